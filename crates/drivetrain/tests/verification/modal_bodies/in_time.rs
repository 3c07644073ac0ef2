//! Vibrating gears in time.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use gearmesh_drivetrain::*;
use gearmesh_dynamics::elements::Channel;
use gearmesh_dynamics::{Joint, JointKind, Marker, Motion, Params, Simulation, TimeFunction};
use gearmesh_geometry::{Flank, GearPair};
use gearmesh_model::ReducedGear;

use crate::mesh_common::modal_gear::MODES;
use crate::mesh_common::*;
use crate::modal_bodies::vibrating_pair::*;

/// Frictionless, undamped modal gears keep their energy: the error of the balance falls with h² in the mean, as for
/// rigid ones.
#[test]
fn vibrating_pairs_keep_their_energy() {
    let pair = spur_pair();
    let models = models(&pair);
    let modes = [COUNT, COUNT];
    let ratio = pair.gear_1.base_radius_m / pair.gear_2.base_radius_m;
    let run = |step_s: f64| {
        let mesh = hybrid(&pair, &models, modes, relieved_kinematics(&pair));
        let (mut builder, markers) = scene(&pair, &models, modes, (mesh, 60.0, -4e-6, 0.0));
        torque(&mut builder, "drive", markers[0], -60.0 * ratio);
        torque(&mut builder, "load", markers[1], -60.0);
        let params = Params {
            rho_infinity: 1.0,
            newton_tolerance: Some(1e-12),
            ..Params::fixed(step_s)
        };
        let mut run = Simulation::new(builder.build().unwrap(), params).unwrap();
        run.run(5e-3, |_| ControlFlow::Continue(())).unwrap();
        *run.info()
    };
    let infos = [4e-6, 2e-6, 1e-6, 5e-7].map(run);
    let errors = infos.map(|info| info.energy.largest_error_j);
    let order = (errors[0] / errors[3]).log2() / 3.0;
    assert!((1.6..2.4).contains(&order), "{order} {errors:?}");
    // Elastic energy of the mean load: about 3 mJ.
    assert!(errors[2] < 1e-6, "{errors:?}");
    // Wrong tangents on the modes would not break the balance, but cost iterations.
    let per_step = infos[1].iterations as f64 / infos[1].steps as f64;
    assert!(per_step < 5.0, "{per_step}");
}

/// A run with modes that is resumed repeats bit by bit.
#[test]
fn resumed_runs_with_modes_repeat() {
    for pair in pairs() {
        let models = models(&pair);
        let modes = [2, COUNT];
        let new = || {
            let mesh = hybrid(&pair, &models, modes, kinematics(&pair));
            let (mut builder, markers) = scene(&pair, &models, modes, (mesh, 60.0, -4e-6, 0.01));
            torque(&mut builder, "load", markers[1], -60.0);
            builder.build().unwrap()
        };
        let params = Params::fixed(4e-6);
        let mut whole = Simulation::new(new(), params).unwrap();
        whole.run(4e-4, |_| ControlFlow::Continue(())).unwrap();
        let checkpoint = whole.checkpoint();
        whole.run(1e-3, |_| ControlFlow::Continue(())).unwrap();
        let mut resumed = Simulation::resume(new(), params, &checkpoint).unwrap();
        resumed.run(1e-3, |_| ControlFlow::Continue(())).unwrap();
        assert_eq!(whole.state(), resumed.state());
    }
}
/// Channels of the mesh over a mesh period at a prescribed slow speed, gears with so many modes: transmission error and
/// strain of gauges of gear 2, a row a step.
pub fn slow_run(
    pair: &GearPair,
    (models, modes): (&[ReducedGear; 2], [usize; 2]),
    (friction, gauges): (Option<Friction>, &[&str]),
    speed: f64,
) -> Vec<Vec<f64>> {
    let mut mesh = hybrid(pair, models, modes, relieved_kinematics(pair));
    if let Some(friction) = friction {
        mesh = mesh.with_friction(friction);
    }
    let mesh = (mesh, speed, -4e-6, 0.05);
    let (mut builder, markers) = scene_with_gauges(pair, models, modes, mesh, gauges);
    torque(&mut builder, "load", markers[1], -60.0);
    let motion = Motion::Speed(TimeFunction::Constant(-speed));
    let ground = Marker::ground([0.0; 3]);
    builder.joint(Joint::new("drive", JointKind::Rotation(motion), ground, markers[0]).unwrap());
    let system = builder.build().unwrap();
    let period = TAU / 30.0 / speed;
    let steps = 300;
    // Everything that vibrates is gone after a few steps: what is left follows the loads.
    let params = Params {
        rho_infinity: 0.0,
        ..Params::fixed(period / f64::from(steps))
    };
    let mut run = Simulation::new(system, params).unwrap();
    let names = run.system().channels();
    let of = |name: &str| names.iter().filter(|(element, _)| element == name).count();
    let counts: Vec<usize> = run.system().elements().map(of).collect();
    let wanted = |(_, (_, channel)): &(usize, &(String, Channel))| {
        channel.name == "transmission_error_m" || channel.name.starts_with("strain")
    };
    let places: Vec<usize> = (names.iter().enumerate().filter(wanted))
        .map(|(place, _)| place)
        .collect();
    let mut out = vec![0.0; names.len()];
    let mut found = Vec::new();
    run.run(1.5 * period, |step| {
        step.system.sample(step.to, &counts, &mut out);
        if step.to.time_s > 0.5 * period {
            found.push(places.iter().map(|place| out[*place]).collect());
        }
        ControlFlow::Continue(())
    })
    .unwrap();
    found
}

/// Peak to peak of a column of one run, and how far that of another is from it at most.
pub fn difference(one: &[Vec<f64>], other: &[Vec<f64>], column: usize) -> [f64; 2] {
    let values = one.iter().map(|row| row[column]);
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| {
        (l.min(x), h.max(x))
    });
    let off = one
        .iter()
        .zip(other)
        .map(|(a, b)| (a[column] - b[column]).abs());
    [high - low, off.fold(0.0, f64::max)]
}

/// At low speed a `modal` gear is a `reduced` one: the difference in transmission error vanishes as the square of the
/// speed.
#[test]
fn slow_modal_gears_are_reduced_gears() {
    let pair = spur_pair();
    let models = models(&pair);
    let worst = |speed: f64| {
        let [reduced, modal] = [[0, 0], [COUNT, COUNT]]
            .map(|modes| slow_run(&pair, (&models, modes), (None, &[]), speed));
        let [peak_to_peak, off] = difference(&reduced, &modal, 0);
        assert!(peak_to_peak > 0.5e-6, "{peak_to_peak}");
        off / peak_to_peak
    };
    let found = [4.0, 2.0, 1.0].map(worst);
    assert!(found[2] < 1e-4, "{found:?}");
    for pair in found.windows(2) {
        assert!((3.0..5.0).contains(&(pair[0] / pair[1])), "{found:?}");
    }
}

/// Gear 2 is held at its bore and struck by a tooth of gear 1, which bounces off: all modes ring at the frequencies of
/// the model, 0.1 %.
#[test]
fn a_struck_gear_rings_at_its_own_frequencies() {
    let pair = spur_pair();
    let models = models(&pair);
    let mesh = hybrid(&pair, &models, [0, COUNT], kinematics(&pair));
    let (mut builder, [_, gear_2]) = scene(&pair, &models, [0, COUNT], (mesh, 0.0, 1e-6, 0.0));
    let housing = Marker::ground([pair.centre_distance_m, 0.0, 0.0]);
    builder.joint(
        Joint::new(
            "lock",
            JointKind::Rotation(Motion::Speed(TimeFunction::Constant(0.0))),
            housing,
            gear_2,
        )
        .unwrap(),
    );
    let system = builder.build().unwrap();
    let mut start = system.start().clone();
    // Gear 1 turns against the right flanks of gear 2.
    start.velocity[5] = -0.3;
    let step_s = 1e-6;
    let params = Params {
        rho_infinity: 1.0,
        ..Params::fixed(step_s)
    };
    let mut run = Simulation::from_state(system, start, params).unwrap();
    let mut rings: Vec<Vec<f64>> = vec![Vec::new(); COUNT];
    let (mut touched, mut free_from) = (false, f64::NAN);
    let mut forces = vec![0.0; run.system().channels().len()];
    // Before gear 1 has crossed the backlash and strikes again.
    run.run(13e-3, |step| {
        let count = [forces.len()];
        step.system.sample(step.to, &count, &mut forces);
        let loaded = forces[0] + forces[1] > 0.0;
        touched |= loaded;
        if loaded {
            free_from = step.to.time_s;
            rings.iter_mut().for_each(Vec::clear);
        } else if touched {
            for (ring, eta) in rings.iter_mut().zip(&step.to.modal) {
                ring.push(*eta);
            }
        }
        ControlFlow::Continue(())
    })
    .unwrap();
    assert!(touched && free_from < 3e-3, "free from {free_from}");
    for (mode, ring) in rings.iter().enumerate() {
        let crossings: Vec<f64> = ring
            .windows(2)
            .enumerate()
            .filter(|(_, pair)| pair[0] < 0.0 && pair[1] >= 0.0)
            .map(|(k, pair)| k as f64 - pair[0] / (pair[1] - pair[0]))
            .collect();
        let (first, last) = (crossings[0], crossings[crossings.len() - 1]);
        let periods = (crossings.len() - 1) as f64;
        let frequency = periods / ((last - first) * step_s);
        let expected = MODES[mode].0;
        assert!(
            (frequency / expected - 1.0).abs() < 1e-3,
            "mode {mode}: {frequency} Hz, {expected} Hz"
        );
        let largest = ring.iter().fold(0.0_f64, |most, eta| most.max(eta.abs()));
        assert!(largest > 1e-9, "mode {mode} was not struck: {largest:e}");
    }
}

#[test]
fn modes_that_cannot_be_used_are_refused() {
    let pair = spur_pair();
    let models = models(&pair);
    let with = |mesh: GearMesh, count| mesh.with_modes(2, &models[1], count);
    let springs = mesh("analytic", &pair, kinematics(&pair));
    let message = with(springs, 2).err().unwrap().to_string();
    assert!(message.contains("hybrid"), "{message}");
    let new = || hybrid(&pair, &models, [0, 0], kinematics(&pair));
    let message = with(new(), COUNT + 1).err().unwrap().to_string();
    assert!(message.contains("7 are needed"), "{message}");
    let done = with(new(), 2).unwrap();
    assert!(
        done.with_side(Flank::Left, reduced_teeth(&pair, Flank::Left))
            .is_err()
    );
    let plain = made_up_gear(&pair.gear_2);
    assert!(new().with_modes(2, &plain, 1).is_err());
    assert!(modal_gear_body(&models[0], 2, -0.1).is_err());
    assert_eq!(modes_up_to(&models[0], 4199.0).unwrap(), 3);
    let message = modes_up_to(&models[0], 7000.0).err().unwrap().to_string();
    assert!(message.contains("6000"), "{message}");
}
