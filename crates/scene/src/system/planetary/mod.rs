//! Planetary sets: what follows from `[[planetary]]`.
//!
//! | what | file |
//! | --- | --- |
//! | angles at which planets fit, phases of the meshes | `layout.rs` |
//! | gears of the set and whether they fit between each other | `gears.rs` |
//! | whether planets touch each other | `room.rs` |
//! | meshed planets: their partners | `partners.rs` |
//! | keys that contradict each other | `keys.rs` |
//! | pins that bend | `pin_beams.rs` |
//! | bodies, joints, bearings and meshes as a scene would state them | `expansion.rs`, `members.rs`, `pins.rs`, `meshes.rs` |

mod expansion;
mod gears;
mod keys;
pub mod layout;
mod members;
mod meshes;
mod partners;
mod pin_beams;
mod pins;
mod room;

pub(super) use expansion::expand;

use std::f64::consts::TAU;

use nalgebra::Vector3;

use layout::{SetTeeth, harmonic_shares, passing_share, phasing};

/// Harmonics of the mesh whose effect is printed.
const HARMONICS: usize = 6;

/// Share of all planets together from which on an order of planets that pass is printed.
const SEEN: f64 = 0.5;

/// A set with the names of its parts.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanetarySet {
    /// Name.
    pub name: String,
    /// Numbers of teeth.
    pub teeth: SetTeeth,
    /// Angles of the planets, counter-clockwise from x \[rad\].
    pub angles_rad: Vec<f64>,
    /// Distance of the pins from the axis \[m\].
    pub centre_distance_m: f64,
    /// Direction of the axis in the world.
    pub axis: [f64; 3],
    /// Bodies of sun, ring and carrier.
    pub members: SetMembers,
    /// Bodies of the planets.
    pub planets: Vec<String>,
    /// Partners of meshed planets; empty of others.
    pub partners: PartnerLayout,
    /// Meshes of the sun, by planet; none without a sun.
    pub sun_meshes: Vec<String>,
    /// Meshes of the ring, by planet; none without a ring.
    pub ring_meshes: Vec<String>,
}

/// The partners of meshed planets.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PartnerLayout {
    /// Their bodies, by planet.
    pub bodies: Vec<String>,
    /// Meshes of planets and partners, by planet.
    pub meshes: Vec<String>,
    /// How far they are ahead of their planets, counter-clockwise about the axis \[rad\].
    pub ahead_rad: f64,
    /// Distance of their pins from the axis \[m\].
    pub distance_m: f64,
}

/// Names of the central bodies.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SetMembers {
    /// The sun, where there is one.
    pub sun: Option<String>,
    /// The ring, where there is one.
    pub ring: Option<String>,
    /// The carrier.
    pub carrier: String,
}

impl Default for PlanetarySet {
    /// No parts, about z.
    fn default() -> Self {
        Self {
            name: String::new(),
            teeth: SetTeeth::default(),
            angles_rad: Vec::new(),
            centre_distance_m: 0.0,
            axis: [0.0, 0.0, 1.0],
            members: SetMembers::default(),
            planets: Vec::new(),
            partners: PartnerLayout::default(),
            sun_meshes: Vec::new(),
            ring_meshes: Vec::new(),
        }
    }
}

impl PlanetarySet {
    /// Part of a vector of the world across the axis.
    #[must_use]
    pub fn across(&self, vector: [f64; 3]) -> f64 {
        let (vector, axis) = (Vector3::from(vector), Vector3::from(self.axis));
        (vector - axis * vector.dot(&axis)).norm()
    }

    /// What is to be known of a set before it runs: teeth, ratios, phases of the meshes and what follows from them.
    #[must_use]
    pub fn words(&self) -> String {
        let teeth = &self.teeth;
        let planet = match (teeth.planet, teeth.planet_to_ring) {
            (a, b) if teeth.is_meshed => format!("{a} (planet), {b} (partner)"),
            (a, b) if a == b => format!("{a} (planet)"),
            (a, b) => format!("{a} and {b} (planet)"),
        };
        let count = |teeth: Option<usize>| teeth.map_or("none".to_owned(), |z| z.to_string());
        let mut words = vec![format!(
            "z {} (sun), {planet}, {} (ring), {} planets at {} deg",
            count(teeth.sun),
            count(teeth.ring),
            self.angles_rad.len(),
            list(self.angles_rad.iter().map(|angle| angle.to_degrees()))
        )];
        if teeth.is_meshed {
            words.push(format!(
                "partners {} deg ahead of their planets, {} mm from the axis",
                list([self.partners.ahead_rad.to_degrees()].into_iter()),
                list([1e3 * self.partners.distance_m].into_iter())
            ));
        }
        if let Some(ratio) = teeth.carrier_held_ratio() {
            words.push(format!(
                "ratio {:.6} from sun to carrier with the ring held, {ratio:.6} turns of the ring for one of the sun with the carrier held",
                1.0 - 1.0 / ratio
            ));
        }
        let with_pairs = if teeth.is_meshed {
            "sun and pair"
        } else {
            "sun"
        };
        for (which, phases) in [
            (with_pairs, teeth.sun_phases(&self.angles_rad)),
            ("ring", teeth.ring_phases(&self.angles_rad)),
        ] {
            if !phases.is_empty() {
                words.push(format!(
                    "{which} meshes {}: ahead by {} mesh periods; {}",
                    phasing(&phases).name(),
                    list(phases.iter().copied()),
                    self.harmonics_in_words(&phases)
                ));
            }
        }
        if let Some(ring) = teeth.ring.filter(|_| self.angles_rad.len() > 1) {
            let reach = self.angles_rad.len() as i64;
            let orders = (-reach..=reach).map(|k| ring as i64 + k);
            let seen = orders.filter(|order| passing_share(*order, &self.angles_rad) > SEEN);
            words.push(format!(
                "a place of the ring sees the mesh, order {ring} of the carrier's turn against it, at orders {}",
                list(seen.map(|order| order as f64))
            ));
        }
        if let (Some(periods), Some(sun)) = (teeth.hunting_periods(), teeth.sun) {
            words.push(format!(
                "all teeth meet again as before after {periods} mesh periods, {} turns of the sun against the carrier",
                periods / sun
            ));
        }
        words.join("; ")
    }

    fn harmonics_in_words(&self, phases: &[f64]) -> String {
        let shares = (1..=HARMONICS).map(|l| (l, harmonic_shares(l, phases, &self.angles_rad)));
        let shares: Vec<_> = shares.collect();
        let of = |wanted: &dyn Fn(f64, f64) -> bool| {
            let found = shares.iter().filter(|(_, s)| wanted(s.turns, s.pushes));
            let found: Vec<String> = found.map(|(l, _)| l.to_string()).collect();
            if found.is_empty() {
                "none".to_owned()
            } else {
                found.join(", ")
            }
        };
        format!(
            "of its first {HARMONICS} harmonics turn sun, ring and carrier: {}, push them sideways: {}, cancel: {}",
            of(&|turns, _| turns > 0.0),
            of(&|_, pushes| pushes > 0.0),
            of(&|turns, pushes| turns == 0.0 && pushes == 0.0)
        )
    }

    /// Where a planet stands in the set, from its axis \[m\].
    #[must_use]
    pub fn planet_at_m(&self, planet: usize) -> [f64; 2] {
        at_m(self.centre_distance_m, self.angles_rad[planet])
    }

    /// Where the partner of a planet stands in the set, from its axis \[m\].
    #[must_use]
    pub fn partner_at_m(&self, planet: usize) -> [f64; 2] {
        let angle_rad = self.angles_rad[planet] + self.partners.ahead_rad;
        at_m(self.partners.distance_m, angle_rad)
    }
}

fn at_m(distance_m: f64, angle_rad: f64) -> [f64; 2] {
    let (sin, cos) = (angle_rad % TAU).sin_cos();
    [distance_m * cos, distance_m * sin]
}

fn list(values: impl Iterator<Item = f64>) -> String {
    // Adding 0 makes 0 of -0.
    let rounded = |value: f64| format!("{}", (value * 1e4).round() / 1e4 + 0.0);
    let words: Vec<String> = values.map(rounded).collect();
    words.join(", ")
}
