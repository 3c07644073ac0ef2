//! The eight-node hexahedron with three incompatible bending modes (QM6 in three dimensions).
//!
//! ```text
//! u = Σ N_i d_i + Σ_k (1 − ξ_k²) a_k          k = 1, 2, 3
//! ```
//!
//! The amplitudes a_k (nine per element) are inner unknowns, eliminated element by element:
//!
//! ```text
//! a = −K_aa⁻¹ K_au d        K = K_uu − K_ua K_aa⁻¹ K_au        ε = (B − G K_aa⁻¹ K_au) d
//! ```
//!
//! The modes give the element the quadratic sag of pure bending, which the plain brick replaces by a parasitic
//! shear ("locking"). Their gradients are taken with the inverse Jacobian at the centre and scaled by
//! |J(0)|/|J|: then ∫ G dV = 0, constant stress does no work on the modes, and the patch test passes on
//! distorted meshes.
//!
//! K_aa is positive definite wherever |J| > 0 at the Gauss points: zero strain of the modes at all eight points
//! needs every a_k to vanish, since the signs of ξ_k there separate the three modes.
//!
//! Sources: R. L. Taylor, P. J. Beresford, E. L. Wilson, *A non-conforming element for stress analysis*,
//! Int. J. Numer. Meth. Eng. 10 (1976) 1211-1219; E. L. Wilson, A. Ibrahimbegovic, *Use of incompatible
//! displacement modes for the calculation of element stiffnesses or stresses*, Finite Elem. Anal. Des. 7 (1990)
//! 229-241.

use nalgebra::SMatrix;

use crate::element_matrix::ElementMatrix;
use crate::error::ElementError;
use crate::hex8::{HexCoordinates, natural_gradients};
use crate::isoparametric::{Jacobian, point_gradients};
use crate::material::LameParameters;
use crate::quadrature::GAUSS_2;
use crate::stiffness_block::{
    BlockStiffness, StrainOperator, add_point_stiffness, compatible_strain_operator, strain_columns,
};

/// Rows per mode amplitude (3 modes x 3 directions), columns per nodal displacement.
type ModeMatrix = SMatrix<f64, 9, 24>;

/// Gradients (1/m) of the three modes 1 − ξ_k² at a natural point, by the Jacobian of the centre.
fn mode_gradients(natural: [f64; 3], determinant: f64, centre: &Jacobian) -> [[f64; 3]; 3] {
    let scale = centre.determinant / determinant;
    std::array::from_fn(|k| {
        let mut in_natural = [0.0; 3];
        in_natural[k] = -2.0 * natural[k] * scale;
        centre.to_physical(in_natural)
    })
}

/// The element before and during elimination of its modes.
struct Elimination {
    /// Blocks of the eight shape functions and, after them, the three modes.
    full: BlockStiffness<11>,
    /// Lower Cholesky factor L of K_aa.
    lower: SMatrix<f64, 9, 9>,
    /// L⁻¹ K_au.
    half_solved: ModeMatrix,
}

fn eliminate(
    coordinates: &HexCoordinates,
    lame: LameParameters,
) -> Result<Elimination, ElementError> {
    let centre = Jacobian::new(coordinates, &natural_gradients([0.0; 3]), [0.0; 3])?;
    let mut full = BlockStiffness::<11>::zero();
    // Every weight of the rule is 1.
    for (point, _) in GAUSS_2 {
        let at = point_gradients(coordinates, natural_gradients, point)?;
        let modes = mode_gradients(point, at.determinant, &centre);
        let gradients: [[f64; 3]; 11] =
            std::array::from_fn(|i| if i < 8 { at.gradients[i] } else { modes[i - 8] });
        add_point_stiffness(&mut full, &gradients, at.determinant, lame);
    }
    let k_aa = SMatrix::<f64, 9, 9>::from_fn(|i, j| full.entry(24 + i, 24 + j));
    let k_au = ModeMatrix::from_fn(|i, j| full.entry(24 + i, j));
    let lower = k_aa
        .cholesky()
        .ok_or(ElementError::ModesNotPositiveDefinite)?
        .l();
    let half_solved = lower
        .solve_lower_triangular(&k_au)
        .ok_or(ElementError::ModesNotPositiveDefinite)?;
    Ok(Elimination {
        full,
        lower,
        half_solved,
    })
}

/// Condensed stiffness K_uu − (L⁻¹K_au)ᵀ(L⁻¹K_au), symmetric to the last bit.
pub(crate) fn stiffness(
    coordinates: &HexCoordinates,
    lame: LameParameters,
) -> Result<ElementMatrix, ElementError> {
    let Elimination {
        full, half_solved, ..
    } = eliminate(coordinates, lame)?;
    Ok(ElementMatrix::from_upper(24, |i, j| {
        let condensed: f64 = (0..9)
            .map(|m| half_solved[(m, i)] * half_solved[(m, j)])
            .sum();
        full.entry(i, j) - condensed
    }))
}

/// Strain operator B − G K_aa⁻¹ K_au at a natural point: the strain that the condensed stiffness is the energy of.
pub(crate) fn strain_operator(
    coordinates: &HexCoordinates,
    lame: LameParameters,
    natural: [f64; 3],
) -> Result<StrainOperator, ElementError> {
    let Elimination {
        lower, half_solved, ..
    } = eliminate(coordinates, lame)?;
    let amplitudes: ModeMatrix = lower
        .tr_solve_lower_triangular(&half_solved)
        .ok_or(ElementError::ModesNotPositiveDefinite)?;
    let centre = Jacobian::new(coordinates, &natural_gradients([0.0; 3]), [0.0; 3])?;
    let at = point_gradients(coordinates, natural_gradients, natural)?;
    let modes = mode_gradients(natural, at.determinant, &centre);
    let mut b = compatible_strain_operator(&at.gradients);
    for (k, gradient) in modes.into_iter().enumerate() {
        for (row, columns) in strain_columns(gradient).into_iter().enumerate() {
            for (a, value) in columns.into_iter().enumerate() {
                for (j, entry) in b[row].iter_mut().enumerate() {
                    *entry -= value * amplitudes[(3 * k + a, j)];
                }
            }
        }
    }
    Ok(b)
}
