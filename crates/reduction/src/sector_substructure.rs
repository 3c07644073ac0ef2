//! One sector: its part of hub, web and rim with the condensed teeth on it, condensed to its two cuts.

use crate::Progress;
use crate::part::Part;
use crate::repeated_mesh::RepeatedMesh;
use crate::sector_condensation::SectorCondensation;
use crate::sector_stiffness::sector_stiffness;
use crate::separating_circle::separating_circle;
use crate::tooth_substructure::{ToothSubstructure, energy_of_images};
use faer::sparse::SparseColMatRef;
use faer::{Mat, MatRef};
use gearmesh_fe::{
    CylindricalFrames, DofMap, FeError, FeModel, SparseMatrix, StaticCondensation, StiffnessMatrix,
    SymbolicFactor, assemble_mass, assemble_stiffness,
};

/// A node of the sector, told so that its image in every sector can be found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum SectorNode {
    /// A node that a tooth shares with its surroundings: number of the tooth in the sector, number of the node.
    Tooth(usize, usize),
    /// A node of hub, web or rim: number in [`RepeatedMesh::body_nodes`].
    Body(usize),
}

/// The sector and its condensation, in cylindrical components.
pub struct SectorSubstructure {
    /// Sectors of the gear, teeth of a sector, first tooth of sector 0.
    pub sectors: usize,
    /// Teeth of a sector.
    pub own: usize,
    first_tooth: usize,
    /// Nodes of the whole mesh of each sector: the images of those of sector 0, which ascend.
    images: Vec<Vec<u32>>,
    /// Sector node of each shared node of each of its teeth.
    tooth_nodes: Vec<Vec<usize>>,
    /// Elements of the body alone.
    body_elements: Vec<u32>,
    /// Nodes of the cuts R (before its first tooth) and L (its image, behind the last one); none in a single sector.
    pub cuts: [Vec<usize>; 2],
    /// Stiffness of hub, web and rim without the tooth cells, three rows for each of
    /// [`SectorSubstructure::body_nodes`].
    pub body_stiffness: StiffnessMatrix,
    /// Sector nodes of hub, web and rim.
    pub body_nodes: Vec<usize>,
    /// The condensation.
    pub condensation: SectorCondensation,
}

/// Nodes of sector 0 that are free, by their numbers, and what they are: the feet of its teeth, and its body.
fn sector_nodes(
    mesh: &impl RepeatedMesh,
    tooth: &ToothSubstructure,
    fixed: &[bool],
    body: &Part,
) -> Vec<SectorNode> {
    let teeth = mesh.teeth();
    let mut listed: Vec<(u32, SectorNode)> = Vec::new();
    for a in 0..teeth / mesh.sectors() {
        listed.extend((0..tooth.boundary_count()).map(|b| {
            let node = tooth.boundary_node((mesh.first_tooth() + a) % teeth, b);
            (node, SectorNode::Tooth(a, b))
        }));
    }
    let body_nodes = mesh.body_nodes(0).into_iter().enumerate();
    listed.extend(body_nodes.map(|(i, node)| (node, SectorNode::Body(i))));
    // Stable: where several names fit, that of the first tooth is kept.
    listed.sort_by_key(|(node, _)| *node);
    listed.dedup_by_key(|(node, _)| *node);
    // Where the ring is outside the web its nodes belong to teeth only.
    listed.retain(|(node, name)| {
        !fixed[*node as usize]
            && (matches!(name, SectorNode::Tooth(..)) || body.place(*node).is_some())
    });
    listed.into_iter().map(|(_, name)| name).collect()
}

/// Body and feet condensed to the nodes of the cuts, of a whole gear by its ring where that pays. `nodes`: number of
/// nodes of the sector. `circle`: nodes that are eliminated late in a whole gear.
fn condensed(
    (body, body_nodes): (SparseColMatRef<'_, usize, f64>, &[usize]),
    (foot, tooth_nodes): (MatRef<'_, f64>, &[Vec<usize>]),
    (nodes, cuts, is_whole): (usize, &[usize], bool),
    circle: impl FnOnce() -> Vec<usize>,
    progress: &dyn Progress,
) -> Result<SectorCondensation, FeError> {
    if is_whole
        && let Some(ringed) =
            SectorCondensation::ringed((body, body_nodes), (foot, tooth_nodes), progress)?
    {
        return Ok(ringed);
    }
    let feet = (|i, j| foot[(i, j)], tooth_nodes);
    let stiffness = sector_stiffness(nodes, (body, body_nodes), feet)?;
    let late = if is_whole { circle() } else { Vec::new() };
    let before = |symbolic: &SymbolicFactor| progress.expect(symbolic.expected_seconds());
    let at_once = StaticCondensation::announced(stiffness, &late, cuts, before)?;
    Ok(SectorCondensation::AtOnce(Box::new(at_once)))
}

impl SectorSubstructure {
    /// Condenses sector 0 to the cuts R (before its first tooth) and L (its image, behind the last one).
    ///
    /// # Errors
    /// [`FeError`] when the factorisation fails.
    pub fn new(
        mesh: &impl RepeatedMesh,
        model: &FeModel,
        fixed: &[bool],
        tooth: &ToothSubstructure,
        progress: &dyn Progress,
    ) -> Result<Self, FeError> {
        let (sectors, teeth) = (mesh.sectors(), mesh.teeth());
        let own = teeth / sectors;
        let first_tooth = mesh.first_tooth();

        let body_elements = mesh.body_elements(0);
        let body = Part::new(model, &body_elements)?;
        let names = sector_nodes(mesh, tooth, fixed, &body);
        let images: Vec<Vec<u32>> = (0..sectors)
            .map(|sector| {
                let in_body = mesh.body_nodes(sector);
                names
                    .iter()
                    .map(|name| match *name {
                        SectorNode::Tooth(a, b) => {
                            tooth.boundary_node((first_tooth + sector * own + a) % teeth, b)
                        }
                        SectorNode::Body(i) => in_body[i],
                    })
                    .collect()
            })
            .collect();
        let place = |node: u32| images[0].binary_search(&node).ok();
        let tooth_nodes: Vec<Vec<usize>> = (0..own)
            .map(|a| {
                (0..tooth.boundary_count())
                    .filter_map(|b| place(tooth.boundary_node((first_tooth + a) % teeth, b)))
                    .collect()
            })
            .collect();

        let dofs = free_dofs(&body, fixed)?;
        let mut body_stiffness = assemble_stiffness(&body.model, &dofs)?;
        frames(&body, mesh, fixed).turn_stiffness(&mut body_stiffness);
        let body_nodes: Vec<usize> = free_nodes(&body, fixed).filter_map(place).collect();

        let cuts = if sectors == 1 {
            [Vec::new(), Vec::new()]
        } else {
            [0, 1].map(|sector| {
                let nodes = mesh.cut_nodes(sector).into_iter();
                nodes.filter_map(place).collect::<Vec<_>>()
            })
        };
        let condensation = condensed(
            (body_stiffness.as_ref(), &body_nodes),
            (tooth.condensation.stiffness(), &tooth_nodes),
            (images[0].len(), &cuts.concat(), sectors == 1),
            || {
                let elements = body_elements.iter();
                let elements = elements.map(|&e| model.element_nodes(e as usize));
                let circle = separating_circle(mesh.nodes(), elements, |n| !fixed[n as usize]);
                circle.into_iter().filter_map(place).collect()
            },
            progress,
        )?;
        Ok(Self {
            sectors,
            own,
            first_tooth,
            images,
            tooth_nodes,
            body_elements,
            cuts,
            body_stiffness,
            body_nodes,
            condensation,
        })
    }

    /// Mass (kg) as [`SectorSubstructure::body_stiffness`].
    ///
    /// # Errors
    /// [`FeError::DensityOutOfRange`].
    pub fn body_mass(
        &self,
        mesh: &impl RepeatedMesh,
        model: &FeModel,
        fixed: &[bool],
        density_kg_per_m3: f64,
    ) -> Result<SparseMatrix, FeError> {
        let body = Part::new(model, &self.body_elements)?;
        let dofs = free_dofs(&body, fixed)?;
        let mut mass = assemble_mass(&body.model, &dofs, density_kg_per_m3)?;
        frames(&body, mesh, fixed).turn_stiffness(&mut mass);
        Ok(mass)
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

    /// Number of nodes.
    pub fn node_count(&self) -> usize {
        self.images[0].len()
    }

    /// Sector nodes of what the a-th tooth shares with its surroundings.
    pub fn tooth_nodes(&self, a: usize) -> &[usize] {
        &self.tooth_nodes[a]
    }

    /// Nodes of the whole mesh of the sector's nodes, in a sector.
    pub fn nodes(&self, sector: usize) -> &[u32] {
        &self.images[sector]
    }

    /// Σ over all sectors of XᵀKX of hub, web and rim without the tooth cells.
    pub fn energy_products(&self, frames: &CylindricalFrames, fields: &[Vec<f64>]) -> Mat<f64> {
        let of_body = |image: &Vec<u32>| self.body_nodes.iter().map(|&i| image[i]).collect();
        let images: Vec<Vec<u32>> = self.images.iter().map(of_body).collect();
        energy_of_images(&images, &self.body_stiffness, frames, fields)
    }
}

/// Nodes of the whole mesh in a part that are not held.
fn free_nodes<'a>(body: &'a Part, fixed: &'a [bool]) -> impl Iterator<Item = u32> + 'a {
    let nodes = body.nodes.iter().copied();
    nodes.filter(|&n| !fixed[n as usize])
}

fn free_dofs(body: &Part, fixed: &[bool]) -> Result<DofMap, FeError> {
    let held: Vec<usize> = (0..body.nodes.len())
        .filter(|&i| fixed[body.nodes[i] as usize])
        .collect();
    DofMap::with_fixed_nodes(body.nodes.len(), &held)
}

fn frames(body: &Part, mesh: &impl RepeatedMesh, fixed: &[bool]) -> CylindricalFrames {
    CylindricalFrames::new(free_nodes(body, fixed).map(|n| mesh.nodes()[n as usize]))
}
