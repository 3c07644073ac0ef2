//! A sweep through the resonance of an oscillator with stops: the response jumps at another speed on the way up than on
//! the way down.
//!
//! A carriage on a spring carries a rotor out of balance, whose speed is prescribed; beyond a clearance on either side
//! stops add to the stiffness. By harmonic balance, an amplitude A at the speed ω satisfies
//!
//! ```text
//! (k(A) − M ω²)² + (c ω)² = (m e ω²/A)²,     k(A) = k₀ + k₁ (2/π) (arccos(b/A) − (b/A) √(1 − (b/A)²)) beyond b
//! ```

use crate::system_runs;

use std::f64::consts::PI;

use gearmesh_dynamics::{
    Body, BodyId, Joint, JointKind, Marker, MarkerPair, Motion, Params, System, TimeFunction,
};
use gearmesh_dynamics::{ElementFailure, ForceElement, Loads, View};
use gearmesh_scene::system_run::*;
use gearmesh_specification::system::run::{Direction, Schedule, SpeedSweep};
use gearmesh_specification::system::solver::Start;
use system_runs::*;

const MASS: f64 = 1.0;
const UNBALANCE: f64 = 1.6e-4;
const STIFFNESS: f64 = 1e4;
const DAMPING: f64 = 8.0;
const STOP: f64 = 2e4;

/// Spring, damper and stops along x of one body.
struct Stops {
    body: [BodyId; 1],
    clearance_m: f64,
}

impl ForceElement for Stops {
    fn name(&self) -> &str {
        "stops"
    }

    fn bodies(&self) -> &[BodyId] {
        &self.body
    }

    fn evaluate(&mut self, view: &View<'_>, loads: &mut Loads) -> Result<(), ElementFailure> {
        let motion = view.body(self.body[0]);
        let (x, v) = (motion.position_m[0], motion.velocity_m_per_s[0]);
        let beyond = x - x.clamp(-self.clearance_m, self.clearance_m);
        loads.add_force(0, &[-STIFFNESS * x - STOP * beyond - DAMPING * v]);
        let stiffness = STIFFNESS + if beyond == 0.0 { 0.0 } else { STOP };
        loads.add_by_position(0, 0, -stiffness);
        loads.add_by_velocity(0, 0, -DAMPING);
        loads.power.stored_j = 0.5 * (STIFFNESS * x * x + STOP * beyond * beyond);
        loads.power.dissipated_w = DAMPING * v * v;
        Ok(())
    }
}

fn oscillator(clearance_m: f64, speed: TimeFunction) -> System {
    let mut builder = System::builder();
    let carriage = builder
        .body(Body::rigid("carriage", MASS - 0.1, [1e-3; 3]))
        .unwrap();
    let mut rotor = Body::rigid("rotor", 0.1, [1e-5; 3]);
    rotor.center_of_mass_m.x = UNBALANCE / 0.1;
    let rotor = builder.body(rotor).unwrap();
    let slide = Joint::new(
        "slide",
        JointKind::Prismatic,
        Marker::ground([0.0; 3]).along([1.0, 0.0, 0.0]),
        Marker::at(carriage, [0.0; 3]).along([1.0, 0.0, 0.0]),
    );
    builder.joint(slide.unwrap());
    let axle = MarkerPair {
        a: Marker::at(carriage, [0.0; 3]),
        b: Marker::at(rotor, [0.0; 3]),
    };
    for (name, kind) in [
        ("axle", JointKind::Revolute),
        ("driver", JointKind::Rotation(Motion::Speed(speed))),
    ] {
        builder.joint(Joint::new(name, kind, axle.a, axle.b).unwrap());
    }
    builder.element(Stops {
        body: [carriage],
        clearance_m,
    });
    builder.build().unwrap()
}

/// Speed, way and amplitude of every window.
type Amplitudes = Vec<(f64, bool, f64)>;

fn sweep(
    clearance_m: f64,
    speeds: (f64, f64, usize),
    (step_s, settle_s): (f64, f64),
) -> (SystemResult, Amplitudes) {
    let plan = SpeedPlan::new(&SpeedSweep {
        motion: "driver".to_owned(),
        from_rad_per_s: speeds.0,
        to_rad_per_s: speeds.1,
        direction: Direction::UpDown,
        schedule: Schedule::Stepped {
            speeds: speeds.2,
            settle_s,
            measure_s: 0.3,
        },
    });
    let system = oscillator(clearance_m, plan.function().unwrap());
    let kind = RunKind::SpeedSweep(InTime {
        params: Params::fixed(step_s),
        start: Start::AsGiven,
        end_s: plan.end_s(),
        interval_s: 1e-3,
        statistics_from_s: 0.0,
        windows: plan.windows().to_vec(),
    });
    let desk = Desk::new();
    let result = desk.run(job(system, kind));
    let found = result.sweep.as_ref().unwrap();
    let x = found
        .columns
        .iter()
        .position(|column| column.name == "bodies/carriage/x_m")
        .unwrap();
    let amplitude = |(window, figures): (&Window, &Vec<Figures>)| {
        let amplitude = 0.5 * figures[x].peak_to_peak();
        (window.speed_rad_per_s, window.up, amplitude)
    };
    let amplitudes = found.windows.iter().zip(&found.figures).map(amplitude);
    let amplitudes = amplitudes.collect();
    (result, amplitudes)
}

/// Without stops the amplitude is m e ω²/√((k − Mω²)² + (cω)²), up and down alike.
#[test]
fn a_linear_sweep_gives_the_closed_form_both_ways() {
    let (result, amplitudes) = sweep(1.0, (70.0, 150.0, 9), (5e-4, 2.2));
    assert_eq!(amplitudes.len(), 18);
    for (omega, up, amplitude) in amplitudes {
        let expected =
            UNBALANCE * omega * omega / (STIFFNESS - MASS * omega * omega).hypot(DAMPING * omega);
        let error = amplitude / expected - 1.0;
        assert!(error.abs() < 0.01, "{error} at {omega} rad/s, up: {up}");
    }
    let record = result.record.unwrap();
    assert!((record.simulated_s - 18.0 * 2.5).abs() < 1e-3);
    assert_eq!(result.rows.rows(), 0);
}

/// Amplitudes that satisfy the harmonic balance at a speed.
fn balanced(omega: f64, clearance: f64) -> Vec<f64> {
    let residual = |a: f64| {
        let stops = if a > clearance {
            let s = clearance / a;
            STOP * 2.0 / PI * (s.acos() - s * (1.0 - s * s).sqrt())
        } else {
            0.0
        };
        (STIFFNESS + stops - MASS * omega * omega).hypot(DAMPING * omega) * a
            - UNBALANCE * omega * omega
    };
    let grid: Vec<f64> = (1..20_000).map(|i| 1e-6 * f64::from(i)).collect();
    let crossings = grid
        .windows(2)
        .filter(|w| residual(w[0]) * residual(w[1]) <= 0.0);
    crossings.map(|w| w[0]).collect()
}

/// The stops bend the resonance to higher speeds: on the way up the response stays on the upper branch until it ends,
/// on the way down it stays below until the lower branch ends.
#[test]
fn a_response_with_stops_jumps_at_other_speeds_up_than_down() {
    let clearance = 1e-3;
    let (_, amplitudes) = sweep(clearance, (100.0, 170.0, 36), (1e-3, 1.2));
    let jump = |up: bool| {
        let leg: Vec<_> = amplitudes.iter().filter(|a| a.1 == up).collect();
        let ratio = |w: &[&(f64, bool, f64)]| (w[0].2 / w[1].2).ln().abs();
        let at = (1..leg.len())
            .max_by(|&i, &j| ratio(&leg[i - 1..=i]).total_cmp(&ratio(&leg[j - 1..=j])))
            .unwrap();
        (0.5 * (leg[at - 1].0 + leg[at].0), ratio(&leg[at - 1..=at]))
    };
    let ((down_at, drop), (up_at, rise)) = (jump(true), jump(false));
    // Ends of the range with three amplitudes.
    let several: Vec<f64> = (1000..1700)
        .map(|i| 0.1 * f64::from(i))
        .filter(|omega| balanced(*omega, clearance).len() >= 3)
        .collect();
    let (lower, upper) = (several[0], several[several.len() - 1]);
    assert!(
        drop > 0.7 && rise > 0.2,
        "no jump: {drop} {rise} {amplitudes:?}"
    );
    assert!(down_at > up_at + 4.0, "{down_at} {up_at}");
    assert!(
        (down_at - upper).abs() < 3.0,
        "up to {down_at}, balance {upper}"
    );
    assert!(
        (up_at - lower).abs() < 3.0,
        "down to {up_at}, balance {lower}"
    );
}
