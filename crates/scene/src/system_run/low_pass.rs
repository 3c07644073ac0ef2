//! Rows as a run goes on: values at instants, and beside them columns from which all that a spectrum over the rows
//! cannot hold has been filtered.
//!
//! A run is looked at more often than rows are written, M times in an interval T, about once a step. What vibrates
//! faster than 1/2T would be folded to a false place in a spectrum over the rows: a column `low_pass/NAME` holds
//!
//! ```text
//! y_k = Σ_j h_j x_{kM+j},   |j| ≤ 16 M
//! ```
//!
//! with the windowed sinc of [`Resampler::decimation`]: a tone below 0.8 of 1/2T is kept within 7e-5 of its amplitude,
//! one above 1.2 of it goes in with less than that, what lies between is damped and folded between. At the ends the
//! series goes on as its mirror image through its last value, x_{−j} = 2 x₀ − x_j, which keeps straight lines and the
//! values there; in runs of fewer than 32 rows, where images end, constants only.
//!
//! The columns that a reader asks for first are filtered. Of all columns the RMS value of x − y is kept: how much of a
//! column would be folded.

use gearmesh_model::Column;
use gearmesh_signal::{Resampler, SeriesError};

use super::column_names::is_prominent;

/// Group of the filtered columns.
pub(crate) const GROUP: &str = "low_pass/";

/// Rows on each side that a filtered value is made of.
const HALF_ROWS: usize = 16;

/// Share of half the rate of the rows up to which a filtered column is right.
pub const LOW_PASS_BAND: f64 = 0.8;

/// Rows on their way: of M samples each.
#[derive(Debug)]
pub(super) struct RowFilter {
    per_row: usize,
    half: usize,
    taps: Vec<f64>,
    /// Places of the columns whose filtered values are given, and columns of a row.
    filtered: Vec<usize>,
    width: usize,
    /// Samples seen, rows given.
    seen: usize,
    given: usize,
    /// Rows away from the ends, and sums over them of the squares of what the filter has taken from each column.
    compared: f64,
    folded: Vec<f64>,
    /// The last samples, sample n at n modulo their number.
    ring: Vec<f64>,
    /// Rows that wait for what comes after them, row k at k modulo their number.
    waiting: Vec<f64>,
    /// Filtered values of all columns.
    sums: Vec<f64>,
    out: Vec<f64>,
}

impl RowFilter {
    /// For rows of `columns`, one for every `per_row` samples; nothing is filtered where rows are samples.
    ///
    /// # Errors
    /// [`SeriesError`] of the filter.
    pub fn new(columns: &[Column], per_row: usize) -> Result<Self, SeriesError> {
        let (taps, filtered) = if per_row > 1 {
            let taps = Resampler::new(HALF_ROWS, LOW_PASS_BAND)?.decimation(per_row);
            let places = (0..columns.len()).filter(|k| is_prominent(&columns[*k].name));
            (taps, places.collect())
        } else {
            (vec![1.0], Vec::new())
        };
        let half = taps.len() / 2;
        let width = columns.len();
        Ok(Self {
            per_row,
            half,
            width,
            seen: 0,
            given: 0,
            compared: 0.0,
            folded: vec![0.0; width],
            ring: vec![0.0; taps.len() * width],
            sums: vec![0.0; width],
            waiting: vec![0.0; (half / per_row + 2) * width],
            out: Vec::with_capacity(width + filtered.len()),
            taps,
            filtered,
        })
    }

    /// The columns of what is given: those of a row, then the filtered ones.
    pub fn columns(&self, columns: &[Column]) -> Vec<Column> {
        let filtered = self.filtered.iter().map(|place| {
            let Column {
                name,
                unit,
                description,
            } = &columns[*place];
            let text = format!("{description}; low-pass below half the rate of the rows");
            Column::new(format!("{GROUP}{name}"), unit, &text)
        });
        columns.iter().cloned().chain(filtered).collect()
    }

    /// Takes a sample of all columns and gives the row that has become known, if any. Allocates nothing.
    pub fn add<E>(
        &mut self,
        sample: &[f64],
        give: impl FnMut(&[f64]) -> Result<(), E>,
    ) -> Result<(), E> {
        let number = self.seen;
        let slot = number % self.taps.len() * self.width;
        self.ring[slot..slot + self.width].copy_from_slice(sample);
        if number.is_multiple_of(self.per_row) {
            let rows = self.waiting.len() / self.width.max(1);
            let slot = number / self.per_row % rows * self.width;
            self.waiting[slot..slot + self.width].copy_from_slice(sample);
        }
        self.seen += 1;
        if number >= self.given * self.per_row + self.half {
            return self.give(give);
        }
        Ok(())
    }

    /// Gives the rows that still wait: nothing comes after them.
    pub fn finish<E>(&mut self, mut give: impl FnMut(&[f64]) -> Result<(), E>) -> Result<(), E> {
        while self.given * self.per_row < self.seen {
            self.give(&mut give)?;
        }
        Ok(())
    }

    fn give<E>(&mut self, mut give: impl FnMut(&[f64]) -> Result<(), E>) -> Result<(), E> {
        let rows = self.waiting.len() / self.width.max(1);
        let slot = self.given % rows * self.width;
        let row = &self.waiting[slot..slot + self.width];
        self.out.clear();
        self.out.extend_from_slice(row);
        let last = self.seen - 1;
        let sums = &mut self.sums;
        sums.fill(0.0);
        let kept =
            |sample: usize| &self.ring[sample % self.taps.len() * self.width..][..self.width];
        for (j, tap) in self.taps.iter().enumerate() {
            let sample = (self.given * self.per_row + j) as i64 - self.half as i64;
            // Through which sample the series is mirrored here, and its image there.
            let (through, image) = if sample < 0 {
                (Some(0), (-sample as usize).min(last))
            } else if sample as usize > last {
                (Some(last), (2 * last).saturating_sub(sample as usize))
            } else {
                (None, sample as usize)
            };
            let values = kept(image);
            match through {
                None => sums
                    .iter_mut()
                    .zip(values)
                    .for_each(|(sum, x)| *sum += tap * x),
                Some(through) => {
                    for ((sum, x), middle) in sums.iter_mut().zip(values).zip(kept(through)) {
                        *sum += tap * (2.0 * middle - x);
                    }
                }
            }
        }
        self.out
            .extend(self.filtered.iter().map(|place| sums[*place]));
        let middle = self.given * self.per_row;
        if middle >= self.half && middle + self.half <= last {
            self.compared += 1.0;
            let pairs = row.iter().zip(&*sums).zip(&mut self.folded);
            pairs.for_each(|((x, y), sum)| *sum += (x - y) * (x - y));
        }
        self.given += 1;
        give(&self.out)
    }

    /// RMS value of what the filter has taken from each column; empty where nothing is filtered or the run has fewer
    /// rows than the filter.
    pub fn folded(&self) -> Vec<f64> {
        if self.per_row == 1 || self.compared == 0.0 {
            return Vec::new();
        }
        let sums = self.folded.iter();
        sums.map(|sum| (sum / self.compared).sqrt()).collect()
    }

    /// All numbers, for a checkpoint.
    pub fn save(&self) -> Vec<f64> {
        let counts = [self.seen as f64, self.given as f64, self.compared];
        let numbers = counts.iter().chain(&self.folded);
        let numbers = numbers.chain(&self.ring).chain(&self.waiting);
        numbers.copied().collect()
    }

    /// Rows that are given once so many samples are seen.
    fn given_after(&self, samples: usize) -> usize {
        let waiting = self.half;
        samples
            .checked_sub(waiting + 1)
            .map_or(0, |before| before / self.per_row + 1)
    }

    /// Whether [`Self::save`] may have given these numbers for the same rows, at most `samples` of them seen.
    pub fn fits(&self, numbers: &[f64], samples: u64) -> bool {
        let Some(([seen, given, compared], rest)) = numbers.split_first_chunk::<3>() else {
            return false;
        };
        rest.len() == self.width + self.ring.len() + self.waiting.len()
            && (0.0..=samples as f64).contains(seen)
            && seen.fract() == 0.0
            && *given == self.given_after(*seen as usize) as f64
            && (0.0..=*given).contains(compared)
    }

    /// Takes what [`Self::save`] gave for the same rows; [`Self::fits`] says whether it did.
    pub fn restore(&mut self, numbers: &[f64]) {
        if let Some(([seen, given, compared], rest)) = numbers.split_first_chunk::<3>() {
            (self.seen, self.given) = (*seen as usize, *given as usize);
            self.compared = *compared;
            let (folded, rest) = rest.split_at(self.width);
            self.folded.copy_from_slice(folded);
            let (ring, waiting) = rest.split_at(self.ring.len());
            self.ring.copy_from_slice(ring);
            self.waiting.copy_from_slice(waiting);
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use std::convert::Infallible;
    use std::f64::consts::TAU;

    const PER_ROW: usize = 5;

    fn columns() -> Vec<Column> {
        ["time_s", "elements/mesh/force_N"]
            .map(|name| Column::new(name, "N", ""))
            .into()
    }

    /// Time, value at the instant, filtered value of each row, of a run that is stored and goes on again at one sample.
    fn rows(samples: usize, value: impl Fn(f64) -> f64, stored_at: Option<usize>) -> Vec<[f64; 3]> {
        let mut found = Vec::new();
        let mut take = |row: &[f64]| {
            found.push(<[f64; 3]>::try_from(row).unwrap());
            Ok::<(), Infallible>(())
        };
        let mut filter = RowFilter::new(&columns(), PER_ROW).unwrap();
        for n in 0..samples {
            if stored_at == Some(n) {
                let numbers = filter.save();
                assert!(filter.fits(&numbers, samples as u64), "{n}");
                for (place, wrong) in [(0, f64::INFINITY), (1, 1e3), (2, -1.0), (0, f64::NAN)] {
                    let mut numbers = numbers.clone();
                    numbers[place] = wrong;
                    assert!(!filter.fits(&numbers, samples as u64), "{n} {place}");
                }
                filter = RowFilter::new(&columns(), PER_ROW).unwrap();
                filter.restore(&numbers);
            }
            let at = n as f64 / PER_ROW as f64;
            filter.add(&[at, value(at)], &mut take).unwrap();
        }
        filter.finish(&mut take).unwrap();
        found
    }

    #[test]
    fn tones_above_half_the_rate_of_the_rows_leave_and_those_below_stay() {
        // In periods a row: 0.3 is kept; 1.35 would be seen at 0.35.
        let low = |at: f64| (TAU * 0.3 * at + 0.4).sin();
        let value = |at: f64| 1000.0 + low(at) + (TAU * 1.35 * at).cos();
        let found = rows(400 * PER_ROW + 1, value, None);
        assert_eq!(found.len(), 401);
        for (k, [at, instant, filtered]) in found.iter().enumerate() {
            assert_eq!(*at, k as f64);
            assert_eq!(*instant, value(*at));
            // Away from the ends, where the mirror image of a tone is another one.
            if (16..385).contains(&k) {
                let off = filtered - 1000.0 - low(*at);
                assert!(off.abs() < 2.0 * 7.2e-5, "row {k}: {off:.1e}");
            }
        }
    }

    #[test]
    fn straight_lines_stay_up_to_both_ends_and_constants_in_short_runs() {
        for [at, instant, filtered] in rows(60 * PER_ROW + 3, |at| 3.0 - 0.25 * at, None) {
            assert!((filtered - instant).abs() < 1e-12, "{at}");
        }
        for samples in [1, 2, 7, 5 * PER_ROW + 1] {
            let found = rows(samples, |_| 3.0, None);
            assert_eq!(found.len(), samples.div_ceil(PER_ROW));
            assert!(found.iter().all(|row| (row[2] - 3.0).abs() < 1e-12));
        }
    }

    #[test]
    fn a_run_that_goes_on_writes_the_same_bits() {
        let value = |at: f64| (7.0 * at * at).sin();
        let whole = rows(100 * PER_ROW, value, None);
        for stored_at in [1, 4, 83, 84, 85, 250] {
            assert_eq!(rows(100 * PER_ROW, value, Some(stored_at)), whole);
        }
    }

    #[test]
    fn rows_that_are_samples_are_given_at_once() {
        let mut filter = RowFilter::new(&columns(), 1).unwrap();
        assert_eq!(filter.columns(&columns()).len(), 2);
        let mut given = 0;
        for n in 0..3 {
            let mut take = |row: &[f64]| {
                assert_eq!(row, [f64::from(n), 2.0]);
                given += 1;
                Ok::<(), Infallible>(())
            };
            filter.add(&[f64::from(n), 2.0], &mut take).unwrap();
        }
        assert_eq!(given, 3);
    }
}
