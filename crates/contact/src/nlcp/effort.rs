//! What a solve has cost so far.

use super::ldl::Shifted;
use super::{NlcpError, Problem, Workspace};

/// Effort of the solve so far.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Effort {
    pub(super) iterations: usize,
    pub(super) factorisations: usize,
    pub(super) shifts: usize,
}

impl Effort {
    /// Factors the active block and counts it.
    pub(super) fn factor(
        &mut self,
        work: &mut Workspace,
        problem: &Problem,
    ) -> Result<(), NlcpError> {
        self.factorisations += 1;
        if work.factor_active(problem)? == Shifted::Yes {
            self.shifts += 1;
        }
        Ok(())
    }
}
