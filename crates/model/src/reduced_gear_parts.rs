//! What a reduced gear says of the parts that it need not have: near field, modes, crack, motions of the bore, bevel
//! body.

use std::f64::consts::TAU;

use gearmesh_geometry::Flank;

use crate::modal_basis::ModalBasis;
use crate::near_field::NearField;
use crate::reduced_gear::ReducedGear;
use crate::reduced_gear_error::ReducedGearError;
use crate::root_crack::RootCrack;

impl ReducedGear {
    /// The calibration of the near field.
    ///
    /// # Errors
    /// [`ReducedGearError::NotCalibrated`] for a model without one.
    pub fn calibration(&self) -> Result<&NearField, ReducedGearError> {
        self.near_field
            .as_ref()
            .ok_or_else(|| ReducedGearError::NotCalibrated {
                gear: self.name.clone(),
            })
    }

    /// The modal basis.
    ///
    /// # Errors
    /// [`ReducedGearError::NoModes`] for a gear that was reduced without.
    pub fn modal_basis(&self) -> Result<&ModalBasis, ReducedGearError> {
        self.modes
            .as_ref()
            .ok_or_else(|| ReducedGearError::NoModes {
                gear: self.name.clone(),
            })
    }

    /// NᵀΦ of one mode on one flank (kg^-½), `[load][component]`.
    ///
    /// # Errors
    /// [`ReducedGearError::NoModes`].
    ///
    /// # Panics
    /// If the mode or tooth does not exist or the hand carries no loads.
    pub fn mode_at_flank(
        &self,
        mode: usize,
        tooth: usize,
        flank: Flank,
    ) -> Result<&[f64], ReducedGearError> {
        let (hands, size) = (self.flanks.len(), 3 * self.grid.len());
        let place = (mode * self.teeth + tooth) * hands + self.carrying(flank);
        Ok(&self.modal_basis()?.flank[place * size..(place + 1) * size])
    }

    /// The crack, where loads on this hand of flank open it.
    pub fn crack_for(&self, flank: Flank) -> Option<&RootCrack> {
        self.crack.as_ref().filter(|crack| crack.side == flank)
    }

    /// s of the loads of a flank, `[load][motion]`; none where motions of the bore were not asked for.
    ///
    /// # Panics
    /// If the tooth does not exist or the hand carries no loads.
    #[must_use]
    pub fn bore_rows(&self, tooth: usize, flank: Flank) -> Option<Vec<f64>> {
        let bore = self.bore.as_ref()?;
        assert!(tooth < self.teeth, "tooth {tooth} of {}", self.teeth);
        let (own, size) = (self.teeth_per_sector(), self.grid.len() * bore.count());
        let start = ((tooth % own) * self.flanks.len() + self.carrying(flank)) * size;
        let mut rows = bore.flank[start..start + size].to_vec();
        let turned = (tooth / own) as f64 * TAU / self.sectors as f64;
        bore.turn(&mut rows, turned);
        Some(rows)
    }

    /// Refuses a bevel gear where flanks are taken to be involutes.
    ///
    /// # Errors
    /// [`ReducedGearError::BevelGear`].
    pub fn demand_cylindrical(&self) -> Result<(), ReducedGearError> {
        match self.bevel {
            None => Ok(()),
            Some(_) => Err(ReducedGearError::BevelGear {
                gear: self.name.clone(),
            }),
        }
    }

    /// Point of a flank of tooth 0 at a load's place (m) and the unit normal into the material there; none of a
    /// cylindrical gear.
    ///
    /// # Panics
    /// If the hand carries no loads or there is no such load.
    pub fn bevel_point(&self, flank: Flank, load: usize) -> Option<[[f64; 3]; 2]> {
        let bevel = self.bevel.as_ref()?;
        let first = 3 * (self.carrying(flank) * self.grid.len() + load);
        let at = |values: &[f64]| [0, 1, 2].map(|axis| values[first + axis]);
        Some([at(&bevel.points_m), at(&bevel.normals)])
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use crate::made_up_models::small_reduced_gear;

    #[test]
    fn a_model_without_calibration_says_so() {
        let mut gear = small_reduced_gear();
        assert!(gear.calibration().is_ok());
        gear.near_field = None;
        let message = gear.calibration().unwrap_err().to_string();
        assert!(message.contains("reduce it again"), "{message}");
    }

    #[test]
    fn a_gear_without_modes_says_so() {
        let mut gear = small_reduced_gear();
        gear.modes = None;
        let message = gear.modal_basis().unwrap_err().to_string();
        assert!(message.contains("[modes]"), "{message}");
    }
}
