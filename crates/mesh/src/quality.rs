//! Scaled Jacobian of hexahedra: the smallest, over the eight corners, of the Jacobian determinant divided by the
//! product of the three edge lengths. 1 for a brick, 0 where a corner collapses, negative where it is inverted.
//! Source: Knupp, *Achieving finite element mesh quality via optimization of the Jacobian matrix norm* (2000).

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

/// Scaled Jacobian of one hexahedron (VTK node order).
pub fn scaled_jacobian(corners: &[[f64; 3]; 8]) -> f64 {
    CORNERS
        .iter()
        .map(|&[o, a, b, c]| {
            let edge =
                |k: usize| std::array::from_fn::<f64, 3, _>(|i| corners[k][i] - corners[o][i]);
            let (u, v, w) = (edge(a), edge(b), edge(c));
            let det = u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0])
                + u[2] * (v[0] * w[1] - v[1] * w[0]);
            let length = |e: [f64; 3]| e.iter().map(|x| x * x).sum::<f64>().sqrt();
            det / (length(u) * length(v) * length(w)).max(f64::MIN_POSITIVE)
        })
        .fold(f64::INFINITY, f64::min)
}

/// Quality of a mesh.
pub fn report(nodes: &[[f64; 3]], hexes: &[[u32; 8]]) -> QualityReport {
    let mut result = QualityReport {
        smallest: f64::INFINITY,
        mean: 0.0,
        worst_m: [0.0; 3],
    };
    for hex in hexes {
        let corners = hex.map(|n| nodes[n as usize]);
        let q = scaled_jacobian(&corners);
        result.mean += q / hexes.len() as f64;
        if q < result.smallest {
            result.smallest = q;
            result.worst_m =
                std::array::from_fn(|i| corners.iter().map(|c| c[i]).sum::<f64>() / 8.0);
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
}
