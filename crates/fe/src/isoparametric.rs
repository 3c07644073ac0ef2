//! The map from a reference shape to an element, x = Σ N_i(ξ) x_i, gradients and stiffness through it.
//!
//! An element is given by its natural gradients ∂N_i/∂(ξ, η, ζ); the rest is the same for all.

use crate::error::ElementError;
use crate::material::LameParameters;
use crate::quadrature::WeightedPoint;
use crate::stiffness_block::{BlockStiffness, add_point_stiffness};

/// The map from the reference shape to the element at one point.
pub(crate) struct Jacobian {
    /// det ∂x/∂ξ (m³).
    pub determinant: f64,
    /// ∂ξ_i/∂x_j (1/m).
    inverse: [[f64; 3]; 3],
}

impl Jacobian {
    /// The map at a natural point, from coordinates (m) and ∂N_i/∂(ξ, η, ζ) there.
    ///
    /// # Errors
    /// [`ElementError::JacobianNotPositive`].
    pub fn new<const N: usize>(
        coordinates: &[[f64; 3]; N],
        natural_gradients: &[[f64; 3]; N],
        natural: [f64; 3],
    ) -> Result<Self, ElementError> {
        let (determinant, cofactors) = cofactors(coordinates, natural_gradients, natural)?;
        Ok(Self {
            determinant,
            inverse: cofactors.map(|row| row.map(|v| v / determinant)),
        })
    }

    /// Physical gradient ∂/∂x_j = Σ_i ∂ξ_i/∂x_j ∂/∂ξ_i of a function with the given natural gradient.
    pub fn to_physical(&self, natural_gradient: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|j| {
            (0..3)
                .map(|i| self.inverse[i][j] * natural_gradient[i])
                .sum()
        })
    }
}

/// det ∂x/∂ξ (m³) at a natural point and the cofactors of ∂x/∂ξ, rows ξ, η, ζ.
fn cofactors(
    coordinates: &[[f64; 3]],
    natural_gradients: &[[f64; 3]],
    natural: [f64; 3],
) -> Result<(f64, [[f64; 3]; 3]), ElementError> {
    // Rows a, b, c: ∂x/∂ξ, ∂x/∂η, ∂x/∂ζ.
    let mut rows = [[0.0; 3]; 3];
    for (x, gradient) in coordinates.iter().zip(natural_gradients) {
        for (row, slope) in rows.iter_mut().zip(gradient) {
            for (sum, x) in row.iter_mut().zip(x) {
                *sum += x * slope;
            }
        }
    }
    let [a, b, c] = rows;
    let cofactors = [cross(b, c), cross(c, a), cross(a, b)];
    let determinant: f64 = (0..3).map(|j| a[j] * cofactors[0][j]).sum();
    // Written so that NaN fails too.
    if !(determinant > 0.0 && determinant.is_finite()) {
        return Err(ElementError::JacobianNotPositive {
            natural,
            determinant_m3: determinant,
        });
    }
    Ok((determinant, cofactors))
}

/// det ∂x/∂ξ (m³) at a natural point, from coordinates (m) and ∂N_i/∂(ξ, η, ζ) there.
///
/// # Errors
/// [`ElementError::JacobianNotPositive`]; [`ElementError::NodeCount`].
pub(crate) fn determinant(
    coordinates: &[[f64; 3]],
    natural_gradients: &[[f64; 3]],
    natural: [f64; 3],
) -> Result<f64, ElementError> {
    if coordinates.len() != natural_gradients.len() {
        return Err(ElementError::NodeCount {
            found: coordinates.len(),
            expected: natural_gradients.len(),
        });
    }
    Ok(cofactors(coordinates, natural_gradients, natural)?.0)
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Gradients of the shape functions at one point of an element.
pub(crate) struct PointGradients<const N: usize> {
    /// ∂N_i/∂x (1/m), one row per node.
    pub gradients: [[f64; 3]; N],
    /// Jacobian determinant (m³): volume per unit of natural volume.
    pub determinant: f64,
}

impl<const N: usize> PointGradients<N> {
    /// Gradients in space from those in natural coordinates.
    ///
    /// # Errors
    /// [`ElementError::JacobianNotPositive`].
    pub fn new(
        coordinates: &[[f64; 3]; N],
        natural_gradients: &[[f64; 3]; N],
        natural: [f64; 3],
    ) -> Result<Self, ElementError> {
        let map = Jacobian::new(coordinates, natural_gradients, natural)?;
        Ok(Self {
            gradients: natural_gradients.map(|g| map.to_physical(g)),
            determinant: map.determinant,
        })
    }
}

/// Gradients of the shape functions in physical coordinates at a natural point.
///
/// # Errors
/// [`ElementError::JacobianNotPositive`].
pub(crate) fn point_gradients<const N: usize>(
    coordinates: &[[f64; 3]; N],
    natural_gradients: impl Fn([f64; 3]) -> [[f64; 3]; N],
    natural: [f64; 3],
) -> Result<PointGradients<N>, ElementError> {
    PointGradients::new(coordinates, &natural_gradients(natural), natural)
}

/// Stiffness by the given quadrature: K = Σ w |J| Bᵀ D B.
///
/// # Errors
/// [`ElementError::JacobianNotPositive`].
pub(crate) fn stiffness<const N: usize>(
    coordinates: &[[f64; 3]; N],
    natural_gradients: impl Fn([f64; 3]) -> [[f64; 3]; N],
    lame: LameParameters,
    rule: &[WeightedPoint],
) -> Result<Box<BlockStiffness<N>>, ElementError> {
    let mut k = Box::new(BlockStiffness::zero());
    for &(point, weight) in rule {
        let at = point_gradients(coordinates, &natural_gradients, point)?;
        add_point_stiffness(&mut k, &at.gradients, weight * at.determinant, lame);
    }
    Ok(k)
}
