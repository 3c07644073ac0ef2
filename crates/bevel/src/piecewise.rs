//! A smooth function of two variables on the square −1 … 1 as a polynomial on each of many cells: as exact as the
//! series that it is taken from, and several times as quick.
//!
//! On a cell f = Σ c_ij pⁱ qʲ, p and q from −1 to 1, interpolated at the zeros of Chebyshev's T₈ and T₁₀ (Trefethen,
//! Approximation Theory and Approximation Practice, chapters 2 to 4: the error of an interpolation falls with the power
//! of the cell's size that has one more than the degree). Cells are not fitted to each other: what jumps between them
//! is the error of the interpolation, which is that of rounding.

use crate::chebyshev::Chebyshev2;
use crate::jet::Jet;

/// Terms of a cell along the first and the second variable: flanks change faster from root to tip.
const ALONG: usize = 8;
const UP: usize = 10;
/// Cells along them.
const CELLS: [usize; 2] = [6, 20];

/// `[j][i]`: coefficients of pⁱ qʲ.
type Cell = [[f64; ALONG]; UP];

/// The function.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Piecewise2 {
    cells: Vec<Cell>,
}

/// The cell of a coordinate, of so many, and the place in it; beyond the ends those at the end.
fn place(x: f64, cells: usize) -> (usize, f64) {
    let along = 0.5 * (x + 1.0) * cells as f64;
    let cell = (along.max(0.0) as usize).min(cells - 1);
    (cell, 2.0 * (along - cell as f64) - 1.0)
}

/// Zeros of T_N.
fn zeros<const TERMS: usize>() -> [f64; TERMS] {
    std::array::from_fn(|k| (std::f64::consts::PI * (k as f64 + 0.5) / TERMS as f64).cos())
}

/// Coefficients of the powers of p from the values at the zeros: `[power][value]`.
fn powers_of_values<const TERMS: usize>() -> [[f64; TERMS]; TERMS] {
    // T_m by powers of p: T_(m+1) = 2 p T_m − T_(m−1).
    let mut by_powers = [[0.0; TERMS]; TERMS];
    (by_powers[0][0], by_powers[1][1]) = (1.0, 1.0);
    for m in 2..TERMS {
        for power in 0..TERMS {
            let raised = if power > 0 {
                2.0 * by_powers[m - 1][power - 1]
            } else {
                0.0
            };
            by_powers[m][power] = raised - by_powers[m - 2][power];
        }
    }
    let share = |m: usize| if m == 0 { 1.0 } else { 2.0 } / TERMS as f64;
    let at_zero = |m: usize, k: usize| {
        (std::f64::consts::PI * m as f64 * (k as f64 + 0.5) / TERMS as f64).cos()
    };
    std::array::from_fn(|power| {
        std::array::from_fn(|k| {
            let terms = (0..TERMS).map(|m| by_powers[m][power] * share(m) * at_zero(m, k));
            terms.sum()
        })
    })
}

impl Piecewise2 {
    /// From the values of a series.
    pub(crate) fn of(series: &Chebyshev2) -> Self {
        let (along, up) = (zeros::<ALONG>(), zeros::<UP>());
        let (of_along, of_up) = (powers_of_values::<ALONG>(), powers_of_values::<UP>());
        let middle = |cell: usize, cells: usize| (2 * cell + 1) as f64 / cells as f64 - 1.0;
        let numbers = (0..CELLS[0]).flat_map(|a| (0..CELLS[1]).map(move |b| [a, b]));
        let cells = numbers.map(|number| {
            let at = |k: usize, zero: f64| middle(number[k], CELLS[k]) + zero / CELLS[k] as f64;
            // Powers of p first, for each of the values along q.
            let rows: [[f64; ALONG]; UP] = up.map(|q| {
                let values = along.map(|p| series.value(at(0, p), at(1, q)));
                of_along.map(|weights| weights.iter().zip(&values).map(|(w, f)| w * f).sum())
            });
            of_up.map(|weights| {
                std::array::from_fn(|i| weights.iter().zip(&rows).map(|(w, row)| w * row[i]).sum())
            })
        });
        Self {
            cells: cells.collect(),
        }
    }

    /// Value and derivatives by x and y, by Horner's rule.
    pub(crate) fn jet(&self, x: f64, y: f64) -> Jet {
        let ((a, p), (b, q)) = (place(x, CELLS[0]), place(y, CELLS[1]));
        // Functions of p: f, ∂f/∂q and half of ∂²f/∂q².
        let (mut f, mut by_q, mut by_qq) = ([0.0; ALONG], [0.0; ALONG], [0.0; ALONG]);
        for row in self.cells[a * CELLS[1] + b].iter().rev() {
            for i in 0..ALONG {
                by_qq[i] = by_qq[i] * q + by_q[i];
                by_q[i] = by_q[i] * q + f[i];
                f[i] = f[i] * q + row[i];
            }
        }
        let (mut v, mut v_p, mut v_pp, mut v_q, mut v_pq, mut v_qq) =
            (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
        for i in (0..ALONG).rev() {
            v_pp = v_pp * p + v_p;
            v_p = v_p * p + v;
            v = v * p + f[i];
            v_pq = v_pq * p + v_q;
            v_q = v_q * p + by_q[i];
            v_qq = v_qq * p + by_qq[i];
        }
        let [per_x, per_y] = CELLS.map(|cells| cells as f64);
        Jet {
            v,
            d: [v_p * per_x, v_q * per_y],
            dd: [
                2.0 * v_pp * per_x * per_x,
                v_pq * per_x * per_y,
                2.0 * v_qq * per_y * per_y,
            ],
        }
    }
}
