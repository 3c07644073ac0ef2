//! The eight-node trilinear hexahedron: reference coordinates, shape functions, gradients, quadrature, stiffness.
//!
//! Node order (VTK hexahedron): bottom face 0-3 counter-clockwise seen from +ζ, top face 4-7 above it.
//! Natural coordinates (ξ, η, ζ) run from −1 to 1.
//!
//! Source: T. J. R. Hughes, *The Finite Element Method*, 1987, sections 3.2, 3.3 and 3.8.

use crate::element::HexCoordinates;
use crate::error::ElementError;
use crate::material::LameParameters;
use crate::stiffness_block::{BlockStiffness, add_point_stiffness};

/// Natural coordinates of the eight nodes.
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

/// 1/√3, the abscissa of the two-point Gauss rule.
const GAUSS_ABSCISSA: f64 = 0.577_350_269_189_625_8;

/// Points of the 2x2x2 Gauss rule, in the order of [`CORNERS`]; each has the weight 1.
///
/// The rule integrates the volume of any trilinear hexahedron exactly and gives the stiffness full rank.
pub const GAUSS_POINTS: [[f64; 3]; 8] = {
    let mut points = CORNERS;
    let mut i = 0;
    while i < 8 {
        let mut j = 0;
        while j < 3 {
            points[i][j] *= GAUSS_ABSCISSA;
            j += 1;
        }
        i += 1;
    }
    points
};

/// Shape functions N_i(ξ, η, ζ) = (1 + ξ_i ξ)(1 + η_i η)(1 + ζ_i ζ)/8.
pub fn shape_functions(natural: [f64; 3]) -> [f64; 8] {
    CORNERS.map(|corner| {
        (0..3)
            .map(|k| 0.5 * (1.0 + corner[k] * natural[k]))
            .product()
    })
}

/// Derivatives ∂N_i/∂(ξ, η, ζ), one row per node.
fn natural_gradients(natural: [f64; 3]) -> [[f64; 3]; 8] {
    CORNERS.map(|corner| {
        let f: [f64; 3] = std::array::from_fn(|k| 0.5 * (1.0 + corner[k] * natural[k]));
        [
            0.5 * corner[0] * f[1] * f[2],
            f[0] * 0.5 * corner[1] * f[2],
            f[0] * f[1] * 0.5 * corner[2],
        ]
    })
}

/// Position (m) of a natural point: x = Σ N_i x_i.
pub fn position_at(coordinates: &HexCoordinates, natural: [f64; 3]) -> [f64; 3] {
    let n = shape_functions(natural);
    std::array::from_fn(|k| (0..8).map(|i| n[i] * coordinates[i][k]).sum())
}

/// The map from the reference cube to the element at one point.
pub(crate) struct Jacobian {
    /// det ∂x/∂ξ (m³).
    pub determinant: f64,
    /// ∂ξ_i/∂x_j (1/m).
    pub inverse: [[f64; 3]; 3],
}

impl Jacobian {
    /// Physical gradient ∂/∂x_j = Σ_i ∂ξ_i/∂x_j ∂/∂ξ_i of a function with the given natural gradient.
    pub fn to_physical(&self, natural_gradient: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|j| {
            (0..3)
                .map(|i| self.inverse[i][j] * natural_gradient[i])
                .sum()
        })
    }
}

/// Jacobian at a natural point.
///
/// # Errors
/// [`ElementError::JacobianNotPositive`].
pub(crate) fn jacobian(
    coordinates: &HexCoordinates,
    natural: [f64; 3],
) -> Result<Jacobian, ElementError> {
    jacobian_of(coordinates, &natural_gradients(natural), natural)
}

fn jacobian_of(
    coordinates: &HexCoordinates,
    gradients: &[[f64; 3]; 8],
    natural: [f64; 3],
) -> Result<Jacobian, ElementError> {
    // Columns a, b, c: ∂x/∂ξ, ∂x/∂η, ∂x/∂ζ.
    let column = |k: usize| -> [f64; 3] {
        std::array::from_fn(|j| (0..8).map(|i| coordinates[i][j] * gradients[i][k]).sum())
    };
    let (a, b, c) = (column(0), column(1), column(2));
    let cofactors = [cross(b, c), cross(c, a), cross(a, b)];
    let determinant: f64 = (0..3).map(|j| a[j] * cofactors[0][j]).sum();
    // Written so that NaN fails too.
    if !(determinant > 0.0 && determinant.is_finite()) {
        return Err(ElementError::JacobianNotPositive {
            natural,
            determinant_m3: determinant,
        });
    }
    Ok(Jacobian {
        determinant,
        inverse: cofactors.map(|row| row.map(|v| v / determinant)),
    })
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Gradients of the shape functions at one point of an element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointGradients {
    /// ∂N_i/∂x (1/m), one row per node.
    pub gradients: [[f64; 3]; 8],
    /// Jacobian determinant (m³): volume per unit of natural volume.
    pub determinant: f64,
}

/// Gradients of the shape functions in physical coordinates at a natural point.
///
/// # Errors
/// [`ElementError::JacobianNotPositive`].
pub fn point_gradients(
    coordinates: &HexCoordinates,
    natural: [f64; 3],
) -> Result<PointGradients, ElementError> {
    let in_natural = natural_gradients(natural);
    let map = jacobian_of(coordinates, &in_natural, natural)?;
    Ok(PointGradients {
        gradients: in_natural.map(|g| map.to_physical(g)),
        determinant: map.determinant,
    })
}

/// Stiffness by the given quadrature, `(point, weight)` each: K = Σ w |J| Bᵀ D B.
pub(crate) fn stiffness_with_rule(
    coordinates: &HexCoordinates,
    lame: LameParameters,
    rule: impl IntoIterator<Item = ([f64; 3], f64)>,
) -> Result<BlockStiffness<8>, ElementError> {
    let mut k = BlockStiffness::zero();
    for (point, weight) in rule {
        let at = point_gradients(coordinates, point)?;
        add_point_stiffness(&mut k, &at.gradients, weight * at.determinant, lame);
    }
    Ok(k)
}

/// Stiffness by the 2x2x2 Gauss rule.
pub(crate) fn stiffness(
    coordinates: &HexCoordinates,
    lame: LameParameters,
) -> Result<BlockStiffness<8>, ElementError> {
    stiffness_with_rule(coordinates, lame, GAUSS_POINTS.map(|p| (p, 1.0)))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

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
        let gradients = point_gradients(&x, at).unwrap().gradients;
        for k in 0..3 {
            let (mut plus, mut minus) = (at, at);
            plus[k] += step;
            minus[k] -= step;
            let dx: [f64; 3] = {
                let (p, m) = (position_at(&x, plus), position_at(&x, minus));
                std::array::from_fn(|j| (p[j] - m[j]) / (2.0 * step))
            };
            let (np, nm) = (shape_functions(plus), shape_functions(minus));
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
        let reduced = stiffness_with_rule(&distorted(), lame, [([0.0; 3], 8.0)]).unwrap();
        assert_eq!(zero_modes(&reduced), 18);
        assert_eq!(zero_modes(&stiffness(&distorted(), lame).unwrap()), 6);
    }

    #[test]
    fn an_inside_out_element_is_refused() {
        let mut x = CORNERS;
        x.swap(0, 4);
        x.swap(1, 5);
        x.swap(2, 6);
        x.swap(3, 7);
        assert!(matches!(
            point_gradients(&x, [0.0; 3]),
            Err(ElementError::JacobianNotPositive { .. })
        ));
    }
}
