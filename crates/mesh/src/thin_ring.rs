//! A ring of the body that is thinner than its elements are long: paved in rows, each quad beside the one above it.
//!
//! A free mesh is made between straight lines over two pieces of a circle each. Such a chord of length 2 h leaves its
//! circle by h²/(2 r): in a ring as thin as that the lines of the outer circle cut those of the inner one, and quads
//! are inverted. Rows with equal numbers of pieces on all circles have right angles however thin the ring is.

/// Rings thinner than this share of the element length are paved in rows.
const SHARE: f64 = 0.25;
/// Rings thinner than this multiple of a chord's distance from its circle likewise.
const CHORDS: f64 = 4.0;

/// Whether the ring between two radii is paved in rows where elements are to be `length_m` long.
pub(crate) fn is_thin(one_m: f64, other_m: f64, length_m: f64) -> bool {
    let height = (one_m - other_m).abs();
    let from_circle = 0.5 * length_m * length_m / one_m.min(other_m);
    height < SHARE * length_m || height < CHORDS * from_circle
}

/// Circles of nodes at the radii `steps_m` between the ring's two, of `count` nodes each. The first and the last node
/// of each are those of the sector's two edges, where it has edges; the others are added by radius and place.
pub(crate) fn circles(
    steps_m: &[f64],
    [first, last]: &[Vec<usize>; 2],
    count: usize,
    mut add: impl FnMut(f64, usize) -> usize,
) -> Vec<Vec<usize>> {
    let row = |(i, &r): (usize, &f64)| {
        (0..count)
            .map(|k| match (k, first.get(i), last.get(i)) {
                (0, Some(&node), _) => node,
                (k, _, Some(&node)) if k + 1 == count => node,
                _ => add(r, k),
            })
            .collect()
    };
    steps_m.iter().enumerate().map(row).collect()
}

/// Quads between consecutive circles, from the outermost inwards.
pub(crate) fn quads(circles: &[&[usize]], closed: bool) -> Vec<[usize; 4]> {
    let between = |pair: &[&[usize]]| {
        let (outer, inner) = (pair[0].to_vec(), pair[1].to_vec());
        let n = outer.len();
        let pieces = if closed { n } else { n - 1 };
        (0..pieces).map(move |k| {
            let next = (k + 1) % n;
            [inner[k], outer[k], outer[next], inner[next]]
        })
    };
    circles.windows(2).flat_map(between).collect()
}
