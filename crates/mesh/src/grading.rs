//! Positions along an edge whose spacing follows a wanted size.

/// How many pieces an edge may have.
#[derive(Debug, Clone, Copy)]
pub struct Pieces {
    /// At least this many.
    pub least: usize,
    /// Only an even number.
    pub even: bool,
}

impl Pieces {
    /// So many or more.
    pub const fn at_least(least: usize) -> Self {
        Self { least, even: false }
    }

    /// An even number of them.
    pub const EVEN: Self = Self {
        least: 2,
        even: true,
    };
}

/// Positions from `from` to `to` whose spacing follows `size(position)`.
pub fn graded(from: f64, to: f64, size: impl Fn(f64) -> f64, pieces: Pieces) -> Vec<f64> {
    let samples = 400;
    let step = (to - from) / samples as f64;
    let mut density = vec![0.0];
    for k in 0..samples {
        let last = density[k];
        density.push(last + step.abs() / size(from + (k as f64 + 0.5) * step));
    }
    let total = density[samples];
    let n = (total.ceil() as usize).max(pieces.least);
    let n = if pieces.even {
        n.next_multiple_of(2)
    } else {
        n
    };
    (0..=n)
        .map(|k| {
            if k == 0 || k == n {
                return if k == 0 { from } else { to };
            }
            let wanted = total * k as f64 / n as f64;
            let i = density.partition_point(|d| *d < wanted).clamp(1, samples);
            let w = (wanted - density[i - 1]) / (density[i] - density[i - 1]);
            from + step * (i as f64 - 1.0 + w)
        })
        .collect()
}
