//! Stiffness, strain operator, mass and volume of one hexahedron, tetrahedron or wedge.
//!
//! Degrees of freedom of an element: 3 i + a is the displacement of node i along axis a (x, y, z).

use gearmesh_elements::Element;

use crate::element_matrix::ElementMatrix;
use crate::error::ElementError;
use crate::isoparametric::{determinant, point_gradients, stiffness};
use crate::material::Material;
use crate::quadrature::{GAUSS_2, GAUSS_3, TET_8, TET_14, WEDGE_6, WEDGE_18, WeightedPoint};
use crate::shape_table::ShapeTable;
use crate::stiffness_block::strain_columns;
use crate::{hex8, hex8_incompatible, hex20, tet10, wedge6, wedge15};

/// Strain per nodal displacement (1/m): rows xx, yy, zz, xy, yz, xz with engineering shear, `operator[row][3 i + a]`.
pub type StrainOperator = [Vec<f64>; 6];

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
        crate::mass::mass_of(self, coordinates, density_kg_per_m3)
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

/// Strain operator of the displacement Σ N_i d_i from the gradients of its shape functions.
pub(crate) fn compatible_strain_operator(gradients: &[[f64; 3]]) -> StrainOperator {
    let mut b = std::array::from_fn(|_| Vec::with_capacity(3 * gradients.len()));
    for gradient in gradients {
        for (row, columns) in b.iter_mut().zip(strain_columns(*gradient)) {
            row.extend(columns);
        }
    }
    b
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::hex8::CORNERS;

    /// A distorted element; its edges are bent where it has nodes on them.
    fn distorted(element: Element) -> Vec<[f64; 3]> {
        let moved = |k: usize| 0.06 * (1.7 * k as f64 + 0.4).sin();
        let nodes = element.natural_nodes().iter().enumerate();
        nodes
            .map(|(i, x)| std::array::from_fn(|axis| 0.01 * (x[axis] + moved(3 * i + axis))))
            .collect()
    }

    /// Conformance of every element: N_i is 1 at node i and 0 at the others, the N sum to 1, and the corners' mean is
    /// the centre.
    #[test]
    fn shape_functions_are_nodal_and_sum_to_one() {
        for element in Element::ALL {
            for (i, node) in element.natural_nodes().iter().enumerate() {
                for (j, value) in element.shape_functions(*node).iter().enumerate() {
                    assert!(
                        (value - f64::from(u8::from(i == j))).abs() < 1e-15,
                        "{element:?}"
                    );
                }
            }
            let sum: f64 = element.shape_functions([0.3, 0.1, -0.7]).iter().sum();
            assert!((sum - 1.0).abs() < 1e-14);
            let corners = element.cell().corner_count();
            for axis in 0..3 {
                let nodes = &element.natural_nodes()[..corners];
                let mean = nodes.iter().map(|x| x[axis]).sum::<f64>() / corners as f64;
                assert!((mean - element.centre()[axis]).abs() < 1e-15);
            }
        }
    }

    /// The Jacobian is the derivative of the position: its determinant equals that of central differences.
    #[test]
    fn gradients_equal_central_differences() {
        let step = 1e-5;
        for element in Element::ALL {
            let x = distorted(element);
            let at = [0.2, 0.3, 0.25];
            let column = |k: usize| -> [f64; 3] {
                let (mut plus, mut minus) = (at, at);
                plus[k] += step;
                minus[k] -= step;
                let (p, m) = (
                    element.position_at(&x, plus),
                    element.position_at(&x, minus),
                );
                std::array::from_fn(|i| (p[i] - m[i]) / (2.0 * step))
            };
            let [a, b, c] = [column(0), column(1), column(2)];
            let determinant = a[0] * (b[1] * c[2] - b[2] * c[1])
                - a[1] * (b[0] * c[2] - b[2] * c[0])
                + a[2] * (b[0] * c[1] - b[1] * c[0]);
            let found = element.jacobian_determinant(&x, at).unwrap();
            // No third derivative along one axis: rounding only, about 1e-16/step.
            assert!((found / determinant - 1.0).abs() < 1e-9, "{element:?}");
            let material = Material::new(210e9, 0.3).unwrap();
            // Each column of the strain operator is the gradient of its shape function: read from the field x_j.
            let b = element.strain_operator(&x, &material, at).unwrap();
            for axis in 0..3 {
                let stretch: f64 = (0..x.len())
                    .map(|i| b[axis][3 * i + axis] * x[i][axis])
                    .sum();
                assert!((stretch - 1.0).abs() < 1e-12);
            }
        }
    }

    /// The faces close the element and face outwards: the volume is ∮ x·n dA/3, here by the corners' polygons.
    #[test]
    fn faces_are_closed_and_face_outwards() {
        for element in Element::ALL {
            let x = element.natural_nodes();
            let mut flux = 0.0;
            let mut edges = std::collections::BTreeMap::<[usize; 2], i32>::new();
            for face in element.faces() {
                let corners = if matches!(face.len(), 3 | 6) { 3 } else { 4 };
                for k in 0..corners {
                    let (a, b) = (face[k], face[(k + 1) % corners]);
                    *edges.entry([a.min(b), a.max(b)]).or_default() += if a < b { 1 } else { -1 };
                    if face.len() > corners {
                        let middle = x[face[corners + k]];
                        for axis in 0..3 {
                            assert!((middle[axis] - 0.5 * (x[a][axis] + x[b][axis])).abs() < 1e-15);
                        }
                    }
                }
                for k in 1..corners - 1 {
                    let [p, q, r] = [x[face[0]], x[face[k]], x[face[k + 1]]];
                    flux += p[0] * (q[1] * r[2] - q[2] * r[1]) - p[1] * (q[0] * r[2] - q[2] * r[0])
                        + p[2] * (q[0] * r[1] - q[1] * r[0]);
                }
            }
            // Every edge is run through once in each direction.
            assert!(edges.values().all(|sum| *sum == 0), "{element:?}");
            let volume: f64 = element.integration_points().iter().map(|p| p.1).sum();
            assert!((flux / 6.0 - volume).abs() < 1e-14, "{element:?}");
        }
    }

    /// Conformance of every element: K = Σ |J| Bᵀ D B with its own strain operator. For the incompatible element
    /// this ties strain recovery to the condensed stiffness.
    #[test]
    fn stiffness_is_the_energy_of_the_strain_operator() {
        let material = Material::new(210e9, 0.3).unwrap();
        for element in Element::ALL {
            let x = distorted(element);
            let k = element.stiffness(&x, &material).unwrap();
            let n = k.size();
            assert_eq!(n, 3 * element.node_count());
            let mut energy = vec![0.0; n * n];
            let mut largest = 0.0_f64;
            for (point, weight) in element.integration_points() {
                let b = element.strain_operator(&x, &material, *point).unwrap();
                let w = weight * element.jacobian_determinant(&x, *point).unwrap();
                for j in 0..n {
                    let stress = material.stress(&std::array::from_fn(|r| b[r][j]));
                    for i in 0..n {
                        energy[i * n + j] += w * (0..6).map(|r| b[r][i] * stress[r]).sum::<f64>();
                        largest = largest.max(energy[i * n + j].abs());
                    }
                }
            }
            for i in 0..n {
                for j in 0..n {
                    assert!(
                        (k[(i, j)] - energy[i * n + j]).abs() < 1e-13 * largest,
                        "{element:?} {i} {j}"
                    );
                }
            }
        }
    }

    /// The modes only ever soften: K_hex8 − K_incompatible is positive semidefinite, here on the diagonal.
    #[test]
    fn incompatible_modes_soften() {
        let material = Material::new(210e9, 0.3).unwrap();
        let x = distorted(Element::Hex8);
        let plain = Element::Hex8.stiffness(&x, &material).unwrap();
        let soft = Element::Hex8Incompatible.stiffness(&x, &material).unwrap();
        for i in 0..24 {
            assert!(soft[(i, i)] < plain[(i, i)]);
        }
    }

    /// The frustum of the reference shape, its section scaled to one half from bottom to top: ∫ (3/4 − t/4)² dt over
    /// −1 < t < 1 is 7/6 of a section for prisms. Straight edges: exact.
    #[test]
    fn volume_of_the_reference_shape_and_of_a_frustum() {
        for element in Element::ALL {
            let nodes = element.natural_nodes();
            let whole: f64 = element.mass_points().iter().map(|p| p.1).sum();
            assert!((element.volume(nodes).unwrap() / whole - 1.0).abs() < 1e-14);
            if element == Element::Tet10 {
                continue;
            }
            let frustum: Vec<_> = nodes
                .iter()
                .map(|c| {
                    let scale = 0.75 - 0.25 * c[2];
                    [scale * c[0], scale * c[1], c[2]]
                })
                .collect();
            let expected = 7.0 / 12.0 * whole;
            assert!((element.volume(&frustum).unwrap() / expected - 1.0).abs() < 1e-13);
        }
    }

    #[test]
    fn another_number_of_nodes_is_refused() {
        assert_eq!(
            Element::Hex20.volume(&CORNERS),
            Err(ElementError::NodeCount {
                found: 8,
                expected: 20
            })
        );
    }
}
