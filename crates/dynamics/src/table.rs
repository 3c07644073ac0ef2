//! A function of time from a table: linear, or a cubic that keeps the table's monotone pieces monotone.

use crate::derivatives::Derivatives;
use crate::error::DynamicsError;

/// How a [`Table`] goes from point to point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Interpolation {
    /// Straight lines; the rate jumps at the points.
    Linear,
    /// Cubic Hermite pieces with the slopes of Fritsch and Butland (weighted harmonic mean of the neighbouring slopes):
    /// no overshoot, continuous rate. Source: SIAM J. Sci. Stat. Comput. 5 (1984) 300-304.
    MonotoneCubic,
}

/// Points (t, y) with increasing t; the end values are held outside.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    times_s: Vec<f64>,
    values: Vec<f64>,
    /// Slope at each point, at both ends of a piece equal to the chord for linear tables.
    slopes: Option<Vec<f64>>,
    /// ∫ from the first point to each point.
    integrals: Vec<f64>,
}

impl Table {
    /// A table of at least two points.
    ///
    /// # Errors
    /// [`DynamicsError::Table`] names the table and the first row where the time does not increase, a number is not
    /// finite or the columns differ in length.
    pub fn new(
        name: &str,
        times_s: Vec<f64>,
        values: Vec<f64>,
        interpolation: Interpolation,
    ) -> Result<Self, DynamicsError> {
        let fault = |row: usize, what: &'static str| {
            Err(DynamicsError::Table {
                name: name.to_owned(),
                row,
                time_s: times_s.get(row).copied().unwrap_or(f64::NAN),
                what,
            })
        };
        if times_s.len() != values.len() || times_s.len() < 2 {
            return fault(
                times_s.len().min(values.len()),
                "needs at least two rows, each with a time and a value",
            );
        }
        for row in 0..times_s.len() {
            if !(times_s[row].is_finite() && values[row].is_finite()) {
                return fault(row, "has a number that is not finite");
            }
            if row > 0 && times_s[row] <= times_s[row - 1] {
                return fault(row, "does not increase in time");
            }
        }
        let slopes = match interpolation {
            Interpolation::Linear => None,
            Interpolation::MonotoneCubic => Some(monotone_slopes(&times_s, &values)),
        };
        let mut table = Self {
            integrals: vec![0.0; times_s.len()],
            times_s,
            values,
            slopes,
        };
        for i in 1..table.times_s.len() {
            table.integrals[i] = table.integrals[i - 1] + table.piece_integral(i - 1, 1.0);
        }
        Ok(table)
    }

    /// Value and derivatives at a time.
    #[must_use]
    pub fn at(&self, time_s: f64) -> Derivatives {
        let last = self.times_s.len() - 1;
        if time_s < self.times_s[0] || time_s >= self.times_s[last] {
            let end = if time_s < self.times_s[0] { 0 } else { last };
            return Derivatives {
                value: self.values[end],
                ..Derivatives::default()
            };
        }
        let i = self.piece(time_s);
        let h = self.times_s[i + 1] - self.times_s[i];
        let s = (time_s - self.times_s[i]) / h;
        let [c0, c1, c2, c3] = self.coefficients(i);
        Derivatives {
            value: c0 + s * (c1 + s * (c2 + s * c3)),
            rate: (c1 + s * (2.0 * c2 + 3.0 * s * c3)) / h,
            acceleration: (2.0 * c2 + 6.0 * s * c3) / (h * h),
        }
    }

    /// ∫ from the first point to the time.
    #[must_use]
    pub fn integral(&self, time_s: f64) -> f64 {
        let last = self.times_s.len() - 1;
        if time_s < self.times_s[0] {
            return (time_s - self.times_s[0]) * self.values[0];
        }
        if time_s >= self.times_s[last] {
            return self.integrals[last] + (time_s - self.times_s[last]) * self.values[last];
        }
        let i = self.piece(time_s);
        let s = (time_s - self.times_s[i]) / (self.times_s[i + 1] - self.times_s[i]);
        self.integrals[i] + self.piece_integral(i, s)
    }

    fn piece(&self, time_s: f64) -> usize {
        let after = self.times_s.partition_point(|&t| t <= time_s);
        (after - 1).min(self.times_s.len() - 2)
    }

    /// Polynomial of piece i in s = 0…1.
    fn coefficients(&self, i: usize) -> [f64; 4] {
        let h = self.times_s[i + 1] - self.times_s[i];
        let rise = self.values[i + 1] - self.values[i];
        match &self.slopes {
            None => [self.values[i], rise, 0.0, 0.0],
            Some(slopes) => {
                let (a, b) = (h * slopes[i], h * slopes[i + 1]);
                [
                    self.values[i],
                    a,
                    3.0 * rise - 2.0 * a - b,
                    a + b - 2.0 * rise,
                ]
            }
        }
    }

    fn piece_integral(&self, i: usize, s: f64) -> f64 {
        let h = self.times_s[i + 1] - self.times_s[i];
        let [c0, c1, c2, c3] = self.coefficients(i);
        h * s * (c0 + s * (c1 / 2.0 + s * (c2 / 3.0 + s * c3 / 4.0)))
    }
}

fn monotone_slopes(t: &[f64], y: &[f64]) -> Vec<f64> {
    let chord = |i: usize| (y[i + 1] - y[i]) / (t[i + 1] - t[i]);
    let last = t.len() - 1;
    (0..=last)
        .map(|i| {
            if i == 0 {
                return chord(0);
            }
            if i == last {
                return chord(last - 1);
            }
            let (left, right) = (chord(i - 1), chord(i));
            if left * right <= 0.0 {
                return 0.0;
            }
            let (h0, h1) = (t[i] - t[i - 1], t[i + 1] - t[i]);
            let (w0, w1) = (2.0 * h1 + h0, h1 + 2.0 * h0);
            (w0 + w1) / (w0 / left + w1 / right)
        })
        .collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn monotone_cubic_does_not_overshoot() {
        let times = vec![0.0, 1.0, 1.1, 4.0, 5.0];
        let values = vec![0.0, 0.1, 5.0, 5.2, 9.0];
        let table = Table::new(
            "t",
            times.clone(),
            values.clone(),
            Interpolation::MonotoneCubic,
        )
        .unwrap();
        for (t, y) in times.iter().zip(&values) {
            assert!((table.at(*t).value - y).abs() < 1e-14);
        }
        let samples: Vec<f64> = (0..=500)
            .map(|k| table.at(0.01 * f64::from(k)).value)
            .collect();
        assert!(samples.windows(2).all(|pair| pair[1] >= pair[0]));
    }

    #[test]
    fn a_table_that_does_not_increase_is_refused_by_row() {
        let refused = Table::new(
            "load",
            vec![0.0, 1.0, 1.0],
            vec![0.0; 3],
            Interpolation::Linear,
        );
        let message = refused.unwrap_err().to_string();
        assert!(
            message.contains("load") && message.contains("row 2"),
            "{message}"
        );
        assert!(Table::new("load", vec![0.0], vec![0.0], Interpolation::Linear).is_err());
        assert!(
            Table::new(
                "load",
                vec![0.0, f64::NAN],
                vec![0.0; 2],
                Interpolation::Linear
            )
            .is_err()
        );
    }
}
