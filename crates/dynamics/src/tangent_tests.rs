//! Every joint and force element: analytic tangents against central differences, and energy against work. One suite for
//! all.
#![allow(clippy::unwrap_used)] // test code

use nalgebra::{DMatrix, Matrix5, Matrix6, UnitQuaternion, Vector3, Vector5};

use crate::body::{Body, BodyId, GROUND, Modes};
use crate::elements::Iterate;
use crate::elements::{
    AppliedLoad, Axes, AxialSupport, BeamSection, Bushing, ForceElement, LinearBearing, LoadKind,
    MatrixBearing, SpringDamper, TorsionSpring,
};
use crate::equations::{At, Detail, Equations};
use crate::joint::{Joint, JointKind, Motion};
use crate::matrix::Matrix;
use crate::relative_motion::{Marker, MarkerPair};
use crate::state::State;
use crate::system::System;
use crate::time_function::TimeFunction;

/// Numbers between −1 and 1, the same in every run.
struct Random(fastrand::Rng);

impl Random {
    fn new(seed: u64) -> Self {
        Self(fastrand::Rng::with_seed(seed))
    }

    fn next(&mut self) -> f64 {
        2.0 * self.0.f64() - 1.0
    }

    fn vector(&mut self, size: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| size * self.next())
    }

    fn turn(&mut self, size: f64) -> UnitQuaternion<f64> {
        UnitQuaternion::from_scaled_axis(self.vector(size))
    }

    fn list(&mut self, count: usize) -> Vec<f64> {
        (0..count).map(|_| self.next()).collect()
    }
}

fn body(name: &str, modes: usize, random: &mut Random) -> Body {
    let mut body = Body::rigid(name, 2.0, [0.5, 0.6, 0.7]);
    body.inertia_kg_m2[(0, 1)] = 0.05;
    body.inertia_kg_m2[(1, 0)] = 0.05;
    body.center_of_mass_m = random.vector(0.3);
    body.position_m = random.vector(0.3);
    body.orientation = random.turn(0.3);
    body.velocity_m_per_s = random.vector(2.0);
    body.angular_velocity_rad_per_s = random.vector(2.0);
    if modes > 0 {
        body.modes = Some(Modes {
            angular_frequency_rad_per_s: (0..modes).map(|i| 3.0 + i as f64).collect(),
            damping_ratio: vec![0.02; modes],
            coupling: DMatrix::from_fn(modes, 6, |_, _| 0.2 * random.next()),
        });
    }
    body
}

fn marker(body: BodyId, random: &mut Random) -> Marker {
    Marker::at(body, random.vector(0.3).into()).oriented(random.turn(0.4))
}

fn pair(random: &mut Random, a: BodyId, b: BodyId) -> MarkerPair {
    MarkerPair {
        a: marker(a, random),
        b: marker(b, random),
    }
}

/// A motion with everything in play.
struct Case {
    system: System,
    state: State,
    acceleration: Vec<f64>,
    lambda: Vec<f64>,
}

impl Case {
    fn new(mut system: System, random: &mut Random) -> Self {
        let mut state = system.start().clone();
        system.begin(&state);
        let n = system.degrees_of_freedom();
        let moved = state.clone();
        let step: Vec<f64> = random.list(n).iter().map(|x| 0.1 * x).collect();
        state.set_moved(&moved, &step, system.layout());
        state.velocity = random.list(n);
        state.time_s = 0.3;
        Self {
            acceleration: random.list(n),
            lambda: random.list(system.equations()),
            state,
            system,
        }
    }

    fn evaluate(&mut self, detail: Detail) -> Equations {
        let mut equations = Equations::new(&self.system);
        let at = At {
            state: &self.state,
            acceleration: &self.acceleration,
            lambda: &self.lambda,
            load_factor: 1.0,
            iterate: Iterate::Single,
        };
        self.system.evaluate(at, detail, &mut equations).unwrap();
        equations
    }

    /// (f(+) − f(−))/2ε of a change of the case.
    fn difference(&mut self, change: impl Fn(&mut Self, f64)) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
        let keep = (self.state.clone(), self.acceleration.clone());
        let step = 1e-5;
        let mut sides = [step, -step].map(|step| {
            change(self, step);
            let found = self.evaluate(Detail::Forces);
            (self.state, self.acceleration) = keep.clone();
            (found.residual, found.violation, found.violation_rate)
        });
        let minus = std::mem::take(&mut sides[1]);
        let plus = std::mem::take(&mut sides[0]);
        let slope = |a: Vec<f64>, b: Vec<f64>| {
            a.iter()
                .zip(b)
                .map(|(a, b)| (a - b) / (2.0 * step))
                .collect()
        };
        (
            slope(plus.0, minus.0),
            slope(plus.1, minus.1),
            slope(plus.2, minus.2),
        )
    }

    fn check_tangents(&mut self, what: &str) {
        let exact = self.evaluate(Detail::Tangents);
        let n = exact.residual.len();
        let same = |kind: &str, matrix: &Matrix, dof: usize, difference: &[f64]| {
            for (i, b) in difference.iter().enumerate() {
                let a = matrix.get(i, dof);
                assert!(
                    (a - b).abs() < 2e-7 * (1.0 + a.abs()),
                    "{what}, {kind} [{i}][{dof}]: {a} and {b}"
                );
            }
        };
        for dof in 0..n {
            let (by_acceleration, ..) =
                self.difference(|case, step| case.acceleration[dof] += step);
            same("mass", &exact.mass, dof, &by_acceleration);
            let (by_velocity, _, rate) =
                self.difference(|case, step| case.state.velocity[dof] += step);
            same("damping", &exact.damping, dof, &by_velocity);
            let (by_position, violation, _) = self.difference(|case, step| {
                let mut increment = vec![0.0; n];
                increment[dof] = step;
                let from = case.state.clone();
                case.state
                    .set_moved(&from, &increment, case.system.layout());
            });
            same("stiffness", &exact.stiffness, dof, &by_position);
            for equation in 0..violation.len() {
                let b = exact.gradient.get(dof, equation);
                assert!(
                    (b - violation[equation]).abs() < 1e-8,
                    "{what}: gradient {equation}"
                );
                assert!((b - rate[equation]).abs() < 1e-8, "{what}: rate {equation}");
            }
        }
    }

    /// d/dt (B v) along the motion at constant v.
    fn check_gradient_rate(&mut self, what: &str) {
        let exact = self.system.gradient_rate(&self.state);
        let (_, _, difference) = self.difference(|case, step| {
            let increment: Vec<f64> = case.state.velocity.iter().map(|v| step * v).collect();
            let from = case.state.clone();
            case.state
                .set_moved(&from, &increment, case.system.layout());
        });
        for (a, b) in exact.iter().zip(&difference) {
            assert!((a - b).abs() < 1e-7, "{what}: {a} and {b}");
        }
    }

    /// Power of all forces and reactions equals −d(energy)/dt − dissipated + supplied: none is invented.
    fn check_energy(&mut self, what: &str) {
        self.acceleration.fill(0.0);
        self.lambda.fill(0.0);
        let forces = self.evaluate(Detail::Forces).residual;
        let energy = self.system.energy(&self.state, &self.lambda);
        let power: f64 = forces
            .iter()
            .zip(&self.state.velocity)
            .map(|(f, v)| f * v)
            .sum();
        let velocity = self.state.velocity.clone();
        let step = 1e-5;
        let mut total = |time: f64| {
            let from = self.state.clone();
            let increment: Vec<f64> = velocity.iter().map(|v| time * v).collect();
            self.state
                .set_moved(&from, &increment, self.system.layout());
            self.evaluate(Detail::Forces);
            let total = self.system.energy(&self.state, &self.lambda).total_j();
            self.state = from;
            total
        };
        let rate = (total(step) - total(-step)) / (2.0 * step);
        let left = rate + energy.dissipated_w - energy.supplied_w;
        assert!(
            (left - power).abs() < 1e-7 * (1.0 + power.abs()),
            "{what}: {left} W and {power} W"
        );
        assert!(energy.dissipated_w >= 0.0);
    }
}

fn wave() -> TimeFunction {
    TimeFunction::Sine {
        offset: 0.1,
        amplitude: 0.2,
        frequency_hz: 0.5,
        phase_rad: 0.3,
    }
}

#[test]
fn joints_have_exact_tangents() {
    let kinds = [
        JointKind::Fixed,
        JointKind::Revolute,
        JointKind::Prismatic,
        JointKind::Cylindrical,
        JointKind::Spherical,
        JointKind::PointOnAxis,
        JointKind::Planar,
        JointKind::Universal,
        JointKind::Translation(Motion::Position(wave())),
        JointKind::Rotation(Motion::Position(wave())),
        JointKind::Rotation(Motion::Speed(wave())),
    ];
    for (index, kind) in kinds.into_iter().enumerate() {
        let random = &mut Random::new(17 + index as u64);
        let what = format!("{kind:?}");
        let mut builder = System::builder();
        let a = builder.body(body("a", 2, random)).unwrap();
        let b = builder.body(body("b", 0, random)).unwrap();
        let [to_body, to_ground] = [pair(random, a, b), pair(random, GROUND, b)];
        builder.joint(Joint::new("between", kind.clone(), to_body.a, to_body.b).unwrap());
        if index % 2 == 1 {
            builder.joint(
                Joint::new("to ground", JointKind::Spherical, to_ground.a, to_ground.b).unwrap(),
            );
        }
        let mut case = Case::new(builder.build().unwrap(), random);
        case.check_tangents(&what);
        case.check_gradient_rate(&what);
        case.check_energy(&what);
    }
}

#[test]
fn coupled_angles_have_exact_tangents() {
    let random = &mut Random::new(5);
    let mut builder = System::builder();
    let a = builder.body(body("a", 0, random)).unwrap();
    let b = builder.body(body("b", 1, random)).unwrap();
    let pairs = [pair(random, GROUND, a), pair(random, b, a)];
    builder.joint(Joint::ratio("ratio", (pairs[0], 0.3), (pairs[1], -0.7)));
    let mut case = Case::new(builder.build().unwrap(), random);
    case.check_tangents("ratio");
    case.check_gradient_rate("ratio");
}

#[test]
fn rolling_has_exact_tangents_and_does_no_work() {
    for (seed, on_ground) in [(7, true), (8, false)] {
        let random = &mut Random::new(seed);
        let mut builder = System::builder();
        let a = builder.body(body("a", 0, random)).unwrap();
        let b = builder.body(body("b", 1, random)).unwrap();
        let mut pair = pair(random, if on_ground { GROUND } else { a }, b);
        // Axes apart: differences of a polar angle lose their figures close to the axis, with the cube of the distance.
        pair.a.position_m += Vector3::new(-1.5, 0.4, 0.0);
        builder.joint(Joint::rolling("rolling", pair, [0.3, 0.7]));
        let mut case = Case::new(builder.build().unwrap(), random);
        case.check_tangents("rolling");
        case.check_gradient_rate("rolling");
        case.check_energy("rolling");
    }
}

#[test]
fn force_elements_have_exact_tangents_and_keep_their_energy() {
    let random = &mut Random::new(91);
    let root = Matrix6::from_fn(|_, _| random.next());
    let bushing = Bushing {
        stiffness: root * root.transpose(),
        damping: 0.1 * root.transpose() * root,
        free_displacement_m: random.vector(0.1),
    };
    let spring = SpringDamper {
        stiffness_n_per_m: 3.0,
        damping_n_s_per_m: 0.4,
        free_length_m: 0.2,
    };
    let torsion = TorsionSpring::new(2.0, 0.3);
    let bearing = LinearBearing {
        radial_stiffness_n_per_m: 4.0,
        axial_stiffness_n_per_m: 2.0,
        tilt_stiffness_nm_per_rad: 3.0,
        radial_damping_n_s_per_m: 0.3,
        axial_damping_n_s_per_m: 0.2,
        tilt_damping_nm_s_per_rad: 0.4,
        ..LinearBearing::default()
    };
    let one_way = |axial_support| LinearBearing {
        axial_support,
        ..bearing
    };
    let [positive, negative] = [AxialSupport::Positive, AxialSupport::Negative].map(one_way);
    let damped = Matrix5::from_fn(|_, _| random.next());
    let matrix = MatrixBearing {
        stiffness: Matrix5::from_fn(|_, _| random.next()),
        damping: 0.1 * damped * damped.transpose(),
        at: Vector5::from_fn(|_, _| 0.1 * random.next()),
        load: Vector5::from_fn(|_, _| random.next()),
    };
    let beam = BeamSection {
        damping_s: 0.1,
        ..BeamSection::round(0.2, 0.1, 300.0, 0.3)
    };
    let force = LoadKind::Force {
        point_m: [0.1, -0.2, 0.3],
    };
    let (id, other) = (BodyId(0), BodyId(1));
    // An end that moves with two modes of the first body, its turns small as those of elastic bodies are.
    let sizes = [0.3, 0.3, 0.3, 1e-3, 1e-3, 1e-3];
    let moving = DMatrix::from_fn(6, 2, |i, _| sizes[i] * random.next());
    for (a, b) in [(id, other), (GROUND, id), (other, GROUND)] {
        let ends = [a, b].map(|body| (body == id).then(|| moving.clone()));
        let mut place = || pair(random, a, b);
        let mut elements: Vec<Box<dyn ForceElement>> = vec![
            Box::new(spring.between("spring", place()).unwrap()),
            Box::new(torsion.between("torsion", place()).unwrap()),
            Box::new(bushing.between("bushing", place()).unwrap()),
            Box::new(bearing.between("bearing", place()).unwrap()),
            Box::new(positive.between("one-way bearing", place()).unwrap()),
            Box::new(negative.between("bearing the other way", place()).unwrap()),
            Box::new(matrix.between("matrix bearing", place()).unwrap()),
            Box::new(beam.between("beam", place(), 1.0).unwrap()),
            Box::new(
                bushing
                    .between("moving bushing", place())
                    .and_then(|bushing| bushing.on_moving_ends(ends))
                    .unwrap(),
            ),
        ];
        for axes in [Axes::World, Axes::Body] {
            for kind in [LoadKind::Torque, force] {
                let direction = (axes, [1.0, 2.0, -0.5]);
                elements.push(Box::new(
                    AppliedLoad::new("load", id, kind, direction, wave()).unwrap(),
                ));
            }
        }
        elements.into_iter().for_each(check_element);
    }
}

fn check_element(element: Box<dyn ForceElement>) {
    let random = &mut Random::new(3);
    let what = element.name().to_owned();
    let mut builder = System::builder();
    builder.body(body("a", 2, random)).unwrap();
    builder.body(body("b", 0, random)).unwrap();
    builder.gravity([1.0, -2.0, 3.0]);
    builder.boxed_element(element);
    let mut case = Case::new(builder.build().unwrap(), random);
    case.check_tangents(&what);
    case.check_energy(&what);
}
