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

use crate::grading::{Pieces, graded};
use crate::mid_sides::{CurvedSides, MidSides};
use crate::plane_mesher::{PlaneMesh, PlaneProblem, Region};
use crate::ring_radius::ring_radius_m;
use crate::tooth_cell::ToothCell;
use gearmesh_elements::CellKind;
use gearmesh_geometry::{GearDefinition, ProfileCurve, RootPosition};
use std::f64::consts::PI;

/// Elements across the layer along the outline, and their growth inwards.
const LAYERS: usize = 3;
const LAYER_GROWTH: f64 = 1.35;
/// Thickness of that layer in fillet element lengths.
const LAYER_THICKNESS: f64 = 2.6;
/// The layer along the outline takes no more than this share of the ring.
const LAYER_SHARE: f64 = 0.6;
/// Growth of element length along the outline, per length.
const GRADING: f64 = 0.3;

/// Points collected for the mesher: coordinates and wanted size.
struct Points(Vec<[f64; 3]>);

impl Points {
    fn add(&mut self, p: [f64; 2]) -> usize {
        self.0.push([p[0], p[1], 1.0]);
        self.0.len() - 1
    }

    /// The mirror image of a list of points; points on the axis are shared.
    fn mirror(&mut self, list: &[usize]) -> Vec<usize> {
        list.iter()
            .map(|&i| {
                let [x, y, _] = self.0[i];
                if y == 0.0 { i } else { self.add([x, -y]) }
            })
            .collect()
    }
}

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
        let tooth = &gear.profile;
        let curve = ProfileCurve::new(tooth);
        let (h_fillet, h_flank) = (gear.mesh.fillet_m, gear.mesh.flank_m);
        let space = tooth.space_angle_rad();
        let polar = |r: f64, angle: f64| [r * angle.cos(), r * angle.sin()];

        // Outline nodes of the right half by arc length; the cut starts at one of them.
        let s_cut = curve
            .arc_length_at(RootPosition::TangentAngle(0.25 * PI))
            .unwrap_or_else(|_| 0.5 * curve.flank_start_m());
        let (s_form, s_end, s_tip) = (
            curve.flank_start_m(),
            curve.flank_end_m(),
            curve.tip_start_m(),
        );
        let size = |s: f64| (h_fillet + GRADING * (s - s_form).max(0.0)).min(h_flank);
        let root = graded(
            0.0,
            s_cut,
            size,
            Pieces {
                least: 3,
                even: false,
            },
        );
        let flank = graded(
            s_cut,
            s_end,
            size,
            Pieces {
                least: 4,
                even: false,
            },
        );
        let mut arcs: Vec<f64> = root.iter().chain(&flank[1..]).copied().collect();
        if s_tip > s_end {
            arcs.push(s_tip);
        }
        let n_root = root.len() - 1;
        let last = arcs.len() - 1;

        // Offset curve: along the normal, turning into the tip land at the tip.
        let tip_half = tooth.tip_half_angle_rad();
        let ring = ring_radius_m(gear);
        // From the outline into the body the radius falls, in a ring it grows.
        let outwards = tooth.tip_direction();
        let room = LAYER_SHARE * (tooth.root_radius_m - ring).abs();
        let thickness = (LAYER_THICKNESS * h_fillet).min(room);
        let tip_thickness = thickness.min(0.45 * tip_half * tooth.tip_radius_m);
        let outline_points: Vec<[f64; 2]> = arcs.iter().map(|&s| curve.point_at(s)).collect();
        let offset_points: Vec<[f64; 2]> = (0..=last)
            .map(|i| {
                let p = outline_points[i];
                if i == 0 {
                    return polar(p[0].hypot(p[1]) - outwards * thickness, space);
                }
                if i == last {
                    return polar(
                        tooth.tip_radius_m,
                        -tip_half + tip_thickness / tooth.tip_radius_m,
                    );
                }
                let ds = 1e-3 * h_fillet;
                let (a, b) = (curve.point_at(arcs[i] - ds), curve.point_at(arcs[i] + ds));
                let along = [b[0] - a[0], b[1] - a[1]];
                let length = along[0].hypot(along[1]);
                let normal = [-outwards * along[1] / length, outwards * along[0] / length];
                let w = if i > n_root {
                    ((arcs[i] - s_cut) / (s_tip - s_cut)).powi(3)
                } else {
                    0.0
                };
                let tip = polar(1.0, -tip_half + 0.5 * PI);
                let d = [
                    (1.0 - w) * normal[0] + w * tip[0],
                    (1.0 - w) * normal[1] + w * tip[1],
                ];
                let scale =
                    (thickness + (tip_thickness - thickness) * w.min(1.0)) / d[0].hypot(d[1]);
                [p[0] + scale * d[0], p[1] + scale * d[1]]
            })
            .collect();

        let mut points = Points(Vec::new());
        let outline: Vec<usize> = outline_points.iter().map(|&p| points.add(p)).collect();
        let offset: Vec<usize> = offset_points.iter().map(|&p| points.add(p)).collect();
        let shares: Vec<f64> = layer_shares();
        let across = |points: &mut Points, i: usize| -> Vec<usize> {
            let (p, q) = (outline_points[i], offset_points[i]);
            let mut line = vec![outline[i]];
            for &w in &shares {
                let straight = [p[0] + w * (q[0] - p[0]), p[1] + w * (q[1] - p[1])];
                let r = straight[0].hypot(straight[1]);
                // The layer's edge on the tip land lies on the tip circle.
                let scale = if i == last {
                    tooth.tip_radius_m / r
                } else {
                    1.0
                };
                line.push(points.add([straight[0] * scale, straight[1] * scale]));
            }
            line.push(offset[i]);
            line
        };
        let at_space = across(&mut points, 0);
        let at_cut = across(&mut points, n_root);
        let at_tip = across(&mut points, last);

        // Cut and tip land, each in n_width pieces from the offset curve to the centre line.
        let cut_start = offset_points[n_root];
        let cut_radius = cut_start[0].hypot(cut_start[1]);
        let cut_angle = cut_start[1].atan2(cut_start[0]);
        let n_width = ((cut_angle.abs() * cut_radius / h_flank).round() as usize).max(2);
        let arc = |points: &mut Points, r: f64, from: f64, first: usize| -> Vec<usize> {
            let mut list = vec![first];
            list.extend(
                (1..n_width)
                    .map(|k| points.add(polar(r, from * (1.0 - k as f64 / n_width as f64)))),
            );
            list.push(points.add([r, 0.0]));
            list
        };
        let cut_half = arc(&mut points, cut_radius, cut_angle, offset[n_root]);
        let tip_angle = -tip_half + tip_thickness / tooth.tip_radius_m;
        let tip_half_line = arc(&mut points, tooth.tip_radius_m, tip_angle, offset[last]);

        // On to the circle where the body begins.
        let start_radius = tooth.root_radius_m - outwards * thickness;
        let depth = (start_radius - ring).abs();
        let n_depth = ((depth / h_flank.max(2.0 * h_fillet)).ceil() as usize).max(2);
        let mut right_down = vec![offset[0]];
        right_down.extend((1..=n_depth).map(|k| {
            points.add(polar(
                start_radius - outwards * depth * k as f64 / n_depth as f64,
                space,
            ))
        }));
        let corner = right_down[n_depth];
        let n_bottom = n_root + n_width;
        let mut bottom_half = vec![corner];
        bottom_half.extend(
            (1..n_bottom)
                .map(|k| points.add(polar(ring, space * (1.0 - k as f64 / n_bottom as f64)))),
        );
        bottom_half.push(points.add([ring, 0.0]));

        // The left half is the mirror image, piece by piece through one table of mirrored points.
        let count = points.0.len();
        let all: Vec<usize> = (0..count).collect();
        let image = points.mirror(&all);
        let m = |list: &[usize]| -> Vec<usize> { list.iter().map(|&i| image[i]).collect() };

        let (root_line, flank_line) = (&outline[..=n_root], &outline[n_root..]);
        let (root_offset, flank_offset) = (&offset[..=n_root], &offset[n_root..]);
        let region = |loop_points: Vec<usize>, corners: [usize; 4]| Region {
            loops: vec![loop_points],
            corners: corners.to_vec(),
            quads: Vec::new(),
        };
        let layer = |line: &[usize], inner: &[usize], start: &[usize], end: &[usize]| {
            region(
                joined(&[line, end, &reversed(inner), &reversed(start)]),
                [
                    line[0],
                    line[line.len() - 1],
                    inner[inner.len() - 1],
                    inner[0],
                ],
            )
        };
        let core_tooth = region(
            joined(&[
                flank_offset,
                &tip_half_line,
                &reversed(&m(&tip_half_line)),
                &reversed(&m(flank_offset)),
                &m(&cut_half),
                &reversed(&cut_half),
            ]),
            [
                offset[n_root],
                offset[last],
                image[offset[last]],
                image[offset[n_root]],
            ],
        );
        let core_under = region(
            joined(&[
                &bottom_half,
                &reversed(&m(&bottom_half)),
                &reversed(&m(&right_down)),
                &m(root_offset),
                &m(&cut_half),
                &reversed(&cut_half),
                &reversed(root_offset),
                &right_down,
            ]),
            [corner, image[corner], image[offset[0]], offset[0]],
        );
        let regions = vec![
            layer(root_line, root_offset, &at_space, &at_cut),
            layer(flank_line, flank_offset, &at_cut, &at_tip),
            layer(&m(root_line), &m(root_offset), &m(&at_space), &m(&at_cut)),
            layer(&m(flank_line), &m(flank_offset), &m(&at_cut), &m(&at_tip)),
            core_tooth,
            core_under,
        ];

        let half_length = curve.length_m();
        let tip_arcs: Vec<f64> = at_tip[1..]
            .iter()
            .chain(&tip_half_line[1..])
            .map(|&i| {
                let [x, y, _] = points.0[i];
                s_tip + (y.atan2(x) + tip_half) * tooth.tip_radius_m
            })
            .collect();
        let right_outline = joined(&[&outline, &at_tip, &tip_half_line]);
        let mut right_arcs = arcs;
        right_arcs.extend(tip_arcs);
        let outline_all = joined(&[&right_outline, &reversed(&m(&right_outline))]);
        let left_arcs: Vec<f64> = right_arcs
            .iter()
            .rev()
            .skip(1)
            .map(|s| 2.0 * half_length - s)
            .collect();
        right_arcs.extend(left_arcs);
        let side = joined(&[&at_space, &right_down]);
        let bottom = joined(&[&bottom_half, &reversed(&m(&bottom_half))]);
        let mut curved = CurvedSides::default();
        for (nodes, arcs) in outline_all.windows(2).zip(right_arcs.windows(2)) {
            let arc = 0.5 * (arcs[0] + arcs[1]);
            let [x, y] = curve.point_at(arc.min(2.0 * half_length - arc));
            let y = if arc > half_length { -y } else { y };
            curved.insert(nodes[0], nodes[1], [x, y]);
        }
        curved.insert_arcs(&bottom, false, |n| [points.0[n][0], points.0[n][1]]);
        Self {
            curved,
            outline_arc_m: right_arcs,
            outline: outline_all,
            cut: joined(&[
                &at_cut,
                &cut_half,
                &reversed(&m(&cut_half)),
                &reversed(&m(&at_cut)),
            ]),
            bottom,
            left_side: m(&side),
            right_side: side,
            problem: PlaneProblem {
                name: "tooth".into(),
                points: points.0,
                regions,
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

/// Inner positions of the layers along the outline as shares of its thickness.
fn layer_shares() -> Vec<f64> {
    let total: f64 = (0..LAYERS).map(|k| LAYER_GROWTH.powi(k as i32)).sum();
    (1..LAYERS)
        .map(|k| (0..k).map(|j| LAYER_GROWTH.powi(j as i32)).sum::<f64>() / total)
        .collect()
}
