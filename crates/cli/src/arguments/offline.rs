//! Arguments of the commands that mesh and reduce a gear, and of the deflections of a reduced one.

use crate::file_words::{flank_words, length_words, local_words};
use clap::Args;
use gearmesh_contact::LocalContact;
use gearmesh_geometry::Flank;
use gearmesh_operations::mesh_file::LengthUnit;
use std::path::PathBuf;

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
    #[arg(long, value_parser = length_words(), default_value = "m")]
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
