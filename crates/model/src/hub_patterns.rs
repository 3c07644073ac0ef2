//! C_hub of a body that does not repeat, in few patterns a tooth.
//!
//! Loads on a tooth reach the body through the tooth's foot only, where the detail of where they stand on the flank is
//! hardly felt. With i and j the loads of a tooth (flank by flank), a and b two teeth, p and q patterns:
//!
//! ```text
//! C_hub(a i, b j) = δ_ab T_ij + Σ_pq V_ip B_(a p)(b q) V_jq
//! ```
//!
//! T and V are those of every tooth. docs/theory/cyclic_symmetry.md: where they come from and what is left out.

use crate::file_error::FileError;
use crate::quantity_check::{check_array, out_of_range};
use crate::record::{Fields, OPEN};
use crate::reduced_gear_error::ReducedGearError;
use std::sync::Arc;

/// C_hub by patterns.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct HubPatterns {
    /// Number of patterns r of a tooth.
    pub count: usize,
    /// T in m/N, `[load][response]`: loads of a flank after those of the other.
    pub own_tooth: Vec<f64>,
    /// V, `[load][pattern]`.
    pub shares: Vec<f64>,
    /// B in m/N: lower triangle, row by row, over teeth and their patterns. Shared by all who combine its loads.
    pub body: Arc<Vec<f64>>,
}

impl HubPatterns {
    /// Lengths of T, V and B for a number of loads of a tooth and of teeth.
    fn lengths(&self, loads: usize, teeth: usize) -> [usize; 3] {
        let all = teeth.saturating_mul(self.count);
        let body = all.saturating_mul(all.saturating_add(1)) / 2;
        [loads * loads, loads.saturating_mul(self.count), body]
    }

    /// Whether the arrays are as long as a gear wants them. `sizes`: sectors, teeth, loads of a tooth.
    ///
    /// # Errors
    /// [`ReducedGearError::OutOfRange`] for a body that repeats, [`ReducedGearError::WrongLength`],
    /// [`ReducedGearError::NotFinite`].
    pub(crate) fn check(
        &self,
        [sectors, teeth, loads]: [usize; 3],
    ) -> Result<(), ReducedGearError> {
        if sectors != 1 {
            let item = "the sectors of a body whose C_hub is kept by patterns";
            return Err(out_of_range(item, sectors, "1"));
        }
        let [own_tooth, shares, body] = self.lengths(loads, teeth);
        let square = "(flanks * loads) squared";
        check_array("own_tooth of C_hub", &self.own_tooth, own_tooth, square)?;
        let product = "flanks * loads * patterns";
        check_array("shares of C_hub", &self.shares, shares, product)?;
        let triangle = "a lower triangle over teeth * patterns";
        check_array("body of C_hub", &self.body, body, triangle)
    }

    /// The same for combinations of loads, each a list of loads of a tooth and shares: T and V between them, B as it
    /// is.
    #[must_use]
    pub fn combined(&self, combinations: &[Vec<(usize, f64)>]) -> Self {
        let (r, n) = (self.count, combinations.len());
        let all = self.shares.len() / r.max(1);
        let mut own_tooth = Vec::with_capacity(n * n);
        let mut shares = vec![0.0; n * r];
        let mut loaded = vec![0.0; all];
        for (row, sums) in combinations.iter().zip(shares.chunks_exact_mut(r.max(1))) {
            loaded.fill(0.0);
            for &(load, share) in row {
                add(&mut loaded, share, &self.own_tooth[load * all..][..all]);
                add(sums, share, &self.shares[load * r..][..r]);
            }
            own_tooth.extend((combinations.iter()).map(|column| {
                let of_responses = column.iter().map(|&(m, share)| share * loaded[m]);
                of_responses.sum::<f64>()
            }));
        }
        Self {
            count: r,
            own_tooth,
            shares,
            body: Arc::clone(&self.body),
        }
    }

    /// B between two teeth: load pattern p, response pattern q.
    fn between(&self, a: usize, p: usize, b: usize, q: usize) -> f64 {
        let (load, response) = (a * self.count + p, b * self.count + q);
        let (row, column) = (load.max(response), load.min(response));
        self.body[row * (row + 1) / 2 + column]
    }

    /// The block of C_hub between two flanks, `[load][response]`: of tooth `a` from its load `from` on, of tooth `b`
    /// from its load `to` on, so many `loads` of each.
    #[must_use]
    pub fn block(&self, [a, b]: [usize; 2], [from, to]: [usize; 2], loads: [usize; 2]) -> Vec<f64> {
        let r = self.count;
        let all = self.shares.len() / r.max(1);
        let mut between = vec![0.0; r * r];
        for p in 0..r {
            for q in 0..r {
                between[p * r + q] = self.between(a, p, b, q);
            }
        }
        let share = |load: usize| &self.shares[load * r..(load + 1) * r];
        let mut block = vec![0.0; loads[0] * loads[1]];
        let mut passed = vec![0.0; r];
        for (l, row) in block.chunks_exact_mut(loads[1]).enumerate() {
            passed.fill(0.0);
            for (v, line) in share(from + l).iter().zip(between.chunks_exact(r)) {
                add(&mut passed, *v, line);
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
        f.bulk("body", Arc::make_mut(&mut self.body), &axes, "m/N", what)
    }
}

/// Adds a multiple of a row.
fn add(sums: &mut [f64], share: f64, row: &[f64]) {
    for (sum, value) in sums.iter_mut().zip(row) {
        *sum += share * value;
    }
}
