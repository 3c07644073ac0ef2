//! The steps of a reduction that know no teeth: compliance, gauges, dynamics, error estimate, provenance.

use crate::asked_gauges::AskedGauges;
use crate::dynamics::{DynamicsRequest, dynamics};
use crate::error_estimate::CoarserMeshes;
use crate::flank_compliance::{ROWS_BY_FIELDS, flank_compliance};
use crate::flank_loads::{GridLoad, SparseVector};
use crate::gear_body::GearBody;
use crate::repeated_mesh::RepeatedMesh;
use crate::stages::Stages;
use crate::tooth_submodel::ToothSubmodel;
use crate::toothed_mesh::ToothParts;
use crate::{Progress, ReductionError};
use gearmesh_fe::FeModel;
use gearmesh_geometry::Flank;
use gearmesh_model::{FlankGrid, Provenance, ReducedGear, ReductionChecks, utc_now};

/// A model whose parts are found one after the other.
pub(crate) struct Reduction<'a, M> {
    /// What has been found.
    pub model: ReducedGear,
    pub body: GearBody<M>,
    /// Of tooth 0, flank by flank.
    pub loads: Vec<Vec<GridLoad>>,
    pub stages: Stages,
    /// Counts by name besides those of the body.
    pub effort: Vec<(String, f64)>,
    submodels: Vec<ToothSubmodel>,
    /// Largest entry of C_hub that its patterns leave out, where it is kept by them.
    left_out: Option<f64>,
    progress: &'a dyn Progress,
}

impl<'a, M: RepeatedMesh + ToothParts> Reduction<'a, M> {
    /// Begins with the compliance of the flanks. `loads`: those of tooth 0, flank by flank.
    ///
    /// # Errors
    /// [`ReductionError`] when a tooth is not held or an identity is violated by more than round-off explains.
    pub fn of_flanks(
        body: GearBody<M>,
        (flanks, loads): (&[Flank], Vec<Vec<GridLoad>>),
        mut stages: Stages,
        progress: &'a dyn Progress,
    ) -> Result<Self, ReductionError> {
        let found = flank_compliance(&body, (flanks, &loads), progress, &mut stages)?;
        let (hub_patterns, left_out) = found.patterns.unzip();
        let material = body.model.material();
        Ok(Self {
            model: ReducedGear {
                teeth: body.mesh.teeth(),
                sectors: body.mesh.sectors(),
                young_pa: material.young_pa(),
                poisson: material.poisson(),
                flanks: flanks.to_vec(),
                c_hub: found.c_hub,
                c_tooth: found.c_tooth,
                hub_patterns,
                checks: ReductionChecks {
                    symmetry: found.symmetry,
                    pattern_identity: found.pattern_identity,
                    further: vec![(ROWS_BY_FIELDS.to_string(), found.rows_by_fields)],
                },
                ..ReducedGear::default()
            },
            body,
            loads,
            stages,
            effort: Vec::new(),
            submodels: found.submodels,
            left_out,
            progress,
        })
    }

    /// What the gauges read of the flanks.
    pub fn read_gauges(&mut self, asked: &AskedGauges) {
        self.model.gauges = asked.readings(&self.body, &self.loads, &self.submodels, self.progress);
        self.stages.lap("gauges");
    }

    /// What the dynamics needs; `gauges` are the rows of all gauges.
    ///
    /// # Errors
    /// As [`dynamics`].
    pub fn add_dynamics(
        &mut self,
        request: &DynamicsRequest<'_>,
        gauges: &[SparseVector],
    ) -> Result<(), ReductionError> {
        let rows = (&self.loads[..], gauges);
        let solves = dynamics(request, &self.body, rows, self.progress, &mut self.model)?;
        let solves = solves.map(|count| ("solves for natural modes".to_string(), count as f64));
        self.effort.extend(solves);
        if self.model.rigid_body.is_some() {
            self.stages.lap("mass and modes");
        }
        Ok(())
    }

    /// The discretisation error from coarser meshes.
    pub fn estimate_errors(&mut self, grid: &FlankGrid, coarser: CoarserMeshes) {
        let model = &mut self.model;
        let errors = coarser.errors_of(model, grid);
        errors.state(&mut model.checks.further, &mut model.gauges);
    }

    /// The model, with what it took, and the body.
    pub fn finished(self) -> (ReducedGear, GearBody<M>) {
        let (mut model, body) = (self.model, self.body);
        let mut effort = body.effort();
        effort.extend(self.effort);
        let dofs = body.dofs.free_count();
        model.provenance = provenance(&body.model, dofs, self.stages, effort);
        if let Some(left_out) = self.left_out {
            let name = "C_hub by patterns, largest entry left out".to_string();
            model.checks.further.push((name, left_out));
            model.c_hub = Vec::new();
        }
        (model, body)
    }
}

/// Where a model comes from that was reduced just now.
pub(crate) fn provenance(
    model: &FeModel,
    dofs: usize,
    stages: Stages,
    effort: Vec<(String, f64)>,
) -> Provenance {
    let elements: Vec<&str> = model.blocks().iter().map(|b| b.element.name()).collect();
    Provenance {
        program: "gearmesh".into(),
        version: env!("CARGO_PKG_VERSION").into(),
        created_utc: utc_now(),
        threads: rayon::current_num_threads(),
        element: elements.join(" + "),
        nodes: model.node_count(),
        elements: model.element_count(),
        dofs,
        stage_seconds: stages.into_seconds(),
        effort,
    }
}
