//! Masses put together: mass, centre and inertia of several parts.

use gearmesh_dynamics::Body;
use nalgebra::{Matrix3, Vector3};

/// A mass with its centre and its inertia about that centre, in the axes of one body.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lump {
    pub mass_kg: f64,
    pub centre_m: Vector3<f64>,
    pub inertia_kg_m2: Matrix3<f64>,
}

impl Lump {
    /// A round tube along z from its lower end.
    pub(super) fn tube(
        [inner_m, outer_m]: [f64; 2],
        density: f64,
        [from_m, to_m]: [f64; 2],
    ) -> Self {
        let length = to_m - from_m;
        let squares = outer_m * outer_m + inner_m * inner_m;
        let mass =
            density * std::f64::consts::PI * (outer_m * outer_m - inner_m * inner_m) * length;
        let across = mass * (3.0 * squares + length * length) / 12.0;
        Self {
            mass_kg: mass,
            centre_m: Vector3::new(0.0, 0.0, 0.5 * (from_m + to_m)),
            inertia_kg_m2: Matrix3::from_diagonal(&Vector3::new(
                across,
                across,
                0.5 * mass * squares,
            )),
        }
    }

    /// What a body has.
    pub(super) fn of(body: &Body) -> Self {
        Self {
            mass_kg: body.mass_kg,
            centre_m: body.center_of_mass_m,
            inertia_kg_m2: body.inertia_kg_m2,
        }
    }

    /// The same lump seen from other axes: x' = turn · x + shift.
    pub(super) fn moved(self, turn: &Matrix3<f64>, shift_m: &Vector3<f64>) -> Self {
        Self {
            centre_m: turn * self.centre_m + shift_m,
            inertia_kg_m2: turn * self.inertia_kg_m2 * turn.transpose(),
            ..self
        }
    }

    /// All parts as one: Steiner's theorem.
    pub(super) fn sum(parts: &[Self]) -> Self {
        let mass: f64 = parts.iter().map(|part| part.mass_kg).sum();
        let moment: Vector3<f64> = parts.iter().map(|part| part.mass_kg * part.centre_m).sum();
        let centre = moment / mass;
        let about = |part: &Self| {
            let c = part.centre_m - centre;
            part.inertia_kg_m2
                + part.mass_kg * (c.norm_squared() * Matrix3::identity() - c * c.transpose())
        };
        Self {
            mass_kg: mass,
            centre_m: centre,
            inertia_kg_m2: parts.iter().map(about).sum(),
        }
    }

    /// Gives a body this mass.
    pub(super) fn put_on(self, body: &mut Body) {
        body.mass_kg = self.mass_kg;
        body.center_of_mass_m = self.centre_m;
        body.inertia_kg_m2 = self.inertia_kg_m2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_halves_are_the_whole() {
        let radii = [0.01, 0.03];
        let whole = Lump::tube(radii, 7850.0, [-0.02, 0.08]);
        let halves = Lump::sum(&[
            Lump::tube(radii, 7850.0, [-0.02, 0.01]),
            Lump::tube(radii, 7850.0, [0.01, 0.08]),
        ]);
        assert!((whole.mass_kg - halves.mass_kg).abs() < 1e-14);
        assert!((whole.centre_m - halves.centre_m).norm() < 1e-15);
        assert!((whole.inertia_kg_m2 - halves.inertia_kg_m2).norm() < 1e-15);
    }
}
