//! Curves of a speed sweep, up and down.

use gearmesh_scene::system_run::{
    Figures, SweepResult, SystemResult, is_prominent, rank, split_unit,
};

use super::columns::{MOST_CHARTS, quantity, readable, scaled, speed_axis};
use super::transient::run_table;
use crate::page::{Axis, LineChart, LineSeries, LineStyle, Section, SeriesColour, Text};

/// What is drawn over the speed: name and value.
type Figure = (&'static str, fn(&Figures) -> f64);

/// One figure on one way.
struct Curve {
    name: String,
    /// Place of the figure, which gives the colour.
    place: usize,
    style: LineStyle,
    values: Vec<f64>,
}

pub(super) fn sweep_section(r: &SystemResult, sweep: &SweepResult) -> Section {
    let mut section = Section::new(format!("{}: speed sweep", r.head.title)).push(Text::paragraph(
        "Each speed goes on from the state that the one before has left: where the curves up and down differ, there are two motions.",
    ));
    let (axis, per_unit) = speed_axis(sweep.windows.iter().map(|w| w.speed_rad_per_s));
    let rpm = |speed: f64| speed * per_unit;
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
    let varying = sweep.varying();
    let interesting = |name: &str| {
        is_prominent(name)
            || name.starts_with("joints/") && matches!(split_unit(name).1, "N" | "N·m")
            || name.starts_with("bodies/") && split_unit(name).1 == "m"
    };
    let mut chosen: Vec<usize> = (0..sweep.columns.len())
        .filter(|c| interesting(&sweep.columns[*c]) && varying[*c])
        .collect();
    chosen.sort_by_key(|c| rank(&sweep.columns[*c]));
    for &column in chosen.iter().take(MOST_CHARTS) {
        let (name, unit) = split_unit(&sweep.columns[column]);
        let figures: [Figure; 4] = [
            ("peak to peak", Figures::peak_to_peak),
            ("RMS about the mean", |f| f.deviation),
            ("mean", |f| f.mean),
            ("least", |f| f.least),
        ];
        let mut curves = Vec::new();
        for (k, (figure, value)) in figures.into_iter().enumerate() {
            for (up, way, style) in [
                (true, "up", LineStyle::Solid),
                (false, "down", LineStyle::Dashed),
            ] {
                if !sweep.windows.iter().any(|w| w.up == up) {
                    continue;
                }
                curves.push(Curve {
                    name: format!("{figure}, {way}"),
                    place: k,
                    style,
                    values: curve(column, up, value),
                });
            }
        }
        let label = quantity(unit);
        let unit = scaled(unit, curves.iter_mut().map(|curve| &mut curve.values));
        let mut chart = LineChart::new(readable(name), axis.clone(), Axis::new(label, unit))
            .x_values(speeds.clone());
        for curve in curves {
            let series = LineSeries::new(curve.name, curve.values)
                .style(curve.style)
                .colour(SeriesColour::Palette(curve.place));
            chart = chart.series(if curve.place == 0 {
                series
            } else {
                series.hidden()
            });
        }
        section = section.push(chart);
    }
    if let Some(record) = &r.record {
        section = section.push(run_table(record));
    }
    section
}
