//! The command line. Each argument is described once, here or in the files of this folder; help follows from it.

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

use clap::{Args, Parser, Subcommand, ValueEnum};
use gearmesh_operations::accuracy::AccuracyRequest;
use gearmesh_operations::bevel_pair::BevelRequest;
use gearmesh_operations::compare::CompareRequest;
use gearmesh_operations::compliance::ComplianceRequest;
use gearmesh_operations::export::ExportRequest;
use gearmesh_operations::file_words::positive;
use gearmesh_operations::import::ImportRequest;
use gearmesh_operations::mesh::MeshRequest;
use gearmesh_operations::modes::ModesRequest;
use gearmesh_operations::optimise::OptimiseRequest;
use gearmesh_operations::recover::RecoverRequest;
use gearmesh_operations::report::ReportRequest;
use gearmesh_operations::tca::TcaRequest;
use std::path::PathBuf;

/// Gear mesh stiffness from finite elements, once; contact and root strain from then on in microseconds.
#[derive(Debug, Parser)]
#[command(name = "gearmesh", version, max_term_width = 100)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Mesh a gear and write it for other programs: ParaView, gmsh, Abaqus, CalculiX, Nastran
    Mesh(Printed<MeshRequest>),
    /// Reduce a gear to its compliance at the flanks (the offline stage)
    Reduce(ReduceArguments),
    /// Find the natural frequencies and mode shapes of a gear, held at its bore
    Modes(Printed<ModesRequest>),
    /// Print the deflection along a flank under a line load
    Compliance(Printed<ComplianceRequest>),
    /// Say what a scene will compute
    Plan(PlanArguments),
    /// Run a scene
    Run(RunArguments),
    /// Recover the strain of all gauges from a result, and whole fields on request
    Recover(Printed<RecoverRequest>),
    /// Compare a result with a reference record
    Compare(Printed<CompareRequest>),
    /// Write a report page
    Report(Printed<ReportRequest>),
    /// Export a result as a table (CSV, Parquet, MATLAB, universal file) or as moving gears (ParaView), a gear as STEP
    Export(Printed<ExportRequest>),
    /// Make a reference record of measured curves: CSV with units, or a universal file
    Record(RecordArguments),
    /// Open a gear pair or a result in the browser: change the pair, see its curves and flanks at once
    Studio(StudioArguments),
    /// Analyse a column of a multibody result: spectra, orders, sidebands, envelope, averages
    Signal(SignalArguments),
    /// Check a gear file, bearing file, scene, study, S-N table, record, model or result
    Check(CheckArguments),
    /// Run a scene again and again with some of its keys changed
    Study(StudyArguments),
    /// Say what accuracy costs in time, for columns of a scene: error against time of every knob
    Accuracy(Printed<AccuracyRequest>),
    /// Seek the relief, crowning or other keys that make the objectives of a gear pair least
    Optimise(Printed<OptimiseRequest>),
    /// Find where a rolling bearing comes to rest under a load: load on every ball or roller, pressures, stiffness,
    /// life
    Bearing(BearingArguments),
    /// Print the frequencies of a rolling bearing: cage, ball or roller, passing of the races
    BearingFrequencies(BearingFrequenciesArguments),
    /// Print blank, machine settings and checks of a bevel pair
    Bevel(Printed<BevelRequest>),
    /// Analyse the tooth contact of a bevel pair: path, transmission error, ellipses, ease-off, edges
    Tca(Printed<TcaRequest>),
    /// Import a gearbox from a REXS file: gear files, scenes, bearing files, a list of what was taken and what not
    Import(Printed<ImportRequest>),
    /// Print the JSON Schema of scene, study, gear, bearing or bevel files
    Schema(SchemaArguments),
    /// Write commented files to start from: a gear, a pair, a gearbox, a bevel pair
    Init(InitArguments),
    /// Say what this machine lacks: Python with gmsh and meshio, memory, other programs
    Doctor(DoctorArguments),
    /// Print the completions of a shell
    Completions(CompletionsArguments),
    /// Write the manual pages
    Man(ManArguments),
    /// Make gear pairs A and B from definition to report
    Demo(DemoArguments),
}

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
    /// Run the cases on a Dask cluster: the address of its scheduler (tcp://HOST:8786), its scheduler file, or "local" for
    /// one that is started for this study (docs/cluster.md)
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
