//! The rotor and the gear rig of seed 002, shorter than shipped.

use std::sync::atomic::AtomicBool;

use gearmesh_scene::system_run::{Outcome, RunJob, SystemResult, run};
use gearmesh_signal::{Window, amplitude_spectrum};

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

/// Two turns of the rotor: balls go round at the fundamental train frequency of its table 2, 0.399 of the shaft's 10 Hz, cages with them, and the two bearings
/// carry the weight that the coupling does not.
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
        assert!(
            (orbit / train - 1.0).abs() < 0.02,
            "{side}: {orbit} {train}"
        );
        assert!((cage / train - 1.0).abs() < 0.02, "{side}: {cage} {train}");
    }
    let vertical = |name: &str| mean(&late(&format!("elements/{name}/force_world_y_N")));
    let borne = vertical("motor side") + vertical("loader side") + vertical("coupling");
    // Shaft of 20, 31 and 20 mm by 40, 120 and 40 mm, and the loader; one turn is averaged.
    let sections = std::f64::consts::FRAC_PI_4 * 1e-9 * (2.0 * 400.0 * 40.0 + 961.0 * 120.0);
    let weight = 9.81 * (7850.0 * sections + 4.0);
    assert!((borne / weight - 1.0).abs() < 0.02, "{borne} {weight}");
}

/// The gear rig: 250 Hz of 25 teeth at 600 rpm is the strongest line of the transmission error below a kilohertz, and its harmonics stand out.
#[test]
fn the_gear_rig_of_seed_002_meshes_at_250_hz() {
    let scene = text("gear_rig_25_30.toml");
    let scene = changed(&scene, "end_s = 0.4", "end_s = 0.06");
    let scene = changed(&scene, "end_s = 0.1, to", "end_s = 0.02, to");
    let scene = changed(&scene, "step_s = 1e-6", "step_s = 2e-6");
    let result = finish(&scene);
    let error = result
        .rows
        .read("elements/mesh/transmission_error_m")
        .unwrap();
    // 20 ms, five meshes: lines 50 Hz apart.
    let late = &error[error.len() - 200..];
    let spectrum = amplitude_spectrum(late, 1e4, Window::None).unwrap();
    let (line, _) = spectrum.peak(100.0, 1000.0).unwrap();
    assert_eq!(line, 5, "{:?}", &spectrum.values[..20]);
    for harmonic in [2, 3] {
        let around = |offset: usize| spectrum.values[5 * harmonic + offset - 2];
        assert!(
            around(2) > 2.0 * around(0).max(around(4)),
            "{harmonic}: {:?}",
            &spectrum.values[..20]
        );
    }
}

/// Seed 000's pair at 500 N and 6000 rpm, a fiftieth of a second and less: without load but the preload all balls of a row bear alike, as many newtons as 500 N/(18 sin α) and their
/// centrifugal force ask for, with and without cage; balls go round as they roll, cages with them.
#[test]
fn the_pair_of_seed_000_runs_with_and_without_cage() {
    let whole = text("spindle_6000_rpm.toml");
    let whole = changed(&whole, "end_s = 0.1", "end_s = 0.01");
    let whole = changed(&whole, "force_N = 300.0", "force_N = 0.0");
    let bare = &whole[..whole.find("[bearing.model.cage]").unwrap()];
    let mut orbits = Vec::new();
    for (scene, caged) in [(&whole[..], true), (bare, false)] {
        let result = finish(scene);
        let late = |name: &str| {
            let values = result.rows.read(name).unwrap();
            values[values.len() / 2..].to_vec()
        };
        let loads: Vec<[f64; 2]> = (1..=36)
            .map(|ball| {
                ["inner", "outer"]
                    .map(|race| mean(&late(&format!("elements/pair/ball_{ball}_{race}_N"))))
            })
            .collect();
        let all = |race: usize| mean(&loads.iter().map(|load| load[race]).collect::<Vec<_>>());
        for load in &loads {
            for (race, value) in load.iter().enumerate() {
                assert!(
                    (value / all(race) - 1.0).abs() < 0.01,
                    "{load:?} {}",
                    all(race)
                );
            }
        }
        assert!(
            all(1) > all(0) + 1.0 && (80.0..110.0).contains(&all(0)),
            "{} {}",
            all(0),
            all(1)
        );
        let orbit = mean(&late("elements/pair/orbit_speed_rad_per_s"));
        orbits.push(orbit);
        if caged {
            for row in 1..=2 {
                let cage = mean(&late(&format!(
                    "bodies/pair_cage_{row}/angular_velocity_z_rad_per_s"
                )));
                assert!((cage / orbit - 1.0).abs() < 0.05, "{cage} {orbit}");
            }
        }
    }
    // Rolling at the contact angle of 17.3 degrees, a little more at speed.
    let rolling =
        0.5 * 200.0 * std::f64::consts::PI * (1.0 - 9.525 / 70.0 * 17.3_f64.to_radians().cos());
    for orbit in orbits {
        assert!((orbit / rolling - 1.0).abs() < 0.01, "{orbit} {rolling}");
    }
}
