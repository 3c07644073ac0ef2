//! Arguments of `gearmesh record`.

use clap::{Args, ValueEnum};
use gearmesh_operations::compare::head_and_column;
use gearmesh_report::Shaft;
use std::path::PathBuf;

/// `gearmesh record`.
#[derive(Debug, Args)]
pub struct RecordArguments {
    /// Measured curves: CSV with units (.csv .txt), or a universal file (.uff .unv .uf)
    pub measured: PathBuf,
    /// Folder for record.toml and data.csv; without it the channels of the file are listed
    #[arg(short, long, requires_all = ["title", "source", "angle_origin"])]
    pub output: Option<PathBuf>,
    /// Which channel a column of the record takes; may be given several times [default: channels that are called like
    /// columns]
    #[arg(long, value_name = "HEAD=CHANNEL", value_parser = head_and_column, requires = "output")]
    pub column: Vec<(String, String)>,
    /// Title of the record
    #[arg(long, requires = "output")]
    pub title: Option<String>,
    /// Where the numbers come from: rig, date, person
    #[arg(long, requires = "output")]
    pub source: Option<String>,
    /// What angle 0 is
    #[arg(long, requires = "output")]
    pub angle_origin: Option<String>,
    /// Whose angle it is
    #[arg(long, value_enum, default_value = "gear_1")]
    pub shaft: ShaftWord,
    /// Revolutions of that shaft after which the record repeats
    #[arg(long, default_value = "1", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub revolutions: u32,
    /// Channel that is the angle [default: the axis of a universal file, the first column of a CSV file]
    #[arg(long, value_name = "CHANNEL")]
    pub angle: Option<String>,
    /// Where the axis is a time: constant speed of the shaft
    #[arg(long, value_parser = super::positive, requires = "output")]
    pub speed_rpm: Option<f64>,
    /// Begin of the revolutions, as the file counts angles [default: the first]
    #[arg(long, allow_negative_numbers = true, requires = "output")]
    pub from_deg: Option<f64>,
    /// Added to the angle, so that 0 is what --angle-origin says
    #[arg(long, allow_negative_numbers = true, default_value = "0")]
    pub angle_offset_deg: f64,
    /// Where the transmission error is an angle: base radius of the gear whose angle it is
    #[arg(long, value_parser = super::positive, requires = "output")]
    pub base_radius_mm: Option<f64>,
    /// Change the sign of a column of the record; may be given several times
    #[arg(long, value_name = "HEAD", requires = "output")]
    pub negate: Vec<String>,
    /// State the unit of a channel or of the axis; may be given several times
    #[arg(long, value_name = "CHANNEL=UNIT", value_parser = head_and_column)]
    pub unit: Vec<(String, String)>,
    /// Print channels or columns as JSON
    #[arg(long)]
    pub json: bool,
}

/// Shaft of a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ShaftWord {
    /// The driver
    #[value(name = "gear_1")]
    Gear1,
    /// The driven gear
    #[value(name = "gear_2")]
    Gear2,
}

impl From<ShaftWord> for Shaft {
    fn from(word: ShaftWord) -> Self {
        match word {
            ShaftWord::Gear1 => Self::Gear1,
            ShaftWord::Gear2 => Self::Gear2,
        }
    }
}
