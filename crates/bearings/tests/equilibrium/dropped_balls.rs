//! Angular-contact balls that centrifugal forces drop off the inner ring. Forces of a ball are differences of the
//! potential energy of its contacts, its motion is Harris' closed form: nothing of the program's formulas is used.
#![allow(clippy::print_stdout)] // figures of the campaign

use crate::common::{bearing, close, definition};
use gearmesh_bearings::quasi_static::Row;
use gearmesh_bearings::warnings::{Concern, Judged};
use gearmesh_bearings::{
    AppliedBearingLoad, BallRow, BearingError, ElementLoad, ElementPlaces, Life, Operation,
    QuasiStaticBearing, RingPose, TiltCondition,
};
use nalgebra::{Vector2, Vector3, Vector5};

/// Large balls at a steep angle: at 4700 rpm each has some 300 N of centrifugal force, and 4.8 kN for all of them.
const LARGE: &str = r#"
name = "large balls"
kind = "angular-contact"
balls = 15
ball_diameter_mm = 24.174919844868697
pitch_diameter_mm = 216.66916286890475
inner_conformity = 0.5131164552247426
outer_conformity = 0.5351324242005663
contact_angle_deg = 40.339456381349173
"#;

const FORCE_N: [f64; 3] = [1243.51, -248.149, 4650.328];
const TILT_RAD: [f64; 2] = [4.445_112_616_813_046e-4, 1.679_103_975_1e-4];

fn load() -> AppliedBearingLoad {
    AppliedBearingLoad {
        force_n: FORCE_N,
        tilt: TiltCondition::Held(TILT_RAD),
    }
}

fn at_rpm(rpm: f64) -> Operation {
    Operation {
        inner_rad_per_s: rpm * std::f64::consts::PI / 30.0,
        ..Operation::default()
    }
}

fn row() -> BallRow {
    match &bearing(LARGE).rows[0] {
        Row::Ball(row) => row.clone(),
        _ => panic!("balls"),
    }
}

/// Distance of a point from the circle of the inner groove's centres, and whether the point lies on the side that faces
/// the groove.
fn from_inner_circle(row: &BallRow, pose: &RingPose, point: &Vector3<f64>) -> Vector2<f64> {
    let v = point - pose.centre_m;
    let height = v.dot(&pose.axis);
    let radius = (v.norm_squared() - height * height).sqrt();
    Vector2::new(
        radius - row.inner.centre_radius_m,
        height - row.inner.centre_z_m,
    )
}

/// Energy of a ball's contact with the inner ring, 2/5 k δ^5/2: with the groove, or `beyond` its end with the edge
/// there, a groove's radius above or below the circle of its centres. Differences keep to one of them: where they meet,
/// forces are equal and their slopes are not.
fn inner_energy(row: &BallRow, pose: &RingPose, point: &Vector3<f64>, beyond: bool) -> f64 {
    let apart = from_inner_circle(row, pose, point);
    let radius = 0.5 * row.ball_diameter_m;
    let depth = if beyond {
        radius - apart[0].hypot(row.inner.arm_m + radius - apart[1].abs())
    } else {
        apart.norm() - row.inner.arm_m
    };
    0.4 * row.inner.contact.stiffness_n_per_m15 * depth.max(0.0).powf(2.5)
}

fn outer_energy(row: &BallRow, place: &Vector2<f64>) -> f64 {
    let apart = place - Vector2::new(row.outer.centre_radius_m, row.outer.centre_z_m);
    let depth = (apart.norm() - row.outer.arm_m).max(0.0);
    0.4 * row.outer.contact.stiffness_n_per_m15 * depth.powf(2.5)
}

/// Central difference of fourth order \[N\]. Steps of a fiftieth of the contact's depth leave (1/50)⁴ and some 1e-9 of
/// rounding: below 1e-6 of the force.
fn slope(h: f64, energy: impl Fn(f64) -> f64) -> f64 {
    (8.0 * (energy(h) - energy(-h)) - (energy(2.0 * h) - energy(-2.0 * h))) / (12.0 * h)
}

/// What is left of the forces on a ball, and its force on the inner ring \[N\].
fn ball_forces(
    row: &BallRow,
    pose: &RingPose,
    rpm: f64,
    ball: &ElementLoad,
) -> (Vector2<f64>, Vector3<f64>) {
    let (s, c) = ball.angle_rad.sin_cos();
    let e_r = Vector3::new(c, s, 0.0);
    let place = Vector2::new(
        row.pitch_radius_m + ball.radial_m,
        row.middle_z_m + ball.axial_m,
    );
    let at = |p: &Vector2<f64>| e_r * p[0] + Vector3::z() * p[1];
    // A ball that the inner ring does not press may lie as near to it as a step of the differences: it must not reach
    // in.
    let pressed = ball.inner_load_n > 0.0;
    let apart = from_inner_circle(row, pose, &at(&place));
    let beyond = apart[0] >= 0.0;
    if !pressed {
        let reached = inner_energy(row, pose, &at(&place), beyond);
        assert!(reached <= 1e-12 * outer_energy(row, &place), "{ball:?}");
    }
    let along = |i: usize, h: f64| {
        let mut p = place;
        p[i] += h;
        let inner = match pressed {
            true => inner_energy(row, pose, &at(&p), beyond),
            false => 0.0,
        };
        inner + outer_energy(row, &p)
    };
    let depth = |load: f64, k: f64| (load / k).cbrt().powi(2);
    let outer_m = depth(ball.outer_load_n, row.outer.contact.stiffness_n_per_m15);
    let inner_m = depth(ball.inner_load_n, row.inner.contact.stiffness_n_per_m15);
    let least_m = if inner_m > 0.0 {
        inner_m.min(outer_m)
    } else {
        outer_m
    };
    let step = 0.02 * least_m;
    let mut left = Vector2::new(-slope(step, |h| along(0, h)), -slope(step, |h| along(1, h)));
    // Harris: outer-race control, tan β = sin α_o / (cos α_o + γ).
    let out = place - Vector2::new(row.outer.centre_radius_m, row.outer.centre_z_m);
    let alpha_o = out[1].atan2(out[0]);
    // On the edge the contact angle is that of the edge; a ball beyond it turns as one that both grooves face alike.
    let alpha_i = if !beyond {
        (-apart[1]).atan2(-apart[0])
    } else if pressed {
        let radius = 0.5 * row.ball_diameter_m;
        ((row.inner.arm_m + radius - apart[1].abs()) * -apart[1].signum()).atan2(apart[0])
    } else {
        alpha_o
    };
    let gamma = 0.5 * row.ball_diameter_m / row.pitch_radius_m;
    let beta = alpha_o.sin().atan2(alpha_o.cos() + gamma);
    let x_o = (alpha_o - beta).cos() / (1.0 + gamma * alpha_o.cos());
    let x_i = (alpha_i - beta).cos() / (1.0 - gamma * alpha_i.cos());
    let speed = rpm * std::f64::consts::PI / 30.0;
    let spin = speed / (gamma * (x_o + x_i));
    let orbit = spin * gamma * x_o;
    let gyroscopic =
        0.1 * row.ball_mass_kg * row.ball_diameter_m.powi(2) * orbit * spin * beta.sin();
    let friction = 2.0 * gyroscopic / row.ball_diameter_m;
    left[0] += row.ball_mass_kg * row.pitch_radius_m * orbit * orbit + friction * alpha_o.sin();
    left[1] -= friction * alpha_o.cos();
    let on_ring = |i: usize| {
        slope(step, |h| {
            let mut moved = *pose;
            moved.centre_m[i] += h;
            if pressed {
                inner_energy(row, &moved, &at(&place), beyond)
            } else {
                0.0
            }
        })
    };
    (left, -Vector3::new(on_ring(0), on_ring(1), on_ring(2)))
}

/// Every ball and the ring are in equilibrium by the second formulation, from rest to twice the speed at which the
/// first balls reach the edge of the inner groove; balls beyond it that it does not press do not touch it.
#[test]
fn rings_with_dropped_balls_are_in_equilibrium() {
    let (bearing, row) = (bearing(LARGE), row());
    let mut most_beyond = 0;
    for rpm in [
        1.0,
        1500.0,
        2100.0,
        2750.0,
        3400.0,
        3800.0,
        4_694.253_588,
        5200.0,
        6000.0,
        7000.0,
    ] {
        let found = bearing
            .equilibrium_with_places(&load(), &at_rpm(rpm))
            .unwrap_or_else(|e| panic!("{rpm} rpm: {e}"));
        let beyond = check(&bearing, (&row, found), rpm, FORCE_N);
        most_beyond = most_beyond.max(beyond);
    }
    assert!(most_beyond > 0);
}

/// Demands that ball by ball and of the ring forces vanish; how many balls lie beyond the end of the inner groove.
fn check(
    bearing: &QuasiStaticBearing,
    (row, (pose, mut places)): (&BallRow, (RingPose, ElementPlaces)),
    rpm: f64,
    force_n: [f64; 3],
) -> usize {
    let (_, loads) = bearing
        .loads_from(&pose, &at_rpm(rpm), &mut places)
        .unwrap();
    let mut sum = Vector3::from(force_n);
    let (mut beyond, mut size) = (0, sum.norm());
    for ball in &loads.elements[0] {
        let (left, on_ring) = ball_forces(row, &pose, rpm, ball);
        let scale = ball.inner_load_n + ball.outer_load_n;
        assert!(
            left.norm() < 1e-6 * scale + 1e-8,
            "{rpm} rpm: {left:?} of {ball:?}"
        );
        sum += on_ring;
        size += ball.inner_load_n;
        beyond += usize::from(ball.beyond_inner_groove);
        if ball.has_dropped() {
            assert_eq!(on_ring.norm(), 0.0);
            assert_eq!(ball.inner_load_n, 0.0, "{ball:?}");
            // Friction that carries the gyroscopic moment tilts the force by a little.
            close(ball.outer_load_n, ball.centrifugal_n, 1e-2);
        }
    }
    assert!(sum.norm() < 1e-6 * size, "{rpm} rpm: {sum:?} of {size}");
    beyond
}

/// Angular-contact bearings drawn at random, to speeds at which centrifugal forces are as large as loads: the second
/// formulation holds wherever an equilibrium is found.
fn many(seed: u64, count: usize) {
    let mut numbers = fastrand::Rng::with_seed(seed);
    let mut between = |low: f64, high: f64| low + (high - low) * numbers.f64();
    let (mut with_beyond, mut refused) = (0, Vec::new());
    for number in 0..count {
        let ball_mm = between(4.0, 30.0);
        let pitch_mm = ball_mm / between(0.1, 0.25);
        let room = std::f64::consts::PI / (ball_mm / pitch_mm).asin();
        let balls = (room * between(0.5, 0.93)) as usize;
        let text = format!(
            "name = \"drawn\"\nkind = \"angular-contact\"\nballs = {balls}\nball_diameter_mm = {ball_mm:?}\n\
             pitch_diameter_mm = {pitch_mm:?}\ninner_conformity = {:?}\nouter_conformity = {:?}\ncontact_angle_deg = {:?}\n",
            between(0.51, 0.54),
            between(0.51, 0.54),
            between(12.0, 45.0)
        );
        let size = 10.0_f64.powf(between(1.3, 3.0)) * ball_mm * ball_mm / 10.0;
        let force_n = [between(-0.4, 0.4) * size, between(-0.4, 0.4) * size, size];
        let tilt = [between(-5e-4, 5e-4), between(-5e-4, 5e-4)];
        let rpm = between(0.05, 0.8) * 3e6 / pitch_mm;
        let bearing = bearing(&text);
        let Row::Ball(row) = &bearing.rows[0] else {
            panic!("balls")
        };
        let load = AppliedBearingLoad {
            force_n,
            tilt: TiltCondition::Held(tilt),
        };
        match bearing.equilibrium_with_places(&load, &at_rpm(rpm)) {
            Ok(found) => {
                with_beyond += usize::from(check(&bearing, (row, found), rpm, force_n) > 0)
            }
            Err(error) => {
                // Near a fold the search may stop short of its tolerance: it says what is left.
                assert!(
                    matches!(error, BearingError::NoEquilibrium { .. }),
                    "{error}\n{text}"
                );
                refused.push(format!("{number}: {error}\n{text}{load:?} {rpm}"));
            }
        }
    }
    println!(
        "{count} bearings, seed {seed}: {with_beyond} with balls beyond the inner groove, {} refused",
        refused.len()
    );
    println!("{}", refused.join("\n"));
    // Where several balls reach the end of the groove together the ring may have no equilibrium beside it: one bearing
    // in a hundred may be refused, none of the few that every run draws.
    assert!(100 * refused.len() <= count, "{} refused", refused.len());
}

#[test]
fn fast_bearings_drawn_at_random_are_in_equilibrium() {
    many(1, 40);
}

/// `BEARINGS=1000 BEARINGS_SEED=2 cargo test --workspace --test equilibrium -- --ignored --nocapture
/// many_fast_bearings`
#[test]
#[ignore = "minutes"]
fn many_fast_bearings_are_in_equilibrium() {
    let number = |name: &str, otherwise: u64| {
        std::env::var(name).map_or(otherwise, |text| text.parse().unwrap())
    };
    many(
        number("BEARINGS_SEED", 2),
        number("BEARINGS", 1000) as usize,
    );
}

/// A model of its own (a program in Python: small tilts, Newton's method by differences, balls kept in both grooves)
/// finds all balls carried up to 3400 rpm, at these places; its tilt is linear, which is 1e-7 of the pitch radius and
/// less than 0.05 µm.
#[test]
fn balls_stay_as_long_as_they_can() {
    let bearing = bearing(LARGE);
    for (rpm, place_um, steepest_deg) in [
        (1500.0, [20.505_473, -41.878_870, 11.872_695], 48.0),
        (2300.0, [24.646_894, -42.127_677, 5.903_755], 54.5),
        (3000.0, [36.209_260, -43.272_795, -11.128_440], 63.7),
        (3400.0, [50.666_022, -44.749_292, -32.841_307], 71.4),
    ] {
        let operation = at_rpm(rpm);
        let (pose, mut places) = bearing
            .equilibrium_with_places(&load(), &operation)
            .unwrap();
        let (_, loads) = bearing.loads_from(&pose, &operation, &mut places).unwrap();
        let all = &loads.elements[0];
        assert!(all.iter().all(|ball| ball.inner_load_n > 0.0), "{rpm} rpm");
        let steepest = all
            .iter()
            .map(|ball| ball.inner_contact_angle_rad.to_degrees())
            .fold(0.0, f64::max);
        // Printed with one decimal.
        assert!(
            (steepest - steepest_deg).abs() < 0.06,
            "{rpm} rpm: {steepest}"
        );
        let apart = 1e6 * pose.centre_m - Vector3::from(place_um);
        assert!(apart.norm() < 0.05, "{rpm} rpm: {apart:?} um");
    }
}

/// Dropped balls are counted in a warning; there is none before they drop.
#[test]
fn dropped_balls_are_warned_of() {
    let (bearing, definition) = (bearing(LARGE), definition(LARGE));
    for (rpm, warned) in [(3000.0, false), (4694.0, true)] {
        let operation = at_rpm(rpm);
        let (pose, mut places) = bearing
            .equilibrium_with_places(&load(), &operation)
            .unwrap();
        let (ring, loads) = bearing.loads_from(&pose, &operation, &mut places).unwrap();
        let life = Life::of(&definition, &loads, FORCE_N, &operation, None);
        let judged = Judged {
            definition: &definition,
            bearing: &bearing,
            pose: &pose,
            ring: &ring,
            loads: &loads,
            force_n: FORCE_N,
            operation: &operation,
            life: &life,
        };
        let found = judged.warnings();
        let found = found.iter().find(|w| w.concern == Concern::DroppedBalls);
        assert_eq!(found.is_some(), warned, "{rpm}");
        if let Some(found) = found {
            let beyond = loads.elements[0].iter().filter(|b| b.beyond_inner_groove);
            let count = beyond.count();
            assert_eq!(found.value, count as f64);
            assert!(found.text.contains(&format!(
                "{count} of 15 that carry at rest lie beyond the end of the inner groove"
            )));
        }
    }
}

/// The force on the ring falls by what its tangent says, with balls dropped: differences with the places kept.
#[test]
fn tangents_hold_with_dropped_balls() {
    let bearing = bearing(LARGE);
    let operation = at_rpm(4694.0);
    let (pose, places) = bearing
        .equilibrium_with_places(&load(), &operation)
        .unwrap();
    let at = |step: &Vector5<f64>| {
        let mut places = places.clone();
        bearing
            .evaluate_from(&pose.moved(step), &operation, &mut places)
            .unwrap()
    };
    let exact = at(&Vector5::zeros()).tangent;
    for i in 0..3 {
        let mut step = Vector5::zeros();
        step[i] = 1e-9;
        let slope = (at(&step).load - at(&-step).load) / 2e-9;
        for j in 0..3 {
            // Second order in a step of 1e-4 of a contact's depth, and 1e-10 N of rounding over 2e-9 m.
            let off = (slope[j] - exact[(j, i)]).abs();
            assert!(off < 1e-5 * exact.norm(), "{i} {j}: {slope:?} {exact:?}");
        }
    }
}
