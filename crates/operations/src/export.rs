//! A result for other programs; a gear for CAD.
//!
//! | what | file |
//! | --- | --- |
//! | tables | `export/tables.rs` |
//! | gears that move | `export/series.rs`, of multibody scenes `system_moments.rs` |
//! | a gear's flanks as STEP | `export/step.rs` |

mod series;
mod step;
mod tables;

use crate::failure::Failure;
use crate::watch::Watch;
use crate::{output_name, overwriting};
use serde::Deserialize;
use serde_json::Value;
use std::path::PathBuf;

/// What is exported.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExportRequest {
    /// Result file, folder of a study, or of STEP files a gear file.
    pub result: PathBuf,
    /// File; its ending chooses the format.
    pub output: PathBuf,
    /// Tables: which one.
    pub table: Option<String>,
    /// Gears that move: most moments, evenly chosen.
    pub moments: Option<u32>,
    /// Gears that move: with the stress on their surfaces.
    #[serde(default)]
    pub stress: bool,
    /// Gears that move, of a pair: torque.
    #[serde(rename = "torque_Nm")]
    pub torque_nm: Option<f64>,
    /// Gears that move, of a run in time: begin.
    pub from_s: Option<f64>,
    /// Gears that move, of a run in time: end.
    pub to_s: Option<f64>,
    /// Gears that move, of a multibody scene: folder that its file names are relative to.
    pub scene_folder: Option<PathBuf>,
}

/// What was written.
#[derive(Debug, Clone)]
pub struct Exported {
    /// For other programs.
    pub figures: Value,
    /// For people; none where the notes say it all.
    pub line: Option<String>,
}

/// Writes a result as tables or as gears that move, or a gear as STEP; the ending of the output chooses.
///
/// # Errors
/// [`Failure`] for files that cannot be read or written, and options for which the format has no use.
pub fn export(a: &ExportRequest, watch: &Watch<'_>) -> Result<Exported, Failure> {
    let inputs = vec![a.result.clone(), a.result.join("study.csv")];
    overwriting::refuse(inputs, std::slice::from_ref(&a.output))?;
    let ending = output_name::export_ending(&a.output)?;
    let moves = ending == ".pvd";
    let is_table = !matches!(ending, ".pvd" | ".step" | ".stp");
    let of_series = [
        ("--moments", a.moments.is_some()),
        ("--torque-Nm", a.torque_nm.is_some()),
        ("--from-s", a.from_s.is_some()),
        ("--to-s", a.to_s.is_some()),
        ("--scene-folder", a.scene_folder.is_some()),
        ("--stress", a.stress),
    ];
    let given = of_series.iter().filter(|(_, given)| *given && !moves);
    let unused = given.map(|(name, _)| *name);
    let unused = unused.chain((a.table.is_some() && !is_table).then_some("--table"));
    if let Some(name) = unused.into_iter().next() {
        return Err(Failure::input(format!(
            "{name} has no use for a {ending} file; leave it out"
        )));
    }
    match ending {
        ".pvd" => series::write(a, watch),
        ".step" | ".stp" => step::write(a, watch),
        _ => tables::write(a, ending, watch),
    }
}
