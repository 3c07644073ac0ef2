//! `[[blank.web]]` and `blank.hub_z_mm`: hub and web by their axial contour.

use super::{MM, TableKeys};
use crate::definition::{Contour, ContourPoint, Openings, Web};
use crate::input::InputError;
use schemars::JsonSchema;
use serde::Deserialize;

/// Lengths that differ by less are equal \[mm\].
const SAME_MM: f64 = 1e-6;

/// One point of the contour: where the web has this diameter, it reaches from back to front.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct WebPointTable {
    diameter_mm: f64,
    z_mm: [f64; 2],
}

/// What a contour must fit.
pub(super) struct ContourRoom {
    pub bore_mm: f64,
    /// Largest diameter of the last point.
    pub ring_mm: f64,
    pub width_mm: f64,
}

/// The contour, and the web as it is at the rim, in SI units.
pub(super) fn check_contour(
    keys: &TableKeys,
    hub_z_mm: [f64; 2],
    points: &[WebPointTable],
    room: &ContourRoom,
) -> Result<(Contour, Web), InputError> {
    let (Some(hub), Some(rim)) = (points.first(), points.last()) else {
        return Err(keys.error(
            "web",
            "missing; a contour needs [[blank.web]] with diameter_mm and z_mm at the hub and at the rim",
        ));
    };
    if points.len() < 2 {
        return Err(keys.error(
            "web",
            "found one point, at least two are needed: at the hub and at the rim",
        ));
    }
    let mut least = room.bore_mm;
    for (k, point) in points.iter().enumerate() {
        let most = if k + 1 == points.len() {
            room.ring_mm
        } else {
            points[k + 1].diameter_mm
        };
        let [back, front] = point.z_mm;
        keys.require(
            &format!("web.{k}.diameter_mm"),
            point.diameter_mm,
            point.diameter_mm > least && point.diameter_mm < most,
            &format!("more than {least:.3} and less than {most:.3}: from the hub outwards, the rim at least half a module thick"),
        )?;
        let z_key = format!("web.{k}.z_mm");
        keys.require(
            &z_key,
            front - back,
            front > back,
            "[back, front] with back < front",
        )?;
        least = point.diameter_mm;
    }
    let half = 0.5 * room.width_mm;
    let last = format!("web.{}.z_mm", points.len() - 1);
    for (side, z) in [(-1.0, rim.z_mm[0]), (1.0, rim.z_mm[1])] {
        keys.require(
            &last,
            z,
            side * z <= half + SAME_MM,
            &format!("-{half} to {half} at the rim: inside the face width"),
        )?;
    }
    // Layers beside the web run through rim and hub alike.
    for (k, (side, name)) in [(-1.0, "back"), (1.0, "front")].into_iter().enumerate() {
        let at_rim = half - side * rim.z_mm[k];
        let at_hub = side * (hub_z_mm[k] - hub.z_mm[k]);
        keys.require(
            "hub_z_mm",
            hub_z_mm[k],
            at_hub > -SAME_MM,
            &format!(
                "at or beyond the {name} of the web at the hub, {}",
                hub.z_mm[k]
            ),
        )?;
        if (at_rim > SAME_MM) != (at_hub > SAME_MM) {
            return Err(keys.error(
                "hub_z_mm",
                format!(
                    "at the {name} the web ends {at_rim:.3} mm inside the rim's face and {at_hub:.3} mm inside the hub's; the layers of \
                     elements need both to be more than 0, or both to be 0"
                ),
            ));
        }
    }
    let contour = Contour {
        hub_z_m: hub_z_mm.map(|z| z * MM),
        web: points
            .iter()
            .map(|point| ContourPoint {
                radius_m: 0.5 * point.diameter_mm * MM,
                z_m: point.z_mm.map(|z| z * MM),
            })
            .collect(),
    };
    let web = Web {
        hub_radius_m: 0.5 * hub.diameter_mm * MM,
        rim_inner_radius_m: 0.5 * rim.diameter_mm * MM,
        thickness_m: (rim.z_mm[1] - rim.z_mm[0]) * MM,
        offset_m: 0.5 * (rim.z_mm[0] + rim.z_mm[1]) * MM,
    };
    Ok((contour, web))
}

/// Openings must keep between two neighbouring points of the contour, where circles of nodes lie.
pub(super) fn check_kinks(
    keys: &TableKeys,
    contour: &Contour,
    openings: Option<&Openings>,
) -> Result<(), InputError> {
    let Some((inner, outer)) = openings.map(Openings::radii_m) else {
        return Ok(());
    };
    for (k, point) in contour.web.iter().enumerate() {
        if point.radius_m >= inner && point.radius_m <= outer {
            return Err(keys.error(
                &format!("web.{k}.diameter_mm"),
                format!(
                    "found {}, which lies among the openings (diameters {:.3} to {:.3} mm); allowed is below or above all of them",
                    2.0 * point.radius_m / MM,
                    2.0 * inner / MM,
                    2.0 * outer / MM
                ),
            ));
        }
    }
    Ok(())
}
