//! Columns of multibody results.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::Studio;
use crate::common::{Desk, argument, gearmesh, number, refused, succeeds};
use crate::hybrid_scene;

/// Columns of a multibody result: every peak is there, whatever is left out.
#[test]
fn columns_of_a_system_are_drawn_with_their_peaks() {
    let desk = Desk::new();
    let scene = desk.file("system.toml", hybrid_scene());
    let result = desk.path("system.h5");
    succeeds(&["run", argument(&scene), "-o", argument(&result)]);
    let studio = Studio::open(&result);
    let description = studio.get("/api/columns").json();
    let name = description["columns"][0]["name"]
        .as_str()
        .unwrap()
        .to_owned();
    assert_eq!(description["axis"]["name"], "time_s");
    let reply = studio.post("/api/columns", &json!({"columns": [name]}));
    assert_eq!(reply.status, 200, "{reply:?}");
    let file = gearmesh_scene::ResultFile::open(&result).unwrap();
    let gearmesh_scene::ResultFile::System(file) = file else {
        panic!("a system")
    };
    let all = file.rows.read(&name).unwrap();
    let drawn: Vec<f64> = reply.json()["curves"][0]
        .as_array()
        .unwrap()
        .iter()
        .map(number)
        .collect();
    let most = |values: &[f64]| values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    assert_eq!(most(&drawn), most(&all));
    let spectrum = studio.post(
        "/api/columns",
        &json!({"columns": [name], "shown": "spectrum"}),
    );
    assert_eq!(spectrum.status, 200, "{spectrum:?}");
    // Of an envelope the band is needed, and lies below half the rate of the rows.
    let envelope = |band: serde_json::Value| {
        let asked = json!({"columns": [name], "shown": "envelope", "band_Hz": band});
        studio.post("/api/columns", &asked).status
    };
    assert_eq!(envelope(json!([10_000.0, 20_000.0])), 200);
    assert_eq!(envelope(json!([10_000.0, 90_000.0])), 422);
    assert_eq!(envelope(json!(null)), 422);
    let unknown = studio.post("/api/columns", &json!({"columns": ["nothing"]}));
    assert_eq!(unknown.status, 422);
    // What belongs to pairs is not there.
    assert_eq!(studio.get("/api/pair").status, 404);
    assert_eq!(studio.post("/api/pair", &json!({})).status, 404);
}

/// A shipped scene with some words replaced, its files named by whole paths.
fn shipped(desk: &Desk, name: &str, changes: &[(&str, &str)]) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fe_models");
    let mut text = std::fs::read_to_string(folder.join(name)).unwrap();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    for key in ["gear", "file"] {
        let whole = format!("{key} = \"{}/", folder.canonicalize().unwrap().display());
        text = text.replace(&format!("{key} = \""), &whole);
    }
    desk.file(name, text)
}

fn floats(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(number).collect()
}

/// Shafts, bearings and gears of the shipped gearbox are drawn where the scene has them; its modes move them.
#[test]
fn a_gearbox_is_drawn_and_its_modes_move() {
    let desk = Desk::new();
    let at_rest = shipped(&desk, "gearbox_three_stage.toml", &[]);
    let result = desk.path("rest.h5");
    succeeds(&["run", argument(&at_rest), "-o", argument(&result)]);
    let studio = Studio::open(&result);
    studio.post("/api/columns/moments", &json!({"from": null, "to": null}));
    let moments = studio.finished();
    let shown = &moments["result"];
    let count = |kind: &str| {
        let parts = shown["parts"].as_array().unwrap().iter();
        parts.filter(|part| part["kind"] == kind).count()
    };
    // Four shafts; each section in halves, which its stations carry.
    let bodies = shown["bodies"].as_array().unwrap().iter();
    // Pinions are discs, wheels have hub, web and rim.
    let parts = bodies.map(|body| body["shape"]["rings"].as_array().unwrap().len());
    let mut parts: Vec<usize> = parts.collect();
    parts.sort_unstable();
    assert_eq!(parts, [1, 1, 1, 3, 3, 3]);
    assert!(
        count("shaft") >= 16 && count("shaft") % 2 == 0,
        "{}",
        count("shaft")
    );
    assert_eq!(count("ring"), 8);
    // The rings are those of the shafts: nothing of them hides in the shaft, and none hangs beside it.
    for part in shown["parts"].as_array().unwrap() {
        let radii = floats(&part["radii_mm"]);
        assert!(
            radii[0] < radii[1] && number(&part["length_mm"]) > 0.0,
            "{part}"
        );
    }

    let modal = shipped(
        &desk,
        "gearbox_three_stage.toml",
        &[("kind = \"static\"", "kind = \"eigen\"")],
    );
    let result = desk.path("modes.h5");
    succeeds(&["run", argument(&modal), "-o", argument(&result)]);
    let studio = Studio::open(&result);
    assert_eq!(studio.get("/api/session").json()["kind"], "modes");
    let machine = studio.get("/api/modes").json();
    let modes = machine["points"][0]["modes"].as_array().unwrap().clone();
    let file = gearmesh_scene::ResultFile::open(&result).unwrap();
    let gearmesh_scene::ResultFile::System(file) = file else {
        panic!("a system")
    };
    assert_eq!(modes.len(), file.eigen[0].modes.len());
    let reply = studio.post("/api/modes", &json!({"point": 0, "mode": modes.len() / 2}));
    assert_eq!(reply.status, 200, "{reply:?}");
    let frames = reply.json()["frames"].as_array().unwrap().clone();
    let origin = |frame: &Value, k: usize| floats(&frame["places"][k]["origin_mm"]);
    let half = frames.len() / 2;
    let own = &file.eigen[0].modes[modes.len() / 2].shape;
    let mut moved = Vec::new();
    for (k, gear) in machine["bodies"].as_array().unwrap().iter().enumerate() {
        let (first, last) = (origin(&frames[0], k), origin(&frames[half], k));
        // Half a period later it is as far on the other side: the real part of the shape, in one scale for all bodies.
        let body = file
            .bodies
            .iter()
            .position(|name| *name == gear["name"])
            .unwrap();
        for axis in 0..3 {
            let across = 0.5 * (first[axis] - last[axis]);
            moved.push((across, own[6 * body + axis][0]));
        }
    }
    let (most, of_it) = (moved.iter().copied())
        .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
        .unwrap();
    for (found, shape) in moved {
        // Places are rounded to a micrometre.
        assert!(
            (found - most / of_it * shape).abs() < 2e-3,
            "{found} {shape}"
        );
    }
    assert_eq!(
        studio
            .post("/api/modes", &json!({"point": 0, "mode": 100_000}))
            .status,
        422
    );
    assert_eq!(studio.get("/api/columns").status, 404);
}

/// Balls of a spindle are drawn where its columns say, with their cages, and two results stand beside each other.
#[test]
fn balls_are_drawn_and_two_results_stand_beside_each_other() {
    let desk = Desk::new();
    let short = [
        ("end_s = 0.1", "end_s = 0.001"),
        ("interval_s = 1e-4", "interval_s = 1e-5"),
    ];
    let scene = shipped(&desk, "spindle_6000_rpm.toml", &short);
    let mut results = ["first.h5", "second.h5"].map(|name| desk.path(name));
    for result in &results {
        succeeds(&["run", argument(&scene), "-o", argument(result)]);
    }
    let studio = Studio::open_beside(&results[0], &results[1]);
    studio.post("/api/columns/moments", &json!({"from": null, "to": null}));
    let moments = studio.finished();
    let shown = &moments["result"];
    let rows = shown["elements"].as_array().unwrap();
    assert_eq!(rows.len(), 2);
    let file = gearmesh_scene::ResultFile::open(&results[0]).unwrap();
    let gearmesh_scene::ResultFile::System(file) = file else {
        panic!("a system")
    };
    let last = &shown["frames"].as_array().unwrap().last().unwrap()["angles_rad"];
    let mut ball = 0;
    for (row, angles) in rows.iter().zip(last.as_array().unwrap()) {
        assert!(row["length_mm"].is_null());
        for angle in floats(angles) {
            ball += 1;
            let column = format!("elements/pair/ball_{ball}_angle_rad");
            assert_eq!(
                angle,
                *file.rows.read(&column).unwrap().last().unwrap(),
                "{column}"
            );
        }
    }
    // Their loads are those of the outer race.
    let loads = &shown["frames"][0]["element_loads_N"];
    let first = file.rows.read("elements/pair/ball_1_outer_N").unwrap()[0];
    assert_eq!(number(&loads[0][0]), first);
    let cages = shown["parts"].as_array().unwrap().iter();
    assert_eq!(cages.filter(|part| part["kind"] == "cage").count(), 2);

    let description = studio.get("/api/columns").json();
    let name = &description["columns"][0]["name"];
    let curves = |beside: bool| {
        let asked = json!({"columns": [name], "beside": beside});
        studio.post("/api/columns", &asked).json()["curves"].clone()
    };
    assert!(
        description["beside"]["columns"]
            .as_array()
            .unwrap()
            .contains(name)
    );
    assert_eq!(curves(true), curves(false));
    // A result at rest runs over something else.
    results[1] = desk.path("rest.h5");
    let gearbox = shipped(&desk, "gearbox_three_stage.toml", &[]);
    succeeds(&["run", argument(&gearbox), "-o", argument(&results[1])]);
    let [first, second] = &results;
    let words = [
        "studio",
        argument(first),
        "--beside",
        argument(second),
        "--no-open",
    ];
    refused(&gearmesh(&words), 2, &["--beside", "`point`"]);
}
