//! Positions and velocities of all bodies, and how they move along an increment.
//!
//! Degrees of freedom of a body, in this order: velocity of the reference point (world axes, 3), angular velocity (body
//! axes, 3), rates of the modal coordinates. Behind all bodies come the coordinates u that force elements own, which
//! move by plain addition as modal coordinates do. The configuration of a body is ℝ³ × SO(3) × ℝᵐ; an increment Δ =
//! (Δx, Δψ, Δη) acts as
//!
//! ```text
//! x ← x + Δx,      q ← q exp(Δψ),      η ← η + Δη
//! ```

use nalgebra::{Matrix3, UnitQuaternion, Vector3};

use crate::body::{Body, BodyId, GROUND};
use crate::rotation;
use crate::unknown::{Unknown, UnknownKind};

/// Where the numbers of each body stand.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// First degree of freedom of each body, and the end of the last one.
    starts: Vec<usize>,
    /// Coordinates of elements, whose degrees of freedom follow.
    unknowns: Vec<Unknown>,
}

impl Layout {
    pub(crate) fn new(bodies: &[Body], unknowns: Vec<Unknown>) -> Self {
        let mut starts = vec![0];
        let mut total = 0;
        for body in bodies {
            total += 6 + body.mode_count();
            starts.push(total);
        }
        Self { starts, unknowns }
    }

    /// Degrees of freedom of the whole system, coordinates of elements included, constraints not counted.
    #[must_use]
    pub fn degrees_of_freedom(&self) -> usize {
        self.first_unknown() + self.unknowns.len()
    }

    /// First degree of freedom that belongs to an element: the end of those of all bodies.
    #[must_use]
    pub fn first_unknown(&self) -> usize {
        self.starts[self.starts.len() - 1]
    }

    /// Coordinates that elements own, in the order of their degrees of freedom.
    #[must_use]
    pub fn unknowns(&self) -> &[Unknown] {
        &self.unknowns
    }

    /// The coordinate of an element behind a degree of freedom; `None` for those of bodies.
    pub(crate) fn unknown(&self, dof: usize) -> Option<&Unknown> {
        self.unknowns.get(dof.checked_sub(self.first_unknown())?)
    }

    /// Coordinates of elements with their degrees of freedom.
    pub(crate) fn unknown_dofs(&self) -> impl Iterator<Item = (usize, &Unknown)> + '_ {
        (self.first_unknown()..).zip(&self.unknowns)
    }

    /// Degrees of freedom of equations without mass.
    pub(crate) fn massless(&self) -> impl Iterator<Item = usize> + '_ {
        let dofs = self.unknown_dofs();
        dofs.filter_map(|(dof, unknown)| (unknown.mass() == 0.0).then_some(dof))
    }

    /// Number of bodies.
    #[must_use]
    pub fn bodies(&self) -> usize {
        self.starts.len() - 1
    }

    /// First degree of freedom of a body; `None` for the ground.
    #[must_use]
    pub fn start(&self, body: BodyId) -> Option<usize> {
        (body != GROUND).then(|| self.starts[body.0])
    }

    /// Degrees of freedom of a body; 6 for the ground, whose loads are dropped.
    #[must_use]
    pub fn size(&self, body: BodyId) -> usize {
        if body == GROUND {
            6
        } else {
            self.starts[body.0 + 1] - self.starts[body.0]
        }
    }

    /// Modal coordinates of all bodies together.
    pub(crate) fn modal_coordinates(&self) -> usize {
        self.first_unknown() - 6 * self.bodies()
    }

    /// First modal coordinate of a body in [`State::modal`].
    pub(crate) fn modal_start(&self, body: usize) -> usize {
        self.starts[body] - 6 * body
    }

    /// First degree of freedom of every body.
    pub(crate) fn starts(&self) -> impl Iterator<Item = usize> + '_ {
        self.starts[..self.bodies()].iter().copied()
    }

    /// Degrees of freedom of every body, then those of single masses inside elements.
    pub(crate) fn massive_ranges(&self) -> impl Iterator<Item = std::ops::Range<usize>> + '_ {
        let bodies = self.starts.windows(2).map(|ends| ends[0]..ends[1]);
        let unknowns = self
            .unknown_dofs()
            .filter(|(_, unknown)| unknown.mass() > 0.0);
        bodies.chain(unknowns.map(|(dof, _)| dof..dof + 1))
    }

    /// Body and place within it of a degree of freedom of a body.
    pub(crate) fn locate(&self, dof: usize) -> (usize, usize) {
        let body = self.starts.partition_point(|&start| start <= dof) - 1;
        (body, dof - self.starts[body])
    }
}

/// Configuration and velocity at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// Time \[s\].
    pub time_s: f64,
    /// Reference points, world axes \[m\].
    pub positions_m: Vec<Vector3<f64>>,
    /// World from body axes.
    pub orientations: Vec<UnitQuaternion<f64>>,
    /// Modal coordinates of all bodies \[√kg·m\].
    pub modal: Vec<f64>,
    /// Velocities, one for each degree of freedom (module page).
    pub velocity: Vec<f64>,
    /// Coordinates of force elements, in the order of the elements.
    pub unknowns: Vec<f64>,
}

impl State {
    /// The start that the bodies state, modal coordinates at zero.
    pub(crate) fn start(bodies: &[Body], layout: &Layout) -> Self {
        let mut velocity = vec![0.0; layout.degrees_of_freedom()];
        for (body, start) in bodies.iter().zip(&layout.starts) {
            velocity[*start..start + 3].copy_from_slice(body.velocity_m_per_s.as_slice());
            velocity[start + 3..start + 6]
                .copy_from_slice(body.angular_velocity_rad_per_s.as_slice());
        }
        Self {
            time_s: 0.0,
            positions_m: bodies.iter().map(|body| body.position_m).collect(),
            orientations: bodies.iter().map(|body| body.orientation).collect(),
            modal: vec![0.0; layout.modal_coordinates()],
            velocity,
            unknowns: vec![0.0; layout.unknowns.len()],
        }
    }

    /// Configuration of `from` moved by an increment; time and velocities stay.
    pub(crate) fn set_moved(&mut self, from: &Self, increment: &[f64], layout: &Layout) {
        for body in 0..layout.bodies() {
            let d = &increment[layout.starts[body]..layout.starts[body + 1]];
            self.positions_m[body] = from.positions_m[body] + Vector3::new(d[0], d[1], d[2]);
            let turned = from.orientations[body] * rotation::exp(&Vector3::new(d[3], d[4], d[5]));
            self.orientations[body] = UnitQuaternion::new_normalize(turned.into_inner());
            let first = layout.modal_start(body);
            for (i, change) in d[6..].iter().enumerate() {
                self.modal[first + i] = from.modal[first + i] + change;
            }
        }
        let changes = &increment[layout.first_unknown()..];
        for ((place, old), change) in self.unknowns.iter_mut().zip(&from.unknowns).zip(changes) {
            *place = old + change;
        }
    }

    /// The state between two accepted ones by cubic Hermite interpolation (rotations: of the rotation vector from
    /// `from`), error of the fourth order in the step. Used for output on a uniform time grid.
    pub fn interpolate(&mut self, from: &Self, to: &Self, time_s: f64, layout: &Layout) {
        let h = to.time_s - from.time_s;
        let s = (time_s - from.time_s) / h;
        // Cubic from 0 with end value d and end rates v0, v1: value and rate at s.
        let hermite = |d: f64, v0: f64, v1: f64| {
            let (a, b) = (h * v0, h * v1);
            let (c2, c3) = (3.0 * d - 2.0 * a - b, a + b - 2.0 * d);
            (
                s * (a + s * (c2 + s * c3)),
                (a + s * (2.0 * c2 + 3.0 * s * c3)) / h,
            )
        };
        self.time_s = time_s;
        for body in 0..layout.bodies() {
            let start = layout.starts[body];
            let shift = to.positions_m[body] - from.positions_m[body];
            let psi = rotation::log(&(from.orientations[body].inverse() * to.orientations[body]));
            let vector = |v: &[f64], at: usize| Vector3::new(v[at], v[at + 1], v[at + 2]);
            let end_rate = rotation::tangent_inverse(&psi) * vector(&to.velocity, start + 3);
            let (mut turn, mut turn_rate) = (Vector3::zeros(), Vector3::zeros());
            for i in 0..3 {
                let (v0, v1) = (from.velocity[start + i], to.velocity[start + i]);
                let (value, rate) = hermite(shift[i], v0, v1);
                self.positions_m[body][i] = from.positions_m[body][i] + value;
                self.velocity[start + i] = rate;
                (turn[i], turn_rate[i]) =
                    hermite(psi[i], from.velocity[start + 3 + i], end_rate[i]);
            }
            let turned = from.orientations[body] * rotation::exp(&turn);
            self.orientations[body] = UnitQuaternion::new_normalize(turned.into_inner());
            let spin = rotation::tangent(&turn) * turn_rate;
            self.velocity[start + 3..start + 6].copy_from_slice(spin.as_slice());
            let first = layout.modal_start(body);
            for i in 0..layout.starts[body + 1] - start - 6 {
                let (a, b) = (from.modal[first + i], to.modal[first + i]);
                let rates = (from.velocity[start + 6 + i], to.velocity[start + 6 + i]);
                let (value, rate) = hermite(b - a, rates.0, rates.1);
                self.modal[first + i] = a + value;
                self.velocity[start + 6 + i] = rate;
            }
        }
        for (i, (dof, unknown)) in layout.unknown_dofs().enumerate() {
            let change = to.unknowns[i] - from.unknowns[i];
            // The rate of a coordinate in equilibrium is a by-product: along a line.
            let rates = match unknown.kind {
                UnknownKind::Equilibrium => (change / h, change / h),
                _ => (from.velocity[dof], to.velocity[dof]),
            };
            let (value, rate) = hermite(change, rates.0, rates.1);
            self.unknowns[i] = from.unknowns[i] + value;
            self.velocity[dof] = rate;
        }
    }
}

/// Position and velocity of one body, as force elements and joints need them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyMotion {
    /// Reference point, world axes \[m\].
    pub position_m: Vector3<f64>,
    /// World from body axes, as a quaternion.
    pub orientation: UnitQuaternion<f64>,
    /// World from body axes, as a matrix.
    pub rotation: Matrix3<f64>,
    /// Velocity of the reference point, world axes \[m/s\].
    pub velocity_m_per_s: Vector3<f64>,
    /// Angular velocity, body axes \[rad/s\].
    pub angular_velocity_rad_per_s: Vector3<f64>,
}

impl BodyMotion {
    /// The ground's.
    pub(crate) fn at_rest() -> Self {
        Self {
            position_m: Vector3::zeros(),
            orientation: UnitQuaternion::identity(),
            rotation: Matrix3::identity(),
            velocity_m_per_s: Vector3::zeros(),
            angular_velocity_rad_per_s: Vector3::zeros(),
        }
    }

    pub(crate) fn of(state: &State, layout: &Layout, body: usize) -> Self {
        let v = &state.velocity[layout.starts[body]..];
        Self {
            position_m: state.positions_m[body],
            orientation: state.orientations[body],
            rotation: *state.orientations[body].to_rotation_matrix().matrix(),
            velocity_m_per_s: Vector3::new(v[0], v[1], v[2]),
            angular_velocity_rad_per_s: Vector3::new(v[3], v[4], v[5]),
        }
    }
}

/// Motion of a body, of all motions with the ground's at the end.
pub(crate) fn motion_of(motions: &[BodyMotion], body: BodyId) -> &BodyMotion {
    &motions[body.0.min(motions.len() - 1)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interpolation_meets_both_ends_and_its_own_rate() {
        let bodies = [Body::rigid("a", 1.0, [1.0; 3])];
        let layout = Layout::new(&bodies, Vec::new());
        let mut from = State::start(&bodies, &layout);
        from.velocity = vec![1.0, -2.0, 0.5, 0.3, -0.9, 4.0];
        let mut to = from.clone();
        to.set_moved(&from, &[0.1, -0.2, 0.0, 0.05, -0.1, 0.4], &layout);
        to.time_s = 0.1;
        to.velocity = vec![0.8, -1.0, 0.1, 0.5, -1.1, 3.9];
        let at = |time_s| {
            let mut state = from.clone();
            state.interpolate(&from, &to, time_s, &layout);
            state
        };
        for (end, time_s) in [(&from, 0.0), (&to, 0.1)] {
            let state = at(time_s);
            assert!((state.positions_m[0] - end.positions_m[0]).norm() < 1e-15);
            assert!(state.orientations[0].angle_to(&end.orientations[0]) < 1e-14);
            for (a, b) in state.velocity.iter().zip(&end.velocity) {
                assert!((a - b).abs() < 1e-13);
            }
        }
        let (before, here, after) = (at(0.04 - 1e-6), at(0.04), at(0.04 + 1e-6));
        let turn =
            rotation::log(&(before.orientations[0].inverse() * after.orientations[0])) / 2e-6;
        for i in 0..3 {
            assert!((turn[i] - here.velocity[3 + i]).abs() < 1e-8);
        }
    }
}
