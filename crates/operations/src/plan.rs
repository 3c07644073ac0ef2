//! What a scene will compute.

use crate::answer::Answer;
use crate::failure::{Failure, Result};
use crate::watch::Watch;
use gearmesh_scene::ModelShelf;
use gearmesh_scene::system::SystemPlan;
use gearmesh_scene::system_run::{ResultSize, RunCost, RunJob};
use gearmesh_scene::{SceneFile, load};
use serde_json::json;

/// Says what a scene will compute.
///
/// # Errors
/// [`Failure`] for what a run would refuse.
pub fn plan(scene: SceneFile, watch: &Watch<'_>) -> Result<Answer> {
    match scene {
        SceneFile::Pair(scene) => {
            let loaded = load(*scene)?;
            loaded.scene.notes.iter().for_each(|note| watch.note(note));
            watch.unit_slips(loaded.unit_slips());
            loaded.contact().map_err(Failure::input)?;
            let plan = loaded.plan();
            let figures = json!({"lines": plan.lines, "positions": plan.positions, "unknowns": plan.unknowns, "proposal": plan.proposal,
                "result_bytes": loaded.result_bytes()});
            Ok(Answer {
                lines: plan.lines,
                figures,
            })
        }
        SceneFile::Bevel(scene) => {
            watch.unit_slips(scene.document.unit_slips());
            let lines = scene.load(&ModelShelf::default())?.plan();
            let figures = json!({ "lines": lines });
            Ok(Answer { lines, figures })
        }
        SceneFile::System(scene) => {
            let loaded = scene.load()?;
            loaded.scene.notes.iter().for_each(|note| watch.note(note));
            watch.unit_slips(loaded.unit_slips());
            // What the run would refuse is refused here.
            let size = ResultSize::of(&RunJob::from_scene(loaded.clone())?);
            let plan = SystemPlan::new(&loaded.scene, loaded.build()?)?
                .with_result(size)
                .with_cost(&loaded.scene, RunCost::timed(&loaded)?);
            let stages: serde_json::Map<String, serde_json::Value> = (plan.stages.iter())
                .map(|(mesh, stage)| (mesh.clone(), json!(stage)))
                .collect();
            let figures = json!({
                "lines": plan.lines, "stages": stages, "degrees_of_freedom": plan.degrees_of_freedom, "equations": plan.equations,
                "mobility": plan.mobility, "highest_frequency_Hz": plan.highest_frequency_hz, "steps": plan.steps,
                "step_cost_s": plan.step_cost_s, "result_bytes": size.map(|size| size.bytes()),
            });
            Ok(Answer {
                lines: plan.lines,
                figures,
            })
        }
    }
}
