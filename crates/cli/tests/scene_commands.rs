//! The commands on scenes, with two small gears: what they print, what they write, and identities of the figures.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stdout,
    missing_docs
)]

mod common;

use common::{
    Desk, SOLID, THIN, argument, changed, gearmesh, largest_difference, number, refused, run_scene,
    succeeds, workshop,
};
use gearmesh_scene::{SceneResult, StrainSeries};
use std::path::Path;
use std::process::{Command, Stdio};

/// A multibody scene with the two reduced gears in a `hybrid` mesh, for a millisecond.
fn hybrid_scene() -> String {
    let gear = |name: &str, model: &Path, x_mm: f64| {
        format!(
            "[[body]]\nname = \"{name}\"\ngear = \"{}\"\nmass_kg = 0.2\ninertia_kg_m2 = [3e-5, 3e-5, 5e-5]\nposition_mm = [{x_mm}, 0, 0]\n\
             [[joint]]\nname = \"axle of {name}\"\nkind = \"revolute\"\nbody_2 = \"{name}\"\n",
            model.display()
        )
    };
    format!(
        "title = \"hybrid\"\n[run]\nkind = \"transient\"\nend_s = 1e-3\n[solver]\nstep_s = 1e-6\n[output]\ninterval_s = 1e-5\n{}{}\
         [[motion]]\njoint = \"axle of solid\"\nspeed_rpm = -60.0\n[[load]]\nbody = \"thin\"\ntorque_Nm = -10.0\n\
         [[gear_mesh]]\nname = \"mesh\"\ngear_1 = \"solid\"\ngear_2 = \"thin\"\nmodel = \"hybrid\"\nlocal = \"weber-banaschek\"\nflanks = \"right\"\n\
         [[gauge]]\nbody = \"thin\"\nnames = [\"tension\"]\n",
        gear("solid", &workshop().solid, 0.0),
        gear("thin", &workshop().thin, 54.7)
    )
}

/// Planned with its gauges; a flank that one model does not carry, a gauge that it does not have and a body that cannot be rigid are refused.
#[test]
fn plan_of_a_hybrid_mesh_in_a_multibody_scene() {
    let scene = hybrid_scene();
    let desk = Desk::new();
    let file = desk.file("scene.toml", &scene);
    let plan = succeeds(&["plan", argument(&file)]).stdout;
    for part in [
        "force      mesh: hybrid mesh, on solid and thin",
        "mesh       mesh: `hybrid`, solid z 18 with thin z 18",
        "mesh frequency at the start 18.000 Hz",
        "gauge      tension of thin",
        "effect     mesh `mesh`: friction: not computed",
        "the right flanks of mesh `mesh` touch",
        "1000 steps of ",
    ] {
        assert!(plan.contains(part), "`{part}` is not in {plan}");
    }
    let figures = succeeds(&["plan", argument(&file), "--json"]).json();
    assert_eq!(figures["degrees_of_freedom"], 12);
    for ((from, to), parts) in [
        (
            ("flanks = \"right\"\n", ""),
            &["left", "flanks = \"right\" or \"left\""][..],
        ),
        (
            ("\"tension\"", "\"tensoin\""),
            &["there is no gauge `tensoin`; did you mean `tension`?"],
        ),
        (
            (
                "name = \"thin\"\n",
                "name = \"thin\"\nflexibility = \"rigid\"\n",
            ),
            &["body.1.flexibility", "is a hybrid mesh"],
        ),
    ] {
        let file = desk.file("scene.toml", changed(&scene, from, to));
        refused(&gearmesh(&["plan", argument(&file)]), 2, parts);
    }
}

/// Ratings are printed, kept and drawn; what cannot be judged is told and does not take the run with it.
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
        "  hertz_pressure_Pa ",
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

/// What editors ask for.
#[test]
fn schemas_are_json() {
    for (kind, keys) in [
        ("scene", ["gear_mesh", "centre_distance_mm"]),
        ("gear", ["module_mm", "bore_diameter_mm"]),
    ] {
        let answer = succeeds(&["schema", kind]);
        assert!(
            answer.json()["$schema"]
                .as_str()
                .unwrap()
                .contains("json-schema.org")
        );
        assert!(
            keys.iter().all(|key| answer.stdout.contains(key)),
            "{answer:#?}"
        );
    }
}

/// Recovers the strain of all gauges: tension, compression.
fn recovered(desk: &Desk, result: &Path) -> [StrainSeries; 2] {
    let output = desk.path("strain.h5");
    succeeds(&["recover", argument(result), "-o", argument(&output)]);
    SceneResult::read(&output)
        .unwrap()
        .strain
        .try_into()
        .unwrap()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |worst, v| v.abs().max(worst))
}

#[test]
fn plan_counts_what_run_computes() {
    let desk = Desk::new();
    let scene = desk.file("scene.toml", workshop().scene(""));
    let plan = succeeds(&["plan", argument(&scene), "--json"]).json();
    // 3 pitches x 8 points; two pairs of two slices.
    assert_eq!(
        (&plan["positions"], &plan["unknowns"]),
        (&48.into(), &4.into())
    );
    let text = succeeds(&["plan", argument(&scene)]).stdout;
    for part in [
        "small pair",
        "2 torques x 24 positions",
        "friction   not computed",
        "gauges     1, methods 1 and 2, 96 readings",
    ] {
        assert!(text.contains(part), "`{part}` is not in {text}");
    }
    assert_eq!(desk.names(), ["scene.toml"]);
    let (result, _) = run_scene(&desk, "");
    let result = SceneResult::read(&result).unwrap();
    assert_eq!(result.angles() * result.torque_nm.len(), 48);
    assert_eq!(result.slots * result.slices, 4);
    assert_eq!(result.strain.len(), 1);
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
        let scene = changed(&workshop().scene(""), "local = \"weber-banaschek\"", "");
        let scene = changed(&scene, argument(&workshop().solid), "gear1.h5");
        let scene = changed(&scene, argument(&workshop().thin), "gear2.h5");
        let (scene, result) = (desk.file("scene.toml", scene), desk.path("result.h5"));
        let answer = succeeds(&["run", argument(&scene), "-o", argument(&result), "--json"]);
        number(&answer.json()["rows"][1]["te_mean_m"])
    };
    let (wide, narrow) = (mean_te(4), mean_te(16));
    assert!((narrow / wide - 1.0).abs() < 0.01, "{wide} {narrow}");
}

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
            number(&row["tangent_stiffness_mean_N_per_m"])
                > number(&row["secant_stiffness_mean_N_per_m"]),
            "{row}"
        );
    }
    assert!(number(&rows[1]["te_mean_m"]) < number(&rows[0]["te_mean_m"]));
    assert_eq!(figures["warnings"], serde_json::json!([]));
}

/// The harmonics are those of the mesh cycle, however many pitches are run.
/// The two local terms describe the same teeth; they differ by what one of them gets wrong, some per cent. The calibrated one is
/// what a scene gets that does not name any.
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
    let weber = "local = \"weber-banaschek\"";
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

#[test]
fn run_prints_the_harmonics_of_the_mesh_cycle() {
    let (_, figures) = run_scene(&Desk::new(), "");
    for row in figures["rows"].as_array().unwrap() {
        let first = number(&row["tangent_stiffness_fourier"][0]["amplitude_N_per_m"]);
        assert!(
            first > 0.01 * number(&row["tangent_stiffness_mean_N_per_m"]),
            "{row}"
        );
    }
}

/// With tip edges in contact the pair never gives way more than without them, gives way less at the change of pairs, and
/// everything that reads a result copes with the further lines.
#[test]
fn an_extended_path_runs_through_recovery_and_report() {
    let desk = Desk::new();
    let (on_path, _) = run_scene(&desk, "");
    let on_path = SceneResult::read(&on_path).unwrap();
    let desk = Desk::new();
    let (file, figures) = run_scene(&desk, "path = \"extended\"\nedge_radius_um = 50");
    for row in figures["rows"].as_array().unwrap() {
        assert!(number(&row["torque_balance"]) < 1e-10, "{row}");
    }
    let extended = SceneResult::read(&file).unwrap();
    let lines = |r: &SceneResult| r.pair_count.iter().sum::<u32>();
    assert!(lines(&extended) > lines(&on_path));
    assert!(
        extended
            .pair_count
            .iter()
            .all(|n| *n as usize <= extended.slots)
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

/// Recovers a scene whose driven gear has the element `element`.
fn recovered_with_element(element: &str) -> [StrainSeries; 2] {
    let desk = Desk::new();
    let gear = changed(THIN, "[mesh]", &format!("[mesh]\nelement = \"{element}\""));
    let (gear, model) = (desk.file("gear.toml", gear), desk.path("gear.h5"));
    succeeds(&[
        "reduce",
        argument(&gear),
        "-o",
        argument(&model),
        "--no-error-estimate",
    ]);
    let scene = changed(
        &workshop().scene(""),
        argument(&workshop().thin),
        argument(&model),
    );
    let (scene, result) = (desk.file("scene.toml", scene), desk.path("result.h5"));
    succeeds(&["run", argument(&scene), "-o", argument(&result)]);
    recovered(&desk, &result)
}

/// Without friction method 2 adds only gᵀW f, the strain of the tooth-only submodel. W is held at the opposite side of
/// the tooth: the strain along a face without motion is zero, and both methods agree exactly. The incompatible modes of
/// the other element turn with the skewness of the element and leave a trace (1.3e-4 here).
#[test]
fn both_methods_agree_on_the_unloaded_side_without_friction() {
    for (element, allowed) in [("hex8", 1e-12), ("hex8-incompatible", 1e-3)] {
        let [tension, compression] = recovered_with_element(element);
        assert_eq!((tension.gear, tension.name.as_str()), (2, "tension"));
        assert_eq!(
            (compression.gear, compression.name.as_str()),
            (2, "compression")
        );
        let difference = largest_difference(&compression.method_1, &compression.method_2);
        let size = largest(&compression.method_2);
        assert!(
            difference < allowed * size,
            "{element}: {difference} of {size}"
        );
        // In the loaded root W is free: it takes a part of the strain, a small one because the load is far away.
        let difference = largest_difference(&tension.method_1, &tension.method_2);
        let size = largest(&tension.method_2);
        assert!(
            difference > 1e-3 * size && difference < 0.2 * size,
            "{element}: {difference} of {size}"
        );
        let peak = |values: &[f64]| {
            values
                .iter()
                .copied()
                .max_by(|a, b| a.abs().total_cmp(&b.abs()))
                .unwrap()
        };
        assert!(peak(&tension.method_2) > 0.0 && peak(&compression.method_2) < 0.0);
    }
}

/// Method 1 has no tangential loads: friction reaches it through the normal forces alone, by the order of μ. Method 2
/// has them: its distance from method 1 changes by the order of μ.
#[test]
fn friction_reaches_method_2() {
    let desk = Desk::new();
    let (result, _) = run_scene(&desk, "");
    let without = recovered(&desk, &result);
    let (result, figures) = run_scene(
        &desk,
        "friction = { model = \"coulomb\", coefficient = 0.1 }\n",
    );
    let with = recovered(&desk, &result);
    for row in figures["rows"].as_array().unwrap() {
        assert!(number(&row["torque_balance"]) < 1e-10, "{row}");
    }
    let excess = |s: &StrainSeries| {
        s.method_2
            .iter()
            .zip(&s.method_1)
            .map(|(two, one)| two - one)
            .collect::<Vec<_>>()
    };
    for (with, without) in with.iter().zip(&without) {
        let size = largest(&without.method_1);
        let normal = largest_difference(&with.method_1, &without.method_1) / size;
        let tangential = largest_difference(&excess(with), &excess(without)) / size;
        assert!(normal > 0.0 && normal < 0.1, "{}: {normal}", with.name);
        assert!(
            tangential > 0.01 && tangential < 0.2,
            "{}: {tangential}",
            with.name
        );
    }
}

#[test]
fn recover_makes_the_field_of_a_position() {
    let desk = Desk::new();
    let (result, _) = run_scene(&desk, "");
    let (strain, field) = (desk.path("strain.h5"), desk.path("field.vtu"));
    let words = [
        "recover",
        argument(&result),
        "-o",
        argument(&strain),
        "--json",
        "--field-gear",
        "2",
    ];
    let position = [
        "--field-angle-deg",
        "20",
        "--field-torque-Nm",
        "60",
        "--field-output",
        argument(&field),
    ];
    let figures = succeeds(&[words.as_slice(), &position].concat()).json();
    assert_eq!(figures["rows"].as_array().unwrap().len(), 4);
    let file = String::from_utf8_lossy(&std::fs::read(&field).unwrap()).into_owned();
    let nodes = format!("NumberOfPoints=\"{}\"", workshop().figures[1]["nodes"]);
    for part in [nodes.as_str(), "displacement_m", "von_mises_Pa"] {
        assert!(file.contains(part), "`{part}` is not in the field");
    }
    assert_eq!(
        desk.names(),
        ["field.vtu", "result.h5", "scene.toml", "strain.h5"]
    );
}

/// Models are found from any folder, not only from that of the run.
#[test]
fn a_result_is_recovered_from_another_folder() {
    let (desk, elsewhere) = (Desk::new(), Desk::new());
    std::fs::copy(&workshop().thin, desk.path("thin.h5")).unwrap();
    let scene = changed(&workshop().scene(""), argument(&workshop().thin), "thin.h5");
    desk.file("scene.toml", scene);
    let program = env!("CARGO_BIN_EXE_gearmesh");
    let in_folder = |folder: &Desk, arguments: &[&str]| {
        let output = Command::new(program)
            .args(arguments)
            .current_dir(folder.path(""))
            .output()
            .unwrap();
        assert!(output.status.success(), "{output:?}");
    };
    in_folder(&desk, &["run", "scene.toml", "-o", "result.h5"]);
    let result = desk.path("result.h5");
    in_folder(
        &elsewhere,
        &["recover", argument(&result), "-o", "strain.h5"],
    );
    assert_eq!(elsewhere.names(), ["strain.h5"]);
}

/// `gearmesh plan ... | head -0`: who reads may stop reading.
#[test]
fn a_reader_that_stops_reading_is_no_error() {
    let desk = Desk::new();
    let scene = desk.file("scene.toml", workshop().scene(""));
    let mut child = Command::new(env!("CARGO_BIN_EXE_gearmesh"))
        .args(["plan", argument(&scene)])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "{output:?}");
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
}

#[test]
fn a_wrong_request_for_a_field_is_refused_before_anything_is_written() {
    let desk = Desk::new();
    let (result, _) = run_scene(&desk, "");
    let (strain, field) = (desk.path("strain.h5"), desk.path("field.vtu"));
    let words = ["recover", argument(&result), "-o", argument(&strain)];
    for (gear, torque, parts) in [
        ("3", "60", ["--field-gear", "found 3", "1 or 2"]),
        ("2", "61", ["--field-torque-Nm", "found 61", "[20.0, 60.0]"]),
    ] {
        let position = [
            "--field-gear",
            gear,
            "--field-angle-deg",
            "20",
            "--field-torque-Nm",
            torque,
            "--field-output",
            argument(&field),
        ];
        let answer = gearmesh(&[words.as_slice(), &position].concat());
        refused(&answer, 2, &parts);
        assert_eq!(desk.names(), ["result.h5", "scene.toml"]);
    }
}

#[test]
fn a_result_whose_model_was_made_again_from_another_gear_is_not_recovered() {
    let desk = Desk::new();
    let model = desk.path("thin.h5");
    std::fs::copy(&workshop().thin, &model).unwrap();
    let scene = changed(
        &workshop().scene(""),
        argument(&workshop().thin),
        argument(&model),
    );
    let scene = changed(&scene, "\"tension\"", "");
    let (scene, result) = (desk.file("scene.toml", scene), desk.path("result.h5"));
    succeeds(&["run", argument(&scene), "-o", argument(&result)]);
    std::fs::copy(&workshop().solid, &model).unwrap();
    let answer = gearmesh(&[
        "recover",
        argument(&result),
        "-o",
        argument(&desk.path("strain.h5")),
    ]);
    assert_eq!(
        (answer.code, answer.stdout.as_str()),
        (Some(2), ""),
        "{answer:#?}"
    );
    assert!(answer.stderr.contains(argument(&model)), "{answer:#?}");
}

/// The page works without a network: nothing in it asks for another file.
#[test]
fn report_loads_nothing() {
    let desk = Desk::new();
    let (result, _) = run_scene(&desk, "");
    let strain = desk.path("strain.h5");
    succeeds(&["recover", argument(&result), "-o", argument(&strain)]);
    let report = desk.path("report.html");
    let answer = succeeds(&["report", argument(&strain), "-o", argument(&report)]);
    assert_eq!(answer.stdout, "");
    let page = std::fs::read_to_string(&report).unwrap();
    assert!(page.starts_with("<!DOCTYPE html>") && page.trim_end().ends_with("</html>"));
    for part in [
        "small pair",
        "small solid",
        "small thin rim",
        "tension",
        "compression",
    ] {
        assert!(page.contains(part), "`{part}` is not in the report");
    }
    let tight: String = page
        .to_lowercase()
        .chars()
        .filter(|c| !c.is_whitespace() && *c != '"' && *c != '\'')
        .collect();
    for load in [
        "src=http",
        "href=http",
        "src=//",
        "href=//",
        "url(http",
        "url(//",
        "<link",
        "@import",
        "import(",
        "fetch(",
        "xmlhttprequest",
    ] {
        assert!(!tight.contains(load), "the report loads by `{load}`");
    }
}
