//! Positions of a loaded bevel pair beside the even ones of a pitch: where a pair of teeth takes load or gives it up,
//! and at the extremes of the transmission error. Even positions meet corners of the error by chance only.
//!
//! Pairs of teeth that carry at one end of a step and not at the other say that something happens between them; halving finds it. Then
//! the highest and the lowest position are followed by halving the steps beside them.

use std::collections::BTreeSet;

use super::loaded_contact::LoadedPosition;
use crate::error::DrivetrainError;

/// Halvings of an even step for an event: it is known to 1/32 of a step, on both sides.
const EVENT_HALVINGS: usize = 5;

/// An extreme is followed until a halving changes the peak-to-peak value by less than this share of it.
const PEAK_SHARE: f64 = 1e-3;

/// Halvings for an extreme at most.
const MOST_HALVINGS: usize = 8;

/// Pairs of teeth that carry.
fn carrying(position: &LoadedPosition) -> BTreeSet<[usize; 2]> {
    position.patches.iter().map(|patch| patch.teeth).collect()
}

/// The positions between those of a whole pitch, its end included: those of `at`, which loads the pair at a turn, in
/// the order of `even`.
pub(super) fn between(
    even: Vec<LoadedPosition>,
    mut at: impl FnMut(f64) -> Result<LoadedPosition, DrivetrainError>,
) -> Result<Vec<LoadedPosition>, DrivetrainError> {
    let mut all: Vec<(LoadedPosition, bool)> = Vec::with_capacity(2 * even.len());
    for next in even {
        if let Some((last, _)) = all.last() {
            let mut ends = [last.clone(), next.clone()];
            let mut found = [Vec::new(), Vec::new()];
            if carrying(&ends[0]) != carrying(&ends[1]) {
                for _ in 0..EVENT_HALVINGS {
                    let middle = halfway(&ends[0], &ends[1], &mut at)?;
                    let side = usize::from(carrying(&middle) != carrying(&ends[0]));
                    found[side].push((middle.clone(), true));
                    ends[side] = middle;
                }
            }
            let [before, mut after] = found;
            after.reverse();
            all.extend(before);
            all.extend(after);
        }
        all.push((next, false));
    }
    for sign in [1.0, -1.0] {
        for _ in 0..MOST_HALVINGS {
            let errors = || all.iter().map(|(position, _)| position.error_rad);
            let spread = errors().fold(f64::MIN, f64::max) - errors().fold(f64::MAX, f64::min);
            let place = (0..all.len()).max_by(|&a, &b| {
                let of = |i: usize| sign * all[i].0.error_rad;
                of(a).total_cmp(&of(b))
            });
            let Some(place) = place else { break };
            let top = sign * all[place].0.error_rad;
            let mut gained = 0.0_f64;
            // Behind the extreme first, so that its place still holds before it.
            for (first, next) in [(place, place + 1), (place.wrapping_sub(1), place)] {
                if first >= all.len() || next >= all.len() {
                    continue;
                }
                let middle = halfway(&all[first].0, &all[next].0, &mut at)?;
                gained = gained.max(sign * middle.error_rad - top);
                all.insert(next, (middle, true));
            }
            if gained < PEAK_SHARE * spread && sides_fall(&all, sign, PEAK_SHARE * spread) {
                break;
            }
        }
    }
    Ok(all
        .into_iter()
        .filter_map(|(position, is_added)| is_added.then_some(position))
        .collect())
}

/// Whether neighbours of the extreme lie so near it that what is between them cannot matter: a line through two of
/// them, led on by half a step, passes the extreme by less than `open`.
fn sides_fall(all: &[(LoadedPosition, bool)], sign: f64, open: f64) -> bool {
    let of = |i: usize| sign * all[i].0.error_rad;
    let Some(place) = (0..all.len()).max_by(|&a, &b| of(a).total_cmp(&of(b))) else {
        return true;
    };
    let near = |i: usize| i < all.len() && of(place) - of(i) < open;
    let is_end = |i: usize| i >= all.len();
    [place.wrapping_sub(1), place + 1]
        .into_iter()
        .all(|i| is_end(i) || near(i))
}

fn halfway(
    a: &LoadedPosition,
    b: &LoadedPosition,
    at: &mut impl FnMut(f64) -> Result<LoadedPosition, DrivetrainError>,
) -> Result<LoadedPosition, DrivetrainError> {
    at(0.5 * (a.pinion_turn_rad + b.pinion_turn_rad))
}
