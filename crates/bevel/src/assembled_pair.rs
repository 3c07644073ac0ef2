//! Both sides of a pair in the assembly of its file: what drives, what is behind it, and the backlash between them.

use crate::assembly::AssemblyError;
use crate::error::BevelError;
use crate::hand::FlankSide;
use crate::pair_design::PairDesign;
use crate::pair_file::PairFile;
use crate::tca::{ToothContact, are_conjugate, tooth_contact, touches_along_lines};

/// A pair in its assembly, in which teeth do not jam.
#[derive(Debug, Clone)]
pub struct AssembledPair {
    /// Contact of the side that drives; none of conjugate flanks in the pair as designed, which touch along lines.
    pub driving: Option<ToothContact>,
    /// Of the other side, which may be out of reach in assemblies in which this one touches.
    pub coast: Result<Option<ToothContact>, BevelError>,
    /// Least normal backlash; none where one side has no contact that is known \[m\].
    pub backlash_m: Option<f64>,
    /// What is to be said of teeth that overlap by less than what is refused.
    pub jam: Option<BevelError>,
}

impl AssembledPair {
    /// Analyses both sides.
    ///
    /// # Errors
    /// [`BevelError`] where the driving flanks do not touch, [`BevelError::Jam`] where teeth jam.
    pub fn new(file: &PairFile, design: &PairDesign) -> Result<Self, BevelError> {
        let contact = |pinion: FlankSide| -> Result<Option<ToothContact>, BevelError> {
            let flanks = design.flanks(pinion);
            if file.tca.error == AssemblyError::default() && are_conjugate(flanks, &file.blank) {
                return Ok(None);
            }
            tooth_contact(flanks, &file.blank, &file.tca).map(Some)
        };
        let driving = contact(file.pinion_flank)?;
        let coast = contact(file.pinion_flank.mate());
        let backlash_m = match (&driving, &coast) {
            (Some(driving), Ok(Some(coast))) => {
                let sides = match file.pinion_flank {
                    FlankSide::Concave => [driving, coast],
                    FlankSide::Convex => [coast, driving],
                };
                Some(design.assembled_backlash_m(&file.blank, sides))
            }
            // Conjugate flanks have no transmission error.
            (None, Ok(None)) => Some(design.backlash_m(&file.blank)),
            _ => None,
        };
        let jam = match backlash_m {
            Some(backlash_m) => design.check_jam(&file.blank, (file.pinion_flank, backlash_m))?,
            None => None,
        };
        Ok(Self {
            driving,
            coast,
            backlash_m,
            jam,
        })
    }

    /// Contact of the side that drives, where it has a path.
    ///
    /// # Errors
    /// [`BevelError::NoContact`] for flanks that touch along lines.
    pub fn path(&self) -> Result<&ToothContact, BevelError> {
        self.driving.as_ref().ok_or_else(touches_along_lines)
    }
}
