//! `gearmesh run`: balances, harmonics, local terms, paths of contact, ratings.

use crate::common::{
    Desk, SOLID, THIN, argument, changed, gearmesh, largest_difference, number, refused, run_scene,
    succeeds, workshop,
};
use crate::{hybrid_scene, largest, recovered};
use gearmesh_scene::SceneResult;

#[test]
fn run_balances_the_torque() {
    let desk = Desk::new();
    let (_, figures) = run_scene(&desk, "");
    let rows = figures["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 2);
    for row in rows {
        assert!(number(&row["torque_balance"]) < 1e-10, "{row}");
        assert!(number(&row["residual"]) < 1e-10, "{row}");
        assert!(
            number(&row["te_mean_m"]) < 0.0,
            "the driven gear lags under load: {row}"
        );
        assert!(
            number(&row["stiffness_tangent_mean_N_per_m"])
                > number(&row["stiffness_secant_mean_N_per_m"]),
            "{row}"
        );
    }
    assert!(number(&rows[1]["te_mean_m"]) < number(&rows[0]["te_mean_m"]));
    assert_eq!(figures["warnings"], serde_json::json!([]));
}

/// `--accuracy`: the figures are those of the lines that are printed to paste; a goal out of reach is a warning.
/// The stage of a pair in print, on the page and in JSON is that of a drive with the same gears.
#[test]
fn the_stage_of_a_pair_is_that_of_a_drive() {
    let desk = Desk::new();
    let (result, figures) = run_scene(&desk, "");
    let stage = &figures["stage"];
    assert!(number(&stage["contact_ratio"]) > 1.0, "{stage}");
    let drive = desk.file("drive.toml", hybrid_scene());
    let planned = succeeds(&["plan", argument(&drive)]).stdout;
    let words = |text: &str| {
        let line = text.lines().find(|line| line.starts_with("stage")).unwrap();
        let from = line.find("ratio").unwrap();
        line[from..line.find(" after ISO").unwrap()].to_owned()
    };
    let scene = desk.path("scene.toml");
    let printed = succeeds(&["run", argument(&scene), "-o", argument(&result)]).stdout;
    assert_eq!(words(&printed), words(&planned));
    let page = desk.path("page.html");
    succeeds(&["report", argument(&result), "-o", argument(&page)]);
    let page = std::fs::read_to_string(page).unwrap();
    assert!(page.contains("Stage: ratio") && !page.contains("eps_alpha"));
}

#[test]
fn a_run_within_a_goal_is_that_of_the_setting_it_names() {
    let desk = Desk::new();
    let scene = desk.file("scene.toml", workshop().scene(""));
    let run = |goal: &str, name: &str| {
        let output = desk.path(name);
        let words = ["run", argument(&scene), "-o", argument(&output), "--json"];
        let of = ["--accuracy", goal, "--columns", "te_mean_um"];
        succeeds(&[&words[..], &of].concat())
    };
    let answer = run("1%", "within.h5");
    let figures = answer.json();
    let found = &figures["accuracy"];
    assert_eq!(found["is_within"], true, "{found}");
    let error = number(&found["errors"]["te_mean_um"]);
    assert!(error > 0.0 && error <= 0.01, "{found}");
    let lines: Vec<&str> = (found["toml"].as_array().unwrap().iter())
        .map(|line| line.as_str().unwrap())
        .collect();
    let points = lines
        .iter()
        .find_map(|line| line.strip_prefix("run.points_per_pitch = "));
    let result = SceneResult::read(&desk.path("within.h5")).unwrap();
    assert_eq!(result.points_per_pitch().to_string(), points.unwrap());

    let found = &run("0.000001%", "beyond.h5");
    assert_eq!(found.json()["accuracy"]["is_within"], false);
    assert!(
        found.stderr.contains("no setting of this scene"),
        "{}",
        found.stderr
    );
    let scene = argument(&scene);
    for words in [&["--accuracy", "1"][..], &["--columns", "te_mean_um"]] {
        let output = desk.path("refused.h5");
        let all = [&["run", scene, "-o", argument(&output)][..], words].concat();
        refused(&gearmesh(&all), 2, &["--accuracy"]);
        assert!(!output.exists());
    }
    let pair = desk.file("pair.toml", "[pinion]\nteeth = 13\n[wheel]\nteeth = 30\n");
    let refusal = |words: &[&str]| {
        let output = desk.path("refused.h5");
        let all = [
            &["run", argument(&pair), "-o", argument(&output)][..],
            words,
        ]
        .concat();
        let answer = gearmesh(&all);
        refused(&answer, 2, &["pair.toml"]);
        answer.stderr
    };
    assert_eq!(refusal(&["--accuracy", "1%"]), refusal(&[]));
}

/// The harmonics are those of the mesh cycle, however many pitches are run.
#[test]
fn run_prints_the_harmonics_of_the_mesh_cycle() {
    let (_, figures) = run_scene(&Desk::new(), "");
    for row in figures["rows"].as_array().unwrap() {
        let first = number(&row["stiffness_tangent_fourier"][0]["amplitude_N_per_m"]);
        assert!(
            first > 0.01 * number(&row["stiffness_tangent_mean_N_per_m"]),
            "{row}"
        );
    }
}

/// The two local terms describe the same teeth; they differ by what one of them gets wrong, some per cent. The
/// calibrated one is what a scene gets that does not name any.
#[test]
fn the_calibrated_local_term_is_the_default() {
    let desk = Desk::new();
    let named = workshop().scene("");
    let run = |name: &str, scene: String| {
        let file = desk.file(&format!("{name}.toml"), scene);
        let output = desk.path(&format!("{name}.h5"));
        let plan = succeeds(&["plan", argument(&file)]).stdout;
        let figures = succeeds(&["run", argument(&file), "-o", argument(&output), "--json"]).json();
        (plan, figures["rows"].as_array().unwrap().clone())
    };
    let weber = "model.local = \"weber-banaschek\"";
    let (_, old) = run("old", named.clone());
    let (plan, new) = run("new", changed(&named, weber, ""));
    assert!(plan.contains("local `calibrated`"), "{plan}");
    for (old, new) in old.iter().zip(&new) {
        let ratio = number(&new["te_mean_m"]) / number(&old["te_mean_m"]);
        println!("mean transmission error, calibrated over Weber-Banaschek: {ratio:.4}");
        assert!((ratio - 1.0).abs() < 0.08 && ratio != 1.0, "{ratio}");
        assert!(number(&new["torque_balance"]) < 1e-10, "{new}");
        assert!(number(&new["residual"]) < 1e-10, "{new}");
    }
}

/// Elements three millimetres wide cannot tell slices of three quarters of a millimetre apart; the calibrated term must
/// leave the contact problem solvable, and the transmission error that of wide slices.
#[test]
fn slices_narrower_than_elements_change_little() {
    let mean_te = |slices: usize| {
        let desk = Desk::new();
        for (name, text) in [("gear1", SOLID), ("gear2", THIN)] {
            let text = changed(text, "slices = 2", &format!("slices = {slices}"));
            let file = desk.file(&format!("{name}.toml"), text);
            let model = desk.path(&format!("{name}.h5"));
            let words = ["reduce", argument(&file), "-o", argument(&model)];
            succeeds(&[words.as_slice(), &["--no-error-estimate"]].concat());
        }
        let scene = changed(
            &workshop().scene(""),
            "model.local = \"weber-banaschek\"",
            "",
        );
        let scene = changed(&scene, argument(&workshop().solid), "gear1.h5");
        let scene = changed(&scene, argument(&workshop().thin), "gear2.h5");
        let (scene, result) = (desk.file("scene.toml", scene), desk.path("result.h5"));
        let answer = succeeds(&["run", argument(&scene), "-o", argument(&result), "--json"]);
        number(&answer.json()["rows"][1]["te_mean_m"])
    };
    let (wide, narrow) = (mean_te(4), mean_te(16));
    assert!((narrow / wide - 1.0).abs() < 0.01, "{wide} {narrow}");
}

/// With tip edges in contact the pair never deflects more than without them, deflects less at the change of pairs,
/// and everything that reads a result copes with the further lines.
#[test]
fn an_extended_path_runs_through_recovery_and_report() {
    let desk = Desk::new();
    let (on_path, _) = run_scene(&desk, "");
    let on_path = SceneResult::read(&on_path).unwrap();
    let desk = Desk::new();
    let (file, figures) = run_scene(
        &desk,
        "teeth.path = \"extended\"\nteeth.edge_radius_um = 50",
    );
    for row in figures["rows"].as_array().unwrap() {
        assert!(number(&row["torque_balance"]) < 1e-10, "{row}");
    }
    let extended = SceneResult::read(&file).unwrap();
    let lines = |r: &SceneResult| r.lines.pair_count.iter().sum::<u32>();
    assert!(lines(&extended) > lines(&on_path));
    assert!(
        extended
            .lines
            .pair_count
            .iter()
            .all(|n| *n as usize <= extended.lines.slots)
    );
    let largest_te = largest(&on_path.te_m);
    let mut gains = Vec::new();
    for (with, without) in extended.te_m.iter().zip(&on_path.te_m) {
        assert!(with - without > -1e-9 * largest_te, "{with} {without}");
        gains.push(with - without);
    }
    assert!(largest(&gains) > 0.02 * largest_te, "{gains:?}");

    let [tension, _] = recovered(&desk, &file);
    let strain = &extended.strain[0];
    assert!(largest_difference(&tension.method_2, &strain.method_2) == 0.0);
    let difference = largest_difference(&strain.method_2, &on_path.strain[0].method_2);
    let size = largest(&strain.method_2);
    assert!(
        difference > 0.0 && difference < 0.5 * size,
        "{difference} {size}"
    );
    let page = desk.path("report.html");
    succeeds(&["report", argument(&file), "-o", argument(&page)]);
    let scene = desk.path("scene.toml");
    let plan = succeeds(&["plan", argument(&scene)]).stdout;
    assert!(
        plan.contains("path `extended` with a tip edge radius of 50 um"),
        "{plan}"
    );
}

/// Both bodies repeat with their teeth, so nothing changes from one pitch to the next.
#[test]
fn the_transmission_error_repeats_with_the_pitch() {
    let desk = Desk::new();
    let (result, _) = run_scene(&desk, "");
    let result = SceneResult::read(&result).unwrap();
    for torque in 0..2 {
        let te = result.curve(&result.te_m, torque);
        for pitch in 1..3 {
            let later = &te[8 * pitch..8 * (pitch + 1)];
            assert!(
                largest_difference(&te[..8], later) < 1e-8 * largest(te),
                "{te:?}"
            );
        }
        assert!(
            te.iter()
                .any(|value| (value - te[0]).abs() > 0.01 * largest(te)),
            "it does not vary: {te:?}"
        );
    }
}

/// Ratings are printed, kept and drawn; what cannot be judged is reported and does not take the run with it.
#[test]
fn a_run_is_rated() {
    let desk = Desk::new();
    desk.file(
        "sn.toml",
        "cycles = [1e3, 1e6]\nstress_amplitude_MPa = [1e-6, 1e-7]\nbelow = \"last-slope\"\n",
    );
    let scene = hybrid_scene()
        + "[[rating]]\nkind = \"nominal\"\nmesh = \"mesh\"\n\
           [[rating]]\nkind = \"fatigue\"\ngauge = \"tension\"\nsn_table = \"sn.toml\"\n";
    let (file, output) = (desk.file("scene.toml", &scene), desk.path("result.h5"));
    let run = ["run", argument(&file), "-o", argument(&output)];
    let answer = succeeds(&run);
    for part in [
        "rating of mesh mesh: Lewis's root stress",
        "  hertz_pressure ",
        "rating of gauge tension of thin: cycles and damage",
        "  not rated: a stress amplitude of ",
    ] {
        assert!(
            answer.stdout.contains(part),
            "`{part}` is not in {answer:#?}"
        );
    }
    let warning = "gauge tension of thin is not rated: a stress amplitude of";
    assert!(answer.stderr.contains(warning), "{answer:#?}");
    let table = desk.file(
        "sn.toml",
        "cycles = [1e3, 1e6]\nstress_amplitude_MPa = [900, 300]\nbelow = \"endurance-limit\"\n",
    );
    assert!(table.exists());
    let json = succeeds(&[&run[..], &["--json"]].concat()).json();
    let figures = |rating: usize| &json["ratings"][rating]["figures"];
    let [force, pressure] =
        ["largest_force_N", "hertz_pressure_Pa"].map(|name| number(&figures(0)[name]));
    assert!(force > 100.0 && pressure > 1e8, "{json:#}");
    assert_eq!(number(&figures(1)["damage"]), 0.0);
    // An infinite life is no number of JSON.
    assert!(figures(1)["life_h"].is_null());
    let page = desk.path("report.html");
    succeeds(&["report", argument(&output), "-o", argument(&page)]);
    let page = std::fs::read_to_string(page).unwrap();
    for part in ["Lewis&#39;s nominal root stress of gear 1", "no damage"] {
        assert!(
            page.contains(part) || page.contains(&part.replace("&#39;", "'")),
            "`{part}` is not on the page"
        );
    }
}

/// A pair is rated at each torque: on paper, in JSON, in the plan and on the page; its gauge over one revolution.
#[test]
fn a_pair_is_rated() {
    let desk = Desk::new();
    desk.file(
        "sn.toml",
        "cycles = [1e3, 1e6]\nstress_amplitude_MPa = [900, 1]\nbelow = \"endurance-limit\"\n",
    );
    let scene = changed(&workshop().scene(""), "pitches = 3", "pitches = 18")
        + "\n[[rating]]\nkind = \"nominal\"\n[[rating]]\nkind = \"fatigue\"\ngauge = \"tension\"\nsn_table = \"sn.toml\"\n";
    let (file, output) = (desk.file("scene.toml", scene), desk.path("result.h5"));
    let plan = succeeds(&["plan", argument(&file)]).stdout;
    let part = "rating     gauge tension of gear 2, at each torque: cycles and damage";
    assert!(plan.contains(part), "{plan}");
    let run = ["run", argument(&file), "-o", argument(&output)];
    let text = succeeds(&run).stdout;
    for part in [
        "rating of the pair at 20 N m: Lewis's root stress",
        "rating of gauge tension of gear 2 at 60 N m: cycles and damage",
        "  life_revolutions ",
    ] {
        assert!(text.contains(part), "`{part}` is not in {text}");
    }
    let json = succeeds(&[&run[..], &["--json"]].concat()).json();
    let figure = |rating: usize, name: &str| number(&json["ratings"][rating]["figures"][name]);
    // Lewis's stress goes with the torque, Hertz's pressure with its root.
    let ratio = |name| figure(2, name) / figure(0, name);
    assert!((ratio("lewis_stress_gear1_Pa") - 3.0).abs() < 1e-9);
    assert!((ratio("hertz_pressure_Pa") - 3f64.sqrt()).abs() < 1e-9);
    assert!(figure(3, "damage") > figure(1, "damage") && figure(1, "damage") > 0.0);
    let page = desk.path("report.html");
    succeeds(&["report", argument(&output), "-o", argument(&page)]);
    let page = std::fs::read_to_string(page).unwrap();
    assert!(page.contains("<h2>Rating</h2>") && page.contains("the same in revolutions"));
}

/// One table of the stages: on the console first, in the JSON and on the page; figures by hand. Of the pair that `init`
/// writes the pinion drives clockwise at 600 rpm against 100 N m on the wheel.
#[test]
fn stages_are_on_console_page_and_in_json() {
    let desk = Desk::new();
    let folder = desk.path("pair");
    succeeds(&["init", "pair", "-o", argument(&folder)]);
    let (scene, output) = (folder.join("drive.toml"), desk.path("drive.h5"));
    let run = ["run", argument(&scene), "-o", argument(&output)];
    let console = succeeds(&run).stdout;
    // Below the figures of the meshes and bearings.
    let lines: Vec<&str> = console
        .lines()
        .skip_while(|line| !line.starts_with("stages, loads mean over the second half of the run"))
        .take(20)
        .collect();
    let shown = |label: &str| {
        let line = lines.iter().find(|line| line.starts_with(label));
        let line = line.unwrap_or_else(|| panic!("{label} is not in {lines:#?}"));
        line.split_whitespace().last().unwrap().to_owned()
    };
    assert_eq!(shown("speed of gear 1"), "-600.0");
    assert_eq!(shown("torque on gear 2"), "100.0");
    assert_eq!(shown("axial force"), "0");
    assert!(shown("c' of ISO 6336-1").parse::<f64>().unwrap() > 5.0);
    let figures = succeeds(&[&run[..], &["--json"]].concat()).json();
    let stage = &figures["stages"]["meshes"]["mesh"];
    // What is held by the motion is the torque by the numbers of teeth; F_t at the working pitch circle of 94.6 mm.
    let torque = 100.0 * 23.0 / 40.0;
    assert!((number(&stage["moment_1_Nm"]) / torque - 1.0).abs() < 1e-3);
    let force = torque / (94.6e-3 * 23.0 / 63.0);
    assert!((number(&stage["tangential_force_N"]) / force - 1.0).abs() < 1e-3);
    assert!((number(&stage["k_h_beta"]) - 1.0).abs() < 1e-9);
    assert!((number(&stage["speed_2_rpm"]) - 345.0).abs() < 1e-2);
    assert_eq!(figures["warnings"], serde_json::json!([]));
    let page = desk.path("drive.html");
    succeeds(&["report", argument(&output), "-o", argument(&page)]);
    let page = std::fs::read_to_string(page).unwrap();
    assert!(
        page.contains("Stages, loads mean over the second half") && page.contains("K<sub>Hβ</sub>")
    );
}
