//! What the slices at two places on one gear deflect each other by.

use crate::crack_rows::CrackRows;
use crate::placed_slice::ToothPlace;
use crate::station_blocks::{CombinedBlocks, Coupling};
use crate::walked_slice::WalkedSlice;

/// Two places on one gear and what their slices deflect each other by.
#[derive(Debug, Clone, Copy)]
pub struct CoupledPlaces<'a> {
    pub(crate) blocks: CombinedBlocks<'a>,
    pub(crate) places: [&'a ToothPlace; 2],
    pub(crate) slices: usize,
    /// Whether anything comes to what the blocks say: `neighboured` or `crack`.
    pub(crate) has_more: bool,
    pub(crate) neighboured: bool,
    pub(crate) crack: Option<&'a CrackRows>,
}

impl CoupledPlaces<'_> {
    /// Φ_aᵀ C Φ_b of a slice at the first place and one at the second \[m/N\]; the calibrated correction's part between neighbours is
    /// included.
    #[inline]
    #[must_use]
    pub fn value(&self, slices: [usize; 2]) -> f64 {
        if let [Some(a), Some(b)] = self.walked() {
            return combined(&a.shares, &b.shares, [a, b], |slices| {
                self.at_middles(slices)
            });
        }
        self.at_middles(slices)
    }

    /// Where both stand along the tooth.
    #[inline]
    fn walked(&self) -> [Option<&WalkedSlice>; 2] {
        self.places.map(|place| place.walked.as_ref())
    }

    /// Of slices where they were laid.
    #[inline]
    fn at_middles(&self, slices: [usize; 2]) -> f64 {
        let whole = self.blocks.between(slices);
        if self.has_more {
            whole + self.more(slices).value
        } else {
            whole
        }
    }

    /// The same with its derivatives by both places.
    #[inline]
    #[must_use]
    pub fn coupling(&self, slices: [usize; 2]) -> Coupling {
        if let [Some(a), Some(b)] = self.walked() {
            let mut sum = Coupling::default();
            for (share_a, i) in a.shares.iter().zip(a.first..) {
                for (share_b, j) in b.shares.iter().zip(b.first..) {
                    let share = share_a * share_b;
                    let one = self.coupling_at_middles([i, j]);
                    sum += Coupling {
                        value: share * one.value,
                        by_a: share * one.by_a,
                        by_b: share * one.by_b,
                    };
                }
            }
            return sum;
        }
        self.coupling_at_middles(slices)
    }

    /// Derivatives by the places of both along the teeth \[m/N per m\]; zero where slices do not walk that way. Of a slice with
    /// itself half of what its compliance changes by.
    #[inline]
    #[must_use]
    pub fn along_teeth(&self) -> [f64; 2] {
        let [Some(a), Some(b)] = self.walked() else {
            return [0.0; 2];
        };
        let at = |slices| self.at_middles(slices);
        [
            combined(&a.rates, &b.shares, [a, b], at),
            combined(&a.shares, &b.rates, [a, b], at),
        ]
    }

    #[inline]
    fn coupling_at_middles(&self, slices: [usize; 2]) -> Coupling {
        let mut whole = self.blocks.between_with_rates(slices);
        if self.has_more {
            whole += self.more(slices);
        }
        whole
    }

    fn more(&self, slices: [usize; 2]) -> Coupling {
        let mut sum = Coupling::default();
        if self.neighboured {
            sum += self.shared(slices);
        }
        if let Some(crack) = self.crack {
            sum += crack.between(self.places, slices);
        }
        sum
    }

    /// The calibrated correction's part between two slices of one tooth: each slice gives its own term to both neighbours, and a neighbour
    /// gets the mean of the two slices' terms, so that a uniform load deflects as before.
    fn shared(&self, [a, b]: [usize; 2]) -> Coupling {
        let each = match a.abs_diff(b) {
            0 => {
                let beside = [a > 0, a + 1 < self.slices];
                -0.5 * beside.into_iter().filter(|exists| *exists).count() as f64
            }
            1 => 0.5,
            _ => return Coupling::default(),
        };
        let [at_a, at_b] = self.places.map(|place| place.shared);
        Coupling {
            value: each * (at_a.0 + at_b.0),
            by_a: each * at_a.1,
            by_b: each * at_b.1,
        }
    }
}

/// Σ_i Σ_j w_i w_j C_ij over the slices around two places.
#[inline]
fn combined(
    weights_a: &[f64; 3],
    weights_b: &[f64; 3],
    [a, b]: [&WalkedSlice; 2],
    at: impl Fn([usize; 2]) -> f64,
) -> f64 {
    let mut sum = 0.0;
    for (weight_a, i) in weights_a.iter().zip(a.first..) {
        for (weight_b, j) in weights_b.iter().zip(b.first..) {
            sum += weight_a * weight_b * at([i, j]);
        }
    }
    sum
}
