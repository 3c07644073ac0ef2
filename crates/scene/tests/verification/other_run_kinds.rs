//! A scene of one kind of run that is turned into the other: the first complaint says all that is to be changed.

use gearmesh_geometry::input::InputDocument;
use gearmesh_scene::system::SystemScene;
use std::path::Path;

const REST: &str = "title = \"disc\"\n[[body]]\nname = \"disc\"\nmass_kg = 1.0\ninertia_kg_m2 = [1e-3, 1e-3, 2e-3]\n";

fn complaint(tables: &str) -> Option<String> {
    let (tables, rest) = (tables.trim_end(), REST);
    let text = format!("{}\n{tables}\n{}", &rest[..15], &rest[15..]);
    let document = InputDocument::new("scene.toml", text);
    SystemScene::from_document(document, Path::new(""))
        .err()
        .map(|e| e.to_string())
}

#[test]
fn a_static_scene_turned_transient_hears_all_at_once() {
    for (tables, remove, give) in [
        (
            "[run]\nkind = \"transient\"\nload_factors = [1.0]",
            "remove `run.load_factors`",
            "give `run.end_s`, `solver.step_s` or `solver.adaptive`, `output.interval_s`",
        ),
        (
            "[run]\nkind = \"transient\"\nend_s = 1.0\nmotion = \"m\"\nangles_deg = [1.0]\n[solver]\nstep_s = 1e-5",
            "remove `run.motion`, `run.angles_deg`",
            "give `output.interval_s`",
        ),
        (
            "[run]\nkind = \"transient\"",
            "",
            "give `run.end_s`, `solver.step_s` or",
        ),
    ] {
        let error = complaint(tables).unwrap();
        assert!(error.contains(remove) && error.contains(give), "{error}");
        assert!(
            error.contains("import --transient") && error.contains("[[motion]]"),
            "{error}"
        );
    }
    // Where one key of its own is missing, the complaint names that one alone.
    let error =
        complaint("[run]\nkind = \"transient\"\nend_s = 1.0\n[output]\ninterval_s = 0.1").unwrap();
    assert!(
        error.contains("solver.step_s") && !error.contains("static scene"),
        "{error}"
    );
}

#[test]
fn a_scene_in_time_turned_static_hears_all_at_once() {
    let tables = "[run]\nkind = \"static\"\nend_s = 1.0\n[solver]\nstep_s = 1e-5\n[output]\ninterval_s = 0.1";
    let left = [
        "end_s = 1.0\n",
        "[solver]\nstep_s = 1e-5\n",
        "[output]\ninterval_s = 0.1",
    ];
    // Each of them in turn is the first complaint; the others that are left are named with it.
    let all = ["`run.end_s`", "`solver.step_s`", "`output.interval_s`"];
    let mut tables = tables.to_owned();
    for (i, piece) in left.iter().enumerate() {
        let error = complaint(&tables).unwrap();
        let expected = format!("remove {};", all[i..].join(", "));
        assert!(error.contains(&expected), "{expected}: {error}");
        assert!(error.contains("something must hold the train"), "{error}");
        tables = tables.replace(piece, "");
    }
    assert_eq!(complaint(&tables), None);
}
