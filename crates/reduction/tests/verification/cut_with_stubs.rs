//! A pinion cut into its shaft, with stubs of the shaft on its faces in one finite element model, against the reduced pinion on beams.

use crate::small_gears::{COARSE, body};
use crate::whole_compliance::products;
use gearmesh_fe::{DofMap, FeModel, RigidGroup};
use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{Flank, GearDefinition};
use gearmesh_reduction::flank_loads::{SparseVector, flank_grid, flank_loads};
use gearmesh_reduction::{GearBody, Silent};
use nalgebra::{Matrix6, Vector3, Vector6};
use std::f64::consts::PI;

/// 17 teeth of module 3 mm, 30 mm wide.
fn pinion(blank: &str) -> GearDefinition {
    let text = format!(
        "name = \"pinion\"\n[tooth]\nteeth = 17\nmodule_mm = 3.0\nprofile_shift = 0.2\nface_width_mm = 30.0\n[material]\nyoung_GPa = 210.0\npoisson = 0.3\n\
         [reduction]\nroll_stations = 3\nslices = 2\nflanks = [\"right\"]\n[mesh]\n{COARSE}[blank]\nkind = \"solid\"\n{blank}"
    );
    GearDefinition::from_document(&InputDocument::new("pinion.toml", text)).unwrap()
}

const SHAFT_M: f64 = 0.5 * 32e-3;
const STUB_M: [f64; 2] = [40e-3, 50e-3];

/// The pinion's model with a stub of the shaft on its back (0) and front (1), and the nodes at their far ends.
fn with_stubs(gear: &GearDefinition, body: &GearBody) -> (FeModel, [Vec<usize>; 2]) {
    let mesh = &body.mesh;
    let section = &mesh.section;
    let inside = |n: usize| {
        let [x, y] = section.nodes[n];
        x.hypot(y) <= SHAFT_M * (1.0 + 1e-6)
    };
    let quads: Vec<[usize; 4]> = (section.quads.iter().copied())
        .filter(|quad| quad.iter().all(|&n| inside(n)))
        .collect();
    let mut nodes = mesh.nodes.clone();
    let mut connectivity = mesh.elements.connectivity().to_vec();
    let half = 0.5 * gear.tooth.face_width_m;
    let planes = mesh.layers.planes_m.len();
    let ends = [0, 1].map(|side| {
        let sign = [-1.0, 1.0][side];
        let face = [0, planes - 1][side];
        let count = 10;
        let mut last: Vec<Option<u32>> = (0..section.nodes.len())
            .map(|n| mesh.node(n, face))
            .collect();
        for layer in 1..=count {
            let z = sign * (half + STUB_M[side] * f64::from(layer) / f64::from(count));
            let mut next = vec![None; last.len()];
            for &n in quads.iter().flatten() {
                if next[n].is_none() {
                    next[n] = Some(nodes.len() as u32);
                    let [x, y] = section.nodes[n];
                    nodes.push([x, y, z]);
                }
            }
            for quad in &quads {
                let (low, high) = if side == 1 {
                    (&last, &next)
                } else {
                    (&next, &last)
                };
                connectivity.extend(quad.iter().map(|&n| low[n].unwrap()));
                connectivity.extend(quad.iter().map(|&n| high[n].unwrap()));
            }
            last = next;
        }
        last.into_iter()
            .enumerate()
            .filter(|(n, _)| inside(*n))
            .filter_map(|(_, n)| Some(n? as usize))
            .collect()
    });
    let (material, element) = (*body.model.material(), body.model.element_of(0));
    (
        FeModel::from_connectivity(nodes, connectivity, material, element).unwrap(),
        ends,
    )
}

/// Force and moment about a point on the axis of a load on nodes.
fn resultant(nodes: &[[f64; 3]], load: &SparseVector, z: f64) -> Vector6<f64> {
    let mut sum = Vector6::zeros();
    for &(dof, value) in load {
        let mut force = Vector3::zeros();
        force[dof % 3] = value;
        let [x, y, height] = nodes[dof / 3];
        let moment = Vector3::new(x, y, height - z).cross(&force);
        for k in 0..3 {
            sum[k] += force[k];
            sum[3 + k] += moment[k];
        }
    }
    sum
}

/// Compliance of a cantilever of the shaft at its free end; `towards` is the sign of z from there to its clamp.
fn cantilever(length: f64, towards: f64) -> Matrix6<f64> {
    let (young, poisson) = (210e9, 0.3);
    let shear = young / (2.0 * (1.0 + poisson));
    let area = PI * SHAFT_M * SHAFT_M;
    let second = 0.25 * PI * SHAFT_M.powi(4);
    let kappa = 6.0 * (1.0 + poisson) / (7.0 + 6.0 * poisson);
    let across = length.powi(3) / (3.0 * young * second) + length / (kappa * shear * area);
    let mixed = towards * length * length / (2.0 * young * second);
    let turn = length / (young * second);
    let mut h = Matrix6::zeros();
    (h[(0, 0)], h[(1, 1)], h[(2, 2)]) = (across, across, length / (young * area));
    (h[(3, 3)], h[(4, 4)], h[(5, 5)]) = (turn, turn, length / (2.0 * shear * second));
    (h[(0, 4)], h[(4, 0)]) = (-mixed, -mixed);
    (h[(1, 3)], h[(3, 1)]) = (mixed, mixed);
    h
}

/// How the far ends of the stubs stand.
#[derive(Clone, Copy, PartialEq)]
enum Ends {
    /// The front one clamped, the back one free.
    Cantilever,
    /// The front one clamped, the back one held across the axis: a bearing.
    Supported,
}

/// Deflections along the normal under a unit force at each load point of tooth 0, by beams of the shaft and the gear's own body.
/// The gear stands on the front face where it is cut into the shaft, otherwise on its middle, to which the shaft goes on.
fn on_beams(
    gear: &GearDefinition,
    body: &GearBody,
    loads: &[SparseVector],
    ends: Ends,
) -> Vec<f64> {
    let half = 0.5 * gear.tooth.face_width_m;
    let (place, within) = match gear.blank.cut_into_shaft() {
        Some(_) => (half, 0.0),
        None => (0.0, half),
    };
    let front = cantilever(STUB_M[1] + within, 1.0);
    let mut stiffness = front.try_inverse().unwrap();
    if ends == Ends::Supported {
        let spring = 1.0 / cantilever(STUB_M[0] + within, 1.0)[(0, 0)];
        let arm = -half - STUB_M[0] - place;
        for (axis, turn, sign) in [(0, 4, 1.0), (1, 3, -1.0)] {
            let mut row = Vector6::zeros();
            (row[axis], row[turn]) = (1.0, sign * arm);
            stiffness += spring * row * row.transpose();
        }
    }
    let beams = stiffness.try_inverse().unwrap();
    let vectors: Vec<&SparseVector> = loads.iter().collect();
    let own = body.compliance(1, &vectors, &Silent);
    let row = gear.tooth.teeth * loads.len();
    (loads.iter().enumerate())
        .map(|(i, load)| {
            let at = resultant(&body.mesh.nodes, load, place);
            own[i * row + i] + at.dot(&(beams * at))
        })
        .collect()
}

/// The same by finite elements of pinion and stubs.
fn in_one_model(
    gear: &GearDefinition,
    body: &GearBody,
    loads: &[SparseVector],
    ends: Ends,
) -> Vec<f64> {
    let (model, [back, front]) = with_stubs(gear, body);
    let group = RigidGroup {
        nodes: back,
        reference_m: [0.0, 0.0, -0.5 * gear.tooth.face_width_m - STUB_M[0]],
        fixed: [true, true, false, false, false, false],
    };
    let groups: Vec<RigidGroup> = (ends == Ends::Supported)
        .then_some(group)
        .into_iter()
        .collect();
    let fixed: Vec<usize> = front
        .iter()
        .flat_map(|&n| [3 * n, 3 * n + 1, 3 * n + 2])
        .collect();
    let dofs = DofMap::with_rigid_groups(model.nodes(), &fixed, &groups).unwrap();
    let vectors: Vec<&SparseVector> = loads.iter().collect();
    let full = products(&model, &dofs, &vectors);
    (0..loads.len()).map(|i| full[(i, i)]).collect()
}

fn loaded(blank: &str) -> (GearDefinition, GearBody, Vec<SparseVector>) {
    let gear = pinion(blank);
    let body = body(&gear);
    let grid = flank_grid(&gear);
    let loads = flank_loads(&gear, &body.mesh, &grid, 0, Flank::Right);
    (
        gear,
        body,
        loads.into_iter().map(|load| load.normal).collect(),
    )
}

/// Mean of the relative differences, and the largest.
fn off(found: &[f64], expected: &[f64]) -> (f64, f64) {
    let each = || found.iter().zip(expected).map(|(a, b)| a / b - 1.0);
    (
        each().sum::<f64>() / found.len() as f64,
        each().fold(0.0, |m: f64, x| m.max(x.abs())),
    )
}

/// Shaft of 32 mm, root of 43 mm. What is left is the joint of stub and gear (the held face is rigid, a stub's end is not) and, between
/// two supports, the core's bending beyond the face. A bore that is not there adds deflection of its own, as much as it pleases.
#[test]
fn a_pinion_on_beams_gives_way_as_one_with_its_shaft() {
    let shaft = 2e3 * SHAFT_M;
    let (gear, body, loads) = loaded(&format!(
        "bore_diameter_mm = 0\nshaft_diameter_mm = [0, {shaft}]\n"
    ));
    let both = loaded(&format!(
        "bore_diameter_mm = 0\nshaft_diameter_mm = [{shaft}, {shaft}]\n"
    ));
    let bores = ["13.0", "31.0"].map(|bore| loaded(&format!("bore_diameter_mm = {bore}\n")));
    for (ends, mean_allowed, allowed) in [
        (Ends::Cantilever, 0.02, 0.025),
        (Ends::Supported, 0.04, 0.08),
    ] {
        // The stubs stand on the nodes of the faces, which lie on the shaft's outline in both blanks.
        let expected = in_one_model(&both.0, &both.1, &both.2, ends);
        let (mean, worst) = off(&on_beams(&gear, &body, &loads, ends), &expected);
        println!(
            "cut into the shaft, held in front: mean {:+.2} %, worst {:.2} %",
            1e2 * mean,
            1e2 * worst
        );
        assert!(
            mean.abs() < mean_allowed && worst < allowed,
            "{mean} {worst}"
        );
        let (held_at_both, _) = off(&on_beams(&both.0, &both.1, &both.2, ends), &expected);
        println!("held at both faces: mean {:+.2} %", 1e2 * held_at_both);
        for (gear, body, loads) in &bores {
            let (invented, _) = off(&on_beams(gear, body, loads, ends), &expected);
            println!(
                "bore {:.1} mm: mean {:+.2} %",
                2e3 * gear.blank.bore_radius_m(),
                1e2 * invented
            );
            assert!(invented > 3.0 * mean.abs(), "{invented} {mean}");
        }
    }
}
