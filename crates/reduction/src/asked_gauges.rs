//! The gauges that a definition asks for, and what they read of the flanks.

use crate::flank_loads::{GridLoad, SparseVector, directions};
use crate::gear_body::GearBody;
use crate::repeated_mesh::RepeatedMesh;
use crate::tooth_submodel::ToothSubmodel;
use crate::{Progress, ReductionError};
use gearmesh_model::GaugeRows;

/// Gauges as rows of nodal weights.
pub(crate) struct AskedGauges {
    /// Their names and places, without readings.
    heads: Vec<GaugeRows>,
    /// On their own teeth.
    pub rows: Vec<SparseVector>,
    /// Placed on tooth 0.
    at_zero: Vec<SparseVector>,
}

impl AskedGauges {
    /// Gauges by name and place, and their rows on a tooth. W is known on tooth 0; the reading there is that on the
    /// gauge's own tooth, because mesh and gauge turn together.
    ///
    /// # Errors
    /// Those of `row`.
    pub fn new<G>(
        gauges: &[G],
        head: impl Fn(&G) -> GaugeRows,
        row: impl Fn(&G, usize) -> Result<SparseVector, ReductionError>,
    ) -> Result<Self, ReductionError> {
        let heads: Vec<GaugeRows> = gauges.iter().map(head).collect();
        let own = gauges.iter().zip(&heads);
        let rows = own.map(|(gauge, head)| row(gauge, head.tooth));
        Ok(Self {
            rows: rows.collect::<Result<_, _>>()?,
            at_zero: gauges
                .iter()
                .map(|gauge| row(gauge, 0))
                .collect::<Result<_, _>>()?,
            heads,
        })
    }

    /// One adjoint solution per gauge: y = K⁻¹g, read at all grid loads in three directions; and gᵀW on its own tooth.
    pub fn readings(
        &self,
        body: &GearBody<impl RepeatedMesh>,
        loads: &[Vec<GridLoad>],
        submodels: &[ToothSubmodel],
        progress: &dyn Progress,
    ) -> Vec<GaugeRows> {
        if self.rows.is_empty() {
            return Vec::new();
        }
        progress.stage("solving gauges");
        let rows: Vec<&SparseVector> = self.rows.iter().collect();
        let adjoints = body.readings(&rows, &directions(loads.iter().flatten()), progress);
        let found = self.heads.iter().zip(&self.at_zero).zip(adjoints);
        found
            .map(|((head, at_zero), adjoint)| GaugeRows {
                adjoint,
                own_tooth: submodels
                    .iter()
                    .flat_map(|s| s.products(&[at_zero]))
                    .collect(),
                ..head.clone()
            })
            .collect()
    }
}
