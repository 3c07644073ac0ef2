//! Results of both kinds: their data sets as NumPy arrays.

use std::path::PathBuf;

use gearmesh_report::export::{Cells, Table, pair_tables, system_tables, torque_table};
use gearmesh_scene::rating::RatingResult;
use gearmesh_scene::system_run::SystemResult;
use gearmesh_scene::{ResultFile, SceneResult};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::{InputError, file_error};
use crate::pair_arrays::PairArrays;

/// A data set: array, names of its axes, unit, what it is.
type DataSet<'py> = (Bound<'py, PyAny>, Vec<String>, String, String);

/// A result in memory (of a pair) or a file whose columns are read when they are asked for (of a multibody scene).
#[pyclass(frozen, module = "gearmesh._native")]
pub(crate) struct NativeResult(Kept);

enum Kept {
    Pair(Box<PairArrays>),
    System(Box<SystemResult>),
}

impl NativeResult {
    /// Of a pair.
    pub(crate) fn of_pair(py: Python<'_>, result: SceneResult) -> PyResult<Self> {
        Ok(Self(Kept::Pair(Box::new(PairArrays::new(py, result)?))))
    }

    /// Of a multibody scene.
    pub(crate) fn of_system(result: SystemResult) -> Self {
        Self(Kept::System(Box::new(result)))
    }
}

/// Opens a result file of either kind.
#[pyfunction]
pub(crate) fn open_result(py: Python<'_>, path: PathBuf) -> PyResult<NativeResult> {
    match py.detach(|| ResultFile::open(&path)).map_err(file_error)? {
        ResultFile::Pair(result) => NativeResult::of_pair(py, *result),
        ResultFile::System(result) => Ok(NativeResult::of_system(*result)),
    }
}

#[pymethods]
impl NativeResult {
    /// "pair", "transient", "static", "speed-sweep" or "eigen".
    #[getter]
    fn kind(&self) -> String {
        match &self.0 {
            Kept::Pair(_) => "pair".to_owned(),
            Kept::System(result) => result.kind.to_string(),
        }
    }

    /// Title of the scene.
    #[getter]
    fn title(&self) -> &str {
        match &self.0 {
            Kept::Pair(pair) => &pair.head.source.title,
            Kept::System(result) => &result.head.title,
        }
    }

    /// The scene, word for word.
    #[getter]
    fn scene_toml(&self) -> &str {
        match &self.0 {
            Kept::Pair(pair) => &pair.head.source.scene_toml,
            Kept::System(result) => &result.head.scene_toml,
        }
    }

    /// Version of the program, and when, UTC.
    #[getter]
    fn made(&self) -> (&str, &str) {
        match &self.0 {
            Kept::Pair(pair) => (&pair.head.source.version, &pair.head.source.created_utc),
            Kept::System(result) => (&result.version, &result.created_utc),
        }
    }

    /// What the user should know: assumptions that do not hold, periods not seen whole, energy that was lost.
    #[getter]
    fn warnings(&self) -> PyResult<Vec<String>> {
        Ok(match &self.0 {
            Kept::Pair(pair) => {
                let mut warnings = pair.head.warnings.clone();
                warnings.extend(pair.head.incomplete());
                warnings.extend(pair.head.ratings.iter().flat_map(RatingResult::reported));
                warnings
            }
            Kept::System(result) => {
                let mut warnings = result.head.notes.clone();
                warnings.extend(result.problem());
                warnings.extend(result.warnings().map_err(file_error)?);
                warnings
            }
        })
    }

    /// Names of all data sets of a pair, of the columns of a multibody result.
    fn names(&self) -> Vec<String> {
        match &self.0 {
            Kept::Pair(pair) => pair.names(),
            Kept::System(result) => {
                let columns = result.rows.columns().iter();
                columns.map(|column| column.name.clone()).collect()
            }
        }
    }

    /// All data sets of a pair by name: (array, names of the axes, unit, description). The arrays are this result's
    /// own memory.
    fn data_sets<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        match &self.0 {
            Kept::Pair(pair) => pair.data_sets(py),
            Kept::System(_) => Ok(PyDict::new(py)),
        }
    }

    /// A column of a multibody result, read now: (array (rows,), ["row"], unit, description).
    fn column<'py>(&self, py: Python<'py>, name: &str) -> PyResult<DataSet<'py>> {
        let Kept::System(result) = &self.0 else {
            return Err(InputError::new_err("a pair's result has no columns"));
        };
        let mut columns = result.rows.columns().iter();
        let column = columns
            .find(|column| column.name == name)
            .ok_or_else(|| InputError::new_err(format!("the result has no column `{name}`")))?;
        let values = result.rows.read(name).map_err(file_error)?;
        let values = PyArray1::from_vec(py, values).into_any();
        let (unit, description) = (column.unit.clone(), column.description.clone());
        Ok((values, vec!["row".to_owned()], unit, description))
    }

    /// The tables that `gearmesh export` knows, by name: {column: array or list of texts}.
    fn tables<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let tables = match &self.0 {
            Kept::Pair(pair) => {
                let result = pair.result(py)?;
                py.detach(|| pair_tables(&result))
            }
            Kept::System(result) => system_tables(result),
        };
        let found = PyDict::new(py);
        for table in tables {
            found.set_item(table.name.clone(), columns(py, table)?)?;
        }
        Ok(found)
    }

    /// The table `torques` of a pair: the figures of each torque.
    fn torque_figures<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let Kept::Pair(pair) = &self.0 else {
            return Ok(PyDict::new(py));
        };
        let result = pair.result(py)?;
        columns(py, py.detach(|| torque_table(&result)))
    }

    /// A pair's figures as people read them: the heads, then a row for each torque.
    fn figure_texts(&self, py: Python<'_>) -> PyResult<Vec<Vec<String>>> {
        let Kept::Pair(pair) = &self.0 else {
            return Ok(Vec::new());
        };
        let table = pair.result(py)?.figure_table(false);
        Ok([vec![table.heads], table.rows].concat())
    }

    /// Writes a pair's result; that of a multibody scene is a file already.
    fn write(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        match &self.0 {
            Kept::Pair(pair) => {
                let result = pair.result(py)?;
                py.detach(|| result.write(&path)).map_err(file_error)
            }
            Kept::System(_) => Err(InputError::new_err(
                "the result of a multibody scene is a file already; copy it",
            )),
        }
    }
}

/// The columns of a table by name.
fn columns<'py>(py: Python<'py>, table: Table<'_>) -> PyResult<Bound<'py, PyDict>> {
    let found = PyDict::new(py);
    for (head, cells) in table.columns {
        match cells {
            Cells::Numbers(values) => found.set_item(head, PyArray1::from_vec(py, values))?,
            Cells::Texts(texts) => found.set_item(head, texts)?,
            Cells::Column(file, name) => {
                let values = file.read(&name).map_err(file_error)?;
                found.set_item(head, PyArray1::from_vec(py, values))?;
            }
        }
    }
    Ok(found)
}
