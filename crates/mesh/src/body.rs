//! Hub, web and rim of one repeating sector below the teeth, with its openings.

use crate::MeshError;
use crate::grading::{Pieces, graded};
use crate::mid_sides::{CurvedSides, MidSides};
use crate::plane_mesher::{PlaneMesh, PlaneProblem, Region};
use crate::ring_radius::ring_radius_m;
use crate::thin_ring;
use gearmesh_geometry::blank::Lugs;
use gearmesh_geometry::{Element, GearDefinition, Openings, Slots};
use std::f64::consts::{FRAC_PI_2, TAU};
use std::iter;

/// Growth of element length with the distance from the ring, and from the hub.
const GRADING: f64 = 0.35;
/// Element length where the web meets the hub, as a share of the largest: stress is singular along that edge (see
/// [`crate::layers`]), and most of a twisted web's deformation is there.
const AT_HUB: f64 = 1.0 / 3.0;

/// Circles nearer to each other are one.
const SAME_M: f64 = 1e-9;

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

/// The first tooth of a sector such that the cut before it keeps clear of all openings.
pub(crate) fn first_tooth(gear: &GearDefinition) -> Result<usize, MeshError> {
    if gear.sectors() == 1 {
        return Ok(0);
    }
    let pitch = TAU / gear.tooth.teeth as f64;
    if let Some(lugs) = gear.blank.rim().and_then(|rim| rim.lugs) {
        // Far from the lugs' edges, at which nodes lie.
        let from_edge = |tooth: usize| {
            let middle = lugs.from_middle_rad((tooth as f64 - 0.5) * pitch);
            (middle - 0.5 * lugs.width_rad).abs()
        };
        let teeth = 0..gear.tooth.teeth / gear.sectors();
        return Ok(teeth.fold(0, |best, tooth| {
            match from_edge(tooth) > from_edge(best) + 1e-9 {
                true => tooth,
                false => best,
            }
        }));
    }
    let Some(openings) = gear.blank.openings() else {
        return Ok(0);
    };
    let repeat = TAU / openings.count() as f64;
    let clearance = |tooth: usize| {
        let angle = (tooth as f64 - 0.5) * pitch - openings.phase_rad();
        let from_centre = (angle - repeat * (angle / repeat).round()).abs();
        from_centre - openings.half_width_rad()
    };
    let teeth_per_sector = gear.tooth.teeth / gear.sectors();
    // Where several cuts are equally clear, the first is taken, so that the choice does not hang on rounding.
    let mut best = 0;
    for tooth in 1..teeth_per_sector {
        if clearance(tooth) > clearance(best) + 1e-9 {
            best = tooth;
        }
    }
    let needed = 0.2 * gear.tooth.module_m / openings.radii_m().0;
    if clearance(best) < needed {
        return Err(MeshError::NoCut {
            needed_deg: needed.to_degrees(),
            best_deg: clearance(best).to_degrees(),
        });
    }
    Ok(best)
}

/// Element length wanted at a radius of the body: from that of the ring's pieces inwards, shorter at the hub's circle
/// too. Towards the hole in the axis of a gear cut into its shaft no element is longer than the sector is wide.
pub(crate) fn element_length(gear: &GearDefinition, ring_size: f64) -> impl Fn(f64) -> f64 {
    let (ring, largest, web) = (ring_radius_m(gear), gear.mesh.body_m, gear.blank.web());
    let sector = gear
        .blank
        .cut_into_shaft()
        .map(|_| TAU / gear.sectors() as f64);
    move |r: f64| {
        let in_sector = sector.map_or(f64::INFINITY, |angle| r * angle);
        let from_ring = ring_size + GRADING * (ring - r).abs();
        let from_hub = web.map_or(f64::INFINITY, |web| {
            AT_HUB * largest + GRADING * (r - web.hub_radius_m).abs()
        });
        from_ring.min(from_hub).min(largest).min(in_sector)
    }
}

/// Places of a circle between the openings and the next one outside of them, as shares of the room there, in the order
/// in which they are tried: beside some gmsh finds poor quads only.
const CIRCLE_AT: [f64; 3] = [0.5, 0.6, 0.4];

/// Radii down to which a body that does not repeat may do so with its teeth \[m\], the one that is tried first ahead;
/// none of one that repeats, and where nothing lies between the ring below the teeth and the openings.
///
/// What is outside of it has the same mesh below every tooth: it is condensed once and joined to a ring by harmonics,
/// as the teeth are. Half way between the openings and the next circle outside of them, where a module is between
/// them, the mesh has become coarser, so that few nodes lie on the circle.
pub fn repeating_down_to_m(gear: &GearDefinition) -> Vec<f64> {
    let repeats = gear.sectors() > 1;
    let openings = gear.blank.openings();
    let openings = openings
        .filter(|_| !(repeats || gear.mesh.element == Element::Tet10 || gear.mesh.plane_strain));
    let Some((_, outer)) = openings.map(|openings| openings.radii_m()) else {
        return Vec::new();
    };
    let circles = region_circles(gear);
    let mut inwards_last = circles.iter().rev().map(|(r, _)| *r);
    let above = inwards_last.find(|r| *r > outer).unwrap_or(outer);
    let room = above - outer;
    let deep = if room >= gear.tooth.module_m {
        CIRCLE_AT.map(|share| outer + share * room).to_vec()
    } else {
        vec![above]
    };
    let ring = ring_radius_m(gear);
    deep.into_iter().filter(|r| *r < ring - SAME_M).collect()
}

/// Circles that separate the regions of the body, from the ring inwards, and whether the region below each is web only.
pub(crate) fn region_circles(gear: &GearDefinition) -> Vec<(f64, bool)> {
    let ring = ring_radius_m(gear);
    let mut levels = vec![(ring, false)];
    if let Some(web) = gear.blank.web() {
        if web.rim_inner_radius_m < ring - 1e-9 {
            levels.push((web.rim_inner_radius_m, true));
        } else {
            levels[0].1 = true;
        }
        // Where the contour has a kink, nodes lie.
        let kinks = gear
            .blank
            .contour()
            .into_iter()
            .flat_map(|contour| &contour.web);
        let inner = kinks.map(|point| point.radius_m).rev();
        levels.extend(
            inner
                .filter(|&r| r > web.hub_radius_m + 1e-9 && r < web.rim_inner_radius_m - 1e-9)
                .map(|r| (r, true)),
        );
        levels.push((web.hub_radius_m, false));
    }
    if let Some(shaft) = gear.blank.cut_into_shaft() {
        // Nodes lie on the outline of the faces at which the gear is held.
        let [a, b] = shaft.end_radii_m;
        for r in [a.max(b), a.min(b)] {
            let above = levels[levels.len() - 1].0;
            if r > shaft.hole_radius_m && r < above - SAME_M {
                levels.push((r, false));
            }
        }
    }
    levels.push((gear.blank.edge_radius_m(), false));
    levels
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

/// The circles of the body's regions within a span, as [`region_circles`].
fn circles_within(gear: &GearDefinition, [outer, inner]: [f64; 2]) -> Vec<(f64, bool)> {
    let all = region_circles(gear);
    let above = all.iter().rev().find(|(r, _)| *r >= outer - SAME_M);
    let mut levels = vec![(outer, above.is_some_and(|(_, web_below)| *web_below))];
    levels.extend(
        all.iter()
            .filter(|(r, _)| *r < outer - SAME_M && *r > inner + SAME_M),
    );
    levels.push((inner, false));
    levels
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
    let (sectors, first_tooth) = (span.sectors, span.first_tooth);
    let teeth = gear.tooth.teeth / sectors;
    let pitch = TAU / gear.tooth.teeth as f64;
    let start = (first_tooth as f64 - 0.5) * pitch;
    let angle = TAU / sectors as f64;
    let closed = sectors == 1;
    let wanted = element_length(gear, ring_size_m);
    let size = |r: f64| match lengths {
        BodyLengths::Wanted => wanted(r),
        BodyLengths::WithinSector => wanted(r).min(r * angle),
    };
    let levels = circles_within(gear, span.radii_m);
    // Pieces of a circle.
    let least = if closed { 8 } else { 2 };
    let in_a_region = |o: &Openings| {
        let within = |pair: &[(f64, bool)]| o.radii_m().1 < pair[0].0 && o.radii_m().0 > pair[1].0;
        levels.windows(2).any(within)
    };
    let in_span = |o: &Openings| o.radii_m().1 > span.radii_m[1];
    let openings = gear.blank.openings().filter(in_span);
    if let Some(openings) = openings.filter(|o| !in_a_region(o)) {
        let (inner, outer) = openings.radii_m();
        return Err(MeshError::OpeningsAcross {
            inner_mm: inner * 1e3,
            outer_mm: outer * 1e3,
        });
    }
    let openings_in = |i: usize| {
        let within = |o: &Openings| o.radii_m().1 < levels[i].0 && o.radii_m().0 > levels[i + 1].0;
        openings.filter(within)
    };
    let is_thin = |i: usize| {
        let (outer, inner) = (levels[i].0, levels[i + 1].0);
        let length = size(inner).min(inner * angle / least as f64);
        thin_ring::is_thin(outer, inner, length) && openings_in(i).is_none()
    };
    // The bore takes over the hub's number of pieces, so that the hub can be paved regularly.
    let is_regular = |i: usize| {
        let is_bore = i + 2 == levels.len() && levels[i + 1].0 <= gear.blank.edge_radius_m();
        is_bore && gear.blank.web().is_some()
    };
    let mut points: Vec<[f64; 3]> = Vec::new();
    let mut add = |r: f64, phi: f64| {
        points.push([r * phi.cos(), r * phi.sin(), size(r)]);
        points.len() - 1
    };
    let mut n = span.pieces * teeth;
    let circles: Vec<Vec<usize>> = levels
        .iter()
        .enumerate()
        .map(|(level, &(r, _))| {
            if level > 0 && !is_regular(level - 1) && !is_thin(level - 1) {
                // Free regions are meshed two boundary pieces at a time, and blossom needs an even number of those:
                // the outline of a region has a multiple of four pieces, of which two equal edges are even already.
                let outer = n;
                n = ((r * angle / size(r)).ceil() as usize)
                    .max(least)
                    .next_multiple_of(2);
                n += (n + outer) % 4;
            }
            let nodes = if closed { n } else { n + 1 };
            let mut places: Vec<f64> = (0..nodes)
                .map(|k| start + angle * k as f64 / n as f64)
                .collect();
            if let Some(lugs) = gear.blank.rim().and_then(|rim| rim.lugs)
                && level + 1 == levels.len()
            {
                move_to_edges(&mut places, &lugs, closed);
            }
            places.into_iter().map(|phi| add(r, phi)).collect()
        })
        .collect();
    let mut curved = CurvedSides::default();
    let mut right_side = Vec::new();
    let mut left_side = Vec::new();
    let mut regions = Vec::new();
    let mut web_region = Vec::new();
    let mut arcs: Vec<Vec<usize>> = Vec::new();
    for (i, pair) in circles.windows(2).enumerate() {
        let (outer, inner) = (&pair[0], &pair[1]);
        let mut loops = Vec::new();
        let even = Pieces {
            least: 2,
            even: true,
        };
        let radii = graded(levels[i].0, levels[i + 1].0, size, even);
        let steps = &radii[1..radii.len() - 1];
        let mut edges = [Vec::new(), Vec::new()];
        if closed {
            loops.push(outer.clone());
            loops.push(inner.clone());
        } else {
            let right: Vec<usize> = steps.iter().map(|&r| add(r, start)).collect();
            let left: Vec<usize> = steps.iter().map(|&r| add(r, start + angle)).collect();
            let mut outline = outer.clone();
            outline.extend(&left);
            outline.extend(inner.iter().rev());
            outline.extend(right.iter().rev());
            loops.push(outline);
            right_side.extend(&right);
            right_side.push(inner[0]);
            left_side.extend(&left);
            left_side.push(inner[inner.len() - 1]);
            edges = [right, left];
        }
        if let Some(openings) = openings_in(i) {
            let repeat = TAU / openings.count() as f64;
            let first = ((start - openings.phase_rad()) / repeat).ceil() as i64;
            for k in 0..(openings.count() / sectors) as i64 {
                let centre = openings.phase_rad() + repeat * (first + k) as f64;
                // Every other point is the middle of a side.
                let outline = opening_outline(&openings, gear.mesh.body_m);
                let (corners, middles): (Vec<_>, Vec<_>) = outline
                    .as_chunks()
                    .0
                    .iter()
                    .map(|&[(r, phi), middle]| (add(r, centre + phi), middle))
                    .unzip();
                for (k, (r, phi)) in middles.into_iter().enumerate() {
                    let (sin, cos) = (centre + phi).sin_cos();
                    let next = corners[(k + 1) % corners.len()];
                    curved.insert(corners[k], next, [r * cos, r * sin]);
                }
                loops.push(corners);
            }
        }
        let mut quads = Vec::new();
        if is_thin(i) || closed && is_regular(i) && openings_in(i).is_none() {
            let pieces = outer.len() - usize::from(!closed);
            let place = |k: usize| start + angle * k as f64 / pieces as f64;
            let between = thin_ring::circles(steps, &edges, outer.len(), |r, k| add(r, place(k)));
            arcs.extend(between.iter().cloned());
            let rows: Vec<&[usize]> = iter::once(&outer[..])
                .chain(between.iter().map(|circle| &circle[..]))
                .chain([&inner[..]])
                .collect();
            quads = thin_ring::quads(&rows, closed);
        }
        regions.push(Region {
            loops,
            corners: Vec::new(),
            quads,
        });
        web_region.push(levels[i].1);
    }
    for circle in circles.iter().chain(&arcs) {
        curved.insert_arcs(circle, closed, |n| [points[n][0], points[n][1]]);
    }
    Ok(BodyProblem {
        web_region,
        ring: circles[0].clone(),
        right_side,
        left_side,
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

/// Outline of an opening as (radius, polar angle from its centre): a multiple of four nodes, each followed by the
/// middle of the side after it.
fn opening_outline(openings: &Openings, body_m: f64) -> Vec<(f64, f64)> {
    match openings {
        Openings::Holes(h) => {
            let n = 2
                * ((TAU * h.radius_m / body_m.min(0.35 * h.radius_m)).ceil() as usize)
                    .next_multiple_of(4);
            (0..n)
                .map(|k| {
                    let a = TAU * k as f64 / n as f64;
                    cartesian_to_polar(
                        h.pitch_radius_m + h.radius_m * a.cos(),
                        h.radius_m * a.sin(),
                    )
                })
                .collect()
        }
        Openings::Slots(s) => slot_outline(s, body_m),
    }
}

fn cartesian_to_polar(x: f64, y: f64) -> (f64, f64) {
    (x.hypot(y), y.atan2(x))
}

/// Sides of a slot's corners over the corner's radius, and sides far from corners over the body's elements at least.
const AT_CORNER: f64 = 0.6;
const FAR_FROM_CORNER: f64 = 0.4;

/// A slot counter-clockwise from the middle of its outer arc: outer arc, corner, radial edge, corner, inner arc, ...
/// Sides are as long as the corners want, and longer with the distance from small ones; their middles stand between
/// the nodes.
fn slot_outline(s: &Slots, body_m: f64) -> Vec<(f64, f64)> {
    let (r_in, r_out, c, half) = (
        s.inner_radius_m,
        s.outer_radius_m,
        s.corner_radius_m,
        0.5 * s.width_rad,
    );
    let near = body_m.min(AT_CORNER * c);
    let far = near.max(FAR_FROM_CORNER * body_m);
    let size = |from_corner_m: f64| (near + GRADING * from_corner_m).min(far);
    let outer_centre = half - (c / (r_out - c)).asin();
    let inner_centre = half - (c / (r_in + c)).asin();
    // Places along a piece of the outline, each followed by the middle of the side after it.
    let sides = |from: f64, to: f64, corner: &dyn Fn(f64) -> f64, least: usize| -> Vec<f64> {
        let ends = graded(from, to, |x| size(corner(x)), Pieces { least, even: false });
        let with_middles = ends.windows(2).flat_map(|w| [w[0], 0.5 * (w[0] + w[1])]);
        with_middles.chain([to]).collect()
    };
    let corner = |radius: f64, angle: f64, from: f64, to: f64| -> Vec<(f64, f64)> {
        let n = 2 * ((c * (to - from).abs() / near).ceil() as usize).max(3);
        (0..=n)
            .map(|k| {
                let a = angle + from + (to - from) * k as f64 / n as f64;
                cartesian_to_polar(
                    radius * angle.cos() + c * a.cos(),
                    radius * angle.sin() + c * a.sin(),
                )
            })
            .collect()
    };
    // Upper half (positive angles): outer arc from the middle, corner, edge, corner, inner arc to the middle.
    let length = r_out * outer_centre;
    let outer = sides(0.0, length, &|x| length - x, 1);
    let mut upper: Vec<(f64, f64)> = (outer[..outer.len() - 1].iter())
        .map(|x| (r_out, x / r_out))
        .collect();
    let edge_turn = FRAC_PI_2 + half - outer_centre;
    upper.extend(corner(r_out - c, outer_centre, 0.0, edge_turn));
    let (from, to) = (
        ((r_out - c).powi(2) - c * c).sqrt(),
        ((r_in + c).powi(2) - c * c).sqrt(),
    );
    // Where the corners meet there is no edge between them.
    let edge = sides(from, to.min(from), &|r| (from - r).min(r - to).max(0.0), 1);
    upper.extend(edge[1..edge.len() - 1].iter().map(|r| (*r, half)));
    let inner_turn = FRAC_PI_2 + half - inner_centre;
    upper.extend(corner(
        r_in + c,
        inner_centre,
        inner_turn,
        std::f64::consts::PI,
    ));
    // The whole outline has twice as many sides as this half; an even half makes it a multiple of four.
    let length = r_in * inner_centre;
    let inner = |least: usize| sides(length, 0.0, &|x| length - x, least);
    let mut last = inner(1);
    let count = (last.len() - 1) / 2;
    if ((upper.len() - 1) / 2 + count) % 2 == 1 {
        last = inner(count + 1);
    }
    upper.extend(last[1..].iter().map(|x| (r_in, x / r_in)));
    let lower: Vec<(f64, f64)> = upper[1..upper.len() - 1]
        .iter()
        .rev()
        .map(|&(r, phi)| (r, -phi))
        .collect();
    upper.extend(lower);
    upper
}
