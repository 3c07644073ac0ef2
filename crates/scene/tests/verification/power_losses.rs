//! What friction takes: of teeth beside the closed form of the mesh loss factor, of bearings beside `gearmesh bearing`.

use std::f64::consts::PI;
use std::fs;

use gearmesh_scene::system_run::RunJob;

use crate::common::{build_in, changed, fe_models, load};
use crate::system_runs::Desk;

/// Two pitches of a pair of the shipped train at 600 rpm against 100 N m.
const PAIR: &str = r#"title = "pair"
[run]
kind = "transient"
end_s = 0.0074074
[solver]
step_s = 1e-5
start = "equilibrium"
[output]
interval_s = 1e-5
[[body]]
name = "pinion"
gear = "train_27.toml"
speed_rpm = 600.0
[[body]]
name = "wheel"
gear = "train_61.toml"
position_mm = [88.0, 0.0, 0.0]
[[joint]]
name = "a"
kind = "revolute"
body_2 = "pinion"
[[joint]]
name = "b"
kind = "revolute"
body_2 = "wheel"
[[motion]]
name = "drive"
joint = "a"
speed_rpm = 600.0
[[load]]
body = "wheel"
torque_Nm = 100.0
[[gear_mesh]]
name = "mesh"
gear_1 = "pinion"
gear_2 = "wheel"
model = { kind = "analytic", slices = 3, damping = { kind = "stiffness-proportional", time_s = 2e-6, full_depth_um = 1.0 } }
teeth = { friction = { model = "coulomb", dynamic_coefficient = 0.05 } }
"#;

/// Ohlendorf's mesh loss factor of a standard spur pair (Niemann and Winter, *Maschinenelemente II*): each of two pairs
/// carries half of the force.
fn loss_factor(z: [f64; 2]) -> f64 {
    let alpha = 20f64.to_radians();
    let addendum = |i: usize| {
        // (√(r_a² − r_b²) − r sin α)/p_b in modules.
        let (r, base) = (0.5 * z[i], 0.5 * z[i] * alpha.cos());
        ((r + 1.0).powi(2) - base * base).sqrt() - r * alpha.sin()
    };
    let [e1, e2] = [addendum(0), addendum(1)].map(|length| length / (PI * alpha.cos()));
    PI * (1.0 / z[0] + 1.0 / z[1]) * (1.0 - (e1 + e2) + e1 * e1 + e2 * e2)
}

#[test]
fn teeth_lose_what_the_mesh_loss_factor_says() {
    let desk = Desk::new();
    let result = desk.run(RunJob::from_scene(load(PAIR, &fe_models()).unwrap()).unwrap());
    let losses = result.power_losses().unwrap().unwrap();
    assert_eq!(losses.parts.len(), 1);
    let mesh = &losses.parts[0];
    assert_eq!(mesh.part, "elements/mesh");
    // 100 N m at 600 × 27/61 rpm come out.
    let out = 100.0 * 600.0 * 27.0 / 61.0 * PI / 30.0;
    let expected = 0.05 * loss_factor([27.0, 61.0]) * out;
    assert!(
        (mesh.mean_w / expected - 1.0).abs() < 0.1,
        "{} W, {expected} W by the loss factor",
        mesh.mean_w
    );
    let through = mesh.through_w.unwrap();
    assert!((through / out - 1.0).abs() < 0.01, "{through} {out}");
    let efficiency = losses.efficiency().unwrap();
    assert!((efficiency - (1.0 - losses.total_w() / through)).abs() < 1e-12);
    // Twice the coefficient, twice the loss; without friction no columns.
    let twice = changed(
        PAIR,
        "dynamic_coefficient = 0.05",
        "dynamic_coefficient = 0.1",
    );
    let result = desk.run(RunJob::from_scene(load(&twice, &fe_models()).unwrap()).unwrap());
    let more = result.power_losses().unwrap().unwrap().total_w();
    assert!((more / losses.total_w() - 2.0).abs() < 0.05, "{more}");
    let without = changed(
        PAIR,
        "teeth = { friction = { model = \"coulomb\", dynamic_coefficient = 0.05 } }\n",
        "",
    );
    let result = desk.run(RunJob::from_scene(load(&without, &fe_models()).unwrap()).unwrap());
    assert_eq!(result.power_losses().unwrap(), None);
    assert!(
        result
            .rows
            .columns()
            .iter()
            .all(|c| !c.name.ends_with("power_W"))
    );
}

/// A deep-groove ball bearing.
pub const BALLS: &str = "name = \"6205\"\nkind = \"deep-groove\"\nballs = 9\nball_diameter_mm = 7.938\npitch_diameter_mm = 39.04\ninner_conformity = 0.52\n\
                     outer_conformity = 0.53\n";

const SHAFT: &str = r#"title = "a shaft that is driven"
[[body]]
name = "shaft"
mass_kg = 1.0
inertia_kg_m2 = [1e-3, 1e-3, 1e-3]
speed_rpm = 3000.0
[[bearing]]
name = "ball bearing"
body_2 = "shaft"
axis = [0, 0, 1]
model = { kind = "quasi-static", file = "balls.toml", radial_damping_N_s_per_mm = 1.0, axial_damping_N_s_per_mm = 1.0, tilt_damping_Nm_s_per_rad = 0.5 }
[[load]]
name = "push"
body = "shaft"
force_N = 500.0
along = [0.6, 0.0, 0.8]
[run]
kind = "static"
"#;

/// Nothing slides from one position of a series to the next: friction is refused, not left out.
#[test]
fn a_series_of_positions_refuses_friction() {
    let time = "kind = \"transient\"\nend_s = 0.0074074\n[solver]\nstep_s = 1e-5\nstart = \"equilibrium\"\n[output]\ninterval_s = 1e-5\n";
    let angles = "kind = \"static\"\nmotion = \"drive\"\nangles_deg = [0.0, 2.0]\n";
    let series = changed(PAIR, time, angles);
    let series = changed(
        &series,
        "damping = { kind = \"stiffness-proportional\", time_s = 2e-6, full_depth_um = 1.0 }",
        "",
    );
    let job = |text: &str| RunJob::from_scene(load(text, &fe_models()).unwrap()).map(|_| ());
    let error = job(&series).unwrap_err().to_string();
    let expected = "gear_mesh.0.teeth.friction: found a table; nothing slides at the positions of run.angles_deg";
    assert!(error.contains(expected), "{error}");
    let friction = "teeth = { friction = { model = \"coulomb\", dynamic_coefficient = 0.05 } }\n";
    job(&changed(&series, friction, "")).unwrap();
}

/// The shaft for a twentieth of a second instead of at rest.
fn coasting() -> String {
    changed(
        SHAFT,
        "kind = \"static\"\n",
        "kind = \"transient\"\nend_s = 0.05\n[solver]\nstep_s = 1e-4\nstart = \"equilibrium\"\n[output]\ninterval_s = 1e-2\n",
    )
}

/// The loss of a bearing in equilibrium is reported, and the shaft turns freely; where friction would not act it is
/// refused. Damping of the tilt does not brake a shaft that turns while it is tilted.
#[test]
fn bearings_tell_their_loss() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("balls.toml");
    fs::write(&file, BALLS).unwrap();
    let run = |text: &str| {
        let loaded = load(text, folder.path()).unwrap();
        Desk::new().run(RunJob::from_scene(loaded).unwrap())
    };
    assert_eq!(run(SHAFT).power_losses().unwrap(), None);
    let rubs = format!("{BALLS}[friction]\nviscosity_mm2_per_s = 30.0\nseal_torque_Nm = 0.02\n");
    fs::write(&file, rubs).unwrap();
    let result = run(SHAFT);
    let losses = result.power_losses().unwrap().unwrap();
    let torque = result.rows.read("elements/ball bearing/friction_torque_Nm");
    let torque = torque.unwrap()[0];
    // At least the seals and 1e-7 f0 (νn)^⅔ d_m³; both turn at 100 π rad/s.
    let least = 0.02 + 1e-10 * 2.0 * 90_000_f64.powf(2.0 / 3.0) * 39.04_f64.powi(3);
    assert!(torque > least && torque < 2.0 * least, "{torque} {least}");
    assert!((losses.total_w() / (torque * 100.0 * PI) - 1.0).abs() < 1e-9);
    assert_eq!(losses.efficiency(), None);
    let linear = changed(
        SHAFT,
        "model = { kind = \"quasi-static\", file = \"balls.toml\", radial",
        "model = { kind = \"linear\", tangent_of = \"balls.toml\", radial",
    );
    // The tangent stands where the bearing itself does: the same loads, the same loss.
    let tangent = run(&linear);
    let column = "elements/ball bearing_friction/friction_torque_Nm";
    let same = tangent.rows.read(column).unwrap()[0];
    assert!((same / torque - 1.0).abs() < 1e-9, "{same} {torque}");
    let moving = changed(
        &coasting(),
        "file = \"balls.toml\", radial_damping_N_s_per_mm = 1.0, axial_damping_N_s_per_mm = 1.0, tilt_damping_Nm_s_per_rad = 0.5",
        "file = \"balls.toml\"",
    );
    let moving = changed(&moving, "kind = \"quasi-static\"", "kind = \"dynamic\"");
    let told = match build_in(&moving, folder.path()) {
        Ok(_) => panic!("accepted"),
        Err(error) => error.to_string(),
    };
    assert!(
        told.contains("[friction]") && told.contains("twice") && told.contains("tangent_of"),
        "{told}"
    );
}

/// A shaft that coasts on the tangent of its bearing is braked as on the bearing itself: to the change of the loads
/// with the speed, which the tangent leaves out of the elastic load but not of the torque.
#[test]
fn tangents_brake_as_their_bearings() {
    let folder = tempfile::tempdir().unwrap();
    let rubs = format!("{BALLS}[friction]\nviscosity_mm2_per_s = 30.0\nseal_torque_Nm = 0.2\n");
    fs::write(folder.path().join("balls.toml"), rubs).unwrap();
    let coasting = coasting();
    let linear = changed(
        &coasting,
        "kind = \"quasi-static\", file",
        "kind = \"linear\", tangent_of",
    );
    let speed = |text: &str| {
        let loaded = load(text, folder.path()).unwrap();
        let result = Desk::new().run(RunJob::from_scene(loaded).unwrap());
        let column = "bodies/shaft/angular_velocity_z_rad_per_s";
        *result.rows.read(column).unwrap().last().unwrap()
    };
    let [own, tangent] = [&coasting, &linear].map(|text| speed(text));
    let lost = 100.0 * PI - own;
    // M t/J: at least the seals' 0.2 N m for 0.05 s on 1e-3 kg m2.
    assert!(lost > 10.0 && lost < 12.0, "{lost}");
    assert!(((own - tangent) / lost).abs() < 1e-4, "{own} {tangent}");
}
