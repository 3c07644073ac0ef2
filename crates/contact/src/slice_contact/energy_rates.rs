//! How the complementary energy of the patches changes at constant forces as they walk over the teeth, or as the share
//! of a slice that touches grows: what a mesh feels as a force besides those along the normals.
//!
//! ```text
//! E* = ½ FᵀCF + Σ∫δ dF          ∂E*/∂u_i = F_i Σ_j ∂_i C_ij F_j + ∂/∂u_i ∫δ_i dF
//! ```

use crate::local_contact::{LawRate, LocalContact};

use super::{Run, SliceContact, dot};

impl SliceContact {
    /// ∂E*/∂u \[J per u\] at the forces of the last solve as a patch walks over the flank of gear 0 or 1. Prepare with
    /// rates.
    ///
    /// # Panics
    /// If there is no such patch.
    pub fn energy_by_u(&self, patch: usize, gear: usize) -> f64 {
        let forces = self.work.forces();
        let (own, n) = (forces[patch], forces.len());
        let Run { law, rates, .. } = &self.runs[self.run[patch]];
        let rate = rates[gear];
        let along = &self.rates[gear][patch * n..][..n];
        let mut sum =
            law.complementary_energy_rate(own, rate.alpha, rate.cap) + own * dot(along, forces);
        if rate.beta != 0.0 {
            sum += rate.beta * law.complementary_energy_by_beta(own);
        }
        sum
    }

    /// ∂E*/∂v \[J per v\] at the forces of the last solve as a patch walks along the tooth of gear 0 or 1; zero on
    /// gears on which slices do not walk that way. Prepare with rates.
    ///
    /// # Panics
    /// If there is no such patch.
    pub fn energy_by_v(&self, patch: usize, gear: usize) -> f64 {
        let forces = self.work.forces();
        let n = forces.len();
        match self.along[gear].get(patch * n..(patch + 1) * n) {
            Some(along) => forces[patch] * dot(along, forces),
            None => 0.0,
        }
    }

    /// ∂E*/∂s \[J\] at the forces of the last solve, s the share of its slice that touches. Prepare with rates.
    ///
    /// # Panics
    /// If there is no such patch.
    pub fn energy_by_share(&self, patch: usize) -> f64 {
        let (force, share) = (self.work.forces()[patch], self.shares[patch]);
        if self.local_contact == LocalContact::None {
            // The slice's own compliance was divided by its share.
            let own = self.own_compliance[patch];
            return -0.5 * force * force * own / (share * share);
        }
        let run = &self.runs[self.run[patch]];
        let (contact, law) = (&run.contact, &run.law);
        let growths = run.depths.map(|depth| depth.growth_by_share);
        let LawRate { alpha, beta, cap } =
            (self.local_contact).law_rate_by_share((contact, law), growths, share);
        law.complementary_energy_rate(force, alpha, cap)
            + beta * law.complementary_energy_by_beta(force)
    }
}
