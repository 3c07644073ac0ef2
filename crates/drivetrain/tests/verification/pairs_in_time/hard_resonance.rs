//! A lightly damped pair with backlash through its resonances, against the oscillator that it must be:
//!
//! ```text
//! m ẍ = F (1 + B cos Ωt) − N,   N = k (1 + A cos Ωt) x + c ẋ  where x > 0 and N > 0, else 0          m = I₂/r_b2²,  Ω = z₁ ω₁
//! ```
//!
//! solved here by the classical Runge-Kutta rule, but for A = 0, where its loss of contact has a closed form. The
//! oscillator, its softening jump, its super- and subharmonics: A. Kahraman, R. Singh, J. Sound Vib. 142 (1990) 49-75
//! and 146 (1991) 135-156; G. W. Blankenship, A. Kahraman, J. Sound Vib. 185 (1995) 743-765.

use std::f64::consts::TAU;

use gearmesh_drivetrain::*;
use gearmesh_dynamics::{Params, Simulation, TimeFunction};
use gearmesh_geometry::{Flank, GearPair};

use crate::mesh_common::spur_pair;
use crate::pairs_in_time::scene::*;

const STIFFNESS: f64 = 3e8;
const TORQUE: f64 = 60.0;
/// Depth at which damping is full \[m\]: hardly any.
const FULL_DEPTH: f64 = 1e-8;

/// The pair as an oscillator.
struct Oscillator {
    mass: f64,
    force: f64,
    damping: f64,
    amplitude: f64,
    /// B
    load_amplitude: f64,
}

/// Over the last mesh periods: peak to peak of x \[m\], least force \[N\], and the amplitudes \[m\] of ½, 1 and 2 times
/// the mesh frequency.
#[derive(Debug, Clone, Copy)]
struct Response {
    swing_m: f64,
    least_n: f64,
    lines_m: [f64; 3],
}

/// Where a run ends: (x, ẋ).
type End = [f64; 2];

impl Response {
    /// Of samples over a whole, even number of periods.
    fn of(samples: &[(f64, f64)], periods: usize) -> Self {
        let n = samples.len();
        let x = || samples.iter().map(|s| s.0);
        let line = |order: f64| {
            let (mut re, mut im) = (0.0, 0.0);
            for (k, value) in x().enumerate() {
                let (s, c) = (TAU * order * (periods * k) as f64 / n as f64).sin_cos();
                re += value * c;
                im += value * s;
            }
            2.0 * re.hypot(im) / n as f64
        };
        Self {
            swing_m: x().fold(f64::MIN, f64::max) - x().fold(f64::MAX, f64::min),
            least_n: samples.iter().map(|s| s.1).fold(f64::MAX, f64::min),
            lines_m: [0.5, 1.0, 2.0].map(line),
        }
    }
}

impl Oscillator {
    fn new(scene: &Scene<'_>, damping_ratio: f64, amplitude: f64) -> Self {
        let mass = scene.mass_2_kg();
        Self {
            mass,
            force: TORQUE / scene.pair.gear_2.base_radius_m,
            damping: 2.0 * damping_ratio * (STIFFNESS * mass).sqrt(),
            amplitude,
            load_amplitude: 0.0,
        }
    }

    fn natural_rad_per_s(&self) -> f64 {
        (STIFFNESS / self.mass).sqrt()
    }

    fn at_rest(&self) -> End {
        [self.force / STIFFNESS, 0.0]
    }

    fn normal_n(&self, phase: f64, [x, v]: End) -> f64 {
        if x <= 0.0 {
            return 0.0;
        }
        let damping = self.damping * step::step(x, [0.0, 0.0], [FULL_DEPTH, 1.0]).0;
        (STIFFNESS * (1.0 + self.amplitude * phase.cos()) * x + damping * v).max(0.0)
    }

    /// By Runge-Kutta from phase 0: `settle` periods, then `watch` to look at.
    fn alone(&self, ratio: f64, (settle, watch): (usize, usize), start: End) -> (Response, End) {
        let steps = 800;
        let omega = ratio * self.natural_rad_per_s();
        let h = TAU / omega / f64::from(steps);
        let force = |t: f64| self.force * (1.0 + self.load_amplitude * (omega * t).cos());
        let rate = |t: f64, y: End| [y[1], (force(t) - self.normal_n(omega * t, y)) / self.mass];
        let moved = |y: End, k: End, h: f64| [y[0] + h * k[0], y[1] + h * k[1]];
        let mut y = start;
        let mut samples = Vec::new();
        for period in 0..settle + watch {
            for step in 0..steps {
                let t = f64::from(step) * h;
                let k1 = rate(t, y);
                let k2 = rate(t + 0.5 * h, moved(y, k1, 0.5 * h));
                let k3 = rate(t + 0.5 * h, moved(y, k2, 0.5 * h));
                let k4 = rate(t + h, moved(y, k3, h));
                for i in 0..2 {
                    y[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
                }
                if period >= settle {
                    samples.push((y[0], self.normal_n(omega * (t + h), y)));
                }
            }
        }
        (Response::of(&samples, watch), y)
    }

    /// The same by two gears in space.
    fn as_gears(
        &self,
        pair: &GearPair,
        ratio: f64,
        (settle, watch): (usize, usize),
        start: End,
    ) -> (Response, End) {
        // 80 to a period of the pair's own at least.
        let steps = (80.0 / ratio).ceil().max(80.0);
        let omega = ratio * self.natural_rad_per_s();
        let step_s = TAU / omega / steps;
        let middle = pair.working_pressure_angle_rad.tan();
        let teeth = pair.gear_1.teeth;
        let spring = MeshSpring::new(STIFFNESS, 1, middle).unwrap();
        let spring = spring.with_sine(self.amplitude, middle, teeth).unwrap();
        let damping = Damping::Viscous {
            coefficient_n_s_per_m: self.damping,
            full_depth_m: FULL_DEPTH,
        };
        let damped = || Damped::new(spring.clone(), damping, 1).unwrap();
        let gears = [pair.gear_1.clone(), pair.gear_2.clone()];
        let (none, a) = ([Vec::new(), Vec::new()], pair.centre_distance_m);
        let kinematics = MeshKinematics::new(
            gears,
            none,
            a,
            crate::mesh_common::layout(1),
            PathEnds::Extended,
        )
        .unwrap();
        let mesh = GearMesh::new(kinematics, Flank::Right, damped())
            .unwrap()
            .with_side(Flank::Left, damped())
            .unwrap();
        let scene = Scene {
            te_m: -start[0],
            te_rate_m_per_s: -start[1],
            ..Scene::new(pair)
                .driven_at(omega / teeth as f64)
                .loaded_by(TORQUE)
        };
        let scene = Scene {
            torque_2: Some(TimeFunction::Sine {
                offset: TORQUE,
                amplitude: self.load_amplitude * TORQUE,
                frequency_hz: omega / TAU,
                phase_rad: 0.25 * TAU,
            }),
            ..scene
        };
        let params = Params {
            rho_infinity: 0.95,
            ..Params::fixed(step_s)
        };
        let mut run = Simulation::new(scene.system(mesh), params).unwrap();
        let period = TAU / omega;
        run.run(settle as f64 * period, |_| {
            std::ops::ControlFlow::Continue(())
        })
        .unwrap();
        let samples = record_on(&mut run, (settle + watch) as f64 * period);
        assert!(samples.iter().all(|s| s.left_n == 0.0));
        let [r1, r2] = [&pair.gear_1, &pair.gear_2].map(|g| g.base_radius_m);
        let [w1, w2] = speeds(run.state());
        let end = [-samples.last().unwrap().te_m, r1 * w1 - r2 * w2];
        let samples: Vec<_> = samples.iter().map(|s| (-s.te_m, s.right_n)).collect();
        (Response::of(&samples, watch), end)
    }
}

/// A small variation of the stiffness: amplitude A F/k over √((1 − Λ²)² + (2ζΛ)²), largest at √(k/m).
#[test]
fn the_primary_resonance() {
    let pair = spur_pair();
    let (zeta, amplitude) = (0.05, 0.002);
    let oscillator = Oscillator::new(&Scene::new(&pair), zeta, amplitude);
    let still = oscillator.at_rest();
    for ratio in [0.7_f64, 0.9, 1.0, 1.1] {
        let (response, _) = oscillator.as_gears(&pair, ratio, (40, 4), still);
        let expected = amplitude * still[0] / (1.0 - ratio * ratio).hypot(2.0 * zeta * ratio);
        let error = response.lines_m[1] / expected - 1.0;
        println!(
            "mesh frequency {ratio:.1} of the natural one: amplitude {:.3e} m, closed form {expected:.3e} m, off by {error:+.1e} (allowed 8e-3)",
            response.lines_m[1]
        );
        assert!(error.abs() < 8e-3, "{ratio} {error} {response:?}");
    }
}

/// Sweeps down and up through the main resonance. The resonance leans to lower speeds because the pair lifts off: it
/// jumps up at another speed than down, and both branches are the oscillator's.
#[test]
fn jumps_and_loss_of_contact() {
    let pair = spur_pair();
    let oscillator = Oscillator::new(&Scene::new(&pair), 0.03, 0.1);
    let ratios: Vec<f64> = (0..13).map(|k| 1.1 - 0.03 * f64::from(k)).collect();
    let sweep = |solve: &dyn Fn(f64, End) -> (Response, End), up: bool| {
        let mut end = oscillator.at_rest();
        let mut found: Vec<Response> = Vec::new();
        let n = ratios.len();
        for k in 0..n {
            let ratio = ratios[if up { n - 1 - k } else { k }];
            let (response, last) = solve(ratio, end);
            end = last;
            found.push(response);
        }
        if up {
            found.reverse();
        }
        found
    };
    let periods = (60, 4);
    let alone = |ratio: f64, start: End| oscillator.alone(ratio, periods, start);
    let gears = |ratio: f64, start: End| oscillator.as_gears(&pair, ratio, periods, start);
    let [down, up] = [false, true].map(|up| {
        let (expected, found) = (sweep(&alone, up), sweep(&gears, up));
        for ((ratio, e), f) in ratios.iter().zip(&expected).zip(&found) {
            let error = f.swing_m / e.swing_m - 1.0;
            println!(
                "up {up} {ratio:.2} {:e} {error:+.4} {}",
                f.swing_m, f.least_n
            );
            assert!(error.abs() < 1e-2, "up {up} {ratio} {e:?} {f:?}");
            assert_eq!(e.least_n == 0.0, f.least_n == 0.0, "{ratio} {e:?} {f:?}");
        }
        found
    });
    // Both branches between the jumps: down between 0.80 and 0.83, up between 0.95 and 0.98.
    for ((ratio, down), up) in ratios.iter().zip(&down).zip(&up) {
        let two_branches = (0.81..0.97).contains(ratio);
        let apart = down.swing_m / up.swing_m - 1.0;
        assert!(
            (apart > 0.3) == two_branches && (two_branches || apart.abs() < 1e-3),
            "{ratio} {apart}"
        );
    }
}

/// With a constant stiffness and a torque that varies the pair is linear until it lifts off, which it does where the
/// varying part of the force has grown to the mean one:
///
/// ```text
/// B² (1 + 4ζ²Λ²) = (1 − Λ²)² + 4ζ²Λ²
/// ```
///
/// One per cent above it jumps up, because the resonance of lifting teeth leans to lower speeds (Comparin and Singh, J.
/// Sound Vib. 134 (1989) 259-290).
#[test]
fn linear_teeth_lift_off_where_they_must_and_then_jump() {
    let pair = spur_pair();
    let (zeta, load_amplitude) = (0.03, 0.3);
    let oscillator = Oscillator {
        load_amplitude,
        ..Oscillator::new(&Scene::new(&pair), zeta, 0.0)
    };
    // A quadratic equation for y = Λ², its lower root: y² − 2 p y + q = 0.
    let (b, z) = (load_amplitude * load_amplitude, 4.0 * zeta * zeta);
    let (p, q) = (1.0 - 0.5 * z * (1.0 - b), 1.0 - b);
    let lift_off = (p - (p * p - q).sqrt()).sqrt();
    assert!((0.83..0.85).contains(&lift_off), "{lift_off}");
    // x and ẋ at phase 0 of x = F/k (1 + B Re(H exp iΩt)), H = 1/(1 − Λ² + 2iζΛ), and its swing.
    let linear = |ratio: f64| {
        let still = oscillator.at_rest()[0];
        let (re, im) = (1.0 - ratio * ratio, 2.0 * zeta * ratio);
        let square = re * re + im * im;
        let omega = ratio * oscillator.natural_rad_per_s();
        let rate = omega * still * load_amplitude * im / square;
        let start = [still * (1.0 + load_amplitude * re / square), rate];
        (start, 2.0 * still * load_amplitude / square.sqrt())
    };
    // From the linear motion, not from rest: its transient would lift off at once.
    let (mut end, _) = linear(0.96 * lift_off);
    for share in [0.96, 0.98, 0.99, 0.995, 1.0025, 1.015] {
        let ratio = share * lift_off;
        let (_, linear_swing) = linear(ratio);
        let (found, last) = oscillator.as_gears(&pair, ratio, (120, 4), end);
        end = last;
        let swing = found.swing_m / linear_swing;
        let dynamic = 0.5 * linear_swing * STIFFNESS * 1.0_f64.hypot(2.0 * zeta * ratio);
        let least = (oscillator.force - dynamic) / oscillator.force;
        println!(
            "{share} {swing:.4} {:.4} {least:.4}",
            found.least_n / oscillator.force
        );
        if share < 1.0 {
            assert!((swing - 1.0).abs() < 3e-3, "{share} {swing}");
            assert!(
                (found.least_n / oscillator.force - least).abs() < 3e-3,
                "{share} {found:?}"
            );
        } else {
            assert_eq!(found.least_n, 0.0);
            assert_eq!(swing > 2.0, share > 1.01, "{share} {swing}");
        }
    }
}

/// Near half of the natural frequency the second order resonates, near twice of it the half order grows until the teeth
/// lift off.
#[test]
fn superharmonic_and_subharmonic() {
    let pair = spur_pair();
    let oscillator = Oscillator::new(&Scene::new(&pair), 0.02, 0.3);
    for ratio in [0.45, 0.48, 0.5, 0.52, 1.8, 2.0, 2.1] {
        let start = [1.1 * oscillator.at_rest()[0], 0.0];
        let (expected, _) = oscillator.alone(ratio, (120, 4), start);
        let (found, _) = oscillator.as_gears(&pair, ratio, (120, 4), start);
        let errors = [0, 1, 2].map(|i| {
            let largest = expected
                .lines_m
                .iter()
                .fold(0.0_f64, |most, x| most.max(*x));
            (found.lines_m[i] - expected.lines_m[i]) / largest
        });
        println!("{ratio} {errors:?} {found:?}");
        assert!(
            errors.iter().all(|e| e.abs() < 2e-2),
            "{ratio} {expected:?} {found:?}"
        );
        let [half, first, second] = found.lines_m;
        match ratio {
            0.5 => assert!(second > 2.0 * first && found.least_n == 0.0),
            1.8 => assert!(half < 1e-3 * first),
            2.0..2.2 => assert!(half > 5.0 * first && found.least_n == 0.0),
            _ => assert!(half < 1e-6 * first),
        }
    }
}
