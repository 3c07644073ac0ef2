//! Where planets can stand, and in which phases their meshes then are.
//!
//! ```text
//! κ = (z_s z_2 + z_r z_1)/gcd(z_1, z_2)       planets fit at ψ with κ ψ/2π a whole number; z_1 = z_2: κ = z_s + z_r
//! κ = z_r − z_s                                the same of meshed planets
//! γ_s = z_s ψ/2π,   γ_r = −z_r ψ/2π            how far meshes of a planet at ψ run ahead, in mesh periods;
//!                                              γ_r = z_r ψ/2π of meshed planets
//! T_l = |Σ_n e^{2πi l γ_n}|/N,   F_l = max_± |Σ_n e^{2πi l γ_n ± iψ_n}|/N
//! ```
//!
//! z_1 meshes with the sun, z_2 with the ring. Harmonic l of the mesh turns the central members with the share T_l of N
//! meshes in phase, and pushes them sideways with F_l. Derivation: docs/theory/planetary_sets.md.

use std::f64::consts::TAU;

use gearmesh_geometry::definition::greatest_common_divisor;

/// Misfit of a planet that counts as rounding of its stated angle, in tooth pitches; angles are then moved to where it
/// is zero.
const ROUNDING_PITCHES: f64 = 1e-3;

/// Shares below this are none: rounding.
const NO_SHARE: f64 = 1e-9;

/// Numbers of teeth; a ring's without sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SetTeeth {
    /// Of the sun, where there is one.
    pub sun: Option<usize>,
    /// Of the planet's gear that meshes with the sun.
    pub planet: usize,
    /// Of the planet's gear that meshes with the ring: the same, but of stepped and of meshed planets.
    pub planet_to_ring: usize,
    /// Whether planets are meshed: that with the ring is another one, which meshes with that at the sun.
    pub is_meshed: bool,
    /// Of the ring, where there is one.
    pub ring: Option<usize>,
}

/// Planets that do not fit between sun and ring.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "planet {planet} at {found_deg:.6} deg does not fit between sun and ring: planets fit at multiples of 360/{places} deg from the first one. The nearest places are \
     angles_deg = {nearest_deg:?}; {} equal angles fit",
    counts_in_words(counts)
)]
pub struct Misfit {
    /// The first planet that does not fit, from 1.
    pub planet: usize,
    /// Its angle from the first planet.
    pub found_deg: f64,
    /// Number of places around.
    pub places: usize,
    /// The nearest places of all planets.
    pub nearest_deg: Vec<f64>,
    /// Numbers of planets that fit and have room at equal angles, up to twelve.
    pub counts: Vec<usize>,
}

fn counts_in_words(counts: &[usize]) -> String {
    let counts: Vec<String> = counts.iter().map(ToString::to_string).collect();
    match counts.len() {
        0 => "no".to_owned(),
        _ => counts.join(", "),
    }
}

/// How the meshes of a kind follow each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phasing {
    /// All in the same phase.
    InPhase,
    /// Each half a period after its neighbour.
    CounterPhased,
    /// Evenly spread over the period.
    Sequential,
    /// Otherwise.
    Uneven,
}

impl Phasing {
    /// In words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::InPhase => "in phase",
            Self::CounterPhased => "counter-phased",
            Self::Sequential => "sequential",
            Self::Uneven => "unevenly phased",
        }
    }
}

/// Effect of a harmonic of the mesh on sun, ring and carrier, as a share of all meshes in phase.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HarmonicShares {
    /// Turns them, T_l.
    pub turns: f64,
    /// Pushes them sideways, F_l.
    pub pushes: f64,
}

impl SetTeeth {
    /// Number of places around at which a planet fits; none where it fits anywhere.
    #[must_use]
    pub fn places(&self) -> Option<usize> {
        let (sun, ring) = (self.sun?, self.ring?);
        if self.is_meshed {
            return (ring != sun).then_some(ring.abs_diff(sun));
        }
        let common = greatest_common_divisor(self.planet, self.planet_to_ring);
        Some((sun * self.planet_to_ring + ring * self.planet) / common)
    }

    /// How far the sun meshes run ahead of that of the first planet, in mesh periods from 0 to below 1; none without a
    /// sun.
    #[must_use]
    pub fn sun_phases(&self, angles_rad: &[f64]) -> Vec<f64> {
        self.sun
            .map_or_else(Vec::new, |z| phases(z as f64, angles_rad))
    }

    /// The same of the ring meshes.
    #[must_use]
    pub fn ring_phases(&self, angles_rad: &[f64]) -> Vec<f64> {
        let sense = if self.is_meshed { 1.0 } else { -1.0 };
        self.ring
            .map_or_else(Vec::new, |z| phases(sense * z as f64, angles_rad))
    }

    /// Mesh periods of the sun after which all teeth of a simple set meet again as before, seen from the carrier; none
    /// of stepped planets, whose two meshes have different periods.
    #[must_use]
    pub fn hunting_periods(&self) -> Option<usize> {
        let gears = [
            self.planet,
            self.planet_to_ring,
            self.sun.unwrap_or(1),
            self.ring.unwrap_or(1),
        ];
        let least = |a: usize, b: usize| a / greatest_common_divisor(a, b) * b;
        let is_simple = self.is_meshed || self.planet == self.planet_to_ring;
        is_simple.then(|| gears.into_iter().fold(1, least))
    }

    /// Turns of the ring for a turn of the sun with the carrier held, −z_s z_2/(z_1 z_r), of meshed planets z_s/z_r;
    /// none without both.
    #[must_use]
    pub fn carrier_held_ratio(&self) -> Option<f64> {
        let (sun, ring) = (self.sun? as f64, self.ring? as f64);
        if self.is_meshed {
            return Some(sun / ring);
        }
        Some(-sun * self.planet_to_ring as f64 / (self.planet as f64 * ring))
    }
}

/// The angles, moved to the places from which they differ by rounding; `places`: how many there are around, none where
/// planets fit anywhere; `room`: how many planets do not touch at equal angles.
///
/// # Errors
/// [`Misfit`] where one differs by more.
pub fn fitted(angles_rad: &[f64], places: Option<usize>, room: usize) -> Result<Vec<f64>, Misfit> {
    let (Some(places), Some(&first)) = (places, angles_rad.first()) else {
        return Ok(angles_rad.to_vec());
    };
    let place = |angle: &f64| ((angle - first) / TAU * places as f64).round();
    let nearest = |angle: &f64| first + place(angle) * TAU / places as f64;
    let misfit = |angle: &f64| ((angle - first) / TAU * places as f64 - place(angle)).abs();
    let Some(planet) = angles_rad
        .iter()
        .position(|angle| misfit(angle) > ROUNDING_PITCHES)
    else {
        return Ok(angles_rad.iter().map(nearest).collect());
    };
    let rounded = |angle: f64| (angle.to_degrees() * 1e6).round() / 1e6;
    Err(Misfit {
        planet: planet + 1,
        found_deg: (angles_rad[planet] - first).to_degrees(),
        places,
        nearest_deg: angles_rad
            .iter()
            .map(|angle| rounded(nearest(angle)))
            .collect(),
        counts: (2..=room.min(12))
            .filter(|count| places.is_multiple_of(*count))
            .collect(),
    })
}

fn phases(teeth: f64, angles_rad: &[f64]) -> Vec<f64> {
    let first = angles_rad.first().copied().unwrap_or(0.0);
    let phase = |angle: &f64| {
        let turns = (teeth * (angle - first) / TAU).rem_euclid(1.0);
        // 1 − rounding is 0.
        if 1.0 - turns < 1e-9 { 0.0 } else { turns }
    };
    angles_rad.iter().map(phase).collect()
}

/// How much of harmonic l of the ring meshes of planets at these angles a place of the ring sees at the order l z_r + k
/// of the carrier's turn against it, |Σ_n e^{i (l z_r + k) ψ_n}|/N: k from what the place sees of a planet that passes.
#[must_use]
pub fn passing_share(order: i64, angles_rad: &[f64]) -> f64 {
    let parts = angles_rad
        .iter()
        .map(|angle| (order as f64 * angle).sin_cos());
    let [x, y] = parts.fold([0.0; 2], |[x, y], (sin, cos)| [x + cos, y + sin]);
    let share = x.hypot(y) / angles_rad.len().max(1) as f64;
    if share < NO_SHARE { 0.0 } else { share }
}

/// How meshes in these phases follow each other.
#[must_use]
pub fn phasing(phases: &[f64]) -> Phasing {
    let steps = phases.iter().zip(phases.iter().cycle().skip(1));
    let steps: Vec<f64> = steps.map(|(a, b)| (b - a).rem_euclid(1.0)).collect();
    let all = |step: f64| {
        let off = |s: &f64| ((s - step).rem_euclid(1.0)).min((step - s).rem_euclid(1.0));
        steps.iter().all(|s| off(s) < 1e-6)
    };
    match steps.first() {
        None => Phasing::InPhase,
        Some(_) if all(0.0) => Phasing::InPhase,
        Some(_) if all(0.5) => Phasing::CounterPhased,
        Some(first) if all(*first) => Phasing::Sequential,
        Some(_) => Phasing::Uneven,
    }
}

/// What harmonic l of meshes in these phases does, the planets at these angles.
#[must_use]
pub fn harmonic_shares(harmonic: usize, phases: &[f64], angles_rad: &[f64]) -> HarmonicShares {
    let sum = |sense: f64| {
        let parts = phases.iter().zip(angles_rad).map(|(phase, angle)| {
            let (sin, cos) = (TAU * harmonic as f64 * phase + sense * angle).sin_cos();
            [cos, sin]
        });
        let [x, y] = parts.fold([0.0; 2], |[x, y], [c, s]| [x + c, y + s]);
        let share = x.hypot(y) / phases.len().max(1) as f64;
        if share < NO_SHARE { 0.0 } else { share }
    };
    HarmonicShares {
        turns: sum(0.0),
        pushes: sum(1.0).max(sum(-1.0)),
    }
}
