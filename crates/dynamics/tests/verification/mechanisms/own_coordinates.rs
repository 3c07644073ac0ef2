//! Force elements with coordinates of their own: against closed forms, and against the same made of bodies or
//! condensed.

use std::ops::ControlFlow;

use gearmesh_dynamics::elements::{AppliedLoad, Axes, ForceElement, LoadKind, Loads, View};
use gearmesh_dynamics::{
    Body, BodyId, DynamicsError, ElementFailure, GROUND, LinearSolver, Params, Simulation,
    StaticParams, System, TimeFunction, Unknown, equilibrium, natural_modes,
};

use crate::mechanisms::beads::Beads;
use crate::mechanisms::problems::maxwell::Maxwell;

pub const MASS_KG: f64 = 2.0;

/// A body at x0 with speed v0 along x under some elements.
pub fn body_under(
    x0: f64,
    v0: f64,
    elements: impl FnOnce(BodyId) -> Vec<Box<dyn ForceElement>>,
) -> System {
    let mut builder = System::builder();
    let mut body = Body::rigid("body", MASS_KG, [1.0; 3]);
    body.position_m.x = x0;
    body.velocity_m_per_s.x = v0;
    let id = builder.body(body).unwrap();
    for element in elements(id) {
        builder.boxed_element(element);
    }
    builder.build().unwrap()
}

pub fn maxwell(id: BodyId) -> Box<dyn ForceElement> {
    Box::new(Maxwell {
        body: [id],
        stiffness_n_per_m: 800.0,
        damping_n_s_per_m: 30.0,
    })
}

pub fn push(id: BodyId, force_n: f64) -> Box<dyn ForceElement> {
    let kind = LoadKind::Force { point_m: [0.0; 3] };
    let direction = (Axes::World, [1.0, 0.0, 0.0]);
    let load = AppliedLoad::new("push", id, kind, direction, TimeFunction::Constant(force_n));
    Box::new(load.unwrap())
}

pub fn run(system: System, params: Params, end_s: f64) -> Simulation {
    let mut simulation = Simulation::new(system, params).unwrap();
    let end = simulation.run(end_s, |_| ControlFlow::Continue(()));
    end.unwrap();
    simulation
}

/// e = x − u and v obey ė = v − (k/c) e, m v̇ = −k e: s² + (k/c) s + k/m = 0. Second order in the step for x and for u.
#[test]
fn a_maxwell_element_follows_its_closed_form_to_the_second_order() {
    let (k, c): (f64, f64) = (800.0, 30.0);
    let (x0, v0, t): (f64, f64, f64) = (0.01, 0.2, 0.3);
    let decay = 0.5 * k / c;
    let omega = (k / MASS_KG - decay * decay).sqrt();
    // e(0) = x0 (the damper starts at length 0), ė(0) = v0 − (k/c) x0.
    let (a, b) = (x0, (v0 - 2.0 * decay * x0 + decay * x0) / omega);
    let e = (-decay * t).exp() * (a * (omega * t).cos() + b * (omega * t).sin());
    // ∫e: from u̇ = (k/c) e and x = u + e; ∫ of the damped vibration in closed form.
    let square = decay * decay + omega * omega;
    let primitive = |t: f64| {
        let (sin, cos) = (omega * t).sin_cos();
        (-decay * t).exp() * (a * (omega * sin - decay * cos) - b * (decay * sin + omega * cos))
            / square
    };
    let u = k / c * (primitive(t) - primitive(0.0));
    let errors = |step_s: f64| {
        let simulation = run(
            body_under(x0, v0, |id| vec![maxwell(id)]),
            Params::fixed(step_s),
            t,
        );
        let state = simulation.state();
        assert!((state.time_s - t).abs() < 1e-9);
        let balance = simulation.info().energy;
        assert!(
            balance.largest_error_j < 1e-3 * balance.work_j,
            "{balance:?}"
        );
        [
            (state.positions_m[0].x - (u + e)).abs(),
            (state.unknowns[0] - u).abs(),
        ]
    };
    let (coarse, fine) = (errors(2e-3), errors(1e-3));
    for (coarse, fine) in coarse.iter().zip(&fine) {
        let order = (coarse / fine).log2();
        assert!(
            (1.8..2.2).contains(&order),
            "order {order}: {coarse:e} {fine:e}"
        );
        assert!(*fine < 3e-6, "{fine:e}");
    }
}

/// Two hardening springs in series, along x between the ground and a body, with the node between them as coordinate or
/// solved inside.
struct Series {
    body: [BodyId; 1],
    condensed: bool,
}

impl Series {
    /// Force in a spring and its slope at a stretch.
    fn spring(stiffness: f64, stretch: f64) -> (f64, f64) {
        let cubic = 1e6 * stretch * stretch;
        (
            stiffness * stretch * (1.0 + cubic),
            stiffness * (1.0 + 3.0 * cubic),
        )
    }

    fn node(&self, x: f64) -> f64 {
        let mut u = 0.5 * x;
        for _ in 0..40 {
            let ([f1, k1], [f2, k2]) = Self::both(x, u);
            u -= (f1 - f2) / (k1 + k2);
        }
        u
    }

    fn both(x: f64, u: f64) -> ([f64; 2], [f64; 2]) {
        let (first, second) = (Self::spring(500.0, u), Self::spring(900.0, x - u));
        ([first.0, first.1], [second.0, second.1])
    }
}

impl ForceElement for Series {
    fn name(&self) -> &str {
        "series"
    }

    fn bodies(&self) -> &[BodyId] {
        &self.body
    }

    fn unknowns(&self) -> Vec<Unknown> {
        let node = Unknown::equilibrium("node_m", 1e-3);
        (0..usize::from(!self.condensed))
            .map(|_| node.clone())
            .collect()
    }

    fn evaluate(&mut self, view: &View<'_>, loads: &mut Loads) -> Result<(), ElementFailure> {
        let x = view.body(self.body[0]).position_m.x;
        let u = if self.condensed {
            self.node(x)
        } else {
            view.unknowns()[0]
        };
        let ([f1, k1], [f2, k2]) = Self::both(x, u);
        loads.add_force(0, &[-f2]);
        if self.condensed {
            loads.add_by_position(0, 0, -k1 * k2 / (k1 + k2));
            return Ok(());
        }
        let own = loads.first_unknown();
        loads.add_force(own, &[f2 - f1]);
        if loads.wants_tangents() {
            loads.add_by_position(0, 0, -k2);
            loads.add_by_position(0, own, k2);
            loads.add_by_position(own, 0, k2);
            loads.add_by_position(own, own, -k1 - k2);
        }
        Ok(())
    }
}

fn series(condensed: bool) -> impl Fn(BodyId) -> Vec<Box<dyn ForceElement>> {
    move |id| {
        vec![Box::new(Series {
            body: [id],
            condensed,
        })]
    }
}

/// A node without mass moves as its condensed law says: in time, at rest and in a small vibration.
#[test]
fn an_inner_equilibrium_is_the_condensed_law() {
    for params in [Params::fixed(1e-3), Params::adaptive(1e-2, 1e-7, 1e-5)] {
        let [inner, condensed] = [false, true]
            .map(|condensed| run(body_under(2e-3, 0.1, series(condensed)), params, 0.5));
        let [a, b] = [&inner, &condensed].map(|run| run.state().positions_m[0].x);
        assert_eq!(inner.info().steps, condensed.info().steps);
        assert!((a - b).abs() < 1e-10, "{a} {b}");
        let node = Series {
            body: [GROUND],
            condensed: true,
        }
        .node(a);
        assert!((inner.state().unknowns[0] - node).abs() < 1e-10);
    }
    let at_rest = [false, true].map(|condensed| {
        let mut system = body_under(0.0, 0.0, |id| {
            let mut elements = series(condensed)(id);
            elements.push(push(id, 3.0));
            elements
        });
        let start = system.start().clone();
        let found = equilibrium(&mut system, &start, &StaticParams::default()).unwrap();
        let modes = natural_modes(&mut system, &found.state).unwrap();
        let fastest = modes.last().unwrap().angular_frequency_rad_per_s;
        (found.state.positions_m[0].x, fastest)
    });
    let [(x, omega), (x_condensed, omega_condensed)] = at_rest;
    assert!((x / x_condensed - 1.0).abs() < 1e-11, "{at_rest:?}");
    assert!((omega / omega_condensed - 1.0).abs() < 1e-9, "{at_rest:?}");
    // Both springs carry the load.
    let ([f1, _], [f2, _]) = Series::both(
        x,
        Series {
            body: [GROUND],
            condensed: true,
        }
        .node(x),
    );
    assert!((f1 - 3.0).abs() < 1e-9 && (f2 - 3.0).abs() < 1e-9);
}

/// Poles of the Maxwell element: s² + (k/c) s + k/m = 0, and the damper that may stand anywhere; at rest beside a
/// spring it carries nothing.
#[test]
fn rates_take_part_in_natural_modes_and_equilibria() {
    let mut system = body_under(0.0, 0.0, |id| vec![maxwell(id)]);
    let start = system.start().clone();
    let modes = natural_modes(&mut system, &start).unwrap();
    let vibrating: Vec<_> = modes
        .iter()
        .filter(|mode| mode.angular_frequency_rad_per_s > 1.0)
        .collect();
    assert_eq!(vibrating.len(), 1);
    let decay = 0.5 * 800.0 / 30.0;
    assert!((vibrating[0].growth_per_s + decay).abs() < 1e-8);
    let omega = (800.0_f64 / MASS_KG - decay * decay).sqrt();
    assert!((vibrating[0].angular_frequency_rad_per_s - omega).abs() < 1e-8);
    let shape = &vibrating[0].shape;
    // u = (k/c) e/s, so that |u/(x − u)| = (k/c)/|s|.
    let u = shape[6];
    let e = [shape[0][0] - u[0], shape[0][1] - u[1]];
    let ratio = u[0].hypot(u[1]) / e[0].hypot(e[1]);
    assert!(
        (ratio - 2.0 * decay / (800.0_f64 / MASS_KG).sqrt()).abs() < 1e-8,
        "{ratio}"
    );

    let mut system = body_under(0.01, 0.0, |id| {
        let spring: Box<dyn ForceElement> = Box::new(Beads {
            bodies: vec![id],
            inside: 0,
            stiffness: 500.0,
            mass_kg: 1.0,
        });
        vec![maxwell(id), spring, push(id, 4.0)]
    });
    let start = system.start().clone();
    let found = equilibrium(&mut system, &start, &StaticParams::default()).unwrap();
    assert!((found.state.positions_m[0].x - 4.0 / 500.0).abs() < 1e-11);
    assert!((found.state.unknowns[0] - 4.0 / 500.0).abs() < 1e-11);
}

/// All three kinds in one system: a run that is resumed gives the same bits.
#[test]
fn a_resumed_run_with_own_coordinates_gives_the_same_bits() {
    let system = || {
        body_under(2e-3, 0.1, |id| {
            let beads = Beads {
                bodies: vec![id],
                inside: 3,
                stiffness: 400.0,
                mass_kg: 0.1,
            };
            let mut elements = series(false)(id);
            elements.push(maxwell(id));
            elements.push(Box::new(beads));
            elements
        })
    };
    for linear_solver in [LinearSolver::Dense, LinearSolver::Sparse] {
        let params = Params {
            linear_solver,
            ..Params::fixed(1e-3)
        };
        let whole = run(system(), params, 0.4);
        let checkpoint = run(system(), params, 0.13).checkpoint();
        let mut second = Simulation::resume(system(), params, &checkpoint).unwrap();
        assert_eq!(second.checkpoint(), checkpoint);
        second.run(0.4, |_| ControlFlow::Continue(())).unwrap();
        assert_eq!(second.checkpoint(), whole.checkpoint());
    }
}

/// Couplings that leave a tangent out, a scale that is none, and an equilibrium that nothing determines are refused by
/// name.
#[test]
fn what_an_element_gets_wrong_is_named() {
    struct Wrong(f64, bool);
    impl ForceElement for Wrong {
        fn name(&self) -> &str {
            "wrong"
        }
        fn bodies(&self) -> &[BodyId] {
            &[]
        }
        fn unknowns(&self) -> Vec<Unknown> {
            vec![
                Unknown::equilibrium("first", self.0),
                Unknown::inertial("second", 1.0, 1.0),
            ]
        }
        fn couplings(&self, starts: &[usize]) -> Vec<Vec<usize>> {
            vec![vec![starts[0]]]
        }
        fn evaluate(&mut self, view: &View<'_>, loads: &mut Loads) -> Result<(), ElementFailure> {
            let all = view.unknowns();
            let slope = if self.1 { 1.0 } else { 0.0 };
            loads.add_force(0, &[-slope * (all[0] - all[1])]);
            loads.add_by_position(0, 0, -slope);
            loads.add_by_position(0, 1, slope);
            Ok(())
        }
    }
    let begin = |scale: f64, holds: bool| {
        let mut builder = System::builder();
        builder.element(Wrong(scale, holds));
        Simulation::new(builder.build()?, Params::fixed(1e-3)).map(|_| ())
    };
    let error = begin(1.0, true).unwrap_err();
    assert!(
        matches!(&error, DynamicsError::Couplings { element } if element == "wrong"),
        "{error}"
    );
    let error = begin(0.0, true).unwrap_err().to_string();
    assert!(
        error.contains("`wrong`, its `first`: scale is 0"),
        "{error}"
    );
    let error = begin(1.0, false).unwrap_err();
    assert!(matches!(error, DynamicsError::Singular { .. }), "{error}");
}
