//! The rotor of seed 002, sound and with spalls, its gear rig, and the bearing pair of seed 000, all shorter than
//! shipped.

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

/// Three turns of the rotor: balls go round at the fundamental train frequency of its table 2, 0.399 of the shaft's 10
/// Hz, and cages with them. With a spall on the outer or the inner race of the loaded bearing its ring shakes at BPFO
/// or BPFI, 3.5913 and 5.4087 times the shaft's frequency, and not without.
#[test]
fn the_rotor_of_seed_002_turns_in_its_bearings_and_shows_their_spalls() {
    let scene = changed(&text("rotor_9_balls.toml"), "end_s = 1.0", "end_s = 0.3");
    let sound = finish(&scene);
    let late = |result: &SystemResult, name: &str| {
        let values = result.rows.read(name).unwrap();
        values[values.len() / 6..].to_vec()
    };
    let train = 0.5 * (1.0 - 7.94 / 39.32) * 20.0 * std::f64::consts::PI;
    for side in ["motor side", "loader side"] {
        let orbit = mean(&late(
            &sound,
            &format!("elements/{side}/orbit_speed_rad_per_s"),
        ));
        let cage = mean(&late(
            &sound,
            &format!("bodies/{side}_cage/angular_velocity_z_rad_per_s"),
        ));
        // Pockets leave 0.2 mm on 20 mm, over a quarter of a second.
        assert!((cage / orbit - 1.0).abs() < 0.02, "{side}: {cage} {orbit}");
        // Rolling, but for slip in the bearings and the play of the pockets.
        assert!(
            (orbit / train - 1.0).abs() < 0.015,
            "{side}: {orbit} {train}"
        );
        // The land holds the cage: 150 um of play, and what it gives.
        let [x, y] =
            ["x", "y"].map(|axis| late(&sound, &format!("elements/{side}/cage_1_{axis}_m")));
        let away = x.iter().zip(&y).map(|(x, y)| x.hypot(*y));
        let farthest = away.fold(0.0, f64::max);
        assert!(farthest < 170e-6, "{side}: {farthest} m");
    }
    // The ring of the loaded bearing; bins of a quarter of a second are 4 Hz apart.
    let shakes = |result: &SystemResult| -> Vec<f64> {
        let values = late(result, "bodies/loader side_ring/acceleration_y_m_per_s2");
        let squares: Vec<f64> = values.iter().map(|a| a * a).collect();
        let middle = mean(&squares);
        (0..20)
            .map(|k| amplitude(&squares, middle, 4.0 * f64::from(k)))
            .collect()
    };
    let without = shakes(&sound);
    for (race, line_hz) in [("outer", 35.913), ("inner", 54.087)] {
        let (before, loaded) = scene.split_once("name = \"loader side\"").unwrap();
        let file = format!("bearing_9_balls_{race}_spall.toml");
        let loaded = changed(loaded, "bearing_9_balls.toml", &file);
        let spalled = finish(&format!("{before}name = \"loader side\"{loaded}"));
        // Balls that bounce make one course of many: the result says so, and it ends where it was asked to, whatever
        // the last step is.
        let told =
            |result: &SystemResult| result.head.notes.iter().any(|n| n.contains("statistics"));
        assert!(told(&spalled) && !told(&sound), "{:?}", spalled.head.notes);
        assert_eq!(spalled.record.as_ref().map(|r| r.simulated_s), Some(0.3));
        let with = shakes(&spalled);
        let stronger = |a: &usize, b: &usize| with[*a].total_cmp(&with[*b]);
        let strongest = (4..20).max_by(stronger).unwrap();
        let found_hz = 4.0 * strongest as f64;
        assert!((found_hz - line_hz).abs() < 4.0, "{race}: {found_hz} Hz");
        assert!(
            with[strongest] > 100.0 * without[strongest],
            "{race}: {with:?} {without:?}"
        );
    }
}

/// Amplitude of the line at a frequency \[Hz\] of rows 0.1 ms apart, by a Hann window.
fn amplitude(values: &[f64], middle: f64, frequency_hz: f64) -> f64 {
    use std::f64::consts::TAU;
    let (mut sum, mut weights) = ([0.0; 2], 0.0);
    for (i, value) in values.iter().enumerate() {
        let weight = 0.5 - 0.5 * (TAU * i as f64 / values.len() as f64).cos();
        let (sine, cosine) = (TAU * frequency_hz * 1e-4 * i as f64).sin_cos();
        sum[0] += weight * (value - middle) * cosine;
        sum[1] += weight * (value - middle) * sine;
        weights += weight;
    }
    2.0 * sum[0].hypot(sum[1]) / weights
}

/// Seed 002's gear rig, load brought up within 20 ms: the mesh shows at 250 Hz and its multiples in the transmission
/// error and in the vertical force on a bearing (its vertical contact force), the bearings of a shaft carry what the
/// mesh and its weight ask for, and friction that turns round within 1 mm/s is no obstacle to steps of 5 us.
#[test]
fn the_gear_rig_of_seed_002_shows_its_mesh_frequency() {
    let scene = changed(
        &text("gear_rig_600_rpm.toml"),
        "end_s = 0.6",
        "end_s = 0.06",
    );
    let scene = changed(&scene, "end_s = 0.1", "end_s = 0.02");
    let scene = changed(&scene, "interval_s = 2e-5", "interval_s = 1e-4");
    let result = finish(&scene);
    // Ten periods of the mesh.
    let late = |name: &str| {
        let values = result.rows.read(name).unwrap();
        values[values.len() - 400..].to_vec()
    };
    for (name, harmonics) in [
        ("elements/mesh/transmission_error_m", 4),
        ("elements/mesh/normal_force_right_N", 2),
        ("elements/gear rear/force_world_y_N", 2),
    ] {
        let values = late(name);
        let middle = mean(&values);
        let line = |frequency_hz: f64| amplitude(&values, middle, frequency_hz);
        let [first, below, above] = [250.0, 175.0, 325.0].map(line);
        assert!(
            first > 5.0 * below.max(above),
            "{name}: {below} {first} {above}"
        );
        for k in 2..=harmonics {
            let here = line(250.0 * f64::from(k));
            let beside = line(250.0 * f64::from(k) + 125.0);
            assert!(
                here > 2.0 * beside && here < first,
                "{name}, {k}: {here} {beside}"
            );
        }
    }
    let up =
        ["front", "rear"].map(|end| mean(&late(&format!("elements/gear {end}/force_world_y_N"))));
    let mesh = mean(&late("elements/mesh/tangential_force_1_N"));
    let shaft = std::f64::consts::PI / 4.0 * 0.025_f64.powi(2) * 0.12 * 7850.0;
    let asked = mesh + 9.81 * (0.4439 + shaft);
    assert!(
        ((up[0] + up[1]) / asked - 1.0).abs() < 5e-3,
        "{up:?} {asked}"
    );
}

/// Seed 000's pair at 500 N and 6000 rpm with its cages, a hundredth of a second: without load but the preload all
/// balls carry alike, 500 N/(18 sin α) and what their centrifugal force changes; balls go round as they roll, cages
/// with them.
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
