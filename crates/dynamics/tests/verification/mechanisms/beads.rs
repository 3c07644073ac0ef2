//! A row of masses inside one force element, against the same made of bodies.

use std::ops::ControlFlow;

use gearmesh_dynamics::elements::{ForceElement, Loads, Power, View};
use gearmesh_dynamics::{
    Body, BodyId, ElementFailure, LinearSolver, Params, Simulation, StaticParams, System, Unknown,
    equilibrium, natural_modes,
};

use crate::mechanisms::own_coordinates::{MASS_KG, push, run};

/// A row of masses along x, each on springs to its neighbours, the last to the body; inside the element or as bodies.
pub struct Beads {
    pub bodies: Vec<BodyId>,
    pub inside: usize,
    pub stiffness: f64,
    pub mass_kg: f64,
}

impl Beads {
    /// Local places of the masses from the ground on, the last that of the body.
    fn places(&self, starts: &[usize]) -> Vec<usize> {
        let (own, bodies) = (starts[starts.len() - 1], &starts[..starts.len() - 1]);
        (own..own + self.inside)
            .chain(bodies.iter().copied())
            .collect()
    }
}

impl ForceElement for Beads {
    fn name(&self) -> &str {
        "beads"
    }

    fn bodies(&self) -> &[BodyId] {
        &self.bodies
    }

    fn unknowns(&self) -> Vec<Unknown> {
        let bead = |i: usize| Unknown::inertial(&format!("bead_{i}_m"), self.mass_kg, 1e-3);
        (0..self.inside).map(bead).collect()
    }

    fn couplings(&self, starts: &[usize]) -> Vec<Vec<usize>> {
        let places = self.places(starts);
        let pairs = places.windows(2).map(<[usize]>::to_vec);
        pairs
            .chain(places.first().map(|first| vec![*first]))
            .collect()
    }

    fn evaluate(&mut self, view: &View<'_>, loads: &mut Loads) -> Result<(), ElementFailure> {
        let places = self.places(loads.starts());
        let of_bodies = self.bodies.iter().map(|&body| view.body(body).position_m.x);
        let places_m: Vec<f64> = view.unknowns().iter().copied().chain(of_bodies).collect();
        let mut stored_j = 0.0;
        let k = self.stiffness;
        for i in 0..places.len() {
            let before = if i == 0 { 0.0 } else { places_m[i - 1] };
            let pull = k * (places_m[i] - before);
            stored_j += 0.5 * pull * pull / k;
            loads.add_force(places[i], &[-pull]);
            loads.add_by_position(places[i], places[i], -k);
            if i > 0 {
                loads.add_force(places[i - 1], &[pull]);
                loads.add_by_position(places[i - 1], places[i - 1], -k);
                loads.add_by_position(places[i - 1], places[i], k);
                loads.add_by_position(places[i], places[i - 1], k);
            }
        }
        loads.power = Power {
            stored_j,
            ..Power::default()
        };
        Ok(())
    }
}

/// A mass inside an element is the same as a body that only its spring moves: path, energy, equilibrium and
/// frequencies.
#[test]
fn a_mass_inside_an_element_is_a_body() {
    let (mass_kg, stiffness) = (0.5, 600.0);
    let system = |inside: bool| {
        let mut builder = System::builder();
        let mut bodies = Vec::new();
        if !inside {
            let bead = Body::rigid("bead", mass_kg, [1.0; 3]);
            bodies.push(builder.body(bead).unwrap());
        }
        let mut body = Body::rigid("body", MASS_KG, [1.0; 3]);
        body.position_m.x = 0.02;
        bodies.push(builder.body(body).unwrap());
        builder.boxed_element(push(bodies[bodies.len() - 1], 2.0));
        builder.element(Beads {
            bodies,
            inside: usize::from(inside),
            stiffness,
            mass_kg,
        });
        builder.build().unwrap()
    };
    let [own, body] = [true, false].map(|inside| run(system(inside), Params::fixed(1e-3), 1.0));
    let bead = |run: &Simulation| match run.state().unknowns.first() {
        Some(u) => *u,
        None => run.state().positions_m[0].x,
    };
    let last = |run: &Simulation| run.state().positions_m.last().unwrap().x;
    assert!((bead(&own) - bead(&body)).abs() < 1e-11);
    assert!((last(&own) - last(&body)).abs() < 1e-11);
    let [a, b] = [&own, &body].map(|run| run.info().energy);
    assert!((a.last.kinetic_j - b.last.kinetic_j).abs() < 1e-10);
    assert!(
        (a.work_j / b.work_j - 1.0).abs() < 1e-9,
        "{} {}",
        a.work_j,
        b.work_j
    );
    let at_rest = [true, false].map(|inside| {
        let mut system = system(inside);
        let start = system.start().clone();
        let found = equilibrium(&mut system, &start, &StaticParams::default()).unwrap();
        let modes = natural_modes(&mut system, &found.state).unwrap();
        let ends = modes
            .iter()
            .rev()
            .map(|mode| mode.angular_frequency_rad_per_s);
        let x = found.state.positions_m.last().unwrap().x;
        (x, ends.take(2).collect::<Vec<_>>())
    });
    assert!((at_rest[0].0 - 2.0 * 2.0 / stiffness).abs() < 1e-12);
    for (a, b) in at_rest[0].1.iter().zip(&at_rest[1].1) {
        assert!((a / b - 1.0).abs() < 1e-11, "{at_rest:?}");
    }
}

/// Hundreds of coordinates in one element make a sparse matrix where it says which meet; n masses between the ground
/// and a free end have ω_j = 2 √(k/m) sin((2j − 1)π/(4n + 2)).
#[test]
fn an_element_with_hundreds_of_coordinates_is_sparse() {
    let system = |inside: usize| {
        let mut builder = System::builder();
        builder.element(Beads {
            bodies: Vec::new(),
            inside,
            stiffness: 1e4,
            mass_kg: 0.01,
        });
        builder.build().unwrap()
    };
    let mut small = system(40);
    let start = small.start().clone();
    let modes = natural_modes(&mut small, &start).unwrap();
    for (j, mode) in modes.iter().enumerate() {
        let half = (2 * j + 1) as f64 * std::f64::consts::PI / 162.0;
        let omega = 2.0 * (1e4_f64 / 0.01).sqrt() * half.sin();
        assert!((mode.angular_frequency_rad_per_s / omega - 1.0).abs() < 1e-11);
    }
    let paths = [LinearSolver::Automatic, LinearSolver::Dense].map(|linear_solver| {
        let params = Params {
            linear_solver,
            ..Params::fixed(1e-4)
        };
        let mut begun = Simulation::new(system(300), params)
            .unwrap()
            .state()
            .clone();
        begun.velocity[299] = 1.0;
        let mut simulation = Simulation::from_state(system(300), begun, params).unwrap();
        simulation.run(0.01, |_| ControlFlow::Continue(())).unwrap();
        (simulation.state().unknowns.clone(), *simulation.info())
    });
    assert!(paths[0].1.pivotings == 1 && paths[1].1.pivotings == 0);
    let apart = paths[0]
        .0
        .iter()
        .zip(&paths[1].0)
        .map(|(a, b)| (a - b).abs());
    assert!(apart.fold(0.0, f64::max) < 1e-13);
    assert!(paths[0].0[299].abs() > 1e-4);
}
