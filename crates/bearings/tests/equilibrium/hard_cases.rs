//! Hard cases: what must not fail, and what must hold there.
#![allow(clippy::print_stdout)] // what docs/hard-cases.md lists as found

use crate::common::{B218, B6205, PAIR, ROLLERS, TAPERED, bearing, close, definition};
use gearmesh_bearings::{
    AppliedBearingLoad, BearingError, Control, ElementPlaces, Operation, QuasiStaticBearing,
    RingPose, TiltCondition,
};
use nalgebra::Vector5;

const FREE: TiltCondition = TiltCondition::Moments([0.0; 2]);
const HELD: TiltCondition = TiltCondition::Held([0.0; 2]);

fn at_rpm(rpm: f64) -> Operation {
    Operation {
        inner_rad_per_s: rpm * std::f64::consts::PI / 30.0,
        ..Operation::default()
    }
}

fn rest(
    bearing: &QuasiStaticBearing,
    force_n: [f64; 3],
    tilt: TiltCondition,
    rpm: f64,
) -> RingPose {
    let load = AppliedBearingLoad { force_n, tilt };
    bearing
        .equilibrium(&load, &at_rpm(rpm))
        .unwrap_or_else(|e| panic!("{e}"))
}

/// 10⁻³ N is carried as well as a million times more.
#[test]
fn tiny_and_heavy_loads_are_carried() {
    let (mut worst_tiny, mut worst) = (0.0_f64, 0.0_f64);
    for text in [B218, TAPERED] {
        let bearing = bearing(text);
        for force in [1e-3, 1.0, 1e5] {
            let pose = rest(&bearing, [0.0, 0.0, force], FREE, 0.0);
            let ring = bearing.evaluate(&pose, &at_rpm(0.0)).unwrap();
            // Each of the 16 or 17 elements counts 1e-9 N as none: 2e-8 N of 1e-3 N, of which more loads have less.
            close(-ring.load[2], force, if force < 1.0 { 2e-5 } else { 1e-8 });
            let off = (-ring.load[2] / force - 1.0).abs();
            if force < 1.0 {
                worst_tiny = worst_tiny.max(off);
            } else {
                worst = worst.max(off);
            }
        }
    }
    println!("thrust of 1e-3 N: force of the bearing off by {worst_tiny:.1e} of it (allowed 2e-5)");
    println!("thrusts of 1 and 1e5 N: off by {worst:.1e} (allowed 1e-8)");
}

/// A free ring in a bearing with clearance feels nothing, and so does one of cylindrical rollers.
#[test]
fn an_unloaded_ring_feels_nothing() {
    let (mut load, mut stiffness) = (0.0_f64, 0.0_f64);
    for text in [
        format!("{B6205}radial_clearance_um = 15.0\n"),
        ROLLERS.to_owned(),
    ] {
        let ring = bearing(&text)
            .evaluate(&RingPose::default(), &Operation::default())
            .unwrap();
        assert_eq!(ring.load.norm(), 0.0);
        assert_eq!(ring.tangent.norm(), 0.0);
        load = load.max(ring.load.norm());
        stiffness = stiffness.max(ring.tangent.norm());
    }
    println!("largest load on the ring {load} N, largest stiffness {stiffness} N/m");
}

/// 10 mrad of misalignment at rest, and d_m·n = 4·10⁶ mm/min of a ring that is free to tilt: equilibrium to rounding.
#[test]
fn misalignment_and_high_speed_are_survived() {
    let bearing = bearing(PAIR);
    let pose = rest(
        &bearing,
        [300.0, 0.0, 100.0],
        TiltCondition::Held([0.01, 0.0]),
        0.0,
    );
    let q = pose.to_five();
    println!(
        "at rest, held at 10 mrad: in equilibrium at {:.3} mrad",
        1e3 * q[3]
    );
    close(q[3], 0.01, 1e-9);
    let fast = 4e6 / 65.0;
    for control in [Control::OuterRace, Control::LeastSpin] {
        let operation = Operation {
            control,
            ..at_rpm(fast)
        };
        let load = AppliedBearingLoad {
            force_n: [300.0, 0.0, 100.0],
            tilt: FREE,
        };
        let pose = bearing
            .equilibrium(&load, &operation)
            .unwrap_or_else(|e| panic!("{e}"));
        let (ring, loads) = bearing.loads(&pose, &operation).unwrap();
        close(-ring.load[0], 300.0, 1e-6);
        let (mut excess, mut thrown) = (f64::INFINITY, f64::INFINITY);
        for ball in loads.elements.iter().flatten() {
            assert!(
                ball.outer_load_n > ball.inner_load_n && ball.centrifugal_n > 0.0,
                "{ball:?}"
            );
            excess = excess.min(ball.outer_load_n - ball.inner_load_n);
            thrown = thrown.min(ball.centrifugal_n);
        }
        println!(
            "free to tilt at {fast:.0} 1/min, {:?}: radial force off by {:.1e} (allowed 1e-6), least centrifugal force of a ball {thrown:.1} N, least outer less inner load {excess:.1} N",
            operation.control,
            (-ring.load[0] / 300.0 - 1.0).abs()
        );
    }
}

/// Reversal of the shaft turns cage and balls round and leaves the loads.
#[test]
fn reversal_leaves_the_loads() {
    let bearing = bearing(B218);
    let pose = RingPose::from_five(&Vector5::new(1e-5, 0.0, 3e-5, 1e-4, 0.0));
    let (ahead, loads) = bearing.loads(&pose, &at_rpm(8000.0)).unwrap();
    let (back, reversed) = bearing.loads(&pose, &at_rpm(-8000.0)).unwrap();
    let apart = (ahead.load - back.load).norm();
    println!(
        "at 8000 and -8000 1/min: loads apart by {:.1e} (allowed 1e-9)",
        apart / ahead.load.norm()
    );
    assert!(apart < 1e-9 * ahead.load.norm());
    let orbit = loads.elements[0][0].orbit_rad_per_s;
    let reversed_orbit = reversed.elements[0][0].orbit_rad_per_s;
    println!("ball 1 orbits at {orbit:.3} and {reversed_orbit:.3} rad/s");
    close(orbit, -reversed_orbit, 1e-9);
}

/// A very slow bearing is one at rest.
#[test]
fn rest_is_the_limit_of_slow_turning() {
    let (mut worst_load, mut worst_tangent) = (0.0_f64, 0.0_f64);
    for text in [B218, TAPERED] {
        let bearing = bearing(text);
        let pose = RingPose::from_five(&Vector5::new(2e-6, 1e-6, 2e-5, 1e-4, 0.0));
        let still = bearing.evaluate(&pose, &at_rpm(0.0)).unwrap();
        let slow = bearing.evaluate(&pose, &at_rpm(0.1)).unwrap();
        let loads_apart = (still.load - slow.load).norm();
        assert!(loads_apart < 1e-7 * still.load.norm());
        let tangents_apart = (still.tangent - slow.tangent).norm();
        assert!(tangents_apart < 1e-6 * still.tangent.norm());
        worst_load = worst_load.max(loads_apart / still.load.norm());
        worst_tangent = worst_tangent.max(tangents_apart / still.tangent.norm());
    }
    println!("0.1 1/min beside rest: loads apart by {worst_load:.1e} (allowed 1e-7)");
    println!("stiffness apart by {worst_tangent:.1e} (allowed 1e-6)");
}

/// Rows that are mirror images: O and X preloaded alike have the same axial stiffness, O tilts much harder; each row
/// carries the stated preload.
#[test]
fn pairs_are_preloaded_and_o_resists_tilting() {
    let pair = |arrangement: &str| {
        let text = PAIR
            .replace("\"O\"", arrangement)
            .replace("preload_um = 5.0", "preload_N = 400.0");
        bearing(&text)
    };
    let (o, x) = (pair("\"O\""), pair("\"X\""));
    let evaluate = |b: &QuasiStaticBearing| {
        b.evaluate(&RingPose::default(), &Operation::default())
            .unwrap()
    };
    let (k_o, k_x) = (evaluate(&o), evaluate(&x));
    println!(
        "axial stiffness O {:.2} N/um, X {:.2} N/um, apart by {:.1e} (allowed 1e-9)",
        -1e-6 * k_o.tangent[(2, 2)],
        -1e-6 * k_x.tangent[(2, 2)],
        (k_o.tangent[(2, 2)] / k_x.tangent[(2, 2)] - 1.0).abs()
    );
    close(k_o.tangent[(2, 2)], k_x.tangent[(2, 2)], 1e-9);
    println!(
        "tilting stiffness O {:.3e} N m/rad, X {:.3e} N m/rad: {:.2} times (at least 2)",
        -k_o.tangent[(3, 3)],
        -k_x.tangent[(3, 3)],
        k_o.tangent[(3, 3)] / k_x.tangent[(3, 3)]
    );
    assert!(
        k_o.tangent[(3, 3)] < 2.0 * k_x.tangent[(3, 3)],
        "O {} X {}",
        k_o.tangent[(3, 3)],
        k_x.tangent[(3, 3)]
    );
    assert!(k_o.load.norm() < 1e-6 * 400.0);
    let (_, loads) = o
        .loads(&RingPose::default(), &Operation::default())
        .unwrap();
    let axial: f64 = loads.elements[0]
        .iter()
        .map(|e| e.inner_load_n * e.inner_contact_angle_rad.sin())
        .sum();
    println!(
        "preload of a row {axial:.3} N of 400 N, off by {:.1e} (allowed 1e-9); both rows together {:.1e} N (allowed 4e-4 N)",
        (axial / 400.0 - 1.0).abs(),
        k_o.load.norm()
    );
    close(axial, 400.0, 1e-9);
    // Tandem shares a thrust evenly.
    let tandem = bearing(
        &PAIR
            .replace("\"O\"", "\"tandem\"")
            .replace("preload_um = 5.0", ""),
    );
    let pose = rest(&tandem, [0.0, 0.0, 800.0], FREE, 0.0);
    let (_, loads) = tandem.loads(&pose, &Operation::default()).unwrap();
    let (first, second) = (
        loads.elements[0][0].inner_load_n,
        loads.elements[1][0].inner_load_n,
    );
    println!(
        "tandem under 800 N: {first:.2} N on a ball of each row, apart by {:.1e} (allowed 1e-9)",
        (first / second - 1.0).abs()
    );
    close(first, second, 1e-9);
}

/// A tilted roller presses its end; a profile takes the edge's load away.
#[test]
fn a_profile_relieves_the_edge() {
    let sharp = ROLLERS.replace(
        "radial_clearance_um = 10.0",
        "profile = { kind = \"straight\" }",
    );
    let edge = |text: &str| {
        let bearing = bearing(text);
        let pose = rest(
            &bearing,
            [3000.0, 0.0, 0.0],
            TiltCondition::Held([0.0, 2e-3]),
            0.0,
        );
        let (_, loads) = bearing.loads(&pose, &Operation::default()).unwrap();
        // End laminae of the roller that carries most.
        let of_roller = &loads.laminae[0][..40];
        of_roller[0].0.max(of_roller[39].0) / of_roller.iter().map(|q| q.0).fold(0.0, f64::max)
    };
    let straight = edge(&sharp);
    assert!((straight - 1.0).abs() < 1e-9, "{straight}");
    let profiled = ROLLERS.replace("radial_clearance_um = 10.0", "");
    let relieved = edge(&profiled);
    println!(
        "load at the end of the roller by its largest: straight {straight:.3}, with a profile {relieved:.3} (below 0.95)"
    );
    assert!(relieved < 0.95, "{relieved}");
}

/// Radial stiffness of the catalogue's 6205 at 0.1 C beside Palmgren's approximation δ = 4.37e-4 Q_max^⅔ D^−⅓ mm (N,
/// mm; A. Palmgren, *Ball and Roller Bearing Engineering*, 1959; quoted by Harris), Q_max = 5 F/Z: stiffness 1.5 F/δ.
/// The approximation is for all ball bearings alike: its constant stands for one osculation, and Hertz' δ of grooves
/// from 0.515 to 0.53 spans 17 %. Both may be apart by 15 %.
#[test]
fn stiffness_at_a_tenth_of_c_is_near_palmgrens() {
    let bearing = bearing(B6205);
    let force = 1400.0;
    let pose = rest(&bearing, [force, 0.0, 0.0], HELD, 0.0);
    let ring = bearing.evaluate(&pose, &Operation::default()).unwrap();
    let largest: f64 = 5.0 * force / 9.0;
    let palmgren_mm = 4.37e-4 * largest.powf(2.0 / 3.0) * 7.938_f64.powf(-1.0 / 3.0);
    let stiffness = 1.5 * force / (1e-3 * palmgren_mm);
    let found = -ring.tangent[(0, 0)];
    println!(
        "radial stiffness at {force:.0} N: {:.1} N/um, by Palmgren {:.1} N/um: {:+.1} % (allowed 15 %)",
        1e-6 * found,
        1e-6 * stiffness,
        100.0 * (found / stiffness - 1.0)
    );
    close(found, stiffness, 0.15);
    assert!(definition(B6205).stated_ratings.dynamic_n.is_none());
}

/// A ring that walks at random, through lift-off and speed: searches that begin at the places before find what
/// searches from nothing find.
#[test]
fn warm_searches_find_what_cold_ones_find() {
    let mut numbers = fastrand::Rng::with_seed(5);
    let mut any = || 2.0 * numbers.f64() - 1.0;
    let (mut worst_load, mut worst_tangent) = (0.0_f64, 0.0_f64);
    let (mut fewest, mut all) = (usize::MAX, 0);
    for (text, rpm) in [
        (B218, 0.0),
        (B218, 9000.0),
        (B6205, 6000.0),
        (PAIR, 15000.0),
        (ROLLERS, 3000.0),
        (TAPERED, 0.0),
    ] {
        let bearing = bearing(text);
        let operation = at_rpm(rpm);
        let mut places = ElementPlaces::unknown(&bearing.rows);
        let mut compared = 0;
        for _ in 0..200 {
            let q = Vector5::new(
                2e-5 * any(),
                2e-5 * any(),
                4e-5 * any(),
                3e-4 * any(),
                3e-4 * any(),
            );
            let pose = RingPose::from_five(&q);
            let cold = bearing.evaluate(&pose, &operation);
            let warm = bearing.evaluate_from(&pose, &operation, &mut places);
            match (cold, warm) {
                (Ok(cold), Ok(warm)) => {
                    compared += 1;
                    let scale = cold.load.norm() + 1.0;
                    let apart = (cold.load - warm.load).norm();
                    assert!(apart < 1e-9 * scale, "{text} {q:?}");
                    worst_load = worst_load.max(apart / scale);
                    let scale = cold.tangent.norm() + 1.0;
                    let apart = (cold.tangent - warm.tangent).norm();
                    assert!(apart < 1e-6 * scale, "{text} {q:?}");
                    worst_tangent = worst_tangent.max(apart / scale);
                }
                (cold, warm) => assert_eq!(
                    cold.is_err(),
                    warm.is_err(),
                    "{text} {q:?} {cold:?} {warm:?}"
                ),
            }
        }
        assert!(compared > 60, "{text}: {compared}");
        fewest = fewest.min(compared);
        all += compared;
    }
    println!(
        "{all} of 1200 places found by both searches, the others by neither; at least {fewest} of the 200 of each bearing (more than 60 asked)"
    );
    println!(
        "loads apart by {worst_load:.1e} (allowed 1e-9), stiffness by {worst_tangent:.1e} (allowed 1e-6)"
    );
}

/// A single row pulled out of its groove is an error, not a bearing that settles where no groove is.
#[test]
fn a_ring_pulled_out_is_an_error() {
    let bearing = bearing(B218);
    let pulled = RingPose::from_five(&Vector5::new(0.0, 0.0, -2e-3, 0.0, 0.0));
    for rpm in [0.0, 5000.0] {
        let found = bearing.evaluate(&pulled, &at_rpm(rpm));
        assert_eq!(found, Err(BearingError::PulledOut), "{rpm}");
        println!("refused at {rpm} 1/min: {}", found.unwrap_err());
    }
    // A little back, the balls are loose: no load, no error.
    let loose = RingPose::from_five(&Vector5::new(0.0, 0.0, -2e-5, 0.0, 0.0));
    let ring = bearing.evaluate(&loose, &at_rpm(0.0)).unwrap();
    println!("balls loose: load on the ring {} N", ring.load.norm());
    assert_eq!(ring.load.norm(), 0.0);
}

/// Without clearance (the default) and load all contacts just touch and have no slope; at speed each ball then rests
/// in the outer groove under its centrifugal force alone.
#[test]
fn balls_that_just_touch_rest_in_the_outer_groove_at_speed() {
    let bearing = bearing(B6205);
    let (mut inner, mut worst_ball, mut worst_ring) = (0.0_f64, 0.0_f64, 0.0_f64);
    let mut thrown = 0.0_f64;
    for rpm in [1.0, 1000.0, 20_000.0] {
        let pose = rest(&bearing, [0.0; 3], FREE, rpm);
        assert_eq!(pose.to_five().norm(), 0.0);
        let (_, loads) = bearing.loads(&pose, &at_rpm(rpm)).unwrap();
        for ball in &loads.elements[0] {
            assert_eq!(ball.inner_load_n, 0.0);
            close(ball.outer_load_n, ball.centrifugal_n, 1e-5);
            inner = inner.max(ball.inner_load_n.abs());
            worst_ball = worst_ball.max((ball.outer_load_n / ball.centrifugal_n - 1.0).abs());
            thrown = thrown.max(ball.centrifugal_n);
        }
        // As a scene begins: rings in the middle, then a load.
        let pose = rest(&bearing, [0.0, 1000.0, 200.0], HELD, rpm);
        let ring = bearing.evaluate(&pose, &at_rpm(rpm)).unwrap();
        close(-ring.load[1], 1000.0, 1e-9);
        worst_ring = worst_ring.max((-ring.load[1] / 1000.0 - 1.0).abs());
    }
    println!("largest load on a ball at the inner race {inner} N");
    println!(
        "load at the outer race apart from the centrifugal force (up to {thrown:.2} N) by {worst_ball:.1e} (allowed 1e-5)"
    );
    println!("then loaded by 1000 N: force of the bearing off by {worst_ring:.1e} (allowed 1e-9)");
}

/// Rings that hardly touch the balls, or press them hard, at any speed: every ball is found, and carries its
/// centrifugal force.
#[test]
fn balls_are_found_from_no_load_to_heavy_load_at_all_speeds() {
    let (mut balls, mut heaviest_n, mut worst) = (0, 0.0_f64, 0.0_f64);
    for (text, ball_m) in [(B6205, 7.938e-3), (B218, 22.23e-3)] {
        let bearing = bearing(text);
        for rpm in [1.0, 10.0, 100.0, 1000.0] {
            for z in [0.0, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4] {
                for x in [0.0, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5] {
                    let pose = RingPose::from_five(&Vector5::new(x, 0.0, z, 0.0, 0.0));
                    let (_, loads) = bearing
                        .loads(&pose, &at_rpm(rpm))
                        .unwrap_or_else(|e| panic!("{rpm} rpm, x {x}, z {z}: {e}"));
                    for ball in &loads.elements[0] {
                        let (inner, outer) =
                            (ball.inner_contact_angle_rad, ball.outer_contact_angle_rad);
                        // Outer-race control: friction there along the groove carries the gyroscopic moment.
                        let friction = 2.0 * ball.gyroscopic_nm / ball_m;
                        let across = ball.outer_load_n * outer.cos()
                            - ball.inner_load_n * inner.cos()
                            - friction * outer.sin();
                        let scale = ball.outer_load_n + ball.centrifugal_n;
                        let unbalanced_n = (across - ball.centrifugal_n).abs();
                        let allowed_n = 1e-6 * scale + 1e-8;
                        assert!(unbalanced_n < allowed_n, "{ball:?}");
                        balls += 1;
                        heaviest_n = heaviest_n.max(ball.outer_load_n);
                        worst = worst.max(unbalanced_n / allowed_n);
                    }
                }
            }
        }
    }
    println!("{balls} balls found, with up to {heaviest_n:.3e} N at the outer race");
    println!(
        "largest unbalanced radial force {worst:.1e} of what is allowed (1e-6 of the ball's load, and 1e-8 N)"
    );
}

/// 3 balls, 20 and 200 on one circle: with the same thrust a ball each stands as the others do, and the ring goes as
/// far.
#[test]
fn three_and_two_hundred_balls_stand_alike() {
    let axial_m = |balls: usize| {
        let text = format!(
            "name = \"drawn\"\nkind = \"angular-contact\"\nballs = {balls}\nball_diameter_mm = 6.0\npitch_diameter_mm = 480.0\n\
             inner_conformity = 0.52\nouter_conformity = 0.53\ncontact_angle_deg = 30.0\n"
        );
        let bearing = bearing(&text);
        let pose = rest(&bearing, [0.0, 0.0, 40.0 * balls as f64], FREE, 0.0);
        let sideways = pose.centre_m.xy().norm();
        println!(
            "{balls} balls: ring goes {:.4} um along its axis, {:.1e} of it sideways (allowed 1e-9)",
            1e6 * pose.centre_m.z,
            sideways / pose.centre_m.z
        );
        assert!(sideways < 1e-9 * pose.centre_m.z, "{sideways}");
        pose.centre_m.z
    };
    let few = axial_m(3);
    let mut worst = 0.0_f64;
    for balls in [20, 200] {
        let many = axial_m(balls);
        close(many, few, 1e-9);
        worst = worst.max((many / few - 1.0).abs());
    }
    println!("axial displacements apart by {worst:.1e} (allowed 1e-9)");
}

/// Up to a million revolutions a minute, d_m n = 39·10⁶ mm/min, where tonnes of centrifugal force press the balls
/// into the outer race: as long as the ring reaches them it is in equilibrium, then the refusal names the speed.
#[test]
fn up_to_a_million_revolutions_a_minute() {
    let bearing = bearing(B6205);
    let load = AppliedBearingLoad {
        force_n: [0.0, -500.0, 300.0],
        tilt: HELD,
    };
    let mut fastest_rpm = 0.0;
    for rpm in [1e4, 3e4, 1e5, 2e5, 5e5, 1e6] {
        match bearing.equilibrium(&load, &at_rpm(rpm)) {
            Ok(pose) => {
                let (ring, loads) = bearing.loads(&pose, &at_rpm(rpm)).unwrap();
                close(ring.load[1], 500.0, 1e-6);
                for ball in &loads.elements[0] {
                    assert!(ball.outer_load_n > 0.9 * ball.centrifugal_n, "{ball:?}");
                }
                fastest_rpm = rpm;
            }
            Err(error) => {
                let error = error.to_string();
                assert!(error.contains("the speed is beyond what"), "{error}");
                println!("none at {rpm} 1/min: {error}");
            }
        }
    }
    println!("in equilibrium up to {fastest_rpm} 1/min");
    assert!(fastest_rpm >= 1e5);
}

/// From balls pressed in by 20 µm to a play of 200 µm: the ring sinks by half the play and what the contacts deflect,
/// less where all balls carry.
#[test]
fn from_interference_to_much_play() {
    let mut before_m = 0.0;
    for clearance_um in [-20.0, -5.0, 0.0, 5.0, 20.0, 60.0, 200.0] {
        let text = format!("{B6205}radial_clearance_um = {clearance_um:?}\n");
        let bearing = bearing(&text);
        let pose = rest(&bearing, [0.0, -500.0, 0.0], HELD, 0.0);
        let sunk_m = -pose.centre_m.y;
        let (ring, loads) = bearing.loads(&pose, &at_rpm(0.0)).unwrap();
        close(ring.load[1], 500.0, 1e-9);
        assert!(sunk_m > before_m, "{clearance_um} um: {sunk_m}");
        before_m = sunk_m;
        let carrying = (loads.elements[0].iter())
            .filter(|ball| ball.inner_load_n > 0.0)
            .count();
        println!(
            "{clearance_um} um: sinks by {:.2} um, {carrying} balls carry",
            1e6 * sunk_m
        );
        if clearance_um < -10.0 {
            assert_eq!(carrying, 9);
        } else if clearance_um > 0.0 {
            // No ball that carries is farther than half a spacing from the line of the load; one alone under all of it
            // deflects by 13.7 µm: without play the most loaded one has 5 F/Z = 278 N and 9.3 µm, as Q to 2/3.
            let farthest_um = 0.5 * clearance_um / 20_f64.to_radians().cos();
            let sunk_um = 1e6 * sunk_m;
            assert!((0.5 * clearance_um..farthest_um + 15.0).contains(&sunk_um));
        }
    }
}

/// As far as a ring can be tilted: a little less than the refusal names has an equilibrium, a little more has none.
#[test]
fn tilted_to_the_edge_of_what_there_is() {
    let pair = bearing(PAIR);
    let tilted = |mrad: f64| {
        let load = AppliedBearingLoad {
            force_n: [0.0, 0.0, 2000.0],
            tilt: TiltCondition::Held([1e-3 * mrad, 0.0]),
        };
        pair.equilibrium(&load, &at_rpm(0.0))
    };
    let BearingError::TiltedBeyondGroove { found_mrad, .. } = tilted(20.0).unwrap_err() else {
        panic!("another reason");
    };
    println!("found up to {found_mrad:.3} mrad");
    let pose = tilted(0.999 * found_mrad).unwrap();
    let ring = pair.evaluate(&pose, &at_rpm(0.0)).unwrap();
    close(-ring.load[2], 2000.0, 1e-8);
    assert!(tilted(1.01 * found_mrad).is_err());
}
