//! The rotor of seed 002 and the bearing pair of seed 000, shorter than shipped.

use std::sync::atomic::AtomicBool;

use gearmesh_scene::system_run::{Outcome, RunJob, SystemResult, run};

use crate::common::{changed, fe_models, load, text};
use crate::system_runs::Desk;

fn finish(scene: &str) -> SystemResult {
    let desk = Desk::new();
    let job = RunJob::from_scene(load(scene, &fe_models()).unwrap()).unwrap();
    let stop = AtomicBool::new(false);
    assert_eq!(run(job, &desk.options(&stop)).unwrap(), Outcome::Finished);
    SystemResult::open(&desk.output).unwrap()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Two turns of the rotor: balls go round at the fundamental train frequency of its table 2, 0.399 of the shaft's 10 Hz, and cages with them.
#[test]
fn the_rotor_of_seed_002_turns_in_its_bearings() {
    let scene = changed(&text("rotor_9_balls.toml"), "end_s = 1.0", "end_s = 0.2");
    let result = finish(&scene);
    let late = |name: &str| {
        let values = result.rows.read(name).unwrap();
        values[values.len() / 2..].to_vec()
    };
    let train = 0.5 * (1.0 - 7.94 / 39.32) * 20.0 * std::f64::consts::PI;
    for side in ["motor side", "loader side"] {
        let orbit = mean(&late(&format!("elements/{side}/orbit_speed_rad_per_s")));
        let cage = mean(&late(&format!(
            "bodies/{side}_cage/angular_velocity_z_rad_per_s"
        )));
        // Pockets leave 0.2 mm on 20 mm, over a tenth of a second.
        assert!((cage / orbit - 1.0).abs() < 0.02, "{side}: {cage} {orbit}");
        // Rolling, but for slip under 8 and 56 N and the play of the races.
        assert!(
            (orbit / train - 1.0).abs() < 0.015,
            "{side}: {orbit} {train}"
        );
        // The land holds the cage: 150 um of play, and what it gives.
        let [x, y] = ["x", "y"].map(|axis| late(&format!("elements/{side}/cage_1_{axis}_m")));
        let away = x.iter().zip(&y).map(|(x, y)| x.hypot(*y));
        let farthest = away.fold(0.0, f64::max);
        assert!(farthest < 170e-6, "{side}: {farthest} m");
    }
}

/// Seed 000's pair at 500 N and 6000 rpm with its cages, a hundredth of a second: without load but the preload all balls bear alike, 500 N/(18 sin α) and what
/// their centrifugal force changes; balls go round as they roll, cages with them.
#[test]
fn the_pair_of_seed_000_runs_with_its_cages() {
    let whole = text("spindle_6000_rpm.toml");
    let whole = changed(&whole, "end_s = 0.1", "end_s = 0.01");
    let whole = changed(&whole, "force_N = 300.0", "force_N = 0.0");
    let result = finish(&whole);
    let late = |name: &str| {
        let values = result.rows.read(name).unwrap();
        values[values.len() / 2..].to_vec()
    };
    let load =
        |ball: usize, race: &str| mean(&late(&format!("elements/pair/ball_{ball}_{race}_N")));
    let [inner, outer] = ["inner", "outer"].map(|race| load(1, race));
    assert!(
        outer > inner + 1.0 && (80.0..110.0).contains(&inner),
        "{inner} {outer}"
    );
    for ball in 2..=36 {
        for (race, first) in [("inner", inner), ("outer", outer)] {
            let found = load(ball, race);
            assert!(
                (found / first - 1.0).abs() < 0.01,
                "{ball}: {found} {first}"
            );
        }
    }
    // Rolling at the contact angle of 17.3 degrees, a little more at speed.
    let ratio = 9.525 / 70.0 * 17.3_f64.to_radians().cos();
    let rolling = 100.0 * std::f64::consts::PI * (1.0 - ratio);
    let orbit = mean(&late("elements/pair/orbit_speed_rad_per_s"));
    assert!((orbit / rolling - 1.0).abs() < 0.01, "{orbit} {rolling}");
    for row in 1..=2 {
        let cage = mean(&late(&format!(
            "bodies/pair_cage_{row}/angular_velocity_z_rad_per_s"
        )));
        assert!((cage / orbit - 1.0).abs() < 0.05, "{cage} {orbit}");
    }
}
