//! The elements on offer, by name: stiffness, strain operator and volume of one hexahedron.
//!
//! Degrees of freedom of an element: 3 i + a is the displacement of node i along axis a (x, y, z).

use crate::error::ElementError;
use crate::hex8::{CORNERS, GAUSS_POINTS, jacobian, point_gradients};
use crate::material::Material;
use crate::stiffness_block::strain_columns;
use crate::{hex8, hex8_incompatible};

/// Coordinates (m) of the eight nodes in VTK order.
pub type HexCoordinates = [[f64; 3]; 8];

/// Element stiffness (24x24, N/m).
pub type ElementStiffness = [[f64; 24]; 24];

/// Strain per nodal displacement (6x24, 1/m); rows xx, yy, zz, xy, yz, xz with engineering shear.
pub type StrainOperator = [[f64; 24]; 6];

/// Formulation of the hexahedron.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum HexElement {
    /// Trilinear displacement, 2x2x2 Gauss points. Locks in bending.
    Hex8,
    /// [`HexElement::Hex8`] with three condensed bending modes (QM6). No locking in bending; the default.
    #[default]
    Hex8Incompatible,
}

impl HexElement {
    /// Stiffness K = ∫ Bᵀ D B dV (24x24, N/m), symmetric to the last bit.
    ///
    /// # Errors
    /// [`ElementError::JacobianNotPositive`] at a Gauss point or the centre.
    pub fn stiffness(
        self,
        coordinates: &HexCoordinates,
        material: &Material,
    ) -> Result<ElementStiffness, ElementError> {
        match self {
            Self::Hex8 => {
                let blocks = hex8::stiffness(coordinates, material.lame())?;
                Ok(std::array::from_fn(|i| {
                    std::array::from_fn(|j| blocks.entry(i, j))
                }))
            }
            Self::Hex8Incompatible => hex8_incompatible::stiffness(coordinates, material.lame()),
        }
    }

    /// Strain operator at a natural point (6x24, 1/m): strain = operator · nodal displacements.
    ///
    /// For [`HexElement::Hex8Incompatible`] the condensed modes are included, so that
    /// K = Σ w |J| operatorᵀ D operator over the Gauss points holds for both elements.
    ///
    /// # Errors
    /// [`ElementError::JacobianNotPositive`] at the point, a Gauss point or the centre.
    pub fn strain_operator(
        self,
        coordinates: &HexCoordinates,
        material: &Material,
        natural: [f64; 3],
    ) -> Result<StrainOperator, ElementError> {
        match self {
            Self::Hex8 => Ok(compatible_strain_operator(
                &point_gradients(coordinates, natural)?.gradients,
            )),
            Self::Hex8Incompatible => {
                hex8_incompatible::strain_operator(coordinates, material.lame(), natural)
            }
        }
    }
}

/// Strain operator of the trilinear displacement from the gradients of its shape functions.
pub(crate) fn compatible_strain_operator(gradients: &[[f64; 3]; 8]) -> StrainOperator {
    let mut b = [[0.0; 24]; 6];
    for (i, gradient) in gradients.iter().enumerate() {
        for (row, columns) in strain_columns(*gradient).into_iter().enumerate() {
            b[row][3 * i..3 * i + 3].copy_from_slice(&columns);
        }
    }
    b
}

/// Volume (m³) of a trilinear hexahedron; the 2x2x2 Gauss rule is exact for it.
///
/// # Errors
/// [`ElementError::JacobianNotPositive`] at a Gauss point.
pub fn element_volume(coordinates: &HexCoordinates) -> Result<f64, ElementError> {
    GAUSS_POINTS
        .iter()
        .map(|p| Ok(jacobian(coordinates, *p)?.determinant))
        .sum()
}

/// Checks that the Jacobian is positive at the Gauss points, the corners and the centre.
///
/// The Gauss points and the centre are where the stiffness needs it, the corners are where strain is read at a
/// surface and where a bad shape shows first.
pub(crate) fn check_shape(coordinates: &HexCoordinates) -> Result<(), ElementError> {
    for point in GAUSS_POINTS.iter().chain(&CORNERS).chain(&[[0.0; 3]]) {
        jacobian(coordinates, *point)?;
    }
    Ok(())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn distorted() -> HexCoordinates {
        let mut x = CORNERS.map(|c| c.map(|v| 0.01 * v));
        x[6] = [0.014, 0.012, 0.013];
        x[1] = [0.009, -0.012, -0.008];
        x[3] = [-0.011, 0.008, -0.012];
        x
    }

    /// Conformance of every element: K = Σ |J| Bᵀ D B with its own strain operator. For the incompatible element
    /// this ties strain recovery to the condensed stiffness.
    #[test]
    fn stiffness_is_the_energy_of_the_strain_operator() {
        let material = Material::new(210e9, 0.3).unwrap();
        let x = distorted();
        for element in [HexElement::Hex8, HexElement::Hex8Incompatible] {
            let k = element.stiffness(&x, &material).unwrap();
            let mut energy = [[0.0; 24]; 24];
            for p in GAUSS_POINTS {
                let b = element.strain_operator(&x, &material, p).unwrap();
                let w = point_gradients(&x, p).unwrap().determinant;
                for j in 0..24 {
                    let stress = material.stress(&std::array::from_fn(|r| b[r][j]));
                    for (i, row) in energy.iter_mut().enumerate() {
                        row[j] += w * (0..6).map(|r| b[r][i] * stress[r]).sum::<f64>();
                    }
                }
            }
            let scale = k.iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
            for i in 0..24 {
                for j in 0..24 {
                    assert!(
                        (k[i][j] - energy[i][j]).abs() < 1e-13 * scale,
                        "{element:?} {i} {j}"
                    );
                    assert_eq!(k[i][j].to_bits(), k[j][i].to_bits());
                }
            }
        }
    }

    /// The modes only ever soften: K_hex8 − K_incompatible is positive semidefinite, here on the diagonal.
    #[test]
    fn incompatible_modes_soften() {
        let material = Material::new(210e9, 0.3).unwrap();
        let x = distorted();
        let plain = HexElement::Hex8.stiffness(&x, &material).unwrap();
        let soft = HexElement::Hex8Incompatible
            .stiffness(&x, &material)
            .unwrap();
        for i in 0..24 {
            assert!(soft[i][i] < plain[i][i]);
        }
    }

    #[test]
    fn volume_of_a_cube_and_of_a_frustum() {
        let cube = CORNERS.map(|c| c.map(|v| 0.5 * v));
        assert!((element_volume(&cube).unwrap() - 1.0).abs() < 1e-14);
        // Square frustum, sides 2 and 1, height 3: V = h/3 (A + B + sqrt(AB)) = 7.
        let frustum = CORNERS.map(|c| {
            let half = if c[2] < 0.0 { 1.0 } else { 0.5 };
            [half * c[0], half * c[1], 1.5 * c[2]]
        });
        assert!((element_volume(&frustum).unwrap() - 7.0).abs() < 1e-13);
    }
}
