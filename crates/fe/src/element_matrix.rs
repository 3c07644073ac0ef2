//! A symmetric element matrix (stiffness or mass), its upper triangle packed column by column.

use std::ops::Index;

/// Symmetric matrix over the degrees of freedom of one element; row 3 i + a is node i along axis a.
///
/// `matrix[(i, j)]` and `matrix[(j, i)]` are one and the same number.
#[derive(Debug, Clone, PartialEq)]
pub struct ElementMatrix {
    size: usize,
    packed: Vec<f64>,
}

impl ElementMatrix {
    /// A matrix from its upper triangle, `entry(row, column)` with row ≤ column.
    pub(crate) fn from_upper(size: usize, mut entry: impl FnMut(usize, usize) -> f64) -> Self {
        let mut packed = Vec::with_capacity(size * (size + 1) / 2);
        for column in 0..size {
            packed.extend((0..=column).map(|row| entry(row, column)));
        }
        Self { size, packed }
    }

    /// Number of rows: three per node.
    pub fn size(&self) -> usize {
        self.size
    }
}

impl Index<(usize, usize)> for ElementMatrix {
    type Output = f64;

    fn index(&self, (i, j): (usize, usize)) -> &f64 {
        let (low, high) = if i <= j { (i, j) } else { (j, i) };
        &self.packed[high * (high + 1) / 2 + low]
    }
}
