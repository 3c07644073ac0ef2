//! Where a pair of teeth touches first at a turn of the pinion, edges and corners included: a search over the whole
//! flank, then Newton's method.
//!
//! A point of the pinion stands at z, ρ, φ in the gear's frame. The gear's flank goes through it when the gear has
//! turned by θ₂ = φ − χ(L, h), χ the azimuth of the gear's flank at that z and ρ. The gear cannot be turned farther
//! back than any point allows: the lead of the pair is the largest that a point has. What a grid of points has is a
//! bound from below, which the contact that is found must reach.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;

use crate::azimuth_surface::{AzimuthSurface, SectionFrame};
use crate::contact_point::{ContactKind, EdgeKind, EdgeLine, Mesh, Touch};
use crate::cut_surface::SurfacePoint;
use crate::error::BevelError;
use crate::flank::{Flank, Located};
use crate::flank_patch::{patch_of, reach_of};

/// Points of the pinion along the face and up the flank.
const POINTS: [usize; 2] = [33, 17];
/// Halvings of the points' distance where Newton finds nothing.
const ZOOMS: usize = 14;
/// By so much of the mean cone distance a contact may stay behind the bound: the rounding of the gear's patch.
const BEHIND: f64 = 2e-8;
/// Points within so many distances of an end may touch with it.
const NEAR_END: f64 = 2.5;

/// Tips, toes and heels of both members.
const EDGES: usize = 6;
/// Leads of points near an edge stay behind that of its contact by less \[rad\]: between points at the distance 2 m/16
/// a profile of radius m z sin α/2 lies back by 0.02/z² rad, so that this holds for gears of 15 teeth and more.
const PASSED_OVER_RAD: f64 = 1e-4;

const WHOLE: [[f64; 2]; 2] = [[0.0, 1.0]; 2];

/// A pair of flanks with the tables of the search.
pub(crate) struct ContactSearch<'a> {
    mesh: Mesh<'a>,
    /// The parts of pinion and gear that their mate can reach.
    frames: [SectionFrame; 2],
    /// The gear's flank.
    gear: AzimuthSurface,
    /// Of the pinion; where its flank is undercut there are none.
    points: Vec<Point>,
    /// Parameters of the gear's flank, by sector and height of its part.
    gear_at: Vec<[f64; 2]>,
    /// Parameters of the ends of the tips at toe and heel, of pinion and gear.
    corners: [[[f64; 2]; 2]; 2],
}

/// A point of the pinion.
struct Point {
    /// s, v of its patch.
    place: [f64; 2],
    /// Parameters of its flank.
    at: [f64; 2],
    /// In the pinion's frame \[m\].
    r: Vector3<f64>,
}

/// A point of the pinion that the gear's flank goes through.
#[derive(Clone, Copy)]
struct Candidate {
    lead_rad: f64,
    gear_turn_rad: f64,
    /// s, v on pinion and gear.
    places: [[f64; 2]; 2],
}

impl<'a> ContactSearch<'a> {
    /// Tables for a pair.
    ///
    /// # Errors
    /// [`BevelError::NoFlankPoint`] where the gear's flank does not reach over its blank.
    pub(crate) fn new(mesh: Mesh<'a>) -> Result<Self, BevelError> {
        let [pinion, gear] = mesh.flanks;
        let surface = patch_of(gear, reach_of(gear, &pinion.blank)?, WHOLE, 0.0)?;
        let frames = [reach_of(pinion, &gear.blank)?, surface.frame];
        let points = grid(pinion, &frames[0]).map(|(place, found)| {
            let found = found.ok()?;
            Some(Point {
                place,
                at: found.at,
                r: found.point.r,
            })
        });
        let corner = |m: usize, s: f64| -> Result<[f64; 2], BevelError> {
            let [cone, height] = frames[m].place_m([s, 1.0]);
            Ok(mesh.flanks[m].locate(cone, height)?.at)
        };
        let corners = [
            [corner(0, 0.0)?, corner(0, 1.0)?],
            [corner(1, 0.0)?, corner(1, 1.0)?],
        ];
        let gear_at = grid(gear, &frames[1]).map(|(_, found)| Ok(found?.at));
        Ok(Self {
            mesh,
            frames,
            gear: surface,
            points: points.flatten().collect(),
            gear_at: gear_at.collect::<Result<_, BevelError>>()?,
            corners,
        })
    }

    /// The pair that is searched.
    pub(crate) fn mesh(&self) -> &Mesh<'a> {
        &self.mesh
    }

    /// The gear's flank through a point of the pinion; none beside the gear's flank.
    fn candidate(&self, turn: f64, place: [f64; 2], r: &Vector3<f64>) -> Option<Candidate> {
        let [pinion, gear] = &self.mesh.assembly.members;
        let (sin, cos) = turn.sin_cos();
        let turned = Vector3::new(r.x * cos - r.y * sin, r.x * sin + r.y * cos, r.z);
        let fixed = pinion.axes * turned + pinion.apex_m;
        let own = gear.axes.tr_mul(&(fixed - gear.apex_m));
        let blank = &self.mesh.flanks[1].blank;
        let there = self.frames[1].at(blank.cone_place(own.z, own.x.hypot(own.y)));
        let inside = |x: &f64| (-1e-9..=1.0 + 1e-9).contains(x);
        if !there.iter().all(inside) {
            return None;
        }
        let azimuth = own.y.atan2(own.x) - self.gear.azimuth_rad(there);
        let ideal = Mesh::ideal_gear_turn(self.mesh.assembly, turn);
        let gear_turn_rad = ideal + (azimuth - ideal + PI).rem_euclid(TAU) - PI;
        Some(Candidate {
            lead_rad: self.mesh.lead_of_turns_rad(turn, gear_turn_rad),
            gear_turn_rad,
            places: [place, there],
        })
    }

    /// Where the pair touches first; none where the flanks have passed each other.
    pub(crate) fn first_touch(&self, turn: f64) -> Option<(ContactKind, Touch)> {
        let leaders = self.leaders(turn);
        let (point, best) = leaders[EDGES]?;
        let start = self.touch_at(turn, self.points[point].at, &best)?;
        let at_ends = self.ahead(self.at_edges(turn, &leaders), self.at_ends(turn));
        let reaches = |touch: &Touch| self.mesh.lead_rad(touch) >= best.lead_rad - BEHIND;
        let near = self.polished(turn, &start, |member, edge| {
            self.is_near(&best, member, edge)
        });
        if let Some(found) = self
            .ahead(near, at_ends)
            .filter(|(_, touch)| reaches(touch))
        {
            return Some(found);
        }
        // Anything, from the place of the largest lead.
        let best = self.zoomed(turn, best, self.points[point].at);
        let start = self.exact(turn, &best, &start);
        let any = self.polished(turn, &start, |_, _| true);
        let lead = self.mesh.lead_rad(&start);
        let found = any.filter(|(_, touch)| self.mesh.lead_rad(touch) >= lead - BEHIND);
        Some(found.unwrap_or_else(|| (self.kind_at(&best), start)))
    }

    /// The points of the largest lead near each edge of the pinion and of the gear, and of all: number and what the
    /// gear's flank is there.
    fn leaders(&self, turn: f64) -> [Option<(usize, Candidate)>; EDGES + 1] {
        let mut leaders: [Option<(usize, Candidate)>; EDGES + 1] = [None; EDGES + 1];
        let is_near = |found: &Candidate, n: usize| {
            let (member, edge) = edge_of(n);
            self.is_near(found, member, edge)
        };
        for (i, point) in self.points.iter().enumerate() {
            let Some(found) = self.candidate(turn, point.place, &point.r) else {
                continue;
            };
            for (n, leader) in leaders.iter_mut().enumerate() {
                let leads = leader.is_none_or(|(_, known)| found.lead_rad > known.lead_rad);
                if leads && (n == EDGES || is_near(&found, n)) {
                    *leader = Some((i, found));
                }
            }
        }
        leaders
    }

    /// Contacts of edges that the points of the search may pass over: from the leader near each of them.
    fn at_edges(
        &self,
        turn: f64,
        leaders: &[Option<(usize, Candidate)>; EDGES + 1],
    ) -> Option<(ContactKind, Touch)> {
        let of_all = leaders[EDGES].map_or(f64::NEG_INFINITY, |(_, all)| all.lead_rad);
        let mut ahead = None;
        for (n, leader) in leaders[..EDGES].iter().enumerate() {
            let Some((point, from)) = leader else {
                continue;
            };
            if from.lead_rad < of_all - PASSED_OVER_RAD {
                continue;
            }
            let own = edge_of(n);
            let start = self.touch_at(turn, self.points[*point].at, from);
            let found = start.and_then(|start| {
                self.polished(turn, &start, |member, edge| (member, edge) == own)
            });
            ahead = self.ahead(ahead, found);
        }
        ahead
    }

    /// Contacts at the ends of tips, which may be slivers between the points of the search: corners, and tips across
    /// ends.
    fn at_ends(&self, turn: f64) -> Option<(ContactKind, Touch)> {
        let mesh = &self.mesh;
        let ideal = Mesh::ideal_gear_turn(mesh.assembly, turn);
        let line = |member: usize, edge| EdgeLine::of(mesh.flanks[member], member, edge);
        let (tip, mut best) = (EdgeKind::Tip, None);
        for (i, end) in [EdgeKind::Toe, EdgeKind::Heel].into_iter().enumerate() {
            let at = [self.corners[0][i], self.corners[1][i]];
            let Some(start) = self.placed(turn, ideal, at) else {
                continue;
            };
            let corner = |member| {
                (
                    ContactKind::Corner { member, end },
                    [line(member, tip), line(member, end)],
                )
            };
            let crossing = |pinion, gear| {
                (
                    ContactKind::Crossing { pinion, gear },
                    [line(0, pinion), line(1, gear)],
                )
            };
            for (kind, lines) in [corner(0), corner(1), crossing(tip, end), crossing(end, tip)] {
                let found = mesh.lines_touch(turn, lines, &start);
                let found = found.filter(|touch| self.is_contact(touch));
                best = self.ahead(best, found.map(|touch| (kind, touch)));
            }
        }
        best
    }

    /// Whether both points lie on the flanks, which face each other.
    fn is_contact(&self, touch: &Touch) -> bool {
        self.mesh.on_flanks(touch) && touch.points[0].n.dot(&touch.points[1].n) < 0.0
    }

    /// Of two contacts that which brings the gear farther.
    fn ahead(
        &self,
        a: Option<(ContactKind, Touch)>,
        b: Option<(ContactKind, Touch)>,
    ) -> Option<(ContactKind, Touch)> {
        let lead = |x: &Option<(ContactKind, Touch)>| {
            x.map_or(f64::NEG_INFINITY, |(_, touch)| self.mesh.lead_rad(&touch))
        };
        if lead(&b) > lead(&a) { b } else { a }
    }

    /// A first guess: parameters of the gear from the table.
    fn touch_at(&self, turn: f64, pinion_at: [f64; 2], from: &Candidate) -> Option<Touch> {
        let [i, k] = [0, 1].map(|n| {
            let last = POINTS[n] - 1;
            ((from.places[1][n] * last as f64).round() as usize).min(last)
        });
        let at = [pinion_at, self.gear_at[i * POINTS[1] + k]];
        self.placed(turn, from.gear_turn_rad, at)
    }

    fn placed(&self, turn: f64, gear_turn: f64, at: [[f64; 2]; 2]) -> Option<Touch> {
        let [pinion, gear] = &self.mesh.assembly.members;
        Some(Touch {
            at,
            pinion_turn_rad: turn,
            gear_turn_rad: gear_turn,
            points: [
                pinion.placed(&self.mesh.flanks[0].point(at[0])?, turn),
                gear.placed(&self.mesh.flanks[1].point(at[1])?, gear_turn),
            ],
        })
    }

    /// Whether a candidate lies near an end of a member.
    fn is_near(&self, of: &Candidate, member: usize, edge: EdgeKind) -> bool {
        let step = POINTS.map(|n| NEAR_END / (n - 1) as f64);
        lies_within(of.places[member], edge, step)
    }

    /// The contact with the largest lead of those of faces, and of edges and corners that are asked for.
    fn polished(
        &self,
        turn: f64,
        start: &Touch,
        asked: impl Fn(usize, EdgeKind) -> bool,
    ) -> Option<(ContactKind, Touch)> {
        let mesh = &self.mesh;
        let mut best: Option<(ContactKind, Touch)> = None;
        let mut consider = |kind: ContactKind, found: Option<Touch>| {
            let found = found.filter(|touch| self.is_contact(touch));
            best = self.ahead(best, found.map(|touch| (kind, touch)));
        };
        let line = |member: usize, edge| EdgeLine::of(mesh.flanks[member], member, edge);
        consider(ContactKind::Flanks, mesh.touch(turn, start));
        let [of_pinion, of_gear] = [0, 1].map(|member: usize| {
            let mut list = EdgeKind::ALL.to_vec();
            list.retain(|edge| asked(member, *edge));
            list
        });
        for (member, list) in [&of_pinion, &of_gear].into_iter().enumerate() {
            for &edge in list {
                let found = mesh.edge_touch(turn, &line(member, edge), start);
                consider(ContactKind::Edge { member, edge }, found);
            }
            for &end in list.iter().filter(|e| **e != EdgeKind::Tip) {
                if list.contains(&EdgeKind::Tip) {
                    let lines = [line(member, EdgeKind::Tip), line(member, end)];
                    let found = mesh.lines_touch(turn, lines, start);
                    consider(ContactKind::Corner { member, end }, found);
                }
            }
        }
        for &pinion in &of_pinion {
            for &gear in &of_gear {
                let found = mesh.lines_touch(turn, [line(0, pinion), line(1, gear)], start);
                consider(ContactKind::Crossing { pinion, gear }, found);
            }
        }
        best
    }

    /// The largest lead round a candidate, by points nearer and nearer to each other.
    fn zoomed(&self, turn: f64, from: Candidate, at: [f64; 2]) -> Candidate {
        let flank = self.mesh.flanks[0];
        let Some(point) = flank.point(at) else {
            return from;
        };
        let near = Located { at, point };
        let mut best = from;
        let mut step = POINTS.map(|n| 1.0 / (n - 1) as f64);
        for _ in 0..ZOOMS {
            let centre = best.places[0];
            for i in -2..=2 {
                for k in -2..=2 {
                    let place = [
                        (centre[0] + 0.5 * f64::from(i) * step[0]).clamp(0.0, 1.0),
                        (centre[1] + 0.5 * f64::from(k) * step[1]).clamp(0.0, 1.0),
                    ];
                    let [cone, height] = self.frames[0].place_m(place);
                    let point = flank.locate_from(cone, height, &near);
                    let found = point
                        .ok()
                        .and_then(|p| self.candidate(turn, place, &p.point.r));
                    if let Some(found) = found.filter(|f| f.lead_rad > best.lead_rad) {
                        best = found;
                    }
                }
            }
            step = step.map(|x| 0.5 * x);
        }
        best
    }

    /// The gear's exact flank through a point of the pinion's exact flank. Where Newton's method finds none, what the
    /// search has found: the same but for the rounding of the gear's patch, and the pair is not lost.
    fn exact(&self, turn: f64, best: &Candidate, near: &Touch) -> Touch {
        let [pinion, gear] = self.mesh.flanks;
        let place = self.frames[0].place_m(best.places[0]);
        let there = self.frames[1].place_m(best.places[1]);
        let at = [
            pinion
                .locate(place[0], place[1])
                .map_or(near.at[0], |found| found.at),
            gear.locate(there[0], there[1])
                .map_or(near.at[1], |found| found.at),
        ];
        let start = self.placed(turn, best.gear_turn_rad, at).unwrap_or(*near);
        let found = self
            .mesh
            .lines_touch(turn, EdgeLine::through(0, place), &start);
        found.unwrap_or(start)
    }

    /// What a place on both flanks is, where no contact of Newton's is as far ahead.
    fn kind_at(&self, best: &Candidate) -> ContactKind {
        let low = [0, 1].map(|m: usize| best.places[m][1]);
        let member = usize::from(low[1] < low[0]);
        if low[member] < 1e-3 {
            return ContactKind::LowerEnd { member };
        }
        let mut ends = (0..2).flat_map(|m: usize| EdgeKind::ALL.map(|edge| (m, edge)));
        let end = ends.find(|(m, edge)| lies_within(best.places[*m], *edge, [1e-3; 2]));
        end.map_or(ContactKind::Flanks, |(member, edge)| ContactKind::Edge {
            member,
            edge,
        })
    }
}

/// Whether a place s, v lies within such a distance of an end, along the face and up the flank.
fn lies_within([s, v]: [f64; 2], edge: EdgeKind, distance: [f64; 2]) -> bool {
    match edge {
        EdgeKind::Tip => v > 1.0 - distance[1],
        EdgeKind::Toe => s < distance[0],
        EdgeKind::Heel => s > 1.0 - distance[0],
    }
}

/// Member and kind of an edge by its number.
fn edge_of(number: usize) -> (usize, EdgeKind) {
    let kinds = EdgeKind::ALL;
    (number / kinds.len(), kinds[number % kinds.len()])
}

/// The points of a flank's part: s and v, and the place on the surface.
fn grid<'a>(
    flank: &'a Flank,
    frame: &'a SectionFrame,
) -> impl Iterator<Item = ([f64; 2], Result<Located, BevelError>)> + 'a {
    let side = flank.mean().point.area().signum();
    (0..POINTS[0] * POINTS[1]).map(move |number| {
        let place = [
            (number / POINTS[1]) as f64 / (POINTS[0] - 1) as f64,
            (number % POINTS[1]) as f64 / (POINTS[1] - 1) as f64,
        ];
        let [cone, height] = frame.place_m(place);
        let found = flank.locate(cone, height);
        // Beyond a singular place the envelope turns back: that is no surface of the tooth.
        let turned_back = BevelError::Undercut {
            flank: flank.name(),
            cone_mm: 1e3 * cone,
            height_mm: 1e3 * height,
        };
        let is_tooth = |found: &Located| found.point.area() * side > 0.0;
        let found = found.and_then(|f| {
            if is_tooth(&f) {
                Ok(f)
            } else {
                Err(turned_back)
            }
        });
        (place, found)
    })
}

impl Mesh<'_> {
    /// Whether both points of a contact lie on the flanks.
    pub fn on_flanks(&self, touch: &Touch) -> bool {
        let own = |m: usize| -> Option<SurfacePoint> { self.flanks[m].point(touch.at[m]) };
        (0..2).all(|m| own(m).is_some_and(|p| self.flanks[m].holds(&p)))
    }

    /// Whether both points of a contact of the extended flanks lie on the blanks or beside them by less than the size
    /// of the flank.
    pub(crate) fn is_near_flanks(&self, touch: &Touch) -> bool {
        (0..2).all(|m| {
            let blank = &self.flanks[m].blank;
            let place = self.flanks[m].point(touch.at[m]);
            let at = place.map(|p| SectionFrame::of_tooth(blank).at(self.flanks[m].place(&p.r)));
            at.is_some_and(|at| at.iter().all(|x| (-1.0..=2.0).contains(x)))
        })
    }

    /// How far the gear is ahead of constant ratio in the sense in which the pinion drives it \[rad\].
    pub fn lead_rad(&self, touch: &Touch) -> f64 {
        self.lead_of_turns_rad(touch.pinion_turn_rad, touch.gear_turn_rad)
    }

    /// As [`Self::lead_rad`] at turns of pinion and gear.
    pub fn lead_of_turns_rad(&self, pinion_turn: f64, gear_turn: f64) -> f64 {
        let sense = self.flanks[0].side.facing(self.flanks[0].blank.hand);
        -sense * (gear_turn + self.assembly.ratio * pinion_turn)
    }
}
