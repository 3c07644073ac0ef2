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

use crate::answer::Answer;
use crate::failure::{Failure, Result};
use crate::watch::Watch;
use crate::{output_name, overwriting};
use serde::Deserialize;
use std::path::PathBuf;

/// What is exported.
#[derive(Debug, Clone, clap::Args, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct ExportRequest {
    /// Result file, or folder of a study; for .step a gear file
    pub result: PathBuf,
    /// File to write; its ending says what: .csv .parquet .mat (MATLAB, Octave, SciPy) .uff .unv (universal file) are
    /// tables, .pvd gears that move (ParaView, PyVista), .step .stp the flanks of a gear (CAD)
    #[arg(short, long)]
    pub output: PathBuf,
    /// Tables: which one [default: the first; in a .mat file all]. Pairs: curves, contact, torques; multibody: rows,
    /// windows, modes and shapes; of both: ratings
    #[arg(long)]
    pub table: Option<String>,
    /// Gears that move: most moments, evenly chosen [default: 100]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub moments: Option<u32>,
    /// Gears that move: with the von Mises stress on the surfaces of their finite elements; meshes and solves each gear
    /// again
    #[arg(long)]
    #[serde(default)]
    pub stress: bool,
    /// Gears that move, of a pair: torque [default: the largest one]
    #[arg(long = "torque-Nm", allow_negative_numbers = true)]
    pub torque_Nm: Option<f64>,
    /// Gears that move, of a run in time: begin [default: that of the run]
    #[arg(long)]
    pub from_s: Option<f64>,
    /// Gears that move, of a run in time: end [default: that of the run]
    #[arg(long)]
    pub to_s: Option<f64>,
    /// Gears that move, of a multibody scene: folder that its file names are relative to [default: that of the result,
    /// else the working folder]
    #[arg(long)]
    pub scene_folder: Option<PathBuf>,
}

/// Writes a result as tables or as gears that move, or a gear as STEP; the ending of the output chooses.
///
/// # Errors
/// [`Failure`] for files that cannot be read or written, and options for which the format has no use.
pub fn export(a: &ExportRequest, watch: &Watch<'_>) -> Result<Answer> {
    let inputs = vec![a.result.clone(), a.result.join("study.csv")];
    overwriting::refuse(inputs, std::slice::from_ref(&a.output))?;
    let ending = output_name::export_ending(&a.output)?;
    let moves = ending == ".pvd";
    let is_table = !matches!(ending, ".pvd" | ".step" | ".stp");
    let of_series = [
        ("--moments", a.moments.is_some()),
        ("--torque-Nm", a.torque_Nm.is_some()),
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
