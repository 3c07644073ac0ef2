//! Where a condition ends, by halving, or where a function crosses zero, by secants.

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

/// Zero of a function that has one sign at the first end and the other at the second one, to within `rounding` of its
/// value: regula falsi that halves the value of an end which stays (Dowell and Jarratt, A modified regula falsi method,
/// BIT 11 (1971): the Illinois algorithm).
pub(crate) fn crossing(
    [mut other, mut last]: [f64; 2],
    rounding: f64,
    function: impl Fn(f64) -> f64,
) -> f64 {
    let (mut at_other, mut at_last) = (function(other), function(last));
    // Some ten are enough; the bound ends what rounding would keep going.
    for _ in 0..100 {
        let next = (other * at_last - last * at_other) / (at_last - at_other);
        let found = function(next);
        if found.abs() <= rounding || found.is_nan() {
            return next;
        }
        if (found < 0.0) == (at_last < 0.0) {
            at_other *= 0.5;
        } else {
            (other, at_other) = (last, at_last);
        }
        (last, at_last) = (next, found);
    }
    last
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeros_are_found_with_few_calls() {
        let calls = std::cell::Cell::new(0);
        // As a fillet's radius begins: level at one end.
        let function = |x: f64| {
            calls.set(calls.get() + 1);
            x * x * (1.0 + 0.3 * x) - 0.01
        };
        for ends in [[0.0, 1.0], [1.0, 0.0]] {
            let found = crossing(ends, 1e-15, function);
            assert!(function(found).abs() <= 1e-15);
            assert!((found - 0.098_553_688_163).abs() < 1e-12, "{found}");
        }
        assert!(calls.get() < 30, "{} calls", calls.get());
    }
}
