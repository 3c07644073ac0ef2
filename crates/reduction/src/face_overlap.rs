//! Integration points on the part of a face that lies in a rectangle of the unrolled tooth outline.
//!
//! Faces stand there as polygons between their corners, cut at the rectangle's edges. Neighbouring polygons share their
//! edges, so that nothing is left out or counted twice. A polygon of four corners is the bilinear image of the unit
//! square,
//!
//! ```text
//! x(u, v) = (1−u)(1−v) p₀ + u (1−v) p₁ + u v p₂ + (1−u) v p₃
//! ```
//! on which Gauss's four points in each direction are exact to degree 6; any other one is fanned from its centre into
//! triangles, squares of which one side has collapsed. No corner is preferred: a mirror image has the mirrored points.

use gearmesh_mesh::OutlineFace;

/// Abscissae on \[0, 1\] and weights of Gauss's rule with four points.
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_9, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];
/// Pieces smaller than this share of the rectangle come from rounding alone.
const SLIVER: f64 = 1e-12;

/// A point of a face with the area that it stands for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FacePoint {
    /// Natural coordinates on the face.
    pub natural: [f64; 2],
    /// Place on the unrolled outline \[arc, z\] \[m\].
    pub place_m: [f64; 2],
    /// Area on the unrolled outline \[m²\].
    pub area_m2: f64,
}

/// Integration points on what `face` has in common with the rectangle `arc_m` × `z_m`.
pub fn overlap_points(face: &OutlineFace, arc_m: [f64; 2], z_m: [f64; 2]) -> Vec<FacePoint> {
    let mut polygon = face.corners_m().to_vec();
    for (axis, range) in [arc_m, z_m].into_iter().enumerate() {
        polygon = kept(&polygon, axis, range[0], 1.0);
        polygon = kept(&polygon, axis, range[1], -1.0);
    }
    let smallest = SLIVER * (arc_m[1] - arc_m[0]) * (z_m[1] - z_m[0]);
    let mut points = Vec::new();
    for corners in quadrilaterals(&polygon) {
        for (u, wu) in GAUSS {
            for (v, wv) in GAUSS {
                let [p, q, r, s] = corners;
                let at = |i: usize| {
                    let (low, high) = (p[i] + u * (q[i] - p[i]), s[i] + u * (r[i] - s[i]));
                    let d_u = (1.0 - v) * (q[i] - p[i]) + v * (r[i] - s[i]);
                    (low + v * (high - low), d_u, high - low)
                };
                let ((arc, arc_u, arc_v), (z, z_u, z_v)) = (at(0), at(1));
                let jacobian = (arc_u * z_v - z_u * arc_v).abs();
                if jacobian < smallest {
                    continue;
                }
                points.push(FacePoint {
                    natural: face.natural_at([arc, z]),
                    place_m: [arc, z],
                    area_m2: wu * wv * jacobian,
                });
            }
        }
    }
    points
}

/// A convex polygon as quadrilaterals, some with two corners in one place.
fn quadrilaterals(polygon: &[[f64; 2]]) -> Vec<[[f64; 2]; 4]> {
    match *polygon {
        [] | [_] | [_, _] => Vec::new(),
        [p, q, r, s] => vec![[p, q, r, s]],
        _ => {
            let n = polygon.len();
            let centre: [f64; 2] =
                std::array::from_fn(|i| polygon.iter().map(|p| p[i]).sum::<f64>() / n as f64);
            (0..n)
                .map(|k| [centre, polygon[k], polygon[(k + 1) % n], centre])
                .collect()
        }
    }
}

/// The part of a convex polygon where sign · (x_axis − bound) ≥ 0 (Sutherland and Hodgman).
fn kept(polygon: &[[f64; 2]], axis: usize, bound: f64, sign: f64) -> Vec<[f64; 2]> {
    let mut result = Vec::with_capacity(polygon.len() + 1);
    for (k, &b) in polygon.iter().enumerate() {
        let a = polygon[(k + polygon.len() - 1) % polygon.len()];
        let (from, to) = (sign * (a[axis] - bound), sign * (b[axis] - bound));
        if (from > 0.0 && to < 0.0) || (from < 0.0 && to > 0.0) {
            let share = from / (from - to);
            let mut cut = [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])];
            cut[axis] = bound;
            result.push(cut);
        }
        if to >= 0.0 {
            result.push(b);
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;
    use gearmesh_mesh::FaceShape;

    fn face(shape: FaceShape, corners: &[[f64; 2]]) -> OutlineFace {
        let n = corners.len();
        let mut places_m = corners.to_vec();
        if shape.is_quadratic() {
            places_m.extend((0..n).map(|k| {
                let (a, b) = (corners[k], corners[(k + 1) % n]);
                [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]
            }));
        }
        OutlineFace {
            shape,
            nodes: (0..places_m.len() as u32).collect(),
            element: 0,
            places_m,
        }
    }

    /// A rectangle in pieces of every shape: polynomials of degree six are integrated exactly over a window in it, and
    /// the shape functions of all pieces reproduce the place.
    #[test]
    fn all_shapes_integrate_over_a_window() {
        let (a, b, c, d, m) = ([0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [0.0, 2.0], [1.2, 0.7]);
        let triangles = [[a, b, m], [b, c, m], [c, d, m], [d, a, m]];
        let quads = [
            [a, [1.4, 0.0], m, [0.0, 0.9]],
            [[1.4, 0.0], b, [3.0, 1.2], m],
            [m, [3.0, 1.2], c, [1.9, 2.0]],
            [[0.0, 0.9], m, [1.9, 2.0], d],
        ];
        let (arcs, heights) = ([0.4, 2.7], [0.1, 1.8]);
        let power = |range: [f64; 2], p: i32| {
            (range[1].powi(p + 1) - range[0].powi(p + 1)) / f64::from(p + 1)
        };
        for shape in FaceShape::ALL {
            let faces: Vec<OutlineFace> = match shape.corner_count() {
                3 => triangles.iter().map(|t| face(shape, t)).collect(),
                _ => quads.iter().map(|q| face(shape, q)).collect(),
            };
            for (i, j) in [(0, 0), (2, 1), (5, 1), (3, 3), (0, 6)] {
                let mut sum = 0.0;
                for face in &faces {
                    for point in overlap_points(face, arcs, heights) {
                        let [s, z] = point.place_m;
                        sum += point.area_m2 * s.powi(i) * z.powi(j);
                        let back = face.place_m(point.natural)[0];
                        assert!((back[0] - s).hypot(back[1] - z) < 1e-12);
                    }
                }
                let exact = power(arcs, i) * power(heights, j);
                assert!((sum / exact - 1.0).abs() < 1e-12, "{shape:?} {i} {j}");
            }
        }
    }

    #[test]
    fn a_window_beside_the_face_is_empty() {
        let unit = face(
            FaceShape::Quad4,
            &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
        );
        assert!(overlap_points(&unit, [1.0, 2.0], [0.0, 1.0]).is_empty());
        assert!(overlap_points(&unit, [0.0, 1.0], [1.5, 2.0]).is_empty());
    }
}
