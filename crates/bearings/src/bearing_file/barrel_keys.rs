//! Keys of spherical roller bearings.

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{Bounded, TableKeys, Within};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::MM;
use super::element_keys::Clearances;
use super::roller_keys::{RollerKeys, Rollers};
use crate::definition::{Arrangement, BarrelShape, RollerGeometry, RollerProfile};

/// Keys of spherical roller bearings.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct SphericalRollerKeys {
    /// Angle of the load lines.
    contact_angle_deg: Bounded<Within<3, 45>>,
    /// Play across the axis from one side to the other; negative: interference, as fits leave it; 0 where not given.
    radial_clearance_um: Option<f64>,
    /// Radius of the rollers' profile; 0.97 of the radius of the sphere inside the outer ring where not given.
    roller_profile_radius_mm: Option<f64>,
    /// Radius of the profile of the inner ring's groove; that of the sphere inside the outer ring where not given.
    inner_groove_radius_mm: Option<f64>,
}

/// Radius of the rollers' profile over that of the sphere, and of the sphere over the inner groove's, where the file
/// names none.
const PROFILE_OVER_SPHERE: f64 = 0.97;

/// Barrels and races, and the two rows.
pub(super) fn geometry(
    rollers: &RollerKeys,
    own: &SphericalRollerKeys,
    keys: &TableKeys<'_>,
) -> Result<(RollerGeometry, Arrangement), InputError> {
    let rollers = rollers.checked(keys)?;
    let (diameter, pitch) = (rollers.row.diameter_mm, rollers.row.pitch_mm);
    let length = rollers.length_mm;
    let angle = own.contact_angle_deg.to_radians();
    // Rows must not meet in the middle plane.
    let most_length = (pitch - diameter * angle.cos()) * angle.tan() / angle.cos();
    keys.require(
        "roller_length_mm",
        length,
        length < most_length,
        &format!("less than {most_length:.3}, with which the rollers of both rows meet in the middle plane"),
    )?;
    let range = Clearances::of_rollers(MM * diameter);
    let clearance_m = range.stated_m(own.radial_clearance_um, keys)?;
    let shape = shape(&rollers, own, keys)?;
    let geometry = RollerGeometry {
        barrel: Some(shape),
        ..rollers.geometry(clearance_m, None, RollerProfile::Straight)
    };
    // Two rows that face one sphere.
    let distance_m = MM * pitch * angle.tan();
    Ok((geometry, Arrangement::X { distance_m }))
}

fn shape(
    rollers: &Rollers,
    own: &SphericalRollerKeys,
    keys: &TableKeys<'_>,
) -> Result<BarrelShape, InputError> {
    let (diameter, pitch) = (rollers.row.diameter_mm, rollers.row.pitch_mm);
    let length = rollers.length_mm;
    let angle = own.contact_angle_deg.to_radians();
    let usual = usual_shape(angle, MM * pitch, MM * diameter);
    let sphere = BarrelShape::sphere_radius_m(angle, pitch, diameter);
    let profile = own
        .roller_profile_radius_mm
        .unwrap_or(usual.profile_radius_m / MM);
    let least = 0.5 * length.max(diameter);
    keys.require(
        "roller_profile_radius_mm",
        profile,
        profile > least && profile < sphere,
        &format!("more than {least:.3} and less than {sphere:.3}, the radius of the sphere inside the outer ring"),
    )?;
    let groove = own
        .inner_groove_radius_mm
        .unwrap_or(usual.groove_radius_m / MM);
    keys.require(
        "inner_groove_radius_mm",
        groove,
        groove > profile && groove < 2.0 * sphere,
        &format!(
            "more than {profile:.3}, the radius of the rollers' profile, and less than {:.3}",
            2.0 * sphere
        ),
    )?;
    Ok(BarrelShape {
        contact_angle_rad: angle,
        profile_radius_m: MM * profile,
        groove_radius_m: MM * groove,
    })
}

/// Profiles where nothing is stated.
pub(super) fn usual_shape(angle_rad: f64, pitch_m: f64, diameter_m: f64) -> BarrelShape {
    let sphere_m = BarrelShape::sphere_radius_m(angle_rad, pitch_m, diameter_m);
    BarrelShape {
        contact_angle_rad: angle_rad,
        profile_radius_m: PROFILE_OVER_SPHERE * sphere_m,
        groove_radius_m: sphere_m,
    }
}
