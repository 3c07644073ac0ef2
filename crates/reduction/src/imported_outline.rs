//! The faces of a mesh that was made elsewhere that lie on the outlines of its teeth.

use crate::imported_check::ImportCheck;
use crate::tooth_frame::{in_tooth, nearest_tooth};
use gearmesh_fe::{ElementFormulas, FeModel};
use gearmesh_geometry::Flank;
use gearmesh_mesh::{FaceShape, OutlineFace};
use std::collections::HashMap;

/// A face of the mesh's boundary.
struct BoundaryFace {
    element: u32,
    shape: FaceShape,
    nodes: Vec<u32>,
}

/// Faces that belong to one element only.
fn boundary_faces(model: &FeModel) -> Vec<BoundaryFace> {
    let mut open: HashMap<[u32; 4], (u32, usize)> = HashMap::new();
    for e in 0..model.element_count() {
        let nodes = model.element_nodes(e);
        for (f, face) in model.element_of(e).faces().iter().enumerate() {
            let corners = if face.len() % 3 == 0 { 3 } else { 4 };
            let mut key = [u32::MAX; 4];
            for (slot, &k) in key.iter_mut().zip(&face[..corners]) {
                *slot = nodes[k];
            }
            key.sort_unstable();
            if open.remove(&key).is_none() {
                open.insert(key, (e as u32, f));
            }
        }
    }
    let mut faces: Vec<(u32, usize)> = open.into_values().collect();
    faces.sort_unstable();
    faces
        .into_iter()
        .map(|(element, f)| {
            let nodes = model.element_nodes(element as usize);
            let face = model.element_of(element as usize).faces()[f];
            BoundaryFace {
                element,
                shape: match face.len() {
                    3 => FaceShape::Triangle3,
                    4 => FaceShape::Quad4,
                    6 => FaceShape::Triangle6,
                    _ => FaceShape::Quad8,
                },
                nodes: face.iter().map(|&k| nodes[k]).collect(),
            }
        })
        .collect()
}

/// Outline faces by tooth and side, and where their nodes lie.
pub(crate) fn outlines(check: &ImportCheck<'_>, model: &FeModel) -> Vec<[Vec<OutlineFace>; 2]> {
    let teeth = check.gear.tooth.teeth;
    let tolerance = check.tolerance_m();
    let inner = check.gear.profile.root_radius_m - tolerance;
    let mut outlines: Vec<[Vec<OutlineFace>; 2]> = vec![Default::default(); teeth];
    for face in boundary_faces(model) {
        let corners: Vec<[f64; 3]> = face
            .nodes
            .iter()
            .map(|n| model.nodes()[*n as usize])
            .collect();
        if corners.iter().any(|x| x[0].hypot(x[1]) < inner) {
            continue;
        }
        let count = corners.len() as f64;
        let centre = std::array::from_fn(|k| corners.iter().map(|x| x[k]).sum::<f64>() / count);
        let tooth = nearest_tooth(centre, teeth);
        for side in Flank::ALL {
            // The centre says which half the face is in; a node on the border belongs to both.
            if in_tooth(centre, tooth, teeth, side)[1] > 0.0 {
                continue;
            }
            let places: Option<Vec<[f64; 2]>> = corners
                .iter()
                .map(|x| {
                    let (arc, off) = check.curve.place_of(in_tooth(*x, tooth, teeth, side));
                    (off.abs() <= tolerance).then_some([arc, x[2]])
                })
                .collect();
            if let Some(places_m) = places {
                outlines[tooth][side as usize].push(OutlineFace {
                    shape: face.shape,
                    nodes: face.nodes.clone(),
                    element: face.element,
                    places_m,
                });
            }
        }
    }
    for faces in outlines.as_flattened_mut() {
        faces.sort_by(|a, b| a.range_m(0)[0].total_cmp(&b.range_m(0)[0]));
    }
    outlines
}
