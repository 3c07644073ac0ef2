//! One static position, torque given, warm: two pairs of five slices on spur teeth, three of twelve on helical ones.
//! The limits are 20 and 100 microseconds.
#![allow(clippy::unwrap_used, missing_docs)]

use gearmesh_contact::Drive;
use gearmesh_contact::{ContactLines, ContactOptions, LocalContact, StaticContact};
use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{GearDefinition, GearPair, Misalignment, ToothDefinition, ToothGeometry};
use gearmesh_model::{Flank, FlankGrid, ReducedGear, StoredGear};

fn main() {
    divan::main();
}

fn gear(name: &str) -> GearDefinition {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../fe_models")
        .join(name);
    GearDefinition::from_document(&InputDocument::read(&path).unwrap()).unwrap()
}

/// A model of realistic size with a made-up compliance: positive definite, falling with the distance between loads.
/// The time of a position depends on sizes and on the number of iterations, not on what the numbers mean.
fn model(gear: &GearDefinition, profile: &ToothGeometry, slices: usize) -> ReducedGear {
    let (first, last) = (profile.form_roll_rad, profile.tip_roll_rad);
    let b = gear.tooth.face_width_m;
    let axial = 2 * slices + 1;
    let grid = FlankGrid {
        roll_angles_rad: (0..9)
            .map(|i| first + (last - first) * f64::from(i) / 8.0)
            .collect(),
        z_m: (0..axial)
            .map(|j| b * (j as f64 / (axial - 1) as f64 - 0.5))
            .collect(),
        slices,
    };
    let (teeth, n) = (gear.tooth.teeth, grid.len());
    let mut c_hub = Vec::with_capacity(teeth * n * n);
    for tooth in 0..teeth {
        let apart = tooth.min(teeth - tooth) as f64;
        for l in 0..n {
            for m in 0..n {
                let (di, dj) = (
                    (l / axial).abs_diff(m / axial) as f64,
                    (l % axial).abs_diff(m % axial) as f64,
                );
                let own = if tooth == 0 {
                    3e-9 * (-0.3 * dj - 0.2 * di).exp()
                } else {
                    0.0
                };
                c_hub.push(1e-9 * (-apart).exp() + own);
            }
        }
    }
    ReducedGear {
        name: gear.name.clone(),
        input: StoredGear::new(gear.clone()),
        teeth,
        sectors: teeth,
        base_radius_m: profile.base_radius_m,
        face_width_m: b,
        young_pa: gear.material.young_pa,
        poisson: gear.material.poisson,
        opposite_distance_m: vec![4e-3; 9],
        near_field: None,
        rigid_body: None,
        reference_point: None,
        modes: None,
        crack: None,
        hub_patterns: None,
        shaft_faces: None,
        bore: None,
        bevel: None,
        grid,
        flanks: vec![Flank::Right],
        c_hub,
        c_tooth: vec![0.0; n * n],
        gauges: Vec::new(),
        provenance: Default::default(),
        checks: Default::default(),
    }
}

/// Pair A, or teeth like its with a helix, at 0.150 m.
fn contact(helix_deg: f64, slices: usize) -> StaticContact {
    let gears = [gear("gear1.toml"), gear("gear2.toml")];
    let [profile_1, profile_2] =
        [(0, helix_deg), (1, -helix_deg)].map(|(i, helix_deg): (usize, f64)| {
            let definition = ToothDefinition {
                helix_angle_rad: helix_deg.to_radians(),
                module_m: 2.6e-3 * helix_deg.to_radians().cos(),
                ..gears[i].tooth.clone()
            };
            ToothGeometry::new(&definition).unwrap()
        });
    let models = [
        model(&gears[0], &profile_1, slices),
        model(&gears[1], &profile_2, slices),
    ];
    let pair = GearPair::new(profile_1, profile_2, 0.150, Misalignment::default()).unwrap();
    let lines = ContactLines {
        pair,
        microgeometry_1: gears[0].microgeometry.right.clone(),
        microgeometry_2: gears[1].microgeometry.right.clone(),
        extension: None,
        zone: gearmesh_contact::ContactZone::of_equal_faces(gears[0].tooth.face_width_m),
    };
    let options = ContactOptions {
        local: LocalContact::WeberBanaschek,
        friction: None,
    };
    StaticContact::new(lines, &models[0], &models[1], options).unwrap()
}

fn run(bencher: divan::Bencher, mut contact: StaticContact, torque_nm: f64) {
    let step = std::f64::consts::TAU / 57.0 / 400.0;
    let mut position = 0;
    bencher.bench_local(|| {
        position += 1;
        contact
            .solve(step * f64::from(position % 400), Drive::Torque(torque_nm))
            .unwrap()
    });
}

#[divan::bench(args = [50.0, 300.0])]
fn static_position(bencher: divan::Bencher, torque_nm: f64) {
    run(bencher, contact(0.0, 5), torque_nm);
}

#[divan::bench(args = [50.0, 300.0])]
fn helical_static_position(bencher: divan::Bencher, torque_nm: f64) {
    run(bencher, contact(20.0, 12), torque_nm);
}
