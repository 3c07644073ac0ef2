//! `[[bearing]]` to parts of the system; one file for each kind of model, `cages.rs` and `housing.rs` for the bodies
//! that bearings bring along.

pub(super) mod cages;
mod dynamic;
pub(super) mod housing;
mod linear;
pub(super) mod placed_bearing;
mod quasi_static;
pub(super) mod rigid;
pub(super) mod tangent;

use gearmesh_bearings::Control;
use gearmesh_bearings::faults::Fault;
use gearmesh_geometry::InputError;
use gearmesh_specification::system::bearing::{
    BearingModel, BearingTable, DynamicBearingTable, QuasiStaticBearingTable,
};

use self::placed_bearing::PlacedBearing;
use super::connections::Connections;

/// Adds all bearings that are force elements.
pub(super) fn add(connections: &mut Connections<'_>) -> Result<(), InputError> {
    let scene = connections.scene;
    for (number, table) in scene.tables.bearing.iter().enumerate() {
        let bearing = &PlacedBearing::new(scene, number, connections.bodies)?;
        housing::add(bearing, connections)?;
        warn(bearing, connections)?;
        match &table.model {
            // A joint.
            BearingModel::Rigid(_) => {}
            BearingModel::Linear(model) => linear::add(bearing, model, connections)?,
            BearingModel::QuasiStatic(model) => quasi_static::add(bearing, model, connections)?,
            BearingModel::Dynamic(model) if connections.at_rest => {
                if model.contact.is_some() {
                    // Balls in equilibrium touch by Hertz: another law has no equilibrium here.
                    let problem = "states a law of contact of its own; equilibria and natural frequencies take Hertz' contact: remove it, or run in time from \"as-given\"";
                    return Err(bearing.keys.error("model.contact", problem));
                }
                quasi_static::add(bearing, &at_rest(model), connections)?;
                connections.parts.notes.push(format!(
                    "bearing `{}` is `dynamic`; equilibria and natural frequencies take its balls in equilibrium (`quasi-static`)",
                    table.name
                ));
            }
            BearingModel::Dynamic(model) => dynamic::add(bearing, model, connections)?,
        }
    }
    Ok(())
}

/// Passes on what the bearing's file warns of.
fn warn(bearing: &PlacedBearing<'_>, connections: &mut Connections<'_>) -> Result<(), InputError> {
    let file = match &bearing.table.model {
        BearingModel::QuasiStatic(model) => &model.file,
        BearingModel::Dynamic(model) => &model.file,
        BearingModel::Rigid(_) | BearingModel::Linear(_) => return Ok(()),
    };
    let folder = &connections.scene.folder;
    let found = placed_bearing::read(("model.file", file), folder, &bearing.keys)?;
    let (name, notes) = (&bearing.table.name, &mut connections.parts.notes);
    let told = found.warnings.iter();
    notes.extend(told.map(|warning| format!("warning: bearing `{name}`: {warning}")));
    let spalled = found.definition.faults.iter().any(is_spall);
    if spalled && matches!(bearing.table.model, BearingModel::Dynamic(_)) {
        notes.push(format!(
            "bearing `{name}`: balls leave its spall and strike; once they have bounced the course in time is that of one run among many alike, which another step does not repeat: \
             take its statistics (mean, deviation, spectrum)"
        ));
    }
    Ok(())
}

fn is_spall(fault: &Fault) -> bool {
    matches!(fault, Fault::RaceSpall { .. } | Fault::BallSpall { .. })
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
        control: Control::default(),
        radial_damping_N_s_per_mm: 0.0,
        axial_damping_N_s_per_mm: 0.0,
        tilt_damping_Nm_s_per_rad: 0.0,
        element_loads: model.ball_loads,
    }
}
