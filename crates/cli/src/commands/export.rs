//! `gearmesh export`: a result for other programs; a gear for CAD.

use crate::arguments::ExportArguments;
use crate::console;
use gearmesh_operations::Failure;
use gearmesh_operations::export::{ExportRequest, export};

/// Runs the command.
pub fn run(a: &ExportArguments) -> Result<(), Failure> {
    let request = ExportRequest {
        result: a.result.clone(),
        output: a.output.clone(),
        table: a.table.clone(),
        moments: a.moments,
        stress: a.stress,
        torque_nm: a.torque_Nm,
        from_s: a.from_s,
        to_s: a.to_s,
        scene_folder: a.scene_folder.clone(),
    };
    let found = export(&request, &console::watch())?;
    if a.json {
        console::json(&found.figures);
    } else {
        found.line.into_iter().for_each(console::data);
    }
    Ok(())
}
