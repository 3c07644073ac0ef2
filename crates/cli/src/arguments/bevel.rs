//! Arguments of `bevel` and `tca`.

use std::path::PathBuf;

use clap::Args;

/// `gearmesh bevel`.
#[derive(Debug, Args)]
pub struct BevelArguments {
    /// Bevel pair file
    pub pair: PathBuf,
    /// Write nominal points and normals of all four flanks for a measuring machine into this folder: pinion-concave.csv
    /// and so on
    #[arg(long, value_name = "FOLDER")]
    pub grid: Option<PathBuf>,
    /// Sectors along the face and heights up the flank of the nominal points
    #[arg(long, num_args = 2, value_names = ["SECTORS", "HEIGHTS"], default_values_t = [9, 5], requires = "grid",
        value_parser = clap::value_parser!(u16).range(3..=99))]
    pub grid_size: Vec<u16>,
    /// Print figures as JSON
    #[arg(long)]
    pub json: bool,
}

/// `gearmesh tca`.
#[derive(Debug, Args)]
#[allow(non_snake_case)]
pub struct TcaArguments {
    /// Bevel pair file
    pub pair: PathBuf,
    /// Page with pictures: contact pattern, transmission error, ease-off
    #[arg(long, value_name = "PAGE.html")]
    pub report: Option<PathBuf>,
    /// Add the stress in the bodies of both members to the page, at the largest torque where their root stress is largest; needs load.models
    #[arg(long, requires = "report")]
    pub stress: bool,
    /// Write the displacement and von Mises field of this member, too: 1 the pinion, 2 the gear
    #[arg(long, requires = "field_output", value_parser = clap::value_parser!(u8).range(1..=2))]
    pub field_gear: Option<u8>,
    /// Turn of the pinion of the field, the nearest computed position is taken; where one pair of teeth carries most where not given
    #[arg(long, allow_negative_numbers = true, requires = "field_gear")]
    pub field_angle_deg: Option<f64>,
    /// Torque of the field; the largest computed one where not given
    #[arg(
        long = "field-torque-Nm",
        allow_negative_numbers = true,
        requires = "field_gear"
    )]
    pub field_torque_Nm: Option<f64>,
    /// Mesh file of the field (vtu, ...)
    #[arg(long, requires = "field_gear")]
    pub field_output: Option<PathBuf>,
    /// Print figures as JSON
    #[arg(long)]
    pub json: bool,
}
