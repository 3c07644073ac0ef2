//! Waterfalls: spectra of short blocks of a series one after the other, as many as a picture shows.

use gearmesh_signal::{CampbellRow, FrequencyBlocks, Window, campbell::frequency_map};

/// Blocks that a picture shows.
const BLOCKS: usize = 80;

/// A stretch has as many blocks beside each other, without what they overlap.
const PARTS: usize = 16;

/// Rows of a block: fewer resolve nothing, more are finer than the picture.
const ROWS: [usize; 2] = [64, 4096];

/// The blocks of a series at even steps, each with its time after the first row, the mean speed of a shaft and its
/// amplitudes (Hann window). Without a shaft all speeds are zero.
///
/// # Errors
/// In words: too few rows, and values that are no numbers.
pub fn waterfall(
    values: &[f64],
    speed_rad_per_s: Option<&[f64]>,
    rate_hz: f64,
) -> Result<Vec<CampbellRow>, String> {
    let block = (values.len() / PARTS).clamp(ROWS[0], ROWS[1]) & !1;
    if values.len() < 2 * block {
        return Err(format!(
            "{} rows are shown; a waterfall needs {}: show a longer part",
            values.len(),
            2 * block
        ));
    }
    let mut turned_rad = 0.0;
    let angle_rad: Vec<f64> = match speed_rad_per_s {
        None => vec![0.0; values.len()],
        Some(speed) => (speed.iter())
            .map(|speed| {
                turned_rad += speed.abs() / rate_hz;
                turned_rad
            })
            .collect(),
    };
    let blocks = FrequencyBlocks {
        block_samples: block,
        step_samples: ((values.len() - block) / (BLOCKS - 1)).max(1),
        window: Window::Hann,
    };
    frequency_map(values, &angle_rad, rate_hz, blocks).map_err(|error| error.to_string())
}
