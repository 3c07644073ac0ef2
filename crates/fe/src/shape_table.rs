//! Shape functions and their gradients at the fixed points of a kind of element, made once for all its elements.

use gearmesh_elements::Element;
use std::sync::LazyLock;

use crate::element::ElementFormulas;
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

/// Of the points of the mass, [`ElementFormulas::mass_points`], by kind.
static OF_MASS: LazyLock<[ShapeTable; Element::ALL.len()]> =
    LazyLock::new(|| Element::ALL.map(|kind| ShapeTable::new(kind, kind.mass_points().to_vec())));

/// Of the points where a Jacobian must be positive, [`ElementFormulas::check_shape`], by kind.
static OF_CHECK: LazyLock<[ShapeTable; Element::ALL.len()]> = LazyLock::new(|| {
    Element::ALL.map(|kind| {
        let gauss = kind.integration_points().iter().map(|(point, _)| *point);
        let others = kind.natural_nodes().iter().copied().chain([kind.centre()]);
        let points = gauss.chain(others).map(|point| (point, 0.0));
        ShapeTable::new(kind, points.collect())
    })
});

impl ShapeTable {
    fn new(kind: Element, points: Vec<([f64; 3], f64)>) -> Self {
        let at = points.iter().map(|(point, _)| *point);
        Self {
            shapes: at.clone().map(|at| kind.shape_functions(at)).collect(),
            gradients: at.map(|at| kind.natural_gradients(at)).collect(),
            points,
        }
    }

    /// The points of the mass of a kind.
    pub fn of_mass(kind: Element) -> &'static Self {
        &OF_MASS[kind as usize]
    }

    /// The points where the Jacobian of a kind must be positive.
    pub fn of_check(kind: Element) -> &'static Self {
        &OF_CHECK[kind as usize]
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
