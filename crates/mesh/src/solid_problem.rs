//! What is asked of the mesher for the body of a gear in tetrahedra: its contour with fillets, openings, element sizes.

use crate::MeshError;
use crate::body_circles::first_tooth;
use crate::ring_radius::ring_radius_m;
use crate::solid_mesher::{PlaneLoop, SolidMeshError, SolidProblem};
use gearmesh_geometry::body_outline::{OutlineEdge, body_outline};
use gearmesh_geometry::{GearDefinition, Openings, Slots};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Elements round a full turn of a curved surface: three on the fillet of a right angle.
const ELEMENTS_PER_TURN: f64 = 12.0;
/// Element length at sharp inner corners, where stress is singular, as a share of the largest (as in hexahedra).
const AT_CORNER: f64 = 1.0 / 3.0;
/// Elements through the thickness of the web, about.
pub(crate) const THROUGH_WEB: f64 = 1.5;
/// Distance \[m\] below which radii are one.
const SAME_M: f64 = 1e-8;

/// What is asked of the mesher for the body of a gear.
///
/// # Errors
/// [`MeshError::NoCut`] when no tooth space lies clear of the openings; [`SolidMeshError`] for a contour that cannot
/// be.
pub fn solid_problem(
    gear: &GearDefinition,
    ring_pieces: usize,
    layers: usize,
) -> Result<SolidProblem, MeshError> {
    let sectors = gear.sectors();
    let own = gear.tooth.teeth / sectors;
    let pitch = TAU / gear.tooth.teeth as f64;
    let ring_m = ring_radius_m(gear);
    let start = (first_tooth(gear)? as f64 - 0.5) * pitch;
    let angle = TAU / sectors as f64;
    let closed = sectors == 1;
    // A full turn is made of two halves; the number of the ring's pieces below a tooth is even.
    let pieces = if closed { 2 } else { 1 };
    let edges = body_outline(&gear.blank, gear.tooth.face_width_m, ring_m)
        .map_err(|e| SolidMeshError::Mismatch(e.to_string()))?;
    let arc_m = ring_m * pitch / ring_pieces as f64;
    let layer_m = gear.tooth.face_width_m / layers as f64;
    let mut openings = Vec::new();
    if let Some(given) = gear.blank.openings() {
        let repeat = TAU / given.count() as f64;
        let first = ((start - given.phase_rad()) / repeat).ceil() as i64;
        openings = (0..(given.count() / sectors) as i64)
            .map(|k| opening_loop(&given, given.phase_rad() + repeat * (first + k) as f64))
            .collect();
    }
    Ok(SolidProblem {
        name: "body".into(),
        contour: contour_loop(gear, &edges, ring_m, arc_m.max(layer_m)),
        openings,
        ring_radius: ring_m * 1e3,
        ring_arcs: own * ring_pieces / pieces,
        ring_layers: layers,
        start,
        angle,
        closed,
        pieces,
        largest: gear.mesh.body_m * 1e3,
        elements_per_turn: ELEMENTS_PER_TURN,
    })
}

/// The contour with element sizes at its corners.
fn contour_loop(
    gear: &GearDefinition,
    edges: &[OutlineEdge],
    ring_m: f64,
    ring_size_m: f64,
) -> PlaneLoop {
    let largest = gear.mesh.body_m;
    let count = edges.len();
    let mut contour = PlaneLoop::default();
    let begins: Vec<usize> = edges
        .iter()
        .enumerate()
        .map(|(k, edge)| {
            let before = &edges[(k + count - 1) % count];
            let along = |e: &OutlineEdge| [e.to_m[0] - e.from_m[0], e.to_m[1] - e.from_m[1]];
            let (a, b) = (along(before), along(edge));
            let curved = before.centre_m.is_some() || edge.centre_m.is_some();
            // The body is on the left: at an inner corner the line turns right.
            let inner =
                !curved && a[0] * b[1] - a[1] * b[0] < -1e-3 * a[0].hypot(a[1]) * b[0].hypot(b[1]);
            let mut size = if inner { AT_CORNER * largest } else { largest };
            if edge.from_m[0] > ring_m - SAME_M {
                size = size.min(ring_size_m);
            } else if let Some(thickness) = web_thickness_m(gear, edge.from_m[0]) {
                size = size.min(thickness / THROUGH_WEB);
            }
            contour.add(edge.from_m, size)
        })
        .collect();
    for (k, edge) in edges.iter().enumerate() {
        let (from, to) = (begins[k], begins[(k + 1) % count]);
        let piece = match edge.centre_m {
            None => vec![from, to],
            Some(centre) => vec![from, contour.add(centre, 0.0), to],
        };
        contour.edges.push(piece);
    }
    contour
}

/// Thickness of the web at a radius between hub and rim.
fn web_thickness_m(gear: &GearDefinition, radius_m: f64) -> Option<f64> {
    let web = gear.blank.web()?;
    if radius_m < web.hub_radius_m - SAME_M || radius_m > web.rim_inner_radius_m + SAME_M {
        return None;
    }
    let Some(contour) = gear.blank.contour() else {
        return Some(web.thickness_m);
    };
    let points = &contour.web;
    let thickness = |k: usize| points[k].z_m[1] - points[k].z_m[0];
    let k = points
        .partition_point(|p| p.radius_m < radius_m)
        .clamp(1, points.len() - 1);
    Some(thickness(k - 1).min(thickness(k)))
}

/// The outline of an opening whose centre has a polar angle.
fn opening_loop(openings: &Openings, centre_rad: f64) -> PlaneLoop {
    let mut outline = PlaneLoop::default();
    match openings {
        Openings::Holes(h) => {
            let (sin, cos) = centre_rad.sin_cos();
            let middle = [h.pitch_radius_m * cos, h.pitch_radius_m * sin];
            let centre = outline.add(middle, 0.0);
            for k in 0..4 {
                let (s, c) = (centre_rad + FRAC_PI_2 * f64::from(k)).sin_cos();
                outline.add(
                    [middle[0] + h.radius_m * c, middle[1] + h.radius_m * s],
                    0.0,
                );
            }
            outline.edges = (0..4)
                .map(|k| vec![1 + k, centre, 1 + (k + 1) % 4])
                .collect();
        }
        Openings::Slots(s) => slot_loop(&mut outline, s, centre_rad),
    }
    outline
}

/// Outer arc, corner, radial edge, corner, inner arc, and back on the other side.
fn slot_loop(outline: &mut PlaneLoop, s: &Slots, centre_rad: f64) {
    let (r_in, r_out, c, half) = (
        s.inner_radius_m,
        s.outer_radius_m,
        s.corner_radius_m,
        0.5 * s.width_rad,
    );
    // Polar angles of the corners' centres, as far inside the radial edge as the corner's radius.
    let outer = half - (c / (r_out - c)).asin();
    let inner = half - (c / (r_in + c)).asin();
    let edge_radius = |centre: f64| (centre * centre - c * c).sqrt();
    let axis = outline.add([0.0, 0.0], 0.0);
    let mut at = |r: f64, phi: f64| {
        let (sin, cos) = (centre_rad + phi).sin_cos();
        outline.add([r * cos, r * sin], 0.0)
    };
    // The middles of both arcs are points too, so that no arc reaches half a turn.
    let corner = |at: &mut dyn FnMut(f64, f64) -> usize, sign: f64| {
        [
            at(r_out, sign * outer),
            at(r_out - c, sign * outer),
            at(edge_radius(r_out - c), sign * half),
            at(edge_radius(r_in + c), sign * half),
            at(r_in + c, sign * inner),
            at(r_in, sign * inner),
        ]
    };
    let top = at(r_out, 0.0);
    let bottom = at(r_in, 0.0);
    let left = corner(&mut at, 1.0);
    let right = corner(&mut at, -1.0);
    outline.edges = vec![
        vec![top, axis, left[0]],
        vec![left[0], left[1], left[2]],
        vec![left[2], left[3]],
        vec![left[3], left[4], left[5]],
        vec![left[5], axis, bottom],
        vec![bottom, axis, right[5]],
        vec![right[5], right[4], right[3]],
        vec![right[3], right[2]],
        vec![right[2], right[1], right[0]],
        vec![right[0], axis, top],
    ];
}
