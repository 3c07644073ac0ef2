//! The finite element model of a gear and the way it is solved.

use crate::cyclic_body::CyclicBody;
use crate::flank_loads::SparseVector;
use crate::part::Part;
use crate::repeated_mesh::RepeatedMesh;
use crate::single_sector::SingleSector;
use crate::stages::Stages;
use crate::tooth_submodel::Deformation;
use crate::tooth_vectors::on_tooth;
use crate::whole_gear::WholeGear;
use crate::{Progress, ReductionError};
use faer::Mat;
use gearmesh_fe::{DofMap, FeModel, Material};
use gearmesh_geometry::definition::Material as GearMaterial;
use gearmesh_geometry::{Element, GearDefinition, Symmetry};
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_mesh::{ElementList, GearMesh};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

/// A gear held at its bore, or at the ends of its shaft's stubs, ready to be loaded. How it is solved shows in nothing
/// but time and memory.
pub struct GearBody<M = GearMesh> {
    /// Mesh.
    pub mesh: M,
    /// Finite element model.
    pub model: FeModel,
    /// Free degrees of freedom.
    pub dofs: DofMap,
    /// Stubs of the shaft that the gear is cut into: part of the stiffness; their mass is the shaft's.
    pub(crate) stubs: Option<Part>,
    /// Wall time by stage.
    pub stage_seconds: Vec<(String, f64)>,
    pub(crate) solver: Solver,
    pub(crate) deformation: Deformation,
    right_hand_sides: AtomicUsize,
}

pub(crate) enum Solver {
    Whole(Box<WholeGear>),
    Cyclic(Box<CyclicBody>),
}

/// The finite element model of a gear's mesh.
///
/// # Errors
/// [`ReductionError::Fe`] when an element is too distorted to be used, or the material is none.
pub fn model_of(gear: &GearDefinition, mesh: &GearMesh) -> Result<FeModel, ReductionError> {
    let (nodes, material) = (mesh.nodes.clone(), &gear.material);
    solid_model(nodes, &mesh.elements, material, gear.mesh.element)
}

/// The finite element model of nodes and elements in a gear's material.
///
/// # Errors
/// As [`model_of`].
pub(crate) fn solid_model(
    nodes: Vec<[f64; 3]>,
    elements: &ElementList,
    material: &GearMaterial,
    element: Element,
) -> Result<FeModel, ReductionError> {
    let material = Material::new(material.young_pa, material.poisson)?;
    let connectivity = elements.connectivity().to_vec();
    Ok(FeModel::from_connectivity(
        nodes,
        connectivity,
        material,
        element,
    )?)
}

/// A gear's mesh and its finite element model, not yet factorised.
pub(crate) struct MeshedGear {
    pub mesh: GearMesh,
    model: FeModel,
    meshed_s: f64,
}

impl MeshedGear {
    /// Meshes a gear.
    ///
    /// # Errors
    /// [`ReductionError`] when it cannot be meshed.
    pub fn new(
        gear: &GearDefinition,
        python: &PythonEnvironment,
        progress: &dyn Progress,
    ) -> Result<Self, ReductionError> {
        progress.stage("meshing");
        let clock = Instant::now();
        let mesh = GearMesh::new(gear, python)?;
        let meshed_s = clock.elapsed().as_secs_f64();
        let model = model_of(gear, &mesh)?;
        Ok(Self {
            mesh,
            model,
            meshed_s,
        })
    }

    /// Holds it at its bore, or the ends of its shaft, in plane strain where its definition says so, and factorises it.
    ///
    /// # Errors
    /// [`ReductionError`] when it is not held.
    pub fn held(
        self,
        gear: &GearDefinition,
        progress: &dyn Progress,
    ) -> Result<GearBody, ReductionError> {
        let held = self.mesh.held(&gear.blank);
        let bore: Vec<usize> = held.into_iter().map(|n| n as usize).collect();
        let deformation = Deformation::of(gear);
        // A plane problem is small: its whole factor takes less than the ring's frames.
        let symmetry = match deformation {
            Deformation::Spatial => gear.reduction.symmetry,
            Deformation::PlaneStrain => Symmetry::Off,
        };
        let of_stubs = self.mesh.stub_elements();
        let stubs = (!of_stubs.is_empty()).then(|| Part::new(&self.model, &of_stubs));
        let stubs = stubs.transpose()?;
        let body = GearBody::held(
            (self.mesh, self.model, &bore),
            (symmetry, deformation),
            self.meshed_s,
            progress,
        )?;
        Ok(GearBody { stubs, ..body })
    }
}

impl GearBody {
    /// Meshes and factorises a gear with its bore, or the ends of its shaft, fixed, in plane strain where its
    /// definition says so.
    ///
    /// # Errors
    /// [`ReductionError`] when it cannot be meshed or is not held.
    pub fn new(
        gear: &GearDefinition,
        python: &PythonEnvironment,
        progress: &dyn Progress,
    ) -> Result<Self, ReductionError> {
        MeshedGear::new(gear, python, progress)?.held(gear, progress)
    }
}

impl<M: RepeatedMesh> GearBody<M> {
    /// Factorises a mesh and its model with some nodes held; making the mesh took `meshed_s` seconds.
    ///
    /// # Errors
    /// [`ReductionError::Fe`] when it is not held, [`ReductionError::HeldTeeth`] when more than its body is.
    pub fn held(
        (mesh, model, bore): (M, FeModel, &[usize]),
        (symmetry, deformation): (Symmetry, Deformation),
        meshed_s: f64,
        progress: &dyn Progress,
    ) -> Result<Self, ReductionError> {
        let mut stages = Stages::after(vec![("mesh".to_string(), meshed_s)]);
        let dofs = deformation.dofs(model.node_count(), bore)?;
        stages.lap("model");
        let solver = match symmetry {
            Symmetry::Auto => {
                let mut fixed = vec![false; model.node_count()];
                for &n in bore {
                    fixed[n] = true;
                }
                // Teeth are condensed with nothing held.
                let held = (0..mesh.teeth())
                    .flat_map(|tooth| mesh.cell_nodes(tooth))
                    .filter(|&n| fixed[n as usize])
                    .count();
                if held > 0 {
                    return Err(ReductionError::HeldTeeth { held });
                }
                let body = CyclicBody::new(&mesh, &model, &fixed, progress, &mut stages)?;
                Solver::Cyclic(Box::new(body))
            }
            Symmetry::Off => {
                let whole = WholeGear::new(&model, &dofs, progress, &mut stages)?;
                Solver::Whole(Box::new(whole))
            }
        };
        Ok(Self {
            mesh,
            model,
            dofs,
            stubs: None,
            stage_seconds: stages.into_seconds(),
            solver,
            deformation,
            right_hand_sides: AtomicUsize::new(0),
        })
    }

    /// Whether the gear is a cross-section in plane strain.
    pub fn is_plane(&self) -> bool {
        self.deformation == Deformation::PlaneStrain
    }

    /// What has been done so far, as counts by name: factorisations, right-hand sides, sizes of what was factorised.
    pub fn effort(&self) -> Vec<(String, f64)> {
        let mut counts = match &self.solver {
            Solver::Whole(_) => vec![
                ("factorisations", 1),
                ("DOF of the whole gear", self.dofs.free_count()),
            ],
            Solver::Cyclic(body) => body.effort(),
        };
        let solved = self.right_hand_sides.load(Ordering::Relaxed);
        counts.insert(1, ("right-hand sides", solved));
        let named = counts.into_iter();
        named.map(|(n, c)| (n.to_string(), c as f64)).collect()
    }

    pub(crate) fn count(&self, right_hand_sides: usize) {
        self.right_hand_sides
            .fetch_add(right_hand_sides, Ordering::Relaxed);
    }

    /// aᵀ K⁻¹ b \[m/N\] for vectors given on tooth 0 and placed, turned, on every tooth; the loaded teeth are those of
    /// the first `own`: `[loaded tooth][load][tooth][response]`.
    pub fn compliance(
        &self,
        own: usize,
        vectors: &[&SparseVector],
        progress: &dyn Progress,
    ) -> Vec<f64> {
        self.count(own * vectors.len());
        match &self.solver {
            Solver::Whole(whole) => {
                let loads: Vec<SparseVector> = (0..own)
                    .flat_map(|t| vectors.iter().map(move |v| on_tooth(&self.mesh, v, t)))
                    .collect();
                let loads: Vec<&SparseVector> = loads.iter().collect();
                whole
                    .readings(&self.mesh, &self.dofs, &loads, vectors, progress)
                    .concat()
            }
            Solver::Cyclic(body) => body.compliance(vectors, progress),
        }
    }

    /// The body under loads given on tooth 0 and placed, turned, on every tooth, as a single sector; none where it
    /// repeats or was factorised as a whole.
    pub(crate) fn single_sector(
        &self,
        vectors: &[&SparseVector],
        progress: &dyn Progress,
    ) -> Option<SingleSector<'_>> {
        match &self.solver {
            Solver::Whole(_) => None,
            Solver::Cyclic(body) => SingleSector::new(body, vectors, progress),
        }
    }

    /// aᵀ K⁻¹ g for rows g on the whole mesh and vectors a given on tooth 0 and placed, turned, on every tooth:
    /// `[row][tooth][vector]`.
    pub fn readings(
        &self,
        rows: &[&SparseVector],
        vectors: &[&SparseVector],
        progress: &dyn Progress,
    ) -> Vec<Vec<f64>> {
        self.count(rows.len());
        match &self.solver {
            Solver::Whole(whole) => whole.readings(&self.mesh, &self.dofs, rows, vectors, progress),
            Solver::Cyclic(body) => body.readings(rows, vectors),
        }
    }

    /// Solves K u = f for many loads on the whole mesh and hands each full displacement vector (all degrees of
    /// freedom, metres per newton) to `each`.
    pub fn solve_each(
        &self,
        loads: &[&SparseVector],
        progress: &dyn Progress,
        each: impl FnMut(usize, &[f64]),
    ) {
        self.count(loads.len());
        match &self.solver {
            Solver::Whole(whole) => whole.solve_each(&self.dofs, loads, progress, each),
            Solver::Cyclic(body) => body.solve_each(loads, progress, each),
        }
    }

    /// XᵀKX \[J\] for displacement fields X over all degrees of freedom, zero where the body is held.
    pub fn energy_products(&self, fields: &[Vec<f64>]) -> Mat<f64> {
        match &self.solver {
            Solver::Whole(whole) => whole.energy_products(&self.dofs, fields),
            Solver::Cyclic(body) => body.energy_products(fields),
        }
    }
}
