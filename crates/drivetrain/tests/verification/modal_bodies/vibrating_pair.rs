//! Pairs of made-up gears that vibrate: their meshes, poses, and scenes in time.

use std::sync::Arc;

use gearmesh_contact::LocalContact;
use gearmesh_drivetrain::*;
use gearmesh_dynamics::elements::{AppliedLoad, Axes, LoadKind};
use gearmesh_dynamics::{Body, Joint, JointKind, Marker, System, SystemBuilder, TimeFunction};
use gearmesh_geometry::microgeometry::{ReliefShape, TipRelief};
use gearmesh_geometry::{Flank, GearPair, Microgeometry, ToothGeometry};
use gearmesh_model::ReducedGear;
use nalgebra::{UnitQuaternion, Vector3};

pub use crate::mesh_common::modal_gear::at_rest;
use crate::mesh_common::modal_gear::{MODES, modal_gear};
use crate::mesh_common::*;

pub const COUNT: usize = MODES.len();

pub fn models(pair: &GearPair) -> [ReducedGear; 2] {
    [
        modal_gear("gear 1", &pair.gear_1),
        modal_gear("gear 2", &pair.gear_2),
    ]
}

/// `hybrid` on both sides, gears `reduced` (no modes) or `modal` with so many modes.
pub fn hybrid(
    pair: &GearPair,
    models: &[ReducedGear; 2],
    modes: [usize; 2],
    kinematics: MeshKinematics,
) -> GearMesh {
    let of = |side| {
        let local = LocalContact::WeberBanaschek;
        ReducedTeeth::new(pair, side, [&models[0], &models[1]], local, 4000.0).unwrap()
    };
    let mut mesh = GearMesh::new(kinematics, Flank::Right, of(Flank::Right))
        .unwrap()
        .with_side(Flank::Left, of(Flank::Left))
        .unwrap();
    for (gear, count) in modes.into_iter().enumerate() {
        if count > 0 {
            mesh = mesh.with_modes(gear + 1, &models[gear], count).unwrap();
        }
    }
    mesh
}

pub fn loaded_poses(pair: &GearPair) -> Vec<Pose> {
    [
        (Flank::Right, 0.02, -9e-6),
        (Flank::Right, 0.11, -14e-6),
        (Flank::Left, 0.19, -11e-6),
    ]
    .map(|(side, theta, te)| {
        let phi = angles(pair, side, theta, te);
        let (shift, tilt) = (
            Vector3::new(2e-6, -1e-6, 1e-4),
            Vector3::new(1e-4, -0.5e-4, 0.0),
        );
        let screwed = [phi[0], phi[1] + screw_rad(pair, shift[2])];
        pose(pair, screwed, shift, tilt)
    })
    .to_vec()
}

pub fn relieved(gear: &ToothGeometry) -> Arc<dyn FlankError> {
    let span = gear.tip_roll_rad - gear.form_roll_rad;
    Arc::new(Microgeometry {
        tip_roll_rad: gear.tip_roll_rad,
        face_width_m: WIDTH,
        tip_relief: Some(TipRelief {
            amount_m: 40e-6,
            start_roll_rad: gear.form_roll_rad + 0.6 * span,
            shape: ReliefShape::Parabolic,
        }),
        ..Microgeometry::default()
    })
}

pub fn relieved_kinematics(pair: &GearPair) -> MeshKinematics {
    let errors = [&pair.gear_1, &pair.gear_2].map(|gear| vec![relieved(gear)]);
    kinematics_with(pair, errors, PathEnds::Extended)
}

/// Two gears on revolute joints, vibrating or not, gear 1 turning clockwise.
pub fn scene(
    pair: &GearPair,
    models: &[ReducedGear; 2],
    modes: [usize; 2],
    mesh: (GearMesh, f64, f64, f64),
) -> (SystemBuilder, [Marker; 2]) {
    scene_with_gauges(pair, models, modes, mesh, &[])
}

/// The same with gauges read on gear 2.
pub fn scene_with_gauges(
    pair: &GearPair,
    models: &[ReducedGear; 2],
    modes: [usize; 2],
    (mesh, speed_1, te_m, damping_ratio): (GearMesh, f64, f64, f64),
    gauges: &[&str],
) -> (SystemBuilder, [Marker; 2]) {
    // Three pitches on: the teeth in mesh lie on no node of any mode.
    let theta = 3.0 * pair.pitch_1_rad();
    let phi = angles(pair, Flank::Right, theta, te_m);
    let ratio = pair.gear_1.base_radius_m / pair.gear_2.base_radius_m;
    let mut builder = System::builder();
    let markers = [0, 1].map(|i| {
        let speed = [-speed_1, speed_1 * ratio][i];
        let x = pair.centre_distance_m * i as f64;
        let gear = match modes[i] {
            0 => gear_body(&models[i]).unwrap(),
            count => modal_gear_body(&models[i], count, damping_ratio).unwrap(),
        };
        let body = Body {
            position_m: Vector3::new(x, 0.0, 0.0),
            orientation: UnitQuaternion::from_scaled_axis(Vector3::new(0.0, 0.0, phi[i])),
            angular_velocity_rad_per_s: Vector3::new(0.0, 0.0, speed),
            ..gear
        };
        let id = builder.body(body).unwrap();
        let marker = Marker::at(id, [0.0; 3]);
        let housing = Marker::ground([x, 0.0, 0.0]);
        let name = format!("bearing {i}");
        builder.joint(Joint::new(&name, JointKind::Revolute, housing, marker).unwrap());
        marker
    });
    let mesh = MeshElement::new("mesh", markers, mesh);
    let mesh = (mesh.with_gauges(2, &models[1], gauges, ModalPart::Included)).unwrap();
    builder.element(mesh);
    (builder, markers)
}

pub fn torque(builder: &mut SystemBuilder, name: &str, on: Marker, value: f64) {
    let axis = (Axes::World, [0.0, 0.0, 1.0]);
    let load = TimeFunction::Constant(value);
    builder.element(AppliedLoad::new(name, on.body, LoadKind::Torque, axis, load).unwrap());
}
