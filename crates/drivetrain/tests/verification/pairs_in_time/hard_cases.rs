//! Motions that are hard to compute: each runs to its end, against a closed form where there is one, and converges with
//! the step.

use std::f64::consts::TAU;

use gearmesh_drivetrain::*;
use gearmesh_dynamics::{Params, Simulation, TimeFunction};
use gearmesh_geometry::{Flank, GearPair, involute};
use nalgebra::Vector3;

use crate::mesh_common::*;
use crate::pairs_in_time::scene::*;

/// A mesh of both sides with damping proportional to stiffness, full at a depth of 1 µm.
pub fn damped_mesh(name: &str, pair: &GearPair, time_s: f64) -> GearMesh {
    damped_on(kinematics(pair), (name, pair), [time_s, 1e-6])
}

pub fn damped_on(
    kinematics: MeshKinematics,
    (name, pair): (&str, &GearPair),
    [time_s, full_depth_m]: [f64; 2],
) -> GearMesh {
    let damping = Damping::StiffnessProportional {
        time_s,
        full_depth_m,
    };
    let of = |side| Damped::new(model(name, pair, side), damping, SLICES).unwrap();
    GearMesh::new(kinematics, Flank::Right, of(Flank::Right))
        .unwrap()
        .with_side(Flank::Left, of(Flank::Left))
        .unwrap()
}

/// Undamped pairs of teeth that touch in the middle of the face, on the rigid path: the one at the pitch point is alone
/// at any depth.
pub fn power_law(pair: &GearPair, stiffness: PowerStiffness) -> GearMesh {
    let law = Impact::new(stiffness, 0.0, 1e-6, 1).unwrap();
    let gears = [pair.gear_1.clone(), pair.gear_2.clone()];
    let none = [Vec::new(), Vec::new()];
    let a = pair.centre_distance_m;
    let kinematics =
        MeshKinematics::new(gears, none, a, layout(1), PathEnds::LineOfAction).unwrap();
    GearMesh::new(kinematics, Flank::Right, law)
        .unwrap()
        .with_side(Flank::Left, law)
        .unwrap()
}

/// Normal backlash: both flanks' gaps together.
pub fn backlash_m(pair: &GearPair) -> f64 {
    let gears = [&pair.gear_1, &pair.gear_2];
    let base: f64 = gears.iter().map(|g| g.base_radius_m).sum();
    let thick: f64 = gears
        .iter()
        .map(|g| 2.0 * g.base_radius_m * g.base_half_angle_rad)
        .sum();
    let inv = involute::involute_function(pair.working_pressure_angle_rad);
    pair.pitch_1_rad() * pair.gear_1.base_radius_m + 2.0 * base * inv - thick
}

/// A mesh of both sides without damping.
pub fn mesh_of(name: &str, pair: &GearPair) -> GearMesh {
    mesh(name, pair, kinematics(pair))
}

/// The root of a growing function between 0 and `most`.
pub fn root(f: impl Fn(f64) -> f64, most: f64) -> f64 {
    let (mut low, mut high) = (0.0, most);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if f(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// Start out of contact and impact at K up to 1e7 N/mm^1.5: gear 2 falls through a gap g under a force F along the line
/// of action, hits, and comes back. Closed form with m = I₂/r_b2²: first touch after √(2 g m/F), K δ^2.5/2.5 = F (g +
/// δ) at the deepest point (a peak that goes with K^0.4 where the fall outweighs the depth), and without damping the
/// gap g again.
#[test]
fn a_fall_through_backlash_and_a_hard_impact() {
    let pair = spur_pair();
    let (gap, torque) = (20e-6, 30.0);
    let scene = Scene {
        te_m: gap,
        ..Scene::new(&pair).driven_at(0.0).loaded_by(torque)
    };
    let force = torque / pair.gear_2.base_radius_m;
    let mass = scene.mass_2_kg();
    let fall_s = (2.0 * gap * mass / force).sqrt();
    let impact = |k_n_per_mm_e: f64| {
        let law = PowerStiffness::n_per_mm_e(k_n_per_mm_e, 1.5).unwrap();
        let work = |depth: f64| law.force(depth).0 * depth / 2.5 - force * (gap + depth);
        let deepest = root(work, 1e-3);
        let peak = law.force(deepest).0;
        // T = 2.943 δ/v of Hertz's impact is short of this by the load's own part.
        let contact_s = 3.0 * deepest / (force / mass * fall_s);
        let run = |step_s: f64| {
            let params = Params {
                rho_infinity: 1.0,
                ..Params::fixed(step_s)
            };
            let system = scene.system(power_law(&pair, law));
            let (samples, _) = record(system, params, 2.0 * fall_s + 1.3 * contact_s);
            let touch = samples.iter().find(|s| s.right_n > 0.0).unwrap().time_s;
            assert!((touch - fall_s).abs() <= 1.1 * step_s, "{touch} {fall_s}");
            assert!(samples.iter().all(|s| s.left_n == 0.0));
            let late = samples.iter().filter(|s| s.time_s > fall_s);
            let back = late.map(|s| s.te_m).fold(f64::MIN, f64::max);
            let found = samples.iter().map(|s| s.right_n).fold(0.0, f64::max);
            [(found / peak - 1.0).abs(), (back / gap - 1.0).abs()]
        };
        let errors = [20.0, 40.0, 80.0, 160.0].map(|steps| run(contact_s / steps));
        println!("K {k_n_per_mm_e:e}: peak {peak} N, errors of peak and return {errors:?}");
        // Seen: peak 4e-3 to 9e-3 off with the first step and 2e-5 to 3e-4 with the last, gap 6e-4 to 6e-3 and 1e-6 to
        // 3e-6.
        let [[peak_first, back_first], _, _, [peak_last, back_last]] = errors;
        assert!(
            peak_first < 1e-2 && peak_last < peak_first / 16.0,
            "{errors:?}"
        );
        assert!(
            back_first < 1e-2 && back_last < back_first / 16.0,
            "{errors:?}"
        );
        peak
    };
    let peaks = [1e5, 1e6, 1e7].map(impact);
    // 1692, 2652 and 5274 N: sharper with K, by less than K^0.4 where the load goes on working over the depth.
    assert!(peaks[0] < peaks[1] && peaks[1] < peaks[2], "{peaks:?}");
}

/// A figure on steps that halve: its last change over its size, and the mean order of its changes.
#[track_caller]
pub fn converges(what: &str, values: &[f64], last_change: f64, least_order: f64) {
    let n = values.len();
    let change = (values[n - 1] / values[n - 2] - 1.0).abs();
    let order = mean_order(values);
    println!("{what}: {values:?}, order {order:.2}, last change {change:.1e}");
    assert!(
        change < last_change && order > least_order,
        "{what} {values:?}: order {order}, last change {change:e}"
    );
}

/// The torque turns round while the gears run: right flanks let go, gear 2 flies through the backlash, left flanks
/// carry. Both ends have the mean force of the torque; landing and its peak converge.
#[test]
fn torque_turns_round_through_backlash() {
    let pair = spur_pair();
    let backlash = backlash_m(&pair);
    for name in MODELS {
        let run = |step_s: f64| {
            let scene = Scene {
                te_m: -4e-6,
                torque_2: Some(TimeFunction::step(1e-3, 60.0, 3e-3, -60.0).unwrap()),
                ..Scene::new(&pair).driven_at(60.0)
            };
            let mesh = damped_mesh(name, &pair, 2e-5);
            let (samples, _) = record(scene.system(mesh), Params::fixed(step_s), 9e-3);
            let landed = samples.iter().position(|s| s.left_n > 0.0).unwrap();
            let flying = samples
                .iter()
                .filter(|s| s.left_n == 0.0 && s.right_n == 0.0)
                .count();
            assert!(samples[..landed].iter().all(|s| s.te_m < backlash + 1e-7));
            assert!(flying as f64 * step_s > 2e-4, "{name} {flying}");
            let peak = samples.iter().map(|s| s.left_n).fold(0.0, f64::max);
            let end = samples.last().unwrap();
            assert_eq!(end.right_n, 0.0);
            (peak, backlash - end.te_m, samples[landed].time_s)
        };
        let found = [8e-6, 4e-6, 2e-6, 1e-6].map(run);
        // Seen at the last halving: 2e-3 of the peak, 8 to 14 times the force of the torque; 1e-5 of the depth at the
        // end.
        converges(&format!("{name} peak"), &found.map(|f| f.0), 3e-3, 1.5);
        let depths = found.map(|f| f.1);
        assert!(
            depths.iter().all(|d| (d / depths[3] - 1.0).abs() < 5e-3),
            "{name} {depths:?}"
        );
        let landed = found.map(|f| f.2);
        assert!((landed[0] - landed[3]).abs() < 16e-6, "{name} {landed:?}");
    }
}

/// Speed of a push \[m/s\].
const START_M_PER_S: f64 = 40e-3;

/// Speed at which a mass comes back from the spring of 3e8 N/m with a damping of 1e-5 s, full at 1 µm: m δ̈ = −max(0, K
/// (δ + τ s(δ) δ̇)), by the classical Runge-Kutta method in steps of 10 ns.
fn speed_after_blow(speed_m_per_s: f64, mass_kg: f64) -> f64 {
    let acceleration = |depth: f64, rate: f64| {
        let x = (depth / 1e-6).clamp(0.0, 1.0);
        let share = x * x * (3.0 - 2.0 * x);
        -(3e8 / mass_kg * (depth + 1e-5 * share * rate)).max(0.0)
    };
    let h = 1e-8;
    let (mut depth, mut rate) = (0.0, speed_m_per_s);
    while depth >= 0.0 {
        let k1 = [rate, acceleration(depth, rate)];
        let at = |k: [f64; 2], h: f64| {
            let (depth, rate) = (depth + h * k[0], rate + h * k[1]);
            [rate, acceleration(depth, rate)]
        };
        let k2 = at(k1, 0.5 * h);
        let k3 = at(k2, 0.5 * h);
        let k4 = at(k3, h);
        depth += h / 6.0 * (k1[0] + 2.0 * (k2[0] + k3[0]) + k4[0]);
        rate += h / 6.0 * (k1[1] + 2.0 * (k2[1] + k3[1]) + k4[1]);
    }
    -rate
}

/// No torque at all: gear 2 floats in the backlash, and nothing touches it. Given a push it hits the flanks in turn
/// and, its damping at work, ever more slowly.
#[test]
fn zero_torque() {
    let pair = spur_pair();
    let backlash = backlash_m(&pair);
    for name in MODELS {
        let floating = Scene {
            te_m: 0.5 * backlash,
            ..Scene::new(&pair).driven_at(60.0)
        };
        let mesh = mesh(name, &pair, kinematics(&pair));
        let (samples, _) = record(floating.system(mesh), Params::fixed(1e-4), 0.5);
        assert!(samples.iter().all(|s| s.right_n == 0.0 && s.left_n == 0.0));
        let end = samples.last().unwrap();
        assert!(
            (end.te_m - 0.5 * backlash).abs() < 1e-11,
            "{name} {:e}",
            end.te_m - 0.5 * backlash
        );
        let pushed = Scene {
            te_rate_m_per_s: -START_M_PER_S,
            ..floating
        };
        let [r1, r2] = [&pair.gear_1, &pair.gear_2].map(|g| g.base_radius_m);
        let run = |step_s: f64| {
            let mesh = damped_mesh(name, &pair, 1e-5);
            let (samples, _) = record(pushed.system(mesh), Params::fixed(step_s), 18e-3);
            let touches = |n: fn(&Sample) -> f64| {
                let begins = |two: &&[Sample]| n(&two[0]) == 0.0 && n(&two[1]) > 0.0;
                samples.windows(2).filter(begins).count()
            };
            let inside = |s: &Sample| s.te_m > -20e-6 && s.te_m < backlash + 20e-6;
            assert!(samples.iter().all(inside), "{name}");
            let end = samples.last().unwrap();
            assert!(end.right_n == 0.0 && end.left_n == 0.0, "{name}");
            let hits = [touches(|s| s.right_n), touches(|s| s.left_n)];
            let rate = r2 * end.speeds[1] - r1 * end.speeds[0];
            (hits, rate)
        };
        let found = [8e-6, 4e-6, 2e-6, 1e-6].map(run);
        println!("{name} {found:?}");
        assert!(found.iter().all(|f| f.0 == found[0].0), "{name} {found:?}");
        let rates = found.map(|f| f.1.abs());
        assert!(rates[3] < START_M_PER_S, "{rates:?}");
        converges(&format!("{name} rate"), &rates, 1e-2, 0.5);
    }
}

/// The same push against one spring of the same stiffness at every place: each blow is one equation.
#[test]
fn blows_of_a_constant_spring_are_those_of_one_mass() {
    let pair = spur_pair();
    let damping = Damping::StiffnessProportional {
        time_s: 1e-5,
        full_depth_m: 1e-6,
    };
    let side = || {
        let middle = pair.working_pressure_angle_rad.tan();
        let spring = MeshSpring::new(3e8, SLICES, middle).unwrap();
        Damped::new(spring, damping, SLICES).unwrap()
    };
    let scene = Scene {
        te_m: 0.5 * backlash_m(&pair),
        te_rate_m_per_s: -START_M_PER_S,
        ..Scene::new(&pair).driven_at(60.0)
    };
    let [r1, r2] = [&pair.gear_1, &pair.gear_2].map(|g| g.base_radius_m);
    let rate = |step_s: f64| {
        let mesh = GearMesh::new(kinematics(&pair), Flank::Right, side())
            .unwrap()
            .with_side(Flank::Left, side())
            .unwrap();
        let (samples, _) = record(scene.system(mesh), Params::fixed(step_s), 18e-3);
        let carries = |s: &Sample| s.right_n + s.left_n > 0.0;
        let begins = |two: &&[Sample]| !carries(&two[0]) && carries(&two[1]);
        let blows = samples.windows(2).filter(begins).count();
        let end = samples.last().unwrap();
        (blows, (r2 * end.speeds[1] - r1 * end.speeds[0]).abs())
    };
    let found = [4e-6, 2e-6, 1e-6].map(rate);
    let expected = (0..found[2].0).fold(START_M_PER_S, |speed, _| {
        speed_after_blow(speed, scene.mass_2_kg())
    });
    println!("{found:?}, one mass {expected}");
    assert!(found[2].0 > 1);
    // Second order: what is left of the error is a third of the last change.
    let last_change = (found[2].1 - found[1].1).abs();
    assert!(
        (found[2].1 - expected).abs() < last_change,
        "{found:?} {expected}"
    );
    assert!(last_change < 1e-3 * expected, "{found:?}");
}

/// 1e-3 N·m, a load of 17 mN: momentum I₂ω + ∫ F r_b2 dt = ∫ T dt holds, and the mesh neither rattles away nor sticks.
#[test]
fn a_thousandth_of_a_newton_metre() {
    let pair = spur_pair();
    let torque = 1e-3;
    for name in MODELS {
        let mut alone = mesh(name, &pair, kinematics(&pair));
        let te = equilibrium(&mut alone, &pair, 0.0, torque);
        let run = |step_s: f64| {
            let scene = Scene {
                te_m: te,
                ..Scene::new(&pair).driven_at(60.0).loaded_by(torque)
            };
            let inertia = scene.mass_2_kg() * pair.gear_2.base_radius_m.powi(2);
            let mesh = damped_on(kinematics(&pair), (name, &pair), [1e-5, 1e-12]);
            let (samples, _) = record(scene.system(mesh), Params::fixed(step_s), 7e-3);
            let sum: f64 = samples.iter().map(|s| s.right_n).sum::<f64>() * step_s;
            let end = samples.last().unwrap();
            let start_speed = 60.0 * pair.gear_1.base_radius_m / pair.gear_2.base_radius_m;
            let gained = inertia * (end.speeds[1] - start_speed);
            let ends = 0.5 * step_s * (end.right_n - torque / pair.gear_2.base_radius_m);
            let impulse = (sum - ends) * pair.gear_2.base_radius_m;
            let balance = (impulse - gained) / (torque * end.time_s) - 1.0;
            assert!(samples.iter().all(|s| s.left_n == 0.0 && s.te_m < 1e-6));
            (balance, end.te_m)
        };
        let found = [8e-6, 4e-6, 2e-6, 1e-6].map(run);
        let momentum = found.iter().map(|f| f.0.abs()).fold(0.0, f64::max);
        println!("{name}: momentum off by {momentum:.1e} of that of the torque (allowed 1e-5)");
        // Seen: 3e-6 and below; 7e-3 for `impact`, whose damping hardly acts at 4 nm, 3e-3 and less for the others.
        assert!(found.iter().all(|f| f.0.abs() < 1e-5), "{name} {found:?}");
        let [.., before, last] = found.map(|f| f.1);
        let (change, share) = ((last / before - 1.0).abs(), last / te);
        println!(
            "transmission error {share:.2} of the static {te:.2e} m (allowed 0.5 to 1.5), last change {change:.1e} (allowed 1e-2)"
        );
        assert!((last / before - 1.0).abs() < 1e-2, "{name} {found:?}");
        // A load put on at once swings the teeth between nothing and twice their deflection; half of that, at least, is
        // damped away.
        assert!((0.5..1.5).contains(&(last / te)), "{name} {te:e} {found:?}");
    }
}

/// Gear 2's axis is tilted in the plane of action by 5 mrad, 20 µm from slice to slice: one slice carries all, the
/// others stand open.
#[test]
fn misalignment_leaves_one_slice() {
    let pair = spur_pair();
    let alpha = pair.working_pressure_angle_rad;
    let tilt = 5e-3 * Vector3::new(alpha.cos(), alpha.sin(), 0.0);
    let edge = slice_planes()[0].abs() * 5e-3;
    for name in MODELS {
        let run = |step_s: f64| {
            let scene = Scene {
                te_m: edge,
                tilt,
                ..Scene::new(&pair).driven_at(60.0).loaded_by(10.0)
            };
            let mesh = damped_mesh(name, &pair, 2e-5);
            let mut run = Simulation::new(scene.system(mesh), Params::fixed(step_s)).unwrap();
            let samples = record_on(&mut run, 8e-3);
            let end = *samples.last().unwrap();
            let mut alone = mesh_of(name, &pair);
            alone.evaluate(&pose_of(run.state()), false).unwrap();
            let (found, forces) = alone.side(Flank::Right).unwrap();
            let carrying: Vec<usize> = (0..forces.len())
                .filter(|&i| forces[i] > 0.0)
                .map(|i| found.contacts[i].slice)
                .collect();
            (end.te_m, carrying, end.right_n)
        };
        let found = [8e-6, 4e-6, 2e-6, 1e-6].map(run);
        for (_, carrying, _) in &found {
            // Two pairs may be in mesh, each on its outermost slice.
            assert!(
                !carrying.is_empty() && carrying.iter().all(|slice| *slice == 0),
                "{name} {found:?}"
            );
        }
        let [_, _, _, (_, _, force)] = &found;
        println!("{name} {force}");
        converges(
            &format!("{name} te"),
            &found.each_ref().map(|f| f.0),
            1e-5,
            1.0,
        );
    }
}

/// A minute at 10 rpm, 300 mesh periods in steps of 1/80 of one, and nothing drifts: the last period repeats the
/// second, and the transmission error is the static one.
#[test]
fn a_minute_at_ten_rpm() {
    let pair = spur_pair();
    let (torque, step_s) = (60.0, 2.5e-3);
    let speed = 10.0 * TAU / 60.0;
    let mut alone = mesh_of("hybrid", &pair);
    let te = equilibrium(&mut alone, &pair, 0.0, torque);
    let scene = Scene {
        te_m: te,
        ..Scene::new(&pair).driven_at(speed).loaded_by(torque)
    };
    let system = scene.system(damped_mesh("hybrid", &pair, 1e-6));
    // The pair's own vibration is 90 times as fast as a step: what the changes of pairs stir of it is to die out at
    // once.
    let params = Params {
        rho_infinity: 0.5,
        ..Params::fixed(step_s)
    };
    let (samples, info) = record(system, params, 60.0);
    assert_eq!(samples.len(), 24_000);
    let (mut drift, mut off) = (0.0_f64, 0.0_f64);
    for k in 0..80 {
        let (early, late) = (samples[80 + k], samples[23_920 + k]);
        drift = drift.max((late.te_m / early.te_m - 1.0).abs());
        let theta = speed * early.time_s;
        let still = equilibrium(&mut alone, &pair, theta, torque);
        off = off.max((early.te_m / still - 1.0).abs());
    }
    println!("drift {drift:.1e}, off the static solution {off:.1e}");
    // Seen: 2e-9 and 4e-4 (`impact` the same), the largest beside a change of pairs; 4e-5 in the mean.
    assert!(drift < 1e-7 && off < 1e-3, "{drift:e} {off:e}");
    assert!(info.largest_violation < 1e-12, "{info:?}");
}

/// Steps from 2 to 60 µs, the longest a sixth of the period of the pair's own vibration: all run, and what they say
/// converges.
#[test]
fn steps_over_a_factor_of_thirty() {
    let pair = spur_pair();
    let torque = 60.0;
    // 10 mesh periods in 600 steps of the longest.
    let end_s = 600.0 * 60e-6;
    let speed = 10.0 * pair.pitch_1_rad() / end_s;
    for name in MODELS {
        let run = |step_s: f64| {
            let scene = Scene {
                te_m: -5e-6,
                ..Scene::new(&pair).driven_at(speed).loaded_by(torque)
            };
            let mesh = damped_mesh(name, &pair, 2e-5);
            let system = scene.system(mesh);
            let (samples, _) = record(system, Params::fixed(step_s), end_s);
            // The last five periods.
            let last = &samples[samples.len() - (300.0 * 60e-6 / step_s).round() as usize..];
            let mean = |f: fn(&Sample) -> f64| last.iter().map(f).sum::<f64>() / last.len() as f64;
            let te = mean(|s| s.te_m);
            let spread =
                last.iter().map(|s| (s.te_m - te).powi(2)).sum::<f64>() / last.len() as f64;
            let share = mean(|s| s.right_n) * pair.gear_2.base_radius_m / torque;
            (share, te, spread.sqrt())
        };
        let found = [60e-6, 30e-6, 15e-6, 6e-6, 2e-6].map(run);
        let (_, te, spread) = found[4];
        println!("{name} {found:?}");
        // The force's mean over whole periods is the torque's, up to what tip edges do to the lever arm.
        assert!(
            found.iter().all(|f| (f.0 - 1.0).abs() < 4e-4),
            "{name} {found:?}"
        );
        // Seen at the longest step: 6e-5, 8e-7, 5e-4, 5e-4 of the mean, 4e-5 to 3e-3 of the spread.
        assert!((found[0].1 / te - 1.0).abs() < 1e-3, "{name} {found:?}");
        assert!((found[0].2 / spread - 1.0).abs() < 5e-3, "{name} {found:?}");
        let nearer = |k: usize| (found[k].1 - te).abs() < 0.3 * (found[0].1 - te).abs();
        assert!(nearer(2) && nearer(3), "{name} {found:?}");
    }
}

/// A run that is stopped in the middle of an impact and resumed ends with the same bits.
#[test]
fn a_run_resumed_in_an_impact_gives_the_same_bits() {
    let pair = spur_pair();
    let scene = Scene {
        te_m: 20e-6,
        ..Scene::new(&pair).driven_at(0.0).loaded_by(30.0)
    };
    let law = PowerStiffness::n_per_mm_e(1e6, 1.5).unwrap();
    let params = Params::fixed(1e-6);
    let system = || scene.system(power_law(&pair, law));
    let go_on = |simulation: &mut Simulation, end_s: f64| {
        simulation
            .run(end_s, |_| std::ops::ControlFlow::Continue(()))
            .unwrap();
    };
    let force = 30.0 / pair.gear_2.base_radius_m;
    let fall_s = (2.0 * 20e-6 * scene.mass_2_kg() / force).sqrt();
    let (samples, _) = record(system(), params, 1.5 * fall_s);
    let deepest = (samples.iter())
        .max_by(|a, b| a.right_n.total_cmp(&b.right_n))
        .unwrap();
    assert!(deepest.right_n > 2.0 * force, "{}", deepest.right_n);
    let (middle_s, end_s) = (deepest.time_s, 2.0 * fall_s);
    let mut whole = Simulation::new(system(), params).unwrap();
    go_on(&mut whole, middle_s);
    let checkpoint = whole.checkpoint();
    go_on(&mut whole, end_s);
    let mut second = Simulation::resume(system(), params, &checkpoint).unwrap();
    go_on(&mut second, end_s);
    assert_eq!(second.checkpoint(), whole.checkpoint());
    println!(
        "stopped at {:.3} ms under {:.0} N, {:.2} times the load (at least 2); resumed up to {:.3} ms: the same bits",
        1e3 * middle_s,
        deepest.right_n,
        deepest.right_n / force,
        1e3 * second.state().time_s
    );
}
