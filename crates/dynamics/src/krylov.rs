//! Natural modes of large systems near zero, by block Arnoldi on the inverse of the shifted equations.
//!
//! With x = (y, ẏ) the equations M ÿ + C ẏ + K y + Bᵀλ = 0, B y = 0 are E ẋ = A x, and for a real shift σ
//!
//! ```text
//! (A − σE)⁻¹E (a, b) = (y, a + σ y),    S y + Bᵀμ = −(M (b + σ a) + C a),    B y = 0,    S = σ²M + σC + K
//! ```
//!
//! has the eigenvalues 1/(s − σ): those next to σ are the largest and are found first. S is sparse and factorised once.
//! Equations without mass and joints make eigenvalues zero, which is where they do no harm.
//!
//! Several starting vectors, so that frequencies that occur as often are found; all vectors are kept orthogonal
//! (twice), in coordinates weighted by the masses. The residual of a pair is what the projected matrix has below its
//! square part. Source: Y. Saad, *Numerical Methods for Large Eigenvalue Problems*, 2nd ed. 2011, sections 6.2 and 8.1.

use std::sync::Arc;

use faer::Mat;

use crate::equations::Equations;
use crate::error::DynamicsError;
use crate::matrix::Matrix;
use crate::saddle::{Saddle, SaddleForm};
use crate::scheme::LinearSolver;
use crate::system::System;

/// Starting vectors: a frequency that occurs more often may lack members.
const BLOCK: usize = 4;

/// The shift over the largest |s| wanted: eigenvalues then differ by less than a factor of five, and none is favoured.
const SHIFT: f64 = 0.3;

/// Residual of an eigenvalue 1/(s − σ) over itself at which it is found.
const FOUND: f64 = 1e-10;

/// Vectors at the first look, and their growth from one to the next.
const FIRST_LOOK: usize = 40;
const GROWTH: f64 = 1.4;

/// An eigenvalue with the displacement of its vector, all degrees of freedom.
pub(crate) struct Found {
    pub re: f64,
    pub im: f64,
    pub shape: Vec<[f64; 2]>,
}

/// All eigenvalues with |s| up to a limit \[rad/s\] and an imaginary part that is not negative; `None` where so many
/// are wanted that a dense solution takes less. The equations have rotations along world axes.
pub(crate) fn eigenvalues_within(
    system: &System,
    equations: &Equations,
    limit: f64,
    time_s: f64,
) -> Result<Option<Vec<Found>>, DynamicsError> {
    let shift = SHIFT * limit;
    let mut operator = Inverse::new(system, equations, shift, time_s)?;
    let mut basis = Basis::new(&mut operator);
    let most = operator.size() / 2;
    let mut look = FIRST_LOOK;
    loop {
        while basis.images.len() < look {
            if !basis.extend(&mut operator) {
                break;
            }
        }
        let all = basis.images.len() < look;
        if let Some(found) = basis.within(limit, shift, &operator, all)? {
            return Ok(Some(found));
        }
        if all || look > most {
            return Ok(None);
        }
        look = (GROWTH * look as f64) as usize;
    }
}

/// (A − σE)⁻¹E in coordinates weighted by √m, displacements times the shift, too.
struct Inverse<'a> {
    equations: &'a Equations,
    saddle: Saddle,
    weights: Vec<f64>,
    shift: f64,
    right: Vec<f64>,
    no_motion: Vec<f64>,
    delta: Vec<f64>,
    mu: Vec<f64>,
    work: Vec<f64>,
}

impl<'a> Inverse<'a> {
    fn new(
        system: &System,
        equations: &'a Equations,
        shift: f64,
        time_s: f64,
    ) -> Result<Self, DynamicsError> {
        let diagonal = system.mass_diagonal();
        let form = SaddleForm::new(&system.structure, &system.kept, LinearSolver::Automatic);
        let mut saddle = Saddle::new(&diagonal, system.layout.massless(), &Arc::new(form));
        let mut matrix = Matrix::zeros(&system.structure.square);
        // Over σ², so that it is like a mass matrix.
        matrix.set_combination(
            [1.0, 1.0 / shift, 1.0 / (shift * shift)],
            [&equations.mass, &equations.damping, &equations.stiffness],
        );
        if !saddle.factor(&matrix, &equations.gradient, &equations.gradient) {
            return Err(DynamicsError::singular(
                "the matrix of natural modes",
                time_s,
            ));
        }
        let (n, m) = (diagonal.len(), system.equations());
        Ok(Self {
            equations,
            saddle,
            weights: diagonal.iter().map(|mass| mass.sqrt()).collect(),
            shift,
            right: vec![0.0; n],
            no_motion: vec![0.0; m],
            delta: vec![0.0; n],
            mu: vec![0.0; m],
            work: vec![0.0; n],
        })
    }

    fn size(&self) -> usize {
        2 * self.weights.len()
    }

    fn apply(&mut self, x: &[f64]) -> Vec<f64> {
        let n = self.weights.len();
        let (upper, lower) = x.split_at(n);
        let shift = self.shift;
        self.right.fill(0.0);
        for (i, place) in self.work.iter_mut().enumerate() {
            *place = upper[i] / (self.weights[i] * shift);
        }
        subtract_product(&self.equations.damping, &self.work, &mut self.right);
        for (i, place) in self.work.iter_mut().enumerate() {
            *place = (lower[i] + upper[i]) / self.weights[i];
        }
        subtract_product(&self.equations.mass, &self.work, &mut self.right);
        for value in &mut self.right {
            *value /= shift * shift;
        }
        self.saddle
            .solve(&self.right, &self.no_motion, &mut self.delta, &mut self.mu);
        let mut image = vec![0.0; 2 * n];
        for i in 0..n {
            let y = self.delta[i] * self.weights[i] * shift;
            image[i] = y;
            // ẏ = a + σ y, a in displacements times the shift.
            image[n + i] = upper[i] / shift + y;
        }
        image
    }
}

/// y ← y − matrix · x
fn subtract_product(matrix: &Matrix, x: &[f64], y: &mut [f64]) {
    for (column, value) in x.iter().enumerate() {
        if *value != 0.0 {
            for (row, entry) in matrix.entries(column) {
                y[row] -= entry * value;
            }
        }
    }
}

/// Orthonormal vectors, and the images of the first of them as combinations of all.
struct Basis {
    vectors: Vec<Vec<f64>>,
    images: Vec<Vec<f64>>,
}

impl Basis {
    fn new(operator: &mut Inverse<'_>) -> Self {
        let mut basis = Self {
            vectors: Vec::new(),
            images: Vec::new(),
        };
        // The same vectors in every run.
        let mut random = fastrand::Rng::with_seed(1);
        for _ in 0..BLOCK {
            let start: Vec<f64> = (0..operator.size())
                .map(|_| 2.0 * random.f64() - 1.0)
                .collect();
            // Twice, so that what joints and equations without mass forbid is gone.
            let moved = operator.apply(&start);
            let moved = operator.apply(&moved);
            basis.add(moved);
        }
        basis
    }

    /// Makes a vector orthogonal to all and adds what is left; its coefficients, the length of what is left behind
    /// them.
    fn add(&mut self, mut vector: Vec<f64>) -> Vec<f64> {
        let length = norm(&vector);
        let mut coefficients = vec![0.0; self.vectors.len()];
        for _ in 0..2 {
            for (coefficient, other) in coefficients.iter_mut().zip(&self.vectors) {
                let along: f64 = other.iter().zip(&vector).map(|(a, b)| a * b).sum();
                *coefficient += along;
                for (value, part) in vector.iter_mut().zip(other) {
                    *value -= along * part;
                }
            }
        }
        let rest = norm(&vector);
        if rest > 1e-13 * length {
            vector.iter_mut().for_each(|value| *value /= rest);
            self.vectors.push(vector);
            coefficients.push(rest);
        }
        coefficients
    }

    /// The image of the next vector; `false` if there is none: the space is closed.
    fn extend(&mut self, operator: &mut Inverse<'_>) -> bool {
        let Some(next) = self.vectors.get(self.images.len()) else {
            return false;
        };
        let image = operator.apply(next);
        let coefficients = self.add(image);
        self.images.push(coefficients);
        true
    }

    /// What is within a limit, once all of it is found and something beyond it, too.
    fn within(
        &self,
        limit: f64,
        shift: f64,
        operator: &Inverse<'_>,
        closed: bool,
    ) -> Result<Option<Vec<Found>>, DynamicsError> {
        let size = self.images.len();
        let square = Mat::from_fn(size, size, |i, j| {
            self.images[j].get(i).copied().unwrap_or(0.0)
        });
        let pairs = square.eigen().map_err(|_| DynamicsError::Eigen {
            size: operator.size(),
        })?;
        let (values, vectors) = (pairs.S().column_vector(), pairs.U());
        let largest = (0..size)
            .map(|j| values[j].re.hypot(values[j].im))
            .fold(0.0, f64::max);
        let (mut inside, mut beyond) = (Vec::new(), 0);
        for j in 0..size {
            let length = values[j].re.hypot(values[j].im);
            if length <= 1e-12 * largest {
                continue;
            }
            let re = shift + values[j].re / length.powi(2);
            let im = -values[j].im / length.powi(2);
            let mut left = 0.0;
            for row in size..self.vectors.len() {
                let mut entry = [0.0; 2];
                for (k, image) in self.images.iter().enumerate() {
                    let h = image.get(row).copied().unwrap_or(0.0);
                    entry[0] += h * vectors[(k, j)].re;
                    entry[1] += h * vectors[(k, j)].im;
                }
                left += entry[0].powi(2) + entry[1].powi(2);
            }
            let found = closed || left.sqrt() <= FOUND * length;
            if re.hypot(im) > limit {
                beyond += usize::from(found);
            } else if !found {
                return Ok(None);
            } else if im >= 0.0 {
                inside.push((j, re, im));
            }
        }
        if beyond < 2 * BLOCK && !closed {
            return Ok(None);
        }
        let n = operator.weights.len();
        let found = inside.into_iter().map(|(j, re, im)| {
            let mut shape = vec![[0.0; 2]; n];
            for (k, vector) in self.vectors[..size].iter().enumerate() {
                let z = vectors[(k, j)];
                for (place, value) in shape.iter_mut().zip(vector) {
                    place[0] += z.re * value;
                    place[1] += z.im * value;
                }
            }
            for (place, weight) in shape.iter_mut().zip(&operator.weights) {
                *place = place.map(|value| value / weight);
            }
            Found { re, im, shape }
        });
        Ok(Some(found.collect()))
    }
}

fn norm(vector: &[f64]) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}
