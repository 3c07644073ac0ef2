//! Errors and faults of single flanks, beside the microgeometry that all teeth have.

use crate::contact_patch::ContactPatch;
use gearmesh_geometry::Flank;
use gearmesh_geometry::flank_error::{FlankError, FlankPoint};
use std::fmt;
use std::sync::Arc;

/// Errors and faults of gear 1 and gear 2.
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

    /// How far they open the gap of a patch on flanks of this side \[m\], along the normal; infinite where one of the
    /// flanks is not there. What is removed from a tip edge opens the gap by its component, cos δ.
    #[must_use]
    pub fn opening_m(&self, patch: &ContactPatch, side: Flank) -> f64 {
        let of_gear = |gear: usize| {
            let at = FlankPoint {
                tooth: patch.teeth[gear],
                side,
                roll_rad: patch.places[gear].u,
                z_m: patch.places[gear].v,
            };
            let removed = |error: &Arc<dyn FlankError>| error.removed(at).depth_m;
            let depth: f64 = self.of_gears[gear].iter().map(removed).sum();
            patch.tilt_rad(gear).cos() * depth
        };
        of_gear(0) + of_gear(1)
    }
}
