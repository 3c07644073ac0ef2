//! What of a column is looked at: `COLUMN`, or `COLUMN:FIGURE` for one number of a series.

use gearmesh_specification::names::unknown;
use gearmesh_specification::study::Study;
use std::f64::consts::TAU;

use crate::system_run::Figures;

/// A number of a series.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Figure {
    /// Mean.
    Mean,
    /// Standard deviation.
    Deviation,
    /// √(mean² + deviation²).
    Rms,
    /// Largest less smallest value.
    PeakToPeak,
    /// Largest value.
    Largest,
    /// Smallest value.
    Least,
    /// Amplitude of the line of the spectrum at a frequency \[Hz\].
    Line(f64),
    /// Of sweeps: the speed at which the column swings most \[1/min\].
    Resonance,
}

/// Figures that every series has.
const OF_SERIES: [&str; 6] = [
    "mean",
    "deviation",
    "rms",
    "peak-to-peak",
    "largest",
    "least",
];

/// Which figures there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FigureKinds {
    /// None: columns are single numbers.
    None,
    /// Those of every series.
    OfSeries,
    /// Lines of the spectrum, too.
    InTime,
    /// The speed of resonance, too.
    OfSweep,
}

impl Figure {
    /// Reads the word behind the colon.
    fn of(word: &str) -> Option<Self> {
        Some(match word {
            "mean" => Self::Mean,
            "deviation" => Self::Deviation,
            "rms" => Self::Rms,
            "peak-to-peak" => Self::PeakToPeak,
            "largest" => Self::Largest,
            "least" => Self::Least,
            "resonance-rpm" => Self::Resonance,
            _ => {
                let hz: f64 = word
                    .strip_prefix("line-")?
                    .strip_suffix("Hz")?
                    .parse()
                    .ok()?;
                (hz > 0.0 && hz.is_finite()).then_some(Self::Line(hz))?
            }
        })
    }

    /// From the figures of a series; none of what asks for the series itself.
    #[must_use]
    pub fn value(self, figures: &Figures) -> Option<f64> {
        Some(match self {
            Self::Mean => figures.mean,
            Self::Deviation => figures.deviation,
            Self::Rms => figures.rms(),
            Self::PeakToPeak => figures.peak_to_peak(),
            Self::Largest => figures.largest,
            Self::Least => figures.least,
            Self::Line(_) | Self::Resonance => return None,
        })
    }
}

/// Begin of the columns that are figures of ratings: `ratings/NAME/FIGURE`.
pub(super) const RATINGS: &str = "ratings/";

/// Begin of the columns that are figures of planetary sets: `planetary/NAME/FIGURE`.
pub(super) const SETS: &str = "planetary/";

/// A column, and what of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Wanted {
    /// The column.
    pub column: String,
    /// Behind the colon, as written; empty where there is none.
    pub word: String,
}

impl Wanted {
    /// `COLUMN` or `COLUMN:FIGURE`.
    #[must_use]
    pub fn of(text: &str) -> Self {
        let (column, word) = text.rsplit_once(':').unwrap_or((text, ""));
        Self {
            column: column.to_owned(),
            word: word.to_owned(),
        }
    }

    /// The columns that a study looks at.
    #[must_use]
    pub fn of_study(study: &Study) -> Vec<Self> {
        let columns = study.tables.columns.iter();
        columns.map(|text| Self::of(text)).collect()
    }

    /// As it was written.
    #[must_use]
    pub fn name(&self) -> String {
        if self.word.is_empty() {
            return self.column.clone();
        }
        format!("{}:{}", self.column, self.word)
    }

    /// Whether it is a figure of a `[[rating]]` of the scene.
    #[must_use]
    pub fn is_of_rating(&self) -> bool {
        self.column.starts_with(RATINGS)
    }

    /// Whether it is a figure of a `[[planetary]]` of the scene.
    #[must_use]
    pub fn is_of_set(&self) -> bool {
        self.column.starts_with(SETS)
    }

    /// The figure; none where the whole series is meant.
    #[must_use]
    pub fn figure(&self) -> Option<Figure> {
        Figure::of(&self.word)
    }

    /// Checks column and figure against what there is.
    ///
    /// # Errors
    /// What to say, with near names.
    pub fn check(&self, known: &[String], kinds: FigureKinds) -> Result<(), String> {
        if !known.contains(&self.column) {
            return Err(unknown("column", &self.column, known));
        }
        if self.word.is_empty() {
            return Ok(());
        }
        if self.is_of_rating() || self.is_of_set() {
            let problem = format!(
                "`{}`: a figure of a rating or a planetary set is one number; remove `:{}`",
                self.name(),
                self.word
            );
            return Err(problem);
        }
        let fits = match self.figure() {
            None => false,
            Some(Figure::Line(_)) => kinds == FigureKinds::InTime,
            Some(Figure::Resonance) => kinds == FigureKinds::OfSweep,
            Some(_) => kinds != FigureKinds::None,
        };
        if fits {
            return Ok(());
        }
        let mut words: Vec<&str> = match kinds {
            FigureKinds::None => {
                return Err(format!(
                    "`{}` is a single number; remove `:{}`",
                    self.column, self.word
                ));
            }
            _ => OF_SERIES.into(),
        };
        match kinds {
            FigureKinds::InTime => words.push("line-250Hz"),
            FigureKinds::OfSweep => words.push("resonance-rpm"),
            _ => {}
        }
        let what = format!("figure of {}, written COLUMN:FIGURE,", self.column);
        Err(unknown(&what, &self.word, &words))
    }
}

/// Amplitude of the part of a series that swings at a frequency: |Σ w (x − x̄) e^(−iωt)| · 2/Σ w under the Hann window
/// w, x̄ the mean under the same window, so that neither the mean nor lines three spacings away leak into it.
#[must_use]
pub fn line_amplitude(values: &[f64], interval_s: f64, hz: f64) -> f64 {
    let count = values.len();
    let weight = |k: usize| 0.5 - 0.5 * (TAU * (k as f64 + 0.5) / count as f64).cos();
    let total: f64 = (0..count).map(weight).sum();
    let mean = (values.iter().enumerate())
        .map(|(k, x)| weight(k) * x)
        .sum::<f64>()
        / total;
    let (mut re, mut im) = (0.0, 0.0);
    for (k, x) in values.iter().enumerate() {
        let (sin, cos) = (TAU * hz * interval_s * k as f64).sin_cos();
        let part = weight(k) * (x - mean);
        re += part * cos;
        im -= part * sin;
    }
    2.0 * re.hypot(im) / total
}

/// Place of the largest swing over the speeds: the vertex of the parabola through the largest value and its neighbours.
#[must_use]
pub fn resonance(speeds: &[f64], swings: &[f64]) -> f64 {
    let best = (0..swings.len()).max_by(|a, b| swings[*a].total_cmp(&swings[*b]));
    let Some(k) = best else { return f64::NAN };
    if k == 0 || k + 1 >= speeds.len() {
        return speeds[k];
    }
    let [x0, x1, x2] = [speeds[k - 1], speeds[k], speeds[k + 1]];
    let (d1, d2) = (
        (swings[k] - swings[k - 1]) / (x1 - x0),
        (swings[k + 1] - swings[k]) / (x2 - x1),
    );
    let curvature = (d2 - d1) / (x2 - x0);
    // A jump has its largest value at the edge: neighbours in speed only, and a vertex between them.
    let vertex = 0.5 * (x0 + x1) - 0.5 * d1 / curvature;
    let between = (x0 < vertex) == (vertex < x2);
    if between && curvature < 0.0 {
        vertex
    } else {
        x1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A line of amplitude 3 at 50 Hz beside a mean of 7 and a line of 5 at 120 Hz.
    #[test]
    fn a_line_is_found_beside_others() {
        let step = 1e-3;
        let wave = |hz: f64, t: f64| (TAU * hz * t + 0.3).sin();
        let values: Vec<f64> = (0..1000)
            .map(|k| f64::from(k) * step)
            .map(|t| 7.0 + 3.0 * wave(50.0, t) + 5.0 * wave(120.0, t))
            .collect();
        assert!((line_amplitude(&values, step, 50.0) - 3.0).abs() < 1e-4);
        assert!((line_amplitude(&values, step, 120.0) - 5.0).abs() < 1e-4);
        assert!(line_amplitude(&values, step, 80.0) < 1e-3);
    }

    #[test]
    fn a_resonance_is_the_vertex_of_a_parabola() {
        let speeds = [100.0, 200.0, 300.0, 400.0];
        let swing = |n: f64| 10.0 - 1e-4 * (n - 230.0).powi(2);
        let found = resonance(&speeds, &speeds.map(swing));
        assert!((found - 230.0).abs() < 1e-9, "{found}");
        assert_eq!(resonance(&speeds, &[4.0, 3.0, 2.0, 1.0]), 100.0);
    }

    #[test]
    fn figures_are_those_of_the_kind() {
        let known = ["a".to_owned(), "b".to_owned()];
        let check = |text: &str, kinds| Wanted::of(text).check(&known, kinds);
        assert!(check("a:line-250Hz", FigureKinds::InTime).is_ok());
        assert!(check("a:line-250Hz", FigureKinds::OfSweep).is_err());
        assert!(check("a:resonance-rpm", FigureKinds::OfSweep).is_ok());
        let told = check("a:maen", FigureKinds::OfSeries).err();
        assert!(told.is_some_and(|told| told.contains("did you mean `mean`?")));
        assert!(check("a:mean", FigureKinds::None).is_err());
        assert!(check("c", FigureKinds::None).is_err());
    }
}
