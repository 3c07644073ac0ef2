//! `[[bearing]]` to parts of the system; one file for each kind of model, `cages.rs` and `housing.rs` for the bodies that bearings bring along.

pub(super) mod cages;
mod dynamic;
pub(super) mod housing;
mod linear;
mod quasi_static;
pub(super) mod rigid;
pub(super) mod rolling_bearing;
pub(super) mod tangent;

use gearmesh_bearings::Control;
use gearmesh_bearings::faults::Fault;
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::TableKeys;

use super::elements::Connections;
use crate::system::tables::bearing::{
    BearingModel, BearingTable, ControlWord, DynamicBearingTable, QuasiStaticBearingTable,
};

/// Adds all bearings that are force elements.
pub(super) fn add(
    tables: &[BearingTable],
    connections: &mut Connections<'_>,
) -> Result<(), InputError> {
    for (number, table) in tables.iter().enumerate() {
        if let Some(housing) = &table.housing {
            housing::add(number, table, housing, connections)?;
        }
        let table = &*housing::seated(table);
        warn(number, table, connections)?;
        match &table.model {
            // A joint.
            BearingModel::Rigid(_) => {}
            BearingModel::Linear(model) => linear::add(number, table, model, connections)?,
            BearingModel::QuasiStatic(model) => {
                quasi_static::add(number, table, model, connections)?;
            }
            BearingModel::Dynamic(model) if connections.manner.at_rest => {
                refuse_stated_contact(number, model, connections)?;
                quasi_static::add(number, table, &at_rest(model), connections)?;
                connections.parts.notes.push(format!(
                    "bearing `{}` is `dynamic`; equilibria and natural frequencies take its balls in equilibrium (`quasi-static`)",
                    table.name
                ));
            }
            BearingModel::Dynamic(model) => dynamic::add(number, table, model, connections)?,
        }
    }
    Ok(())
}

/// Passes on what the bearing's file warns of.
fn warn(
    number: usize,
    table: &BearingTable,
    connections: &mut Connections<'_>,
) -> Result<(), InputError> {
    let file = match &table.model {
        BearingModel::QuasiStatic(model) => &model.file,
        BearingModel::Dynamic(model) => &model.file,
        BearingModel::Rigid(_) | BearingModel::Linear(_) => return Ok(()),
    };
    let key = format!("bearing.{number}");
    let keys = TableKeys::new(connections.document, &key);
    let found = rolling_bearing::read("model.file", file, connections.folder, &keys)?;
    let name = &table.name;
    let told = found.warnings.iter();
    let notes = told.map(|warning| format!("warning: bearing `{name}`: {warning}"));
    connections.parts.notes.extend(notes);
    let spalled = found.definition.faults.iter().any(is_spall);
    if spalled && matches!(table.model, BearingModel::Dynamic(_)) {
        connections.parts.notes.push(format!(
            "bearing `{name}`: balls leave its spall and strike; once they have bounced the course in time is that of one run among many alike, which another step does not repeat: \
             take its statistics (mean, deviation, spectrum)"
        ));
    }
    Ok(())
}

fn is_spall(fault: &Fault) -> bool {
    matches!(fault, Fault::RaceSpall { .. } | Fault::BallSpall { .. })
}

/// Balls in equilibrium touch by Hertz: another law has no equilibrium here.
fn refuse_stated_contact(
    number: usize,
    model: &DynamicBearingTable,
    connections: &Connections<'_>,
) -> Result<(), InputError> {
    if model.contact.is_none() {
        return Ok(());
    }
    let key = format!("bearing.{number}");
    let keys = TableKeys::new(connections.document, &key);
    let problem = "states a law of contact of its own; equilibria and natural frequencies take Hertz' contact: remove it, or run in time from \"as-given\"";
    Err(keys.error("model.contact", problem))
}

/// How balls roll.
fn control(word: ControlWord) -> Control {
    match word {
        ControlWord::OuterRace => Control::OuterRace,
        ControlWord::LeastSpin => Control::LeastSpin,
    }
}

/// Whether there are balls that move.
pub(super) fn any_dynamic(tables: &[BearingTable]) -> bool {
    let is_dynamic = |table: &BearingTable| matches!(table.model, BearingModel::Dynamic(_));
    tables.iter().any(is_dynamic)
}

/// What a `dynamic` bearing is where nothing moves.
fn at_rest(model: &DynamicBearingTable) -> QuasiStaticBearingTable {
    QuasiStaticBearingTable {
        file: model.file.clone(),
        control: ControlWord::default(),
        radial_damping_N_s_per_mm: 0.0,
        axial_damping_N_s_per_mm: 0.0,
        tilt_damping_Nm_s_per_rad: 0.0,
        element_loads: model.ball_loads,
    }
}
