//! The figures of a multibody run for people: what was asked for first, what it took after it.

use std::f64::consts::TAU;

use gearmesh_model::Column;
use gearmesh_report::{column_width, short, usual_unit};
use gearmesh_scene::system_run::{
    ColumnSummary, EigenResult, MeshPassing, ResultKind, RunRecord, SystemResult, foremost,
    is_overdamped, is_prominent, rank, shares_in_words, stem,
};

use crate::failure::{Failure, Result};
use crate::periods::MARK;
use crate::{losses, mesh_axes, ratings, sets, stages};

/// Lines of the table of columns; all are in the JSON and in the file.
const MOST_LINES: usize = 40;

/// Columns of the tables of sweeps and equilibria.
const MOST_COLUMNS: usize = 5;

/// Bodies and force elements named with a mode.
const MOST_SHARES: usize = 3;

/// The figures for people.
pub fn table(result: &SystemResult) -> Result<Vec<String>> {
    let mut lines = vec![format!("{}: {}", result.head.title, result.kind)];
    lines.extend(sets::lines(result)?);
    lines.extend(match result.kind {
        ResultKind::Transient => columns(result)?,
        ResultKind::SpeedSweep => sweep(result),
        ResultKind::Static => [equilibria(result)?, mesh_axes::lines(result)?].concat(),
        ResultKind::Eigen => result.eigen.iter().flat_map(|p| modes(result, p)).collect(),
    });
    lines.extend(stages::lines(result)?);
    lines.extend(losses::lines(result)?);
    lines.extend(ratings::lines(&result.ratings));
    if let Some(record) = &result.record {
        lines.extend(effort(
            record,
            result.relative_energy_error().unwrap_or(f64::NAN),
        ));
    }
    Ok(lines)
}

fn effort(r: &RunRecord, relative_energy_error: f64) -> Vec<String> {
    let per_step = |count: f64| count / r.steps.max(1.0);
    vec![
        format!(
            "{:.6} s simulated in {:.3} s: {:.4} times real time",
            r.simulated_s,
            r.wall_s,
            r.real_time_factor()
        ),
        format!(
            "{} steps of {:.3e} to {:.3e} s ({} rejected, {} not converged), {:.2} iterations, {:.2} evaluations, {:.4} factorisations a step",
            r.steps,
            r.least_step_s,
            r.largest_step_s,
            r.rejected,
            r.unconverged,
            per_step(r.iterations),
            per_step(r.evaluations),
            per_step(r.factorisations)
        ),
        format!(
            "joints hold to {:.1e} m or rad, their rates to {:.1e}; energy balances to {:.2e} J, {:.1e} of the work done",
            r.largest_violation,
            r.largest_violation_rate,
            r.largest_energy_error_j,
            relative_energy_error
        ),
    ]
}

fn columns(result: &SystemResult) -> Result<Vec<String>> {
    let found = result.summaries(is_prominent).map_err(Failure::work)?;
    let passings = result.mesh_passings().map_err(Failure::work)?;
    let all = found.len();
    let found = foremost(found);
    let mut lines = table_of(
        &found,
        &["mean", "deviation", "pk-pk", "dominant Hz"],
        |column, factor| {
            let figures = &column.figures;
            let dominant = column
                .dominant_hz
                .map_or("-".to_owned(), |hz| format!("{hz:.3}"));
            vec![
                short(factor * figures.mean),
                short(factor * figures.deviation),
                short(factor * figures.peak_to_peak()),
                format!("{dominant:>11}{}", incomplete(&passings, &column.name)),
            ]
        },
    );
    let shown = found.len().min(MOST_LINES);
    if shown < all {
        let zero = all - found.len();
        lines.push(format!(
            "and {} more, {zero} of them zero but for rounding",
            all - shown
        ));
    }
    lines.push(result.statistics_in_words());
    lines.extend(passings.iter().map(MeshPassing::in_words));
    Ok(lines)
}

/// Names, units and cells of the first columns; `cells` takes a column and the factor to the unit in which it is read.
/// A mark may stand behind the last cell.
fn table_of(
    found: &[ColumnSummary],
    heads: &[&str],
    cells: impl Fn(&ColumnSummary, f64) -> Vec<String>,
) -> Vec<String> {
    let shown = &found[..found.len().min(MOST_LINES)];
    let stems = shown.iter().map(|column| stem(&column.name, &column.unit));
    let width = column_width(stems, 6);
    let row = |name: &str, unit: &str, cells: Vec<String>| {
        let cells = cells.iter().map(|cell| format!(" {cell:>11}"));
        format!("{name:width$} {unit:<7}{}", cells.collect::<String>())
    };
    let heads = heads.iter().map(|head| (*head).to_owned());
    let mut lines = vec![row("column", "unit", heads.collect())];
    for column in shown {
        let stem = stem(&column.name, &column.unit);
        let (factor, unit) = usual_unit(&column.unit, column.figures.magnitude());
        lines.push(row(stem, unit, cells(column, factor)));
    }
    lines
}

/// Mark of a line whose figures a longer run may change.
fn incomplete(passings: &[MeshPassing], column: &str) -> &'static str {
    let mut passings = passings.iter();
    if passings.any(|mesh| mesh.leaves_incomplete(column)) {
        MARK
    } else {
        ""
    }
}

fn sweep(result: &SystemResult) -> Vec<String> {
    let Some(sweep) = &result.sweep else {
        return Vec::new();
    };
    let varying = sweep.varying();
    let mut chosen: Vec<(usize, &Column)> = sweep.columns.iter().enumerate().collect();
    chosen.retain(|(place, column)| varying[*place] && is_prominent(&column.name));
    chosen.sort_by_key(|(_, column)| rank(&column.name));
    chosen.truncate(MOST_COLUMNS);
    let mut head = format!("{:>12} {:>5}", "speed rpm", "way");
    let (mut factors, mut widths) = (Vec::new(), Vec::new());
    for (place, Column { name, unit, .. }) in &chosen {
        let stem = stem(name, unit);
        let windows = sweep.figures.iter();
        let largest = windows.fold(0.0, |most: f64, figures| {
            most.max(figures[*place].peak_to_peak())
        });
        let (factor, unit) = usual_unit(unit, largest);
        factors.push(factor);
        let cell = format!("pk-pk {} {unit}", last_parts(stem));
        widths.push(column_width([&cell], 12));
        head += &format!("  {cell:>12}");
    }
    let mut lines = vec![head];
    for (window, figures) in sweep.windows.iter().zip(&sweep.figures) {
        let mut line = format!(
            "{:>12.3} {:>5}",
            window.speed_rad_per_s * 60.0 / TAU,
            if window.up { "up" } else { "down" }
        );
        for (((column, _), factor), width) in chosen.iter().zip(&factors).zip(&widths) {
            line += &format!(
                "  {:>width$}",
                short(factor * figures[*column].peak_to_peak())
            );
        }
        lines.push(line);
    }
    lines.extend(result.incomplete_windows());
    lines
}

/// The last two parts of a column's name.
fn last_parts(name: &str) -> String {
    let parts: Vec<&str> = name.split('/').collect();
    parts[parts.len().saturating_sub(2)..].join("/")
}

/// One line a column: the value where there is one equilibrium, mean and extremes over several.
fn equilibria(result: &SystemResult) -> Result<Vec<String>> {
    let wanted = |name: &str| is_prominent(name) || name.ends_with("/turn_rad");
    let found = foremost(result.summaries(wanted).map_err(Failure::work)?);
    let rows = result.rows.rows();
    let heads: &[&str] = match rows {
        1 => &["value"],
        _ => &["mean", "least", "largest", "pk-pk"],
    };
    let mut lines = table_of(&found, heads, |column, factor| {
        let f = column.figures;
        let figures = [f.mean, f.least, f.largest, f.peak_to_peak()];
        figures[..heads.len()]
            .iter()
            .map(|x| short(factor * x))
            .collect()
    });
    if found.len() > MOST_LINES {
        lines.push(format!("and {} more in the file", found.len() - MOST_LINES));
    }
    if rows > 1 {
        lines.push(format!("over {rows} equilibria; each is a row of the file"));
    }
    Ok(lines)
}

fn modes(result: &SystemResult, found: &EigenResult) -> Vec<String> {
    let mut title = format!("load factor {}", found.point.load_factor);
    if let Some(speed) = found.point.speed_rad_per_s {
        title += &format!(", {:.3} rpm", speed * 60.0 / TAU);
    }
    let mut lines = vec![
        title,
        format!(
            "{:>5} {:>13} {:>11}  {:<44} share of the strain energy",
            "mode", "frequency Hz", "damping %", "share of the kinetic energy"
        ),
    ];
    let kinds = found.kinds_in_words(&result.bodies, &result.head.sets);
    let mut overdamped = Vec::new();
    for (k, mode) in found.modes.iter().enumerate() {
        let moves = shares_in_words(&result.bodies, &found.participation[k], MOST_SHARES);
        let moves = format!("{}{moves}", kinds[k]);
        let strain = found.strain.get(k);
        let strained = strain.map_or(String::new(), |shares| {
            shares_in_words(&result.elements, shares, MOST_SHARES)
        });
        if is_overdamped(mode) {
            let decay_ms = -1e3 / mode.growth_per_s;
            overdamped.push(format!(
                "{:>5} {:>13} {:>11}  {moves:<44} {strained}",
                k + 1,
                short(decay_ms),
                ""
            ));
            continue;
        }
        let line = format!(
            "{:>5} {:>13.4} {:>11.4}  {moves:<44} {strained}",
            k + 1,
            mode.frequency_hz(),
            100.0 * mode.damping_ratio()
        );
        lines.push(line.trim_end().to_owned());
    }
    if !overdamped.is_empty() {
        lines.push(format!(
            "{} motions die out without vibrating (overdamped); time in ms to 1/e:",
            overdamped.len()
        ));
        lines.extend(overdamped);
    }
    lines
}
