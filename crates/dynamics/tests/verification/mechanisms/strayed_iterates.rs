//! Elements whose model ends somewhere: iterates that go beyond cost shorter ways, not the run.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use gearmesh_dynamics::elements::{AppliedLoad, Axes, LoadKind};
use gearmesh_dynamics::{
    Body, BodyId, DynamicsError, ElementFailure, ForceElement, Loads, Params, Simulation, System,
    TimeFunction, View,
};

/// A force along x that depends on the place, and is known up to some place.
struct Law {
    body: [BodyId; 1],
    /// Force \[N\] over x \[m\], and its derivative.
    force: fn(f64) -> [f64; 2],
    /// Least and largest x \[m\], and latest time \[s\], for which it is known.
    known: ([f64; 2], f64),
    calls: Arc<AtomicU64>,
}

impl ForceElement for Law {
    fn name(&self) -> &str {
        "law"
    }

    fn bodies(&self) -> &[BodyId] {
        &self.body
    }

    fn evaluate(&mut self, view: &View<'_>, loads: &mut Loads) -> Result<(), ElementFailure> {
        self.calls.fetch_add(1, Ordering::Relaxed);
        let x = view.body(self.body[0]).position_m.x;
        let ([low_m, high_m], until_s) = self.known;
        if !(low_m..=high_m).contains(&x) || view.time_s > until_s {
            return Err(format!("no law at x = {x:.3e} m").into());
        }
        let [force, slope] = (self.force)(x);
        loads.add_force(0, &[force]);
        loads.add_by_position(0, 0, slope);
        Ok(())
    }
}

/// A body on its way along x under such a law, and how often the law was asked.
fn system(
    (mass_kg, x_m, speed_m_per_s): (f64, f64, f64),
    force: fn(f64) -> [f64; 2],
    known: ([f64; 2], f64),
    load: Option<TimeFunction>,
) -> (System, Arc<AtomicU64>) {
    let mut builder = System::builder();
    let mut body = Body::rigid("body", mass_kg, [1.0; 3]);
    body.position_m.x = x_m;
    body.velocity_m_per_s.x = speed_m_per_s;
    let id = builder.body(body).unwrap();
    let calls = Arc::new(AtomicU64::new(0));
    if let Some(load) = load {
        let along = (Axes::World, [1.0, 0.0, 0.0]);
        builder.element(
            AppliedLoad::new(
                "load",
                id,
                LoadKind::Force { point_m: [0.0; 3] },
                along,
                load,
            )
            .unwrap(),
        );
    }
    builder.element(Law {
        body: [id],
        force,
        known,
        calls: Arc::clone(&calls),
    });
    (builder.build().unwrap(), calls)
}

/// A stop at x = 0.
fn stop(x: f64) -> [f64; 2] {
    let stiffness = 1e8;
    if x > 0.0 {
        [-stiffness * x, -stiffness]
    } else {
        [0.0, 0.0]
    }
}

/// The first guess of a step is a millimetre deep in a stop whose law ends at 0.3 mm, as the body itself never goes: it
/// is met in parts of the step, at the first steps of a run as later.
#[test]
fn a_guess_beyond_the_law_is_made_in_parts() {
    for before in [2.5e-3, 0.0505] {
        let (system, _) = system((1.0, -before, 1.0), stop, ([-1.0, 3e-4], 1.0), None);
        let mut run = Simulation::new(system, Params::fixed(1e-3)).unwrap();
        run.run(before + 0.1, |_| ControlFlow::Continue(()))
            .unwrap();
        let state = run.state();
        // Thrown back; how fast is not for steps to say that are as long as the blow.
        assert!(state.velocity[0] < -0.3, "{state:?}");
        assert!(state.positions_m[0].x < 0.0, "{state:?}");
        let info = run.info();
        assert!(
            info.unconverged > 0 && info.step_range_s.0 < 1e-3,
            "{info:?}"
        );
        assert!(info.steps < 250, "{info:?}");
    }
}

/// A spring that deflects: 10 N at most. Newton's whole correction from where it has hardly any stiffness left goes far
/// beyond where it is known.
fn soft(x: f64) -> [f64; 2] {
    let (most_n, width_m) = (10.0 * std::f64::consts::FRAC_2_PI, 1e-4);
    let ratio = x / width_m;
    [
        -most_n * ratio.atan(),
        -most_n / (width_m * (1.0 + ratio * ratio)),
    ]
}

#[test]
fn a_correction_beyond_the_law_is_damped() {
    let width_m = 1e-4;
    let rest_m = width_m * (0.9 * std::f64::consts::FRAC_PI_2).tan();
    // From 9 to −9 N within a step.
    let load = TimeFunction::step(0.05, 9.0, 0.06, -9.0).unwrap();
    let body = (1e-3, rest_m, 0.0);
    let (system, calls) = system(
        body,
        soft,
        ([-60.0 * width_m, 60.0 * width_m], 1.0),
        Some(load),
    );
    let params = Params {
        rho_infinity: 0.0,
        ..Params::fixed(1e-2)
    };
    let mut run = Simulation::new(system, params).unwrap();
    run.run(0.2, |_| ControlFlow::Continue(())).unwrap();
    let x = run.state().positions_m[0].x;
    assert!((x + rest_m).abs() < 0.02 * rest_m, "{x:e} {rest_m:e}");
    assert_eq!(run.info().unconverged, 0, "{:?}", run.info());
    assert!(calls.load(Ordering::Relaxed) < 200);
}

/// What no step can do without is reported as the element has said it, and soon.
#[test]
fn an_element_that_fails_for_good_ends_the_run_with_its_words() {
    for until_s in [0.0025, 0.5] {
        let (system, calls) = system((1.0, 0.0, 1e-3), stop, ([-1.0, 1.0], until_s), None);
        let mut run = Simulation::new(system, Params::fixed(1e-3)).unwrap();
        let mut before = 0;
        let end = run.run(1.0, |_| {
            before = calls.load(Ordering::Relaxed);
            ControlFlow::Continue(())
        });
        match end {
            Err(DynamicsError::Element {
                element, source, ..
            }) => {
                assert_eq!(element, "law");
                assert!(source.to_string().contains("no law at x"), "{source}");
            }
            other => panic!("{other:?}"),
        }
        assert!(run.state().time_s > until_s - 1e-3 && run.state().time_s <= until_s);
        let asked = calls.load(Ordering::Relaxed) - before;
        assert!(asked < 40, "{asked}");
    }
}
