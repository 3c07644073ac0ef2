//! The knobs of a multibody scene: solver, models of meshes and bearings, slices, paths, modes.
//!
//! Meshes and bearings of a kind go together: a gearbox has a knob for its meshes, not one for each.

use toml::{Table, Value};

use super::knobs::{Knob, LOCAL, PATHS, Rung, rounded};
use crate::study::BaseScene;

/// Damping that a bearing keeps in every model that has it.
const BEARING_DAMPING: [&str; 3] = [
    "radial_damping_N_s_per_mm",
    "axial_damping_N_s_per_mm",
    "tilt_damping_Nm_s_per_rad",
];

/// The knobs of a scene. What it refuses is left out later.
pub(super) fn of_system(base: &BaseScene) -> Vec<Knob> {
    let mut knobs = of_solver(base);
    knobs.extend(of_meshes(base));
    knobs.extend(bearing_models(base));
    for body in 0.. {
        if base.value(&format!("body.{body}.name")).is_none() {
            break;
        }
        let key = format!("body.{body}.modes_up_to_Hz");
        if let Some(own) = number(base, &key) {
            knobs.push(scaled(&key, own, &[0.25, 0.5, 1.0]));
        }
    }
    knobs
}

fn number(base: &BaseScene, key: &str) -> Option<f64> {
    match base.value(key)? {
        Value::Float(value) => Some(value),
        Value::Integer(value) => Some(value as f64),
        _ => None,
    }
}

fn scaled(key: &str, own: f64, factors: &[f64]) -> Knob {
    let values = factors.iter().map(|f| Value::Float(rounded(own * f)));
    Knob::of(key, values)
}

/// Step or tolerances, ρ∞, Newton's tolerance, how long a sweep settles.
fn of_solver(base: &BaseScene) -> Vec<Knob> {
    let mut knobs = Vec::new();
    if let Some(own) = number(base, "solver.step_s") {
        knobs.push(scaled("solver.step_s", own, &[4.0, 2.0, 1.0, 0.5, 0.25]));
    }
    if let Some(Value::Table(adaptive)) = base.value("solver.adaptive") {
        // All tolerances together.
        let tolerances: Vec<(String, f64)> = adaptive
            .iter()
            .filter(|(key, _)| key.contains("tolerance"))
            .filter_map(|(key, value)| Some((key.clone(), value.as_float()?)))
            .collect();
        if !tolerances.is_empty() {
            let rung = |factor: f64| Rung {
                label: format!("{factor} times"),
                settings: tolerances
                    .iter()
                    .map(|(key, own)| {
                        let key = format!("solver.adaptive.{key}");
                        (key, Value::Float(rounded(own * factor)))
                    })
                    .collect(),
            };
            knobs.push(Knob {
                name: "solver.adaptive tolerances".to_owned(),
                rungs: [100.0, 10.0, 1.0, 0.1].map(rung).into(),
                further: Vec::new(),
            });
        }
    }
    if base.value("solver").is_some() {
        // With finer steps it matters less and less: the reference keeps the scene's.
        let own = number(base, "solver.rho_infinity").unwrap_or(0.8);
        let mut others = vec![0.0, 0.5, 0.8, 0.95];
        others.retain(|rho| *rho != own);
        others.push(own);
        let others = others.into_iter().map(Value::Float);
        knobs.push(Knob::of("solver.rho_infinity", others));
        let tolerances = [1e-4, 1e-6, 1e-8].map(Value::Float);
        knobs.push(Knob::of("solver.newton_tolerance", tolerances));
    }
    if let Some(own) = number(base, "run.settle_s") {
        knobs.push(scaled("run.settle_s", own, &[0.25, 0.5, 1.0]));
    }
    knobs
}

/// Every rung of a knob of several tables: label, and what it sets in the table of a number.
fn together(name: &str, labels: &[&str], of: impl Fn(&str) -> Vec<(String, Value)>) -> Knob {
    let rung = |label: &&str| Rung {
        label: (*label).to_owned(),
        settings: of(label),
    };
    Knob {
        name: name.to_owned(),
        rungs: labels.iter().map(rung).collect(),
        further: Vec::new(),
    }
}

fn of_meshes(base: &BaseScene) -> Vec<Knob> {
    let mut hybrid: Vec<(usize, Table)> = Vec::new();
    let mut sliced: Vec<(usize, Option<i64>)> = Vec::new();
    let mut paths = Vec::new();
    for mesh in 0.. {
        let at = |key: &str| format!("gear_mesh.{mesh}.{key}");
        let Some(Value::Table(model)) = base.value(&at("model")) else {
            break;
        };
        let kind = model.get("kind").and_then(Value::as_str);
        let slices = model.get("slices").and_then(Value::as_integer);
        // Where a hybrid mesh states none, it has those of its models.
        if slices.is_some() || kind == Some("hybrid") {
            sliced.push((mesh, slices));
        }
        if kind != Some("kinematic") && base.value(&at("bevel_pair")).is_none() {
            paths.push(mesh);
        }
        if kind == Some("hybrid") {
            hybrid.push((mesh, model));
        }
    }
    let mut knobs = Vec::new();
    if !hybrid.is_empty() {
        let of = |label: &str| {
            let one = |(mesh, own): &(usize, Table)| {
                (
                    format!("gear_mesh.{mesh}.model"),
                    Value::Table(mesh_model(label, own)),
                )
            };
            hybrid.iter().map(one).collect()
        };
        let own = |model: &Table| {
            let local = model.get("local").and_then(Value::as_str);
            LOCAL.iter().position(|word| Some(*word) == local)
        };
        let top = hybrid.iter().filter_map(|(_, model)| own(model)).max();
        let mut labels = vec!["kinematic", "iso6336", "analytic"];
        labels.extend(&LOCAL[..=top.unwrap_or(2)]);
        knobs.push(together("gear_mesh.model", &labels, of));
    }
    if !sliced.is_empty() {
        let most = sliced.iter().filter_map(|(_, own)| *own).max();
        let mut labels: Vec<String> = [1, 3]
            .into_iter()
            .filter(|count| most.is_none_or(|most| *count < most))
            .map(|count| count.to_string())
            .collect();
        labels.push(most.map_or_else(|| "as it is".to_owned(), |most| most.to_string()));
        let labels: Vec<&str> = labels.iter().map(String::as_str).collect();
        let of = |label: &str| {
            let count: Option<i64> = label.parse().ok();
            let one = |(mesh, own): &(usize, Option<i64>)| {
                let key = format!("gear_mesh.{mesh}.model.slices");
                let count = count?.min(own.unwrap_or(i64::MAX));
                // The most of some meshes is more than others state.
                (own.is_some() || Some(count) != most).then_some((key, Value::Integer(count)))
            };
            sliced.iter().filter_map(one).collect()
        };
        knobs.push(together("gear_mesh.model.slices", &labels, of));
    }
    if !paths.is_empty() {
        let of = |label: &str| {
            let word = Value::String(label.to_owned());
            let one = |mesh: &usize| (format!("gear_mesh.{mesh}.teeth.path"), word.clone());
            paths.iter().map(one).collect()
        };
        knobs.push(together("gear_mesh.teeth.path", &PATHS, of));
    }
    knobs
}

/// A cheaper model in the place of a hybrid one: kind, or the local term of a hybrid one.
fn mesh_model(label: &str, own: &Table) -> Table {
    if LOCAL.contains(&label) {
        let mut model = own.clone();
        model.insert("local".to_owned(), Value::String(label.to_owned()));
        return model;
    }
    let mut model = Table::new();
    model.insert("kind".to_owned(), Value::String(label.to_owned()));
    if label != "kinematic" {
        for key in ["damping", "slices"] {
            if let Some(value) = own.get(key) {
                model.insert(key.to_owned(), value.clone());
            }
        }
    }
    model
}

/// Models of bearings that name a bearing file, all together.
fn bearing_models(base: &BaseScene) -> Option<Knob> {
    const KINDS: [&str; 3] = ["linear", "quasi-static", "dynamic"];
    let mut found: Vec<(usize, Table, usize)> = Vec::new();
    for bearing in 0.. {
        let Some(Value::Table(model)) = base.value(&format!("bearing.{bearing}.model")) else {
            break;
        };
        let kind = model.get("kind").and_then(Value::as_str);
        let top = KINDS.iter().position(|word| Some(*word) == kind);
        if let (Some(top), true) = (top, model.contains_key("file")) {
            found.push((bearing, model, top));
        }
    }
    let top = found.iter().map(|(_, _, top)| *top).max()?;
    let of = |label: &str| {
        let rung = KINDS.iter().position(|word| *word == label);
        let one = |(bearing, own, top): &(usize, Table, usize)| {
            let model = match rung < Some(*top) {
                true => bearing_model(label, own),
                false => own.clone(),
            };
            (format!("bearing.{bearing}.model"), Value::Table(model))
        };
        found.iter().map(one).collect()
    };
    Some(together("bearing.model", &KINDS[..=top], of))
}

fn bearing_model(label: &str, own: &Table) -> Table {
    let mut model = Table::new();
    model.insert("kind".to_owned(), Value::String(label.to_owned()));
    let file = if label == "linear" {
        "tangent_of"
    } else {
        "file"
    };
    if let Some(name) = own.get("file") {
        model.insert(file.to_owned(), name.clone());
    }
    for key in BEARING_DAMPING {
        if let Some(value) = own.get(key) {
            model.insert(key.to_owned(), value.clone());
        }
    }
    model
}
