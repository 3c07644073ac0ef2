//! The speed of a carrier between two gears whose speeds are known: Willis' equation without the planet's own speed.
//!
//! ```text
//! (ω_a − ω_c) u_a = (ω_b − ω_c) u_b,      u = z/z_p of the gear and the planet in mesh with it, negative of a ring
//! ```
//!
//! The planet meets a and b, itself or by a second gear that is fixed to it. Planets of one carrier that mesh with each
//! other turn as (ω_2 − ω_c) = −(z_1/z_2)(ω_1 − ω_c); with ω_p − ω_c = k (ω_1 − ω_c) the ratio of what meets planet p
//! counts u/k.

use super::bodies::Bodies;
use super::carriers::Carried;
use super::gear_mesh::PreparedMesh;
use super::linked::firsts;

/// Coefficients below this are none: ratios of teeth are about 1.
const NO_EQUATION: f64 = 1e-9;

/// A gear in mesh with a planet.
struct Central {
    gear: usize,
    /// u.
    teeth_ratio: f64,
}

/// Meshes of planets by the planet, which bears what is fixed to it, or by one of those in mesh with each other, with
/// what takes it round.
pub(super) struct Planets(Vec<(usize, usize, Vec<Central>)>);

impl Planets {
    /// Those of all meshes.
    pub(super) fn find(bodies: &Bodies, carried: &[Carried], meshes: &[PreparedMesh]) -> Self {
        let mut above = vec![None; bodies.list.len()];
        for one in carried {
            above[one.body] = one.carrier;
        }
        let ends: Vec<[Option<(usize, usize)>; 2]> = meshes
            .iter()
            .map(|mesh| mesh.bodies.map(|body| taken_round(bodies, &above, body)))
            .collect();
        // Each planet's first one, and k.
        let mut leads: Vec<(usize, f64)> = (0..bodies.list.len()).map(|body| (body, 1.0)).collect();
        let mut found: Vec<(usize, usize, Vec<Central>)> = Vec::new();
        let is_of_planets = |ends: &[Option<(usize, usize)>; 2]| matches!(ends, [Some((_, one)), Some((_, other))] if one == other);
        for (mesh, ends) in meshes
            .iter()
            .zip(&ends)
            .filter(|(_, ends)| is_of_planets(ends))
        {
            if let [Some((one, _)), Some((other, _))] = *ends {
                let [(first, k), (last, other_k)] = [leads[one], leads[other]];
                let share = -k / (mesh.built.ratio() * other_k);
                if first != last {
                    let following = leads.iter_mut().filter(|(lead, _)| *lead == last);
                    following.for_each(|(lead, k)| (*lead, *k) = (first, *k * share));
                }
            }
        }
        for (mesh, ends) in meshes
            .iter()
            .zip(&ends)
            .filter(|(_, ends)| !is_of_planets(ends))
        {
            for (planet, central) in [(0, 1), (1, 0)] {
                let Some((own, carrier)) = ends[planet] else {
                    continue;
                };
                let (lead, k) = leads[own];
                let ratio = mesh.built.ratio();
                let teeth_ratio = if central == 1 { ratio } else { 1.0 / ratio } / k;
                let central = Central {
                    gear: mesh.bodies[central],
                    teeth_ratio,
                };
                match found.iter_mut().find(|(known, ..)| *known == lead) {
                    Some((_, _, centrals)) => centrals.push(central),
                    None => found.push((lead, carrier, vec![central])),
                }
            }
        }
        Self(found)
    }

    /// A carrier or gear that is free, with the speed \[rad/s\] that Willis' equations of all planets give it. One of
    /// them gives it where two of a, b and c are known; in trains with members in common, such as Simpson's, it takes
    /// several.
    pub(super) fn first_settled(
        &self,
        bodies: &Bodies,
        groups: &[(Vec<usize>, String)],
    ) -> Option<(usize, f64)> {
        if self.0.is_empty() {
            return None;
        }
        // The first body of those that are fixed to each other, for every body.
        let fixed = groups.iter().flat_map(|(group, _)| group.windows(2));
        let leading = firsts(bodies.list.len(), fixed.map(|pair| [pair[0], pair[1]]));
        let mut free: Vec<usize> = Vec::new();
        let mut rows = Vec::new();
        for (_, carrier, centrals) in &self.0 {
            let Some((a, others)) = centrals.split_first() else {
                continue;
            };
            for b in others.iter().filter(|b| b.gear != a.gear) {
                let [u_a, u_b] = [a.teeth_ratio, b.teeth_ratio];
                // Coefficients of unknown speeds, then the right side.
                let mut row = vec![0.0; free.len() + 1];
                for (body, factor) in [(a.gear, u_a), (b.gear, -u_b), (*carrier, u_b - u_a)] {
                    let [own, first] = [body, leading[body]].map(|body| &bodies.list[body]);
                    if own.speed_is_free && first.speed_is_free {
                        let place = free.iter().position(|known| *known == leading[body]);
                        let place = place.unwrap_or_else(|| {
                            free.push(leading[body]);
                            row.insert(free.len() - 1, 0.0);
                            free.len() - 1
                        });
                        row[place] += factor * own.axis().dot(&first.axis()).signum();
                    } else {
                        let spin = own.body.angular_velocity_rad_per_s.z;
                        *row.last_mut()? -= factor * spin;
                    }
                }
                rows.push(row);
            }
        }
        for row in &mut rows {
            let right = row.pop()?;
            row.resize(free.len(), 0.0);
            row.push(right);
        }
        let (place, spin) = first_solved(rows, free.len())?;
        Some((free[place], spin))
    }
}

/// The first unknown that linear equations determine, by elimination; each row has its right side behind the
/// coefficients.
fn first_solved(mut rows: Vec<Vec<f64>>, unknowns: usize) -> Option<(usize, f64)> {
    let most = |row: &[f64]| {
        row[..unknowns]
            .iter()
            .fold(0.0_f64, |most, x| most.max(x.abs()))
    };
    let mut done = 0;
    for column in 0..unknowns {
        let at = |row: &Vec<f64>| row[column].abs();
        let best = (done..rows.len()).max_by(|&a, &b| at(&rows[a]).total_cmp(&at(&rows[b])));
        let Some(best) = best.filter(|&row| at(&rows[row]) > NO_EQUATION) else {
            continue;
        };
        rows.swap(done, best);
        let pivot = rows[done].clone();
        for (place, row) in rows.iter_mut().enumerate() {
            let share = if place == done {
                0.0
            } else {
                row[column] / pivot[column]
            };
            row.iter_mut()
                .zip(&pivot)
                .for_each(|(x, p)| *x -= share * p);
        }
        done += 1;
    }
    rows.iter().find_map(|row| {
        let largest = most(row);
        let mut parts = (0..unknowns).filter(|&k| row[k].abs() > NO_EQUATION * largest.max(1.0));
        let place = parts.next()?;
        parts
            .next()
            .is_none()
            .then(|| (place, row[unknowns] / row[place]))
    })
}

/// The body on whose axis a body stands, or itself, and the body that takes that axis round.
fn taken_round(bodies: &Bodies, above: &[Option<usize>], body: usize) -> Option<(usize, usize)> {
    let mut on = body;
    loop {
        let next = above[on]?;
        let [led, leading] = [on, next].map(|body| &bodies.list[body]);
        let arm = (led.body.position_m - leading.body.position_m).cross(&leading.axis());
        if arm.norm() > super::start_speeds::ON_AXIS_M {
            return Some((on, next));
        }
        on = next;
    }
}
