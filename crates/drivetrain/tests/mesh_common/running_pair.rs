//! A pair like pair A of seed 004 at 600 rpm between bearings that let both gears move in all six directions.

use gearmesh_contact::LocalContact;
use gearmesh_drivetrain::*;
use gearmesh_dynamics::elements::{AppliedLoad, Axes, LinearBearing, LoadKind};
use gearmesh_dynamics::{Marker, MarkerPair, Params, SystemBuilder, TimeFunction};
use gearmesh_geometry::definition::ToothDefinition;
use gearmesh_geometry::microgeometry::ProfileCrowning;
use gearmesh_geometry::{Flank, GearPair, Microgeometry, Misalignment, ToothGeometry};
use gearmesh_model::{GaugeRows, NearField, ReducedGear};
use std::f64::consts::TAU;
use std::sync::Arc;

use super::{SLICES, WIDTH, angles, disc, layout, made_up_gear};

/// Speed of gear 1 \[rad/s\].
pub const SPEED: f64 = TAU * 10.0;
/// Steps of one mesh period.
pub const STEPS_A_PERIOD: usize = 50;
/// Step of 50 to a mesh period of 57 teeth \[s\].
pub const STEP_S: f64 = TAU / SPEED / 57.0 / STEPS_A_PERIOD as f64;
/// Torque on gear 2 \[N·m\].
const TORQUE: f64 = 200.0;

/// Defaults: Newton's iteration adds at most a tenth to the error of the step.
pub fn params() -> Params {
    Params::fixed(STEP_S)
}

/// 57/57 teeth, module 2.6 mm, centre distance 150 mm.
pub fn pair_a() -> GearPair {
    let gear = || {
        ToothGeometry::new(&ToothDefinition {
            module_m: 2.6e-3,
            rack_tip_radius: 0.38,
            thickness_allowance_m: 0.0,
            ..super::pair_common::tooth(57, 0.33, 0.0)
        })
        .unwrap()
    };
    GearPair::new(gear(), gear(), 0.150, Misalignment::default()).unwrap()
}

/// 25/30 teeth, module 2 mm, centre distance 55 mm: the pair of seed 002.
pub fn pair_of_seed_002() -> GearPair {
    let gear = |teeth| {
        ToothGeometry::new(&ToothDefinition {
            module_m: 2e-3,
            ..super::pair_common::tooth(teeth, 0.0, 0.0)
        })
        .unwrap()
    };
    GearPair::new(gear(25), gear(30), 0.055, Misalignment::default()).unwrap()
}

/// 55/55 teeth with a helix of 15 degrees, about as large.
pub fn helical_pair_a() -> GearPair {
    let gear = |helix_deg: f64| {
        ToothGeometry::new(&ToothDefinition {
            module_m: 2.6e-3,
            rack_tip_radius: 0.38,
            helix_angle_rad: helix_deg.to_radians(),
            ..super::pair_common::tooth(55, 0.33, 0.0)
        })
        .unwrap()
    };
    let (gear_1, gear_2) = (gear(15.0), gear(-15.0));
    let centre = 2.0 * gear_1.reference_radius_m + 0.66 * 2.6e-3;
    GearPair::new(gear_1, gear_2, centre, Misalignment::default()).unwrap()
}

fn crowned(gear: &ToothGeometry) -> Arc<dyn FlankError> {
    Arc::new(Microgeometry {
        tip_roll_rad: gear.tip_roll_rad,
        face_width_m: WIDTH,
        profile_crowning: Some(ProfileCrowning {
            amount_m: 10e-6,
            centre_roll_rad: 0.5 * (gear.tip_roll_rad + gear.form_roll_rad),
        }),
        ..Microgeometry::default()
    })
}

/// Names of the gauges of [`calibrated_gear`].
pub const GAUGES: [&str; 8] = ["g0", "g1", "g2", "g3", "g4", "g5", "g6", "g7"];

/// The made-up gear with a near field of the usual size, so that the default local contact can be used, and gauges.
pub fn calibrated_gear(tooth: &ToothGeometry) -> ReducedGear {
    let gear = made_up_gear(tooth);
    let stations = gear.grid.roll_angles_rad.len();
    let places = 12;
    let (low, high) = (tooth.form_roll_rad, tooth.flank_end_roll_rad);
    let mesh = |i: usize| {
        let (a, b) = ((i / stations % stations) as f64, (i % stations) as f64);
        9e-12 * (-0.1 * (a - b).abs()).exp()
    };
    let loads = gear.grid.len();
    let gauge = |number: usize| GaugeRows {
        name: GAUGES[number].to_owned(),
        tooth: number,
        side: Flank::Right,
        description: "made up".to_owned(),
        error_estimate_relative: 0.01,
        adjoint: (0..gear.teeth * 2 * loads * 3)
            .map(|i| 1e-9 * (0.1 * (i + number) as f64).sin())
            .collect(),
        own_tooth: (0..2 * loads)
            .map(|i| 1e-10 * (0.2 * (i + number) as f64).cos())
            .collect(),
    };
    ReducedGear {
        gauges: (0..GAUGES.len()).map(gauge).collect(),
        near_field: Some(NearField {
            half_width_m: 1e-4,
            roll_angles_rad: (0..places)
                .map(|k| low + (high - low) * k as f64 / (places - 1) as f64)
                .collect(),
            contact_m2_per_n: (0..places).map(|k| 1.4e-11 + 1e-13 * k as f64).collect(),
            mesh_m2_per_n: (0..2 * stations * stations).map(mesh).collect(),
            element_m: 1e-5,
            residual: 1e-3,
        }),
        ..gear
    }
}

/// The teeth of one side: `hybrid` with damping proportional to stiffness, or `impact`, which has its own and one
/// plane.
fn teeth(name: &str, pair: &GearPair, side: Flank) -> Box<dyn TeethModel> {
    if name == "impact" {
        let law = PowerStiffness::n_per_mm_e(4e6, 1.5).unwrap();
        return Box::new(Impact::new(law, 2e3, 5e-6, 1).unwrap());
    }
    let models = [&pair.gear_1, &pair.gear_2].map(calibrated_gear);
    let local = LocalContact::Calibrated;
    let teeth = ReducedTeeth::new(pair, side, [&models[0], &models[1]], local, 3000.0).unwrap();
    let damping = Damping::StiffnessProportional {
        time_s: 3e-6,
        full_depth_m: 1e-6,
    };
    Box::new(Damped::new(teeth, damping, SLICES).unwrap())
}

/// The mesh of the pair with both sides of the teeth.
pub fn running_mesh(name: &str, pair: &GearPair) -> GearMesh {
    let gears = [pair.gear_1.clone(), pair.gear_2.clone()];
    let planes = match name {
        "impact" => layout(1),
        _ => layout(SLICES),
    };
    let errors = [vec![crowned(&pair.gear_1)], Vec::new()];
    let kinematics = MeshKinematics::new(
        gears,
        errors,
        pair.centre_distance_m,
        planes,
        PathEnds::Extended,
    )
    .unwrap();
    GearMesh::new(kinematics, Flank::Right, teeth(name, pair, Flank::Right))
        .unwrap()
        .with_side(Flank::Left, teeth(name, pair, Flank::Left))
        .unwrap()
}

/// The system; gear 1 drives with the torque that gear 2 is braked with, over the ratio. So many gauges are read on
/// gear 2.
pub fn running_pair(pair: &GearPair, mesh: GearMesh, gauges: usize) -> SystemBuilder {
    let ratio = pair.gear_1.base_radius_m / pair.gear_2.base_radius_m;
    let phi = angles(pair, Flank::Right, 0.0, -12e-6);
    let mut builder = gearmesh_dynamics::System::builder();
    let bearing = LinearBearing {
        radial_stiffness_n_per_m: 2e8,
        axial_stiffness_n_per_m: 1e8,
        tilt_stiffness_nm_per_rad: 1e5,
        radial_damping_n_s_per_m: 2e3,
        axial_damping_n_s_per_m: 1e3,
        tilt_damping_nm_s_per_rad: 1.0,
        ..LinearBearing::default()
    };
    let sides = [
        (0, &pair.gear_1, -SPEED, ratio * TORQUE),
        (1, &pair.gear_2, ratio * SPEED, TORQUE),
    ];
    let markers = sides.map(|(i, gear, speed, torque)| {
        let name = format!("gear {}", i + 1);
        let x = pair.centre_distance_m * i as f64;
        let id = builder
            .body(disc(&name, gear, WIDTH, (x, phi[i], speed)))
            .unwrap();
        let marker = Marker::at(id, [0.0; 3]);
        let place = MarkerPair {
            a: Marker::ground([x, 0.0, 0.0]),
            b: marker,
        };
        let name = format!("bearing {}", i + 1);
        builder.element(bearing.between(&name, place).unwrap());
        let axis = (Axes::World, [0.0, 0.0, 1.0]);
        let load = TimeFunction::Constant(-torque);
        let name = format!("torque {}", i + 1);
        builder.element(AppliedLoad::new(&name, id, LoadKind::Torque, axis, load).unwrap());
        marker
    });
    let model = calibrated_gear(&pair.gear_2);
    let names = &GAUGES[..gauges];
    let mesh = MeshElement::new("mesh", markers, mesh)
        .with_gauges(2, &model, names, ModalPart::Included)
        .unwrap();
    builder.element(mesh);
    builder
}
