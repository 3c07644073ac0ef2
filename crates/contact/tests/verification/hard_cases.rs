//! Hard problems of the contact solver: residual of every answer from the definition, agreement with solvers of other
//! kinds.
#![allow(clippy::unwrap_used, clippy::needless_range_loop, clippy::print_stdout)] // test code; the figures of the run are its output

use crate::nlcp_common;

use gearmesh_contact::nlcp::{LocalLaw, Params, Workspace, solve_load, solve_position};
use nalgebra::{DMatrix, DVector};
use nlcp_common::Data;
use nlcp_common::families::{FAMILIES, Family, problem};
use nlcp_common::lemke::lemke;
use nlcp_common::projected;
use nlcp_common::random::{Case, Kind, Random, case};

/// Largest relative residual of an answer: what the solver promises (`Params::tolerance`).
const RESIDUAL: f64 = 1e-10;

/// Agreement of the gaps with the independent solvers, relative to the row scale.
///
/// Both answers have a residual near rounding; gaps of a positive semi-definite problem are unique, but their
/// sensitivity grows with the square root of the residual where the matrix is singular, hence not smaller.
const GAP_TOLERANCE: f64 = 1e-6;

/// Agreement of the forces on well-conditioned matrices, relative to the largest force.
const FORCE_TOLERANCE: f64 = 1e-6;

/// Problems that CI solves; NLCP_PROBLEMS in the environment says another number.
const PROBLEMS: usize = 90_000;

/// Corrections that have a place of their own in the histogram.
const COUNTED: usize = 12;

#[derive(Debug, Default)]
struct Figures {
    problems: usize,
    linear: usize,
    /// Worst residual, and the seed of its problem.
    worst: (f64, u64),
    iterations: [usize; COUNTED + 1],
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

impl Figures {
    fn note(&mut self, residual: f64, seed: u64) {
        if residual > self.worst.0 {
            self.worst = (residual, seed);
        }
    }

    /// What the page of hard cases shows.
    fn print(&self, family: Family) {
        let histogram: Vec<String> = (self.iterations.iter().enumerate())
            .filter(|(_, count)| **count > 0)
            .map(|(k, count)| match k {
                COUNTED => format!("more: {count}"),
                k => format!("{k}: {count}"),
            })
            .collect();
        println!(
            "{}: {} problems, worst residual {:.1e} (seed {}); by descent {}, shifted {}; Lemke {} compared, {} without an answer, gaps {:.1e}, \
             forces {:.1e}; projected {} compared, {} too slow, forces {:.1e}; corrections {}",
            family.words(),
            self.problems,
            self.worst.0,
            self.worst.1,
            self.descents,
            self.shifted,
            self.lemke_compared,
            self.lemke_rays,
            self.worst_lemke_gap,
            self.worst_lemke_force,
            self.projected_compared,
            self.projected_slow,
            self.worst_projected_force,
            histogram.join(", ")
        );
    }
}

/// Solves problems of a family by load, cold and from the unrelated answer of the one before, and by the approach
/// found.
fn run(family: Family, count: usize, projected_every: usize) -> Figures {
    let mut work = Workspace::new(20);
    let params = Params::default();
    let mut figures = Figures::default();
    for index in 0..count {
        let seed = index as u64;
        let case = problem(family, seed);
        let (data, problem) = (&case.data, case.data.problem());
        let told = || {
            format!(
                "{family:?}, seed {seed}, {:?}, {} slices",
                case.kind,
                data.size()
            )
        };
        if index % 2 == 0 {
            work.reset();
        }
        let info = solve_load(&problem, case.load, &params, &mut work)
            .unwrap_or_else(|e| panic!("{}: {e}", told()));
        let residual = data.residual(work.forces(), info.approach_m, Some(case.load));
        assert!(
            residual <= RESIDUAL,
            "{}: residual {residual:e}, {info:?}",
            told()
        );
        figures.problems += 1;
        figures.note(residual, seed);
        figures.iterations[info.iterations.min(COUNTED)] += 1;
        figures.descents += usize::from(info.descent);
        figures.shifted += usize::from(info.shifts > 0);

        let approach = info.approach_m;
        let info = solve_position(&problem, approach, &params, &mut work)
            .unwrap_or_else(|e| panic!("{} at given approach: {e}", told()));
        let residual = data.residual(work.forces(), approach, None);
        assert!(
            residual <= RESIDUAL,
            "{} at given approach: {residual:e}, {info:?}",
            told()
        );
        figures.note(residual, seed);
        figures.descents += usize::from(info.descent);

        let keeps_forces = family.keeps_forces(case.kind);
        if case.linear {
            figures.linear += 1;
            compare_with_lemke(
                index,
                (&case, keeps_forces),
                approach,
                work.forces(),
                &mut figures,
            );
        } else if index % projected_every == 1 && keeps_forces {
            compare_with_projected(index, &case, approach, work.forces(), &mut figures);
        }
        // Nothing touches before the first contact.
        let before = problem.first_contact() - 1e-6;
        let open = solve_position(&problem, before, &params, &mut work).unwrap();
        assert!(
            open.active == 0 && work.forces().iter().all(|f| *f == 0.0),
            "{}: {open:?}",
            told()
        );
    }
    figures
}

fn compare_with_lemke(
    index: usize,
    (case, keeps_forces): (&Case, bool),
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
        let difference = (mine[i] - theirs[i]).abs() / scale[i].max(f64::MIN_POSITIVE);
        figures.worst_lemke_gap = figures.worst_lemke_gap.max(difference);
        assert!(
            difference <= GAP_TOLERANCE,
            "seed {index}, {:?}: gap differs by {difference:e}",
            case.kind
        );
    }
    if keeps_forces {
        let difference = force_difference(force, &other);
        figures.worst_lemke_force = figures.worst_lemke_force.max(difference);
        assert!(
            // The rounding takes a matrix to be inverted, and is hardly ever needed.
            difference <= FORCE_TOLERANCE
                || difference <= FORCE_TOLERANCE + rounding_of_gaps(data, force, approach, first),
            "seed {index}, {:?}: force differs by {difference:e}",
            case.kind
        );
    }
}

/// What the forces may differ by for the rounding of the right-hand side that Lemke's method was given, over the
/// largest force: |C_AA⁻¹| δq over the slices A that carry, with δq = ε (|e| + (|a₀| + |a|) w) of its differences.
/// Just behind the first contact, where a − a₀ keeps few digits of a, that is far above ε.
fn rounding_of_gaps(data: &Data, force: &[f64], approach: f64, first: f64) -> f64 {
    let carries: Vec<usize> = (0..force.len()).filter(|&i| force[i] > 0.0).collect();
    let (n, count) = (force.len(), carries.len());
    let compliance = DMatrix::from_fn(count, count, |i, j| {
        data.compliance[carries[i] * n + carries[j]]
    });
    let Some(inverse) = compliance.try_inverse() else {
        return 0.0;
    };
    let rounding = DVector::from_fn(count, |i, _| {
        let (e, w) = (data.separation[carries[i]], data.closing[carries[i]]);
        f64::EPSILON * (e.abs() + (first.abs() + approach.abs()) * w)
    });
    let largest = force.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    (inverse.abs() * rounding).amax() / largest
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
        "seed {index}, {:?}: force differs by {difference:e}",
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

/// Duplicate and nearly dependent slices, gaps of zero and of one size, one slice alone, all pressed, forces from 1e-9
/// to 1e9 N, compliances over twelve decades, friction that turns within the slices: every residual at most 1e-10 of
/// its row, the gaps those of Lemke's pivoting, the forces those of projected Gauss-Seidel where they are unique, no
/// force before the first contact.
#[test]
fn families_of_hard_contact_problems() {
    let count = std::env::var("NLCP_PROBLEMS").map_or(PROBLEMS, |text| text.parse().unwrap());
    for family in FAMILIES {
        let figures = run(family, count.div_ceil(FAMILIES.len()), 50);
        figures.print(family);
        // The comparisons must have taken place, or the test shows nothing.
        assert!(figures.linear * 3 > figures.problems, "{figures:?}");
        if family == Family::Random {
            assert!(
                figures.lemke_compared * 100 >= figures.linear * 80,
                "{figures:?}"
            );
            assert!(
                figures.projected_compared > 10 * figures.projected_slow,
                "{figures:?}"
            );
        }
        // Elsewhere dense pivoting gives up more often, but on no family always.
        assert!(figures.lemke_compared * 10 >= figures.linear, "{figures:?}");
    }
}

/// The load given, slices of gears: approach and forces are those of projected Gauss-Seidel with a bracket on the
/// approach.
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
            "seed {index}: force differs by {difference:e}"
        );
        let first = case.data.problem().first_contact();
        let relative = (info.approach_m - approach).abs() / (approach - first);
        assert!(
            relative <= 1e-7,
            "seed {index}: deflection differs by {relative:e}"
        );
    }
    println!("{compared} problems compared");
    assert!(compared > 60, "only {compared} problems compared");
}

/// Linear complementarity problems w = M z + q ≥ 0, z ≥ 0, wᵀz = 0 that are published with the Siconos software
/// (numerics/src/LCP/test/data, whose own licence is Apache 2.0), those of its collection whose M is symmetric: name,
/// rows of M, q, an answer or none where there are many.
type Published = (
    &'static str,
    &'static [f64],
    &'static [f64],
    Option<&'static [f64]>,
);

const PUBLISHED: [Published; 2] = [
    // Cottle, Pang, Stone, The Linear Complementarity Problem, remark 4.1.14: every z₁ + z₂ = 1 is an answer.
    ("lcp_CPS_1", &[1.0, 1.0, 1.0, 1.0], &[-1.0, -1.0], None),
    (
        "lcp_deudeu",
        &[2.0, 1.0, 1.0, 2.0],
        &[-5.0, -6.0],
        Some(&[4.0 / 3.0, 7.0 / 3.0]),
    ),
];

/// The converter: q = e − a with slices of equal closing, a the approach, e ≥ 0.
fn of_linear_problem(m: &[f64], q: &[f64]) -> (Data, f64) {
    let n = q.len();
    let least = q.iter().copied().fold(f64::INFINITY, f64::min);
    let data = Data {
        compliance: m.to_vec(),
        local: vec![LocalLaw::none(); n],
        separation: q.iter().map(|q| q - least).collect(),
        closing: vec![1.0; n],
        lever: vec![1.0; n],
    };
    (data, -least)
}

/// Fathi's problems: M = L Lᵀ with ones on the diagonal of L and twos below, q = −1, symmetric and positive definite.
/// The answer is zᵀ = (1, 0, …, 0); on such problems the number of pivots of Lemke's and Murty's methods grows
/// exponentially with n (Y. Fathi, Math. Program. 17 (1979) 335-344).
fn of_fathi(n: usize) -> (Vec<f64>, Vec<f64>) {
    let below = |i: usize, j: usize| match i.cmp(&j) {
        std::cmp::Ordering::Less => 0.0,
        std::cmp::Ordering::Equal => 1.0,
        std::cmp::Ordering::Greater => 2.0,
    };
    let entry = |at: usize| (0..n).map(|k| below(at / n, k) * below(at % n, k)).sum();
    ((0..n * n).map(entry).collect(), vec![-1.0; n])
}

/// Published linear complementarity problems with symmetric matrices, as contacts at a given approach: a singular one
/// of which every z₁ + z₂ = 1 is an answer, and Fathi's, on which pivoting methods take exponentially many steps.
/// Residual at most 1e-10, the known answers, and no more corrections than slices.
#[test]
fn published_linear_complementarity_problems() {
    let mut work = Workspace::new(32);
    let mut solve = |name: &str, m: &[f64], q: &[f64]| {
        let (data, approach) = of_linear_problem(m, q);
        work.reset();
        let info = solve_position(&data.problem(), approach, &Params::default(), &mut work)
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        let residual = data.residual(work.forces(), approach, None);
        println!(
            "{name}: residual {residual:.1e}, {} corrections",
            info.iterations
        );
        assert!(residual <= RESIDUAL, "{name}: {residual:e}");
        assert!(info.iterations <= q.len().max(3), "{name}: {info:?}");
        work.forces().to_vec()
    };
    for (name, m, q, answer) in PUBLISHED {
        let z = solve(name, m, q);
        match answer {
            Some(answer) => assert!(force_difference(&z, answer) < 1e-12, "{name}: {z:?}"),
            None => assert!((z.iter().sum::<f64>() - 1.0).abs() < 1e-10, "{name}: {z:?}"),
        }
    }
    for n in [2, 4, 8, 16, 32] {
        let (m, q) = of_fathi(n);
        let z = solve(&format!("Fathi, n {n}"), &m, &q);
        let mut answer = vec![0.0; n];
        answer[0] = 1.0;
        assert!(
            force_difference(&z, &answer) < FORCE_TOLERANCE,
            "{n}: {z:?}"
        );
    }
}
