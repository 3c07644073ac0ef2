//! Time histories, spectra, energy and accuracy of a run in time.

use gearmesh_model::FileError;
use gearmesh_scene::system_run::{MeshPassing, RunRecord, SystemResult, is_prominent, stem};
use gearmesh_signal::{Spectrum, Window, amplitude_spectrum};

use super::columns::{Group, MOST_CHARTS, groups, harmonic, left_out, scaled, turning, varies};
use crate::min_max;
use crate::page::{Align, Axis, AxisScale, LineChart, LineSeries, Section, Table, Text};
use crate::short_number::short;

/// Lines of a series that are transformed: the last so many.
const LONGEST: usize = 1 << 20;

/// Decades below the strongest line that a spectrum shows.
const DECADES: f64 = 1e-6;

/// Harmonics of a mesh frequency that are marked.
const HARMONICS: usize = 5;

/// Highest frequency of a spectrum over the mesh frequency.
const SPECTRUM_END: f64 = 12.0;

pub(super) fn histories(r: &SystemResult) -> Result<Section, FileError> {
    let times = r.rows.read("time_s")?;
    let x = min_max::abscissas(&times);
    let groups = groups(r, varies(r));
    let mut section = Section::new(format!("{}: time histories", r.head.title));
    for group in groups.iter().take(MOST_CHARTS) {
        let over = (Axis::new("time", "s"), x.clone());
        section = section.push(group.chart(group.title.clone(), over, |(column, _)| {
            Ok(min_max::values(&r.rows.read(column)?))
        })?);
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
pub(super) fn spectra(
    r: &SystemResult,
    passings: &[MeshPassing],
) -> Result<Option<Section>, FileError> {
    let interval_s = r.interval_s()?;
    let meshes: Vec<&MeshPassing> = turning(passings).collect();
    let mut section = Section::new(format!("{}: spectra", r.head.title)).push(Text::paragraph(
        "Amplitudes over the second half of the run, mean removed, Hann window. Mesh frequencies are means over that half.",
    ));
    if r.samples_per_row > 1 {
        section = section.push(Text::paragraph(format!(
            "Rows are {interval_s} s apart, {} samples each: the spectra are those of the samples, without what vibrates faster than rows \
             can tell, and end at {} of half the rate of the rows, {:.1} Hz.",
            r.samples_per_row,
            r.spectrum_band(),
            r.spectrum_band() * 0.5 / interval_s
        )));
    }
    let mut charts = 0;
    for group in groups(r, varies(r)) {
        let of_elements = group.columns.iter().all(|(c, _)| is_prominent(c));
        if !of_elements || charts == MOST_CHARTS {
            continue;
        }
        if let Some(chart) = spectrum_chart(r, &group, interval_s, &meshes)? {
            section = section.push(chart);
            charts += 1;
        }
    }
    Ok((charts > 0).then_some(section))
}

/// Spectra of a group's columns; none where they are too short, or nothing moves.
fn spectrum_chart(
    r: &SystemResult,
    group: &Group,
    interval_s: f64,
    meshes: &[&MeshPassing],
) -> Result<Option<LineChart>, FileError> {
    let mut curves = Vec::new();
    let mut lines = Vec::new();
    for (column, curve) in &group.columns {
        let Some(spectrum) = second_half(&r.read_for_spectrum(column)?, interval_s) else {
            continue;
        };
        let right = (r.spectrum_band() * spectrum.values.len() as f64) as usize;
        lines = (0..right).map(|i| spectrum.at(i)).collect();
        curves.push((curve, spectrum.values[..right].to_vec()));
    }
    let ends = meshes.iter().map(|mesh| SPECTRUM_END * mesh.frequency_hz);
    let end = ends.fold(0.0_f64, f64::max);
    let shown = match end > 0.0 {
        true => lines.partition_point(|f| *f <= end),
        false => lines.len(),
    };
    let still = |values: &[f64]| values[1..shown].iter().all(|v| *v == 0.0);
    if shown < 4 || curves.iter().all(|(_, values)| still(values)) {
        return Ok(None);
    }
    let unit = scaled(&group.unit, curves.iter_mut().map(|(_, values)| values));
    let amplitudes = curves.iter().flat_map(|(_, values)| &values[1..shown]);
    let floor = DECADES * amplitudes.copied().fold(0.0, f64::max);
    let mut chart = LineChart::new(
        group.title.clone(),
        Axis::new("frequency", "Hz"),
        Axis::new(group.amplitude(), unit),
    )
    .y_scale(AxisScale::Logarithmic)
    .x_values(min_max::abscissas(&lines[1..shown]));
    for (curve, values) in curves {
        let values = min_max::values(&values[1..shown]);
        let values = values.into_iter().map(|v| v.max(floor)).collect();
        chart = chart.series(LineSeries::new(curve.clone(), values));
    }
    for mesh in meshes {
        for k in 1..=HARMONICS {
            chart = chart.mark(k as f64 * mesh.frequency_hz, harmonic(&mesh.mesh.name, k));
        }
    }
    Ok(Some(chart))
}

/// The spectrum of the second half of a channel, its mean removed.
fn second_half(all: &[f64], interval_s: f64) -> Option<Spectrum> {
    let half = all.len().div_ceil(2).min(LONGEST);
    let values = &all[all.len() - half..];
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let centred: Vec<f64> = values.iter().map(|x| x - mean).collect();
    amplitude_spectrum(&centred, 1.0 / interval_s, Window::Hann).ok()
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
    section = section
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
        )?);
    // A fixed step is a number of the table.
    let steps = r.rows.read("run/step_s")?;
    if steps.iter().any(|step| *step != steps[0]) {
        section = section.push(chart(
            "Step",
            Axis::new("step", "s"),
            &[("run/step_s", "step")],
            AxisScale::Logarithmic,
        )?);
    }
    Ok(section)
}

pub(super) fn run_table(record: &RunRecord) -> Table {
    let mut table = Table::new("The run")
        .column("figure", Align::Left)
        .column("value", Align::Right)
        .column("unit", Align::Left);
    for (name, unit, value) in record.entries() {
        let stem = stem(name, unit);
        let (value, unit) = match unit {
            "1" => (format!("{value}"), ""),
            _ => (short(value), unit),
        };
        table = table.row([stem.replace('_', " "), value, unit.to_owned()]);
    }
    table
}
