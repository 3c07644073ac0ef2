//! Bevel pairs: looked at while their text changes, and run into a folder.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::SystemTime;

use gearmesh_geometry::input::InputDocument;
use gearmesh_operations::new_files;
use gearmesh_operations::report::{ReportRequest, report};
use gearmesh_operations::run::{RunHow, run_bevel};
use gearmesh_operations::tca::{TcaRequest, tca};
use gearmesh_operations::{Failure, Watch};
use gearmesh_report::pair_in_space::bevel_pair;
use gearmesh_scene::ModelShelf;
use gearmesh_scene::pair::{BevelScene, SceneResult};
use gearmesh_scene::study::RestFigures;
use serde_json::{Value, json};

use crate::problem::Problem;

/// The models of the pair that is looked at again and again, read once until a file of them changes.
#[derive(Debug, Default)]
pub struct BevelModels(Mutex<(Vec<Stamped>, Arc<ModelShelf>)>);

/// A file and when it was written.
type Stamped = (PathBuf, Option<SystemTime>);

impl BevelModels {
    /// The models of a scene.
    fn of(&self, scene: &BevelScene) -> Arc<ModelShelf> {
        let named = scene
            .file
            .load
            .iter()
            .filter_map(|load| load.models.as_ref());
        let stamped = named.flatten().map(|file| {
            let path = scene.folder().join(file);
            let written = path.metadata().and_then(|found| found.modified()).ok();
            (path, written)
        });
        let files: Vec<Stamped> = stamped.collect();
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if kept.0 != files {
            *kept = (files, Arc::default());
        }
        Arc::clone(&kept.1)
    }
}

/// A pair as its text is, under its torques: what should be known of it, curves, figures and the gears in space;
/// nothing is written.
///
/// # Errors
/// [`Problem`] for what is wrong with it, and once `stop` is set.
pub fn live(file: &Path, models: &BevelModels, stop: &AtomicBool) -> Result<Value, Problem> {
    let scene = BevelScene::from_document(InputDocument::read(file)?)?;
    let found = RestFigures::solved_bevel(&scene, &models.of(&scene), stop);
    if stop.load(Ordering::Relaxed) {
        return Err(Problem::Stopped);
    }
    // With the flanks that were made; what is wrong with them is said in the words of `gearmesh check`.
    let warnings = new_files::look_at_bevel(&scene)?;
    let (figures, result) = found.map_err(Failure::from)?;
    Ok(json!({
        "warnings": warnings,
        "load": result.as_ref().map(|result| load_curves(&scene, result)),
        "columns": new_files::figures_as_json(&figures),
    }))
}

/// Analyses and runs the pair of a file; result and pages stand beside it.
///
/// # Errors
/// [`Problem`] for what is wrong with it, and once `watch` stops it.
pub fn written(file: &Path, watch: &Watch<'_>) -> Result<Value, Problem> {
    let request = TcaRequest {
        pair: file.to_owned(),
        report: Some(file.with_file_name("bevel_pair.html")),
    };
    let found = tca(&request, watch)?;
    let scene = BevelScene::from_document(InputDocument::read(file)?)?;
    let loaded = under_load(&scene, file, watch)?;
    let columns = RestFigures::of_bevel(&scene, loaded.as_ref()).map_err(Failure::from)?;
    Ok(json!({
        "tca": found.figures,
        "lines": found.lines,
        "load": loaded.as_ref().map(|result| load_curves(&scene, result)),
        "columns": new_files::figures_as_json(&columns),
    }))
}

/// Runs a bevel pair under the torques of its `[load]`, if it has one, and writes result and page beside its file.
fn under_load(
    scene: &BevelScene,
    file: &Path,
    watch: &Watch<'_>,
) -> Result<Option<SceneResult>, Problem> {
    if scene.file.load.is_none() {
        return Ok(None);
    }
    let output = file.with_extension("h5");
    let how = RunHow {
        output: Some(&output),
        ..RunHow::default()
    };
    let result = run_bevel(scene, &how, watch)?;
    let request = ReportRequest {
        results: vec![output],
        output: file.with_file_name("bevel_pair_loaded.html"),
        ..ReportRequest::default()
    };
    report(&request, watch)?;
    Ok(Some(result))
}

/// Curves of a pitch as the page draws them, and the gears in space.
fn load_curves(scene: &BevelScene, result: &SceneResult) -> Value {
    let largest_mpa = result.even_positions().map(|position| {
        let pressures = position.pressing().map(|at| 1e-6 * at.pressure_pa);
        pressures.fold(0.0, f64::max)
    });
    let pitch = 0..result.points_per_pitch();
    let of_pitch = |values: &[f64], scale: f64| -> Vec<f64> {
        let curves = values.chunks_exact(result.angles());
        let pitches = curves.flat_map(|curve| &curve[pitch.clone()]);
        pitches.map(|value| scale * value).collect()
    };
    json!({
        "torques_Nm": result.torque_nm,
        "angle_deg": of_pitch(&result.angle_rad, 1f64.to_degrees()),
        "te_um": of_pitch(&result.te_m, 1e6),
        "unloaded_um": of_pitch(&result.unloaded_m, 1e6),
        "pressure_largest_MPa": largest_mpa.collect::<Vec<_>>(),
        "in_space": bevel_pair(scene, result),
    })
}
