//! `[material]`: linear elastic, isotropic.

use super::TableKeys;
use crate::definition::Material;
use crate::input::{InputDocument, InputError};
use serde::Deserialize;

/// The keys of `[material]`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub(super) struct MaterialTable {
    young_GPa: f64,
    poisson: f64,
}

impl MaterialTable {
    /// The material, in SI units.
    pub(super) fn check(self, document: &InputDocument) -> Result<Material, InputError> {
        let keys = TableKeys::new(document, "material");
        keys.require(
            "young_GPa",
            self.young_GPa,
            self.young_GPa > 0.0,
            "more than 0",
        )?;
        keys.require(
            "poisson",
            self.poisson,
            (0.0..0.5).contains(&self.poisson),
            "0 up to, not including, 0.5",
        )?;
        Ok(Material {
            young_pa: self.young_GPa * 1e9,
            poisson: self.poisson,
        })
    }
}
