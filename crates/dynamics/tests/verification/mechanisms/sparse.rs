//! The sparse solver against the dense one, on mechanisms that are hard for it: closed loops, redundant equations,
//! contact that is lost.

use std::ops::ControlFlow;

use gearmesh_dynamics::elements::{ForceElement, Loads, SpringDamper, View};
use gearmesh_dynamics::{
    Body, BodyId, ElementFailure, GROUND, Joint, JointKind, LinearSolver, Marker, MarkerPair,
    Params, Simulation, System,
};
use nalgebra::{UnitQuaternion, Vector3};

use crate::mechanisms::problems::{andrews, chain};

/// Pushes two bodies apart along y while they overlap: its tangent comes and goes.
struct Stop {
    bodies: [BodyId; 2],
    stiffness: f64,
}

impl ForceElement for Stop {
    fn name(&self) -> &str {
        "stop"
    }

    fn bodies(&self) -> &[BodyId] {
        &self.bodies
    }

    fn evaluate(&mut self, view: &View<'_>, loads: &mut Loads) -> Result<(), ElementFailure> {
        let [a, b] = self.bodies.map(|body| view.body(body).position_m.y);
        let overlap = a - b;
        if overlap > 0.0 {
            // A power of two keeps the force smooth where it begins.
            let (force, slope) = (
                self.stiffness * overlap * overlap,
                2.0 * self.stiffness * overlap,
            );
            loads.add_force(1, &[-force]);
            loads.add_force(7, &[force]);
            for (row, sign) in [(1, -1.0), (7, 1.0)] {
                loads.add_by_position(row, 1, sign * slope);
                loads.add_by_position(row, 7, -sign * slope);
            }
        }
        Ok(())
    }
}

/// Two chains of links that hang side by side, tied by springs; the upper falls on the lower one again and again.
fn colliding_chains() -> System {
    let mut builder = System::builder();
    builder.gravity([0.0, -9.81, 0.0]);
    let mut rows: [Vec<BodyId>; 2] = [Vec::new(), Vec::new()];
    for (row, height_m) in rows.iter_mut().zip([0.0, 0.02]) {
        let mut before = GROUND;
        for link in 0..6 {
            let name = format!("link {link} at {height_m}");
            let mut body = Body::rigid(&name, 0.1, [1e-5, 1e-4, 1e-4]);
            body.position_m = Vector3::new(0.1 * f64::from(link) + 0.05, height_m, 0.0);
            let id = builder.body(body).unwrap();
            let end = if link == 0 {
                [0.0, height_m, 0.0]
            } else {
                [0.05, 0.0, 0.0]
            };
            let [a, b] = [Marker::at(before, end), Marker::at(id, [-0.05, 0.0, 0.0])];
            let joint = Joint::new(&format!("hinge of {name}"), JointKind::Revolute, a, b);
            builder.joint(joint.unwrap());
            if height_m == 0.0 {
                let spring = SpringDamper {
                    stiffness_n_per_m: 300.0,
                    damping_n_s_per_m: 0.2,
                    free_length_m: 0.1,
                };
                let pair = MarkerPair {
                    a: Marker::ground([0.1 * f64::from(link) + 0.05, -0.1, 0.0]),
                    b: Marker::at(id, [0.0; 3]),
                };
                builder.element(spring.between(&format!("spring of {name}"), pair).unwrap());
            }
            before = id;
            row.push(id);
        }
    }
    builder.element(Stop {
        bodies: [rows[0][5], rows[1][5]],
        stiffness: 5e5,
    });
    builder.build().unwrap()
}

fn run(system: System, solver: LinearSolver, step_s: f64, end_s: f64) -> Simulation {
    let params = Params {
        linear_solver: solver,
        ..Params::fixed(step_s)
    };
    let mut simulation = Simulation::new(system, params).unwrap();
    simulation
        .run(end_s, |_| ControlFlow::Continue(()))
        .unwrap();
    simulation
}

/// Largest differences of places \[m\], velocities and reactions, the latter two over their largest.
fn difference(a: &Simulation, b: &Simulation) -> [f64; 3] {
    let places = a.state().positions_m.iter().zip(&b.state().positions_m);
    let most = |a: &[f64], b: &[f64]| {
        let size = a.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let apart = a
            .iter()
            .zip(b)
            .fold(0.0_f64, |most, (x, y)| most.max((x - y).abs()));
        apart / size
    };
    [
        places.fold(0.0, |most, (x, y)| (x - y).norm().max(most)),
        most(&a.state().velocity, &b.state().velocity),
        most(a.lambda(), b.lambda()),
    ]
}

/// Both solvers take the same path: as many iterations and factorisations, and results that agree to rounding.
#[test]
fn sparse_and_dense_agree_to_rounding() {
    let turned = UnitQuaternion::from_scaled_axis(Vector3::new(0.3, -0.8, 0.5));
    let squeezer = || andrews::mechanism(turned, Vector3::new(0.1, 0.2, 0.3));
    assert!(!squeezer().redundant().is_empty());
    let mechanisms: [(&str, &dyn Fn() -> System, f64, f64); 3] = [
        ("squeezing mechanism", &squeezer, 1e-5, 0.01),
        ("chain", &|| chain::system(20), 1e-3, 0.05),
        ("colliding chains", &colliding_chains, 2e-4, 0.2),
    ];
    for (name, system, step_s, end_s) in mechanisms {
        let dense = run(system(), LinearSolver::Dense, step_s, end_s);
        let sparse = run(system(), LinearSolver::Sparse, step_s, end_s);
        let [a, b] = [dense.info(), sparse.info()];
        assert_eq!(a.iterations, b.iterations, "{name}");
        assert_eq!(a.factorisations, b.factorisations, "{name}");
        assert_eq!(a.pivotings, 0, "{name}");
        assert!(
            b.pivotings > 0 && b.factorisations > b.pivotings,
            "{name}: {b:?}"
        );
        let [places, velocities, reactions] = difference(&dense, &sparse);
        assert!(
            places < 1e-11 && velocities < 1e-9 && reactions < 1e-7,
            "{name}: {places:.1e} {velocities:.1e} {reactions:.1e}"
        );
    }
}

/// A chain finds its pivots once; steps need no more factorisations where it is longer, and hardly more iterations.
#[test]
fn effort_of_a_chain_does_not_grow_with_its_length() {
    let effort = |links: usize| {
        let simulation = run(chain::system(links), LinearSolver::Automatic, 1e-3, 0.02);
        let info = *simulation.info();
        (info.iterations, info.factorisations, info.pivotings)
    };
    assert_eq!(effort(20), (60, 14, 1));
    assert_eq!(effort(200), (70, 14, 1));
}

/// A run on sparse factors that is resumed gives the same bits, pivots included.
#[test]
fn a_resumed_sparse_run_gives_the_same_bits() {
    let params = Params {
        linear_solver: LinearSolver::Sparse,
        ..Params::fixed(2e-4)
    };
    let whole = run(colliding_chains(), LinearSolver::Sparse, 2e-4, 0.15);
    let first = run(colliding_chains(), LinearSolver::Sparse, 2e-4, 0.083);
    let checkpoint = first.checkpoint();
    let mut second = Simulation::resume(colliding_chains(), params, &checkpoint).unwrap();
    assert_eq!(second.checkpoint(), checkpoint);
    second.run(0.15, |_| ControlFlow::Continue(())).unwrap();
    assert_eq!(second.checkpoint(), whole.checkpoint());
}

/// Loops of joints that contradict each other, or that are singular on the way, are named whichever solver is taken.
#[test]
fn redundant_equations_of_a_long_ladder_are_named() {
    let mut builder = System::builder();
    let mut before = GROUND;
    for link in 0..40 {
        let mut body = Body::rigid(&format!("link {link}"), 0.1, [1e-5, 1e-4, 1e-4]);
        body.position_m = Vector3::new(0.1 * f64::from(link), 0.0, 0.0);
        let id = builder.body(body).unwrap();
        let start = if link == 0 { 0.0 } else { 0.1 };
        for (name, height_m) in [("lower", 0.0), ("upper", 0.3)] {
            let [a, b] = [[start, 0.0, height_m], [0.0, 0.0, height_m]];
            let joint = Joint::new(
                &format!("{name} hinge {link}"),
                JointKind::Revolute,
                Marker::at(before, a),
                Marker::at(id, b),
            );
            builder.joint(joint.unwrap());
        }
        before = id;
    }
    let system = builder.build().unwrap();
    assert_eq!(system.redundant().len(), 40);
    for (link, redundancy) in system.redundant().iter().enumerate() {
        assert_eq!(redundancy.joint, format!("upper hinge {link}"));
        assert_eq!(redundancy.implied_by, [format!("lower hinge {link}")]);
        assert_eq!(redundancy.equations, 5);
    }
}
