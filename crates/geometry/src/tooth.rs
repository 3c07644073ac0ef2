//! One tooth: root arc, trochoidal fillet, involute flank, chamfer and tip, as functions of simple parameters.

use crate::fillet::Fillet;
use crate::flank::Flank;
use crate::involute;
use crate::tooth_definition::ToothDefinition;
use crate::tooth_error::GeometryError;
use std::f64::consts::PI;

/// The transverse profile of a tooth centred on +x: of helical teeth the section at z = 0. Radii in metres, angles in
/// radians.
#[derive(Debug, Clone, PartialEq)]
pub struct ToothGeometry {
    /// Number of teeth, without sign.
    pub teeth: usize,
    /// Whether the teeth stand on the inside of a ring and point to the axis.
    pub internal: bool,
    /// Reference radius m z / (2 cos β).
    pub reference_radius_m: f64,
    /// Base radius.
    pub base_radius_m: f64,
    /// Tip radius.
    pub tip_radius_m: f64,
    /// Root radius.
    pub root_radius_m: f64,
    /// Half the angle that the tooth covers on the base circle: thickness/(2r) + inv α; of a ring's tooth, which ends
    /// before that circle, thickness/(2r) − inv α.
    pub base_half_angle_rad: f64,
    /// Roll angle at which the fillet hands over to the involute.
    pub form_roll_rad: f64,
    /// Roll angle at which the usable flank ends: tip circle, or start of the chamfer.
    pub flank_end_roll_rad: f64,
    /// Roll angle of the involute on the tip circle.
    pub tip_roll_rad: f64,
    /// Chamfer.
    pub tip_chamfer_m: f64,
    /// True when the fillet crosses the involute instead of touching it.
    pub undercut: bool,
    /// The fillet of the right flank.
    pub fillet: Fillet,
    /// Fillet parameter at the hand-over to the involute.
    pub fillet_end: f64,
    /// Helix angle β on the reference cylinder, positive for a right hand; zero for spur teeth.
    pub helix_angle_rad: f64,
}

impl ToothGeometry {
    /// Refuses a tooth whose flanks meet below the tip circle.
    pub(crate) fn refuse_pointed(&self) -> Result<(), GeometryError> {
        let half_angle = self.half_angle_rad(self.tip_roll_rad);
        if half_angle <= 0.0 || self.tip_radius_m <= self.base_radius_m {
            return Err(GeometryError::PointedTooth {
                tip_radius_mm: self.tip_radius_m * 1e3,
                thickness_mm: 2.0 * half_angle * self.tip_radius_m * 1e3,
            });
        }
        Ok(())
    }

    /// Ends the flank at the chamfer of the tip, which leaves some of the flank and of the land.
    pub(crate) fn chamfer_tip(&mut self) -> Result<(), GeometryError> {
        if self.tip_chamfer_m <= 0.0 {
            return Ok(());
        }
        let too_large = |lost, allowed_m: f64| GeometryError::ChamferTooLarge {
            chamfer_mm: self.tip_chamfer_m * 1e3,
            lost,
            allowed_mm: allowed_m * 1e3,
        };
        let form_radius = involute::radius_m(self.form_roll_rad, self.base_radius_m);
        let end = self.tip_radius_m - self.tip_direction() * self.tip_chamfer_m;
        if !self.is_towards_tip(end, form_radius) {
            let flank = self.tip_direction() * (self.tip_radius_m - form_radius);
            return Err(too_large("usable flank", flank));
        }
        let tip_half_angle = self.half_angle_rad(self.tip_roll_rad);
        self.flank_end_roll_rad = involute::roll_angle_rad(end, self.base_radius_m);
        if self.tip_half_angle_rad() <= 0.0 {
            return Err(too_large("tip land", tip_half_angle * self.tip_radius_m));
        }
        Ok(())
    }

    /// Which way the tip lies from the root: +1 away from the axis, −1 towards it, inside a ring. ISO 21771 gives the
    /// radii of a gear this sign.
    pub fn tip_direction(&self) -> f64 {
        if self.internal { -1.0 } else { 1.0 }
    }

    /// Whether the radius `a_m` lies nearer to the tip than `b_m`.
    pub fn is_towards_tip(&self, a_m: f64, b_m: f64) -> bool {
        (a_m - b_m) * self.tip_direction() > 0.0
    }

    /// The smallest and the largest roll angle of the flank \[rad\]: from form circle to flank end, of a ring from
    /// flank end to form circle.
    pub fn flank_rolls_rad(&self) -> [f64; 2] {
        let ends = [self.form_roll_rad, self.flank_end_roll_rad];
        [ends[0].min(ends[1]), ends[0].max(ends[1])]
    }

    /// Polar angle of the middle of the tooth space beside the right flank \[rad\].
    pub fn space_angle_rad(&self) -> f64 {
        -PI / self.teeth as f64
    }

    /// Turn of the section per metre of z \[rad/m\]: tan β/r = tan β_b/r_b, positive for a right hand.
    pub fn twist_rad_per_m(&self) -> f64 {
        self.helix_angle_rad.tan() / self.reference_radius_m
    }

    /// Helix angle β_b on the base cylinder \[rad\], positive for a right hand: tan β_b = tan β cos α_t, which is the
    /// same as sin β_b = sin β cos α_n.
    pub fn base_helix_angle_rad(&self) -> f64 {
        (self.base_radius_m * self.twist_rad_per_m()).atan()
    }

    /// Overlap ratio ε_β = b tan β_b/p_bt = b sin β/(π m_n) over a width b: pitches that a tooth twists through.
    pub fn overlap_ratio(&self, face_width_m: f64) -> f64 {
        face_width_m * self.twist_rad_per_m().abs() * self.teeth as f64 / std::f64::consts::TAU
    }

    /// Number of teeth of the spur gear that a helical tooth resembles in its normal section:
    /// z_n = z/(cos²β_b cos β).
    pub fn virtual_teeth(&self) -> f64 {
        self.teeth as f64 / (self.base_helix_angle_rad().cos().powi(2) * self.helix_angle_rad.cos())
    }

    /// Hand of the helix in words, `none` for spur teeth.
    pub fn hand(&self) -> &'static str {
        if self.helix_angle_rad > 0.0 {
            "right"
        } else if self.helix_angle_rad < 0.0 {
            "left"
        } else {
            "none"
        }
    }

    /// Unit normal of a helical flank in the section at z = 0, into the material: the transverse normal n_t times cos
    /// β_b and −sin β_b along +z on right flanks, +sin β_b on left ones. On the helicoid ∂P/∂z = (tan β_b e_t + e_z)
    /// besides a part along the profile, with e_t = n_t on the right and −n_t on the left flank. Turn it with its
    /// section.
    pub fn flank_normal(&self, side: Flank, roll_rad: f64) -> [f64; 3] {
        let ([x, y], _) = self.flank_frame(side, roll_rad);
        let (sin, cos) = self.base_helix_angle_rad().sin_cos();
        [cos * x, cos * y, -side.mirror() * sin]
    }

    /// Half the angle that the tooth covers at a roll angle: ψ = ψ_b ∓ (ξ − atan ξ), + inside a ring.
    pub fn half_angle_rad(&self, roll_rad: f64) -> f64 {
        self.base_half_angle_rad - self.tip_direction() * involute::polar_angle_rad(roll_rad)
    }

    /// Half the angle of the tip land, after the chamfer.
    pub fn tip_half_angle_rad(&self) -> f64 {
        if self.tip_chamfer_m > 0.0 {
            self.half_angle_rad(self.flank_end_roll_rad) - self.tip_chamfer_m / self.tip_radius_m
        } else {
            self.half_angle_rad(self.tip_roll_rad)
        }
    }

    /// Roll angle of the point that lies `towards_tip_m` along the profile from the one at `roll_rad`; zero beyond the
    /// base circle. The arc of an involute is r_b ξ²/2; in a ring it runs to the root.
    pub fn roll_from_rad(&self, roll_rad: f64, towards_tip_m: f64) -> f64 {
        let further = 2.0 * self.tip_direction() * towards_tip_m / self.base_radius_m;
        (roll_rad * roll_rad + further).max(0.0).sqrt()
    }

    /// Point of a flank \[m\] at a roll angle, for the tooth centred on +x.
    pub fn flank_point_m(&self, side: Flank, roll_rad: f64) -> [f64; 2] {
        let r = involute::radius_m(roll_rad, self.base_radius_m);
        let psi = self.half_angle_rad(roll_rad);
        [r * psi.cos(), -side.mirror() * r * psi.sin()]
    }

    /// Unit normal of a flank, into the material, and unit tangent towards the tip.
    ///
    /// With φ = ±ξ − ψ_b the base tangent's polar angle on the right flank: normal e_t(φ), tangent ±e_r(φ), − inside a
    /// ring.
    pub fn flank_frame(&self, side: Flank, roll_rad: f64) -> ([f64; 2], [f64; 2]) {
        let tip = self.tip_direction();
        let (s, c) = (tip * roll_rad - self.base_half_angle_rad).sin_cos();
        let mirror = side.mirror();
        ([-s, mirror * c], [tip * c, tip * mirror * s])
    }
}

/// Pressure angle in the transverse section \[rad\]: tan α_t = tan α_n/cos β.
pub fn transverse_pressure_angle_rad(d: &ToothDefinition) -> f64 {
    if d.helix_angle_rad == 0.0 {
        d.pressure_angle_rad
    } else {
        (d.pressure_angle_rad.tan() / d.helix_angle_rad.cos()).atan()
    }
}
