//! A plane across the axis halfway between the gears' axes: where it cuts them, and the line of action in it.
//!
//! With the frame of mesh_frame.rs, d the way from gear 1's axis to gear 2's in the plane, and v any vector in it,
//!
//! ```text
//! d = u − ½ D′ h + 2 (s + F/2) f,      v·∂d = (v, z₂ b × v) + 2 (f·v) ∂(s + F/2)
//! ```

use gearmesh_geometry::BaseCircles;
use nalgebra::{SMatrix, Vector3};

use crate::error::DrivetrainError;
use crate::mesh_frame::{MeshFrame, ZoneSection, turn_of_spin_gradient};
use crate::pose::{Vector6, on_turn, stacked};

mod tooth_zero;

pub(crate) use tooth_zero::ToothZero;

/// 6×6 matrix on the increments of a pose.
pub type Matrix6 = SMatrix<f64, 6, 6>;

/// A slice plane at a pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlicePlane {
    /// Place of the slice along the axes at the pitch point, from halfway between the mid-faces \[m\].
    pub section_m: f64,
    /// The same from the mid-faces of gear 1 and gear 2 \[m\].
    pub heights_m: [f64; 2],
    /// w: unit vector of the line of action, direction of the force on gear 2, gear 1 axes.
    pub normal: Vector3<f64>,
    /// w⊥: across it in the plane, counter-clockwise.
    pub across: Vector3<f64>,
    /// L: length of the line of action between the base circles \[m\], with its sign ([`BaseCircles`]).
    pub length_m: f64,
    /// Working pressure angle α \[rad\].
    pub pressure_angle_rad: f64,
    /// β: polar angle of gear 2's axis from gear 1's \[rad\]; half a turn more where one is a ring.
    pub polar_rad: f64,
    /// Where the plane cuts the axes of gear 1 and gear 2, from their origins \[m\].
    pub(crate) axis_heights_m: [f64; 2],
    /// f·w and f·w⊥.
    pub(crate) tilt: [f64; 2],
    /// ∂s and ∂(s + F/2).
    pub(crate) section_gradient: Vector6,
    pub(crate) plane_gradient: Vector6,
}

/// The slice planes of one side of the teeth at a pose. Reused from call to call.
#[derive(Debug, Clone, Default)]
pub struct SidePlanes {
    /// The planes.
    pub planes: Vec<SlicePlane>,
    /// The flanks of tooth 0 in them.
    pub(crate) zeros: Vec<ToothZero>,
}

/// What both sides of the teeth share in a slice plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CentreLine {
    at: ZoneSection,
    /// e_r(β) and e_t(β), β the polar angle of a: against the way to gear 2 where one gear is a ring.
    radial: Vector3<f64>,
    tangential: Vector3<f64>,
    /// sin α and cos α.
    pressure_angle: (f64, f64),
    pressure_angle_rad: f64,
    pub length_m: f64,
    pub polar_rad: f64,
}

/// Length L \[m\] of the line of action between the base circles, and working pressure angle \[rad\].
pub(crate) fn line_of_action(
    circles: &BaseCircles,
    distance_m: f64,
) -> Result<(f64, f64), DrivetrainError> {
    let line = circles.line_of_action(distance_m);
    line.ok_or(DrivetrainError::CentreDistance {
        found_mm: distance_m * 1e3,
        smallest_mm: circles.sum_m().abs() * 1e3,
    })
}

impl CentreLine {
    /// The centre line in a section.
    pub(crate) fn new(frame: &MeshFrame, at: ZoneSection) -> Result<Self, DrivetrainError> {
        let [z_1, z_2] = at.axis_heights_m;
        // Of one magnitude: nothing is lost where the gears stand far along the axes.
        let d = frame.displacement_m + z_2 * frame.axis_2 - z_1 * Vector3::z();
        let d = d - d.dot(&frame.axis) * frame.axis;
        let circles = &frame.circles;
        let (length_m, pressure_angle_rad) = line_of_action(circles, d.norm())?;
        let (distance, sum) = (circles.signed_distance_m(d.norm()), circles.sum_m());
        let radial = d / distance;
        Ok(Self {
            at,
            radial,
            tangential: frame.axis.cross(&radial),
            pressure_angle: (length_m / distance, sum / distance),
            pressure_angle_rad,
            length_m,
            polar_rad: frame.polar_rad(&radial),
        })
    }

    /// The slice plane for flanks of the hand σ.
    pub(crate) fn plane(&self, frame: &MeshFrame, sigma: f64) -> SlicePlane {
        let (sin, cos) = self.pressure_angle;
        let normal = sin * self.radial - sigma * cos * self.tangential;
        let across = sin * self.tangential + sigma * cos * self.radial;
        SlicePlane {
            section_m: self.at.section_m,
            heights_m: self.at.heights_m,
            normal,
            across,
            length_m: self.length_m,
            pressure_angle_rad: self.pressure_angle_rad,
            polar_rad: self.polar_rad,
            axis_heights_m: self.at.axis_heights_m,
            tilt: [frame.half_tilt.dot(&normal), frame.half_tilt.dot(&across)],
            section_gradient: self.at.gradient,
            plane_gradient: self.at.plane_gradient,
        }
    }
}

impl SlicePlane {
    /// w·∂d.
    pub(crate) fn along_normal(&self, frame: &MeshFrame) -> Vector6 {
        self.of_distance(frame, &self.normal, self.tilt[0])
    }

    /// ∂ω = w⊥·∂d/L: turn of the line of action in the plane.
    pub(crate) fn turn(&self, frame: &MeshFrame) -> Vector6 {
        self.of_distance(frame, &self.across, self.tilt[1]) / self.length_m
    }

    fn of_distance(&self, frame: &MeshFrame, along: &Vector3<f64>, tilt: f64) -> Vector6 {
        let moment = self.axis_heights_m[1] * frame.axis_2.cross(along);
        stacked(*along, moment) + 2.0 * tilt * self.plane_gradient
    }

    /// Second derivative of the transverse gap of spur flanks by the increments; what falls to zero with the tilt is
    /// left out, and microgeometry: that is of the order of the load times its curvature, 1e-6 of the stiffness. On
    /// parallel axes, with p = (0, b × w) and ∂z₂ = ∂(s + F/2) − ∂D′/2,
    ///
    /// ```text
    /// ∂²g = L ∂ω ∂ωᵀ + p ∂z₂ᵀ + ∂(s + F/2) pᵀ − ½ (c, 0) pᵀ + [z₂ b wᵀ − (σ r_b2/2 + σ R/8) b×]
    /// ```
    pub(crate) fn transverse_curvature(&self, frame: &MeshFrame, sigma: f64) -> Matrix6 {
        let turn = self.turn(frame);
        let by_tilt = on_turn(frame.axis_2.cross(&self.normal));
        let height_2 = self.plane_gradient - 0.5 * frame.displacement_along_gradient;
        let upright = stacked(0.5 * frame.axis, Vector3::zeros());
        let mut h = self.length_m * turn * turn.transpose();
        h += by_tilt * height_2.transpose();
        h += (self.plane_gradient - upright) * by_tilt.transpose();
        let [r1, r2] = frame.circles.radii_m;
        let mut turns = h.fixed_view_mut::<3, 3>(3, 3);
        turns += self.axis_heights_m[1] * frame.axis_2 * self.normal.transpose();
        turns += sigma * (r2 + 0.25 * (r1 + r2)) * turn_of_spin_gradient();
        h
    }
}
