//! `[microgeometry]`: what is removed from the ideal flanks.

use super::{MM, TableKeys, UM};
use crate::input::{InputDocument, InputError};
use crate::involute;
use crate::microgeometry::{Microgeometry, ProfileCrowning, ReliefShape, TipRelief};
use crate::tooth::ToothGeometry;
use schemars::JsonSchema;
use serde::Deserialize;

/// The keys of `[microgeometry]`.
#[derive(Deserialize, JsonSchema, Default)]
#[serde(deny_unknown_fields)]
pub(super) struct MicrogeometryTable {
    /// Profile crowning at the tip circle, a parabola in roll length from profile_crowning_diameter_mm on.
    profile_crowning_um: Option<f64>,
    /// Diameter at which the profile crowning is zero; needed with it.
    profile_crowning_diameter_mm: Option<f64>,
    /// Tip relief at the tip circle.
    tip_relief_um: Option<f64>,
    /// Diameter at which the tip relief begins; needed with it.
    tip_relief_start_diameter_mm: Option<f64>,
    /// "linear" or "parabolic" in roll length; "linear" where not given.
    tip_relief_shape: Option<TipReliefShape>,
    /// Lead crowning: a parabola over the face, zero at mid-face, this at both ends; 0 where not given.
    lead_crowning_um: Option<f64>,
    /// Slope of the flank line over the whole face width: removed at +z, added at -z, zero at mid-face; 0 where not
    /// given.
    flank_angle_um: Option<f64>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
enum TipReliefShape {
    Linear,
    Parabolic,
}

impl MicrogeometryTable {
    /// The microgeometry of both flanks, in SI units.
    pub(super) fn check(
        self,
        document: &InputDocument,
        profile: &ToothGeometry,
        face_width_m: f64,
    ) -> Result<Microgeometry, InputError> {
        let keys = TableKeys::new(document, "microgeometry");
        let profile_crowning = self.check_profile_crowning(&keys, profile)?;
        let tip_relief = self.check_tip_relief(&keys, profile)?;
        for (key, value) in [
            ("profile_crowning_um", self.profile_crowning_um),
            ("tip_relief_um", self.tip_relief_um),
            ("lead_crowning_um", self.lead_crowning_um),
            ("flank_angle_um", self.flank_angle_um),
        ] {
            if let Some(v) = value {
                keys.require(key, v, v.abs() <= 1000.0, "-1000 to 1000")?;
            }
        }
        Ok(Microgeometry {
            tip_roll_rad: profile.tip_roll_rad,
            face_width_m,
            profile_crowning,
            tip_relief,
            lead_crowning_m: self.lead_crowning_um.unwrap_or(0.0) * UM,
            flank_angle_m: self.flank_angle_um.unwrap_or(0.0) * UM,
        })
    }

    fn check_profile_crowning(
        &self,
        keys: &TableKeys,
        profile: &ToothGeometry,
    ) -> Result<Option<ProfileCrowning>, InputError> {
        let diameter_key = "profile_crowning_diameter_mm";
        match (self.profile_crowning_um, self.profile_crowning_diameter_mm) {
            (None, None) => Ok(None),
            (Some(amount), Some(diameter)) => Ok(Some(ProfileCrowning {
                amount_m: amount * UM,
                centre_roll_rad: roll_at(keys, diameter_key, diameter, profile)?,
            })),
            (Some(_), None) => Err(keys.error(
                "profile_crowning_um",
                "needs profile_crowning_diameter_mm, where nothing is removed",
            )),
            (None, Some(_)) => {
                Err(keys.error(diameter_key, "is not used without profile_crowning_um"))
            }
        }
    }

    fn check_tip_relief(
        &self,
        keys: &TableKeys,
        profile: &ToothGeometry,
    ) -> Result<Option<TipRelief>, InputError> {
        let start_key = "tip_relief_start_diameter_mm";
        match (self.tip_relief_um, self.tip_relief_start_diameter_mm) {
            (Some(amount), Some(diameter)) => Ok(Some(TipRelief {
                amount_m: amount * UM,
                start_roll_rad: roll_at(keys, start_key, diameter, profile)?,
                shape: match self.tip_relief_shape {
                    Some(TipReliefShape::Linear) | None => ReliefShape::Linear,
                    Some(TipReliefShape::Parabolic) => ReliefShape::Parabolic,
                },
            })),
            (Some(_), None) => {
                Err(keys.error("tip_relief_um", "needs tip_relief_start_diameter_mm"))
            }
            (None, Some(_)) => Err(keys.error(start_key, "is not used without tip_relief_um")),
            (None, None) if self.tip_relief_shape.is_some() => {
                Err(keys.error("tip_relief_shape", "is not used without tip_relief_um"))
            }
            (None, None) => Ok(None),
        }
    }
}

/// Roll angle of the flank at the diameter that `key` gives.
fn roll_at(
    keys: &TableKeys,
    key: &str,
    diameter_mm: f64,
    profile: &ToothGeometry,
) -> Result<f64, InputError> {
    let low = 2.0 * involute::radius_m(profile.form_roll_rad, profile.base_radius_m) / MM;
    let high = 2.0 * profile.tip_radius_m / MM;
    keys.require(
        key,
        diameter_mm,
        diameter_mm >= low && diameter_mm < high,
        &format!("{low:.3} to below {high:.3}: the involute part of the flank"),
    )?;
    Ok(involute::roll_angle_rad(
        0.5 * diameter_mm * MM,
        profile.base_radius_m,
    ))
}
