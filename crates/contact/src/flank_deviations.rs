//! What is removed from the flanks of two gears, at rest and in motion.

use crate::contact_patch::ContactPatch;
use gearmesh_geometry::Flank;
use gearmesh_geometry::flank_error::{FlankError, FlankPoint, Removed};
use std::fmt;
use std::sync::Arc;

/// Errors and faults of single flanks of gear 1 and gear 2, and in motion their microgeometry.
#[derive(Clone, Default)]
pub struct FlankDeviations {
    of_gears: [Vec<Arc<dyn FlankError>>; 2],
}

impl fmt::Debug for FlankDeviations {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let counts = self.of_gears.each_ref().map(Vec::len);
        formatter
            .debug_tuple("FlankDeviations")
            .field(&counts)
            .finish()
    }
}

impl FlankDeviations {
    /// The errors of both gears.
    #[must_use]
    pub fn new(of_gears: [Vec<Arc<dyn FlankError>>; 2]) -> Self {
        Self { of_gears }
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.of_gears.iter().all(Vec::is_empty)
    }

    /// Bound of what they add to both flanks together \[m\].
    #[must_use]
    pub fn most_added_m(&self) -> f64 {
        let of_gear = |errors: &Vec<Arc<dyn FlankError>>| {
            errors.iter().map(|e| e.most_added_m()).sum::<f64>()
        };
        self.of_gears.iter().map(of_gear).sum()
    }

    /// All that is removed at a point of gear 0 or 1.
    #[must_use]
    pub fn removed(&self, gear: usize, at: FlankPoint) -> Removed {
        let mut sum = Removed::default();
        for error in &self.of_gears[gear] {
            let removed = error.removed(at);
            sum.depth_m += removed.depth_m;
            sum.slope_m_per_rad += removed.slope_m_per_rad;
            sum.slope_along_axis += removed.slope_along_axis;
        }
        sum
    }

    /// How far they open the gap of a patch on flanks of these sides \[m\], along the normal; infinite where one of the
    /// flanks is not there. What is removed from a tip edge opens the gap by its component, cos δ.
    #[must_use]
    pub fn opening_m(&self, patch: &ContactPatch, sides: [Flank; 2]) -> f64 {
        let of_gear = |gear: usize| {
            let at = FlankPoint {
                tooth: patch.teeth[gear],
                side: sides[gear],
                roll_rad: patch.places[gear].u,
                z_m: patch.places[gear].v,
            };
            patch.tilt_rad(gear).cos() * self.removed(gear, at).depth_m
        };
        of_gear(0) + of_gear(1)
    }
}
