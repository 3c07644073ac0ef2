//! Keys of spherical roller bearings.

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::TableKeys;

use super::element_keys::{Clearances, Elements, contact_angle_rad, laminae, roller_length_mm};
use super::{BearingFile, MM};
use crate::definition::{Arrangement, BarrelShape, RollerGeometry, RollerProfile};

/// Radius of the rollers' profile over that of the sphere, and of the sphere over the inner groove's, where the file
/// names none.
const PROFILE_OVER_SPHERE: f64 = 0.97;

/// Barrels and races, and the two rows.
pub(super) fn geometry(
    file: &BearingFile,
    keys: &TableKeys<'_>,
) -> Result<(RollerGeometry, Arrangement), InputError> {
    let rollers = Elements::rollers(file, keys)?;
    let (diameter, pitch) = (rollers.diameter_mm, rollers.pitch_mm);
    let length = roller_length_mm(file, keys, diameter)?;
    let angle = contact_angle_rad(file, keys, [3.0, 45.0])?;
    // Rows must not meet in the middle plane.
    let most_length = (pitch - diameter * angle.cos()) * angle.tan() / angle.cos();
    keys.require(
        "roller_length_mm",
        length,
        length < most_length,
        &format!("less than {most_length:.3}, with which the rollers of both rows meet in the middle plane"),
    )?;
    let clearance_m = Clearances::of_rollers(MM * diameter).stated_m(file, keys)?;
    let shape = shape(file, keys, angle, (diameter, length, pitch))?;
    Ok(barrels(
        (rollers.number, laminae(file)),
        (MM * diameter, MM * length, MM * pitch),
        shape,
        clearance_m,
    ))
}

fn shape(
    file: &BearingFile,
    keys: &TableKeys<'_>,
    angle: f64,
    (diameter, length, pitch): (f64, f64, f64),
) -> Result<BarrelShape, InputError> {
    let usual = usual_shape(angle, MM * pitch, MM * diameter);
    let sphere = BarrelShape::sphere_radius_m(angle, pitch, diameter);
    let profile = file
        .roller_profile_radius_mm
        .unwrap_or(usual.profile_radius_m / MM);
    let least = 0.5 * length.max(diameter);
    keys.require(
        "roller_profile_radius_mm",
        profile,
        profile > least && profile < sphere,
        &format!("more than {least:.3} and less than {sphere:.3}, the radius of the sphere inside the outer ring"),
    )?;
    let groove = file
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

/// Two rows that face one sphere.
pub(super) fn barrels(
    (rollers, laminae): (usize, usize),
    (diameter_m, length_m, pitch_m): (f64, f64, f64),
    shape: BarrelShape,
    clearance_m: f64,
) -> (RollerGeometry, Arrangement) {
    let rows = Arrangement::X {
        distance_m: pitch_m * shape.contact_angle_rad.tan(),
    };
    let geometry = RollerGeometry {
        rollers,
        diameter_m,
        length_m,
        pitch_diameter_m: pitch_m,
        radial_clearance_m: clearance_m,
        taper: None,
        barrel: Some(shape),
        profile: RollerProfile::Straight,
        laminae,
    };
    (geometry, rows)
}
