//! Figures and curves of the page are those of `gearmesh run`, of changed scenes and of changed bodies.

use serde_json::json;

use super::{Studio, pair_scene, printed, timeless};
use crate::common::{Desk, changed, number, run_scene, succeeds, workshop};

#[test]
fn changed_pairs_have_the_figures_of_run() {
    let desk = Desk::new();
    let studio = Studio::open(&pair_scene(&desk));
    let as_it_is = studio.post("/api/pair", &json!({}));
    assert_eq!(as_it_is.status, 200, "{as_it_is:?}");
    let as_it_is = as_it_is.json();
    assert_eq!(
        timeless(as_it_is["figures"].clone()),
        printed(&desk, &workshop().scene(""))
    );

    // The same change by hand, key by key.
    let change = json!({
        "settings": {
            "pair.centre_distance_mm": 54.72,
            "pair.deviation_mrad": 0.037,
            "gear_1.microgeometry.tip_relief_um": 7.3,
            "gear_1.microgeometry.tip_relief_start_diameter_mm": 57.0,
            "gear_1.microgeometry.tip_relief_shape": "parabolic",
            "gear_2.microgeometry.lead_crowning_um": 4,
            "mesh.teeth.friction.dynamic_coefficient": 0.06,
            "run.torques_Nm": [20, 45.5, 60],
            "run.points_per_pitch": 9,
        },
        "removed": ["gauges.gear_2"],
    });
    let by_hand = workshop().scene("");
    let mut by_hand = changed(
        &by_hand,
        "centre_distance_mm = 54.7\n",
        "centre_distance_mm = 54.72\ndeviation_mrad = 0.037\n",
    );
    for (from, to) in [
        ("[20.0, 60.0]", "[20.0, 45.5, 60.0]"),
        ("points_per_pitch = 8", "points_per_pitch = 9"),
        ("[gauges]\ngear_2 = [\"tension\"]\n", ""),
    ] {
        by_hand = changed(&by_hand, from, to);
    }
    by_hand += "teeth.friction = { model = \"coulomb\", dynamic_coefficient = 0.06 }\n\
        [gear_1.microgeometry]\ntip_relief_um = 7.3\ntip_relief_start_diameter_mm = 57.0\ntip_relief_shape = \"parabolic\"\n\
        [gear_2.microgeometry]\nlead_crowning_um = 4.0\n";
    let answer = studio.post("/api/pair", &change);
    assert_eq!(answer.status, 200, "{answer:?}");
    let answer = answer.json();
    let expected = printed(&desk, &by_hand);
    assert_eq!(timeless(answer["figures"].clone()), expected);
    assert_ne!(
        expected["rows"][0]["te_mean_m"],
        as_it_is["figures"]["rows"][0]["te_mean_m"]
    );

    // What is saved gives the same figures from any folder.
    let saved = studio.post("/api/pair/toml", &change);
    assert_eq!(saved.status, 200, "{saved:?}");
    let elsewhere = Desk::new();
    assert_eq!(printed(&elsewhere, &saved.body), expected);

    // A change more and back: the numbers of the beginning.
    assert_eq!(
        timeless(studio.post("/api/pair", &json!({})).json()["figures"].clone()),
        timeless(as_it_is["figures"].clone())
    );
}

/// The result of a run is opened with its scene and its models.
#[test]
fn curves_are_those_of_the_result_file() {
    let desk = Desk::new();
    let (file, _) = run_scene(&desk, "");
    let result = gearmesh_scene::SceneResult::read(&file).unwrap();
    let studio = Studio::open(&file);
    let answer = studio.post("/api/pair", &json!({})).json();
    let curve =
        |key: &str| -> Vec<f64> { answer[key].as_array().unwrap().iter().map(number).collect() };
    let scaled =
        |values: &[f64], factor: f64| -> Vec<f64> { values.iter().map(|x| factor * x).collect() };
    assert_eq!(curve("te_um"), scaled(&result.te_m, 1e6));
    assert_eq!(
        curve("pressure_MPa"),
        scaled(&result.lines.pressure_pa, 1e-6)
    );
    assert_eq!(curve("force_N"), result.lines.force_n);
    let strain: Vec<f64> = answer["strain"][0]["method_2_ustrain"]
        .as_array()
        .unwrap()
        .iter()
        .map(number)
        .collect();
    assert_eq!(strain, scaled(&result.strain[0].method_2, 1e6));
    // Slices touch on the flank of gear 1: their places have its diameters.
    let (diameters, points) = (curve("diameter_mm"), curve("point_mm"));
    let mut touching = 0;
    for (diameter, point) in diameters
        .iter()
        .zip(points.chunks(2))
        .filter(|(d, _)| **d > 0.0)
    {
        assert!((2.0 * point[0].hypot(point[1]) - diameter).abs() < 1e-9 * diameter);
        assert!((47.0..61.0).contains(diameter), "{diameter}");
        touching += 1;
    }
    assert!(touching >= result.angles());
    // At every position the forces make the torque: sum of normal forces times the base radius of gear 2.
    let base_2_m = 1e-3 * 0.5 * 3.0 * 18.0 * 20f64.to_radians().cos();
    let block = result.lines.slots * result.lines.slices;
    for (k, forces) in curve("force_N").chunks(block).enumerate() {
        let torque = result.torque_nm[k / result.angles()];
        assert!((forces.iter().sum::<f64>() * base_2_m / torque - 1.0).abs() < 1e-9);
    }
}

#[test]
fn keys_are_those_of_the_schema_and_pitch_errors_are_felt() {
    let desk = Desk::new();
    let studio = Studio::open(&pair_scene(&desk));
    let description = studio.get("/api/pair").json();
    let fields = description["fields"].as_array().unwrap();
    let field = |key: &str| {
        fields
            .iter()
            .find(|field| field["key"] == key)
            .unwrap_or_else(|| panic!("{key}"))
    };
    let schema = succeeds(&["schema", "scene"]).json();
    let words =
        &schema["$defs"]["MicrogeometryTable"]["properties"]["tip_relief_um"]["description"];
    let relief = field("gear_1.microgeometry.tip_relief_um");
    assert_eq!(&relief["help"], words);
    assert_eq!(
        (&relief["unit"], &relief["label"]),
        (&json!("µm"), &json!("tip relief"))
    );
    assert!(relief["with"]["gear_1.microgeometry.tip_relief_start_diameter_mm"].is_number());
    assert_eq!(field("pair.centre_distance_mm")["stated"], json!(54.7));
    assert_eq!(
        field("gauges.gear_2")["kind"]["names"],
        json!(["tension", "compression"])
    );
    assert!(fields.len() > 40, "{}", fields.len());
    // Nothing that names a file.
    for part in ["pair.gear_1", "misalignment_from", "topography", "profile"] {
        let named = fields
            .iter()
            .filter(|field| field["key"].as_str().unwrap().ends_with(part));
        assert_eq!(named.count(), 0, "{part}");
    }
    assert_eq!(description["gears"][0]["teeth"], json!(18));

    let mut removed = vec![0.0; 18];
    removed[3] = 12.5;
    let key = "mesh.teeth.errors_1";
    let answer = studio.post(
        "/api/pair",
        &json!({"settings": {key: removed, "run.pitches": 18}}),
    );
    assert_eq!(answer.status, 200, "{answer:?}");
    let numbers: Vec<String> = removed.iter().map(|x| format!("{x:?}")).collect();
    let by_hand = changed(&workshop().scene(""), "pitches = 3", "pitches = 18")
        + &format!(
            "teeth.errors_1 = [{{ kind = \"pitch\", side = \"right\", removed_um = [{}] }}]\n",
            numbers.join(", ")
        );
    assert_eq!(
        timeless(answer.json()["figures"].clone()),
        printed(&desk, &by_hand)
    );
    let few = studio.post("/api/pair", &json!({"settings": {key: [1.0, 2.0]}}));
    assert_eq!(few.status, 422);
    assert!(few.body.contains("18 numbers"), "{few:?}");
}
