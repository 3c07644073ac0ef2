//! The body of a gear and what of it repeats with the teeth, meshed in the cross-section.

use crate::MeshError;
use crate::body::{BodyLengths, BodyProblem, Span, body_problem};
use crate::body_circles::{first_tooth, repeating_down_to_m};
use crate::plane_mesher::{PlaneMesh, PlaneMeshError, mesh_one, mesh_plane};
use crate::python::PythonEnvironment;
use crate::ring_radius::ring_radius_m;
use crate::tooth_blocks::ToothBlocks;
use gearmesh_geometry::GearDefinition;

/// Meshes of a tooth's cell and of the spans below it.
pub(crate) struct MeshedSpans {
    pub cell_mesh: PlaneMesh,
    /// The body's span.
    pub span: Span,
    pub body: BodyProblem,
    pub body_mesh: PlaneMesh,
    /// What a body that does not repeat has alike below every tooth, one tooth of it.
    pub below_teeth: Option<(BodyProblem, PlaneMesh)>,
}

impl MeshedSpans {
    /// Meshes them. The body begins at the first circle beside which gmsh finds good quads, at the ring below the teeth
    /// where there is none; there its quads are taken as they are.
    ///
    /// # Errors
    /// [`MeshError`] when gmsh is missing or fails, or when no sector can be cut.
    pub fn new(
        gear: &GearDefinition,
        python: &PythonEnvironment,
        blocks: &ToothBlocks,
        ring_size_m: f64,
    ) -> Result<Self, MeshError> {
        let (teeth, sectors) = (gear.tooth.teeth, gear.sectors());
        let (ring_m, pieces) = (ring_radius_m(gear), blocks.ring_pieces());
        let is_poor =
            |mesh: &PlaneMesh| mesh.smallest_scaled_jacobian() < gear.mesh.min_scaled_jacobian;
        let circles = repeating_down_to_m(gear);
        let mut circles = circles.into_iter();
        loop {
            let deep_m = circles.next();
            let below_teeth = deep_m.map(|deep_m| Span {
                radii_m: [ring_m, deep_m],
                sectors: teeth,
                first_tooth: 0,
                pieces,
            });
            let below_teeth = below_teeth
                .map(|span| body_problem(gear, ring_size_m, &span, BodyLengths::WithinSector))
                .transpose()?;
            let span = Span {
                radii_m: [deep_m.unwrap_or(ring_m), gear.blank.edge_radius_m()],
                sectors,
                first_tooth: first_tooth(gear)?,
                pieces: (below_teeth.as_ref()).map_or(pieces, |below| below.bore.len() - 1),
            };
            let mut body = body_problem(gear, ring_size_m, &span, BodyLengths::Wanted)?;
            let mut problems = vec![blocks.problem.clone(), body.problem.clone()];
            problems.extend(below_teeth.as_ref().map(|below| below.problem.clone()));
            let mut meshes = mesh_plane(python, &problems)?.into_iter();
            let (Some(cell_mesh), Some(mut body_mesh)) = (meshes.next(), meshes.next()) else {
                return Err(PlaneMeshError::Mismatch("another number of meshes").into());
            };
            let below_teeth = below_teeth.zip(meshes.next());
            if let Some((_, mesh)) = &below_teeth {
                if is_poor(&body_mesh) || is_poor(mesh) {
                    continue;
                }
            } else if sectors > 1 && is_poor(&body_mesh) {
                body = body_problem(gear, ring_size_m, &span, BodyLengths::WithinSector)?;
                body_mesh = mesh_one(python, &body.problem)?;
            }
            return Ok(Self {
                cell_mesh,
                span,
                body,
                body_mesh,
                below_teeth,
            });
        }
    }
}
