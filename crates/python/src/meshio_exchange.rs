//! Mesh files to and from the formats of other programs.

use std::path::{Path, PathBuf};

use gearmesh_model::MeshData;
use numpy::{AllowTypeChange, PyArray1, PyArrayLike2, PyArrayMethods};
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::errors::file_error;
use crate::mesh_arrays::{field, hex_rows, mesh_error, point_rows};
use crate::meshio_format::MeshioFormat;

/// A node set becomes a field of this name and the set's where the format has no sets.
const SET_PREFIX: &str = "set:";

/// Writes a mesh file in any format that meshio writes, chosen by the extension of out_path.
///
/// length_unit is the unit of the coordinates in the written file, "m" or "mm". The file is read back before it gets its
/// name; returned are the names of sets and fields that the format could not hold.
#[pyfunction]
#[pyo3(signature = (mesh_h5, out_path, length_unit = "m"))]
pub(crate) fn export_mesh(
    py: Python<'_>,
    mesh_h5: PathBuf,
    out_path: PathBuf,
    length_unit: &str,
) -> PyResult<Vec<String>> {
    let metres_per_unit = metres_per(length_unit)?;
    let format = MeshioFormat::of(py, &out_path)?;
    let mesh = py
        .detach(|| gearmesh_model::read_mesh(&mesh_h5))
        .map_err(file_error)?;
    let (outgoing, names) = to_meshio(py, &mesh, &format, metres_per_unit)?;

    // Some formats write a second file beside: all are made in a folder of their own and moved together.
    let file_name = out_path.file_name().unwrap_or_default();
    let folder = match out_path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let disk = |error: std::io::Error| {
        PyOSError::new_err(format!("cannot write {}: {error}", out_path.display()))
    };
    let temporary = tempfile::Builder::new()
        .prefix(".gearmesh-")
        .tempdir_in(folder)
        .map_err(disk)?;
    let temporary_path = temporary.path().join(file_name);
    let options = PyDict::new(py);
    options.set_item("file_format", &format.name)?;
    let text = temporary_path.to_string_lossy().into_owned();
    let written = py
        .import("meshio")?
        .call_method("write", (text, outgoing), Some(&options));
    written.map_err(|error| format.explain(py, "write", &out_path, error))?;

    let stored = from_meshio(
        py,
        &format.read(py, &temporary_path)?,
        &format,
        metres_per_unit,
    );
    let stored = stored
        .map_err(|error| format.explain(py, "read back", &out_path, error))?
        .0;
    if stored.hexes.len() != mesh.hexes.len() || stored.points.len() != mesh.points.len() {
        return Err(PyValueError::new_err(format!(
            "{}: {} files do not hold hexahedra ({} of {} came back); choose another format",
            out_path.display(),
            format.name,
            stored.hexes.len(),
            mesh.hexes.len()
        )));
    }
    for entry in std::fs::read_dir(temporary.path()).map_err(disk)? {
        let entry = entry.map_err(disk)?;
        std::fs::rename(entry.path(), folder.join(entry.file_name())).map_err(disk)?;
    }
    let kept = |name: &String| {
        stored.point_sets.contains_key(name)
            || stored.point_fields.contains_key(name)
            || stored.cell_fields.contains_key(name)
    };
    Ok(names.into_iter().filter(|name| !kept(name)).collect())
}

/// Reads any format that meshio reads into a mesh file: hexahedra of 8 or 20 nodes, node sets and fields.
///
/// length_unit is the unit of the coordinates in the file that is read, "m" or "mm". Fields named "set:..." become node
/// sets. Surface, line and point cells are left out; returned is what was. Other volume cells raise ValueError.
#[pyfunction]
#[pyo3(signature = (in_path, out_h5, length_unit = "m"))]
pub(crate) fn import_mesh(
    py: Python<'_>,
    in_path: PathBuf,
    out_h5: PathBuf,
    length_unit: &str,
) -> PyResult<Vec<String>> {
    let metres_per_unit = metres_per(length_unit)?;
    if let Err(source) = std::fs::File::open(&in_path) {
        return Err(file_error(gearmesh_model::FileError::Io {
            path: in_path,
            action: "open",
            source,
        }));
    }
    let format = MeshioFormat::of(py, &in_path)?;
    let (mesh, left_out) = from_meshio(py, &format.read(py, &in_path)?, &format, metres_per_unit)?;
    if mesh.hexes.is_empty() {
        return Err(PyValueError::new_err(format!(
            "{}: there are no hexahedra of 8 or 20 nodes",
            in_path.display()
        )));
    }
    mesh.check_hexahedra().map_err(mesh_error)?;
    py.detach(|| gearmesh_model::write_mesh(&out_h5, &mesh))
        .map_err(file_error)?;
    Ok(left_out)
}

fn metres_per(length_unit: &str) -> PyResult<f64> {
    match length_unit {
        "m" => Ok(1.0),
        "mm" => Ok(1e-3),
        _ => Err(PyValueError::new_err(format!(
            "length_unit is \"{length_unit}\"; allowed are \"m\" and \"mm\""
        ))),
    }
}

/// A `meshio.Mesh`, and the names of all sets and fields.
fn to_meshio<'py>(
    py: Python<'py>,
    mesh: &MeshData,
    format: &MeshioFormat,
    metres_per_unit: f64,
) -> PyResult<(Bound<'py, PyAny>, Vec<String>)> {
    let points = mesh
        .points
        .as_flattened()
        .iter()
        .map(|x| x / metres_per_unit)
        .collect();
    let points = PyArray1::<f64>::from_vec(py, points).reshape([mesh.points.len(), 3])?;
    // meshio numbers both hexahedra as VTK does.
    let quadratic = mesh.hexes_of_20();
    let (cell_type, nodes) = match &quadratic {
        Some(hexes) => ("hexahedron20", hexes.as_flattened()),
        None => ("hexahedron", mesh.hexes.as_flattened()),
    };
    let hexes = nodes.iter().map(|&node| i64::from(node)).collect();
    let hexes = PyArray1::<i64>::from_vec(py, hexes)
        .reshape([mesh.hexes.len(), nodes.len() / mesh.hexes.len().max(1)])?;
    let (point_data, cell_data, point_sets) = (PyDict::new(py), PyDict::new(py), PyDict::new(py));
    for (name, set) in &mesh.point_sets {
        if format.has_point_sets() {
            let members = set.iter().map(|&node| i64::from(node)).collect();
            point_sets.set_item(name, PyArray1::<i64>::from_vec(py, members))?;
        } else {
            let mut member = vec![0.0; mesh.points.len()];
            set.iter().for_each(|&node| member[node as usize] = 1.0);
            point_data.set_item(
                format!("{SET_PREFIX}{name}"),
                PyArray1::from_vec(py, member),
            )?;
        }
    }
    for (data, fields) in [
        (&point_data, &mesh.point_fields),
        (&cell_data, &mesh.cell_fields),
    ] {
        for (name, field) in fields
            .iter()
            .filter(|(_, field)| format.holds_components(field.components))
        {
            let array = PyArray1::from_slice(py, &field.values);
            let array = match field.components {
                1 => array.into_any(),
                components => array
                    .reshape([field.values.len() / components, components])?
                    .into_any(),
            };
            // Cell data of meshio is a list with one array a block of cells; there is one block.
            let array = if data.is(&cell_data) {
                PyList::new(py, [array])?.into_any()
            } else {
                array
            };
            data.set_item(name, array)?;
        }
    }
    let options = PyDict::new(py);
    options.set_item("point_data", point_data)?;
    options.set_item("cell_data", cell_data)?;
    options.set_item("point_sets", point_sets)?;
    let cells = PyList::new(py, [(cell_type, hexes)])?;
    let outgoing = py
        .import("meshio")?
        .getattr("Mesh")?
        .call((points, cells), Some(&options))?;
    let names = mesh
        .point_sets
        .keys()
        .chain(mesh.point_fields.keys())
        .chain(mesh.cell_fields.keys());
    Ok((outgoing, names.cloned().collect()))
}

/// The hexahedra, sets and fields of a `meshio.Mesh`, and in words what was left out.
fn from_meshio(
    py: Python<'_>,
    incoming: &Bound<'_, PyAny>,
    format: &MeshioFormat,
    metres_per_unit: f64,
) -> PyResult<(MeshData, Vec<String>)> {
    let numpy = py.import("numpy")?;
    let mut mesh = MeshData {
        points: point_rows(&incoming.getattr("points")?.extract()?, metres_per_unit)?,
        ..MeshData::default()
    };
    let mut left_out = Vec::new();
    let mut hex_blocks = Vec::new();
    let mut quadratic = Vec::new();
    for (block, cells) in incoming.getattr("cells")?.try_iter()?.enumerate() {
        let cells = cells?;
        let kind: String = cells.getattr("type")?.extract()?;
        let data = cells.getattr("data")?;
        if kind == "hexahedron" {
            mesh.hexes.extend(hex_rows::<8>(&data.extract()?)?);
            hex_blocks.push(block);
        } else if kind == "hexahedron20" {
            quadratic.extend(hex_rows::<20>(&data.extract()?)?);
            hex_blocks.push(block);
        } else if cells.getattr("dim")?.extract::<usize>()? < 3 {
            left_out.push(format!("{} {kind} cells", data.len()?));
        } else {
            let message = format!(
                "{} {kind} cells; only hexahedra of 8 or 20 nodes are allowed: mesh the body with them",
                data.len()?
            );
            return Err(PyValueError::new_err(message));
        }
    }
    if !quadratic.is_empty() {
        if !mesh.hexes.is_empty() {
            let message = format!(
                "{} hexahedra of 8 and {} of 20 nodes; all must have the same number of nodes",
                mesh.hexes.len(),
                quadratic.len()
            );
            return Err(PyValueError::new_err(message));
        }
        mesh.set_hexes_of_20(&quadratic);
    }
    for (name, set) in incoming.getattr("point_sets")?.cast::<PyDict>()?.iter() {
        mesh.point_sets.insert(stored_name(&name)?, node_set(&set)?);
    }
    // "gmsh:dim_tags", "nastran:ref" and the like are the format's own bookkeeping.
    let own = format!("{}:", format.name);
    for (name, data) in incoming.getattr("point_data")?.cast::<PyDict>()?.iter() {
        let name = stored_name(&name)?;
        let values = field(&field_rows(&data)?);
        match name.strip_prefix(SET_PREFIX) {
            Some(set) if values.components == 1 => {
                let members = values
                    .values
                    .iter()
                    .zip(0..)
                    .filter(|(value, _)| **value != 0.0)
                    .map(|(_, node)| node);
                mesh.point_sets.insert(set.to_owned(), members.collect());
            }
            _ if name.starts_with(&own) => left_out.push(format!("point data {name}")),
            _ => drop(mesh.point_fields.insert(name, values)),
        }
    }
    for (name, blocks) in incoming.getattr("cell_data")?.cast::<PyDict>()?.iter() {
        let name = stored_name(&name)?;
        if name.starts_with(&own) {
            left_out.push(format!("cell data {name}"));
            continue;
        }
        let hex_data = hex_blocks
            .iter()
            .map(|&block| blocks.get_item(block))
            .collect::<PyResult<Vec<_>>>()?;
        if !hex_data.is_empty() {
            let joined = numpy.call_method1("concatenate", (hex_data,))?;
            mesh.cell_fields.insert(name, field(&field_rows(&joined)?));
        }
    }
    Ok((mesh, left_out))
}

/// One row a node or element, also for scalars.
fn field_rows<'py>(array: &Bound<'py, PyAny>) -> PyResult<PyArrayLike2<'py, f64, AllowTypeChange>> {
    let array = array
        .py()
        .import("numpy")?
        .call_method1("asarray", (array, "float64"))?;
    let length = array.len()?;
    let rows = array.call_method1("reshape", (length, if length == 0 { 1 } else { -1 }))?;
    rows.extract()
}

/// A name of another program as it can be stored: slashes make groups in HDF5.
fn stored_name(name: &Bound<'_, PyAny>) -> PyResult<String> {
    Ok(name.extract::<String>()?.replace('/', "_"))
}

fn node_set(set: &Bound<'_, PyAny>) -> PyResult<Vec<u32>> {
    set.try_iter()?.map(|node| node?.extract()).collect()
}
