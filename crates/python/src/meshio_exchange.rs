//! Mesh files to and from the formats of other programs.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use gearmesh_model::{CellKind, MeshData};
use numpy::{AllowTypeChange, PyArray1, PyArrayLike2, PyArrayMethods};
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PySlice};

use crate::errors::file_error;
use crate::mesh_arrays::{cell_rows, field, mesh_error, point_rows};
use crate::meshio_format::MeshioFormat;
use crate::solver_decks::{DeckOptions, write_abaqus, write_nastran};

/// A node set becomes a field of this name and the set's.
const SET_PREFIX: &str = "set:";

/// Writes a mesh file in a format of other programs, chosen by the extension of out_path: .bdf .nas (Nastran), .inp
/// (Abaqus, CalculiX), .msh (gmsh), .vtk .vtu .xdmf .xmf (ParaView).
///
/// length_unit is the unit of the coordinates in the written file, "m" or "mm"; incompatible_modes makes hexahedra of
/// an .inp file C3D8I in place of C3D8. The file is read back before it gets its name; returned are the names of sets
/// and fields that the format does not hold.
#[pyfunction]
#[pyo3(signature = (mesh_h5, out_path, length_unit = "m", incompatible_modes = false))]
pub(crate) fn export_mesh(
    py: Python<'_>,
    mesh_h5: PathBuf,
    out_path: PathBuf,
    length_unit: &str,
    incompatible_modes: bool,
) -> PyResult<Vec<String>> {
    let options = DeckOptions {
        length_unit,
        metres_per_unit: metres_per(length_unit)?,
        incompatible_modes,
    };
    let format = MeshioFormat::to_write(py, &out_path)?;
    let mesh = py
        .detach(|| gearmesh_model::read_mesh(&mesh_h5))
        .map_err(file_error)?;

    // meshio looks at the ending of the name: the file gets its whole name in a folder of its own.
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
    match &format.name[..] {
        "abaqus" | "nastran" => {
            write_deck(&temporary_path, &mesh, &format, options).map_err(disk)?;
        }
        _ => {
            let outgoing = to_meshio(py, &mesh, &format, options.metres_per_unit)?;
            let text = temporary_path.to_string_lossy().into_owned();
            let meshio = py.import("meshio")?;
            let keywords = format.write_options(py)?;
            let written = meshio.call_method("write", (text, outgoing), Some(&keywords));
            written.map_err(|error| format.explain(py, "write", &out_path, error))?;
        }
    }

    let stored = from_meshio(
        py,
        &format.read(py, &temporary_path)?,
        &format,
        options.metres_per_unit,
    );
    let stored = stored
        .map_err(|error| format.explain(py, "read back", &out_path, error))?
        .0;
    if stored.cell_count() != mesh.cell_count() || stored.points.len() != mesh.points.len() {
        return Err(PyValueError::new_err(format!(
            "{}: {} files do not hold these volume elements ({} of {} came back); choose another format",
            out_path.display(),
            format.name,
            stored.cell_count(),
            mesh.cell_count()
        )));
    }
    std::fs::rename(&temporary_path, &out_path).map_err(disk)?;
    let set_kept = |name: &&String| {
        // Nastran's SET1 is written, but meshio does not read it.
        format.name == "nastran" || stored.point_sets.contains_key(*name)
    };
    let field_kept = |name: &&String| {
        stored.point_fields.contains_key(*name) || stored.cell_fields.contains_key(*name)
    };
    let sets = mesh.point_sets.keys().filter(|name| !set_kept(name));
    let fields = mesh.point_fields.keys().chain(mesh.cell_fields.keys());
    let fields = fields.filter(|name| !field_kept(name));
    Ok(sets.chain(fields).cloned().collect())
}

/// Writes a mesh as input of a finite element program.
fn write_deck(
    path: &Path,
    mesh: &MeshData,
    format: &MeshioFormat,
    options: DeckOptions<'_>,
) -> std::io::Result<()> {
    let mut out = BufWriter::new(File::create(path)?);
    if format.name == "nastran" {
        write_nastran(&mut out, mesh, options)?;
    } else {
        write_abaqus(&mut out, mesh, options)?;
    }
    out.flush()
}

/// Reads any format that meshio reads into a mesh file: volume elements, node sets and fields.
///
/// Volume elements are hexahedra of 8 or 20 nodes, tetrahedra of 10, wedges of 6 or 15; others raise ValueError.
/// length_unit is the unit of the coordinates in the file that is read, "m" or "mm". Node sets are those of the file,
/// fields named "set:...", and the nodes of its sets of elements (Abaqus *ELSET, gmsh physical groups), also of surface
/// elements. These, line and point elements and nodes of no volume element are left out; returned is what was.
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
    if mesh.cell_count() == 0 {
        return Err(PyValueError::new_err(format!(
            "{}: there are no volume elements",
            in_path.display()
        )));
    }
    mesh.check_cells().map_err(mesh_error)?;
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

/// A `meshio.Mesh`; sets become fields.
fn to_meshio<'py>(
    py: Python<'py>,
    mesh: &MeshData,
    format: &MeshioFormat,
    metres_per_unit: f64,
) -> PyResult<Bound<'py, PyAny>> {
    let points = mesh
        .points
        .as_flattened()
        .iter()
        .map(|x| x / metres_per_unit)
        .collect();
    let points = PyArray1::<f64>::from_vec(py, points).reshape([mesh.points.len(), 3])?;
    let (point_data, cell_data) = (PyDict::new(py), PyDict::new(py));
    for (name, set) in &mesh.point_sets {
        let mut member = vec![0.0; mesh.points.len()];
        set.iter().for_each(|&node| member[node as usize] = 1.0);
        let name = format!("{SET_PREFIX}{name}");
        point_data.set_item(name, PyArray1::from_vec(py, member))?;
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
            if data.is(&point_data) {
                data.set_item(name, array)?;
                continue;
            }
            // Cell data of meshio is a list with one array a block of cells.
            let (blocks, mut first) = (PyList::empty(py), 0);
            for (kind, nodes) in &mesh.cells {
                let next = first + nodes.len() / kind.node_count();
                blocks.append(array.get_item(PySlice::new(
                    py,
                    first as isize,
                    next as isize,
                    1,
                ))?)?;
                first = next;
            }
            data.set_item(name, blocks)?;
        }
    }
    let options = PyDict::new(py);
    options.set_item("point_data", point_data)?;
    options.set_item("cell_data", cell_data)?;
    let cells = PyList::empty(py);
    for (kind, nodes) in &mesh.cells {
        let rows = nodes.iter().map(|&node| i64::from(node)).collect();
        let shape = [nodes.len() / kind.node_count(), kind.node_count()];
        let rows = PyArray1::<i64>::from_vec(py, rows).reshape(shape)?;
        cells.append((meshio_name(*kind), rows))?;
    }
    py.import("meshio")?
        .getattr("Mesh")?
        .call((points, cells), Some(&options))
}

/// What meshio calls a kind of element. It numbers the nodes of all of them as [`CellKind`] says, whatever the format.
const fn meshio_name(kind: CellKind) -> &'static str {
    match kind {
        CellKind::Hex8 => "hexahedron",
        CellKind::Hex20 => "hexahedron20",
        CellKind::Tet10 => "tetra10",
        CellKind::Wedge6 => "wedge",
        CellKind::Wedge15 => "wedge15",
    }
}

/// Why a volume element of meshio is refused.
fn refusal(kind: &str, count: usize) -> PyErr {
    let advice = match kind {
        "tetra" => {
            "linear tetrahedra are far too stiff in bending: save the mesh with quadratic elements (second order, tetra10)"
        }
        _ => {
            "allowed are hexahedra of 8 or 20 nodes, tetrahedra of 10, wedges of 6 or 15: mesh the body with them"
        }
    };
    PyValueError::new_err(format!("{count} {kind} cells; {advice}"))
}

/// The elements, sets and fields of a `meshio.Mesh`, and in words what was left out.
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
    let mut blocks_of: BTreeMap<CellKind, Vec<usize>> = BTreeMap::new();
    for (block, cells) in incoming.getattr("cells")?.try_iter()?.enumerate() {
        let cells = cells?;
        let name: String = cells.getattr("type")?.extract()?;
        let data = cells.getattr("data")?;
        let kind = CellKind::ALL.into_iter().find(|k| meshio_name(*k) == name);
        if let Some(kind) = kind {
            let rows = cell_rows(kind, &data.extract()?)?;
            mesh.cells.entry(kind).or_default().extend(rows);
            blocks_of.entry(kind).or_default().push(block);
        } else if cells.getattr("dim")?.extract::<usize>()? < 3 {
            left_out.push(format!("{} {name} cells", data.len()?));
        } else {
            return Err(refusal(&name, data.len()?));
        }
    }
    turn_wedges(&mut mesh);
    for (name, set) in incoming.getattr("point_sets")?.cast::<PyDict>()?.iter() {
        mesh.point_sets.insert(stored_name(&name)?, node_set(&set)?);
    }
    for (name, set) in element_sets(incoming)? {
        mesh.point_sets.entry(name).or_insert(set);
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
    for (name, data) in incoming.getattr("cell_data")?.cast::<PyDict>()?.iter() {
        let name = stored_name(&name)?;
        if name.starts_with(&own) {
            left_out.push(format!("cell data {name}"));
            continue;
        }
        let blocks = blocks_of.values().flatten();
        let of_cells = blocks
            .map(|&block| data.get_item(block))
            .collect::<PyResult<Vec<_>>>()?;
        if !of_cells.is_empty() {
            let joined = numpy.call_method1("concatenate", (of_cells,))?;
            mesh.cell_fields.insert(name, field(&field_rows(&joined)?));
        }
    }
    mesh.validate().map_err(mesh_error)?;
    let loose = mesh.remove_loose_points();
    if loose > 0 {
        left_out.push(format!("{loose} nodes of no volume element"));
    }
    Ok((mesh, left_out))
}

/// VTK's own program numbers the lower triangle of a wedge the other way round than Abaqus and gmsh; files of both
/// kinds go by the same name. Where all wedges of a mesh are inside out, upper and lower triangle are exchanged.
fn turn_wedges(mesh: &mut MeshData) {
    for (kind, halves) in [
        (CellKind::Wedge6, &[(0, 3)][..]),
        (CellKind::Wedge15, &[(0, 3), (6, 9)][..]),
    ] {
        let Some(nodes) = mesh.cells.get(&kind) else {
            continue;
        };
        let known = |cell: &[u32]| cell.iter().all(|n| (*n as usize) < mesh.points.len());
        let mut cells = nodes.chunks_exact(kind.node_count());
        if !cells.all(|cell| known(cell) && mesh.corner_jacobian_m3(kind, cell, 0) < 0.0) {
            continue;
        }
        for cell in mesh
            .cells
            .get_mut(&kind)
            .into_iter()
            .flat_map(|nodes| nodes.chunks_exact_mut(kind.node_count()))
        {
            for &(low, high) in halves {
                (0..3).for_each(|k| cell.swap(low + k, high + k));
            }
        }
    }
}

/// The nodes of each named set of elements: meshio's `cell_sets`, and in gmsh's older format the physical groups,
/// numbers of the elements whose names stand in `field_data`.
fn element_sets(incoming: &Bound<'_, PyAny>) -> PyResult<BTreeMap<String, Vec<u32>>> {
    let py = incoming.py();
    let mut sets: BTreeMap<String, Vec<u32>> = BTreeMap::new();
    let cells: Vec<Bound<'_, PyAny>> = incoming
        .getattr("cells")?
        .try_iter()?
        .collect::<PyResult<_>>()?;
    let mut add = |name: String, block: &Bound<'_, PyAny>, members: &Bound<'_, PyAny>| {
        let rows = block.getattr("data")?.get_item(members)?;
        let nodes: Vec<u32> = rows
            .call_method0("ravel")?
            .call_method0("tolist")?
            .extract()?;
        sets.entry(name).or_default().extend(nodes);
        Ok::<(), PyErr>(())
    };
    for (name, by_block) in incoming.getattr("cell_sets")?.cast::<PyDict>()?.iter() {
        let name = stored_name(&name)?;
        if name.starts_with("gmsh:") {
            continue;
        }
        for (block, members) in cells.iter().zip(by_block.try_iter()?) {
            let members = members?;
            if !members.is_none() && members.len()? > 0 {
                let members = members.call_method1("astype", ("int64",))?;
                add(name.clone(), block, &members)?;
            }
        }
    }
    let groups = incoming
        .getattr("cell_data")?
        .cast_into::<PyDict>()?
        .get_item("gmsh:physical")?;
    if let Some(groups) = groups {
        for (name, number_and_dimension) in incoming.getattr("field_data")?.cast::<PyDict>()?.iter()
        {
            let [number, dimension]: [i64; 2] =
                number_and_dimension.call_method0("tolist")?.extract()?;
            for (block, of_cell) in cells.iter().zip(groups.try_iter()?) {
                if block.getattr("dim")?.extract::<i64>()? == dimension {
                    let numpy = py.import("numpy")?;
                    let equal = numpy.call_method1("equal", (of_cell?, number))?;
                    add(stored_name(&name)?, block, &equal)?;
                }
            }
        }
    }
    for set in sets.values_mut() {
        set.sort_unstable();
        set.dedup();
    }
    Ok(sets)
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
