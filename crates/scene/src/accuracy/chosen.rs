//! The setting for a goal without trying all of them: the search begins where a scene of the same kind was found to be
//! exact enough, and climbs until one rung more of every knob changes the columns by little enough.

use super::bench::{Bench, Measured};
use super::column_errors::largest;
use super::doubt::in_one_direction;
use super::fronts;
use super::knobs::{Knob, case_of};
use super::ladder::{top_of, words};
use super::paste::to_paste;
use crate::study::{StudyError, Subject};

/// Error of a setting over the change by one rung more.
///
/// A rung leaves a share q of the error, and changes 1 - q of it. Steps and distances go by halves, and first order is
/// the slowest there is, so q is at most 1/2: the lower rung's error is at most twice the change, the higher one's at
/// most the change itself.
const LEFT: f64 = 2.0;

/// The setting that was found.
#[derive(Debug, Clone)]
pub struct Chosen {
    /// The scene with it.
    pub subject: Subject,
    /// Keys and values, a line each, to paste.
    pub toml: Vec<String>,
    /// Names of the columns.
    pub columns: Vec<String>,
    /// Largest error of each column, relative; infinite where no other setting could be run beside it.
    pub errors: Vec<f64>,
    /// Asked for.
    pub goal: f64,
    /// Where the search began, in words.
    pub begun: String,
    /// Settings that were run.
    pub runs: usize,
    /// Settings that could not be run, and why.
    pub failed: Vec<String>,
}

impl Chosen {
    /// The column with the largest error, and that error.
    #[must_use]
    pub fn worst(&self) -> (&str, f64) {
        let all = self.columns.iter().zip(&self.errors);
        let worst = all.max_by(|a, b| a.1.total_cmp(b.1));
        worst.map_or(("", 0.0), |(column, error)| (column, *error))
    }

    /// Whether the goal was met.
    #[must_use]
    pub fn is_within(&self) -> bool {
        self.worst().1 <= self.goal
    }
}

/// Finds the setting for a goal. `progress` gets the number of settings that were run, and how many there are at most.
///
/// # Errors
/// [`StudyError`] for a scene without knobs, one whose most exact setting cannot be run, and on a stop.
pub fn choose(
    bench: &Bench<'_>,
    goal: f64,
    progress: &dyn Fn(usize, usize),
) -> Result<Chosen, StudyError> {
    let (mut knobs, _) = bench.knobs()?;
    if knobs.is_empty() {
        let problem = "has no setting that trades accuracy for time; run it as it is".to_owned();
        return Err(bench.refused(problem).into());
    }
    let (mut rungs, begun) = fronts::start(&bench.kind(), goal, &knobs);
    for knob in &mut knobs {
        let further = std::mem::take(&mut knob.further);
        knob.rungs.extend(further);
    }
    let top = top_of(&knobs);
    let left = top.iter().zip(&rungs).map(|(top, rung)| top - rung);
    let most = 2 + left.max().unwrap_or(0);
    let mut runs = 0;
    let mut failed = Vec::new();
    let mut measured = |rungs: &[usize]| {
        progress(runs, most);
        runs += 1;
        let outcome = bench.measure_once(&case_of(&knobs, rungs));
        match outcome {
            // A coarse setting may fail where a finer one does not.
            Err(error) if bench.is_stopped() || rungs == top => Err(error),
            Err(error) => {
                failed.push(format!("{}: {error}", words(&knobs, rungs)));
                Ok(None)
            }
            Ok(outcome) => Ok(Some(outcome)),
        }
    };
    let mut below = measured(&rungs)?;
    let mut found = vec![f64::INFINITY; bench.names().len()];
    while rungs != top {
        let higher = one_rung_more(&knobs, &rungs);
        let above = measured(&higher)?;
        found = changes(bench, below.as_ref(), above.as_ref());
        found.iter_mut().for_each(|change| *change *= LEFT);
        if largest(&found) <= goal {
            break;
        }
        (rungs, below) = (higher, above);
    }
    if rungs == top {
        // What the last rung of what has a direction still changes; there is none beyond it.
        let lower = one_rung_less(&knobs);
        let above = below;
        let below = if lower == top {
            None
        } else {
            measured(&lower)?
        };
        found = changes(bench, below.as_ref(), above.as_ref());
    }
    let case = case_of(&knobs, &rungs);
    Ok(Chosen {
        subject: bench.subject_of(&case)?,
        toml: to_paste(&knobs, &rungs, &|table| bench.name_of(table)),
        columns: bench.names(),
        errors: found,
        goal,
        begun,
        runs,
        failed,
    })
}

/// Every knob whose rungs have a direction one rung higher; of the others, whose rungs are choices, the top: none of
/// them is a measure of another.
fn one_rung_more(knobs: &[Knob], rungs: &[usize]) -> Vec<usize> {
    let more = |((knob, rung), top): ((&Knob, &usize), usize)| match in_one_direction(knob) {
        Some(_) => (rung + 1).min(top),
        None => top,
    };
    (knobs.iter().zip(rungs))
        .zip(top_of(knobs))
        .map(more)
        .collect()
}

/// The top with every knob whose rungs have a direction one rung lower.
fn one_rung_less(knobs: &[Knob]) -> Vec<usize> {
    let less = |knob: &Knob| knob.rungs.len() - 1 - usize::from(in_one_direction(knob).is_some());
    knobs.iter().map(less).collect()
}

fn changes(bench: &Bench<'_>, below: Option<&Measured>, above: Option<&Measured>) -> Vec<f64> {
    match (below, above) {
        (Some(below), Some(above)) => bench.errors(&below.values, &above.values),
        _ => vec![f64::INFINITY; bench.names().len()],
    }
}
