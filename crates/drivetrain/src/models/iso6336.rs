//! `iso6336`: one spring for the whole mesh, c_γ b, after ISO 6336-1 method B, constant or with a sine over the mesh
//! cycle; or the tangent to the static curve of the pair itself (pair_curve.rs).
//!
//! ```text
//! q′ = 0.04723 + 0.15551/z_n1 + 0.25791/z_n2 − 0.00635 x₁ − 0.11654 x₁/z_n1 − 0.00193 x₂ − 0.24188 x₂/z_n2 + 0.00529 x₁² + 0.00182 x₂²
//! c′ = C_M C_R C_B cos β (E/206 GPa)/q′,   C_B = [1 + 0.5(1.2 − h_fP/m_n)] [1 − 0.02(20° − α_Pn)]
//! c′ falls with the fourth root of the load below 100 N/mm,   c_γα = c′ (0.75 ε_α + 0.25)
//! ```
//!
//! in N/(mm·µm). The spring acts on the gap of the ideal flanks in the pitch point, which all pairs have in common, and
//! knows no single tooth: flank errors are refused with it. Force and energy are functions of the pose alone, whatever
//! pair of teeth is nearest: on tilted helical gears pairs differ in their gaps, and a spring that went from one to the
//! next would make energy. Friction acts where the pair on the path is; on helical teeth each slice has its own phase
//! of the sine. c_γα is a force over an arc of the base circle, both in the transverse plane: along the normal the
//! spring is c_γα b/cos²β_b.

use crate::error::{DrivetrainError, not_negative, positive};
use crate::flank_contacts::{FlankContacts, Section};
use crate::models::teeth_model::{TeethLoads, TeethModel};
use crate::pair_curve::PairCurve;
use crate::roll_harmonics::RollHarmonics;

/// What the single stiffness of ISO 6336-1 depends on. Gear 1 is the pinion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SingleStiffness {
    /// Virtual numbers of teeth z_n.
    pub virtual_teeth: [f64; 2],
    /// Profile shift coefficients x.
    pub profile_shifts: [f64; 2],
    /// Helix angle β \[rad\].
    pub helix_angle_rad: f64,
    /// Dedendum of the basic rack over the module, h_fP/m_n.
    pub rack_dedendum: f64,
    /// Pressure angle of the basic rack α_Pn \[rad\].
    pub rack_pressure_angle_rad: f64,
    /// C_R of thin webs; 1 for solid discs.
    pub blank_factor: f64,
    /// Young's modulus of both gears \[Pa\]: E = 2 E₁E₂/(E₁ + E₂).
    pub young_pa: f64,
    /// F_t K_A/b \[N/m\].
    pub line_load_n_per_m: f64,
}

impl SingleStiffness {
    /// Theoretical single stiffness c′_th = 1/q′ \[N/(mm·µm)\].
    #[must_use]
    pub fn theoretical(&self) -> f64 {
        let [z1, z2] = self.virtual_teeth;
        let [x1, x2] = self.profile_shifts;
        let flexibility = 0.04723 + 0.15551 / z1 + 0.25791 / z2
            - 0.00635 * x1
            - 0.11654 * x1 / z1
            - 0.00193 * x2
            - 0.24188 * x2 / z2
            + 0.00529 * x1 * x1
            + 0.00182 * x2 * x2;
        1.0 / flexibility
    }

    /// Single stiffness c′ \[N/(mm·µm)\].
    #[must_use]
    pub fn single(&self) -> f64 {
        let rack = (1.0 + 0.5 * (1.2 - self.rack_dedendum))
            * (1.0 - 0.02 * (20.0 - self.rack_pressure_angle_rad.to_degrees()));
        let light = (self.line_load_n_per_m / 1e5).min(1.0).powf(0.25);
        0.8 * self.blank_factor
            * rack
            * self.helix_angle_rad.cos()
            * (self.young_pa / 206e9)
            * light
            * self.theoretical()
    }

    /// Mesh stiffness over the face width, c_γα \[N/m per m\] at the contact ratio ε_α.
    #[must_use]
    pub fn mesh_n_per_m2(&self, contact_ratio: f64) -> f64 {
        self.single() * (0.75 * contact_ratio + 0.25) * 1e9
    }
}

/// C_R of a thin web: 1 + ln(b_s/b)/(5 exp(s_R/(5 m_n))), with b_s/b held in 0.2…1.2 and s_R/m_n at 1 at least.
#[must_use]
pub fn blank_factor(web_over_face: f64, rim_over_module: f64) -> f64 {
    let web = web_over_face.clamp(0.2, 1.2);
    1.0 + web.ln() / (5.0 * (rim_over_module.max(1.0) / 5.0).exp())
}

/// The load at which a pair's static curve was taken: there the spring has the pair's deflection.
#[derive(Debug, Clone, PartialEq)]
struct OperatingPoint {
    force_n: f64,
    deflection_m: RollHarmonics,
}

/// The spring of the whole mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshSpring {
    stiffness_n_per_m: RollHarmonics,
    operating: Option<OperatingPoint>,
    slices: f64,
    middle_roll_rad: f64,
    /// Roll angle of each slice's section less that at whose phase the curves are taken \[rad\]; none where that is its
    /// own.
    ahead_rad: Vec<f64>,
}

/// A spring at one roll angle.
#[derive(Debug, Clone, Copy, PartialEq)]
struct SpringAt {
    /// k and dk/dξ.
    stiffness: (f64, f64),
    /// Depth at which the force begins, and its derivative by ξ.
    touch_m: (f64, f64),
}

impl MeshSpring {
    /// A spring of `stiffness_n_per_m` shared by `slices`; `middle_roll_rad` is the roll angle at the pitch point, the
    /// same on both gears: about half-way of the path.
    ///
    /// # Errors
    /// [`DrivetrainError::Value`].
    pub fn new(
        stiffness_n_per_m: f64,
        slices: usize,
        middle_roll_rad: f64,
    ) -> Result<Self, DrivetrainError> {
        let mean = positive("iso6336 mesh", "the stiffness in N/m", stiffness_n_per_m)?;
        Ok(Self {
            stiffness_n_per_m: RollHarmonics::constant(mean),
            operating: None,
            slices: slices as f64,
            middle_roll_rad,
            ahead_rad: Vec::new(),
        })
    }

    /// The tangent to a pair's static curve, F = F₀ + k(ξ) (δ − δ₀(ξ)) where that is positive, shared by `slices`.
    #[must_use]
    pub fn on_curve(curve: &PairCurve, slices: usize, middle_roll_rad: f64) -> Self {
        Self {
            stiffness_n_per_m: curve.tangent_n_per_m().clone(),
            operating: Some(OperatingPoint {
                force_n: curve.force_n(),
                deflection_m: curve.deflection_m().clone(),
            }),
            slices: slices as f64,
            middle_roll_rad,
            ahead_rad: Vec::new(),
        }
    }

    /// Takes the curves of all slices at one phase, that at mid-face: for curves of the mesh as a whole on helical
    /// teeth. `ahead_rad`: roll angle of each slice's section on gear 1 less that at mid-face.
    #[must_use]
    pub fn with_phase_of_mid_face(mut self, ahead_rad: Vec<f64>) -> Self {
        self.ahead_rad = ahead_rad;
        self
    }

    /// Turns a stiffness in the transverse plane, as ISO 6336-1 states it, into that along the normal of helical
    /// flanks: over cos²β_b.
    #[must_use]
    pub fn on_base_helix(mut self, base_helix_angle_rad: f64) -> Self {
        let cos = base_helix_angle_rad.cos();
        self.stiffness_n_per_m = self.stiffness_n_per_m.scaled(1.0 / (cos * cos));
        self.operating = self.operating.map(|point| OperatingPoint {
            force_n: point.force_n / cos,
            deflection_m: point.deflection_m.scaled(cos),
        });
        self
    }

    /// Lets the stiffness vary as 1 + A cos(z₁(ξ₁ − ξ_max)) over the mesh cycle, 0 ≤ A < 1.
    ///
    /// # Errors
    /// [`DrivetrainError::Value`].
    pub fn with_sine(
        mut self,
        relative_amplitude: f64,
        roll_of_maximum_rad: f64,
        teeth_1: usize,
    ) -> Result<Self, DrivetrainError> {
        let what = "the relative amplitude of the stiffness";
        not_negative("iso6336 mesh", what, relative_amplitude)?;
        DrivetrainError::require(
            "iso6336 mesh",
            (what, relative_amplitude),
            relative_amplitude < 1.0,
            "below 1",
        )?;
        let mean = self.stiffness_n_per_m.mean();
        let sine = [(relative_amplitude * mean, 0.0)];
        self.stiffness_n_per_m = RollHarmonics::new(mean, &sine, teeth_1, roll_of_maximum_rad);
        Ok(self)
    }

    fn at(&self, roll_1_rad: f64) -> SpringAt {
        let stiffness = self.stiffness_n_per_m.at(roll_1_rad);
        let touch_m = self.operating.as_ref().map_or((0.0, 0.0), |point| {
            let (k, k_slope) = stiffness;
            let (deflection, slope) = point.deflection_m.at(roll_1_rad);
            let taken_up = point.force_n / k;
            (deflection - taken_up, slope + taken_up * k_slope / k)
        });
        SpringAt { stiffness, touch_m }
    }
}

impl TeethModel for MeshSpring {
    fn evaluate(
        &mut self,
        flanks: &FlankContacts,
        _tangents: bool,
        loads: &mut TeethLoads,
    ) -> Result<(), DrivetrainError> {
        // All pairs of a slice have one gap here: which of them carries is where friction acts.
        let [r1, r2] = flanks.action_m_per_u;
        let off_path = |section: &Section| -> f64 {
            let beyond = [0, 1].map(|i| section.roll_rad[i] - section.touching_roll_rad[i]);
            (beyond.iter().zip([r1, r2]))
                .map(|(rad, r)| (r.signum() * rad).max(0.0))
                .sum()
        };
        let from_middle = |section: &Section| {
            let [of_1, of_2] = section.roll_rad.map(|roll| roll - self.middle_roll_rad);
            (r1 * of_1 - r2 * of_2).abs()
        };
        let order = |a: &Section, b: &Section| {
            let ends = off_path(a).total_cmp(&off_path(b));
            ends.then(from_middle(a).total_cmp(&from_middle(b)))
        };
        let n = flanks.contacts.len();
        for slice in 0..self.slices as usize {
            let in_slice = flanks.contacts.iter().enumerate();
            let nearest = (in_slice.filter(|(_, contact)| contact.slice == slice))
                .min_by(|(_, a), (_, b)| order(flanks.section(a), flanks.section(b)));
            let Some((i, contact)) = nearest else {
                continue;
            };
            let ahead = self.ahead_rad.get(slice).copied().unwrap_or(0.0);
            let section = flanks.section(contact);
            let spring = self.at(section.roll_rad[0] - ahead);
            let depth = -contact.gap_m - spring.touch_m.0;
            if depth > 0.0 {
                let (stiffness, slope) = spring.stiffness;
                let width = section.share / self.slices;
                let (each, each_slope) = (stiffness * width, slope * width);
                let force = each * depth;
                let stored = 0.5 * force * depth;
                loads.normal_n[i] = force;
                loads.stiffness_n_per_m[i * n + i] = each;
                loads.stored_j += stored;
                loads.energy_by_roll[contact.section][0] +=
                    force * spring.touch_m.1 - 0.5 * each_slope * depth * depth;
                loads.energy_by_share[contact.section] -= stored / section.share;
            }
        }
        Ok(())
    }

    fn resolves_teeth(&self) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ISO/TR 6336-30 example 1: m_n 8, z 17/103, β 15.8°, x 0.145/0, α_n 20°, h_fP 1.4 m. Published: c′_th 17.85584,
    /// c′ 12.37047, c_γα 17.46485 N/(mm·µm), with ε_α 1.5489.
    #[test]
    fn the_published_example() {
        let beta = 15.8f64.to_radians();
        let alpha_n = 20f64.to_radians();
        let base_cos = (1.0 - (beta.sin() * alpha_n.cos()).powi(2)).sqrt();
        let virtual_teeth = [17.0, 103.0].map(|z| z / (base_cos * base_cos * beta.cos()));
        let pair = SingleStiffness {
            virtual_teeth,
            profile_shifts: [0.145, 0.0],
            helix_angle_rad: beta,
            rack_dedendum: 1.4,
            rack_pressure_angle_rad: alpha_n,
            blank_factor: 1.0,
            young_pa: 206e9,
            line_load_n_per_m: 4e5,
        };
        assert!(
            (pair.theoretical() - 17.85584).abs() < 1e-5,
            "{}",
            pair.theoretical()
        );
        assert!((pair.single() - 12.37047).abs() < 1e-5, "{}", pair.single());
        let published_ratio: f64 = (17.46485 / 12.37047 - 0.25) / 0.75;
        assert!((published_ratio - 1.549).abs() < 1e-3);
        let mesh = pair.mesh_n_per_m2(published_ratio) * 1e-9;
        assert!((mesh - 17.46485).abs() < 1e-4);
        let light = SingleStiffness {
            line_load_n_per_m: 1e5 / 16.0,
            ..pair
        };
        assert!((light.single() / pair.single() - 0.5).abs() < 1e-12);
    }

    #[test]
    fn webs_soften() {
        assert!((blank_factor(1.0, 3.0) - 1.0).abs() < 1e-15);
        assert!((blank_factor(0.1, 0.5) - blank_factor(0.2, 1.0)).abs() < 1e-15);
        assert!(blank_factor(0.3, 2.0) < 1.0);
    }
}
