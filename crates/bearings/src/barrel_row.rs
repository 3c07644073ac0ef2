//! A row of barrel rollers between the inner ring's groove and the sphere inside the outer ring: half a spherical
//! roller bearing.
//!
//! Rollers and cage tilt with the inner ring, so that everything is reported in its axes: each roller stays in an axial
//! plane of the inner ring, and the outer ring is a sphere of which only the middle counts. All forces of the outer
//! ring go through that middle; the bearing resists no tilt about it. Formulas (22) to (24) of
//! docs/theory/rolling_bearings.md.

use nalgebra::{Matrix3, Vector3};

use crate::barrel_equilibrium::Barrel;
use crate::element_load::ElementLoad;
use crate::element_place::ElementPlace;
use crate::error::BearingError;
use crate::line_contact::LineContact;
use crate::operation::Operation;
use crate::ring_load::RingLoad;
use crate::ring_pose::RingPose;

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

/// The least turn that takes the axis z to the ring's axis a, and how the ring's frame turns with a rotation of the
/// ring about fixed axes: by W δφ, W = P − a (e_z P)/(1 + a_z), P = 1 − a aᵀ.
pub(crate) fn least_turn(a: &Vector3<f64>) -> (Matrix3<f64>, Matrix3<f64>) {
    let share = 1.0 / (1.0 + a.z);
    let turn = Matrix3::new(
        1.0 - a.x * a.x * share,
        -a.x * a.y * share,
        a.x,
        -a.x * a.y * share,
        1.0 - a.y * a.y * share,
        a.y,
        -a.x,
        -a.y,
        a.z,
    );
    let across = Matrix3::identity() - a * a.transpose();
    let by_turn = across - a * (across.row(2) * share);
    (turn, by_turn)
}

impl BarrelRow {
    /// Adds what the row does to the ring, and hands every roller's load to `each`. The search of each roller begins at
    /// its place in the inner ring's axes, which it leaves where it ends.
    ///
    /// # Errors
    /// [`BearingError::NoRollerEquilibrium`].
    pub(crate) fn add(
        &self,
        pose: &RingPose,
        operation: &Operation,
        places: &mut [ElementPlace],
        ring: &mut RingLoad,
        mut each: impl FnMut(ElementLoad),
        mut each_lamina: impl FnMut(f64, f64),
    ) -> Result<(), BearingError> {
        let (turn, by_turn) = least_turn(&pose.axis);
        let sphere = -(turn.tr_mul(&pose.centre_m));
        let ratio = 0.5 * self.diameter_m * self.across.0 / self.pitch_radius_m;
        let (inner, outer) = (operation.inner_rad_per_s, operation.outer_rad_per_s);
        let orbit = 0.5 * (inner * (1.0 - ratio) + outer * (1.0 + ratio));
        let (mut force, mut by_sphere) = (Vector3::zeros(), Matrix3::zeros());
        for (number, place) in places.iter_mut().enumerate() {
            let angle_rad = operation.element_angle_rad(self.first_angle_rad, number, self.rollers);
            let (sine, cosine) = angle_rad.sin_cos();
            let axes = Matrix3::new(cosine, -sine, 0.0, sine, cosine, 0.0, 0.0, 0.0, 1.0);
            let barrel = Barrel {
                row: self,
                sphere: axes.tr_mul(&sphere),
                number,
                angle_rad,
            };
            let (mut load, pressed, change) = barrel.rest(place, &mut each_lamina)?;
            force += axes * pressed;
            by_sphere += axes * change * axes.transpose();
            load.orbit_rad_per_s = orbit;
            each(load);
        }
        // What the rollers press the sphere with they press the ring with the other way, through the sphere's middle.
        let force: Vector3<f64> = -(turn * force);
        let stiffness = turn * by_sphere * turn.transpose();
        let (arm, hold) = (pose.centre_m.cross_matrix(), force.cross_matrix());
        let by_rotation = (stiffness * arm - hold) * by_turn;
        let mut part = ring.load.fixed_rows_mut::<3>(0);
        part += force;
        let mut part = ring.load.fixed_rows_mut::<3>(3);
        part -= pose.centre_m.cross(&force);
        let mut block = ring.tangent.fixed_view_mut::<3, 3>(0, 0);
        block += stiffness;
        let mut block = ring.tangent.fixed_view_mut::<3, 3>(0, 3);
        block += by_rotation;
        let mut block = ring.tangent.fixed_view_mut::<3, 3>(3, 0);
        block += hold - arm * stiffness;
        let mut block = ring.tangent.fixed_view_mut::<3, 3>(3, 3);
        block -= arm * by_rotation;
        Ok(())
    }
}
