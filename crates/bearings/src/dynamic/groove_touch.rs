//! Where a ball stands against a groove: exact for a torus, at any place of the ball and any pose of the ring.

use nalgebra::{Matrix3, Vector3};

use super::surface_contact::{ElasticLoad, Touch};
use crate::ball_row::Groove;

/// The touch of a ball whose centre stands at w from the ring's middle, the ring's axis being a (both in the same
/// axes):
///
/// ```text
/// h = w·a,  e = (w − ha)/|w − ha|,  d = (|w − ha| − R) e + (h − z) a,  ℓ = |d|,  n = d/ℓ,  δ = ℓ − (r − D/2)
/// N = m mᵀ/ℓ + (n·e/|w − ha|) t tᵀ,   t = a × e,  m = n × t
/// ```
///
/// None on the axis and at the groove's centre, where n has no direction and the ball is far from touching.
#[inline(always)] // a touch is large to hand back
pub(crate) fn groove_touch(
    groove: &Groove,
    w: &Vector3<f64>,
    axis: &Vector3<f64>,
) -> Option<Touch> {
    let height = w.dot(axis);
    let radial = w - axis * height;
    let radius = radial.norm();
    if radius < 1e-3 * groove.centre_radius_m {
        return None;
    }
    let e = radial / radius;
    let (out, up) = (radius - groove.centre_radius_m, height - groove.centre_z_m);
    // Millimetres: no square is too large or too small.
    let length = (out * out + up * up).sqrt();
    let approach_m = length - groove.arm_m;
    if length < 1e-6 * groove.arm_m {
        return None;
    }
    let normal = e * (out / length) + axis * (up / length);
    let t = axis.cross(&e);
    let m = normal.cross(&t);
    let turning: Matrix3<f64> =
        m * (m / length).transpose() + t * (t * (out / (length * radius))).transpose();
    Some(Touch {
        approach_m,
        normal,
        turning,
        by_turn: None,
    })
}

/// Hertz' load of the groove's contact, with its energy ⅖ k δ^2.5.
#[inline]
pub(crate) fn hertz_load(groove: &Groove, approach_m: f64) -> ElasticLoad {
    let (load_n, slope_n_per_m) = groove.contact.load(approach_m);
    ElasticLoad {
        load_n,
        slope_n_per_m,
        stored_j: 0.4 * load_n * approach_m,
    }
}
