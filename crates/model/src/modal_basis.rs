//! Natural modes of a gear held at its bore, as the dynamics needs them: the Craig-Bampton basis.
//!
//! With the displacements u = R r + Φ η + (quasi-static rest), r the six motions of the reference point,
//!
//! ```text
//! [ RᵀMR   RᵀMΦ ] [ r̈ ]   [ 0  0  ] [ r ]   [ RᵀN f + reaction ]
//! [ ΦᵀMR   1    ] [ η̈ ] + [ 0  Ω² ] [ η ] = [ ΦᵀN f            ]
//! ```
//!
//! and the deflection at the flanks is NᵀR r + NᵀΦ η + (C − NᵀΦ Ω⁻² ΦᵀN) f: what the modes left out deflect
//! statically is the residual flexibility. Nothing is counted twice.

use crate::reduced_gear::{GaugeRows, ReducedGear};
use crate::reduced_gear_error::ReducedGearError;
use gearmesh_geometry::Flank;

/// Natural modes with the bore held, modal mass 1, lowest first.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ModalBasis {
    /// ω² of each mode (rad²/s²).
    pub omega_squared: Vec<f64>,
    /// Nodal diameters of each mode: the strongest harmonic round the teeth.
    pub nodal_diameters: Vec<usize>,
    /// The basis holds every mode up to this frequency (Hz).
    pub complete_to_hz: f64,
    /// NᵀΦ (kg^-½), `[mode][tooth][flank][load][component]`; components as in [`GaugeRows::adjoint`].
    pub flank: Vec<f64>,
    /// gᵀΦ (strain per m kg^½), `[mode][gauge]`.
    pub gauges: Vec<f64>,
    /// ΦᵀMR (kg^½, and kg^½ m for rotations), `[mode][motion]`: x, y, z, rotations about x, y, z through the origin of
    /// the gear's frame, on the axis at mid-face.
    pub coupling: Vec<f64>,
}

impl ModalBasis {
    /// Number of modes.
    pub fn count(&self) -> usize {
        self.omega_squared.len()
    }

    /// Natural frequencies (Hz).
    pub fn frequencies_hz(&self) -> Vec<f64> {
        let hz = |w: &f64| w.sqrt() / std::f64::consts::TAU;
        self.omega_squared.iter().map(hz).collect()
    }
}

impl ReducedGear {
    /// The modal basis.
    ///
    /// # Errors
    /// [`ReducedGearError::NoModes`] for a gear that was reduced without.
    pub fn modal_basis(&self) -> Result<&ModalBasis, ReducedGearError> {
        self.modes
            .as_ref()
            .ok_or_else(|| ReducedGearError::NoModes {
                gear: self.name.clone(),
            })
    }

    /// NᵀΦ of one mode on one flank (kg^-½), `[load][component]`.
    ///
    /// # Errors
    /// [`ReducedGearError::NoModes`].
    ///
    /// # Panics
    /// If the mode or tooth does not exist or the hand carries no loads.
    pub fn mode_at_flank(
        &self,
        mode: usize,
        tooth: usize,
        flank: Flank,
    ) -> Result<&[f64], ReducedGearError> {
        let (hands, size) = (self.flanks.len(), 3 * self.grid.len());
        let place = (mode * self.teeth + tooth) * hands + self.carrying(flank);
        Ok(&self.modal_basis()?.flank[place * size..(place + 1) * size])
    }

    /// The residual flexibility C − NᵀΦ Ω⁻² ΦᵀN between two flanks (m/N), normal loads, `[load L][response L]` as
    /// [`ReducedGear::c_hub_block`]: what the body deflects statically beyond its modes. Over all loads together it is
    /// positive semidefinite, and each further mode lessens it.
    ///
    /// # Errors
    /// [`ReducedGearError::NoModes`].
    ///
    /// # Panics
    /// As [`ReducedGear::c_hub_block`].
    pub fn residual_flexibility_block(
        &self,
        load_tooth: usize,
        load_flank: Flank,
        response_tooth: usize,
        response_flank: Flank,
    ) -> Result<Vec<f64>, ReducedGearError> {
        let basis = self.modal_basis()?;
        let hub = self.c_hub_block(load_tooth, load_flank, response_tooth, response_flank);
        let mut rest = hub.into_owned();
        for (mode, omega_squared) in basis.omega_squared.iter().enumerate() {
            let load = self.mode_at_flank(mode, load_tooth, load_flank)?;
            let response = self.mode_at_flank(mode, response_tooth, response_flank)?;
            let normal = |of: &[f64]| -> Vec<f64> { of.iter().step_by(3).copied().collect() };
            let (load, response) = (normal(load), normal(response));
            for (row, l) in rest.chunks_mut(response.len()).zip(&load) {
                for (value, m) in row.iter_mut().zip(&response) {
                    *value -= l * m / omega_squared;
                }
            }
        }
        Ok(rest)
    }

    /// The residual rows of a gauge, (K⁻¹g)ᵀN − gᵀΦ Ω⁻² ΦᵀN (1/N), `[tooth][flank][load][component]` as
    /// [`GaugeRows::adjoint`].
    ///
    /// # Errors
    /// [`ReducedGearError::NoModes`].
    ///
    /// # Panics
    /// If there is no such gauge.
    pub fn residual_gauge_rows(&self, gauge: usize) -> Result<Vec<f64>, ReducedGearError> {
        let basis = self.modal_basis()?;
        let GaugeRows { adjoint, .. } = &self.gauges[gauge];
        let mut rest = adjoint.clone();
        for (mode, shape) in basis.flank.chunks_exact(adjoint.len()).enumerate() {
            let reading = basis.gauges[mode * self.gauges.len() + gauge];
            let share = reading / basis.omega_squared[mode];
            rest.iter_mut()
                .zip(shape)
                .for_each(|(value, at_load)| *value -= share * at_load);
        }
        Ok(rest)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::synthetic::small_reduced_gear;

    #[test]
    fn each_mode_lessens_the_residual_by_its_own_share() {
        let gear = small_reduced_gear();
        let basis = gear.modal_basis().unwrap();
        assert_eq!(basis.count(), 2);
        let rest = gear
            .residual_flexibility_block(1, Flank::Left, 4, Flank::Right)
            .unwrap();
        let hub = gear.c_hub_block(1, Flank::Left, 4, Flank::Right);
        let at = |mode, tooth, flank, load: usize| {
            gear.mode_at_flank(mode, tooth, flank).unwrap()[3 * load]
        };
        let (l, m) = (2, 7);
        let expected = hub[l * 9 + m]
            - (0..2)
                .map(|k| {
                    at(k, 1, Flank::Left, l) * at(k, 4, Flank::Right, m) / basis.omega_squared[k]
                })
                .sum::<f64>();
        assert!((rest[l * 9 + m] - expected).abs() < 1e-15 * expected.abs());
        assert_ne!(rest[l * 9 + m], hub[l * 9 + m]);
        // Gauges likewise: the entry of tooth 3, left flank, load 5, tangential.
        let rest = gear.residual_gauge_rows(1).unwrap();
        let place = ((3 * 2 + 1) * 9 + 5) * 3 + 1;
        let expected = gear.gauges[1].adjoint[place]
            - (0..2)
                .map(|k| {
                    let shape = gear.mode_at_flank(k, 3, Flank::Left).unwrap()[3 * 5 + 1];
                    basis.gauges[2 * k + 1] * shape / basis.omega_squared[k]
                })
                .sum::<f64>();
        assert!((rest[place] - expected).abs() < 1e-15 * expected.abs());
    }

    #[test]
    fn a_gear_without_modes_says_so() {
        let mut gear = small_reduced_gear();
        gear.modes = None;
        let message = gear.modal_basis().unwrap_err().to_string();
        assert!(message.contains("[modes]"), "{message}");
    }
}
