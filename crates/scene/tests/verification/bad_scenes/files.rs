//! Tables that are none, and files that are no scene.

use gearmesh_geometry::input::InputDocument;
use gearmesh_scene::SceneFile;

use crate::common::*;

#[test]
fn tables_that_do_not_increase_are_refused_in_their_file() {
    let folder = tempfile::tempdir().unwrap();
    let scene = changed(
        &text("scene_pendulum.toml"),
        "[[joint]]",
        "[[load]]\nbody = \"rod\"\ntorque_Nm = { table = { file = \"rig.csv\", column = \"torque_Nm\" } }\n[[joint]]",
    );
    for (table, expected) in [
        (
            "time_s,torque_Nm\n0,1\n# pause\n0.2,3\n0.2,4\n",
            "rig.csv:5: time_s: found 0.2 after 0.2; it must increase from row to row",
        ),
        (
            "time_s,torque_Nm\n0,1\n0.2,x\n",
            "rig.csv:3: torque_Nm: found 'x', allowed is a number such as",
        ),
        (
            "time_s,torque_Nm\n0,1\n0.2,inf\n",
            "rig.csv:3: torque_Nm: found inf, allowed is a finite number from -1e12 to 1e12 Nm",
        ),
        (
            "time_s,torque_Nm\n0,1\n0.2,3,4\n",
            "rig.csv:3: 3 fields; the head has 2",
        ),
        (
            "time_s,force_N\n0,1\n0.2,3\n",
            "rig.csv:1: torque_Nm: there is no such column; the file has time_s, force_N",
        ),
        (
            "time_s,torque_Nm\n0,1\n",
            "rig.csv:1: 1 rows of numbers; at least 2 are needed",
        ),
        ("", "rig.csv: is empty"),
    ] {
        std::fs::write(folder.path().join("rig.csv"), table).unwrap();
        let complaint = build_in(&scene, folder.path()).err().unwrap().to_string();
        assert!(
            complaint.contains(expected),
            "`{expected}` is not in\n{complaint}"
        );
    }
    std::fs::remove_file(folder.path().join("rig.csv")).unwrap();
    let complaint = build_in(&scene, folder.path()).err().unwrap().to_string();
    assert!(
        complaint.contains("rig.csv: cannot read the file"),
        "{complaint}"
    );
}

#[test]
fn files_that_are_no_scene_are_told_apart() {
    let kind = |text: &str| {
        SceneFile::from_document(InputDocument::new("f.toml", text), &fe_models())
            .unwrap_err()
            .to_string()
    };
    assert!(
        kind(&text("gear1.toml")).contains("this is a gear file; a scene has [pair] or [[body]]")
    );
    assert!(kind("title = \"x\"\n").contains("f.toml: no scene: it has neither [pair]"));
    assert!(
        kind("title = \"x\"\n[pair]\n[[body]]\n").contains("f.toml:3: body: a scene has [pair]")
    );
    assert!(
        kind("title = \"x\"\nbody = []\n[run]\nkind = \"static\"\n")
            .contains("f.toml:2: body: is empty")
    );
    let pair = text("pair_a.toml");
    let document = InputDocument::new("p.toml", pair);
    assert!(matches!(
        SceneFile::from_document(document, &fe_models()).unwrap(),
        SceneFile::Pair(_)
    ));
}

/// A model of the mesh that knows no cracks does not pass over one in silence.
#[test]
fn a_crack_that_no_model_feels_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let scene = (text("scene_two_wheels.toml").replacen("gear1.toml", "pinion.toml", 1)).replacen(
        "gear1.toml",
        "wheel.toml",
        1,
    );
    let crack = "\n[crack]\ntooth = 0\nside = \"right\"\ndepth_mm = 1.0\n";
    for (cracked, key) in [("pinion.toml", "gear_1"), ("wheel.toml", "gear_2")] {
        for name in ["pinion.toml", "wheel.toml"] {
            let more = if name == cracked { crack } else { "" };
            let file = folder.path().join(name);
            std::fs::write(file, format!("{}{more}", text("gear1.toml"))).unwrap();
        }
        let complaint = build_in(&scene, folder.path()).err().unwrap().to_string();
        for part in [key, cracked, "[crack]", "\"hybrid\"", "cracks_1"] {
            assert!(complaint.contains(part), "`{part}` is not in\n{complaint}");
        }
    }
}
