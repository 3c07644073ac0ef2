//! The trochoidal root fillet that a rack with a rounded tip cuts.
//!
//! The rack's pitch line rolls on the reference circle (radius r). The centre of the rounding (radius ρ) runs at
//! depth H_c below that line; the normal of the cut curve passes through the instantaneous pitch point, hence, with
//! the centre's distance t from the radial line through that point,
//!
//! C(t) = (r − H_c) e_r(φ) + t e_t(φ),  φ = c₀ + (E − t)/r,  P(t) = C + ρ sgn(H_c) (−H_c e_r + t e_t)/√(H_c² + t²).
//!
//! t = 0 is the deepest point (root circle), t = H_c / tan α the tangent transition to the involute.
//!
//! A helical gear's rack is rounded in its normal section; the transverse section stretches it by 1/cos β along the
//! pitch line, and the arc becomes an ellipse with half axes ρ and ρ/cos β. With t still H_c times the tangent of the
//! rounding's angle in the *normal* section and sin = t sgn(H_c)/√(H_c² + t²), the law of gearing gives, exactly,
//!
//! P(t) = (r − H_c − ρ cos) e_r(φ) + cos β (t + ρ sin) e_t(φ),  φ = c₀ + (E − t cos β + ρ sin · sin²β/cos β)/r.
//! c₀ is the
//! polar angle of the tooth space's centre, E the distance of the rounding's centre from the rack tooth's centre
//! line. Derivation: docs/theory/geometry.md; the same construction is in ISO 6336-3 and Litvin.

/// The curve cut by one rounded corner of the rack, for the right flank of the tooth centred on +x.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trochoid {
    /// Reference radius r \[m\].
    pub reference_radius_m: f64,
    /// Depth H_c of the rounding's centre below the rolling line \[m\]; negative above it, never zero.
    pub centre_depth_m: f64,
    /// Distance E of the rounding's centre from the rack tooth's centre line \[m\].
    pub centre_offset_m: f64,
    /// Radius ρ of the rounding \[m\].
    pub tip_radius_m: f64,
    /// cos β of the helix; one for spur teeth.
    pub helix_cos: f64,
    /// Polar angle c₀ of the tooth space's centre \[rad\].
    pub space_angle_rad: f64,
}

impl Trochoid {
    /// Keeps the depth of the rounding's centre away from zero, where the curve degenerates to an arc and its
    /// parameter to a point: a billionth of the module moves no point of the gear by more than that.
    pub fn regular_depth_m(depth_m: f64, module_m: f64) -> f64 {
        let least = 1e-9 * module_m;
        if depth_m.abs() < least {
            least
        } else {
            depth_m
        }
    }

    /// Sine of the angle on the rounding between its deepest point and the one that cuts, in the normal section.
    fn rounding_sin(&self, t_m: f64) -> f64 {
        t_m * self.centre_depth_m.signum() / self.centre_depth_m.hypot(t_m)
    }

    fn contact_angle_rad(&self, t_m: f64) -> f64 {
        let (cos, sin) = (self.helix_cos, self.rounding_sin(t_m));
        let flattening = self.tip_radius_m * sin * (1.0 - cos * cos) / cos;
        self.space_angle_rad
            + (self.centre_offset_m - t_m * cos + flattening) / self.reference_radius_m
    }

    /// Point \[x, y\] \[m\] of the cut curve.
    pub fn point_m(&self, t_m: f64) -> [f64; 2] {
        let (s, c) = self.contact_angle_rad(t_m).sin_cos();
        let scale =
            1.0 + self.tip_radius_m * self.centre_depth_m.signum() / self.centre_depth_m.hypot(t_m);
        let radial = self.reference_radius_m - self.centre_depth_m * scale;
        let tangential = t_m * scale * self.helix_cos;
        [radial * c - tangential * s, radial * s + tangential * c]
    }

    /// See [`super::Fillet::tangent_angle_rad`].
    pub fn tangent_angle_rad(&self, t_m: f64) -> f64 {
        self.contact_angle_rad(t_m) + std::f64::consts::FRAC_PI_2
            - (self.helix_cos * t_m / self.centre_depth_m).atan()
    }
}
