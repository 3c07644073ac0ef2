//! Compliance of patches that have hardly moved since it was computed, as the iterates of one step ask for it: to the
//! first order of where they stand.
//!
//! ```text
//! C_ij ≈ C⁰_ij + X_ij + X_ji        X_ij = Σ_gears ∂_i C_ij δu_i + ∂C_ij/∂v_i δv_i
//! ```
//!
//! Between stations the compliance is smooth, and its slope changes by some times itself over a flank or a slice: moves
//! of at most [`FARTHEST_U`] and [`FARTHEST_SLICES`] leave out 1e-8 of it, 1e-13 m of teeth that deflect by 10 µm. A
//! patch that has come over a station is not near any more. Rates between patches that carry are computed where they
//! stand, as always.

use super::compliance::{Filling, Part};
use super::{Elastic, Run, SliceContact};
use crate::contact_error::ContactError;
use crate::contact_patch::ContactPatch;
use crate::local_contact::LocalContact;

/// How far a patch may have moved up a flank, as a share of it.
const FARTHEST_U: f64 = 5e-5;
/// How far along the tooth, in widths of a slice.
const FARTHEST_SLICES: f64 = 5e-4;

/// Where a patch stood on one gear.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Stood {
    u: f64,
    v: f64,
}

/// A patch and where it stood.
#[derive(Debug, Clone, Copy)]
struct KeptPatch {
    teeth: [usize; 2],
    slice: usize,
    stood: [Stood; 2],
    /// Its station up the flank, and the first of the slices around it, of both gears.
    cells: [(usize, Option<usize>); 2],
}

impl KeptPatch {
    fn new(patch: &ContactPatch, run: &Run) -> Self {
        Self {
            teeth: patch.teeth,
            slice: patch.slice,
            stood: [0, 1].map(|gear: usize| Stood {
                u: patch.places[gear].u,
                v: patch.places[gear].v,
            }),
            cells: [0, 1].map(|gear: usize| {
                let place = &run.places[gear];
                (place.place.station, place.walked.map(|walked| walked.first))
            }),
        }
    }

    /// Moves of u and of v on both gears since, if they are small.
    fn moved_to(&self, other: &Self, slice_width_m: f64) -> Option<[[f64; 2]; 2]> {
        let is_same = self.teeth == other.teeth && self.slice == other.slice;
        let moves = [0, 1].map(|gear: usize| {
            let (old, new) = (&self.stood[gear], &other.stood[gear]);
            [new.u - old.u, new.v - old.v]
        });
        let is_near = |[by_u, by_v]: &[f64; 2]| {
            by_u.abs() <= FARTHEST_U && by_v.abs() <= FARTHEST_SLICES * slice_width_m
        };
        (is_same && self.cells == other.cells && moves.iter().all(is_near)).then_some(moves)
    }
}

/// Compliance of patches, and where they stood.
#[derive(Debug, Clone, Default)]
pub(super) struct KeptCompliance {
    patches: Vec<KeptPatch>,
    c: Vec<f64>,
    /// As the fields of [`SliceContact`] of the same names.
    rates: [Vec<f64>; 2],
    along: [Vec<f64>; 2],
    /// Moves of all patches since, `[patch][gear][u, v]`.
    moves: Vec<[[f64; 2]; 2]>,
}

impl KeptCompliance {
    /// Memory for so many patches.
    pub(super) fn with_capacity(patches: usize) -> Self {
        Self {
            patches: Vec::with_capacity(patches),
            c: Vec::with_capacity(patches * patches),
            rates: [0, 1].map(|_| Vec::with_capacity(patches * patches)),
            along: [0, 1].map(|_| Vec::with_capacity(patches * patches)),
            moves: Vec::with_capacity(patches),
        }
    }

    /// Takes the moves of patches from where they stood; `false` if these are other ones, or have moved far.
    fn follow(&mut self, patches: impl ExactSizeIterator<Item = KeptPatch>, width_m: f64) -> bool {
        self.moves.clear();
        if self.patches.is_empty() || patches.len() != self.patches.len() {
            return false;
        }
        let pairs = self.patches.iter().zip(patches);
        let moves = pairs.map_while(|(old, new)| old.moved_to(&new, width_m));
        self.moves.extend(moves);
        self.moves.len() == self.patches.len()
    }
}

/// What is known of the rates of the patches that were prepared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum RatesOfPatches {
    Unasked,
    /// Asked for: a solve ends with [`SliceContact::fill_rates`].
    Asked,
    Known,
}

impl SliceContact {
    /// As [`Self::prepare`] with rates, for patches at which [`Self::prepare_nearby`] may follow: all rates are
    /// computed, also those that nobody feels here.
    ///
    /// # Errors
    /// As [`Self::prepare`].
    pub fn prepare_to_keep(
        &mut self,
        patches: &[ContactPatch],
        floor_n: f64,
    ) -> Result<(), ContactError> {
        if !self.can_keep() {
            return self.prepare(patches, floor_n, true);
        }
        self.take(patches, floor_n, true)?;
        self.fill_with_rates();
        self.divide_by_shares();
        self.kept.patches.clear();
        let kept = patches.iter().zip(&self.runs);
        self.kept
            .patches
            .extend(kept.map(|(patch, run)| KeptPatch::new(patch, run)));
        let size = patches.len() * patches.len();
        let keep = |kept: &mut Vec<f64>, values: &[f64]| {
            kept.clear();
            kept.extend_from_slice(&values[..size.min(values.len())]);
        };
        keep(&mut self.kept.c, &self.c);
        for gear in 0..2 {
            keep(&mut self.kept.rates[gear], &self.rates[gear]);
            keep(&mut self.kept.along[gear], &self.along[gear]);
        }
        self.rates_of_patches = RatesOfPatches::Known;
        Ok(())
    }

    /// The same for patches next to the last ones of [`Self::prepare_to_keep`], from whose compliance; of others as
    /// that does. Returns whether they are next to them: the forces of the last solve are then a good start.
    ///
    /// # Errors
    /// As [`Self::prepare`].
    pub fn prepare_nearby(
        &mut self,
        patches: &[ContactPatch],
        floor_n: f64,
    ) -> Result<bool, ContactError> {
        if !self.can_keep() || patches.len() != self.kept.patches.len() {
            self.prepare_to_keep(patches, floor_n)?;
            return Ok(false);
        }
        self.take(patches, floor_n, true)?;
        let now = patches.iter().zip(&self.runs);
        let now = now.map(|(patch, run)| KeptPatch::new(patch, run));
        if !self.kept.follow(now, self.layout.width_m()) {
            self.prepare_to_keep(patches, floor_n)?;
            return Ok(false);
        }
        self.fill_from_kept();
        self.divide_by_shares();
        Ok(true)
    }

    /// Forgets what [`Self::prepare_to_keep`] has kept.
    pub fn forget_kept(&mut self) {
        self.kept.patches.clear();
    }

    /// Whether each patch has a place of its own, and a compliance that no share divides.
    fn can_keep(&self) -> bool {
        matches!(self.elastic, Elastic::Reduced(_))
            && !self.shares_places()
            && self.local_contact != LocalContact::None
    }

    /// C and all its rates.
    fn fill_with_rates(&mut self) {
        self.arch.dispatch(Filling(Part::WithRates, self));
    }

    #[inline(always)]
    pub(super) fn fill_pairs_with_rates(&mut self) {
        let Elastic::Reduced(flanks) = &self.elastic else {
            return;
        };
        let [flank_1, flank_2] = flanks;
        let n = self.slice.len();
        let [rates_1, rates_2] = &mut self.rates;
        for (i, a) in self.runs.iter().enumerate() {
            for (j, b) in self.runs.iter().enumerate().skip(i) {
                let on_1 = flank_1.between(&a.places[0], &b.places[0]);
                let on_2 = flank_2.between(&a.places[1], &b.places[1]);
                let slices = [self.slice[i], self.slice[j]];
                let (here, across) = (i * n + j, j * n + i);
                let (of_1, along_1) = on_1.coupling(slices);
                let (of_2, along_2) = on_2.coupling(slices);
                let value = of_1.value + of_2.value;
                self.c[across] = value;
                self.c[here] = value;
                rates_1[across] = of_1.by_b;
                rates_1[here] = of_1.by_a;
                rates_2[across] = of_2.by_b;
                rates_2[here] = of_2.by_a;
                for (along, [by_a, by_b]) in self.along.iter_mut().zip([along_1, along_2]) {
                    if !along.is_empty() {
                        along[across] = by_b;
                        along[here] = by_a;
                    }
                }
            }
        }
    }

    /// C from the kept one and the moves.
    fn fill_from_kept(&mut self) {
        let n = self.slice.len();
        let c = &mut self.c[..n * n];
        for (i, (row, moves)) in c.chunks_exact_mut(n).zip(&self.kept.moves).enumerate() {
            let [rates_1, rates_2] = [0, 1].map(|gear: usize| &self.kept.rates[gear][i * n..][..n]);
            let [[by_1, _], [by_2, _]] = moves;
            for ((x, rate_1), rate_2) in row.iter_mut().zip(rates_1).zip(rates_2) {
                *x = rate_1 * by_1 + rate_2 * by_2;
            }
            for (along, [_, by]) in self.kept.along.iter().zip(moves) {
                if !along.is_empty() {
                    for (x, rate) in row.iter_mut().zip(&along[i * n..][..n]) {
                        *x += rate * by;
                    }
                }
            }
        }
        for i in 0..n {
            for j in i..n {
                let (here, across) = (i * n + j, j * n + i);
                let value = self.kept.c[here] + (c[here] + c[across]);
                c[here] = value;
                c[across] = value;
            }
        }
    }
}
