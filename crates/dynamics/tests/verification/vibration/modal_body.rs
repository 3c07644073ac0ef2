//! A body with one vibration mode: its frequency, its momentum, its energy.

use crate::vibration::{close, origin};
use gearmesh_dynamics::elements::{AppliedLoad, Axes, LoadKind, SpringDamper};
use gearmesh_dynamics::{
    Body, GROUND, Marker, MarkerPair, Modes, Params, Simulation, System, TimeFunction,
    natural_modes,
};
use nalgebra::{DMatrix, Vector3};
use std::ops::ControlFlow;

/// A body whose mode is a mass on a spring along x: total mass 2 kg, of which 0.5 kg swing.
fn modal_body(damping_ratio: f64) -> Body {
    let (total, swinging, stiffness): (f64, f64, f64) = (2.0, 0.5, 800.0);
    let mut body = Body::rigid("modal", total, [0.2, 0.3, 0.25]);
    body.modes = Some(Modes {
        angular_frequency_rad_per_s: vec![(stiffness / swinging).sqrt()],
        damping_ratio: vec![damping_ratio],
        coupling: DMatrix::from_row_slice(1, 6, &[swinging.sqrt(), 0.0, 0.0, 0.0, 0.0, 0.0]),
    });
    body
}

#[test]
fn a_modal_body_rings_like_the_two_masses_it_stands_for() {
    let mut builder = System::builder();
    builder.body(modal_body(0.0)).unwrap();
    let mut system = builder.build().unwrap();
    let start = system.start().clone();
    let modes = natural_modes(&mut system, &start).unwrap();
    let exact = (800.0_f64 * (1.0 / 0.5 + 1.0 / 1.5)).sqrt();
    close(
        modes.last().unwrap().natural_angular_frequency_rad_per_s(),
        exact,
        1e-9,
    );
    assert!(modes[modes.len() - 2].natural_angular_frequency_rad_per_s() < 1e-6);
}

#[test]
fn a_tumbling_modal_body_keeps_momentum_and_energy() {
    let run = |steps: usize, boost: f64| {
        let mut body = modal_body(0.0);
        body.angular_velocity_rad_per_s = Vector3::new(1.0, 2.0, 0.5);
        body.velocity_m_per_s = Vector3::new(0.3 + boost, 0.0, 0.0);
        let mut builder = System::builder();
        builder.body(body).unwrap();
        let system = builder.build().unwrap();
        let mut start = system.start().clone();
        start.modal[0] = 0.02;
        let params = Params {
            rho_infinity: 1.0,
            newton_tolerance: Some(1e-12),
            ..Params::fixed(1.0 / steps as f64)
        };
        let mut simulation = Simulation::from_state(system, start, params).unwrap();
        simulation.run(1.0, |_| ControlFlow::Continue(())).unwrap();
        simulation
    };
    let [coarse, fine] = [1000, 2000].map(|steps| run(steps, 0.0).info().energy.largest_error_j);
    assert!(
        ((coarse / fine).log2() - 2.0).abs() < 0.1,
        "{coarse} {fine}"
    );
    // An observer who moves along sees the same.
    let (still, moving) = (run(1000, 0.0), run(1000, 5.0));
    let shift = moving.state().positions_m[0] - still.state().positions_m[0];
    assert!(
        (shift - Vector3::new(5.0, 0.0, 0.0)).norm() < 1e-9,
        "{shift}"
    );
    let difference = moving.state().modal[0] - still.state().modal[0];
    assert!(difference.abs() < 1e-8, "{difference}");
}

#[test]
fn the_energy_of_a_damped_vibration_is_all_accounted_for() {
    let error = |steps: usize| {
        let mut builder = System::builder();
        let mut body = modal_body(0.05);
        body.velocity_m_per_s.x = 1.0;
        let id = builder.body(body).unwrap();
        let spring = SpringDamper {
            stiffness_n_per_m: 500.0,
            damping_n_s_per_m: 3.0,
            free_length_m: 0.0,
        };
        let pair = MarkerPair {
            a: Marker::at(GROUND, [-0.3, 0.0, 0.0]),
            b: origin(id),
        };
        builder.element(spring.between("spring", pair).unwrap());
        let pull = TimeFunction::Sine {
            offset: 1.0,
            amplitude: 20.0,
            frequency_hz: 3.0,
            phase_rad: 0.0,
        };
        builder.element(
            AppliedLoad::new(
                "pull",
                id,
                LoadKind::Force { point_m: [0.0; 3] },
                (Axes::World, [1.0, 0.0, 0.0]),
                pull,
            )
            .unwrap(),
        );
        let mut simulation = Simulation::new(
            builder.build().unwrap(),
            Params::fixed(1.0 / f64::from(steps as u32)),
        )
        .unwrap();
        simulation.run(1.0, |_| ControlFlow::Continue(())).unwrap();
        let energy = simulation.info().energy;
        assert!(
            energy.dissipated_j > 0.5 && energy.supplied_j.abs() > 0.5,
            "{energy:?}"
        );
        energy.largest_error_j
    };
    let (coarse, fine) = (error(500), error(1000));
    assert!(
        ((coarse / fine).log2() - 2.0).abs() < 0.2,
        "{coarse} {fine}"
    );
}
