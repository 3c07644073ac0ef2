//! What a root crack adds to the compliance between slices: C_ab += Σ_k φ_k(a) φ_k(b), rows by tooth, as a crack sits on one.
//!
//! The rows of the model are combined to slices as the compliance is: along the axis once, along the profile at each place.

use crate::axial_spread::AxialSpread;
use crate::placed_slice::PlacedSlice;
use crate::roll_shares::{RollPlace, SHARES};
use crate::station_blocks::LineBlock;
use gearmesh_model::{FlankGrid, RootCrack};

/// Slices whose rows are combined before they are used, so that most pairs of slices cost three products a row.
const CHUNK: usize = 8;

/// Rows of a crack for the slices of one gear.
#[derive(Debug, Clone)]
pub struct CrackRows {
    rows: usize,
    slices: usize,
    stations: usize,
    /// `[tooth][row][station][slice]` \[√(m/N)\].
    values: Vec<f64>,
}

impl CrackRows {
    /// Combines the rows of a model to its slices.
    #[must_use]
    pub fn new(crack: &RootCrack, teeth: usize, grid: &FlankGrid, spread: &AxialSpread) -> Self {
        let (stations, slices) = (grid.roll_angles_rad.len(), spread.slices());
        let loads = grid.len();
        let rows = crack.count(teeth, loads);
        let mut values = Vec::with_capacity(teeth * rows * stations * slices);
        for tooth in 0..teeth {
            for row in 0..rows {
                let own = &crack.rows[(row * teeth + tooth) * loads..][..loads];
                for k in 0..stations * slices {
                    let shares = spread.shares(k % slices).iter();
                    let terms = shares.map(|&(i, share)| share * own[grid.load(k / slices, i)]);
                    values.push(terms.sum());
                }
            }
        }
        Self {
            rows,
            slices,
            stations,
            values,
        }
    }

    /// Σ w_s φ(s, slice) of one row on a tooth with the four weights of a place.
    fn at(
        &self,
        (tooth, row): (usize, usize),
        first: usize,
        w: &[f64; SHARES],
        slice: usize,
    ) -> f64 {
        let start = (tooth * self.rows + row) * self.stations;
        let last = self.stations - 1;
        (w.iter().enumerate())
            .map(|(k, share)| {
                share * self.values[(start + (first + k).min(last)) * self.slices + slice]
            })
            .sum()
    }

    /// Between two lines, added to `out`, `[slice of a][slice of b]`.
    pub fn add(
        &self,
        (tooth_a, a): (usize, &RollPlace),
        (tooth_b, b): (usize, &RollPlace),
        out: &mut [f64],
    ) {
        for row in 0..self.rows {
            for (i, along) in out.chunks_exact_mut(self.slices).enumerate() {
                let phi_a = self.at((tooth_a, row), a.first(), a.all_shares(), i);
                for (j, place) in along.iter_mut().enumerate() {
                    *place += phi_a * self.at((tooth_b, row), b.first(), b.all_shares(), j);
                }
            }
        }
    }

    /// As [`Self::add`] with the derivatives by the roll angles of both lines.
    pub fn add_with_rates(
        &self,
        (tooth_a, a): (usize, &RollPlace),
        (tooth_b, b): (usize, &RollPlace),
        out: &mut LineBlock,
    ) {
        let n = self.slices;
        let (mut phi_b, mut rate_b) = ([0.0; CHUNK], [0.0; CHUNK]);
        for row in 0..self.rows {
            for first in (0..n).step_by(CHUNK) {
                let count = CHUNK.min(n - first);
                for j in 0..count {
                    let slice = first + j;
                    phi_b[j] = self.at((tooth_b, row), b.first(), b.all_shares(), slice);
                    rate_b[j] = self.at((tooth_b, row), b.first(), b.all_rates(), slice);
                }
                for i in 0..n {
                    let phi_a = self.at((tooth_a, row), a.first(), a.all_shares(), i);
                    let rate_a = self.at((tooth_a, row), a.first(), a.all_rates(), i);
                    for j in 0..count {
                        let place = i * n + first + j;
                        out.value[place] += phi_a * phi_b[j];
                        out.by_a[place] += rate_a * phi_b[j];
                        out.by_b[place] += phi_a * rate_b[j];
                    }
                }
            }
        }
    }

    /// Between two slices, each at its own place \[m/N\].
    #[must_use]
    pub fn between(&self, a: &PlacedSlice, b: &PlacedSlice) -> f64 {
        self.sum(a, a.place.all_shares(), b)
    }

    /// Derivative of [`Self::between`] by the roll angle of `a` \[m/(N·rad)\]; of a slice with itself half of what its compliance changes by.
    #[must_use]
    pub fn between_rate(&self, a: &PlacedSlice, b: &PlacedSlice) -> f64 {
        self.sum(a, a.place.all_rates(), b)
    }

    /// Σ over the rows with weights of the stations on the side of `a`.
    fn sum(&self, a: &PlacedSlice, w: &[f64; SHARES], b: &PlacedSlice) -> f64 {
        let shares = b.place.all_shares();
        (0..self.rows)
            .map(|row| {
                self.at((a.tooth, row), a.place.first(), w, a.slice)
                    * self.at((b.tooth, row), b.place.first(), shares, b.slice)
            })
            .sum()
    }
}
