//! The last resort for a given load: a bracket on the deflection.
//!
//! Where `b` is not parallel to `w` and the compliance is nearly singular, `dT/dx` may turn negative on a piece of the
//! path, and neither the active set method nor the descent is sure to arrive. But at given `y` the forces always exist,
//! and `T(y) = Σ b_i F_i(y)` is continuous, zero at `y = 0` and unbounded, so that a bracket closes on a solution. Near
//! it the forces may change a lot within the last digits of `y`; each point is therefore handed to the bordered active
//! set method, which has forces and deflection as separate unknowns and needs only the right slices to start from.

use super::active_set::active_set;
use super::effort::Effort;
use super::state::Evaluation;
use super::{NlcpError, Params, Problem, Workspace, descent};

/// Points tried: doublings and bisections that exhaust the digits of any bracket.
const POINT_LIMIT: usize = 200;

/// Corrections of the active set method at each point.
const CORRECTIONS_A_POINT: usize = 12;

/// Finds forces and deflection that balance `load`; returns what was reached.
pub(super) fn balance(
    problem: &Problem,
    load: f64,
    tolerance: f64,
    work: &mut Workspace,
    effort: &mut Effort,
) -> Result<Evaluation, NlcpError> {
    work.start_from_springs(problem, Some(load));
    let mut y = work.deflection;
    let (mut low, mut high) = (0.0, f64::INFINITY);
    let params = Params {
        tolerance,
        max_corrections: CORRECTIONS_A_POINT,
    };
    let mut evaluation = Evaluation {
        gap_residual: f64::INFINITY,
        load: 0.0,
    };
    for _ in 0..POINT_LIMIT {
        work.deflection = y;
        let point = descent::descend(problem, None, tolerance, work, effort)?;
        evaluation = active_set(problem, Some(load), &params, work, effort)?;
        if evaluation.residual(Some(load)) <= tolerance {
            break;
        }
        if point.load < load {
            low = y
        } else {
            high = y
        }
        y = if high.is_finite() {
            0.5 * (low + high)
        } else {
            2.0 * low
        };
    }
    Ok(evaluation)
}
