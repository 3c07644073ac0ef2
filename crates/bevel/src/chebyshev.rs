//! A function of two variables as a sum of products of Chebyshev polynomials on a square: smooth, with all derivatives.

use crate::jet::Jet;

/// Polynomials along the first and the second variable.
pub(crate) const ALONG: usize = 12;
pub(crate) const UP: usize = 20;

/// Coefficients below are rounding of the values that were interpolated, and left out (of angles: 1e-16 m on a gear).
const ROUNDING: f64 = 1e-15;

/// f(x, y) = Σ c_ij T_i(x) T_j(y) on −1 … 1.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Chebyshev2 {
    coefficients: [[f64; UP]; ALONG],
    /// Coefficients of each row up to the last one above rounding.
    used: [usize; ALONG],
}

impl Chebyshev2 {
    /// Interpolates values at the zeros of the first polynomials left out, T_12 and T_20. `value` is asked row by row,
    /// y within x.
    pub(crate) fn interpolate<E>(
        mut value: impl FnMut(f64, f64) -> Result<f64, E>,
    ) -> Result<Self, E> {
        let zero = |k: usize, n: usize| (std::f64::consts::PI * (k as f64 + 0.5) / n as f64).cos();
        let mut values = [[0.0; UP]; ALONG];
        for (k, row) in values.iter_mut().enumerate() {
            for (l, place) in row.iter_mut().enumerate() {
                *place = value(zero(k, ALONG), zero(l, UP))?;
            }
        }
        // T_i at the zeros is cos(i ϑ); the polynomials are orthogonal over them.
        let weight = |i: usize, k: usize, n: usize| {
            let share = if i == 0 { 1.0 } else { 2.0 } / n as f64;
            share * (std::f64::consts::PI * i as f64 * (k as f64 + 0.5) / n as f64).cos()
        };
        let mut coefficients = [[0.0; UP]; ALONG];
        for (i, row) in coefficients.iter_mut().enumerate() {
            for (j, place) in row.iter_mut().enumerate() {
                for (k, line) in values.iter().enumerate() {
                    let of_line: f64 = (0..UP).map(|l| weight(j, l, UP) * line[l]).sum();
                    *place += weight(i, k, ALONG) * of_line;
                }
            }
        }
        Ok(Self::new(coefficients))
    }

    /// With given coefficients c_ij.
    pub(crate) fn new(coefficients: [[f64; UP]; ALONG]) -> Self {
        let used = coefficients.map(|row| {
            let last = row.iter().rposition(|c| c.abs() > ROUNDING);
            last.map_or(0, |last| last + 1)
        });
        Self { coefficients, used }
    }

    /// Largest coefficient of the last two polynomials along the second variable: of the size of what is left out.
    pub(crate) fn last_terms(&self) -> f64 {
        let last = self.coefficients.iter().flat_map(|row| &row[UP - 2..]);
        last.fold(0.0, |most, c| most.max(c.abs()))
    }

    /// Value.
    pub(crate) fn value(&self, x: f64, y: f64) -> f64 {
        self.jet(x, y).v
    }

    /// Value and derivatives by x and y.
    pub(crate) fn jet(&self, x: f64, y: f64) -> Jet {
        let along = polynomials::<ALONG>(x);
        let up = polynomials::<UP>(y);
        let mut jet = Jet::constant(0.0);
        for ((row, used), [t, d, dd]) in self.coefficients.iter().zip(self.used).zip(along) {
            // The row's function of y and its derivatives, side by side for the processor's vectors.
            let mut of_up = [0.0; 3];
            for (c, values) in row.iter().zip(&up).take(used) {
                for (sum, value) in of_up.iter_mut().zip(values) {
                    *sum += c * value;
                }
            }
            let [f, by_y, by_yy] = of_up;
            jet.v += t * f;
            jet.d[0] += d * f;
            jet.d[1] += t * by_y;
            jet.dd[0] += dd * f;
            jet.dd[1] += d * by_y;
            jet.dd[2] += t * by_yy;
        }
        jet
    }
}

/// T_0 … T_(N−1), each with its first and second derivative: T_(i+1) = 2x T_i − T_(i−1).
pub(crate) fn polynomials<const N: usize>(x: f64) -> [[f64; 3]; N] {
    let mut list = [[0.0; 3]; N];
    list[0] = [1.0, 0.0, 0.0];
    list[1] = [x, 1.0, 0.0];
    for i in 2..N {
        let ([t, d, dd], [before, before_d, before_dd]) = (list[i - 1], list[i - 2]);
        list[i] = [
            2.0 * x * t - before,
            2.0 * t + 2.0 * x * d - before_d,
            4.0 * d + 2.0 * x * dd - before_dd,
        ];
    }
    list
}
