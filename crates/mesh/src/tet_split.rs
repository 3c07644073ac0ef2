//! Bricks above the quads of a tooth's section, split into tetrahedra that meet those of their neighbours.
//!
//! A quad is cut along a diagonal, the prism above each triangle into three tetrahedra. Where the prism's sides are cut
//! follows from an order of the section's nodes alone: from the lower node of the earlier one to the upper node of the
//! later one (J. Dompierre et al., *How to subdivide pyramids, prisms and hexahedra into tetrahedra*, 8th Int. Meshing
//! Roundtable 1999). So two prisms cut their common side alike, layers lie on each other, and all teeth are split in
//! the same way.

use crate::tooth_cell::ToothCell;

/// Tetrahedra of one brick.
pub const TETRAHEDRA: usize = 6;

/// A corner of a brick: number in the quad, and below (0) or above (1).
pub type BrickCorner = (usize, usize);

/// Order of the nodes of a tooth cell by which sides are cut. Along both sides of the cell it runs inwards, so that
/// neighbouring teeth agree, and along the ring's inner circle counter-clockwise.
pub fn node_order(cell: &ToothCell) -> Vec<usize> {
    let count = cell.nodes.len();
    let mut order: Vec<usize> = (0..count).map(|n| 2 * count + n).collect();
    for (k, &n) in cell.bottom.iter().enumerate() {
        order[n] = count + k;
    }
    for (k, (&right, &left)) in cell.right_side.iter().zip(&cell.left_side).enumerate() {
        order[right] = k;
        order[left] = 3 * count + k;
    }
    order
}

/// The tetrahedra of the brick above a quad, corners 0-2 counter-clockwise seen from corner 3, by the order of the
/// quad's nodes and their places \[x, y\]; the quad is cut along its shorter diagonal.
pub fn tetrahedra(order: [usize; 4], places: [[f64; 2]; 4]) -> [[BrickCorner; 4]; TETRAHEDRA] {
    let diagonal =
        |a: usize, b: usize| (places[a][0] - places[b][0]).hypot(places[a][1] - places[b][1]);
    let triangles = if diagonal(0, 2) <= diagonal(1, 3) {
        [[0, 1, 2], [0, 2, 3]]
    } else {
        [[0, 1, 3], [1, 2, 3]]
    };
    let mut all = [[(0, 0); 4]; TETRAHEDRA];
    for (t, triangle) in triangles.into_iter().enumerate() {
        let mut sorted = triangle;
        sorted.sort_by_key(|&corner| order[corner]);
        let [u, v, w] = sorted;
        let at = |corner: usize| triangle.iter().position(|&c| c == corner);
        let even = matches!((at(u), at(v)), (Some(a), Some(b)) if (a + 1) % 3 == b);
        let split = [
            [(u, 0), (v, 0), (w, 0), (w, 1)],
            [(u, 0), (v, 1), (v, 0), (w, 1)],
            [(u, 0), (v, 1), (w, 1), (u, 1)],
        ];
        for (k, mut tetrahedron) in split.into_iter().enumerate() {
            if !even {
                tetrahedron.swap(1, 2);
            }
            all[3 * t + k] = tetrahedron;
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [1.1, 0.0], [1.0, 1.0], [0.0, 1.0]];

    fn point((corner, level): BrickCorner) -> [f64; 3] {
        [SQUARE[corner][0], SQUARE[corner][1], level as f64]
    }

    /// Whatever the order of the nodes: six tetrahedra the right way round fill the brick, and its sides are cut from
    /// the lower earlier to the upper later node.
    #[test]
    fn every_order_fills_the_brick() {
        let mut orders = Vec::new();
        for code in 0..256 {
            let order = [code % 4, code / 4 % 4, code / 16 % 4, code / 64];
            if (0..4).all(|k| order.contains(&k)) {
                orders.push(order);
            }
        }
        assert_eq!(orders.len(), 24);
        for order in orders {
            let mut volume = 0.0;
            let mut edges = std::collections::BTreeSet::new();
            for corners in tetrahedra(order, SQUARE) {
                let [o, a, b, c] = corners.map(point);
                let [u, v, w] = [a, b, c].map(|p| [0, 1, 2].map(|k| p[k] - o[k]));
                let six = u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0])
                    + u[2] * (v[0] * w[1] - v[1] * w[0]);
                assert!(six > 0.5, "{order:?} {corners:?} {six}");
                volume += six / 6.0;
                for p in corners {
                    for q in corners {
                        edges.insert((p, q));
                    }
                }
            }
            assert!((volume - 1.05).abs() < 1e-14, "{volume}");
            for k in 0..4 {
                let next = (k + 1) % 4;
                let rises = order[k] < order[next];
                assert_eq!(edges.contains(&((k, 0), (next, 1))), rises);
                assert_eq!(edges.contains(&((k, 1), (next, 0))), !rises);
            }
        }
    }
}
