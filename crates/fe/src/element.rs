//! The elements on offer, by name: stiffness, strain operator, volume of one hexahedron.
//!
//! Degrees of freedom of an element: 3 i + a is the displacement of node i along axis a (x, y, z).

use crate::element_matrix::ElementMatrix;
use crate::error::ElementError;
use crate::material::Material;
use crate::quadrature::{GAUSS_2, GAUSS_3, WeightedPoint};
use crate::stiffness_block::strain_columns;
use crate::{hex8, hex8_incompatible, hex20};

/// Strain per nodal displacement (1/m): rows xx, yy, zz, xy, yz, xz with engineering shear, `operator[row][3 i + a]`.
pub type StrainOperator = [Vec<f64>; 6];

/// Formulation of the hexahedron.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum HexElement {
    /// Eight nodes, trilinear displacement, 2×2×2 Gauss points. Locks in bending.
    Hex8,
    /// [`HexElement::Hex8`] with three condensed bending modes (QM6). No locking in bending; the default.
    #[default]
    Hex8Incompatible,
    /// Twenty nodes, quadratic displacement and edges (serendipity), 3×3×3 Gauss points.
    Hex20,
}

impl HexElement {
    /// Every formulation.
    pub const ALL: [Self; 3] = [Self::Hex8, Self::Hex8Incompatible, Self::Hex20];

    /// The name in files and messages.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Hex8 => "hex8",
            Self::Hex8Incompatible => "hex8-incompatible",
            Self::Hex20 => "hex20",
        }
    }

    /// The formulation with this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|e| e.name() == name)
    }

    /// Number of nodes, 8 or 20.
    pub const fn node_count(self) -> usize {
        self.natural_nodes().len()
    }

    /// Natural coordinates of the nodes in VTK order; the corners are the first eight.
    pub const fn natural_nodes(self) -> &'static [[f64; 3]] {
        match self {
            Self::Hex8 | Self::Hex8Incompatible => &hex8::CORNERS,
            Self::Hex20 => &hex20::NODES,
        }
    }

    /// The Gauss points of the stiffness with their weights, which sum to 8.
    pub const fn integration_points(self) -> &'static [WeightedPoint] {
        match self {
            Self::Hex8 | Self::Hex8Incompatible => &GAUSS_2,
            Self::Hex20 => &GAUSS_3,
        }
    }

    /// Shape functions at a natural point, one per node; the condensed modes are not among them.
    pub fn shape_functions(self, natural: [f64; 3]) -> Vec<f64> {
        match self {
            Self::Hex8 | Self::Hex8Incompatible => hex8::shape_functions(natural).to_vec(),
            Self::Hex20 => hex20::shape_functions(natural).to_vec(),
        }
    }

    /// Position (m) of a natural point: x = Σ N_i x_i.
    pub fn position_at(self, coordinates: &[[f64; 3]], natural: [f64; 3]) -> [f64; 3] {
        let n = self.shape_functions(natural);
        std::array::from_fn(|k| n.iter().zip(coordinates).map(|(n, x)| n * x[k]).sum())
    }

    /// Jacobian determinant (m³) at a natural point: volume per unit of natural volume.
    ///
    /// # Errors
    /// [`ElementError::JacobianNotPositive`]; [`ElementError::NodeCount`].
    pub fn jacobian_determinant(
        self,
        coordinates: &[[f64; 3]],
        natural: [f64; 3],
    ) -> Result<f64, ElementError> {
        match self {
            Self::Hex8 | Self::Hex8Incompatible => {
                Ok(hex8::jacobian(nodes(coordinates)?, natural)?.determinant)
            }
            Self::Hex20 => Ok(hex20::jacobian(nodes(coordinates)?, natural)?.determinant),
        }
    }

    /// Volume (m³). The rule of the stiffness is exact where edges are straight.
    ///
    /// # Errors
    /// As [`HexElement::jacobian_determinant`], at a Gauss point.
    pub fn volume(self, coordinates: &[[f64; 3]]) -> Result<f64, ElementError> {
        self.integration_points()
            .iter()
            .map(|(point, weight)| Ok(weight * self.jacobian_determinant(coordinates, *point)?))
            .sum()
    }

    /// Stiffness K = ∫ Bᵀ D B dV (N/m) from the coordinates (m) of the nodes.
    ///
    /// # Errors
    /// [`ElementError::JacobianNotPositive`] at a Gauss point or the centre; [`ElementError::NodeCount`].
    pub fn stiffness(
        self,
        coordinates: &[[f64; 3]],
        material: &Material,
    ) -> Result<ElementMatrix, ElementError> {
        let (lame, rule) = (material.lame(), self.integration_points());
        match self {
            Self::Hex8 => {
                let blocks = hex8::stiffness(nodes(coordinates)?, lame, rule)?;
                Ok(ElementMatrix::from_upper(24, |i, j| blocks.entry(i, j)))
            }
            Self::Hex8Incompatible => hex8_incompatible::stiffness(nodes(coordinates)?, lame),
            Self::Hex20 => {
                let blocks = hex20::stiffness(nodes(coordinates)?, lame, rule)?;
                Ok(ElementMatrix::from_upper(60, |i, j| blocks.entry(i, j)))
            }
        }
    }

    /// Strain operator (6 × 3 nodes, 1/m) at a natural point: strain = operator · nodal displacements.
    ///
    /// For [`HexElement::Hex8Incompatible`] the condensed modes are included, so that
    /// K = Σ w |J| operatorᵀ D operator over the Gauss points holds for every element.
    ///
    /// # Errors
    /// [`ElementError::JacobianNotPositive`] at the point, and for the incompatible element at a Gauss point or the
    /// centre; [`ElementError::NodeCount`].
    pub fn strain_operator(
        self,
        coordinates: &[[f64; 3]],
        material: &Material,
        natural: [f64; 3],
    ) -> Result<StrainOperator, ElementError> {
        match self {
            Self::Hex8 => {
                let at = hex8::point_gradients(nodes(coordinates)?, natural)?;
                Ok(compatible_strain_operator(&at.gradients))
            }
            Self::Hex8Incompatible => {
                hex8_incompatible::strain_operator(nodes(coordinates)?, material.lame(), natural)
            }
            Self::Hex20 => {
                let at = hex20::point_gradients(nodes(coordinates)?, natural)?;
                Ok(compatible_strain_operator(&at.gradients))
            }
        }
    }

    /// Checks that the Jacobian is positive at the Gauss points, the nodes and the centre.
    ///
    /// The Gauss points and the centre are where the stiffness needs it, the nodes are where strain is read at a
    /// surface and where a bad shape shows first.
    pub(crate) fn check_shape(self, coordinates: &[[f64; 3]]) -> Result<(), ElementError> {
        let gauss = self.integration_points().iter().map(|(point, _)| point);
        for point in gauss.chain(self.natural_nodes()).chain(&[[0.0; 3]]) {
            self.jacobian_determinant(coordinates, *point)?;
        }
        Ok(())
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
    use crate::hex20::EDGE_CORNERS;

    /// A distorted hexahedron; with twenty nodes its edges are bent too.
    fn distorted(element: HexElement) -> Vec<[f64; 3]> {
        let mut x = CORNERS.map(|c| c.map(|v| 0.01 * v)).to_vec();
        x[6] = [0.014, 0.012, 0.013];
        x[1] = [0.009, -0.012, -0.008];
        x[3] = [-0.011, 0.008, -0.012];
        if element == HexElement::Hex20 {
            for (k, [a, b]) in EDGE_CORNERS.into_iter().enumerate() {
                x.push(std::array::from_fn(|axis| {
                    0.5 * (x[a][axis] + x[b][axis]) + 0.001 * ((3 * k + axis) as f64).sin()
                }));
            }
        }
        x
    }

    /// Conformance of every element: K = Σ |J| Bᵀ D B with its own strain operator. For the incompatible element
    /// this ties strain recovery to the condensed stiffness.
    #[test]
    fn stiffness_is_the_energy_of_the_strain_operator() {
        let material = Material::new(210e9, 0.3).unwrap();
        for element in HexElement::ALL {
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
        let x = distorted(HexElement::Hex8);
        let plain = HexElement::Hex8.stiffness(&x, &material).unwrap();
        let soft = HexElement::Hex8Incompatible
            .stiffness(&x, &material)
            .unwrap();
        for i in 0..24 {
            assert!(soft[(i, i)] < plain[(i, i)]);
        }
    }

    #[test]
    fn volume_of_a_cube_and_of_a_frustum() {
        for element in HexElement::ALL {
            let nodes = element.natural_nodes();
            let cube: Vec<_> = nodes.iter().map(|c| c.map(|v| 0.5 * v)).collect();
            assert!((element.volume(&cube).unwrap() - 1.0).abs() < 1e-14);
            // Square frustum, sides 2 and 1, height 3: V = h/3 (A + B + sqrt(AB)) = 7.
            let frustum: Vec<_> = nodes
                .iter()
                .map(|c| {
                    let half = 0.75 - 0.25 * c[2];
                    [half * c[0], half * c[1], 1.5 * c[2]]
                })
                .collect();
            assert!((element.volume(&frustum).unwrap() - 7.0).abs() < 1e-13);
        }
    }

    #[test]
    fn another_number_of_nodes_is_refused() {
        assert_eq!(
            HexElement::Hex20.volume(&CORNERS),
            Err(ElementError::NodeCount {
                found: 8,
                expected: 20
            })
        );
    }

    #[test]
    fn names_lead_back() {
        for element in HexElement::ALL {
            assert_eq!(HexElement::from_name(element.name()), Some(element));
        }
        assert_eq!(HexElement::from_name("hex9"), None);
    }
}
