//! The examples of docs/extending.md do what they say.

#[path = "examples/spring_teeth.rs"]
mod spring_teeth;
#[path = "examples/waviness.rs"]
mod waviness;

use std::sync::Arc;

use crate::conformance::energy::check_energy;
use crate::conformance::loaded_poses;
use crate::mesh_common::*;
use gearmesh_drivetrain::*;
use gearmesh_geometry::{Flank, GearPair};
use spring_teeth::SpringTeeth;
use waviness::Waviness;

fn meshed(kinematics: MeshKinematics, teeth: impl Fn() -> Box<dyn TeethModel>) -> GearMesh {
    GearMesh::new(kinematics, Flank::Right, teeth())
        .unwrap()
        .with_side(Flank::Left, teeth())
        .unwrap()
}

fn spring_teeth() -> Box<dyn TeethModel> {
    Box::new(SpringTeeth {
        stiffness_n_per_m: 2e8,
        slices: SLICES,
    })
}

/// `impact` with the exponent 1 and without damping is the same spring.
#[test]
fn spring_teeth_are_impact_with_the_exponent_one() {
    let impact = || -> Box<dyn TeethModel> {
        let stiffness = PowerStiffness::n_per_mm_e(2e5, 1.0).unwrap();
        Box::new(Impact::new(stiffness, 0.0, 1e-6, SLICES).unwrap())
    };
    for pair in pairs() {
        let mut ours = meshed(kinematics(&pair), spring_teeth);
        let mut theirs = meshed(kinematics(&pair), impact);
        for at in loaded_poses(&pair) {
            let [a, b] = [&mut ours, &mut theirs].map(|mesh| mesh.evaluate(&at, true).unwrap());
            let scale = b.load.norm();
            assert!(scale > 100.0 && (a.load - b.load).norm() < 1e-12 * scale);
            let slope = b.by_position.norm();
            assert!((a.by_position - b.by_position).norm() < 1e-12 * slope);
            assert!((a.power.stored_j / b.power.stored_j - 1.0).abs() < 1e-12);
        }
        check_energy("spring teeth", &mut ours, &loaded_poses(&pair));
    }
}

/// Waves open and close the gap by their depth, and turn its normal by their slope: the mesh stays conservative.
#[test]
fn waves_on_a_flank_act_by_depth_and_slope() {
    let waves = |amplitude_m: f64| -> Arc<dyn FlankError> {
        Arc::new(Waviness {
            amplitude_m,
            waves_per_rad: 20.0,
        })
    };
    let wavy = |pair: &GearPair| {
        let errors = [vec![waves(1e-6)], vec![waves(-2e-6)]];
        kinematics_with(pair, errors, PathEnds::Extended)
    };
    for pair in pairs() {
        let mut mesh = meshed(wavy(&pair), spring_teeth);
        let mut plain = meshed(kinematics(&pair), spring_teeth);
        let poses = loaded_poses(&pair);
        check_energy("waves", &mut mesh, &poses);
        for at in &poses {
            let [with, without] =
                [&mut mesh, &mut plain].map(|mesh| mesh.evaluate(at, false).unwrap().load);
            assert!((with - without).norm() > 1e-3 * without.norm());
        }
    }
    // Nothing of it is felt where flanks are farther apart than the crests stand out.
    let most = waves(3e-6).most_added_m();
    assert_eq!(most, 3e-6);
}
