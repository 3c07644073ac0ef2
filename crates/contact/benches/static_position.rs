//! One static position: two pairs of five slices, torque given, warm. The limit is 20 microseconds.
#![allow(clippy::unwrap_used, missing_docs)]

use gearmesh_contact::static_contact::Drive;
use gearmesh_contact::{ContactLines, ContactOptions, LocalContact, StaticContact};
use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{GearDefinition, GearPair, Misalignment};
use gearmesh_model::{Flank, FlankGrid, ReducedGear};

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
fn model(gear: &GearDefinition) -> ReducedGear {
    let (first, last) = (gear.profile.form_roll_rad, gear.profile.tip_roll_rad);
    let b = gear.tooth.face_width_m;
    let grid = FlankGrid {
        roll_angles_rad: (0..9)
            .map(|i| first + (last - first) * f64::from(i) / 8.0)
            .collect(),
        z_m: (0..11).map(|j| b * (f64::from(j) / 10.0 - 0.5)).collect(),
        slices: 5,
    };
    let (teeth, n) = (gear.tooth.teeth, grid.len());
    let mut c_hub = Vec::with_capacity(teeth * n * n);
    for tooth in 0..teeth {
        let apart = tooth.min(teeth - tooth) as f64;
        for l in 0..n {
            for m in 0..n {
                let (di, dj) = (
                    (l / 11).abs_diff(m / 11) as f64,
                    (l % 11).abs_diff(m % 11) as f64,
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
        input_toml: gear.source.clone(),
        teeth,
        sectors: teeth,
        base_radius_m: gear.profile.base_radius_m,
        face_width_m: b,
        young_pa: gear.material.young_pa,
        poisson: gear.material.poisson,
        opposite_distance_m: vec![4e-3; 9],
        near_field: None,
        rigid_body: None,
        reference_point: None,
        modes: None,
        crack: None,
        grid,
        flanks: vec![Flank::Right],
        c_hub,
        c_tooth: vec![0.0; n * n],
        gauges: Vec::new(),
        provenance: Default::default(),
        checks: Default::default(),
    }
}

#[divan::bench(args = [50.0, 300.0])]
fn static_position(bencher: divan::Bencher, torque_nm: f64) {
    let (gear_1, gear_2) = (gear("gear1.toml"), gear("gear2.toml"));
    let pair = GearPair::new(
        gear_1.profile.clone(),
        gear_2.profile.clone(),
        0.150,
        Misalignment::default(),
    )
    .unwrap();
    let (model_1, model_2) = (model(&gear_1), model(&gear_2));
    let lines = ContactLines {
        pair,
        microgeometry_1: gear_1.microgeometry,
        microgeometry_2: gear_2.microgeometry,
        extension: None,
        zone: gearmesh_contact::ContactZone::of_equal_faces(gear_1.tooth.face_width_m),
    };
    let options = ContactOptions {
        local: LocalContact::WeberBanaschek,
        friction: None,
    };
    let mut contact = StaticContact::new(lines, &model_1, &model_2, options).unwrap();
    let step = std::f64::consts::TAU / 57.0 / 400.0;
    let mut position = 0;
    bencher.bench_local(|| {
        position += 1;
        contact
            .solve(step * f64::from(position % 400), Drive::Torque(torque_nm))
            .unwrap()
    });
}
