//! Fatigue damage of counted cycles by Miner's rule, and the life that follows.
//!
//! D = Σ n_i/N(σ_ar,i); failure at D = 1 (A. Palmgren 1924, M. A. Miner 1945).

use crate::damage_error::DamageError;
use crate::mean_stress::MeanStress;
use crate::rainflow::{Cycle, Passage, rainflow};
use crate::sn_curve::SnCurve;

/// Damage of one passage of a history.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Damage {
    /// Miner's sum D of one passage.
    pub per_passage: f64,
    /// Cycles counted, halves as ½.
    pub cycles: f64,
    /// The cycle that has the shortest life, a half like a whole one (the first of several alike); none without damage.
    pub most_damaging: Option<Cycle>,
}

impl Damage {
    /// Passages until D = 1; infinite without damage.
    pub fn passages_to_failure(&self) -> f64 {
        1.0 / self.per_passage
    }

    /// Life in hours if one passage takes `passage_s` seconds.
    pub fn life_h(&self, passage_s: f64) -> f64 {
        self.passages_to_failure() * passage_s / 3600.0
    }

    /// Life in units of which one passage has `per_passage`: revolutions, load cycles.
    pub fn life_in(&self, per_passage: f64) -> f64 {
        self.passages_to_failure() * per_passage
    }
}

/// Miner's sum of counted stress cycles \[Pa\].
///
/// # Errors
/// [`DamageError`], see its variants.
pub fn miner_damage(
    cycles: &[Cycle],
    curve: &SnCurve,
    mean_stress: MeanStress,
) -> Result<Damage, DamageError> {
    let mut damage = Damage {
        per_passage: 0.0,
        cycles: 0.0,
        most_damaging: None,
    };
    let mut most = 0.0;
    for cycle in cycles {
        let amplitude = mean_stress.equivalent_amplitude_pa(cycle)?;
        let one = 1.0 / curve.cycles_to_failure(amplitude)?;
        damage.per_passage += cycle.count * one;
        damage.cycles += cycle.count;
        if one > most {
            most = one;
            damage.most_damaging = Some(*cycle);
        }
    }
    Ok(damage)
}

/// Counts the cycles of a stress history \[Pa\] and adds up their damage.
///
/// # Errors
/// [`DamageError`], see its variants.
pub fn history_damage(
    stress_pa: &[f64],
    passage: Passage,
    curve: &SnCurve,
    mean_stress: MeanStress,
) -> Result<Damage, DamageError> {
    miner_damage(&rainflow(stress_pa, passage)?, curve, mean_stress)
}
