//! Natural frequencies and shapes: K φ = ω² M φ, lowest first, by block Lanczos on the factor of K + s M.
//!
//! A = (K + s M)⁻¹ M is self-adjoint in the product ⟨x, y⟩ = xᵀ M y; its largest eigenvalues θ = 1/(ω² + s) are the
//! lowest frequencies, and they are well apart. The basis V is M-orthonormal and grows by A times its last block:
//!
//! ```text
//! A V_p = V_p S + V_r B          V_p: columns that A was applied to, V_r: the remainders, M-orthogonal to V_p
//! S y = θ y                      Ritz pair θ, φ = V_p y, with ‖A φ − θ φ‖_M = ‖B y‖ and |θ − exact| ≤ ‖B y‖
//! ```
//!
//! When the basis is full it is restarted with the best Ritz vectors and the remainders ("thick restart"), which keeps
//! the relation above. Every new vector is orthogonalised twice against the whole basis.
//!
//! Bodies that repeat have pairs of equal frequencies; a block as wide as the multiplicity finds all members, which
//! Lanczos with one vector does not. This, and the M-product, is why faer's own partial eigensolver is not used.
//!
//! Sources: R. G. Grimes, J. G. Lewis, H. D. Simon, *A shifted block Lanczos algorithm for solving sparse symmetric
//! generalized eigenproblems*, SIAM J. Matrix Anal. Appl. 15 (1994) 228-272; K. Wu, H. Simon, *Thick-restart Lanczos
//! method*, SIAM J. Matrix Anal. Appl. 22 (2000) 602-616.

use faer::{Mat, MatMut, MatRef};

use crate::compressed_columns::SparseMatrix;
use crate::error::FeError;
use crate::factor::Factor;
use crate::lanczos_basis::LanczosBasis;
use crate::mode_problem::ModeProblem;
use crate::symmetric_product::SymmetricRows;

/// Which modes are wanted, from the lowest on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum WantedModes {
    /// So many.
    Lowest(usize),
    /// All with ω² up to this (rad²/s²). The search goes on until a mode above it has converged too.
    UpTo(f64),
}

impl WantedModes {
    /// How many of these θ = 1/(ω² + s), largest first, are wanted, and how many must have converged for that.
    fn among(self, theta: &[f64], shift: f64, unknowns: usize) -> [usize; 2] {
        match self {
            Self::Lowest(count) => [count; 2],
            Self::UpTo(omega_squared) => {
                let least = 1.0 / (omega_squared + shift);
                let count = theta.iter().take_while(|t| **t >= least).count();
                [count, (count + 1).min(unknowns)]
            }
        }
    }
}

/// K and M as matrices, with the factor of K + s M.
struct AssembledProblem<'a> {
    stiffness: SymmetricRows,
    mass: SymmetricRows,
    factor: &'a Factor,
}

impl ModeProblem for AssembledProblem<'_> {
    fn size(&self) -> usize {
        self.factor.size()
    }

    fn mass_product(&self, x: MatRef<'_, f64>) -> Mat<f64> {
        self.mass.product(x)
    }

    fn stiffness_product(&self, x: MatRef<'_, f64>) -> Mat<f64> {
        self.stiffness.product(x)
    }

    fn solve_in_place(&self, b: MatMut<'_, f64>) {
        self.factor.solve_in_place(b);
    }
}

/// How natural modes are searched.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModeSettings {
    /// Which modes are wanted.
    pub wanted: WantedModes,
    /// Shift s (rad²/s²) of the factor that is handed in: 0 for a body that is held; positive, of the size of the
    /// lowest ω² wanted, for one that is free and has K singular.
    pub shift_rad2_per_s2: f64,
    /// Largest ‖A φ − θ φ‖_M / θ: the relative error of ω² + s is at most this, and in fact about its square.
    pub tolerance: f64,
    /// Largest number of restarts.
    pub restarts: usize,
    /// Vectors that are carried on together, at least the multiplicity of a frequency: 2 for bodies of revolution, 3
    /// for a cube, 6 for the rigid motions of a free body.
    pub block: usize,
}

impl ModeSettings {
    /// `count` modes of a held body to 1e-10, with blocks of 8: ω² is then right to rounding, and the residual of K and
    /// M, which weighs the higher modes left in a shape with their ω², is below some 1e-8 too.
    pub fn new(count: usize) -> Self {
        Self {
            wanted: WantedModes::Lowest(count),
            shift_rad2_per_s2: 0.0,
            tolerance: 1e-10,
            restarts: 60,
            block: 8,
        }
    }
}

/// Natural modes, lowest first.
#[derive(Debug, Clone)]
pub struct NaturalModes {
    /// ω² (rad²/s²); rounding about 0 for rigid motions.
    pub omega_squared: Vec<f64>,
    /// Shapes φ (free unknowns x modes), φᵀ M φ = 1: their unit is kg^-½ times that of the unknown.
    pub shapes: Mat<f64>,
    /// ‖K φ − ω² M φ‖ / ((ω² + s) ‖M φ‖) of each mode, Euclidean norms, from K and M themselves. It carries the
    /// rounding of K φ, some 1e-16 times the largest eigenvalue over ω².
    pub relative_residuals: Vec<f64>,
    /// ‖A φ − θ φ‖_M / θ of each mode, what the search stopped on.
    pub krylov_residuals: Vec<f64>,
    /// Vectors solved for.
    pub solves: usize,
    /// Restarts made.
    pub restarts: usize,
}

impl NaturalModes {
    fn new(problem: &impl ModeProblem, shift: f64, mut shapes: Mat<f64>, theta: &[f64]) -> Self {
        let mut omega_squared = Vec::with_capacity(shapes.ncols());
        let mut relative_residuals = Vec::with_capacity(shapes.ncols());
        for (mode, theta) in theta.iter().take(shapes.ncols()).enumerate() {
            // The sign is free: the largest entry is positive.
            let largest = shapes
                .col(mode)
                .iter()
                .fold(0.0_f64, |l, v| if v.abs() > l.abs() { *v } else { l });
            if largest < 0.0 {
                shapes.col_mut(mode).iter_mut().for_each(|v| *v = -*v);
            }
            let shape = shapes.col(mode).as_mat();
            let value = 1.0 / theta - shift;
            let elastic = problem.stiffness_product(shape);
            let inertial = problem.mass_product(shape);
            let residual = elastic - faer::Scale(value) * &inertial;
            relative_residuals.push(residual.norm_l2() * theta / inertial.norm_l2());
            omega_squared.push(value);
        }
        Self {
            omega_squared,
            shapes,
            relative_residuals,
            krylov_residuals: Vec::new(),
            solves: 0,
            restarts: 0,
        }
    }

    /// Natural frequencies (Hz); 0 where ω² is below zero by rounding.
    pub fn frequencies_hz(&self) -> Vec<f64> {
        self.omega_squared
            .iter()
            .map(|w| w.max(0.0).sqrt() / std::f64::consts::TAU)
            .collect()
    }
}

/// K + s M for two matrices of the same constraints, which have the same pattern.
///
/// # Errors
/// [`FeError::SizeMismatch`] when the patterns differ.
pub fn shifted_stiffness(
    k: &SparseMatrix,
    m: &SparseMatrix,
    shift_rad2_per_s2: f64,
) -> Result<SparseMatrix, FeError> {
    if k.symbolic().col_ptr() != m.symbolic().col_ptr()
        || k.symbolic().row_idx() != m.symbolic().row_idx()
    {
        return Err(FeError::SizeMismatch {
            what: "the pattern of the mass matrix (nonzeros)",
            found: m.compute_nnz(),
            expected: k.compute_nnz(),
        });
    }
    let mut sum = k.clone();
    for (value, mass) in sum.val_mut().iter_mut().zip(m.val()) {
        *value += shift_rad2_per_s2 * mass;
    }
    Ok(sum)
}

/// The lowest natural modes of stiffness `k` and mass `m`; `factor` is that of K + s M with the shift of `settings`.
///
/// As [`search_modes`], with the matrices at hand.
///
/// # Errors
/// [`FeError::ModeCount`], [`FeError::SizeMismatch`], [`FeError::ModesNotConverged`].
pub fn natural_modes(
    k: &SparseMatrix,
    m: &SparseMatrix,
    factor: &Factor,
    settings: &ModeSettings,
) -> Result<NaturalModes, FeError> {
    let n = k.ncols();
    for (what, found) in [
        ("the mass matrix", m.ncols()),
        ("the factor", factor.size()),
    ] {
        FeError::check_size(what, found, n)?;
    }
    let [stiffness, mass] = [k, m].map(SymmetricRows::new);
    let problem = AssembledProblem {
        stiffness,
        mass,
        factor,
    };
    search_modes(&problem, settings)
}

/// The lowest natural modes of a problem that tells its products and solves; none where the wanted range holds none.
///
/// Memory: 3 count + 4 block vectors for the basis, half of it again at a restart. The start vectors are fixed, so
/// the result is the same in every run up to the rounding of parallel sums.
///
/// # Errors
/// [`FeError::ModeCount`], [`FeError::ModesNotConverged`].
pub fn search_modes(
    problem: &impl ModeProblem,
    settings: &ModeSettings,
) -> Result<NaturalModes, FeError> {
    let n = problem.size();
    if let WantedModes::Lowest(found) = settings.wanted
        && (found == 0 || found > n)
    {
        return Err(FeError::ModeCount { found, unknowns: n });
    }
    let shift = settings.shift_rad2_per_s2;
    let block = settings.block.max(1);
    let mut basis = LanczosBasis::new(n);
    basis.append(problem.start(block.min(n)), problem, None);
    let (mut solves, mut restarts) = (0, 0);
    loop {
        solves += basis.grow(block, problem);
        let failed = |converged, wanted| FeError::ModesNotConverged {
            converged,
            wanted,
            restarts,
        };
        let ritz = basis.ritz().ok_or_else(|| failed(0, 1))?;
        let [wanted, needed] = settings.wanted.among(&ritz.theta, shift, n);
        let converged = ritz.residuals.iter().take(needed);
        let converged = converged.filter(|r| **r <= settings.tolerance).count();
        if converged == needed {
            let shapes = basis.vectors(&ritz, wanted);
            let mut modes = NaturalModes::new(problem, shift, shapes, &ritz.theta);
            modes.krylov_residuals = ritz.residuals[..wanted].to_vec();
            (modes.solves, modes.restarts) = (solves, restarts);
            return Ok(modes);
        }
        let kept = needed + block;
        let full = basis.len >= 3 * kept;
        let exhausted = basis.processed == basis.len;
        if exhausted || (full && restarts == settings.restarts) {
            return Err(failed(converged, needed));
        }
        if full {
            basis.restart(&ritz, kept);
            restarts += 1;
        }
    }
}
