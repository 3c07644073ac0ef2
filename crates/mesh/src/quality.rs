//! Scaled Jacobian of hexahedra: the smallest, over the eight corners, of the Jacobian determinant divided by the
//! product of the three edge lengths. 1 for a brick, 0 where a corner collapses, negative where it is inverted. The
//! edges of a twenty-node hexahedron are parabolas; at its corners their tangents take the place of the edges.
//! For ten-node tetrahedra its place is taken by the distortion of their edges, [`tetrahedron_jacobian`].
//! Source: Knupp, *Achieving finite element mesh quality via optimization of the Jacobian matrix norm* (2000).

use crate::MeshError;
use crate::elements::ElementList;
use gearmesh_elements::{HEX_EDGES, TET_EDGES, TET_NODES};

/// What the quality of a mesh comes to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QualityReport {
    /// Smallest scaled Jacobian.
    pub smallest: f64,
    /// Mean scaled Jacobian.
    pub mean: f64,
    /// Centre of the worst element \[m\].
    pub worst_m: [f64; 3],
}

impl QualityReport {
    /// Refuses a mesh that is poorer than demanded.
    ///
    /// # Errors
    /// [`MeshError::Quality`] with the worst element.
    pub fn demand(&self, min_scaled_jacobian: f64) -> Result<(), MeshError> {
        if self.smallest >= min_scaled_jacobian {
            return Ok(());
        }
        let [x_mm, y_mm, z_mm] = self.worst_m.map(|v| v * 1e3);
        Err(MeshError::Quality {
            found: self.smallest,
            lengths: String::new(),
            demanded: min_scaled_jacobian,
            x_mm,
            y_mm,
            z_mm,
        })
    }
}

/// For each corner: the neighbours along the three local axes, ordered to a right-handed frame.
const CORNERS: [[usize; 4]; 8] = [
    [0, 1, 3, 4],
    [1, 2, 0, 5],
    [2, 3, 1, 6],
    [3, 0, 2, 7],
    [4, 7, 5, 0],
    [5, 4, 6, 1],
    [6, 5, 7, 2],
    [7, 6, 4, 3],
];

/// Scaled Jacobian of one hexahedron from the coordinates of its eight or twenty nodes (VTK order).
pub fn scaled_jacobian(nodes: &[[f64; 3]]) -> f64 {
    // Direction of the edge from corner `from` to corner `to`, at `from`.
    let edge = |from: usize, to: usize| -> [f64; 3] {
        let has_both = |e: &[usize; 2]| e.contains(&from) && e.contains(&to);
        let middle = (nodes.len() > 8)
            .then(|| HEX_EDGES.iter().position(has_both))
            .flatten()
            .and_then(|k| nodes.get(8 + k));
        std::array::from_fn(|i| match middle {
            Some(m) => 4.0 * m[i] - 3.0 * nodes[from][i] - nodes[to][i],
            None => nodes[to][i] - nodes[from][i],
        })
    };
    CORNERS
        .iter()
        .map(|&[o, a, b, c]| {
            let (u, v, w) = (edge(o, a), edge(o, b), edge(o, c));
            let det = u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0])
                + u[2] * (v[0] * w[1] - v[1] * w[0]);
            let length = |e: [f64; 3]| e.iter().map(|x| x * x).sum::<f64>().sqrt();
            det / (length(u) * length(v) * length(w)).max(f64::MIN_POSITIVE)
        })
        .fold(f64::INFINITY, f64::min)
}

/// Distortion of a ten-node tetrahedron: the smallest Jacobian determinant at its nodes over that of the tetrahedron
/// with straight edges between the same corners. 1 where edges are straight with their nodes in the middle; 0 or less
/// where the element is folded, or its corners are the wrong way round.
pub fn tetrahedron_jacobian(nodes: &[[f64; 3]; 10]) -> f64 {
    let det = |m: [[f64; 3]; 3]| {
        m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
            - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
    };
    let edge = |k: usize| [0, 1, 2].map(|i| nodes[k][i] - nodes[0][i]);
    let straight = det([edge(1), edge(2), edge(3)]);
    if straight <= 0.0 {
        return -1.0;
    }
    // Volume coordinates and their slopes.
    let slope = |corner: usize, k: usize| match corner {
        0 => -1.0,
        c if c == k + 1 => 1.0,
        _ => 0.0,
    };
    TET_NODES
        .iter()
        .map(|at| {
            let l = [1.0 - at[0] - at[1] - at[2], at[0], at[1], at[2]];
            let columns = [0, 1, 2].map(|k| {
                let mut column = [0.0; 3];
                let mut add = |node: usize, weight: f64| {
                    for (sum, x) in column.iter_mut().zip(nodes[node]) {
                        *sum += weight * x;
                    }
                };
                for (c, volume) in l.iter().enumerate() {
                    add(c, (4.0 * volume - 1.0) * slope(c, k));
                }
                for (e, &[a, b]) in TET_EDGES.iter().enumerate() {
                    add(4 + e, 4.0 * (l[b] * slope(a, k) + l[a] * slope(b, k)));
                }
                column
            });
            det(columns) / straight
        })
        .fold(f64::INFINITY, f64::min)
}

/// Quality of a mesh.
pub fn report(nodes: &[[f64; 3]], elements: &ElementList) -> QualityReport {
    let mut result = QualityReport {
        smallest: f64::INFINITY,
        mean: 0.0,
        worst_m: [0.0; 3],
    };
    let corners = elements.shape().corner_count();
    let mut coordinates = Vec::new();
    for element in elements.iter() {
        coordinates.clear();
        coordinates.extend(element.iter().map(|&n| nodes[n as usize]));
        let q = match <&[[f64; 3]; 10]>::try_from(coordinates.as_slice()) {
            Ok(nodes) => tetrahedron_jacobian(nodes),
            Err(_) => scaled_jacobian(&coordinates),
        };
        result.mean += q / elements.len() as f64;
        if q < result.smallest {
            result.smallest = q;
            result.worst_m = std::array::from_fn(|i| {
                coordinates[..corners].iter().map(|c| c[i]).sum::<f64>() / corners as f64
            });
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    fn brick() -> [[f64; 3]; 8] {
        [
            [0., 0., 0.],
            [2., 0., 0.],
            [2., 1., 0.],
            [0., 1., 0.],
            [0., 0., 3.],
            [2., 0., 3.],
            [2., 1., 3.],
            [0., 1., 3.],
        ]
    }

    #[test]
    fn a_brick_scores_one_and_an_inverted_one_minus_one() {
        assert!((scaled_jacobian(&brick()) - 1.0).abs() < 1e-14);
        let b = brick();
        let inverted = [b[4], b[5], b[6], b[7], b[0], b[1], b[2], b[3]];
        assert!((scaled_jacobian(&inverted) + 1.0).abs() < 1e-14);
    }

    #[test]
    fn a_sheared_corner_scores_its_sine() {
        let mut b = brick();
        // Shear the y edges by 45 degrees: every corner angle is 45 or 135 degrees, sine √½.
        for corner in &mut b {
            corner[0] += corner[1];
        }
        assert!((scaled_jacobian(&b) - 0.5f64.sqrt()).abs() < 1e-14);
    }

    /// One node of an edge moved by a quarter of the edge towards its end: at that end ∂x/∂ξ falls to zero.
    #[test]
    fn a_tetrahedron_is_judged_by_its_edges() {
        let mut nodes = TET_NODES.map(|[x, y, z]| [2.0 * x + 0.3 * y, y, z + 0.1 * x]);
        assert!((tetrahedron_jacobian(&nodes) - 1.0).abs() < 1e-14);
        let [from, to] = [nodes[0], nodes[1]];
        nodes[4] = [0, 1, 2].map(|k| nodes[4][k] + 0.25 * (to[k] - from[k]));
        assert!(tetrahedron_jacobian(&nodes).abs() < 1e-14);
        nodes.swap(0, 1);
        assert_eq!(tetrahedron_jacobian(&nodes), -1.0);
    }

    /// A mid-edge node moved a quarter of the edge's length off it turns the edge's ends by 45 degrees.
    #[test]
    fn a_bent_edge_turns_its_corners() {
        let mut nodes = brick().to_vec();
        for [a, b] in HEX_EDGES {
            nodes.push(std::array::from_fn(|i| 0.5 * (nodes[a][i] + nodes[b][i])));
        }
        assert!((scaled_jacobian(&nodes) - 1.0).abs() < 1e-14);
        nodes[8][1] -= 0.5;
        assert!((scaled_jacobian(&nodes) - 0.5f64.sqrt()).abs() < 1e-14);
    }
}
