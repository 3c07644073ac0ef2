//! A finely graded cross-section of the tooth above the cut, for a narrow load at one place of its right flank.
//!
//! One mapped block: rows follow the outline from the cut to the tip corner, columns cross the tooth from the loaded to
//! the opposite side. Both are graded towards the load, so that no mesher is needed and every column begins at a
//! node of the exact outline. Coons' patch between the four edges:
//!
//! ```text
//! X(s, t) = (1−t) R(s) + t L(s) + (1−s) B(t) + s T(t) − (corners, bilinear)
//! ```
//!
//! with R the right and L the left outline, B the cut as the gear's own mesh has it, T the tip land.

use crate::cut_line::CutLine;
use crate::grading::{Pieces, graded};
use crate::plane::{apart, arc_lengths, coons, lerp};
use gearmesh_geometry::{ProfileCurve, ToothGeometry};

/// How finely a [`ContactSection`] is meshed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactGrading {
    /// Element length at the load \[m\], along the flank and into the tooth.
    pub smallest_m: f64,
    /// Along the flank the element length stays the smallest up to this distance from the load's centre \[m\].
    pub plateau_m: f64,
    /// Growth of the element length per length, no unit, 0 to 0.5.
    pub growth: f64,
    /// Largest element length \[m\].
    pub largest_m: f64,
}

/// Quads of the tooth above the cut with a node where the load's centre is.
#[derive(Debug, Clone)]
pub struct ContactSection {
    /// \[x, y\] \[m\], tooth centred on +x.
    pub nodes: Vec<[f64; 2]>,
    /// Node numbers, counter-clockwise.
    pub quads: Vec<[usize; 4]>,
    /// Nodes of the loaded outline, from the cut to the tip corner.
    pub outline: Vec<usize>,
    /// Their arc lengths from the centre of the right tooth space \[m\].
    pub outline_arc_m: Vec<f64>,
    /// Element length at the load \[m\].
    pub smallest_m: f64,
    /// Which of them is the load's centre.
    pub centre: usize,
    /// Nodes of the cut and of the opposite side, tip corner included: the supports of the tooth-only submodel.
    pub held: Vec<usize>,
}

/// The tooth above the cut by its four edges, the loaded side clockwise of the other.
pub struct ToothEdges<'a> {
    /// The loaded outline by its arc length.
    pub loaded: &'a dyn Fn(f64) -> [f64; 2],
    /// The other one by its share of the way from the cut to the tip.
    pub opposite: &'a dyn Fn(f64) -> [f64; 2],
    /// The tip land by the share of the way from the loaded side.
    pub tip: &'a dyn Fn(f64) -> [f64; 2],
    /// The cut from the loaded side to the other.
    pub cut: &'a [[f64; 2]],
    /// Arc lengths of the loaded outline: the cut, the beginning and the end of the flank, the tip corner.
    pub marks_m: [f64; 4],
}

impl ContactSection {
    /// Meshes the tooth above a cut for a load on the right flank at an arc length from the tooth space.
    ///
    /// `centre_arc_m` is taken to lie on the involute; beyond its ends it is moved there.
    pub fn new(
        tooth: &ToothGeometry,
        curve: &ProfileCurve,
        cut: &CutLine,
        centre_arc_m: f64,
        grading: ContactGrading,
    ) -> Self {
        let marks_m = [
            cut.arc_m,
            curve.flank_start_m(),
            curve.flank_end_m(),
            curve.tip_start_m(),
        ];
        let tip_half = tooth.tip_half_angle_rad();
        let edges = ToothEdges {
            loaded: &|arc| curve.point_at(arc),
            opposite: &|share| {
                let p = curve.point_at(marks_m[0] + share * (marks_m[3] - marks_m[0]));
                [p[0], -p[1]]
            },
            tip: &|share| {
                let angle = tip_half * (2.0 * share - 1.0);
                [
                    tooth.tip_radius_m * angle.cos(),
                    tooth.tip_radius_m * angle.sin(),
                ]
            },
            cut: &cut.points_m,
            marks_m,
        };
        Self::of_edges(&edges, centre_arc_m, grading)
    }

    /// The same of any tooth.
    pub fn of_edges(edges: &ToothEdges<'_>, centre_arc_m: f64, grading: ContactGrading) -> Self {
        let [s_cut, s_start, s_end, s_tip] = edges.marks_m;
        let cut = Polyline::new(edges.cut.to_vec());
        let s_centre = centre_arc_m.clamp(s_start, s_end);
        let growing = |distance: f64| {
            (grading.smallest_m + grading.growth * distance.max(0.0)).min(grading.largest_m)
        };

        let along = |s: f64| growing((s - s_centre).abs() - grading.plateau_m);
        let arcs = rows(s_cut, [s_centre, s_end, s_tip], along, grading.smallest_m);
        let centre = arcs.partition_point(|&s| s < s_centre - 1e-3 * grading.smallest_m);
        let share_of = |arc: f64| (arc - s_cut) / (s_tip - s_cut);

        // Columns, graded by the depth below the load.
        let (at, beyond) = (
            (edges.loaded)(s_centre),
            (edges.opposite)(share_of(s_centre)),
        );
        let width = apart(beyond, at);
        let shares: Vec<f64> = graded(0.0, width, growing, Pieces::at_least(4))
            .into_iter()
            .map(|depth| depth / width)
            .collect();

        let right: Vec<[f64; 2]> = arcs.iter().map(|&s| (edges.loaded)(s)).collect();
        let left: Vec<[f64; 2]> = arcs
            .iter()
            .map(|&s| (edges.opposite)(share_of(s)))
            .collect();
        let last = arcs.len() - 1;
        let columns = shares.len();
        let corners = [[right[0], left[0]], [right[last], left[last]]];
        let mut nodes = Vec::with_capacity(arcs.len() * columns);
        for ((&arc, &r), &l) in arcs.iter().zip(&right).zip(&left) {
            let s = share_of(arc);
            for &t in &shares {
                let sides = [cut.at(t), (edges.tip)(t)];
                nodes.push(coons([r, l], sides, corners, (s, t)));
            }
        }
        let mut quads = Vec::with_capacity((arcs.len() - 1) * (columns - 1));
        for i in 0..arcs.len() - 1 {
            for j in 0..columns - 1 {
                let n = i * columns + j;
                quads.push([n, n + columns, n + columns + 1, n + 1]);
            }
        }
        // Columns run counter-clockwise. Rows run outwards, and the two are a right-handed pair; inwards in a ring.
        if right[0][0].hypot(right[0][1]) > right[last][0].hypot(right[last][1]) {
            for quad in &mut quads {
                quad.swap(1, 3);
            }
        }
        let mut held: Vec<usize> = (0..columns).collect();
        held.extend((1..arcs.len()).map(|i| i * columns + columns - 1));
        Self {
            nodes,
            quads,
            outline: (0..arcs.len()).map(|i| i * columns).collect(),
            outline_arc_m: arcs,
            smallest_m: grading.smallest_m,
            centre,
            held,
        }
    }
}

/// Places of the rows. Nodes at the load's centre, at the end of the flank and at the tip corner.
fn rows(cut: f64, marks: [f64; 3], along: impl Fn(f64) -> f64, smallest_m: f64) -> Vec<f64> {
    let mut arcs = vec![cut];
    for to in marks {
        let from = arcs[arcs.len() - 1];
        // Two marks closer than this are one: an element must not be a sliver.
        if to - from > 0.2 * smallest_m {
            arcs.extend(&graded(from, to, &along, Pieces::at_least(1))[1..]);
        }
    }
    arcs
}

/// A broken line by the share of its length.
struct Polyline {
    points: Vec<[f64; 2]>,
    lengths: Vec<f64>,
}

impl Polyline {
    fn new(points: Vec<[f64; 2]>) -> Self {
        let lengths = arc_lengths(&points);
        Self { points, lengths }
    }

    fn at(&self, share: f64) -> [f64; 2] {
        let last = self.points.len() - 1;
        let wanted = share * self.lengths[last];
        let k = self.lengths.partition_point(|l| *l < wanted).clamp(1, last);
        let w = (wanted - self.lengths[k - 1]) / (self.lengths[k] - self.lengths[k - 1]);
        lerp(self.points[k - 1], self.points[k], w)
    }
}
