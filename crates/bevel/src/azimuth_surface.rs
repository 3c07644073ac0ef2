//! A flank as its azimuth over the blank: a place is s along the face and v up the flank between two lines of the
//! axial section. With L, h of the blank the point is
//!
//! ```text
//! r = (ρ cos χ, ρ sin χ, z),   ρ = L sin γ + h cos γ,   z = L cos γ − h sin γ
//! ```
//!
//! The lower line may bow, so that it follows a flank whose surface ends close below it. χ(s, v) is a sum of Chebyshev
//! polynomials; all derivatives follow.

use nalgebra::{Matrix3, Vector3};

use crate::blank::MemberBlank;
use crate::chebyshev::Chebyshev2;
use crate::cut_surface::curvature_tensor;
use crate::jet::{Jet, JetVector};

/// A point of a patch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PatchPoint {
    /// Place \[m\].
    pub r: Vector3<f64>,
    /// ∂r/∂s, ∂r/∂v.
    pub dr: [Vector3<f64>; 2],
    /// ∂²r/∂s², ∂²r/∂s∂v, ∂²r/∂v².
    pub ddr: [Vector3<f64>; 3],
    /// Unit normal into the material.
    pub n: Vector3<f64>,
    /// ∂n/∂s, ∂n/∂v.
    pub dn: [Vector3<f64>; 2],
}

impl PatchPoint {
    /// Curvature tensor in the member's frame, as [`crate::SurfacePoint::curvature`] \[1/m\].
    pub fn curvature(&self) -> Matrix3<f64> {
        curvature_tensor(&self.dr, &self.dn)
    }
}

/// How the lower line departs from the straight line between its ends: h(s) − h_line(s) = s (1 − s) Σ c_k (2 s − 1)^k
/// \[m\].
pub(crate) type Bow = [f64; 6];

/// Lines of the axial section between which s and v count.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SectionFrame {
    /// Cone distances of s = 0 and s = 1 \[m\].
    pub cones_m: [f64; 2],
    /// Heights of v = 0 and v = 1, each at s = 0 and s = 1 \[m\].
    pub heights_m: [[f64; 2]; 2],
    /// Bow of the line v = 0; none where it is straight.
    pub bow_m: Option<Bow>,
}

impl SectionFrame {
    /// The whole tooth: toe to heel, root to tip.
    pub(crate) fn of_tooth(blank: &MemberBlank) -> Self {
        let cones_m = [blank.inner_cone_m(), blank.outer_cone_m];
        Self {
            cones_m,
            heights_m: [
                cones_m.map(|cone| -blank.dedendum_m(cone)),
                cones_m.map(|cone| blank.addendum_m(cone)),
            ],
            bow_m: None,
        }
    }

    /// Departure of the lower line from its straight line at s, with its first and second derivative by s \[m\].
    fn bow(&self, s: f64) -> [f64; 3] {
        let Some(coefficients) = &self.bow_m else {
            return [0.0; 3];
        };
        let t = 2.0 * s - 1.0;
        let [mut p, mut dp, mut ddp] = [0.0; 3];
        for c in coefficients.iter().rev() {
            ddp = ddp * t + 2.0 * dp;
            dp = dp * t + p;
            p = p * t + c;
        }
        let (window, slope) = (s * (1.0 - s), -t);
        // t changes twice as fast as s.
        [
            window * p,
            slope * p + 2.0 * window * dp,
            -2.0 * p + 4.0 * slope * dp + 4.0 * window * ddp,
        ]
    }

    /// L and h of a place \[m\].
    pub(crate) fn place_m(&self, [s, v]: [f64; 2]) -> [f64; 2] {
        let along = |ends: [f64; 2]| ends[0] + (ends[1] - ends[0]) * s;
        let [mut low, high] = self.heights_m.map(along);
        low += self.bow(s)[0];
        [along(self.cones_m), low + (high - low) * v]
    }

    /// s and v of L and h.
    pub(crate) fn at(&self, [cone, height]: [f64; 2]) -> [f64; 2] {
        let [toe, heel] = self.cones_m;
        let s = (cone - toe) / (heel - toe);
        let [mut low, high] = self.heights_m.map(|h| h[0] + (h[1] - h[0]) * s);
        low += self.bow(s)[0];
        [s, (height - low) / (high - low)]
    }

    /// Height between the lines at s, and its derivative by s \[m\].
    pub(crate) fn depth_m(&self, s: f64) -> [f64; 2] {
        let [low, high] = self.heights_m;
        let ends = [0, 1].map(|i| high[i] - low[i]);
        let [bow, slope, _] = self.bow(s);
        [
            ends[0] + (ends[1] - ends[0]) * s - bow,
            ends[1] - ends[0] - slope,
        ]
    }

    /// L and h with derivatives by s and v.
    fn jets(&self, at: [f64; 2]) -> [Jet; 2] {
        let [s, v] = [Jet::parameter(at[0], 0), Jet::parameter(at[1], 1)];
        let line = |ends: [f64; 2]| Jet::constant(ends[0]) + s * (ends[1] - ends[0]);
        let [mut low, high] = self.heights_m.map(line);
        if self.bow_m.is_some() {
            low = low + Jet::parameter(at[0], 0).chain(self.bow(at[0]));
        }
        [line(self.cones_m), low + (high - low) * v]
    }
}

/// ρ and z of L and h, γ by its sine and cosine.
fn radius_and_height([sin, cos]: [f64; 2], [cone, height]: [Jet; 2]) -> [Jet; 2] {
    [cone * sin + height * cos, cone * cos - height * sin]
}

/// The surface.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct AzimuthSurface {
    pub frame: SectionFrame,
    /// Sine and cosine of the pitch angle.
    pub pitch: [f64; 2],
    /// +1 where the flank faces counter-clockwise, −1 where it faces clockwise.
    pub facing: f64,
    /// Least and largest s and v over which the polynomials are spread.
    pub domain: [[f64; 2]; 2],
    /// χ over the domain as a square \[rad\].
    pub azimuth: Chebyshev2,
}

impl AzimuthSurface {
    /// The point at a place.
    pub(crate) fn point(&self, at: [f64; 2]) -> PatchPoint {
        let [x, y] = scaled(&self.domain, at);
        self.point_of(at, &self.azimuth.jet(x, y))
    }

    /// The point at a place whose azimuth is known with its derivatives by x and y of the polynomials.
    pub(crate) fn point_of(&self, at: [f64; 2], azimuth: &Jet) -> PatchPoint {
        let [radius, z] = radius_and_height(self.pitch, self.frame.jets(at));
        let (sine, cosine) = self.by_place(azimuth).sin_cos();
        let r = JetVector([radius * cosine, radius * sine, z]);
        let (dr, ddr) = (r.first(), r.second());
        let across = dr[0].cross(&dr[1]);
        let size = across.norm();
        // r_s × r_v looks counter-clockwise, the normal of a flank that faces counter-clockwise the other way.
        let inwards = -self.facing / size;
        let n = across * inwards;
        let dn = [0, 1].map(|k| {
            let step = (ddr[k].cross(&dr[1]) + dr[0].cross(&ddr[k + 1])) * inwards;
            step - n * n.dot(&step)
        });
        PatchPoint {
            r: r.value(),
            dr,
            ddr,
            n,
            dn,
        }
    }

    /// χ with its derivatives by s and v from those by x and y.
    pub(crate) fn by_place(&self, azimuth: &Jet) -> Jet {
        let [by_s, by_v] = scale(&self.domain);
        Jet {
            v: azimuth.v,
            d: [azimuth.d[0] * by_s, azimuth.d[1] * by_v],
            dd: [
                azimuth.dd[0] * by_s * by_s,
                azimuth.dd[1] * by_s * by_v,
                azimuth.dd[2] * by_v * by_v,
            ],
        }
    }

    /// ∂χ/∂s and ∂χ/∂v \[rad\].
    pub(crate) fn azimuth_slopes(&self, at: [f64; 2]) -> [f64; 2] {
        let [x, y] = scaled(&self.domain, at);
        self.by_place(&self.azimuth.jet(x, y)).d
    }

    /// χ \[rad\].
    pub(crate) fn azimuth_rad(&self, at: [f64; 2]) -> f64 {
        let [x, y] = scaled(&self.domain, at);
        self.azimuth.value(x, y)
    }

    /// ∂χ/∂s and ∂χ/∂v of a surface through a point with this normal (of either sense), and by how much the point moves
    /// along the normal for each radian of χ \[m\]. As r_s·N = 0 and r_v·N = 0, χ_k = −(ρ_k N_ρ + z_k N_z)/(ρ N_φ).
    pub(crate) fn slopes_of_normal(
        frame: &SectionFrame,
        pitch: [f64; 2],
        at: [f64; 2],
        r: &Vector3<f64>,
        normal: &Vector3<f64>,
    ) -> ([f64; 2], f64) {
        let [radius, z] = radius_and_height(pitch, frame.jets(at));
        let size = r.x.hypot(r.y);
        let outwards = (normal.x * r.x + normal.y * r.y) / size;
        let around = (normal.y * r.x - normal.x * r.y) / size;
        let slopes =
            [0, 1].map(|k| -(radius.d[k] * outwards + z.d[k] * normal.z) / (size * around));
        (slopes, size * around)
    }
}

/// s, v to the square of the polynomials.
pub(crate) fn scaled(domain: &[[f64; 2]; 2], at: [f64; 2]) -> [f64; 2] {
    let by = scale(domain);
    [0, 1].map(|k| (at[k] - domain[k][0]) * by[k] - 1.0)
}

pub(crate) fn unscaled(domain: &[[f64; 2]; 2], xy: [f64; 2]) -> [f64; 2] {
    let by = scale(domain);
    [0, 1].map(|k| domain[k][0] + (xy[k] + 1.0) / by[k])
}

pub(crate) fn scale(domain: &[[f64; 2]; 2]) -> [f64; 2] {
    domain.map(|[low, high]| 2.0 / (high - low))
}
