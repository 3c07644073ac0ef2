//! `impact`: F = K δ^e + STEP(δ, 0, 0, d_max, C_max) δ̇ on each pair of teeth, never pulling; δ is the penetration of
//! rigid flanks along the real line of action, on helical teeth along the flanks' normal. K is that of a pair over its
//! whole width: where slices of a helical pair are off the path, the others carry their share alone.
//!
//! Source: the IMPACT function of MSC Adams, as used in seeds 002 and 003. The stiffness has the unit N/m^e: its
//! exponent is part of the value. Damping is part of this law; friction is added by the mesh.

use crate::error::{DrivetrainError, not_negative, positive};
use crate::flank_contacts::FlankContacts;
use crate::models::teeth_model::{TeethLoads, TeethModel};
use crate::step::step;

/// A contact stiffness with its exponent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PowerStiffness {
    n_per_m_e: f64,
    exponent: f64,
}

impl PowerStiffness {
    /// K in N/mm^e, as such values are stated: F = K (δ/mm)^e.
    ///
    /// # Errors
    /// [`DrivetrainError::Value`] if K is not positive or e below 1.
    pub fn n_per_mm_e(value: f64, exponent: f64) -> Result<Self, DrivetrainError> {
        positive("impact mesh", "the stiffness in N/mm^e", value)?;
        Self::n_per_m_e(value * 1e3_f64.powf(exponent), exponent)
    }

    /// K in N/m^e.
    ///
    /// # Errors
    /// As [`Self::n_per_mm_e`].
    pub fn n_per_m_e(n_per_m_e: f64, exponent: f64) -> Result<Self, DrivetrainError> {
        let owner = "impact mesh";
        positive(owner, "the stiffness in N/m^e", n_per_m_e)?;
        DrivetrainError::require(
            owner,
            ("the exponent e", exponent),
            exponent >= 1.0 && exponent.is_finite(),
            "at least 1 and finite",
        )?;
        Ok(Self {
            n_per_m_e,
            exponent,
        })
    }

    /// Force \[N\] and its slope \[N/m\] at a penetration ≥ 0 \[m\].
    #[must_use]
    pub fn force(&self, depth_m: f64) -> (f64, f64) {
        // δ^(e−1) is finite at zero because e ≥ 1.
        let root = self.n_per_m_e * depth_m.powf(self.exponent - 1.0);
        (root * depth_m, root * self.exponent)
    }
}

/// The law of a pair of teeth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impact {
    stiffness: PowerStiffness,
    damping_n_s_per_m: f64,
    full_depth_m: f64,
    slices: f64,
    on_modes: bool,
}

impl Impact {
    /// Stiffness, largest damping C_max \[N·s/m\], depth d_max \[m\] from which it acts in full; shared by so many
    /// slices.
    ///
    /// # Errors
    /// [`DrivetrainError::Value`] if the damping is negative or d_max not positive.
    pub fn new(
        stiffness: PowerStiffness,
        damping_n_s_per_m: f64,
        full_depth_m: f64,
        slices: usize,
    ) -> Result<Self, DrivetrainError> {
        let owner = "impact mesh";
        Ok(Self {
            stiffness,
            damping_n_s_per_m: not_negative(owner, "the damping in N s/m", damping_n_s_per_m)?,
            full_depth_m: positive(owner, "the depth of full damping in m", full_depth_m)?,
            slices: slices as f64,
            on_modes: false,
        })
    }

    /// The same on flanks that vibrate: K is that of the surfaces alone, and what the modes deflect comes on top.
    #[must_use]
    pub fn on_modes(mut self) -> Self {
        self.on_modes = true;
        self
    }

    /// Penetration \[m\] at which a pair of teeth carries this force \[N\].
    #[must_use]
    pub fn depth_m(&self, force_n: f64) -> f64 {
        (force_n / self.stiffness.n_per_m_e).powf(1.0 / self.stiffness.exponent)
    }
}

impl TeethModel for Impact {
    fn acts_singly(&self) -> bool {
        true
    }

    fn takes_modes(&self) -> bool {
        self.on_modes
    }

    fn evaluate(
        &mut self,
        flanks: &FlankContacts,
        _tangents: bool,
        loads: &mut TeethLoads,
    ) -> Result<(), DrivetrainError> {
        for (i, contact) in flanks.contacts.iter().enumerate() {
            let depth = -contact.gap_m;
            if depth <= 0.0 {
                continue;
            }
            let rate = contact.gap_rate_m_per_s;
            let (elastic, slope) = self.stiffness.force(depth);
            let full = [self.full_depth_m, self.damping_n_s_per_m];
            let (damping, damping_slope) = step(depth, [0.0, 0.0], full);
            // One but for a helical slice that is partly on the path.
            let section = flanks.section(contact);
            let share = section.share;
            let slices = self.slices / (share * section.stiffness);
            let force = (elastic - damping * rate) / slices;
            let stored = elastic * depth / (self.stiffness.exponent + 1.0) / slices;
            loads.stored_j += stored;
            if force > 0.0 {
                loads.normal_n[i] = force;
                let own = loads.own(i);
                loads.stiffness_n_per_m[own] = (slope - damping_slope * rate) / slices;
                loads.damping_n_s_per_m[own] = damping / slices;
                loads.dissipated_w += damping * rate * rate / slices;
                loads.energy_by_share[contact.section] -= stored / share;
            } else {
                loads.dissipated_w += elastic * rate / slices;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    /// Seed 002 after its unit is put right: 1e7 N/mm^2.2 gives 398 N at 10 µm, 1.5e8 gives 5972 N.
    #[test]
    fn the_unit_carries_the_exponent() {
        for (k, force) in [(1e7, 398.1), (1.5e8, 5971.6)] {
            let stiffness = PowerStiffness::n_per_mm_e(k, 2.2).unwrap();
            assert!((stiffness.force(10e-6).0 - force).abs() < 0.1);
        }
        assert!(PowerStiffness::n_per_mm_e(1e7, 0.9).is_err());
        assert!(PowerStiffness::n_per_mm_e(-1.0, 1.5).is_err());
    }
}
