//! Arguments of `gearmesh export`.

use clap::Args;
use std::path::PathBuf;

/// `gearmesh export`.
#[derive(Debug, Args)]
#[allow(non_snake_case)]
pub struct ExportArguments {
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
    /// Gears that move: with the von Mises stress on the surfaces of their finite elements; meshes and solves each gear again
    #[arg(long)]
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
    /// Print what was written as JSON
    #[arg(long)]
    pub json: bool,
}
