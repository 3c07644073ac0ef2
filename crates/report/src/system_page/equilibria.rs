//! Static series over an angle or a load factor.

use gearmesh_model::FileError;
use gearmesh_scene::system_run::{SystemResult, noticeable, rank, split_unit};

use super::columns::{MOST_CHARTS, groups, left_out, quantity, readable, scaled};
use super::transient::LAST_RANK;
use crate::page::{Align, Axis, KeyFigures, LineChart, LineSeries, Section, Table};
use crate::short_number::{short, usual_unit};

/// Columns of the table.
const MOST_COLUMNS: usize = 8;

/// Meshes whose figures head a page.
const MOST_MESHES: usize = 4;

/// A column over all equilibria.
struct Values<'a> {
    name: &'a str,
    values: Vec<f64>,
}

impl Values<'_> {
    fn least(&self) -> f64 {
        self.values.iter().copied().fold(f64::INFINITY, f64::min)
    }

    fn largest(&self) -> f64 {
        self.values
            .iter()
            .copied()
            .fold(f64::NEG_INFINITY, f64::max)
    }

    fn mean(&self) -> f64 {
        self.values.iter().sum::<f64>() / self.values.len() as f64
    }

    fn magnitude(&self) -> f64 {
        self.least().abs().max(self.largest().abs())
    }
}

/// Channels of force elements that are not zero but for rounding, those first that a reader asks for first.
fn channels(r: &SystemResult) -> Result<Vec<Values<'_>>, FileError> {
    let mut found = Vec::new();
    for column in r.rows.columns() {
        if column.name.starts_with("elements/") {
            let values = r.rows.read(&column.name)?;
            let name = &column.name;
            found.push(Values { name, values });
        }
    }
    let mut shown = {
        let extremes = found.iter().map(|c| (c.name, c.least(), c.largest()));
        noticeable(extremes).into_iter()
    };
    found.retain(|_| shown.next().unwrap_or(false));
    found.sort_by_key(|column| rank(column.name));
    Ok(found)
}

/// Transmission error and tooth force of the meshes, and the largest radial force of a bearing.
pub(super) fn key_figures(r: &SystemResult) -> Result<KeyFigures, FileError> {
    let mut figures = KeyFigures::new();
    let channels = channels(r)?;
    let one = r.rows.rows() == 1;
    for mesh in r.head.meshes.iter().take(MOST_MESHES) {
        let of_mesh = format!("elements/{}/", mesh.name);
        let mut found = channels
            .iter()
            .filter_map(|c| Some((c.name.strip_prefix(&of_mesh)?, c)));
        if let Some((_, te)) = found
            .clone()
            .find(|(channel, _)| *channel == "transmission_error_m")
        {
            let (label, value) = match one {
                true => ("TE", te.mean()),
                false => ("TE peak to peak", te.largest() - te.least()),
            };
            figures = figures.figure(format!("{}: {label}", mesh.name), short(1e6 * value), "µm");
        }
        if let Some((_, force)) = found.find(|(channel, _)| channel.starts_with("normal_force_")) {
            let label = if one {
                "normal force"
            } else {
                "largest normal force"
            };
            figures = figures.figure(
                format!("{}: {label}", mesh.name),
                short(force.largest()),
                "N",
            );
        }
    }
    let radial = channels
        .iter()
        .filter(|column| column.name.ends_with("/force_radial_N"));
    if let Some(force) = radial.max_by(|a, b| a.largest().total_cmp(&b.largest())) {
        let bearing = force.name.split('/').nth(1).unwrap_or_default();
        let label = format!("largest bearing force: {bearing}");
        figures = figures.figure(label, short(force.largest()), "N");
    }
    Ok(figures)
}

/// Meshes and bearings at a glance, and folded all other force elements: the value of one equilibrium, figures of
/// several.
fn columns_tables(r: &SystemResult) -> Result<[Table; 2], FileError> {
    let heads: &[&str] = match r.rows.rows() {
        1 => &["value"],
        _ => &["mean", "least", "largest", "peak to peak"],
    };
    let mut tables = [
        Table::new("Meshes and bearings"),
        Table::new("Springs, couplings and beams").folded(),
    ]
    .map(|table| {
        let table = table
            .column("column", Align::Left)
            .column("unit", Align::Left);
        heads
            .iter()
            .fold(table, |table, head| table.column(*head, Align::Right))
    });
    for column in channels(r)? {
        let (name, unit) = split_unit(column.name);
        let (factor, unit) = usual_unit(unit, column.magnitude());
        let figures = [
            column.mean(),
            column.least(),
            column.largest(),
            column.largest() - column.least(),
        ];
        let mut row = vec![readable(name), unit.to_owned()];
        row.extend(figures.iter().take(heads.len()).map(|x| short(factor * x)));
        tables[usize::from(rank(column.name) > LAST_RANK)].push_row(row);
    }
    Ok(tables)
}

pub(super) fn equilibria(r: &SystemResult) -> Result<Section, FileError> {
    let mut section = Section::new(format!("{}: equilibria", r.head.title));
    for table in columns_tables(r)? {
        if !table.is_empty() {
            section = section.push(table);
        }
    }
    if r.rows.rows() == 1 {
        return Ok(section);
    }
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
            let of_rows = |(column, _): &(String, String)| {
                let values = r.rows.read(column)?;
                Ok::<_, FileError>(rows.iter().map(|&row| values[row]).collect())
            };
            let columns = group.columns.iter().map(of_rows);
            let mut curves: Vec<Vec<f64>> = columns.collect::<Result<_, _>>()?;
            let unit = scaled(group.unit, curves.iter_mut());
            let y = Axis::new(quantity(group.unit), unit);
            let mut chart = LineChart::new(title, axis.clone(), y)
                .x_values(rows.iter().map(|&row| x[row]).collect());
            for ((_, name), values) in group.columns.iter().zip(curves) {
                chart = chart.series(LineSeries::new(name.clone(), values));
            }
            section = section.push(chart);
        }
    }
    let mut table = Table::new("Each equilibrium")
        .column("load factor", Align::Right)
        .column(axis_name(varied), Align::Right);
    let names = r.rows.columns().iter().map(|c| c.name.clone());
    let mut chosen: Vec<String> = names.filter(|name| name.starts_with("elements/")).collect();
    chosen.sort_by_key(|name| rank(name));
    chosen.truncate(MOST_COLUMNS);
    let mut values = Vec::new();
    for name in &chosen {
        let (stem, unit) = split_unit(name);
        let mut column = r.rows.read(name)?;
        let unit = scaled(unit, std::iter::once(&mut column));
        table = table.column(format!("{} {unit}", readable(stem)), Align::Right);
        values.push(column);
    }
    for row in 0..factors.len().min(200) {
        let mut cells = vec![format!("{}", factors[row]), format!("{:.5}", x[row])];
        cells.extend(values.iter().map(|column| short(column[row])));
        table = table.row(cells);
    }
    Ok(left_out(section.push(table), &groups))
}

fn axis_name(varied: bool) -> &'static str {
    if varied { "angle deg" } else { "point" }
}
