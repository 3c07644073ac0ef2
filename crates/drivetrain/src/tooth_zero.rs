//! The flanks of tooth 0 in a slice plane: what all pairs of teeth share there, and from which each follows by its pitches.

use std::f64::consts::PI;

use gearmesh_geometry::{Flank, ToothGeometry};

use crate::mesh_frame::MeshFrame;
use crate::pose::Vector6;
use crate::slice_plane::{SlicePlane, on_turn};

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
        side: Flank,
        plane: &SlicePlane,
    ) -> Self {
        let sigma = side.mirror();
        let frame_turn = on_turn(sigma * frame.frame_turn);
        let spin = on_turn(sigma * frame.spin_gradient);
        let of_1 = sigma * plane.turn(frame) - frame_turn;
        let [r1, r2] = [gears[0].base_radius_m, gears[1].base_radius_m];
        Self {
            roll_rad: Self::rolls_rad(gears, frame.spin_rad, side, plane),
            roll_gradient: [of_1, of_1 - spin],
            gradient: plane.along_normal(frame) + r2 * spin + (r1 + r2) * frame_turn,
        }
    }

    /// The roll angles alone.
    pub(crate) fn rolls_rad(
        gears: &[ToothGeometry; 2],
        spin_rad: f64,
        side: Flank,
        plane: &SlicePlane,
    ) -> [f64; 2] {
        let seen_from_mate = [-plane.polar_rad, spin_rad - plane.polar_rad - PI];
        [0, 1].map(|i: usize| {
            plane.pressure_angle_rad + gears[i].base_half_angle_rad
                - side.mirror() * seen_from_mate[i]
        })
    }
}
