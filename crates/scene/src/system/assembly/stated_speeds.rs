//! Speeds that bodies state against what their joints allow: what does not fit would be dropped at the start without a
//! word.

use std::f64::consts::TAU;

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::InputDocument;
use gearmesh_specification::system::body::BodyTable;
use gearmesh_specification::system::joint::JointWord;
use nalgebra::Vector3;

use super::bodies::Bodies;
use super::joints::PlacedJoint;

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
                Some(joint.seat.frame.axes * Vector3::z())
            }
        };
        // What nobody knows adapts.
        let knows = |end: &Option<usize>| end.is_none_or(|body| !bodies.list[body].speed_is_free);
        let ends = joint.seat.ends;
        if !ends.iter().all(knows) {
            continue;
        }
        let turning = |body: usize| bodies.list[body].turning();
        let [first, second] = ends.map(|end| end.map_or_else(Vector3::zeros, turning));
        let relative = second - first;
        let across = match free_axis {
            Some(axis) => relative - axis * axis.dot(&relative),
            None => relative,
        };
        if across.norm() <= ACROSS * first.norm().max(second.norm()) {
            continue;
        }
        let states = |body: &usize| tables.get(*body).is_some_and(|b| b.speed_rpm.is_some());
        let Some(place) = ends.into_iter().rev().flatten().find(states) else {
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
        let problem = format!(
            "`{}` turns by {:.6} rpm in a way that joint `{name}` ({kind}) does not allow: the body's z axis is [{:.4}, {:.4}, {:.4}], and the \
             joint {allowed}; turn the body (cardan_deg) or the joint (axis) so that they fit, or leave the speed out",
            tables[place].name,
            across.norm() * 60.0 / TAU,
            axis[0],
            axis[1],
            axis[2]
        );
        return Err(document.error(&format!("body.{place}.speed_rpm"), problem));
    }
    Ok(())
}
