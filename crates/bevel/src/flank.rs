//! One flank of a member: a surface with its place on the blank.

use nalgebra::{Matrix2, Vector2, Vector3};

use crate::blank::MemberBlank;
use crate::cut_surface::{CutSurface, SurfacePoint};
use crate::error::BevelError;
use crate::grid_surface::{GridFit, GridSurface};
use crate::hand::FlankSide;
use crate::settings::{MachineSettings, Tool};

/// A flank, turned about the member's axis such that its mean point (mean cone distance, on the pitch cone) lies in
/// the x-z plane, x > 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Flank {
    /// The member's blank.
    pub blank: MemberBlank,
    /// Side of the tooth.
    pub side: FlankSide,
    surface: FlankSurface,
    /// Sine and cosine of the turn from the surface's own frame.
    turn: [f64; 2],
    mean: Located,
}

/// What the flank is.
#[derive(Debug, Clone, PartialEq)]
enum FlankSurface {
    /// What a tool leaves.
    Cut(CutSurface),
    /// Through points.
    Points(Box<GridSurface>),
}

/// A point of a flank and its parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Located {
    /// Parameters a, b of the surface.
    pub at: [f64; 2],
    /// The point.
    pub point: SurfacePoint,
}

/// Which surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Sheet {
    Flank,
    Fillet,
}

/// What is asked beside the cone distance: the height, or the distance from the end of the surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Row {
    Height,
    End,
}

/// Newton steps for a place of a flank.
const MOST_STEPS: usize = 40;
/// Parts into which the way to a place is cut at most.
const MOST_PARTS: usize = 32;

impl Flank {
    /// The flank that a machine cuts.
    ///
    /// # Errors
    /// [`BevelError::NoFlankPoint`] where the tool does not reach the mean point.
    pub fn cut(
        blank: &MemberBlank,
        side: FlankSide,
        settings: &MachineSettings,
    ) -> Result<Self, BevelError> {
        let surface = CutSurface {
            settings: *settings,
            side,
        };
        Self::new(blank, side, FlankSurface::Cut(surface))
    }

    /// The flank through a grid of points.
    ///
    /// # Errors
    /// [`BevelError::NoFlankPoint`] where the grid is not one of this blank.
    pub fn through(
        blank: &MemberBlank,
        side: FlankSide,
        surface: GridSurface,
    ) -> Result<Self, BevelError> {
        Self::new(blank, side, FlankSurface::Points(Box::new(surface)))
    }

    fn new(
        blank: &MemberBlank,
        side: FlankSide,
        surface: FlankSurface,
    ) -> Result<Self, BevelError> {
        let mut flank = Self {
            blank: blank.clone(),
            side,
            surface,
            turn: [0.0, 1.0],
            mean: Located {
                at: [0.0; 2],
                point: NOWHERE,
            },
        };
        let start = flank.first_guess();
        flank.mean = flank
            .newton(Sheet::Flank, Row::Height, [blank.mean_cone_m, 0.0], start)
            .ok_or_else(|| flank.no_point([blank.mean_cone_m, 0.0]))?;
        let r = flank.mean.point.r;
        let size = r.x.hypot(r.y);
        flank.turn = [-r.y / size, r.x / size];
        flank.mean.point = flank.turned(flank.mean.point);
        Ok(flank)
    }

    /// Member and side, for messages.
    pub fn name(&self) -> String {
        format!("{}'s {}", self.blank.name, self.side.word())
    }

    /// The surface in the frame of the machine's start; none for a flank from points.
    pub fn cut_surface(&self) -> Option<&CutSurface> {
        match &self.surface {
            FlankSurface::Cut(surface) => Some(surface),
            FlankSurface::Points(_) => None,
        }
    }

    /// How well the surface fits its points; none for a flank that was cut.
    pub fn grid_fit(&self) -> Option<&GridFit> {
        match &self.surface {
            FlankSurface::Cut(_) => None,
            FlankSurface::Points(surface) => Some(&surface.fit),
        }
    }

    /// Azimuth of the mean point in the frame of the flank's table of points \[rad\]; none for a flank that was cut.
    pub fn table_azimuth_rad(&self) -> Option<f64> {
        match &self.surface {
            FlankSurface::Cut(_) => None,
            FlankSurface::Points(surface) => Some(surface.zero_rad - self.turn_rad()),
        }
    }

    /// A point in the surface's own frame.
    fn own(&self, sheet: Sheet, at: [f64; 2]) -> Option<SurfacePoint> {
        match (&self.surface, sheet) {
            (FlankSurface::Cut(surface), Sheet::Flank) => surface.flank(at[0], at[1]),
            (FlankSurface::Cut(surface), Sheet::Fillet) => surface.fillet(at[0], at[1]),
            (FlankSurface::Points(surface), Sheet::Flank) => surface.point(at),
            (FlankSurface::Points(_), Sheet::Fillet) => None,
        }
    }

    /// The mean point.
    pub fn mean(&self) -> &Located {
        &self.mean
    }

    /// The turn about z that brings the mean point from the machine's start onto +x \[rad\].
    pub fn turn_rad(&self) -> f64 {
        self.turn[0].atan2(self.turn[1])
    }

    /// Unit tangents of the flank at one of its points, in the member's frame: along the tooth towards the heel (on
    /// the cone with the pitch angle), and
    /// up the profile towards the tip.
    pub fn directions(&self, p: &SurfacePoint) -> [Vector3<f64>; 2] {
        let [generator, up] = self.blank.directions(&p.r);
        let along = p.n.cross(&up).normalize();
        let along = along * along.dot(&generator).signum();
        let profile = p.n.cross(&along);
        [along, profile * profile.dot(&up).signum()]
    }

    fn turned(&self, mut p: SurfacePoint) -> SurfacePoint {
        let [s, c] = self.turn;
        let turn =
            |v: &mut Vector3<f64>| *v = Vector3::new(v.x * c - v.y * s, v.x * s + v.y * c, v.z);
        turn(&mut p.r);
        turn(&mut p.n);
        p.dr.iter_mut().for_each(turn);
        p.dn.iter_mut().for_each(turn);
        p.ddr.iter_mut().for_each(turn);
        p
    }

    /// The surface at parameters, also beyond the blank. None where there is no surface.
    pub fn point(&self, at: [f64; 2]) -> Option<SurfacePoint> {
        self.own(Sheet::Flank, at).map(|p| self.turned(p))
    }

    /// The fillet at parameters of the flank; none for a flank from points.
    pub fn fillet(&self, at: [f64; 2]) -> Option<SurfacePoint> {
        self.own(Sheet::Fillet, at).map(|p| self.turned(p))
    }

    /// Cone distance L and height h above the pitch cone of a point \[m\].
    pub fn place(&self, r: &Vector3<f64>) -> [f64; 2] {
        self.blank.cone_place(r.z, r.x.hypot(r.y))
    }

    /// ∂(L, h)/∂(a, b).
    pub fn place_slopes(&self, p: &SurfacePoint) -> Matrix2<f64> {
        let radius = p.r.x.hypot(p.r.y);
        let column = |d: &Vector3<f64>| {
            self.blank
                .cone_place(d.z, (p.r.x * d.x + p.r.y * d.y) / radius)
        };
        let [a, b] = [column(&p.dr[0]), column(&p.dr[1])];
        Matrix2::new(a[0], b[0], a[1], b[1])
    }

    /// Lower end of the flank at a cone distance, where the fillet begins.
    ///
    /// # Errors
    /// [`BevelError::NoFlankPoint`] where the flank ends above.
    pub fn bottom(&self, cone_m: f64) -> Result<Located, BevelError> {
        let pitch = self.locate(cone_m, 0.0)?;
        let height = -self.blank.dedendum_m(cone_m);
        self.march(Sheet::Flank, Row::End, [cone_m, 0.0], &pitch)
            .ok_or_else(|| self.no_point([cone_m, height]))
    }

    /// Lower end of the fillet at a cone distance, where the root's bottom begins; that of the flank where the tool
    /// has no edge, or the flank is one from points.
    ///
    /// # Errors
    /// As [`Self::bottom`].
    pub fn root(&self, cone_m: f64) -> Result<Located, BevelError> {
        let bottom = self.bottom(cone_m)?;
        let milled = |cut: &CutSurface| cut.settings.face_mill().is_some();
        if !self.cut_surface().is_some_and(milled) {
            return Ok(bottom);
        }
        let height = -self.blank.dedendum_m(cone_m);
        let begin = self.fillet(bottom.at).map(|point| Located {
            at: bottom.at,
            point,
        });
        begin
            .and_then(|begin| self.march(Sheet::Fillet, Row::End, [cone_m, 0.0], &begin))
            .ok_or_else(|| self.no_point([cone_m, height]))
    }

    /// Points of the fillet at a cone distance, from where the flank begins (share 1) downwards (0 the lower end):
    /// `shares` fall.
    ///
    /// # Errors
    /// As [`Self::bottom`].
    pub fn fillet_line(&self, cone_m: f64, shares: &[f64]) -> Result<Vec<Located>, BevelError> {
        let bottom = self.bottom(cone_m)?;
        let lost = || self.no_point([cone_m, -self.blank.dedendum_m(cone_m)]);
        let point = self.fillet(bottom.at).ok_or_else(lost)?;
        let whole = point.above_end;
        let mut here = Located {
            at: bottom.at,
            point,
        };
        shares
            .iter()
            .map(|share| {
                let target = [cone_m, share * whole];
                here = self
                    .march(Sheet::Fillet, Row::End, target, &here)
                    .ok_or_else(lost)?;
                Ok(here)
            })
            .collect()
    }

    /// Whether a point lies on the flank: between toe and heel, below the tip, above the fillet.
    pub fn holds(&self, p: &SurfacePoint) -> bool {
        let [cone, height] = self.place(&p.r);
        let slack = 1e-9 * self.blank.mean_cone_m;
        cone >= self.blank.inner_cone_m() - slack
            && cone <= self.blank.outer_cone_m + slack
            && height <= self.blank.addendum_m(cone) + slack
            && height >= -self.blank.dedendum_m(cone)
            && p.above_end >= -slack
    }

    /// The point at a cone distance and a height above the pitch cone.
    ///
    /// # Errors
    /// [`BevelError::NoFlankPoint`] where the surface does not reach there.
    pub fn locate(&self, cone_m: f64, height_m: f64) -> Result<Located, BevelError> {
        self.locate_from(cone_m, height_m, &self.mean)
    }

    /// As [`Self::locate`], from a point nearby.
    ///
    /// # Errors
    /// As [`Self::locate`].
    pub fn locate_from(
        &self,
        cone_m: f64,
        height_m: f64,
        start: &Located,
    ) -> Result<Located, BevelError> {
        let target = [cone_m, height_m];
        self.march(Sheet::Flank, Row::Height, target, start)
            .ok_or_else(|| self.no_point(target))
    }

    /// Newton from a point nearby, in smaller and smaller parts of the way where it fails.
    fn march(&self, sheet: Sheet, row: Row, target: [f64; 2], start: &Located) -> Option<Located> {
        let from = self.coordinates(row, &start.point);
        let mut parts = 1;
        while parts <= MOST_PARTS {
            let mut here = Some(start.at);
            let mut found = None;
            for k in 1..=parts {
                let share = k as f64 / parts as f64;
                let step = [0, 1].map(|i| from[i] + share * (target[i] - from[i]));
                found = here.and_then(|at| self.newton(sheet, row, step, at));
                here = found.as_ref().map(|f| f.at);
            }
            if let Some(found) = found {
                return Some(Located {
                    at: found.at,
                    point: self.turned(found.point),
                });
            }
            parts *= 2;
        }
        None
    }

    /// Cone distance, and height or distance from the surface's end.
    fn coordinates(&self, row: Row, p: &SurfacePoint) -> [f64; 2] {
        let [cone, height] = self.place(&p.r);
        match row {
            Row::Height => [cone, height],
            Row::End => [cone, p.above_end],
        }
    }

    fn no_point(&self, [cone, height]: [f64; 2]) -> BevelError {
        BevelError::NoFlankPoint {
            flank: self.name(),
            cone_mm: 1e3 * cone,
            height_mm: 1e3 * height,
        }
    }

    /// Parameters near the mean point: cradle at 0, blade from the cutter's centre towards the mean point.
    fn first_guess(&self) -> [f64; 2] {
        let mean = self.blank.mean_cone_m;
        let s = match &self.surface {
            FlankSurface::Cut(surface) => &surface.settings,
            FlankSurface::Points(surface) => return surface.at([mean, 0.0]),
        };
        let along = mean * (self.blank.pitch_angle_rad - s.root_angle_rad).cos()
            + s.work_offset_m * s.root_angle_rad.cos();
        match s.tool {
            Tool::Plane { .. } => [mean, 0.0],
            Tool::FaceMill(mill) => {
                let (sin, cos) = mill.cradle_angle_rad.sin_cos();
                let azimuth = (s.offset_m - mill.radial_m * sin).atan2(along - mill.radial_m * cos);
                let up = self.blank.dedendum_m(mean) / mill.blade_angle_rad.cos();
                [azimuth, if s.roll.is_some() { 0.0 } else { up }]
            }
        }
    }

    /// Damped Newton for a place, in the surface's own frame.
    fn newton(&self, sheet: Sheet, row: Row, target: [f64; 2], start: [f64; 2]) -> Option<Located> {
        let surface = |at: [f64; 2]| self.own(sheet, at);
        let miss = |p: &SurfacePoint| {
            let [cone, second] = self.coordinates(row, p);
            Vector2::new(cone - target[0], second - target[1])
        };
        let mut at = start;
        let mut point = surface(at)?;
        let mut error = miss(&point);
        let close = 1e-14 * self.blank.mean_cone_m;
        for _ in 0..MOST_STEPS {
            if error.norm() <= close {
                return Some(Located { at, point });
            }
            let mut slopes = self.place_slopes(&point);
            if row == Row::End {
                let [a, b] = point.above_end_slopes;
                slopes.set_row(1, &nalgebra::RowVector2::new(a, b));
            }
            let step = slopes.lu().solve(&error)?;
            let mut share = 1.0;
            loop {
                let next = [at[0] - share * step.x, at[1] - share * step.y];
                let tried = surface(next).map(|p| (miss(&p), p));
                match tried {
                    Some((smaller, p)) if smaller.norm() < error.norm() => {
                        (at, point, error) = (next, p, smaller);
                        break;
                    }
                    // Rounding keeps the last digits from falling.
                    _ if error.norm() <= 100.0 * close => return Some(Located { at, point }),
                    _ if share < 1e-3 => return None,
                    _ => share *= 0.5,
                }
            }
        }
        None
    }
}

/// Spiral angle at a point: that of the flank's trace on the cone through it, against the cone's generator; positive
/// for a right hand \[rad\].
pub fn spiral_angle_rad(flank: &Flank, located: &Located) -> f64 {
    let [generator, up] = flank.blank.directions(&located.point.r);
    let [trace, _] = flank.directions(&located.point);
    let around = generator.cross(&up);
    trace.dot(&around).atan2(trace.dot(&generator))
}

/// Normal pressure angle at a point: of the normal against the cone through it \[rad\].
pub fn pressure_angle_rad(flank: &Flank, located: &Located) -> f64 {
    let [_, up] = flank.blank.directions(&located.point.r);
    (-located.point.n.dot(&up)).clamp(-1.0, 1.0).asin()
}

/// Stands until the mean point is known.
const NOWHERE: SurfacePoint = SurfacePoint {
    r: Vector3::new(0.0, 0.0, 0.0),
    dr: [Vector3::new(0.0, 0.0, 0.0); 2],
    ddr: [Vector3::new(0.0, 0.0, 0.0); 3],
    n: Vector3::new(0.0, 0.0, 0.0),
    dn: [Vector3::new(0.0, 0.0, 0.0); 2],
    above_end: 0.0,
    above_end_slopes: [0.0; 2],
};
