//! A result against a reference record, both through the rig pipeline.

use crate::failure::{Failure, Result};
use gearmesh_report::system_comparison::{SystemSelection, compare_system};
use gearmesh_report::{ReferenceRecord, SeriesComparison, scene_comparison::compare_scene};
use gearmesh_scene::ResultFile;
use serde::{Deserialize, Deserializer};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// What is compared.
#[derive(Debug, Clone, clap::Args, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CompareRequest {
    /// Result file
    pub result: PathBuf,
    /// Folder of a reference record (docs/records.md)
    pub reference: PathBuf,
    /// Multibody results: which column of the result belongs to a column of data.csv; may be given several times
    #[arg(long, value_name = "HEAD=COLUMN", value_parser = head_and_column)]
    #[serde(default, deserialize_with = "pairs")]
    pub column: Vec<(String, String)>,
    /// Multibody results: begin at this time [default: the middle of the run]
    #[arg(long)]
    pub from_s: Option<f64>,
    /// Multibody results: the record's angle at the start of the run [default: 0]
    #[arg(long, allow_negative_numbers = true)]
    pub start_angle_deg: Option<f64>,
}

/// Two names with `=` between them.
///
/// # Errors
/// What is allowed.
pub fn head_and_column(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((head, column)) if !head.is_empty() && !column.is_empty() => {
            Ok((head.trim().to_owned(), column.trim().to_owned()))
        }
        _ => Err("allowed is HEAD=COLUMN, a column of data.csv and one of the result".to_owned()),
    }
}

/// Reads names by names.
fn pairs<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<(String, String)>, D::Error> {
    BTreeMap::deserialize(from).map(|named| named.into_iter().collect())
}

/// What the comparison came to.
#[derive(Debug)]
pub struct Compared {
    /// Title of the result.
    pub title: String,
    /// The record.
    pub record: ReferenceRecord,
    /// A comparison a quantity and torque.
    pub comparisons: Vec<SeriesComparison>,
}

impl Compared {
    /// For other programs.
    #[must_use]
    pub fn figures(&self) -> Value {
        json!({
            "record": self.record.title, "kind": self.record.kind.to_string(), "shaft": self.record.shaft,
            "revolutions": self.record.revolutions, "comparisons": self.comparisons,
        })
    }
}

/// Compares a result with a record.
///
/// # Errors
/// [`Failure`] for files that cannot be read or do not belong together, and options of the other kind of result.
pub fn compare(a: &CompareRequest) -> Result<Compared> {
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
            (result.source.title, record, found)
        }
    };
    Ok(Compared {
        title,
        record,
        comparisons,
    })
}

fn refuse_options_of_systems(a: &CompareRequest) -> Result<()> {
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
