//! Bearings at the ends of what is asked of them: no clearance, heavy preload, lift-off, no load at all, from rest,
//! reversal, very fast, very light, askew.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use gearmesh_bearings::dynamic::{DynamicEffects, Rebound, Traction};
use gearmesh_bearings::quasi_static::QuasiStaticBearing;
use gearmesh_bearings::ring_equilibrium::{AppliedBearingLoad, TiltCondition};
use gearmesh_bearings::{Operation, RingPose};
use gearmesh_dynamics::{
    Joint, JointKind, Marker, Motion, Params, Simulation, System, TimeFunction,
};
use nalgebra::Vector5;

use crate::common::{B6205, bearing, close};
use crate::rig::{Channels, Held, cage, element, hold, pockets, row, shaft, system};

pub fn rolling(damping_s_per_m: f64) -> DynamicEffects {
    DynamicEffects {
        rebound: Rebound {
            factor_s_per_m: damping_s_per_m,
        },
        traction: Some(Traction::coulomb(0.08, 2e-2).unwrap()),
        ..DynamicEffects::default()
    }
}

fn axial(shift_m: f64) -> RingPose {
    RingPose::from_five(&Vector5::new(0.0, 0.0, shift_m, 0.0, 0.0))
}

fn at(speed_rad_per_s: f64) -> Operation {
    Operation {
        inner_rad_per_s: speed_rad_per_s,
        ..Operation::default()
    }
}

/// The end of a run with the ring held in its place.
fn held(
    bearing: &QuasiStaticBearing,
    pose: &RingPose,
    speed: f64,
    (step_s, end_s): (f64, f64),
) -> Channels {
    let system = system(bearing, rolling(10.0), pose, speed, &Held::Fast);
    let mut run = Simulation::new(system, Params::fixed(step_s)).unwrap();
    run.run(end_s, |_| ControlFlow::Continue(())).unwrap();
    Channels::at_end(run)
}

/// Loads of all balls against the equilibrium's, as a share of the largest.
#[track_caller]
fn as_in_equilibrium(
    found: &Channels,
    bearing: &QuasiStaticBearing,
    pose: &RingPose,
    speed: f64,
    share: f64,
) {
    let (_, loads) = bearing.loads(pose, &at(speed)).unwrap();
    let largest = loads.elements[0]
        .iter()
        .map(|l| l.outer_load_n)
        .fold(0.0, f64::max);
    let mut worst = 0.0_f64;
    for (ball, load) in loads.elements[0].iter().enumerate() {
        for (race, expected) in [("inner", load.inner_load_n), ("outer", load.outer_load_n)] {
            let here = found.get(&format!("bearing.ball_{}_{race}_N", ball + 1));
            assert!(
                (here - expected).abs() < share * largest,
                "ball {} {race}: {here}, in equilibrium {expected}",
                ball + 1
            );
            worst = worst.max((here - expected).abs() / largest);
        }
    }
    println!(
        "loads on all balls as in equilibrium to {worst:.1e} of the largest, {largest:.3e} N (allowed {share:.0e})"
    );
}

/// Balls that just touch, turning slowly: no ball carries more than its centrifugal force; pressed in by 0.2 mm they
/// carry a kilonewton each.
#[test]
fn no_clearance_and_heavy_preload() {
    let bearing = bearing(B6205);
    let idle = held(&bearing, &axial(0.0), 100.0, (1e-5, 5e-3));
    let ball = row(&bearing);
    let centrifugal = ball.ball_mass_kg * ball.pitch_radius_m * (0.4_f64 * 100.0).powi(2);
    let mut most = 0.0_f64;
    for number in 1..=9 {
        let load = idle.get(&format!("bearing.ball_{number}_outer_N"));
        assert!(load <= 1.1 * centrifugal, "{load} N, {centrifugal} N");
        most = most.max(load);
    }
    println!(
        "just touching: at most {most:.3e} N on a ball, centrifugal force {centrifugal:.3e} N (allowed 1.1 times that)"
    );
    let pose = axial(2e-4);
    // Friction of a kilonewton's load stops a ball within microseconds: the step resolves that.
    let pressed = held(&bearing, &pose, 100.0, (1e-6, 1e-3));
    let carried = pressed.get("bearing.ball_1_inner_N");
    println!("pressed in by 0.2 mm: {carried:.1} N on ball 1 (at least 1000 N)");
    assert!(carried > 1000.0);
    as_in_equilibrium(&pressed, &bearing, &pose, 100.0, 1e-3);
}

/// A caged bearing with clearance under a radial load: each ball that passes the load zone and leaves it carries load
/// and loses it within a turn of the cage.
#[test]
fn balls_lose_contact_each_turn() {
    let bearing = bearing(&format!("{B6205}radial_clearance_um = 15.0\n"));
    let speed = TAU * 50.0;
    let load = AppliedBearingLoad {
        force_n: [0.0, -400.0, 0.0],
        tilt: TiltCondition::Held([0.0; 2]),
    };
    let pose = bearing.equilibrium(&load, &at(speed)).unwrap();
    let mut builder = System::builder();
    let shaft = shaft(&mut builder, &pose, speed);
    hold(&mut builder, shaft, &pose, speed, &Held::Fast);
    let cage = cage(&mut builder, row(&bearing).pitch_radius_m, 0.4 * speed);
    let mut effects = rolling(3.0);
    let mut guided = pockets();
    guided.shape = gearmesh_bearings::dynamic::PocketShape::Spherical;
    effects.cages = vec![(cage, guided)];
    builder.element(element(&bearing, effects, shaft));
    let mut run = Simulation::new(builder.build().unwrap(), Params::fixed(1e-5)).unwrap();
    let mut range = [[f64::INFINITY, 0.0]; 9];
    // A turn of the cage takes 50 ms.
    run.run(0.05, |step| {
        let found = Channels::of(step.system, step.to);
        for (ball, range) in range.iter_mut().enumerate() {
            let load = found.get(&format!("bearing.ball_{}_inner_N", ball + 1));
            *range = [range[0].min(load), range[1].max(load)];
        }
        ControlFlow::Continue(())
    })
    .unwrap();
    let expected = bearing.loads(&pose, &at(speed)).unwrap().1;
    let largest = expected.elements[0]
        .iter()
        .map(|l| l.inner_load_n)
        .fold(0.0, f64::max);
    for [least, most] in range {
        assert!(
            least == 0.0 && most > 0.7 * largest,
            "{least} to {most}, {largest}"
        );
    }
    let highest_low = range.iter().map(|r| r[0]).fold(0.0, f64::max);
    let lowest_peak = range.iter().map(|r| r[1]).fold(f64::INFINITY, f64::min);
    println!(
        "in a turn of the cage each of {} balls falls to {highest_low} N and reaches at least {lowest_peak:.1} N",
        range.len()
    );
    println!(
        "largest load in equilibrium {largest:.1} N: {:.2} of it reached (at least 0.7)",
        lowest_peak / largest
    );
}

/// Balls that touch nothing feel nothing, at rest to the last bit; a run with them goes on.
#[test]
fn all_balls_unloaded() {
    let bearing = bearing(&format!("{B6205}radial_clearance_um = 50.0\n"));
    let rest = held(&bearing, &RingPose::default(), 0.0, (1e-4, 1e-2));
    let mut largest = 0.0_f64;
    for axis in ["x", "y", "z"] {
        let force = rest.get(&format!("bearing.force_shaft_{axis}_N"));
        assert_eq!(force, 0.0);
        largest = largest.max(force.abs());
    }
    println!("at rest: largest force on the shaft {largest} N");
    // In motion they lie on the outer race by centrifugal force alone, and slow down there.
    let moving = held(&bearing, &RingPose::default(), 300.0, (1e-5, 5e-3));
    let (mut inner, mut least, mut most) = (0.0_f64, f64::INFINITY, 0.0_f64);
    for ball in 1..=9 {
        let load = moving.get(&format!("bearing.ball_{ball}_inner_N"));
        assert_eq!(load, 0.0);
        inner = inner.max(load.abs());
        let load = moving.get(&format!("bearing.ball_{ball}_outer_N"));
        assert!(load.is_finite());
        (least, most) = (least.min(load), most.max(load));
    }
    println!(
        "at 300 rad/s: {inner} N on a ball at the inner race, {least:.3e} to {most:.3e} N at the outer"
    );
}

/// Orbit speed of the balls at the end, the shaft driven along its own time function.
fn driven(speed: TimeFunction, start: f64, end_s: f64) -> f64 {
    let bearing = bearing(B6205);
    let pose = axial(5e-5);
    let mut builder = System::builder();
    let shaft = shaft(&mut builder, &pose, start);
    let seat = Marker::ground(pose.centre_m.into()).along(pose.axis.into());
    let of = Marker::at(shaft, [0.0; 3]);
    builder.joint(Joint::new("axis", JointKind::Revolute, seat, of).unwrap());
    let turning = JointKind::Rotation(Motion::Speed(speed));
    builder.joint(Joint::new("speed", turning, seat, of).unwrap());
    builder.element(element(&bearing, rolling(3.0), shaft));
    let mut run = Simulation::new(builder.build().unwrap(), Params::fixed(1e-5)).unwrap();
    run.run(end_s, |_| ControlFlow::Continue(())).unwrap();
    Channels::at_end(run).get("bearing.orbit_speed_rad_per_s")
}

/// Balls at rest are taken along by the shaft, and turn round with it.
#[test]
fn start_from_rest_and_reversal() {
    let loads = bearing(B6205).loads(&axial(5e-5), &at(100.0)).unwrap().1;
    let rolling = loads.elements[0][0].orbit_rad_per_s;
    let start = driven(
        TimeFunction::step(0.0, 0.0, 0.02, 100.0).unwrap(),
        0.0,
        0.03,
    );
    println!(
        "from rest to 100 rad/s: balls orbit at {start:.3} rad/s, rolling {rolling:.3}: off by {:.1e} (allowed 2e-3)",
        (start / rolling - 1.0).abs()
    );
    close(start, rolling, 2e-3);
    let back = driven(
        TimeFunction::step(0.005, 100.0, 0.03, -100.0).unwrap(),
        100.0,
        0.04,
    );
    println!(
        "reversed to -100 rad/s: {back:.3} rad/s: off by {:.1e} (allowed 2e-3)",
        (back / -rolling - 1.0).abs()
    );
    close(back, -rolling, 2e-3);
}

/// d_m n = 4·10⁶ mm/min: 102 000 rpm. Balls press on the outer race by centrifugal force as they do in equilibrium.
#[test]
fn four_million() {
    let bearing = bearing(B6205);
    let speed = 4e6 / 39.04 * TAU / 60.0;
    let pose = axial(1e-4);
    let found = held(&bearing, &pose, speed, (5e-7, 1e-3));
    let ball = row(&bearing);
    let orbit = found.get("bearing.orbit_speed_rad_per_s");
    let centrifugal = ball.ball_mass_kg * ball.pitch_radius_m * orbit * orbit;
    println!("centrifugal force of a ball {centrifugal:.1} N (at least 700 N)");
    assert!(centrifugal > 700.0, "{centrifugal}");
    let expected = bearing.loads(&pose, &at(speed)).unwrap().1.elements[0][0].orbit_rad_per_s;
    println!(
        "balls orbit at {orbit:.1} rad/s, in equilibrium {expected:.1}: off by {:.1e} (allowed 2e-2)",
        (orbit / expected - 1.0).abs()
    );
    close(orbit, expected, 2e-2);
    // The loads are those of the square of that speed.
    as_in_equilibrium(&found, &bearing, &pose, speed, 4e-2);
}

/// A thrust of a millinewton is carried.
#[test]
fn a_millinewton() {
    let bearing = bearing(B6205);
    let load = AppliedBearingLoad {
        force_n: [0.0, 0.0, 1e-3],
        tilt: TiltCondition::Held([0.0; 2]),
    };
    let pose = bearing.equilibrium(&load, &Operation::default()).unwrap();
    let system = system(&bearing, rolling(100.0), &pose, 0.0, &Held::Thrust(1e-3));
    let mut run = Simulation::new(system, Params::fixed(1e-5)).unwrap();
    run.run(5e-3, |_| ControlFlow::Continue(())).unwrap();
    let found = Channels::at_end(run);
    let force = found.get("bearing.force_shaft_z_N");
    println!(
        "axial force on the shaft {force:.5e} N against a thrust of 1e-3 N: off by {:.1e} (allowed 1e-2)",
        (force / -1e-3 - 1.0).abs()
    );
    close(force, -1e-3, 1e-2);
}

/// Ten milliradians of misalignment: heavy loads on the balls, as in equilibrium, and a moment against the tilt.
#[test]
fn ten_milliradians() {
    let bearing = bearing(&format!("{B6205}radial_clearance_um = 20.0\n"));
    let pose = RingPose::from_five(&Vector5::new(0.0, 0.0, 0.0, 0.01, 0.0));
    let found = held(&bearing, &pose, 0.0, (1e-6, 1e-4));
    as_in_equilibrium(&found, &bearing, &pose, 0.0, 5e-3);
    let moment = found.get("bearing.moment_shaft_x_Nm");
    println!("moment on the shaft about the axis of the tilt {moment:.2} N m (below -1 N m)");
    assert!(moment < -1.0, "{moment}");
}
