//! Blows and jams: a start far from equilibrium, blows that graze, blows that end in rest, teeth without backlash.

use std::ops::ControlFlow;

use gearmesh_drivetrain::*;
use gearmesh_dynamics::{Params, Simulation};
use gearmesh_geometry::{Flank, GearPair, involute};

use crate::mesh_common::*;
use crate::pairs_in_time::hard_cases::{backlash_m, damped_mesh, mesh_of, power_law, root};
use crate::pairs_in_time::scene::*;

/// The law of the single pairs here, F = K δ^1.5, and its work up to a depth.
const K_N_PER_MM_E: f64 = 1e6;

fn law() -> PowerStiffness {
    PowerStiffness::n_per_mm_e(K_N_PER_MM_E, 1.5).unwrap()
}

fn work_j(depth_m: f64) -> f64 {
    law().force(depth_m).0 * depth_m / 2.5
}

fn without_damping(step_s: f64) -> Params {
    Params {
        rho_infinity: 1.0,
        ..Params::fixed(step_s)
    }
}

/// Teeth 0.3 mm in each other, 46 times the deflection of the load: 164 kN throw gear 2 through the backlash at the
/// other flanks, against the load F. Closed form, with n pairs of teeth on the left: W(0.3 mm) = n W(δ) + F (0.3 mm +
/// backlash + δ), W = K δ^2.5/2.5.
#[test]
fn a_start_far_from_equilibrium() {
    let pair = spur_pair();
    let (depth, torque) = (0.3e-3, 30.0);
    let force = torque / pair.gear_2.base_radius_m;
    let scene = Scene {
        te_m: -depth,
        ..Scene::new(&pair).driven_at(0.0).loaded_by(torque)
    };
    let way = depth + backlash_m(&pair);
    let run = |step_s: f64| {
        let system = scene.system(power_law(&pair, law()));
        let (samples, info) = record(system, without_damping(step_s), 0.4e-3);
        let peak = (samples.iter())
            .max_by(|a, b| a.left_n.total_cmp(&b.left_n))
            .unwrap();
        let n = peak.pairs;
        let deepest = root(
            |x: f64| n * work_j(x) + force * (way + x) - work_j(depth),
            1e-3,
        );
        let expected = n * law().force(deepest).0;
        assert!(samples.iter().all(|s| s.te_m.is_finite()));
        [
            (peak.left_n / expected - 1.0).abs(),
            info.energy.largest_error_j / work_j(depth),
        ]
    };
    let found = [2e-6, 1e-6, 0.5e-6, 0.25e-6].map(run);
    println!("impact: errors of peak and energy {found:?}");
    // 35 steps over the first blow at 2 µs: second order, so 64 times less in the end; the peak is that of a sample.
    let [[peak_first, energy_first], _, _, [peak_last, energy_last]] = found;
    assert!(
        peak_first < 1e-2 && peak_last < peak_first / 16.0,
        "{found:?}"
    );
    assert!(
        energy_first < 1e-2 && energy_last < energy_first / 32.0,
        "{found:?}"
    );
}

/// The same of every mesh model, turning: 60 µm in each other, ten times and more the deflection of the load. All
/// numbers are finite, and the energy balance closes with the second order of the step.
#[test]
fn a_start_far_from_equilibrium_in_every_model() {
    let pair = spur_pair();
    for name in MODELS {
        let run = |step_s: f64| {
            let scene = Scene {
                te_m: -60e-6,
                ..Scene::new(&pair).driven_at(60.0).loaded_by(60.0)
            };
            let system = scene.system(mesh_of(name, &pair));
            let (samples, info) = record(system, without_damping(step_s), 0.5e-3);
            let is_finite = |s: &Sample| s.te_m.is_finite() && s.right_n.is_finite();
            assert!(samples.iter().all(is_finite), "{name}");
            info.energy.largest_error_j / info.energy.first.potential_j
        };
        let found = [2e-6, 1e-6, 0.5e-6].map(run);
        println!("{name}: error of the energy over that of the start {found:?}");
        // The change of pairs puts kinks into the force, where the order scatters.
        let order = (found[0] / found[2]).log2() / 2.0;
        assert!(order > 1.4 && found[2] < 1e-3, "{name} {found:?}");
    }
}

/// Gear 2 is thrown from the right flanks against its load, so that it reaches the left ones at the turning point of
/// its flight: 10 nm short of them, just at them, and 10 to 1000 nm into them. A grazing blow must not be a blow: no
/// force where none is touched, else one that the depth d allows, K d^1.5 with n pairs, and the landing on the right
/// flanks is that of a free flight but for what the graze's own force can do.
#[test]
fn blows_that_graze() {
    let pair = spur_pair();
    let (gap, torque) = (5e-6, 30.0);
    let force = torque / pair.gear_2.base_radius_m;
    let mass = Scene::new(&pair).mass_2_kg();
    let fall = force / mass;
    let flight = backlash_m(&pair) - gap;
    for depth in [-10e-9, 0.0, 10e-9, 100e-9, 1e-6] {
        let speed = (2.0 * fall * (flight + depth)).sqrt();
        let scene = Scene {
            te_m: gap,
            te_rate_m_per_s: speed,
            ..Scene::new(&pair).driven_at(0.0).loaded_by(torque)
        };
        // Free flight: up and down again to the gap of the right flanks.
        let landing_s = (speed + (speed * speed + 2.0 * fall * gap).sqrt()) / fall;
        let run = |step_s: f64| {
            let system = scene.system(power_law(&pair, law()));
            let (samples, _) = record(system, without_damping(step_s), landing_s + 20e-6);
            let peak = samples.iter().map(|s| s.left_n).fold(0.0, f64::max);
            let landed = samples.iter().find(|s| s.right_n > 0.0).unwrap();
            (peak, landed.time_s - landing_s)
        };
        let found = [1e-6, 0.5e-6].map(run);
        println!("{depth:e} m: force and lateness of the landing {found:?}");
        for ((peak, late_s), step_s) in found.into_iter().zip([1e-6, 0.5e-6]) {
            // Places are rounded to less than a picometre.
            let most = 2.0 * law().force((depth + 1e-12).max(0.0)).0;
            assert!(peak <= most * (1.0 + 1e-6), "{depth:e}: {peak} of {most}");
            // A sample at most half a step beside the turning point sees it to F h²/8 m.
            let seen = depth - 0.2 * fall * step_s * step_s - most / force * depth.max(0.0);
            assert!(
                peak >= law().force(seen.max(0.0)).0,
                "{depth:e}: {peak} {seen:e}"
            );
            // The graze's force over 2 √(2 d/fall) changes the speed by no more than so much, and the landing by that
            // over the fall.
            let lasts_s = 2.0 * (2.0 * depth.max(0.0) / fall).sqrt();
            let most_s = most / mass * lasts_s / fall + 1.1 * step_s;
            assert!(late_s.abs() < most_s, "{depth:e}: {late_s:e} of {most_s:e}");
        }
    }
}

/// Figures of a fall that ends in rest.
#[derive(Debug)]
struct Rest {
    blows: usize,
    /// Of the last blow's beginning \[s\].
    sticks_s: f64,
    heat_j: f64,
    depth_m: f64,
}

/// Damping of the fall that ends in rest: time \[s\], and depth of full damping \[m\].
const DAMPING: [f64; 2] = [5e-6, 1e-6];

/// One mass on the pair's law, by the classical Runge-Kutta method in steps of 50 ns: m δ̈ = F − P(δ + τ s(δ) δ̇),
/// P(x) = K max(0, x)^1.5.
fn fall_of_one_mass(gap_m: f64, force_n: f64, mass_kg: f64, end_s: f64) -> Rest {
    let [time_s, full_m] = DAMPING;
    let pushes = |depth: f64, rate: f64| {
        let x = (depth / full_m).clamp(0.0, 1.0);
        let felt = depth + time_s * x * x * (3.0 - 2.0 * x) * rate;
        if depth > 0.0 && felt > 0.0 {
            law().force(felt).0
        } else {
            0.0
        }
    };
    let acceleration = |[depth, rate]: [f64; 2]| (force_n - pushes(depth, rate)) / mass_kg;
    let h = 5e-8;
    let mut y = [-gap_m, 0.0];
    let mut rest = Rest {
        blows: 0,
        sticks_s: 0.0,
        heat_j: 0.0,
        depth_m: 0.0,
    };
    for step in 0..(end_s / h) as usize {
        let rate = |y: [f64; 2]| [y[1], acceleration(y)];
        let moved = |k: [f64; 2], h: f64| [y[0] + h * k[0], y[1] + h * k[1]];
        let k1 = rate(y);
        let k2 = rate(moved(k1, 0.5 * h));
        let k3 = rate(moved(k2, 0.5 * h));
        let k4 = rate(moved(k3, h));
        let next = [0, 1].map(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
        if y[0] <= 0.0 && next[0] > 0.0 {
            rest.blows += 1;
            rest.sticks_s = step as f64 * h;
        }
        y = next;
    }
    rest.depth_m = y[0];
    rest.heat_j = force_n * (gap_m + y[0]) - work_j(y[0]) - 0.5 * mass_kg * y[1] * y[1];
    rest
}

/// A fall of 20 µm that ends in rest: ever lower bounces, each under the load, until the teeth no longer part.
/// Bounces, the moment from which they stick, depth and heat are those of one mass; heat is what the load did, less
/// what the teeth keep.
#[test]
fn blows_that_end_in_rest() {
    let pair = spur_pair();
    let (gap, torque, end_s) = (20e-6, 30.0, 60e-3);
    let force = torque / pair.gear_2.base_radius_m;
    let scene = Scene {
        te_m: gap,
        ..Scene::new(&pair).driven_at(0.0).loaded_by(torque)
    };
    let expected = fall_of_one_mass(gap, force, scene.mass_2_kg(), end_s);
    let gears = [pair.gear_1.clone(), pair.gear_2.clone()];
    let run = |step_s: f64| {
        let damping = Damping::StiffnessProportional {
            time_s: DAMPING[0],
            full_depth_m: DAMPING[1],
        };
        let elastic = Impact::new(law(), 0.0, 1e-6, 1).unwrap();
        let teeth = || Damped::new(elastic, damping, 1).unwrap();
        let none = [Vec::new(), Vec::new()];
        let a = pair.centre_distance_m;
        let path =
            MeshKinematics::new(gears.clone(), none, a, layout(1), PathEnds::LineOfAction).unwrap();
        let mesh = GearMesh::new(path, Flank::Right, teeth()).unwrap();
        let mesh = mesh.with_side(Flank::Left, teeth()).unwrap();
        let (samples, info) = record(scene.system(mesh), Params::fixed(step_s), end_s);
        let begins = |two: &&[Sample]| two[0].te_m >= 0.0 && two[1].te_m < 0.0;
        let blows: Vec<&[Sample]> = samples.windows(2).filter(begins).collect();
        let energy = info.energy;
        assert!(
            energy.largest_error_j < 2e-2 * energy.dissipated_j,
            "{energy:?}"
        );
        Rest {
            blows: blows.len(),
            sticks_s: blows[blows.len() - 1][0].time_s,
            heat_j: energy.dissipated_j,
            depth_m: -samples[samples.len() - 1].te_m,
        }
    };
    let found = [2e-6, 1e-6, 0.5e-6].map(run);
    println!("{found:?}, one mass {expected:?}");
    assert!(expected.blows > 5, "{expected:?}");
    let at_rest = (force / law().force(1.0).0).powf(1.0 / 1.5);
    assert!(
        (expected.depth_m / at_rest - 1.0).abs() < 1e-6,
        "{at_rest:e}"
    );
    for rest in &found {
        assert_eq!(rest.blows, expected.blows, "{rest:?}");
        assert!((rest.depth_m / at_rest - 1.0).abs() < 1e-4, "{rest:?}");
    }
    let off = |of: fn(&Rest) -> f64| {
        found
            .each_ref()
            .map(|f| (of(f) / of(&expected) - 1.0).abs())
    };
    let (late, heat) = (off(|r| r.sticks_s), off(|r| r.heat_j));
    println!("off: sticking {late:?}, heat {heat:?}");
    // A blow is seen at the next step.
    assert!(late[2] < 1e-3, "{late:?}");
    // Tooth damping is in the balance to its first order only (conservation.rs): this stays with every step.
    assert!(heat[2] < 5e-3, "{heat:?}");
}

/// Sum of the gaps of both flanks along the line of action at a centre distance; negative where teeth jam.
fn play_m(pair: &GearPair, centre_m: f64) -> f64 {
    let base = pair.gear_1.base_radius_m + pair.gear_2.base_radius_m;
    let inv = |cos: f64| involute::involute_function(cos.acos());
    backlash_m(pair) + 2.0 * base * (inv(base / centre_m) - inv(base / pair.centre_distance_m))
}

/// Gears mounted so near that teeth have no backlash but overlap by 2 δ: without torque both sides carry the same, and
/// as much as a depth of δ each says where as many pairs carry on both. They turn on, with friction, in the sum over
/// whole pitches with the same force on both sides; what the drive puts in turns into heat. Such a pair is refused by
/// name when it is put together, and a jam deeper than teeth can deflect ends the run.
#[test]
fn gears_without_backlash_jam() {
    let pair = spur_pair();
    let centre = |nearer: f64| pair.centre_distance_m - nearer;
    let nearer = root(|nearer| -play_m(&pair, centre(nearer)) - 20e-6, 0.7e-3);
    let play = play_m(&pair, centre(nearer));
    assert!((play + 20e-6).abs() < 1e-12, "{play:e}");
    let gears = || (pair.gear_1.clone(), pair.gear_2.clone());
    let refused = GearPair::new(gears().0, gears().1, centre(nearer), Default::default());
    let told = refused.unwrap_err().to_string();
    assert!(
        told.contains("the teeth do not fit: backlash -0.02"),
        "{told}"
    );

    let friction = Friction::new([0.1, 0.08], [2e-3, 2e-2]).unwrap();
    let pitch_s = pair.pitch_1_rad() / 60.0;
    let steps = 400;
    for name in ["impact", "analytic", "hybrid"] {
        let scene = Scene {
            nearer_m: nearer,
            te_m: 0.5 * backlash_m(&pair),
            ..Scene::new(&pair).driven_at(60.0).loaded_by(0.0)
        };
        let mesh = damped_mesh(name, &pair, 2e-5).with_friction(friction);
        let params = Params::fixed(pitch_s / f64::from(steps));
        let (samples, info) = record(scene.system(mesh), params, 4.0 * pitch_s);
        let last = &samples[samples.len() - 2 * steps as usize..];
        let mean = |f: fn(&Sample) -> f64| last.iter().map(f).sum::<f64>() / last.len() as f64;
        let (right, left) = (mean(|s| s.right_n), mean(|s| s.left_n));
        let energy = info.energy;
        println!(
            "{name}: {right:.1} N right, {left:.1} N left, heat {:.4} J, energy off by {:.1e} J",
            energy.dissipated_j, energy.largest_error_j
        );
        assert!(
            last.iter().all(|s| s.right_n > 0.0 && s.left_n > 0.0),
            "{name}"
        );
        // Friction of the two sides has arms that differ by the paths' own places: ρ μ/r_b, a few per cent.
        assert!((right / left - 1.0).abs() < 0.05, "{name}: {right} {left}");
        assert!(
            energy.largest_error_j < 1e-2 * energy.dissipated_j,
            "{name} {energy:?}"
        );
    }

    // At rest, one law of one pair: its force at half the overlap, times the pairs that carry.
    let scene = Scene {
        nearer_m: nearer,
        te_m: 0.5 * backlash_m(&pair) - 3e-6,
        ..Scene::new(&pair).driven_at(0.0)
    };
    let params = |step_s: f64| Params {
        rho_infinity: 0.5,
        ..Params::fixed(step_s)
    };
    let mut run = Simulation::new(scene.system(mesh_of("impact", &pair)), params(2e-6)).unwrap();
    let samples = record_on(&mut run, 20e-3);
    let end = samples[samples.len() - 1];
    let mut alone = mesh_of("impact", &pair);
    alone.evaluate(&pose_of(run.state()), false).unwrap();
    // Elastic teeth: depth of each side from its own pairs.
    let depth = |side: Flank| {
        let (found, forces) = alone.side(side).unwrap();
        let deepest = found.contacts.iter().map(|c| -c.gap_m).fold(0.0, f64::max);
        (deepest, forces.iter().sum::<f64>())
    };
    let [(right, right_n), (left, left_n)] = [Flank::Right, Flank::Left].map(depth);
    println!("at rest: {right:e} m, {left:e} m, {right_n} N, {left_n} N, {end:?}");
    assert!((right + left + play).abs() < 1e-9, "{right:e} {left:e}");
    assert!((right_n / left_n - 1.0).abs() < 1e-4, "{right_n} {left_n}");

    // Deeper than a tenth of the base pitch on each side.
    let deep = root(
        |nearer| {
            -play_m(&pair, centre(nearer))
                - 2.2 * 0.1 * pair.pitch_1_rad() * pair.gear_1.base_radius_m
        },
        4e-3,
    );
    let scene = Scene {
        nearer_m: deep,
        te_m: 0.5 * backlash_m(&pair),
        ..Scene::new(&pair).driven_at(60.0)
    };
    let ended = Simulation::new(scene.system(mesh_of("impact", &pair)), Params::fixed(1e-6))
        .and_then(|mut run| run.run(1e-3, |_| ControlFlow::Continue(())));
    let message = ended.unwrap_err().to_string();
    for word in ["in each other", "a tenth of the base pitch", "`mesh`"] {
        assert!(message.contains(word), "`{word}` is not in {message}");
    }
}
