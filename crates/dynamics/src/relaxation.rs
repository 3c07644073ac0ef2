//! The way down to an equilibrium from far away, where Newton's method goes to and fro between states of contact:
//! pseudo-transient continuation (C. T. Kelley, D. E. Keyes: *Convergence analysis of pseudo-transient continuation*,
//! SIAM J. Numer. Anal. 35, 1998).
//!
//! ```text
//! [σ M + ∂residual/∂q   Bᵀ] [δ ]      [residual ]
//! [B                    0 ] [δλ] = −  [violation]
//! ```
//!
//! With a large σ a step goes a little way along the forces over the masses, with none it is Newton's. σ becomes
//! smaller while what is unbalanced does, and larger where a step makes it much larger, which is then not made.

use std::sync::Arc;

use crate::elements::Iterate;
use crate::equations::{Detail, Equations};
use crate::error::DynamicsError;
use crate::saddle::SaddleForm;
use crate::state::State;
use crate::static_correction::correct;
use crate::static_steps::{SHORT, Walk, in_masses, measure, moments_in_world, standing};
use crate::system::System;
use crate::unbalanced::pushing;

/// Steps at most, those that are not made included.
const MOST_STEPS: usize = 400;

/// Share of all that pushes which is left unbalanced, in the measure of the masses: the rest is Newton's.
const LEFT: f64 = 1e-4;

/// What is unbalanced may grow by this factor in a step: where contacts begin it does.
const GROWTH: f64 = 2.0;

/// Factors on σ after a step, and where one is not made.
const EASED: f64 = 0.3;
const TIGHTENED: f64 = 10.0;

/// Takes a motion and its reactions near to an equilibrium, if there is one down the forces; returns the steps. Where
/// there is none it ends after [`MOST_STEPS`], wherever it is.
///
/// # Errors
/// Of an element at the start, or where the matrix is no number.
pub(crate) fn relax(
    system: &mut System,
    (state, lambda): (&mut State, &mut Vec<f64>),
    load_factor: f64,
    (equations, form): (&mut Equations, &Arc<SaddleForm>),
) -> Result<usize, DynamicsError> {
    let n = system.degrees_of_freedom();
    let (rest, size) = (vec![0.0; n], system.size_m());
    let mut found = Equations::new(system);
    let mut sigma = None;
    let mut steps = 0;
    while steps < MOST_STEPS {
        let at = standing(state, &rest, lambda, (load_factor, Iterate::Single));
        system.evaluate(at, Detail::Tangents, equations)?;
        let pushing = pushing(system, equations, lambda);
        let unbalanced = in_masses(system, &equations.residual);
        if unbalanced <= LEFT * in_masses(system, &pushing) {
            break;
        }
        moments_in_world(system, equations);
        let masses = system.mass_diagonal();
        // The first step is short by itself.
        let mut weight = sigma.unwrap_or_else(|| {
            let along: Vec<f64> = equations
                .residual
                .iter()
                .zip(&masses)
                .map(|(r, m)| r / m)
                .collect();
            measure(system, &along, size).0 / SHORT
        });
        let mut added = 0.0;
        loop {
            steps += 1;
            for (dof, mass) in masses.iter().enumerate() {
                equations.stiffness.add(dof, dof, (weight - added) * mass);
            }
            added = weight;
            let correction = correct(system, (equations, form), &pushing)?;
            let walk = Walk {
                from: state.clone(),
                lambda_from: lambda.clone(),
                correction: &correction.values,
                most_force: GROWTH * unbalanced,
            };
            let ratio = measure(system, &correction.values[..n], size).0;
            walk.to((10.0 * SHORT / ratio).min(1.0), system, state, lambda);
            let at = standing(state, &rest, lambda, (load_factor, Iterate::Single));
            if walk.is_clear(at, system, &mut found) {
                weight *= EASED;
                break;
            }
            state.clone_from(&walk.from);
            lambda.clone_from(&walk.lambda_from);
            if steps >= MOST_STEPS {
                return Ok(steps);
            }
            weight *= TIGHTENED;
        }
        sigma = Some(weight);
    }
    Ok(steps)
}
