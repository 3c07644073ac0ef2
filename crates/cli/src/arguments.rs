//! The command line. Each argument is described once, here or in the files of this folder; help follows from it.

mod bearing;
mod bevel;
mod export;
mod machine;
mod offline;
mod record;
mod signal;
mod studio;

pub use bearing::{BearingArguments, BearingFrequenciesArguments, ControlWord};
pub use bevel::{BevelArguments, TcaArguments};
pub use export::ExportArguments;
pub use machine::{CompletionsArguments, DoctorArguments, InitArguments, InitKind, ManArguments};
pub use offline::{ComplianceArguments, MeshArguments, ModesArguments, ReduceArguments};
pub use record::RecordArguments;
pub use signal::{
    AbscissaArguments, BearingLineArguments, SeriesArguments, SignalAnalysis, SignalArguments,
    WindowKind,
};
pub use studio::StudioArguments;

use clap::{Args, Parser, Subcommand, ValueEnum};
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
    Mesh(MeshArguments),
    /// Reduce a gear to its compliance at the flanks (the offline stage)
    Reduce(ReduceArguments),
    /// Find the natural frequencies and mode shapes of a gear, held at its bore
    Modes(ModesArguments),
    /// Print the deflection along a flank under a line load
    Compliance(ComplianceArguments),
    /// Say what a scene will compute
    Plan(PlanArguments),
    /// Run a scene
    Run(RunArguments),
    /// Recover the strain of all gauges from a result, and whole fields on request
    Recover(RecoverArguments),
    /// Compare a result with a reference record
    Compare(CompareArguments),
    /// Write a report page
    Report(ReportArguments),
    /// Export a result as a table (CSV, Parquet, MATLAB, universal file) or as moving gears (ParaView), a gear as STEP
    Export(ExportArguments),
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
    Accuracy(AccuracyArguments),
    /// Seek the relief, crowning or other keys that make the objectives of a gear pair least
    Optimise(OptimiseArguments),
    /// Find where a rolling bearing comes to rest under a load: load on every ball or roller, pressures, stiffness,
    /// life
    Bearing(BearingArguments),
    /// Print the frequencies of a rolling bearing: cage, ball or roller, passing of the races
    BearingFrequencies(BearingFrequenciesArguments),
    /// Print blank, machine settings and checks of a bevel pair
    Bevel(BevelArguments),
    /// Analyse the tooth contact of a bevel pair: path, transmission error, ellipses, ease-off, edges
    Tca(TcaArguments),
    /// Import a gearbox from a REXS file: gear files, scenes, bearing files, a list of what was taken and what not
    Import(ImportArguments),
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
    /// Print figures as JSON
    #[arg(long)]
    pub json: bool,
}

/// A number that is more than zero.
fn positive(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| "no number".to_owned())?;
    if value > 0.0 && value < 1e9 {
        Ok(value)
    } else {
        Err("allowed is more than 0, less than 1e9".to_owned())
    }
}

/// Two names with `=` between them.
fn head_and_column(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((head, column)) if !head.is_empty() && !column.is_empty() => {
            Ok((head.trim().to_owned(), column.trim().to_owned()))
        }
        _ => Err("allowed is HEAD=COLUMN, a column of data.csv and one of the result".to_owned()),
    }
}

/// `gearmesh recover`.
#[derive(Debug, Args)]
#[allow(non_snake_case)]
pub struct RecoverArguments {
    /// Result file
    pub result: PathBuf,
    /// Strain file
    #[arg(short, long)]
    pub output: PathBuf,
    /// Write the displacement and von Mises field of this gear (1 or 2), too
    #[arg(long, requires = "field_angle_deg", requires = "field_output")]
    pub field_gear: Option<usize>,
    /// Driver angle of the field: the nearest computed position is taken
    #[arg(long)]
    pub field_angle_deg: Option<f64>,
    /// Torque of the field; the largest computed one where not given
    #[arg(long = "field-torque-Nm")]
    pub field_torque_Nm: Option<f64>,
    /// Mesh file of the field (vtu, ...)
    #[arg(long)]
    pub field_output: Option<PathBuf>,
    /// Print figures as JSON
    #[arg(long)]
    pub json: bool,
}

/// `gearmesh compare`.
#[derive(Debug, Args)]
pub struct CompareArguments {
    /// Result file
    pub result: PathBuf,
    /// Folder of a reference record (docs/records.md)
    pub reference: PathBuf,
    /// Multibody results: which column of the result belongs to a column of data.csv; may be given several times
    #[arg(long, value_name = "HEAD=COLUMN", value_parser = head_and_column)]
    pub column: Vec<(String, String)>,
    /// Multibody results: begin at this time [default: the middle of the run]
    #[arg(long)]
    pub from_s: Option<f64>,
    /// Multibody results: the record's angle at the start of the run [default: 0]
    #[arg(long, allow_negative_numbers = true)]
    pub start_angle_deg: Option<f64>,
    /// Print figures as JSON
    #[arg(long)]
    pub json: bool,
}

/// `gearmesh report`.
#[derive(Debug, Args)]
pub struct ReportArguments {
    /// Result files, one section each
    #[arg(required = true)]
    pub results: Vec<PathBuf>,
    /// HTML file
    #[arg(short, long)]
    pub output: PathBuf,
    /// Add the stress of the gears: pictures of the loaded tooth and its neighbours at the moment of the largest root
    /// stress, of a pair at its largest torque; meshes and solves each gear again
    #[arg(long)]
    pub stress: bool,
    /// The stress at this time, the nearest row is taken [default: where the root stress is largest]
    #[arg(long)]
    pub stress_at_s: Option<f64>,
    /// The stress of a pair at this angle of the driver, the nearest one is taken [default: where the root stress is
    /// largest]
    #[arg(long, allow_negative_numbers = true)]
    pub stress_angle_deg: Option<f64>,
    /// The stress of a multibody scene: folder that its file names are relative to [default: that of the result, else the
    /// working folder]
    #[arg(long)]
    pub scene_folder: Option<PathBuf>,
    /// Folder of a reference record for each result, in the same order
    #[arg(long)]
    pub reference: Vec<PathBuf>,
    /// Print what was written as JSON
    #[arg(long)]
    pub json: bool,
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

/// `gearmesh accuracy`.
#[derive(Debug, Args)]
pub struct AccuracyArguments {
    /// Scene of a gear pair, multibody scene, or bevel pair
    pub scene: PathBuf,
    /// What is to be exact: columns of a study of the scene, of series COLUMN:FIGURE, with mean, deviation, rms,
    /// peak-to-peak, largest, least; of runs in time line-250Hz; of sweeps resonance-rpm
    #[arg(long, required = true, value_delimiter = ',')]
    pub columns: Vec<String>,
    /// Runs in time: figures from this time on
    #[arg(long, default_value = "0")]
    pub from_s: f64,
    /// Vary elements and element lengths of the reduced gears, too, which reduces each several times; keep the models
    /// in this folder
    #[arg(long)]
    pub elements: Option<PathBuf>,
    /// Judge settings by this time; processor time where other work shares the machine
    #[arg(long, default_value = "wall")]
    pub time: TimeWord,
    /// Page with the picture of error against time
    #[arg(short, long)]
    pub output: Option<PathBuf>,
    /// Print figures as JSON
    #[arg(long)]
    pub json: bool,
}

/// A time that settings are judged by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum TimeWord {
    /// Wall time
    Wall,
    /// Processor time
    Processor,
}

/// `gearmesh optimise`.
#[derive(Debug, Args)]
pub struct OptimiseArguments {
    /// File with the scene, what is sought, what scatters, what is to be small
    pub file: PathBuf,
    /// Folder for front.csv, tried.csv and the page optimise.html
    #[arg(short, long)]
    pub output: PathBuf,
    /// Print figures as JSON
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

/// `gearmesh import`.
#[derive(Debug, Args)]
pub struct ImportArguments {
    /// REXS file: XML (.rexs), JSON (.rexsj) or a zip file of one (.rexsz)
    pub model: PathBuf,
    /// Folder for the files that are made; files of the same names are replaced
    #[arg(short, long)]
    pub output: PathBuf,
    /// Scenes of reduced gears (`hybrid` meshes) in place of the springs of ISO 6336: reduce the gear files first
    #[arg(long)]
    pub reduced: bool,
    /// Scenes that run in time, driven at the speeds of the file, in place of scenes at rest
    #[arg(long)]
    pub transient: bool,
    /// Write the files only: neither check them nor run the scenes at rest
    #[arg(long)]
    pub no_run: bool,
    /// Print the figures at rest, and what was taken, assumed and not represented, as JSON
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
