//! How far the columns of a setting are off those of a reference.

use std::ops::Range;

use crate::study::{Figure, Wanted};

/// What the errors of columns are relative to.
pub(super) struct ColumnErrors {
    /// Of each column the columns among whose values in the reference the largest is what its error is relative to:
    /// its own, of a line of a spectrum all lines of the series that are judged. A line that is nothing beside another
    /// is not asked for digits of its own.
    beside: Vec<Vec<usize>>,
}

impl ColumnErrors {
    /// Of columns.
    pub(super) fn new(columns: &[Wanted]) -> Self {
        let is_line = |one: &Wanted| matches!(one.figure(), Some(Figure::Line(_)));
        let all = |of: &Wanted| {
            let like = |other: &Wanted| is_line(other) && other.column == of.column;
            (0..columns.len())
                .filter(|&k| like(&columns[k]))
                .collect::<Vec<_>>()
        };
        let beside = columns.iter().enumerate().map(|(k, one)| match one {
            line if is_line(line) => all(line),
            _ => vec![k],
        });
        Self {
            beside: beside.collect(),
        }
    }

    /// Places of a column's values, one for each torque, among those of all columns.
    fn places(&self, values: usize, column: usize) -> Range<usize> {
        let each = (values / self.beside.len().max(1)).max(1);
        column * each..(column + 1) * each
    }

    /// What an error of each value is relative to.
    pub(super) fn scales(&self, reference: &[f64]) -> Vec<f64> {
        let mut scales = Vec::with_capacity(reference.len());
        for (column, beside) in self.beside.iter().enumerate() {
            for (torque, place) in self.places(reference.len(), column).enumerate() {
                let others = (beside.iter())
                    .map(|&other| reference[self.places(reference.len(), other).start + torque]);
                scales.push(others.fold(reference[place].abs(), |most, x| most.max(x.abs())));
            }
        }
        scales
    }

    /// Largest error of each column over its torques, relative to what the reference has there. Where neither has a
    /// number, as a face load factor without a load, there is nothing to compare; where one of them has, the error is
    /// infinite.
    pub(super) fn of(&self, values: &[f64], reference: &[f64]) -> Vec<f64> {
        let scales = self.scales(reference);
        let error = |column: usize| {
            let places = self.places(reference.len(), column);
            // What is nothing in the reference has no relative error: all of it is one.
            let relative = |at: usize| match (values[at], reference[at], scales[at]) {
                (value, known, _) if !known.is_finite() && !value.is_finite() => 0.0,
                (value, known, _) if !known.is_finite() || !value.is_finite() => f64::INFINITY,
                (0.0, _, 0.0) => 0.0,
                (_, _, 0.0) => 1.0,
                (value, known, scale) => (value - known).abs() / scale,
            };
            places.map(relative).fold(0.0, f64::max)
        };
        (0..self.beside.len()).map(error).collect()
    }
}

/// The largest error of all columns.
pub(super) fn largest(errors: &[f64]) -> f64 {
    errors.iter().copied().fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn columns(names: &[&str]) -> ColumnErrors {
        let wanted: Vec<Wanted> = names.iter().map(|name| Wanted::of(name)).collect();
        ColumnErrors::new(&wanted)
    }

    #[test]
    fn errors_are_the_largest_over_the_torques() {
        let two = columns(&["a", "b"]);
        let reference = [10.0, -20.0, 1.0, 0.0];
        assert_eq!(two.of(&[11.0, -20.0, 1.0, 0.0], &reference), [0.1, 0.0]);
        // Of nothing every error is all.
        assert_eq!(two.of(&[10.0, -25.0, 1.0, 1e-9], &reference), [0.25, 1.0]);
    }

    /// Where a number stands against none, nothing is exact.
    #[test]
    fn a_missing_number_is_no_exact_one() {
        let gap = f64::NAN;
        let one = columns(&["a"]);
        let error = |value: f64, reference: f64| one.of(&[1.0, value], &[1.0, reference])[0];
        assert_eq!(error(gap, 2.0), f64::INFINITY);
        assert_eq!(error(2.0, gap), f64::INFINITY);
        assert_eq!(error(f64::INFINITY, 2.0), f64::INFINITY);
        assert_eq!(error(gap, gap), 0.0);
        assert_eq!(error(0.0, 2.0), 1.0);
        assert_eq!(largest(&[0.1, error(gap, 2.0)]), f64::INFINITY);
    }

    /// A line is judged beside the largest one of its series.
    #[test]
    fn a_small_line_is_judged_beside_a_large_one() {
        let four = columns(&["a:line-10Hz", "a:line-20Hz", "b:line-20Hz", "a:largest"]);
        let found = four.of(&[11.0, 2.0, 2.0, 2.0], &[10.0, 1.0, 1.0, 1.0]);
        assert_eq!(found, [0.1, 0.1, 1.0, 1.0]);
    }
}
