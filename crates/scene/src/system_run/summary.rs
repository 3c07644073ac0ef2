//! Figures of the columns of a result at a glance.

use gearmesh_model::FileError;
use gearmesh_signal::{Window, amplitude_spectrum};

use super::column_names::{noticeable, rank, varying};
use super::column_statistics::Figures;
use super::result::SystemResult;
use super::result_kind::ResultKind;

/// Longest series that is transformed: the last so many rows.
const LONGEST: usize = 1 << 20;

/// Lines of the spectrum that belong to the mean under the Hann window.
const MEAN_LINES: f64 = 3.0;

/// One column of a result.
#[derive(Debug, Clone, PartialEq)]
pub struct ColumnSummary {
    /// Name with unit.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Mean, deviation, extremes.
    pub figures: Figures,
    /// Frequency of the strongest line \[Hz\]; none where nothing varies, or rows are too far apart for it.
    pub dominant_hz: Option<f64>,
}

/// A time or a speed as people write it: what sums of steps leave behind the ninth decimal goes.
pub(super) fn without_rounding(value: f64) -> f64 {
    (1e9 * value).round() / 1e9
}

impl SystemResult {
    /// Distance of the rows of a transient result \[s\].
    ///
    /// # Errors
    /// [`FileError`] if the result has no times.
    pub fn interval_s(&self) -> Result<f64, FileError> {
        let times = self.rows.read("time_s")?;
        let steps = times.len().max(2) - 1;
        Ok((times.last().copied().unwrap_or(f64::NAN) - times[0]) / steps as f64)
    }

    /// What the statistics of a transient result go over, in words.
    #[must_use]
    pub fn statistics_in_words(&self) -> String {
        let end_s = self
            .record
            .as_ref()
            .map_or(f64::NAN, |record| record.simulated_s);
        let samples = match self.samples_per_row {
            1 => "all rows".to_owned(),
            samples => format!("{samples} samples a row"),
        };
        let [from_s, end_s] = [self.statistics_from_s, end_s].map(without_rounding);
        format!("figures from {from_s} s to {end_s} s, of {samples}")
    }

    /// Largest error of the energy balance of a run in time over the work done.
    #[must_use]
    pub fn relative_energy_error(&self) -> Option<f64> {
        Some(self.record.as_ref()?.relative_energy_error())
    }

    /// What is wrong with the result as a whole, if anything is: no figure of it is to be used then.
    #[must_use]
    pub fn problem(&self) -> Option<String> {
        self.record.as_ref()?.energy_problem()
    }

    /// Which columns of a transient result vary by more than rounding.
    #[must_use]
    pub fn varying(&self) -> Vec<bool> {
        let columns = self.rows.columns().iter().zip(&self.statistics);
        varying(columns.map(|(column, f)| (column.unit.as_str(), f.least, f.largest)))
    }

    /// Columns of a run in time or of a static series whose names `wanted` accepts, in the order of the file.
    ///
    /// # Errors
    /// [`FileError`].
    pub fn summaries(
        &self,
        wanted: impl Fn(&str) -> bool,
    ) -> Result<Vec<ColumnSummary>, FileError> {
        let mut found = Vec::new();
        if self.kind != ResultKind::Transient {
            for column in self.rows.columns().iter().filter(|c| wanted(&c.name)) {
                found.push(ColumnSummary {
                    name: column.name.clone(),
                    unit: column.unit.clone(),
                    figures: Figures::of(&self.rows.read(&column.name)?),
                    dominant_hz: None,
                });
            }
            return Ok(found);
        }
        let interval_s = self.interval_s()?;
        let columns = self.rows.columns().iter().zip(&self.statistics);
        for ((column, figures), varies) in columns.zip(self.varying()) {
            if !wanted(&column.name) {
                continue;
            }
            let folds = self.folded_share(&column.name).is_some();
            let dominant_hz = if varies && !folds && !is_progressive(&column.name) {
                let values = self.read_for_spectrum(&column.name)?;
                let first = (self.statistics_from_s / interval_s).round() as usize;
                dominant_hz(&values[first.min(values.len() - 1)..], interval_s)
            } else {
                None
            };
            found.push(ColumnSummary {
                name: column.name.clone(),
                unit: column.unit.clone(),
                figures: *figures,
                dominant_hz,
            });
        }
        Ok(found)
    }
}

/// The columns that are other than zero by more than rounding, those first that a reader asks for first.
#[must_use]
pub fn foremost(mut found: Vec<ColumnSummary>) -> Vec<ColumnSummary> {
    let shown = {
        let columns = found
            .iter()
            .map(|c| (&*c.unit, c.figures.least, c.figures.largest));
        noticeable(columns)
    };
    let mut shown = shown.into_iter();
    found.retain(|_| shown.next().unwrap_or(false));
    found.sort_by_key(|column| rank(&column.name));
    found
}

/// Columns that grow with the run: a frequency of theirs says nothing.
fn is_progressive(name: &str) -> bool {
    let counted = [
        "/turn_rad",
        "/angle_rad",
        "cardan_x_rad",
        "cardan_y_rad",
        "cardan_z_rad",
    ];
    name == "time_s"
        || name.starts_with("energy/")
        || name.starts_with("run/")
        || counted.iter().any(|end| name.ends_with(end))
}

/// Place of the strongest line above the mean \[Hz\].
fn dominant_hz(values: &[f64], interval_s: f64) -> Option<f64> {
    let values = &values[values.len().saturating_sub(LONGEST)..];
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let centred: Vec<f64> = values.iter().map(|x| x - mean).collect();
    let spectrum = amplitude_spectrum(&centred, 1.0 / interval_s, Window::Hann).ok()?;
    let from = MEAN_LINES * spectrum.line_spacing;
    spectrum.peak_place(from, spectrum.highest()).ok()
}
