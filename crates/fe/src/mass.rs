//! Consistent mass matrix: M_ij = ∫ ρ N_i N_j dV in each of the three directions.
//!
//! Integrated by [`ElementFormulas::mass_points`]: exact for any hexahedron with eight nodes and any wedge with six,
//! and for straight-edged elements with more nodes. The condensed modes of the incompatible element carry no mass: they
//! are inner unknowns of its stiffness only.

use faer::{Mat, MatRef};
use rayon::prelude::*;

use crate::assembly::assemble;
use crate::compressed_columns::SparseMatrix;
use crate::constraints::DofMap;
use crate::element::ElementFormulas;
use crate::element_matrix::ElementMatrix;
use crate::error::FeError;
use crate::graph::NodeGraph;
use crate::model::FeModel;
use crate::shape_table::ShapeTable;

/// Mass matrix M (free x free, kg) of a model of one density (kg/m³) under constraints.
///
/// It has the pattern of the stiffness, zeros between directions included, so that one symbolic factor serves both and
/// K + s M is a sum of two lists of values.
///
/// # Errors
/// [`FeError::DensityOutOfRange`]; [`FeError::SizeMismatch`] when the constraints belong to another model;
/// [`FeError::Element`].
pub fn assemble_mass(
    model: &FeModel,
    dofs: &DofMap,
    density_kg_per_m3: f64,
) -> Result<SparseMatrix, FeError> {
    check_density(density_kg_per_m3)?;
    assemble(model, dofs, &NodeGraph::new(model, dofs)?, |element| {
        element_mass(model, element, density_kg_per_m3)
    })
}

/// M X (3 n × columns) over all degrees of freedom of a model, held or not, element by element: for the few products
/// that need no matrix, such as those with rigid motions.
///
/// # Errors
/// [`FeError::DensityOutOfRange`]; [`FeError::SizeMismatch`] when X has other rows; [`FeError::Element`].
pub fn mass_product(
    model: &FeModel,
    density_kg_per_m3: f64,
    x: MatRef<'_, f64>,
) -> Result<Mat<f64>, FeError> {
    check_density(density_kg_per_m3)?;
    product_by_elements(model, x, |element| {
        element_mass(model, element, density_kg_per_m3)
    })
}

/// K X over all degrees of freedom of a model, held or not, element by element: the forces on all nodes (N) that go
/// with displacements X (m).
///
/// # Errors
/// [`FeError::SizeMismatch`] when X has other rows; [`FeError::Element`].
pub fn stiffness_product(model: &FeModel, x: MatRef<'_, f64>) -> Result<Mat<f64>, FeError> {
    product_by_elements(model, x, |element| model.element_stiffness(element))
}

/// Sum over all elements of their matrix times X.
fn product_by_elements(
    model: &FeModel,
    x: MatRef<'_, f64>,
    matrix_of: impl Fn(usize) -> Result<ElementMatrix, FeError> + Sync,
) -> Result<Mat<f64>, FeError> {
    FeError::check_size(
        "the vectors for the matrix of a model",
        x.nrows(),
        model.dof_count(),
    )?;
    let mut product = Mat::zeros(x.nrows(), x.ncols());
    // Elements in parallel, sums always in their order.
    for chunk in (0..model.element_count()).collect::<Vec<_>>().chunks(8192) {
        let parts = chunk
            .par_iter()
            .map(|&element| {
                let dofs = model.element_dofs(element)?;
                let matrix = matrix_of(element)?;
                let part = Mat::from_fn(dofs.len(), x.ncols(), |i, column| {
                    (0..dofs.len())
                        .map(|j| matrix[(i, j)] * x[(dofs[j], column)])
                        .sum::<f64>()
                });
                Ok((dofs, part))
            })
            .collect::<Result<Vec<_>, FeError>>()?;
        for (dofs, part) in &parts {
            for column in 0..x.ncols() {
                for (i, &dof) in dofs.iter().enumerate() {
                    product[(dof, column)] += part[(i, column)];
                }
            }
        }
    }
    Ok(product)
}

/// Mass moments ρ∫(1, x, y, z, x², y², z², xy, yz, zx) dV of a model of one density, from the same points as M: RᵀMR of
/// the rigid motions R without a matrix, because they are linear in x as the shape functions are.
///
/// # Errors
/// [`FeError::DensityOutOfRange`]; [`FeError::Element`].
pub fn mass_moments(model: &FeModel, density_kg_per_m3: f64) -> Result<[f64; 10], FeError> {
    check_density(density_kg_per_m3)?;
    let of_element = |element: usize| {
        let kind = model.element_of(element);
        let coordinates = model.element_coordinates(element)?;
        let mut sums = [0.0; 10];
        for found in ShapeTable::of_mass(kind).volumes(&coordinates) {
            let (volume, shape) = found.map_err(|source| FeError::Element { element, source })?;
            let mass = density_kg_per_m3 * volume;
            let [x, y, z] = std::array::from_fn(|k| {
                let terms = shape.iter().zip(&coordinates).map(|(n, c)| n * c[k]);
                terms.sum::<f64>()
            });
            for (sum, part) in
                (sums.iter_mut()).zip([1.0, x, y, z, x * x, y * y, z * z, x * y, y * z, z * x])
            {
                *sum += mass * part;
            }
        }
        Ok(sums)
    };
    // Elements in parallel, sums always in their order.
    let elements: Vec<usize> = (0..model.element_count()).collect();
    let parts = elements.par_iter().map(|&element| of_element(element));
    let parts = parts.collect::<Result<Vec<_>, FeError>>()?;
    Ok(parts.iter().fold([0.0; 10], |sums, part| {
        std::array::from_fn(|k| sums[k] + part[k])
    }))
}

fn element_mass(
    model: &FeModel,
    element: usize,
    density_kg_per_m3: f64,
) -> Result<ElementMatrix, FeError> {
    model
        .element_of(element)
        .mass(&model.element_coordinates(element)?, density_kg_per_m3)
        .map_err(|source| FeError::Element { element, source })
}

fn check_density(density_kg_per_m3: f64) -> Result<(), FeError> {
    if density_kg_per_m3 > 0.0 && density_kg_per_m3.is_finite() {
        Ok(())
    } else {
        Err(FeError::DensityOutOfRange { density_kg_per_m3 })
    }
}
