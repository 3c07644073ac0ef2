//! What both gears share at a pose: the axis halfway between theirs, and where their faces overlap along it.
//!
//! With e_z and b the axes of gear 1 and gear 2, h = e_z + b, t = h/(1 + b_z), f = (b − e_z)/2 and c = h/|h|,
//!
//! ```text
//! D′ = t·u     axial displacement of gear 2's origin,            ∂D′ = (t, b × (u − D′ e_z)/(1 + b_z))
//! F  = f·u     twice how far the pitch point lies before halfway, ∂F  = (f, ½ b × u)
//! D  = D′ − F (r_b1 − r_b2)/(r_b1 + r_b2)                         the displacement of the faces at the pitch point
//! ```
//!
//! A plane across c cuts the axes at z₁ = s + F/2 + D′/2 and z₂ = s + F/2 − D′/2 of the gears' origins, s counted at
//! the pitch point from halfway between the mid-faces. Exchanging the gears changes the signs of u, f, D′ and D, and
//! nothing else: what follows from this frame does not know which gear is the first.

use gearmesh_contact::ContactZone;
use gearmesh_geometry::BaseCircles;
use nalgebra::{Matrix3, Vector3};

use crate::pose::{Pose, Vector6, stacked};

/// The frame at a pose; all vectors in gear 1's axes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MeshFrame {
    /// r_b1 and r_b2.
    pub circles: BaseCircles,
    /// u.
    pub displacement_m: Vector3<f64>,
    /// b.
    pub axis_2: Vector3<f64>,
    /// c.
    pub axis: Vector3<f64>,
    /// f.
    pub half_tilt: Vector3<f64>,
    /// t = ∂γ/∂ϑ.
    pub spin_gradient: Vector3<f64>,
    /// γ: turn of gear 2 against gear 1 about their own axes \[rad\].
    pub spin_rad: f64,
    /// ∂m/∂ϑ: turn about c of the frame in which polar angles are counted, the shortest rotation of gear 1's to c.
    pub frame_turn: Vector3<f64>,
    /// The axes of that frame across c.
    across: [Vector3<f64>; 2],
    /// D′ \[m\] and ∂D′.
    pub displacement_along_m: f64,
    pub displacement_along_gradient: Vector6,
    /// F \[m\] and ∂F.
    shift_m: f64,
    shift_gradient: Vector6,
    /// ∂D.
    pub displacement_gradient: Vector6,
    /// The overlap of the faces at D.
    pub zone: ContactZone,
}

impl MeshFrame {
    /// The frame of two gears with faces `face_widths_m` wide at a pose.
    pub(crate) fn new(circles: BaseCircles, face_widths_m: [f64; 2], pose: &Pose) -> Self {
        let (u, b) = (pose.displacement_m, pose.axis_2());
        let sum = Vector3::z() + b;
        let below = 1.0 + b[2];
        let half_tilt = 0.5 * (b - Vector3::z());
        let spin_gradient = sum / below;
        let cos_half = (0.5 * below).sqrt();
        let axis = sum / (2.0 * cos_half);
        let frame_turn = (b[2] * b - Vector3::z()) / (2.0 * below * (1.0 + cos_half));
        let lean = (Vector3::z() + axis) / (1.0 + cos_half);
        let across = [Vector3::x() - axis[0] * lean, Vector3::y() - axis[1] * lean];
        let along_m = spin_gradient.dot(&u);
        let along_gradient = stacked(
            spin_gradient,
            b.cross(&(u - along_m * Vector3::z())) / below,
        );
        let shift_m = half_tilt.dot(&u);
        let shift_gradient = stacked(half_tilt, 0.5 * b.cross(&u));
        Self {
            circles,
            displacement_m: u,
            axis_2: b,
            axis,
            half_tilt,
            spin_gradient,
            spin_rad: pose.spin_rad(),
            frame_turn,
            across,
            displacement_along_m: along_m,
            displacement_along_gradient: along_gradient,
            shift_m,
            shift_gradient,
            displacement_gradient: along_gradient - circles.pitch_place() * shift_gradient,
            zone: ContactZone::new(face_widths_m, pose.face_displacement_m(circles)),
        }
    }

    /// Polar angle of a direction across c \[rad\].
    pub(crate) fn polar_rad(&self, direction: &Vector3<f64>) -> f64 {
        direction
            .dot(&self.across[1])
            .atan2(direction.dot(&self.across[0]))
    }

    /// The section of the zone at `place` of its width, −½ to ½.
    pub(crate) fn section(&self, place: f64) -> ZoneSection {
        let zone = &self.zone;
        let section_m = zone.middle_m + place * zone.width_m;
        let moves = zone.middle_by_displacement + place * zone.width_by_displacement;
        let (plane_m, half_m) = (
            section_m + 0.5 * self.shift_m,
            0.5 * self.displacement_along_m,
        );
        let gradient = moves * self.displacement_gradient;
        ZoneSection {
            section_m,
            heights_m: zone.heights_m(section_m),
            axis_heights_m: [plane_m + half_m, plane_m - half_m],
            gradient,
            plane_gradient: gradient + 0.5 * self.shift_gradient,
        }
    }
}

/// A section of the contact zone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ZoneSection {
    /// s \[m\].
    pub section_m: f64,
    /// Places on the faces of gear 1 and gear 2 at the pitch point, from their mid-faces \[m\].
    pub heights_m: [f64; 2],
    /// z₁ and z₂: where the plane cuts the axes, from the gears' origins \[m\].
    pub axis_heights_m: [f64; 2],
    /// ∂s.
    pub gradient: Vector6,
    /// ∂(s + F/2).
    pub plane_gradient: Vector6,
}

/// ∂t/∂ϑ at parallel axes, −½ e_z ×.
pub(crate) fn turn_of_spin_gradient() -> Matrix3<f64> {
    -0.5 * Vector3::z().cross_matrix()
}
