//! Scenes for the tests of multibody scene files.
#![allow(clippy::unwrap_used, clippy::expect_used, dead_code, missing_docs)]

use std::path::{Path, PathBuf};

use gearmesh_dynamics::elements::Channel;
use gearmesh_dynamics::{State, System};
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::InputDocument;
use gearmesh_scene::system::{BuiltSystem, LoadedSystem, SystemPlan, SystemScene};
use gearmesh_scene::system_run::RunCost;

/// The folder of the shipped scenes.
pub fn fe_models() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fe_models")
}

pub fn text(name: &str) -> String {
    std::fs::read_to_string(fe_models().join(name)).unwrap()
}

/// Reads a scene in a folder, and the gears that it names.
pub fn load(text: &str, folder: &Path) -> Result<LoadedSystem, InputError> {
    let document = InputDocument::new("scene.toml", text);
    SystemScene::from_document(document, folder)?.load()
}

/// Reads and builds a scene in a folder, by default that of the shipped ones.
pub fn build_in(text: &str, folder: &Path) -> Result<BuiltSystem, InputError> {
    load(text, folder)?.build()
}

/// Reads, builds and plans a scene in the folder of the shipped ones, with the trials that tell its cost.
pub fn plan(text: &str) -> Result<SystemPlan, InputError> {
    let loaded = load(text, &fe_models())?;
    let plan = SystemPlan::new(&loaded.scene, loaded.build()?)?;
    Ok(plan.with_cost(&loaded.scene, RunCost::timed(&loaded)?))
}

pub fn build(text: &str) -> Result<BuiltSystem, InputError> {
    build_in(text, &fe_models())
}

/// `text` with `from`, which must be there once, replaced.
pub fn changed(text: &str, from: &str, to: &str) -> String {
    assert_eq!(text.matches(from).count(), 1, "`{from}` in {text}");
    text.replacen(from, to, 1)
}

/// Line of the first place of a text, from 1.
pub fn line_of(text: &str, part: &str) -> usize {
    let place = text
        .find(part)
        .unwrap_or_else(|| panic!("`{part}` is not in {text}"));
    text[..place].matches('\n').count() + 1
}

/// What the elements of a system write at a motion.
pub struct Outputs {
    channels: Vec<(String, Channel)>,
    values: Vec<f64>,
}

impl Outputs {
    pub fn at(system: &mut System, state: &State) -> Self {
        let channels = system.channels();
        let of = |name: &str| channels.iter().filter(|(of, _)| of == name).count();
        let counts: Vec<usize> = system.elements().map(of).collect();
        let mut values = vec![0.0; channels.len()];
        system.sample(state, &counts, &mut values);
        Self { channels, values }
    }

    pub fn value(&self, element: &str, channel: &str) -> f64 {
        self.get(element, channel).unwrap()
    }

    pub fn get(&self, element: &str, channel: &str) -> Option<f64> {
        let is_it = |(of, one): &(String, Channel)| of == element && one.name == channel;
        let place = self.channels.iter().position(is_it)?;
        Some(self.values[place])
    }
}
