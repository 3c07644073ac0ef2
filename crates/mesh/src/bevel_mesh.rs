//! Nodes and elements of a bevel gear in hexahedra, swept along the tooth from toe to heel, with the sets that the reduction needs.
//!
//! One tooth's sector is made of two grids of quads in each section ([`Levels`]): ring and body, and the tooth above its cut. Sectors are
//! turned copies; the left side of one is the right side of the next.

use gearmesh_bevel::{BevelError, BevelGear};
use gearmesh_elements::CellKind;
use gearmesh_geometry::{Element, Flank};
use rayon::prelude::*;
use std::f64::consts::TAU;

use crate::MeshError;
use crate::bevel_level::{Level, Levels};
use crate::elements::ElementList;
use crate::face::{FaceShape, OutlineFace};
use crate::quality::{self, QualityReport};

const NONE: u32 = u32::MAX;

/// A meshed bevel gear.
#[derive(Debug, Clone)]
pub struct BevelMesh {
    /// \[x, y, z\] in the member's frame \[m\].
    pub nodes: Vec<[f64; 3]>,
    /// Elements.
    pub elements: ElementList,
    /// Quality.
    pub quality: QualityReport,
    /// Sections from toe to heel, as shares of the face.
    pub along: Vec<f64>,
    /// Outlines of tooth 0 from the middle of the space to the tip: cone distance and height above the pitch cone \[m\],
    /// `[right, left][section][node]`.
    pub outline_m: [Vec<Vec<[f64; 2]>>; 2],
    teeth: usize,
    grid: Grid,
    /// Node of sector 0 by section node and section, [`NONE`] where there is none or where it is the next sector's.
    local: Vec<u32>,
    /// Nodes of a sector.
    in_sector: usize,
}

/// Nodes of a section.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Grid {
    /// 1, or 2 with nodes in the middles of sides.
    order: usize,
    /// Columns of ring and body, and those beside the cut.
    columns: usize,
    pub(crate) beside: usize,
    /// Rows of the ring, and of ring and body.
    ring: usize,
    rows: usize,
    /// Rows of the tooth above the cut, and its columns.
    pub(crate) tooth: usize,
    pub(crate) across: usize,
    sections: usize,
}

/// A section node and whether it is the image of one in the next sector.
type Place = (usize, bool);

impl Grid {
    pub(crate) fn of(levels: &Levels<'_>, order: usize) -> Self {
        let s = &levels.spacing;
        let (beside, columns) = levels.columns();
        Self {
            order,
            columns,
            beside,
            ring: s.ring.len() - 1,
            rows: s.ring.len() - 1 + s.body.len(),
            tooth: s.high.len() + s.flank.len() - 2,
            across: s.across.len() - 1,
            sections: s.along.len(),
        }
    }

    fn section_nodes(&self) -> usize {
        (self.rows + 1) * (self.columns + 1) + self.tooth * (self.across + 1)
    }

    /// Node of ring and body.
    fn body(&self, row: usize, column: usize) -> usize {
        row * (self.columns + 1) + column
    }

    /// Node of the tooth, row 0 the cut.
    pub(crate) fn tooth(&self, row: usize, column: usize) -> usize {
        match row {
            0 => self.body(0, self.beside + column),
            _ => (self.rows + 1) * (self.columns + 1) + (row - 1) * (self.across + 1) + column,
        }
    }

    /// Nodes of one side's outline from the middle of the space to the tip.
    fn outline(&self, side: Flank) -> Vec<usize> {
        let foot = (0..self.beside).map(|c| match side {
            Flank::Right => self.body(0, c),
            Flank::Left => self.body(0, self.columns - c),
        });
        let column = match side {
            Flank::Right => 0,
            Flank::Left => self.across,
        };
        foot.chain((0..=self.tooth).map(|row| self.tooth(row, column)))
            .collect()
    }

    /// All nodes of ring and body of some rows.
    fn body_rows(&self, rows: std::ops::RangeInclusive<usize>) -> impl Iterator<Item = usize> {
        let grid = *self;
        rows.flat_map(move |row| (0..=grid.columns).map(move |column| grid.body(row, column)))
    }

    /// Nodes of the tooth above the cut, without the cut.
    fn tooth_rows(&self) -> impl Iterator<Item = usize> {
        let grid = *self;
        (1..=grid.tooth).flat_map(move |row| (0..=grid.across).map(move |c| grid.tooth(row, c)))
    }

    /// The node in the sector itself, or in the next one where it lies on the left side.
    fn own(&self, node: usize) -> Place {
        let width = self.columns + 1;
        if node < (self.rows + 1) * width && node % width == self.columns {
            (node - self.columns, true)
        } else {
            (node, false)
        }
    }

    /// Whether a node is one of an element: at most one of its three numbers is odd where elements are quadratic.
    fn is_used(&self, node: usize, section: usize) -> bool {
        if self.order == 1 {
            return true;
        }
        let width = self.columns + 1;
        let first_of_tooth = (self.rows + 1) * width;
        let (row, column) = match node.checked_sub(first_of_tooth) {
            None => (node / width, node % width),
            Some(k) => (k / (self.across + 1) + 1, k % (self.across + 1)),
        };
        row % 2 + column % 2 + section % 2 <= 1
    }

    /// Quads by their nodes, order + 1 by order + 1: along ξ first, then η; (ξ, η, towards the heel) is right-handed.
    fn quads(&self) -> Vec<[[usize; 3]; 3]> {
        let p = self.order;
        let mut quads = Vec::new();
        let mut push = |node: &dyn Fn(usize, usize) -> usize| {
            let mut quad = [[0; 3]; 3];
            for (a, row) in quad.iter_mut().enumerate() {
                for (b, slot) in row.iter_mut().enumerate() {
                    if a <= p && b <= p {
                        *slot = node(a, b);
                    }
                }
            }
            quads.push(quad);
        };
        // The tooth first: ξ up, η across. Then ring and body: ξ across, η down.
        for row in (0..self.tooth).step_by(p) {
            for column in (0..self.across).step_by(p) {
                push(&|a, b| self.tooth(row + a, column + b));
            }
        }
        for row in (0..self.rows).step_by(p) {
            for column in (0..self.columns).step_by(p) {
                push(&|a, b| self.body(row + b, column + a));
            }
        }
        quads
    }

    /// Quads of the tooth, of tooth and ring, and of all.
    fn quad_counts(&self) -> [usize; 3] {
        let p = self.order;
        let tooth = self.tooth / p * (self.across / p);
        let row = self.columns / p;
        [
            tooth,
            tooth + self.ring / p * row,
            tooth + self.rows / p * row,
        ]
    }
}

impl BevelMesh {
    /// Meshes a bevel gear.
    ///
    /// # Errors
    /// [`MeshError::Bevel`] where the tool leaves no surface, [`MeshError::Quality`] for a mesh poorer than demanded.
    pub fn new(gear: &BevelGear) -> Result<Self, MeshError> {
        let mesh = Self::of_any_quality(gear)?;
        mesh.quality.demand(gear.mesh.min_scaled_jacobian)?;
        Ok(mesh)
    }

    /// The same, however poor its elements.
    ///
    /// # Errors
    /// As [`Self::new`] without the second.
    pub fn of_any_quality(gear: &BevelGear) -> Result<Self, MeshError> {
        let (order, shape) = match gear.mesh.element {
            Element::Hex20 => (2, CellKind::Hex20),
            _ => (1, CellKind::Hex8),
        };
        let levels = Levels::new(gear, order)?;
        let grid = Grid::of(&levels, order);
        let along = levels.spacing.along.clone();
        let made: Vec<Level> = along
            .par_iter()
            .map(|share| levels.level(*share))
            .collect::<Result<_, BevelError>>()?;
        let count = grid.section_nodes();
        let mut local = vec![NONE; count * grid.sections];
        let mut own: Vec<[f64; 3]> = Vec::new();
        for node in 0..count {
            for (section, level) in made.iter().enumerate() {
                if grid.is_used(node, section) && !grid.own(node).1 {
                    local[node * grid.sections + section] = own.len() as u32;
                    own.push(level.nodes[node]);
                }
            }
        }
        let teeth = gear.blank().teeth;
        let in_sector = own.len();
        let turned = (0..teeth).flat_map(|tooth| {
            let (sin, cos) = (TAU * tooth as f64 / teeth as f64).sin_cos();
            let own = &own;
            own.iter()
                .map(move |[x, y, z]| [cos * x - sin * y, sin * x + cos * y, *z])
        });
        let nodes: Vec<[f64; 3]> = turned.collect();
        let mut outline_m: [Vec<Vec<[f64; 2]>>; 2] = [Vec::new(), Vec::new()];
        for level in made {
            for (all, line) in outline_m.iter_mut().zip(level.outline_m) {
                all.push(line);
            }
        }
        let mut mesh = Self {
            nodes,
            elements: ElementList::new(shape),
            quality: QualityReport {
                smallest: 1.0,
                mean: 1.0,
                worst_m: [0.0; 3],
            },
            along,
            outline_m,
            teeth,
            grid,
            local,
            in_sector,
        };
        let mut elements = ElementList::new(shape);
        let quads = grid.quads();
        for tooth in 0..teeth {
            for quad in &quads {
                for first in (0..grid.sections - 1).step_by(order) {
                    elements.push(
                        hexahedron(quad, order)
                            .map(|(node, section)| mesh.node(tooth, node, first + section)),
                    );
                }
            }
        }
        // All sectors are alike.
        let one = elements.len() / teeth;
        let mut first = ElementList::new(shape);
        for element in elements.iter().take(one) {
            first.push(element.iter().copied());
        }
        mesh.quality = quality::report(&mesh.nodes, &first);
        mesh.elements = elements;
        Ok(mesh)
    }

    /// Number of teeth, which is that of the sectors.
    pub fn teeth(&self) -> usize {
        self.teeth
    }

    /// 1, or 2 where elements are quadratic: sections and outline nodes between two corners of elements.
    pub fn order(&self) -> usize {
        self.grid.order
    }

    fn node(&self, tooth: usize, node: usize, section: usize) -> u32 {
        let (node, next) = self.grid.own(node);
        let sector = (tooth + usize::from(next)) % self.teeth;
        let local = self.local[node * self.grid.sections + section];
        (sector * self.in_sector) as u32 + local
    }

    /// Nodes of some section nodes in all sections that have them: those of the first, then those of the second.
    fn columns(&self, tooth: usize, nodes: impl IntoIterator<Item = usize>) -> Vec<u32> {
        let mut all = Vec::new();
        for node in nodes {
            for section in 0..self.grid.sections {
                if self.grid.is_used(node, section) {
                    all.push(self.node(tooth, node, section));
                }
            }
        }
        all
    }

    fn elements_of(&self, tooth: usize, quads: std::ops::Range<usize>) -> Vec<u32> {
        let layers = (self.grid.sections - 1) / self.grid.order;
        let all = self.grid.quad_counts()[2];
        let first = (tooth * all * layers) as u32;
        (quads.start * layers..quads.end * layers)
            .map(|e| first + e as u32)
            .collect()
    }

    /// Columns of elements along the teeth, of all sectors: corners in the section nearest to the middle of the face, and elements from toe to heel.
    pub fn columns_along(&self) -> Vec<([u32; 4], Vec<u32>)> {
        let (grid, p) = (self.grid, self.grid.order);
        let middle = (grid.sections - 1) / p / 2 * p;
        let quads = grid.quads();
        let of_tooth = |tooth: usize| {
            let quads = quads.iter().enumerate();
            quads.map(move |(number, quad)| {
                let corners = [quad[0][0], quad[p][0], quad[p][p], quad[0][p]];
                let corners = corners.map(|node| self.node(tooth, node, middle));
                (corners, self.elements_of(tooth, number..number + 1))
            })
        };
        (0..self.teeth).flat_map(of_tooth).collect()
    }

    /// Nodes of the bore.
    pub fn bore(&self) -> Vec<u32> {
        let row = self.grid.rows;
        let on_bore = |tooth| {
            self.columns(
                tooth,
                (0..self.grid.columns).map(|c| self.grid.body(row, c)),
            )
        };
        (0..self.teeth).flat_map(on_bore).collect()
    }

    /// Nodes of a tooth with the ring below it, the i-th of each tooth the image of the i-th of tooth 0.
    pub fn cell_nodes(&self, tooth: usize) -> Vec<u32> {
        let grid = self.grid;
        self.columns(
            tooth,
            grid.body_rows(0..=grid.ring).chain(grid.tooth_rows()),
        )
    }

    /// Elements of a tooth with the ring below it.
    pub fn cell_elements(&self, tooth: usize) -> Vec<u32> {
        self.elements_of(tooth, 0..self.grid.quad_counts()[1])
    }

    /// Nodes of a sector's body, with what it shares with the ring, the i-th of each sector the image of the i-th of sector 0.
    pub fn body_nodes(&self, sector: usize) -> Vec<u32> {
        let grid = self.grid;
        self.columns(sector, grid.body_rows(grid.ring..=grid.rows))
    }

    /// Elements of a sector's body.
    pub fn body_elements(&self, sector: usize) -> Vec<u32> {
        let [_, cell, all] = self.grid.quad_counts();
        self.elements_of(sector, cell..all)
    }

    /// Nodes of the cut before a sector, the i-th of each sector the image of the i-th of sector 0.
    pub fn cut_nodes(&self, sector: usize) -> Vec<u32> {
        let grid = self.grid;
        self.columns(sector, (0..=grid.rows).map(|row| grid.body(row, 0)))
    }

    /// Elements of the tooth above the cut of the tooth-only submodel.
    pub fn tooth_elements(&self, tooth: usize) -> Vec<u32> {
        self.elements_of(tooth, 0..self.grid.quad_counts()[0])
    }

    /// Nodes that hold the tooth-only submodel for loads on `loaded`: the cut and the opposite side of the tooth above it.
    pub fn tooth_supports(&self, tooth: usize, loaded: Flank) -> Vec<u32> {
        let grid = self.grid;
        let column = match loaded {
            Flank::Right => grid.across,
            Flank::Left => 0,
        };
        let cut = (0..=grid.across).map(|c| grid.tooth(0, c));
        let opposite = (1..=grid.tooth).map(|row| grid.tooth(row, column));
        self.columns(tooth, cut.chain(opposite))
    }

    /// Nodes on one side's outline from P, where the cut begins, to the tip.
    pub fn flank_nodes(&self, tooth: usize, side: Flank) -> Vec<u32> {
        let outline = self.grid.outline(side);
        self.columns(tooth, outline[self.grid.beside..].iter().copied())
    }

    /// Faces of one side of a tooth from the middle of the space to the tip; `place` gives the coordinates of an outline node
    /// in a section: its number from the space's middle and that of the section.
    pub fn outline_faces(
        &self,
        tooth: usize,
        side: Flank,
        place: impl Fn(usize, usize) -> [f64; 2],
    ) -> Vec<OutlineFace> {
        let (grid, p) = (self.grid, self.grid.order);
        let outline = grid.outline(side);
        let layers = (grid.sections - 1) / p;
        let at_foot = grid.beside / p;
        let mut faces = Vec::new();
        for step in 0..(outline.len() - 1) / p {
            let quad = match (step.checked_sub(at_foot), side) {
                (Some(row), Flank::Right) => row * (grid.across / p),
                (Some(row), Flank::Left) => (row + 1) * (grid.across / p) - 1,
                (None, Flank::Right) => grid.quad_counts()[0] + step,
                (None, Flank::Left) => grid.quad_counts()[0] + grid.columns / p - 1 - step,
            };
            for layer in 0..layers {
                let (k, l) = (step * p, layer * p);
                let corners = [(k, l), (k + p, l), (k + p, l + p), (k, l + p)];
                let middles = [(k + 1, l), (k + 2, l + 1), (k + 1, l + 2), (k, l + 1)];
                let (shape, at) = match p {
                    1 => (FaceShape::Quad4, corners.to_vec()),
                    _ => (FaceShape::Quad8, [corners, middles].concat()),
                };
                let element = (tooth * grid.quad_counts()[2] + quad) * layers + layer;
                faces.push(OutlineFace {
                    shape,
                    nodes: (at.iter())
                        .map(|&(k, l)| self.node(tooth, outline[k], l))
                        .collect(),
                    element: element as u32,
                    places_m: at.iter().map(|&(k, l)| place(k, l)).collect(),
                });
            }
        }
        faces
    }

    /// Points of one side's outline of tooth 0 at a share of the face, from the middle of the space to the tip \[m\].
    ///
    /// # Errors
    /// [`MeshError::Bevel`].
    pub fn outline_points_m(
        &self,
        gear: &BevelGear,
        side: Flank,
        along: f64,
    ) -> Result<Vec<[f64; 3]>, MeshError> {
        let level = Levels::new(gear, self.grid.order)?.level(along)?;
        let [right, left] = level.outline_points_m;
        Ok(match side {
            Flank::Right => right,
            Flank::Left => left,
        })
    }

    /// Number of the outline node at which the cut begins.
    pub fn outline_foot(&self) -> usize {
        self.grid.beside
    }
}

/// Section nodes and sections of a hexahedron in VTK's order.
pub(crate) fn hexahedron(
    quad: &[[usize; 3]; 3],
    order: usize,
) -> impl Iterator<Item = (usize, usize)> {
    let p = order;
    let corners = [quad[0][0], quad[p][0], quad[p][p], quad[0][p]];
    let middles = [quad[1][0], quad[2][1], quad[1][2], quad[0][1]];
    let at = |nodes: [usize; 4], section: usize| nodes.map(|node| (node, section));
    let mut all = [at(corners, 0), at(corners, p)].concat();
    if p == 2 {
        all.extend([at(middles, 0), at(middles, 2), at(corners, 1)].concat());
    }
    all.into_iter()
}
