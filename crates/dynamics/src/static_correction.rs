//! One correction of a static equilibrium.
//!
//! It is the smallest that solves Newton's equations. Where the scaled matrix is regular by far, the factors of a step
//! in time give it. Else singular values do, which find the directions that nothing resists.

use std::sync::Arc;

use faer::Mat;

use crate::equations::Equations;
use crate::error::DynamicsError;
use crate::matrix::Matrix;
use crate::saddle::{Saddle, SaddleForm};
use crate::scheme::LinearSolver;
use crate::system::System;

/// Singular values below this share of the largest, after scaling, count as zero.
const FREE: f64 = 1e-11;

/// Share of the largest stiffness, and of the largest entry of a joint equation, scaled by the masses, that counts as
/// rounding.
const ROUNDING: f64 = 1e-14;

/// Share of the largest push anywhere with which a push is compared at least: below [`BALANCED`] times this it is
/// rounding, such as what a body turned by rounding has of a load beside its direction.
const FELT: f64 = 1e-5;

/// Largest growth of a vector by the inverse of the scaled matrix at which it counts as regular: a hundred times below
/// where singular values count as zero.
const REGULAR: f64 = 1e9;

/// A scaled Newton matrix, decomposed, with what it says about free motions.
pub(crate) struct Correction {
    /// δ and δλ, free directions at rest.
    pub values: Vec<f64>,
    /// Free motions, scaled to a largest entry of 1.
    pub free: Vec<Vec<f64>>,
    /// Load along each over the sum of all that pushes along it, whatever its sign.
    pub share: Vec<f64>,
    /// Load along each.
    pub load: Vec<f64>,
}

impl Correction {
    /// Of a regular matrix, which leaves no motion free; none where a value is no number.
    fn of_regular(values: Vec<f64>) -> Option<Self> {
        values.iter().all(|x| x.is_finite()).then(|| Self {
            values,
            free: Vec::new(),
            share: Vec::new(),
            load: Vec::new(),
        })
    }
}

/// Where the entries of all corrections of a system are.
pub(crate) fn form_of(system: &System) -> Arc<SaddleForm> {
    let form = SaddleForm::new(&system.structure, &system.kept, LinearSolver::Automatic);
    Arc::new(form)
}

/// The correction at an evaluated motion; `pushing`: all that pushes on each degree of freedom, whatever its sign.
pub(crate) fn correct(
    system: &System,
    (equations, form): (&Equations, &Arc<SaddleForm>),
    pushing: &[f64],
) -> Result<Correction, DynamicsError> {
    match by_factors(system, equations, form) {
        Some(correction) => Ok(correction),
        None => by_singular_values(&Scaled::new(system, equations), equations, pushing),
    }
}

/// `None` if the matrix is singular or nearly so.
fn by_factors(
    system: &System,
    equations: &Equations,
    form: &Arc<SaddleForm>,
) -> Option<Correction> {
    let diagonal = system.mass_diagonal();
    let mut saddle = Saddle::new(&diagonal, system.layout.massless(), form);
    let (n, m) = (diagonal.len(), system.equations());
    // Over the largest scaled stiffness, so that entries are as large as those of joints.
    let stiffest = (0..n).flat_map(|j| {
        let column = equations.stiffness.entries(j);
        let scaled = column.map(move |(i, k)| (i, j, k));
        scaled.collect::<Vec<_>>()
    });
    let stiffest = stiffest.fold(0.0_f64, |most, (i, j, k)| {
        most.max(k.abs() / (diagonal[i] * diagonal[j]).sqrt())
    });
    if stiffest <= 0.0 || !stiffest.is_finite() {
        return None;
    }
    let mut matrix = Matrix::zeros(&system.structure.square);
    let none = &equations.stiffness;
    matrix.set_combination([0.0, 0.0, 1.0 / stiffest], [none, none, none]);
    if !saddle.factor(&matrix, &equations.gradient, &equations.gradient) {
        return None;
    }
    let (mut delta, mut mu) = (vec![0.0; n], vec![0.0; m]);
    // The inverse, applied again and again, shows how small the smallest singular value is.
    let length = |x: &[f64]| {
        let squares = x.iter().zip(&diagonal).map(|(x, mass)| x * x * mass);
        squares.sum::<f64>().sqrt()
    };
    let mut along: Vec<f64> = (0..n)
        .map(|i| (1.0 + (i % 7) as f64) * diagonal[i].sqrt())
        .collect();
    let rest = vec![0.0; m];
    for _ in 0..3 {
        let before = {
            let squares = along.iter().zip(&diagonal).map(|(x, mass)| x * x / mass);
            squares.sum::<f64>().sqrt()
        };
        saddle.solve(&along, &rest, &mut delta, &mut mu);
        let after = length(&delta);
        if after.is_nan() || after > REGULAR * before {
            return None;
        }
        if after == 0.0 {
            break;
        }
        for ((place, value), mass) in along.iter_mut().zip(&delta).zip(&diagonal) {
            *place = value * mass / after;
        }
    }
    let right: Vec<f64> = equations.residual.iter().map(|r| -r / stiffest).collect();
    let violation: Vec<f64> = equations.violation.iter().map(|x| -x).collect();
    saddle.solve(&right, &violation, &mut delta, &mut mu);
    let reactions = system.kept.iter().map(|&equation| mu[equation] * stiffest);
    let values: Vec<f64> = delta.iter().copied().chain(reactions).collect();
    Correction::of_regular(values)
}

/// Newton's matrix, its rows and columns scaled to largest entries of about 1.
struct Scaled {
    matrix: Mat<f64>,
    /// Of rows, and of columns.
    scale: Vec<f64>,
    /// Scaled right-hand side.
    right: Vec<f64>,
}

impl Scaled {
    fn new(system: &System, equations: &Equations) -> Self {
        let n = equations.residual.len();
        let kept = &system.kept;
        let total = n + kept.len();
        let mut matrix = without_rounding(system, equations);
        // From scales of the mass matrix.
        let masses = system.mass_diagonal();
        let mut scale: Vec<f64> = masses.iter().map(|mass| 1.0 / mass.sqrt()).collect();
        scale.resize(total, 1.0);
        for _ in 0..4 {
            let mut most = vec![0.0_f64; total];
            for j in 0..total {
                for i in 0..total {
                    let entry = matrix[(i, j)].abs();
                    most[i] = most[i].max(entry * scale[j]);
                    most[j] = most[j].max(entry * scale[i]);
                }
            }
            for (scale, most) in scale.iter_mut().zip(most) {
                let change = most * *scale;
                if change > 0.0 {
                    *scale /= change.sqrt();
                }
            }
        }
        for j in 0..total {
            for i in 0..total {
                matrix[(i, j)] *= scale[i] * scale[j];
            }
        }
        let violation = kept.iter().map(|&equation| equations.violation[equation]);
        let right = equations.residual.iter().copied().chain(violation);
        let right = right.zip(&scale).map(|(x, scale)| -scale * x).collect();
        Self {
            matrix,
            scale,
            right,
        }
    }
}

/// Newton's matrix without what is rounding in it.
fn without_rounding(system: &System, equations: &Equations) -> Mat<f64> {
    let n = equations.residual.len();
    let kept = &system.kept;
    let total = n + kept.len();
    let mass: Vec<f64> = system
        .mass_diagonal()
        .iter()
        .map(|mass| 1.0 / mass.sqrt())
        .collect();
    // What has no mass is not measured by it.
    let weighs: Vec<bool> = system.masses().iter().map(|mass| *mass > 0.0).collect();
    let mut matrix = Mat::zeros(total, total);
    // Stiffness at the level of rounding is none: the largest stiffness and, over a radian, the loads say how much that
    // is.
    let mut most = 0.0_f64;
    for j in (0..n).filter(|&j| weighs[j]) {
        let column = equations.stiffness.entries(j).filter(|(i, _)| weighs[*i]);
        let stiffest = column.fold(0.0_f64, |most, (i, k)| {
            most.max((mass[i] * k * mass[j]).abs())
        });
        let loaded = (equations.residual[j] * mass[j] * mass[j]).abs();
        most = most.max(stiffest).max(loaded);
    }
    let noise = ROUNDING * most;
    for j in 0..n {
        for (i, k) in equations.stiffness.entries(j) {
            let is_felt = !(weighs[i] && weighs[j]) || (mass[i] * k * mass[j]).abs() > noise;
            matrix[(i, j)] = if is_felt { k } else { 0.0 };
        }
    }
    // So is what a joint equation has of a motion that it leaves free.
    for (place, &equation) in kept.iter().enumerate() {
        let entries = || equations.gradient.entries(equation);
        let weighed = entries().filter(|(i, _)| weighs[*i]);
        let most = weighed.fold(0.0_f64, |most, (i, b)| most.max((mass[i] * b).abs()));
        for (i, b) in entries() {
            if !weighs[i] || (mass[i] * b).abs() > ROUNDING * most {
                matrix[(i, n + place)] = b;
                matrix[(n + place, i)] = b;
            }
        }
    }
    matrix
}

fn by_singular_values(
    scaled: &Scaled,
    equations: &Equations,
    pushing: &[f64],
) -> Result<Correction, DynamicsError> {
    let Scaled {
        matrix,
        scale,
        right,
    } = scaled;
    let n = equations.residual.len();
    let total = right.len();
    let singular = || {
        DynamicsError::singular(
            "the static stiffness (it has entries that are not finite)",
            0.0,
        )
    };
    let mut svd = matrix.svd().map_err(|_| singular())?;
    let rank = {
        let s = svd.S().column_vector();
        (0..total).take_while(|&k| s[k] > FREE * s[0]).count()
    };
    // A motion that nothing resists changes no load; yet off the equilibrium other motions change the load along it, by
    // as much as loads are unbalanced. Scaled up, that little would weigh as much as all else: the equation along a
    // free motion is left out.
    let along_free = svd.V().subcols(rank, total - rank).to_owned();
    let unequal = along_free.transpose() * matrix;
    if unequal.norm_max() > FREE * svd.S().column_vector()[0] {
        let equal = matrix - &along_free * unequal;
        svd = equal.svd().map_err(|_| singular())?;
    }
    let (u, s, v) = (svd.U(), svd.S().column_vector(), svd.V());
    let mut correction = Correction {
        values: vec![0.0; total],
        free: Vec::new(),
        share: Vec::new(),
        load: Vec::new(),
    };
    let most_push = pushing.iter().fold(0.0_f64, |most, push| most.max(*push));
    for k in 0..total {
        let along: f64 = (0..total).map(|i| u[(i, k)] * right[i]).sum();
        if s[k] > FREE * s[0] {
            for i in 0..total {
                correction.values[i] += scale[i] * v[(i, k)] * along / s[k];
            }
            continue;
        }
        let motion: Vec<f64> = (0..n).map(|i| scale[i] * v[(i, k)]).collect();
        let most = motion.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        if most == 0.0 {
            continue;
        }
        let motion: Vec<f64> = motion.iter().map(|x| x / most).collect();
        let load: f64 = motion
            .iter()
            .zip(&equations.residual)
            .map(|(x, r)| x * r)
            .sum();
        let pushes = motion.iter().zip(pushing);
        let all: f64 = pushes.map(|(x, push)| (x * push).abs()).sum();
        let all = all.max(FELT * most_push);
        correction
            .share
            .push(if all > 0.0 { load.abs() / all } else { 0.0 });
        correction.load.push(load);
        correction.free.push(motion);
    }
    if correction.values.iter().any(|x| !x.is_finite()) {
        return Err(singular());
    }
    Ok(correction)
}
