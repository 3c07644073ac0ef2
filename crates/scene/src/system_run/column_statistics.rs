//! Mean, standard deviation and extremes of every column, as rows come.
//!
//! Sums of squared deviations by Welford's update, which does not cancel where the mean is large.
//! Source: B. P. Welford, Technometrics 4 (1962) 419-420.

/// Figures of one column.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Figures {
    /// Mean.
    pub mean: f64,
    /// Standard deviation: the RMS value about the mean.
    pub deviation: f64,
    /// Smallest value.
    pub least: f64,
    /// Largest value.
    pub largest: f64,
}

impl Figures {
    /// Of a series; not numbers without values.
    pub fn of(values: &[f64]) -> Self {
        let mut statistics = ColumnStatistics::new(1);
        values.iter().for_each(|value| statistics.add(&[*value]));
        statistics.figures()[0]
    }

    /// Largest amount.
    pub fn magnitude(&self) -> f64 {
        self.least.abs().max(self.largest.abs())
    }

    /// √(mean² + deviation²)
    pub fn rms(&self) -> f64 {
        self.mean.hypot(self.deviation)
    }

    /// Largest less smallest value.
    pub fn peak_to_peak(&self) -> f64 {
        self.largest - self.least
    }
}

/// Running figures of all columns of a row.
#[derive(Debug, Clone, PartialEq)]
pub struct ColumnStatistics {
    rows: f64,
    /// Mean, sum of squared deviations, least, largest of each column.
    columns: Vec<[f64; 4]>,
}

impl ColumnStatistics {
    /// No rows yet.
    pub fn new(columns: usize) -> Self {
        Self {
            rows: 0.0,
            columns: vec![[0.0, 0.0, f64::INFINITY, f64::NEG_INFINITY]; columns],
        }
    }

    /// Takes a row. Allocates nothing.
    pub fn add(&mut self, row: &[f64]) {
        self.rows += 1.0;
        for (column, &x) in self.columns.iter_mut().zip(row) {
            let [mean, squares, least, largest] = column;
            let before = x - *mean;
            *mean += before / self.rows;
            *squares += before * (x - *mean);
            *least = least.min(x);
            *largest = largest.max(x);
        }
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.columns.len()
    }

    /// Figures of each column; not a number without rows.
    pub fn figures(&self) -> Vec<Figures> {
        let empty = self.rows == 0.0;
        let of = |&[mean, squares, least, largest]: &[f64; 4]| Figures {
            mean: if empty { f64::NAN } else { mean },
            deviation: (squares / self.rows).sqrt(),
            least: if empty { f64::NAN } else { least },
            largest: if empty { f64::NAN } else { largest },
        };
        self.columns.iter().map(of).collect()
    }

    /// All numbers, for a checkpoint.
    pub fn save(&self) -> Vec<f64> {
        let mut numbers = vec![self.rows];
        numbers.extend(self.columns.iter().flatten());
        numbers
    }

    /// Takes what [`Self::save`] gave for as many columns.
    pub fn restore(&mut self, numbers: &[f64]) {
        if let Some((rows, columns)) = numbers.split_first() {
            self.rows = *rows;
            let (columns, _) = columns.as_chunks::<4>();
            self.columns.copy_from_slice(columns);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_those_of_the_definition_also_after_a_restart() {
        let xs: Vec<f64> = (0..100).map(|i| 1e9 + f64::from(i * i % 17)).collect();
        let mut statistics = ColumnStatistics::new(2);
        for (i, x) in xs.iter().enumerate() {
            statistics.add(&[*x, -1.0]);
            if i == 40 {
                let saved = statistics.save();
                statistics = ColumnStatistics::new(2);
                statistics.restore(&saved);
            }
        }
        let found = statistics.figures()[0];
        let small: Vec<f64> = xs.iter().map(|x| x - 1e9).collect();
        let mean = small.iter().sum::<f64>() / 100.0;
        let variance = small.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 100.0;
        assert!((found.mean - 1e9 - mean).abs() < 1e-6);
        assert!((found.deviation - variance.sqrt()).abs() < 1e-6);
        assert_eq!((found.least, found.largest), (1e9, 1e9 + 16.0));
        let constant = statistics.figures()[1];
        assert_eq!((constant.deviation, constant.rms()), (0.0, 1.0));
    }
}
