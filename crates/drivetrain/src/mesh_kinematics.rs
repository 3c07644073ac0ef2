//! Which tooth flanks face each other at a pose of two gears, and how far apart they are.
//!
//! Seen in planes across the axis halfway between the gears' axes (mesh_frame.rs), slice by slice. With d the way from
//! gear 1's axis to gear 2's in such a plane, z₁ and z₂ where it cuts them, and σ = ±1 for right and left flanks
//!
//! ```text
//! a = |d|,   β = polar angle of d,   cos α = R/a,   R = r_b1 + r_b2,   L = a sin α
//! ξ₁ = α + ψ_b1 − σ(−β + k₁τ₁ + κ₁z₁),  ξ₂ = α + ψ_b2 − σ(γ − β − π + k₂τ₂ + κ₂z₂)   roll angles on the line of action
//! g  = cos β_b (L − r_b1 ξ₁ − r_b2 ξ₂) + e₁(ξ₁, z₁) + e₂(ξ₂, z₂)                      gap, e: material removed
//! ```
//!
//! for tooth k₁ against tooth k₂, in lengths with the signs of [`BaseCircles`]: with a ring σ is its hand, β turns by
//! half a turn, ψ_b of the ring is negative, and so half a turn changes sides (tooth_zero.rs). κ turns helical
//! sections, on tilted axes as base_helix.rs has it, and is zero on spur teeth. The gradient is in closed form: with w
//! the unit vector of the line of action (the transverse force on gear 2), w⊥ across it, t = ∂γ/∂ϑ and m the turn of
//! the frame,
//!
//! ```text
//! ∂ξ₁/∂(u, ϑ) = σ w⊥·∂d/L − σ ∂m,     ∂ξ₂ = ∂ξ₁ − (0, σ t),     ∂g/∂(u, ϑ)  = w·∂d + (0, σ r_b2 t) + σ R ∂m + e₁′ ∂ξ₁ + e₂′ ∂ξ₂ + …
//! ```
//!
//! Which teeth face each other follows from the angles alone: there is no memory, and a slipped pair is found again.
//! Exchanging the gears changes nothing. Derivation, and the second derivative: docs/theory/gear_meshes.md.

use std::f64::consts::TAU;

use gearmesh_contact::slice_part::LEAST_SHARE;
use gearmesh_contact::{FlankDeviations, SliceLayout};
use gearmesh_geometry::{BaseCircles, Flank, ToothGeometry};

use crate::base_helix::{BaseHelix, IdealFlanks};
use crate::error::DrivetrainError;
use crate::flank_contacts::{
    AlongTeeth, FlankContacts, FlankErrors, Section, TeethLine, ToothContact,
};
use crate::flank_error::FlankPoint;
use crate::mesh_frame::MeshFrame;
use crate::path_ends::{PathEnds, TipEdges, part_on_path};
use crate::pose::{Pose, Vector6};
use crate::pose_geometry::PoseGeometry;
use crate::slice_plane::{SidePlanes, SlicePlane, ToothZero, line_of_action};

/// Largest angle between the axes \[rad\] for which slices in parallel planes are taken as the truth: neglected terms
/// are of the order of its square, 1e-4 of the lengths. The static scene has the same limit.
pub const LARGEST_MISALIGNMENT_RAD: f64 = 10e-3;

/// Two gears with their deviations.
#[derive(Clone)]
pub struct MeshKinematics {
    pub(crate) gears: [ToothGeometry; 2],
    pub(crate) circles: BaseCircles,
    deviations: FlankDeviations,
    layout: SliceLayout,
    ends: PathEnds,
    edges: TipEdges,
    /// Roll angles up to which flanks touch, tip edges included.
    ends_rad: [f64; 2],
    pub(crate) helix: Option<BaseHelix>,
    /// How far the roll angle on gear 1 changes from mid-face to the faces, tilted axes included \[rad\]; zero on spur
    /// teeth.
    slant_1_rad: f64,
    /// r_b1 ξ₁ − r_b2 ξ₂ \[m\] in the pitch point.
    pitch_place_m: f64,
    /// The same where a spring that stands for the whole mesh has its gap; none where each pair has its own.
    common_place_m: Option<f64>,
    /// Bound of what deviations add to both flanks together \[m\].
    pub(crate) most_added_m: f64,
}

/// A pair of teeth in the slice planes of a pose: what its sections share.
struct PlacedTeeth<'a> {
    frame: &'a MeshFrame,
    rates: &'a Vector6,
    side: Flank,
    /// σ.
    sigma: f64,
    /// Roll angles that it is behind tooth 0 \[rad\].
    behind_rad: [f64; 2],
    teeth: [usize; 2],
}

impl MeshKinematics {
    /// Two gears that run at about `centre_distance_m`, with slices over the overlap of their faces.
    ///
    /// # Errors
    /// [`DrivetrainError::Helix`] if the helices do not fit, [`DrivetrainError::CentreDistance`],
    /// [`DrivetrainError::Length`] without slices, [`DrivetrainError::Contact`] if the faces do not overlap where the
    /// slices are laid.
    pub fn new(
        gears: [ToothGeometry; 2],
        errors: [FlankErrors; 2],
        centre_distance_m: f64,
        layout: SliceLayout,
        ends: PathEnds,
    ) -> Result<Self, DrivetrainError> {
        let circles = BaseCircles::new(gears.each_ref());
        let [helix_1, helix_2] = [0, 1].map(|i: usize| gears[i].base_helix_angle_rad());
        let [signed_1, signed_2] = [circles.sense(0) * helix_1, circles.sense(1) * helix_2];
        if (signed_1 + signed_2).abs() > 1e-6 * helix_1.abs() {
            return Err(DrivetrainError::Helix {
                helix_1_deg: helix_1.to_degrees(),
                helix_2_deg: helix_2.to_degrees(),
            });
        }
        if layout.slices == 0 {
            return Err(DrivetrainError::Length {
                owner: "gear mesh",
                what: "the list of slices",
                found: 0,
                expected: 1,
            });
        }
        layout.check()?;
        let helix = BaseHelix::new(&gears);
        let slant_1_rad = helix.map_or(0.0, |h| {
            let along_face = 0.5 * layout.face_widths_m[0] * h.twist_rad_per_m[0].abs();
            along_face + LARGEST_MISALIGNMENT_RAD * h.tan.abs()
        });
        let (length, _) = line_of_action(&circles, centre_distance_m)?;
        let edges = match ends {
            PathEnds::LineOfAction => TipEdges::default(),
            PathEnds::Extended => {
                TipEdges::new(&gears, (&circles, length), helix.map_or(1.0, |h| h.cos))
            }
        };
        let ends_rad = [0, 1]
            .map(|i: usize| gears[i].flank_end_roll_rad + circles.sense(i) * edges.reach_rad[i]);
        let deviations = FlankDeviations::new(errors);
        Ok(Self {
            gears,
            circles,
            most_added_m: deviations.most_added_m(),
            deviations,
            layout,
            ends,
            ends_rad,
            edges,
            helix,
            slant_1_rad,
            pitch_place_m: circles.pitch_place() * length,
            common_place_m: None,
        })
    }

    /// The gears.
    #[must_use]
    pub fn gears(&self) -> &[ToothGeometry; 2] {
        &self.gears
    }

    /// Where the slices lie.
    #[must_use]
    pub fn layout(&self) -> &SliceLayout {
        &self.layout
    }

    /// Gives all pairs of teeth in a slice one gap, that of ideal flanks in the pitch point: for a spring that stands
    /// for the whole mesh.
    pub(crate) fn share_one_gap(&mut self) {
        self.common_place_m = Some(self.pitch_place_m);
    }

    /// How the path ends.
    #[must_use]
    pub fn ends(&self) -> PathEnds {
        self.ends
    }

    /// Whether the flanks of any gear deviate from the ideal.
    #[must_use]
    pub fn has_errors(&self) -> bool {
        !self.deviations.is_empty()
    }

    /// Angle between two teeth \[rad\].
    #[must_use]
    pub fn pitch_rad(&self, gear: usize) -> f64 {
        TAU / self.gears[gear].teeth as f64
    }

    /// Largest number of slices that can face each other at once, for sizing.
    #[must_use]
    pub fn capacity(&self) -> usize {
        // From the base circle to the tip, of a ring from the root.
        let farthest = self.ends_rad[0].max(self.gears[0].form_roll_rad);
        let span = farthest + 2.0 * self.slant_1_rad;
        (span / self.pitch_rad(0)).ceil() as usize * self.layout.slices + self.layout.slices
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
        at.locate(self.circles, &self.layout, pose)
    }

    /// Finds all pairs of teeth that face each other with their flanks of one side; returns what both sides share at
    /// the pose, and the slice planes of this one.
    ///
    /// # Errors
    /// As [`Self::locate`].
    pub fn contacts(
        &self,
        pose: &Pose,
        side: Flank,
        found: &mut FlankContacts,
    ) -> Result<(PoseGeometry, SidePlanes), DrivetrainError> {
        let (mut at, mut planes) = Default::default();
        self.locate(pose, &mut at)?;
        self.contacts_at((pose, &at), side, &mut planes, found);
        Ok((at, planes))
    }

    /// The same at a pose that has been located already.
    pub fn contacts_at(
        &self,
        (pose, at): (&Pose, &PoseGeometry),
        side: Flank,
        placed_in: &mut SidePlanes,
        found: &mut FlankContacts,
    ) {
        found.clear();
        let SidePlanes { planes, zeros } = placed_in;
        planes.clear();
        zeros.clear();
        let (Some(middle), Some(frame)) = (&at.middle, &at.frame) else {
            return;
        };
        let reference = &self.layout.reference;
        found.along_teeth = AlongTeeth {
            moved_m: frame.zone.displacement_m - reference.displacement_m,
            share: frame.zone.width_m / reference.width_m,
        };
        let (circles, sigma) = (&self.circles, self.circles.hand(side));
        found.action_m_per_u = circles.radii_m;
        planes.extend(at.slices.iter().map(|line| line.plane(frame, sigma)));
        let zero = |plane: &SlicePlane| ToothZero::new(&self.gears, frame, sigma, plane);
        zeros.extend(planes.iter().map(zero));
        let rates = pose.rates();
        // The middle of an odd number of slices has been placed already.
        let between;
        let middle = match at.middle_slice() {
            Some(slice) => (&planes[slice], &zeros[slice]),
            None => {
                let plane = middle.plane(frame, sigma);
                between = (plane, zero(&plane));
                (&between.0, &between.1)
            }
        };
        let [pitch_1, pitch_2] = [self.pitch_rad(0), self.pitch_rad(1)];
        let ends = self.ends_rad;
        let [zero_1, zero_2] = (self.helix.as_ref()).map_or(middle.1.roll_rad, |helix| {
            helix.mid_face_rolls_rad(middle.0, middle.1, sigma)
        });
        let length_m = middle.0.length_m;
        let start_1 = circles.mate_roll_rad(length_m, (1, ends[1]));
        // Along the path, against which the roll angle of a ring runs.
        let towards_tip = circles.sense(0);
        let beyond_rad = |end: f64| towards_tip * (zero_1 - end);
        let first = ((beyond_rad(ends[0]) - self.slant_1_rad) / pitch_1).ceil() as i64;
        let last = ((beyond_rad(start_1) + self.slant_1_rad) / pitch_1).floor() as i64;
        // Flanks that stand open touch later: one more pair is looked at.
        for count_1 in (first..=last + 1).map(|count| towards_tip as i64 * count) {
            let behind_1 = count_1 as f64 * pitch_1;
            // The mate is the tooth whose flank is nearest.
            let touching = circles.mate_roll_rad(length_m, (0, zero_1 - behind_1));
            let count_2 = ((zero_2 - touching) / pitch_2).round();
            let behind_2 = count_2 * pitch_2;
            let rolls = [zero_1 - behind_1, zero_2 - behind_2];
            if self.helix.is_none() && !self.are_on_flanks(&rolls) {
                continue;
            }
            let counts = [count_1, count_2 as i64];
            let sense = sigma as i64;
            let teeth =
                [0, 1].map(|i| (sense * counts[i]).rem_euclid(self.gears[i].teeth as i64) as usize);
            let placed = PlacedTeeth {
                frame,
                rates: &rates,
                side,
                sigma,
                behind_rad: [behind_1, behind_2],
                teeth,
            };
            self.add_line(&placed, middle, (planes, zeros), found);
        }
    }

    /// Adds a pair of teeth with its slices, unless all of them are off the path.
    fn add_line(
        &self,
        placed: &PlacedTeeth<'_>,
        middle: (&SlicePlane, &ToothZero),
        (planes, zeros): (&[SlicePlane], &[ToothZero]),
        found: &mut FlankContacts,
    ) {
        let line = found.lines.len();
        let first = found.contacts.len();
        let first_section = found.sections.len();
        let mut at_middle = None;
        for (slice, (plane, zero)) in planes.iter().zip(zeros).enumerate() {
            let ideal = self.ideal_flanks(placed, plane, zero);
            if plane.section_m == middle.0.section_m {
                at_middle = Some(ideal);
            }
            let own = match &self.helix {
                None => None,
                Some(helix) => match self.own_section(helix, placed, &ideal) {
                    None => continue,
                    section => section,
                },
            };
            let (roll_rad, roll_gradient) = (own.as_ref())
                .map_or((&ideal.roll_rad, &ideal.roll_gradient), |section| {
                    (&section.roll_rad, &section.roll_gradient)
                });
            let (mut gap_m, mut gradient) = (ideal.gap_m, ideal.gradient);
            // What the whole mesh shares is the gap of ideal flanks.
            if self.common_place_m.is_none() {
                let rolls = (roll_rad, roll_gradient);
                self.add_removed(placed, plane, rolls, (&mut gap_m, &mut gradient));
            }
            if !gap_m.is_finite() {
                continue;
            }
            // A spur line has one section, made below.
            let mut section = first_section;
            if let Some(own) = own {
                section = found.sections.len();
                let contacts = (found.contacts.len(), 1);
                found.sections.push(Section { contacts, ..own });
            }
            found.contacts.push(ToothContact {
                line,
                slice,
                section,
                heights_m: plane.heights_m,
                gap_m,
                gap_rate_m_per_s: gradient.dot(placed.rates),
                gradient,
            });
        }
        let contacts = (first, found.contacts.len() - first);
        if self.helix.is_some() && contacts.1 == 0 {
            return;
        }
        let ideal = at_middle.unwrap_or_else(|| self.ideal_flanks(placed, middle.0, middle.1));
        if self.helix.is_none() {
            let mut section = self.section(placed.frame, &ideal);
            section.contacts = contacts;
            self.touch(&mut section);
            found.sections.push(section);
        }
        found.lines.push(TeethLine {
            teeth: placed.teeth,
            section: first_section,
            ideal_gap_m: ideal.gap_m / self.helix.map_or(1.0, |helix| helix.cos),
            contacts,
        });
    }

    /// Adds what is removed of both flanks in a plane to their gap and its gradient.
    fn add_removed(
        &self,
        placed: &PlacedTeeth<'_>,
        plane: &SlicePlane,
        (roll_rad, roll_gradient): (&[f64; 2], &[Vector6; 2]),
        (gap_m, gradient): (&mut f64, &mut Vector6),
    ) {
        for (gear, sense) in [(0, 0.5), (1, -0.5)] {
            let point = FlankPoint {
                tooth: placed.teeth[gear],
                side: self.circles.side_of(gear, placed.side),
                roll_rad: roll_rad[gear],
                z_m: plane.heights_m[gear],
            };
            let (depth, [by_roll, by_height]) = self.removed(gear, point);
            *gap_m += depth;
            *gradient += by_roll * roll_gradient[gear];
            if by_height != 0.0 {
                let shift = sense * placed.frame.displacement_gradient;
                *gradient += by_height * (plane.section_gradient + shift);
            }
        }
    }

    /// Ideal flanks in a plane.
    fn ideal_flanks(
        &self,
        placed: &PlacedTeeth<'_>,
        plane: &SlicePlane,
        zero: &ToothZero,
    ) -> IdealFlanks {
        let roll_rad = [0, 1].map(|i| zero.roll_rad[i] - placed.behind_rad[i]);
        if let Some(helix) = &self.helix {
            let plain = (roll_rad, placed.sigma);
            return helix.flanks((placed.frame, plane), zero, plain, self.common_place_m);
        }
        IdealFlanks {
            gap_m: self.circles.gap_m(plane.length_m, roll_rad),
            roll_rad,
            roll_gradient: zero.roll_gradient,
            gradient: zero.gradient,
        }
    }

    /// The section of a whole slice, without its contacts and what [`Self::touch`] makes.
    fn section(&self, frame: &MeshFrame, ideal: &IdealFlanks) -> Section {
        let width_m = self.layout.reference.width_m;
        let rate = frame.zone.width_by_displacement / width_m;
        Section {
            roll_rad: ideal.roll_rad,
            touching_roll_rad: ideal.roll_rad,
            roll_gradient: ideal.roll_gradient,
            share: frame.zone.width_m / width_m,
            share_gradient: rate * frame.displacement_gradient,
            stiffness: 1.0,
            ..Section::default()
        }
    }

    /// Makes of a section what follows from its roll angles and its share: where it touches, how long, how curved.
    fn touch(&self, section: &mut Section) {
        let rolls = [0, 1].map(|i: usize| {
            let (form, end) = (
                self.gears[i].form_roll_rad,
                self.gears[i].flank_end_roll_rad,
            );
            section.roll_rad[i].clamp(form.min(end), form.max(end))
        });
        let helix_cos = self.helix.map_or(1.0, |helix| helix.cos);
        section.touching_roll_rad = rolls;
        section.length_m = section.share * self.layout.width_m() / helix_cos;
        (section.radius_m, section.radius_growth) = self.circles.relative_radius(rolls, helix_cos);
    }

    /// The section of a helical slice in its middle, on the rigid path in the middle of the part that is on it; none
    /// off the path.
    fn own_section(
        &self,
        helix: &BaseHelix,
        placed: &PlacedTeeth<'_>,
        ideal: &IdealFlanks,
    ) -> Option<Section> {
        let mut section = self.section(placed.frame, ideal);
        let touches = match self.ends {
            _ if self.common_place_m.is_some() => true,
            PathEnds::LineOfAction => {
                let flanks = [0, 1].map(|gear: usize| {
                    let slope = -placed.sigma * helix.twist_rad_per_m[gear];
                    (slope, self.ends_rad[gear], self.circles.sense(gear))
                });
                part_on_path(&mut section, flanks, self.layout.width_m())
            }
            PathEnds::Extended => self.are_on_flanks(&section.roll_rad),
        };
        self.touch(&mut section);
        (touches && section.share > LEAST_SHARE).then_some(section)
    }

    /// Depth \[m\] and slopes along the profile \[m/rad\] and the axis of everything removed at a flank, the tip edge's
    /// gap beyond the flank's end included.
    fn removed(&self, gear: usize, at: FlankPoint) -> (f64, [f64; 2]) {
        let end = self.gears[gear].flank_end_roll_rad;
        let past_end = at.roll_rad - end;
        if self.circles.sense(gear) * past_end <= 0.0 {
            let removed = self.deviations.removed(gear, at);
            let slopes = [removed.slope_m_per_rad, removed.slope_along_axis];
            return (removed.depth_m, slopes);
        }
        let at_end = FlankPoint {
            roll_rad: end,
            ..at
        };
        let removed = self.deviations.removed(gear, at_end);
        let edge = self.edges.gap_m_per_rad2[gear];
        let depth = edge * past_end * past_end + removed.depth_m;
        (depth, [2.0 * edge * past_end, removed.slope_along_axis])
    }

    /// Whether both roll angles lie before the ends of the flanks, tip edges included.
    fn are_on_flanks(&self, roll_rad: &[f64; 2]) -> bool {
        let past_end = |i: usize| self.circles.sense(i) * (roll_rad[i] - self.ends_rad[i]);
        (0..2).all(|i| past_end(i) <= 0.0)
    }
}
