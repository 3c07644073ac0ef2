//! Static series over an angle or a load factor.

use gearmesh_model::{Column, FileError};
use gearmesh_scene::system_run::{SystemResult, rank, stem};

use super::columns::{MOST_CHARTS, groups, left_out, scaled};
use crate::column_words::readable;
use crate::page::{Align, Axis, Section, Table};
use crate::short_number::short;

/// Columns of the table.
const MOST_COLUMNS: usize = 8;

/// Over the angle or the load factor; none for a single equilibrium, whose figures head the page.
pub(super) fn equilibria(r: &SystemResult) -> Result<Option<Section>, FileError> {
    if r.rows.rows() == 1 {
        return Ok(None);
    }
    let mut section = Section::new(format!("{}: equilibria", r.head.title));
    let factors = r.rows.read("load_factor")?;
    let varied = r.rows.columns().iter().any(|c| c.name == "angle_rad");
    // Over the angle for each load factor, or over the load factor.
    let (x, axis) = if varied {
        let angles = r.rows.read("angle_rad")?;
        let degrees = angles.iter().map(|a| a.to_degrees()).collect();
        (degrees, Axis::new("angle of the varied motion", "deg"))
    } else {
        (factors.clone(), Axis::new("load factor", ""))
    };
    let x: Vec<f64> = x;
    let mut legs: Vec<(f64, Vec<usize>)> = Vec::new();
    for (row, factor) in factors.iter().enumerate() {
        let key = if varied { *factor } else { 0.0 };
        match legs.last_mut() {
            Some((last, rows)) if last.to_bits() == key.to_bits() => rows.push(row),
            _ => legs.push((key, vec![row])),
        }
    }
    let mut groups = groups(r, |_| true);
    groups.retain(|group| !group.title.starts_with("Angular"));
    for (_, rows) in &mut legs {
        rows.sort_by(|&a, &b| x[a].total_cmp(&x[b]));
        rows.dedup_by(|a, b| x[*a].to_bits() == x[*b].to_bits());
    }
    for group in groups.iter().take(MOST_CHARTS) {
        for (factor, rows) in &legs {
            if rows.len() < 2 {
                continue;
            }
            let title = if varied && legs.len() > 1 {
                format!("{}, load factor {factor}", group.title)
            } else {
                group.title.clone()
            };
            let of_rows = |values: &[f64]| rows.iter().map(|&row| values[row]).collect();
            let over = (axis.clone(), of_rows(&x));
            let chart = group.chart(title, over, |(column, _)| {
                Ok(of_rows(&r.rows.read(column)?))
            })?;
            section = section.push(chart);
        }
    }
    let mut table = Table::new("Each equilibrium")
        .column("load factor", Align::Right)
        .column(axis_name(varied), Align::Right);
    let columns = r.rows.columns().iter();
    let mut chosen: Vec<&Column> = columns
        .filter(|column| column.name.starts_with("elements/"))
        .collect();
    chosen.sort_by_key(|column| rank(&column.name));
    chosen.truncate(MOST_COLUMNS);
    let mut values = Vec::new();
    for column in chosen {
        let mut of_rows = r.rows.read(&column.name)?;
        let unit = scaled(&column.unit, std::iter::once(&mut of_rows));
        let head = readable(stem(&column.name, &column.unit));
        table = table.column(format!("{head} {unit}"), Align::Right);
        values.push(of_rows);
    }
    for row in 0..factors.len().min(200) {
        let mut cells = vec![format!("{}", factors[row]), format!("{:.5}", x[row])];
        cells.extend(values.iter().map(|column| short(column[row])));
        table = table.row(cells);
    }
    Ok(Some(left_out(section.push(table), &groups)))
}

fn axis_name(varied: bool) -> &'static str {
    if varied { "angle deg" } else { "point" }
}
