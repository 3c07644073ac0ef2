//! The bevel pair of seed 001 at 600 rpm on fixed axes, 100 N·m on the gear: the scene dynamics_bevel_20_20_hybrid.toml
//! at constant speed.

use std::f64::consts::TAU;

use gearmesh_bevel::PairFile;
use gearmesh_contact::LocalContact;
use gearmesh_contact::slice_contact::SliceContact;
use gearmesh_drivetrain::*;
use gearmesh_dynamics::elements::{AppliedLoad, Axes, LoadKind};
use gearmesh_dynamics::{
    Body, Joint, JointKind, Marker, Motion, Params, SystemBuilder, TimeFunction,
};
use gearmesh_geometry::Flank;
use gearmesh_model::ReducedGear;
use nalgebra::{Rotation3, UnitQuaternion, Vector3};

use crate::mesh_common::made_up_bevel::made_up_bevel;

/// Speed of the pinion \[rad/s\], teeth and steps of a mesh period.
const SPEED: f64 = TAU * 10.0;
const TEETH: usize = 20;
pub const STEPS_A_PERIOD: usize = 50;
/// \[s\]
pub const STEP_S: f64 = TAU / SPEED / TEETH as f64 / STEPS_A_PERIOD as f64;
const TORQUE_NM: f64 = 100.0;

/// What the teeth are made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Teeth {
    /// The surfaces of rigid gears.
    HalfSpaces,
    /// Made-up reduced members.
    Reduced,
}

pub fn params() -> Params {
    Params::fixed(STEP_S)
}

/// The flanks of the pair in so many slices.
pub fn flanks(slices: usize) -> BevelSlices {
    let file = format!(
        "{}/../../fe_models/bevel_20_20.toml",
        env!("CARGO_MANIFEST_DIR")
    );
    let file = PairFile::read(file.as_ref()).unwrap();
    BevelSlices::new(&file.blank, &file.design().unwrap(), slices).unwrap()
}

fn damped(flanks: &BevelSlices, contact: SliceContact) -> Damped {
    let teeth = ReducedTeeth::of_flanks(contact, 3500.0).unwrap();
    let damping = Damping::StiffnessProportional {
        time_s: 5e-6,
        full_depth_m: 1e-6,
    };
    Damped::new(teeth, damping, flanks.layout().slices).unwrap()
}

fn both_sides(flanks: &BevelSlices, contact: impl Fn(Flank) -> SliceContact) -> GearMesh {
    let of = |side: Flank| damped(flanks, contact(side));
    GearMesh::of_flanks(Box::new(flanks.clone()), Flank::Right, of(Flank::Right))
        .unwrap()
        .with_side(Flank::Left, of(Flank::Left))
        .unwrap()
}

/// The mesh with both sides of the teeth.
pub fn bevel_mesh(kind: Teeth, flanks: &BevelSlices) -> GearMesh {
    match kind {
        Teeth::HalfSpaces => both_sides(flanks, |_| flanks.surface_contact([(206e9, 0.3); 2])),
        Teeth::Reduced => {
            let bodies = [0, 1].map(|member| made_up_bevel(flanks, member));
            reduced_bevel_mesh([&bodies[0], &bodies[1]], flanks)
        }
    }
}

/// The mesh of two reduced members.
pub fn reduced_bevel_mesh(models: [&ReducedGear; 2], flanks: &BevelSlices) -> GearMesh {
    let local = LocalContact::Calibrated;
    both_sides(flanks, |side| {
        flanks.reduced_contact(side, models, local).unwrap()
    })
}

/// Turn of the gear at which the left flanks touch, and in which sense pressing them turns it.
fn start(flanks: &BevelSlices) -> (f64, f64) {
    let (pair, side) = (flanks.pair(), Flank::Left);
    let lever = pair.levers_m()[1] * side.mirror();
    let mut turn = 0.0;
    let mut found = FlankContacts::default();
    for _ in 0..40 {
        let pose = pair.nominal_pose([0.0, turn]);
        pair.contacts_at(&pose, side, &mut found).unwrap();
        turn -= found.lines[0].ideal_gap_m / lever;
    }
    (turn, lever.signum())
}

/// Pinion driven at its speed, gear braked; rigid bodies.
pub fn running_bevel(flanks: &BevelSlices, mesh: GearMesh) -> SystemBuilder {
    let inertia = [0.7e-4, 0.7e-4, 1.1e-4];
    let bodies = ["pinion", "gear"].map(|name| Body::rigid(name, 0.25, inertia));
    running_at(flanks, mesh, bodies, SPEED)
}

/// The same with these bodies at this speed of the pinion \[rad/s\].
pub fn running_at(
    flanks: &BevelSlices,
    mesh: GearMesh,
    [pinion, gear]: [Body; 2],
    speed: f64,
) -> SystemBuilder {
    let (turn, forwards) = start(flanks);
    let pair = flanks.pair();
    let axes = |turn: f64| {
        let rotation = Rotation3::from_matrix_unchecked(pair.nominal_pose([0.0, turn]).rotation);
        UnitQuaternion::from_rotation_matrix(&rotation)
    };
    let axis = axes(0.0) * Vector3::z();
    let mut builder = gearmesh_dynamics::System::builder();
    let pinion = Body {
        angular_velocity_rad_per_s: Vector3::new(0.0, 0.0, -forwards * speed),
        ..pinion
    };
    let gear = Body {
        orientation: axes(turn),
        angular_velocity_rad_per_s: forwards * speed * axis,
        ..gear
    };
    let [pinion, gear] = [pinion, gear].map(|body| builder.body(body).unwrap());
    let markers = [pinion, gear].map(|body| Marker::at(body, [0.0; 3]));
    let grounds = [0.0, 1.0].map(|second| {
        let ground = Marker::ground([0.0; 3]);
        if second > 0.0 {
            ground.oriented(axes(0.0))
        } else {
            ground
        }
    });
    let speed = JointKind::Rotation(Motion::Speed(TimeFunction::Constant(-forwards * speed)));
    for (name, kind, member) in [
        ("pinion shaft", JointKind::Revolute, 0),
        ("drive", speed, 0),
        ("gear shaft", JointKind::Revolute, 1),
    ] {
        builder.joint(Joint::new(name, kind, grounds[member], markers[member]).unwrap());
    }
    let brake = TimeFunction::Constant(-forwards * TORQUE_NM);
    let along = (Axes::World, axis.into());
    builder.element(AppliedLoad::new("brake", gear, LoadKind::Torque, along, brake).unwrap());
    builder.element(MeshElement::new("mesh", markers, mesh));
    builder
}
