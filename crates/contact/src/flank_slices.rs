//! How the slices of a mesh sit on a flank of one of its reduced gears: what reads shapes or rows at the flank takes
//! the shares that the compliance has, whichever family the gear is of.

use gearmesh_model::{Flank, ReducedGear, ReducedGearError};

use crate::axial_spread::AxialSpread;
use crate::bevel_slices::{even_spread, profile_hats};
use crate::contact_zone::SliceLayout;
use crate::profile_shares::ProfileHats;
use crate::walked_slice::SliceWalk;

/// Shares of a slice's force on the stations of a flank.
#[derive(Debug, Clone, PartialEq)]
pub struct FlankSlices {
    /// Up the profile.
    pub hats: ProfileHats,
    /// Along the tooth.
    pub spread: AxialSpread,
    /// Where slices stand along the tooth if they do not stay where they were laid: on the gear of a bevel pair.
    pub walk: Option<SliceWalk>,
}

impl FlankSlices {
    /// The slices of a layout on a flank of gear 1 or 2.
    ///
    /// # Errors
    /// [`ReducedGearError::FlankNotReduced`] if that flank carries no loads.
    pub fn new(
        layout: &SliceLayout,
        gear: usize,
        model: &ReducedGear,
        flank: Flank,
    ) -> Result<Self, ReducedGearError> {
        let hats = profile_hats(model, flank)?;
        if model.bevel.is_none() {
            return Ok(Self {
                hats,
                spread: layout.spread(gear, model),
                walk: None,
            });
        }
        let [face_1_m, _] = layout.face_widths_m;
        let walk = SliceWalk::new(layout.slices, model.face_width_m, face_1_m);
        Ok(Self {
            hats,
            spread: even_spread(model, layout.slices),
            walk: walk.filter(|_| gear == 2),
        })
    }
}
