//! The spur gear that a helical tooth resembles in its normal section: its root is rated in place of the helical one's.
//!
//! ISO 6336-3:2006, 6.2.3: z_n = z/(cos²β_b cos β) teeth (z/cos³β in textbooks, 1.5 % more at β = 20°), the normal
//! module and rack, d_n = m_n z_n, d_an = d_n + d_a − d, ε_αn = ε_α/cos²β_b. z_n is no whole number. What is asked of
//! the gear is taken from the spur gears of the whole numbers on both sides of it, in proportion, as from a table: a
//! form factor is off by ≈ 0.7/z³ that way, 1e-4 at 18 teeth. A spur tooth is its own.

use crate::root_section::{
    LoadPoint, RootConstruction, RootSection, RootSectionError, highest_single_contact_roll_rad,
};
use gearmesh_geometry::{Gearing, ToothDefinition, ToothGeometry};

/// The virtual spur gear of a tooth, spur or helical.
#[derive(Debug, Clone, PartialEq)]
pub struct VirtualGear {
    /// Spur gears of whole numbers of teeth with their shares, which add up to 1.
    gears: Vec<(ToothGeometry, f64)>,
    /// Normal module m_n \[m\].
    module_m: f64,
    /// cos²β_b.
    base_cos_squared: f64,
}

impl VirtualGear {
    /// Derives the gear.
    ///
    /// # Errors
    /// [`RootSectionError::Virtual`] where no such spur gear can be cut.
    pub fn new(definition: &ToothDefinition) -> Result<Self, RootSectionError> {
        if definition.gearing != Gearing::External {
            return Err(RootSectionError::Internal);
        }
        let spur = |teeth: usize, above_reference_m: f64| {
            let tip_radius_m = 0.5 * definition.module_m * teeth as f64 + above_reference_m;
            let definition = ToothDefinition {
                teeth,
                helix_angle_rad: 0.0,
                tip_diameter_m: Some(2.0 * tip_radius_m),
                thickness_allowance_m: definition.thickness_allowance_m
                    * definition.helix_angle_rad.cos(),
                ..definition.clone()
            };
            ToothGeometry::new(&definition)
                .map_err(|source| RootSectionError::Virtual { teeth, source })
        };
        let own = ToothGeometry::new(definition).map_err(|source| RootSectionError::Virtual {
            teeth: definition.teeth,
            source,
        })?;
        let above = own.tip_radius_m - own.reference_radius_m;
        let teeth = own.virtual_teeth();
        let (low, share) = (teeth.floor() as usize, teeth.fract());
        let mut gears = vec![(spur(low, above)?, 1.0 - share)];
        if share > 0.0 {
            gears.push((spur(low + 1, above)?, share));
        }
        Ok(Self {
            gears,
            module_m: definition.module_m,
            base_cos_squared: own.base_helix_angle_rad().cos().powi(2),
        })
    }

    /// What `figure` gives for the gear, linear in the number of teeth.
    ///
    /// # Errors
    /// Those of `figure`.
    pub fn interpolated<E>(
        &self,
        figure: impl Fn(&ToothGeometry) -> Result<f64, E>,
    ) -> Result<f64, E> {
        let mut sum = 0.0;
        for (gear, share) in &self.gears {
            sum += share * figure(gear)?;
        }
        Ok(sum)
    }

    /// Contact ratio in the normal section, ε_αn = ε_α/cos²β_b.
    #[must_use]
    pub fn contact_ratio(&self, transverse_contact_ratio: f64) -> f64 {
        transverse_contact_ratio / self.base_cos_squared
    }

    /// Lewis's factor Y (in normal modules) by the parabola, for a load at the given point in a pair with the
    /// transverse contact ratio ε_α.
    ///
    /// # Errors
    /// [`RootSectionError`], see its variants.
    pub fn lewis_factor(
        &self,
        load: LoadPoint,
        transverse_contact_ratio: f64,
    ) -> Result<f64, RootSectionError> {
        self.interpolated(|gear| {
            let roll_rad = match load {
                LoadPoint::Tip => gear.flank_end_roll_rad,
                LoadPoint::HighestSingleContact => highest_single_contact_roll_rad(
                    gear,
                    self.contact_ratio(transverse_contact_ratio),
                )?,
            };
            let section = RootSection::new(gear, roll_rad, RootConstruction::Parabola)?;
            Ok(section.lewis_factor(self.module_m))
        })
    }
}
