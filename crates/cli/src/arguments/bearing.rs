//! Arguments of the commands for rolling bearings.

use clap::{Args, ValueEnum};
use std::path::PathBuf;

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
    /// Page with pictures: loads round the bearing, contact angles, pressures
    #[arg(long, value_name = "PAGE.html")]
    pub report: Option<PathBuf>,
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
