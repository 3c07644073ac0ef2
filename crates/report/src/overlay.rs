//! Several results in the same charts, by the names of their files.

use gearmesh_model::{Column, FileError};
use gearmesh_scene::SceneResult;
use gearmesh_scene::pair::figure_table::{FigureKind, FigureTable};
use gearmesh_scene::system_run::{ResultKind, SystemResult, rank, stem};

use crate::min_max;
use crate::page::{Align, Axis, LineChart, LineSeries, Section, Table, Text};
use crate::peak_view::PeakView;
use crate::short_number::{short, usual_unit};

/// Columns that are overlaid, at most.
const MOST_CHARTS: usize = 12;

/// The last rank that is overlaid: meshes, bearings, root strain.
const LAST_RANK: u8 = 3;

/// Gear pairs with the names of their files; none where there are fewer than two.
#[must_use]
pub fn overlaid_pairs(results: &[(String, &SceneResult)]) -> Option<Section> {
    let [(_, first), _, ..] = results else {
        return None;
    };
    let last = |r: &SceneResult| r.torque_nm.len() - 1;
    let x: Vec<f64> = first.angle_rad.iter().map(|a| a.to_degrees()).collect();
    let widths: Option<Vec<f64>> =
        (results.iter().map(|(_, r)| r.overlap_width_m().ok())).collect();
    let stiffness = |k: usize| FigureKind::Stiffness.read_unit(widths.as_ref().map(|all| all[k]));
    let factors: Vec<f64> = (0..results.len()).map(|k| stiffness(k).factor).collect();
    let chart = |title: &str, y: Axis, factors: &[f64], of: fn(&SceneResult) -> &Vec<f64>| {
        let axis = Axis::new("driver angle", "deg");
        let mut chart = LineChart::new(title, axis, y).x_values(x.clone());
        for ((name, r), factor) in results.iter().zip(factors) {
            let own: Vec<f64> = r.angle_rad.iter().map(|a| a.to_degrees()).collect();
            let values = interpolated(&own, r.curve(of(r), last(r)), &x);
            let values = values.into_iter().map(|v| factor * v).collect();
            let label = format!("{name}, {} N m", r.torque_nm[last(r)]);
            chart = chart.series(LineSeries::new(label, values));
        }
        chart
    };
    let torques: Vec<(&SceneResult, usize)> = results.iter().map(|(_, r)| (*r, last(r))).collect();
    let shown = FigureTable::new(&torques, |figure| {
        results.iter().any(|(_, r)| r.shows(figure))
    });
    let mut table = Table::new("At the largest torque").columns(Align::Left, ["file", "title"]);
    for head in shown.heads {
        table = table.column(head, Align::Right);
    }
    for ((name, r), texts) in results.iter().zip(shown.rows) {
        table.push_row([vec![name.clone(), r.source.title.clone()], texts].concat());
    }
    let section = Section::new("Gear pairs side by side")
        .push(table)
        .push(chart(
            "Transmission error",
            Axis::new("TE", "µm"),
            &vec![1e6; results.len()],
            |r| &r.te_m,
        ))
        .push(chart(
            "Tangent mesh stiffness",
            Axis::new("stiffness", stiffness(0).name),
            &factors,
            |r| &r.tangent_n_per_m,
        ));
    Some(with_root_strain(section, results))
}

/// Adds the gauges that all pairs have, each by both methods, and their largest tension and compression.
fn with_root_strain(mut section: Section, results: &[(String, &SceneResult)]) -> Section {
    let Some((_, first)) = results.first() else {
        return section;
    };
    let mut table = Table::new("Root strain at the largest torque, µε")
        .column("gear", Align::Right)
        .columns(Align::Left, ["gauge", "file"])
        .columns(Align::Right, ["method", "largest", "smallest", "range"]);
    let degrees = |r: &SceneResult| -> Vec<f64> {
        r.angle_rad.iter().map(|angle| angle.to_degrees()).collect()
    };
    let mut is_empty = true;
    for own in &first.strain {
        let same = |r: &SceneResult| {
            let mut all = r.strain.iter();
            all.position(|s| (s.gear, &s.name) == (own.gear, &own.name))
        };
        let numbers: Option<Vec<usize>> = results.iter().map(|(_, r)| same(r)).collect();
        let Some(numbers) = numbers else {
            continue;
        };
        is_empty = false;
        let last = |r: &SceneResult| r.torque_nm.len() - 1;
        let view = PeakView::of(first, own, first.curve(&own.method_2, last(first)));
        let mut chart = LineChart::new(
            format!("Gear {}, gauge {}", own.gear, own.name),
            Axis::new("driver angle", "deg"),
            Axis::new("strain", "µε"),
        )
        .x_values(view.angles_deg(first));
        if let Some([from, to]) = view.window_deg(first) {
            chart = chart.x_window(from, to);
        }
        for ((file, r), number) in results.iter().zip(numbers) {
            let s = &r.strain[number];
            for (method, values) in [(1, &s.method_1), (2, &s.method_2)] {
                let curve = interpolated(&degrees(r), r.curve(values, last(r)), &degrees(first));
                let micro = view.turned(&curve).iter().map(|v| 1e6 * v).collect();
                let label = format!("{file}, {} N m, method {method}", r.torque_nm[last(r)]);
                chart = chart.series(LineSeries::new(label, micro));
                let [least, most] = r.strain_ends(number, method, last(r));
                table.push_row([
                    own.gear.to_string(),
                    own.name.clone(),
                    file.clone(),
                    method.to_string(),
                    short(1e6 * most),
                    short(1e6 * least),
                    short(1e6 * (most - least)),
                ]);
            }
        }
        section = section.push(chart);
    }
    if is_empty {
        section
    } else {
        section.push(table)
    }
}

/// Multibody results of one kind, transient or speed sweeps, with the names of their files; none where there are fewer
/// than two.
///
/// # Errors
/// [`FileError`] if a column cannot be read.
pub fn overlaid_systems(results: &[(String, &SystemResult)]) -> Result<Option<Section>, FileError> {
    let [(_, first), others @ ..] = results else {
        return Ok(None);
    };
    let in_time = first.kind == ResultKind::Transient;
    let overlaid = in_time || first.kind == ResultKind::SpeedSweep;
    if others.is_empty() || !overlaid || others.iter().any(|(_, r)| r.kind != first.kind) {
        return Ok(None);
    }
    let common = common_columns(first, others);
    let mut section = Section::new("Results side by side");
    if common.is_empty() {
        return Ok(Some(section.push(Text::paragraph(
            "The files have no meshes or bearings of the same names; nothing is overlaid.",
        ))));
    }
    let left_out = common.len().saturating_sub(MOST_CHARTS);
    for column in common.iter().take(MOST_CHARTS) {
        section = section.push(overlaid_column(results, column, in_time)?);
    }
    if left_out > 0 {
        section = section.push(Text::note(format!(
            "{left_out} more common columns are not overlaid."
        )));
    }
    Ok(Some(section))
}

/// Columns that all results have, the foremost first.
fn common_columns(first: &SystemResult, others: &[(String, &SystemResult)]) -> Vec<Column> {
    let columns_of = |r: &SystemResult| -> Vec<Column> {
        match &r.sweep {
            Some(sweep) => sweep.columns.clone(),
            None => r.rows.columns().to_vec(),
        }
    };
    let others: Vec<Vec<Column>> = others.iter().map(|(_, r)| columns_of(r)).collect();
    let has = |all: &[Column], column: &Column| {
        let mut all = all.iter();
        all.any(|other| (&other.name, &other.unit) == (&column.name, &column.unit))
    };
    let mut common = columns_of(first);
    common.retain(|c| rank(&c.name) <= LAST_RANK && others.iter().all(|all| has(all, c)));
    common.sort_by_key(|column| rank(&column.name));
    common
}

/// One column of all results, over the abscissas of the first.
fn overlaid_column(
    results: &[(String, &SystemResult)],
    Column { name, unit, .. }: &Column,
    in_time: bool,
) -> Result<LineChart, FileError> {
    let curve = |(_, r): &(String, &SystemResult)| match in_time {
        true => in_time_curve(r, name),
        false => Ok(swept_curve(r, name)),
    };
    let curves = results.iter().map(curve).collect::<Result<Vec<_>, _>>()?;
    let values = curves.iter().flat_map(|(_, y)| y);
    let largest = values.fold(0.0, |most: f64, y| most.max(y.abs()));
    let words: Vec<&str> = stem(name, unit).split('/').skip(1).collect();
    let words = words.join(": ").replace('_', " ");
    let (factor, unit) = usual_unit(unit, largest);
    let x = &curves[0].0;
    let (title, axis, shown) = if in_time {
        (words, Axis::new("time", "s"), min_max::abscissas(x))
    } else {
        let title = format!("{words}, peak to peak on the way up");
        let axis = Axis::new("speed of the varied motion", "rpm");
        (title, axis, x.clone())
    };
    let mut chart = LineChart::new(title, axis, Axis::new("value", unit)).x_values(shown);
    for ((file, _), (own, y)) in results.iter().zip(&curves) {
        let mut values = interpolated(own, y, x);
        values.iter_mut().for_each(|v| *v *= factor);
        if in_time {
            values = min_max::values(&values);
        }
        chart = chart.series(LineSeries::new(file.clone(), values));
    }
    Ok(chart)
}

type Curve = (Vec<f64>, Vec<f64>);

fn in_time_curve(r: &SystemResult, name: &str) -> Result<Curve, FileError> {
    Ok((r.rows.read("time_s")?, r.rows.read(name)?))
}

/// Peak to peak over the amount of the speed, upwards; downwards where the sweep goes down only.
fn swept_curve(r: &SystemResult, name: &str) -> Curve {
    let Some(sweep) = &r.sweep else {
        return Curve::default();
    };
    let Some(column) = sweep.columns.iter().position(|c| c.name == name) else {
        return Curve::default();
    };
    let up = sweep.windows.iter().any(|w| w.up);
    let windows = sweep.windows.iter().zip(&sweep.figures);
    let mut points: Vec<(f64, f64)> = windows
        .filter(|(w, _)| w.up == up)
        .map(|(w, f)| {
            let rpm = w.speed_rad_per_s.abs() * 60.0 / std::f64::consts::TAU;
            (rpm, f[column].peak_to_peak())
        })
        .collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points.dedup_by(|a, b| a.0.to_bits() == b.0.to_bits());
    points.into_iter().unzip()
}

/// Straight between the points; nothing (NaN) beyond their ends.
fn interpolated(x: &[f64], y: &[f64], at: &[f64]) -> Vec<f64> {
    let value = |&at: &f64| {
        let after = x.partition_point(|x| *x < at);
        match (after.checked_sub(1), x.get(after)) {
            (_, Some(next)) if *next == at => y[after],
            (Some(before), Some(next)) => {
                let share = (at - x[before]) / (next - x[before]);
                y[before] + share * (y[after] - y[before])
            }
            _ => f64::NAN,
        }
    };
    at.iter().map(value).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_are_met_where_they_are_and_nowhere_else() {
        let found = interpolated(
            &[0.0, 1.0, 3.0],
            &[2.0, 4.0, 8.0],
            &[-0.1, 0.0, 0.5, 2.0, 3.0, 3.1],
        );
        assert_eq!(found[1..5], [2.0, 3.0, 6.0, 8.0]);
        assert!(found[0].is_nan() && found[5].is_nan());
    }
}
