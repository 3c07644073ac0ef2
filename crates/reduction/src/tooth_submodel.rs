//! The tooth-only submodel: the tooth above the cut, held at the cut and on its opposite side.
//!
//! Its solution W for the flank loads carries the same near field under the load as the whole gear's U on the same
//! mesh, so that the patterns Ψ = U − W are free of it.

use crate::ReductionError;
use crate::flank_loads::{GridLoad, SparseVector, normals};
use crate::part::Part;
use crate::toothed_mesh::ToothParts;
use faer::Mat;
use gearmesh_fe::{DofMap, Factor, FeModel, assemble_stiffness};
use gearmesh_geometry::{Flank, GearDefinition};

/// How a body may deform.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Deformation {
    /// In all directions.
    Spatial,
    /// Plane strain: nowhere along the axis.
    PlaneStrain,
}

impl Deformation {
    /// What a gear's definition asks for.
    pub fn of(gear: &GearDefinition) -> Self {
        if gear.mesh.plane_strain {
            Self::PlaneStrain
        } else {
            Self::Spatial
        }
    }

    /// The free degrees of freedom of a model of which the listed nodes are held.
    ///
    /// # Errors
    /// [`gearmesh_fe::FeError`] when nothing is left free.
    pub fn dofs(self, node_count: usize, held: &[usize]) -> Result<DofMap, gearmesh_fe::FeError> {
        match self {
            Self::Spatial => DofMap::with_fixed_nodes(node_count, held),
            Self::PlaneStrain => {
                let mut fixed: Vec<usize> = (0..node_count).map(|n| 3 * n + 2).collect();
                fixed.extend(held.iter().flat_map(|&n| [3 * n, 3 * n + 1]));
                DofMap::with_fixed_dofs(node_count, &fixed)
            }
        }
    }
}

/// W on a tooth for the loads of one flank.
pub struct ToothSubmodel {
    /// Whole-gear degree of freedom of each submodel degree of freedom, ascending.
    full_dofs: Vec<usize>,
    /// Solution, submodel degrees of freedom × loads \[m/N\].
    w: Mat<f64>,
}

impl ToothSubmodel {
    /// Solves the submodel of tooth 0 for its flank loads.
    ///
    /// # Errors
    /// [`ReductionError::Fe`] when the submodel is not held.
    pub fn new(
        model: &FeModel,
        mesh: &impl ToothParts,
        side: Flank,
        loads: &[GridLoad],
        deformation: Deformation,
    ) -> Result<Self, ReductionError> {
        Self::of_tooth(model, mesh, (0, side), loads, deformation)
    }

    /// Solves the submodel of a tooth for the loads of one of its flanks.
    ///
    /// # Errors
    /// [`ReductionError::Fe`] when the submodel is not held.
    pub fn of_tooth(
        model: &FeModel,
        mesh: &impl ToothParts,
        (tooth, side): (usize, Flank),
        loads: &[GridLoad],
        deformation: Deformation,
    ) -> Result<Self, ReductionError> {
        let Part { nodes, model: part } = Part::new(model, &mesh.tooth_elements(tooth))?;
        let supports: Vec<usize> = mesh
            .tooth_supports(tooth, side)
            .into_iter()
            .filter_map(|n| nodes.binary_search(&n).ok())
            .collect();
        let dofs = deformation.dofs(part.node_count(), &supports)?;
        let stiffness = assemble_stiffness(&part, &dofs)?;
        let factor = Factor::of_model(&part, &dofs, &stiffness)?;
        let mut w = Mat::<f64>::zeros(dofs.free_count(), loads.len());
        for (column, load) in loads.iter().enumerate() {
            for &(dof, value) in &load.normal {
                if let Ok(node) = nodes.binary_search(&((dof / 3) as u32))
                    && let Some(free) = dofs.free_of(3 * node + dof % 3)
                {
                    w[(free, column)] = value;
                }
            }
        }
        factor.solve_in_place(w.as_mut());
        let full_dofs = (0..dofs.free_count())
            .map(|free| {
                let d = dofs.full_of(free);
                3 * nodes[d / 3] as usize + d % 3
            })
            .collect();
        Ok(Self { full_dofs, w })
    }

    /// Subtracts Σ w_l W_l from a field over all degrees of freedom of the whole gear.
    pub fn subtract(&self, weights: &[f64], field: &mut [f64]) {
        for (k, &dof) in self.full_dofs.iter().enumerate() {
            let row = weights.iter().enumerate();
            field[dof] -= row.map(|(load, w)| w * self.w[(k, load)]).sum::<f64>();
        }
    }

    /// NᵀW of the loads that it was solved for, `[load][response]` (m/N).
    pub fn compliance(&self, loads: &[GridLoad]) -> Vec<f64> {
        let count = loads.len();
        let products = self.products(&normals(loads));
        (0..count * count)
            .map(|k| products[(k % count) * count + k / count])
            .collect()
    }

    /// rowᵀ W for each load, for rows over the whole gear's degrees of freedom: `[row][load]`.
    pub fn products(&self, rows: &[&SparseVector]) -> Vec<f64> {
        let loads = self.w.ncols();
        let mut result = vec![0.0; rows.len() * loads];
        for (row, sums) in rows.iter().zip(result.chunks_mut(loads)) {
            for &(dof, value) in *row {
                if let Ok(k) = self.full_dofs.binary_search(&dof) {
                    for (load, sum) in sums.iter_mut().enumerate() {
                        *sum += value * self.w[(k, load)];
                    }
                }
            }
        }
        result
    }
}
