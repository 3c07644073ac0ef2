//! Tangents against differences.

use crate::ball_types::{FOUR_POINT, THRUST};
use crate::barrels::BARRELS;
use crate::common::{B218, B6205, PAIR, ROLLERS, TAPERED, bearing};
use gearmesh_bearings::{Control, Operation, QuasiStaticBearing, RingLoad, RingPose};
use nalgebra::{Matrix6, Vector5, Vector6};

/// Load at a pose moved by a small displacement or rotation about the fixed axes.
fn moved(
    bearing: &QuasiStaticBearing,
    pose: &RingPose,
    operation: &Operation,
    place: usize,
    step: f64,
) -> Vector6<f64> {
    let mut change = Vector5::zeros();
    change[place] = step;
    bearing
        .evaluate(&pose.moved(&change), operation)
        .unwrap()
        .load
}

/// Fourth-order central differences of the first five columns.
fn differences(
    bearing: &QuasiStaticBearing,
    pose: &RingPose,
    operation: &Operation,
    arm: f64,
    h: f64,
) -> Matrix6<f64> {
    let mut matrix = Matrix6::zeros();
    for place in 0..5 {
        let step = if place < 3 { h } else { h / arm };
        let at = |factor: f64| moved(bearing, pose, operation, place, factor * step);
        let column = (at(-2.0) - at(2.0) + (at(1.0) - at(-1.0)) * 8.0) / (12.0 * step);
        matrix.set_column(place, &column);
    }
    matrix
}

/// Largest misfit over the largest entry, moments and rotations taken at the pitch radius.
fn misfit(ring: &RingLoad, other: &Matrix6<f64>, arm: f64) -> f64 {
    let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
    for i in 0..6 {
        for j in 0..5 {
            let scale = if i < 3 { 1.0 } else { arm } * if j < 3 { 1.0 } else { arm };
            worst = worst.max((ring.tangent[(i, j)] - other[(i, j)]).abs() / scale);
            largest = largest.max(ring.tangent[(i, j)].abs() / scale);
        }
    }
    worst / largest
}

/// Balls and rollers that carry load, and all of them.
fn loaded(bearing: &QuasiStaticBearing, pose: &RingPose, operation: &Operation) -> (usize, usize) {
    let (_, loads) = bearing.loads(pose, operation).unwrap();
    let all = loads.elements.iter().flatten();
    (
        all.clone().filter(|e| e.inner_load_n > 0.0).count(),
        all.count(),
    )
}

/// Random poses of a bearing; returns how many had both loaded and lifted-off elements.
fn check(
    text: &str,
    operation: &Operation,
    states: usize,
    (shift, tilt): ([f64; 3], f64),
) -> usize {
    let bearing = bearing(text);
    let arm = bearing.rows[0].pitch_radius_m();
    let mut numbers = fastrand::Rng::with_seed(states as u64 + text.len() as u64);
    let mut number = || 2.0 * numbers.f64() - 1.0;
    let (mut mixed, mut done, mut unjudged) = (0, 0, 0);
    while done < states {
        let q = Vector5::new(
            shift[0] * number(),
            shift[0] * number(),
            shift[1] + shift[2] * number(),
            tilt * number(),
            tilt * number(),
        );
        let pose = RingPose::from_five(&q);
        let ring = bearing.evaluate(&pose, operation).unwrap();
        if ring.load.norm() < 1.0 {
            continue;
        }
        // Where a ball or lamina is about to touch, its stiffness rises with an infinite slope, and no difference
        // across that place says anything: of such states the differences disagree with each other.
        let by_steps =
            [1e-8, 3e-9, 1e-9, 3e-10].map(|h| differences(&bearing, &pose, operation, arm, h));
        let mut best = f64::INFINITY;
        let mut judged = false;
        for pair in by_steps.windows(2) {
            let other = RingLoad {
                tangent: pair[0],
                ..ring
            };
            if misfit(&other, &pair[1], arm) < 3e-7 {
                judged = true;
                best = best.min(misfit(&ring, &pair[1], arm));
            }
        }
        if !judged {
            unjudged += 1;
            continue;
        }
        assert!(best < 1e-6, "{text}\n{operation:?}\n{q}: {best:e}");
        done += 1;
        let (with, all) = loaded(&bearing, &pose, operation);
        if with < all {
            mixed += 1;
        }
    }
    // Laminae touch and part by the dozen, and their law rises more steeply.
    assert!(
        unjudged <= done / 2,
        "{unjudged} of {done} states could not be judged"
    );
    mixed
}

fn at_rpm(rpm: f64, control: Control) -> Operation {
    Operation {
        inner_rad_per_s: rpm * std::f64::consts::PI / 30.0,
        cage_angle_rad: 0.123,
        control,
        ..Operation::default()
    }
}

#[test]
fn tangents_of_balls_at_rest_are_derivatives() {
    let rest = Operation::default();
    let groove = format!("{B6205}radial_clearance_um = 12.0\n");
    let mixed = check(&groove, &rest, 250, ([40e-6, 0.0, 100e-6], 3e-3))
        + check(B218, &rest, 100, ([40e-6, 20e-6, 60e-6], 1e-3))
        + check(PAIR, &rest, 150, ([15e-6, 0.0, 20e-6], 1e-3));
    assert!(mixed > 200, "{mixed} states with lifted-off balls");
}

#[test]
fn tangents_of_four_point_and_thrust_balls_are_derivatives() {
    let rest = Operation::default();
    let fast = at_rpm(8000.0, Control::OuterRace);
    let mixed = check(FOUR_POINT, &rest, 60, ([40e-6, 0.0, 60e-6], 1e-3))
        + check(FOUR_POINT, &fast, 40, ([40e-6, 0.0, 60e-6], 1e-3))
        + check(THRUST, &rest, 40, ([40e-6, 20e-6, 10e-6], 1e-3))
        + check(THRUST, &fast, 20, ([20e-6, 30e-6, 5e-6], 2e-4));
    assert!(mixed > 40, "{mixed} states with lifted-off balls");
}

#[test]
fn tangents_of_balls_at_speed_are_derivatives() {
    let groove = format!("{B6205}radial_clearance_um = 12.0\n");
    let mixed = check(
        &groove,
        &at_rpm(18000.0, Control::OuterRace),
        150,
        ([40e-6, 0.0, 100e-6], 3e-3),
    ) + check(
        B218,
        &at_rpm(10000.0, Control::OuterRace),
        100,
        ([40e-6, 20e-6, 60e-6], 1e-3),
    ) + check(
        PAIR,
        &at_rpm(-20000.0, Control::LeastSpin),
        150,
        ([15e-6, 0.0, 20e-6], 1e-3),
    );
    assert!(mixed > 100, "{mixed} states with lifted-off balls");
}

#[test]
fn tangents_of_rollers_are_derivatives() {
    let rest = Operation::default();
    let fast = at_rpm(8000.0, Control::OuterRace);
    let mixed = check(ROLLERS, &rest, 40, ([25e-6, 0.0, 0.0], 2e-3))
        + check(ROLLERS, &fast, 20, ([25e-6, 0.0, 0.0], 2e-3))
        + check(TAPERED, &rest, 20, ([10e-6, 15e-6, 10e-6], 5e-4))
        + check(TAPERED, &fast, 20, ([10e-6, 15e-6, 10e-6], 5e-4))
        + check(BARRELS, &rest, 20, ([60e-6, 0.0, 60e-6], 5e-3));
    assert!(mixed > 50, "{mixed} states with lifted-off rollers");
}
