//! Points in a plane, two quantities against each other: trials of an optimisation and their front.
//!
//! Drawn as SVG in the page itself: it needs no script.

use super::checks::check_some;
use super::markup::{COLOURS, escape, legend, text_width};
use super::polar_chart::{round_step, tick};
use super::typography::{html, plain, svg};
use super::{Axis, PageError};
use std::fmt::Write as _;

/// Width and height of the drawing, in its own units.
const SIZE: [f64; 2] = [460.0, 300.0];

/// Room above the field and below it: a line of numbers, a line with the title of the axis.
const ABOVE: f64 = 10.0;
const BELOW: f64 = 46.0;

/// Points of one kind.
#[derive(Debug, Clone, PartialEq)]
pub struct PointSeries {
    name: String,
    points: Vec<[f64; 2]>,
    joined: bool,
    is_mark: bool,
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
            is_mark: false,
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

    /// A ring each: a few points that a reader looks for.
    #[must_use]
    pub fn marked(mut self) -> Self {
        self.is_mark = true;
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
            (value, tick(value))
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
        _ => plain(&format!("1e{power}")),
    }
}

/// Every so many numbers of an abscissa are written, so that they do not touch.
fn every(ticks: &[(f64, String)], room: f64) -> usize {
    let widest = ticks
        .iter()
        .map(|(_, text)| text_width(text))
        .fold(0.0, f64::max);
    let fit = (room / (widest + 10.0)).floor().max(1.0) as usize;
    ticks.len().div_ceil(fit)
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

    pub(super) fn render(&self, page: &mut String) -> Result<(), PageError> {
        self.check()?;
        let place = Place::of(self);
        // Writing to a String does not fail.
        let _ = write!(
            page,
            "<figure class=\"polar points\">\n<figcaption>{}</figcaption>\n<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n",
            html(&self.title),
            SIZE[0],
            SIZE[1],
            escape(&plain(&self.title))
        );
        place.grid(page);
        place.titles(&self.axes, page);
        for (number, series) in self.series.iter().enumerate() {
            place.series(number % COLOURS, series, page);
        }
        page.push_str("</svg>\n");
        let entries = self.series.iter().enumerate();
        let entries = entries.map(|(number, series)| (number, &series.name[..]));
        page.push_str(&legend(entries, &self.told));
        page.push_str("</figure>\n");
        Ok(())
    }

    fn all_points(&self) -> impl Iterator<Item = &[f64; 2]> {
        let series = self.series.iter();
        series.flat_map(|series| series.points.iter().chain(&series.through))
    }

    fn check(&self) -> Result<(), PageError> {
        let none = self.all_points().next().is_none();
        check_some(&self.title, "the set of points", none)?;
        let fits = |point: &[f64; 2]| {
            let mut pairs = point.iter().zip(self.logarithmic);
            pairs.all(|(v, log)| v.is_finite() && (!log || *v > 0.0))
        };
        if let Some((index, point)) = self
            .all_points()
            .enumerate()
            .find(|(_, point)| !fits(point))
        {
            let not_finite = point.iter().copied().find(|v| !v.is_finite());
            return Err(PageError::NotFinite {
                block: self.title.clone(),
                what: "points".to_owned(),
                index,
                found: not_finite.unwrap_or(point[0]),
            });
        }
        Ok(())
    }
}

/// Where values lie in the picture.
struct Place {
    scales: [Scale; 2],
    ticks: [Vec<(f64, String)>; 2],
    left: f64,
    right: f64,
    bottom: f64,
}

impl Place {
    fn of(chart: &ScatterChart) -> Self {
        let scales = [0, 1].map(|k| {
            let values = chart.all_points().map(move |p| p[k]);
            Scale::of(values, chart.logarithmic[k])
        });
        let ticks = [0, 1].map(|k: usize| scales[k].ticks());
        let widest = |ticks: &[(f64, String)]| {
            let widths = ticks.iter().map(|(_, text)| text_width(text));
            widths.fold(0.0, f64::max)
        };
        Self {
            // The title of the ordinate, its numbers; half of the last number of the abscissa.
            left: 30.0 + widest(&ticks[1]),
            right: SIZE[0] - (0.5 * widest(&ticks[0]) + 4.0).max(10.0),
            bottom: SIZE[1] - BELOW,
            scales,
            ticks,
        }
    }

    fn x(&self, value: f64) -> f64 {
        self.left + (self.right - self.left) * self.scales[0].share(value)
    }

    fn y(&self, value: f64) -> f64 {
        ABOVE + (self.bottom - ABOVE) * (1.0 - self.scales[1].share(value))
    }

    fn grid(&self, page: &mut String) {
        let (left, right, bottom) = (self.left, self.right, self.bottom);
        let every = every(&self.ticks[0], right - left);
        for (number, (value, text)) in self.ticks[0].iter().enumerate() {
            let at = self.x(*value);
            let _ = write!(
                page,
                "<line x1=\"{at:.1}\" y1=\"{ABOVE}\" x2=\"{at:.1}\" y2=\"{bottom}\" class=\"grid\"/>"
            );
            if number % every == 0 {
                let _ = write!(
                    page,
                    "<text x=\"{at:.1}\" y=\"{}\" text-anchor=\"middle\">{text}</text>",
                    bottom + 18.0
                );
            }
        }
        for (value, text) in &self.ticks[1] {
            let at = self.y(*value);
            let _ = write!(
                page,
                "<line x1=\"{left:.1}\" y1=\"{at:.1}\" x2=\"{right:.1}\" y2=\"{at:.1}\" class=\"grid\"/><text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{text}</text>",
                left - 6.0,
                at + 4.0
            );
        }
    }

    fn titles(&self, axes: &[Axis; 2], page: &mut String) {
        let named = |axis: &Axis, room: f64| {
            let label = match &axis.unit[..] {
                "" => axis.label.clone(),
                unit => format!("{} [{unit}]", axis.label),
            };
            // A long title is set smaller instead of being cut.
            let smaller = room / text_width(&plain(&label));
            let smaller = (smaller < 1.0).then(|| format!(" style=\"--fit:{smaller:.3}\""));
            (smaller.unwrap_or_default(), svg(&label))
        };
        let (smaller, label) = named(&axes[0], SIZE[0] - 8.0);
        let middle = 0.5 * (self.left + self.right);
        let half = 0.5 * text_width(&label).min(SIZE[0] - 8.0);
        let _ = write!(
            page,
            "\n<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\"{smaller}>{label}</text>",
            middle.clamp(half, (SIZE[0] - half).max(half)),
            SIZE[1] - 6.0
        );
        let (smaller, label) = named(&axes[1], self.bottom + BELOW - 12.0);
        let _ = writeln!(
            page,
            "<text transform=\"translate(13 {:.1}) rotate(-90)\" text-anchor=\"middle\"{smaller}>{label}</text>",
            0.5 * SIZE[1]
        );
    }

    fn series(&self, colour: usize, series: &PointSeries, page: &mut String) {
        let line = match series.joined {
            true => &series.points,
            false => &series.through,
        };
        if !line.is_empty() {
            let _ = write!(
                page,
                "<polyline fill=\"none\" stroke=\"var(--c{colour})\" points=\""
            );
            for [a, b] in line {
                let _ = write!(page, "{:.1},{:.1} ", self.x(*a), self.y(*b));
            }
            page.push_str("\"/>");
        }
        let radius = if series.joined { 3.5 } else { 2.0 };
        let drawn = match series.is_mark {
            true => {
                format!("r=\"5.5\" fill=\"none\" stroke=\"var(--c{colour})\" stroke-width=\"2\"")
            }
            false => format!("r=\"{radius}\" fill=\"var(--c{colour})\""),
        };
        for (k, [a, b]) in series.points.iter().enumerate() {
            let label = series.labels.get(k);
            let label = label.map_or(String::new(), |l| escape(&plain(l)));
            let _ = write!(
                page,
                "<circle cx=\"{:.1}\" cy=\"{:.1}\" {drawn}><title>{label}</title></circle>",
                self.x(*a),
                self.y(*b)
            );
        }
        page.push('\n');
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
        assert!(html.contains("&lt;all&gt;"), "{html}");
        // The last point is the corner of the grid.
        let number = |text: &str, name: &str| -> f64 {
            let from = text.split(name).nth(1).unwrap();
            from.split('"').nth(1).unwrap().parse().unwrap()
        };
        let corner = |html: &str| {
            let last = html.split("<circle").last().unwrap();
            let grid = html.split("text-anchor=\"end\"").next().unwrap();
            let line = grid.rsplit("<line").next().unwrap();
            assert_eq!(number(last, "cx="), number(line, "x2="));
            assert_eq!(number(last, "cy="), ABOVE);
        };
        corner(&html);
        let mut html = String::new();
        let log = chart(vec![[0.1, 1.0], [10.0, 100.0]]).logarithmic(true, true);
        log.render(&mut html).unwrap();
        corner(&html);
        assert!(html.contains(">0.1<"), "{html}");
    }

    /// However long numbers and titles are, they are inside, and numbers of the abscissa do not touch.
    #[test]
    fn numbers_have_room() {
        for points in [[1e5, 1.2e5], [0.001, 0.0012], [-2e-6, 3e-6], [1e9, 3e9]] {
            let mut html = String::new();
            chart(vec![[points[0]; 2], [points[1]; 2]])
                .render(&mut html)
                .unwrap();
            let mut before = f64::NEG_INFINITY;
            for text in html.split("<text x=\"").skip(1) {
                let (at, rest) = text.split_once('"').unwrap();
                let at: f64 = at.parse().unwrap();
                let words = rest.split_once('>').unwrap().1.split('<').next().unwrap();
                let wide = text_width(words);
                let left = match rest.contains("\"end\"") {
                    true => at - wide,
                    false => at - 0.5 * wide,
                };
                assert!(left >= 13.0 && left + wide <= SIZE[0], "{words} at {at}");
                if rest.contains("\"end\"") || words.starts_with('a') {
                    continue;
                }
                assert!(left > before, "{words} touches the number before");
                before = left + wide;
            }
        }
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
