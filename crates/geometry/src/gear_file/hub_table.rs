//! `[hub]`: how the bore is held.

use super::TableKeys;
use super::material_table::needs_density;
use crate::definition::{HubSupport, Material};
use crate::input::{InputDocument, InputError};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The keys of `[hub]`.
#[derive(Deserialize, Serialize, JsonSchema, Default)]
#[serde(deny_unknown_fields)]
pub struct HubTable {
    /// "fixed", or "reference-point": rigid, with six degrees of freedom, on the axis at mid-face, of bevel gears at
    /// the pitch apex; "fixed" where not given.
    #[serde(default)]
    support: HubSupport,
}

impl HubTable {
    /// The support asked for, not yet checked.
    pub(super) const fn support(&self) -> HubSupport {
        self.support
    }

    /// The support.
    ///
    /// # Errors
    /// [`InputError`] for a reference point without a density or in plane strain.
    pub fn check(
        self,
        document: &InputDocument,
        material: &Material,
        plane_strain: bool,
    ) -> Result<HubSupport, InputError> {
        if self.support == HubSupport::ReferencePoint {
            needs_density(
                document,
                "hub.support",
                material,
                "bodies on a reference point",
            )?;
            if plane_strain {
                return Err(TableKeys::new(document, "hub").error(
                    "support",
                    "a cross-section in plane strain has no six rigid motions; set support = \"fixed\" or mesh.plane_strain = false",
                ));
            }
        }
        Ok(self.support)
    }
}
