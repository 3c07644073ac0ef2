//! Nodes in the middle of the sides of quads, for quadratic elements.
//!
//! A side that is a piece of the outline, of a circle or of an opening has its node on that curve, half way along it,
//! so that the parabola through the three nodes meets the curve to the fourth power of its length. All other sides are
//! straight.

use crate::plane_mesher::PlaneMesh;
use std::collections::HashMap;

/// The middles \[x, y\] \[m\] of the sides that are not straight, by their two nodes.
#[derive(Debug, Clone, Default)]
pub struct CurvedSides(HashMap<[usize; 2], [f64; 2]>);

fn key(a: usize, b: usize) -> [usize; 2] {
    [a.min(b), a.max(b)]
}

impl CurvedSides {
    /// Tells the middle of the side between two nodes.
    pub fn insert(&mut self, a: usize, b: usize, middle: [f64; 2]) {
        self.0.insert(key(a, b), middle);
    }

    /// The sides between consecutive nodes of a chain are arcs of one circle about the axis; `points` are all nodes'
    /// \[x, y\].
    pub fn insert_arcs(
        &mut self,
        chain: &[usize],
        closed: bool,
        points: impl Fn(usize) -> [f64; 2],
    ) {
        for [a, b] in sides(chain, closed) {
            let (p, q) = (points(a), points(b));
            let middle = [p[0] + q[0], p[1] + q[1]];
            let scale = p[0].hypot(p[1]) / middle[0].hypot(middle[1]);
            self.insert(a, b, middle.map(|v| scale * v));
        }
    }
}

/// Consecutive pairs of a chain; a closed one ends where it began.
fn sides(chain: &[usize], closed: bool) -> impl Iterator<Item = [usize; 2]> {
    let last = chain.last().zip(chain.first()).filter(|_| closed);
    let pairs = chain.windows(2).map(|w| [w[0], w[1]]);
    pairs.chain(last.map(|(&a, &b)| [a, b]))
}

/// Where the nodes in the middle of sides are.
#[derive(Debug, Clone)]
pub struct MidSides(HashMap<[usize; 2], usize>);

impl MidSides {
    /// Adds a node in the middle of each side of a mesh of quads.
    pub fn add(mesh: &mut PlaneMesh, curved: &CurvedSides) -> Self {
        let mut on_side: HashMap<[usize; 2], usize> = HashMap::new();
        let nodes = &mut mesh.nodes;
        mesh.mid_sides = mesh
            .quads
            .iter()
            .map(|quad| {
                std::array::from_fn(|k| {
                    let [a, b] = key(quad[k], quad[(k + 1) % 4]);
                    *on_side.entry([a, b]).or_insert_with(|| {
                        let (p, q) = (nodes[a], nodes[b]);
                        let straight = [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])];
                        nodes.push(curved.0.get(&[a, b]).copied().unwrap_or(straight));
                        nodes.len() - 1
                    })
                })
            })
            .collect();
        Self(on_side)
    }

    /// The nodes in the middle of the sides along a chain.
    pub fn along(&self, chain: &[usize]) -> Vec<usize> {
        let middles = sides(chain, false).filter_map(|[a, b]| self.0.get(&key(a, b)));
        middles.copied().collect()
    }

    /// A chain with the nodes in the middle of its sides between its own.
    pub fn interleaved(&self, chain: &[usize], closed: bool) -> Vec<usize> {
        let mut all = Vec::with_capacity(2 * chain.len());
        for [a, b] in sides(chain, closed) {
            all.push(a);
            all.extend(self.0.get(&key(a, b)));
        }
        if !closed {
            all.extend(chain.last());
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_are_shared_and_chains_keep_their_order() {
        // Two quads side by side; their common lower nodes 0, 1, 2 on a circle of radius 1.
        let polar = |r: f64, a: f64| [r * a.cos(), r * a.sin()];
        let mut mesh = PlaneMesh {
            nodes: vec![
                polar(1.0, 0.3),
                polar(1.0, 0.0),
                polar(1.0, -0.3),
                polar(2.0, 0.3),
                polar(2.0, 0.0),
                polar(2.0, -0.3),
            ],
            quads: vec![[0, 1, 4, 3], [1, 2, 5, 4]],
            mid_sides: Vec::new(),
            owners: vec![0, 0],
        };
        let mut curved = CurvedSides::default();
        let points = mesh.nodes.clone();
        curved.insert_arcs(&[0, 1, 2], false, |n| points[n]);
        let middles = MidSides::add(&mut mesh, &curved);
        assert_eq!(mesh.nodes.len(), 6 + 7);
        assert_eq!(mesh.mid_sides[0][1], mesh.mid_sides[1][3]);
        let chain = middles.interleaved(&[2, 1, 0], false);
        assert_eq!((chain[0], chain[2], chain[4]), (2, 1, 0));
        assert_eq!(middles.along(&[2, 1, 0]), [chain[1], chain[3]]);
        for (n, angle) in [(chain[1], -0.15), (chain[3], 0.15)] {
            let [x, y] = polar(1.0, angle);
            assert!((mesh.nodes[n][0] - x).hypot(mesh.nodes[n][1] - y) < 1e-15);
        }
        // Straight where nothing was stated.
        let [x, y] = mesh.nodes[mesh.mid_sides[0][2]];
        assert!(x.hypot(y) < 2.0 - 0.02);
        assert_eq!(middles.interleaved(&[0, 1], true).len(), 4);
    }
}
