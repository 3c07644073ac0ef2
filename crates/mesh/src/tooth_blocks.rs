//! One tooth with the ring below it, in blocks that follow its outline.
//!
//! ```text
//!          T-T'----Tc----T'-T          L  three layers of elements along the whole outline
//!         / |             | \          coreT  inside of the tooth, above the cut
//!        / L|    coreT    |L \         coreU  below it, down to the ring's inner circle
//!       /  P'-----Pc-----P'   \        P  where the outline makes 45 degrees with the centre line
//!  A---P  /               \  P---A     P-P'-Pc-P'-P  the cut of the tooth-only submodel
//!  A'----'     coreU       '----A'     A  centre of the tooth space
//!  +-----------------------------+
//! ```
//! The cut does not run along the root circle: the fillet is tangent to it there, and elements between the two
//! would have a zero angle (docs/decisions/0002-submodel-cut.md).

use crate::mid_sides::{CurvedSides, MidSides};
use crate::plane_mesher::{PlaneMesh, PlaneProblem, Region};
use crate::tooth_cell::ToothCell;
use crate::tooth_lines::HalfLines;
use gearmesh_elements::CellKind;
use gearmesh_geometry::{GearDefinition, ProfileCurve};

/// The blocks of one tooth, ready for the mesher.
pub struct ToothBlocks {
    /// What the mesher gets.
    pub problem: PlaneProblem,
    pub(crate) outline: Vec<usize>,
    pub(crate) outline_arc_m: Vec<f64>,
    pub(crate) cut: Vec<usize>,
    bottom: Vec<usize>,
    right_side: Vec<usize>,
    left_side: Vec<usize>,
    curved: CurvedSides,
}

impl ToothBlocks {
    /// Places the nodes on all block edges.
    pub fn new(gear: &GearDefinition) -> Self {
        let curve = ProfileCurve::new(&gear.profile);
        let lines = HalfLines::new(gear, &curve);
        // The left half is the mirror image, piece by piece through one table of mirrored points.
        let mut points = lines.points.clone();
        let image = mirrored(&mut points);
        let m = |list: &[usize]| -> Vec<usize> { list.iter().map(|&i| image[i]).collect() };
        let there_and_back = |half: &[usize]| joined(&[half, &reversed(&m(half))]);

        let right_outline = joined(&[&lines.outline, &lines.at_tip, &lines.tip_land]);
        let outline = there_and_back(&right_outline);
        let length = 2.0 * curve.length_m();
        let mut outline_arc_m = lines.arcs_to_centre(&gear.profile, curve.tip_start_m());
        let left_arcs = outline_arc_m.iter().rev().skip(1).map(|s| length - s);
        let left_arcs: Vec<f64> = left_arcs.collect();
        outline_arc_m.extend(left_arcs);

        let bottom = there_and_back(&lines.bottom);
        let mut curved = CurvedSides::default();
        for (nodes, arcs) in outline.windows(2).zip(outline_arc_m.windows(2)) {
            let arc = 0.5 * (arcs[0] + arcs[1]);
            let [x, y] = curve.point_at(arc.min(length - arc));
            let y = if arc > 0.5 * length { -y } else { y };
            curved.insert(nodes[0], nodes[1], [x, y]);
        }
        curved.insert_arcs(&bottom, false, |n| [points[n][0], points[n][1]]);
        let right_side = joined(&[&lines.at_space, &lines.down]);
        Self {
            curved,
            outline_arc_m,
            outline,
            cut: there_and_back(&joined(&[&lines.at_cut, &lines.cut])),
            bottom,
            left_side: m(&right_side),
            right_side,
            problem: PlaneProblem {
                name: "tooth".into(),
                regions: regions(&lines, &image),
                points,
                largest: 1.0,
            },
        }
    }

    /// Number of pieces of the ring's inner circle that belong to one tooth.
    pub fn ring_pieces(&self) -> usize {
        self.bottom.len() - 1
    }

    /// Number of pieces of the edge that a tooth shares with the next one.
    pub fn side_pieces(&self) -> usize {
        self.right_side.len() - 1
    }

    /// Puts the mesher's quads to the blocks, with nodes in the middle of their sides for quadratic elements.
    pub fn finish(self, mut mesh: PlaneMesh, shape: CellKind) -> ToothCell {
        let above_cut = mesh
            .owners
            .iter()
            .map(|&region| matches!(region, 1 | 3 | 4))
            .collect();
        let outline_quads = self
            .outline
            .windows(2)
            .map(|edge| {
                mesh.quads
                    .iter()
                    .position(|q| q.contains(&edge[0]) && q.contains(&edge[1]))
                    .unwrap_or(0)
            })
            .collect();
        let middles = (shape.is_quadratic()).then(|| MidSides::add(&mut mesh, &self.curved));
        let centres = match shape {
            CellKind::Tet10 => mesh.add_centres(),
            _ => Vec::new(),
        };
        let quad_count = mesh.quads.len();
        let chain = |corners: Vec<usize>| match &middles {
            None => corners,
            Some(middles) => middles.interleaved(&corners, false),
        };
        ToothCell {
            outline_mid_sides: middles
                .as_ref()
                .map_or_else(Vec::new, |middles| middles.along(&self.outline)),
            cut: chain(self.cut),
            bottom: chain(self.bottom),
            right_side: chain(self.right_side),
            left_side: chain(self.left_side),
            nodes: mesh.nodes,
            quads: mesh.quads,
            mid_sides: mesh.mid_sides,
            centres,
            web_only: vec![false; quad_count],
            above_cut,
            outline: self.outline,
            outline_arc_m: self.outline_arc_m,
            outline_quads,
        }
    }
}

/// The regions of the picture above: four layers along the outline, the core above the cut, the core below it.
/// `image` has the mirror image of each point of the right half.
fn regions(lines: &HalfLines, image: &[usize]) -> Vec<Region> {
    let m = |list: &[usize]| -> Vec<usize> { list.iter().map(|&i| image[i]).collect() };
    let across = |half: &[usize]| joined(&[half, &reversed(&m(half))]);
    let region = |loop_points: Vec<usize>, corners: [usize; 4]| Region {
        loops: vec![loop_points],
        corners: corners.to_vec(),
        quads: Vec::new(),
    };
    let layer = |line: &[usize], inner: &[usize], start: &[usize], end: &[usize]| {
        let corners = [
            line[0],
            line[line.len() - 1],
            inner[inner.len() - 1],
            inner[0],
        ];
        region(
            joined(&[line, end, &reversed(inner), &reversed(start)]),
            corners,
        )
    };
    let at_cut = lines.cut_position;
    let (root_line, flank_line) = (&lines.outline[..=at_cut], &lines.outline[at_cut..]);
    let (root_offset, flank_offset) = (&lines.offset[..=at_cut], &lines.offset[at_cut..]);
    let (space, cut, tip) = (&lines.at_space, &lines.at_cut, &lines.at_tip);
    let cut_back = joined(&[&m(&lines.cut), &reversed(&lines.cut)]);
    let ends = |first: usize, last: usize| [first, last, image[last], image[first]];
    let offset_at = |place: usize| lines.offset[place];
    let core_tooth = region(
        joined(&[
            flank_offset,
            &across(&lines.tip_land),
            &reversed(&m(flank_offset)),
            &cut_back,
        ]),
        ends(offset_at(at_cut), offset_at(lines.offset.len() - 1)),
    );
    let [corner, space_corner] = [lines.bottom[0], lines.offset[0]];
    let core_under = region(
        joined(&[
            &across(&lines.bottom),
            &reversed(&m(&lines.down)),
            &m(root_offset),
            &cut_back,
            &reversed(root_offset),
            &lines.down,
        ]),
        [corner, image[corner], image[space_corner], space_corner],
    );
    vec![
        layer(root_line, root_offset, space, cut),
        layer(flank_line, flank_offset, cut, tip),
        layer(&m(root_line), &m(root_offset), &m(space), &m(cut)),
        layer(&m(flank_line), &m(flank_offset), &m(cut), &m(tip)),
        core_tooth,
        core_under,
    ]
}

/// Adds the mirror image of every point; gives its place. Points on the axis are their own image.
fn mirrored(points: &mut Vec<[f64; 3]>) -> Vec<usize> {
    (0..points.len())
        .map(|i| match points[i] {
            [_, 0.0, _] => i,
            [x, y, size] => {
                points.push([x, -y, size]);
                points.len() - 1
            }
        })
        .collect()
}

/// Lines one after the other, a point that two of them share once.
fn joined(parts: &[&[usize]]) -> Vec<usize> {
    let mut list: Vec<usize> = Vec::new();
    for part in parts {
        for &p in *part {
            if list.last() != Some(&p) {
                list.push(p);
            }
        }
    }
    if list.len() > 1 && list.first() == list.last() {
        list.pop();
    }
    list
}

fn reversed(list: &[usize]) -> Vec<usize> {
    list.iter().rev().copied().collect()
}
