//! Natural frequencies of gear 2, on a coarse mesh, against scikit-fem on the same mesh: own assembly, ARPACK.

use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{GearDefinition, ModeRange};
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_model::{CellKind, MeshData, write_mesh};
use gearmesh_reduction::{GearBody, Silent};
use std::collections::BTreeMap;
use std::path::Path;

const DENSITY: f64 = 7850.0;

/// Gear 2 with the plain brick, which scikit-fem has too, and elements as large as the quality allows.
fn gear() -> GearDefinition {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fe_models/gear2.toml");
    let text = std::fs::read_to_string(path).unwrap();
    let text = format!(
        "{text}\n[mesh]\nelement = \"hex8\"\nflank_mm = 2.5\nfillet_mm = 1.2\nbody_mm = 10.0\naxial_mm = 23.0\n"
    );
    GearDefinition::from_document(&InputDocument::new("gear2.toml", text)).unwrap()
}

/// Harmonics of one sector of 57 against all degrees of freedom at once, by other elements and another solver: 1e-8.
#[test]
#[ignore = "assembly and direct solution in Python, a minute"]
fn frequencies_of_gear_2_are_those_of_scikit_fem() {
    let python = PythonEnvironment::find().unwrap();
    let gear = gear();
    let body = GearBody::new(&gear, &python, &Silent).unwrap();
    let rigid = body.rigid_mass(DENSITY).unwrap();
    let count = 14;
    let modes = body
        .natural_modes(&rigid, ModeRange::Count(count), &Silent, |_, _, _| {})
        .unwrap();

    let folder = std::env::temp_dir().join(format!("gear-modes-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("gear.h5");
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
