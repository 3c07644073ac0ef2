//! A ball that is larger or smaller than the others.
//!
//! Its approach to both races grows by half of what it is larger; its mass grows with the cube. The stiffness of its
//! contacts is kept: it changes by a share of about ΔD/D.

use crate::groove::Groove;

/// A ball of another size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OffSizeBall {
    /// ΔD; negative: smaller \[m\].
    pub oversize_m: f64,
}

impl OffSizeBall {
    /// The groove as it is for this ball: r − (D + ΔD)/2.
    pub(crate) fn apply(&self, groove: &mut Groove) {
        groove.arm_m -= 0.5 * self.oversize_m;
    }

    /// Its mass over that of the others.
    pub(crate) fn mass_ratio(&self, ball_diameter_m: f64) -> f64 {
        (1.0 + self.oversize_m / ball_diameter_m).powi(3)
    }
}
