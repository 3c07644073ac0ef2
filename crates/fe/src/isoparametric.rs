//! The map from the cube [−1, 1]³ to an element, x = Σ N_i(ξ) x_i, and gradients through it.

use crate::error::ElementError;

/// The map from the reference cube to the element at one point.
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
        // Columns a, b, c: ∂x/∂ξ, ∂x/∂η, ∂x/∂ζ.
        let column = |k: usize| -> [f64; 3] {
            std::array::from_fn(|j| {
                (0..N)
                    .map(|i| coordinates[i][j] * natural_gradients[i][k])
                    .sum()
            })
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
