//! Work that takes its time: long calculations, gears that are reduced again.

use std::time::Duration;

use serde_json::{Value, json};

use super::{Studio, pair_scene, printed, timeless};
use crate::common::{Desk, SOLID, argument, changed, number, succeeds, workshop};

/// A long calculation is stopped, by a button or by a newer one.
#[test]
fn long_calculations_stop() {
    let desk = Desk::new();
    let studio = Studio::open(&pair_scene(&desk));
    let long = json!({"settings": {"run.pitches": 300, "run.points_per_pitch": 200}});
    let solved = || number(&studio.get("/api/progress").json()["solved"]);
    let wait_until = |is_so: &dyn Fn(f64) -> bool| {
        let begun = std::time::Instant::now();
        while begun.elapsed() < Duration::from_secs(20) && !is_so(solved()) {
            std::thread::sleep(Duration::from_millis(5));
        }
    };
    std::thread::scope(|scope| {
        let waiting = scope.spawn(|| studio.post("/api/pair", &long));
        wait_until(&|solved| solved >= 10.0);
        assert_eq!(studio.post("/api/stop", &json!({})).status, 200);
        let reply = waiting.join().unwrap();
        assert_eq!(
            (reply.status, &reply.json()["kind"]),
            (409, &json!("stopped"))
        );

        // What has been solved stays what it was until the next calculation has begun.
        let stopped_at = solved();
        let waiting = scope.spawn(|| studio.post("/api/pair", &long));
        wait_until(&|solved| solved != stopped_at);
        assert_eq!(studio.post("/api/pair", &json!({})).status, 200);
        let reply = waiting.join().unwrap();
        assert_eq!(
            (reply.status, &reply.json()["kind"]),
            (409, &json!("overtaken"))
        );
    });
}

/// A changed body is reduced beside the calculations, and gives the figures of the same gear file reduced by hand.
#[test]
fn a_changed_body_is_reduced_again() {
    let desk = Desk::new();
    let scene = pair_scene(&desk);
    let studio = Studio::open(&scene);
    let bore = "pair.gear_1:blank.bore_diameter_mm";
    let change = json!({"settings": {bore: 20, "gear_1.microgeometry.lead_crowning_um": 2}});
    let reply = studio.post("/api/pair", &change);
    assert_eq!(reply.status, 409, "{reply:?}");
    assert_eq!(reply.json()["kind"], "unreduced");
    // Its shape and its knobs are known before.
    let gears = studio.post("/api/pair/gears", &change).json();
    assert_eq!(gears["gears"][0]["rings"][0]["inner_mm"], json!(10.0));
    assert_eq!(studio.post("/api/pair/toml", &change).status, 409);

    assert_eq!(studio.post("/api/pair/reduce", &change).status, 200);
    // Meanwhile the pair as it is is computed.
    assert_eq!(studio.post("/api/pair", &json!({})).status, 200);
    let ended = studio.finished();
    assert_eq!(ended["problem"], Value::Null, "{ended}");
    let answer = studio.post("/api/pair", &change);
    assert_eq!(answer.status, 200, "{answer:?}");

    let gear = changed(SOLID, "bore_diameter_mm = 14.0", "bore_diameter_mm = 20.0");
    let gear = desk.file("wide_bore.toml", gear);
    let model = desk.path("wide_bore.h5");
    let no_estimate = "--no-error-estimate";
    succeeds(&[
        "reduce",
        argument(&gear),
        "-o",
        argument(&model),
        no_estimate,
    ]);
    let by_hand = workshop().scene("");
    let by_hand = changed(&by_hand, argument(&workshop().solid), argument(&model))
        + "[gear_1.microgeometry]\nlead_crowning_um = 2.0\n";
    let expected = printed(&desk, &by_hand);
    assert_eq!(timeless(answer.json()["figures"].clone()), expected);

    // What is saved has the changed gear beside it.
    let saved = studio.post("/api/pair/toml", &change);
    assert_eq!(saved.status, 200, "{saved:?}");
    drop(studio);
    assert_eq!(printed(&desk, &saved.body), expected);
}

/// A reduction is stopped; a body that cannot be is refused in the words of its file.
#[test]
fn bodies_are_stopped_and_refused() {
    let desk = Desk::new();
    let studio = Studio::open(&pair_scene(&desk));
    let change = json!({"settings": {"pair.gear_2:blank.web_thickness_mm": 3.5}});
    assert_eq!(studio.post("/api/pair/reduce", &change).status, 200);
    assert_eq!(studio.post("/api/job/stop", &json!({})).status, 200);
    assert_eq!(studio.finished()["problem"]["kind"], "stopped");
    for (key, value, part) in [
        ("pair.gear_1:blank.bore_diameter_mm", json!(60), "bore"),
        ("pair.gear_1:tooth.module_mm", json!(-1), "0.01 to 200"),
        ("pair.gear_1:mesh.flank_mm", json!(1), "no key"),
        ("pair.gear_1:tooth.teeth", json!(18.5), "whole number"),
        ("pair.gear_2:blank.holes.count", json!(3), "pitch_circle"),
    ] {
        let reply = studio.post("/api/pair", &json!({"settings": {key: value}}));
        assert_eq!(reply.status, 422, "{key}: {reply:?}");
        assert!(reply.body.contains(part), "{key}: {reply:?}");
    }
    let removed = json!({"removed": ["pair.gear_1:blank.bore_diameter_mm"]});
    assert_eq!(studio.post("/api/pair", &removed).status, 422);
}

/// The optimum is that of `gearmesh optimise`, and taken over it has the figures that the front says.
#[test]
fn an_optimisation_is_taken_over() {
    let desk = Desk::new();
    let studio = Studio::open(&pair_scene(&desk));
    let relief = "gear_1.microgeometry.tip_relief_um";
    let crowning = "gear_2.microgeometry.lead_crowning_um";
    let seek = json!({
        "change": {"settings": {"pair.deviation_mrad": 0.1}},
        "variables": [{"key": relief, "from": 0, "to": 30}, {"key": crowning, "from": 0, "to": 8}],
        "objectives": [
            {"column": "te_peak_to_peak_um", "torque_Nm": 60.0},
            {"column": "pressure_largest_MPa", "torque_Nm": null},
        ],
        "trials": 20,
    });
    assert_eq!(studio.post("/api/pair/optimise", &seek).status, 200);
    let ended = studio.finished();
    assert_eq!(ended["problem"], Value::Null, "{ended}");
    let found = &ended["result"];
    let front = found["figures"]["front"].as_array().unwrap();
    assert!(!front.is_empty());
    // What the relief needs beside it was set for all.
    let start = "gear_1.microgeometry.tip_relief_start_diameter_mm";
    assert!(number(&found["settings"][start]) > 54.0, "{found}");
    for point in front {
        let mut settings = found["settings"].as_object().unwrap().clone();
        settings.extend(point["variables"].as_object().unwrap().clone());
        let answer = studio
            .post("/api/pair", &json!({"settings": settings}))
            .json();
        let rows = answer["figures"]["rows"].as_array().unwrap();
        let te = 1e6 * number(&rows[1]["te_peak_to_peak_m"]);
        let told = number(&point["objectives"]["te_peak_to_peak_um at 60 Nm"]);
        assert!((te - told).abs() < 1e-9 * te, "{te} {told}");
        let pressures = rows
            .iter()
            .map(|row| 1e-6 * number(&row["pressure_largest_Pa"]));
        let mean = pressures.sum::<f64>() / rows.len() as f64;
        let told = number(&point["objectives"]["pressure_largest_MPa at mean"]);
        assert!((mean - told).abs() < 1e-9 * mean, "{mean} {told}");
    }
    for (key, value, part) in [
        ("trials", json!(9999), "5000"),
        ("variables", json!([]), "variable"),
        (
            "objectives",
            json!([{"column": "nothing", "torque_Nm": null}]),
            "nothing",
        ),
        (
            "variables",
            json!([{"key": "pair.gear_1:tooth.module_mm", "from": 2, "to": 3}]),
            "reduce a gear",
        ),
        (
            "variables",
            json!([{"key": relief, "from": 3, "to": 2}]),
            "from below to",
        ),
    ] {
        let mut wrong = seek.clone();
        wrong[key] = value;
        studio.post("/api/pair/optimise", &wrong);
        let ended = studio.finished();
        assert_eq!(ended["problem"]["kind"], "input", "{ended}");
        assert!(
            ended["problem"]["error"].as_str().unwrap().contains(part),
            "{ended}"
        );
    }
}
