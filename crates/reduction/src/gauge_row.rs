//! A strain gauge as one row of nodal weights: ε = gᵀd.
//!
//! The strain of a surface point is that of the element behind it, rotated to the direction of the profile
//! (*Transmission Error and Strain Analysis of Lightweight Gears*, section 4.4; seed 004 in docs/sources.md).
//!
//! *Linear bricks in layers*: what is accurate is the displacement of their nodes. On each plane between two layers the
//! edges of the faces are a chain along the profile, whose elongations from node to node add up to a curve; the gauge
//! reads the elongation between its ends, and the mean over its width of a curve through the planes. The strain at the
//! centre of a face is the mean of its piece and of two planes, which lies below the peak where gauges are placed.
//!
//! *Other elements*: the mean of their own strain over what the faces have in common with the gauge.

use crate::ReductionError;
use crate::face_overlap::overlap_points;
use crate::flank_loads::SparseVector;
use crate::toothed_mesh::ToothedMesh;
use gearmesh_fe::{ElementFormulas, FeModel};
use gearmesh_geometry::{GaugeDefinition, GearDefinition, ProfileCurve, RootPosition};
use gearmesh_mesh::{FaceShape, OutlineFace};
use gearmesh_model::GaugeRows;
use std::collections::BTreeMap;

/// So much of a piece of the curve a neighbour's piece must be long to have a say in it.
const NEAREST: f64 = 0.25;
/// Places of nodes are one within this share of a face: the last digits of a mesh that is read back.
const SAME_PLACE: f64 = 0.01;

/// A point of a face and its share of the gauge's area.
pub(crate) struct Reading<'a> {
    pub face: &'a OutlineFace,
    pub natural: [f64; 2],
    pub area_m2: f64,
}

/// A gauge by its name and place, without readings.
pub(crate) fn gauge_head(gauge: &GaugeDefinition) -> GaugeRows {
    let place = match gauge.position {
        RootPosition::TangentAngle(a) => format!("{:.2} deg tangent", a.to_degrees()),
        RootPosition::Radius(r) => format!("radius {:.4} mm", r * 1e3),
    };
    GaugeRows {
        name: gauge.name.clone(),
        tooth: gauge.tooth,
        side: gauge.side,
        description: format!(
            "tooth {}, {} root, {place}, {:.3} mm along the profile, {:.3} mm wide at z {:.3} mm",
            gauge.tooth,
            gauge.side,
            gauge.length_m * 1e3,
            gauge.width_m * 1e3,
            gauge.z_m * 1e3
        ),
        ..GaugeRows::default()
    }
}

/// The row of a gauge, placed on `tooth` instead of its own tooth.
///
/// # Errors
/// [`ReductionError::EmptyGauge`] when no face lies under it.
pub fn gauge_row(
    gear: &GearDefinition,
    mesh: &impl ToothedMesh,
    model: &FeModel,
    gauge: &GaugeDefinition,
    tooth: usize,
) -> Result<SparseVector, ReductionError> {
    let empty = || ReductionError::EmptyGauge {
        name: gauge.name.clone(),
    };
    let curve = ProfileCurve::new(&gear.profile);
    let centre = curve.arc_length_at(gauge.position).map_err(|_| empty())?;
    let along = [centre - 0.5 * gauge.length_m, centre + 0.5 * gauge.length_m];
    let across = [
        gauge.z_m - 0.5 * gauge.width_m,
        gauge.z_m + 0.5 * gauge.width_m,
    ];
    let faces = mesh.outline_faces(tooth, gauge.side, [0.0, curve.flank_end_m()]);
    let readings = readings(&faces, along, across);
    let area: f64 = readings.iter().map(|r| r.area_m2).sum();
    if area == 0.0 {
        return Err(empty());
    }
    let mut row: BTreeMap<usize, f64> = BTreeMap::new();
    for reading in readings {
        for (dof, value) in strain_row(model, reading.face, reading.natural)? {
            *row.entry(dof).or_default() += reading.area_m2 / area * value;
        }
    }
    Ok(row.into_iter().collect())
}

/// Points of faces under a gauge, with the area that each stands for.
pub(crate) fn readings(
    faces: &[OutlineFace],
    along: [f64; 2],
    across: [f64; 2],
) -> Vec<Reading<'_>> {
    let pieces: Option<Vec<[Piece<'_>; 2]>> = faces.iter().map(pieces_of).collect();
    match pieces {
        Some(pieces) if !pieces.is_empty() => of_layers(pieces.into_flattened(), along, across),
        _ => everywhere(faces, along, across),
    }
}

/// Integration points all over the gauge.
fn everywhere(faces: &[OutlineFace], along: [f64; 2], across: [f64; 2]) -> Vec<Reading<'_>> {
    faces
        .iter()
        .flat_map(|face| {
            let points = overlap_points(face, along, across).into_iter();
            points.map(move |point| Reading {
                face,
                natural: point.natural,
                area_m2: point.area_m2,
            })
        })
        .collect()
}

/// An edge of a face along the profile: a piece of a chain on a plane between two layers.
struct Piece<'a> {
    face: &'a OutlineFace,
    /// Its middle on the face.
    natural: [f64; 2],
    /// Its ends along the profile, and its place across it \[m\].
    arcs_m: [f64; 2],
    z_m: f64,
    /// Tolerance of places, a share of the face's size along the profile and across it \[m\].
    same_m: [f64; 2],
}

/// The two edges of a linear quadrilateral that run along the profile, on one plane each; none of another face.
fn pieces_of(face: &OutlineFace) -> Option<[Piece<'_>; 2]> {
    if face.shape != FaceShape::Quad4 {
        return None;
    }
    let [length_m, height_m] = [0, 1].map(|axis| {
        let [low, high] = face.range_m(axis);
        high - low
    });
    let edge = |k: usize| {
        let [a, b] = [k, (k + 1) % 4].map(|corner| face.places_m[corner]);
        ((b[1] - a[1]).abs() <= SAME_PLACE * height_m).then(|| Piece {
            face,
            natural: FaceShape::quad_edge_middle(k),
            arcs_m: [a[0].min(b[0]), a[0].max(b[0])],
            z_m: 0.5 * (a[1] + b[1]),
            same_m: [SAME_PLACE * length_m, SAME_PLACE * height_m],
        })
    };
    let opposite = |k: usize| Some([edge(k)?, edge(k + 2)?]);
    opposite(0).or_else(|| opposite(1))
}

/// Middles of edges: plane by plane the elongation of the chain under the gauge, and the integral of the curve through
/// the planes. Faces on both sides of an edge have half of its share each.
fn of_layers(mut pieces: Vec<Piece<'_>>, along: [f64; 2], across: [f64; 2]) -> Vec<Reading<'_>> {
    let same = |axis: usize, [p, q]: [&Piece<'_>; 2]| {
        let [a, b] = [p, q].map(|piece| [piece.arcs_m[0], piece.z_m][axis]);
        (a - b).abs() <= p.same_m[axis].min(q.same_m[axis])
    };
    pieces.sort_by(|a, b| a.z_m.total_cmp(&b.z_m));
    let planes: Vec<&mut [Piece<'_>]> = pieces.chunk_by_mut(|p, q| same(1, [p, q])).collect();
    let places: Vec<f64> = planes.iter().map(|plane| plane[0].z_m).collect();
    let mut readings = Vec::new();
    for (plane, width) in planes.into_iter().zip(curve_integral(&places, across)) {
        plane.sort_by(|a, b| a.arcs_m[0].total_cmp(&b.arcs_m[0]));
        let chain: Vec<&[Piece<'_>]> = plane.chunk_by(|p, q| same(0, [p, q])).collect();
        let knots = chain.iter().map(|edge| edge[0].arcs_m[0]);
        let end = chain.last().map(|edge| edge[0].arcs_m[1]);
        let knots: Vec<f64> = knots.chain(end).collect();
        for (edge, share) in chain.iter().zip(elongation(&knots, along)) {
            let area_m2 = width * share / edge.len() as f64;
            if area_m2 != 0.0 {
                readings.extend(edge.iter().map(|piece| Reading {
                    face: piece.face,
                    natural: piece.natural,
                    area_m2,
                }));
            }
        }
    }
    readings
}

/// Strain along the profile at a point of a face, as weights of the nodal displacements.
fn strain_row(
    model: &FeModel,
    face: &OutlineFace,
    natural: [f64; 2],
) -> Result<SparseVector, ReductionError> {
    let [_, d_xi, d_eta] = face.place_m(natural);
    let det = d_xi[0] * d_eta[1] - d_xi[1] * d_eta[0];
    // The profile's direction: ∂x/∂(arc length) at constant z.
    let mut t = [0.0; 2];
    for (&node, [_, n_xi, n_eta]) in face.nodes.iter().zip(face.shape.shapes(natural)) {
        let along = (n_xi * d_eta[1] - n_eta * d_xi[1]) / det;
        for (axis, sum) in t.iter_mut().enumerate() {
            *sum += along * model.nodes()[node as usize][axis];
        }
    }
    let length = t[0].hypot(t[1]);
    strain_weights(model, face, natural, [t[0] / length, t[1] / length, 0.0])
}

/// Normal strain along a unit vector t at a point of a face, as weights of the nodal displacements.
pub(crate) fn strain_weights(
    model: &FeModel,
    face: &OutlineFace,
    natural: [f64; 2],
    t: [f64; 3],
) -> Result<SparseVector, ReductionError> {
    let element = model.element_nodes(face.element as usize);
    let in_element = model.element_of(face.element as usize).natural_nodes();
    // The point in the element's natural coordinates.
    let mut inside = [0.0; 3];
    for (&node, [n, _, _]) in face.nodes.iter().zip(face.shape.shapes(natural)) {
        if let Some(k) = element.iter().position(|&other| other == node) {
            for (sum, coordinate) in inside.iter_mut().zip(in_element[k]) {
                *sum += n * coordinate;
            }
        }
    }
    // Order xx, yy, zz, xy, yz, xz with engineering shear.
    let rotation = [
        t[0] * t[0],
        t[1] * t[1],
        t[2] * t[2],
        t[0] * t[1],
        t[1] * t[2],
        t[0] * t[2],
    ];
    let operator = model.strain_operator(face.element as usize, inside)?;
    let weight = |column: usize| (0..6).map(|i| rotation[i] * operator[i][column]).sum();
    Ok(element
        .iter()
        .enumerate()
        .flat_map(|(k, &node)| (0..3).map(move |axis| (3 * node as usize + axis, 3 * k + axis)))
        .map(|(dof, column)| (dof, weight(column)))
        .collect())
}

/// The cubic through the two points around a place and their neighbours, as weights of the points. A neighbour nearer
/// than [`NEAREST`] of the piece is left out, so that small differences do not grow.
fn cubic(x: &[f64], s: f64) -> impl Iterator<Item = (usize, f64)> {
    let last = x.len() - 1;
    let i = x.partition_point(|&knot| knot <= s).clamp(1, last) - 1;
    let far = |a: usize, b: usize| (x[a] - x[b]).abs() >= NEAREST * (x[i + 1] - x[i]);
    let first = if i > 0 && far(i, i - 1) { i - 1 } else { i };
    let end = if i + 1 < last && far(i + 1, i + 2) {
        i + 2
    } else {
        i + 1
    };
    (first..=end).map(move |j| {
        let others = (first..=end).filter(|&k| k != j);
        (j, others.map(|k| (s - x[k]) / (x[j] - x[k])).product())
    })
}

/// Weights w with ∫ f ds = Σ w_i f(x_i) over `range` for the curve of cubics through the points x, constant beyond
/// the first and last of them.
fn curve_integral(x: &[f64], range: [f64; 2]) -> Vec<f64> {
    let mut weights = vec![0.0; x.len()];
    let last = x.len() - 1;
    weights[0] += (range[1].min(x[0]) - range[0]).max(0.0);
    weights[last] += (range[1] - range[0].max(x[last])).max(0.0);
    for piece in x.windows(2) {
        let (from, to) = (range[0].max(piece[0]), range[1].min(piece[1]));
        if to <= from {
            continue;
        }
        // Two Gauss points integrate a cubic exactly.
        for sign in [-1.0, 1.0] {
            let s = 0.5 * (from + to) + sign * 0.5 * (to - from) / f64::sqrt(3.0);
            for (j, share) in cubic(x, s) {
                weights[j] += 0.5 * (to - from) * share;
            }
        }
    }
    weights
}

/// Weights w with ∫ ε ds = Σ w_i ε_i over `range`, from the mean strains ε_i of the pieces between the points x. The
/// elongation up to a point is Σ h_i ε_i; between points it is the curve of cubics through these. The strain is
/// constant beyond the first and last of them.
fn elongation(x: &[f64], range: [f64; 2]) -> Vec<f64> {
    let last = x.len() - 1;
    let mut weights = vec![0.0; last];
    weights[0] += (range[1].min(x[0]) - range[0]).max(0.0);
    weights[last - 1] += (range[1] - range[0].max(x[last])).max(0.0);
    for (sign, end) in [(-1.0, range[0]), (1.0, range[1])] {
        for (j, share) in cubic(x, end.clamp(x[0], x[last])) {
            for i in 0..j {
                weights[i] += sign * share * (x[i + 1] - x[i]);
            }
        }
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::{curve_integral, elongation, readings};
    use gearmesh_mesh::{FaceShape, OutlineFace};

    /// Faces along the profile in two layers, their nodes moved by a share of a face.
    fn faces(moved: f64) -> Vec<OutlineFace> {
        let arcs = [0.0, 1.0, 2.5, 3.5, 5.0];
        let place = |k: usize, l: usize| {
            let noise = moved * ((7 * k + 3 * l) as f64).sin();
            [arcs[k] + noise, 2.0 * l as f64 + noise]
        };
        let grid = (0..4).flat_map(|k| (0..2).map(move |l| (k, l)));
        grid.map(|(k, l)| OutlineFace {
            shape: FaceShape::Quad4,
            nodes: vec![0; 4],
            element: 0,
            places_m: vec![
                place(k, l),
                place(k + 1, l),
                place(k + 1, l + 1),
                place(k, l + 1),
            ],
        })
        .collect()
    }

    /// Faces in layers are read at the middles of their edges, also where the last digits of a mesh that is read back
    /// move nodes; faces that lie otherwise all over. Each reading stands for its share of the gauge.
    #[test]
    fn faces_in_layers_are_read_on_their_edges() {
        let ([along, across], area) = ([[1.2, 2.8], [0.5, 3.0]], 1.6 * 2.5);
        for (moved, on_edges) in [(0.0, true), (1e-3, true), (0.1, false)] {
            let faces = faces(moved);
            let found = readings(&faces, along, across);
            let sum: f64 = found.iter().map(|reading| reading.area_m2).sum();
            assert!((sum / area - 1.0).abs() < 1e-12, "{moved}: {sum}");
            let edges = found
                .iter()
                .filter(|reading| reading.natural.contains(&0.0));
            assert_eq!(edges.count() == found.len(), on_edges, "{moved}");
            if on_edges {
                // Four pieces in each layer, whose edges lie on two planes.
                assert_eq!(found.len(), 4 * 2 * 2, "{moved}");
            }
        }
    }

    /// ∫ f ds over a range, from values at the points.
    fn integral(x: &[f64], range: [f64; 2], f: impl Fn(f64) -> f64) -> f64 {
        let weights = curve_integral(x, range).into_iter();
        weights.zip(x).map(|(w, s)| w * f(*s)).sum()
    }

    /// With two neighbours a cubic, with one a parabola, beyond the ends a constant.
    #[test]
    fn polynomials_are_integrated_exactly() {
        let x = [0.0, 1.0, 2.5, 3.0, 5.0, 6.0];
        let cubic = |s: f64| 2.0 - 0.7 * s + 0.3 * s * s - 0.05 * s.powi(3);
        let stem = |s: f64| 2.0 * s - 0.35 * s * s + 0.1 * s.powi(3) - 0.0125 * s.powi(4);
        for range in [[1.2, 1.7], [1.0, 2.7], [2.6, 5.0]] {
            let exact = stem(range[1]) - stem(range[0]);
            let found = integral(&x, range, cubic);
            assert!((found - exact).abs() < 1e-13, "{range:?}: {found} {exact}");
        }
        let found = integral(&x, [0.2, 0.9], |s| s * s);
        assert!((found - (0.9f64.powi(3) - 0.2f64.powi(3)) / 3.0).abs() < 1e-14);
        assert!((integral(&x, [-2.0, 0.0], cubic) - 4.0).abs() < 1e-14);
        assert_eq!(curve_integral(&[1.0], [0.5, 3.0]), [2.5]);
    }

    /// Of neighbours that nearly coincide only one has a say: a small difference of the others does not grow.
    #[test]
    fn near_neighbours_are_left_out() {
        let weights = curve_integral(&[-0.1, 0.0, 5.0, 5.1], [0.0, 5.0]);
        assert_eq!(weights, [0.0, 2.5, 2.5, 0.0]);
    }

    /// From exact means of pieces the elongation of a strain that is a parabola, and from few pieces what they allow.
    #[test]
    fn elongations_of_parabolas_are_exact() {
        let x = [0.0, 1.0, 2.5, 3.0, 5.0, 6.0];
        let stem = |s: f64| 2.0 * s - 0.35 * s * s + 0.1 * s.powi(3);
        let mean = |p: &[f64]| (stem(p[1]) - stem(p[0])) / (p[1] - p[0]);
        for range in [[1.2, 1.7], [1.0, 2.7], [2.6, 5.0], [1.0, 5.0]] {
            let weights = elongation(&x, range).into_iter();
            let found: f64 = weights.zip(x.windows(2)).map(|(w, p)| w * mean(p)).sum();
            let exact = stem(range[1]) - stem(range[0]);
            assert!((found - exact).abs() < 1e-13, "{range:?}: {found} {exact}");
        }
        assert_eq!(elongation(&[0.0, 1.0], [-1.0, 3.0]), [4.0]);
        let sums = elongation(&x, [0.3, 5.7]).iter().sum::<f64>();
        assert!((sums - 5.4).abs() < 1e-13, "{sums}");
    }
}
