//! What lies between the equal steps of a contact analysis: the turns at which the next pair of teeth takes over, where
//! the gear stays behind most, and the smooth extremes of the pair that leads.

use crate::contact_path::PairContacts;
use crate::contact_point::{ContactKind, Touch};
use crate::contact_search::ContactSearch;

/// Halvings of a step for a change of pairs: beyond them rounding decides.
const HALVINGS: usize = 30;

/// Contacts between the steps of one pitch: of both pairs where one takes over from the other, and of the one that
/// leads where its lead has an extreme. `leaders`: of each step of the pitch the number of the contact that leads, and
/// its lead \[rad\].
pub(crate) fn between_positions(
    search: &ContactSearch<'_>,
    of: &PairContacts,
    leaders: &[(i64, f64)],
) -> Vec<(ContactKind, Touch)> {
    let n = leaders.len() as i64;
    // A pair's own turn at the time k of the pitch is (k + n·pair) steps; a pitch later each pair stands where the next
    // one stood.
    let pair_at = |k: i64| {
        let (own, around) = (k.rem_euclid(n), k.div_euclid(n));
        (leaders[own as usize].0 - own) / n - around
    };
    let lead_at = |k: i64| leaders[k.rem_euclid(n) as usize].1;
    let touch = |pair: i64, time: f64| search.first_touch((time + (pair * n) as f64) * of.step_rad);
    let lead = |pair: i64, time: f64| {
        touch(pair, time).map_or(f64::NEG_INFINITY, |(_, t)| search.mesh().lead_rad(&t))
    };
    let mut found = Vec::new();
    for k in 0..n {
        let (here, next) = (pair_at(k), pair_at(k + 1));
        if here != next {
            let (mut near, mut far) = (k as f64, k as f64 + 1.0);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (near + far);
                if lead(here, middle) > lead(next, middle) {
                    near = middle;
                } else {
                    far = middle;
                }
            }
            found.extend(
                [here, next]
                    .into_iter()
                    .filter_map(|pair| touch(pair, near)),
            );
            continue;
        }
        let [a, b, c] = [k - 1, k, k + 1].map(lead_at);
        if pair_at(k - 1) == here && (b - a) * (c - b) <= 0.0 && a != c {
            // The vertex of the parabola through three steps.
            let share = 0.5 * (a - c) / (a - 2.0 * b + c);
            found.extend(touch(here, k as f64 + share));
        }
    }
    found
}
