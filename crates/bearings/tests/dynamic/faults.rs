//! What faults do to the force on the rings: the lines of FTF, BSF, BPFO and BPFI, waves that a set of balls feels or
//! does not, energy, and a bearing without any.
//!
//! Which orders of waves a set of Z balls feels: kZ along the axis, kZ ± 1 across it (F. P. Wardle, *Vibration forces
//! produced by waviness of the rolling surfaces of thrust loaded ball bearings*, Proc. IMechE C 202 (1988), parts 1
//! and 2).

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use gearmesh_bearings::dynamic::{DynamicEffects, Rebound, Traction};
use gearmesh_bearings::{BearingFrequencies, DynamicBearing, Operation, RingPose};
use gearmesh_dynamics::{GROUND, Marker, MarkerPair, Params, Simulation};
use nalgebra::Vector5;

use crate::common::{B6205, bearing, definition};
use crate::rig::{Channels, Held, shaft, system};

const SPEED: f64 = TAU * 100.0;
const STEP_S: f64 = 1e-5;
const STEPS: usize = 10_000;

fn pose() -> RingPose {
    RingPose::from_five(&Vector5::new(0.0, 0.0, 5e-5, 0.0, 0.0))
}

fn effects() -> DynamicEffects {
    DynamicEffects {
        rebound: Rebound {
            factor_s_per_m: 3.0,
        },
        traction: Some(Traction::coulomb(0.08, 2e-2).unwrap()),
        ..DynamicEffects::default()
    }
}

/// FTF, BSF, BPFO, BPFI at the contact angle under load.
fn lines() -> BearingFrequencies {
    let operation = Operation {
        inner_rad_per_s: SPEED,
        ..Operation::default()
    };
    let (_, loads) = bearing(B6205).loads(&pose(), &operation).unwrap();
    let ball = loads.elements[0][0];
    let mut sizes = definition(B6205).rolling_sizes();
    sizes.contact_angle_rad = 0.5 * (ball.inner_contact_angle_rad + ball.outer_contact_angle_rad);
    sizes.frequencies(SPEED / TAU, 0.0)
}

/// Amplitudes of the lines of a channel, 10 Hz apart, of a tenth of a second at 6000 rpm after a hundredth; a Hann
/// window.
fn spectrum(faults: &str, channel: &str) -> Vec<f64> {
    let bearing = bearing(&format!("{B6205}{faults}"));
    let system = system(&bearing, effects(), &pose(), SPEED, &Held::Fast);
    let mut run = Simulation::new(system, Params::fixed(STEP_S)).unwrap();
    let name = format!("bearing.{channel}");
    let mut values = Vec::with_capacity(STEPS + 1000);
    run.run(STEP_S * (STEPS as f64 + 1000.0), |step| {
        values.push(Channels::of(step.system, step.to).get(&name));
        ControlFlow::Continue(())
    })
    .unwrap();
    let values = &values[values.len() - STEPS..];
    let mean = values.iter().sum::<f64>() / STEPS as f64;
    let window = |i: usize| 1.0 - (TAU * i as f64 / STEPS as f64).cos();
    let line = |bin: usize| {
        let (mut real, mut imaginary) = (0.0, 0.0);
        for (i, value) in values.iter().enumerate() {
            let (s, c) = (TAU * (bin * i % STEPS) as f64 / STEPS as f64).sin_cos();
            let share = (value - mean) * window(i);
            real += share * c;
            imaginary += share * s;
        }
        2.0 * real.hypot(imaginary) / STEPS as f64
    };
    (0..150).map(line).collect()
}

/// The highest line within a third of a frequency lies within one bin of it; its amplitude.
#[track_caller]
fn line_at(spectrum: &[f64], hz: f64) -> f64 {
    let bins = (0.67 * hz / 10.0).ceil() as usize..=(1.33 * hz / 10.0) as usize;
    let bins = *bins.start().max(&2)..=*bins.end();
    let highest = bins
        .max_by(|a, b| spectrum[*a].total_cmp(&spectrum[*b]))
        .unwrap();
    assert!(
        (10.0 * highest as f64 - hz).abs() <= 10.0,
        "line at {} Hz, expected {hz:.2} Hz: {:?}",
        10 * highest,
        &spectrum[..80]
    );
    spectrum[highest]
}

const OUTER: &str = "[[fault]]\nkind = \"race-spall\"\nrace = \"outer\"\nangle_deg = 20.0\nlength_mm = 1.0\ndepth_um = 4.0\n";

#[test]
fn every_fault_shows_its_line_and_the_sound_bearing_none() {
    let f = lines();
    let sound = spectrum("", "force_shaft_z_N");
    for (faults, hz) in [
        (OUTER.to_owned(), f.outer_race_hz),
        (OUTER.replace("outer", "inner"), f.inner_race_hz),
        (
            "[[fault]]\nkind = \"ball-spall\"\nball = 2\ndiameter_mm = 2.0\ndepth_um = 4.0\n"
                .to_owned(),
            2.0 * f.element_hz,
        ),
        (
            "[[fault]]\nkind = \"waviness\"\nrace = \"outer\"\norder = 9\nradial_um = 0.5\n"
                .to_owned(),
            f.outer_race_hz,
        ),
        (
            "[[fault]]\nkind = \"waviness\"\nrace = \"inner\"\norder = 9\naxial_um = 0.5\n"
                .to_owned(),
            f.inner_race_hz,
        ),
    ] {
        let found = spectrum(&faults, "force_shaft_z_N");
        let height = line_at(&found, hz);
        let bin = (hz / 10.0).round() as usize;
        let without = sound[bin - 1..=bin + 1]
            .iter()
            .fold(0.0_f64, |a, b| a.max(*b));
        assert!(height > 0.05, "{faults}: {height} N");
        assert!(
            without < 1e-3 * height,
            "{faults}: {height} N, sound {without} N"
        );
    }
}

/// An off-size ball goes round with the cage, a ring that stands askew with its shaft.
#[test]
fn off_size_balls_and_misaligned_rings_turn_with_what_carries_them() {
    let f = lines();
    let sound = spectrum("", "force_shaft_x_N");
    let large = "[[fault]]\nkind = \"off-size-ball\"\nball = 4\noversize_um = 1.0\n";
    let height = line_at(&spectrum(large, "force_shaft_x_N"), f.cage_hz);
    assert!(
        height > 0.5 && sound[4] < 1e-3 * height,
        "{height} {}",
        sound[4]
    );
    let askew = "[[fault]]\nkind = \"misaligned-ring\"\nring = \"inner\"\ntilt_mrad = [0.2, 0.0]\n";
    let sound = spectrum("", "moment_shaft_y_Nm");
    let height = line_at(&spectrum(askew, "moment_shaft_y_Nm"), SPEED / TAU);
    assert!(
        height > 1e-2 && sound[10] < 1e-3 * height,
        "{height} {}",
        sound[10]
    );
}

/// Nine balls feel nine waves along the axis and eight across it; eight along it do not reach the axial force.
#[test]
fn which_waves_a_set_of_balls_feels() {
    let waves = |order: u32| {
        format!(
            "[[fault]]\nkind = \"waviness\"\nrace = \"outer\"\norder = {order}\nradial_um = 0.2\n"
        )
    };
    let bin = (lines().outer_race_hz / 10.0).round() as usize;
    let at = |order, channel: &str| {
        let found = spectrum(&waves(order), channel);
        found[bin - 1..=bin + 1]
            .iter()
            .fold(0.0_f64, |a, b| a.max(*b))
    };
    let (along, across) = (at(9, "force_shaft_z_N"), at(8, "force_shaft_x_N"));
    let (not_along, not_across) = (at(8, "force_shaft_z_N"), at(9, "force_shaft_x_N"));
    assert!(not_along < 0.05 * along, "{along} {not_along}");
    assert!(not_across < 0.05 * across, "{across} {not_across}");
}

/// A fault without depth is no fault: the same force to the last bit; one of a picometre is nearly none.
#[test]
fn a_fault_without_depth_is_none() {
    let force = |faults: &str| {
        let bearing = bearing(&format!("{B6205}{faults}"));
        let system = system(&bearing, effects(), &pose(), SPEED, &Held::Fast);
        let mut run = Simulation::new(system, Params::fixed(STEP_S)).unwrap();
        run.run(2e-3, |_| ControlFlow::Continue(())).unwrap();
        let found = Channels::at_end(run);
        ["x", "y", "z"].map(|axis| found.get(&format!("bearing.force_shaft_{axis}_N")))
    };
    let all = |um: &str| {
        format!(
            "{}[[fault]]\nkind = \"waviness\"\nrace = \"inner\"\norder = 5\nradial_um = {um}\naxial_um = {um}\n\
             [[fault]]\nkind = \"off-size-ball\"\nball = 1\noversize_um = {um}\n\
             [[fault]]\nkind = \"ball-spall\"\nball = 1\ndiameter_mm = 1.0\ndepth_um = {um}\n",
            OUTER.replace("4.0", um)
        )
    };
    let sound = force("");
    assert_eq!(sound, force(&all("0.0")));
    for (a, b) in sound.iter().zip(force(&all("1e-6"))) {
        assert!((a - b).abs() < 1e-4 * sound[2].abs(), "{a} {b}");
    }
}

/// Without friction and damping races with spalls and waves take no energy and give none: what the balance misses falls
/// with the square of the step.
#[test]
fn faults_make_no_energy() {
    let faults = format!(
        "{OUTER}{}[[fault]]\nkind = \"waviness\"\nrace = \"inner\"\norder = 7\nradial_um = 0.5\naxial_um = 0.5\n",
        OUTER.replace("outer", "inner").replace("20.0", "95.0")
    );
    let bearing = bearing(&format!("{B6205}{faults}"));
    let (ring, _) = bearing.loads(&pose(), &Operation::default()).unwrap();
    let thrust = [0.0, 0.0, -ring.load[2]];
    let missed = |step_s: f64| {
        let held = Held::Loaded(thrust, [0.0; 3]);
        let system = system(&bearing, DynamicEffects::default(), &pose(), SPEED, &held);
        let params = Params {
            rho_infinity: 1.0,
            ..Params::fixed(step_s)
        };
        let mut run = Simulation::new(system, params).unwrap();
        run.run(1e-3, |_| ControlFlow::Continue(())).unwrap();
        run.info().energy.largest_error_j
    };
    let (coarse, fine) = (missed(1e-6), missed(5e-7));
    assert!(fine < 0.3 * coarse, "{coarse:e} {fine:e}");
    // The contacts store some millijoules.
    assert!(fine < 1e-6, "{fine:e}");
}

/// Nothing turns balls without friction: a spall on one cannot come round.
#[test]
fn a_spalled_ball_needs_friction() {
    let text = format!(
        "{B6205}[[fault]]\nkind = \"ball-spall\"\nball = 2\ndiameter_mm = 2.0\ndepth_um = 4.0\n"
    );
    let bearing = bearing(&text);
    let mut builder = gearmesh_dynamics::System::builder();
    let shaft = shaft(&mut builder, &pose(), 0.0);
    let pair = MarkerPair {
        a: Marker::at(GROUND, [0.0; 3]),
        b: Marker::at(shaft, [0.0; 3]),
    };
    let refused = DynamicBearing::new("bearing", pair, &bearing, DynamicEffects::default());
    assert!(
        refused
            .err()
            .unwrap()
            .to_string()
            .contains("needs traction")
    );
    let at_rest = gearmesh_bearings::QuasiStaticElement::new(
        "bearing",
        pair,
        &definition(&text),
        gearmesh_bearings::Control::OuterRace,
        gearmesh_bearings::RingDamping::default(),
    );
    assert!(at_rest.err().unwrap().to_string().contains("`dynamic`"));
}

/// The bearing in equilibrium feels the same waves and the same off-size ball as slow balls do.
#[test]
fn the_equilibrium_has_the_faults_of_the_balls() {
    let faults = format!(
        "{}[[fault]]\nkind = \"waviness\"\nrace = \"outer\"\norder = 4\nradial_um = 1.0\naxial_um = 0.5\nphase_deg = 30.0\n\
         [[fault]]\nkind = \"off-size-ball\"\nball = 3\noversize_um = 1.5\n",
        OUTER.replace("20.0", "1.5").replace("outer", "inner")
    );
    let bearing = bearing(&format!("{B6205}{faults}"));
    let damped = DynamicEffects {
        rebound: Rebound {
            factor_s_per_m: 10.0,
        },
        ..DynamicEffects::default()
    };
    let system = system(&bearing, damped, &pose(), 0.0, &Held::Fast);
    let mut run = Simulation::new(system, Params::fixed(2e-6)).unwrap();
    run.run(4e-4, |_| ControlFlow::Continue(())).unwrap();
    let (ring, loads) = bearing.loads(&pose(), &Operation::default()).unwrap();
    let found = Channels::at_end(run);
    let largest = loads.elements[0]
        .iter()
        .map(|l| l.inner_load_n)
        .fold(0.0, f64::max);
    for (ball, load) in loads.elements[0].iter().enumerate() {
        let here = found.get(&format!("bearing.ball_{}_inner_N", ball + 1));
        assert!(
            (here - load.inner_load_n).abs() < 2e-3 * largest,
            "{here} {load:?}"
        );
    }
    assert!(ring.load[0].hypot(ring.load[1]) > 0.01 * ring.load[2].abs());
    for (axis, name) in ["x", "y", "z"].iter().enumerate() {
        let force = found.get(&format!("bearing.force_shaft_{name}_N"));
        assert!(
            (force - ring.load[axis]).abs() < 2e-3 * ring.load[2].abs(),
            "{name} {force}"
        );
    }
}

/// Forces on the shaft at each multiple of 10 µs, steps of `step_s`.
fn history(faults: &str, end_s: f64, step_s: f64) -> Vec<[f64; 3]> {
    let bearing = bearing(&format!("{B6205}{faults}"));
    let system = system(&bearing, effects(), &pose(), SPEED, &Held::Fast);
    let mut run = Simulation::new(system, Params::fixed(step_s)).unwrap();
    let stride = (STEP_S / step_s).round() as usize;
    let (mut values, mut count) = (Vec::new(), 0);
    run.run(end_s, |step| {
        count += 1;
        if count % stride == 0 {
            let channels = Channels::of(step.system, step.to);
            values
                .push(["x", "y", "z"].map(|a| channels.get(&format!("bearing.force_shaft_{a}_N"))));
        }
        ControlFlow::Continue(())
    })
    .unwrap();
    values
}

/// Balls that leave and strike: with halved steps the force over time tends to one course.
#[test]
fn the_history_over_a_spall_converges_with_the_step() {
    let deep = OUTER.replace("depth_um = 4.0", "depth_um = 20.0");
    for faults in [OUTER, &deep, &OUTER.replace("outer", "inner")] {
        let all = [1e-5, 5e-6, 2.5e-6, 1.25e-6].map(|step| history(faults, 0.02, step));
        let apart: Vec<f64> = all
            .windows(2)
            .map(|pair| {
                let squares = pair[0].iter().zip(&pair[1]);
                let sum: f64 = squares
                    .flat_map(|(a, b)| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)))
                    .sum();
                (sum / pair[0].len() as f64).sqrt()
            })
            .collect();
        // Of second order: a quarter with each halving, of forces that swing by hundreds of newtons.
        for pair in apart.windows(2) {
            assert!(pair[1] < 0.35 * pair[0], "{faults} {apart:?}");
        }
    }
}
