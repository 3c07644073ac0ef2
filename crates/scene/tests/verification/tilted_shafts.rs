//! Shafts that turn while a force tilts them in their bearing: what damps the tilt does not brake them.

use std::fs;

use gearmesh_scene::system_run::{RunJob, SystemResult};

use crate::common::{changed, load};
use crate::power_losses::BALLS;
use crate::system_runs::Desk;

const SHAFT: &str = r#"title = "a shaft that is tilted"
[[body]]
name = "shaft"
mass_kg = 1.0
inertia_kg_m2 = [1e-3, 1e-3, 1e-3]
speed_rpm = 3000.0
[[bearing]]
name = "bearing"
body_2 = "shaft"
axis = [0, 0, 1]
model = { kind = "linear", radial_stiffness_N_per_mm = 1e5, axial_stiffness_N_per_mm = 1e5, tilt_stiffness_Nm_per_rad = 600.0, radial_damping_N_s_per_mm = 1.0, axial_damping_N_s_per_mm = 1.0, tilt_damping_Nm_s_per_rad = 5.0 }
[[load]]
name = "push"
body = "shaft"
force_N = 500.0
along = [0.6, 0.0, 0.8]
at_mm = [0.0, 0.0, 20.0]
[run]
kind = "transient"
end_s = 0.02
[solver]
start = "equilibrium"
step_s = 1e-5
[output]
interval_s = 1e-4
"#;

/// The shaft on a linear bearing and on one with balls.
fn both() -> [String; 2] {
    let balls = changed(
        SHAFT,
        "kind = \"linear\", radial_stiffness_N_per_mm = 1e5, axial_stiffness_N_per_mm = 1e5, tilt_stiffness_Nm_per_rad = 600.0",
        "kind = \"quasi-static\", file = \"balls.toml\"",
    );
    [SHAFT.to_owned(), balls]
}

fn result_of(text: &str) -> SystemResult {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("balls.toml"), BALLS).unwrap();
    let loaded = load(text, folder.path()).unwrap();
    Desk::new().run(RunJob::from_scene(loaded).unwrap())
}

/// Tilted by some 10 mrad at 3000 1/min, damping of all that turns across the bearing's axis would take 0.16 N m.
#[test]
fn a_tilted_shaft_keeps_its_speed() {
    for text in both() {
        let result = result_of(&text);
        let last = |name: &str| *result.rows.read(name).unwrap().last().unwrap();
        let speed = (["x", "y", "z"].iter())
            .map(|axis| last(&format!("bodies/shaft/angular_velocity_{axis}_rad_per_s")).powi(2));
        let kept = speed.sum::<f64>().sqrt() / (100.0 * std::f64::consts::PI);
        let balance = result.relative_energy_error().unwrap();
        assert!((kept - 1.0).abs() < 1e-6, "{kept}");
        assert!(balance < 1e-6, "{balance}");
    }
}

/// At rest, too, nothing is left that a shaft without other resistance could not stand.
#[test]
fn a_tilted_shaft_without_resistance_has_an_equilibrium() {
    for text in both() {
        let start = &text[..text.find("[run]").unwrap()];
        let result = result_of(&format!("{start}[run]\nkind = \"static\"\n"));
        let force = result.rows.read("elements/bearing/force_radial_N").unwrap();
        assert!((force[0] / 300.0 - 1.0).abs() < 1e-6, "{force:?}");
    }
}

/// Pushed along its axis on cylindrical rollers alone, the shaft leaves them: no equilibrium was found, after seconds.
#[test]
fn what_only_cylindrical_rollers_support_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let rollers = "name = \"rollers\"\nkind = \"cylindrical-roller\"\nrollers = 12\nroller_diameter_mm = 5.0\nroller_length_mm = 5.0\n\
                   pitch_diameter_mm = 40.0\nradial_clearance_um = 5.0\n";
    fs::write(folder.path().join("rollers.toml"), rollers).unwrap();
    fs::write(folder.path().join("balls.toml"), BALLS).unwrap();
    let shaft = r#"title = "a shaft on rollers"
[[body]]
name = "disc"
mass_kg = 1.0
inertia_kg_m2 = [1e-3, 1e-3, 1e-3]
[[shaft]]
name = "shaft"
stations_mm = [0.0, 100.0, 200.0]
origin_mm = [0.0, 0.0, 0.0]
outer_diameters_mm = [30.0, 30.0]
density_kg_per_m3 = 7850.0
model = { kind = "beam", young_GPa = 206.0, poisson = 0.3 }
seat = [{ station = 1, body = "disc" }]
[[bearing]]
name = "left"
body_2 = "shaft/0"
axis = [0, 0, 1]
model = { kind = "quasi-static", file = "rollers.toml" }
[[bearing]]
name = "right"
body_2 = "shaft/2"
axis = [0, 0, 1]
model = { kind = "quasi-static", file = "LAST" }
[[load]]
name = "push"
body = "disc"
force_N = 500.0
along = [0.6, 0.0, 0.8]
[run]
kind = "static"
"#;
    let built = |last: &str| {
        load(&changed(shaft, "LAST", last), folder.path())
            .unwrap()
            .build()
    };
    assert!(built("balls.toml").is_ok());
    let message = built("rollers.toml").map(|_| ()).unwrap_err().to_string();
    assert!(
        message.contains("nothing else holds `disc` there"),
        "{message}"
    );
}
