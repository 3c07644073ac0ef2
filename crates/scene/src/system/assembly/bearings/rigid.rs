//! Bearings that are joints.

use gearmesh_dynamics::{Joint, JointKind, SystemBuilder};
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{InputDocument, TableKeys};

use super::housing::seated;
use crate::system::assembly::bodies::Bodies;
use crate::system::assembly::elements::pair;
use crate::system::assembly::parts::Parts;
use crate::system::tables::bearing::{BearingModel, BearingTable, HeldWord};

/// Adds the joints of all rigid bearings.
pub(in crate::system::assembly) fn add(
    tables: &[BearingTable],
    document: &InputDocument,
    bodies: &Bodies,
    builder: &mut SystemBuilder,
    parts: &mut Parts,
) -> Result<(), InputError> {
    for (number, table) in tables.iter().enumerate() {
        let BearingModel::Rigid(model) = &table.model else {
            continue;
        };
        let key = format!("bearing.{number}");
        let keys = TableKeys::new(document, &key);
        let table = seated(table);
        let ends = bodies.find_pair(&keys, table.body_1.as_deref(), &table.body_2)?;
        let frame = bodies.stated_frame(&keys, ends[1], table.at_mm, table.axis)?;
        let kind = match (model.axial, model.tilt) {
            (HeldWord::Held, HeldWord::Held) => JointKind::Revolute,
            (HeldWord::Free, HeldWord::Held) => JointKind::Cylindrical,
            (HeldWord::Held, HeldWord::Free) => JointKind::Spherical,
            (HeldWord::Free, HeldWord::Free) => JointKind::PointOnAxis,
        };
        let at = pair(bodies, ends, &frame);
        let joint = Joint::new(&table.name, kind, at.a, at.b);
        builder.joint(joint.map_err(|e| keys.error("", e))?);
        parts.joint(&table.name, "rigid bearing", bodies, ends);
    }
    Ok(())
}
