//! `kind = "bearing-life"` over the loads of a run.

use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use gearmesh_scene::system_run::{Outcome, RunJob, RunOptions, SystemResult, run};

use crate::common::{build_in, changed, load};
use crate::rating::near;

const BALLS: &str = r#"name = "6205"
kind = "deep-groove"
balls = 9
ball_diameter_mm = 7.94
pitch_diameter_mm = 39.04
inner_conformity = 0.52
outer_conformity = 0.53
[ratings]
dynamic_N = 14000.0
static_N = 7850.0
"#;

const SCENE: &str = r#"title = "a shaft in a bearing that wears"
[run]
kind = "static"
[[body]]
name = "shaft"
mass_kg = 1.0
inertia_kg_m2 = [2e-3, 2e-3, 1e-3]
speed_rpm = 3000.0
[[bearing]]
name = "front"
body_2 = "shaft"
axis = [0, 0, 1]
model = { kind = "quasi-static", file = "balls.toml", element_loads = true }
[[load]]
name = "push"
body = "shaft"
force_N = 1000.0
along = [0.6, 0.8, 0.0]
[[rating]]
kind = "bearing-life"
bearing = "front"
"#;

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("balls.toml"), BALLS).unwrap();
    folder
}

fn finish(text: &str, folder: &Path) -> SystemResult {
    let output = folder.join("result.h5");
    let stop = AtomicBool::new(false);
    let options = RunOptions {
        output: &output,
        restart: true,
        checkpoint_interval: Duration::from_secs(3600),
        stop: &stop,
        progress: &|_| {},
    };
    let job = RunJob::from_scene(load(text, folder).unwrap()).unwrap();
    assert_eq!(run(job, &options).unwrap(), Outcome::Finished);
    SystemResult::open(&output).unwrap()
}

fn figure(result: &SystemResult, name: &str) -> f64 {
    let rated = &result.ratings[0];
    let value = rated.figure(name);
    value.unwrap_or_else(|| panic!("{name} is not in {rated:?}"))
}

/// One load across the axis: P is the load, L10 = (14 000 N/1000 N)³ = 2744 million turns or 15 244 h at 3000 rpm;
/// L10r by ISO/TS 16281, written out here, from the loads of the balls in the rows.
#[test]
fn one_load_has_the_life_of_the_standard() {
    let folder = folder();
    let result = finish(SCENE, folder.path());
    near(figure(&result, "bearing_equivalent_load_N"), 1000.0, 1e-9);
    near(figure(&result, "bearing_l10_mrev"), 2744.0, 1e-8);
    near(
        figure(&result, "bearing_l10_h"),
        2744e6 / (60.0 * 3000.0),
        1e-8,
    );
    let one = reference_life(&result);
    // 53.13 degrees lie between a ball and the gap beside it: life by the mean damage of a ball under the load and a
    // gap there.
    let [ball, gap] = [0.0_f64, 20.0].map(|degrees| {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        let along = format!("along = [{cosine}, {sine}, 0.0]");
        let text = changed(SCENE, "along = [0.6, 0.8, 0.0]", &along);
        reference_life(&finish(&text, folder.path()))
    });
    assert!((one - ball) * (one - gap) < 0.0, "{one} {ball} {gap}");
    let both = 2.0 / (1.0 / ball + 1.0 / gap);
    near(figure(&result, "bearing_l10r_mrev"), both, 1e-4);
}

/// L10r by ISO/TS 16281 from the loads of the balls in the first row.
fn reference_life(result: &SystemResult) -> f64 {
    let gamma: f64 = 7.94 / 39.04;
    let grooves = (0.52 / 0.53 * (2.0 * 0.53 - 1.0) / (2.0 * 0.52 - 1.0_f64)).powf(0.41);
    let ratio = 1.044 * ((1.0 - gamma) / (1.0 + gamma)).powf(1.72) * grooves;
    let inner = 14_000.0 / (0.407 * 9.0) * (1.0 + ratio.powf(10.0 / 3.0)).powf(0.3);
    let outer = 14_000.0 / (0.389 * 9.0) * (1.0 + ratio.powf(-10.0 / 3.0)).powf(0.3);
    let mean = |race: &str, power: f64| {
        let load = |ball: usize| {
            let name = format!("elements/front/element_{ball}_{race}_N");
            result.rows.read(&name).unwrap()[0]
        };
        let sum: f64 = (1..=9).map(|ball| load(ball).powf(power)).sum();
        (sum / 9.0).powf(1.0 / power)
    };
    let power = 10.0 / 3.0;
    let damage =
        (mean("inner", 3.0) / inner).powf(power) + (mean("outer", power) / outer).powf(power);
    damage.powf(-0.9)
}

/// Half the time under 500 N, half under 1000 N: L10 = (C/P)³ with P³ = (500³ + 1000³)/2. With another load share the
/// life follows; hours are those of the speed.
#[test]
fn damages_add_up_over_time() {
    let folder = folder();
    let text = SCENE.replace("kind = \"static\"", "kind = \"transient\"\nend_s = 0.1\n[solver]\nstep_s = 2e-5\nstart = \"equilibrium\"\n[output]\ninterval_s = 1e-4");
    let text = changed(
        &text,
        "model = { kind = \"quasi-static\", file = \"balls.toml\", element_loads = true }",
        "model = { kind = \"linear\", radial_stiffness_N_per_mm = 1e5, axial_stiffness_N_per_mm = 1e5, tilt_stiffness_Nm_per_rad = 1e3, radial_damping_N_s_per_mm = 20.0 }",
    );
    let text = changed(
        &text,
        "force_N = 1000.0",
        "force_N = { step = { start_s = 0.0499, from = 500.0, end_s = 0.0501, to = 1000.0 } }",
    );
    let text = text + "file = \"balls.toml\"\nviscosity_mm2_per_s = 20.0\ncontamination = 0.5\n";
    let result = finish(&text, folder.path());
    let equivalent = (0.5 * (500.0_f64.powi(3) + 1000.0_f64.powi(3))).cbrt();
    near(
        figure(&result, "bearing_equivalent_load_N"),
        equivalent,
        2e-3,
    );
    let life = (14_000.0 / equivalent).powi(3);
    near(figure(&result, "bearing_l10_mrev"), life, 6e-3);
    near(
        figure(&result, "bearing_l10_h"),
        life * 1e6 / (60.0 * 3000.0),
        6e-3,
    );
    near(
        figure(&result, "bearing_mean_speed_rad_per_s"),
        100.0 * std::f64::consts::PI,
        1e-9,
    );
    // L10r: the lives of the two loads, each for half the time; L10mr beside it.
    let alone = |force: &str| {
        let text = changed(SCENE, "force_N = 1000.0", force);
        let text = text + "viscosity_mm2_per_s = 20.0\ncontamination = 0.5\n";
        let result = finish(&text, folder.path());
        ["bearing_l10r_mrev", "bearing_l10mr_mrev"].map(|name| figure(&result, name))
    };
    let (low, high) = (alone("force_N = 500.0"), alone("force_N = 1000.0"));
    for (i, name) in ["bearing_l10r_mrev", "bearing_l10mr_mrev"]
        .iter()
        .enumerate()
    {
        let both = 2.0 / (1.0 / low[i] + 1.0 / high[i]);
        near(figure(&result, name), both, 6e-3);
        assert!(low[i] > 4.0 * high[i], "{low:?} {high:?}");
    }
    // Only what comes after `from_s` counts.
    let late = finish(&(text + "from_s = 0.06\n"), folder.path());
    near(figure(&late, "bearing_l10_mrev"), 2744.0, 2e-3);
}

/// What cannot be rated is refused at its key.
#[test]
fn bad_bearing_ratings_are_told() {
    let folder = folder();
    let quasi = "model = { kind = \"quasi-static\", file = \"balls.toml\", element_loads = true }";
    let linear = "model = { kind = \"linear\", radial_stiffness_N_per_mm = 1e5 }";
    for (from, to, parts) in [
        (
            "bearing = \"front\"",
            "bearing = \"frond\"",
            ["rating.0.bearing", "`front`"],
        ),
        (
            quasi,
            "model = { kind = \"rigid\" }",
            ["rating.0.bearing", "joint"],
        ),
        (quasi, linear, ["rating.0.file", "missing"]),
        (
            "bearing = \"front\"",
            "bearing = \"front\"\nfile = \"balls.toml\"",
            ["rating.0.file", "remove"],
        ),
        (
            "bearing = \"front\"",
            "bearing = \"front\"\nfrom_s = 0.1",
            ["rating.0.from_s", "static"],
        ),
        (
            "bearing = \"front\"",
            "bearing = \"front\"\ncontamination = 0.5",
            ["rating.0.viscosity_mm2_per_s", "missing"],
        ),
        (
            "bearing = \"front\"",
            "bearing = \"front\"\nviscosity_mm2_per_s = 20.0\ncontamination = 1.5",
            ["rating.0.contamination", "0 to 1"],
        ),
        (
            "kind = \"static\"",
            "kind = \"static\"\n[output]\nelements = [\"push\"]",
            ["rating.0", "output.elements"],
        ),
        (
            "kind = \"static\"",
            "kind = \"eigen\"",
            ["rating.0.kind", "eigen"],
        ),
    ] {
        let text = changed(SCENE, from, to);
        let Err(error) = build_in(&text, folder.path()) else {
            panic!("{to} is accepted");
        };
        for part in parts {
            assert!(
                error.to_string().contains(part),
                "`{part}` is not in {error}"
            );
        }
    }
}

/// What `gearmesh bearing` warns of under one load is warned of in a run, for each load of it, and kept in the result.
#[test]
fn loads_beyond_the_limits_of_a_bearing_are_reported() {
    let folder = folder();
    let result = finish(SCENE, folder.path());
    assert_eq!(result.warnings().unwrap(), Vec::<String>::new());
    // 20 kN: s0 = 7850/20 000, more than half of C, and steel yields.
    let heavy = changed(SCENE, "force_N = 1000.0", "force_N = 20000.0");
    let result = finish(&heavy, folder.path());
    let warnings = result.warnings().unwrap();
    for what in [
        "static safety: s0 = C0/P0 = 0.39",
        "pressure: ",
        "more than 0.5 C = 7000 N",
    ] {
        let found = warnings.iter().find(|w| w.contains(what));
        let found = found.unwrap_or_else(|| panic!("{what} is not in {warnings:?}"));
        assert!(found.starts_with("bearing front: "), "{found}");
    }
    // A tenth of a newton at speed: balls may skid.
    let light = changed(SCENE, "force_N = 1000.0", "force_N = 10.0");
    let warnings = finish(&light, folder.path()).warnings().unwrap();
    assert!(
        warnings.iter().any(|w| w.contains("minimum load: ")),
        "{warnings:?}"
    );
}
