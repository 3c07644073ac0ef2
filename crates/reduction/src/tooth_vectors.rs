//! Loads and rows of tooth 0, turned to another tooth: all teeth have the same mesh.

use crate::flank_loads::SparseVector;
use gearmesh_mesh::GearMesh;
use rayon::prelude::*;
use std::collections::HashMap;
use std::f64::consts::TAU;

/// A vector given on the cell of tooth 0, on `tooth`. Entries outside the cell are left out.
pub fn on_tooth(mesh: &GearMesh, vector: &SparseVector, tooth: usize) -> SparseVector {
    if tooth == 0 {
        return vector.clone();
    }
    let cells = &mesh.section.cell_nodes;
    let (sin, cos) = (TAU * tooth as f64 / cells.len() as f64).sin_cos();
    let needed: HashMap<u32, ()> = vector.iter().map(|e| ((e.0 / 3) as u32, ())).collect();
    let mut image: HashMap<usize, usize> = HashMap::with_capacity(needed.len());
    for (&from, &to) in cells[0].iter().zip(&cells[tooth]) {
        for plane in 0..mesh.layers.planes_m.len() {
            if let (Some(a), Some(b)) = (mesh.node(from, plane), mesh.node(to, plane))
                && needed.contains_key(&a)
            {
                image.insert(a as usize, b as usize);
            }
        }
    }
    let mut turned: Vec<(usize, f64)> = Vec::with_capacity(2 * vector.len());
    for &(dof, value) in vector {
        let Some(&node) = image.get(&(dof / 3)) else {
            continue;
        };
        match dof % 3 {
            0 => turned.extend([(3 * node, cos * value), (3 * node + 1, sin * value)]),
            1 => turned.extend([(3 * node, -sin * value), (3 * node + 1, cos * value)]),
            _ => turned.push((3 * node + 2, value)),
        }
    }
    summed(turned)
}

/// Vectors given on the cell of tooth 0, on every tooth: `[tooth][vector]`.
pub fn on_all_teeth(mesh: &GearMesh, vectors: &[&SparseVector]) -> Vec<SparseVector> {
    (0..mesh.section.cell_nodes.len())
        .into_par_iter()
        .flat_map_iter(|t| vectors.iter().map(move |v| on_tooth(mesh, v, t)))
        .collect()
}

/// Entries sorted by degree of freedom, those of the same one added.
pub fn summed(mut entries: Vec<(usize, f64)>) -> SparseVector {
    entries.sort_by_key(|entry| entry.0);
    entries.dedup_by(|b, a| {
        let same = a.0 == b.0;
        if same {
            a.1 += b.1;
        }
        same
    });
    entries
}
