//! Nominal stresses of ISO 6336:2006 for a pair, all factors K one: σ_H0 of part 2 at the pitch point, σ_F0 of part 3
//! by method B.
//!
//! ```text
//! σ_H0 = Z_H Z_E Z_ε Z_β √(F_t/(d₁ b) · (u + 1)/u)
//!        Z_H = √(2 cos β_b cos α_wt/(cos² α_t sin α_wt))     Z_E = 1/√(π Σ (1 − ν²)/E)     Z_β = 1/√cos β
//!        Z_ε² = (4 − ε_α)/3 (1 − ε_β) + ε_β/ε_α,  ε_β no more than 1
//! σ_F0 = F_t/(b m_n) · Y_F Y_S Y_β Y_B Y_DT
//!        Y_S = (1.2 + 0.13 L) q_s^(1/(1.21 + 2.3/L)),  L = s_Fn/h_Fe,  q_s = s_Fn/(2 ρ_F)
//!        Y_β = 1 − ε_β β/120°,  ε_β no more than 1, β no more than 30°
//!        Y_B = 1.6 ln(2.242 h_t/s_R) where the rim is thinner than 1.2 tooth heights, 1 elsewhere
//! ```
//!
//! Y_F and Y_S are those of the section where the tangent of the tooth's own fillet makes 30° with its centre line, in
//! the normal section, with the load ε_αn − 1 normal base pitches below the tip: at the highest point of single contact
//! below ε_αn = 2, at the inner point of triple contact from there on. For teeth so deep
//!
//! ```text
//! Y_DT = 1                       ε_αn ≤ 2.05, or flanks of a tolerance class above 4
//! Y_DT = 2.366 − 0.666 ε_αn      2.05 < ε_αn < 2.5 and tolerance class 4 or better (ISO 1328-1)
//! ```
//!
//! since only flanks of small errors share the load among three pairs (ISO 6336-3:2006, deep tooth factor;
//! IACS' Unified Requirement M56, M56.3.7, states the same). From ε_αn = 2.5 on there is no σ_F0 here, nor below
//! half a tooth height of rim, where Y_B is not defined.

use crate::root_section::{RootConstruction, RootSection, RootSectionError};
use crate::virtual_gear::VirtualGear;
use gearmesh_geometry::{GearPair, Material, ToothDefinition, ToothGeometry};
use std::f64::consts::{PI, TAU};

/// Factors of σ_H0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IsoPressure {
    /// Z_H: curvature at the pitch point.
    pub zone_factor: f64,
    /// Z_E \[√Pa\].
    pub elasticity_factor: f64,
    /// Z_ε.
    pub contact_ratio_factor: f64,
    /// Z_β.
    pub helix_factor: f64,
    /// (u + 1)/(u d₁ b) \[1/m²\].
    tangential_per_m2: f64,
}

/// Factors of one gear's σ_F0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IsoRoot {
    /// Y_F.
    pub form_factor: f64,
    /// Y_S: the notch of the fillet.
    pub stress_correction_factor: f64,
    /// Y_β.
    pub helix_factor: f64,
    /// Y_B.
    pub rim_factor: f64,
    /// Y_DT.
    pub deep_tooth_factor: f64,
    /// Contact ratio ε_αn of the virtual spur gears.
    pub virtual_contact_ratio: f64,
}

/// Contact ratio ε_αn up to which Y_DT is 1 for flanks of every class.
const DEEP: f64 = 2.05;

/// Contact ratio ε_αn from which there is no σ_F0.
const DEEPEST: f64 = 2.5;

/// Worst tolerance class of ISO 1328-1 whose flanks share the load among three pairs.
const SHARING_CLASS: usize = 4;

/// Y_DT at a contact ratio ε_αn below 2.5; a class that is not known counts as one above 4, which is safe.
fn deep_tooth_factor(ratio: f64, tolerance_class: Option<usize>) -> f64 {
    if ratio > DEEP && tolerance_class.is_some_and(|class| class <= SHARING_CLASS) {
        2.366 - 0.666 * ratio
    } else {
        1.0
    }
}

impl IsoPressure {
    /// The factors of a pair over the common face width b \[m\].
    #[must_use]
    pub fn new(pair: &GearPair, face_width_m: f64, materials: [Material; 2]) -> Self {
        let gear = &pair.gear_1;
        let alpha_wt = pair.working_pressure_angle_rad;
        let cos_alpha_t = gear.base_radius_m / gear.reference_radius_m;
        let zone = 2.0 * pair.base_helix_angle_rad().cos() * alpha_wt.cos()
            / (cos_alpha_t * cos_alpha_t * alpha_wt.sin());
        let compliance: f64 = materials
            .iter()
            .map(|m| (1.0 - m.poisson * m.poisson) / m.young_pa)
            .sum();
        let (transverse, overlap) = (
            pair.contact_ratio(),
            pair.overlap_ratio(face_width_m).min(1.0),
        );
        let contact = (4.0 - transverse) / 3.0 * (1.0 - overlap) + overlap / transverse;
        let curvature: f64 = [&pair.gear_1, &pair.gear_2]
            .iter()
            .map(|gear| 0.5 / gear.reference_radius_m)
            .sum();
        Self {
            zone_factor: zone.sqrt(),
            elasticity_factor: (PI * compliance).sqrt().recip(),
            contact_ratio_factor: contact.sqrt(),
            helix_factor: gear.helix_angle_rad.cos().sqrt().recip(),
            tangential_per_m2: curvature / face_width_m,
        }
    }

    /// σ_H0 \[Pa\] under the tangential force F_t \[N\] at the reference circle.
    #[must_use]
    pub fn pressure_pa(&self, tangential_n: f64) -> f64 {
        self.zone_factor
            * self.elasticity_factor
            * self.contact_ratio_factor
            * self.helix_factor
            * (tangential_n * self.tangential_per_m2).sqrt()
    }
}

impl IsoRoot {
    /// The factors of one gear of a pair, by its definition and its geometry, over the common face width \[m\];
    /// `rim_m`: rim below the root circle, none of a solid gear; `tolerance_class`: of ISO 1328-1, the worse one of
    /// both gears. None where the method has none: ε_αn from 2.5 on, no 30° tangent, or a rim below half a tooth
    /// height.
    ///
    /// # Errors
    /// [`RootSectionError`] where the normal section is that of no spur gear.
    pub fn new(
        (tooth, own): (&ToothDefinition, &ToothGeometry),
        pair: &GearPair,
        face_width_m: f64,
        (rim_m, tolerance_class): (Option<f64>, Option<usize>),
    ) -> Result<Option<Self>, RootSectionError> {
        let gear = VirtualGear::new(tooth)?;
        let ratio = gear.contact_ratio(pair.contact_ratio());
        let height_m = own.tip_radius_m - own.root_radius_m;
        let rim_factor = rim_m.map_or(Some(1.0), |rim| rim_factor(rim / height_m));
        let Some(rim_factor) = rim_factor else {
            return Ok(None);
        };
        if ratio >= DEEPEST {
            return Ok(None);
        }
        let section = |spur: &ToothGeometry| {
            let below_tip_rad = (ratio - 1.0).max(0.0) * TAU / spur.teeth as f64;
            let roll_rad = spur.flank_end_roll_rad - below_tip_rad;
            RootSection::new(spur, roll_rad, RootConstruction::Tangent30)
        };
        let form = gear.interpolated(|spur| {
            Ok(section(spur)?.iso_form_factor(tooth.module_m, tooth.pressure_angle_rad))
        });
        let notch = gear.interpolated(|spur| Ok(section(spur)?.stress_correction_factor()));
        let overlap = pair.overlap_ratio(face_width_m).min(1.0);
        let helix_deg = tooth.helix_angle_rad.abs().to_degrees().min(30.0);
        match (form, notch) {
            (Ok(form_factor), Ok(stress_correction_factor)) => Ok(Some(Self {
                form_factor,
                stress_correction_factor,
                helix_factor: 1.0 - overlap * helix_deg / 120.0,
                rim_factor,
                deep_tooth_factor: deep_tooth_factor(ratio, tolerance_class),
                virtual_contact_ratio: ratio,
            })),
            (Err(RootSectionError::NoTangent { .. }), _) => Ok(None),
            (Err(error), _) | (_, Err(error)) => Err(error),
        }
    }

    /// Whether a tolerance class of 4 or better would lower σ_F0, and to what share.
    #[must_use]
    pub fn share_of_fine_classes(&self) -> Option<f64> {
        let share = deep_tooth_factor(self.virtual_contact_ratio, Some(SHARING_CLASS));
        (share < self.deep_tooth_factor).then_some(share)
    }

    /// σ_F0 \[Pa\] under the tangential force F_t \[N\] at the reference circle, over the face width b and with the
    /// normal module \[m\].
    #[must_use]
    pub fn stress_pa(&self, tangential_n: f64, face_width_m: f64, module_m: f64) -> f64 {
        tangential_n / (face_width_m * module_m)
            * self.form_factor
            * self.stress_correction_factor
            * self.helix_factor
            * self.rim_factor
            * self.deep_tooth_factor
    }
}

/// Y_B of a rim of so many tooth heights; none below one half.
fn rim_factor(heights: f64) -> Option<f64> {
    match heights {
        h if h >= 1.2 => Some(1.0),
        h if h >= 0.5 => Some(1.6 * (2.242 / h).ln()),
        _ => None,
    }
}
