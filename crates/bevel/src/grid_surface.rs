//! A flank through a grid of points: least squares of Chebyshev polynomials for the azimuth over the blank, from places
//! and normals. docs/theory/bevel_gears.md, "Flanks from points".

use std::path::Path;

use gearmesh_geometry::InputError;
use nalgebra::{DMatrix, DVector, Vector3};

use crate::azimuth_surface::{AzimuthSurface, PatchPoint, SectionFrame, scale, scaled};
use crate::blank::MemberBlank;
use crate::chebyshev::{ALONG, Chebyshev2, UP, polynomials};
use crate::cut_surface::SurfacePoint;
use crate::hand::FlankSide;
use crate::point_grid::PointGrid;

/// A flank may go on beyond its grid by this share of the grid's size.
const MOST_BEYOND: f64 = 0.25;
/// So far the polynomials are asked at all, for contacts of extended surfaces.
const DEFINED: f64 = 0.6;
/// A normal counts as much as a place that is off by so much of the points' distance.
const NORMAL_LEVER: f64 = 0.25;
/// A point this many times as far off its neighbours' surface as half of the points, and this share of their distance, is a
/// slip.
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
    /// Root mean square of the distance of each point from the surface through all others: what the surface is off between
    /// points \[m\].
    pub left_out_rms_m: f64,
    /// The largest of these, at an end of the grid as a rule; beyond the points the surface may be off by several times as much
    /// \[m\].
    pub left_out_worst_m: f64,
    /// Largest angle between a given normal and the surface's \[rad\].
    pub worst_normal_rad: f64,
    /// How far the flank goes on beyond the grid at toe, heel and tip \[m\].
    pub beyond_m: [f64; 3],
}

/// A flank from points.
#[derive(Debug, Clone, PartialEq)]
pub struct GridSurface {
    surface: AzimuthSurface,
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

/// Points on the blank.
struct Samples {
    surface: AzimuthSurface,
    end: f64,
    beyond_m: [f64; 3],
    at: Vec<[f64; 2]>,
    azimuth_rad: Vec<f64>,
    /// ∂χ/∂s, ∂χ/∂v by the normals.
    slopes: Vec<[f64; 2]>,
    /// Way along the normal for each radian of χ \[m\].
    lever_m: Vec<f64>,
    /// Azimuth of the deviations \[rad\].
    added_rad: Vec<f64>,
    /// Distance of neighbours in s and v.
    spacing: [f64; 2],
}

impl Samples {
    fn new(grid: &PointGrid, blank: &MemberBlank, side: FlankSide) -> Result<Self, InputError> {
        let frame = SectionFrame::of_tooth(blank);
        let (sin, cos) = blank.pitch_angle_rad.sin_cos();
        let facing = side.facing(blank.hand);
        let [sectors, heights] = grid.size;
        let middle = grid.points[(sectors / 2) * heights + heights / 2].r;
        let zero = middle.y.atan2(middle.x);
        let (turn_sin, turn_cos) = (-zero).sin_cos();
        let turned = |v: &Vector3<f64>| {
            Vector3::new(
                v.x * turn_cos - v.y * turn_sin,
                v.x * turn_sin + v.y * turn_cos,
                v.z,
            )
        };
        let mut samples = Self {
            surface: AzimuthSurface {
                frame,
                pitch: [sin, cos],
                facing,
                domain: [[0.0, 1.0]; 2],
                azimuth: Chebyshev2::new([[0.0; UP]; ALONG]),
            },
            end: 0.0,
            beyond_m: [0.0; 3],
            at: Vec::new(),
            azimuth_rad: Vec::new(),
            slopes: Vec::new(),
            lever_m: Vec::new(),
            added_rad: Vec::new(),
            spacing: [0.0; 2],
        };
        let first = grid.points[0].normal;
        let first_around = around(&grid.points[0].r, &first);
        for (i, point) in grid.points.iter().enumerate() {
            let (r, normal) = (turned(&point.r), turned(&point.normal));
            let place = blank.cone_place(r.z, r.x.hypot(r.y));
            let at = frame.at(place);
            if !at.iter().all(|x| (-0.5..=1.5).contains(x)) {
                let problem = format!(
                    "the point lies at cone distance {:.3} mm, {:+.3} mm from the pitch cone, far from the {}'s tooth (cone distance {:.3} to {:.3} mm); \
                     are origin and axis those of the member (apex at 0, z towards the heel)?",
                    1e3 * place[0],
                    1e3 * place[1],
                    blank.name,
                    1e3 * blank.inner_cone_m(),
                    1e3 * blank.outer_cone_m
                );
                return Err(grid.error_at(i, "x_mm", problem));
            }
            let this = around(&r, &normal);
            if this.abs() < 1e-3 || this.signum() != first_around.signum() {
                let problem = "the normal points to the other side than that of the first sector and height; all into the material, or all out of it";
                return Err(grid.error_at(i, "nx", problem.to_owned()));
            }
            let (slopes, lever) =
                AzimuthSurface::slopes_of_normal(&frame, [sin, cos], at, &r, &normal);
            samples.at.push(at);
            samples.azimuth_rad.push(r.y.atan2(r.x));
            samples.slopes.push(slopes);
            samples.lever_m.push(lever.abs());
            // Material that is added moves the flank the way it faces.
            samples
                .added_rad
                .push(facing * point.deviation_m / lever.abs());
        }
        samples.demand_order(grid)?;
        samples.demand_side(grid, blank, side)?;
        samples.demand_cover(grid, blank)?;
        Ok(samples)
    }

    fn number(&self, grid: &PointGrid, sector: usize, height: usize) -> usize {
        sector * grid.size[1] + height
    }

    /// s goes one way along sectors and v one way along heights.
    fn demand_order(&mut self, grid: &PointGrid) -> Result<(), InputError> {
        let [sectors, heights] = grid.size;
        for k in 0..2 {
            let last = [(sectors - 1, 0), (0, heights - 1)][k];
            let whole = self.at[self.number(grid, last.0, last.1)][k] - self.at[0][k];
            self.spacing[k] = whole.abs() / (grid.size[k] - 1) as f64;
            for sector in 0..sectors {
                for height in 0..heights {
                    let next = [(sector + 1, height), (sector, height + 1)][k];
                    if next.0 >= sectors || next.1 >= heights {
                        continue;
                    }
                    let (a, b) = (
                        self.number(grid, sector, height),
                        self.number(grid, next.0, next.1),
                    );
                    let step = (self.at[b][k] - self.at[a][k]) * whole.signum();
                    if step <= 0.1 * self.spacing[k] {
                        let problem = format!(
                            "from sector {}, height {} to here the flank goes back {}; sectors must go one way along the face, heights one way up the flank",
                            sector + 1,
                            height + 1,
                            ["along the face", "down the flank"][k]
                        );
                        return Err(grid.error_at(b, "x_mm", problem));
                    }
                }
            }
        }
        Ok(())
    }

    /// The points are those of this side and hand: a flank that faces counter-clockwise turns back clockwise from root to tip.
    fn demand_side(
        &self,
        grid: &PointGrid,
        blank: &MemberBlank,
        side: FlankSide,
    ) -> Result<(), InputError> {
        let n = self.slopes.len() as f64;
        let mean = [0, 1].map(|k| self.slopes.iter().map(|s| s[k]).sum::<f64>() / n);
        if mean[1] * self.surface.facing >= 0.0 {
            return Err(grid.error(format!(
                "these are not points of the {} flank of a {}-hand {}: the tooth would be thicker at its tip; is it the other flank, or the mirror image?",
                side.word(),
                blank.hand.word(),
                blank.name
            )));
        }
        let turn = mean[0] * blank.hand.sign();
        let along = turn * blank.mean_cone_m * blank.pitch_angle_rad.sin();
        // Zerol and straight teeth lean to neither side.
        if along < -0.1 * blank.face_width_m {
            return Err(grid.error(format!(
                "these points lean to the other side than a {} hand does; is it the mirror image, or z towards the apex?",
                blank.hand.word()
            )));
        }
        Ok(())
    }

    /// The grid reaches over most of the tooth.
    fn demand_cover(&mut self, grid: &PointGrid, blank: &MemberBlank) -> Result<(), InputError> {
        let mut domain = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for at in &self.at {
            for k in 0..2 {
                domain[k][0] = domain[k][0].min(at[k]);
                domain[k][1] = domain[k][1].max(at[k]);
            }
        }
        let size = domain.map(|[low, high]| high - low);
        let beyond = [
            domain[0][0] / size[0],
            (1.0 - domain[0][1]) / size[0],
            (1.0 - domain[1][1]) / size[1],
        ];
        for (share, end) in beyond.into_iter().zip(["toe", "heel", "tip"]) {
            if share > MOST_BEYOND {
                return Err(grid.error(format!(
                    "the {}'s flank goes on beyond the grid at the {end} by {:.0} % of the grid's size, allowed are {:.0} %",
                    blank.name,
                    100.0 * share,
                    100.0 * MOST_BEYOND
                )));
            }
        }
        let depth = self.surface.frame.depth_m(0.5)[0];
        let face = blank.face_width_m;
        self.beyond_m = [
            domain[0][0] * face,
            (1.0 - domain[0][1]) * face,
            (1.0 - domain[1][1]) * depth,
        ]
        .map(|x| x.max(0.0));
        self.end = (domain[1][0] - MOST_BEYOND * size[1]).max(0.0);
        self.surface.domain = domain;
        Ok(())
    }

    /// Rows of the least squares of a point: its place, and its two slopes where normals count. Units: metres along the normal.
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
    fn solve(&self, size: [usize; 2], nominal: bool) -> Option<Trial> {
        let n = size[0] * size[1];
        let used = if nominal { 3 } else { 1 };
        let value = |i: usize| {
            if nominal {
                DVector::from_iterator(3, self.values(i).iter().copied())
            } else {
                DVector::from_element(1, self.lever_m[i] * self.added_rad[i])
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

    /// The numbers of polynomials with which left-out points, places and normals, are missed least, first along the face, then
    /// up the flank. Places alone may by chance be met well by a surface that waves between them.
    fn best(&self, grid: &PointGrid, nominal: bool) -> Option<Trial> {
        let more = if nominal { 2 } else { 0 };
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
                let Some(trial) = self.solve(next, nominal) else {
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
        let Trial {
            size,
            coefficients,
            mut left_out,
            ..
        } = self.best(grid, true).ok_or_else(none)?;
        let mut table = [[0.0; UP]; ALONG];
        let add = |c: &DVector<f64>, [p, q]: [usize; 2], table: &mut [[f64; UP]; ALONG]| {
            for i in 0..p {
                for j in 0..q {
                    table[i][j] += c[i * q + j];
                }
            }
        };
        add(&coefficients, size, &mut table);
        self.surface.azimuth = Chebyshev2::new(table);
        let worst_normal_rad = self.demand_sense(grid, &left_out)?;
        if grid.is_measured {
            let added = self.best(grid, false).ok_or_else(none)?;
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
            end: self.end,
            fit,
        })
    }

    /// Refuses points off the surface of their neighbours and normals that are not the surface's; the largest angle of normals.
    fn demand_sense(&self, grid: &PointGrid, left_out: &[f64]) -> Result<f64, InputError> {
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
        Ok(most)
    }

    /// Unit normal at a point of the surface if its azimuth had these slopes.
    fn normal_with(&self, at: [f64; 2], p: &PatchPoint, slopes: [f64; 2]) -> Vector3<f64> {
        let own = self.surface.azimuth_slopes(at);
        let around = Vector3::new(-p.r.y, p.r.x, 0.0);
        let [a, b] = [0, 1].map(|k| p.dr[k] + around * (slopes[k] - own[k]));
        a.cross(&b).normalize()
    }
}

fn around(r: &Vector3<f64>, normal: &Vector3<f64>) -> f64 {
    (normal.y * r.x - normal.x * r.y) / r.x.hypot(r.y)
}

fn rms(list: &[f64]) -> f64 {
    (list.iter().map(|x| x * x).sum::<f64>() / list.len() as f64).sqrt()
}
