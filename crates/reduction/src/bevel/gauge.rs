//! A strain gauge in the root of a bevel tooth as one row of nodal weights.
//!
//! The gauge follows the fillet: its middle is where the fillet's tangent makes the asked angle with the tooth's centre
//! line in the section normal to the tooth, in every section. Its direction is normal to the tooth in the surface, its
//! width runs along the tooth.

use gearmesh_bevel::{BevelError, BevelGauge, BevelGear};
use gearmesh_fe::FeModel;
use gearmesh_geometry::Flank;
use gearmesh_mesh::{BevelMesh, OutlineFace};
use gearmesh_model::GaugeRows;
use nalgebra::Vector3;
use std::collections::BTreeMap;

use crate::ReductionError;
use crate::flank_loads::SparseVector;
use crate::gauge_row::{readings, strain_weights};

/// Places at which a fillet is looked at.
const LOOKS: usize = 48;

/// The row of a gauge, placed on `tooth` instead of its own tooth.
///
/// # Errors
/// [`ReductionError::NoGaugePlace`] where the fillet has no such tangent, [`ReductionError::EmptyGauge`] when no face
/// lies under it.
pub fn bevel_gauge_row(
    gear: &BevelGear,
    mesh: &BevelMesh,
    model: &FeModel,
    gauge: &BevelGauge,
    tooth: usize,
) -> Result<SparseVector, ReductionError> {
    let sections = mesh.along.len();
    let k_side = usize::from(gauge.side == Flank::Left);
    let lines = &mesh.outline_m[k_side];
    let nodes = outline_points(gear, mesh, gauge.side)?;
    let count = lines[0].len();
    // Along the tooth: the length of the line through the cut's end, from the gauge's middle.
    let foot = mesh.outline_foot();
    let mut ys = vec![0.0];
    for l in 1..sections {
        ys.push(ys[l - 1] + (nodes[l][foot] - nodes[l - 1][foot]).norm());
    }
    let share = gauge.along_m / gear.blank().face_width_m + 0.5;
    let middle = interpolated(&mesh.along, &ys, share);
    // Along the profile: the length normal to the tooth, from the place with the asked tangent.
    let mut places = Vec::with_capacity(sections);
    for l in 0..sections {
        let next = [l.saturating_sub(1), (l + 1).min(sections - 1)];
        let mut ws = vec![0.0];
        for k in 1..count {
            let along = (nodes[next[1]][k] - nodes[next[0]][k]).normalize();
            let step = nodes[l][k] - nodes[l][k - 1];
            ws.push(ws[k - 1] + (step - along * along.dot(&step)).norm());
        }
        let height = fillet_height_m(gear, gauge, lines[l][0][0])?;
        // Heights fall nowhere from the fillet's lower end on.
        let heights: Vec<f64> = lines[l].iter().map(|p| p[1]).collect();
        let at = interpolated(&heights, &ws, height);
        places.push((
            ws.into_iter().map(|w| w - at).collect::<Vec<f64>>(),
            ys[l] - middle,
        ));
    }
    let faces = mesh.outline_faces(tooth, gauge.side, |k, l| [places[l].0[k], places[l].1]);
    let half = |size: f64| [-0.5 * size, 0.5 * size];
    let readings = readings(&faces, half(gauge.length_m), half(gauge.width_m));
    let area: f64 = readings.iter().map(|r| r.area_m2).sum();
    if area == 0.0 {
        return Err(ReductionError::EmptyGauge {
            name: gauge.name.clone(),
        });
    }
    let mut row: BTreeMap<usize, f64> = BTreeMap::new();
    for reading in readings {
        let t = across_tooth(model, reading.face, reading.natural);
        for (dof, value) in strain_weights(model, reading.face, reading.natural, t)? {
            *row.entry(dof).or_default() += reading.area_m2 / area * value;
        }
    }
    Ok(row.into_iter().collect())
}

/// A gauge by its name and place, without readings.
pub(crate) fn bevel_gauge_head(gauge: &BevelGauge) -> GaugeRows {
    GaugeRows {
        name: gauge.name.clone(),
        tooth: gauge.tooth,
        side: gauge.side,
        description: format!(
            "tooth {}, {} root, {:.2} deg tangent, {:.3} mm along the profile, {:.3} mm wide at {:.3} mm from mid-face along the pitch cone",
            gauge.tooth,
            gauge.side,
            gauge.tangent_rad.to_degrees(),
            gauge.length_m * 1e3,
            gauge.width_m * 1e3,
            gauge.along_m * 1e3
        ),
        ..GaugeRows::default()
    }
}

/// Points of tooth 0's outline, `[section][node]`; nodes that the mesh leaves out between quadratic elements included.
fn outline_points(
    gear: &BevelGear,
    mesh: &BevelMesh,
    side: Flank,
) -> Result<Vec<Vec<Vector3<f64>>>, ReductionError> {
    mesh.along
        .iter()
        .map(|share| {
            let points = mesh.outline_points_m(gear, side, *share)?;
            Ok(points.into_iter().map(Vector3::from).collect())
        })
        .collect()
}

/// Height above the pitch cone \[m\] of the fillet's place with the asked tangent at a cone distance.
fn fillet_height_m(
    gear: &BevelGear,
    gauge: &BevelGauge,
    cone_m: f64,
) -> Result<f64, ReductionError> {
    let side = gear.flank_side(gauge.side);
    let flank = gear.tooth.flank(side);
    let shares: Vec<f64> = (0..=LOOKS).rev().map(|k| k as f64 / LOOKS as f64).collect();
    let lost = |e: BevelError| ReductionError::Mesh(e.into());
    let line = flank.fillet_line(cone_m, &shares).map_err(lost)?;
    let looked: Vec<[f64; 2]> = line
        .iter()
        .map(|found| {
            let [along, _] = flank.directions(&found.point);
            let [_, up] = gear.blank().directions(&found.point.r);
            let centre = (up - along * along.dot(&up)).normalize();
            let angle = found.point.n.dot(&centre).abs().clamp(0.0, 1.0).asin();
            [angle, flank.place(&found.point.r)[1]]
        })
        .collect();
    let asked = gauge.tangent_rad;
    let between = looked
        .windows(2)
        .find(|w| w[0][0] <= asked && asked <= w[1][0]);
    let Some([low, high]) = between.and_then(|w| <[[f64; 2]; 2]>::try_from(w).ok()) else {
        return Err(ReductionError::NoGaugePlace {
            name: gauge.name.clone(),
            from_deg: looked[0][0].to_degrees(),
            to_deg: looked[LOOKS][0].to_degrees(),
        });
    };
    let share = (asked - low[0]) / (high[0] - low[0]).max(f64::MIN_POSITIVE);
    Ok(low[1] + share * (high[1] - low[1]))
}

/// Value at a place of a line through points whose abscissae rise, or stay.
fn interpolated(x: &[f64], y: &[f64], at: f64) -> f64 {
    let k = x.partition_point(|x| *x <= at).clamp(1, x.len() - 1);
    let share = (at - x[k - 1]) / (x[k] - x[k - 1]);
    y[k - 1] + share * (y[k] - y[k - 1])
}

/// Unit tangent of a face normal to the tooth, whose direction is the face's second.
fn across_tooth(model: &FeModel, face: &OutlineFace, natural: [f64; 2]) -> [f64; 3] {
    let (mut up, mut along) = (Vector3::zeros(), Vector3::zeros());
    for (&node, [_, d_xi, d_eta]) in face.nodes.iter().zip(face.shape.shapes(natural)) {
        let x = Vector3::from(model.nodes()[node as usize]);
        up += x * d_xi;
        along += x * d_eta;
    }
    let along = along.normalize();
    let across = (up - along * along.dot(&up)).normalize();
    [across.x, across.y, across.z]
}
