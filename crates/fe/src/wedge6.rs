//! The six-node wedge: reference coordinates, shape functions, gradients. It fills the gaps of hexahedral meshes.
//!
//! ```text
//! N_i = L_i (1 + ζζ_i)/2                          L = (1 − ξ − η, ξ, η)
//! ```
//!
//! Node order: 0-2 the lower triangle, counter-clockwise seen from the upper one; 3-5 above them. Natural coordinates
//! ξ, η ≥ 0, ξ + η ≤ 1, −1 ≤ ζ ≤ 1.
//!
//! Integration: three points in the triangle times two along ζ, exact for the stiffness of a straight prism. The
//! element locks in bending as the plain eight-node hexahedron does.
//!
//! Source: T. J. R. Hughes, *The Finite Element Method*, 1987, sections 3.4 and 3.8.

/// Natural coordinates of the six nodes.
pub(crate) const NODES: [[f64; 3]; 6] = [
    [0.0, 0.0, -1.0],
    [1.0, 0.0, -1.0],
    [0.0, 1.0, -1.0],
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 1.0],
    [0.0, 1.0, 1.0],
];

/// Gradients of the area coordinates L = (1 − ξ − η, ξ, η).
pub(crate) const L_GRADIENTS: [[f64; 2]; 3] = [[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]];

pub(crate) fn area_coordinates([x, y, _]: [f64; 3]) -> [f64; 3] {
    [1.0 - x - y, x, y]
}

/// The nodes of each face, counter-clockwise seen from outside: two triangles, three quads.
pub(crate) const FACES: [&[usize]; 5] = [
    &[0, 2, 1],
    &[3, 4, 5],
    &[0, 1, 4, 3],
    &[1, 2, 5, 4],
    &[2, 0, 3, 5],
];

/// Shape functions N_i(ξ, η, ζ).
pub(crate) fn shape_functions(natural: [f64; 3]) -> [f64; 6] {
    let l = area_coordinates(natural);
    std::array::from_fn(|i| 0.5 * l[i % 3] * (1.0 + NODES[i][2] * natural[2]))
}

/// Derivatives ∂N_i/∂(ξ, η, ζ), one row per node.
pub(crate) fn natural_gradients(natural: [f64; 3]) -> [[f64; 3]; 6] {
    let l = area_coordinates(natural);
    std::array::from_fn(|i| {
        let half = 0.5 * (1.0 + NODES[i][2] * natural[2]);
        let [gx, gy] = L_GRADIENTS[i % 3];
        [gx * half, gy * half, 0.5 * NODES[i][2] * l[i % 3]]
    })
}
