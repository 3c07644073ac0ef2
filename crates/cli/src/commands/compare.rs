//! `gearmesh compare`: a result against a reference record, both through the rig pipeline.

use crate::arguments::CompareArguments;
use crate::console;
use crate::failure::Failure;
use gearmesh_report::system_comparison::{SystemSelection, compare_system};
use gearmesh_report::{ReferenceRecord, comparison_table, scene_comparison::compare_scene};
use gearmesh_scene::ResultFile;
use serde_json::json;

/// Runs the command.
pub fn run(a: &CompareArguments) -> Result<(), Failure> {
    let record = || ReferenceRecord::read(&a.reference).map_err(Failure::input);
    let (title, record, comparisons) = match ResultFile::open(&a.result).map_err(Failure::input)? {
        ResultFile::System(result) => {
            let record = record()?;
            let start_angle_deg = a.start_angle_deg.unwrap_or(0.0);
            if !start_angle_deg.is_finite() {
                return Err(Failure::input(format!(
                    "--start-angle-deg: found {start_angle_deg}, allowed is a finite number"
                )));
            }
            let selection = SystemSelection {
                columns: a.column.iter().cloned().collect(),
                from_s: a.from_s,
                start_angle_rad: start_angle_deg.to_radians(),
            };
            let found = compare_system(&result, &record, &selection).map_err(Failure::input)?;
            (result.head.title, record, found)
        }
        ResultFile::Pair(result) => {
            refuse_options_of_systems(a)?;
            let record = record()?;
            let found = compare_scene(&result, &record).map_err(Failure::input)?;
            (result.title, record, found)
        }
    };
    if a.json {
        let list = serde_json::to_value(&comparisons).map_err(Failure::work)?;
        console::json(&json!({
            "record": record.title, "kind": record.kind.to_string(), "shaft": record.shaft,
            "revolutions": record.revolutions, "comparisons": list,
        }));
    } else {
        console::data(format!(
            "{title} against `{}` ({})",
            record.title, record.kind
        ));
        console::data(format!(
            "angles and orders of the shaft of {}, {} revolution(s)",
            record.shaft, record.revolutions
        ));
        console::data(comparison_table(&comparisons));
    }
    Ok(())
}

fn refuse_options_of_systems(a: &CompareArguments) -> Result<(), Failure> {
    let given = [
        ("--column", !a.column.is_empty()),
        ("--from-s", a.from_s.is_some()),
        ("--start-angle-deg", a.start_angle_deg.is_some()),
    ];
    match given.iter().find(|(_, given)| *given) {
        Some((option, _)) => Err(Failure::input(format!(
            "{option} is for results of multibody scenes; {} is that of a [pair]: leave it out",
            a.result.display()
        ))),
        None => Ok(()),
    }
}
