//! The eight-node trilinear hexahedron: reference coordinates, shape functions, gradients.
//!
//! Node order (VTK hexahedron): bottom face 0-3 counter-clockwise seen from +ζ, top face 4-7 above it.
//! Natural coordinates (ξ, η, ζ) run from −1 to 1.
//!
//! Source: T. J. R. Hughes, *The Finite Element Method*, 1987, sections 3.2, 3.3 and 3.8.

/// Coordinates (m) of the eight nodes.
pub(crate) type HexCoordinates = [[f64; 3]; 8];

/// Natural coordinates of the eight corners, in VTK order.
pub const CORNERS: [[f64; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

/// Natural coordinates of the nodes, under the name that all elements use.
pub(crate) const NODES: [[f64; 3]; 8] = CORNERS;

/// The nodes of each face, counter-clockwise seen from outside.
pub(crate) const FACES: [&[usize]; 6] = [
    &[0, 3, 2, 1],
    &[4, 5, 6, 7],
    &[0, 1, 5, 4],
    &[1, 2, 6, 5],
    &[2, 3, 7, 6],
    &[3, 0, 4, 7],
];

/// Shape functions N_i(ξ, η, ζ) = (1 + ξ_i ξ)(1 + η_i η)(1 + ζ_i ζ)/8.
pub(crate) fn shape_functions(natural: [f64; 3]) -> [f64; 8] {
    CORNERS.map(|corner| {
        (0..3)
            .map(|k| 0.5 * (1.0 + corner[k] * natural[k]))
            .product()
    })
}

/// Derivatives ∂N_i/∂(ξ, η, ζ), one row per node.
pub(crate) fn natural_gradients(natural: [f64; 3]) -> [[f64; 3]; 8] {
    CORNERS.map(|corner| {
        let f: [f64; 3] = std::array::from_fn(|k| 0.5 * (1.0 + corner[k] * natural[k]));
        [
            0.5 * corner[0] * f[1] * f[2],
            f[0] * 0.5 * corner[1] * f[2],
            f[0] * f[1] * 0.5 * corner[2],
        ]
    })
}
