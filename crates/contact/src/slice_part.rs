//! The part of a slice of helical teeth that is on the rigid path of contact: between the slice's edges and the places
//! where a flank ends.
//!
//! Places run along the axes. Each comes with its derivatives by N numbers, at rest none, at a pose the six increments.

use nalgebra::SVector;

/// Share of a slice below which it counts as off the path, or beside the mate's face. No unit. Its force falls with the
/// share, so that this is the jump that is left, a hundred-thousandth of a slice's force; far below, the floor of the
/// local law's logarithm would reach its cap.
pub const LEAST_SHARE: f64 = 1e-5;

/// A number and its derivatives.
pub type WithGradient<const N: usize> = (f64, SVector<f64, N>);

/// Where the part begins and ends \[m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlicePart<const N: usize> {
    /// The lower end.
    pub low: WithGradient<N>,
    /// The upper end.
    pub high: WithGradient<N>,
}

impl<const N: usize> SlicePart<N> {
    /// Ends the part at a place: nothing above it is on the path, or nothing below it.
    pub fn end_at(&mut self, place: WithGradient<N>, nothing_above: bool) {
        if nothing_above && place.0 < self.high.0 {
            self.high = place;
        } else if !nothing_above && place.0 > self.low.0 {
            self.low = place;
        }
    }

    /// Its share of a slice of this width \[m\]; negative where nothing of it is on the path.
    #[must_use]
    pub fn share(&self, width_m: f64) -> WithGradient<N> {
        let (low, high) = (&self.low, &self.high);
        ((high.0 - low.0) / width_m, (high.1 - low.1) / width_m)
    }

    /// Its middle \[m\].
    #[must_use]
    pub fn middle(&self) -> WithGradient<N> {
        let (low, high) = (&self.low, &self.high);
        (0.5 * (low.0 + high.0), 0.5 * (low.1 + high.1))
    }
}
