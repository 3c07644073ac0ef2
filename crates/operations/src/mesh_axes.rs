//! How the axes of gears in mesh stand to each other in a static result: to be put into a `[pair]`.

use crate::failure::{Failure, Result};
use gearmesh_geometry::Flank;
use gearmesh_scene::system_run::SystemResult;

/// A line for each mesh whose gears' places are in the result, at its last point.
pub fn lines(result: &SystemResult) -> Result<Vec<String>> {
    let Some(last) = result.rows.rows().checked_sub(1) else {
        return Ok(Vec::new());
    };
    let mut lines = Vec::new();
    for mesh in &result.head.meshes {
        let axes = result.mesh_axes(mesh, last, false);
        let Some(axes) = axes.map_err(Failure::work)? else {
            continue;
        };
        let flank = result.loaded_flank(&mesh.name, last);
        let flank = flank.map_err(Failure::work)?.unwrap_or(Flank::Right);
        let found = axes.misalignment(flank);
        lines.push(format!(
            "axes of mesh {} at point {last}, {} flanks: inclination_mrad = {:.6}, deviation_mrad = {:.6}, centre distance {:.4} mm",
            mesh.name,
            flank.name(),
            1e3 * found.inclination_rad,
            1e3 * found.deviation_rad,
            1e3 * axes.centre_distance_m
        ));
    }
    Ok(lines)
}
