//! A tooth flank as a gear engineer draws it, toe to heel and root to tip in one scale, with what touches on it.
//!
//! Drawn as SVG in the page itself: it needs no script.

use super::PageError;
use super::markup::{escape, legend};
use super::polar_chart::{round_step, tick};
use super::typography::{html, plain};
use std::fmt::Write as _;

/// Width of the flank in the drawing, in its own units, and the space round it.
const WIDE: f64 = 380.0;
const MARGIN: f64 = 44.0;

/// A line on the flank.
#[derive(Debug, Clone, PartialEq)]
struct FlankLine {
    name: String,
    points_mm: Vec<[f64; 2]>,
}

/// The outline of a flank with patches and lines, in mm: x along the face towards the heel, y up the flank.
#[derive(Debug, Clone, PartialEq)]
pub struct FlankChart {
    title: String,
    outline_mm: Vec<[f64; 2]>,
    patches_mm: Vec<Vec<[f64; 2]>>,
    lines: Vec<FlankLine>,
}

impl FlankChart {
    /// The flank inside a closed outline.
    pub fn new(title: impl Into<String>, outline_mm: Vec<[f64; 2]>) -> Self {
        Self {
            title: title.into(),
            outline_mm,
            patches_mm: Vec::new(),
            lines: Vec::new(),
        }
    }

    /// Adds an area that touches at one position; what of it lies beyond the flank is not drawn.
    #[must_use]
    pub fn patch(mut self, points_mm: Vec<[f64; 2]>) -> Self {
        self.patches_mm.push(points_mm);
        self
    }

    /// Adds points, one dot each, joined by a line.
    #[must_use]
    pub fn line(mut self, name: impl Into<String>, points_mm: Vec<[f64; 2]>) -> Self {
        self.lines.push(FlankLine {
            name: name.into(),
            points_mm,
        });
        self
    }

    fn check(&self) -> Result<(), PageError> {
        if self.outline_mm.len() < 3 {
            return Err(PageError::Empty {
                block: self.title.clone(),
                what: "the outline",
            });
        }
        let lines = self.lines.iter().map(|l| (&*l.name, &l.points_mm));
        let patches = self.patches_mm.iter().map(|p| ("patch", p));
        let all = lines.chain(patches).chain([("outline", &self.outline_mm)]);
        for (what, points) in all {
            let mut values = points.iter().flatten().enumerate();
            if let Some((index, &found)) = values.find(|(_, v)| !v.is_finite()) {
                return Err(PageError::NotFinite {
                    block: self.title.clone(),
                    what: what.to_owned(),
                    index,
                    found,
                });
            }
        }
        Ok(())
    }

    pub(super) fn render(&self, page: &mut String) -> Result<(), PageError> {
        self.check()?;
        let end = |k: usize, pick: fn(f64, f64) -> f64| {
            let values = self.outline_mm.iter().map(|p| p[k]);
            values.reduce(pick).unwrap_or(0.0)
        };
        let (low, high) = (
            [0, 1].map(|k| end(k, f64::min)),
            [0, 1].map(|k| end(k, f64::max)),
        );
        let scale = WIDE / (high[0] - low[0]);
        let tall = (high[1] - low[1]) * scale;
        let place = |[x, y]: [f64; 2]| [(x - low[0]) * scale, (high[1] - y) * scale];
        let joined = |points: &[[f64; 2]]| {
            points.iter().fold(String::new(), |mut text, point| {
                let [x, y] = place(*point);
                let _ = write!(text, "{x:.2},{y:.2} ");
                text
            })
        };
        // Names of clips are those of the page: the outline's own text makes them differ.
        let outline = joined(&self.outline_mm);
        let clip = format!("flank{}", outline.len() * 1000 + page.len());
        // Writing to a String does not fail.
        let _ = write!(
            page,
            "<figure class=\"polar flank\">\n<figcaption>{}</figcaption>\n\
             <svg viewBox=\"{} {} {:.1} {:.1}\" role=\"img\" aria-label=\"{}\">\n\
             <clipPath id=\"{clip}\"><polygon points=\"{outline}\"/></clipPath>\n",
            html(&self.title),
            -MARGIN,
            -MARGIN,
            WIDE + 2.0 * MARGIN,
            tall + 2.0 * MARGIN,
            escape(&plain(&self.title))
        );
        for patch in &self.patches_mm {
            let _ = writeln!(
                page,
                "<polygon clip-path=\"url(#{clip})\" fill=\"var(--c0)\" fill-opacity=\"0.13\" points=\"{}\"/>",
                joined(patch)
            );
        }
        let _ = writeln!(
            page,
            "<polygon points=\"{outline}\" fill=\"none\" stroke=\"var(--faint)\"/>"
        );
        for (number, line) in self.lines.iter().enumerate() {
            let colour = number + 1;
            if line.points_mm.len() > 1 {
                let points = joined(&line.points_mm);
                let _ = writeln!(
                    page,
                    "<polyline fill=\"none\" stroke=\"var(--c{colour})\" points=\"{points}\"/>"
                );
            }
            for point in &line.points_mm {
                let [x, y] = place(*point);
                let _ = write!(
                    page,
                    "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"2\" fill=\"var(--c{colour})\"/>"
                );
            }
            page.push('\n');
        }
        for (x, y, anchor, word) in [
            (-8.0, 0.5 * tall, "end", "toe"),
            (WIDE + 8.0, 0.5 * tall, "start", "heel"),
            (0.5 * WIDE, -8.0, "middle", "tip"),
            (0.5 * WIDE, tall + 16.0, "middle", "root"),
        ] {
            let _ = write!(
                page,
                "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{word}</text>"
            );
        }
        let bar = round_step(high[0] - low[0]);
        let at = tall + 30.0;
        let _ = write!(
            page,
            "<line x1=\"0\" y1=\"{at:.1}\" x2=\"{0:.1}\" y2=\"{at:.1}\" stroke=\"var(--faint)\" stroke-width=\"2\"/>\
             <text x=\"{1:.1}\" y=\"{2:.1}\">{3} mm</text>\n</svg>\n",
            bar * scale,
            bar * scale + 6.0,
            at + 4.0,
            tick(bar)
        );
        let lines = self.lines.iter().enumerate();
        page.push_str(&legend(lines.map(|(k, line)| (k + 1, &line.name[..])), ""));
        page.push_str("</figure>\n");
        Ok(())
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn square() -> Vec<[f64; 2]> {
        vec![[10.0, 0.0], [20.0, 0.0], [20.0, 5.0], [10.0, 5.0]]
    }

    #[test]
    fn toe_is_left_and_tip_is_up() {
        let mut html = String::new();
        let chart = FlankChart::new("t", square())
            .patch(vec![[12.0, 1.0], [14.0, 1.0], [13.0, 2.0]])
            .line("path", vec![[10.0, 5.0], [20.0, 0.0]]);
        chart.render(&mut html).unwrap();
        assert!(
            html.contains("points=\"0.00,0.00 380.00,190.00 \""),
            "{html}"
        );
        assert!(html.contains("points=\"76.00,152.00 "), "{html}");
    }

    #[test]
    fn what_is_no_flank_is_told() {
        let mut html = String::new();
        let none = FlankChart::new("t", Vec::new());
        assert!(matches!(
            none.render(&mut html),
            Err(PageError::Empty { .. })
        ));
        let wrong = FlankChart::new("t", square()).line("a", vec![[f64::NAN, 0.0]]);
        assert!(matches!(
            wrong.render(&mut html),
            Err(PageError::NotFinite { .. })
        ));
    }
}
