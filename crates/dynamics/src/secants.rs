//! Broyden's update: what the corrections of one step tell about the error of an old Newton matrix.
//!
//! With J₀ the factorised matrix and s_k the corrections made so far, all by Broyden's matrices, the next one is
//!
//! ```text
//! z = −J₀⁻¹ r;    z ← z + s_{j+1} ⟨s_j, z⟩/⟨s_j, s_j⟩  for j = 0 … k − 1;    s_{k+1} = z/(1 − ⟨s_k, z⟩/⟨s_k, s_k⟩)
//! ```
//!
//! ⟨⟩ weighs the increments with their masses; reactions take part in s, not in ⟨⟩, which is a Broyden update all the
//! same. A contact whose stiffness has changed is an error of rank one: one update removes it. Nothing is kept from
//! step to step.
//!
//! Source: C. T. Kelley, Iterative Methods for Linear and Nonlinear Equations, SIAM 1995, section 7.3.

/// Corrections kept; after as many the memory begins anew.
const MOST: usize = 6;

/// 1 − ⟨s, z⟩/⟨s, s⟩ outside this range says that the matrix is no approximation: the plain correction is then taken.
const TRUSTED: std::ops::RangeInclusive<f64> = 0.3..=3.0;

/// Corrections of the present step.
pub(crate) struct Secants {
    weights: Vec<f64>,
    /// Increments and reactions of each correction, one after the other.
    corrections: Vec<Vec<f64>>,
    squares: [f64; MOST],
    count: usize,
}

impl Secants {
    /// For increments of these masses and so many joint equations.
    pub(crate) fn new(masses: &[f64], equations: usize) -> Self {
        Self {
            weights: masses.to_vec(),
            corrections: vec![vec![0.0; masses.len() + equations]; MOST],
            squares: [0.0; MOST],
            count: 0,
        }
    }

    /// Begins anew: another step, or new factors.
    pub(crate) fn reset(&mut self) {
        self.count = 0;
    }

    /// Turns the correction by the old matrix into Broyden's, and keeps it.
    pub(crate) fn improve(&mut self, delta: &mut [f64], mu: &mut [f64]) {
        let n = delta.len();
        for j in 0..self.count {
            let share = self.product(j, delta) / self.squares[j];
            let (next, factor) = if j + 1 < self.count {
                (j + 1, share)
            } else if TRUSTED.contains(&(1.0 - share)) {
                // z/(1 − share) = z + z share/(1 − share)
                let factor = 1.0 / (1.0 - share);
                for value in delta.iter_mut().chain(mu.iter_mut()) {
                    *value *= factor;
                }
                break;
            } else {
                self.count = 0;
                break;
            };
            let (of_delta, of_mu) = self.corrections[next].split_at(n);
            for (value, other) in delta.iter_mut().zip(of_delta) {
                *value += factor * other;
            }
            for (value, other) in mu.iter_mut().zip(of_mu) {
                *value += factor * other;
            }
        }
        if self.count == MOST {
            self.count = 0;
        }
        let place = &mut self.corrections[self.count];
        place[..n].copy_from_slice(delta);
        place[n..].copy_from_slice(mu);
        let square = self.product(self.count, delta);
        self.squares[self.count] = square;
        // Nothing to learn from no correction at all, or from one that is no number.
        self.count = if square > 0.0 { self.count + 1 } else { 0 };
    }

    fn product(&self, correction: usize, delta: &[f64]) -> f64 {
        let pairs = self.corrections[correction].iter().zip(delta);
        pairs.zip(&self.weights).map(|((a, b), w)| w * a * b).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Residual A x − b with J₀ = 1: the number of corrections until it vanishes.
    fn corrections(a: [[f64; 3]; 3], broyden: bool) -> usize {
        let b = [1.0, -2.0, 0.5];
        let mut x = [0.0; 3];
        let mut secants = Secants::new(&[2.0, 3.0], 1);
        for count in 0..200 {
            let residual: [f64; 3] =
                std::array::from_fn(|i| (0..3).map(|j| a[i][j] * x[j]).sum::<f64>() - b[i]);
            if residual.iter().all(|r| r.abs() < 1e-13) {
                return count;
            }
            let (mut delta, mut mu) = ([-residual[0], -residual[1]], [-residual[2]]);
            if broyden {
                secants.improve(&mut delta, &mut mu);
            }
            for (x, d) in x.iter_mut().zip(delta.iter().chain(&mu)) {
                *x += d;
            }
        }
        200
    }

    /// An error of rank one in the matrix costs two corrections more, whatever its size; one of rank two, four.
    #[test]
    fn an_error_of_low_rank_is_learnt() {
        let one = [[1.3, 0.2, 0.0], [0.3, 1.2, 0.0], [0.15, 0.1, 1.0]];
        assert!(corrections(one, false) > 20);
        assert!(corrections(one, true) <= 4, "{}", corrections(one, true));
        let two = [[1.3, 0.2, 0.0], [-0.1, 1.25, 0.0], [0.15, 0.1, 1.0]];
        assert!(corrections(two, false) > 20);
        assert!(corrections(two, true) <= 7, "{}", corrections(two, true));
    }
}
