//! Accelerations, reactions and their rates at a given motion: what an integration starts from.
//!
//! ```text
//! [M  Bᵀ] [v̇]   [Q − velocity-dependent inertia]
//! [B  0 ] [λ] = [f̈ − (dB/dt) v                  ]
//! ```

use std::sync::Arc;

use crate::elements::Iterate;
use crate::equations::{At, Detail, Equations};
use crate::error::DynamicsError;
use crate::matrix::Matrix;
use crate::saddle::{Saddle, SaddleForm};
use crate::scheme::LinearSolver;
use crate::state::State;
use crate::system::System;
use crate::unknown::{Unknown, UnknownKind};
use crate::unknown_start::settle_unknowns;

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
        iterate: Iterate::Single,
    };
    system.evaluate(at, Detail::Tangents, equations)?;
    let mut forces: Vec<f64> = equations.residual.iter().map(|r| -r).collect();
    // What has no mass has no acceleration here; that of a run follows from differences.
    system.hold_massless(&mut equations.mass);
    for dof in system.layout.massless() {
        forces[dof] = 0.0;
    }
    let rates = system.gradient_rate(state);
    let right: Vec<f64> = system
        .prescribed(state.time_s)
        .zip(&rates)
        .map(|(f, rate)| f.acceleration - rate)
        .collect();
    if !saddle.factor(&equations.mass, &equations.gradient, &equations.gradient) {
        return Err(DynamicsError::singular(
            "the matrix of accelerations and reactions",
            state.time_s,
        ));
    }
    saddle.solve(&forces, &right, &mut acceleration, &mut lambda);
    Ok(Accelerations {
        acceleration,
        lambda,
    })
}

/// v̈ by a central difference of [`accelerations`] along the motion, ± `step_s`: an error of the second order in the
/// step. Coordinates without mass get their accelerations, and those in equilibrium their rates, by differences, too.
pub(crate) fn jerk(
    system: &mut System,
    state: &mut State,
    acceleration: &mut [f64],
    step_s: f64,
    equations: &mut Equations,
    saddle: &mut Saddle,
) -> Result<Vec<f64>, DynamicsError> {
    let mut along = |time: f64| {
        let mut moved = state.clone();
        let increment: Vec<f64> = state
            .velocity
            .iter()
            .zip(&*acceleration)
            .map(|(v, a)| time * (v + 0.5 * time * a))
            .collect();
        moved.set_moved(state, &increment, &system.layout);
        moved.time_s = state.time_s + time;
        for (v, a) in moved.velocity.iter_mut().zip(&*acceleration) {
            *v += time * a;
        }
        settle_unknowns(system, &mut moved)?;
        let found = accelerations(system, &moved, equations, saddle)?;
        Ok::<_, DynamicsError>((found.acceleration, moved))
    };
    let (before, after) = (along(-step_s)?, along(step_s)?);
    for (i, (dof, unknown)) in system.layout.unknown_dofs().enumerate() {
        let [least, here, most] = [&before.1, &*state, &after.1].map(|state| state.unknowns[i]);
        match unknown.kind {
            UnknownKind::Inertial { .. } => {}
            UnknownKind::Rate => {
                acceleration[dof] =
                    (after.1.velocity[dof] - before.1.velocity[dof]) / (2.0 * step_s);
            }
            UnknownKind::Equilibrium => {
                state.velocity[dof] = (most - least) / (2.0 * step_s);
                acceleration[dof] = (most - 2.0 * here + least) / (step_s * step_s);
            }
        }
    }
    let pairs = after.0.iter().zip(&before.0);
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
        let mut saddle = Saddle::new(
            &self.mass_diagonal(),
            self.layout.massless(),
            &Arc::new(form),
        );
        accelerations(self, state, &mut equations, &mut saddle)
    }

    /// Diagonal of the mass matrix, which does not change with the motion; zero where an equation has no mass.
    pub(crate) fn masses(&self) -> Vec<f64> {
        let bodies = self
            .inertias
            .iter()
            .flat_map(crate::inertia::Inertia::diagonal);
        bodies
            .chain(self.layout.unknowns().iter().map(Unknown::mass))
            .collect()
    }

    /// The same with masses in place of the zeros that make a coordinate over its scale weigh as much as a turn of the
    /// heaviest body at the size of the system: for scales.
    pub(crate) fn mass_diagonal(&self) -> Vec<f64> {
        let heaviest = self
            .bodies
            .iter()
            .fold(0.0_f64, |most, b| most.max(b.mass_kg));
        let inertia = heaviest * self.size_m().powi(2);
        let mut masses = self.masses();
        for (dof, unknown) in self.layout.unknown_dofs() {
            if unknown.mass() == 0.0 {
                masses[dof] = inertia / (unknown.scale * unknown.scale);
            }
        }
        masses
    }

    /// Gives coordinates without mass one of 1, so that a matrix of masses and joints is regular; they then do not move
    /// in it.
    pub(crate) fn hold_massless(&self, mass: &mut Matrix) {
        for dof in self.layout.massless() {
            mass.add(dof, dof, 1.0);
        }
    }
}
