//! Waves of a race: its groove is no circle.
//!
//! ```text
//! w_r = A_r cos(nψ + φ),   w_z = A_z cos(nψ + φ)                                                        (18)
//! ```
//!
//! move the groove's centre at the angle ψ of the ring's own axes away from the axis and along it. One wave a turn
//! across the axis is a ring that stands aside, one along it a ring that stands askew.

/// Waves of one order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Waviness {
    /// n, waves round the race.
    pub order: u32,
    /// A_r, across the axis \[m\].
    pub radial_m: f64,
    /// A_z, along the axis \[m\].
    pub axial_m: f64,
    /// φ \[rad\].
    pub phase_rad: f64,
}

/// Displacement of a groove's centre, (w_r, w_z) \[m\], with two derivatives by ψ.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Displaced {
    pub radial: [f64; 3],
    pub axial: [f64; 3],
}

impl Waviness {
    /// Adds the waves at ψ.
    pub(crate) fn add(&self, psi: f64, to: &mut Displaced) {
        let n = f64::from(self.order);
        let (sine, cosine) = (n * psi + self.phase_rad).sin_cos();
        for (place, wave) in [cosine, -n * sine, -n * n * cosine].into_iter().enumerate() {
            to.radial[place] += self.radial_m * wave;
            to.axial[place] += self.axial_m * wave;
        }
    }
}
