//! Numbers of tables.

/// Three to four digits.
pub(crate) fn short(value: f64) -> String {
    if value == 0.0 {
        "0".to_owned()
    } else if !(1e-3..1e5).contains(&value.abs()) {
        format!("{value:.3e}")
    } else {
        let digits = (3 - value.abs().max(1e-3).log10().floor() as i32).clamp(0, 6);
        format!("{value:.*}", digits as usize)
    }
}
