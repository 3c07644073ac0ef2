//! Small made-up objects for the tests of several crates. Not results of any computation.
#![allow(dead_code, missing_docs)]

use std::collections::BTreeMap;

use gearmesh_model::{
    BevelBody, BevelMember, BevelNearField, BorePatterns, CellKind, FaceMass, Field, Flank,
    FlankGrid, GaugeRows, HubPatterns, MeshData, ModalBasis, NearField, Provenance, ReducedGear,
    ReductionChecks, ReferencePoint, RigidBody, RootCrack, ShaftFaces, SpiralHand, StoredGear,
};
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

/// So many numbers, of each by its place.
fn numbers(count: usize, of: impl Fn(usize) -> f64) -> Vec<f64> {
    (0..count).map(of).collect()
}

/// A matrix of n rows and columns, or several, that decays away from its diagonal.
fn decaying(count: usize, n: usize, largest: f64) -> Vec<f64> {
    numbers(count, |k| largest * (-apart(k, n)).exp())
}

/// How far an entry of such matrices is off the diagonal.
fn apart(k: usize, n: usize) -> f64 {
    (k / n % n).abs_diff(k % n) as f64
}

/// The same teeth on a body that does not repeat, C_hub by two patterns a tooth.
pub fn small_patterned_gear() -> ReducedGear {
    let gear = small_reduced_gear();
    let loads = gear.flanks.len() * gear.grid.len();
    let (count, all) = (2, 2 * gear.teeth);
    ReducedGear {
        sectors: 1,
        c_hub: Vec::new(),
        hub_patterns: Some(HubPatterns {
            count,
            own_tooth: decaying(loads * loads, loads, 1e-9),
            shares: numbers(loads * count, |k| 0.3 * (k as f64).cos()),
            body: Arc::new(numbers(all * (all + 1) / 2, |k| 1e-10 * (1.0 + k as f64))),
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
    let c_tooth = decaying(2 * loads * loads, loads, 2e-10);
    let gauge = |name: &str, tooth: usize, side: Flank| GaugeRows {
        name: name.to_owned(),
        tooth,
        side,
        description: format!("made up, {side} side of tooth {tooth}"),
        error_estimate_relative: 0.01,
        adjoint: numbers(teeth * 2 * loads * 3, |i| 1e-9 * (i as f64).sin()),
        own_tooth: numbers(2 * loads, |i| 1e-10 * (i as f64).cos()),
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
            flank: numbers(teeth * 2 * loads * 3 * 6, |i| (0.1 * i as f64).cos()),
        }),
        modes: Some(ModalBasis {
            omega_squared: vec![4e7, 9e7],
            nodal_diameters: vec![1, 0],
            complete_to_hz: 2000.0,
            flank: numbers(2 * teeth * 2 * loads * 3, |i| 0.02 * (0.3 * i as f64).sin()),
            gauges: vec![0.1, -0.2, 0.3, 0.05],
            coupling: numbers(12, |i| 0.01 * i as f64),
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
        mesh_m2_per_n: decaying(18, 3, 9e-12),
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
    let waving = |count, scale: f64| numbers(count, |i| scale * (0.7 * i as f64).sin());
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
    bore.stiffness = numbers(motions * motions, |i| 1e8 / (1.0 + apart(i, motions)));
    bore.flank = waving(loads * motions, 0.5);
    bore.gauges = waving(gear.gauges.len() * motions, 0.1);
    ReducedGear {
        bore: Some(bore),
        ..gear
    }
}

/// The same as [`small_reduced_gear`], cut into a shaft that goes on at both faces.
pub fn small_two_faced_gear() -> ReducedGear {
    let gear = small_reduced_gear();
    let waving = |count, scale: f64| numbers(count, |i| scale * (0.3 * i as f64).cos());
    let loads = gear.teeth * gear.flanks.len() * gear.grid.len();
    let modes = gear.modes.as_ref().map_or(0, ModalBasis::count);
    let spread = |scale: f64| numbers(36, |i| if i / 6 == i % 6 { scale } else { 0.0 });
    ReducedGear {
        shaft_faces: Some(ShaftFaces {
            front_m: [0.0, 0.0, 0.5 * gear.face_width_m],
            stiffness: spread(1e8),
            flank: waving(6 * 3 * loads, 0.5),
            gauges: waving(6 * gear.gauges.len(), 0.1),
            mass: Some(FaceMass {
                mass: spread(0.05),
                coupling: waving(36, 0.01),
                modes: waving(6 * modes, 0.02),
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
        z_m: numbers(5, |j| 0.015 * (0.25 * j as f64 - 0.5)),
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
        c_tooth: decaying(2 * loads * loads, loads, 4e-10),
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
                mesh_m2_per_n: decaying(4 * stations * stations, stations, 9e-12),
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
        rows: numbers(2 * 6 * 9, |i| 1e-5 * (0.7 * i as f64).sin()),
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
    let field = Field {
        components: 3,
        values: numbers(36, |i| 1e-6 * (i as f64).sqrt()),
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
