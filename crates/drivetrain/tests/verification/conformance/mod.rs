//! One suite on all mesh models, spur and helical: whatever pushes on gears must do what follows.

mod backlash;
mod bevel_facets;
mod bevel_pair;
mod bevel_slices;
mod crossed_cylinders;
mod crowned_cylinders;
mod effects;
mod energy;
mod examples;
mod exchange;
mod followed_gaps;
mod hard_pairs;
mod hertz;
mod invariance;
use crate::mesh_common;
mod models;
mod node_surface;
mod two_bodies;
mod zone;

use gearmesh_drivetrain::pose::Vector6;
use gearmesh_drivetrain::*;
use gearmesh_geometry::{Flank, GearPair};
use mesh_common::*;
use nalgebra::Vector3;

/// Poses with one and two loaded pairs, tilted and displaced a little, right or left flanks loaded.
fn loaded_poses(pair: &GearPair) -> Vec<Pose> {
    let mut poses = Vec::new();
    for (side, theta, te) in [
        (Flank::Right, 0.02, -9e-6),
        (Flank::Right, 0.11, -14e-6),
        (Flank::Left, 0.19, -11e-6),
    ] {
        let phi = angles(pair, side, theta, te);
        let shift = Vector3::new(2e-6, -1e-6, 1e-4);
        // 0.1 mrad unloads nothing, but makes every slice different.
        let tilt = Vector3::new(1e-4, -0.5e-4, 0.0);
        let screwed = [phi[0], phi[1] + screw_rad(pair, shift[2])];
        poses.push(pose(pair, screwed, shift, tilt));
    }
    poses
}

fn rates(seed: usize) -> Vector6 {
    let value = |i: usize| ((7 * seed + 3 * i + 1) as f64).sin();
    Vector6::new(
        0.01 * value(0),
        0.01 * value(1),
        0.01 * value(2),
        0.2 * value(3),
        0.2 * value(4),
        0.3 * value(5),
    )
}

fn friction() -> Friction {
    Friction::new([0.12, 0.07], [2e-3, 2e-2]).unwrap()
}

/// A mesh with damping by name; impact has its own.
fn damped(name: &str, pair: &GearPair, damping: Damping) -> GearMesh {
    let of = |side| -> Box<dyn TeethModel> {
        match name {
            "impact" => model(name, pair, side),
            _ => Box::new(Damped::new(model(name, pair, side), damping, SLICES).unwrap()),
        }
    };
    let mesh = GearMesh::new(kinematics(pair), Flank::Right, of(Flank::Right))
        .unwrap()
        .with_side(Flank::Left, of(Flank::Left))
        .unwrap();
    with_own_modes(name, pair, mesh)
}

const DAMPINGS: [Damping; 2] = [
    Damping::StiffnessProportional {
        time_s: 5e-6,
        full_depth_m: 1e-6,
    },
    Damping::Viscous {
        coefficient_n_s_per_m: 2e3,
        full_depth_m: 1e-6,
    },
];
