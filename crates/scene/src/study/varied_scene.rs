//! A scene with some of its keys changed.

use std::path::Path;

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::InputDocument;

use super::study_file::{Case, Study};
use crate::former_forms::SYSTEM;
use crate::system::SystemScene;

/// The scene of a case. A key must stand in the scene already, and its new value must be of the same kind: a study
/// varies what a scene says. Keys may have the form of earlier versions.
///
/// # Errors
/// [`InputError`] of the study for a key that the scene does not have, of the scene for a value that it refuses.
pub fn varied(
    study: &Study,
    scene: &InputDocument,
    case: &Case,
    folder: &Path,
) -> Result<SystemScene, InputError> {
    let scene = scene.clone().with_former(SYSTEM);
    let given: toml::Value = scene.glance()?;
    let mut root = given.clone();
    for setting in &case.settings {
        for key in &setting.keys {
            let place = find(&mut root, &scene.present_path(key))
                .map_err(|problem| complaint(study, &setting.parameter, key, problem))?;
            let numbers = |value: &toml::Value| value.is_float() || value.is_integer();
            let alike =
                place.same_type(&setting.value) || numbers(place) && numbers(&setting.value);
            if !alike {
                let problem = format!(
                    "is {} in the scene and cannot be {}",
                    place.type_str(),
                    setting.value.type_str()
                );
                return Err(complaint(study, &setting.parameter, key, problem));
            }
            *place = setting.value.clone();
        }
    }
    if root == given {
        return SystemScene::from_document(scene, folder);
    }
    let text = toml::to_string(&root).map_err(|error| scene.error("", error))?;
    let name = format!("{} with {}", scene.file, case.name());
    SystemScene::from_document(InputDocument::new(name, text), folder)
}

fn complaint(study: &Study, parameter: &str, key: &str, problem: String) -> InputError {
    let number = study
        .tables
        .parameter
        .iter()
        .position(|p| p.name == parameter);
    let at = format!("parameter.{}.keys", number.unwrap_or_default());
    study.document.error(&at, format!("`{key}` {problem}"))
}

/// The value at a dotted path.
fn find<'a>(root: &'a mut toml::Value, key: &str) -> Result<&'a mut toml::Value, String> {
    let mut place = root;
    let mut walked = String::new();
    for part in key.split('.') {
        let offers = match &*place {
            toml::Value::Table(table) => table.keys().cloned().collect::<Vec<_>>().join(", "),
            toml::Value::Array(items) => format!("items 0 to {}", items.len().saturating_sub(1)),
            _ => "nothing below it".to_owned(),
        };
        let next = match place {
            toml::Value::Table(table) => table.get_mut(part),
            toml::Value::Array(items) => part.parse().ok().and_then(|i: usize| items.get_mut(i)),
            _ => None,
        };
        let Some(next) = next else {
            let there = if walked.is_empty() {
                "the scene"
            } else {
                &walked
            };
            return Err(format!(
                "is not in the scene: {there} has {offers}, not `{part}`"
            ));
        };
        place = next;
        walked = format!("{walked}{}{part}", if walked.is_empty() { "" } else { "." });
    }
    Ok(place)
}
