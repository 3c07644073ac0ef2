//! Edge of one body on the flank of another: how the half width of a line contact shrinks as the edge tilts.
//!
//! # Derivation
//! A corner whose side makes the small angle `δ` with the surface it presses on touches over the length
//!
//! ```text
//! p(s) = (E* δ/2) √((L − s)/s),     L = 4 q/(π E* δ),     1/E* = Σ (1 − ν²)/E
//! ```
//!
//! `s` from the corner: a flat punch, tilted until its far end lifts off. The mean of `ln s` over that pressure is
//! `ln(L/4) − 1`, over a Hertz pressure `ln(a/2) − ½`: the corner deflects as under a Hertz pressure of the half width
//!
//! ```text
//! a_w = (L/2) e^(−1/2) = κ q/(E* δ),     κ = 2/(π √e) = 0.386
//! ```
//!
//! Without tilt the half width is Hertz's, `a_H² = 4qρ/(πE*)`; a rounded edge keeps at least its own, `a_e² =
//! 4qρ_e/(πE*)`. In between
//!
//! ```text
//! a² = a_H² (u + e)/(1 + u),   u = a_w²/a_H² = F/F₁,   F₁ = 4 E* ρ δ² b_s/(π κ²),   e = ρ_e/ρ
//! ```
//!
//! which tends to `a_H` for `δ → 0`, to `a_e` for light loads, and to `1/a² = 1/a_H² + 1/a_w²` for a sharp edge. As the
//! local deflection goes with `−2β F ln a`, the edge adds
//!
//! ```text
//! δ_e(F) = β F ln[(1 + u)/(e + u)] = β F ∫ₑ¹ dt/(t + u),     δ_e'(F) = β ∫ₑ¹ t dt/(t + u)²  > 0
//! ```
//!
//! increasing and concave, with a finite slope `β ln(1/e)` at zero load.

use super::line_contact::LineContact;
use std::f64::consts::{FRAC_2_PI, PI};

/// κ = 2/(π√e) of `a_w = κ q/(E* δ)`, no unit.
///
/// Two half planes. At tooth tips of a resolved plane-strain solution (tools/reference/off_path.py; z 50, m 3 mm, 15 to
/// 175 N/mm, tilts of 0.1° to 3°, measured against a Hertz pressure of half width 0.03 m cut off at the corner, as the
/// calibration has it) the fit is κ = 0.37 with 0.97 times the logarithm.
pub const WEDGE_WIDTH: f64 = FRAC_2_PI * 0.606_530_659_712_633_4;

/// An edge that presses on a flank at an angle, for one slice.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeContact {
    /// F₁ \[N\]: the load at which the wedge's half width equals Hertz's.
    wedge_force_n: f64,
    /// e = ρ_e/ρ, at most 1.
    radius_ratio: f64,
}

impl EdgeContact {
    /// The edge of a contact that without tilt is `contact`, tilted by `tilt_rad`; `edge_relative_radius_m` is the
    /// relative radius ρ_e of the rounded edge and the flank. None without tilt.
    pub fn new(contact: &LineContact, tilt_rad: f64, edge_relative_radius_m: f64) -> Option<Self> {
        let compliance = contact.plane_strain_compliance();
        let wedge_force_n = 4.0 * contact.relative_radius_m * tilt_rad.powi(2) * contact.width_m
            / (PI * WEDGE_WIDTH.powi(2) * compliance);
        (wedge_force_n > 0.0).then(|| Self {
            wedge_force_n,
            radius_ratio: (edge_relative_radius_m / contact.relative_radius_m).min(1.0),
        })
    }

    /// Half width over Hertz's, `a/a_H`.
    pub fn half_width_share(&self, force_n: f64) -> f64 {
        let u = force_n.max(0.0) / self.wedge_force_n;
        ((u + self.radius_ratio) / (1.0 + u)).sqrt()
    }

    /// `δ_e/β` \[N\] and `δ_e'/β` at the force `force_n` ≥ 0 \[N\].
    #[inline]
    pub(super) fn evaluate(&self, force_n: f64) -> (f64, f64) {
        let e = self.radius_ratio;
        let u = force_n / self.wedge_force_n;
        let logarithm = ((1.0 - e) / (e + u)).ln_1p();
        let fall = (1.0 - e) / (e + u) * (u / (1.0 + u));
        (force_n * logarithm, logarithm - fall)
    }

    /// `∫₀^F δ_e dF / β` \[N²\].
    pub(super) fn complementary_energy(&self, force_n: f64) -> f64 {
        let e = self.radius_ratio;
        let u = force_n / self.wedge_force_n;
        let rounded = if e > 0.0 {
            0.5 * e * e * (u / e).ln_1p()
        } else {
            0.0
        };
        let integral = 0.5 * u * u * ((1.0 - e) / (e + u)).ln_1p() + 0.5 * (1.0 - e) * u
            - 0.5 * u.ln_1p()
            + rounded;
        self.wedge_force_n.powi(2) * integral
    }
}
