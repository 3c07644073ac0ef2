//! Keys of a bearing that is known by its catalogue line only.

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{InputDocument, TableKeys};

use super::ball_keys::MOST_INTERFERENCE;
use super::roller_keys::require_clearance;
use super::{BearingFile, MM, UM};
use crate::catalogue::{CATALOGUE, CatalogueLine, CatalogueType, find};
use crate::definition::{
    BallBearingKind, BallGeometry, BearingGeometry, RollerGeometry, RollerProfile,
};
use crate::estimate::Estimate;

/// A bearing estimated from its line.
pub(super) struct FromCatalogue {
    pub geometry: BearingGeometry,
    pub line: CatalogueLine,
    pub estimate: Estimate,
    pub name: Option<String>,
}

/// Finds or reads the line and estimates what is inside.
pub(super) fn geometry(
    file: &BearingFile,
    document: &InputDocument,
    keys: &TableKeys<'_>,
    notes: &mut Vec<String>,
) -> Result<FromCatalogue, InputError> {
    let (line, name) = match &file.designation {
        Some(designation) => {
            let listed = find(designation).ok_or_else(|| {
                let known: Vec<&str> = CATALOGUE.iter().map(|one| one.designation).collect();
                keys.error(
                    "designation",
                    format!(
                        "found \"{designation}\", allowed is one of {}; give type, bore_mm, outside_diameter_mm, width_mm and [ratings] instead",
                        known.join(", ")
                    ),
                )
            })?;
            for (key, given) in [
                ("type", file.r#type.is_some()),
                ("bore_mm", file.bore_mm.is_some()),
                ("outside_diameter_mm", file.outside_diameter_mm.is_some()),
                ("width_mm", file.width_mm.is_some()),
                ("contact_angle_deg", file.contact_angle_deg.is_some()),
            ] {
                if given {
                    return Err(keys.error(
                        key,
                        "is given together with a designation, which says it; remove one of the two",
                    ));
                }
            }
            notes.push(format!("{}: {}", listed.designation, listed.source));
            (listed.line, Some(listed.designation.to_owned()))
        }
        None => (line(file, document, keys)?, None),
    };
    let estimate = line.estimate().ok_or_else(|| {
        keys.error(
            "bore_mm",
            "no number of balls or rollers goes between bore and outside diameter; check the line",
        )
    })?;
    let clearance_m = UM * file.radial_clearance_um.unwrap_or(0.0);
    let geometry = match line.kind {
        CatalogueType::DeepGroove | CatalogueType::AngularContact => {
            ball_geometry(file, keys, &line, &estimate, clearance_m)?
        }
        CatalogueType::CylindricalRoller => {
            require_clearance(keys, clearance_m / UM, estimate.diameter_m / UM)?;
            for (key, given) in [
                ("inner_conformity", file.inner_conformity.is_some()),
                ("outer_conformity", file.outer_conformity.is_some()),
            ] {
                if given {
                    return Err(keys.error(key, "is not used by a roller bearing; remove it"));
                }
            }
            BearingGeometry::Roller(RollerGeometry {
                rollers: estimate.elements,
                diameter_m: estimate.diameter_m,
                length_m: estimate.length_m,
                pitch_diameter_m: estimate.pitch_m,
                radial_clearance_m: clearance_m,
                taper: None,
                profile: RollerProfile::Logarithmic {
                    scale_m: 0.35e-3 * estimate.diameter_m,
                },
                laminae: 40,
            })
        }
    };
    notes.push(
        "number and size of the rolling elements are estimated from the catalogue line (ISO 281, ISO 76); pitch diameter, conformities and clearance are \
         assumed where not given"
            .to_owned(),
    );
    Ok(FromCatalogue {
        geometry,
        line,
        estimate,
        name,
    })
}

fn ball_geometry(
    file: &BearingFile,
    keys: &TableKeys<'_>,
    line: &CatalogueLine,
    estimate: &Estimate,
    clearance_m: f64,
) -> Result<BearingGeometry, InputError> {
    let conformity = |key: &str, value: Option<f64>, usual: f64| {
        let value = value.unwrap_or(usual);
        keys.require(
            key,
            value,
            value > 0.5 && value <= 1.0,
            "more than 0.5 and at most 1",
        )?;
        Ok::<_, InputError>(value)
    };
    let inner = conformity("inner_conformity", file.inner_conformity, 0.52)?;
    let outer = conformity("outer_conformity", file.outer_conformity, 0.53)?;
    let (kind, free_angle_rad) = match line.kind {
        CatalogueType::AngularContact => {
            if file.radial_clearance_um.is_some() {
                return Err(keys.error(
                    "radial_clearance_um",
                    "is not used by an angular-contact bearing, whose contact angle says it; remove it",
                ));
            }
            (BallBearingKind::AngularContact, line.contact_angle_rad)
        }
        _ => {
            let distance_m = (inner + outer - 1.0) * estimate.diameter_m;
            let (least, most) = (
                -MOST_INTERFERENCE * estimate.diameter_m / UM,
                2.0 * distance_m / UM,
            );
            keys.require(
                "radial_clearance_um",
                clearance_m / UM,
                (least..most).contains(&(clearance_m / UM)),
                &format!("{least:.1} (interference of a hundredth of the ball's diameter) up to, not including, {most:.1}"),
            )?;
            let half_sine = (0.25 * clearance_m.max(0.0) / distance_m).sqrt();
            (BallBearingKind::DeepGroove, 2.0 * half_sine.asin())
        }
    };
    Ok(BearingGeometry::Ball(BallGeometry {
        kind,
        balls: estimate.elements,
        ball_diameter_m: estimate.diameter_m,
        pitch_diameter_m: estimate.pitch_m,
        inner_conformity: inner,
        outer_conformity: outer,
        free_angle_rad,
        interference_m: match kind {
            BallBearingKind::DeepGroove => (-clearance_m).max(0.0),
            BallBearingKind::AngularContact => 0.0,
        },
    }))
}

/// The line as the file states it.
fn line(
    file: &BearingFile,
    document: &InputDocument,
    keys: &TableKeys<'_>,
) -> Result<CatalogueLine, InputError> {
    let needed_by = "a catalogue bearing without designation";
    let kind = keys.needed("type", file.r#type, needed_by)?;
    let size = |key: &str, value: Option<f64>| {
        let value = keys.needed(key, value, needed_by)?;
        keys.require(key, value, value > 0.0, "more than 0")?;
        Ok::<_, InputError>(MM * value)
    };
    let bore_m = size("bore_mm", file.bore_mm)?;
    let outside_m = size("outside_diameter_mm", file.outside_diameter_mm)?;
    let width_m = size("width_mm", file.width_mm)?;
    keys.require(
        "outside_diameter_mm",
        outside_m / MM,
        outside_m > bore_m,
        &format!("more than the bore, {}", bore_m / MM),
    )?;
    let table = TableKeys::new(document, "ratings");
    let ratings = file.ratings.clone().unwrap_or_default();
    let rating = |key: &str, value: Option<f64>| {
        let value = table.needed(key, value, needed_by)?;
        table.require(key, value, value > 0.0, "more than 0")?;
        Ok::<_, InputError>(value)
    };
    let contact_angle_rad = match (kind, file.contact_angle_deg) {
        (CatalogueType::AngularContact, angle) => {
            let degrees = keys.needed("contact_angle_deg", angle, "an angular-contact bearing")?;
            keys.require(
                "contact_angle_deg",
                degrees,
                degrees > 0.0 && degrees <= 60.0,
                "more than 0 and at most 60",
            )?;
            degrees.to_radians()
        }
        (_, None) => 0.0,
        (_, Some(_)) => {
            return Err(keys.error(
                "contact_angle_deg",
                "is used by type = \"angular-contact\" only; remove it",
            ));
        }
    };
    Ok(CatalogueLine {
        kind,
        bore_m,
        outside_m,
        width_m,
        dynamic_n: rating("dynamic_N", ratings.dynamic_N)?,
        static_n: rating("static_N", ratings.static_N)?,
        contact_angle_rad,
    })
}
