//! `[material]`: linear elastic, isotropic.

use crate::definition::Material;
use crate::input::{Bounded, End, InputDocument, InputError, Positive};
use crate::number_range;
use schemars::JsonSchema;
use serde::Deserialize;

/// The keys of `[material]`.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct MaterialTable {
    /// Young's modulus.
    young_GPa: Bounded<Positive>,
    /// Poisson's ratio.
    poisson: Bounded<PoissonRatio>,
    /// Density; needed by natural modes and by a body that moves.
    density_kg_per_m3: Option<Bounded<Positive>>,
}

number_range!(
    /// Poisson's ratios of elastic metals; one of 0.5 keeps its volume, and its stiffness has no inverse.
    pub PoissonRatio: End::At(0.0), End::Beyond(0.5)
);

impl MaterialTable {
    /// The material, in SI units.
    pub fn material(&self) -> Material {
        Material {
            young_pa: *self.young_GPa * 1e9,
            poisson: *self.poisson,
            density_kg_per_m3: self.density_kg_per_m3.map(f64::from),
        }
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
