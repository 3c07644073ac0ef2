//! Bearings that are joints.

use gearmesh_dynamics::JointKind;
use gearmesh_geometry::InputError;
use gearmesh_specification::system::bearing::{BearingModel, HeldWord};

use super::placed_bearing::PlacedBearing;
use crate::system::assembly::connections::Connections;

/// Adds the joints of all rigid bearings.
pub(in crate::system::assembly) fn add(
    connections: &mut Connections<'_>,
) -> Result<(), InputError> {
    let scene = connections.scene;
    for (number, table) in scene.tables.bearing.iter().enumerate() {
        let BearingModel::Rigid(model) = &table.model else {
            continue;
        };
        let PlacedBearing { keys, seat, .. } =
            PlacedBearing::new(scene, number, connections.bodies)?;
        let kind = match (model.axial, model.tilt) {
            (HeldWord::Held, HeldWord::Held) => JointKind::Revolute,
            (HeldWord::Free, HeldWord::Held) => JointKind::Cylindrical,
            (HeldWord::Held, HeldWord::Free) => JointKind::Spherical,
            (HeldWord::Free, HeldWord::Free) => JointKind::PointOnAxis,
        };
        connections.joint(&keys, (&table.name, "rigid bearing"), &seat, kind)?;
    }
    Ok(())
}
