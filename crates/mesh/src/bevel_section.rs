//! A bevel tooth in the plane normal to it at one place of the face: its outlines, and its own mesh seen along the
//! tooth.
//!
//! The section L = const is cut obliquely by the spiral. Seen along the tooth (the direction of the lines of nodes in
//! the middle of it) it becomes the normal section of the cylinder that touches the tooth there. x points up the tooth,
//! y counter-clockwise.

use gearmesh_bevel::BevelGear;
use gearmesh_geometry::{Element, Flank};
use nalgebra::Vector3;

use crate::MeshError;
use crate::bevel_grid::{Grid, cell_kind, grid_quad, hexahedron};
use crate::bevel_level::{Level, Levels};
use crate::elements::ElementList;
use crate::face::{OutlineFace, outline_face};

/// Pieces of the outline from P to the flank, and from there to the tip.
const PIECES: [usize; 2] = [16, 64];
/// Share of the face over which the direction of the tooth is taken.
const STEP: f64 = 1e-3;

/// A normal section of a tooth.
#[derive(Debug, Clone)]
pub struct BevelSection {
    /// Outlines from P, where the cut begins, to the tip: right, left \[m\].
    pub outline_m: [Vec<[f64; 2]>; 2],
    /// Their heights above the pitch cone \[m\].
    pub heights_m: [Vec<f64>; 2],
    /// Lower ends of the fillets \[m\].
    pub roots_m: [[f64; 2]; 2],
    /// The cut from the right to the left outline \[m\].
    pub cut_m: Vec<[f64; 2]>,
    /// Nodes of the tooth's own mesh above the cut, rows from the cut on, each from right to left \[m\].
    pub nodes_m: Vec<[f64; 2]>,
    /// Heights of its outline nodes above the pitch cone from P to the tip: right, left \[m\].
    pub node_heights_m: [Vec<f64>; 2],
    /// Directions of x and y in the gear's frame.
    pub axes: [[f64; 3]; 2],
    /// Cone distance of the section \[m\].
    pub cone_m: f64,
    columns: usize,
    order: usize,
}

/// One layer of the tooth's own mesh in the normal section.
pub struct SectionLayer {
    /// Nodes \[m\], z along the tooth.
    pub nodes: Vec<[f64; 3]>,
    /// Elements.
    pub elements: ElementList,
    /// Faces of one side with the height above the pitch cone \[m\] and the share of the thickness of their nodes.
    pub faces: Vec<OutlineFace>,
    /// Nodes that hold the tooth for loads on that side.
    pub held: Vec<usize>,
}

impl BevelSection {
    /// The normal section at a share of the way from toe to heel.
    ///
    /// # Errors
    /// [`MeshError::Bevel`] where the tool leaves no surface.
    pub fn new(gear: &BevelGear, along: f64) -> Result<Self, MeshError> {
        let order = match gear.mesh.element {
            Element::Hex20 => 2,
            _ => 1,
        };
        let levels = Levels::new(gear, order)?;
        let grid = Grid::of(&levels, order);
        let middle = grid.beside + grid.tooth / 2;
        let centre = |level: &Level| {
            let [r, l] = [0, 1].map(|k| Vector3::from(level.outline_points_m[k][middle]));
            (r + l) * 0.5
        };
        let (before, after) = (levels.level(along - STEP)?, levels.level(along + STEP)?);
        let level = levels.level(along)?;
        let d = (centre(&after) - centre(&before)).normalize();
        let origin = centre(&level);
        let [_, up] = gear.blank().directions(&origin);
        let x = (up - d * d.dot(&up)).normalize();
        let y = d.cross(&x);
        let seen = |p: &[f64; 3]| {
            let v = Vector3::from(*p) - origin;
            [v.dot(&x), v.dot(&y)]
        };
        let fine = levels.with_pieces(PIECES).level(along)?;
        let foot = grid.beside;
        let of = |lines: &[Vec<[f64; 3]>; 2]| {
            [0, 1].map(|k| lines[k][foot..].iter().map(seen).collect::<Vec<_>>())
        };
        let heights = |lines: &[Vec<[f64; 2]>; 2]| {
            [0, 1].map(|k| lines[k][foot..].iter().map(|p| p[1]).collect::<Vec<_>>())
        };
        let bottom = levels.spacing.bottom.len() - 1;
        let node = |row: usize, column: usize| seen(&level.nodes[grid.tooth(row, column)]);
        Ok(Self {
            outline_m: of(&fine.outline_points_m),
            heights_m: heights(&fine.outline_m),
            roots_m: [0, 1].map(|k| seen(&level.outline_points_m[k][bottom])),
            cut_m: (0..=grid.across).map(|column| node(0, column)).collect(),
            nodes_m: (0..=grid.tooth)
                .flat_map(|row| (0..=grid.across).map(move |column| (row, column)))
                .map(|(row, column)| node(row, column))
                .collect(),
            node_heights_m: heights(&level.outline_m),
            axes: [x, y].map(|v| [v.x, v.y, v.z]),
            cone_m: level.outline_m[0][foot][0],
            columns: grid.across + 1,
            order,
        })
    }

    /// One layer of the tooth's own mesh, for loads on a side.
    pub fn layer(&self, side: Flank, thickness_m: f64) -> SectionLayer {
        let (p, columns) = (self.order, self.columns);
        let rows = self.nodes_m.len() / columns;
        let section = |row: usize, column: usize| row * columns + column;
        let is_used = |node: usize, level: usize| {
            p == 1 || (node / columns) % 2 + (node % columns) % 2 + level % 2 <= 1
        };
        let mut number = vec![u32::MAX; self.nodes_m.len() * (p + 1)];
        let mut nodes = Vec::new();
        for (n, at) in self.nodes_m.iter().enumerate() {
            for level in (0..=p).filter(|level| is_used(n, *level)) {
                number[n * (p + 1) + level] = nodes.len() as u32;
                nodes.push([at[0], at[1], thickness_m * (level as f64 / p as f64 - 0.5)]);
            }
        }
        let id = |n: usize, level: usize| number[n * (p + 1) + level];
        let mut elements = ElementList::new(cell_kind(p));
        let mut of_quad = Vec::new();
        for row in (0..rows - 1).step_by(p) {
            for column in (0..columns - 1).step_by(p) {
                let quad = grid_quad(p, |a, b| section(row + a, column + b));
                let places = hexahedron(&quad, p).into_iter();
                of_quad.push(elements.push(places.map(|(n, level)| id(n, level))));
            }
        }
        let (k, own, opposite) = match side {
            Flank::Right => (0, 0, columns - 1),
            Flank::Left => (1, columns - 1, 0),
        };
        let heights = &self.node_heights_m[k];
        let per_row = (columns - 1) / p;
        let faces = (0..rows - 1)
            .step_by(p)
            .map(|row| {
                let (shape, at) = outline_face(p, (row, 0));
                let first = row / p * per_row;
                let quad = if own == 0 { first } else { first + per_row - 1 };
                OutlineFace {
                    shape,
                    nodes: at
                        .iter()
                        .map(|&(a, level)| id(section(a, own), level))
                        .collect(),
                    element: of_quad[quad],
                    places_m: at
                        .iter()
                        .map(|&(a, level)| [heights[a], level as f64 / p as f64])
                        .collect(),
                }
            })
            .collect();
        let mut held = Vec::new();
        let cut = (0..columns).map(|column| section(0, column));
        let side = (1..rows).map(|row| section(row, opposite));
        for n in cut.chain(side) {
            held.extend(
                (0..=p)
                    .filter(|l| is_used(n, *l))
                    .map(|l| id(n, l) as usize),
            );
        }
        SectionLayer {
            nodes,
            elements,
            faces,
            held,
        }
    }
}
