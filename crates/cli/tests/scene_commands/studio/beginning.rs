//! Something new without a file: pairs, bearings, bevel pairs, gearboxes.

use gearmesh_scene::SceneResult;
use serde_json::{Value, json};

use super::{Studio, printed, timeless};
use crate::common::{Desk, argument, number, root, succeeds};

/// The files of a kind as the page begins with them.
fn files(studio: &Studio, kind: &str) -> Value {
    let all = studio.get("/api/new").json();
    let kinds = all["kinds"].as_array().unwrap();
    let kind = kinds.iter().find(|one| one["name"] == kind).unwrap();
    let files = kind["files"].as_array().unwrap().iter();
    files
        .map(|file| {
            (
                file["name"].as_str().unwrap().to_owned(),
                file["text"].clone(),
            )
        })
        .collect::<serde_json::Map<_, _>>()
        .into()
}

#[test]
fn everything_begins_with_sound_files() {
    let desk = Desk::new();
    let studio = Studio::new_in(&desk.path(""));
    assert_eq!(studio.get("/api/session").json()["kind"], "new");
    assert_eq!(studio.get("/api/pair").status, 404);
    for kind in ["pair", "helical-pair", "bearing", "bevel-pair"] {
        let reply = studio.post(
            "/api/new",
            &json!({"kind": kind, "files": files(&studio, kind)}),
        );
        assert_eq!(reply.status, 200, "{kind}: {reply:?}");
        // Of a bearing from its designation the inside is an estimate, which is said.
        let warnings = reply.json()["warnings"].as_array().unwrap().len();
        assert_eq!(warnings > 0, kind == "bearing", "{kind}: {reply:?}");
    }
    // Nothing is written before something is asked for.
    assert_eq!(desk.names(), Vec::<String>::new());

    // A bearing's figures are those of its command.
    let bearing = files(&studio, "bearing");
    let found = studio
        .post("/api/new", &json!({"kind": "bearing", "files": bearing}))
        .json();
    let columns = found["columns"]["columns"].as_array().unwrap();
    let column = |name: &str| {
        let found = columns.iter().find(|one| one["name"] == name);
        number(&found.unwrap_or_else(|| panic!("no {name} in {columns:?}"))["values"][0])
    };
    let file = desk.file("bearing.toml", bearing["bearing.toml"].as_str().unwrap());
    let load = ["--load-N", "0,1500,300", "--speed-rpm", "1500", "--json"];
    let by_hand = succeeds(&[&["bearing", argument(&file)], &load[..]].concat()).json();
    let l10r = number(&by_hand["life"]["L10r_Mrev"]);
    assert!((column("life_L10r_Mrev") - l10r).abs() < 1e-9 * l10r);
}

#[test]
fn fields_and_text_are_one() {
    let desk = Desk::new();
    let studio = Studio::new_in(&desk.path(""));
    let texts = files(&studio, "pair");
    let edit = |text: &str, settings: Value| {
        studio.post(
            "/api/new/edit",
            &json!({"kind": "pair", "name": "pinion.toml", "text": text, "settings": settings}),
        )
    };
    let text = texts["pinion.toml"].as_str().unwrap();
    let changed = edit(text, json!({"tooth.module_mm": 2.5})).json();
    // One number differs, comments and all else stay.
    assert_eq!(
        changed["text"],
        json!(text.replacen("module_mm = 3.0", "module_mm = 2.5", 1))
    );
    // What is typed is read.
    let typed = edit(&text.replace("teeth = 23", "teeth = 24"), json!({})).json();
    let fields = typed["fields"].as_array().unwrap();
    let teeth = fields
        .iter()
        .find(|field| field["key"] == "tooth.teeth")
        .unwrap();
    assert_eq!(teeth["stated"], json!(24));

    // Gears that do not run together are said before they are reduced, and so is what is no TOML.
    let wrong = |name: &str, text: Value| {
        let mut files = texts.clone();
        files[name] = text;
        let reply = studio.post("/api/new", &json!({"kind": "pair", "files": files}));
        assert_eq!(reply.status, 422, "{reply:?}");
        reply.json()["error"].as_str().unwrap().to_owned()
    };
    let problem = wrong("pinion.toml", changed["text"].clone());
    assert!(
        problem.contains("pair.toml") && problem.contains("module"),
        "{problem}"
    );
    let problem = wrong("wheel.toml", json!("teeth = "));
    assert!(problem.starts_with("wheel.toml:1"), "{problem}");
    assert!(wrong("../wheel.toml", json!("")).contains("allowed are the files"));
    for (key, value) in [
        ("tooth.nothing", json!(1)),
        ("tooth.module_mm", json!("wide")),
        ("mesh.flank_mm", json!(1)),
    ] {
        assert_eq!(edit(text, json!({key: value})).status, 422, "{key}");
    }
    assert_eq!(desk.names(), Vec::<String>::new());
}

#[test]
fn a_new_pair_is_reduced_and_opened() {
    let desk = Desk::new();
    let studio = Studio::new_in(&desk.path(""));
    let mut texts = files(&studio, "pair");
    let coarse = "\n[mesh]\nflank_mm = 1.5\nfillet_mm = 0.8\nbody_mm = 5.0\naxial_mm = 5.0\n[reduction]\nroll_stations = 4\nslices = 2\n";
    for name in ["pinion.toml", "wheel.toml"] {
        let text = texts[name].as_str().unwrap().to_owned();
        texts[name] = json!(text + coarse);
    }
    let new = json!({"kind": "pair", "files": texts});
    assert_eq!(studio.post("/api/new/begin", &new).status, 200);
    let ended = studio.finished();
    assert_eq!(ended["problem"], Value::Null, "{ended}");
    assert_eq!(studio.get("/api/session").json()["kind"], "pair");
    let answer = studio.post("/api/pair", &json!({}));
    assert_eq!(answer.status, 200, "{answer:?}");
    let scene = std::fs::read_to_string(desk.path("pair/pair.toml")).unwrap();
    let whole = ["pinion", "wheel"].iter().fold(scene, |text, name| {
        let model = desk.path("pair").join(format!("{name}.h5"));
        text.replace(&format!("\"{name}.h5\""), &format!("{model:?}"))
    });
    assert_eq!(
        timeless(answer.json()["figures"].clone()),
        printed(&desk, &whole)
    );
    // Back to the beginning: the files stay.
    assert_eq!(studio.post("/api/new/start", &json!({})).status, 200);
    assert_eq!(studio.get("/api/session").json()["kind"], "new");
    assert!(desk.path("pair/pinion.h5").exists());
}

#[test]
fn a_bevel_pair_and_a_gearbox_are_computed() {
    let desk = Desk::new();
    let studio = Studio::new_in(&desk.path(""));
    let mut texts = files(&studio, "bevel-pair");
    let text = texts["bevel_pair.toml"].as_str().unwrap();
    texts["bevel_pair.toml"] = json!(
        text.replace("positions_per_pitch = 16", "positions_per_pitch = 6")
            .replace("slices = 31", "slices = 11")
    );
    studio.post(
        "/api/new/begin",
        &json!({"kind": "bevel-pair", "files": texts}),
    );
    let ended = studio.finished();
    assert_eq!(ended["problem"], Value::Null, "{ended}");
    let file = desk.path("bevel-pair/bevel_pair.toml");
    let by_hand = succeeds(&["tca", argument(&file), "--json"]).json();
    assert_eq!(ended["result"]["tca"], by_hand);
    // Curves under load are those of the result beside the pages.
    let run = SceneResult::read(&desk.path("bevel-pair/bevel_pair.h5")).unwrap();
    let load = &ended["result"]["load"];
    assert_eq!(load["torques_Nm"], json!(run.torque_nm));
    assert_eq!(load["angle_deg"].as_array().unwrap().len(), 6);
    for (name, values) in [("te_um", &run.te_m), ("unloaded_um", &run.unloaded_m)] {
        let drawn: Vec<f64> = values.iter().map(|value| 1e6 * value).collect();
        assert_eq!(load[name], json!(drawn), "{name}");
    }
    let gears = load["in_space"]["gears"].as_array().unwrap().iter();
    let teeth: Vec<u64> = gears.map(|gear| gear["teeth"].as_u64().unwrap()).collect();
    assert_eq!(teeth, run.bevel.unwrap().teeth.map(|teeth| teeth as u64));
    let rows = load["pressure_largest_MPa"].as_array().unwrap();
    let largest = |all: &[f64]| all.iter().copied().fold(0.0, f64::max);
    let drawn: Vec<f64> = rows.iter().map(|value| value.as_f64().unwrap()).collect();
    assert_eq!(drawn.len(), 6 * run.torque_nm.len());
    assert!((largest(&drawn) / (1e-6 * largest(&run.lines.pressure_pa)) - 1.0).abs() < 1e-12);
    for page in ["bevel_pair.html", "bevel_pair_loaded.html"] {
        assert!(desk.path("bevel-pair").join(page).exists(), "{page}");
    }

    let bytes = std::fs::read_to_string(root().join("fe_models/gearbox_three_stage.rexs")).unwrap();
    let reply = studio.send(&studio.lines("POST /api/new/import/box.rexs"), &bytes);
    assert_eq!(reply.status, 200, "{reply:?}");
    let ended = studio.finished();
    assert_eq!(ended["problem"], Value::Null, "{ended}");
    let found = &ended["result"]["import"];
    assert_eq!(found["at_rest"]["refused"], json!([]));
    let scene = found["scenes"][0].as_str().unwrap();
    assert!(desk.path("gearbox").join(scene).exists());
    // Names of files lead nowhere else.
    let reply = studio.send(
        &studio.lines("POST /api/new/import/..%2F..%2Fbox.rexs"),
        "no gearbox",
    );
    assert_eq!(reply.status, 200);
    assert_eq!(studio.finished()["problem"]["kind"], "input");
}
