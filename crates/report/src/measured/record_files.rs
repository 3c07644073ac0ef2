//! The two files of a record from measured channels.

use super::unit::{ANGLE_DEG, LENGTH_UM, STRAIN_USTRAIN, TIME_S, Units, state_units};
use super::{Channel, MeasuredError, channel};
use crate::pair_orders::Shaft;
use crate::quantity::Quantity;
use crate::record_data::parse_head;
use std::fmt::Write;
use std::ops::Range;

/// A record whose end is off its begin by so many of the largest steps between neighbours does not repeat.
const OPEN: f64 = 3.0;

/// What the record is, and which channels it takes.
#[derive(Debug, Clone)]
pub struct RecordRequest {
    /// Title, for people.
    pub title: String,
    /// Where the numbers come from.
    pub source: String,
    /// What angle 0 is.
    pub angle_origin: String,
    /// Whose angle the axis is.
    pub shaft: Shaft,
    /// Revolutions of it after which the record repeats.
    pub revolutions: usize,
    /// Head of data.csv and channel; empty takes every channel whose name with its unit is such a head.
    pub columns: Vec<(String, String)>,
    /// Heads whose sign is changed.
    pub negated: Vec<String>,
    /// Units stated by the user: channel or axis, unit.
    pub units: Vec<(String, String)>,
    /// Constant speed of the shaft \[rpm\], where the axis is a time.
    pub speed_rpm: Option<f64>,
    /// Radius \[mm\] that makes a transmission error in angles one along the line of action.
    pub base_radius_mm: Option<f64>,
    /// Where the revolutions begin \[deg\], on the axis of the file; its begin where none.
    pub from_deg: Option<f64>,
    /// Added to the angle \[deg\].
    pub angle_offset_deg: f64,
}

/// Contents of the two files, and what was left out or turned round, for people.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordFiles {
    /// record.toml.
    pub description: String,
    /// data.csv.
    pub data: String,
    /// Remarks.
    pub notes: Vec<String>,
}

/// Makes the files of a record.
///
/// # Errors
/// [`MeasuredError`].
pub fn record_files(
    mut channels: Vec<Channel>,
    request: &RecordRequest,
) -> Result<RecordFiles, MeasuredError> {
    state_units(&mut channels, &request.units)?;
    let columns = columns_of(&channels, request)?;
    let mut notes = Vec::new();
    let first = columns[0].1;
    let (angle_deg, places) = rising_angles(first, request, &mut notes)?;
    let rows = window(&angle_deg, request)?;
    let left_out = angle_deg.len() - rows.len();
    if left_out > 0 {
        notes.push(format!(
            "{left_out} of {} values lie outside the revolutions and are left out",
            angle_deg.len()
        ));
    }
    check_base_radius(&columns, request)?;
    let mut values = Vec::new();
    for (head, channel) in &columns {
        if channel.x != first.x {
            return Err(MeasuredError::OtherAxis {
                first: first.name.clone(),
                second: channel.name.clone(),
            });
        }
        let sign = if request.negated.contains(head) {
            -1.0
        } else {
            1.0
        };
        let factor = sign * factor(head, channel, request)?;
        let mean = |at: &Range<usize>| {
            let sum: f64 = channel.y[at.clone()].iter().sum();
            factor * sum / at.len() as f64
        };
        let column: Vec<f64> = places.iter().map(mean).collect();
        notes.extend(open_end(head, &column[rows.clone()]));
        values.push(column);
    }
    let mut data = String::from("angle_deg");
    for (head, _) in &columns {
        data.push(',');
        data.push_str(head);
    }
    data.push('\n');
    for row in rows {
        let _ = write!(data, "{}", angle_deg[row] + request.angle_offset_deg);
        for column in &values {
            let _ = write!(data, ",{}", column[row]);
        }
        data.push('\n');
    }
    Ok(RecordFiles {
        description: description(request),
        data,
        notes,
    })
}

/// The axis as an angle that rises, each once, with the rows of the channel that stand at it.
fn rising_angles(
    channel: &Channel,
    request: &RecordRequest,
    notes: &mut Vec<String>,
) -> Result<(Vec<f64>, Vec<Range<usize>>), MeasuredError> {
    let mut angle_deg = angles(channel, request)?;
    notes.extend(without_wraps(&mut angle_deg));
    if angle_deg.last() < angle_deg.first() {
        // A record's angle is positive in the shaft's own sense of turning.
        angle_deg.iter_mut().for_each(|angle| *angle = -*angle);
        notes.push("the angle falls: its sign is changed".to_owned());
    }
    let places = places_of(&angle_deg);
    if places.len() < angle_deg.len() {
        notes.push(format!(
            "{} values stand at the angle of the one before: of each angle the mean is taken",
            angle_deg.len() - places.len()
        ));
        angle_deg = places.iter().map(|rows| angle_deg[rows.start]).collect();
    }
    Ok((angle_deg, places))
}

/// A base radius is stated for a transmission error in angles only.
fn check_base_radius(
    columns: &[(String, &Channel)],
    request: &RecordRequest,
) -> Result<(), MeasuredError> {
    let errors = || columns.iter().filter(|(head, _)| head.starts_with("te_"));
    let mut units = errors().map(|(_, channel)| &channel.unit);
    if request.base_radius_mm.is_none() || units.any(|unit| ANGLE_DEG.factor(unit).is_some()) {
        return Ok(());
    }
    for (_, channel) in errors() {
        if LENGTH_UM.factor(&channel.unit).is_none() {
            ANGLE_DEG.factor_of(&channel.name, &channel.unit)?;
        }
    }
    let problem = "--base-radius-mm: no transmission error of this record is measured as an angle";
    Err(MeasuredError::Option(problem.to_owned()))
}

/// Heads with their channels.
fn columns_of<'a>(
    channels: &'a [Channel],
    request: &RecordRequest,
) -> Result<Vec<(String, &'a Channel)>, MeasuredError> {
    let mut columns = Vec::new();
    for (head, name) in &request.columns {
        parse_head(head).ok_or_else(|| MeasuredError::Head {
            found: head.clone(),
        })?;
        columns.push((head.clone(), channel(channels, name)?));
    }
    if request.columns.is_empty() {
        let named = channels.iter().filter(|c| parse_head(&c.name).is_some());
        columns.extend(named.map(|c| (c.name.clone(), c)));
    }
    if columns.is_empty() {
        let names: Vec<&str> = channels.iter().map(|c| &*c.name).collect();
        return Err(MeasuredError::Option(format!(
            "--column HEAD=CHANNEL says which channels the record takes, such as te_um_200Nm={}; there are: {}",
            names.first().unwrap_or(&""),
            names.join("; ")
        )));
    }
    if let Some(head) = (request.negated.iter()).find(|head| columns.iter().all(|c| c.0 != **head))
    {
        let heads: Vec<&str> = columns.iter().map(|c| &*c.0).collect();
        return Err(MeasuredError::Option(format!(
            "--negate {head}: the record has no such column; it has {}",
            heads.join(" ")
        )));
    }
    Ok(columns)
}

/// The axis as an angle in degrees.
fn angles(channel: &Channel, request: &RecordRequest) -> Result<Vec<f64>, MeasuredError> {
    let unit = &channel.axis_unit;
    let degrees = |factor: f64| channel.x.iter().map(|x| factor * x).collect();
    match (TIME_S.factor(unit), request.speed_rpm) {
        (Some(seconds), Some(rpm)) => Ok(degrees(6.0 * rpm.abs() * seconds)),
        (Some(_), None) => Err(MeasuredError::Option(format!(
            "the axis `{}` is a time; --angle names the channel with the shaft's angle, or --speed-rpm the constant speed of the shaft",
            channel.axis
        ))),
        (None, Some(_)) if ANGLE_DEG.factor(unit).is_some() => Err(MeasuredError::Option(format!(
            "--speed-rpm: the axis `{}` is an angle already",
            channel.axis
        ))),
        _ => Ok(degrees(ANGLE_DEG.factor_of(&channel.axis, unit)?)),
    }
}

/// Lets an angle that begins anew after a turn go on; says how often it did.
fn without_wraps(angle_deg: &mut [f64]) -> Option<String> {
    let forward = angle_deg.windows(2).filter(|p| p[1] > p[0]).count();
    let sense = if 2 * forward < angle_deg.len() {
        -1.0
    } else {
        1.0
    };
    let (mut turns, mut wraps, mut before) = (0.0, 0, None);
    for angle in angle_deg {
        let step = before.map_or(0.0, |before| sense * (*angle - before));
        before = Some(*angle);
        if step < -180.0 {
            turns -= sense * (step / 360.0).round();
            wraps += 1;
        }
        *angle += 360.0 * turns;
    }
    (wraps > 0).then(|| format!("the angle begins anew {wraps} times: it is taken to go on"))
}

/// Rows that stand at one angle.
fn places_of(angle_deg: &[f64]) -> Vec<Range<usize>> {
    let mut places: Vec<Range<usize>> = Vec::new();
    for (row, angle) in angle_deg.iter().enumerate() {
        match places.last_mut() {
            Some(last) if angle_deg[last.start] == *angle => last.end = row + 1,
            _ => places.push(row..row + 1),
        }
    }
    places
}

/// What is to be said of a column whose end does not meet its begin.
fn open_end(head: &str, values: &[f64]) -> Option<String> {
    let (first, last) = (values.first()?, values.last()?);
    let steps = values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let (jump, largest) = ((first - last).abs(), steps.fold(0.0, f64::max));
    (jump > OPEN * largest && largest > 0.0).then(|| {
        format!(
            "{head}: from its end to its begin is a jump of {jump:.4}, {:.1} times the largest step between neighbours: it does not repeat with these revolutions \
             (a drift, other revolutions), and its peak-to-peak value is too large",
            jump / largest
        )
    })
}

/// Rows of the revolutions asked for.
fn window(
    angle_deg: &[f64],
    request: &RecordRequest,
) -> Result<std::ops::Range<usize>, MeasuredError> {
    let mut widest = 0.0_f64;
    for (k, pair) in angle_deg.windows(2).enumerate() {
        if pair[1] <= pair[0] {
            return Err(MeasuredError::AngleOrder {
                place: k + 2,
                before_deg: pair[0],
                found_deg: pair[1],
            });
        }
        widest = widest.max(pair[1] - pair[0]);
    }
    let from_deg = request
        .from_deg
        .unwrap_or_else(|| angle_deg.first().copied().unwrap_or_default());
    let needed_deg = 360.0 * request.revolutions as f64;
    let begin = angle_deg.partition_point(|angle| *angle < from_deg);
    // The angle that closes the revolutions repeats the first and is left out, jitter or not.
    let span_deg = angle_deg.last().unwrap_or(&0.0) - angle_deg.first().unwrap_or(&0.0);
    let mean = span_deg / angle_deg.len().max(2).saturating_sub(1) as f64;
    let close = from_deg + needed_deg - 0.1 * mean;
    let end = angle_deg.partition_point(|angle| *angle < close);
    let covered_deg = match angle_deg.get(begin..end) {
        Some([first, .., last]) => last - first,
        _ => 0.0,
    };
    let starts = angle_deg.get(begin).is_some_and(|a| a - from_deg <= widest);
    if !starts || covered_deg + 2.0 * widest < needed_deg {
        return Err(MeasuredError::TooShort {
            covered_deg,
            from_deg,
            revolutions: request.revolutions,
            needed_deg,
        });
    }
    Ok(begin..end)
}

/// From the unit of a channel to that of its column.
fn factor(head: &str, channel: &Channel, request: &RecordRequest) -> Result<f64, MeasuredError> {
    // A channel that is called like the column is in its unit.
    let stated = !(channel.unit.is_empty() && channel.name == head);
    let of = |units: &Units| match stated {
        true => units.factor_of(&channel.name, &channel.unit),
        false => Ok(1.0),
    };
    let Some((Quantity::TransmissionError, _)) = parse_head(head) else {
        return of(&STRAIN_USTRAIN);
    };
    let degrees = ANGLE_DEG.factor(&channel.unit);
    match (degrees, request.base_radius_mm) {
        (Some(degrees), Some(radius_mm)) => Ok(degrees.to_radians() * radius_mm * 1e3),
        (Some(_), None) => Err(MeasuredError::Option(format!(
            "channel `{}` is a transmission error in {}: --base-radius-mm is the base radius of the gear whose angle it is",
            channel.name, channel.unit
        ))),
        (None, _) => of(&LENGTH_UM),
    }
}

fn description(request: &RecordRequest) -> String {
    let text = |value: &str| toml::Value::String(value.to_owned()).to_string();
    let shaft = match request.shaft {
        Shaft::Gear1 => "gear_1",
        Shaft::Gear2 => "gear_2",
    };
    format!(
        "title = {}\nkind = \"measured\"\nsource = {}\nangle_origin = {}\nshaft = \"{shaft}\"\nrevolutions = {}\n\n\
         [uncertainty]                           # as far as it is known\n# te_mean_um = 0.5\n# te_peak_to_peak_um = 0.2\n# strain_range_ustrain = 10.0\n",
        text(&request.title),
        text(&request.source),
        text(&request.angle_origin),
        request.revolutions
    )
}
