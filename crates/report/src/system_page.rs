//! Sections of the report of a multibody scene.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use gearmesh_model::FileError;
use gearmesh_scene::system_run::{EigenResult, Figures, RunRecord, SweepResult, SystemResult};
use gearmesh_signal::{Window, amplitude_spectrum};

use crate::min_max;
use crate::page::{
    Align, Axis, AxisScale, KeyFigures, LineChart, LineSeries, LineStyle, Section, SeriesColour,
    Table, Text,
};

/// Charts of one section; what is left out is named.
const MOST_CHARTS: usize = 24;

/// Lines of a series that are transformed: the last so many.
const LONGEST: usize = 1 << 20;

/// Decades below the strongest line that a spectrum shows.
const DECADES: f64 = 1e-6;

/// Harmonics of a mesh frequency that are marked.
const HARMONICS: usize = 5;

/// Highest frequency of a spectrum over the mesh frequency.
const SPECTRUM_END: f64 = 12.0;

/// Bodies named with a mode.
const MOST_BODIES: usize = 3;

/// Suffixes of column names, longest first where one ends another, and their units.
const UNITS: [(&str, &str); 15] = [
    ("_rad_per_s2", "rad/s²"),
    ("_rad_per_s", "rad/s"),
    ("_m_per_s2", "m/s²"),
    ("_m_per_s", "m/s"),
    ("_sqrt_kg_m", "√kg·m"),
    ("_N_per_m", "N/m"),
    ("_ustrain", "µε"),
    ("_Nm", "N·m"),
    ("_N", "N"),
    ("_Pa", "Pa"),
    ("_J", "J"),
    ("_W", "W"),
    ("_rad", "rad"),
    ("_m", "m"),
    ("_s", "s"),
];

/// A column's name without its unit, and the unit.
fn split_unit(name: &str) -> (&str, &'static str) {
    let found = UNITS
        .iter()
        .find_map(|(suffix, unit)| Some((name.strip_suffix(suffix)?, *unit)));
    found.unwrap_or((name, ""))
}

/// All sections of a result.
pub(crate) fn sections(r: &SystemResult) -> Result<Vec<Section>, FileError> {
    let mut sections = vec![overview(r)?];
    match &r.kind[..] {
        "transient" => {
            sections.push(histories(r)?);
            sections.extend(spectra(r)?);
            sections.push(accuracy(r)?);
        }
        "speed-sweep" => {
            if let Some(sweep) = &r.sweep {
                sections.push(sweep_section(r, sweep));
            }
        }
        "static" => sections.push(equilibria(r)?),
        _ => sections.push(eigen(r)),
    }
    sections.push(provenance(r));
    Ok(sections)
}

fn overview(r: &SystemResult) -> Result<Section, FileError> {
    let mut figures = KeyFigures::new();
    if let Some(record) = &r.record {
        figures = figures
            .figure("simulated", format!("{:.4}", record.simulated_s), "s")
            .figure("real-time factor", short(record.real_time_factor()), "1")
            .figure("steps", format!("{}", record.steps), "")
            .figure(
                "joints hold to",
                format!("{:.1e}", record.largest_violation),
                "m or rad",
            )
            .figure(
                "energy error",
                format!("{:.1e}", record.relative_energy_error()),
                "of the largest energy",
            );
    }
    for (name, hz) in mesh_frequencies(r)? {
        figures = figures.figure(format!("mesh frequency {name}"), format!("{hz:.3}"), "Hz");
    }
    let mut section = Section::new(r.head.title.clone());
    if r.record.is_some() {
        section = section.push(figures);
    }
    if r.kind == "transient" {
        section = section.push(columns_table(r)?);
    }
    for note in &r.head.notes {
        section = section.push(Text::note(note.clone()));
    }
    Ok(section)
}

/// Three to four digits.
fn short(value: f64) -> String {
    if value != 0.0 && !(1e-3..1e5).contains(&value.abs()) {
        format!("{value:.3e}")
    } else {
        let digits = (3 - value.abs().max(1e-3).log10().floor() as i32).clamp(0, 6);
        format!("{value:.*}", digits as usize)
    }
}

fn columns_table(r: &SystemResult) -> Result<Table, FileError> {
    let mut table = Table::new("Channels of force elements and speeds over the whole run")
        .column("column", Align::Left)
        .column("unit", Align::Left)
        .column("mean", Align::Right)
        .column("RMS about the mean", Align::Right)
        .column("least", Align::Right)
        .column("largest", Align::Right)
        .column("peak to peak", Align::Right)
        .column("dominant Hz", Align::Right);
    for column in r.summaries(is_prominent)? {
        let (name, unit) = split_unit(&column.name);
        let f = column.figures;
        table = table.row([
            readable(name),
            unit.to_owned(),
            short(f.mean),
            short(f.deviation),
            short(f.least),
            short(f.largest),
            short(f.peak_to_peak()),
            column.dominant_hz.map_or("-".to_owned(), short),
        ]);
    }
    Ok(table)
}

fn is_prominent(name: &str) -> bool {
    name.starts_with("elements/") || name.ends_with("/angular_velocity_z_rad_per_s")
}

/// `elements/mesh/normal_force_right` as `mesh: normal force right`.
fn readable(name: &str) -> String {
    let parts: Vec<&str> = name.split('/').skip(1).collect();
    match parts.split_last() {
        None => name.to_owned(),
        Some((last, [])) => last.replace('_', " "),
        Some((last, before)) => format!("{}: {}", before.join(" "), last.replace('_', " ")),
    }
}

/// Mean mesh frequencies: teeth times speed of gear 1 about its axis.
fn mesh_frequencies(r: &SystemResult) -> Result<Vec<(String, f64)>, FileError> {
    let mut found = Vec::new();
    for mesh in &r.head.meshes {
        for (body, teeth) in mesh.bodies.iter().zip(mesh.teeth) {
            let name = format!("bodies/{body}/angular_velocity_z_rad_per_s");
            let place = r.rows.columns().iter().position(|c| c.name == name);
            if let Some(figures) = place.and_then(|place| r.statistics.get(place)) {
                let hz = teeth as f64 * figures.mean.abs() / TAU;
                if hz > 0.0 {
                    found.push((mesh.name.clone(), hz));
                }
                break;
            }
        }
    }
    Ok(found)
}

/// Columns that make one chart: title, unit, and the columns with the names of their curves.
struct Group {
    title: String,
    unit: &'static str,
    columns: Vec<(String, String)>,
}

/// Columns that vary, by owner and unit: elements, speeds, joints, bodies.
fn groups(r: &SystemResult, varies: impl Fn(usize) -> bool) -> Vec<Group> {
    let mut order: Vec<(u8, String)> = Vec::new();
    let mut groups: BTreeMap<(u8, String), Group> = BTreeMap::new();
    for (place, column) in r.rows.columns().iter().enumerate() {
        let parts: Vec<&str> = column.name.split('/').collect();
        let [kind, owners @ .., last] = &parts[..] else {
            continue;
        };
        let (stem, unit) = split_unit(last);
        let owner = owners.join(" ");
        // Speeds of all bodies share a chart; places and angles have one for each body.
        let (rank, title, curve) = match *kind {
            "elements" => (
                0,
                format!("{owner}, {}", quantity(unit)),
                stem.replace('_', " "),
            ),
            "bodies" if stem == "angular_velocity_z" => (
                1,
                "Angular velocities about the bodies' own z axes".to_owned(),
                owner.clone(),
            ),
            "joints" if matches!(unit, "N" | "N·m") => (
                2,
                format!("{owner}, {} of the joint on body 2", quantity(unit)),
                stem.replace('_', " "),
            ),
            "bodies" if unit == "m" => (3, format!("{owner}, place"), stem.replace('_', " ")),
            "bodies" if unit == "√kg·m" => (
                4,
                format!("{owner}, modal coordinates"),
                stem.replace('_', " "),
            ),
            "bodies" if unit == "rad/s²" && stem.ends_with('z') => (
                5,
                "Angular accelerations about the bodies' own z axes".to_owned(),
                owner.clone(),
            ),
            _ => continue,
        };
        if !varies(place) {
            continue;
        }
        let key = (rank, title.clone());
        if !groups.contains_key(&key) {
            order.push(key.clone());
        }
        let group = groups.entry(key).or_insert(Group {
            title,
            unit,
            columns: Vec::new(),
        });
        group.columns.push((column.name.clone(), curve));
    }
    order.sort_by_key(|key| key.0);
    order.iter().filter_map(|key| groups.remove(key)).collect()
}

fn quantity(unit: &str) -> &'static str {
    match unit {
        "N" => "force",
        "N·m" => "moment",
        "m" => "length",
        "rad" => "angle",
        "m/s" => "speed",
        "rad/s" => "angular velocity",
        "Pa" => "pressure",
        "µε" => "strain",
        "J" => "energy",
        "W" => "power",
        "" => "number",
        _ => "quantity",
    }
}

fn varies(figures: &[Figures]) -> impl Fn(usize) -> bool + '_ {
    |place| {
        figures
            .get(place)
            .is_some_and(|f| f.peak_to_peak() > 1e-9 * f.mean.abs().max(1e-12))
    }
}

fn histories(r: &SystemResult) -> Result<Section, FileError> {
    let times = r.rows.read("time_s")?;
    let x = min_max::abscissas(&times);
    let groups = groups(r, varies(&r.statistics));
    let mut section = Section::new(format!("{}: time histories", r.head.title));
    for group in groups.iter().take(MOST_CHARTS) {
        let mut chart = LineChart::new(
            group.title.clone(),
            Axis::new("time", "s"),
            Axis::new(quantity(group.unit), group.unit),
        )
        .x_values(x.clone());
        for (column, curve) in &group.columns {
            let values = min_max::values(&r.rows.read(column)?);
            chart = chart.series(LineSeries::new(curve.clone(), values));
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

fn left_out(section: Section, groups: &[Group]) -> Section {
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

/// Amplitude spectra of the channels of force elements, second half of the run.
fn spectra(r: &SystemResult) -> Result<Option<Section>, FileError> {
    let interval_s = r.interval_s()?;
    let meshes = mesh_frequencies(r)?;
    let mut section = Section::new(format!("{}: spectra", r.head.title)).push(Text::paragraph(
        "Amplitudes over the second half of the run, mean removed, Hann window. Mesh frequencies are means over the whole run.",
    ));
    let mut charts = 0;
    for group in groups(r, varies(&r.statistics)) {
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
        let strongest = curves
            .iter()
            .flat_map(|(_, values)| values[1..shown].iter().copied())
            .fold(0.0, f64::max);
        if strongest <= 0.0 {
            continue;
        }
        let mut chart = LineChart::new(
            group.title.clone(),
            Axis::new("frequency", "Hz"),
            Axis::new("amplitude", group.unit),
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

fn accuracy(r: &SystemResult) -> Result<Section, FileError> {
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

fn run_table(record: &RunRecord) -> Table {
    let mut table = Table::new("The run")
        .column("figure", Align::Left)
        .column("value", Align::Right)
        .column("unit", Align::Left);
    for (name, unit, value) in record.entries() {
        let (stem, _) = split_unit(name);
        let value = if unit == "1" {
            format!("{value}")
        } else {
            short(value)
        };
        table = table.row([stem.replace('_', " "), value, unit.to_owned()]);
    }
    table
}

fn sweep_section(r: &SystemResult, sweep: &SweepResult) -> Section {
    let mut section = Section::new(format!("{}: speed sweep", r.head.title)).push(Text::paragraph(
        "Each speed goes on from the state that the one before has left: where the curves up and down differ, there are two motions.",
    ));
    if let Some(record) = &r.record {
        section = section.push(run_table(record));
    }
    let rpm = |speed: f64| speed * 60.0 / TAU;
    let mut speeds: Vec<f64> = sweep
        .windows
        .iter()
        .map(|w| rpm(w.speed_rad_per_s))
        .collect();
    speeds.sort_by(f64::total_cmp);
    speeds.dedup_by(|a, b| (*a - *b).abs() < 1e-9 * b.abs().max(1.0));
    let curve = |column: usize, up: bool, value: fn(&Figures) -> f64| -> Vec<f64> {
        let at = |speed: &f64| {
            let windows = sweep.windows.iter().zip(&sweep.figures);
            let mut here = windows.filter(|(w, _)| {
                w.up == up && (rpm(w.speed_rad_per_s) - speed).abs() < 1e-9 * speed.abs().max(1.0)
            });
            here.next().map_or(f64::NAN, |(_, f)| value(&f[column]))
        };
        speeds.iter().map(at).collect()
    };
    let varies = |column: &usize| {
        let figures = sweep.figures.iter().map(|f| &f[*column]);
        figures.fold(0.0_f64, |most, f| most.max(f.peak_to_peak())) > 0.0
    };
    let interesting = |name: &str| {
        is_prominent(name)
            || name.starts_with("joints/") && matches!(split_unit(name).1, "N" | "N·m")
            || name.starts_with("bodies/") && split_unit(name).1 == "m"
    };
    let mut chosen: Vec<usize> = (0..sweep.columns.len())
        .filter(|c| interesting(&sweep.columns[*c]) && varies(c))
        .collect();
    chosen.sort_by_key(|c| !sweep.columns[*c].starts_with("elements/"));
    for &column in chosen.iter().take(MOST_CHARTS) {
        let (name, unit) = split_unit(&sweep.columns[column]);
        let mut chart = LineChart::new(
            readable(name),
            Axis::new("speed", "rpm"),
            Axis::new(quantity(unit), unit),
        )
        .x_values(speeds.clone());
        let figures: [(&str, fn(&Figures) -> f64); 4] = [
            ("peak to peak", Figures::peak_to_peak),
            ("RMS about the mean", |f| f.deviation),
            ("mean", |f| f.mean),
            ("least", |f| f.least),
        ];
        for (k, (figure, value)) in figures.into_iter().enumerate() {
            for (up, way, style) in [
                (true, "up", LineStyle::Solid),
                (false, "down", LineStyle::Dashed),
            ] {
                if !sweep.windows.iter().any(|w| w.up == up) {
                    continue;
                }
                let values = curve(column, up, value);
                let series = LineSeries::new(format!("{figure}, {way}"), values)
                    .style(style)
                    .colour(SeriesColour::Palette(k));
                chart = chart.series(if k == 0 { series } else { series.hidden() });
            }
        }
        section = section.push(chart);
    }
    section
}

fn equilibria(r: &SystemResult) -> Result<Section, FileError> {
    let mut section = Section::new(format!("{}: equilibria", r.head.title));
    let factors = r.rows.read("load_factor")?;
    let varied = r.rows.columns().iter().any(|c| c.name == "angle_rad");
    // Over the angle for each load factor, or over the load factor.
    let (x, axis) = if varied {
        let angles = r.rows.read("angle_rad")?;
        let degrees = angles.iter().map(|a| a.to_degrees()).collect();
        (degrees, Axis::new("angle of the varied motion", "deg"))
    } else {
        (factors.clone(), Axis::new("load factor", ""))
    };
    let x: Vec<f64> = x;
    let mut legs: Vec<(f64, Vec<usize>)> = Vec::new();
    for (row, factor) in factors.iter().enumerate() {
        let key = if varied { *factor } else { 0.0 };
        match legs.last_mut() {
            Some((last, rows)) if last.to_bits() == key.to_bits() => rows.push(row),
            _ => legs.push((key, vec![row])),
        }
    }
    let mut groups = groups(r, |_| true);
    groups.retain(|group| !group.title.starts_with("Angular"));
    let increasing = |rows: &[usize]| rows.windows(2).all(|w| x[w[1]] > x[w[0]]);
    for group in groups.iter().take(MOST_CHARTS) {
        for (factor, rows) in &legs {
            if rows.len() < 2 || !increasing(rows) {
                continue;
            }
            let title = if varied && legs.len() > 1 {
                format!("{}, load factor {factor}", group.title)
            } else {
                group.title.clone()
            };
            let y = Axis::new(quantity(group.unit), group.unit);
            let mut chart = LineChart::new(title, axis.clone(), y)
                .x_values(rows.iter().map(|&row| x[row]).collect());
            for (column, curve) in &group.columns {
                let values = r.rows.read(column)?;
                let values = rows.iter().map(|&row| values[row]).collect();
                chart = chart.series(LineSeries::new(curve.clone(), values));
            }
            section = section.push(chart);
        }
    }
    let mut table = Table::new("Equilibria")
        .column("load factor", Align::Right)
        .column(axis_name(varied), Align::Right);
    let names = r.rows.columns().iter().map(|c| c.name.clone());
    let chosen: Vec<String> = names
        .filter(|name| name.starts_with("elements/"))
        .take(5)
        .collect();
    let mut values = Vec::new();
    for name in &chosen {
        let (stem, unit) = split_unit(name);
        table = table.column(format!("{} {unit}", readable(stem)), Align::Right);
        values.push(r.rows.read(name)?);
    }
    for row in 0..factors.len().min(200) {
        let mut cells = vec![format!("{}", factors[row]), format!("{:.5}", x[row])];
        cells.extend(values.iter().map(|column| format!("{:.6e}", column[row])));
        table = table.row(cells);
    }
    Ok(left_out(section.push(table), &groups))
}

fn axis_name(varied: bool) -> &'static str {
    if varied { "angle deg" } else { "point" }
}

fn eigen(r: &SystemResult) -> Section {
    let mut section = Section::new(format!("{}: natural frequencies", r.head.title));
    if let Some(chart) = campbell(r) {
        section = section.push(chart);
    }
    for found in &r.eigen {
        section = section.push(modes_table(r, found));
    }
    section
}

fn modes_table(r: &SystemResult, found: &EigenResult) -> Table {
    let mut title = format!("Load factor {}", found.point.load_factor);
    if let Some(speed) = found.point.speed_rad_per_s {
        title += &format!(", {:.2} rpm", speed * 60.0 / TAU);
    }
    let mut table = Table::new(title)
        .column("mode", Align::Right)
        .column("frequency Hz", Align::Right)
        .column("damping %", Align::Right)
        .column("share of the kinetic energy", Align::Left);
    for (k, (mode, shares)) in found.modes.iter().zip(&found.participation).enumerate() {
        let mut order: Vec<usize> = (0..shares.len()).collect();
        order.sort_by(|&a, &b| shares[b].total_cmp(&shares[a]));
        let bodies = order
            .iter()
            .take(MOST_BODIES)
            .filter(|&&body| shares[body] > 5e-4)
            .map(|&body| format!("{} {:.1} %", r.bodies[body], 100.0 * shares[body]));
        table = table.row([
            (k + 1).to_string(),
            format!("{:.4}", mode.frequency_hz()),
            format!("{:.3}", 100.0 * mode.damping_ratio()),
            bodies.collect::<Vec<_>>().join(", "),
        ]);
    }
    table
}

/// Frequencies over speed at the first load factor, with the orders of the meshes' teeth.
fn campbell(r: &SystemResult) -> Option<LineChart> {
    let first = r.eigen.first()?.point.load_factor;
    let mut points: Vec<(f64, &EigenResult)> = r
        .eigen
        .iter()
        .filter(|found| found.point.load_factor.to_bits() == first.to_bits())
        .filter_map(|found| Some((found.point.speed_rad_per_s? * 60.0 / TAU, found)))
        .collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points.dedup_by(|a, b| a.0.to_bits() == b.0.to_bits());
    if points.len() < 2 {
        return None;
    }
    let modes = points.iter().map(|(_, found)| found.modes.len()).max()?;
    let speeds: Vec<f64> = points.iter().map(|(speed, _)| *speed).collect();
    let mut chart = LineChart::new(
        "Natural frequencies over speed (by rising frequency), with orders of the meshes",
        Axis::new("speed of the varied motion", "rpm"),
        Axis::new("frequency", "Hz"),
    )
    .x_values(speeds.clone());
    for mode in 0..modes {
        let at = |(_, found): &(f64, &EigenResult)| {
            found.modes.get(mode).map_or(f64::NAN, |m| m.frequency_hz())
        };
        let values = points.iter().map(at).collect();
        let series = LineSeries::new(format!("mode {}", mode + 1), values);
        chart = chart.series(series.colour(SeriesColour::Palette(mode)));
    }
    for mesh in &r.head.meshes {
        for order in 1..=2 {
            let teeth = (order * mesh.teeth[0]) as f64;
            let values = speeds.iter().map(|rpm| teeth * rpm.abs() / 60.0).collect();
            let name = format!("{}: order {teeth} of {}", mesh.name, mesh.bodies[0]);
            chart = chart.series(LineSeries::new(name, values).style(LineStyle::Dotted));
        }
    }
    Some(chart)
}

fn provenance(r: &SystemResult) -> Section {
    let mut section = Section::new(format!("{}: scene", r.head.title)).push(Text::paragraph(
        format!("gearmesh {}, computed {}.", r.version, r.created_utc),
    ));
    if !r.head.inputs.is_empty() {
        section = section.push(Text::preformatted(r.head.inputs.join("\n")));
    }
    section.push(Text::preformatted(r.head.scene_toml.clone()))
}
