//! Natural frequencies, damping and shapes of small motions about an operating point.
//!
//! With rotations δθ along **world** axes, δψ = Rᵀδθ and δΩ = Rᵀδθ̇, so that the linearised equations are of the second
//! order also for spinning bodies, gyroscopic terms in Ĉ:
//!
//! ```text
//! M̂ ÿ + Ĉ ẏ + K̂ y + B̂ᵀδλ = 0,  B̂ y = 0       M̂ = TᵀMT,  Ĉ = TᵀCT − M̂ W,  K̂ = TᵀKT,  B̂ = BT
//! T = diag(I, Rᵀ, I),  W = diag(0, ω̃, 0)
//! ```
//!
//! On a basis Z of the null space of B̂ with ZᵀM̂Z = I the eigenvalues are those of [0 I; −ZᵀK̂Z −ZᵀĈZ], or, where
//! nothing damps or spins, −ω² those of the symmetric −ZᵀK̂Z. The equations are frozen at the given instant: exact at
//! rest and for bodies that spin about an axis of symmetry; otherwise coefficients vary with the angle. Derivation:
//! docs/theory/multibody.md.

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use nalgebra::{DMatrix, Matrix3};

use crate::elements::Iterate;
use crate::equations::{At, Detail, Equations};
use crate::error::DynamicsError;
use crate::krylov;
use crate::matrix::Matrix;
use crate::metric::Metric;
use crate::rotation::skew;
use crate::state::State;
use crate::system::{Slot, System};

/// A damping matrix below this share of the frequencies, and an asymmetry of the stiffness below this share of it, is
/// rounding.
const ROUNDING: f64 = 1e-11;

/// One eigenvalue s = σ ± iω with its shape.
#[derive(Debug, Clone, PartialEq)]
pub struct NaturalMode {
    /// σ \[1/s\]: negative where the motion dies out.
    pub growth_per_s: f64,
    /// ω ≥ 0 of the damped vibration \[rad/s\]; 0 for motions that do not vibrate.
    pub angular_frequency_rad_per_s: f64,
    /// Complex amplitudes (real, imaginary) of all degrees of freedom: places and rotations along world axes, then
    /// modal coordinates; the largest is 1 + 0i.
    pub shape: Vec<[f64; 2]>,
}

impl NaturalMode {
    /// Frequency of the damped vibration \[Hz\].
    #[must_use]
    pub fn frequency_hz(&self) -> f64 {
        self.angular_frequency_rad_per_s / std::f64::consts::TAU
    }

    /// |s|: the frequency without damping \[rad/s\].
    #[must_use]
    pub fn natural_angular_frequency_rad_per_s(&self) -> f64 {
        self.growth_per_s.hypot(self.angular_frequency_rad_per_s)
    }

    /// Damping ratio −σ/|s|; 0 for s = 0.
    #[must_use]
    pub fn damping_ratio(&self) -> f64 {
        let size = self.natural_angular_frequency_rad_per_s();
        if size > 0.0 {
            // No negative zero.
            0.0 - self.growth_per_s / size
        } else {
            0.0
        }
    }
}

/// Unknowns of motions and joints from which modes up to a frequency are sought by [`krylov`].
const LARGE: usize = 400;

/// Share of its frequency below which the growth of a mode found by Krylov vectors is rounding.
const FOUND: f64 = 1e-9;

/// The modes of [`natural_modes`] whose frequency is at most `most_hz`. In large systems they alone are sought, by
/// Krylov vectors (`krylov.rs`), which leaves out motions that die out faster than e^(−2π `most_hz` t); a frequency
/// that occurs more than four times may then lack members.
///
/// # Errors
/// As [`natural_modes`].
pub fn natural_modes_up_to(
    system: &mut System,
    state: &State,
    most_hz: f64,
) -> Result<Vec<NaturalMode>, DynamicsError> {
    if system.degrees_of_freedom() + system.kept.len() >= LARGE {
        let equations = about(system, state)?;
        let limit = std::f64::consts::TAU * most_hz;
        let found = krylov::eigenvalues_within(system, &equations, limit, state.time_s)?;
        if let Some(found) = found {
            let modes = found.into_iter().map(|found| NaturalMode {
                growth_per_s: if found.re.abs() > FOUND * found.im {
                    found.re
                } else {
                    0.0
                },
                angular_frequency_rad_per_s: found.im,
                shape: scaled(found.shape),
            });
            return Ok(sorted(modes.collect()));
        }
    }
    let mut modes = natural_modes(system, state)?;
    modes.retain(|mode| mode.frequency_hz() <= most_hz);
    Ok(modes)
}

/// The linearised equations about a state, rotations along body axes.
fn tangents(system: &mut System, state: &State) -> Result<Equations, DynamicsError> {
    let accelerations = system.accelerations(state)?;
    let mut equations = Equations::new(system);
    let at = At {
        state,
        acceleration: &accelerations.acceleration,
        lambda: &accelerations.lambda,
        load_factor: 1.0,
        iterate: Iterate::Single,
    };
    system.evaluate(at, Detail::Tangents, &mut equations)?;
    Ok(equations)
}

/// The linearised equations about a state, rotations along world axes.
pub(crate) fn about(system: &mut System, state: &State) -> Result<Equations, DynamicsError> {
    let mut equations = tangents(system, state)?;
    turn_to_world(system, state, &mut equations);
    Ok(equations)
}

/// By rising |s|.
fn sorted(mut modes: Vec<NaturalMode>) -> Vec<NaturalMode> {
    modes.sort_by(|a, b| {
        a.natural_angular_frequency_rad_per_s()
            .total_cmp(&b.natural_angular_frequency_rad_per_s())
    });
    modes
}

/// Eigenvalues with ω ≥ 0 about a state, by rising |s|. Free motions come out as s ≈ 0.
///
/// # Errors
/// [`DynamicsError::Eigen`], [`DynamicsError::Singular`] or the error of an element.
pub fn natural_modes(
    system: &mut System,
    state: &State,
) -> Result<Vec<NaturalMode>, DynamicsError> {
    let equations = about(system, state)?;
    let basis = null_space(system, &equations, state.time_s)?;
    let reduced = |matrix: &Matrix| basis.tr_mul(&(matrix.to_dense() * &basis));
    let stiffness = reduced(&equations.stiffness);
    let damping = reduced(&equations.damping);
    let massless = system.layout.massless().count();
    if massless > 0 {
        return with_massless(&stiffness, &damping, massless, &basis);
    }
    let scale = stiffness.amax().sqrt();
    let asymmetry = (&stiffness - stiffness.transpose()).amax();
    let modes = if damping.amax() <= ROUNDING * scale && asymmetry <= ROUNDING * scale * scale {
        undamped(&stiffness, &basis)?
    } else {
        damped(&stiffness, &damping, scale, &basis)?
    };
    Ok(sorted(modes))
}

/// Share of each force element in the strain energy of some modes about a state, `[mode][element]`: |yᴴ K y| with the
/// element's part of the stiffness, over the sum of all elements. Zero of all where nothing is strained.
///
/// # Errors
/// The error of an element.
pub fn strain_shares(
    system: &mut System,
    state: &State,
    modes: &[NaturalMode],
) -> Result<Vec<Vec<f64>>, DynamicsError> {
    // The elements keep the tangents that they were asked for.
    tangents(system, state)?;
    let shares = modes.iter().map(|mode| {
        // Increments of rotation are those about body axes.
        let mut amplitudes = [0, 1].map(|part| mode.shape.iter().map(|a| a[part]).collect());
        for (body, start) in system.layout.starts().enumerate() {
            let to_body = state.orientations[body].inverse();
            for y in &mut amplitudes {
                let y: &mut Vec<f64> = y;
                let turn = nalgebra::Vector3::from_column_slice(&y[start + 3..start + 6]);
                y[start + 3..start + 6].copy_from_slice((to_body * turn).as_slice());
            }
        }
        let energy = |slot: &Slot| -> f64 {
            let of_part = |y: &Vec<f64>| -> f64 {
                let pairs = slot.places.iter().flat_map(|columns| {
                    (0..columns.count).map(move |j| (columns.local + j, columns.system + j))
                });
                pairs
                    .map(|(local, place)| {
                        let tangent = &slot.loads.by_position;
                        let rows = slot.places.iter().flat_map(|rows| {
                            (0..rows.count).map(move |i| (rows.local + i, rows.system + i))
                        });
                        let force: f64 =
                            rows.map(|(row, at)| tangent.get(row, local) * y[at]).sum();
                        -force * y[place]
                    })
                    .sum()
            };
            amplitudes.iter().map(of_part).sum::<f64>().abs()
        };
        let energies: Vec<f64> = system.slots.iter().map(energy).collect();
        let total: f64 = energies.iter().sum();
        let scale = if total > 0.0 { total } else { 1.0 };
        energies.iter().map(|energy| energy / scale).collect()
    });
    Ok(shares.collect())
}

/// M, C, K and B of the system become M̂, Ĉ, K̂ and B̂.
fn turn_to_world(system: &System, state: &State, equations: &mut Equations) {
    for (body, start) in system.layout.starts().enumerate() {
        let turn = start + 3;
        let to_body: Matrix3<f64> = state.orientations[body]
            .to_rotation_matrix()
            .matrix()
            .transpose();
        for matrix in [
            &mut equations.mass,
            &mut equations.damping,
            &mut equations.stiffness,
        ] {
            matrix.turn_columns(turn, &to_body);
            matrix.turn_rows(turn, &to_body);
        }
        let own = nalgebra::Vector3::from_column_slice(&state.velocity[turn..turn + 3]);
        let spin = skew(&(to_body.transpose() * own));
        let masses = &equations.mass;
        for &row in masses.pattern().column(turn) {
            let m = [0, 1, 2].map(|k| masses.get(row, turn + k));
            for k in 0..3 {
                let value: f64 = (0..3).map(|l| m[l] * spin[(l, k)]).sum();
                equations.damping.add(row, turn + k, -value);
            }
        }
    }
    equations.gradient.turn_bodies(|start| {
        let (body, _) = system.layout.locate(start);
        let rotation = state.orientations[body].to_rotation_matrix();
        rotation.matrix().transpose()
    });
}

/// Z: motions that the joints allow, orthonormal in the mass matrix, then coordinates without mass one by one.
fn null_space(
    system: &System,
    equations: &Equations,
    time_s: f64,
) -> Result<DMatrix<f64>, DynamicsError> {
    let singular = || DynamicsError::singular("the mass matrix", time_s);
    let metric = Metric::new(equations, system.layout.massive_ranges()).ok_or_else(singular)?;
    let n = equations.residual.len();
    let kept = &system.kept;
    let rows = metric.dense_columns(n, kept);
    // Coordinates without mass are in no joint: directions of their own, behind the others.
    let massless: Vec<usize> = system.layout.massless().collect();
    let massive: Vec<usize> = (0..n).filter(|dof| !massless.contains(dof)).collect();
    let q = Mat::from_fn(massive.len(), kept.len(), |i, j| rows[(massive[i], j)])
        .qr()
        .compute_Q();
    let moves = massive.len() - kept.len();
    let mut basis = DMatrix::zeros(n, moves + massless.len());
    for (i, &dof) in massive.iter().enumerate() {
        for j in 0..moves {
            basis[(dof, j)] = q[(i, kept.len() + j)];
        }
    }
    for column in basis.as_mut_slice().chunks_mut(n.max(1)) {
        metric.scale_back(column);
    }
    for (j, &dof) in massless.iter().enumerate() {
        basis[(dof, moves + j)] = 1.0;
    }
    Ok(basis)
}

fn shape(basis: &DMatrix<f64>, amplitude: impl Fn(usize) -> [f64; 2]) -> Vec<[f64; 2]> {
    let mut shape = vec![[0.0; 2]; basis.nrows()];
    for k in 0..basis.ncols() {
        let [re, im] = amplitude(k);
        for (place, z) in shape.iter_mut().zip(basis.column(k).iter()) {
            place[0] += z * re;
            place[1] += z * im;
        }
    }
    scaled(shape)
}

/// The shape with its largest entry at 1 + 0i.
fn scaled(mut shape: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let square = |a: &[f64; 2]| a[0] * a[0] + a[1] * a[1];
    let largest =
        shape.iter().copied().fold(
            [0.0; 2],
            |most, a| if square(&a) > square(&most) { a } else { most },
        );
    let size = square(&largest);
    if size > 0.0 {
        for a in &mut shape {
            *a = [
                (a[0] * largest[0] + a[1] * largest[1]) / size,
                (a[1] * largest[0] - a[0] * largest[1]) / size,
            ];
        }
    }
    shape
}

fn undamped(
    stiffness: &DMatrix<f64>,
    basis: &DMatrix<f64>,
) -> Result<Vec<NaturalMode>, DynamicsError> {
    let size = stiffness.nrows();
    let matrix = Mat::from_fn(size, size, |i, j| {
        0.5 * (stiffness[(i, j)] + stiffness[(j, i)])
    });
    let found = matrix
        .self_adjoint_eigen(Side::Lower)
        .map_err(|_| DynamicsError::Eigen { size })?;
    let (values, vectors) = (found.S().column_vector(), found.U());
    let mut modes = Vec::with_capacity(size);
    for j in 0..size {
        let shape = shape(basis, |k| [vectors[(k, j)], 0.0]);
        let square = values[j];
        let mode = |growth_per_s, angular_frequency_rad_per_s| NaturalMode {
            growth_per_s,
            angular_frequency_rad_per_s,
            shape: shape.clone(),
        };
        if square >= 0.0 {
            modes.push(mode(0.0, square.sqrt()));
        } else {
            modes.push(mode((-square).sqrt(), 0.0));
            modes.push(mode(-(-square).sqrt(), 0.0));
        }
    }
    Ok(modes)
}

fn damped(
    stiffness: &DMatrix<f64>,
    damping: &DMatrix<f64>,
    scale: f64,
    basis: &DMatrix<f64>,
) -> Result<Vec<NaturalMode>, DynamicsError> {
    let size = stiffness.nrows();
    // Velocities over a frequency, so that both halves of the matrix are of one size.
    let scale = if scale > 0.0 { scale } else { 1.0 };
    let matrix = Mat::from_fn(2 * size, 2 * size, |i, j| match (i < size, j < size) {
        (true, true) => 0.0,
        (true, false) => scale * f64::from(u8::from(i == j - size)),
        (false, true) => -stiffness[(i - size, j)] / scale,
        (false, false) => -damping[(i - size, j - size)],
    });
    let found = matrix
        .eigen()
        .map_err(|_| DynamicsError::Eigen { size: 2 * size })?;
    let (values, vectors) = (found.S().column_vector(), found.U());
    let modes = (0..2 * size)
        .filter(|&j| values[j].im >= 0.0)
        .map(|j| NaturalMode {
            growth_per_s: values[j].re,
            angular_frequency_rad_per_s: values[j].im,
            shape: shape(basis, |k| [vectors[(k, j)].re, vectors[(k, j)].im]),
        });
    Ok(modes.collect())
}

/// A shift over the largest frequency without coupling, 1/s: no eigenvalue sits on it but by chance.
const SHIFT: f64 = 0.1234567;

/// Share of the largest 1/(s − shift) below which it stands for an equation without a rate: no motion of its own.
const NO_RATE: f64 = 1e-9;

/// With coordinates w without mass, the last `massless` of the basis. With x = (y, ẏ, w),
///
/// ```text
/// [1 0  0    ]      [ 0     1     0    ]
/// [0 1  C_yw ] ẋ =  [−K_yy −C_yy −K_yw ] x        E ẋ = A x
/// [0 0  C_ww ]      [−K_wy −C_wy −K_ww ]
/// ```
///
/// E is singular where w has no rate; the eigenvalues of (A − σE)⁻¹E are 1/(s − σ), and zero for what has none.
fn with_massless(
    stiffness: &DMatrix<f64>,
    damping: &DMatrix<f64>,
    massless: usize,
    basis: &DMatrix<f64>,
) -> Result<Vec<NaturalMode>, DynamicsError> {
    let moves = stiffness.nrows() - massless;
    let size = 2 * moves + massless;
    let failed = || DynamicsError::Eigen { size };
    // Place among y and w; true: among the rates of y.
    let place = |i: usize| match i {
        i if i < moves => (i, false),
        i if i < 2 * moves => (i - moves, true),
        i => (i - moves, false),
    };
    let equations = |i: usize| i >= moves;
    let equal = |i: usize, j: usize| f64::from(u8::from(i == j));
    let rates = Mat::from_fn(size, size, |i, j| match (place(i), place(j)) {
        ((row, _), (column, false)) if equations(i) && column >= moves => damping[(row, column)],
        _ if i < 2 * moves => equal(i, j),
        _ => 0.0,
    });
    let forces = Mat::from_fn(size, size, |i, j| match (place(i), place(j)) {
        ((row, _), (column, true)) if equations(i) => -damping[(row, column)],
        ((row, _), (column, false)) if equations(i) => -stiffness[(row, column)],
        ((row, _), (column, true)) => equal(row, column),
        _ => 0.0,
    });
    let fastest = (0..moves)
        .map(|i| stiffness[(i, i)].abs().sqrt().max(damping[(i, i)].abs()))
        .fold(0.0, f64::max);
    let shift = SHIFT * if fastest > 0.0 { fastest } else { 1.0 };
    let shifted = Mat::from_fn(size, size, |i, j| forces[(i, j)] - shift * rates[(i, j)]);
    let inverse = shifted.partial_piv_lu().solve(&rates);
    let found = inverse.eigen().map_err(|_| failed())?;
    let (values, vectors) = (found.S().column_vector(), found.U());
    let size_of = |j: usize| values[j].re.hypot(values[j].im);
    let largest = (0..size).map(size_of).fold(0.0, f64::max);
    let modes = (0..size)
        .filter(|&j| size_of(j) > NO_RATE * largest)
        .map(|j| {
            // 1/θ = θ̄/|θ|²
            let square = size_of(j).powi(2);
            let (re, im) = (values[j].re / square, -values[j].im / square);
            (j, shift + re, im)
        })
        .filter(|(_, _, im)| *im >= 0.0)
        .map(
            |(j, growth_per_s, angular_frequency_rad_per_s)| NaturalMode {
                growth_per_s,
                angular_frequency_rad_per_s,
                shape: shape(basis, |k| {
                    let vector = vectors[(if k < moves { k } else { k + moves }, j)];
                    [vector.re, vector.im]
                }),
            },
        );
    Ok(sorted(modes.collect()))
}
