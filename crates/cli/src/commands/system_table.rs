//! The figures of a multibody run for people: what was asked for first, what it took after it.

use std::f64::consts::TAU;

use gearmesh_report::{short, usual_unit};
use gearmesh_scene::system_run::{
    ColumnSummary, EigenResult, MeshPassing, RunRecord, SystemResult, is_overdamped, is_prominent,
    noticeable, rank, shares_in_words, split_unit,
};

use crate::commands::periods::MARK;
use crate::commands::{mesh_axes, ratings};
use crate::failure::Failure;

/// Lines of the table of columns; all are in the JSON and in the file.
const MOST_LINES: usize = 40;

/// Columns of the tables of sweeps and equilibria.
const MOST_COLUMNS: usize = 5;

/// Bodies and force elements named with a mode.
const MOST_SHARES: usize = 3;

/// The figures for people.
pub fn table(result: &SystemResult) -> Result<Vec<String>, Failure> {
    let mut lines = vec![format!("{}: {}", result.head.title, result.kind)];
    lines.extend(match &result.kind[..] {
        "transient" => columns(result)?,
        "speed-sweep" => sweep(result),
        "static" => [equilibria(result)?, mesh_axes::lines(result)?].concat(),
        _ => result.eigen.iter().flat_map(|p| modes(result, p)).collect(),
    });
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

fn columns(result: &SystemResult) -> Result<Vec<String>, Failure> {
    let mut found = result.summaries(is_prominent).map_err(Failure::work)?;
    let passings = result.mesh_passings().map_err(Failure::work)?;
    let all = found.len();
    let mut shown = {
        let extremes = found
            .iter()
            .map(|c| (&*c.name, c.figures.least, c.figures.largest));
        noticeable(extremes).into_iter()
    };
    found.retain(|_| shown.next().unwrap_or(false));
    found.sort_by_key(|column| rank(&column.name));
    let stems = found.iter().map(|column| split_unit(&column.name).0);
    let width = stems
        .take(MOST_LINES)
        .map(|stem| stem.chars().count())
        .max();
    let width = width.unwrap_or(0).max(6);
    let mut lines = vec![format!(
        "{:width$} {:<7} {:>11} {:>11} {:>11} {:>12}",
        "column", "unit", "mean", "deviation", "pk-pk", "dominant Hz"
    )];
    for ColumnSummary {
        name,
        figures,
        dominant_hz,
    } in found.iter().take(MOST_LINES)
    {
        let (stem, unit) = split_unit(name);
        let largest = figures.least.abs().max(figures.largest.abs());
        let (factor, unit) = usual_unit(unit, largest);
        let dominant = dominant_hz.map_or("-".to_owned(), |hz| format!("{hz:.3}"));
        lines.push(format!(
            "{stem:width$} {unit:<7} {:>11} {:>11} {:>11} {dominant:>12}{}",
            short(factor * figures.mean),
            short(factor * figures.deviation),
            short(factor * figures.peak_to_peak()),
            incomplete(&passings, name)
        ));
    }
    let shown = found.len().min(MOST_LINES);
    if shown < all {
        let zero = all - found.len();
        lines.push(format!(
            "and {} more, {zero} of them zero but for rounding",
            all - shown
        ));
    }
    lines.extend(passings.iter().map(MeshPassing::in_words));
    Ok(lines)
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
    let mut chosen: Vec<(usize, &String)> = sweep.columns.iter().enumerate().collect();
    chosen.retain(|(place, name)| varying[*place] && is_prominent(name));
    chosen.sort_by_key(|(_, name)| rank(name));
    chosen.truncate(MOST_COLUMNS);
    let mut head = format!("{:>12} {:>5}", "speed rpm", "way");
    let mut factors = Vec::new();
    for (column, name) in &chosen {
        let (stem, unit) = split_unit(name);
        let windows = sweep.figures.iter();
        let largest = windows.fold(0.0, |most: f64, figures| {
            most.max(figures[*column].peak_to_peak())
        });
        let (factor, unit) = usual_unit(unit, largest);
        factors.push(factor);
        head += &format!(" {:>32}", format!("pk-pk {} {unit}", last_parts(stem)));
    }
    let mut lines = vec![head];
    for (window, figures) in sweep.windows.iter().zip(&sweep.figures) {
        let mut line = format!(
            "{:>12.3} {:>5}",
            window.speed_rad_per_s * 60.0 / TAU,
            if window.up { "up" } else { "down" }
        );
        for ((column, _), factor) in chosen.iter().zip(&factors) {
            line += &format!(" {:>32}", short(factor * figures[*column].peak_to_peak()));
        }
        lines.push(line);
    }
    lines.extend(result.incomplete_windows());
    lines
}

/// The last two parts of a column's name.
fn last_parts(name: &str) -> String {
    let parts: Vec<&str> = name.split('/').collect();
    let last = parts[parts.len().saturating_sub(2)..].join("/");
    let cut = last.chars().count().saturating_sub(22);
    last.chars().skip(cut).collect()
}

/// One line a column: the value where there is one equilibrium, mean and extremes over several.
fn equilibria(result: &SystemResult) -> Result<Vec<String>, Failure> {
    let mut found = Vec::new();
    for column in result.rows.columns() {
        if is_prominent(&column.name) || column.name.ends_with("/turn_rad") {
            let values = result.rows.read(&column.name).map_err(Failure::work)?;
            found.push((&column.name, values));
        }
    }
    let least = |values: &[f64]| values.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = |values: &[f64]| values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let mut shown = {
        let extremes = found
            .iter()
            .map(|(name, values)| (name.as_str(), least(values), largest(values)));
        noticeable(extremes).into_iter()
    };
    found.retain(|_| shown.next().unwrap_or(false));
    found.sort_by_key(|(name, _)| rank(name));
    let stems = found.iter().map(|(name, _)| split_unit(name).0);
    let width = stems
        .take(MOST_LINES)
        .map(|stem| stem.chars().count())
        .max();
    let width = width.unwrap_or(0).max(6);
    let rows = result.rows.rows();
    let heads: &[&str] = match rows {
        1 => &["value"],
        _ => &["mean", "least", "largest", "pk-pk"],
    };
    let head: String = heads.iter().map(|head| format!(" {head:>11}")).collect();
    let mut lines = vec![format!("{:width$} {:<7}{head}", "column", "unit")];
    for (name, values) in found.iter().take(MOST_LINES) {
        let (stem, unit) = split_unit(name);
        let (least, largest) = (least(values), largest(values));
        let (factor, unit) = usual_unit(unit, least.abs().max(largest.abs()));
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let figures = [mean, least, largest, largest - least];
        let figures = figures.iter().take(heads.len());
        let cells: String = figures
            .map(|x| format!(" {:>11}", short(factor * x)))
            .collect();
        lines.push(format!("{stem:width$} {unit:<7}{cells}"));
    }
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
    let mut overdamped = Vec::new();
    for (k, mode) in found.modes.iter().enumerate() {
        let moves = shares_in_words(&result.bodies, &found.participation[k], MOST_SHARES);
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
