//! Time histories, spectra, energy and accuracy of a run in time.

use gearmesh_model::FileError;
use gearmesh_scene::system_run::{
    RunRecord, SystemResult, is_prominent, noticeable, rank, split_unit,
};
use gearmesh_signal::{Window, amplitude_spectrum};

use super::columns::{
    MOST_CHARTS, groups, left_out, mesh_frequencies, quantity, readable, scaled, varies,
};
use crate::min_max;
use crate::page::{
    Align, Axis, AxisScale, KeyFigures, LineChart, LineSeries, Section, Table, Text,
};
use crate::short_number::{short, usual_unit};

/// Lines of a series that are transformed: the last so many.
const LONGEST: usize = 1 << 20;

/// Decades below the strongest line that a spectrum shows.
const DECADES: f64 = 1e-6;

/// Harmonics of a mesh frequency that are marked.
const HARMONICS: usize = 5;

/// Highest frequency of a spectrum over the mesh frequency.
const SPECTRUM_END: f64 = 12.0;

/// Meshes whose figures head a page.
const MOST_MESHES: usize = 4;

/// Transmission error and tooth force of the meshes, and the largest radial force of a bearing; of other kinds of
/// results none.
pub(super) fn key_figures(r: &SystemResult) -> KeyFigures {
    let mut figures = KeyFigures::new();
    let columns = || r.rows.columns().iter().map(|c| &*c.name).zip(&r.statistics);
    for mesh in r.head.meshes.iter().take(MOST_MESHES) {
        let of_mesh = format!("elements/{}/", mesh.name);
        let find = |channel: &str| {
            let mut found =
                columns().filter_map(|(name, f)| Some((name.strip_prefix(&of_mesh)?, f)));
            found.find(|(name, _)| *name == channel).map(|(_, f)| f)
        };
        if let Some(te) = find("transmission_error_m") {
            let label = format!("{}: TE peak to peak", mesh.name);
            figures = figures.figure(label, short(1e6 * te.peak_to_peak()), "µm");
        }
        let sides = ["normal_force_right_N", "normal_force_left_N"];
        let forces = sides.iter().filter_map(|side| find(side)).map(|f| f.mean);
        if let Some(force) = forces.reduce(f64::max) {
            let label = format!("{}: mean normal force", mesh.name);
            figures = figures.figure(label, short(force), "N");
        }
    }
    let radial = columns().filter(|(name, _)| name.ends_with("/force_radial_N"));
    if let Some((name, f)) = radial.max_by(|a, b| a.1.largest.total_cmp(&b.1.largest)) {
        let bearing = name.split('/').nth(1).unwrap_or_default();
        let label = format!("largest bearing force: {bearing}");
        figures = figures.figure(label, short(f.largest), "N");
    }
    figures
}

/// The last rank that the first table of a page has: meshes, bearings, strain, line loads, speeds.
pub(super) const LAST_RANK: u8 = 5;

/// Meshes, bearings and speeds at a glance, and folded all other force elements.
pub(super) fn columns_tables(r: &SystemResult) -> Result<[Table; 2], FileError> {
    let mut tables = [
        Table::new("Meshes, bearings and speeds over the whole run"),
        Table::new("Springs, couplings and beams over the whole run").folded(),
    ]
    .map(|table| {
        table
            .column("column", Align::Left)
            .column("unit", Align::Left)
            .column("mean", Align::Right)
            .column("RMS about the mean", Align::Right)
            .column("least", Align::Right)
            .column("largest", Align::Right)
            .column("peak to peak", Align::Right)
            .column("dominant Hz", Align::Right)
    });
    let mut found = r.summaries(is_prominent)?;
    let mut shown = {
        let extremes = found
            .iter()
            .map(|c| (&*c.name, c.figures.least, c.figures.largest));
        noticeable(extremes).into_iter()
    };
    found.retain(|_| shown.next().unwrap_or(false));
    found.sort_by_key(|column| rank(&column.name));
    let passings = r.mesh_passings()?;
    for column in found {
        let (name, unit) = split_unit(&column.name);
        let f = column.figures;
        let (factor, unit) = usual_unit(unit, f.least.abs().max(f.largest.abs()));
        let place = usize::from(rank(&column.name) > LAST_RANK);
        let incomplete = passings
            .iter()
            .any(|mesh| mesh.leaves_incomplete(&column.name));
        tables[place].push_row([
            readable(name) + if incomplete { " (incomplete)" } else { "" },
            unit.to_owned(),
            short(factor * f.mean),
            short(factor * f.deviation),
            short(factor * f.least),
            short(factor * f.largest),
            short(factor * f.peak_to_peak()),
            column.dominant_hz.map_or("-".to_owned(), short),
        ]);
    }
    Ok(tables)
}

pub(super) fn histories(r: &SystemResult) -> Result<Section, FileError> {
    let times = r.rows.read("time_s")?;
    let x = min_max::abscissas(&times);
    let groups = groups(r, varies(r));
    let mut section = Section::new(format!("{}: time histories", r.head.title));
    for group in groups.iter().take(MOST_CHARTS) {
        let read = |(column, _): &(String, String)| r.rows.read(column);
        let columns = group.columns.iter().map(read);
        let mut curves = columns.collect::<Result<Vec<_>, _>>()?;
        curves.iter_mut().for_each(|y| *y = min_max::values(y));
        let unit = scaled(group.unit, curves.iter_mut());
        let mut chart = LineChart::new(
            group.title.clone(),
            Axis::new("time", "s"),
            Axis::new(quantity(group.unit), unit),
        )
        .x_values(x.clone());
        for ((_, name), values) in group.columns.iter().zip(curves) {
            chart = chart.series(LineSeries::new(name.clone(), values));
        }
        section = section.push(chart);
    }
    if times.len() > x.len() {
        section = section.push(Text::paragraph(format!(
            "{} rows: the charts show the smallest and the largest value of every {}.",
            times.len(),
            (2 * times.len()).div_ceil(x.len())
        )));
    }
    Ok(left_out(section, &groups))
}

/// Amplitude spectra of the channels of force elements, second half of the run.
pub(super) fn spectra(r: &SystemResult) -> Result<Option<Section>, FileError> {
    let interval_s = r.interval_s()?;
    let meshes = mesh_frequencies(r)?;
    let mut section = Section::new(format!("{}: spectra", r.head.title)).push(Text::paragraph(
        "Amplitudes over the second half of the run, mean removed, Hann window. Mesh frequencies are means over that half.",
    ));
    let mut charts = 0;
    for group in groups(r, varies(r)) {
        let of_elements = group.columns.iter().all(|(c, _)| is_prominent(c));
        if !of_elements || charts == MOST_CHARTS {
            continue;
        }
        let mut curves = Vec::new();
        let mut lines = Vec::new();
        for (column, curve) in &group.columns {
            let all = r.rows.read(column)?;
            let half = all.len().div_ceil(2).min(LONGEST);
            let values = &all[all.len() - half..];
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            let centred: Vec<f64> = values.iter().map(|x| x - mean).collect();
            let Ok(spectrum) = amplitude_spectrum(&centred, 1.0 / interval_s, Window::Hann) else {
                continue;
            };
            lines = (0..spectrum.values.len()).map(|i| spectrum.at(i)).collect();
            curves.push((curve, spectrum.values));
        }
        let end = meshes
            .iter()
            .map(|(_, hz)| SPECTRUM_END * hz)
            .fold(0.0_f64, f64::max);
        let shown = if end > 0.0 {
            lines.partition_point(|f| *f <= end)
        } else {
            lines.len()
        };
        if shown < 4 {
            continue;
        }
        if curves
            .iter()
            .all(|(_, values)| values[1..shown].iter().all(|v| *v == 0.0))
        {
            continue;
        }
        let unit = scaled(group.unit, curves.iter_mut().map(|(_, values)| values));
        let strongest = curves
            .iter()
            .flat_map(|(_, values)| values[1..shown].iter().copied())
            .fold(0.0, f64::max);
        let mut chart = LineChart::new(
            group.title.clone(),
            Axis::new("frequency", "Hz"),
            Axis::new("amplitude", unit),
        )
        .y_scale(AxisScale::Logarithmic)
        .x_values(min_max::abscissas(&lines[1..shown]));
        for (curve, values) in curves {
            let floor = DECADES * strongest;
            let values = min_max::values(&values[1..shown]);
            let values = values.into_iter().map(|v| v.max(floor)).collect();
            chart = chart.series(LineSeries::new(curve.clone(), values));
        }
        for (name, hz) in &meshes {
            for k in 1..=HARMONICS {
                chart = chart.mark(
                    k as f64 * hz,
                    if k == 1 {
                        name.clone()
                    } else {
                        format!("{k}×")
                    },
                );
            }
        }
        section = section.push(chart);
        charts += 1;
    }
    Ok((charts > 0).then_some(section))
}

pub(super) fn accuracy(r: &SystemResult) -> Result<Section, FileError> {
    let times = r.rows.read("time_s")?;
    let x = min_max::abscissas(&times);
    let chart = |title: &str, y: Axis, curves: &[(&str, &str)], scale| {
        let mut chart = LineChart::new(title, Axis::new("time", "s"), y)
            .y_scale(scale)
            .x_values(x.clone());
        for (column, curve) in curves {
            let values = r.rows.read(column)?;
            chart = chart.series(LineSeries::new(*curve, min_max::values(&values)));
        }
        Ok::<_, FileError>(chart)
    };
    let mut section = Section::new(format!("{}: energy and accuracy", r.head.title));
    if let Some(record) = &r.record {
        section = section.push(run_table(record));
    }
    Ok(section
        .push(chart(
            "Energies",
            Axis::new("energy", "J"),
            &[
                ("energy/kinetic_J", "kinetic"),
                ("energy/potential_J", "potential"),
                ("energy/dissipated_J", "dissipated"),
                ("energy/supplied_J", "supplied"),
            ],
            AxisScale::Linear,
        )?)
        .push(chart(
            "Error of the energy balance",
            Axis::new("energy", "J"),
            &[("energy/error_J", "error")],
            AxisScale::Linear,
        )?)
        .push(chart(
            "Largest violation of a joint so far",
            Axis::new("violation", "m or rad"),
            &[("run/largest_violation", "violation")],
            AxisScale::Logarithmic,
        )?)
        .push(chart(
            "Step",
            Axis::new("step", "s"),
            &[("run/step_s", "step")],
            AxisScale::Logarithmic,
        )?))
}

pub(super) fn run_table(record: &RunRecord) -> Table {
    let mut table = Table::new("The run")
        .column("figure", Align::Left)
        .column("value", Align::Right)
        .column("unit", Align::Left);
    for (name, unit, value) in record.entries() {
        let (stem, _) = split_unit(name);
        let (value, unit) = match unit {
            "1" => (format!("{value}"), ""),
            _ => (short(value), unit),
        };
        table = table.row([stem.replace('_', " "), value, unit.to_owned()]);
    }
    table
}
