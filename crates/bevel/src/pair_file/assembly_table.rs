//! `[tca]`: what a contact analysis is asked, and the assembly.

use gearmesh_geometry::input::{Bounded, Count, End, Within};
use gearmesh_geometry::number_range;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::assembly::AssemblyError;
use crate::hand::FlankSide;
use crate::tca::TcaRequest;

/// Contact analysis and assembly.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AssemblyTable {
    /// Flank of the pinion that drives; "concave" where not given.
    pub pinion_flank: Option<FlankSide>,
    /// Marking thickness of the ellipses; 6.35 where not given.
    pub marking_um: Option<Bounded<MarkingThickness>>,
    /// Positions a pitch; 48 where not given.
    pub positions_per_pitch: Option<Count<8, 1000>>,
    /// Offset of the pinion along +y of the fixed frame; 0 where not given.
    pub offset_um: Option<Bounded<Within<-5000, 5000>>>,
    /// Pinion moved away from the apex along its axis; 0 where not given.
    pub pinion_axial_um: Option<Bounded<Within<-5000, 5000>>>,
    /// Gear moved away from the apex along its axis; 0 where not given.
    pub gear_axial_um: Option<Bounded<Within<-5000, 5000>>>,
    /// How much larger the shaft angle is; 0 where not given.
    pub shaft_angle_mrad: Option<Bounded<Within<-50, 50>>>,
}

number_range!(
    /// Thicknesses of marking compound.
    pub MarkingThickness: End::At(0.1), End::At(100.0)
);

/// The usual thickness of marking compound \[µm\].
pub(super) const DEFAULT_MARKING_UM: f64 = 6.35;

impl AssemblyTable {
    pub(super) fn request(&self) -> (FlankSide, TcaRequest) {
        let default = TcaRequest::default();
        let micrometres =
            |value: Option<Bounded<Within<-5000, 5000>>>| 1e-6 * value.map_or(0.0, f64::from);
        let request = TcaRequest {
            error: AssemblyError {
                offset_m: micrometres(self.offset_um),
                pinion_axial_m: micrometres(self.pinion_axial_um),
                gear_axial_m: micrometres(self.gear_axial_um),
                shaft_angle_rad: 1e-3 * self.shaft_angle_mrad.map_or(0.0, f64::from),
            },
            marking_m: 1e-6 * self.marking_um.map_or(DEFAULT_MARKING_UM, f64::from),
            per_pitch: self
                .positions_per_pitch
                .map_or(default.per_pitch, Count::get),
            ..default
        };
        (self.pinion_flank.unwrap_or(FlankSide::Concave), request)
    }
}
