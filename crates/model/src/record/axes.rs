//! Axes of the arrays of a record: as the documentation writes them, as an array has them, as a file must have them.

use std::path::Path;

use super::OPEN;
use crate::data_tree::{DataArray, DataTree, Values};
use crate::file_error::FileError;

pub(super) fn form(axes: &[(&str, usize)], single: &str) -> String {
    if axes.is_empty() {
        return single.to_owned();
    }
    axes.iter().map(|(label, _)| format!("[{label}]")).collect()
}

/// An array whose open axis is as long as its values say.
pub(super) fn array(values: Values, axes: &[(&str, usize)], unit: &str, what: &str) -> DataArray {
    let known = axes.iter().map(|axis| axis.1).filter(|n| *n != OPEN);
    let open = values.len() / known.product::<usize>().max(1);
    let closed = |&(label, n): &(_, _)| (label, if n == OPEN { open } else { n });
    let axes: Vec<(&str, usize)> = axes.iter().map(closed).collect();
    DataArray::new(values, &axes, unit, what)
}

/// The shape that an array of the file must have: its own along the open axis.
pub(super) fn shape(
    tree: &DataTree,
    path: &Path,
    name: &str,
    axes: &[(&str, usize)],
) -> Result<Vec<usize>, FileError> {
    let mut wanted: Vec<usize> = axes.iter().map(|axis| axis.1).collect();
    let Some(open) = wanted.iter().position(|n| *n == OPEN) else {
        return Ok(wanted);
    };
    let found = tree.shape_of(path, name)?;
    if found.len() != wanted.len() {
        wanted[open] = 0;
        return Err(FileError::WrongShape {
            path: path.to_owned(),
            item: format!("array \"{name}\""),
            found: found.to_vec(),
            expected: wanted,
        });
    }
    wanted[open] = found[open];
    Ok(wanted)
}
