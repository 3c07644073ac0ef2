//! `gearmesh compliance`: deflection along a flank.

use crate::arguments::ComplianceArguments;
use crate::console;
use crate::failure::Failure;
use gearmesh_contact::flank_deflection::{FlankLoad, flank_deflection};
use gearmesh_geometry::involute;
use gearmesh_model::{ReductionChecks, read_reduced_gear};
use serde_json::json;

/// Runs the command.
pub fn run(a: &ComplianceArguments) -> Result<(), Failure> {
    let model = read_reduced_gear(&a.model).map_err(Failure::input)?;
    model.demand_cylindrical().map_err(Failure::input)?;
    let at_tooth = a.at_tooth.unwrap_or(a.tooth);
    for (name, tooth) in [("--tooth", a.tooth), ("--at-tooth", at_tooth)] {
        if tooth >= model.teeth {
            return Err(Failure::input(format!(
                "{name}: found {tooth}, allowed is 0 to {}",
                model.teeth - 1
            )));
        }
    }
    for (name, value) in [
        ("--line-load-N-per-mm", a.line_load_N_per_mm),
        ("--half-width-mm", a.half_width_mm),
    ] {
        if !(value > 0.0 && value.is_finite()) {
            return Err(Failure::input(format!(
                "{name}: found {value}, allowed is more than 0"
            )));
        }
    }
    let radius_mm = |xi: f64| 1e3 * involute::radius_m(xi, model.base_radius_m);
    let stations = &model.grid.roll_angles_rad;
    let (low, high) = (
        radius_mm(stations[0]),
        radius_mm(stations[stations.len() - 1]),
    );
    let mut rows = Vec::new();
    for &radius in &a.radius_mm {
        if !(radius >= low - 1e-6 && radius <= high + 1e-6) {
            return Err(Failure::input(format!(
                "--radius-mm: found {radius}, allowed is {low:.4} to {high:.4}, the involute part of the flank"
            )));
        }
        let load = FlankLoad {
            tooth: a.tooth,
            flank: a.flank,
            radius_m: radius * 1e-3,
            line_load_n_per_m: a.line_load_N_per_mm * 1e3,
            half_width_m: a.half_width_mm * 1e-3,
        };
        rows.push((
            radius,
            flank_deflection(&model, &load, at_tooth, a.local).map_err(Failure::input)?,
        ));
    }
    // Made for a load on tooth 0; on others the body below may differ.
    let mesh_error = model.checks.further(if at_tooth == a.tooth {
        ReductionChecks::LOADED_TOOTH_ERROR
    } else {
        ReductionChecks::OTHER_TEETH_ERROR
    });
    if a.json {
        let list: Vec<_> = rows
            .iter()
            .map(|(radius, d)| {
                let (global, local) = d.means_m();
                json!({"radius_mm": radius, "global_m": global, "local_m": local, "total_m": global + local,
                       "global_per_slice_m": d.global_m, "local_per_slice_m": d.local_m})
            })
            .collect();
        console::json(
            &json!({"gear": model.name, "tooth": a.tooth, "at_tooth": at_tooth, "mesh_error_relative": mesh_error,
                    "rows": list}),
        );
        return Ok(());
    }
    let mesh_error = console::mesh_error(mesh_error);
    console::data(format!(
        "{}: deflection along the {} flank's inward normal at tooth {at_tooth}, line load on tooth {}; mesh error {mesh_error}",
        model.name, a.flank, a.tooth
    ));
    let slices: Vec<String> = (0..model.grid.slices)
        .map(|k| format!("{:>11}", format!("slice {k} um")))
        .collect();
    console::data(format!(
        "{:>9} {:>10} {:>10} {:>10} {}",
        "radius mm",
        "mean um",
        "global um",
        "local um",
        slices.join(" ")
    ));
    for (radius, d) in rows {
        let (global, local) = d.means_m();
        let each: Vec<String> = d
            .global_m
            .iter()
            .zip(&d.local_m)
            .map(|(g, l)| format!("{:>11.5}", (g + l) * 1e6))
            .collect();
        console::data(format!(
            "{radius:>9.4} {:>10.5} {:>10.5} {:>10.5} {}",
            (global + local) * 1e6,
            global * 1e6,
            local * 1e6,
            each.join(" ")
        ));
    }
    Ok(())
}
