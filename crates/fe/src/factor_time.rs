//! How long a factorisation will take, told before it starts.
//!
//! The number of operations is known exactly from the pattern ([`crate::SymbolicFactor::flops`]); how many of them this
//! machine does in a second is measured once, on a dense matrix of the size of a large supernode, whose rate the sparse
//! factorisation of a large solid comes near: 6.5e11 operations took 13 s where 20 s were expected (two threads beside
//! other work, 2026-11-27). It is an estimate for the person who waits, never an input of a result.

use faer::linalg::solvers::Llt;
use faer::{Mat, Side};
use std::sync::OnceLock;
use std::time::Instant;

/// Rows of the dense matrix that is timed: some 100 ms of work.
const ROWS: usize = 2048;
/// Below this number of operations, a second or two, a factorisation is over before anyone could read the estimate.
const NOT_WORTH_A_TRIAL: f64 = 5e10;

/// Expected wall time (s) of a factorisation of `flops` multiplications and additions on all threads; zero for small
/// ones.
pub(crate) fn expected_seconds(flops: f64) -> f64 {
    if flops < NOT_WORTH_A_TRIAL {
        return 0.0;
    }
    static RATE: OnceLock<f64> = OnceLock::new();
    flops / RATE.get_or_init(dense_rate)
}

/// Operations per second of the dense Cholesky factorisation, the better of two trials: the first one warms up.
fn dense_rate() -> f64 {
    let a = Mat::from_fn(ROWS, ROWS, |i, j| {
        if i == j {
            ROWS as f64
        } else {
            1.0 / (1.0 + i.abs_diff(j) as f64)
        }
    });
    let seconds = (0..2)
        .map(|_| {
            let start = Instant::now();
            std::hint::black_box(Llt::new(a.as_ref(), Side::Lower).is_ok());
            start.elapsed().as_secs_f64()
        })
        .fold(f64::INFINITY, f64::min);
    (ROWS as f64).powi(3) / 3.0 / seconds.max(1e-6)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_ones_take_no_time_and_twice_the_work_takes_twice_as_long() {
        assert_eq!(expected_seconds(1e9), 0.0);
        let (one, two) = (expected_seconds(1e11), expected_seconds(2e11));
        assert!(one > 0.0 && one.is_finite());
        assert!((two / one - 2.0).abs() < 1e-12);
    }
}
