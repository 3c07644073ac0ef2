//! Which settings are tried, and which one to take.
//!
//! The reference has every knob at its top. From it each knob goes down alone: what it costs and what it saves. Errors
//! that add up and times that multiply then say which of all combinations may lie on the front; those are run, and what
//! is reported of them is measured, not predicted.

use super::bench::{Bench, JudgedTime, Measured};
use super::column_errors::largest;
use super::doubt;
use super::effects::Effect;
use super::knobs::{Knob, case_of};
use super::paste::to_paste;
use crate::pair::warnings::ColumnPressure;
use crate::study::{Effort, StudyError};
use gearmesh_specification::study::Case;

/// Combinations that are run after the knobs by themselves.
const MOST_COMBINATIONS: usize = 16;

/// Combinations that are looked at without being run.
const MOST_FORETOLD: usize = 200_000;

/// A setting that was run.
#[derive(Debug, Clone, PartialEq)]
pub struct Tried {
    /// Rung of each knob.
    pub rungs: Vec<usize>,
    /// Knob that alone stands lower than in the reference; none of the reference and of combinations.
    pub alone: Option<usize>,
    /// The time that settings are judged by \[s\].
    pub seconds: f64,
    /// All that it took.
    pub effort: Effort,
    /// Reducing its gears \[s\]: once, and not in the time.
    pub reduction_s: f64,
    /// Largest error of each column, relative to the reference.
    pub errors: Vec<f64>,
}

/// What an effect changes and takes.
#[derive(Debug, Clone, PartialEq)]
pub struct EffectFound {
    /// The effect.
    pub effect: Effect,
    /// What the scene took without it.
    pub without: Effort,
    /// What it took with it.
    pub with: Effort,
    /// Largest change of each column by the effect, relative to the scene without it.
    pub changes: Vec<f64>,
}

impl Tried {
    /// The largest error of all columns.
    #[must_use]
    pub fn error(&self) -> f64 {
        largest(&self.errors)
    }
}

/// What a user may want.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Goal {
    /// The cheapest setting within this error.
    Within(f64),
    /// The most exact setting that answers within this time \[s\].
    Interactive(f64),
}

/// The setting to take for a goal.
#[derive(Debug, Clone, PartialEq)]
pub struct Advice {
    /// The goal.
    pub goal: Goal,
    /// The setting, run once more.
    pub tried: Tried,
    /// Keys and values, a line each, to paste.
    pub toml: Vec<String>,
}

/// What was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Accuracy {
    /// What runs in the scene, as [`Bench::kind`].
    pub kind: String,
    /// Names of the columns.
    pub columns: Vec<String>,
    /// The knobs.
    pub knobs: Vec<Knob>,
    /// What was not varied, and why.
    pub left_out: Vec<String>,
    /// Everything that was run; the reference first.
    pub tried: Vec<Tried>,
    /// Settings that failed: what they are and why.
    pub failed: Vec<String>,
    /// What to take.
    pub advice: Vec<Advice>,
    /// What each effect changes and takes, in the scene as it is.
    pub effects: Vec<EffectFound>,
    /// The time that settings are judged by.
    pub time: JudgedTime,
    /// Of a chaotic run how far each column spreads over runs that begin next to each other, relative to their mean,
    /// which is the reference; else empty.
    pub spread: Vec<f64>,
    /// The reference's column with the largest pressure, where steel yields under it; also where it is not judged.
    pub yielding: Option<ColumnPressure>,
    /// Goals of which no setting can be said to be within them, for the reference itself may be further off.
    pub open: Vec<Goal>,
}

/// An answer that a user waits for without losing the thread \[s\].
const INTERACTIVE_S: f64 = 0.1;

/// A last step of the reference that changes the columns by more than this is too large.
const SETTLED: f64 = 0.01;

/// Runs a scene in all settings worth a look. `progress` gets what was run, and how many are known to come.
///
/// # Errors
/// [`StudyError`] for a scene whose reference cannot be run, and on a stop.
pub fn accuracy(
    bench: &Bench<'_>,
    progress: &dyn Fn(usize, usize),
) -> Result<Accuracy, StudyError> {
    let (mut knobs, left_out) = bench.knobs()?;
    let columns = bench.names();
    let mut reference = settled_reference(bench, &mut knobs)?;
    let spread = doubt::spread(bench, &knobs, &mut reference)?;
    let top = top_of(&knobs);
    let judge = |measured: &Measured| bench.errors(&measured.values, &reference.values);
    let mut found = Accuracy {
        kind: bench.kind(),
        tried: vec![tried(
            bench,
            top.clone(),
            None,
            (&reference, judge(&reference)),
        )],
        columns,
        left_out,
        failed: Vec::new(),
        advice: Vec::new(),
        effects: Vec::new(),
        time: bench.time(),
        knobs,
        spread,
        yielding: reference.yielding.clone(),
        open: Vec::new(),
    };
    let singles = one_lower(&found.knobs, &top);
    let count = singles.len() + MOST_COMBINATIONS;
    let mut done = 0;
    let mut attempt = |found: &mut Accuracy, (rungs, alone): (Vec<usize>, Option<usize>)| {
        stopped(bench)?;
        match bench.measure(&case_of(&found.knobs, &rungs)) {
            Ok(measured) => {
                let one = tried(bench, rungs, alone, (&measured, judge(&measured)));
                found.tried.push(one);
            }
            Err(error) => {
                stopped(bench)?;
                found
                    .failed
                    .push(format!("{}: {error}", words(&found.knobs, &rungs)));
            }
        }
        done += 1;
        progress(done, count);
        Ok::<(), StudyError>(())
    };
    for single in singles {
        attempt(&mut found, single)?;
    }
    for rungs in foretold_front(&found, &top) {
        attempt(&mut found, (rungs, None))?;
    }
    advise(bench, &mut found, &reference)?;
    add_effects(bench, &mut found)?;
    Ok(found)
}

/// Rungs of which one is lower than the top, and the number of its knob.
fn one_lower(knobs: &[Knob], top: &[usize]) -> Vec<(Vec<usize>, Option<usize>)> {
    let mut singles = Vec::new();
    for (number, knob) in knobs.iter().enumerate() {
        for rung in 0..knob.rungs.len() - 1 {
            let mut rungs = top.to_vec();
            rungs[number] = rung;
            singles.push((rungs, Some(number)));
        }
    }
    singles
}

/// Finds the cheapest setting for each goal among those that were tried.
fn advise(bench: &Bench<'_>, found: &mut Accuracy, reference: &Measured) -> Result<(), StudyError> {
    let doubts = found.doubts();
    for goal in [
        Goal::Within(0.01),
        Goal::Within(0.001),
        Goal::Interactive(INTERACTIVE_S),
    ] {
        if let Some(rungs) = choice(&found.tried, goal, &doubts) {
            // Once more, as the user will: what is reported is what it does.
            let measured = bench.measure(&case_of(&found.knobs, &rungs))?;
            let errors = bench.errors(&measured.values, &reference.values);
            found.advice.push(Advice {
                goal,
                toml: to_paste(&found.knobs, &rungs, &|table| bench.name_of(table)),
                tried: tried(bench, rungs, None, (&measured, errors)),
            });
        } else if let Goal::Within(_) = goal {
            found.open.push(goal);
        }
    }
    Ok(())
}

/// Runs the scene with each effect that it has not, and without each that it has.
fn add_effects(bench: &Bench<'_>, found: &mut Accuracy) -> Result<(), StudyError> {
    let (effects, left_out) = bench.effects();
    found.left_out.extend(left_out);
    if effects.is_empty() {
        return Ok(());
    }
    let as_it_is = bench.measure(&Case::default())?;
    for effect in effects {
        stopped(bench)?;
        match bench.measure(&effect.case) {
            Ok(other) => {
                let (without, with) = match effect.present {
                    true => (&other, &as_it_is),
                    false => (&as_it_is, &other),
                };
                found.effects.push(EffectFound {
                    changes: bench.errors(&with.values, &without.values),
                    without: without.effort,
                    with: with.effort,
                    effect,
                });
            }
            Err(error) => {
                stopped(bench)?;
                found.failed.push(format!("{}: {error}", effect.name));
            }
        }
    }
    Ok(())
}

pub(super) fn top_of(knobs: &[Knob]) -> Vec<usize> {
    knobs.iter().map(|knob| knob.rungs.len() - 1).collect()
}

/// The scene with every knob at its top. Knobs with further rungs get as many as it takes for the last step to change
/// the columns by less than [`SETTLED`].
fn settled_reference(bench: &Bench<'_>, knobs: &mut [Knob]) -> Result<Measured, StudyError> {
    let mut reference = bench.measure(&case_of(knobs, &top_of(knobs)))?;
    for number in 0..knobs.len() {
        if knobs[number].further.is_empty() || knobs[number].rungs.len() < 2 {
            continue;
        }
        let mut lower = top_of(knobs);
        lower[number] -= 1;
        stopped(bench)?;
        let mut below = bench.measure(&case_of(knobs, &lower))?;
        while largest(&bench.errors(&below.values, &reference.values)) > SETTLED
            && !knobs[number].further.is_empty()
        {
            stopped(bench)?;
            let rung = knobs[number].further.remove(0);
            knobs[number].rungs.push(rung);
            let higher = bench.measure(&case_of(knobs, &top_of(knobs)))?;
            below = std::mem::replace(&mut reference, higher);
        }
    }
    Ok(reference)
}

impl Accuracy {
    /// How far the reference itself may be off: of the knobs whose rungs are numbers (steps, slices, tolerances) the
    /// one whose last rung still changes the columns most, and by how much. None where there is no such knob.
    #[must_use]
    pub fn unsettled(&self) -> Option<(&Knob, f64)> {
        let is_number = |knob: &Knob| knob.rungs.iter().all(|r| r.label.parse::<f64>().is_ok());
        let last_step = |(number, knob): (usize, &'_ Knob)| {
            let below = knob.rungs.len().checked_sub(2)?;
            let single = |one: &&Tried| one.alone == Some(number) && one.rungs[number] == below;
            Some((number, self.tried.iter().find(single)?.error()))
        };
        let steps = self.knobs.iter().enumerate().filter(|(_, k)| is_number(k));
        let most = steps
            .filter_map(last_step)
            .max_by(|a, b| a.1.total_cmp(&b.1))?;
        Some((&self.knobs[most.0], most.1))
    }
}

fn stopped(bench: &Bench<'_>) -> Result<(), StudyError> {
    if bench.is_stopped() {
        return Err(StudyError::Stopped);
    }
    Ok(())
}

fn tried(
    bench: &Bench<'_>,
    rungs: Vec<usize>,
    alone: Option<usize>,
    (measured, errors): (&Measured, Vec<f64>),
) -> Tried {
    Tried {
        rungs,
        alone,
        seconds: bench.time().of(&measured.effort),
        effort: measured.effort,
        reduction_s: measured.reduction_s,
        errors,
    }
}

/// A setting in words: what differs from the reference.
#[must_use]
pub fn words(knobs: &[Knob], rungs: &[usize]) -> String {
    let lowered = knobs
        .iter()
        .zip(rungs)
        .filter(|(knob, rung)| **rung + 1 < knob.rungs.len());
    let words = lowered.map(|(knob, rung)| format!("{} = {}", knob.name, knob.rungs[*rung].label));
    let words: Vec<String> = words.collect();
    if words.is_empty() {
        return "reference".to_owned();
    }
    words.join(", ")
}

/// Combinations that may lie on the front of error against time, by errors that add up and times that multiply.
fn foretold_front(found: &Accuracy, top: &[usize]) -> Vec<Vec<usize>> {
    let reference = &found.tried[0];
    // Of each knob its rungs with error and share of the time; those that failed are left out.
    let effect = |knob: usize, rung: usize| {
        if rung == top[knob] {
            return Some((0.0, 1.0));
        }
        let single = found
            .tried
            .iter()
            .find(|one| one.alone == Some(knob) && one.rungs[knob] == rung);
        single.map(|one| (one.error(), one.seconds / reference.seconds))
    };
    // Rungs, error, share of the time.
    let mut all: Vec<(Vec<usize>, f64, f64)> = vec![(Vec::new(), 0.0, 1.0)];
    for (knob, last) in top.iter().enumerate() {
        let mut longer = Vec::new();
        for (rungs, error, share) in &all {
            for rung in 0..=*last {
                if let Some((more, faster)) = effect(knob, rung) {
                    let rungs = rungs.iter().copied().chain([rung]).collect();
                    longer.push((rungs, error + more, share * faster));
                }
            }
        }
        all = longer;
        if all.len() > MOST_FORETOLD {
            all = undominated(all);
        }
    }
    let front = undominated(all);
    let is_new = |rungs: &Vec<usize>| !found.tried.iter().any(|one| one.rungs == *rungs);
    let fresh: Vec<Vec<usize>> = front.into_iter().map(|one| one.0).filter(is_new).collect();
    let count = fresh.len().min(MOST_COMBINATIONS);
    // Evenly over the front.
    (0..count)
        .map(|k| {
            fresh[if count < 2 {
                0
            } else {
                k * (fresh.len() - 1) / (count - 1)
            }]
            .clone()
        })
        .collect()
}

fn undominated(mut all: Vec<(Vec<usize>, f64, f64)>) -> Vec<(Vec<usize>, f64, f64)> {
    all.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.2.total_cmp(&b.2)));
    let mut least = f64::INFINITY;
    all.retain(|one| {
        let better = one.2 < least;
        least = least.min(one.2);
        better
    });
    all
}

/// The measured setting that serves a goal best, the reference among them. Its error counts together with what the
/// reference itself may be off by, `doubts`; none where that alone is too much, and where none answers in time.
fn choice(tried: &[Tried], goal: Goal, doubts: &[f64]) -> Option<Vec<usize>> {
    let sound = || tried.iter();
    let is_within = |one: &&Tried, most: f64| {
        let mut both = one.errors.iter().zip(doubts);
        both.all(|(error, doubt)| error + doubt <= most)
    };
    let by = |a: f64, b: f64| a.total_cmp(&b);
    let best =
        match goal {
            Goal::Within(error) => (sound().filter(|one| is_within(one, error)))
                .min_by(|a, b| by(a.seconds, b.seconds)),
            Goal::Interactive(seconds) => (sound().filter(|one| one.seconds <= seconds))
                .min_by(|a, b| by(a.error(), b.error())),
        };
    best.map(|one| one.rungs.clone())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accuracy::Rung;

    fn setting(rungs: [usize; 2], alone: Option<usize>, seconds: f64, error: f64) -> Tried {
        Tried {
            rungs: rungs.into(),
            alone,
            seconds,
            effort: Effort::default(),
            reduction_s: 0.0,
            errors: vec![error],
        }
    }

    /// Two knobs of two rungs: lowered alone each saves time, so that both together are foretold to save more; a third
    /// that only costs is in no combination.
    #[test]
    fn combinations_are_those_that_may_pay() {
        let knob = |name: &str| Knob {
            name: name.to_owned(),
            rungs: ["low", "high"]
                .map(|label| Rung {
                    label: label.to_owned(),
                    settings: Vec::new(),
                })
                .into(),
            further: Vec::new(),
        };
        let mut found = Accuracy {
            kind: "pair at rest".to_owned(),
            columns: vec!["x".to_owned()],
            knobs: vec![knob("a"), knob("b")],
            left_out: Vec::new(),
            tried: vec![
                setting([1, 1], None, 8.0, 0.0),
                setting([0, 1], Some(0), 4.0, 0.01),
                setting([1, 0], Some(1), 2.0, 0.02),
            ],
            failed: Vec::new(),
            advice: Vec::new(),
            effects: Vec::new(),
            time: JudgedTime::Wall,
            spread: Vec::new(),
            yielding: None,
            open: Vec::new(),
        };
        assert_eq!(foretold_front(&found, &[1, 1]), [vec![0, 0]]);
        // What costs time and exactness is not worth a run.
        found.tried[1].seconds = 9.0;
        assert!(foretold_front(&found, &[1, 1]).is_empty());

        let tried = &found.tried;
        let choice = |goal: Goal, doubt: f64| choice(tried, goal, &[doubt]);
        assert_eq!(choice(Goal::Within(0.03), 0.0), Some(vec![1, 0]));
        assert_eq!(choice(Goal::Within(0.001), 0.0), Some(vec![1, 1]));
        assert_eq!(choice(Goal::Interactive(3.0), 0.0), Some(vec![1, 0]));
        assert_eq!(choice(Goal::Interactive(1.0), 0.0), None);
        // A reference that may be off by 2 % leaves 1 % of 3; by 4 %, nothing can be said.
        assert_eq!(choice(Goal::Within(0.03), 0.02), Some(vec![1, 1]));
        assert_eq!(choice(Goal::Within(0.03), 0.04), None);
    }
}
