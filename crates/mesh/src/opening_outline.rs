//! Outlines of holes and slots as the body's mesh follows them.

use crate::body_circles::GRADING;
use crate::grading::{Pieces, graded};
use gearmesh_geometry::{Openings, Slots};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Outline of an opening as (radius, polar angle from its centre): a multiple of four nodes, each followed by the
/// middle of the side after it.
pub(crate) fn opening_outline(openings: &Openings, body_m: f64) -> Vec<(f64, f64)> {
    match openings {
        Openings::Holes(h) => {
            let n = 2
                * ((TAU * h.radius_m / body_m.min(0.35 * h.radius_m)).ceil() as usize)
                    .next_multiple_of(4);
            (0..n)
                .map(|k| {
                    let a = TAU * k as f64 / n as f64;
                    cartesian_to_polar(
                        h.pitch_radius_m + h.radius_m * a.cos(),
                        h.radius_m * a.sin(),
                    )
                })
                .collect()
        }
        Openings::Slots(s) => slot_outline(s, body_m),
    }
}

fn cartesian_to_polar(x: f64, y: f64) -> (f64, f64) {
    (x.hypot(y), y.atan2(x))
}

/// Sides of a slot's corners over the corner's radius, and sides far from corners over the body's elements at least.
const AT_CORNER: f64 = 0.6;
const FAR_FROM_CORNER: f64 = 0.4;

/// A slot counter-clockwise from the middle of its outer arc: outer arc, corner, radial edge, corner, inner arc, ...
/// Sides are as long as the corners want, and longer with the distance from small ones; their middles stand between
/// the nodes.
fn slot_outline(s: &Slots, body_m: f64) -> Vec<(f64, f64)> {
    let (r_in, r_out, c, half) = (
        s.inner_radius_m,
        s.outer_radius_m,
        s.corner_radius_m,
        0.5 * s.width_rad,
    );
    let near = body_m.min(AT_CORNER * c);
    let far = near.max(FAR_FROM_CORNER * body_m);
    let size = |from_corner_m: f64| (near + GRADING * from_corner_m).min(far);
    let outer_centre = half - (c / (r_out - c)).asin();
    let inner_centre = half - (c / (r_in + c)).asin();
    // Places along a piece of the outline, each followed by the middle of the side after it.
    let sides = |from: f64, to: f64, corner: &dyn Fn(f64) -> f64, least: usize| -> Vec<f64> {
        let ends = graded(from, to, |x| size(corner(x)), Pieces::at_least(least));
        let with_middles = ends.windows(2).flat_map(|w| [w[0], 0.5 * (w[0] + w[1])]);
        with_middles.chain([to]).collect()
    };
    let corner = |radius: f64, angle: f64, from: f64, to: f64| -> Vec<(f64, f64)> {
        let n = 2 * ((c * (to - from).abs() / near).ceil() as usize).max(3);
        (0..=n)
            .map(|k| {
                let a = angle + from + (to - from) * k as f64 / n as f64;
                cartesian_to_polar(
                    radius * angle.cos() + c * a.cos(),
                    radius * angle.sin() + c * a.sin(),
                )
            })
            .collect()
    };
    // Upper half (positive angles): outer arc from the middle, corner, edge, corner, inner arc to the middle.
    let length = r_out * outer_centre;
    let outer = sides(0.0, length, &|x| length - x, 1);
    let mut upper: Vec<(f64, f64)> = (outer[..outer.len() - 1].iter())
        .map(|x| (r_out, x / r_out))
        .collect();
    let edge_turn = FRAC_PI_2 + half - outer_centre;
    upper.extend(corner(r_out - c, outer_centre, 0.0, edge_turn));
    let (from, to) = (
        ((r_out - c).powi(2) - c * c).sqrt(),
        ((r_in + c).powi(2) - c * c).sqrt(),
    );
    // Where the corners meet there is no edge between them.
    let edge = sides(from, to.min(from), &|r| (from - r).min(r - to).max(0.0), 1);
    upper.extend(edge[1..edge.len() - 1].iter().map(|r| (*r, half)));
    let inner_turn = FRAC_PI_2 + half - inner_centre;
    upper.extend(corner(r_in + c, inner_centre, inner_turn, PI));
    // The whole outline has twice as many sides as this half; an even half makes it a multiple of four.
    let length = r_in * inner_centre;
    let inner = |least: usize| sides(length, 0.0, &|x| length - x, least);
    let mut last = inner(1);
    let count = (last.len() - 1) / 2;
    if ((upper.len() - 1) / 2 + count) % 2 == 1 {
        last = inner(count + 1);
    }
    upper.extend(last[1..].iter().map(|x| (r_in, x / r_in)));
    let lower: Vec<(f64, f64)> = upper[1..upper.len() - 1]
        .iter()
        .rev()
        .map(|&(r, phi)| (r, -phi))
        .collect();
    upper.extend(lower);
    upper
}
