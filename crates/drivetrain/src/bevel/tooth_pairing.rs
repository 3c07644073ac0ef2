//! Which teeth of a bevel pair face each other at a pose.

use std::f64::consts::TAU;

use gearmesh_geometry::Flank;

use super::bevel_mesh::BevelMesh;
use super::tooth_side::REACH;
use crate::pose::Pose;

/// Pairs of teeth that are looked at.
pub(super) const MOST_PAIRS: usize = 2 * REACH as usize + 1;

/// A pair of teeth that may touch.
pub(super) struct Candidate {
    pub teeth: [usize; 2],
    pub turns_rad: [f64; 2],
    /// Of gear 1's mean point from the plane of the axes.
    pub angle_1_rad: f64,
    /// Gap that the mean points would have \[m\].
    pub mean_gap_m: f64,
}

impl BevelMesh {
    /// Pairs of teeth whose flanks may face each other; the one nearest to the plane of the axes first.
    pub(super) fn candidates(&self, pose: &Pose, flank: Flank) -> impl Iterator<Item = Candidate> {
        let side = &self.sides[flank as usize];
        let (b, k) = (
            pose.axis_2(),
            pose.rotation.transpose().column(2).into_owned(),
        );
        // Where the plane of the axes stands, seen in each gear.
        let zones = [b[1].atan2(b[0]), k[1].atan2(k[0])];
        let pitches = self.teeth.map(|z| TAU / z as f64);
        let [from_1, from_2] = [0, 1].map(|m: usize| side.azimuths_rad[m] - zones[m]);
        let middle = -(from_1 / pitches[0]).round() as i64;
        let reach = REACH.min(0.5 * self.teeth[0] as f64 - 1.0) as i64;
        let (teeth, lever, sigma) = (self.teeth, side.levers_m[1], flank.mirror());
        let outwards = (0..=2 * reach).map(|i| if i % 2 == 0 { -i / 2 } else { (i + 1) / 2 });
        outwards.map(move |ahead| {
            let tooth_1 = middle + ahead;
            let angle_1 = from_1 + tooth_1 as f64 * pitches[0];
            let wanted_2 = -angle_1 * teeth[0] as f64 / teeth[1] as f64;
            let tooth_2 = ((wanted_2 - from_2) / pitches[1]).round();
            let behind = from_2 + tooth_2 * pitches[1] - wanted_2;
            Candidate {
                teeth: [
                    tooth_1.rem_euclid(teeth[0] as i64),
                    (tooth_2 as i64).rem_euclid(teeth[1] as i64),
                ]
                .map(|tooth| tooth as usize),
                angle_1_rad: angle_1,
                turns_rad: [tooth_1 as f64 * pitches[0], tooth_2 * pitches[1]],
                mean_gap_m: sigma * behind * lever,
            }
        })
    }
}
