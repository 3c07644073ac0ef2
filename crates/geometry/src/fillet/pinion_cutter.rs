//! The trochoidal root fillet that the rounded tip of a pinion cutter leaves in a ring.
//!
//! The cutter's pitch circle (radius r_w0) rolls inside the ring's (r_w2 = r_w0 + a_0). The centre of the rounding
//! (radius ρ) runs at the radius r_c about the cutter's axis; ζ is its angle from the line of centres, γ its angle from
//! the middle of the cutter's tooth. Rolling without slip turns the line of centres by (γ − ζ) z_0/z_2 against the
//! middle of the space, and the normal of the cut curve passes through the pitch point:
//!
//! φ = c₀ + (γ − ζ) z_0/z_2,  P(ζ) = a_0 e_r(φ) + r_c e_r(φ + ζ) + ρ n,
//! n ∥ (r_c cos ζ − r_w0) e_r(φ) + r_c sin ζ e_t(φ).
//!
//! ζ = 0 is the deepest point (root circle, radius a_0 + r_c + ρ). The involute begins where n lies along the line of
//! action, at ζ = α_c − α_w with cos α_c = r_b0/r_c. Derivation: docs/theory/internal_teeth.md.

use std::f64::consts::FRAC_PI_2;

/// The curve cut by one rounded corner of the cutter's tooth, for the right flank of the ring's tooth centred on +x.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CutterTrochoid {
    /// Distance a_0 of the axes of cutter and ring \[m\].
    pub centre_distance_m: f64,
    /// Radius r_w0 of the cutter's pitch circle \[m\].
    pub pitch_radius_m: f64,
    /// Radius r_c at which the rounding's centre lies about the cutter's axis \[m\]; more than the pitch circle's.
    pub centre_radius_m: f64,
    /// Angle γ of the rounding's centre from the middle of the cutter's tooth \[rad\].
    pub centre_angle_rad: f64,
    /// Radius ρ of the rounding \[m\], in the transverse section.
    pub tip_radius_m: f64,
    /// z_0/z_2 of cutter and ring.
    pub ratio: f64,
    /// Polar angle c₀ of the tooth space's centre \[rad\].
    pub space_angle_rad: f64,
}

impl CutterTrochoid {
    /// Angle of the line of centres, and of the normal from it.
    fn angles_rad(&self, zeta_rad: f64) -> [f64; 2] {
        let line = self.space_angle_rad + (self.centre_angle_rad - zeta_rad) * self.ratio;
        let (sin, cos) = zeta_rad.sin_cos();
        let across = self.centre_radius_m * sin;
        let along = self.centre_radius_m * cos - self.pitch_radius_m;
        [line, across.atan2(along)]
    }

    /// Point \[x, y\] \[m\] of the cut curve.
    pub fn point_m(&self, zeta_rad: f64) -> [f64; 2] {
        let [line, normal] = self.angles_rad(zeta_rad);
        let terms = [
            (self.centre_distance_m, line),
            (self.centre_radius_m, line + zeta_rad),
            (self.tip_radius_m, line + normal),
        ];
        terms.iter().fold([0.0; 2], |p, (length, angle)| {
            [p[0] + length * angle.cos(), p[1] + length * angle.sin()]
        })
    }

    /// See [`super::Fillet::tangent_angle_rad`]; the tip of a ring's tooth points to the axis.
    pub fn tangent_angle_rad(&self, zeta_rad: f64) -> f64 {
        let [line, normal] = self.angles_rad(zeta_rad);
        FRAC_PI_2 - line - normal
    }

    /// Half of the arc that the cutter's tip land leaves on the root circle \[rad\].
    pub(super) fn root_arc_rad(&self) -> f64 {
        self.centre_angle_rad * self.ratio
    }
}
