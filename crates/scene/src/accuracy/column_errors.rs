//! How far the columns of a setting are off those of a reference.

/// Largest error of each column over its torques, relative to what the reference has there. Where neither has a number,
/// as a face load factor without a load, there is nothing to compare; where one of them has, the error is infinite.
pub(super) fn errors(values: &[f64], reference: &[f64], columns: usize) -> Vec<f64> {
    let each = reference.len() / columns.max(1);
    let chunks = values
        .chunks(each.max(1))
        .zip(reference.chunks(each.max(1)));
    let error = |(values, reference): (&[f64], &[f64])| {
        let pairs = values.iter().zip(reference);
        // What is nothing in the reference has no relative error: all of it is one.
        let relative = |(value, reference): (&f64, &f64)| match *reference {
            known if !known.is_finite() && !value.is_finite() => 0.0,
            known if !known.is_finite() || !value.is_finite() => f64::INFINITY,
            0.0 if *value == 0.0 => 0.0,
            0.0 => 1.0,
            known => (value - known).abs() / known.abs(),
        };
        pairs.map(relative).fold(0.0, f64::max)
    };
    chunks.map(error).collect()
}

/// The largest error of all columns.
pub(super) fn largest(errors: &[f64]) -> f64 {
    errors.iter().copied().fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where a number stands against none, nothing is exact.
    #[test]
    fn a_missing_number_is_no_exact_one() {
        let gap = f64::NAN;
        let error = |value: f64, reference: f64| errors(&[1.0, value], &[1.0, reference], 1)[0];
        assert_eq!(error(gap, 2.0), f64::INFINITY);
        assert_eq!(error(2.0, gap), f64::INFINITY);
        assert_eq!(error(f64::INFINITY, 2.0), f64::INFINITY);
        assert_eq!(error(gap, gap), 0.0);
        assert_eq!(error(0.0, 2.0), 1.0);
        assert_eq!(largest(&[0.1, error(gap, 2.0)]), f64::INFINITY);
    }
}
