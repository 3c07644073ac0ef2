//! Compliance between slices on contact lines, from the compliance between unit loads on the flank grid.
//!
//! A slice force at u is a combination Φ of grid loads. Along the tooth its shares ([`AxialSpread`]) make it nearly a
//! uniform load on the slice, and equal slice forces an exactly uniform line load. Along the profile the nearest
//! stations share the force so that its first two moments are kept ([`ProfileHats`]). C = Φᵀ C_grid Φ as a whole. The
//! part of Φ along the tooth does not depend on the position and is applied once, when the model is loaded. Slices may
//! stand each at its own u: on one line they have one only where it runs along the tooth.

use crate::axial_spread::AxialSpread;
use crate::calibrated_field::CalibratedField;
use crate::coupled_places::CoupledPlaces;
use crate::crack_rows::CrackRows;
use crate::local_contact::{CompliancePart, LocalContact, effective_depth_m};
use crate::placed_slice::ToothPlace;
use crate::profile_shares::{ProfileHats, ProfilePlace};
use crate::slice_spread::NeighbourTerm;
use crate::station_blocks::StationBlocks;
use crate::walked_slice::SliceWalk;
use gearmesh_model::{Flank, FlankGrid, ReducedGear, ReducedGearError};
use std::borrow::Cow;
use std::f64::consts::PI;

/// Slice compliance of one gear for loads on one hand of flank.
#[derive(Debug, Clone)]
pub struct SliceCompliance {
    teeth: usize,
    teeth_per_sector: usize,
    slices: usize,
    hats: ProfileHats,
    opposite_distance_m: Vec<f64>,
    /// Pairs of flanks: `[tooth in sector][response tooth]`.
    blocks: StationBlocks,
    /// Of the flank in contact; only where the local contact is calibrated.
    near_field: Option<CalibratedField>,
    /// What neighbouring slices of one contact line share of the calibrated correction \[m/N\], at the roll stations
    /// and half-way between; empty where there is none.
    spread: Vec<f64>,
    /// What a crack adds; none where the gear has none that loads on this flank open.
    crack: Option<CrackRows>,
    young_pa: f64,
    poisson: f64,
    slice_width_m: f64,
    /// Where slices walk along the teeth.
    walk: Option<SliceWalk>,
}

/// What a family of flanks says of one, besides its compliance.
pub(crate) struct FlankGeometry {
    /// Along the profile.
    pub hats: ProfileHats,
    /// Length along the tooth over the width along the face by which slices are counted.
    pub stretch: f64,
    /// Where the local contact is calibrated.
    pub near_field: Option<CalibratedField>,
}

/// Depth of the local logarithm on one flank, and how it grows as the contact moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalDepth {
    /// h \[m\].
    pub depth_m: f64,
    /// ∂(ln h)/∂u.
    pub growth_by_u: f64,
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
    /// [`ReducedGearError::BevelGear`] for one, [`ReducedGearError::FlankNotReduced`] when the model carries no loads
    /// on `flank`, [`ReducedGearError::NotCalibrated`] when `local` is calibrated and the model is not.
    pub fn on_slices(
        gear: &ReducedGear,
        flank: Flank,
        local: LocalContact,
        spread: &AxialSpread,
    ) -> Result<Self, ReducedGearError> {
        gear.demand_cylindrical()?;
        let hats = ProfileHats::of_involute(&gear.grid.roll_angles_rad);
        Self::on_grid(gear, flank, local, (hats, spread))
    }

    /// Condenses the grid of a flank of any family: `hats` and `spread` say where loads between its stations sit along
    /// the profile and along the tooth.
    ///
    /// # Errors
    /// As [`Self::on_slices`].
    pub fn on_grid(
        gear: &ReducedGear,
        flank: Flank,
        local: LocalContact,
        (hats, spread): (ProfileHats, &AxialSpread),
    ) -> Result<Self, ReducedGearError> {
        let flank_index = gear.flank_index(flank)?;
        let near_field = match local {
            LocalContact::Calibrated => Some(CalibratedField::new(gear, flank_index)?),
            LocalContact::None | LocalContact::WeberBanaschek => None,
        };
        let geometry = FlankGeometry {
            hats,
            stretch: 1.0,
            near_field,
        };
        Self::condensed(gear, flank, local, (geometry, spread))
    }

    pub(crate) fn condensed(
        gear: &ReducedGear,
        flank: Flank,
        local: LocalContact,
        (geometry, spread): (FlankGeometry, &AxialSpread),
    ) -> Result<Self, ReducedGearError> {
        gear.flank_index(flank)?;
        let FlankGeometry {
            hats,
            stretch,
            near_field,
        } = geometry;
        let grid = &gear.grid;
        let (stations, slices) = (grid.roll_angles_rad.len(), spread.slices());
        let own = gear.teeth_per_sector();
        let axial = loads_of_slices(grid, spread);
        let blocks = match gear.flank_patterns(flank, local.part() == CompliancePart::Patterns) {
            Some(patterns) => {
                let patterns = (patterns.combined(&axial), [0, 0]);
                StationBlocks::of_patterns(stations, [slices; 2], patterns, gear.teeth)
            }
            None => {
                let block = |tooth: usize, other: usize| match local.part() {
                    CompliancePart::Patterns => gear.c_g_block(tooth, flank, other, flank),
                    CompliancePart::Hub => gear.c_hub_block(tooth, flank, other, flank),
                };
                blocks_of_all(gear, block, [&axial; 2])
            }
        };
        let slice_width_m = spread.width_m();
        let k = 2.0 * (1.0 - gear.poisson * gear.poisson) / (PI * gear.young_pa);
        // A single slice has no neighbours.
        let neighboured = near_field.as_ref().filter(|_| slices > 1);
        let to_neighbours = neighboured.map_or(Vec::new(), |field| {
            let own_width_m = gear.slice_width_m();
            let neighbours = NeighbourTerm::new(own_width_m / slice_width_m);
            let opposite_m = gear.opposite_distances_m(flank);
            // Hats are stiffer at a station than between two, where the load is shared.
            (0..2 * stations - 1)
                .map(|half| {
                    let station = (half / 2).min(stations - 2);
                    let share = 0.5 * half as f64 - station as f64;
                    let c = hats.centroids();
                    let roll = (1.0 - share) * c[station] + share * c[station + 1];
                    let place = hats.place(roll);
                    let missing = field.missing(roll, &place, (slices / 2, 1.0)).value;
                    let sizes = (opposite_m[half.div_ceil(2)], stretch * slice_width_m);
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
            walk: None,
        })
    }

    /// Lets slices stand where the places of their patches are along the tooth, v from the middle of the face, not
    /// where they were laid. Of own slices over the whole face, at least three.
    #[must_use]
    pub fn walking_along(mut self, face_1_m: f64) -> Self {
        let face_m = self.slices as f64 * self.slice_width_m;
        self.walk = SliceWalk::new(self.slices, face_m, face_1_m);
        self
    }

    /// Whether they do.
    pub(crate) fn walks_along(&self) -> bool {
        self.walk.is_some()
    }

    /// A place of a slice with where it stands along the tooth \[m\].
    pub(crate) fn walked(&self, place: ToothPlace, slice: usize, v: f64) -> ToothPlace {
        let walked = self.walk.map(|walk| walk.at(slice, v));
        ToothPlace { walked, ..place }
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

    /// Where a place along the profile lies between the stations.
    pub fn place(&self, u: f64) -> ProfilePlace {
        self.hats.place(u)
    }

    /// A place along the profile of a tooth.
    pub fn on_tooth(&self, tooth: usize, u: f64) -> ToothPlace {
        let (own, place) = (tooth % self.teeth_per_sector, self.place(u));
        ToothPlace {
            tooth,
            place,
            shared: self.shared_at(&place),
            in_sector: (own, tooth - own),
            walked: None,
        }
    }

    /// Depth h \[m\] of the local logarithm at a roll angle: effective where the model is calibrated, else the distance
    /// to the opposite side.
    ///
    /// A slice that touches over a share of its width only (helical teeth, at the ends of the path) has the line load
    /// q = F/(share b_s), but its hats still spread F over the whole slice: the calibration then adds
    /// q (c₀ − share w_h − k ln(a/a₀)). With the share the force goes to zero, as it must.
    pub fn local_depth_m(&self, roll_rad: f64, share: f64) -> f64 {
        let middle = self.slices / 2;
        self.local_depth(roll_rad, &self.place(roll_rad), (middle, share))
            .depth_m
    }

    /// [`Self::local_depth_m`] of a slice that touches over a share, at a place that is known, and how it changes.
    pub fn local_depth(
        &self,
        roll_rad: f64,
        place: &ProfilePlace,
        (slice, share): (usize, f64),
    ) -> LocalDepth {
        let Some(field) = &self.near_field else {
            let (low, high) = (
                self.opposite_distance_m[place.station],
                self.opposite_distance_m[place.station + 1],
            );
            let inside = place.share.clamp(0.0, 1.0);
            let depth = (1.0 - inside) * low + inside * high;
            let slope = if inside == place.share {
                (high - low) / self.spacing(place.station)
            } else {
                0.0
            };
            return LocalDepth {
                depth_m: depth,
                growth_by_u: slope / depth,
                growth_by_share: 0.0,
            };
        };
        let missing = field.missing(roll_rad, place, (slice, share));
        let k = 2.0 * (1.0 - self.poisson * self.poisson) / (PI * self.young_pa);
        LocalDepth {
            depth_m: effective_depth_m(missing.value, field.half_width_m, self.material()),
            growth_by_u: missing.by_roll / k,
            growth_by_share: missing.by_share / k,
        }
    }

    /// Distance of the centroids of a station's hat and the next one's.
    fn spacing(&self, station: usize) -> f64 {
        let c = self.hats.centroids();
        c[station + 1] - c[station]
    }

    /// What slices at two places deflect each other by.
    #[inline(always)]
    #[must_use]
    pub fn between<'a>(&'a self, a: &'a ToothPlace, b: &'a ToothPlace) -> CoupledPlaces<'a> {
        let (tooth, response) = a.with_response(b.tooth, self.teeth);
        let neighboured = !self.spread.is_empty() && a.tooth == b.tooth;
        CoupledPlaces {
            blocks: (self.blocks).at(tooth * self.teeth + response, [&a.place, &b.place]),
            places: [a, b],
            slices: self.slices,
            has_more: neighboured || self.crack.is_some(),
            neighboured,
            crack: self.crack.as_ref(),
        }
    }

    /// What neighbouring slices share of the calibrated correction at a place \[m/N\], and its derivative by u; zero
    /// where there is none.
    fn shared_at(&self, place: &ProfilePlace) -> (f64, f64) {
        if self.spread.is_empty() {
            return (0.0, 0.0);
        }
        let inside = place.share.clamp(0.0, 1.0);
        let at = 2.0 * (place.station as f64 + inside);
        let low = (at as usize).min(self.spread.len() - 2);
        let share = at - low as f64;
        let (below, above) = (self.spread[low], self.spread[low + 1]);
        let moves = if inside == place.share {
            2.0 / self.spacing(place.station)
        } else {
            0.0
        };
        (
            (1.0 - share) * below + share * above,
            (above - below) * moves,
        )
    }
}

/// Loads and shares of each (station, slice).
pub(crate) fn loads_of_slices(grid: &FlankGrid, spread: &AxialSpread) -> Vec<Vec<(usize, f64)>> {
    let slices = spread.slices();
    let of_slice = |k: usize| {
        let shares = spread.shares(k % slices).iter();
        shares
            .map(|&(i, share)| (grid.load(k / slices, i), share))
            .collect()
    };
    (0..grid.roll_angles_rad.len() * slices)
        .map(of_slice)
        .collect()
}

/// T of all pairs of flanks: of a sector's teeth with all teeth, by their compliance `block(tooth, response tooth)`.
/// `axial`: loads and shares of each (station, slice) of the first flank and of the second.
pub(crate) fn blocks_of_all<'a>(
    gear: &'a ReducedGear,
    block: impl Fn(usize, usize) -> Cow<'a, [f64]>,
    axial: [&[Vec<(usize, f64)>]; 2],
) -> StationBlocks {
    let own = gear.teeth_per_sector();
    let (loads, stations) = (gear.grid.len(), gear.grid.roll_angles_rad.len());
    let sizes = axial.map(<[_]>::len);
    let slices = sizes.map(|size| size / stations);
    let mut blocks = StationBlocks::new(stations, slices, own * gear.teeth);
    let mut condensed = vec![0.0; sizes[0] * sizes[1]];
    let mut loaded = vec![0.0; loads];
    for tooth in 0..own {
        for other in 0..gear.teeth {
            let block = block(tooth, other);
            for (row, responses) in axial[0].iter().zip(condensed.chunks_exact_mut(sizes[1])) {
                // First the loads, then the responses: each entry of the block is used a few times only.
                loaded.fill(0.0);
                for &(l, share) in row {
                    for (sum, c) in loaded.iter_mut().zip(&block[l * loads..][..loads]) {
                        *sum += share * c;
                    }
                }
                for (response, column) in responses.iter_mut().zip(axial[1]) {
                    *response = column.iter().map(|&(m, share)| share * loaded[m]).sum();
                }
            }
            blocks.push(|[a, i], [b, j]| {
                condensed[(a * slices[0] + i) * sizes[1] + b * slices[1] + j]
            });
        }
    }
    blocks
}

/// The largest term between neighbours that leaves the compliance positive \[m/N\]: half of the least xᵀCx/xᵀLx of the
/// loads x = (1, −1) on two and (1, −2, 1) on three slices side by side, L the graph Laplacian of the row of slices,
/// in whose shape the term enters. Reached where slices are narrower than the elements across the width, which cannot
/// tell them apart.
fn largest_neighbour_term(blocks: &StationBlocks, slices: usize, place: &ProfilePlace) -> f64 {
    let c = |i: usize, j: usize| blocks.at(0, [place, place]).between([i, j]);
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
