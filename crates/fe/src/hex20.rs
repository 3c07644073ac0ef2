//! The twenty-node serendipity hexahedron: reference coordinates, shape functions, gradients.
//!
//! ```text
//! corner      N_i = (1 + ξξ_i)(1 + ηη_i)(1 + ζζ_i)(ξξ_i + ηη_i + ζζ_i − 2)/8
//! mid-edge    N_i = (1 − ξ²)(1 + ηη_i)(1 + ζζ_i)/4          where ξ_i = 0; the other two axes alike
//! ```
//!
//! Node order (VTK quadratic hexahedron): corners as the eight-node hexahedron; 8-11 on the edges 0-1, 1-2, 2-3, 3-0;
//! 12-15 above them; 16-19 on the upright edges 0-4, 1-5, 2-6, 3-7. Mid-edge nodes may lie off the chord: edges are
//! then parabolas.
//!
//! Integration: 3×3×3 Gauss points. The integrand of the stiffness of a parallelepiped has degree 4 in each variable
//! (N_i has degree 2), so the rule is exact there; with 2×2×2 points one element has six zero-energy modes too many.
//!
//! Source: T. J. R. Hughes, *The Finite Element Method*, 1987, section 3.7 (serendipity) and 3.8 (quadrature).

use crate::hex8::CORNERS;
use gearmesh_elements::HEX_EDGES;

/// Natural coordinates of the twenty nodes.
pub(crate) const NODES: [[f64; 3]; 20] = with_middles(CORNERS, &HEX_EDGES);

/// Corners, and after them the middles of the edges between them.
pub(crate) const fn with_middles<const C: usize, const N: usize>(
    corners: [[f64; 3]; C],
    edges: &[[usize; 2]],
) -> [[f64; 3]; N] {
    let mut nodes = [[0.0; 3]; N];
    let mut i = 0;
    while i < N {
        let [a, b] = if i < C { [i, i] } else { edges[i - C] };
        let ([ax, ay, az], [bx, by, bz]) = (corners[a], corners[b]);
        nodes[i] = [0.5 * (ax + bx), 0.5 * (ay + by), 0.5 * (az + bz)];
        i += 1;
    }
    nodes
}

/// The nodes of each face: corners counter-clockwise seen from outside, then the edges between them.
pub(crate) const FACES: [&[usize]; 6] = [
    &[0, 3, 2, 1, 11, 10, 9, 8],
    &[4, 5, 6, 7, 12, 13, 14, 15],
    &[0, 1, 5, 4, 8, 17, 12, 16],
    &[1, 2, 6, 5, 9, 18, 13, 17],
    &[2, 3, 7, 6, 10, 19, 14, 18],
    &[3, 0, 4, 7, 11, 16, 15, 19],
];

/// Shape functions N_i(ξ, η, ζ).
pub(crate) fn shape_functions(natural: [f64; 3]) -> [f64; 20] {
    std::array::from_fn(|i| {
        let product: f64 = (0..3).map(|k| factor(i, k, natural[k])).product();
        match i {
            0..8 => product * corner_sum(i, natural) / 8.0,
            _ => product / 4.0,
        }
    })
}

/// Derivatives ∂N_i/∂(ξ, η, ζ), one row per node.
pub(crate) fn natural_gradients(natural: [f64; 3]) -> [[f64; 3]; 20] {
    std::array::from_fn(|i| {
        let f: [f64; 3] = std::array::from_fn(|k| factor(i, k, natural[k]));
        std::array::from_fn(|k| {
            let others = f[(k + 1) % 3] * f[(k + 2) % 3];
            match i {
                // Product rule of (1 + ξξ_i)·(sum), both with the slope ξ_i.
                0..8 => NODES[i][k] * others * (corner_sum(i, natural) + f[k]) / 8.0,
                _ if NODES[i][k] == 0.0 => -2.0 * natural[k] * others / 4.0,
                _ => NODES[i][k] * others / 4.0,
            }
        })
    })
}

/// 1 + x x_i, or 1 − x² along the edge of a mid-edge node.
fn factor(node: usize, axis: usize, x: f64) -> f64 {
    let at = NODES[node][axis];
    if at == 0.0 { 1.0 - x * x } else { 1.0 + x * at }
}

/// ξξ_i + ηη_i + ζζ_i − 2 of a corner.
fn corner_sum(node: usize, natural: [f64; 3]) -> f64 {
    (0..3).map(|k| natural[k] * NODES[node][k]).sum::<f64>() - 2.0
}
