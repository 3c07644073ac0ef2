//! Elastic materials of gears and shafts.

use crate::error::Result;
use crate::ledger::About;
use crate::source::Part;
use crate::units::{KG_PER_DM3, MPA, ONE};

/// Linear elastic material.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Material {
    /// Young's modulus \[GPa\].
    pub young_gpa: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Density \[kg/m³\].
    pub density_kg_per_m3: f64,
}

/// Steel, where the file says nothing.
pub const STEEL: Material = Material {
    young_gpa: 206.0,
    poisson: 0.3,
    density_kg_per_m3: 7850.0,
};

/// Larger moduli stand for rigid bodies \[MPa\]: a hundred times that of steel is stiff enough.
const MOST_MPA: f64 = 2e7;

/// Material of a component, steel where it names none.
///
/// # Errors
/// Those of [`Part`].
pub fn material(component: Part<'_>) -> Result<Material> {
    let mut named = component.parts(&["material"]);
    let Some(found) = named.next() else {
        let what = "no material given: steel, 206 GPa, 0.3, 7850 kg/m3";
        component.assume(About::Stiffness, what);
        return Ok(STEEL);
    };
    let young = found.positive("elastic_modulus", MPA)?;
    if let Some(rigid) = young.filter(|&e| e > MOST_MPA) {
        let what = format!("a modulus of {rigid:e} MPa stands for rigid: {MOST_MPA:e} MPa");
        found.assume(About::Small, what);
    }
    let poisson = found
        .number("poisson_ratio", ONE)?
        .filter(|v| (0.0..0.5).contains(v));
    let density = found.positive("density", KG_PER_DM3)?;
    if young.is_none() || poisson.is_none() || density.is_none() {
        found.assume(About::Stiffness, "modulus, Poisson's ratio or density not given or not possible: those of steel, 206 GPa, 0.3, 7850 kg/m3");
    }
    Ok(Material {
        young_gpa: young.map_or(STEEL.young_gpa, |e| 1e-3 * e.min(MOST_MPA)),
        poisson: poisson.unwrap_or(STEEL.poisson),
        density_kg_per_m3: density.map_or(STEEL.density_kg_per_m3, |d| 1e3 * d),
    })
}
