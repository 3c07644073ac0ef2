//! Newton's method with damping, for steps at which plain iterations find no solution.
//!
//! Friction that turns round within less slip than a step changes has a matrix that says nothing about the other side:
//! whole corrections go to and fro between sliding one way and sliding the other. Here the matrix is made anew at each
//! iterate x, and of its correction Δ = −J(x)⁻¹ r(x) only the share λ is taken after which the same matrix sees less
//! left over:
//!
//! ```text
//! ‖J(x)⁻¹ r(x + λ Δ)‖ ≤ (1 − λ/4) ‖Δ‖        ‖δ‖² = Σ m δ²,  λ = 1, ½, ¼ …
//! ```
//!
//! The test does not depend on how equations are scaled. It costs an evaluation and a solution each time, and a
//! factorisation for each iterate, so that it stands behind the plain iteration.
//!
//! Source: P. Deuflhard, Newton Methods for Nonlinear Problems, Springer 2004, section 3.3 (natural monotonicity test).

use crate::convergence::Measured;
use crate::elements::Iterate;
use crate::equations::Detail;
use crate::integrator::{Integrator, Point, STALLED};
use crate::scheme::Params;
use crate::step_failure::StepFailure;
use crate::system::System;

/// Iterates after which a step is given up.
const MOST: usize = 60;

/// Smallest share of a correction.
const LEAST: f64 = 1e-6;

impl Integrator {
    /// As `attempt`, by damped iterations.
    pub(crate) fn attempt_damped(
        &mut self,
        system: &mut System,
        from: &Point,
        to: &mut Point,
        step_s: f64,
        params: &Params,
    ) -> Result<(), StepFailure> {
        let h = step_s;
        let square = self.scheme.beta * h * h;
        self.begin(system, from, to, h);
        let (mut share, mut ratio, mut largest) = (1.0_f64, f64::INFINITY, 0);
        for iteration in 1..=MOST {
            self.effort.iterations += 1;
            let given_up = StepFailure::no_convergence(iteration, ratio, largest);
            self.evaluate(system, to, (Detail::Tangents, Iterate::Single))
                .map_err(StepFailure::Element)?;
            if !self.factor(system, h) {
                return Err(given_up);
            }
            self.correct(square);
            self.keep(to);
            let whole = self.correction_size();
            loop {
                self.go(system, from, to, (h, share));
                let evaluated = self.evaluate(system, to, (Detail::Forces, Iterate::Single));
                let mut left = f64::INFINITY;
                if evaluated.is_ok() {
                    self.correct(square);
                    left = self.correction_size();
                    let measured = self.measure(system, from, to, h, params.newton_tolerance);
                    let Measured { above_floor, .. } = measured;
                    (ratio, largest) = (measured.ratio, measured.largest);
                    let small = ratio <= 1.0 || above_floor <= STALLED;
                    if share >= 1.0 && small && ratio.is_finite() {
                        self.apply(system, from, to, h);
                        self.finish(from, to, h);
                        return Ok(());
                    }
                }
                if left <= (1.0 - 0.25 * share) * whole {
                    break;
                }
                share *= 0.5;
                if share < LEAST {
                    return Err(evaluated.map_or_else(StepFailure::Element, |()| given_up));
                }
            }
            share = (4.0 * share).min(1.0);
        }
        self.factored_step_s = f64::NAN;
        Err(StepFailure::no_convergence(MOST, ratio, largest))
    }

    /// Keeps the iterate and its correction.
    fn keep(&mut self, to: &Point) {
        self.kept.increment.copy_from_slice(&self.increment);
        self.kept.velocity.copy_from_slice(&to.state.velocity);
        self.kept.acceleration.copy_from_slice(&to.acceleration);
        self.kept.lambda.copy_from_slice(&to.lambda);
        self.kept.delta.copy_from_slice(&self.delta);
        self.kept.mu.copy_from_slice(&self.mu);
    }

    /// From the kept iterate by a share of its correction.
    fn go(&mut self, system: &System, from: &Point, to: &mut Point, (h, share): (f64, f64)) {
        self.increment.copy_from_slice(&self.kept.increment);
        to.state.velocity.copy_from_slice(&self.kept.velocity);
        to.acceleration.copy_from_slice(&self.kept.acceleration);
        to.lambda.copy_from_slice(&self.kept.lambda);
        let kept = self.kept.delta.iter().chain(&self.kept.mu);
        for (value, whole) in self.delta.iter_mut().chain(&mut self.mu).zip(kept) {
            *value = share * whole;
        }
        self.apply(system, from, to, h);
    }

    /// √Σ m δ² of the correction at hand.
    fn correction_size(&self) -> f64 {
        let weighed = self.delta.iter().zip(&self.masses);
        weighed
            .map(|(delta, mass)| mass * delta * delta)
            .sum::<f64>()
            .sqrt()
    }
}
