//! The fifteen-node serendipity wedge: reference coordinates, shape functions, gradients.
//!
//! ```text
//! corner              N_i = L_i (1 + ζζ_i)(2 L_i + ζζ_i − 2)/2
//! mid-edge, triangle  N_k = 2 L_a L_b (1 + ζζ_k)
//! mid-edge, upright   N_k = L_a (1 − ζ²)                L = (1 − ξ − η, ξ, η)
//! ```
//!
//! Node order (VTK quadratic wedge, corners as in the six-node wedge): 6-8 on the edges 0-1, 1-2, 2-0; 9-11 above them;
//! 12-14 on the upright edges 0-3, 1-4, 2-5. Mid-edge nodes may lie off the chord.
//!
//! Integration: six points in the triangle (degree 4) times three along ζ, exact for the stiffness of a straight prism.
//!
//! Source: O. C. Zienkiewicz, R. L. Taylor, *The Finite Element Method*, vol. 1, 2000, section 8.12.

use crate::hex20::with_middles;
use crate::wedge6::{self, L_GRADIENTS, area_coordinates};
use gearmesh_elements::WEDGE_EDGES;

/// Natural coordinates of the fifteen nodes.
pub(crate) const NODES: [[f64; 3]; 15] = with_middles(wedge6::NODES, &WEDGE_EDGES);

/// The area coordinates that the mid-edge nodes of a triangle belong to.
const TRIANGLE_EDGES: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];

/// The nodes of each face: corners counter-clockwise seen from outside, then the edges between them.
pub(crate) const FACES: [&[usize]; 5] = [
    &[0, 2, 1, 8, 7, 6],
    &[3, 4, 5, 9, 10, 11],
    &[0, 1, 4, 3, 6, 13, 9, 12],
    &[1, 2, 5, 4, 7, 14, 10, 13],
    &[2, 0, 3, 5, 8, 12, 11, 14],
];

/// Shape functions N_i(ξ, η, ζ).
pub(crate) fn shape_functions(natural: [f64; 3]) -> [f64; 15] {
    let l = area_coordinates(natural);
    let z = natural[2];
    std::array::from_fn(|i| {
        let s = z * NODES[i][2];
        match i {
            0..6 => 0.5 * l[i % 3] * (1.0 + s) * (2.0 * l[i % 3] + s - 2.0),
            6..12 => {
                let [a, b] = TRIANGLE_EDGES[i % 3];
                2.0 * l[a] * l[b] * (1.0 + s)
            }
            _ => l[i % 3] * (1.0 - z * z),
        }
    })
}

/// Derivatives ∂N_i/∂(ξ, η, ζ), one row per node.
pub(crate) fn natural_gradients(natural: [f64; 3]) -> [[f64; 3]; 15] {
    let l = area_coordinates(natural);
    let z = natural[2];
    // ∂/∂(ξ, η) of a function of the area coordinates from its derivatives by two of them.
    let plane = |a: usize, by_a: f64, b: usize, by_b: f64| -> [f64; 2] {
        std::array::from_fn(|k| by_a * L_GRADIENTS[a][k] + by_b * L_GRADIENTS[b][k])
    };
    std::array::from_fn(|i| {
        let at = NODES[i][2];
        let s = z * at;
        let ([gx, gy], gz) = match i {
            0..6 => {
                let la = l[i % 3];
                let by_l = 0.5 * (1.0 + s) * (4.0 * la + s - 2.0);
                let by_z = 0.5 * la * at * (2.0 * la + 2.0 * s - 1.0);
                (plane(i % 3, by_l, i % 3, 0.0), by_z)
            }
            6..12 => {
                let [a, b] = TRIANGLE_EDGES[i % 3];
                let up = 2.0 * (1.0 + s);
                (plane(a, up * l[b], b, up * l[a]), 2.0 * l[a] * l[b] * at)
            }
            _ => (plane(i % 3, 1.0 - z * z, i % 3, 0.0), -2.0 * z * l[i % 3]),
        };
        [gx, gy, gz]
    })
}
