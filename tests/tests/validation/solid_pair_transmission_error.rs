//! Validation: static transmission error of a solid pair (z 50/50, m 3 mm, b 20 mm) in plane strain against an
//! independent, resolved contact solution (reference/solid_*), at every position, on and beyond the path of contact.

use gearmesh_contact::Drive;
use gearmesh_contact::{ContactLines, ContactOptions, LocalContact, PathExtension, StaticContact};
use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{GearDefinition, GearPair, Misalignment};
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_reduction::{ReductionOptions, Silent, reduce};
use std::path::Path;

const GEAR: &str = "name = \"plane\"\n[tooth]\nteeth = 50\nmodule_mm = 3.0\nface_width_mm = 20.0\n\
    [blank]\nkind = \"solid\"\nbore_diameter_mm = 60.0\n[material]\nyoung_GPa = 206.0\npoisson = 0.3\n\
    [mesh]\nplane_strain = true\nflank_mm = 0.5\n[reduction]\nroll_stations = 17\nflanks = [\"right\"]\n";
const CENTRE_DISTANCE_M: f64 = 0.15002;
const TORQUES_NM: [f64; 2] = [170.0, 340.0];
const POINTS_PER_PITCH: usize = 40;
/// The reference has a sharp edge; a radius much smaller than the Hertz width stands for it.
const EDGE_RADIUS_M: f64 = 1e-5;

/// Driver angle \[rad\] and transmission error \[m\] at both torques, over one pitch.
fn reference(folder: &str) -> Vec<(f64, [f64; 2])> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../reference");
    let text = std::fs::read_to_string(root.join(folder).join("data.csv")).unwrap();
    text.lines()
        .skip(1)
        .take(POINTS_PER_PITCH)
        .map(|line| {
            let v: Vec<f64> = line.split(',').map(|v| v.parse().unwrap()).collect();
            (v[0].to_radians(), [v[1] * 1e-6, v[2] * 1e-6])
        })
        .collect()
}

#[test]
fn the_transmission_error_agrees_at_every_position() {
    let gear = GearDefinition::from_document(&InputDocument::new("plane.toml", GEAR)).unwrap();
    let options = ReductionOptions {
        estimate_error: false,
    };
    let python = PythonEnvironment::find().unwrap();
    let (model, _) = reduce(&gear, &python, options, &Silent).unwrap();
    let profile = || gear.profile.clone();
    for (folder, extended) in [("solid_line_of_action", false), ("solid_extended", true)] {
        let misalignment = Misalignment {
            inclination_rad: 0.0,
            deviation_rad: 0.0,
        };
        let pair = GearPair::new(profile(), profile(), CENTRE_DISTANCE_M, misalignment).unwrap();
        let lines = ContactLines {
            extension: extended.then(|| PathExtension::new(&pair, EDGE_RADIUS_M)),
            pair,
            zone: gearmesh_contact::ContactZone::of_equal_faces(gear.tooth.face_width_m),
            microgeometry_1: gear.microgeometry.right.clone(),
            microgeometry_2: gear.microgeometry.right.clone(),
        };
        let options = ContactOptions {
            local: LocalContact::Calibrated,
            friction: None,
        };
        let mut contact = StaticContact::new(lines, &model, &model, options).unwrap();
        let rows = reference(folder);
        assert_eq!(rows.len(), POINTS_PER_PITCH);
        for (k, torque) in TORQUES_NM.into_iter().enumerate() {
            let errors: Vec<f64> = rows
                .iter()
                .map(|(angle, te)| {
                    let state = contact.solve(*angle, Drive::Torque(torque)).unwrap();
                    state.transmission_error_m / te[k] - 1.0
                })
                .collect();
            let worst = errors.iter().fold(0.0_f64, |w, e| w.max(e.abs()));
            let mean = errors.iter().sum::<f64>() / errors.len() as f64;
            println!(
                "{folder}, {torque} N m: mean {:+.2} %, largest {:.2} %",
                100.0 * mean,
                100.0 * worst
            );
            assert!(worst < 0.01, "{folder} at {torque} N m: {errors:?}");
        }
    }
}
