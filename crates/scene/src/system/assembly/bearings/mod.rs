//! `[[bearing]]` to parts of the system; one file for each kind of model.

mod linear;
mod quasi_static;

use gearmesh_geometry::InputError;

use super::elements::Connections;
use crate::system::tables::bearing::{BearingModel, BearingTable};

/// Adds all bearings.
pub(super) fn add(
    tables: &[BearingTable],
    connections: &mut Connections<'_>,
) -> Result<(), InputError> {
    for (number, table) in tables.iter().enumerate() {
        match &table.model {
            BearingModel::Linear(model) => linear::add(number, table, model, connections)?,
            BearingModel::QuasiStatic(model) => {
                quasi_static::add(number, table, model, connections)?;
            }
        }
    }
    Ok(())
}
