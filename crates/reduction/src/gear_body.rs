//! The finite element model of a whole gear: mesh, stiffness, factor.

use crate::tooth_submodel::Deformation;
use crate::{Progress, ReductionError};
use faer::Mat;
use gearmesh_fe::{DofMap, Factor, FeModel, HexElement, Material, NodeGraph, StiffnessMatrix};
use gearmesh_fe::{DofOrdering, assemble_stiffness_with_graph};
use gearmesh_geometry::{ElementKind, GearDefinition};
use gearmesh_mesh::GearMesh;
use gearmesh_mesh::python::PythonEnvironment;
use std::time::Instant;

/// Columns that are solved together.
pub const BLOCK: usize = 64;

/// A gear held at its bore, ready to be loaded.
pub struct GearBody {
    /// Mesh.
    pub mesh: GearMesh,
    /// Finite element model.
    pub model: FeModel,
    /// Free degrees of freedom.
    pub dofs: DofMap,
    /// Stiffness over the free degrees of freedom.
    pub stiffness: StiffnessMatrix,
    /// Its factor.
    pub factor: Factor,
    /// Wall time by stage.
    pub stage_seconds: Vec<(String, f64)>,
}

/// The element of the finite element crate that a definition names.
pub fn element_of(kind: ElementKind) -> HexElement {
    match kind {
        ElementKind::Hex8 => HexElement::Hex8,
        ElementKind::Hex8Incompatible => HexElement::Hex8Incompatible,
    }
}

impl GearBody {
    /// Meshes, assembles and factors a gear with its bore fixed, in plane strain where its definition says so.
    ///
    /// # Errors
    /// [`ReductionError`] when it cannot be meshed or is not held.
    pub fn new(
        gear: &GearDefinition,
        python: &PythonEnvironment,
        progress: &dyn Progress,
    ) -> Result<Self, ReductionError> {
        let mut stage_seconds = Vec::new();
        let mut clock = Instant::now();
        let mut lap = |name: &str| {
            stage_seconds.push((name.to_string(), clock.elapsed().as_secs_f64()));
            clock = Instant::now();
        };
        progress.stage("meshing");
        let mesh = GearMesh::new(gear, python)?;
        lap("mesh");
        progress.stage("assembling");
        let material = Material::new(gear.material.young_pa, gear.material.poisson)?;
        let model = FeModel::new(
            mesh.nodes.clone(),
            mesh.hexes.clone(),
            material,
            element_of(gear.mesh.element),
        )?;
        let fixed: Vec<usize> = mesh.bore().into_iter().map(|n| n as usize).collect();
        let dofs = Deformation::of(gear).dofs(model.node_count(), &fixed)?;
        let graph = NodeGraph::new(&model, &dofs)?;
        let stiffness = assemble_stiffness_with_graph(&model, &dofs, &graph)?;
        lap("assembly");
        progress.stage("factoring");
        let ordering = DofOrdering::nested_dissection(&graph, &dofs)?;
        let factor = Factor::new(&stiffness, ordering)?;
        lap("factor");
        Ok(Self {
            mesh,
            model,
            dofs,
            stiffness,
            factor,
            stage_seconds,
        })
    }

    /// Solves K u = f for many loads, a block at a time, and hands each full displacement vector (all degrees of
    /// freedom, metres per newton) to `each`.
    pub fn solve_each(
        &self,
        loads: &[&crate::flank_loads::SparseVector],
        progress: &dyn Progress,
        mut each: impl FnMut(usize, &[f64]),
    ) {
        let mut full = vec![0.0; self.dofs.dof_count()];
        for (block, chunk) in loads.chunks(BLOCK).enumerate() {
            let mut rhs = Mat::<f64>::zeros(self.dofs.free_count(), chunk.len());
            for (column, load) in chunk.iter().enumerate() {
                for &(dof, value) in *load {
                    if let Some(free) = self.dofs.free_of(dof) {
                        rhs[(free, column)] = value;
                    }
                }
            }
            self.factor.solve_in_place(rhs.as_mut());
            for column in 0..chunk.len() {
                for free in 0..self.dofs.free_count() {
                    full[self.dofs.full_of(free)] = rhs[(free, column)];
                }
                each(block * BLOCK + column, &full);
            }
            progress.advance((block * BLOCK + chunk.len()).min(loads.len()), loads.len());
        }
    }
}
