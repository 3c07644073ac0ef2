//! What the solution by repetition asks of a mesh: its teeth and sectors are turned copies of one another.

use gearmesh_mesh::{BevelMesh, GearMesh};

/// A mesh of a gear that repeats.
pub trait RepeatedMesh: Sync {
    /// \[x, y, z\] of the nodes \[m\], z the axis.
    fn nodes(&self) -> &[[f64; 3]];

    /// Number of teeth.
    fn teeth(&self) -> usize;

    /// Number of repeating sectors, a divisor of that of the teeth.
    fn sectors(&self) -> usize;

    /// First tooth of sector 0.
    fn first_tooth(&self) -> usize;

    /// Nodes of a tooth's cell, the i-th of each tooth the image of the i-th of tooth 0.
    fn cell_nodes(&self, tooth: usize) -> Vec<u32>;

    /// Elements of a tooth's cell.
    fn cell_elements(&self, tooth: usize) -> Vec<u32>;

    /// Nodes of a sector's body with what it shares with the teeth, the i-th of each sector the image of the i-th of
    /// sector 0.
    fn body_nodes(&self, sector: usize) -> Vec<u32>;

    /// Elements of a sector's body.
    fn body_elements(&self, sector: usize) -> Vec<u32>;

    /// Nodes of the cut before the first tooth of a sector, the i-th of each sector the image of the i-th of sector 0.
    fn cut_nodes(&self, sector: usize) -> Vec<u32>;
}

/// What the meshes answer themselves, by the same names.
macro_rules! own_cells {
    () => {
        fn nodes(&self) -> &[[f64; 3]] {
            &self.nodes
        }

        fn teeth(&self) -> usize {
            Self::teeth(self)
        }

        fn cell_nodes(&self, tooth: usize) -> Vec<u32> {
            Self::cell_nodes(self, tooth)
        }

        fn cell_elements(&self, tooth: usize) -> Vec<u32> {
            Self::cell_elements(self, tooth)
        }

        fn body_nodes(&self, sector: usize) -> Vec<u32> {
            Self::body_nodes(self, sector)
        }

        fn body_elements(&self, sector: usize) -> Vec<u32> {
            Self::body_elements(self, sector)
        }

        fn cut_nodes(&self, sector: usize) -> Vec<u32> {
            Self::cut_nodes(self, sector)
        }
    };
}

impl RepeatedMesh for GearMesh {
    own_cells!();

    fn sectors(&self) -> usize {
        Self::sectors(self)
    }

    fn first_tooth(&self) -> usize {
        Self::first_tooth(self)
    }
}

impl RepeatedMesh for BevelMesh {
    own_cells!();

    fn sectors(&self) -> usize {
        Self::teeth(self)
    }

    fn first_tooth(&self) -> usize {
        0
    }
}
