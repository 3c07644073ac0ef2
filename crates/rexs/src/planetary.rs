//! Planetary stages: scenes have no planets, but speeds and torques pass through where one of sun, ring and carrier
//! stands, so that what is before and behind such a stage turns and is loaded as it should be.
//!
//! Willis: ω_s − i₀ ω_r = (1 − i₀) ω_c with i₀ = −z_A z_r/(z_s z_B), the ratio of sun to ring under a carrier that
//! stands; planet A meets the sun, B the ring, both on one shaft, mostly one gear (Niemann, Winter: Maschinenelemente,
//! volume 2, planetary gears).

use crate::ledger::About;
use crate::model::Component;
use crate::power_flow::Link;
use crate::source::Source;
use crate::structure::Structure;
use crate::train::{TorqueSeat, Train};
use crate::units::{ONE, RPM};
use std::collections::{HashMap, HashSet};

/// A member that turns about the common axis: teeth, its shaft in the scene, its words.
struct Member {
    shaft: Option<i64>,
    /// Gear, or the shaft of the carrier: component.
    part: i64,
    name: &'static str,
}

/// What may turn shafts, found once for all stages.
struct Acting {
    /// Shafts on which a load transmits torque, and those on which a brake acts.
    loaded: HashSet<i64>,
    braked: HashSet<i64>,
    /// Gears of meshes by shaft.
    gears: HashMap<i64, HashSet<i64>>,
    /// Shafts at bevel stages, couplings and planetary stages that were joined.
    joined: HashSet<i64>,
}

impl Acting {
    fn of(train: &Train) -> Self {
        let transmitting = train.loads.iter().filter(|l| l.transmits && !l.is_brake);
        let braking = train.loads.iter().filter(|l| l.is_brake);
        let mut gears: HashMap<i64, HashSet<i64>> = HashMap::new();
        for gear in train.meshes.iter().flat_map(|m| m.gears) {
            let seated = &train.gears[gear];
            gears
                .entry(seated.shaft)
                .or_default()
                .insert(seated.gear.id);
        }
        let bevels = train.bevels.iter().map(|b| b.shaft);
        let coupled = train.couplings.iter().flat_map(|c| c.sides);
        Self {
            loaded: transmitting.map(|l| l.shaft).collect(),
            braked: braking.map(|l| l.shaft).collect(),
            gears,
            joined: bevels.chain(coupled).collect(),
        }
    }
}

/// Joins the members of all planetary stages.
pub fn join(source: &Source<'_>, structure: &Structure, train: &mut Train) {
    let mut acting = Acting::of(train);
    let mut pairs_of: HashMap<i64, Vec<(usize, [i64; 2])>> = HashMap::new();
    for (place, stage) in structure.stages().iter().enumerate() {
        let pairs = pairs_of.entry(stage.id).or_default();
        pairs.push((place, stage.gears));
    }
    for stage in source.model.of_kind(&["planetary_stage"]) {
        let parts = structure.partners(stage.id, &["cylindrical_stage"]);
        let mut pairs: Vec<_> = { parts.iter() }
            .filter_map(|id| pairs_of.get(id))
            .flatten()
            .copied()
            .collect();
        pairs.sort_unstable();
        let pairs: Vec<[i64; 2]> = pairs.into_iter().map(|(_, gears)| gears).collect();
        let (about, what) = match members(source, structure, train, (stage, &pairs)) {
            Some((members, ratio)) => couple(source, train, (stage, &mut acting), members, ratio),
            None => (
                About::Lost,
                "sun, ring, planets and carrier were not found as one of each kind".to_owned(),
            ),
        };
        source.leave_out(
            stage,
            about,
            format!("planetary stages have no planets and no mesh in scenes; {what}"),
        );
    }
}

/// Sun, ring and carrier, and i₀.
fn members(
    source: &Source<'_>,
    structure: &Structure,
    train: &Train,
    (stage, pairs): (&Component, &[[i64; 2]]),
) -> Option<([Member; 3], f64)> {
    let in_scene = |ids: Vec<i64>| ids.into_iter().find(|&id| train.shaft(id).is_some());
    let is_ring = |id: i64| {
        let component = source.model.component(id);
        component.is_some_and(|c| c.kind == "ring_gear")
    };
    let mate = |[a, b]: [i64; 2]| {
        let ring = is_ring(b).then_some((b, a));
        ring.or_else(|| is_ring(a).then_some((a, b)))
    };
    let with_ring: Vec<(i64, i64)> = pairs.iter().copied().filter_map(mate).collect();
    let &(ring, planet_b) = with_ring.first()?;
    let shaft_of = |gear: i64| structure.partners(gear, &["shaft"]).first().copied();
    let planets: HashSet<i64> = with_ring.iter().map(|&(_, p)| p).collect();
    let pins: HashSet<i64> = planets.iter().filter_map(|&p| shaft_of(p)).collect();
    let is_planet = |gear: i64| {
        planets.contains(&gear) || shaft_of(gear).is_some_and(|own| pins.contains(&own))
    };
    let with_sun = pairs.iter().filter(|p| !p.iter().any(|&g| is_ring(g)));
    let suns: Vec<(i64, i64)> = with_sun
        .filter_map(|&[a, b]| match (is_planet(a), is_planet(b)) {
            (false, true) => Some((a, b)),
            (true, false) => Some((b, a)),
            _ => None,
        })
        .collect();
    let &(sun, planet_a) = suns.first()?;
    let is_one = suns.iter().all(|s| s.0 == sun) && with_ring.iter().all(|r| r.0 == ring);
    let is_all = suns.len() + with_ring.len() == pairs.len();
    if !is_one || !is_all {
        return None;
    }
    let teeth = |gear: i64| -> Option<f64> {
        let component = source.model.component(gear)?;
        let teeth = source.number(component, "number_of_teeth", ONE).ok()??;
        Some(teeth.abs()).filter(|z| *z > 0.0)
    };
    let ratio = -teeth(planet_a)? * teeth(ring)? / (teeth(sun)? * teeth(planet_b)?);
    let carriers = structure.planetary_shafts(stage.id, "planet_carrier_shaft");
    let carrier = in_scene(carriers.clone());
    let member = |part: i64, name| Member {
        shaft: in_scene(structure.partners(part, &["shaft"])),
        part,
        name,
    };
    Some((
        [
            member(sun, "sun"),
            member(ring, "ring"),
            Member {
                shaft: carrier,
                part: carrier.or(carriers.first().copied())?,
                name: "carrier",
            },
        ],
        ratio,
    ))
}

/// Links the two members that turn; says what was done.
fn couple(
    source: &Source<'_>,
    train: &mut Train,
    (stage, acting): (&Component, &mut Acting),
    members: [Member; 3],
    ratio: f64,
) -> (About, String) {
    let turns = |m: &Member| {
        m.shaft
            .is_some_and(|id| is_driven(source, acting, m.part, id))
    };
    let turning: Vec<bool> = members.iter().map(turns).collect();
    // Speed of the second member over that of the first.
    let (pair, standing, relative) = match turning[..] {
        [true, false, true] => ([0, 2], 1, 1.0 / (1.0 - ratio)),
        [true, true, false] => ([0, 1], 2, 1.0 / ratio),
        [false, true, true] => ([1, 2], 0, -ratio / (1.0 - ratio)),
        _ => {
            let names = members.iter().zip(&turning).filter(|(_, t)| **t);
            let names: Vec<&str> = names.map(|(m, _)| m.name).collect();
            let what = format!(
                "speeds and torques do not pass through: of sun, ring and carrier two must turn, the third one stands; on shafts with a load, another gear or a coupling are: {}",
                if names.is_empty() {
                    "none".to_owned()
                } else {
                    names.join(", ")
                }
            );
            return (About::Lost, what);
        }
    };
    let shafts = pair.map(|i| members[i].shaft.unwrap_or_default());
    let link = train.links.len();
    train.links.push(Link {
        shafts,
        ratio: relative,
    });
    let middle = members[pair[0]].part;
    let point = train
        .gear(middle)
        .and_then(|g| Some(train.shaft(g.shaft)?.frame?.point([g.mid_mm, 0.0, 0.0])));
    for (side, (&shaft, member)) in shafts.iter().zip(pair.map(|i| &members[i])).enumerate() {
        let Some(own) = train.shaft(shaft) else {
            continue;
        };
        let [start, end] = own.ends_mm();
        let along = own.frame.zip(point).map_or(0.0, |(f, p)| f.u_of(p));
        let u_mm = if start < end {
            along.clamp(start, end)
        } else {
            along
        };
        acting.joined.insert(shaft);
        train.planetary.push(TorqueSeat {
            shaft,
            u_mm,
            link: (link, side),
            name: if stage.name.is_empty() {
                format!("{} of {}", member.name, stage.words())
            } else {
                format!("{} of {}", member.name, stage.name)
            },
        });
    }
    let [a, b] = pair.map(|i| members[i].name);
    let what = format!(
        "its {} stands, {b} turns {relative:.6} times as fast as {a}: torques pass through, and act on the shafts of both in the scene; no forces: across the axis they cancel between planets, along the axis those of helical teeth are left out",
        members[standing].name
    );
    (About::Support, what)
}

/// Whether something but the stage itself may turn a shaft: a load that transmits torque, another gear, a coupling to
/// another shaft.
fn is_driven(source: &Source<'_>, acting: &Acting, part: i64, shaft: i64) -> bool {
    let component = source.model.component(shaft);
    let stands = component.is_some_and(|c| {
        let speed = source.number(c, "rotational_speed", RPM).ok().flatten();
        speed == Some(0.0) && matches!(source.flag(c, "defines_speed"), Ok(Some(true)))
    });
    let stands = stands || acting.braked.contains(&shaft);
    let mates = acting.gears.get(&shaft).into_iter().flatten();
    let has_mate = { mates }.any(|gear| *gear != part);
    !stands && (acting.loaded.contains(&shaft) || has_mate || acting.joined.contains(&shaft))
}
