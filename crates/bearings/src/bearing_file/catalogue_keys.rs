//! Keys of a bearing that is known by its catalogue line only.

use gearmesh_geometry::input::{Bounded, InputDocument, Positive, TableKeys};
use gearmesh_geometry::{InputError, given};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::ball_keys::{Conformity, angle_of_clearance, four_point_kind, shoulder_heights_m};
use super::barrel_keys::usual_shape;
use super::element_keys::Clearances;
use super::roller_keys::{LAMINAE, usual_taper};
use super::row_keys::{PreloadKeys, RowKeys};
use super::{GeneralKeys, Inside, MM};
use crate::catalogue::{CatalogueLine, CatalogueType, KnownInside};
use crate::definition::{
    Arrangement, BallBearingKind, BallGeometry, BearingGeometry, RollerGeometry, RollerProfile,
    StatedRatings,
};
use crate::designations;
use crate::estimate::Estimate;

/// Keys of a line of a catalogue.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct CatalogueKeys {
    /// A designation such as "6205", "7010 C", "NU 204" or "30206": boundary dimensions by ISO 15 and ISO 355.
    designation: Option<String>,
    /// Type, where no designation is given.
    r#type: Option<CatalogueType>,
    /// Contact angle without load of angular-contact, four-point and spherical roller bearings; of tapered ones the
    /// angle of the outer race.
    contact_angle_deg: Option<f64>,
    /// Play across the axis from one side to the other; negative: interference, as fits leave it; 0 where not given.
    radial_clearance_um: Option<f64>,
    /// Ball bearings: number of balls in a row, where it is known.
    balls: Option<usize>,
    /// Ball bearings: diameter of the balls, where it is known.
    ball_diameter_mm: Option<Bounded<Positive>>,
    /// Ball bearings: radius of the inner groove over the ball's diameter, where it is known.
    inner_conformity: Option<Bounded<Conformity>>,
    /// Ball bearings: radius of the outer groove over the ball's diameter, where it is known.
    outer_conformity: Option<Bounded<Conformity>>,
    /// Ball bearings: heights of the shoulders above the bottoms of the inner and outer groove, where they are known.
    shoulder_heights_mm: Option<[f64; 2]>,
    /// Roller bearings: number of rollers in a row, where it is known.
    rollers: Option<usize>,
    /// Roller bearings: diameter of the rollers, in their middle, where it is known.
    roller_diameter_mm: Option<Bounded<Positive>>,
    /// Roller bearings: length of the rollers that carries, where it is known.
    roller_length_mm: Option<Bounded<Positive>>,
    /// Diameter of the circle of the balls' or rollers' middles, where it is known; the middle between bore and outside
    /// diameter otherwise.
    pitch_diameter_mm: Option<Bounded<Positive>>,
}

/// A line: its own keys, those of its rows and those of all bearings.
#[derive(Clone, Copy)]
pub(super) struct Line<'a> {
    pub general: &'a GeneralKeys,
    pub rows: &'a RowKeys,
    pub preload: &'a PreloadKeys,
    pub own: &'a CatalogueKeys,
}

/// Finds or reads the line and estimates what is inside.
pub(super) fn inside(
    file: Line<'_>,
    document: &InputDocument,
    keys: &TableKeys<'_>,
    notes: &mut Vec<String>,
) -> Result<Inside, InputError> {
    let (mut line, name) = match &file.own.designation {
        Some(designation) => designated(designation, file, keys, notes)?,
        None => (line(file, keys)?, None),
    };
    read_ratings(file, document, &mut line, name.is_some())?;
    refuse_unused(file, keys, line.kind)?;
    line.known = known(file, line.kind);
    if line.kind == CatalogueType::SphericalRoller && line.contact_angle_rad == 0.0 {
        // Rows whose middles stand half the width apart.
        line.contact_angle_rad = (0.5 * line.width_m / line.pitch_m()).atan();
        notes.push(format!(
            "the contact angle is assumed as {:.2} deg, with which the rows stand half the width apart; give contact_angle_deg where it is known (atan(e/1.5))",
            line.contact_angle_rad.to_degrees()
        ));
    }
    line.check().map_err(|no| {
        let table = TableKeys::new(document, if no.in_ratings { "ratings" } else { "" });
        // Metres in millimetres again: without what rounding leaves.
        let found = (1e9 * no.found).round() / 1e9;
        table.error(no.key, format!("found {found}, allowed is {}", no.allowed))
    })?;
    let estimate = line.estimate().ok_or_else(|| {
        keys.error(
            "bore_mm",
            "no number of balls or rollers that reaches the ratings goes between bore and outside diameter and into the width; check the line",
        )
    })?;
    let geometry = if line.kind.has_rollers() {
        roller_geometry(file, keys, &line, &estimate)?
    } else {
        ball_geometry(file, keys, &line, &estimate)?
    };
    notes.push(
        "number and size of the rolling elements that the file does not state are estimated from the catalogue line (ISO 281, ISO 76); pitch diameter, \
         conformities and clearance are assumed where not given"
            .to_owned(),
    );
    let stated = file.general.stated_ratings();
    let (arrangement, ratings) = match rows(file, keys, &line, &estimate, notes)? {
        Some(rows) => (rows, stated),
        None => {
            // The line's ratings are those of one bearing.
            let of_one = StatedRatings {
                dynamic_n: line.dynamic_n,
                static_n: line.static_n,
                fatigue_n: None,
            };
            let arrangement = file.rows.arrangement(keys)?;
            let bearings = arrangement.rows().len();
            let ratings = of_one.of_several(bearings, &geometry, stated.fatigue_n);
            (arrangement, ratings)
        }
    };
    Ok(Inside {
        geometry,
        arrangement,
        preload: file.preload.preload(keys)?,
        ratings,
        boundary_m: (Some(line.bore_m), Some(line.outside_m)),
        estimate: Some(estimate),
        name,
    })
}

/// The line of a designation.
fn designated(
    designation: &str,
    file: Line<'_>,
    keys: &TableKeys<'_>,
    notes: &mut Vec<String>,
) -> Result<(CatalogueLine, Option<String>), InputError> {
    let mut listed = designations::find(designation).ok_or_else(|| {
        keys.error(
            "designation",
            format!(
                "found \"{designation}\", allowed are {}; give type, bore_mm, outside_diameter_mm and width_mm instead",
                designations::known()
            ),
        )
    })?;
    let twice = "is given together with a designation, which says it; remove one of the two";
    keys.refuse(&given!(file.own; r#type), twice)?;
    keys.refuse(
        &given!(file.general; bore_mm, outside_diameter_mm, width_mm),
        twice,
    )?;
    if listed.says_angle {
        keys.refuse(&given!(file.own; contact_angle_deg), twice)?;
    } else {
        listed.line.contact_angle_rad = contact_angle(file, keys, listed.line.kind)?;
    }
    notes.push(format!("{}: {}", listed.designation, listed.source()));
    Ok((listed.line, Some(listed.designation)))
}

/// What is known of the inside.
fn known(file: Line<'_>, kind: CatalogueType) -> KnownInside {
    let (number, diameter) = if kind.has_rollers() {
        (file.own.rollers, file.own.roller_diameter_mm)
    } else {
        (file.own.balls, file.own.ball_diameter_mm)
    };
    KnownInside {
        elements: number,
        diameter_m: diameter.map(|mm| MM * mm),
        length_m: file.own.roller_length_mm.map(|mm| MM * mm),
        pitch_m: file.own.pitch_diameter_mm.map(|mm| MM * mm),
    }
}

/// Rows within one pair of rings.
fn rows(
    file: Line<'_>,
    keys: &TableKeys<'_>,
    line: &CatalogueLine,
    estimate: &Estimate,
    notes: &mut Vec<String>,
) -> Result<Option<Arrangement>, InputError> {
    if line.kind.rows() == 1 {
        return Ok(None);
    }
    if line.kind == CatalogueType::SphericalRoller {
        let distance_m = estimate.pitch_m * line.contact_angle_rad.tan();
        return Ok(Some(Arrangement::X { distance_m }));
    }
    let most_m = line.width_m - estimate.diameter_m;
    // Balls of both rows side by side, were they not staggered.
    let least_m = 0.5 * estimate.diameter_m;
    let distance_m = match file.rows.row_distance_mm {
        Some(mm) => MM * mm,
        None => {
            let distance_m = (0.5 * line.width_m).max(estimate.diameter_m).min(most_m);
            notes.push(format!(
                "the rows are assumed to stand {:.2} mm apart; give row_distance_mm where it is known",
                distance_m / MM
            ));
            distance_m
        }
    };
    keys.require(
        "row_distance_mm",
        distance_m / MM,
        distance_m >= least_m && distance_m <= most_m,
        &format!(
            "{:.2} to {:.2}: two rows of balls of {:.2} mm in a width of {} mm",
            least_m / MM,
            most_m / MM,
            estimate.diameter_m / MM,
            line.width_m / MM
        ),
    )?;
    file.rows.of_double_row(keys, distance_m).map(Some)
}

fn roller_geometry(
    file: Line<'_>,
    keys: &TableKeys<'_>,
    line: &CatalogueLine,
    estimate: &Estimate,
) -> Result<BearingGeometry, InputError> {
    let size = (estimate.diameter_m, estimate.length_m, estimate.pitch_m);
    let is = |kind: CatalogueType| line.kind == kind;
    let taper = is(CatalogueType::TaperedRoller).then(|| usual_taper(line.contact_angle_rad, size));
    let barrel = is(CatalogueType::SphericalRoller)
        .then(|| usual_shape(line.contact_angle_rad, size.2, size.0));
    let share = match (&taper, &barrel) {
        (Some(_), _) => 0.45e-3,
        (None, Some(_)) => 0.0,
        (None, None) => 0.35e-3,
    };
    Ok(BearingGeometry::Roller(RollerGeometry {
        rollers: estimate.elements,
        diameter_m: estimate.diameter_m,
        length_m: estimate.length_m,
        pitch_diameter_m: estimate.pitch_m,
        radial_clearance_m: Clearances::of_rollers(size.0)
            .stated_m(file.own.radial_clearance_um, keys)?,
        taper,
        barrel,
        profile: RollerProfile::Logarithmic {
            scale_m: share * estimate.diameter_m,
        },
        laminae: LAMINAE,
    }))
}

fn ball_geometry(
    file: Line<'_>,
    keys: &TableKeys<'_>,
    line: &CatalogueLine,
    estimate: &Estimate,
) -> Result<BearingGeometry, InputError> {
    let usual = match line.kind {
        CatalogueType::ThrustBall => [0.54; 2],
        _ => [0.52, 0.53],
    };
    let inner = file.own.inner_conformity.map_or(usual[0], f64::from);
    let outer = file.own.outer_conformity.map_or(usual[1], f64::from);
    let (ball_m, distance_m) = (
        estimate.diameter_m,
        (inner + outer - 1.0) * estimate.diameter_m,
    );
    let (kind, (free_angle_rad, interference_m)) = match line.kind {
        CatalogueType::DeepGroove => {
            let range = Clearances::of_balls(ball_m, 2.0 * distance_m);
            let angle = angle_of_clearance(
                range.stated_m(file.own.radial_clearance_um, keys)?,
                distance_m,
            );
            (BallBearingKind::DeepGroove, angle)
        }
        CatalogueType::FourPoint => {
            let (sizes, angle) = ((ball_m, distance_m), line.contact_angle_rad);
            let kind = four_point_kind(file.own.radial_clearance_um, keys, sizes, angle)?;
            (kind, (angle, 0.0))
        }
        CatalogueType::ThrustBall => (BallBearingKind::Thrust, (std::f64::consts::FRAC_PI_2, 0.0)),
        _ => (
            BallBearingKind::AngularContact,
            (line.contact_angle_rad, 0.0),
        ),
    };
    Ok(BearingGeometry::Ball(BallGeometry {
        kind,
        balls: estimate.elements,
        ball_diameter_m: estimate.diameter_m,
        pitch_diameter_m: estimate.pitch_m,
        inner_conformity: inner,
        outer_conformity: outer,
        free_angle_rad,
        interference_m,
        stated_shoulder_heights_m: shoulder_heights_m(
            file.own.shoulder_heights_mm,
            keys,
            estimate.diameter_m / MM,
        )?,
    }))
}

/// The line as the file states it, without ratings.
fn line(file: Line<'_>, keys: &TableKeys<'_>) -> Result<CatalogueLine, InputError> {
    let needed_by = "a catalogue bearing without designation";
    let kind = keys.needed("type", file.own.r#type, needed_by)?;
    let size = |key: &str, value: Option<Bounded<Positive>>| {
        let value = keys.needed(key, value, needed_by)?;
        Ok::<_, InputError>(MM * value)
    };
    let bore_m = size("bore_mm", file.general.bore_mm)?;
    let outside_m = size("outside_diameter_mm", file.general.outside_diameter_mm)?;
    let width_m = size("width_mm", file.general.width_mm)?;
    keys.require(
        "outside_diameter_mm",
        outside_m / MM,
        outside_m > bore_m,
        &format!("more than the bore, {}", bore_m / MM),
    )?;
    Ok(CatalogueLine {
        kind,
        bore_m,
        outside_m,
        width_m,
        dynamic_n: None,
        static_n: None,
        contact_angle_rad: contact_angle(file, keys, kind)?,
        known: KnownInside::default(),
    })
}

/// Ratings that the file states; they belong to one bearing.
fn read_ratings(
    file: Line<'_>,
    document: &InputDocument,
    line: &mut CatalogueLine,
    has_designation: bool,
) -> Result<(), InputError> {
    let table = TableKeys::new(document, "ratings");
    let ratings = file.general.ratings.clone().unwrap_or_default();
    for (key, value, place) in [
        ("dynamic_N", ratings.dynamic_N, &mut line.dynamic_n),
        ("static_N", ratings.static_N, &mut line.static_n),
    ] {
        if !has_designation {
            table.needed(key, value, "a catalogue bearing without designation")?;
        }
        *place = value.map(f64::from);
    }
    Ok(())
}

fn contact_angle(
    file: Line<'_>,
    keys: &TableKeys<'_>,
    kind: CatalogueType,
) -> Result<f64, InputError> {
    let key = "contact_angle_deg";
    match (kind.angles_deg(), file.own.contact_angle_deg) {
        // Follows from the width where it is not known.
        (Some(_), None) if kind == CatalogueType::SphericalRoller => Ok(0.0),
        (Some([least, most]), angle) => {
            let needed_by = match kind {
                CatalogueType::TaperedRoller => {
                    "type = \"tapered-roller\" (where a catalogue prints e, the angle is atan(e/1.5))".to_owned()
                }
                _ => format!("type = \"{}\"", kind.word()),
            };
            let degrees = keys.needed(key, angle, &needed_by)?;
            keys.require(
                key,
                degrees,
                (least..=most).contains(&degrees),
                &format!("{least} to {most}"),
            )?;
            Ok(degrees.to_radians())
        }
        (None, None) => Ok(0.0),
        (None, Some(_)) => Err(keys.error(
            key,
            format!(
                "is not used by type = \"{}\", which has none of its own; remove it",
                kind.word()
            ),
        )),
    }
}

/// Keys that the type of a line does not use are errors.
fn refuse_unused(
    file: Line<'_>,
    keys: &TableKeys<'_>,
    kind: CatalogueType,
) -> Result<(), InputError> {
    const BALLS: &str =
        "deep-groove angular-contact angular-contact-double-row four-point thrust-ball";
    const WITH_SHOULDERS: &str =
        "deep-groove angular-contact angular-contact-double-row four-point";
    const ROLLERS: &str = "cylindrical-roller tapered-roller spherical-roller";
    // The play of the others is said by their contact angle or preload_um.
    const WITH_PLAY: &str = "deep-groove four-point cylindrical-roller spherical-roller";
    const PAIRED: &str =
        "deep-groove angular-contact angular-contact-double-row cylindrical-roller tapered-roller";
    let (own, rows) = (file.own, file.rows);
    let groups: &[(&[(&str, bool)], &str)] = &[
        (&given!(own; balls, ball_diameter_mm), BALLS),
        (&given!(own; inner_conformity, outer_conformity), BALLS),
        (&given!(own; shoulder_heights_mm), WITH_SHOULDERS),
        (&given!(own; rollers, roller_diameter_mm), ROLLERS),
        (&given!(own; roller_length_mm), ROLLERS),
        (&given!(own; radial_clearance_um), WITH_PLAY),
        (&given!(rows; arrangement, row_distance_mm), PAIRED),
    ];
    keys.refuse_unused(("type", kind.word()), groups)
}
