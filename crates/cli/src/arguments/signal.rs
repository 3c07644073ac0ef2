//! Arguments of `gearmesh signal`.

use clap::{Args, Subcommand, ValueEnum};
use std::path::PathBuf;

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
        /// Print them as JSON
        #[arg(long)]
        json: bool,
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
        #[command(flatten)]
        bearing: BearingLineArguments,
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
        /// Orders to print, the strongest ones
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

/// A bearing whose frequencies are marked.
#[derive(Debug, Args)]
pub struct BearingLineArguments {
    /// Bearing file: mark its FTF, BSF, BPFO and BPFI in the envelope's spectrum
    #[arg(long)]
    pub bearing: Option<PathBuf>,
    /// Speed of the bearing's inner ring against its outer one; not with --shaft
    #[arg(long, requires = "bearing", allow_negative_numbers = true)]
    pub speed_rpm: Option<f64>,
    /// Contact angle of the bearing under load, instead of the nominal one
    #[arg(long, requires = "bearing")]
    pub contact_angle_deg: Option<f64>,
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
