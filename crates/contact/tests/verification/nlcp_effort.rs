//! Effort pinned: corrections and factorisations of a fixed set of problems. A regression test: it says "unchanged".
#![allow(clippy::unwrap_used, clippy::needless_range_loop)] // test code in index notation
#![allow(clippy::print_stdout)] // the counts, for whoever raises a bound

use crate::nlcp_common;
use crate::pair_common;

use gearmesh_contact::Drive;
use gearmesh_contact::nlcp::{Params, Workspace, solve_load};
use nlcp_common::random::{Kind, Random, case, compliance, weber};

#[test]
fn effort_of_warm_steps_is_unchanged() {
    let mut random = Random::new(41);
    let n = 15;
    let compliance = compliance(Kind::GearLike, n, &mut random);
    let local: Vec<_> = (0..n).map(|_| weber(100.0, &mut random)).collect();
    let mut work = Workspace::new(n);
    let (mut iterations, mut factorisations) = (Vec::new(), 0);
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
        // One more for the tangent, one less where the last correction is made by the factor of the one before.
        assert!(info.factorisations <= info.iterations + 1);
        factorisations += info.factorisations;
        iterations.push(info.iterations);
    }
    assert_eq!(
        (&iterations[..], factorisations),
        (&WARM_STEPS.0[..], WARM_STEPS.1)
    );
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

/// Positions of a helical pair with 12 slices, 20°, 400 to a pitch and one from the other. Their time is that of these
/// corrections.
#[test]
fn helical_positions_take_few_corrections() {
    let lines = pair_common::helical(20.0, gearmesh_geometry::Flank::Right);
    let mut contact = pair_common::contact(&lines, pair_common::FRICTIONLESS, 12);
    let step = lines.pair.pitch_1_rad() / 400.0;
    let (mut corrections, mut factorisations, mut most, mut unknowns) = (0, 0, 0, 0);
    for position in 0..=400 {
        let solved = contact.solve(step * f64::from(position), Drive::Torque(300.0));
        let info = solved.unwrap().info;
        unknowns = unknowns.max(contact.patches().len());
        assert!(!info.descent && info.shifts == 0, "{position}");
        if position > 0 {
            corrections += info.iterations;
            factorisations += info.factorisations;
            most = most.max(info.iterations);
        }
    }
    let mean = corrections as f64 / 400.0;
    println!("{unknowns} unknowns, {mean} corrections in the mean, {most} at most");
    assert!((18..=36).contains(&unknowns), "{unknowns}");
    // One more each for the tangent, one less each where a factor is used again.
    assert!(
        factorisations <= corrections + 100,
        "{factorisations} {corrections}"
    );
    assert!(mean < 3.2 && most <= 6, "{mean} {most}");
}

/// Corrections of each of the twenty steps, of which the first is cold, and factorisations of all.
const WARM_STEPS: ([usize; 20], usize) = (
    [3, 4, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3],
    67,
);

/// Number of problems by corrections (the last entry: 11 or more), and those left to the descent.
const RANDOM_PROBLEMS: ([usize; 12], usize) = ([14, 91, 145, 134, 73, 18, 3, 1, 0, 0, 0, 0], 0);
