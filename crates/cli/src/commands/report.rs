//! `gearmesh report`: one HTML page for one or more results.

use super::recover::scene_of;
use super::stress_picture::pictures;
use crate::arguments::ReportArguments;
use crate::console;
use crate::failure::Failure;
use crate::output_name;
use crate::page_file;
use gearmesh_report::ReferenceRecord;
use gearmesh_report::overlay::{overlaid_pairs, overlaid_systems};
use gearmesh_report::page::Page;
use gearmesh_report::scene_page::{SceneChapter, scene_page};
use gearmesh_scene::ResultFile;
use gearmesh_scene::system_run::SystemResult;
use serde_json::json;
use std::path::{Path, PathBuf};

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
    let files = file_names(&a.results);
    // Of pairs, of multibody results.
    let mut names = [Vec::new(), Vec::new()];
    for (k, path) in a.results.iter().enumerate() {
        let result = match ResultFile::open(path).map_err(Failure::input)? {
            ResultFile::System(result) => {
                if !a.reference.is_empty() {
                    return Err(Failure::input(format!(
                        "--reference: {} is the result of a multibody scene, which no record is compared with; leave it out",
                        path.display()
                    )));
                }
                systems.push(*result);
                names[1].push(files[k].clone());
                continue;
            }
            ResultFile::Pair(result) => *result,
        };
        let record = match a.reference.get(k) {
            Some(folder) => Some(ReferenceRecord::read(folder).map_err(Failure::input)?),
            None => None,
        };
        names[0].push(files[k].clone());
        let pictures = if a.stress {
            let (pictures, left_out) = pictures(&scene_of(&result, path)?, &result)?;
            left_out.iter().for_each(console::note);
            pictures
        } else {
            Vec::new()
        };
        chapters.push(SceneChapter {
            result,
            record,
            pictures,
        });
    }
    let page = scene_page(&chapters, &systems).map_err(Failure::work)?;
    let pairs = chapters.iter().zip(&names[0]);
    let pairs: Vec<_> = pairs.map(|(c, name)| (name.clone(), &c.result)).collect();
    let others: Vec<_> = names[1].iter().cloned().zip(&systems).collect();
    let overlaid = overlaid_systems(&others).map_err(Failure::work)?;
    let sections = overlaid.into_iter().chain(overlaid_pairs(&pairs));
    page_file::write(&sections.fold(page, Page::first_section), &a.output)?;
    if a.json {
        console::json(&json!({ "file": a.output, "results": a.results }));
    }
    Ok(())
}

/// Names of files as a chart tells them apart: bare, or as given where two are alike.
fn file_names(files: &[PathBuf]) -> Vec<String> {
    let bare = |path: &PathBuf| {
        path.file_name()
            .map_or(path.display().to_string(), |n| n.to_string_lossy().into())
    };
    let all: Vec<String> = files.iter().map(bare).collect();
    let alone = |name: &String| all.iter().filter(|other| *other == name).count() == 1;
    if all.iter().all(alone) {
        all.clone()
    } else {
        files
            .iter()
            .map(|path| path.display().to_string())
            .collect()
    }
}

/// Renders the page and writes it, beside and renamed.
pub fn write_page(
    chapters: &[SceneChapter],
    systems: &[SystemResult],
    output: &Path,
) -> Result<(), Failure> {
    let page = scene_page(chapters, systems).map_err(Failure::work)?;
    page_file::write(&page, output)
}
