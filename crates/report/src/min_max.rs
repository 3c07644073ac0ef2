//! Fewer points for a chart: of every bin the smallest and the largest value, in the order in which they come, so that
//! no peak is lost.

/// Least and largest of some values.
pub(crate) fn ends(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
        [low.min(value), high.max(value)]
    })
}

/// Bins of a chart.
const BINS: usize = 1500;

/// Abscissas for curves over `x`: two for every bin, or all where that is not fewer.
pub fn abscissas(x: &[f64]) -> Vec<f64> {
    let size = bin(x.len());
    if size <= 2 {
        return x.to_vec();
    }
    let of_bin = |bin: &[f64]| [bin[0], bin[bin.len() / 2]];
    x.chunks(size)
        .filter(|bin| bin.len() > 1)
        .flat_map(of_bin)
        .collect()
}

/// The values that belong to [`abscissas`].
pub fn values(y: &[f64]) -> Vec<f64> {
    let size = bin(y.len());
    if size <= 2 {
        return y.to_vec();
    }
    let of_bin = |bin: &[f64]| {
        let (mut least, mut largest) = (0, 0);
        for (i, value) in bin.iter().enumerate() {
            if *value < bin[least] {
                least = i;
            }
            if *value > bin[largest] {
                largest = i;
            }
        }
        [bin[least.min(largest)], bin[least.max(largest)]]
    };
    y.chunks(size)
        .filter(|bin| bin.len() > 1)
        .flat_map(of_bin)
        .collect()
}

fn bin(count: usize) -> usize {
    count.div_ceil(BINS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_single_peak_survives() {
        let x: Vec<f64> = (0..1_000_001).map(f64::from).collect();
        let mut y = vec![0.0; x.len()];
        (y[123_456], y[777_777]) = (5.0, -3.0);
        let (x, y) = (abscissas(&x), values(&y));
        assert_eq!(x.len(), y.len());
        assert!(x.len() <= 2 * BINS && x.windows(2).all(|w| w[1] > w[0]));
        assert!(y.contains(&5.0) && y.contains(&-3.0));
        let place = y.iter().position(|y| *y == 5.0).map(|i| x[i]);
        assert!(place.is_some_and(|x| (x - 123_456.0).abs() < 1_000.0));
    }

    #[test]
    fn short_curves_stay_as_they_are() {
        let x: Vec<f64> = (0..2_999).map(f64::from).collect();
        assert_eq!((abscissas(&x), values(&x)), (x.clone(), x));
    }
}
