//! Settings of a solve.

use super::NlcpError;

/// Settings of a solve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// Largest accepted relative residual (norm in the module documentation), no unit.
    ///
    /// Default 1e-10, sensible range 1e-13 to 1e-6. The iteration is quadratic at its end, so that most solves end
    /// near 1e-15; below 1e-13 the rounding of long rows may stand in the way.
    pub tolerance: f64,
    /// Newton corrections of the active set method before the descent takes over. Default 60; a warm solve needs 1
    /// to 4.
    pub max_corrections: usize,
}

impl Default for Params {
    fn default() -> Self {
        Params {
            tolerance: 1e-10,
            max_corrections: 60,
        }
    }
}

impl Params {
    pub(super) fn check(&self) -> Result<(), NlcpError> {
        if self.tolerance > 0.0 {
            Ok(())
        } else {
            Err(NlcpError::Tolerance {
                found: self.tolerance,
            })
        }
    }
}
