//! What the slices at two places on one gear deflect each other by.

use crate::crack_rows::CrackRows;
use crate::placed_slice::ToothPlace;
use crate::station_blocks::{CombinedBlocks, Coupling};
use crate::walked_slice::{SLICES, WalkedSlice};

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
    /// Φ_aᵀ C Φ_b of a slice at the first place and one at the second \[m/N\]; the calibrated correction's part
    /// between neighbours is included.
    #[inline(always)]
    #[must_use]
    pub fn value(&self, slices: [usize; 2]) -> f64 {
        let [Some(a), Some(b)] = self.walked() else {
            let whole = self.blocks.between(slices);
            return if self.has_more {
                whole + self.more(slices).value
            } else {
                whole
            };
        };
        let whole = self.blocks.around([a, b]);
        if self.has_more {
            whole + self.more_around((&a.shares, &b.shares), [a, b]).value
        } else {
            whole
        }
    }

    /// Where both stand along the tooth.
    #[inline(always)]
    fn walked(&self) -> [Option<&WalkedSlice>; 2] {
        let [a, b] = self.places;
        [a.walked.as_ref(), b.walked.as_ref()]
    }

    /// The same with its derivatives by both places up the flank, and by those along the teeth \[m/N per m\], which
    /// are zero where slices do not walk that way. Of a slice with itself each is half the derivative of its
    /// compliance.
    #[inline(always)]
    #[must_use]
    pub fn coupling(&self, slices: [usize; 2]) -> (Coupling, [f64; 2]) {
        let [Some(a), Some(b)] = self.walked() else {
            return (self.coupling_at_middles(slices), [0.0; 2]);
        };
        let (mut whole, mut along) = self.blocks.around_with_rates([a, b]);
        if self.has_more {
            whole += self.more_around((&a.shares, &b.shares), [a, b]);
            along[0] += self.more_around((&a.rates, &b.shares), [a, b]).value;
            along[1] += self.more_around((&a.shares, &b.rates), [a, b]).value;
        }
        (whole, along)
    }

    #[inline(always)]
    fn coupling_at_middles(&self, slices: [usize; 2]) -> Coupling {
        let mut whole = self.blocks.between_with_rates(slices);
        if self.has_more {
            whole += self.more(slices);
        }
        whole
    }

    #[inline(always)]
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

    /// The calibrated correction's part between two slices of one tooth: each slice gives its own term to both
    /// neighbours, and a neighbour gets the mean of the two slices' terms, so that a uniform load deflects as before.
    #[inline(always)]
    fn shared(&self, [a, b]: [usize; 2]) -> Coupling {
        let each = match a.abs_diff(b) {
            0 => {
                let beside = [a > 0, a + 1 < self.slices];
                -0.5 * beside.into_iter().filter(|exists| *exists).count() as f64
            }
            1 => 0.5,
            _ => return Coupling::default(),
        };
        let (at_a, at_b) = (self.places[0].shared, self.places[1].shared);
        Coupling {
            value: each * (at_a.0 + at_b.0),
            by_a: each * at_a.1,
            by_b: each * at_b.1,
        }
    }

    /// Σ_i Σ_j w_i w_j of [`Self::more`] over the slices around two places.
    #[inline(always)]
    fn more_around(
        &self,
        (weights_a, weights_b): (&[f64; SLICES], &[f64; SLICES]),
        [a, b]: [&WalkedSlice; 2],
    ) -> Coupling {
        let mut sum = Coupling::default();
        // Of slices farther apart none are neighbours.
        if self.crack.is_none() && a.first.abs_diff(b.first) > SLICES {
            return sum;
        }
        for (weight_a, i) in weights_a.iter().zip(a.first..) {
            for (weight_b, j) in weights_b.iter().zip(b.first..) {
                let (weight, one) = (weight_a * weight_b, self.more([i, j]));
                sum += Coupling {
                    value: weight * one.value,
                    by_a: weight * one.by_a,
                    by_b: weight * one.by_b,
                };
            }
        }
        sum
    }
}
