//! `gearmesh plan`: what a scene will compute.

use crate::arguments::PlanArguments;
use crate::console;
use gearmesh_operations::Failure;
use gearmesh_operations::plan::plan;
use gearmesh_scene::SceneFile;

/// Runs the command.
pub fn run(a: &PlanArguments) -> Result<(), Failure> {
    let found = plan(SceneFile::read(&a.scene)?, &console::watch())?;
    if a.json {
        console::json(&found.figures);
    } else {
        found.lines.iter().for_each(console::data);
    }
    Ok(())
}
