//! Points of a whole gear in the frame of one of its teeth.

use gearmesh_geometry::Flank;
use std::f64::consts::TAU;

/// The tooth in whose pitch a point lies.
pub(crate) fn nearest_tooth([x, y, _]: [f64; 3], teeth: usize) -> usize {
    let pitch = TAU / teeth as f64;
    (y.atan2(x) / pitch).round().rem_euclid(teeth as f64) as usize
}

/// A point \[x, y\] in the frame of a tooth's right half: turned back to +x, and mirrored for the left side.
pub(crate) fn in_tooth([x, y, _]: [f64; 3], tooth: usize, teeth: usize, side: Flank) -> [f64; 2] {
    let (sin, cos) = (TAU * tooth as f64 / teeth as f64).sin_cos();
    let turned = [cos * x + sin * y, cos * y - sin * x];
    [turned[0], side.mirror() * turned[1]]
}
