//! How fast bodies turn at the start whose speed nobody states: as their motion, shaft, fixed joint or mesh asks, on
//! axes that may be carried round.
//!
//! ```text
//! z₁ (ω₁ − ω_c) + z₂ (ω₂ − ω_c) = 0        ω_c: turn of the line of centres (mesh_frequency.rs); Willis' equation
//! ```

use std::f64::consts::TAU;

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::InputDocument;
use gearmesh_specification::system::connection::TorsionSpringTable;
use gearmesh_specification::system::joint::JointWord;
use gearmesh_specification::system::mesh_model::MeshKind;
use nalgebra::Vector3;

use super::bodies::{Bodies, Seat};
use super::carriers::{self, Carried, Holds};
use super::gear_mesh::PreparedMesh;
use super::joints::{PlacedJoint, PlacedMotion};
use super::mesh_frequency::carrier_rad_per_s;
use super::willis::Planets;

/// Share by which speeds that a scene states on both gears of a `kinematic` mesh may miss its ratio: they are written
/// with a few figures.
const RATIO_IS_MET: f64 = 1e-6;

/// Distance from an axis that counts as none \[m\]: rounding of places.
pub(super) const ON_AXIS_M: f64 = 1e-12;

/// The speed about its joint's axis that a motion gives \[rad/s\], where it drives an angle.
type SpinOf<'a> = &'a dyn Fn(&PlacedMotion) -> Option<f64>;

/// Gives speeds to bodies whose speed nobody states: those of motions, of the shaft or body that they are fixed to, and
/// of the gears they mesh with. Bodies on a carrier that turns go along with it. A carrier that nobody drives stands.
pub(super) fn settle_speeds(
    bodies: &mut Bodies,
    holds: Holds<'_>,
    (motions, spin_of): (&[PlacedMotion], SpinOf<'_>),
    meshes: &[PreparedMesh],
    notes: &mut Vec<String>,
) {
    let carried = carriers::find(bodies, holds);
    let groups = fixed_groups(&holds);
    let planets = Planets::find(bodies, &carried, meshes);
    stand_on_the_ground(bodies, &holds);
    loop {
        let mut settled = false;
        for motion in motions {
            if let Some(spin) = spin_of(motion) {
                settled |= drive(bodies, &holds.joints[motion.joint], spin, notes);
            }
        }
        for one in &carried {
            one.go_along(bodies);
        }
        for (group, name) in &groups {
            settled |= turn_together(bodies, group, name, notes);
        }
        for mesh in meshes {
            let is_known = |gear: &usize| place_is_known(bodies, &carried, *gear);
            if mesh.bodies.iter().all(is_known) {
                settled |= follow_mesh(bodies, mesh, notes);
            }
        }
        if settled {
            continue;
        }
        if let Some((body, spin)) = planets.first_settled(bodies, &groups) {
            let name = || "the meshes of planets".to_owned();
            if settle(bodies, body, spin, name, notes) {
                continue;
            }
        }
        // What carries others and is driven by nobody stands, so that the rest can follow.
        let mut carriers = carried.iter().filter_map(|one| one.carrier);
        let Some(free) = carriers.find(|&body| bodies.list[body].speed_is_free) else {
            return;
        };
        bodies.list[free].speed_is_free = false;
    }
}

/// Whether everything that takes a body round has its speed; what stands on the body's own axis does not.
fn place_is_known(bodies: &Bodies, carried: &[Carried], body: usize) -> bool {
    let carrier = |body: usize| carried.iter().find(|one| one.body == body)?.carrier;
    let mut on = body;
    while bodies.list[on].velocity_is_free {
        match carrier(on) {
            None => return true,
            Some(next) => {
                let [led, leading] = [on, next].map(|body| &bodies.list[body]);
                let arm = (led.body.position_m - leading.body.position_m).cross(&leading.axis());
                if leading.speed_is_free && arm.norm() > ON_AXIS_M {
                    return false;
                }
                on = next;
            }
        }
    }
    true
}

/// What is fixed to the ground does not turn.
fn stand_on_the_ground(bodies: &mut Bodies, holds: &Holds<'_>) {
    for joint in holds.joints {
        if let (JointWord::Fixed, [None, Some(body)] | [Some(body), None]) =
            (joint.table.kind, joint.seat.ends)
        {
            bodies.list[body].speed_is_free = false;
        }
    }
}

/// Bodies that turn as one, and what joins them.
fn fixed_groups(holds: &Holds<'_>) -> Vec<(Vec<usize>, String)> {
    let of_shafts = holds.shafts.iter();
    let mut groups: Vec<(Vec<usize>, String)> = of_shafts
        .map(|shaft| (shaft.bodies().collect(), shaft.describe()))
        .collect();
    for joint in holds.joints {
        if let (JointWord::Fixed, [Some(a), Some(b)]) = (joint.table.kind, joint.seat.ends) {
            groups.push((vec![a, b], format!("joint `{}`", joint.table.name)));
        }
    }
    groups
}

/// A motion turns body 2 of its joint against body 1.
fn drive(
    bodies: &mut Bodies,
    joint: &PlacedJoint<'_>,
    spin_rad_per_s: f64,
    notes: &mut Vec<String>,
) -> bool {
    let Seat { ends, frame } = joint.seat;
    let axis = frame.axes * Vector3::z();
    // The speed of an end about the axis, and whether that is known; none where it turns about another axis.
    let about = |end: Option<usize>| match end {
        None => Some((0.0, true)),
        Some(body) => {
            let placed = &bodies.list[body];
            let sense = placed.axis().dot(&axis);
            let spin = placed.spin() * sense.signum();
            (sense.abs() > 1.0 - 1e-9).then_some((spin, !placed.speed_is_free))
        }
    };
    // What the motion turns, how fast about the axis, and whether that is its own axis.
    let (led, spin, is_own) = match (ends, about(ends[0]), about(ends[1])) {
        ([_, Some(led)], Some((base, true)), Some((_, false))) => {
            (led, base + spin_rad_per_s, true)
        }
        ([Some(led), _], Some((_, false)), Some((end, true))) => (led, end - spin_rad_per_s, true),
        ([_, Some(led)], Some((base, true)), None) => (led, base + spin_rad_per_s, false),
        ([Some(led), _], None, Some((end, true))) => (led, end - spin_rad_per_s, false),
        _ => return false,
    };
    let from = || "its motion".to_string();
    if is_own {
        let sense = bodies.list[led].axis().dot(&axis).signum();
        return settle(bodies, led, spin * sense, from, notes);
    }
    let along = bodies.list[led].body.orientation.inverse() * axis;
    settle_about(bodies, led, (along, spin), from, notes)
}

fn turn_together(
    bodies: &mut Bodies,
    group: &[usize],
    name: &str,
    notes: &mut Vec<String>,
) -> bool {
    let known = group.iter().find(|&&body| !bodies.list[body].speed_is_free);
    let Some(&known) = known else {
        return false;
    };
    let (spin, axis) = (bodies.list[known].spin(), bodies.list[known].axis());
    let mut settled = false;
    for &body in group {
        let sense = bodies.list[body].axis().dot(&axis);
        if sense.abs() > 1.0 - 1e-9 {
            let (spin, from) = (spin * sense.signum(), || name.to_owned());
            settled |= settle(bodies, body, spin, from, notes);
        }
    }
    settled
}

fn follow_mesh(bodies: &mut Bodies, mesh: &PreparedMesh, notes: &mut Vec<String>) -> bool {
    let mut settled = false;
    for (from, to) in [(0, 1), (1, 0)] {
        if !bodies.list[mesh.bodies[from]].speed_is_free {
            let spin = fitting_spin(bodies, mesh, (from, to));
            let name = || format!("mesh `{}`", mesh.built.name);
            settled |= settle(bodies, mesh.bodies[to], spin, name, notes);
        }
    }
    settled
}

/// The speed of one gear of a mesh at which it rolls on the other \[rad/s\].
fn fitting_spin(bodies: &Bodies, mesh: &PreparedMesh, (from, to): (usize, usize)) -> f64 {
    let carrier = carrier_rad_per_s(mesh, bodies);
    let against_carrier = bodies.list[mesh.bodies[from]].spin() - carrier;
    match to {
        1 => carrier - against_carrier / mesh.built.ratio(),
        _ => carrier - against_carrier * mesh.built.ratio(),
    }
}

/// Tells of bodies whose speed nobody states and that a torsion spring joins to one that turns: they start at rest, and
/// the spring jerks them; and of bodies that turn and are held to the ground, as scenes at rest hold their trains.
pub(super) fn note_jerks(bodies: &Bodies, springs: &[TorsionSpringTable], notes: &mut Vec<String>) {
    for spring in springs {
        let find = |name: &str| Some(&bodies.list[bodies.number(name)?]);
        let first = spring.body_1.as_deref().and_then(find);
        let ends = [first, find(&spring.body_2)];
        if spring.body_1.is_none()
            && let Some(placed) = ends[1]
            && placed.spin() != 0.0
        {
            let rpm = placed.spin() * 60.0 / TAU;
            notes.push(format!(
                "torsion spring `{}` joins `{}`, which starts with {rpm:.6} rpm, to the ground: at rest that holds a train, in time it stops it at once. To drive the train, \
                 give the spring a body_1 of its own with a [[joint]] about the shaft's axis and a [[motion]] (`gearmesh import --transient` writes them)",
                spring.name, placed.body.name
            ));
        }
        let [Some(a), Some(b)] = ends else { continue };
        for (led, leading) in [(a, b), (b, a)] {
            let rpm = leading.spin() * 60.0 / TAU;
            let along = led.axis().dot(&leading.axis()).abs() > 1.0 - 1e-9;
            if led.speed_is_free && !leading.speed_is_free && rpm != 0.0 && along {
                notes.push(format!(
                    "body `{}` starts at rest, and torsion spring `{}` joins it to `{}`, which starts with {rpm:.6} rpm: speeds do not follow through springs; state its \
                     speed_rpm if it shall turn from the start",
                    led.body.name, spring.name, leading.body.name
                ));
            }
        }
    }
}

/// Refuses speeds on both gears of a `kinematic` mesh that do not fit its ratio: the joint would change them at the
/// start.
pub(super) fn refuse_missed_ratios(
    bodies: &Bodies,
    meshes: &[PreparedMesh],
    document: &InputDocument,
) -> Result<(), InputError> {
    let is_kinematic = |mesh: &&PreparedMesh| mesh.model == MeshKind::Kinematic;
    for mesh in meshes.iter().filter(is_kinematic) {
        let spin = |gear: usize| bodies.list[mesh.bodies[gear]].spin();
        let fitting = fitting_spin(bodies, mesh, (0, 1));
        let largest = spin(0).abs().max(spin(1).abs()).max(fitting.abs());
        if (spin(1) - fitting).abs() > RATIO_IS_MET * largest {
            let rpm = |spin: f64| spin * 60.0 / TAU;
            let [gear_1, gear_2] = mesh.bodies.map(|body| bodies.name(Some(body)));
            let problem = format!(
                "`{gear_2}` turns at {:.6} rpm at the start; with `{gear_1}` at {:.6} rpm and the line of centres at {:.6} rpm the ratio asks \
                 for {:.6} rpm: correct one of the speeds, or leave it out and it follows",
                rpm(spin(1)),
                rpm(spin(0)),
                rpm(carrier_rad_per_s(mesh, bodies)),
                rpm(fitting)
            );
            return Err(document.error(&format!("{}.gear_2", mesh.key), problem));
        }
    }
    Ok(())
}

/// Sets the speed of a body about its z, if nobody has; says whether it did.
fn settle(
    bodies: &mut Bodies,
    body: usize,
    spin_rad_per_s: f64,
    from: impl Fn() -> String,
    notes: &mut Vec<String>,
) -> bool {
    settle_about(bodies, body, (Vector3::z(), spin_rad_per_s), from, notes)
}

/// Sets the speed of a body about an axis of its own, if nobody has; says whether it did.
fn settle_about(
    bodies: &mut Bodies,
    body: usize,
    (along, spin_rad_per_s): (Vector3<f64>, f64),
    from: impl Fn() -> String,
    notes: &mut Vec<String>,
) -> bool {
    let placed = &mut bodies.list[body];
    if !placed.speed_is_free {
        return false;
    }
    placed.speed_is_free = false;
    placed.body.angular_velocity_rad_per_s = spin_rad_per_s * along;
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
