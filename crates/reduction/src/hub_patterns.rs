//! C_hub of a body that does not repeat, kept by the patterns that a tooth passes on to its body.
//!
//! Loads on a tooth reach the body through the tooth's foot only. With T what stays inside the tooth, the same on every tooth,
//!
//! ```text
//! C_hub(a, b) = δ_ab T + B_ab ≈ δ_ab T + V (Vᵀ B_ab V) Vᵀ,        V orthonormal: loads × patterns
//! ```
//!
//! Where a load stands on the flank is felt below the tooth less and less, the finer the detail (Saint-Venant). V are the left singular
//! vectors of the blocks of some teeth with themselves and their neighbours, where detail is felt most. Of the wheel with 47 teeth and six
//! holes 198 loads a tooth leave some 75 patterns. All blocks are compared with what is kept of them.

use faer::{Mat, MatRef};
use gearmesh_model::HubPatterns;
use rayon::prelude::*;

/// Largest difference of an entry over the largest entry. Far below any mesh error, and below what single precision would leave out (6e-8).
const ALLOWED: f64 = 1e-8;
/// The first choice: singular values above this share of the largest.
const FIRST_CHOICE: f64 = 1e-9;
/// Patterns that are added where that is not enough.
const MORE: usize = 10;
/// Teeth whose blocks give the patterns, evenly round the gear.
const SAMPLED_TEETH: usize = 8;

/// Patterns of C_hub, given as `[loaded tooth][load][tooth][response]` over all teeth, and the largest entry that they leave out, over the largest
/// of all; none where that takes more patterns than there are loads. `inside`: T, loads × loads (m/N).
pub fn by_patterns(rows: &[f64], inside: &Mat<f64>) -> Option<(HubPatterns, f64)> {
    let n = inside.nrows();
    let teeth = (rows.len() / (n * n)).isqrt();
    let body = |a: usize, b: usize| {
        Mat::from_fn(n, n, |l, m| {
            let value = rows[((a * n + l) * teeth + b) * n + m];
            if a == b {
                value - inside[(l, m)]
            } else {
                value
            }
        })
    };
    let sampled: Vec<(usize, usize)> = (0..SAMPLED_TEETH.min(teeth))
        .map(|k| k * teeth / SAMPLED_TEETH.min(teeth))
        .flat_map(|a| [0, 1, 2, teeth - 1].map(|apart| (a, (a + apart) % teeth)))
        .collect();
    let mut stack = Mat::<f64>::zeros(n, n * sampled.len());
    for (k, &(a, b)) in sampled.iter().enumerate() {
        stack.as_mut().subcols_mut(k * n, n).copy_from(body(a, b));
    }
    let svd = stack.thin_svd().ok()?;
    let sizes = svd.S().column_vector();
    let mut count = (0..n)
        .take_while(|&k| sizes[k] > FIRST_CHOICE * sizes[0])
        .count();
    let largest = rows
        .iter()
        .fold(0.0_f64, |most, value| most.max(value.abs()));
    loop {
        if count > n {
            return None;
        }
        let shares = svd.U().subcols(0, count);
        let (between, left_out) = kept(&body, teeth, shares);
        let left_out = left_out / largest;
        if left_out <= ALLOWED {
            let patterns = HubPatterns {
                count,
                own_tooth: (0..n * n).map(|k| inside[(k / n, k % n)]).collect(),
                shares: (0..n * count)
                    .map(|k| shares[(k / count, k % count)])
                    .collect(),
                body: lower_triangle(&between, teeth, count),
            };
            return Some((patterns, left_out));
        }
        count += MORE;
    }
}

/// Vᵀ B_ab V for b up to a, tooth after tooth, and the largest entry of B − V Vᵀ B V Vᵀ (m/N).
fn kept(
    body: &(impl Fn(usize, usize) -> Mat<f64> + Sync),
    teeth: usize,
    shares: MatRef<'_, f64>,
) -> (Vec<Mat<f64>>, f64) {
    let pairs: Vec<(usize, usize)> = (0..teeth)
        .flat_map(|a| (0..=a).map(move |b| (a, b)))
        .collect();
    let blocks: Vec<(Mat<f64>, f64)> = pairs
        .par_iter()
        .map(|&(a, b)| {
            let whole = body(a, b);
            let between = shares.transpose() * &whole * shares;
            let back = shares * &between * shares.transpose();
            let mut most = 0.0_f64;
            for l in 0..whole.nrows() {
                for m in 0..whole.ncols() {
                    most = most.max((whole[(l, m)] - back[(l, m)]).abs());
                }
            }
            (between, most)
        })
        .collect();
    let left_out = blocks.iter().fold(0.0_f64, |most, (_, own)| most.max(*own));
    (
        blocks.into_iter().map(|(between, _)| between).collect(),
        left_out,
    )
}

/// Rows over teeth and their patterns, each up to its diagonal.
fn lower_triangle(blocks: &[Mat<f64>], teeth: usize, count: usize) -> Vec<f64> {
    let all = teeth * count;
    let mut triangle = Vec::with_capacity(all * (all + 1) / 2);
    for a in 0..teeth {
        for p in 0..count {
            for b in 0..=a {
                let block = &blocks[a * (a + 1) / 2 + b];
                let most = if a == b { p + 1 } else { count };
                triangle.extend((0..most).map(|q| block[(p, q)]));
            }
        }
    }
    triangle
}
