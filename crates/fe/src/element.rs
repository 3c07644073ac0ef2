//! Stiffness, strain operator, mass and volume of one hexahedron, tetrahedron or wedge.
//!
//! Degrees of freedom of an element: 3 i + a is the displacement of node i along axis a (x, y, z).

use gearmesh_elements::Element;
use std::sync::LazyLock;

use crate::element_matrix::ElementMatrix;
use crate::error::ElementError;
use crate::isoparametric::{determinant, point_gradients, stiffness};
use crate::material::Material;
use crate::quadrature::{GAUSS_2, GAUSS_3, TET_8, TET_14, WEDGE_6, WEDGE_18, WeightedPoint};
use crate::shape_table::ShapeTable;
use crate::stiffness_block::{StrainOperator, compatible_strain_operator};
use crate::{hex8, hex8_incompatible, hex20, tet10, wedge6, wedge15};

/// Evaluates an expression with the module that has the shape functions of an element.
macro_rules! with_shape {
    ($element:expr, $shape:ident => $value:expr) => {
        match $element {
            Element::Hex8 | Element::Hex8Incompatible => {
                use crate::hex8 as $shape;
                $value
            }
            Element::Hex20 => {
                use crate::hex20 as $shape;
                $value
            }
            Element::Tet10 => {
                use crate::tet10 as $shape;
                $value
            }
            Element::Wedge6 => {
                use crate::wedge6 as $shape;
                $value
            }
            Element::Wedge15 => {
                use crate::wedge15 as $shape;
                $value
            }
        }
    };
}

/// What a finite element computes from its nodes.
pub trait ElementFormulas: Sized {
    /// Natural coordinates of the nodes in VTK order, corners first.
    fn natural_nodes(self) -> &'static [[f64; 3]];

    /// Natural coordinates of the centre: the mean of the corners.
    fn centre(self) -> [f64; 3];

    /// The nodes of each face: corners counter-clockwise seen from outside, then the nodes on the edges between them in
    /// the same order.
    fn faces(self) -> &'static [&'static [usize]];

    /// The points of the stiffness with their weights, which sum to the volume of the reference shape.
    fn integration_points(self) -> &'static [WeightedPoint];

    /// The points of the mass, exact where edges are straight (wedges: where the element is a prism), also for
    /// integrals of smooth functions against the shape functions.
    fn mass_points(self) -> &'static [WeightedPoint];

    /// Shape functions at a natural point, one per node; the condensed modes are not among them.
    fn shape_functions(self, natural: [f64; 3]) -> Vec<f64>;

    /// ∂N_i/∂(ξ, η, ζ) at a natural point, one per node; the condensed modes are not among them.
    fn natural_gradients(self, natural: [f64; 3]) -> Vec<[f64; 3]>;

    /// Position (m) of a natural point: x = Σ N_i x_i.
    fn position_at(self, coordinates: &[[f64; 3]], natural: [f64; 3]) -> [f64; 3];

    /// Jacobian determinant (m³) at a natural point: volume per unit of natural volume.
    ///
    /// # Errors
    /// [`ElementError::JacobianNotPositive`]; [`ElementError::NodeCount`].
    fn jacobian_determinant(
        self,
        coordinates: &[[f64; 3]],
        natural: [f64; 3],
    ) -> Result<f64, ElementError>;

    /// Volume (m³). The rule of the stiffness is exact where edges are straight, and for curved tetrahedra.
    ///
    /// # Errors
    /// As [`ElementFormulas::jacobian_determinant`], at a Gauss point.
    fn volume(self, coordinates: &[[f64; 3]]) -> Result<f64, ElementError>;

    /// Stiffness K = ∫ Bᵀ D B dV (N/m) from the coordinates (m) of the nodes.
    ///
    /// # Errors
    /// [`ElementError::JacobianNotPositive`] at a Gauss point or the centre; [`ElementError::NodeCount`].
    fn stiffness(
        self,
        coordinates: &[[f64; 3]],
        material: &Material,
    ) -> Result<ElementMatrix, ElementError>;

    /// Strain operator (6 × 3 nodes, 1/m) at a natural point: strain = operator · nodal displacements.
    ///
    /// For [`Element::Hex8Incompatible`] the condensed modes are included, so that
    /// K = Σ w |J| operatorᵀ D operator over the Gauss points holds for every element.
    ///
    /// # Errors
    /// [`ElementError::JacobianNotPositive`] at the point, and for the incompatible element at a Gauss point or the
    /// centre; [`ElementError::NodeCount`].
    fn strain_operator(
        self,
        coordinates: &[[f64; 3]],
        material: &Material,
        natural: [f64; 3],
    ) -> Result<StrainOperator, ElementError>;

    /// Checks that the Jacobian is positive at the Gauss points, the nodes and the centre.
    ///
    /// The Gauss points and the centre are where the stiffness needs it, the nodes are where strain is read at a
    /// surface and where a bad shape shows first.
    fn check_shape(self, coordinates: &[[f64; 3]]) -> Result<(), ElementError>;

    /// Mass (kg) from the coordinates (m) of the nodes and the density ρ (kg/m³).
    ///
    /// # Errors
    /// [`ElementError::JacobianNotPositive`] at a Gauss point; [`ElementError::NodeCount`].
    fn mass(
        self,
        coordinates: &[[f64; 3]],
        density_kg_per_m3: f64,
    ) -> Result<ElementMatrix, ElementError>;
}

impl ElementFormulas for Element {
    fn natural_nodes(self) -> &'static [[f64; 3]] {
        with_shape!(self, shape => &shape::NODES)
    }

    fn centre(self) -> [f64; 3] {
        match self {
            Self::Hex8 | Self::Hex8Incompatible | Self::Hex20 => [0.0; 3],
            Self::Tet10 => [0.25; 3],
            Self::Wedge6 | Self::Wedge15 => [1.0 / 3.0, 1.0 / 3.0, 0.0],
        }
    }

    fn faces(self) -> &'static [&'static [usize]] {
        match self {
            Self::Hex8 | Self::Hex8Incompatible => &hex8::FACES,
            Self::Hex20 => &hex20::FACES,
            Self::Tet10 => &tet10::FACES,
            Self::Wedge6 => &wedge6::FACES,
            Self::Wedge15 => &wedge15::FACES,
        }
    }

    fn integration_points(self) -> &'static [WeightedPoint] {
        match self {
            Self::Hex8 | Self::Hex8Incompatible => &GAUSS_2,
            Self::Hex20 => &GAUSS_3,
            Self::Tet10 => &TET_8,
            Self::Wedge6 => &WEDGE_6,
            Self::Wedge15 => &WEDGE_18,
        }
    }

    fn mass_points(self) -> &'static [WeightedPoint] {
        match self {
            Self::Hex8 | Self::Hex8Incompatible | Self::Hex20 => &GAUSS_3,
            Self::Tet10 => &TET_14,
            Self::Wedge6 | Self::Wedge15 => &WEDGE_18,
        }
    }

    fn shape_functions(self, natural: [f64; 3]) -> Vec<f64> {
        with_shape!(self, shape => shape::shape_functions(natural).to_vec())
    }

    fn natural_gradients(self, natural: [f64; 3]) -> Vec<[f64; 3]> {
        with_shape!(self, shape => shape::natural_gradients(natural).to_vec())
    }

    fn position_at(self, coordinates: &[[f64; 3]], natural: [f64; 3]) -> [f64; 3] {
        let n = self.shape_functions(natural);
        std::array::from_fn(|k| n.iter().zip(coordinates).map(|(n, x)| n * x[k]).sum())
    }

    fn jacobian_determinant(
        self,
        coordinates: &[[f64; 3]],
        natural: [f64; 3],
    ) -> Result<f64, ElementError> {
        with_shape!(self, shape => determinant(coordinates, &shape::natural_gradients(natural), natural))
    }

    fn volume(self, coordinates: &[[f64; 3]]) -> Result<f64, ElementError> {
        self.integration_points()
            .iter()
            .map(|(point, weight)| Ok(weight * self.jacobian_determinant(coordinates, *point)?))
            .sum()
    }

    fn stiffness(
        self,
        coordinates: &[[f64; 3]],
        material: &Material,
    ) -> Result<ElementMatrix, ElementError> {
        if self == Self::Hex8Incompatible {
            return hex8_incompatible::stiffness(nodes(coordinates)?, material.lame());
        }
        let (lame, rule) = (material.lame(), self.integration_points());
        with_shape!(self, shape => {
            let blocks = stiffness(nodes(coordinates)?, shape::natural_gradients, lame, rule)?;
            let size = 3 * self.node_count();
            Ok(ElementMatrix::from_upper(size, |i, j| blocks.entry(i, j)))
        })
    }

    fn strain_operator(
        self,
        coordinates: &[[f64; 3]],
        material: &Material,
        natural: [f64; 3],
    ) -> Result<StrainOperator, ElementError> {
        if self == Self::Hex8Incompatible {
            let nodes = nodes(coordinates)?;
            return hex8_incompatible::strain_operator(nodes, material.lame(), natural);
        }
        with_shape!(self, shape => {
            let at = point_gradients(nodes(coordinates)?, shape::natural_gradients, natural)?;
            Ok(compatible_strain_operator(&at.gradients))
        })
    }

    fn check_shape(self, coordinates: &[[f64; 3]]) -> Result<(), ElementError> {
        let mut volumes = ShapeTable::of_check(self).volumes(coordinates);
        volumes.try_for_each(|volume| volume.map(drop))
    }

    fn mass(
        self,
        coordinates: &[[f64; 3]],
        density_kg_per_m3: f64,
    ) -> Result<ElementMatrix, ElementError> {
        let n = self.node_count();
        let mut scalar = vec![0.0; n * n];
        for found in ShapeTable::of_mass(self).volumes(coordinates) {
            let (volume, shape) = found?;
            for i in 0..n {
                let share = density_kg_per_m3 * volume * shape[i];
                for j in i..n {
                    scalar[i * n + j] += share * shape[j];
                }
            }
        }
        Ok(ElementMatrix::from_upper(3 * n, |i, j| {
            if i % 3 == j % 3 {
                scalar[i / 3 * n + j / 3]
            } else {
                0.0
            }
        }))
    }
}

/// Of the points of the mass, [`ElementFormulas::mass_points`], by kind.
static OF_MASS: LazyLock<[ShapeTable; Element::ALL.len()]> = LazyLock::new(|| {
    Element::ALL.map(|kind| ShapeTable::of_kind(kind, kind.mass_points().to_vec()))
});

/// Of the points where a Jacobian must be positive, [`ElementFormulas::check_shape`], by kind.
static OF_CHECK: LazyLock<[ShapeTable; Element::ALL.len()]> = LazyLock::new(|| {
    Element::ALL.map(|kind| {
        let gauss = kind.integration_points().iter().map(|(point, _)| *point);
        let others = kind.natural_nodes().iter().copied().chain([kind.centre()]);
        let points = gauss.chain(others).map(|point| (point, 0.0));
        ShapeTable::of_kind(kind, points.collect())
    })
});

impl ShapeTable {
    /// The table of a kind at natural points with these weights.
    fn of_kind(kind: Element, points: Vec<([f64; 3], f64)>) -> Self {
        Self::new(
            points,
            |at| kind.shape_functions(at),
            |at| kind.natural_gradients(at),
        )
    }

    /// The points of the mass of a kind.
    pub fn of_mass(kind: Element) -> &'static Self {
        &OF_MASS[kind as usize]
    }

    /// The points where the Jacobian of a kind must be positive.
    pub fn of_check(kind: Element) -> &'static Self {
        &OF_CHECK[kind as usize]
    }
}

/// The coordinates as an array of the length an element needs.
pub(crate) fn nodes<const N: usize>(
    coordinates: &[[f64; 3]],
) -> Result<&[[f64; 3]; N], ElementError> {
    coordinates.try_into().map_err(|_| ElementError::NodeCount {
        found: coordinates.len(),
        expected: N,
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    /// The mass of the trilinear brick of volume V: ρV/27 at a node with itself, half as much for each step along an
    /// edge (Hughes 1987, section 7.3).
    #[test]
    fn mass_of_a_brick_in_closed_form() {
        let element = Element::Hex8;
        let coordinates: Vec<_> = element
            .natural_nodes()
            .iter()
            .map(|c| [0.5 * c[0], 1.0 * c[1], 1.5 * c[2]])
            .collect();
        let m = element.mass(&coordinates, 27.0 / 6.0).unwrap();
        for i in 0..24 {
            for j in 0..24 {
                let (a, b) = (coordinates[i / 3], coordinates[j / 3]);
                let steps = (0..3).filter(|k| a[*k] != b[*k]).count();
                let expected = if i % 3 == j % 3 {
                    0.5_f64.powi(steps as i32)
                } else {
                    0.0
                };
                assert!((m[(i, j)] - expected).abs() < 1e-14, "{i} {j}");
            }
        }
    }
}
