//! Stiffness of a bevel contact after Hertz, from the curvatures of both flanks where they touch.
//!
//! F = K δ^1.5 with K = E* k(κ_1, κ_2), κ the principal relative curvatures (`gearmesh_geometry::point_contact`). K
//! changes along the path; with the energy K δ^2.5/2.5 its change is a force, too, so that an undamped pair keeps its
//! energy:
//!
//! ```text
//! ∂(ln k)/∂pose = Σ ∂(ln k)/∂q ∂q/∂pose + ∂(ln k)/∂ϑ,   ϑ the turn of gear 2
//! ```
//!
//! The derivatives of ln k are differences. An edge counts with the curvature of its flank: how sharp it is is not
//! known.

use gearmesh_bevel::PatchPoint;
use gearmesh_contact::{RelativeCurvature, SurfaceCurvature};
use gearmesh_geometry::point_contact::PointContact;
use nalgebra::{Matrix3, Rotation3, Vector3};

use super::nearest_points::{Nearest, Placed};
use super::pose_derivatives::PoseDerivatives;
use crate::pose::Vector6;

/// Least relative curvature over the largest: longer ellipses, and flanks that bend into each other, count as such.
const LEAST: f64 = 1e-5;
/// Steps of the differences: of a place, flanks being 1 long, and of an angle \[rad\].
const STEP: f64 = 1e-3;

/// Least and largest curvature of an ellipse that has an end \[1/m\].
pub(crate) fn bounded(relative: &RelativeCurvature) -> [f64; 2] {
    let [least, largest] = relative.principal_per_m;
    [least.max(LEAST * largest), largest]
}

/// k = K/E* of two curvatures \[m^½\].
pub(crate) fn stiffness_per_pa(relative: &RelativeCurvature) -> f64 {
    let [least, largest] = bounded(relative);
    PointContact::new(least + largest, largest - least, 1.0).stiffness_n_per_m15
}

/// What a measure of the curvatures is at a contact, and the derivative of its logarithm by the increments of the pose.
pub(crate) fn local_measure(
    bodies: &[Placed<'_>; 2],
    found: &Nearest,
    motion: &PoseDerivatives,
    measure: impl Fn(&RelativeCurvature) -> f64,
) -> (f64, Vector6) {
    let measured =
        |points: [PatchPoint; 2]| measure(&curvature(&Nearest::new(found.held, found.at, points)));
    let here = measured(found.points);
    let slope = |there: [f64; 2]| (there[1] - there[0]) / (2.0 * STEP * here);
    let mut gradient = Vector6::zeros();
    for m in 0..2 {
        for k in 0..2 {
            if found.held[m][k].is_some() {
                continue;
            }
            let there = [-STEP, STEP].map(|step| {
                let (mut at, mut points) = (found.at[m], found.points);
                at[k] += step;
                points[m] = bodies[m].point(at);
                measured(points)
            });
            gradient += slope(there) * motion.places.row(2 * m + k).transpose();
        }
    }
    let [first, second] = found.points;
    for (i, axis) in [Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis()]
        .iter()
        .enumerate()
    {
        let there = [-STEP, STEP].map(|step| {
            let turn = Rotation3::from_axis_angle(axis, step);
            let turned = PatchPoint {
                dr: second.dr.map(|v| turn * v),
                n: turn * second.n,
                dn: second.dn.map(|v| turn * v),
                ..second
            };
            measured([first, turned])
        });
        gradient[3 + i] += slope(there);
    }
    (here, gradient)
}

/// Relative curvature of the surfaces at a contact.
pub(crate) fn curvature(point: &Nearest) -> RelativeCurvature {
    let surfaces = [0, 1].map(|m: usize| {
        let p = &point.points[m];
        principal(&p.curvature(), &point.normal, &p.dr[0].normalize())
    });
    RelativeCurvature::new(point.normal, surfaces)
}

/// Principal curvatures of a tensor in the plane across a normal.
pub(crate) fn principal(
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
