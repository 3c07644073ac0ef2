//! The figures of a pair by torque: one table, two where a sheet of paper has no room for all columns.

use crate::page::{Align, Table};
use gearmesh_scene::SceneResult;

/// Figures that a sheet of paper has room for beside each other.
const MOST_FIGURES: usize = 12;

/// The tables; `mark` stands behind what a longer run may change.
pub(crate) fn tables(r: &SceneResult, mark: &str) -> Vec<Table> {
    let shown = r.figure_table(false);
    let figures = shown.heads.len().saturating_sub(1);
    let parts = figures.div_ceil(MOST_FIGURES);
    let part = |k: usize| {
        let mut table = Table::new(match k {
            0 => format!(
                "By torque: transmission error, mean mesh stiffness (secant and tangent), face load factor, largest Hertz pressure{mark}"
            ),
            _ => format!("By torque, further figures{mark}"),
        });
        // The torque stands in each.
        let own = 1 + k * figures / parts..1 + (k + 1) * figures / parts;
        let cut = |cells: &[String]| [&cells[..1], &cells[own.clone()]].concat();
        for head in cut(&shown.heads) {
            table = table.column(head, Align::Right);
        }
        for row in &shown.rows {
            table.push_row(cut(row));
        }
        table
    };
    (0..parts).map(part).collect()
}
