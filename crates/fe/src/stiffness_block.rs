//! Stiffness, as 3x3 blocks for isotropic material, and strain operator of a set of scalar functions times three
//! directions.
//!
//! For the vector functions N_i e_a and N_j e_b, with gradients g_i and g_j, the integrand of the stiffness is
//!
//! ```text
//! k_ij[a][b] = λ g_i[a] g_j[b] + μ g_j[a] g_i[b] + μ δ_ab g_i·g_j
//! ```
//!
//! which is Bᵀ D B written out for σ = λ tr(ε) I + 2 μ ε, at a fifth of the operations.

use crate::material::LameParameters;

/// Strain per nodal displacement (1/m): rows xx, yy, zz, xy, yz, xz with engineering shear, `operator[row][3 i + a]`.
pub type StrainOperator = [Vec<f64>; 6];

/// Stiffness over M scalar functions: the block of functions i and j is `blocks[i][j]` (3x3, N/m).
pub(crate) struct BlockStiffness<const M: usize> {
    pub blocks: [[[[f64; 3]; 3]; M]; M],
}

impl<const M: usize> BlockStiffness<M> {
    pub fn zero() -> Self {
        Self {
            blocks: [[[[0.0; 3]; 3]; M]; M],
        }
    }

    /// Entry of the degrees of freedom `row` and `column` (three per function). The lower triangle is read from
    /// the upper one, so the matrix is symmetric to the last bit.
    pub fn entry(&self, row: usize, column: usize) -> f64 {
        let (low, high) = if row <= column {
            (row, column)
        } else {
            (column, row)
        };
        self.blocks[low / 3][high / 3][low % 3][high % 3]
    }
}

/// Adds `weight` times the integrand at one point to the blocks i ≤ j.
pub(crate) fn add_point_stiffness<const M: usize>(
    k: &mut BlockStiffness<M>,
    gradients: &[[f64; 3]; M],
    weight: f64,
    lame: LameParameters,
) {
    let (lambda, mu) = (weight * lame.lambda_pa, weight * lame.mu_pa);
    for i in 0..M {
        let gi = gradients[i];
        let (li, mi) = (gi.map(|v| lambda * v), gi.map(|v| mu * v));
        for (j, gj) in gradients.iter().enumerate().skip(i) {
            let block = &mut k.blocks[i][j];
            let dot = mi[0] * gj[0] + mi[1] * gj[1] + mi[2] * gj[2];
            for a in 0..3 {
                for b in 0..3 {
                    block[a][b] += li[a] * gj[b] + gj[a] * mi[b];
                }
                block[a][a] += dot;
            }
        }
    }
}

/// The three columns (displacement along x, y, z) of the strain operator of a function with this gradient.
///
/// `result[row][a]` is the strain component `row` (xx, yy, zz, xy, yz, xz; engineering shear) per unit of the
/// function times e_a.
pub(crate) fn strain_columns(g: [f64; 3]) -> [[f64; 3]; 6] {
    [
        [g[0], 0.0, 0.0],
        [0.0, g[1], 0.0],
        [0.0, 0.0, g[2]],
        [g[1], g[0], 0.0],
        [0.0, g[2], g[1]],
        [g[2], 0.0, g[0]],
    ]
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
    use crate::material::Material;

    /// The short form equals Bᵀ D B.
    #[test]
    fn blocks_equal_b_transposed_d_b() {
        let material = Material::new(210e9, 0.3).unwrap();
        let gradients = [[0.3, -1.2, 0.7], [2.0, 0.4, -0.9]];
        let mut k = BlockStiffness::<2>::zero();
        add_point_stiffness(&mut k, &gradients, 1.0, material.lame());
        let d = material.elasticity();
        for row in 0..6 {
            for column in 0..6 {
                let bi = strain_columns(gradients[row / 3]);
                let bj = strain_columns(gradients[column / 3]);
                let mut expected = 0.0;
                for p in 0..6 {
                    for q in 0..6 {
                        expected += bi[p][row % 3] * d[p][q] * bj[q][column % 3];
                    }
                }
                assert!((k.entry(row, column) - expected).abs() < 1e-12 * 210e9 * 10.0);
            }
        }
    }
}
