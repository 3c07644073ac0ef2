//! Nodes that move as one rigid body with the six degrees of freedom of a reference point.
//!
//! ```text
//! u_n = t + θ × (x_n − x_R)          t: displacement of the reference point (m), θ: its rotation (rad), small
//! ```
//!
//! Written for all degrees of freedom this is u = T q. Forces follow by the transpose, Tᵀ f: the force on a rigid node
//! goes to the reference point with its moment (x_n − x_R) × f.

use faer::Mat;

/// A set of nodes tied rigidly to a reference point.
#[derive(Debug, Clone, PartialEq)]
pub struct RigidGroup {
    /// The nodes. Three that are not on one line let the group hold a body against rotation.
    pub nodes: Vec<usize>,
    /// Place of the reference point (m); it need not be a node.
    pub reference_m: [f64; 3],
    /// Which of the six degrees of freedom of the reference point are fixed: x, y, z, then rotation about x, y, z.
    pub fixed: [bool; 6],
}

/// The part of u_n along `axis` that each of the six degrees of freedom contributes: a row of T.
///
/// `arm`: x_n − x_R (m).
pub(crate) fn row(arm: [f64; 3], axis: usize) -> [f64; 6] {
    let [x, y, z] = arm;
    // Columns e_b × r for b = x, y, z.
    let rotations = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
    std::array::from_fn(|q| match q {
        0..3 => f64::from(u8::from(q == axis)),
        _ => rotations[q - 3][axis],
    })
}

/// R (3 n × 6): displacements of all nodes (m) under the six unit motions of a rigid body, x, y, z (1 m), then rotation
/// about x, y, z (1 rad) through the reference point.
pub fn rigid_motions(nodes: &[[f64; 3]], reference_m: [f64; 3]) -> Mat<f64> {
    let mut motions = Mat::zeros(3 * nodes.len(), 6);
    for (n, place) in nodes.iter().enumerate() {
        let arm = std::array::from_fn(|k| place[k] - reference_m[k]);
        for axis in 0..3 {
            for (q, value) in row(arm, axis).into_iter().enumerate() {
                motions[(3 * n + axis, q)] = value;
            }
        }
    }
    motions
}
