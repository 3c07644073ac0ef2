//! Power losses of a run: lines of the console, figures of the JSON.

use gearmesh_report::short;
use gearmesh_scene::system_run::SystemResult;
use serde_json::{Value, json};

use crate::failure::{Failure, Result};

/// A line for each part that loses power, and their sum; nothing where no part names friction.
pub fn lines(result: &SystemResult) -> Result<Vec<String>> {
    let Some(losses) = result.power_losses().map_err(Failure::work)? else {
        return Ok(Vec::new());
    };
    let percent = |efficiency: f64| format!("{:.3} %", 100.0 * efficiency);
    let mut lines = vec!["power lost by friction, mean over the rows:".to_owned()];
    for loss in &losses.parts {
        let mut line = format!("  {}: {} W", loss.part, short(loss.mean_w));
        if let (Some(through), Some(efficiency)) = (loss.through_w, loss.efficiency()) {
            line += &format!(
                " of {} W through it, efficiency {}",
                short(through),
                percent(efficiency)
            );
        }
        lines.push(line);
    }
    let mut line = format!("  in all: {} W", short(losses.total_w()));
    if let (Some(through), Some(efficiency)) = (losses.through_w(), losses.efficiency()) {
        line += &format!(
            ", {} % of the {} W through the mesh with most power: efficiency {}",
            short(100.0 * (1.0 - efficiency)),
            short(through),
            percent(efficiency)
        );
    }
    lines.push(line);
    Ok(lines)
}

/// For `--json`; null where no part names friction.
pub fn json(result: &SystemResult) -> Result<Value> {
    let losses = result.power_losses().map_err(Failure::work)?;
    Ok(losses.map_or(Value::Null, |losses| {
        let parts = losses.parts.iter().map(|loss| {
            json!({
                "part": loss.part, "mean_W": loss.mean_w, "through_W": loss.through_w, "efficiency": loss.efficiency(),
            })
        });
        json!({
            "parts": parts.collect::<Vec<_>>(), "total_W": losses.total_w(), "through_W": losses.through_w(),
            "efficiency": losses.efficiency(),
        })
    }))
}
