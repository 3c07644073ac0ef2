//! A flank as a surface over its grid's coordinates (u, v): points, normals, curvatures; and how two such surfaces face
//! each other.
//!
//! What a kinematics of flanks needs to make patches of any family: where two surfaces touch, κ = κ₁ + κ₂ is their
//! relative curvature in each direction of the common tangent plane. A patch has 1/κ across its line as `radius_m`;
//! along the line κ opens the gap by ½ κ v². Nothing here is asked in a solve: patches carry the numbers.
//!
//! Involute helicoid (F. L. Litvin, A. Fuentes, Gear Geometry and Applied Theory): straight along its generators, which
//! lean by β_b; across them the radius of curvature is r_b ξ/cos β_b.

use gearmesh_geometry::{Flank, ToothGeometry};
use nalgebra::Vector3;

use crate::contact_patch::FlankPlace;

/// Curvature of a surface at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceCurvature {
    /// Principal curvatures \[1/m\], positive where the body is convex.
    pub principal_per_m: [f64; 2],
    /// Unit tangent of the first of them.
    pub first: Vector3<f64>,
}

/// A flank of one tooth in the frame of its gear: z along the axis, the tooth centred on +x at mid-face.
pub trait FlankSurface {
    /// Point \[m\].
    fn point_m(&self, at: FlankPlace) -> Vector3<f64>;

    /// Unit normal into the material: direction of the normal force on the tooth.
    fn normal(&self, at: FlankPlace) -> Vector3<f64>;

    /// Curvature.
    fn curvature(&self, at: FlankPlace) -> SurfaceCurvature;

    /// Area per du dv, |∂x/∂u × ∂x/∂v|: what the hats of a grid average over.
    fn area(&self, at: FlankPlace) -> f64;
}

/// A flank of an involute gear: u is the roll angle ξ \[rad\], v the height above mid-face \[m\].
#[derive(Debug, Clone, Copy)]
pub struct InvoluteSurface<'a> {
    /// The tooth.
    pub tooth: &'a ToothGeometry,
    /// Its flank.
    pub flank: Flank,
}

impl InvoluteSurface<'_> {
    /// Turns what is seen in the section at mid-face into the section at a height.
    fn turned(&self, [x, y, z]: [f64; 3], height_m: f64) -> Vector3<f64> {
        let (sin, cos) = (self.tooth.twist_rad_per_m() * height_m).sin_cos();
        Vector3::new(cos * x - sin * y, sin * x + cos * y, z)
    }
}

impl FlankSurface for InvoluteSurface<'_> {
    fn point_m(&self, at: FlankPlace) -> Vector3<f64> {
        let [x, y] = self.tooth.flank_point_m(self.flank, at.u);
        self.turned([x, y, at.v], at.v)
    }

    fn normal(&self, at: FlankPlace) -> Vector3<f64> {
        self.turned(self.tooth.flank_normal(self.flank, at.u), at.v)
    }

    /// Across the generators, towards the tip, first.
    fn curvature(&self, at: FlankPlace) -> SurfaceCurvature {
        let (_, [x, y]) = self.tooth.flank_frame(self.flank, at.u);
        // A ring's flank is hollow.
        let radius_m = self.tooth.tip_direction() * self.tooth.base_radius_m * at.u;
        let across = self.tooth.base_helix_angle_rad().cos() / radius_m;
        SurfaceCurvature {
            principal_per_m: [across, 0.0],
            first: self.turned([x, y, 0.0], at.v),
        }
    }

    /// r_b ξ/cos β_b.
    fn area(&self, at: FlankPlace) -> f64 {
        self.tooth.base_radius_m * at.u / self.tooth.base_helix_angle_rad().cos()
    }
}

/// Relative curvature of two surfaces that touch, in their tangent plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RelativeCurvature {
    /// Least and largest \[1/m\].
    pub principal_per_m: [f64; 2],
    /// Unit tangent along which it is least: the long axis of a point contact.
    pub along: Vector3<f64>,
}

impl RelativeCurvature {
    /// Of two surfaces with one normal line; tangents in one frame.
    #[must_use]
    pub fn new(normal: Vector3<f64>, surfaces: [SurfaceCurvature; 2]) -> Self {
        let x = surfaces[0].first;
        let y = normal.cross(&x);
        let (mut xx, mut yy, mut xy) = (0.0, 0.0, 0.0);
        for surface in surfaces {
            let (cos, sin) = (surface.first.dot(&x), surface.first.dot(&y));
            let [first, second] = surface.principal_per_m;
            xx += first * cos * cos + second * sin * sin;
            yy += first * sin * sin + second * cos * cos;
            xy += (first - second) * cos * sin;
        }
        let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
        let spread = half.hypot(xy);
        // The largest lies at half the angle of (half, xy) from x, the least across it.
        let angle = 0.5 * xy.atan2(half);
        Self {
            principal_per_m: [mean - spread, mean + spread],
            along: angle.cos() * y - angle.sin() * x,
        }
    }

    /// Curvature \[1/m\] along a unit tangent.
    #[must_use]
    pub fn along_tangent(&self, tangent: &Vector3<f64>) -> f64 {
        let [least, largest] = self.principal_per_m;
        let square = self.along.dot(tangent).powi(2);
        least * square + largest * (1.0 - square)
    }
}
