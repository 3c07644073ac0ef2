//! What holds for the motion of any free system of bodies on joints, trees and loops: no force from outside, no
//! damping.

use std::ops::ControlFlow;

use gearmesh_dynamics::elements::SpringDamper;
use gearmesh_dynamics::{
    Body, BodyId, BodyMotion, DynamicsError, Joint, JointKind, Marker, MarkerPair, Params,
    Simulation, System,
};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use proptest::prelude::*;
use proptest::sample::{Index, select};

use crate::property_cases::cases;

type V = Vector3<f64>;

/// A body, placed from the one that it hangs on.
#[derive(Debug, Clone)]
struct Part {
    mass_kg: f64,
    gyration: [f64; 3],
    centre_m: [f64; 3],
    from_parent_m: [f64; 3],
    turn: [f64; 3],
    parent: Index,
    kind: JointKind,
    joint_turn: [f64; 3],
}

/// Bodies on joints, all moving as one at the start: every joint's rate is zero then.
#[derive(Debug, Clone)]
struct Scene {
    parts: Vec<Part>,
    /// Whether the last body is held to the first by one more joint.
    is_loop: bool,
    velocity: [f64; 3],
    spin: [f64; 3],
    stiffness_n_per_m: f64,
}

fn three(range: std::ops::Range<f64>) -> [std::ops::Range<f64>; 3] {
    [range.clone(), range.clone(), range]
}

fn scenes() -> impl Strategy<Value = Scene> {
    let kinds = [
        JointKind::Spherical,
        JointKind::Universal,
        JointKind::Revolute,
        JointKind::Cylindrical,
        JointKind::Fixed,
    ];
    let part = (
        (
            0.5f64..3.0,
            three(0.2..1.0),
            three(-0.1..0.1),
            three(0.15..0.4),
        ),
        (
            three(-1.0..1.0),
            any::<Index>(),
            select(kinds.to_vec()),
            three(-1.0..1.0),
        ),
    );
    let part = part.prop_map(|(own, joint)| Part {
        mass_kg: own.0,
        gyration: own.1,
        centre_m: own.2,
        from_parent_m: own.3,
        turn: joint.0,
        parent: joint.1,
        kind: joint.2,
        joint_turn: joint.3,
    });
    let start = (
        any::<bool>(),
        three(-1.0..1.0),
        three(-3.0..3.0),
        100.0f64..2000.0,
    );
    (proptest::collection::vec(part, 2..6), start).prop_map(|(parts, start)| Scene {
        // Only a loop of enough spherical joints has no redundant equations at every place.
        is_loop: start.0 && parts.len() > 3,
        parts,
        velocity: start.1,
        spin: start.2,
        stiffness_n_per_m: start.3,
    })
}

/// A motion of the whole scene: turned, moved, and in steady motion.
#[derive(Debug, Clone, Copy)]
struct View {
    turn: UnitQuaternion<f64>,
    shift: V,
    boost: V,
    /// Bodies and joints in the opposite order.
    reversed: bool,
}

const PLAIN: View = View {
    turn: UnitQuaternion::new_unchecked(nalgebra::Quaternion::new(1.0, 0.0, 0.0, 0.0)),
    shift: V::new(0.0, 0.0, 0.0),
    boost: V::new(0.0, 0.0, 0.0),
    reversed: false,
};

impl Scene {
    /// Parent of each body, and the joint between them.
    fn parent(&self, i: usize) -> (usize, JointKind) {
        match self.is_loop {
            true => (i - 1, JointKind::Spherical),
            false => (self.parts[i].parent.index(i), self.parts[i].kind.clone()),
        }
    }

    fn bodies(&self) -> Vec<Body> {
        let mut bodies: Vec<Body> = Vec::new();
        for (i, p) in self.parts.iter().enumerate() {
            let [a, b, c] = p.gyration;
            let moments = [b + c, a + c, a + b].map(|sum| 0.02 * p.mass_kg * sum);
            let mut body = Body::rigid(&format!("body {i}"), p.mass_kg, moments);
            body.center_of_mass_m = V::from(p.centre_m);
            body.orientation = UnitQuaternion::from_scaled_axis(V::from(p.turn));
            if i > 0 {
                // Up and down in turn, so that loops do not stretch into a line.
                let mut way = V::from(p.from_parent_m);
                way[i % 3] *= -1.0;
                body.position_m = bodies[self.parent(i).0].position_m + way;
            }
            let spin = V::from(self.spin);
            body.velocity_m_per_s = V::from(self.velocity) + spin.cross(&body.position_m);
            body.angular_velocity_rad_per_s = body.orientation.inverse() * spin;
            bodies.push(body);
        }
        bodies
    }

    fn system(&self, view: &View) -> (System, Vec<BodyId>) {
        let plain = self.bodies();
        let order: Vec<usize> = match view.reversed {
            true => (0..plain.len()).rev().collect(),
            false => (0..plain.len()).collect(),
        };
        let mut builder = System::builder();
        let mut ids = vec![None; plain.len()];
        for &i in &order {
            let mut body = plain[i].clone();
            body.position_m = view.turn * body.position_m + view.shift;
            body.velocity_m_per_s = view.turn * body.velocity_m_per_s + view.boost;
            body.orientation = view.turn * body.orientation;
            ids[i] = Some(builder.body(body).unwrap());
        }
        let ids: Vec<BodyId> = ids.into_iter().flatten().collect();
        // A frame of the unmoved world, fixed in a body.
        let marker = |i: usize, place: V, turn: UnitQuaternion<f64>| {
            let body = &plain[i];
            let back = body.orientation.inverse();
            Marker::at(ids[i], (back * (place - body.position_m)).into()).oriented(back * turn)
        };
        let mut joints = Vec::new();
        for i in 1..plain.len() {
            let (parent, kind) = self.parent(i);
            let place = 0.5 * (plain[parent].position_m + plain[i].position_m);
            let turn = UnitQuaternion::from_scaled_axis(V::from(self.parts[i].joint_turn));
            // Universal: x of the first and y of the second stay at right angles, as they are in one frame.
            let (a, b) = (marker(parent, place, turn), marker(i, place, turn));
            joints.push(Joint::new(&format!("joint {i}"), kind, a, b).unwrap());
        }
        let last = plain.len() - 1;
        if self.is_loop {
            let place =
                0.5 * (plain[0].position_m + plain[last].position_m) + V::new(0.0, 0.1, 0.1);
            let turn = UnitQuaternion::identity();
            let (a, b) = (marker(last, place, turn), marker(0, place, turn));
            joints.push(Joint::new("closing joint", JointKind::Spherical, a, b).unwrap());
        }
        if view.reversed {
            joints.reverse();
        }
        for joint in joints {
            builder.joint(joint);
        }
        let spring = SpringDamper {
            stiffness_n_per_m: self.stiffness_n_per_m,
            damping_n_s_per_m: 0.0,
            free_length_m: 0.05,
        };
        let pair = MarkerPair {
            a: Marker::at(ids[0], [0.05, 0.0, 0.0]),
            b: Marker::at(ids[last], [0.0, -0.05, 0.02]),
        };
        builder.element(spring.between("spring", pair).unwrap());
        (builder.build().unwrap(), ids)
    }

    /// What is there at the start.
    fn start(&self) -> Outcome {
        let (system, ids) = self.system(&PLAIN);
        let simulation = Simulation::new(system, Params::fixed(1e-3)).unwrap();
        self.outcome(&simulation, &ids)
    }

    /// What is there after `END_S`; none where no run comes to it.
    fn run(&self, view: &View, steps: u32, rho_infinity: f64) -> Option<Outcome> {
        let (system, ids) = self.system(view);
        let params = Params {
            rho_infinity,
            newton_tolerance: Some(1e-12),
            ..Params::fixed(END_S / f64::from(steps))
        };
        let mut simulation = Simulation::new(system, params).unwrap();
        match simulation.run(END_S, |_| ControlFlow::Continue(())) {
            // The spring's ends may meet, where its force has no direction: the run says that the step is too long.
            Err(DynamicsError::StepTooLarge { .. }) => return None,
            Err(e) => panic!("{e}"),
            Ok(_) => {}
        }
        Some(self.outcome(&simulation, &ids))
    }

    /// Motions of all bodies in the order of the parts; momentum, angular momentum about the origin and energy.
    fn outcome(&self, simulation: &Simulation, ids: &[BodyId]) -> Outcome {
        let motions: Vec<BodyMotion> = ids
            .iter()
            .map(|&id| simulation.system().body_motion(simulation.state(), id))
            .collect();
        let (mut momentum, mut angular) = (V::zeros(), V::zeros());
        for (motion, body) in motions.iter().zip(self.bodies()) {
            let rotation: Matrix3<f64> = motion.rotation;
            let (omega, arm) = (
                rotation * motion.angular_velocity_rad_per_s,
                rotation * body.center_of_mass_m,
            );
            let of_centre = body.mass_kg * (motion.velocity_m_per_s + omega.cross(&arm));
            momentum += of_centre;
            let own = rotation * body.inertia_kg_m2 * motion.angular_velocity_rad_per_s;
            angular += own + (motion.position_m + arm).cross(&of_centre);
        }
        let energy_j = simulation.info().energy.last.total_j();
        Outcome {
            motions,
            momentum,
            angular,
            energy_j,
        }
    }
}

struct Outcome {
    motions: Vec<BodyMotion>,
    momentum: V,
    angular: V,
    energy_j: f64,
}

impl Outcome {
    /// Largest difference of places \[m\] and turns \[rad\].
    fn off(&self, other: &Self) -> f64 {
        self.motions
            .iter()
            .zip(&other.motions)
            .fold(0.0, |worst: f64, (a, b)| {
                let turn = a.orientation.angle_to(&b.orientation);
                worst.max((a.position_m - b.position_m).norm()).max(turn)
            })
    }
}

const END_S: f64 = 0.1;

proptest! {
    #![proptest_config(cases(12))]

    /// The motion, momentum, angular momentum and energy converge with the second power of the step: to what they were
    /// at the start, the last three. Without damping by the scheme.
    #[test]
    fn free_systems_converge_and_conserve(scene in scenes()) {
        let runs = [80, 160, 320].map(|steps| scene.run(&PLAIN, steps, 1.0));
        prop_assume!(runs.iter().all(Option::is_some));
        let [coarse, middle, fine] = runs.map(Option::unwrap);
        let start = scene.start();
        let order = |errors: [f64; 2], scale: f64| {
            // Rounding and Newton's tolerance are all that is left where there is next to no error.
            errors[1] < 1e-9 * scale || (2.8..5.5).contains(&(errors[0] / errors[1]))
        };
        let motion = [coarse.off(&middle), middle.off(&fine)];
        prop_assert!(order(motion, 1.0), "motion: {motion:?}");
        // Reference points are not the centres of mass, so that momentum is not linear in the velocities of the state.
        let momentum = [&middle, &fine].map(|o| (o.momentum - start.momentum).norm());
        prop_assert!(order(momentum, 1.0 + start.momentum.norm()), "momentum: {momentum:?}");
        let angular = [&middle, &fine].map(|o| (o.angular - start.angular).norm());
        prop_assert!(order(angular, 1.0 + start.angular.norm()), "angular momentum: {angular:?}");
        let energy = [&middle, &fine].map(|o| (o.energy_j - start.energy_j).abs());
        prop_assert!(order(energy, 1.0 + start.energy_j), "energy: {energy:?}");
    }

    /// Turned, moved and in steady motion as a whole, a system moves as before, seen from there; so it does with its
    /// bodies and joints in another order.
    #[test]
    fn motion_does_not_hang_on_the_view(
        scene in scenes(), turn in three(-3.0..3.0), shift in three(-2.0..2.0), boost in three(-2.0..2.0), reversed in any::<bool>(),
    ) {
        let turn = UnitQuaternion::from_scaled_axis(V::from(turn));
        let view = View { turn, shift: V::from(shift), boost: V::from(boost), reversed };
        let (plain, seen) = (scene.run(&PLAIN, 80, 0.8), scene.run(&view, 80, 0.8));
        prop_assert_eq!(plain.is_some(), seen.is_some());
        prop_assume!(plain.is_some());
        let (plain, seen) = (plain.unwrap(), seen.unwrap());
        for (a, b) in plain.motions.iter().zip(&seen.motions) {
            let place = view.turn * a.position_m + view.shift + END_S * view.boost;
            prop_assert!((b.position_m - place).norm() < 1e-8, "{:e} m", (b.position_m - place).norm());
            let off = (view.turn * a.orientation).angle_to(&b.orientation);
            prop_assert!(off < 1e-8, "{off:e} rad");
            let velocity = view.turn * a.velocity_m_per_s + view.boost;
            prop_assert!((b.velocity_m_per_s - velocity).norm() < 1e-6);
            let spin = (b.angular_velocity_rad_per_s - a.angular_velocity_rad_per_s).norm();
            prop_assert!(spin < 1e-6, "{spin:e} rad/s");
        }
    }
}
