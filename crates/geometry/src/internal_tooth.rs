//! The tooth of a ring gear: what its number of teeth, profile shift and cutter make of it.
//!
//! The space of the ring is the tooth of its counterpart, an external gear with the same number of teeth and the
//! profile shift −x. Lengths in files have no sign; ISO 21771 gives z and all diameters of a ring a negative one.
//! Equations: docs/theory/internal_teeth.md.

use crate::bisection::halved;
use crate::fillet::Fillet;
use crate::fillet::full_round::FullRound;
use crate::fillet::pinion_cutter::CutterTrochoid;
use crate::involute;
use crate::tip_sweep::{RollingPinion, deepest};
use crate::tooth::{ToothGeometry, transverse_pressure_angle_rad};
use crate::tooth_definition::{InternalRoot, PinionCutter, ToothDefinition};
use crate::tooth_error::GeometryError;
use std::f64::consts::{FRAC_PI_2, PI};

/// A ring keeps at least so many more teeth than its cutter.
const LEAST_DIFFERENCE: usize = 3;
/// Rounding of the tip of a cutter in modules where none is given and so much fits.
const DEFAULT_TIP_RADIUS: f64 = 0.25;
/// Overlap that counts as rounding \[m\].
const ROUNDING_M: f64 = 1e-9;

/// The transverse section of a pinion cutter's tooth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CutterTooth {
    /// Reference radius \[m\].
    reference_radius_m: f64,
    /// Base radius \[m\].
    base_radius_m: f64,
    /// Tip radius \[m\].
    tip_radius_m: f64,
    /// Half the angle of the tooth on the base circle \[rad\].
    base_half_angle_rad: f64,
}

impl CutterTooth {
    fn new(d: &ToothDefinition, cutter: &PinionCutter) -> Self {
        let helix_cos = d.helix_angle_rad.cos();
        let alpha = transverse_pressure_angle_rad(d);
        let reference = 0.5 * d.module_m * cutter.teeth as f64 / helix_cos;
        let shift = 2.0 * cutter.profile_shift * d.pressure_angle_rad.tan();
        let thickness = d.module_m * (FRAC_PI_2 + shift) / helix_cos;
        Self {
            reference_radius_m: reference,
            base_radius_m: reference * alpha.cos(),
            tip_radius_m: reference + d.module_m * (cutter.addendum + cutter.profile_shift),
            base_half_angle_rad: 0.5 * thickness / reference + involute::involute_function(alpha),
        }
    }

    /// Roll angle of the inner parallel curve of the flank at the radius of the rounding's centre, and the angle γ of
    /// that centre from the middle of the tooth; γ is negative where the rounding does not fit.
    fn rounding(&self, radius_m: f64) -> [f64; 2] {
        let roll = involute::roll_angle_rad(self.tip_radius_m - radius_m, self.base_radius_m);
        let turned = radius_m / self.base_radius_m + involute::polar_angle_rad(roll);
        [roll, self.base_half_angle_rad - turned]
    }

    /// Largest rounding that fits \[m\]: zero or less where the tooth is pointed.
    fn largest_rounding_m(&self) -> f64 {
        if self.rounding(0.0)[1] < 0.0 {
            return -1.0;
        }
        let fits = |radius_m: f64| self.rounding(radius_m)[1] >= 0.0;
        halved([0.0, self.tip_radius_m - self.base_radius_m], 100, fits)[0]
    }
}

impl PinionCutter {
    /// A cutter that suits a ring, where a file leaves its numbers open: the fewest teeth, from a third of the ring's
    /// on, whose involute reaches the ring's tip and whose tip runs clear of it; an addendum of 1.25 modules; a tip
    /// radius of 0.25 modules or, where that does not fit, the largest that does. A third of the ring's teeth where no
    /// number does.
    #[must_use]
    pub fn suited(
        d: &ToothDefinition,
        teeth: Option<usize>,
        profile_shift: f64,
        addendum: Option<f64>,
        tip_radius: Option<f64>,
    ) -> Self {
        let with = |teeth: usize| {
            let mut cutter = Self {
                teeth,
                profile_shift,
                addendum: addendum.unwrap_or(1.25),
                tip_radius: 0.0,
            };
            let fits = CutterTooth::new(d, &cutter).largest_rounding_m() / d.module_m;
            // A trifle less than the full round, whose centre then does not pass the middle of the tooth by rounding.
            let most = (fits * (1.0 - 1e-9)).max(0.0);
            cutter.tip_radius = tip_radius.unwrap_or(DEFAULT_TIP_RADIUS.min(most));
            cutter
        };
        if let Some(teeth) = teeth {
            return with(teeth);
        }
        let third = d.teeth.div_ceil(3).max(5);
        let most = d.teeth.saturating_sub(LEAST_DIFFERENCE).max(third);
        let suits = |cutter: &Self| internal_tooth(d, &InternalRoot::Cutter(*cutter)).is_ok();
        ((third..=most).map(with).find(suits)).unwrap_or_else(|| with(third))
    }
}

/// Derives the profile of a ring's tooth.
pub(crate) fn internal_tooth(
    d: &ToothDefinition,
    root: &InternalRoot,
) -> Result<ToothGeometry, GeometryError> {
    let helix_cos = d.helix_angle_rad.cos();
    let tan_n = d.pressure_angle_rad.tan();
    let alpha = transverse_pressure_angle_rad(d);
    let (m, z) = (d.module_m, d.teeth as f64);
    let reference = 0.5 * m * z / helix_cos;
    let base = reference * alpha.cos();
    let tip =
        (d.tip_diameter_m).map_or(reference - m * (d.addendum + d.profile_shift), |v| 0.5 * v);
    if tip <= base {
        return Err(GeometryError::TipInsideBase {
            tip_radius_mm: tip * 1e3,
            base_radius_mm: base * 1e3,
        });
    }
    let thickness =
        m * (FRAC_PI_2 + 2.0 * d.profile_shift * tan_n) / helix_cos - d.thickness_allowance_m;
    let base_half_angle = 0.5 * thickness / reference - involute::involute_function(alpha);
    let tip_roll = involute::roll_angle_rad(tip, base);
    let flank_end = involute::roll_angle_rad(tip + d.tip_chamfer_m, base);
    let space = RingSpace {
        teeth: d.teeth,
        base_radius_m: base,
        base_half_angle_rad: PI / z - base_half_angle,
        flank_end_roll_rad: flank_end,
    };
    let made = match root {
        InternalRoot::Cutter(cutter) => space.cut(d, cutter)?,
        InternalRoot::FullRound => space.rounded(reference + m * (d.dedendum - d.profile_shift))?,
    };
    let form_radius = involute::radius_m(made.form_roll_rad, base);
    if !(made.root_radius_m > tip && form_radius > tip) {
        return Err(GeometryError::ImpossibleRing {
            root_radius_mm: made.root_radius_m * 1e3,
            form_radius_mm: form_radius * 1e3,
            tip_radius_mm: tip * 1e3,
        });
    }
    let mut tooth = ToothGeometry {
        teeth: d.teeth,
        internal: true,
        reference_radius_m: reference,
        base_radius_m: base,
        tip_radius_m: tip,
        root_radius_m: made.root_radius_m,
        base_half_angle_rad: base_half_angle,
        form_roll_rad: made.form_roll_rad,
        flank_end_roll_rad: tip_roll,
        tip_roll_rad: tip_roll,
        tip_chamfer_m: d.tip_chamfer_m,
        undercut: false,
        fillet: made.fillet,
        fillet_end: made.fillet_end,
        helix_angle_rad: d.helix_angle_rad,
    };
    tooth.refuse_pointed()?;
    tooth.chamfer_tip()?;
    if let InternalRoot::Cutter(cutter) = root {
        check_trimming(d, cutter, &tooth)?;
    }
    Ok(tooth)
}

/// Refuses a cutter whose corners take away the tips of the ring on their way in or out of the space.
fn check_trimming(
    d: &ToothDefinition,
    cutter: &PinionCutter,
    ring: &ToothGeometry,
) -> Result<(), GeometryError> {
    let Fillet::Cutter(curve) = ring.fillet else {
        return Ok(());
    };
    let tooth = CutterTooth::new(d, cutter);
    // Points of the rounding, from the tip land to the flank, by the direction of the rounding's normal.
    let [roll, gamma] = tooth.rounding(curve.tip_radius_m);
    let steepest = FRAC_PI_2 - roll.atan();
    let corner = (0..=8).map(|k| {
        let (sin, cos) = (steepest * f64::from(k) / 8.0).sin_cos();
        let along = curve.centre_radius_m + curve.tip_radius_m * cos;
        let across = curve.tip_radius_m * sin;
        (along.hypot(across), gamma + across.atan2(along))
    });
    let pinion = RollingPinion {
        teeth: cutter.teeth,
        corners: corner.collect(),
        centre_distance_m: curve.centre_distance_m,
        turned_rad: 0.0,
    };
    let worst = deepest(ring, &pinion);
    if worst.depth_m > ROUNDING_M {
        return Err(GeometryError::CutterTrimsTip {
            cutter_teeth: cutter.teeth,
            depth_um: worst.depth_m * 1e6,
            clear_tip_diameter_mm: 2e3 * worst.clear_tip_radius_m,
        });
    }
    Ok(())
}

/// The space between two teeth of a ring, before its root.
struct RingSpace {
    teeth: usize,
    base_radius_m: f64,
    /// Half the angle of the space on the base circle: that of the counterpart's tooth.
    base_half_angle_rad: f64,
    flank_end_roll_rad: f64,
}

/// What a tool leaves at the root.
struct MadeRoot {
    fillet: Fillet,
    fillet_end: f64,
    root_radius_m: f64,
    form_roll_rad: f64,
}

impl RingSpace {
    /// By a pinion cutter without backlash, at the centre distance that the widths of its tooth and of the space ask
    /// for: r_w2 (ψ_s − inv α_w0) = r_w0 (ψ_0 − inv α_w0), with the pitch radii as the numbers of teeth.
    fn cut(&self, d: &ToothDefinition, cutter: &PinionCutter) -> Result<MadeRoot, GeometryError> {
        let (z, z_0) = (self.teeth as f64, cutter.teeth as f64);
        if cutter.teeth + LEAST_DIFFERENCE > self.teeth {
            return Err(GeometryError::CutterTooLarge {
                cutter_teeth: cutter.teeth,
                allowed: self.teeth.saturating_sub(LEAST_DIFFERENCE),
            });
        }
        let tooth = CutterTooth::new(d, cutter);
        let rho = cutter.tip_radius * d.module_m;
        let [rounding_roll, gamma] = tooth.rounding(rho);
        if gamma < 0.0 {
            return Err(GeometryError::CutterTipTooNarrow {
                tip_radius: cutter.tip_radius,
                allowed: (tooth.largest_rounding_m() / d.module_m).max(0.0),
            });
        }
        // The tool's tooth is taken wider by the allowance, which the space is, too.
        let wider = 0.5 * d.thickness_allowance_m / tooth.reference_radius_m;
        let half_angle = tooth.base_half_angle_rad + wider;
        let inv = (z * self.base_half_angle_rad - z_0 * half_angle) / (z - z_0);
        let alpha_w = involute::pressure_angle_rad(inv).ok_or(GeometryError::NoCutting {
            cutter_teeth: cutter.teeth,
            // Sum of the shifts at which inv α_w0 vanishes.
            least_shift_sum: 0.5
                * involute::involute_function(transverse_pressure_angle_rad(d))
                * (z - z_0)
                / d.pressure_angle_rad.tan(),
        })?;
        let (sin, cos) = alpha_w.sin_cos();
        let centre_distance = (self.base_radius_m - tooth.base_radius_m) / cos;
        let pitch_radius = tooth.base_radius_m / cos;
        let curve = CutterTrochoid {
            centre_distance_m: centre_distance,
            pitch_radius_m: pitch_radius,
            centre_radius_m: tooth.tip_radius_m - rho,
            centre_angle_rad: gamma + wider,
            tip_radius_m: rho,
            ratio: z_0 / z,
            space_angle_rad: -PI / z,
        };
        if curve.centre_radius_m <= pitch_radius * (1.0 + 1e-9) {
            return Err(GeometryError::CutterTooShort {
                centre_radius_mm: curve.centre_radius_m * 1e3,
                pitch_radius_mm: pitch_radius * 1e3,
            });
        }
        // Smallest radius of the ring's flank that touches an involute of the cutter: that starts at its base circle.
        let line = centre_distance * sin;
        let reached = self.base_radius_m * self.flank_end_roll_rad - line;
        if reached < 0.0 {
            return Err(GeometryError::CutterMissesTip {
                cutter_teeth: cutter.teeth,
                reached_diameter_mm: 2e3 * self.base_radius_m.hypot(line),
                flank_end_diameter_mm: 2e3
                    * involute::radius_m(self.flank_end_roll_rad, self.base_radius_m),
            });
        }
        let flank_start = tooth.base_radius_m * rounding_roll + rho;
        Ok(MadeRoot {
            fillet: Fillet::Cutter(curve),
            fillet_end: rounding_roll.atan() - alpha_w,
            root_radius_m: centre_distance + tooth.tip_radius_m,
            form_roll_rad: (line + flank_start) / self.base_radius_m,
        })
    }

    /// By a tool of the space's form with a full root radius that touches the root circle.
    fn rounded(&self, root_radius_m: f64) -> Result<MadeRoot, GeometryError> {
        let roll_of = |rho: f64| involute::roll_angle_rad(root_radius_m - rho, self.base_radius_m);
        let excess = |rho: f64| {
            self.base_half_angle_rad
                - rho / self.base_radius_m
                - involute::polar_angle_rad(roll_of(rho))
        };
        let high = root_radius_m - self.base_radius_m;
        if !(high > 0.0 && excess(0.0) > 0.0 && excess(high) < 0.0) {
            return Err(GeometryError::NoFullRound {
                root_radius_mm: root_radius_m * 1e3,
                width_mm: 2e3 * root_radius_m * excess(0.0),
            });
        }
        let [rho, _] = halved([0.0, high], 200, |rho| excess(rho) > 0.0);
        let form_roll = roll_of(rho) + rho / self.base_radius_m;
        let space_angle = -PI / self.teeth as f64;
        // The flank's inward normal has the polar angle π/2 − (ξ + ψ_b).
        let tooth_half_angle = -space_angle - self.base_half_angle_rad;
        Ok(MadeRoot {
            fillet: Fillet::FullRound(FullRound {
                centre_radius_m: root_radius_m - rho,
                radius_m: rho,
                space_angle_rad: space_angle,
            }),
            fillet_end: FRAC_PI_2 - form_roll - tooth_half_angle - space_angle,
            root_radius_m,
            form_roll_rad: form_roll,
        })
    }
}
