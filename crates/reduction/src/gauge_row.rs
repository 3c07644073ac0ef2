//! A strain gauge as one row of nodal weights: ε = gᵀd.
//!
//! The strain of a surface point is that of the element behind it, rotated to the direction of the profile
//! (*Transmission Error and Strain Analysis of Lightweight Gears*, section 4.4; seed 004 in docs/sources.md).
//!
//! *Quadratic elements*: its mean over what the faces have in common with the gauge.
//!
//! *Linear elements*: their strain is accurate at the centres of the faces only. It is taken there, and a curve goes
//! through the centres of each layer of elements, along the profile, and through the layers, across it. The gauge reads
//! the mean of these curves: one that covers a part of a face should not read its centre, and at the peak of the
//! strain, where gauges are placed, straight lines between the centres lie below it.

use crate::ReductionError;
use crate::face_overlap::overlap_points;
use crate::flank_loads::SparseVector;
use crate::toothed_mesh::ToothedMesh;
use gearmesh_fe::{ElementFormulas, FeModel};
use gearmesh_geometry::{GaugeDefinition, GearDefinition, ProfileCurve, RootPosition};
use gearmesh_mesh::OutlineFace;
use gearmesh_model::GaugeRows;
use std::collections::BTreeMap;

/// So much of a piece of the curve a neighbour's piece must be long to have a say in it.
const NEAREST: f64 = 0.25;
/// Layers whose edges differ by less are one \[m\].
const SAME_LAYER_M: f64 = 1e-9;

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
    if faces.iter().any(|face| face.shape.is_quadratic()) {
        everywhere(faces, along, across)
    } else {
        at_centres(faces, along, across)
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

/// Centres of faces, weighted by the integral of the curve through them along the profile and across it.
fn at_centres(faces: &[OutlineFace], along: [f64; 2], across: [f64; 2]) -> Vec<Reading<'_>> {
    let same = |a: [f64; 2], b: [f64; 2]| (0..2).all(|k| (a[k] - b[k]).abs() < SAME_LAYER_M);
    let centre = |face: &OutlineFace| face.place_m(face.shape.centre())[0];
    let mut layers: Vec<[f64; 2]> = faces.iter().map(|face| face.range_m(1)).collect();
    layers.sort_by(|a, b| a[0].total_cmp(&b[0]));
    layers.dedup_by(|a, b| same(*a, *b));
    let middles: Vec<f64> = layers.iter().map(|z| 0.5 * (z[0] + z[1])).collect();
    let mut readings = Vec::new();
    for (layer, width) in layers.into_iter().zip(curve_integral(&middles, across)) {
        if width == 0.0 {
            continue;
        }
        let mut strip: Vec<&OutlineFace> = { faces.iter() }
            .filter(|face| same(face.range_m(1), layer))
            .collect();
        strip.sort_by(|a, b| centre(a)[0].total_cmp(&centre(b)[0]));
        let centres: Vec<f64> = strip.iter().map(|face| centre(face)[0]).collect();
        let shares = curve_integral(&centres, along);
        let covered = strip
            .into_iter()
            .zip(shares)
            .filter(|(_, share)| *share != 0.0);
        readings.extend(covered.map(|(face, share)| Reading {
            face,
            natural: face.shape.centre(),
            area_m2: width * share,
        }));
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

/// Weights w with ∫ f ds = Σ w_i f(x_i) over `range` for the curve f through the points x: between two of them the
/// cubic through these and their neighbours, constant beyond the first and last of them. A neighbour nearer than
/// [`NEAREST`] of the piece is left out, so that small differences do not grow.
fn curve_integral(x: &[f64], range: [f64; 2]) -> Vec<f64> {
    let mut weights = vec![0.0; x.len()];
    let last = x.len() - 1;
    weights[0] += (range[1].min(x[0]) - range[0]).max(0.0);
    weights[last] += (range[1] - range[0].max(x[last])).max(0.0);
    for i in 0..last {
        let (from, to) = (range[0].max(x[i]), range[1].min(x[i + 1]));
        if to <= from {
            continue;
        }
        let far = |a: usize, b: usize| (x[a] - x[b]).abs() >= NEAREST * (x[i + 1] - x[i]);
        let first = if i > 0 && far(i, i - 1) { i - 1 } else { i };
        let end = if i + 1 < last && far(i + 1, i + 2) {
            i + 2
        } else {
            i + 1
        };
        // Two Gauss points integrate a cubic exactly.
        for sign in [-1.0, 1.0] {
            let s = 0.5 * (from + to) + sign * 0.5 * (to - from) / f64::sqrt(3.0);
            for j in first..=end {
                let others = (first..=end).filter(|&k| k != j);
                let share: f64 = others.map(|k| (s - x[k]) / (x[j] - x[k])).product();
                weights[j] += 0.5 * (to - from) * share;
            }
        }
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::curve_integral;

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
}
