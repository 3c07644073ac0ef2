//! Which trials no other one beats.

use super::evaluator::{Trial, in_order};

/// The Pareto front: trials of which no other one is as small in all objectives and smaller in one; by the first
/// objective, increasing. Of trials with equal objectives the first one stands for all.
#[must_use]
pub fn front(tried: &[Trial]) -> Vec<Trial> {
    let mut sorted: Vec<&Trial> = tried.iter().collect();
    // A trial is beaten by none that comes after it in this order.
    sorted.sort_by(|a, b| in_order(&a.objectives, &b.objectives));
    let mut front: Vec<Trial> = Vec::new();
    for trial in sorted {
        let as_good = |other: &Trial| {
            let mut pairs = other.objectives.iter().zip(&trial.objectives);
            pairs.all(|(theirs, own)| theirs <= own)
        };
        if !front.iter().any(as_good) {
            front.push(trial.clone());
        }
    }
    front
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    /// Against the definition, pair by pair, on made-up objectives.
    #[test]
    fn the_front_is_what_nothing_beats() {
        let mut rng = fastrand::Rng::with_seed(5);
        for objectives in [1, 2, 3] {
            let tried: Vec<Trial> = (0..200)
                .map(|k| Trial {
                    values: vec![f64::from(k)],
                    objectives: (0..objectives).map(|_| f64::from(rng.u32(0..20))).collect(),
                    yielding: None,
                })
                .collect();
            let beats = |a: &Trial, b: &Trial| {
                let pairs = || a.objectives.iter().zip(&b.objectives);
                pairs().all(|(x, y)| x <= y) && pairs().any(|(x, y)| x < y)
            };
            let found = front(&tried);
            for trial in &tried {
                let beaten = tried.iter().any(|other| beats(other, trial));
                let there = found.iter().any(|one| one.objectives == trial.objectives);
                assert_eq!(there, !beaten);
            }
            let first: Vec<f64> = found.iter().map(|trial| trial.objectives[0]).collect();
            assert!(first.is_sorted());
        }
    }
}
