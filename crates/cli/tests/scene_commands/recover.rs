//! `gearmesh recover`: both methods, the field of a position, results in other places.

use crate::common::{
    Desk, THIN, argument, changed, gearmesh, largest_difference, number, program, refused,
    run_scene, succeeds, workshop,
};
use crate::{largest, recovered};
use gearmesh_scene::{SceneResult, StrainSeries};

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
        "teeth.friction = { model = \"coulomb\", dynamic_coefficient = 0.1 }\n",
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

/// Errors and eccentricity decide forces and places of the contacts; strain is read again from the forces, at these
/// places.
#[test]
fn strain_of_a_pair_with_errors_is_read_again() {
    let desk = Desk::new();
    desk.file("lead.csv", "z_mm,removed_um\n-6,0\n6,4\n");
    let effects = "teeth.errors_1 = [{ kind = \"deviation\", lead = \"lead.csv\" }]\n\
                   teeth.errors_2 = [{ kind = \"spall\", tooth = 17, side = \"right\", radii_mm = [27.0, 28.0], z_mm = [-6, 6], depth_um = 6.0 }]\n\
                   teeth.eccentricity_2 = { offset_um = 30.0, direction_deg = 40.0 }\n";
    let (result, _) = run_scene(&desk, effects);
    let plan = succeeds(&["plan", argument(&desk.path("scene.toml"))]).stdout;
    for part in ["gear 1: deviation", "gear 2: spall, eccentricity"] {
        assert!(plan.contains(part), "`{part}` is not in {plan}");
    }
    let first = SceneResult::read(&result).unwrap();
    let again = recovered(&desk, &result);
    let tension = again.iter().find(|s| s.name == "tension").unwrap();
    assert_eq!(tension.method_2, first.strain[0].method_2);
    let (plain, _) = run_scene(&desk, "");
    let plain = SceneResult::read(&plain).unwrap();
    assert!(largest_difference(&plain.te_m, &first.te_m) > 1e-6);
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
    let in_folder = |folder: &Desk, arguments: &[&str]| {
        let output = program(arguments)
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
