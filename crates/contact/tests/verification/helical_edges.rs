//! Tip edges of helical teeth on the mate's flank: gaps and lever arms against points of both helicoids in space, and a
//! transmission error without jumps.

use crate::pair_common;

use gearmesh_contact::{
    ContactLines, Drive, FlanksAtRest, InvoluteAtRest, PathExtension, SliceLayout,
};
use gearmesh_geometry::{Flank, GearPair};
use nalgebra::Vector3;
use pair_common::{FRICTIONLESS, contact, helical};

const SLICES: usize = 5;

fn lines() -> ContactLines {
    let lines = helical(20.0, Flank::Right);
    let extension = Some(PathExtension::new(&lines.pair, 100e-6));
    ContactLines { extension, ..lines }
}

/// A point of a right flank in a frame with gear 1's axis along z through the origin and gear 2's through +x: the
/// transverse section, turned by the helix. `turned_rad` from pair 0 at the pitch point, in the gear's own sense.
fn placed(
    pair: &GearPair,
    gear: usize,
    turned_rad: f64,
    [roll_rad, z_m]: [f64; 2],
) -> Vector3<f64> {
    let tooth = [&pair.gear_1, &pair.gear_2][gear];
    let [point, pitch_point] = [roll_rad, pair.working_pressure_angle_rad.tan()]
        .map(|roll| tooth.flank_point_m(Flank::Right, roll));
    let (start, sense, centre_m) = match gear {
        0 => (0.0, -1.0, 0.0),
        _ => (std::f64::consts::PI, 1.0, pair.centre_distance_m),
    };
    let helix = z_m * tooth.helix_angle_rad.tan() / tooth.reference_radius_m;
    let angle = start - pitch_point[1].atan2(pitch_point[0]) + sense * turned_rad + helix;
    let (s, c) = angle.sin_cos();
    Vector3::new(
        centre_m + c * point[0] - s * point[1],
        s * point[0] + c * point[1],
        z_m,
    )
}

/// Least distance of a point to a flank in space \[m\], by sampling in ever smaller windows about a first place.
fn distance_m(
    pair: &GearPair,
    gear: usize,
    turned_rad: f64,
    from: Vector3<f64>,
    first: [f64; 2],
) -> f64 {
    let (mut best, mut centre, mut reach) = (f64::INFINITY, first, [0.05, 1e-3]);
    for _ in 0..24 {
        let middle = centre;
        for i in -10..=10 {
            for k in -10..=10 {
                let at = [
                    middle[0] + reach[0] * f64::from(i) / 10.0,
                    middle[1] + reach[1] * f64::from(k) / 10.0,
                ];
                let own = (placed(pair, gear, turned_rad, at) - from).norm();
                if own < best {
                    (best, centre) = (own, at);
                }
            }
        }
        reach = reach.map(|r| 0.4 * r);
    }
    best
}

/// All edges at some angles: the gap is the distance in space, and the arms are the moments about both axes of the unit
/// force that the patch states, at the edge.
#[test]
fn gaps_and_arms_are_those_of_the_helicoids() {
    let lines = lines();
    let pair = lines.pair.clone();
    let models =
        [&pair.gear_1, &pair.gear_2].map(|gear| pair_common::made_up_gear(gear, 20e-3, SLICES));
    let layout = SliceLayout::of_models([&models[0], &models[1]], 0.0);
    let mut flanks = InvoluteAtRest::new(lines, layout, None);
    let mut edges = [0; 2];
    for k in 0..24 {
        let driver_rad = pair.pitch_1_rad() * f64::from(k) / 24.0;
        let mut patches = Vec::new();
        flanks.patches_at(driver_rad, &mut patches).unwrap();
        for patch in patches.iter().filter(|patch| patch.edge.is_some()) {
            let tip = patch.edge.unwrap().gear;
            let mate = 1 - tip;
            edges[tip] += 1;
            let number = flanks.active_lines()[patch.line].pair;
            let theta_1 = driver_rad - number as f64 * pair.pitch_1_rad();
            let ratio = pair.gear_1.base_radius_m / pair.gear_2.base_radius_m;
            let turned = [theta_1, ratio * theta_1];
            let z_m = layout.reference.slice_centre_m(patch.slice, layout.slices);
            let end = [&pair.gear_1, &pair.gear_2][tip].flank_end_roll_rad;
            let edge = placed(&pair, tip, turned[tip], [end, z_m]);
            let foot = [patch.places[mate].u, z_m];
            let found = distance_m(&pair, mate, turned[mate], edge, foot);
            // Windows shrink to 1e-12 m; the distance is flat there.
            assert!(
                (patch.gap_m - found).abs() < 1e-12,
                "{} {found}",
                patch.gap_m
            );
            let force_on_2 = Vector3::from(patch.normal);
            for gear in [0, 1] {
                let axis = Vector3::new([0.0, pair.centre_distance_m][gear], 0.0, 0.0);
                let moment = [-1.0, 1.0][gear] * (edge - axis).cross(&force_on_2).z;
                // Both counter-clockwise: gear 2 is driven, gear 1 feels the opposite force.
                assert!(
                    (moment / patch.balance.levers_m[gear] - 1.0).abs() < 1e-9,
                    "{gear} {moment}"
                );
            }
        }
    }
    assert!(edges.iter().all(|count| *count > 10), "{edges:?}");
}

/// A slice enters as an edge without force: the largest step of the transmission error shrinks with the step.
#[test]
fn the_transmission_error_has_no_jumps() {
    let lines = lines();
    let largest_step = |points: usize| {
        let mut contact = contact(&lines, FRICTIONLESS, SLICES);
        let step = lines.pair.pitch_1_rad() / points as f64;
        let curve: Vec<f64> = (0..=points)
            .map(|k| {
                let state = contact
                    .solve(step * k as f64 + 0.013, Drive::Torque(300.0))
                    .unwrap();
                state.transmission_error_m
            })
            .collect();
        curve
            .windows(2)
            .map(|w| (w[1] - w[0]).abs())
            .fold(0.0, f64::max)
    };
    let steps = [200, 800, 3200].map(largest_step);
    // A quarter for a slope that is bounded, with what the grid misses of it.
    assert!(
        steps[1] < 0.35 * steps[0] && steps[2] < 0.35 * steps[1],
        "{steps:?}"
    );
}
