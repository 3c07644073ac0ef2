//! Andrews' squeezing mechanism: seven bodies in a plane, driven by a constant torque, here in space with ten revolute
//! joints.
//!
//! Each of the three loops of revolute joints has three redundant equations, so the mechanism also tries those.
//!
//! Data and reference solution: W. Schiehlen (ed.), *Multibody Systems Handbook*, 1990; E. Hairer, G. Wanner, *Solving
//! Ordinary Differential Equations II*, 2nd ed., section VII.7; test set for initial value problems (Bari), problem
//! `andrews`. The positions at the end are computed anew by tools/reference/andrews.py.

use gearmesh_dynamics::elements::{AppliedLoad, Axes, LoadKind, SpringDamper};
use gearmesh_dynamics::{
    Body, BodyId, Joint, JointKind, Marker, MarkerPair, Simulation, System, TimeFunction,
};
use nalgebra::{UnitQuaternion, Vector3};

/// End of the reference solution \[s\].
pub const END_S: f64 = 0.03;

/// β, Θ, γ, Φ, δ, Ω, ε at 0.03 s \[rad\].
pub const ANGLES: [f64; 7] = [
    0.1581077119629904e2,
    -0.1575637105984298e2,
    0.4082224013073101e-1,
    -0.5347301163226948,
    0.5244099658805304,
    0.5347301163226948,
    0.1048080741042263e1,
];

/// Their rates at 0.03 s \[rad/s\].
pub const RATES: [f64; 7] = [
    0.1139920302151208e4,
    -0.1424379294994111e4,
    0.1103291221937134e2,
    0.1929337464421385e2,
    0.5735699284790808,
    -0.1929337464421385e2,
    0.3231791658026955,
];

/// Forces of the point P on bodies 3, 4 and 6 at 0.03 s, as x and y in turn, up to their sign \[N\].
pub const FORCES: [f64; 6] = [
    0.199175333373191e3,
    -0.2975531228015052e2,
    0.2306654119098399e2,
    0.3145271365475927e2,
    0.2264249232082739e2,
    0.1161740700019673e2,
];

const START: [f64; 7] = [
    -0.061_713_890_014_276_45,
    0.0,
    0.455_279_819_163_070_37,
    0.222_668_390_165_885_88,
    0.487_364_979_543_842_56,
    -0.222_668_390_165_885_88,
    1.230_547_444_549_821_2,
];

const A: [f64; 2] = [-0.06934, -0.00227];
const B: [f64; 2] = [-0.03635, 0.03273];
const C: [f64; 2] = [0.014, 0.072];
const RR: f64 = 7e-3;
const D: f64 = 28e-3;
const SS: f64 = 35e-3;
const E: f64 = 2e-2;
const ZT: f64 = 4e-2;
const ZF: f64 = 2e-2;
const U: f64 = 4e-2;

/// Mass, moment of inertia about the centre of mass, centre of mass from the joint where the body's frame sits.
const BODIES: [(f64, f64, [f64; 2]); 7] = [
    (0.04325, 2.194e-6, [92e-5, 0.0]),
    (0.00365, 4.410e-7, [-115e-4, 0.0]),
    (0.02373, 5.255e-6, [1043e-5, -1874e-5]),
    (0.00706, 5.667e-7, [0.0, -(E - 1421e-5)]),
    (0.07050, 1.169e-5, [916e-5, 2308e-5]),
    (0.00706, 5.667e-7, [ZF - 1421e-5, 0.0]),
    (0.05498, 1.912e-5, [449e-5, -1228e-5]),
];

/// The mechanism at its start, its plane turned by `orientation` and moved by `origin`.
pub fn mechanism(orientation: UnitQuaternion<f64>, origin: Vector3<f64>) -> System {
    let [beta, theta, gamma, phi, delta, omega, epsilon] = START;
    let angles = [
        beta,
        beta + theta,
        gamma,
        phi + delta,
        delta,
        omega + epsilon,
        epsilon,
    ];
    let along = |from: [f64; 2], angle: f64, [x, y]: [f64; 2]| {
        let (s, c) = angle.sin_cos();
        [from[0] + c * x - s * y, from[1] + s * x + c * y]
    };
    let origins = [
        [0.0, 0.0],
        along([0.0, 0.0], beta, [RR, 0.0]),
        B,
        along(A, delta, [ZT, 0.0]),
        A,
        along(A, epsilon, [0.0, -U]),
        A,
    ];
    let mut builder = System::builder();
    let mut ids = Vec::new();
    for (index, (mass, inertia, center)) in BODIES.into_iter().enumerate() {
        let mut body = Body::rigid(
            &format!("K{}", index + 1),
            mass,
            [0.6 * inertia, 0.7 * inertia, inertia],
        );
        body.center_of_mass_m = Vector3::new(center[0], center[1], 0.0);
        let place = Vector3::new(origins[index][0], origins[index][1], 0.0);
        body.position_m = origin + orientation * place;
        body.orientation =
            orientation * UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angles[index]);
        ids.push(builder.body(body).unwrap());
    }
    let world = |[x, y]: [f64; 2]| {
        let position = origin + orientation * Vector3::new(x, y, 0.0);
        Marker::ground(position.into()).oriented(orientation)
    };
    let on = |body: BodyId, [x, y]: [f64; 2]| Marker::at(body, [x, y, 0.0]);
    let k = |number: usize| ids[number - 1];
    let tip = on(k(2), [-D, 0.0]);
    let hinges = [
        ("P3", tip, on(k(3), [0.0, -SS])),
        ("P4", tip, on(k(4), [0.0, -E])),
        ("P6", tip, on(k(6), [ZF, 0.0])),
        ("O", world([0.0, 0.0]), on(k(1), [0.0, 0.0])),
        ("12", on(k(1), [RR, 0.0]), on(k(2), [0.0, 0.0])),
        ("B", world(B), on(k(3), [0.0, 0.0])),
        ("54", on(k(5), [ZT, 0.0]), on(k(4), [0.0, 0.0])),
        ("A5", world(A), on(k(5), [0.0, 0.0])),
        ("76", on(k(7), [0.0, -U]), on(k(6), [0.0, 0.0])),
        ("A7", world(A), on(k(7), [0.0, 0.0])),
    ];
    for (name, a, b) in hinges {
        builder.joint(Joint::new(name, JointKind::Revolute, a, b).unwrap());
    }
    let spring = SpringDamper {
        stiffness_n_per_m: 4530.0,
        damping_n_s_per_m: 0.0,
        free_length_m: 7785e-5,
    };
    let pair = MarkerPair {
        a: world(C),
        b: on(k(3), [2e-2, -18e-3]),
    };
    builder.element(spring.between("spring", pair).unwrap());
    let axis = orientation * Vector3::z();
    let drive = AppliedLoad::new(
        "drive",
        k(1),
        LoadKind::Torque,
        (Axes::World, [axis.x, axis.y, axis.z]),
        TimeFunction::Constant(33e-3),
    );
    builder.element(drive.unwrap());
    builder.build().unwrap()
}

/// β, Θ, γ, Φ, δ, Ω, ε, each within half a turn of `near`, and their rates.
pub fn angles(
    simulation: &Simulation,
    orientation: &UnitQuaternion<f64>,
    near: &[f64; 7],
) -> ([f64; 7], [f64; 7]) {
    let state = simulation.state();
    let angle = |number: usize| {
        let seen = (orientation.inverse() * state.orientations[number - 1]) * Vector3::x();
        seen.y.atan2(seen.x)
    };
    let rate = |number: usize| state.velocity[6 * (number - 1) + 5];
    let from = |value: &dyn Fn(usize) -> f64| {
        [
            value(1),
            value(2) - value(1),
            value(3),
            value(4) - value(5),
            value(5),
            value(6) - value(7),
            value(7),
        ]
    };
    let mut found = from(&angle);
    let turn = std::f64::consts::TAU;
    for (angle, near) in found.iter_mut().zip(near) {
        *angle += turn * ((near - *angle) / turn).round();
    }
    (found, from(&rate))
}

/// Forces at P on bodies 3, 4 and 6 in the mechanism's plane.
pub fn forces(simulation: &Simulation, orientation: &UnitQuaternion<f64>) -> [f64; 6] {
    let tip = orientation.inverse() * simulation.state().orientations[1];
    let mut forces = [0.0; 6];
    for joint in 0..3 {
        let lambda = &simulation.lambda()[5 * joint..];
        let world = tip * Vector3::new(lambda[0], lambda[1], 0.0);
        forces[2 * joint] = world.x;
        forces[2 * joint + 1] = world.y;
    }
    forces
}
