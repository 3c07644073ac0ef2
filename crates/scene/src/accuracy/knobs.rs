//! The knobs of a scene: keys that trade accuracy for time, with the rungs between.

use std::ops::RangeInclusive;

use gearmesh_bevel::PairFile;
use gearmesh_specification::study::{Case, Setting};
use toml::Value;

use crate::pair::LoadedScene;

/// A place of a knob.
#[derive(Debug, Clone, PartialEq)]
pub struct Rung {
    /// In words.
    pub label: String,
    /// Keys and their values; none leaves the scene as it is.
    pub settings: Vec<(String, Value)>,
}

/// A knob: rungs from the cheapest to the one that the reference has.
#[derive(Debug, Clone, PartialEq)]
pub struct Knob {
    /// Name in tables: its key.
    pub name: String,
    /// The rungs; the last is the reference's.
    pub rungs: Vec<Rung>,
    /// Rungs beyond, which the reference takes as long as its last step still changes the columns too much.
    pub further: Vec<Rung>,
}

impl Knob {
    /// A knob of one key.
    pub(super) fn of(key: &str, values: impl IntoIterator<Item = Value>) -> Self {
        Self {
            name: key.to_owned(),
            rungs: values.into_iter().map(|value| rung(key, value)).collect(),
            further: Vec::new(),
        }
    }

    /// The same with rungs beyond.
    fn and_further(mut self, values: impl IntoIterator<Item = Value>) -> Self {
        let beyond = values.into_iter().map(|value| rung(&self.name, value));
        self.further = beyond.collect();
        self
    }
}

/// A rung of one key.
fn rung(key: &str, value: Value) -> Rung {
    Rung {
        label: value.to_string().trim_matches('"').to_owned(),
        settings: vec![(key.to_owned(), value)],
    }
}

/// The settings of a choice of rungs, as a case of a study.
#[must_use]
pub(super) fn case_of(knobs: &[Knob], rungs: &[usize]) -> Case {
    let chosen = knobs.iter().zip(rungs);
    case_with(chosen.flat_map(|(knob, rung)| &knob.rungs[*rung].settings))
}

/// A rung by itself, as a case of a study.
#[must_use]
pub(super) fn case_of_rung(rung: &Rung) -> Case {
    case_with(&rung.settings)
}

fn case_with<'a>(settings: impl IntoIterator<Item = &'a (String, Value)>) -> Case {
    let setting = |(key, value): &(String, Value)| Setting::of(key, value.clone());
    Case::of(settings.into_iter().map(setting).collect())
}

/// Local terms of a hybrid mesh, cheapest first.
pub(super) const LOCAL: [&str; 3] = ["none", "weber-banaschek", "calibrated"];
pub(super) const PATHS: [&str; 2] = ["line-of-action", "extended"];

fn words(words: &[&str]) -> Vec<Value> {
    words
        .iter()
        .map(|word| Value::String((*word).to_owned()))
        .collect()
}

/// Knobs of a gear pair at rest. What the scene refuses is left out later.
pub(super) fn of_pair(loaded: &LoadedScene) -> Vec<Knob> {
    let calibrated = loaded.models.iter().all(|model| model.near_field.is_some());
    let local = if calibrated { &LOCAL[..] } else { &LOCAL[..2] };
    let coarser = loaded
        .models
        .iter()
        .map(|model| model.grid.slices)
        .min()
        .unwrap_or(1);
    let mut slices = vec![1, 3, loaded.layout.slices, coarser, 2 * coarser];
    slices.sort_unstable();
    slices.dedup();
    let own = loaded.scene.points_per_pitch;
    let mut points = vec![own / 4, own / 2, own, 2 * own, 4 * own];
    points.retain(|count| *count >= 4);
    // Peaks between two positions are missed: they ask for many.
    let further = [8, 16, 32, 64].map(|times| own * times);
    let count = |count: usize| Value::Integer(count as i64);
    let mut knobs = vec![
        Knob::of("mesh.model.local", words(local)),
        Knob::of("mesh.model.slices", slices.into_iter().map(count)),
        Knob::of("run.points_per_pitch", points.into_iter().map(count))
            .and_further(further.map(count)),
    ];
    if !loaded.lines.pair.is_helical() {
        knobs.push(Knob::of("mesh.teeth.path", words(&PATHS)));
    }
    knobs
}

/// Knobs of the tooth contact analysis of a bevel pair, and of its contact under load.
pub(super) fn of_bevel(file: &PairFile) -> Vec<Knob> {
    let allowed = |counts: &[usize], range: RangeInclusive<usize>| {
        let allowed = counts.iter().filter(|count| range.contains(*count));
        let values = allowed.map(|count| Value::Integer(*count as i64));
        values.collect::<Vec<_>>()
    };
    let positions = |key: &str, own: usize, range: RangeInclusive<usize>| {
        let counts = [own / 4, own / 2, own, 2 * own];
        let further = [4, 8, 16].map(|times| own * times);
        Knob::of(key, allowed(&counts, range.clone())).and_further(allowed(&further, range))
    };
    let own = file.tca.per_pitch;
    let mut knobs = vec![positions("tca.positions_per_pitch", own, 8..=1000)];
    if let Some(load) = &file.load {
        knobs.push(positions(
            "load.positions_per_pitch",
            load.positions,
            4..=500,
        ));
        // Models allow no more than their own, and half spaces are cut off in slices that are too short: none finer
        // than stated.
        if let Some(own) = load.slices {
            let counts = [own / 4, own / 2, own];
            knobs.push(Knob::of("load.slices", allowed(&counts, 3..=100)));
        }
    }
    knobs
}

/// To six digits: a step is read by people.
pub(super) fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}
