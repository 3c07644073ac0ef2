//! A plane across gear 1's axis at a pose: where gear 2's axis crosses it, and the line of action in it.

use std::f64::consts::TAU;

use gearmesh_geometry::{FlankSide, ToothGeometry};
use nalgebra::{Matrix3, SMatrix, Vector3};

use crate::error::DrivetrainError;
use crate::pose::{Pose, Vector6};

/// How far the spacing of slice planes may vary, as a share of it: rounding.
const UNEVEN: f64 = 1e-6;

/// 6×6 matrix on the increments of a pose.
pub type Matrix6 = SMatrix<f64, 6, 6>;

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
pub(crate) struct CentreLine {
    pub z_m: f64,
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
    pub(crate) slices: Vec<CentreLine>,
    pub(crate) middle: Option<CentreLine>,
    pub(crate) spin_rad: f64,
}

/// Length L \[m\] of the line of action between the base circles, and working pressure angle \[rad\].
pub(crate) fn line_of_action(
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

/// Two vectors one above the other.
pub(crate) fn stacked(upper: Vector3<f64>, lower: Vector3<f64>) -> Vector6 {
    Vector6::new(upper[0], upper[1], upper[2], lower[0], lower[1], lower[2])
}

impl CentreLine {
    /// The centre line in the plane z.
    pub(crate) fn new(
        gears: &[ToothGeometry; 2],
        pose: &Pose,
        z_m: f64,
    ) -> Result<Self, DrivetrainError> {
        let d = pose.displacement_m + z_m * pose.axis_2();
        let distance = d[0].hypot(d[1]);
        let (length_m, pressure_angle_rad) = line_of_action(gears, distance)?;
        let sum = gears[0].base_radius_m + gears[1].base_radius_m;
        Ok(Self {
            z_m,
            radial: Vector3::new(d[0] / distance, d[1] / distance, 0.0),
            pressure_angle: (length_m / distance, sum / distance),
            pressure_angle_rad,
            length_m,
            polar_rad: d[1].atan2(d[0]),
        })
    }

    /// Takes the polar angle within half a turn of that of the middle: where gear 1 has turned by half a turn, those of some slices would be π,
    /// of others −π, and teeth that are counted in the middle would be a whole turn off.
    pub(crate) fn turn_next_to(&mut self, middle: &Self) {
        self.polar_rad += TAU * ((middle.polar_rad - self.polar_rad) / TAU).round();
    }

    /// The slice plane for flanks of one side.
    pub(crate) fn plane(&self, side: FlankSide) -> SlicePlane {
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
    /// Second derivative of the transverse gap by the increments, microgeometry left out: that is of the order of the load times its
    /// curvature, 1e-6 of the stiffness.
    pub(crate) fn transverse_curvature(
        &self,
        pose: &Pose,
        side: FlankSide,
        base_radius_2_m: f64,
    ) -> Matrix6 {
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

/// Width of evenly spaced slices \[m\]; none where there is one.
pub(crate) fn even_width_m(slices_m: &[f64]) -> Result<Option<f64>, DrivetrainError> {
    let steps = || slices_m.windows(2).map(|pair| pair[1] - pair[0]);
    let Some(width) = steps().next() else {
        return Ok(None);
    };
    if width > 0.0 && steps().all(|step| (step - width).abs() <= UNEVEN * width) {
        return Ok(Some(width));
    }
    Err(DrivetrainError::UnevenSlices)
}
