//! `gearmesh report`: one HTML page for one or more results.

use crate::arguments::ReportArguments;
use crate::console;
use gearmesh_operations::Failure;
use gearmesh_operations::report::{ReportRequest, report};

/// Runs the command.
pub fn run(a: &ReportArguments) -> Result<(), Failure> {
    let request = ReportRequest {
        results: a.results.clone(),
        output: a.output.clone(),
        stress: a.stress,
        stress_at_s: a.stress_at_s,
        stress_angle_deg: a.stress_angle_deg,
        scene_folder: a.scene_folder.clone(),
        reference: a.reference.clone(),
    };
    let told = report(&request, &console::watch())?;
    if a.json {
        console::json(&told);
    }
    Ok(())
}
