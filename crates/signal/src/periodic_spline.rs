//! The periodic interpolating cubic spline: twice continuously differentiable, on any increasing grid.
//!
//! Source: C. de Boor, A Practical Guide to Splines, ch. IV (second-derivative form); the cyclic tridiagonal system is
//! solved by the Sherman-Morrison formula.

/// A cubic spline s(x) with s(x + period) = s(x) through given points.
#[derive(Debug, Clone)]
pub(crate) struct PeriodicSpline {
    /// Increasing knots, all inside one period from the first.
    knots: Vec<f64>,
    values: Vec<f64>,
    /// Second derivative at each knot.
    curvatures: Vec<f64>,
    period: f64,
}

impl PeriodicSpline {
    /// The spline through `values` at `knots`.
    ///
    /// The caller has checked: at least four knots, strictly increasing, last knot < first knot + `period`, all finite.
    pub(crate) fn new(knots: Vec<f64>, values: Vec<f64>, period: f64) -> Self {
        let n = knots.len();
        let step = |i: usize| {
            if i + 1 < n {
                knots[i + 1] - knots[i]
            } else {
                knots[0] + period - knots[n - 1]
            }
        };
        let slope = |i: usize| (values[(i + 1) % n] - values[i]) / step(i);

        // h_{i-1} M_{i-1} + 2 (h_{i-1} + h_i) M_i + h_i M_{i+1} = 6 (slope_i - slope_{i-1}), indices modulo n.
        let before: Vec<f64> = (0..n).map(|i| step((i + n - 1) % n)).collect();
        let after: Vec<f64> = (0..n).map(step).collect();
        let diagonal: Vec<f64> = (0..n).map(|i| 2.0 * (before[i] + after[i])).collect();
        let right: Vec<f64> = (0..n)
            .map(|i| 6.0 * (slope(i) - slope((i + n - 1) % n)))
            .collect();
        let curvatures = solve_cyclic(&before, &diagonal, &after, &right);
        Self {
            knots,
            values,
            curvatures,
            period,
        }
    }

    /// s(x) for any finite x.
    pub(crate) fn value(&self, x: f64) -> f64 {
        let n = self.knots.len();
        let first = self.knots[0];
        // rem_euclid may round up to the period itself; the last interval takes that point.
        let x = first + (x - first).rem_euclid(self.period);
        let i = self.knots.partition_point(|&knot| knot <= x).max(1) - 1;
        let (j, right) = if i + 1 < n {
            (i + 1, self.knots[i + 1])
        } else {
            (0, first + self.period)
        };
        let h = right - self.knots[i];
        let a = (right - x) / h;
        let b = (x - self.knots[i]) / h;
        a * self.values[i]
            + b * self.values[j]
            + ((a * a * a - a) * self.curvatures[i] + (b * b * b - b) * self.curvatures[j]) * h * h
                / 6.0
    }
}

/// Solves the cyclic tridiagonal system `lower[i] x[i-1] + diagonal[i] x[i] + upper[i] x[i+1] = right[i]`.
///
/// The matrix of a periodic spline is strictly diagonally dominant, so no pivoting is needed.
fn solve_cyclic(lower: &[f64], diagonal: &[f64], upper: &[f64], right: &[f64]) -> Vec<f64> {
    let n = diagonal.len();
    let corner_top = lower[0];
    let corner_bottom = upper[n - 1];
    // A = T + u v^T with u = (gamma, 0, .., corner_bottom), v = (1, 0, .., corner_top / gamma).
    let gamma = -diagonal[0];
    let mut reduced = diagonal.to_vec();
    reduced[0] -= gamma;
    reduced[n - 1] -= corner_top * corner_bottom / gamma;
    let mut u = vec![0.0; n];
    u[0] = gamma;
    u[n - 1] = corner_bottom;

    let x = solve_tridiagonal(lower, &reduced, upper, right);
    let z = solve_tridiagonal(lower, &reduced, upper, &u);
    let ratio = corner_top / gamma;
    let factor = (x[0] + ratio * x[n - 1]) / (1.0 + z[0] + ratio * z[n - 1]);
    x.iter().zip(&z).map(|(x, z)| x - factor * z).collect()
}

/// The Thomas algorithm; `lower[0]` and `upper[n-1]` are not read.
fn solve_tridiagonal(lower: &[f64], diagonal: &[f64], upper: &[f64], right: &[f64]) -> Vec<f64> {
    let n = diagonal.len();
    let mut upper_scaled = vec![0.0; n];
    let mut x = vec![0.0; n];
    upper_scaled[0] = upper[0] / diagonal[0];
    x[0] = right[0] / diagonal[0];
    for i in 1..n {
        let pivot = diagonal[i] - lower[i] * upper_scaled[i - 1];
        upper_scaled[i] = upper[i] / pivot;
        x[i] = (right[i] - lower[i] * x[i - 1]) / pivot;
    }
    for i in (0..n - 1).rev() {
        x[i] -= upper_scaled[i] * x[i + 1];
    }
    x
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// A grid of one revolution whose steps vary by a factor of about three.
    fn uneven_grid(n: usize) -> Vec<f64> {
        (0..n)
            .map(|i| {
                let t = i as f64 / n as f64;
                TAU * (t + 0.07 * (TAU * t).sin() - 0.3)
            })
            .collect()
    }

    #[test]
    fn passes_through_its_points_in_every_period() {
        let knots = uneven_grid(17);
        let values: Vec<f64> = knots.iter().map(|x| (3.0 * x).cos() + x.sin()).collect();
        let spline = PeriodicSpline::new(knots.clone(), values.clone(), TAU);
        for (knot, value) in knots.iter().zip(&values) {
            for turn in [-2.0, 0.0, 5.0] {
                assert!((spline.value(knot + turn * TAU) - value).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn converges_with_the_fourth_power_of_the_step() {
        let error = |n: usize| {
            let knots = uneven_grid(n);
            let values = knots.iter().map(|x| (2.0 * x + 0.4).sin()).collect();
            let spline = PeriodicSpline::new(knots, values, TAU);
            (0..1000)
                .map(|i| i as f64 * TAU / 1000.0)
                .map(|x| (spline.value(x) - (2.0 * x + 0.4).sin()).abs())
                .fold(0.0, f64::max)
        };
        let rate = (error(40) / error(80)).log2();
        assert!((3.7..4.4).contains(&rate), "rate {rate}");
    }

    #[test]
    fn a_cubic_is_not_reproduced_by_a_wrong_period() {
        // Negative test: the rate above must not be an accident of the reference function.
        let knots = uneven_grid(80);
        let values: Vec<f64> = knots.iter().map(|x| (2.0 * x).sin()).collect();
        let spline = PeriodicSpline::new(knots, values, 1.1 * TAU);
        assert!((spline.value(10.0) - 20f64.sin()).abs() > 1e-3);
    }
}
