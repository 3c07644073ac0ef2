//! `[tca]`: what a contact analysis is asked, and the assembly.

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{InputDocument, TableKeys};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::assembly::AssemblyError;
use crate::hand::FlankSide;
use crate::tca::TcaRequest;

/// Contact analysis and assembly.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct AssemblyTable {
    /// Flank of the pinion that drives; "concave" where not given.
    pinion_flank: Option<FlankSide>,
    /// Marking thickness of the ellipses; 6.35 where not given.
    marking_um: Option<f64>,
    /// Positions a pitch; 48 where not given.
    positions_per_pitch: Option<usize>,
    /// Offset of the pinion along +y of the fixed frame; 0 where not given.
    offset_um: Option<f64>,
    /// Pinion moved away from the apex along its axis; 0 where not given.
    pinion_axial_um: Option<f64>,
    /// Gear moved away from the apex along its axis; 0 where not given.
    gear_axial_um: Option<f64>,
    /// How much larger the shaft angle is; 0 where not given.
    shaft_angle_mrad: Option<f64>,
}

impl AssemblyTable {
    pub(super) fn request(
        &self,
        document: &InputDocument,
    ) -> Result<(FlankSide, TcaRequest), InputError> {
        let keys = TableKeys::new(document, "tca");
        let default = TcaRequest::default();
        let marking = self.marking_um.unwrap_or(6.35);
        keys.require(
            "marking_um",
            marking,
            (0.1..=100.0).contains(&marking),
            "0.1 to 100",
        )?;
        let per_pitch = self.positions_per_pitch.unwrap_or(default.per_pitch);
        if !(8..=1000).contains(&per_pitch) {
            return Err(keys.error(
                "positions_per_pitch",
                format!("found {per_pitch}, allowed is 8 to 1000"),
            ));
        }
        let micrometres = |key: &str, value: Option<f64>| -> Result<f64, InputError> {
            let value = value.unwrap_or(0.0);
            keys.require(key, value, value.abs() <= 5000.0, "-5000 to 5000")?;
            Ok(1e-6 * value)
        };
        let tilt = self.shaft_angle_mrad.unwrap_or(0.0);
        keys.require("shaft_angle_mrad", tilt, tilt.abs() <= 50.0, "-50 to 50")?;
        let error = AssemblyError {
            offset_m: micrometres("offset_um", self.offset_um)?,
            pinion_axial_m: micrometres("pinion_axial_um", self.pinion_axial_um)?,
            gear_axial_m: micrometres("gear_axial_um", self.gear_axial_um)?,
            shaft_angle_rad: 1e-3 * tilt,
        };
        let request = TcaRequest {
            error,
            marking_m: 1e-6 * marking,
            per_pitch,
            ..default
        };
        Ok((self.pinion_flank.unwrap_or(FlankSide::Concave), request))
    }
}
