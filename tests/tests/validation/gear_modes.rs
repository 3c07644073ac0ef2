//! Natural frequencies of a small gear against scikit-fem on the same mesh: own assembly, ARPACK.

use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{GearDefinition, ModeRange};
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_model::{CellKind, MeshData, write_mesh};
use gearmesh_reduction::{GearBody, Silent};
use std::collections::BTreeMap;

const DENSITY: f64 = 7850.0;

/// A thin rim in the plain brick, which scikit-fem has too, and elements as large as the quality allows: what holds to
/// rounding holds on any mesh.
const GEAR: &str = "name = \"small\"
[tooth]
teeth = 12
module_mm = 3.0
profile_shift = 0.1
face_width_mm = 12.0
[blank]
kind = \"thin-rim\"
bore_diameter_mm = 10.0
hub_diameter_mm = 14.0
rim_inner_diameter_mm = 22.0
web_thickness_mm = 4.0
[material]
young_GPa = 210.0
poisson = 0.3
[mesh]
element = \"hex8\"
flank_mm = 2.4
fillet_mm = 1.2
body_mm = 6.0
axial_mm = 12.0
";

/// Harmonics of one sector of 12 against all degrees of freedom at once, by other elements and another solver: 1e-8.
#[test]
fn frequencies_are_those_of_scikit_fem() {
    let python = PythonEnvironment::find().unwrap();
    let gear = GearDefinition::from_document(&InputDocument::new("gear.toml", GEAR)).unwrap();
    let body = GearBody::new(&gear, &python, &Silent).unwrap();
    let rigid = body.rigid_mass(DENSITY).unwrap();
    let count = 14;
    let modes = body
        .natural_modes(&rigid, ModeRange::Count(count), &Silent, |_, _, _| {})
        .unwrap();

    let folder = std::env::temp_dir().join(format!("gear-modes-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("gear.h5");
    println!("{} nodes", body.mesh.nodes.len());
    let data = MeshData {
        points: body.mesh.nodes.clone(),
        cells: BTreeMap::from([(CellKind::Hex8, body.mesh.elements.connectivity().to_vec())]),
        point_sets: body.mesh.node_sets(&gear),
        ..MeshData::default()
    };
    write_mesh(&file, &data).unwrap();
    let young = gear.material.young_pa.to_string();
    let poisson = gear.material.poisson.to_string();
    let arguments = [
        file.to_str().unwrap(),
        &young,
        &poisson,
        &DENSITY.to_string(),
        &count.to_string(),
    ];
    let script = include_str!("../../python/gear_modes_skfem.py");
    let answer = python.run("scikit-fem", script, &arguments, b"").unwrap();
    std::fs::remove_dir_all(folder).unwrap();
    let expected: Vec<f64> = String::from_utf8(answer)
        .unwrap()
        .lines()
        .map(|line| line.parse().unwrap())
        .collect();
    assert_eq!(expected.len(), count);
    for (mode, expected) in modes.modes.iter().zip(&expected) {
        let found = mode.frequency_hz();
        assert!((found / expected - 1.0).abs() < 1e-8, "{found} {expected}");
    }
}
