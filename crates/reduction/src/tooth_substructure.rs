//! One tooth cell, condensed to the nodes that it shares with the rest of the gear.
//!
//! All teeth have the same mesh, turned. In cylindrical components they have the same stiffness matrix too, so that one
//! condensation serves the whole gear: most of its degrees of freedom are eliminated here, once.

use crate::flank_loads::SparseVector;
use crate::part::Part;
use crate::repeated_mesh::RepeatedMesh;
use faer::Mat;
use gearmesh_fe::{
    CondensedLoads, CylindricalFrames, DofMap, FeError, FeModel, SparseMatrix, StaticCondensation,
    StiffnessMatrix, assemble_mass, assemble_stiffness,
};
use rayon::prelude::*;

/// The tooth cell and its condensation, in cylindrical components.
pub struct ToothSubstructure {
    /// Elements of the cell of tooth 0.
    elements: Vec<u32>,
    /// Cell of tooth 0 as nodes of the whole mesh, ascending.
    part: Vec<u32>,
    /// Nodes of the whole mesh of each tooth: the images of those of tooth 0.
    images: Vec<Vec<u32>>,
    /// Nodes of the cell that are shared with the rest of the gear.
    pub boundary: Vec<usize>,
    /// Stiffness of the cell, nothing fixed, three rows a node.
    pub stiffness: StiffnessMatrix,
    /// The condensation.
    pub condensation: StaticCondensation,
}

impl ToothSubstructure {
    /// Condenses the cell of tooth 0.
    ///
    /// # Errors
    /// [`FeError`] when the factorisation fails.
    pub fn new(mesh: &impl RepeatedMesh, model: &FeModel) -> Result<Self, FeError> {
        let elements = mesh.cell_elements(0);
        let part = Part::new(model, &elements)?;
        let own: Vec<Option<usize>> = mesh
            .cell_nodes(0)
            .into_iter()
            .map(|n| part.place(n))
            .collect();
        let images = (0..mesh.teeth())
            .map(|tooth| {
                let mut image = vec![0; part.nodes.len()];
                for (i, node) in own.iter().zip(mesh.cell_nodes(tooth)) {
                    if let &Some(i) = i {
                        image[i] = node;
                    }
                }
                image
            })
            .collect();
        let mut inside = vec![false; model.element_count()];
        for &e in &elements {
            inside[e as usize] = true;
        }
        let mut shared = vec![false; model.node_count()];
        for outside in (0..model.element_count()).filter(|&e| !inside[e]) {
            for &n in model.element_nodes(outside) {
                shared[n as usize] = true;
            }
        }
        let boundary: Vec<usize> = (0..part.nodes.len())
            .filter(|&i| shared[part.nodes[i] as usize])
            .collect();
        let dofs = DofMap::all_free(part.nodes.len())?;
        let mut stiffness = assemble_stiffness(&part.model, &dofs)?;
        CylindricalFrames::new(part.model.nodes().iter().copied()).turn_stiffness(&mut stiffness);
        let condensation = StaticCondensation::new(stiffness.clone(), &boundary)?;
        Ok(Self {
            elements,
            part: part.nodes,
            images,
            boundary,
            stiffness,
            condensation,
        })
    }

    /// Mass of the cell (kg), as [`ToothSubstructure::stiffness`].
    ///
    /// # Errors
    /// [`FeError::DensityOutOfRange`].
    pub fn mass(&self, model: &FeModel, density_kg_per_m3: f64) -> Result<SparseMatrix, FeError> {
        let part = Part::new(model, &self.elements)?;
        let dofs = DofMap::all_free(part.nodes.len())?;
        let mut mass = assemble_mass(&part.model, &dofs, density_kg_per_m3)?;
        CylindricalFrames::new(part.model.nodes().iter().copied()).turn_stiffness(&mut mass);
        Ok(mass)
    }

    /// Number of nodes of the cell.
    pub fn node_count(&self) -> usize {
        self.part.len()
    }

    /// Number of nodes shared with the rest of the gear.
    pub fn boundary_count(&self) -> usize {
        self.boundary.len()
    }

    /// Nodes of the whole mesh of the cell's nodes, on a tooth.
    pub fn nodes(&self, tooth: usize) -> &[u32] {
        &self.images[tooth]
    }

    /// Node of the whole mesh of the b-th shared node, on a tooth.
    pub fn boundary_node(&self, tooth: usize, b: usize) -> u32 {
        self.images[tooth][self.boundary[b]]
    }

    /// Vectors on tooth 0 carried to the shared nodes.
    pub fn condense(
        &self,
        frames: &CylindricalFrames,
        vectors: &[&SparseVector],
    ) -> CondensedLoads {
        let mut loads = Mat::zeros(self.condensation.size(), vectors.len());
        for (column, vector) in vectors.iter().enumerate() {
            for &(dof, value) in *vector {
                if let Ok(i) = self.part.binary_search(&((dof / 3) as u32)) {
                    add_turned(frames, dof, value, |axis, part| {
                        loads[(3 * i + axis, column)] += part;
                    });
                }
            }
        }
        self.condensation.condense(loads.as_ref())
    }

    /// Σ over the given teeth of XᵀKX for fields over the whole mesh, in Cartesian components.
    pub fn energy_products(&self, frames: &CylindricalFrames, fields: &[Vec<f64>]) -> Mat<f64> {
        energy_of_images(&self.images, &self.stiffness, frames, fields)
    }
}

/// Σ of XᵀKX over all images of a part, given by their nodes.
pub(crate) fn energy_of_images(
    images: &[Vec<u32>],
    stiffness: &SparseMatrix,
    frames: &CylindricalFrames,
    fields: &[Vec<f64>],
) -> Mat<f64> {
    let of_image = |nodes: &Vec<u32>| {
        let x = gather(frames, nodes, fields);
        x.transpose() * (stiffness.as_ref() * &x)
    };
    sum_in_order(images.par_iter().map(of_image).collect(), fields.len())
}

/// Sum of square matrices in their order: the same to the last bit, however many threads have made them.
fn sum_in_order(products: Vec<Mat<f64>>, size: usize) -> Mat<f64> {
    (products.into_iter()).fold(Mat::zeros(size, size), |sum, product| sum + product)
}

/// Splits one Cartesian entry of a vector into the cylindrical components of its node.
pub(crate) fn add_turned(
    frames: &CylindricalFrames,
    dof: usize,
    value: f64,
    mut add: impl FnMut(usize, f64),
) {
    let mut entry = [0.0; 3];
    entry[dof % 3] = value;
    for (axis, part) in frames
        .to_cylindrical(dof / 3, entry)
        .into_iter()
        .enumerate()
    {
        if part != 0.0 {
            add(axis, part);
        }
    }
}

/// Fields over the whole mesh at some nodes, in cylindrical components: 3·nodes × fields.
fn gather(frames: &CylindricalFrames, nodes: &[u32], fields: &[Vec<f64>]) -> Mat<f64> {
    let mut x = Mat::zeros(3 * nodes.len(), fields.len());
    for (column, field) in fields.iter().enumerate() {
        for (i, node) in nodes.iter().map(|&n| n as usize).enumerate() {
            let u = [field[3 * node], field[3 * node + 1], field[3 * node + 2]];
            for (axis, part) in frames.to_cylindrical(node, u).into_iter().enumerate() {
                x[(3 * i + axis, column)] = part;
            }
        }
    }
    x
}
