//! What a tooth passes on to the body below it, in few patterns.
//!
//! Loads on a tooth reach the body through the tooth's foot only. Carried there they are F, feet × loads, and
//!
//! ```text
//! C(load on tooth a, response on tooth b) = δ_ab T + Fᵀ S_ab F        T inside the tooth, S of the body with all feet
//! F = U Σ Vᵀ ≈ P Vᵀ,  P = U Σ over σ > ε σ_1                          C = δ_ab T + V (Pᵀ S_ab P) Vᵀ
//! ```
//!
//! Where a load stands on the flank is felt below the tooth less and less, the finer the detail (Saint-Venant): of 198 loads on
//! both flanks some 80 patterns are left. Only these are solved for, and only Pᵀ S P is kept where the body does not repeat. What is left out
//! of F is below ε of its largest singular value; the check of C_hub against solved fields, to 1e-9, sees the patterns too.

use faer::{Mat, MatRef};
use gearmesh_model::HubPatterns;
use rayon::prelude::*;

/// ε: two orders below the 1e-9 to which C_hub is checked.
const LEFT_OUT: f64 = 1e-11;

/// Patterns of the loads of a tooth at its foot.
pub(crate) struct TransmittedPatterns {
    /// P: feet × patterns (N).
    pub at_foot: Mat<f64>,
    /// V: loads × patterns.
    pub shares: Mat<f64>,
}

impl TransmittedPatterns {
    /// Patterns of loads at a foot, feet × loads (N); the loads themselves where the body repeats, and there are few to be solved, or
    /// where that saves little.
    pub fn new(at_foot: &Mat<f64>, sectors: usize) -> Self {
        let loads = at_foot.ncols();
        let all = || Self {
            at_foot: at_foot.clone(),
            shares: Mat::identity(loads, loads),
        };
        if sectors > 1 {
            return all();
        }
        let Ok(svd) = at_foot.thin_svd() else {
            return all();
        };
        let sizes = svd.S().column_vector();
        let count = (0..sizes.nrows())
            .take_while(|&k| sizes[k] > LEFT_OUT * sizes[0])
            .count();
        if 5 * count > 4 * loads {
            return all();
        }
        Self {
            at_foot: Mat::from_fn(at_foot.nrows(), count, |i, k| svd.U()[(i, k)] * sizes[k]),
            shares: svd.V().subcols(0, count).to_owned(),
        }
    }
}

/// C_hub of the teeth of a sector against all teeth, by patterns.
pub struct PatternCompliance {
    /// T: inside a tooth, loads × loads (m/N).
    pub(crate) own_tooth: Mat<f64>,
    /// V: loads × patterns.
    pub(crate) shares: Mat<f64>,
    /// Pᵀ S P by the number of sectors from load to response: teeth of the responding sector and patterns × those of the loaded one.
    pub(crate) body: Vec<Mat<f64>>,
    /// Sector and number in it of each tooth.
    pub(crate) places: Vec<(usize, usize)>,
}

impl PatternCompliance {
    /// Number of patterns.
    pub fn patterns(&self) -> usize {
        self.shares.ncols()
    }

    fn block(&self, load_tooth: usize, response_tooth: usize) -> MatRef<'_, f64> {
        let (from, a) = self.places[load_tooth];
        let (to, b) = self.places[response_tooth];
        let (r, sectors) = (self.patterns(), self.body.len());
        self.body[(to + sectors - from) % sectors]
            .as_ref()
            .submatrix(b * r, a * r, r, r)
    }

    /// All of it for the first `own` loaded teeth: `[loaded tooth][load][tooth][response]`.
    pub fn rows(&self, own: usize) -> Vec<f64> {
        let (n, teeth) = (self.shares.nrows(), self.places.len());
        let mut rows = vec![0.0; own * n * teeth * n];
        rows.par_chunks_mut(n * teeth * n)
            .enumerate()
            .for_each(|(a, rows)| {
                for t in 0..teeth {
                    // Responses × loads.
                    let mut block = &self.shares * self.block(a, t) * self.shares.transpose();
                    if a == t {
                        block += &self.own_tooth;
                    }
                    for l in 0..n {
                        for m in 0..n {
                            rows[(l * teeth + t) * n + m] = block[(m, l)];
                        }
                    }
                }
            });
        rows
    }

    /// For the model file; none of a body that repeats, whose C_hub is short as it is.
    pub fn stored(&self) -> Option<HubPatterns> {
        if self.body.len() > 1 {
            return None;
        }
        let (n, r, teeth) = (self.shares.nrows(), self.patterns(), self.places.len());
        let mut body = Vec::with_capacity(teeth * r * (teeth * r + 1) / 2);
        for response in 0..teeth {
            for q in 0..r {
                for load in 0..=response {
                    let block = self.block(load, response);
                    let most = if load == response { q + 1 } else { r };
                    body.extend((0..most).map(|p| block[(q, p)]));
                }
            }
        }
        Some(HubPatterns {
            count: r,
            own_tooth: (0..n * n).map(|k| self.own_tooth[(k % n, k / n)]).collect(),
            shares: (0..n * r).map(|k| self.shares[(k / r, k % r)]).collect(),
            body,
        })
    }
}
