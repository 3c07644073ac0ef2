//! The surface of a finite element model, or of a part that is cut out of it: faces that belong to one element only,
//! and the stress on them.

use gearmesh_fe::{ElementFormulas, FeModel, von_mises};
use nalgebra::Matrix3;
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
    let all: Vec<u32> = (0..model.element_count() as u32).collect();
    skin_of(model, &all)
}

/// The surface of some elements, those faces included at which they are cut out of the rest.
pub fn skin_of(model: &FeModel, elements: &[u32]) -> Vec<SkinFace> {
    let of_element = |element: &u32| {
        let nodes = model.element_nodes(*element as usize);
        let faces = model.element_of(*element as usize).faces().iter();
        let element = *element;
        faces.map(move |face| SkinFace {
            corners: corners(face).iter().map(|k| nodes[*k]).collect(),
            element,
        })
    };
    let all = || elements.iter().flat_map(of_element);
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

/// Stress \[Pa\] in the middle of each face under the displacement of all degrees of freedom \[m\], that of the face's
/// element there: xx, yy, zz, xy, yz, xz.
///
/// # Errors
/// [`ReductionError::Fe`] when an element's strain cannot be taken.
pub fn stress_on_faces(
    model: &FeModel,
    faces: &[SkinFace],
    displacement_m: &[f64],
) -> Result<Vec<[f64; 6]>, ReductionError> {
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
        Ok(model.material().stress(&strain))
    };
    faces.par_iter().map(of_face).collect()
}

/// Von Mises stress \[Pa\] of each face.
///
/// # Errors
/// As [`stress_on_faces`].
pub fn von_mises_on_faces(
    model: &FeModel,
    faces: &[SkinFace],
    displacement_m: &[f64],
) -> Result<Vec<f64>, ReductionError> {
    let stress = stress_on_faces(model, faces, displacement_m)?;
    Ok(stress.iter().map(von_mises).collect())
}

/// The first principal stress, the largest eigenvalue of the stress tensor; tension is positive \[Pa\].
pub fn first_principal_pa(stress: &[f64; 6]) -> f64 {
    let [x, y, z, xy, yz, xz] = *stress;
    let tensor = Matrix3::new(x, xy, xz, xy, y, yz, xz, yz, z);
    tensor.symmetric_eigenvalues().max()
}

#[cfg(test)]
mod tests {
    use super::first_principal_pa;

    /// σ t tᵀ has the eigenvalues σ, 0, 0; pressure on all sides is its own.
    #[test]
    fn the_first_principal_stress_is_the_largest_eigenvalue() {
        let t: [f64; 3] = [2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0];
        let along = |s: f64, p: f64| {
            let pair = |i: usize, j: usize| s * t[i] * t[j];
            let own = |i: usize| pair(i, i) + p;
            [own(0), own(1), own(2), pair(0, 1), pair(1, 2), pair(0, 2)]
        };
        for (s, p, expected) in [(3e8, 0.0, 3e8), (-3e8, 0.0, 0.0), (1e8, -4e8, -3e8)] {
            let found = first_principal_pa(&along(s, p));
            assert!(
                (found - expected).abs() < 1e-6 * 4e8,
                "{found:e} {expected:e}"
            );
        }
    }
}
