//! A flank of tooth 0 as nodes on a grid, toe to heel and up the flank, with bilinear patches between them.

use gearmesh_geometry::Flank;
use nalgebra::{Matrix3, Rotation3, Vector3};
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::Vector;

use crate::error::DrivetrainError;

/// Least patches along the face and up the flank, most on a flank.
const LEAST_PATCHES: f64 = 4.0;
const MOST_PATCHES: f64 = 1e5;

/// Columns and rows of nodes that are looked at together first.
const BLOCK: usize = 8;

/// Longest edges of the patches \[m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PatchSize {
    /// Along the face.
    pub along_m: f64,
    /// Up the flank.
    pub up_m: f64,
}

/// A node of the grid, tooth 0.
#[derive(Debug, Clone, Copy)]
pub(super) struct Node {
    pub place_m: Vector3<f64>,
    /// Of the patches round it, the part that its shape function has.
    pub area_m2: f64,
    /// Unit vectors up the flank and along the tooth, at right angles.
    pub tangents: [Vector3<f64>; 2],
    /// Unit normal out of the material.
    pub normal: Vector3<f64>,
}

/// Nodes that stand together: the others lie within a radius \[m\] of the one in the middle.
#[derive(Debug, Clone)]
pub(super) struct Block {
    pub middle: usize,
    pub radius_m: f64,
    pub nodes: Vec<usize>,
}

/// A flank as nodes and patches.
#[derive(Debug, Clone)]
pub struct DigitalFlank {
    /// Patches along the face and up the flank.
    pub(super) patches: [usize; 2],
    /// Column by column along the face, up the flank first.
    pub(super) nodes: Vec<Node>,
    /// 1 where ∂x/∂s × ∂x/∂u points out of the material, else −1.
    pub(super) outwards: f64,
    /// Place u up the flank of its lower line and its tip.
    pub(super) ends: [f64; 2],
    pub(super) bounds: [Vector3<f64>; 2],
    pub(super) blocks: Vec<Block>,
    /// How much normals of neighbouring nodes turn at most, over their distance \[1/m\].
    pub(super) curvature_per_m: f64,
}

impl DigitalFlank {
    /// Cuts a flank of tooth 0 into patches no longer than these, as many along the face in each slice. `point(s, u)`:
    /// its point \[m\] at a share along the face from the toe and a place up the flank between `ends`, that of the
    /// lower line and that of the tip.
    ///
    /// # Errors
    /// [`DrivetrainError::Value`] for edges that are not positive, longer than a quarter of the flank, or so short
    /// that there would be more than a
    /// hundred thousand patches.
    pub fn new(
        side: Flank,
        (size, slices): (PatchSize, usize),
        ends: [f64; 2],
        point: impl Fn(f64, f64) -> Vector3<f64>,
    ) -> Result<Self, DrivetrainError> {
        let [lower, tip] = ends;
        let along_m = [lower, tip].map(|u| (point(1.0, u) - point(0.0, u)).norm());
        let up_m = [0.0, 1.0].map(|s| (point(s, tip) - point(s, lower)).norm());
        let counts = [
            along_m[0].max(along_m[1]) / size.along_m,
            up_m[0].max(up_m[1]) / size.up_m,
        ];
        let edges = [size.along_m, size.up_m];
        let few = counts[0] * counts[1] <= MOST_PATCHES;
        let allowed = "positive, at most a quarter of the flank, and long enough for a hundred thousand patches on a flank";
        let parts = (counts, LEAST_PATCHES, few);
        DrivetrainError::check_edges("patches of a flank", edges, parts, allowed)?;
        let [along, up] = counts.map(|count| count.ceil() as usize);
        let patches = [along.div_ceil(slices) * slices, up];
        let [columns, rows] = patches.map(|count| count + 1);
        let share = |k: usize, count: usize| k as f64 / count as f64;
        let places = (0..columns).flat_map(|i| (0..rows).map(move |k| (i, k)));
        let places = places.map(|(i, k)| {
            let u = lower + (tip - lower) * share(k, patches[1]);
            point(share(i, patches[0]), u)
        });
        let places: Vec<Vector3<f64>> = places.collect();
        let nodes = (0..places.len()).map(|number| {
            let up = places[near_row(number, 1, rows)] - places[near_row(number, -1, rows)];
            let up = up.normalize();
            let along = places[near_column(number, 1, [columns, rows])]
                - places[near_column(number, -1, [columns, rows])];
            let along = (along - up * up.dot(&along)).normalize();
            Node {
                place_m: places[number],
                area_m2: 0.0,
                tangents: [up, along],
                normal: along.cross(&up),
            }
        });
        let mut nodes: Vec<Node> = nodes.collect();
        add_areas(&mut nodes, patches);
        let [mid, mid_u] = [0.5, 0.5 * (lower + tip)];
        let step = 1e-4;
        let by_s = point(mid + step, mid_u) - point(mid - step, mid_u);
        let h = step * (tip - lower);
        let by_u = point(mid, mid_u + h) - point(mid, mid_u - h);
        let clockwise = -Vector3::z().cross(&point(mid, mid_u));
        let facing = by_s.cross(&by_u).dot(&clockwise) * side.mirror();
        for node in &mut nodes {
            node.normal *= facing.signum();
        }
        let extreme = |k: usize, pick: fn(f64, f64) -> f64, from: f64| {
            places.iter().map(|r| r[k]).fold(from, pick)
        };
        Ok(Self {
            patches,
            blocks: blocks(&nodes, [columns, rows]),
            curvature_per_m: curvature_per_m(&nodes, [columns, rows]),
            nodes,
            outwards: facing.signum(),
            ends,
            bounds: [
                Vector3::from_fn(|k, _| extreme(k, f64::min, f64::INFINITY)),
                Vector3::from_fn(|k, _| extreme(k, f64::max, f64::NEG_INFINITY)),
            ],
        })
    }

    /// Number of patches.
    #[must_use]
    pub fn patch_count(&self) -> usize {
        self.patches[0] * self.patches[1]
    }

    /// Area of all patches \[m²\].
    #[must_use]
    pub fn area_m2(&self) -> f64 {
        self.nodes.iter().map(|node| node.area_m2).sum()
    }

    /// Corners of a patch: at (0, 0), (1, 0), (0, 1), (1, 1) along the face and up the flank.
    pub(super) fn corners(&self, [i, k]: [usize; 2]) -> [Vector3<f64>; 4] {
        let rows = self.patches[1] + 1;
        let first = i * rows + k;
        [first, first + rows, first + 1, first + rows + 1].map(|n| self.nodes[n].place_m)
    }

    /// Share along the face and place up the flank of a node.
    pub(super) fn at_node(&self, number: usize) -> [f64; 2] {
        let rows = self.patches[1] + 1;
        self.at([number / rows, number % rows], [0.0; 2])
    }

    /// The same of a place in a patch.
    pub(super) fn at(&self, patch: [usize; 2], within: [f64; 2]) -> [f64; 2] {
        let share = |k: usize| (patch[k] as f64 + within[k]) / self.patches[k] as f64;
        let [lower, tip] = self.ends;
        [share(0), lower + (tip - lower) * share(1)]
    }

    /// Box round the flank turned and moved.
    pub(super) fn box_at(&self, axes: &Matrix3<f64>, origin_m: &Vector3<f64>) -> Aabb {
        let corners = (0..8).map(|k| {
            let corner = Vector3::from_fn(|axis, _| self.bounds[(k >> axis) & 1][axis]);
            let moved = origin_m + axes * corner;
            Vector::new(moved.x, moved.y, moved.z)
        });
        Aabb::from_points(corners)
    }

    /// Box round the flank of a tooth turned about z by this angle, from its nodes.
    pub(super) fn box_of_tooth(&self, turn_rad: f64) -> Aabb {
        let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), turn_rad);
        Aabb::from_points(self.nodes.iter().map(|node| {
            let moved = turn * node.place_m;
            Vector::new(moved.x, moved.y, moved.z)
        }))
    }
}

/// The node some rows further, or the last one there.
fn near_row(number: usize, steps: isize, rows: usize) -> usize {
    let row = (number % rows) as isize;
    let to = (row + steps).clamp(0, rows as isize - 1);
    (number as isize + to - row) as usize
}

/// The node some columns further, or the last one there.
fn near_column(number: usize, steps: isize, [columns, rows]: [usize; 2]) -> usize {
    let column = (number / rows) as isize;
    let to = (column + steps).clamp(0, columns as isize - 1);
    to as usize * rows + number % rows
}

/// All nodes in blocks.
fn blocks(nodes: &[Node], [columns, rows]: [usize; 2]) -> Vec<Block> {
    let mut found = Vec::new();
    for first_column in (0..columns).step_by(BLOCK) {
        for first_row in (0..rows).step_by(BLOCK) {
            let [last_column, last_row] =
                [(first_column, columns), (first_row, rows)].map(|(at, end)| (at + BLOCK).min(end));
            let inside = (first_column..last_column)
                .flat_map(|i| (first_row..last_row).map(move |k| i * rows + k));
            let middle = (first_column + last_column) / 2 * rows + (first_row + last_row) / 2;
            let radius_m = |number: usize| (nodes[number].place_m - nodes[middle].place_m).norm();
            found.push(Block {
                middle,
                radius_m: inside.clone().map(radius_m).fold(0.0, f64::max),
                nodes: inside.collect(),
            });
        }
    }
    found
}

fn curvature_per_m(nodes: &[Node], [columns, rows]: [usize; 2]) -> f64 {
    let numbers = 0..nodes.len();
    let turns = numbers.flat_map(|number| {
        [
            near_row(number, 1, rows),
            near_column(number, 1, [columns, rows]),
        ]
        .into_iter()
        .filter(move |next| *next != number)
        .map(move |next| {
            let (a, b) = (&nodes[number], &nodes[next]);
            (a.normal - b.normal).norm() / (a.place_m - b.place_m).norm()
        })
    });
    turns.fold(0.0, f64::max)
}

/// ∫ N dA of each node over the patches round it, by two by two places of Gauss.
fn add_areas(nodes: &mut [Node], patches: [usize; 2]) {
    let rows = patches[1] + 1;
    let half = 0.5 / 3.0_f64.sqrt();
    for i in 0..patches[0] {
        for k in 0..patches[1] {
            let first = i * rows + k;
            let numbers = [first, first + rows, first + 1, first + rows + 1];
            let corners = numbers.map(|n| nodes[n].place_m);
            for (x, e) in [(-half, -half), (half, -half), (-half, half), (half, half)] {
                let at = [0.5 + x, 0.5 + e];
                let [by_x, by_e] = slopes(&corners, at);
                let area = 0.25 * by_x.cross(&by_e).norm();
                for (number, shape) in numbers.iter().zip(shapes(at)) {
                    nodes[*number].area_m2 += shape * area;
                }
            }
        }
    }
}

/// Bilinear shape functions of the corners.
pub(super) fn shapes([x, e]: [f64; 2]) -> [f64; 4] {
    [(1.0 - x) * (1.0 - e), x * (1.0 - e), (1.0 - x) * e, x * e]
}

/// ∂x/∂ξ and ∂x/∂η of a patch.
pub(super) fn slopes(corners: &[Vector3<f64>; 4], [x, e]: [f64; 2]) -> [Vector3<f64>; 2] {
    let [a, b, c, d] = corners;
    [
        (b - a) * (1.0 - e) + (d - c) * e,
        (c - a) * (1.0 - x) + (d - b) * x,
    ]
}
