//! A gear that was meshed elsewhere: its bore, its teeth and the faces of their outlines.
//!
//! Node sets say which nodes lie on the bore and on each flank. Everything else follows from where nodes are: a face of
//! the boundary whose nodes all lie on the exact profile of a tooth belongs to its outline, and its place there, arc
//! length and z of each node, is that of the profile point at the same radius. So root fillets need no set.
//!
//! The tooth-only submodel is cut where the definition's own mesh would be cut ([`CutLine`]): elements with a corner
//! above the line belong to it, and their nodes on or below the line are held. In a mesh that has the line among its
//! edges this is the submodel of the tooth's own mesh; otherwise the cut is a staircase one element deep.

use crate::ReductionError;
use crate::imported_check::ImportCheck;
use crate::imported_error::Misfit;
use crate::imported_outline::outlines;
use crate::tooth_frame::{in_tooth, nearest_tooth};
use crate::toothed_mesh::{ToothParts, ToothedMesh};
use gearmesh_fe::{Element, ElementBlock, FeModel, Material};
use gearmesh_geometry::{Flank, GearDefinition, MeshedBody, ProfileCurve};
use gearmesh_mesh::{CutLine, OutlineFace};
use gearmesh_model::{CellKind, MeshData};

/// Margin \[modules\] by which a node on the cut counts as below it.
const CUT_MARGIN: f64 = 1e-6;

/// A gear that was meshed elsewhere.
pub struct ImportedMesh {
    /// The finite element model.
    pub model: FeModel,
    /// Nodes of the bore.
    pub bore: Vec<u32>,
    /// Where the tooth-only submodels are cut.
    pub cut: CutLine,
    /// Outline faces by tooth and side (right, left), by growing arc length.
    outlines: Vec<[Vec<OutlineFace>; 2]>,
    /// Elements of each tooth above the cut.
    tooth_elements: Vec<Vec<u32>>,
    /// Their nodes on or below the cut.
    cut_nodes: Vec<Vec<u32>>,
    /// Their nodes on the outline above the cut, by side.
    side_nodes: Vec<[Vec<u32>; 2]>,
}

impl ImportedMesh {
    /// Checks a mesh against the definition and finds its teeth.
    ///
    /// # Errors
    /// [`ReductionError::Imported`] that says what is missing or in the wrong place; [`ReductionError::Fe`] naming an
    /// element that is inside out.
    pub fn new(
        gear: &GearDefinition,
        body: &MeshedBody,
        mesh: MeshData,
    ) -> Result<Self, ReductionError> {
        let check = ImportCheck {
            gear,
            body,
            curve: ProfileCurve::new(&gear.profile),
            mesh: &mesh,
        };
        check.parts()?;
        let bore = check.bore()?;
        let flanks = check.flanks()?;
        let model = fe_model(&check)?;
        let outlines = outlines(&check, &model);
        check.coverage(&outlines, &flanks)?;
        let mut imported = Self {
            model,
            bore,
            cut: CutLine::new(gear),
            outlines,
            tooth_elements: Vec::new(),
            cut_nodes: Vec::new(),
            side_nodes: Vec::new(),
        };
        imported.find_teeth(gear);
        Ok(imported)
    }

    /// Elements above the cut, which of their nodes hold them.
    fn find_teeth(&mut self, gear: &GearDefinition) {
        let (teeth, nodes) = (gear.tooth.teeth, self.model.nodes());
        let margin = CUT_MARGIN * gear.tooth.module_m;
        // The tooth above whose cut a node lies, if any.
        let above: Vec<Option<usize>> = nodes
            .iter()
            .map(|x| {
                let tooth = nearest_tooth(*x, teeth);
                let point = in_tooth(*x, tooth, teeth, Flank::Right);
                (!self.cut.is_below(point, margin)).then_some(tooth)
            })
            .collect();
        let mut elements = vec![Vec::new(); teeth];
        for e in 0..self.model.element_count() {
            let mut own = self.model.element_nodes(e).iter();
            if let Some(tooth) = own.find_map(|n| above[*n as usize]) {
                elements[tooth].push(e as u32);
            }
        }
        for (tooth, elements) in elements.into_iter().enumerate() {
            let of_tooth = elements
                .iter()
                .flat_map(|&e| self.model.element_nodes(e as usize));
            let mut below: Vec<u32> = of_tooth
                .copied()
                .filter(|n| above[*n as usize].is_none())
                .collect();
            below.sort_unstable();
            below.dedup();
            let sides = Flank::ALL.map(|side| {
                let faces = &self.outlines[tooth][side as usize];
                let mut on_side: Vec<u32> = faces
                    .iter()
                    .flat_map(|face| face.nodes.iter().copied())
                    .filter(|n| above[*n as usize].is_some())
                    .collect();
                on_side.sort_unstable();
                on_side.dedup();
                on_side
            });
            self.tooth_elements.push(elements);
            self.cut_nodes.push(below);
            self.side_nodes.push(sides);
        }
    }
}

impl ToothedMesh for ImportedMesh {
    fn outline_faces(&self, tooth: usize, side: Flank, arc_m: [f64; 2]) -> Vec<OutlineFace> {
        let faces = self.outlines[tooth][side as usize].iter();
        let inside = |face: &&OutlineFace| {
            let [from, to] = face.range_m(0);
            to > arc_m[0] && from < arc_m[1]
        };
        faces.filter(inside).cloned().collect()
    }

    fn twist_rad_per_m(&self) -> f64 {
        0.0
    }
}

impl ToothParts for ImportedMesh {
    fn tooth_elements(&self, tooth: usize) -> Vec<u32> {
        self.tooth_elements[tooth].clone()
    }

    fn tooth_supports(&self, tooth: usize, loaded: Flank) -> Vec<u32> {
        let opposite = &self.side_nodes[tooth][loaded.opposite() as usize];
        let mut nodes = [&self.cut_nodes[tooth][..], &opposite[..]].concat();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }
}

/// The finite element model; eight-node hexahedra take the formulation of the definition.
fn fe_model(check: &ImportCheck<'_>) -> Result<FeModel, ReductionError> {
    let named = check.gear.mesh.element;
    let has = |kind| check.mesh.cells.contains_key(&kind);
    let fits = match named {
        // The default, which says nothing.
        Element::Hex8Incompatible => true,
        _ => has(named.cell()),
    };
    if !fits {
        let found: Vec<&str> = check.mesh.cells.keys().map(|kind| kind.name()).collect();
        return Err(ReductionError::Imported(check.misfit(Misfit::Element {
            element: named.name(),
            found: found.join(" and "),
        })));
    }
    let blocks = check.mesh.cells.iter().map(|(kind, nodes)| ElementBlock {
        element: match (kind, named) {
            (CellKind::Hex8, Element::Hex8) => Element::Hex8,
            (CellKind::Hex8, _) => Element::Hex8Incompatible,
            (CellKind::Hex20, _) => Element::Hex20,
            (CellKind::Tet10, _) => Element::Tet10,
            (CellKind::Wedge6, _) => Element::Wedge6,
            (CellKind::Wedge15, _) => Element::Wedge15,
        },
        nodes: nodes.clone(),
    });
    let material = &check.gear.material;
    Ok(FeModel::from_blocks(
        check.mesh.points.clone(),
        blocks.collect(),
        Material::new(material.young_pa, material.poisson)?,
    )?)
}
