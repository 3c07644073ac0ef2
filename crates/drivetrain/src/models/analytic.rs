//! `analytic`: each pair of teeth two beams on their foundations in series with a Hertz contact, slices side by side.
//!
//! ```text
//! c_pair(ξ₁, ξ₂) = c₁(ξ₁) + c₂(ξ₂) + c_h,   c_h = 2/(π b) Σ (1 − ν²)/E          F = −gap/c_pair where gap < 0
//! ```
//!
//! Helical teeth are thin spur slices, each at its own roll angle in the transverse section and free of its neighbours.
//! A force F along the normal bends them by its transverse part F cos β_b and moves the flank along the normal by cos
//! β_b of that; the line of Hertz's contact is longer by 1/cos β_b:
//!
//! ```text
//! c_pair = cos²β_b (c₁ + c₂) + cos β_b c_h
//! ```
//!
//! Pairs share the load by their gaps only: the foundation does not couple neighbouring teeth, which makes the mesh too
//! soft by their common part where two pairs carry. Sources: tooth_compliance.rs; Hertz linearised, Yang and Lin
//! (1987); slices: Z. Wan, H. Cao, Y. Zi, W. He, Y. Chen, Mech. Mach. Theory 92 (2015) 447-463.

use std::f64::consts::PI;
use std::sync::Arc;

use gearmesh_geometry::Material;

use crate::error::DrivetrainError;
use crate::flank_contacts::FlankContacts;
use crate::models::teeth_model::{TeethLoads, TeethModel};
use crate::tooth_compliance::{BeamTooth, RootCrack, ToothCompliance};

/// Compliance of the Hertz contact of two teeth over the width \[m/N\]; for equal materials 4(1 − ν²)/(πEb).
#[must_use]
pub fn hertz_m_per_n(materials: [Material; 2], face_width_m: f64) -> f64 {
    let sum: f64 = (materials.iter())
        .map(|m| (1.0 - m.poisson * m.poisson) / m.young_pa)
        .sum();
    2.0 * sum / (PI * face_width_m)
}

/// A gear's teeth: all alike but for those named.
#[derive(Debug, Clone)]
struct GearTeeth {
    common: Arc<ToothCompliance>,
    cracked: Vec<(usize, Arc<ToothCompliance>)>,
}

impl GearTeeth {
    fn of(&self, tooth: usize) -> &ToothCompliance {
        let own = self.cracked.iter().find(|(number, _)| *number == tooth);
        own.map_or(&self.common, |(_, compliance)| compliance)
    }
}

/// The teeth of both gears.
#[derive(Debug, Clone)]
pub struct BeamTeeth {
    gears: [GearTeeth; 2],
    /// Along the flanks' normal.
    hertz_m_per_n: f64,
    /// cos²β_b
    helix_cos_squared: f64,
    slices: f64,
}

impl BeamTeeth {
    /// Tabulates the teeth of two gears shared by `slices`; both sides of the teeth are alike. `cracks` are (tooth,
    /// crack) of each gear.
    ///
    /// # Errors
    /// [`DrivetrainError::Tooth`] for a crack in a tooth that does not exist, [`DrivetrainError::Value`] for a crack
    /// off the fillet or too deep,
    /// [`DrivetrainError::RingBeams`].
    pub fn new(
        gears: [BeamTooth<'_>; 2],
        slices: usize,
        cracks: [&[(usize, RootCrack)]; 2],
    ) -> Result<Self, DrivetrainError> {
        if let Some(ring) = gears.iter().find(|gear| gear.tooth.internal) {
            return Err(DrivetrainError::RingBeams { gear: ring.gear });
        }
        let width = gears[0].face_width_m.min(gears[1].face_width_m);
        let teeth = |gear: &BeamTooth<'_>, cracks: &[(usize, RootCrack)]| {
            let common = Arc::new(gear.table(None));
            let mut cracked = Vec::new();
            for &(tooth, crack) in cracks {
                crate::errors::check_tooth("root crack", tooth, gear.tooth.teeth)?;
                crack.check(gear.tooth)?;
                cracked.push((tooth, Arc::new(gear.table(Some(crack)))));
            }
            Ok::<_, DrivetrainError>(GearTeeth { common, cracked })
        };
        let helix_cos = gears[0].tooth.base_helix_angle_rad().cos();
        Ok(Self {
            hertz_m_per_n: helix_cos * hertz_m_per_n(gears.map(|g| g.material), width),
            helix_cos_squared: helix_cos * helix_cos,
            gears: [teeth(&gears[0], cracks[0])?, teeth(&gears[1], cracks[1])?],
            slices: slices as f64,
        })
    }

    /// Stiffness \[N/m\] of one pair of teeth along the normal, over the whole width at these roll angles.
    #[must_use]
    pub fn pair_stiffness_n_per_m(&self, teeth: [usize; 2], roll_rad: [f64; 2]) -> f64 {
        let of = |i: usize| self.gears[i].of(teeth[i]).at(roll_rad[i]).0;
        1.0 / (self.helix_cos_squared * (of(0) + of(1)) + self.hertz_m_per_n)
    }
}

impl TeethModel for BeamTeeth {
    fn evaluate(
        &mut self,
        flanks: &FlankContacts,
        _tangents: bool,
        loads: &mut TeethLoads,
    ) -> Result<(), DrivetrainError> {
        let n = flanks.contacts.len();
        for (number, section) in flanks.sections.iter().enumerate() {
            let (first, count) = section.contacts;
            let Some(contact) = flanks.contacts.get(first).filter(|_| count > 0) else {
                continue;
            };
            let teeth = flanks.lines[contact.line].teeth;
            let tooth = |i: usize| self.gears[i].of(teeth[i]).at(section.touching_roll_rad[i]);
            let (of_1, of_2) = (tooth(0), tooth(1));
            let whole = self.helix_cos_squared * (of_1.0 + of_2.0) + self.hertz_m_per_n;
            // The share is one but for a helical slice that is partly on the path.
            let slices = self.slices / section.share;
            let stiffness = 1.0 / (whole * slices);
            for i in first..first + count {
                let depth = -flanks.contacts[i].gap_m;
                if depth > 0.0 {
                    let force = stiffness * depth;
                    loads.normal_n[i] = force;
                    loads.stiffness_n_per_m[i * n + i] = stiffness;
                    loads.stored_j += 0.5 * force * depth;
                    let squared = 0.5 * slices * force * force * self.helix_cos_squared;
                    loads.energy_by_roll[number][0] += squared * of_1.1;
                    loads.energy_by_roll[number][1] += squared * of_2.1;
                    loads.energy_by_share[number] -= 0.5 * force * depth / section.share;
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hertz_of_the_reference() {
        let steel = Material {
            young_pa: 206e9,
            poisson: 0.3,
            density_kg_per_m3: None,
        };
        let stiffness = 1.0 / hertz_m_per_n([steel; 2], 0.02);
        assert!((stiffness / 3.555869e9 - 1.0).abs() < 1e-6, "{stiffness}");
    }
}
