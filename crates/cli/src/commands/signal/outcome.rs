//! What an analysis found: figures, a list, curves; printed, as JSON, CSV or a page.

use crate::arguments::SeriesArguments;
use crate::commands::signal::series::Series;
use crate::console;
use gearmesh_model::{csv_cell, write_text};
use gearmesh_operations::Failure;
use gearmesh_report::min_max;
use gearmesh_report::page::{
    Align, Axis, AxisScale, LineChart, LineSeries, MapChart, Page, Section, Table, capital,
};
use gearmesh_signal::Spectrum;
use serde_json::{Map, Value, json};
use std::fmt::Write;

/// A spectrum is drawn down to this share of its largest line.
const FLOOR: f64 = 1e-6;

/// A column of numbers with its unit.
pub struct Curve {
    name: String,
    unit: String,
    values: Vec<f64>,
}

impl Curve {
    pub fn new(name: &str, unit: &str, values: Vec<f64>) -> Self {
        Self {
            name: name.to_owned(),
            unit: unit.to_owned(),
            values,
        }
    }
}

/// A spectrum that a page draws beside the curves.
pub struct LineSpectrum {
    axis: (&'static str, &'static str),
    unit: String,
    /// Without the mean.
    pub places: Vec<f64>,
    amplitudes: Vec<f64>,
    /// Places with names.
    pub marks: Vec<(f64, String)>,
}

impl LineSpectrum {
    pub fn new(series: &Series, spectrum: &Spectrum) -> Self {
        Self {
            axis: (series.place, series.place_unit),
            unit: series.unit.clone(),
            places: (1..spectrum.values.len())
                .map(|line| spectrum.at(line))
                .collect(),
            amplitudes: spectrum.values.iter().skip(1).copied().collect(),
            marks: Vec::new(),
        }
    }

    /// From zero to a little beyond the last mark; all where nothing is marked.
    fn chart(&self) -> LineChart {
        let (name, unit) = self.axis;
        let mut chart = LineChart::new(
            "Spectrum of the envelope",
            Axis::new(name, unit),
            Axis::new("amplitude", self.unit.clone()),
        )
        .x_values(self.places.clone())
        .series(LineSeries::new("envelope", self.amplitudes.clone()));
        let last = self.marks.iter().map(|(at, _)| *at).fold(0.0, f64::max);
        if last > 0.0 {
            chart = chart.x_window(0.0, 1.1 * last);
        }
        for (at, name) in &self.marks {
            chart = chart.mark(*at, name.clone());
        }
        chart
    }
}

/// Outcome of an analysis.
pub struct Outcome {
    title: String,
    column: String,
    /// Unit of the values.
    unit: String,
    analysis: &'static str,
    place: &'static str,
    figures: Vec<(&'static str, f64, String)>,
    /// Heads and rows of the list.
    pub heads: Vec<String>,
    pub rows: Vec<Vec<f64>>,
    /// Abscissa first.
    pub curves: Vec<Curve>,
    /// Whether ordinates are drawn on a logarithmic scale.
    pub is_logarithmic: bool,
    /// A spectrum that is drawn, too.
    pub spectrum: Option<LineSpectrum>,
    /// A map that is drawn in place of the curves.
    pub map: Option<MapChart>,
}

impl Outcome {
    pub fn new(series: &Series, analysis: &'static str) -> Self {
        Self {
            title: series.title.clone(),
            column: series.column.clone(),
            unit: series.unit.clone(),
            analysis,
            place: series.place,
            figures: Vec::new(),
            heads: Vec::new(),
            rows: Vec::new(),
            curves: Vec::new(),
            is_logarithmic: false,
            spectrum: None,
            map: None,
        }
    }

    /// Adds a figure; what is no number is not there.
    pub fn figure(&mut self, name: &'static str, value: f64, unit: &str) {
        self.figures.push((name, value, unit.to_owned()));
    }

    /// The strongest lines of a spectrum as the list.
    pub fn list_peaks(&mut self, spectrum: &Spectrum, count: usize) {
        self.heads = vec![self.place.to_owned(), "amplitude".to_owned()];
        let found = peaks(spectrum, count);
        let row = |(line, amplitude)| vec![spectrum.at(line), amplitude];
        self.rows = found.into_iter().map(row).collect();
    }

    /// Prints, and writes the file that was asked for.
    pub fn finish(&self, a: &SeriesArguments) -> Result<(), Failure> {
        if let Some(path) = &a.output {
            let extension = path.extension().and_then(|e| e.to_str()).unwrap_or("");
            let text = match extension {
                "csv" => self.csv(),
                "html" => self.page()?,
                found => {
                    return Err(Failure::input(format!(
                        "--output: found the extension `{found}`, allowed are csv and html"
                    )));
                }
            };
            write_text(path, &text).map_err(Failure::work)?;
        }
        if a.json {
            console::json(&self.json());
        } else {
            self.print();
        }
        Ok(())
    }

    fn print(&self) {
        console::data(format!("{} of {}", self.analysis, self.column));
        for (name, value, unit) in &self.figures {
            let value = short(*value);
            console::data(format!("{name}: {value} {unit}").trim_end());
        }
        if !self.rows.is_empty() {
            let heads = self.heads.iter().map(|head| format!("{head:>18}"));
            console::data(heads.collect::<String>());
            for row in &self.rows {
                let cells = row.iter().map(|value| format!("{:>18}", short(*value)));
                console::data(cells.collect::<String>());
            }
        }
    }

    fn json(&self) -> Value {
        let figure = |(name, value, unit): &(&str, f64, String)| json!({ "name": name, "value": value, "unit": unit });
        let row = |row: &Vec<f64>| {
            let pairs = self.heads.iter().zip(row);
            Value::Object(
                pairs
                    .map(|(head, value)| (head.clone(), json!(value)))
                    .collect::<Map<_, _>>(),
            )
        };
        json!({
            "title": self.title,
            "column": self.column,
            "analysis": self.analysis,
            "figures": self.figures.iter().map(figure).collect::<Vec<_>>(),
            "list": self.rows.iter().map(row).collect::<Vec<_>>(),
        })
    }

    fn csv(&self) -> String {
        let head = |curve: &Curve| match &*curve.unit {
            "" => curve.name.clone(),
            unit => format!("{} [{unit}]", curve.name),
        };
        let heads: Vec<String> = self.curves.iter().map(head).collect();
        let heads: Vec<_> = heads.iter().map(|head| csv_cell(head)).collect();
        let mut text = heads.join(",") + "\n";
        let rows = self.curves.first().map_or(0, |curve| curve.values.len());
        for row in 0..rows {
            for (i, curve) in self.curves.iter().enumerate() {
                let comma = if i > 0 { "," } else { "" };
                // Writing to a String does not fail.
                let _ = write!(text, "{comma}{:e}", curve.values[row]);
            }
            text.push('\n');
        }
        text
    }

    fn page(&self) -> Result<String, Failure> {
        let mut section = Section::new(capital(self.analysis));
        section = match &self.map {
            Some(map) => section.push(map.clone()),
            None => section.push(self.chart()?),
        };
        if let Some(spectrum) = &self.spectrum {
            section = section.push(spectrum.chart());
        }
        if !self.figures.is_empty() {
            let mut table = Table::new("Figures")
                .column("figure", Align::Left)
                .column("value", Align::Right)
                .column("unit", Align::Left);
            for (name, value, unit) in &self.figures {
                table = table.row([(*name).to_owned(), few_digits(*value), unit.clone()]);
            }
            section = section.push(table);
        }
        if !self.rows.is_empty() {
            let heads = self
                .heads
                .iter()
                .map(|head| match head.ends_with("amplitude") {
                    true => format!("{head} {}", self.unit),
                    false => head.clone(),
                });
            let table = heads.fold(Table::new("Lines"), |table, head| {
                table.column(head, Align::Right)
            });
            let cells = self
                .rows
                .iter()
                .map(|row| row.iter().map(|value| few_digits(*value)));
            section = section.push(cells.fold(table, Table::row));
        }
        let page = Page::new(self.title.clone())
            .subtitle(self.column.clone())
            .section(section);
        page.render().map_err(Failure::work)
    }

    /// The curves over the first of them.
    fn chart(&self) -> Result<LineChart, Failure> {
        let [x, ordinates @ ..] = &self.curves[..] else {
            return Err(Failure::work("nothing to draw"));
        };
        let unit = ordinates.first().map_or("", |curve| &*curve.unit);
        let what = match ordinates {
            [one] => &*one.name,
            _ => "value",
        };
        let scale = if self.is_logarithmic {
            AxisScale::Logarithmic
        } else {
            AxisScale::Linear
        };
        // The mean is taken off: the line at zero would fix the scale of a logarithmic axis.
        let first = usize::from(self.is_logarithmic);
        let mut chart = LineChart::new(
            format!("{}: {}", self.column, self.analysis),
            Axis::new(x.name.clone(), x.unit.clone()),
            Axis::new(what, unit),
        )
        .x_values(min_max::abscissas(&x.values[first..]))
        .y_scale(scale);
        for curve in ordinates {
            let mut values = min_max::values(&curve.values[first..]);
            if self.is_logarithmic {
                let floor = FLOOR * values.iter().copied().fold(0.0, f64::max);
                values
                    .iter_mut()
                    .for_each(|value| *value = value.max(floor));
            }
            chart = chart.series(LineSeries::new(curve.name.clone(), values));
        }
        Ok(chart)
    }
}

/// Line and value of the largest local maxima of a spectrum, strongest first; the mean is none.
pub fn peaks(spectrum: &Spectrum, count: usize) -> Vec<(usize, f64)> {
    let values = &spectrum.values;
    let at = |line: usize| values.get(line).copied().unwrap_or(0.0);
    let is_peak = |&line: &usize| at(line) > at(line - 1) && at(line) >= at(line + 1);
    let mut found: Vec<(usize, f64)> = (1..values.len())
        .filter(is_peak)
        .map(|line| (line, values[line]))
        .collect();
    found.sort_by(|a, b| b.1.total_cmp(&a.1));
    found.truncate(count);
    found
}

/// As pages show numbers; whole ones as they are.
fn few_digits(value: f64) -> String {
    match value.is_nan() || value.fract() == 0.0 {
        true => short(value),
        false => gearmesh_report::short(value),
    }
}

/// Five decimals; small and large numbers in scientific notation.
fn short(value: f64) -> String {
    let size = value.abs();
    if value.is_nan() {
        return "-".to_owned();
    }
    let whole = value.round();
    if size < 1e9 && (value - whole).abs() <= 1e-9 * size {
        format!("{whole:.0}")
    } else if (1e-3..1e7).contains(&size) {
        format!("{value:.5}")
    } else {
        format!("{value:.5e}")
    }
}
