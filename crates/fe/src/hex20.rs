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

/// Natural coordinates of the twenty nodes.
pub(crate) const NODES: [[f64; 3]; 20] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
    [0.0, -1.0, -1.0],
    [1.0, 0.0, -1.0],
    [0.0, 1.0, -1.0],
    [-1.0, 0.0, -1.0],
    [0.0, -1.0, 1.0],
    [1.0, 0.0, 1.0],
    [0.0, 1.0, 1.0],
    [-1.0, 0.0, 1.0],
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
];

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

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::isoparametric::stiffness;
    use crate::quadrature::{GAUSS_2, GAUSS_3, WeightedPoint};
    use gearmesh_elements::HEX_EDGES;

    /// Corners moved, edges bent.
    fn distorted() -> [[f64; 3]; 20] {
        let mut x = NODES;
        x[6] = [1.4, 1.2, 1.3];
        x[1] = [0.9, -1.2, -0.8];
        for (k, [a, b]) in HEX_EDGES.into_iter().enumerate() {
            x[8 + k] = std::array::from_fn(|axis| {
                0.5 * (x[a][axis] + x[b][axis]) + 0.1 * ((3 * k + axis) as f64).sin()
            });
        }
        x
    }

    #[test]
    fn mid_edge_nodes_lie_between_their_corners() {
        for (k, [a, b]) in HEX_EDGES.into_iter().enumerate() {
            let middle = std::array::from_fn(|axis| 0.5 * (NODES[a][axis] + NODES[b][axis]));
            assert_eq!(NODES[8 + k], middle);
        }
    }

    #[test]
    fn shape_functions_are_nodal() {
        for (i, node) in NODES.iter().enumerate() {
            for (j, value) in shape_functions(*node).iter().enumerate() {
                assert!((value - f64::from(u8::from(i == j))).abs() < 1e-15);
            }
        }
    }

    /// Every quadratic of the three coordinates, and ξ²η besides, is a sum of shape functions.
    #[test]
    fn quadratics_are_reproduced() {
        let functions: [fn([f64; 3]) -> f64; 11] = [
            |_| 1.0,
            |x| x[0],
            |x| x[1],
            |x| x[2],
            |x| x[0] * x[0],
            |x| x[1] * x[1],
            |x| x[2] * x[2],
            |x| x[0] * x[1],
            |x| x[1] * x[2],
            |x| x[0] * x[2],
            |x| x[0] * x[0] * x[1],
        ];
        let at = [0.3, -0.7, 0.1];
        let n = shape_functions(at);
        for f in functions {
            let sum: f64 = (0..20).map(|i| n[i] * f(NODES[i])).sum();
            assert!((sum - f(at)).abs() < 1e-14);
        }
    }

    #[test]
    fn gradients_equal_central_differences() {
        let at = [0.2, -0.4, 0.6];
        let step = 1e-5;
        for k in 0..3 {
            let (mut plus, mut minus) = (at, at);
            plus[k] += step;
            minus[k] -= step;
            let (np, nm) = (shape_functions(plus), shape_functions(minus));
            for (i, gradient) in natural_gradients(at).iter().enumerate() {
                // Third derivatives vanish along one axis: rounding only, about 1e-16/step.
                assert!((gradient[k] - (np[i] - nm[i]) / (2.0 * step)).abs() < 1e-10);
            }
        }
    }

    fn zero_modes(rule: &[WeightedPoint]) -> usize {
        let lame = crate::Material::new(210e9, 0.3).unwrap().lame();
        let k = stiffness(&distorted(), natural_gradients, lame, rule).unwrap();
        let dense = faer::Mat::from_fn(60, 60, |i, j| k.entry(i, j));
        let eigenvalues = dense.self_adjoint_eigenvalues(faer::Side::Lower).unwrap();
        let largest = eigenvalues.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        eigenvalues
            .iter()
            .filter(|v| v.abs() < 1e-10 * largest)
            .count()
    }

    /// 2×2×2 points give 48 strains for 60 − 6 deformations: six modes too many. The full rule has none.
    #[test]
    fn reduced_quadrature_has_six_modes_too_many() {
        assert_eq!(zero_modes(&GAUSS_2), 12);
        assert_eq!(zero_modes(&GAUSS_3), 6);
    }
}
