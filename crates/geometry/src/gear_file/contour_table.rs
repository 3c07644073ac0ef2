//! `[[blank.web]]` and `blank.hub_z_mm`: hub and web by their axial contour, with fillets in its corners.

use super::{MM, TableKeys};
use crate::blank::{Blank, Contour, ContourPoint, Web};
use crate::body_outline::body_outline;
use crate::input::{Bounded, InputError, NotNegative};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Lengths that differ by less are equal \[mm\].
const SAME_MM: f64 = 1e-6;

/// One point of the contour: where the web has this diameter, it reaches from back to front.
#[derive(Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct WebPointTable {
    /// Diameter.
    diameter_mm: f64,
    /// Back and front of the web there.
    z_mm: [f64; 2],
    /// Fillet radius of the corners there; 0 (sharp) where not given.
    fillet_radius_mm: Option<Bounded<NotNegative>>,
}

/// What a contour must fit.
pub(super) struct ContourRoom {
    pub bore_mm: f64,
    /// Largest diameter of the last point.
    pub ring_mm: f64,
    pub width_mm: f64,
    /// Walls are not thinner.
    pub least_mm: f64,
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
    for k in 0..points.len() {
        check_point(keys, k, points, room)?;
    }
    let half = 0.5 * room.width_mm;
    let last = format!("web.{}.z_mm", points.len() - 1);
    for (side, z) in [(-1.0, rim.z_mm[0]), (1.0, rim.z_mm[1])] {
        keys.require(
            &last,
            z,
            is_flush_or_clear(half - side * z, room),
            &format!(
                "-{half} to {half} at the rim: inside the face width, flush with it or {:.4} away",
                room.least_mm
            ),
        )?;
    }
    for (k, (side, name)) in [(-1.0, "back"), (1.0, "front")].into_iter().enumerate() {
        let at_hub = side * (hub_z_mm[k] - hub.z_mm[k]);
        keys.require(
            "hub_z_mm",
            hub_z_mm[k],
            is_flush_or_clear(at_hub, room),
            &format!(
                "at or beyond the {name} of the web at the hub, {}; if beyond, by at least {:.4}",
                hub.z_mm[k], room.least_mm
            ),
        )?;
    }
    let contour = Contour {
        hub_z_m: hub_z_mm.map(|z| z * MM),
        web: points
            .iter()
            .map(|point| ContourPoint {
                radius_m: 0.5 * point.diameter_mm * MM,
                z_m: point.z_mm.map(|z| z * MM),
                fillet_radius_m: point.fillet_radius_mm.map_or(0.0, f64::from) * MM,
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

/// A point against those before and behind it.
fn check_point(
    keys: &TableKeys,
    k: usize,
    points: &[WebPointTable],
    room: &ContourRoom,
) -> Result<(), InputError> {
    let (diameter, [back, front]) = (points[k].diameter_mm, points[k].z_mm);
    let before = k.checked_sub(1).map(|before| &points[before]);
    let least = before.map_or(room.bore_mm, |point| point.diameter_mm);
    let behind = points.get(k + 1);
    let most = behind.map_or(room.ring_mm, |point| point.diameter_mm);
    // Two points at one diameter are a step of the web.
    let step = before.filter(|point| point.diameter_mm == diameter);
    keys.require(
        &format!("web.{k}.diameter_mm"),
        diameter,
        (diameter >= least + 2.0 * room.least_mm || step.is_some())
            && (diameter < most || behind.is_some() && diameter == most),
        &format!(
            "at least {:.4} and less than {most:.3}: from the hub outwards in steps of two thousandths of a module, the rim at least half a module thick",
            least + 2.0 * room.least_mm
        ),
    )?;
    let z_key = format!("web.{k}.z_mm");
    keys.require(
        &z_key,
        front - back,
        front >= back + room.least_mm,
        &format!(
            "[back, front] with back < front, at least {:.4} apart, a thousandth of a module",
            room.least_mm
        ),
    )?;
    if let Some(before) = step.map(|point| point.z_mm) {
        let common = before[1].min(front) - before[0].max(back);
        keys.require(
            &z_key,
            common,
            common >= room.least_mm && (back != before[0] || front != before[1]),
            "a step that moves a face and leaves the web in one piece: a thousandth of a module in common with the point before it",
        )?;
    }
    Ok(())
}

/// Whether two faces are one, or so far apart as walls are thick.
fn is_flush_or_clear(apart_mm: f64, room: &ContourRoom) -> bool {
    apart_mm.abs() <= SAME_MM || apart_mm >= room.least_mm
}

/// Every fillet must find a corner and room in it.
pub(super) fn check_fillets(
    keys: &TableKeys,
    blank: &Blank,
    width_m: f64,
    outer_m: f64,
) -> Result<(), InputError> {
    body_outline(blank, width_m, outer_m)
        .map(|_| ())
        .map_err(|e| keys.error(&format!("web.{}.fillet_radius_mm", e.web_point()), e))
}
