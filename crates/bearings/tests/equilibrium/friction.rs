//! Friction torque: the published powers, hand calculations, and the coefficients of friction that catalogues print.

use std::f64::consts::PI;

use gearmesh_bearings::bearing_file::BearingFromFile;
use gearmesh_bearings::ring_equilibrium::{AppliedBearingLoad, TiltCondition};
use gearmesh_bearings::{FrictionTorque, Operation, Ratings};
use gearmesh_geometry::input::InputDocument;

use crate::common::{B218, B6205, PAIR, ROLLERS, TAPERED, bearing, close, definition};

fn friction(text: &str, force_n: [f64; 3], rpm: f64) -> FrictionTorque {
    let load = AppliedBearingLoad {
        force_n,
        tilt: TiltCondition::Held([0.0; 2]),
    };
    let operation = Operation {
        inner_rad_per_s: rpm * PI / 30.0,
        ..Operation::default()
    };
    let own = bearing(text);
    let pose = own.equilibrium(&load, &operation).unwrap();
    let (_, loads) = own.loads(&pose, &operation).unwrap();
    let d = definition(text);
    d.friction.unwrap().torque(&d, &loads, &operation)
}

fn oiled(text: &str, more: &str) -> String {
    format!("{text}[friction]\nviscosity_mm2_per_s = 20.0\n{more}")
}

/// The part without load goes with (νn)^⅔ d_m³, is constant where νn is small, and is there at every load.
#[test]
fn the_viscous_part_follows_its_powers() {
    let at = |rpm: f64| friction(&oiled(B6205, ""), [500.0, 0.0, 0.0], rpm).viscous_nm;
    // 1e-7 × 2 × (20 × 1500)^⅔ × 39.04³ N mm
    close(
        at(1500.0),
        1e-10 * 2.0 * 30_000_f64.powf(2.0 / 3.0) * 39.04_f64.powi(3),
        1e-12,
    );
    close(at(12_000.0) / at(1500.0), 4.0, 1e-12);
    close(at(50.0), 1e-10 * 2.0 * 160.0 * 39.04_f64.powi(3), 1e-12);
    // It has no step: 160^1.5/20 rpm is where the two laws meet.
    let meet = 160_f64.powf(1.5) / 20.0;
    close(at(meet * (1.0 + 1e-9)), at(meet * (1.0 - 1e-9)), 1e-8);
    // Two rows, twice; a stated f0 as stated.
    let stated = friction(&oiled(PAIR, "f0 = 1.5\n"), [0.0, 0.0, 100.0], 1500.0);
    close(
        stated.viscous_nm,
        2.0 * 1e-10 * 1.5 * 30_000_f64.powf(2.0 / 3.0) * 65_f64.powi(3),
        1e-12,
    );
}

/// f1 P1 d_m by hand: radial rollers, balls under thrust and across, taper.
#[test]
fn the_part_by_the_load_by_hand() {
    let (force, rollers) = ([2000.0, 1500.0, 0.0], oiled(ROLLERS, ""));
    let across = friction(&rollers, force, 600.0);
    // The rollers press the outer race in their own axial planes, the inner ring in planes through its displaced axis,
    // which are turned by up to u/r_i, r_i 13 mm the inner race's radius: F_r differs by no more than that.
    let load = AppliedBearingLoad {
        force_n: force,
        tilt: TiltCondition::Held([0.0; 2]),
    };
    let own = bearing(&rollers);
    let pose = own.equilibrium(&load, &Operation::default()).unwrap();
    let turned = pose.centre_m.norm() / 13e-3;
    assert!(turned < 2e-3, "{turned}");
    close(across.load_nm, 1e-3 * 0.0003 * 2500.0 * 33.5, turned);
    let c0 = Ratings::of(&definition(B6205)).static_n;
    let along = friction(&oiled(B6205, ""), [0.0, 0.0, 400.0], 60.0);
    // P0 = 0.5 F_a, P1 = 3 F_a.
    close(
        along.load_nm,
        1e-3 * 0.0005 * (200.0 / c0).powf(0.55) * 1200.0 * 39.04,
        1e-4,
    );
    let c0 = Ratings::of(&definition(B218)).static_n;
    let both = friction(&oiled(B218, ""), [3000.0, 0.0, 9000.0], 60.0);
    let (p0, p1) = (
        0.5 * 3000.0 + 0.26 * 9000.0,
        0.9 * 9000.0 / 40_f64.to_radians().tan() - 300.0,
    );
    close(
        both.load_nm,
        1e-3 * 0.001 * (f64::max(p0, 3000.0) / c0).powf(0.33) * p1 * 125.3,
        1e-3,
    );
    let stated = friction(&oiled(B218, "f1 = 0.002\n"), [0.0, 0.0, 9000.0], 60.0);
    close(
        stated.load_nm,
        1e-3 * 0.002 * 0.9 * 9000.0 / 40_f64.to_radians().tan() * 125.3,
        1e-3,
    );
    // Preload rubs without any load from outside.
    assert!(friction(&oiled(PAIR, ""), [0.0; 3], 600.0).load_nm > 1e-3);
}

/// Catalogues give 2M/(P d) of 0.0015 for deep groove, 0.002 for angular contact, 0.0011 for cylindrical and 0.0018 for
/// tapered roller bearings at a tenth of C: a factor of two, which is what two such rules differ by.
#[test]
fn torques_are_of_the_size_of_the_catalogues_coefficients() {
    for (text, bore_mm, force, expected) in [
        (B6205, 25.0, [1.0, 0.0, 0.0], 0.0015),
        (B218, 90.0, [1.0, 0.0, 1.0], 0.0020),
        (ROLLERS, 20.0, [1.0, 0.0, 0.0], 0.0011),
        (TAPERED, 30.0, [1.0, 0.0, 0.4], 0.0018),
    ] {
        let size = 0.1 * Ratings::of(&definition(text)).dynamic_n;
        let force = force.map(|f| f * size);
        let found = friction(&oiled(text, ""), force, 1500.0);
        let load = f64::hypot(force[0], force[2]).max(size);
        let coefficient = 2.0 * found.total_nm() / (load * 1e-3 * bore_mm);
        let ratio = coefficient / expected;
        assert!((0.5..2.0).contains(&ratio), "{text}: {coefficient}");
    }
}

#[test]
fn seals_and_power_add_up() {
    let f = friction(
        &oiled(B6205, "seal_torque_Nm = 0.03\n"),
        [500.0, 0.0, 0.0],
        3000.0,
    );
    close(f.total_nm(), f.viscous_nm + f.load_nm + 0.03, 1e-12);
    close(f.power_w(), f.total_nm() * 100.0 * PI, 1e-12);
    // Turned the other way it loses as much; at rest nothing.
    close(
        friction(
            &oiled(B6205, "seal_torque_Nm = 0.03\n"),
            [500.0, 0.0, 0.0],
            -3000.0,
        )
        .power_w(),
        f.power_w(),
        1e-9,
    );
    assert_eq!(
        friction(&oiled(B6205, ""), [500.0, 0.0, 0.0], 0.0).power_w(),
        0.0
    );
    for (more, part) in [
        ("f0 = -1.0\n", "friction.f0: found -1"),
        ("f1 = 0.5\n", "friction.f1: found 0.5"),
        ("seal_torque_Nm = -0.1\n", "friction.seal_torque_Nm"),
    ] {
        let document = InputDocument::new("b.toml", oiled(B6205, more));
        let found = BearingFromFile::from_document(&document)
            .unwrap_err()
            .to_string();
        assert!(found.contains(part), "{found}");
    }
}
