//! Where two smooth patches with edges are nearest to each other, or deepest in each other: Newton's method on
//! stationary distances, of faces, edges and corners.
//!
//! d = r₂ − r₁, t the tangents ∂r/∂(s, v), n the normals into the material. Four unknowns (s, v on both), four
//! equations:
//!
//! ```text
//! inside both        d·t₂ = 0 (2),   t₁·n₂ = 0 (2)
//! edge on a face     d·t = 0 of the face (2),   t·n = 0 along the edge,   the edge's own coordinate at its end
//! corner on a face   d·t = 0 of the face (2),   both coordinates of the corner
//! edge across edge   d·t = 0 along both edges,  two coordinates at their ends
//! ```
//!
//! The gap g = d·N, N the normal of the face (of both edges where edges cross), goes over from one to the next without
//! a jump, and so does its gradient: at the change both have one common normal. Which of them holds:
//! `contact_limits.rs`.

use std::cell::Cell;

use gearmesh_bevel::{FlankPatch, PatchPoint};
use nalgebra::{Matrix3, Matrix4, Vector3, Vector4};

use super::tooth_side::about_z;

/// Newton steps at most.
const MOST_STEPS: usize = 15;
/// Longest step of a coordinate, flanks being 1 long.
const LONGEST: f64 = 0.3;
/// A step below ends the iteration: what is left is of the order of its square, and points at its end follow from those
/// at its start by their derivatives.
const CLOSE: f64 = 1e-7;

/// A patch in space: turned about its own axis, then r = A r_own + origin.
#[derive(Clone, Copy)]
pub(crate) struct Placed<'a> {
    pub patch: &'a FlankPatch,
    pub turn_rad: f64,
    /// A; none where the axes are those of space.
    pub axes: Option<Matrix3<f64>>,
    pub origin_m: Vector3<f64>,
    /// Counts the points that are computed.
    pub points: &'a Cell<u64>,
}

impl Placed<'_> {
    pub(crate) fn point(&self, at: [f64; 2]) -> PatchPoint {
        self.points.set(self.points.get() + 1);
        let mut point = self.patch.point_turned(at, self.turn_rad);
        if let Some(axes) = &self.axes {
            point.r = axes * point.r + self.origin_m;
            point.n = axes * point.n;
            let directions = point.dr.iter_mut().chain(&mut point.ddr);
            for direction in directions.chain(&mut point.dn) {
                *direction = axes * *direction;
            }
        }
        point
    }

    /// Axes of space from those of the flank.
    pub(crate) fn rotation(&self) -> Matrix3<f64> {
        let turn = about_z(self.turn_rad);
        self.axes.map_or(turn, |axes| axes * turn)
    }
}

/// Which coordinates stand at an end: `[member][s, v]`.
pub(crate) type Held = [[Option<f64>; 2]; 2];

pub(super) const FREE: Held = [[None; 2]; 2];

/// What gives the normal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// The face of member 0 or 1.
    Face(usize),
    /// Two edges, along these coordinates of member 0 and 1.
    Edges([usize; 2]),
}

/// Kind of a contact with held coordinates.
pub(crate) fn kind(held: &Held) -> Kind {
    let is_held = |member: usize| held[member].iter().any(Option::is_some);
    match (is_held(0), is_held(1)) {
        (_, false) => Kind::Face(1),
        (true, true) => Kind::Edges([0, 1].map(|m: usize| usize::from(held[m][0].is_some()))),
        (false, true) => Kind::Face(0),
    }
}

/// Two points that are nearest.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Nearest {
    pub held: Held,
    /// s, v on both members.
    pub at: [[f64; 2]; 2],
    pub points: [PatchPoint; 2],
    /// N, from member 0 to member 1 where they stand apart.
    pub normal: Vector3<f64>,
    /// Open positive \[m\].
    pub gap_m: f64,
}

impl Nearest {
    pub(crate) fn new(held: Held, at: [[f64; 2]; 2], points: [PatchPoint; 2]) -> Self {
        let [p, q] = &points;
        let normal = match kind(&held) {
            Kind::Face(1) => q.n,
            Kind::Face(_) => -p.n,
            Kind::Edges([i, j]) => {
                let across = p.dr[i].cross(&q.dr[j]).normalize();
                across * across.dot(&q.n).signum()
            }
        };
        let gap_m = (q.r - p.r).dot(&normal);
        Self {
            held,
            at,
            points,
            normal,
            gap_m,
        }
    }

    /// How the gap changes with a coordinate \[m\].
    pub(super) fn slope(&self, member: usize, k: usize) -> f64 {
        let sign = [-1.0, 1.0][member];
        sign * self.points[member].dr[k].dot(&self.normal)
    }

    /// Whether held coordinates would let the gap shrink beyond their ends.
    pub(super) fn is_held_back(&self) -> bool {
        (0..2).all(|m| {
            (0..2).all(|k| match self.held[m][k] {
                None => true,
                Some(end) => self.slope(m, k) * (2.0 * end - 1.0) <= 1e-12,
            })
        })
    }
}

/// Residuals and their derivatives by the unknowns, rows as at the head of this file.
pub(crate) fn equations(
    held: &Held,
    at: &[[f64; 2]; 2],
    points: &[PatchPoint; 2],
) -> (Vector4<f64>, Matrix4<f64>) {
    let mut residual = Vector4::zeros();
    let mut slopes = Matrix4::zeros();
    let d = points[1].r - points[0].r;
    // d·t of member m along k.
    let along = |m: usize, k: usize, row: usize, f: &mut Vector4<f64>, j: &mut Matrix4<f64>| {
        let p = &points[m];
        f[row] = d.dot(&p.dr[k]);
        for l in 0..2 {
            j[(row, l)] -= points[0].dr[l].dot(&p.dr[k]);
            j[(row, 2 + l)] += points[1].dr[l].dot(&p.dr[k]);
            j[(row, 2 * m + l)] += d.dot(&p.ddr[k + l]);
        }
    };
    let hold =
        |m: usize, k: usize, end: f64, row: usize, f: &mut Vector4<f64>, j: &mut Matrix4<f64>| {
            f[row] = at[m][k] - end;
            j[(row, 2 * m + k)] = 1.0;
        };
    match kind(held) {
        Kind::Face(face) => {
            let other = 1 - face;
            for k in 0..2 {
                along(face, k, k, &mut residual, &mut slopes);
                if let Some(end) = held[other][k] {
                    hold(other, k, end, 2 + k, &mut residual, &mut slopes);
                    continue;
                }
                let (p, q) = (&points[other], &points[face]);
                residual[2 + k] = p.dr[k].dot(&q.n);
                for l in 0..2 {
                    slopes[(2 + k, 2 * other + l)] = p.ddr[k + l].dot(&q.n);
                    slopes[(2 + k, 2 * face + l)] = p.dr[k].dot(&q.dn[l]);
                }
            }
        }
        Kind::Edges(free) => {
            for m in 0..2 {
                along(m, free[m], m, &mut residual, &mut slopes);
                let k = 1 - free[m];
                if let Some(end) = held[m][k] {
                    hold(m, k, end, 2 + m, &mut residual, &mut slopes);
                }
            }
        }
    }
    (residual, slopes)
}

/// Moves a point a tiny step along its patch, to the square of the step.
fn shift(p: &mut PatchPoint, [x, y]: [f64; 2]) {
    p.r += (p.dr[0] + 0.5 * (p.ddr[0] * x + p.ddr[1] * y)) * x
        + (p.dr[1] + 0.5 * (p.ddr[1] * x + p.ddr[2] * y)) * y;
    for k in 0..2 {
        p.dr[k] += p.ddr[k] * x + p.ddr[k + 1] * y;
    }
    p.n = (p.n + p.dn[0] * x + p.dn[1] * y).normalize();
}

/// Newton's method for one set of held coordinates.
pub(super) fn solve(bodies: &[Placed<'_>; 2], held: Held, start: [[f64; 2]; 2]) -> Option<Nearest> {
    let mut at = start;
    for m in 0..2 {
        for k in 0..2 {
            if let Some(end) = held[m][k] {
                at[m][k] = end;
            }
        }
    }
    for _ in 0..MOST_STEPS {
        let mut points = [bodies[0].point(at[0]), bodies[1].point(at[1])];
        let (residual, slopes) = equations(&held, &at, &points);
        let mut step = slopes.lu().solve(&residual)?;
        let most = step.amax();
        if !most.is_finite() {
            return None;
        }
        if most > LONGEST {
            step *= LONGEST / most;
        }
        let mut moved: f64 = 0.0;
        for m in 0..2 {
            for k in 0..2 {
                let [low, high] = bodies[m].patch.domain()[k];
                let next = (at[m][k] - step[2 * m + k]).clamp(low, high);
                moved = moved.max((next - at[m][k]).abs());
                at[m][k] = next;
            }
        }
        if most < CLOSE {
            for (m, point) in points.iter_mut().enumerate() {
                shift(point, [-step[2 * m], -step[2 * m + 1]]);
            }
            let facing = points[0].n.dot(&points[1].n) < 0.0;
            return facing.then(|| Nearest::new(held, at, points));
        }
        // Pressed against the end of the patch: nothing is nearest here.
        if moved < CLOSE {
            return None;
        }
    }
    None
}
