//! `gearmesh export`: a result for other programs; a gear for CAD.
//!
//! | what | file |
//! | --- | --- |
//! | tables | `export/tables.rs` |
//! | gears that move | `export/series.rs`, of multibody scenes `export/system_moments.rs` |
//! | a gear's flanks as STEP | `export/step.rs` |

mod series;
mod step;
pub mod system_moments;
mod tables;

use crate::arguments::ExportArguments;
use crate::failure::Failure;
use crate::output_name;

/// Runs the command.
pub fn run(a: &ExportArguments) -> Result<(), Failure> {
    let ending = output_name::export_ending(&a.output)?;
    let moves = ending == ".pvd";
    let is_table = !matches!(ending, ".pvd" | ".step" | ".stp");
    let of_series = [
        ("--moments", a.moments.is_some()),
        ("--torque-Nm", a.torque_Nm.is_some()),
        ("--from-s", a.from_s.is_some()),
        ("--to-s", a.to_s.is_some()),
        ("--scene-folder", a.scene_folder.is_some()),
        ("--stress", a.stress),
    ];
    let given = of_series.iter().filter(|(_, given)| *given && !moves);
    let unused = given.map(|(name, _)| *name);
    let unused = unused.chain((a.table.is_some() && !is_table).then_some("--table"));
    if let Some(name) = unused.into_iter().next() {
        return Err(Failure::input(format!(
            "{name} has no use for a {ending} file; leave it out"
        )));
    }
    match ending {
        ".pvd" => series::run(a),
        ".step" | ".stp" => step::run(a),
        _ => tables::run(a, ending),
    }
}
