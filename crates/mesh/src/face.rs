//! Faces of elements on a tooth's outline, told by their places on the unrolled outline.
//!
//! Node order: corners first, then the middles of the edges, edge k between corners k and k + 1. Natural coordinates
//! run from −1 to 1 on quadrilaterals; on triangles the corners are (0, 0), (1, 0) and (0, 1).

/// Natural coordinates of the nodes of an eight-node quadrilateral; the four-node one has the first four.
const QUAD_NODES: [[f64; 2]; 8] = [
    [-1.0, -1.0],
    [1.0, -1.0],
    [1.0, 1.0],
    [-1.0, 1.0],
    [0.0, -1.0],
    [1.0, 0.0],
    [0.0, 1.0],
    [-1.0, 0.0],
];

/// Kind of a face by its nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FaceShape {
    /// Three corners.
    Triangle3,
    /// Four corners.
    Quad4,
    /// A triangle with middles of edges.
    Triangle6,
    /// A quadrilateral with middles of edges (serendipity).
    Quad8,
}

/// A shape function and its two natural derivatives.
type Shape = [f64; 3];

impl FaceShape {
    /// Every shape.
    pub const ALL: [Self; 4] = [Self::Triangle3, Self::Quad4, Self::Triangle6, Self::Quad8];

    /// Number of nodes.
    pub const fn node_count(self) -> usize {
        match self {
            Self::Triangle3 => 3,
            Self::Quad4 => 4,
            Self::Triangle6 => 6,
            Self::Quad8 => 8,
        }
    }

    /// Number of corners; they are the first nodes.
    pub const fn corner_count(self) -> usize {
        match self {
            Self::Triangle3 | Self::Triangle6 => 3,
            Self::Quad4 | Self::Quad8 => 4,
        }
    }

    /// True for faces of quadratic elements.
    pub const fn is_quadratic(self) -> bool {
        matches!(self, Self::Triangle6 | Self::Quad8)
    }

    /// Natural coordinates of the centre.
    pub const fn centre(self) -> [f64; 2] {
        match self.corner_count() {
            3 => [1.0 / 3.0; 2],
            _ => [0.0; 2],
        }
    }

    /// Natural coordinates of the middle of a quadrilateral's edge, that between corners k and k + 1.
    pub const fn quad_edge_middle(k: usize) -> [f64; 2] {
        QUAD_NODES[4 + k]
    }

    /// Shape functions at a natural point with their natural derivatives, one row \[N, ∂N/∂ξ, ∂N/∂η\] per node.
    pub fn shapes(self, [x, y]: [f64; 2]) -> Vec<Shape> {
        // Area coordinates of a triangle: corner 0 at (0, 0), 1 at (1, 0), 2 at (0, 1).
        let areas = [[1.0 - x - y, -1.0, -1.0], [x, 1.0, 0.0], [y, 0.0, 1.0]];
        match self {
            Self::Triangle3 => areas.to_vec(),
            Self::Triangle6 => {
                let corner = |[l, dx, dy]: Shape| {
                    let slope = 4.0 * l - 1.0;
                    [l * (2.0 * l - 1.0), slope * dx, slope * dy]
                };
                let middle = |[a, ax, ay]: Shape, [b, bx, by]: Shape| {
                    [
                        4.0 * a * b,
                        4.0 * (a * bx + b * ax),
                        4.0 * (a * by + b * ay),
                    ]
                };
                (0..3)
                    .map(|k| corner(areas[k]))
                    .chain((0..3).map(|k| middle(areas[k], areas[(k + 1) % 3])))
                    .collect()
            }
            Self::Quad4 => QUAD_NODES[..4]
                .iter()
                .map(|[a, b]| {
                    let (f, g) = (1.0 + a * x, 1.0 + b * y);
                    [0.25 * f * g, 0.25 * a * g, 0.25 * f * b]
                })
                .collect(),
            Self::Quad8 => QUAD_NODES
                .iter()
                .map(|&[a, b]| {
                    let (f, g) = (1.0 + a * x, 1.0 + b * y);
                    if a == 0.0 {
                        let bubble = 1.0 - x * x;
                        [0.5 * bubble * g, -x * g, 0.5 * bubble * b]
                    } else if b == 0.0 {
                        let bubble = 1.0 - y * y;
                        [0.5 * f * bubble, 0.5 * a * bubble, -y * f]
                    } else {
                        let sum = a * x + b * y - 1.0;
                        [
                            0.25 * f * g * sum,
                            0.25 * a * g * (sum + f),
                            0.25 * b * f * (sum + g),
                        ]
                    }
                })
                .collect(),
        }
    }
}

/// A face of an element on a tooth's outline.
#[derive(Debug, Clone, PartialEq)]
pub struct OutlineFace {
    /// Its shape.
    pub shape: FaceShape,
    /// Its nodes.
    pub nodes: Vec<u32>,
    /// Element behind it.
    pub element: u32,
    /// Place of each node on the unrolled outline \[arc, z\] \[m\]: arc length from the centre of the tooth space of
    /// the side asked for, and axial position. A helical tooth is turned back to z = 0 by [`crate::GearMesh::twist`].
    pub places_m: Vec<[f64; 2]>,
}

impl OutlineFace {
    /// Range of arc length (`axis` 0) or of z (`axis` 1) that the face covers \[m\].
    pub fn range_m(&self, axis: usize) -> [f64; 2] {
        let values = self.places_m.iter().map(|p| p[axis]);
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| {
            [low.min(v), high.max(v)]
        })
    }

    /// Corners of the face on the unrolled outline.
    pub fn corners_m(&self) -> &[[f64; 2]] {
        &self.places_m[..self.shape.corner_count()]
    }

    /// Place on the unrolled outline of a natural point, and its natural derivatives: \[place, ∂/∂ξ, ∂/∂η\].
    pub fn place_m(&self, natural: [f64; 2]) -> [[f64; 2]; 3] {
        let shapes = self.shape.shapes(natural);
        std::array::from_fn(|k| {
            std::array::from_fn(|axis| {
                let places = self.places_m.iter();
                shapes.iter().zip(places).map(|(n, p)| n[k] * p[axis]).sum()
            })
        })
    }

    /// Natural coordinates of a place on the unrolled outline. At once where the face is a parallelogram or a straight
    /// triangle there, by Newton's method otherwise.
    pub fn natural_at(&self, place_m: [f64; 2]) -> [f64; 2] {
        let mut natural = self.shape.centre();
        for _ in 0..20 {
            let [at, d_xi, d_eta] = self.place_m(natural);
            let miss = [place_m[0] - at[0], place_m[1] - at[1]];
            let det = d_xi[0] * d_eta[1] - d_xi[1] * d_eta[0];
            let step = [
                (miss[0] * d_eta[1] - miss[1] * d_eta[0]) / det,
                (d_xi[0] * miss[1] - d_xi[1] * miss[0]) / det,
            ];
            natural = [natural[0] + step[0], natural[1] + step[1]];
            if step[0].abs().max(step[1].abs()) < 1e-14 {
                break;
            }
        }
        natural
    }
}

/// The face of a hexahedron over a step of the outline from node `k` and a layer from section `l`: its places.
pub(crate) fn outline_face(
    order: usize,
    (k, l): (usize, usize),
) -> (FaceShape, Vec<(usize, usize)>) {
    let p = order;
    let corners = [(k, l), (k + p, l), (k + p, l + p), (k, l + p)];
    let middles = [(k + 1, l), (k + 2, l + 1), (k + 1, l + 2), (k, l + 1)];
    match p {
        1 => (FaceShape::Quad4, corners.to_vec()),
        _ => (FaceShape::Quad8, [corners, middles].concat()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn natural_nodes(shape: FaceShape) -> Vec<[f64; 2]> {
        let triangle = [
            [0.0, 0.0],
            [1.0, 0.0],
            [0.0, 1.0],
            [0.5, 0.0],
            [0.5, 0.5],
            [0.0, 0.5],
        ];
        match shape.corner_count() {
            3 => triangle[..shape.node_count()].to_vec(),
            _ => QUAD_NODES[..shape.node_count()].to_vec(),
        }
    }

    #[test]
    fn shape_functions_are_nodal_and_their_derivatives_are_theirs() {
        for shape in FaceShape::ALL {
            let nodes = natural_nodes(shape);
            for (i, &node) in nodes.iter().enumerate() {
                for (j, n) in shape.shapes(node).iter().enumerate() {
                    assert!((n[0] - f64::from(u8::from(i == j))).abs() < 1e-15);
                }
            }
            let (at, step) = ([0.2, 0.3], 1e-6);
            for axis in 0..2 {
                let (mut plus, mut minus) = (at, at);
                plus[axis] += step;
                minus[axis] -= step;
                let (p, m) = (shape.shapes(plus), shape.shapes(minus));
                for ((n, p), m) in shape.shapes(at).iter().zip(p).zip(m) {
                    assert!((n[1 + axis] - (p[0] - m[0]) / (2.0 * step)).abs() < 1e-9);
                }
            }
            let sum: f64 = shape.shapes(at).iter().map(|n| n[0]).sum();
            assert!((sum - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn a_place_leads_back_to_its_natural_point() {
        for shape in FaceShape::ALL {
            let bend = |[x, y]: [f64; 2]| [2e-3 * x + 3e-4 * y * y, 1e-3 * (y - 0.2 * x * y)];
            let face = OutlineFace {
                shape,
                nodes: (0..shape.node_count() as u32).collect(),
                element: 0,
                places_m: natural_nodes(shape).into_iter().map(bend).collect(),
            };
            let natural = [0.3, 0.4];
            let found = face.natural_at(face.place_m(natural)[0]);
            assert!((0..2).all(|k| (found[k] - natural[k]).abs() < 1e-13));
        }
    }
}
