//! Speeds and torques by the ratios.

use gearmesh_rexs::power_flow::{Link, TorqueOn, flow};
use std::collections::BTreeMap;

fn torque(shaft: i64, torque_nm: Option<f64>) -> TorqueOn {
    TorqueOn {
        shaft,
        torque_nm,
        power_w: None,
    }
}

fn link(a: i64, b: i64, ratio: f64) -> Link {
    Link {
        shafts: [a, b],
        ratio,
    }
}

#[test]
fn a_train_of_two_stages() {
    let links = [link(1, 2, -0.5), link(2, 3, -0.25)];
    let found = flow(
        &[1, 2, 3],
        &links,
        &[torque(1, Some(10.0)), torque(3, None)],
        &BTreeMap::from([(1, 800.0)]),
    );
    assert_eq!(
        found.speed_rpm,
        BTreeMap::from([(1, 800.0), (2, -400.0), (3, 100.0)])
    );
    assert_eq!(found.torque_nm, [10.0, -80.0]);
    assert_eq!(found.link_nm, [Some([10.0, 20.0]), Some([-20.0, -80.0])]);
    assert!(found.unbalanced.is_empty() && found.assumed_speed.is_empty());
}

#[test]
fn power_is_shared_at_a_branch_and_torques_of_one_sign_are_turned() {
    // Shaft 1 drives 2 and 3.
    let links = [link(1, 2, -1.0), link(1, 3, -2.0)];
    let torques = [
        torque(1, None),
        torque(2, Some(30.0)),
        torque(3, Some(10.0)),
    ];
    let found = flow(
        &[1, 2, 3],
        &links,
        &torques,
        &BTreeMap::from([(1, -1000.0)]),
    );
    assert_eq!(found.torque_nm[0], 50.0);
    assert_eq!(found.link_nm, [Some([30.0, 30.0]), Some([20.0, 10.0])]);
    let turned = flow(
        &[1, 2],
        &[link(1, 2, -0.5)],
        &[torque(1, Some(10.0)), torque(2, Some(-20.0))],
        &BTreeMap::new(),
    );
    assert_eq!(
        (turned.torque_nm, turned.turned),
        (vec![10.0, 20.0], vec![1])
    );
}

#[test]
fn loops_leave_torques_open_and_power_gives_a_torque() {
    let links = [link(1, 2, -0.5), link(1, 2, -0.5)];
    let found = flow(
        &[1, 2],
        &links,
        &[torque(1, Some(10.0)), torque(2, None)],
        &BTreeMap::from([(1, 100.0)]),
    );
    assert_eq!(found.link_nm, [None, None]);
    assert_eq!(found.torque_nm, [10.0, 20.0]);
    let power = TorqueOn {
        shaft: 1,
        torque_nm: None,
        power_w: Some(1e3 * std::f64::consts::PI),
    };
    let found = flow(
        &[1, 2],
        &links[..1],
        &[power, torque(2, None)],
        &BTreeMap::from([(1, 300.0)]),
    );
    assert!((found.torque_nm[0] - 100.0).abs() < 1e-9 && (found.torque_nm[1] - 200.0).abs() < 1e-9);
}

/// A stage before a loop of two equal paths: its torque is known, those of the loop are not.
#[test]
fn what_is_before_and_behind_a_loop_has_its_torque() {
    let links = [
        link(1, 2, -0.5),
        link(2, 3, -0.5),
        link(2, 3, -0.5),
        link(3, 4, -1.0),
    ];
    let found = flow(
        &[1, 2, 3, 4],
        &links,
        &[torque(1, Some(10.0)), torque(4, None)],
        &BTreeMap::from([(1, 100.0), (4, 30.0)]),
    );
    assert_eq!(
        found.link_nm,
        [Some([10.0, 20.0]), None, None, Some([40.0, 40.0])]
    );
    assert!(found.locked.is_empty());
    assert_eq!(found.other_speed, [(4, 30.0)]);
    let other = [link(1, 2, -0.5), link(1, 2, -1.0)];
    let found = flow(&[1, 2], &other, &[], &BTreeMap::new());
    assert_eq!(found.locked, [(1, -0.5)]);
}
