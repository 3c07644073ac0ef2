//! A gear cut into its shaft whose core is a uniform beam: the same as a gear on the middle of a shaft that goes on
//! through it. The one comes as stiffness between two faces and motions of the flanks, the other as beams with a rigid
//! gear's frame between them.

use std::path::Path;

use gearmesh_dynamics::elements::BeamSection;
use gearmesh_geometry::ToothGeometry;
use gearmesh_model::{
    FaceMass, ReducedGear, ShaftFaces, StoredGear, read_reduced_gear, write_reduced_gear,
};
use gearmesh_scene::system_run::{RunJob, SystemResult};
use nalgebra::{Matrix6, Vector3, Vector6};

use crate::common::load;
use crate::made_up_gears::mesh_common::made_up_gear;
use crate::made_up_gears::{gear_file, pair, write_models};
use crate::system_runs::Desk;

const HALF_M: f64 = 10e-3;
const CORE_MM: f64 = 24.0;

/// The motion of a point h further along z by that of a point.
fn transfer(h: f64) -> Matrix6<f64> {
    let mut x = Matrix6::identity();
    (x[(0, 4)], x[(1, 3)]) = (h, -h);
    x
}

/// Centre of each station's hat; `weight`: what it is spread over.
fn centres(stations: &[f64], weight: impl Fn(f64) -> f64) -> Vec<f64> {
    let last = stations.len() - 1;
    let hat = |k: usize, x: f64| {
        let (low, high) = (stations[k.saturating_sub(1)], stations[(k + 1).min(last)]);
        let side = if x < stations[k] { low } else { high };
        if side == stations[k] {
            0.0
        } else {
            (1.0 - (x - stations[k]) / (side - stations[k])).max(0.0)
        }
    };
    let points = 4000;
    let at = |i: i32| {
        stations[0] + (stations[last] - stations[0]) * (f64::from(i) + 0.5) / f64::from(points)
    };
    (0..=last)
        .map(|k| {
            let sums = (0..points).fold([0.0; 2], |[a, b], i| {
                let share = hat(k, at(i)) * weight(at(i));
                [a + share * at(i), b + share]
            });
            sums[0] / sums[1]
        })
        .collect()
}

/// Force and moment about mid-face of a unit normal force on the flank.
fn wrench(tooth: &ToothGeometry, number: usize, side: f64, xi: f64, z: f64) -> Vector6<f64> {
    let middle = std::f64::consts::TAU * number as f64 / tooth.teeth as f64;
    let beta = middle - side * (tooth.base_half_angle_rad - xi);
    let (sin, cos) = beta.sin_cos();
    let normal = side * Vector3::new(-sin, cos, 0.0);
    let radius = tooth.base_radius_m;
    let place = radius * Vector3::new(cos, sin, 0.0) - radius * xi * normal + z * Vector3::z();
    let moment = place.cross(&normal);
    Vector6::new(normal.x, normal.y, normal.z, moment.x, moment.y, moment.z)
}

/// The made-up pinion on a core of two beams, both faces held, as a reduction would give it.
fn on_a_beam(gear: ReducedGear, tooth: &ToothGeometry) -> ReducedGear {
    let section = BeamSection::round(0.5e-3 * CORE_MM, 0.0, 210e9, 0.3);
    let (half, x) = (section.tip_stiffness(HALF_M), transfer(HALF_M));
    let middle = half + x.tr_mul(&(half * x));
    let soft = middle.try_inverse().unwrap();
    let of_front = soft * x.tr_mul(&half);
    let rolls = centres(&gear.grid.roll_angles_rad, |xi| xi);
    let heights = centres(&gear.grid.z_m, |_| 1.0);
    let mut rows = Vec::new();
    for number in 0..gear.teeth {
        for side in [1.0, -1.0] {
            for xi in &rolls {
                rows.extend(heights.iter().map(|z| wrench(tooth, number, side, *xi, *z)));
            }
        }
    }
    let loads = gear.grid.len();
    let mut c_hub = gear.c_hub.clone();
    let mut entries = c_hub.iter_mut();
    for from in rows[..2 * loads].chunks(loads) {
        for to in rows.chunks(loads) {
            for a in from {
                for b in to {
                    *entries.next().unwrap() += a.dot(&(soft * b));
                }
            }
        }
    }
    let stiffness = half - half * x * soft * x.tr_mul(&half);
    let stiffness = 0.5 * (stiffness + stiffness.transpose());
    let flank = rows.iter().flat_map(|row| {
        let moved = of_front.tr_mul(row);
        moved.iter().copied().chain([0.0; 12]).collect::<Vec<f64>>()
    });
    ReducedGear {
        shaft_faces: Some(ShaftFaces {
            front_m: [0.0, 0.0, HALF_M],
            stiffness: stiffness.iter().copied().collect(),
            flank: flank.collect(),
            gauges: Vec::new(),
            mass: Some(FaceMass {
                mass: Matrix6::from_diagonal(&Vector6::new(0.05, 0.05, 0.05, 1e-5, 1e-5, 1e-5))
                    .iter()
                    .copied()
                    .collect(),
                coupling: vec![0.0; 36],
                modes: Vec::new(),
            }),
        }),
        c_hub,
        ..gear
    }
}

/// `ends`: stations of the bearings at lower and higher z.
fn scene(of_shaft: &str, station: usize, [left, right]: [usize; 2]) -> String {
    format!(
        r#"title = "pinion shaft"
[run]
kind = "static"
[[body]]
name = "pinion"
gear = "pinion.h5"
cardan_deg = [0.0, 0.0, 5.0]
[[body]]
name = "wheel"
gear = "gear_41.h5"
position_mm = [106.8, 0.0, 0.0]
[[shaft]]
name = "bar"
model = {{ kind = "beam", young_GPa = 210.0, poisson = 0.3 }}
origin_mm = [0.0, 0.0, 0.0]
{of_shaft}
density_kg_per_m3 = 7850.0
[[shaft.seat]]
station = {station}
body = "pinion"
[[bearing]]
name = "left"
body_2 = "bar/{left}"
model = {{ kind = "linear", radial_stiffness_N_per_mm = 2e5 }}
[[bearing]]
name = "right"
body_2 = "bar/{right}"
model = {{ kind = "linear", radial_stiffness_N_per_mm = 3e5, axial_stiffness_N_per_mm = 1e5 }}
[[joint]]
name = "axle"
kind = "revolute"
body_2 = "wheel"
[[torsion_spring]]
name = "brake"
body_2 = "bar/{right}"
stiffness_Nm_per_rad = 1e6
[[load]]
body = "wheel"
torque_Nm = 400.0
[[gear_mesh]]
name = "mesh"
gear_1 = "pinion"
gear_2 = "wheel"
model = {{ kind = "hybrid", local = "weber-banaschek" }}
teeth = {{ path = "line-of-action" }}
"#
    )
}

const CUT: &str = "stations_mm = [-50.0, 0.0, 60.0]\nouter_diameters_mm = [20.0, 22.0]";
const AGAINST: &str =
    "axis = [0.0, 0.0, -1.0]\nstations_mm = [-60.0, 0.0, 50.0]\nouter_diameters_mm = [22.0, 20.0]";
const THROUGH: &str =
    "stations_mm = [-50.0, -10.0, 0.0, 10.0, 60.0]\nouter_diameters_mm = [20.0, 24.0, 24.0, 22.0]";

/// A gear file whose shaft goes on at these diameters of back and front face.
fn cut_file(ends: &str) -> String {
    let bore = "bore_diameter_mm = 30.0";
    let cut = format!("bore_diameter_mm = 0\nshaft_diameter_mm = {ends}");
    let text = gear_file(30, 0.2);
    assert!(text.contains(bore));
    text.replace(bore, &cut)
}

fn result(scene: &str, pinion: &ReducedGear, folder: &Path) -> SystemResult {
    write_reduced_gear(&folder.join("pinion.h5"), pinion).unwrap();
    let desk = Desk::new();
    desk.run(RunJob::from_scene(load(scene, folder).unwrap()).unwrap())
}

fn last(result: &SystemResult, column: &str) -> f64 {
    *result.rows.read(column).unwrap().last().unwrap()
}

#[test]
fn a_core_that_is_a_beam_carries_as_the_shaft_going_through() {
    let folder = tempfile::tempdir().unwrap();
    write_models(folder.path());
    let tooth = pair().gear_1;
    let plain = ReducedGear {
        near_field: None,
        rigid_body: read_reduced_gear(&folder.path().join("gear_30.h5"))
            .unwrap()
            .rigid_body,
        input: StoredGear::of_older_file(gear_file(30, 0.2)),
        ..made_up_gear(&tooth)
    };
    let cut = on_a_beam(
        ReducedGear {
            input: StoredGear::of_older_file(cut_file("[20, 22]")),
            ..plain.clone()
        },
        &tooth,
    );
    let through = result(&scene(THROUGH, 2, [0, 4]), &plain, folder.path());
    // The shaft along the gear's z, and against it: other ends of the beams stand on the front face.
    let ways = [scene(CUT, 1, [0, 2]), scene(AGAINST, 1, [2, 0])];
    let line_loads = |r: &SystemResult| {
        [1, 2, 3, 4, 5].map(|k| last(r, &format!("elements/mesh/line_load_slice_{k}_N_per_m")))
    };
    let expected = line_loads(&through);
    let most = expected.iter().fold(0.0, |m: f64, x| m.max(*x));
    let least = expected.iter().fold(most, |m: f64, x| m.min(*x));
    assert!(least > 0.0 && most > 1.1 * least, "{expected:?}");
    for text in ways {
        let found = result(&text, &cut, folder.path());
        // In time from there, nothing moves.
        let run = "kind = \"transient\"\nend_s = 1e-3\n[solver]\nstep_s = 1e-5\nstart = \"equilibrium\"\n[output]\ninterval_s = 1e-4";
        let in_time = text.replace("kind = \"static\"", run);
        let in_time = result(&in_time, &cut, folder.path());
        let loads = line_loads(&found);
        for (a, b) in loads.iter().zip(line_loads(&in_time)) {
            assert!((a - b).abs() < 1e-6 * most, "{a} {b}");
        }
        for (a, b) in expected.iter().zip(&loads) {
            assert!((a - b).abs() < 1e-3 * most, "{expected:?} {loads:?}");
        }
        for bearing in ["left", "right"] {
            for axis in ["x", "y"] {
                let column = format!("elements/{bearing}/force_world_{axis}_N");
                let [a, b] = [&through, &found].map(|r| last(r, &column));
                assert!((a - b).abs() < 1e-3 * a.abs(), "{column}: {a} {b}");
            }
        }
    }
}

/// A file that ends the shaft where it goes on, and a model without its faces are refused.
#[test]
fn faces_that_the_model_does_not_know_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    write_models(folder.path());
    let refused = |ends: &str| {
        let model = ReducedGear {
            input: StoredGear::of_older_file(cut_file(ends)),
            near_field: None,
            ..made_up_gear(&pair().gear_1)
        };
        write_reduced_gear(&folder.path().join("pinion.h5"), &model).unwrap();
        let text = scene(CUT, 1, [0, 2]);
        let built = load(&text, folder.path()).and_then(|loaded| loaded.build());
        built.err().unwrap().to_string()
    };
    let one_face = refused("[0, 22]");
    assert!(
        one_face.contains("the shaft goes on at the back face of `pinion`"),
        "{one_face}"
    );
    let old = refused("[20, 22]");
    assert!(old.contains("reduce the gear again"), "{old}");
}
