//! The axial contour of the body as a closed line of straight pieces and arcs: fillets put into the corners of hub, web
//! and rim.
//!
//! A fillet of radius ρ in a corner whose two sides make the angle φ is the arc tangent to both; it begins the length
//! t = ρ/tan(φ/2) away from the corner, and its centre lies ρ/sin(φ/2) away on the bisector. It fits where the lengths
//! t taken from both ends of every side do not pass the side's own length.

use crate::blank::{Blank, Contour, Web};
use std::f64::consts::PI;

/// Lengths below are none \[m\].
const SAME_M: f64 = 1e-9;
/// Sides that turn by less are one straight line \[rad\].
const STRAIGHT_RAD: f64 = 1e-6;

/// A piece of the contour, the body on its left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutlineEdge {
    /// \[r, z\] of its beginning \[m\].
    pub from_m: [f64; 2],
    /// \[r, z\] of its end \[m\].
    pub to_m: [f64; 2],
    /// \[r, z\] of the centre of an arc of less than half a turn \[m\]; none for a straight piece.
    pub centre_m: Option<[f64; 2]>,
}

impl OutlineEdge {
    /// Radius \[m\] of an arc.
    pub fn radius_m(&self) -> Option<f64> {
        let [r, z] = self.from_m;
        self.centre_m.map(|c| (c[0] - r).hypot(c[1] - z))
    }
}

/// A fillet that finds no room.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum FilletError {
    /// A side is too short for it.
    #[error(
        "found {:.4}, which does not fit the corner at diameter {:.3} mm, z {:.3} mm: its sides leave room for at most {:.4}{}",
        radius_m * 1e3, 2e3 * corner_m[0], 1e3 * corner_m[1], largest_m * 1e3,
        if *beside { " beside the fillets of the neighbouring corners" } else { "" }
    )]
    NoRoom {
        /// Point of the web that names it.
        web_point: usize,
        /// Its radius \[m\].
        radius_m: f64,
        /// \[r, z\] of the corner \[m\].
        corner_m: [f64; 2],
        /// What fits \[m\].
        largest_m: f64,
        /// Whether fillets of neighbouring corners take a part of the room.
        beside: bool,
    },
    /// There is no corner.
    #[error(
        "found {:.4}, but the contour has no corner there, neither at the back nor at the front; remove it",
        radius_m * 1e3
    )]
    NoCorner {
        /// Point of the web that names it.
        web_point: usize,
        /// Its radius \[m\].
        radius_m: f64,
    },
}

impl FilletError {
    /// How much of what was asked for fits.
    fn share(&self) -> f64 {
        match *self {
            Self::NoRoom {
                radius_m,
                largest_m,
                ..
            } => largest_m / radius_m,
            Self::NoCorner { .. } => 0.0,
        }
    }

    /// Number of the point of the web whose fillet it is.
    pub const fn web_point(&self) -> usize {
        match *self {
            Self::NoRoom { web_point, .. } | Self::NoCorner { web_point, .. } => web_point,
        }
    }
}

/// A corner of the contour before fillets.
#[derive(Debug, Clone, Copy)]
struct Corner {
    at_m: [f64; 2],
    /// Point of the web that it belongs to, and its fillet.
    fillet: Option<(usize, f64)>,
}

/// Contour \[r, z\] of the body between the bore and a cylinder of radius `outer_m` inside the rim, counter-clockwise
/// from the back of that cylinder.
///
/// # Errors
/// [`FilletError`] with what fits.
pub fn body_outline(
    blank: &Blank,
    face_width_m: f64,
    outer_m: f64,
) -> Result<Vec<OutlineEdge>, FilletError> {
    let half = 0.5 * face_width_m;
    let front = side_corners(blank, half, 1, outer_m);
    let back = side_corners(blank, half, 0, outer_m);
    let corners: Vec<Corner> = (back.iter().take(1).chain(&front).copied())
        .chain(back[1..].iter().rev().copied())
        .collect();
    rounded(&merged(corners))
}

/// Corners of the back (0) or front (1) from the outer cylinder inwards.
fn side_corners(blank: &Blank, half_m: f64, side: usize, outer_m: f64) -> Vec<Corner> {
    let face = [-half_m, half_m][side];
    let sharp = |r: f64, z: f64| Corner {
        at_m: [r, z],
        fillet: None,
    };
    let bore = blank.bore_radius_m();
    let mut corners = vec![sharp(outer_m, face)];
    match (blank.contour(), blank.web()) {
        (Some(contour), _) => {
            let points = contour.web.iter().enumerate().rev();
            if let Some(rim) = contour.web.last() {
                corners.push(sharp(rim.radius_m, face));
            }
            corners.extend(points.map(|(k, point)| Corner {
                at_m: [point.radius_m, point.z_m[side]],
                fillet: (point.fillet_radius_m > 0.0).then_some((k, point.fillet_radius_m)),
            }));
            if let Some(hub) = contour.web.first() {
                corners.push(sharp(hub.radius_m, contour.hub_z_m[side]));
            }
            corners.push(sharp(bore, contour.hub_z_m[side]));
        }
        (None, Some(web)) => {
            let z = web_face_m(&web, side);
            corners.extend([
                sharp(web.rim_inner_radius_m, face),
                sharp(web.rim_inner_radius_m, z),
                sharp(web.hub_radius_m, z),
                sharp(web.hub_radius_m, face),
                sharp(bore, face),
            ]);
        }
        (None, None) => corners.push(sharp(bore, face)),
    }
    corners
}

fn web_face_m(web: &Web, side: usize) -> f64 {
    web.offset_m + [-0.5, 0.5][side] * web.thickness_m
}

/// Corners at one place become one; that with the fillet is kept.
fn merged(corners: Vec<Corner>) -> Vec<Corner> {
    let mut kept: Vec<Corner> = Vec::with_capacity(corners.len());
    for corner in corners {
        match kept.last_mut() {
            Some(last) if distance(last.at_m, corner.at_m) < SAME_M => {
                last.fillet = last.fillet.or(corner.fillet);
            }
            _ => kept.push(corner),
        }
    }
    kept
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// The unit vector from a point to another.
fn towards(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    let length = distance(a, b);
    [(b[0] - a[0]) / length, (b[1] - a[1]) / length]
}

/// What is wrong with the fillet of the k-th corner, whose sides make an angle.
fn no_room(corners: &[Corner], taken: &[f64], k: usize, opening_rad: f64) -> Option<FilletError> {
    let n = corners.len();
    let (web_point, radius_m) = corners[k].fillet?;
    let somewhere = corners
        .iter()
        .zip(taken)
        .any(|(c, t)| *t > 0.0 && c.fillet.is_some_and(|(other, _)| other == web_point));
    if !somewhere {
        return Some(FilletError::NoCorner {
            web_point,
            radius_m,
        });
    }
    let beside = [(k + n - 1) % n, (k + 1) % n];
    let left = beside.map(|j| distance(corners[k].at_m, corners[j].at_m) - taken[j]);
    let room = left[0].min(left[1]);
    (taken[k] > room + SAME_M).then(|| FilletError::NoRoom {
        web_point,
        radius_m,
        corner_m: corners[k].at_m,
        largest_m: room.max(0.0) * (0.5 * opening_rad).tan(),
        beside: beside.iter().any(|&j| taken[j] > 0.0),
    })
}

/// The closed line through the corners with their fillets.
fn rounded(corners: &[Corner]) -> Result<Vec<OutlineEdge>, FilletError> {
    let n = corners.len();
    let at = |k: usize| corners[k % n].at_m;
    // Angle between the sides of a corner, π where they are one line.
    let opening = |k: usize| {
        let (a, b) = (towards(at(k), at(k + n - 1)), towards(at(k), at(k + 1)));
        (a[0] * b[0] + a[1] * b[1]).clamp(-1.0, 1.0).acos()
    };
    // Length that the fillet takes from each side.
    let taken: Vec<f64> = (0..n)
        .map(|k| match corners[k].fillet {
            Some((_, radius)) if opening(k) < PI - STRAIGHT_RAD => {
                radius / (0.5 * opening(k)).tan()
            }
            _ => 0.0,
        })
        .collect();
    let worst = (0..n)
        .filter_map(|k| no_room(corners, &taken, k, opening(k)))
        .min_by(|a, b| a.share().total_cmp(&b.share()));
    if let Some(error) = worst {
        return Err(error);
    }
    let along = |k: usize, to: usize| {
        let d = towards(at(k), at(to));
        [0, 1].map(|axis| at(k)[axis] + taken[k % n] * d[axis])
    };
    let mut edges = Vec::with_capacity(2 * n);
    for k in 0..n {
        let (begin, end) = (along(k, k + n - 1), along(k, k + 1));
        if taken[k] > 0.0
            && let Some((_, radius)) = corners[k].fillet
        {
            let (a, b) = (towards(at(k), at(k + n - 1)), towards(at(k), at(k + 1)));
            let bisector = [a[0] + b[0], a[1] + b[1]];
            let scale = radius / ((0.5 * opening(k)).sin() * bisector[0].hypot(bisector[1]));
            edges.push(OutlineEdge {
                from_m: begin,
                to_m: end,
                centre_m: Some([0, 1].map(|axis| at(k)[axis] + scale * bisector[axis])),
            });
        }
        let next = along(k + 1, k);
        if distance(end, next) > SAME_M {
            edges.push(OutlineEdge {
                from_m: end,
                to_m: next,
                centre_m: None,
            });
        }
    }
    Ok(edges)
}

/// Slope |dz/dr| of the web's faces above which moved layers of hexahedra are sheared too far: 60 degrees, a scaled
/// Jacobian of one half.
const STEEP: f64 = 1.732;

/// Why a contour is beyond moved layers of hexahedra; none where they follow it.
pub fn beyond_layers(
    contour: &Contour,
    openings_m: Option<(f64, f64)>,
    face_width_m: f64,
) -> Option<&'static str> {
    let (hub, rim) = (contour.web.first()?, contour.web.last()?);
    if contour.web.iter().any(|p| p.fillet_radius_m > 0.0) {
        return Some("the contour has fillets");
    }
    let pairs = || contour.web.windows(2);
    if pairs().any(|p| p[1].radius_m - p[0].radius_m < SAME_M) {
        return Some("the web has a step");
    }
    let steep = |side: usize| {
        pairs().any(|p| {
            (p[1].z_m[side] - p[0].z_m[side]).abs() > STEEP * (p[1].radius_m - p[0].radius_m)
        })
    };
    if steep(0) || steep(1) {
        return Some("a face of the web is steeper than 60 degrees");
    }
    // Layers beside the web run through rim and hub alike.
    for (side, sign) in [-1.0, 1.0].into_iter().enumerate() {
        let at_rim = 0.5 * face_width_m - sign * rim.z_m[side];
        let at_hub = sign * (contour.hub_z_m[side] - hub.z_m[side]);
        if (at_rim > SAME_M) != (at_hub > SAME_M) {
            return Some("the web is flush with only one of rim and hub");
        }
    }
    let (inner, outer) = openings_m?;
    contour
        .web
        .iter()
        .any(|p| p.radius_m >= inner && p.radius_m <= outer)
        .then_some("a point of the contour lies among the openings")
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::blank::ContourPoint;

    fn blank(fillets: [f64; 3]) -> Blank {
        let point = |radius_m, z_m, fillet_radius_m| ContourPoint {
            radius_m,
            z_m,
            fillet_radius_m,
        };
        Blank::Webbed {
            bore_radius_m: 0.010,
            web: Web {
                hub_radius_m: 0.016,
                rim_inner_radius_m: 0.030,
                thickness_m: 0.006,
                offset_m: 0.001,
            },
            contour: Some(Contour {
                hub_z_m: [-0.014, 0.012],
                web: vec![
                    point(0.016, [-0.005, 0.004], fillets[0]),
                    point(0.022, [-0.0045, 0.003], fillets[1]),
                    point(0.030, [-0.002, 0.004], fillets[2]),
                ],
            }),
            openings: None,
        }
    }

    /// Area and static moment of the enclosed region about the axis, by Green's theorem: ∮ r dz and ∮ ½ r² dz.
    fn area(edges: &[OutlineEdge]) -> f64 {
        let mut sum = 0.0;
        for edge in edges {
            let n = if edge.centre_m.is_some() { 2000 } else { 1 };
            let at = |k: i32| {
                let w = f64::from(k) / f64::from(n);
                match edge.centre_m {
                    None => [0, 1].map(|i| edge.from_m[i] + w * (edge.to_m[i] - edge.from_m[i])),
                    Some(c) => {
                        let angle = |p: [f64; 2]| (p[1] - c[1]).atan2(p[0] - c[0]);
                        let from = angle(edge.from_m);
                        let turn = angle(edge.to_m) - from;
                        let turn = turn - 2.0 * PI * (turn / (2.0 * PI)).round();
                        let radius = edge.radius_m().unwrap();
                        let (sin, cos) = (from + w * turn).sin_cos();
                        [c[0] + radius * cos, c[1] + radius * sin]
                    }
                }
            };
            for k in 0..n {
                let (p, q) = (at(k), at(k + 1));
                sum += 0.5 * (p[0] * q[1] - p[1] * q[0]);
            }
        }
        sum
    }

    /// Each arc touches both of its neighbours, and adds to a corner of angle φ (removes from one that juts out)
    /// ρ² (1/tan(φ/2) − (π − φ)/2).
    #[test]
    fn arcs_are_tangent_and_fill_their_corners() {
        let edges = body_outline(&blank([0.002, 0.003, 0.0015]), 0.024, 0.034).unwrap();
        assert_eq!(edges.iter().filter(|e| e.centre_m.is_some()).count(), 6);
        let direction = |e: &OutlineEdge, at: [f64; 2]| match e.centre_m {
            None => towards(e.from_m, e.to_m),
            Some(c) => {
                let d = towards(c, at);
                [-d[1], d[0]]
            }
        };
        for (k, edge) in edges.iter().enumerate() {
            let next = &edges[(k + 1) % edges.len()];
            assert!(distance(edge.to_m, next.from_m) < 1e-15);
            if edge.centre_m.is_some() || next.centre_m.is_some() {
                let (a, b) = (direction(edge, edge.to_m), direction(next, edge.to_m));
                assert!((a[0] * b[1] - a[1] * b[0]).abs() < 1e-9, "{edge:?}");
            }
        }
        let sharp = body_outline(&blank([0.0; 3]), 0.024, 0.034).unwrap();
        let corners = [
            // Back and front at the hub, at the kink, at the rim: the neighbours of each corner.
            (
                [0.016, -0.005],
                [0.016, -0.014],
                [0.022, -0.0045],
                0.002,
                1.0,
            ),
            ([0.016, 0.004], [0.016, 0.012], [0.022, 0.003], 0.002, 1.0),
            (
                [0.022, -0.0045],
                [0.016, -0.005],
                [0.030, -0.002],
                0.003,
                -1.0,
            ),
            ([0.022, 0.003], [0.016, 0.004], [0.030, 0.004], 0.003, 1.0),
            (
                [0.030, -0.002],
                [0.022, -0.0045],
                [0.030, -0.012],
                0.0015,
                1.0,
            ),
            ([0.030, 0.004], [0.022, 0.003], [0.030, 0.012], 0.0015, 1.0),
        ];
        let filled: f64 = corners
            .iter()
            .map(|&(c, a, b, radius, sign)| {
                let (a, b) = (towards(c, a), towards(c, b));
                let phi = (a[0] * b[0] + a[1] * b[1]).acos();
                sign * radius * radius * (1.0 / (0.5 * phi).tan() - 0.5 * (PI - phi))
            })
            .sum();
        let found = area(&edges) - area(&sharp);
        assert!((found / filled - 1.0).abs() < 1e-5, "{found} {filled}");
    }

    /// A radius grows until its arc meets the next one: that much fits, and no more.
    #[test]
    fn what_fits_is_what_is_said_to_fit() {
        let error = body_outline(&blank([0.002, 0.0, 0.02]), 0.024, 0.034).unwrap_err();
        let FilletError::NoRoom {
            web_point,
            largest_m,
            beside,
            ..
        } = error
        else {
            unreachable!("{error}");
        };
        assert_eq!((web_point, beside), (2, false));
        assert!(body_outline(&blank([0.002, 0.0, largest_m]), 0.024, 0.034).is_ok());
        assert!(body_outline(&blank([0.002, 0.0, 1.001 * largest_m]), 0.024, 0.034).is_err());
        let error = body_outline(&blank([0.002, 0.1, 0.001]), 0.024, 0.034).unwrap_err();
        assert!(error.to_string().contains("beside the fillets"), "{error}");
    }

    #[test]
    fn a_fillet_without_a_corner_is_refused() {
        let mut straight = blank([0.0, 0.001, 0.0]);
        if let Blank::Webbed {
            contour: Some(contour),
            ..
        } = &mut straight
        {
            contour.web[1].radius_m = 0.023;
            contour.web[1].z_m = [-0.0035, 0.004];
        }
        let error = body_outline(&straight, 0.024, 0.034).unwrap_err();
        assert!(matches!(error, FilletError::NoCorner { web_point: 1, .. }));
    }
}
