//! Checks of quantities and arrays of a reduced gear, with errors that name them.

use std::fmt;

use crate::reduced_gear_error::ReducedGearError;

pub(crate) fn out_of_range(
    item: &str,
    found: impl fmt::Display,
    allowed: &'static str,
) -> ReducedGearError {
    ReducedGearError::OutOfRange {
        item: item.to_owned(),
        found: found.to_string(),
        allowed,
    }
}

pub(crate) fn in_range(
    item: &str,
    value: f64,
    holds: impl Fn(f64) -> bool,
    allowed: &'static str,
) -> Result<(), ReducedGearError> {
    if holds(value) {
        Ok(())
    } else {
        Err(out_of_range(item, value, allowed))
    }
}

pub(crate) fn check_array(
    item: &str,
    values: &[f64],
    expected: usize,
    formula: &'static str,
) -> Result<(), ReducedGearError> {
    if values.len() != expected {
        return Err(ReducedGearError::WrongLength {
            item: item.to_owned(),
            found: values.len(),
            expected,
            formula,
        });
    }
    match values.iter().position(|value| !value.is_finite()) {
        Some(index) => Err(ReducedGearError::NotFinite {
            item: item.to_owned(),
            index,
            value: values[index],
        }),
        None => Ok(()),
    }
}

/// At least two finite values, strictly increasing.
pub(crate) fn check_stations(item: &str, values: &[f64]) -> Result<(), ReducedGearError> {
    check_array(item, values, values.len(), "any number")?;
    if values.len() < 2 || values.windows(2).any(|pair| pair[0] >= pair[1]) {
        return Err(out_of_range(
            item,
            format!("{values:?}"),
            "at least two strictly increasing values",
        ));
    }
    Ok(())
}

pub(crate) fn smallest(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::INFINITY, f64::min)
}

pub(crate) fn positive(value: f64) -> bool {
    value > 0.0 && value.is_finite()
}

pub(crate) fn check_finite(item: &str, value: f64) -> Result<(), ReducedGearError> {
    in_range(item, value, f64::is_finite, "finite")
}

/// An error or what is left over: finite and not negative.
pub(crate) fn check_error(item: &str, value: f64) -> Result<(), ReducedGearError> {
    let holds = |e: f64| e >= 0.0 && e.is_finite();
    in_range(item, value, holds, "finite and not negative")
}

/// What near fields of all gears have: half width of the calibrating pressure and element length (m), and the residual.
pub(crate) fn check_calibration(
    near_field: &str,
    [half_width_m, element_m, residual]: [f64; 3],
) -> Result<(), ReducedGearError> {
    for (name, length_m) in [("half_width_m", half_width_m), ("element_m", element_m)] {
        let item = format!("{near_field}.{name}");
        in_range(&item, length_m, positive, "above 0 m")?;
    }
    check_error(&format!("{near_field}.residual"), residual)
}
