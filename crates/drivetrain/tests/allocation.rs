//! A mesh must not allocate once it is warm: counted by the global allocator of this test program.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // the figures are printed

#[path = "../../../tests/support/counting_allocator.rs"]
mod counting_allocator;
#[path = "allocation/hard_long_runs.rs"]
mod hard_long_runs;
mod mesh_common;
#[allow(dead_code)] // what the verification program uses of it
#[path = "verification/pairs_in_time/scene.rs"]
mod scene;

use counting_allocator::allocations;
use gearmesh_drivetrain::*;
use gearmesh_geometry::Flank;
use mesh_common::*;
use nalgebra::Vector3;

#[test]
fn evaluations_do_not_allocate() {
    let damping = Damping::StiffnessProportional {
        time_s: 1e-6,
        full_depth_m: 1e-6,
    };
    let friction = Friction::new([0.1, 0.05], [1e-3, 1e-2]).unwrap();
    for pair in pairs() {
        for name in CONFORMING {
            let of = |side| Damped::new(model(name, &pair, side), damping, SLICES).unwrap();
            let mesh = GearMesh::new(kinematics(&pair), Flank::Right, of(Flank::Right))
                .unwrap()
                .with_side(Flank::Left, of(Flank::Left))
                .unwrap()
                .with_friction(friction);
            let mut mesh = with_own_modes(name, &pair, mesh);
            // From the pressed right flanks through the backlash to the left ones, around a whole pitch.
            let poses: Vec<Pose> = (0..200)
                .map(|k| {
                    let k = f64::from(k);
                    let phi = angles(&pair, Flank::Right, 0.0021 * k, -10e-6 + 1.5e-6 * k);
                    pose(&pair, phi, Vector3::zeros(), Vector3::zeros())
                })
                .collect();
            for at in &poses {
                mesh.evaluate(at, true).unwrap();
                mesh.remember();
            }
            let before = allocations();
            for at in &poses {
                mesh.evaluate(at, true).unwrap();
                mesh.remember();
            }
            assert_eq!(allocations() - before, 0, "{name}");
        }
    }
}

/// Whole steps of a system, output with gauges included.
#[test]
fn steps_and_output_do_not_allocate() {
    use mesh_common::running_pair::*;
    for pair in [pair_a(), helical_pair_a()] {
        steps_do_not_allocate(&pair);
    }
}

fn steps_do_not_allocate(pair: &gearmesh_geometry::GearPair) {
    use mesh_common::running_pair::*;
    let system = running_pair(pair, running_mesh("hybrid", pair), 8);
    let run = gearmesh_dynamics::Simulation::new(system.build().unwrap(), params());
    count_in_steps(run.unwrap(), STEP_S);
}

/// Meshes that are solved together, damped; on fixed axes, and with rollers in the bore that they share.
#[test]
fn steps_of_an_idler_do_not_allocate() {
    use mesh_common::idler::*;
    let damping = Damping::StiffnessProportional {
        time_s: 1e-6,
        full_depth_m: 1e-6,
    };
    let rollers = Rollers {
        bore: Some(1.0),
        number: 12,
        young_pa: 206e9,
        clearance_m: 4e-6,
        beside_m: [0.0; 2],
    };
    for rollers in [None, Some(rollers)] {
        let how = Meshes {
            damping: Some(damping),
            ends: PathEnds::Extended,
            rollers,
            ..PLAIN
        };
        // A pitch takes 60 steps.
        let system = idler(0.0, [5e-6, 5e-6], how, (45.0, 150.0));
        let step_s = std::f64::consts::TAU / 41.0 / 45.0 / 60.0;
        let params = gearmesh_dynamics::Params::fixed(step_s);
        let run = gearmesh_dynamics::Simulation::new(system, params);
        count_in_steps(run.unwrap(), step_s);
    }
}

fn count_in_steps(mut run: gearmesh_dynamics::Simulation, step_s: f64) {
    let names = run.system().channels();
    let of = |name: &str| names.iter().filter(|(element, _)| element == name).count();
    let counts: Vec<usize> = run.system().elements().map(of).collect();
    let mut out = vec![0.0; names.len()];
    let (mut before, mut steps) = (0, 0);
    run.run(200.0 * step_s, |step| {
        step.system.sample(step.to, &counts, &mut out);
        steps += 1;
        // One mesh period warms everything up.
        if steps == 60 {
            before = allocations();
        }
        std::ops::ControlFlow::Continue(())
    })
    .unwrap();
    assert!(steps > 190);
    assert_eq!(allocations() - before, 0);
}

/// Bevel gears in slices, reduced ones.
#[test]
fn bevel_evaluations_do_not_allocate() {
    use mesh_common::made_up_bevel::made_up_bevel;
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../fe_models/bevel_20_20.toml"
    );
    let file = gearmesh_bevel::PairFile::read(path.as_ref()).unwrap();
    let flanks = BevelSlices::new(&file.blank, &file.design().unwrap(), 12).unwrap();
    let bodies = [0, 1].map(|member| made_up_bevel(&flanks, member));
    let teeth = |side: Flank| {
        let local = (gearmesh_contact::LocalContact::Calibrated, 2000.0);
        let models = [&bodies[0], &bodies[1]];
        flanks.reduced_teeth(side, models, local).unwrap()
    };
    let mesh = GearMesh::of_flanks(Box::new(flanks.clone()), Flank::Right, teeth(Flank::Right));
    let mut mesh = mesh
        .unwrap()
        .with_side(Flank::Left, teeth(Flank::Left))
        .unwrap();
    // Turning over a pitch, rocked from one side of the teeth to the other.
    let poses: Vec<Pose> = (0..200)
        .map(|k| {
            let turn = 0.0016 * f64::from(k);
            let rock = 8e-4 * (0.31 * f64::from(k)).sin();
            flanks.pair().nominal_pose([turn, -turn + rock])
        })
        .collect();
    let mut loaded = 0;
    for at in &poses {
        loaded += usize::from(mesh.evaluate(at, true).unwrap().load.norm() > 100.0);
        mesh.remember();
    }
    assert!(loaded > 100, "{loaded}");
    let before = allocations();
    for at in &poses {
        mesh.evaluate(at, true).unwrap();
        mesh.remember();
    }
    assert_eq!(allocations() - before, 0);
}
