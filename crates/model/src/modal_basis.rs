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

/// Natural modes with the bore held, modal mass 1, lowest first.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ModalBasis {
    /// ω² of each mode (rad²/s²).
    pub omega_squared: Vec<f64>,
    /// Nodal diameters of each mode: the strongest harmonic round the teeth.
    pub nodal_diameters: Vec<usize>,
    /// The basis holds every mode up to this frequency (Hz).
    pub complete_to_hz: f64,
    /// NᵀΦ (kg^-½), `[mode][tooth][flank][load][component]`; components as in
    /// [`crate::reduced_gear::GaugeRows::adjoint`].
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
