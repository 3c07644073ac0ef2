//! Which tooth flanks face each other at a pose of two gears, and how far apart they are.
//!
//! Everything is seen in gear 1's frame, slice plane by slice plane. With b gear 2's axis, σ = ±1 for right and left flanks, and
//! at the plane z
//!
//! ```text
//! d = u + z b,   a = |d_xy|,   β = polar angle of d,   cos α = R/a,   R = r_b1 + r_b2,   L = a sin α
//! ξ₁ = α + ψ_b1 − σ(−β + k₁τ₁ + κ₁z₁),  ξ₂ = α + ψ_b2 − σ(γ − β − π + k₂τ₂ + κ₂z)   roll angles on the line of action
//! g  = cos β_b (L − r_b1 ξ₁ − r_b2 ξ₂) + e₁(ξ₁, z) + e₂(ξ₂, z)                       gap, e: material removed
//! ```
//!
//! for tooth k₁ against tooth k₂; κ turns helical sections (base_helix.rs) and is zero on spur teeth. The gradient is in closed form: with w
//! the unit vector of the line of action (the transverse force on gear 2), w⊥ = e_z × w and t = ∂γ/∂ϑ,
//!
//! ```text
//! ∂ξ₁/∂(u, ϑ) = (σ w⊥/L, z b × σ w⊥/L) − σ κ₁ ∂z₁,     ∂ξ₂ = (σ w⊥/L, z b × σ w⊥/L) − (0, σ t)
//! ∂g/∂(u, ϑ)  = cos β_b (w, z b × w + σ r_b2 t) + σ sin β_b ∂z₁ + e₁′ ∂ξ₁ + e₂′ ∂ξ₂
//! ```
//!
//! Which teeth face each other follows from the angles alone: there is no memory, and a slipped pair is found again. Derivation, and
//! the second derivative: docs/theory/gear_meshes.md.

use std::f64::consts::TAU;

use gearmesh_geometry::{FlankSide, ToothGeometry};

use crate::base_helix::BaseHelix;
use crate::error::DrivetrainError;
use crate::flank_contacts::{FlankContacts, FlankErrors, Section, TeethLine, ToothContact};
use crate::flank_error::FlankPoint;
use crate::path_ends::{PathEnds, TipEdges, part_on_path};
use crate::pose::{Pose, Vector6};
use crate::slice_plane::{
    CentreLine, Matrix6, PoseGeometry, SlicePlane, even_width_m, line_of_action,
};
use crate::tooth_zero::ToothZero;

/// Largest angle between the axes \[rad\] for which slices in parallel planes are taken as the truth: neglected terms are of the order
/// of its square, 1e-4 of the lengths. The static scene has the same limit.
pub const LARGEST_MISALIGNMENT_RAD: f64 = 10e-3;

/// Two gears with their deviations.
#[derive(Clone)]
pub struct MeshKinematics {
    pub(crate) gears: [ToothGeometry; 2],
    errors: [FlankErrors; 2],
    slices_m: Vec<f64>,
    ends: PathEnds,
    edges: TipEdges,
    /// Roll angles up to which flanks touch, tip edges included.
    ends_rad: [f64; 2],
    pub(crate) helix: Option<BaseHelix>,
    /// Width of a slice \[m\]; none where there is one slice, which then stands for the whole face.
    slice_width_m: Option<f64>,
    /// How far the roll angle on gear 1 changes from mid-face to the faces \[rad\]; zero on spur teeth.
    slant_1_rad: f64,
    /// Bound of what deviations add to both flanks together \[m\].
    pub(crate) most_added_m: f64,
}

/// A pair of teeth in the slice planes of a pose: what its sections share.
struct PlacedTeeth<'a> {
    pose: &'a Pose,
    side: FlankSide,
    /// Roll angles that it is behind tooth 0 \[rad\].
    behind_rad: [f64; 2],
    teeth: [usize; 2],
}

/// Ideal flanks in a slice plane.
#[derive(Clone, Copy)]
struct IdealFlanks {
    roll_rad: [f64; 2],
    roll_gradient: [Vector6; 2],
    /// Along the normal \[m\].
    gap_m: f64,
    gradient: Vector6,
}

impl MeshKinematics {
    /// Two gears that run at about `centre_distance_m`, with slice planes at `slices_m` \[m\], evenly spaced on helical gears.
    ///
    /// # Errors
    /// [`DrivetrainError::Helix`] if the helices do not fit, [`DrivetrainError::CentreDistance`], [`DrivetrainError::Length`] without
    /// slices, or [`DrivetrainError::UnevenSlices`].
    pub fn new(
        gears: [ToothGeometry; 2],
        errors: [FlankErrors; 2],
        centre_distance_m: f64,
        slices_m: Vec<f64>,
        ends: PathEnds,
    ) -> Result<Self, DrivetrainError> {
        let [helix_1, helix_2] = [0, 1].map(|i: usize| gears[i].base_helix_angle_rad());
        if (helix_1 + helix_2).abs() > 1e-6 * helix_1.abs() {
            return Err(DrivetrainError::Helix {
                helix_1_deg: helix_1.to_degrees(),
                helix_2_deg: helix_2.to_degrees(),
            });
        }
        if slices_m.is_empty() {
            return Err(DrivetrainError::Length {
                owner: "gear mesh",
                what: "the list of slice planes",
                found: 0,
                expected: 1,
            });
        }
        let helix = BaseHelix::new(&gears);
        let slice_width_m = match helix {
            None => None,
            Some(_) => even_width_m(&slices_m)?,
        };
        let outermost = (slices_m.iter()).fold(0.0, |most: f64, z| most.max(z.abs()));
        let half_width = outermost + 0.5 * slice_width_m.unwrap_or(0.0);
        let slant_1_rad = helix.map_or(0.0, |h| h.twist_rad_per_m[0].abs() * half_width);
        let (length, _) = line_of_action(&gears, centre_distance_m)?;
        let edges = match ends {
            PathEnds::LineOfAction => TipEdges::default(),
            PathEnds::Extended => TipEdges::new(&gears, length, helix.map_or(1.0, |h| h.cos)),
        };
        let ends_rad = [0, 1].map(|i: usize| gears[i].flank_end_roll_rad + edges.reach_rad[i]);
        let most_added =
            |errors: &FlankErrors| errors.iter().map(|one| one.most_added_m()).sum::<f64>();
        let most_added_m = errors.iter().map(most_added).sum();
        Ok(Self {
            gears,
            errors,
            slices_m,
            ends,
            ends_rad,
            edges,
            helix,
            slice_width_m,
            slant_1_rad,
            most_added_m,
        })
    }

    /// The gears.
    #[must_use]
    pub fn gears(&self) -> &[ToothGeometry; 2] {
        &self.gears
    }

    /// Slice planes \[m\].
    #[must_use]
    pub fn slices_m(&self) -> &[f64] {
        &self.slices_m
    }

    /// How the path ends.
    #[must_use]
    pub fn ends(&self) -> PathEnds {
        self.ends
    }

    /// Whether the flanks of any gear deviate from the ideal.
    #[must_use]
    pub fn has_errors(&self) -> bool {
        self.errors.iter().any(|errors| !errors.is_empty())
    }

    /// Angle between two teeth \[rad\].
    #[must_use]
    pub fn pitch_rad(&self, gear: usize) -> f64 {
        TAU / self.gears[gear].teeth as f64
    }

    /// Largest number of slices that can face each other at once, for sizing.
    #[must_use]
    pub fn capacity(&self) -> usize {
        let span = self.ends_rad[0] + 2.0 * self.slant_1_rad;
        (span / self.pitch_rad(0)).ceil() as usize * self.slices_m.len() + self.slices_m.len()
    }

    /// Finds what both sides of the teeth share.
    ///
    /// # Errors
    /// [`DrivetrainError::Misalignment`], [`DrivetrainError::CentreDistance`].
    pub fn locate(&self, pose: &Pose, at: &mut PoseGeometry) -> Result<(), DrivetrainError> {
        // What is no number is not aligned either.
        if !pose.is_aligned(LARGEST_MISALIGNMENT_RAD) {
            return Err(DrivetrainError::Misalignment {
                found_mrad: pose.misalignment_rad() * 1e3,
                allowed_mrad: LARGEST_MISALIGNMENT_RAD * 1e3,
            });
        }
        at.slices.clear();
        at.middle = None;
        for &z in &self.slices_m {
            let line = CentreLine::new(&self.gears, pose, z)?;
            if z == 0.0 {
                at.middle = Some(line);
            }
            at.slices.push(line);
        }
        let middle = match at.middle {
            Some(middle) => middle,
            None => CentreLine::new(&self.gears, pose, 0.0)?,
        };
        at.slices
            .iter_mut()
            .for_each(|line| line.turn_next_to(&middle));
        at.middle = Some(middle);
        at.spin_rad = pose.spin_rad();
        Ok(())
    }

    /// Gap \[m\] of ideal flanks of one side at mid-face if no flanks of that side can touch at a pose that has been located; none if some
    /// might. Spur teeth only: in each plane all their pairs have the same ideal gap.
    pub(crate) fn open_gap_m(&self, at: &PoseGeometry, side: FlankSide) -> Option<f64> {
        let middle = at.middle.as_ref().filter(|_| self.helix.is_none())?;
        let [r1, r2] = [self.gears[0].base_radius_m, self.gears[1].base_radius_m];
        let rolls =
            |plane: &SlicePlane| ToothZero::rolls_rad(&self.gears, at.spin_rad, side, plane);
        let plane = middle.plane(side);
        let [roll_1, roll_2] = rolls(&plane);
        let touching = (plane.length_m - r1 * roll_1) / r2;
        let pitch_2 = self.pitch_rad(1);
        let ahead_2 = ((roll_2 - touching) / pitch_2).round() * pitch_2;
        let gap_m = |plane: &SlicePlane, [roll_1, roll_2]: [f64; 2]| {
            plane.length_m - r1 * roll_1 - r2 * (roll_2 - ahead_2)
        };
        let is_open = |line: &CentreLine| {
            let plane = line.plane(side);
            gap_m(&plane, rolls(&plane)) > self.most_added_m
        };
        at.slices
            .iter()
            .all(is_open)
            .then(|| gap_m(&plane, [roll_1, roll_2]))
    }

    /// Finds all pairs of teeth that face each other with their flanks of one side.
    ///
    /// # Errors
    /// As [`Self::locate`].
    pub fn contacts(
        &self,
        pose: &Pose,
        side: FlankSide,
        found: &mut FlankContacts,
    ) -> Result<(), DrivetrainError> {
        let mut at = PoseGeometry::default();
        self.locate(pose, &mut at)?;
        self.contacts_at(pose, &at, side, found);
        Ok(())
    }

    /// The same at a pose that has been located already.
    pub fn contacts_at(
        &self,
        pose: &Pose,
        at: &PoseGeometry,
        side: FlankSide,
        found: &mut FlankContacts,
    ) {
        found.clear();
        let Some(middle) = &at.middle else {
            return;
        };
        let planes = at.slices.iter().map(|line| line.plane(side));
        found.planes.extend(planes);
        let zero =
            |plane: &SlicePlane| ToothZero::new(&self.gears, (pose, at.spin_rad), side, plane);
        found.zeros.extend(found.planes.iter().map(zero));
        let middle = middle.plane(side);
        let middle = (middle, zero(&middle));
        let [r1, r2] = [self.gears[0].base_radius_m, self.gears[1].base_radius_m];
        let [pitch_1, pitch_2] = [self.pitch_rad(0), self.pitch_rad(1)];
        let ends = self.ends_rad;
        let [mut zero_1, zero_2] = middle.1.roll_rad;
        if let Some(helix) = &self.helix {
            zero_1 -= side.mirror() * helix.twist_rad_per_m[0] * pose.displacement_m[2];
        }
        let length_m = middle.0.length_m;
        let start_1 = (length_m - r2 * ends[1]) / r1;
        let first = ((zero_1 - ends[0] - self.slant_1_rad) / pitch_1).ceil() as i64;
        let last = ((zero_1 - start_1 + self.slant_1_rad) / pitch_1).floor() as i64;
        for count_1 in first..=last {
            let behind_1 = count_1 as f64 * pitch_1;
            // The mate is the tooth whose flank is nearest.
            let touching = (length_m - r1 * (zero_1 - behind_1)) / r2;
            let count_2 = ((zero_2 - touching) / pitch_2).round();
            let behind_2 = count_2 * pitch_2;
            if self.helix.is_none() && zero_2 - behind_2 > ends[1] {
                continue;
            }
            let counts = [count_1, count_2 as i64];
            let sense = side.mirror() as i64;
            let teeth =
                [0, 1].map(|i| (sense * counts[i]).rem_euclid(self.gears[i].teeth as i64) as usize);
            let placed = PlacedTeeth {
                pose,
                side,
                behind_rad: [behind_1, behind_2],
                teeth,
            };
            self.add_line(&placed, &middle, found);
        }
    }

    /// Adds a pair of teeth with its slices, unless all of them are off the path.
    fn add_line(
        &self,
        placed: &PlacedTeeth<'_>,
        middle: &(SlicePlane, ToothZero),
        found: &mut FlankContacts,
    ) {
        let line = found.lines.len();
        let first = found.contacts.len();
        let rates = placed.pose.rates();
        let mut at_middle = None;
        for (slice, (plane, zero)) in found.planes.iter().zip(&found.zeros).enumerate() {
            let ideal = self.ideal_flanks(placed, plane, zero);
            if plane.z_m == middle.0.z_m {
                at_middle = Some(ideal);
            }
            let own = match &self.helix {
                None => None,
                Some(helix) => match self.own_section(helix, placed.side, &ideal) {
                    None => continue,
                    section => section,
                },
            };
            let (roll_rad, roll_gradient) = (own.as_ref())
                .map_or((&ideal.roll_rad, &ideal.roll_gradient), |section| {
                    (&section.roll_rad, &section.roll_gradient)
                });
            let (mut gap_m, mut gradient) = (ideal.gap_m, ideal.gradient);
            for gear in 0..2 {
                let at = (placed.side, roll_rad[gear], plane.z_m);
                let (depth, slope) = self.removed(gear, placed.teeth[gear], at);
                gap_m += depth;
                gradient += slope * roll_gradient[gear];
            }
            if !gap_m.is_finite() {
                continue;
            }
            // A spur line has one section, made below.
            let mut section = line;
            if let Some(own) = own {
                section = found.sections.len();
                let contacts = (found.contacts.len(), 1);
                found.sections.push(Section { contacts, ..own });
            }
            found.contacts.push(ToothContact {
                line,
                slice,
                section,
                gap_m,
                gap_rate_m_per_s: gradient.dot(&rates),
                gradient,
            });
        }
        let contacts = (first, found.contacts.len() - first);
        if self.helix.is_some() && contacts.1 == 0 {
            return;
        }
        let ideal = at_middle.unwrap_or_else(|| self.ideal_flanks(placed, &middle.0, &middle.1));
        let middle = Section {
            contacts,
            ..self.section(&ideal)
        };
        if self.helix.is_none() {
            found.sections.push(middle);
        }
        found.lines.push(TeethLine {
            teeth: placed.teeth,
            middle,
            ideal_gap_m: ideal.gap_m / self.helix.map_or(1.0, |helix| helix.cos),
            contacts,
        });
    }

    /// Ideal flanks in a plane.
    fn ideal_flanks(
        &self,
        placed: &PlacedTeeth<'_>,
        plane: &SlicePlane,
        zero: &ToothZero,
    ) -> IdealFlanks {
        let [r1, r2] = [self.gears[0].base_radius_m, self.gears[1].base_radius_m];
        let mut roll_rad = [0, 1].map(|i| zero.roll_rad[i] - placed.behind_rad[i]);
        let mut roll_gradient = zero.roll_gradient;
        let mut gradient = zero.gradient;
        let mut helix_cos = 1.0;
        if let Some(helix) = &self.helix {
            let sigma = placed.side.mirror();
            helix_cos = helix.cos;
            let [twist_1, twist_2] = helix.twist_rad_per_m;
            roll_rad[1] -= sigma * twist_2 * plane.z_m;
            let height = helix.height(plane, placed.pose, sigma, roll_rad[1]);
            roll_rad[0] -= sigma * twist_1 * height.z_m;
            roll_gradient[0] -= sigma * twist_1 * height.gradient;
            gradient = helix.cos * (gradient + sigma * helix.tan * height.gradient);
        }
        IdealFlanks {
            gap_m: helix_cos * (plane.length_m - r1 * roll_rad[0] - r2 * roll_rad[1]),
            roll_rad,
            roll_gradient,
            gradient,
        }
    }

    /// The section of a whole slice, without its contacts.
    fn section(&self, ideal: &IdealFlanks) -> Section {
        Section {
            roll_rad: ideal.roll_rad,
            touching_roll_rad: self.touching_roll_rad(ideal.roll_rad),
            roll_gradient: ideal.roll_gradient,
            share: 1.0,
            share_gradient: Vector6::zeros(),
            contacts: (0, 0),
        }
    }

    fn touching_roll_rad(&self, roll_rad: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|i| {
            let gear = &self.gears[i];
            roll_rad[i].clamp(gear.form_roll_rad, gear.flank_end_roll_rad)
        })
    }

    /// The section of a helical slice in its middle, on the rigid path in the middle of the part that is on it; none off the path.
    fn own_section(
        &self,
        helix: &BaseHelix,
        side: FlankSide,
        ideal: &IdealFlanks,
    ) -> Option<Section> {
        let mut section = self.section(ideal);
        let touches = match (self.ends, self.slice_width_m) {
            (PathEnds::LineOfAction, Some(width_m)) => {
                let slopes = helix.twist_rad_per_m.map(|twist| -side.mirror() * twist);
                part_on_path(&mut section, (slopes, self.ends_rad), width_m)
            }
            _ => (0..2).all(|i| section.roll_rad[i] <= self.ends_rad[i]),
        };
        section.touching_roll_rad = self.touching_roll_rad(section.roll_rad);
        touches.then_some(section)
    }

    /// Second derivative of the gap in a plane by the increments, microgeometry left out: that is of the order of the load times its
    /// curvature, 1e-6 of the stiffness. `roll_2_rad`: of the contact, or the mean of several ones weighted by their forces; unused on
    /// spur teeth.
    #[must_use]
    pub fn gap_curvature(
        &self,
        plane: &SlicePlane,
        pose: &Pose,
        side: FlankSide,
        roll_2_rad: f64,
    ) -> Matrix6 {
        let base_radius_2_m = self.gears[1].base_radius_m;
        let transverse = plane.transverse_curvature(pose, side, base_radius_2_m);
        let Some(helix) = &self.helix else {
            return transverse;
        };
        let sigma = side.mirror();
        let along_axis = helix.height_curvature(plane, pose, sigma, roll_2_rad);
        helix.cos * transverse + sigma * helix.sin * along_axis
    }

    /// Depth \[m\] and slope \[m/rad\] of everything removed at a flank, the tip edge's gap beyond the flank's end included.
    fn removed(
        &self,
        gear: usize,
        tooth: usize,
        (side, roll, z_m): (FlankSide, f64, f64),
    ) -> (f64, f64) {
        let end = self.gears[gear].flank_end_roll_rad;
        let beyond = roll - end;
        let (mut depth, mut slope) = (0.0, 0.0);
        if beyond > 0.0 {
            let edge = self.edges.gap_m_per_rad2[gear];
            depth += edge * beyond * beyond;
            slope += 2.0 * edge * beyond;
        }
        for error in &self.errors[gear] {
            let removed = error.removed(FlankPoint {
                tooth,
                side,
                roll_rad: roll.min(end),
                z_m,
            });
            depth += removed.depth_m;
            if beyond <= 0.0 {
                slope += removed.slope_m_per_rad;
            }
        }
        (depth, slope)
    }
}
