//! Helical pairs in time: energy at both ends of the path, the axial force on bearings.

use std::ops::ControlFlow;

use gearmesh_drivetrain::*;
use gearmesh_dynamics::Simulation;

use crate::mesh_common::running_pair::{
    STEP_S, helical_pair_a, params, running_mesh, running_pair,
};
use crate::mesh_common::*;
use crate::pairs_in_time::conservation::energy_error_j;

/// A frictionless undamped `hybrid` pair at a full load keeps its energy on the rigid path as on the extended one:
/// slices that leave give back what they store (spur teeth lose 19 mJ on the rigid path in 7 ms). Extended, the error
/// of the balance falls with h² in the mean over runs; on the rigid path a line begins in its corner with a force along
/// the path, 1e-3 of all, and a jump within a step costs h.
#[test]
fn helical_pairs_keep_their_energy() {
    let pair = helical_pair(18.0);
    for (ends, orders, most_j) in [
        (PathEnds::Extended, 1.4..2.5, 2e-6),
        (PathEnds::LineOfAction, 0.7..1.5, 2e-5),
    ] {
        let error = |step_s: f64| energy_error_j(&pair, ends, (step_s, 5e-3), 2);
        let errors = [8e-6, 4e-6, 2e-6].map(error);
        let order = (errors[0] / errors[2]).log2() / 2.0;
        println!("{ends:?} {errors:?} {order}");
        // Of 20 mJ in the teeth. Seen in 7 ms and three runs: 1.1e-5, 2.9e-6, 7.8e-7 J,
        // order 1.9; 2.6e-5, 1.2e-5, 6.3e-6 J, order 1.0.
        assert!(orders.contains(&order), "{ends:?} {errors:?} {order}");
        assert!(errors[2] < most_j, "{ends:?} {errors:?}");
    }
}

/// Six degrees of freedom on bearings at 600 rpm, gauges read at every step: the mean axial displacement is that of F_t
/// tan β_b on the axial springs, gear 1 to −z and gear 2 to +z, and Newton's corrections stay as few as with spur
/// teeth.
#[test]
fn bearings_carry_the_axial_force() {
    let pair = helical_pair_a();
    for name in ["impact", "hybrid"] {
        let system = running_pair(&pair, running_mesh(name, &pair), 8);
        let mut run = Simulation::new(system.build().unwrap(), params()).unwrap();
        let names = run.system().channels();
        let of = |name: &str| names.iter().filter(|(element, _)| element == name).count();
        let counts: Vec<usize> = run.system().elements().map(of).collect();
        let mut out = vec![0.0; names.len()];
        let strain = (names.iter()).position(|(_, channel)| channel.name.contains("strain"));
        let (mut heights, mut steps, mut strained) = ([0.0; 2], 0, 0.0_f64);
        let (settle, end) = (600.0 * STEP_S, 1600.0 * STEP_S);
        run.run(end, |step| {
            if step.to.time_s > settle {
                step.system.sample(step.to, &counts, &mut out);
                strained = strained.max(strain.map_or(f64::NAN, |place| out[place].abs()));
                for (height, at) in heights.iter_mut().zip(&step.to.positions_m) {
                    *height += at[2];
                }
                steps += 1;
            }
            ControlFlow::Continue(())
        })
        .unwrap();
        let info = run.info();
        let corrections = info.iterations as f64 / info.steps as f64;
        let axial = 200.0 / pair.gear_2.base_radius_m * pair.base_helix_angle_rad().tan();
        let mean = heights.map(|height| height / f64::from(steps) * 1e8 / axial);
        println!("{name} {mean:?} {corrections} {strained}");
        assert!(
            (mean[0] + 1.0).abs() < 0.01 && (mean[1] - 1.0).abs() < 0.01,
            "{name} {mean:?}"
        );
        // Seen: 2.94 with either; spur teeth take 2.8 and 2.6.
        assert!(
            corrections < 3.3 && info.unconverged == 0,
            "{name} {corrections}"
        );
        assert!(strained.is_finite() && strained > 0.0);
    }
}
