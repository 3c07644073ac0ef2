//! `[pinion.concave]` and its like: settings of the machine for one flank, in and out.

use std::fmt::Write as _;

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{
    Bounded, End, InputDocument, NotNegative, Positive, TableKeys, UpTo, Within,
};
use gearmesh_geometry::number_range;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::settings::{FaceMill, MachineSettings, Roll, Tool};

/// Settings of a face milling machine for one flank. Signs: docs/theory/bevel_gears.md, "Frames".
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SettingsTable {
    /// Radius of the blade's point.
    pub point_radius_mm: Bounded<Positive>,
    /// Angle of the blade.
    pub blade_angle_deg: Bounded<Within<0, 45>>,
    /// Radius of the blade's edge.
    pub edge_radius_mm: Bounded<NotNegative>,
    /// Radial distance of the cutter from the cradle's axis.
    pub radial_distance_mm: Bounded<Positive>,
    /// Cradle angle; positive for a right hand.
    pub cradle_angle_deg: Bounded<Within<-180, 180>>,
    /// Machine root angle.
    pub machine_root_angle_deg: Bounded<RootAngle>,
    /// Sliding base; away from the cradle is positive. 0 where not given.
    pub sliding_base_mm: Option<f64>,
    /// Offset of the work along +y of the machine; 0 where not given.
    pub offset_mm: Option<f64>,
    /// Machine centre to back, towards the heel; 0 where not given.
    pub work_offset_mm: Option<f64>,
    /// Ratio of roll, work over cradle; not given for a formate member.
    pub ratio_of_roll: Option<Bounded<UpTo<100>>>,
    /// Modified roll c2, c3, c4; 0 where not given.
    pub modified_roll: Option<[f64; 3]>,
}

number_range!(
    /// Machine root angles: from a rack to a crown gear.
    pub RootAngle: End::Beyond(0.0), End::Beyond(90.0)
);

impl SettingsTable {
    pub(super) fn settings(
        &self,
        document: &InputDocument,
        table: &str,
    ) -> Result<MachineSettings, InputError> {
        let keys = TableKeys::new(document, table);
        if self.ratio_of_roll.is_none() && self.modified_roll.is_some() {
            return Err(keys.error(
                "modified_roll",
                "is not used without ratio_of_roll: the work is held; remove it",
            ));
        }
        Ok(MachineSettings {
            tool: Tool::FaceMill(FaceMill {
                point_radius_m: 1e-3 * *self.point_radius_mm,
                blade_angle_rad: self.blade_angle_deg.to_radians(),
                edge_radius_m: 1e-3 * *self.edge_radius_mm,
                radial_m: 1e-3 * *self.radial_distance_mm,
                cradle_angle_rad: self.cradle_angle_deg.to_radians(),
            }),
            root_angle_rad: self.machine_root_angle_deg.to_radians(),
            sliding_base_m: 1e-3 * self.sliding_base_mm.unwrap_or(0.0),
            offset_m: 1e-3 * self.offset_mm.unwrap_or(0.0),
            work_offset_m: 1e-3 * self.work_offset_mm.unwrap_or(0.0),
            roll: self.ratio_of_roll.map(|ratio| Roll {
                ratio: *ratio,
                modified: self.modified_roll.unwrap_or_default(),
            }),
        })
    }
}

/// Settings as a table of a pair file; none for a plane tool, which has none.
pub fn settings_toml(settings: &MachineSettings, table: &str) -> Option<String> {
    let mill = settings.face_mill()?;
    let mut text = format!("[{table}]\n");
    let mut line = |key: &str, value: f64| {
        let _ = writeln!(text, "{key} = {value:?}");
    };
    line("point_radius_mm", 1e3 * mill.point_radius_m);
    line("blade_angle_deg", mill.blade_angle_rad.to_degrees());
    line("edge_radius_mm", 1e3 * mill.edge_radius_m);
    line("radial_distance_mm", 1e3 * mill.radial_m);
    line("cradle_angle_deg", mill.cradle_angle_rad.to_degrees());
    line(
        "machine_root_angle_deg",
        settings.root_angle_rad.to_degrees(),
    );
    line("sliding_base_mm", 1e3 * settings.sliding_base_m);
    line("offset_mm", 1e3 * settings.offset_m);
    line("work_offset_mm", 1e3 * settings.work_offset_m);
    if let Some(roll) = settings.roll {
        line("ratio_of_roll", roll.ratio);
        let [c2, c3, c4] = roll.modified;
        let _ = writeln!(text, "modified_roll = [{c2:?}, {c3:?}, {c4:?}]");
    }
    Some(text)
}
