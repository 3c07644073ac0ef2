//! Joint equations in the metric of the mass matrix, body by body.
//!
//! With M = LLᵀ (one block for each body) the rows of B̂ = B L⁻ᵀ are comparable whatever their units, and G = B̂B̂ᵀ = B
//! M⁻¹Bᵀ couples only equations that share a body. G is factorised row by row in the order of the equations, each row
//! from its first neighbour on: what is left on the diagonal is the part of a row of B̂ that does not follow from those
//! before it.

use nalgebra::{Cholesky, DMatrix, Dyn};

use crate::equations::Equations;

/// Share of a row of B̂ below which it counts as dependent on the rows before it. Rounding leaves about 1e-15,
/// well-built mechanisms have more than 1e-3.
const DEPENDENT: f64 = 1e-8;

/// Square of the share of a row that the factors of G still tell; below it the rest of the row itself is formed, twice.
const DOUBTFUL: f64 = 1e-6;

/// The mass matrix of one body and where it begins.
struct Block {
    start: usize,
    mass: Cholesky<f64, Dyn>,
}

/// Joint equations at one configuration in the metric of the mass matrix.
pub(crate) struct Metric {
    blocks: Vec<Block>,
    /// Block of each degree of freedom.
    block_of: Vec<usize>,
    /// B̂: for each equation the degrees of freedom that it has, rising, with their values.
    rows: Vec<Vec<(usize, f64)>>,
}

/// Cholesky factors of G for the kept equations, row by row from the first neighbour to the diagonal.
pub(crate) struct Factors {
    first: Vec<usize>,
    rows: Vec<Vec<f64>>,
}

impl Metric {
    /// `None` if the mass matrix is not positive definite, which valid bodies exclude as long as modes stay small.
    /// `bodies`: their degrees of freedom; others take part in no joint.
    pub(crate) fn new(
        equations: &Equations,
        bodies: impl Iterator<Item = std::ops::Range<usize>>,
    ) -> Option<Self> {
        let mut blocks = Vec::new();
        let mut block_of = Vec::new();
        for range in bodies {
            let (start, size) = (range.start, range.len());
            let mass =
                DMatrix::from_fn(size, size, |i, j| equations.mass.get(start + i, start + j));
            block_of.resize(range.end, blocks.len());
            blocks.push(Block {
                start,
                mass: mass.cholesky()?,
            });
        }
        let mut metric = Self {
            blocks,
            block_of,
            rows: Vec::new(),
        };
        let count = equations.gradient.pattern().columns();
        metric.rows = (0..count)
            .map(|equation| metric.row(equations.gradient.column(equation)))
            .collect();
        Some(metric)
    }

    /// L⁻¹ Bᵢᵀ. The rigid motion of a body comes before its modes, on which L⁻¹ acts, too.
    fn row(&self, (dofs, values): (&[usize], &[f64])) -> Vec<(usize, f64)> {
        let mut row = Vec::new();
        for (dofs, values) in dofs.chunks_exact(6).zip(values.chunks_exact(6)) {
            let block = &self.blocks[self.block_of[dofs[0]]];
            let lower = block.mass.l_dirty();
            let first = row.len();
            for i in 0..lower.nrows() {
                let right = values.get(i).copied().unwrap_or(0.0);
                let known: f64 = (0..i)
                    .map(|j| lower[(i, j)] * Self::value(&row, first + j))
                    .sum();
                row.push((block.start + i, (right - known) / lower[(i, i)]));
            }
        }
        row
    }

    fn value(row: &[(usize, f64)], place: usize) -> f64 {
        row[place].1
    }

    /// L⁻ᵀ x in place: from the metric's coordinates to increments.
    pub(crate) fn scale_back(&self, x: &mut [f64]) {
        for block in &self.blocks {
            let lower = block.mass.l_dirty();
            let own = &mut x[block.start..block.start + lower.nrows()];
            for i in (0..own.len()).rev() {
                let known: f64 = (i + 1..own.len()).map(|j| lower[(j, i)] * own[j]).sum();
                own[i] = (own[i] - known) / lower[(i, i)];
            }
        }
    }

    /// B̂ᵀ with all its zeros, one column for each of these equations.
    pub(crate) fn dense_columns(&self, size: usize, equations: &[usize]) -> DMatrix<f64> {
        let mut dense = DMatrix::zeros(size, equations.len());
        for (column, &equation) in equations.iter().enumerate() {
            for &(dof, value) in &self.rows[equation] {
                dense[(dof, column)] = value;
            }
        }
        dense
    }

    /// ⟨B̂_a, B̂_b⟩
    pub(crate) fn product(&self, a: usize, b: usize) -> f64 {
        let (mut left, mut right) = (
            self.rows[a].iter().peekable(),
            self.rows[b].iter().peekable(),
        );
        let mut sum = 0.0;
        while let (Some(&&(i, x)), Some(&&(j, y))) = (left.peek(), right.peek()) {
            if i == j {
                sum += x * y;
            }
            if i <= j {
                left.next();
            }
            if j <= i {
                right.next();
            }
        }
        sum
    }

    /// The equations that are independent of those before them, with the factors of their G.
    pub(crate) fn independent(&self) -> (Vec<usize>, Factors) {
        let all: Vec<usize> = (0..self.rows.len()).collect();
        self.factorise(&all, |rest, length| rest > DEPENDENT * length)
    }

    /// Factors of G for these equations; `None` where they are not independent.
    pub(crate) fn factors(&self, kept: &[usize]) -> Option<Factors> {
        let (found, factors) = self.factorise(kept, |rest, _| rest > 0.0);
        (found.len() == kept.len()).then_some(factors)
    }

    fn factorise(
        &self,
        candidates: &[usize],
        keeps: impl Fn(f64, f64) -> bool,
    ) -> (Vec<usize>, Factors) {
        let mut kept: Vec<usize> = Vec::new();
        let mut factors = Factors {
            first: Vec::new(),
            rows: Vec::new(),
        };
        // First kept equation on each body.
        let mut neighbour = vec![usize::MAX; self.blocks.len()];
        for &equation in candidates {
            let blocks = self.rows[equation]
                .iter()
                .map(|&(dof, _)| self.block_of[dof]);
            let first = blocks.clone().map(|block| neighbour[block]).min();
            let first = first.unwrap_or(kept.len()).min(kept.len());
            let square = self.product(equation, equation);
            let right = kept[first..]
                .iter()
                .map(|&other| self.product(other, equation));
            let mut row = factors.forward(first, right.collect());
            let left = square - row.iter().map(|x| x * x).sum::<f64>();
            let rest = if left > DOUBTFUL * square {
                left.sqrt()
            } else {
                self.rest(equation, &kept, &factors)
            };
            if keeps(rest, square.sqrt()) {
                for block in blocks {
                    neighbour[block] = neighbour[block].min(kept.len());
                }
                kept.push(equation);
                row.push(rest);
                factors.first.push(first);
                factors.rows.push(row);
            }
        }
        (kept, factors)
    }

    /// Length of what is left of a row of B̂ without its projection on the kept ones; projected twice, so that rounding
    /// does not hide a dependence.
    fn rest(&self, equation: usize, kept: &[usize], factors: &Factors) -> f64 {
        let mut rest = vec![0.0; self.block_of.len()];
        for &(dof, value) in &self.rows[equation] {
            rest[dof] = value;
        }
        for _ in 0..2 {
            let along = |&other: &usize| {
                let row = self.rows[other].iter();
                row.map(|&(dof, value)| value * rest[dof]).sum()
            };
            let mut weights: Vec<f64> = kept.iter().map(along).collect();
            factors.solve(&mut weights);
            for (&other, weight) in kept.iter().zip(&weights) {
                for &(dof, value) in &self.rows[other] {
                    rest[dof] -= weight * value;
                }
            }
        }
        rest.iter().map(|x| x * x).sum::<f64>().sqrt()
    }

    /// Smallest motion δ (in the metric) with B δ = p for the kept equations.
    pub(crate) fn least_motion(
        &self,
        size: usize,
        (kept, factors): (&[usize], &Factors),
        p: &[f64],
    ) -> Vec<f64> {
        let mut weights: Vec<f64> = kept.iter().map(|&equation| p[equation]).collect();
        factors.solve(&mut weights);
        let mut motion = vec![0.0; size];
        for (&equation, weight) in kept.iter().zip(&weights) {
            for &(dof, value) in &self.rows[equation] {
                motion[dof] += weight * value;
            }
        }
        self.scale_back(&mut motion);
        motion
    }

    /// The kept equations that a dropped one is a combination of.
    pub(crate) fn implying(
        &self,
        (kept, factors): (&[usize], &Factors),
        dropped: usize,
    ) -> Vec<usize> {
        let mut weights: Vec<f64> = kept
            .iter()
            .map(|&other| self.product(other, dropped))
            .collect();
        factors.solve(&mut weights);
        let largest = weights.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let entries = kept.iter().zip(&weights);
        entries
            .filter(|(_, weight)| weight.abs() > 1e-6 * largest)
            .map(|(&index, _)| index)
            .collect()
    }
}

impl Factors {
    /// The next row of the factors, without its diagonal, from the row of G from its first neighbour on.
    fn forward(&self, first: usize, mut row: Vec<f64>) -> Vec<f64> {
        for k in 0..row.len() {
            let other = &self.rows[first + k];
            let begin = self.first[first + k].max(first);
            let before = &other[begin - self.first[first + k]..other.len() - 1];
            let known: f64 = row[begin - first..k]
                .iter()
                .zip(before)
                .map(|(a, b)| a * b)
                .sum();
            row[k] = (row[k] - known) / other[other.len() - 1];
        }
        row
    }

    /// G⁻¹ x in place.
    fn solve(&self, x: &mut [f64]) {
        for (k, (row, &first)) in self.rows.iter().zip(&self.first).enumerate() {
            let (before, diagonal) = (&row[..row.len() - 1], row[row.len() - 1]);
            let known: f64 = before.iter().zip(&x[first..k]).map(|(a, b)| a * b).sum();
            x[k] = (x[k] - known) / diagonal;
        }
        for (k, (row, &first)) in self.rows.iter().zip(&self.first).enumerate().rev() {
            let (before, diagonal) = (&row[..row.len() - 1], row[row.len() - 1]);
            x[k] /= diagonal;
            let here = x[k];
            for (target, value) in x[first..k].iter_mut().zip(before) {
                *target -= value * here;
            }
        }
    }
}
