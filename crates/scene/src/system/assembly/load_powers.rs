//! Power of torques at the speeds of the start: loads that drive where a motion drives already, and torques that do not
//! balance where nothing else holds the train.
//!
//! P = T·ω of each constant torque on a body that turns; positive where it goes in. Functions of time are not judged.

use std::f64::consts::TAU;

use gearmesh_geometry::input::Beside;
use gearmesh_specification::system::SystemTables;
use gearmesh_specification::system::function::FunctionTable;
use gearmesh_specification::system::load::{AxesWord, LoadTable};
use nalgebra::Vector3;

use super::bodies::{Bodies, GROUND_NAME};
use super::joints::PlacedMotion;

/// Power that does not come out, as a share of what goes in, from which it is reported.
const MISSING: f64 = 0.01;

/// Share of a body's speed below which its part along an axis is rounding.
const ROUNDING: f64 = 1e-9;

/// A torque on a body that turns.
struct Power<'a> {
    load: &'a LoadTable,
    torque_nm: f64,
    speed_rpm: f64,
    watts: f64,
}

/// Adds warnings.
pub(super) fn note(
    tables: &SystemTables,
    motions: &[PlacedMotion],
    bodies: &Bodies,
    notes: &mut Vec<String>,
) {
    let powers: Vec<Power<'_>> = (tables.load.iter())
        .filter_map(|load| power(load, bodies))
        .collect();
    let driving = motions
        .iter()
        .find(|motion| motion.spin_at_start().is_some_and(|w| w != 0.0));
    if let Some(motion) = driving {
        for p in powers.iter().filter(|p| p.watts > 0.0) {
            notes.push(format!(
                "warning: load `{}` drives: {} N m on `{}`, which turns at {:.6} rpm, put {:.6} W in, and motion `{}` must brake. A load that takes power has \
                 the sign against the speed: {} N m",
                p.load.name(),
                p.torque_nm,
                p.load.body,
                p.speed_rpm,
                p.watts,
                motion.name(),
                -p.torque_nm
            ));
        }
        return;
    }
    let is_held = !motions.is_empty()
        || !tables.python_element.is_empty()
        || springs_take_power(tables, bodies);
    let sum = |sign: f64| -> f64 { powers.iter().map(|p| (sign * p.watts).max(0.0)).sum() };
    let [into, out] = [sum(1.0), sum(-1.0)];
    if !is_held && (into - out).abs() > MISSING * into.max(out) {
        let names = powers
            .iter()
            .map(|p| format!("`{}` {:+.6} W", p.load.name(), p.watts));
        notes.push(format!(
            "warning: power does not balance at the speeds of the start: loads put {into:.6} W in and take {out:.6} W out ({}). Nothing else holds the train, \
             which gathers or loses speed",
            names.collect::<Vec<_>>().join(", ")
        ));
    }
}

/// Whether a spring between the ground and a body resists a turning of the body that the scene begins with. A spring
/// that holds a body at rest takes no power, and one that does not resist turning takes none either.
fn springs_take_power(tables: &SystemTables, bodies: &Bodies) -> bool {
    let turns = |(first, second): (&Option<String>, &str), axis: Option<[f64; 3]>| {
        let body = match (first.as_deref().unwrap_or(GROUND_NAME), second) {
            (GROUND_NAME, body) | (body, GROUND_NAME) => bodies.number(body),
            _ => None,
        };
        let Some(placed) = body.map(|body| &bodies.list[body]) else {
            return false;
        };
        let along = axis.map_or_else(|| placed.axis(), Vector3::from);
        let along = along.try_normalize(0.0).unwrap_or_else(|| placed.axis());
        let spin = placed.turning();
        along.dot(&spin).abs() > ROUNDING * spin.norm()
    };
    let torsion = tables.torsion_spring.iter().any(|spring| {
        let resists = spring.stiffness_Nm_per_rad != 0.0 || spring.damping_Nm_s_per_rad != 0.0;
        resists && turns((&spring.body_1, &spring.body_2), spring.axis)
    });
    let bushing = tables.bushing.iter().any(|Beside(bushing, own)| {
        let about_z = |diagonal: Option<[f64; 3]>, matrix: Option<[[f64; 6]; 6]>| {
            diagonal.is_some_and(|d| d[2] != 0.0) || matrix.is_some_and(|m| m[5][5] != 0.0)
        };
        let resists = about_z(bushing.stiffness_Nm_per_rad, bushing.stiffness_matrix_SI)
            || about_z(bushing.damping_Nm_s_per_rad, bushing.damping_matrix_SI);
        resists && turns((&own.body_1, &own.body_2), own.axis)
    });
    torsion || bushing
}

fn power<'a>(load: &'a LoadTable, bodies: &Bodies) -> Option<Power<'a>> {
    let Some(FunctionTable::Constant(torque_nm)) = load.torque_Nm else {
        return None;
    };
    let placed = &bodies.list[bodies.number(&load.body)?];
    let spin = placed.body.angular_velocity_rad_per_s;
    let along = Vector3::from(load.along.unwrap_or([0.0, 0.0, 1.0]));
    let along = along.try_normalize(0.0)?;
    let own = match load.axes {
        Some(AxesWord::Body) => along,
        _ if load.along.is_none() => along,
        _ => placed.body.orientation.inverse() * along,
    };
    let speed = own.dot(&spin);
    (speed != 0.0 && torque_nm != 0.0).then_some(Power {
        load,
        torque_nm,
        speed_rpm: speed * 60.0 / TAU,
        watts: torque_nm * speed,
    })
}
