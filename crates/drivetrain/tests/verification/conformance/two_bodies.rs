//! Meshes between two bodies in space: action and reaction, tangents, turned scenes.

use crate::conformance::{DAMPINGS, damped, friction, loaded_poses, rates};
use crate::mesh_common::*;
use gearmesh_drivetrain::mesh_element::PairTangents;
use gearmesh_drivetrain::*;
use gearmesh_dynamics::state::BodyMotion;
use gearmesh_dynamics::{GROUND, Marker, MarkerPair};

use nalgebra::{Matrix3, SVector, UnitQuaternion, Vector3};
use std::f64::consts::FRAC_PI_2;

/// Two bodies in space that carry the gears in markers off their reference points.
struct Scene {
    pair: MarkerPair,
    bodies: [BodyMotion; 2],
}

impl Scene {
    fn new(pose: &Pose) -> Self {
        let marker = |position: [f64; 3], turn: [f64; 3]| {
            Marker::at(GROUND, position).oriented(UnitQuaternion::from_scaled_axis(turn.into()))
        };
        let pair = MarkerPair {
            a: marker([3e-3, -5e-3, 20e-3], [0.3, -0.2, 0.7]),
            b: marker([-2e-3, 1e-3, -15e-3], [-0.1, 0.4, 0.2]),
        };
        let world_from_a = UnitQuaternion::from_scaled_axis(Vector3::new(0.5, 0.9, -1.3));
        let rotation = nalgebra::Rotation3::from_matrix_unchecked(pose.rotation);
        let a_from_b = UnitQuaternion::from_rotation_matrix(&rotation);
        let at = Vector3::new(0.2, -0.1, 0.4);
        let body = |marker: &Marker,
                    orientation: UnitQuaternion<f64>,
                    position: Vector3<f64>,
                    seed: usize| {
            let orientation = orientation * marker.orientation().inverse();
            let speed = rates(seed);
            body_motion(
                position - orientation * marker.position_m,
                orientation,
                Vector3::new(speed[0], speed[1], speed[2]),
                Vector3::new(speed[3], speed[4], speed[5]),
            )
        };
        let bodies = [
            body(&pair.a, world_from_a, at, 1),
            body(
                &pair.b,
                world_from_a * a_from_b,
                at + world_from_a * pose.displacement_m,
                2,
            ),
        ];
        Self { pair, bodies }
    }

    /// Generalised force on both bodies, and its tangents (zero unless asked for).
    fn loads(&self, mesh: &mut GearMesh, tangents: bool) -> (SVector<f64, 12>, PairTangents) {
        let motion = self.pair.motion(&self.bodies[0], &self.bodies[1]);
        let load = mesh.evaluate(&Pose::from(&motion), tangents).unwrap();
        (
            motion.generalised_force(&load.load),
            PairTangents::new(&load, &motion),
        )
    }

    fn force(&self, mesh: &mut GearMesh) -> SVector<f64, 12> {
        self.loads(mesh, false).0
    }

    /// Moved by an increment of the bodies' degrees of freedom, or by a change of their velocities.
    fn changed(&self, dof: usize, by: f64, velocity: bool) -> Self {
        let mut bodies = self.bodies;
        let body = &mut bodies[dof / 6];
        let mut v = [body.velocity_m_per_s, body.angular_velocity_rad_per_s];
        let (mut position, mut orientation) = (body.position_m, body.orientation);
        if velocity {
            v[dof % 6 / 3][dof % 3] += by;
        } else if dof % 6 < 3 {
            position[dof % 3] += by;
        } else {
            orientation *= UnitQuaternion::from_scaled_axis(by * Vector3::ith(dof % 3, 1.0));
        }
        *body = body_motion(position, orientation, v[0], v[1]);
        Self {
            pair: self.pair,
            bodies,
        }
    }
}

fn body_motion(
    position_m: Vector3<f64>,
    orientation: UnitQuaternion<f64>,
    velocity_m_per_s: Vector3<f64>,
    angular_velocity_rad_per_s: Vector3<f64>,
) -> BodyMotion {
    BodyMotion {
        position_m,
        orientation,
        rotation: *orientation.to_rotation_matrix().matrix(),
        velocity_m_per_s,
        angular_velocity_rad_per_s,
    }
}

/// Force and moment about the world's origin on one body, world axes.
fn about_origin(
    scene: &Scene,
    force: &SVector<f64, 12>,
    body: usize,
) -> (Vector3<f64>, Vector3<f64>) {
    let f: Vector3<f64> = force.fixed_rows::<3>(6 * body).into();
    let m: Vector3<f64> = force.fixed_rows::<3>(6 * body + 3).into();
    let at = &scene.bodies[body];
    (f, at.rotation * m + at.position_m.cross(&f))
}

#[test]
fn action_is_reaction() {
    for pair in pairs() {
        for name in CONFORMING {
            let mut mesh = damped(name, &pair, DAMPINGS[0]).with_friction(friction());
            check_reaction(name, &mut mesh, &loaded_poses(&pair));
        }
    }
}

pub(crate) fn check_reaction(name: &str, mesh: &mut GearMesh, poses: &[Pose]) {
    for at in poses {
        let scene = Scene::new(at);
        let force = scene.force(mesh);
        let [(f1, m1), (f2, m2)] = [0, 1].map(|body| about_origin(&scene, &force, body));
        assert!(f1.norm() > 100.0);
        assert!((f1 + f2).norm() < 1e-12 * f1.norm(), "{name}");
        let off = (m1 + m2).norm();
        assert!(off < 1e-12 * f1.norm(), "{name}: {off}");
    }
}

/// Tangents by position and velocity of all twelve degrees of freedom against central differences.
#[test]
fn tangents_agree_with_differences() {
    for pair in pairs() {
        for name in CONFORMING {
            for (effects, tolerance) in [(false, 2e-3), (true, 5e-3)] {
                for damping in DAMPINGS {
                    let mut mesh = damped(name, &pair, damping);
                    if effects {
                        mesh = mesh.with_friction(friction());
                    }
                    let what = format!("{name} {damping:?} {effects}");
                    check_tangents((&what, tolerance), &mut mesh, &loaded_poses(&pair));
                }
            }
        }
    }
}

pub(crate) fn check_tangents((name, tolerance): (&str, f64), mesh: &mut GearMesh, poses: &[Pose]) {
    for (number, at) in poses.iter().enumerate() {
        let scene = Scene::new(at);
        let (force, here) = scene.loads(mesh, true);
        for dof in 0..12 {
            let angular = dof % 6 >= 3;
            for velocity in [false, true] {
                let h = match (velocity, angular) {
                    (false, false) => 1e-10,
                    (false, true) => 2e-9,
                    (true, _) => 1e-6,
                };
                let mut at = |by| scene.changed(dof, by, velocity).force(mesh);
                let difference = (at(h) - at(-h)) / (2.0 * h);
                let (tangent, whole) = if velocity {
                    (here.by_velocity.column(dof), &here.by_velocity)
                } else {
                    (here.by_position.column(dof), &here.by_position)
                };
                // Rows of forces and of moments have their own scale; so have the columns.
                for rows in [0, 3, 6, 9] {
                    let off =
                        (difference.fixed_rows::<3>(rows) - tangent.fixed_rows::<3>(rows)).norm();
                    let column = 3 * (dof / 3);
                    let scale = whole.fixed_view::<3, 3>(rows, column).norm();
                    let noise = 1e-9 * force.norm() / h * 1e-3;
                    assert!(
                        off <= tolerance * scale + noise,
                        "{name} {number} dof {dof} rows {rows} velocity {velocity}: {off:e} of {scale:e}"
                    );
                }
            }
        }
    }
}

/// The whole scene turned by a Cardan angle of 90°: the same loads, turned with it.
#[test]
fn loads_turn_with_the_scene() {
    for pair in pairs() {
        for name in CONFORMING {
            let mut mesh = damped(name, &pair, DAMPINGS[1]).with_friction(friction());
            check_turned(name, &mut mesh, &loaded_poses(&pair));
        }
    }
}

pub(crate) fn check_turned(name: &str, mesh: &mut GearMesh, poses: &[Pose]) {
    let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.0, FRAC_PI_2, 0.0));
    let moved = Vector3::new(1.0, -2.0, 0.5);
    for at in poses {
        let scene = Scene::new(at);
        let turned = Scene {
            pair: scene.pair,
            bodies: scene.bodies.map(|b| {
                body_motion(
                    turn * b.position_m + moved,
                    turn * b.orientation,
                    turn * b.velocity_m_per_s,
                    b.angular_velocity_rad_per_s,
                )
            }),
        };
        let (before, after) = (scene.force(mesh), turned.force(mesh));
        let rotation: Matrix3<f64> = *turn.to_rotation_matrix().matrix();
        for rows in [0, 6] {
            let (f, m) = (
                before.fixed_rows::<3>(rows),
                before.fixed_rows::<3>(rows + 3),
            );
            let off_f = (rotation * f - after.fixed_rows::<3>(rows)).norm();
            let off_m = (m - after.fixed_rows::<3>(rows + 3)).norm();
            // Penetrations of 1e-5 m come out of places of the order of 1 m: eleven digits, some lost in the solver.
            assert!(
                off_f < 1e-8 * f.norm() && off_m < 1e-8 * f.norm(),
                "{name} {off_f:e} {off_m:e}"
            );
        }
    }
}
