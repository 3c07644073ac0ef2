//! C_hub of a body that does not repeat, found and kept by the patterns that a tooth passes on to its body.
//!
//! Loads on a tooth reach the body through the tooth's foot only. With T what stays inside the tooth, the same on
//! every tooth,
//!
//! ```text
//! C_hub(a, b) = δ_ab T + B_ab ≈ δ_ab T + V (Vᵀ B_ab V) Vᵀ,        V orthonormal: loads × patterns
//! ```
//!
//! Where a load stands on the flank is felt below the tooth less and less, the finer the detail (Saint-Venant). V are
//! the left singular vectors of the blocks of some teeth with themselves and a neighbour, where detail is felt most.
//! Of the wheel with 47 teeth and six holes 198 loads a tooth leave some 75 patterns. So all loads are solved for on
//! the sampled teeth only, on the others the patterns.
//!
//! What is left out, with P = V Vᵀ, is B − P B P = (1 − P) B P + P B (1 − P) + (1 − P) B (1 − P). Between sampled
//! teeth every entry of it is known. For the others the patterns are joined by what they leave of some combinations g
//! of all loads with random signs: the mean square of an entry of E g is the sum of the squares of that row of E, so
//! that no entry of E is likely to be larger than the largest of E g.

use crate::Progress;
use crate::flank_loads::SparseVector;
use crate::gear_body::GearBody;
use crate::repeated_mesh::RepeatedMesh;
use crate::single_sector::{HalfSolves, SingleSector};
use faer::{Mat, MatRef};
use gearmesh_model::HubPatterns;
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Largest difference of an entry over the largest entry. Far below any mesh error, and below what single precision
/// would leave out (6e-8).
const ALLOWED: f64 = 1e-8;
/// The same of the sampled teeth, from which the patterns are: on the others they leave more.
const ALLOWED_OF_SAMPLED: f64 = 0.1 * ALLOWED;
/// The first choice: singular values above this share of the largest.
const FIRST_CHOICE: f64 = 1e-9;
/// Patterns that are added where that is not enough.
const MORE: usize = 10;
/// Teeth, evenly round the gear, whose blocks with themselves and the next tooth give the patterns.
const SAMPLED_PAIRS: usize = 4;
/// Combinations of loads with random signs on each of the other teeth.
const PROBES: usize = 2;
/// Teeth that are solved at a time: enough blocks of columns for the threads, not much memory.
const TOGETHER: usize = 2;

/// C_hub by patterns and what was found on the way.
pub struct FoundPatterns {
    /// T, V, B.
    pub patterns: HubPatterns,
    /// Largest entry that they leave out, over the largest of all.
    pub left_out: f64,
    /// C_hub of the loads of tooth 0, `[load][tooth][response]` (m/N): in full where the response is on a sampled
    /// tooth, tooth 0 among them.
    pub first_tooth: Vec<f64>,
    /// Right-hand sides that were solved.
    pub solved: usize,
}

/// Solves for the patterns of C_hub; none for a body that repeats or was factorised as a whole, and where there would
/// be as many of them as loads. `vectors`: the loads of tooth 0.
pub fn by_patterns(
    body: &GearBody<impl RepeatedMesh>,
    vectors: &[&SparseVector],
    progress: &dyn Progress,
) -> Option<FoundPatterns> {
    let sector = body.single_sector(vectors, progress)?;
    let (n, teeth) = (vectors.len(), sector.teeth());
    let pairs = (0..SAMPLED_PAIRS).map(|k| k * teeth / SAMPLED_PAIRS);
    let sampled: BTreeSet<usize> = pairs.flat_map(|a| [a, (a + 1) % teeth]).collect();
    let sampled = Sampled::new(&sector, sampled, progress);
    let svd = sampled.side_by_side().thin_svd().ok()?;
    let sizes = svd.S().column_vector();
    let mut count = (0..n)
        .take_while(|&k| sizes[k] > FIRST_CHOICE * sizes[0])
        .count();
    while count < n {
        let shares = svd.U().subcols(0, count);
        let left_out = sampled.left_out(shares) / sampled.largest;
        if left_out <= ALLOWED_OF_SAMPLED {
            let others = Others::new(&sector, &sampled, shares, progress);
            let (blocks, more) = others.products(&sampled, progress);
            let left_out = left_out.max(more / sampled.largest);
            if left_out <= ALLOWED {
                return Some(FoundPatterns {
                    patterns: HubPatterns {
                        count,
                        own_tooth: row_by_row(sampled.inside.as_ref()),
                        shares: row_by_row(shares),
                        body: Arc::new(lower_triangle(&blocks, teeth, count)),
                    },
                    left_out,
                    first_tooth: sampled.first_rows(&blocks, shares, teeth),
                    solved: sector.solved(),
                });
            }
        }
        count += MORE;
    }
    None
}

/// Teeth of which all loads are solved.
struct Sampled {
    /// Ascending, the first of them tooth 0.
    numbers: Vec<usize>,
    solves: Vec<HalfSolves>,
    /// B between them: the i-th with all up to itself.
    blocks: Vec<Vec<Mat<f64>>>,
    /// T.
    inside: Mat<f64>,
    /// Largest entry of C_hub (m/N).
    largest: f64,
}

impl Sampled {
    fn new(sector: &SingleSector<'_>, teeth: BTreeSet<usize>, progress: &dyn Progress) -> Self {
        progress.stage("solving all loads of some teeth");
        let inside = sector.inside();
        let all_loads = Mat::identity(inside.nrows(), inside.nrows());
        let numbers: Vec<usize> = teeth.into_iter().collect();
        let mut solves = Vec::with_capacity(numbers.len());
        for &tooth in &numbers {
            solves.push(sector.half_solves(tooth, all_loads.as_ref()));
            progress.advance(solves.len(), numbers.len());
        }
        let up_to = |i: usize| {
            let earlier = (0..=i).into_par_iter();
            earlier
                .map(|j| sector.work(&solves[i], &solves[j]))
                .collect()
        };
        let blocks: Vec<Vec<Mat<f64>>> = (0..numbers.len()).map(up_to).collect();
        let largest = (blocks.iter().enumerate())
            .map(|(i, row)| (&row[i] + &inside).norm_max())
            .fold(0.0, f64::max);
        Self {
            numbers,
            solves,
            blocks,
            inside,
            largest,
        }
    }

    /// B between the i-th and the j-th.
    fn block(&self, i: usize, j: usize) -> MatRef<'_, f64> {
        if j <= i {
            self.blocks[i][j].as_ref()
        } else {
            self.blocks[j][i].transpose()
        }
    }

    /// All blocks side by side.
    fn side_by_side(&self) -> Mat<f64> {
        let (n, count) = (self.inside.nrows(), self.numbers.len());
        let mut stack = Mat::zeros(n, n * count * count);
        for k in 0..count * count {
            let block = self.block(k / count, k % count);
            stack.as_mut().subcols_mut(k * n, n).copy_from(block);
        }
        stack
    }

    /// Largest entry of their blocks that patterns leave out (m/N).
    fn left_out(&self, shares: MatRef<'_, f64>) -> f64 {
        let of_block = |block: &Mat<f64>| {
            let between = shares.transpose() * block * shares;
            (block - shares * between * shares.transpose()).norm_max()
        };
        let blocks = self.blocks.par_iter().flatten();
        blocks.map(of_block).reduce(|| 0.0, f64::max)
    }

    /// C_hub of tooth 0's loads: from its own solutions, where the response is on another tooth from the patterns.
    /// `kept`: VᵀBV, lower triangle of teeth.
    fn first_rows(&self, kept: &[Mat<f64>], shares: MatRef<'_, f64>, teeth: usize) -> Vec<f64> {
        let n = self.inside.nrows();
        let blocks: Vec<Mat<f64>> = (0..teeth)
            .map(|tooth| match self.numbers.binary_search(&tooth) {
                Ok(0) => self.block(0, 0) + &self.inside,
                Ok(i) => self.block(0, i).to_owned(),
                Err(_) => shares * kept[tooth * (tooth + 1) / 2].transpose() * shares.transpose(),
            })
            .collect();
        let mut rows = Vec::with_capacity(n * n * teeth);
        for load in 0..n {
            for block in &blocks {
                rows.extend((0..n).map(|response| block[(load, response)]));
            }
        }
        rows
    }
}

/// The other teeth, of which patterns are solved.
struct Others<'a> {
    sector: &'a SingleSector<'a>,
    /// V.
    shares: MatRef<'a, f64>,
    /// Of the patterns, then of what they leave of combinations of all loads.
    solves: Vec<HalfSolves>,
}

impl<'a> Others<'a> {
    fn new(
        sector: &'a SingleSector<'a>,
        sampled: &Sampled,
        shares: MatRef<'a, f64>,
        progress: &dyn Progress,
    ) -> Self {
        progress.stage("solving patterns of the other teeth");
        let (n, r) = shares.shape();
        let mut random = fastrand::Rng::with_seed(n as u64);
        let signs = Mat::from_fn(n, PROBES, |_, _| if random.bool() { 1.0 } else { -1.0 });
        let mut columns = Mat::zeros(n, r + PROBES);
        columns.as_mut().subcols_mut(0, r).copy_from(shares);
        let left = &signs - shares * (shares.transpose() * &signs);
        columns.as_mut().subcols_mut(r, PROBES).copy_from(left);
        let numbers: Vec<usize> = (0..sector.teeth())
            .filter(|tooth| sampled.numbers.binary_search(tooth).is_err())
            .collect();
        let mut solves = Vec::with_capacity(numbers.len());
        for teeth in numbers.chunks(TOGETHER) {
            let solve = |tooth: &usize| sector.half_solves(*tooth, columns.as_ref());
            solves.par_extend(teeth.par_iter().map(solve));
            progress.advance(solves.len(), numbers.len());
        }
        Self {
            sector,
            shares,
            solves,
        }
    }

    /// VᵀBV of each tooth with all up to itself, and the largest entry that is found to be left out where a tooth is
    /// not among the sampled.
    fn products(&self, sampled: &Sampled, progress: &dyn Progress) -> (Vec<Mat<f64>>, f64) {
        let teeth = self.sector.teeth();
        progress.stage("work of the loads of each tooth on each");
        let pairs: Vec<(usize, usize)> = (0..teeth)
            .flat_map(|a| (0..=a).map(move |b| (a, b)))
            .collect();
        let done = AtomicUsize::new(0);
        let found: Vec<(Mat<f64>, f64)> = (pairs.par_iter())
            .map(|&(a, b)| {
                let found = self.pair(sampled, a, b);
                progress.advance(done.fetch_add(1, Ordering::Relaxed) + 1, pairs.len());
                found
            })
            .collect();
        let left_out = found.iter().fold(0.0_f64, |most, (_, own)| most.max(*own));
        let blocks = found.into_iter().map(|(between, _)| between).collect();
        (blocks, left_out)
    }

    fn pair(&self, sampled: &Sampled, a: usize, b: usize) -> (Mat<f64>, f64) {
        let (v, r) = (self.shares, self.shares.ncols());
        let place = |tooth: usize| sampled.numbers.binary_search(&tooth);
        // A tooth that is not sampled is the one behind those sampled before it.
        match (place(a), place(b)) {
            (Ok(i), Ok(j)) => (v.transpose() * sampled.block(i, j) * v, 0.0),
            (Ok(i), Err(before)) => {
                let work = (self.sector).work(&sampled.solves[i], &self.solves[b - before]);
                self.half_known(work.as_ref())
            }
            (Err(before), Ok(j)) => {
                let work = (self.sector).work(&sampled.solves[j], &self.solves[a - before]);
                let (between, left_out) = self.half_known(work.as_ref());
                (between.transpose().to_owned(), left_out)
            }
            (Err(before_a), Err(before_b)) => {
                let work =
                    (self.sector).work(&self.solves[a - before_a], &self.solves[b - before_b]);
                let (known, left) = work.split_at_row(r);
                let one_side = v * known.subcols(r, PROBES);
                let other_side = v * left.subcols(0, r).transpose();
                let both = left.subcols(r, PROBES);
                let left_out = one_side.norm_max() + other_side.norm_max() + both.norm_max();
                (known.subcols(0, r).to_owned(), left_out)
            }
        }
    }

    /// VᵀBV and the largest entry left out, from B of all loads of a sampled tooth and the columns of another one.
    fn half_known(&self, work: MatRef<'_, f64>) -> (Mat<f64>, f64) {
        let (v, r) = (self.shares, self.shares.ncols());
        let (patterns, left) = work.split_at_col(r);
        let between = v.transpose() * patterns;
        let one_side = (patterns - v * &between) * v.transpose();
        (between, one_side.norm_max() + left.norm_max())
    }
}

fn row_by_row(matrix: MatRef<'_, f64>) -> Vec<f64> {
    let rows = 0..matrix.nrows();
    rows.flat_map(|i| (0..matrix.ncols()).map(move |j| matrix[(i, j)]))
        .collect()
}

/// Rows over teeth and their patterns, each up to its diagonal.
fn lower_triangle(blocks: &[Mat<f64>], teeth: usize, count: usize) -> Vec<f64> {
    let all = teeth * count;
    let mut triangle = Vec::with_capacity(all * (all + 1) / 2);
    for a in 0..teeth {
        for p in 0..count {
            for b in 0..=a {
                let block = &blocks[a * (a + 1) / 2 + b];
                let most = if a == b { p + 1 } else { count };
                triangle.extend((0..most).map(|q| block[(p, q)]));
            }
        }
    }
    triangle
}
