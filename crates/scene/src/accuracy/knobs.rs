//! The knobs of a scene: keys that trade accuracy for time, with the rungs between.

use toml::Value;

use crate::pair::LoadedScene;
use crate::study::{BaseScene, Case, Setting};

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
}

impl Knob {
    /// A knob of one key.
    fn of(key: &str, values: impl IntoIterator<Item = Value>) -> Self {
        let rung = |value: Value| Rung {
            label: value.to_string().trim_matches('"').to_owned(),
            settings: vec![(key.to_owned(), value)],
        };
        Self {
            name: key.to_owned(),
            rungs: values.into_iter().map(rung).collect(),
        }
    }
}

/// The settings of a choice of rungs, as a case of a study.
#[must_use]
pub(super) fn case_of(knobs: &[Knob], rungs: &[usize]) -> Case {
    let chosen = knobs
        .iter()
        .zip(rungs)
        .flat_map(|(knob, rung)| &knob.rungs[*rung].settings);
    let setting = |(key, value): &(String, Value)| Setting {
        parameter: key.clone(),
        keys: vec![key.clone()],
        value: value.clone(),
    };
    Case {
        settings: chosen.map(setting).collect(),
    }
}

/// Local terms of a hybrid mesh, cheapest first.
const LOCAL: [&str; 3] = ["none", "weber-banaschek", "calibrated"];
const PATHS: [&str; 2] = ["line-of-action", "extended"];

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
    let mut points = vec![own / 4, own / 2, own, 2 * own];
    points.retain(|count| *count >= 4);
    let count = |count: usize| Value::Integer(count as i64);
    let mut knobs = vec![
        Knob::of("mesh.model.local", words(local)),
        Knob::of("mesh.model.slices", slices.into_iter().map(count)),
        Knob::of("run.points_per_pitch", points.into_iter().map(count)),
    ];
    if !loaded.lines.pair.is_helical() {
        knobs.push(Knob::of("mesh.teeth.path", words(&PATHS)));
    }
    knobs
}

/// Knobs of a multibody scene.
pub(super) fn of_system(base: &BaseScene) -> Vec<Knob> {
    let mut knobs = Vec::new();
    let number = |key: &str| match base.value(key)? {
        Value::Float(value) => Some(value),
        Value::Integer(value) => Some(value as f64),
        _ => None,
    };
    let scaled = |key: &str, own: f64, factors: &[f64]| {
        Knob::of(
            key,
            factors
                .iter()
                .map(|factor| Value::Float(rounded(own * factor))),
        )
    };
    if let Some(step) = number("solver.step_s") {
        knobs.push(scaled("solver.step_s", step, &[4.0, 2.0, 1.0, 0.5, 0.25]));
    }
    let tolerances = ["translation_tolerance_um", "rotation_tolerance_urad"]
        .map(|key| format!("solver.adaptive.{key}"));
    if let [Some(translation), Some(rotation)] = [number(&tolerances[0]), number(&tolerances[1])] {
        let rung = |factor: f64| Rung {
            label: format!("{factor} times"),
            settings: vec![
                (
                    tolerances[0].clone(),
                    Value::Float(rounded(translation * factor)),
                ),
                (
                    tolerances[1].clone(),
                    Value::Float(rounded(rotation * factor)),
                ),
            ],
        };
        knobs.push(Knob {
            name: "solver.adaptive tolerances".to_owned(),
            rungs: [100.0, 10.0, 1.0, 0.1].map(rung).into(),
        });
    }
    if base.value("solver").is_some() {
        // With finer steps it matters less and less: the reference keeps the scene's.
        let own = number("solver.rho_infinity").unwrap_or(0.8);
        let mut others = vec![0.0, 0.5, 0.8, 0.95];
        others.retain(|rho| *rho != own);
        others.push(own);
        knobs.push(Knob::of(
            "solver.rho_infinity",
            others.into_iter().map(Value::Float),
        ));
        let tolerances = [1e-4, 1e-6, 1e-8].map(Value::Float);
        knobs.push(Knob::of("solver.newton_tolerance", tolerances));
    }
    for mesh in 0.. {
        let at = |key: &str| format!("gear_mesh.{mesh}.{key}");
        let Some(Value::Table(model)) = base.value(&at("model")) else {
            break;
        };
        let kind = model
            .get("kind")
            .and_then(Value::as_str)
            .unwrap_or_default();
        if kind == "hybrid" {
            let own = model
                .get("local")
                .and_then(Value::as_str)
                .unwrap_or("calibrated");
            let top = LOCAL.iter().position(|word| *word == own).unwrap_or(2);
            knobs.push(Knob::of(&at("model.local"), words(&LOCAL[..=top])));
        }
        if let Some(own) = number(&at("model.slices")) {
            let mut counts = vec![1, 3, own as i64];
            counts.retain(|count| *count <= own as i64);
            counts.dedup();
            knobs.push(Knob::of(
                &at("model.slices"),
                counts.into_iter().map(Value::Integer),
            ));
        }
        if kind != "kinematic" && base.value(&at("bevel_pair")).is_none() {
            knobs.push(Knob::of(&at("teeth.path"), words(&PATHS)));
        }
    }
    for body in 0.. {
        if base.value(&format!("body.{body}.name")).is_none() {
            break;
        }
        let key = format!("body.{body}.modes_up_to_Hz");
        if let Some(own) = number(&key) {
            knobs.push(scaled(&key, own, &[0.25, 0.5, 1.0]));
        }
    }
    knobs
}

/// To six digits: a step is read by people.
fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}
