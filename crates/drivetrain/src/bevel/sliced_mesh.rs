//! Kinematics of a bevel pair in slices: every pair of teeth touches in a row of sections across gear 1's tooth, even
//! along its face.
//!
//! A slice stands for a stretch of gear 1's face; its patch is where its middle section is nearest to gear 2
//! (`section_points.rs`), and the row of patches is the line on which the flanks nearly touch, whatever its slant.
//! Where gear 2's face ends within a slice, the slice touches over a share of its length. Only sections near enough to
//! touch are computed: a guess from the pair as designed tells them.

use std::cell::Cell;

use gearmesh_bevel::{PairBlank, PairDesign};
use gearmesh_contact::SliceLayout;
use gearmesh_contact::slice_part::LEAST_SHARE;
use gearmesh_geometry::Flank;
use nalgebra::{Matrix3, Vector3};

use super::bevel_mesh::{BevelMesh, angle_of};
use super::line_geometry::MISFIT;
use super::nearby_sections::{NEARBY_M, Searched};
use super::nearest_points::Nearest;
use super::nominal_contacts::Guess;
use super::pose_derivatives::{MovingContacts, PoseDerivatives, gradient};
use super::section_points::{EDGES, middle, nearest_on_section};
use super::sliced_side::SlicedSide;
use super::tooth_pairing::{Candidate, MOST_PAIRS};
use super::tooth_side::{about_z, placed};
use crate::error::DrivetrainError;
use crate::flank_contacts::{FlankContacts, Section, ToothContact};
use crate::flank_kinematics::{FlankKinematics, Tangent};
use crate::pose::{Pose, Vector6};
use crate::slice_plane::Matrix6;

/// What a guess of a gap may miss \[m\] at the pair as designed: half a step of the table of nominal contacts.
const MARGIN_M: f64 = 3e-6;
/// Sections that stand open by more than this many times the deepest overlap do not touch, see `OUT_OF_REACH` of the
/// hybrid model.
const REACH: f64 = 3.0;
/// Sections of pairs at rest that stand open by more are not looked at, however far the gears approach each other
/// \[m\].
const MOST_REACH_M: f64 = 2e-3;
/// Part of a slice over which the end of gear 2's face is rounded.
const ROUNDING: f64 = 0.1;
/// Slices along the teeth.
const SLICES: std::ops::RangeInclusive<usize> = 3..=100;

/// A pair of teeth that may touch.
struct Looked {
    candidate: Candidate,
    /// Displacement \[m\] and axes of gear 2 in the frame of gear 1's tooth.
    seen: (Vector3<f64>, Matrix3<f64>),
    /// What its one contact would have, if it is near at all.
    gap_m: Option<f64>,
}

/// Flanks of a bevel pair in slices, gear 1 the pinion.
#[derive(Debug, Clone)]
pub struct BevelSlices {
    pair: BevelMesh,
    layout: SliceLayout,
    sides: [SlicedSide; 2],
    found: [MovingContacts; 2],
    guesses: Vec<Option<Guess>>,
    is_apart: [bool; 2],
    searched: [Searched; 2],
    /// Sections that stand open by less are looked at in any case \[m\].
    reach_m: f64,
}

impl BevelSlices {
    /// The flanks of a pair that has been designed, in so many slices along the face.
    ///
    /// # Errors
    /// As [`BevelMesh::new`] and [`Self::of_pair`].
    pub fn new(
        blank: &PairBlank,
        design: &PairDesign,
        slices: usize,
    ) -> Result<Self, DrivetrainError> {
        Self::of_pair(BevelMesh::new(blank, design)?, slices)
    }

    /// The flanks of a pair in so many slices along the face.
    ///
    /// # Errors
    /// [`DrivetrainError::Value`] for a number of slices out of range, [`DrivetrainError::BevelLine`] where the line of
    /// contact is not smooth over the flank.
    pub fn of_pair(pair: BevelMesh, slices: usize) -> Result<Self, DrivetrainError> {
        DrivetrainError::require(
            "bevel mesh",
            ("the number of slices", slices as f64),
            SLICES.contains(&slices),
            "3 to 100",
        )?;
        let side = |flank: Flank| {
            let of_pair = &pair.sides[flank as usize];
            let side = SlicedSide::new(of_pair, pair.teeth, pair.shaft_angle_rad, slices);
            side.filter(|side| side.line.misfit < MISFIT)
                .ok_or(DrivetrainError::BevelLine { flank })
        };
        let capacity = MOST_PAIRS * slices;
        Ok(Self {
            sides: [side(Flank::Right)?, side(Flank::Left)?],
            layout: SliceLayout::new([pair.layout.face_widths_m[0]; 2], 0.0, slices),
            found: [0, 1].map(|_| MovingContacts::with_capacity(capacity)),
            guesses: Vec::with_capacity(capacity),
            is_apart: [false; 2],
            searched: [0, 1].map(|_| Searched::with_capacity(MOST_PAIRS, slices)),
            reach_m: 0.0,
            pair,
        })
    }

    /// Finds all patches that stand open by less than this \[m\]: for pairs at rest, whose approach is not known at the
    /// pose.
    #[must_use]
    pub fn reaching(mut self, reach_m: f64) -> Self {
        self.reach_m = reach_m;
        self
    }

    /// The same flanks, each pair of teeth one contact.
    #[must_use]
    pub fn pair(&self) -> &BevelMesh {
        &self.pair
    }

    /// Largest relative misfit of radius and length of the line of contact on a side, against the samples that they
    /// were fitted to.
    #[must_use]
    pub fn line_misfit(&self, side: Flank) -> f64 {
        self.sides[side as usize].line.misfit
    }

    /// Slices along the face.
    pub(super) fn slices(&self) -> usize {
        self.layout.slices
    }

    /// What was found of a side, to be overwritten.
    fn take(&mut self, side: Flank) -> (Vec<PoseDerivatives>, Searched) {
        let side = side as usize;
        let none = Searched::with_capacity(0, 0);
        (
            std::mem::take(&mut self.found[side].0),
            std::mem::replace(&mut self.searched[side], none),
        )
    }

    fn put(&mut self, side: Flank, (list, searched): (Vec<PoseDerivatives>, Searched)) {
        self.found[side as usize].0 = list;
        self.searched[side as usize] = searched;
    }

    /// Goes over all sections of a side that may touch; returns whether there is none.
    fn find(
        &self,
        pose: &Pose,
        flank: Flank,
        (list, guesses, searched): (
            &mut Vec<PoseDerivatives>,
            &mut Vec<Option<Guess>>,
            &mut Searched,
        ),
        found: &mut FlankContacts,
    ) -> bool {
        found.clear();
        list.clear();
        guesses.clear();
        searched.begin(pose, found.bent_m);
        found.action_m_per_u = [0.0; 2];
        let sliced = &self.sides[flank as usize];
        let margin_m = self.margin_m(pose, flank) + found.bent_m;
        let reach_m = |least_m: f64| {
            let overlap_m = (margin_m - least_m).max(0.0);
            least_m.max(self.reach_m) + margin_m + REACH * overlap_m
        };
        // Pairs of teeth first, by the one contact that each of them would have.
        let of_pairs = &self.pair.sides[flank as usize].nominal;
        let mut pairs: [Option<Looked>; MOST_PAIRS] = [const { None }; MOST_PAIRS];
        for (pair, candidate) in pairs.iter_mut().zip(self.pair.candidates(pose, flank)) {
            let back = about_z(-candidate.turns_rad[0]);
            let rotation = back * pose.rotation * about_z(candidate.turns_rad[1]);
            let moved_m = back * pose.displacement_m;
            let guess = of_pairs.guess(candidate.angle_1_rad, &moved_m, &rotation);
            *pair = Some(Looked {
                candidate,
                seen: (moved_m, rotation),
                gap_m: guess.map(|guess| guess.gap_m),
            });
        }
        let pairs = || pairs.iter().flatten();
        let gaps = pairs().filter_map(|pair| pair.gap_m);
        let far_m = reach_m(gaps.fold(f64::INFINITY, f64::min) - margin_m) + margin_m;
        for pair in pairs() {
            let far = pair.gap_m.is_some_and(|gap_m| gap_m > far_m);
            let (moved_m, rotation) = &pair.seen;
            guesses.extend(sliced.nominal.iter().map(|slice| {
                let guess = || slice.guess_nearby(pair.candidate.angle_1_rad, moved_m, rotation);
                (!far).then(guess).flatten()
            }));
        }
        let gaps = guesses.iter().flatten().map(|guess| guess.gap_m);
        let reach_m = reach_m(gaps.fold(f64::INFINITY, f64::min));
        for (pair, own) in pairs().zip(guesses.chunks_exact(self.layout.slices)) {
            if own.iter().flatten().any(|guess| guess.gap_m <= reach_m) {
                self.find_line(pose, flank, &pair.candidate, (own, reach_m), list, found);
                if found.lines.len() > searched.turns_rad.len() {
                    searched.turns_rad.push(pair.candidate.turns_rad);
                }
            }
        }
        if found.lines.is_empty() {
            self.pair.push_apart(pose, flank, found);
        } else {
            searched.nearest_first(found);
        }
        list.is_empty()
    }

    /// What guesses of gaps may miss, poses nearby included \[m\]: the square of how far gear 2 stands off the design
    /// counts against the radius across the line.
    fn margin_m(&self, pose: &Pose, flank: Flank) -> f64 {
        let tilt = angle_of(&pose.axis_2()) - self.pair.shaft_angle_rad;
        let moved_m = pose.displacement_m.norm() + self.pair.mean_cone_m * tilt.abs();
        let [radius, _] = self.sides[flank as usize].line.at([0.5; 2]);
        MARGIN_M + NEARBY_M + moved_m * moved_m / radius.value
    }

    /// The sections of a pair of teeth.
    fn find_line(
        &self,
        pose: &Pose,
        flank: Flank,
        candidate: &Candidate,
        (guesses, reach_m): (&[Option<Guess>], f64),
        list: &mut Vec<PoseDerivatives>,
        found: &mut FlankContacts,
    ) {
        let side = &self.pair.sides[flank as usize];
        let sliced = &self.sides[flank as usize];
        let stands = (pose.rotation, pose.displacement_m);
        let points = Cell::new(0);
        let bodies = placed(&side.patches, candidate.turns_rad, stands, &points);
        let (line, first) = (found.lines.len(), found.contacts.len());
        let mut least_m = f64::INFINITY;
        for (slice, guess) in guesses.iter().enumerate() {
            let Some(guess) = guess.filter(|guess| guess.gap_m <= reach_m) else {
                continue;
            };
            let s = middle(slice, self.layout.slices);
            let likely = sliced.nominal[slice]
                .limits(&guess)
                .map(|limits| limits.long());
            let edges = likely.chain(EDGES);
            let Some(point) = nearest_on_section(&bodies, s, edges, guess.at) else {
                continue;
            };
            let motion = PoseDerivatives::new(&point, &pose.displacement_m);
            if self.push(pose, flank, (line, slice), (&point, &motion), found) {
                least_m = least_m.min(point.gap_m);
                list.push(motion);
            }
        }
        self.pair.count_points(points.get());
        if found.contacts.len() > first {
            found.add_line(candidate.teeth, first, least_m);
        }
    }

    /// Adds a patch if any of it stands on gear 2.
    pub(super) fn push(
        &self,
        pose: &Pose,
        flank: Flank,
        (line, slice): (usize, usize),
        (point, motion): (&Nearest, &PoseDerivatives),
        found: &mut FlankContacts,
    ) -> bool {
        let row = |i: usize| motion.places.row(i).transpose();
        let widths_m = self.pair.layout.face_widths_m;
        // Of gear 2's face that a slice covers.
        let covered = widths_m[0] / widths_m[1] / self.layout.slices as f64;
        let (share, share_by_s) = share_on_face(point.at[1][0], covered);
        if share < LEAST_SHARE {
            return false;
        }
        let number = found.contacts.len();
        let gradient = gradient(point, &pose.displacement_m);
        let up = point.at.map(|at| at[1]);
        let [radius, length] = self.sides[flank as usize].line.at(point.at[0]);
        found.sections.push(Section {
            roll_rad: up,
            touching_roll_rad: up,
            roll_gradient: [row(1), row(3)],
            share,
            share_gradient: share_by_s * row(2),
            stiffness: 1.0,
            length_m: share * length.value / self.layout.slices as f64,
            radius_m: radius.value,
            radius_growth: [radius.growth, 0.0],
            length_growth: [length.growth, 0.0],
            along_gradient: [Vector6::zeros(), widths_m[1] * row(2)],
            contacts: (number, 1),
        });
        found.contacts.push(ToothContact {
            line,
            slice,
            section: number,
            heights_m: [0, 1].map(|m: usize| (point.at[m][0] - 0.5) * widths_m[m]),
            gap_m: point.gap_m,
            gap_rate_m_per_s: gradient.dot(&pose.rates()),
            gradient,
        });
        true
    }
}

/// Share of a slice that stands on gear 2's face, its middle at s there and `covered` of the face long, and its
/// derivative by s.
fn share_on_face(s: f64, covered: f64) -> (f64, f64) {
    let over = |beyond: f64| match beyond {
        x if x <= 0.0 => (0.0, 0.0),
        x if x < ROUNDING => (0.5 * x * x / ROUNDING, x / ROUNDING),
        x => (x - 0.5 * ROUNDING, 1.0),
    };
    let (toe, toe_slope) = over(0.5 - s / covered);
    let (heel, heel_slope) = over(0.5 + (s - 1.0) / covered);
    (1.0 - toe - heel, (toe_slope - heel_slope) / covered)
}

impl FlankKinematics for BevelSlices {
    fn layout(&self) -> &SliceLayout {
        &self.layout
    }

    fn capacity(&self) -> usize {
        MOST_PAIRS * self.layout.slices
    }

    fn pitch_m(&self) -> f64 {
        self.pair.pitch_m()
    }

    fn locate(&mut self, pose: &Pose) -> Result<(), DrivetrainError> {
        self.pair.locate(pose)
    }

    fn contacts(&mut self, pose: &Pose, side: Flank, found: &mut FlankContacts) {
        let mut own = self.take(side);
        let mut guesses = std::mem::take(&mut self.guesses);
        let places = (&mut own.0, &mut guesses, &mut own.1);
        self.is_apart[side as usize] = self.find(pose, side, places, found);
        self.put(side, own);
        self.guesses = guesses;
    }

    fn reaches(&mut self, approach_m: f64) -> Result<bool, DrivetrainError> {
        // Within a fifth of the reach guesses of gaps may miss.
        if approach_m < 0.8 * self.reach_m {
            return Ok(true);
        }
        self.reach_m *= 2.0;
        if self.reach_m <= MOST_REACH_M {
            return Ok(false);
        }
        Err(DrivetrainError::Value {
            owner: "bevel pair under load",
            what: "the approach of the flanks in mm",
            found: 1e3 * approach_m,
            allowed: "less than 1.5: state smaller torques or errors of assembly",
        })
    }

    fn contacts_nearby(&mut self, pose: &Pose, side: Flank, found: &mut FlankContacts) {
        let mut own = self.take(side);
        let again = self.find_again(pose, side, (&mut own.0, &mut own.1), found);
        self.put(side, own);
        if !again {
            self.contacts(pose, side, found);
        }
    }

    fn contacts_at(
        &self,
        pose: &Pose,
        side: Flank,
        found: &mut FlankContacts,
    ) -> Result<(), DrivetrainError> {
        self.pair.check_axes(pose)?;
        let mut searched = Searched::with_capacity(0, 0);
        let places = (&mut Vec::new(), &mut Vec::new(), &mut searched);
        self.find(pose, side, places, found);
        Ok(())
    }

    fn gap_curvature(&self, _: &FlankContacts, contact: usize, side: Flank) -> Matrix6 {
        self.found[side as usize].gap_curvature(contact)
    }

    fn sliding(
        &self,
        _: &FlankContacts,
        contact: usize,
        side: Flank,
        derivatives: bool,
    ) -> [Option<Tangent>; 2] {
        self.found[side as usize].sliding(contact, derivatives)
    }

    fn tangents_on_flanks(&self, contact: usize, side: Flank) -> Option<[[[f64; 2]; 2]; 2]> {
        self.found[side as usize].tangents_on_flanks(contact)
    }

    fn nearest_gap_m(&self, side: Flank) -> Option<f64> {
        self.pair.nearest_gap_m(side)
    }

    fn is_apart(&self) -> bool {
        self.is_apart.iter().all(|apart| *apart)
    }

    fn towards_gear_2(&self, pose: &Pose) -> Vector3<f64> {
        self.pair.towards_gear_2(pose)
    }
}
