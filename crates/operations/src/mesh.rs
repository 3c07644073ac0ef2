//! A gear's mesh for other programs.

use crate::failure::{Failure, Result};
use crate::gear_file::{AnyGear, GearFile, note_element, note_sound};
use crate::memory;
use crate::mesh_file::{LengthUnit, MeshFields, export_bevel_mesh, export_mesh, note_body_grid};
use crate::watch::Watch;
use crate::{output_name, overwriting};
use gearmesh_mesh::quality::QualityReport;
use gearmesh_mesh::{BevelMesh, GearMesh};
use gearmesh_reduction::bevel::bevel_model;
use gearmesh_reduction::gear_body::model_of;
use gearmesh_reduction::{OfflineJob, ReductionError};
use serde::Deserialize;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// What is meshed, and where the mesh goes.
#[derive(Debug, Clone, clap::Args, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeshRequest {
    /// Gear file
    pub gear: PathBuf,
    /// Mesh file; its extension names the format: .bdf .nas (Nastran), .inp (Abaqus, CalculiX), .msh (gmsh), .vtk .vtu
    /// .xdmf .xmf (ParaView)
    #[arg(short, long)]
    pub output: PathBuf,
    /// Unit of the coordinates in the file
    #[arg(long, value_parser = crate::file_words::length_words(), default_value = "m")]
    #[serde(default)]
    pub length_unit: LengthUnit,
    /// Begin even if the memory estimate exceeds what is free
    #[arg(long)]
    #[serde(default)]
    pub even_if_memory_is_short: bool,
}

/// A mesh that was written.
#[derive(Debug, Clone)]
pub struct Meshed {
    /// Name of the gear.
    pub name: String,
    /// Nodes.
    pub nodes: usize,
    /// Elements.
    pub elements: usize,
    /// What the elements are, in the plural.
    pub shapes: &'static str,
    /// Degrees of freedom with the bore held.
    pub dofs: usize,
    /// Sectors that repeat.
    pub sectors: usize,
    /// Scaled Jacobians.
    pub quality: QualityReport,
    /// The smallest scaled Jacobian that was demanded.
    pub demanded: f64,
}

impl Meshed {
    /// For other programs.
    #[must_use]
    pub fn figures(&self) -> Value {
        json!({
            "nodes": self.nodes,
            "elements": self.elements,
            "dofs": self.dofs,
            "sectors": self.sectors,
            "scaled_jacobian_smallest": self.quality.smallest,
            "scaled_jacobian_mean": self.quality.mean,
        })
    }
}

/// Meshes a gear of either family and writes the mesh.
///
/// # Errors
/// [`Failure`] where the gear cannot be meshed, an element is unfit for the finite element model, or the file cannot be
/// written.
pub fn mesh(a: &MeshRequest, watch: &Watch<'_>) -> Result<Meshed> {
    overwriting::refuse(vec![a.gear.clone()], std::slice::from_ref(&a.output))?;
    output_name::demand_mesh(&a.output)?;
    let read = GearFile::read(&a.gear, watch)?;
    let file = (&*a.output, a.length_unit);
    match &read.gear {
        AnyGear::Cylindrical(gear) => {
            note_element(gear, watch);
            note_sound(gear, "nodes and elements are", watch);
            let even_if_short = a.even_if_memory_is_short;
            memory::demand(
                gear,
                &read.file,
                (OfflineJob::Mesh, None),
                even_if_short,
                watch,
            )?;
            let mesh = GearMesh::new(gear, &watch.python()?).map_err(ReductionError::from)?;
            model_of(gear, &mesh)?;
            export_mesh(gear, &mesh, MeshFields::default(), file, watch)?;
            let straightened = mesh.straightened_edges();
            if straightened > 0 {
                watch.note(format!(
                    "{straightened} edges on curved surfaces of the body are straight, since elements would have been folded there"
                ));
            }
            Ok(Meshed {
                name: gear.name.clone(),
                nodes: mesh.nodes.len(),
                elements: mesh.elements.len(),
                shapes: mesh.elements.shape().plural(),
                dofs: mesh.dofs(),
                sectors: gear.sectors(),
                quality: mesh.quality,
                demanded: gear.mesh.min_scaled_jacobian,
            })
        }
        AnyGear::Bevel(gear) => {
            let about = |error: ReductionError| Failure::from(error).about(Path::new(&read.file));
            let mesh = BevelMesh::new(gear).map_err(|error| about(error.into()))?;
            bevel_model(gear, &mesh).map_err(about)?;
            export_bevel_mesh(gear, &mesh, MeshFields::default(), file, watch)?;
            note_body_grid(mesh.body_grid(), watch);
            Ok(Meshed {
                name: gear.name.clone(),
                nodes: mesh.nodes.len(),
                elements: mesh.elements.len(),
                shapes: mesh.elements.shape().plural(),
                dofs: 3 * (mesh.nodes.len() - mesh.bore().len()),
                sectors: mesh.teeth(),
                quality: mesh.quality,
                demanded: gear.mesh.min_scaled_jacobian,
            })
        }
    }
}
