//! The two calls, and which method solves them: the active set, then the descent, then the bracket.

use super::active_set::active_set;
use super::effort::Effort;
use super::state::Evaluation;
use super::{NlcpError, Params, Problem, Workspace, bracket, descent};

/// What a solve found and what it cost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Info {
    /// Newton corrections made, those of the descent included.
    pub iterations: usize,
    /// Factorisations of the active block, the one for the tangent included.
    pub factorisations: usize,
    /// Relative residual reached (module documentation).
    pub residual: f64,
    /// Slices in contact.
    pub active: usize,
    /// Slices in contact whose force lies below the floor of their local law.
    pub floor_hits: usize,
    /// Slices whose force lies above the cap of their local law: their half width is no longer small against the depth.
    pub cap_hits: usize,
    /// Factorisations that needed a shift because the active block was singular to rounding.
    pub shifts: usize,
    /// Whether the active set method gave up and the descent, or after it the bracket, found the solution.
    pub descent: bool,
    /// Approach `x` \[m\]. At zero load that of the first contact, `min e_i/w_i`.
    pub approach_m: f64,
    /// Load `Σ b_i F_i` \[N·m\].
    pub load: f64,
    /// Tangent `dT/dx = bᵀ(C + diag δ')⁻¹ w` on the active set \[N\] (load per metre of approach).
    pub stiffness: f64,
}

/// Solves for the slice forces at the given approach `approach_m` \[m\].
///
/// Forces, gaps and tangent are left in `work`. If no slice touches, all forces are zero and the tangent vanishes.
///
/// # Errors
/// [`NlcpError`] if the workspace is too small, the tolerance not positive, the approach not finite, the active block
/// not positive definite, or the tolerance is not reached.
pub fn solve_position(
    problem: &Problem,
    approach_m: f64,
    params: &Params,
    work: &mut Workspace,
) -> Result<Info, NlcpError> {
    if !approach_m.is_finite() {
        return Err(NlcpError::Approach { found: approach_m });
    }
    params.check()?;
    work.load_problem(problem)?;
    if work.size == 0 {
        return Ok(open_contact(problem, approach_m, work));
    }
    let deflection = approach_m - work.first_contact;
    if deflection <= 0.0 {
        work.deflection = deflection;
        return Ok(open_contact(problem, approach_m, work));
    }
    let start = if work.warm { Start::Warm } else { Start::Cold };
    work.deflection = deflection;
    solve(problem, None, start, params, work)
}

/// Solves for the slice forces and the approach under the given load `load` \[N·m\] ≥ 0.
///
/// Forces, gaps and tangent are left in `work`. Zero load is the limit from above: no force, and the approach at which
/// the first slice touches.
///
/// # Errors
/// [`NlcpError`] if the workspace is too small, the tolerance not positive, the load negative or not finite, there is
/// no slice to carry it, the active block is not positive definite, or the tolerance is not reached.
pub fn solve_load(
    problem: &Problem,
    load: f64,
    params: &Params,
    work: &mut Workspace,
) -> Result<Info, NlcpError> {
    if !(load.is_finite() && load >= 0.0) {
        return Err(NlcpError::Load { found: load });
    }
    params.check()?;
    work.load_problem(problem)?;
    if work.size == 0 && load > 0.0 {
        return Err(NlcpError::NoSlices { load });
    }
    if load == 0.0 {
        let approach = work.first_contact;
        work.deflection = 0.0;
        return Ok(open_contact(problem, approach, work));
    }
    let start = if work.warm { Start::Warm } else { Start::Cold };
    solve(problem, Some(load), start, params, work)
}

/// Whether the workspace holds a solution to start from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Start {
    Cold,
    Warm,
}

/// No slice carries force.
fn open_contact(problem: &Problem, approach_m: f64, work: &mut Workspace) -> Info {
    work.clear();
    work.force_rate[..work.size].fill(0.0);
    if work.size > 0 {
        work.evaluate(problem);
    }
    // The next solve is better started from springs than from an empty set.
    work.warm = false;
    Info {
        iterations: 0,
        factorisations: 0,
        residual: 0.0,
        active: 0,
        floor_hits: 0,
        cap_hits: 0,
        shifts: 0,
        descent: false,
        approach_m,
        load: 0.0,
        stiffness: 0.0,
    }
}

fn solve(
    problem: &Problem,
    load: Option<f64>,
    start: Start,
    params: &Params,
    work: &mut Workspace,
) -> Result<Info, NlcpError> {
    work.warm = false;
    let given = work.deflection;
    if start == Start::Cold {
        work.factored.clear();
        work.start_from_springs(problem, load);
    }
    let mut effort = Effort::default();
    let mut last = active_set(problem, load, params, work, &mut effort)?;
    let mut descent = false;
    let solved = |evaluation: &Evaluation| evaluation.residual(load) <= params.tolerance;
    if !solved(&last) {
        descent = true;
        work.deflection = given;
        last = descent::descend(problem, load, params.tolerance, work, &mut effort)?;
        if let Some(load) = load
            && !solved(&last)
        {
            last = bracket::balance(problem, load, params.tolerance, work, &mut effort)?;
        }
    }
    let residual = last.residual(load);
    if !solved(&last) {
        return Err(NlcpError::NoConvergence {
            iterations: effort.iterations,
            residual,
            tolerance: params.tolerance,
            active: work.list.len(),
            size: work.size,
        });
    }
    finish(problem, residual, last.load, descent, effort, work)
}

/// Tangent and counters at the solution.
fn finish(
    problem: &Problem,
    residual: f64,
    load: f64,
    descent: bool,
    mut effort: Effort,
    work: &mut Workspace,
) -> Result<Info, NlcpError> {
    work.collect();
    effort.factor(work, problem)?;
    let stiffness = work.differentiate(problem);
    work.force_rate[..work.size].fill(0.0);
    let (mut floor_hits, mut cap_hits) = (0, 0);
    for (k, &slice) in work.list.iter().enumerate() {
        work.force_rate[slice] = work.per_approach[k];
        let (law, force) = (&problem.local[slice], work.force[slice]);
        floor_hits += usize::from(law.is_below_floor(force));
        cap_hits += usize::from(law.is_above_cap(force));
    }
    work.warm = true;
    Ok(Info {
        iterations: effort.iterations,
        factorisations: effort.factorisations,
        residual,
        active: work.list.len(),
        floor_hits,
        cap_hits,
        shifts: effort.shifts,
        descent,
        approach_m: work.first_contact + work.deflection,
        load,
        stiffness,
    })
}
