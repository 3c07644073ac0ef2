//! `[material]`: linear elastic, isotropic.

use super::TableKeys;
use crate::definition::Material;
use crate::input::{InputDocument, InputError};
use schemars::JsonSchema;
use serde::Deserialize;

/// The keys of `[material]`.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct MaterialTable {
    /// Young's modulus.
    young_GPa: f64,
    /// Poisson's ratio.
    poisson: f64,
    /// Density; needed by natural modes and by a body that moves.
    density_kg_per_m3: Option<f64>,
}

impl MaterialTable {
    /// The material, in SI units.
    ///
    /// # Errors
    /// [`InputError`] for a constant that no elastic material has.
    pub fn check(self, document: &InputDocument) -> Result<Material, InputError> {
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
        if let Some(density) = self.density_kg_per_m3 {
            keys.require("density_kg_per_m3", density, density > 0.0, "more than 0")?;
        }
        Ok(Material {
            young_pa: self.young_GPa * 1e9,
            poisson: self.poisson,
            density_kg_per_m3: self.density_kg_per_m3,
        })
    }
}

/// Complains at `key` where the material has no density.
pub(super) fn needs_density(
    document: &InputDocument,
    key: &str,
    material: &Material,
    what: &str,
) -> Result<(), InputError> {
    match material.density_kg_per_m3 {
        Some(_) => Ok(()),
        None => Err(document.error(
            key,
            format!("{what} need a density; add material.density_kg_per_m3, 7850 for steel"),
        )),
    }
}
