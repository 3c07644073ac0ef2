//! `gearmesh reduce`: the offline stage.

use crate::arguments::ReduceArguments;
use crate::console::StageBar;
use crate::failure::Failure;
use crate::{console, memory, offline, output_name};
use gearmesh_bevel::BevelGear;
use gearmesh_model::{ReducedGear, ReductionChecks, write_reduced_gear};
use gearmesh_reduction::bevel::reduce_bevel;
use gearmesh_reduction::{OfflineJob, ReductionOptions};
use serde_json::json;

/// Runs the command.
pub fn run(arguments: &ReduceArguments) -> Result<(), Failure> {
    output_name::demand_hdf5(&arguments.output)?;
    if let Some(gear) = offline::bevel_gear(&arguments.gear)? {
        return bevel(arguments, &gear);
    }
    let gear = offline::gear(&arguments.gear)?;
    let model = match gear.blank.meshed() {
        Some(body) => {
            if !arguments.no_error_estimate {
                console::note("no error estimate: the mesh is given, there is no coarser one");
            }
            offline::reduced_import(&gear, body)?
        }
        None => {
            offline::note_element(&gear);
            let even_if_short = arguments.even_if_memory_is_short;
            memory::demand(
                &gear,
                &arguments.gear,
                OfflineJob::Reduction {
                    estimate_error: !arguments.no_error_estimate,
                },
                even_if_short,
            )?;
            offline::reduced(&gear, !arguments.no_error_estimate)?.0
        }
    };
    write(arguments, &model)
}

fn bevel(arguments: &ReduceArguments, gear: &BevelGear) -> Result<(), Failure> {
    let options = ReductionOptions {
        estimate_error: !arguments.no_error_estimate,
    };
    let bar = StageBar::new(&gear.name);
    let outcome = reduce_bevel(gear, options, &bar);
    bar.finish();
    let (model, body) = outcome.map_err(|error| Failure::from(error).about(&arguments.gear))?;
    offline::note_body_grid(body.mesh.body_grid());
    write(arguments, &model)
}

fn write(arguments: &ReduceArguments, model: &ReducedGear) -> Result<(), Failure> {
    write_reduced_gear(&arguments.output, model).map_err(Failure::work)?;
    if arguments.json {
        console::json(&figures(model));
    } else {
        summary(model).into_iter().for_each(console::data);
    }
    Ok(())
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
    ] {
        if model.checks.further(name).is_none() {
            lines.push(format!("{name}: {}", console::mesh_error(None)));
        }
    }
    for g in &model.gauges {
        let error = console::mesh_error(g.error_estimate());
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
    let times: Vec<String> = p
        .stage_seconds
        .iter()
        .map(|(name, s)| format!("{name} {s:.1} s"))
        .collect();
    lines.push(format!(
        "time on {} threads: {}",
        p.threads,
        times.join(", ")
    ));
    if !p.effort.is_empty() {
        let counts: Vec<String> = p
            .effort
            .iter()
            .map(|(name, count)| format!("{count} {name}"))
            .collect();
        lines.push(format!("effort: {}", counts.join(", ")));
    }
    lines
}
