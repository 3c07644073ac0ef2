//! One tooth with the ring below it, meshed: quads, their outline, edges and cut. Its blocks are those of
//! `tooth_blocks.rs`. Where the body does not repeat, what is between the ring and its openings is part of the cell.

use crate::body::BodyProblem;
use crate::plane_mesher::PlaneMesh;

/// The outline, its blocks and, after meshing, the quads of one tooth centred on +x.
#[derive(Debug, Clone)]
pub struct ToothCell {
    /// \[x, y\] \[m\].
    pub nodes: Vec<[f64; 2]>,
    /// Node numbers, counter-clockwise.
    pub quads: Vec<[usize; 4]>,
    /// Nodes in the middle of each quad's sides; empty where elements are linear.
    pub mid_sides: Vec<[usize; 4]>,
    /// Nodes in the middle of the quads themselves; only where they are split into tetrahedra.
    pub centres: Vec<usize>,
    /// True for quads of the tooth-only submodel.
    pub above_cut: Vec<bool>,
    /// True for quads that exist only in the web's layers.
    pub web_only: Vec<bool>,
    /// Nodes of the outline, from the right tooth space over the tip to the left one.
    pub outline: Vec<usize>,
    /// Arc length of those nodes from the right tooth space \[m\].
    pub outline_arc_m: Vec<f64>,
    /// Nodes in the middle of the pieces of the outline; empty where elements are linear.
    pub outline_mid_sides: Vec<usize>,
    /// Quad behind each piece of the outline.
    pub outline_quads: Vec<usize>,
    /// Nodes of the cut, from the right to the left outline, those in the middle of sides between the others.
    pub cut: Vec<usize>,
    /// Nodes of the cell's inner circle, counter-clockwise, likewise.
    pub bottom: Vec<usize>,
    /// Nodes of the right edge, outwards to inwards, likewise.
    pub right_side: Vec<usize>,
    /// Nodes of the left edge, outwards to inwards.
    pub left_side: Vec<usize>,
}

impl ToothCell {
    /// Adds what repeats with the teeth below the ring, one sector of it below each: its outer circle are the nodes of
    /// the cell's inner one.
    pub(crate) fn extend_below(&mut self, below: &BodyProblem, mesh: &PlaneMesh) {
        let mut place = vec![usize::MAX; mesh.nodes.len()];
        for (&local, &own) in below.ring.iter().zip(&self.bottom) {
            place[local] = own;
        }
        for (slot, &p) in place.iter_mut().zip(&mesh.nodes) {
            if *slot == usize::MAX {
                *slot = self.nodes.len();
                self.nodes.push(p);
            }
        }
        let onto = |list: &[usize]| list.iter().map(|&n| place[n]).collect::<Vec<_>>();
        self.quads
            .extend(mesh.quads.iter().map(|q| q.map(|n| place[n])));
        self.mid_sides
            .extend(mesh.mid_sides.iter().map(|m| m.map(|n| place[n])));
        self.above_cut.resize(self.quads.len(), false);
        self.web_only
            .extend(mesh.owners.iter().map(|&region| below.web_region[region]));
        self.right_side.extend(onto(&below.right_side));
        self.left_side.extend(onto(&below.left_side));
        self.bottom = onto(&below.bore);
    }
}
