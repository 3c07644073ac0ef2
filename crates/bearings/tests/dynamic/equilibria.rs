//! Run slowly, the moving balls stand where the equilibrium puts them; and what a step costs.

use std::ops::ControlFlow;
use std::sync::Arc;

use gearmesh_bearings::dynamic::{BearingEffort, DynamicEffects, Rebound, Traction};
use gearmesh_bearings::quasi_static::{QuasiStaticBearing, Row};
use gearmesh_bearings::ring_equilibrium::{AppliedBearingLoad, TiltCondition};
use gearmesh_bearings::{Operation, RingPose};
use gearmesh_dynamics::{Params, Simulation, System};
use nalgebra::Vector5;

use crate::common::{B218, B6205, PAIR, bearing, close};
use crate::rig::{Channels, Held, element, hold, shaft, system};

/// χ of some times the approach's own time takes the start's displacement away.
fn damped(factor_s_per_m: f64) -> DynamicEffects {
    DynamicEffects {
        rebound: Rebound { factor_s_per_m },
        ..DynamicEffects::default()
    }
}

/// Loads under a force and a moment at 60 rpm after a displaced start, against the equilibrium's: 0.1 % of the largest.
/// The runs are short: without cage and friction nothing keeps balls from drifting out of a load zone.
fn compare(text: &str, force_n: [f64; 3], moment_nm: [f64; 2], (damping, end_s): (f64, f64)) {
    let bearing = bearing(text);
    let speed = 2.0 * std::f64::consts::PI;
    let operation = Operation {
        inner_rad_per_s: speed,
        ..Operation::default()
    };
    let load = AppliedBearingLoad {
        force_n,
        tilt: TiltCondition::Moments(moment_nm),
    };
    let pose = bearing.equilibrium(&load, &operation).unwrap();
    let displaced = RingPose::from_five(&(pose.to_five() * 0.97));
    let held = Held::Loaded(force_n, [moment_nm[0], moment_nm[1], 0.0]);
    let system = system(&bearing, damped(damping), &displaced, speed, &held);
    let mut run = Simulation::new(system, Params::fixed(5e-6)).unwrap();
    run.run(end_s, |_| ControlFlow::Continue(())).unwrap();
    // The cage of the equilibrium has gone on with its balls.
    let orbit = bearing.loads(&pose, &operation).unwrap().1.elements[0][0].orbit_rad_per_s;
    let later = Operation {
        cage_angle_rad: orbit * end_s,
        ..operation
    };
    let (_, loads) = bearing.loads(&pose, &later).unwrap();
    let shaft = run.state().positions_m[0];
    let moved = (shaft - pose.centre_m).norm();
    assert!(
        moved < 1e-3 * pose.centre_m.norm(),
        "{shaft} {}",
        pose.centre_m
    );
    let found = Channels::at_end(run);
    let all: Vec<_> = loads.elements.iter().flatten().collect();
    let largest = all.iter().map(|l| l.inner_load_n).fold(0.0, f64::max);
    for (number, ball) in all.iter().enumerate() {
        for (race, expected) in [("inner", ball.inner_load_n), ("outer", ball.outer_load_n)] {
            let here = found.get(&format!("bearing.ball_{}_{race}_N", number + 1));
            assert!(
                (here - expected).abs() < 1e-3 * largest,
                "ball {} {race}: {here} {expected}",
                number + 1
            );
        }
    }
    close(found.get("bearing.orbit_speed_rad_per_s"), orbit, 1e-2);
}

#[test]
fn slow_runs_are_the_equilibrium() {
    compare(B218, [0.0, 0.0, 17800.0], [0.0; 2], (15.0, 4e-3));
    compare(PAIR, [400.0, -150.0, 300.0], [2.0, -1.0], (60.0, 2e-3));
}

/// The ring held where the equilibrium has it and balls that begin 20 nm off: 0.1 % of the largest load, and of force
/// and moment on the ring.
#[test]
fn balls_settle_where_the_equilibrium_has_them() {
    let bearing = bearing(&format!("{B6205}radial_clearance_um = 12.0\n"));
    let speed = 2.0 * std::f64::consts::PI;
    let operation = Operation {
        inner_rad_per_s: speed,
        ..Operation::default()
    };
    let load = AppliedBearingLoad {
        force_n: [0.0, 800.0, 0.0],
        tilt: TiltCondition::Held([0.0; 2]),
    };
    let pose = bearing.equilibrium(&load, &operation).unwrap();
    let system = system(&bearing, damped(3.0), &pose, speed, &Held::Fast);
    let mut state = system.start().clone();
    // Along the radius, where contacts damp; across the contacts nothing does.
    for place in state.unknowns.chunks_exact_mut(3) {
        let share = 1.0 + 2e-8 / place[0].hypot(place[1]);
        place[0] *= share;
        place[1] *= share;
    }
    let mut run = Simulation::from_state(system, state, Params::fixed(1e-6)).unwrap();
    run.run(1e-4, |_| ControlFlow::Continue(())).unwrap();
    let (ring, loads) = bearing.loads(&pose, &operation).unwrap();
    let found = Channels::at_end(run);
    let largest = loads.elements[0]
        .iter()
        .map(|l| l.inner_load_n)
        .fold(0.0, f64::max);
    let mut lifted = 0;
    for (number, ball) in loads.elements[0].iter().enumerate() {
        lifted += usize::from(ball.inner_load_n == 0.0);
        let inner = found.get(&format!("bearing.ball_{}_inner_N", number + 1));
        assert!(
            (inner - ball.inner_load_n).abs() < 1e-3 * largest,
            "{inner} {ball:?}"
        );
    }
    assert!(lifted > 0, "one ball at least carries nothing");
    for (axis, name) in ["x", "y", "z"].iter().enumerate() {
        let force = found.get(&format!("bearing.force_shaft_{name}_N"));
        assert!(
            (force - ring.load[axis]).abs() < 1e-3 * 800.0,
            "{name} {force}"
        );
        let moment = found.get(&format!("bearing.moment_shaft_{name}_Nm"));
        assert!(
            (moment - ring.load[3 + axis]).abs() < 1e-3 * 800.0 * 0.0195,
            "{name} {moment}"
        );
    }
}

/// Under pure thrust without weight no ball differs from another, at 6000 rpm with friction.
#[test]
fn balls_are_alike_under_thrust() {
    let bearing = bearing(
        PAIR.replace("arrangement = \"O\"", "")
            .replace("row_distance_mm = 16.0", "")
            .as_str(),
    );
    let speed = 628.3;
    let effects = DynamicEffects {
        traction: Some(Traction::coulomb(0.05, 0.01).unwrap()),
        ..damped(4.0)
    };
    let system = system(
        &bearing,
        effects,
        &RingPose::default(),
        speed,
        &Held::Thrust(500.0),
    );
    let mut run = Simulation::new(system, Params::fixed(1e-5)).unwrap();
    run.run(0.01, |_| ControlFlow::Continue(())).unwrap();
    let found = Channels::at_end(run);
    let first = found.get("bearing.ball_1_inner_N");
    assert!(first > 30.0, "{first}");
    for ball in 2..=19 {
        close(
            found.get(&format!("bearing.ball_{ball}_inner_N")),
            first,
            1e-6,
        );
    }
}

/// A system with this many balls.
fn with_balls(balls: usize, effort: &Arc<BearingEffort>, effects: DynamicEffects) -> System {
    let mut bearing = bearing(B6205);
    if let Row::Ball(row) = &mut bearing.rows[0] {
        row.balls = balls;
    }
    counted(&bearing, effort, effects)
}

fn counted(
    bearing: &QuasiStaticBearing,
    effort: &Arc<BearingEffort>,
    effects: DynamicEffects,
) -> System {
    let mut builder = System::builder();
    let pose = RingPose::from_five(&Vector5::new(3e-6, 0.0, 2e-5, 0.0, 0.0));
    let shaft = shaft(&mut builder, &pose, 100.0);
    hold(&mut builder, shaft, &pose, 100.0, &Held::Fast);
    builder.element(element(bearing, effects, shaft).counted(effort.clone()));
    builder.build().unwrap()
}

/// Entries of the tangent and evaluations of contacts grow with the number of balls and no faster; what is not named is
/// not called.
#[test]
fn cost_is_linear_in_the_balls() {
    let mut seen = Vec::new();
    for balls in [6, 12, 24] {
        let effort = Arc::new(BearingEffort::default());
        let mut system = with_balls(balls, &effort, damped(4.0));
        let start = system.start().clone();
        let zero = vec![0.0; system.degrees_of_freedom()];
        let before = effort.counts();
        let probe = system
            .probe("bearing", &start, &zero, &start.velocity)
            .unwrap();
        let after = effort.counts();
        let entries = probe.by_position.iter().filter(|x| **x != 0.0).count();
        seen.push((entries, after[0] - before[0], after[2] - before[2]));
    }
    // Twice as many balls more bring twice as many entries more; a few are zero where a ball stands on an axis.
    let more = [seen[1].0 - seen[0].0, seen[2].0 - seen[1].0];
    assert!(10 * more[1] <= 21 * more[0], "{seen:?}");
    for pair in seen.windows(2) {
        assert_eq!(pair[1].1, 2 * pair[0].1, "{seen:?}");
    }
    assert!(seen.iter().all(|s| s.2 == 0), "traction was not named");
    let effort = Arc::new(BearingEffort::default());
    let rolling = DynamicEffects {
        traction: Some(Traction::coulomb(0.05, 0.01).unwrap()),
        ..DynamicEffects::default()
    };
    let mut system = with_balls(6, &effort, rolling);
    let start = system.start().clone();
    let zero = vec![0.0; system.degrees_of_freedom()];
    let before = effort.counts();
    system
        .probe("bearing", &start, &zero, &start.velocity)
        .unwrap();
    let [_, contacts, tractions, pockets] = effort.counts();
    assert_eq!(tractions - before[2], contacts - before[1]);
    assert_eq!(pockets, 0);
}

/// A ball is missing: the others have states and channels under their own numbers, and settle where the equilibrium
/// without it has them.
#[test]
fn moving_balls_know_nothing_of_a_missing_one() {
    let bearing = bearing(&format!(
        "{B218}[[fault]]\nkind = \"missing\"\nelement = 5\n"
    ));
    let speed = 2.0 * std::f64::consts::PI;
    let operation = Operation {
        inner_rad_per_s: speed,
        ..Operation::default()
    };
    let load = AppliedBearingLoad {
        force_n: [3000.0, 0.0, 17800.0],
        tilt: TiltCondition::Held([0.0; 2]),
    };
    let pose = bearing.equilibrium(&load, &operation).unwrap();
    let system = system(&bearing, damped(15.0), &pose, speed, &Held::Fast);
    let mut run = Simulation::new(system, Params::fixed(5e-6)).unwrap();
    run.run(2e-3, |_| ControlFlow::Continue(())).unwrap();
    let found = Channels::at_end(run);
    let (_, loads) = bearing.loads(&pose, &operation).unwrap();
    let balls = loads.elements[0].iter().enumerate();
    for (number, ball) in balls.filter(|(number, _)| *number != 4) {
        let here = found.get(&format!("bearing.ball_{}_inner_N", number + 1));
        assert!(
            (here - ball.inner_load_n).abs() < 3e-3 * loads.elements[0][0].inner_load_n,
            "{here} {ball:?}"
        );
    }
    assert_eq!(loads.elements[0][4].inner_load_n, 0.0);
    close(found.get("bearing.force_shaft_z_N"), -17800.0, 2e-3);
}
