//! Compliance between the stations of two flanks, and its combination to two slices, each at its own place.
//!
//! ```text
//! C_ab = Σ_s Σ_t w_s w_t T_st            ∂C_ab/∂u_a = Σ_s Σ_t w′_s w_t T_st,   ∂C_ab/∂u_b = Σ_s Σ_t w_s w′_t T_st
//! ```
//!
//! T_st belongs to station s of slice a of one flank and station t of slice b of another one, w are the four shares of
//! a place. All T of two slices lie in one piece, station by station, so that a combination reads four short stretches
//! of memory: this is the dearest part of a contact.

use crate::profile_shares::{ProfilePlace, SHARES};
use crate::walked_slice::WalkedSlice;
use gearmesh_model::HubPatterns;
use std::sync::{Arc, OnceLock};

/// C of two slices, and how it changes with the place of each \[m/N, m/N per u\].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Coupling {
    /// C_ab.
    pub value: f64,
    /// ∂C_ab/∂u_a. Of a slice with itself both places move, and this is half the derivative of its compliance.
    pub by_a: f64,
    /// ∂/∂u_b.
    pub by_b: f64,
}

impl std::ops::AddAssign for Coupling {
    fn add_assign(&mut self, other: Self) {
        self.value += other.value;
        self.by_a += other.by_a;
        self.by_b += other.by_b;
    }
}

/// T of all slices of all pairs of flanks.
#[derive(Debug, Clone)]
pub struct StationBlocks {
    /// Of the first flank of a pair and of the second.
    slices: [usize; 2],
    stations: usize,
    /// Stations and, where they are fewer than the shares of a place, as many zeros more.
    stride: usize,
    values: Values,
}

/// T, `[pair of flanks][slice a][slice b][station a][station b]` \[m/N\].
#[derive(Debug, Clone)]
enum Values {
    /// Of all pairs at once.
    All(Vec<f64>),
    /// Of a pair when it is asked for first.
    OnDemand(Arc<OnDemand>),
}

/// Flanks of a body that does not repeat: of the thousands of pairs of its teeth a run touches neighbours only.
#[derive(Debug)]
struct OnDemand {
    /// Of the loads (station, slice) of the first flank, then of the second where that is another one.
    patterns: HubPatterns,
    /// First loads of both flanks.
    first: [usize; 2],
    teeth: usize,
    pairs: Vec<OnceLock<Vec<f64>>>,
}

impl StationBlocks {
    /// Empty, for flanks with so many stations, the first and the second of a pair with so many slices; then one
    /// [`Self::push`] for each pair of flanks.
    #[must_use]
    pub fn new(stations: usize, slices: [usize; 2], pairs: usize) -> Self {
        let stride = stations.max(SHARES);
        Self {
            slices,
            stations,
            stride,
            values: Values::All(Vec::with_capacity(
                pairs * slices[0] * slices[1] * stride * stride,
            )),
        }
    }

    /// Of a body's patterns, combined to its stations and slices, each pair `[tooth][response tooth]` when it is asked
    /// for first. `first`: where the loads of the first and the second flank begin among those of the patterns.
    #[must_use]
    pub fn of_patterns(
        stations: usize,
        slices: [usize; 2],
        (patterns, first): (HubPatterns, [usize; 2]),
        teeth: usize,
    ) -> Self {
        let pairs = (0..teeth * teeth).map(|_| OnceLock::new()).collect();
        Self {
            values: Values::OnDemand(Arc::new(OnDemand {
                patterns,
                first,
                teeth,
                pairs,
            })),
            ..Self::new(stations, slices, 0)
        }
    }

    /// Appends a pair of flanks by its entries (station a, slice a), (station b, slice b).
    pub fn push(&mut self, entry: impl Fn([usize; 2], [usize; 2]) -> f64) {
        let layout = (self.slices, self.stations, self.stride);
        if let Values::All(values) = &mut self.values {
            append(values, layout, entry);
        }
    }

    /// Slices of the first and of the second flank.
    pub(crate) fn slices(&self) -> [usize; 2] {
        self.slices
    }

    /// Stations of a pair, with zeros that fill them up.
    pub(crate) fn stride(&self) -> usize {
        self.stride
    }

    /// Number of pairs of flanks.
    pub(crate) fn pairs(&self) -> usize {
        match &self.values {
            Values::All(values) => values.len() / self.size_of_pair(),
            Values::OnDemand(found) => found.pairs.len(),
        }
    }

    /// The same where all are known.
    pub(crate) fn known_pairs(&self) -> Option<usize> {
        matches!(self.values, Values::All(_)).then(|| self.pairs())
    }

    fn size_of_pair(&self) -> usize {
        self.slices[0] * self.slices[1] * self.stride * self.stride
    }

    /// All T of a pair of flanks, `[slice a][slice b][station a][station b]`.
    #[inline(always)]
    pub(crate) fn values_of(&self, pair: usize) -> &[f64] {
        let size = self.size_of_pair();
        match &self.values {
            Values::All(values) => &values[pair * size..(pair + 1) * size],
            Values::OnDemand(found) => match found.pairs[pair].get() {
                Some(values) => values,
                None => self.asked_first(found, pair),
            },
        }
    }

    /// Combines the slices of two flanks of a pair of flanks at two places.
    #[inline(always)]
    #[must_use]
    pub fn at<'a>(&'a self, pair: usize, places: [&'a ProfilePlace; 2]) -> CombinedBlocks<'a> {
        let first = places[0].first() * self.stride + places[1].first();
        let values = self.values_of(pair);
        CombinedBlocks {
            values: &values[first..],
            slices: self.slices[1],
            stride: self.stride,
            places,
        }
    }

    #[cold]
    fn asked_first<'a>(&self, found: &'a OnDemand, pair: usize) -> &'a [f64] {
        found.pairs[pair].get_or_init(|| {
            let [of_a, of_b] = self.slices;
            let sizes = self.slices.map(|slices| self.stations * slices);
            let teeth = [pair / found.teeth, pair % found.teeth];
            let block = found.patterns.block(teeth, found.first, sizes);
            let mut values = Vec::new();
            append(
                &mut values,
                (self.slices, self.stations, self.stride),
                |[a, i], [b, j]| block[(a * of_a + i) * sizes[1] + b * of_b + j],
            );
            values
        })
    }
}

/// Appends a pair of flanks; stations beyond those that exist are zeros.
fn append(
    values: &mut Vec<f64>,
    (slices, stations, stride): ([usize; 2], usize, usize),
    entry: impl Fn([usize; 2], [usize; 2]) -> f64,
) {
    for (i, j) in (0..slices[0]).flat_map(|i| (0..slices[1]).map(move |j| (i, j))) {
        for (a, b) in (0..stride).flat_map(|a| (0..stride).map(move |b| (a, b))) {
            let exists = a < stations && b < stations;
            values.push(if exists { entry([a, i], [b, j]) } else { 0.0 });
        }
    }
}

/// T of two flanks as two places combine it.
#[derive(Debug, Clone, Copy)]
pub struct CombinedBlocks<'a> {
    /// From the first entry that is needed on.
    values: &'a [f64],
    /// Of the second flank.
    slices: usize,
    stride: usize,
    places: [&'a ProfilePlace; 2],
}

impl CombinedBlocks<'_> {
    /// The four rows of four entries of slice a on the first flank and slice b on the second one.
    #[inline(always)]
    fn rows(&self, [a, b]: [usize; 2]) -> [&[f64; SHARES]; SHARES] {
        let first = (a * self.slices + b) * self.stride * self.stride;
        let entries = &self.values[first..][..(SHARES - 1) * self.stride + SHARES];
        // Not `from_fn`, nor `map` below: calls that the loops around them cannot take in.
        let stride = self.stride;
        [
            row(entries, 0),
            row(entries, stride),
            row(entries, 2 * stride),
            row(entries, 3 * stride),
        ]
    }

    /// C of slice a of the first flank and slice b of the second one.
    #[inline(always)]
    #[must_use]
    pub fn between(&self, slices: [usize; 2]) -> f64 {
        let rows = self.rows(slices);
        dot(
            &weighted(&rows, self.places[0].all_shares()),
            self.places[1].all_shares(),
        )
    }

    /// The same with its changes.
    #[inline(always)]
    #[must_use]
    pub fn between_with_rates(&self, slices: [usize; 2]) -> Coupling {
        let rows = self.rows(slices);
        let [a, b] = self.places;
        let along = weighted(&rows, a.all_shares());
        let changes = weighted(&rows, a.all_rates());
        Coupling {
            value: dot(&along, b.all_shares()),
            by_a: dot(&changes, b.all_shares()),
            by_b: dot(&along, b.all_rates()),
        }
    }
}

/// Slices that stand beside their own middles along the tooth: Σ_i Σ_j w_i w_j C_ij over those around both places.
impl CombinedBlocks<'_> {
    /// C.
    #[inline(always)]
    #[must_use]
    pub(crate) fn around(&self, [a, b]: [&WalkedSlice; 2]) -> f64 {
        let own = self.places[0].all_shares();
        let mut sum = [0.0; SHARES];
        for (share_a, i) in a.shares.iter().zip(a.first..) {
            for (share_b, j) in b.shares.iter().zip(b.first..) {
                add(
                    &mut sum,
                    share_a * share_b,
                    &weighted(&self.rows([i, j]), own),
                );
            }
        }
        dot(&sum, self.places[1].all_shares())
    }

    /// The same with its changes by u, and by the places of both along the teeth \[m/N per m\].
    #[inline(always)]
    #[must_use]
    pub(crate) fn around_with_rates(&self, [a, b]: [&WalkedSlice; 2]) -> (Coupling, [f64; 2]) {
        let [own, turned] = [self.places[0].all_shares(), self.places[0].all_rates()];
        let (mut here, mut by_a) = ([0.0; SHARES], [0.0; SHARES]);
        let mut along = [[0.0; SHARES]; 2];
        for (k, i) in (a.first..).take(a.shares.len()).enumerate() {
            for (l, j) in (b.first..).take(b.shares.len()).enumerate() {
                let rows = self.rows([i, j]);
                let row = weighted(&rows, own);
                let share = a.shares[k] * b.shares[l];
                add(&mut here, share, &row);
                add(&mut along[0], a.rates[k] * b.shares[l], &row);
                add(&mut along[1], a.shares[k] * b.rates[l], &row);
                add(&mut by_a, share, &weighted(&rows, turned));
            }
        }
        let [shares, rates] = [self.places[1].all_shares(), self.places[1].all_rates()];
        let coupling = Coupling {
            value: dot(&here, shares),
            by_a: dot(&by_a, shares),
            by_b: dot(&here, rates),
        };
        (coupling, [dot(&along[0], shares), dot(&along[1], shares)])
    }
}

/// The row that begins at an entry.
#[inline(always)]
fn row(entries: &[f64], first: usize) -> &[f64; SHARES] {
    entries[first..].first_chunk().unwrap_or(&[0.0; SHARES])
}

/// Adds a multiple of a row.
#[inline(always)]
fn add(sum: &mut [f64; SHARES], weight: f64, row: &[f64; SHARES]) {
    for (place, value) in sum.iter_mut().zip(row) {
        *place += weight * value;
    }
}

/// Σ_k w_k row_k.
#[inline(always)]
fn weighted(rows: &[&[f64; SHARES]; SHARES], weights: &[f64; SHARES]) -> [f64; SHARES] {
    let mut sum = [0.0; SHARES];
    for (row, weight) in rows.iter().zip(weights) {
        for (place, value) in sum.iter_mut().zip(*row) {
            *place += weight * value;
        }
    }
    sum
}

#[inline(always)]
fn dot(a: &[f64; SHARES], b: &[f64; SHARES]) -> f64 {
    (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3])
}
