//! Flanks of gear 1 divided into triangles or quadrilaterals: how deep they stand in gear 2's, whatever their number.
//!
//! Every place x of a facet that gear 2's flank covers by h = (x − p₂)·n₂ > 0, p₂ the foot of x on it, stores ½h² on a
//! unit of area, as an elastic foundation does. With W the integral over all facets, the approach of a pair of teeth is
//! that of the paraboloid that would store the same,
//!
//! ```text
//! δ³ = C W,   C = 3 √(ρ₁ρ₂)/π,   3 ∂δ/δ = ∂W/W + ∂(ln C)
//! ∂W = −∫ h G dA,   G = (n₂, a × n₂),   a = x − u
//! ```
//!
//! with the principal relative curvatures ρ where the smooth flanks are nearest. There is one force for a pair of
//! teeth, K δ^1.5, with a potential; a sum of such forces over facets would grow with their number. Facets end at the
//! toe, the heel and the tip of gear 1; those of gear 2 end what counts over the width of a facet.
//! docs/theory/bevel_gears.md, "Flanks as facets".

use std::f64::consts::PI;

use gearmesh_bevel::{FlankPatch, PatchPoint};
use nalgebra::{Matrix2, Matrix2x6, Matrix3, Matrix3x6, Vector2, Vector3};

use super::hertz_stiffness::{bounded, local_measure};
use super::nearest_points::{Nearest, Placed};
use super::pose_derivatives::PoseDerivatives;
use crate::error::DrivetrainError;
use crate::pose::{Vector6, stacked};
use crate::slice_plane::Matrix6;

/// Most facets of a flank: 50 MB.
const MOST_FACETS: f64 = 2e5;
/// Least facets along the face and up the flank.
const LEAST_FACETS: f64 = 8.0;
/// Gear 2's flank ends over so many facets of gear 1's.
const FADE: f64 = 1.0;
/// Newton's steps to a foot, and the step that ends them, flanks being 1 long: what is left is of the order of its
/// square.
const MOST_STEPS: usize = 12;
const CLOSE: f64 = 1e-6;
/// Gauss's places of two points between 0 and 1.
const GAUSS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];

/// What a flank is divided into.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FacetKind {
    /// Plane triangles, two in a cell of the grid, three points each.
    Triangles,
    /// Quadrilaterals, bilinear between their corners, two by two points each.
    Quadrilaterals,
}

/// How a flank is divided.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FacetSize {
    /// Into what.
    pub kind: FacetKind,
    /// Longest edge along the face \[m\].
    pub along_m: f64,
    /// Longest edge up the flank \[m\].
    pub up_m: f64,
}

/// A place at which covering is measured, tooth 0 of gear 1.
#[derive(Debug, Clone, Copy)]
struct Place {
    r: Vector3<f64>,
    area_m2: f64,
}

/// A flank of gear 1 as facets.
#[derive(Debug, Clone)]
pub(super) struct Facets {
    /// Cell by cell, up the flank first.
    places: Vec<Place>,
    per_cell: usize,
    /// Cells along the face and up the flank.
    cells: [usize; 2],
    /// Over which shares of its face and flank gear 2 ends.
    fade: [f64; 2],
}

/// How deep a pair of teeth overlaps.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sunk {
    /// Below zero \[m\].
    pub gap_m: f64,
    /// Derivative of the gap by the increments of the pose.
    pub gradient: Vector6,
    /// The second one; what the change of ln C has of it is left out.
    pub curvature: Matrix6,
}

/// Integrals over what is covered.
struct Stored {
    /// Axes of space from those of the facets.
    axes: Matrix3<f64>,
    energy: f64,
    by_pose: Vector6,
    by_both: Matrix6,
}

impl Facets {
    /// Divides the flank of gear 1 that faces that of gear 2.
    ///
    /// # Errors
    /// [`DrivetrainError::Value`] where an edge is not positive, longer than an eighth of the flank, or so short that
    /// there would be more than two hundred thousand facets.
    pub(super) fn new(
        [own, mate]: &[FlankPatch; 2],
        size: FacetSize,
    ) -> Result<Self, DrivetrainError> {
        let lengths = |patch: &FlankPatch| {
            let corner = |s: f64, v: f64| patch.point([s, v]).r;
            let along = (corner(1.0, 1.0) - corner(0.0, 1.0)).norm();
            let up = [0.0, 1.0].map(|s| (corner(s, 1.0) - corner(s, 0.0)).norm());
            [along, up[0].max(up[1])]
        };
        let (lengths_m, of_mate_m) = (lengths(own), lengths(mate));
        let edges = [size.along_m, size.up_m];
        let counts = [0, 1].map(|k: usize| lengths_m[k] / edges[k]);
        let facets_per_cell = match size.kind {
            FacetKind::Triangles => 2.0,
            FacetKind::Quadrilaterals => 1.0,
        };
        let few = facets_per_cell * counts[0] * counts[1] <= MOST_FACETS;
        let allowed = "positive, at most an eighth of the flank, and long enough for two hundred thousand facets on a flank";
        let parts = (counts, LEAST_FACETS, few);
        DrivetrainError::check_edges("facets of a bevel flank", edges, parts, allowed)?;
        let cells = counts.map(|count| count.ceil() as usize);
        let steps = cells.map(|count| 1.0 / count as f64);
        let [along, up] = cells;
        let mut corners = Vec::with_capacity((along + 1) * (up + 1));
        for i in 0..=along {
            for k in 0..=up {
                corners.push(corner(
                    own,
                    [steps[0] * i as f64, steps[1] * k as f64],
                    steps,
                ));
            }
        }
        let per_cell = match size.kind {
            FacetKind::Triangles => 6,
            FacetKind::Quadrilaterals => 4,
        };
        let mut places = Vec::with_capacity(along * up * per_cell);
        for i in 0..along {
            for k in 0..up {
                let number = i * (up + 1) + k;
                let [a, b] = [corners[number], corners[number + 1]];
                let [c, d] = [corners[number + up + 1], corners[number + up + 2]];
                match size.kind {
                    // Diagonals by turns, so that none of the two directions is preferred.
                    FacetKind::Triangles if (i + k).is_multiple_of(2) => {
                        places.extend(triangle([a, b, d]));
                        places.extend(triangle([a, d, c]));
                    }
                    FacetKind::Triangles => {
                        places.extend(triangle([a, b, c]));
                        places.extend(triangle([b, d, c]));
                    }
                    FacetKind::Quadrilaterals => places.extend(quadrilateral([a, b, c, d])),
                }
            }
        }
        Ok(Self {
            places,
            per_cell,
            cells,
            fade: [0, 1].map(|k: usize| FADE * edges[k] / of_mate_m[k]),
        })
    }

    /// Gap of a pair of teeth whose smooth flanks overlap; none where no place is covered.
    pub(super) fn sunk(
        &self,
        bodies: &[Placed<'_>; 2],
        point: &Nearest,
        motion: &PoseDerivatives,
    ) -> Option<Sunk> {
        let stored = self.stored(bodies, point);
        if stored.energy <= 0.0 {
            return None;
        }
        let ln_c = |relative: &gearmesh_contact::RelativeCurvature| {
            let [least, largest] = bounded(relative);
            (least * largest).sqrt()
        };
        let (root, by_pose) = local_measure(bodies, point, motion, ln_c);
        let c = 3.0 * root / PI;
        let depth = (c * stored.energy).cbrt();
        let of_energy = stored.by_pose / stored.energy;
        let by_depth = (of_energy + by_pose) * (depth / 3.0);
        let by_both = by_depth * by_depth.transpose() / depth
            + (stored.by_both / stored.energy - of_energy * of_energy.transpose()) * (depth / 3.0);
        Some(Sunk {
            gap_m: -depth,
            gradient: -by_depth,
            curvature: -by_both,
        })
    }

    /// Integrals over the cells around the nearest point: a rectangle of them grows until its borders are covered
    /// nowhere.
    fn stored(&self, bodies: &[Placed<'_>; 2], point: &Nearest) -> Stored {
        let mut sum = Stored {
            axes: bodies[0].rotation(),
            energy: 0.0,
            by_pose: Vector6::zeros(),
            by_both: Matrix6::zeros(),
        };
        let mut foot = point.at[1];
        let start = [0, 1].map(|k: usize| {
            let cell = (point.at[0][k] * self.cells[k] as f64).floor();
            cell.clamp(0.0, self.cells[k] as f64 - 1.0) as usize
        });
        let mut low = start.map(|cell| cell.saturating_sub(1));
        let mut high = [0, 1].map(|k: usize| (start[k] + 2).min(self.cells[k]));
        let cells = [0, 1].map(|k: usize| [low[k], high[k]]);
        self.add(bodies, cells, &mut foot, &mut sum);
        loop {
            let mut grown = false;
            for (k, up) in [(0, false), (0, true), (1, false), (1, true)] {
                let next = if up {
                    (high[k] < self.cells[k]).then_some(high[k])
                } else {
                    low[k].checked_sub(1)
                };
                let Some(next) = next else { continue };
                let mut strip = [0, 1].map(|k: usize| [low[k], high[k]]);
                strip[k] = [next, next + 1];
                if self.add(bodies, strip, &mut foot, &mut sum) {
                    (low[k], high[k]) = (low[k].min(next), high[k].max(next + 1));
                    grown = true;
                }
            }
            if !grown {
                return sum;
            }
        }
    }

    /// Adds what is covered in cells from the first to before the second number along the face and up the flank;
    /// whether anything is.
    fn add(
        &self,
        bodies: &[Placed<'_>; 2],
        [along, up]: [[usize; 2]; 2],
        foot: &mut [f64; 2],
        sum: &mut Stored,
    ) -> bool {
        let mut covered = false;
        for i in along[0]..along[1] {
            for k in up[0]..up[1] {
                let first = (i * self.cells[1] + k) * self.per_cell;
                for place in &self.places[first..first + self.per_cell] {
                    covered |= self.add_place(bodies, place, foot, sum);
                }
            }
        }
        covered
    }

    fn add_place(
        &self,
        bodies: &[Placed<'_>; 2],
        place: &Place,
        start: &mut [f64; 2],
        sum: &mut Stored,
    ) -> bool {
        let x = sum.axes * place.r;
        let Some((at, foot)) = foot_of(&bodies[1], &x, *start) else {
            return false;
        };
        *start = at;
        let h = (x - foot.r).dot(&foot.n);
        let ends = self.ends(at);
        if h <= 0.0 || ends.0 <= 0.0 {
            return false;
        }
        let arm = x - bodies[1].origin_m;
        let gradient = stacked(foot.n, arm.cross(&foot.n));
        // How the foot walks over gear 2 as that moves: p_k·dx of the place against it.
        let walks = walks(&foot, &x, &arm);
        let mut turned = Matrix3x6::zeros();
        turned
            .fixed_columns_mut::<3>(3)
            .copy_from(&-foot.n.cross_matrix());
        for k in 0..2 {
            turned += foot.dn[k] * walks.row(k);
        }
        let mut arm_by_pose = Matrix3x6::zeros();
        arm_by_pose.fixed_columns_mut::<3>(0).fill_with_identity();
        arm_by_pose.neg_mut();
        let moment = arm.cross_matrix() * turned - foot.n.cross_matrix() * arm_by_pose;
        let mut curvature = Matrix6::zeros();
        curvature.fixed_rows_mut::<3>(0).copy_from(&turned);
        curvature.fixed_rows_mut::<3>(3).copy_from(&moment);
        let area = place.area_m2 * ends.0;
        let ends_by_pose =
            (walks.row(0) * ends.1[0] + walks.row(1) * ends.1[1]).transpose() * place.area_m2;
        sum.energy += 0.5 * area * h * h;
        sum.by_pose += ends_by_pose * (0.5 * h * h) - gradient * (area * h);
        sum.by_both += (gradient * gradient.transpose() - curvature * h) * area
            - (ends_by_pose * gradient.transpose() + gradient * ends_by_pose.transpose()) * h;
        true
    }

    /// How much of gear 2 there is at a place of its flank, from 1 inside to 0 beyond toe, heel and tip, and its
    /// derivatives by s and v.
    fn ends(&self, [s, v]: [f64; 2]) -> (f64, [f64; 2]) {
        let ramp = |inside: f64, width: f64| {
            let share = 0.5 + inside / width;
            let inner = share > 0.0 && share < 1.0;
            (share.clamp(0.0, 1.0), if inner { 1.0 / width } else { 0.0 })
        };
        let [of_s, of_v] = self.fade;
        let (toe, heel, tip) = (ramp(s, of_s), ramp(1.0 - s, of_s), ramp(1.0 - v, of_v));
        let along = (toe.1 * heel.0 - toe.0 * heel.1) * tip.0;
        (toe.0 * heel.0 * tip.0, [along, -toe.0 * heel.0 * tip.1])
    }
}

/// A corner of the grid: aside of the flank, so that the facets lie on it in the mean. The middles of chords lie off by
/// their sagittas, two thirds of which are the mean.
fn corner(patch: &FlankPatch, at: [f64; 2], steps: [f64; 2]) -> Vector3<f64> {
    let here = patch.point(at);
    let off: f64 = (0..2)
        .map(|k| {
            let mut ends = [at, at];
            let half = 0.5 * steps[k];
            // The flank has no places below its lower line.
            let middle = if k == 1 { at[k].max(half) } else { at[k] };
            (ends[0][k], ends[1][k]) = (middle - half, middle + half);
            let mut between = at;
            between[k] = middle;
            let [a, b] = ends.map(|at| patch.point(at).r);
            (0.5 * (a + b) - patch.point(between).r).dot(&here.n)
        })
        .sum();
    here.r - here.n * (off * 2.0 / 3.0)
}

/// Three points inside, exact for squares.
fn triangle([a, b, c]: [Vector3<f64>; 3]) -> [Place; 3] {
    let area_m2 = 0.5 * (b - a).cross(&(c - a)).norm() / 3.0;
    let sum = (a + b + c) / 6.0;
    [a, b, c].map(|corner| Place {
        r: sum + corner * 0.5,
        area_m2,
    })
}

/// Corners below and above at one place along the face, then at the next.
fn quadrilateral([a, b, c, d]: [Vector3<f64>; 4]) -> [Place; 4] {
    [0, 1, 2, 3].map(|number: usize| {
        let (x, y) = (GAUSS[number / 2], GAUSS[number % 2]);
        let by_x = (c - a) * (1.0 - y) + (d - b) * y;
        let by_y = (b - a) * (1.0 - x) + (d - c) * x;
        Place {
            r: (a * (1.0 - y) + b * y) * (1.0 - x) + (c * (1.0 - y) + d * y) * x,
            area_m2: 0.25 * by_x.cross(&by_y).norm(),
        }
    })
}

/// The foot of a point on a flank, from a place nearby.
fn foot_of(body: &Placed<'_>, x: &Vector3<f64>, start: [f64; 2]) -> Option<([f64; 2], PatchPoint)> {
    let domain = body.patch.domain();
    let mut at = start;
    for _ in 0..MOST_STEPS {
        let point = body.point(at);
        let off = x - point.r;
        let residual = Vector2::new(off.dot(&point.dr[0]), off.dot(&point.dr[1]));
        let step = metric(&point, &off).try_inverse()? * residual;
        let mut moved: f64 = 0.0;
        for k in 0..2 {
            let [low, high] = domain[k];
            let next = (at[k] + step[k]).clamp(low, high);
            moved = moved.max((next - at[k]).abs());
            at[k] = next;
        }
        if moved < CLOSE {
            // Pressed against the end of the patch: it has no foot there.
            let own = step.amax() < CLOSE;
            return own.then(|| (at, body.point(at)));
        }
    }
    None
}

/// p_k·p_l − (x − p)·p_kl.
fn metric(point: &PatchPoint, off: &Vector3<f64>) -> Matrix2<f64> {
    let of = |k: usize, l: usize| point.dr[k].dot(&point.dr[l]) - off.dot(&point.ddr[k + l]);
    Matrix2::new(of(0, 0), of(0, 1), of(1, 0), of(1, 1))
}

/// ∂(s, v of the foot)/∂pose of a point that stands still while gear 2 moves.
fn walks(foot: &PatchPoint, x: &Vector3<f64>, arm: &Vector3<f64>) -> Matrix2x6<f64> {
    let mut by_pose = Matrix2x6::zeros();
    for k in 0..2 {
        // Against gear 2 the point moves by −(δu + ϑ × a).
        let t = foot.dr[k];
        by_pose.set_row(k, &-stacked(t, arm.cross(&t)).transpose());
    }
    let inverse = metric(foot, &(x - foot.r)).try_inverse();
    inverse.map_or_else(Matrix2x6::zeros, |inverse| inverse * by_pose)
}
