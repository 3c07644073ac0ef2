//! Section nodes of a bevel tooth and the ring below it, and the quads between them.

use gearmesh_elements::CellKind;
use gearmesh_geometry::Flank;

use crate::bevel_level::Levels;
use crate::elements::brick;

/// Nodes of a section.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Grid {
    /// 1, or 2 with nodes in the middles of sides.
    pub(crate) order: usize,
    /// Columns of ring and body, and those beside the cut.
    pub(crate) columns: usize,
    pub(crate) beside: usize,
    /// Rows of the ring.
    pub(crate) ring: usize,
    /// Rows of the tooth above the cut, and its columns.
    pub(crate) tooth: usize,
    pub(crate) across: usize,
    pub(crate) sections: usize,
}

/// A section node and whether it is the image of one in the next sector.
pub(crate) type Place = (usize, bool);

impl Grid {
    pub(crate) fn of(levels: &Levels<'_>, order: usize) -> Self {
        let s = &levels.spacing;
        let (beside, columns) = levels.columns();
        Self {
            order,
            columns,
            beside,
            ring: s.ring.len() - 1,
            tooth: s.high.len() + s.flank.len() - 2,
            across: s.across.len() - 1,
            sections: s.along.len(),
        }
    }

    pub(crate) fn section_nodes(&self) -> usize {
        (self.ring + 1) * (self.columns + 1) + self.tooth * (self.across + 1)
    }

    /// Node of the ring.
    pub(crate) fn ring(&self, row: usize, column: usize) -> usize {
        row * (self.columns + 1) + column
    }

    /// Node of the tooth, row 0 the cut.
    pub(crate) fn tooth(&self, row: usize, column: usize) -> usize {
        match row {
            0 => self.ring(0, self.beside + column),
            _ => (self.ring + 1) * (self.columns + 1) + (row - 1) * (self.across + 1) + column,
        }
    }

    /// Nodes of one side's outline from the middle of the space to the tip.
    pub(crate) fn outline(&self, side: Flank) -> Vec<usize> {
        let foot = (0..self.beside).map(|c| match side {
            Flank::Right => self.ring(0, c),
            Flank::Left => self.ring(0, self.columns - c),
        });
        let column = match side {
            Flank::Right => 0,
            Flank::Left => self.across,
        };
        foot.chain((0..=self.tooth).map(|row| self.tooth(row, column)))
            .collect()
    }

    /// All nodes of the ring of some rows.
    pub(crate) fn ring_rows(
        &self,
        rows: std::ops::RangeInclusive<usize>,
    ) -> impl Iterator<Item = usize> {
        let grid = *self;
        rows.flat_map(move |row| (0..=grid.columns).map(move |column| grid.ring(row, column)))
    }

    /// Nodes of the tooth above the cut, without the cut.
    pub(crate) fn tooth_rows(&self) -> impl Iterator<Item = usize> {
        let grid = *self;
        (1..=grid.tooth).flat_map(move |row| (0..=grid.across).map(move |c| grid.tooth(row, c)))
    }

    /// The node in the sector itself, or in the next one where it lies on the left side.
    pub(crate) fn own(&self, node: usize) -> Place {
        let width = self.columns + 1;
        if node < (self.ring + 1) * width && node % width == self.columns {
            (node - self.columns, true)
        } else {
            (node, false)
        }
    }

    /// Whether a node is one of an element: at most one of its three numbers is odd where elements are quadratic.
    pub(crate) fn is_used(&self, node: usize, section: usize) -> bool {
        if self.order == 1 {
            return true;
        }
        let width = self.columns + 1;
        let first_of_tooth = (self.ring + 1) * width;
        let (row, column) = match node.checked_sub(first_of_tooth) {
            None => (node / width, node % width),
            Some(k) => (k / (self.across + 1) + 1, k % (self.across + 1)),
        };
        row % 2 + column % 2 + section % 2 <= 1
    }

    /// Quads by their nodes, order + 1 by order + 1: along ξ first, then η; (ξ, η, towards the heel) is right-handed.
    pub(crate) fn quads(&self) -> Vec<[[usize; 3]; 3]> {
        let p = self.order;
        let mut quads = Vec::new();
        // The tooth first: ξ up, η across. Then the ring: ξ across, η down.
        for row in (0..self.tooth).step_by(p) {
            for column in (0..self.across).step_by(p) {
                quads.push(grid_quad(p, |a, b| self.tooth(row + a, column + b)));
            }
        }
        for row in (0..self.ring).step_by(p) {
            for column in (0..self.columns).step_by(p) {
                quads.push(grid_quad(p, |a, b| self.ring(row + b, column + a)));
            }
        }
        quads
    }

    /// Quads of the tooth, and of tooth and ring.
    pub(crate) fn quad_counts(&self) -> [usize; 2] {
        let p = self.order;
        let tooth = self.tooth / p * (self.across / p);
        [tooth, tooth + self.ring / p * (self.columns / p)]
    }
}

/// What hexahedra of this order are.
pub(crate) const fn cell_kind(order: usize) -> CellKind {
    match order {
        1 => CellKind::Hex8,
        _ => CellKind::Hex20,
    }
}

/// A quad of order + 1 by order + 1 nodes.
pub(crate) fn grid_quad(order: usize, node: impl Fn(usize, usize) -> usize) -> [[usize; 3]; 3] {
    let mut quad = [[0; 3]; 3];
    for (a, line) in quad.iter_mut().enumerate().take(order + 1) {
        for (b, slot) in line.iter_mut().enumerate().take(order + 1) {
            *slot = node(a, b);
        }
    }
    quad
}

/// Its corners, counter-clockwise.
pub(crate) fn corners_of(quad: &[[usize; 3]; 3], order: usize) -> [usize; 4] {
    let p = order;
    [quad[0][0], quad[p][0], quad[p][p], quad[0][p]]
}

/// Section nodes and sections of a hexahedron in VTK's order.
pub(crate) fn hexahedron(quad: &[[usize; 3]; 3], order: usize) -> Vec<(usize, usize)> {
    let middles = [quad[1][0], quad[2][1], quad[1][2], quad[0][1]];
    let middles = (order == 2).then_some(middles);
    brick(corners_of(quad, order), middles, 0)
}
