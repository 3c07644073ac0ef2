//! Joint equations as a whole: places and speeds that fit them, and which of them are redundant.
//!
//! With M = LLᵀ, the rows of B̂ = B L⁻ᵀ are comparable whatever their units. Redundant equations are found by orthogonalising the
//! rows one after the other in the order of the joints (twice, so that rounding does not hide a dependence): a row of which
//! less than 1e-8 is left follows from those before it. The order makes the answer repeatable and lets an earlier joint keep its equations,
//! which a QR with free choice of pivots would not. Dropped equations are watched, not solved.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::equations::{At, Detail, Equations};
use crate::error::DynamicsError;
use crate::matrix::Matrix;
use crate::state::State;
use crate::system::System;

/// Share of a row of B̂ below which it counts as dependent on the rows before it. Rounding leaves about 1e-15, well-built
/// mechanisms have more than 1e-3.
const DEPENDENT: f64 = 1e-8;

/// What may be left of a redundant equation (m, rad, or m/s, rad/s): more than any rounding, less than anything that matters.
pub(crate) const CONSISTENT: f64 = 1e-6;

/// A joint of which some equations follow from those of other joints.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Redundancy {
    /// Name of the joint.
    pub joint: String,
    /// Number of its equations that are redundant.
    pub equations: usize,
    /// The joints that imply them.
    pub implied_by: Vec<String>,
}

/// Joint equations at one configuration in the metric of the mass matrix.
pub(crate) struct Metric {
    mass: Cholesky<f64, Dyn>,
    /// B̂ᵀ: L⁻¹ B_iᵀ, one column for each equation.
    rows: DMatrix<f64>,
}

impl Metric {
    /// `None` if the mass matrix is not positive definite, which valid bodies exclude as long as modes stay small.
    pub(crate) fn new(equations: &Equations) -> Option<Self> {
        let mass = dense(&equations.mass).cholesky()?;
        let mut rows = dense(&equations.gradient);
        mass.l_dirty().solve_lower_triangular_mut(&mut rows);
        Some(Self { mass, rows })
    }

    /// B̂ᵀ, one column for each equation.
    pub(crate) fn rows(&self) -> &DMatrix<f64> {
        &self.rows
    }

    /// L⁻ᵀ x: from the metric's coordinates to increments.
    pub(crate) fn scale_back(&self, x: &mut DMatrix<f64>) {
        self.mass.l_dirty().tr_solve_lower_triangular_mut(x);
    }

    /// The equations that are independent of those before them.
    fn independent(&self) -> Vec<usize> {
        let mut basis: Vec<DVector<f64>> = Vec::new();
        let mut kept = Vec::new();
        for (index, row) in self.rows.column_iter().enumerate() {
            let length = row.norm();
            let mut rest: DVector<f64> = row.into();
            for _ in 0..2 {
                for direction in &basis {
                    rest -= direction * direction.dot(&rest);
                }
            }
            if rest.norm() > DEPENDENT * length {
                rest.normalize_mut();
                basis.push(rest);
                kept.push(index);
            }
        }
        kept
    }

    /// Smallest motion δ (in the metric) with B δ = p for the kept equations.
    pub(crate) fn least_motion(&self, kept: &[usize], p: &[f64]) -> Option<DVector<f64>> {
        let rows = self.rows.select_columns(kept);
        let right = DVector::from_iterator(kept.len(), kept.iter().map(|&i| p[i]));
        let factor = rows.tr_mul(&rows).cholesky()?;
        let mut motion = &rows * factor.solve(&right);
        self.mass
            .l_dirty()
            .tr_solve_lower_triangular_mut(&mut motion);
        Some(motion)
    }

    /// The kept equations that a dropped one is a combination of.
    fn implying(&self, kept: &[usize], dropped: usize) -> Vec<usize> {
        let rows = self.rows.select_columns(kept);
        let right = rows.tr_mul(&self.rows.column(dropped));
        let Some(factor) = rows.tr_mul(&rows).cholesky() else {
            return Vec::new();
        };
        let weights = factor.solve(&right);
        let largest = weights.amax();
        let entries = kept.iter().zip(weights.iter());
        entries
            .filter(|(_, weight)| weight.abs() > 1e-6 * largest)
            .map(|(&index, _)| index)
            .collect()
    }
}

fn dense(matrix: &Matrix) -> DMatrix<f64> {
    DMatrix::from_column_slice(matrix.rows(), matrix.columns(), matrix.values())
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
    };
    system.evaluate_without_elements(at, Detail::Tangents, equations);
    Metric::new(equations).ok_or(DynamicsError::Singular {
        what: "the mass matrix",
        time_s: state.time_s,
    })
}

/// Moves the start onto the joints and finds the redundant equations.
pub(crate) fn analyse(system: &mut System) -> Result<(), DynamicsError> {
    let mut state = system.start.clone();
    system.begin_joints(&state);
    let mut equations = Equations::new(system);
    let mut metric = evaluate(system, &state, &mut equations)?;
    let mut kept = metric.independent();
    for _ in 0..50 {
        let p: Vec<f64> = equations.violation.iter().map(|x| -x).collect();
        if largest(&p, &kept).1 < 1e-14 {
            break;
        }
        let Some(motion) = metric.least_motion(&kept, &p) else {
            break;
        };
        // Not more than half a radian or, for places, half a metre at a time: far starts come in without overshoot.
        let motion = motion.scale((0.5 / motion.amax()).min(1.0));
        let from = state.clone();
        state.set_moved(&from, motion.as_slice(), &system.layout);
        metric = evaluate(system, &state, &mut equations)?;
        kept = metric.independent();
        if motion.amax() < 1e-15 {
            break;
        }
    }
    let all: Vec<usize> = (0..system.equations()).collect();
    let (worst, violation) = largest(&equations.violation, &all);
    if violation.is_nan() || violation >= CONSISTENT {
        return Err(contradiction(
            system,
            &metric,
            &kept,
            worst,
            violation,
            state.time_s,
        ));
    }
    system.redundant = redundancies(system, &metric, &kept);
    system.kept = kept;
    system.start = state;
    let start = system.start.clone();
    system.begin_joints(&start);
    Ok(())
}

/// Index and magnitude of the largest entry among `of`; not a number counts as largest.
fn largest(values: &[f64], of: &[usize]) -> (usize, f64) {
    of.iter().fold((0, 0.0), |(index, most), &i| {
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
    kept: &[usize],
    worst: usize,
    violation: f64,
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
        involved.extend(metric.implying(kept, worst));
    }
    DynamicsError::Contradiction {
        joints: names(system, &involved),
        violation,
        time_s,
    }
}

/// Whether two equations act on common motions.
fn shares(metric: &Metric, a: usize, b: usize) -> bool {
    let (a, b) = (metric.rows.column(a), metric.rows.column(b));
    a.dot(&b).abs() > 1e-8 * a.norm() * b.norm()
}

fn redundancies(system: &System, metric: &Metric, kept: &[usize]) -> Vec<Redundancy> {
    let mut found: Vec<Redundancy> = Vec::new();
    for dropped in (0..system.equations()).filter(|i| !kept.contains(i)) {
        let joint = system.joint_of(dropped);
        let mut implied_by = names(system, &metric.implying(kept, dropped));
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
    let change = metric
        .least_motion(&kept, &p)
        .ok_or(DynamicsError::Singular {
            what: "the matrix of the joints",
            time_s: state.time_s,
        })?;
    for (v, change) in state.velocity.iter_mut().zip(change.iter()) {
        *v += change;
    }
    let metric = evaluate(system, state, &mut equations)?;
    let all: Vec<usize> = (0..system.equations()).collect();
    let (worst, violation) = largest(&equations.violation_rate, &all);
    let scale = state
        .velocity
        .iter()
        .fold(1.0_f64, |most, v| most.max(v.abs()));
    if violation.is_nan() || violation >= CONSISTENT * scale {
        return Err(contradiction(
            system,
            &metric,
            &kept,
            worst,
            violation,
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
    Err(contradiction(
        system,
        &metric,
        &kept,
        worst.0,
        worst.1,
        state.time_s,
    ))
}
