//! Curves of a speed sweep, up and down.

use gearmesh_model::Column;
use gearmesh_scene::system_run::{
    Figures, SweepResult, SystemResult, Window, is_prominent, rank, stem,
};

use super::at_a_glance::MOST_MESHES;
use super::columns::{MOST_CHARTS, scaled, speed_axis};
use super::transient::run_table;
use crate::column_words::readable;
use crate::page::{
    Axis, KeyFigures, LineChart, LineSeries, LineStyle, Section, SeriesColour, Text,
};
use crate::short_number::{short, usual_unit};

/// What is drawn over the speed: name and value.
type Figure = (&'static str, fn(&Figures) -> f64);
const FIGURES: [Figure; 4] = [
    ("peak to peak", Figures::peak_to_peak),
    ("RMS about the mean", |f| f.deviation),
    ("mean", |f| f.mean),
    ("least", |f| f.least),
];

/// One figure on one way.
struct Curve {
    name: String,
    /// Place of the figure, which gives the colour.
    place: usize,
    style: LineStyle,
    values: Vec<f64>,
}

/// Where transmission error and forces of each mesh swing most, and where a bearing's force is largest.
pub(super) fn key_figures(sweep: &SweepResult) -> KeyFigures {
    let mut figures = KeyFigures::new();
    // The window in which a figure of a column is largest.
    let peak = |column: usize, value: fn(&Figures) -> f64| {
        let windows = sweep.windows.iter().zip(&sweep.figures);
        let values = windows.map(|(window, figures)| (window, value(&figures[column])));
        values.max_by(|a, b| a.1.total_cmp(&b.1))
    };
    // As the axes of the charts have it: of a motion in the negative sense the amount.
    let (_, per_unit) = speed_axis(sweep.windows.iter().map(|w| w.speed_rad_per_s));
    let at = |window: &Window| {
        let way = if window.up { "up" } else { "down" };
        format!("at {} rpm, {way}", short(window.speed_rad_per_s * per_unit))
    };
    let mut push = |label: String, column: &Column, found: Option<(&Window, f64)>| {
        if let Some((window, value)) = found {
            let (factor, unit) = usual_unit(&column.unit, value.abs());
            let figure = std::mem::take(&mut figures).figure(
                label,
                short(factor * value),
                format!("{unit} {}", at(window)),
            );
            figures = figure;
        }
    };
    let named = || sweep.columns.iter().enumerate();
    let owner = |name: &str| name.split('/').nth(1).unwrap_or_default().to_owned();
    let meshes = named().filter(|(_, column)| column.name.ends_with("/transmission_error_m"));
    for (place, column) in meshes.take(MOST_MESHES) {
        let mesh = owner(&column.name);
        push(
            format!("{mesh}: largest TE peak to peak"),
            column,
            peak(place, Figures::peak_to_peak),
        );
        let of_side = format!("elements/{mesh}/normal_force_");
        let sides = named().filter(|(_, column)| column.name.starts_with(&of_side));
        let forces =
            sides.filter_map(|(place, column)| Some((column, peak(place, |f| f.largest)?)));
        if let Some((column, force)) = forces.max_by(|a, b| a.1.1.total_cmp(&b.1.1)) {
            push(format!("{mesh}: largest normal force"), column, Some(force));
        }
    }
    let radial = named().filter(|(_, column)| column.name.ends_with("/force_radial_N"));
    let forces = radial.filter_map(|(place, column)| Some((column, peak(place, |f| f.largest)?)));
    if let Some((column, force)) = forces.max_by(|a, b| a.1.1.total_cmp(&b.1.1)) {
        push(
            format!("largest bearing force: {}", owner(&column.name)),
            column,
            Some(force),
        );
    }
    figures
}

pub(super) fn sweep_section(r: &SystemResult, sweep: &SweepResult) -> Section {
    let mut section = Section::new(format!("{}: speed sweep", r.head.title)).push(Text::paragraph(
        "Each speed goes on from the state that the one before has left: where the curves up and down differ, there are two motions.",
    ));
    let incomplete = r.incomplete_windows().into_iter();
    section = section.push_all(incomplete.map(Text::note));
    let over = Speeds::of(sweep);
    let columns = chosen(sweep).into_iter().take(MOST_CHARTS);
    section = section.push_all(columns.map(|column| over.chart(sweep, column)));
    section.push_all(r.record.as_ref().map(run_table))
}

/// Columns whose curves are drawn, the foremost first.
fn chosen(sweep: &SweepResult) -> Vec<usize> {
    let varying = sweep.varying();
    let interesting = |column: &Column| {
        let (name, unit) = (&column.name, &column.unit[..]);
        is_prominent(name)
            || name.starts_with("joints/") && matches!(unit, "N" | "N·m")
            || name.starts_with("bodies/") && unit == "m"
    };
    let mut chosen: Vec<usize> = (0..sweep.columns.len())
        .filter(|c| interesting(&sweep.columns[*c]) && varying[*c])
        .collect();
    chosen.sort_by_key(|c| rank(&sweep.columns[*c].name));
    chosen
}

/// The speeds of a sweep, over which its figures are drawn.
struct Speeds {
    axis: Axis,
    /// From rad/s to what the axis shows.
    per_unit: f64,
    /// As the axis shows them, increasing.
    values: Vec<f64>,
}

impl Speeds {
    fn of(sweep: &SweepResult) -> Self {
        let speeds = || sweep.windows.iter().map(|w| w.speed_rad_per_s);
        let (axis, per_unit) = speed_axis(speeds());
        let mut values: Vec<f64> = speeds().map(|speed| speed * per_unit).collect();
        values.sort_by(f64::total_cmp);
        values.dedup_by(|a, b| is_same(*a, *b));
        Self {
            axis,
            per_unit,
            values,
        }
    }

    /// A figure of a column at all speeds on one way; NaN where that way has no such speed.
    fn curve(
        &self,
        sweep: &SweepResult,
        (column, up): (usize, bool),
        value: fn(&Figures) -> f64,
    ) -> Vec<f64> {
        let at = |speed: &f64| {
            let windows = sweep.windows.iter().zip(&sweep.figures);
            let mut here = windows
                .filter(|(w, _)| w.up == up && is_same(w.speed_rad_per_s * self.per_unit, *speed));
            here.next().map_or(f64::NAN, |(_, f)| value(&f[column]))
        };
        self.values.iter().map(at).collect()
    }

    /// All figures of a column on both ways.
    fn chart(&self, sweep: &SweepResult, column: usize) -> LineChart {
        let ways = [
            (true, "up", LineStyle::Solid),
            (false, "down", LineStyle::Dashed),
        ];
        let mut curves = Vec::new();
        for (place, (figure, value)) in FIGURES.into_iter().enumerate() {
            for (up, way, style) in ways {
                if sweep.windows.iter().any(|w| w.up == up) {
                    curves.push(Curve {
                        name: format!("{figure}, {way}"),
                        place,
                        style,
                        values: self.curve(sweep, (column, up), value),
                    });
                }
            }
        }
        let Column { name, unit, .. } = &sweep.columns[column];
        let title = readable(stem(name, unit));
        let label = title.rsplit_once(": ").map_or(&title[..], |(_, what)| what);
        let label = label.to_owned();
        let unit = scaled(unit, curves.iter_mut().map(|curve| &mut curve.values));
        let chart = LineChart::new(title, self.axis.clone(), Axis::new(label, unit));
        let chart = chart.x_values(self.values.clone());
        curves.into_iter().fold(chart, |chart, curve| {
            let series = LineSeries::new(curve.name, curve.values)
                .style(curve.style)
                .colour(SeriesColour::Palette(curve.place));
            chart.series(match curve.place {
                0 => series,
                _ => series.hidden(),
            })
        })
    }
}

/// Whether two speeds are one but for rounding.
fn is_same(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-9 * b.abs().max(1.0)
}
