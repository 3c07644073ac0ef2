//! What the integration tests share: a steel, the element list, a distorted block.
#![allow(dead_code, missing_docs, clippy::unwrap_used)]

use gearmesh_fe::{Element, ElementFormulas, FeModel, Material, StructuredMesh, chord_middle};

pub const ELEMENTS: [Element; 6] = Element::ALL;

pub fn steel() -> Material {
    Material::new(210e9, 0.3).unwrap()
}

/// A unit cube of n³ elements whose inner nodes are moved by up to 0.15 of the element size; the boundary
/// stays plane.
pub fn distorted_cube(n: usize) -> StructuredMesh {
    let mut mesh = StructuredMesh::block([n; 3], [1.0; 3]);
    let inside = |v: f64| v > 1e-9 && v < 1.0 - 1e-9;
    let mut random = fastrand::Rng::with_seed(n as u64);
    for node in &mut mesh.nodes {
        if node.iter().all(|v| inside(*v)) {
            for v in node {
                *v += 0.15 / n as f64 * (2.0 * random.f64() - 1.0);
            }
        }
    }
    mesh
}

/// A model of a mesh in the unit cube. Edges of quadratic elements inside are bent by up to 0.07 of their length, those
/// on the boundary are straight.
pub fn model(mesh: StructuredMesh, element: Element) -> FeModel {
    let bent = |_, [a, b]: [[f64; 3]; 2]| {
        let middle = chord_middle([a, b]);
        let inside = middle.iter().all(|v| *v > 1e-9 && *v < 1.0 - 1e-9);
        let length = (0..3).map(|k| (b[k] - a[k]).powi(2)).sum::<f64>().sqrt();
        let bend = if inside { 0.04 * length } else { 0.0 };
        let seed = 129.898 * middle[0] + 782.33 * middle[1] + 377.19 * middle[2];
        std::array::from_fn(|k| middle[k] + bend * (seed + 2.1 * k as f64).sin())
    };
    mesh.into_model(steel(), element, bent).unwrap()
}

/// One distorted element of about the given half size, its edges bent where it has nodes on them.
pub fn distorted_element(element: Element, half_size: f64) -> Vec<[f64; 3]> {
    let nodes = element.natural_nodes();
    let moved = |k: usize, by: f64| by * (1.7 * k as f64 + 0.4).sin();
    nodes
        .iter()
        .enumerate()
        .map(|(i, x)| std::array::from_fn(|axis| half_size * (x[axis] + moved(3 * i + axis, 0.06))))
        .collect()
}

/// Indices of the nodes of a model whose coordinates satisfy a condition.
pub fn nodes_where(model: &FeModel, condition: impl Fn([f64; 3]) -> bool) -> Vec<usize> {
    (0..model.node_count())
        .filter(|&n| condition(model.nodes()[n]))
        .collect()
}

/// Rotation matrix about a unit-scaled axis by an angle (Rodrigues).
pub fn rotation(axis: [f64; 3], angle: f64) -> [[f64; 3]; 3] {
    let length = axis.iter().map(|v| v * v).sum::<f64>().sqrt();
    let [x, y, z] = axis.map(|v| v / length);
    let (s, c) = angle.sin_cos();
    let d = 1.0 - c;
    [
        [c + x * x * d, x * y * d - z * s, x * z * d + y * s],
        [y * x * d + z * s, c + y * y * d, y * z * d - x * s],
        [z * x * d - y * s, z * y * d + x * s, c + z * z * d],
    ]
}

pub fn rotate(r: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| (0..3).map(|j| r[i][j] * v[j]).sum())
}
