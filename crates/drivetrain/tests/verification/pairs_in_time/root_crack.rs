//! One cracked tooth in time: a disturbance once a revolution, sidebands of the mesh frequency at the shaft's.

use std::f64::consts::TAU;

use gearmesh_contact::LocalContact;
use gearmesh_drivetrain::*;
use gearmesh_dynamics::Params;
use gearmesh_geometry::{Flank, GearPair};

use crate::mesh_common::cracked_gear::cracked_gear;
use crate::mesh_common::{SLICES, kinematics, made_up_gear, spur_pair};
use crate::pairs_in_time::scene::*;

/// Steps in a mesh period: ten in a period of the pair on its stiffness.
const STEPS: usize = 60;
const CRACKED: usize = 7;

fn mesh(pair: &GearPair, crack: Option<f64>) -> GearMesh {
    let gear_1 = match crack {
        Some(share) => cracked_gear(&pair.gear_1, CRACKED, share),
        None => made_up_gear(&pair.gear_1),
    };
    let models = [gear_1, made_up_gear(&pair.gear_2)];
    let of = |side| {
        let local = LocalContact::WeberBanaschek;
        let teeth = ReducedTeeth::new(pair, side, [&models[0], &models[1]], local, 4000.0).unwrap();
        let damping = Damping::StiffnessProportional {
            time_s: 2e-5,
            full_depth_m: 1e-7,
        };
        Damped::new(teeth, damping, SLICES).unwrap()
    };
    GearMesh::new(kinematics(pair), Flank::Right, of(Flank::Right))
        .unwrap()
        .with_side(Flank::Left, of(Flank::Left))
        .unwrap()
}

/// Transmission error over a revolution of gear 1 at 600 rpm under 150 N·m, after half a revolution that settles.
fn one_turn(crack: Option<f64>) -> Vec<f64> {
    let pair = spur_pair();
    let speed = 10.0 * TAU;
    let turn = STEPS * pair.gear_1.teeth;
    let scene = Scene {
        te_m: -8e-6,
        ..Scene::new(&pair).driven_at(speed).loaded_by(150.0)
    };
    let step_s = TAU / speed / turn as f64;
    let samples = record(
        scene.system(mesh(&pair, crack)),
        Params::fixed(step_s),
        1.5 * TAU / speed,
    )
    .0;
    let all: Vec<f64> = samples.iter().map(|sample| sample.te_m).collect();
    all[all.len() - turn..].to_vec()
}

/// Amplitude of an order of the revolution.
fn line(samples: &[f64], order: usize) -> f64 {
    let n = samples.len() as f64;
    let (mut re, mut im) = (0.0, 0.0);
    for (k, value) in samples.iter().enumerate() {
        let (s, c) = (TAU * (order * k) as f64 / n).sin_cos();
        re += value * c;
        im += value * s;
    }
    2.0 * re.hypot(im) / n
}

#[test]
fn one_cracked_tooth_shows_once_a_turn() {
    let teeth = spur_pair().gear_1.teeth;
    let sound = one_turn(None);
    let [shallow, deep] = [0.05, 0.3].map(|share| one_turn(Some(share)));
    let drop = |cracked: &[f64]| -> Vec<f64> {
        (cracked.iter().zip(&sound))
            .map(|(c, s)| (c - s).abs())
            .collect()
    };
    let (shallow_drop, deep_drop) = (drop(&shallow), drop(&deep));
    let largest = |values: &[f64]| values.iter().fold(0.0_f64, |m, v| m.max(*v));
    let swing = sound.iter().fold(f64::MIN, |m, v| m.max(*v))
        - sound.iter().fold(f64::MAX, |m, v| m.min(*v));
    println!(
        "transmission error: sound {:.3} um peak to peak; a crack moves it by {:.3} and {:.3} um",
        swing * 1e6,
        largest(&shallow_drop) * 1e6,
        largest(&deep_drop) * 1e6
    );
    assert!(largest(&deep_drop) > 3.0 * largest(&shallow_drop) && largest(&deep_drop) > 0.2e-6);
    // One disturbance: what is disturbed by more than a tenth lies within two and a half pitches.
    let disturbed: Vec<usize> = (0..deep_drop.len())
        .filter(|&k| deep_drop[k] > 0.1 * largest(&deep_drop))
        .collect();
    let (first, last) = (disturbed[0], disturbed[disturbed.len() - 1]);
    assert!(
        (last - first) < 5 * STEPS / 2,
        "{} pitches",
        (last - first) / STEPS
    );
    // Sidebands of the mesh frequency and the shaft's own order, where the sound gear has none.
    let carrier = line(&sound, teeth);
    for order in [1, 2, 3, teeth - 2, teeth - 1, teeth + 1, teeth + 2] {
        let [of_sound, of_cracked] = [&sound, &deep].map(|samples| line(samples, order));
        println!(
            "order {order}: {:.5} of the mesh order's, sound {:.1e}",
            of_cracked / carrier,
            of_sound / carrier
        );
        assert!(
            of_sound < 1e-6 * carrier && of_cracked > 1e-3 * carrier,
            "order {order}: {of_sound:e} {of_cracked:e} of {carrier:e}"
        );
    }
}
