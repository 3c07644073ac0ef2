//! The finite element model of a bevel gear, and its flanks as patches.

use crate::gear_body::solid_model;
use crate::tooth_submodel::Deformation;
use crate::{GearBody, Progress, ReductionError};
use gearmesh_bevel::{BevelError, BevelGear, FlankPatch};
use gearmesh_fe::FeModel;
use gearmesh_geometry::Flank;
use gearmesh_mesh::{BevelMesh, BodyGrid, MeshError};
use std::time::Instant;

/// A flank as a patch.
///
/// # Errors
/// [`ReductionError::Mesh`] where the tool leaves no surface.
pub(crate) fn flank_patch(gear: &BevelGear, side: Flank) -> Result<FlankPatch, ReductionError> {
    let cut = |error: BevelError| ReductionError::Mesh(MeshError::Bevel(error));
    gear.patch(side).map_err(cut)
}

/// The finite element model of a bevel gear, held at its bore.
///
/// # Errors
/// [`ReductionError`] when it cannot be meshed or is not held.
pub fn bevel_body(
    gear: &BevelGear,
    progress: &dyn Progress,
) -> Result<GearBody<BevelMesh>, ReductionError> {
    held(gear, progress, || BevelMesh::new(gear))
}

/// The same with a body of this kind, and elements no poorer than demanded.
///
/// # Errors
/// As [`bevel_body`].
pub fn bevel_body_of(
    gear: &BevelGear,
    grid: BodyGrid,
    progress: &dyn Progress,
) -> Result<GearBody<BevelMesh>, ReductionError> {
    held(gear, progress, || {
        let mesh = BevelMesh::of_grid(gear, grid)?;
        mesh.quality.demand(gear.mesh.min_scaled_jacobian)?;
        Ok(mesh)
    })
}

fn held(
    gear: &BevelGear,
    progress: &dyn Progress,
    made: impl FnOnce() -> Result<BevelMesh, MeshError>,
) -> Result<GearBody<BevelMesh>, ReductionError> {
    let clock = Instant::now();
    progress.stage("meshing");
    let mesh = made()?;
    let meshed_s = clock.elapsed().as_secs_f64();
    let model = bevel_model(gear, &mesh)?;
    let bore: Vec<usize> = mesh.bore().into_iter().map(|n| n as usize).collect();
    let way = (gear.reduction.symmetry, Deformation::Spatial);
    GearBody::held((mesh, model, &bore), way, meshed_s, progress)
}

/// The finite element model of a bevel gear's mesh.
///
/// # Errors
/// [`ReductionError::Fe`] when an element is too distorted to be used.
pub fn bevel_model(gear: &BevelGear, mesh: &BevelMesh) -> Result<FeModel, ReductionError> {
    let (nodes, material) = (mesh.nodes.clone(), &gear.material);
    solid_model(nodes, &mesh.elements, material, gear.mesh.element)
}
