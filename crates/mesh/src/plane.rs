//! Points of a plane: between two of them, how far apart they are, and Coons' patch.

pub(crate) type Point = [f64; 2];

/// A share of the way from one point to another.
pub(crate) fn lerp(a: Point, b: Point, share: f64) -> Point {
    [0, 1].map(|k| a[k] + share * (b[k] - a[k]))
}

pub(crate) fn apart(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Lengths of a broken line from its first point to each of its points.
pub(crate) fn arc_lengths(line: &[Point]) -> Vec<f64> {
    let mut arcs = vec![0.0];
    for pair in line.windows(2) {
        arcs.push(arcs[arcs.len() - 1] + apart(pair[0], pair[1]));
    }
    arcs
}

/// A place of a Coons patch, (1−t) R(s) + t L(s) + (1−s) B(t) + s T(t) − (corners, bilinear): a point of each of its
/// four edges there, `[R, L]` and `[B, T]`, and its corners, those at s = 0 and those at s = 1, R first.
pub(crate) fn coons(
    [right, left]: [Point; 2],
    [bottom, top]: [Point; 2],
    corners: [[Point; 2]; 2],
    (s, t): (f64, f64),
) -> Point {
    let [low, high] = corners;
    std::array::from_fn(|axis| {
        let corners = (1.0 - s) * ((1.0 - t) * low[0][axis] + t * low[1][axis])
            + s * ((1.0 - t) * high[0][axis] + t * high[1][axis]);
        (1.0 - t) * right[axis] + t * left[axis] + (1.0 - s) * bottom[axis] + s * top[axis]
            - corners
    })
}
