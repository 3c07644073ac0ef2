//! Speeds that bodies state against what their joints allow: what does not fit would be dropped at the start without a
//! word.

use std::f64::consts::TAU;

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{InputDocument, TableKeys};
use nalgebra::Vector3;

use super::bodies::Bodies;
use super::joints::PlacedJoint;
use crate::system::tables::body::BodyTable;
use crate::system::tables::joint::JointWord;

/// Share of a speed that may point across the joint's axis: a milliradian, whose loss changes the speed by 5e-7.
const ACROSS: f64 = 1e-3;

/// Refuses a stated `speed_rpm`, about the body's z, that turns a body in a way that one of its joints does not let it.
pub(super) fn check(
    tables: &[BodyTable],
    bodies: &Bodies,
    joints: &[PlacedJoint<'_>],
    document: &InputDocument,
) -> Result<(), InputError> {
    for joint in joints {
        let free_axis = match joint.table.kind {
            JointWord::Spherical => continue,
            JointWord::Fixed | JointWord::Prismatic => None,
            JointWord::Revolute | JointWord::Cylindrical | JointWord::Planar => {
                Some(joint.frame.axes * Vector3::z())
            }
        };
        // What nobody knows adapts.
        let knows = |end: &Option<usize>| end.is_none_or(|body| !bodies.list[body].speed_is_free);
        if !joint.ends.iter().all(knows) {
            continue;
        }
        let spin = |end: Option<usize>| {
            end.map_or_else(Vector3::zeros, |body| {
                let body = &bodies.list[body].body;
                body.orientation * body.angular_velocity_rad_per_s
            })
        };
        let [first, second] = joint.ends.map(spin);
        let relative = second - first;
        let across = match free_axis {
            Some(axis) => relative - axis * axis.dot(&relative),
            None => relative,
        };
        if across.norm() <= ACROSS * first.norm().max(second.norm()) {
            continue;
        }
        let Some(place) = [joint.ends[1], joint.ends[0]]
            .into_iter()
            .flatten()
            .find(|&body| {
                tables
                    .get(body)
                    .is_some_and(|table| table.speed_rpm.is_some())
            })
        else {
            continue;
        };
        let name = &joint.table.name;
        let kind = joint.table.kind.name();
        let allowed = match free_axis {
            Some(a) => format!(
                "only lets it turn about [{:.4}, {:.4}, {:.4}]",
                a[0], a[1], a[2]
            ),
            None => "does not let it turn".to_owned(),
        };
        let axis = bodies.list[place].axis();
        let body_key = format!("body.{place}");
        return Err(TableKeys::new(document, &body_key).error(
            "speed_rpm",
            format!(
                "`{}` turns by {:.6} rpm in a way that joint `{name}` ({kind}) does not allow: the body's z axis is [{:.4}, {:.4}, {:.4}], and the \
                 joint {allowed}; turn the body (cardan_deg) or the joint (axis) so that they fit, or leave the speed out",
                tables[place].name,
                across.norm() * 60.0 / TAU,
                axis[0],
                axis[1],
                axis[2]
            ),
        ));
    }
    Ok(())
}
