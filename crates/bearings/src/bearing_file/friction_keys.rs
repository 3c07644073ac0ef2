//! Keys of `[friction]`.

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{InputDocument, TableKeys};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::definition::BearingGeometry;
use crate::friction::{Friction, LoadFactor, usual_factors};

/// `[friction]`: friction torque by Palmgren's model.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub(super) struct FrictionTable {
    /// Viscosity of the lubricant at the bearing's temperature; of a grease that of its base oil.
    viscosity_mm2_per_s: f64,
    /// f0 of the part without load, for a row; where not given that of the type in an oil bath: deep groove 2, angular contact 3.3, cylindrical rollers 3,
    /// tapered rollers 6. Oil mist and little grease half of it, oil jets and vertical shafts twice.
    f0: Option<f64>,
    /// f1 of the part by the load; where not given that of the type: deep groove 0.0005 (P0/C0)^0.55, angular contact 0.001 (P0/C0)^0.33, cylindrical rollers
    /// 0.0003, tapered rollers 0.0004.
    f1: Option<f64>,
    /// Torque of all seals, as their maker states it; 0 where not given.
    seal_torque_Nm: Option<f64>,
}

/// Checks the table.
pub(super) fn friction(
    table: &FrictionTable,
    document: &InputDocument,
    geometry: &BearingGeometry,
) -> Result<Friction, InputError> {
    let keys = TableKeys::new(document, "friction");
    if !geometry.is_classic() {
        return Err(keys.error(
            "",
            "Palmgren's factors of four-point, thrust and spherical roller bearings are not built in; remove the table",
        ));
    }
    let within = |key: &str, value: f64, most: f64| {
        let allowed = format!("0 to {most}");
        keys.require(key, value, (0.0..=most).contains(&value), &allowed)
    };
    let viscosity = table.viscosity_mm2_per_s;
    let is_oil = viscosity > 0.0 && viscosity <= 1e5;
    keys.require(
        "viscosity_mm2_per_s",
        viscosity,
        is_oil,
        "more than 0 and at most 100000",
    )?;
    let (viscous_factor, load_factor) = usual_factors(geometry);
    let viscous_factor = table.f0.unwrap_or(viscous_factor);
    within("f0", viscous_factor, 100.0)?;
    let load_factor = match table.f1 {
        None => load_factor,
        Some(f1) => {
            within("f1", f1, 0.1)?;
            LoadFactor::Stated(f1)
        }
    };
    let seals_nm = table.seal_torque_Nm.unwrap_or(0.0);
    within("seal_torque_Nm", seals_nm, 1e4)?;
    Ok(Friction {
        viscosity_mm2_per_s: viscosity,
        viscous_factor,
        load_factor,
        seals_nm,
    })
}
