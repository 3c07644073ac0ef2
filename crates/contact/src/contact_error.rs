//! Why a contact of two elastic gears has no state, at rest or in motion.

use crate::nlcp::{LocalLawError, NlcpError};
use gearmesh_model::ReducedGearError;

/// Why no contact state could be computed.
#[derive(Debug, thiserror::Error)]
pub enum ContactError {
    /// The model does not carry loads on the flank in contact.
    #[error(transparent)]
    Model(#[from] ReducedGearError),
    /// The faces do not overlap.
    #[error(
        "the gears stand side by side: {displacement_mm:.4} mm apart along the axis with faces {:.4} and {:.4} mm wide; move them so that their faces overlap",
        widths_mm[0],
        widths_mm[1]
    )]
    Apart {
        /// Axial displacement of gear 2.
        displacement_mm: f64,
        /// Face widths.
        widths_mm: [f64; 2],
    },
    /// A number of slices that the models cannot stand for.
    #[error(
        "found {found} slices, allowed are 1 to {most}: the flank grids of the models resolve no more over the overlap of the faces; \
         for more, reduce the gears again with more `slices` under [reduction]"
    )]
    Slices {
        /// Slices asked for.
        found: usize,
        /// Most slices.
        most: usize,
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
    /// All flanks that could carry the load at this position are gone.
    #[error(
        "no flank is left to touch: the teeth that would carry the load there are broken off; gears turn on until others touch, \
         which a multibody scene shows"
    )]
    NoFlanks,
    /// No flanks are within reach of each other.
    #[error("no flanks face each other there: the gears are out of mesh")]
    NothingFaces,
    /// The gears cannot mesh as they stand.
    #[error("{0}")]
    Flanks(Box<dyn std::error::Error + Send + Sync>),
    /// More patches than there is memory for.
    #[error("{found} slices face each other, more than the {most} that the pair was prepared for")]
    TooMany {
        /// Patches found.
        found: usize,
        /// Most patches.
        most: usize,
    },
    /// No local law.
    #[error("contact of tooth {} of gear 1 and tooth {} of gear 2: {cause}", teeth[0], teeth[1])]
    LocalLaw {
        /// Teeth of gear 1 and gear 2.
        teeth: [usize; 2],
        /// Cause.
        cause: LocalLawError,
    },
    /// No solution.
    #[error("slice forces: {0}")]
    Nlcp(#[from] NlcpError),
    /// At one position of a pair.
    #[error("at driver angle {angle_deg:.4} deg: {cause}")]
    At {
        /// Driver angle.
        angle_deg: f64,
        /// Cause.
        cause: Box<ContactError>,
    },
}

impl ContactError {
    /// Whether the computation failed, not the input.
    #[must_use]
    pub fn is_computation(&self) -> bool {
        match self {
            Self::At { cause, .. } => cause.is_computation(),
            Self::LocalLaw { .. } | Self::Nlcp(_) | Self::TooMany { .. } => true,
            _ => false,
        }
    }
}
