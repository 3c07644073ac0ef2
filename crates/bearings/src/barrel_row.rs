//! A row of barrel rollers between the inner ring's groove and the sphere inside the outer ring: half a spherical
//! roller bearing.
//!
//! Rollers and cage tilt with the inner ring, so that everything is reported in its axes: each roller stays in an axial
//! plane of the inner ring, and the outer ring is a sphere of which only the middle counts. All forces of the outer
//! ring go through that middle; the bearing resists no tilt about it. Formulas (22) to (24) of
//! docs/theory/rolling_bearings.md.

use crate::line_contact::LineContact;

/// A lamina of a barrel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BarrelLamina {
    /// Place along the roller's axis from its middle \[m\].
    pub place_m: f64,
    /// Radius of the roller there \[m\].
    pub reach_m: f64,
}

/// A row of barrels.
#[derive(Debug, Clone, PartialEq)]
pub struct BarrelRow {
    /// Number of rollers.
    pub rollers: usize,
    /// Angle of the first roller \[rad\].
    pub first_angle_rad: f64,
    /// d_m/2 \[m\].
    pub pitch_radius_m: f64,
    /// Largest diameter \[m\].
    pub diameter_m: f64,
    /// Middle of a roller without load, (r, z) in the inner ring's axial plane \[m\].
    pub middle_m: (f64, f64),
    /// Direction across a roller away from the axis, (cos α, ± sin α).
    pub across: (f64, f64),
    /// Laminae.
    pub laminae: Vec<BarrelLamina>,
    /// Length of a lamina \[m\].
    pub lamina_length_m: f64,
    /// Centre of the inner groove's profile, (r, z) \[m\].
    pub groove_centre_m: (f64, f64),
    /// Its radius \[m\].
    pub groove_radius_m: f64,
    /// Radius of the sphere inside the outer ring \[m\].
    pub sphere_radius_m: f64,
    /// Contacts of a lamina with the inner and outer race.
    pub contacts: [LineContact; 2],
}
