//! How large the mesh of a gear will be, from its definition alone, before gmsh is asked.
//!
//! The blocks of a tooth are structured and their edges are placed by [`ToothBlocks`]: their quads are counted. The
//! body is meshed freely between circles whose element lengths are given: gmsh carries these lengths inwards, so that
//! the quads between two circles lie between the integral of dA/h² with the wanted length h, which grows with the
//! distance from both, and the same with a length that runs linearly from one circle to the other. Their geometric mean
//! is taken; how far it is off stands in docs/theory/reduction.md.

use crate::MeshError;
use crate::body_circles::{element_length, region_circles, repeating_down_to_m};
use crate::grading::{Pieces, graded};
use crate::layers::Layers;
use crate::ring_radius::ring_radius_m;
use crate::solid_problem::THROUGH_WEB;
use crate::tooth_blocks::ToothBlocks;
use gearmesh_geometry::{Element, GearDefinition, Openings, Web};
use std::f64::consts::{PI, TAU};

/// Radii at which an integral over a region takes its integrand.
const SAMPLES: usize = 200;
/// Nodes of a free mesh of ten-node tetrahedra in the volume of an element length cubed: 1.4 corners and seven edges at
/// each.
const TET_NODES: f64 = 11.0;
/// Tetrahedra likewise.
const TETRAHEDRA: f64 = 7.0;

/// Tetrahedra of a sector of the body that are begun. Chosen, not measured: far above what bodies with
/// sensible element lengths have.
const MOST_TETRAHEDRA: f64 = 1e6;

/// Sizes of a mesh and of its parts, estimated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshSize {
    /// Nodes.
    pub nodes: f64,
    /// Elements.
    pub elements: f64,
    /// Those of all teeth with the ring below them.
    pub tooth_elements: f64,
    /// Nodes of one tooth with the ring below it.
    pub tooth_nodes: f64,
    /// Those of them that it shares with the rest.
    pub foot_nodes: f64,
    /// Those of these that it shares with the next tooth.
    pub side_nodes: f64,
    /// Nodes of hub, web and rim of one sector.
    pub body_nodes: f64,
    /// Nodes of the circle on which the teeth stand.
    pub circle_nodes: f64,
    /// Nodes of the cut between two sectors; none where one sector is the whole gear.
    pub cut_nodes: f64,
}

/// Corners of quads, and quads, of a part of the cross-section.
#[derive(Debug, Clone, Copy, Default)]
struct Quads {
    corners: f64,
    quads: f64,
}

impl MeshSize {
    /// Estimates the mesh of a gear. A gear that was meshed elsewhere has none to estimate.
    pub fn estimate(gear: &GearDefinition) -> Option<Self> {
        if gear.blank.meshed().is_some() {
            return None;
        }
        let layers = Layers::new(gear);
        let all = layers.face.len() as f64;
        let web = gear.blank.web();
        let in_web = web.map_or(all, |_| layers.web.len() as f64);
        let blocks = ToothBlocks::new(gear);
        let (teeth, sectors) = (gear.tooth.teeth as f64, gear.sectors() as f64);
        let side = blocks.side_pieces() as f64 + 1.0;
        let ring = blocks.ring_pieces() as f64;
        let cell = structured(&blocks);
        let element = gear.mesh.element;
        let ring_size = ring_radius_m(gear) * TAU / teeth / ring;
        let column = |corners: f64, layers: f64| corners * nodes_a_corner(element, layers);
        let tooth_nodes = column(cell.corners, all);
        let own_nodes = column(cell.corners - side, all);
        let tooth_elements = teeth * cell.quads * all * elements_a_brick(element);
        let mut size = Self {
            nodes: teeth * own_nodes,
            elements: tooth_elements,
            tooth_elements,
            tooth_nodes,
            foot_nodes: 0.0,
            side_nodes: column(side, all),
            body_nodes: 0.0,
            circle_nodes: 0.0,
            cut_nodes: column(side, all),
        };
        let (circles, deep) = circles_down(gear);
        let below = if circles[0].1 { in_web } else { all };
        size.circle_nodes = teeth * column(ring, below);
        let length = element_length(gear, ring_size);
        let (mut body_nodes, mut below_teeth) = (0.0, 0.0);
        for pair in circles.windows(2) {
            let ((outer, web_only), (inner, _)) = (pair[0], pair[1]);
            let stubs = (0..layers.count()).filter(|&layer| {
                let radius = layers.stub_radius_m(layer);
                radius.is_some_and(|radius| outer < radius * (1.0 + 1e-6))
            });
            let layers = match web_only {
                true => in_web,
                false => all + stubs.count() as f64,
            };
            if element == Element::Tet10 {
                let region = (outer, inner, web_only);
                let [nodes, tetrahedra, cut] = free_tetrahedra(gear, region, &length);
                body_nodes += nodes;
                size.elements += tetrahedra;
                size.cut_nodes += cut;
                continue;
            }
            let radial = graded(outer, inner, &length, Pieces::EVEN).len() as f64 - 1.0;
            let quads = match web {
                // As many pieces on all circles.
                Some(web) if web.hub_radius_m == outer => radial * TAU * outer / length(outer),
                _ => free_quads(gear, outer, inner, &length),
            };
            size.elements += quads * layers;
            if deep.is_some_and(|deep| inner >= deep) {
                // Part of the cells of the teeth, which share their sides.
                below_teeth += column(quads, layers);
                size.tooth_nodes += column(quads / teeth + radial, layers);
                size.side_nodes += column(radial, layers);
                let pieces = (inner * TAU / teeth / length(inner) / 2.0).ceil() * 2.0;
                size.circle_nodes = teeth * column(pieces, layers);
                continue;
            }
            body_nodes += column(quads, layers);
            size.cut_nodes += column(radial, layers);
        }
        size.nodes += body_nodes + below_teeth;
        size.foot_nodes = 2.0 * size.side_nodes + size.circle_nodes / teeth;
        size.body_nodes = body_nodes / sectors;
        if sectors == 1.0 {
            size.cut_nodes = 0.0;
        }
        Some(size)
    }
}

/// Circles between regions, outermost first, with whether the web alone lies below each; and how far down all repeats
/// with the teeth.
fn circles_down(gear: &GearDefinition) -> (Vec<(f64, bool)>, Option<f64>) {
    let mut circles = region_circles(gear);
    let deep = repeating_down_to_m(gear).first().copied();
    if let Some(deep) = deep {
        let inside = circles.iter().position(|(radius, _)| *radius < deep);
        let at = inside.unwrap_or(circles.len());
        circles.insert(at, (deep, circles[at - 1].1));
        // Between two circles of one radius there is nothing.
        circles.dedup_by(|inner, outer| inner.0 >= outer.0);
    }
    (circles, deep)
}

/// Nodes, tetrahedra and nodes of the cut of a region between two circles.
fn free_tetrahedra(
    gear: &GearDefinition,
    (outer, inner, web_only): (f64, f64, bool),
    length: &impl Fn(f64) -> f64,
) -> [f64; 3] {
    let share = web_share(gear, web_only);
    let thin = thinnest(gear, web_only);
    let volume = cubes(gear, outer, inner, &|r| length(r).min(thin)) * share;
    let across = (outer - inner) * gear.tooth.face_width_m * share;
    [
        TET_NODES * volume,
        TETRAHEDRA * volume,
        4.0 * across / gear.mesh.body_m.powi(2),
    ]
}

/// Refuses a body of tetrahedra that would take gmsh longer than it is given.
///
/// # Errors
/// [`MeshError::TooManyTetrahedra`].
pub(crate) fn demand_few_tetrahedra(gear: &GearDefinition) -> Result<(), MeshError> {
    let (Some(size), true) = (
        MeshSize::estimate(gear),
        gear.mesh.element == Element::Tet10,
    ) else {
        return Ok(());
    };
    let in_body = size.elements - size.tooth_elements;
    let estimated = in_body / gear.sectors() as f64;
    if estimated <= MOST_TETRAHEDRA {
        return Ok(());
    }
    let thin = thinnest(gear, true);
    let (key, advice) = if thin < gear.mesh.body_m {
        let key = match gear.blank.contour() {
            Some(_) => "blank.web",
            None => "blank.web_thickness_mm",
        };
        let advice = "make the web thicker, or set mesh.element = \"hex8-incompatible\", whose layers may be thin";
        (key, advice)
    } else {
        ("mesh.body_mm", "take longer ones")
    };
    Err(MeshError::TooManyTetrahedra {
        key,
        estimated,
        allowed: MOST_TETRAHEDRA,
        length_mm: 1e3 * thin.min(gear.mesh.body_m),
        advice,
    })
}

/// Longest element through the thickness of the web (m).
fn thinnest(gear: &GearDefinition, web_only: bool) -> f64 {
    let thickness = |web: Web| match gear.blank.contour() {
        Some(contour) => (contour.web.iter())
            .map(|point| point.z_m[1] - point.z_m[0])
            .fold(f64::INFINITY, f64::min),
        None => web.thickness_m,
    };
    let web = gear.blank.web().filter(|_| web_only);
    web.map_or(f64::INFINITY, |web| thickness(web) / THROUGH_WEB)
}

/// Nodes above a corner of the cross-section, with those in the middles of the sides (as many as two corners have) and,
/// in split bricks, of the quads.
fn nodes_a_corner(element: Element, layers: f64) -> f64 {
    match element {
        Element::Tet10 => 4.0 * (2.0 * layers + 1.0),
        _ if element.cell().is_quadratic() => 4.0 * layers + 3.0,
        _ => layers + 1.0,
    }
}

/// Elements in a layer above a quad of the teeth.
fn elements_a_brick(element: Element) -> f64 {
    match element {
        Element::Tet10 => crate::tet_split::TETRAHEDRA as f64,
        _ => 1.0,
    }
}

/// The structured blocks of a tooth: each has as many quads as its edges have pieces, multiplied.
fn structured(blocks: &ToothBlocks) -> Quads {
    let mut size = Quads {
        corners: blocks.problem.points.len() as f64,
        quads: 0.0,
    };
    for region in &blocks.problem.regions {
        let outline = &region.loops[0];
        let place = |corner: usize| outline.iter().position(|&p| p == corner).unwrap_or(0);
        let along = place(region.corners[1]).abs_diff(place(region.corners[0]));
        let along = along.min(outline.len() - along);
        let across = outline.len() / 2 - along;
        size.quads += (along * across) as f64;
        size.corners += ((along - 1) * (across - 1)) as f64;
    }
    size
}

/// Share of a ring of the body that openings leave.
fn open_share(gear: &GearDefinition, outer: f64, inner: f64) -> f64 {
    let Some(openings) = gear.blank.openings() else {
        return 1.0;
    };
    let (r_in, r_out) = openings.radii_m();
    if r_in >= outer || r_out <= inner {
        return 1.0;
    }
    let area = match openings {
        Openings::Holes(holes) => holes.count as f64 * PI * holes.radius_m.powi(2),
        Openings::Slots(slots) => {
            0.5 * slots.count as f64 * slots.width_rad * (r_out.powi(2) - r_in.powi(2))
        }
    };
    (1.0 - area / (PI * (outer.powi(2) - inner.powi(2)))).clamp(0.0, 1.0)
}

/// Share of the face width that the body fills between two circles.
fn web_share(gear: &GearDefinition, web_only: bool) -> f64 {
    match gear.blank.web() {
        Some(web) if web_only => web.thickness_m / gear.tooth.face_width_m,
        _ => 1.0,
    }
}

/// ∫ f(r) dr between two circles.
fn over_radius(outer: f64, inner: f64, f: impl Fn(f64) -> f64) -> f64 {
    let step = (outer - inner) / SAMPLES as f64;
    (0..SAMPLES)
        .map(|k| step * f(inner + (k as f64 + 0.5) * step))
        .sum()
}

/// Quads of a free mesh between two circles.
fn free_quads(gear: &GearDefinition, outer: f64, inner: f64, length: &impl Fn(f64) -> f64) -> f64 {
    let (at_outer, at_inner) = (length(outer), length(inner));
    let wanted = over_radius(outer, inner, |r| TAU * r / length(r).powi(2));
    let linear = over_radius(outer, inner, |r| {
        let share = (outer - r) / (outer - inner);
        TAU * r / (at_outer + share * (at_inner - at_outer)).powi(2)
    });
    (wanted * linear).sqrt() * open_share(gear, outer, inner)
}

/// Volume between two circles over the whole width, in element lengths cubed.
fn cubes(gear: &GearDefinition, outer: f64, inner: f64, length: &impl Fn(f64) -> f64) -> f64 {
    let width = gear.tooth.face_width_m;
    over_radius(outer, inner, |r| TAU * r * width / length(r).powi(3))
        * open_share(gear, outer, inner)
}
