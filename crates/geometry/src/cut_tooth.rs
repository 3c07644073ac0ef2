//! The tooth that a definition makes: of an external gear by its rack, of a ring by [`internal_tooth`].

use crate::bisection::halved;
use crate::fillet::Fillet;
use crate::fillet::rack::Trochoid;
use crate::internal_tooth::internal_tooth;
use crate::involute;
use crate::tooth::{ToothGeometry, transverse_pressure_angle_rad};
use crate::tooth_definition::{Gearing, ToothDefinition};
use crate::tooth_error::GeometryError;
use std::f64::consts::{FRAC_PI_2, PI};

/// The trochoid of the rounded tip of a rack that cuts so deep below the reference circle.
fn rack_trochoid(
    d: &ToothDefinition,
    reference_radius_m: f64,
    depth_m: f64,
) -> Result<Trochoid, GeometryError> {
    let helix_cos = d.helix_angle_rad.cos();
    let (sin_n, cos_n) = d.pressure_angle_rad.sin_cos();
    let tan_n = d.pressure_angle_rad.tan();
    let m = d.module_m;
    let rho = d.rack_tip_radius * m;
    let offset = 0.25 * PI * m - d.dedendum * m * tan_n - rho * (1.0 - sin_n) / cos_n;
    if offset < -1e-12 * m {
        return Err(GeometryError::RackTipTooNarrow {
            rack_tip_radius: d.rack_tip_radius,
            excess_mm: -offset * 1e3,
            allowed: (0.25 * PI - d.dedendum * tan_n) * cos_n / (1.0 - sin_n),
        });
    }
    Ok(Trochoid {
        reference_radius_m,
        centre_depth_m: Trochoid::regular_depth_m(depth_m - rho, m),
        centre_offset_m: offset.max(0.0) / helix_cos + 0.5 * d.thickness_allowance_m,
        tip_radius_m: rho,
        helix_cos,
        space_angle_rad: -PI / d.teeth as f64,
    })
}

impl ToothGeometry {
    /// Derives the profile.
    ///
    /// # Errors
    /// [`GeometryError`] when no tooth with these numbers exists; the reason carries the numbers.
    pub fn new(d: &ToothDefinition) -> Result<Self, GeometryError> {
        match &d.gearing {
            Gearing::External => Self::external(d),
            Gearing::Internal(root) => internal_tooth(d, root),
        }
    }

    fn external(d: &ToothDefinition) -> Result<Self, GeometryError> {
        // Heights and the rack's own lengths are those of the normal section; lengths along the pitch line stretch by
        // 1/cos β in the transverse section, and with them the tangent of the pressure angle.
        let helix_cos = d.helix_angle_rad.cos();
        let tan_n = d.pressure_angle_rad.tan();
        let alpha = transverse_pressure_angle_rad(d);
        let m = d.module_m;
        let reference = 0.5 * m * d.teeth as f64 / helix_cos;
        let base = reference * alpha.cos();
        let tip = d
            .tip_diameter_m
            .map_or(reference + m * (d.addendum + d.profile_shift), |v| 0.5 * v);
        let depth = m * (d.dedendum - d.profile_shift);
        let root = reference - depth;
        if !(root > 0.0 && tip > root) {
            return Err(GeometryError::ImpossibleRadii {
                root_radius_mm: root * 1e3,
                tip_radius_mm: tip * 1e3,
            });
        }

        let trochoid = rack_trochoid(d, reference, depth)?;
        let thickness =
            m * (FRAC_PI_2 + 2.0 * d.profile_shift * tan_n) / helix_cos - d.thickness_allowance_m;
        let base_half_angle = 0.5 * thickness / reference + involute::involute_function(alpha);
        let tip_roll = involute::roll_angle_rad(tip, base);
        let mut tooth = Self {
            teeth: d.teeth,
            internal: false,
            reference_radius_m: reference,
            base_radius_m: base,
            tip_radius_m: tip,
            root_radius_m: root,
            base_half_angle_rad: base_half_angle,
            form_roll_rad: 0.0,
            flank_end_roll_rad: tip_roll,
            tip_roll_rad: tip_roll,
            tip_chamfer_m: d.tip_chamfer_m,
            undercut: false,
            fillet: Fillet::Rack(trochoid),
            fillet_end: 0.0,
            helix_angle_rad: d.helix_angle_rad,
        };
        tooth.refuse_pointed()?;
        tooth.end_fillet(d, &trochoid)?;
        tooth.chamfer_tip()?;
        Ok(tooth)
    }

    /// Ends the fillet where the involute starts: the rack's straight flank ends where the rounding begins, whose
    /// contact point that is, or the trochoid crosses the involute.
    fn end_fillet(
        &mut self,
        d: &ToothDefinition,
        trochoid: &Trochoid,
    ) -> Result<(), GeometryError> {
        let (sin_n, tan_n) = (d.pressure_angle_rad.sin(), d.pressure_angle_rad.tan());
        let sin = transverse_pressure_angle_rad(d).sin();
        let (tip, base) = (self.tip_radius_m, self.base_radius_m);
        let undercut_error = |form_roll: f64| GeometryError::Undercut {
            form_radius_mm: involute::radius_m(form_roll, base) * 1e3,
            tip_radius_mm: tip * 1e3,
            needed_profile_shift: d.dedendum
                - d.rack_tip_radius * (1.0 - sin_n)
                - 0.5 * d.teeth as f64 / d.helix_angle_rad.cos() * sin * sin,
        };
        let depth = trochoid.centre_depth_m + trochoid.tip_radius_m * sin_n;
        let form_roll = (self.reference_radius_m * sin - depth / sin) / base;
        if form_roll >= 0.0 {
            self.form_roll_rad = form_roll;
            self.fillet_end = trochoid.centre_depth_m / tan_n;
        } else {
            self.undercut = true;
            self.fillet_end = self
                .undercut_crossing(trochoid)
                .ok_or_else(|| undercut_error(self.tip_roll_rad))?;
            let p = trochoid.point_m(self.fillet_end);
            self.form_roll_rad = involute::roll_angle_rad(p[0].hypot(p[1]), base);
        }
        match self.form_roll_rad >= self.tip_roll_rad {
            true => Err(undercut_error(self.form_roll_rad)),
            false => Ok(()),
        }
    }

    /// Fillet parameter at which an undercut trochoid crosses the involute.
    fn undercut_crossing(&self, trochoid: &Trochoid) -> Option<f64> {
        // From the root circle, which lies below the base circle here, the trochoid runs inside what would be the tooth
        // without undercut, and leaves it at the crossing.
        let is_inside = |t: f64| {
            let p = trochoid.point_m(t);
            let r = p[0].hypot(p[1]);
            let roll = involute::roll_angle_rad(r, self.base_radius_m);
            r < self.base_radius_m || p[1].atan2(p[0]) > -self.half_angle_rad(roll)
        };
        // The parameter grows from the root with the depth's own sign.
        let end = 3.0 * self.reference_radius_m * trochoid.centre_depth_m.signum();
        let steps = 20_000;
        let mut low = 0.0;
        for k in 0..=steps {
            let t = end * k as f64 / steps as f64;
            let p = trochoid.point_m(t);
            if p[0].hypot(p[1]) > self.tip_radius_m {
                break;
            }
            if is_inside(t) {
                low = t;
                continue;
            }
            let [low, high] = halved([low, t], 100, is_inside);
            return Some(0.5 * (low + high));
        }
        None
    }
}
