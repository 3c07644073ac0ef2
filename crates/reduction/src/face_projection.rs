//! Forces at single points of a flank: the finite element face that a point lies on, its natural coordinates by
//! Newton's method, and the shares of the face's nodes (*Transmission Error and Strain Analysis of Lightweight Gears*,
//! equations 9 and 10; seed 004 in docs/sources.md).
//!
//! A point x of the true flank lies beside the faces of its elements, which are flat or parabolas. It is put on them
//! along a direction m, the one in which its force acts, so that the force stays on its own line:
//!
//! ```text
//! x + d m − Σ N_a(ξ, η) x_a = 0            for ξ, η, d
//! ```
//!
//! Three equations for three unknowns, where equation 10 has three for two. Faces that share an edge leave no gap and
//! no overlap for one direction, as they would for the nearest point. Where the point lies on the face d is zero.
//!
//! The force F goes to the nodes by s_a = N_a F, and the displacement of the point is read by the same shares, Σ N_a
//! u_a.

use crate::flank_loads::SparseVector;
use gearmesh_mesh::{FaceShape, OutlineFace};
use nalgebra::Vector3;

/// Steps of Newton's method at most. A flat parallelogram takes one and one more that finds nothing left; the others
/// double their digits with every step.
const MOST_STEPS: usize = 20;
/// A step in natural coordinates that ends the search. Rounding of coordinates is some 1e-13 of a face.
const LAST_STEP: f64 = 1e-11;
/// Points beyond an edge of all faces by less, in natural coordinates, are put on it. Edges are chords, too: over a
/// layer of length l the edge of a helical tooth's tip is l² tan²β/(4 r h) of a half face inside the true one, 0.004 at
/// 20 degrees, 0.06 at 45 degrees (r 40 mm, l 2 to 3 mm, faces of h 0.9 mm).
const BESIDE: f64 = 0.1;
/// How far from a face along the direction a point may lie, in diagonals of the face. A curve is a quarter of its chord
/// away from it where it turns by 106 degrees on one element; a flank of a good mesh turns by a few.
const REACH: f64 = 0.25;

/// A point of a face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Projection {
    /// Number of the face.
    pub face: usize,
    /// Natural coordinates on it.
    pub natural: [f64; 2],
    /// How far along the direction the face lies from the point \[m\].
    pub distance_m: f64,
    /// How far beside the edge of the outermost face the point's line goes by, as it stands on its edge \[m\]; zero on
    /// faces.
    pub beside_m: f64,
    /// Steps of Newton's method.
    pub steps: usize,
}

/// No face lies under a point.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "no element face lies under the point ({:.6}, {:.6}, {:.6}) mm: the nearest face is {:.6} mm away; keep the point between \
     the ends of the flank and the faces of the gear, and its direction across the flank",
    1e3 * point_m[0], 1e3 * point_m[1], 1e3 * point_m[2], 1e3 * away_m
)]
pub struct OffEveryFace {
    /// The point \[m\].
    pub point_m: [f64; 3],
    /// Distance to the nearest point of any face \[m\], infinite where there is no face.
    pub away_m: f64,
}

/// Faces of finite elements in space.
#[derive(Debug, Clone)]
pub struct FaceSurface {
    faces: Vec<PlacedFace>,
}

#[derive(Debug, Clone)]
struct PlacedFace {
    shape: FaceShape,
    nodes: Vec<u32>,
    points_m: Vec<[f64; 3]>,
    /// Box around its nodes, wider by how far from it a point may lie.
    low_m: Vector3<f64>,
    high_m: Vector3<f64>,
    reach_m: f64,
}

impl FaceSurface {
    /// Some faces of a mesh with these nodes \[m\].
    pub fn new(faces: &[OutlineFace], nodes_m: &[[f64; 3]]) -> Self {
        let placed = |face: &OutlineFace| {
            let points = face.nodes.iter().map(|&node| nodes_m[node as usize]);
            PlacedFace::new(face.shape, face.nodes.clone(), points.collect())
        };
        Self {
            faces: faces.iter().map(placed).collect(),
        }
    }

    /// Number of faces.
    pub fn len(&self) -> usize {
        self.faces.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.faces.is_empty()
    }

    /// Puts a point on the face under it along a direction of any length. Only faces in whose boxes the point lies are
    /// looked at.
    ///
    /// # Errors
    /// [`OffEveryFace`] where no face lies under it.
    pub fn project(&self, point_m: [f64; 3], along: [f64; 3]) -> Result<Projection, OffEveryFace> {
        let along = Vector3::from(along);
        let direction = along / along.norm();
        let near = self.faces.iter().enumerate();
        let found = near
            .filter(|(_, face)| face.has_in_box(point_m))
            .filter_map(|(number, face)| {
                let mut found = face.project(point_m.into(), direction)?;
                let beyond = face.excess(found.natural).max(0.0);
                if beyond > BESIDE || found.distance_m.abs() > face.reach_m {
                    return None;
                }
                found.face = number;
                if beyond > 0.0 {
                    let wanted = face.place(found.natural)[0];
                    found.natural = face.inside(found.natural);
                    found.beside_m = (face.place(found.natural)[0] - wanted).norm();
                }
                Some((beyond, found))
            })
            // On a face, if there is one; of several on the nearest.
            .min_by(|(a, on_a), (b, on_b)| {
                let nearer = on_a.distance_m.abs().total_cmp(&on_b.distance_m.abs());
                a.total_cmp(b).then(nearer)
            })
            .map(|(_, found)| found);
        found.ok_or_else(|| OffEveryFace {
            point_m,
            away_m: (self.faces.iter())
                .map(|face| face.away_m(point_m))
                .fold(f64::INFINITY, f64::min),
        })
    }

    /// Nodes of a face with their shares of a force at a point of it, N_a(ξ, η), which add up to one.
    pub fn shares(&self, at: &Projection) -> impl Iterator<Item = (u32, f64)> {
        let face = &self.faces[at.face];
        let shapes = face.shape.shapes(at.natural).into_iter();
        face.nodes
            .iter()
            .zip(shapes)
            .map(|(&node, shape)| (node, shape[0]))
    }

    /// Nodal forces of a force \[N\] at a point of a face, s = Nᵀ F: the row, too, that reads the displacement of the
    /// point along F, N to the metre.
    pub fn load(&self, at: &Projection, force_n: [f64; 3]) -> SparseVector {
        let mut load: SparseVector = (self.shares(at))
            .flat_map(|(node, share)| (0..3).map(move |k| (3 * node as usize + k, share, k)))
            .map(|(dof, share, k)| (dof, share * force_n[k]))
            .filter(|(_, value)| *value != 0.0)
            .collect();
        load.sort_by_key(|entry| entry.0);
        load
    }

    /// The place in space of a point of a face \[m\].
    pub fn point_m(&self, at: &Projection) -> [f64; 3] {
        self.faces[at.face].place(at.natural)[0].into()
    }
}

impl PlacedFace {
    fn new(shape: FaceShape, nodes: Vec<u32>, points_m: Vec<[f64; 3]>) -> Self {
        let of_points = |start: f64, choose: fn(f64, f64) -> f64| {
            let at = |axis: usize| points_m.iter().map(|p| p[axis]).fold(start, choose);
            Vector3::new(at(0), at(1), at(2))
        };
        let low = of_points(f64::INFINITY, f64::min);
        let high = of_points(f64::NEG_INFINITY, f64::max);
        let reach_m = REACH * (high - low).norm();
        Self {
            shape,
            nodes,
            points_m,
            low_m: low.add_scalar(-reach_m),
            high_m: high.add_scalar(reach_m),
            reach_m,
        }
    }

    fn has_in_box(&self, point_m: [f64; 3]) -> bool {
        (0..3).all(|k| (self.low_m[k]..=self.high_m[k]).contains(&point_m[k]))
    }

    /// Place of a natural point \[m\] and its natural derivatives.
    fn place(&self, natural: [f64; 2]) -> [Vector3<f64>; 3] {
        let shapes = self.shape.shapes(natural);
        std::array::from_fn(|k| {
            Vector3::from_fn(|axis, _| {
                let points = self.points_m.iter();
                shapes.iter().zip(points).map(|(n, p)| n[k] * p[axis]).sum()
            })
        })
    }

    /// Newton's method from the middle of the face; none where it does not come to rest, or leaves the face by far.
    fn project(&self, point_m: Vector3<f64>, direction: Vector3<f64>) -> Option<Projection> {
        let (mut natural, mut distance_m) = (self.shape.centre(), 0.0);
        for steps in 1..=MOST_STEPS {
            let [at, d_xi, d_eta] = self.place(natural);
            let miss = point_m + distance_m * direction - at;
            // d_xi a + d_eta b − direction c = miss, by Cramer's rule.
            let across = d_xi.cross(&d_eta);
            let det = -across.dot(&direction);
            let a = -miss.cross(&d_eta).dot(&direction) / det;
            let b = -d_xi.cross(&miss).dot(&direction) / det;
            natural = [natural[0] + a, natural[1] + b];
            distance_m += across.dot(&miss) / det;
            let last = a.abs().max(b.abs());
            // Far outside, along a face that turns away, or with a direction in the face.
            if !(last < 1e3 && self.excess(natural) < 1e2) {
                return None;
            }
            if last < LAST_STEP {
                return Some(Projection {
                    face: 0,
                    natural,
                    distance_m,
                    beside_m: 0.0,
                    steps,
                });
            }
        }
        None
    }

    /// How far a natural point lies beyond the edges; negative inside.
    fn excess(&self, [x, y]: [f64; 2]) -> f64 {
        match self.shape.corner_count() {
            3 => (-x).max(-y).max(x + y - 1.0),
            _ => x.abs().max(y.abs()) - 1.0,
        }
    }

    /// The point of the face that is nearest to a natural point, along the natural axes.
    fn inside(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        match self.shape.corner_count() {
            3 => {
                let (x, y) = (x.max(0.0), y.max(0.0));
                let over = (x + y - 1.0).max(0.0);
                let x = (x - 0.5 * over).clamp(0.0, 1.0);
                [x, y.min(1.0 - x)]
            }
            _ => [x.clamp(-1.0, 1.0), y.clamp(-1.0, 1.0)],
        }
    }

    /// Distance to the nearest of some points of the face \[m\]: for messages.
    fn away_m(&self, point_m: [f64; 3]) -> f64 {
        const PARTS: usize = 8;
        let share = |k: usize| k as f64 / PARTS as f64;
        let all = (0..=PARTS).flat_map(|i| (0..=PARTS).map(move |j| [share(i), share(j)]));
        let natural = all.map(|[x, y]| match self.shape.corner_count() {
            3 => [x * (1.0 - y), y],
            _ => [2.0 * x - 1.0, 2.0 * y - 1.0],
        });
        natural
            .map(|at| (self.place(at)[0] - Vector3::from(point_m)).norm())
            .fold(f64::INFINITY, f64::min)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use fastrand::Rng;

    const SIZE_M: f64 = 1e-3;

    fn corners_and_middles(shape: FaceShape) -> Vec<[f64; 2]> {
        let corners: &[[f64; 2]] = match shape.corner_count() {
            3 => &[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
            _ => &[[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]],
        };
        let n = corners.len();
        let middle = |k: usize| {
            let (a, b) = (corners[k], corners[(k + 1) % n]);
            [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]
        };
        let middles = (0..n).map(middle);
        let all = corners.iter().copied().chain(middles);
        all.take(shape.node_count()).collect()
    }

    /// A face whose nodes are moved by up to a twentieth of its edges in all directions.
    fn distorted(shape: FaceShape, random: &mut Rng) -> FaceSurface {
        let nodes = corners_and_middles(shape);
        let edge = (nodes[1][0] - nodes[0][0]).abs();
        let moved = nodes.iter().map(|&[x, y]| {
            let mut by = || 0.1 * edge * (random.f64() - 0.5);
            [x + by(), y + by(), by()].map(|c| SIZE_M * c)
        });
        let face = PlacedFace::new(shape, (0..nodes.len() as u32).collect(), moved.collect());
        FaceSurface { faces: vec![face] }
    }

    fn natural_inside(shape: FaceShape, random: &mut Rng) -> [f64; 2] {
        let (x, y) = (random.f64(), random.f64());
        match shape.corner_count() {
            3 => [x * (1.0 - y), y],
            _ => [2.0 * x - 1.0, 2.0 * y - 1.0],
        }
    }

    /// Force and moment about a point of nodal forces on a surface of one face.
    fn resultant(
        surface: &FaceSurface,
        load: &SparseVector,
        about: Vector3<f64>,
    ) -> [Vector3<f64>; 2] {
        let (mut force, mut moment) = (Vector3::zeros(), Vector3::zeros());
        for &(dof, value) in load {
            let mut at_node = Vector3::zeros();
            at_node[dof % 3] = value;
            let arm = Vector3::from(surface.faces[0].points_m[dof / 3]) - about;
            force += at_node;
            moment += arm.cross(&at_node);
        }
        [force, moment]
    }

    /// On distorted faces of every shape: the natural point and the distance are found again, shares add up to one, the
    /// nodal forces have force and moment of the load, which stays on its own line.
    #[test]
    fn points_of_distorted_faces_are_found_again() {
        let mut random = Rng::with_seed(11);
        let mut most_steps = 0;
        for shape in FaceShape::ALL {
            for _ in 0..500 {
                let surface = distorted(shape, &mut random);
                let natural = natural_inside(shape, &mut random);
                let [on_face, d_xi, d_eta] = surface.faces[0].place(natural);
                // Up to some twenty degrees beside the normal.
                let normal = d_xi.cross(&d_eta) / (SIZE_M * SIZE_M);
                let along = normal + Vector3::from([0; 3].map(|_| 0.2 * (random.f64() - 0.5)));
                let distance_m = 0.1 * SIZE_M * (random.f64() - 0.5);
                let point = on_face - distance_m * along / along.norm();
                let found = surface.project(point.into(), along.into()).unwrap();
                let off = (0..2).map(|k| (found.natural[k] - natural[k]).abs());
                assert!(off.fold(0.0, f64::max) < 1e-9, "{shape:?} {found:?}");
                assert!((found.distance_m - distance_m).abs() < 1e-9 * SIZE_M);
                most_steps = most_steps.max(found.steps);

                let sum: f64 = surface.shares(&found).map(|(_, share)| share).sum();
                assert!((sum - 1.0).abs() < 1e-14);
                let force = Vector3::from([0; 3].map(|_| random.f64() - 0.5));
                let load = surface.load(&found, force.into());
                let [total, moment] = resultant(&surface, &load, on_face);
                assert!((total - force).amax() < 1e-13);
                assert!(moment.amax() < 1e-9 * SIZE_M, "{moment:?}");
                let [_, moment] = resultant(&surface, &surface.load(&found, along.into()), point);
                assert!(moment.amax() < 1e-9 * SIZE_M, "{moment:?}");
                // Read by the same shares, a field that is linear in space has its value there.
                let read: f64 = (surface.shares(&found))
                    .map(|(node, share)| {
                        let at = Vector3::from(surface.faces[0].points_m[node as usize]);
                        share * at.dot(&force)
                    })
                    .sum();
                assert!((read - on_face.dot(&force)).abs() < 1e-9 * SIZE_M);
            }
        }
        assert!(most_steps <= 8, "{most_steps}");
    }

    #[test]
    fn a_flat_parallelogram_takes_one_step() {
        let points = vec![
            [0.0, 0.0, 0.0],
            [2.0, 0.1, 0.0],
            [2.3, 1.1, 0.0],
            [0.3, 1.0, 0.0],
        ];
        let face = PlacedFace::new(FaceShape::Quad4, vec![0, 1, 2, 3], points);
        let surface = FaceSurface { faces: vec![face] };
        let found = surface.project([1.5, 0.8, -0.1], [0.2, 0.1, 1.0]).unwrap();
        // The second one finds nothing left.
        assert_eq!(found.steps, 2);
        assert!((found.distance_m - 0.1 * (1.05_f64).sqrt()).abs() < 1e-15);
    }

    /// Two faces that meet at 20 degrees, a ridge or a valley: along a line across the edge every point is found, at
    /// the edge on both nodes of it, and shares do not jump.
    #[test]
    fn points_at_an_edge_belong_to_its_nodes() {
        for slope in [0.176_f64, -0.176] {
            let points = [
                [-1.0, 0.0, -slope],
                [-1.0, 1.0, -slope],
                [0.0, 0.0, 0.0],
                [0.0, 1.0, 0.0],
                [1.0, 0.0, -slope],
                [1.0, 1.0, -slope],
            ];
            let face = |nodes: [u32; 4]| {
                let of = nodes.map(|n| points[n as usize]).to_vec();
                PlacedFace::new(FaceShape::Quad4, nodes.to_vec(), of)
            };
            let surface = FaceSurface {
                faces: vec![face([0, 2, 3, 1]), face([2, 4, 5, 3])],
            };
            let shares = |x: f64| {
                let found = surface.project([x, 0.25, 0.05], [0.0, 0.0, -1.0]).unwrap();
                let mut all = [0.0; 6];
                surface
                    .shares(&found)
                    .for_each(|(node, share)| all[node as usize] += share);
                all
            };
            let at_edge = [0.0, 0.0, 0.75, 0.25, 0.0, 0.0];
            for x in [-1e-7, -1e-9, 0.0, 1e-9, 1e-7] {
                let off = shares(x)
                    .into_iter()
                    .zip(at_edge)
                    .map(|(a, b)| (a - b).abs());
                assert!(off.fold(0.0, f64::max) < 2e-7, "{x}");
            }
            // A little beyond the outer edge it is put on the edge, which is said.
            assert!((shares(1.02)[4] - 0.75).abs() < 1e-12);
            let beside = surface.project([1.02, 0.25, 0.05], [0.0, 0.0, -1.0]);
            let edge_on = (1.0 + slope * slope).sqrt();
            assert!((beside.unwrap().beside_m - 0.02 * edge_on).abs() < 1e-12);
        }
    }

    #[test]
    fn points_off_every_face_are_refused() {
        let mut random = Rng::with_seed(3);
        let surface = distorted(FaceShape::Quad4, &mut random);
        let down = [0.0, 0.0, -1.0];
        for point in [
            [1.5 * SIZE_M, 0.0, 0.0],
            [0.0, 0.0, 3.0 * SIZE_M],
            [f64::NAN, 0.0, 0.0],
        ] {
            let error = surface.project(point, down).unwrap_err();
            assert!(error.to_string().contains("no element face lies under"));
        }
        // The nearest of the face's points is reported: beside the edge at 1 ± 0.1.
        let away = surface
            .project([1.5 * SIZE_M, 0.0, 0.0], down)
            .unwrap_err()
            .away_m;
        assert!((0.35..0.65).contains(&(away / SIZE_M)), "{away}");
        // Along the face, or along nothing.
        for along in [[1.0, 0.0, 0.0], [0.0; 3], [f64::NAN; 3]] {
            assert!(surface.project([0.0, 0.0, 0.2 * SIZE_M], along).is_err());
        }
        let nothing = FaceSurface { faces: Vec::new() };
        assert!(nothing.is_empty());
        let error = nothing.project([0.0; 3], down).unwrap_err();
        assert_eq!(error.away_m, f64::INFINITY);
    }
}
