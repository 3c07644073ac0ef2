//! A stage of cylindrical gears at a glance: what follows from its teeth, its centre distance and its speed at the
//! start.

use gearmesh_geometry::{GearDefinition, GearPair, InputError};
use gearmesh_model::{Fields, FileError, Record};
use serde::Serialize;

use super::iso_stiffness::{N_PER_MM_UM, REFERENCE_LINE_LOAD_N_PER_M, iso_stiffness};
use crate::pair::SceneResult;

/// Figures of a stage, whatever the model of its mesh.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct StageSummary {
    /// u: teeth of gear 2 over those of gear 1, negative with a ring (ISO 21771).
    pub ratio: f64,
    /// Transverse contact ratio ε_α.
    pub contact_ratio: f64,
    /// Overlap ratio ε_β over the common width.
    pub overlap_ratio: f64,
    /// Single stiffness c′ after ISO 6336-1 method B at 100 N/mm or more \[N/m²\].
    #[serde(rename = "single_stiffness_N_per_m2")]
    pub single_stiffness_n_per_m2: f64,
    /// Mesh stiffness c_γα likewise \[N/m²\].
    #[serde(rename = "mesh_stiffness_N_per_m2")]
    pub mesh_stiffness_n_per_m2: f64,
    /// Radius of gear 1's working pitch circle \[m\].
    pub pitch_radius_1_m: f64,
    /// Largest sliding over the path of contact, as a share of the speed of the pitch line.
    pub largest_sliding: f64,
    /// Tangential, radial and axial force between the working pitch circles under 1 N m on gear 1, without friction
    /// \[N\].
    #[serde(rename = "forces_of_1_Nm_N")]
    pub forces_of_1_nm_n: [f64; 3],
    /// Speed of the pitch line at the start \[m/s\], seen from the line of centres.
    pub pitch_line_speed_m_per_s: f64,
}

impl Record for StageSummary {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        let mut number =
            |name: &str, value: &mut f64, unit: &str, what: &str| f.number(name, value, unit, what);
        let what = "teeth of gear 2 over those of gear 1, negative with a ring";
        number("ratio", &mut self.ratio, "1", what)?;
        let what = "transverse contact ratio";
        number("contact_ratio", &mut self.contact_ratio, "1", what)?;
        let what = "overlap ratio over the common width";
        number("overlap_ratio", &mut self.overlap_ratio, "1", what)?;
        let what = "single stiffness after ISO 6336-1 method B";
        let value = &mut self.single_stiffness_n_per_m2;
        number("single_stiffness_N_per_m2", value, "N/m²", what)?;
        let what = "mesh stiffness after ISO 6336-1 method B";
        let value = &mut self.mesh_stiffness_n_per_m2;
        number("mesh_stiffness_N_per_m2", value, "N/m²", what)?;
        let what = "radius of gear 1's working pitch circle";
        number("pitch_radius_1_m", &mut self.pitch_radius_1_m, "m", what)?;
        let what = "largest sliding as a share of the speed of the pitch line";
        number("largest_sliding", &mut self.largest_sliding, "1", what)?;
        let what = "speed of the pitch line at the start";
        let value = &mut self.pitch_line_speed_m_per_s;
        number("pitch_line_speed_m_per_s", value, "m/s", what)?;
        let axes = [("tangential, radial, axial", 3)];
        let what = "force between the working pitch circles under 1 N m on gear 1";
        f.fixed(
            "forces_of_1_Nm_N",
            &mut self.forces_of_1_nm_n,
            &axes,
            "N",
            what,
        )
    }
}

impl StageSummary {
    /// The figures of a pair over a common width \[m\], its stiffness that of ISO 6336-1; no speed yet.
    pub(crate) fn new(pair: &GearPair, gears: [&GearDefinition; 2], width_m: f64) -> Self {
        let (first, second) = (&pair.gear_1, &pair.gear_2);
        let alpha = pair.working_pressure_angle_rad;
        let pitch_radius_1_m = first.base_radius_m / alpha.cos();
        let ends = [pair.roll_start_1_rad, pair.roll_end_1_rad];
        let sliding = ends.map(|roll| pair.sliding_velocity_m_per_s(roll, 1.0).abs());
        // On the working pitch cylinder the helix rises as on the base cylinder.
        let helix = (pair.base_helix_angle_rad().tan() / alpha.cos()).abs();
        let tangential = 1.0 / pitch_radius_1_m;
        let stiffness = iso_stiffness(gears, REFERENCE_LINE_LOAD_N_PER_M);
        Self {
            ratio: (second.teeth as f64 / first.teeth as f64)
                .copysign(pair.circles().sense(0) * pair.circles().sense(1)),
            contact_ratio: pair.contact_ratio(),
            overlap_ratio: pair.overlap_ratio(width_m),
            single_stiffness_n_per_m2: N_PER_MM_UM * stiffness.single(),
            mesh_stiffness_n_per_m2: stiffness.mesh_n_per_m2(pair.contact_ratio()),
            pitch_radius_1_m,
            largest_sliding: sliding[0].max(sliding[1]) / pitch_radius_1_m,
            forces_of_1_nm_n: [tangential, tangential * alpha.tan(), tangential * helix],
            pitch_line_speed_m_per_s: 0.0,
        }
    }

    /// In words, for people.
    #[must_use]
    pub fn words(&self) -> String {
        let [tangential, radial, axial] = self.forces_of_1_nm_n;
        let pitch_line = match self.pitch_line_speed_m_per_s {
            0.0 => String::new(),
            speed => format!("pitch line {speed:.3} m/s at the start, "),
        };
        format!(
            "ratio {:.6}, eps_alpha {:.3}, eps_beta {:.3}, c' {:.3} and c_gamma {:.3} N/(mm um) after ISO 6336-1 method B, \
             {pitch_line}sliding up to {:.1} % of the pitch line's speed; 1 N m on gear 1: {tangential:.2} N tangential, {radial:.2} N radial, {axial:.2} N axial",
            self.ratio,
            self.contact_ratio,
            self.overlap_ratio,
            self.single_stiffness_n_per_m2 / N_PER_MM_UM,
            self.mesh_stiffness_n_per_m2 / N_PER_MM_UM,
            100.0 * self.largest_sliding
        )
    }
}

impl SceneResult {
    /// The stage at a glance: what follows from teeth and centre distance; none of bevel pairs.
    ///
    /// # Errors
    /// As of [`Self::overlap_width_m`].
    pub fn stage(&self) -> Result<Option<StageSummary>, InputError> {
        let Some(pair) = self.gear_pair()? else {
            return Ok(None);
        };
        let (gears, width_m) = (self.definitions()?, self.overlap_width_m()?);
        Ok(Some(StageSummary::new(&pair, gears, width_m)))
    }
}
