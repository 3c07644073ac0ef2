//! A ball or roller that is not there: lost with its pocket of the cage, or left out in assembly.
//!
//! Its place in the row stays empty: the others keep their angles, as the cage holds them, and the rings feel nothing
//! there.

use super::Fault;
use crate::error::BearingError;

/// The empty places of a row of so many balls or rollers, each once, in rising order.
///
/// # Errors
/// [`BearingError::Parameter`] for an element that the row does not have; [`BearingError::NotCarried`] where fewer than
/// two are left.
pub(crate) fn missing(
    faults: &[Fault],
    number: usize,
    elements: usize,
) -> Result<Vec<usize>, BearingError> {
    let mut found = Vec::new();
    for fault in faults {
        if let Fault::Missing { row, element } = *fault
            && row == number
        {
            BearingError::require(
                "the number of a missing ball or roller, from 1,",
                (element + 1) as f64,
                element < elements,
                "at most the number of balls or rollers of the row",
            )?;
            found.push(element);
        }
    }
    found.sort_unstable();
    found.dedup();
    if found.len() + 2 > elements {
        return Err(BearingError::NotCarried(
            "fewer than two balls or rollers of a row are left: take some of the `missing` faults away",
        ));
    }
    Ok(found)
}
