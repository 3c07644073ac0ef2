//! `gearmesh study`: cases, figures, what is wrong with a study.

use crate::common;

use common::{Desk, argument, changed, gearmesh, number, refused, succeeds};

/// A wheel of 0.5 kg m² that a torque turns for a second: ω(1) = T/J.
const SCENE: &str = include_str!("../../../../tests/support/wheel.toml");

const STUDY: &str = r#"title = "Torque"
scene = "scene.toml"
columns = ["bodies/wheel/angular_velocity_z_rad_per_s"]
[[parameter]]
name = "torque"
keys = ["load.0.torque_Nm"]
values = [4.0]
"#;

#[test]
fn a_study_prints_its_cases_and_keeps_its_results() {
    let desk = Desk::new();
    desk.file("scene.toml", SCENE);
    let study = desk.file("study.toml", STUDY);
    let out = desk.path("out");
    let command = ["study", argument(&study), "-o", argument(&out)];
    let told = succeeds(&command).stdout;
    assert!(told.starts_with("Torque, from 0 s on\n"), "{told}");
    let line = |name: &str| told.lines().find(|line| line.starts_with(name)).unwrap();
    for (name, last) in [("as it is", "4.000"), ("torque = 4.0", "8.000")] {
        assert!(line(name).ends_with(last), "{told}");
    }
    let names = common::names_in(&out);
    let files = succeeds(&[&command[..], &["--json"]].concat()).json();
    assert_eq!(common::names_in(&out), names);
    assert!(
        names.contains(&"study.csv".to_owned()) && names.len() == 4,
        "{names:?}"
    );
    let page = std::fs::read_to_string(out.join("study.html")).unwrap();
    assert!(page.contains("All cases") && page.contains("torque = 4.0"));
    let case = &files["cases"][1];
    assert_eq!(number(&case["parameters"]["torque"]), 4.0);
    assert!((number(&case["columns"][0]["largest"]) - 8.0).abs() < 1e-9);
}

/// Results that together are large are refused before the first case, by the program of studies and of optimisations.
#[test]
fn large_results_are_refused_until_they_are_allowed() {
    let desk = Desk::new();
    desk.file(
        "scene.toml",
        changed(SCENE, "interval_s = 1e-2", "interval_s = 1e-5"),
    );
    let study = desk.file("study.toml", STUDY);
    let out = desk.path("out");
    let words = [
        "study",
        argument(&study),
        "-o",
        argument(&out),
        "--most-result-GB",
    ];
    // Two cases of 100 001 rows of 38 columns.
    let told = [
        "the results of its 2 cases together will have 60.8 MB, allowed are 0.05 GB",
        "--most-result-GB 1 ",
    ];
    refused(&gearmesh(&[&words[..], &["0.05"]].concat()), 2, &told);
    assert!(!out.exists());
    let search = desk.file(
        "optimise.toml",
        "title = \"t\"\nscene = \"scene.toml\"\ntrials = 20\n[[variable]]\nname = \"torque\"\nkeys = [\"load.0.torque_Nm\"]\nfrom = 1.0\nto = 2.0\n\
         [[objective]]\nname = \"speed\"\nterm = [{ column = \"bodies/wheel/angular_velocity_z_rad_per_s:largest\" }]\n",
    );
    let words = [
        "optimise",
        argument(&search),
        "-o",
        argument(&out),
        "--most-result-GB",
        "0.03",
    ];
    refused(
        &gearmesh(&words),
        2,
        &["the result of each trial will have 30.4 MB, allowed are 0.03 GB"],
    );
    assert!(!out.exists());
}

/// Figures of a sweep are those of its speeds, of a static run those of its equilibria: no time is told with them.
#[test]
fn what_figures_are_taken_over_is_told() {
    let desk = Desk::new();
    let time = "[solver]\nstep_s = 1e-3\n[output]\ninterval_s = 1e-3";
    let sweep = "kind = \"speed-sweep\"\nmotion = \"driver\"\nfrom_rpm = 10.0\nto_rpm = 20.0\nspeeds = 3\nsettle_s = 0.1\nmeasure_s = 0.1";
    let still = "kind = \"static\"\nload_factors = [0.5, 1.0]";
    for (run, held, over) in [
        (
            format!("{sweep}\n{time}"),
            "[[motion]]\nname = \"driver\"\njoint = \"hinge\"\nspeed_rpm = 10.0",
            "over all speeds",
        ),
        (
            still.to_owned(),
            "[[load]]\nbody = \"rod\"\ntorque_Nm = 0.5",
            "over all equilibria",
        ),
        (
            format!("kind = \"transient\"\nend_s = 0.1\n{time}"),
            "",
            "from 0 s on",
        ),
    ] {
        let scene = format!(
            "title = \"rod\"\ngravity_m_per_s2 = [0.0, -9.81, 0.0]\n[run]\n{run}\n\
             [[body]]\nname = \"rod\"\nmass_kg = 1.0\ninertia_kg_m2 = [1e-3, 1e-3, 1e-3]\ncentre_of_mass_mm = [0.0, -100.0, 0.0]\n\
             [[joint]]\nname = \"hinge\"\nkind = \"revolute\"\nbody_2 = \"rod\"\n{held}\n"
        );
        desk.file("scene.toml", scene);
        let study = desk.file(
            "study.toml",
            "title = \"rods\"\nscene = \"scene.toml\"\ncolumns = [\"joints/hinge/force_y_N\"]\n\
             [[parameter]]\nname = \"mass\"\nkeys = [\"body.0.mass_kg\"]\nvalues = [2.0]\n",
        );
        let out = desk.path("out");
        let told = succeeds(&["study", argument(&study), "-o", argument(&out)]).stdout;
        assert_eq!(
            told.lines().next(),
            Some(&format!("rods, {over}")[..]),
            "{told}"
        );
    }
}

/// Of a bevel pair under load, columns under load have a number for each torque, those without load one number and say
/// so.
#[test]
fn what_is_without_load_stands_once() {
    let desk = Desk::new();
    let shipped = format!(
        "{}/../../fe_models/bevel_20_20_loaded.toml",
        env!("CARGO_MANIFEST_DIR")
    );
    desk.file("pair.toml", std::fs::read_to_string(shipped).unwrap());
    let study = desk.file(
        "study.toml",
        "title = \"loaded\"\nscene = \"pair.toml\"\ncolumns = [\"te_peak_to_peak_urad\", \"loaded_te_peak_to_peak_urad\"]\n\
         [[parameter]]\nname = \"offset\"\nkeys = [\"tca.offset_um\"]\nvalues = [20.0, 30.0]\n",
    );
    let out = desk.path("out");
    let told = succeeds(&["study", argument(&study), "-o", argument(&out)]).stdout;
    let cells: Vec<Vec<&str>> = told
        .lines()
        .map(|l| l.split_whitespace().collect())
        .collect();
    assert_eq!(
        told.lines().nth(1),
        Some("te_peak_to_peak_urad, the same at every torque")
    );
    assert_eq!(cells[2], ["as", "it", "is", "52.10"], "{told}");
    assert_eq!(cells[5], ["loaded_te_peak_to_peak_urad"], "{told}");
    assert_eq!(cells[7].len(), 6, "{told}");
    // The page draws it once as well, beside a curve for each of the three torques.
    let page = std::fs::read_to_string(out.join("study.html")).unwrap();
    let entries: Vec<&str> = page
        .split("class=\"key\"")
        .skip(1)
        .filter_map(|entry| entry.split("</span> ").nth(1)?.split("</span>").next())
        .collect();
    assert_eq!(
        entries,
        [
            "the same at every torque",
            "50 N·m",
            "100 N·m",
            "200 N·m",
            "cases",
            "front"
        ],
        "{entries:?}"
    );
}

#[test]
fn a_wrong_study_is_refused_and_a_failed_case_is_told() {
    let desk = Desk::new();
    desk.file("scene.toml", SCENE);
    let out = desk.path("out");
    let run = |name: &str, text: String| {
        let study = desk.file(name, text);
        gearmesh(&["study", argument(&study), "-o", argument(&out)])
    };
    let answer = run("key.toml", changed(STUDY, "load.0", "load.1"));
    refused(
        &answer,
        2,
        &["key.toml:6", "`load.1.torque_Nm`", "items 0 to 0"],
    );
    assert!(!out.exists());
    let answer = run(
        "column.toml",
        changed(STUDY, "angular_velocity_z", "speed_z"),
    );
    refused(
        &answer,
        2,
        &[
            "column.toml:3",
            "bodies/wheel/speed_z",
            "the scene has `time_s`",
        ],
    );
    assert!(!out.exists());
    // A run that ends before the figures begin.
    let late = changed(STUDY, "columns =", "from_s = 1.5\ncolumns =");
    let answer = run("late.toml", late);
    assert_eq!(answer.code, Some(1), "{answer:#?}");
    assert!(answer.stderr.contains("2 of 2 cases failed"), "{answer:#?}");
    assert!(
        answer
            .stdout
            .contains("torque = 4.0 failed: from_s = 1.5 is after the end"),
        "{}",
        answer.stdout
    );
}

/// Two studies that begin together in one folder share its cases: both end with all of them, and nothing is left over.
#[test]
fn two_studies_in_one_folder_end_clean() {
    let desk = Desk::new();
    desk.file(
        "scene.toml",
        changed(SCENE, "step_s = 1e-2", "step_s = 1e-4"),
    );
    // 2 N m is the scene as it is.
    let values: Vec<String> = (3..=14).map(|k| format!("{k}.0")).collect();
    let text = changed(STUDY, "[4.0]", &format!("[{}]", values.join(", ")));
    let study = desk.file("study.toml", &text);
    let out = desk.path("out");
    let words = ["study", argument(&study), "-o", argument(&out), "--json"];
    let both = [common::begin(&words), common::begin(&words)]
        .map(|child| child.wait_with_output().unwrap());
    let figures = both.map(|output| {
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{told}");
        serde_json::from_slice::<serde_json::Value>(&output.stdout).unwrap()
    });
    for all in &figures {
        let cases = all["cases"].as_array().unwrap();
        assert_eq!(cases.len(), 13);
        for (k, case) in cases.iter().enumerate().skip(1) {
            let speed = number(&case["columns"][0]["largest"]);
            assert!((speed - 2.0 * (k + 2) as f64).abs() < 1e-9, "{k}: {speed}");
        }
    }
    let names = common::names_in(&out);
    let results = names.iter().filter(|name| name.ends_with(".h5")).count();
    assert_eq!((names.len(), results), (15, 13), "{names:?}");
    // What they left is whole: a third study has nothing to run.
    let csv = std::fs::read(out.join("study.csv")).unwrap();
    succeeds(&["study", argument(&study), "-o", argument(&out)]);
    assert_eq!(std::fs::read(out.join("study.csv")).unwrap(), csv);
    assert_eq!(common::names_in(&out), names);
}

/// Functions of Python are told apart from what the program can compute, and what to do is said.
#[test]
fn a_scene_with_a_python_function_is_refused() {
    let desk = Desk::new();
    let text = changed(SCENE, "torque_Nm = 2.0", "torque_Nm = { python = \"fan\" }");
    let scene = desk.file("scene.toml", text);
    let out = desk.path("out.h5");
    let answer = gearmesh(&["run", argument(&scene), "-o", argument(&out)]);
    refused(
        &answer,
        2,
        &[
            "load.0.torque_Nm.python",
            "`fan`",
            "gearmesh.Scene",
            "functions",
        ],
    );
    assert!(!out.exists());
}

/// A table that a file of the study names has its part in the names of the results: other contents are computed anew,
/// those of before are found again.
#[test]
fn another_table_under_the_same_name_is_another_case() {
    let desk = Desk::new();
    let table = "torque_Nm = { table = { file = \"rig.csv\", column = \"torque_Nm\", time_column = \"time_s\" } }";
    desk.file("scene.toml", changed(SCENE, "torque_Nm = 2.0", table));
    let text = changed(STUDY, "load.0.torque_Nm", "body.0.mass_kg");
    let study = desk.file("study.toml", text);
    let out = desk.path("out");
    let run = |torque: &str| {
        desk.file(
            "rig.csv",
            format!("time_s,torque_Nm\n0,{torque}\n2,{torque}\n"),
        );
        let told = succeeds(&["study", argument(&study), "-o", argument(&out), "--json"]).json();
        let names = common::names_in(&out).into_iter();
        let results: Vec<String> = names.filter(|name| name.ends_with(".h5")).collect();
        let speeds = told["cases"].as_array().unwrap().iter();
        let speeds: Vec<f64> = speeds
            .map(|case| number(&case["columns"][0]["largest"]))
            .collect();
        (results, speeds)
    };
    let near = |found: &[f64], speed: f64| {
        assert!(
            found.len() == 2 && found.iter().all(|x| (x - speed).abs() < 1e-9),
            "{found:?}"
        );
    };
    let (first, speeds) = run("2.0");
    assert_eq!(first.len(), 2);
    near(&speeds, 4.0);
    let (second, speeds) = run("3.0");
    near(&speeds, 6.0);
    let new = second.iter().filter(|name| !first.contains(name));
    assert_eq!(new.count(), 2, "{first:?} {second:?}");
    let (third, speeds) = run("2.0");
    near(&speeds, 4.0);
    assert_eq!(third, second);
}

/// A gear in plane strain, reduced in a moment.
fn reduce_plane_gear(desk: &Desk) {
    let gear = desk.file(
        "gear.toml",
        changed(
            &changed(common::SOLID, "axial_mm = 3.0", "plane_strain = true"),
            "slices = 2\n",
            "",
        ),
    );
    let model = desk.path("gear.h5");
    succeeds(&["reduce", argument(&gear), "-o", argument(&model)]);
}

/// A pair of these gears.
const PLANE_PAIR: &str = "title = \"pair\"\n[pair]\ngear_1 = \"gear.h5\"\ngear_2 = \"gear.h5\"\ncentre_distance_mm = 54.7\n[mesh.model]\n\
     kind = \"hybrid\"\n[mesh.teeth]\npath = \"line-of-action\"\n[run]\ntorques_Nm = [60.0]\npitches = 1\npoints_per_pitch = 8\n";

/// Pressures under which steel yields are warned of also where nobody asks for pressures.
#[test]
fn pressures_that_no_steel_carries_are_warned_of_by_whatever_runs_a_scene_often() {
    let desk = Desk::new();
    reduce_plane_gear(&desk);
    let scene = desk.file("pair.toml", PLANE_PAIR);
    let study = desk.file(
        "study.toml",
        "title = \"t\"\nscene = \"pair.toml\"\ncolumns = [\"te_mean_um\"]\n[[parameter]]\nname = \"shift\"\n\
         keys = [\"pair.centre_distance_mm\"]\nvalues = [54.75]\n",
    );
    let search = desk.file(
        "search.toml",
        "title = \"t\"\nscene = \"pair.toml\"\ntrials = 20\n[[variable]]\nname = \"distance\"\nkeys = [\"pair.centre_distance_mm\"]\n\
         from = 54.7\nto = 54.8\n[[objective]]\nname = \"te\"\nterm = [{ column = \"te_peak_to_peak_um\" }]\n",
    );
    let out = ["studied", "sought"].map(|name| desk.path(name));
    let commands = [
        vec!["study", argument(&study), "-o", argument(&out[0])],
        vec!["optimise", argument(&search), "-o", argument(&out[1])],
        vec!["accuracy", argument(&scene), "--columns", "te_mean_um"],
    ];
    for (torque, is_warned) in [("60.0", false), ("60000.0", true)] {
        desk.file("pair.toml", changed(PLANE_PAIR, "60.0", torque));
        for words in &commands {
            let told = succeeds(words).stderr;
            let warned = told.contains("GPa") && told.contains("pressure reaches");
            assert_eq!(warned, is_warned, "{words:?} at {torque} N m: {told}");
        }
    }
}

/// Elements and element lengths are one more knob of `accuracy`, each rung a reduction that is kept: of gears in plane
/// strain, which take a moment.
#[test]
fn accuracy_varies_the_meshes_of_gears_and_keeps_them() {
    let desk = Desk::new();
    reduce_plane_gear(&desk);
    let scene = desk.file("pair.toml", PLANE_PAIR);
    let kept = desk.path("kept");
    std::fs::create_dir(&kept).unwrap();
    let words = ["accuracy", argument(&scene), "--columns", "te_mean_um"];
    let varied = |more: &[&str]| {
        let told = succeeds(&[&words[..], more].concat()).stdout;
        told.contains("gears' meshes")
    };
    assert!(!varied(&[]));
    let elements = ["--elements", argument(&kept)];
    assert!(varied(&elements));
    let models = || -> Vec<(String, std::time::SystemTime)> {
        let folder = std::fs::read_dir(kept.join("models")).unwrap();
        let mut all: Vec<_> = folder
            .map(|entry| entry.unwrap())
            .filter(|entry| {
                entry
                    .path()
                    .extension()
                    .is_some_and(|ending| ending == "h5")
            })
            .map(|entry| {
                let made = entry.metadata().unwrap().modified().unwrap();
                (entry.file_name().into_string().unwrap(), made)
            })
            .collect();
        all.retain(|(name, _)| name.ends_with(".h5"));
        all.sort();
        all
    };
    // Three rungs beside the gear as it is; both gears are the same.
    let first = models();
    assert_eq!(first.len(), 3, "{first:?}");
    assert!(varied(&elements));
    assert_eq!(models(), first);
}

/// The table of what lies in the folder, where nothing is computed.
#[test]
fn a_study_is_gathered_from_its_folder() {
    let desk = Desk::new();
    desk.file("scene.toml", SCENE);
    let study = desk.file("study.toml", STUDY);
    let out = desk.path("out");
    let command = ["study", argument(&study), "-o", argument(&out)];
    let whole = succeeds(&command).stdout;
    let failures = desk.file("failures.json", "{}");
    let gather = [&command[..], &["--gather", argument(&failures)]].concat();
    assert_eq!(succeeds(&gather).stdout, whole);
    let file = common::names_in(&out)
        .into_iter()
        .find(|name| name.ends_with(".h5"));
    std::fs::remove_file(out.join(file.unwrap())).unwrap();
    let answer = gearmesh(&gather);
    assert_eq!(answer.code, Some(1));
    assert!(answer.stderr.contains("1 of 2 cases failed"), "{answer:#?}");
    assert!(answer.stdout.contains("broken off"), "{answer:#?}");
}
