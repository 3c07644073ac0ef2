//! Compliance between slices on contact lines, from the compliance between unit loads on the flank grid.
//!
//! A slice force at roll angle ξ is a combination Φ of grid loads. Along the axis its shares ([`AxialSpread`]) make it
//! nearly a uniform load on the slice, and equal slice forces an exactly uniform line load. Along the profile the nearest
//! stations share the force so that its first two moments are kept ([`RollHats`]). C = Φᵀ C_grid Φ as a whole.
//! The axial part of Φ does not depend on the position and is applied once, when the model is loaded.

use crate::axial_spread::AxialSpread;
use crate::calibrated_field::CalibratedField;
use crate::crack_rows::CrackRows;
use crate::local_contact::{CompliancePart, LocalContact, effective_depth_m};
use crate::placed_slice::PlacedSlice;
use crate::roll_shares::{RollHats, RollPlace, SHARES};
use crate::slice_spread::NeighbourTerm;
use crate::station_blocks::{LineBlock, StationBlocks};
use gearmesh_model::{Flank, ReducedGear, ReducedGearError};
use std::f64::consts::PI;

/// Slice compliance of one gear for loads on one hand of flank.
#[derive(Debug, Clone)]
pub struct SliceCompliance {
    teeth: usize,
    teeth_per_sector: usize,
    slices: usize,
    hats: RollHats,
    opposite_distance_m: Vec<f64>,
    /// Pairs of flanks: `[tooth in sector][response tooth]`.
    blocks: StationBlocks,
    /// Of the flank in contact; only where the local contact is calibrated.
    near_field: Option<CalibratedField>,
    /// What neighbouring slices of one contact line share of the calibrated correction \[m/N\], at the roll stations and
    /// half-way between; empty where there is none.
    spread: Vec<f64>,
    /// What a crack adds; none where the gear has none that loads on this flank open.
    crack: Option<CrackRows>,
    young_pa: f64,
    poisson: f64,
    slice_width_m: f64,
}

/// Depth of the local logarithm on one flank, and how it grows as the contact moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalDepth {
    /// h \[m\].
    pub depth_m: f64,
    /// ∂(ln h)/∂ξ \[1/rad\].
    pub growth_by_roll: f64,
    /// ∂(ln h)/∂(share of the width).
    pub growth_by_share: f64,
}

impl SliceCompliance {
    /// Condenses a reduced gear to its own slices.
    ///
    /// # Errors
    /// As [`Self::on_slices`].
    pub fn new(
        gear: &ReducedGear,
        flank: Flank,
        local: LocalContact,
    ) -> Result<Self, ReducedGearError> {
        Self::on_slices(gear, flank, local, &AxialSpread::own(gear))
    }

    /// Condenses a reduced gear to slices that lie anywhere on its face.
    ///
    /// # Errors
    /// [`ReducedGearError::FlankNotReduced`] when the model carries no loads on `flank`,
    /// [`ReducedGearError::NotCalibrated`] when `local` is calibrated and the model is not.
    pub fn on_slices(
        gear: &ReducedGear,
        flank: Flank,
        local: LocalContact,
        spread: &AxialSpread,
    ) -> Result<Self, ReducedGearError> {
        let flank_index = gear.flank_index(flank)?;
        let near_field = match local {
            LocalContact::Calibrated => Some(CalibratedField::new(gear, flank_index)?),
            LocalContact::None | LocalContact::WeberBanaschek => None,
        };
        let grid = &gear.grid;
        let (stations, slices) = (grid.roll_angles_rad.len(), spread.slices());
        let loads = grid.len();
        let size = stations * slices;
        let own = gear.teeth_per_sector();
        let mut blocks = StationBlocks::new(stations, slices, own * gear.teeth);
        let mut condensed = vec![0.0; size * size];
        // Loads and shares of each (station, slice).
        let axial: Vec<Vec<(usize, f64)>> = (0..size)
            .map(|k| {
                let shares = spread.shares(k % slices).iter();
                shares
                    .map(|&(i, share)| (grid.load(k / slices, i), share))
                    .collect()
            })
            .collect();
        let mut loaded = vec![0.0; loads];
        for tooth in 0..own {
            for other in 0..gear.teeth {
                let block = match local.part() {
                    CompliancePart::Patterns => gear.c_g_block(tooth, flank, other, flank),
                    CompliancePart::Hub => gear.c_hub_block(tooth, flank, other, flank).into(),
                };
                for (row, responses) in axial.iter().zip(condensed.chunks_exact_mut(size)) {
                    // First the loads, then the responses: each entry of the block is used a few times only.
                    loaded.fill(0.0);
                    for &(l, share) in row {
                        for (sum, c) in loaded.iter_mut().zip(&block[l * loads..][..loads]) {
                            *sum += share * c;
                        }
                    }
                    for (response, column) in responses.iter_mut().zip(&axial) {
                        *response = column.iter().map(|&(m, share)| share * loaded[m]).sum();
                    }
                }
                blocks.push(slices, |[a, i], [b, j]| {
                    condensed[(a * slices + i) * size + b * slices + j]
                });
            }
        }
        let slice_width_m = spread.width_m();
        let hats = RollHats::new(&grid.roll_angles_rad);
        let k = 2.0 * (1.0 - gear.poisson * gear.poisson) / (PI * gear.young_pa);
        // A single slice has no neighbours.
        let neighboured = near_field.as_ref().filter(|_| slices > 1);
        let to_neighbours = neighboured.map_or(Vec::new(), |field| {
            let own_width_m = gear.face_width_m / grid.slices as f64;
            let neighbours = NeighbourTerm::new(own_width_m / slice_width_m);
            let opposite_m = gear.opposite_distances_m(flank);
            // Hats are stiffer at a station than between two, where the load is shared.
            (0..2 * stations - 1)
                .map(|half| {
                    let station = (half / 2).min(stations - 2);
                    let share = 0.5 * half as f64 - station as f64;
                    let c = hats.centroids_rad();
                    let roll = (1.0 - share) * c[station] + share * c[station + 1];
                    let place = hats.place(roll);
                    let missing = field.missing(roll, &place, 1.0).value;
                    let sizes = (opposite_m[half.div_ceil(2)], slice_width_m);
                    let term = neighbours.at(k, missing, field.half_width_m, sizes);
                    term.min(largest_neighbour_term(&blocks, slices, &place))
                })
                .collect()
        });
        Ok(Self {
            teeth: gear.teeth,
            teeth_per_sector: own,
            slices,
            hats,
            opposite_distance_m: gear.opposite_distances_m(flank).to_vec(),
            blocks,
            near_field,
            spread: to_neighbours,
            crack: (gear.crack_for(flank))
                .map(|crack| CrackRows::new(crack, gear.teeth, grid, spread)),
            young_pa: gear.young_pa,
            poisson: gear.poisson,
            slice_width_m,
        })
    }

    /// Number of slices.
    pub fn slices(&self) -> usize {
        self.slices
    }

    /// Number of teeth.
    pub fn teeth(&self) -> usize {
        self.teeth
    }

    /// Width of a slice \[m\].
    pub fn slice_width_m(&self) -> f64 {
        self.slice_width_m
    }

    /// Young's modulus \[Pa\] and Poisson's ratio.
    pub fn material(&self) -> (f64, f64) {
        (self.young_pa, self.poisson)
    }

    /// Where a roll angle lies between the stations.
    pub fn place(&self, roll_rad: f64) -> RollPlace {
        self.hats.place(roll_rad)
    }

    /// Depth h \[m\] of the local logarithm at a roll angle: effective where the model is calibrated, else the distance
    /// to the opposite side.
    ///
    /// A slice that touches over a share of its width only (helical teeth, at the ends of the path) has the line load
    /// q = F/(share b_s), but its hats still spread F over the whole slice: the calibration then adds
    /// q (c₀ − share w_h − k ln(a/a₀)). With the share the force goes to zero, as it must.
    pub fn local_depth_m(&self, roll_rad: f64, share: f64) -> f64 {
        self.local_depth(roll_rad, &self.place(roll_rad), share)
            .depth_m
    }

    /// [`Self::local_depth_m`] at a roll angle whose place is known, and how it changes.
    pub fn local_depth(&self, roll_rad: f64, place: &RollPlace, share: f64) -> LocalDepth {
        let Some(field) = &self.near_field else {
            let (low, high) = (
                self.opposite_distance_m[place.station],
                self.opposite_distance_m[place.station + 1],
            );
            let inside = place.share.clamp(0.0, 1.0);
            let depth = (1.0 - inside) * low + inside * high;
            let slope = if inside == place.share {
                (high - low) / self.spacing_rad(place.station)
            } else {
                0.0
            };
            return LocalDepth {
                depth_m: depth,
                growth_by_roll: slope / depth,
                growth_by_share: 0.0,
            };
        };
        let missing = field.missing(roll_rad, place, share);
        let k = 2.0 * (1.0 - self.poisson * self.poisson) / (PI * self.young_pa);
        LocalDepth {
            depth_m: effective_depth_m(missing.value, field.half_width_m, self.material()),
            growth_by_roll: missing.by_roll / k,
            growth_by_share: missing.by_share / k,
        }
    }

    /// Distance of the centroids of a station's hat and the next one's \[rad\].
    fn spacing_rad(&self, station: usize) -> f64 {
        let c = self.hats.centroids_rad();
        c[station + 1] - c[station]
    }

    /// Number of the block of two flanks.
    fn pair(&self, tooth_a: usize, tooth_b: usize) -> usize {
        let tooth = tooth_a % self.teeth_per_sector;
        let response = (tooth_b + self.teeth - (tooth_a - tooth)) % self.teeth;
        tooth * self.teeth + response
    }

    /// Φᵀ C Φ between the slices of two contact lines, into `out`, `[slice of a][slice of b]`. On one and the same line the calibrated
    /// correction's part between neighbours is included.
    pub fn line_block(
        &self,
        (tooth_a, place_a): (usize, &RollPlace),
        (tooth_b, place_b): (usize, &RollPlace),
        out: &mut [f64],
    ) {
        out.fill(0.0);
        (self.blocks).add(self.pair(tooth_a, tooth_b), place_a, place_b, out);
        if tooth_a == tooth_b && !self.spread.is_empty() {
            add_spread(out, self.slices, self.spread_at(place_a).0);
        }
        if let Some(crack) = &self.crack {
            crack.add((tooth_a, place_a), (tooth_b, place_b), out);
        }
    }

    /// [`Self::line_block`] with its derivatives by the roll angles of both lines; on one and the same line `by_a` is half of what the
    /// block changes by, and `by_b` has no meaning.
    pub fn line_block_with_rates(
        &self,
        (tooth_a, place_a): (usize, &RollPlace),
        (tooth_b, place_b): (usize, &RollPlace),
        out: &mut LineBlock,
    ) {
        for values in [&mut out.value, &mut out.by_a, &mut out.by_b] {
            values.fill(0.0);
        }
        if let Some(crack) = &self.crack {
            crack.add_with_rates((tooth_a, place_a), (tooth_b, place_b), out);
        }
        let pair = self.pair(tooth_a, tooth_b);
        if tooth_a != tooth_b {
            self.blocks.add_with_rates(pair, place_a, place_b, out);
            return;
        }
        self.blocks.add_own_with_rates(pair, place_a, out);
        if !self.spread.is_empty() {
            let (term, rate) = self.spread_at(place_a);
            add_spread(&mut out.value, self.slices, term);
            add_spread(&mut out.by_a, self.slices, 0.5 * rate);
        }
    }

    /// What neighbouring slices share of the calibrated correction at a roll place \[m/N\], and its derivative by the roll angle; zero where
    /// there is none.
    fn spread_at(&self, place: &RollPlace) -> (f64, f64) {
        if self.spread.is_empty() {
            return (0.0, 0.0);
        }
        let inside = place.share.clamp(0.0, 1.0);
        let at = 2.0 * (place.station as f64 + inside);
        let low = (at as usize).min(self.spread.len() - 2);
        let share = at - low as f64;
        let (below, above) = (self.spread[low], self.spread[low + 1]);
        let moves = if inside == place.share {
            2.0 / self.spacing_rad(place.station)
        } else {
            0.0
        };
        (
            (1.0 - share) * below + share * above,
            (above - below) * moves,
        )
    }

    /// The calibrated correction's part between two slices of one tooth: each slice gives its own term to both neighbours,
    /// and a neighbour gets the mean of the two slices' terms. With all slices at one place that of [`Self::add_block`].
    fn spread_between(&self, a: &PlacedSlice, b: &PlacedSlice) -> f64 {
        if a.tooth != b.tooth {
            return 0.0;
        }
        match a.slice.abs_diff(b.slice) {
            0 => -self.neighbours(a.slice) * self.spread_at(&a.place).0,
            1 => 0.5 * (self.spread_at(&a.place).0 + self.spread_at(&b.place).0),
            _ => 0.0,
        }
    }

    /// Φ_aᵀ C Φ_b between two slices that each stand at their own place, as on slanted contact lines; the
    /// calibrated correction's part between neighbours is included.
    pub fn between_slices(&self, a: &PlacedSlice, b: &PlacedSlice) -> f64 {
        self.combined(a, a.place.all_shares(), b)
            + self.spread_between(a, b)
            + (self.crack.as_ref()).map_or(0.0, |crack| crack.between(a, b))
    }

    /// Σ w_s C between the stations of slice `a` with weights w_s and slice `b` at its place. Plain loops: on helical teeth most of the
    /// time goes here.
    fn combined(&self, a: &PlacedSlice, weights: &[f64; SHARES], b: &PlacedSlice) -> f64 {
        let pair = self.pair(a.tooth, b.tooth);
        let entry = a.slice * self.slices + b.slice;
        let mut sum = 0.0;
        for (station, weight) in (a.place.first()..).zip(weights) {
            // Stations that do not exist have no share.
            if *weight == 0.0 {
                continue;
            }
            let mut along = 0.0;
            for (other, share) in (b.place.first()..).zip(b.place.all_shares()) {
                if *share != 0.0 {
                    along += share * self.blocks.block(pair, station, other)[entry];
                }
            }
            sum += weight * along;
        }
        sum
    }

    /// Derivative of [`Self::between_slices`] by the roll angle of slice `a` \[m/(N·rad)\]; of a slice with itself half of what its
    /// compliance changes by.
    pub fn between_slices_rate(&self, a: &PlacedSlice, b: &PlacedSlice) -> f64 {
        let rate = self.combined(a, a.place.all_rates(), b);
        // As in `spread_between`: in sum over both slices of a term half of its change.
        let spread = match a.slice.abs_diff(b.slice) {
            _ if a.tooth != b.tooth => 0.0,
            0 => -0.5 * self.neighbours(a.slice) * self.spread_at(&a.place).1,
            1 => 0.5 * self.spread_at(&a.place).1,
            _ => 0.0,
        };
        let crack = self.crack.as_ref();
        rate + spread + crack.map_or(0.0, |crack| crack.between_rate(a, b))
    }

    /// How many slices stand beside a slice.
    fn neighbours(&self, slice: usize) -> f64 {
        let beside = [slice > 0, slice + 1 < self.slices];
        beside.into_iter().filter(|exists| *exists).count() as f64
    }
}

/// Adds a term between neighbouring slices and takes it from both, so that a uniform load deflects as before.
fn add_spread(block: &mut [f64], slices: usize, term: f64) {
    for i in 1..slices {
        for (row, column, sign) in [
            (i, i, -1.0),
            (i - 1, i - 1, -1.0),
            (i, i - 1, 1.0),
            (i - 1, i, 1.0),
        ] {
            block[row * slices + column] += sign * term;
        }
    }
}

/// The largest term between neighbours that leaves the compliance positive \[m/N\]: half of the least xᵀCx/xᵀLx of the loads x
/// = (1, −1) on two and (1, −2, 1) on three slices side by side, L the graph Laplacian of the row of slices, in whose shape the
/// term enters. Reached where slices are narrower than the elements across the width, which cannot tell them apart.
fn largest_neighbour_term(blocks: &StationBlocks, slices: usize, place: &RollPlace) -> f64 {
    let mut own = vec![0.0; slices * slices];
    blocks.add(0, place, place, &mut own);
    let c = |i: usize, j: usize| own[i * slices + j];
    let mut least = f64::INFINITY;
    for x in [[1.0, -1.0].as_slice(), &[1.0, -2.0, 1.0]] {
        let outer = x[0] * x[0] + x[x.len() - 1] * x[x.len() - 1];
        let steps: f64 = x.windows(2).map(|p| (p[1] - p[0]) * (p[1] - p[0])).sum();
        for first in 0..(slices + 1).saturating_sub(x.len()) {
            let terms = (0..x.len()).flat_map(|i| (0..x.len()).map(move |j| (i, j)));
            let energy: f64 = terms
                .map(|(i, j)| x[i] * x[j] * c(first + i, first + j))
                .sum();
            least = least.min(energy / (steps + outer));
        }
    }
    0.5 * least.max(0.0)
}
