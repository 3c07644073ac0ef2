//! Loads and rows of tooth 0, turned to another tooth: all teeth have the same mesh.

use crate::flank_loads::SparseVector;
use crate::repeated_mesh::RepeatedMesh;
use rayon::prelude::*;
use std::collections::{HashMap, HashSet};
use std::f64::consts::TAU;

/// A vector given on the cell of tooth 0, on `tooth`. Entries outside the cell are left out.
pub fn on_tooth(mesh: &impl RepeatedMesh, vector: &SparseVector, tooth: usize) -> SparseVector {
    turned(mesh, &[vector], tooth).remove(0)
}

/// Vectors given on the cell of tooth 0, on every tooth: `[tooth][vector]`.
pub fn on_all_teeth(mesh: &impl RepeatedMesh, vectors: &[&SparseVector]) -> Vec<SparseVector> {
    (0..mesh.teeth())
        .into_par_iter()
        .flat_map_iter(|tooth| turned(mesh, vectors, tooth))
        .collect()
}

fn turned(mesh: &impl RepeatedMesh, vectors: &[&SparseVector], tooth: usize) -> Vec<SparseVector> {
    if tooth == 0 {
        return vectors.iter().map(|&vector| vector.clone()).collect();
    }
    let (sin, cos) = (TAU * tooth as f64 / mesh.teeth() as f64).sin_cos();
    let entries = vectors.iter().copied().flatten();
    let needed: HashSet<u32> = entries.map(|e| (e.0 / 3) as u32).collect();
    let cells = mesh.cell_nodes(0).into_iter().zip(mesh.cell_nodes(tooth));
    let image: HashMap<usize, usize> = cells
        .filter(|(from, _)| needed.contains(from))
        .map(|(from, to)| (from as usize, to as usize))
        .collect();
    let turn = |vector: &&SparseVector| {
        let mut turned: Vec<(usize, f64)> = Vec::with_capacity(2 * vector.len());
        for &(dof, value) in *vector {
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
    };
    vectors.iter().map(turn).collect()
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
