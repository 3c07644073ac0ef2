//! The model of the gear meshes of an imported scene.

use crate::running::{DAMPING_S, Running};
use crate::text::number;

/// What the gear meshes of a scene are computed with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Meshes {
    /// The springs of ISO 6336, without reduced gears.
    #[default]
    Iso6336,
    /// The contact of reduced gears, whose models lie beside the gear files: `GEAR.h5`.
    Hybrid,
}

impl Meshes {
    /// What a body names as its gear.
    pub fn gear(self, file: &str) -> String {
        match self {
            Self::Iso6336 => file.to_owned(),
            Self::Hybrid => model_file(file),
        }
    }
}

/// The model of a gear file.
pub fn model_file(gear_file: &str) -> String {
    format!("{}.h5", gear_file.trim_end_matches(".toml"))
}

/// The keys of a `model` table.
pub fn mesh_model(with: Meshes, running: Running) -> String {
    let model = match with {
        Meshes::Iso6336 => "kind = \"iso6336\", slices = 9",
        Meshes::Hybrid => "kind = \"hybrid\"",
    };
    match running {
        Running::AtRest => model.to_owned(),
        Running::InTime => format!(
            "{model}, damping = {{ kind = \"stiffness-proportional\", time_s = {}, full_depth_um = 1.0 }}",
            number(DAMPING_S)
        ),
    }
}
