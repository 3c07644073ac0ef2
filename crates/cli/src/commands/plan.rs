//! `gearmesh plan`: what a scene will compute.

use crate::arguments::PlanArguments;
use crate::console;
use crate::failure::Failure;
use gearmesh_scene::{Scene, load};
use serde_json::json;

/// Runs the command.
pub fn run(arguments: &PlanArguments) -> Result<(), Failure> {
    let plan = load(Scene::read(&arguments.scene)?)?.plan();
    if arguments.json {
        console::json(
            &json!({"lines": plan.lines, "positions": plan.positions, "unknowns": plan.unknowns}),
        );
    } else {
        plan.lines.iter().for_each(console::data);
    }
    Ok(())
}
