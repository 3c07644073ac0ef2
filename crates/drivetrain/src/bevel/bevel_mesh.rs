//! Kinematics of a bevel pair: which teeth face each other at a pose, where they are nearest.
//!
//! Frames of the gears: origin in the pitch apex, z towards the heel, the middle of tooth 0 on +x at the mean point.
//! Each pair of teeth makes one patch, a point that is nearest.

use std::cell::Cell;
use std::f64::consts::TAU;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use gearmesh_bevel::tca::are_conjugate;
use gearmesh_bevel::{PairBlank, PairDesign};
use gearmesh_contact::{RelativeCurvature, SliceLayout};
use gearmesh_geometry::Flank;
use nalgebra::Vector3;

use super::facets::{FacetSize, Facets};
use super::hertz_stiffness::{local_measure, principal, stiffness_per_pa};
use super::pose_derivatives::{MovingContacts, PoseDerivatives, gradient};
use super::tooth_pairing::MOST_PAIRS;
use super::tooth_side::{FAR, Guesses, Side, about_z, nominal_rotation, placed, side_of};
use super::touch::Touch;
use crate::error::DrivetrainError;
use crate::flank_contacts::{FlankContacts, Section, ToothContact};
use crate::flank_kinematics::{ContactPatch, FlankKinematics, Tangent};
use crate::pose::{Pose, Vector6, on_turn};
use crate::slice_plane::Matrix6;

/// So do those that stand open by this share of a pitch more than the nearest ones.
const NEAR: f64 = 0.03;
/// How far the shaft angle may be off \[rad\], and the apexes apart over the mean cone distance.
const MOST_TILT_RAD: f64 = 0.05;
const MOST_APART: f64 = 0.1;
/// Least relative curvature over the largest at the mean point below which flanks touch along a line.
const LINE_CONTACT: f64 = 1e-5;

/// Flanks of a bevel pair, gear 1 the pinion.
#[derive(Debug, Clone)]
pub struct BevelMesh {
    pub(super) teeth: [usize; 2],
    pub(super) shaft_angle_rad: f64,
    pub(super) mean_cone_m: f64,
    pub(super) layout: SliceLayout,
    /// Right and left.
    pub(super) sides: [Side; 2],
    at: Option<Pose>,
    found: [MovingContacts; 2],
    touches: [Vec<Touch>; 2],
    /// Whether any flanks were near enough for their spheres to meet.
    is_apart: [bool; 2],
    /// Points of flanks that were computed, by this mesh and all copies of it.
    pub(super) points: Arc<AtomicU64>,
    /// Whether the stiffness of contacts follows their curvature; that at the mean points of right and left flanks over
    /// E*.
    hertz: Option<[f64; 2]>,
    /// Right and left flanks of gear 1 as facets.
    facets: Option<[Facets; 2]>,
}

/// Why flanks have no relative curvature: they touch along a line, or, where the exact ones do not, the patches that
/// stand for them do not follow a surface that turns back close below.
fn no_point_contact(blank: &PairBlank, design: &PairDesign, flank: Flank) -> DrivetrainError {
    let flanks = [0, 1].map(|m: usize| design.teeth[m].flank(side_of(blank, m, flank)));
    match are_conjugate(flanks, blank) {
        true => DrivetrainError::LineContact { flank },
        false => DrivetrainError::FlankTurnsBack { flank },
    }
}

/// A pair of teeth as its contact has it.
struct NearFlanks {
    teeth: [usize; 2],
    /// Place up the flanks of gear 1 and gear 2, and its derivatives by the increments of the pose.
    up: [f64; 2],
    up_gradient: [Vector6; 2],
    /// Place along the faces from their middles \[m\].
    heights_m: [f64; 2],
    radius_m: f64,
    /// Of smooth flanks \[m\].
    ideal_gap_m: f64,
    gap_m: f64,
    gradient: Vector6,
}

impl BevelMesh {
    /// The flanks of a pair that has been designed.
    ///
    /// # Errors
    /// [`DrivetrainError::Bevel`] where a surface does not reach over its blank, [`DrivetrainError::FlankTurnsBack`]
    /// where it turns back so close below the flank that its curvature is not known well enough,
    /// [`DrivetrainError::LineContact`] for conjugate flanks.
    pub fn new(blank: &PairBlank, design: &PairDesign) -> Result<Self, DrivetrainError> {
        let sides = [
            Side::new(blank, design, Flank::Right)?,
            Side::new(blank, design, Flank::Left)?,
        ];
        let mesh = Self {
            teeth: blank.data.teeth,
            shaft_angle_rad: blank.data.shaft_angle_rad,
            mean_cone_m: blank.mean_cone_m,
            layout: SliceLayout::new(blank.data.face_width_m, 0.0, 1),
            sides,
            at: None,
            found: [0, 1].map(|_| MovingContacts::with_capacity(MOST_PAIRS)),
            touches: [0, 1].map(|_| Vec::with_capacity(MOST_PAIRS)),
            is_apart: [false; 2],
            points: Arc::default(),
            hertz: None,
            facets: None,
        };
        for flank in Flank::ALL {
            let [least, largest] = mesh.mean_curvature(flank).principal_per_m;
            if least < LINE_CONTACT * largest {
                return Err(no_point_contact(blank, design, flank));
            }
        }
        Ok(mesh)
    }

    /// Pose of gear 2 where the pair stands as designed and gears 1 and 2 have turned by these angles about their axes
    /// \[rad\]; both tooth 0 are at turn 0 in the plane of the axes.
    #[must_use]
    pub fn nominal_pose(&self, turns_rad: [f64; 2]) -> Pose {
        let rotation = nominal_rotation(self.shaft_angle_rad, turns_rad);
        Pose::at_rest(Vector3::zeros(), rotation)
    }

    /// Relative curvature of both flanks where their mean points meet.
    #[must_use]
    pub fn mean_curvature(&self, flank: Flank) -> RelativeCurvature {
        let side = &self.sides[flank as usize];
        let turns = side.azimuths_rad.map(|azimuth| -azimuth);
        let rotation = self.nominal_pose([0.0; 2]).rotation;
        let axes = [about_z(turns[0]), rotation * about_z(turns[1])];
        let points = [0, 1].map(|m: usize| side.patches[m].point(side.patches[m].mean));
        let normal = axes[1] * points[1].n;
        let curvatures = [0, 1].map(|m: usize| {
            let tensor = axes[m] * points[m].curvature() * axes[m].transpose();
            let first = (axes[m] * points[m].dr[0]).normalize();
            principal(&tensor, &normal, &first)
        });
        RelativeCurvature::new(normal, curvatures)
    }

    /// Lets the stiffness of contacts follow their curvature, from [`Self::hertz_stiffness`] at the mean points.
    #[must_use]
    pub fn with_hertz(mut self) -> Self {
        self.hertz = Some(Flank::ALL.map(|side| stiffness_per_pa(&self.mean_curvature(side))));
        self
    }

    /// Takes the flanks of gear 1 as facets against the smooth ones of gear 2: the approach of a pair of teeth is then
    /// measured by all that is covered of them. It does not depend on how fine they are, once the contact spans some.
    ///
    /// # Errors
    /// [`DrivetrainError::Value`] for edges that are not positive, longer than an eighth of the flank, or too short.
    pub fn with_facets(mut self, size: FacetSize) -> Result<Self, DrivetrainError> {
        let [right, left] = &self.sides;
        self.facets = Some([
            Facets::new(&right.patches, size)?,
            Facets::new(&left.patches, size)?,
        ]);
        Ok(self)
    }

    /// K of F = K δ^1.5 where the mean points of a side touch \[N/m^1.5\], after Hertz, with E* \[Pa\].
    #[must_use]
    pub fn hertz_stiffness(&self, side: Flank, contact_modulus_pa: f64) -> f64 {
        contact_modulus_pa * stiffness_per_pa(&self.mean_curvature(side))
    }

    /// Counts points.
    pub(super) fn count_points(&self, points: u64) {
        self.points.fetch_add(points, Ordering::Relaxed);
    }

    /// Points of flanks that were computed so far at all poses, by this mesh and all copies of it: the effort of the
    /// search.
    #[must_use]
    pub fn computed_points(&self) -> u64 {
        self.points.load(Ordering::Relaxed)
    }

    /// Azimuths of the mean points of tooth 0 of both gears on a side \[rad\].
    #[must_use]
    pub fn azimuths_rad(&self, side: Flank) -> [f64; 2] {
        self.sides[side as usize].azimuths_rad
    }

    /// Face widths along the pitch cones \[m\].
    #[must_use]
    pub fn face_widths_m(&self) -> [f64; 2] {
        self.layout.face_widths_m
    }

    /// Numbers of teeth.
    #[must_use]
    pub fn teeth(&self) -> [usize; 2] {
        self.teeth
    }

    /// Point \[m\] of a flank of tooth 0 of gear 0 or 1 in its frame, at shares along the face and up the flank.
    ///
    /// # Panics
    /// If there is no such gear.
    #[must_use]
    pub fn flank_point_m(&self, side: Flank, gear: usize, at: [f64; 2]) -> Vector3<f64> {
        self.sides[side as usize].patches[gear].point(at).r
    }

    /// Corners of the flanks of gear 1 and gear 2 \[m\]: cone distance and height above the pitch cone of lower line
    /// and tip at the toe, tip and lower line at the heel. Those of right flanks; left ones have the same.
    #[must_use]
    pub fn flank_corners_m(&self) -> [[[f64; 2]; 4]; 2] {
        let corners = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]];
        [0, 1].map(|m: usize| corners.map(|at| self.sides[0].patches[m].place_m(at)))
    }

    /// Levers of the normal at the mean points about the axes of gear 1 and gear 2 \[m\], those of right flanks.
    #[must_use]
    pub fn levers_m(&self) -> [f64; 2] {
        self.sides[0].levers_m
    }

    /// Goes over all pairs of teeth of a side.
    fn find(
        &self,
        pose: &Pose,
        flank: Flank,
        (list, touches): (&mut Vec<PoseDerivatives>, &mut Vec<Touch>),
        found: &mut FlankContacts,
    ) -> bool {
        found.clear();
        list.clear();
        touches.clear();
        let side = &self.sides[flank as usize];
        found.action_m_per_u = [0.0; 2];
        let mut guesses = [Guesses::default(); MOST_PAIRS];
        let candidates = || self.candidates(pose, flank).zip(0..MOST_PAIRS);
        for (candidate, number) in candidates() {
            let back = about_z(-candidate.turns_rad[0]);
            let rotation = back * pose.rotation * about_z(candidate.turns_rad[1]);
            let moved_m = back * pose.displacement_m;
            guesses[number] = side.guesses(candidate.angle_1_rad, &moved_m, &rotation);
        }
        // What guesses may miss at most, for a gap changes by no more than the axes move: only of those that stand so
        // far open is nothing computed.
        let moved_m = pose.displacement_m.norm()
            + self.mean_cone_m * (angle_of(&pose.axis_2()) - self.shaft_angle_rad).abs();
        let gaps = guesses.iter().filter_map(Guesses::gap_m);
        let least_m = gaps.fold(f64::INFINITY, f64::min).max(0.0);
        let far_m = FAR * self.pitch_m();
        let looked_m = far_m.min(least_m + NEAR * self.pitch_m()) + 2.0 * moved_m;
        let points = Cell::new(0);
        for (candidate, number) in candidates() {
            let guesses = &guesses[number];
            if guesses.gap_m().is_some_and(|gap_m| gap_m > looked_m) {
                continue;
            }
            let stands = (pose.rotation, pose.displacement_m);
            let bodies = placed(&side.patches, candidate.turns_rad, stands, &points);
            let Some(point) = side.contact(&bodies, guesses, far_m) else {
                continue;
            };
            let motion = PoseDerivatives::new(&point, &pose.displacement_m);
            let mut touch = Touch::new(&point);
            let up = |m: usize| motion.places.row(2 * m + 1).transpose();
            let mut contact = NearFlanks {
                teeth: candidate.teeth,
                up: point.at.map(|at| at[1]),
                up_gradient: [up(0), up(1)],
                heights_m: [0, 1]
                    .map(|m: usize| (point.at[m][0] - 0.5) * self.layout.face_widths_m[m]),
                radius_m: 1.0 / touch.relative.principal_per_m[1],
                ideal_gap_m: point.gap_m,
                gap_m: point.gap_m,
                gradient: gradient(&point, &pose.displacement_m),
            };
            if let (Some(facets), true) = (&self.facets, point.gap_m < 0.0) {
                let sunk = facets[flank as usize].sunk(&bodies, &point, &motion);
                contact.gap_m = sunk.map_or(0.0, |sunk| sunk.gap_m);
                contact.gradient = sunk.map_or(contact.gradient, |sunk| sunk.gradient);
                touch.gap_curvature = sunk.map(|sunk| sunk.curvature);
            }
            self.push(pose, &contact, found);
            if let (Some(mean), true) = (&self.hertz, point.gap_m < 0.0) {
                let (local, gradient) = local_measure(&bodies, &point, &motion, stiffness_per_pa);
                let last = found.sections.len() - 1;
                found.sections[last].stiffness = local / mean[flank as usize];
                found.sections[last].share_gradient = gradient;
            }
            list.push(motion);
            touches.push(touch);
        }
        self.count_points(points.get());
        // The nearest pair first: the transmission error is its gap.
        if let Some(first) = nearest_first(found) {
            list.swap(0, first);
            touches.swap(0, first);
        }
        if list.is_empty() {
            self.push_apart(pose, flank, found);
        }
        list.is_empty()
    }

    /// Flanks that no sphere brings together, by their mean points: for gears that are still to be turned until they
    /// touch.
    pub(super) fn push_apart(&self, pose: &Pose, flank: Flank, found: &mut FlankContacts) {
        let side = &self.sides[flank as usize];
        let Some(nearest) = self.candidates(pose, flank).next() else {
            return;
        };
        let lever = flank.mirror() * side.levers_m[1];
        let apart = NearFlanks {
            teeth: nearest.teeth,
            up: [0, 1].map(|m: usize| side.patches[m].mean[1]),
            up_gradient: [Vector6::zeros(); 2],
            heights_m: [0.0; 2],
            radius_m: 1.0 / self.mean_curvature(flank).principal_per_m[1],
            ideal_gap_m: nearest.mean_gap_m,
            gap_m: nearest.mean_gap_m,
            gradient: on_turn(lever * pose.axis_2()),
        };
        self.push(pose, &apart, found);
    }

    fn push(&self, pose: &Pose, near: &NearFlanks, found: &mut FlankContacts) {
        let number = found.contacts.len();
        found.sections.push(Section {
            roll_rad: near.up,
            touching_roll_rad: near.up,
            roll_gradient: near.up_gradient,
            share: 1.0,
            stiffness: 1.0,
            length_m: self.layout.width_m(),
            radius_m: near.radius_m,
            contacts: (number, 1),
            ..Section::default()
        });
        found.contacts.push(ToothContact {
            line: number,
            slice: 0,
            section: number,
            heights_m: near.heights_m,
            gap_m: near.gap_m,
            gap_rate_m_per_s: near.gradient.dot(&pose.rates()),
            gradient: near.gradient,
        });
        found.add_line(near.teeth, number, near.ideal_gap_m);
    }
}

/// Brings the nearest pair of teeth to the front, with its one contact and its section; returns its number before.
fn nearest_first(found: &mut FlankContacts) -> Option<usize> {
    let first = found.nearest_first()?;
    found.contacts.swap(0, first);
    found.sections.swap(0, first);
    for number in [0, first] {
        found.lines[number].section = number;
        found.lines[number].contacts = (number, 1);
        found.sections[number].contacts = (number, 1);
        found.contacts[number].section = number;
    }
    Some(first)
}

/// Angle of a gear's axis from gear 1's \[rad\].
pub(super) fn angle_of(axis: &Vector3<f64>) -> f64 {
    axis[2].clamp(-1.0, 1.0).acos()
}

impl FlankKinematics for BevelMesh {
    fn layout(&self) -> &SliceLayout {
        &self.layout
    }

    fn capacity(&self) -> usize {
        MOST_PAIRS
    }

    /// That of the mean points along the normal.
    fn pitch_m(&self) -> f64 {
        TAU / self.teeth[1] as f64 * self.sides[0].levers_m[1]
    }

    fn locate(&mut self, pose: &Pose) -> Result<(), DrivetrainError> {
        self.check_axes(pose)?;
        self.at = Some(*pose);
        Ok(())
    }

    fn contacts(&mut self, pose: &Pose, side: Flank, found: &mut FlankContacts) {
        let mut list = std::mem::take(&mut self.found[side as usize].0);
        let mut touches = std::mem::take(&mut self.touches[side as usize]);
        self.is_apart[side as usize] = self.find(pose, side, (&mut list, &mut touches), found);
        self.found[side as usize].0 = list;
        self.touches[side as usize] = touches;
    }

    fn contacts_at(
        &self,
        pose: &Pose,
        side: Flank,
        found: &mut FlankContacts,
    ) -> Result<(), DrivetrainError> {
        self.check_axes(pose)?;
        self.find(pose, side, (&mut Vec::new(), &mut Vec::new()), found);
        Ok(())
    }

    fn gap_curvature(&self, _: &FlankContacts, contact: usize, side: Flank) -> Matrix6 {
        let of_facets = self.touches[side as usize].get(contact);
        let of_facets = of_facets.and_then(|touch| touch.gap_curvature);
        of_facets.unwrap_or_else(|| self.found[side as usize].gap_curvature(contact))
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

    fn contact_patch(
        &self,
        contact: usize,
        side: Flank,
        force_and_modulus: (f64, f64),
    ) -> Option<ContactPatch> {
        let touch = self.touches[side as usize].get(contact)?;
        Some(touch.patch(force_and_modulus))
    }

    /// The gap of the mean points, between the pairs that are nearest.
    fn nearest_gap_m(&self, side: Flank) -> Option<f64> {
        let pose = self.at.as_ref()?;
        let gaps = self
            .candidates(pose, side)
            .map(|candidate| candidate.mean_gap_m);
        gaps.min_by(|a, b| a.abs().total_cmp(&b.abs()))
    }

    fn is_apart(&self) -> bool {
        self.is_apart.iter().all(|apart| *apart)
    }

    /// From gear 1's axis towards that of gear 2.
    fn towards_gear_2(&self, pose: &Pose) -> Vector3<f64> {
        pose.axis_2()
    }
}

impl BevelMesh {
    /// Whether the axes stand as flanks can follow.
    pub(super) fn check_axes(&self, pose: &Pose) -> Result<(), DrivetrainError> {
        let tilt = angle_of(&pose.axis_2()) - self.shaft_angle_rad;
        let apart = pose.displacement_m.norm();
        if !(tilt.abs() <= MOST_TILT_RAD && apart <= MOST_APART * self.mean_cone_m) {
            return Err(DrivetrainError::BevelAxes {
                shaft_deg: (tilt + self.shaft_angle_rad).to_degrees(),
                designed_deg: self.shaft_angle_rad.to_degrees(),
                apart_mm: 1e3 * apart,
                allowed_mm: 1e3 * MOST_APART * self.mean_cone_m,
            });
        }
        Ok(())
    }
}
