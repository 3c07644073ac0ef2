//! A path in a plane with the same scale both ways: where the middle of a shaft or cage goes.
//!
//! Drawn as SVG in the page itself: it needs no script.

use super::PageError;
use super::checks::{check_finite, check_some};
use super::polar_chart::{open_square, round_step, tick};
use super::typography::html;
use std::fmt::Write as _;

/// Half the width of the drawing, in its own units.
const HALF: f64 = 226.0;

/// Half the width of the field in it; the numbers stand beside it.
const FIELD: f64 = 170.0;

/// A path; the last point stands out.
#[derive(Debug, Clone, PartialEq)]
pub struct PathChart {
    title: String,
    unit: String,
    points: Vec<[f64; 2]>,
}

impl PathChart {
    /// A path of points (x, y), both in this unit; x to the right, y upwards.
    pub fn new(title: impl Into<String>, unit: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self {
            title: title.into(),
            unit: unit.into(),
            points,
        }
    }

    pub(super) fn render(&self, page: &mut String) -> Result<(), PageError> {
        check_some(&self.title, "the path", self.points.is_empty())?;
        let all = || self.points.iter().flatten();
        check_finite(&self.title, "path", all())?;
        let largest = all().fold(0.0, |a: f64, b| a.max(b.abs()));
        let step = round_step(largest);
        let top = step * (largest / step).ceil().max(1.0);
        let scale = FIELD / top;
        open_square(&self.title, HALF, page);
        let lines = (top / step).round() as i32;
        for line in -lines..=lines {
            let value = tick(step * f64::from(line));
            let at = step * f64::from(line) * scale;
            let _ = write!(
                page,
                "<line x1=\"{at:.1}\" y1=\"{}\" x2=\"{at:.1}\" y2=\"{FIELD}\" class=\"grid\"/>\
                 <line x1=\"{}\" y1=\"{at:.1}\" x2=\"{FIELD}\" y2=\"{at:.1}\" class=\"grid\"/>",
                -FIELD, -FIELD
            );
            if line % 2 == 0 || lines < 4 {
                let _ = write!(
                    page,
                    "<text x=\"{at:.1}\" y=\"{}\" text-anchor=\"middle\">{value}</text>\
                     <text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{value}</text>",
                    FIELD + 16.0,
                    -FIELD - 5.0,
                    -at + 4.0
                );
            }
        }
        page.push_str("\n<polyline fill=\"none\" stroke=\"var(--c0)\" points=\"");
        for [x, y] in &self.points {
            let _ = write!(page, "{:.2},{:.2} ", x * scale, -y * scale);
        }
        let [x, y] = self.points[self.points.len() - 1];
        let _ = writeln!(
            page,
            "\"/><circle cx=\"{:.2}\" cy=\"{:.2}\" r=\"3\" fill=\"var(--c1)\"/>\n</svg>\n\
             <p class=\"readout\">x to the right, y upwards, in {}; the dot is the end</p>\n</figure>",
            x * scale,
            -y * scale,
            html(&self.unit)
        );
        Ok(())
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn the_path_is_in_scale_both_ways() {
        let mut html = String::new();
        let path = PathChart::new("t", "µm", vec![[0.0, 0.0], [10.0, -5.0]]);
        path.render(&mut html).unwrap();
        assert!(
            html.contains("points=\"0.00,-0.00 170.00,85.00 \""),
            "{html}"
        );
    }

    #[test]
    fn what_is_no_path_is_told() {
        let mut html = String::new();
        let none = PathChart::new("t", "m", Vec::new());
        assert!(matches!(
            none.render(&mut html),
            Err(PageError::Empty { .. })
        ));
        let wrong = PathChart::new("t", "m", vec![[0.0, f64::NAN]]);
        assert!(matches!(
            wrong.render(&mut html),
            Err(PageError::NotFinite { .. })
        ));
    }
}
