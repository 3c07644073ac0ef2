//! Structured hexahedral meshes of blocks and rings: for tests, benchmarks and size studies.

use std::f64::consts::TAU;

use crate::error::FeError;
use crate::material::Material;
use crate::model::FeModel;
use crate::quadratic_mesh::QuadraticMesh;
use gearmesh_elements::Element;

/// A mesh of hexahedra in VTK node order.
#[derive(Debug, Clone, PartialEq)]
pub struct StructuredMesh {
    /// Node coordinates (m).
    pub nodes: Vec<[f64; 3]>,
    /// Node indices of the hexahedra.
    pub hexes: Vec<[u32; 8]>,
}

/// Whether the first direction runs back into itself.
#[derive(Clone, Copy, PartialEq)]
enum FirstDirection {
    Open,
    Closed,
}

impl StructuredMesh {
    /// A block from the origin to `size` (m) with the given numbers of elements along x, y, z.
    pub fn block(counts: [usize; 3], size: [f64; 3]) -> Self {
        Self::mapped(counts, |s| std::array::from_fn(|k| s[k] * size[k]))
    }

    /// A block whose nodes are placed by `map` from [0, 1]³; the map must keep orientation.
    pub fn mapped(counts: [usize; 3], map: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        Self::build(counts, FirstDirection::Open, map)
    }

    /// A ring about z: numbers of elements around, radially and axially; inner and outer radius (m); width (m),
    /// z from −width/2 to width/2.
    pub fn ring(counts: [usize; 3], radii: [f64; 2], width: f64) -> Self {
        // Around is against the radial direction's right hand with z, so go round clockwise.
        Self::build(counts, FirstDirection::Closed, |s| {
            let radius = radii[0] + s[1] * (radii[1] - radii[0]);
            let angle = -TAU * s[0];
            [
                radius * angle.cos(),
                radius * angle.sin(),
                (s[2] - 0.5) * width,
            ]
        })
    }

    /// Indices of the nodes whose coordinates satisfy a condition.
    pub fn nodes_where(&self, condition: impl Fn([f64; 3]) -> bool) -> Vec<usize> {
        (0..self.nodes.len())
            .filter(|&n| condition(self.nodes[n]))
            .collect()
    }

    /// A model of any kind of element: hexahedra as they are or cut in wedges or tetrahedra, with nodes on their edges
    /// where `place` says (see [`QuadraticMesh::new`]) if the element has such.
    ///
    /// # Errors
    /// As [`FeModel::new`].
    pub fn into_model(
        self,
        material: Material,
        element: Element,
        place: impl FnMut([u32; 2], [[f64; 3]; 2]) -> [f64; 3],
    ) -> Result<FeModel, FeError> {
        match element {
            Element::Hex8 | Element::Hex8Incompatible => {
                FeModel::new(self.nodes, self.hexes, material, element)
            }
            Element::Wedge6 => FeModel::new(self.nodes.clone(), self.wedges(), material, element),
            Element::Hex20 => {
                let mesh = QuadraticMesh::new(self.nodes, &self.hexes, place);
                FeModel::new(mesh.nodes, mesh.elements, material, element)
            }
            Element::Tet10 => {
                let mesh =
                    QuadraticMesh::of_tetrahedra(self.nodes.clone(), &self.tetrahedra(), place);
                FeModel::new(mesh.nodes, mesh.elements, material, element)
            }
            Element::Wedge15 => {
                let mesh = QuadraticMesh::of_wedges(self.nodes.clone(), &self.wedges(), place);
                FeModel::new(mesh.nodes, mesh.elements, material, element)
            }
        }
    }

    /// Every hexahedron cut in two wedges along the diagonal 0-2 of its bottom.
    pub fn wedges(&self) -> Vec<[u32; 6]> {
        let of = |h: &[u32; 8]| [[0, 1, 2, 4, 5, 6], [0, 2, 3, 4, 6, 7]].map(|w| w.map(|i| h[i]));
        self.hexes.iter().flat_map(of).collect()
    }

    /// Every hexahedron cut in six tetrahedra about its diagonal 0-6; neighbours agree on the diagonals of faces.
    pub fn tetrahedra(&self) -> Vec<[u32; 4]> {
        const CUT: [[usize; 4]; 6] = [
            [0, 1, 2, 6],
            [0, 5, 1, 6],
            [0, 2, 3, 6],
            [0, 3, 7, 6],
            [0, 4, 5, 6],
            [0, 7, 4, 6],
        ];
        let of = |h: &[u32; 8]| CUT.map(|t| t.map(|i| h[i]));
        self.hexes.iter().flat_map(of).collect()
    }

    fn build(
        counts: [usize; 3],
        first: FirstDirection,
        map: impl Fn([f64; 3]) -> [f64; 3],
    ) -> Self {
        let [nx, ny, nz] = counts;
        let node_x = if first == FirstDirection::Closed {
            nx
        } else {
            nx + 1
        };
        let mut nodes = Vec::with_capacity(node_x * (ny + 1) * (nz + 1));
        for k in 0..=nz {
            for j in 0..=ny {
                for i in 0..node_x {
                    nodes.push(map([
                        i as f64 / nx as f64,
                        j as f64 / ny as f64,
                        k as f64 / nz as f64,
                    ]));
                }
            }
        }
        let at = |i: usize, j: usize, k: usize| ((k * (ny + 1) + j) * node_x + i % node_x) as u32;
        let mut hexes = Vec::with_capacity(nx * ny * nz);
        for k in 0..nz {
            for j in 0..ny {
                for i in 0..nx {
                    hexes.push([
                        at(i, j, k),
                        at(i + 1, j, k),
                        at(i + 1, j + 1, k),
                        at(i, j + 1, k),
                        at(i, j, k + 1),
                        at(i + 1, j, k + 1),
                        at(i + 1, j + 1, k + 1),
                        at(i, j + 1, k + 1),
                    ]);
                }
            }
        }
        Self { nodes, hexes }
    }
}
