//! STEP: a smooth step between two values.

/// STEP(x, x₀, y₀, x₁, y₁) and its derivative by x: y₀ below x₀, y₁ above x₁, between them the cubic
/// y₀ + (y₁ − y₀) s²(3 − 2s), s = (x − x₀)/(x₁ − x₀). x₁ > x₀.
#[must_use]
pub fn step(x: f64, [x0, y0]: [f64; 2], [x1, y1]: [f64; 2]) -> (f64, f64) {
    let s = (x - x0) / (x1 - x0);
    if s <= 0.0 {
        (y0, 0.0)
    } else if s >= 1.0 {
        (y1, 0.0)
    } else {
        let rise = y1 - y0;
        (
            y0 + rise * s * s * (3.0 - 2.0 * s),
            rise * 6.0 * s * (1.0 - s) / (x1 - x0),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ends_and_the_middle() {
        let at = |x| step(x, [1.0, 2.0], [3.0, -2.0]);
        assert_eq!(at(0.0), (2.0, 0.0));
        assert_eq!(at(4.0), (-2.0, 0.0));
        assert_eq!(at(2.0), (0.0, -3.0));
    }
}
