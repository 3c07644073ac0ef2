//! The periodic monotone cubic: between two points it stays between their values, on any increasing grid.
//!
//! Source: F. N. Fritsch and J. Butland, A method for constructing local monotone piecewise cubic interpolants, SIAM
//! J. Sci. Stat. Comput. 5 (1984): the slope at a point is the weighted harmonic mean of the chords beside it, and 0
//! where they differ in sign.

/// A piecewise cubic s(x) with s(x + period) = s(x) through given points, with continuous slope.
#[derive(Debug, Clone)]
pub(crate) struct BoundedCubic {
    /// Increasing knots, all inside one period from the first.
    knots: Vec<f64>,
    values: Vec<f64>,
    /// Slope at each knot.
    slopes: Vec<f64>,
    period: f64,
}

impl BoundedCubic {
    /// The cubic through `values` at `knots`.
    ///
    /// The caller has checked: at least two knots, strictly increasing, last knot < first knot + `period`, all finite.
    pub(crate) fn new(knots: Vec<f64>, values: Vec<f64>, period: f64) -> Self {
        let n = knots.len();
        let step = |i: usize| match knots.get(i + 1) {
            Some(next) => next - knots[i],
            None => knots[0] + period - knots[i],
        };
        let slope_at = |i: usize| {
            let before = (i + n - 1) % n;
            let [h0, h1] = [step(before), step(i)];
            let chord = |k: usize, h: f64| (values[(k + 1) % n] - values[k]) / h;
            let [s0, s1] = [chord(before, h0), chord(i, h1)];
            if s0 * s1 > 0.0 {
                3.0 * (h0 + h1) / ((2.0 * h1 + h0) / s0 + (h1 + 2.0 * h0) / s1)
            } else {
                0.0
            }
        };
        let slopes = (0..n).map(slope_at).collect();
        Self {
            knots,
            values,
            slopes,
            period,
        }
    }

    /// s(x) for any finite x.
    pub(crate) fn value(&self, x: f64) -> f64 {
        let first = self.knots[0];
        // rem_euclid may round up to the period itself; the last interval takes that point.
        let x = first + (x - first).rem_euclid(self.period);
        let i = self.knots.partition_point(|&knot| knot <= x).max(1) - 1;
        let (j, right) = match self.knots.get(i + 1) {
            Some(&next) => (i + 1, next),
            None => (0, first + self.period),
        };
        let h = right - self.knots[i];
        let b = (x - self.knots[i]) / h;
        let a = 1.0 - b;
        a * a * (1.0 + 2.0 * b) * self.values[i]
            + b * b * (1.0 + 2.0 * a) * self.values[j]
            + a * b * h * (a * self.slopes[i] - b * self.slopes[j])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn passes_through_its_points_and_leaves_no_interval() {
        // Steps from 0.01 to 0.6, values without any order.
        let knots: Vec<f64> = (0..20)
            .map(|i| 0.3 * f64::from(i) + if i % 3 == 1 { -0.29 } else { 0.0 })
            .collect();
        let values: Vec<f64> = (0..20).map(|i| f64::from(7 * i % 11) - 4.0).collect();
        let cubic = BoundedCubic::new(knots.clone(), values.clone(), TAU);
        for i in 0..20 {
            let right = *knots.get(i + 1).unwrap_or(&(knots[0] + TAU));
            let [v0, v1] = [values[i], values[(i + 1) % 20]];
            for turn in [-2.0, 0.0, 5.0] {
                assert!((cubic.value(knots[i] + turn * TAU) - v0).abs() < 1e-9);
            }
            for k in 0..=50 {
                let v = cubic.value(knots[i] + (right - knots[i]) * f64::from(k) / 50.0);
                assert!(v >= v0.min(v1) - 1e-9 && v <= v0.max(v1) + 1e-9);
            }
        }
    }

    /// Between two points beside a crest it is cut off by 1 − cos(π/p) with p points a period.
    #[test]
    fn a_smooth_signal_is_met_but_for_its_crests() {
        for p in [12, 40] {
            let knots: Vec<f64> = (0..2 * p)
                .map(|i| TAU * f64::from(i) / f64::from(2 * p))
                .collect();
            let mut worst = 0.0f64;
            for k in 0..40 {
                let signal = |x: f64| (2.0 * x + TAU * f64::from(k) / 80.0).sin();
                let values = knots.iter().map(|x| signal(*x)).collect();
                let cubic = BoundedCubic::new(knots.clone(), values, TAU);
                let places = (0..2000).map(|i| TAU * f64::from(i) / 2000.0);
                let off = places.map(|x| (cubic.value(x) - signal(x)).abs());
                worst = off.fold(worst, f64::max);
            }
            let cut_off = 1.0 - (0.5 * TAU / f64::from(p)).cos();
            assert!(
                (worst / cut_off - 1.0).abs() < 0.1,
                "{p}: {worst} {cut_off}"
            );
        }
    }
}
