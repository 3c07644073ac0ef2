//! A filleted web with holes in ten-node tetrahedra against scikit-fem on the same mesh: stiffness and displacements.

use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{Flank, GearDefinition};
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_model::{CellKind, MeshData, write_mesh};
use gearmesh_reduction::flank_loads::{SparseVector, flank_grid, flank_loads};
use gearmesh_reduction::{GearBody, Silent};
use std::collections::BTreeMap;
use std::path::Path;

/// Web off the middle with fillets at hub and rim, two sectors with a hole each; elements as large as they may be.
const GEAR: &str = "name = \"filleted\"
[tooth]
teeth = 16
module_mm = 3.0
profile_shift = 0.2
face_width_mm = 12.0
[blank]
kind = \"contour\"
bore_diameter_mm = 12.0
hub_z_mm = [-8.0, 6.0]
web = [
  { diameter_mm = 18.0, z_mm = [-3.0, 2.0], fillet_radius_mm = 2.0 },
  { diameter_mm = 34.0, z_mm = [-2.0, 2.0], fillet_radius_mm = 1.5 },
]
holes = { count = 2, pitch_circle_diameter_mm = 26.5, diameter_mm = 2.8, phase_deg = 50.0 }
[material]
young_GPa = 210.0
poisson = 0.3
[mesh]
flank_mm = 3.0
fillet_mm = 0.8
body_mm = 6.0
axial_mm = 6.0
[reduction]
roll_stations = 4
slices = 2
";

fn write_columns(path: &Path, columns: &[Vec<f64>]) {
    let bytes: Vec<u8> = columns
        .iter()
        .flatten()
        .flat_map(|v| v.to_le_bytes())
        .collect();
    std::fs::write(path, bytes).unwrap();
}

/// Cyclic substructures against the whole gear at once, by elements assembled elsewhere: xᵀKx agrees to rounding,
/// displacements solve K u = f, and the compliances between the loads, near and far, are off by less than 1e-8:
/// u_iᵀ(f_j − K u_j) is what a solution with that K would add to them.
#[test]
#[ignore = "a whole gear in Python, a minute"]
fn stiffness_and_displacements_are_those_of_scikit_fem() {
    let python = PythonEnvironment::find().unwrap();
    let gear = GearDefinition::from_document(&InputDocument::new("gear.toml", GEAR)).unwrap();
    let body = GearBody::new(&gear, &python, &Silent).unwrap();
    assert_eq!(body.mesh.sectors(), 2);
    let dofs = 3 * body.mesh.nodes.len();
    println!("{dofs} degrees of freedom");
    let grid = flank_grid(&gear);
    // A load in the middle of a flank, one on a corner of a flank elsewhere.
    let loads: Vec<SparseVector> = [
        (0, Flank::Right, grid.load(2, 2)),
        (11, Flank::Left, grid.load(3, 0)),
    ]
    .into_iter()
    .map(|(tooth, side, load)| {
        flank_loads(&gear, &body.mesh, &grid, tooth, side)[load]
            .normal
            .clone()
    })
    .collect();
    let mut found: Vec<Vec<f64>> = Vec::new();
    let rows: Vec<&SparseVector> = loads.iter().collect();
    body.solve_each(&rows, &Silent, |_, u| found.push(u.to_vec()));
    // Smooth and rough fields, zero where the body is held.
    let bore = body.mesh.bore();
    let fields: Vec<Vec<f64>> = [1.0e3, 3.0e5]
        .into_iter()
        .map(|wave: f64| {
            let mut field: Vec<f64> = body
                .mesh
                .nodes
                .iter()
                .flat_map(|p| [0, 1, 2].map(|k| (wave * (p[k] + 0.3 * p[(k + 1) % 3])).sin()))
                .collect();
            for &n in &bore {
                field[3 * n as usize..3 * n as usize + 3].fill(0.0);
            }
            field
        })
        .collect();
    let energy = body.energy_products(&fields);

    let folder = std::env::temp_dir().join(format!("tetrahedra-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let [mesh_file, loads_file, fields_file] =
        ["gear.h5", "loads", "fields"].map(|name| folder.join(name));
    let data = MeshData {
        points: body.mesh.nodes.clone(),
        cells: BTreeMap::from([(CellKind::Tet10, body.mesh.elements.connectivity().to_vec())]),
        point_sets: body.mesh.node_sets(&gear),
        ..MeshData::default()
    };
    write_mesh(&mesh_file, &data).unwrap();
    let columns: Vec<Vec<f64>> = loads
        .iter()
        .map(|load| {
            let mut column = vec![0.0; dofs];
            load.iter().for_each(|&(dof, value)| column[dof] = value);
            column
        })
        .collect();
    write_columns(&loads_file, &[columns, found].concat());
    write_columns(&fields_file, &fields);
    let arguments = [
        mesh_file.to_str().unwrap(),
        &gear.material.young_pa.to_string(),
        &gear.material.poisson.to_string(),
        loads_file.to_str().unwrap(),
        fields_file.to_str().unwrap(),
    ];
    let script = include_str!("../../python/tetrahedra_skfem.py");
    let answer = python.run("scikit-fem", script, &arguments, b"").unwrap();
    std::fs::remove_dir_all(folder).unwrap();
    let answer = String::from_utf8(answer).unwrap();
    let numbers: Vec<f64> = answer.lines().map(|line| line.parse().unwrap()).collect();
    println!("{numbers:?}");
    let (energies, of_loads) = numbers.split_at(fields.len());
    for (k, expected) in energies.iter().enumerate() {
        let off = energy[(k, k)] / expected - 1.0;
        assert!(off.abs() < 1e-11, "x'Kx {expected:.6e}, off by {off:.1e}");
    }
    assert_eq!(of_loads.len(), loads.len() * (1 + loads.len()));
    for (k, line) in of_loads.chunks(1 + loads.len()).enumerate() {
        assert!(line[0] < 1e-8, "load {k}: residual {:.1e}", line[0]);
        for error in &line[1..] {
            assert!(
                error.abs() < 1e-8,
                "load {k}: compliance off by {error:.1e}"
            );
        }
    }
}
