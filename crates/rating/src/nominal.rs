//! Nominal stresses of a pair, spur or helical, under its normal force: Lewis's root stress of both gears and Hertz's
//! flank pressure.
//!
//! Root: one tooth carries all, σ = F_t/(b m_n Y) with F_t = F cos β_b r_b/r at the reference circle and Y of the
//! [`VirtualGear`]. Force and length of the tooth both grow by 1/cos β in the normal section, so that the transverse
//! force and the face width stand for them.
//!
//! Flank: the line load is F over the [`shortest_contact_length_m`]. From an overlap ratio of 1 on the pressure is that
//! of the pitch point; that of spur teeth is the largest in single contact; between them it is linear in ε_β, as in ISO
//! 6336-2:2006, 6.2 (Z_B, Z_D).
//!
//! Beside both stand the nominal stresses of ISO 6336 itself ([`IsoPressure`], [`IsoRoot`]).

use crate::contact_length::shortest_contact_length_m;
use crate::flank_pressure::{FlankPressureError, flank_pressure};
use crate::iso_nominal::{IsoPressure, IsoRoot};
use crate::root_section::{LoadPoint, RootSectionError, lewis_stress_pa};
use crate::virtual_gear::VirtualGear;
use gearmesh_geometry::{GearPair, Material, ToothDefinition};

/// Why a pair has no nominal stresses.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NominalError {
    /// A tooth has no root section.
    #[error(transparent)]
    Root(#[from] RootSectionError),
    /// The flanks have no pressure.
    #[error(transparent)]
    Pressure(#[from] FlankPressureError),
    /// A force that is none.
    #[error("the largest normal force is {found_n} N; it must be a finite number, 0 or more")]
    Force {
        /// The force.
        found_n: f64,
    },
}

/// What of a pair's nominal stresses does not depend on the force.
#[derive(Debug, Clone, PartialEq)]
pub struct NominalRating {
    /// Lewis's factors Y of gear 1 and gear 2.
    pub lewis_factors: [f64; 2],
    /// Factors of ISO 6336-2.
    pub iso_pressure: IsoPressure,
    /// Factors of ISO 6336-3 of gear 1 and gear 2, where it has some.
    pub iso_roots: [Option<IsoRoot>; 2],
    /// Line load over normal force, 1/L \[1/m\].
    line_load_per_force_per_m: f64,
    /// Tangential force at the reference circle over normal force.
    tangential_share: f64,
    face_width_m: f64,
    module_m: f64,
    /// Pressure under a line load of 1 N/m \[Pa\].
    pressure_of_unit_pa: f64,
}

/// Nominal stresses under one force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NominalStresses {
    /// Lewis's root stress of gear 1 and gear 2 \[Pa\].
    pub lewis_pa: [f64; 2],
    /// Flank pressure \[Pa\].
    pub flank_pressure_pa: f64,
    /// σ_F0 of ISO 6336-3, method B, of gear 1 and gear 2 \[Pa\].
    pub iso_root_pa: [Option<f64>; 2],
    /// σ_H0 of ISO 6336-2 at the pitch point \[Pa\].
    pub iso_pressure_pa: f64,
}

impl NominalRating {
    /// The rating of a pair that was made of two gears with these teeth; its force acts at `load` for Lewis's stress,
    /// over the width of the narrower gear. `rims_m`: thickness of rims below the root circles, none of solid gears;
    /// `tolerance_class`: of ISO 1328-1, the worse one of both gears, where it is known.
    ///
    /// # Errors
    /// [`NominalError`].
    pub fn new(
        pair: &GearPair,
        teeth: [&ToothDefinition; 2],
        materials: [Material; 2],
        rims_m: [Option<f64>; 2],
        (load, tolerance_class): (LoadPoint, Option<usize>),
    ) -> Result<Self, NominalError> {
        let [first, second] = teeth;
        let factor = |tooth| VirtualGear::new(tooth)?.lewis_factor(load, pair.contact_ratio());
        let face_width_m = first.face_width_m.min(second.face_width_m);
        let at = |roll_rad: f64| {
            flank_pressure(pair, roll_rad, 1.0, materials).map(|found| found.peak_pressure_pa)
        };
        // Without overlap the pitch point need not lie on the path of contact.
        let overlap = pair.overlap_ratio(face_width_m).min(1.0);
        let mut pressure_of_unit_pa = 0.0;
        if overlap < 1.0 {
            let most = single_contact_ends_rad(pair)
                .into_iter()
                .map(at)
                .try_fold(0.0_f64, |most, found| found.map(|p| most.max(p)))?;
            pressure_of_unit_pa += (1.0 - overlap) * most;
        }
        if overlap > 0.0 {
            pressure_of_unit_pa += overlap * at(pair.working_pressure_angle_rad.tan())?;
        }
        let gear_1 = &pair.gear_1;
        let iso = |k: usize| {
            let own = [&pair.gear_1, &pair.gear_2][k];
            let blank = (rims_m[k], tolerance_class);
            IsoRoot::new((teeth[k], own), pair, face_width_m, blank)
        };
        Ok(Self {
            lewis_factors: [factor(first)?, factor(second)?],
            iso_pressure: IsoPressure::new(pair, face_width_m, materials),
            iso_roots: [iso(0)?, iso(1)?],
            line_load_per_force_per_m: 1.0 / shortest_contact_length_m(pair, face_width_m),
            tangential_share: pair.base_helix_angle_rad().cos() * gear_1.base_radius_m
                / gear_1.reference_radius_m,
            face_width_m,
            module_m: first.module_m,
            pressure_of_unit_pa,
        })
    }

    /// Stresses under the normal force F of the mesh \[N\], all pairs of teeth together, across the contact lines.
    ///
    /// # Errors
    /// [`NominalError::Force`].
    pub fn under(&self, normal_force_n: f64) -> Result<NominalStresses, NominalError> {
        if !(normal_force_n.is_finite() && normal_force_n >= 0.0) {
            return Err(NominalError::Force {
                found_n: normal_force_n,
            });
        }
        let tangential_n = self.tangential_share * normal_force_n;
        let lewis =
            |factor| lewis_stress_pa(tangential_n, self.face_width_m, self.module_m, factor);
        // Hertz's pressure grows with the root of the line load.
        let line_load_n_per_m = self.line_load_per_force_per_m * normal_force_n;
        let root = |iso: IsoRoot| iso.stress_pa(tangential_n, self.face_width_m, self.module_m);
        Ok(NominalStresses {
            iso_root_pa: self.iso_roots.map(|iso| iso.map(root)),
            iso_pressure_pa: self.iso_pressure.pressure_pa(tangential_n),
            lewis_pa: self.lewis_factors.map(lewis),
            flank_pressure_pa: self.pressure_of_unit_pa * line_load_n_per_m.sqrt(),
        })
    }
}

/// Roll angles of gear 1 between which one pair of teeth carries all, in the transverse section. ρ₁ρ₂/(ρ₁ + ρ₂) has its
/// maximum between the ends of a stretch of the path, so its minimum is at one of them. With two pairs everywhere it is
/// the pitch point.
fn single_contact_ends_rad(pair: &GearPair) -> Vec<f64> {
    let [start, end] = [pair.roll_start_1_rad, pair.roll_end_1_rad];
    let pitch = pair.pitch_1_rad();
    if end - start < 2.0 * pitch {
        vec![(end - pitch).max(start), (start + pitch).min(end)]
    } else {
        vec![pair.working_pressure_angle_rad.tan()]
    }
}
