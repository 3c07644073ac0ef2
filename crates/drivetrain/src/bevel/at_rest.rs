//! A bevel pair at rest where it is assembled: its flanks at each driver angle, and what a contact meets there.
//!
//! Driver angles count in the sense in which the pinion is driven; at 0 the mean points of both flanks stand in the
//! plane of the axes. Without load the transmission error is the largest of −(gap without approach) over all slices.

use std::f64::consts::TAU;

use gearmesh_bevel::{Assembly, AssemblyError, FlankSide, PairBlank};
use gearmesh_contact::ContactPatch;
use gearmesh_geometry::Flank;
use nalgebra::Matrix3;

use super::sliced_mesh::BevelSlices;
use super::tooth_side::about_z;
use crate::pose::Pose;
use crate::posed_flanks::PosedFlanks;

/// Sections that stand open by more are not looked at first \[m\].
const FIRST_REACH_M: f64 = 60e-6;

/// A bevel pair that rests under load.
#[derive(Debug, Clone)]
pub struct BevelAtRest {
    flanks: BevelSlices,
    assembly: Assembly,
    side: Flank,
}

/// Where a patch touches, besides its places on the flanks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaceAtRest {
    /// Sliding speed of both flanks over the pinion's speed \[m/rad\], gears turning at the teeth's ratio.
    pub sliding_m: f64,
    /// How far from its middle the nearer tip of both gears is \[m\], up the flank.
    pub to_tip_m: f64,
}

impl BevelAtRest {
    /// The pair whose pinion drives with a flank, assembled with an error.
    #[must_use]
    pub fn new(
        blank: &PairBlank,
        flanks: BevelSlices,
        (pinion_flank, error): (FlankSide, &AssemblyError),
    ) -> Self {
        // Right flanks face clockwise.
        let side = match pinion_flank.facing(blank.members[0].hand) < 0.0 {
            true => Flank::Right,
            false => Flank::Left,
        };
        Self {
            flanks,
            assembly: Assembly::new(blank, error),
            side,
        }
    }

    /// Side of the teeth that touches.
    #[must_use]
    pub fn side(&self) -> Flank {
        self.side
    }

    /// The flanks in slices.
    #[must_use]
    pub fn flanks(&self) -> &BevelSlices {
        &self.flanks
    }

    /// Radius \[m\] on the gear at which the transmission error counts: lever of its mean point's normal.
    #[must_use]
    pub fn radius_2_m(&self) -> f64 {
        self.flanks.pair().levers_m()[1]
    }

    /// Number of the pair of teeth that has this tooth of the pinion: the next one comes into mesh a pitch later.
    #[must_use]
    pub fn pair_of(&self, tooth_1: i64) -> i64 {
        let teeth = self.flanks.pair().teeth()[0] as i64;
        let signed = (tooth_1 + teeth / 2).rem_euclid(teeth) - teeth / 2;
        signed * self.side.mirror() as i64
    }

    /// The flanks for a contact.
    #[must_use]
    pub fn posed(&self) -> PosedFlanks<BevelSlices, impl Fn(f64) -> Pose + use<>> {
        let teeth = self.flanks.pair().teeth();
        let ratio = teeth[0] as f64 / teeth[1] as f64;
        let azimuths = self.flanks.pair().azimuths_rad(self.side);
        let (assembly, sense) = (self.assembly, -self.side.mirror());
        let pose_at = move |driver_angle_rad: f64| {
            let turn = sense * driver_angle_rad;
            let turns = [turn - azimuths[0], -ratio * turn - azimuths[1]];
            let axes = [0, 1]
                .map(|m: usize| -> Matrix3<f64> { assembly.members[m].axes * about_z(turns[m]) });
            let apart = assembly.members[1].apex_m - assembly.members[0].apex_m;
            let back = axes[0].transpose();
            Pose::at_rest(back * apart, back * axes[1])
        };
        let flanks = self.flanks.clone().reaching(FIRST_REACH_M);
        PosedFlanks::new(flanks, self.side, self.radius_2_m(), pose_at)
    }

    /// What a patch meets at a driver angle.
    #[must_use]
    pub fn place(&self, driver_angle_rad: f64, patch: &ContactPatch) -> PlaceAtRest {
        let pair = self.flanks.pair();
        let widths_m = pair.face_widths_m();
        let on_flank = |gear: usize| {
            let at = patch.places[gear];
            [at.v / widths_m[gear] + 0.5, at.u]
        };
        let to_tip_m = [0, 1].map(|gear: usize| {
            let [s, v] = on_flank(gear);
            let [here, tip] = [v, 1.0].map(|v| pair.flank_point_m(self.side, gear, [s, v]));
            (tip - here).norm()
        });
        let [pinion, gear] = &self.assembly.members;
        let pitch = TAU / pair.teeth()[0] as f64;
        let azimuth = pair.azimuths_rad(self.side)[0];
        let turn = -self.side.mirror() * driver_angle_rad - azimuth;
        let turned = about_z(turn + patch.teeth[0] as f64 * pitch);
        let point = turned * pair.flank_point_m(self.side, 0, on_flank(0));
        let r = pinion.axes * point + pinion.apex_m;
        let v = pinion.axis().cross(&(r - pinion.apex_m))
            + gear.axis().cross(&(r - gear.apex_m)) * self.assembly.ratio;
        PlaceAtRest {
            sliding_m: v.norm(),
            to_tip_m: f64::min(to_tip_m[0], to_tip_m[1]),
        }
    }
}
