//! Compliance between the roll stations of two flanks, and its combination to two contact lines.
//!
//! ```text
//! C_ab = Σ_s Σ_t w_s w_t T_st            ∂C_ab/∂ξ_a = Σ_s Σ_t w′_s w_t T_st,   ∂C_ab/∂ξ_b = Σ_s Σ_t w_s w′_t T_st
//! ```
//!
//! T_st is the slices × slices block of station s of one flank with station t of the other, w the four shares of a line's place. All
//! blocks lie in one piece each, so that the innermost loops run along memory: this is the dearest part of a mesh's evaluation.

use crate::roll_shares::{RollPlace, SHARES};

/// Blocks of all pairs of flanks.
#[derive(Debug, Clone)]
pub struct StationBlocks {
    stations: usize,
    /// Entries of one block.
    size: usize,
    /// `[pair of flanks][station a][station b][slice a][slice b]` \[m/N\].
    values: Vec<f64>,
}

/// C of two lines, and how it changes with the roll angle of each \[m/N, m/(N rad)\].
#[derive(Debug, Clone, Default)]
pub struct LineBlock {
    /// `[slice of a][slice of b]`.
    pub value: Vec<f64>,
    /// ∂/∂ξ_a.
    pub by_a: Vec<f64>,
    /// ∂/∂ξ_b.
    pub by_b: Vec<f64>,
}

impl LineBlock {
    /// For lines of so many slices.
    #[must_use]
    pub fn new(slices: usize) -> Self {
        let zeros = || vec![0.0; slices * slices];
        Self {
            value: zeros(),
            by_a: zeros(),
            by_b: zeros(),
        }
    }
}

impl StationBlocks {
    /// Empty, for flanks with so many stations and slices; then one [`Self::push`] for each pair of flanks.
    #[must_use]
    pub fn new(stations: usize, slices: usize, pairs: usize) -> Self {
        let size = slices * slices;
        Self {
            stations,
            size,
            values: Vec::with_capacity(pairs * stations * stations * size),
        }
    }

    /// Appends a pair of flanks by its entries (station a, slice a, station b, slice b).
    pub fn push(&mut self, slices: usize, entry: impl Fn([usize; 2], [usize; 2]) -> f64) {
        for a in 0..self.stations {
            for b in 0..self.stations {
                for i in 0..slices {
                    self.values
                        .extend((0..slices).map(|j| entry([a, i], [b, j])));
                }
            }
        }
    }

    /// T of two stations of a pair of flanks, `[slice a][slice b]`.
    #[must_use]
    pub fn block(&self, pair: usize, station_a: usize, station_b: usize) -> &[f64] {
        let number = (pair * self.stations + station_a) * self.stations + station_b;
        &self.values[number * self.size..][..self.size]
    }

    /// Blocks of station a with the stations that share a force at place b; stations that do not exist have no share.
    fn row(&self, pair: usize, station_a: usize, b: &RollPlace) -> [&[f64]; SHARES] {
        let last = self.stations - 1;
        std::array::from_fn(|k| self.block(pair, station_a, (b.first() + k).min(last)))
    }

    /// C_ab, added to `out`.
    pub fn add(&self, pair: usize, a: &RollPlace, b: &RollPlace, out: &mut [f64]) {
        let w = b.all_shares();
        for (station, share) in a.shares() {
            let [t0, t1, t2, t3] = self.row(pair, station, b);
            let along = out.iter_mut().zip(t0).zip(t1).zip(t2).zip(t3);
            for ((((place, t0), t1), t2), t3) in along {
                *place += share * (w[0] * t0 + w[1] * t1 + w[2] * t2 + w[3] * t3);
            }
        }
    }

    /// C_aa of a line with itself, and half of its change with the line's roll angle in `by_a`, added to `out`.
    pub fn add_own_with_rates(&self, pair: usize, a: &RollPlace, out: &mut LineBlock) {
        let (w, r) = (a.all_shares(), a.all_rates());
        let n = self.size;
        let (value, by_a) = (&mut out.value[..n], &mut out.by_a[..n]);
        for k in 0..SHARES.min(self.stations) {
            let [t0, t1, t2, t3] = self.row(pair, a.first() + k, a);
            let (t0, t1, t2, t3) = (&t0[..n], &t1[..n], &t2[..n], &t3[..n]);
            for i in 0..n {
                let along = w[0] * t0[i] + w[1] * t1[i] + w[2] * t2[i] + w[3] * t3[i];
                value[i] += w[k] * along;
                by_a[i] += r[k] * along;
            }
        }
    }

    /// C_ab of two lines and its changes, added to `out`.
    pub fn add_with_rates(&self, pair: usize, a: &RollPlace, b: &RollPlace, out: &mut LineBlock) {
        let (w, r) = (b.all_shares(), b.all_rates());
        let n = self.size;
        let (value, by_a, by_b) = (&mut out.value[..n], &mut out.by_a[..n], &mut out.by_b[..n]);
        for k in 0..SHARES.min(self.stations) {
            let (share, rate) = (a.all_shares()[k], a.all_rates()[k]);
            let [t0, t1, t2, t3] = self.row(pair, a.first() + k, b);
            let (t0, t1, t2, t3) = (&t0[..n], &t1[..n], &t2[..n], &t3[..n]);
            for i in 0..n {
                let along = w[0] * t0[i] + w[1] * t1[i] + w[2] * t2[i] + w[3] * t3[i];
                let change = r[0] * t0[i] + r[1] * t1[i] + r[2] * t2[i] + r[3] * t3[i];
                value[i] += share * along;
                by_a[i] += rate * along;
                by_b[i] += share * change;
            }
        }
    }
}
