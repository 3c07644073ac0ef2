//! The command line. Each argument is described once, here; help follows from it.

use crate::length_unit::LengthUnit;
use gearmesh_contact::LocalContact;
use gearmesh_geometry::Flank;

use crate::file_words::{flank_words, local_words};
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
    /// Export a result as a table: CSV, Parquet or MATLAB
    Export(ExportArguments),
    /// Analyse a column of a multibody result: spectra, orders, sidebands, envelope, averages
    Signal(SignalArguments),
    /// Check a gear file, bearing file, scene, study, S-N table, record, model or result
    Check(CheckArguments),
    /// Run a multibody scene again and again with some of its keys changed
    Study(StudyArguments),
    /// Find where a rolling bearing comes to rest under a load: load on every ball or roller, pressures, stiffness,
    /// life
    Bearing(BearingArguments),
    /// Print the frequencies of a rolling bearing: cage, ball or roller, passing of the races
    BearingFrequencies(BearingFrequenciesArguments),
    /// Print the JSON Schema of scene, study, gear or bearing files
    Schema(SchemaArguments),
    /// Make gear pairs A and B from definition to report
    Demo(DemoArguments),
}

/// `gearmesh mesh`.
#[derive(Debug, Args)]
pub struct MeshArguments {
    /// Gear file
    pub gear: PathBuf,
    /// Mesh file; its extension names the format: .bdf .nas (Nastran), .inp (Abaqus, CalculiX), .msh (gmsh), .vtk .vtu
    /// .xdmf .xmf (ParaView)
    #[arg(short, long)]
    pub output: PathBuf,
    /// Unit of the coordinates in the file
    #[arg(long, value_enum, default_value = "m")]
    pub length_unit: LengthUnit,
    /// Begin even if the memory estimate exceeds what is free
    #[arg(long)]
    pub even_if_memory_is_short: bool,
    /// Print figures as JSON
    #[arg(long)]
    pub json: bool,
}

/// `gearmesh reduce`.
#[derive(Debug, Args)]
pub struct ReduceArguments {
    /// Gear file
    pub gear: PathBuf,
    /// Model file
    #[arg(short, long)]
    pub output: PathBuf,
    /// Do not reduce a coarser mesh to estimate the discretisation error
    #[arg(long)]
    pub no_error_estimate: bool,
    /// Begin even if the memory estimate exceeds what is free
    #[arg(long)]
    pub even_if_memory_is_short: bool,
    /// Print figures as JSON
    #[arg(long)]
    pub json: bool,
}

/// `gearmesh modes`.
#[derive(Debug, Args)]
#[allow(non_snake_case)]
pub struct ModesArguments {
    /// Gear file with material.density_kg_per_m3
    pub gear: PathBuf,
    /// So many modes, the lowest; instead of what the gear file says
    #[arg(long, conflicts_with = "up_to_Hz")]
    pub count: Option<usize>,
    /// All modes up to this frequency; instead of what the gear file says
    #[arg(long = "up-to-Hz")]
    pub up_to_Hz: Option<f64>,
    /// Mesh file for the shapes, one point field a mode (.vtu, .msh, ...)
    #[arg(long)]
    pub shapes: Option<PathBuf>,
    /// Begin even if the memory estimate exceeds what is free
    #[arg(long)]
    pub even_if_memory_is_short: bool,
    /// Print figures as JSON
    #[arg(long)]
    pub json: bool,
}

/// `gearmesh compliance`.
#[derive(Debug, Args)]
#[allow(non_snake_case)]
pub struct ComplianceArguments {
    /// Model file
    pub model: PathBuf,
    /// Loaded tooth
    #[arg(long)]
    pub tooth: usize,
    /// Loaded side
    #[arg(long, value_parser = flank_words(), default_value = Flank::Right.name())]
    pub flank: Flank,
    /// Radius of the load; several, separated by commas, give a table
    #[arg(long, value_delimiter = ',', required = true)]
    pub radius_mm: Vec<f64>,
    /// Line load, uniform over the face width
    #[arg(long = "line-load-N-per-mm")]
    pub line_load_N_per_mm: f64,
    /// Half width of the Hertz contact (for the local term)
    #[arg(long)]
    pub half_width_mm: f64,
    /// Tooth at which the deflection is read, same radius and side; the loaded one where not given
    #[arg(long)]
    pub at_tooth: Option<usize>,
    /// Local contact term
    #[arg(long, value_parser = local_words(), default_value = LocalContact::default().name())]
    pub local: LocalContact,
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
    /// Print figures as JSON
    #[arg(long)]
    pub json: bool,
}

/// A number of seconds that is more than zero.
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
    /// Add the stress over the cross-section of both gears of each pair, at the largest torque and the first position;
    /// meshes the gears again
    #[arg(long)]
    pub stress: bool,
    /// Folder of a reference record for each result, in the same order
    #[arg(long)]
    pub reference: Vec<PathBuf>,
}

/// `gearmesh export`.
#[derive(Debug, Args)]
pub struct ExportArguments {
    /// Result file, or folder of a study
    pub result: PathBuf,
    /// Table: .csv, .parquet or .mat (MATLAB, Octave, SciPy)
    #[arg(short, long)]
    pub output: PathBuf,
    /// Table of the result [default: the first; in a .mat file all]. Pairs: curves, contact, torques; multibody: rows,
    /// windows, modes and shapes; of both: ratings
    #[arg(long)]
    pub table: Option<String>,
}

/// `gearmesh signal`.
#[derive(Debug, Args)]
pub struct SignalArguments {
    /// What to compute.
    #[command(subcommand)]
    pub analysis: SignalAnalysis,
}

/// The analyses.
#[derive(Debug, Subcommand)]
pub enum SignalAnalysis {
    /// List the columns of a result
    Columns {
        /// Result of a multibody run in time
        result: PathBuf,
    },
    /// Mean, RMS, peak to peak, kurtosis and crest factor
    Statistics {
        #[command(flatten)]
        series: SeriesArguments,
    },
    /// Amplitudes over frequency, or over the orders of a shaft
    Spectrum {
        #[command(flatten)]
        series: SeriesArguments,
        #[command(flatten)]
        abscissa: AbscissaArguments,
        /// Strongest lines to print
        #[arg(long, default_value_t = 10)]
        peaks: usize,
    },
    /// Lines at a carrier and at multiples of a modulator beside it
    Sidebands {
        #[command(flatten)]
        series: SeriesArguments,
        #[command(flatten)]
        abscissa: AbscissaArguments,
        /// Carrier in Hz, with --shaft in orders: the mesh frequency or number of teeth, or a multiple
        #[arg(long)]
        carrier: f64,
        /// Distance of the sidebands in Hz, with --shaft in orders: the shaft's frequency, or 1
        #[arg(long)]
        modulator: f64,
        /// Sidebands on each side
        #[arg(long, default_value_t = 5)]
        pairs: u32,
        /// Lines beside the nearest one among which the largest is read
        #[arg(long, default_value_t = 0)]
        search_lines: usize,
    },
    /// Envelope of a band, and the spectrum of the envelope
    Envelope {
        #[command(flatten)]
        series: SeriesArguments,
        #[command(flatten)]
        abscissa: AbscissaArguments,
        /// Lower end of the band in Hz, with --shaft in orders
        #[arg(long)]
        low: f64,
        /// Upper end of the band
        #[arg(long)]
        high: f64,
        /// Width of the band's edges [default: a tenth of the band]
        #[arg(long)]
        edge: Option<f64>,
        /// Strongest lines of the envelope's spectrum to print
        #[arg(long, default_value_t = 10)]
        peaks: usize,
    },
    /// Average over the turns of a shaft, or over mesh periods, and what it leaves
    Average {
        #[command(flatten)]
        series: SeriesArguments,
        #[command(flatten)]
        shaft: ShaftArguments,
        /// Periods in a turn: 1 for the shaft itself, its number of teeth for the mesh
        #[arg(long, default_value_t = 1)]
        periods_per_turn: usize,
    },
    /// Orders over the speed of a shaft in a run-up
    Map {
        #[command(flatten)]
        series: SeriesArguments,
        #[command(flatten)]
        shaft: ShaftArguments,
        /// Turns in a block: lines are 1/this apart
        #[arg(long, default_value_t = 4)]
        block_turns: usize,
        /// Turns from one block to the next
        #[arg(long, default_value_t = 1)]
        step_turns: usize,
        /// Orders to print and draw, the strongest ones
        #[arg(long, default_value_t = 5)]
        peaks: usize,
    },
}

impl SignalAnalysis {
    /// The series that is analysed; none where only names are listed.
    pub fn series(&self) -> Option<&SeriesArguments> {
        match self {
            Self::Columns { .. } => None,
            Self::Statistics { series }
            | Self::Spectrum { series, .. }
            | Self::Sidebands { series, .. }
            | Self::Envelope { series, .. }
            | Self::Average { series, .. }
            | Self::Map { series, .. } => Some(series),
        }
    }
}

/// Which series, and where the outcome goes.
#[derive(Debug, Args)]
pub struct SeriesArguments {
    /// Result of a multibody run in time
    pub result: PathBuf,
    /// Column of the result
    pub column: String,
    /// Begin at this time [default: the middle of the run]
    #[arg(long)]
    pub from_s: Option<f64>,
    /// End at this time [default: the end of the run]
    #[arg(long)]
    pub to_s: Option<f64>,
    /// File for the curves: .csv, or .html for a page with a chart
    #[arg(short, long)]
    pub output: Option<PathBuf>,
    /// Print figures as JSON
    #[arg(long)]
    pub json: bool,
}

/// Time or angle, and the window.
#[derive(Debug, Args)]
pub struct AbscissaArguments {
    /// Resample to the angle of this body's shaft: orders in place of Hz
    #[arg(long)]
    pub shaft: Option<String>,
    /// Samples in a turn after resampling [default: as many as the result has]
    #[arg(long, requires = "shaft")]
    pub samples_per_turn: Option<usize>,
    /// Window [default: hann in time; none over whole turns]
    #[arg(long)]
    pub window: Option<WindowKind>,
}

/// The shaft whose angle counts.
#[derive(Debug, Args)]
pub struct ShaftArguments {
    /// Body whose turns count
    #[arg(long)]
    pub shaft: String,
    /// Samples in a turn after resampling [default: as many as the result has]
    #[arg(long)]
    pub samples_per_turn: Option<usize>,
}

/// Windows of a spectrum.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum WindowKind {
    /// All samples alike: for whole periods
    None,
    /// The usual choice
    Hann,
    /// For the amplitudes of single tones
    FlatTop,
}

/// `gearmesh check`.
#[derive(Debug, Args)]
pub struct CheckArguments {
    /// Gear file, bearing file, scene, study, S-N table, record (or its folder), model or result
    pub file: PathBuf,
}

/// `gearmesh study`.
#[derive(Debug, Args)]
pub struct StudyArguments {
    /// Study file
    pub study: PathBuf,
    /// Folder for the results and study.csv; what is there already is not run again
    #[arg(short, long)]
    pub output: PathBuf,
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
    /// Gears
    Gear,
    /// Rolling bearings
    Bearing,
}

/// How balls roll.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ControlWord {
    /// Without spin on the outer race
    OuterRace,
    /// Each ball on the race that lets less power go into spin
    LeastSpin,
}

/// `gearmesh bearing`.
#[derive(Debug, Args)]
#[allow(non_snake_case)]
pub struct BearingArguments {
    /// Bearing file
    pub bearing: PathBuf,
    /// Force on the inner ring along x, y and z, the axis
    #[arg(
        long = "load-N",
        alias = "load",
        value_delimiter = ',',
        num_args = 1,
        required = true,
        allow_hyphen_values = true,
        value_name = "X,Y,Z"
    )]
    pub load_N: Vec<f64>,
    /// Moment on the inner ring about x and y [default: 0,0]
    #[arg(
        long = "moment-Nm",
        value_delimiter = ',',
        num_args = 1,
        allow_hyphen_values = true,
        value_name = "X,Y",
        conflicts_with = "tilt_mrad"
    )]
    pub moment_Nm: Vec<f64>,
    /// Hold the inner ring at this tilt about x and y instead
    #[arg(
        long,
        value_delimiter = ',',
        num_args = 1,
        allow_hyphen_values = true,
        value_name = "X,Y"
    )]
    pub tilt_mrad: Vec<f64>,
    /// Speed of the inner ring: centrifugal force and gyroscopic moment of the rolling elements
    #[arg(long, default_value_t = 0.0, allow_negative_numbers = true)]
    pub speed_rpm: f64,
    /// Speed of the outer ring
    #[arg(long, default_value_t = 0.0, allow_negative_numbers = true)]
    pub outer_speed_rpm: f64,
    /// How balls roll at speed
    #[arg(long, value_enum, default_value = "outer-race")]
    pub control: ControlWord,
    /// Viscosity of the lubricant at the bearing's temperature, for the modified life L10mr; with a speed
    #[arg(long, requires = "contamination")]
    pub viscosity_mm2_per_s: Option<f64>,
    /// Contamination factor e_C of ISO 281: 1 clean, 0 dirty
    #[arg(long, requires = "viscosity_mm2_per_s")]
    pub contamination: Option<f64>,
    /// Print figures as JSON
    #[arg(long)]
    pub json: bool,
}

/// `gearmesh bearing-frequencies`.
#[derive(Debug, Args)]
pub struct BearingFrequenciesArguments {
    /// Bearing file
    pub bearing: PathBuf,
    /// Speed of the inner ring
    #[arg(long, default_value_t = 60.0, allow_negative_numbers = true)]
    pub speed_rpm: f64,
    /// Speed of the outer ring
    #[arg(long, default_value_t = 0.0, allow_negative_numbers = true)]
    pub outer_speed_rpm: f64,
    /// Contact angle under load, instead of the nominal one
    #[arg(long)]
    pub contact_angle_deg: Option<f64>,
    /// Print figures as JSON
    #[arg(long)]
    pub json: bool,
}

/// `gearmesh demo`.
#[derive(Debug, Args)]
pub struct DemoArguments {
    /// Folder for models, results and the report
    #[arg(short, long)]
    pub output: PathBuf,
}
