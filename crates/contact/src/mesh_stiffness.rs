//! Mesh stiffness over a mesh cycle: secant, tangent, mean and Fourier coefficients.

use crate::static_contact::ContactState;
use std::f64::consts::TAU;

/// Mesh stiffness at one position, force along the line of action over deflection along it \[N/m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshStiffness {
    /// T₂ / (r_b2² φ) with φ = (TE unloaded − TE)/r_b2: F over the whole deflection since first touch at this position.
    pub secant_n_per_m: f64,
    /// dT₂/dθ₂ / r_b2²: the slope at this load.
    pub tangent_n_per_m: f64,
}

impl MeshStiffness {
    /// Stiffness of a solved position; zero without load.
    pub fn of(state: &ContactState, base_radius_2_m: f64) -> Self {
        let deflection = state.unloaded_m - state.transmission_error_m;
        let secant = if deflection > 0.0 {
            state.torque_2_nm / (base_radius_2_m * deflection)
        } else {
            0.0
        };
        Self {
            secant_n_per_m: secant,
            tangent_n_per_m: state.torque_rate_n / base_radius_2_m,
        }
    }
}

/// Complex Fourier coefficients of a periodic curve as (amplitude, phase): value = mean + Σ a_k cos(k φ + p_k).
///
/// `values` are samples at equal steps over exactly one period, the end not repeated.
pub fn fourier(values: &[f64], orders: usize) -> (f64, Vec<(f64, f64)>) {
    let n = values.len();
    let mean = values.iter().sum::<f64>() / n as f64;
    let coefficients = (1..=orders.min(n.saturating_sub(1) / 2))
        .map(|k| {
            let (mut re, mut im) = (0.0, 0.0);
            for (i, v) in values.iter().enumerate() {
                let (s, c) = (TAU * (k * i % n) as f64 / n as f64).sin_cos();
                re += v * c;
                im -= v * s;
            }
            let scale = 2.0 / n as f64;
            (scale * re.hypot(im), im.atan2(re))
        })
        .collect();
    (mean, coefficients)
}

/// Mean and harmonics of the mesh cycle of a curve that runs over a whole number of pitches: harmonic k is the k-th
/// multiple of the tooth meshing order, its part common to all pitches.
pub fn mesh_harmonics(values: &[f64], pitches: usize, orders: usize) -> (f64, Vec<(f64, f64)>) {
    let (mean, all) = fourier(values, orders * pitches);
    (
        mean,
        all.into_iter().skip(pitches - 1).step_by(pitches).collect(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fourier_finds_amplitude_and_phase() {
        let n = 40;
        let values: Vec<f64> = (0..n)
            .map(|i| 3.0 + 2.0 * (2.0 * TAU * f64::from(i) / f64::from(n) + 0.7).cos())
            .collect();
        let (mean, c) = fourier(&values, 4);
        assert!((mean - 3.0).abs() < 1e-13);
        assert!((c[1].0 - 2.0).abs() < 1e-13 && (c[1].1 - 0.7).abs() < 1e-13);
        assert!(c[0].0 < 1e-13 && c[2].0 < 1e-13);
        let (_, mesh) = mesh_harmonics(&values, 2, 3);
        assert_eq!(mesh.len(), 3);
        assert!((mesh[0].0 - 2.0).abs() < 1e-13 && mesh[1].0 < 1e-13);
    }
}
