//! `gearmesh signal` on a vibration that is known in closed form.

use crate::common;

use common::{Desk, argument, changed, gearmesh, refused, succeeds};
use serde_json::Value;
use std::f64::consts::TAU;
use std::path::PathBuf;
use std::sync::OnceLock;

const INERTIA: f64 = 0.01;
const STIFFNESS: f64 = 20.0;
const DAMPING: f64 = 0.3;

/// A torsional oscillator under 60, 70 and 80 Hz, beside a disc that turns backwards at 600 rpm: orders 6, 7 and 8 of
/// it.
const SCENE: &str = r#"title = "Three tones"
[run]
kind = "transient"
end_s = 2.0
[solver]
step_s = 1e-4
[output]
interval_s = 5e-4
[[body]]
name = "rod"
mass_kg = 1.0
inertia_kg_m2 = [0.01, 0.01, 0.01]
[[body]]
name = "disc"
mass_kg = 1.0
inertia_kg_m2 = [0.01, 0.01, 0.01]
position_mm = [500.0, 0.0, 0.0]
[[joint]]
name = "hinge"
kind = "revolute"
body_2 = "rod"
[[joint]]
name = "axis"
kind = "revolute"
body_2 = "disc"
[[motion]]
joint = "axis"
speed_rpm = -600.0
[[torsion_spring]]
name = "spring"
body_2 = "rod"
stiffness_Nm_per_rad = 20.0
damping_Nm_s_per_rad = 0.3
[[load]]
body = "rod"
[load.torque_Nm]
sum = [
    { sine = { amplitude = 1.0, frequency_Hz = 60.0 } },
    { sine = { amplitude = 4.0, frequency_Hz = 70.0 } },
    { sine = { amplitude = 1.0, frequency_Hz = 80.0 } },
]
"#;

const ANGLE: &str = "joints/hinge/angle_rad";

/// Amplitude of the rod's angle under a torque of this amplitude.
fn response(torque_nm: f64, frequency_hz: f64) -> f64 {
    let omega = TAU * frequency_hz;
    torque_nm / (STIFFNESS - INERTIA * omega * omega).hypot(DAMPING * omega)
}

/// The result, computed once.
fn result() -> &'static (Desk, PathBuf) {
    static RESULT: OnceLock<(Desk, PathBuf)> = OnceLock::new();
    RESULT.get_or_init(|| {
        let desk = Desk::new();
        let scene = desk.file("scene.toml", SCENE);
        let result = desk.path("result.h5");
        succeeds(&["run", argument(&scene), "-o", argument(&result)]);
        (desk, result)
    })
}

/// An analysis as JSON.
fn signal(analysis: &str, further: &[&str]) -> Value {
    let (_, result) = result();
    let mut arguments = vec!["signal", analysis, argument(result), ANGLE, "--json"];
    arguments.extend(further);
    succeeds(&arguments).json()
}

fn figure(found: &Value, name: &str) -> f64 {
    let figures = found["figures"].as_array().unwrap().iter();
    let mut named = figures.filter(|figure| figure["name"] == name);
    named.next().unwrap()["value"].as_f64().unwrap()
}

fn list(found: &Value, head: &str) -> Vec<f64> {
    let rows = found["list"].as_array().unwrap().iter();
    rows.map(|row| row[head].as_f64().unwrap()).collect()
}

/// The integrator's own error, (ωh)²/12, stays below.
const TOLERANCE: f64 = 1e-3;

fn assert_near(found: f64, expected: f64) {
    let off = found / expected - 1.0;
    assert!(
        off.abs() < TOLERANCE,
        "{found} is {off:+.1e} off {expected}"
    );
}

#[test]
fn tones_are_found_over_frequency_and_order() {
    let frequencies = signal("spectrum", &["--window", "flat-top", "--peaks", "3"]);
    let mut places = list(&frequencies, "frequency");
    places.sort_by(f64::total_cmp);
    for (place, hz) in places.iter().zip([60.0, 70.0, 80.0]) {
        assert!((place - hz).abs() < 1.0, "{place} Hz");
    }
    let orders = signal("spectrum", &["--shaft", "disc", "--peaks", "3"]);
    let found: Vec<f64> = list(&orders, "order");
    let amplitudes = list(&orders, "amplitude");
    assert_near(found[0], 7.0);
    assert_near(amplitudes[0], response(4.0, 70.0));
    assert_near(found[1], 6.0);
    assert_near(amplitudes[1], response(1.0, 60.0));
    assert_near(found[2], 8.0);
    assert_near(amplitudes[2], response(1.0, 80.0));
    // 200 samples in a turn: right up to order 80, and nothing above is shown.
    let all = signal("spectrum", &["--shaft", "disc", "--peaks", "1000"]);
    assert!(list(&all, "order").iter().all(|order| *order <= 80.0));
    // A flat top reads the same amplitude between two lines.
    assert_near(list(&frequencies, "amplitude")[0], amplitudes[0]);
}

#[test]
fn sidebands_are_read_beside_their_carrier() {
    let of = ["--carrier", "7", "--modulator", "1", "--pairs", "2"];
    let found = signal("sidebands", &[&["--shaft", "disc"], &of[..]].concat());
    let ratios = list(&found, "over the carrier");
    assert_eq!(list(&found, "number"), [-2.0, -1.0, 0.0, 1.0, 2.0]);
    assert_near(ratios[1], response(1.0, 60.0) / response(4.0, 70.0));
    assert_near(ratios[3], response(1.0, 80.0) / response(4.0, 70.0));
    assert!(ratios[0] < 1e-4 && ratios[4] < 1e-4, "{ratios:?}");
    let together = figure(
        &found,
        "sidebands over the carrier (root of the sum of squares)",
    );
    assert_near(together, ratios[1].hypot(ratios[3]));
}

#[test]
fn envelope_statistics_average_and_map_agree_with_the_tones() {
    let tones = [
        response(1.0, 60.0),
        response(4.0, 70.0),
        response(1.0, 80.0),
    ];
    let square: f64 = tones.iter().map(|a| a * a).sum();
    let statistics = signal("statistics", &["--from-s", "1.0", "--to-s", "1.9995"]);
    assert_near(
        figure(&statistics, "RMS about the mean"),
        (0.5 * square).sqrt(),
    );
    // Two sidebands that are not equal turn the phase a little: the envelope beats with the disc's 10 Hz.
    let envelope = signal(
        "envelope",
        &["--low", "30", "--high", "110", "--peaks", "1"],
    );
    assert!((list(&envelope, "frequency")[0] - 10.0).abs() < 1.0);
    let level = figure(&envelope, "mean of the envelope");
    assert!((level / tones[1] - 1.0).abs() < 0.02, "{level}");
    // All of it repeats with the disc, and none of it with a seventh of a turn but the carrier.
    let turn = signal("average", &["--shaft", "disc"]);
    assert!(figure(&turn, "RMS of the residual") < 1e-5 * tones[1]);
    let seventh = ["--shaft", "disc", "--periods-per-turn", "7"];
    let carrier = signal("average", &seventh);
    assert!(
        (figure(&carrier, "peak to peak of the average") / (2.0 * tones[1]) - 1.0).abs() < 0.02
    );
    let rest = (0.5 * (tones[0].powi(2) + tones[2].powi(2))).sqrt();
    assert!((figure(&carrier, "RMS of the residual") / rest - 1.0).abs() < 0.02);
    let map = signal(
        "map",
        &["--shaft", "disc", "--block-turns", "4", "--peaks", "1"],
    );
    assert_near(list(&map, "order")[0], 7.0);
    assert_near(list(&map, "at rpm")[0], 600.0);
}

/// The envelope beats with 10 Hz, which is BPFO of this bearing at 167.07 rpm: the line is found there and nowhere
/// else, and the page marks it.
#[test]
fn frequencies_of_a_bearing_are_marked_in_the_envelope() {
    let (desk, file) = result();
    let bearing = desk.file(
        "bearing.toml",
        "name = \"seed 002\"\nkind = \"deep-groove\"\nballs = 9\nball_diameter_mm = 7.94\npitch_diameter_mm = 39.32\n\
         inner_conformity = 0.52\nouter_conformity = 0.52\n",
    );
    let page = desk.path("envelope.html");
    let band = ["--low", "30", "--high", "110", "--peaks", "1"];
    let lines = ["--bearing", argument(&bearing), "--speed-rpm", "167.07"];
    let all = [&band[..], &lines[..], &["-o", argument(&page)]].concat();
    let found = signal("envelope", &all);
    assert!((figure(&found, "BPFO") - 10.0).abs() < 1e-3);
    let strongest = list(&found, "amplitude")[0];
    assert_eq!(figure(&found, "amplitude at BPFO"), strongest);
    for other in ["amplitude at BSF", "amplitude at BPFI"] {
        assert!(figure(&found, other) < 0.05 * strongest, "{other}");
    }
    let page = std::fs::read_to_string(&page).unwrap();
    for part in ["Spectrum of the envelope", "2 BPFO", "FTF"] {
        assert!(page.contains(part), "{part}");
    }
    let file = argument(file);
    let ask = |further: &[&str]| {
        let all = [&["signal", "envelope", file, ANGLE][..], &band[..], further].concat();
        gearmesh(&all)
    };
    refused(
        &ask(&lines[..2]),
        2,
        &["--bearing", "--speed-rpm", "--shaft"],
    );
    refused(
        &ask(&[&lines[..3], &["0"]].concat()),
        2,
        &["--speed-rpm", "found 0"],
    );
    refused(
        &ask(&[&lines[..], &["--shaft", "disc"]].concat()),
        2,
        &["--speed-rpm", "remove it"],
    );
}

#[test]
fn curves_go_to_a_table_or_a_page() {
    let (desk, _) = result();
    let (csv, html) = (desk.path("curves.csv"), desk.path("curves.html"));
    signal("spectrum", &["--shaft", "disc", "-o", argument(&csv)]);
    let table = std::fs::read_to_string(&csv).unwrap();
    let mut lines = table.lines();
    assert_eq!(lines.next(), Some("order,amplitude [rad]"));
    let strongest = lines
        .map(|line| line.split_once(',').unwrap())
        .max_by(|a, b| a.1.parse::<f64>().unwrap().total_cmp(&b.1.parse().unwrap()));
    assert_near(strongest.unwrap().0.parse().unwrap(), 7.0);
    signal("map", &["--shaft", "disc", "-o", argument(&html)]);
    let page = std::fs::read_to_string(&html).unwrap();
    // At one speed over the time: a map, no lines.
    for part in ["orders over the time", "class=\"polar map\"", "Three tones"] {
        assert!(page.contains(part), "{part}");
    }
    assert!(!page.contains("data-kind=\"line\""));
}

#[test]
fn what_cannot_be_analysed_is_told() {
    let (desk, result) = result();
    let ask = |further: &[&str]| {
        let arguments = [&["signal"], further].concat();
        gearmesh(&arguments)
    };
    let file = argument(result);
    refused(
        &ask(&["statistics", file, "hinge"]),
        2,
        &["joints/hinge/angle_rad", "signal columns"],
    );
    let shaft = ["spectrum", file, ANGLE, "--shaft", "wheel"];
    refused(&ask(&shaft), 2, &["--shaft", "`wheel`", "rod, disc"]);
    // The rod swings to and fro: it has no orders.
    refused(
        &ask(&["spectrum", file, ANGLE, "--shaft", "rod"]),
        2,
        &["turn"],
    );
    let late = ["statistics", file, ANGLE, "--from-s", "3"];
    refused(&ask(&late), 2, &["found 3 to 2", "0 to 2"]);
    let picture = desk.path("picture.pdf");
    let drawn = ["statistics", file, ANGLE, "-o", argument(&picture)];
    refused(&ask(&drawn), 2, &["`pdf`", "csv and html"]);
    assert!(!picture.exists());
    let band = ["envelope", file, ANGLE, "--low", "30", "--high", "5000"];
    refused(&ask(&band), 2, &["upper end of the band", "5000"]);
    let many = [
        "average",
        file,
        ANGLE,
        "--shaft",
        "disc",
        "--periods-per-turn",
        "90",
    ];
    refused(&ask(&many), 2, &["--periods-per-turn", "90", "interval_s"]);
    let in_time = [
        "end_s = 2.0\n",
        "[solver]\nstep_s = 1e-4\n",
        "[output]\ninterval_s = 5e-4\n",
    ];
    let eigen = in_time
        .iter()
        .fold(SCENE.to_owned(), |scene, part| changed(&scene, part, ""));
    let scene = desk.file("eigen.toml", eigen.replace("transient", "eigen"));
    let other = desk.path("eigen.h5");
    succeeds(&["run", argument(&scene), "-o", argument(&other)]);
    refused(
        &ask(&["columns", argument(&other)]),
        2,
        &["`eigen`", "`transient`"],
    );
}

/// Every line that docs/results.md shows, word for word, on the result of the scene that it names, in longer steps.
#[test]
fn the_lines_that_the_documentation_shows_run() {
    let desk = Desk::new();
    let models = common::root().join("fe_models");
    let text = std::fs::read_to_string(models.join("dynamics_25_30.toml")).unwrap();
    for gear in ["pinion_25_m2.toml", "wheel_30_m2.toml"] {
        std::fs::copy(models.join(gear), desk.path(gear)).unwrap();
    }
    let scene = desk.file(
        "scene.toml",
        changed(&text, "step_s = 2e-6", "step_s = 1e-5"),
    );
    std::fs::create_dir(desk.path("out")).unwrap();
    let result = desk.path("out/25_30.h5");
    succeeds(&["run", argument(&scene), "-o", argument(&result)]);
    let page = std::fs::read_to_string(common::root().join("docs/results.md")).unwrap();
    let lines = page
        .lines()
        .filter_map(|line| line.strip_prefix("gearmesh "));
    let lines: Vec<&str> = lines.filter(|line| line.contains("out/25_30.h5")).collect();
    assert!(lines.len() >= 4, "{lines:?}");
    for line in lines {
        let words: Vec<&str> = line.split_whitespace().collect();
        let mut program = common::program(&words);
        program.current_dir(desk.path(""));
        let answer = common::ends(program, std::time::Duration::from_secs(60));
        assert_eq!(answer.code, Some(0), "{line}: {}", answer.stderr);
        assert!(!answer.stdout.is_empty(), "{line}");
        if let Some(output) = words.iter().position(|word| *word == "-o") {
            assert!(desk.path(words[output + 1]).is_file(), "{line}");
        }
    }
}
