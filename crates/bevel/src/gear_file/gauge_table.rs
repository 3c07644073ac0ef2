//! `[[gauge]]`: strain gauges in the tooth roots.

use gearmesh_geometry::input::{Bounded, End, TableKeys};
use gearmesh_geometry::number_range;
use gearmesh_geometry::{Flank, InputError};
use schemars::JsonSchema;
use serde::Deserialize;

use super::MM;
use crate::bevel_gear::{BevelGauge, BevelGear};

/// The keys of one `[[gauge]]`.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct GaugeTable {
    /// Name.
    name: String,
    /// Tooth, from 0.
    tooth: usize,
    /// Side of the tooth: "right" faces clockwise about the axis from apex to heel.
    side: Flank,
    /// Angle between the fillet's tangent and the tooth's centre line, in the section normal to the tooth; 30 where not
    /// given.
    tangent_deg: Option<Bounded<RootTangent>>,
    /// Length along the profile.
    length_mm: f64,
    /// Middle along the pitch cone from mid-face towards the heel; 0 where not given.
    #[serde(default)]
    along_mm: f64,
    /// Width along the tooth.
    width_mm: f64,
}

number_range!(
    /// Tangents of a fillet: from along the tooth's centre line to straight across.
    RootTangent: End::Beyond(0.0), End::Beyond(90.0)
);

impl GaugeTable {
    /// The gauge, in SI units; `gear` has those above it in the file.
    pub(super) fn check(
        self,
        keys: &TableKeys,
        gear: &BevelGear,
    ) -> Result<BevelGauge, InputError> {
        let blank = gear.blank();
        keys.require_tooth(self.tooth, blank.teeth)?;
        if gear.gauges.iter().any(|other| other.name == self.name) {
            return Err(keys.error("name", format!("`{}` is used by another gauge", self.name)));
        }
        let half_mm = 0.5 * blank.face_width_m / MM;
        keys.require(
            "along_mm",
            self.along_mm,
            self.along_mm.abs() <= half_mm,
            &format!("-{half_mm} to {half_mm}"),
        )?;
        keys.require(
            "width_mm",
            self.width_mm,
            self.width_mm > 0.0 && self.along_mm.abs() + 0.5 * self.width_mm <= half_mm,
            "more than 0, the gauge between toe and heel",
        )?;
        let module_mm = gear.mean_module_m() / MM;
        keys.require(
            "length_mm",
            self.length_mm,
            self.length_mm > 0.0 && self.length_mm <= module_mm,
            &format!("more than 0 and at most {module_mm:.4}, the mean module"),
        )?;
        let tangent = self.tangent_deg.map_or(30.0, f64::from);
        Ok(BevelGauge {
            name: self.name,
            tooth: self.tooth,
            side: self.side,
            tangent_rad: tangent.to_radians(),
            length_m: self.length_mm * MM,
            along_m: self.along_mm * MM,
            width_m: self.width_mm * MM,
        })
    }
}
