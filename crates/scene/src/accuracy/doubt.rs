//! How far the reference itself may be off: what its knobs would still change, and how far runs part that begin next to
//! each other.

use super::bench::{Bench, Measured};
use super::column_errors::largest;
use super::knobs::{Knob, case_of};
use super::ladder::{Accuracy, top_of};
use crate::study::StudyError;

/// Runs that begin next to each other and part by more than this, a tenth of the finest goal, are chaotic: their
/// figures are statistics.
const PARTED: f64 = 1e-4;

/// Runs of a chaotic scene, the reference among them.
const NEIGHBOURS: usize = 5;

/// How far each column of a chaotic reference spreads over neighbouring runs: its standard deviation over their mean,
/// which the reference becomes. Empty where neighbours stay together, or where nothing moves in time.
///
/// A neighbour has ρ∞ of the integrator changed by 1e-4. That changes a regular run by some 1e-4 of what its steps
/// leave, far less than [`PARTED`]; in a chaotic one the difference grows by e in each Lyapunov time, from 1e-4 of the
/// error of a step to the size of the motion.
///
/// # Errors
/// [`StudyError`] for a neighbour that cannot be run.
pub(super) fn spread(
    bench: &Bench<'_>,
    knobs: &[Knob],
    reference: &mut Measured,
) -> Result<Vec<f64>, StudyError> {
    let case = case_of(knobs, &top_of(knobs));
    let mut all = vec![reference.values.clone()];
    for number in 1..NEIGHBOURS {
        let Some(beside) = bench.beside(&case, number) else {
            return Ok(Vec::new());
        };
        all.push(bench.measure(&beside)?.values);
        if number == 1 && largest(&bench.errors(&all[1], &all[0])) < PARTED {
            return Ok(Vec::new());
        }
    }
    let (means, deviations): (Vec<f64>, Vec<f64>) = (0..reference.values.len())
        .map(|column| mean_and_deviation(all.iter().map(|values| values[column])))
        .unzip();
    let over = |(deviation, scale): (&f64, f64)| match *deviation {
        0.0 => 0.0,
        deviation => deviation / scale,
    };
    let spreads = deviations.iter().zip(bench.scales(&means)).map(over);
    let spreads = spreads.collect();
    reference.values = means;
    Ok(spreads)
}

/// Mean and standard deviation of a sample.
fn mean_and_deviation(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let count = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / count;
    let squares: f64 = values.map(|value| (value - mean).powi(2)).sum();
    (mean, (squares / (count - 1.0)).sqrt())
}

impl Accuracy {
    /// How far each column of the reference may itself be off, relative: what the last rung of each knob leaves, added
    /// up over the knobs whose rungs go up or down, and the spread of a chaotic run.
    #[must_use]
    pub fn doubts(&self) -> Vec<f64> {
        let mut doubts = self.spread.clone();
        doubts.resize(self.columns.len(), 0.0);
        for (number, knob) in self.knobs.iter().enumerate() {
            let Some(values) = in_one_direction(knob) else {
                continue;
            };
            let last = values.len() - 1;
            let Some(below) = self.alone(number, last - 1) else {
                continue;
            };
            // Rungs of one ratio say how fast the column settles.
            let even = last > 1
                && (values[last] * values[last - 2] / values[last - 1].powi(2) - 1.0).abs() < 1e-3;
            let before = if even {
                self.alone(number, last - 2)
            } else {
                None
            };
            for (column, doubt) in doubts.iter_mut().enumerate() {
                *doubt += left_over(below[column], before.map(|errors| errors[column]));
            }
        }
        doubts
    }

    /// Errors with one knob alone on a rung.
    fn alone(&self, knob: usize, rung: usize) -> Option<&[f64]> {
        let mut tried = self.tried.iter();
        let one = tried.find(|one| one.alone == Some(knob) && one.rungs[knob] == rung)?;
        Some(&one.errors)
    }
}

/// Rungs as numbers, where they are numbers that grow or fall; others are choices, none of which is nearer to the
/// truth.
pub(super) fn in_one_direction(knob: &Knob) -> Option<Vec<f64>> {
    let values: Result<Vec<f64>, _> = knob.rungs.iter().map(|rung| rung.label.parse()).collect();
    let values = values.ok()?;
    let grows = values.is_sorted() || values.iter().rev().is_sorted();
    (grows && values.len() > 1).then_some(values)
}

/// What the last rung may leave, from its change e₁ and that of the last two rungs together, e₂.
///
/// Where every rung leaves a share q of what the one below left, e₁ = c (1 − q) and e₂ = c (1 − q²)/q with c of the
/// rung below the last, so that 1/q = e₂/e₁ − 1 and c q = e₁/(1/q − 1). Times 1.25, for orders mix: Roache's grid
/// convergence index of three grids (J. Fluids Eng. 116, 1994, 405). A 1/q below 2, slower than first order, counts as
/// 2; where e₂ is not known it is e₁.
fn left_over(last: f64, last_two: Option<f64>) -> f64 {
    last_two.map_or(last, |two| {
        1.25 * last / ((two / last - 1.0).max(2.0) - 1.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x + h², at h of 4, 2 and 1: 1 is left.
    #[test]
    fn what_is_left_of_a_series() {
        assert_eq!(left_over(3.0, Some(15.0)), 1.25);
        // x + h, and what settles slower still or does not fit.
        for two in [3.0, 2.0, 0.5] {
            assert_eq!(left_over(1.0, Some(two)), 1.25);
        }
        assert_eq!(left_over(1.0, None), 1.0);
        assert_eq!(left_over(0.0, Some(1.0)), 0.0);
        assert_eq!(left_over(0.0, Some(0.0)), 0.0);
    }

    #[test]
    fn deviation_is_that_of_a_sample() {
        let found = mean_and_deviation([9.0, 10.0, 11.0].into_iter());
        assert_eq!(found, (10.0, 1.0));
        assert_eq!(mean_and_deviation([0.0, 0.0].into_iter()), (0.0, 0.0));
    }
}
