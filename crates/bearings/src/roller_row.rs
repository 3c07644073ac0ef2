//! A row of rollers between two races.

use crate::line_contact::LineContact;
use crate::operation::Operation;

/// A lamina.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lamina {
    /// Place along the roller's axis from its middle, positive towards the large end \[m\].
    pub place_m: f64,
    /// Length \[m\].
    pub length_m: f64,
    /// Distance of the roller's surface from its axis along the race's normal, the profile taken off \[m\].
    pub reach_m: f64,
}

/// A conical race: points p = (r, z) with n·p = h, n = (cos α, sin α) its normal away from the axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Race {
    /// n, in the ring's axial plane.
    pub normal: (f64, f64),
    /// h \[m\].
    pub offset_m: f64,
    /// Contact with a roller.
    pub contact: LineContact,
}

/// The rib on the inner ring that a tapered roller's large end leans on: plane against sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rib {
    /// Centre of the sphere on the roller's axis, from the roller's middle \[m\].
    pub centre_m: f64,
    /// From the sphere's centre to the rib, in the ring's axial plane.
    pub normal: (f64, f64),
    /// n·p at which the sphere's centre just lets the end touch \[m\].
    pub offset_m: f64,
    /// k in Q = k δ^1.5 \[N/m^1.5\].
    pub stiffness_n_per_m15: f64,
}

/// A row of rollers.
#[derive(Debug, Clone, PartialEq)]
pub struct RollerRow {
    /// Number of rollers.
    pub rollers: usize,
    /// Angle of the first roller \[rad\].
    pub first_angle_rad: f64,
    /// d_m/2 \[m\].
    pub pitch_radius_m: f64,
    /// Mean diameter \[m\].
    pub diameter_m: f64,
    /// Place of the rollers' middles without load \[m\].
    pub middle_z_m: f64,
    /// Direction of the roller's axis towards its large end, (r, z).
    pub axis: (f64, f64),
    /// Laminae.
    pub laminae: Vec<Lamina>,
    /// Race of the inner ring, in its frame.
    pub inner: Race,
    /// Race of the outer ring.
    pub outer: Race,
    /// Rib; none for cylindrical rollers, which do not move along z.
    pub rib: Option<Rib>,
    /// Mass of a roller \[kg\].
    pub mass_kg: f64,
    /// Moments of inertia about its axis and across it \[kg·m²\].
    pub inertia_kg_m2: (f64, f64),
    /// Rollers that are not there, in rising order.
    pub missing: Vec<usize>,
}

impl RollerRow {
    /// Angle of a roller \[rad\].
    #[must_use]
    pub fn angle_rad(&self, roller: usize, operation: &Operation) -> f64 {
        operation.element_angle_rad(self.first_angle_rad, roller, self.rollers)
    }
}
