//! Static equilibrium: the motion in which nothing accelerates, by Newton's method along a path of loads or of time.
//!
//! ```text
//! [∂residual/∂q   Bᵀ] [δ ]      [residual ]
//! [B              0 ] [δλ] = −  [violation]           v̇ = 0, v as given
//! ```
//!
//! Each correction is the smallest that solves this (singular value decomposition of the scaled matrix). Directions
//! that nothing resists are thereby held and reported by name, or refused. A load along such a direction moves the
//! system along it for some iterations, because resistance may come with the position; if none comes it is an error. It
//! moves a little at first and further each time: surfaces that just touch have to be met within their deflection, a
//! pendulum released level has a long way to go.

use std::sync::Arc;

use crate::elements::Iterate;
use crate::equations::{Detail, Equations};
use crate::error::DynamicsError;
use crate::relaxation::relax;
use crate::saddle::SaddleForm;
use crate::state::State;
use crate::static_correction::{Correction, correct, form_of};
use crate::static_steps::{SHORT, Walk, in_masses, measure, moments_in_world, standing};
use crate::system::System;
use crate::unbalanced::{most_unbalanced, pushing};

/// Load along a free direction, as a share of all that pushes along it, that counts as balanced.
const BALANCED: f64 = 1e-9;

/// Share of all that pushes on a degree of freedom that may be left over where corrections do not become small:
/// rounding, over a stiffness that is hardly there.
const AT_REST: f64 = 1e-12;

/// Longest correction of one iteration: radians, and shares of the system's size.
const LONGEST: f64 = 0.2;

/// First move along a free direction, largest entry in m or rad, and the factor by which the next one is longer while
/// none resists.
const FIRST_PUSH: f64 = 1e-6;
const PUSH_GROWTH: f64 = 2.0;

/// Where the unbalanced force becomes this many times larger along a correction, something stiff is in the way (teeth,
/// stops): the correction ends before it. Looked for at ever doubled distances, from [`SHORT`] on, and where it is
/// nearer from the first push on.
const RUN_INTO: f64 = 4.0;

/// Share of all that pushes with which this comparison is made at least: next to an equilibrium any move makes the
/// little that is unbalanced many times larger.
const COMPARED: f64 = 0.1;

/// Shortest step along the path to an equilibrium, over the longest.
const LEAST_STRIDE: f64 = 1.0 / 256.0;

/// What to do about motions that nothing resists.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FreeMotions {
    /// Hold them where they are; they are listed in the result.
    Hold,
    /// Refuse them.
    Refuse,
}

/// Parameters of [`equilibrium`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StaticParams {
    /// Longest steps in which applied loads and weights are brought up, or time goes on: so many; shorter ones are made
    /// where they are needed. Default 1.
    pub load_steps: usize,
    /// Iterations in each. Default 100.
    pub most_iterations: usize,
    /// Largest correction at the end: radians, and share of the system's size. Default 1e-12.
    pub tolerance: f64,
    /// Motions that nothing resists. Default: hold.
    pub free_motions: FreeMotions,
}

impl Default for StaticParams {
    fn default() -> Self {
        Self {
            load_steps: 1,
            most_iterations: 100,
            tolerance: 1e-12,
            free_motions: FreeMotions::Hold,
        }
    }
}

/// A static equilibrium.
#[derive(Debug, Clone, PartialEq)]
pub struct Equilibrium {
    /// Places in equilibrium; velocities as given.
    pub state: State,
    /// Reactions λ, one for each joint equation.
    pub lambda: Vec<f64>,
    /// Iterations of all steps, those that were given up included.
    pub iterations: usize,
    /// Motions that nothing resists, held.
    pub held: Vec<String>,
}

/// Finds the static equilibrium near a state. Loads are brought up in fewer or more steps, as they are needed.
///
/// # Errors
/// [`DynamicsError::NoEquilibrium`], [`DynamicsError::Unbalanced`], [`DynamicsError::LeftOnTheWay`],
/// [`DynamicsError::Singular`] or the error of an element.
pub fn equilibrium(
    system: &mut System,
    start: &State,
    params: &StaticParams,
) -> Result<Equilibrium, DynamicsError> {
    system.begin(start);
    // Reactions at release, so that the stiffness of tensioned joints is there from the first iteration.
    let lambda = system.accelerations(start)?.lambda;
    follow(system, (start, lambda), Path::Loads, params)
}

/// The equilibrium at another time, from an earlier one: joints and elements go on from the motion that they were last
/// committed to, in as many steps of time as are needed. For a series of equilibria in which turns are counted and
/// couplings hold.
///
/// # Errors
/// As [`equilibrium`].
pub fn next_equilibrium(
    system: &mut System,
    from: &Equilibrium,
    time_s: f64,
    params: &StaticParams,
) -> Result<Equilibrium, DynamicsError> {
    let start = (&from.state, from.lambda.clone());
    follow(system, start, Path::Time(time_s), params)
}

/// What is brought up on the way to an equilibrium.
#[derive(Clone, Copy)]
enum Path {
    /// Applied loads and weights from nothing.
    Loads,
    /// Time from that of the start: motions and loads that are functions of it.
    Time(f64),
}

/// Goes along a path in steps that become shorter where no equilibrium is found and longer again where one is.
fn follow(
    system: &mut System,
    (from, lambda): (&State, Vec<f64>),
    path: Path,
    params: &StaticParams,
) -> Result<Equilibrium, DynamicsError> {
    let (mut equations, form) = (Equations::new(system), form_of(system));
    let mut start = from.clone();
    // Nothing inside an element moves at rest.
    start.velocity[system.layout.first_unknown()..].fill(0.0);
    let mut found = Equilibrium {
        state: start,
        lambda,
        iterations: 0,
        held: Vec::new(),
    };
    let whole = 1.0 / params.load_steps.max(1) as f64;
    let (mut done, mut stride) = (0.0, whole);
    let mut relaxes = true;
    while done < 1.0 {
        // Sums of strides are 1 but for rounding.
        let target = if done + stride > 1.0 - 1e-9 {
            1.0
        } else {
            done + stride
        };
        let mut trial = found.clone();
        let load_factor = match path {
            Path::Loads => target,
            Path::Time(time_s) => {
                trial.state.time_s = from.time_s + target * (time_s - from.time_s);
                1.0
            }
        };
        let start = trial.clone();
        let work = (&mut equations, &form);
        let mut settled = settle(system, &mut trial, load_factor, params, work);
        if relaxes && matches!(settled, Err(DynamicsError::NoEquilibrium { .. })) {
            // Newton's method goes to and fro where contacts come and go: down the forces first, then once more.
            let iterations = trial.iterations;
            trial = Equilibrium {
                iterations,
                ..start
            };
            let moved = (&mut trial.state, &mut trial.lambda);
            if let Ok(steps) = relax(system, moved, load_factor, (&mut equations, &form)) {
                trial.iterations += steps;
                let work = (&mut equations, &form);
                settled = settle(system, &mut trial, load_factor, params, work);
            }
            // Where it does not help, shorter steps may: not both, each time.
            relaxes = settled.is_ok();
        }
        match settled {
            Ok(()) => {
                system.commit(&trial.state)?;
                found = trial;
                done = target;
                stride = (2.0 * stride).min(whole);
            }
            Err(error) if stride > LEAST_STRIDE * whole && path.may_help(&error) => {
                // What the trial took counts, too.
                found.iterations = trial.iterations;
                stride *= 0.25;
            }
            Err(error) => return Err(error),
        }
    }
    Ok(found)
}

impl Path {
    /// Whether shorter steps may find what a longer one did not. A motion that nothing resists is none the more
    /// resisted under a part of the loads, but contact may be lost on the way to another position.
    fn may_help(self, error: &DynamicsError) -> bool {
        match error {
            DynamicsError::NoEquilibrium { .. }
            | DynamicsError::LeftOnTheWay { .. }
            | DynamicsError::Element { .. } => true,
            DynamicsError::Unbalanced { .. } => matches!(self, Self::Time(_)),
            _ => false,
        }
    }
}

/// The failure of an element after a correction that was largest at the degree of freedom `moved`; at the start the
/// error itself.
fn on_the_way(
    error: DynamicsError,
    system: &System,
    load_factor: f64,
    moved: Option<usize>,
) -> DynamicsError {
    match (error, moved) {
        (
            DynamicsError::Element {
                element, source, ..
            },
            Some(largest),
        ) => DynamicsError::LeftOnTheWay {
            load_factor,
            moved: system.describe(largest),
            element,
            source,
        },
        (error, _) => error,
    }
}

/// Newton's method at one share of the loads, from the motion and reactions that `found` has to those in equilibrium.
fn settle(
    system: &mut System,
    found: &mut Equilibrium,
    load_factor: f64,
    params: &StaticParams,
    (equations, form): (&mut Equations, &Arc<SaddleForm>),
) -> Result<(), DynamicsError> {
    let n = system.degrees_of_freedom();
    let rest = vec![0.0; n];
    let size = system.size_m();
    let Equilibrium {
        state,
        lambda,
        iterations,
        held,
    } = found;
    let mut push = FIRST_PUSH;
    let mut pushed = false;
    let mut moved = None;
    for iteration in 1..=params.most_iterations.max(1) {
        *iterations += 1;
        // From the second iteration on elements were asked nearby.
        let iterate = moved.map_or(Iterate::Single, |_| Iterate::Correction);
        let at = standing(state, &rest, lambda, (load_factor, iterate));
        let evaluated = system.evaluate(at, Detail::Tangents, equations);
        evaluated.map_err(|error| on_the_way(error, system, load_factor, moved))?;
        if pushed {
            // Along a free motion bodies may go where no element can follow them.
            system.admits(state)?;
        }
        let pushing = pushing(system, equations, lambda);
        let at_rest = balances(system, equations, &pushing, params.tolerance * size);
        moments_in_world(system, equations);
        let mut correction = correct(system, (equations, form), &pushing)?;
        let last = iteration >= params.most_iterations;
        let refuses = params.free_motions == FreeMotions::Refuse;
        pushed = push_on(system, &mut correction, &mut push, (refuses, last))?;
        let (ratio, largest) = measure(system, &correction.values[..n], size);
        moved = Some(largest);
        let settled = !pushed && (at_rest || ratio <= params.tolerance);
        if last && !settled || !ratio.is_finite() {
            return Err(DynamicsError::NoEquilibrium {
                iterations: iteration,
                load_factor,
                ratio: ratio / params.tolerance,
                largest: system.describe(largest),
                unbalanced: most_unbalanced(system, equations, lambda),
            });
        }
        if settled {
            let free = correction.free.iter();
            *held = free.map(|motion| in_words(system, motion)).collect();
            if at_rest {
                return Ok(());
            }
        }
        let pushed_by = in_masses(system, &pushing);
        let moved_by = (&correction.values[..], ratio);
        walk_on(
            system,
            (state, lambda),
            load_factor,
            moved_by,
            (equations, pushed_by),
        );
        if settled {
            return Ok(());
        }
    }
    Ok(())
}

/// Lets a correction go further along the free motion that is loaded most, if one is loaded; returns whether one is. A
/// free motion is an error where they are refused, a loaded one in the last iteration.
fn push_on(
    system: &System,
    correction: &mut Correction,
    push: &mut f64,
    (refuses, last): (bool, bool),
) -> Result<bool, DynamicsError> {
    let share = &correction.share;
    let unbalanced = (0..correction.free.len())
        .filter(|&k| share[k] > BALANCED)
        .max_by(|&a, &b| share[a].total_cmp(&share[b]));
    if refuses && !correction.free.is_empty() {
        return Err(unbalanced_error(
            system,
            correction,
            unbalanced.unwrap_or(0),
        ));
    }
    let Some(k) = unbalanced else {
        return Ok(false);
    };
    if last {
        return Err(unbalanced_error(system, correction, k));
    }
    let signed = -*push * correction.load[k].signum();
    for (value, free) in correction.values.iter_mut().zip(&correction.free[k]) {
        *value += signed * free;
    }
    *push = (PUSH_GROWTH * *push).min(0.5 * LONGEST);
    Ok(true)
}

/// Goes along a correction, whose largest entry is `ratio`, as far as nothing stiff is in the way.
fn walk_on(
    system: &mut System,
    (state, lambda): (&mut State, &mut Vec<f64>),
    load_factor: f64,
    (correction, ratio): (&[f64], f64),
    (equations, pushed_by): (&mut Equations, f64),
) {
    let rest = vec![0.0; system.degrees_of_freedom()];
    let unbalanced = in_masses(system, &equations.residual);
    let walk = Walk {
        from: state.clone(),
        lambda_from: lambda.clone(),
        correction,
        most_force: RUN_INTO * unbalanced.max(COMPARED * pushed_by),
    };
    let whole = (LONGEST / ratio).min(1.0);
    let mut is_clear = |share: f64| {
        walk.to(share, system, state, lambda);
        let at = standing(state, &rest, lambda, (load_factor, Iterate::Single));
        walk.is_clear(at, system, equations)
    };
    let first = |length: f64| whole.min(length / ratio);
    let mut share = first(FIRST_PUSH);
    if share < whole && is_clear(first(SHORT)) {
        share = first(SHORT);
    }
    while share < whole && is_clear(whole.min(2.0 * share)) {
        share = whole.min(2.0 * share);
    }
    walk.to(share, system, state, lambda);
}

/// Whether forces balance to rounding everywhere and joints hold.
fn balances(system: &System, equations: &Equations, pushing: &[f64], holds: f64) -> bool {
    let mut forces = equations.residual.iter().zip(pushing);
    let mut kept = system.kept.iter();
    forces.all(|(left, all)| left.abs() <= AT_REST * all)
        && kept.all(|&equation| equations.violation[equation].abs() <= holds)
}

fn in_words(system: &System, motion: &[f64]) -> String {
    let parts = motion.iter().enumerate().filter(|(_, x)| x.abs() > 0.1);
    let words: Vec<String> = parts.map(|(dof, _)| system.describe(dof)).collect();
    words.join(" with ")
}

fn unbalanced_error(system: &System, correction: &Correction, k: usize) -> DynamicsError {
    DynamicsError::Unbalanced {
        motion: in_words(system, &correction.free[k]),
        load: correction.load[k].abs(),
    }
}
