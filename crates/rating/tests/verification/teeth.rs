//! Teeth for the tests.

use gearmesh_geometry::{ToothDefinition, ToothGeometry};

/// Module 1 mm, so that lengths in mm are in modules.
pub const MODULE_M: f64 = 1e-3;

/// A standard tooth: pressure angle 20°, addendum 1, dedendum 1.25, rack tip radius 0.3.
pub fn standard(teeth: usize) -> ToothDefinition {
    ToothDefinition {
        teeth,
        gearing: Default::default(),
        module_m: MODULE_M,
        pressure_angle_rad: 20f64.to_radians(),
        profile_shift: 0.0,
        addendum: 1.0,
        dedendum: 1.25,
        rack_tip_radius: 0.3,
        tip_diameter_m: None,
        thickness_allowance_m: 0.0,
        tip_chamfer_m: 0.0,
        face_width_m: 10e-3,
        helix_angle_rad: 0.0,
    }
}

pub fn geometry(definition: &ToothDefinition) -> ToothGeometry {
    ToothGeometry::new(definition).unwrap()
}
