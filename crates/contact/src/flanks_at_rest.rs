//! What a contact at rest asks of the kinematics of two gears' flanks, whatever the family of the gears.
//!
//! | flanks | file |
//! | --- | --- |
//! | involute teeth, spur and helical, in closed form | `involute_at_rest.rs` |
//! | any flanks that run as a gear mesh, at the pose of the driver angle | `gearmesh-drivetrain`, `posed_flanks.rs` |

use crate::contact_error::ContactError;
use crate::contact_patch::ContactPatch;

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

    /// Radius \[m\] at gear 2 along whose circle the transmission error is counted; of involute gears that of the base
    /// circle.
    fn radius_2_m(&self) -> f64;
}
