//! The primal-dual active set method: Newton corrections on the slices that touch.
//!
//! A factor is used again while the set stays and the residual falls fast enough: with r₁ after a correction from r₀,
//! the next one by the same factor is expected to leave r₁²/r₀. Newton's own convergence is quadratic, so that the last
//! of its factorisations is seldom needed.

use super::effort::Effort;
use super::state::Evaluation;
use super::{NlcpError, Params, Problem, Workspace};

/// Corrections without a better active set after which the method is taken to cycle.
///
/// The number of slices on the wrong side falls nearly every time when the method converges; a set that does not
/// improve eight times is either cycling or much slower than the descent.
const STALL_LIMIT: usize = 8;

/// Relative residual below which the last solution is so near that its factor is tried first.
const NEARBY: f64 = 1e-3;

/// Newton corrections on the active set until nothing is on the wrong side; ends unconverged when it cycles.
pub(super) fn active_set(
    problem: &Problem,
    load: Option<f64>,
    params: &Params,
    work: &mut Workspace,
    effort: &mut Effort,
) -> Result<Evaluation, NlcpError> {
    let mut evaluation = work.evaluate(problem);
    let mut fewest_wrong = usize::MAX;
    let mut is_enough = evaluation.residual(load) <= NEARBY;
    let mut stalled = 0;
    for _ in 0..params.max_corrections {
        if evaluation.residual(load) <= params.tolerance {
            break;
        }
        let entered = enter_penetrating(params.tolerance, work);
        if work.list.is_empty() {
            // Under load something must touch: the slice that closes first does.
            enter_first(problem, work);
        }
        effort.iterations += 1;
        if !(is_enough && work.factored == work.list) {
            effort.factor(work, problem)?;
        }
        work.correct_forces();
        if let Some(load) = load
            && !work.balance_correction(problem, load - evaluation.load)
        {
            break;
        }
        for (&slice, change) in work.list.iter().zip(&work.correction) {
            work.force[slice] += change;
        }
        let left = leave_tensile(work);
        let before = evaluation.residual(load);
        evaluation = work.evaluate(problem);
        let after = evaluation.residual(load);
        is_enough = after * after <= params.tolerance * before;
        let wrong = entered + left;
        if wrong > 0 {
            stalled += 1;
            if wrong < fewest_wrong {
                fewest_wrong = wrong;
                stalled = 0;
            } else if stalled >= STALL_LIMIT {
                break;
            }
        }
    }
    Ok(evaluation)
}

/// Takes open slices with a gap below −tolerance × scale into the set; returns their number.
fn enter_penetrating(tolerance: f64, work: &mut Workspace) -> usize {
    let mut entered = 0;
    for i in 0..work.size {
        if !work.active[i] && work.gap[i] < -tolerance * work.scale[i] {
            work.active[i] = true;
            entered += 1;
        }
    }
    work.collect();
    entered
}

fn enter_first(problem: &Problem, work: &mut Workspace) {
    let mut first = 0;
    let mut smallest = f64::INFINITY;
    for i in 0..work.size {
        let touch = work.shifted[i] / problem.closing[i];
        if touch < smallest {
            smallest = touch;
            first = i;
        }
    }
    work.active[first] = true;
    work.list.push(first);
}

/// Releases slices whose force is not positive; returns their number.
fn leave_tensile(work: &mut Workspace) -> usize {
    let mut left = 0;
    for k in 0..work.list.len() {
        let slice = work.list[k];
        // NaN stays, and shows in the residual.
        if work.force[slice] <= 0.0 {
            work.force[slice] = 0.0;
            work.active[slice] = false;
            left += 1;
        }
    }
    left
}
