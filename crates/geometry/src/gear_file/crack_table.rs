//! `[crack]`: a crack in one tooth's root.

use gearmesh_elements::Element;

use super::gauge_table::root_position;
use super::{MM, TableKeys};
use crate::definition::{
    CrackDefinition, Flank, GearDefinition, ReductionSettings, ToothDefinition,
};
use crate::input::{Bounded, InputDocument, InputError, Within};
use crate::profile_curve::ProfileCurve;
use crate::tooth::ToothGeometry;
use schemars::JsonSchema;
use serde::Deserialize;
use std::f64::consts::FRAC_PI_2;

/// The keys of `[crack]`.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct CrackTable {
    /// Tooth, from 0.
    tooth: usize,
    /// Side on which it opens.
    side: Flank,
    /// Depth.
    depth_mm: f64,
    /// Direction against the tooth's centre line: 0 towards the centre of the gear, 90 straight across; at right angles
    /// to the profile where not given.
    angle_deg: Option<Bounded<Within<0, 90>>>,
    /// Place of the mouth: angle of the profile's tangent with the tooth's centre line. This or radius_mm; 30 where
    /// neither is given.
    tangent_deg: Option<f64>,
    /// Place of the mouth: its radius.
    radius_mm: Option<f64>,
}

impl CrackTable {
    /// The crack, in SI units.
    pub(super) fn check(
        self,
        document: &InputDocument,
        tooth: &ToothDefinition,
        profile: &ToothGeometry,
        reduction: &ReductionSettings,
    ) -> Result<CrackDefinition, InputError> {
        let keys = TableKeys::new(document, "crack");
        keys.require_tooth(self.tooth, tooth.teeth)?;
        if !reduction.flanks.contains(&self.side) {
            return Err(keys.error(
                "side",
                format!(
                    "loads on the {} flanks open this crack, and reduction.flanks has none there; add them",
                    self.side.name()
                ),
            ));
        }
        let curve = ProfileCurve::new(profile);
        let start = root_position(
            &keys,
            &curve,
            (self.tangent_deg, self.radius_mm),
            "the crack's mouth",
        )?;
        let mouth_arc_m = (curve.arc_length_at(start)).map_err(|e| keys.error("radius_mm", e))?;
        if mouth_arc_m > curve.flank_start_m() {
            return Err(keys.error(
                "radius_mm",
                "the crack's mouth lies on the flank, allowed is the root fillet",
            ));
        }
        let thickness_mm = -2.0 * curve.point_at(mouth_arc_m)[1] / MM;
        keys.require(
            "depth_mm",
            self.depth_mm,
            self.depth_mm > 0.0 && self.depth_mm < thickness_mm,
            &format!("more than 0 and less than the tooth's thickness there, {thickness_mm:.3}"),
        )?;
        let angle_rad = match self.angle_deg {
            None => FRAC_PI_2 - curve.tangent_angle_at_rad(mouth_arc_m),
            Some(angle) => angle.to_radians(),
        };
        Ok(CrackDefinition {
            tooth: self.tooth,
            side: self.side,
            start,
            depth_m: self.depth_mm * MM,
            angle_rad,
        })
    }
}

/// Refuses a crack where there are no layers of hexahedra whose nodes could be doubled.
pub(super) fn check_mesh(
    gear: &GearDefinition,
    document: &InputDocument,
) -> Result<(), InputError> {
    if gear.crack.is_none() {
        return Ok(());
    }
    let problem = if gear.blank.rim().is_some() {
        "cracks are made in external teeth only; remove [crack]"
    } else if gear.blank.meshed().is_some() {
        "a crack is cut into gearmesh's own mesh, blank.kind = \"mesh\" has none; remove [crack]"
    } else if gear.mesh.element == Element::Tet10 {
        "a crack follows the sides of hexahedra, and this gear is meshed in tetrahedra; set mesh.element to one of hexahedra or remove [crack]"
    } else {
        return Ok(());
    };
    Err(document.error("crack", problem))
}
