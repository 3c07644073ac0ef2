//! Lemke's complementary pivoting for `w = M z + q ≥ 0, z ≥ 0, wᵀz = 0` on a dense tableau.
//!
//! C. E. Lemke, Management Science 11 (1965) 681-689; Cottle, Pang, Stone, The Linear Complementarity Problem
//! (1992), algorithm 4.4.5. Written from the book and sharing nothing with the solver under test.

/// Solves the problem; `None` on a secondary ray (for a positive semi-definite `M`: no solution) or too many pivots.
pub fn lemke(m: &[f64], q: &[f64]) -> Option<Vec<f64>> {
    let n = q.len();
    if q.iter().all(|&v| v >= 0.0) {
        return Some(vec![0.0; n]);
    }
    // Equilibrate: z = D z', w = D⁻¹ w' with D = diag(M)^-1/2 keeps complementarity and gives a unit diagonal.
    let d: Vec<f64> = (0..n)
        .map(|i| {
            if m[i * n + i] > 0.0 {
                m[i * n + i].sqrt().recip()
            } else {
                1.0
            }
        })
        .collect();
    // Columns: w_0..w_n, z_0..z_n, artificial, right-hand side. Rows: I w − M z − e z0 = q.
    let width = 2 * n + 2;
    let mut t = vec![0.0; n * width];
    for i in 0..n {
        t[i * width + i] = 1.0;
        for j in 0..n {
            t[i * width + n + j] = -m[i * n + j] * d[i] * d[j];
        }
        t[i * width + 2 * n] = -1.0;
        t[i * width + 2 * n + 1] = q[i] * d[i];
    }
    let mut basis: Vec<usize> = (0..n).collect();
    let mut row = (0..n).min_by(|&a, &b| (q[a] * d[a]).total_cmp(&(q[b] * d[b])))?;
    let mut entering = 2 * n;
    for _ in 0..50 * (n + 1) {
        pivot(&mut t, width, n, row, entering);
        let leaving = std::mem::replace(&mut basis[row], entering);
        if leaving == 2 * n {
            let mut z = vec![0.0; n];
            for (i, &b) in basis.iter().enumerate() {
                if (n..2 * n).contains(&b) {
                    z[b - n] = t[i * width + 2 * n + 1].max(0.0) * d[b - n];
                }
            }
            return Some(z);
        }
        entering = if leaving < n {
            leaving + n
        } else {
            leaving - n
        };
        row = ratio_test(&t, width, n, entering, &basis)?;
    }
    None
}

fn ratio_test(
    t: &[f64],
    width: usize,
    n: usize,
    entering: usize,
    basis: &[usize],
) -> Option<usize> {
    let mut best: Option<(usize, f64)> = None;
    for i in 0..n {
        let slope = t[i * width + entering];
        if slope > 1e-13 {
            let ratio = t[i * width + width - 1] / slope;
            let better = match best {
                None => true,
                // Ties let the artificial variable leave.
                Some((_, r)) => ratio < r || (ratio == r && basis[i] == 2 * n),
            };
            if better {
                best = Some((i, ratio));
            }
        }
    }
    best.map(|(i, _)| i)
}

fn pivot(t: &mut [f64], width: usize, n: usize, row: usize, column: usize) {
    let value = t[row * width + column];
    for k in 0..width {
        t[row * width + k] /= value;
    }
    for i in 0..n {
        if i != row {
            let factor = t[i * width + column];
            if factor != 0.0 {
                for k in 0..width {
                    t[i * width + k] -= factor * t[row * width + k];
                }
            }
        }
    }
}
