//! What a root crack adds to the compliance between slices: C_ab += Σ_k φ_k(a) φ_k(b), rows by tooth, as a crack sits
//! on one.
//!
//! The rows of the model are combined to slices as the compliance is: along the tooth once, along the profile at each
//! place.

use crate::axial_spread::AxialSpread;
use crate::placed_slice::ToothPlace;
use crate::profile_shares::SHARES;
use crate::station_blocks::Coupling;
use gearmesh_model::{FlankGrid, RootCrack};

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

    /// Σ w_s φ(s, slice) of one row with weights of the stations at a place.
    fn at(&self, at: &ToothPlace, slice: usize, row: usize, weights: &[f64; SHARES]) -> f64 {
        let start = (at.tooth * self.rows + row) * self.stations;
        let last = self.stations - 1;
        (weights.iter().enumerate())
            .map(|(k, share)| {
                let station = (at.place.first() + k).min(last);
                share * self.values[(start + station) * self.slices + slice]
            })
            .sum()
    }

    /// Between two slices, each at its own place \[m/N\].
    #[must_use]
    pub fn between(&self, places: [&ToothPlace; 2], slices: [usize; 2]) -> Coupling {
        let mut sum = Coupling::default();
        for row in 0..self.rows {
            let [(of_a, rate_a), (of_b, rate_b)] = [0, 1].map(|k: usize| {
                let of = |weights| self.at(places[k], slices[k], row, weights);
                let place = &places[k].place;
                (of(place.all_shares()), of(place.all_rates()))
            });
            sum.value += of_a * of_b;
            sum.by_a += rate_a * of_b;
            sum.by_b += of_a * rate_b;
        }
        sum
    }
}
