//! Keys of spherical roller bearings.

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::TableKeys;

use super::roller_keys::{LAMINAE, require_clearance};
use super::{BearingFile, MM, UM};
use crate::definition::{Arrangement, BarrelShape, RollerGeometry, RollerProfile};

/// Radius of the rollers' profile over that of the sphere, and of the sphere over the inner groove's, where the file names none.
const PROFILE_OVER_SPHERE: f64 = 0.97;

/// Barrels and races, and the two rows.
pub(super) fn geometry(
    file: &BearingFile,
    keys: &TableKeys<'_>,
) -> Result<(RollerGeometry, Arrangement), InputError> {
    let needed_by = "kind = \"spherical-roller\"";
    let needed = |key: &str, value: Option<f64>| {
        let value = keys.needed(key, value, needed_by)?;
        keys.require(key, value, value > 0.0, "more than 0")?;
        Ok::<_, InputError>(value)
    };
    for (key, given) in [
        ("arrangement", file.arrangement.is_some()),
        ("row_distance_mm", file.row_distance_mm.is_some()),
    ] {
        if given {
            let problem = "is not used by kind = \"spherical-roller\", whose two rows face one sphere at the contact angle; remove it";
            return Err(keys.error(key, problem));
        }
    }
    let rollers = keys.needed("rollers", file.rollers, needed_by)?;
    let diameter = needed("roller_diameter_mm", file.roller_diameter_mm)?;
    let length = needed("roller_length_mm", file.roller_length_mm)?;
    let pitch = needed("pitch_diameter_mm", file.pitch_diameter_mm)?;
    let degrees = needed("contact_angle_deg", file.contact_angle_deg)?;
    keys.require(
        "pitch_diameter_mm",
        pitch,
        pitch > diameter,
        &format!("more than the roller's diameter, {diameter}"),
    )?;
    let room = (std::f64::consts::PI / (diameter / pitch).asin()).floor();
    keys.require(
        "rollers",
        rollers as f64,
        rollers >= 3 && (rollers as f64) <= room,
        &format!("3 to {room}, as many rollers of {diameter} mm as go round on {pitch} mm"),
    )?;
    keys.require(
        "contact_angle_deg",
        degrees,
        (3.0..=45.0).contains(&degrees),
        "3 to 45",
    )?;
    let angle = degrees.to_radians();
    // Rows must not meet in the middle plane.
    let most_length = (pitch - diameter * angle.cos()) * angle.tan() / angle.cos();
    keys.require(
        "roller_length_mm",
        length,
        length < most_length,
        &format!("less than {most_length:.3}, with which the rollers of both rows meet in the middle plane"),
    )?;
    let laminae = file.laminae.unwrap_or(LAMINAE);
    keys.require(
        "laminae",
        laminae as f64,
        (2..=1000).contains(&laminae),
        "2 to 1000; ISO/TS 16281 asks for 30 at least",
    )?;
    let clearance_um = file.radial_clearance_um.unwrap_or(0.0);
    require_clearance(keys, clearance_um, 1e3 * diameter)?;
    let shape = shape(file, keys, angle, (diameter, length, pitch))?;
    Ok(barrels(
        (rollers, laminae),
        (MM * diameter, MM * length, MM * pitch),
        shape,
        UM * clearance_um,
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
