//! Mesh files as NumPy arrays.

use std::collections::BTreeMap;
use std::path::PathBuf;

use gearmesh_model::{Field, MeshData, MeshDataError};
use numpy::{AllowTypeChange, PyArray1, PyArrayLike2, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::file_error;

type FloatRows<'py> = PyArrayLike2<'py, f64, AllowTypeChange>;

/// Reads a mesh file into a dict of NumPy arrays.
///
/// Keys: points (n, 3) in metres, hexes (m, 8) or (m, 20) in VTK node order, point_sets {name: indices}, point_fields and
/// cell_fields {name: (rows, components)}.
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
    let elements = mesh.hexes.len();
    let hexes = match mesh.hexes_of_20() {
        Some(hexes) => PyArray1::from_vec(py, hexes.into_flattened()).reshape([elements, 20])?,
        None => PyArray1::from_slice(py, mesh.hexes.as_flattened()).reshape([elements, 8])?,
    };
    result.set_item("hexes", hexes)?;
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

/// Writes a mesh file from arrays: points (n, 3) in metres, hexes (m, 8) or (m, 20) in VTK node order, sets and fields
/// by name.
///
/// Fields are (rows, components). Every hexahedron must have a positive Jacobian at each corner.
#[pyfunction]
#[pyo3(signature = (path, points, hexes, point_sets = None, point_fields = None))]
pub(crate) fn write_mesh(
    py: Python<'_>,
    path: PathBuf,
    points: FloatRows<'_>,
    hexes: PyArrayLike2<'_, i64, AllowTypeChange>,
    point_sets: Option<BTreeMap<String, Vec<u32>>>,
    point_fields: Option<BTreeMap<String, FloatRows<'_>>>,
) -> PyResult<()> {
    let mut mesh = MeshData {
        points: point_rows(&points, 1.0)?,
        point_sets: point_sets.unwrap_or_default(),
        ..MeshData::default()
    };
    match hexes.as_array().ncols() {
        20 => mesh.set_hexes_of_20(&hex_rows(&hexes)?),
        _ => mesh.hexes = hex_rows(&hexes)?,
    }
    for (name, array) in point_fields.unwrap_or_default() {
        mesh.point_fields.insert(name, field(&array));
    }
    mesh.check_hexahedra().map_err(mesh_error)?;
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

/// Node indices; the array must have N columns and hold no negative index.
pub(crate) fn hex_rows<const N: usize>(
    array: &PyArrayLike2<'_, i64, AllowTypeChange>,
) -> PyResult<Vec<[u32; N]>> {
    let view = array.as_array();
    if view.ncols() != N {
        let message = format!(
            "hexahedra have {} nodes; 8 or 20 are needed, (m, 8) or (m, 20)",
            view.ncols()
        );
        return Err(PyValueError::new_err(message));
    }
    let mut rows = Vec::with_capacity(view.nrows());
    for (element, row) in view.rows().into_iter().enumerate() {
        let mut hex = [0; N];
        for (slot, &node) in hex.iter_mut().zip(row) {
            *slot = u32::try_from(node).map_err(|_| {
                PyValueError::new_err(format!(
                    "element {element} refers to node {node}; indices start at 0"
                ))
            })?;
        }
        rows.push(hex);
    }
    Ok(rows)
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
