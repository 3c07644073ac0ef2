//! Values at angles round a circle, as bars from its middle: which balls of a bearing carry how much.
//!
//! Drawn as SVG in the page itself: it needs no script.

use super::PageError;
use super::checks::{check_count, check_finite, check_some};
use super::markup::{escape, legend};
use super::typography::{html, plain};
use std::f64::consts::TAU;
use std::fmt::Write as _;

/// Half the width of the drawing, in its own units.
const HALF: f64 = 210.0;

/// Its largest circle; the names of the angles stand outside.
const RADIUS: f64 = 165.0;

/// One family of bars.
#[derive(Debug, Clone, PartialEq)]
struct PolarSeries {
    name: String,
    values: Vec<f64>,
}

/// Bars from the middle; angles count from the right, anticlockwise, x to the right and y upwards.
#[derive(Debug, Clone, PartialEq)]
pub struct PolarChart {
    title: String,
    unit: String,
    angles_rad: Vec<f64>,
    series: Vec<PolarSeries>,
}

impl PolarChart {
    /// A picture without bars.
    pub fn new(title: impl Into<String>, unit: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            unit: unit.into(),
            angles_rad: Vec::new(),
            series: Vec::new(),
        }
    }

    /// Where the bars stand.
    #[must_use]
    pub fn angles_rad(mut self, angles_rad: Vec<f64>) -> Self {
        self.angles_rad = angles_rad;
        self
    }

    /// Adds a family of bars, one value an angle, none below zero.
    #[must_use]
    pub fn series(mut self, name: impl Into<String>, values: Vec<f64>) -> Self {
        self.series.push(PolarSeries {
            name: name.into(),
            values,
        });
        self
    }

    fn check(&self) -> Result<f64, PageError> {
        let none = self.angles_rad.is_empty() || self.series.is_empty();
        check_some(&self.title, "the list of bars", none)?;
        for series in &self.series {
            let what = format!("series '{}'", series.name);
            let (found, expected) = (series.values.len(), self.angles_rad.len());
            check_count(&self.title, &what, found, expected)?;
        }
        for series in &self.series {
            check_finite(&self.title, &series.name, &series.values)?;
        }
        check_finite(&self.title, "angles", &self.angles_rad)?;
        let values = self.series.iter().flat_map(|s| &s.values);
        Ok(values.fold(0.0, |a: f64, b| a.max(*b)))
    }

    pub(super) fn render(&self, page: &mut String) -> Result<(), PageError> {
        let largest = self.check()?;
        let step = round_step(largest);
        let top = if largest > 0.0 {
            step * (largest / step).ceil()
        } else {
            1.0
        };
        let scale = RADIUS / top;
        open_square(&self.title, HALF, page);
        self.grid(page, (step, top, scale));
        let width = (0.45 * TAU * 60.0 / self.angles_rad.len() as f64).clamp(2.0, 14.0);
        for (number, series) in self.series.iter().enumerate() {
            let share = width / (number + 1) as f64;
            for (angle, value) in self.angles_rad.iter().zip(&series.values) {
                let (s, c) = angle.sin_cos();
                let length = value.max(0.0) * scale;
                let _ = write!(
                    page,
                    "<line x1=\"0\" y1=\"0\" x2=\"{:.2}\" y2=\"{:.2}\" stroke=\"var(--c{number})\" stroke-width=\"{share:.1}\"/>",
                    length * c,
                    -length * s
                );
            }
        }
        // On top of the bars, or they would hide it.
        for circle in 1..=circles(step, top) {
            let value = step * circle as f64;
            let _ = write!(
                page,
                "<text x=\"3\" y=\"{:.1}\">{}</text>",
                -value * scale - 2.0,
                tick(value)
            );
        }
        page.push_str("\n</svg>\n");
        let entries = self.series.iter().enumerate();
        let entries = entries.map(|(number, series)| (number, &series.name[..]));
        let told = format!("in {0}; circles every {1} {0}", self.unit, tick(step));
        page.push_str(&legend(entries, &told));
        page.push_str("</figure>\n");
        Ok(())
    }

    /// Circles, and rays at every 45°.
    fn grid(&self, page: &mut String, (step, top, scale): (f64, f64, f64)) {
        for circle in 1..=circles(step, top) {
            let radius = step * circle as f64 * scale;
            let _ = write!(page, "<circle r=\"{radius:.1}\" class=\"grid\"/>");
        }
        for eighth in 0..8_u8 {
            let degrees = 45.0 * f64::from(eighth);
            let (s, c) = degrees.to_radians().sin_cos();
            let (x, y) = (c * (RADIUS + 24.0), -s * (RADIUS + 24.0) + 4.0);
            let _ = write!(
                page,
                "<line x1=\"0\" y1=\"0\" x2=\"{:.1}\" y2=\"{:.1}\" class=\"grid\"/>\
                 <text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"middle\">{degrees}°</text>",
                RADIUS * c,
                -RADIUS * s
            );
        }
        page.push('\n');
    }
}

fn circles(step: f64, top: f64) -> usize {
    (top / step).round().max(1.0) as usize
}

/// A number beside an axis: without the rounding of a sum, small and large ones with a power of ten.
pub(super) fn tick(value: f64) -> String {
    let exact = format!("{value:.4e}").parse::<f64>().unwrap_or(value);
    plain(&match exact != 0.0 && !(1e-4..1e7).contains(&exact.abs()) {
        true => format!("{exact:e}"),
        false => exact.to_string(),
    })
}

/// 1, 2 or 5 times a power of ten, so that three to six fit in.
pub(super) fn round_step(largest: f64) -> f64 {
    if largest <= 0.0 {
        return 1.0;
    }
    let rough = largest / 5.0;
    let power = 10.0_f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .find(|m| m * power >= rough);
    // A sum in decimal digits: 0.30000000000000004 has no place in a picture.
    let found = step.unwrap_or(10.0) * power;
    format!("{found:.3e}").parse().unwrap_or(found)
}

/// Begins a square figure whose drawing reaches so far from its middle.
pub(super) fn open_square(title: &str, half: f64, page: &mut String) {
    let wide = 2.0 * half;
    // Writing to a String does not fail.
    let _ = write!(
        page,
        "<figure class=\"polar\">\n<figcaption>{}</figcaption>\n\
         <svg viewBox=\"{} {} {wide} {wide}\" role=\"img\" aria-label=\"{}\">\n",
        html(title),
        -half,
        -half,
        escape(&plain(title))
    );
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn bars_stand_at_their_angles_and_in_scale() {
        let chart = PolarChart::new("t", "N")
            .angles_rad(vec![0.0, 0.25 * TAU])
            .series("inner", vec![100.0, 50.0]);
        let mut html = String::new();
        chart.render(&mut html).unwrap();
        assert!(html.contains("x2=\"165.00\" y2=\"-0.00\""), "{html}");
        assert!(html.contains("x2=\"0.00\" y2=\"-82.50\""), "{html}");
        assert!(html.contains("circles every 20 N"), "{html}");
    }

    #[test]
    fn what_does_not_fit_is_told() {
        let mut html = String::new();
        let none = PolarChart::new("t", "N");
        assert!(matches!(
            none.render(&mut html),
            Err(PageError::Empty { .. })
        ));
        let short = none
            .clone()
            .angles_rad(vec![0.0, 1.0])
            .series("a", vec![1.0]);
        assert!(matches!(
            short.render(&mut html),
            Err(PageError::Count { .. })
        ));
        let wrong = none.angles_rad(vec![0.0]).series("a", vec![f64::NAN]);
        assert!(matches!(
            wrong.render(&mut html),
            Err(PageError::NotFinite { .. })
        ));
    }
}
