//! Accelerations, reactions and their rates at a given motion: what an integration starts from.
//!
//! ```text
//! [M  Bᵀ] [v̇]   [Q − velocity-dependent inertia]
//! [B  0 ] [λ] = [f̈ − (dB/dt) v                  ]
//! ```

use std::sync::Arc;

use crate::equations::{At, Detail, Equations};
use crate::error::DynamicsError;
use crate::saddle::{Saddle, SaddleForm};
use crate::scheme::LinearSolver;
use crate::state::State;
use crate::system::System;

/// Accelerations and reactions at one motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Accelerations {
    /// v̇, one for each degree of freedom.
    pub acceleration: Vec<f64>,
    /// λ, one for each joint equation.
    pub lambda: Vec<f64>,
}

/// Solves the system above.
pub(crate) fn accelerations(
    system: &mut System,
    state: &State,
    equations: &mut Equations,
    saddle: &mut Saddle,
) -> Result<Accelerations, DynamicsError> {
    let (n, m) = (system.degrees_of_freedom(), system.equations());
    let mut acceleration = vec![0.0; n];
    let mut lambda = vec![0.0; m];
    let at = At {
        state,
        acceleration: &acceleration,
        lambda: &lambda,
        load_factor: 1.0,
    };
    system.evaluate(at, Detail::Tangents, equations)?;
    let forces: Vec<f64> = equations.residual.iter().map(|r| -r).collect();
    let rates = system.gradient_rate(state);
    let right: Vec<f64> = system
        .prescribed(state.time_s)
        .zip(&rates)
        .map(|(f, rate)| f.acceleration - rate)
        .collect();
    if !saddle.factor(&equations.mass, &equations.gradient, &equations.gradient) {
        return Err(DynamicsError::Singular {
            what: "the matrix of accelerations and reactions",
            time_s: state.time_s,
        });
    }
    saddle.solve(&forces, &right, &mut acceleration, &mut lambda);
    Ok(Accelerations {
        acceleration,
        lambda,
    })
}

/// v̈ by a central difference of [`accelerations`] along the motion, ± `step_s`: an error of the second order in the step.
pub(crate) fn jerk(
    system: &mut System,
    state: &State,
    acceleration: &[f64],
    step_s: f64,
    equations: &mut Equations,
    saddle: &mut Saddle,
) -> Result<Vec<f64>, DynamicsError> {
    let mut along = |time: f64| {
        let mut moved = state.clone();
        let increment: Vec<f64> = state
            .velocity
            .iter()
            .zip(acceleration)
            .map(|(v, a)| time * (v + 0.5 * time * a))
            .collect();
        moved.set_moved(state, &increment, &system.layout);
        moved.time_s = state.time_s + time;
        for (v, a) in moved.velocity.iter_mut().zip(acceleration) {
            *v += time * a;
        }
        accelerations(system, &moved, equations, saddle)
    };
    let (before, after) = (along(-step_s)?, along(step_s)?);
    let pairs = after.acceleration.iter().zip(&before.acceleration);
    Ok(pairs.map(|(a, b)| (a - b) / (2.0 * step_s)).collect())
}

impl System {
    /// Accelerations and reactions at a motion that fits the joints.
    ///
    /// # Errors
    /// [`DynamicsError::Singular`], or the error of a force element.
    pub fn accelerations(&mut self, state: &State) -> Result<Accelerations, DynamicsError> {
        let mut equations = Equations::new(self);
        let form = SaddleForm::new(&self.structure, &self.kept, LinearSolver::Automatic);
        let mut saddle = Saddle::new(&self.mass_diagonal(), &Arc::new(form));
        accelerations(self, state, &mut equations, &mut saddle)
    }

    /// Diagonal of the mass matrix, which does not change with the motion.
    pub(crate) fn mass_diagonal(&self) -> Vec<f64> {
        self.inertias
            .iter()
            .flat_map(crate::inertia::Inertia::diagonal)
            .collect()
    }
}
