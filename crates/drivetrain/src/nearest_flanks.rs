//! Ideal flanks at mid-face whether teeth are there or not: how far the nearest pair stands open, and whether any can
//! touch at all.
//!
//! All pairs of ideal flanks of one side have the same transverse gap but for whole base pitches,
//!
//! ```text
//! g = L − r_b1 ξ₁ − r_b2 ξ₂   (mod p_b),      p_b = 2π r_b1/z₁,      |g| ≤ p_b/2 for the nearest pair
//! ```
//!
//! so that the gap goes on where no tooth reaches the mate: its flanks are then continued as involutes. Gears are apart
//! from a = r_a1 + r_a2 on, a² = L² + (r_b1 + r_b2)². With a ring a and its radii are negative.

use std::f64::consts::TAU;

use gearmesh_geometry::Flank;

use crate::gear_mesh::GearMesh;
use crate::mesh_kinematics::MeshKinematics;
use crate::pose_geometry::PoseGeometry;
use crate::slice_plane::{CentreLine, SlicePlane, ToothZero};

impl MeshKinematics {
    /// Base pitch \[m\], in the transverse plane.
    #[must_use]
    pub fn base_pitch_m(&self) -> f64 {
        let gear = &self.gears[0];
        TAU * gear.base_radius_m / gear.teeth as f64
    }

    /// Gap \[m\] of ideal flanks of one side in the middle of the zone if no flanks of that side can touch at a pose
    /// that has been located; none if some might. Spur teeth only: in each plane all their pairs have the same ideal
    /// gap.
    pub(crate) fn open_gap_m(&self, at: &PoseGeometry, side: Flank) -> Option<f64> {
        let middle = at.middle.as_ref().filter(|_| self.helix.is_none())?;
        let frame = at.frame.as_ref()?;
        let (circles, sigma) = (&self.circles, self.circles.hand(side));
        let rolls = |plane: &SlicePlane| ToothZero::rolls_rad(&self.gears, frame, sigma, plane);
        let plane = middle.plane(frame, sigma);
        let [roll_1, roll_2] = rolls(&plane);
        let touching = circles.mate_roll_rad(plane.length_m, (0, roll_1));
        let pitch_2 = self.pitch_rad(1);
        let ahead_2 = ((roll_2 - touching) / pitch_2).round() * pitch_2;
        let gap_m = |plane: &SlicePlane, [roll_1, roll_2]: [f64; 2]| {
            circles.gap_m(plane.length_m, [roll_1, roll_2 - ahead_2])
        };
        let middle_gap_m = gap_m(&plane, [roll_1, roll_2]);
        let is_open = |(slice, line): (usize, &CentreLine)| {
            if Some(slice) == at.middle_slice() {
                return middle_gap_m > self.most_added_m;
            }
            let plane = line.plane(frame, sigma);
            gap_m(&plane, rolls(&plane)) > self.most_added_m
        };
        let mut slices = at.slices.iter().enumerate();
        slices.all(is_open).then_some(middle_gap_m)
    }

    /// Transverse gap \[m\] in the middle of the zone of the pair of ideal flanks that is nearest, continued beyond
    /// their ends: at most half a base pitch open or overlapping. None at a pose that has not been located.
    pub(crate) fn nearest_gap_m(&self, at: &PoseGeometry, side: Flank) -> Option<f64> {
        let frame = at.frame.as_ref()?;
        let (circles, sigma) = (&self.circles, self.circles.hand(side));
        let plane = at.middle.as_ref()?.plane(frame, sigma);
        let zero = ToothZero::new(&self.gears, frame, sigma, &plane);
        let pitch_m = self.base_pitch_m();
        let gap_m = |rolls: [f64; 2]| circles.gap_m(plane.length_m, rolls);
        let mut nearest_m = gap_m(zero.roll_rad);
        if let Some(helix) = &self.helix {
            let [roll_1, roll_2] = zero.roll_rad;
            // The height of the contact is that of the nearest tooth of gear 2.
            let at_mid_face = gap_m(helix.mid_face_rolls_rad(&plane, &zero, sigma));
            let behind_2 = (at_mid_face / pitch_m).round() * circles.sense(1) * self.pitch_rad(1);
            let plain = ([roll_1, roll_2 + behind_2], sigma);
            nearest_m = helix.flanks((frame, &plane), &zero, plain, None).gap_m / helix.cos;
        }
        Some(nearest_m - pitch_m * (nearest_m / pitch_m).round())
    }

    /// Whether no tooth reaches the mate at a located pose: the tip circles clear each other, or the faces no longer
    /// overlap.
    pub(crate) fn is_apart(&self, at: &PoseGeometry) -> bool {
        let circles = &self.circles;
        let tip = |gear: usize| circles.sense(gear) * self.gears[gear].tip_radius_m;
        let distance_m = |line: &CentreLine| line.length_m.hypot(circles.sum_m());
        let clear =
            |line: &CentreLine| circles.signed_distance_m(distance_m(line)) >= tip(0) + tip(1);
        (at.middle.as_ref()).is_some_and(|line| at.slices.is_empty() || clear(line))
    }
}

impl GearMesh {
    /// Transverse gap \[m\] of the nearest ideal flanks at the last pose, continued beyond the ends of the teeth: of
    /// two sides that of the one which is nearer, as the transmission error.
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
