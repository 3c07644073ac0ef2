//! `gearmesh report`: one HTML page for one or more results.

use super::report_stress;
use crate::arguments::ReportArguments;
use crate::console;
use crate::failure::Failure;
use crate::output_name;
use crate::page_file;
use gearmesh_report::ReferenceRecord;
use gearmesh_report::overlay::{overlaid_pairs, overlaid_systems};
use gearmesh_report::page::Page;
use gearmesh_report::scene_page::{SceneChapter, SystemChapter, scene_page};
use gearmesh_scene::ResultFile;
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
    for (name, given) in [
        ("--stress-at-s", a.stress_at_s.is_some()),
        ("--stress-angle-deg", a.stress_angle_deg.is_some()),
        ("--scene-folder", a.scene_folder.is_some()),
    ] {
        if given && !a.stress {
            let problem = format!("{name} is for pictures of the stress; add --stress");
            return Err(Failure::input(problem));
        }
    }
    let (mut chapters, mut systems) = (Vec::new(), Vec::new());
    let mut figures = Vec::new();
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
                let stress = match a.stress {
                    true => Some(report_stress::of_system(a, &result, path)?),
                    false => None,
                };
                let stress = stress.map(|(section, own)| {
                    figures.extend(own);
                    section
                });
                systems.push(SystemChapter {
                    result: *result,
                    stress,
                });
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
        let stress = match a.stress {
            true => Some(report_stress::of_pair(a, &result, path)?),
            false => None,
        };
        let stress = stress.map(|(section, own)| {
            figures.extend(own);
            section
        });
        chapters.push(SceneChapter {
            result,
            record,
            stress,
        });
    }
    let page = scene_page(&chapters, &systems).map_err(Failure::work)?;
    let pairs = chapters.iter().zip(&names[0]);
    let pairs: Vec<_> = pairs.map(|(c, name)| (name.clone(), &c.result)).collect();
    let others = names[1].iter().cloned();
    let others: Vec<_> = others.zip(systems.iter().map(|c| &c.result)).collect();
    let overlaid = overlaid_systems(&others).map_err(Failure::work)?;
    let sections = overlaid.into_iter().chain(overlaid_pairs(&pairs));
    page_file::write(&sections.fold(page, Page::first_section), &a.output)?;
    if a.json {
        let mut told = json!({ "file": a.output, "results": a.results });
        if a.stress {
            told["stress"] = figures.into();
        }
        console::json(&told);
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
    systems: &[SystemChapter],
    output: &Path,
) -> Result<(), Failure> {
    let page = scene_page(chapters, systems).map_err(Failure::work)?;
    page_file::write(&page, output)
}
