//! A table as functions over one axis, as measuring programs hold them (universal files, data set 58).

use super::{ExportError, Table};
use gearmesh_scene::system_run::unit_in_name;
use serde::Deserialize;

/// Values over an axis.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Function {
    /// Column of the table, with the unit in its name.
    pub name: String,
    /// What is the same for all values, such as `torque_Nm = 100`; empty where nothing is.
    pub condition: String,
    /// SI unit of the values; `1` for plain numbers.
    pub unit: String,
    /// Column that is the axis.
    pub axis: String,
    /// Its SI unit.
    pub axis_unit: String,
    /// Places on the axis, rising or falling.
    pub x: Vec<f64>,
    /// Values.
    pub y: Vec<f64>,
}

/// Tables that are functions: their axis, and the column that tells one function from the next.
const FUNCTIONS: [(&str, &str, Option<&str>); 3] = [
    ("curves", "angle_rad", Some("torque_Nm")),
    ("rows", "time_s", None),
    ("windows", "speed_rad_per_s", Some("up")),
];

/// Gives the functions of a table to `take`, one after the other: its columns of numbers over the axis, each torque or
/// way of a sweep by itself. Values that are not there, and functions of less than two values, are left out; a table
/// without an axis (contact, modes, ratings) has none. Axis and one column are in memory.
///
/// # Errors
/// [`ExportError::File`] if a column cannot be read; those of `take`.
pub fn for_each_function(
    table: &Table<'_>,
    take: &mut dyn FnMut(Function) -> Result<(), ExportError>,
) -> Result<(), ExportError> {
    let numbers = |wanted: &str| {
        let column = table.columns.iter().find(|(name, _)| name == wanted);
        let numbers = column.map(|(_, cells)| cells.numbers(0..cells.rows()));
        numbers.transpose().map(Option::flatten)
    };
    let kind = FUNCTIONS.iter().find(|(name, ..)| *name == table.name);
    let Some((_, axis, group)) = kind else {
        return Ok(());
    };
    let Some(x) = numbers(axis)? else {
        return Ok(());
    };
    let groups = match group {
        Some(group) => numbers(group)?,
        None => None,
    };
    // Rows of one group follow each other.
    let mut first = 0;
    while first < x.len() {
        let same = |row: &usize| groups.as_ref().is_none_or(|g| g[*row] == g[first]);
        let end = first + (first..x.len()).take_while(same).count();
        let condition = match (group, &groups) {
            (Some(name), Some(values)) => format!("{name} = {}", values[first]),
            _ => String::new(),
        };
        for (name, cells) in &table.columns {
            if name == axis || Some(&**name) == *group {
                continue;
            }
            let Some(values) = cells.numbers(first..end)? else {
                continue;
            };
            let own = x[first..end].iter().copied().zip(values.iter().copied());
            let (x, y): (Vec<f64>, Vec<f64>) = own.filter(|(_, value)| value.is_finite()).unzip();
            if y.len() < 2 {
                continue;
            }
            take(Function {
                name: name.clone(),
                condition: condition.clone(),
                unit: unit_of(name).to_owned(),
                axis: (*axis).to_owned(),
                axis_unit: unit_in_name(axis).to_owned(),
                x,
                y,
            })?;
        }
        first = end;
    }
    Ok(())
}

/// The unit of a column; of a sweep's figure (`… mean`) that of its column.
fn unit_of(name: &str) -> &'static str {
    let figures = [" mean", " deviation", " least", " largest"];
    let stem = figures.iter().find_map(|figure| name.strip_suffix(figure));
    unit_in_name(stem.unwrap_or(name))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn functions(table: &Table<'_>) -> Vec<Function> {
        let mut found = Vec::new();
        for_each_function(table, &mut |function| {
            found.push(function);
            Ok(())
        })
        .unwrap();
        found
    }

    fn table(name: &str, columns: &[(&str, &[f64])]) -> Table<'static> {
        let mut table = Table::new(name);
        for (head, values) in columns {
            table.numbers(*head, values.to_vec());
        }
        table
    }

    #[test]
    fn each_torque_is_a_function_of_the_angle() {
        let curves = table(
            "curves",
            &[
                ("torque_Nm", &[5.0, 5.0, 5.0, 9.0, 9.0]),
                ("angle_rad", &[0.0, 0.1, 0.2, 0.0, 0.1]),
                ("te_m", &[1.0, f64::NAN, 3.0, 4.0, 5.0]),
            ],
        );
        let found = functions(&curves);
        let shown: Vec<_> = (found.iter())
            .map(|f| {
                (
                    &*f.condition,
                    &*f.unit,
                    &*f.axis_unit,
                    f.x.clone(),
                    f.y.clone(),
                )
            })
            .collect();
        assert_eq!(
            shown,
            [
                ("torque_Nm = 5", "m", "rad", vec![0.0, 0.2], vec![1.0, 3.0]),
                ("torque_Nm = 9", "m", "rad", vec![0.0, 0.1], vec![4.0, 5.0]),
            ]
        );
    }

    #[test]
    fn the_ways_of_a_sweep_are_kept_apart_and_tables_without_an_axis_have_none() {
        let windows = table(
            "windows",
            &[
                ("speed_rad_per_s", &[1.0, 2.0, 2.0, 1.0]),
                ("up", &[1.0, 1.0, 0.0, 0.0]),
                ("elements/mesh/force_N largest", &[1.0, 2.0, 3.0, 4.0]),
            ],
        );
        let found = functions(&windows);
        assert_eq!(found.len(), 2);
        assert_eq!((&*found[1].unit, &*found[1].condition), ("N", "up = 0"));
        assert_eq!(found[1].x, [2.0, 1.0]);
        let none = table("contact", &[("angle_rad", &[0.0, 1.0])]);
        assert!(functions(&none).is_empty());
    }
}
