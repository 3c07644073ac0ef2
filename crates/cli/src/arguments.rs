//! Arguments of the commands. Each is described once, here or in the files of this folder, or in the request of its
//! operation; help follows from it.

mod bearing;
mod machine;
mod offline;
mod record;
mod signal;
mod studio;

pub use bearing::{BearingArguments, BearingFrequenciesArguments, ControlWord};
pub use machine::{CompletionsArguments, DoctorArguments, InitArguments, InitKind, ManArguments};
pub use offline::ReduceArguments;
pub use record::RecordArguments;
pub use signal::{
    AbscissaArguments, BearingLineArguments, SeriesArguments, SignalAnalysis, SignalArguments,
    WindowKind,
};
pub use studio::StudioArguments;

use clap::{Args, ValueEnum};
use gearmesh_operations::file_words::positive;
use std::path::PathBuf;

/// The request of an operation, and how its answer is printed.
#[derive(Debug, Args)]
pub struct Printed<R: Args> {
    /// What the operation is asked for
    #[command(flatten)]
    pub request: R,
    /// Print figures as JSON
    #[arg(long)]
    pub json: bool,
}

/// `gearmesh plan`.
#[derive(Debug, Args)]
pub struct PlanArguments {
    /// Scene file
    pub scene: PathBuf,
    /// Print figures as JSON
    #[arg(long)]
    pub json: bool,
}

/// `gearmesh run`.
#[derive(Debug, Args)]
pub struct RunArguments {
    /// Scene file
    pub scene: PathBuf,
    /// Result file; an unfinished run of a multibody scene is kept beside it, as OUTPUT.part, and goes on when the
    /// command is repeated
    #[arg(short, long)]
    pub output: PathBuf,
    /// Discard an unfinished run and begin anew
    #[arg(long)]
    pub restart: bool,
    /// Wall time between checkpoints of a multibody run
    #[arg(long, default_value = "10", value_parser = positive)]
    pub checkpoint_s: f64,
    /// Largest result that is written: rows of all columns, or the forces of all positions of a pair
    #[arg(long = "most-result-GB", default_value = "1", value_parser = positive)]
    pub most_result_gb: f64,
    /// Run in the cheapest setting that is found to be this exact, as `1%`: a few runs, each one rung finer, from where
    /// scenes of the same kind were; the scene's own values of these settings do not count
    #[arg(long, value_name = "PERCENT", value_parser = percent)]
    pub accuracy: Option<f64>,
    /// What is to be that exact, as in `gearmesh accuracy`
    #[arg(long, value_delimiter = ',', requires = "accuracy")]
    pub columns: Vec<String>,
    /// Runs in time: what is to be exact counts from this time on
    #[arg(long, default_value = "0", requires = "accuracy")]
    pub from_s: f64,
    /// Print figures as JSON
    #[arg(long)]
    pub json: bool,
}

/// A share, written in percent.
fn percent(text: &str) -> Result<f64, String> {
    let number = text
        .strip_suffix('%')
        .map(|number| number.trim().parse::<f64>());
    match number {
        Some(Ok(value)) if value > 0.0 && value <= 50.0 => Ok(0.01 * value),
        _ => Err("allowed is more than 0 % and at most 50 %, written as 1%".to_owned()),
    }
}

/// `gearmesh check`.
#[derive(Debug, Args)]
pub struct CheckArguments {
    /// Gear file, bearing file, scene, study, S-N table, record (or its folder), model or result
    pub file: PathBuf,
    /// Print what the file is as JSON
    #[arg(long)]
    pub json: bool,
}

/// `gearmesh study`.
#[derive(Debug, Args)]
pub struct StudyArguments {
    /// Study file
    pub study: PathBuf,
    /// Folder for the results, study.csv and the page study.html; what is there already is not run again
    #[arg(short, long)]
    pub output: PathBuf,
    /// Largest size of the results of all cases together
    #[arg(long = "most-result-GB", default_value = "1", value_parser = positive)]
    pub most_result_gb: f64,
    /// Run the cases on a Dask cluster: the address of its scheduler (tcp://HOST:8786), its scheduler file, or "local"
    /// for one that is started for this study (docs/cluster.md)
    #[arg(long)]
    pub scheduler: Option<String>,
    /// Compute nothing: make the table of what lies in the folder, with the failures that this file lists
    #[arg(long, hide = true, conflicts_with = "scheduler")]
    pub gather: Option<PathBuf>,
    /// Print figures as JSON
    #[arg(long)]
    pub json: bool,
}

/// `gearmesh schema`.
#[derive(Debug, Args)]
pub struct SchemaArguments {
    /// Kind of file
    pub kind: SchemaKind,
    /// Print a page of all keys (Markdown) instead
    #[arg(long)]
    pub markdown: bool,
}

/// A kind of file that has a schema.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum SchemaKind {
    /// Scenes: of a gear pair, or of a multibody system
    Scene,
    /// Parameter studies
    Study,
    /// Optimisations
    Optimise,
    /// Gears
    Gear,
    /// Rolling bearings
    Bearing,
    /// Bevel pairs
    Bevel,
    /// Members of bevel pairs as bodies
    BevelGear,
    /// Reduced gear bodies: data sets of the HDF5 file
    Model,
    /// Results of gear pairs: data sets of the HDF5 file
    PairResult,
    /// Results of multibody scenes: data sets of the HDF5 file
    SystemResult,
}

/// `gearmesh demo`.
#[derive(Debug, Args)]
pub struct DemoArguments {
    /// Folder for models, results and the report
    #[arg(short, long)]
    pub output: PathBuf,
}
