//! Where the body is cut: circles between its regions, the first tooth of a sector, and the element length at a radius.

use crate::MeshError;
use crate::ring_radius::ring_radius_m;
use gearmesh_geometry::{Element, GearDefinition};
use std::f64::consts::TAU;

/// Growth of element length with the distance from the ring, and from the hub.
pub(crate) const GRADING: f64 = 0.35;
/// Element length where the web meets the hub, as a share of the largest: stress is singular along that edge (see
/// [`crate::layers`]), and most of a twisted web's deformation is there.
const AT_HUB: f64 = 1.0 / 3.0;
/// Circles nearer to each other are one.
const SAME_M: f64 = 1e-9;

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

/// The circles of the body's regions within a span, as [`region_circles`].
pub(crate) fn circles_within(gear: &GearDefinition, [outer, inner]: [f64; 2]) -> Vec<(f64, bool)> {
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
