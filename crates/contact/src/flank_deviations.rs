//! Errors and faults of single flanks, beside the microgeometry that all teeth have.

use crate::contact_lines::ContactLine;
use gearmesh_geometry::FlankSide;
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

    /// How far they open the gap of a line's section \[m\], along the normal; infinite where one of the flanks is not
    /// there. What is removed from a tip edge opens the gap by its component, cos δ. `heights_m` are the section's
    /// places from the gears' own mid-faces.
    #[must_use]
    pub fn opening_m(&self, line: &ContactLine, side: FlankSide, heights_m: [f64; 2]) -> f64 {
        let places = [
            (line.tooth_1, line.roll_1_rad, heights_m[0]),
            (line.tooth_2, line.roll_2_rad, heights_m[1]),
        ];
        let of_gear = |gear: usize| {
            let (tooth, roll_rad, z_m) = places[gear];
            let at = FlankPoint {
                tooth,
                side,
                roll_rad,
                z_m,
            };
            let removed = |error: &Arc<dyn FlankError>| error.removed(at).depth_m;
            let depth: f64 = self.of_gears[gear].iter().map(removed).sum();
            line.tilt_rad(gear).cos() * depth
        };
        of_gear(0) + of_gear(1)
    }
}
