//! A function of two variables as a sum of products of Chebyshev polynomials on a square: smooth, with all derivatives.

use crate::jet::Jet;

/// Polynomials along the first and the second variable.
const ALONG: usize = 12;
const UP: usize = 20;

/// f(x, y) = Σ c_ij T_i(x) T_j(y) on −1 … 1.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Chebyshev2 {
    coefficients: [[f64; UP]; ALONG],
}

impl Chebyshev2 {
    /// Interpolates values at the zeros of the first polynomials left out, T_12 and T_20. `value` is asked row by row, y within x.
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
        Ok(Self { coefficients })
    }

    /// Value.
    pub(crate) fn value(&self, x: f64, y: f64) -> f64 {
        let [along, ..] = polynomials::<ALONG>(x);
        let [up, ..] = polynomials::<UP>(y);
        let rows = self.coefficients.iter().zip(along);
        rows.map(|(row, t)| t * dot(row, &up)).sum()
    }

    /// Value and derivatives by x and y.
    pub(crate) fn jet(&self, x: f64, y: f64) -> Jet {
        let [along, along_1, along_2] = polynomials::<ALONG>(x);
        let [up, up_1, up_2] = polynomials::<UP>(y);
        let mut jet = Jet::constant(0.0);
        for (i, row) in self.coefficients.iter().enumerate() {
            let of_up = dot(row, &up);
            let by_up = dot(row, &up_1);
            jet.v += along[i] * of_up;
            jet.d[0] += along_1[i] * of_up;
            jet.d[1] += along[i] * by_up;
            jet.dd[0] += along_2[i] * of_up;
            jet.dd[1] += along_1[i] * by_up;
            jet.dd[2] += along[i] * dot(row, &up_2);
        }
        jet
    }
}

fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// T_0 … T_(N−1) and their first and second derivatives: T_(i+1) = 2x T_i − T_(i−1).
fn polynomials<const N: usize>(x: f64) -> [[f64; N]; 3] {
    let [mut t, mut d, mut dd] = [[0.0; N]; 3];
    t[0] = 1.0;
    if N > 1 {
        t[1] = x;
        d[1] = 1.0;
    }
    for i in 2..N {
        t[i] = 2.0 * x * t[i - 1] - t[i - 2];
        d[i] = 2.0 * t[i - 1] + 2.0 * x * d[i - 1] - d[i - 2];
        dd[i] = 4.0 * d[i - 1] + 2.0 * x * dd[i - 1] - dd[i - 2];
    }
    [t, d, dd]
}
