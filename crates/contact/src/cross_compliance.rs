//! Compliance between the slices of two meshes of one gear body: the deflection at one mesh under the force of another.
//!
//! ```text
//! C_ab = Φ_aᵀ C_hub Φ_b
//! ```
//!
//! Φ_a and Φ_b combine the loads of each mesh's own flank and slices. Teeth of different meshes are different teeth:
//! the near field of a contact does not reach from one to the other, and C_hub is the whole.

use crate::axial_spread::AxialSpread;
use crate::place_blocks::{BetweenPlaces, PlaceBlocks};
use crate::placed_slice::ToothPlace;
use crate::slice_compliance::{blocks_of_all, loads_of_slices};
use crate::station_blocks::StationBlocks;
use gearmesh_model::{Flank, ReducedGear, ReducedGearError};

/// Compliance of one gear between slices of two meshes.
#[derive(Debug, Clone)]
pub struct CrossCompliance {
    teeth: usize,
    /// `[tooth in sector][response tooth]`.
    blocks: PlaceBlocks,
}

impl CrossCompliance {
    /// Between slices on one flank of a gear, spread so along the teeth, and slices on the same or the other one.
    ///
    /// # Errors
    /// [`ReducedGearError::BevelGear`], [`ReducedGearError::FlankNotReduced`].
    pub fn new(
        gear: &ReducedGear,
        flanks: [Flank; 2],
        spreads: [&AxialSpread; 2],
    ) -> Result<Self, ReducedGearError> {
        gear.demand_cylindrical()?;
        let indices = [gear.flank_index(flanks[0])?, gear.flank_index(flanks[1])?];
        let [of_a, of_b] = spreads.map(|spread| loads_of_slices(&gear.grid, spread));
        let blocks = match &gear.hub_patterns {
            Some(patterns) => {
                let loads = gear.grid.len();
                let on_flank = |slices: &[Vec<(usize, f64)>], flank: usize| {
                    let moved = |&(load, share): &(usize, f64)| (load + flank * loads, share);
                    let each = slices.iter().map(|row| row.iter().map(moved).collect());
                    each.collect::<Vec<Vec<(usize, f64)>>>()
                };
                let mut both = on_flank(&of_a, indices[0]);
                both.extend(on_flank(&of_b, indices[1]));
                let patterns = (patterns.combined(&both), [0, of_a.len()]);
                let stations = gear.grid.roll_angles_rad.len();
                let slices = spreads.map(AxialSpread::slices);
                StationBlocks::of_patterns(stations, slices, patterns, gear.teeth)
            }
            None => {
                let block = |a: usize, b: usize| gear.c_hub_block(a, flanks[0], b, flanks[1]);
                blocks_of_all(gear, block, [&of_a, &of_b])
            }
        };
        Ok(Self {
            teeth: gear.teeth,
            blocks: PlaceBlocks::new(blocks),
        })
    }

    /// C of all slices at a place of the first mesh and at one of the second \[m/N\], and how it changes with both
    /// places.
    #[inline(always)]
    pub(crate) fn between(&self, places: [&ToothPlace; 2], found: &mut BetweenPlaces) {
        let [a, b] = places;
        let (tooth, response) = a.with_response(b.tooth, self.teeth);
        let pair = tooth * self.teeth + response;
        self.blocks.combine(pair, [&a.place, &b.place], found);
    }

    /// Place of two slices in what is found.
    #[inline(always)]
    pub(crate) fn entry(&self, slices: [usize; 2]) -> usize {
        self.blocks.entry(slices)
    }
}
