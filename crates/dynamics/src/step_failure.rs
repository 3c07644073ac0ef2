//! Why a step was given up, and what may be done about it.

use crate::error::DynamicsError;

/// See [`StepFailure::leeway`].
const LEEWAY: u64 = 100;

/// Why a step was given up.
#[derive(Debug)]
pub(crate) enum StepFailure {
    NoConvergence {
        iterations: usize,
        ratio: f64,
        largest: usize,
    },
    Singular,
    /// What an evaluation at one of its iterates reported.
    Element(DynamicsError),
}

impl StepFailure {
    /// After so many iterations, with what is left over what is allowed, most of it at a degree of freedom.
    pub(crate) fn no_convergence(iterations: usize, ratio: f64, largest: usize) -> Self {
        Self::NoConvergence {
            iterations,
            ratio,
            largest,
        }
    }

    /// Whether iterates that went another way, or a shorter step, may do without it: they did not converge, or went
    /// where an element cannot follow.
    pub(crate) fn is_of_the_way(&self) -> bool {
        matches!(
            self,
            Self::NoConvergence { .. } | Self::Element(DynamicsError::Element { .. })
        )
    }

    /// Steps that count as made where it is judged whether such failures are rare: a start out of balance may go beyond
    /// what an element covers some times.
    pub(crate) fn leeway(&self) -> u64 {
        match self {
            Self::Element(_) => LEEWAY,
            _ => 0,
        }
    }
}
