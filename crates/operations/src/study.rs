//! A scene again and again with some of its keys changed.

use crate::failure::{Failure, Result};
use crate::overwriting::refuse_named;
use crate::page_file;
use crate::reduce::reduced_for_study;
use crate::watch::Watch;
use gearmesh_report::study_page::study_page;
use gearmesh_scene::pair::warnings::yielding;
use gearmesh_scene::study::{StudyOptions, StudyOutcome, gather_study, run_study};
use gearmesh_specification::study::Study;
use std::collections::BTreeMap;
use std::path::Path;

/// Refuses a folder whose table or page is a file that the study reads.
///
/// # Errors
/// [`Failure`] that names both.
pub fn refuse_overwriting(study: &Study, folder: &Path) -> Result<()> {
    let read = [Path::new(&study.document.file), &study.folder];
    let outputs = ["study.csv", "study.html"].map(|name| folder.join(name));
    let mut outputs = outputs.iter();
    outputs.try_for_each(|output| refuse_named(&study.document.text, read, output))
}

/// Runs all cases of a study into a folder, and writes its page; stopped, the same call goes on later.
///
/// # Errors
/// [`Failure`] before the first case where the study or one of its scenes is wrong, and where files cannot be written.
pub fn study(study: &Study, folder: &Path, watch: &Watch<'_>) -> Result<StudyOutcome> {
    refuse_overwriting(study, folder)?;
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
) -> Result<StudyOutcome> {
    refuse_overwriting(study, folder)?;
    let outcome = gather_study(study, folder, failures)?;
    conclude(study, &outcome, folder, watch)?;
    Ok(outcome)
}

/// Writes the page, and warns of pressures that no steel carries.
fn conclude(study: &Study, outcome: &StudyOutcome, folder: &Path, watch: &Watch<'_>) -> Result<()> {
    let page = study_page(study, &outcome.cases);
    page_file::write(&page, &folder.join("study.html"), watch)?;
    let pressures = outcome.cases.iter().filter_map(|case| {
        let (column, pa) = case.yielding.as_ref()?;
        Some((format!("{}, {column}", case.case.name()), *pa))
    });
    watch.yielding(yielding(pressures).as_ref());
    Ok(())
}
