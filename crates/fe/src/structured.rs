//! Structured hexahedral meshes of blocks and rings: for tests, benchmarks and size studies.

use std::f64::consts::TAU;

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
