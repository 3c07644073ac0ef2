//! Points of a grid on the blank: their places in s and v, azimuths and slopes, and whether they are those of this
//! flank.

use gearmesh_geometry::InputError;
use nalgebra::Vector3;

use crate::azimuth_surface::{AzimuthSurface, SectionFrame};
use crate::blank::MemberBlank;
use crate::chebyshev::{ALONG, Chebyshev2, UP};
use crate::hand::FlankSide;
use crate::point_grid::PointGrid;

/// A flank may go on beyond its grid by this share of the grid's size.
const MOST_BEYOND: f64 = 0.25;
/// Points may lie beyond the blank by this share of the face and of the depth: blanks are rounded, edges have radii.
const MOST_OFF: f64 = 0.05;

/// Points on the blank.
pub(crate) struct Samples {
    pub surface: AzimuthSurface,
    pub end: f64,
    pub beyond_m: [f64; 3],
    pub at: Vec<[f64; 2]>,
    pub azimuth_rad: Vec<f64>,
    /// ∂χ/∂s, ∂χ/∂v by the normals.
    pub slopes: Vec<[f64; 2]>,
    /// Way along the normal for each radian of χ \[m\].
    pub lever_m: Vec<f64>,
    /// Azimuth of the deviations \[rad\].
    pub added_rad: Vec<f64>,
    /// Distance of neighbours in s and v.
    pub spacing: [f64; 2],
    /// Azimuth of the surface's own +x in the frame of the table \[rad\].
    pub zero_rad: f64,
    /// Places of the points in the frame of the surface \[m\].
    places: Vec<Vector3<f64>>,
}

impl Samples {
    pub fn new(grid: &PointGrid, blank: &MemberBlank, side: FlankSide) -> Result<Self, InputError> {
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
            zero_rad: zero,
            places: Vec::new(),
        };
        let first = grid.points[0].normal;
        let first_around = around(&grid.points[0].r, &first);
        for (i, point) in grid.points.iter().enumerate() {
            let (r, normal) = (turned(&point.r), turned(&point.normal));
            let place = blank.cone_place(r.z, r.x.hypot(r.y));
            let at = frame.at(place);
            demand_on_tooth(grid, i, blank, at, place)?;
            let this = around(&r, &normal);
            if this.abs() < 1e-3 || this.signum() != first_around.signum() {
                return Err(if grid.has_normals {
                    let problem = "the normal points to the other side than that of the first sector and height; all into the material, or all out of it";
                    grid.error_at(i, "nx", problem.to_owned())
                } else {
                    let problem = "neighbours of this point do not go on as sectors along the face and heights up the flank; no normal can be made of them";
                    grid.error_at(i, "x_mm", problem.to_owned())
                });
            }
            let (slopes, lever) =
                AzimuthSurface::slopes_of_normal(&frame, [sin, cos], at, &r, &normal);
            samples.at.push(at);
            samples.places.push(r);
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

    /// The points are those of this side and hand: a flank that faces counter-clockwise turns back clockwise from root
    /// to tip.
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

    /// Puts the normals of the fitted surface in place of those that were made of neighbouring points.
    pub fn take_normals_of_surface(&mut self, grid: &PointGrid) {
        for i in 0..self.at.len() {
            let normal = self.surface.point(self.at[i]).n;
            let (frame, pitch) = (&self.surface.frame, self.surface.pitch);
            let (slopes, lever) = AzimuthSurface::slopes_of_normal(
                frame,
                pitch,
                self.at[i],
                &self.places[i],
                &normal,
            );
            self.slopes[i] = slopes;
            self.lever_m[i] = lever.abs();
            self.added_rad[i] = self.surface.facing * grid.points[i].deviation_m / lever.abs();
        }
    }
}

/// A point of the flank lies on the tooth.
fn demand_on_tooth(
    grid: &PointGrid,
    point: usize,
    blank: &MemberBlank,
    [s, v]: [f64; 2],
    place_m: [f64; 2],
) -> Result<(), InputError> {
    let face = blank.face_width_m;
    let [tip, root] = [blank.addendum_m(place_m[0]), blank.dedendum_m(place_m[0])];
    let off = |share: f64, size: f64| share.max(0.0) * size;
    let ends = [
        ("the toe", off(-s, face), off(-s, 1.0)),
        ("the heel", off(s - 1.0, face), off(s - 1.0, 1.0)),
        ("the tip cone", place_m[1] - tip, off(v - 1.0, 1.0)),
        ("the root cone", -root - place_m[1], off(-v, 1.0)),
    ];
    let Some((end, off_m, _)) = ends.into_iter().find(|(_, _, share)| *share > MOST_OFF) else {
        return Ok(());
    };
    Err(grid.error_at(
        point,
        "x_mm",
        format!(
            "the point lies {:.3} mm beyond {end} of the {}'s tooth, at cone distance {:.3} mm, {:+.3} mm from the pitch cone (the tooth: cone distance {:.3} to {:.3} mm, there \
             {:+.3} to {:+.3} mm); are origin and axis those of the member (pitch apex at 0, z towards the heel)? points_origin_mm is where the table's origin lies on the axis",
            1e3 * off_m,
            blank.name,
            1e3 * place_m[0],
            1e3 * place_m[1],
            1e3 * blank.inner_cone_m(),
            1e3 * blank.outer_cone_m,
            -1e3 * root,
            1e3 * tip
        ),
    ))
}

fn around(r: &Vector3<f64>, normal: &Vector3<f64>) -> f64 {
    (normal.y * r.x - normal.x * r.y) / r.x.hypot(r.y)
}
