//! Slice forces as forces on the unit loads of the flank grid: what the whole finite element model is loaded with.

use crate::gauge_reader::LoadedSlice;
use gearmesh_contact::{AxialSpread, ProfileHats};
use gearmesh_model::{Flank, FlankGrid};

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

/// A force anywhere on a flank: uniform over a stretch along the tooth, at one place of the profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlacedForce {
    /// Tooth.
    pub tooth: usize,
    /// Flank.
    pub side: Flank,
    /// Roll angle \[rad\], on a bevel gear the share of the way up the flank.
    pub u: f64,
    /// Middle of the stretch, from mid-face \[m\].
    pub v_m: f64,
    /// Its width \[m\].
    pub width_m: f64,
    /// Along the inward normal \[N\].
    pub normal_n: f64,
    /// Along the profile towards the tip \[N\].
    pub tangential_n: f64,
}

/// Spreads forces over the flank grid of a face; `hats` say how a force between stations of its flank is shared.
pub fn placed_forces<'a>(
    (grid, face_width_m): (&FlankGrid, f64),
    hats: impl Fn(Flank) -> &'a ProfileHats,
    forces: &[PlacedForce],
) -> Vec<(Flank, GridLoadForce)> {
    let mut on_grid = Vec::new();
    for force in forces {
        // What of the stretch stands beyond the face is pushed back on it.
        let width_m = force.width_m.min(face_width_m);
        let end = 0.5 * (face_width_m - width_m);
        let middle = force.v_m.clamp(-end, end);
        let spread = AxialSpread::on_face((grid.slices, face_width_m), [middle], width_m);
        for (station, weight) in hats(force.side).place(force.u).shares() {
            for &(axial, share) in spread.shares(0) {
                let load = GridLoadForce {
                    tooth: force.tooth,
                    load: grid.load(station, axial),
                    normal_n: weight * share * force.normal_n,
                    tangential_n: weight * share * force.tangential_n,
                };
                on_grid.push((force.side, load));
            }
        }
    }
    on_grid
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
