//! The offline stage: a gear becomes its compliance at the flanks.

use crate::failure::Result;
use crate::gear_file::{AnyGear, GearFile, note_element};
use crate::memory;
use crate::mesh_file::note_body_grid;
use crate::scratch::Scratch;
use crate::watch::Watch;
use gearmesh_geometry::{GearDefinition, MeshedBody};
use gearmesh_model::{ReducedGear, ReductionChecks, write_reduced_gear};
use gearmesh_reduction::bevel::reduce_bevel;
use gearmesh_reduction::{GearBody, OfflineJob, ReductionOptions, read_body, reduce_imported};
use serde_json::json;
use std::path::Path;

/// How a gear is reduced.
#[derive(Debug, Clone, Copy)]
pub struct Reduction {
    /// Reduce a coarser mesh too, and estimate the error of the discretisation.
    pub estimate_error: bool,
    /// Begin even where the estimate of the memory exceeds what is free.
    pub even_if_memory_is_short: bool,
}

/// Meshes and reduces a gear of either family.
///
/// # Errors
/// [`Failure`](crate::Failure) where it cannot be meshed or held, or the memory is short.
pub fn reduce(of: &GearFile, how: Reduction, watch: &Watch<'_>) -> Result<ReducedGear> {
    let options = ReductionOptions {
        estimate_error: how.estimate_error,
    };
    match &of.gear {
        AnyGear::Bevel(gear) => {
            let outcome = watch.offline(&gear.name, |told| reduce_bevel(gear, options, told));
            let (model, body) = outcome.map_err(|error| error.about(Path::new(&of.file)))?;
            note_body_grid(body.mesh.body_grid(), watch);
            Ok(model)
        }
        AnyGear::Cylindrical(gear) => match gear.blank.meshed() {
            Some(body) => {
                if how.estimate_error {
                    watch.note("no error estimate: the mesh is given, there is no coarser one");
                }
                reduced_import(gear, body, watch)
            }
            None => {
                note_element(gear, watch);
                let even_if_short = how.even_if_memory_is_short;
                // How long natural modes take is not estimated.
                let duration: Option<memory::Duration> = match (gear.modes, how.estimate_error) {
                    (Some(_), _) => None,
                    (None, true) => Some(|estimate| estimate.reduction_seconds(true)),
                    (None, false) => Some(|estimate| estimate.reduction_seconds(false)),
                };
                let job = (OfflineJob::Reduction, duration);
                memory::demand(gear, &of.file, job, even_if_short, watch)?;
                Ok(reduced(gear, how.estimate_error, watch)?.0)
            }
        },
    }
}

/// The same, into a model file; where the operation is stopped none is written.
///
/// # Errors
/// As [`reduce`], and where the file cannot be written.
pub fn reduce_to(
    of: &GearFile,
    how: Reduction,
    output: &Path,
    watch: &Watch<'_>,
) -> Result<ReducedGear> {
    let model = reduce(of, how, watch)?;
    watch.go_on()?;
    write_reduced_gear(output, &model)?;
    Ok(model)
}

/// Meshes and reduces a cylindrical gear; its body is handed on for fields.
///
/// # Errors
/// As [`reduce`].
pub fn reduced(
    gear: &GearDefinition,
    estimate_error: bool,
    watch: &Watch<'_>,
) -> Result<(ReducedGear, GearBody)> {
    let python = watch.python()?;
    let options = ReductionOptions { estimate_error };
    watch.offline(&gear.name, |told| {
        gearmesh_reduction::reduce(gear, &python, options, told)
    })
}

/// Reduces a gear whose body a study varies; what went wrong in words.
pub(crate) fn reduced_for_study(
    gear: &GearDefinition,
    watch: &Watch<'_>,
) -> Result<ReducedGear, String> {
    let outcome = match gear.blank.meshed() {
        Some(body) => reduced_import(gear, body, watch),
        None => reduced(gear, true, watch).map(|(model, _)| model),
    };
    outcome.map_err(|failure| failure.message)
}

/// Reads, checks and reduces a gear that was meshed elsewhere.
fn reduced_import(
    gear: &GearDefinition,
    body: &MeshedBody,
    watch: &Watch<'_>,
) -> Result<ReducedGear> {
    let folder = Scratch::new()?;
    let python = watch.python()?;
    watch.offline(&gear.name, |told| {
        told.stage("reading the mesh");
        let mesh = read_body(body, &python, &folder.path().join("mesh.h5"))?;
        reduce_imported(gear, body, mesh, told)
    })
}

/// A mesh error in words.
#[must_use]
pub fn mesh_error(relative: Option<f64>) -> String {
    relative.map_or_else(
        || "not estimated".to_owned(),
        |error| format!("about {:.2} %", 100.0 * error),
    )
}

/// The figures of a model for machines.
pub fn figures(model: &ReducedGear) -> serde_json::Value {
    let gauges: Vec<_> = model
        .gauges
        .iter()
        .map(|g| json!({"name": g.name, "error_estimate_relative": g.error_estimate()}))
        .collect();
    json!({
        "name": model.name,
        "dofs": model.provenance.dofs,
        "nodes": model.provenance.nodes,
        "elements": model.provenance.elements,
        "element": model.provenance.element,
        "sectors": model.sectors,
        "flank_loads": model.grid.len(),
        "symmetry": model.checks.symmetry,
        "pattern_identity": model.checks.pattern_identity,
        "further": model.checks.further.iter().cloned().collect::<std::collections::BTreeMap<_, _>>(),
        "gauges": gauges,
        "crack": model.crack.as_ref().map(|crack| json!({
            "tooth": crack.tooth,
            "side": crack.side.to_string(),
            "mouth_radius_mm": crack.mouth_radius_m * 1e3,
            "depth_mm": crack.depth_m * 1e3,
            "angle_deg": crack.angle_rad.to_degrees(),
            "rows": crack.count(model.teeth, model.grid.len()),
            "left_out": crack.left_out,
        })),
        "mass_kg": model.rigid_body.as_ref().map(|body| body.mass_kg),
        "natural_frequencies_Hz": model.modes.as_ref().map(|modes| modes.frequencies_hz()),
        "stage_seconds": model.provenance.stage_seconds.iter().map(|(n, s)| json!({"stage": n, "seconds": s})).collect::<Vec<_>>(),
        "effort": model.provenance.effort.iter().cloned().collect::<std::collections::BTreeMap<_, _>>(),
    })
}

/// The figures of a model for people.
pub fn summary(model: &ReducedGear) -> Vec<String> {
    let p = &model.provenance;
    let mut lines = vec![
        format!(
            "{}: {} nodes, {} {} elements, {} degrees of freedom, {} repeating sectors",
            model.name, p.nodes, p.elements, p.element, p.dofs, model.sectors
        ),
        format!(
            "flank grid {} x {}, {} slices; C_hub asymmetry {:.1e}, pattern identity {:.1e}",
            model.grid.roll_angles_rad.len(),
            model.grid.z_m.len(),
            model.grid.slices,
            model.checks.symmetry,
            model.checks.pattern_identity
        ),
    ];
    for (name, value) in &model.checks.further {
        // Estimates are per cents; identities that hold to rounding would read as zero.
        lines.push(if value.abs() < 1e-5 {
            format!("{name}: {value:.1e}")
        } else {
            format!("{name}: {:.2} %", 100.0 * value)
        });
    }
    for name in [
        ReductionChecks::LOADED_TOOTH_ERROR,
        ReductionChecks::OTHER_TEETH_ERROR,
        ReductionChecks::BOTH_TEETH_ERROR,
    ] {
        if model.checks.further(name).is_none() {
            lines.push(format!("{name}: {}", mesh_error(None)));
        }
    }
    for g in &model.gauges {
        let error = mesh_error(g.error_estimate());
        lines.push(format!(
            "gauge {}: {}; mesh error {error}",
            g.name, g.description
        ));
    }
    if let Some(crack) = &model.crack {
        let rows = crack.count(model.teeth, model.grid.len());
        lines.push(format!(
            "{}; {rows} rows, more would add at most {:.0e} of its compliance",
            crack.description(),
            crack.left_out
        ));
    }
    lines.extend(of_body(model));
    let list = |shown: Vec<String>| shown.join(", ");
    let times = p.stage_seconds.iter();
    let times = times.map(|(name, s)| format!("{name} {s:.1} s"));
    lines.push(format!(
        "time on {} threads: {}",
        p.threads,
        list(times.collect())
    ));
    if !p.effort.is_empty() {
        let counts = p
            .effort
            .iter()
            .map(|(name, count)| format!("{count} {name}"));
        lines.push(format!("effort: {}", list(counts.collect())));
    }
    lines
}

/// Mass, support and natural modes, where the model has them.
fn of_body(model: &ReducedGear) -> Vec<String> {
    let mut lines = Vec::new();
    if let Some(body) = &model.rigid_body {
        let support = match &model.reference_point {
            Some(_) => "bore rigid on a reference point",
            None if model
                .input
                .definition()
                .is_some_and(|gear| gear.blank.cut_into_shaft().is_some()) =>
            {
                "faces of the shaft fixed"
            }
            None => "bore fixed",
        };
        lines.push(format!("mass {:.4} kg, {support}", body.mass_kg));
    }
    if let Some(basis) = &model.modes {
        lines.push(format!(
            "{} natural modes up to {:.1} Hz, the lowest at {:.1} Hz with {} nodal diameters",
            basis.count(),
            basis.complete_to_hz,
            basis.frequencies_hz()[0],
            basis.nodal_diameters[0]
        ));
    }
    lines
}
