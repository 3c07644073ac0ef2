//! What every chart and picture asks of its data.

use super::PageError;

/// There is something to show.
pub(super) fn check_some(block: &str, what: &'static str, is_empty: bool) -> Result<(), PageError> {
    if !is_empty {
        return Ok(());
    }
    let block = block.to_owned();
    Err(PageError::Empty { block, what })
}

/// Numbers that belong together are as many.
pub(super) fn check_count(
    block: &str,
    what: &str,
    found: usize,
    expected: usize,
) -> Result<(), PageError> {
    if found == expected {
        return Ok(());
    }
    Err(PageError::Count {
        block: block.to_owned(),
        what: what.to_owned(),
        found,
        expected,
    })
}

/// Every number is finite.
pub(super) fn check_finite<'a>(
    block: &str,
    what: &str,
    values: impl IntoIterator<Item = &'a f64>,
) -> Result<(), PageError> {
    check_finite_at(block, what, values.into_iter().copied().enumerate())
}

/// The same of numbers with the indices under which they are reported.
pub(super) fn check_finite_at(
    block: &str,
    what: &str,
    mut values: impl Iterator<Item = (usize, f64)>,
) -> Result<(), PageError> {
    match values.find(|(_, value)| !value.is_finite()) {
        None => Ok(()),
        Some((index, found)) => Err(PageError::NotFinite {
            block: block.to_owned(),
            what: what.to_owned(),
            index,
            found,
        }),
    }
}

/// Abscissas are there and increase.
pub(super) fn check_abscissas(block: &str, what: &'static str, x: &[f64]) -> Result<(), PageError> {
    check_some(block, what, x.is_empty())?;
    let mut before = f64::NEG_INFINITY;
    for (index, &found) in x.iter().enumerate() {
        if !(found.is_finite() && found > before) {
            return Err(PageError::NotIncreasing {
                block: block.to_owned(),
                index,
                found,
                before,
            });
        }
        before = found;
    }
    Ok(())
}

/// A range has finite ends, the first below the second.
pub(super) fn check_range(
    block: &str,
    what: &'static str,
    low: f64,
    high: f64,
) -> Result<(), PageError> {
    if low.is_finite() && high.is_finite() && low < high {
        return Ok(());
    }
    Err(PageError::Range {
        block: block.to_owned(),
        what,
        low,
        high,
    })
}
