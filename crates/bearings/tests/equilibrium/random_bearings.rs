//! Drawn bearings of all types, at rest, at speed and tilted, with 3 to 60 elements, against a model of their own in
//! numpy and scipy that shares no line with the project: the places of their rings are in `random_bearings.toml`.

use crate::common::bearing;
use gearmesh_bearings::{AppliedBearingLoad, Operation, TiltCondition};
use gearmesh_geometry::input::InputDocument;
use nalgebra::Vector5;
use serde::Deserialize;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Drawn {
    case: Vec<Case>,
}

/// A bearing's file, its load, and where its ring rests under it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Case {
    name: String,
    file: String,
    force_n: [f64; 3],
    tilt_rad: Option<[f64; 2]>,
    moment_nm: Option<[f64; 2]>,
    /// Of the inner ring; at rest without.
    #[serde(default)]
    rpm: f64,
    place_um: [f64; 3],
    tilt_mrad: [f64; 2],
}

/// The places of the file have nine decimals, and their search ended at 1e-9 of the load; stiffness is worth less than
/// tenfold between the parts of a place. 1e-7 of it is more than both.
#[test]
fn drawn_bearings_rest_where_another_model_finds_them() {
    let text = include_str!("random_bearings.toml");
    let drawn: Drawn = InputDocument::new("random_bearings.toml", text)
        .glance()
        .unwrap();
    assert!(drawn.case.len() >= 30, "{}", drawn.case.len());
    for case in drawn.case {
        let bearing = bearing(&case.file);
        let tilt = case.tilt_rad.map_or_else(
            || TiltCondition::Moments(case.moment_nm.unwrap()),
            TiltCondition::Held,
        );
        let load = AppliedBearingLoad {
            force_n: case.force_n,
            tilt,
        };
        let operation = Operation {
            inner_rad_per_s: case.rpm * std::f64::consts::PI / 30.0,
            ..Operation::default()
        };
        let found = bearing
            .equilibrium(&load, &operation)
            .unwrap_or_else(|e| panic!("{}: {e}", case.name));
        let arm = bearing.rows[0].pitch_radius_m();
        let [x, y, z] = case.place_um.map(|um| 1e-6 * um);
        let [about_x, about_y] = case.tilt_mrad.map(|mrad| 1e-3 * mrad);
        let expected = Vector5::new(x, y, z, about_x, about_y);
        let in_metres = Vector5::new(1.0, 1.0, 1.0, arm, arm);
        let size = expected.component_mul(&in_metres).norm();
        let away = (found.to_five() - expected)
            .component_mul(&in_metres)
            .norm();
        assert!(
            away < 1e-7 * size,
            "{}: {away:e} m of {size:e} m from its place",
            case.name
        );
    }
}
