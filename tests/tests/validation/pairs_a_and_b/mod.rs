//! Pairs A and B of seed 004 (docs/sources.md) as `cargo xtask demo` runs them: against the records that were computed
//! independently (`reference/pair_a`, `reference/pair_b`), in time at 10 rpm against rest, and against the figures that
//! docs/demo.md prints.
//!
//! A record's jumps where pairs come and go make its figures those of its own positions, so ours are computed at the
//! same ones, 48 a pitch. Bounds are what both sides state: our mesh error and the record's uncertainty.

mod in_time;
mod pages;
mod records;

use gearmesh_geometry::GearDefinition;
use gearmesh_geometry::input::InputDocument;
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_model::write_reduced_gear;
use gearmesh_reduction::{ReductionOptions, Silent, reduce};
use gearmesh_scene::{LoadedScene, Scene, SceneResult, load, run};
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// Teeth of all three gears.
const TEETH: usize = 57;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Folder with the models of gears 1, 2 and 3 as their files are, with estimates of their errors.
fn models() -> &'static Path {
    static FOLDER: OnceLock<tempfile::TempDir> = OnceLock::new();
    FOLDER
        .get_or_init(|| {
            let folder = tempfile::tempdir().unwrap();
            let python = PythonEnvironment::find().unwrap();
            for name in ["gear1", "gear2", "gear3"] {
                let file = root().join(format!("fe_models/{name}.toml"));
                let text = std::fs::read_to_string(file).unwrap();
                let document = InputDocument::new(format!("{name}.toml"), text);
                let gear = GearDefinition::from_document(&document).unwrap();
                let options = ReductionOptions {
                    estimate_error: true,
                };
                let (model, _) = reduce(&gear, &python, options, &Silent).unwrap();
                write_reduced_gear(&folder.path().join(format!("{name}.h5")), &model).unwrap();
            }
            folder
        })
        .path()
}

/// A file of `fe_models` with the models of this test, and `changes` of its text.
fn document(name: &str, changes: &[(&str, &str)]) -> InputDocument {
    let file = root().join(format!("fe_models/{name}.toml"));
    let mut text = std::fs::read_to_string(file).unwrap();
    for (from, to) in [("../out/demo/", "")].iter().chain(changes) {
        assert!(text.contains(from), "{name}.toml has no `{from}`");
        text = text.replace(from, to);
    }
    InputDocument::new(format!("{name}.toml"), text)
}

fn pair(name: &str, changes: &[(&str, &str)]) -> (LoadedScene, SceneResult) {
    let loaded = load(Scene::from_document(document(name, changes), models()).unwrap()).unwrap();
    let result = run(&loaded, &|_, _| ()).unwrap();
    (loaded, result)
}

/// Amplitude of an order of even positions over whole revolutions.
fn amplitude(values: &[f64], order: usize) -> f64 {
    let turn = |k: usize| TAU * (order * k % values.len()) as f64 / values.len() as f64;
    let sum = |part: fn(f64) -> f64| -> f64 {
        let terms = values.iter().enumerate().map(|(k, x)| x * part(turn(k)));
        terms.sum()
    };
    2.0 / values.len() as f64 * sum(f64::cos).hypot(sum(f64::sin))
}

fn swing(values: &[f64]) -> f64 {
    let ends = values
        .iter()
        .fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(*x), b.max(*x)));
    ends.1 - ends.0
}
