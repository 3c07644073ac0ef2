//! Compliance between all slices at a place of one flank and all slices at a place of another one.
//!
//! ```text
//! C_ij = Σ_s Σ_t w_s w_t T_st,ij      ∂C_ij/∂u_a = Σ_s Σ_t w′_s w_t T_st,ij,   ∂C_ij/∂u_b = Σ_s Σ_t w_s w′_t T_st,ij
//! ```
//!
//! The same as in `station_blocks.rs`, for flanks of different meshes, where all slices of both places are wanted: T of
//! two stations and all slices lies in one piece, so that one weight goes for a row of numbers side by side.

use std::sync::{Arc, OnceLock};

use crate::profile_shares::{ProfilePlace, SHARES};
use crate::station_blocks::StationBlocks;

/// Rows are so many numbers long, or a multiple of it: what a processor sums up side by side.
const LANES: usize = 8;

/// T, `[pair of flanks][station a][station b][slice a, slice b]`, rows of slices filled up with zeros \[m/N\].
#[derive(Debug, Clone)]
pub struct PlaceBlocks {
    /// Of the second flank.
    slices: usize,
    stride: usize,
    /// Length of a row.
    row: usize,
    values: Values,
}

#[derive(Debug, Clone)]
enum Values {
    /// Of all pairs at once.
    All(Vec<f64>),
    /// Of a pair when it is asked for first.
    OnDemand(StationBlocks, Arc<Vec<OnceLock<Vec<f64>>>>),
}

/// C and how it changes with both places, `[slice a, slice b]`.
#[derive(Debug, Clone, Default)]
pub struct BetweenPlaces {
    /// C_ij \[m/N\].
    pub value: Vec<f64>,
    /// ∂C_ij/∂u_a \[m/N per u\].
    pub by_a: Vec<f64>,
    /// ∂C_ij/∂u_b.
    pub by_b: Vec<f64>,
    /// Σ_s w_s T_st and Σ_s w′_s T_st of four stations t.
    along: Vec<f64>,
}

impl PlaceBlocks {
    /// The same numbers in this order.
    #[must_use]
    pub fn new(blocks: StationBlocks) -> Self {
        let [of_a, of_b] = blocks.slices();
        let (stride, row) = (blocks.stride(), (of_a * of_b).next_multiple_of(LANES));
        let values = match blocks.known_pairs() {
            Some(pairs) => {
                let mut values = Vec::with_capacity(pairs * stride * stride * row);
                for pair in 0..pairs {
                    append(&mut values, blocks.values_of(pair), (stride, row));
                }
                Values::All(values)
            }
            None => {
                let pairs = (0..blocks.pairs()).map(|_| OnceLock::new()).collect();
                Values::OnDemand(blocks, Arc::new(pairs))
            }
        };
        Self {
            slices: of_b,
            stride,
            row,
            values,
        }
    }

    /// Place of slice a of the first flank and slice b of the second one in what is found.
    #[inline(always)]
    #[must_use]
    pub fn entry(&self, [a, b]: [usize; 2]) -> usize {
        a * self.slices + b
    }

    /// Combines all slices of a pair of flanks at two places.
    #[inline(always)]
    pub fn combine(&self, pair: usize, places: [&ProfilePlace; 2], found: &mut BetweenPlaces) {
        let size = self.stride * self.stride * self.row;
        let values = match &self.values {
            Values::All(values) => &values[pair * size..][..size],
            Values::OnDemand(blocks, pairs) => match pairs[pair].get() {
                Some(values) => &values[..size],
                None => self.asked_first(blocks, &pairs[pair], pair),
            },
        };
        let [a, b] = places;
        let first = a.first() * self.stride + b.first();
        let row = self.row;
        for known in [&mut found.value, &mut found.by_a, &mut found.by_b] {
            known.resize(row, 0.0);
        }
        found.along.resize(2 * SHARES * row, 0.0);
        let (along, changes) = found.along.split_at_mut(SHARES * row);
        let each = along
            .chunks_exact_mut(row)
            .zip(changes.chunks_exact_mut(row));
        for (t, (along, changes)) in each.enumerate() {
            let station = |s: usize| &values[(first + s * self.stride + t) * row..][..row];
            let stations = [station(0), station(1), station(2), station(3)];
            weigh(along, a.all_shares(), stations);
            weigh(changes, a.all_rates(), stations);
        }
        combine(&mut found.value, b.all_shares(), along);
        combine(&mut found.by_a, b.all_shares(), changes);
        combine(&mut found.by_b, b.all_rates(), along);
    }

    #[cold]
    fn asked_first<'a>(
        &self,
        blocks: &StationBlocks,
        known: &'a OnceLock<Vec<f64>>,
        pair: usize,
    ) -> &'a [f64] {
        known.get_or_init(|| {
            let mut values = Vec::new();
            let sizes = (self.stride, self.row);
            append(&mut values, blocks.values_of(pair), sizes);
            values
        })
    }
}

/// Σ_k w_k row_k, one after the other, as `station_blocks.rs` weighs the stations of the first flank.
#[inline(always)]
fn weigh(sum: &mut [f64], weights: &[f64; SHARES], rows: [&[f64]; SHARES]) {
    let [first, second, third, fourth] = rows;
    let pairs = first.iter().zip(second).zip(third.iter().zip(fourth));
    for (sum, ((a, b), (c, d))) in sum.iter_mut().zip(pairs) {
        *sum = ((weights[0] * a + weights[1] * b) + weights[2] * c) + weights[3] * d;
    }
}

/// The same by two pairs, as it combines those of the second flank.
#[inline(always)]
fn combine(sum: &mut [f64], weights: &[f64; SHARES], rows: &[f64]) {
    let n = sum.len();
    let (first, rest) = rows.split_at(n);
    let (second, rest) = rest.split_at(n);
    let (third, fourth) = rest.split_at(n);
    let pairs = first.iter().zip(second).zip(third.iter().zip(&fourth[..n]));
    for (sum, ((a, b), (c, d))) in sum.iter_mut().zip(pairs) {
        *sum = (weights[0] * a + weights[1] * b) + (weights[2] * c + weights[3] * d);
    }
}

/// Appends a pair of flanks, `[slices][stations]` of it known.
fn append(values: &mut Vec<f64>, known: &[f64], (stride, row): (usize, usize)) {
    let block = stride * stride;
    let slices = known.len() / block;
    for stations in 0..block {
        values.extend((0..slices).map(|slice| known[slice * block + stations]));
        values.resize(values.len() + row - slices, 0.0);
    }
}
