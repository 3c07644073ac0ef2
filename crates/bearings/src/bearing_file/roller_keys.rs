//! Keys of roller bearings.

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::TableKeys;

use super::element_keys::{Clearances, Elements, contact_angle_rad, laminae, roller_length_mm};
use super::{BearingFile, Kind, MM, ProfileTable, UM};
use crate::build_rows::half_taper_of;
use crate::definition::{RollerGeometry, RollerProfile, Taper};

/// Rollers and races.
pub(super) fn geometry(
    file: &BearingFile,
    keys: &TableKeys<'_>,
) -> Result<RollerGeometry, InputError> {
    let rollers = Elements::rollers(file, keys)?;
    let (diameter, pitch) = (rollers.diameter_mm, rollers.pitch_mm);
    let length = roller_length_mm(file, keys, diameter)?;
    let taper = (file.kind == Kind::TaperedRoller)
        .then(|| taper(file, keys, (diameter, length, pitch)))
        .transpose()?;
    Ok(RollerGeometry {
        rollers: rollers.number,
        diameter_m: MM * diameter,
        length_m: MM * length,
        pitch_diameter_m: MM * pitch,
        radial_clearance_m: Clearances::of_rollers(MM * diameter).stated_m(file, keys)?,
        taper,
        barrel: None,
        profile: profile(file, diameter),
        laminae: laminae(file),
    })
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
    file: &BearingFile,
    keys: &TableKeys<'_>,
    (diameter, length, pitch): (f64, f64, f64),
) -> Result<Taper, InputError> {
    let angle = contact_angle_rad(file, keys, [5.0, 45.0])?;
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
    let height = file.rib_height_mm.unwrap_or(RIB_SHARE * large);
    keys.require(
        "rib_height_mm",
        height,
        height > 0.0 && height < large,
        &format!("more than 0 and less than {large:.3}, the radius of the roller's large end"),
    )?;
    Ok(Taper {
        contact_angle_rad: angle,
        end_radius_ratio: file.end_radius_ratio.map_or(END_RADIUS_RATIO, f64::from),
        rib_height_m: MM * height,
    })
}

fn profile(file: &BearingFile, diameter_mm: f64) -> RollerProfile {
    let share = if file.kind == Kind::TaperedRoller {
        0.45e-3
    } else {
        0.35e-3
    };
    match file.profile {
        Some(ProfileTable::Straight {}) => RollerProfile::Straight,
        Some(ProfileTable::Crowned { radius_mm }) => RollerProfile::Crowned {
            radius_m: MM * radius_mm,
        },
        Some(ProfileTable::Logarithmic {
            scale_um: Some(scale),
        }) => RollerProfile::Logarithmic {
            scale_m: UM * scale,
        },
        None | Some(ProfileTable::Logarithmic { scale_um: None }) => RollerProfile::Logarithmic {
            scale_m: share * MM * diameter_mm,
        },
    }
}
