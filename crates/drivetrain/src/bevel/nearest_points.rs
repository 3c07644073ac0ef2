//! Where two smooth patches with edges are nearest to each other, or deepest in each other: Newton's method on
//! stationary distances, of faces, edges and corners.
//!
//! d = r₂ − r₁, t the tangents ∂r/∂(s, v), n the normals into the material. Four unknowns (s, v on both), four equations:
//!
//! ```text
//! inside both        d·t₂ = 0 (2),   t₁·n₂ = 0 (2)
//! edge on a face     d·t = 0 of the face (2),   t·n = 0 along the edge,   the edge's own coordinate at its end
//! corner on a face   d·t = 0 of the face (2),   both coordinates of the corner
//! edge across edge   d·t = 0 along both edges,  two coordinates at their ends
//! ```
//!
//! The gap g = d·N, N the normal of the face (of both edges where edges cross), goes over from one to the next without a
//! jump, and so does its gradient: at the change both have one common normal. Of several ends that hold a contact back
//! that counts at which the gap would shrink further beyond (the multiplier of the end).

use std::cell::Cell;

use gearmesh_bevel::{FlankPatch, PatchPoint};
use nalgebra::{Matrix3, Matrix4, Vector3, Vector4};

use super::tooth_side::about_z;

/// Newton steps at most.
const MOST_STEPS: usize = 15;
/// Longest step of a coordinate, flanks being 1 long.
const LONGEST: f64 = 0.3;
/// Lower lines count that stand no deeper behind the mate's flank than this share of their own flank's height, a fifth of a module: a tooth is
/// thicker, and what lies behind it is no contact.
const DEEPEST: f64 = 0.1;
/// A step below ends the iteration: what is left is of the order of its square, and points at its end follow from those at
/// its start by their derivatives.
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
    fn is_held_back(&self) -> bool {
        (0..2).all(|m| {
            (0..2).all(|k| match self.held[m][k] {
                None => true,
                Some(end) => self.slope(m, k) * (2.0 * end - 1.0) <= 1e-12,
            })
        })
    }

    /// Whether no lower line holds it from behind the mate's tooth.
    pub(super) fn is_before_the_tooth(&self) -> bool {
        LongEdge::of(&self.held).is_none_or(|edge| {
            let height_m = self.points[edge.member].dr[1].norm();
            edge.is_tip || self.gap_m > -DEEPEST * height_m
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

/// An edge along the face: the tip of a member, or the lower line of one whose patch ends there, as those of flanks do that
/// turn back close below. A mate that reaches deeper touches that line: its contact would else be lost with all its force.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct LongEdge {
    pub member: usize,
    pub is_tip: bool,
}

impl LongEdge {
    pub(super) const ALL: [Self; 4] = [
        Self::new(0, true),
        Self::new(1, true),
        Self::new(0, false),
        Self::new(1, false),
    ];

    const fn new(member: usize, is_tip: bool) -> Self {
        Self { member, is_tip }
    }

    /// The one that holds a contact.
    pub(crate) fn of(held: &Held) -> Option<Self> {
        let of_member = |m: usize| Some(Self::new(m, held[m][1]? > 0.5));
        (0..2).find_map(of_member)
    }

    /// Its place up the flank.
    pub(super) fn end(self) -> f64 {
        f64::from(u8::from(self.is_tip))
    }

    /// Whether the patch has it.
    pub(super) fn is_there(self, bodies: &[Placed<'_>; 2]) -> bool {
        self.is_tip || bodies[self.member].patch.domain()[1][0] >= 0.0
    }
}

/// What holds a contact back.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Limit {
    /// An edge along the face.
    Long(LongEdge),
    /// Both toes or both heels: the first of the two ends.
    End(usize),
}

const LIMITS: [Limit; 6] = [
    Limit::Long(LongEdge::ALL[0]),
    Limit::Long(LongEdge::ALL[1]),
    Limit::Long(LongEdge::ALL[2]),
    Limit::Long(LongEdge::ALL[3]),
    Limit::End(0),
    Limit::End(1),
];

impl Limit {
    /// By how much a contact stands beyond it, in lengths of the flank; within it below zero.
    fn excess(self, at: &[[f64; 2]; 2]) -> f64 {
        match self {
            Self::Long(edge) if edge.is_tip => at[edge.member][1] - 1.0,
            // A patch that goes on below its lower line has no edge there, one that does not has no contacts beyond.
            Self::Long(_) => f64::NEG_INFINITY,
            Self::End(end) => {
                let sign = 2.0 * end as f64 - 1.0;
                let beyond = |m: usize| sign * (at[m][0] - end as f64);
                beyond(0).max(beyond(1))
            }
        }
    }

    /// Holds the coordinate of a member.
    fn hold(self, member: usize, mut held: Held) -> Held {
        match self {
            Self::Long(edge) => held[member][1] = Some(edge.end()),
            Self::End(end) => held[member][0] = Some(end as f64),
        }
        held
    }
}

/// Slack of limits: rounding.
const SLACK: f64 = 1e-9;

/// What holds a contact: an edge along the face, toes or heels, such an edge and an end, or nothing inside both flanks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Limits {
    long: Option<LongEdge>,
    end: Option<usize>,
}

impl Limits {
    const NONE: Self = Self::new(None, None);
    const ONE: [Self; 6] = [
        Self::new(Some(LongEdge::ALL[0]), None),
        Self::new(Some(LongEdge::ALL[1]), None),
        Self::new(None, Some(0)),
        Self::new(None, Some(1)),
        Self::new(Some(LongEdge::ALL[2]), None),
        Self::new(Some(LongEdge::ALL[3]), None),
    ];

    /// An edge along the face, or nothing.
    pub(super) const fn along(long: Option<LongEdge>) -> Self {
        Self::new(long, None)
    }

    const fn new(long: Option<LongEdge>, end: Option<usize>) -> Self {
        Self { long, end }
    }

    /// Edges along the face with toes or heels.
    fn corners() -> impl Iterator<Item = Self> {
        let with_ends = |edge| [0, 1].map(|end| Self::new(Some(edge), Some(end)));
        LongEdge::ALL.into_iter().flat_map(with_ends)
    }

    /// Those that hold coordinates of a contact.
    pub(crate) fn of(held: &Held) -> Self {
        let end = held.iter().find_map(|own| own[0]);
        Self {
            long: LongEdge::of(held),
            end: end.map(|end| usize::from(end > 0.5)),
        }
    }

    /// The edge along the face that holds, if one does.
    pub(super) fn long(self) -> Option<LongEdge> {
        self.long
    }

    fn holds(self, limit: Limit) -> bool {
        match limit {
            Limit::Long(edge) => self.long == Some(edge),
            Limit::End(end) => self.end == Some(end),
        }
    }

    /// Whether a contact stands within all of these.
    fn none_passed(self, at: &[[f64; 2]; 2]) -> bool {
        let mut own = LIMITS.iter().filter(|limit| self.holds(**limit));
        own.all(|limit| limit.excess(at) <= SLACK)
    }

    /// Whether a contact stands within all others.
    fn others_hold(self, at: &[[f64; 2]; 2]) -> bool {
        let mut others = LIMITS.iter().filter(|limit| !self.holds(**limit));
        others.all(|limit| limit.excess(at) <= SLACK)
    }

    /// The contact that they hold. Toes and heels of both members hold together: the gap is the larger one of the two.
    fn contact(
        self,
        bodies: &[Placed<'_>; 2],
        start: [[f64; 2]; 2],
        elsewhere: &Cell<Option<Nearest>>,
    ) -> Option<Nearest> {
        if self.long.is_some_and(|edge| !edge.is_there(bodies)) {
            return None;
        }
        let hold = |edge: LongEdge| Limit::Long(edge).hold(edge.member, FREE);
        let long = self.long.map_or(FREE, hold);
        let one = |held: Held| {
            let found = solve(bodies, held, start)
                .filter(|found| self.others_hold(&found.at) && found.is_before_the_tooth());
            let (back, on) = (
                found.filter(Nearest::is_held_back),
                found.filter(|f| !f.is_held_back()),
            );
            elsewhere.set(elsewhere.get().or(on));
            back
        };
        let Some(end) = self.end else {
            return one(long);
        };
        let [a, b] = [0, 1].map(|member| one(Limit::End(end).hold(member, long)));
        match (a, b) {
            (Some(a), Some(b)) => Some(if b.gap_m > a.gap_m { b } else { a }),
            (a, b) => a.or(b),
        }
    }
}

/// Nearest points with stated limits, from a guess nearby; none where others hold.
pub(crate) fn nearest_within(
    bodies: &[Placed<'_>; 2],
    limits: Limits,
    guess: [[f64; 2]; 2],
) -> Option<Nearest> {
    limits.contact(bodies, guess, &Cell::new(None))
}

/// Nearest points from a guess nearby, whatever holds them: the limits that are likely first.
pub(crate) fn nearest_from(
    bodies: &[Placed<'_>; 2],
    likely: Limits,
    guess: [[f64; 2]; 2],
) -> Option<Nearest> {
    let others = [Limits::NONE].into_iter().chain(Limits::ONE);
    let mut all = [likely].into_iter().chain(others).chain(Limits::corners());
    all.find_map(|limits| nearest_within(bodies, limits, guess))
}

/// Why no contact was found from a guess.
pub(crate) enum NoContact {
    /// The flanks do not face each other, or stand too far apart.
    Apart,
    /// They face each other, but nothing holds from this place.
    Missed([[f64; 2]; 2]),
}

/// Nearest points of two flanks with tips, toes and heels, from a guess.
///
/// # Errors
/// [`NoContact`]; apart are flanks that do not face each other, or stand farther apart than `far_m` at the guess.
pub(crate) fn nearest(
    bodies: &[Placed<'_>; 2],
    guess: [[f64; 2]; 2],
    far_m: f64,
) -> Result<Nearest, NoContact> {
    // From the middle of a cell straight to the other flank: both points then belong together. Flanks on which neither
    // middle has a foot do not face each other.
    let foot = |held: Held| solve(bodies, held, guess);
    let foot =
        foot([guess[0].map(Some), [None; 2]]).or_else(|| foot([[None; 2], guess[1].map(Some)]));
    let Some(foot) = foot.filter(|foot| foot.gap_m <= far_m) else {
        return Err(NoContact::Apart);
    };
    let inside = solve(bodies, FREE, foot.at);
    if let Some(found) = inside.filter(|found| Limits::NONE.others_hold(&found.at)) {
        return Ok(found);
    }
    let start = inside.map_or(foot.at, |found| found.at);
    let elsewhere: Cell<Option<Nearest>> = Cell::new(None);
    let least = |a: Option<Nearest>, b: Option<Nearest>| match (a, b) {
        (Some(a), Some(b)) => Some(if b.gap_m < a.gap_m { b } else { a }),
        (a, b) => a.or(b),
    };
    // Those that the contact of the surfaces has passed first, or, where none was found, those towards which the gap shrinks;
    // the others only where none of them holds.
    let passed = |limits: Limits| match (inside, limits.long, limits.end) {
        (Some(found), ..) => !limits.none_passed(&found.at),
        (None, Some(edge), _) => {
            let sign = 2.0 * edge.end() - 1.0;
            sign * foot.slope(edge.member, 1) < 0.0 || sign * foot.slope(1 - edge.member, 1) > 0.0
        }
        (None, None, end) => {
            let sign = 2.0 * end.unwrap_or(0) as f64 - 1.0;
            sign * foot.slope(0, 0) < 0.0 || sign * foot.slope(1, 0) < 0.0
        }
    };
    let mut found = None;
    for now in [true, false] {
        for limits in Limits::ONE
            .into_iter()
            .filter(|limits| passed(*limits) == now)
        {
            found = least(found, limits.contact(bodies, start, &elsewhere));
        }
        if found.is_some() {
            break;
        }
    }
    // Not held back by an end: there is a contact inside, which the first guess has missed.
    let missed = elsewhere
        .get()
        .filter(|_| found.is_none() && inside.is_none());
    let missed = missed.and_then(|from| solve(bodies, FREE, from.at));
    let found = found.or(missed.filter(|found| Limits::NONE.others_hold(&found.at)));
    if let Some(found) = found {
        return Ok(found);
    }
    let mut found = None;
    for limits in Limits::corners() {
        found = least(found, limits.contact(bodies, start, &Cell::new(None)));
    }
    let from = elsewhere.get().map_or(start, |from| from.at);
    found.ok_or(NoContact::Missed(from))
}
