//! The stiffness of a sector: its body and the dense blocks of the teeth at their feet.
//!
//! Where one sector has all teeth those blocks are most of it, some 10⁸ numbers. They are added in place to a pattern
//! that is found node by node: a list of rows, columns and values would take several times the memory of the matrix.

use faer::sparse::{SparseColMat, SparseColMatRef, SymbolicSparseColMat};
use gearmesh_fe::{FeError, StiffnessMatrix};

/// Displacements of a node.
const AXES: usize = 3;

/// Lower triangle of the stiffness over three rows a node: the body's own, over `body_nodes`, and one dense block over
/// each list of `tooth_nodes`.
///
/// # Errors
/// [`FeError::OutOfMemory`].
pub(crate) fn sector_stiffness(
    nodes: usize,
    (body, body_nodes): (SparseColMatRef<'_, usize, f64>, &[usize]),
    (block, tooth_nodes): (impl Fn(usize, usize) -> f64, &[Vec<usize>]),
) -> Result<StiffnessMatrix, FeError> {
    let mut below: Vec<Vec<u32>> = (0..nodes as u32).map(|node| vec![node]).collect();
    let mut couple = |a: usize, b: usize| {
        if a > b {
            below[b].push(a as u32);
        }
    };
    for (k, &column) in body_nodes.iter().enumerate() {
        for row in body.row_idx_of_col(AXES * k).filter(|row| row % AXES == 0) {
            couple(body_nodes[row / AXES], column);
        }
    }
    for own in tooth_nodes {
        own.iter()
            .for_each(|&a| own.iter().for_each(|&b| couple(a, b)));
    }
    for list in &mut below {
        list.sort_unstable();
        list.dedup();
    }
    let mut lower = LowerTriangle::new(below)?;
    for column in 0..body.ncols() {
        let c = body_nodes[column / AXES];
        let entries = (body.row_idx_of_col(column)).zip(body.val_of_col(column));
        for (row, &value) in entries {
            let axes = [row % AXES, column % AXES];
            lower.add(body_nodes[row / AXES], c, [(axes, value)]);
        }
    }
    for own in tooth_nodes {
        for (b, &c) in own.iter().enumerate() {
            for (a, &r) in own.iter().enumerate() {
                let axes = (0..AXES).flat_map(|k| (0..AXES).map(move |i| [i, k]));
                let entries = axes.map(|[i, k]| ([i, k], block(AXES * a + i, AXES * b + k)));
                lower.add(r, c, entries);
            }
        }
    }
    Ok(lower.into_matrix())
}

/// A lower triangle of full blocks of 3 × 3.
struct LowerTriangle {
    /// Row nodes of each column node, ascending from itself.
    below: Vec<Vec<u32>>,
    /// First entry of each column, and the end.
    starts: Vec<usize>,
    values: Vec<f64>,
}

impl LowerTriangle {
    fn new(below: Vec<Vec<u32>>) -> Result<Self, FeError> {
        let mut starts = Vec::with_capacity(AXES * below.len() + 1);
        let mut end = 0;
        starts.push(end);
        for list in &below {
            for axis in 0..AXES {
                end += AXES * list.len() - axis;
                starts.push(end);
            }
        }
        let mut values = Vec::new();
        values
            .try_reserve_exact(end)
            .map_err(|_| FeError::OutOfMemory {
                bytes: end.saturating_mul(size_of::<f64>()),
            })?;
        values.resize(end, 0.0);
        Ok(Self {
            below,
            starts,
            values,
        })
    }

    /// Adds entries between the axes of a row node and a column node; what is above the diagonal is left to its mirror.
    fn add(
        &mut self,
        row: usize,
        column: usize,
        entries: impl IntoIterator<Item = ([usize; 2], f64)>,
    ) {
        let Ok(place) = self.below[column].binary_search(&(row as u32)) else {
            return;
        };
        for ([i, k], value) in entries {
            // A column begins at its diagonal.
            if row > column || i >= k {
                self.values[self.starts[AXES * column + k] + AXES * place + i - k] += value;
            }
        }
    }

    fn into_matrix(self) -> StiffnessMatrix {
        let mut rows = Vec::with_capacity(self.values.len());
        for list in &self.below {
            for axis in 0..AXES {
                let all = list
                    .iter()
                    .flat_map(|&node| (0..AXES).map(move |i| AXES * node as usize + i));
                rows.extend(all.skip(axis));
            }
        }
        let size = AXES * self.below.len();
        let pattern = SymbolicSparseColMat::new_checked(size, size, self.starts, None, rows);
        SparseColMat::new(pattern, self.values)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use faer::Mat;
    use faer::sparse::Triplet;

    /// Every entry is the sum of what the body and the blocks have there, wherever the nodes of a block stand.
    #[test]
    fn entries_are_sums() {
        let (nodes, body_nodes) = (5, [0, 2, 3]);
        let value = |i: usize, j: usize| 1.0 + (i.min(j) * 100 + i.max(j)) as f64;
        let coupled = |i: usize, j: usize| (i / 3).abs_diff(j / 3) < 2;
        let all = || (0..9).flat_map(|j| (0..9).map(move |i| (i, j)));
        let triplets: Vec<_> = all()
            .filter(|&(i, j)| coupled(i, j))
            .map(|(i, j)| Triplet::new(i, j, value(i, j)))
            .collect();
        let body = SparseColMat::try_new_from_triplets(9, 9, &triplets).unwrap();
        let block = Mat::from_fn(6, 6, |i, j| 1e4 * value(i, j));
        let feet = [vec![4, 1], vec![1, 2]];
        let found = sector_stiffness(
            nodes,
            (body.as_ref(), &body_nodes),
            (|i, j| block[(i, j)], &feet),
        )
        .unwrap()
        .to_dense();
        let mut expected = Mat::<f64>::zeros(15, 15);
        for triplet in &triplets {
            let at = |k: usize| 3 * body_nodes[k / 3] + k % 3;
            expected[(at(triplet.row), at(triplet.col))] += triplet.val;
        }
        for own in &feet {
            for (i, j) in (0..6).flat_map(|i| (0..6).map(move |j| (i, j))) {
                expected[(3 * own[i / 3] + i % 3, 3 * own[j / 3] + j % 3)] += block[(i, j)];
            }
        }
        for (i, j) in (0..15).flat_map(|i| (0..=i).map(move |j| (i, j))) {
            assert_eq!(found[(i, j)], expected[(i, j)], "{i} {j}");
        }
    }
}
