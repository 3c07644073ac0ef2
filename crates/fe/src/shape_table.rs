//! Shape functions and their gradients at the fixed points of a kind of element, made once for all its elements.

use crate::error::ElementError;
use crate::isoparametric::determinant;

/// Values at some natural points of a kind of element.
pub(crate) struct ShapeTable {
    /// Natural coordinates and weights; weight zero where nothing is integrated.
    points: Vec<([f64; 3], f64)>,
    /// N_i at each point, one row a point.
    shapes: Vec<Vec<f64>>,
    /// ∂N_i/∂(ξ, η, ζ) at each point, one row a point.
    gradients: Vec<Vec<[f64; 3]>>,
}

impl ShapeTable {
    /// N_i and ∂N_i/∂(ξ, η, ζ) at natural points with these weights.
    pub fn new(
        points: Vec<([f64; 3], f64)>,
        shape_functions: impl Fn([f64; 3]) -> Vec<f64>,
        natural_gradients: impl Fn([f64; 3]) -> Vec<[f64; 3]>,
    ) -> Self {
        let at = points.iter().map(|(point, _)| *point);
        Self {
            shapes: at.clone().map(shape_functions).collect(),
            gradients: at.map(natural_gradients).collect(),
            points,
        }
    }

    /// Of each point the volume (m³) that it stands for, weight × Jacobian determinant, and the shape functions there.
    ///
    /// # Errors
    /// [`ElementError::JacobianNotPositive`], and [`ElementError::NodeCount`] where the coordinates (m) are not those
    /// of the kind.
    pub fn volumes(
        &self,
        coordinates: &[[f64; 3]],
    ) -> impl Iterator<Item = Result<(f64, &[f64]), ElementError>> {
        let rows = self.points.iter().zip(&self.gradients).zip(&self.shapes);
        rows.map(move |((&(point, weight), gradients), shape)| {
            Ok((
                weight * determinant(coordinates, gradients, point)?,
                shape.as_slice(),
            ))
        })
    }
}
