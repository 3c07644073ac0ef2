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
//! the normal section, with the load at the highest point of single contact. Y_DT is 1 up to ε_αn = 2.05; from ε_αn = 2
//! on there is no such point and no σ_F0. Below half a tooth height of rim Y_B is not defined, and the gear has no
//! σ_F0.

use crate::root_section::{
    RootConstruction, RootSection, RootSectionError, highest_single_contact_roll_rad,
};
use crate::virtual_gear::VirtualGear;
use gearmesh_geometry::{GearPair, Material, ToothDefinition, ToothGeometry};
use std::f64::consts::PI;

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
    /// `rim_m`: rim below the root circle, none of a solid gear. None where the method has none: ε_αn from 2 on, no 30°
    /// tangent, or a rim below half a tooth height.
    ///
    /// # Errors
    /// [`RootSectionError`] where the normal section is that of no spur gear.
    pub fn new(
        (tooth, own): (&ToothDefinition, &ToothGeometry),
        pair: &GearPair,
        face_width_m: f64,
        rim_m: Option<f64>,
    ) -> Result<Option<Self>, RootSectionError> {
        let gear = VirtualGear::new(tooth)?;
        let ratio = gear.contact_ratio(pair.contact_ratio());
        let height_m = own.tip_radius_m - own.root_radius_m;
        let rim_factor = rim_m.map_or(Some(1.0), |rim| rim_factor(rim / height_m));
        let Some(rim_factor) = rim_factor else {
            return Ok(None);
        };
        let section = |spur: &ToothGeometry| {
            let roll = highest_single_contact_roll_rad(spur, ratio)?;
            RootSection::new(spur, roll, RootConstruction::Tangent30)
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
            })),
            (
                Err(RootSectionError::NoSingleContact { .. } | RootSectionError::NoTangent { .. }),
                _,
            ) => Ok(None),
            (Err(error), _) | (_, Err(error)) => Err(error),
        }
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
