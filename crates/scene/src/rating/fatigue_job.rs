//! From the strain of a gauge to cycles, damage and life.

use std::path::Path;

use gearmesh_geometry::input::TableKeys;
use gearmesh_geometry::{InputError, Material};
use gearmesh_rating::{
    DamageError, MeanStress, Passage, SnCurve, TurningPoints, miner_damage, rainflow,
    root_stress_pa,
};
use gearmesh_specification::rating::FatigueRule;

use super::result::{RatingFigure, figures};
use super::sn_table_file::read_sn_table;

/// From the strain of a gauge to damage.
#[derive(Debug, Clone, PartialEq)]
pub struct FatigueJob {
    /// Stress over strain \[Pa\].
    pub modulus_pa: f64,
    /// S-N curve of local stress.
    pub curve: SnCurve,
    /// What the mean of a cycle does.
    pub mean_stress: MeanStress,
    /// How often the history is passed.
    pub passage: Passage,
}

/// How long one passage of a history takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PassageLength {
    /// Time \[s\].
    Seconds(f64),
    /// Revolutions of the gauge's gear.
    Revolutions(f64),
}

impl FatigueJob {
    /// The job of a rule for a gauge in this material; the S-N table is relative to the scene's folder.
    ///
    /// # Errors
    /// [`InputError`] for an S-N table that is none.
    pub fn new(
        rule: &FatigueRule,
        material: Material,
        folder: &Path,
        keys: &TableKeys<'_>,
    ) -> Result<Self, InputError> {
        Ok(Self {
            modulus_pa: root_stress_pa(&[1.0], material, rule.surface)[0],
            curve: read_sn_table(&folder.join(&rule.sn_table), keys)?,
            mean_stress: rule.mean_stress,
            passage: rule.passage,
        })
    }

    /// Figures of a history of stress \[Pa\].
    ///
    /// # Errors
    /// [`DamageError`], see its variants.
    pub fn figures(
        &self,
        points: TurningPoints,
        length: PassageLength,
    ) -> Result<Vec<RatingFigure>, DamageError> {
        let points = points.finish()?;
        let cycles = rainflow(&points, self.passage)?;
        let damage = miner_damage(&cycles, &self.curve, self.mean_stress)?;
        let worst = damage.most_damaging;
        let life = match length {
            PassageLength::Seconds(seconds) => ("life_h", damage.life_h(seconds)),
            PassageLength::Revolutions(turns) => ("life_revolutions", damage.life_in(turns)),
        };
        Ok(figures(&[
            (
                "least_stress_Pa",
                points.iter().copied().fold(f64::INFINITY, f64::min),
            ),
            (
                "largest_stress_Pa",
                points.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            ),
            ("cycles", damage.cycles),
            (
                "most_damaging_amplitude_Pa",
                worst.map_or(0.0, |cycle| cycle.amplitude()),
            ),
            (
                "most_damaging_mean_Pa",
                worst.map_or(0.0, |cycle| cycle.mean()),
            ),
            ("damage", damage.per_passage),
            ("life_passages", damage.passages_to_failure()),
            life,
        ]))
    }
}
