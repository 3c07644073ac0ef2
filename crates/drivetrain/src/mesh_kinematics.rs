//! Which tooth flanks face each other at a pose of two spur gears, and how far apart they are.
//!
//! Everything is seen in gear 1's frame, slice plane by slice plane. With b gear 2's axis, σ = ±1 for right and left flanks, and
//! at the plane z
//!
//! ```text
//! d = u + z b,   a = |d_xy|,   β = polar angle of d,   cos α = R/a,   R = r_b1 + r_b2,   L = a sin α
//! ξ₁ = α + ψ_b1 − σ(−β + k₁τ₁),      ξ₂ = α + ψ_b2 − σ(γ − β − π + k₂τ₂)        roll angles on the line of action
//! g  = L − r_b1 ξ₁ − r_b2 ξ₂ + e₁(ξ₁, z) + e₂(ξ₂, z)                               gap, e: material removed
//! ```
//!
//! for tooth k₁ against tooth k₂. The gradient is in closed form: with w the unit vector of the line of action (the force on gear 2),
//! w⊥ = e_z × w and t = ∂γ/∂ϑ,
//!
//! ```text
//! ∂ξ₁/∂(u, ϑ) = (σ w⊥/L, z b × σ w⊥/L),     ∂ξ₂ = ∂ξ₁ − (0, σ t)
//! ∂g/∂(u, ϑ)  = (w, z b × w + σ r_b2 t) + e₁′ ∂ξ₁ + e₂′ ∂ξ₂
//! ```
//!
//! Which teeth face each other follows from the angles alone: there is no memory, and a slipped pair is found again. Derivation, and
//! the second derivative: docs/theory/gear_meshes.md.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use gearmesh_contact::tip_contact::LARGEST_GAP_OVER_BASE_PITCH;
use gearmesh_geometry::{FlankSide, ToothGeometry};
use nalgebra::{Matrix3, SMatrix, Vector3};

use crate::error::DrivetrainError;
use crate::flank_error::{FlankError, FlankPoint};
use crate::flank_modes::ModalRows;
use crate::pose::{Pose, Vector6};

/// 6×6 matrix on the increments of a pose.
pub type Matrix6 = SMatrix<f64, 6, 6>;

/// Largest angle between the axes \[rad\] for which slices in parallel planes are taken as the truth: neglected terms are of the order
/// of its square, 1e-4 of the lengths. The static scene has the same limit.
pub const LARGEST_MISALIGNMENT_RAD: f64 = 10e-3;

/// What happens where the rigid path of contact ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PathEnds {
    /// Pairs touch on the rigid path only: a loaded pair ends abruptly, its force jumps to zero and its elastic energy is lost.
    LineOfAction,
    /// Beyond the end the tip edge goes on touching with a gap that grows as ½ δ² ρ_tip L/ρ_mate, δ the roll angle beyond: the exact
    /// gap of an edge to second order. Force and energy are then continuous.
    #[default]
    Extended,
}

/// Two tooth flanks that face each other; roll angles at mid-face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TeethLine {
    /// Teeth of gear 1 and gear 2.
    pub teeth: [usize; 2],
    /// Roll angles where the flanks cross the line of action \[rad\]; continued beyond the ends of the path.
    pub roll_rad: [f64; 2],
    /// The same, at most at the end of the flank.
    pub touching_roll_rad: [f64; 2],
    /// Derivatives of the roll angles by the increments of the pose.
    pub roll_gradient: [Vector6; 2],
    /// Gap that ideal flanks would have at mid-face \[m\].
    pub ideal_gap_m: f64,
    /// First of its contacts, and how many there are.
    pub contacts: (usize, usize),
}

/// One slice of such a pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToothContact {
    /// Number of its line.
    pub line: usize,
    /// Number of the slice plane.
    pub slice: usize,
    /// Gap \[m\] along the line of action, open positive.
    pub gap_m: f64,
    /// Rate of the gap \[m/s\].
    pub gap_rate_m_per_s: f64,
    /// Derivative of the gap by the increments of the pose.
    pub gradient: Vector6,
}

/// A slice plane at a pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlicePlane {
    /// Axial position \[m\].
    pub z_m: f64,
    /// w: unit vector of the line of action, direction of the force on gear 2, gear 1 axes.
    pub normal: Vector3<f64>,
    /// w⊥ = e_z × w.
    pub across: Vector3<f64>,
    /// L: length of the line of action between the base circles \[m\].
    pub length_m: f64,
    /// Working pressure angle α \[rad\].
    pub pressure_angle_rad: f64,
    /// β: polar angle of gear 2's axis from gear 1's \[rad\].
    pub polar_rad: f64,
}

/// What both sides of the teeth share in a slice plane.
#[derive(Debug, Clone, Copy, PartialEq)]
struct CentreLine {
    z_m: f64,
    /// e_r(β)
    radial: Vector3<f64>,
    /// sin α and cos α.
    pressure_angle: (f64, f64),
    pressure_angle_rad: f64,
    length_m: f64,
    polar_rad: f64,
}

/// Slice planes at a pose, what both sides of the teeth share. Reused from call to call.
#[derive(Debug, Clone, Default)]
pub struct PoseGeometry {
    slices: Vec<CentreLine>,
    middle: Option<CentreLine>,
    spin_rad: f64,
}

/// Tooth flanks facing each other on one side of the teeth, at one pose. Reused from call to call.
#[derive(Debug, Clone, Default)]
pub struct FlankContacts {
    /// Slice planes.
    pub planes: Vec<SlicePlane>,
    /// Pairs of teeth.
    pub lines: Vec<TeethLine>,
    /// Their slices, line by line.
    pub contacts: Vec<ToothContact>,
    /// Shapes of gear 1's and gear 2's vibration modes at them; empty without.
    pub modal: [ModalRows; 2],
}

impl FlankContacts {
    /// Memory for so many slice planes and contacts.
    #[must_use]
    pub fn with_capacity(planes: usize, contacts: usize) -> Self {
        Self {
            planes: Vec::with_capacity(planes),
            lines: Vec::with_capacity(contacts),
            contacts: Vec::with_capacity(contacts),
            modal: [ModalRows::default(), ModalRows::default()],
        }
    }
}

/// Deviations of one gear's flanks.
pub type FlankErrors = Vec<Arc<dyn FlankError>>;

/// Two spur gears with their deviations.
#[derive(Clone)]
pub struct MeshKinematics {
    gears: [ToothGeometry; 2],
    errors: [FlankErrors; 2],
    slices_m: Vec<f64>,
    ends: PathEnds,
    /// Where the flank ends, and how far beyond its end a tip edge is followed \[rad\].
    reach_rad: [f64; 2],
    /// Gap of a tip edge over δ² \[m/rad²\].
    edge_m_per_rad2: [f64; 2],
}

impl MeshKinematics {
    /// Two gears that run at about `centre_distance_m`, with slice planes at `slices_m` \[m\].
    ///
    /// # Errors
    /// [`DrivetrainError::Helical`], [`DrivetrainError::CentreDistance`], or [`DrivetrainError::Length`] without slices.
    pub fn new(
        gears: [ToothGeometry; 2],
        errors: [FlankErrors; 2],
        centre_distance_m: f64,
        slices_m: Vec<f64>,
        ends: PathEnds,
    ) -> Result<Self, DrivetrainError> {
        for gear in &gears {
            if gear.helix_angle_rad != 0.0 {
                return Err(DrivetrainError::Helical {
                    base_helix_deg: gear.base_helix_angle_rad().to_degrees(),
                });
            }
        }
        if slices_m.is_empty() {
            return Err(DrivetrainError::Length {
                owner: "gear mesh",
                what: "the list of slice planes",
                found: 0,
                expected: 1,
            });
        }
        let (length, _) = line_of_action(&gears, centre_distance_m)?;
        let mut edge_m_per_rad2 = [0.0; 2];
        let mut reach_rad = [0.0; 2];
        if ends == PathEnds::Extended {
            for (i, gear) in gears.iter().enumerate() {
                let tip = gear.base_radius_m * gear.flank_end_roll_rad;
                let mate = length - tip;
                let pitch = TAU / gear.teeth as f64;
                edge_m_per_rad2[i] = 0.5 * tip * length / mate;
                let largest = LARGEST_GAP_OVER_BASE_PITCH * pitch * gear.base_radius_m;
                reach_rad[i] = (largest / edge_m_per_rad2[i]).sqrt().min(0.5 * pitch);
            }
        }
        Ok(Self {
            gears,
            errors,
            slices_m,
            ends,
            reach_rad,
            edge_m_per_rad2,
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
        let span = self.gears[0].flank_end_roll_rad + self.reach_rad[0];
        (span / self.pitch_rad(0)).ceil() as usize * self.slices_m.len() + self.slices_m.len()
    }

    /// Roll angle of tooth 0 on gear 0 or 1 in a plane, and σ.
    fn roll_of_tooth_0(
        &self,
        gear: usize,
        side: FlankSide,
        plane: &SlicePlane,
        spin_rad: f64,
    ) -> f64 {
        let seen_from_mate = match gear {
            0 => -plane.polar_rad,
            _ => spin_rad - plane.polar_rad - PI,
        };
        plane.pressure_angle_rad + self.gears[gear].base_half_angle_rad
            - side.mirror() * seen_from_mate
    }

    /// The centre line in the plane z.
    fn centre_line(&self, pose: &Pose, z_m: f64) -> Result<CentreLine, DrivetrainError> {
        let d = pose.displacement_m + z_m * pose.axis_2();
        let distance = d[0].hypot(d[1]);
        let (length_m, pressure_angle_rad) = line_of_action(&self.gears, distance)?;
        let sum = self.gears[0].base_radius_m + self.gears[1].base_radius_m;
        Ok(CentreLine {
            z_m,
            radial: Vector3::new(d[0] / distance, d[1] / distance, 0.0),
            pressure_angle: (length_m / distance, sum / distance),
            pressure_angle_rad,
            length_m,
            polar_rad: d[1].atan2(d[0]),
        })
    }

    /// Finds what both sides of the teeth share.
    ///
    /// # Errors
    /// [`DrivetrainError::Misalignment`], [`DrivetrainError::CentreDistance`].
    pub fn locate(&self, pose: &Pose, at: &mut PoseGeometry) -> Result<(), DrivetrainError> {
        let tilt = pose.misalignment_rad();
        // NaN is refused, too.
        if tilt.is_nan() || tilt > LARGEST_MISALIGNMENT_RAD {
            return Err(DrivetrainError::Misalignment {
                found_mrad: tilt * 1e3,
                allowed_mrad: LARGEST_MISALIGNMENT_RAD * 1e3,
            });
        }
        at.slices.clear();
        at.middle = None;
        for &z in &self.slices_m {
            let line = self.centre_line(pose, z)?;
            if z == 0.0 {
                at.middle = Some(line);
            }
            at.slices.push(line);
        }
        if at.middle.is_none() {
            at.middle = Some(self.centre_line(pose, 0.0)?);
        }
        at.spin_rad = pose.spin_rad();
        Ok(())
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
        found.planes.clear();
        found.lines.clear();
        found.contacts.clear();
        let Some(middle) = &at.middle else {
            return;
        };
        let planes = at.slices.iter().map(|line| line.plane(side));
        found.planes.extend(planes);
        let (middle, spin) = (middle.plane(side), at.spin_rad);
        let [r1, r2] = [self.gears[0].base_radius_m, self.gears[1].base_radius_m];
        let [pitch_1, pitch_2] = [self.pitch_rad(0), self.pitch_rad(1)];
        let ends = [0, 1].map(|i| self.gears[i].flank_end_roll_rad + self.reach_rad[i]);
        let zero_1 = self.roll_of_tooth_0(0, side, &middle, spin);
        let zero_2 = self.roll_of_tooth_0(1, side, &middle, spin);
        let start_1 = (middle.length_m - r2 * ends[1]) / r1;
        let first = ((zero_1 - ends[0]) / pitch_1).ceil() as i64;
        let last = ((zero_1 - start_1) / pitch_1).floor() as i64;
        for count_1 in first..=last {
            let roll_1 = zero_1 - count_1 as f64 * pitch_1;
            // The mate is the tooth whose flank is nearest.
            let touching = (middle.length_m - r1 * roll_1) / r2;
            let count_2 = ((zero_2 - touching) / pitch_2).round();
            let roll_2 = zero_2 - count_2 * pitch_2;
            if roll_2 <= ends[1] {
                let counts = [count_1 as f64, count_2];
                self.add_line(pose, side, (&middle, spin, counts), found);
            }
        }
    }

    /// Adds the pair of teeth that stand `counts` pitches from tooth 0 against the sense of growing roll.
    fn add_line(
        &self,
        pose: &Pose,
        side: FlankSide,
        (middle, spin, counts): (&SlicePlane, f64, [f64; 2]),
        found: &mut FlankContacts,
    ) {
        let sigma = side.mirror();
        let axis = pose.axis_2();
        let turn = pose.spin_gradient();
        let teeth =
            [0, 1].map(|i| (sigma * counts[i]).rem_euclid(self.gears[i].teeth as f64) as usize);
        let rolls = |plane: &SlicePlane| {
            [0, 1]
                .map(|i| self.roll_of_tooth_0(i, side, plane, spin) - counts[i] * self.pitch_rad(i))
        };
        let roll_gradients = |plane: &SlicePlane| {
            let along = sigma / plane.length_m * plane.across;
            let of_1 = stacked(along, plane.z_m * axis.cross(&along));
            [of_1, of_1 - stacked(Vector3::zeros(), sigma * turn)]
        };
        let line = found.lines.len();
        let first = found.contacts.len();
        let rates = pose.rates();
        let [r1, r2] = [self.gears[0].base_radius_m, self.gears[1].base_radius_m];
        for (slice, plane) in found.planes.iter().enumerate() {
            let roll = rolls(plane);
            let by_pose = roll_gradients(plane);
            let mut gap_m = plane.length_m - r1 * roll[0] - r2 * roll[1];
            let moment = plane.z_m * axis.cross(&plane.normal) + sigma * r2 * turn;
            let mut gradient = stacked(plane.normal, moment);
            for gear in 0..2 {
                let (depth, slope) = self.removed(gear, teeth[gear], (side, roll[gear], plane.z_m));
                gap_m += depth;
                gradient += slope * by_pose[gear];
            }
            if gap_m.is_finite() {
                found.contacts.push(ToothContact {
                    line,
                    slice,
                    gap_m,
                    gap_rate_m_per_s: gradient.dot(&rates),
                    gradient,
                });
            }
        }
        let roll_rad = rolls(middle);
        found.lines.push(TeethLine {
            teeth,
            roll_rad,
            touching_roll_rad: [0, 1].map(|i| {
                let gear = &self.gears[i];
                roll_rad[i].clamp(gear.form_roll_rad, gear.flank_end_roll_rad)
            }),
            ideal_gap_m: middle.length_m - r1 * roll_rad[0] - r2 * roll_rad[1],
            roll_gradient: roll_gradients(middle),
            contacts: (first, found.contacts.len() - first),
        });
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
            let edge = self.edge_m_per_rad2[gear];
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

/// Length L \[m\] of the line of action between the base circles, and working pressure angle \[rad\].
fn line_of_action(
    gears: &[ToothGeometry; 2],
    distance_m: f64,
) -> Result<(f64, f64), DrivetrainError> {
    let sum = gears[0].base_radius_m + gears[1].base_radius_m;
    if distance_m.is_nan() || distance_m <= sum {
        return Err(DrivetrainError::CentreDistance {
            found_mm: distance_m * 1e3,
            smallest_mm: sum * 1e3,
        });
    }
    let length = ((distance_m - sum) * (distance_m + sum)).sqrt();
    Ok((length, length.atan2(sum)))
}

fn stacked(upper: Vector3<f64>, lower: Vector3<f64>) -> Vector6 {
    Vector6::new(upper[0], upper[1], upper[2], lower[0], lower[1], lower[2])
}

impl CentreLine {
    /// The slice plane for flanks of one side.
    fn plane(&self, side: FlankSide) -> SlicePlane {
        let (sin, cos) = self.pressure_angle;
        let tangential = Vector3::new(-self.radial[1], self.radial[0], 0.0);
        let normal = sin * self.radial - side.mirror() * cos * tangential;
        SlicePlane {
            z_m: self.z_m,
            normal,
            across: Vector3::new(-normal[1], normal[0], 0.0),
            length_m: self.length_m,
            pressure_angle_rad: self.pressure_angle_rad,
            polar_rad: self.polar_rad,
        }
    }
}

impl SlicePlane {
    /// Second derivative of the gap by the increments, microgeometry left out: that is of the order of the load times its curvature,
    /// 1e-6 of the stiffness.
    #[must_use]
    pub fn gap_curvature(&self, pose: &Pose, side: FlankSide, base_radius_2_m: f64) -> Matrix6 {
        let axis = pose.axis_2().cross_matrix();
        let carried: Matrix3<f64> = -self.z_m * axis;
        let normal_by_d = self.across * self.across.transpose() / self.length_m;
        let moment_by_turn = -carried * normal_by_d * carried
            + self.z_m * self.normal.cross_matrix() * axis
            + side.mirror() * base_radius_2_m * pose.spin_curvature();
        let mut h = Matrix6::zeros();
        h.fixed_view_mut::<3, 3>(0, 0).copy_from(&normal_by_d);
        h.fixed_view_mut::<3, 3>(0, 3)
            .copy_from(&(normal_by_d * carried));
        h.fixed_view_mut::<3, 3>(3, 0)
            .copy_from(&(-carried * normal_by_d));
        h.fixed_view_mut::<3, 3>(3, 3).copy_from(&moment_by_turn);
        h
    }
}
