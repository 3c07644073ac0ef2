//! A flank as one smooth patch over its blank, for contact in motion: quick to evaluate, and the same whether a machine
//! or a measurement gave it.
//!
//! A place is s along the face, 0 at the toe and 1 at the heel, and v up the flank, 0 at the lower line and 1 at the
//! tip. Its azimuth is interpolated from the exact surface (`azimuth_surface.rs`).

use nalgebra::{DMatrix, DVector};

use crate::azimuth_surface::{AzimuthSurface, Bow, SectionFrame, scaled, unscaled};
use crate::blank::MemberBlank;
use crate::chebyshev::Chebyshev2;
use crate::error::BevelError;
use crate::flank::Flank;
use crate::hand::FlankSide;
use crate::piecewise::Piecewise2;
use crate::tooth::Tooth;

pub use crate::azimuth_surface::PatchPoint;

/// How far a patch goes on beyond toe and heel, and above its upper line, as shares of its size.
const BEYOND: [f64; 2] = [0.1, 0.12];
/// How far it goes on below its lower line: gears that stand off their places reach deeper. The first of these where
/// the surface goes on and the series is exact; flanks that turn back close below end at the line.
const BELOW: [f64; 3] = [0.1, 0.07, 0.04];

/// What the last terms of such a series are worth at most \[m\].
const LAST_TERMS_M: f64 = 1e-11;

/// The mate's tip reaches so deep at most, over its addendum.
const REACH: f64 = 1.05;

/// Places along the face at which the lower end is looked at.
const LOOKS: usize = 9;

fn share(look: usize) -> f64 {
    look as f64 / (LOOKS - 1) as f64
}

/// A flank of tooth 0 in the member's frame: origin in the pitch apex, z towards the heel, the middle of the tooth
/// on +x at the mean point.
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
    surface: AzimuthSurface,
    /// The surface's azimuth, quick to evaluate.
    azimuth: Piecewise2,
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
        let turn = tooth.half_angle_rad(side);
        let domain = |below: f64| [[-BEYOND[0], 1.0 + BEYOND[0]], [-below, 1.0 + BEYOND[1]]];
        let flank = tooth.flank(side);
        let straight = reach_of(flank, mate)?;
        let is_exact = |surface: &AzimuthSurface| {
            surface.azimuth.last_terms() * tooth.blank.outer_cone_m < LAST_TERMS_M
        };
        let deeper = BELOW.into_iter().find_map(|below| {
            let surface = patch_over(flank, straight, domain(below), turn).ok();
            surface.filter(is_exact)
        });
        let surface = match deeper {
            Some(surface) => surface,
            None => patch_of(flank, straight, domain(0.0), turn)?,
        };
        let blank = &tooth.blank;
        let frame = &surface.frame;
        Ok(Self {
            teeth: blank.teeth,
            cones_m: frame.cones_m,
            facing: surface.facing,
            mean: frame.at([blank.mean_cone_m, 0.0]),
            azimuth: Piecewise2::of(&surface.azimuth),
            surface,
        })
    }

    /// Least and largest s and v at which the patch is defined.
    pub fn domain(&self) -> &[[f64; 2]; 2] {
        &self.surface.domain
    }

    /// Cone distance and height above the pitch cone of a place \[m\].
    pub fn place_m(&self, at: [f64; 2]) -> [f64; 2] {
        self.surface.frame.place_m(at)
    }

    /// The point at a place.
    pub fn point(&self, at: [f64; 2]) -> PatchPoint {
        self.point_turned(at, 0.0)
    }

    /// The point at a place of the flank that has turned about the member's axis \[rad\].
    pub fn point_turned(&self, at: [f64; 2], turn_rad: f64) -> PatchPoint {
        let [x, y] = scaled(&self.surface.domain, at);
        let mut azimuth = self.azimuth.jet(x, y);
        azimuth.v += turn_rad;
        self.surface.point_of(at, &azimuth)
    }

    /// How far the polynomials of cells, which [`Self::point`] takes, lie from the series that they stand for at a
    /// place: azimuth \[rad\], and its first and second derivatives by the place.
    pub fn azimuth_misfit(&self, at: [f64; 2]) -> [f64; 3] {
        let [x, y] = scaled(&self.surface.domain, at);
        let off = self
            .surface
            .by_place(&(self.azimuth.jet(x, y) - self.surface.azimuth.jet(x, y)));
        let most = |values: &[f64]| values.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        [off.v.abs(), most(&off.d), most(&off.dd)]
    }

    /// Azimuth of a place in the member's frame \[rad\].
    pub fn azimuth_rad(&self, at: [f64; 2]) -> f64 {
        self.surface.azimuth_rad(at)
    }

    /// Lever of the normal at the mean point about the member's axis \[m\], above zero.
    pub fn lever_m(&self) -> f64 {
        let point = self.point(self.mean);
        (point.r.x * point.n.y - point.r.y * point.n.x).abs()
    }
}

/// The part of a flank that the mate can reach: its lower line is straight, and nowhere above where the flank ends or
/// the mate's tip reaches.
///
/// # Errors
/// [`BevelError::NoFlankPoint`] where the flank ends above its fillet.
pub(crate) fn reach_of(flank: &Flank, mate: &MemberBlank) -> Result<SectionFrame, BevelError> {
    let mut depths = [0.0; LOOKS];
    for (i, height) in depths.iter_mut().enumerate() {
        let cone = cone_m(&flank.blank, share(i));
        let of_mate = -REACH * mate.addendum_m(cone);
        *height = of_mate.max(bottom_m(flank, cone)?);
    }
    let [toe, heel] = [depths[0], depths[LOOKS - 1]];
    let above = |i: usize| toe + (heel - toe) * share(i) - depths[i];
    let sag = (0..LOOKS).map(above).fold(0.0, f64::max);
    let mut frame = SectionFrame::of_tooth(&flank.blank);
    frame.heights_m[0] = [toe - sag, heel - sag];
    Ok(frame)
}

/// The whole flank above its fillet. Its lower line bows as the flank's end does: teeth close to undercut have no
/// surface below it.
///
/// # Errors
/// [`BevelError::NoFlankPoint`] where the flank ends above its fillet.
fn bowed_frame(flank: &Flank, domain: &[[f64; 2]; 2]) -> Result<SectionFrame, BevelError> {
    let mut frame = SectionFrame::of_tooth(&flank.blank);
    let [toe, heel] = [0.0, 1.0].map(|s| bottom_m(flank, cone_m(&flank.blank, s)));
    let [toe, heel] = [toe?, heel?];
    frame.heights_m[0] = [toe, heel];
    let [from, to] = domain[0];
    let size = Bow::default().len();
    let mut powers = DMatrix::zeros(3 * size, size);
    let mut bows = DVector::zeros(3 * size);
    for k in 0..3 * size {
        let turn = std::f64::consts::PI * (k as f64 + 0.5) / (3 * size) as f64;
        let s = from + 0.5 * (to - from) * (1.0 - turn.cos());
        bows[k] = bottom_m(flank, cone_m(&flank.blank, s))? - (toe + (heel - toe) * s);
        let t = 2.0 * s - 1.0;
        for power in 0..size {
            powers[(k, power)] = s * (1.0 - s) * t.powi(power as i32);
        }
    }
    frame.bow_m = powers
        .svd(true, true)
        .solve(&bows, 0.0)
        .ok()
        .map(|found| std::array::from_fn(|k| found[k]));
    Ok(frame)
}

fn cone_m(blank: &MemberBlank, s: f64) -> f64 {
    blank.inner_cone_m() + blank.face_width_m * s
}

/// Height of the flank's lower end above the pitch cone.
fn bottom_m(flank: &Flank, cone_m: f64) -> Result<f64, BevelError> {
    Ok(flank.place(&flank.bottom(cone_m)?.point.r)[1])
}

/// A flank over a domain of s and v, turned by an angle about the axis: down to the straight line of [`reach_of`], or,
/// where the surface does not reach so deep, the whole of it above its fillet.
///
/// # Errors
/// [`BevelError::NoFlankPoint`] where the surface does not reach over it either.
pub(crate) fn patch_of(
    flank: &Flank,
    straight: SectionFrame,
    domain: [[f64; 2]; 2],
    turn_rad: f64,
) -> Result<AzimuthSurface, BevelError> {
    patch_over(flank, straight, domain, turn_rad).or_else(|refused| {
        let bowed = bowed_frame(flank, &domain).map_err(|_| refused)?;
        patch_over(flank, bowed, domain, turn_rad)
    })
}

fn patch_over(
    flank: &Flank,
    frame: SectionFrame,
    domain: [[f64; 2]; 2],
    turn_rad: f64,
) -> Result<AzimuthSurface, BevelError> {
    let blank = &flank.blank;
    let mut start = *flank.mean();
    let azimuth = Chebyshev2::interpolate(|x, y| {
        let [cone, height] = frame.place_m(unscaled(&domain, [x, y]));
        let found = flank
            .locate_from(cone, height, &start)
            .or_else(|_| flank.locate(cone, height))?;
        start = found;
        let r = found.point.r;
        Ok::<f64, BevelError>(turn_rad + r.y.atan2(r.x))
    })?;
    let (sin, cos) = blank.pitch_angle_rad.sin_cos();
    Ok(AzimuthSurface {
        frame,
        pitch: [sin, cos],
        facing: flank.side.facing(blank.hand),
        domain,
        azimuth,
    })
}
