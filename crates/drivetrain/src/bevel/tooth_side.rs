//! One side of the teeth of a bevel pair: the flanks that face each other, and where they are nearest without a guess.

use std::cell::Cell;
use std::f64::consts::TAU;

use gearmesh_bevel::{FlankPatch, FlankSide, PairBlank, PairDesign};
use gearmesh_geometry::Flank;
use nalgebra::{Matrix3, Rotation3, Vector3};

use super::bounding_spheres::BoundingSpheres;
use super::nearest_points::{Nearest, Placed, nearest};
use super::nominal_contacts::NominalContacts;
use crate::error::DrivetrainError;

/// Pitches of the pinion to either side of the plane of the axes within which teeth are looked at.
pub(super) const REACH: f64 = 3.5;
/// Flanks that stand farther open than this share of a pitch do not touch soon, and are passed over.
pub(super) const FAR: f64 = 0.2;

/// A flank of each member on one side of the teeth.
#[derive(Debug, Clone)]
pub(super) struct Side {
    /// Of gear 1 and gear 2.
    pub patches: [FlankPatch; 2],
    /// Round parts of them.
    pub spheres: [BoundingSpheres; 2],
    /// Contacts of the pair as designed.
    pub nominal: NominalContacts,
    /// Azimuth of the mean points of tooth 0 \[rad\].
    pub azimuths_rad: [f64; 2],
    /// Lever of the normal at the mean point of gear 1 and gear 2 \[m\].
    pub levers_m: [f64; 2],
}

impl Side {
    /// Flanks of a side, and the contacts of the pair as designed.
    pub fn new(
        blank: &PairBlank,
        design: &PairDesign,
        flank: Flank,
    ) -> Result<Self, DrivetrainError> {
        let patch = |member: usize| {
            // Right flanks face clockwise.
            let facing = -flank.mirror();
            let own = &blank.members[member];
            let side = FlankSide::BOTH
                .into_iter()
                .find(|side| side.facing(own.hand) == facing);
            let side = side.unwrap_or(FlankSide::Concave);
            FlankPatch::of_tooth(&design.teeth[member], &blank.members[1 - member], side)
        };
        let patches = [patch(0)?, patch(1)?];
        let spheres = [0, 1].map(|m: usize| BoundingSpheres::new(&patches[m]));
        let azimuths_rad = [0, 1].map(|m: usize| patches[m].azimuth_rad(patches[m].mean));
        let levers_m = [0, 1].map(|m: usize| patches[m].lever_m());
        let [pitch_1, pitch_2] = blank.data.teeth.map(|z| TAU / z as f64);
        let count = Cell::new(0);
        let nominal = NominalContacts::new(pitch_1, REACH, |angle_1| {
            let angles = [angle_1, -angle_1 * pitch_2 / pitch_1];
            let turns = [0, 1].map(|m: usize| angles[m] - azimuths_rad[m]);
            let rotation = nominal_rotation(blank.data.shaft_angle_rad, turns);
            let bodies = placed(&patches, [0.0; 2], (rotation, Vector3::zeros()), &count);
            (
                rotation,
                searched(&bodies, &spheres, FAR * pitch_2 * levers_m[1]),
            )
        });
        Ok(Self {
            patches,
            spheres,
            nominal,
            azimuths_rad,
            levers_m,
        })
    }
}

/// Both flanks of a side in the frame of gear 1, turned about their own axes; gear 2 with its axes and its origin \[m\] there.
pub(super) fn placed<'a>(
    patches: &'a [FlankPatch; 2],
    turns_rad: [f64; 2],
    (axes, displacement_m): (Matrix3<f64>, Vector3<f64>),
    points: &'a Cell<u64>,
) -> [Placed<'a>; 2] {
    let stands = [(None, Vector3::zeros()), (Some(axes), displacement_m)];
    [0, 1].map(|m: usize| Placed {
        patch: &patches[m],
        turn_rad: turns_rad[m],
        axes: stands[m].0,
        origin_m: stands[m].1,
        points,
    })
}

/// Nearest points without a guess, beginning at the two nearest of all bounding spheres.
pub(super) fn searched(
    bodies: &[Placed<'_>; 2],
    spheres: &[BoundingSpheres; 2],
    far_m: f64,
) -> Option<Nearest> {
    let [first, second] = bodies;
    let guess = BoundingSpheres::meet(
        [&spheres[0], &spheres[1]],
        [&first.rotation(), &second.rotation()],
        second.origin_m,
    )?;
    nearest(bodies, guess, far_m)
}

/// Gear 2's axes in gear 1's where the pair stands as designed and the gears have turned by these angles.
pub(super) fn nominal_rotation(shaft_angle_rad: f64, turns_rad: [f64; 2]) -> Matrix3<f64> {
    let (sin, cos) = shaft_angle_rad.sin_cos();
    // x towards gear 1's axis, y against gear 1's.
    let axes = Matrix3::new(-cos, 0.0, sin, 0.0, -1.0, 0.0, sin, 0.0, cos);
    about_z(-turns_rad[0]) * axes * about_z(turns_rad[1])
}

/// Turn about z.
pub(super) fn about_z(angle_rad: f64) -> Matrix3<f64> {
    *Rotation3::from_axis_angle(&Vector3::z_axis(), angle_rad).matrix()
}
