//! Keys of `[friction]`.

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{Bounded, End, InputDocument, TableKeys, UpTo, Within};
use gearmesh_geometry::number_range;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::definition::BearingGeometry;
use crate::friction::{Friction, LoadFactor, usual_factors};

/// `[friction]`: friction torque by Palmgren's model.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub(super) struct FrictionTable {
    /// Viscosity of the lubricant at the bearing's temperature; of a grease that of its base oil.
    viscosity_mm2_per_s: Bounded<UpTo<100_000>>,
    /// f0 of the part without load, for a row; where not given that of the type in an oil bath: deep groove 2, angular
    /// contact 3.3, cylindrical rollers 3, tapered rollers 6. Oil mist and little grease half of it, oil jets and
    /// vertical shafts twice.
    f0: Option<Bounded<Within<0, 100>>>,
    /// f1 of the part by the load; where not given that of the type: deep groove 0.0005 (P0/C0)^0.55, angular
    /// contact 0.001 (P0/C0)^0.33, cylindrical rollers 0.0003, tapered rollers 0.0004.
    f1: Option<Bounded<LoadFactors>>,
    /// Torque of all seals, as their maker states it; 0 where not given.
    seal_torque_Nm: Option<Bounded<Within<0, 10_000>>>,
}

number_range!(
    /// Palmgren's f1: a hundred times that of any type.
    LoadFactors: End::At(0.0), End::At(0.1)
);

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
    let (viscous_factor, load_factor) = usual_factors(geometry);
    Ok(Friction {
        viscosity_mm2_per_s: *table.viscosity_mm2_per_s,
        viscous_factor: table.f0.map_or(viscous_factor, f64::from),
        load_factor: table.f1.map_or(load_factor, |f1| LoadFactor::Stated(*f1)),
        seals_nm: table.seal_torque_Nm.map_or(0.0, f64::from),
    })
}
