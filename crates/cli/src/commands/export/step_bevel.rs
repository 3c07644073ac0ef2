//! A bevel gear's exact flanks as STEP: sections of the tooth through exact points, skinned from toe to heel.

use crate::failure::Failure;
use gearmesh_bevel::{BevelGear, FlankPatch};
use gearmesh_geometry::Flank;
use gearmesh_mesh::bevel_level::{Level, Levels};
use serde_json::{Value, json};
use std::f64::consts::PI;

pub const WRITE: &str = include_str!("../../step/write_bevel.py");

/// Sections from toe to heel.
const SECTIONS: usize = 17;
/// Pieces of a section's fillet above P and of its flank.
const PIECES: [usize; 2] = [12, 20];
/// Length of the pieces of the fillet below P, in mean modules.
const FILLET_PIECE: f64 = 0.03;
/// Places on a flank and a fillet, along the profile and along the face, at which the file is compared with the exact surface.
const CHECKED: [usize; 2] = [9, 7];

/// Points of the sections in pieces, rings of the body, and points of the exact surfaces to compare with; lengths in mm.
pub fn description(gear: &BevelGear) -> Result<Value, Failure> {
    let mut fine = gear.clone();
    fine.mesh.fillet_m = FILLET_PIECE * gear.mean_module_m();
    let levels = Levels::new(&fine, 1).map_err(Failure::work)?;
    let levels = levels.with_pieces(PIECES);
    let sections = (0..SECTIONS)
        .map(|k| {
            let level = levels.level(share(k, SECTIONS)).map_err(Failure::work)?;
            Ok(pieces(&levels, &level))
        })
        .collect::<Result<Vec<_>, Failure>>()?;
    let blank = gear.blank();
    let ends = [blank.inner_cone_m(), blank.outer_cone_m];
    let rings = [0, 1].map(|k: usize| {
        let [z, r] = blank.meridian_m(ends[k], -blank.dedendum_m(ends[k]) - gear.body.rim_m);
        let mut rings = vec![[1e3 * r, 1e3 * z]];
        rings.extend(
            gear.body
                .contour
                .iter()
                .map(|p| [1e3 * p.radius_m, 1e3 * p.z_m[k]]),
        );
        rings
    });
    let mut checked = serde_json::Map::new();
    for side in Flank::ALL {
        let patch = gear.patch(side).map_err(Failure::work)?;
        checked.insert(format!("{side} flank"), json!(flank_points(&patch)));
        let fillet = fillet_points(gear, side)?;
        checked.insert(format!("{side} fillet"), json!(fillet));
    }
    let [toe, heel] = rings;
    Ok(json!({
        "teeth": blank.teeth,
        "sections": sections,
        "rings": { "toe": toe, "heel": heel },
        "checked": checked,
    }))
}

/// Closer towards the ends, as splines want it.
fn share(k: usize, count: usize) -> f64 {
    0.5 * (1.0 - (PI * k as f64 / (count - 1) as f64).cos())
}

/// A section's outline from the middle of one tooth space to the next: bottom, fillet, flank, tip, flank, fillet, bottom \[mm\].
fn pieces(levels: &Levels<'_>, level: &Level) -> Vec<Vec<[f64; 3]>> {
    let s = &levels.spacing;
    let root = s.bottom.len() - 1;
    let flank = root + s.low.len() + s.high.len() - 2;
    let mm = |points: &[[f64; 3]]| -> Vec<[f64; 3]> {
        points.iter().map(|p| p.map(|x| 1e3 * x)).collect()
    };
    let [right, left] = &level.outline_points_m;
    let three = |line: &[[f64; 3]]| {
        [
            mm(&line[..=root]),
            mm(&line[root..=flank]),
            mm(&line[flank..]),
        ]
    };
    let [bottom_r, fillet_r, flank_r] = three(right);
    let mut others = three(left);
    for points in &mut others {
        points.reverse();
    }
    let [bottom_l, fillet_l, flank_l] = others;
    let tip = arc(flank_r[flank_r.len() - 1], flank_l[0]);
    vec![
        bottom_r, fillet_r, flank_r, tip, flank_l, fillet_l, bottom_l,
    ]
}

/// Points on the circle about the axis from one point to another.
fn arc(from: [f64; 3], to: [f64; 3]) -> Vec<[f64; 3]> {
    let angle = |p: [f64; 3]| p[1].atan2(p[0]);
    let (a, b) = (angle(from), angle(to));
    (0..=4)
        .map(|k| match k {
            0 => from,
            4 => to,
            _ => {
                let share = f64::from(k) / 4.0;
                let (s, c) = (a + share * (b - a)).sin_cos();
                let radius = (1.0 - share) * from[0].hypot(from[1]) + share * to[0].hypot(to[1]);
                [
                    radius * c,
                    radius * s,
                    (1.0 - share) * from[2] + share * to[2],
                ]
            }
        })
        .collect()
}

/// Points of the exact flank, none of which the splines go through but those at the edges \[mm\].
fn flank_points(patch: &FlankPatch) -> Vec<[f64; 3]> {
    let mut points = Vec::new();
    for i in 0..CHECKED[0] {
        for j in 0..CHECKED[1] {
            let even = |k: usize, count: usize| k as f64 / (count - 1) as f64;
            let at = [even(j, CHECKED[1]), even(i, CHECKED[0])];
            let r = patch.point(at).r;
            points.push([r.x, r.y, r.z].map(|x| 1e3 * x));
        }
    }
    points
}

/// Points of the exact fillet \[mm\].
fn fillet_points(gear: &BevelGear, side: Flank) -> Result<Vec<[f64; 3]>, Failure> {
    let blank = gear.blank();
    let flank_side = gear.flank_side(side);
    let flank = gear.tooth.flank(flank_side);
    let (sin, cos) = gear.tooth.half_angle_rad(flank_side).sin_cos();
    let shares: Vec<f64> = (0..CHECKED[0])
        .map(|k| k as f64 / (CHECKED[0] - 1) as f64)
        .collect();
    let mut points = Vec::new();
    for j in 0..CHECKED[1] {
        let along = j as f64 / (CHECKED[1] - 1) as f64;
        let cone_m = blank.inner_cone_m() + along * blank.face_width_m;
        let line = flank.fillet_line(cone_m, &shares).map_err(Failure::work)?;
        points.extend(line.iter().map(|found| {
            let r = found.point.r;
            [cos * r.x - sin * r.y, sin * r.x + cos * r.y, r.z].map(|x| 1e3 * x)
        }));
    }
    Ok(points)
}
