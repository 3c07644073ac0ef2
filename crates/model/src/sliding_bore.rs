//! A gear whose bore slides on a rigid pin: the compliance of its flanks with the motions of the bore that no force
//! holds.
//!
//! ```text
//! S_oo q_o = s_oᵀ f,      C = C_hub + s_o S_oo⁻¹ s_oᵀ        o: tangential and axial motions but the rigid ones
//! ```
//!
//! Radial motions are held, as by a pin that presses and pulls. The uniform tangential and the uniform axial motion
//! belong to the motion of the body. Theory: docs/theory/bore_patterns.md.

use crate::bore_patterns::BoreMotion;
use crate::reduced_gear::ReducedGear;
use crate::reduced_gear_error::ReducedGearError;

impl ReducedGear {
    /// The gear with a bore that slides, as flanks feel it. Gauges, modes and the bore's motions, which are those of a
    /// held bore, are left out.
    ///
    /// # Errors
    /// [`ReducedGearError::NoBoreMotions`] for a model without motions of its bore, [`ReducedGearError::BoreStiffness`]
    /// if their stiffness is not positive.
    pub fn with_sliding_bore(&self) -> Result<Self, ReducedGearError> {
        let Some(bore) = &self.bore else {
            let gear = self.name.clone();
            return Err(ReducedGearError::NoBoreMotions { gear });
        };
        let (m, loads, own) = (bore.count(), self.grid.len(), self.teeth_per_sector());
        let mut free: Vec<usize> = bore.motions_of(BoreMotion::Tangential).skip(1).collect();
        if bore.components > 2 {
            free.extend(bore.motions_of(BoreMotion::Axial).skip(1));
        }
        let n = free.len();
        let entry = |i: usize, j: usize| bore.stiffness[free[i] * m + free[j]];
        let factor = cholesky(n, entry).ok_or_else(|| ReducedGearError::BoreStiffness {
            gear: self.name.clone(),
        })?;
        // L⁻¹ s_oᵀ of each flank, `[tooth][flank][load][motion]`: a product of two is what the bore's motions add.
        let mut halves = Vec::with_capacity(self.teeth * self.flanks.len() * loads * n);
        for tooth in 0..self.teeth {
            for flank in &self.flanks {
                let rows = self.bore_rows(tooth, *flank).unwrap_or_default();
                for row in rows.chunks_exact(m) {
                    let first = halves.len();
                    halves.extend(free.iter().map(|&motion| row[motion]));
                    forward(&factor, &mut halves[first..]);
                }
            }
        }
        let of_flank = loads * n;
        let half = |flank: usize| &halves[flank * of_flank..(flank + 1) * of_flank];
        let mut c_hub = self.c_hub_in_full().into_owned();
        let flanks = self.flanks.len();
        let blocks = c_hub.chunks_exact_mut(loads * loads).enumerate();
        for (number, block) in blocks {
            let (load, response) = (
                number / (self.teeth * flanks),
                number % (self.teeth * flanks),
            );
            debug_assert!(load < own * flanks);
            let pressed = half(load).chunks_exact(n);
            for (row, a) in block.chunks_exact_mut(loads).zip(pressed) {
                for (value, b) in row.iter_mut().zip(half(response).chunks_exact(n)) {
                    *value += a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
                }
            }
        }
        Ok(Self {
            c_hub,
            hub_patterns: None,
            gauges: Vec::new(),
            modes: None,
            bore: None,
            ..self.clone()
        })
    }
}

/// L of a symmetric matrix = L Lᵀ, row by row; none if it is not positive.
fn cholesky(n: usize, entry: impl Fn(usize, usize) -> f64) -> Option<Vec<Vec<f64>>> {
    let mut rows: Vec<Vec<f64>> = Vec::with_capacity(n);
    for i in 0..n {
        let mut row: Vec<f64> = Vec::with_capacity(i + 1);
        for j in 0..=i {
            let other = rows.get(j).map_or(&row[..], |row| &row[..j]);
            let passed: f64 = row.iter().zip(other).map(|(a, b)| a * b).sum();
            let value = entry(i, j) - passed;
            if j < i {
                row.push(value / rows[j][j]);
            } else if value > 1e-12 * entry(i, i) {
                row.push(value.sqrt());
            } else {
                return None;
            }
        }
        rows.push(row);
    }
    Some(rows)
}

/// L⁻¹ v.
fn forward(factor: &[Vec<f64>], v: &mut [f64]) {
    for (i, row) in factor.iter().enumerate() {
        let passed: f64 = row[..i].iter().zip(&*v).map(|(a, b)| a * b).sum();
        v[i] = (v[i] - passed) / row[i];
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use crate::synthetic::{small_bored_gear, small_reduced_gear};

    /// x of A x = b by Gauss-Jordan, A positive.
    fn solved(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
        for i in 0..b.len() {
            for k in 0..b.len() {
                if k != i {
                    let factor = a[k][i] / a[i][i];
                    let from = a[i].clone();
                    for (value, other) in a[k].iter_mut().zip(&from) {
                        *value -= factor * other;
                    }
                    b[k] -= factor * b[i];
                }
            }
        }
        b.iter()
            .enumerate()
            .map(|(i, value)| value / a[i][i])
            .collect()
    }

    /// Each entry by its formula, with the equation solved another way. 1e-12 of what is added.
    #[test]
    fn a_sliding_bore_adds_what_its_free_motions_do() {
        let gear = small_bored_gear();
        let released = gear.with_sliding_bore().unwrap();
        let bore = gear.bore.as_ref().unwrap();
        let m = bore.count();
        // Tangential, then axial ones, the uniform one of each left out.
        let (first, each) = (m / 3, m / 3);
        let free: Vec<usize> = (first + 1..first + each).chain(2 * each + 1..m).collect();
        let s = |i: usize| {
            free.iter()
                .map(|&j| bore.stiffness[i * m + j])
                .collect::<Vec<f64>>()
        };
        let matrix: Vec<Vec<f64>> = free.iter().map(|&i| s(i)).collect();
        let loads = gear.grid.len();
        for (tooth, other) in [
            (0, 0),
            (1, 4),
            (gear.teeth_per_sector() - 1, gear.teeth - 1),
        ] {
            for (of_a, of_b) in [(0, 1), (1, 1)] {
                let flanks = [gear.flanks[of_a], gear.flanks[of_b]];
                let rows = gear.bore_rows(tooth, flanks[0]).unwrap();
                let responses = gear.bore_rows(other, flanks[1]).unwrap();
                let before = gear.c_hub_block(tooth, flanks[0], other, flanks[1]);
                let after = released.c_hub_block(tooth, flanks[0], other, flanks[1]);
                for load in 0..loads {
                    let push = free.iter().map(|&q| rows[load * m + q]).collect();
                    let motion = solved(matrix.clone(), push);
                    for response in 0..loads {
                        let row = &responses[response * m..][..m];
                        let terms = free.iter().zip(&motion).map(|(&q, x)| row[q] * x);
                        let adds: f64 = terms.sum();
                        let at = load * loads + response;
                        let off = (after[at] - before[at] - adds).abs();
                        assert!(off < 1e-12 * before[at].abs().max(adds.abs()), "{off}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_model_without_motions_of_its_bore_says_so() {
        let message = small_reduced_gear()
            .with_sliding_bore()
            .unwrap_err()
            .to_string();
        assert!(message.contains("[reduction.bore]"), "{message}");
        let mut gear = small_bored_gear();
        let bore = gear.bore.as_mut().unwrap();
        bore.stiffness.iter_mut().for_each(|value| *value = -*value);
        let message = gear.with_sliding_bore().unwrap_err().to_string();
        assert!(message.contains("not positive"), "{message}");
    }
}
