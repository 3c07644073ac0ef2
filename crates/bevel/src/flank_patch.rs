//! A flank as one smooth patch over its blank, for contact in motion: quick to evaluate, and the same whether a machine
//! or a measurement gave it.
//!
//! A place is s along the face, 0 at the toe and 1 at the heel, and v up the flank, 0 at the lower line and 1 at the
//! tip. With L, h of the blank the point is
//!
//! ```text
//! r = (ρ cos χ, ρ sin χ, z),   ρ = L sin γ + h cos γ,   z = L cos γ − h sin γ
//! ```
//!
//! χ(s, v) is interpolated from the exact surface by Chebyshev polynomials; all derivatives follow.

use nalgebra::{Matrix3, Vector3};

use crate::blank::MemberBlank;
use crate::chebyshev::Chebyshev2;
use crate::cut_surface::curvature_tensor;
use crate::error::BevelError;
use crate::hand::FlankSide;
use crate::jet::{Jet, JetVector};
use crate::tooth::Tooth;

/// How far a patch goes on beyond toe and heel, and below and above its lines, as shares of its size.
const BEYOND: [[f64; 2]; 2] = [[0.1, 0.1], [0.0, 0.12]];

/// The mate's tip reaches so deep at most, over its addendum.
const REACH: f64 = 1.05;

/// Places along the face at which the lower end is looked at.
const LOOKS: usize = 9;

fn share(look: usize) -> f64 {
    look as f64 / (LOOKS - 1) as f64
}

/// A flank of tooth 0 in the member's frame: origin in the pitch apex, z towards the heel, the middle of the tooth on +x
/// at the mean point.
#[derive(Debug, Clone, PartialEq)]
pub struct FlankPatch {
    /// Number of teeth.
    pub teeth: usize,
    /// Cone distances of toe and heel \[m\].
    pub cones_m: [f64; 2],
    /// +1 where the flank faces counter-clockwise, −1 where it faces clockwise.
    pub facing: f64,
    /// Place of the mean point, on the pitch cone.
    pub mean: [f64; 2],
    /// Sine and cosine of the pitch angle.
    pitch: [f64; 2],
    /// Heights of the lower line and of the tip at toe and heel \[m\].
    heights_m: [[f64; 2]; 2],
    azimuth: Chebyshev2,
}

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

impl FlankPatch {
    /// The flank of a tooth.
    ///
    /// # Errors
    /// [`BevelError::NoFlankPoint`] where the surface does not reach over the blank.
    pub fn of_tooth(
        tooth: &Tooth,
        mate: &MemberBlank,
        side: FlankSide,
    ) -> Result<Self, BevelError> {
        let (blank, flank) = (&tooth.blank, tooth.flank(side));
        let cones_m = [blank.inner_cone_m(), blank.outer_cone_m];
        // The lower line is straight, and nowhere above where the flank ends or the mate's tip reaches.
        let mut depths = [0.0; LOOKS];
        for (i, height) in depths.iter_mut().enumerate() {
            let cone = cones_m[0] + blank.face_width_m * share(i);
            let bottom = flank.bottom(cone)?;
            let of_mate = -REACH * mate.addendum_m(cone);
            *height = of_mate.max(flank.place(&bottom.point.r)[1]);
        }
        let [toe, heel] = [depths[0], depths[LOOKS - 1]];
        let above = |i: usize| toe + (heel - toe) * share(i) - depths[i];
        let sag = (0..LOOKS).map(above).fold(0.0, f64::max);
        let lower = [toe - sag, heel - sag];
        let frame = Frame {
            cones_m,
            heights_m: [lower, cones_m.map(|cone| blank.addendum_m(cone))],
        };
        let turn = tooth.half_angle_rad(side);
        let mut start = *flank.mean();
        let azimuth = Chebyshev2::interpolate(|x, y| {
            let [cone, height] = frame.place_m(unscaled([x, y]));
            let found = flank
                .locate_from(cone, height, &start)
                .or_else(|_| flank.locate(cone, height))?;
            start = found;
            let r = found.point.r;
            Ok::<f64, BevelError>(turn + r.y.atan2(r.x))
        })?;
        let (sin, cos) = blank.pitch_angle_rad.sin_cos();
        let along = (blank.mean_cone_m - cones_m[0]) / blank.face_width_m;
        let [low, high] = frame.heights_m.map(|h| h[0] + (h[1] - h[0]) * along);
        Ok(Self {
            teeth: blank.teeth,
            cones_m,
            facing: side.facing(blank.hand),
            mean: [along, -low / (high - low)],
            pitch: [sin, cos],
            heights_m: frame.heights_m,
            azimuth,
        })
    }

    /// Least and largest s and v at which the patch is defined.
    pub const fn domain() -> [[f64; 2]; 2] {
        let [[a, b], [c, d]] = BEYOND;
        [[-a, 1.0 + b], [-c, 1.0 + d]]
    }

    /// Cone distance and height above the pitch cone of a place \[m\].
    pub fn place_m(&self, at: [f64; 2]) -> [f64; 2] {
        let frame = Frame {
            cones_m: self.cones_m,
            heights_m: self.heights_m,
        };
        frame.place_m(at)
    }

    /// The point at a place.
    pub fn point(&self, at: [f64; 2]) -> PatchPoint {
        let [s, v] = [Jet::parameter(at[0], 0), Jet::parameter(at[1], 1)];
        let number = Jet::constant;
        let [toe, heel] = self.cones_m;
        let cone = number(toe) + number(heel - toe) * s;
        let [low, high] = self
            .heights_m
            .map(|h| number(h[0]) + number(h[1] - h[0]) * s);
        let height = low + (high - low) * v;
        let [sin, cos] = self.pitch.map(number);
        let radius = cone * sin + height * cos;
        let [x, y] = scaled(at);
        let mut azimuth = self.azimuth.jet(x, y);
        let [by_s, by_v] = scale();
        azimuth.d = [azimuth.d[0] * by_s, azimuth.d[1] * by_v];
        azimuth.dd = [
            azimuth.dd[0] * by_s * by_s,
            azimuth.dd[1] * by_s * by_v,
            azimuth.dd[2] * by_v * by_v,
        ];
        let (sine, cosine) = azimuth.sin_cos();
        let r = JetVector([radius * cosine, radius * sine, cone * cos - height * sin]);
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

    /// Azimuth of a place in the member's frame \[rad\].
    pub fn azimuth_rad(&self, at: [f64; 2]) -> f64 {
        let [x, y] = scaled(at);
        self.azimuth.value(x, y)
    }

    /// Lever of the normal at the mean point about the member's axis \[m\], above zero.
    pub fn lever_m(&self) -> f64 {
        let point = self.point(self.mean);
        (point.r.x * point.n.y - point.r.y * point.n.x).abs()
    }
}

/// Lines of the blank.
struct Frame {
    cones_m: [f64; 2],
    heights_m: [[f64; 2]; 2],
}

impl Frame {
    fn place_m(&self, [s, v]: [f64; 2]) -> [f64; 2] {
        let along = |ends: [f64; 2]| ends[0] + (ends[1] - ends[0]) * s;
        let [low, high] = self.heights_m.map(along);
        [along(self.cones_m), low + (high - low) * v]
    }
}

/// s, v to the square of the polynomials.
fn scaled(at: [f64; 2]) -> [f64; 2] {
    let [by_s, by_v] = scale();
    let [[s, _], [v, _]] = FlankPatch::domain();
    [(at[0] - s) * by_s - 1.0, (at[1] - v) * by_v - 1.0]
}

fn unscaled(xy: [f64; 2]) -> [f64; 2] {
    let [by_s, by_v] = scale();
    let [[s, _], [v, _]] = FlankPatch::domain();
    [s + (xy[0] + 1.0) / by_s, v + (xy[1] + 1.0) / by_v]
}

fn scale() -> [f64; 2] {
    FlankPatch::domain().map(|[low, high]| 2.0 / (high - low))
}
