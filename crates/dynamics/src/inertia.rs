//! Inertia forces of one body and their tangents.
//!
//! From the kinetic energy, with V = Rᵀv, s = m c + L_tᵀη the first moment of mass of the deformed body and L_t, L_r
//! the halves of the modal coupling,
//!
//! ```text
//! T = ½ m vᵀv + vᵀR (Ω × s + L_tᵀη̇) + ½ ΩᵀJΩ + ΩᵀL_rᵀη̇ + ½ η̇ᵀη̇
//!
//! force   (world):  m v̇ + R W,   W = Ω̇ × s + Ω × (Ω × s) + L_tᵀη̈ + 2 Ω × L_tᵀη̇
//! moment  (body):   J Ω̇ + s × Rᵀv̇ + L_rᵀη̈ + Ω × (J Ω + L_rᵀη̇)
//! modal:            η̈ + L_t Rᵀv̇ + L_r Ω̇ + 2ζω η̇ + ω² η
//! ```
//!
//! Exact for a rigid body. For a modal one the change of J and L_r with η (centrifugal softening, gyroscopic coupling
//! of modes among each other) is neglected; what is kept is derived from T, so energy is kept, and does not depend on
//! the observer's velocity. Derivation: docs/theory/multibody.md.

use nalgebra::{Matrix3, Vector3};

use crate::body::Body;
use crate::matrix::Matrix;
use crate::rotation::skew;
use crate::state::BodyMotion;

/// Constant mass properties of a body.
#[derive(Debug, Clone)]
pub(crate) struct Inertia {
    mass: f64,
    first_moment: Vector3<f64>,
    inertia: Matrix3<f64>,
    /// One row of L for each mode.
    translational: Vec<Vector3<f64>>,
    rotational: Vec<Vector3<f64>>,
    stiffness: Vec<f64>,
    damping: Vec<f64>,
}

/// What the inertia forces depend on.
pub(crate) struct Motion<'a> {
    pub body: &'a BodyMotion,
    /// η
    pub modal: &'a [f64],
    /// Velocity of the body's degrees of freedom.
    pub velocity: &'a [f64],
    /// Their derivative by time.
    pub acceleration: &'a [f64],
}

/// Where tangents of the body go: rows and columns from `start` of the system's matrices.
pub(crate) struct Tangents<'a> {
    pub start: usize,
    pub mass: &'a mut Matrix,
    pub damping: &'a mut Matrix,
    pub stiffness: &'a mut Matrix,
}

/// Sums over the modes that the equations share.
struct Sums {
    /// s = m c + L_tᵀη
    moment: Vector3<f64>,
    /// L_tᵀη̇
    moment_rate: Vector3<f64>,
    /// L_tᵀη̈
    moment_acceleration: Vector3<f64>,
    /// L_rᵀη̇
    spin: Vector3<f64>,
    /// L_rᵀη̈
    spin_rate: Vector3<f64>,
}

fn vector(values: &[f64]) -> Vector3<f64> {
    Vector3::new(values[0], values[1], values[2])
}

impl Inertia {
    pub(crate) fn new(body: &Body) -> Self {
        let mut inertia = Self {
            mass: body.mass_kg,
            first_moment: body.mass_kg * body.center_of_mass_m,
            inertia: body.inertia_about_reference_kg_m2(),
            translational: Vec::new(),
            rotational: Vec::new(),
            stiffness: Vec::new(),
            damping: Vec::new(),
        };
        if let Some(modes) = &body.modes {
            for (i, omega) in modes.angular_frequency_rad_per_s.iter().enumerate() {
                let row =
                    |first: usize| Vector3::from_fn(|axis, _| modes.coupling[(i, first + axis)]);
                inertia.translational.push(row(0));
                inertia.rotational.push(row(3));
                inertia.stiffness.push(omega * omega);
                inertia.damping.push(2.0 * modes.damping_ratio[i] * omega);
            }
        }
        inertia
    }

    /// Diagonal of the body's mass matrix.
    pub(crate) fn diagonal(&self) -> impl Iterator<Item = f64> + '_ {
        let j = &self.inertia;
        [
            self.mass,
            self.mass,
            self.mass,
            j[(0, 0)],
            j[(1, 1)],
            j[(2, 2)],
        ]
        .into_iter()
        .chain(self.translational.iter().map(|_| 1.0))
    }

    fn sums(&self, modal: &[f64], rates: &[f64], accelerations: &[f64]) -> Sums {
        let mut sums = Sums {
            moment: self.first_moment,
            moment_rate: Vector3::zeros(),
            moment_acceleration: Vector3::zeros(),
            spin: Vector3::zeros(),
            spin_rate: Vector3::zeros(),
        };
        for (i, (t, r)) in self.translational.iter().zip(&self.rotational).enumerate() {
            sums.moment += modal[i] * t;
            sums.moment_rate += rates[i] * t;
            sums.moment_acceleration += accelerations[i] * t;
            sums.spin += rates[i] * r;
            sums.spin_rate += accelerations[i] * r;
        }
        sums
    }

    /// Adds the inertia forces, and the modal elastic and damping forces, to the body's part of the residual.
    pub(crate) fn add_forces(&self, motion: &Motion<'_>, residual: &mut [f64]) {
        let (rotation, omega) = (motion.body.rotation, motion.body.angular_velocity_rad_per_s);
        let (linear, alpha) = (
            vector(motion.acceleration),
            vector(&motion.acceleration[3..]),
        );
        let (rates, accelerations) = (&motion.velocity[6..], &motion.acceleration[6..]);
        let sums = self.sums(motion.modal, rates, accelerations);
        let force = self.mass * linear + rotation * relative_force(&sums, &omega, &alpha);
        let own = rotation.transpose() * linear;
        let moment = self.inertia * alpha
            + sums.moment.cross(&own)
            + sums.spin_rate
            + omega.cross(&(self.inertia * omega + sums.spin));
        for i in 0..3 {
            residual[i] += force[i];
            residual[3 + i] += moment[i];
        }
        for (i, (t, r)) in self.translational.iter().zip(&self.rotational).enumerate() {
            residual[6 + i] += accelerations[i]
                + t.dot(&own)
                + r.dot(&alpha)
                + self.damping[i] * rates[i]
                + self.stiffness[i] * motion.modal[i];
        }
    }

    /// Adds the derivatives of [`Self::add_forces`] by acceleration (mass), velocity and configuration increment.
    pub(crate) fn add_tangents(&self, motion: &Motion<'_>, out: &mut Tangents<'_>) {
        let (rotation, omega) = (motion.body.rotation, motion.body.angular_velocity_rad_per_s);
        let (linear, alpha) = (
            vector(motion.acceleration),
            vector(&motion.acceleration[3..]),
        );
        let sums = self.sums(
            motion.modal,
            &motion.velocity[6..],
            &motion.acceleration[6..],
        );
        let (x, turn) = (out.start, out.start + 3);
        let s = skew(&sums.moment);
        let spin = skew(&omega);
        let own = rotation.transpose() * linear;

        out.mass.add3(x, x, &(self.mass * Matrix3::identity()));
        out.mass.add3(x, turn, &(-rotation * s));
        out.mass.add3(turn, x, &(s * rotation.transpose()));
        out.mass.add3(turn, turn, &self.inertia);

        let centripetal = skew(&omega.cross(&sums.moment)) + spin * s;
        let coriolis = 2.0 * skew(&sums.moment_rate);
        out.damping
            .add3(x, turn, &(-rotation * (centripetal + coriolis)));
        let momentum = self.inertia * omega + sums.spin;
        out.damping
            .add3(turn, turn, &(spin * self.inertia - skew(&momentum)));

        let pull = relative_force(&sums, &omega, &alpha);
        out.stiffness.add3(x, turn, &(-rotation * skew(&pull)));
        out.stiffness.add3(turn, turn, &(s * skew(&own)));

        let turning = skew(&alpha) + spin * spin;
        for (i, (t, r)) in self.translational.iter().zip(&self.rotational).enumerate() {
            let mode = out.start + 6 + i;
            let world = rotation * t;
            out.mass.add_pair(x, mode, &world);
            out.mass.add_pair(turn, mode, r);
            out.mass.add(mode, mode, 1.0);
            out.damping
                .add_column(x, mode, (2.0 * (rotation * (spin * t))).as_slice());
            out.damping.add_column(turn, mode, (spin * r).as_slice());
            out.damping.add(mode, mode, self.damping[i]);
            out.stiffness
                .add_column(x, mode, (rotation * (turning * t)).as_slice());
            out.stiffness
                .add_column(turn, mode, t.cross(&own).as_slice());
            out.stiffness.add_row(mode, turn, &t.cross(&own));
            out.stiffness.add(mode, mode, self.stiffness[i]);
        }
    }

    /// Kinetic energy \[J\].
    pub(crate) fn kinetic_energy(&self, motion: &BodyMotion, modal: &[f64], rates: &[f64]) -> f64 {
        let sums = self.sums(modal, rates, rates);
        let (v, omega) = (motion.velocity_m_per_s, motion.angular_velocity_rad_per_s);
        let own = motion.rotation.transpose() * v;
        0.5 * self.mass * v.norm_squared()
            + own.dot(&(omega.cross(&sums.moment) + sums.moment_rate))
            + 0.5 * omega.dot(&(self.inertia * omega))
            + omega.dot(&sums.spin)
            + 0.5 * rates.iter().map(|rate| rate * rate).sum::<f64>()
    }

    /// Strain energy of the modes \[J\].
    pub(crate) fn strain_energy(&self, modal: &[f64]) -> f64 {
        let terms = self.stiffness.iter().zip(modal);
        0.5 * terms.map(|(k, eta)| k * eta * eta).sum::<f64>()
    }

    /// Power that modal damping takes \[W\].
    pub(crate) fn dissipated_power(&self, rates: &[f64]) -> f64 {
        let terms = self.damping.iter().zip(rates);
        terms.map(|(d, rate)| d * rate * rate).sum()
    }
}

/// W of the module page.
fn relative_force(sums: &Sums, omega: &Vector3<f64>, alpha: &Vector3<f64>) -> Vector3<f64> {
    alpha.cross(&sums.moment)
        + omega.cross(&omega.cross(&sums.moment))
        + sums.moment_acceleration
        + 2.0 * omega.cross(&sums.moment_rate)
}
