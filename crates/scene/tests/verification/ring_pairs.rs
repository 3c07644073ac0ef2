//! A planet in a ring in time: energy with every model, slow motion against the pair at rest, the ideal ratio with its
//! sign.

use std::path::Path;

use gearmesh_geometry::input::InputDocument;
use gearmesh_scene::system_run::{RunJob, SystemResult};
use gearmesh_scene::{Scene, load as load_pair, run};

use crate::common::load;
use crate::made_up_gears::write_planet_and_ring;
use crate::system_runs::Desk;

/// Load on the ring \[N·m\].
const TORQUE_NM: f64 = 150.0;

/// The planet is driven clockwise, on its right flanks; the ring goes with it against a torque.
fn scene(run: &str, speed_rpm: f64, mesh: &str) -> String {
    format!(
        "title = \"ring\"\n{run}\n[[body]]\nname = \"planet\"\ngear = \"gear_24.h5\"\n\
         [[body]]\nname = \"ring\"\ngear = \"gear_75.h5\"\nposition_mm = [76.5, 0.0, 0.0]\n\
         [[joint]]\nname = \"pin\"\nkind = \"revolute\"\nbody_2 = \"planet\"\n\
         [[joint]]\nname = \"seat\"\nkind = \"revolute\"\nbody_2 = \"ring\"\n\
         [[motion]]\nname = \"drive\"\njoint = \"pin\"\nspeed_rpm = {:?}\n\
         [[load]]\nbody = \"ring\"\ntorque_Nm = {TORQUE_NM:?}\n\
         [[gear_mesh]]\nname = \"mesh\"\ngear_1 = \"planet\"\ngear_2 = \"ring\"\n{mesh}\n",
        -speed_rpm
    )
}

fn result(text: &str, folder: &Path, desk: &Desk) -> SystemResult {
    desk.run(RunJob::from_scene(load(text, folder).unwrap()).unwrap())
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Two and a half mesh periods at 3000 rpm, undamped but for `impact`: what the balance is off by falls with the step,
/// and is small at the shorter one.
#[test]
fn the_energy_of_a_ring_pair_balances_with_every_model() {
    let folder = tempfile::tempdir().unwrap();
    for (helix_deg, model) in [
        (
            0.0,
            "model = { kind = \"impact\", stiffness_N_per_mm_e = 1e6, exponent = 1.5, damping_N_s_per_mm = 100.0, full_damping_depth_um = 5.0 }",
        ),
        (0.0, "model = { kind = \"iso6336\", slices = 3 }"),
        (
            0.0,
            "model = { kind = \"hybrid\", local = \"weber-banaschek\" }",
        ),
    ] {
        write_planet_and_ring(folder.path(), helix_deg);
        let off = [2e-6, 1e-6].map(|step_s| {
            let run = format!(
                "[run]\nkind = \"transient\"\nend_s = 0.002\n[solver]\nstep_s = {step_s:?}\nstart = \"equilibrium\"\nrho_infinity = 0.99\n\
                 [output]\ninterval_s = 1e-5"
            );
            let desk = Desk::new();
            let found = result(&scene(&run, 3000.0, model), folder.path(), &desk);
            found.relative_energy_error().unwrap()
        });
        assert!(
            off[1] < off[0].max(1e-9) && off[1] < 1e-3,
            "{model}: {off:?}"
        );
    }
}

/// A mesh period at 5 rpm: the transmission error of bodies in motion is that of the pair at rest, in the mean over the
/// period and at its ends.
#[test]
fn a_ring_pair_in_slow_motion_is_that_at_rest() {
    let folder = tempfile::tempdir().unwrap();
    write_planet_and_ring(folder.path(), 0.0);
    let run_table = "[run]\nkind = \"transient\"\nend_s = 0.5\n[solver]\nstep_s = 1e-4\nstart = \"equilibrium\"\nrho_infinity = 0.0\n\
                     [output]\ninterval_s = 1e-3";
    let hybrid = "model = { kind = \"hybrid\", local = \"weber-banaschek\", damping = { kind = \"stiffness-proportional\", time_s = 1e-6, full_depth_um = 1.0 } }";
    let desk = Desk::new();
    let in_time = result(&scene(run_table, 5.0, hybrid), folder.path(), &desk);
    let moving = in_time
        .rows
        .read("elements/mesh/transmission_error_m")
        .unwrap();
    let text = format!(
        "title = \"at rest\"\n[pair]\ngear_1 = \"gear_24.h5\"\ngear_2 = \"gear_75.h5\"\ncentre_distance_mm = 76.5\n[run]\ntorques_Nm = [{TORQUE_NM:?}]\n\
         pitches = 1\npoints_per_pitch = 60\n[mesh]\nmodel.kind = \"hybrid\"\nmodel.local = \"weber-banaschek\"\n"
    );
    let pair = Scene::from_document(InputDocument::new("pair.toml", text), folder.path()).unwrap();
    let at_rest = run(&load_pair(pair).unwrap(), &|_, _| ()).unwrap();
    let [moving_mean, mean_at_rest] = [mean(&moving), mean(&at_rest.te_m)];
    let ends = |values: &[f64]| {
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        [
            least,
            values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        ]
    };
    let ([a, b], [c, d]) = (ends(&moving), ends(&at_rest.te_m));
    assert!((moving_mean / mean_at_rest - 1.0).abs() < 5e-3);
    assert!((a / c - 1.0).abs() < 0.02 && (b / d - 1.0).abs() < 0.02);
}

/// z₁ φ₁ + z₂ φ₂ with z₂ negative: both turn the same way, and the ring's torque pulls the planet by 24/75 of it.
#[test]
fn the_ideal_ratio_of_a_ring_has_its_sign() {
    let folder = tempfile::tempdir().unwrap();
    write_planet_and_ring(folder.path(), 0.0);
    let run_table = "[run]\nkind = \"transient\"\nend_s = 0.01\n[solver]\nstep_s = 1e-4\n[output]\ninterval_s = 1e-3";
    let desk = Desk::new();
    let found = result(
        &scene(run_table, 600.0, "model.kind = \"kinematic\""),
        folder.path(),
        &desk,
    );
    let last = |name: &str| *found.rows.read(name).unwrap().last().unwrap();
    let [planet, ring] = ["planet", "ring"].map(|body| last(&format!("bodies/{body}/turn_rad")));
    assert!(
        (ring / planet - 24.0 / 75.0).abs() < 1e-12,
        "{planet} {ring}"
    );
    let motor = last("joints/drive/moment_z_Nm");
    assert!(
        (motor.abs() / (TORQUE_NM * 24.0 / 75.0) - 1.0).abs() < 1e-6,
        "{motor}"
    );
    assert!(found.head.meshes[0].ratio() < 0.0);
}
