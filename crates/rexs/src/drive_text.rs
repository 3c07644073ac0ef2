//! What drives and loads a scene: the spring that holds each train, torques and forces.

use crate::by_number::grouped;
use crate::gearbox::Train;
use crate::in_time::driven_body;
use crate::ledger::About;
use crate::running::Running;
use crate::source::Source;
use crate::text::{number, numbers, quoted};
use crate::vectors::Frame;
use std::collections::{BTreeMap, HashMap, HashSet};

/// A torque on a shaft about z, at a place along u.
struct Torque {
    shaft: i64,
    u_mm: f64,
    nm: f64,
    name: String,
}

/// A spring that holds a train where its power goes in.
#[derive(Debug, Clone)]
pub struct Held {
    /// Its name in the scene.
    pub spring: String,
    /// The load, or the member of a stage, in whose place it stands.
    pub at: String,
    /// The torque about z that it must put on the shaft, by the balance of power \[N m\].
    pub torque_nm: f64,
}

/// Stiffness with which each train is held where power goes in \[N m/rad\].
const HELD_NM_PER_RAD: f64 = 1e6;

/// Each train is held by a spring about its axis where most power goes in, in time driven there if it turns; all other
/// torques and forces are loads.
///
/// Returns the springs to the ground.
pub fn drive(
    text: &mut String,
    source: &Source<'_>,
    (train, running): (&Train, Running),
    groups: &BTreeMap<i64, usize>,
) -> Vec<Held> {
    let mut held = Vec::new();
    let torques = torques(source, train);
    let mut done: HashSet<usize> = HashSet::new();
    let in_groups = torques.iter();
    let in_groups = in_groups.filter_map(|torque| Some((*groups.get(&torque.shaft)?, torque)));
    let torques_of: HashMap<usize, Vec<&Torque>> = grouped(in_groups);
    for shaft in train.shafts.iter() {
        let Some(&group) = groups.get(&shaft.id) else {
            continue;
        };
        if !done.insert(group) {
            continue;
        }
        let mine = torques_of.get(&group).map_or(&[][..], Vec::as_slice);
        let power = |t: &Torque| t.nm * train.flow.speed_rpm.get(&t.shaft).copied().unwrap_or(1.0);
        let all = mine.iter().copied();
        let input = all.max_by(|a, b| power(a).total_cmp(&power(b)));
        let (body, name) = match input {
            Some(t) => (train.shaft(t.shaft).map(|s| s.body(t.u_mm)), t.name.clone()),
            None => {
                let what = "no torque acts on its train: held at its first station";
                source.assume_of(shaft.id, About::Torque, what);
                (Some(shaft.station_body(0)), shaft.name.clone())
            }
        };
        let Some(body) = body else { continue };
        let at = input.map_or(shaft.id, |t| t.shaft);
        let speed_rpm = train.flow.speed_rpm.get(&at).copied().unwrap_or(0.0);
        if running == Running::InTime
            && speed_rpm != 0.0
            && let Some(on) = train.shaft(at)
        {
            let line = (on.frame.unwrap_or(Frame::WORLD).origin_mm, on.z());
            let driven = driven_body((&name, &body), line, speed_rpm, HELD_NM_PER_RAD);
            text.push_str(&driven);
        } else {
            let spring = format!("held at {name}");
            text.push_str(&format!(
                "\n# Holds the train where its power goes in; its torque is that of the input.\n[[torsion_spring]]\nname = {}\nbody_2 = {}\nstiffness_Nm_per_rad = {}\n",
                quoted(&spring),
                quoted(&body),
                number(HELD_NM_PER_RAD)
            ));
            held.push(Held {
                spring,
                at: name,
                torque_nm: input.map_or(0.0, |t| t.nm),
            });
        }
        other_torques(text, train, mine, input);
    }
    forces(text, train);
    held
}

/// Torques of the loads that transmit power, and those that links put on shafts.
fn torques(source: &Source<'_>, train: &Train) -> Vec<Torque> {
    let transmitting = train.loads.iter().filter(|l| l.transmits);
    let mut torques: Vec<Torque> = transmitting
        .zip(&train.flow.torque_nm)
        .map(|(load, &nm)| Torque {
            shaft: load.shaft,
            u_mm: load.u_mm,
            nm,
            name: load.name.clone(),
        })
        .collect();
    for seat in train.torque_seats() {
        // What the shaft brings to the link, the link takes from the shaft.
        let Some(link) = train.flow.torques_nm(seat.link.0) else {
            if let Some(component) = source.part(seat.shaft) {
                component.leave_out(About::Lost, format!("the torque at {}, which is part of a loop: it depends on stiffness, which a stage without a mesh in the scene does not have. Nothing acts there, what is behind it carries no load", seat.name));
            }
            continue;
        };
        torques.push(Torque {
            shaft: seat.shaft,
            u_mm: seat.u_mm,
            nm: -link[seat.link.1],
            name: format!("torque at {}", seat.name),
        });
    }
    torques
}

/// The torques of a train other than that which goes in where it is held or driven.
fn other_torques(text: &mut String, train: &Train, mine: &[&Torque], input: Option<&Torque>) {
    for &t in mine {
        let is_input = input.is_some_and(|i| std::ptr::eq(i, t));
        if is_input || t.nm == 0.0 {
            continue;
        }
        let Some(on) = train.shaft(t.shaft) else {
            continue;
        };
        text.push_str(&format!(
            "\n[[load]]\nname = {}\nbody = {}\ntorque_Nm = {}\n",
            quoted(&t.name),
            quoted(&on.body(t.u_mm)),
            number(t.nm)
        ));
    }
}

fn forces(text: &mut String, train: &Train) {
    for load in &train.loads {
        let Some(shaft) = train.shaft(load.shaft) else {
            continue;
        };
        let frame = shaft.frame.unwrap_or(Frame::WORLD);
        let body = quoted(&shaft.body(load.u_mm));
        let mut table = |kind: &str, axis: usize, key: &str, value: f64| {
            if value != 0.0 {
                let name = quoted(&format!("{} {kind} {}", load.name, ["u", "v", "w"][axis]));
                text.push_str(&format!(
                    "\n[[load]]\nname = {name}\nbody = {body}\n{key} = {}\nalong = {}\n",
                    number(value),
                    numbers(&frame.axes[axis])
                ));
            }
        };
        for (axis, &force) in load.force_n.iter().enumerate() {
            table("force", axis, "force_N", force);
        }
        for (axis, &moment) in load.moment_nm.iter().enumerate() {
            table("moment", axis + 1, "torque_Nm", moment);
        }
    }
}
