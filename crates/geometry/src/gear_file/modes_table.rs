//! `[modes]`: natural modes with the bore held, for the dynamics.

use super::TableKeys;
use super::material_table::needs_density;
use crate::definition::{Material, ModeRange};
use crate::input::{Bounded, Count, InputDocument, InputError, Positive};
use schemars::JsonSchema;
use serde::Deserialize;

/// The keys of `[modes]`.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct ModesTable {
    /// So many, the lowest. This or up_to_Hz.
    count: Option<Count<1, 1000>>,
    /// All up to this frequency.
    up_to_Hz: Option<Bounded<Positive>>,
}

impl ModesTable {
    /// Which modes are wanted.
    ///
    /// # Errors
    /// [`InputError`] without a density, in plane strain, or where it does not say one of both ways which modes.
    pub fn check(
        self,
        document: &InputDocument,
        material: &Material,
        plane_strain: bool,
    ) -> Result<ModeRange, InputError> {
        let keys = TableKeys::new(document, "modes");
        needs_density(document, "modes", material, "natural modes")?;
        if plane_strain {
            return Err(document.error(
                "modes",
                "plane strain has no natural modes of a gear; remove [modes] or set mesh.plane_strain = false",
            ));
        }
        match (self.count, self.up_to_Hz) {
            (Some(count), None) => Ok(ModeRange::Count(count.get())),
            (None, Some(hz)) => Ok(ModeRange::UpToHz(*hz)),
            (Some(_), Some(_)) => Err(keys.error(
                "count",
                "count and up_to_Hz exclude each other; keep one of them",
            )),
            (None, None) => Err(document.error(
                "modes",
                "say which modes: up_to_Hz, a frequency, or count, a number",
            )),
        }
    }
}
