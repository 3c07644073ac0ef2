//! A crack by doubled nodes, as an update of the sound body that needs no new factor.
//!
//! The nodes on a surface of element faces are doubled; the elements on one side of it, those *beyond*, see u + w
//! there, w the jump:
//!
//! ```text
//! [ K     K_p  ] [ u ]   [ f ]        K_p, K_pp: columns of the jumps, assembled from the elements beyond alone
//! [ K_pᵀ  K_pp ] [ w ] = [ 0 ]
//!
//! S = K_pp − K_pᵀ K⁻¹ K_p = L Lᵀ,     r(f) = −L⁻¹ K_pᵀ K⁻¹ f,     fᵀ K_c⁻¹ h = fᵀ K⁻¹ h + r(f)·r(h)
//! ```
//!
//! for loads f, h that have no entry at the doubled nodes. Exact: block elimination of the mesh whose nodes are really
//! doubled. The faces of the crack may pass through each other.

use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Mat, MatRef, Par, Side};
use std::collections::{BTreeMap, HashMap};

use crate::constraints::DofMap;
use crate::error::FeError;
use crate::model::FeModel;

/// The jumps of a crack and their stiffness.
#[derive(Debug, Clone)]
pub struct DoubledNodes {
    coupling: Vec<Vec<(usize, f64)>>,
    own: Mat<f64>,
}

/// L of S = L Lᵀ, the stiffness of the jumps with the rest of the body free to follow.
#[derive(Debug, Clone)]
pub struct JumpFactor {
    lower: Mat<f64>,
    asymmetry: f64,
}

impl DoubledNodes {
    /// Doubles nodes for the elements `beyond`. Displacements that are held do not jump.
    ///
    /// # Errors
    /// [`FeError::NothingFree`] without a free jump, [`FeError::ElementOutOfRange`], [`FeError::Element`].
    pub fn new(
        model: &FeModel,
        dofs: &DofMap,
        doubled: &[u32],
        beyond: &[u32],
    ) -> Result<Self, FeError> {
        let mut doubled = doubled.to_vec();
        doubled.sort_unstable();
        doubled.dedup();
        let of_node = |&node: &u32| (0..3).map(move |axis| 3 * node as usize + axis);
        let jumps: HashMap<usize, usize> = (doubled.iter().flat_map(of_node))
            .filter(|&dof| dofs.free_of(dof).is_some())
            .enumerate()
            .map(|(jump, dof)| (dof, jump))
            .collect();
        if jumps.is_empty() {
            return Err(FeError::NothingFree {
                dof_count: 3 * doubled.len(),
            });
        }
        let mut coupling = vec![BTreeMap::<usize, f64>::new(); jumps.len()];
        let mut own = Mat::zeros(jumps.len(), jumps.len());
        for &element in beyond {
            let of_element = model.element_dofs(element as usize)?;
            if !of_element.iter().any(|dof| jumps.contains_key(dof)) {
                continue;
            }
            let stiffness = model.element_stiffness(element as usize)?;
            for (j, column) in of_element.iter().enumerate() {
                let Some(&jump) = jumps.get(column) else {
                    continue;
                };
                for (i, row) in of_element.iter().enumerate() {
                    *coupling[jump].entry(*row).or_default() += stiffness[(i, j)];
                    if let Some(&other) = jumps.get(row) {
                        own[(other, jump)] += stiffness[(i, j)];
                    }
                }
            }
        }
        Ok(Self {
            coupling: (coupling.into_iter())
                .map(|column| column.into_iter().collect())
                .collect(),
            own,
        })
    }

    /// Number of jumps.
    pub fn count(&self) -> usize {
        self.coupling.len()
    }

    /// Columns of K_p (N/m): (degree of freedom of the sound body, value), ascending.
    pub fn coupling(&self) -> &[Vec<(usize, f64)>] {
        &self.coupling
    }

    /// The factor of S from K_pᵀ K⁻¹ K_p (N/m).
    ///
    /// # Errors
    /// [`FeError::SizeMismatch`], [`FeError::CrackNotPositiveDefinite`].
    pub fn factor(&self, condensed: MatRef<'_, f64>) -> Result<JumpFactor, FeError> {
        let n = self.count();
        if condensed.nrows() != n || condensed.ncols() != n {
            return Err(FeError::SizeMismatch {
                what: "what the body takes of the jumps' stiffness",
                found: condensed.nrows(),
                expected: n,
            });
        }
        let largest = condensed.norm_max();
        let mut asymmetry: f64 = 0.0;
        let stiffness = Mat::from_fn(n, n, |i, j| {
            let (above, below) = (condensed[(i, j)], condensed[(j, i)]);
            asymmetry = asymmetry.max((above - below).abs() / largest);
            self.own[(i, j)] - 0.5 * (above + below)
        });
        match stiffness.llt(Side::Lower) {
            Ok(factor) => Ok(JumpFactor {
                lower: factor.L().to_owned(),
                asymmetry,
            }),
            Err(_) => Err(FeError::CrackNotPositiveDefinite { jumps: n }),
        }
    }
}

impl JumpFactor {
    /// Largest difference of K_pᵀ K⁻¹ K_p from its transpose, relative to its largest entry.
    pub fn asymmetry(&self) -> f64 {
        self.asymmetry
    }

    /// r = −L⁻¹ g for each column g = K_pᵀ K⁻¹ f.
    pub fn rows(&self, readings: MatRef<'_, f64>) -> Mat<f64> {
        let mut rows = Mat::from_fn(readings.nrows(), readings.ncols(), |i, j| -readings[(i, j)]);
        solve_lower_triangular_in_place(self.lower.as_ref(), rows.as_mut(), Par::Seq);
        rows
    }
}
