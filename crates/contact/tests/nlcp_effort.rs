//! Effort pinned: corrections and factorisations of a fixed set of problems. A regression test: it says "unchanged".
#![allow(clippy::unwrap_used, clippy::needless_range_loop)] // test code in index notation

mod nlcp_common;
mod pair_common;

use gearmesh_contact::nlcp::{Params, Workspace, solve_load};
use gearmesh_contact::{ContactLines, Drive};
use gearmesh_geometry::{GearPair, Misalignment, ToothGeometry};
use nlcp_common::random::{Kind, Random, case, compliance, weber};

#[test]
fn effort_of_warm_steps_is_unchanged() {
    let mut random = Random::new(41);
    let n = 15;
    let compliance = compliance(Kind::GearLike, n, &mut random);
    let local: Vec<_> = (0..n).map(|_| weber(100.0, &mut random)).collect();
    let mut work = Workspace::new(n);
    let mut iterations = Vec::new();
    for step in 0..20 {
        let separation = (0..n)
            .map(|i| 4e-6 * (0.05 * f64::from(step) + 0.3 * i as f64).sin())
            .collect();
        let data = nlcp_common::Data {
            compliance: compliance.clone(),
            local: local.clone(),
            separation,
            closing: vec![1.0; n],
            lever: vec![0.07; n],
        };
        let info = solve_load(&data.problem(), 70.0, &Params::default(), &mut work).unwrap();
        // One more for the tangent.
        assert_eq!(info.factorisations, info.iterations + 1);
        iterations.push(info.iterations);
    }
    assert_eq!(iterations, WARM_STEPS);
}

#[test]
fn effort_of_random_cold_problems_is_unchanged() {
    let mut random = Random::new(42);
    let mut work = Workspace::new(20);
    let mut histogram = [0; 12];
    let mut descents = 0;
    for _ in 0..2000 {
        let case = case(20, &mut random);
        // On ill-conditioned matrices rounding, hence the platform, decides the last iteration.
        if case.kind != Kind::GearLike {
            continue;
        }
        work.reset();
        let info = solve_load(
            &case.data.problem(),
            case.load,
            &Params::default(),
            &mut work,
        )
        .unwrap();
        histogram[info.iterations.min(11)] += 1;
        descents += usize::from(info.descent);
    }
    assert_eq!((histogram, descents), RANDOM_PROBLEMS);
}

/// Corrections of each of the twenty steps; the first is cold.
const WARM_STEPS: [usize; 20] = [3, 4, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3];

/// Number of problems by corrections (the last entry: 11 or more), and those left to the descent.
const RANDOM_PROBLEMS: ([usize; 12], usize) = ([14, 91, 146, 144, 62, 18, 4, 0, 0, 0, 0, 0], 0);

/// Corrections over a mesh cycle of 24 positions of a helical pair of 12 slices, each from the forces of the last, and
/// of the same positions from nothing.
#[test]
fn effort_of_helical_positions_is_unchanged() {
    let gear = |teeth: usize, helix_deg: f64| {
        let mut d = pair_common::tooth(teeth, 0.0, 0.0);
        d.helix_angle_rad = f64::to_radians(helix_deg);
        ToothGeometry::new(&d).unwrap()
    };
    let (gear_1, gear_2) = (gear(31, 20.0), gear(40, -20.0));
    let centre = gear_1.reference_radius_m + gear_2.reference_radius_m;
    let pair = GearPair::new(gear_1, gear_2, centre, Misalignment::default()).unwrap();
    let lines = ContactLines {
        extension: None,
        ..pair_common::extended(pair, 1e-4)
    };
    let mut contact = pair_common::contact(&lines, pair_common::FRICTIONLESS, 12);
    let step = lines.pair.pitch_1_rad() / 24.0;
    let mut corrections = |cold: bool| {
        let mut each = |k: u32| {
            if cold {
                contact.reset();
            }
            let angle = 0.0137 + step * f64::from(k);
            contact
                .solve(angle, Drive::Torque(200.0))
                .unwrap()
                .info
                .iterations
        };
        (0..24).map(&mut each).collect::<Vec<_>>()
    };
    corrections(false);
    let found = [corrections(false), corrections(true)];
    assert_eq!(found, HELICAL_POSITIONS);
}

/// Corrections of each position, warm and cold.
const HELICAL_POSITIONS: [[usize; 24]; 2] = [
    [
        3, 3, 3, 3, 3, 4, 3, 3, 3, 4, 3, 4, 4, 3, 3, 4, 3, 3, 5, 4, 3, 4, 4, 3,
    ],
    [
        3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 4, 3, 3,
    ],
];
