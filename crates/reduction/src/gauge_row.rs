//! A strain gauge as one row of nodal weights: ε = gᵀd.
//!
//! In each layer of elements the strain is taken at the centres of the faces along the profile, from the element behind
//! the face, and rotated to the direction of the face's edge (seed 004, 4.4). Between the centres it is taken as
//! linear, and the mean over the gauge's length is that of this broken line: the strain of a linear element is most
//! accurate at its centre, and a gauge that covers a part of a face should not read its centre. Layers are averaged
//! with the width that gauge and layer have in common.

use crate::ReductionError;
use crate::flank_loads::SparseVector;
use gearmesh_fe::{CORNERS, FeModel};
use gearmesh_geometry::{GaugeDefinition, GearDefinition, ProfileCurve};
use gearmesh_mesh::GearMesh;
use gearmesh_mesh::gear_mesh::OutlineFace;
use std::collections::BTreeMap;

/// The row of a gauge, placed on `tooth` instead of its own tooth.
///
/// # Errors
/// [`ReductionError::EmptyGauge`] when no face lies under it.
pub fn gauge_row(
    gear: &GearDefinition,
    mesh: &GearMesh,
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
    let overlap = |a: [f64; 2], b: [f64; 2]| (a[1].min(b[1]) - a[0].max(b[0])).max(0.0);
    let faces = mesh.outline_faces(tooth, gauge.side, [0.0, curve.flank_end_m()]);
    let mut layers: Vec<[f64; 2]> = faces
        .iter()
        .map(|f| f.z_m)
        .filter(|&z| overlap(z, across) > 0.0)
        .collect();
    layers.sort_by(|a, b| a[0].total_cmp(&b[0]));
    layers.dedup();
    let mut row: BTreeMap<usize, f64> = BTreeMap::new();
    let mut area = 0.0;
    for layer in layers {
        let mut strip: Vec<&OutlineFace> = faces.iter().filter(|f| f.z_m == layer).collect();
        strip.sort_by(|a, b| a.arc_m[0].total_cmp(&b.arc_m[0]));
        let centres: Vec<f64> = strip
            .iter()
            .map(|f| 0.5 * (f.arc_m[0] + f.arc_m[1]))
            .collect();
        let shares = broken_line_integral(&centres, along);
        let width = overlap(layer, across);
        for (face, share) in strip.iter().zip(shares).filter(|(_, share)| *share != 0.0) {
            area += width * share;
            for (dof, value) in face_row(mesh, model, face)? {
                *row.entry(dof).or_default() += width * share * value;
            }
        }
    }
    if area == 0.0 {
        return Err(empty());
    }
    Ok(row
        .into_iter()
        .map(|(dof, value)| (dof, value / area))
        .collect())
}

/// Strain along the profile at the centre of a face, as weights of the nodal displacements.
fn face_row(
    mesh: &GearMesh,
    model: &FeModel,
    face: &OutlineFace,
) -> Result<SparseVector, ReductionError> {
    let hex = mesh.hexes[face.hex as usize];
    let corners: Vec<usize> = (0..8).filter(|&k| face.nodes.contains(&hex[k])).collect();
    let natural: [f64; 3] = std::array::from_fn(|i| {
        corners.iter().map(|&k| CORNERS[k][i]).sum::<f64>() / corners.len() as f64
    });
    // The profile's direction in the middle of the layer: the mean of the edges on both planes, which a helix turns.
    let [a, b, c, d] = face.nodes.map(|n| mesh.nodes[n as usize]);
    let (dx, dy) = (b[0] - a[0] + c[0] - d[0], b[1] - a[1] + c[1] - d[1]);
    let length = dx.hypot(dy);
    let t = [dx / length, dy / length];
    // Normal strain along t; order xx, yy, zz, xy, yz, xz with engineering shear.
    let rotation = [t[0] * t[0], t[1] * t[1], 0.0, t[0] * t[1], 0.0, 0.0];
    let operator = model.strain_operator(face.hex as usize, natural)?;
    let weight = |column: usize| (0..6).map(|i| rotation[i] * operator[i][column]).sum();
    Ok(hex
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
