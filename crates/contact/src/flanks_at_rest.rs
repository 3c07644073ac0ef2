//! What a contact at rest asks of the kinematics of two gears' flanks, whatever the family of the gears.
//!
//! | flanks | file |
//! | --- | --- |
//! | involute teeth, spur and helical, in closed form | `involute_at_rest.rs` |
//! | any flanks that run as a gear mesh, at the pose of the driver angle | `gearmesh-drivetrain`, `posed_flanks.rs` |

use crate::contact_error::ContactError;
use crate::contact_patch::ContactPatch;
use crate::tip_contact::TipGear;

/// Flanks of two gears of which gear 1 is turned and gear 2 follows.
pub trait FlanksAtRest {
    /// Finds the patches that touch or may touch at a driver angle \[rad\], line by line, into `patches`, which is
    /// empty. Gaps are those where the transmission error is zero, and close with the approach −TE as
    /// [`crate::PatchBalance::closing`] says.
    ///
    /// # Errors
    /// What keeps the gears from meshing there.
    fn patches_at(
        &mut self,
        driver_angle_rad: f64,
        patches: &mut Vec<ContactPatch>,
    ) -> Result<(), ContactError>;

    /// Lines at the last driver angle; some may have no patch.
    fn lines(&self) -> usize;

    /// Pair of teeth of a line of the last driver angle, as the family numbers them, and the gear whose tip edge
    /// touches along it, if one does.
    fn pair_and_tip(&self, line: usize) -> (i64, Option<TipGear>);

    /// Whether the patches that were found are all that close by this approach \[m\]. Where they are not, the next
    /// search reaches farther.
    ///
    /// # Errors
    /// An approach that no search reaches.
    fn reaches(&mut self, _approach_m: f64) -> Result<bool, ContactError> {
        Ok(true)
    }

    /// Radius \[m\] at gear 2 along whose circle the transmission error is counted; of involute gears that of the base
    /// circle.
    fn radius_2_m(&self) -> f64;
}
