//! The surface of a finite element model: faces that belong to one element only, and the stress on them.

use gearmesh_fe::{ElementFormulas, FeModel, von_mises};
use rayon::prelude::*;
use std::collections::HashMap;

use crate::ReductionError;

/// A face of the surface.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SkinFace {
    /// Corners, three or four, counter-clockwise seen from outside.
    pub corners: Vec<u32>,
    /// The element that it belongs to.
    pub element: u32,
}

/// Faces with one element, in the order of the elements.
pub fn skin(model: &FeModel) -> Vec<SkinFace> {
    let of_element = |element: usize| {
        let nodes = model.element_nodes(element);
        let faces = model.element_of(element).faces().iter();
        faces.map(move |face| SkinFace {
            corners: corners(face).iter().map(|k| nodes[*k]).collect(),
            element: element as u32,
        })
    };
    let all = || (0..model.element_count()).flat_map(of_element);
    let key = |face: &SkinFace| {
        let mut key = face.corners.clone();
        key.sort_unstable();
        key
    };
    let mut times: HashMap<Vec<u32>, u8> = HashMap::new();
    for face in all() {
        *times.entry(key(&face)).or_default() += 1;
    }
    all().filter(|face| times[&key(face)] == 1).collect()
}

/// A face's corners, without the nodes between them.
fn corners(face: &[usize]) -> &[usize] {
    let count = if matches!(face.len(), 3 | 6) { 3 } else { 4 };
    &face[..count]
}

/// Von Mises stress \[Pa\] in the middle of each face under the displacement of all degrees of freedom \[m\]: that of the face's element there.
///
/// # Errors
/// [`ReductionError::Fe`] when an element's strain cannot be taken.
pub fn stress_on_faces(
    model: &FeModel,
    faces: &[SkinFace],
    displacement_m: &[f64],
) -> Result<Vec<f64>, ReductionError> {
    let of_face = |face: &SkinFace| {
        let element = face.element as usize;
        let nodes = model.element_nodes(element);
        let natural = model.element_of(element).natural_nodes();
        let mut middle = [0.0; 3];
        for corner in &face.corners {
            if let Some(k) = nodes.iter().position(|node| node == corner) {
                for (sum, x) in middle.iter_mut().zip(natural[k]) {
                    *sum += x / face.corners.len() as f64;
                }
            }
        }
        let strain = model.strain(element, middle, displacement_m)?;
        Ok(von_mises(&model.material().stress(&strain)))
    };
    faces.par_iter().map(of_face).collect()
}
