//! N equal sectors in a ring, each condensed to its two cuts: displacements at the cuts for loads anywhere.
//!
//! In components that turn with the sectors ([`crate::CylindricalFrames`]) every sector has the same stiffness S over
//! its first cut R and its second cut L, and the L of one is the R of the next. With u(j) the displacement of the cut
//! before sector j and p(j) the loads of sector j carried to its cuts, equilibrium of cut j is
//!
//! ```text
//!     (S_RR + S_LL) u(j) + S_RL u(j+1) + S_LR u(j-1) = p_R(j) + p_L(j-1)
//! ```
//!
//! a circulant system. The discrete Fourier transform u^(k) = Σ_j u(j) e^{-ikjα}, α = 2π/N, takes it apart into one
//! small Hermitian system per harmonic (nodal diameter) k,
//!
//! ```text
//!     S(k) u^(k) = p_R^(k) + e^{-ikα} p_L^(k),      S(k) = S_RR + S_LL + e^{ikα} S_RL + e^{-ikα} S_LR,
//! ```
//!
//! and S(N-k) is the conjugate of S(k), so that 0 ≤ k ≤ N/2 suffices. The loads of one sector alone have the same
//! transform p = p_R + e^{-ikα} p_L for all k up to that factor, and with S(k) = Λ Λᴴ the work q·u of the loads q of a
//! sector j further on is (1/N) Σ_k e^{ikjα} (Λ⁻¹q)ᴴ (Λ⁻¹p).
//!
//! Source: D. L. Thomas, *Dynamics of rotationally periodic structures*, Int. J. Numer. Meth. Eng. 14 (1979) 81-102.

use crate::error::FeError;
use crate::ring_transform::{RingTransform, by_reference};
use faer::linalg::solvers::Llt;
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::reborrow::ReborrowMut;
use faer::{Mat, MatMut, MatRef, Side, c64};
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The factorised harmonics of a ring of sectors.
#[derive(Debug)]
pub struct CyclicInterface {
    sectors: usize,
    /// Displacements of one cut.
    cut: usize,
    /// Λ of the harmonics 0 to N/2; empty when there is no cut.
    factors: Vec<Mat<c64>>,
}

impl CyclicInterface {
    /// Factorises all harmonics of `sectors` sectors with the stiffness S over \[R, L\] (N/m). A single sector has no
    /// cuts: its S has no rows.
    ///
    /// # Errors
    /// [`FeError::SizeMismatch`] when S is not square, has an odd number of rows, or one sector has cuts;
    /// [`FeError::NotPositiveDefinite`] when the ring as a whole is not held.
    pub fn new(stiffness: MatRef<'_, f64>, sectors: usize) -> Result<Self, FeError> {
        Self::counted(stiffness, sectors, |_, _| ())
    }

    /// As [`CyclicInterface::new`]; `finished` is told how many of how many harmonics are.
    ///
    /// # Errors
    /// As [`CyclicInterface::new`].
    pub fn counted(
        stiffness: MatRef<'_, f64>,
        sectors: usize,
        finished: impl Fn(usize, usize) + Sync,
    ) -> Result<Self, FeError> {
        let done = AtomicUsize::new(0);
        let rows = stiffness.nrows();
        let cut = rows / 2;
        let expected = if sectors == 1 { 0 } else { 2 * cut };
        if stiffness.ncols() != expected || rows != expected {
            return Err(FeError::SizeMismatch {
                what: "the stiffness at the cuts of a sector",
                found: rows,
                expected,
            });
        }
        let harmonics = if cut == 0 { 0 } else { sectors / 2 + 1 };
        let factors = (0..harmonics)
            .into_par_iter()
            .map(|k| {
                let turn = RingTransform { parts: sectors }.phase(k);
                let s = Mat::from_fn(cut, cut, |i, j| {
                    let own = stiffness[(i, j)] + stiffness[(cut + i, cut + j)];
                    let (rl, lr) = (stiffness[(i, cut + j)], stiffness[(cut + i, j)]);
                    turn * rl + turn.conj() * lr + c64::new(own, 0.0)
                });
                let llt = Llt::new(s.as_ref(), Side::Lower)
                    .map_err(|_| FeError::NotPositiveDefinite { free_dof: 0 })?;
                finished(done.fetch_add(1, Ordering::Relaxed) + 1, harmonics);
                Ok(llt.L().to_owned())
            })
            .collect::<Result<_, FeError>>()?;
        Ok(Self {
            sectors,
            cut,
            factors,
        })
    }

    /// Number of sectors.
    pub fn sectors(&self) -> usize {
        self.sectors
    }

    /// Number of harmonics that were factorised.
    pub fn harmonics(&self) -> usize {
        self.factors.len()
    }

    /// Displacements of one cut.
    pub fn cut_size(&self) -> usize {
        self.cut
    }

    /// e^{ikα}: what a cut has more in phase than the cut before, in a field of harmonic k.
    pub fn turn(&self, k: usize) -> c64 {
        self.ring().phase(k)
    }

    /// Overwrites the loads p_R + e^{-ikα} p_L of harmonic k (rows of one cut × cases) with the displacements of cut R.
    ///
    /// # Panics
    /// If there is no such harmonic or `loads` does not have the rows of a cut. Without cuts nothing is to be done.
    pub fn solve_harmonic(&self, k: usize, mut loads: MatMut<'_, c64>) {
        assert_eq!(loads.nrows(), self.cut, "rows of the loads at a cut");
        if self.cut == 0 {
            return;
        }
        let factor = self.factors[k].as_ref();
        solve_lower_triangular_in_place(factor, loads.rb_mut(), faer::get_global_parallelism());
        solve_upper_triangular_in_place(factor.adjoint(), loads, faer::get_global_parallelism());
    }

    /// Λ⁻¹(p_R + e^{-ikα} p_L).
    fn transformed(&self, k: usize, loads: MatRef<'_, f64>) -> Mat<c64> {
        let back = self.ring().phase(k).conj();
        let mut y = Mat::from_fn(self.cut, loads.ncols(), |i, j| {
            back * loads[(self.cut + i, j)] + c64::new(loads[(i, j)], 0.0)
        });
        solve_lower_triangular_in_place(
            self.factors[k].as_ref(),
            y.as_mut(),
            faer::get_global_parallelism(),
        );
        y
    }

    /// For loads of one sector, carried to its cuts \[R, L\] (rows) by condensation: q·u for each load q of the sector
    /// j further on under each load p of the first one, `result[j][(q, p)]`, without what happens inside one sector
    /// with its cuts held.
    ///
    /// # Panics
    /// If `loads` does not have the rows of both cuts.
    pub fn products(&self, loads: MatRef<'_, f64>) -> Vec<Mat<f64>> {
        assert_eq!(loads.nrows(), 2 * self.cut, "rows of the loads at the cuts");
        let n = loads.ncols();
        let spectrum: Vec<Mat<c64>> = (0..self.harmonics())
            .into_par_iter()
            .map(|k| {
                let y = self.transformed(k, loads);
                y.adjoint() * &y
            })
            .collect();
        self.ring().back(&by_reference(&spectrum), (n, n))
    }

    /// Displacements at the cuts \[R, L\] of each sector, from the loads of each sector carried to its cuts:
    /// `result[j]` (both cuts × cases) from `loads[j]`.
    ///
    /// # Panics
    /// If there is not one block of loads per sector, all with the rows of both cuts and as many columns.
    pub fn displacements(&self, loads: &[Mat<f64>]) -> Vec<Mat<f64>> {
        assert_eq!(loads.len(), self.sectors, "one block of loads per sector");
        let cases = loads[0].ncols();
        let spectrum: Vec<Mat<c64>> = (0..self.harmonics())
            .into_par_iter()
            .map(|k| {
                let mut total = Mat::<c64>::zeros(self.cut, cases);
                for (j, block) in loads.iter().enumerate() {
                    let turn = self.ring().phase(k * j).conj();
                    let next = self.ring().phase(k * (j + 1)).conj();
                    for column in 0..cases {
                        for i in 0..self.cut {
                            total[(i, column)] +=
                                turn * block[(i, column)] + next * block[(self.cut + i, column)];
                        }
                    }
                }
                self.solve_harmonic(k, total.as_mut());
                total
            })
            .collect();
        let cuts = (self.ring()).back(&by_reference(&spectrum), (self.cut, cases));
        (0..self.sectors)
            .map(|j| {
                let next = &cuts[(j + 1) % self.sectors];
                Mat::from_fn(2 * self.cut, cases, |i, column| {
                    if i < self.cut {
                        cuts[j][(i, column)]
                    } else {
                        next[(i - self.cut, column)]
                    }
                })
            })
            .collect()
    }

    fn ring(&self) -> RingTransform {
        RingTransform {
            parts: self.sectors,
        }
    }
}
