//! The whole cross-section: tooth cells and body sectors copied round the axis and joined.

use crate::MeshError;
use crate::body::BodyProblem;
use crate::body_circles::first_tooth;
use crate::crack_line::CrackLine;
use crate::meshed_spans::MeshedSpans;
use crate::plane_mesher::{PlaneMesh, mesh_one};
use crate::python::PythonEnvironment;
use crate::ring_radius::ring_radius_m;
use crate::tooth_blocks::ToothBlocks;
use crate::tooth_cell::ToothCell;
use gearmesh_elements::CellKind;
use gearmesh_geometry::GearDefinition;
use std::f64::consts::TAU;
use std::ops::Range;

/// Quads of the full cross-section.
#[derive(Debug, Clone)]
pub struct Section {
    /// \[x, y\] \[m\].
    pub nodes: Vec<[f64; 2]>,
    /// Node numbers, counter-clockwise.
    pub quads: Vec<[usize; 4]>,
    /// Nodes in the middle of each quad's sides (side k from corner k to k + 1); empty where elements are linear.
    pub mid_sides: Vec<[usize; 4]>,
    /// Nodes in the middle of the quads; only where they are split into tetrahedra.
    pub centres: Vec<usize>,
    /// True for quads that exist only in the web's layers.
    pub web_only: Vec<bool>,
    /// Nodes of the bore.
    pub bore: Vec<usize>,
    /// The cell of tooth 0, in its own numbering.
    pub cell: ToothCell,
    /// Crack in the cell, where the gear has one; it is opened on one tooth only.
    pub crack: Option<CrackLine>,
    /// Section node of each cell node, by tooth.
    pub cell_nodes: Vec<Vec<usize>>,
    /// Section quad of the first cell quad, by tooth; the others follow.
    pub cell_first_quad: Vec<usize>,
    /// First tooth of sector 0; sector s begins teeth/sectors teeth further on for each sector.
    pub first_tooth: usize,
    /// Section node of each node of the body sector (hub, web, rim), by sector.
    pub body_nodes: Vec<Vec<usize>>,
    /// Body sector nodes on its edge at the smaller angle, outwards to inwards, without those on the ring; empty when
    /// there is one sector.
    pub body_right_side: Vec<usize>,
    /// Section quads of each body sector.
    pub body_quads: Vec<Range<usize>>,
}

/// The left side of each sector is the right side of the next.
fn join_sides(sectors: &mut [Vec<usize>], left_side: &[usize], right_side: &[usize]) {
    for sector in 0..sectors.len() {
        let next = (sector + 1) % sectors.len();
        for (&left, &right) in left_side.iter().zip(right_side) {
            sectors[sector][left] = sectors[next][right];
        }
    }
}

fn rotated(p: [f64; 2], angle: f64) -> [f64; 2] {
    let (s, c) = angle.sin_cos();
    [c * p[0] - s * p[1], s * p[0] + c * p[1]]
}

impl Section {
    /// Shape of the whole elements above its quads.
    pub const fn element_shape(&self) -> CellKind {
        if self.mid_sides.is_empty() {
            CellKind::Hex8
        } else {
            CellKind::Hex20
        }
    }

    /// Meshes one tooth and one sector of the body and copies them. Where elements are tetrahedra the body is not made
    /// of layers: then the section is that of the teeth alone.
    ///
    /// # Errors
    /// [`MeshError`] when gmsh is missing or fails, or when no sector can be cut.
    pub fn new(gear: &GearDefinition, python: &PythonEnvironment) -> Result<Self, MeshError> {
        let teeth = gear.tooth.teeth;
        let sectors = gear.sectors();
        let cell_problem = ToothBlocks::new(gear);
        let shape = gear.mesh.element.cell();
        if shape == CellKind::Tet10 {
            let mesh = mesh_one(python, &cell_problem.problem)?;
            let cell = cell_problem.finish(mesh, shape);
            return Ok(Self::of_teeth(cell, teeth, sectors, first_tooth(gear)?));
        }
        let ring_pieces = cell_problem.ring_pieces();
        let ring_size_m = ring_radius_m(gear) * TAU / (teeth * ring_pieces) as f64;
        let mut found = MeshedSpans::new(gear, python, &cell_problem, ring_size_m)?;
        let (span, body, body_mesh) = (&found.span, &mut found.body, &mut found.body_mesh);
        let mut cell = cell_problem.finish(found.cell_mesh, shape);
        let crack = gear.crack.as_ref();
        let crack = crack
            .map(|crack| CrackLine::new(&mut cell, gear, crack))
            .transpose()?;
        if shape == CellKind::Hex20 {
            body.make_quadratic(body_mesh);
        }
        if let Some((below, mesh)) = &mut found.below_teeth {
            if shape == CellKind::Hex20 {
                below.make_quadratic(mesh);
            }
            cell.extend_below(below, mesh);
        }
        let mut section = Self::of_teeth(cell, teeth, sectors, span.first_tooth);
        section.number_body(body, body_mesh);
        section.add_body(body, body_mesh);
        section.crack = crack;
        section.body_right_side = found.body.right_side;
        Ok(section)
    }

    /// Nodes of all sectors of the body: those of the ring are the cells', the left edge of each sector is the right
    /// edge of the next.
    fn number_body(&mut self, body: &BodyProblem, mesh: &PlaneMesh) {
        let (teeth, sectors) = (self.cell_nodes.len(), self.body_nodes.len());
        let ring_per_tooth = self.cell.bottom.len() - 1;
        self.body_nodes = vec![vec![usize::MAX; mesh.nodes.len()]; sectors];
        for (sector, map) in self.body_nodes.iter_mut().enumerate() {
            for (k, &local) in body.ring.iter().enumerate() {
                let tooth = self.first_tooth + sector * (teeth / sectors) + k / ring_per_tooth;
                let place = self.cell.bottom[k % ring_per_tooth];
                map[local] = self.cell_nodes[tooth % teeth][place];
            }
            for (local, &p) in mesh.nodes.iter().enumerate() {
                if map[local] == usize::MAX && !body.left_side.contains(&local) {
                    map[local] = self.nodes.len();
                    self.nodes
                        .push(rotated(p, TAU * sector as f64 / sectors as f64));
                }
            }
        }
        join_sides(&mut self.body_nodes, &body.left_side, &body.right_side);
    }

    /// Quads and bore of all sectors of the body.
    fn add_body(&mut self, body: &BodyProblem, mesh: &PlaneMesh) {
        self.body_quads.clear();
        for map in &self.body_nodes {
            let first = self.quads.len();
            self.body_quads.push(first..first + mesh.quads.len());
            (self.quads).extend(mesh.quads.iter().map(|q| q.map(|n| map[n])));
            (self.mid_sides).extend(mesh.mid_sides.iter().map(|m| m.map(|n| map[n])));
            let in_web = mesh.owners.iter().map(|&region| body.web_region[region]);
            self.web_only.extend(in_web);
            self.bore.extend(body.bore.iter().map(|&local| map[local]));
        }
        self.bore.sort_unstable();
        self.bore.dedup();
    }

    /// The cells of all teeth, joined; no body yet.
    fn of_teeth(cell: ToothCell, teeth: usize, sectors: usize, first_tooth: usize) -> Self {
        let mut nodes: Vec<[f64; 2]> = Vec::new();
        // Teeth: the left edge of each is the right edge of the next.
        let mut cell_nodes = vec![vec![usize::MAX; cell.nodes.len()]; teeth];
        for (tooth, map) in cell_nodes.iter_mut().enumerate() {
            for (local, &p) in cell.nodes.iter().enumerate() {
                if !cell.left_side.contains(&local) {
                    map[local] = nodes.len();
                    nodes.push(rotated(p, TAU * tooth as f64 / teeth as f64));
                }
            }
        }
        join_sides(&mut cell_nodes, &cell.left_side, &cell.right_side);
        let mut quads = Vec::with_capacity(teeth * cell.quads.len());
        let mut mid_sides = Vec::new();
        let mut centres = Vec::new();
        let mut web_only = Vec::with_capacity(teeth * cell.quads.len());
        let mut cell_first_quad = Vec::with_capacity(teeth);
        for map in &cell_nodes {
            cell_first_quad.push(quads.len());
            quads.extend(cell.quads.iter().map(|q| q.map(|n| map[n])));
            mid_sides.extend(cell.mid_sides.iter().map(|m| m.map(|n| map[n])));
            centres.extend(cell.centres.iter().map(|&n| map[n]));
            web_only.extend(&cell.web_only);
        }
        let none = quads.len()..quads.len();
        Self {
            nodes,
            web_only,
            quads,
            mid_sides,
            centres,
            bore: Vec::new(),
            cell,
            crack: None,
            cell_nodes,
            cell_first_quad,
            first_tooth,
            body_nodes: vec![Vec::new(); sectors],
            body_right_side: Vec::new(),
            body_quads: vec![none; sectors],
        }
    }
}
