//! `[[gauge]]`: strain gauges in the tooth roots.

use super::{MM, TableKeys};
use crate::definition::{Flank, GaugeDefinition, RootPosition, ToothDefinition};
use crate::input::{InputDocument, InputError};
use crate::profile_curve::ProfileCurve;
use crate::tooth::ToothGeometry;
use schemars::JsonSchema;
use serde::Deserialize;

/// The keys of one `[[gauge]]`.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct GaugeTable {
    /// Name.
    name: String,
    /// Tooth, from 0.
    tooth: usize,
    /// Side of the tooth.
    side: Flank,
    /// Place: angle of the profile's tangent with the tooth's centre line. This or radius_mm; 30 where neither is
    /// given.
    tangent_deg: Option<f64>,
    /// Place: radius.
    radius_mm: Option<f64>,
    /// Length along the profile.
    length_mm: f64,
    /// Middle along the axis from mid-face; 0 where not given.
    #[serde(default)]
    z_mm: f64,
    /// Width along the axis.
    width_mm: f64,
}

impl GaugeTable {
    /// The gauge, in SI units; `others` are the gauges above it in the file.
    fn check(
        self,
        keys: &TableKeys,
        others: &[GaugeDefinition],
        tooth: &ToothDefinition,
        curve: &ProfileCurve,
    ) -> Result<GaugeDefinition, InputError> {
        keys.require_tooth(self.tooth, tooth.teeth)?;
        if others.iter().any(|other| other.name == self.name) {
            return Err(keys.error("name", format!("`{}` is used by another gauge", self.name)));
        }
        let half_width = 0.5 * tooth.face_width_m / MM;
        if !(self.width_mm > 0.0 && self.z_mm.abs() + 0.5 * self.width_mm <= half_width) {
            return Err(keys.error(
                "width_mm",
                format!(
                    "found {} at z {} mm: the gauge must lie between z -{half_width} and {half_width} mm",
                    self.width_mm, self.z_mm
                ),
            ));
        }
        keys.require(
            "length_mm",
            self.length_mm,
            self.length_mm > 0.0 && self.length_mm <= tooth.module_m / MM,
            "more than 0 and at most one module",
        )?;
        Ok(GaugeDefinition {
            position: root_position(keys, curve, (self.tangent_deg, self.radius_mm), "the gauge")?,
            name: self.name,
            tooth: self.tooth,
            side: self.side,
            length_m: self.length_mm * MM,
            z_m: self.z_mm * MM,
            width_m: self.width_mm * MM,
        })
    }
}

/// Where on the root fillet something sits, by `tangent_deg` or `radius_mm`; the 30 degree tangent where neither is
/// given. `what`: what is placed, in words.
pub(super) fn root_position(
    keys: &TableKeys,
    curve: &ProfileCurve,
    (tangent_deg, radius_mm): (Option<f64>, Option<f64>),
    what: &str,
) -> Result<RootPosition, InputError> {
    let (key, position) = match (tangent_deg, radius_mm) {
        (None, None) => (
            "tangent_deg",
            RootPosition::TangentAngle(30f64.to_radians()),
        ),
        (Some(angle), None) => (
            "tangent_deg",
            RootPosition::TangentAngle(angle.to_radians()),
        ),
        (None, Some(radius)) => ("radius_mm", RootPosition::Radius(radius * MM)),
        (Some(_), Some(_)) => {
            return Err(keys.error(
                "radius_mm",
                format!("tangent_deg and radius_mm both place {what}; give one of them"),
            ));
        }
    };
    match curve.arc_length_at(position) {
        Ok(_) => Ok(position),
        Err(problem) => Err(keys.error(key, problem)),
    }
}

/// All gauges of the file, in its order.
pub(super) fn check_all(
    tables: Vec<GaugeTable>,
    document: &InputDocument,
    tooth: &ToothDefinition,
    profile: &ToothGeometry,
) -> Result<Vec<GaugeDefinition>, InputError> {
    let curve = ProfileCurve::new(profile);
    let mut gauges = Vec::with_capacity(tables.len());
    for (i, table) in tables.into_iter().enumerate() {
        let path = format!("gauge.{i}");
        let keys = TableKeys::new(document, &path);
        gauges.push(table.check(&keys, &gauges, tooth, &curve)?);
    }
    Ok(gauges)
}
