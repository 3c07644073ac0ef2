//! The effects of a scene: what it names and could do without, and friction, which it may leave out.

use gearmesh_specification::study::{Case, Setting};
use toml::Value;

use crate::study::BaseScene;

/// An effect that is put off, or on.
#[derive(Debug, Clone, PartialEq)]
pub struct Effect {
    /// Its key, or keys of several tables as one.
    pub name: String,
    /// Whether the scene has it; the case then puts it off, otherwise on.
    pub present: bool,
    /// The scene without it, or with it.
    pub case: Case,
}

/// What a table of the list may have and could do without.
const OF_TABLES: [(&str, &[&str]); 5] = [
    (
        "gear_mesh",
        &[
            "teeth.friction",
            "teeth.errors_1",
            "teeth.errors_2",
            "teeth.eccentricity_1",
            "teeth.eccentricity_2",
            "model.damping",
            "model.cracks_1",
            "model.cracks_2",
        ],
    ),
    ("body", &["microgeometry"]),
    (
        "bearing",
        &[
            "housing",
            "model.traction",
            "model.rebound",
            "model.cage",
            "model.surface",
        ],
    ),
    ("spring", &["damping_N_s_per_mm"]),
    ("torsion_spring", &["damping_Nm_s_per_rad"]),
];

/// What stands at the top of a scene and could be left out.
const AT_TOP: [&str; 11] = [
    "mesh.teeth.friction",
    "mesh.teeth.errors_1",
    "mesh.teeth.errors_2",
    "mesh.teeth.eccentricity_1",
    "mesh.teeth.eccentricity_2",
    "gear_1.microgeometry",
    "gear_2.microgeometry",
    "pair.deviation_mrad",
    "pair.inclination_mrad",
    "gravity_m_per_s2",
    "gauge",
];

/// The effects of a scene; those whose lack it refuses are left out later.
pub(super) fn of_scene(base: &BaseScene) -> Vec<Effect> {
    let mut found = Vec::new();
    let off = |name: &str, removed: Vec<String>| Effect {
        name: name.to_owned(),
        present: true,
        case: Case {
            removed,
            ..Case::default()
        },
    };
    for key in AT_TOP.into_iter().chain(["gauges", "rating"]) {
        if base.value(key).is_some() {
            found.push(off(key, vec![key.to_owned()]));
        }
    }
    for (list, keys) in OF_TABLES {
        for key in keys {
            let there = stated(base, list, key);
            if !there.is_empty() {
                found.push(off(&format!("{list}.{key}"), there));
            }
        }
    }
    found.extend(replaced(base, "body", "flexibility", &["reduced", "rigid"]));
    found.extend(rigid_shafts(base));
    found.extend(friction(base));
    found
}

/// The tables of a list that the scene has.
fn tables<'a>(base: &'a BaseScene, list: &'a str) -> impl Iterator<Item = String> + 'a {
    let name = move |number: usize| format!("{list}.{number}");
    (0..)
        .map(name)
        .take_while(move |table| base.value(table).is_some())
}

/// A key of all tables of a list that state it.
fn stated(base: &BaseScene, list: &str, key: &str) -> Vec<String> {
    let all = tables(base, list).map(|table| format!("{table}.{key}"));
    all.filter(|whole| base.value(whole).is_some()).collect()
}

/// An effect that a value at some keys takes away, or brings.
fn set(present: bool, name: String, keys: Vec<String>, value: Value) -> Effect {
    let setting = Setting {
        parameter: name.clone(),
        keys,
        value,
    };
    Effect {
        present,
        case: Case::of(vec![setting]),
        name,
    }
}

/// A word that is taken down, of all tables of a list that have it higher.
fn replaced(base: &BaseScene, list: &str, key: &str, words: &[&str]) -> Vec<Effect> {
    let higher = |keys: &mut Vec<String>, word: &str| {
        keys.retain(|key| base.value(key) != Some(Value::String(word.to_owned())));
    };
    let mut keys = stated(base, list, key);
    let mut effects = Vec::new();
    for word in words {
        higher(&mut keys, word);
        if keys.is_empty() {
            continue;
        }
        let value = Value::String((*word).to_owned());
        let name = format!("{list}.{key} above \"{word}\"");
        effects.push(set(true, name, keys.clone(), value));
    }
    effects
}

/// Beams of shafts, all of them rigid instead.
fn rigid_shafts(base: &BaseScene) -> Option<Effect> {
    let beams: Vec<String> = tables(base, "shaft")
        .filter(|table| {
            base.value(&format!("{table}.model.kind")) == Some(Value::String("beam".to_owned()))
        })
        .map(|table| format!("{table}.model"))
        .collect();
    let rigid = [("kind".to_owned(), Value::String("rigid".to_owned()))];
    let name = "shaft.model of kind \"beam\"".to_owned();
    let rigid = Value::Table(rigid.into_iter().collect());
    (!beams.is_empty()).then(|| set(true, name, beams, rigid))
}

/// Friction of teeth where the scene has none, with a coefficient that lubricated gears have.
fn friction(base: &BaseScene) -> Option<Effect> {
    let model = [
        ("model".to_owned(), Value::String("coulomb".to_owned())),
        ("dynamic_coefficient".to_owned(), Value::Float(0.05)),
    ];
    let mut keys: Vec<String> = tables(base, "gear_mesh")
        .map(|table| format!("{table}.teeth.friction"))
        .collect();
    if base.value("pair").is_some() {
        keys.push("mesh.teeth.friction".to_owned());
    }
    if keys.is_empty() || keys.iter().any(|key| base.value(key).is_some()) {
        return None;
    }
    let name = "friction of teeth, coulomb, 0.05".to_owned();
    let model = Value::Table(model.into_iter().collect());
    Some(set(false, name, keys, model))
}
