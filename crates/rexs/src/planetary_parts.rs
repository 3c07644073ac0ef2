//! The parts of a planetary stage, by which gears are in mesh: sun, ring, carrier, planets, and the ratio i₀ that
//! `planetary.rs` explains.

use crate::gearbox::Train;
use crate::source::{Part, Source};
use crate::structure::Stage;
use crate::units::ONE;
use std::collections::HashSet;

/// A member that turns about the common axis: teeth, its shaft in the scene, its words.
pub struct Member {
    /// Shaft: component.
    pub shaft: Option<i64>,
    /// Gear, or the shaft of the carrier: component.
    pub part: i64,
    /// `sun`, `ring` or `carrier`.
    pub name: &'static str,
}

/// Parts of a planetary stage.
pub struct Parts {
    /// Sun, ring and carrier.
    pub members: [Member; 3],
    /// i₀.
    pub(crate) ratio: f64,
    /// Planets in mesh with the sun.
    pub planets: Vec<i64>,
    /// Whether the same gears are in mesh with the ring.
    pub is_simple: bool,
    /// The stage of the sun and the first planet.
    pub first_stage: i64,
    /// All shafts of the carrier that the scene has.
    pub carriers: Vec<i64>,
}

/// Sun, ring and carrier, and i₀.
pub fn members(
    source: &Source<'_>,
    train: &Train,
    (stage, pairs): (Part<'_>, &[Stage]),
) -> Option<Parts> {
    let in_scene = |ids: Vec<i64>| ids.into_iter().find(|&id| train.shaft(id).is_some());
    let is_ring = |id: i64| {
        let component = source.part(id);
        component.is_some_and(|c| c.kind == "ring_gear")
    };
    let mate = |[a, b]: [i64; 2]| {
        let ring = is_ring(b).then_some((b, a));
        ring.or_else(|| is_ring(a).then_some((a, b)))
    };
    let with_ring: Vec<(i64, i64)> = pairs.iter().filter_map(|s| mate(s.gears)).collect();
    let &(ring, planet_b) = with_ring.first()?;
    let shaft_of = |gear: i64| source.structure.partners(gear, &["shaft"]).first().copied();
    let planets: HashSet<i64> = with_ring.iter().map(|&(_, p)| p).collect();
    let pins: HashSet<i64> = planets.iter().filter_map(|&p| shaft_of(p)).collect();
    let is_planet = |gear: i64| {
        planets.contains(&gear) || shaft_of(gear).is_some_and(|own| pins.contains(&own))
    };
    let with_sun = pairs
        .iter()
        .filter(|p| !p.gears.iter().any(|&g| is_ring(g)));
    let suns: Vec<(i64, i64, i64)> = with_sun
        .filter_map(
            |&Stage { id, gears: [a, b] }| match (is_planet(a), is_planet(b)) {
                (false, true) => Some((a, b, id)),
                (true, false) => Some((b, a, id)),
                _ => None,
            },
        )
        .collect();
    let &(sun, planet_a, first_stage) = suns.first()?;
    let is_one = suns.iter().all(|s| s.0 == sun) && with_ring.iter().all(|r| r.0 == ring);
    let is_all = suns.len() + with_ring.len() == pairs.len();
    if !is_one || !is_all {
        return None;
    }
    let teeth = |gear: i64| -> Option<f64> {
        let component = source.part(gear)?;
        let teeth = component.number("number_of_teeth", ONE).ok()??;
        Some(teeth.abs()).filter(|z| *z > 0.0)
    };
    let ratio = -teeth(planet_a)? * teeth(ring)? / (teeth(sun)? * teeth(planet_b)?);
    let carriers = source
        .structure
        .planetary_shafts(stage.id, "planet_carrier_shaft");
    let carrier = in_scene(carriers.clone());
    let mut planets_of_sun: Vec<i64> = suns.iter().map(|s| s.1).collect();
    let mut seen = HashSet::new();
    planets_of_sun.retain(|planet| seen.insert(*planet));
    let member = |part: i64, name| Member {
        shaft: in_scene(source.structure.partners(part, &["shaft"])),
        part,
        name,
    };
    let members = [
        member(sun, "sun"),
        member(ring, "ring"),
        Member {
            shaft: carrier,
            part: carrier.or(carriers.first().copied())?,
            name: "carrier",
        },
    ];
    let carriers = carriers.into_iter().filter(|&id| train.shaft(id).is_some());
    Some(Parts {
        members,
        ratio,
        is_simple: seen == planets,
        planets: planets_of_sun,
        first_stage,
        carriers: carriers.collect(),
    })
}
