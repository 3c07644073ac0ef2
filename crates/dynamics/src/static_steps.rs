//! Steps towards a static equilibrium: how large a correction and what is unbalanced are, and the way along a
//! correction.

use nalgebra::Vector3;

use crate::elements::Iterate;
use crate::equations::{At, Detail, Equations};
use crate::rotation::skew;
use crate::state::State;
use crate::system::System;

/// Move within which nothing that is in the way can be passed through, in the measure of [`measure`]: a small part of a
/// tooth.
pub(crate) const SHORT: f64 = 1e-3;

/// A motion under a share of the loads, without accelerations (`rest`: zeros), by itself or next to the last one.
pub(crate) fn standing<'a>(
    state: &'a State,
    rest: &'a [f64],
    lambda: &'a [f64],
    (load_factor, iterate): (f64, Iterate),
) -> At<'a> {
    At {
        state,
        acceleration: rest,
        lambda,
        load_factor,
        iterate,
    }
}

/// Size of forces, in the measure of the masses: √(Σ rᵢ²/mᵢ).
pub(crate) fn in_masses(system: &System, forces: &[f64]) -> f64 {
    let terms = forces.iter().zip(system.mass_diagonal());
    terms.map(|(r, m)| r * r / m).sum::<f64>().sqrt()
}

/// Largest correction (radians, shares of the size) and where.
pub(crate) fn measure(system: &System, increment: &[f64], size: f64) -> (f64, usize) {
    increment
        .iter()
        .enumerate()
        .fold((0.0, 0), |(most, place), (dof, d)| {
            let here = match system.layout.unknown(dof) {
                Some(unknown) => d.abs() / unknown.scale,
                None if (3..6).contains(&system.layout.locate(dof).1) => d.abs(),
                None => d.abs() / size,
            };
            if here > most {
                (here, dof)
            } else {
                (most, place)
            }
        })
}

/// Lets the stiffness be that of moments along fixed axes: δ(R r) = R (δr + δψ × r). Off the equilibrium a rotation
/// that nothing resists would otherwise seem to change the moments, as the axes turn along.
pub(crate) fn moments_in_world(system: &System, equations: &mut Equations) {
    for start in system.layout.starts() {
        let turn = start + 3;
        let moment = Vector3::from_column_slice(&equations.residual[turn..turn + 3]);
        equations.stiffness.add3(turn, turn, &-skew(&moment));
    }
}

/// A correction that is made step by step.
pub(crate) struct Walk<'a> {
    pub from: State,
    pub lambda_from: Vec<f64>,
    /// δ and δλ.
    pub correction: &'a [f64],
    /// Unbalanced force at most.
    pub most_force: f64,
}

impl Walk<'_> {
    /// The motion after a share of the correction.
    pub fn to(&self, share: f64, system: &System, state: &mut State, lambda: &mut [f64]) {
        let (moves, pushes) = self.correction.split_at(system.degrees_of_freedom());
        let increment: Vec<f64> = moves.iter().map(|d| share * d).collect();
        state.set_moved(&self.from, &increment, &system.layout);
        for (&equation, push) in system.kept.iter().zip(pushes) {
            lambda[equation] = self.lambda_from[equation] + share * push;
        }
    }

    /// Whether nothing stiff has been run into; a motion that an element refuses is too far away, too.
    pub fn is_clear(&self, at: At<'_>, system: &mut System, equations: &mut Equations) -> bool {
        let found = system.evaluate(at, Detail::Forces, equations);
        found.is_ok() && in_masses(system, &equations.residual) <= self.most_force
    }
}
