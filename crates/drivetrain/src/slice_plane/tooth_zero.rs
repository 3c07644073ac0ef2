//! The flanks of tooth 0 in a slice plane: what all pairs of teeth share there, and from which each follows by its
//! pitches.

use std::f64::consts::PI;

use gearmesh_geometry::ToothGeometry;

use super::SlicePlane;
use crate::mesh_frame::MeshFrame;
use crate::pose::{Vector6, on_turn};

/// Ideal spur flanks of tooth 0 of both gears in a slice plane; helical ones before their section turns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ToothZero {
    /// Roll angles on the line of action \[rad\].
    pub roll_rad: [f64; 2],
    /// ∂ξ/∂(increments), of every tooth.
    pub roll_gradient: [Vector6; 2],
    /// ∂(transverse gap)/∂(increments), of every pair.
    pub gradient: Vector6,
}

impl ToothZero {
    /// The flanks of one side in a plane.
    pub(crate) fn new(
        gears: &[ToothGeometry; 2],
        frame: &MeshFrame,
        sigma: f64,
        plane: &SlicePlane,
    ) -> Self {
        let frame_turn = on_turn(sigma * frame.frame_turn);
        let spin = on_turn(sigma * frame.spin_gradient);
        let of_1 = sigma * plane.turn(frame) - frame_turn;
        let [_, r2] = frame.circles.radii_m;
        Self {
            roll_rad: Self::rolls_rad(gears, frame, sigma, plane),
            roll_gradient: [of_1, of_1 - spin],
            gradient: plane.along_normal(frame) + r2 * spin + frame.circles.sum_m() * frame_turn,
        }
    }

    /// The roll angles alone.
    pub(crate) fn rolls_rad(
        gears: &[ToothGeometry; 2],
        frame: &MeshFrame,
        sigma: f64,
        plane: &SlicePlane,
    ) -> [f64; 2] {
        let turned = [0.0, frame.spin_rad];
        [0, 1].map(|i: usize| {
            let sense = frame.circles.sense(i);
            // Gear 1 looks along a, gear 2 against it, but for the ring, whose radius points the other way.
            let faces_away = (sense > 0.0) == (i == 1);
            let ahead = if faces_away { PI } else { 0.0 };
            let seen_from_mate = turned[i] - plane.polar_rad - ahead;
            plane.pressure_angle_rad + sense * gears[i].base_half_angle_rad - sigma * seen_from_mate
        })
    }
}
