//! The stages: what follows from their teeth, beside torques, forces, speeds and K_Hβ of the run.

use gearmesh_model::FileError;
use gearmesh_scene::system_run::SystemResult;

use crate::page::{Align, Table};
use crate::short_number::short;

/// A line a figure, a column a stage; none of a scene without gear meshes.
pub(super) fn table(r: &SystemResult) -> Result<Option<Table>, FileError> {
    let Some(stages) = r.stages()? else {
        return Ok(None);
    };
    let mut table = Table::new(format!("Stages, loads {}", stages.over))
        .columns(Align::Left, ["figure", "unit"]);
    for row in &stages.rows {
        table = table.column(row.mesh.name.clone(), Align::Right);
    }
    for line in stages.lines() {
        let label = match line.key {
            "contact_ratio" => "ε_α",
            "overlap_ratio" => "ε_β",
            "single_stiffness_N_per_mm_um" => "c′ of ISO 6336-1",
            "mesh_stiffness_N_per_mm_um" => "c_γ of ISO 6336-1",
            _ => line.label,
        };
        let values = line.values.iter();
        let values = values.map(|value| value.map_or_else(|| "–".to_owned(), short));
        let head = [label.to_owned(), line.unit.to_owned()].into_iter();
        table.push_row(head.chain(values));
    }
    Ok(Some(table))
}
