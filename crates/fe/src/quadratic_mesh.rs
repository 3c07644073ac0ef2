//! Quadratic elements from linear ones: one node more on every edge.

use std::collections::HashMap;

use gearmesh_elements::{HEX_EDGES, TET_EDGES, WEDGE_EDGES};

/// A mesh of quadratic elements of N nodes in VTK node order.
#[derive(Debug, Clone, PartialEq)]
pub struct QuadraticMesh<const N: usize = 20> {
    /// Node coordinates (m): the corners with their old numbers, then the mid-edge nodes.
    pub nodes: Vec<[f64; 3]>,
    /// Node indices of the elements.
    pub elements: Vec<[u32; N]>,
}

impl QuadraticMesh<20> {
    /// Twenty-node hexahedra. `place(a, b)` gives the position (m) of the node between two corners, given with their
    /// node numbers: the middle of the chord where an edge is straight, a point of the curve near its middle where the
    /// body is curved. It is asked once per edge, the smaller node number first.
    ///
    /// # Panics
    /// If an element names a node that does not exist, or the nodes pass 2³².
    pub fn new(
        nodes: Vec<[f64; 3]>,
        hexes: &[[u32; 8]],
        place: impl FnMut([u32; 2], [[f64; 3]; 2]) -> [f64; 3],
    ) -> Self {
        with_edge_nodes(nodes, hexes, &HEX_EDGES, place)
    }
}

impl QuadraticMesh<10> {
    /// Ten-node tetrahedra; `place` as in [`QuadraticMesh::new`].
    ///
    /// # Panics
    /// As [`QuadraticMesh::new`].
    pub fn of_tetrahedra(
        nodes: Vec<[f64; 3]>,
        tetrahedra: &[[u32; 4]],
        place: impl FnMut([u32; 2], [[f64; 3]; 2]) -> [f64; 3],
    ) -> Self {
        with_edge_nodes(nodes, tetrahedra, &TET_EDGES, place)
    }
}

impl QuadraticMesh<15> {
    /// Fifteen-node wedges; `place` as in [`QuadraticMesh::new`].
    ///
    /// # Panics
    /// As [`QuadraticMesh::new`].
    pub fn of_wedges(
        nodes: Vec<[f64; 3]>,
        wedges: &[[u32; 6]],
        place: impl FnMut([u32; 2], [[f64; 3]; 2]) -> [f64; 3],
    ) -> Self {
        with_edge_nodes(nodes, wedges, &WEDGE_EDGES, place)
    }
}

fn with_edge_nodes<const C: usize, const N: usize>(
    mut nodes: Vec<[f64; 3]>,
    elements: &[[u32; C]],
    edges: &[[usize; 2]],
    mut place: impl FnMut([u32; 2], [[f64; 3]; 2]) -> [f64; 3],
) -> QuadraticMesh<N> {
    let mut on_edge: HashMap<[u32; 2], u32> = HashMap::new();
    let elements = elements
        .iter()
        .map(|corners| {
            let mut element = [0; N];
            element[..C].copy_from_slice(corners);
            for (node, &[a, b]) in element[C..].iter_mut().zip(edges) {
                let mut edge = [corners[a], corners[b]];
                edge.sort_unstable();
                *node = *on_edge.entry(edge).or_insert_with(|| {
                    nodes.push(place(edge, edge.map(|n| nodes[n as usize])));
                    (nodes.len() - 1) as u32
                });
            }
            element
        })
        .collect();
    assert!(
        u32::try_from(nodes.len()).is_ok(),
        "node numbers of 32 bits"
    );
    QuadraticMesh { nodes, elements }
}

impl<const N: usize> QuadraticMesh<N> {
    /// Indices of the nodes whose coordinates satisfy a condition.
    pub fn nodes_where(&self, condition: impl Fn([f64; 3]) -> bool) -> Vec<usize> {
        (0..self.nodes.len())
            .filter(|&n| condition(self.nodes[n]))
            .collect()
    }
}

/// Middle of a chord.
pub fn chord_middle([a, b]: [[f64; 3]; 2]) -> [f64; 3] {
    std::array::from_fn(|k| 0.5 * (a[k] + b[k]))
}

/// The point midway between two points of a body of revolution about z, at their mean angle, mean radius and mean
/// height: on the circle where both lie on one. Neither may lie on the axis, nor both opposite each other.
pub fn arc_middle([a, b]: [[f64; 3]; 2]) -> [f64; 3] {
    let radii = [a, b].map(|p| p[0].hypot(p[1]));
    let direction = |k: usize| a[k] / radii[0] + b[k] / radii[1];
    let scale = 0.5 * (radii[0] + radii[1]) / direction(0).hypot(direction(1));
    [
        scale * direction(0),
        scale * direction(1),
        0.5 * (a[2] + b[2]),
    ]
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::{Element, FeModel, Material, StructuredMesh};

    /// Euler's count for a block: edges of an n³ grid are 3 n (n + 1)².
    #[test]
    fn every_edge_gets_one_node() {
        let n = 3;
        let block = StructuredMesh::block([n; 3], [1.0; 3]);
        let corners = block.nodes.len();
        let mesh = QuadraticMesh::new(block.nodes, &block.hexes, |_, ends| chord_middle(ends));
        assert_eq!(mesh.nodes.len() - corners, 3 * n * (n + 1) * (n + 1));
        let steel = Material::new(210e9, 0.3).unwrap();
        let model = FeModel::new(mesh.nodes, mesh.elements, steel, Element::Hex20).unwrap();
        assert!((model.volume().unwrap() - 1.0).abs() < 1e-14);
    }

    /// The volume of a ring with parabolas for arcs converges with the fourth power of the element's angle.
    #[test]
    fn a_ring_is_round_to_fourth_order() {
        let error = |around: usize| {
            let ring = StructuredMesh::ring([around, 1, 1], [1.0, 2.0], 1.0);
            let mesh = QuadraticMesh::new(ring.nodes, &ring.hexes, |_, ends| arc_middle(ends));
            let steel = Material::new(210e9, 0.3).unwrap();
            let model = FeModel::new(mesh.nodes, mesh.elements, steel, Element::Hex20).unwrap();
            (model.volume().unwrap() / (3.0 * std::f64::consts::PI) - 1.0).abs()
        };
        let order = (error(8) / error(16)).log2();
        assert!((order - 4.0).abs() < 0.1, "order {order}");
    }
}
