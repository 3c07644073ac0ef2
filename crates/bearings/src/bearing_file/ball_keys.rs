//! Keys of ball bearings.

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::TableKeys;

use super::{BearingFile, Kind, MM, UM};
use crate::definition::{BallBearingKind, BallGeometry};

/// Balls and grooves; what cannot be assembled is refused with the numbers.
pub(super) fn geometry(
    file: &BearingFile,
    keys: &TableKeys<'_>,
    notes: &mut Vec<String>,
) -> Result<BallGeometry, InputError> {
    let needed_by = format!("kind = \"{}\"", file.kind.word());
    let needed = |key: &str, value: Option<f64>| keys.needed(key, value, &needed_by);
    let balls = keys.needed("balls", file.balls, &needed_by)?;
    let ball = needed("ball_diameter_mm", file.ball_diameter_mm)?;
    let pitch = needed("pitch_diameter_mm", file.pitch_diameter_mm)?;
    keys.require("ball_diameter_mm", ball, ball > 0.0, "more than 0")?;
    keys.require(
        "pitch_diameter_mm",
        pitch,
        pitch > ball,
        &format!("more than the ball's diameter, {ball}"),
    )?;
    let conformity = |key: &str, value: Option<f64>| {
        let value = needed(key, value)?;
        keys.require(
            key,
            value,
            value > 0.5 && value <= 1.0,
            "more than 0.5, the ball's own radius, and at most 1",
        )?;
        Ok::<_, InputError>(value)
    };
    let inner = conformity("inner_conformity", file.inner_conformity)?;
    let outer = conformity("outer_conformity", file.outer_conformity)?;
    // Neighbours must not touch.
    let room = (std::f64::consts::PI / (ball / pitch).asin()).floor();
    keys.require(
        "balls",
        balls as f64,
        balls >= 3 && (balls as f64) <= room,
        &format!("3 to {room}, as many balls of {ball} mm as go round on {pitch} mm"),
    )?;
    if matches!(file.kind, Kind::FourPoint | Kind::ThrustBall) && file.arrangement.is_some() {
        let problem = format!(
            "is not used by kind = \"{}\", which has one row; remove it",
            file.kind.word()
        );
        return Err(keys.error("arrangement", problem));
    }
    let (kind, (free_angle_rad, interference_mm)) = match file.kind {
        Kind::FourPoint => four_point_angle(file, keys, (inner + outer - 1.0) * ball, ball)?,
        Kind::ThrustBall => (BallBearingKind::Thrust, (std::f64::consts::FRAC_PI_2, 0.0)),
        kind => (
            if kind == Kind::DeepGroove {
                BallBearingKind::DeepGroove
            } else {
                BallBearingKind::AngularContact
            },
            free_angle(file, keys, (ball, pitch), (inner, outer))?,
        ),
    };
    let geometry = BallGeometry {
        kind,
        balls,
        ball_diameter_m: MM * ball,
        pitch_diameter_m: MM * pitch,
        inner_conformity: inner,
        outer_conformity: outer,
        free_angle_rad,
        interference_m: MM * interference_mm,
        stated_shoulder_heights_m: shoulder_heights_m(file, keys, ball)?,
    };
    if file.raceway_diameters_mm.is_some() {
        notes.push(format!(
            "the raceways leave a radial clearance of {:.1} um: contact angle {:.3} deg without load",
            geometry.radial_clearance_m() / UM,
            free_angle_rad.to_degrees()
        ));
    }
    Ok(geometry)
}

/// `shoulder_heights_mm`, for balls of a diameter \[mm\].
pub(super) fn shoulder_heights_m(
    file: &BearingFile,
    keys: &TableKeys<'_>,
    ball: f64,
) -> Result<Option<[f64; 2]>, InputError> {
    let Some(heights) = file.shoulder_heights_mm else {
        return Ok(None);
    };
    for height in heights {
        keys.require(
            "shoulder_heights_mm",
            height,
            height > 0.0 && height <= 0.5 * ball,
            &format!(
                "more than 0 and at most {}, half of the ball's diameter",
                0.5 * ball
            ),
        )?;
    }
    Ok(Some(heights.map(|height| MM * height)))
}

/// Contact angle of the four arcs, and play.
fn four_point_angle(
    file: &BearingFile,
    keys: &TableKeys<'_>,
    distance_mm: f64,
    ball_mm: f64,
) -> Result<(BallBearingKind, (f64, f64)), InputError> {
    let degrees = keys.needed(
        "contact_angle_deg",
        file.contact_angle_deg,
        "kind = \"four-point\"",
    )?;
    keys.require(
        "contact_angle_deg",
        degrees,
        degrees > 0.0 && degrees <= 60.0,
        "more than 0 and at most 60",
    )?;
    let angle = degrees.to_radians();
    let clearance_um = file.radial_clearance_um.unwrap_or(0.0);
    let kind = four_point_kind(keys, clearance_um, (MM * ball_mm, MM * distance_mm), angle)?;
    Ok((kind, (angle, 0.0)))
}

/// Play up to that at which balls touch two arcs only under thrust, or interference up to a hundredth of the ball's diameter.
pub(super) fn four_point_kind(
    keys: &TableKeys<'_>,
    clearance_um: f64,
    (ball_m, distance_m): (f64, f64),
    angle_rad: f64,
) -> Result<BallBearingKind, InputError> {
    let least_um = -MOST_INTERFERENCE * ball_m / UM;
    let most_um = 2.0 * distance_m * angle_rad.cos() / UM;
    keys.require(
        "radial_clearance_um",
        clearance_um,
        (least_um..most_um).contains(&clearance_um),
        &format!(
            "{least_um:.1} (interference of a hundredth of the ball's diameter) up to, not including, {most_um:.1}: with more no ball touches both rings"
        ),
    )?;
    Ok(BallBearingKind::FourPoint {
        clearance_m: UM * clearance_um,
    })
}

/// Balls and rollers may be too large for their rings by this share of their diameter: for balls of 8 mm 80 um, several times what tight fits take
/// away.
pub(super) const MOST_INTERFERENCE: f64 = 0.01;

/// Share of a limit of the clearance within which a number counts as the limit: 0.52 + 0.53 − 1 is not 0.05 to the last digit.
pub(super) const ROUNDING: f64 = 1e-12;

/// α₀ from the contact angle, the clearance or the raceways' diameters: cos α₀ = 1 − P_d/(2A); and how far P_d lies below zero \[mm\].
fn free_angle(
    file: &BearingFile,
    keys: &TableKeys<'_>,
    (ball, pitch): (f64, f64),
    (inner, outer): (f64, f64),
) -> Result<(f64, f64), InputError> {
    let distance_mm = (inner + outer - 1.0) * ball;
    // cos α = 1 − P_d/(2A) as sin²(α/2) = P_d/(4A), which keeps the digits of small clearances.
    let angle = |clearance_mm: f64| {
        let half_sine = (0.25 * clearance_mm.max(0.0) / distance_mm).sqrt();
        (2.0 * half_sine.asin(), (-clearance_mm).max(0.0))
    };
    let deep_groove = file.kind == Kind::DeepGroove;
    let least_mm = if deep_groove {
        -MOST_INTERFERENCE * ball
    } else {
        0.0
    };
    if let Some([bottom_inner, bottom_outer]) = file.raceway_diameters_mm {
        for (key, given) in [
            ("contact_angle_deg", file.contact_angle_deg.is_some()),
            ("radial_clearance_um", file.radial_clearance_um.is_some()),
        ] {
            if given {
                return Err(keys.error(
                    key,
                    "is given together with raceway_diameters_mm, from which it follows; remove one of the two",
                ));
            }
        }
        let clearance = bottom_outer - bottom_inner - 2.0 * ball;
        let most = 2.0 * distance_mm;
        let pair = format!("found {bottom_inner} and {bottom_outer}");
        if clearance < least_mm {
            return Err(keys.error(
                "raceway_diameters_mm",
                format!(
                    "{pair}; {bottom_outer} - {bottom_inner} - 2 x {ball} = {clearance:.4} mm: the balls do not go in between"
                ),
            ));
        }
        if clearance >= most * (1.0 - ROUNDING) {
            return Err(keys.error(
                "raceway_diameters_mm",
                format!(
                    "{pair}; {bottom_outer} - {bottom_inner} - 2 x {ball} = {clearance:.4} mm of play, but grooves of {inner} and {outer} ball diameters \
                     hold a ball with less than {most:.4} mm only: no ball touches both. Check the diameters (they are those of the grooves' \
                     bottoms), or state the {} instead",
                    if deep_groove { "radial_clearance_um" } else { "contact_angle_deg" }
                ),
            ));
        }
        let (free, interference) = angle(clearance);
        // Ball centres that just touch both grooves lie on a circle of their own.
        let cosine = free.cos() + 0.5 * interference / distance_mm;
        let at = |f: f64| 2.0 * f * ball - (2.0 * f - 1.0) * ball * cosine;
        let middle = 0.5 * (bottom_inner + at(inner) + bottom_outer - at(outer));
        if (middle - pitch).abs() > 1e-3 * pitch {
            return Err(keys.error(
                "pitch_diameter_mm",
                format!("found {pitch}; raceways of {bottom_inner} and {bottom_outer} mm put the balls on {middle:.4} mm"),
            ));
        }
        return Ok((free, interference));
    }
    if file.kind == Kind::AngularContact {
        let degrees = keys.needed(
            "contact_angle_deg",
            file.contact_angle_deg,
            "an angular-contact bearing without raceway_diameters_mm",
        )?;
        keys.require(
            "contact_angle_deg",
            degrees,
            degrees > 0.0 && degrees <= 60.0,
            "more than 0 and at most 60",
        )?;
        return Ok((degrees.to_radians(), 0.0));
    }
    let clearance_um = file.radial_clearance_um.unwrap_or(0.0);
    let most_um = 2e3 * distance_mm;
    keys.require(
        "radial_clearance_um",
        clearance_um,
        clearance_um >= 1e3 * least_mm && clearance_um < most_um * (1.0 - ROUNDING),
        &format!(
            "{:.1} (interference of a hundredth of the ball's diameter) up to, not including, {most_um:.1}: with more no ball touches both grooves",
            1e3 * least_mm
        ),
    )?;
    Ok(angle(1e-3 * clearance_um))
}
