//! What a result of a multibody scene holds.

use std::fmt;

use gearmesh_model::Named;

/// Kind of a result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ResultKind {
    /// A motion in time.
    #[default]
    Transient,
    /// A motion whose speed was varied, measured in windows.
    SpeedSweep,
    /// Equilibria.
    Static,
    /// Natural frequencies.
    Eigen,
}

impl ResultKind {
    /// Whether time goes on in it.
    pub fn is_in_time(self) -> bool {
        matches!(self, Self::Transient | Self::SpeedSweep)
    }
}

impl Named for ResultKind {
    const NAMES: &'static [(Self, &'static str)] = &[
        (Self::Transient, "transient"),
        (Self::SpeedSweep, "speed-sweep"),
        (Self::Static, "static"),
        (Self::Eigen, "eigen"),
    ];
}

impl fmt::Display for ResultKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name_in_files())
    }
}
