//! What friction takes in a run, part by part.

use gearmesh_model::FileError;
use gearmesh_scene::system_run::SystemResult;

use crate::page::{Align, Section, Table, Text};
use crate::short_number::short;

/// A table of the parts that lose power; none where no part names friction.
pub(super) fn section(r: &SystemResult) -> Result<Option<Section>, FileError> {
    let Some(losses) = r.power_losses()? else {
        return Ok(None);
    };
    let mut table = Table::new("Power lost by friction, mean over the rows")
        .column("part", Align::Left)
        .column("loss W", Align::Right)
        .columns(Align::Right, ["power through it W", "efficiency %"]);
    let shown = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), short);
    let percent = |value: Option<f64>| {
        value.map_or_else(|| "-".to_owned(), |value| format!("{:.3}", 100.0 * value))
    };
    for loss in &losses.parts {
        table.push_row([
            loss.part.clone(),
            short(loss.mean_w),
            shown(loss.through_w),
            percent(loss.efficiency()),
        ]);
    }
    table.push_row([
        "in all".to_owned(),
        short(losses.total_w()),
        shown(losses.through_w()),
        percent(losses.efficiency()),
    ]);
    let note = "In all: over the largest power through a mesh, as where power goes through one mesh after the other. Parts that name no friction lose none here.";
    let heading = format!("{}: power losses", r.head.title);
    Ok(Some(
        Section::new(heading).push(table).push(Text::note(note)),
    ))
}
