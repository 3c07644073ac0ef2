//! A pinion cut into its shaft, taken with its frame on its back face: compliance and natural frequencies against one
//! finite element model that is held at the back face, its front face rigid and free. Both are the same body, reached
//! by another way.
#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

use gearmesh_drivetrain::GearOnFaces;
use gearmesh_fe::{
    DofMap, Factor, ModeSettings, RigidGroup, WantedModes, assemble_mass, assemble_stiffness,
    natural_modes,
};
use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{Flank, GearDefinition};
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_reduction::flank_loads::{flank_grid, flank_loads};
use gearmesh_reduction::gauge_row::gauge_row;
use gearmesh_reduction::{ReductionOptions, Silent, reduce};
use std::f64::consts::TAU;

#[path = "../support/whole_compliance.rs"]
mod whole_compliance;

const PINION: &str = r#"
name = "pinion"
[tooth]
teeth = 17
module_mm = 3.0
profile_shift = 0.2
face_width_mm = 30.0
[material]
young_GPa = 210.0
poisson = 0.3
density_kg_per_m3 = 7850.0
[mesh]
flank_mm = 2.4
fillet_mm = 1.2
body_mm = 6.0
axial_mm = 6.0
[reduction]
roll_stations = 3
slices = 2
flanks = ["right"]
[blank]
kind = "solid"
bore_diameter_mm = 0
shaft_diameter_mm = [32, 30]
[[gauge]]
name = "root"
tooth = 0
side = "right"
tangent_deg = 30.0
length_mm = 2.0
width_mm = 10.0
[modes]
count = 24
"#;

#[test]
fn its_modes_and_its_compliance_are_those_of_the_body_held_at_the_back() {
    let document = InputDocument::new("pinion.toml", PINION.to_owned());
    let gear = GearDefinition::from_document(&document).unwrap();
    let options = ReductionOptions {
        estimate_error: false,
    };
    let python = PythonEnvironment::find().unwrap();
    let (model, body) = reduce(&gear, &python, options, &Silent).unwrap();

    let [back, front] = body.mesh.shaft_faces(gear.blank.two_faced_shaft().unwrap());
    let fixed: Vec<usize> = back
        .iter()
        .flat_map(|&n| (0..3).map(move |a| 3 * n as usize + a))
        .collect();
    let group = RigidGroup {
        nodes: front.iter().map(|&n| n as usize).collect(),
        reference_m: [0.0, 0.0, 0.015],
        fixed: [false; 6],
    };
    let dofs = DofMap::with_rigid_groups(body.model.nodes(), &fixed, &[group]).unwrap();
    let k = assemble_stiffness(&body.model, &dofs).unwrap();
    let m = assemble_mass(&body.model, &dofs, 7850.0).unwrap();
    let factor = Factor::of_model(&body.model, &dofs, &k).unwrap();
    let settings = ModeSettings {
        wanted: WantedModes::Lowest(6),
        ..ModeSettings::new(1)
    };
    let found = natural_modes(&k, &m, &factor, &settings).unwrap();
    let expected: Vec<f64> = found.omega_squared.iter().map(|w| w.sqrt() / TAU).collect();

    // Rayleigh and Ritz: from above, and closer with more modes.
    let mut before = vec![f64::INFINITY; expected.len()];
    for natural in [0, 8, 24] {
        let on_faces = GearOnFaces::new(&model, natural).unwrap();
        let frequencies = on_faces.model.modes.as_ref().unwrap().frequencies_hz();
        assert_eq!(frequencies.len(), 6 + natural);
        let off: Vec<f64> = (frequencies.iter().zip(&expected))
            .map(|(a, b)| a / b - 1.0)
            .collect();
        println!("{natural} natural modes: {off:.5?} of {expected:.0?} Hz");
        for (now, before) in off.iter().zip(&mut before) {
            assert!(*now > -1e-6 && *now < *before + 1e-9, "{now} {before}");
            *before = *now;
        }
    }
    assert!(before.iter().all(|off| *off < 0.01), "{before:?}");

    let loads = flank_loads(&gear, &body.mesh, &flank_grid(&gear), 0, Flank::Right);
    let root = gauge_row(&gear, &body.mesh, &body.model, &gear.gauges[0], 0).unwrap();
    let mut vectors: Vec<_> = loads.iter().map(|load| &load.normal).collect();
    vectors.push(&root);
    let expected = whole_compliance::products(&body.model, &dofs, &vectors);
    let on_faces = GearOnFaces::new(&model, 24).unwrap();
    let strain = &on_faces.model.gauges[0].adjoint;
    for (load, found) in strain.iter().step_by(3).take(loads.len()).enumerate() {
        let expected = expected[(loads.len(), load)];
        assert!((found / expected - 1.0).abs() < 1e-8, "{found} {expected}");
    }
    let found = on_faces.model.c_hub_block(0, Flank::Right, 0, Flank::Right);
    let held = model.c_hub_block(0, Flank::Right, 0, Flank::Right);
    for (i, (found, held)) in found.iter().zip(held.iter()).enumerate() {
        let expected = expected[(i / loads.len(), i % loads.len())];
        assert!((found / expected - 1.0).abs() < 1e-8, "{found} {expected}");
        assert!(expected > 1.01 * held);
    }
}
