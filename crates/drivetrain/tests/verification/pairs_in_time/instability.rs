//! Parametric instability of a gear mesh: Meissner's equation (square wave) and Mathieu's (sine), through the
//! kinematics of the pair.
//!
//! Gear 1 turns at constant speed, so that the mesh stiffness is a function of time; a disturbance x of the loaded
//! motion obeys m ẍ + k(t) x = 0. Its map over one mesh period is found from three runs; it grows where the trace
//! exceeds 2 in magnitude.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use gearmesh_drivetrain::FlankContacts;
use gearmesh_drivetrain::*;
use gearmesh_dynamics::{Params, Simulation};
use gearmesh_geometry::{Flank, GearPair};

use crate::mesh_common::spur_pair;
use crate::pairs_in_time::scene::*;

const MEAN: f64 = 3e8;
const STEPS: usize = 400;
/// Penetration about which the pair is disturbed, and the disturbance \[m\].
const DEPTH: f64 = 50e-6;
const DISTURBANCE: f64 = 1e-8;

/// The mesh as one spring that is stiff over a part of the pitch, as with one and two pairs of teeth, and soft over the
/// rest.
struct SquareWave {
    stiff: f64,
    soft: f64,
    /// Part of the pitch with the stiff value.
    part: f64,
    /// Roll angle on gear 1 at which the stiff part begins, and the pitch \[rad\].
    begin_rad: f64,
    pitch_rad: f64,
}

impl TeethModel for SquareWave {
    fn evaluate(
        &mut self,
        flanks: &FlankContacts,
        _tangents: bool,
        loads: &mut TeethLoads,
    ) -> Result<(), DrivetrainError> {
        let Some(line) = flanks.lines.first() else {
            return Ok(());
        };
        let place = ((flanks.sections[line.section].roll_rad[0] - self.begin_rad) / self.pitch_rad)
            .rem_euclid(1.0);
        let stiffness = if place < self.part {
            self.stiff
        } else {
            self.soft
        };
        let depth = -line.ideal_gap_m;
        if depth > 0.0 {
            loads.normal_n[line.contacts.0] = stiffness * depth;
            loads.stiffness_n_per_m[line.contacts.0 * (flanks.contacts.len() + 1)] = stiffness;
        }
        Ok(())
    }

    fn resolves_teeth(&self) -> bool {
        false
    }
}

/// Trace of the map of disturbances over one mesh period, at the mesh frequency Ω = √(MEAN/m)/√δ.
fn trace(pair: &GearPair, delta: f64, teeth: &dyn Fn() -> Box<dyn TeethModel>) -> f64 {
    let mass = Scene::new(pair).mass_2_kg();
    let omega = (MEAN / mass / delta).sqrt();
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
    let run = |x: f64, v: f64| {
        let scene = Scene {
            te_m: x - DEPTH,
            te_rate_m_per_s: v,
            ..Scene::new(pair)
                .driven_at(omega / pair.gear_1.teeth as f64)
                .loaded_by(MEAN * DEPTH * pair.gear_2.base_radius_m)
        };
        let mesh = GearMesh::new(kinematics.clone(), Flank::Right, teeth()).unwrap();
        let params = Params {
            rho_infinity: 1.0,
            newton_tolerance: Some(1e-13),
            ..Params::fixed(TAU / omega / STEPS as f64)
        };
        let mut run = Simulation::new(scene.system(mesh), params).unwrap();
        run.run(TAU / omega, |_| ControlFlow::Continue(())).unwrap();
        let [r1, r2] = [&pair.gear_1, &pair.gear_2].map(|g| g.base_radius_m);
        let [w1, w2] = speeds(run.state());
        let pose = pose_of(run.state());
        let mut alone = GearMesh::new(kinematics.clone(), Flank::Right, teeth()).unwrap();
        alone.evaluate(&pose, false).unwrap();
        let te = alone.transmission_error_m().unwrap();
        assert!(te < 0.0);
        [te, r2 * w2 - r1 * w1]
    };
    let still = run(0.0, 0.0);
    let rate = omega * DISTURBANCE;
    let [by_place, by_rate] = [run(DISTURBANCE, 0.0), run(0.0, rate)];
    (by_place[0] - still[0]) / DISTURBANCE + (by_rate[1] - still[1]) / rate
}

/// Where |trace| passes 2 between two values of δ.
fn border(trace: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let unstable = |delta: f64| trace(delta).abs() > 2.0;
    let at_low = unstable(low);
    assert_ne!(at_low, unstable(high), "no border between {low} and {high}");
    for _ in 0..14 {
        let middle = 0.5 * (low + high);
        if unstable(middle) == at_low {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// Meissner's map for `part` of the period at k₊ and the rest at k₋, in closed form.
fn meissner(delta: f64, epsilon: f64, part: f64) -> f64 {
    let [a, b] = [1.0 + epsilon, 1.0 - epsilon].map(|k| (delta * k).sqrt());
    let (sa, ca) = (a * TAU * part).sin_cos();
    let (sb, cb) = (b * TAU * (1.0 - part)).sin_cos();
    2.0 * ca * cb - (a / b + b / a) * sa * sb
}

#[test]
fn a_square_wave_is_unstable_where_meissner_says() {
    let pair = spur_pair();
    let pitch_rad = pair.pitch_1_rad();
    for (epsilon, part) in [(0.3, 0.5), (0.3, 0.64)] {
        let teeth = || -> Box<dyn TeethModel> {
            Box::new(SquareWave {
                stiff: MEAN * (1.0 + epsilon),
                soft: MEAN * (1.0 - epsilon),
                part,
                // Half a step early: the step that ends at a corner still has the old value.
                begin_rad: pair.working_pressure_angle_rad.tan() + 0.5 * pitch_rad / STEPS as f64,
                pitch_rad,
            })
        };
        for delta in [0.15, 0.6, 1.7] {
            let (found, exact) = (trace(&pair, delta, &teeth), meissner(delta, epsilon, part));
            assert!(
                (found - exact).abs() < 1e-3,
                "{part} {delta} {found} {exact}"
            );
        }
        // The main region, twice the natural frequency, and the second; with half-and-half waves it is the third that
        // is wide.
        let second = if part == 0.5 {
            [1.8, 2.25, 3.0]
        } else {
            [0.75, 1.0, 1.4]
        };
        for [low, inside, high] in [[0.15, 0.25, 0.5], second] {
            let width = |trace: &dyn Fn(f64) -> f64| {
                [border(trace, low, inside), border(trace, inside, high)]
            };
            let found = width(&|delta| self::trace(&pair, delta, &teeth));
            let exact = width(&|delta| meissner(delta, epsilon, part));
            println!("{part}: {found:?} {exact:?}");
            for (found, exact) in found.iter().zip(exact) {
                assert!((found / exact - 1.0).abs() < 5e-4, "{part} {found} {exact}");
            }
        }
    }
}

/// `iso6336` with its sine is Mathieu's equation, a = 4δ and q = A a/2: borders b₁, a₁, b₂ and a₂ as characteristic
/// values solve a = a_r(A a/2), computed with scipy 1.15 (`scipy.special.mathieu_a`, `mathieu_b`,
/// `scipy.optimize.brentq`).
#[test]
fn a_sine_is_unstable_where_mathieu_says() {
    let pair = spur_pair();
    let middle = pair.working_pressure_angle_rad.tan();
    let teeth = || -> Box<dyn TeethModel> {
        let spring = MeshSpring::new(MEAN, 1, middle).unwrap();
        Box::new(spring.with_sine(0.4, middle, pair.gear_1.teeth).unwrap())
    };
    let borders = [
        (0.15, 0.25, 0.2076296396748409),
        (0.25, 0.4, 0.31002198962461475),
        (0.9, 1.03, 0.9870448363957414),
        (1.03, 1.2, 1.0699361951580166),
    ];
    for (low, high, exact) in borders {
        let found = border(|delta| trace(&pair, delta, &teeth), low, high);
        println!("{found} {exact}");
        assert!((found / exact - 1.0).abs() < 5e-4, "{found} {exact}");
    }
}
