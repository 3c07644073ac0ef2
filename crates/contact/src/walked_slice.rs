//! A slice that stands beside its own middle along the tooth: its force as shares of itself and its neighbours.
//!
//! Of slices of width w at k − 1, k, k + 1 that stand shifted by τ w from k, Lagrange's weights
//!
//! ```text
//! τ(τ − 1)/2,   1 − τ²,   τ(τ + 1)/2
//! ```
//!
//! keep the force, its first moment τ and its second one τ²: what is smooth along the tooth is read as it is at the
//! place. At the ends of the tooth the three slices are those nearest to the end.

/// Slices that share a force.
pub(crate) const SLICES: usize = 3;

/// How far a slice may stand from its own middle, in widths; beyond, the place is held.
const FARTHEST: f64 = 1.5;

/// Shares of the slices around a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WalkedSlice {
    /// First of the slices.
    pub first: usize,
    /// Their shares.
    pub shares: [f64; SLICES],
    /// Derivatives of the shares by the place along the tooth \[1/m\].
    pub rates: [f64; SLICES],
}

impl WalkedSlice {
    /// Slice number `slice` of `slices`, at least three, of `width_m`; its middle at `shift_m` from where it was laid.
    pub(crate) fn new(slice: usize, slices: usize, shift_m: f64, width_m: f64) -> Self {
        let first = slice.saturating_sub(1).min(slices - SLICES);
        let stated = shift_m / width_m;
        let held = stated.clamp(-FARTHEST, FARTHEST);
        let moves = if held == stated { 1.0 / width_m } else { 0.0 };
        // From the middle one of the three.
        let tau = held + slice as f64 - (first + 1) as f64;
        Self {
            first,
            shares: [
                0.5 * tau * (tau - 1.0),
                1.0 - tau * tau,
                0.5 * tau * (tau + 1.0),
            ],
            rates: [tau - 0.5, -2.0 * tau, tau + 0.5].map(|rate| rate * moves),
        }
    }
}

/// Slices of gear 2 that stand where their patches are along its teeth: gear 1's slices are even on its face, and both
/// faces end together at the heel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SliceWalk {
    slices: usize,
    face_m: f64,
    face_1_m: f64,
}

impl SliceWalk {
    /// So many slices over a face of `face_m`, as many as gear 1 has over its face of `face_1_m`; none where there are
    /// too few to share a force.
    #[must_use]
    pub fn new(slices: usize, face_m: f64, face_1_m: f64) -> Option<Self> {
        let walk = Self {
            slices,
            face_m,
            face_1_m,
        };
        (slices >= SLICES).then_some(walk)
    }

    /// Where a slice stands whose patch is at v from the middle of the face \[m\].
    #[must_use]
    pub fn at(&self, slice: usize, v_m: f64) -> WalkedSlice {
        let count = self.slices as f64;
        let width_m = self.face_m / count;
        // The slice here that is nearest to where it lies.
        let lies_m = 0.5 * self.face_m - self.face_1_m * (1.0 - (slice as f64 + 0.5) / count);
        let nearest = (lies_m / width_m + 0.5 * count).max(0.0) as usize;
        let nearest = nearest.min(self.slices - 1);
        let laid_m = (nearest as f64 + 0.5) * width_m - 0.5 * self.face_m;
        WalkedSlice::new(nearest, self.slices, v_m - laid_m, width_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_keep_force_and_moments_and_have_their_slopes() {
        for slice in 0..6 {
            for shift in [-0.9, -0.2, 0.0, 0.3, 1.2] {
                let at = |shift: f64| WalkedSlice::new(slice, 6, shift * 2.0, 2.0);
                let here = at(shift);
                let place = slice as f64 + shift;
                for power in 0..3 {
                    let numbers = here.shares.iter().zip(here.first..);
                    let moment: f64 = numbers.map(|(w, k)| w * (k as f64).powi(power)).sum();
                    assert!((moment - place.powi(power)).abs() < 1e-12);
                }
                let (below, above) = (at(shift - 1e-6), at(shift + 1e-6));
                for k in 0..SLICES {
                    let slope = (above.shares[k] - below.shares[k]) / 4e-6;
                    assert!((slope - here.rates[k]).abs() < 1e-8);
                }
            }
        }
    }
}
