//! Slices of a reduced bevel gear: even along its face, each with the near field of its own place along the tooth.

use gearmesh_model::{BevelBody, Flank, ReducedGear, ReducedGearError};

use crate::axial_spread::AxialSpread;
use crate::calibrated_field::CalibratedField;
use crate::local_contact::LocalContact;
use crate::profile_shares::ProfileHats;
use crate::slice_compliance::{FlankGeometry, SliceCompliance};

/// Where slices sit on a gear that were laid evenly on gear 1's face, `face_1_m` wide: both faces end together at the
/// heel.
#[must_use]
pub fn spread_from_heel(gear: &ReducedGear, face_1_m: f64, slices: usize) -> AxialSpread {
    let width_m = face_1_m / slices as f64;
    let middle_m = |k: usize| 0.5 * gear.face_width_m - ((slices - k) as f64 - 0.5) * width_m;
    AxialSpread::new(gear, (0..slices).map(middle_m), width_m)
}

/// Hats up a flank of a reduced gear: over the area of a bevel flank, over the length of an involute.
///
/// # Errors
/// [`ReducedGearError::FlankNotReduced`] if that flank carries no loads.
pub fn profile_hats(gear: &ReducedGear, flank: Flank) -> Result<ProfileHats, ReducedGearError> {
    let flank_index = gear.flank_index(flank)?;
    Ok(match &gear.bevel {
        Some(bevel) => {
            let surface = Surface {
                gear,
                bevel,
                flank_index,
            };
            surface.hats()
        }
        None => ProfileHats::of_involute(&gear.grid.roll_angles_rad),
    })
}

/// Middles of even slices along a face \[m\] from its own middle.
fn middles_m(face_width_m: f64, slices: usize) -> impl Iterator<Item = f64> {
    (0..slices).map(move |k| ((k as f64 + 0.5) / slices as f64 - 0.5) * face_width_m)
}

/// So many slices along the face of a gear.
#[must_use]
pub fn even_spread(gear: &ReducedGear, slices: usize) -> AxialSpread {
    let width_m = gear.face_width_m / slices as f64;
    AxialSpread::new(gear, middles_m(gear.face_width_m, slices), width_m)
}

impl SliceCompliance {
    /// Condenses a reduced bevel gear to so many even slices along its face.
    ///
    /// u is the share of the way up the flank, v the place along the face from its middle, along the pitch cone \[m\].
    ///
    /// # Errors
    /// [`ReducedGearError::NotBevel`] for a cylindrical gear, else as [`Self::on_grid`].
    pub fn of_bevel(
        gear: &ReducedGear,
        flank: Flank,
        local: LocalContact,
        slices: usize,
    ) -> Result<Self, ReducedGearError> {
        let not_bevel = || ReducedGearError::NotBevel {
            gear: gear.name.clone(),
        };
        let bevel = gear.bevel.as_ref().ok_or_else(not_bevel)?;
        let flank_index = gear.flank_index(flank)?;
        let near_field = match (local, &bevel.near_field) {
            (LocalContact::Calibrated, Some(field)) => {
                let (stations, face_m) = (gear.grid.roll_angles_rad.len(), gear.face_width_m);
                let middles_m = middles_m(face_m, slices);
                let field = CalibratedField::of_bevel(field, flank_index, stations, middles_m);
                Some(field)
            }
            (LocalContact::Calibrated, None) => {
                return Err(ReducedGearError::NotCalibrated {
                    gear: gear.name.clone(),
                });
            }
            _ => None,
        };
        let surface = Surface {
            gear,
            bevel,
            flank_index,
        };
        let geometry = FlankGeometry {
            hats: surface.hats(),
            stretch: surface.stretch(),
            near_field,
        };
        Self::condensed(gear, flank, local, (geometry, &even_spread(gear, slices)))
    }
}

/// A flank of a bevel body at its stations.
struct Surface<'a> {
    gear: &'a ReducedGear,
    bevel: &'a BevelBody,
    flank_index: usize,
}

impl Surface<'_> {
    /// Hats up the flank, over its area in the middle of the face.
    fn hats(&self) -> ProfileHats {
        let grid = &self.gear.grid;
        let (us, along) = (&grid.roll_angles_rad, grid.z_m.len());
        let areas = &self.bevel.areas_m2[self.flank_index * grid.len()..];
        let middle = |station: usize| areas[station * along + along / 2];
        let area = |u: f64| {
            let high = us.partition_point(|at| *at <= u).clamp(1, us.len() - 1);
            let share = (u - us[high - 1]) / (us[high] - us[high - 1]);
            (1.0 - share) * middle(high - 1) + share * middle(high)
        };
        ProfileHats::new(us, area)
    }

    /// Length of the tooth half-way up over the width of its face along the pitch cone.
    fn stretch(&self) -> f64 {
        let grid = &self.gear.grid;
        let along = grid.z_m.len();
        let first = self.flank_index * grid.len() + grid.roll_angles_rad.len() / 2 * along;
        let points = &self.bevel.points_m[3 * first..3 * (first + along)];
        let steps = points.windows(6).step_by(3).map(|pair| {
            let step = [0, 1, 2].map(|axis: usize| pair[axis + 3] - pair[axis]);
            step.iter().map(|d| d * d).sum::<f64>().sqrt()
        });
        steps.sum::<f64>() / self.gear.face_width_m
    }
}
