//! Four-point, thrust and double-row ball bearings: figures that are called independent are those of
//! tools/reference/bearing_types.py, which seeks the least energy of ring and balls together and shares no code with
//! the workspace.

use crate::common::{B6205, close, definition};
use gearmesh_bearings::definition::{BallBearingKind, BearingDefinition, BearingGeometry};
use gearmesh_bearings::quasi_static::{Row, RowLoads};
use gearmesh_bearings::thrust_ratings::{
    thrust_ball_dynamic_factor, thrust_ball_static_factor, thrust_ball_static_n,
};
use gearmesh_bearings::{
    AppliedBearingLoad, BearingError, DynamicBearing, DynamicEffects, Life, Operation,
    QuasiStaticBearing, Ratings, RingPose, TiltCondition,
};
use gearmesh_dynamics::{Marker, MarkerPair};
use nalgebra::Vector5;

/// A four-point bearing of 20 µm play.
pub const FOUR_POINT: &str = r#"
name = "QJ"
kind = "four-point"
balls = 15
ball_diameter_mm = 12.7
pitch_diameter_mm = 70.0
inner_conformity = 0.52
outer_conformity = 0.53
contact_angle_deg = 35.0
radial_clearance_um = 20.0
"#;

/// Two washers.
pub const THRUST: &str = r#"
name = "thrust"
kind = "thrust-ball"
balls = 14
ball_diameter_mm = 7.938
pitch_diameter_mm = 36.0
inner_conformity = 0.54
outer_conformity = 0.54
"#;

const DOUBLE_ROW: &str = r#"
name = "double row"
kind = "angular-contact"
balls = 13
ball_diameter_mm = 7.938
pitch_diameter_mm = 38.5
inner_conformity = 0.52
outer_conformity = 0.53
contact_angle_deg = 30.0
arrangement = "O"
row_distance_mm = 10.3
"#;

const FREE: TiltCondition = TiltCondition::Moments([0.0; 2]);
const HELD: TiltCondition = TiltCondition::Held([0.0; 2]);

fn at_rpm(rpm: f64) -> Operation {
    Operation {
        inner_rad_per_s: rpm * std::f64::consts::PI / 30.0,
        ..Operation::default()
    }
}

fn rest(
    definition: &BearingDefinition,
    force_n: [f64; 3],
    tilt: TiltCondition,
    rpm: f64,
) -> (RingPose, RowLoads) {
    let bearing = QuasiStaticBearing::new(definition).unwrap();
    let load = AppliedBearingLoad { force_n, tilt };
    let pose = bearing
        .equilibrium(&load, &at_rpm(rpm))
        .unwrap_or_else(|e| panic!("{e}"));
    let (_, loads) = bearing.loads(&pose, &at_rpm(rpm)).unwrap();
    (pose, loads)
}

/// Coordinates in µm and mrad to 1e-6 of the largest.
fn stands_at(pose: &RingPose, expected: [f64; 5]) {
    let five = pose.to_five();
    for place in 0..5 {
        let found = five[place] * if place < 3 { 1e6 } else { 1e3 };
        assert!(
            (found - expected[place]).abs() < 1e-6 * (1.0 + expected[place].abs()),
            "coordinate {place}: found {found}, expected {}",
            expected[place]
        );
    }
}

/// All four points of a ball carry under a load across the axis, two under thrust.
#[test]
fn four_point_bearings_bear_as_the_independent_ones() {
    let qj = definition(FOUR_POINT);
    let (pose, loads) = rest(&qj, [3000.0, 500.0, 2000.0], FREE, 0.0);
    stands_at(
        &pose,
        [
            28.891077579,
            4.700011029,
            28.871242516,
            -0.137148172,
            0.848457926,
        ],
    );
    let ball = &loads.elements[0][0];
    let other = ball.other_side.unwrap();
    // The side that carries more comes first: here that of negative angles.
    for (found, expected) in [
        (ball.inner_load_n, 696.437811),
        (ball.outer_load_n, 699.884366),
        (ball.inner_contact_angle_rad, -0.592088791),
        (other.inner_load_n, 638.743593),
        (other.outer_load_n, 640.332716),
        (other.outer_contact_angle_rad, 0.595581301),
    ] {
        close(found, expected, 1e-6);
    }
    let (pose, loads) = rest(&qj, [300.0, 0.0, 9000.0], FREE, 0.0);
    stands_at(&pose, [10.951758215, 0.0, 46.042194103, 0.0, 0.369284611]);
    let ball = &loads.elements[0][3];
    close(ball.inner_load_n, 961.21015, 1e-6);
    close(ball.inner_contact_angle_rad, 0.669370712, 1e-6);
    assert_eq!(ball.other_side.unwrap().inner_load_n, 0.0);
}

/// The four-point bearing without distance between the arcs' centres is the deep-groove bearing, with play and without;
/// turned round it is itself.
#[test]
fn four_point_bearings_meet_their_limits() {
    for clearance_um in [0.0, 12.0] {
        let groove = definition(&format!("{B6205}radial_clearance_um = {clearance_um}\n"));
        let mut arched = groove.clone();
        let BearingGeometry::Ball(g) = &mut arched.geometry else {
            panic!("no balls");
        };
        g.kind = BallBearingKind::FourPoint {
            clearance_m: 1e-6 * clearance_um,
        };
        let free_angle_rad = g.free_angle_rad;
        g.free_angle_rad = 0.0;
        let mut one = QuasiStaticBearing::new(&groove).unwrap();
        let mut other = QuasiStaticBearing::new(&arched).unwrap();
        // Stiffness at the same angle.
        if let (Row::Ball(one), Row::FourPoint(other)) = (&mut one.rows[0], &mut other.rows[0]) {
            for place in 0..2 {
                other.inner[place].groove.contact = one.inner.contact;
                other.outer[place].groove.contact = one.outer.contact;
            }
            assert!((one.free_angle_rad, free_angle_rad) >= (0.0, 0.0));
        }
        for q in [
            [12e-6, 3e-6, 0.0, 0.0, 0.0],
            [9e-6, -4e-6, 60e-6, 1e-3, -5e-4],
            [5e-6, 0.0, -150e-6, 0.0, 2e-3],
        ] {
            let pose = RingPose::from_five(&Vector5::from(q));
            let [one, other] =
                [&one, &other].map(|b| b.evaluate(&pose, &Operation::default()).unwrap());
            let size = one.load.norm();
            assert!(size > 10.0 && (one.load - other.load).norm() < 1e-9 * size);
            let stiffness = one.tangent.norm();
            assert!((one.tangent - other.tangent).norm() < 1e-7 * stiffness);
        }
    }
    // Mirrored in the middle plane.
    let qj = definition(FOUR_POINT);
    let (up, _) = rest(&qj, [1000.0, 300.0, 4000.0], HELD, 0.0);
    let (down, _) = rest(&qj, [1000.0, 300.0, -4000.0], HELD, 0.0);
    assert!((up.centre_m.x - down.centre_m.x).abs() < 1e-15);
    assert!((up.centre_m.z + down.centre_m.z).abs() < 1e-15);
    // Under pure thrust it is the angular-contact bearing of its contact angle, moved by the play it has left at that
    // angle: without play by nothing.
    let tight = definition(&FOUR_POINT.replace("radial_clearance_um = 20.0\n", ""));
    let angular = definition(
        &FOUR_POINT
            .replace("radial_clearance_um = 20.0\n", "")
            .replace("four-point", "angular-contact"),
    );
    let thrust = [0.0, 0.0, 8000.0];
    let (one, loads) = rest(&tight, thrust, FREE, 0.0);
    let (other, expected) = rest(&angular, thrust, FREE, 0.0);
    close(one.centre_m.z, other.centre_m.z, 1e-9);
    let (found, expected) = (&loads.elements[0][2], &expected.elements[0][2]);
    close(found.inner_load_n, expected.inner_load_n, 1e-9);
    close(
        found.inner_contact_angle_rad,
        expected.inner_contact_angle_rad,
        1e-9,
    );
    // And so is its life, to what rounding leaves.
    let life = |definition: &BearingDefinition| {
        let (_, loads) = rest(definition, thrust, FREE, 0.0);
        Life::of(definition, &loads, thrust, &Operation::default(), None)
    };
    close(
        life(&tight).reference_mrev,
        life(&angular).reference_mrev,
        1e-8,
    );
    assert!(life(&tight).basic_mrev.is_none());
}

/// Of both tracks of a race each is stressed by itself: with all four points loaded alike damage is twice that of one
/// side.
#[test]
fn both_tracks_of_a_four_point_bearing_count() {
    let qj = definition(&FOUR_POINT.replace(
        "radial_clearance_um = 20.0\n",
        "radial_clearance_um = -20.0\n",
    ));
    let (_, mut loads) = rest(&qj, [0.0; 3], FREE, 0.0);
    let of = |loads: &RowLoads| {
        Life::of(&qj, loads, [0.0; 3], &Operation::default(), None).reference_mrev
    };
    let both = of(&loads);
    for ball in loads.elements.iter_mut().flatten() {
        let other = ball.other_side.unwrap();
        close(ball.inner_load_n, other.inner_load_n, 1e-6);
        ball.other_side = Some(Default::default());
    }
    close(both, of(&loads) * 2.0_f64.powf(-0.9), 1e-5);
}

/// Under pure thrust both contacts of a ball share the approach: δ = 2 (F/(Z K))^⅔. Beside loads across the axis: the
/// independent figures.
#[test]
fn thrust_bearings_bear_as_closed_form_and_independent_ones() {
    let thrust = definition(THRUST);
    let bearing = QuasiStaticBearing::new(&thrust).unwrap();
    let Row::Ball(row) = &bearing.rows[0] else {
        panic!("no balls");
    };
    let stiffness = row.inner.contact.stiffness_n_per_m15;
    close(row.outer.contact.stiffness_n_per_m15, stiffness, 1e-9);
    for force in [10.0, 5000.0, 60_000.0] {
        let (pose, loads) = rest(&thrust, [0.0, 0.0, force], FREE, 0.0);
        let expected: f64 = 2.0 * (force / (14.0 * stiffness)).powf(2.0 / 3.0);
        close(pose.centre_m.z, expected, 1e-9);
        close(loads.elements[0][3].inner_load_n, force / 14.0, 1e-9);
        close(
            loads.elements[0][3].inner_contact_angle_rad.to_degrees(),
            90.0,
            1e-9,
        );
    }
    let (pose, loads) = rest(&thrust, [200.0, 50.0, 5000.0], FREE, 0.0);
    stands_at(
        &pose,
        [
            49.104888851,
            12.276222213,
            12.345922734,
            0.000503916,
            -0.002015665,
        ],
    );
    let ball = &loads.elements[0][3];
    close(ball.inner_load_n, 334.736978, 1e-6);
    close(ball.outer_contact_angle_rad, 1.53553411, 1e-6);
    // Cages of thrust bearings turn with half the speed.
    let frequencies = thrust.rolling_sizes().frequencies(10.0, 0.0);
    close(frequencies.cage_hz, 5.0, 1e-12);
    close(frequencies.outer_race_hz, 70.0, 1e-12);
}

/// At speed balls of a thrust bearing are thrown out: they lean on the outer flank of the housing's groove and the
/// inner flank of the shaft's.
#[test]
fn thrown_balls_of_thrust_bearings_climb() {
    let thrust = definition(THRUST);
    let (_, loads) = rest(&thrust, [0.0, 0.0, 2000.0], FREE, 6000.0);
    let ball = &loads.elements[0][0];
    let [inner, outer] =
        [ball.inner_contact_angle_rad, ball.outer_contact_angle_rad].map(f64::to_degrees);
    assert!(outer < 89.0 && inner > 91.0, "{outer} {inner}");
    // Equilibrium across the axis, the gyroscopic moment's friction at the outer race among it.
    let friction = 2.0 * ball.gyroscopic_nm / 7.938e-3;
    let (sine, cosine) = ball.outer_contact_angle_rad.sin_cos();
    let across = ball.centrifugal_n + ball.inner_load_n * ball.inner_contact_angle_rad.cos()
        - ball.outer_load_n * cosine
        + friction * sine;
    assert!(across.abs() < 1e-8 * ball.inner_load_n, "{across}");
    // A half turn of the cage for one of the shaft, to what the climb changes.
    close(ball.orbit_rad_per_s, 100.0 * std::f64::consts::PI, 0.02);
}

/// ISO 281's table of thrust ball bearings of 90°: 36.7, 45.2, 59.5, 73.3, 90.2 at D/d_m 0.01, 0.02, 0.05, 0.10, 0.20;
/// ISO 76: f₀ 61.6.
#[test]
fn ratings_of_thrust_bearings_are_those_of_the_standards() {
    for (ratio, factor) in [
        (0.01, 36.7),
        (0.02, 45.2),
        (0.05, 59.5),
        (0.10, 73.3),
        (0.20, 90.2),
    ] {
        close(thrust_ball_dynamic_factor(ratio), factor, 2e-3);
    }
    close(thrust_ball_static_factor(), 61.6, 1e-2);
    let thrust = definition(THRUST);
    let ratings = Ratings::of(&thrust);
    close(ratings.static_n, thrust_ball_static_n(14, 7.938e-3), 1e-12);
    // P = F_a; all balls alike: L10r is L10 with grooves of the rating's own kind.
    let force = [0.0, 0.0, 4000.0];
    let (_, loads) = rest(&thrust, force, FREE, 0.0);
    let life = Life::of(&thrust, &loads, force, &Operation::default(), None);
    close(life.equivalent_n.unwrap(), 4000.0, 1e-12);
    close(life.reference_mrev, life.basic_mrev.unwrap(), 1e-6);
    let aside = Life::of(
        &thrust,
        &loads,
        [100.0, 0.0, 4000.0],
        &Operation::default(),
        None,
    );
    assert!(aside.basic_mrev.is_none());
}

/// Two rows in one pair of rings, in both arrangements; ISO 281's P for two rows of 30°: 0.63 F_r + 1.24 F_a above e =
/// 0.80.
#[test]
fn double_rows_bear_as_the_independent_ones() {
    let double = definition(DOUBLE_ROW);
    let (pose, loads) = rest(&double, [2000.0, 0.0, 1500.0], FREE, 0.0);
    stands_at(&pose, [16.653343013, 0.0, 20.056876641, 0.0, 0.676487560]);
    close(loads.elements[0][0].inner_load_n, 496.3038, 1e-6);
    close(loads.elements[1][2].inner_load_n, 66.5990324, 1e-6);
    let faces = definition(&DOUBLE_ROW.replace("\"O\"", "\"X\""));
    let (pose, loads) = rest(&faces, [2000.0, 0.0, 1500.0], FREE, 0.0);
    stands_at(&pose, [16.059803602, 0.0, 18.547753403, 0.0, 1.446305315]);
    close(loads.elements[0][2].inner_load_n, 42.1844699, 1e-6);
    close(loads.elements[1][0].inner_load_n, 560.377706, 1e-6);
    for (force, expected) in [
        ([2000.0, 0.0, 1800.0], 0.63 * 2000.0 + 1.24 * 1800.0),
        ([2000.0, 0.0, 1500.0], 2000.0 + 0.78 * 1500.0),
    ] {
        let life = Life::of(&double, &loads, force, &Operation::default(), None);
        close(life.equivalent_n.unwrap(), expected, 1e-12);
    }
    // Rows at one place under a load across the axis carry as one row with twice the balls would: half the load each.
    let near = definition(&DOUBLE_ROW.replace("10.3", "1e-9"));
    let (_, loads) = rest(&near, [2000.0, 0.0, 0.0], HELD, 0.0);
    for (one, other) in loads.elements[0].iter().zip(&loads.elements[1]) {
        assert!((one.inner_load_n - other.inner_load_n).abs() < 1e-9);
    }
}

/// Balls of these bearings do not move by themselves: the model is refused with what to take.
#[test]
fn moving_balls_are_refused() {
    for text in [FOUR_POINT, THRUST] {
        let bearing = QuasiStaticBearing::new(&definition(text)).unwrap();
        let pair = MarkerPair {
            a: Marker::ground([0.0; 3]),
            b: Marker::ground([0.0; 3]),
        };
        let made = DynamicBearing::new("b", pair, &bearing, DynamicEffects::default());
        let Err(BearingError::NotCarried(problem)) = made else {
            panic!("accepted");
        };
        assert!(problem.contains("quasi-static"));
    }
}
