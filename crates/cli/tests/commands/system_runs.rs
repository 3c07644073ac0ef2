//! `gearmesh run`, `check` and `report` on multibody scenes: results, kills, Ctrl-C.

use crate::common;

use common::{Answer, Desk, argument, changed, gearmesh, refused, send, succeeds};
use gearmesh_scene::system_run::SystemResult;
use std::path::Path;
use std::process::Child;
use std::time::Duration;

/// A driven pendulum on a torsion spring: 120 000 steps, some hundred milliseconds at least.
const PENDULUM: &str = r#"title = "Driven pendulum"
gravity_m_per_s2 = [0.0, -9.81, 0.0]
[run]
kind = "transient"
end_s = 12.0
[solver]
step_s = 1e-4
[output]
interval_s = 1e-3
[[body]]
name = "rod"
mass_kg = 3.0
inertia_kg_m2 = [0.25, 1e-3, 0.25]
position_mm = [500.0, 0.0, 0.0]
cardan_deg = [0.0, 0.0, 90.0]
[[joint]]
name = "hinge"
kind = "revolute"
body_2 = "rod"
at_mm = [0.0, 0.0, 0.0]
[[torsion_spring]]
name = "spring"
body_2 = "rod"
stiffness_Nm_per_rad = 20.0
damping_Nm_s_per_rad = 0.2
[[load]]
body = "rod"
torque_Nm = { sine = { amplitude = 9.0, frequency_Hz = 0.9 } }
"#;

fn begin(scene: &Path, output: &Path, checkpoint_s: &str) -> Child {
    let words = ["run", argument(scene), "-o", argument(output), "--json"];
    common::begin(&[&words[..], &["--checkpoint-s", checkpoint_s]].concat())
}

fn assert_same_columns(a: &Path, b: &Path) {
    let [a, b] = [a, b].map(|path| SystemResult::open(path).unwrap());
    assert_eq!(a.rows.columns(), b.rows.columns());
    for column in a.rows.columns() {
        let bits = |r: &SystemResult| -> Vec<u64> {
            let values = r.rows.read(&column.name).unwrap();
            values.iter().map(|x| x.to_bits()).collect()
        };
        assert!(bits(&a) == bits(&b), "{}", column.name);
    }
    let steps = |r: &SystemResult| r.record.map(|r| (r.steps, r.iterations, r.evaluations));
    assert_eq!(steps(&a), steps(&b));
    assert_eq!(a.statistics, b.statistics);
}

/// Waits until a file is there, another one than the one that was found before. Gives none if the run ends first.
fn next_file(path: &Path, before: Option<u64>, child: &mut Child) -> Option<u64> {
    use std::os::unix::fs::MetadataExt;
    loop {
        let found = path.metadata().ok().map(|file| file.ino());
        if found.is_some() && found != before {
            return found;
        }
        if child.try_wait().unwrap().is_some() {
            return None;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// Killed again and again, at times that fall into steps, rows and checkpoints alike, a run still ends with the bits of
/// one that was left in peace. There is never half a result, and no other file is left beside it.
#[test]
fn a_run_that_is_killed_goes_on_from_its_checkpoint_to_the_same_result() {
    let desk = Desk::new();
    let scene = desk.file("scene.toml", PENDULUM);
    let (whole, killed) = (desk.path("whole.h5"), desk.path("killed.h5"));
    succeeds(&["run", argument(&scene), "-o", argument(&whole)]);
    let checkpoint = desk.path("killed.h5.part").join("checkpoint.h5");
    let (mut kills, mut resumed, mut last) = (0, 0, None);
    let answer = loop {
        let mut child = begin(&scene, &killed, "0.02");
        if kills < 6 {
            // A new checkpoint, so that each run gets further than the one before; then at no fixed time.
            last = next_file(&checkpoint, last, &mut child);
            std::thread::sleep(Duration::from_millis([3, 17, 0, 11, 25, 7][kills]));
        }
        let running = child.try_wait().unwrap().is_none();
        if kills < 6 && running {
            send("-KILL", child.id());
            let answer = Answer::from(child.wait_with_output().unwrap());
            assert_eq!(answer.code, None);
            // Killed at the very end, the run may have given its result its name already; then it is whole.
            if killed.exists() {
                assert_same_columns(&whole, &killed);
            }
            kills += 1;
            resumed += usize::from(answer.stderr.contains("goes on from the checkpoint"));
            continue;
        }
        break Answer::from(child.wait_with_output().unwrap());
    };
    assert_eq!(answer.code, Some(0), "{answer:#?}");
    assert!(kills >= 1, "the run was too short to be killed");
    resumed += usize::from(answer.stderr.contains("goes on from the checkpoint"));
    assert!(resumed >= 1, "never resumed in {kills} kills");
    assert_same_columns(&whole, &killed);
    assert_eq!(desk.names(), ["killed.h5", "scene.toml", "whole.h5"]);
}

#[test]
fn an_interrupted_run_says_so_and_goes_on() {
    let desk = Desk::new();
    let scene = desk.file("scene.toml", changed(PENDULUM, "12.0", "60.0"));
    let output = desk.path("result.h5");
    let mut child = begin(&scene, &output, "0.01");
    let part = desk.path("result.h5.part");
    next_file(&part.join("checkpoint.h5"), None, &mut child).unwrap();
    send("-INT", child.id());
    let answer = Answer::from(child.wait_with_output().unwrap());
    refused(&answer, 130, &["interrupted", "--restart"]);
    assert_eq!(desk.names(), ["result.h5.part", "scene.toml"]);
    assert!(part.join("checkpoint.h5").exists());
    // Another scene must not go on from it, unless told to begin anew.
    let other = desk.file("other.toml", changed(PENDULUM, "12.0", "0.1"));
    let other_run = ["run", argument(&other), "-o", argument(&output)];
    refused(
        &gearmesh(&other_run),
        2,
        &["result.h5.part", "another scene", "--restart"],
    );
    // Rows that are not those of the run must not end in a result.
    let rows = std::fs::read(part.join("rows.log")).unwrap();
    let mut flipped = rows.clone();
    flipped[rows.len() / 2] ^= 4;
    std::fs::write(part.join("rows.log"), flipped).unwrap();
    let run = ["run", argument(&scene), "-o", argument(&output)];
    refused(&gearmesh(&run), 1, &["rows.log", "altered", "--restart"]);
    std::fs::write(part.join("rows.log"), rows).unwrap();
    let first = succeeds(&run);
    assert!(
        first.stderr.contains("goes on from the checkpoint"),
        "{first:#?}"
    );
    assert_eq!(desk.names(), ["other.toml", "result.h5", "scene.toml"]);
    succeeds(&[&other_run[..], &["--restart"]].concat());
}

/// Two processes cannot write one result.
#[test]
fn a_result_that_another_run_writes_is_refused() {
    let desk = Desk::new();
    let scene = desk.file("scene.toml", changed(PENDULUM, "12.0", "1000.0"));
    let output = desk.path("result.h5");
    let mut child = begin(&scene, &output, "0.01");
    let part = desk.path("result.h5.part");
    next_file(&part.join("checkpoint.h5"), None, &mut child).unwrap();
    let answer = gearmesh(&["run", argument(&scene), "-o", argument(&output)]);
    send("-KILL", child.id());
    child.wait().unwrap();
    refused(&answer, 1, &["rows.log", "in use"]);
}

/// Figures, check and report of every kind of run.
#[test]
fn every_kind_of_run_is_printed_checked_and_reported() {
    let solver = "[solver]\nstep_s = 1e-4\n[output]\ninterval_s = 1e-3\n";
    let run = "kind = \"transient\"\nend_s = 12.0";
    let transient = changed(PENDULUM, "12.0", "1.0");
    let load = "torque_Nm = { sine = { amplitude = 9.0, frequency_Hz = 0.9 } }";
    let still = changed(&changed(PENDULUM, solver, ""), load, "torque_Nm = 5.0");
    let fixed = changed(&still, run, "kind = \"static\"\nload_factors = [0.5, 1.0]");
    let eigen = changed(&still, run, "kind = \"eigen\"");
    let driven = "[[motion]]\nname = \"driver\"\njoint = \"hinge\"\nspeed_rpm = 10.0\n";
    let sweep = changed(
        PENDULUM,
        run,
        "kind = \"speed-sweep\"\nmotion = \"driver\"\nfrom_rpm = 10.0\nto_rpm = 20.0\nspeeds = 3\nsettle_s = 0.1\nmeasure_s = 0.1",
    ) + driven;
    for (kind, scene) in [
        ("transient", transient),
        ("static", fixed),
        ("eigen", eigen),
        ("speed-sweep", sweep),
    ] {
        let desk = Desk::new();
        let scene = desk.file("scene.toml", scene);
        let (output, page) = (desk.path("result.h5"), desk.path("page.html"));
        let run = ["run", argument(&scene), "-o", argument(&output)];
        let printed = succeeds(&run);
        assert!(printed.stdout.contains(kind), "{printed:#?}");
        let json = succeeds(&[&run[..], &["--json"]].concat()).json();
        assert_eq!(json["kind"], kind);
        let checked = succeeds(&["check", argument(&output)]);
        assert!(checked.stdout.contains("Driven pendulum") && checked.stdout.contains("sound"));
        succeeds(&["report", argument(&output), "-o", argument(&page)]);
        let html = std::fs::read_to_string(&page).unwrap();
        assert!(html.contains("Driven pendulum"));
        match kind {
            "transient" => {
                assert_eq!(json["rows"], 1001);
                assert!(json["run"]["relative_energy_error"].as_f64().unwrap() < 1e-3);
            }
            "eigen" => {
                // √((k + m g l sin)/J) about the equilibrium, damping c/(2 √(k J)) of it: here only that it vibrates
                // once.
                let modes = json["points"][0]["modes"].as_array().unwrap();
                assert_eq!(modes.len(), 1);
                assert_eq!(modes[0]["participation"]["rod"], 1.0);
            }
            "speed-sweep" => assert_eq!(json["windows"].as_array().unwrap().len(), 6),
            _ => assert_eq!(json["columns"]["load_factor"][1], 1.0),
        }
    }
}

/// Moments of inertia \[kg m²\] of two gears, stiffness \[N/m\] of a pair of teeth, torque \[N m\].
const INERTIAS: [f64; 2] = [5e-3, 2e-2];
const STIFFNESS: f64 = 3e8;
const TORQUE: f64 = 40.0;

/// Base radii \[m\] of the two gears.
fn base_radii() -> [f64; 2] {
    [30.0, 40.0].map(|z| 0.5 * z * 3e-3 * 20.0_f64.to_radians().cos())
}

/// Two gears on fixed axes under balanced torques; `run` is the table of the run and what it needs.
fn two_gears(desk: &Desk, run: &str) -> std::path::PathBuf {
    let gear = |teeth: usize| {
        format!(
            "name = \"gear\"\n[tooth]\nteeth = {teeth}\nmodule_mm = 3.0\nface_width_mm = 20.0\n[blank]\nkind = \"solid\"\nbore_diameter_mm = 20.0\n[material]\nyoung_GPa = 210.0\npoisson = 0.3\n"
        )
    };
    desk.file("one.toml", gear(30));
    desk.file("two.toml", gear(40));
    let [j1, j2] = INERTIAS;
    let [r1, r2] = base_radii();
    desk.file(
        "scene.toml",
        format!(
            r#"title = "Two gears"
{run}
[[body]]
name = "one"
gear = "one.toml"
mass_kg = 1.0
inertia_kg_m2 = [3e-3, 3e-3, {j1}]
[[body]]
name = "two"
gear = "two.toml"
mass_kg = 2.0
inertia_kg_m2 = [1e-2, 1e-2, {j2}]
position_mm = [105.3, 0.0, 0.0]
[[joint]]
name = "axle one"
kind = "revolute"
body_2 = "one"
[[joint]]
name = "axle two"
kind = "revolute"
body_2 = "two"
[[load]]
name = "drive"
body = "one"
torque_Nm = -{TORQUE}
[[load]]
name = "brake"
body = "two"
torque_Nm = -{}
[[gear_mesh]]
name = "mesh"
gear_1 = "one"
gear_2 = "two"
model.kind = "impact"
teeth.flanks = "right"
model.stiffness_N_per_mm_e = {}
model.exponent = 1.0
"#,
            TORQUE * r2 / r1,
            STIFFNESS * 1e-3
        ),
    )
}

/// Two gears by a linear mesh: √(k/m_eq), k = K, m_eq = J₁J₂/(J₁ r₂² + J₂ r₁²) with base radii.
#[test]
fn two_gears_have_the_closed_form_frequency() {
    let desk = Desk::new();
    let scene = two_gears(&desk, "[run]\nkind = \"eigen\"");
    let ([j1, j2], [r1, r2], k) = (INERTIAS, base_radii(), STIFFNESS);
    let output = desk.path("result.h5");
    let json = succeeds(&["run", argument(&scene), "-o", argument(&output), "--json"]).json();
    let modes = json["points"][0]["modes"].as_array().unwrap();
    let found = modes.last().unwrap()["frequency_Hz"].as_f64().unwrap();
    // One or two pairs of teeth carry, each with K: the number at the start is in the notes of the mesh.
    let single = (k * (r1 * r1 / j1 + r2 * r2 / j2)).sqrt() / std::f64::consts::TAU;
    let pairs = (found / single).powi(2);
    assert!(
        (pairs - pairs.round()).abs() < 2e-6 * pairs && (1.0..3.0).contains(&pairs.round()),
        "{found} {single}"
    );
}

/// The first lines of the console, and the first figures of the page, are transmission error and tooth force: r_b of
/// the driver times the normal force is its torque.
#[test]
fn transmission_error_and_mesh_force_come_first() {
    let desk = Desk::new();
    let force = TORQUE / base_radii()[0];
    for (kind, run) in [
        ("static", "[run]\nkind = \"static\""),
        (
            "speed-sweep",
            "[run]\nkind = \"speed-sweep\"\nmotion = \"driver\"\nfrom_rpm = -60.0\nto_rpm = -90.0\nspeeds = 2\nsettle_s = 0.05\nmeasure_s = 0.05\n[solver]\nstep_s = 1e-4\nstart = \"equilibrium\"\n[output]\ninterval_s = 1e-3\n[[motion]]\nname = \"driver\"\njoint = \"axle one\"\nspeed_rpm = -60.0",
        ),
    ] {
        let scene = two_gears(&desk, run);
        let (output, page) = (desk.path(&format!("{kind}.h5")), desk.path("page.html"));
        let told = succeeds(&["run", argument(&scene), "-o", argument(&output)]).stdout;
        let mut lines = told.lines().skip(1);
        assert!(lines.next().unwrap().contains(if kind == "static" {
            "value"
        } else {
            "pk-pk mesh/transmission_error"
        }));
        succeeds(&["report", argument(&output), "-o", argument(&page)]);
        let html = std::fs::read_to_string(&page).unwrap();
        let first = &html[html.find("<dt>").unwrap()..];
        if kind == "static" {
            assert!(
                lines
                    .next()
                    .unwrap()
                    .starts_with("elements/mesh/transmission_error"),
                "{told}"
            );
            let normal: Vec<&str> = lines.next().unwrap().split_whitespace().collect();
            assert_eq!(
                normal[..2],
                ["elements/mesh/normal_force_right", "N"],
                "{told}"
            );
            let found: f64 = normal[2].parse().unwrap();
            assert!((found / force - 1.0).abs() < 1e-3, "{found} {force}");
            assert!(first.starts_with("<dt>mesh: TE</dt>"));
        } else {
            assert!(first.starts_with("<dt>mesh: largest TE peak to peak</dt>"));
            // A slow sweep has the same forces both ways.
            let has_way = ["up", "down"].map(|way| first.contains(&format!(" rpm, {way}")));
            assert!(
                first.contains("<dt>mesh: largest normal force</dt>") && has_way.contains(&true)
            );
        }
    }
}

/// Steps far too long for a stiff spring let its energy vanish: the run says so and ends with 1, its result is kept and
/// is not sound.
#[test]
fn a_run_whose_energy_does_not_balance_ends_with_1() {
    let desk = Desk::new();
    let scene = changed(
        PENDULUM,
        "stiffness_Nm_per_rad = 20.0",
        "stiffness_Nm_per_rad = 1e6",
    );
    let scene = changed(&scene, "step_s = 1e-4", "step_s = 2e-3\nrho_infinity = 0.0");
    let scene = changed(&scene, "end_s = 12.0", "end_s = 0.2");
    let scene = changed(
        &scene,
        "mass_kg = 3.0",
        "mass_kg = 3.0\nangular_velocity_rad_per_s = [0.0, 0.0, 30.0]",
    );
    let scene = desk.file("scene.toml", &scene);
    let output = desk.path("result.h5");
    let answer = gearmesh(&["run", argument(&scene), "-o", argument(&output)]);
    assert_eq!(answer.code, Some(1), "{answer:#?}");
    for part in [
        "the energy of this run does not balance",
        "% of the",
        "energy/error_J",
    ] {
        assert!(
            answer.stderr.contains(part),
            "`{part}` is not in {answer:#?}"
        );
    }
    // The figures are there all the same.
    assert!(answer.stdout.contains("of the work done"), "{answer:#?}");
    let checked = gearmesh(&["check", argument(&output)]);
    assert_eq!(checked.code, Some(1), "{checked:#?}");
    assert!(
        checked.stdout.contains(", not sound: transient, "),
        "{checked:#?}"
    );
}
