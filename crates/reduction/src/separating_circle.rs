//! A circle of few nodes that parts a body: that between hub and web, as a rule.
//!
//! What is inside of it is then eliminated without the rim, and loads on teeth do not reach it: their half solves pass
//! through the rim, the web and the circle only. Nested dissection by itself cuts hub, web and rim along radii, with
//! fewer nodes in each cut, and every tooth reaches some of each. Which nodes are eliminated late changes the cost
//! only, no result beyond rounding.

use std::collections::BTreeSet;

/// Nodes on one circle lie so near to it (m).
const SAME_M: f64 = 1e-9;

/// Nodes of the circle by which the fewest nodes part a body's elements, those outside of it from those inside; none
/// where no circle does, or only one of more nodes than the cuts of a compact body have, (elements)^(2/3). `nodes` are
/// those of `elements`' numbers \[m\], the axis is z; `is_free` tells which may move.
pub(crate) fn separating_circle<'a>(
    nodes: &[[f64; 3]],
    elements: impl Iterator<Item = &'a [u32]> + Clone,
    is_free: impl Fn(u32) -> bool,
) -> Vec<u32> {
    let radius = |node: u32| nodes[node as usize][0].hypot(nodes[node as usize][1]);
    let mut radii: BTreeSet<i64> = BTreeSet::new();
    // Smallest and largest radius of each element.
    let spans: Vec<(f64, f64)> = (elements.clone())
        .map(|element| {
            let of_nodes = || element.iter().map(|&node| radius(node));
            radii.extend(of_nodes().map(|r| (r / SAME_M).round() as i64));
            let least = of_nodes().fold(f64::INFINITY, f64::min);
            (least, of_nodes().fold(0.0, f64::max))
        })
        .collect();
    let inner = spans
        .iter()
        .fold(f64::INFINITY, |least, span| least.min(span.0));
    let outer = spans.iter().fold(0.0_f64, |most, span| most.max(span.1));
    let mut best: Vec<u32> = Vec::new();
    for place in radii {
        let r = place as f64 * SAME_M;
        let (below, above) = (r - 2.0 * SAME_M, r + 2.0 * SAME_M);
        let is_inside = below > inner && above < outer;
        if !is_inside
            || spans
                .iter()
                .any(|&(least, most)| least < below && most > above)
        {
            continue;
        }
        let mut on_circle: Vec<u32> = (elements.clone().zip(&spans))
            .filter(|(_, (_, most))| *most > above)
            .flat_map(|(element, _)| element)
            .copied()
            .filter(|&node| radius(node) < above && is_free(node))
            .collect();
        on_circle.sort_unstable();
        on_circle.dedup();
        if best.is_empty() || on_circle.len() < best.len() {
            best = on_circle;
        }
    }
    // A mesh of hexahedra has about as many nodes as elements.
    if best.len() as f64 > (spans.len() as f64).powf(2.0 / 3.0) {
        best.clear();
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Rings of quads, `around` to a turn between given radii.
    fn rings(radii: &[f64], around: usize) -> (Vec<[f64; 3]>, Vec<[u32; 4]>) {
        let nodes = radii
            .iter()
            .flat_map(|r| {
                (0..around).map(move |k| {
                    let angle = TAU * k as f64 / around as f64;
                    [r * angle.cos(), r * angle.sin(), 0.0]
                })
            })
            .collect();
        let number = |ring: usize, k: usize| (ring * around + k % around) as u32;
        let elements = (1..radii.len())
            .flat_map(|i| {
                (0..around).map(move |k| {
                    [
                        number(i - 1, k),
                        number(i - 1, k + 1),
                        number(i, k + 1),
                        number(i, k),
                    ]
                })
            })
            .collect();
        (nodes, elements)
    }

    #[test]
    fn the_circle_of_fewest_nodes_is_found_and_none_where_elements_span_it() {
        let radii: Vec<f64> = (10..40).map(|r| f64::from(r) * 1e-3).collect();
        let (nodes, mut elements) = rings(&radii, 12);
        let found = |elements: &[[u32; 4]], held: &[u32]| {
            let lists = elements.iter().map(|element| &element[..]);
            separating_circle(&nodes, lists, |node| !held.contains(&node))
        };
        // All circles have twelve nodes but the one with three that are held.
        let held: Vec<u32> = (60..63).collect();
        assert_eq!(found(&elements, &held), (63..72).collect::<Vec<_>>());
        // An element over three rings closes the two circles within it.
        elements.push([48, 49, 85, 84]);
        let circle = found(&elements, &held);
        assert_eq!(circle.len(), 12);
        assert!(
            !circle.iter().any(|node| (60..84).contains(node)),
            "{circle:?}"
        );
        // Coarse all round: its circles have as many nodes as any cut.
        let (nodes, elements) = rings(&[1e-2, 2e-2, 3e-2], 12);
        let lists = elements.iter().map(|element| &element[..]);
        assert_eq!(separating_circle(&nodes, lists, |_| true), [0; 0]);
    }
}
