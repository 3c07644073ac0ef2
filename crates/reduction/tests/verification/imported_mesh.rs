//! A gear that was meshed elsewhere: the same numbers from our own mesh read back, agreement with a mesh of tetrahedra,
//! and what is said when the mesh is not the gear.

use crate::computed;
use crate::small_gears::{self, MESH, QUADRATIC, SOLID, difference, reduced};
use gearmesh_fe::{QuadraticMesh, arc_middle, chord_middle};
use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{Blank, Flank, GearDefinition, LengthUnit, MeshedBody, ProfileCurve};
use gearmesh_mesh::GearMesh;
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_model::{CellKind, MeshData, ReducedGear};
use gearmesh_reduction::{ReductionError, Silent, reduce_imported};
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// Agreement demanded of the same mesh made here and read back: rounding alone.
const AGREEMENT: f64 = 1e-9;

fn gear(mesh: &str) -> GearDefinition {
    small_gears::gear(mesh, SOLID, 0.0)
}

fn meshed_elsewhere() -> MeshedBody {
    MeshedBody {
        file: "body.inp".into(),
        length_unit: LengthUnit::Metre,
        bore_set: "bore".into(),
        flank_sets: "tooth{tooth}_{side}_flank".into(),
    }
}

/// Our own mesh as another program would hand it over.
fn exported(gear: &GearDefinition, mesh: &GearMesh) -> MeshData {
    let kind = mesh.elements.shape();
    MeshData {
        points: mesh.nodes.clone(),
        cells: BTreeMap::from([(kind, mesh.elements.connectivity().to_vec())]),
        point_sets: mesh.node_sets(gear),
        ..MeshData::default()
    }
}

fn imported(gear: &GearDefinition, mesh: MeshData) -> Result<ReducedGear, ReductionError> {
    let mut gear = gear.clone();
    let body = meshed_elsewhere();
    gear.blank = Blank::Meshed {
        bore_radius_m: gear.blank.bore_radius_m(),
        body: body.clone(),
    };
    reduce_imported(&gear, &body, mesh, &Silent)
}

fn own(gear: &GearDefinition) -> (ReducedGear, GearMesh) {
    let (model, body) = reduced(gear, false);
    (model, body.mesh)
}

/// The same mesh, made here or read: the same C_hub for all pairs of teeth, C_tooth, near field and gauge rows.
#[test]
fn our_own_mesh_read_back_gives_the_same_numbers() {
    the_same_numbers(&gear(MESH));
}

#[test]
fn our_own_quadratic_mesh_read_back_gives_the_same_numbers() {
    the_same_numbers(&gear(QUADRATIC));
}

fn the_same_numbers(gear: &GearDefinition) {
    let (made, mesh) = own(gear);
    let read = imported(gear, exported(gear, &mesh)).unwrap();
    assert_eq!((made.sectors, read.sectors), (18, 1));
    for (load, response) in [(0, 0), (0, 1), (5, 5), (5, 4), (17, 8)] {
        for &a in &made.flanks {
            for &b in &made.flanks {
                let difference = difference(
                    &made.c_hub_block(load, a, response, b),
                    &read.c_hub_block(load, a, response, b),
                );
                assert!(difference < AGREEMENT, "{load} {response}: {difference:e}");
            }
        }
    }
    assert!(difference(&made.c_tooth, &read.c_tooth) < AGREEMENT);
    let [of_made, of_read] = [&made, &read].map(|m| m.near_field.as_ref().unwrap());
    let fine = difference(&of_made.contact_m2_per_n, &of_read.contact_m2_per_n);
    assert!(fine < AGREEMENT, "{fine:e}");
    let near = difference(&of_made.mesh_m2_per_n, &of_read.mesh_m2_per_n);
    assert!(near < AGREEMENT, "{near:e}");
    // The teeth have one mesh, turned.
    let spread = read.checks.further[0].1;
    assert!(spread < AGREEMENT, "{spread:e}");
    for (a, b) in made.gauges.iter().zip(&read.gauges) {
        assert!(difference(&a.adjoint, &b.adjoint) < AGREEMENT);
        assert!(difference(&a.own_tooth, &b.own_tooth) < AGREEMENT);
    }
}

/// Every hexahedron cut in six tetrahedra, columns of nodes in the order of their numbers so that neighbours agree; new
/// nodes on the profile, the bore, or the middle of their edge.
fn in_tetrahedra(gear: &GearDefinition, mesh: &GearMesh) -> MeshData {
    let mut tetrahedra: Vec<[u32; 4]> = Vec::new();
    for hex in mesh.elements.iter() {
        let column = |k: usize| [hex[k], hex[k + 4]];
        // The diagonal of the quad starts at its smallest node.
        let first = (0..4).min_by_key(|&k| hex[k]).unwrap();
        let corner = |k: usize| column((first + k) % 4);
        for prism in [
            [corner(0), corner(1), corner(2)],
            [corner(0), corner(2), corner(3)],
        ] {
            let mut sorted = prism;
            sorted.sort_unstable();
            let [[a, a_up], [b, b_up], [c, c_up]] = sorted;
            for tet in [[a, b, c, c_up], [a, b, b_up, c_up], [a, a_up, b_up, c_up]] {
                let x = tet.map(|n| mesh.nodes[n as usize]);
                let edge = |k: usize| -> [f64; 3] { std::array::from_fn(|i| x[k][i] - x[0][i]) };
                let (u, v, w) = (edge(1), edge(2), edge(3));
                let volume = u[0] * (v[1] * w[2] - v[2] * w[1])
                    - u[1] * (v[0] * w[2] - v[2] * w[0])
                    + u[2] * (v[0] * w[1] - v[1] * w[0]);
                let [p, q, r, s] = tet;
                tetrahedra.push(if volume > 0.0 { tet } else { [p, r, q, s] });
            }
        }
    }
    let curve = ProfileCurve::new(&gear.profile);
    let teeth = gear.tooth.teeth;
    let on_profile = |[a, b]: [[f64; 3]; 2]| -> Option<[f64; 3]> {
        let centre = chord_middle([a, b]);
        let pitch = TAU / teeth as f64;
        let tooth = (centre[1].atan2(centre[0]) / pitch).round();
        let (sin, cos) = (tooth * pitch).sin_cos();
        let back = |p: [f64; 3]| [cos * p[0] + sin * p[1], cos * p[1] - sin * p[0]];
        let mirror = if back(centre)[1] > 0.0 { -1.0 } else { 1.0 };
        let arcs = [a, b].map(|p| {
            let [x, y] = back(p);
            curve.place_of([x, mirror * y])
        });
        let near = arcs.iter().all(|(_, off)| off.abs() < 1e-9);
        let [x, y] = curve.point_at(0.5 * (arcs[0].0 + arcs[1].0));
        let y = mirror * y;
        near.then_some([cos * x - sin * y, sin * x + cos * y, centre[2]])
    };
    let bore = gear.blank.bore_radius_m();
    let place = |_, ends: [[f64; 3]; 2]| {
        if ends.iter().all(|p| (p[0].hypot(p[1]) - bore).abs() < 1e-9) {
            return arc_middle(ends);
        }
        on_profile(ends).unwrap_or_else(|| chord_middle(ends))
    };
    let quadratic = QuadraticMesh::of_tetrahedra(mesh.nodes.clone(), &tetrahedra, place);
    let mut data = MeshData {
        points: quadratic.nodes,
        cells: BTreeMap::from([(CellKind::Tet10, quadratic.elements.into_flattened())]),
        ..MeshData::default()
    };
    // New nodes between members of a set are members; on the outline and the bore every such edge lies on the surface.
    for (name, set) in mesh.node_sets(gear) {
        let mut member = vec![false; mesh.nodes.len()];
        set.iter().for_each(|&n| member[n as usize] = true);
        let mut all = set.clone();
        for tet in data.cells[&CellKind::Tet10].chunks_exact(10) {
            for (k, [a, b]) in CellKind::Tet10.edges().iter().copied().enumerate() {
                if [a, b].iter().all(|&c| member[tet[c] as usize]) {
                    all.push(tet[4 + k]);
                }
            }
        }
        all.sort_unstable();
        all.dedup();
        data.point_sets.insert(name, all);
    }
    data
}

/// Deflection of the middle station under one newton over the whole width, calibrated: C_hub and what the near field
/// adds for the same contact on every mesh.
fn deflection(model: &ReducedGear) -> f64 {
    let flank = model.flanks[0];
    let (count, axial) = (model.grid.len(), model.grid.z_m.len());
    let station = 1;
    let share = |j: usize| if j == 0 || j == axial - 1 { 0.5 } else { 1.0 } / (axial - 1) as f64;
    let block = model.c_hub_block(0, flank, 0, flank);
    let mut hub = 0.0;
    for i in 0..axial {
        for j in 0..axial {
            let (l, m) = (model.grid.load(station, i), model.grid.load(station, j));
            hub += share(i) * share(j) * block[l * count + m];
        }
    }
    let field = model.near_field.as_ref().unwrap();
    let stations = model.grid.roll_angles_rad.len();
    let roll = model.grid.roll_angles_rad[station];
    let near = field.contact_at(roll, model.base_radius_m)
        - field.mesh_m2_per_n[station * stations + station];
    hub + near / model.face_width_m
}

/// Quadratic tetrahedra on the coarse mesh and hexahedra on a finer one, recorded, come to the same deflection.
#[test]
#[ignore = "every tooth of a mesh of tetrahedra is loaded (cargo xtask test runs it)"]
fn tetrahedra_agree_with_hexahedra() {
    let narrow = |mesh: &str| {
        let text = gear(mesh)
            .source
            .replace("face_width_mm = 12.0", "face_width_mm = 6.0")
            .replace("z_mm = 2.0", "z_mm = 0.0")
            .replace("slices = 2", "slices = 1")
            .replace("flanks = [\"right\", \"left\"]", "flanks = [\"right\"]");
        GearDefinition::from_document(&InputDocument::new("small.toml", text)).unwrap()
    };
    let coarse = narrow(MESH);
    let (hexahedra, mesh) = own(&coarse);
    let tetrahedra = imported(&coarse, in_tetrahedra(&coarse, &mesh)).unwrap();
    assert_eq!(tetrahedra.provenance.element, "tet10");
    let fine = narrow("flank_mm = 0.6\nfillet_mm = 0.3\nbody_mm = 2.0\naxial_mm = 0.75\n");
    let fine = computed::numbers("hexahedra_for_imported_mesh", &fine.source, || {
        vec![deflection(&own(&fine).0)]
    })[0];
    let [coarse, tets] = [&hexahedra, &tetrahedra].map(deflection);
    let (hex_error, tet_error) = (coarse / fine - 1.0, tets / fine - 1.0);
    println!("tet10 {tet_error:.5}, hex8-incompatible on the same mesh {hex_error:.5}");
    assert!(tet_error.abs() < 0.004, "{tet_error} {hex_error}");
    assert!(hex_error.abs() < 0.02, "{hex_error}");
}

fn refusal(change: impl FnOnce(&mut GearDefinition, &mut MeshData)) -> String {
    let mut gear = gear(MESH);
    let python = PythonEnvironment::find().unwrap();
    let mesh = GearMesh::new(&gear, &python).unwrap();
    let mut data = exported(&gear, &mesh);
    change(&mut gear, &mut data);
    imported(&gear, data).unwrap_err().to_string()
}

fn said(message: &str, parts: &[&str]) {
    for part in parts {
        assert!(message.contains(part), "`{part}` is not in: {message}");
    }
}

#[test]
fn a_mesh_that_is_not_the_gear_is_explained() {
    let message = refusal(|_, mesh| {
        mesh.point_sets.remove("tooth4_left_flank");
        mesh.point_sets.remove("tooth7_right_flank");
    });
    said(
        &message,
        &[
            "body.inp",
            "\"tooth4_left_flank\" (and 1 more",
            "\"bore\", ",
            "and 45 more",
        ],
    );

    let message = refusal(|_, mesh| mesh.point_sets.clear());
    said(
        &message,
        &["\"bore\"", "where the gear is held", "no sets at all"],
    );

    // A millimetre file read as metres: the bore says so first.
    let scaled = |mesh: &mut MeshData, by: f64| {
        mesh.points
            .as_flattened_mut()
            .iter_mut()
            .for_each(|x| *x *= by);
    };
    let message = refusal(|_, mesh| scaled(mesh, 1e3));
    said(
        &message,
        &[
            "radius 10000.0000 mm",
            "10.0000 mm",
            "6.0 um",
            "blank.length_unit",
        ],
    );

    // Half a tooth pitch out of phase, and a little out of phase.
    let turned = |mesh: &mut MeshData, angle: f64| {
        let (sin, cos) = angle.sin_cos();
        for p in &mut mesh.points {
            *p = [cos * p[0] - sin * p[1], sin * p[0] + cos * p[1], p[2]];
        }
    };
    for degrees in [10.0_f64, 0.1] {
        let message = refusal(|_, mesh| turned(mesh, degrees.to_radians()));
        let by = format!("turned by {degrees:.4} deg");
        said(
            &message,
            &[
                "off the right flank of tooth 0",
                "6.0 um (0.2 % of the module)",
                &by,
            ],
        );
    }

    // Seen from the other end: elements inside out would be refused before, so they are turned round too.
    let message = refusal(|_, mesh| {
        for p in &mut mesh.points {
            p[1] = -p[1];
        }
        for hex in mesh
            .cells
            .get_mut(&CellKind::Hex8)
            .unwrap()
            .chunks_exact_mut(8)
        {
            (0..4).for_each(|k| hex.swap(k, k + 4));
        }
    });
    said(&message, &["where the left flank lies", "mirror image"]);

    // Another profile shift.
    let message = refusal(|gear, _| {
        *gear = {
            let text = gear
                .source
                .replace("profile_shift = 0.1", "profile_shift = 0.2");
            GearDefinition::from_document(&InputDocument::new("small.toml", text)).unwrap()
        }
    });
    said(
        &message,
        &[
            "um off the right flank of tooth 0",
            "um (0.2 % of the module)",
        ],
    );

    // Half of the width.
    let message = refusal(|gear, _| gear.tooth.face_width_m = 0.024);
    said(&message, &["cover 50.00 %", "face width of 24.000 mm"]);

    // A second body beside the first.
    let message = refusal(|_, mesh| {
        let (points, nodes) = (mesh.points.clone(), mesh.cells[&CellKind::Hex8].clone());
        let first = points.len() as u32;
        mesh.points
            .extend(points.iter().map(|p| [p[0], p[1], p[2] + 1.0]));
        let copy = nodes.iter().map(|n| n + first);
        mesh.cells.get_mut(&CellKind::Hex8).unwrap().extend(copy);
    });
    said(&message, &["2 parts that share no node"]);

    // An element inside out.
    let message = refusal(|_, mesh| mesh.cells.get_mut(&CellKind::Hex8).unwrap().swap(80, 81));
    said(&message, &["element 10", "Jacobian"]);
}

/// One missing gauge face set is no matter: roots are found by where they are, on either side.
#[test]
fn root_sets_are_not_needed() {
    let gear = gear(MESH);
    let python = PythonEnvironment::find().unwrap();
    let mesh = GearMesh::new(&gear, &python).unwrap();
    let mut data = exported(&gear, &mesh);
    data.point_sets.retain(|name, _| !name.ends_with("_root"));
    let read = imported(&gear, data).unwrap();
    assert_eq!(read.gauges.len(), 1);
    assert_eq!(read.flanks.len(), [Flank::Right, Flank::Left].len());
}
