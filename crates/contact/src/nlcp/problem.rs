//! The data of one complementarity problem, checked once and borrowed.

use super::{LocalLaw, NlcpError};

/// Squared relative tolerance of the symmetry and definiteness checks.
///
/// A condensed compliance is symmetric to the rounding of its factorisation, about 1e-12; 1e-9 of
/// `sqrt(C_ii C_jj)` lets that pass and still catches a transposed block.
const SYMMETRY_TOLERANCE_SQUARED: f64 = 1e-18;

/// The data of `g = C F + δ(F) + e − x w` and of the balance `bᵀF = T` (symbols in the module documentation).
#[derive(Debug, Clone, Copy)]
pub struct Problem<'a> {
    pub(super) compliance: &'a [f64],
    pub(super) local: &'a [LocalLaw],
    pub(super) separation: &'a [f64],
    pub(super) closing: &'a [f64],
    pub(super) lever: &'a [f64],
}

impl<'a> Problem<'a> {
    /// Checks and keeps the data of `n` slices.
    ///
    /// - `compliance`: `C`, n × n, in rows or columns (symmetric) \[m/N\]
    /// - `local`: `δ_i`
    /// - `separation`: `e_i`, open positive \[m\]
    /// - `closing`: `w_i > 0`, normally 1
    /// - `lever`: `b_i > 0` \[m\]
    ///
    /// Takes O(n²) comparisons and no memory.
    ///
    /// # Errors
    /// [`NlcpError`] if lengths differ, a value is not finite, `w` or `b` is not positive, or `C` is not symmetric or
    /// has an entry too large for a positive semi-definite matrix.
    pub fn new(
        compliance: &'a [f64],
        local: &'a [LocalLaw],
        separation: &'a [f64],
        closing: &'a [f64],
        lever: &'a [f64],
    ) -> Result<Self, NlcpError> {
        let problem = Self::of_sizes(compliance, local, separation, (closing, lever))?;
        problem.check_symmetry()?;
        Ok(problem)
    }

    /// The same with a matrix whose entries were written twice, which is symmetric by that: of each pair one is
    /// looked at.
    pub(crate) fn of_symmetric(
        compliance: &'a [f64],
        local: &'a [LocalLaw],
        separation: &'a [f64],
        (closing, lever): (&'a [f64], &'a [f64]),
    ) -> Result<Self, NlcpError> {
        let problem = Self::of_sizes(compliance, local, separation, (closing, lever))?;
        match problem.is_bounded() {
            true => Ok(problem),
            // Says where.
            false => problem.check_symmetry().map(|()| problem),
        }
    }

    fn of_sizes(
        compliance: &'a [f64],
        local: &'a [LocalLaw],
        separation: &'a [f64],
        (closing, lever): (&'a [f64], &'a [f64]),
    ) -> Result<Self, NlcpError> {
        let n = separation.len();
        for (what, found, expected) in [
            ("the compliance matrix", compliance.len(), n * n),
            ("the list of local laws", local.len(), n),
            ("the list of closing rates w", closing.len(), n),
            ("the list of lever arms b", lever.len(), n),
        ] {
            if found != expected {
                return Err(NlcpError::Shape {
                    what,
                    found,
                    expected,
                });
            }
        }
        for slice in 0..n {
            let value = separation[slice];
            if !value.is_finite() {
                return Err(NlcpError::NotFinite {
                    what: "the separation e",
                    slice,
                    found: value,
                });
            }
            require_positive("the closing rate w", slice, closing[slice])?;
            require_positive("the lever arm b", slice, lever[slice])?;
            let diagonal = compliance[slice * n + slice];
            if !diagonal.is_finite() {
                return Err(NlcpError::NotFinite {
                    what: "the own compliance",
                    slice,
                    found: diagonal,
                });
            }
            if diagonal < 0.0 {
                return Err(NlcpError::NotPositive {
                    what: "the own compliance",
                    slice,
                    found: diagonal,
                });
            }
        }
        Ok(Problem {
            compliance,
            local,
            separation,
            closing,
            lever,
        })
    }

    /// Number of slices.
    pub fn size(&self) -> usize {
        self.separation.len()
    }

    /// The approach \[m\] at which the first slice touches, `min e_i/w_i`; infinite without slices.
    pub fn first_contact(&self) -> f64 {
        self.separation
            .iter()
            .zip(self.closing)
            .map(|(e, w)| e / w)
            .fold(f64::INFINITY, f64::min)
    }

    /// Whether no entry is too large for a positive semi-definite matrix, looked for below the diagonal.
    fn is_bounded(&self) -> bool {
        let n = self.size();
        // So many entries of the diagonal side by side: the comparison runs in every step of a simulation.
        let mut diagonal = [0.0; 64];
        (0..n).step_by(diagonal.len()).all(|first| {
            for (own, entry) in
                (diagonal.iter_mut()).zip(self.compliance.iter().step_by(n + 1).skip(first))
            {
                *own = *entry;
            }
            (first + 1..n).all(|row| {
                let entries = &self.compliance[row * n..][..=row];
                let bound = entries[row] * (1.0 + 1e-9);
                let pairs = entries[first..row].iter().zip(&diagonal);
                pairs.fold(true, |all, (entry, other)| {
                    all & (entry * entry <= bound * other)
                })
            })
        })
    }

    fn check_symmetry(&self) -> Result<(), NlcpError> {
        let n = self.size();
        for row in 1..n {
            let entries = &self.compliance[row * n..][..n];
            let own = entries[row];
            // NaN fails both comparisons.
            let good = |column: usize, other: &[f64]| {
                let (entry, skew) = (entries[column], entries[column] - other[row]);
                let bound_squared = own * other[column];
                (skew * skew <= SYMMETRY_TOLERANCE_SQUARED * bound_squared)
                    & (entry * entry <= bound_squared * (1.0 + 1e-9))
            };
            let above = self.compliance.chunks_exact(n).take(row).enumerate();
            // No branch inside: this runs in every step of a simulation.
            if above
                .clone()
                .fold(true, |all, (column, other)| all & good(column, other))
            {
                continue;
            }
            for (column, other) in above {
                if !good(column, other) {
                    let bound = (own * other[column]).sqrt();
                    let (entry, mirrored) = (entries[column], other[row]);
                    return Err(NlcpError::NotSemiDefinite {
                        row,
                        column,
                        entry,
                        mirrored,
                        bound,
                    });
                }
            }
        }
        Ok(())
    }
}

fn require_positive(what: &'static str, slice: usize, found: f64) -> Result<(), NlcpError> {
    if !found.is_finite() {
        return Err(NlcpError::NotFinite { what, slice, found });
    }
    if found <= 0.0 {
        return Err(NlcpError::NotPositive { what, slice, found });
    }
    Ok(())
}
