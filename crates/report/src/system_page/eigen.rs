//! Natural frequencies: tables of modes and the Campbell chart.

use std::f64::consts::TAU;

use gearmesh_scene::system_run::{EigenResult, SystemResult, is_overdamped, shares_in_words};

use super::columns::speed_axis;
use crate::page::{Align, Axis, LineChart, LineSeries, LineStyle, Section, SeriesColour, Table};
use crate::short_number::short;

/// Bodies and force elements named with a mode.
const MOST_SHARES: usize = 3;

pub(super) fn eigen(r: &SystemResult) -> Section {
    let mut section = Section::new(format!("{}: natural frequencies", r.head.title));
    section = section.push_all(campbell(r));
    let tables = r.eigen.iter().flat_map(|found| modes_tables(r, found));
    section.push_all(tables.filter(|table| !table.is_empty()))
}

/// Vibrations, and motions that only die out.
fn modes_tables(r: &SystemResult, found: &EigenResult) -> [Table; 2] {
    let mut title = format!("Load factor {}", found.point.load_factor);
    if let Some(speed) = found.point.speed_rad_per_s {
        title += &format!(", {:.2} rpm", speed * 60.0 / TAU);
    }
    let overdamped = Table::new(format!("{title}: motions that die out without vibrating"))
        .columns(Align::Right, ["motion", "ms to 1/e"]);
    let vibrating = Table::new(title).columns(Align::Right, ["mode", "frequency Hz", "damping %"]);
    let [mut vibrating, mut overdamped] = [vibrating, overdamped.folded()].map(|table| {
        table
            .column("share of the kinetic energy", Align::Left)
            .column("share of the strain energy", Align::Left)
    });
    let kinds = found.kinds_in_words(&r.bodies, &r.head.sets);
    for (k, mode) in found.modes.iter().enumerate() {
        let moves = shares_in_words(&r.bodies, &found.participation[k], MOST_SHARES);
        let moves = format!("{}{moves}", kinds[k]);
        let strain = found.strain.get(k);
        let strained = strain.map_or("-".to_owned(), |shares| {
            shares_in_words(&r.elements, shares, MOST_SHARES)
        });
        let number = (k + 1).to_string();
        if is_overdamped(mode) {
            let decay_ms = -1e3 / mode.growth_per_s;
            overdamped.push_row([number, short(decay_ms), moves, strained]);
        } else {
            vibrating.push_row([
                number,
                format!("{:.4}", mode.frequency_hz()),
                format!("{:.3}", 100.0 * mode.damping_ratio()),
                moves,
                strained,
            ]);
        }
    }
    [vibrating, overdamped]
}

/// Frequencies over speed at the first load factor, with the orders of the meshes' teeth.
fn campbell(r: &SystemResult) -> Option<LineChart> {
    let first = r.eigen.first()?.point.load_factor;
    let all = r
        .eigen
        .iter()
        .filter_map(|found| found.point.speed_rad_per_s);
    let (axis, per_unit) = speed_axis(all);
    let mut points: Vec<(f64, &EigenResult)> = r
        .eigen
        .iter()
        .filter(|found| found.point.load_factor.to_bits() == first.to_bits())
        .filter_map(|found| Some((found.point.speed_rad_per_s? * per_unit, found)))
        .collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points.dedup_by(|a, b| a.0.to_bits() == b.0.to_bits());
    if points.len() < 2 {
        return None;
    }
    let modes = points.iter().map(|(_, found)| found.modes.len()).max()?;
    let speeds: Vec<f64> = points.iter().map(|(speed, _)| *speed).collect();
    let mut chart = LineChart::new(
        "Natural frequencies over speed (by rising frequency), with orders of the meshes",
        axis,
        Axis::new("frequency", "Hz"),
    )
    .x_values(speeds.clone());
    for mode in 0..modes {
        let at = |(_, found): &(f64, &EigenResult)| {
            let vibrates = found.modes.get(mode).filter(|m| !is_overdamped(m));
            vibrates.map_or(f64::NAN, |m| m.frequency_hz())
        };
        let values = points.iter().map(at).collect();
        let series = LineSeries::new(format!("mode {}", mode + 1), values);
        chart = chart.series(series.colour(SeriesColour::Palette(mode)));
    }
    for mesh in &r.head.meshes {
        for order in 1..=2 {
            let teeth = (order * mesh.teeth[0]) as f64;
            let values = speeds.iter().map(|rpm| teeth * rpm.abs() / 60.0).collect();
            let name = format!("{}: order {teeth} of {}", mesh.name, mesh.bodies[0]);
            chart = chart.series(LineSeries::new(name, values).style(LineStyle::Dotted));
        }
    }
    Some(chart)
}
