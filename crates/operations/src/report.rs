//! One HTML page for one or more results.

use crate::answer::Answer;
use crate::bevel_stress;
use crate::failure::{Failure, Result};
use crate::result_stress::{self, StressRequest, StressSection};
use crate::watch::Watch;
use crate::{output_name, overwriting, page_file};
use gearmesh_report::ReferenceRecord;
use gearmesh_report::overlay::{overlaid_pairs, overlaid_systems};
use gearmesh_report::page::Page;
use gearmesh_report::scene_page::{SceneChapter, SystemChapter, scene_page};
use gearmesh_scene::{ResultFile, SceneResult};
use serde::Deserialize;
use serde_json::json;
use std::path::{Path, PathBuf};

/// What is reported.
#[derive(Debug, Clone, Default, clap::Args, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReportRequest {
    /// Result files, one section each
    #[arg(required = true)]
    #[serde(deserialize_with = "crate::one_or_many::read")]
    pub results: Vec<PathBuf>,
    /// HTML file
    #[arg(short, long)]
    pub output: PathBuf,
    /// Add the stress of the gears: pictures of the loaded tooth and its neighbours at the moment of the largest root
    /// stress, of a pair at its largest torque; meshes and solves each gear again
    #[arg(long)]
    #[serde(default)]
    pub stress: bool,
    /// The stress at this time, the nearest row is taken [default: where the root stress is largest]
    #[arg(long)]
    pub stress_at_s: Option<f64>,
    /// The stress of a pair at this angle of the driver, the nearest one is taken [default: where the root stress is
    /// largest]
    #[arg(long, allow_negative_numbers = true)]
    pub stress_angle_deg: Option<f64>,
    /// The stress of a multibody scene: folder that its file names are relative to [default: that of the result, else
    /// the working folder]
    #[arg(long)]
    pub scene_folder: Option<PathBuf>,
    /// Folder of a reference record for each result, in the same order
    #[arg(long)]
    #[serde(default, deserialize_with = "crate::one_or_many::read")]
    pub reference: Vec<PathBuf>,
}

/// Writes the page; what `gearmesh report --json` prints.
///
/// # Errors
/// [`Failure`] for files that cannot be read, options that do not belong to a result, and a page that cannot be
/// written.
pub fn report(a: &ReportRequest, watch: &Watch<'_>) -> Result<Answer> {
    demand_sound(a)?;
    let how = StressRequest {
        at_s: a.stress_at_s,
        angle_deg: a.stress_angle_deg,
        scene_folder: a.scene_folder.clone(),
    };
    let (mut chapters, mut systems) = (Vec::new(), Vec::new());
    let mut figures = Vec::new();
    let mut keep = |(section, own): StressSection| {
        figures.extend(own);
        section
    };
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
                    true => Some(result_stress::of_system(&how, &result, path, watch)?),
                    false => None,
                };
                systems.push(SystemChapter {
                    result: *result,
                    stress: stress.map(&mut keep),
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
            true => Some(stress_at_rest(&how, &result, path, watch)?),
            false => None,
        };
        chapters.push(SceneChapter {
            result,
            record,
            stress: stress.map(&mut keep),
        });
    }
    let page = scene_page(&chapters, &systems).map_err(Failure::work)?;
    let pairs = chapters.iter().zip(&names[0]);
    let pairs: Vec<_> = pairs.map(|(c, name)| (name.clone(), &c.result)).collect();
    let others = names[1].iter().cloned();
    let others: Vec<_> = others.zip(systems.iter().map(|c| &c.result)).collect();
    let overlaid = overlaid_systems(&others).map_err(Failure::work)?;
    let sections = overlaid.into_iter().chain(overlaid_pairs(&pairs));
    watch.go_on()?;
    page_file::write(&sections.fold(page, Page::first_section), &a.output, watch)?;
    let mut told = json!({ "file": a.output, "results": a.results });
    if a.stress {
        told["stress"] = figures.into();
    }
    Ok(told.into())
}

/// Refuses options that do not go together, before anything is read.
fn demand_sound(a: &ReportRequest) -> Result<()> {
    let of_record = |folder: &PathBuf| ["record.toml", "data.csv"].map(|name| folder.join(name));
    let records = a.reference.iter().flat_map(of_record);
    let inputs = a.results.iter().cloned().chain(records).collect();
    overwriting::refuse(inputs, std::slice::from_ref(&a.output))?;
    output_name::demand_page(&a.output)?;
    if !a.reference.is_empty() && a.reference.len() != a.results.len() {
        return Err(Failure::input(format!(
            "--reference: found {} folders for {} results; give one for each result, or none",
            a.reference.len(),
            a.results.len()
        )));
    }
    let of_stress = [
        ("--stress-at-s", a.stress_at_s.is_some()),
        ("--stress-angle-deg", a.stress_angle_deg.is_some()),
        ("--scene-folder", a.scene_folder.is_some()),
    ];
    match of_stress.iter().find(|(_, given)| *given && !a.stress) {
        Some((name, _)) => Err(Failure::input(format!(
            "{name} is for pictures of the stress; add --stress"
        ))),
        None => Ok(()),
    }
}

/// The stress of a pair at rest.
fn stress_at_rest(
    how: &StressRequest,
    result: &SceneResult,
    path: &Path,
    watch: &Watch<'_>,
) -> Result<StressSection> {
    if how.at_s.is_some() {
        return Err(Failure::input(format!(
            "--stress-at-s is for runs in time; {} is a pair at rest, use --stress-angle-deg",
            path.display()
        )));
    }
    if result.bevel.is_none() {
        return result_stress::of_pair(how, result, path, watch);
    }
    bevel_stress::section(result, how.angle_deg, watch)
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
    watch: &Watch<'_>,
) -> Result<()> {
    let page = scene_page(chapters, systems).map_err(Failure::work)?;
    page_file::write(&page, output, watch)
}
