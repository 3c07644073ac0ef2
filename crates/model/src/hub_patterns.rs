//! C_hub of a body that does not repeat, in few patterns a tooth.
//!
//! Loads on a tooth reach the body through the tooth's foot only, and what they do there is little of what they are on the flank. With i
//! and j the loads of a tooth (flank by flank), a and b two teeth, p and q patterns:
//!
//! ```text
//! C_hub(a i, b j) = δ_ab T_ij + Σ_pq V_ip B_(a p)(b q) V_jq
//! ```
//!
//! T and V are those of every tooth. docs/theory/cyclic_symmetry.md: where they come from and what is left out.

use crate::file_error::FileError;
use crate::record::{Fields, OPEN};

/// C_hub by patterns.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct HubPatterns {
    /// Number of patterns r of a tooth.
    pub count: usize,
    /// T in m/N, `[load][response]`: loads of a flank after those of the other.
    pub own_tooth: Vec<f64>,
    /// V, `[load][pattern]`.
    pub shares: Vec<f64>,
    /// B in m/N: lower triangle, row by row, over teeth and their patterns.
    pub body: Vec<f64>,
}

impl HubPatterns {
    /// Lengths of T, V and B for a number of loads of a tooth and of teeth.
    pub(crate) fn lengths(&self, loads: usize, teeth: usize) -> [usize; 3] {
        let all = teeth.saturating_mul(self.count);
        let body = all.saturating_mul(all.saturating_add(1)) / 2;
        [loads * loads, loads.saturating_mul(self.count), body]
    }

    /// B between two teeth: load pattern p, response pattern q.
    fn between(&self, a: usize, p: usize, b: usize, q: usize) -> f64 {
        let (load, response) = (a * self.count + p, b * self.count + q);
        let (row, column) = (load.max(response), load.min(response));
        self.body[row * (row + 1) / 2 + column]
    }

    /// The block of C_hub between two flanks, `[load][response]`: of tooth `a` from its load `from` on, of tooth `b` from its load
    /// `to` on, `loads` each.
    pub(crate) fn block(
        &self,
        [a, b]: [usize; 2],
        [from, to]: [usize; 2],
        loads: usize,
    ) -> Vec<f64> {
        let r = self.count;
        let all = self.shares.len() / r.max(1);
        let mut between = vec![0.0; r * r];
        for p in 0..r {
            for q in 0..r {
                between[p * r + q] = self.between(a, p, b, q);
            }
        }
        let share = |load: usize| &self.shares[load * r..(load + 1) * r];
        let mut block = vec![0.0; loads * loads];
        let mut passed = vec![0.0; r];
        for (l, row) in block.chunks_exact_mut(loads).enumerate() {
            passed.fill(0.0);
            for (v, line) in share(from + l).iter().zip(between.chunks_exact(r)) {
                for (sum, value) in passed.iter_mut().zip(line) {
                    *sum += v * value;
                }
            }
            for (m, value) in row.iter_mut().enumerate() {
                let both = share(to + m).iter().zip(&passed);
                *value = both.map(|(v, sum)| v * sum).sum();
                if a == b {
                    *value += self.own_tooth[(from + l) * all + to + m];
                }
            }
        }
        block
    }

    pub(crate) fn fields(
        &mut self,
        f: &mut Fields<'_>,
        loads: usize,
        frame: &'static str,
    ) -> Result<(), FileError> {
        f.count("count", &mut self.count, "patterns of a tooth")?;
        let what = "what stays inside a tooth, equal for all teeth";
        let axes = [("load of a tooth", loads), ("response", loads)];
        f.in_frame(frame)
            .numbers("own_tooth", &mut self.own_tooth, &axes, "m/N", what)?;
        let what = "share of each pattern in a load, equal for all teeth";
        let axes = [("load of a tooth", loads), ("pattern", self.count)];
        f.in_frame(frame)
            .numbers("shares", &mut self.shares, &axes, "1", what)?;
        let what = "compliance of the body between patterns: lower triangle, row by row, over teeth and their patterns";
        let axes = [("pair of patterns", OPEN)];
        f.bulk("body", &mut self.body, &axes, "m/N", what)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use crate::synthetic::small_patterned_gear;
    use gearmesh_geometry::Flank;

    /// Each entry by the formula of this file's head, and a force here moves what is there as much as the other way round.
    #[test]
    fn blocks_are_sums_over_patterns() {
        let gear = small_patterned_gear();
        gear.validate().unwrap();
        let patterns = gear.hub_patterns.as_ref().unwrap();
        let (loads, r) = (gear.grid.len(), patterns.count);
        let flanks = [Flank::Right, Flank::Left];
        for (a, b) in [(0, 0), (0, 3), (5, 2)] {
            for (f, g) in [(0, 0), (0, 1), (1, 0)] {
                let block = gear.c_hub_block(a, flanks[f], b, flanks[g]);
                let back = gear.c_hub_block(b, flanks[g], a, flanks[f]);
                for l in 0..loads {
                    for m in 0..loads {
                        let (i, j) = (f * loads + l, g * loads + m);
                        let mut sum = if a == b {
                            patterns.own_tooth[i * 2 * loads + j]
                        } else {
                            0.0
                        };
                        for p in 0..r {
                            for q in 0..r {
                                let (load, response) = (a * r + p, b * r + q);
                                let (row, column) = (load.max(response), load.min(response));
                                let between = patterns.body[row * (row + 1) / 2 + column];
                                sum += patterns.shares[i * r + p]
                                    * between
                                    * patterns.shares[j * r + q];
                            }
                        }
                        let value = block[l * loads + m];
                        assert!((value - sum).abs() < 1e-12 * sum.abs().max(1e-9));
                        assert!((value - back[m * loads + l]).abs() < 1e-15);
                    }
                }
            }
        }
        assert_eq!(gear.c_hub_in_full().len(), (gear.teeth * 2 * loads).pow(2));
    }
}
