//! When the iteration of a step may end: as soon as what is left of it is small against the step's own error.
//!
//! What is left of an increment, ε, stays in the velocity as γ/(βh) ε and adds up from step to step; so does the step's
//! own error of the velocity, which is known from the accelerations of three points in time:
//!
//! ```text
//! own error of the velocity = D h³ v⃛,    D = Δ(α_m − ½) + 1/12 − Δ²,    h² v⃛ ≈ v̇_{n+1} − 2 v̇_n + v̇_{n−1}
//! ε ≤ SHARE · D β/γ · h² |v̇_{n+1} − 2 v̇_n + v̇_{n−1}|
//! ```
//!
//! The largest of each kind of coordinate (places, rotations, modal coordinates) counts. Where a step is long against
//! the fastest vibrations (stiff modes that a damping scheme passes over, motions that follow their loads), these
//! accelerations tell nothing about what the step gets wrong, and are large: then a share of the step's own increment
//! is the limit, [`MOST`]. A stated tolerance, such a share too, takes the place of both. Derivation:
//! docs/theory/multibody.md.

use crate::matrix::Matrix;
use crate::scheme::Scheme;
use crate::system::System;

/// Share of the step's own error that may be left. What is left is estimated from two corrections, and over a run it
/// may add up with one sign where the step's own errors cancel in part: with a hundredth it was seen to come to a
/// twentieth of the error at the end, with this share to less than a fiftieth (tests/mechanisms).
const SHARE: f64 = 0.003;

/// Share of the step's own increment that is never exceeded: bodies with modes above 20 kHz, driven against each other
/// in steps of 0.7 ms, otherwise leave the iteration so early that they pass through each other.
const MOST: f64 = 1e-8;

/// Smallest meaningful correction of a rotation \[rad\], and of a place over the size of the system: the rounding of a
/// few operations. Velocities carry it divided by the step. It grows with the largest counted angle \[rad\], which is
/// as inexact as it is large.
const ROUNDING: f64 = 1e-15;

/// Kinds of degrees of freedom: places, rotations, modal coordinates, coordinates of elements over their scale.
/// Tolerances go by kind.
pub(crate) const KINDS: usize = 4;

/// A step as far as it has come.
pub(crate) struct Progress<'a> {
    pub step_s: f64,
    /// Stated share of the step's own increment.
    pub stated: Option<f64>,
    /// Velocity, acceleration and its rate where the step begins.
    pub velocity: &'a [f64],
    pub acceleration: &'a [f64],
    pub jerk: &'a [f64],
    /// Acceleration and increment with the latest correction.
    pub new_acceleration: &'a [f64],
    pub increment: &'a [f64],
    /// The latest correction, of increments and of βh² λ.
    pub delta: &'a [f64],
    pub mu: &'a [f64],
    pub gradient: &'a Matrix,
}

/// The latest correction against what it may be.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Measured {
    /// Largest correction over its tolerance; not a number if any correction is none.
    pub ratio: f64,
    /// Degree of freedom where.
    pub largest: usize,
    /// Largest correction over the floor of rounding.
    pub above_floor: f64,
}

/// Sizes and masses of a system that corrections are compared with.
pub(crate) struct Convergence {
    pub kinds: Vec<usize>,
    floor: [f64; KINDS],
    /// 1 + the largest counted angle \[rad\] at the start of the step: what multiplies the floor.
    revolved: f64,
    /// Size of the system \[m\] and square root of its heaviest mass: how far a turn moves places, and modal
    /// coordinates per place.
    reach: (f64, f64),
    pub inverse_mass: Vec<f64>,
    /// 1 for degrees of freedom of bodies, 1/scale for coordinates of elements.
    pub per_scale: Vec<f64>,
    pushed: Vec<f64>,
    /// `SHARE` · D β/γ
    share_of_error: f64,
}

impl Convergence {
    pub(crate) fn new(system: &System, scheme: &Scheme) -> Self {
        let n = system.degrees_of_freedom();
        let layout = &system.layout;
        let kinds = (0..n).map(|dof| match layout.unknown(dof) {
            Some(_) => 3,
            None => (layout.locate(dof).1 / 3).min(2),
        });
        let per_scale = (0..n).map(|dof| layout.unknown(dof).map_or(1.0, |u| 1.0 / u.scale));
        let size = system.size_m();
        let masses = system.bodies.iter().map(|body| body.mass_kg);
        let root_mass = masses.fold(0.0_f64, f64::max).sqrt();
        // No joint pushes on what has no mass.
        let inverse = |mass: f64| if mass > 0.0 { 1.0 / mass } else { 0.0 };
        let inverse_mass = system.masses().into_iter().map(inverse);
        Self {
            kinds: kinds.collect(),
            per_scale: per_scale.collect(),
            floor: [
                ROUNDING * size,
                ROUNDING,
                ROUNDING * size * root_mass,
                ROUNDING,
            ],
            revolved: 1.0,
            reach: (size, root_mass),
            inverse_mass: inverse_mass.collect(),
            pushed: vec![0.0; n],
            share_of_error: SHARE * scheme.velocity_error_constant() * scheme.beta / scheme.gamma,
        }
    }

    /// Begins a step at which joints have turned by so much \[rad\].
    pub(crate) fn begin(&mut self, largest_angle_rad: f64) {
        self.revolved = 1.0 + largest_angle_rad;
    }

    /// Measures the latest correction. That of the reactions counts as the increment that it would cause if the bodies
    /// were free, M⁻¹Bᵀμ with the diagonal of M: with old factors δ can vanish while λ does not converge.
    pub(crate) fn measure(&mut self, kept: &[usize], step: &Progress<'_>) -> Measured {
        if !kept.is_empty() {
            self.pushed.fill(0.0);
        }
        for &equation in kept {
            let mu = step.mu[equation];
            for (dof, b) in step.gradient.entries(equation) {
                self.pushed[dof] += mu * b;
            }
        }
        let mut most = [(0.0_f64, 0); KINDS];
        let mut sum = 0.0;
        let corrections = step.delta.iter().zip(&self.pushed).zip(&self.inverse_mass);
        for (dof, (((delta, push), inverse), &kind)) in corrections.zip(&self.kinds).enumerate() {
            let correction = delta.abs().max((inverse * push).abs()) * self.per_scale[dof];
            // What is no number would be lost in the maximum.
            sum += delta + push;
            if correction > most[kind].0 {
                most[kind] = (correction, dof);
            }
        }
        let allowed = match step.stated {
            Some(stated) => self.moved(step).map(|size| stated * size),
            None => {
                let (error, moved) = (self.own_error(step), self.moved(step));
                std::array::from_fn(|kind| {
                    (self.share_of_error * error[kind]).min(MOST * moved[kind])
                })
            }
        };
        let (mut ratio, mut largest, mut above_floor) = (0.0_f64, 0, 0.0_f64);
        for (kind, (correction, dof)) in most.into_iter().enumerate() {
            let floor = self.floor[kind] * self.revolved;
            let here = correction / (allowed[kind] + floor);
            if here > ratio {
                (ratio, largest) = (here, dof);
            }
            above_floor = above_floor.max(correction / floor);
        }
        Measured {
            ratio: if sum.is_finite() { ratio } else { f64::NAN },
            largest,
            above_floor,
        }
    }

    /// h² |v̇_{n+1} − 2 v̇_n + v̇_{n−1}|, the largest of each kind.
    fn own_error(&self, step: &Progress<'_>) -> [f64; KINDS] {
        let h = step.step_s;
        let mut largest = [0.0_f64; KINDS];
        let accelerations = step.new_acceleration.iter().zip(step.acceleration);
        let kinds = self.kinds.iter().zip(&self.per_scale);
        for (((new, old), jerk), (&kind, scale)) in accelerations.zip(step.jerk).zip(kinds) {
            largest[kind] = largest[kind].max((new - old - h * jerk).abs() * scale);
        }
        self.shared(largest.map(|bend| h * h * bend))
    }

    /// The largest increment of each kind.
    fn moved(&self, step: &Progress<'_>) -> [f64; KINDS] {
        let mut largest = [0.0_f64; KINDS];
        let moves = step.increment.iter().zip(step.velocity);
        let kinds = self.kinds.iter().zip(&self.per_scale);
        for ((increment, velocity), (&kind, scale)) in moves.zip(kinds) {
            let moved = increment.abs().max(step.step_s * velocity.abs()) * scale;
            largest[kind] = largest[kind].max(moved);
        }
        self.shared(largest)
    }

    /// A turn moves places, and places modal coordinates: what hardly moves in a system that spins need not be exact to
    /// a share of its own small motion.
    fn shared(&self, mut size: [f64; KINDS]) -> [f64; KINDS] {
        let (arm, root_mass) = self.reach;
        size[0] = size[0].max(arm * size[1]);
        size[2] = size[2].max(root_mass * size[0]);
        size[3] = size[3].max(size[1]);
        size
    }
}
