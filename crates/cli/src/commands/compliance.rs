//! `gearmesh compliance`: deflection along a flank.

use crate::arguments::Printed;
use crate::console;
use gearmesh_contact::flank_deflection::FlankDeflection;
use gearmesh_operations::Failure;
use gearmesh_operations::compliance::{ComplianceRequest, compliance};
use gearmesh_operations::reduce::mesh_error;

/// Runs the command.
pub fn run(a: &Printed<ComplianceRequest>) -> Result<(), Failure> {
    let found = compliance(&a.request, &console::watch())?;
    if a.json {
        console::json(&found.figures());
        return Ok(());
    }
    let mesh_error = mesh_error(found.mesh_error);
    console::data(format!(
        "{}: deflection along the {} flank's inward normal at tooth {}, line load on tooth {}; mesh error {mesh_error}",
        found.gear, a.request.flank, found.at_tooth, found.tooth
    ));
    let slices: Vec<String> = (0..found.slices)
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
    for (radius, d) in &found.rows {
        console::data(row(*radius, d));
    }
    if let Some(projected) = &found.projected {
        console::data(format!(
            "by projection on element faces: {} solutions, {:.2} s after mesh and factor ({:.2} s)",
            projected.solutions,
            projected.projection_s + projected.solutions_s,
            projected.factor_s
        ));
        for ((radius, _), d) in found.rows.iter().zip(&projected.deflections) {
            console::data(row(*radius, d));
        }
    }
    Ok(())
}

fn row(radius_mm: f64, d: &FlankDeflection) -> String {
    let (global, local) = d.means_m();
    let each = d.global_m.iter().zip(&d.local_m);
    let each: Vec<String> = each
        .map(|(g, l)| format!("{:>11.5}", (g + l) * 1e6))
        .collect();
    format!(
        "{radius_mm:>9.4} {:>10.5} {:>10.5} {:>10.5} {}",
        (global + local) * 1e6,
        global * 1e6,
        local * 1e6,
        each.join(" ")
    )
}
