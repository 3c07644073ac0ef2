//! What a new user types first: `init`, `doctor`, `completions`, `man`.

use crate::common::{
    Desk, argument, changed, gearmesh, names_in, program, refused, succeeds, workshop,
};
use std::process::Command;

#[test]
fn what_was_written_is_told_as_json_on_request() {
    let desk = Desk::new();
    let folder = desk.path("gear");
    let told = succeeds(&["init", "gear", "-o", argument(&folder), "--json"]).json();
    assert_eq!(told["files"][0], argument(&folder.join("pinion.toml")));
}

#[test]
fn what_init_writes_passes_check_and_runs() {
    let desk = Desk::new();
    for (kind, files) in [
        ("gear", &["pinion.toml"][..]),
        (
            "pair",
            &["drive.toml", "pair.toml", "pinion.toml", "wheel.toml"][..],
        ),
        (
            "gearbox",
            &["gearbox.toml", "pinion.toml", "wheel.toml"][..],
        ),
        (
            "planetary",
            &[
                "planetary.toml",
                "planetary_planet.toml",
                "planetary_ring.toml",
                "planetary_sun.toml",
            ][..],
        ),
        (
            "bevel",
            &[
                "bevel_drive.toml",
                "bevel_gear.toml",
                "bevel_pair.toml",
                "bevel_pinion.toml",
            ][..],
        ),
    ] {
        let folder = desk.path(kind);
        succeeds(&["init", kind, "-o", argument(&folder)]);
        assert_eq!(names_in(&folder), files);
        for file in files.iter().filter(|name| **name != "pair.toml") {
            succeeds(&["check", argument(&folder.join(file))]);
        }
        // What is there is left as it is.
        refused(
            &gearmesh(&["init", kind, "-o", argument(&folder)]),
            2,
            &["there already", files[0]],
        );
    }
    // The pair wants reduced gears: those of the workshop stand in for them.
    let text = std::fs::read_to_string(desk.path("pair").join("pair.toml")).unwrap();
    let (solid, thin) = (
        argument(&workshop().solid).to_owned(),
        argument(&workshop().thin).to_owned(),
    );
    let text = changed(
        &changed(&text, "\"pinion.h5\"", &format!("{solid:?}")),
        "\"wheel.h5\"",
        &format!("{thin:?}"),
    );
    let text = changed(
        &changed(&text, "94.6 ", "54.7 "),
        "gear_1 = [\"root\"]",
        "gear_2 = [\"tension\"]",
    );
    succeeds(&[
        "check",
        argument(&desk.file("pair_of_the_workshop.toml", text)),
    ]);
    for kind in ["gearbox", "planetary"] {
        let scene = desk.path(kind).join(format!("{kind}.toml"));
        let result = desk.path(&format!("{kind}.h5"));
        succeeds(&["run", argument(&scene), "-o", argument(&result)]);
    }
}

/// What a set prints first: how its planets share the load; the same in the JSON. One pin is 20 um ahead.
#[test]
fn a_planetary_set_to_start_with_says_how_its_planets_share_the_load() {
    let desk = Desk::new();
    let folder = desk.path("planetary");
    succeeds(&["init", "planetary", "-o", argument(&folder)]);
    let scene = folder.join("planetary.toml");
    let plan = succeeds(&["plan", argument(&scene)]).stdout;
    for part in [
        "planetary  set: z 27 (sun), 24 (planet), 75 (ring), 3 planets at 0, 120, 240 deg",
        "ratio 3.777778",
        "in phase",
        "set planet 3",
    ] {
        assert!(plan.contains(part), "`{part}` is not in {plan}");
    }
    assert!(!plan.contains("warning"), "{plan}");
    let told = succeeds(&[
        "run",
        argument(&scene),
        "-o",
        argument(&desk.path("set.h5")),
    ])
    .stdout;
    for part in [
        "planetary set set, over the 12 equilibria",
        "K_gamma",
        "sun share",
    ] {
        assert!(told.contains(part), "`{part}` is not in {told}");
    }
    let told = succeeds(&[
        "run",
        argument(&scene),
        "-o",
        argument(&desk.path("again.h5")),
        "--json",
    ])
    .json();
    let shares = told["planetary"]["set"]["sun"]["share_mean"]
        .as_array()
        .unwrap();
    let sum: f64 = shares.iter().map(|share| share.as_f64().unwrap()).sum();
    assert!((sum - 3.0).abs() < 1e-9, "{shares:?}");
    // The pin that is ahead carries less.
    assert!(shares[0].as_f64().unwrap() < 0.9, "{shares:?}");
    // A pin carries both meshes of its planet, across the line of centres: 2 F cos 20 deg. The pin's force is the
    // largest over the equilibria, and so is the share beside the mean force; 1 %: sun and ring need not be largest at
    // the same one.
    let numbers = |found: &serde_json::Value| -> Vec<f64> {
        let list = found.as_array().unwrap().iter();
        list.map(|number| number.as_f64().unwrap()).collect()
    };
    let set = &told["planetary"]["set"];
    let [force, mean, largest] =
        ["normal_force_N", "share_mean", "share_largest"].map(|key| numbers(&set["sun"][key]));
    for (planet, pin) in numbers(&set["pin_force_N"]).iter().enumerate() {
        let mesh = force[planet] * largest[planet] / mean[planet];
        let expected = 2.0 * mesh * 20f64.to_radians().cos();
        assert!((pin / expected - 1.0).abs() < 0.01, "{pin} {expected}");
    }
}

/// The pair's contact under its torques, and the pair in motion, both from what `init` wrote.
#[test]
fn a_bevel_pair_to_start_with_is_analysed_and_runs() {
    let desk = Desk::new();
    let folder = desk.path("bevel");
    let told = succeeds(&["init", "bevel", "-o", argument(&folder)]);
    assert!(
        told.stderr.contains("gearmesh tca bevel_pair.toml"),
        "{}",
        told.stderr
    );
    let pair = folder.join("bevel_pair.toml");
    let free = succeeds(&["tca", argument(&pair), "--json"]).json();
    assert!(free["path"].as_array().unwrap().len() > 10, "{free}");
    let (scene, result) = (folder.join("bevel_drive.toml"), desk.path("drive.h5"));
    let run = succeeds(&["run", argument(&scene), "-o", argument(&result)]);
    // 17 teeth at 10 turns a second.
    assert!(run.stdout.contains("170.000 Hz"), "{}", run.stdout);
}

#[test]
fn doctor_says_where_python_is_and_what_the_variable_does() {
    let answer = succeeds(&["doctor"]);
    for word in [
        "ok      python: 3.",
        "ok      gmsh: 4.",
        "ok      meshio: 5.",
        "processors",
    ] {
        assert!(
            answer.stdout.contains(word),
            "{word} is not in {}",
            answer.stdout
        );
    }
    let found = succeeds(&["doctor", "--json"]).json();
    assert!(
        found
            .as_array()
            .unwrap()
            .iter()
            .any(|f| f["name"] == "gmsh" && f["sound"] == true)
    );
    let output = program(&["doctor"])
        .env("GEARMESH_PYTHON", "/no/such/python")
        .output()
        .unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(1));
    for word in [
        "MISSING python",
        "/no/such/python (GEARMESH_PYTHON)",
        "pip install ./gearmesh-*.whl",
        "With the sources: cargo xtask prepare",
        "gmsh meshio",
    ] {
        assert!(text.contains(word), "{word} is not in {text}");
    }
    // Of the archive, whose users have no cargo: alone in a folder without a Python beside or above it.
    let desk = Desk::new();
    let alone = desk.path("gearmesh");
    let built = env!("CARGO_BIN_EXE_gearmesh");
    std::fs::hard_link(built, &alone)
        .or_else(|_| std::fs::copy(built, &alone).map(|_| ()))
        .unwrap();
    let output = Command::new(&alone)
        .arg("doctor")
        .env_remove("GEARMESH_PYTHON")
        .output()
        .unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(
        text.contains("unpacked archive") && !text.contains("xtask demo"),
        "{text}"
    );
}

#[test]
fn completions_and_manual_pages_know_all_commands() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = succeeds(&["completions", shell]).stdout;
        for command in ["bearing-frequencies", "import", "tca"] {
            assert!(script.contains(command), "{shell}: {command}");
        }
    }
    let desk = Desk::new();
    succeeds(&["man", "-o", argument(&desk.path("man"))]);
    let pages = names_in(&desk.path("man"));
    for page in ["gearmesh.1", "gearmesh-run.1", "gearmesh-signal-spectrum.1"] {
        assert!(
            pages.iter().any(|p| p == page),
            "{page} is not among {pages:?}"
        );
    }
}

#[test]
fn nothing_that_is_piped_has_colours() {
    for arguments in [
        &["--help"][..],
        &["run"],
        &["no-such-command"],
        &["check", "no_such_file.toml"],
    ] {
        let answer = gearmesh(arguments);
        assert!(
            !answer.stdout.contains('\u{1b}') && !answer.stderr.contains('\u{1b}'),
            "{arguments:?}"
        );
    }
}
