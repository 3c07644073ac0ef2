//! `gearmesh record`: measured curves into a reference record.

use crate::arguments::RecordArguments;
use crate::console;
use gearmesh_geometry::input::{MOST_TEXT_BYTES, read_bytes};
use gearmesh_model::{write_folder, write_text};
use gearmesh_operations::{Failure, output_name, overwriting, uff};
use gearmesh_report::ReferenceRecord;
use gearmesh_report::measured::{
    Channel, MeasuredError, RecordFiles, RecordRequest, csv_channels, decoded, record_files,
};
use serde_json::json;
use std::path::Path;

/// Runs the command.
pub fn run(a: &RecordArguments) -> Result<(), Failure> {
    if let Some(folder) = &a.output {
        let files = ["record.toml", "data.csv"].map(|name| folder.join(name));
        overwriting::refuse(vec![a.measured.clone()], &files)?;
    }
    let channels = channels_of(a)?;
    let Some(folder) = &a.output else {
        list(&channels, a.json);
        return Ok(());
    };
    let text = |value: &Option<String>| value.clone().unwrap_or_default();
    let request = RecordRequest {
        title: text(&a.title),
        source: text(&a.source),
        angle_origin: text(&a.angle_origin),
        shaft: a.shaft.into(),
        revolutions: a.revolutions as usize,
        columns: a.column.clone(),
        negated: a.negate.clone(),
        units: a.unit.clone(),
        speed_rpm: a.speed_rpm,
        base_radius_mm: a.base_radius_mm,
        from_deg: a.from_deg,
        angle_offset_deg: a.angle_offset_deg,
    };
    let files = record_files(channels, &request).map_err(|error| blame(&a.measured, &error))?;
    let record = checked(&files)?;
    let named = [
        ("data.csv".to_owned(), files.data.clone()),
        ("record.toml".to_owned(), files.description.clone()),
    ];
    write_folder(folder, &named)?;
    files.notes.iter().for_each(console::note);
    let heads: Vec<&str> = record.columns.iter().map(|c| &*c.name).collect();
    if a.json {
        console::json(&json!({
            "record": folder, "columns": heads, "values": record.angle_rad.len(), "notes": files.notes,
        }));
        return Ok(());
    }
    console::data(format!(
        "{}: {} values of {}",
        folder.display(),
        record.angle_rad.len(),
        heads.join(" ")
    ));
    Ok(())
}

/// The record as `gearmesh compare` will read it, before its files are written.
fn checked(files: &RecordFiles) -> Result<ReferenceRecord, Failure> {
    let folder = tempfile::tempdir().map_err(Failure::work)?;
    write_text(&folder.path().join("record.toml"), &files.description)?;
    write_text(&folder.path().join("data.csv"), &files.data)?;
    let record = ReferenceRecord::read(folder.path()).map_err(Failure::input)?;
    for column in &record.columns {
        record
            .series(column)
            .map_err(|error| Failure::input(format!("{}: {error}", column.name)))?;
    }
    Ok(record)
}

fn channels_of(a: &RecordArguments) -> Result<Vec<Channel>, Failure> {
    if output_name::measured_ending(&a.measured)? == output_name::Measured::Table {
        let shown = a.measured.display();
        let bytes = read_bytes(&a.measured, MOST_TEXT_BYTES)
            .map_err(|cause| Failure::input(format!("{shown}: {cause}")))?;
        let (text, written_in) = decoded(bytes);
        if let Some(words) = written_in {
            console::note(format!("{shown}: no UTF-8, read as {words}"));
        }
        return csv_channels(&text, a.angle.as_deref()).map_err(|error| blame(&a.measured, &error));
    }
    let mut functions = uff::read(&a.measured, &console::watch())?;
    let names: Vec<String> = functions.iter().map(|f| f.name.clone()).collect();
    for function in &mut functions {
        // Only what tells it from others belongs to its name.
        if names.iter().filter(|name| **name == function.name).count() == 1 {
            function.condition.clear();
        }
    }
    let mut channels: Vec<Channel> = functions.into_iter().map(Channel::from).collect();
    let Some(angle) = &a.angle else {
        return Ok(channels);
    };
    let Some(place) = channels.iter().position(|c| c.name == *angle) else {
        let names: Vec<&str> = channels.iter().map(|c| &*c.name).collect();
        let error = MeasuredError::NoChannel {
            wanted: angle.clone(),
            known: names.join("; "),
        };
        return Err(blame(&a.measured, &error));
    };
    let angle = channels.remove(place);
    for channel in &mut channels {
        if channel.x != angle.x {
            let error = MeasuredError::OtherAxis {
                first: angle.name,
                second: channel.name.clone(),
            };
            return Err(blame(&a.measured, &error));
        }
        channel.axis.clone_from(&angle.name);
        channel.axis_unit.clone_from(&angle.unit);
        channel.x.clone_from(&angle.y);
    }
    Ok(channels)
}

fn blame(path: &Path, error: &MeasuredError) -> Failure {
    Failure::input(match error {
        MeasuredError::Table { .. } => format!("{}:{error}", path.display()),
        _ => format!("{}: {error}", path.display()),
    })
}

/// Name, unit, axis and range of each channel.
fn list(channels: &[Channel], as_json: bool) {
    let range = |values: &[f64]| {
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        [least, most]
    };
    if as_json {
        let all: Vec<_> = (channels.iter())
            .map(|c| {
                json!({"name": c.name, "unit": c.unit, "axis": c.axis, "axis_unit": c.axis_unit, "values": c.y.len(),
                       "range": range(&c.y), "axis_range": range(&c.x)})
            })
            .collect();
        console::json(&json!({ "channels": all }));
        return;
    }
    console::data(format!(
        "{:<40} {:>10} {:>8} {:>24}  axis",
        "channel", "unit", "values", "least to largest"
    ));
    for channel in channels {
        let ([least, most], [from, to]) = (range(&channel.y), range(&channel.x));
        console::data(format!(
            "{:<40} {:>10} {:>8} {:>24}  {} [{}] {from:.6} to {to:.6}",
            channel.name,
            shown_unit(&channel.unit),
            channel.y.len(),
            format!("{least:.5e} to {most:.5e}"),
            channel.axis,
            shown_unit(&channel.axis_unit),
        ));
    }
}

fn shown_unit(unit: &str) -> &str {
    if unit.is_empty() { "?" } else { unit }
}
