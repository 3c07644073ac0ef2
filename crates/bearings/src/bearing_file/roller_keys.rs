//! Keys of roller bearings.

use gearmesh_geometry::input::{Bounded, Count, End, Positive, TableKeys, Within};
use gearmesh_geometry::{InputError, kinds, number_range};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::element_keys::{Clearances, Elements};
use super::{MM, UM};
use crate::build_rows::half_taper_of;
use crate::definition::{RollerGeometry, RollerProfile, Taper};

/// Laminae where the file names none.
pub(super) const LAMINAE: usize = 40;

/// Lengths of rollers over their diameter: thinner ones are discs, longer ones wires.
const SLENDERNESS: [f64; 2] = [0.1, 100.0];

number_range!(
    /// Radius of a roller's end over its distance from the apex.
    EndRadiusRatio: End::Beyond(0.2), End::Beyond(1.0), "at 1 the end fits the rib all over"
);

/// Keys of all roller bearings.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct RollerKeys {
    /// Number of rollers in a row.
    rollers: usize,
    /// Diameter of the rollers, in their middle.
    roller_diameter_mm: Bounded<Positive>,
    /// Length of the rollers that carries.
    roller_length_mm: Bounded<Positive>,
    /// Diameter of the circle of the rollers' middles.
    pitch_diameter_mm: Bounded<Positive>,
    /// Laminae of a roller; 40 where not given.
    laminae: Option<Count<2, 1000>>,
}

/// Keys of cylindrical roller bearings.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct CylindricalRollerKeys {
    /// Play across the axis from one side to the other; negative: interference, as fits leave it; 0 where not given.
    radial_clearance_um: Option<f64>,
    /// End profile; logarithmic by ISO/TS 16281 where not given.
    profile: Option<ProfileTable>,
}

/// Keys of tapered roller bearings.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct TaperedRollerKeys {
    /// Angle of the outer race against the axis.
    contact_angle_deg: Bounded<Within<5, 45>>,
    /// End profile; logarithmic by ISO/TS 16281 where not given.
    profile: Option<ProfileTable>,
    /// Radius of the roller's spherical end over the distance of that end from the apex; 0.95 where not given.
    end_radius_ratio: Option<Bounded<EndRadiusRatio>>,
    /// Height of the contact with the rib above the inner race's edge; a fifth of the roller's large radius where not
    /// given.
    rib_height_mm: Option<f64>,
}

/// `[profile]`: material taken off a roller towards its ends.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(remote = "Self", rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(tag = "kind", rename = "ProfileTable")]
enum ProfileTable {
    /// Nothing is taken off.
    Straight {},
    /// At x from the middle of the length L: s ln(1/(1 − (2x/L)²)).
    Logarithmic {
        /// s; 0.35 ‰ (tapered: 0.45 ‰) of the diameter where not given.
        scale_um: Option<Bounded<Within<0, 1000>>>,
    },
    /// A circle.
    Crowned {
        /// Radius of the crown.
        radius_mm: Bounded<Positive>,
    },
}

kinds!(ProfileTable, "kind");

/// Rollers on their circle, checked.
pub(super) struct Rollers {
    pub row: Elements,
    pub length_mm: f64,
    pub laminae: usize,
}

impl RollerKeys {
    /// Checks what all roller bearings have.
    pub fn checked(&self, keys: &TableKeys<'_>) -> Result<Rollers, InputError> {
        let diameter = *self.roller_diameter_mm;
        let row = Elements::rollers((self.rollers, diameter, *self.pitch_diameter_mm), keys)?;
        let length_mm = *self.roller_length_mm;
        let [least, most] = SLENDERNESS.map(|share| share * diameter);
        keys.require(
            "roller_length_mm",
            length_mm,
            (least..=most).contains(&length_mm),
            &format!("{least:.4} to {most:.4}, a tenth to a hundred times the rollers' diameter"),
        )?;
        Ok(Rollers {
            row,
            length_mm,
            laminae: self.laminae.map_or(LAMINAE, Count::get),
        })
    }
}

impl Rollers {
    /// Rollers and races.
    pub fn geometry(
        self,
        clearance_m: f64,
        taper: Option<Taper>,
        profile: RollerProfile,
    ) -> RollerGeometry {
        RollerGeometry {
            rollers: self.row.number,
            diameter_m: MM * self.row.diameter_mm,
            length_m: MM * self.length_mm,
            pitch_diameter_m: MM * self.row.pitch_mm,
            radial_clearance_m: clearance_m,
            taper,
            barrel: None,
            profile,
            laminae: self.laminae,
        }
    }
}

/// A cylindrical roller bearing.
pub(super) fn cylindrical(
    rollers: &RollerKeys,
    own: &CylindricalRollerKeys,
    keys: &TableKeys<'_>,
) -> Result<RollerGeometry, InputError> {
    let rollers = rollers.checked(keys)?;
    let diameter_m = MM * rollers.row.diameter_mm;
    let range = Clearances::of_rollers(diameter_m);
    let clearance_m = range.stated_m(own.radial_clearance_um, keys)?;
    let profile = profile(own.profile.as_ref(), 0.35e-3 * diameter_m);
    Ok(rollers.geometry(clearance_m, None, profile))
}

/// A tapered roller bearing.
pub(super) fn tapered(
    rollers: &RollerKeys,
    own: &TaperedRollerKeys,
    keys: &TableKeys<'_>,
) -> Result<RollerGeometry, InputError> {
    let rollers = rollers.checked(keys)?;
    let taper = taper(&rollers, own, keys)?;
    let profile = profile(own.profile.as_ref(), 0.45e-3 * MM * rollers.row.diameter_mm);
    Ok(rollers.geometry(0.0, Some(taper), profile))
}

/// Where the file names none: a choice, docs/theory/rolling_bearings.md says what it decides.
const END_RADIUS_RATIO: f64 = 0.95;

/// Length of a tapered roller over its diameter: shorter ones tip over between the races and the rib.
const LEAST_LENGTH: f64 = 0.25;

/// Share of the large end's radius at which the rib touches, where the file names none.
const RIB_SHARE: f64 = 0.2;

/// Taper and rib of a roller of this diameter, length and pitch diameter, as they are where nothing else is stated.
pub(super) fn usual_taper(
    contact_angle_rad: f64,
    (diameter_m, length_m, pitch_m): (f64, f64, f64),
) -> Taper {
    let half_taper = half_taper_of(diameter_m / pitch_m, contact_angle_rad);
    let large_m = 0.5 * diameter_m + 0.5 * length_m * half_taper.tan();
    Taper {
        contact_angle_rad,
        end_radius_ratio: END_RADIUS_RATIO,
        rib_height_m: RIB_SHARE * large_m,
    }
}

fn taper(
    rollers: &Rollers,
    own: &TaperedRollerKeys,
    keys: &TableKeys<'_>,
) -> Result<Taper, InputError> {
    let (diameter, pitch) = (rollers.row.diameter_mm, rollers.row.pitch_mm);
    let length = rollers.length_mm;
    let angle = own.contact_angle_deg.to_radians();
    let ratio = diameter / pitch;
    let half_taper = half_taper_of(ratio, angle);
    let apex = 0.5 * pitch / (angle - half_taper).sin();
    let least = LEAST_LENGTH * diameter;
    keys.require(
        "roller_length_mm",
        length,
        length >= least && length < apex,
        &format!(
            "{least:.3}, a quarter of the rollers' diameter, with less they tip over, to less than {apex:.3}, the distance of their middle from their apex"
        ),
    )?;
    let large = 0.5 * diameter + 0.5 * length * half_taper.tan();
    let height = own.rib_height_mm.unwrap_or(RIB_SHARE * large);
    keys.require(
        "rib_height_mm",
        height,
        height > 0.0 && height < large,
        &format!("more than 0 and less than {large:.3}, the radius of the roller's large end"),
    )?;
    Ok(Taper {
        contact_angle_rad: angle,
        end_radius_ratio: own.end_radius_ratio.map_or(END_RADIUS_RATIO, f64::from),
        rib_height_m: MM * height,
    })
}

/// The profile; where nothing is stated the logarithmic one of this scale.
fn profile(table: Option<&ProfileTable>, usual_m: f64) -> RollerProfile {
    match table {
        Some(ProfileTable::Straight {}) => RollerProfile::Straight,
        Some(ProfileTable::Crowned { radius_mm }) => RollerProfile::Crowned {
            radius_m: MM * *radius_mm,
        },
        Some(ProfileTable::Logarithmic {
            scale_um: Some(scale),
        }) => RollerProfile::Logarithmic {
            scale_m: UM * *scale,
        },
        None | Some(ProfileTable::Logarithmic { scale_um: None }) => {
            RollerProfile::Logarithmic { scale_m: usual_m }
        }
    }
}
