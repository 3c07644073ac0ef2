//! Planetary stages: speeds and torques pass through where one of sun, ring and carrier stands. Where the file says
//! enough the scene has the whole set (`planetary_set.rs`), else torques on two shafts, so that what is before and
//! behind the stage turns and is loaded as it should be.
//!
//! Willis: ω_s − i₀ ω_r = (1 − i₀) ω_c with i₀ = −z_A z_r/(z_s z_B), the ratio of sun to ring under a carrier that
//! stands; planet A meets the sun, B the ring, both on one shaft, mostly one gear (Niemann, Winter: Maschinenelemente,
//! volume 2, planetary gears).

use crate::gearbox::{TorqueSeat, Train};
use crate::ledger::About;
use crate::planetary_parts::members;
pub use crate::planetary_parts::{Member, Parts};
use crate::planetary_set;
use crate::power_flow::Link;
use crate::source::{Part, Source};
use crate::structure::Stage;
use crate::units::RPM;
use std::collections::{HashMap, HashSet};

/// What may turn shafts, found once for all stages.
struct Acting {
    /// Shafts on which a load transmits torque, and those on which a brake acts.
    loaded: HashSet<i64>,
    braked: HashSet<i64>,
    /// Gears of meshes by shaft.
    gears: HashMap<i64, HashSet<i64>>,
    /// Shafts at bevel stages, couplings and planetary stages that were joined.
    joined: HashSet<i64>,
    /// Shafts from one planetary stage to another: of two or more, in one of them of its sun or carrier.
    shared: HashSet<i64>,
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
        let bevels = train.bevels.iter().map(|b| b.seat.shaft);
        let coupled = train.couplings.iter().flat_map(|c| c.sides);
        Self {
            loaded: transmitting.map(|l| l.shaft).collect(),
            braked: braking.map(|l| l.shaft).collect(),
            gears,
            joined: bevels.chain(coupled).collect(),
            shared: HashSet::new(),
        }
    }

    /// Finds the shafts from one planetary stage to another.
    fn share(&mut self, all: &[(Part<'_>, Parts)]) {
        let mut stages_on: HashMap<i64, (usize, bool)> = HashMap::new();
        for member in all.iter().flat_map(|(_, parts)| &parts.members) {
            if let Some(shaft) = member.shaft {
                let (count, passes) = stages_on.entry(shaft).or_default();
                *count += 1;
                *passes |= member.name != "ring";
            }
        }
        let shared = stages_on
            .into_iter()
            .filter(|(_, (count, passes))| *count > 1 && *passes);
        self.shared = shared.map(|(shaft, _)| shaft).collect();
    }
}

/// Joins the members of all planetary stages.
pub fn join(source: &Source<'_>, train: &mut Train) {
    let mut acting = Acting::of(train);
    let mut pairs_of: HashMap<i64, Vec<(usize, Stage)>> = HashMap::new();
    for (place, stage) in source.structure.stages().iter().enumerate() {
        pairs_of.entry(stage.id).or_default().push((place, *stage));
    }
    let mut in_sets: HashSet<i64> = HashSet::new();
    let mut all = Vec::new();
    for stage in source.of_kind(&["planetary_stage"]) {
        let stages = stage.partners(&["cylindrical_stage"]);
        let mut pairs: Vec<_> = { stages.iter() }
            .filter_map(|id| pairs_of.get(id))
            .flatten()
            .copied()
            .collect();
        pairs.sort_unstable_by_key(|(place, _)| *place);
        let pairs: Vec<Stage> = pairs.into_iter().map(|(_, stage)| stage).collect();
        match members(source, train, (stage, &pairs)) {
            Some(parts) => all.push((stage, parts)),
            None => {
                let what = "sun, ring, planets and carrier were not found as one of each kind; the scene has no planets and no mesh of it";
                stage.leave_out(About::Lost, what);
            }
        }
    }
    acting.share(&all);
    for (stage, parts) in all {
        let Some((standing, link)) = link(source, train, (stage, &acting), &parts) else {
            continue;
        };
        let turning: Vec<usize> = (0..3).filter(|member| *member != standing).collect();
        let shafts = turning.iter().filter_map(|&i| parts.members[i].shaft);
        acting.joined.extend(shafts);
        match planetary_set::read(source, train, (stage, &parts), (standing, link)) {
            Ok(set) => {
                in_sets.extend(&parts.planets);
                in_sets.insert(parts.members[1].part);
                train.sets.push(set);
            }
            Err(reason) => {
                let told = torques(train, (stage, &parts), (&turning, link));
                let what = format!(
                    "the scene has no planets and no mesh of it ({reason}); its {} stands, {told}",
                    parts.members[standing].name
                );
                stage.leave_out(About::Support, what);
            }
        }
    }
    list_left_out(source, train, &in_sets);
}

/// Gears on no shaft, and bearings of planets, that no set has.
fn list_left_out(source: &Source<'_>, train: &Train, in_sets: &HashSet<i64>) {
    for seated in train.gears.iter().filter(|g| g.shaft < 0) {
        let id = seated.gear.id;
        let Some(component) = source.part(id).filter(|_| !in_sets.contains(&id)) else {
            continue;
        };
        // Planets stand on pins.
        let shafts = source.structure.partners(id, &["shaft"]);
        let is_planet = |id: &i64| source.structure.planetary_role(*id).is_some();
        let about = match shafts.iter().any(is_planet) || seated.gear.internal {
            true => About::Nothing,
            false => About::Lost,
        };
        let what = "on no shaft of the scene: its file is written, the scene does not have it";
        component.leave_out(about, what);
    }
    let planets = { in_sets.iter() }.flat_map(|gear| source.structure.partners(*gear, &["shaft"]));
    let mut told: HashSet<i64> = HashSet::new();
    for shaft in planets {
        let own = train.of_planets.get(&shaft).into_iter().flatten();
        told.extend(own.map(|bearing| bearing.id));
    }
    for bearing in train.of_planets.values().flatten() {
        if told.insert(bearing.id)
            && let Some(component) = source.part(bearing.id)
        {
            component.leave_out(About::Nothing, "on no shaft of the scene");
        }
    }
}

/// Links the two members that turn: which one stands, and the link.
fn link(
    source: &Source<'_>,
    train: &mut Train,
    (stage, acting): (Part<'_>, &Acting),
    parts: &Parts,
) -> Option<(usize, usize)> {
    let (members, ratio) = (&parts.members, parts.ratio);
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
                "the scene has no planets and no mesh of it, and speeds and torques do not pass through (differentials, of which three members turn, are not taken over): of sun, ring and carrier two must turn, the third one stands; on shafts with a load, another gear or a coupling are: {}",
                if names.is_empty() {
                    "none".to_owned()
                } else {
                    names.join(", ")
                }
            );
            stage.leave_out(About::Lost, what);
            return None;
        }
    };
    let shafts = pair.map(|i| members[i].shaft.unwrap_or_default());
    train.links.push(Link {
        shafts,
        ratio: relative,
    });
    Some((standing, train.links.len() - 1))
}

/// Torques on the shafts of the two members that turn; says what they are.
fn torques(
    train: &mut Train,
    (stage, parts): (Part<'_>, &Parts),
    (turning, link): (&[usize], usize),
) -> String {
    let members = &parts.members;
    let (shafts, relative) = (train.links[link].shafts, train.links[link].ratio);
    let middle = members[turning[0]].part;
    let point = train
        .gear(middle)
        .and_then(|g| Some(train.shaft(g.shaft)?.frame?.point([g.mid_mm, 0.0, 0.0])));
    for (side, (&shaft, member)) in shafts
        .iter()
        .zip(turning.iter().map(|&i| &members[i]))
        .enumerate()
    {
        let Some(own) = train.shaft(shaft) else {
            continue;
        };
        let u_mm = own.nearest_mm(point);
        train.planetary.push(TorqueSeat {
            shaft,
            u_mm,
            link: (link, side),
            name: format!("{} of {}", member.name, stage.name_or(&stage.words())),
        });
    }
    let [a, b] = [turning[0], turning[1]].map(|i| members[i].name);
    format!(
        "{b} turns {relative:.6} times as fast as {a}: torques pass through, and act on the shafts of both in the scene; no forces: across the axis they cancel between planets, along the axis those of helical teeth are left out"
    )
}

/// Whether something but the stage itself may turn a shaft: a load that transmits torque, another gear, a coupling to
/// another shaft, another planetary stage.
fn is_driven(source: &Source<'_>, acting: &Acting, part: i64, shaft: i64) -> bool {
    let component = source.part(shaft);
    let stands = component.is_some_and(|c| {
        let speed = c.number("rotational_speed", RPM).ok().flatten();
        speed == Some(0.0) && matches!(c.flag("defines_speed"), Ok(Some(true)))
    });
    let stands = stands || acting.braked.contains(&shaft);
    let mates = acting.gears.get(&shaft).into_iter().flatten();
    let has_mate = { mates }.any(|gear| *gear != part);
    let passes = acting.joined.contains(&shaft) || acting.shared.contains(&shaft);
    !stands && (acting.loaded.contains(&shaft) || has_mate || passes)
}
