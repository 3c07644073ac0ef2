//! Verification on random problems: residual of every answer from the definition, agreement with independent solvers.
#![allow(clippy::unwrap_used, clippy::needless_range_loop, clippy::print_stdout)] // test code; the figures of the run are its output

mod nlcp_common;

use gearmesh_contact::nlcp::{Params, Workspace, solve_load, solve_position};
use nlcp_common::lemke::lemke;
use nlcp_common::projected;
use nlcp_common::random::{Case, Kind, Random, case};

/// Agreement of the gaps with the independent solvers, relative to the row scale.
///
/// Both answers have a residual near rounding; gaps of a positive semi-definite problem are unique, but their
/// sensitivity grows with the square root of the residual where the matrix is singular, hence not smaller.
const GAP_TOLERANCE: f64 = 1e-6;

/// Agreement of the forces on well-conditioned matrices, relative to the largest force.
const FORCE_TOLERANCE: f64 = 1e-6;

#[derive(Debug, Default)]
struct Figures {
    problems: usize,
    linear: usize,
    worst_residual: f64,
    most_iterations: usize,
    iterations: usize,
    descents: usize,
    shifted: usize,
    lemke_compared: usize,
    lemke_rays: usize,
    worst_lemke_gap: f64,
    worst_lemke_force: f64,
    projected_compared: usize,
    projected_slow: usize,
    worst_projected_force: f64,
}

fn run(seed: u64, count: usize, projected_every: usize) -> Figures {
    let mut random = Random::new(seed);
    let mut work = Workspace::new(20);
    let params = Params::default();
    let mut figures = Figures::default();
    for index in 0..count {
        let case = case(20, &mut random);
        let (data, problem) = (&case.data, case.data.problem());
        // Every other problem starts from the unrelated answer of the one before.
        if index % 2 == 0 {
            work.reset();
        }
        let info = solve_load(&problem, case.load, &params, &mut work).unwrap_or_else(|e| {
            panic!("problem {index}, {:?}, n = {}: {e}", case.kind, data.size())
        });
        let residual = data.residual(work.forces(), info.approach_m, Some(case.load));
        assert!(
            residual <= 1e-10,
            "problem {index}, {:?}: residual {residual:e}, {info:?}",
            case.kind
        );
        figures.problems += 1;
        figures.worst_residual = figures.worst_residual.max(residual);
        figures.iterations += info.iterations;
        figures.most_iterations = figures.most_iterations.max(info.iterations);
        figures.descents += usize::from(info.descent);
        figures.shifted += usize::from(info.shifts > 0);

        let approach = info.approach_m;
        let info = solve_position(&problem, approach, &params, &mut work).unwrap();
        let residual = data.residual(work.forces(), approach, None);
        assert!(
            residual <= 1e-10,
            "problem {index}, {:?} at given approach: {residual:e}, {info:?}",
            case.kind
        );
        figures.worst_residual = figures.worst_residual.max(residual);
        figures.descents += usize::from(info.descent);

        if case.linear {
            figures.linear += 1;
            compare_with_lemke(index, &case, approach, work.forces(), &mut figures);
        } else if index % projected_every == 1 && well_conditioned(case.kind) {
            compare_with_projected(index, &case, approach, work.forces(), &mut figures);
        }
    }
    figures
}

fn well_conditioned(kind: Kind) -> bool {
    matches!(kind, Kind::GearLike | Kind::Gram)
}

fn compare_with_lemke(
    index: usize,
    case: &Case,
    approach: f64,
    force: &[f64],
    figures: &mut Figures,
) {
    let data = &case.data;
    let first = data.problem().first_contact();
    let q: Vec<f64> = (data.separation.iter().zip(&data.closing))
        .map(|(e, w)| (e - first * w).max(0.0) - (approach - first) * w)
        .collect();
    let Some(other) = lemke(&data.compliance, &q) else {
        figures.lemke_rays += 1;
        return;
    };
    // An answer that does not solve the problem is no judge: dense pivoting has no refinement.
    if data.residual(&other, approach, None) > 1e-8 {
        figures.lemke_rays += 1;
        return;
    }
    figures.lemke_compared += 1;
    let ((mine, scale), (theirs, _)) = (data.gaps(force, approach), data.gaps(&other, approach));
    for i in 0..data.size() {
        let difference = (mine[i] - theirs[i]).abs() / scale[i];
        figures.worst_lemke_gap = figures.worst_lemke_gap.max(difference);
        assert!(
            difference <= GAP_TOLERANCE,
            "problem {index}, {:?}: gap differs by {difference:e}",
            case.kind
        );
    }
    if well_conditioned(case.kind) {
        let difference = force_difference(force, &other);
        figures.worst_lemke_force = figures.worst_lemke_force.max(difference);
        assert!(
            difference <= FORCE_TOLERANCE,
            "problem {index}, {:?}: force differs by {difference:e}",
            case.kind
        );
    }
}

fn compare_with_projected(
    index: usize,
    case: &Case,
    approach: f64,
    force: &[f64],
    figures: &mut Figures,
) {
    let mut other = vec![0.0; force.len()];
    if projected::position(&case.data, approach, &mut other).is_none() {
        figures.projected_slow += 1;
        return;
    }
    figures.projected_compared += 1;
    let difference = force_difference(force, &other);
    figures.worst_projected_force = figures.worst_projected_force.max(difference);
    assert!(
        difference <= FORCE_TOLERANCE,
        "problem {index}, {:?}: force differs by {difference:e}",
        case.kind
    );
}

fn force_difference(a: &[f64], b: &[f64]) -> f64 {
    let largest = a.iter().chain(b).copied().fold(f64::MIN_POSITIVE, f64::max);
    a.iter()
        .zip(b)
        .map(|(x, y)| (x - y).abs())
        .fold(0.0, f64::max)
        / largest
}

/// The comparisons must have taken place, or the test shows nothing.
fn check_coverage(figures: &Figures) {
    println!("{figures:#?}");
    assert!(figures.linear * 3 > figures.problems, "{figures:?}");
    assert!(
        figures.lemke_compared * 100 >= figures.linear * 80,
        "{figures:?}"
    );
    assert!(
        figures.projected_compared > 10 * figures.projected_slow,
        "{figures:?}"
    );
}

#[test]
fn hundred_thousand_random_problems() {
    check_coverage(&run(1, 100_000, 200));
}

#[test]
#[ignore = "a million problems take a minute; run with --ignored"]
fn million_random_problems() {
    check_coverage(&run(2, 1_000_000, 200));
}

#[test]
fn given_load_agrees_with_projected_gauss_seidel() {
    let mut random = Random::new(3);
    let mut work = Workspace::new(12);
    let mut compared = 0;
    for index in 0..400 {
        let case = case(12, &mut random);
        if case.kind != Kind::GearLike {
            continue;
        }
        let info = solve_load(
            &case.data.problem(),
            case.load,
            &Params::default(),
            &mut work,
        )
        .unwrap();
        let Some((approach, force)) = projected::load(&case.data, case.load) else {
            continue;
        };
        compared += 1;
        let difference = force_difference(work.forces(), &force);
        assert!(
            difference <= FORCE_TOLERANCE,
            "problem {index}: force differs by {difference:e}"
        );
        let first = case.data.problem().first_contact();
        let relative = (info.approach_m - approach).abs() / (approach - first);
        assert!(
            relative <= 1e-7,
            "problem {index}: deflection differs by {relative:e}"
        );
    }
    assert!(compared > 60, "only {compared} problems compared");
}
