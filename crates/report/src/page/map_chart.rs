//! A map: how large something is over two axes, as colours of a logarithmic scale.
//!
//! Drawn as SVG in the page itself: it needs no script.

use super::PageError;
use super::checks::{check_count, check_finite, check_some};
use super::line_chart::Axis;
use super::markup::escape;
use super::polar_chart::round_step;
use super::typography::{html, plain, svg};
use crate::short_number::short;
use std::fmt::Write as _;

/// Cells of the picture along and up at most: a screen shows no more, and a cell costs some bytes of the page.
const CELLS: [usize; 2] = [160, 120];

/// The picture and the space left and right of it, in its own units: few enough that letters of 14 of them are readable
/// on a telephone.
const SIZE: [f64; 2] = [400.0, 250.0];
const MARGIN: f64 = 76.0;
const MARGIN_RIGHT: f64 = 24.0;

/// Decades below the largest value that are distinguished, and colours of a decade.
const DECADES: usize = 4;
const SHADES: usize = 6;

/// Ends and three steps between of the colours, dark to light: even in lightness, also without colour.
const COLOURS: [[f64; 3]; 5] = [
    [68.0, 1.0, 84.0],
    [59.0, 82.0, 139.0],
    [33.0, 145.0, 140.0],
    [94.0, 201.0, 98.0],
    [253.0, 231.0, 37.0],
];

/// Values over two axes.
#[derive(Debug, Clone, PartialEq)]
pub struct MapChart {
    title: String,
    axes: [Axis; 2],
    quantity: Axis,
    /// Places along, rising.
    along: Vec<f64>,
    /// Distance of the places up, which begin at 0.
    spacing: f64,
    /// Values up at each place along.
    columns: Vec<Vec<f64>>,
    /// Over the map.
    lines: Vec<(String, Vec<[f64; 2]>)>,
}

impl MapChart {
    /// An empty map of a quantity over the axis along and the axis up.
    pub fn new(title: impl Into<String>, along: Axis, up: Axis, quantity: Axis) -> Self {
        Self {
            title: title.into(),
            axes: [along, up],
            quantity,
            along: Vec::new(),
            spacing: 1.0,
            columns: Vec::new(),
            lines: Vec::new(),
        }
    }

    /// Places along, rising, and at each the values up, which lie `spacing` apart from 0 on.
    #[must_use]
    pub fn values(mut self, along: Vec<f64>, spacing: f64, columns: Vec<Vec<f64>>) -> Self {
        (self.along, self.spacing, self.columns) = (along, spacing, columns);
        self
    }

    /// Draws a line over the map, its name at the end; what of it lies above the map is left out.
    #[must_use]
    pub fn line(mut self, name: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        self.lines.push((name.into(), points));
        self
    }

    fn check(&self) -> Result<usize, PageError> {
        let lines = self.columns.first().map_or(0, Vec::len);
        let none = self.along.is_empty() || lines == 0;
        check_some(&self.title, "the map", none)?;
        check_count(&self.title, "map", self.columns.len(), self.along.len())?;
        for column in &self.columns {
            check_count(&self.title, "column", column.len(), lines)?;
        }
        let of_lines = self.lines.iter().flat_map(|(_, points)| points).flatten();
        let values = self.columns.iter().flatten().chain(&self.along);
        check_finite(&self.title, "values", values.chain(of_lines))?;
        Ok(lines)
    }

    pub(super) fn render(&self, page: &mut String) -> Result<(), PageError> {
        let lines = self.check()?;
        let (from, to) = (self.along[0], self.along[self.along.len() - 1]);
        let cells = [CELLS[0].min(2 * self.along.len()), CELLS[1].min(lines)];
        let largest = self.columns.iter().flatten().copied().fold(0.0, f64::max);
        let (title, name) = (html(&self.title), escape(&plain(&self.title)));
        let [wide, high] = SIZE;
        // Writing to a String does not fail.
        let _ = write!(
            page,
            "<figure class=\"polar map\">\n<figcaption>{title}</figcaption>\n\
             <svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{name}\">\n",
            wide + MARGIN + MARGIN_RIGHT,
            high + 64.0
        );
        let _ = writeln!(
            page,
            "<rect x=\"{MARGIN}\" y=\"8\" width=\"{wide}\" height=\"{high}\" fill=\"{}\"/>",
            colour(0)
        );
        let levels = |x: usize| -> Vec<usize> {
            let place = from + (to - from) * (x as f64 + 0.5) / cells[0] as f64;
            let column = &self.columns[nearest(&self.along, place)];
            let of_cell = |y: usize| {
                let range = y * lines / cells[1]..(y + 1) * lines / cells[1];
                column[range].iter().copied().fold(0.0, f64::max)
            };
            (0..cells[1]).map(|y| level(of_cell(y), largest)).collect()
        };
        let columns: Vec<Vec<usize>> = (0..cells[0]).map(levels).collect();
        let rows: Vec<Vec<usize>> = (0..cells[1])
            .map(|y| columns.iter().map(|column| column[y]).collect())
            .collect();
        let size = [wide / cells[0] as f64, high / cells[1] as f64];
        for shade in 1..DECADES * SHADES {
            let mut path = String::new();
            for (y, row) in rows.iter().enumerate() {
                let mut x = 0;
                while x < cells[0] {
                    let first = x;
                    while x < cells[0] && row[x] == shade {
                        x += 1;
                    }
                    if x > first {
                        let _ = write!(
                            path,
                            "M{:.1} {:.1}h{:.1}v-{:.1}h-{2:.1}z",
                            MARGIN + first as f64 * size[0],
                            8.0 + high - y as f64 * size[1],
                            (x - first) as f64 * size[0],
                            size[1]
                        );
                    } else {
                        x += 1;
                    }
                }
            }
            if !path.is_empty() {
                let _ = writeln!(
                    page,
                    "<path d=\"{path}\" fill=\"{}\" shape-rendering=\"crispEdges\"/>",
                    colour(shade)
                );
            }
        }
        let top = self.spacing * lines as f64;
        self.ticks(page, ([from, to], top));
        self.lines_over(page, ([from, to], top));
        page.push_str("</svg>\n");
        self.scale(page, largest);
        page.push_str("</figure>\n");
        Ok(())
    }

    /// Numbers and names of both axes.
    fn ticks(&self, page: &mut String, ([from, to], top): ([f64; 2], f64)) {
        let [wide, high] = SIZE;
        let bottom = 8.0 + high;
        let named = |axis: &Axis| match &axis.unit[..] {
            "" => svg(&axis.label),
            unit => format!("{} ({})", svg(&axis.label), svg(unit)),
        };
        let step = round_step(to - from);
        let mut value = step * (from / step).ceil();
        while to > from && value <= to + 1e-9 * step {
            let x = MARGIN + wide * (value - from) / (to - from);
            let _ = write!(
                page,
                "<text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
                bottom + 22.0,
                on_axis(value, step)
            );
            value += step;
        }
        if to <= from {
            let _ = write!(
                page,
                "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
                MARGIN + 0.5 * wide,
                bottom + 22.0,
                short(from)
            );
        }
        let step = round_step(top);
        let mut value = 0.0;
        while value <= top + 1e-9 * step {
            let y = bottom - high * value / top;
            let _ = write!(
                page,
                "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
                MARGIN - 6.0,
                y + 4.0,
                on_axis(value, step)
            );
            value += step;
        }
        let _ = writeln!(
            page,
            "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>\
             <text x=\"16\" y=\"{:.1}\" text-anchor=\"middle\" transform=\"rotate(-90 16 {3:.1})\">{}</text>",
            MARGIN + 0.5 * wide,
            bottom + 48.0,
            named(&self.axes[0]),
            8.0 + 0.5 * high,
            named(&self.axes[1])
        );
    }

    /// Lines over the map, where they are within it.
    fn lines_over(&self, page: &mut String, ([from, to], top): ([f64; 2], f64)) {
        let [wide, high] = SIZE;
        let mut taken: Vec<[f64; 2]> = Vec::new();
        for (name, points) in &self.lines {
            let within = |p: &&[f64; 2]| p[0] >= from && p[0] <= to && p[1] >= 0.0 && p[1] <= top;
            let place = |[x, y]: [f64; 2]| {
                [
                    MARGIN + wide * (x - from) / (to - from).max(f64::MIN_POSITIVE),
                    8.0 + high - high * y / top,
                ]
            };
            let mut runs = points.split(|p| !within(&p)).filter(|run| run.len() > 1);
            for run in runs.clone() {
                let text = run.iter().fold(String::new(), |mut text, point| {
                    let [x, y] = place(*point);
                    let _ = write!(text, "{x:.1},{y:.1} ");
                    text
                });
                let _ = writeln!(
                    page,
                    "<polyline points=\"{}\" fill=\"none\" stroke=\"#ffffff\" stroke-width=\"1.3\" stroke-dasharray=\"7 6\"/>",
                    text.trim_end()
                );
            }
            // A name where it meets no other one.
            let last = runs.next_back();
            let end = last.and_then(|run| run.last()).map(|p| place(*p));
            let Some([x, y]) = end.map(|[x, y]| [x - 6.0, (y - 6.0).max(24.0)]) else {
                continue;
            };
            let is_free =
                |other: &[f64; 2]| (other[1] - y).abs() > 20.0 || (other[0] - x).abs() > 120.0;
            if taken.iter().all(is_free) {
                taken.push([x, y]);
                let _ = writeln!(
                    page,
                    "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"end\">{}</text>",
                    svg(name)
                );
            }
        }
    }

    /// The colours of the decades.
    fn scale(&self, page: &mut String, largest: f64) {
        page.push_str("<p class=\"legend\">");
        for decade in (0..=DECADES).rev() {
            let value = largest / 10_f64.powi(decade as i32);
            let _ = write!(
                page,
                "<span class=\"entry\"><span class=\"key\" style=\"background: {}\"></span> {}{}</span> ",
                colour(level(value, largest)),
                if decade == DECADES { "up to " } else { "" },
                html(&short(value))
            );
        }
        let _ = writeln!(
            page,
            "{} ({})</p>",
            html(&self.quantity.label),
            html(&self.quantity.unit)
        );
    }
}

/// The place that is nearest to a value, of places that rise.
fn nearest(places: &[f64], value: f64) -> usize {
    let after = places.partition_point(|place| *place < value);
    let before = after.saturating_sub(1);
    if after == places.len() || value - places[before] <= places[after] - value {
        before
    } else {
        after
    }
}

/// Which of the colours a value has: 0 for all that is [`DECADES`] decades below the largest.
fn level(value: f64, largest: f64) -> usize {
    if value <= 0.0 || largest <= 0.0 {
        return 0;
    }
    let above = (DECADES as f64 + (value / largest).log10()) * SHADES as f64;
    (above.max(0.0) as usize).min(DECADES * SHADES - 1)
}

fn colour(level: usize) -> String {
    let at = (COLOURS.len() - 1) as f64 * level as f64 / (DECADES * SHADES - 1) as f64;
    let first = (at as usize).min(COLOURS.len() - 2);
    let share = at - first as f64;
    let part = |k: usize| (1.0 - share) * COLOURS[first][k] + share * COLOURS[first + 1][k];
    format!("rgb({:.0},{:.0},{:.0})", part(0), part(1), part(2))
}

/// A tick in as many digits as its step needs.
fn on_axis(value: f64, step: f64) -> String {
    let digits = (-step.log10().floor()).clamp(0.0, 9.0) as usize;
    format!("{value:.digits$}")
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn map() -> MapChart {
        let axis = |label: &str| Axis::new(label, "");
        MapChart::new("m", axis("x"), axis("y"), axis("z"))
    }

    #[test]
    fn a_line_that_stands_is_one_row_of_the_brightest_colour() {
        let columns = vec![vec![0.0, 1e-9, 7.0, 0.0]; 50];
        let along = (0..50).map(f64::from).collect();
        let mut html = String::new();
        map().values(along, 1.0, columns).render(&mut html).unwrap();
        // All else is the ground.
        assert_eq!(html.matches("<path").count(), 1, "{html}");
        let brightest = colour(DECADES * SHADES - 1);
        // From the third of four rows over the whole width.
        let row = format!("<path d=\"M76.0 133.0h400.0v-62.5h-400.0z\" fill=\"{brightest}\"");
        assert!(html.contains(&row), "{html}");
    }

    #[test]
    fn a_line_leaves_the_map_and_comes_back() {
        let along: Vec<f64> = (0..5).map(f64::from).collect();
        let columns = vec![vec![1.0; 10]; 5];
        let line = [2.0, 5.0, 12.0, 5.0, 4.0].into_iter().enumerate();
        let line = line.map(|(x, y)| [x as f64, y]).collect();
        let mut html = String::new();
        let chart = map().values(along, 1.0, columns).line("1×", line);
        chart.render(&mut html).unwrap();
        // Both ends of the part that is above are left out, and the name stands once.
        assert_eq!(html.matches("<polyline").count(), 2, "{html}");
        assert!(html.contains("points=\"76.0,208.0 176.0,133.0\""), "{html}");
        assert_eq!(html.matches(">1×<").count(), 1);
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let mut html = String::new();
        assert!(matches!(
            map().render(&mut html),
            Err(PageError::Empty { .. })
        ));
        let short = map().values(vec![1.0, 2.0], 1.0, vec![vec![1.0]]);
        assert!(matches!(
            short.render(&mut html),
            Err(PageError::Count { .. })
        ));
        let wrong = map().values(vec![1.0], 1.0, vec![vec![f64::NAN]]);
        assert!(matches!(
            wrong.render(&mut html),
            Err(PageError::NotFinite { .. })
        ));
    }

    #[test]
    fn the_nearest_place_is_found() {
        let places = [1.0, 2.0, 4.0];
        let found = [0.0, 1.4, 1.6, 3.1, 9.0].map(|value| nearest(&places, value));
        assert_eq!(found, [0, 0, 1, 2, 2]);
    }
}
