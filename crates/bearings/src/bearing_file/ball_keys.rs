//! Keys of ball bearings.

use gearmesh_geometry::InputError;
use gearmesh_geometry::given;
use gearmesh_geometry::input::TableKeys;

use super::element_keys::{Clearances, Elements, contact_angle_rad};
use super::{BearingFile, Kind, MM, UM};
use crate::definition::{BallBearingKind, BallGeometry};

/// Balls and grooves; what cannot be assembled is refused with the numbers.
pub(super) fn geometry(
    file: &BearingFile,
    keys: &TableKeys<'_>,
    notes: &mut Vec<String>,
) -> Result<BallGeometry, InputError> {
    let needed_by = format!("kind = \"{}\"", file.kind.word());
    let balls = Elements::balls(file, keys)?;
    let (ball, pitch) = (balls.diameter_mm, balls.pitch_mm);
    let inner = *keys.needed("inner_conformity", file.inner_conformity, &needed_by)?;
    let outer = *keys.needed("outer_conformity", file.outer_conformity, &needed_by)?;
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
        balls: balls.number,
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
    let angle = contact_angle_rad(file, keys, [0.0, 60.0])?;
    let kind = four_point_kind(file, keys, (MM * ball_mm, MM * distance_mm), angle)?;
    Ok((kind, (angle, 0.0)))
}

/// Play up to that at which balls touch two arcs only under thrust.
pub(super) fn four_point_kind(
    file: &BearingFile,
    keys: &TableKeys<'_>,
    (ball_m, distance_m): (f64, f64),
    angle_rad: f64,
) -> Result<BallBearingKind, InputError> {
    let range = Clearances::of_balls(ball_m, 2.0 * distance_m * angle_rad.cos());
    let clearance_m = range.stated_m(file, keys)?;
    Ok(BallBearingKind::FourPoint { clearance_m })
}

/// α₀ and the interference of deep-groove bearings from the clearance and the distance of the grooves' centres: cos α
/// = 1 − P_d/(2A) as sin²(α/2) = P_d/(4A), which keeps the digits of small clearances.
pub(super) fn angle_of_clearance(clearance: f64, distance: f64) -> (f64, f64) {
    let half_sine = (0.25 * clearance.max(0.0) / distance).sqrt();
    (2.0 * half_sine.asin(), (-clearance).max(0.0))
}

/// α₀ from the contact angle, the clearance or the raceways' diameters: cos α₀ = 1 − P_d/(2A); and how far P_d lies
/// below zero \[mm\].
fn free_angle(
    file: &BearingFile,
    keys: &TableKeys<'_>,
    (ball, pitch): (f64, f64),
    (inner, outer): (f64, f64),
) -> Result<(f64, f64), InputError> {
    let distance_mm = (inner + outer - 1.0) * ball;
    let deep_groove = file.kind == Kind::DeepGroove;
    let range = Clearances::of_balls(MM * ball, 2.0 * MM * distance_mm);
    if let Some([bottom_inner, bottom_outer]) = file.raceway_diameters_mm {
        keys.refuse(
            &given!(file; contact_angle_deg, radial_clearance_um),
            "is given together with raceway_diameters_mm, from which it follows; remove one of the two",
        )?;
        let clearance = bottom_outer - bottom_inner - 2.0 * ball;
        let pair = format!("found {bottom_inner} and {bottom_outer}");
        let goes_in = clearance >= 0.0 || deep_groove;
        if !(goes_in && range.holds_elements(MM * clearance)) {
            return Err(keys.error(
                "raceway_diameters_mm",
                format!(
                    "{pair}; {bottom_outer} - {bottom_inner} - 2 x {ball} = {clearance:.4} mm: the balls do not go in between"
                ),
            ));
        }
        if !range.touches(MM * clearance) {
            return Err(keys.error(
                "raceway_diameters_mm",
                format!(
                    "{pair}; {bottom_outer} - {bottom_inner} - 2 x {ball} = {clearance:.4} mm of play, but grooves of {inner} and {outer} ball diameters \
                     hold a ball with less than {:.4} mm only: no ball touches both. Check the diameters (they are those of the grooves' \
                     bottoms), or state the {} instead",
                    2.0 * distance_mm,
                    if deep_groove { "radial_clearance_um" } else { "contact_angle_deg" }
                ),
            ));
        }
        let (free, interference) = angle_of_clearance(clearance, distance_mm);
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
        return Ok((contact_angle_rad(file, keys, [0.0, 60.0])?, 0.0));
    }
    let clearance_mm = range.stated_m(file, keys)? / MM;
    Ok(angle_of_clearance(clearance_mm, distance_mm))
}
