//! The ten-node tetrahedron: reference coordinates, shape functions, gradients.
//!
//! ```text
//! L = (1 − ξ − η − ζ, ξ, η, ζ)
//! corner      N_i = L_i (2 L_i − 1)
//! mid-edge    N_k = 4 L_a L_b                     on the edge between the corners a and b
//! ```
//!
//! Node order (VTK quadratic tetrahedron): corners 0-2 counter-clockwise seen from corner 3; 4-9 on the edges 0-1, 1-2,
//! 2-0, 0-3, 1-3, 2-3. Mid-edge nodes may lie off the chord. Natural coordinates ξ, η, ζ ≥ 0, ξ + η + ζ ≤ 1.
//!
//! Integration: eight points, exact for degree 3. The stiffness of a straight tetrahedron has degree 2 (four points are
//! usual); the nodal forces of a constant stress, cofactors of ∂x/∂ξ times ∂N/∂ξ, have degree 3 where edges are curved,
//! so that the patch test passes on curved elements too.
//!
//! Source: T. J. R. Hughes, *The Finite Element Method*, 1987, appendix 3.I.

use gearmesh_elements::TET_EDGES;
pub(crate) use gearmesh_elements::TET_NODES as NODES;

/// Gradients of the four volume coordinates L in natural coordinates.
const L_GRADIENTS: [[f64; 3]; 4] = [
    [-1.0, -1.0, -1.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
];

fn volume_coordinates([x, y, z]: [f64; 3]) -> [f64; 4] {
    [1.0 - x - y - z, x, y, z]
}

/// The nodes of each face: corners counter-clockwise seen from outside, then the edges between them.
pub(crate) const FACES: [&[usize]; 4] = [
    &[0, 2, 1, 6, 5, 4],
    &[0, 1, 3, 4, 8, 7],
    &[1, 2, 3, 5, 9, 8],
    &[2, 0, 3, 6, 7, 9],
];

/// Shape functions N_i(ξ, η, ζ).
pub(crate) fn shape_functions(natural: [f64; 3]) -> [f64; 10] {
    let l = volume_coordinates(natural);
    std::array::from_fn(|i| match i {
        0..4 => l[i] * (2.0 * l[i] - 1.0),
        _ => {
            let [a, b] = TET_EDGES[i - 4];
            4.0 * l[a] * l[b]
        }
    })
}

/// Derivatives ∂N_i/∂(ξ, η, ζ), one row per node.
pub(crate) fn natural_gradients(natural: [f64; 3]) -> [[f64; 3]; 10] {
    let l = volume_coordinates(natural);
    std::array::from_fn(|i| match i {
        0..4 => L_GRADIENTS[i].map(|g| (4.0 * l[i] - 1.0) * g),
        _ => {
            let [a, b] = TET_EDGES[i - 4];
            std::array::from_fn(|k| 4.0 * (l[b] * L_GRADIENTS[a][k] + l[a] * L_GRADIENTS[b][k]))
        }
    })
}
