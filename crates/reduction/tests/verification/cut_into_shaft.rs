//! Gears without bore, cut into their shafts: held at their end faces, the core as stiff as a shaft.

use crate::small_gears::{self, COARSE, body, difference, reduced, without_symmetry};
use gearmesh_geometry::{Blank, CutIntoShaft, GearDefinition};
use gearmesh_reduction::Silent;
use std::f64::consts::PI;

const FRONT: &str =
    "[blank]\nkind = \"solid\"\nbore_diameter_mm = 0.0\nshaft_diameter_mm = [0.0, 30.0]\n";
const BOTH: &str =
    "[blank]\nkind = \"solid\"\nbore_diameter_mm = 0.0\nshaft_diameter_mm = [24.0, 30.0]\n";

/// The same gear with another hole left open in its mesh.
fn with_hole(gear: &GearDefinition, share: f64) -> GearDefinition {
    let mut gear = gear.clone();
    let shaft = *gear.blank.cut_into_shaft().unwrap();
    gear.blank = Blank::CutIntoShaft(CutIntoShaft {
        hole_radius_m: share * shaft.hole_radius_m,
        ..shaft
    });
    gear
}

/// Held are the ends of stubs of shaft, a quarter of its diameter beyond the faces, and there are nodes on the outline.
/// Their mass is not the gear's.
#[test]
fn the_shaft_is_held_some_way_off_its_faces() {
    let gear = small_gears::gear(COARSE, BOTH, 0.0);
    let body = body(&gear);
    let held = body.mesh.held(&gear.blank);
    let half = 0.5 * gear.tooth.face_width_m;
    for (face, radius) in [(-half - 6e-3, 12e-3), (half + 7.5e-3, 15e-3)] {
        let of_face = |n: &&u32| (body.mesh.nodes[**n as usize][2] - face).abs() < 1e-9;
        let radii: Vec<f64> = (held.iter().filter(of_face))
            .map(|&n| {
                let [x, y, _] = body.mesh.nodes[n as usize];
                x.hypot(y)
            })
            .collect();
        let most = radii.iter().copied().fold(0.0, f64::max);
        assert!((most - radius).abs() < 1e-9, "{most}");
        let here = |p: &&[f64; 3]| (p[2] - face).abs() < 1e-9;
        assert_eq!(radii.len(), body.mesh.nodes.iter().filter(here).count());
    }
    let beyond = |p: &&[f64; 3]| p[2].abs() > half + 1e-9;
    let reach = (body.mesh.nodes.iter().filter(beyond)).map(|p| p[0].hypot(p[1]) * p[2].signum());
    assert!(
        reach.clone().fold(0.0, f64::min) > -12e-3 - 1e-9
            && reach.fold(0.0, f64::max) < 15e-3 + 1e-9
    );
    let of_stubs: f64 = (body.mesh.stub_elements().into_iter())
        .map(|element| body.model.element_volume(element as usize).unwrap())
        .sum();
    let mass = body.rigid_body(7850.0).unwrap().mass_kg;
    assert!((mass / 7850.0 + of_stubs - body.model.volume().unwrap()).abs() < 1e-12);
    let moved = body.rigid_mass(7850.0).unwrap().body;
    assert!((moved.mass_kg / mass - 1.0).abs() < 1e-12);
}

/// The hole that the mesh leaves open does not count: half of it gives the same compliance. The cyclic solution is
/// that of the whole gear.
#[test]
fn the_hole_in_the_axis_does_not_count() {
    let gear = small_gears::gear(COARSE, FRONT, 0.0);
    let (model, _) = reduced(&gear, false);
    let (whole, _) = reduced(&without_symmetry(&gear), false);
    let symmetry = difference(&whole.c_hub, &model.c_hub);
    assert!(symmetry < 1e-9, "{symmetry:e}");
    let [four, half] = [4.0, 0.5].map(|share| {
        let (other, _) = reduced(&with_hole(&gear, share), false);
        difference(&model.c_hub, &other.c_hub)
    });
    println!("hole times 4: {four:e}, times 0.5: {half:e}");
    // Of the polar moment four times the hole takes 256 times as much. The mesh is another one as well.
    assert!(
        half < 1e-4 && half < four && four < 2e-3,
        "{half:e} {four:e}"
    );
}

/// A torque on the face that is not held turns the core like a shaft: away from both ends by T/(G J) in a length, J
/// between that of the root circle and that of the reference circle.
#[test]
fn the_core_twists_as_a_shaft() {
    let mut gear = small_gears::gear(COARSE, FRONT, 0.0);
    gear.tooth.face_width_m = 90e-3;
    let body = body(&gear);
    let mesh = &body.mesh;
    let half = 0.5 * gear.tooth.face_width_m;
    // Tangential forces in proportion to the radius.
    let loaded: Vec<usize> = (0..mesh.nodes.len())
        .filter(|&n| {
            (mesh.nodes[n][2] + half).abs() < 1e-9
                && mesh.nodes[n][0].hypot(mesh.nodes[n][1]) < 18e-3
        })
        .collect();
    let mut force = Vec::new();
    let mut torque = 0.0;
    for &n in &loaded {
        let [x, y, _] = mesh.nodes[n];
        force.extend([(3 * n, -y), (3 * n + 1, x)]);
        torque += x * x + y * y;
    }
    let mut u = Vec::new();
    body.solve_each(&[&force], &Silent, |_, field| u = field.to_vec());
    let turn = |z: f64| {
        let (mut sum, mut weight) = (0.0, 0.0);
        for (n, [x, y, height]) in mesh.nodes.iter().enumerate() {
            if (height - z).abs() < 1e-6 && x.hypot(*y) < 19e-3 {
                sum += x * u[3 * n + 1] - y * u[3 * n];
                weight += x * x + y * y;
            }
        }
        assert!(weight > 0.0, "no nodes at {z}");
        sum / weight
    };
    let mut planes: Vec<f64> = mesh
        .nodes
        .iter()
        .map(|p| p[2])
        .filter(|z| z.abs() < 0.5 * half)
        .collect();
    planes.sort_by(f64::total_cmp);
    let (low, high) = (planes[0], planes[planes.len() - 1]);
    let shear = gear.material.young_pa / (2.0 * (1.0 + gear.material.poisson));
    let polar = torque * (high - low) / (shear * (turn(low) - turn(high)));
    let of_circle = |r: f64| 0.5 * PI * r.powi(4);
    let (root, reference) = (gear.profile.root_radius_m, 0.5 * 18.0 * 3e-3);
    println!(
        "J {polar:e}: root {:e}, reference {:e}",
        of_circle(root),
        of_circle(reference)
    );
    assert!(polar > of_circle(root) && polar < of_circle(reference));
}
