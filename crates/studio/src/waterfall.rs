//! Waterfall of a column: spectra of short blocks one after the other, each at its time and at the speed of a shaft.

use gearmesh_report::waterfall;
use serde::Deserialize;
use serde_json::{Value, json};

use crate::columns::ColumnsSession;
use crate::problem::Problem;

/// Lines that a picture shows: of more the largest of neighbours.
const LINES: usize = 400;

/// Which waterfall.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WaterfallAsked {
    column: String,
    /// Column of a shaft's speed \[rad/s\], for its orders.
    speed: Option<String>,
    from: Option<f64>,
    to: Option<f64>,
}

impl ColumnsSession {
    /// Amplitudes `[block][line]`, with the time of each block and the speed there.
    ///
    /// # Errors
    /// [`Problem::Input`] for columns that are not there, rows without even steps in time, and too few of them.
    pub fn waterfall(&self, asked: &WaterfallAsked) -> Result<Value, Problem> {
        let rows = self.stretch([asked.from, asked.to]);
        let time_s = &self.axis()[rows.clone()];
        let rate = self.rate(time_s)?;
        let refused =
            |error: &dyn std::fmt::Display| Problem::Input(format!("{}: {error}", asked.column));
        let result = self.locked()?;
        let read = |name: &String| -> Result<Vec<f64>, Problem> {
            self.demand(name)?;
            Ok(result.read_for_spectrum(name)?[rows.clone()].to_vec())
        };
        let values = read(&asked.column)?;
        let speed = asked.speed.as_ref().map(read).transpose()?;
        let map = waterfall(&values, speed.as_deref(), rate).map_err(|error| refused(&error))?;
        let lines = map.first().map_or(0, |row| row.spectrum.values.len());
        let group = lines.div_ceil(LINES).max(1);
        let largest = |lines: &[f64]| lines.iter().copied().fold(0.0, f64::max);
        let amplitudes: Vec<f64> = (map.iter())
            .flat_map(|row| row.spectrum.values.chunks(group).map(largest))
            .collect();
        let spacing = map.first().map_or(0.0, |row| row.spectrum.line_spacing);
        Ok(json!({
            "time_s": map.iter().map(|row| time_s[0] + row.time_s).collect::<Vec<_>>(),
            "speed_Hz": map.iter().map(|row| row.speed_rad_per_s / std::f64::consts::TAU).collect::<Vec<_>>(),
            "lines": lines.div_ceil(group),
            "line_Hz": spacing * group as f64,
            "amplitudes": amplitudes,
        }))
    }
}
