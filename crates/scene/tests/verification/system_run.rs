//! Runs of systems made in code: rows, resumed runs, equilibria, natural frequencies.

use crate::system_runs;

use std::f64::consts::{PI, TAU};
use std::sync::atomic::AtomicBool;

use gearmesh_dynamics::elements::TorsionSpring;
use gearmesh_dynamics::{
    BodyId, ElementFailure, ForceElement, Interpolation, Loads, MarkerPair, Motion, Params, System,
    Table, TimeFunction, View,
};
use gearmesh_model::FileError;
use gearmesh_scene::system_run::*;
use gearmesh_specification::system::solver::Start;
use system_runs::*;

fn adaptive() -> Params {
    Params::adaptive(5e-3, 1e-7, 1e-7)
}

/// Every column of two results, bit for bit; of the records all but the wall time.
fn assert_same(a: &SystemResult, b: &SystemResult) {
    assert_eq!(a.rows.columns(), b.rows.columns());
    assert_eq!(a.rows.beside(), b.rows.beside());
    for column in a.rows.columns().iter().chain(a.rows.beside()) {
        let bits = |r: &SystemResult| -> Vec<u64> {
            let values = r.rows.read(&column.name).unwrap();
            values.iter().map(|x| x.to_bits()).collect()
        };
        assert_eq!(bits(a), bits(b), "{}", column.name);
    }
    let record = |r: &SystemResult| RunRecord {
        wall_s: 0.0,
        ..r.record.unwrap()
    };
    assert_eq!(record(a), record(b));
    assert_eq!(a.statistics, b.statistics);
    assert_eq!((&a.head, &a.sweep), (&b.head, &b.sweep));
}

/// A run that is stopped after every single step, its process state thrown away each time, writes the bits of one that
/// was not.
#[test]
fn a_run_stopped_after_every_step_writes_the_same_result() {
    for (params, start) in [
        (Params::fixed(2e-3), Start::AsGiven),
        (adaptive(), Start::AsGiven),
        (Params::fixed(2e-3), Start::Equilibrium),
        // Two samples a row: filtered columns wait for what comes after them.
        (Params::fixed(5e-4), Start::AsGiven),
    ] {
        let kind = || {
            RunKind::Transient(InTime {
                params,
                start,
                end_s: 0.2,
                interval_s: 1e-3,
                statistics_from_s: 0.0,
                windows: Vec::new(),
            })
        };
        let desk = Desk::new();
        let whole = desk.run(job(driven_pendulum(), kind()));
        let other = Desk::new();
        let stop = AtomicBool::new(true);
        let mut legs = 1;
        while run(job(driven_pendulum(), kind()), &other.options(&stop)).unwrap()
            == Outcome::Stopped
        {
            assert!(!other.output.exists() && PartFolder::beside(&other.output).exists());
            legs += 1;
        }
        assert!(legs > 50, "{legs} legs");
        assert!(!PartFolder::beside(&other.output).exists());
        assert_same(&whole, &SystemResult::open(&other.output).unwrap());
    }
}

#[test]
fn an_unfinished_run_of_another_scene_is_kept_until_told() {
    let desk = Desk::new();
    let stop = AtomicBool::new(true);
    let kind = || transient(Params::fixed(1e-3), 0.1, 1e-3);
    let first = run(job(driven_pendulum(), kind()), &desk.options(&stop)).unwrap();
    assert_eq!(first, Outcome::Stopped);
    let changed = || {
        let mut job = job(driven_pendulum(), kind());
        job.head.scene_toml.push_str("\n# changed");
        job
    };
    let refused = run(changed(), &desk.options(&stop)).unwrap_err();
    assert!(matches!(refused, SystemRunError::OtherRun { .. }) && refused.is_input());
    let restart = RunOptions {
        restart: true,
        ..desk.options(&stop)
    };
    assert_eq!(run(changed(), &restart).unwrap(), Outcome::Stopped);
    // A checkpoint that is cut is not taken for one.
    let checkpoint = PartFolder::beside(&desk.output).join("checkpoint.h5");
    let bytes = std::fs::read(&checkpoint).unwrap();
    std::fs::write(&checkpoint, &bytes[..bytes.len() / 2]).unwrap();
    let refused = run(changed(), &desk.options(&stop)).unwrap_err();
    let SystemRunError::Checkpoint { source } = refused else {
        panic!("{refused}");
    };
    assert!(matches!(source, FileError::Truncated { .. }), "{source}");
}

#[test]
fn rows_stand_on_a_uniform_grid_to_the_end() {
    // The interval is no multiple of the step, the step none of the run, and adaptive steps follow no grid at all.
    for params in [Params::fixed(0.7e-3), adaptive()] {
        let desk = Desk::new();
        let result = desk.run(job(driven_pendulum(), transient(params, 0.3, 0.9e-3)));
        let times = result.rows.read("time_s").unwrap();
        assert_eq!(times.len(), 334);
        for (k, time) in times.iter().enumerate() {
            assert!((time - 0.9e-3 * k as f64).abs() < 1e-15);
        }
        let columns = result.rows.columns();
        let names: Vec<&str> = columns.iter().map(|c| c.name.as_str()).collect();
        for name in [
            "bodies/bob/x_m",
            "bodies/bob/cardan_z_rad",
            "bodies/bob/angular_acceleration_z_rad_per_s2",
            "joints/hinge/force_y_N",
            "joints/hinge/angle_rad",
            "energy/error_J",
            "run/step_s",
        ] {
            assert!(names.contains(&name), "{name} is not among {names:?}");
        }
        for name in &names {
            let values = result.rows.read(name).unwrap();
            assert!(values.iter().all(|x| x.is_finite()), "{name}");
        }
    }
}

/// Adaptive and fixed steps agree, and so do the columns with each other: the reaction carries weight and inertia.
#[test]
fn adaptive_steps_give_the_motion_of_small_fixed_ones() {
    let fine = Params::adaptive(5e-3, 1e-9, 1e-9);
    let [fixed, adaptive] = [Params::fixed(1e-4), fine].map(|params| {
        let desk = Desk::new();
        desk.run(job(driven_pendulum(), transient(params, 1.0, 1e-2)))
    });
    for (name, tolerance) in [
        ("joints/hinge/angle_rad", 2e-5),
        ("bodies/bob/angular_velocity_z_rad_per_s", 2e-4),
        ("joints/hinge/force_y_N", 2e-2),
    ] {
        let [a, b] = [&fixed, &adaptive].map(|r| r.rows.read(name).unwrap());
        let worst = a
            .iter()
            .zip(&b)
            .fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        assert!(worst < tolerance, "{name}: {worst}");
    }
    let steps = |r: &SystemResult| r.record.unwrap().steps;
    assert!(steps(&adaptive) < steps(&fixed));
    let read = |name: &str| fixed.rows.read(name).unwrap();
    let (force, acceleration) = (
        read("joints/hinge/force_y_N"),
        read("bodies/bob/acceleration_y_m_per_s2"),
    );
    for (force, acceleration) in force.iter().zip(&acceleration) {
        assert!((force - 1.2 * (acceleration + 9.81)).abs() < 1e-4 * 30.0);
    }
}

/// J dω/dt = T: exact for the scheme, so to rounding.
#[test]
fn constant_torque_gives_linear_speed() {
    let mut builder = System::builder();
    let pair = wheel("wheel", &mut builder, 3.0);
    torque(&mut builder, pair, "torque", TimeFunction::Constant(20.0));
    let desk = Desk::new();
    let kind = transient(Params::fixed(1e-3), 2.0, 0.1);
    let result = desk.run(job(builder.build().unwrap(), kind));
    let read = |name: &str| result.rows.read(name).unwrap();
    let speeds = read("bodies/wheel/angular_velocity_z_rad_per_s");
    let turns = read("bodies/wheel/turn_rad");
    for (k, (speed, turn)) in speeds.iter().zip(&turns).enumerate() {
        let t = 0.1 * k as f64;
        assert!((speed - 3.0 - 40.0 * t).abs() < 1e-9, "{speed} at {t}");
        assert!((turn - 3.0 * t - 20.0 * t * t).abs() < 1e-9);
    }
    let record = result.record.unwrap();
    assert!(result.relative_energy_error().unwrap() < 1e-9);
    assert!((record.supplied_j - 20.0 * turns[20]).abs() < 1e-6);
    let figures = &result
        .summaries(|name| name.ends_with("velocity_z_rad_per_s"))
        .unwrap();
    assert!(figures.iter().any(|c| (c.figures.mean - 43.0).abs() < 1e-9));
}

/// A torque about a wheel's axis that nobody supplies.
struct FromNowhere {
    body: [BodyId; 1],
    torque_nm: f64,
}

impl ForceElement for FromNowhere {
    fn name(&self) -> &'static str {
        "from nowhere"
    }

    fn bodies(&self) -> &[BodyId] {
        &self.body
    }

    fn evaluate(&mut self, _: &View<'_>, loads: &mut Loads) -> Result<(), ElementFailure> {
        loads.add_force(5, &[self.torque_nm]);
        Ok(())
    }
}

/// Energy out of nothing is seen beside the million joules that a flywheel just has; an honest load of the same size
/// passes.
#[test]
fn energy_is_judged_against_the_work_done() {
    let run = |made_up: bool| {
        let mut builder = System::builder();
        wheel("flywheel", &mut builder, 2000.0);
        let pair = wheel("wheel", &mut builder, 1.0);
        if made_up {
            builder.element(FromNowhere {
                body: [pair.b.body],
                torque_nm: 2.0,
            });
        } else {
            torque(&mut builder, pair, "torque", TimeFunction::Constant(2.0));
        }
        let desk = Desk::new();
        desk.run(job(
            builder.build().unwrap(),
            transient(Params::fixed(1e-3), 1.0, 0.1),
        ))
    };
    // dω = T t/J = 4 rad/s: 0.25 kg m² (5² − 1²) = 6 J, of 1e6.
    let honest = run(false);
    assert_eq!(honest.problem(), None);
    let work = honest.record.unwrap().work_j;
    assert!(
        (work / 12.0 - 1.0).abs() < 1e-6,
        "by the load and on the wheel: {work}"
    );
    let found = run(true);
    let relative = found.relative_energy_error().unwrap();
    assert!((relative - 1.0).abs() < 1e-6, "{relative}");
    let problem = found.problem().unwrap();
    assert!(
        problem.contains("6.000e0 J came from nowhere") && problem.contains("100.0 %"),
        "{problem}"
    );
}

fn spring_on(pair: MarkerPair) -> gearmesh_dynamics::elements::MarkerElement<TorsionSpring> {
    TorsionSpring::new(50.0, 0.1)
        .between("spring", pair)
        .unwrap()
}

#[test]
fn equilibria_follow_the_load_factor() {
    let system = |factor: f64| {
        let mut builder = System::builder();
        let pair = wheel("wheel", &mut builder, 0.0);
        builder.element(spring_on(pair));
        let load = TimeFunction::Constant(30.0 * factor);
        torque(&mut builder, pair, "torque", load);
        builder.build().unwrap()
    };
    let factors = [0.25, 1.0, 2.5];
    let point = |&load_factor: &f64| StaticPoint {
        angle_rad: None,
        time_s: 0.0,
        load_factor,
        steps: 1,
    };
    let desk = Desk::new();
    let kind = RunKind::Static(StaticJob {
        points: factors.iter().map(point).collect(),
        system_at: Box::new(move |factor| Ok(system(factor))),
    });
    let result = desk.run(job(system(1.0), kind));
    let angles = result
        .rows
        .read("joints/bearing of wheel/angle_rad")
        .unwrap();
    for (angle, factor) in angles.iter().zip(factors) {
        assert!((angle - 0.6 * factor).abs() < 1e-12, "{angle}");
    }
    assert_eq!(result.rows.read("load_factor").unwrap(), factors);
    assert!(result.record.is_none());
}

/// A driver turns a spring through two revolutions and back: angle counted, moment k a, and the opposite on the other
/// side.
#[test]
fn equilibria_follow_a_driver_over_several_turns() {
    let values: Vec<f64> = (0..=40)
        .map(|i| 4.0 * PI * (PI * f64::from(i) / 40.0).sin())
        .collect();
    let system = {
        let values = values.clone();
        move || {
            let times = (0..values.len()).map(|i| i as f64).collect();
            let table = Table::new("driver", times, values.clone(), Interpolation::Linear);
            let motion = Motion::Position(TimeFunction::Table(table.unwrap()));
            let (mut builder, pair) = driven_wheel(motion);
            builder.element(spring_on(pair));
            builder.build().unwrap()
        }
    };
    let point = |(i, &angle): (usize, &f64)| StaticPoint {
        angle_rad: Some(angle),
        time_s: i as f64,
        load_factor: 1.0,
        steps: 1,
    };
    let desk = Desk::new();
    let nominal = system();
    let kind = RunKind::Static(StaticJob {
        points: values.iter().enumerate().map(point).collect(),
        system_at: Box::new(move |_| Ok(system())),
    });
    let result = desk.run(job(nominal, kind));
    let read = |name: &str| result.rows.read(name).unwrap();
    assert_eq!(read("angle_rad"), values);
    let turns = read("bodies/wheel/turn_rad");
    let moments = read("joints/driver/moment_z_Nm");
    for ((angle, turn), moment) in values.iter().zip(turns).zip(moments) {
        assert!((turn - angle).abs() < 1e-11, "{turn} for {angle}");
        let expected = 50.0 * angle;
        assert!(
            (moment - expected).abs() < 1e-8 * 700.0,
            "{moment} for {angle}"
        );
    }
}

/// Two discs on a torsion spring: √(k (J₁+J₂)/(J₁J₂)), shares of the energy J₂ : J₁, and the damping c/k ω/2.
#[test]
fn natural_frequencies_and_participations_have_their_closed_form() {
    let system = || {
        let mut builder = System::builder();
        let first = wheel("first", &mut builder, 0.0);
        let mut body = gearmesh_dynamics::Body::rigid("second", 1.0, [0.1, 0.1, 0.125]);
        body.position_m.z = 0.2;
        let second = builder.body(body).unwrap();
        let place = gearmesh_dynamics::Marker::at(second, [0.0; 3]);
        let ground = gearmesh_dynamics::Marker::ground([0.0, 0.0, 0.2]);
        let kind = gearmesh_dynamics::JointKind::Revolute;
        builder.joint(gearmesh_dynamics::Joint::new("other bearing", kind, ground, place).unwrap());
        builder.element(spring_on(MarkerPair {
            a: first.b,
            b: place,
        }));
        builder.build().unwrap()
    };
    let (j1, j2, k, c) = (0.5_f64, 0.125, 50.0, 0.1);
    let expected = (k * (j1 + j2) / (j1 * j2)).sqrt();
    let settling = Settling {
        time_s: 1e-2,
        params: Params::fixed(1e-3),
        start: Start::AsGiven,
    };
    for settle in [None, Some(settling)] {
        let desk = Desk::new();
        let kind = RunKind::Eigen(EigenJob {
            torques: Vec::new(),
            points: vec![
                EigenPoint {
                    speed_rad_per_s: None,
                    load_factor: 1.0,
                };
                2
            ],
            settle,
            most_frequency_hz: None,
            system_at: Box::new(move |_| Ok(system())),
        });
        let result = desk.run(job(system(), kind));
        assert_eq!(result.bodies, ["first", "second"]);
        assert_eq!(result.eigen.len(), 2);
        let point = &result.eigen[1];
        let (mode, shares) = (
            point.modes.last().unwrap(),
            point.participation.last().unwrap(),
        );
        let omega = mode.natural_angular_frequency_rad_per_s();
        assert!((omega / expected - 1.0).abs() < 1e-9, "{omega} {expected}");
        assert!((mode.damping_ratio() / (0.5 * c / k * expected) - 1.0).abs() < 1e-6);
        assert!(
            (shares[0] - j2 / (j1 + j2)).abs() < 1e-9
                && (shares[0] + shares[1] - 1.0).abs() < 1e-12
        );
        assert!(mode.frequency_hz() < expected / TAU);
    }
}
