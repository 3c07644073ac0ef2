//! `gearmesh bearing` and `gearmesh bearing-frequencies`.

use crate::common::{Desk, argument, gearmesh, refused, succeeds};

const B218: &str = r#"name = "218"
kind = "angular-contact"
balls = 16
ball_diameter_mm = 22.23
pitch_diameter_mm = 125.3
inner_conformity = 0.5232
outer_conformity = 0.5232
contact_angle_deg = 40.0
"#;

fn near(value: &serde_json::Value, expected: f64, relative: f64) {
    let found = value.as_f64().unwrap();
    assert!(
        (found / expected - 1.0).abs() < relative,
        "{found}, expected {expected}"
    );
}

/// The figures of a 218 under thrust (tools/reference/bearings.py), and its life.
#[test]
fn a_bearing_under_thrust() {
    let desk = Desk::new();
    let file = desk.file("218.toml", B218);
    let answer = succeeds(&[
        "bearing",
        argument(&file),
        "--load-N",
        "0,0,17800",
        "--json",
    ]);
    let json = answer.json();
    near(&json["displacement_um"][2], 36.097055628, 1e-8);
    let ball = &json["rows"][0][3];
    near(&ball["inner_load_N"], 1678.87935, 1e-8);
    near(&ball["inner_contact_angle_deg"], 41.5019, 1e-5);
    // p₀ = 3Q/(2πab) of the printed ellipse.
    let ellipse = |key: &str| ball[key].as_f64().unwrap();
    let area =
        std::f64::consts::PI * ellipse("inner_half_length_mm") * ellipse("inner_half_width_mm");
    near(&ball["inner_pressure_MPa"], 1.5 * 1678.87935 / area, 1e-7);
    // P = 0.57 F_a at 40 degrees; L10 = (C/P)³.
    near(&json["life"]["equivalent_N"], 0.57 * 17800.0, 1e-12);
    let c = json["ratings"]["dynamic_N"].as_f64().unwrap();
    near(
        &json["life"]["L10_Mrev"],
        (c / (0.57 * 17800.0)).powi(3),
        1e-12,
    );
    let text = succeeds(&[
        "bearing",
        argument(&file),
        "--load-N",
        "0,0,17800",
        "--speed-rpm",
        "10000",
    ])
    .stdout;
    for part in ["z 14.6564 um", "1452.070   1924.160", "50.0092 31.2608"] {
        assert!(text.contains(part), "`{part}` is not in {text}");
    }
}

/// Seed 002's bearing: 0.3991, 3.5913 and 5.4087 times the shaft speed (docs/sources.md).
#[test]
fn frequencies_of_seed_002() {
    let desk = Desk::new();
    let text = "name = \"seed 002\"\nkind = \"deep-groove\"\nballs = 9\nball_diameter_mm = 7.94\npitch_diameter_mm = 39.32\n\
                inner_conformity = 0.52\nouter_conformity = 0.52\n";
    let file = desk.file("bearing.toml", text);
    let json = succeeds(&[
        "bearing-frequencies",
        argument(&file),
        "--speed-rpm",
        "600",
        "--json",
    ])
    .json();
    near(&json["FTF_Hz"], 3.990336, 1e-6);
    near(&json["BPFO_Hz"], 35.9130, 1e-5);
    near(&json["BPFI_Hz"], 54.0870, 1e-5);
    near(&json["BSF_Hz"], 23.7510, 1e-4);
    // REFERENCES: 6205 as in Case Western Reserve's data; 2 BSF is 4.713443 there.
    let text = text.replace("7.94", "7.94004").replace("39.32", "39.0398");
    let file = desk.file("6205.toml", &text);
    let json = succeeds(&["bearing-frequencies", argument(&file), "--json"]).json();
    near(&json["FTF_Hz"], 0.398308, 2e-6);
    near(&json["BPFO_Hz"], 3.584776, 2e-6);
    near(&json["BPFI_Hz"], 5.415224, 2e-6);
    near(&json["BSF_Hz"], 0.5 * 4.713443, 1e-6);
}

#[test]
fn bad_loads_and_files_are_refused() {
    let desk = Desk::new();
    let file = desk.file("218.toml", B218);
    let bearing = |more: &[&str]| {
        let mut all = vec!["bearing", argument(&file)];
        all.extend(more);
        gearmesh(&all)
    };
    refused(
        &bearing(&["--load-N", "1,2"]),
        2,
        &["--load-N", "found 1,2", "3 numbers"],
    );
    refused(&bearing(&["--load-N", "1,nan,2"]), 2, &["--load-N", "NaN"]);
    refused(
        &bearing(&["--load-N", "0,0,1", "--tilt-mrad", "500,0"]),
        2,
        &["--tilt-mrad"],
    );
    refused(
        &bearing(&[
            "--load-N",
            "0,0,1",
            "--viscosity-mm2-per-s",
            "20",
            "--contamination",
            "0.5",
        ]),
        2,
        &["--speed-rpm"],
    );
    // Pulled out of its groove.
    refused(
        &bearing(&["--load-N", "0,0,-100"]),
        1,
        &["pulls the rings", "second row"],
    );
    let rollers = "name = \"NU\"\nkind = \"cylindrical-roller\"\nrollers = 12\nroller_diameter_mm = 7.5\nroller_length_mm = 9.0\npitch_diameter_mm = 33.5\n";
    let file = desk.file("rollers.toml", rollers);
    let answer = gearmesh(&["bearing", argument(&file), "--load-N", "100,0,1"]);
    refused(&answer, 2, &["--load-N", "axial"]);
    let file = desk.file("wrong.toml", B218.replace("balls = 16", "balls = 99"));
    let answer = gearmesh(&["check", argument(&file)]);
    refused(&answer, 2, &["wrong.toml:3: balls", "found 99"]);
}

/// The page has the loads all round and the figures; the picture's largest bar is the largest load.
#[test]
fn a_page_shows_the_loads() {
    let desk = Desk::new();
    let file = desk.file("218.toml", B218);
    let page = desk.path("218.html");
    let load = ["bearing", argument(&file), "--load-N", "8000,0,17800"];
    succeeds(
        &[
            &load[..],
            &["--speed-rpm", "3000", "--report", argument(&page)],
        ]
        .concat(),
    );
    let text = std::fs::read_to_string(&page).unwrap();
    for part in [
        "Load on each element",
        "Contact angle",
        "Peak pressure",
        "L10r",
        "3000 rpm",
    ] {
        assert!(text.contains(part), "`{part}` is not in the page");
    }
    // Sixteen balls at two races, and eight rays.
    assert_eq!(text.matches("stroke=\"var(--c").count(), 32);
    let other = desk.path("218.pdf");
    let asked = [&load[..], &["--report", argument(&other)]].concat();
    refused(
        &gearmesh(&asked),
        2,
        &["--report", ".pdf: this writes", ".html"],
    );
    let same = [&load[..], &["--report", argument(&file)]].concat();
    refused(&gearmesh(&same), 2, &["is read by this command"]);
}

/// Faults that need motion are refused with what to do; those of races act at rest.
#[test]
fn faults_at_rest() {
    let desk = Desk::new();
    let with = |name: &str, fault: &str| desk.file(name, format!("{B218}[[fault]]\n{fault}"));
    let load = |file: &std::path::Path| {
        ["bearing", argument(file), "--load-N", "0,0,17800"].map(str::to_owned)
    };
    let askew = with(
        "askew.toml",
        "kind = \"misaligned-ring\"\nring = \"outer\"\ntilt_mrad = [1.0, 0.0]\n",
    );
    let words = load(&askew);
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    refused(&gearmesh(&words), 2, &["misaligned ring", "--tilt-mrad"]);
    let ball = with(
        "ball.toml",
        "kind = \"ball-spall\"\nball = 1\ndiameter_mm = 1.0\ndepth_um = 5.0\n",
    );
    let words = load(&ball);
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    refused(&gearmesh(&words), 2, &["spall on a ball", "`dynamic`"]);
    let large = with(
        "large.toml",
        "kind = \"off-size-ball\"\nball = 5\noversize_um = 5.0\n",
    );
    let words = load(&large);
    let mut words: Vec<&str> = words.iter().map(String::as_str).collect();
    words.push("--json");
    let json = succeeds(&words).json();
    let load = |ball: usize| json["rows"][0][ball]["inner_load_N"].as_f64().unwrap();
    assert!(load(4) > 1.05 * load(3) && load(4) > 1.05 * load(5));
}

/// Without load nothing is written as -0, and life is unlimited.
#[test]
fn a_bearing_without_load_has_plain_zeros() {
    let desk = Desk::new();
    let file = desk.file("218.toml", B218);
    let text = succeeds(&["bearing", argument(&file), "--load-N", "0,0,0"]).stdout;
    assert!(!text.contains("-0.0"), "{text}");
    assert!(text.contains("L10r unlimited"), "{text}");
    let sunk = ["bearing", argument(&file), "--load-N", "0,0,-100"];
    refused(
        &gearmesh(&sunk),
        1,
        &["a second row, or turn the load round"],
    );
}

/// The clearance in operation stands in print, page and JSON, its terms sum up, and the balls have it.
#[test]
fn a_fit_is_printed_term_by_term() {
    let desk = Desk::new();
    let text = "kind = \"catalogue\"\ndesignation = \"6205\"\nradial_clearance_um = 20.0\n[fit]\nshaft_interference_um = 9.0\n\
                inner_ring_temperature_C = 70.0\nouter_ring_temperature_C = 60.0\n";
    let file = desk.file("fitted.toml", text);
    let page = desk.path("fitted.html");
    let load = ["bearing", argument(&file), "--load-N", "1000,0,0"];
    let json = succeeds(&[&load[..], &["--json", "--report", argument(&page)]].concat()).json();
    let clearance = &json["clearance"];
    let um = |key: &str| clearance[key].as_f64().unwrap();
    let terms = [
        "stated_um",
        "by_shaft_um",
        "by_housing_um",
        "by_inner_ring_heat_um",
        "by_outer_ring_heat_um",
        "by_element_heat_um",
    ];
    let sum: f64 = terms.into_iter().map(um).sum();
    near(&clearance["operating_um"], sum, 1e-12);
    assert!(um("operating_um") < 12.0 && um("by_shaft_um") < -7.0);
    let print = succeeds(&load).stdout;
    let page = std::fs::read_to_string(&page).unwrap();
    for (words, unit) in [(&print, "um"), (&page, "µm")] {
        assert!(words.contains("heat of the inner ring"), "{words}");
        let interference = format!("shaft: interference in operation 9.00 {unit}, pressure ");
        assert!(words.contains(&interference), "{words}");
    }
    let plain = text
        .split("[fit]")
        .next()
        .unwrap()
        .replace("20.0", &um("operating_um").to_string());
    let file = desk.file("plain.toml", plain);
    let other = succeeds(&["bearing", argument(&file), "--load-N", "1000,0,0", "--json"]).json();
    near(
        &json["displacement_um"][0],
        other["displacement_um"][0].as_f64().unwrap(),
        1e-4,
    );
    assert!(other.get("clearance").is_none());
}

/// Friction stands in print, page and JSON; a missing ball is reported by name.
#[test]
fn friction_and_missing_balls_are_printed() {
    let desk = Desk::new();
    let text = format!(
        "{B218}[friction]\nviscosity_mm2_per_s = 30.0\nseal_torque_Nm = 0.1\n[[fault]]\nkind = \"missing\"\nelement = 3\n"
    );
    let file = desk.file("rubs.toml", text);
    let page = desk.path("rubs.html");
    let load = [
        "bearing",
        argument(&file),
        "--load-N",
        "0,0,17800",
        "--speed-rpm",
        "1500",
    ];
    let json = succeeds(&[&load[..], &["--json", "--report", argument(&page)]].concat()).json();
    let friction = |key: &str| json["friction"][key].as_f64().unwrap();
    near(
        &json["friction"]["torque_Nm"],
        friction("viscous_Nm") + friction("load_Nm") + 0.1,
        1e-12,
    );
    near(
        &json["friction"]["power_W"],
        friction("torque_Nm") * 50.0 * std::f64::consts::PI,
        1e-12,
    );
    assert_eq!(json["rows"][0][2]["missing"], true);
    let print = succeeds(&load).stdout;
    assert!(
        print.contains("friction torque") && print.contains("power loss"),
        "{print}"
    );
    assert!(print.contains("  45.00         missing"), "{print}");
    assert!(
        std::fs::read_to_string(&page)
            .unwrap()
            .contains("power loss")
    );
}

/// Figures beyond their limits are warned of on the console, in JSON and on the page, each with figure and limit; slips
/// of units when the file is read.
#[test]
fn limits_and_slips_of_units_are_warned_of() {
    let desk = Desk::new();
    let file = desk.file("218.toml", B218);
    let page = desk.path("218.html");
    let answer = succeeds(&[
        "bearing",
        argument(&file),
        "--load-N",
        "0,0,400000",
        "--speed-rpm",
        "5000",
        "--viscosity-mm2-per-s",
        "20",
        "--contamination",
        "0.5",
        "--report",
        argument(&page),
        "--json",
    ]);
    let json = answer.json();
    let found = json["warnings"].as_array().unwrap();
    let concerns: Vec<&str> = found
        .iter()
        .map(|warning| warning["concern"].as_str().unwrap())
        .collect();
    assert_eq!(
        concerns,
        [
            "static-safety",
            "shoulder",
            "shoulder",
            "life-load",
            "speed"
        ]
    );
    // P0 = 0.26 F_a; n d_m = 5000 x 125.3.
    near(&json["static_safety"]["equivalent_N"], 104_000.0, 1e-12);
    near(&found[4]["value"], 626_500.0, 1e-12);
    near(&found[4]["limit"], 500_000.0, 1e-12);
    let text = std::fs::read_to_string(&page).unwrap();
    for warning in found {
        let sentence = warning["text"].as_str().unwrap();
        assert!(
            answer.stderr.contains(&format!("warning: {sentence}")),
            "{sentence}"
        );
        let concern = sentence.split(':').next().unwrap();
        assert!(text.contains(&format!("Warning: {concern}")), "{concern}");
    }
    assert!(text.contains("L10mr"));
    let sound = succeeds(&["bearing", argument(&file), "--load-N", "0,0,20000"]);
    assert!(!sound.stderr.contains("warning"), "{}", sound.stderr);
    let slipped = format!(
        "{B218}[ratings]\ndynamic_N = 14.0\n[element_material]\nyoung_GPa = 206000.0\npoisson = 0.3\ndensity_kg_per_m3 = 7.85\n"
    );
    let file = desk.file("slipped.toml", slipped);
    for command in [
        &["check", argument(&file)][..],
        &["bearing", argument(&file), "--load-N", "0,0,100"],
    ] {
        let answer = succeeds(command);
        for part in [
            "ratings.dynamic_N: 14 is unusual",
            "14 kN are 14000 N",
            "element_material.young_GPa: 206000 is unusual",
            "element_material.density_kg_per_m3: 7.85 is unusual",
        ] {
            assert!(
                answer.stderr.contains(part),
                "`{part}` is not in {}",
                answer.stderr
            );
        }
    }
}
