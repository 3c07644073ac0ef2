//! Where a condition ends, by halving.

/// Halves an interval so many times: the condition holds at its first end, not at its second one.
pub(crate) fn halved(
    [mut low, mut high]: [f64; 2],
    times: usize,
    holds: impl Fn(f64) -> bool,
) -> [f64; 2] {
    for _ in 0..times {
        let middle = 0.5 * (low + high);
        if holds(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    [low, high]
}
