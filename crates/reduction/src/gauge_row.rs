//! A strain gauge as one row of nodal weights: ε = gᵀd.
//!
//! The strain of a surface point is that of the element behind it, rotated to the direction of the profile
//! (*Transmission Error and Strain Analysis of Lightweight Gears*, section 4.4; seed 004 in docs/sources.md).
//!
//! *Quadratic elements*: its mean over what the faces have in common with the gauge.
//!
//! *Linear elements*: their strain is accurate at the centres of the faces only. In each layer of elements it is taken
//! there and as linear between the centres; the mean over the gauge's length is that of this broken line, since a gauge
//! that covers a part of a face should not read its centre. Layers are averaged with the width that gauge and layer
//! have in common.

use crate::ReductionError;
use crate::face_overlap::overlap_points;
use crate::flank_loads::SparseVector;
use crate::toothed_mesh::ToothedMesh;
use gearmesh_fe::{ElementFormulas, FeModel};
use gearmesh_geometry::{GaugeDefinition, GearDefinition, ProfileCurve, RootPosition};
use gearmesh_mesh::OutlineFace;
use gearmesh_model::GaugeRows;
use std::collections::BTreeMap;

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
        between_centres(faces, along, across)
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

/// Centres of faces, weighted by the integral of the broken line between them.
fn between_centres(faces: &[OutlineFace], along: [f64; 2], across: [f64; 2]) -> Vec<Reading<'_>> {
    let overlap = |a: [f64; 2], b: [f64; 2]| (a[1].min(b[1]) - a[0].max(b[0])).max(0.0);
    let same = |a: [f64; 2], b: [f64; 2]| (0..2).all(|k| (a[k] - b[k]).abs() < SAME_LAYER_M);
    let mut layers: Vec<[f64; 2]> = faces
        .iter()
        .map(|face| face.range_m(1))
        .filter(|&z| overlap(z, across) > 0.0)
        .collect();
    layers.sort_by(|a, b| a[0].total_cmp(&b[0]));
    layers.dedup_by(|a, b| same(*a, *b));
    let mut readings = Vec::new();
    for layer in layers {
        let centre = |face: &OutlineFace| face.place_m(face.shape.centre())[0][0];
        let mut strip: Vec<(f64, &OutlineFace)> = faces
            .iter()
            .filter(|face| same(face.range_m(1), layer))
            .map(|face| (centre(face), face))
            .collect();
        strip.sort_by(|a, b| a.0.total_cmp(&b.0));
        let centres: Vec<f64> = strip.iter().map(|(centre, _)| *centre).collect();
        let shares = broken_line_integral(&centres, along);
        let width = overlap(layer, across);
        let covered = strip.iter().zip(shares).filter(|(_, share)| *share != 0.0);
        readings.extend(covered.map(|((_, face), share)| Reading {
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

/// Weights w with ∫ f ds = Σ w_i f(x_i) over `range` for the broken line f through the points x; constant beyond the
/// first and last of them.
fn broken_line_integral(x: &[f64], range: [f64; 2]) -> Vec<f64> {
    let mut weights = vec![0.0; x.len()];
    let last = x.len() - 1;
    weights[0] += (range[1].min(x[0]) - range[0]).max(0.0);
    weights[last] += (range[1] - range[0].max(x[last])).max(0.0);
    for i in 0..last {
        let (from, to) = (range[0].max(x[i]), range[1].min(x[i + 1]));
        if to > from {
            let share = (0.5 * (from + to) - x[i]) / (x[i + 1] - x[i]);
            weights[i] += (to - from) * (1.0 - share);
            weights[i + 1] += (to - from) * share;
        }
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::broken_line_integral;

    #[test]
    fn the_broken_line_is_integrated_exactly() {
        let x = [0.0, 1.0, 2.5, 3.0, 5.0];
        let f = |s: f64| 2.0 - 0.7 * s;
        for range in [[0.2, 0.7], [0.5, 2.7], [1.0, 5.0], [2.6, 2.8]] {
            let sum: f64 = broken_line_integral(&x, range)
                .iter()
                .zip(x)
                .map(|(w, s)| w * f(s))
                .sum();
            let exact = (range[1] - range[0]) * f(0.5 * (range[0] + range[1]));
            assert!((sum - exact).abs() < 1e-14, "{range:?}");
        }
        // A kink between the points is kept, and the line goes on flat beyond its ends.
        let weights = broken_line_integral(&[0.0, 1.0, 2.0], [-1.0, 1.5]);
        let expected = [1.0 + 0.5, 0.5 + 0.375, 0.125];
        assert!(
            weights
                .iter()
                .zip(expected)
                .all(|(w, e)| (w - e).abs() < 1e-15)
        );
    }
}
