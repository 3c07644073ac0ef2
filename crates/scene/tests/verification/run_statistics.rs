//! What a run says of its columns: frequencies, spectra and peaks of all steps, statistics of the steady part.

use std::f64::consts::{PI, TAU};

use gearmesh_dynamics::{Params, System, TimeFunction};
use gearmesh_scene::system_run::*;
use gearmesh_specification::system::solver::Start;

use crate::system_runs::*;

#[test]
fn the_dominant_frequency_is_that_of_the_load() {
    let mut builder = System::builder();
    let pair = wheel("wheel", &mut builder, 0.0);
    let sine = TimeFunction::Sine {
        offset: 0.0,
        amplitude: 5.0,
        frequency_hz: 37.0,
        phase_rad: 0.0,
    };
    torque(&mut builder, pair, "torque", sine);
    let desk = Desk::new();
    let kind = transient(Params::fixed(5e-4), 2.0, 1e-3);
    let result = desk.run(job(builder.build().unwrap(), kind));
    let wanted = "bodies/wheel/angular_acceleration_z_rad_per_s2";
    let found = &result.summaries(|name| name == wanted).unwrap()[0];
    assert!((found.dominant_hz.unwrap() - 37.0).abs() < 0.5, "{found:?}");
    // Amplitude over √2.
    assert!((found.figures.deviation - 10.0 * std::f64::consts::FRAC_1_SQRT_2).abs() < 0.02);
}

/// A wheel under two torques, at 70 Hz and at 930 Hz, looked at once a step and written at 1 kHz, where 930 Hz would be
/// seen at 70.
#[test]
fn spectra_and_peaks_are_those_of_the_steps() {
    let sine = |amplitude: f64, frequency_hz: f64| TimeFunction::Sine {
        offset: 0.0,
        amplitude,
        frequency_hz,
        phase_rad: 0.0,
    };
    let system = || {
        let mut builder = System::builder();
        let pair = wheel("wheel", &mut builder, 10.0);
        torque(&mut builder, pair, "slow", sine(2.0, 110.0));
        torque(&mut builder, pair, "fast", sine(20.0, 930.0));
        builder.build().unwrap()
    };
    let kind = |statistics_from_s: f64| {
        RunKind::Transient(InTime {
            params: Params::fixed(1e-4),
            start: Start::AsGiven,
            end_s: 0.5,
            interval_s: 1e-3,
            statistics_from_s,
            windows: Vec::new(),
        })
    };
    let desk = Desk::new();
    let result = desk.run(job(system(), kind(0.25)));
    assert_eq!(result.samples_per_row, 10);
    let speed = "bodies/wheel/angular_velocity_z_rad_per_s";
    let line = |values: &[f64], hz: f64| {
        // Over 0.4 s in the middle: whole periods of both tones.
        let values = &values[50..450];
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let part = |shift: f64| -> f64 {
            let at = |k: usize| TAU * hz * 1e-3 * k as f64 + shift;
            let terms = values.iter().enumerate();
            terms.map(|(k, x)| (x - mean) * at(k).cos()).sum::<f64>() * 2.0 / values.len() as f64
        };
        part(0.0).hypot(part(-0.5 * PI))
    };
    // Amplitude of the speed: M/(2 pi f I).
    let amplitude = |torque: f64, hz: f64| torque / (TAU * hz * 0.5);
    let instants = result.rows.read(speed).unwrap();
    let filtered = result.read_for_spectrum(speed).unwrap();
    let (slow, fast) = (amplitude(2.0, 110.0), amplitude(20.0, 930.0));
    assert!((line(&instants, 70.0) / fast - 1.0).abs() < 0.05, "folded");
    assert!(
        line(&filtered, 70.0) < 1e-4 * fast,
        "{:e}",
        line(&filtered, 70.0)
    );
    assert!((line(&filtered, 110.0) / slow - 1.0).abs() < 0.01);
    // Rows meet the fast tone at other places of its period than its peaks; the samples do not miss them.
    let place = result
        .rows
        .columns()
        .iter()
        .position(|c| c.name == speed)
        .unwrap();
    let figures = result.statistics[place];
    assert!((figures.peak_to_peak() / (2.0 * (slow + fast)) - 1.0).abs() < 0.03);
    let rms = (0.5 * (slow * slow + fast * fast)).sqrt();
    assert!(
        (figures.deviation / rms - 1.0).abs() < 0.02,
        "{figures:?} {rms:e}"
    );
    // The acceleration is not filtered: nearly all of it is the fast tone, and reported.
    let share = result
        .folded_share("bodies/wheel/angular_acceleration_z_rad_per_s2")
        .unwrap();
    assert!(share > 0.9, "{share}");
    assert_eq!(result.folded_share(speed), None);
    assert_eq!(
        result.statistics_in_words(),
        "figures from 0.25 s to 0.5 s, of 10 samples a row"
    );
}

/// A wheel that speeds up at first only: the steady half has no spread.
#[test]
fn statistics_leave_out_the_start() {
    let step = TimeFunction::step(0.0, 5.0, 0.1, 0.0).unwrap();
    let mut builder = System::builder();
    let pair = wheel("wheel", &mut builder, 0.0);
    torque(&mut builder, pair, "start", step);
    let kind = transient_from(Params::fixed(1e-3), 0.4, 1e-3, 0.2);
    let result = Desk::new().run(job(builder.build().unwrap(), kind));
    let speed = "bodies/wheel/angular_velocity_z_rad_per_s";
    let place = result
        .rows
        .columns()
        .iter()
        .position(|c| c.name == speed)
        .unwrap();
    let figures = result.statistics[place];
    let last = *result.rows.read(speed).unwrap().last().unwrap();
    assert!(
        last > 0.1 && figures.peak_to_peak() < 1e-9 * last,
        "{figures:?}"
    );
}
