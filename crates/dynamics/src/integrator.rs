//! One step of the Lie-group generalized-alpha scheme for index 3.
//!
//! Unknowns are the increment Δq and the reactions λ at the end of the step; a_{n+1}, v_{n+1} and v̇_{n+1} follow from
//! Δq by the scheme. Newton's matrix, with T the derivative of the exponential (rotation.rs), multiplied by βh²:
//!
//! ```text
//! [μ M + γh C + βh² K T   Bᵀ] [δΔq    ]      [βh² residual]
//! [B T                    0 ] [βh² δλ ]  = − [violation   ]        μ = (1 − α_m)/(1 − α_f)
//! ```
//!
//! The factors are kept from step to step, what a step's own corrections tell about their error is used within it
//! (`secants.rs`), and they are made anew, at the present iterate, when the step length has changed or corrections
//! shrink too slowly. In small systems, where factors cost less than an evaluation, they are made anew at the start of
//! every step for a while once a step by old ones has taken many corrections. Corrections by factors of the step itself
//! that grow go astray: they might end at another solution, far from where the step began. The iteration is then given
//! up; a damped one takes its place (`damped_newton.rs`), or a shorter step.
//!
//! Sources: O. Brüls, A. Cardona, M. Arnold, Mech. Mach. Theory 48 (2012) 121-137, table 1; growing corrections: A. C.
//! Hindmarsh et al., SUNDIALS, ACM Trans. Math. Softw. 31 (2005) 363-396, whose CVODE gives up at the same factor.

use std::sync::Arc;

use nalgebra::{Matrix3, Vector3};

use crate::convergence::{Convergence, Measured, Progress};
use crate::elements::Iterate;
use crate::equations::{At, Detail, Equations};
use crate::error::DynamicsError;
use crate::joint::Joint;
use crate::kept_iterate::KeptIterate;
use crate::matrix::Matrix;
use crate::rotation;
use crate::saddle::{Saddle, SaddleForm};
use crate::scheme::{LinearSolver, Params, Scheme};
use crate::secants::Secants;
use crate::state::State;
use crate::step_failure::StepFailure;
use crate::system::System;
use crate::unknown::UnknownKind;

/// Corrections must shrink by this factor from one iteration to the next, or the matrix is made anew.
const SLOW: f64 = 0.2;

/// Corrections that grow by this factor from one to the next, both by factors of this step, go astray.
const ASTRAY: f64 = 2.0;

/// So many corrections by old factors are many: new ones take two or three.
const MANY: usize = 5;

/// So many steps then begin with new factors, before old ones are tried again.
const FRESH_STEPS: u64 = 32;

/// Unknowns up to which a system is small. An evaluation by elements worth speaking of, such as a contact of elastic
/// bodies, takes longer than factors of as many.
const SMALL: usize = 60;

/// Where corrections no longer shrink, they are accepted up to this multiple of the floor of rounding.
pub(crate) const STALLED: f64 = 100.0;

/// All that the scheme carries from step to step.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Point {
    pub state: State,
    /// v̇
    pub acceleration: Vec<f64>,
    /// a, the scheme's own variable.
    pub algorithmic: Vec<f64>,
    /// v̈, by differences.
    pub jerk: Vec<f64>,
    pub lambda: Vec<f64>,
    /// What rounding has left out of the time so far \[s\], by which the next step is longer (W. Kahan, Commun. ACM 8
    /// (1965) 40): after 10⁷ steps of 10 µs a plain sum is off by 20 ns.
    pub clock_rest_s: f64,
}

/// What a step needed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Effort {
    pub iterations: u64,
    pub factorisations: u64,
    pub evaluations: u64,
    pub pivotings: u64,
}

/// Scheme, work space and factors.
pub(crate) struct Integrator {
    pub scheme: Scheme,
    pub equations: Equations,
    pub saddle: Saddle,
    /// Step length that the factors are for; not a number before the first.
    pub factored_step_s: f64,
    /// Steps to come that begin with new factors.
    pub fresh_steps: u64,
    /// For the changes of step length, on the mass matrix itself.
    projector: Saddle,
    pub convergence: Convergence,
    /// Masses of all degrees of freedom, zero where an equation has none.
    pub masses: Vec<f64>,
    /// What an error is multiplied by before it is compared with the tolerance of its kind.
    pub error_scale: Vec<f64>,
    matrix: Matrix,
    turned: Matrix,
    /// T of every body.
    turns: Vec<Matrix3<f64>>,
    pub increment: Vec<f64>,
    pub delta: Vec<f64>,
    pub mu: Vec<f64>,
    right: Vec<f64>,
    right_joints: Vec<f64>,
    secants: Secants,
    pub kept: KeptIterate,
    pub effort: Effort,
}

impl Integrator {
    pub(crate) fn new(system: &System, scheme: Scheme, solver: LinearSolver) -> Self {
        let (n, m) = (system.degrees_of_freedom(), system.equations());
        let diagonal = system.mass_diagonal();
        let form = Arc::new(SaddleForm::new(&system.structure, &system.kept, solver));
        Self {
            scheme,
            equations: Equations::new(system),
            saddle: Saddle::new(&diagonal, system.layout.massless(), &form),
            factored_step_s: f64::NAN,
            fresh_steps: 0,
            projector: Saddle::new(&diagonal, system.layout.massless(), &form),
            convergence: Convergence::new(system, &scheme),
            masses: system.masses(),
            error_scale: (0..n).map(|dof| error_scale(system, dof)).collect(),
            matrix: Matrix::zeros(&system.structure.square),
            turned: Matrix::zeros(&system.structure.gradient),
            turns: vec![Matrix3::identity(); system.bodies.len()],
            increment: vec![0.0; n],
            delta: vec![0.0; n],
            mu: vec![0.0; m],
            right: vec![0.0; n],
            right_joints: vec![0.0; m],
            secants: Secants::new(&system.masses(), m),
            kept: KeptIterate::new(n, m),
            effort: Effort::default(),
        }
    }

    /// Work space of the equations and the projector, for the start of a run.
    pub(crate) fn for_start(&mut self) -> (&mut Equations, &mut Saddle) {
        (&mut self.equations, &mut self.projector)
    }

    /// Tries a step from one point to another, whose content is overwritten.
    pub(crate) fn attempt(
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
        let begins_fresh = self.fresh_steps > 0;
        let mut stale = begins_fresh || self.factored_step_s.to_bits() != h.to_bits();
        let (mut last, mut last_above_floor, mut place) = (f64::INFINITY, f64::INFINITY, 0);
        // Corrections by factors of this step, one after the other.
        let mut own_corrections = 0;
        self.secants.reset();
        for iteration in 1..=params.most_iterations {
            self.effort.iterations += 1;
            let iterate = match iteration {
                1 => Iterate::First,
                _ => Iterate::Correction,
            };
            let detail = match stale {
                true => Detail::Tangents,
                false => Detail::Forces,
            };
            self.evaluate(system, to, (detail, iterate))
                .map_err(StepFailure::Element)?;
            if stale {
                if !self.factor(system, h) {
                    // Singular at an iterate that has strayed is the step's fault, not the system's.
                    return Err(match iteration {
                        1 => StepFailure::Singular,
                        _ => StepFailure::no_convergence(iteration, last, place),
                    });
                }
                self.secants.reset();
                stale = false;
                own_corrections = 1;
            } else if own_corrections > 0 {
                own_corrections += 1;
            }
            self.correct(square);
            self.secants.improve(&mut self.delta, &mut self.mu);
            self.apply(system, from, to, h);
            let Measured {
                ratio,
                largest,
                above_floor,
            } = self.measure(system, from, to, h, params.newton_tolerance);
            if !ratio.is_finite() {
                self.factored_step_s = f64::NAN;
                return Err(StepFailure::no_convergence(iteration, ratio, largest));
            }
            let shrinks = above_floor < SLOW * last_above_floor;
            // What the corrections to come would add, if they shrink on as they do: ratio · (θ + θ² + …).
            let theta = (above_floor / last_above_floor).min(0.5);
            let rest = match iteration {
                1 => ratio,
                _ => ratio * (theta / (1.0 - theta)),
            };
            if rest <= 1.0 || (!shrinks && above_floor <= STALLED) {
                self.pace(begins_fresh, iteration);
                self.finish(from, to, h);
                return Ok(());
            }
            if !shrinks && iteration > 1 {
                stale = true;
            }
            let strays = own_corrections > 1 && above_floor > ASTRAY * last_above_floor;
            (last, last_above_floor, place) = (ratio, above_floor, largest);
            if strays || iteration == params.most_iterations {
                self.factored_step_s = f64::NAN;
                return Err(StepFailure::no_convergence(iteration, ratio, largest));
            }
        }
        Err(StepFailure::Singular)
    }

    /// Says how many steps to come begin with new factors, after one that did or did not and took so many corrections.
    /// Where new factors take as many, they are no help.
    fn pace(&mut self, began_fresh: bool, corrections: usize) {
        let is_small = self.delta.len() + self.mu.len() <= SMALL;
        self.fresh_steps = match (began_fresh, corrections >= MANY) {
            (true, false) => self.fresh_steps - 1,
            (false, true) if is_small => FRESH_STEPS,
            _ => 0,
        };
    }

    /// First guess of a step, and what corrections are measured against.
    pub(crate) fn begin(&mut self, system: &System, from: &Point, to: &mut Point, h: f64) {
        self.predict(system, from, to, h);
        let angles = system.joints.iter().map(Joint::largest_angle_rad);
        self.convergence.begin(angles.fold(0.0, f64::max));
    }

    /// Newton's correction at the evaluated iterate, by the factors at hand.
    pub(crate) fn correct(&mut self, square: f64) {
        for (right, residual) in self.right.iter_mut().zip(&self.equations.residual) {
            *right = -square * residual;
        }
        for (right, violation) in self.right_joints.iter_mut().zip(&self.equations.violation) {
            *right = -violation;
        }
        self.saddle.solve(
            &self.right,
            &self.right_joints,
            &mut self.delta,
            &mut self.mu,
        );
    }

    /// Adds the correction at hand to the iterate.
    pub(crate) fn apply(&mut self, system: &System, from: &Point, to: &mut Point, h: f64) {
        let scheme = self.scheme;
        let square = scheme.beta * h * h;
        for (i, delta) in self.delta.iter().enumerate() {
            self.increment[i] += delta;
            to.state.velocity[i] += scheme.gamma / (h * scheme.beta) * delta;
            to.acceleration[i] += scheme.mass_factor() / square * delta;
        }
        for (lambda, mu) in to.lambda.iter_mut().zip(&self.mu) {
            *lambda += mu / square;
        }
        to.state
            .set_moved(&from.state, &self.increment, &system.layout);
    }

    /// First guess: v̇ and λ stay.
    fn predict(&mut self, system: &System, from: &Point, to: &mut Point, h: f64) {
        let s = self.scheme;
        to.lambda.copy_from_slice(&from.lambda);
        to.acceleration.copy_from_slice(&from.acceleration);
        for i in 0..self.increment.len() {
            let old = from.algorithmic[i];
            let new = (from.acceleration[i] - s.alpha_m * old) / (1.0 - s.alpha_m);
            let velocity = from.state.velocity[i];
            self.increment[i] = h * velocity + h * h * ((0.5 - s.beta) * old + s.beta * new);
            to.state.velocity[i] = velocity + h * ((1.0 - s.gamma) * old + s.gamma * new);
        }
        to.state
            .set_moved(&from.state, &self.increment, &system.layout);
        let passed_s = h + from.clock_rest_s;
        to.state.time_s = from.state.time_s + passed_s;
        to.clock_rest_s = passed_s - (to.state.time_s - from.state.time_s);
    }

    pub(crate) fn evaluate(
        &mut self,
        system: &mut System,
        to: &Point,
        (detail, iterate): (Detail, Iterate),
    ) -> Result<(), DynamicsError> {
        self.effort.evaluations += 1;
        let at = At {
            state: &to.state,
            acceleration: &to.acceleration,
            lambda: &to.lambda,
            load_factor: 1.0,
            iterate,
        };
        system.evaluate(at, detail, &mut self.equations)
    }

    /// Assembles and factorises Newton's matrix at the present iterate; `false` if it is singular.
    pub(crate) fn factor(&mut self, system: &System, h: f64) -> bool {
        let (s, equations) = (self.scheme, &mut self.equations);
        self.turned.copy_from(&equations.gradient);
        for (start, t) in system.layout.starts().zip(&mut self.turns) {
            let turn = start + 3;
            let psi = Vector3::from_column_slice(&self.increment[turn..turn + 3]);
            *t = rotation::tangent(&psi);
            equations.stiffness.turn_columns(turn, t);
        }
        let turns = &self.turns;
        self.turned
            .turn_bodies(|start| turns[system.layout.locate(start).0]);
        let factors = [s.mass_factor(), s.gamma * h, s.beta * h * h];
        self.matrix.set_combination(
            factors,
            [&equations.mass, &equations.damping, &equations.stiffness],
        );
        self.effort.factorisations += 1;
        let before = self.saddle.pivotings();
        let regular = self
            .saddle
            .factor(&self.matrix, &equations.gradient, &self.turned);
        self.effort.pivotings += self.saddle.pivotings() - before;
        self.factored_step_s = if regular { h } else { f64::NAN };
        regular
    }

    /// The latest correction against what it may be.
    pub(crate) fn measure(
        &mut self,
        system: &System,
        from: &Point,
        to: &Point,
        step_s: f64,
        stated: Option<f64>,
    ) -> Measured {
        let step = Progress {
            step_s,
            stated,
            velocity: &from.state.velocity,
            acceleration: &from.acceleration,
            jerk: &from.jerk,
            new_acceleration: &to.acceleration,
            increment: &self.increment,
            delta: &self.delta,
            mu: &self.mu,
            gradient: &self.equations.gradient,
        };
        self.convergence.measure(&system.kept, &step)
    }

    pub(crate) fn finish(&self, from: &Point, to: &mut Point, h: f64) {
        let s = self.scheme;
        for i in 0..to.algorithmic.len() {
            to.algorithmic[i] = ((1.0 - s.alpha_f) * to.acceleration[i]
                + s.alpha_f * from.acceleration[i]
                - s.alpha_m * from.algorithmic[i])
                / (1.0 - s.alpha_m);
            to.jerk[i] = (to.acceleration[i] - from.acceleration[i]) / h;
        }
    }

    /// Evaluates masses and joints at a point and factorises [M Bᵀ; B 0] there into the projector; `false` if it is
    /// singular.
    pub(crate) fn joints_are_regular(&mut self, system: &mut System, point: &Point) -> bool {
        let at = At {
            state: &point.state,
            acceleration: &point.acceleration,
            lambda: &point.lambda,
            load_factor: 1.0,
            iterate: Iterate::Single,
        };
        system.evaluate_without_elements(at, Detail::Tangents, &mut self.equations);
        let Equations { mass, gradient, .. } = &mut self.equations;
        system.hold_massless(mass);
        self.projector.factor(mass, gradient, gradient)
    }

    /// Fits a and v to another step length, `old_step_s` = 0 at the start of a run: a stands for v̇ at t + Δh, and v
    /// carries C h² v̈ in the directions that joints prescribe (docs/theory/multibody.md). Without this λ would lose an
    /// order for some steps. Later in a run the part that v carries is read off the joints' rates and scaled, which
    /// does not amplify what noise v̈ has.
    pub(crate) fn retune(
        &mut self,
        system: &mut System,
        point: &mut Point,
        old_step_s: f64,
        step_s: f64,
    ) -> Result<(), DynamicsError> {
        for i in 0..point.algorithmic.len() {
            let offset = if old_step_s > 0.0 {
                (point.algorithmic[i] - point.acceleration[i]) * (step_s / old_step_s)
            } else {
                self.scheme.shift * step_s * point.jerk[i]
            };
            point.algorithmic[i] = point.acceleration[i] + offset;
        }
        if system.kept.is_empty() {
            return Ok(());
        }
        if !self.joints_are_regular(system, point) {
            return Err(DynamicsError::singular(
                "the matrix of the joints",
                point.state.time_s,
            ));
        }
        let equations = &self.equations;
        if old_step_s > 0.0 {
            let share = (step_s / old_step_s).powi(2) - 1.0;
            for (right, rate) in self.right_joints.iter_mut().zip(&equations.violation_rate) {
                *right = share * rate;
            }
        } else {
            let share = self.scheme.error_constant * step_s * step_s;
            for (equation, right) in self.right_joints.iter_mut().enumerate() {
                let row = equations.gradient.entries(equation);
                *right = share * row.map(|(dof, b)| b * point.jerk[dof]).sum::<f64>();
            }
        }
        self.right.fill(0.0);
        self.projector.solve(
            &self.right,
            &self.right_joints,
            &mut self.delta,
            &mut self.mu,
        );
        for (velocity, change) in point.state.velocity.iter_mut().zip(&self.delta) {
            *velocity += change;
        }
        Ok(())
    }
}

/// Coordinates in equilibrium have no error of their own: they follow the others.
fn error_scale(system: &System, dof: usize) -> f64 {
    match system.layout.unknown(dof) {
        None => 1.0,
        Some(unknown) if unknown.kind == UnknownKind::Equilibrium => 0.0,
        Some(unknown) => 1.0 / unknown.scale,
    }
}
