//! Tables of a multibody result: rows in time or of equilibria, windows of a sweep, modes.

use gearmesh_model::Column;
use gearmesh_scene::system_run::{ResultKind, SystemResult};

use super::{Cells, Table, ratings_table};

/// `rows` of transient and static results, `windows` of a sweep, `modes` and `shapes` of natural frequencies;
/// `ratings`.
#[must_use]
pub fn system_tables(result: &SystemResult) -> Vec<Table<'_>> {
    let mut tables = match result.kind {
        ResultKind::Transient | ResultKind::Static => vec![rows(result)],
        ResultKind::SpeedSweep => vec![windows(result)],
        ResultKind::Eigen => vec![modes(result), shapes(result)],
    };
    tables.extend(ratings_table(&result.ratings));
    tables
}

/// The columns of the file, as they are, read when they are needed.
fn rows(result: &SystemResult) -> Table<'_> {
    let file = &result.rows;
    let columns = file.columns().iter().map(|column| &column.name);
    Table {
        name: "rows".to_owned(),
        columns: columns
            .map(|name| (name.clone(), Cells::Column(file, name.clone())))
            .collect(),
    }
}

/// A row a window; of each column of the run the mean, deviation, least and largest.
fn windows(result: &SystemResult) -> Table<'static> {
    let mut table = Table::new("windows");
    let Some(sweep) = &result.sweep else {
        return table;
    };
    let windows = &sweep.windows;
    table.numbers(
        "speed_rad_per_s",
        windows.iter().map(|w| w.speed_rad_per_s).collect(),
    );
    let up = windows.iter().map(|w| f64::from(u8::from(w.up)));
    table.numbers("up", up.collect());
    table.numbers("from_s", windows.iter().map(|w| w.from_s).collect());
    table.numbers("to_s", windows.iter().map(|w| w.to_s).collect());
    for (place, Column { name, .. }) in sweep.columns.iter().enumerate() {
        let figures = || sweep.figures.iter().map(|window| &window[place]);
        table.numbers(format!("{name} mean"), figures().map(|f| f.mean).collect());
        let deviation = figures().map(|f| f.deviation);
        table.numbers(format!("{name} deviation"), deviation.collect());
        table.numbers(
            format!("{name} least"),
            figures().map(|f| f.least).collect(),
        );
        let largest = figures().map(|f| f.largest);
        table.numbers(format!("{name} largest"), largest.collect());
    }
    table
}

/// A row for each operating point and mode; shares of the kinetic energy by body and of the strain energy by force
/// element.
fn modes(result: &SystemResult) -> Table<'static> {
    let mut table = Table::new("modes");
    let all = || {
        let points = result.eigen.iter();
        points.flat_map(|point| point.modes.iter().enumerate().map(move |m| (point, m)))
    };
    table.numbers(
        "load_factor",
        all().map(|(p, _)| p.point.load_factor).collect(),
    );
    let speed = all().map(|(p, _)| p.point.speed_rad_per_s.unwrap_or(f64::NAN));
    table.numbers("speed_rad_per_s", speed.collect());
    table.numbers("mode", all().map(|(_, (k, _))| (k + 1) as f64).collect());
    let frequency = all().map(|(_, (_, mode))| mode.frequency_hz());
    table.numbers("frequency_Hz", frequency.collect());
    let damping = all().map(|(_, (_, mode))| mode.damping_ratio());
    table.numbers("damping_ratio", damping.collect());
    let growth = all().map(|(_, (_, mode))| mode.growth_per_s);
    table.numbers("growth_per_s", growth.collect());
    for (place, body) in result.bodies.iter().enumerate() {
        let share = all().map(|(point, (k, _))| point.participation[k][place]);
        table.numbers(format!("participation {body}"), share.collect());
    }
    for (place, element) in result.elements.iter().enumerate() {
        let share = all().map(|(point, (k, _))| point.strain[k][place]);
        table.numbers(format!("strain energy {element}"), share.collect());
    }
    table
}

/// A row for each operating point, mode and degree of freedom.
fn shapes(result: &SystemResult) -> Table<'static> {
    let mut columns: [Vec<f64>; 5] = Default::default();
    for (number, point) in result.eigen.iter().enumerate() {
        for (k, mode) in point.modes.iter().enumerate() {
            for (dof, [real, imaginary]) in mode.shape.iter().enumerate() {
                let row = [
                    (number + 1) as f64,
                    (k + 1) as f64,
                    (dof + 1) as f64,
                    *real,
                    *imaginary,
                ];
                columns.iter_mut().zip(row).for_each(|(c, v)| c.push(v));
            }
        }
    }
    let names = ["point", "mode", "degree_of_freedom", "real", "imaginary"];
    let mut table = Table::new("shapes");
    for (name, values) in names.into_iter().zip(columns) {
        table.numbers(name, values);
    }
    table
}
