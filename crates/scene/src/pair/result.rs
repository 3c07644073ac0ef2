//! The result of a scene. Its file: `result_record.rs`.

use super::between_positions::BetweenPositions;
use super::bevel_result::BevelRest;
use super::contact_places::ContactPlaces;
use super::coverage::named;
use crate::periods::Coverage;
use crate::rating::RatingResult;
use gearmesh_model::{GaugeRows, StoredGear};
use gearmesh_recovery::Strain;

/// Strain of one gauge, `[torque][angle]`, dimensionless.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StrainSeries {
    /// Gear 1 or 2.
    pub gear: usize,
    /// Name of the gauge.
    pub name: String,
    /// Estimated relative error of the mesh at this gauge, zero where it was not estimated.
    pub error_estimate_relative: f64,
    /// How much of its period the run has seen.
    pub coverage: Coverage,
    /// Method 1.
    pub method_1: Vec<f64>,
    /// Method 2.
    pub method_2: Vec<f64>,
    /// Both methods at the positions between the even ones, `[E][period]`: in each period of the mesh that the run has.
    /// One of them in files of older programs, or none.
    pub between: [Vec<f64>; 2],
}

impl StrainSeries {
    /// Reads a gauge of a gear at all positions of a result: `even` by torque and angle, `between` by number and
    /// pitches later. Positions between the even ones are those of the first period; tooth by tooth they come again
    /// in each.
    pub(super) fn read(
        result: &SceneResult,
        (gear, rows, coverage): (usize, &GaugeRows, Coverage),
        even: impl Fn(usize, usize) -> Strain,
        between: impl Fn(usize, usize) -> Strain,
    ) -> Self {
        let angles = result.angles();
        let cases = 0..result.torque_nm.len() * angles;
        let at_even: Vec<Strain> = cases.map(|k| even(k / angles, k % angles)).collect();
        let mesh = &result.contact_coverage;
        let periods = (mesh.averaged_pitches() / mesh.period_pitches.max(1)).max(1);
        let at_between: Vec<Strain> = (0..result.between.angle_rad.len() * periods)
            .map(|k| between(k / periods, k % periods * mesh.period_pitches))
            .collect();
        let method =
            |of: &[Strain], value: fn(&Strain) -> f64| of.iter().map(value).collect::<Vec<f64>>();
        let methods = |of: &[Strain]| [method(of, |s| s.method_1), method(of, |s| s.method_2)];
        let [method_1, method_2] = methods(&at_even);
        Self {
            gear,
            name: rows.name.clone(),
            error_estimate_relative: rows.error_estimate_relative,
            coverage,
            method_1,
            method_2,
            between: methods(&at_between),
        }
    }

    /// The estimated relative error of the mesh; none where it was not estimated.
    pub fn error_estimate(&self) -> Option<f64> {
        (self.error_estimate_relative > 0.0).then_some(self.error_estimate_relative)
    }
}

/// Where the result of a pair comes from.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PairSource {
    /// Title of the scene.
    pub title: String,
    /// The scene file, verbatim.
    pub scene_toml: String,
    /// The gears of the models.
    pub gears: [StoredGear; 2],
    /// Model files, as absolute paths, so that the result can be used from any folder.
    pub model_files: [String; 2],
    /// Microgeometry of gear 1 and gear 2 in words; empty in files of older programs.
    pub microgeometry: [String; 2],
    /// Program version.
    pub version: String,
    /// When, UTC.
    pub created_utc: String,
}

/// Forces on the contact lines. With T torques, A angles, L line slots and S slices.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LineForces {
    /// Line slots L.
    pub slots: usize,
    /// Slices S.
    pub slices: usize,
    /// Pair number in each slot, `[A][L]`; only the first `pair_count` are used.
    pub pair: Vec<f64>,
    /// Contact lines looked at, `[A]`; tip edges beyond the path that stay apart count too, with no force.
    pub pair_count: Vec<u32>,
    /// Slice forces \[N\], `[T][A][L][S]`.
    pub force_n: Vec<f64>,
    /// Hertz pressure \[Pa\], `[T][A][L][S]`.
    pub pressure_pa: Vec<f64>,
    /// Where the slices touch; none in files of older programs.
    pub places: Option<ContactPlaces>,
    /// Largest over mean line load of the most loaded line, worst of all positions, per torque: K_Hβ.
    pub k_h_beta: Vec<f64>,
}

/// How a pair was solved. With T torques.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PairSolution {
    /// Newton iterations, sum over all positions, `[T]`.
    pub iterations: Vec<u32>,
    /// Largest relative residual, `[T]`.
    pub residual: Vec<f64>,
    /// Largest relative error of Σ F b = T₂, `[T]`.
    pub torque_balance: Vec<f64>,
    /// Solution and strain time \[s\].
    pub seconds: [f64; 2],
}

/// All curves of a run. With T torques and A angles.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SceneResult {
    /// Where it comes from.
    pub source: PairSource,
    /// Pitches of gear 1 that the angles run through.
    pub pitches: usize,
    /// How much of the period of transmission error, stiffness, forces and pressure the run has seen.
    pub contact_coverage: Coverage,
    /// A run that would cover what this one does not; empty where it covers everything.
    pub proposal: String,
    /// Driver angles \[rad\], A.
    pub angle_rad: Vec<f64>,
    /// Torques on gear 2 \[N·m\], T.
    pub torque_nm: Vec<f64>,
    /// Transmission error \[m\], `[T][A]`.
    pub te_m: Vec<f64>,
    /// Transmission error at first touch \[m\], `[A]`.
    pub unloaded_m: Vec<f64>,
    /// Torque on gear 1 \[N·m\], `[T][A]`.
    pub torque_1_nm: Vec<f64>,
    /// Axial force on gear 1 \[N\], positive along +z, `[T][A]`; gear 2 feels the opposite. Zero for spur gears.
    pub axial_force_1_n: Vec<f64>,
    /// Secant mesh stiffness \[N/m\], `[T][A]`.
    pub secant_n_per_m: Vec<f64>,
    /// Tangent mesh stiffness \[N/m\], `[T][A]`.
    pub tangent_n_per_m: Vec<f64>,
    /// Forces and pressures on the contact lines.
    pub lines: LineForces,
    /// How it was solved.
    pub solution: PairSolution,
    /// Estimated relative error of the mesh in the deflection of a tooth while the next one carries, too: the larger
    /// one of both gears, zero where it was not estimated.
    pub te_mesh_error: f64,
    /// Positions beside the even ones: at events and peaks.
    pub between: BetweenPositions,
    /// What bevel pairs have besides.
    pub bevel: Option<BevelRest>,
    /// Strain.
    pub strain: Vec<StrainSeries>,
    /// Ratings, torque by torque.
    pub ratings: Vec<RatingResult>,
    /// Warnings about assumptions.
    pub warnings: Vec<String>,
}

impl SceneResult {
    /// Number of angles.
    pub fn angles(&self) -> usize {
        self.angle_rad.len()
    }

    /// One torque's part of a `[T][A]` array.
    pub fn curve<'a>(&self, values: &'a [f64], torque: usize) -> &'a [f64] {
        &values[torque * self.angles()..(torque + 1) * self.angles()]
    }

    /// Positions in a pitch.
    pub fn points_per_pitch(&self) -> usize {
        self.angles() / self.pitches.max(1)
    }

    /// The part of one torque's curve of the mesh that means are made of: as many whole periods as there are.
    pub fn averaged<'a>(&self, values: &'a [f64], torque: usize) -> &'a [f64] {
        let points = self.contact_coverage.averaged_pitches() * self.points_per_pitch();
        &self.curve(values, torque)[..points]
    }

    /// All quantities with how much of their period the run has seen: those of the mesh first, then each gauge.
    pub fn coverages(&self) -> Vec<(String, Coverage)> {
        named(self.contact_coverage, &self.strain)
    }

    /// What is incomplete, a sentence for each quantity; empty where nothing is.
    pub fn incomplete(&self) -> Vec<String> {
        let sentence =
            |(name, coverage): (String, Coverage)| Some(format!("{name}: {}", coverage.missing()?));
        self.coverages().into_iter().filter_map(sentence).collect()
    }

    /// Whether the gears push each other along the axis: helical teeth.
    pub fn has_axial_force(&self) -> bool {
        self.axial_force_1_n.iter().any(|force| *force != 0.0)
    }

    /// Sum of all slice forces at each position of a torque \[N\], `[A]`.
    pub fn normal_force_n(&self, torque: usize) -> Vec<f64> {
        (0..self.angles())
            .map(|angle| self.position_forces(torque, angle).iter().sum())
            .collect()
    }

    /// Slice forces of all lines at one position \[N\], `[L][S]`.
    pub fn position_forces(&self, torque: usize, angle: usize) -> &[f64] {
        let size = self.lines.slots * self.lines.slices;
        &self.lines.force_n[(torque * self.angles() + angle) * size..][..size]
    }

    /// Slice forces of one line \[N\].
    pub fn forces(&self, torque: usize, angle: usize, slot: usize) -> &[f64] {
        let first =
            ((torque * self.angles() + angle) * self.lines.slots + slot) * self.lines.slices;
        &self.lines.force_n[first..first + self.lines.slices]
    }
}
