//! Arguments of `gearmesh export`.

use clap::Args;
use std::path::PathBuf;

/// `gearmesh export`.
#[derive(Debug, Args)]
pub struct ExportArguments {
    /// Result file, or folder of a study
    pub result: PathBuf,
    /// File to write; its ending says what: .csv .parquet .mat (MATLAB, Octave, SciPy) .uff .unv (universal file) are
    /// tables
    #[arg(short, long)]
    pub output: PathBuf,
    /// Table of the result [default: the first; in a .mat file all]. Pairs: curves, contact, torques; multibody: rows,
    /// windows, modes and shapes; of both: ratings
    #[arg(long)]
    pub table: Option<String>,
    /// Print what was written as JSON
    #[arg(long)]
    pub json: bool,
}
