//! The clearance of a fitted, warm bearing, term by term: lines of the console, figures of the JSON, table of the page.

use super::bearing::rounded;
use gearmesh_bearings::OperatingClearance;
use gearmesh_bearings::fit::SeatInOperation;
use gearmesh_report::page::{Align, Section, Table, Text};
use serde_json::{Value, json};

/// Terms of the radial clearance in the order in which they add up: what it is, its key, micrometres.
fn terms(c: &OperatingClearance) -> [(&'static str, &'static str, f64); 6] {
    [
        ("stated", "stated_um", c.stated_m),
        ("inner ring on the shaft", "by_shaft_um", c.by_shaft_m),
        ("outer ring in the housing", "by_housing_um", c.by_housing_m),
        (
            "heat of the inner ring",
            "by_inner_ring_heat_um",
            c.by_inner_heat_m,
        ),
        (
            "heat of the outer ring",
            "by_outer_ring_heat_um",
            c.by_outer_heat_m,
        ),
        (
            "heat of balls or rollers",
            "by_element_heat_um",
            c.by_element_heat_m,
        ),
    ]
    .map(|(what, key, metres)| (what, key, 1e6 * metres + 0.0))
}

/// The seats that there are.
fn seats(c: &OperatingClearance) -> impl Iterator<Item = (&'static str, SeatInOperation)> {
    let both = [("shaft", c.shaft), ("housing", c.housing)];
    both.into_iter()
        .filter_map(|(name, seat)| Some((name, seat?)))
}

/// For the console.
pub(super) fn lines(c: &OperatingClearance) -> Vec<String> {
    let changes: Vec<String> = terms(c)
        .iter()
        .skip(1)
        .map(|(what, _, um)| format!("{what} {:+.2}", rounded(*um, 2)))
        .collect();
    let mut lines = vec![format!(
        "radial clearance in operation {:.2} um = stated {:.2}; {}",
        1e6 * c.operating_m(),
        1e6 * c.stated_m,
        changes.join(", ")
    )];
    for (name, seat) in seats(c) {
        let interference = 1e6 * seat.interference_m;
        lines.push(if seat.pressure_pa > 0.0 {
            format!(
                "{name}: interference in operation {interference:.2} um, pressure {:.2} MPa, stress round the ring {:.1} MPa",
                1e-6 * seat.pressure_pa,
                1e-6 * seat.hoop_stress_pa
            )
        } else {
            format!("{name}: loose in operation by {:.2} um: the ring may creep on its seat", -interference)
        });
    }
    lines
}

/// For `--json`.
pub(super) fn figures(c: &OperatingClearance) -> Value {
    let mut value = json!({ "operating_um": 1e6 * c.operating_m() });
    for (_, key, um) in terms(c) {
        value[key] = json!(um);
    }
    for (name, seat) in seats(c) {
        value[name] = json!({
            "interference_um": 1e6 * seat.interference_m,
            "pressure_MPa": 1e-6 * seat.pressure_pa,
            "hoop_stress_MPa": 1e-6 * seat.hoop_stress_pa,
        });
    }
    value
}

/// For the page.
pub(super) fn section(c: &OperatingClearance) -> Section {
    let mut table = Table::new("From the stated clearance to that in operation")
        .column("", Align::Left)
        .column("radial clearance µm", Align::Right);
    for (what, _, um) in terms(c) {
        table.push_row([what.to_owned(), format!("{um:.2}")]);
    }
    table.push_row([
        "in operation".to_owned(),
        format!("{:.2}", 1e6 * c.operating_m()),
    ]);
    let mut section = Section::new("Clearance").push(table);
    for line in lines(c).into_iter().skip(1) {
        section = section.push(Text::note(line));
    }
    section
}
