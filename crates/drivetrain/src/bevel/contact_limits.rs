//! What holds the contact of two flanks: tips, lower lines, toes and heels, and the search for those that do.
//!
//! Of several ends that hold a contact back that counts at which the gap would shrink further beyond (the multiplier of
//! the end).

use std::cell::Cell;

use super::nearest_points::{FREE, Held, Nearest, Placed, solve};

/// Lower lines count that stand no deeper behind the mate's flank than this share of their own flank's height, a fifth
/// of a module: a tooth is thicker, and what lies behind it is no contact.
const DEEPEST: f64 = 0.1;
/// Slack of limits: rounding.
const SLACK: f64 = 1e-9;

/// An edge along the face: the tip of a member, or the lower line of one whose patch ends there, as those of flanks do
/// that turn back close below. A mate that reaches deeper touches that line: its contact would else be lost with all
/// its force.
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

    /// Whether a contact that it holds is on the mate's flank, not behind its tooth.
    pub(super) fn is_before_the_tooth(self, found: &Nearest) -> bool {
        let height_m = found.points[self.member].dr[1].norm();
        self.is_tip || found.gap_m > -DEEPEST * height_m
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
            let is_before =
                |found: &Nearest| self.long.is_none_or(|edge| edge.is_before_the_tooth(found));
            let found = solve(bodies, held, start)
                .filter(|found| self.others_hold(&found.at) && is_before(found));
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
    // Those that the contact of the surfaces has passed first, or, where none was found, those towards which the gap
    // shrinks; the others only where none of them holds.
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
            found = nearer(found, limits.contact(bodies, start, &elsewhere));
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
        found = nearer(found, limits.contact(bodies, start, &Cell::new(None)));
    }
    let from = elsewhere.get().map_or(start, |from| from.at);
    found.ok_or(NoContact::Missed(from))
}

/// Of two contacts that of the smaller gap, the first where they are alike.
pub(super) fn nearer(a: Option<Nearest>, b: Option<Nearest>) -> Option<Nearest> {
    match (a, b) {
        (Some(a), Some(b)) => Some(if b.gap_m < a.gap_m { b } else { a }),
        (a, b) => a.or(b),
    }
}
