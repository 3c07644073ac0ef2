//! The speed of a carrier between two gears whose speeds are known: Willis' equation without the planet's own speed.
//!
//! ```text
//! (ω_a − ω_c) u_a = (ω_b − ω_c) u_b,      u = z/z_p of the gear and the planet in mesh with it, negative of a ring
//! ```
//!
//! The planet meets a and b, itself or by a second gear that is fixed to it.

use super::bodies::Bodies;
use super::carriers::Carried;
use super::gear_mesh::PreparedMesh;

/// A gear in mesh with a planet.
struct Central {
    gear: usize,
    /// u.
    teeth_ratio: f64,
}

/// Meshes of planets by the planet, which bears what is fixed to it, with what takes it round.
pub(super) struct Planets(Vec<(usize, usize, Vec<Central>)>);

impl Planets {
    /// Those of all meshes.
    pub(super) fn find(bodies: &Bodies, carried: &[Carried], meshes: &[PreparedMesh]) -> Self {
        let mut found: Vec<(usize, usize, Vec<Central>)> = Vec::new();
        let mut above = vec![None; bodies.list.len()];
        for one in carried {
            above[one.body] = one.carrier;
        }
        for mesh in meshes {
            for (planet, central) in [(0, 1), (1, 0)] {
                let Some((own, carrier)) = taken_round(bodies, &above, mesh.bodies[planet]) else {
                    continue;
                };
                // What the same carrier takes round is a planet, too.
                let gear = mesh.bodies[central];
                let other = taken_round(bodies, &above, gear);
                if other.is_some_and(|(_, other)| other == carrier) {
                    continue;
                }
                let ratio = mesh.ratio();
                let teeth_ratio = if central == 1 { ratio } else { 1.0 / ratio };
                let central = Central { gear, teeth_ratio };
                match found.iter_mut().find(|(known, ..)| *known == own) {
                    Some((_, _, centrals)) => centrals.push(central),
                    None => found.push((own, carrier, vec![central])),
                }
            }
        }
        Self(found)
    }

    /// A carrier that is free, with the speed \[rad/s\] that two gears of known speed give it.
    pub(super) fn first_settled(&self, bodies: &Bodies) -> Option<(usize, f64)> {
        let known = |central: &&Central| !bodies.list[central.gear].speed_is_free;
        let spin = |gear: usize| bodies.list[gear].body.angular_velocity_rad_per_s.z;
        self.0.iter().find_map(|(_, carrier, centrals)| {
            if !bodies.list[*carrier].speed_is_free {
                return None;
            }
            let mut known = centrals.iter().filter(known);
            let a = known.next()?;
            let b = known.find(|b| b.gear != a.gear)?;
            let [u_a, u_b] = [a.teeth_ratio, b.teeth_ratio];
            let apart = u_a - u_b;
            (apart.abs() > 1e-9 * u_a.abs())
                .then(|| (*carrier, (u_a * spin(a.gear) - u_b * spin(b.gear)) / apart))
        })
    }
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
