//! `gearmesh tca`: tooth contact analysis of a bevel pair.

use crate::arguments::TcaArguments;
use crate::console;
use gearmesh_operations::Failure;
use gearmesh_operations::tca::{TcaRequest, tca};

/// Runs the command.
pub fn run(a: &TcaArguments) -> Result<(), Failure> {
    let request = TcaRequest {
        pair: a.pair.clone(),
        report: a.report.clone(),
        stress: a.stress,
        field_gear: a.field_gear,
        field_angle_deg: a.field_angle_deg,
        field_torque_nm: a.field_torque_Nm,
        field_output: a.field_output.clone(),
    };
    let found = tca(&request, &console::watch())?;
    if a.json {
        console::json(&found.figures);
    } else {
        found.lines.into_iter().for_each(console::data);
    }
    Ok(())
}
