//! Slice forces as forces on the unit loads of the flank grid: what the whole finite element model is loaded with.

use crate::gauge_reader::LoadedSlice;
use gearmesh_contact::{AxialSpread, ProfileHats};
use gearmesh_model::FlankGrid;

/// Force on one unit load of one tooth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GridLoadForce {
    /// Tooth.
    pub tooth: usize,
    /// Load number, see [`FlankGrid::load`].
    pub load: usize,
    /// Along the inward normal \[N\].
    pub normal_n: f64,
    /// Along the profile towards the tip \[N\].
    pub tangential_n: f64,
}

/// Spreads the forces of slices over the flank grid, with the same shares as the compliance: f = Φ F.
pub fn grid_forces(
    grid: &FlankGrid,
    spread: &AxialSpread,
    slices: impl IntoIterator<Item = LoadedSlice>,
) -> Vec<GridLoadForce> {
    let hats = ProfileHats::of_involute(&grid.roll_angles_rad);
    let mut forces = Vec::new();
    for loaded in slices {
        for (station, weight) in hats.place(loaded.roll_rad).shares() {
            for &(axial, share) in spread.shares(loaded.slice) {
                let on_load = weight * share * loaded.force_n;
                if on_load != 0.0 {
                    forces.push(GridLoadForce {
                        tooth: loaded.tooth,
                        load: grid.load(station, axial),
                        normal_n: on_load * loaded.components[0],
                        tangential_n: on_load * loaded.components[1],
                    });
                }
            }
        }
    }
    forces
}
