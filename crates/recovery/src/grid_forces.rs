//! Slice forces as forces on the unit loads of the flank grid: what the whole finite element model is loaded with.

use crate::gauge_reader::LoadedLine;
use gearmesh_contact::slice_compliance::{axial_shares, centroids, roll_place};
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

/// Spreads the forces of contact lines over the flank grid, with the same shares as the compliance: f = Φ F.
pub fn grid_forces<'a>(
    grid: &FlankGrid,
    lines: impl IntoIterator<Item = LoadedLine<'a>>,
) -> Vec<GridLoadForce> {
    let centroids = centroids(&grid.roll_angles_rad);
    let mut forces = Vec::new();
    for line in lines {
        let place = roll_place(&centroids, line.roll_rad);
        for (station, weight) in [
            (place.station, 1.0 - place.share),
            (place.station + 1, place.share),
        ] {
            for (slice, force) in line.forces_n.iter().enumerate() {
                for (axial, share) in axial_shares(slice, grid.slices) {
                    let on_load = weight * share * force;
                    if on_load != 0.0 {
                        forces.push(GridLoadForce {
                            tooth: line.tooth,
                            load: grid.load(station, axial),
                            normal_n: on_load * line.components[0],
                            tangential_n: on_load * line.components[1],
                        });
                    }
                }
            }
        }
    }
    forces
}
