//! Forces of bevel stages against their closed forms and the ratio.

use gearmesh_rexs::bevel::BevelStage;
use gearmesh_rexs::bevel_force::{Line, mean_force};
use gearmesh_rexs::placement::{cross, dot};

/// Seed 001's pair: 20/20, 3.5 mm, 35 degrees, 100 N m; F_t 3367 N, axially 2725 and radially -609 N, or the other way
/// round.
fn pair(is_right_hand: bool) -> BevelStage {
    BevelStage {
        pinion: 0,
        teeth: [20, 20],
        outer_module_mm: 3.5,
        face_widths_mm: [15.0; 2],
        shaft_angle_deg: 90.0,
        pressure_angle_deg: 20.0,
        spiral_angle_deg: 35.0,
        is_right_hand,
    }
}

const AXES: [Line; 2] = [
    Line {
        point_mm: [0.0, 0.0, 80.0],
        direction: [0.0, 0.0, 1.0],
    },
    Line {
        point_mm: [60.0, 0.0, 0.0],
        direction: [1.0, 0.0, 0.0],
    },
];

#[test]
fn shares_are_those_of_the_closed_form() {
    let pair = pair(false);
    let mean_mm = pair.mean_cone_distance_mm() * 45f64.to_radians().sin();
    let tangential = 100.0 / (1e-3 * mean_mm);
    // A left-hand pinion that drives clockwise, seen from its back, is pushed off the apex.
    let [tan_a, spiral] = [20f64.to_radians().tan(), 35f64.to_radians()];
    let half = 45f64.to_radians().sin();
    let [plus, minus] =
        [1.0, -1.0].map(|sign| tangential * half * (tan_a / spiral.cos() + sign * spiral.tan()));
    let force = mean_force(&pair, AXES, 100.0).unwrap();
    let [x, y, z] = force.on_pinion_n;
    let close = |a: f64, b: f64| (a - b).abs() < 1e-9 * tangential;
    assert!(close(z, plus), "{z} {plus}");
    // The mate stands at +x: what pushes off it is -x.
    assert!(close(-x, minus), "{x} {minus}");
    assert!(close(y, tangential), "{y} {tangential}");
    let turned = mean_force(&pair, AXES, -100.0).unwrap().on_pinion_n;
    assert!(
        close(turned[2], minus) && close(-turned[0], plus),
        "{turned:?}"
    );
}

/// The torque about either axis is that of the ratio, whatever the hand and the sense of the axes.
#[test]
fn torques_are_those_of_the_ratio() {
    for (teeth, hand, turned) in [([13, 35], true, 1.0), ([8, 48], false, -1.0)] {
        let mut stage = pair(hand);
        stage.teeth = teeth;
        let mut axes = AXES;
        axes[1].direction = axes[1].direction.map(|x| turned * x);
        let force = mean_force(&stage, axes, 100.0).unwrap();
        let arm = force.point_mm.map(|x| 1e-3 * x);
        let moment = cross(arm, force.on_pinion_n);
        assert!(
            (dot(moment, [0.0, 0.0, 1.0]) - 100.0).abs() < 1e-9,
            "{moment:?}"
        );
        let on_gear = -dot(moment, [1.0, 0.0, 0.0]);
        let ratio = teeth[1] as f64 / teeth[0] as f64;
        assert!((on_gear.abs() - 100.0 * ratio).abs() < 1e-9, "{on_gear}");
    }
}

#[test]
fn axes_that_do_not_cross_have_none() {
    let mut axes = AXES;
    axes[1].point_mm[1] = 5.0;
    assert!(mean_force(&pair(true), axes, 100.0).is_none());
    axes[1] = axes[0];
    assert!(mean_force(&pair(true), axes, 100.0).is_none());
}
