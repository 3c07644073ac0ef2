//! Ideal flanks at mid-face whether teeth are there or not: how far the nearest pair stands open, and whether any can touch at all.
//!
//! All pairs of ideal flanks of one side have the same transverse gap but for whole base pitches,
//!
//! ```text
//! g = L − r_b1 ξ₁ − r_b2 ξ₂   (mod p_b),      p_b = 2π r_b1/z₁,      |g| ≤ p_b/2 for the nearest pair
//! ```
//!
//! so that the gap goes on where no tooth reaches the mate: its flanks are then continued as involutes. Gears are apart from a = r_a1 + r_a2 on,
//! a² = L² + (r_b1 + r_b2)².

use std::f64::consts::TAU;

use gearmesh_geometry::{Flank, ToothGeometry};

use crate::gear_mesh::GearMesh;
use crate::mesh_frame::PoseGeometry;
use crate::mesh_kinematics::MeshKinematics;
use crate::slice_plane::CentreLine;
use crate::tooth_zero::ToothZero;

impl MeshKinematics {
    /// Base pitch \[m\], in the transverse plane.
    #[must_use]
    pub fn base_pitch_m(&self) -> f64 {
        let gear = &self.gears[0];
        TAU * gear.base_radius_m / gear.teeth as f64
    }

    /// Transverse gap \[m\] in the middle of the zone of the pair of ideal flanks that is nearest, continued beyond their ends: at most half a base
    /// pitch open or overlapping. None at a pose that has not been located.
    pub(crate) fn nearest_gap_m(&self, at: &PoseGeometry, side: Flank) -> Option<f64> {
        let frame = at.frame.as_ref()?;
        let plane = at.middle.as_ref()?.plane(frame, side);
        let [r1, r2] = [self.gears[0].base_radius_m, self.gears[1].base_radius_m];
        let zero = ToothZero::new(&self.gears, frame, side, &plane);
        let pitch_m = self.base_pitch_m();
        let gap_m = |rolls: [f64; 2]| plane.length_m - r1 * rolls[0] - r2 * rolls[1];
        let mut nearest_m = gap_m(zero.roll_rad);
        if let Some(helix) = &self.helix {
            let sigma = side.mirror();
            let [roll_1, roll_2] = zero.roll_rad;
            // The height of the contact is that of the nearest tooth of gear 2.
            let at_mid_face = gap_m(helix.mid_face_rolls_rad(&plane, &zero, sigma));
            let behind_2 = (at_mid_face / pitch_m).round() * self.pitch_rad(1);
            let plain = ([roll_1, roll_2 + behind_2], sigma);
            nearest_m = helix.flanks((frame, &plane), &zero, plain, None).gap_m / helix.cos;
        }
        Some(nearest_m - pitch_m * (nearest_m / pitch_m).round())
    }

    /// Whether no tooth reaches the mate at a located pose: the tip circles clear each other, or the faces no longer overlap.
    pub(crate) fn is_apart(&self, at: &PoseGeometry) -> bool {
        let [base, tip] = [0, 1].map(|i: usize| {
            let of = |gear: &ToothGeometry| [gear.base_radius_m, gear.tip_radius_m][i];
            of(&self.gears[0]) + of(&self.gears[1])
        });
        let clear = |line: &CentreLine| line.length_m.hypot(base) >= tip;
        (at.middle.as_ref()).is_some_and(|line| at.slices.is_empty() || clear(line))
    }
}

impl GearMesh {
    /// Transverse gap \[m\] of the nearest ideal flanks at the last pose, continued beyond the ends of the teeth: of two sides that of the one
    /// which is nearer, as the transmission error.
    #[must_use]
    pub fn nearest_gap_m(&self) -> Option<f64> {
        let gaps = self.flanks();
        let gaps = gaps.filter_map(|flank| self.kinematics().nearest_gap_m(flank));
        gaps.min_by(f64::total_cmp)
    }

    /// Whether no tooth reached the mate at the last pose: tip circles clear, or faces side by side.
    #[must_use]
    pub fn is_apart(&self) -> bool {
        self.kinematics().is_apart()
    }
}
