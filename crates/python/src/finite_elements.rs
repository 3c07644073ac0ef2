//! Stiffness, mass, displacements, strains and natural modes of the body in a mesh file.
//!
//! Degree of freedom 3 n + a is the displacement of node n along axis a.

use std::path::{Path, PathBuf};

use gearmesh_fe::{
    DofMap, Element, ElementBlock, ElementFormulas, Factor, FeModel, Material, ModeSettings,
    SparseMatrix, assemble_mass, assemble_stiffness, natural_modes as search_modes,
};
use gearmesh_model::CellKind;
use numpy::{AllowTypeChange, PyArray1, PyArray2, PyArray3, PyArrayLike2, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::errors::{fe_error, file_error};

type FloatRows<'py> = PyArrayLike2<'py, f64, AllowTypeChange>;

/// Values, row indices and column pointers of a sparse matrix.
type CompressedColumns<'py> = (
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<i64>>,
    Bound<'py, PyArray1<i64>>,
);

/// Frequencies, shapes and residuals.
type NaturalModes<'py> = (
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray3<f64>>,
    Bound<'py, PyArray1<f64>>,
);

/// Stiffness (N/m) of a body over all its degrees of freedom, nothing held: (data, row_indices, column_pointers).
///
/// Both triangles are stored, by columns: scipy.sparse.csc_matrix takes the tuple as it is. Young's modulus in Pa;
/// element is "hex8", "hex8-incompatible", "hex20", "tet10", "wedge6" or "wedge15", one that the mesh has; other
/// elements of the mesh keep the formulation of their kind. Degree of freedom 3 n + a is the displacement of node n
/// along axis a.
#[pyfunction]
#[pyo3(signature = (mesh_h5, young_pa, poisson, element = "hex8-incompatible"))]
pub(crate) fn stiffness<'py>(
    py: Python<'py>,
    mesh_h5: PathBuf,
    young_pa: f64,
    poisson: f64,
    element: &str,
) -> PyResult<CompressedColumns<'py>> {
    let k = py.detach(|| {
        let model = model(&mesh_h5, young_pa, poisson, element)?;
        let dofs = DofMap::all_free(model.node_count()).map_err(fe_error)?;
        assemble_stiffness(&model, &dofs).map_err(fe_error)
    })?;
    Ok(compressed_columns(py, &k))
}

/// Consistent mass (kg) of a body over all its degrees of freedom: (data, row_indices, column_pointers) as stiffness.
///
/// Density in kg/m3. The condensed modes of "hex8-incompatible" carry no mass: it has the mass of "hex8".
#[pyfunction]
#[pyo3(signature = (mesh_h5, density_kg_per_m3, element = "hex8-incompatible"))]
pub(crate) fn mass<'py>(
    py: Python<'py>,
    mesh_h5: PathBuf,
    density_kg_per_m3: f64,
    element: &str,
) -> PyResult<CompressedColumns<'py>> {
    let m = py.detach(|| {
        // The mass asks nothing of the elastic constants.
        let model = model(&mesh_h5, 1.0, 0.0, element)?;
        let dofs = DofMap::all_free(model.node_count()).map_err(fe_error)?;
        assemble_mass(&model, &dofs, density_kg_per_m3).map_err(fe_error)
    })?;
    Ok(compressed_columns(py, &m))
}

/// Frequencies (count,) in Hz, shapes (count, n, 3) and relative residuals (count,) of the lowest natural modes.
///
/// The listed nodes are held. A shape has modal mass 1: its unit is kg^-1/2. A residual is
/// |K phi - w^2 M phi| / (w^2 |M phi|). The other arguments are those of stiffness.
#[pyfunction]
#[allow(clippy::too_many_arguments, reason = "Python's keyword arguments")]
pub(crate) fn natural_modes<'py>(
    py: Python<'py>,
    mesh_h5: PathBuf,
    young_pa: f64,
    poisson: f64,
    density_kg_per_m3: f64,
    element: &str,
    fixed_nodes: Vec<i64>,
    count: usize,
) -> PyResult<NaturalModes<'py>> {
    let (modes, shapes, nodes) = py.detach(|| {
        let model = model(&mesh_h5, young_pa, poisson, element)?;
        let fixed = node_indices(&fixed_nodes, &model)?;
        let dofs = DofMap::with_fixed_nodes(model.node_count(), &fixed).map_err(fe_error)?;
        let k = assemble_stiffness(&model, &dofs).map_err(fe_error)?;
        let m = assemble_mass(&model, &dofs, density_kg_per_m3).map_err(fe_error)?;
        let factor = Factor::of_model(&model, &dofs, &k).map_err(fe_error)?;
        let modes = search_modes(&k, &m, &factor, &ModeSettings::new(count)).map_err(fe_error)?;
        let shapes: Vec<f64> = (0..count)
            .flat_map(|mode| {
                let free: Vec<f64> = modes.shapes.col(mode).iter().copied().collect();
                dofs.expand(&free)
            })
            .collect();
        Ok::<_, PyErr>((modes, shapes, model.node_count()))
    })?;
    Ok((
        PyArray1::from_vec(py, modes.frequencies_hz()),
        PyArray1::from_vec(py, shapes).reshape([count, nodes, 3])?,
        PyArray1::from_vec(py, modes.relative_residuals),
    ))
}

/// The arrays of a sparse matrix; SciPy knows signed indices only.
fn compressed_columns<'py>(py: Python<'py>, matrix: &SparseMatrix) -> CompressedColumns<'py> {
    let signed = |indices: &[usize]| {
        let indices = indices.iter().map(|&index| index as i64).collect();
        PyArray1::<i64>::from_vec(py, indices)
    };
    (
        PyArray1::from_slice(py, matrix.val()),
        signed(matrix.symbolic().row_idx()),
        signed(matrix.symbolic().col_ptr()),
    )
}

/// Displacement (n, 3) in metres of a body under nodal forces (n, 3) in newtons, with the listed nodes held.
///
/// A force on a held node goes into its support. The other arguments are those of stiffness.
#[pyfunction]
pub(crate) fn solve<'py>(
    py: Python<'py>,
    mesh_h5: PathBuf,
    young_pa: f64,
    poisson: f64,
    element: &str,
    fixed_nodes: Vec<i64>,
    force: FloatRows<'py>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let (shape, force) = (shape(&force), values(&force));
    let displacement = py.detach(|| {
        let model = model(&mesh_h5, young_pa, poisson, element)?;
        check_node_rows("force", shape, &force, &model)?;
        let fixed = node_indices(&fixed_nodes, &model)?;
        let dofs = DofMap::with_fixed_nodes(model.node_count(), &fixed).map_err(fe_error)?;
        let k = assemble_stiffness(&model, &dofs).map_err(fe_error)?;
        let factor = Factor::of_model(&model, &dofs, &k).map_err(fe_error)?;
        let mut displacement = dofs.restrict(&force);
        factor.solve_slice_in_place(&mut displacement);
        Ok::<_, PyErr>(dofs.expand(&displacement))
    })?;
    PyArray1::from_vec(py, displacement).reshape(shape)
}

/// Strain (m, 6) of every element from the displacement (n, 3) in metres of its nodes.
///
/// The columns are xx, yy, zz, xy, yz, xz with engineering shear. natural is the point of each element in its own
/// coordinates (hexahedra -1 to 1, tetrahedra and triangles of wedges 0 to 1); the default is each element's centre.
/// The condensed modes of "hex8-incompatible" are part of the strain; they vanish at the centre. The other arguments
/// are those of stiffness.
#[pyfunction]
#[pyo3(signature = (mesh_h5, young_pa, poisson, element, displacement, natural = None))]
pub(crate) fn strain<'py>(
    py: Python<'py>,
    mesh_h5: PathBuf,
    young_pa: f64,
    poisson: f64,
    element: &str,
    displacement: FloatRows<'py>,
    natural: Option<[f64; 3]>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    if let Some(natural) = natural
        && !natural.iter().all(|x| (-1.0..=1.0).contains(x))
    {
        return Err(PyValueError::new_err(format!(
            "the natural point is {natural:?}; its coordinates run from -1 to 1"
        )));
    }
    let (shape, displacement) = (shape(&displacement), values(&displacement));
    let rows = py.detach(|| {
        let model = model(&mesh_h5, young_pa, poisson, element)?;
        check_node_rows("displacement", shape, &displacement, &model)?;
        (0..model.element_count())
            .map(|e| {
                let at = natural.unwrap_or_else(|| model.element_of(e).centre());
                model.strain(e, at, &displacement).map_err(fe_error)
            })
            .collect::<PyResult<Vec<_>>>()
    })?;
    PyArray1::from_slice(py, rows.as_flattened()).reshape([rows.len(), 6])
}

/// The model of the body in a mesh file. The wedges beside hexahedra have the order of these, their formulation has no
/// choice.
fn model(mesh_h5: &Path, young_pa: f64, poisson: f64, element: &str) -> PyResult<FeModel> {
    let names = Element::ALL.map(|e| format!("{:?}", e.name()));
    let named = Element::from_name(element).ok_or_else(|| {
        let message = format!(
            "the element is {element:?}; it must be one of {}",
            names.join(", ")
        );
        PyValueError::new_err(message)
    })?;
    let material = Material::new(young_pa, poisson).map_err(fe_error)?;
    let mesh = gearmesh_model::read_mesh(mesh_h5).map_err(file_error)?;
    let mut unused = true;
    let blocks = mesh.cells.into_iter().map(|(kind, nodes)| {
        let own = match kind {
            CellKind::Hex8 => Element::Hex8,
            CellKind::Hex20 => Element::Hex20,
            CellKind::Tet10 => Element::Tet10,
            CellKind::Wedge6 => Element::Wedge6,
            CellKind::Wedge15 => Element::Wedge15,
        };
        // Eight nodes leave a choice.
        let element = match (own, named) {
            (Element::Hex8, Element::Hex8Incompatible) => named,
            _ => own,
        };
        unused &= element != named;
        ElementBlock { element, nodes }
    });
    let blocks: Vec<ElementBlock> = blocks.collect();
    if unused {
        let found: Vec<&str> = blocks.iter().map(|block| block.element.name()).collect();
        let message = format!(
            "the mesh has the elements {}; {element} is not among them",
            found.join(", ")
        );
        return Err(PyValueError::new_err(message));
    }
    FeModel::from_blocks(mesh.points, blocks, material).map_err(fe_error)
}

fn shape(array: &FloatRows<'_>) -> [usize; 2] {
    array.as_array().dim().into()
}

/// The entries row by row, whatever their order in memory.
fn values(array: &FloatRows<'_>) -> Vec<f64> {
    array.as_array().iter().copied().collect()
}

/// Checks that an array has one row of three finite numbers for each node.
fn check_node_rows(name: &str, shape: [usize; 2], values: &[f64], model: &FeModel) -> PyResult<()> {
    let nodes = model.node_count();
    if shape != [nodes, 3] {
        let message = format!("{name} has the shape {shape:?}; the mesh needs [{nodes}, 3]");
        return Err(PyValueError::new_err(message));
    }
    match values.iter().position(|value| !value.is_finite()) {
        Some(place) => Err(PyValueError::new_err(format!(
            "{name} of node {} is {}; all must be finite",
            place / 3,
            values[place]
        ))),
        None => Ok(()),
    }
}

fn node_indices(nodes: &[i64], model: &FeModel) -> PyResult<Vec<usize>> {
    let in_range = |&node: &i64| {
        usize::try_from(node)
            .ok()
            .filter(|&index| index < model.node_count())
            .ok_or_else(|| {
                PyValueError::new_err(format!(
                    "node {node} is to be held; the mesh has the nodes 0 to {}",
                    model.node_count() - 1
                ))
            })
    };
    nodes.iter().map(in_range).collect()
}
