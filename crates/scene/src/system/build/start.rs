//! What the scene leaves open about the start and the meshes settle: how fast bodies turn, and how far gears are turned so that their teeth
//! touch.

use std::f64::consts::TAU;

use gearmesh_drivetrain::FlankContacts;
use gearmesh_geometry::input::{InputDocument, TableKeys};
use gearmesh_geometry::{FlankSide, InputError};
use nalgebra::Vector3;

use super::bodies::Bodies;
use super::gear_mesh::PreparedMesh;
use super::joints::{PlacedJoint, PlacedMotion};
use super::shafts::PlacedShaft;
use crate::system::tables::UM;
use crate::system::tables::joint::JointWord;

/// Touching is met to this gap \[m\]: far below any deflection, well above rounding.
const TOUCHING_M: f64 = 1e-13;

/// Gives speeds to bodies whose speed nobody states: those of motions, of the shaft or body that they are fixed to, and of the gears they
/// mesh with.
pub(super) fn settle_speeds(
    bodies: &mut Bodies,
    (joints, motions): (&[PlacedJoint<'_>], &[PlacedMotion]),
    shafts: &[PlacedShaft],
    meshes: &[PreparedMesh],
    notes: &mut Vec<String>,
) {
    for motion in motions {
        let joint = &joints[motion.joint];
        if let ([None, Some(body)], Some(spin)) = (joint.ends, motion.spin_at_start()) {
            let axis = joint.frame.axes * Vector3::z();
            let sense = bodies.list[body].axis().dot(&axis);
            if sense.abs() > 1.0 - 1e-9 {
                settle(
                    bodies,
                    body,
                    spin * sense.signum(),
                    || "its motion".to_string(),
                    notes,
                );
            }
        }
    }
    let mut groups: Vec<(Vec<usize>, String)> = shafts
        .iter()
        .map(|shaft| (shaft.bodies().collect(), shaft.describe()))
        .collect();
    for joint in joints {
        if let (JointWord::Fixed, [Some(a), Some(b)]) = (joint.table.kind, joint.ends) {
            groups.push((vec![a, b], format!("joint `{}`", joint.table.name)));
        }
    }
    loop {
        let mut settled = false;
        for (group, name) in &groups {
            let Some(&known) = group.iter().find(|&&body| !bodies.list[body].speed_is_free) else {
                continue;
            };
            let (spin, axis) = (
                bodies.list[known].body.angular_velocity_rad_per_s.z,
                bodies.list[known].axis(),
            );
            for &body in group {
                let sense = bodies.list[body].axis().dot(&axis);
                if sense.abs() > 1.0 - 1e-9 {
                    settled |= settle(bodies, body, spin * sense.signum(), || name.clone(), notes);
                }
            }
        }
        for mesh in meshes {
            for (from, to) in [(0, 1), (1, 0)] {
                let [known, free] = [mesh.bodies[from], mesh.bodies[to]];
                if bodies.list[known].speed_is_free {
                    continue;
                }
                let spin = -bodies.list[known].body.angular_velocity_rad_per_s.z
                    * mesh.teeth[from] as f64
                    / mesh.teeth[to] as f64;
                settled |= settle(
                    bodies,
                    free,
                    spin,
                    || format!("mesh `{}`", mesh.name),
                    notes,
                );
            }
        }
        if !settled {
            return;
        }
    }
}

/// Sets the speed of a body, if nobody has; says whether it did.
fn settle(
    bodies: &mut Bodies,
    body: usize,
    spin_rad_per_s: f64,
    from: impl Fn() -> String,
    notes: &mut Vec<String>,
) -> bool {
    let placed = &mut bodies.list[body];
    if !placed.speed_is_free {
        return false;
    }
    placed.speed_is_free = false;
    placed.body.angular_velocity_rad_per_s = Vector3::new(0.0, 0.0, spin_rad_per_s);
    if spin_rad_per_s != 0.0 {
        let rpm = spin_rad_per_s * 60.0 / TAU;
        notes.push(format!(
            "body `{}` starts with {rpm:.6} rpm, which follows from {}",
            placed.body.name,
            from()
        ));
    }
    true
}

/// Turns gears whose angle nobody states so that their teeth touch, gear 2 where both are free; says what it did and where teeth stand
/// whose angles are stated.
pub(super) fn settle_phases(
    bodies: &mut Bodies,
    meshes: &[PreparedMesh],
    document: &InputDocument,
    notes: &mut Vec<String>,
) -> Result<(), InputError> {
    // A gear that an earlier mesh has turned, or turned others against, stays.
    let mut meshed: Vec<usize> = Vec::new();
    for mesh in meshes {
        let Some(teeth) = &mesh.mesh else {
            continue;
        };
        let free = |i: usize| {
            bodies.list[mesh.bodies[i]].turn_is_free && !meshed.contains(&mesh.bodies[i])
        };
        let turned = [1, 0].into_iter().find(|&i| free(i));
        let side = driven_side(mesh, bodies);
        let keys = TableKeys::new(document, &mesh.key);
        let gap = |bodies: &Bodies, side: FlankSide| {
            let mut found = FlankContacts::default();
            let pose = mesh.pose(bodies);
            teeth
                .kinematics()
                .contacts(&pose, side, &mut found)
                .map_err(|e| keys.error("", e))?;
            let gaps = found.contacts.iter().map(|contact| contact.gap_m);
            Ok::<f64, InputError>(gaps.fold(f64::INFINITY, f64::min))
        };
        let name = &mesh.name;
        if let Some(i) = turned {
            let mut least = gap(bodies, side)?;
            for _ in 0..100 {
                if !least.is_finite() || least.abs() < TOUCHING_M {
                    break;
                }
                // Seen along z, the gap grows with gear 2's turn by σ r_b2; gear 1's opens the other way round.
                let slope = side.mirror() * mesh.base_radii_m[i];
                bodies.list[mesh.bodies[i]].turn(-least / slope);
                least = gap(bodies, side)?;
            }
            if least.is_finite() && least.abs() < UM {
                let body = &bodies.list[mesh.bodies[i]].body;
                let angle = body.orientation.scaled_axis();
                notes.push(format!(
                    "body `{}` is turned so that the {} flanks of mesh `{name}` touch: rotation vector [{:.6}, {:.6}, {:.6}] deg",
                    body.name,
                    side.name(),
                    angle[0].to_degrees(),
                    angle[1].to_degrees(),
                    angle[2].to_degrees()
                ));
            } else {
                return Err(keys.error("", format!("no angle of body `{}` was found at which the {} flanks touch (gap {least:.3e} m); state cardan_deg of both gears", bodies.list[mesh.bodies[i]].body.name, side.name())));
            }
        } else {
            let mut stand = Vec::new();
            for side in &mesh.sides {
                let least = gap(bodies, *side)?;
                let word = if least < 0.0 {
                    "overlap by"
                } else {
                    "are open by"
                };
                stand.push(format!(
                    "the {} flanks {word} {:.3} um",
                    side.name(),
                    least.abs() / UM
                ));
            }
            notes.push(format!(
                "mesh `{name}` starts as the bodies stand: {}",
                stand.join(", ")
            ));
        }
        meshed.extend(mesh.bodies);
    }
    Ok(())
}

/// The side that touches at the start: right where gear 1 turns clockwise or stands.
fn driven_side(mesh: &PreparedMesh, bodies: &Bodies) -> FlankSide {
    let spin = bodies.list[mesh.bodies[0]]
        .body
        .angular_velocity_rad_per_s
        .z;
    let wanted = if spin > 0.0 {
        FlankSide::Left
    } else {
        FlankSide::Right
    };
    let known = mesh.sides.iter().find(|side| **side == wanted);
    known.or(mesh.sides.first()).copied().unwrap_or(wanted)
}
