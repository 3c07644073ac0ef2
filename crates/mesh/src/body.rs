//! Hub, web and rim of one repeating sector below the teeth, with its openings.

use crate::MeshError;
use crate::body_circles::{circles_within, element_length};
use crate::grading::{Pieces, graded};
use crate::mid_sides::{CurvedSides, MidSides};
use crate::opening_outline::opening_outline;
use crate::plane_mesher::{PlaneMesh, PlaneProblem, Region};
use crate::thin_ring;
use gearmesh_geometry::blank::Lugs;
use gearmesh_geometry::{GearDefinition, Openings};
use std::f64::consts::TAU;
use std::iter;

/// One sector of a span of the body, ready for the mesher.
#[derive(Debug, Clone)]
pub struct BodyProblem {
    /// What the mesher gets.
    pub problem: PlaneProblem,
    /// True for regions that exist only in the web's layers.
    pub web_region: Vec<bool>,
    /// Points on the outer circle, counter-clockwise, shared with the tooth cells.
    pub ring: Vec<usize>,
    /// Points on the sector's edges, outwards to inwards, without those on the ring; empty when there is one sector.
    pub right_side: Vec<usize>,
    /// The same on the edge at the larger angle.
    pub left_side: Vec<usize>,
    /// Points on the inner circle: the bore, where the span reaches down to it.
    pub bore: Vec<usize>,
    /// True where the sector is the whole body, closed in itself.
    closed: bool,
    curved: CurvedSides,
}

impl BodyProblem {
    /// Puts nodes in the middle of the sides of the body's mesh, those of ring, edges and bore between the others.
    pub fn make_quadratic(&mut self, mesh: &mut PlaneMesh) {
        let middles = MidSides::add(mesh, &self.curved);
        for side in [&mut self.right_side, &mut self.left_side] {
            // The side of the edge next to the ring: at the ring's first or last node.
            let ring = [self.ring[0], self.ring[self.ring.len() - 1]];
            let Some(first) = side.first() else { continue };
            let outer = ring
                .into_iter()
                .find(|&r| !middles.along(&[r, *first]).is_empty());
            let chain: Vec<usize> = outer.into_iter().chain(side.iter().copied()).collect();
            *side = middles.interleaved(&chain, false).split_off(1);
        }
        self.ring = middles.interleaved(&self.ring, self.closed);
        self.bore = middles.interleaved(&self.bore, self.closed);
    }
}

/// How long the body's elements are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BodyLengths {
    /// As wanted, whatever the sector's width.
    Wanted,
    /// Nowhere longer than the sector is wide: towards the bore the wedge of one tooth becomes narrower than an
    /// element, and quads of twice its width and several times its length have corners of some ten degrees.
    WithinSector,
}

/// A part of the body between two circles, and how it is cut.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// Radii of its outer and its inner circle \[m\].
    pub radii_m: [f64; 2],
    /// Equal sectors in a turn.
    pub sectors: usize,
    /// First tooth above sector 0.
    pub first_tooth: usize,
    /// Pieces of the outer circle below each tooth.
    pub pieces: usize,
}

/// Places the nodes on the edges of a span's regions; the ring's pieces are `ring_size_m` long.
///
/// # Errors
/// [`MeshError::OpeningsAcross`] when openings lie across a circle of nodes.
pub fn body_problem(
    gear: &GearDefinition,
    ring_size_m: f64,
    span: &Span,
    lengths: BodyLengths,
) -> Result<BodyProblem, MeshError> {
    let angle = TAU / span.sectors as f64;
    let wanted = element_length(gear, ring_size_m);
    let size = |r: f64| match lengths {
        BodyLengths::Wanted => wanted(r),
        BodyLengths::WithinSector => wanted(r).min(r * angle),
    };
    let mut sector = Sector::new(gear, span, size)?;
    let circles = sector.circles(span.pieces);
    let mut regions = Vec::new();
    let mut arcs: Vec<Vec<usize>> = Vec::new();
    for (i, pair) in circles.windows(2).enumerate() {
        let (region, between) = sector.region(i, &pair[0], &pair[1]);
        regions.push(region);
        arcs.extend(between);
    }
    let (points, closed) = (sector.points, sector.closed);
    let mut curved = sector.curved;
    for circle in circles.iter().chain(&arcs) {
        curved.insert_arcs(circle, closed, |n| [points[n][0], points[n][1]]);
    }
    let levels = &sector.levels;
    Ok(BodyProblem {
        web_region: levels[..regions.len()]
            .iter()
            .map(|level| level.1)
            .collect(),
        ring: circles[0].clone(),
        right_side: sector.right_side,
        left_side: sector.left_side,
        bore: circles[circles.len() - 1].clone(),
        closed,
        curved,
        problem: PlaneProblem {
            name: "body".into(),
            points,
            regions,
            largest: gear.mesh.body_m,
        },
    })
}

/// A sector while its nodes are placed.
struct Sector<'g, F> {
    gear: &'g GearDefinition,
    /// Element length wanted at a radius.
    size: F,
    /// Circles between the regions, and whether the region below each is web only.
    levels: Vec<(f64, bool)>,
    /// Those within the span.
    openings: Option<Openings>,
    sectors: usize,
    start: f64,
    angle: f64,
    closed: bool,
    points: Vec<[f64; 3]>,
    curved: CurvedSides,
    right_side: Vec<usize>,
    left_side: Vec<usize>,
}

impl<'g, F: Fn(f64) -> f64> Sector<'g, F> {
    fn new(gear: &'g GearDefinition, span: &Span, size: F) -> Result<Self, MeshError> {
        let levels = circles_within(gear, span.radii_m);
        let in_span = |o: &Openings| o.radii_m().1 > span.radii_m[1];
        let openings = gear.blank.openings().filter(in_span);
        let in_a_region = |o: &Openings| {
            levels
                .windows(2)
                .any(|pair| lies_between(o, [pair[0].0, pair[1].0]))
        };
        if let Some(openings) = openings.filter(|o| !in_a_region(o)) {
            let (inner, outer) = openings.radii_m();
            return Err(MeshError::OpeningsAcross {
                inner_mm: inner * 1e3,
                outer_mm: outer * 1e3,
            });
        }
        let pitch = TAU / gear.tooth.teeth as f64;
        Ok(Self {
            gear,
            size,
            levels,
            openings,
            sectors: span.sectors,
            start: (span.first_tooth as f64 - 0.5) * pitch,
            angle: TAU / span.sectors as f64,
            closed: span.sectors == 1,
            points: Vec::new(),
            curved: CurvedSides::default(),
            right_side: Vec::new(),
            left_side: Vec::new(),
        })
    }

    fn add(&mut self, r: f64, phi: f64) -> usize {
        let size = (self.size)(r);
        self.points.push([r * phi.cos(), r * phi.sin(), size]);
        self.points.len() - 1
    }

    fn openings_in(&self, region: usize) -> Option<Openings> {
        let circles = [self.levels[region].0, self.levels[region + 1].0];
        self.openings.filter(|o| lies_between(o, circles))
    }

    /// Least number of pieces of a circle.
    fn least(&self) -> usize {
        if self.closed { 8 } else { 2 }
    }

    fn is_thin(&self, region: usize) -> bool {
        let (outer, inner) = (self.levels[region].0, self.levels[region + 1].0);
        let length = (self.size)(inner).min(inner * self.angle / self.least() as f64);
        thin_ring::is_thin(outer, inner, length) && self.openings_in(region).is_none()
    }

    /// The bore takes over the hub's number of pieces, so that the hub can be paved regularly.
    fn is_regular(&self, region: usize) -> bool {
        let (blank, levels) = (&self.gear.blank, &self.levels);
        let is_bore = region + 2 == levels.len() && levels[region + 1].0 <= blank.edge_radius_m();
        is_bore && blank.web().is_some()
    }

    /// The nodes of all circles; the outer one has `pieces` below each tooth.
    fn circles(&mut self, pieces: usize) -> Vec<Vec<usize>> {
        let mut n = pieces * self.gear.tooth.teeth / self.sectors;
        let levels = self.levels.clone();
        let circle = |(level, (r, _)): (usize, (f64, bool))| {
            if level > 0 && !self.is_regular(level - 1) && !self.is_thin(level - 1) {
                // Free regions are meshed two boundary pieces at a time, and blossom needs an even number of those:
                // the outline of a region has a multiple of four pieces, of which two equal edges are even already.
                let outer = n;
                n = ((r * self.angle / (self.size)(r)).ceil() as usize)
                    .max(self.least())
                    .next_multiple_of(2);
                n += (n + outer) % 4;
            }
            let nodes = if self.closed { n } else { n + 1 };
            let mut places: Vec<f64> = (0..nodes)
                .map(|k| self.start + self.angle * k as f64 / n as f64)
                .collect();
            if let Some(lugs) = self.gear.blank.rim().and_then(|rim| rim.lugs)
                && level + 1 == self.levels.len()
            {
                move_to_edges(&mut places, &lugs, self.closed);
            }
            places.into_iter().map(|phi| self.add(r, phi)).collect()
        };
        levels.into_iter().enumerate().map(circle).collect()
    }

    /// The region between two circles, and the circles of nodes within it, where it is paved regularly.
    fn region(&mut self, i: usize, outer: &[usize], inner: &[usize]) -> (Region, Vec<Vec<usize>>) {
        let radii = graded(
            self.levels[i].0,
            self.levels[i + 1].0,
            &self.size,
            Pieces::EVEN,
        );
        let steps = &radii[1..radii.len() - 1];
        let (mut loops, edges) = self.outline(outer, inner, steps);
        let openings = self.openings_in(i);
        if let Some(openings) = &openings {
            loops.extend(self.opening_loops(openings));
        }
        let (mut quads, mut between) = (Vec::new(), Vec::new());
        if self.is_thin(i) || self.closed && self.is_regular(i) && openings.is_none() {
            let pieces = outer.len() - usize::from(!self.closed);
            let (start, angle) = (self.start, self.angle);
            let place = |k: usize| start + angle * k as f64 / pieces as f64;
            between = thin_ring::circles(steps, &edges, outer.len(), |r, k| self.add(r, place(k)));
            let rows: Vec<&[usize]> = iter::once(outer)
                .chain(between.iter().map(|circle| &circle[..]))
                .chain([inner])
                .collect();
            quads = thin_ring::quads(&rows, self.closed);
        }
        let region = Region {
            loops,
            corners: Vec::new(),
            quads,
        };
        (region, between)
    }

    /// The closed lines around a region without its openings, and the nodes on its right and left edge between the
    /// circles, of which a closed sector has none.
    fn outline(
        &mut self,
        outer: &[usize],
        inner: &[usize],
        steps: &[f64],
    ) -> (Vec<Vec<usize>>, [Vec<usize>; 2]) {
        if self.closed {
            return (
                vec![outer.to_vec(), inner.to_vec()],
                [Vec::new(), Vec::new()],
            );
        }
        let [right, left] = [self.start, self.start + self.angle].map(|phi| {
            steps
                .iter()
                .map(|&r| self.add(r, phi))
                .collect::<Vec<usize>>()
        });
        let mut outline = outer.to_vec();
        outline.extend(&left);
        outline.extend(inner.iter().rev());
        outline.extend(right.iter().rev());
        self.right_side.extend(&right);
        self.right_side.push(inner[0]);
        self.left_side.extend(&left);
        self.left_side.push(inner[inner.len() - 1]);
        (vec![outline], [right, left])
    }

    /// The outlines of a sector's openings.
    fn opening_loops(&mut self, openings: &Openings) -> Vec<Vec<usize>> {
        let count = openings.count() / self.sectors;
        let repeat = TAU / openings.count() as f64;
        let first = ((self.start - openings.phase_rad()) / repeat).ceil() as i64;
        // Every other point is the middle of a side.
        let outline = opening_outline(openings, self.gear.mesh.body_m);
        let one = |k: i64| {
            let centre = openings.phase_rad() + repeat * (first + k) as f64;
            let (corners, middles): (Vec<_>, Vec<_>) = outline
                .as_chunks()
                .0
                .iter()
                .map(|&[(r, phi), middle]| (self.add(r, centre + phi), middle))
                .unzip();
            for (k, (r, phi)) in middles.into_iter().enumerate() {
                let (sin, cos) = (centre + phi).sin_cos();
                let next = corners[(k + 1) % corners.len()];
                self.curved.insert(corners[k], next, [r * cos, r * sin]);
            }
            corners
        };
        (0..count as i64).map(one).collect()
    }
}

/// Whether openings lie between two circles, without touching them.
fn lies_between(openings: &Openings, [outer, inner]: [f64; 2]) -> bool {
    openings.radii_m().1 < outer && openings.radii_m().0 > inner
}

/// Edges of lugs so near to a cut, in pieces of the circle, lie on it.
const ON_CUT: f64 = 1e-6;

/// Moves the nearest of the places round a sector to the edges of lugs, its two ends excepted where it is not `closed`;
/// an edge that lies on an end stays there.
fn move_to_edges(places: &mut [f64], lugs: &Lugs, closed: bool) {
    let (first, last) = (places[0], places[places.len() - 1]);
    let spacing = places[1] - first;
    let repeat = lugs.repeat_rad();
    let end = if closed { first + TAU } else { last };
    let mut moved = vec![false; places.len()];
    if !closed {
        (moved[0], moved[places.len() - 1]) = (true, true);
    }
    for half in [-0.5, 0.5] {
        let edge = lugs.phase_rad + half * lugs.width_rad;
        let mut at = edge + repeat * ((first - edge) / repeat).ceil();
        while at < end - ON_CUT * spacing {
            if closed || at > first + ON_CUT * spacing {
                // The first place of a closed circle comes after its last one.
                let way = |k: usize| at - places[k] - TAU * ((at - places[k]) / TAU).round();
                let free = (0..places.len()).filter(|&k| !moved[k]);
                if let Some(k) = free.min_by(|&a, &b| way(a).abs().total_cmp(&way(b).abs())) {
                    places[k] += way(k);
                    moved[k] = true;
                }
            }
            at += repeat;
        }
    }
}
