//! The text of a gear file inside a model or a result is provenance: what is in it changes nothing.

use std::path::Path;

use gearmesh_geometry::input::InputDocument;
use gearmesh_model::{DataTree, FileFormat, REDUCED_GEAR_FORMAT};
use gearmesh_scene::{RESULT_FORMAT, Scene, SceneResult};

use crate::common::load;
use crate::made_up_gears::drilled_pair;

const RUBBISH: &str = "]] tooth = { number_of_teeth: many ";

fn pair_result(folder: &Path) -> SceneResult {
    let run = "pitches = 1\npoints_per_pitch = 4";
    let text = drilled_pair::scene("drilled", run, "[gauges]\ngear_2 = [\"g0\"]\n");
    let scene = Scene::from_document(InputDocument::new("pair.toml", text), folder).unwrap();
    let loaded = gearmesh_scene::load(scene).unwrap();
    let mut result = gearmesh_scene::run(&loaded, &|_, _| ()).unwrap();
    result.source.created_utc.clear();
    result.solution.seconds = [0.0; 2];
    result
}

/// Replaces texts of a file and seals it again.
fn spoil(path: &Path, format: &FileFormat, names: &[&str]) {
    let mut tree = DataTree::read(path, format).unwrap();
    for name in names {
        let text = tree.texts.get_mut(*name).unwrap();
        RUBBISH.clone_into(text);
    }
    tree.write(path, format).unwrap();
}

#[test]
fn models_and_results_need_no_text() {
    let folder = tempfile::tempdir().unwrap();
    drilled_pair::write_models(folder.path());
    let sound = pair_result(folder.path());
    for name in ["pinion", "wheel", "drilled"] {
        let path = folder.path().join(format!("{name}.h5"));
        spoil(&path, &REDUCED_GEAR_FORMAT, &["gear/input_toml"]);
    }
    let spoiled = pair_result(folder.path());
    let definition = |result: &SceneResult, gear: usize| {
        let mut definition = result.source.gears[gear].definition().unwrap().clone();
        definition.source.clear();
        definition
    };
    for gear in 0..2 {
        assert_eq!(spoiled.source.gears[gear].text, RUBBISH);
        assert_eq!(definition(&spoiled, gear), definition(&sound, gear));
    }
    let mut same = spoiled.clone();
    same.source.gears = sound.source.gears.clone();
    assert_eq!(same, sound);

    let scene = drilled_pair::scene_in_time(1e-3);
    load(&scene, folder.path()).unwrap();

    let path = folder.path().join("pair_result.h5");
    sound.write(&path).unwrap();
    spoil(&path, &RESULT_FORMAT, &["gear_1_toml", "gear_2_toml"]);
    let read = SceneResult::read(&path).unwrap();
    assert_eq!(definition(&read, 1), definition(&sound, 1));
    // Six holes on 47 teeth: known without the text.
    assert_eq!(read.contact_coverage, sound.contact_coverage);
    assert!(read.contact_coverage.period_pitches > 1);
}

/// A file from before definitions were stored is known by its text only, and says so where that means nothing.
#[test]
fn older_models_are_known_by_their_text() {
    let folder = tempfile::tempdir().unwrap();
    drilled_pair::write_models(folder.path());
    let older = FileFormat {
        version: 4,
        ..REDUCED_GEAR_FORMAT
    };
    let path = folder.path().join("drilled.h5");
    let sound = pair_result(folder.path());
    let mut tree = DataTree::read(&path, &REDUCED_GEAR_FORMAT).unwrap();
    tree.arrays
        .retain(|name, _| !name.starts_with("definition/"));
    tree.texts
        .retain(|name, _| !name.starts_with("definition/"));
    tree.write(&path, &older).unwrap();
    assert_eq!(pair_result(folder.path()), sound);

    tree.put_text("gear/input_toml", RUBBISH);
    tree.write(&path, &older).unwrap();
    let text = drilled_pair::scene("drilled", "pitches = 1\npoints_per_pitch = 4", "");
    let document = InputDocument::new("pair.toml", text);
    let scene = Scene::from_document(document, folder.path()).unwrap();
    let message = gearmesh_scene::load(scene).unwrap_err().to_string();
    assert!(
        message.contains("gear file inside") && message.contains("drilled.h5"),
        "{message}"
    );
}
