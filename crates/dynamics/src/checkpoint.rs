//! The whole state of a run as plain arrays: a run that goes on from them gives the same bits as one that was never
//! stopped.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use crate::energy::EnergyBalance;
use crate::error::DynamicsError;
use crate::integrator::{Effort, Integrator, Point};
use crate::scheme::{Params, Scheme};
use crate::simulation::{RunInfo, Simulation};
use crate::state::State;
use crate::system::System;

/// Scalars and counts that checkpoints of earlier versions have.
const OLD_SCALARS: usize = 20;
const OLD_COUNTS: usize = 8;

/// Arrays of a run. Each may be stored as it is; names say what they hold.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Checkpoint {
    /// time, step length, step length of the factors \[s\], shortest and longest step \[s\], largest violations (2),
    /// energies (13), what rounding has left out of the time \[s\] (left out by earlier versions: none).
    pub scalars: Vec<f64>,
    /// steps, rejected, unconverged, iterations, factorisations, pivotings, evaluations, steps of the present length,
    /// steps to come that begin with new factors (left out by earlier versions: none).
    pub counts: Vec<u64>,
    /// x, y, z of every body \[m\].
    pub positions_m: Vec<f64>,
    /// w, i, j, k of every body.
    pub quaternions: Vec<f64>,
    /// Modal coordinates.
    pub modal: Vec<f64>,
    /// Coordinates of elements.
    pub unknowns: Vec<f64>,
    /// v, v̇, a and v̈, one after the other.
    pub velocities: Vec<f64>,
    /// λ
    pub reactions: Vec<f64>,
    /// Angles and offsets of joints, then the internal states of elements.
    pub internal: Vec<f64>,
    /// The iteration matrix that was factorised last, the scales of its joint rows, where it is sparse the matrix for
    /// which pivots were chosen, and the gradients of the joints when it was made.
    pub matrix: Vec<f64>,
}

impl Checkpoint {
    fn clock_rest_s(&self) -> f64 {
        self.scalars.get(OLD_SCALARS).copied().unwrap_or_default()
    }

    /// Whether arrays have the lengths that a system needs, whose matrix has so many numbers, and times make sense.
    fn check(&self, system: &System, start: &State, matrix: usize) -> Result<(), DynamicsError> {
        let (n, bodies) = (system.degrees_of_freedom(), system.bodies().len());
        let mut saved = Vec::new();
        for slot in &system.slots {
            slot.element.save(&mut saved);
        }
        let of_joints: usize = system.joints().iter().map(crate::joint::Joint::saved).sum();
        // Earlier versions leave the last one out.
        let (scalars, counts) = (self.scalars.len(), self.counts.len());
        for (what, found, expected) in [
            (
                "scalars",
                scalars,
                scalars.clamp(OLD_SCALARS, OLD_SCALARS + 1),
            ),
            ("counts", counts, counts.clamp(OLD_COUNTS, OLD_COUNTS + 1)),
            ("positions_m", self.positions_m.len(), 3 * bodies),
            ("quaternions", self.quaternions.len(), 4 * bodies),
            ("modal", self.modal.len(), start.modal.len()),
            ("unknowns", self.unknowns.len(), start.unknowns.len()),
            ("velocities", self.velocities.len(), 4 * n),
            ("reactions", self.reactions.len(), system.equations()),
            ("internal", self.internal.len(), of_joints + saved.len()),
            ("matrix", self.matrix.len(), matrix),
        ] {
            if found != expected {
                return Err(DynamicsError::Checkpoint {
                    what,
                    found,
                    expected,
                });
            }
        }
        let (time_s, step_s, rest_s) = (self.scalars[0], self.scalars[1], self.clock_rest_s());
        for (what, found, is_fine) in [
            ("its time", time_s, time_s >= 0.0),
            ("its step", step_s, step_s > 0.0),
            ("the rest of its clock", rest_s, rest_s.abs() < step_s),
        ] {
            if !(is_fine && found.is_finite()) {
                return Err(DynamicsError::CheckpointNumber { what, found });
            }
        }
        Ok(())
    }
}

impl Simulation {
    /// The run as it stands.
    #[must_use]
    pub fn checkpoint(&self) -> Checkpoint {
        let (info, point) = (&self.info, &self.now);
        let mut scalars = vec![
            point.state.time_s,
            self.step_s,
            self.integrator.factored_step_s,
            info.step_range_s.0,
            info.step_range_s.1,
            info.largest_violation,
            info.largest_violation_rate,
        ];
        scalars.extend(info.energy.numbers());
        scalars.push(point.clock_rest_s);
        let mut internal = Vec::new();
        for joint in self.system.joints() {
            joint.save(&mut internal);
        }
        for slot in &self.system.slots {
            slot.element.save(&mut internal);
        }
        let mut matrix = Vec::new();
        self.integrator.saddle.save(&mut matrix);
        matrix.extend_from_slice(self.integrator.equations.gradient.values());
        let vectors = [
            &point.state.velocity,
            &point.acceleration,
            &point.algorithmic,
            &point.jerk,
        ];
        Checkpoint {
            scalars,
            counts: vec![
                info.steps,
                info.rejected,
                info.unconverged,
                info.iterations,
                info.factorisations,
                info.pivotings,
                info.evaluations,
                self.steps_alike,
                self.integrator.fresh_steps,
            ],
            positions_m: point
                .state
                .positions_m
                .iter()
                .flat_map(|x| [x[0], x[1], x[2]])
                .collect(),
            quaternions: point
                .state
                .orientations
                .iter()
                .flat_map(|q| [q.w, q.i, q.j, q.k])
                .collect(),
            modal: point.state.modal.clone(),
            unknowns: point.state.unknowns.clone(),
            velocities: vectors.into_iter().flatten().copied().collect(),
            reactions: point.lambda.clone(),
            internal,
            matrix,
        }
    }

    /// Goes on from a checkpoint with the system and the parameters that wrote it.
    ///
    /// # Errors
    /// [`DynamicsError::Checkpoint`] if an array has another length than the system needs,
    /// [`DynamicsError::CheckpointNumber`], [`DynamicsError::Parameter`].
    pub fn resume(
        mut system: System,
        params: Params,
        checkpoint: &Checkpoint,
    ) -> Result<Self, DynamicsError> {
        params.validate()?;
        let start = system.start().clone();
        system.begin(&start);
        let mut integrator = Integrator::new(
            &system,
            Scheme::new(params.rho_infinity),
            params.linear_solver,
        );
        let saved_matrix = integrator.saddle.saved();
        let gradients = integrator.equations.gradient.values().len();
        let n = system.degrees_of_freedom();
        let c = checkpoint;
        c.check(&system, &start, saved_matrix + gradients)?;
        let clock_rest_s = c.clock_rest_s();
        let (matrix, gradient) = c.matrix.split_at(saved_matrix);
        integrator.saddle.restore(matrix);
        integrator.equations.gradient.set(gradient);
        integrator.factored_step_s = c.scalars[2];
        integrator.fresh_steps = c.counts.get(OLD_COUNTS).copied().unwrap_or_default();
        integrator.effort = Effort::default();
        restore_internal(&mut system, &c.internal);
        let vector = |k: usize| c.velocities[k * n..(k + 1) * n].to_vec();
        let quaternion =
            |q: &[f64]| UnitQuaternion::new_unchecked(Quaternion::new(q[0], q[1], q[2], q[3]));
        let now = Point {
            state: State {
                time_s: c.scalars[0],
                positions_m: c
                    .positions_m
                    .chunks(3)
                    .map(Vector3::from_column_slice)
                    .collect(),
                orientations: c.quaternions.chunks(4).map(quaternion).collect(),
                modal: c.modal.clone(),
                unknowns: c.unknowns.clone(),
                velocity: vector(0),
            },
            acceleration: vector(1),
            algorithmic: vector(2),
            jerk: vector(3),
            lambda: c.reactions.clone(),
            clock_rest_s,
        };
        let mut energies = [0.0; 13];
        energies.copy_from_slice(&c.scalars[7..OLD_SCALARS]);
        Ok(Self {
            other: now.clone(),
            info: RunInfo {
                steps: c.counts[0],
                rejected: c.counts[1],
                unconverged: c.counts[2],
                iterations: c.counts[3],
                factorisations: c.counts[4],
                pivotings: c.counts[5],
                evaluations: c.counts[6],
                step_range_s: (c.scalars[3], c.scalars[4]),
                largest_violation: c.scalars[5],
                largest_violation_rate: c.scalars[6],
                energy: EnergyBalance::from_numbers(&energies),
            },
            system,
            params,
            integrator,
            now,
            step_s: c.scalars[1],
            steps_alike: c.counts[7],
        })
    }
}

/// Hands stored numbers to joints and elements, in the order in which they were saved; the total length has been
/// checked.
fn restore_internal(system: &mut System, numbers: &[f64]) {
    let mut rest = numbers;
    let mut take = |count: usize| {
        let (own, after) = rest.split_at(count);
        rest = after;
        own
    };
    for joint in &mut system.joints {
        let own = take(joint.saved());
        joint.restore(own);
    }
    let mut own = Vec::new();
    for slot in &mut system.slots {
        own.clear();
        slot.element.save(&mut own);
        slot.element.restore(take(own.len()));
    }
}
