//! One sector: its part of hub, web and rim with the condensed teeth on it, condensed to its two cuts.

use crate::Progress;
use crate::part::Part;
use crate::tooth_substructure::{ToothSubstructure, gather};
use faer::Mat;
use faer::sparse::{SparseColMat, Triplet};
use gearmesh_fe::{
    CylindricalFrames, DofMap, FeError, FeModel, StaticCondensation, StiffnessMatrix,
    assemble_stiffness,
};
use gearmesh_mesh::GearMesh;
use rayon::prelude::*;

/// A node of the sector, told so that its image in every sector can be found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum SectorNode {
    /// A node that a tooth shares with its surroundings: number of the tooth in the sector, number of the node.
    Tooth(usize, usize),
    /// A node of the body sector and its plane.
    Body(usize, usize),
}

/// The sector and its condensation, in cylindrical components.
pub struct SectorSubstructure {
    /// Sectors of the gear, teeth of a sector, first tooth of sector 0.
    pub sectors: usize,
    /// Teeth of a sector.
    pub own: usize,
    first_tooth: usize,
    nodes: Vec<SectorNode>,
    /// Nodes of the whole mesh in sector 0, ascending.
    mesh_nodes: Vec<u32>,
    /// Sector node of each shared node of each of its teeth.
    tooth_nodes: Vec<Vec<usize>>,
    /// Stiffness of the body alone and its nodes among those of the sector.
    body_stiffness: StiffnessMatrix,
    body_nodes: Vec<usize>,
    condensation: StaticCondensation,
}

impl SectorSubstructure {
    /// Condenses sector 0 to the cuts R (before its first tooth) and L (its image, behind the last one).
    ///
    /// # Errors
    /// [`FeError`] when the factorisation fails.
    pub fn new(
        mesh: &GearMesh,
        model: &FeModel,
        fixed: &[bool],
        tooth: &ToothSubstructure,
        progress: &dyn Progress,
    ) -> Result<Self, FeError> {
        let section = &mesh.section;
        let sectors = section.body_quads.len();
        let teeth = section.cell_nodes.len();
        let own = teeth / sectors;
        let first_tooth = section.first_tooth;
        let planes = 0..mesh.layers.planes_m.len();

        let mut listed: Vec<(u32, SectorNode)> = Vec::new();
        for a in 0..own {
            listed.extend((0..tooth.boundary_count()).filter_map(|b| {
                let node = tooth.boundary_node(mesh, (first_tooth + a) % teeth, b)?;
                Some((node, SectorNode::Tooth(a, b)))
            }));
        }
        for (local, &n) in section.body_nodes[0].iter().enumerate() {
            for plane in planes.clone() {
                if let Some(node) = mesh.node(n, plane) {
                    listed.push((node, SectorNode::Body(local, plane)));
                }
            }
        }
        // Stable: where several names fit, that of the first tooth is kept.
        listed.sort_by_key(|(node, _)| *node);
        listed.dedup_by_key(|(node, _)| *node);
        // The cross-section holds ring nodes of body and teeth; those of the ring outside the web belong to teeth only.
        listed.retain(|(node, _)| !fixed[*node as usize]);
        let elements: Vec<u32> = section.body_quads[0]
            .clone()
            .flat_map(|q| (0..mesh.layers.count()).filter_map(move |layer| mesh.hex(q, layer)))
            .collect();
        let body = Part::new(model, &elements)?;
        listed.retain(|(node, name)| {
            matches!(name, SectorNode::Tooth(..)) || body.place(*node).is_some()
        });
        let (mesh_nodes, nodes): (Vec<u32>, Vec<SectorNode>) = listed.into_iter().unzip();
        let place = |node: u32| mesh_nodes.binary_search(&node).ok();
        let tooth_nodes: Vec<Vec<usize>> = (0..own)
            .map(|a| {
                (0..tooth.boundary_count())
                    .filter_map(|b| {
                        place(tooth.boundary_node(mesh, (first_tooth + a) % teeth, b)?)
                    })
                    .collect()
            })
            .collect();

        let held: Vec<usize> = (0..body.nodes.len())
            .filter(|&i| fixed[body.nodes[i] as usize])
            .collect();
        let dofs = DofMap::with_fixed_nodes(body.nodes.len(), &held)?;
        let mut body_stiffness = assemble_stiffness(&body.model, &dofs)?;
        let free = || body.nodes.iter().filter(|&&n| !fixed[n as usize]);
        CylindricalFrames::new(free().map(|&n| mesh.nodes[n as usize]))
            .turn_stiffness(&mut body_stiffness);
        let body_nodes: Vec<usize> = free().filter_map(|&n| place(n)).collect();

        let kept: Vec<usize> = if sectors == 1 {
            Vec::new()
        } else {
            let cut = |sector: usize| {
                let cell = &section.cell_nodes[(first_tooth + sector * own) % teeth];
                let cell = section.cell.right_side.iter().map(|&c| cell[c]);
                let body = &section.body_nodes[sector];
                let body = section.body_right_side.iter().map(|&c| body[c]);
                cell.chain(body)
                    .flat_map(|n| planes.clone().filter_map(move |plane| mesh.node(n, plane)))
                    .filter_map(place)
                    .collect::<Vec<_>>()
            };
            let (right, left) = (cut(0), cut(1));
            right.into_iter().chain(left).collect()
        };
        let stiffness = assemble(
            nodes.len(),
            &body_stiffness,
            &body_nodes,
            tooth,
            &tooth_nodes,
        )?;
        let condensation = StaticCondensation::announced(stiffness, &kept, |symbolic| {
            progress.expect(symbolic.expected_seconds())
        })?;
        Ok(Self {
            sectors,
            own,
            first_tooth,
            nodes,
            mesh_nodes,
            tooth_nodes,
            body_stiffness,
            body_nodes,
            condensation,
        })
    }

    /// The condensation.
    pub fn condensation(&self) -> &StaticCondensation {
        &self.condensation
    }

    /// Sector of a tooth and its number there.
    pub fn of_tooth(&self, tooth: usize) -> (usize, usize) {
        let teeth = self.sectors * self.own;
        let from_first = (tooth + teeth - self.first_tooth) % teeth;
        (from_first / self.own, from_first % self.own)
    }

    /// Tooth of a sector.
    pub fn tooth(&self, sector: usize, a: usize) -> usize {
        (self.first_tooth + sector * self.own + a) % (self.sectors * self.own)
    }

    /// Sector nodes of what the a-th tooth shares with its surroundings.
    pub fn tooth_nodes(&self, a: usize) -> &[usize] {
        &self.tooth_nodes[a]
    }

    /// Number of nodes.
    pub fn node_count(&self) -> usize {
        self.nodes.len()
    }

    /// Node of the whole mesh of the i-th sector node, in a sector.
    pub fn node(
        &self,
        mesh: &GearMesh,
        tooth: &ToothSubstructure,
        sector: usize,
        i: usize,
    ) -> Option<u32> {
        if sector == 0 {
            return Some(self.mesh_nodes[i]);
        }
        match self.nodes[i] {
            SectorNode::Tooth(a, b) => tooth.boundary_node(mesh, self.tooth(sector, a), b),
            SectorNode::Body(local, plane) => {
                mesh.node(mesh.section.body_nodes[sector][local], plane)
            }
        }
    }

    /// Σ over all sectors of XᵀKX of hub, web and rim without the tooth cells.
    pub fn energy_products(
        &self,
        mesh: &GearMesh,
        tooth: &ToothSubstructure,
        frames: &CylindricalFrames,
        fields: &[Vec<f64>],
    ) -> Mat<f64> {
        let zero = || Mat::<f64>::zeros(fields.len(), fields.len());
        (0..self.sectors)
            .into_par_iter()
            .map(|sector| {
                let nodes = self
                    .body_nodes
                    .iter()
                    .map(|&i| self.node(mesh, tooth, sector, i));
                let x = gather(frames, nodes, fields);
                x.transpose() * (self.body_stiffness.as_ref() * &x)
            })
            .reduce(zero, |a, b| a + b)
    }
}

/// Lower triangle of the sector's stiffness: the body's own and one dense block per tooth.
fn assemble(
    nodes: usize,
    body_stiffness: &StiffnessMatrix,
    body_nodes: &[usize],
    tooth: &ToothSubstructure,
    tooth_nodes: &[Vec<usize>],
) -> Result<StiffnessMatrix, FeError> {
    let block = tooth.condensation().stiffness();
    let dof = |nodes: &[usize], k: usize| 3 * nodes[k / 3] + k % 3;
    let body = body_stiffness.as_ref();
    let from_body = (0..body.ncols()).flat_map(|column| {
        body.row_idx_of_col(column)
            .zip(body.val_of_col(column))
            .map(move |(row, value)| (dof(body_nodes, row), dof(body_nodes, column), *value))
    });
    let from_teeth = tooth_nodes.iter().flat_map(|own| {
        (0..block.ncols()).flat_map(move |column| {
            (0..block.nrows())
                .map(move |row| (dof(own, row), dof(own, column), block[(row, column)]))
        })
    });
    let triplets: Vec<Triplet<usize, usize, f64>> = from_body
        .chain(from_teeth)
        .filter(|(row, column, _)| row >= column)
        .map(|(row, column, value)| Triplet::new(row, column, value))
        .collect();
    SparseColMat::try_new_from_triplets(3 * nodes, 3 * nodes, &triplets)
        .map_err(|_| FeError::OutOfMemory { bytes: 0 })
}
