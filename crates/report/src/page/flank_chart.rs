//! A tooth flank as a gear engineer draws it, toe to heel and root to tip in one scale, with what touches on it.
//!
//! Drawn as SVG in the page itself: it needs no script.

use super::PageError;
use super::checks::{check_finite, check_some};
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
        let none = self.outline_mm.len() < 3;
        check_some(&self.title, "the outline", none)?;
        let lines = self.lines.iter().map(|l| (&*l.name, &l.points_mm));
        let patches = self.patches_mm.iter().map(|p| ("patch", p));
        let all = lines.chain(patches).chain([("outline", &self.outline_mm)]);
        for (what, points) in all {
            check_finite(&self.title, what, points.iter().flatten())?;
        }
        Ok(())
    }

    pub(super) fn render(&self, page: &mut String) -> Result<(), PageError> {
        self.check()?;
        let frame = Frame::of(&self.outline_mm);
        // Names of clips are those of the page: the outline's own text makes them differ.
        let outline = frame.joined(&self.outline_mm);
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
            frame.tall() + 2.0 * MARGIN,
            escape(&plain(&self.title))
        );
        for patch in &self.patches_mm {
            let _ = writeln!(
                page,
                "<polygon clip-path=\"url(#{clip})\" fill=\"var(--c0)\" fill-opacity=\"0.13\" points=\"{}\"/>",
                frame.joined(patch)
            );
        }
        let _ = writeln!(
            page,
            "<polygon points=\"{outline}\" fill=\"none\" stroke=\"var(--faint)\"/>"
        );
        for (number, line) in self.lines.iter().enumerate() {
            frame.line(number + 1, &line.points_mm, page);
        }
        frame.names(page);
        frame.scale_bar(page);
        let lines = self.lines.iter().enumerate();
        page.push_str(&legend(lines.map(|(k, line)| (k + 1, &line.name[..])), ""));
        page.push_str("</figure>\n");
        Ok(())
    }
}

/// Where points of the flank lie in the drawing.
struct Frame {
    low: [f64; 2],
    high: [f64; 2],
    scale: f64,
}

impl Frame {
    fn of(outline_mm: &[[f64; 2]]) -> Self {
        let end = |k: usize, pick: fn(f64, f64) -> f64| {
            let values = outline_mm.iter().map(|p| p[k]);
            values.reduce(pick).unwrap_or(0.0)
        };
        let low = [0, 1].map(|k| end(k, f64::min));
        let high = [0, 1].map(|k| end(k, f64::max));
        let scale = WIDE / (high[0] - low[0]);
        Self { low, high, scale }
    }

    fn tall(&self) -> f64 {
        (self.high[1] - self.low[1]) * self.scale
    }

    fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (x, y) = (x - self.low[0], self.high[1] - y);
        [x * self.scale, y * self.scale]
    }

    fn joined(&self, points_mm: &[[f64; 2]]) -> String {
        points_mm.iter().fold(String::new(), |mut text, point| {
            let [x, y] = self.place(*point);
            let _ = write!(text, "{x:.2},{y:.2} ");
            text
        })
    }

    fn line(&self, colour: usize, points_mm: &[[f64; 2]], page: &mut String) {
        if points_mm.len() > 1 {
            let points = self.joined(points_mm);
            let _ = writeln!(
                page,
                "<polyline fill=\"none\" stroke=\"var(--c{colour})\" points=\"{points}\"/>"
            );
        }
        for point in points_mm {
            let [x, y] = self.place(*point);
            let _ = write!(
                page,
                "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"2\" fill=\"var(--c{colour})\"/>"
            );
        }
        page.push('\n');
    }

    fn names(&self, page: &mut String) {
        let tall = self.tall();
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
    }

    fn scale_bar(&self, page: &mut String) {
        let bar = round_step(self.high[0] - self.low[0]);
        let at = self.tall() + 30.0;
        let _ = write!(
            page,
            "<line x1=\"0\" y1=\"{at:.1}\" x2=\"{0:.1}\" y2=\"{at:.1}\" stroke=\"var(--faint)\" stroke-width=\"2\"/>\
             <text x=\"{1:.1}\" y=\"{2:.1}\">{3} mm</text>\n</svg>\n",
            bar * self.scale,
            bar * self.scale + 6.0,
            at + 4.0,
            tick(bar)
        );
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
