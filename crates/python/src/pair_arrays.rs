//! A pair's result whose data sets lie in NumPy arrays: Python and this side share them.

use std::collections::BTreeMap;
use std::path::Path;

use gearmesh_model::{DataArray, DataTree, Values, read_record, write_record};
use gearmesh_scene::{RESULT_FORMAT, SceneResult};
use numpy::{Element, PyArray1, PyArrayDyn, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::file_error;

/// Texts and small parts as the result has them, and its data sets, moved into arrays that cannot be written to: tables
/// and files are made of them.
pub(crate) struct PairArrays {
    /// The result without its large arrays.
    pub(crate) head: SceneResult,
    texts: DataTree,
    sets: BTreeMap<String, (Array, DataArray)>,
}

/// A data set's memory.
enum Array {
    F64(Py<PyArrayDyn<f64>>),
    U32(Py<PyArrayDyn<u32>>),
}

impl PairArrays {
    /// Hands the arrays of a result over to NumPy.
    pub(crate) fn new(py: Python<'_>, mut result: SceneResult) -> PyResult<Self> {
        let mut texts = DataTree::default();
        write_record(&mut result, &mut texts);
        let mut sets = BTreeMap::new();
        for (name, mut set) in std::mem::take(&mut texts.arrays) {
            let array = match std::mem::replace(&mut set.values, Values::F64(Vec::new())) {
                Values::F64(values) => Array::F64(handed_over(py, values, &set.shape)?),
                Values::U32(values) => Array::U32(handed_over(py, values, &set.shape)?),
            };
            sets.insert(name, (array, set));
        }
        Ok(Self {
            head: result,
            texts,
            sets,
        })
    }

    /// Names of the data sets.
    pub(crate) fn names(&self) -> Vec<String> {
        self.sets.keys().cloned().collect()
    }

    /// All data sets by name: (array, names of the axes, unit, description).
    pub(crate) fn data_sets<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let found = PyDict::new(py);
        for (name, (array, set)) in &self.sets {
            let array = match array {
                Array::F64(array) => array.bind(py).as_any(),
                Array::U32(array) => array.bind(py).as_any(),
            };
            let told = (array, &set.axis_labels, &set.unit, &set.description);
            found.set_item(name, told)?;
        }
        Ok(found)
    }

    /// The whole result, in memory of its own, for a file or a table.
    pub(crate) fn result(&self, py: Python<'_>) -> PyResult<SceneResult> {
        let mut tree = self.texts.clone();
        for (name, (array, set)) in &self.sets {
            let mut set = set.clone();
            set.values = match array {
                Array::F64(array) => Values::F64(copied(py, array)?),
                Array::U32(array) => Values::U32(copied(py, array)?),
            };
            tree.put(name.clone(), set);
        }
        py.detach(move || read_record(&mut tree, Path::new("the result"), RESULT_FORMAT.version))
            .map_err(file_error)
    }
}

/// An array that owns the values as they lie in memory, for reading.
fn handed_over<T: Element>(
    py: Python<'_>,
    values: Vec<T>,
    shape: &[usize],
) -> PyResult<Py<PyArrayDyn<T>>> {
    let array = PyArray1::from_vec(py, values).reshape(shape)?;
    let _ = array.readwrite().make_nonwriteable();
    Ok(array.unbind())
}

fn copied<T: Element + Copy>(py: Python<'_>, array: &Py<PyArrayDyn<T>>) -> PyResult<Vec<T>> {
    Ok(array.bind(py).readonly().as_slice()?.to_vec())
}
