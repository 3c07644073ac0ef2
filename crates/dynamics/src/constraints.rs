//! Joint equations as a whole: places and speeds that fit them, and which of them are redundant.
//!
//! Redundant equations are found in the order of the joints by what is left of each row once its projection on those
//! before it is taken away, in the metric of the mass matrix (`metric.rs`). The order makes the answer repeatable and
//! lets an earlier joint keep its equations, which a QR with free choice of pivots would not. Dropped equations are
//! watched, not solved.

use crate::elements::Iterate;
use crate::equations::{At, Detail, Equations};
use crate::error::DynamicsError;
use crate::metric::{Factors, Metric};
use crate::redundancy::Redundancy;
use crate::state::State;
use crate::system::System;

/// What may be left of a redundant equation (m, rad, or m/s, rad/s): more than any rounding, less than anything that
/// matters.
pub(crate) const CONSISTENT: f64 = 1e-6;

/// What [`analyse`] found.
pub(crate) struct Analysis {
    /// The start, moved onto the joints.
    pub start: State,
    /// Joint equations that are solved; the others follow from them.
    pub kept: Vec<usize>,
    pub redundant: Vec<Redundancy>,
}

/// Mass matrix, gradients and what is left of the equations at a state.
fn evaluate(
    system: &mut System,
    state: &State,
    equations: &mut Equations,
) -> Result<Metric, DynamicsError> {
    let (n, m) = (system.degrees_of_freedom(), system.equations());
    let at = At {
        state,
        acceleration: &vec![0.0; n],
        lambda: &vec![0.0; m],
        load_factor: 1.0,
        iterate: Iterate::Single,
    };
    system.evaluate_without_elements(at, Detail::Tangents, equations);
    Metric::new(equations, system.layout.massive_ranges())
        .ok_or(DynamicsError::singular("the mass matrix", state.time_s))
}

/// Moves the start onto the joints and finds the redundant equations.
pub(crate) fn analyse(system: &mut System) -> Result<Analysis, DynamicsError> {
    let mut state = system.start.clone();
    system.begin_joints(&state);
    let mut equations = Equations::new(system);
    let mut metric = evaluate(system, &state, &mut equations)?;
    let (mut kept, mut factors) = metric.independent();
    for _ in 0..50 {
        let p: Vec<f64> = equations.violation.iter().map(|x| -x).collect();
        if largest(&p, kept.iter().copied()).1 < 1e-14 {
            break;
        }
        let mut motion = metric.least_motion(system.degrees_of_freedom(), (&kept, &factors), &p);
        // Not more than half a radian or, for places, half a metre at a time: far starts come in without overshoot.
        let most = motion.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let share = (0.5 / most).min(1.0);
        motion.iter_mut().for_each(|x| *x *= share);
        let from = state.clone();
        state.set_moved(&from, &motion, &system.layout);
        metric = evaluate(system, &state, &mut equations)?;
        (kept, factors) = metric.independent();
        if most * share < 1e-15 {
            break;
        }
    }
    let (worst, violation) = largest(&equations.violation, 0..system.equations());
    if violation.is_nan() || violation >= CONSISTENT {
        let what = (worst, violation);
        return Err(contradiction(
            system,
            &metric,
            (&kept, &factors),
            what,
            state.time_s,
        ));
    }
    Ok(Analysis {
        redundant: redundancies(system, &metric, (&kept, &factors)),
        kept,
        start: state,
    })
}

fn factors(metric: &Metric, kept: &[usize], state: &State) -> Result<Factors, DynamicsError> {
    let found = metric.factors(kept);
    found.ok_or_else(|| DynamicsError::singular("the matrix of the joints", state.time_s))
}

/// Index and magnitude of the largest entry among `of`; not a number counts as largest.
fn largest(values: &[f64], of: impl Iterator<Item = usize>) -> (usize, f64) {
    of.fold((0, 0.0), |(index, most), i| {
        let here = values[i].abs();
        if here > most || here.is_nan() {
            (i, here)
        } else {
            (index, most)
        }
    })
}

fn names(system: &System, equations: &[usize]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for &equation in equations {
        let name = system.joint_of(equation);
        if !names.iter().any(|known| known == name) {
            names.push(name.to_owned());
        }
    }
    names
}

fn contradiction(
    system: &System,
    metric: &Metric,
    (kept, factors): (&[usize], &Factors),
    (worst, violation): (usize, f64),
    time_s: f64,
) -> DynamicsError {
    let mut involved = vec![worst];
    if kept.contains(&worst) {
        // No dependence to read off: the equations that could not be met at all.
        involved.extend(
            kept.iter()
                .filter(|&&other| other != worst && shares(metric, worst, other)),
        );
    } else {
        involved.extend(metric.implying((kept, factors), worst));
    }
    DynamicsError::Contradiction {
        joints: names(system, &involved),
        violation,
        time_s,
    }
}

/// Whether two equations act on common motions.
fn shares(metric: &Metric, a: usize, b: usize) -> bool {
    let length = |row: usize| metric.product(row, row).sqrt();
    metric.product(a, b).abs() > 1e-8 * length(a) * length(b)
}

fn redundancies(
    system: &System,
    metric: &Metric,
    (kept, factors): (&[usize], &Factors),
) -> Vec<Redundancy> {
    let mut found: Vec<Redundancy> = Vec::new();
    for dropped in (0..system.equations()).filter(|i| kept.binary_search(i).is_err()) {
        let joint = system.joint_of(dropped);
        let mut implied_by = names(system, &metric.implying((kept, factors), dropped));
        implied_by.retain(|name| name != joint);
        if let Some(known) = found.iter_mut().find(|known| known.joint == joint) {
            known.equations += 1;
            for name in implied_by {
                if !known.implied_by.contains(&name) {
                    known.implied_by.push(name);
                }
            }
        } else {
            found.push(Redundancy {
                joint: joint.to_owned(),
                equations: 1,
                implied_by,
            });
        }
    }
    found
}

/// Changes the velocities by the least (in the metric of the mass matrix) so that they fit the joints.
pub(crate) fn project_velocity(
    system: &mut System,
    state: &mut State,
) -> Result<(), DynamicsError> {
    if system.equations() == 0 {
        return Ok(());
    }
    let mut equations = Equations::new(system);
    let metric = evaluate(system, state, &mut equations)?;
    let p: Vec<f64> = equations.violation_rate.iter().map(|x| -x).collect();
    let kept = system.kept.clone();
    let factors = factors(&metric, &kept, state)?;
    let change = metric.least_motion(system.degrees_of_freedom(), (&kept, &factors), &p);
    for (v, change) in state.velocity.iter_mut().zip(change.iter()) {
        *v += change;
    }
    let metric = evaluate(system, state, &mut equations)?;
    let what = largest(&equations.violation_rate, 0..system.equations());
    let scale = state
        .velocity
        .iter()
        .fold(1.0_f64, |most, v| most.max(v.abs()));
    if what.1.is_nan() || what.1 >= CONSISTENT * scale {
        return Err(contradiction(
            system,
            &metric,
            (&kept, &factors),
            what,
            state.time_s,
        ));
    }
    Ok(())
}

/// The error for a dropped equation that no longer holds, if there is one.
pub(crate) fn watch_dropped(
    system: &mut System,
    state: &State,
    violation: &[f64],
) -> Result<(), DynamicsError> {
    if system.redundant.is_empty() {
        return Ok(());
    }
    let dropped = (0..violation.len()).filter(|i| system.kept.binary_search(i).is_err());
    let worst = dropped.fold((0, 0.0), |(index, most), i| {
        if violation[i].abs() > most {
            (i, violation[i].abs())
        } else {
            (index, most)
        }
    });
    if worst.1 < CONSISTENT {
        return Ok(());
    }
    let mut equations = Equations::new(system);
    let metric = evaluate(system, state, &mut equations)?;
    let kept = system.kept.clone();
    let factors = factors(&metric, &kept, state)?;
    Err(contradiction(
        system,
        &metric,
        (&kept, &factors),
        worst,
        state.time_s,
    ))
}
