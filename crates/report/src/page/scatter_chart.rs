//! Points in a plane, two quantities against each other: trials of an optimisation and their front.
//!
//! Drawn as SVG in the page itself: it needs no script.

use super::markup::{COLOURS, escape, legend};
use super::polar_chart::round_step;
use super::{Axis, PageError};
use std::fmt::Write as _;

/// Width and height of the field, and room for numbers at its left, top, right and bottom, in the drawing's own units.
const FIELD: [f64; 2] = [520.0, 320.0];
const ROOM: [f64; 4] = [64.0, 10.0, 14.0, 42.0];

/// Points of one kind.
#[derive(Debug, Clone, PartialEq)]
pub struct PointSeries {
    name: String,
    points: Vec<[f64; 2]>,
    joined: bool,
    through: Vec<[f64; 2]>,
    labels: Vec<String>,
}

impl PointSeries {
    /// Points (x, y).
    pub fn new(name: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self {
            name: name.into(),
            points,
            joined: false,
            through: Vec::new(),
            labels: Vec::new(),
        }
    }

    /// Joined by a line, in the order given.
    #[must_use]
    pub fn joined(mut self) -> Self {
        self.joined = true;
        self
    }

    /// A line among the points, in their colour: what they come to in the mean.
    #[must_use]
    pub fn through(mut self, line: Vec<[f64; 2]>) -> Self {
        self.through = line;
        self
    }

    /// What is shown where the pointer rests on a point, one for each.
    #[must_use]
    pub fn labels(mut self, labels: Vec<String>) -> Self {
        self.labels = labels;
        self
    }
}

/// Of a linear axis, relative to the numbers on it.
const LEAST_SPAN: f64 = 1e-3;

/// Points of some kinds over two axes. A logarithmic abscissa has no points at 0 and below.
#[derive(Debug, Clone, PartialEq)]
pub struct ScatterChart {
    title: String,
    axes: [Axis; 2],
    logarithmic: [bool; 2],
    series: Vec<PointSeries>,
    told: String,
}

/// An axis of the drawing: where values lie, and the numbers beside it.
struct Scale {
    ends: [f64; 2],
    /// Distance of the numbers beside a linear axis.
    step: f64,
    logarithmic: bool,
}

impl Scale {
    fn of(values: impl Iterator<Item = f64>, logarithmic: bool) -> Self {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for value in values {
            let value = if logarithmic { value.log10() } else { value };
            low = low.min(value);
            high = high.max(value);
        }
        if logarithmic {
            let ends = [low.floor(), high.ceil().max(low.floor() + 1.0)];
            return Self {
                ends,
                step: 1.0,
                logarithmic,
            };
        }
        // Not so near that the numbers beside the axis are all the same.
        let least = LEAST_SPAN * low.abs().max(high.abs());
        let span = match high - low {
            0.0 => low.abs().max(1.0),
            span => span.max(least),
        };
        let step = round_step(span);
        let first = (low / step).floor();
        let last = (high / step).ceil().max(first + 1.0);
        let ends = [first * step, last * step];
        Self {
            ends,
            step,
            logarithmic,
        }
    }

    /// 0 at the low end, 1 at the high end.
    fn share(&self, value: f64) -> f64 {
        let value = if self.logarithmic {
            value.log10()
        } else {
            value
        };
        (value - self.ends[0]) / (self.ends[1] - self.ends[0])
    }

    fn ticks(&self) -> Vec<(f64, String)> {
        let [low, high] = self.ends;
        if self.logarithmic {
            let powers = low as i32..=high as i32;
            return powers
                .map(|p| (10.0_f64.powi(p), power_of_ten(p)))
                .collect();
        }
        let step = self.step;
        let count = ((high - low) / step).round() as i32;
        let first = (low / step).round();
        let at = |k: i32| {
            let value = step * (first + f64::from(k));
            // Without the rounding of the sum.
            let text = format!("{value:.4e}").parse::<f64>();
            (value, text.unwrap_or(value).to_string())
        };
        (0..=count).map(at).collect()
    }
}

/// As people write it.
fn power_of_ten(power: i32) -> String {
    match power {
        -3..=-1 => format!(
            "{:.1$}",
            10.0_f64.powi(power),
            power.unsigned_abs() as usize
        ),
        0..=4 => format!("{:.0}", 10.0_f64.powi(power)),
        _ => format!("1e{power}"),
    }
}

impl ScatterChart {
    /// A chart without points.
    pub fn new(title: impl Into<String>, x: Axis, y: Axis) -> Self {
        Self {
            title: title.into(),
            axes: [x, y],
            logarithmic: [false; 2],
            series: Vec::new(),
            told: String::new(),
        }
    }

    /// Powers of ten at equal distances, of the abscissa and of the ordinate.
    #[must_use]
    pub fn logarithmic(mut self, x: bool, y: bool) -> Self {
        self.logarithmic = [x, y];
        self
    }

    /// What is said behind the names of the series.
    #[must_use]
    pub fn told(mut self, told: impl Into<String>) -> Self {
        self.told = told.into();
        self
    }

    /// Adds points; later ones lie on top.
    #[must_use]
    pub fn series(mut self, series: PointSeries) -> Self {
        self.series.push(series);
        self
    }

    pub(super) fn render(&self, html: &mut String) -> Result<(), PageError> {
        let all = || {
            let series = self.series.iter();
            series.flat_map(|series| series.points.iter().chain(&series.through))
        };
        if all().next().is_none() {
            return Err(PageError::Empty {
                block: self.title.clone(),
                what: "the set of points",
            });
        }
        let fits = |point: &[f64; 2]| {
            let pairs = point.iter().zip(self.logarithmic);
            pairs
                .into_iter()
                .all(|(v, log)| v.is_finite() && (!log || *v > 0.0))
        };
        if let Some((index, point)) = all().enumerate().find(|(_, point)| !fits(point)) {
            return Err(PageError::NotFinite {
                block: self.title.clone(),
                what: "points".to_owned(),
                index,
                found: point
                    .iter()
                    .copied()
                    .find(|v| !v.is_finite())
                    .unwrap_or(point[0]),
            });
        }
        let scales = [0, 1].map(|k| Scale::of(all().map(move |p| p[k]), self.logarithmic[k]));
        let x = |value: f64| ROOM[0] + FIELD[0] * scales[0].share(value);
        let y = |value: f64| ROOM[1] + FIELD[1] * (1.0 - scales[1].share(value));
        let title = escape(&self.title);
        let (wide, high) = (ROOM[0] + FIELD[0] + ROOM[2], ROOM[1] + FIELD[1] + ROOM[3]);
        let (right, bottom) = (ROOM[0] + FIELD[0], ROOM[1] + FIELD[1]);
        // Writing to a String does not fail.
        let _ = write!(
            html,
            "<figure class=\"polar points\">\n<figcaption>{title}</figcaption>\n<svg viewBox=\"0 0 {wide} {high}\" role=\"img\" aria-label=\"{title}\">\n"
        );
        for (value, text) in scales[0].ticks() {
            let at = x(value);
            let _ = write!(
                html,
                "<line x1=\"{at:.1}\" y1=\"{}\" x2=\"{at:.1}\" y2=\"{bottom}\" class=\"grid\"/><text x=\"{at:.1}\" y=\"{}\" text-anchor=\"middle\">{text}</text>",
                ROOM[1],
                bottom + 15.0
            );
        }
        for (value, text) in scales[1].ticks() {
            let at = y(value);
            let _ = write!(
                html,
                "<line x1=\"{}\" y1=\"{at:.1}\" x2=\"{right}\" y2=\"{at:.1}\" class=\"grid\"/><text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{text}</text>",
                ROOM[0],
                ROOM[0] - 6.0,
                at + 4.0
            );
        }
        let named = |axis: &Axis| match &axis.unit[..] {
            "" => escape(&axis.label),
            unit => format!("{} / {}", escape(&axis.label), escape(unit)),
        };
        let _ = write!(
            html,
            "\n<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text><text transform=\"translate(13 {:.1}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
            0.5 * (ROOM[0] + right),
            high - 6.0,
            named(&self.axes[0]),
            0.5 * (ROOM[1] + bottom),
            named(&self.axes[1])
        );
        for (number, series) in self.series.iter().enumerate() {
            let colour = number % COLOURS;
            let line = match series.joined {
                true => &series.points,
                false => &series.through,
            };
            if !line.is_empty() {
                let _ = write!(
                    html,
                    "<polyline fill=\"none\" stroke=\"var(--c{colour})\" points=\""
                );
                for [a, b] in line {
                    let _ = write!(html, "{:.1},{:.1} ", x(*a), y(*b));
                }
                html.push_str("\"/>");
            }
            let radius = if series.joined { 3.5 } else { 2.0 };
            for (k, [a, b]) in series.points.iter().enumerate() {
                let label = series.labels.get(k).map_or(String::new(), |l| escape(l));
                let _ = write!(
                    html,
                    "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"{radius}\" fill=\"var(--c{colour})\"><title>{label}</title></circle>",
                    x(*a),
                    y(*b)
                );
            }
            html.push('\n');
        }
        html.push_str("</svg>\n");
        let entries = self.series.iter().enumerate();
        let entries = entries.map(|(number, series)| (number, &series.name[..]));
        html.push_str(&legend(entries, &self.told));
        html.push_str("</figure>\n");
        Ok(())
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn chart(points: Vec<[f64; 2]>) -> ScatterChart {
        ScatterChart::new("t", Axis::new("a", "s"), Axis::new("b", "%"))
            .series(PointSeries::new("<all>", points))
    }

    #[test]
    fn points_stand_between_round_numbers() {
        let mut html = String::new();
        chart(vec![[0.0, 10.0], [10.0, 20.0]])
            .render(&mut html)
            .unwrap();
        let corner = format!("cx=\"{:.1}\" cy=\"{:.1}\"", ROOM[0] + FIELD[0], ROOM[1]);
        assert!(
            html.contains(&corner) && html.contains("&lt;all&gt;"),
            "{html}"
        );
        let mut html = String::new();
        let log = chart(vec![[0.1, 1.0], [10.0, 100.0]]).logarithmic(true, true);
        log.render(&mut html).unwrap();
        assert!(html.contains(&corner) && html.contains(">0.1<"), "{html}");
    }

    /// Points that hardly differ are not drawn so far apart that all numbers beside the axes read the same.
    #[test]
    fn numbers_beside_an_axis_differ() {
        for points in [[3.61526, 3.61527], [3.61526, 3.61526], [0.0, 0.0]] {
            let scale = Scale::of(points.into_iter(), false);
            let ticks: Vec<String> = scale.ticks().into_iter().map(|tick| tick.1).collect();
            assert!(ticks.len() > 1 && ticks.windows(2).all(|pair| pair[0] != pair[1]));
            assert!(scale.share(points[0]) >= 0.0 && scale.share(points[1]) <= 1.0);
            let (value, _) = scale.ticks()[1];
            assert!((scale.share(value) - 1.0 / (ticks.len() as f64 - 1.0)).abs() < 1e-6);
        }
    }

    #[test]
    fn what_cannot_be_drawn_is_told() {
        for wrong in [
            chart(Vec::new()),
            chart(vec![[f64::NAN, 1.0]]),
            chart(vec![[0.0, 1.0]]).logarithmic(true, false),
        ] {
            assert!(wrong.render(&mut String::new()).is_err());
        }
    }
}
