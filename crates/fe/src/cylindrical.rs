//! Displacements and stiffness in cylindrical components: radial, circumferential, axial at each node.
//!
//! In these components a part and its image under a turn about z have the same stiffness matrix, entry by entry, and a
//! field that turns with the part is the same list of numbers. Cyclic symmetry then needs no rotation matrices.

use crate::compressed_columns::StiffnessMatrix;

/// The frames of some nodes: (cos φ, sin φ) of their polar angles.
#[derive(Debug, Clone, PartialEq)]
pub struct CylindricalFrames(Vec<[f64; 2]>);

impl CylindricalFrames {
    /// Frames at the given places \[x, y, z\] (m). On the axis itself, where φ is not defined, the frame is Cartesian.
    pub fn new(nodes: impl IntoIterator<Item = [f64; 3]>) -> Self {
        let frame = |[x, y, _]: [f64; 3]| {
            let r = x.hypot(y);
            if r > 0.0 { [x / r, y / r] } else { [1.0, 0.0] }
        };
        Self(nodes.into_iter().map(frame).collect())
    }

    /// Cylindrical from Cartesian components at a node.
    pub fn to_cylindrical(&self, node: usize, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let [c, s] = self.0[node];
        [c * x + s * y, c * y - s * x, z]
    }

    /// Cartesian from cylindrical components at a node.
    pub fn to_cartesian(&self, node: usize, [r, t, z]: [f64; 3]) -> [f64; 3] {
        let [c, s] = self.0[node];
        [c * r - s * t, s * r + c * t, z]
    }

    /// Qᵀ K Q for a stiffness whose rows and columns are the three displacements of each frame's node, in order, and
    /// whose pattern consists of 3×3 blocks.
    ///
    /// # Panics
    /// If K does not have three rows per frame or its pattern is not made of whole blocks.
    pub fn turn_stiffness(&self, k: &mut StiffnessMatrix) {
        assert_eq!(k.ncols(), 3 * self.0.len(), "three columns per node");
        for node in 0..self.0.len() {
            let starts: [usize; 3] =
                std::array::from_fn(|axis| k.as_ref().col_range(3 * node + axis).start);
            let height = k.as_ref().col_range(3 * node).len();
            let rows: Vec<usize> = k.as_ref().row_idx_of_col(3 * node).step_by(3).collect();
            assert_eq!(3 * rows.len(), height, "a pattern of 3x3 blocks");
            let values = k.val_mut();
            for (place, row) in rows.into_iter().enumerate() {
                let at = |r: usize, c: usize| starts[c] + 3 * place + r;
                // Columns into the row node's frame, then rows into the column node's.
                for c in 0..3 {
                    let turned =
                        self.to_cylindrical(row / 3, std::array::from_fn(|r| values[at(r, c)]));
                    for (r, value) in turned.into_iter().enumerate() {
                        values[at(r, c)] = value;
                    }
                }
                for r in 0..3 {
                    let turned =
                        self.to_cylindrical(node, std::array::from_fn(|c| values[at(r, c)]));
                    for (c, value) in turned.into_iter().enumerate() {
                        values[at(r, c)] = value;
                    }
                }
            }
        }
    }
}
