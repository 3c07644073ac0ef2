//! The body of a bevel gear below the ring of its teeth: quads in the meridian, turned about the axis over the columns
//! of the ring.
//!
//! Where the lines of the body on the toe's and on the heel's side run much alike, rows between them do. Webs with
//! steep walls would have rows that lie askew; there the meridian is meshed freely in quads (gmsh), and elements are as
//! long as `body_mm` away from the ring. Columns follow the spiral in the ring. In rows each keeps the azimuth of its
//! section; how it goes on into a free mesh is `bevel_twist.rs`.

use gearmesh_bevel::BevelGear;

use crate::MeshError;
use crate::bevel_grid::grid_quad;
use crate::bevel_level::Levels;
use crate::bevel_twist::Torsion;
use crate::grading::{Pieces, graded};
use crate::mid_sides::{CurvedSides, MidSides};
use crate::plane::{apart, lerp};
use crate::plane_mesher::{PlaneProblem, Region, mesh_one};
use crate::python::PythonEnvironment;

/// Growth of element length per length along the lines, from the ring.
const GROWTH: f64 = 0.4;
/// Elements through the thickness of the body at a place of its lines, at least.
const THROUGH: f64 = 2.0;

/// How the meridian of a bevel body is cut into quads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BodyGrid {
    /// Rows from the ring to the bore, from the line on the toe's side to that on the heel's.
    Rows,
    /// A free mesh between the lines.
    Free,
}

/// Quads in the meridian below the ring.
#[derive(Debug, Clone)]
pub(crate) struct Meridian {
    /// How it was made.
    pub kind: BodyGrid,
    /// \[z, radius\] \[m\].
    pub nodes: Vec<[f64; 2]>,
    /// Nodes, order + 1 by order + 1, counter-clockwise in (z, radius).
    pub quads: Vec<[[usize; 3]; 3]>,
    /// 0 of corners, 1 in the middle of sides, 2 in the middle of quads, where quadratic elements have no node.
    pub between: Vec<u8>,
    /// The node of each section at the ring.
    pub ring: Vec<usize>,
    /// The section of each node that is at the ring.
    pub section: Vec<Option<usize>>,
    /// Nodes of the bore.
    pub bore: Vec<usize>,
    /// What is seen along the axis: pieces of a line from ring to bore, and the quads before and behind each.
    pub seen: Vec<([usize; 2], Vec<usize>)>,
}

impl Meridian {
    /// Makes the quads.
    ///
    /// # Errors
    /// [`MeshError`] where the lines of a free mesh cross, or gmsh is missing or fails.
    pub(crate) fn new(
        gear: &BevelGear,
        levels: &Levels<'_>,
        order: usize,
        kind: BodyGrid,
    ) -> Result<Self, MeshError> {
        match kind {
            BodyGrid::Rows => Ok(Self::rows(levels, order)),
            BodyGrid::Free => Self::free(gear, levels, order),
        }
    }

    fn rows(levels: &Levels<'_>, order: usize) -> Self {
        let (lines, spacing) = (&levels.meridian, &levels.spacing);
        let sections = spacing.along.len();
        let mut nodes = Vec::new();
        for &(piece, share) in std::iter::once(&(0, 0.0)).chain(&spacing.body) {
            let [toe, heel] = [0, 1].map(|k| lerp(lines[piece][k], lines[piece + 1][k], share));
            let place = |along: &f64| {
                let [r, z] = lerp(toe, heel, *along);
                [z, r]
            };
            nodes.extend(spacing.along.iter().map(place));
        }
        let rows = spacing.body.len();
        let at = |row: usize, section: usize| row * sections + section;
        let p = order;
        let (mut quads, mut seen) = (Vec::new(), Vec::new());
        let middle = (sections - 1) / p / 2 * p;
        for row in (0..rows).step_by(p) {
            let first = quads.len();
            for section in (0..sections - 1).step_by(p) {
                // z to the heel, the radius from the lower row up.
                quads.push(grid_quad(p, |a, b| at(row + p - b, section + a)));
            }
            seen.push((
                [at(row, middle), at(row + p, middle)],
                (first..quads.len()).collect(),
            ));
        }
        let count = nodes.len();
        Self {
            kind: BodyGrid::Rows,
            between: (0..nodes.len())
                .map(|n| ((n / sections) % p + (n % sections) % p) as u8)
                .collect(),
            nodes,
            quads,
            section: sections_of(count, &(0..sections).collect::<Vec<_>>()),
            ring: (0..sections).collect(),
            bore: (0..sections).map(|section| at(rows, section)).collect(),
            seen,
        }
    }

    fn free(gear: &BevelGear, levels: &Levels<'_>, order: usize) -> Result<Self, MeshError> {
        let lines = &levels.meridian;
        check_lines(lines)?;
        let along: Vec<f64> = levels
            .spacing
            .along
            .iter()
            .copied()
            .step_by(order)
            .collect();
        let outline = Outline::of(lines, &along, gear.mesh.body_m);
        let Outline {
            points,
            at_bore,
            ring_end,
            ring_begin,
        } = outline;
        let count = points.len();
        let problem = PlaneProblem {
            name: format!("body of {}", gear.name),
            points,
            regions: vec![Region {
                loops: vec![(0..count).collect()],
                ..Region::default()
            }],
            largest: gear.mesh.body_m,
        };
        let mut mesh = mesh_one(&PythonEnvironment::find()?, &problem)?;
        let corners = mesh.nodes.len();
        let mut ring: Vec<usize> = (ring_end..=ring_begin).rev().collect();
        let mut bore: Vec<usize> = (0..=at_bore).collect();
        let line: Vec<usize> = (at_bore..=ring_end).rev().collect();
        let seen = seen(&mesh.nodes, &mesh.quads, &line);
        if order == 2 {
            let middles = MidSides::add(&mut mesh, &CurvedSides::default());
            ring = middles.interleaved(&ring, false);
            bore = middles.interleaved(&bore, false);
        }
        let quads = mesh.quads.iter().enumerate().map(|(k, quad)| {
            let mut all = [[quad[0]; 3]; 3];
            let p = order;
            (all[0][0], all[p][0], all[p][p], all[0][p]) = (quad[0], quad[1], quad[2], quad[3]);
            if let Some(middles) = mesh.mid_sides.get(k).filter(|_| p == 2) {
                (all[1][0], all[2][1], all[1][2], all[0][1]) =
                    (middles[0], middles[1], middles[2], middles[3]);
            }
            all
        });
        Ok(Self {
            kind: BodyGrid::Free,
            quads: quads.collect(),
            between: (0..mesh.nodes.len())
                .map(|n| u8::from(n >= corners))
                .collect(),
            section: sections_of(mesh.nodes.len(), &ring),
            nodes: mesh.nodes,
            ring,
            bore,
            seen,
        })
    }

    /// 1, or 2 with nodes in the middles of sides.
    pub(crate) fn order(&self) -> usize {
        if self.between.contains(&1) { 2 } else { 1 }
    }

    /// Azimuths of all nodes, `[node][column]` \[rad\], from those at the ring, `[section][column]`; the last column is
    /// the first of the next sector.
    pub(crate) fn azimuths_rad(&self, ring: &[&[f64]]) -> Vec<Vec<f64>> {
        let sections = ring.len();
        if self.kind == BodyGrid::Rows {
            let of_section = |n: usize| ring[n % sections].to_vec();
            return (0..self.nodes.len()).map(of_section).collect();
        }
        let torsion = Torsion::new(&self.quads, self.order(), &self.nodes);
        let columns = ring[0].len();
        let mut all = vec![vec![0.0; columns]; self.nodes.len()];
        for column in 0..columns {
            let given: Vec<(usize, f64)> = (self.ring.iter())
                .zip(ring)
                .map(|(&n, of_section)| (n, of_section[column]))
                .collect();
            for (row, value) in all.iter_mut().zip(torsion.solve(&self.between, &given)) {
                row[column] = value;
            }
        }
        if self.order() == 1 {
            return all;
        }
        for quad in &self.quads {
            for (middle, ends) in [
                (quad[1][0], [quad[0][0], quad[2][0]]),
                (quad[2][1], [quad[2][0], quad[2][2]]),
                (quad[1][2], [quad[0][2], quad[2][2]]),
                (quad[0][1], [quad[0][0], quad[0][2]]),
            ] {
                if self.section[middle].is_none() {
                    all[middle] = (0..columns)
                        .map(|c| 0.5 * (all[ends[0]][c] + all[ends[1]][c]))
                        .collect();
                }
            }
        }
        all
    }
}

/// The outline of a body with the lengths wanted at its points, counter-clockwise: along the bore to the heel, up to
/// the ring, along it to the toe, down to the bore.
struct Outline {
    /// \[z, radius, length\] \[m\].
    points: Vec<[f64; 3]>,
    /// Pieces along the bore.
    at_bore: usize,
    /// The points of the ring at the heel and at the toe.
    ring_end: usize,
    ring_begin: usize,
}

impl Outline {
    fn of(lines: &[[[f64; 2]; 2]], along: &[f64], body_m: f64) -> Self {
        let (last, layers) = (lines.len() - 1, along.len() - 1);
        let begin = apart(lines[0][0], lines[0][1]) / layers as f64;
        let size = lengths_at_lines(lines, body_m);
        let [toe, heel] = [0, 1].map(|k| side_points(lines, k, &size, begin));
        let width = apart(lines[last][0], lines[last][1]);
        let at_bore = 2 * ((0.5 * width / size[last]).ceil() as usize).max(1);
        let mut points: Vec<[f64; 3]> = (0..=at_bore)
            .map(|i| {
                let [r, z] = lerp(lines[last][0], lines[last][1], i as f64 / at_bore as f64);
                [z, r, size[last]]
            })
            .collect();
        points.extend(heel.iter().rev().skip(1));
        let ring_end = points.len() - 1;
        points.extend((1..layers).rev().map(|i| {
            let [r, z] = lerp(lines[0][0], lines[0][1], along[i]);
            [z, r, begin]
        }));
        let ring_begin = points.len();
        points.extend(&toe[..toe.len() - 1]);
        Self {
            points,
            at_bore,
            ring_end,
            ring_begin,
        }
    }
}

/// Wanted lengths at the places of the lines: a part of the thickness, and no longer than the shorter pieces of the
/// lines that begin there.
fn lengths_at_lines(lines: &[[[f64; 2]; 2]], body_m: f64) -> Vec<f64> {
    let last = lines.len() - 1;
    let piece = |k: usize| {
        let lengths = [0, 1].map(|side| apart(lines[k][side], lines[k + 1][side]));
        lengths[0].min(lengths[1])
    };
    (0..=last)
        .map(|k| {
            let thickness = apart(lines[k][0], lines[k][1]);
            let before = if k > 0 { piece(k - 1) } else { f64::INFINITY };
            let behind = if k < last { piece(k) } else { f64::INFINITY };
            let longest = (thickness / THROUGH).min(before).min(behind);
            longest.min(body_m)
        })
        .collect()
}

/// One side from the ring to the bore, both ends included, with lengths that grow from that at the ring.
fn side_points(lines: &[[[f64; 2]; 2]], side: usize, size: &[f64], begin: f64) -> Vec<[f64; 3]> {
    let mut points: Vec<[f64; 3]> = Vec::new();
    let mut below = 0.0;
    for (piece, pair) in lines.windows(2).enumerate() {
        let length = apart(pair[0][side], pair[1][side]);
        let wanted = |s: f64| {
            let between = size[piece] + (size[piece + 1] - size[piece]) * s / length;
            between.min(begin + GROWTH * (below + s))
        };
        // gmsh paves with lines over two pieces, which must not go round a corner.
        let places = graded(0.0, length, wanted, Pieces::EVEN);
        let skipped = usize::from(piece > 0);
        points.extend(places.iter().skip(skipped).map(|s| {
            let [r, z] = lerp(pair[0][side], pair[1][side], s / length);
            [z, r, wanted(*s)]
        }));
        below += length;
    }
    points
}

/// The section of each node that is one of the ring's.
fn sections_of(nodes: usize, ring: &[usize]) -> Vec<Option<usize>> {
    let mut of = vec![None; nodes];
    for (section, node) in ring.iter().enumerate() {
        of[*node] = Some(section);
    }
    of
}

/// Pieces of a line from the ring to the bore, and the quads whose middles have their radii.
fn seen(nodes: &[[f64; 2]], quads: &[[usize; 4]], line: &[usize]) -> Vec<([usize; 2], Vec<usize>)> {
    let radius = |n: usize| nodes[n][1];
    let middles: Vec<f64> = quads
        .iter()
        .map(|quad| 0.25 * quad.iter().map(|n| radius(*n)).sum::<f64>())
        .collect();
    let pieces = line.windows(2).map(|pair| {
        let range = radius(pair[1])..radius(pair[0]);
        let own = (0..quads.len()).filter(|k| range.contains(&middles[*k]));
        ([pair[0], pair[1]], own.collect::<Vec<_>>())
    });
    pieces.filter(|(_, own)| !own.is_empty()).collect()
}

/// Refuses lines that cross.
fn check_lines(lines: &[[[f64; 2]; 2]]) -> Result<(), MeshError> {
    // Once round: down on the toe's side, up on the heel's.
    let mut round: Vec<[f64; 2]> = lines.iter().map(|pair| pair[0]).collect();
    round.extend(lines.iter().rev().map(|pair| pair[1]));
    let count = round.len();
    let turn = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| {
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    for i in 0..count {
        for j in i + 2..count {
            if (j + 1) % count == i {
                continue;
            }
            let [a, b] = [round[i], round[i + 1]];
            let [c, d] = [round[j], round[(j + 1) % count]];
            if turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0 {
                let share = turn(c, d, a) / (turn(c, d, a) - turn(c, d, b));
                let [r, z] = lerp(a, b, share);
                return Err(MeshError::CrossedLines {
                    diameter_mm: 2e3 * r,
                    z_mm: 1e3 * z,
                });
            }
        }
    }
    Ok(())
}
