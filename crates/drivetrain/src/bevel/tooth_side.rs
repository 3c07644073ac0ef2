//! One side of the teeth of a bevel pair: the flanks that face each other, and where they are nearest without a guess.

use std::cell::Cell;
use std::f64::consts::TAU;

use gearmesh_bevel::{FlankPatch, FlankSide, PairBlank, PairDesign};
use gearmesh_geometry::Flank;
use nalgebra::{Matrix3, Rotation3, Vector3};

use super::bounding_spheres::BoundingSpheres;
use super::contact_limits::{Limits, NoContact, nearer, nearest, nearest_from, nearest_within};
use super::nearest_points::{FREE, Nearest, Placed, solve};
use super::nominal_contacts::{Guess, NominalContacts};
use super::section_points::{edge_of, sections};
use crate::error::DrivetrainError;

/// Pitches of the pinion to either side of the plane of the axes within which teeth are looked at.
pub(super) const REACH: f64 = 3.5;
/// Flanks that stand farther open than this share of a pitch do not touch soon, and are passed over.
pub(super) const FAR: f64 = 0.2;

/// Places along an edge from which its contact is sought.
const ALONG_EDGES: [f64; 3] = [0.15, 0.45, 0.85];
/// Sections that are looked at where Newton's method finds no contact of flanks that face each other.
const SECTIONS: usize = 12;
/// Gaps that differ by less are one \[m\].
const SAME_M: f64 = 1e-9;

/// Whether right or left flanks of a member are its concave or its convex ones. Right flanks face clockwise.
pub(super) fn side_of(blank: &PairBlank, member: usize, flank: Flank) -> FlankSide {
    let hand = blank.members[member].hand;
    let faces = |side: &FlankSide| side.facing(hand) == -flank.mirror();
    let found = FlankSide::BOTH.into_iter().find(faces);
    found.unwrap_or(FlankSide::Concave)
}

/// A flank of each member on one side of the teeth.
#[derive(Debug, Clone)]
pub(super) struct Side {
    /// Of gear 1 and gear 2.
    pub patches: [FlankPatch; 2],
    /// Round parts of them.
    pub spheres: [BoundingSpheres; 2],
    /// Contacts of the pair as designed.
    pub nominal: NominalContacts,
    /// Contacts beside those, where a pair of teeth touches in two places (on the flank and on an edge): either may
    /// become the nearer one.
    pub rivals: Option<NominalContacts>,
    /// Azimuth of the mean points of tooth 0 \[rad\].
    pub azimuths_rad: [f64; 2],
    /// Lever of the normal at the mean point of gear 1 and gear 2 \[m\].
    pub levers_m: [f64; 2],
}

impl Side {
    /// Flanks of a side, and the contacts of the pair as designed.
    pub fn new(
        blank: &PairBlank,
        design: &PairDesign,
        flank: Flank,
    ) -> Result<Self, DrivetrainError> {
        let patch = |member: usize| {
            let side = side_of(blank, member, flank);
            FlankPatch::of_tooth(&design.teeth[member], &blank.members[1 - member], side)
        };
        let patches = [patch(0)?, patch(1)?];
        let spheres = [0, 1].map(|m: usize| BoundingSpheres::new(&patches[m]));
        let azimuths_rad = [0, 1].map(|m: usize| patches[m].azimuth_rad(patches[m].mean));
        let levers_m = [0, 1].map(|m: usize| patches[m].lever_m());
        let [pitch_1, pitch_2] = blank.data.teeth.map(|z| TAU / z as f64);
        let poses = NominalContacts::angles(pitch_1, REACH).into_iter();
        let rotations: Vec<Matrix3<f64>> = poses
            .map(|angle_1| {
                let angles = [angle_1, -angle_1 * pitch_2 / pitch_1];
                let turns = [0, 1].map(|m: usize| angles[m] - azimuths_rad[m]);
                nominal_rotation(blank.data.shaft_angle_rad, turns)
            })
            .collect();
        let far_m = FAR * pitch_2 * levers_m[1];
        let [first, second] = designed_contacts(&patches, &spheres, &rotations, far_m);
        let rivals = second.iter().any(Option::is_some);
        let table = |contacts: Vec<Option<Nearest>>| {
            NominalContacts::new(pitch_1, REACH, rotations.iter().copied().zip(contacts))
        };
        let (nominal, rivals) = (table(first), rivals.then(|| table(second)));
        Ok(Self {
            patches,
            spheres,
            nominal,
            rivals,
            azimuths_rad,
            levers_m,
        })
    }

    /// Where the tables expect the contacts of a pair of teeth at an angle of gear 1's; gear 2 in the frame of that
    /// tooth.
    pub fn guesses(
        &self,
        angle_1_rad: f64,
        displacement_m: &Vector3<f64>,
        rotation: &Matrix3<f64>,
    ) -> Guesses {
        let rivals = self.rivals.as_ref();
        Guesses {
            nominal: self.nominal.guess(angle_1_rad, displacement_m, rotation),
            // Off the design they come a little earlier or later.
            rival: rivals
                .and_then(|table| table.guess_nearby(angle_1_rad, displacement_m, rotation)),
        }
    }

    /// The contact of the least gap near these guesses; searched over the flanks where none is there. None where flanks
    /// do not face each other, or stand farther apart than `far_m`.
    pub fn contact(
        &self,
        bodies: &[Placed<'_>; 2],
        guesses: &Guesses,
        far_m: f64,
    ) -> Option<Nearest> {
        let near = |table: &NominalContacts, guess: &Guess| {
            let mut limits = table.limits(guess);
            limits.find_map(|limits| nearest_within(bodies, limits, guess.at))
        };
        let nominal = guesses.nominal.as_ref();
        let found = nominal.and_then(|guess| near(&self.nominal, guess));
        let rival = self.rivals.as_ref().zip(guesses.rival.as_ref());
        let rival = rival.and_then(|(table, guess)| near(table, guess));
        let found = nearer(found, rival);
        let found = found.or_else(|| searched(bodies, &self.spheres, far_m));
        found.or_else(|| {
            let guess = nominal?;
            nearest_from(bodies, Limits::along(None), guess.at).filter(|found| found.gap_m <= far_m)
        })
    }
}

/// Where a pair of teeth may touch.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Guesses {
    nominal: Option<Guess>,
    rival: Option<Guess>,
}

impl Guesses {
    /// The least gap that is expected \[m\]; none where no contact is.
    pub fn gap_m(&self) -> Option<f64> {
        let gaps = [&self.nominal, &self.rival].into_iter().flatten();
        gaps.map(|guess| guess.gap_m).reduce(f64::min)
    }
}

/// Contacts of the pair as designed at neighbouring poses, those of the least gap and others beside them: each searched
/// over the flanks and on their edges, and followed from those of the pose before and after, for a search may miss one.
fn designed_contacts(
    patches: &[FlankPatch; 2],
    spheres: &[BoundingSpheres; 2],
    rotations: &[Matrix3<f64>],
    far_m: f64,
) -> [Vec<Option<Nearest>>; 2] {
    let count = Cell::new(0);
    let at = |k: usize| placed(patches, [0.0; 2], (rotations[k], Vector3::zeros()), &count);
    let add = |own: &mut Vec<Nearest>, new: Nearest| {
        let same = |old: &Nearest| (old.gap_m - new.gap_m).abs() < SAME_M;
        if new.gap_m <= far_m && !own.iter().any(same) {
            own.push(new);
            own.sort_by(|a, b| a.gap_m.total_cmp(&b.gap_m));
            own.truncate(2);
        }
    };
    let last = rotations.len() - 1;
    let mut found: Vec<Vec<Nearest>> = Vec::with_capacity(rotations.len());
    for k in 0..=last {
        let mut own: Vec<Nearest> = searched(&at(k), spheres, far_m).into_iter().collect();
        if !own.is_empty() {
            edge_contacts(&at(k), far_m, |contact| add(&mut own, contact));
        }
        found.push(own);
    }
    let onwards = (0..last).map(|k| [k, k + 1]);
    let backwards = (0..last).rev().map(|k| [k + 1, k]);
    for [from, to] in onwards.chain(backwards) {
        for known in found[from].clone() {
            if let Some(new) = nearest_from(&at(to), Limits::of(&known.held), known.at) {
                add(&mut found[to], new);
            }
        }
    }
    [0, 1].map(|k: usize| found.iter().map(|own| own.get(k).copied()).collect())
}

/// Contacts of tips, toes and heels, from some places along each of them, and of the corners beside these places.
fn edge_contacts(bodies: &[Placed<'_>; 2], far_m: f64, mut add: impl FnMut(Nearest)) {
    for member in 0..2 {
        for (held, end) in [(1, 1.0), (0, 0.0), (0, 1.0)] {
            for along in ALONG_EDGES {
                let mut place = [along; 2];
                place[held] = end;
                let mut still = FREE;
                still[member] = place.map(Some);
                let mut guess = [[place[0], 1.0 - place[1]]; 2];
                guess[member] = place;
                let Some(foot) = solve(bodies, still, guess).filter(|foot| foot.gap_m <= far_m)
                else {
                    continue;
                };
                let mut edge = FREE;
                edge[member][held] = Some(end);
                let mut corner = edge;
                corner[member][1 - held] = Some(along.round());
                // Below the lower line is no end.
                let is_corner = held == 1 || along > 0.5;
                for ends in [Some(edge), is_corner.then_some(corner)]
                    .into_iter()
                    .flatten()
                {
                    if let Some(found) = nearest_within(bodies, Limits::of(&ends), foot.at) {
                        add(found);
                    }
                }
            }
        }
    }
}

/// Both flanks of a side in the frame of gear 1, turned about their own axes; gear 2 with its axes and its origin \[m\]
/// there.
pub(super) fn placed<'a>(
    patches: &'a [FlankPatch; 2],
    turns_rad: [f64; 2],
    (axes, displacement_m): (Matrix3<f64>, Vector3<f64>),
    points: &'a Cell<u64>,
) -> [Placed<'a>; 2] {
    let stands = [(None, Vector3::zeros()), (Some(axes), displacement_m)];
    [0, 1].map(|m: usize| Placed {
        patch: &patches[m],
        turn_rad: turns_rad[m],
        axes: stands[m].0,
        origin_m: stands[m].1,
        points,
    })
}

/// Nearest points without a guess, beginning at the two nearest of all bounding spheres, and, where that finds none, at
/// the section of the least gap.
pub(super) fn searched(
    bodies: &[Placed<'_>; 2],
    spheres: &[BoundingSpheres; 2],
    far_m: f64,
) -> Option<Nearest> {
    let [first, second] = bodies;
    let guess = BoundingSpheres::meet(
        [&spheres[0], &spheres[1]],
        [&first.rotation(), &second.rotation()],
        second.origin_m,
    )?;
    match nearest(bodies, guess, far_m) {
        Ok(found) => Some(found),
        Err(NoContact::Apart) => None,
        Err(NoContact::Missed(from)) => {
            let found = sections(bodies, from, None, SECTIONS);
            let found = found.into_iter().flatten();
            let least = found.min_by(|a, b| a.gap_m.total_cmp(&b.gap_m))?;
            nearest_from(bodies, Limits::along(edge_of(&least)), least.at)
                .filter(|found| found.gap_m <= far_m)
        }
    }
}

/// Gear 2's axes in gear 1's where the pair stands as designed and the gears have turned by these angles.
pub(super) fn nominal_rotation(shaft_angle_rad: f64, turns_rad: [f64; 2]) -> Matrix3<f64> {
    let (sin, cos) = shaft_angle_rad.sin_cos();
    // x towards gear 1's axis, y against gear 1's.
    let axes = Matrix3::new(-cos, 0.0, sin, 0.0, -1.0, 0.0, sin, 0.0, cos);
    about_z(-turns_rad[0]) * axes * about_z(turns_rad[1])
}

/// Turn about z.
pub(super) fn about_z(angle_rad: f64) -> Matrix3<f64> {
    *Rotation3::from_axis_angle(&Vector3::z_axis(), angle_rad).matrix()
}
