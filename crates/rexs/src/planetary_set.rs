//! A planetary stage as `[[planetary]]` of the scene: sun on its shaft, carrier fixed to its own, ring held or on a
//! shaft, planets on their bearings.

use crate::bearing::{AxialSupport, Bearing, RIGID_TILT};
use crate::cylindrical::Gear;
pub use crate::gearbox::PlanetarySet;
use crate::gearbox::Train;
use crate::ledger::About;
use crate::mesh_model::{Meshes, mesh_model};
use crate::placement::frame;
use crate::planetary_parts::Parts;
use crate::power_flow::Link;
use crate::running::Running;
use crate::source::{Part, Source};
use crate::text::{number, numbers, quoted};
use crate::units::MM;
use crate::vectors::{Frame, add, dot};
use std::f64::consts::TAU;

/// Reads the set of a stage; `standing` is the member that does not turn, 0 for the sun, 1 the ring, 2 the carrier.
///
/// # Errors
/// Why the scene cannot have it, in words.
pub fn read(
    source: &Source<'_>,
    train: &mut Train,
    (stage, parts): (Part<'_>, &Parts),
    (standing, link): (usize, usize),
) -> Result<PlanetarySet, String> {
    let [sun, ring, _] = &parts.members;
    if standing == 0 {
        return Err("sets whose sun stands pass torques only".to_owned());
    }
    if !parts.is_simple {
        return Err("stepped planets pass torques only".to_owned());
    }
    let place = |id: i64| train.gears.place(id).ok_or("a gear is missing".to_owned());
    let [sun, planet, ring_gear] = [sun.part, parts.planets[0], ring.part].map(place);
    let (sun, planet, ring_gear) = (sun?, planet?, ring_gear?);
    let hand = hand_deg([sun, planet, ring_gear].map(|i| &train.gears[i].gear))?;
    let shaft = train.shaft(train.gears[sun].shaft);
    let own = shaft.and_then(|s| Some((s.frame?, s.sign())));
    let (own, sign) = own.ok_or("the sun's shaft has no place")?;
    let axis = own.axes[0].map(|x| sign * x);
    let mid_mm = train.gears[sun].mid_mm;
    let middle = own.point([mid_mm, 0.0, 0.0]);
    let planets = parts.planets.iter();
    let frames: Vec<Option<Frame>> = planets.map(|&p| shaft_frame(source, p)).collect();
    let distance_mm = distance_mm(source, train, parts, (&own, &frames[0]), [sun, planet]);
    let teeth = train.gears[sun].gear.teeth + train.gears[ring_gear].gear.teeth;
    let angles_deg = told_angles_deg(stage, (own.origin_mm, axis), &frames, teeth);
    let is_against = |frame: &Option<Frame>| frame.is_some_and(|f| dot(f.axes[0], axis) < 0.0);
    let first = (parts.planets[0], planet);
    let bearings = of_planet(source, train, first, is_against(&frames[0]));
    let planets = parts.planets.iter().zip(frames);
    let planets = planets.filter_map(|(&id, frame)| Some((train.gears.place(id)?, frame)));
    let planets: Vec<(usize, Option<Frame>)> = planets.collect();
    let others = planets.iter().skip(1).map(|(gear, _)| *gear).collect();
    let ring_frame = (ring_gear, shaft_frame(source, ring.part));
    let against_u =
        { planets.into_iter().chain([ring_frame]) }.filter(|(_, frame)| is_against(frame));
    let against_u = against_u.map(|(gear, _)| gear).collect();
    if standing == 2
        && let Some(on) = ring.shaft
        && let Some(frame) = train.shaft(on).and_then(|s| s.frame)
    {
        let seated = &mut train.gears[ring_gear];
        (seated.shaft, seated.mid_mm) = (on, frame.u_of(middle));
    }
    train.gears[ring_gear].gear.helix_deg = hand;
    let carriers = match standing {
        2 => Vec::new(),
        _ => join_carriers(train, &parts.carriers, middle),
    };
    let what = format!(
        "[[planetary]] of the scene: {} planets, all as the first one; its {} stands; carrier and pins are rigid",
        parts.planets.len(),
        parts.members[standing].name
    );
    stage.assume(About::Small, what);
    let number = format!("planetary stage {}", stage.id);
    Ok(PlanetarySet {
        name: stage.name_or(&number).to_owned(),
        sun,
        planet,
        others,
        ring: ring_gear,
        distance_mm,
        angles_deg,
        carriers,
        bearings,
        link,
        against_u,
    })
}

/// Where the shaft of a gear stands, by its own place.
fn shaft_frame(source: &Source<'_>, gear: i64) -> Option<Frame> {
    let shafts = source.structure.partners(gear, &["shaft"]);
    frame(source.part(*shafts.first()?)?).ok()?
}

/// Helix angle of the planets, with which sun and ring go together \[°\].
fn hand_deg([sun, planet, ring]: [&Gear; 3]) -> Result<f64, String> {
    let (s, p, r) = (sun.helix_deg, planet.helix_deg, ring.helix_deg);
    if (s + p).abs() > 1e-6 || (r.abs() - p.abs()).abs() > 1e-6 {
        return Err(format!(
            "helix angles do not go together: sun {s}, planet {p}, ring {r} deg"
        ));
    }
    Ok(p)
}

/// Angles of the planets, and a word about them where they are not those of the file.
fn told_angles_deg(
    stage: Part<'_>,
    axis: ([f64; 3], [f64; 3]),
    frames: &[Option<Frame>],
    teeth: u32,
) -> Vec<f64> {
    let Some((angles_deg, moved_deg)) = angles_deg(axis, frames, teeth) else {
        let about = "its planets have no places of their own around the axis: at equal angles";
        stage.assume(About::Small, about);
        return equal_deg(frames.len());
    };
    if moved_deg > ROUNDING_DEG {
        let about = format!(
            "its teeth do not fit where its planets are: moved by up to {moved_deg:.3} deg about its axis, \
             to the nearest places where they do"
        );
        stage.assume(About::Place, about);
    }
    angles_deg
}

/// Shafts of the carrier with the place of the set along them; they turn as one.
fn join_carriers(train: &mut Train, shafts: &[i64], middle_mm: [f64; 3]) -> Vec<(i64, f64)> {
    let known = shafts.iter().filter_map(|&id| Some((id, train.shaft(id)?)));
    let carriers = known.map(|(id, shaft)| (id, shaft.nearest_mm(Some(middle_mm))));
    let carriers: Vec<(i64, f64)> = carriers.collect();
    // Both halves of a carrier turn as one.
    let halves = carriers.windows(2).map(|pair| [pair[0].0, pair[1].0]);
    train
        .links
        .extend(halves.map(|shafts| Link { shafts, ratio: 1.0 }));
    carriers
}

/// Tells which planets have other flanks than the first one, whose the scene gives to all.
pub fn tell_unlike_planets(source: &Source<'_>, train: &Train) {
    for set in &train.sets {
        let first = &train.gears[set.planet].gear;
        let others = set.others.iter().map(|&i| &train.gears[i].gear);
        for gear in others.filter(|gear| gear.microgeometry != first.microgeometry) {
            if let Some(component) = source.part(gear.id) {
                let what = format!(
                    "its flank modifications are others than those of {}, which all planets of the scene have: they stand in {} alone",
                    first.name, gear.file
                );
                component.leave_out(About::Flanks, what);
            }
        }
    }
}

/// What the stage of sun and planet states, else the planet's place, else the reference circles.
fn distance_mm(
    source: &Source<'_>,
    train: &Train,
    parts: &Parts,
    (sun, planet): (&Frame, &Option<Frame>),
    gears: [usize; 2],
) -> f64 {
    let stage = source.part(parts.first_stage);
    let stated = stage.and_then(|s| s.number("center_distance", MM).ok().flatten());
    let stated = stated.map(f64::abs).filter(|d| *d > 0.0);
    let by_place = planet.map(|frame| sun.from_axis_mm(frame.origin_mm));
    let radius = |&i: &usize| 0.5 * train.gears[i].gear.reference_diameter_mm();
    let stated = stated.or(by_place.filter(|d| *d > 0.0));
    stated.unwrap_or_else(|| gears.iter().map(radius).sum())
}

fn equal_deg(planets: usize) -> Vec<f64> {
    (0..planets)
        .map(|n| 360.0 * n as f64 / planets as f64)
        .collect()
}

/// Planets are moved by less than this where a file rounds their places \[°\]: a micrometre at a radius of 6 mm.
const ROUNDING_DEG: f64 = 0.01;

/// Angles of the planets about the axis of the set (a point of it, its direction), counted as `[[planetary]]` does, at
/// the nearest places where they fit, and by how much the farthest was moved; none where the file does not set them
/// apart.
fn angles_deg(
    (origin_mm, [x, y, z]): ([f64; 3], [f64; 3]),
    frames: &[Option<Frame>],
    places: u32,
) -> Option<(Vec<f64>, f64)> {
    let (sin_a, cos_a) = if y.hypot(z) < 1e-12 {
        (0.0, 1.0)
    } else {
        (-y / y.hypot(z), z / y.hypot(z))
    };
    let (sin_b, cos_b) = (x, y.hypot(z));
    let across = [[cos_b, sin_a * sin_b, -cos_a * sin_b], [0.0, cos_a, sin_a]];
    let mut found: Vec<f64> = Vec::new();
    for frame in frames {
        let between = add((*frame)?.origin_mm, origin_mm, -1.0);
        let [c, s] = across.map(|direction| dot(between, direction));
        found.push(s.atan2(c));
    }
    let places = f64::from(places);
    let turned = found.iter().map(|angle| (angle - found[0]) / TAU * places);
    let turned: Vec<f64> = turned.collect();
    let at: Vec<f64> = { turned.iter() }
        .map(|at| at.round().rem_euclid(places))
        .collect();
    let moved = { turned.iter() }.map(|at| 360.0 * (at - at.round()).abs() / places);
    let apart = |i: usize| !at[..i].contains(&at[i]);
    let first = found[0].to_degrees();
    let angles = at.iter().map(|k| first + 360.0 * k / places).collect();
    let all_apart = (0..at.len()).all(apart);
    all_apart.then(|| (angles, moved.fold(0.0, f64::max)))
}

/// Bearings between the shaft of a planet and its pin, with their places.
fn of_planet(
    source: &Source<'_>,
    train: &Train,
    (gear, place): (i64, usize),
    reversed: bool,
) -> Vec<(f64, Bearing)> {
    let shafts = source.structure.partners(gear, &["shaft"]);
    let mid_mm = Some(train.gears[place].mid_mm).filter(|mid| mid.is_finite());
    let bearings = { shafts.iter() }.filter_map(|shaft| train.of_planets.get(shaft));
    let on = bearings.flatten().filter_map(|bearing| {
        let mut sides = bearing.sides.iter();
        let side = sides.position(|side| shafts.contains(side))?;
        let u_mm = bearing.u_mm[side].or(bearing.u_mm[1 - side]);
        let z_mm = u_mm.zip(mid_mm).map_or(0.0, |(u, mid)| u - mid);
        Some((if reversed { -z_mm } else { z_mm }, bearing.clone()))
    });
    let mut found: Vec<(f64, Bearing)> = on.collect();
    if let [(_, only)] = &mut found[..] {
        only.tilt_nm_per_rad = only.tilt_nm_per_rad.max(RIGID_TILT);
    }
    if let Some((_, first)) = found.first_mut()
        && first.axial == AxialSupport::None
    {
        let least = 0.4 * first.radial_n_per_mm.max(1.0);
        first.axial_n_per_mm = first.axial_n_per_mm.max(least);
    }
    found
}

/// Tables of all sets.
pub fn tables(train: &Train, with: Meshes, running: Running) -> String {
    train
        .sets
        .iter()
        .map(|set| set.tables(train, (with, running)))
        .collect()
}

impl PlanetarySet {
    fn tables(&self, train: &Train, (with, running): (Meshes, Running)) -> String {
        let [sun, planet, ring] = [self.sun, self.planet, self.ring].map(|i| &train.gears[i]);
        let Some(shaft) = train.shaft(sun.shaft) else {
            return String::new();
        };
        let own = shaft.frame.unwrap_or(Frame::WORLD);
        let carrier = format!("{} carrier", self.name);
        let mut text = format!(
            "\n[[planetary]]\nname = {}\nposition_mm = {}\naxis = {}\ncentre_distance_mm = {}\n",
            quoted(&self.name),
            numbers(&own.point([sun.mid_mm, 0.0, 0.0])),
            numbers(&shaft.z()),
            number(self.distance_mm)
        );
        if let Some([torque, _]) = train.flow.torques_nm(self.link)
            && torque != 0.0
        {
            let sense = if torque > 0.0 { "positive" } else { "negative" };
            text.push_str(&format!("sun_torque = \"{sense}\"\n"));
        }
        let model = mesh_model(with, running);
        for (key, gears) in [("sun_mesh", [sun, planet]), ("ring_mesh", [planet, ring])] {
            let plain =
                gears.iter().any(|g| !g.gear.microgeometry.is_empty()) && with == Meshes::Iso6336;
            let plain = if plain { ", microgeometry = false" } else { "" };
            text.push_str(&format!("{key} = {{ model = {{ {model} }}{plain} }}\n"));
        }
        text.push_str(&format!("sun = {{ body = {} }}\n", quoted(&sun.gear.name)));
        let gear = |file: &str| quoted(&with.gear(file));
        text.push_str(&match ring.shaft {
            0.. => format!("ring = {{ body = {} }}\n", quoted(&ring.gear.name)),
            _ => format!(
                "ring = {{ gear = {}, support = \"held\" }}\n",
                gear(&ring.gear.file)
            ),
        });
        // A steel disc through the pins, as thick as half a face: at rest it does not count.
        let radius_m = 1e-3 * self.distance_mm;
        let mass = 7850.0 * 0.5e-3 * planet.gear.face_width_mm * 0.5 * TAU * radius_m * radius_m;
        let across = 0.25 * mass * radius_m * radius_m;
        let support = if self.carriers.is_empty() {
            "held"
        } else {
            "free"
        };
        text.push_str(&format!(
            "carrier = {{ mass_kg = {}, inertia_kg_m2 = {}, support = \"{support}\" }}\n",
            number(mass),
            numbers(&[across, across, 2.0 * across])
        ));
        let bearings: Vec<String> = (self.bearings.iter())
            .map(|(z_mm, bearing)| {
                let model = bearing.linear_model(bearing.axial_n_per_mm, running);
                format!("{{ z_mm = {}, model = {{ {model} }} }}", number(*z_mm))
            })
            .collect();
        let bearings = match bearings.is_empty() {
            true => String::new(),
            false => format!(", bearings = [{}]", bearings.join(", ")),
        };
        text.push_str(&format!(
            "planets = {{ gear = {}, angles_deg = {}{bearings} }}\n",
            gear(&planet.gear.file),
            numbers(&self.angles_deg)
        ));
        for (id, u_mm) in &self.carriers {
            if let Some(shaft) = train.shaft(*id) {
                text.push_str(&format!(
                    "\n[[joint]]\nname = {}\nkind = \"fixed\"\nbody_1 = {}\nbody_2 = {}\n",
                    quoted(&format!("{carrier} on {}", shaft.name)),
                    quoted(&shaft.body(*u_mm)),
                    quoted(&carrier)
                ));
            }
        }
        text
    }
}
