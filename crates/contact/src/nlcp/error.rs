//! What can go wrong in setting up or solving the complementarity problem.

use thiserror::Error;

/// Error of [`Problem::new`](super::Problem::new), [`solve_position`](super::solve_position) and
/// [`solve_load`](super::solve_load).
#[derive(Debug, Clone, PartialEq, Error)]
pub enum NlcpError {
    /// An input array has the wrong length.
    #[error(
        "{what} has {found} entries, {expected} are needed for this number of slices: pass arrays of one size"
    )]
    Shape {
        /// Name of the array.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The length that the number of slices asks for.
        expected: usize,
    },
    /// The problem has more slices than the workspace was made for.
    #[error(
        "{size} slices do not fit a workspace made for {capacity}: make it with Workspace::new({size})"
    )]
    TooLarge {
        /// Slices of the problem.
        size: usize,
        /// Slices the workspace holds.
        capacity: usize,
    },
    /// An input is NaN or infinite.
    #[error("{what} of slice {slice} is {found}; it must be a finite number")]
    NotFinite {
        /// Name of the input.
        what: &'static str,
        /// Slice (row).
        slice: usize,
        /// The value.
        found: f64,
    },
    /// An input that must be positive is not.
    #[error("{what} of slice {slice} is {found}; it must be positive")]
    NotPositive {
        /// Name of the input.
        what: &'static str,
        /// Slice.
        slice: usize,
        /// The value.
        found: f64,
    },
    /// The compliance matrix is not symmetric, or an off-diagonal entry is too large for a positive semi-definite one.
    #[error(
        "compliance C[{row}][{column}] = {entry} m/N and C[{column}][{row}] = {mirrored} m/N; they must be equal and \
         at most sqrt(C_ii C_jj) = {bound} m/N: check how the matrix was condensed"
    )]
    NotSemiDefinite {
        /// Row of the entry.
        row: usize,
        /// Column of the entry.
        column: usize,
        /// The entry \[m/N\].
        entry: f64,
        /// The mirrored entry \[m/N\].
        mirrored: f64,
        /// Largest magnitude that a positive semi-definite matrix allows \[m/N\].
        bound: f64,
    },
    /// The approach is NaN or infinite.
    #[error("the approach is {found} m; it must be a finite number")]
    Approach {
        /// The value \[m\].
        found: f64,
    },
    /// The load is negative or not finite.
    #[error(
        "the load is {found} N m; it must be zero or positive: turn the sign convention or load the other flank"
    )]
    Load {
        /// The value \[N·m\].
        found: f64,
    },
    /// The tolerance is not a positive number.
    #[error("the tolerance is {found}; it must be a positive number, 1e-10 is the default")]
    Tolerance {
        /// The value.
        found: f64,
    },
    /// A load was given to a problem without slices.
    #[error("a load of {load} N m cannot be carried by a problem without slices")]
    NoSlices {
        /// The load \[N·m\].
        load: f64,
    },
    /// The stiffness of the slices in contact does not exist: `C + diag δ'` has a negative pivot, or it vanishes.
    #[error(
        "the compliance of the slices in contact is not positive definite: pivot {pivot} m/N at slice {slice} whose \
         own compliance is {diagonal} m/N; check the compliance matrix and that each local law keeps it positive"
    )]
    NotPositiveDefinite {
        /// Slice of the pivot.
        slice: usize,
        /// The pivot \[m/N\].
        pivot: f64,
        /// Diagonal entry before elimination \[m/N\].
        diagonal: f64,
    },
    /// Neither the active set nor the descent reached the tolerance.
    #[error(
        "no convergence after {iterations} iterations: relative residual {residual:.3e}, allowed {tolerance:.3e}, \
         {active} of {size} slices in contact; check the scales of compliance, separations and load"
    )]
    NoConvergence {
        /// Newton corrections made.
        iterations: usize,
        /// Relative residual reached (module documentation).
        residual: f64,
        /// Relative residual asked for.
        tolerance: f64,
        /// Slices in contact at the end.
        active: usize,
        /// Slices of the problem.
        size: usize,
    },
}
