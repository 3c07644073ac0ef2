//! The gears of a planetary set in plane strain, sun 27, planet 24, ring 75, module 2 mm, each reduced once for all
//! tests of this module.

use gearmesh_geometry::GearDefinition;
use gearmesh_geometry::input::InputDocument;
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_model::ReducedGear;
use gearmesh_reduction::{ReductionOptions, Silent, reduce};
use std::sync::OnceLock;

/// Face width \[m\].
pub const FACE_M: f64 = 10e-3;
/// Harmonics of the planets' bores.
pub const HARMONICS: usize = 32;

/// Fillets of 0.15 modules: no strain is read.
fn made(name: &str, tooth: &str, blank: &str, more: &str) -> ReducedGear {
    let text = format!(
        "name = \"{name}\"\n[tooth]\nmodule_mm = 2.0\nface_width_mm = 10.0\n{tooth}\n[blank]\n{blank}\n\
         [material]\nyoung_GPa = 206.0\npoisson = 0.3\n[mesh]\nplane_strain = true\nelement = \"hex20\"\nfillet_mm = 0.3\n{more}\n"
    );
    let gear = GearDefinition::from_document(&InputDocument::new("plane.toml", text)).unwrap();
    let options = ReductionOptions {
        estimate_error: false,
    };
    let python = PythonEnvironment::find().unwrap();
    reduce(&gear, &python, options, &Silent).unwrap().0
}

/// Bore 20 mm.
pub fn sun() -> &'static ReducedGear {
    static SUN: OnceLock<ReducedGear> = OnceLock::new();
    let tooth = "teeth = 27\nrack_tip_radius = 0.38";
    SUN.get_or_init(|| {
        made(
            "sun",
            tooth,
            "kind = \"solid\"\nbore_diameter_mm = 20.0",
            "",
        )
    })
}

/// Held over its outside of 170 mm.
pub fn ring() -> &'static ReducedGear {
    static RING: OnceLock<ReducedGear> = OnceLock::new();
    let tooth = "teeth = -75\naddendum = 0.8\n[tooth.cutter]\nteeth = 27";
    let blank = "kind = \"ring\"\nouter_diameter_mm = 170.0";
    RING.get_or_init(|| made("ring", tooth, blank, ""))
}

/// Bore 20 mm, or 37 mm (a rim of 1.5 modules), with its motions.
pub fn planet(thin: bool) -> &'static ReducedGear {
    static PLANETS: [OnceLock<ReducedGear>; 2] = [OnceLock::new(), OnceLock::new()];
    let bore_mm = if thin { 37.0 } else { 20.0 };
    let tooth = "teeth = 24\nrack_tip_radius = 0.38";
    let blank = format!("kind = \"solid\"\nbore_diameter_mm = {bore_mm:?}");
    let more = format!("body_mm = 1.0\n[reduction.bore]\nharmonics = {HARMONICS}");
    PLANETS[usize::from(thin)].get_or_init(|| made("planet", tooth, &blank, &more))
}
