//! Curves over a common abscissa.

use super::PageError;
use super::checks::{check_abscissas, check_count, check_finite_at, check_range, check_some};
use super::packed::floats;
use super::typography::plain;
use serde_json::{Value, json};

/// What an axis shows, and its unit (empty for a pure number).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Axis {
    pub(super) label: String,
    pub(super) unit: String,
}

impl Axis {
    /// An axis.
    pub fn new(label: impl Into<String>, unit: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            unit: unit.into(),
        }
    }

    pub(super) fn payload(&self) -> Value {
        json!({ "label": plain(&self.label), "unit": plain(&self.unit) })
    }
}

/// Division of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum AxisScale {
    /// Equal steps.
    #[default]
    Linear,
    /// Equal ratios; values of 0 and below are gaps.
    Logarithmic,
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LineStyle {
    /// Without gaps.
    #[default]
    Solid,
    /// Long strokes: for the reference of a solid line of the same colour.
    Dashed,
    /// Short strokes.
    Dotted,
}

/// Colour of a line.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum SeriesColour {
    /// The next colour of the palette by the place of the series in the chart.
    #[default]
    Next,
    /// A colour of the palette (8 colours, repeated): the same for lines that belong together.
    Palette(usize),
    /// A place 0 … 1 on a ramp from dark to bright: for a parameter that grows, such as the torque.
    Ramp(f64),
}

/// One curve.
#[derive(Debug, Clone, PartialEq)]
pub struct LineSeries {
    name: String,
    values: Vec<f64>,
    style: LineStyle,
    colour: SeriesColour,
    shown: bool,
}

impl LineSeries {
    /// A solid line in the next colour. NaN is a gap.
    pub fn new(name: impl Into<String>, values: Vec<f64>) -> Self {
        Self {
            name: name.into(),
            values,
            style: LineStyle::Solid,
            colour: SeriesColour::Next,
            shown: true,
        }
    }

    /// How the line is drawn.
    #[must_use]
    pub fn style(mut self, style: LineStyle) -> Self {
        self.style = style;
        self
    }

    /// The line's colour.
    #[must_use]
    pub fn colour(mut self, colour: SeriesColour) -> Self {
        self.colour = colour;
        self
    }

    /// Not drawn until the reader switches it on in the legend.
    #[must_use]
    pub fn hidden(mut self) -> Self {
        self.shown = false;
        self
    }
}

/// Curves over a common abscissa: zoom by dragging, double click for the whole, values under the cursor in the legend,
/// a click in the legend switches a curve.
#[derive(Debug, Clone, PartialEq)]
pub struct LineChart {
    title: String,
    x: Axis,
    y: Axis,
    y_scale: AxisScale,
    x_values: Vec<f64>,
    x_window: Option<[f64; 2]>,
    series: Vec<LineSeries>,
    marks: Vec<(f64, String)>,
}

impl LineChart {
    /// A chart without data.
    pub fn new(title: impl Into<String>, x: Axis, y: Axis) -> Self {
        Self {
            title: title.into(),
            x,
            y,
            y_scale: AxisScale::Linear,
            x_values: Vec::new(),
            x_window: None,
            series: Vec::new(),
            marks: Vec::new(),
        }
    }

    /// The abscissas of all series, increasing.
    #[must_use]
    pub fn x_values(mut self, x_values: Vec<f64>) -> Self {
        self.x_values = x_values;
        self
    }

    /// Division of the ordinate.
    #[must_use]
    pub fn y_scale(mut self, scale: AxisScale) -> Self {
        self.y_scale = scale;
        self
    }

    /// Part of the abscissa that is shown first; a button and a double click show all.
    #[must_use]
    pub fn x_window(mut self, low: f64, high: f64) -> Self {
        self.x_window = Some([low, high]);
        self
    }

    /// Adds a curve.
    #[must_use]
    pub fn series(mut self, series: LineSeries) -> Self {
        self.series.push(series);
        self
    }

    /// Marks an abscissa with a name.
    #[must_use]
    pub fn mark(mut self, x: f64, label: impl Into<String>) -> Self {
        self.marks.push((x, label.into()));
        self
    }

    pub(super) fn title(&self) -> &str {
        &self.title
    }

    pub(super) fn payload(&self) -> Result<Value, PageError> {
        check_abscissas(&self.title, "abscissa", &self.x_values)?;
        if let Some([low, high]) = self.x_window {
            check_range(&self.title, "the first window", low, high)?;
        }
        let mut series = Vec::with_capacity(self.series.len());
        for s in &self.series {
            let what = format!("series '{}'", s.name);
            check_count(&self.title, &what, s.values.len(), self.x_values.len())?;
            // NaN is a gap.
            let drawn = s.values.iter().copied().enumerate();
            check_finite_at(&self.title, &what, drawn.filter(|(_, v)| !v.is_nan()))?;
            series.push(json!({
                "name": plain(&s.name),
                "values": floats(s.values.iter().copied()),
                "dash": match s.style { LineStyle::Solid => "solid", LineStyle::Dashed => "dashed", LineStyle::Dotted => "dotted" },
                "colour": match s.colour {
                    SeriesColour::Next => json!({ "palette": series.len() }),
                    SeriesColour::Palette(i) => json!({ "palette": i }),
                    SeriesColour::Ramp(place) => json!({ "ramp": place.clamp(0.0, 1.0) }),
                },
                "shown": s.shown,
            }));
        }
        check_some(&self.title, "the list of series", series.is_empty())?;
        let marks = self.marks.iter();
        let marks = marks.map(|(x, label)| json!({ "order": x, "label": plain(label) }));
        Ok(json!({
            "marks": marks.collect::<Vec<_>>(),
            "x": self.x.payload(),
            "y": self.y.payload(),
            "log": self.y_scale == AxisScale::Logarithmic,
            "window": self.x_window,
            "abscissas": floats(self.x_values.iter().copied()),
            "series": series,
        }))
    }
}
