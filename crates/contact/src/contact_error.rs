//! Why a contact of two reduced gears has no state.

use crate::nlcp::{LocalLawError, NlcpError};
use gearmesh_model::ReducedGearError;

/// Why no contact state could be computed.
#[derive(Debug, thiserror::Error)]
pub enum ContactError {
    /// The model does not carry loads on the flank in contact.
    #[error(transparent)]
    Model(#[from] ReducedGearError),
    /// The two models have different slices.
    #[error(
        "the gears have {slices_1} and {slices_2} slices of {width_1_mm:.4} and {width_2_mm:.4} mm; reduce both with the same reduction.slices and face width"
    )]
    Slices {
        /// Slices of gear 1.
        slices_1: usize,
        /// Slices of gear 2.
        slices_2: usize,
        /// Slice width of gear 1.
        width_1_mm: f64,
        /// Slice width of gear 2.
        width_2_mm: f64,
    },
    /// The model's teeth are not those of the pair.
    #[error("the model of gear {gear} has {found} teeth, the pair needs {needed}")]
    Teeth {
        /// Gear 1 or 2.
        gear: usize,
        /// Teeth of the model.
        found: usize,
        /// Teeth of the pair.
        needed: usize,
    },
    /// Tip edges of helical teeth are not modelled.
    #[error(
        "helical teeth touch on the path of contact only: an extended path needs spur gears; leave the extension out"
    )]
    HelicalExtension,
    /// No local law.
    #[error("at driver angle {angle_deg:.4} deg: {cause}")]
    LocalLaw {
        /// Driver angle.
        angle_deg: f64,
        /// Cause.
        cause: LocalLawError,
    },
    /// No solution.
    #[error("at driver angle {angle_deg:.4} deg: {cause}")]
    Nlcp {
        /// Driver angle.
        angle_deg: f64,
        /// Cause.
        cause: NlcpError,
    },
}
