//! Nodes and elements of a bevel gear in hexahedra, swept along the tooth from toe to heel, with the sets that the
//! reduction needs.
//!
//! One tooth's sector is made of two grids of quads in each section ([`Levels`]), the tooth above its cut and the ring
//! below it, and of quads of the meridian below the ring ([`BodyGrid`]), turned about the axis over the ring's columns.
//! Sectors are turned copies; the left side of one is the right side of the next.

use gearmesh_bevel::{BevelError, BevelGear};
use gearmesh_geometry::{Element, Flank};
use rayon::prelude::*;
use std::f64::consts::TAU;

use crate::MeshError;
use crate::bevel_grid::{Grid, cell_kind, corners_of, hexahedron};
use crate::bevel_level::{Level, Levels};
use crate::bevel_meridian::{BodyGrid, Meridian};
use crate::elements::ElementList;
use crate::face::{OutlineFace, outline_face};
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
    /// Outlines of tooth 0 from the middle of the space to the tip: cone distance and height above the pitch cone
    /// \[m\], `[right, left][section][node]`.
    pub outline_m: [Vec<Vec<[f64; 2]>>; 2],
    teeth: usize,
    grid: Grid,
    meridian: Meridian,
    /// Node of sector 0 by section node and section, [`NONE`] where there is none or where it is the next sector's.
    local: Vec<u32>,
    /// The same of the body by node of the meridian and column; [`NONE`] at the ring, too.
    in_body: Vec<u32>,
    /// Nodes of a sector.
    in_sector: usize,
}

/// A gear's sections.
struct Sections<'a> {
    gear: &'a BevelGear,
    order: usize,
    levels: Levels<'a>,
    made: Vec<Level>,
}

impl BevelMesh {
    /// Meshes a bevel gear, the body in rows, or freely where rows would be poorer than demanded.
    ///
    /// # Errors
    /// [`MeshError::Bevel`] where the tool leaves no surface, [`MeshError::Quality`] for a mesh poorer than demanded,
    /// and those of [`Self::of_grid`].
    pub fn new(gear: &BevelGear) -> Result<Self, MeshError> {
        let sections = Sections::new(gear, BodyGrid::Rows)?;
        let demanded = gear.mesh.min_scaled_jacobian;
        let rows = Self::of_sections(&sections, BodyGrid::Rows)?;
        if rows.quality.smallest >= demanded {
            return Ok(rows);
        }
        // A free body changes nothing of teeth and ring, but that it may want one section more.
        rows.worst(rows.cell_elements(0)).demand(demanded)?;
        let free = Self::of_grid(gear, BodyGrid::Free)?;
        free.quality.demand(demanded)?;
        Ok(free)
    }

    /// The same with a body of this kind, however poor its elements.
    ///
    /// # Errors
    /// [`MeshError::Bevel`]; of free bodies [`MeshError::CrossedLines`], and [`MeshError::Python`] or
    /// [`MeshError::Plane`] where gmsh is missing or fails.
    pub fn of_grid(gear: &BevelGear, body: BodyGrid) -> Result<Self, MeshError> {
        Self::of_sections(&Sections::new(gear, body)?, body)
    }

    fn of_sections(sections: &Sections<'_>, body: BodyGrid) -> Result<Self, MeshError> {
        let Sections {
            gear,
            order,
            levels,
            made,
        } = sections;
        let (order, teeth) = (*order, gear.blank().teeth);
        let grid = Grid::of(levels, order);
        let meridian = Meridian::new(gear, levels, order, body)?;
        let mut own: Vec<[f64; 3]> = Vec::new();
        let local = number_sections(&grid, made, &mut own);
        let in_body = number_body(&grid, &meridian, made, &mut own);
        let in_sector = own.len();
        let turned = (0..teeth).flat_map(|tooth| {
            let (sin, cos) = (TAU * tooth as f64 / teeth as f64).sin_cos();
            let own = &own;
            own.iter()
                .map(move |[x, y, z]| [cos * x - sin * y, sin * x + cos * y, *z])
        });
        let nodes: Vec<[f64; 3]> = turned.collect();
        let outline = |k: usize| {
            made.iter()
                .map(|level| level.outline_m[k].clone())
                .collect()
        };
        let mut mesh = Self {
            nodes,
            elements: ElementList::new(cell_kind(order)),
            quality: QualityReport {
                smallest: 1.0,
                mean: 1.0,
                worst_m: [0.0; 3],
            },
            along: levels.spacing.along.clone(),
            outline_m: [outline(0), outline(1)],
            teeth,
            grid,
            meridian,
            local,
            in_body,
            in_sector,
        };
        mesh.elements = mesh.hexahedra();
        // All sectors are alike.
        let one = (mesh.elements.len() / teeth) as u32;
        mesh.quality = mesh.worst((0..one).collect());
        Ok(mesh)
    }

    /// Elements of all sectors: those of tooth and ring, then those of the body.
    fn hexahedra(&self) -> ElementList {
        let (grid, order) = (&self.grid, self.grid.order);
        let mut elements = ElementList::new(cell_kind(order));
        let quads = grid.quads();
        for tooth in 0..self.teeth {
            for quad in &quads {
                for first in (0..grid.sections - 1).step_by(order) {
                    elements.push(
                        hexahedron(quad, order)
                            .into_iter()
                            .map(|(node, section)| self.node(tooth, node, first + section)),
                    );
                }
            }
            for quad in &self.meridian.quads {
                for first in (0..grid.columns).step_by(order) {
                    elements.push(
                        hexahedron(quad, order)
                            .into_iter()
                            .map(|(node, column)| self.body_node(tooth, node, first + column)),
                    );
                }
            }
        }
        elements
    }

    /// Quality of some elements.
    fn worst(&self, of: Vec<u32>) -> QualityReport {
        let mut elements = ElementList::new(self.elements.shape());
        for element in of {
            elements.push(self.elements.nodes(element).iter().copied());
        }
        quality::report(&self.nodes, &elements)
    }

    /// How the body is meshed.
    pub fn body_grid(&self) -> BodyGrid {
        self.meridian.kind
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

    /// The node of a sector at a place of the meridian and a column.
    fn body_node(&self, sector: usize, node: usize, column: usize) -> u32 {
        if let Some(section) = self.meridian.section[node] {
            return self.node(sector, self.grid.ring(self.grid.ring, column), section);
        }
        let next = column == self.grid.columns;
        let column = if next { 0 } else { column };
        let sector = (sector + usize::from(next)) % self.teeth;
        (sector * self.in_sector) as u32 + self.in_body[node * self.grid.columns + column]
    }

    /// Nodes of some nodes of the meridian in some columns, where there are any: those of the first, then those of the
    /// second.
    fn body_columns(
        &self,
        sector: usize,
        nodes: impl IntoIterator<Item = usize>,
        columns: std::ops::Range<usize>,
    ) -> Vec<u32> {
        let mut all = Vec::new();
        for node in nodes {
            for column in columns.clone() {
                if is_in_body(&self.grid, &self.meridian, node, column) {
                    all.push(self.body_node(sector, node, column));
                }
            }
        }
        all
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

    /// Elements of a sector.
    fn in_one(&self) -> usize {
        self.elements.len() / self.teeth
    }

    fn elements_of(&self, tooth: usize, quads: std::ops::Range<usize>) -> Vec<u32> {
        let layers = (self.grid.sections - 1) / self.grid.order;
        let first = (tooth * self.in_one()) as u32;
        (quads.start * layers..quads.end * layers)
            .map(|e| first + e as u32)
            .collect()
    }

    /// What is seen of all sectors along the axis: corners, of teeth and ring in the section nearest to the middle of
    /// the face, and the elements before and behind them.
    pub fn columns_along(&self) -> Vec<([u32; 4], Vec<u32>)> {
        let (grid, p) = (self.grid, self.grid.order);
        let middle = (grid.sections - 1) / p / 2 * p;
        let quads = grid.quads();
        let steps = grid.columns / p;
        let in_cell = quads.len() * ((grid.sections - 1) / p);
        let of_tooth = |tooth: usize| {
            let quads = quads.iter().enumerate();
            let cell = quads.map(move |(number, quad)| {
                let corners = corners_of(quad, p).map(|node| self.node(tooth, node, middle));
                (corners, self.elements_of(tooth, number..number + 1))
            });
            let first = tooth * self.in_one() + in_cell;
            let body = self
                .meridian
                .seen
                .iter()
                .flat_map(move |([up, down], own)| {
                    (0..steps).map(move |step| {
                        let at = |node: usize, column: usize| self.body_node(tooth, node, column);
                        let (a, b) = (step * p, (step + 1) * p);
                        let elements = own.iter().map(|quad| (first + quad * steps + step) as u32);
                        (
                            [at(*up, a), at(*up, b), at(*down, b), at(*down, a)],
                            elements.collect(),
                        )
                    })
                });
            cell.chain(body)
        };
        (0..self.teeth).flat_map(of_tooth).collect()
    }

    /// Nodes of the bore.
    pub fn bore(&self) -> Vec<u32> {
        let on_bore = |tooth| {
            let nodes = self.meridian.bore.iter().copied();
            self.body_columns(tooth, nodes, 0..self.grid.columns)
        };
        (0..self.teeth).flat_map(on_bore).collect()
    }

    /// Nodes of a tooth with the ring below it, the i-th of each tooth the image of the i-th of tooth 0.
    pub fn cell_nodes(&self, tooth: usize) -> Vec<u32> {
        let grid = self.grid;
        self.columns(
            tooth,
            grid.ring_rows(0..=grid.ring).chain(grid.tooth_rows()),
        )
    }

    /// Elements of a tooth with the ring below it.
    pub fn cell_elements(&self, tooth: usize) -> Vec<u32> {
        self.elements_of(tooth, 0..self.grid.quad_counts()[1])
    }

    /// Nodes of a sector's body, with what it shares with the ring, the i-th of each sector the image of the i-th of
    /// sector 0.
    pub fn body_nodes(&self, sector: usize) -> Vec<u32> {
        self.body_columns(
            sector,
            0..self.meridian.nodes.len(),
            0..self.grid.columns + 1,
        )
    }

    /// Elements of a sector's body.
    pub fn body_elements(&self, sector: usize) -> Vec<u32> {
        let one = self.in_one();
        let body = self.meridian.quads.len() * (self.grid.columns / self.grid.order);
        ((sector + 1) * one - body..(sector + 1) * one)
            .map(|e| e as u32)
            .collect()
    }

    /// Nodes of the cut before a sector, the i-th of each sector the image of the i-th of sector 0.
    pub fn cut_nodes(&self, sector: usize) -> Vec<u32> {
        let grid = self.grid;
        // The ring's last row is the body's first.
        let mut all = self.columns(sector, (0..grid.ring).map(|row| grid.ring(row, 0)));
        all.extend(self.body_columns(sector, 0..self.meridian.nodes.len(), 0..1));
        all
    }

    /// Elements of the tooth above the cut of the tooth-only submodel.
    pub fn tooth_elements(&self, tooth: usize) -> Vec<u32> {
        self.elements_of(tooth, 0..self.grid.quad_counts()[0])
    }

    /// Nodes that hold the tooth-only submodel for loads on `loaded`: the cut and the opposite side of the tooth above
    /// it.
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

    /// Faces of one side of a tooth from the middle of the space to the tip; `place` gives the coordinates of an
    /// outline node in a section: its number from the space's middle and that of the section.
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
                let (shape, at) = outline_face(p, (k, l));
                let element = tooth * self.in_one() + quad * layers + layer;
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

impl<'a> Sections<'a> {
    fn new(gear: &'a BevelGear, body: BodyGrid) -> Result<Self, MeshError> {
        let order = match gear.mesh.element {
            Element::Hex20 => 2,
            _ => 1,
        };
        let mut levels = Levels::new(gear, order)?;
        if body == BodyGrid::Free {
            levels = levels.even_along(order);
        }
        let along = levels.spacing.along.par_iter();
        let made = along
            .map(|share| levels.level(*share))
            .collect::<Result<_, BevelError>>()?;
        Ok(Self {
            gear,
            order,
            levels,
            made,
        })
    }
}

/// Whether elements have a node at a place of the meridian and a column.
fn is_in_body(grid: &Grid, meridian: &Meridian, node: usize, column: usize) -> bool {
    usize::from(meridian.between[node]) + column % grid.order <= 1
}

/// Nodes of a sector's tooth and ring, by section node and section; [`NONE`] where there is none, or where it is the
/// next sector's.
fn number_sections(grid: &Grid, made: &[Level], own: &mut Vec<[f64; 3]>) -> Vec<u32> {
    let count = grid.section_nodes();
    let mut local = vec![NONE; count * grid.sections];
    for node in 0..count {
        for (section, level) in made.iter().enumerate() {
            if grid.is_used(node, section) && !grid.own(node).1 {
                local[node * grid.sections + section] = own.len() as u32;
                own.push(level.nodes[node]);
            }
        }
    }
    local
}

/// Nodes of a sector's body, by node of the meridian and column; [`NONE`] at the ring, too.
fn number_body(
    grid: &Grid,
    meridian: &Meridian,
    made: &[Level],
    own: &mut Vec<[f64; 3]>,
) -> Vec<u32> {
    let at_ring: Vec<&[f64]> = made.iter().map(|l| l.columns_rad.as_slice()).collect();
    let azimuths = meridian.azimuths_rad(&at_ring);
    let mut in_body = vec![NONE; meridian.nodes.len() * grid.columns];
    for (node, [z, radius]) in meridian.nodes.iter().enumerate() {
        for column in 0..grid.columns {
            if is_in_body(grid, meridian, node, column) && meridian.section[node].is_none() {
                in_body[node * grid.columns + column] = own.len() as u32;
                let (sin, cos) = azimuths[node][column].sin_cos();
                own.push([radius * cos, radius * sin, *z]);
            }
        }
    }
    in_body
}
