//! Small made-up objects for the tests of several crates and of the Python module. Not results of any computation.

use std::collections::BTreeMap;

use crate::bevel_body::{BevelBody, BevelMember, BevelNearField, SpiralHand};
use crate::bore_patterns::BorePatterns;
use crate::hub_patterns::HubPatterns;
use crate::mesh_data::{Field, MeshData};
use crate::modal_basis::ModalBasis;
use crate::near_field::NearField;
use crate::reduced_gear::{FlankGrid, GaugeRows, Provenance, ReducedGear, ReductionChecks};
use crate::rigid_body::{ReferencePoint, RigidBody};
use crate::root_crack::RootCrack;
use crate::shaft_faces::{FaceMass, ShaftFaces};
use crate::stored_gear::StoredGear;
use gearmesh_elements::CellKind;
use gearmesh_geometry::Flank;
use std::sync::Arc;

/// The gear file of [`small_reduced_gear`].
const SYNTHETIC_TEXT: &str = r#"# made up
name = "synthetic" # α = 20°
[tooth]
teeth = 6
module_mm = 20.0
profile_shift = 0.4
addendum = 0.8
face_width_mm = 20.0
[blank]
kind = "thin-rim"
bore_diameter_mm = 16.0
hub_diameter_mm = 24.0
rim_inner_diameter_mm = 60.0
web_thickness_mm = 6.0
[blank.holes]
count = 3
pitch_circle_diameter_mm = 42.0
diameter_mm = 8.0
phase_deg = 0.0
[material]
young_GPa = 210.0
poisson = 0.3
density_kg_per_m3 = 7850.0
[microgeometry]
lead_crowning_um = 5.0
[[gauge]]
name = "root"
tooth = 0
side = "right"
tangent_deg = 30.0
length_mm = 1.0
width_mm = 2.0
"#;

/// The same teeth on a body that does not repeat, C_hub by two patterns a tooth.
pub fn small_patterned_gear() -> ReducedGear {
    let gear = small_reduced_gear();
    let loads = gear.flanks.len() * gear.grid.len();
    let (count, all) = (2, 2 * gear.teeth);
    let apart = |k: usize| (k / loads).abs_diff(k % loads) as f64;
    ReducedGear {
        sectors: 1,
        c_hub: Vec::new(),
        hub_patterns: Some(HubPatterns {
            count,
            own_tooth: (0..loads * loads)
                .map(|k| 1e-9 * (-apart(k)).exp())
                .collect(),
            shares: (0..loads * count).map(|k| 0.3 * (k as f64).cos()).collect(),
            body: Arc::new(
                (0..all * (all + 1) / 2)
                    .map(|k| 1e-10 * (1.0 + k as f64))
                    .collect(),
            ),
        }),
        ..gear
    }
}

/// Six teeth in three sectors, three by three loads on both hands, symmetric compliance that decays with distance.
pub fn small_reduced_gear() -> ReducedGear {
    let (teeth, sectors) = (6, 3);
    let own = teeth / sectors;
    let flanks = vec![Flank::Right, Flank::Left];
    let grid = FlankGrid {
        roll_angles_rad: vec![0.2, 0.35, 0.5],
        z_m: vec![-0.01, 0.0, 0.01],
        slices: 1,
    };
    let loads = grid.len();
    let c_hub = decaying_compliance(teeth, own, loads);
    let pair = |i: usize| (i / loads % loads, i % loads);
    let c_tooth = (0..2 * loads * loads)
        .map(|i| 2e-10 * (-(pair(i).0 as f64 - pair(i).1 as f64).abs()).exp())
        .collect();
    let gauge = |name: &str, tooth: usize, side: Flank| GaugeRows {
        name: name.to_owned(),
        tooth,
        side,
        description: format!("made up, {side} side of tooth {tooth}"),
        error_estimate_relative: 0.01,
        adjoint: (0..teeth * 2 * loads * 3)
            .map(|i| 1e-9 * (i as f64).sin())
            .collect(),
        own_tooth: (0..2 * loads).map(|i| 1e-10 * (i as f64).cos()).collect(),
    };
    ReducedGear {
        name: "synthetic".to_owned(),
        input: StoredGear::of_older_file(SYNTHETIC_TEXT.to_owned()),
        teeth,
        sectors,
        base_radius_m: 0.07,
        face_width_m: 0.02,
        young_pa: 210e9,
        poisson: 0.3,
        grid,
        flanks,
        c_hub,
        c_tooth,
        opposite_distance_m: vec![0.004, 0.003, 0.002, 0.0041, 0.0031, 0.0021],
        near_field: Some(near_field()),
        gauges: vec![
            gauge("root", 0, Flank::Right),
            gauge("opposite", 3, Flank::Left),
        ],
        rigid_body: Some(RigidBody {
            reference_m: [0.0; 3],
            mass_kg: 1.5,
            centre_m: [0.0, 0.0, 0.001],
            inertia_kg_m2: [[2e-3, 0.0, 0.0], [0.0, 2e-3, 0.0], [0.0, 0.0, 3.8e-3]],
        }),
        reference_point: Some(ReferencePoint {
            place_m: [0.0; 3],
            flank: (0..teeth * 2 * loads * 3 * 6)
                .map(|i| (0.1 * i as f64).cos())
                .collect(),
        }),
        modes: Some(ModalBasis {
            omega_squared: vec![4e7, 9e7],
            nodal_diameters: vec![1, 0],
            complete_to_hz: 2000.0,
            flank: (0..2 * teeth * 2 * loads * 3)
                .map(|i| 0.02 * (0.3 * i as f64).sin())
                .collect(),
            gauges: vec![0.1, -0.2, 0.3, 0.05],
            coupling: (0..12).map(|i| 0.01 * f64::from(i)).collect(),
        }),
        crack: None,
        hub_patterns: None,
        shaft_faces: None,
        bore: None,
        bevel: None,
        provenance: provenance(),
        checks: ReductionChecks {
            symmetry: 1e-16,
            pattern_identity: 2e-12,
            further: vec![("residual".to_owned(), 3e-13)],
        },
    }
}

/// Symmetric in its two triples by construction: (tooth, flank, load). Teeth of even number are stiffer, as those over
/// a spoke are.
fn decaying_compliance(teeth: usize, own: usize, loads: usize) -> Vec<f64> {
    let compliance = |a: (usize, usize, usize), b: (usize, usize, usize)| {
        let around = (a.0 + teeth - b.0) % teeth;
        let apart = around.min(teeth - around) as f64;
        let weight = |t: (usize, usize, usize)| 1.0 + 0.3 * (t.0 % own) as f64 + 0.1 * t.2 as f64;
        let same_side = if a.1 == b.1 { 1.0 } else { -0.4 };
        1e-9 * same_side
            * weight(a)
            * weight(b)
            * (-apart - 0.2 * (a.2 as f64 - b.2 as f64).abs()).exp()
    };
    let mut c_hub = Vec::new();
    for load_tooth in 0..own {
        for load_flank in 0..2 {
            for response_tooth in 0..teeth {
                for response_flank in 0..2 {
                    for l in 0..loads {
                        let load = (load_tooth, load_flank, l);
                        c_hub.extend(
                            (0..loads)
                                .map(|m| compliance(load, (response_tooth, response_flank, m))),
                        );
                    }
                }
            }
        }
    }
    c_hub
}

fn near_field() -> NearField {
    NearField {
        half_width_m: 1e-4,
        roll_angles_rad: vec![0.2, 0.3, 0.4, 0.5],
        contact_m2_per_n: vec![1.4e-11, 1.2e-11, 1.3e-11, 2.0e-11],
        mesh_m2_per_n: (0..18)
            .map(|i| {
                let (a, b) = (f64::from(i / 3 % 3), f64::from(i % 3));
                9e-12 * (-(a - b).abs()).exp()
            })
            .collect(),
        element_m: 1.25e-5,
        residual: 2e-3,
    }
}

fn provenance() -> Provenance {
    Provenance {
        program: "gearmesh".to_owned(),
        version: "0.0.0".to_owned(),
        created_utc: "2000-01-01T00:00:00Z".to_owned(),
        threads: 2,
        element: "none".to_owned(),
        nodes: 12,
        elements: 2,
        dofs: 24,
        stage_seconds: vec![("mesh".to_owned(), 0.5), ("assemble".to_owned(), 0.25)],
        effort: vec![("factorisations".to_owned(), 1.0)],
    }
}

/// The same as [`small_reduced_gear`] with motions of its bore.
pub fn small_bored_gear() -> ReducedGear {
    let gear = small_reduced_gear();
    let numbers = |count: usize, scale: f64| -> Vec<f64> {
        (0..count).map(|i| scale * (0.7 * i as f64).sin()).collect()
    };
    let mut bore = BorePatterns {
        harmonics: 1,
        along: 2,
        components: 3,
        radius_m: 8e-3,
        ends_m: [-0.5 * gear.face_width_m, 0.5 * gear.face_width_m],
        ..BorePatterns::default()
    };
    let motions = bore.count();
    let loads = gear.teeth_per_sector() * gear.flanks.len() * gear.grid.len();
    bore.stiffness = (0..motions * motions)
        .map(|i| 1e8 / (1.0 + (i / motions).abs_diff(i % motions) as f64))
        .collect();
    bore.flank = numbers(loads * motions, 0.5);
    bore.gauges = numbers(gear.gauges.len() * motions, 0.1);
    ReducedGear {
        bore: Some(bore),
        ..gear
    }
}

/// The same as [`small_reduced_gear`], cut into a shaft that goes on at both faces.
pub fn small_two_faced_gear() -> ReducedGear {
    let gear = small_reduced_gear();
    let numbers = |count: usize, scale: f64| -> Vec<f64> {
        (0..count).map(|i| scale * (0.3 * i as f64).cos()).collect()
    };
    let modes = gear.modes.as_ref().map_or(0, ModalBasis::count);
    let spread = |scale: f64| -> Vec<f64> {
        let entry = |i: usize| if i / 6 == i % 6 { scale } else { 0.0 };
        (0..36).map(entry).collect()
    };
    ReducedGear {
        shaft_faces: Some(ShaftFaces {
            front_m: [0.0, 0.0, 0.5 * gear.face_width_m],
            stiffness: spread(1e8),
            flank: numbers(
                6 * 3 * gear.teeth * gear.flanks.len() * gear.grid.len(),
                0.5,
            ),
            gauges: numbers(6 * gear.gauges.len(), 0.1),
            mass: Some(FaceMass {
                mass: spread(0.05),
                coupling: numbers(36, 0.01),
                modes: numbers(6 * modes, 0.02),
            }),
        }),
        ..gear
    }
}

/// The gear of a bevel pair with 20 teeth, three by five loads on both hands: points on cones, compliance that decays
/// with distance.
pub fn small_bevel_gear() -> ReducedGear {
    let teeth = 20;
    let grid = FlankGrid {
        roll_angles_rad: vec![0.0, 0.5, 1.0],
        z_m: (0..5)
            .map(|j| 0.015 * (0.25 * f64::from(j) - 0.5))
            .collect(),
        slices: 2,
    };
    let loads = grid.len();
    let flanks = vec![Flank::Right, Flank::Left];
    // Symmetric in (tooth, flank, load): by distance round the gear and between loads only.
    let compliance = |around: usize, other_side: bool, a: usize, b: usize| {
        let side = if other_side { -0.4 } else { 1.0 };
        let apart = around.min(teeth - around) as f64 + 0.2 * (a as f64 - b as f64).abs();
        2e-9 * side * (-apart).exp()
    };
    let mut c_hub = Vec::new();
    for load_flank in 0..2 {
        for block in 0..teeth * 2 {
            for l in 0..loads {
                let other = block % 2 != load_flank;
                c_hub.extend((0..loads).map(|m| compliance(block / 2, other, l, m)));
            }
        }
    }
    let (points_m, normals) = on_cones(&grid);
    let stations = grid.roll_angles_rad.len();
    ReducedGear {
        name: "synthetic bevel gear".to_owned(),
        input: StoredGear::without_definition("# made up\n".to_owned()),
        teeth,
        sectors: teeth,
        base_radius_m: 0.028,
        face_width_m: 0.015,
        opposite_distance_m: vec![0.004; 2 * stations],
        c_hub,
        c_tooth: (0..2 * loads * loads)
            .map(|i| {
                let apart = (i / loads % loads).abs_diff(i % loads) as f64;
                4e-10 * (-apart).exp()
            })
            .collect(),
        near_field: None,
        gauges: Vec::new(),
        reference_point: None,
        modes: None,
        bevel: Some(BevelBody {
            pair_text: "# made up\n".to_owned(),
            member: BevelMember::Gear,
            hand: SpiralHand::Left,
            pitch_angle_rad: std::f64::consts::FRAC_PI_4,
            cones_m: [0.0345, 0.0495],
            points_m,
            normals,
            areas_m2: vec![9e-5; 2 * loads],
            near_field: Some(BevelNearField {
                half_width_m: 1e-4,
                sections_m: vec![-0.005, 0.005],
                profile: vec![0.0, 0.4, 0.8, 1.0],
                profile_length_m: vec![5e-3, 6e-3, 5e-3, 6e-3],
                contact_m2_per_n: [1.4e-11, 1.2e-11, 1.3e-11, 2.0e-11].repeat(4),
                mesh_m2_per_n: (0..4 * stations * stations)
                    .map(|i| {
                        let apart = (i / stations % stations).abs_diff(i % stations) as f64;
                        9e-12 * (-apart).exp()
                    })
                    .collect(),
                opposite_distance_m: vec![0.004; 4 * stations],
                element_m: 1.25e-5,
                residual: 2e-3,
            }),
        }),
        grid,
        flanks,
        ..small_reduced_gear()
    }
}

/// Points on cones, with normals that face both ways round.
fn on_cones(grid: &FlankGrid) -> (Vec<f64>, Vec<f64>) {
    let (mut points_m, mut normals) = (Vec::new(), Vec::new());
    for facing in [-1.0, 1.0] {
        for u in &grid.roll_angles_rad {
            for along in &grid.z_m {
                let [cone, height] = [0.042 + along, 0.005 * (u - 0.5)];
                let radius = (cone + height) * 0.5_f64.sqrt();
                let turn = facing * 0.06 - 10.0 * along;
                let (sin, cos) = turn.sin_cos();
                points_m.extend([radius * cos, radius * sin, (cone - height) * 0.5_f64.sqrt()]);
                normals.extend([facing * sin, -facing * cos, 0.0]);
            }
        }
    }
    (points_m, normals)
}

/// A crack in tooth 4 of [`small_reduced_gear`], two rows.
pub fn small_crack() -> RootCrack {
    RootCrack {
        tooth: 4,
        side: Flank::Right,
        mouth_radius_m: 0.066,
        depth_m: 1.5e-3,
        angle_rad: 1.0,
        rows: (0..2 * 6 * 9)
            .map(|i| 1e-5 * (0.7 * f64::from(i)).sin())
            .collect(),
        left_out: 3e-11,
    }
}

/// Two bricks side by side in x with a node set and a field.
pub fn block_mesh() -> MeshData {
    let index = |i: u32, j: u32, k: u32| i + 3 * (j + 2 * k);
    let mut points = Vec::new();
    for k in 0..2 {
        for j in 0..2 {
            for i in 0..3 {
                points.push([
                    0.001 * f64::from(i) / 3.0,
                    0.002 * f64::from(j),
                    0.1 + 0.003 * f64::from(k),
                ]);
            }
        }
    }
    let hex = |i: u32| {
        let ring = |k| {
            [
                index(i, 0, k),
                index(i + 1, 0, k),
                index(i + 1, 1, k),
                index(i, 1, k),
            ]
        };
        let ([a, b, c, d], [e, f, g, h]) = (ring(0), ring(1));
        [a, b, c, d, e, f, g, h]
    };
    let displacement = (0..36).map(|i| 1e-6 * f64::from(i).sqrt()).collect();
    let field = Field {
        components: 3,
        values: displacement,
        unit: "m".to_owned(),
    };
    MeshData {
        points,
        cells: BTreeMap::from([(CellKind::Hex8, [hex(0), hex(1)].concat())]),
        point_sets: BTreeMap::from([("bore".to_owned(), vec![0, 3, 6, 9])]),
        point_fields: BTreeMap::from([("displacement".to_owned(), field)]),
        cell_fields: BTreeMap::new(),
    }
}
