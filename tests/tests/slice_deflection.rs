//! Validation in three dimensions with free ends: one of 5 and one of 10 slices loaded, deflection there and on all other
//! slices, against a mesh graded to the contact in all directions.
//!
//! The body under the teeth is left out on both sides: the gear is one tooth held at its cut. It is the near field that is at
//! stake, and so the fine mesh stays affordable.
#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

mod graded_tooth;

use gearmesh_contact::{LocalContact, SliceCompliance};
use gearmesh_fe::{DofMap, Factor, FeModel, HexElement, Material, assemble_stiffness};
use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{FlankSide, GearDefinition, involute};
use gearmesh_mesh::GearMesh;
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_model::{Flank, Provenance, ReducedGear, ReductionChecks};
use gearmesh_reduction::flank_loads::{dot, flank_grid, flank_loads};
use gearmesh_reduction::near_field::calibrate;
use graded_tooth::{Contact, GradedTooth};

const YOUNG: f64 = 206e9;
const POISSON: f64 = 0.3;
const WIDTH_M: f64 = 20e-3;
const HALF_WIDTH_M: f64 = 1.2e-4;
const RADIUS_M: f64 = 76e-3;

fn gear(slices: usize, stations: usize) -> GearDefinition {
    let text = format!(
        "name = \"tooth\"\n[tooth]\nteeth = 50\nmodule_mm = 3.0\nface_width_mm = 20.0\n[blank]\nkind = \"solid\"\n\
         bore_diameter_mm = 60.0\n[material]\nyoung_GPa = 206.0\npoisson = 0.3\n[mesh]\nflank_mm = 0.8\naxial_mm = 1.0\n\
         [reduction]\nflanks = [\"right\"]\nslices = {slices}\nroll_stations = {stations}\n"
    );
    GearDefinition::from_document(&InputDocument::new("tooth.toml", text)).unwrap()
}

fn material() -> Material {
    Material::new(YOUNG, POISSON).unwrap()
}

/// Deflection of each slice \[m/N\] with each slice loaded, `[loaded][slice]`, as the online side has it.
fn sliced(gear: &GearDefinition, mesh: &GearMesh) -> Vec<Vec<f64>> {
    let grid = flank_grid(gear);
    let loads = flank_loads(gear, mesh, &grid, 0, FlankSide::Right);
    let all = FeModel::new(
        mesh.nodes.clone(),
        mesh.hexes.clone(),
        material(),
        HexElement::Hex8Incompatible,
    )
    .unwrap();
    let near_field = calibrate(gear, mesh, &all, &grid).unwrap();

    // The tooth alone, its cut held.
    let hexes = mesh.tooth_hexes(0);
    let mut nodes: Vec<u32> = hexes.iter().flat_map(|&h| mesh.hexes[h as usize]).collect();
    nodes.sort_unstable();
    nodes.dedup();
    let local = |n: u32| nodes.binary_search(&n).unwrap();
    let tooth = FeModel::new(
        nodes.iter().map(|&n| mesh.nodes[n as usize]).collect(),
        hexes
            .iter()
            .map(|&h| mesh.hexes[h as usize].map(|n| local(n) as u32))
            .collect(),
        material(),
        HexElement::Hex8Incompatible,
    )
    .unwrap();
    let cell = &mesh.section.cell;
    let held: Vec<usize> = cell
        .cut
        .iter()
        .flat_map(|&n| {
            (0..mesh.layers.planes_m.len())
                .map(move |plane| mesh.node(mesh.section.cell_nodes[0][n], plane).unwrap())
        })
        .map(local)
        .collect();
    let dofs = DofMap::with_fixed_nodes(tooth.node_count(), &held).unwrap();
    let factor =
        Factor::of_model(&tooth, &dofs, &assemble_stiffness(&tooth, &dofs).unwrap()).unwrap();
    let rows: Vec<Vec<(usize, f64)>> = loads
        .iter()
        .map(|load| {
            (load.normal.iter())
                .map(|&(dof, v)| (3 * local((dof / 3) as u32) + dof % 3, v))
                .collect()
        })
        .collect();
    let count = grid.len();
    let mut block = vec![0.0; count * count];
    for (l, row) in rows.iter().enumerate() {
        let mut u = vec![0.0; dofs.free_count()];
        for &(dof, value) in row {
            if let Some(free) = dofs.free_of(dof) {
                u[free] = value;
            }
        }
        factor.solve_slice_in_place(&mut u);
        let full = dofs.expand(&u);
        for (m, response) in rows.iter().enumerate() {
            block[l * count + m] = dot(response, &full);
        }
    }
    let size = count * count;
    let mut c_hub = vec![0.0; gear.tooth.teeth * size];
    c_hub[..size].copy_from_slice(&block);
    let reduced = ReducedGear {
        name: gear.name.clone(),
        input_toml: gear.source.clone(),
        teeth: gear.tooth.teeth,
        sectors: gear.tooth.teeth,
        base_radius_m: gear.profile.base_radius_m,
        face_width_m: WIDTH_M,
        young_pa: YOUNG,
        poisson: POISSON,
        flanks: vec![Flank::Right],
        c_hub,
        c_tooth: vec![0.0; size],
        opposite_distance_m: vec![3e-3; grid.roll_angles_rad.len()],
        near_field: Some(near_field),
        gauges: Vec::new(),
        provenance: Provenance::default(),
        checks: ReductionChecks::default(),
        grid,
    };
    let compliance =
        SliceCompliance::new(&reduced, Flank::Right, LocalContact::Calibrated).unwrap();
    let n = compliance.slices();
    let roll = involute::roll_angle_rad(RADIUS_M, gear.profile.base_radius_m);
    let place = compliance.place(roll);
    let mut c = vec![0.0; n * n];
    compliance.add_block((0, place), (0, place), 1.0, &mut c, 0, n);
    let k = 2.0 * (1.0 - POISSON * POISSON) / (std::f64::consts::PI * YOUNG);
    let own = k
        * ((2.0 * compliance.local_depth_m(roll, 1.0) / HALF_WIDTH_M).ln()
            - POISSON / (2.0 * (1.0 - POISSON)))
        / compliance.slice_width_m();
    (0..n)
        .map(|loaded| {
            (0..n)
                .map(|i| c[loaded * n + i] + if i == loaded { own } else { 0.0 })
                .collect()
        })
        .collect()
}

#[test]
#[ignore = "study"]
fn study() {
    let python = PythonEnvironment::find().unwrap();
    let contact = Contact {
        radius_m: RADIUS_M,
        half_width_m: HALF_WIDTH_M,
    };
    let base = gear(5, 9);
    let mesh = GearMesh::new(&base, &python).unwrap();
    let factors: Vec<f64> = std::env::var("FACTORS")
        .unwrap()
        .split(',')
        .map(|f| f.parse().unwrap())
        .collect();
    let graded: Vec<GradedTooth> = factors
        .iter()
        .map(|&f| {
            let clock = std::time::Instant::now();
            let g = GradedTooth::new(&base, &mesh, contact, f);
            println!(
                "factor {f}: {} dofs, {:.1} s",
                g.dofs,
                clock.elapsed().as_secs_f64()
            );
            for (n, j) in [(1, 0), (5, 2), (5, 0), (10, 4), (10, 0)] {
                println!(
                    "  {n} {j}: {}",
                    g.deflections(n, j)
                        .iter()
                        .map(|d| format!("{:9.4}", d * 1e9))
                        .collect::<String>()
                );
            }
            g
        })
        .collect();
    let best = if graded.len() > 1 {
        graded[0].extrapolated(&graded[1], factors[1] / factors[0], 2.0)
    } else {
        graded.into_iter().next().unwrap()
    };
    for stations in [9, 17] {
        for slices in [5, 10] {
            let gear = gear(slices, stations);
            let ours = sliced(&gear, &GearMesh::new(&gear, &python).unwrap());
            let fine: Vec<Vec<f64>> = (0..slices).map(|j| best.deflections(slices, j)).collect();
            let line = |of: &dyn Fn(usize) -> f64| {
                (0..slices)
                    .map(|i| format!("{:8.3}", 100.0 * of(i)))
                    .collect::<String>()
            };
            println!("stations {stations} slices {slices}");
            let sum = |c: &Vec<Vec<f64>>, i: usize| -> f64 { c.iter().map(|row| row[i]).sum() };
            println!(
                " uniform  {} mean {:.3}",
                line(&|i| sum(&ours, i) / sum(&fine, i) - 1.0),
                100.0
                    * ((0..slices).map(|i| sum(&ours, i)).sum::<f64>()
                        / (0..slices).map(|i| sum(&fine, i)).sum::<f64>()
                        - 1.0)
            );
            for j in 0..slices {
                println!(
                    " loaded {j} {}  own rel",
                    line(&|i| (ours[j][i] - fine[j][i]) / fine[j][j])
                );
            }
        }
    }
}
