//! Taking checked parts out of a [`DataTree`] that was read; the file's path is passed along for the errors.

use std::path::Path;

use crate::data_tree::{DataTree, Values};
use crate::data_tree_file::{missing, wrong_type};
use crate::file_error::FileError;

impl DataTree {
    /// Takes out an array of 64-bit floats of a given shape.
    ///
    /// # Errors
    /// [`FileError::Missing`], [`FileError::WrongType`], [`FileError::WrongShape`]; `path` is named in them.
    pub fn take_f64(
        &mut self,
        path: &Path,
        name: &str,
        shape: &[usize],
    ) -> Result<Vec<f64>, FileError> {
        match self.take(path, name, shape)? {
            Values::F64(values) => Ok(values),
            Values::U32(_) => Err(wrong_type(
                path,
                name,
                "32-bit counts",
                "64-bit floating point",
            )),
        }
    }

    /// Takes out an array of 32-bit counts of a given shape.
    ///
    /// # Errors
    /// As [`DataTree::take_f64`].
    pub fn take_u32(
        &mut self,
        path: &Path,
        name: &str,
        shape: &[usize],
    ) -> Result<Vec<u32>, FileError> {
        match self.take(path, name, shape)? {
            Values::U32(values) => Ok(values),
            Values::F64(_) => Err(wrong_type(
                path,
                name,
                "64-bit floating point",
                "32-bit counts",
            )),
        }
    }

    /// Takes out a single floating-point number.
    ///
    /// # Errors
    /// As [`DataTree::take_f64`].
    pub fn take_scalar(&mut self, path: &Path, name: &str) -> Result<f64, FileError> {
        self.take_f64(path, name, &[]).map(|values| values[0])
    }

    /// Takes out a text.
    ///
    /// # Errors
    /// [`FileError::Missing`].
    pub fn take_text(&mut self, path: &Path, name: &str) -> Result<String, FileError> {
        self.texts
            .remove(name)
            .ok_or_else(|| missing(path, "text", name))
    }

    /// The shape of an array that is still in the tree.
    ///
    /// # Errors
    /// [`FileError::Missing`]; [`FileError::WrongShape`] when it has not `N` axes.
    pub fn shape<const N: usize>(&self, path: &Path, name: &str) -> Result<[usize; N], FileError> {
        let found = self.shape_of(path, name)?.to_vec();
        found.try_into().map_err(|found| FileError::WrongShape {
            path: path.to_owned(),
            item: format!("array \"{name}\""),
            found,
            expected: vec![0; N],
        })
    }

    /// The shape of an array that is still in the tree, whatever its axes are.
    ///
    /// # Errors
    /// [`FileError::Missing`].
    pub(crate) fn shape_of(&self, path: &Path, name: &str) -> Result<&[usize], FileError> {
        let array = self.arrays.get(name);
        let array = array.ok_or_else(|| missing(path, "array", name))?;
        Ok(&array.shape)
    }

    fn take(&mut self, path: &Path, name: &str, shape: &[usize]) -> Result<Values, FileError> {
        let array = self
            .arrays
            .remove(name)
            .ok_or_else(|| missing(path, "array", name))?;
        if array.shape != shape {
            return Err(FileError::WrongShape {
                path: path.to_owned(),
                item: format!("array \"{name}\""),
                found: array.shape,
                expected: shape.to_vec(),
            });
        }
        Ok(array.values)
    }
}
