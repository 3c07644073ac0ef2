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

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::error::ElementError;
    use crate::isoparametric::{point_gradients, stiffness};
    use crate::stiffness_block::BlockStiffness;

    fn distorted() -> HexCoordinates {
        let mut x = CORNERS;
        x[6] = [1.4, 1.2, 1.3];
        x[1] = [0.9, -1.2, -0.8];
        x
    }

    #[test]
    fn shape_functions_are_nodal_and_sum_to_one() {
        for (i, corner) in CORNERS.iter().enumerate() {
            for (j, value) in shape_functions(*corner).iter().enumerate() {
                assert!((value - f64::from(u8::from(i == j))).abs() < 1e-15);
            }
        }
        let sum: f64 = shape_functions([0.3, -0.7, 0.1]).iter().sum();
        assert!((sum - 1.0).abs() < 1e-15);
    }

    #[test]
    fn gradients_equal_central_differences() {
        let x = distorted();
        let at = [0.2, -0.4, 0.6];
        let step = 1e-6;
        let gradients = point_gradients(&x, natural_gradients, at)
            .unwrap()
            .gradients;
        for k in 0..3 {
            let (mut plus, mut minus) = (at, at);
            plus[k] += step;
            minus[k] -= step;
            let (np, nm) = (shape_functions(plus), shape_functions(minus));
            let dx: [f64; 3] = std::array::from_fn(|j| {
                (0..8).map(|i| (np[i] - nm[i]) * x[i][j]).sum::<f64>() / (2.0 * step)
            });
            for i in 0..8 {
                let along: f64 = (0..3).map(|j| gradients[i][j] * dx[j]).sum();
                // Central difference of a trilinear function: rounding only, about 1e-16/step.
                assert!((along - (np[i] - nm[i]) / (2.0 * step)).abs() < 1e-9);
            }
        }
    }

    fn zero_modes(k: &BlockStiffness<8>) -> usize {
        let dense = faer::Mat::from_fn(24, 24, |i, j| k.entry(i, j));
        let eigenvalues = dense.self_adjoint_eigenvalues(faer::Side::Lower).unwrap();
        let largest = eigenvalues.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        eigenvalues
            .iter()
            .filter(|v| v.abs() < 1e-10 * largest)
            .count()
    }

    /// The six-zero-modes test can fail: one-point quadrature adds twelve hourglass modes, the full rule none.
    #[test]
    fn one_point_quadrature_has_hourglass_modes() {
        let lame = crate::Material::new(210e9, 0.3).unwrap().lame();
        let reduced = stiffness(&distorted(), natural_gradients, lame, &[([0.0; 3], 8.0)]).unwrap();
        assert_eq!(zero_modes(&reduced), 18);
        let full = stiffness(
            &distorted(),
            natural_gradients,
            lame,
            &crate::quadrature::GAUSS_2,
        )
        .unwrap();
        assert_eq!(zero_modes(&full), 6);
    }

    #[test]
    fn an_inside_out_element_is_refused() {
        let mut x = CORNERS;
        x.swap(0, 4);
        x.swap(1, 5);
        x.swap(2, 6);
        x.swap(3, 7);
        assert!(matches!(
            point_gradients(&x, natural_gradients, [0.0; 3]),
            Err(ElementError::JacobianNotPositive { .. })
        ));
    }
}
