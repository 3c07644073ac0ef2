//! Scenes in the forms of earlier versions: read as what they are now, with a note that says how they are written now.

use gearmesh_geometry::input::InputDocument;
use gearmesh_scene::Scene;
use gearmesh_scene::study::{StudyScenes, Subject};
use gearmesh_specification::study::Study;

use crate::common::*;

/// Without the lines of a table by kind: the shipped scene of two wheels as it was.
fn wheels(mesh: &str) -> String {
    let now = text("scene_two_wheels.toml");
    let (head, model) = now.split_once("\n[gear_mesh.model]\n").unwrap();
    format!("{head}{}\n{mesh}", model.replacen("kind =", "model =", 1))
}

#[track_caller]
fn notes(text: &str) -> Vec<String> {
    load(text, &fe_models()).unwrap().scene.notes
}

/// The lines that a note names and the text that it offers.
fn note(key: &str, lines: &[usize], present: &str) -> String {
    let shown: Vec<String> = lines.iter().map(usize::to_string).collect();
    let verb = if lines.len() == 1 { "line" } else { "lines" };
    let is = if lines.len() == 1 { "is" } else { "are" };
    format!(
        "scene.toml:{}: {key}: {verb} {} {is} in a form of earlier versions, which is still read; now it is written\n    {present}",
        lines[0],
        shown.join(", ")
    )
}

/// A complaint about a key in its former place has that place's line and the present key; the note has the text to
/// write.
#[test]
fn bearings_without_a_table_for_their_model_are_read() {
    let pendulum = text("scene_pendulum.toml");
    let first = pendulum.lines().count() + 1;
    let former = |stiffness: &str| {
        format!(
            "{pendulum}[[bearing]]\nname = \"b\"\nkind = \"linear\"\nbody_2 = \"rod\"\nradial_stiffness_N_per_mm = {stiffness}\n\
             axial_stiffness_N_per_mm = 2_000.0 # a remark\n"
        )
    };
    let present = "model = { kind = \"linear\", radial_stiffness_N_per_mm = 1e5, axial_stiffness_N_per_mm = 2_000.0 }";
    assert_eq!(
        notes(&former("1e5")),
        [note(
            "bearing.0.model",
            &[first + 2, first + 4, first + 5],
            present
        )]
    );
    for (stiffness, problem) in [
        ("1e14", "radial_stiffness_N_per_mm: found 1e14,"),
        (
            "true",
            "radial_stiffness_N_per_mm: found true, allowed is a number",
        ),
        ("inf", "radial_stiffness_N_per_mm: found inf"),
    ] {
        let complaint = build(&former(stiffness)).err().unwrap().to_string();
        let place = format!("scene.toml:{}: bearing.0.model.{problem}", first + 4);
        assert!(complaint.starts_with(&place), "{complaint}");
    }
}

/// What the note offers, put in place of the lines that it names, is the scene in its present form, without a note.
#[test]
fn gear_meshes_are_read_and_the_offered_text_means_the_same() {
    let further = "flanks = \"right\"\npath = \"line-of-action\"\n\
                   errors_1 = [{ kind = \"pitch\", side = \"right\",\n  removed_um = [1.0] }]\n\
                   [gear_mesh.friction]\nmodel = \"coulomb\"\ndynamic_coefficient = 0.1\n";
    let former = wheels(further);
    let found = notes(&former);
    let [model, teeth] = &found[..] else {
        panic!("{found:#?}");
    };
    let offered = |note: &str| note.split_once("written\n    ").unwrap().1.to_owned();
    assert_eq!(
        offered(model),
        "model = { kind = \"impact\", stiffness_N_per_mm_e = 1e6, exponent = 1.5, damping_N_s_per_mm = 1e2, full_damping_depth_um = 10.0 }"
    );
    assert_eq!(
        offered(teeth),
        "teeth = { flanks = \"right\", path = \"line-of-action\", errors_1 = [{ kind = \"pitch\", side = \"right\", removed_um = [1.0] }], \
         friction = { model = \"coulomb\", dynamic_coefficient = 0.1 } }"
    );
    let place = former.find("model = \"impact\"").unwrap();
    let present = format!(
        "{}{}\n{}\n",
        &former[..place],
        offered(model),
        offered(teeth)
    );
    assert_eq!(notes(&present), [""; 0]);
    let tables = |text: &str| format!("{:?}", load(text, &fe_models()).unwrap().scene.tables);
    assert_eq!(tables(&former), tables(&present));
    // The file as it is shipped has no notes either.
    assert_eq!(notes(&text("scene_two_wheels.toml")), [""; 0]);
}

/// Lines of complaints are those of the file, keys those of today, at every depth.
#[test]
fn complaints_about_former_files_point_to_their_lines() {
    for (from, to, at, complaint) in [
        (
            "exponent = 1.5",
            "exponent = 0.5",
            "exponent",
            "gear_mesh.0.model.exponent: found 0.5",
        ),
        (
            "exponent = 1.5",
            "exponent = '1'",
            "exponent",
            "gear_mesh.0.model.exponent: found the text \"1\"",
        ),
        (
            "\"impact\"",
            "\"impct\"",
            "\"impct\"",
            "gear_mesh.0.model.kind: unknown kind `impct`, expected one of `kinematic`",
        ),
        (
            "exponent = 1.5",
            "local = \"none\"",
            "local",
            "gear_mesh.0.model: `local` belongs to kind \"hybrid\", not to \"impact\"",
        ),
        (
            "exponent = 1.5",
            "exponent = 1.5\nfriction = { model = \"coulomb\", dynamic_coefficient = 9.0 }",
            "friction",
            "gear_mesh.0.teeth.friction.dynamic_coefficient: found 9",
        ),
        // Both forms of one key: the former one is no key any more.
        (
            "exponent = 1.5",
            "exponent = 1.5\nflanks = \"right\"\nteeth.flanks = \"left\"",
            "flanks = \"right\"",
            "gear_mesh.0: unknown field `flanks`",
        ),
    ] {
        let scene = changed(&wheels(""), from, to);
        let found = build(&scene).err().unwrap().to_string();
        let place = format!("scene.toml:{}: {complaint}", line_of(&scene, at));
        assert!(found.starts_with(&place), "{found}\n{place}");
    }
}

#[test]
fn shafts_are_read() {
    let two_stage = text("dynamics_two_stage.toml");
    let now = "model = { kind = \"beam\", young_GPa = 210.0, poisson = 0.3, damping_s = 1e-6 }";
    let former = two_stage.replacen(
        now,
        "kind = \"beam\"\nyoung_GPa = 210.0\npoisson = 0.3\ndamping_s = 1e-6",
        1,
    );
    let line = line_of(&former, "kind = \"beam\"");
    let lines = format!(
        "scene.toml:{line}: shaft.0.model: lines {line} to {} are",
        line + 3
    );
    let found = notes(&former);
    assert!(
        found.len() == 1 && found[0].starts_with(&lines) && found[0].ends_with(now),
        "{found:?}"
    );
    let rigid = former.replacen("kind = \"beam\"", "kind = \"rigid\"", 1);
    let refused = build(&rigid).err().unwrap().to_string();
    let place = format!(
        "scene.toml:{}: shaft.0.model: `damping_s` belongs to kind \"beam\"",
        line + 3
    );
    assert!(refused.starts_with(&place), "{refused}");
}

#[test]
fn pairs_are_read() {
    let head = "title = \"t\"\n[pair]\ngear_1 = \"a.h5\"\ngear_2 = \"b.h5\"\ncentre_distance_mm = 100.0\n\
                [run]\ntorques_Nm = [1.0]\npitches = 1\npoints_per_pitch = 4\n[mesh]\n";
    let read = |mesh: &str| {
        let document = InputDocument::new("scene.toml", format!("{head}{mesh}"));
        Scene::from_document(document, &fe_models())
    };
    let former = read(
        "model = \"hybrid\"\nlocal = \"weber-banaschek\"\npath = \"extended\"\nedge_radius_um = 50.0\n\
         errors_2 = [{ kind = \"broken-tooth\", tooth = 3, above_radius_mm = 47.0 }]\neccentricity_1 = { offset_um = 10.0 }\n\
         friction = { model = \"coulomb\", coefficient = 0.1, reversal_um = 30.0 }\n",
    );
    let former = former.unwrap();
    let (model, teeth) = (
        "model = { kind = \"hybrid\", local = \"weber-banaschek\" }",
        "teeth = { path = \"extended\", edge_radius_um = 50.0, errors_2 = [{ kind = \"broken-tooth\", tooth = 3, above_radius_mm = 47.0 }], \
         eccentricity_1 = { offset_um = 10.0 }, friction = { model = \"coulomb\", dynamic_coefficient = 0.1, reversal_um = 30.0 } }",
    );
    assert_eq!(
        former.notes,
        [
            note("mesh.model", &[11, 12], model),
            note("mesh.teeth", &[13, 14, 15, 16, 17], teeth)
                .replace("13, 14, 15, 16, 17", "13 to 17"),
        ]
    );
    let present = read(&format!("{model}\n{teeth}\n")).unwrap();
    assert!(present.notes.is_empty(), "{:?}", present.notes);
    let sense = |scene: Scene| {
        let Scene {
            contact,
            edge_radius_m,
            path_by_default,
            gears,
            ..
        } = scene;
        format!("{contact:?} {edge_radius_m:?} {path_by_default} {gears:?}")
    };
    assert_eq!(sense(former), sense(present));
    let wrong = read("model = \"hybrid\"\nfriction = { model = \"coulomb\", coefficient = 2.0 }\n");
    let complaint = wrong.unwrap_err().to_string();
    let begins =
        "scene.toml:12: mesh.teeth.friction.dynamic_coefficient: found 2, allowed is 0 to 1";
    assert_eq!(complaint, begins);
}

/// Keys of a study may have the form of its scene or of earlier versions.
#[test]
fn keys_of_studies_are_read() {
    let exponent = |scene: &str, key: &str, value: &str| {
        let study = format!(
            "title = \"s\"\nscene = \"s.toml\"\ncolumns = [\"c\"]\n[[parameter]]\nname = \"p\"\nkeys = [\"{key}\"]\nvalues = [{value}]\n"
        );
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("s.toml"), scene).unwrap();
        let study = Study::from_document(InputDocument::new("study.toml", study), folder.path());
        let made = StudyScenes::new(&study.unwrap(), folder.path()).map_err(|e| e.to_string())?;
        let Some(Subject::System(made)) = made.scenes.last() else {
            unreachable!("a multibody scene");
        };
        Ok::<_, String>(format!("{:?}", made.tables.gear_mesh[0].model))
    };
    let (former, present) = (wheels(""), text("scene_two_wheels.toml"));
    for scene in [&former, &present] {
        for key in ["gear_mesh.0.exponent", "gear_mesh.0.model.exponent"] {
            let made = exponent(scene, key, "1.25").unwrap();
            assert!(made.contains("exponent: Some(1.25)"), "{made}");
        }
    }
    for key in ["gear_mesh.0.model", "gear_mesh.0.model.kind"] {
        let refused = exponent(&present, key, "\"analytic\"").unwrap_err();
        assert!(
            refused.contains("\"impact\" and \"node-to-surface\", not to \"analytic\""),
            "{refused}"
        );
    }
}
