//! What kind of mode of a planetary set a natural mode is.
//!
//! Modes of N equal planets at equal angles are rotational (sun, ring and carrier turn and stay on the axis),
//! translational (they move across it and do not turn) or planet modes (they stand still); Lin and Parker, Journal of
//! Vibration and Acoustics 121, 1999. Of other sets the same names say what a mode is nearly.

use gearmesh_dynamics::NaturalMode;
use nalgebra::Vector3;

use super::result::EigenResult;
use crate::system::planetary::PlanetarySet;

/// Degrees of freedom of a rigid body.
const RIGID: usize = 6;

/// Share of a mode's largest displacement below which a part is taken as standing still: unequal phases of the meshes
/// mix modes by a few percent.
const STILL: f64 = 0.05;

/// Kind of a mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SetModeKind {
    /// Sun, ring and carrier turn.
    Rotational,
    /// They move across the axis.
    Translational,
    /// Planets alone move.
    Planet,
    /// Parts move along the axis or tilt.
    OutOfPlane,
    /// Sun, ring and carrier turn and move.
    Mixed,
    /// No part of the set moves.
    Elsewhere,
}

impl SetModeKind {
    /// In words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Rotational => "rotational",
            Self::Translational => "translational",
            Self::Planet => "planet",
            Self::OutOfPlane => "out of plane",
            Self::Mixed => "mixed",
            Self::Elsewhere => "elsewhere",
        }
    }
}

/// The modes of a set.
#[derive(Debug, Clone, PartialEq)]
pub struct SetMode {
    /// Name of the set.
    pub set: String,
    /// Kind of each mode, in their order.
    pub kinds: Vec<SetModeKind>,
}

impl EigenResult {
    /// The kinds of all modes, for every set; none where bodies have modes of their own, whose shapes are not told
    /// apart.
    #[must_use]
    pub fn set_modes(&self, bodies: &[String], sets: &[PlanetarySet]) -> Vec<SetMode> {
        let is_rigid = |mode: &NaturalMode| mode.shape.len() == RIGID * bodies.len();
        if !self.modes.iter().all(is_rigid) {
            return Vec::new();
        }
        let of_set = |set: &PlanetarySet| SetMode {
            set: set.name.clone(),
            kinds: self
                .modes
                .iter()
                .map(|mode| kind(mode, bodies, set))
                .collect(),
        };
        sets.iter().map(of_set).collect()
    }

    /// The kinds of each mode as the begin of a line, "rotational: "; empty of a scene without sets.
    #[must_use]
    pub fn kinds_in_words(&self, bodies: &[String], sets: &[PlanetarySet]) -> Vec<String> {
        let modes = self.set_modes(bodies, sets);
        let of_mode = |k: usize| match &modes[..] {
            [only] => format!("{}: ", only.kinds[k].name()),
            all => all
                .iter()
                .map(|set| format!("{} {}: ", set.set, set.kinds[k].name()))
                .collect(),
        };
        (0..self.modes.len()).map(of_mode).collect()
    }
}

fn kind(mode: &NaturalMode, bodies: &[String], set: &PlanetarySet) -> SetModeKind {
    // Largest amplitudes of some bodies [m]: across the axis, about it, out of the plane; angles on the pins' circle.
    let axis = Vector3::from(set.axis);
    let largest = |names: &mut dyn Iterator<Item = &String>| {
        let places = names.filter_map(|name| bodies.iter().position(|body| body == name));
        places.fold([0.0_f64; 3], |most, place| {
            let own = &mode.shape[RIGID * place..RIGID * (place + 1)];
            // Along and across the axis, of three displacements or angles from the first one on.
            let parts = |first: usize| {
                let [real, imaginary] =
                    [0, 1].map(|part| Vector3::from_fn(|i, _| own[first + i][part]));
                let along = [real.dot(&axis), imaginary.dot(&axis)];
                let across = [real - axis * along[0], imaginary - axis * along[1]];
                let across = across[0].norm().hypot(across[1].norm());
                [along[0].hypot(along[1]), across]
            };
            let ([out, moves], [turns, tilts]) = (parts(0), parts(3));
            let arm_m = set.centre_distance_m;
            [
                most[0].max(moves),
                most[1].max(turns * arm_m),
                most[2].max(out).max(tilts * arm_m),
            ]
        })
    };
    let members = &set.members;
    let central = [
        members.sun.as_ref(),
        members.ring.as_ref(),
        Some(&members.carrier),
    ];
    let [moves, turns, out] = largest(&mut central.into_iter().flatten());
    let [planet_moves, planet_turns, planet_out] =
        largest(&mut set.planets.iter().chain(&set.partners.bodies));
    let out = out.max(planet_out);
    let in_plane = moves.max(turns).max(planet_moves).max(planet_turns);
    let still = STILL * in_plane.max(out);
    // The largest entry of a shape is 1, in metres or radians.
    let whole = mode
        .shape
        .iter()
        .map(|a| a[0].hypot(a[1]))
        .fold(0.0, f64::max);
    if in_plane.max(out) < STILL * whole * set.centre_distance_m.min(1.0) {
        return SetModeKind::Elsewhere;
    }
    match (moves > still, turns > still) {
        _ if out > in_plane => SetModeKind::OutOfPlane,
        (false, false) => SetModeKind::Planet,
        (false, true) => SetModeKind::Rotational,
        (true, false) => SetModeKind::Translational,
        (true, true) => SetModeKind::Mixed,
    }
}
