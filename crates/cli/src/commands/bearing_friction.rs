//! Friction torque of a bearing: line of the console, figures of the JSON and of the page.

use gearmesh_bearings::FrictionTorque;
use gearmesh_report::page::KeyFigures;
use gearmesh_report::short;
use serde_json::{Value, json};

/// For the console.
pub(super) fn line(f: &FrictionTorque) -> String {
    let mut text = format!(
        "friction torque {} N m = lubricant {} + load {}",
        short(f.total_nm()),
        short(f.viscous_nm),
        short(f.load_nm)
    );
    if f.seals_nm > 0.0 {
        text += &format!(" + seals {}", short(f.seals_nm));
    }
    text + &if f.speed_rad_per_s > 0.0 {
        format!("; power loss {} W", short(f.power_w()))
    } else {
        "; no power is lost at rest, give --speed-rpm".to_owned()
    }
}

/// For `--json`.
pub(super) fn figures(f: &FrictionTorque) -> Value {
    json!({
        "torque_Nm": f.total_nm(),
        "viscous_Nm": f.viscous_nm,
        "load_Nm": f.load_nm,
        "seals_Nm": f.seals_nm,
        "power_W": f.power_w(),
    })
}

/// For the page.
pub(super) fn at_a_glance(f: &FrictionTorque, figures: KeyFigures) -> KeyFigures {
    figures
        .figure("friction torque", short(f.total_nm()), "N m")
        .figure("power loss", short(f.power_w()), "W")
}
