//! Mesh files as NumPy arrays.

use std::collections::BTreeMap;
use std::path::PathBuf;

use gearmesh_model::{CellKind, Field, MeshData, MeshDataError};
use numpy::{AllowTypeChange, PyArray1, PyArrayLike2, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::file_error;

type FloatRows<'py> = PyArrayLike2<'py, f64, AllowTypeChange>;

/// Reads a mesh file into a dict of NumPy arrays.
///
/// Keys: points (n, 3) in metres, cells {kind: (m, nodes)} with the kinds hex8, hex20, tet10, wedge6, wedge15,
/// point_sets {name: indices}, point_fields and cell_fields {name: (rows, components)}; the elements of cell_fields are
/// those of cells, kind after kind.
#[pyfunction]
pub(crate) fn read_mesh(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyDict>> {
    let mesh = py
        .detach(|| gearmesh_model::read_mesh(&path))
        .map_err(file_error)?;
    let result = PyDict::new(py);
    result.set_item(
        "points",
        PyArray1::from_slice(py, mesh.points.as_flattened()).reshape([mesh.points.len(), 3])?,
    )?;
    let cells = PyDict::new(py);
    for (kind, nodes) in mesh.cells {
        let shape = [nodes.len() / kind.node_count(), kind.node_count()];
        cells.set_item(kind.name(), PyArray1::from_vec(py, nodes).reshape(shape)?)?;
    }
    result.set_item("cells", cells)?;
    let sets = PyDict::new(py);
    for (name, set) in mesh.point_sets {
        sets.set_item(name, PyArray1::from_vec(py, set))?;
    }
    result.set_item("point_sets", sets)?;
    for (key, fields) in [
        ("point_fields", mesh.point_fields),
        ("cell_fields", mesh.cell_fields),
    ] {
        let arrays = PyDict::new(py);
        for (name, field) in fields {
            let shape = [field.values.len() / field.components, field.components];
            arrays.set_item(name, PyArray1::from_vec(py, field.values).reshape(shape)?)?;
        }
        result.set_item(key, arrays)?;
    }
    Ok(result)
}

/// Writes a mesh file from arrays: points (n, 3) in metres, cells {kind: (m, nodes)} as read_mesh returns them, sets
/// and fields by name.
///
/// Fields are (rows, components). Every element must have a positive Jacobian at each corner.
#[pyfunction]
#[pyo3(signature = (path, points, cells, point_sets = None, point_fields = None))]
pub(crate) fn write_mesh(
    py: Python<'_>,
    path: PathBuf,
    points: FloatRows<'_>,
    cells: BTreeMap<String, PyArrayLike2<'_, i64, AllowTypeChange>>,
    point_sets: Option<BTreeMap<String, Vec<u32>>>,
    point_fields: Option<BTreeMap<String, FloatRows<'_>>>,
) -> PyResult<()> {
    let mut mesh = MeshData {
        points: point_rows(&points, 1.0)?,
        point_sets: point_sets.unwrap_or_default(),
        ..MeshData::default()
    };
    for (name, rows) in cells {
        let kind = CellKind::from_name(&name).ok_or_else(|| {
            let names = CellKind::ALL.map(CellKind::name).join(", ");
            PyValueError::new_err(format!("cells of the kind {name:?}; allowed are {names}"))
        })?;
        mesh.cells.insert(kind, cell_rows(kind, &rows)?);
    }
    for (name, array) in point_fields.unwrap_or_default() {
        mesh.point_fields.insert(name, field(&array));
    }
    mesh.check_cells().map_err(mesh_error)?;
    py.detach(|| gearmesh_model::write_mesh(&path, &mesh))
        .map_err(file_error)
}

/// Coordinates times a factor; the array must have three columns.
pub(crate) fn point_rows(array: &FloatRows<'_>, metres_per_unit: f64) -> PyResult<Vec<[f64; 3]>> {
    let view = array.as_array();
    if view.ncols() != 3 {
        let message = format!(
            "points have {} coordinates; three are needed (n, 3)",
            view.ncols()
        );
        return Err(PyValueError::new_err(message));
    }
    Ok(view
        .rows()
        .into_iter()
        .map(|row| [0, 1, 2].map(|i| row[i] * metres_per_unit))
        .collect())
}

/// Node indices, element by element; the array must have as many columns as the elements have nodes and hold no
/// negative index.
pub(crate) fn cell_rows(
    kind: CellKind,
    array: &PyArrayLike2<'_, i64, AllowTypeChange>,
) -> PyResult<Vec<u32>> {
    let view = array.as_array();
    if view.ncols() != kind.node_count() {
        let message = format!(
            "{} elements have {} nodes; {} are needed",
            kind.name(),
            view.ncols(),
            kind.node_count()
        );
        return Err(PyValueError::new_err(message));
    }
    let node = |(place, &node): (usize, &i64)| {
        u32::try_from(node).map_err(|_| {
            PyValueError::new_err(format!(
                "element {} refers to node {node}; indices start at 0",
                place / kind.node_count()
            ))
        })
    };
    view.iter().enumerate().map(node).collect()
}

/// A field without unit, one row a node or element.
pub(crate) fn field(array: &FloatRows<'_>) -> Field {
    let view = array.as_array();
    Field {
        components: view.ncols(),
        values: view.iter().copied().collect(),
        unit: String::new(),
    }
}

pub(crate) fn mesh_error(error: MeshDataError) -> PyErr {
    PyValueError::new_err(error.to_string())
}
