//! A transient run: consistent start, steps, error control, records.

use std::ops::ControlFlow;

use crate::constraints::{self, watch_dropped};
use crate::convergence::KINDS;
use crate::energy::EnergyBalance;
use crate::error::DynamicsError;
use crate::initial;
use crate::integrator::{Integrator, Point};
use crate::scheme::{AdaptiveStep, Params, Scheme, StepControl};
use crate::state::State;
use crate::step_failure::StepFailure;
use crate::system::System;
use crate::unknown_start::settle_unknowns;

/// What a run has needed and how exact it was.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RunInfo {
    /// Accepted steps.
    pub steps: u64,
    /// Steps repeated because the estimated error was too large.
    pub rejected: u64,
    /// Steps repeated because Newton's iteration did not converge.
    pub unconverged: u64,
    /// Newton iterations.
    pub iterations: u64,
    /// Factorisations of the iteration matrix.
    pub factorisations: u64,
    /// Those among them of a sparse matrix that chose pivots and found the pattern of the factors; the others kept
    /// both. Zero where the matrix is solved as a dense one.
    pub pivotings: u64,
    /// Evaluations of the equations: calls of each active force element.
    pub evaluations: u64,
    /// Shortest and longest accepted step \[s\].
    pub step_range_s: (f64, f64),
    /// Largest violation of a joint equation (m or rad).
    pub largest_violation: f64,
    /// Largest violation of the rate of a joint equation (m/s or rad/s). Of the second order in the step:
    /// docs/theory/multibody.md.
    pub largest_violation_rate: f64,
    /// Energy balance.
    pub energy: EnergyBalance,
}

/// An accepted step, as the caller of [`Simulation::run`] sees it.
pub struct Accepted<'a> {
    /// State at its start.
    pub from: &'a State,
    /// State at its end.
    pub to: &'a State,
    /// Reactions λ at its start, one for each joint equation.
    pub lambda_from: &'a [f64],
    /// Reactions λ at its end.
    pub lambda: &'a [f64],
    /// v̇ at its start.
    pub acceleration_from: &'a [f64],
    /// v̇ at its end.
    pub acceleration: &'a [f64],
    /// Records up to its end.
    pub info: &'a RunInfo,
    /// The system, for [`System::sample`] and names.
    pub system: &'a mut System,
}

impl Accepted<'_> {
    /// Writes the state at a time within the step ([`State::interpolate`]).
    pub fn interpolate(&self, time_s: f64, out: &mut State) {
        out.interpolate(self.from, self.to, time_s, self.system.layout());
    }
}

/// Times on a uniform grid, taken from steps as they come.
#[derive(Debug, Clone)]
pub struct OutputGrid {
    interval_s: f64,
    parts: u64,
    next: u64,
    state: State,
}

impl OutputGrid {
    /// Times 0, `interval_s`, 2 `interval_s`, …
    #[must_use]
    pub fn new(interval_s: f64, like: &State) -> Self {
        Self {
            interval_s,
            parts: 1,
            next: 0,
            state: like.clone(),
        }
    }

    /// The same times, and the intervals between them in so many equal parts.
    #[must_use]
    pub fn in_parts(mut self, parts: u64) -> Self {
        self.parts = parts.max(1);
        self
    }

    /// Time of a number \[s\]: those of whole intervals do not depend on the parts.
    fn time_s(&self, number: u64) -> f64 {
        let part = (number % self.parts) as f64 / self.parts as f64;
        ((number / self.parts) as f64 + part) * self.interval_s
    }

    /// Begins with the grid time of this number.
    #[must_use]
    pub fn from_index(mut self, index: u64) -> Self {
        self.next = index;
        self
    }

    /// Number of the grid time that comes next.
    #[must_use]
    pub fn next_index(&self) -> u64 {
        self.next
    }

    /// Calls `write` with the interpolated state at every grid time that the step reaches.
    pub fn visit(&mut self, step: &mut Accepted<'_>, mut write: impl FnMut(&State, &mut System)) {
        let end = step.to.time_s + 1e-9 * self.interval_s;
        while self.time_s(self.next) <= end {
            step.interpolate(self.time_s(self.next), &mut self.state);
            write(&self.state, step.system);
            self.next += 1;
        }
    }
}

/// A run of a system.
pub struct Simulation {
    pub(crate) system: System,
    pub(crate) params: Params,
    pub(crate) integrator: Integrator,
    pub(crate) now: Point,
    /// The last point before an accepted step; scratch during one.
    pub(crate) other: Point,
    /// Length of the next step, to which `now` is tuned \[s\].
    pub(crate) step_s: f64,
    /// Accepted steps of this length.
    pub(crate) steps_alike: u64,
    pub(crate) info: RunInfo,
}

impl Simulation {
    /// Begins at the system's start, velocities fitted to the joints.
    ///
    /// # Errors
    /// [`DynamicsError::Parameter`], [`DynamicsError::Contradiction`], [`DynamicsError::Singular`], or the error of an
    /// element.
    pub fn new(system: System, params: Params) -> Result<Self, DynamicsError> {
        let start = system.start().clone();
        Self::from_state(system, start, params)
    }

    /// Begins at a state, such as a static equilibrium, whose places fit the joints; velocities are fitted.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn from_state(
        mut system: System,
        mut state: State,
        params: Params,
    ) -> Result<Self, DynamicsError> {
        params.validate()?;
        system.begin(&state);
        constraints::project_velocity(&mut system, &mut state)?;
        settle_unknowns(&mut system, &mut state)?;
        let mut integrator = Integrator::new(
            &system,
            Scheme::new(params.rho_infinity),
            params.linear_solver,
        );
        let step_s = params.first_step_s();
        let (equations, saddle) = integrator.for_start();
        let mut first = initial::accelerations(&mut system, &state, equations, saddle)?;
        system.refresh(&state);
        let energy = system.energy(&state, &first.lambda);
        let jerk = initial::jerk(
            &mut system,
            &mut state,
            &mut first.acceleration,
            step_s,
            equations,
            saddle,
        )?;
        let mut now = Point {
            algorithmic: first.acceleration.clone(),
            acceleration: first.acceleration,
            lambda: first.lambda,
            jerk,
            state,
            clock_rest_s: 0.0,
        };
        let work_rate_w = system.work_rate_w(
            &now.state,
            &now.acceleration,
            &now.lambda,
            &integrator.masses,
        );
        integrator.retune(&mut system, &mut now, 0.0, step_s)?;
        Ok(Self {
            other: now.clone(),
            info: RunInfo {
                step_range_s: (f64::INFINITY, 0.0),
                energy: EnergyBalance::begin(energy, work_rate_w),
                ..RunInfo::default()
            },
            system,
            params,
            integrator,
            now,
            step_s,
            steps_alike: 0,
        })
    }

    /// State now. In directions that joints prescribe the velocity is that of the scheme, exact to the second order in
    /// the step.
    #[must_use]
    pub fn state(&self) -> &State {
        &self.now.state
    }

    /// v̇ now.
    #[must_use]
    pub fn acceleration(&self) -> &[f64] {
        &self.now.acceleration
    }

    /// Reactions λ now, one for each joint equation.
    #[must_use]
    pub fn lambda(&self) -> &[f64] {
        &self.now.lambda
    }

    /// Records so far.
    #[must_use]
    pub fn info(&self) -> &RunInfo {
        &self.info
    }

    /// The system.
    #[must_use]
    pub fn system(&self) -> &System {
        &self.system
    }

    /// Gives the system back.
    #[must_use]
    pub fn into_system(self) -> System {
        self.system
    }

    /// Steps until `end_s` is reached or `visit` breaks. The last step may go past the end: interpolate.
    ///
    /// # Errors
    /// As [`Self::step`].
    pub fn run(
        &mut self,
        end_s: f64,
        mut visit: impl FnMut(&mut Accepted<'_>) -> ControlFlow<()>,
    ) -> Result<(), DynamicsError> {
        while self.now.state.time_s < end_s - 1e-6 * self.step_s {
            self.step()?;
            let mut step = Accepted {
                from: &self.other.state,
                to: &self.now.state,
                lambda_from: &self.other.lambda,
                lambda: &self.now.lambda,
                acceleration_from: &self.other.acceleration,
                acceleration: &self.now.acceleration,
                info: &self.info,
                system: &mut self.system,
            };
            if visit(&mut step).is_break() {
                break;
            }
        }
        Ok(())
    }

    /// Makes one step that is accepted, after as many shorter trials as the step control allows.
    ///
    /// # Errors
    /// [`DynamicsError::StepTooLarge`] or [`DynamicsError::StepSingular`] with advice,
    /// [`DynamicsError::Contradiction`] if a redundant joint equation no longer holds, [`DynamicsError::Singular`], or
    /// the error of an element.
    pub fn step(&mut self) -> Result<(), DynamicsError> {
        loop {
            let h = self.step_s;
            let mut outcome = self.integrator.attempt(
                &mut self.system,
                &self.now,
                &mut self.other,
                h,
                &self.params,
            );
            if matches!(&outcome, Err(failure) if failure.is_of_the_way()) && self.is_shortest(h) {
                outcome = self.integrator.attempt_damped(
                    &mut self.system,
                    &self.now,
                    &mut self.other,
                    h,
                    &self.params,
                );
            }
            self.count_effort();
            let limits = match (self.params.step, outcome) {
                (StepControl::Fixed { step_s }, Ok(())) => {
                    let again = h < step_s && self.steps_alike + 1 >= PARTS;
                    let next = if again { PARTS as f64 * h } else { h };
                    return self.accept(h, next);
                }
                (StepControl::Fixed { step_s }, Err(failure)) if failure.is_of_the_way() => {
                    self.info.unconverged += 1;
                    let part = h / PARTS as f64;
                    let leeway = failure.leeway();
                    let often = self.info.steps + leeway < RARE * self.info.unconverged;
                    if part < LEAST_PART * step_s || often {
                        return Err(self.refusal(failure, FIXED_ADVICE));
                    }
                    self.change_step(part)?;
                    continue;
                }
                (StepControl::Fixed { .. }, Err(failure)) => {
                    return Err(self.refusal(failure, FIXED_ADVICE));
                }
                (StepControl::Adaptive(_), Err(failure)) => {
                    self.info.unconverged += 1;
                    if self.is_shortest(h) {
                        return Err(self.refusal(failure, ADAPTIVE_ADVICE));
                    }
                    self.change_step(0.25 * h)?;
                    continue;
                }
                (StepControl::Adaptive(limits), Ok(())) => limits,
            };
            let error = self.error_ratio(h, &limits);
            let factor = 0.9 / error.cbrt();
            if error > 1.0 {
                self.info.rejected += 1;
                let shorter = h * factor.clamp(0.2, 0.8);
                if shorter < limits.least_step_s {
                    return Err(
                        self.refusal(StepFailure::no_convergence(0, error, 0), TOLERANCE_ADVICE)
                    );
                }
                self.change_step(shorter)?;
                continue;
            }
            let grows = factor > GROWTH && self.steps_alike >= SETTLED;
            let next = if grows {
                (GROWTH * h).min(limits.largest_step_s)
            } else {
                h
            };
            return self.accept(h, next);
        }
    }

    /// Whether no shorter step may be tried.
    fn is_shortest(&self, step_s: f64) -> bool {
        match self.params.step {
            StepControl::Fixed { .. } => true,
            StepControl::Adaptive(limits) => 0.25 * step_s < limits.least_step_s,
        }
    }

    fn count_effort(&mut self) {
        let effort = std::mem::take(&mut self.integrator.effort);
        self.info.iterations += effort.iterations;
        self.info.factorisations += effort.factorisations;
        self.info.evaluations += effort.evaluations;
        self.info.pivotings += effort.pivotings;
    }

    fn accept(&mut self, h: f64, next_step_s: f64) -> Result<(), DynamicsError> {
        let equations = &self.integrator.equations;
        let most = |values: &[f64]| values.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        self.info.largest_violation = self.info.largest_violation.max(most(&equations.violation));
        self.info.largest_violation_rate = self
            .info
            .largest_violation_rate
            .max(most(&equations.violation_rate));
        watch_dropped(&mut self.system, &self.other.state, &equations.violation)?;
        std::mem::swap(&mut self.now, &mut self.other);
        self.system.commit(&self.now.state)?;
        let energy = self.system.energy(&self.now.state, &self.now.lambda);
        let masses = &self.integrator.masses;
        let Point {
            state,
            acceleration,
            lambda,
            ..
        } = &self.now;
        let work_rate_w = self.system.work_rate_w(state, acceleration, lambda, masses);
        self.info.energy.advance(energy, work_rate_w, h);
        self.info.steps += 1;
        self.steps_alike += 1;
        let (least, largest) = self.info.step_range_s;
        self.info.step_range_s = (least.min(h), largest.max(h));
        if next_step_s.to_bits() != h.to_bits() {
            self.change_step(next_step_s)?;
        }
        Ok(())
    }

    fn change_step(&mut self, step_s: f64) -> Result<(), DynamicsError> {
        self.integrator
            .retune(&mut self.system, &mut self.now, self.step_s, step_s)?;
        self.step_s = step_s;
        self.steps_alike = 0;
        Ok(())
    }

    /// Estimated error of the step just tried over its tolerance.
    fn error_ratio(&self, h: f64, limits: &AdaptiveStep) -> f64 {
        let tolerance: [f64; KINDS] = [
            limits.translation_tolerance_m,
            limits.rotation_tolerance_rad,
            limits.modal_tolerance,
            limits.rotation_tolerance_rad,
        ];
        let weight = self.integrator.scheme.error_constant.abs() * h * h;
        let pairs = self.other.acceleration.iter().zip(&self.now.acceleration);
        let ratios = pairs
            .zip(&self.integrator.convergence.kinds)
            .zip(&self.integrator.error_scale)
            .map(|(((new, old), &kind), scale)| {
                weight * (new - old).abs() * scale / tolerance[kind]
            });
        // The floor keeps the growth of the step finite where nothing accelerates.
        ratios.fold(1e-9, f64::max)
    }

    fn refusal(&mut self, failure: StepFailure, advice: &'static str) -> DynamicsError {
        let time_s = self.now.state.time_s;
        match failure {
            StepFailure::Element(error) => error,
            StepFailure::Singular
                if self
                    .integrator
                    .joints_are_regular(&mut self.system, &self.now) =>
            {
                DynamicsError::StepSingular {
                    time_s,
                    step_s: self.step_s,
                    advice,
                }
            }
            StepFailure::Singular => DynamicsError::singular("the iteration matrix", time_s),
            StepFailure::NoConvergence {
                iterations,
                ratio,
                largest,
            } => DynamicsError::StepTooLarge {
                time_s,
                step_s: self.step_s,
                iterations,
                ratio,
                largest: self.system.describe(largest),
                advice,
            },
        }
    }
}

/// A fixed step at which no solution is found is made in so many parts, and each of those again, down to this share.
/// After as many steps of one length the step is that many times longer again.
const PARTS: u64 = 4;
const LEAST_PART: f64 = 1.0 / 256.0;

/// A step that has more often no solution than once in so many is too long.
const RARE: u64 = 20;

/// An adaptive step grows by this factor at once, where it could grow by more: a change costs a factorisation and
/// stirs the reactions.
const GROWTH: f64 = 1.5;

/// Steps of one length before it grows: what a change has stirred must die out first, or it would be taken for an
/// error.
const SETTLED: u64 = 4;

const FIXED_ADVICE: &str = "the fixed step is too large for the stiffest force or the fastest rotation: take a tenth of it, or an adaptive step";
const ADAPTIVE_ADVICE: &str = "the shortest step allowed does not converge either: look for a force that jumps with position or speed, or allow shorter steps";
const TOLERANCE_ADVICE: &str =
    "the shortest step allowed exceeds the tolerance: loosen the tolerance, or allow shorter steps";
