//! A groove as a mesh of triangles: what a ball feels does not depend on how fine the mesh is, once the contact spans
//! some of them.
//!
//! Every point x of the surface that the ball covers by h = D/2 − |x − w| > 0 stores ½h² on a unit of area, as an
//! elastic foundation does. With W the integral over all triangles, the approach is that of the paraboloid that would
//! store the same,
//!
//! ```text
//! G(δ) = δ³/√(1 + βδ) = 3 W √(ρ₁ρ₂)/π,   n = ∂δ/∂w,   N = ∂n/∂w
//! ```
//!
//! with the sums of curvatures ρ₁ and ρ₂ of the contact across and along the groove, and βδ the share by which ρ₁ grows
//! as the ball sinks in. There is one force for a ball and a groove, Hertz' of this δ; it has a potential, and its
//! direction is smooth, which that to the nearest triangle is not. Formula (21) of docs/theory/rolling_bearings.md.

use std::f64::consts::{FRAC_PI_3, PI, TAU};

use nalgebra::{Matrix3, Vector3};
use parry3d_f64::math::Vector;
use parry3d_f64::shape::TriMesh;

use super::surface_contact::Touch;
use crate::ball_row::{BallRow, Groove};
use crate::error::BearingError;
use crate::faults::Side;

/// Most triangles of a groove: 300 MB.
const MOST_TRIANGLES: f64 = 2e6;
/// The groove reaches so far to both sides of its bottom.
const REACH_RAD: f64 = FRAC_PI_3;

/// How fine a groove is divided.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TriangleSize {
    /// Longest edge across the groove \[m\].
    pub across_m: f64,
    /// Longest edge along the way of the balls \[m\].
    pub along_m: f64,
}

/// A groove as triangles, in the frame of its ring.
pub struct GrooveTriangles {
    mesh: TriMesh,
    /// 3√(ρ₁ρ₂)/π \[1/m\].
    paraboloid_per_m: f64,
    /// β \[1/m\].
    growth_per_m: f64,
}

impl GrooveTriangles {
    /// Divides the groove of a ring. Its vertices stand aside of the torus, so that the triangles lie on it in the
    /// mean.
    ///
    /// # Errors
    /// [`BearingError::Parameter`] where an edge is not positive, too long for the groove or so short that there would
    /// be more than two million triangles.
    pub fn new(row: &BallRow, side: Side, size: TriangleSize) -> Result<Self, BearingError> {
        let groove = row.groove(side);
        let radius_m = groove.arm_m + 0.5 * row.ball_diameter_m;
        let (across, along) = (
            2.0 * REACH_RAD * radius_m / size.across_m,
            TAU * (groove.centre_radius_m + radius_m) / size.along_m,
        );
        let allowed = "positive, at most a fifth of the groove's width, and long enough for two million triangles on a race";
        for (what, found, parts) in [
            (
                "the edge of the triangles across the groove in m",
                size.across_m,
                across,
            ),
            (
                "the edge of the triangles along the groove in m",
                size.along_m,
                along,
            ),
        ] {
            let fits = found > 0.0 && parts >= 5.0 && 2.0 * across * along <= MOST_TRIANGLES;
            BearingError::require(what, found, fits, allowed)?;
        }
        let (across, along) = (across.ceil() as usize, along.ceil() as usize);
        // Towards the bottom of the groove, outwards or inwards.
        let out = if side == Side::Outer { 1.0 } else { -1.0 };
        let (step, turn) = (2.0 * REACH_RAD / across as f64, TAU / along as f64);
        let at = |angle: f64, turned: f64| on_torus(groove, (radius_m, out), angle, turned);
        let mut vertices = Vec::with_capacity((across + 1) * along);
        for place in 0..along {
            let turned = turn * place as f64;
            for row in 0..=across {
                let angle = -REACH_RAD + step * row as f64;
                let (x, normal) = at(angle, turned);
                // How far the middles of the chords lie off, two thirds of which are the mean.
                let chord = |a: Vector3<f64>, b: Vector3<f64>| (0.5 * (a + b) - x).dot(&normal);
                let half = [0.5 * step, 0.5 * turn];
                let off = chord(at(angle - half[0], turned).0, at(angle + half[0], turned).0)
                    + chord(at(angle, turned - half[1]).0, at(angle, turned + half[1]).0);
                let moved = x - normal * (off * 2.0 / 3.0);
                vertices.push(Vector::new(moved.x, moved.y, moved.z));
            }
        }
        let mut indices = Vec::with_capacity(2 * across * along);
        let number = |place: usize, row: usize| ((place % along) * (across + 1) + row) as u32;
        for place in 0..along {
            for row in 0..across {
                let [a, b] = [number(place, row), number(place, row + 1)];
                let [c, d] = [number(place + 1, row), number(place + 1, row + 1)];
                // Diagonals by turns, so that none of the two directions is preferred.
                if (place + row).is_multiple_of(2) {
                    indices.extend([[a, b, d], [a, d, c]]);
                } else {
                    indices.extend([[a, b, c], [b, d, c]]);
                }
            }
        }
        let mesh = TriMesh::new(vertices, indices).map_err(|_| BearingError::Parameter {
            what: "the edge of the triangles in m",
            found: size.across_m,
            allowed,
        })?;
        let across_per_m = 2.0 / row.ball_diameter_m - 1.0 / radius_m;
        let along_per_m = groove.contact.curvature_sum_per_m - across_per_m;
        Ok(Self {
            mesh,
            paraboloid_per_m: 3.0 * (across_per_m * along_per_m).sqrt() / PI,
            growth_per_m: (2.0 / row.ball_diameter_m).powi(2) / across_per_m,
        })
    }

    /// Number of triangles.
    #[must_use]
    pub fn triangles(&self) -> usize {
        self.mesh.num_triangles()
    }

    /// δ \[m\], n and N \[1/m\] of a ball of a radius whose centre stands at w in the frame of the ring; none where it
    /// covers no triangle.
    #[must_use]
    pub fn approach(
        &self,
        w: &Vector3<f64>,
        radius_m: f64,
    ) -> Option<(f64, Vector3<f64>, Matrix3<f64>)> {
        let centre = Vector::new(w.x, w.y, w.z);
        let (mut stored, mut by_place, mut by_both) =
            (0.0, Vector3::zeros(), Matrix3::<f64>::zeros());
        let near = self.mesh.bvh().leaves(|node| {
            let aabb = node.aabb();
            let nearest = centre.clamp(aabb.mins, aabb.maxs);
            (nearest - centre).length_squared() < radius_m * radius_m
        });
        for triangle in near {
            let triangle = self.mesh.triangle(triangle);
            let (a, b, c) = (
                triangle.a - centre,
                triangle.b - centre,
                triangle.c - centre,
            );
            let area = 0.5 * (b - a).cross(c - a).length() / 3.0;
            let sum = (a + b + c) / 6.0;
            for corner in [a, b, c] {
                // Three points inside, exact for squares.
                let arm = sum + corner * 0.5;
                let distance = arm.length();
                let covered = radius_m - distance;
                if covered <= 0.0 {
                    continue;
                }
                let normal = Vector3::new(arm.x, arm.y, arm.z) / distance;
                stored += 0.5 * area * covered * covered;
                by_place += normal * (area * covered);
                let square = normal * normal.transpose();
                by_both += (square - (Matrix3::identity() - square) * (covered / distance)) * area;
            }
        }
        if stored <= 0.0 {
            return None;
        }
        let (approach, slope, bend) = self.paraboloid(self.paraboloid_per_m * stored);
        let normal = by_place * (self.paraboloid_per_m / slope);
        let turning = by_both * (self.paraboloid_per_m / slope)
            - normal * normal.transpose() * (bend / slope);
        Some((approach, normal, turning))
    }

    /// δ of a G, G′ and G″.
    fn paraboloid(&self, value: f64) -> (f64, f64, f64) {
        let first = value.cbrt();
        // βδ is some hundredths: each pass gains two digits.
        let mut approach = first;
        for _ in 0..8 {
            approach = first * (1.0 + self.growth_per_m * approach).cbrt().sqrt();
        }
        let x = self.growth_per_m * approach;
        let root = (1.0 + x).sqrt();
        let slope = approach * approach * (3.0 + 2.5 * x) / (root * (1.0 + x));
        let bend = approach * (6.0 + 9.0 * x + 3.75 * x * x) / (root * (1.0 + x).powi(2));
        (approach, slope, bend)
    }

    /// The touch of a ball at w from the ring's middle, both in the axes in which those of the ring are `axes`.
    pub(super) fn touch(
        &self,
        w: &Vector3<f64>,
        axes: &Matrix3<f64>,
        radius_m: f64,
    ) -> Option<Touch> {
        let (approach_m, normal, turning) = self.approach(&axes.tr_mul(w), radius_m)?;
        Some(Touch {
            approach_m,
            normal: axes * normal,
            turning: axes * turning * axes.transpose(),
            by_turn: None,
        })
    }
}

/// A point of the groove's surface and its normal, away from the balls; the angle is counted from the groove's bottom.
fn on_torus(
    groove: &Groove,
    (radius_m, out): (f64, f64),
    angle: f64,
    turned: f64,
) -> (Vector3<f64>, Vector3<f64>) {
    let e = Vector3::new(turned.cos(), turned.sin(), 0.0);
    let normal = e * (out * angle.cos()) + Vector3::z() * angle.sin();
    let centre = e * groove.centre_radius_m + Vector3::z() * groove.centre_z_m;
    (centre + normal * radius_m, normal)
}
