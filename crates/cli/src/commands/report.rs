//! `gearmesh report`: one HTML page for one or more results.

use crate::arguments::ReportArguments;
use crate::console;
use crate::failure::Failure;
use crate::output_name;
use gearmesh_model::{FileError, write_text};
use gearmesh_report::ReferenceRecord;
use gearmesh_report::scene_page::{SceneChapter, scene_page};
use gearmesh_scene::SceneResult;
use gearmesh_scene::system_run::SystemResult;
use std::path::Path;

/// Runs the command.
pub fn run(a: &ReportArguments) -> Result<(), Failure> {
    output_name::demand_page(&a.output)?;
    if !a.reference.is_empty() && a.reference.len() != a.results.len() {
        return Err(Failure::input(format!(
            "--reference: found {} folders for {} results; give one for each result, or none",
            a.reference.len(),
            a.results.len()
        )));
    }
    let (mut chapters, mut systems) = (Vec::new(), Vec::new());
    for (k, path) in a.results.iter().enumerate() {
        match SystemResult::open(path) {
            Ok(result) => {
                if !a.reference.is_empty() {
                    return Err(Failure::input(format!(
                        "--reference: {} is the result of a multibody scene, which no record is compared with; leave it out",
                        path.display()
                    )));
                }
                systems.push(result);
                continue;
            }
            Err(FileError::WrongFormat { .. }) => {}
            Err(error) => return Err(Failure::input(error)),
        }
        let result = SceneResult::read(path).map_err(Failure::input)?;
        let record = match a.reference.get(k) {
            Some(folder) => Some(ReferenceRecord::read(folder).map_err(Failure::input)?),
            None => None,
        };
        chapters.push(SceneChapter {
            result,
            record,
            pictures: Vec::new(),
        });
    }
    write_page(&chapters, &systems, &a.output)
}

/// Renders the page and writes it, beside and renamed.
pub fn write_page(
    chapters: &[SceneChapter],
    systems: &[SystemResult],
    output: &Path,
) -> Result<(), Failure> {
    let html = scene_page(chapters, systems)
        .and_then(|page| page.render().map_err(Into::into))
        .map_err(Failure::work)?;
    write_text(output, &html).map_err(Failure::work)?;
    console::note(format!(
        "{}: {:.1} MB",
        output.display(),
        html.len() as f64 * 1e-6
    ));
    Ok(())
}
