//! Keys of ball bearings.

use gearmesh_geometry::input::{Bounded, End, Positive, TableKeys};
use gearmesh_geometry::{InputError, given, number_range};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::element_keys::{Clearances, Elements};
use super::{MM, UM};
use crate::definition::{BallBearingKind, BallGeometry};

number_range!(
    /// Radius of a groove over the ball's diameter.
    pub(super) Conformity: End::Beyond(0.5), End::At(1.0), "0.5 is the ball's own radius"
);

number_range!(
    /// Contact angles of grooves \[deg\].
    GrooveAngle: End::Beyond(0.0), End::At(60.0)
);

/// Keys of all ball bearings.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct BallKeys {
    /// Number of balls in a row.
    balls: usize,
    /// Diameter of the balls.
    ball_diameter_mm: Bounded<Positive>,
    /// Diameter of the circle of the balls' middles.
    pitch_diameter_mm: Bounded<Positive>,
    /// Radius of the inner groove over the ball's diameter; of a thrust bearing that of the washer on the shaft.
    inner_conformity: Bounded<Conformity>,
    /// Radius of the outer groove over the ball's diameter; of a thrust bearing that of the washer in the housing.
    outer_conformity: Bounded<Conformity>,
}

/// Keys of deep-groove ball bearings.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct DeepGrooveKeys {
    /// Play across the axis from one side to the other; negative: interference, as fits leave it; 0 where not given.
    radial_clearance_um: Option<f64>,
    /// Diameters of the grooves' bottoms, inner and outer, instead of the clearance.
    raceway_diameters_mm: Option<[f64; 2]>,
    /// Heights of the shoulders above the bottoms of the inner and outer groove, of the higher one where they differ;
    /// estimated where not given (0.2 of the ball's diameter or 30° beyond the contact angle). Contact ellipses that
    /// reach beyond are warned of.
    shoulder_heights_mm: Option<[f64; 2]>,
}

/// Keys of angular-contact ball bearings.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct AngularContactKeys {
    /// Contact angle without load; needed without `raceway_diameters_mm`.
    contact_angle_deg: Option<Bounded<GrooveAngle>>,
    /// Diameters of the grooves' bottoms, inner and outer, instead of the contact angle.
    raceway_diameters_mm: Option<[f64; 2]>,
    /// Heights of the shoulders, as of deep-groove bearings.
    shoulder_heights_mm: Option<[f64; 2]>,
}

/// Keys of four-point bearings.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct FourPointKeys {
    /// Contact angle of a ball that touches at all four points.
    contact_angle_deg: Bounded<GrooveAngle>,
    /// Play across the axis from one side to the other; negative: interference, as fits leave it; 0 where not given.
    radial_clearance_um: Option<f64>,
    /// Heights of the shoulders, as of deep-groove bearings.
    shoulder_heights_mm: Option<[f64; 2]>,
}

/// Balls between two grooves, checked.
struct Balls {
    row: Elements,
    /// f_i and f_o.
    conformities: [f64; 2],
}

impl BallKeys {
    fn checked(&self, keys: &TableKeys<'_>) -> Result<Balls, InputError> {
        let stated = (self.balls, *self.ball_diameter_mm, *self.pitch_diameter_mm);
        Ok(Balls {
            row: Elements::balls(stated, keys)?,
            conformities: [*self.inner_conformity, *self.outer_conformity],
        })
    }
}

impl Balls {
    /// A = (f_i + f_o − 1) D \[mm\].
    fn groove_distance_mm(&self) -> f64 {
        let [inner, outer] = self.conformities;
        (inner + outer - 1.0) * self.row.diameter_mm
    }

    /// Balls and grooves with α₀ and the interference \[mm\].
    fn geometry(
        &self,
        kind: BallBearingKind,
        (free_angle_rad, interference_mm): (f64, f64),
        stated_shoulder_heights_m: Option<[f64; 2]>,
    ) -> BallGeometry {
        BallGeometry {
            kind,
            balls: self.row.number,
            ball_diameter_m: MM * self.row.diameter_mm,
            pitch_diameter_m: MM * self.row.pitch_mm,
            inner_conformity: self.conformities[0],
            outer_conformity: self.conformities[1],
            free_angle_rad,
            interference_m: MM * interference_mm,
            stated_shoulder_heights_m,
        }
    }

    /// α₀ and the interference \[mm\] of grooves whose bottoms have these diameters: cos α₀ = 1 − P_d/(2A). Balls of
    /// a deep-groove bearing may be a little too large for them.
    fn of_raceways(
        &self,
        [bottom_inner, bottom_outer]: [f64; 2],
        deep_groove: bool,
        keys: &TableKeys<'_>,
    ) -> Result<(f64, f64), InputError> {
        let (ball, pitch) = (self.row.diameter_mm, self.row.pitch_mm);
        let [inner, outer] = self.conformities;
        let distance_mm = self.groove_distance_mm();
        let range = Clearances::of_balls(MM * ball, 2.0 * MM * distance_mm);
        let clearance = bottom_outer - bottom_inner - 2.0 * ball;
        let refused = |why: &str| {
            keys.error(
                "raceway_diameters_mm",
                format!(
                    "found {bottom_inner} and {bottom_outer}; {bottom_outer} - {bottom_inner} - 2 x {ball} = {clearance:.4} mm{why}"
                ),
            )
        };
        let goes_in = clearance >= 0.0 || deep_groove;
        if !(goes_in && range.holds_elements(MM * clearance)) {
            return Err(refused(": the balls do not go in between"));
        }
        if !range.touches(MM * clearance) {
            return Err(refused(&format!(
                " of play, but grooves of {inner} and {outer} ball diameters hold a ball with less than {:.4} mm only: no ball touches both. \
                 Check the diameters (they are those of the grooves' bottoms), or state the {} instead",
                2.0 * distance_mm,
                if deep_groove {
                    "radial_clearance_um"
                } else {
                    "contact_angle_deg"
                }
            )));
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
        Ok((free, interference))
    }

    /// Balls and grooves with shoulders; what follows from diameters of raceways is noted.
    fn in_grooves(
        &self,
        kind: BallBearingKind,
        free: (f64, f64),
        (raceways_mm, shoulders_mm): (Option<[f64; 2]>, Option<[f64; 2]>),
        (keys, notes): (&TableKeys<'_>, &mut Vec<String>),
    ) -> Result<BallGeometry, InputError> {
        let heights = shoulder_heights_m(shoulders_mm, keys, self.row.diameter_mm)?;
        let geometry = self.geometry(kind, free, heights);
        if raceways_mm.is_some() {
            notes.push(format!(
                "the raceways leave a radial clearance of {:.1} um: contact angle {:.3} deg without load",
                geometry.radial_clearance_m() / UM,
                geometry.free_angle_rad.to_degrees()
            ));
        }
        Ok(geometry)
    }
}

/// What is wrong with a key beside diameters of raceways.
const TWICE: &str =
    "is given together with raceway_diameters_mm, from which it follows; remove one of the two";

/// A deep-groove bearing.
pub(super) fn deep_groove(
    balls: &BallKeys,
    own: &DeepGrooveKeys,
    keys: &TableKeys<'_>,
    notes: &mut Vec<String>,
) -> Result<BallGeometry, InputError> {
    let balls = balls.checked(keys)?;
    let free = match own.raceway_diameters_mm {
        Some(bottoms) => {
            keys.refuse(&given!(own; radial_clearance_um), TWICE)?;
            balls.of_raceways(bottoms, true, keys)?
        }
        None => {
            let distance_mm = balls.groove_distance_mm();
            let range = Clearances::of_balls(MM * balls.row.diameter_mm, 2.0 * MM * distance_mm);
            let clearance_mm = range.stated_m(own.radial_clearance_um, keys)? / MM;
            angle_of_clearance(clearance_mm, distance_mm)
        }
    };
    let stated = (own.raceway_diameters_mm, own.shoulder_heights_mm);
    balls.in_grooves(BallBearingKind::DeepGroove, free, stated, (keys, notes))
}

/// An angular-contact bearing.
pub(super) fn angular_contact(
    balls: &BallKeys,
    own: &AngularContactKeys,
    keys: &TableKeys<'_>,
    notes: &mut Vec<String>,
) -> Result<BallGeometry, InputError> {
    let balls = balls.checked(keys)?;
    let free = match own.raceway_diameters_mm {
        Some(bottoms) => {
            keys.refuse(&given!(own; contact_angle_deg), TWICE)?;
            balls.of_raceways(bottoms, false, keys)?
        }
        None => {
            let needed_by = "a bearing without raceway_diameters_mm";
            let degrees = keys.needed("contact_angle_deg", own.contact_angle_deg, needed_by)?;
            (degrees.to_radians(), 0.0)
        }
    };
    let stated = (own.raceway_diameters_mm, own.shoulder_heights_mm);
    balls.in_grooves(BallBearingKind::AngularContact, free, stated, (keys, notes))
}

/// A four-point bearing.
pub(super) fn four_point(
    balls: &BallKeys,
    own: &FourPointKeys,
    keys: &TableKeys<'_>,
) -> Result<BallGeometry, InputError> {
    let balls = balls.checked(keys)?;
    let angle = own.contact_angle_deg.to_radians();
    let sizes = (MM * balls.row.diameter_mm, MM * balls.groove_distance_mm());
    let kind = four_point_kind(own.radial_clearance_um, keys, sizes, angle)?;
    let heights = shoulder_heights_m(own.shoulder_heights_mm, keys, balls.row.diameter_mm)?;
    Ok(balls.geometry(kind, (angle, 0.0), heights))
}

/// A thrust bearing.
pub(super) fn thrust(balls: &BallKeys, keys: &TableKeys<'_>) -> Result<BallGeometry, InputError> {
    let free = (std::f64::consts::FRAC_PI_2, 0.0);
    let balls = balls.checked(keys)?;
    Ok(balls.geometry(BallBearingKind::Thrust, free, None))
}

/// `shoulder_heights_mm`, for balls of a diameter \[mm\].
pub(super) fn shoulder_heights_m(
    stated: Option<[f64; 2]>,
    keys: &TableKeys<'_>,
    ball: f64,
) -> Result<Option<[f64; 2]>, InputError> {
    let Some(heights) = stated else {
        return Ok(None);
    };
    let most = 0.5 * ball;
    for height in heights {
        keys.require(
            "shoulder_heights_mm",
            height,
            height > 0.0 && height <= most,
            &format!("more than 0 and at most {most}, half of the ball's diameter"),
        )?;
    }
    Ok(Some(heights.map(|height| MM * height)))
}

/// Play up to that at which balls touch two arcs only under thrust.
pub(super) fn four_point_kind(
    clearance_um: Option<f64>,
    keys: &TableKeys<'_>,
    (ball_m, distance_m): (f64, f64),
    angle_rad: f64,
) -> Result<BallBearingKind, InputError> {
    let range = Clearances::of_balls(ball_m, 2.0 * distance_m * angle_rad.cos());
    let clearance_m = range.stated_m(clearance_um, keys)?;
    Ok(BallBearingKind::FourPoint { clearance_m })
}

/// α₀ and the interference of deep-groove bearings from the clearance and the distance of the grooves' centres: cos α
/// = 1 − P_d/(2A) as sin²(α/2) = P_d/(4A), which keeps the digits of small clearances.
pub(super) fn angle_of_clearance(clearance: f64, distance: f64) -> (f64, f64) {
    let half_sine = (0.25 * clearance.max(0.0) / distance).sqrt();
    (2.0 * half_sine.asin(), (-clearance).max(0.0))
}
