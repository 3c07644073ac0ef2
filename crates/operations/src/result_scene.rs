//! The scene inside a pair's result, with its models.

use crate::failure::{Failure, Result};
use gearmesh_geometry::input::InputDocument;
use gearmesh_scene::{LoadedScene, Scene, SceneResult, load};
use std::path::Path;

/// The scene of a result, with its models; their paths are those of the run.
pub fn scene_of(result: &SceneResult, path: &Path) -> Result<LoadedScene> {
    let document = InputDocument::new(
        format!("scene inside {}", path.display()),
        result.source.scene_toml.clone(),
    );
    let mut scene = Scene::from_document(document, Path::new(""))?.with_known_forces();
    for (gear, file) in scene.gears.iter_mut().zip(&result.source.model_files) {
        gear.model = file.into();
    }
    let mut loaded = load(scene.clone())?;
    if scene.path_by_default && !loaded.has_lines_of(result) {
        // Written when the rigid path was the default.
        scene.edge_radius_m = None;
        loaded = load(scene)?;
    }
    if !loaded.has_lines_of(result) {
        return Err(Failure::input(format!(
            "the scene inside {} does not give its contact lines; run the scene again",
            path.display()
        )));
    }
    for (k, model) in loaded.models.iter().enumerate() {
        if model.input != result.source.gears[k] {
            return Err(Failure::input(format!(
                "{} has been made again from another gear file since {} was computed; run the scene again",
                result.source.model_files[k],
                path.display()
            )));
        }
    }
    Ok(loaded)
}
