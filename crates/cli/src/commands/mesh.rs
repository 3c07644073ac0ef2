//! `gearmesh mesh`: a gear's mesh for other programs.

use crate::arguments::MeshArguments;
use crate::failure::Failure;
use crate::{console, memory, offline, output_name};
use gearmesh_bevel::BevelGear;
use gearmesh_mesh::{BevelMesh, GearMesh};
use gearmesh_reduction::bevel::bevel_model;
use gearmesh_reduction::{OfflineJob, ReductionError};
use serde_json::json;

/// Runs the command.
pub fn run(arguments: &MeshArguments) -> Result<(), Failure> {
    output_name::demand_mesh(&arguments.output)?;
    if let Some(gear) = offline::bevel_gear(&arguments.gear)? {
        return bevel(arguments, &gear);
    }
    let gear = offline::gear(&arguments.gear)?;
    offline::note_element(&gear);
    offline::note_sound(&gear, "nodes and elements are");
    let even_if_short = arguments.even_if_memory_is_short;
    memory::demand(&gear, &arguments.gear, OfflineJob::Mesh, even_if_short)?;
    let mesh = GearMesh::new(&gear, &offline::python()?)
        .map_err(|e| Failure::from(gearmesh_reduction::ReductionError::from(e)))?;
    // Refused here too, where the finite element model would refuse an element.
    gearmesh_reduction::gear_body::model_of(&gear, &mesh)?;
    offline::export_mesh(
        &gear,
        &mesh,
        offline::MeshFields::default(),
        arguments.length_unit,
        &arguments.output,
    )?;
    let quality = mesh.quality;
    let straightened = mesh.straightened_edges();
    if straightened > 0 {
        console::note(format!(
            "{straightened} edges on curved surfaces of the body are straight, since elements would have been folded there"
        ));
    }
    if arguments.json {
        console::json(&json!({
            "nodes": mesh.nodes.len(),
            "elements": mesh.elements.len(),
            "dofs": mesh.dofs(),
            "sectors": gear.sectors(),
            "scaled_jacobian_smallest": quality.smallest,
            "scaled_jacobian_mean": quality.mean,
        }));
    } else {
        console::data(format!(
            "{}: {} nodes, {} {}, {} degrees of freedom, {} repeating sectors",
            gear.name,
            mesh.nodes.len(),
            mesh.elements.len(),
            mesh.elements.shape().plural(),
            mesh.dofs(),
            gear.sectors()
        ));
        console::data(format!(
            "scaled Jacobian: smallest {:.3}, mean {:.3} (demanded {:.3})",
            quality.smallest, quality.mean, gear.mesh.min_scaled_jacobian
        ));
    }
    Ok(())
}

fn bevel(arguments: &MeshArguments, gear: &BevelGear) -> Result<(), Failure> {
    let about = |error: ReductionError| Failure::from(error).about(&arguments.gear);
    let mesh = BevelMesh::new(gear).map_err(|error| about(error.into()))?;
    bevel_model(gear, &mesh).map_err(about)?;
    let (no_fields, unit) = (offline::MeshFields::default(), arguments.length_unit);
    offline::export_bevel_mesh(gear, &mesh, no_fields, unit, &arguments.output)?;
    offline::note_body_grid(mesh.body_grid());
    let quality = mesh.quality;
    let bore = mesh.bore().len();
    let dofs = 3 * (mesh.nodes.len() - bore);
    if arguments.json {
        console::json(&json!({
            "nodes": mesh.nodes.len(),
            "elements": mesh.elements.len(),
            "dofs": dofs,
            "sectors": mesh.teeth(),
            "scaled_jacobian_smallest": quality.smallest,
            "scaled_jacobian_mean": quality.mean,
        }));
    } else {
        console::data(format!(
            "{}: {} nodes, {} {}, {dofs} degrees of freedom, {} repeating sectors",
            gear.name,
            mesh.nodes.len(),
            mesh.elements.len(),
            mesh.elements.shape().plural(),
            mesh.teeth()
        ));
        console::data(format!(
            "scaled Jacobian: smallest {:.3}, mean {:.3} (demanded {:.3})",
            quality.smallest, quality.mean, gear.mesh.min_scaled_jacobian
        ));
    }
    Ok(())
}
