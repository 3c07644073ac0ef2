//! Columns of a result as a page shows them: units, readable names, groups that share a chart.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use gearmesh_model::FileError;
use gearmesh_scene::system_run::{MeshPassing, SystemResult, is_of_pair, rank, stem};

use crate::page::{Axis, LineChart, LineSeries, Section, Text};
use crate::short_number::usual_unit;

/// Charts of one section; what is left out is named.
pub(super) const MOST_CHARTS: usize = 24;

pub(super) fn quantity(unit: &str) -> &'static str {
    match unit {
        "N" => "force",
        "N/m" => "line load",
        "N·m" => "moment",
        "m" => "length",
        "rad" => "angle",
        "m/s" => "speed",
        "rad/s" => "angular velocity",
        "m/s²" => "acceleration",
        "rad/s²" => "angular acceleration",
        "√kg·m" => "modal coordinate",
        "Hz" => "frequency",
        "Pa" => "pressure",
        "µε" => "strain",
        "J" => "energy",
        "W" => "power",
        "" | "1" => "number",
        _ => "quantity",
    }
}

/// The meshes that turned.
pub(super) fn turning(passings: &[MeshPassing]) -> impl Iterator<Item = &MeshPassing> {
    passings.iter().filter(|mesh| mesh.frequency_hz > 0.0)
}

/// The second half of a column of a result.
pub(super) fn half(r: &SystemResult, column: &str) -> Result<Vec<f64>, FileError> {
    let all = r.rows.read(column)?;
    Ok(all[all.len() / 2..].to_vec())
}

/// Mean of some values.
pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// Columns that make one chart: title, unit, and the columns with the names of their curves.
pub(super) struct Group {
    pub(super) title: String,
    pub(super) unit: String,
    pub(super) columns: Vec<(String, String)>,
}

/// Columns that vary, by owner and unit, those first that a reader asks for first.
pub(super) fn groups(r: &SystemResult, varies: impl Fn(usize) -> bool) -> Vec<Group> {
    let mut order: Vec<(u8, String)> = Vec::new();
    let mut groups: BTreeMap<String, Group> = BTreeMap::new();
    for (place, column) in r.rows.columns().iter().enumerate() {
        let parts: Vec<&str> = column.name.split('/').collect();
        let [kind, owners @ .., last] = &parts[..] else {
            continue;
        };
        let (stem, unit) = (stem(last, &column.unit), &column.unit[..]);
        let Some((title, curve)) = chart_of(kind, &owners.join(" "), stem, unit) else {
            continue;
        };
        // Pairs of teeth have pictures of their own.
        if !varies(place) || (*kind == "elements" && is_of_pair(last)) {
            continue;
        }
        let key = (rank(&column.name), title.clone());
        // A chart stands where its foremost column stands.
        match order.iter_mut().find(|(_, known)| *known == title) {
            Some(known) => known.0 = known.0.min(key.0),
            None => order.push(key),
        }
        let group = groups.entry(title.clone()).or_insert(Group {
            title,
            unit: unit.to_owned(),
            columns: Vec::new(),
        });
        group.columns.push((column.name.clone(), curve));
    }
    order.sort_by_key(|key| key.0);
    let mut groups: Vec<Group> = (order.iter())
        .filter_map(|(_, title)| groups.remove(title))
        .collect();
    for group in &mut groups {
        if let ([(column, curve)], true) = (&group.columns[..], group.is_of_elements()) {
            let owner = column.split('/').nth(1).unwrap_or_default();
            group.title = format!("{owner}, {curve}");
        }
    }
    groups
}

/// Title of the chart that shows a column, and the name of its curve; none of what no chart shows.
fn chart_of(kind: &str, owner: &str, stem: &str, unit: &str) -> Option<(String, String)> {
    let words = stem.replace('_', " ");
    // Speeds of all bodies share a chart; places and angles have one for each body.
    let of_all = |what: &str| {
        Some((
            format!("{what} about the bodies' own z axes"),
            owner.to_owned(),
        ))
    };
    let title = match kind {
        "elements" if stem.starts_with("force_world_") => format!("{owner}, force in world axes"),
        // One chart an axis for all balls of a bearing.
        "elements" if unit == "m/s²" && stem.contains("_acceleration_") => {
            let (ball, axis) = stem.split_once("_acceleration_").unwrap_or((stem, ""));
            let title = format!("{owner}, acceleration along {axis} of the balls");
            return Some((title, ball.replace('_', " ")));
        }
        "elements" => format!("{owner}, {}", quantity(unit)),
        "bodies" if stem == "angular_velocity_z" => return of_all("Angular velocities"),
        "joints" if stem.contains("_world_") => {
            let quantity = quantity(unit);
            format!("{owner}, {quantity} of the joint on body 2 in world axes")
        }
        "joints" if matches!(unit, "N" | "N·m") => {
            format!("{owner}, {} of the joint on body 2", quantity(unit))
        }
        "bodies" if unit == "m" => format!("{owner}, place"),
        "bodies" if unit == "√kg·m" => format!("{owner}, modal coordinates"),
        "bodies" if unit == "rad/s²" && stem.ends_with('z') => {
            return of_all("Angular accelerations");
        }
        _ => return None,
    };
    Some((title, words))
}

impl Group {
    /// A chart of all curves over some abscissas: `values` of each column.
    pub(super) fn chart(
        &self,
        title: String,
        (x, x_values): (Axis, Vec<f64>),
        values: impl FnMut(&(String, String)) -> Result<Vec<f64>, FileError>,
    ) -> Result<LineChart, FileError> {
        let curves = self.columns.iter().map(values);
        let mut curves = curves.collect::<Result<Vec<_>, _>>()?;
        let unit = scaled(&self.unit, curves.iter_mut());
        let chart = LineChart::new(title, x, Axis::new(self.ordinate(), unit)).x_values(x_values);
        let series = self.columns.iter().zip(curves);
        let series = series.map(|((_, name), values)| LineSeries::new(name.clone(), values));
        Ok(series.fold(chart, LineChart::series))
    }

    /// What the ordinate shows, without its unit.
    pub(super) fn ordinate(&self) -> &str {
        match &self.columns[..] {
            [(_, curve)] if self.is_of_elements() => curve,
            [(column, _), ..] if column.starts_with("bodies/") && self.unit == "m" => "place",
            _ => quantity(&self.unit),
        }
    }

    /// What the ordinate of a spectrum shows: "amplitude" where its unit says of what, else of which number.
    pub(super) fn amplitude(&self) -> String {
        match &self.unit[..] {
            "" | "1" => format!("amplitude of {}", self.ordinate()),
            _ => "amplitude".to_owned(),
        }
    }

    /// Whether all columns are channels of force elements.
    pub(super) fn is_of_elements(&self) -> bool {
        let mut columns = self.columns.iter();
        columns.all(|(column, _)| column.starts_with("elements/"))
    }
}

/// Brings curves to the unit in which they are read; gives the unit.
pub(super) fn scaled<'a, 'u>(
    unit: &'u str,
    curves: impl Iterator<Item = &'a mut Vec<f64>>,
) -> &'u str {
    let curves: Vec<&mut Vec<f64>> = curves.collect();
    let values = curves.iter().flat_map(|curve| curve.iter());
    let largest = values.fold(0.0_f64, |most, x| most.max(x.abs()));
    let (factor, unit) = usual_unit(unit, largest);
    curves.into_iter().flatten().for_each(|x| *x *= factor);
    unit
}

/// The axis of a motion's speed, and the factor that brings rad/s to its rpm: a motion that only turns in the negative
/// sense is drawn by its amount, so that faster is to the right.
pub(super) fn speed_axis(speeds_rad_per_s: impl Iterator<Item = f64>) -> (Axis, f64) {
    let rpm = 60.0 / TAU;
    if speeds_rad_per_s.fold(f64::NEG_INFINITY, f64::max) < 0.0 {
        return (Axis::new("speed in the negative sense", "rpm"), -rpm);
    }
    (Axis::new("speed of the varied motion", "rpm"), rpm)
}

/// Whether a column of a transient result varies by more than rounding.
pub(super) fn varies(r: &SystemResult) -> impl Fn(usize) -> bool {
    let varying = r.varying();
    move |place| varying.get(place).is_some_and(|varies| *varies)
}

pub(super) fn left_out(section: Section, groups: &[Group]) -> Section {
    if groups.len() <= MOST_CHARTS {
        return section;
    }
    let names: Vec<&str> = groups[MOST_CHARTS..]
        .iter()
        .map(|g| g.title.as_str())
        .collect();
    section.push(Text::note(format!(
        "Not shown, but in the file: {}.",
        names.join("; ")
    )))
}

/// How a multiple of a mesh frequency is called.
pub(super) fn harmonic(mesh: &str, multiple: usize) -> String {
    match multiple {
        1 => mesh.to_owned(),
        k => format!("{k}×"),
    }
}
