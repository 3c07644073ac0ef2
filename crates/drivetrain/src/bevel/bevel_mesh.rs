//! Kinematics of a bevel pair: which teeth face each other at a pose, where they are nearest.
//!
//! Frames of the gears: origin in the pitch apex, z towards the heel, the middle of tooth 0 on +x at the mean point. Each
//! pair of teeth makes one patch, a point that is nearest.

use std::cell::Cell;
use std::f64::consts::TAU;

use gearmesh_bevel::{FlankPatch, FlankSide, PairBlank, PairDesign};
use gearmesh_contact::{RelativeCurvature, SliceLayout, SurfaceCurvature};
use gearmesh_geometry::Flank;
use nalgebra::{Matrix3, Rotation3, Vector3};

use super::bounding_spheres::BoundingSpheres;
use super::nearest_points::{Nearest, Placed, nearest, nearest_within};
use super::nominal_contacts::{Guess, NominalContacts};
use super::pose_derivatives::{PoseDerivatives, gradient};
use crate::error::DrivetrainError;
use crate::flank_contacts::{FlankContacts, Section, TeethLine, ToothContact};
use crate::flank_kinematics::FlankKinematics;
use crate::pose::{Pose, Vector6};
use crate::slice_plane::{Matrix6, on_turn};

/// Pitches of the pinion to either side of the plane of the axes within which teeth are looked at.
const REACH: f64 = 3.5;
/// Flanks that stand farther open than this share of a pitch do not touch soon, and are passed over.
const FAR: f64 = 0.2;
/// So do those that stand open by this share of a pitch more than the nearest ones.
const NEAR: f64 = 0.03;
/// Pairs of teeth that are looked at.
const MOST_PAIRS: usize = 2 * REACH as usize + 1;
/// How far the shaft angle may be off \[rad\], and the apexes apart over the mean cone distance.
const MOST_TILT_RAD: f64 = 0.05;
const MOST_APART: f64 = 0.1;
/// Least relative curvature over the largest at the mean point below which flanks touch along a line.
const LINE_CONTACT: f64 = 1e-5;

/// A flank of each member on one side of the teeth.
#[derive(Debug, Clone)]
struct Side {
    patches: [FlankPatch; 2],
    spheres: [BoundingSpheres; 2],
    nominal: NominalContacts,
    /// Azimuth of the mean points of tooth 0 \[rad\].
    azimuths_rad: [f64; 2],
    /// Lever of the normal at the mean point of gear 1 and gear 2 \[m\].
    levers_m: [f64; 2],
}

/// Flanks of a bevel pair, gear 1 the pinion.
#[derive(Debug, Clone)]
pub struct BevelMesh {
    teeth: [usize; 2],
    shaft_angle_rad: f64,
    mean_cone_m: f64,
    layout: SliceLayout,
    /// Right and left.
    sides: [Side; 2],
    at: Option<Pose>,
    found: [Vec<PoseDerivatives>; 2],
    /// Whether any flanks were near enough for their spheres to meet.
    is_apart: [bool; 2],
    /// Points of flanks that were computed.
    points: Cell<u64>,
}

impl Side {
    fn new(blank: &PairBlank, design: &PairDesign, flank: Flank) -> Result<Self, DrivetrainError> {
        let patch = |member: usize| {
            // Right flanks face clockwise.
            let facing = -flank.mirror();
            let own = &blank.members[member];
            let side = FlankSide::BOTH
                .into_iter()
                .find(|side| side.facing(own.hand) == facing);
            let side = side.unwrap_or(FlankSide::Concave);
            FlankPatch::of_tooth(&design.teeth[member], &blank.members[1 - member], side)
        };
        let patches = [patch(0)?, patch(1)?];
        let spheres = [0, 1].map(|m: usize| BoundingSpheres::new(&patches[m]));
        let azimuths_rad = [0, 1].map(|m: usize| patches[m].azimuth_rad(patches[m].mean));
        let levers_m = [0, 1].map(|m: usize| patches[m].lever_m());
        let [pitch_1, pitch_2] = blank.data.teeth.map(|z| TAU / z as f64);
        let count = Cell::new(0);
        let nominal = NominalContacts::new(pitch_1, REACH, |angle_1| {
            let angles = [angle_1, -angle_1 * pitch_2 / pitch_1];
            let turns = [0, 1].map(|m: usize| angles[m] - azimuths_rad[m]);
            let rotation = nominal_rotation(blank.data.shaft_angle_rad, turns);
            let bodies = placed(
                &patches,
                [Matrix3::identity(), rotation],
                Vector3::zeros(),
                &count,
            );
            (
                rotation,
                searched(&bodies, &spheres, FAR * pitch_2 * levers_m[1]),
            )
        });
        Ok(Self {
            patches,
            spheres,
            nominal,
            azimuths_rad,
            levers_m,
        })
    }
}

/// Both flanks of a side in the frame of gear 1.
fn placed<'a>(
    patches: &'a [FlankPatch; 2],
    rotations: [Matrix3<f64>; 2],
    displacement_m: Vector3<f64>,
    points: &'a Cell<u64>,
) -> [Placed<'a>; 2] {
    let origins_m = [Vector3::zeros(), displacement_m];
    [0, 1].map(|m: usize| Placed {
        patch: &patches[m],
        rotation: rotations[m],
        origin_m: origins_m[m],
        points,
    })
}

/// Nearest points without a guess, beginning at the two nearest of all bounding spheres.
fn searched(
    bodies: &[Placed<'_>; 2],
    spheres: &[BoundingSpheres; 2],
    far_m: f64,
) -> Option<Nearest> {
    let [first, second] = bodies;
    let guess = BoundingSpheres::meet(
        [&spheres[0], &spheres[1]],
        [&first.rotation, &second.rotation],
        second.origin_m,
    )?;
    nearest(bodies, guess, far_m)
}

/// Gear 2's axes in gear 1's where the pair stands as designed and the gears have turned by these angles.
fn nominal_rotation(shaft_angle_rad: f64, turns_rad: [f64; 2]) -> Matrix3<f64> {
    let (sin, cos) = shaft_angle_rad.sin_cos();
    // x towards gear 1's axis, y against gear 1's.
    let axes = Matrix3::new(-cos, 0.0, sin, 0.0, -1.0, 0.0, sin, 0.0, cos);
    about_z(-turns_rad[0]) * axes * about_z(turns_rad[1])
}

/// A pair of teeth that may touch.
struct Candidate {
    teeth: [usize; 2],
    turns_rad: [f64; 2],
    /// Of gear 1's mean point from the plane of the axes.
    angle_1_rad: f64,
    /// Gap that the mean points would have \[m\].
    mean_gap_m: f64,
}

impl BevelMesh {
    /// The flanks of a pair that has been designed.
    ///
    /// # Errors
    /// [`DrivetrainError::Bevel`] where a surface does not reach over its blank, [`DrivetrainError::LineContact`] for
    /// conjugate flanks.
    pub fn new(blank: &PairBlank, design: &PairDesign) -> Result<Self, DrivetrainError> {
        let sides = [
            Side::new(blank, design, Flank::Right)?,
            Side::new(blank, design, Flank::Left)?,
        ];
        let mut mesh = Self {
            teeth: blank.data.teeth,
            shaft_angle_rad: blank.data.shaft_angle_rad,
            mean_cone_m: blank.mean_cone_m,
            layout: SliceLayout::new(blank.data.face_width_m, 0.0, 1),
            sides,
            at: None,
            found: [Vec::new(), Vec::new()],
            is_apart: [false; 2],
            points: Cell::new(0),
        };
        let capacity = mesh.capacity();
        mesh.found = [0, 1].map(|_| Vec::with_capacity(capacity));
        for flank in Flank::ALL {
            let [least, largest] = mesh.mean_curvature(flank).principal_per_m;
            if least < LINE_CONTACT * largest {
                return Err(DrivetrainError::LineContact { flank });
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

    /// Points of flanks that were computed so far at all poses: the effort of the search.
    #[must_use]
    pub fn computed_points(&self) -> u64 {
        self.points.get()
    }

    /// Levers of the normal at the mean points about the axes of gear 1 and gear 2 \[m\], those of right flanks.
    #[must_use]
    pub fn levers_m(&self) -> [f64; 2] {
        self.sides[0].levers_m
    }

    /// Pairs of teeth whose flanks may face each other; the one nearest to the plane of the axes first.
    fn candidates(&self, pose: &Pose, flank: Flank) -> impl Iterator<Item = Candidate> {
        let side = &self.sides[flank as usize];
        let (b, k) = (
            pose.axis_2(),
            pose.rotation.transpose().column(2).into_owned(),
        );
        // Where the plane of the axes stands, seen in each gear.
        let zones = [b[1].atan2(b[0]), k[1].atan2(k[0])];
        let pitches = self.teeth.map(|z| TAU / z as f64);
        let [from_1, from_2] = [0, 1].map(|m: usize| side.azimuths_rad[m] - zones[m]);
        let middle = -(from_1 / pitches[0]).round() as i64;
        let reach = REACH.min(0.5 * self.teeth[0] as f64 - 1.0) as i64;
        let (teeth, lever, sigma) = (self.teeth, side.levers_m[1], flank.mirror());
        let outwards = (0..=2 * reach).map(|i| if i % 2 == 0 { -i / 2 } else { (i + 1) / 2 });
        outwards.map(move |ahead| {
            let tooth_1 = middle + ahead;
            let angle_1 = from_1 + tooth_1 as f64 * pitches[0];
            let wanted_2 = -angle_1 * teeth[0] as f64 / teeth[1] as f64;
            let tooth_2 = ((wanted_2 - from_2) / pitches[1]).round();
            let behind = from_2 + tooth_2 * pitches[1] - wanted_2;
            Candidate {
                teeth: [
                    tooth_1.rem_euclid(teeth[0] as i64),
                    (tooth_2 as i64).rem_euclid(teeth[1] as i64),
                ]
                .map(|tooth| tooth as usize),
                angle_1_rad: angle_1,
                turns_rad: [tooth_1 as f64 * pitches[0], tooth_2 * pitches[1]],
                mean_gap_m: sigma * behind * lever,
            }
        })
    }

    /// Goes over all pairs of teeth of a side.
    fn find(
        &self,
        pose: &Pose,
        flank: Flank,
        list: &mut Vec<PoseDerivatives>,
        found: &mut FlankContacts,
    ) -> bool {
        found.clear();
        list.clear();
        let side = &self.sides[flank as usize];
        found.action_m_per_u = [0.0; 2];
        let mut guesses: [Option<Guess>; MOST_PAIRS] = [None; MOST_PAIRS];
        let candidates = || self.candidates(pose, flank).zip(0..MOST_PAIRS);
        for (candidate, number) in candidates() {
            let back = about_z(-candidate.turns_rad[0]);
            let rotation = back * pose.rotation * about_z(candidate.turns_rad[1]);
            let angle = candidate.angle_1_rad;
            guesses[number] = side
                .nominal
                .guess(angle, &(back * pose.displacement_m), &rotation);
        }
        // What guesses may miss at most, for a gap changes by no more than the axes move: only of those that stand so far open
        // is nothing computed.
        let moved_m = pose.displacement_m.norm()
            + self.mean_cone_m * (angle_of(&pose.axis_2()) - self.shaft_angle_rad).abs();
        let gaps = guesses.iter().flatten().map(|guess| guess.gap_m);
        let least_m = gaps.fold(f64::INFINITY, f64::min).max(0.0);
        let far_m = FAR * self.pitch_m();
        let looked_m = far_m.min(least_m + NEAR * self.pitch_m()) + 2.0 * moved_m;
        for (candidate, number) in candidates() {
            let guess = &guesses[number];
            if guess.is_some_and(|guess| guess.gap_m > looked_m) {
                continue;
            }
            let rotations = [
                about_z(candidate.turns_rad[0]),
                pose.rotation * about_z(candidate.turns_rad[1]),
            ];
            let bodies = placed(&side.patches, rotations, pose.displacement_m, &self.points);
            let guessed = guess.as_ref().and_then(|guess| {
                let mut limits = side.nominal.limits(guess);
                limits.find_map(|limits| nearest_within(&bodies, limits, guess.at))
            });
            let Some(point) = guessed.or_else(|| searched(&bodies, &side.spheres, far_m)) else {
                continue;
            };
            let motion = PoseDerivatives::new(&point, &pose.displacement_m);
            self.push(pose, candidate.teeth, (&point, &motion), found);
            list.push(motion);
        }
        // The nearest pair first: the transmission error is its gap.
        let gap_m = |line: usize| found.lines[line].ideal_gap_m;
        if let Some(first) = (0..list.len()).min_by(|a, b| gap_m(*a).total_cmp(&gap_m(*b))) {
            found.lines.swap(0, first);
            found.contacts.swap(0, first);
            found.sections.swap(0, first);
            list.swap(0, first);
            for number in [0, first] {
                found.lines[number].section = number;
                found.lines[number].contacts = (number, 1);
                found.sections[number].contacts = (number, 1);
                found.contacts[number].line = number;
                found.contacts[number].section = number;
            }
        }
        if list.is_empty() {
            self.push_apart(pose, flank, found);
        }
        list.is_empty()
    }

    /// Flanks that no sphere brings together, by their mean points: for gears that are still to be turned until they touch.
    fn push_apart(&self, pose: &Pose, flank: Flank, found: &mut FlankContacts) {
        let side = &self.sides[flank as usize];
        let Some(nearest) = self.candidates(pose, flank).next() else {
            return;
        };
        let lever = flank.mirror() * side.levers_m[1];
        let gradient = on_turn(lever * pose.axis_2());
        let up = [0, 1].map(|m: usize| side.patches[m].mean[1]);
        found.lines.push(TeethLine {
            teeth: nearest.teeth,
            section: 0,
            ideal_gap_m: nearest.mean_gap_m,
            contacts: (0, 1),
        });
        found.sections.push(Section {
            roll_rad: up,
            touching_roll_rad: up,
            roll_gradient: [Vector6::zeros(); 2],
            share: 1.0,
            share_gradient: Vector6::zeros(),
            length_m: self.layout.width_m(),
            radius_m: 1.0 / self.mean_curvature(flank).principal_per_m[1],
            radius_growth: [0.0; 2],
            contacts: (0, 1),
        });
        found.contacts.push(ToothContact {
            line: 0,
            slice: 0,
            section: 0,
            heights_m: [0.0; 2],
            gap_m: nearest.mean_gap_m,
            gap_rate_m_per_s: gradient.dot(&pose.rates()),
            gradient,
        });
    }

    fn push(
        &self,
        pose: &Pose,
        teeth: [usize; 2],
        (point, motion): (&Nearest, &PoseDerivatives),
        found: &mut FlankContacts,
    ) {
        let number = found.contacts.len();
        let gradient = gradient(point, &pose.displacement_m);
        let up = point.at.map(|at| at[1]);
        let row = |i: usize| motion.places.row(i).transpose();
        found.lines.push(TeethLine {
            teeth,
            section: number,
            ideal_gap_m: point.gap_m,
            contacts: (number, 1),
        });
        found.sections.push(Section {
            roll_rad: up,
            touching_roll_rad: up,
            roll_gradient: [row(1), row(3)],
            share: 1.0,
            share_gradient: Vector6::zeros(),
            length_m: self.layout.width_m(),
            radius_m: 1.0 / curvature(point).principal_per_m[1],
            radius_growth: [0.0; 2],
            contacts: (number, 1),
        });
        found.contacts.push(ToothContact {
            line: number,
            slice: 0,
            section: number,
            heights_m: [0, 1].map(|m: usize| (point.at[m][0] - 0.5) * self.layout.face_widths_m[m]),
            gap_m: point.gap_m,
            gap_rate_m_per_s: gradient.dot(&pose.rates()),
            gradient,
        });
    }
}

/// Relative curvature of the surfaces at a contact.
fn curvature(point: &Nearest) -> RelativeCurvature {
    let surfaces = [0, 1].map(|m: usize| {
        let p = &point.points[m];
        principal(&p.curvature(), &point.normal, &p.dr[0].normalize())
    });
    RelativeCurvature::new(point.normal, surfaces)
}

/// Principal curvatures of a tensor in the plane across a normal.
fn principal(
    tensor: &Matrix3<f64>,
    normal: &Vector3<f64>,
    near: &Vector3<f64>,
) -> SurfaceCurvature {
    let x = (near - normal * normal.dot(near)).normalize();
    let y = normal.cross(&x);
    let (xx, yy, xy) = (
        x.dot(&(tensor * x)),
        y.dot(&(tensor * y)),
        x.dot(&(tensor * y)),
    );
    let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
    let spread = half.hypot(xy);
    let angle = 0.5 * xy.atan2(half);
    SurfaceCurvature {
        principal_per_m: [mean + spread, mean - spread],
        first: angle.cos() * x + angle.sin() * y,
    }
}

/// Angle of a gear's axis from gear 1's \[rad\].
fn angle_of(axis: &Vector3<f64>) -> f64 {
    axis[2].clamp(-1.0, 1.0).acos()
}

fn about_z(angle_rad: f64) -> Matrix3<f64> {
    *Rotation3::from_axis_angle(&Vector3::z_axis(), angle_rad).matrix()
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
        let mut list = std::mem::take(&mut self.found[side as usize]);
        self.is_apart[side as usize] = self.find(pose, side, &mut list, found);
        self.found[side as usize] = list;
    }

    fn contacts_at(
        &self,
        pose: &Pose,
        side: Flank,
        found: &mut FlankContacts,
    ) -> Result<(), DrivetrainError> {
        self.check_axes(pose)?;
        self.find(pose, side, &mut Vec::new(), found);
        Ok(())
    }

    fn gap_curvature(&self, _: &FlankContacts, contact: usize, side: Flank) -> Matrix6 {
        let motion = self.derivatives(contact, side);
        motion.map_or_else(Matrix6::zeros, |motion| motion.gap_curvature())
    }

    fn sliding(&self, _: &FlankContacts, contact: usize, side: Flank) -> Vector6 {
        let motion = self.derivatives(contact, side);
        motion.map_or_else(Vector6::zeros, |motion| motion.sliding()[0].0)
    }

    fn sliding_gradient(&self, _: &FlankContacts, contact: usize, side: Flank) -> Matrix6 {
        let motion = self.derivatives(contact, side);
        motion.map_or_else(Matrix6::zeros, |motion| motion.sliding()[0].1)
    }

    fn second_sliding(
        &self,
        _: &FlankContacts,
        contact: usize,
        side: Flank,
    ) -> Option<(Vector6, Matrix6)> {
        self.derivatives(contact, side)
            .map(|motion| motion.sliding()[1])
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
    fn check_axes(&self, pose: &Pose) -> Result<(), DrivetrainError> {
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

    fn derivatives(&self, contact: usize, side: Flank) -> Option<&PoseDerivatives> {
        self.found[side as usize].get(contact)
    }
}
