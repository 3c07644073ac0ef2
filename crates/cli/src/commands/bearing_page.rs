//! The page of `gearmesh bearing --report`: loads round the bearing, contact angles and pressures.

use super::bearing::Answer;
use super::{bearing_clearance, bearing_friction};
use crate::arguments::BearingArguments;
use crate::console;
use gearmesh_bearings::ElementLoad;
use gearmesh_operations::Failure;
use gearmesh_operations::page_file;
use gearmesh_report::page::{
    Align, Axis, KeyFigures, LineChart, LineSeries, Page, PolarChart, Section, Table, Text,
};
use gearmesh_report::{short, short_beside};
use std::path::Path;

/// Writes the page.
///
/// # Errors
/// [`Failure`] where the page cannot be made or the file not be written.
pub fn write(answer: &Answer<'_>, a: &BearingArguments, path: &Path) -> Result<(), Failure> {
    page_file::write(&page(answer, a), path, &console::watch())
}

fn page(answer: &Answer<'_>, a: &BearingArguments) -> Page {
    let list = |values: &[f64]| {
        values
            .iter()
            .map(f64::to_string)
            .collect::<Vec<_>>()
            .join(", ")
    };
    let mut under = format!("under {} N", list(&a.load_N));
    if !a.moment_Nm.is_empty() {
        under += &format!(" and {} N m", list(&a.moment_Nm));
    }
    if !a.tilt_mrad.is_empty() {
        under += &format!(", held at {} mrad", list(&a.tilt_mrad));
    }
    if a.speed_rpm != 0.0 || a.outer_speed_rpm != 0.0 {
        under += &format!(
            ", inner ring {} rpm, outer ring {} rpm",
            a.speed_rpm, a.outer_speed_rpm
        );
    }
    let mut page = Page::new(answer.found.definition.name.clone())
        .subtitle(format!("Rolling bearing {under}"))
        .section(at_a_glance(answer));
    let rows = answer.loads.elements.len();
    for (row, loads) in answer.loads.elements.iter().enumerate() {
        let name = if rows > 1 {
            format!("Row {}", row + 1)
        } else {
            "Balls and rollers".to_owned()
        };
        page = page.section(of_row(answer, row, loads, name));
    }
    if let Some(clearance) = answer.found.definition.operating_clearance() {
        page = page.section(bearing_clearance::section(&clearance));
    }
    page.footer(format!(
        "{} by gearmesh {}",
        a.bearing.display(),
        env!("CARGO_PKG_VERSION")
    ))
}

fn at_a_glance(answer: &Answer<'_>) -> Section {
    let q = answer.pose.to_five();
    let k = answer.stiffness();
    let all = || {
        answer
            .loads
            .elements
            .iter()
            .enumerate()
            .flat_map(|(row, list)| list.iter().map(move |e| (row, e)))
    };
    // What is only rounding of the other components is 0; a tilt moves the balls on their circle.
    let moved = [0, 1, 2]
        .map(|i| q[i].abs())
        .into_iter()
        .fold(0.0, f64::max);
    let radius = answer.bearing.rows[0].pitch_radius_m();
    let tilted = (moved / radius).max(q[3].abs()).max(q[4].abs());
    let load = all()
        .map(|(_, e)| e.inner_load_n.max(e.outer_load_n))
        .fold(0.0, f64::max);
    let pressure = all()
        .flat_map(|(row, e)| answer.bearing.rows[row].peak_pressures_pa(e))
        .fold(0.0, f64::max);
    let life = |value: Option<f64>| match value {
        Some(v) if v.is_finite() => short(v),
        Some(_) => "unlimited".to_owned(),
        None => "not given".to_owned(),
    };
    let millions = "10⁶ turns";
    let figures = KeyFigures::new()
        .figure("largest load of an element", short(load), "N")
        .figure("largest pressure", short(1e-6 * pressure), "MPa")
        .figure(
            "ring moves by x, y, z",
            [0, 1, 2]
                .map(|i| short_beside(1e6 * q[i], 1e6 * moved))
                .join(", "),
            "µm",
        )
        .figure(
            "and tilts about x, y",
            [3, 4]
                .map(|i| short_beside(1e3 * q[i], 1e3 * tilted))
                .join(", "),
            "mrad",
        )
        .figure(
            "stiffness x, y, z",
            [0, 1, 2].map(|i| short(1e-6 * k[i][i])).join(", "),
            "N/µm",
        )
        .figure("L10", life(answer.life.basic_mrev), millions)
        .figure("L10r", life(Some(answer.life.reference_mrev)), millions);
    let figures = match &answer.friction {
        Some(friction) => bearing_friction::at_a_glance(friction, figures),
        None => figures,
    };
    let figures = match answer.life.modified_mrev {
        None => figures,
        modified => figures.figure("L10mr", life(modified), millions),
    };
    let figures = match answer.safety {
        Some(safety) if safety.factor.is_finite() => {
            figures.figure("static safety s₀ = C₀/P₀", short(safety.factor), "")
        }
        _ => figures,
    };
    let mut section = Section::new("At a glance").push(figures);
    for warning in &answer.found.warnings {
        section = section.push(Text::note(format!("Warning: {warning}")));
    }
    for warning in &answer.warnings {
        section = section.push(Text::note(format!("Warning: {warning}")));
    }
    if answer.found.estimate.is_some() {
        section = section.push(Text::note("Number and size of the elements are estimated from the line of a catalogue; gearmesh bearing prints the spread."));
    }
    section
}

fn of_row(answer: &Answer<'_>, row: usize, loads: &[ElementLoad], name: String) -> Section {
    let of = |f: fn(&ElementLoad) -> f64| loads.iter().map(f).collect::<Vec<_>>();
    let polar = PolarChart::new("Load on each element, seen along z", "N")
        .angles_rad(of(|e| e.angle_rad))
        .series("outer race", of(|e| e.outer_load_n))
        .series("inner race", of(|e| e.inner_load_n));
    let mut section = Section::new(name).push(polar);
    // Angles rise from the first element on, at most once round.
    let degrees = of(|e| e.angle_rad.to_degrees());
    let chart = |title: &str, what: &str, unit: &str, inner: Vec<f64>, outer: Vec<f64>| {
        LineChart::new(title, Axis::new("angle", "deg"), Axis::new(what, unit))
            .x_values(degrees.clone())
            .series(LineSeries::new("outer race", outer))
            .series(LineSeries::new("inner race", inner))
    };
    if !answer.of_rollers() {
        section = section.push(chart(
            "Contact angle",
            "contact angle",
            "deg",
            of(|e| e.inner_contact_angle_rad.to_degrees()),
            of(|e| e.outer_contact_angle_rad.to_degrees()),
        ));
    }
    let pressures: Vec<[f64; 2]> = loads
        .iter()
        .map(|e| {
            answer.bearing.rows[row]
                .peak_pressures_pa(e)
                .map(|p| 1e-6 * p)
        })
        .collect();
    let side = |side: usize| pressures.iter().map(|p| p[side]).collect::<Vec<_>>();
    section = section.push(chart("Peak pressure", "pressure", "MPa", side(0), side(1)));
    section.push(table(loads, &pressures))
}

fn table(loads: &[ElementLoad], pressures: &[[f64; 2]]) -> Table {
    let heads = [
        "element",
        "angle deg",
        "inner N",
        "outer N",
        "inner deg",
        "outer deg",
        "inner MPa",
        "outer MPa",
    ];
    let mut table = heads
        .into_iter()
        .fold(Table::new("All elements").folded(), |t, head| {
            t.column(head, Align::Right)
        });
    for (number, (e, p)) in loads.iter().zip(pressures).enumerate() {
        table.push_row([
            (number + 1).to_string(),
            format!("{:.2}", e.angle_rad.to_degrees()),
            short(e.inner_load_n),
            short(e.outer_load_n),
            format!("{:.3}", e.inner_contact_angle_rad.to_degrees()),
            format!("{:.3}", e.outer_contact_angle_rad.to_degrees()),
            short(p[0]),
            short(p[1]),
        ]);
    }
    table
}
