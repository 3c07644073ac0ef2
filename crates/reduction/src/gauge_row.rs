//! A strain gauge as one row of nodal weights: ε = gᵀd.
//!
//! For each element face under the gauge the strain of the element behind it is taken at the face's centre, rotated to
//! the direction of the face's edge along the profile (seed 004, 4.4), and averaged with the area that gauge and face
//! have in common as weight.

use crate::ReductionError;
use crate::flank_loads::SparseVector;
use gearmesh_fe::{FeModel, CORNERS};
use gearmesh_geometry::{GaugeDefinition, GearDefinition, ProfileCurve};
use gearmesh_mesh::GearMesh;
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
    let empty = || ReductionError::EmptyGauge { name: gauge.name.clone() };
    let curve = ProfileCurve::new(&gear.profile);
    let centre = curve.arc_length_at(gauge.position).map_err(|_| empty())?;
    let along = [centre - 0.5 * gauge.length_m, centre + 0.5 * gauge.length_m];
    let across = [gauge.z_m - 0.5 * gauge.width_m, gauge.z_m + 0.5 * gauge.width_m];
    let overlap = |a: [f64; 2], b: [f64; 2]| (a[1].min(b[1]) - a[0].max(b[0])).max(0.0);
    let mut row: BTreeMap<usize, f64> = BTreeMap::new();
    let mut area = 0.0;
    for face in mesh.outline_faces(tooth, gauge.side, along) {
        let weight = overlap(face.arc_m, along) * overlap(face.z_m, across);
        if weight == 0.0 {
            continue;
        }
        area += weight;
        let hex = mesh.hexes[face.hex as usize];
        let corners: Vec<usize> = (0..8).filter(|&k| face.nodes.contains(&hex[k])).collect();
        let natural: [f64; 3] =
            std::array::from_fn(|i| corners.iter().map(|&k| CORNERS[k][i]).sum::<f64>() / corners.len() as f64);
        let (a, b) = (mesh.nodes[face.nodes[0] as usize], mesh.nodes[face.nodes[1] as usize]);
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let length = dx.hypot(dy);
        let t = [dx / length, dy / length];
        // Normal strain along t; order xx, yy, zz, xy, yz, xz with engineering shear.
        let rotation = [t[0] * t[0], t[1] * t[1], 0.0, t[0] * t[1], 0.0, 0.0];
        let operator = model.strain_operator(face.hex as usize, natural)?;
        for (k, &node) in hex.iter().enumerate() {
            for axis in 0..3 {
                let value: f64 = (0..6).map(|i| rotation[i] * operator[i][3 * k + axis]).sum();
                *row.entry(3 * node as usize + axis).or_default() += weight * value;
            }
        }
    }
    if area == 0.0 {
        return Err(empty());
    }
    Ok(row.into_iter().map(|(dof, value)| (dof, value / area)).collect())
}
