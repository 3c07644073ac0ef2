//! A gear solved by one factorisation of all its degrees of freedom: what the cyclic way is compared with.

use crate::Progress;
use crate::flank_loads::{SparseVector, dot};
use crate::repeated_mesh::RepeatedMesh;
use crate::stages::Stages;
use crate::tooth_vectors::on_all_teeth;
use faer::Mat;
use gearmesh_fe::{
    DofMap, DofOrdering, Factor, FeError, FeModel, ModeSettings, NaturalModes, NodeGraph,
    SparseMatrix, StiffnessMatrix, SymbolicFactor, assemble_stiffness_with_graph, natural_modes,
};
use rayon::prelude::*;
use std::sync::Arc;

/// Columns that are solved together.
const BLOCK: usize = 64;

/// Stiffness of the whole gear and its factor.
pub struct WholeGear {
    stiffness: StiffnessMatrix,
    factor: Factor,
}

impl WholeGear {
    /// Assembles and factorises. The wall time of each stage is added to `stages`.
    ///
    /// # Errors
    /// [`FeError`] when the body is not held or memory is short.
    pub(crate) fn new(
        model: &FeModel,
        dofs: &DofMap,
        progress: &dyn Progress,
        stages: &mut Stages,
    ) -> Result<Self, FeError> {
        progress.stage("assembling");
        let graph = NodeGraph::new(model, dofs)?;
        let stiffness = assemble_stiffness_with_graph(model, dofs, &graph)?;
        stages.lap("assembly");
        progress.stage("factoring");
        let ordering = DofOrdering::nested_dissection(&graph, dofs)?;
        let symbolic = SymbolicFactor::new(&stiffness, ordering)?;
        progress.expect(symbolic.expected_seconds());
        let factor = Factor::from_symbolic(Arc::new(symbolic), &stiffness)?;
        stages.lap("factor");
        Ok(Self { stiffness, factor })
    }

    /// K⁻¹ p for many loads, a block at a time, as full fields handed to `each` one by one.
    pub fn solve_each(
        &self,
        dofs: &DofMap,
        loads: &[&SparseVector],
        progress: &dyn Progress,
        mut each: impl FnMut(usize, &[f64]),
    ) {
        let mut full = vec![0.0; dofs.dof_count()];
        for (block, chunk) in loads.chunks(BLOCK).enumerate() {
            let mut rhs = Mat::<f64>::zeros(dofs.free_count(), chunk.len());
            for (column, load) in chunk.iter().enumerate() {
                for &(dof, value) in *load {
                    if let Some(free) = dofs.free_of(dof) {
                        rhs[(free, column)] = value;
                    }
                }
            }
            self.factor.solve_in_place(rhs.as_mut());
            for column in 0..chunk.len() {
                for free in 0..dofs.free_count() {
                    full[dofs.full_of(free)] = rhs[(free, column)];
                }
                each(block * BLOCK + column, &full);
            }
            progress.advance((block * BLOCK + chunk.len()).min(loads.len()), loads.len());
        }
    }

    /// aᵀ K⁻¹ g: `[row][tooth][vector]`, as [`crate::cyclic_body::CyclicBody::readings`].
    pub fn readings(
        &self,
        mesh: &impl RepeatedMesh,
        dofs: &DofMap,
        rows: &[&SparseVector],
        vectors: &[&SparseVector],
        progress: &dyn Progress,
    ) -> Vec<Vec<f64>> {
        let everywhere = on_all_teeth(mesh, vectors);
        let mut readings = Vec::with_capacity(rows.len());
        self.solve_each(dofs, rows, progress, |_, u| {
            readings.push(everywhere.par_iter().map(|v| dot(v, u)).collect());
        });
        readings
    }

    /// The lowest natural modes for a mass matrix over the free degrees of freedom.
    ///
    /// # Errors
    /// As [`natural_modes`].
    pub fn natural_modes(
        &self,
        mass: &SparseMatrix,
        settings: &ModeSettings,
    ) -> Result<NaturalModes, FeError> {
        natural_modes(&self.stiffness, mass, &self.factor, settings)
    }

    /// XᵀKX for full fields that are zero where the body is held.
    pub fn energy_products(&self, dofs: &DofMap, fields: &[Vec<f64>]) -> Mat<f64> {
        let mut x = Mat::zeros(dofs.free_count(), fields.len());
        for (column, field) in fields.iter().enumerate() {
            for free in 0..dofs.free_count() {
                x[(free, column)] = field[dofs.full_of(free)];
            }
        }
        x.transpose() * (self.stiffness.as_ref() * &x)
    }
}
