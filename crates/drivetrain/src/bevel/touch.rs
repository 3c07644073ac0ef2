//! How two bevel flanks lie against each other where they touch: relative curvature, and the ellipse under a load as
//! each flank sees it.

use gearmesh_contact::RelativeCurvature;
use gearmesh_geometry::point_contact::PointContact;
use nalgebra::{Matrix2, Vector2, Vector3};

use super::hertz_stiffness::{bounded, curvature};
use super::nearest_points::Nearest;
use crate::flank_kinematics::{ContactPatch, PatchAxes};
use crate::slice_plane::Matrix6;

/// A contact of two flanks, in the frame of gear 1.
#[derive(Debug, Clone, Copy)]
pub(super) struct Touch {
    pub relative: RelativeCurvature,
    /// Second derivative of the gap by the pose where flanks as facets tell it.
    pub gap_curvature: Option<Matrix6>,
    normal: Vector3<f64>,
    /// s, v on both members.
    at: [[f64; 2]; 2],
    /// ∂r/∂(s, v) on both members.
    tangents: [[Vector3<f64>; 2]; 2],
}

impl Touch {
    pub(super) fn new(point: &Nearest) -> Self {
        Self {
            relative: curvature(point),
            gap_curvature: None,
            normal: point.normal,
            at: point.at,
            tangents: [0, 1].map(|m: usize| point.points[m].dr),
        }
    }

    /// The place on both flanks, and Hertz' ellipse under a force \[N\] with E* \[Pa\].
    pub(super) fn patch(&self, (force_n, modulus_pa): (f64, f64)) -> ContactPatch {
        let [least, largest] = bounded(&self.relative);
        let ellipse =
            PointContact::new(least + largest, largest - least, modulus_pa).ellipse(force_n);
        let along = self.relative.along;
        let axes = [
            along * ellipse.half_length_m,
            self.normal.cross(&along) * ellipse.half_width_m,
        ];
        ContactPatch {
            places: self.at,
            peak_pressure_pa: ellipse.peak_pressure_pa,
            axes: [0, 1].map(|m: usize| PatchAxes {
                long: on_flank(&self.tangents[m], &axes[0]),
                short: on_flank(&self.tangents[m], &axes[1]),
            }),
        }
    }
}

/// (Δs, Δv) of a step in the tangent plane, by least squares.
fn on_flank([by_s, by_v]: &[Vector3<f64>; 2], step: &Vector3<f64>) -> [f64; 2] {
    let square = Matrix2::new(
        by_s.dot(by_s),
        by_s.dot(by_v),
        by_s.dot(by_v),
        by_v.dot(by_v),
    );
    let right = Vector2::new(by_s.dot(step), by_v.dot(step));
    square
        .try_inverse()
        .map_or([0.0; 2], |inverse| (inverse * right).into())
}
