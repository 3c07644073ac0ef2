//! `gearmesh bearing-frequencies`: cage, ball or roller, and passing of the races.

use crate::arguments::BearingFrequenciesArguments;
use crate::commands::bearing;
use crate::console;
use gearmesh_operations::Failure;
use serde_json::json;

/// Runs the command.
pub fn run(a: &BearingFrequenciesArguments) -> Result<(), Failure> {
    let found = bearing::read(&a.bearing)?;
    let sizes = bearing::sizes(&found, a.contact_angle_deg)?;
    let speed = |flag: &str, rpm: f64| {
        if rpm.is_finite() && rpm.abs() <= 1e7 {
            Ok(rpm / 60.0)
        } else {
            Err(Failure::input(format!(
                "{flag}: found {rpm}, allowed is -1e7 to 1e7"
            )))
        }
    };
    let inner_hz = speed("--speed-rpm", a.speed_rpm)?;
    let outer_hz = speed("--outer-speed-rpm", a.outer_speed_rpm)?;
    let f = sizes.frequencies(inner_hz, outer_hz);
    let relative_hz = (inner_hz - outer_hz).abs();
    let rows = [
        ("FTF", "cage", f.cage_hz),
        (
            "BSF",
            "ball or roller about its own axis; a fault on it meets a race at twice that",
            f.element_hz,
        ),
        (
            "BPFO",
            "elements over a place of the outer race",
            f.outer_race_hz,
        ),
        (
            "BPFI",
            "elements over a place of the inner race",
            f.inner_race_hz,
        ),
    ];
    if a.json {
        console::json(&json!({
            "bearing": found.definition.name,
            "inner_speed_Hz": inner_hz,
            "outer_speed_Hz": outer_hz,
            "contact_angle_deg": sizes.contact_angle_rad.to_degrees(),
            "FTF_Hz": f.cage_hz,
            "BSF_Hz": f.element_hz,
            "BPFO_Hz": f.outer_race_hz,
            "BPFI_Hz": f.inner_race_hz,
        }));
        return Ok(());
    }
    console::data(format!(
        "{}: {} elements, contact angle {:.2} deg, inner ring {:.4} Hz, outer ring {:.4} Hz",
        found.definition.name,
        sizes.elements,
        sizes.contact_angle_rad.to_degrees(),
        inner_hz,
        outer_hz
    ));
    console::data("                Hz   per turn of the rings against each other");
    for (name, meaning, hz) in rows {
        let per_turn = if relative_hz > 0.0 {
            format!("{:9.6}", hz / relative_hz)
        } else {
            " ".repeat(9)
        };
        console::data(format!("{name:<5} {hz:>12.5}  {per_turn}  {meaning}"));
    }
    Ok(())
}
