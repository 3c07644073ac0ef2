//! The coarser meshes of a bevel gear, from which its discretisation error is estimated.

use super::body::{bevel_body_of, flank_patch};
use super::gauge::bevel_gauge_row;
use super::loads::bevel_loads;
use crate::error_estimate::{
    Asked, CoarserMeshes, Longer, SAFETY, WITH_EDGES, coarsened, each_mesh, mesh_figures,
};
use crate::{Progress, ReductionError};
use gearmesh_bevel::BevelGear;
use gearmesh_mesh::BodyGrid;
use gearmesh_model::FlankGrid;

/// Solves the coarser meshes of a bevel gear, whose body is meshed in one way on all of them.
///
/// # Errors
/// [`ReductionError`] when a coarse mesh cannot be made or solved.
pub(super) fn coarser_bevel_meshes(
    gear: &BevelGear,
    body_grid: BodyGrid,
    grid: &FlankGrid,
    progress: &dyn Progress,
) -> Result<CoarserMeshes, ReductionError> {
    let asked = Asked {
        grid,
        side: gear.reduction.flanks[0],
        gauge_teeth: gear.gauges.iter().map(|gauge| gauge.tooth).collect(),
    };
    let figures = |longer: Longer, progress: &dyn Progress| {
        let mut coarse = gear.clone();
        coarse.mesh = coarsened(&gear.mesh, longer);
        let body = bevel_body_of(&coarse, body_grid, progress)?;
        let patch = flank_patch(&coarse, asked.side)?;
        let loads = bevel_loads(&body.mesh, &patch, asked.side, grid);
        let rows = (coarse.gauges.iter())
            .map(|gauge| bevel_gauge_row(&coarse, &body.mesh, &body.model, gauge, gauge.tooth))
            .collect::<Result<_, _>>()?;
        mesh_figures(&asked, &body, (&loads, rows), progress)
    };
    let steps = vec![Longer::Section, Longer::All];
    each_mesh(steps, (WITH_EDGES, SAFETY), progress, figures)
}
