//! The safeguard: a descent that cannot cycle, for problems on which the active set method does.
//!
//! At fixed deflection `y` the slice forces minimise over `F ≥ 0` the convex function
//!
//! ```text
//! φ(F) = ½ FᵀC F + Σ ∫δ_i dF + Σ (e_i − x₀ w_i − y w_i) F_i,       ∇φ = g
//! ```
//!
//! Newton steps on the present face, cut at the first force that reaches zero and shortened until the slope along the
//! step has fallen, lower φ. When the face is done, the slice with the largest violation enters. φ never rises and each
//! face has one minimum, so that no face comes back (Lawson and Hanson 1974, chapter 23, with curved φ). Slow and sure.
//!
//! With the load given the forces are kept on `Σ b_i F_i = T` and `y` is the multiplier of that condition: for `b`
//! parallel to `w` the same descent, on a plane. With friction (`b` not parallel to `w`) φ is no exact merit any more;
//! the steps stay the same and the number of corrections is bounded.

use super::effort::Effort;
use super::state::Evaluation;
use super::{NlcpError, Problem, Workspace};

/// Corrections allowed: each slice may enter and leave several times, with some Newton steps on each face.
fn correction_limit(size: usize) -> usize {
    200 + 40 * size
}

/// A step is long enough when the slope of φ along it has fallen below this fraction of its start value.
const SLOPE_REDUCTION: f64 = 0.5;

/// Each shortening takes at least a third off the step.
const SHORTENING_LIMIT: usize = 40;

/// Minimises φ at the present deflection, or under the given load, from scratch.
///
/// Returns what was reached, at the latest after [`correction_limit`] corrections.
pub(super) fn descend(
    problem: &Problem,
    load: Option<f64>,
    tolerance: f64,
    work: &mut Workspace,
    effort: &mut Effort,
) -> Result<Evaluation, NlcpError> {
    start(problem, load, work);
    let mut evaluation = work.evaluate(problem);
    for _ in 0..correction_limit(work.size) {
        if evaluation.residual(load) <= tolerance {
            break;
        }
        let balanced = evaluation.balance(load) <= tolerance;
        if balanced && face_is_done(tolerance, work) && !enter_worst(work) {
            break;
        }
        work.collect();
        effort.iterations += 1;
        effort.factor(work, problem)?;
        work.correct_forces();
        if let Some(load) = load
            && !work.balance_correction(problem, load - evaluation.load)
        {
            break;
        }
        evaluation = step(problem, work);
    }
    work.collect();
    Ok(evaluation)
}

/// Admissible forces: none at given deflection, those of independent springs under load.
fn start(problem: &Problem, load: Option<f64>, work: &mut Workspace) {
    work.clear();
    if let Some(load) = load {
        work.start_from_springs(problem, Some(load));
    }
}

fn face_is_done(tolerance: f64, work: &Workspace) -> bool {
    (0..work.size).all(|i| !work.active[i] || work.gap[i].abs() <= tolerance * work.scale[i])
}

/// Takes the open slice with the largest relative penetration into the set; false if none penetrates.
fn enter_worst(work: &mut Workspace) -> bool {
    let mut worst = None;
    let mut largest = 0.0;
    for i in 0..work.size {
        let relative = -work.gap[i] / work.scale[i];
        if !work.active[i] && relative > largest {
            largest = relative;
            worst = Some(i);
        }
    }
    worst.inspect(|&i| work.active[i] = true).is_some()
}

/// Goes along `correction` as far as `F ≥ 0` and the descent of φ allow.
fn step(problem: &Problem, work: &mut Workspace) -> Evaluation {
    let mut length = 1.0;
    let mut blocking = None;
    for (k, &slice) in work.list.iter().enumerate() {
        let change = work.correction[k];
        if work.force[slice] + length * change <= 0.0 && change < 0.0 {
            length = work.force[slice] / -change;
            blocking = Some(slice);
        }
    }
    // The forces before the step; `per_approach` is free here.
    for (k, &slice) in work.list.iter().enumerate() {
        work.per_approach[k] = work.force[slice];
    }
    let start_slope = slope_along(work);
    let mut shortenings = 0;
    loop {
        for (k, &slice) in work.list.iter().enumerate() {
            work.force[slice] = (work.per_approach[k] + length * work.correction[k]).max(0.0);
        }
        if let Some(slice) = blocking {
            work.force[slice] = 0.0;
        }
        let evaluation = work.evaluate(problem);
        let slope = slope_along(work);
        // A start slope that is not negative is rounding: the face is done, any step is right.
        let overshot = start_slope < 0.0 && slope > -SLOPE_REDUCTION * start_slope;
        if !overshot || shortenings == SHORTENING_LIMIT {
            if let Some(slice) = blocking {
                work.active[slice] = false;
            }
            return evaluation;
        }
        // Secant for the zero of the slope; start_slope < 0 < slope, so the step is shortened.
        length *= start_slope / (start_slope - slope);
        blocking = None;
        shortenings += 1;
    }
}

/// Derivative of φ along `correction`.
fn slope_along(work: &Workspace) -> f64 {
    work.list
        .iter()
        .zip(&work.correction)
        .map(|(&slice, change)| work.gap[slice] * change)
        .sum()
}
