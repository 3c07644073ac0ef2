//! A scene again and again with some of its keys changed.

use crate::failure::Failure;
use crate::page_file;
use crate::reduce::reduced_for_study;
use crate::watch::Watch;
use gearmesh_report::study_page::study_page;
use gearmesh_scene::pair::warnings::excessive_pressure;
use gearmesh_scene::study::{
    SelectedValue, Study, StudyOptions, StudyOutcome, gather_study, run_study,
};
use std::collections::BTreeMap;
use std::path::Path;

/// Runs all cases of a study into a folder, and writes its page; stopped, the same call goes on later.
///
/// # Errors
/// [`Failure`] before the first case where the study or one of its scenes is wrong, and where files cannot be written.
pub fn study(study: &Study, folder: &Path, watch: &Watch<'_>) -> Result<StudyOutcome, Failure> {
    let task = watch.listener.begin("study");
    let progress = |done: usize, count: usize| task.advance(done as f64, count as f64);
    let options = StudyOptions {
        folder,
        stop: watch.stop,
        progress: &progress,
        reduce: &|gear| reduced_for_study(gear, watch),
    };
    let outcome = run_study(study, &options);
    drop(task);
    if watch.is_stopped() {
        return Err(Failure::stopped(
            "interrupted; the same command goes on from here",
        ));
    }
    let outcome = outcome?;
    conclude(study, &outcome, folder, watch)?;
    Ok(outcome)
}

/// The same of cases that lie in the folder already; nothing is computed. `failures`: why cases have failed, by the
/// names of their files.
///
/// # Errors
/// As [`study`].
pub fn gather(
    study: &Study,
    folder: &Path,
    failures: &BTreeMap<String, String>,
    watch: &Watch<'_>,
) -> Result<StudyOutcome, Failure> {
    let outcome = gather_study(study, folder, failures)?;
    conclude(study, &outcome, folder, watch)?;
    Ok(outcome)
}

/// Writes the page, and warns of pressures that no steel carries.
fn conclude(
    study: &Study,
    outcome: &StudyOutcome,
    folder: &Path,
    watch: &Watch<'_>,
) -> Result<(), Failure> {
    let page = study_page(study, &outcome.cases);
    page_file::write(&page, &folder.join("study.html"), watch)?;
    let figures = outcome.cases.iter().flat_map(|case| {
        let columns = case.figures.iter().flatten();
        columns.map(move |one| (format!("{}, {}", case.case.name(), one.column), one))
    });
    let pressures = figures.filter_map(|(name, one)| {
        let to_pa = match one.unit.as_str() {
            "Pa" => 1.0,
            "MPa" => 1e6,
            _ => return None,
        };
        let largest = match &one.value {
            SelectedValue::Single(value) => *value,
            SelectedValue::Series(figures) => figures.largest,
        };
        one.column
            .contains("pressure")
            .then_some((name, to_pa * largest))
    });
    excessive_pressure(pressures)
        .into_iter()
        .for_each(|words| watch.warning(words));
    Ok(())
}
