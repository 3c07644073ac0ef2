//! Numbers of tables: usual units, few digits.

/// Four digits or all before the point; a power of ten only where zeros would hide the number.
#[must_use]
pub fn short(value: f64) -> String {
    if value == 0.0 {
        "0".to_owned()
    } else if !(1e-3..1e7).contains(&value.abs()) {
        format!("{value:.3e}")
    } else {
        let digits = (3 - value.abs().log10().floor() as i32).clamp(0, 6);
        format!("{value:.*}", digits as usize)
    }
}

/// The same beside an amount of its kind: 0 where the four digits of that one do not reach it, as the sideways
/// displacement of a ring under a load along its axis.
#[must_use]
pub fn short_beside(value: f64, amount: f64) -> String {
    const FOUR_DIGITS: f64 = 5e-5;
    short(match value.abs() < FOUR_DIGITS * amount.abs() {
        true => 0.0,
        false => value,
    })
}

/// The unit in which an engineer reads a quantity whose largest amount is `largest`, and the factor that brings it
/// there: stress and pressure in MPa, line load and stiffness in N/mm, small lengths in µm or mm.
#[must_use]
pub fn usual_unit(unit: &str, largest: f64) -> (f64, &str) {
    match unit {
        "1" => (1.0, ""),
        "Pa" => (1e-6, "MPa"),
        "N/m" => (1e-3, "N/mm"),
        "m" if largest < 1e-3 => (1e6, "µm"),
        "m" if largest < 1.0 => (1e3, "mm"),
        _ => (1.0, unit),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forces_and_stresses_are_read_without_powers_of_ten() {
        assert_eq!(short(2812.345), "2812");
        assert_eq!(short(215_776.6), "215777");
        assert_eq!(short(-0.012_345_6), "-0.01235");
        assert_eq!(short(3.2e-9), "3.200e-9");
        assert_eq!(short_beside(3.672e-12, 87.93), "0");
        assert_eq!(short_beside(3.672e-2, 87.93), "0.03672");
        let (factor, unit) = usual_unit("Pa", 2.157_765e7);
        assert_eq!(
            (short(factor * 2.157_765e7), unit),
            ("21.58".to_owned(), "MPa")
        );
        assert_eq!(usual_unit("m", 3e-5), (1e6, "µm"));
        assert_eq!(usual_unit("N", 3e5), (1.0, "N"));
    }
}
