//! A flank through a grid of points: least squares of Chebyshev polynomials for the azimuth over the blank, from places
//! and normals. docs/theory/bevel_gears.md, "Flanks from points".

use std::path::Path;

use gearmesh_geometry::InputError;
use nalgebra::{DMatrix, DVector, Vector3};

use crate::azimuth_surface::{AzimuthSurface, PatchPoint, scale, scaled};
use crate::blank::MemberBlank;
use crate::chebyshev::{ALONG, Chebyshev2, UP, polynomials};
use crate::cut_surface::SurfacePoint;
use crate::grid_samples::Samples;
use crate::hand::FlankSide;
use crate::point_grid::PointGrid;

/// So far the polynomials are asked at all, for contacts of extended surfaces.
const DEFINED: f64 = 0.6;
/// A normal counts as much as a place that is off by so much of the points' distance.
const NORMAL_LEVER: f64 = 0.25;
/// A point this many times as far off its neighbours' surface as half of the points, and this share of their distance,
/// is a slip.
const SLIP: [f64; 2] = [12.0, 0.01];
/// A normal so far off the surface through the points does not belong to them \[rad\].
const MOST_TURNED: f64 = 0.05;

/// How well a surface fits its points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GridFit {
    /// Sectors and heights.
    pub size: [usize; 2],
    /// Polynomials along the face and up the flank.
    pub polynomials: [usize; 2],
    /// Distance of the points from the surface: root mean square and largest \[m\].
    pub rms_m: f64,
    /// Largest \[m\].
    pub worst_m: f64,
    /// Root mean square of the distance of each point from the surface through all others: what the surface is off
    /// between points \[m\].
    pub left_out_rms_m: f64,
    /// The largest of these, at an end of the grid as a rule; beyond the points the surface may be off by several times
    /// as much \[m\].
    pub left_out_worst_m: f64,
    /// Largest angle between a given normal and the surface's \[rad\]; none where the file has no normals.
    pub worst_normal_rad: Option<f64>,
    /// How far the flank goes on beyond the grid at toe, heel and tip \[m\].
    pub beyond_m: [f64; 3],
}

/// A flank from points.
#[derive(Debug, Clone, PartialEq)]
pub struct GridSurface {
    surface: AzimuthSurface,
    /// Azimuth of the surface's +x in the frame of the table \[rad\].
    pub(crate) zero_rad: f64,
    /// v below which there is no flank.
    end: f64,
    /// The fit.
    pub fit: GridFit,
}

impl GridSurface {
    /// Reads a grid and fits the flank of a member.
    ///
    /// # Errors
    /// [`InputError`] with file, line and reason.
    pub fn read(
        path: &Path,
        apex_m: f64,
        blank: &MemberBlank,
        side: FlankSide,
    ) -> Result<Self, InputError> {
        let grid = PointGrid::read(path, apex_m)?;
        Samples::new(&grid, blank, side)?.fit(&grid)
    }

    /// s and v of the mean point.
    pub(crate) fn at(&self, place_m: [f64; 2]) -> [f64; 2] {
        self.surface.frame.at(place_m)
    }

    /// The point at s, v of the whole tooth; none far beyond the grid.
    pub(crate) fn point(&self, at: [f64; 2]) -> Option<SurfacePoint> {
        let xy = scaled(&self.surface.domain, at);
        if !xy.iter().all(|x| x.abs() <= 1.0 + 2.0 * DEFINED) {
            return None;
        }
        let p = self.surface.point(at);
        let [depth, by_s] = self.surface.frame.depth_m(at[0]);
        let above = at[1] - self.end;
        Some(SurfacePoint {
            r: p.r,
            dr: p.dr,
            ddr: p.ddr,
            n: p.n,
            dn: p.dn,
            above_end: above * depth,
            above_end_slopes: [above * by_s, depth],
        })
    }
}

/// A fit with some numbers of polynomials.
struct Trial {
    /// Polynomials along the face and up the flank.
    size: [usize; 2],
    coefficients: DVector<f64>,
    /// Of each point, the distance from the surface through all others \[m\].
    left_out: Vec<f64>,
    /// Root mean square of how far place and normal of each point are missed by the surface through all others \[m\].
    missed_m: f64,
}

/// What the polynomials go through.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Target {
    /// Places and normals.
    Normals,
    /// Places alone.
    Places,
    /// Deviations.
    Added,
}

impl Samples {
    /// Rows of the least squares of a point: its place, and its two slopes where normals count. Units: metres along the
    /// normal.
    fn rows(&self, point: usize, [p, q]: [usize; 2]) -> DMatrix<f64> {
        let [x, y] = scaled(&self.surface.domain, self.at[point]);
        let by = scale(&self.surface.domain);
        let (along, up) = (polynomials::<ALONG>(x), polynomials::<UP>(y));
        let lever = self.lever_m[point];
        let weight = [0, 1].map(|k| lever * NORMAL_LEVER * self.spacing[k]);
        DMatrix::from_fn(3, p * q, |row, column| {
            let (a, b) = (along[column / q], up[column % q]);
            match row {
                0 => lever * a[0] * b[0],
                1 => weight[0] * by[0] * a[1] * b[0],
                _ => weight[1] * by[1] * a[0] * b[1],
            }
        })
    }

    fn values(&self, point: usize) -> Vector3<f64> {
        let lever = self.lever_m[point];
        let slope = |k: usize| lever * NORMAL_LEVER * self.spacing[k] * self.slopes[point][k];
        Vector3::new(lever * self.azimuth_rad[point], slope(0), slope(1))
    }

    /// Least squares with so many polynomials.
    fn solve(&self, size: [usize; 2], target: Target) -> Option<Trial> {
        let n = size[0] * size[1];
        let (used, azimuth_rad) = match target {
            Target::Normals => (3, &self.azimuth_rad),
            Target::Places => (1, &self.azimuth_rad),
            Target::Added => (1, &self.added_rad),
        };
        let value = |i: usize| {
            if target == Target::Normals {
                DVector::from_iterator(3, self.values(i).iter().copied())
            } else {
                DVector::from_element(1, self.lever_m[i] * azimuth_rad[i])
            }
        };
        let (mut matrix, mut right) = (DMatrix::zeros(n, n), DVector::zeros(n));
        let all: Vec<DMatrix<f64>> = (0..self.at.len())
            .map(|i| self.rows(i, size).rows(0, used).into_owned())
            .collect();
        for (i, rows) in all.iter().enumerate() {
            matrix += rows.transpose() * rows;
            right += rows.transpose() * value(i);
        }
        let solved = matrix.cholesky()?;
        let coefficients = solved.solve(&right);
        let left_out = all.iter().enumerate().map(|(i, rows)| {
            let residual = value(i) - rows * &coefficients;
            let hat = rows * solved.solve(&rows.transpose());
            let without = DMatrix::identity(used, used) - hat;
            let off = without.lu().solve(&residual)?;
            Some((off[0].abs(), off.norm()))
        });
        let (left_out, with_normals): (Vec<f64>, Vec<f64>) =
            left_out.collect::<Option<Vec<_>>>()?.into_iter().unzip();
        Some(Trial {
            size,
            coefficients,
            left_out,
            missed_m: rms(&with_normals),
        })
    }

    /// The numbers of polynomials with which left-out points, places and normals, are missed least, first along the
    /// face, then up the flank. Places alone may by chance be met well by a surface that waves between them.
    fn best(&self, grid: &PointGrid, target: Target) -> Option<Trial> {
        let more = if target == Target::Normals { 2 } else { 0 };
        let most = [
            (grid.size[0] + more).min(ALONG),
            (grid.size[1] + more).min(UP),
        ];
        let mut best: Option<Trial> = None;
        let mut size = [3.min(most[0]), 3.min(most[1])];
        for k in [1, 0, 1, 0] {
            for count in 1..=most[k] {
                let mut next = size;
                next[k] = count;
                let Some(trial) = self.solve(next, target) else {
                    continue;
                };
                if best.as_ref().is_none_or(|b| trial.missed_m < b.missed_m) {
                    best = Some(trial);
                }
            }
            size = best.as_ref()?.size;
        }
        best
    }

    fn fit(mut self, grid: &PointGrid) -> Result<GridSurface, InputError> {
        let none = || grid.error("no smooth surface goes through these points".to_owned());
        let mut table = [[0.0; UP]; ALONG];
        let add = |c: &DVector<f64>, [p, q]: [usize; 2], table: &mut [[f64; UP]; ALONG]| {
            for i in 0..p {
                for j in 0..q {
                    table[i][j] += c[i * q + j];
                }
            }
        };
        let target = if grid.has_normals {
            Target::Normals
        } else {
            let rough = self.best(grid, Target::Places).ok_or_else(none)?;
            add(&rough.coefficients, rough.size, &mut table);
            self.surface.azimuth = Chebyshev2::new(table);
            self.take_normals_of_surface(grid);
            table = [[0.0; UP]; ALONG];
            Target::Places
        };
        let Trial {
            size,
            coefficients,
            mut left_out,
            ..
        } = self.best(grid, target).ok_or_else(none)?;
        add(&coefficients, size, &mut table);
        self.surface.azimuth = Chebyshev2::new(table);
        let worst_normal_rad = self.demand_sense(grid, &left_out)?;
        if grid.is_measured {
            let added = self.best(grid, Target::Added).ok_or_else(none)?;
            add(&added.coefficients, added.size, &mut table);
            self.surface.azimuth = Chebyshev2::new(table);
            for (a, b) in left_out.iter_mut().zip(added.left_out) {
                *a = a.hypot(b);
            }
        }
        let off: Vec<f64> = (0..self.at.len())
            .map(|i| {
                let found = self.surface.azimuth_rad(self.at[i]);
                self.lever_m[i] * (found - self.azimuth_rad[i] - self.added_rad[i]).abs()
            })
            .collect();
        let fit = GridFit {
            size: grid.size,
            polynomials: size,
            rms_m: rms(&off),
            worst_m: off.iter().copied().fold(0.0, f64::max),
            left_out_rms_m: rms(&left_out),
            left_out_worst_m: left_out.iter().copied().fold(0.0, f64::max),
            worst_normal_rad,
            beyond_m: self.beyond_m,
        };
        Ok(GridSurface {
            surface: self.surface,
            zero_rad: self.zero_rad,
            end: self.end,
            fit,
        })
    }

    /// Refuses points off the surface of their neighbours and normals that are not the surface's; the largest angle of
    /// normals.
    fn demand_sense(&self, grid: &PointGrid, left_out: &[f64]) -> Result<Option<f64>, InputError> {
        let mut sorted = left_out.to_vec();
        sorted.sort_by(f64::total_cmp);
        let usual = sorted[sorted.len() / 2];
        let face = self.surface.frame.cones_m;
        let spacing = self.spacing[0] * (face[1] - face[0]);
        let worst = (0..left_out.len()).max_by(|a, b| left_out[*a].total_cmp(&left_out[*b]));
        if let Some(i) = worst
            && left_out[i] > SLIP[0] * usual
            && left_out[i] > SLIP[1] * spacing
        {
            let problem = format!(
                "the point lies {:.4} mm off the surface through all others, half of which are within {:.4} mm; a slip?",
                1e3 * left_out[i],
                1e3 * usual
            );
            return Err(grid.error_at(i, "x_mm", problem));
        }
        if !grid.has_normals {
            return Ok(None);
        }
        let mut most = 0.0f64;
        for (i, at) in self.at.iter().enumerate() {
            let p = self.surface.point(*at);
            let given = self.normal_with(*at, &p, self.slopes[i]);
            let angle = given.cross(&p.n).norm().atan2(given.dot(&p.n).abs());
            if angle > MOST_TURNED {
                let problem = format!(
                    "the normal is {:.2} degrees off that of the surface through the points, allowed are {:.2}",
                    angle.to_degrees(),
                    MOST_TURNED.to_degrees()
                );
                return Err(grid.error_at(i, "nx", problem));
            }
            most = most.max(angle);
        }
        Ok(Some(most))
    }

    /// Unit normal at a point of the surface if its azimuth had these slopes.
    fn normal_with(&self, at: [f64; 2], p: &PatchPoint, slopes: [f64; 2]) -> Vector3<f64> {
        let own = self.surface.azimuth_slopes(at);
        let around = Vector3::new(-p.r.y, p.r.x, 0.0);
        let [a, b] = [0, 1].map(|k| p.dr[k] + around * (slopes[k] - own[k]));
        a.cross(&b).normalize()
    }
}

fn rms(list: &[f64]) -> f64 {
    (list.iter().map(|x| x * x).sum::<f64>() / list.len() as f64).sqrt()
}
