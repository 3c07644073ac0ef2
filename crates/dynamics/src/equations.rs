//! The equations of a system at one motion.
//!
//! ```text
//! inertia(q, v, v̇) + Bᵀλ − Q(q, v, t) = 0          residual, one entry for each degree of freedom
//! φ(q) − offset − f(t) = 0,   B = ∂φ/∂q            violation, one entry for each equation of a joint
//! ```

use nalgebra::SVector;

use crate::body::BodyId;
use crate::elements::{Iterate, View};
use crate::error::DynamicsError;
use crate::inertia::{Motion, Tangents};
use crate::matrix::Matrix;
use crate::state::{State, motion_of};
use crate::system::{System, view};
use crate::unknown::UnknownKind;

/// Whether tangents are wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Detail {
    Forces,
    Tangents,
}

/// A motion at which the equations are evaluated.
#[derive(Clone, Copy)]
pub(crate) struct At<'a> {
    pub state: &'a State,
    pub acceleration: &'a [f64],
    /// One for each joint equation, dropped ones included (zero).
    pub lambda: &'a [f64],
    pub load_factor: f64,
    pub iterate: Iterate,
}

/// The equations at one motion.
pub(crate) struct Equations {
    pub residual: Vec<f64>,
    pub violation: Vec<f64>,
    /// d(violation)/dt
    pub violation_rate: Vec<f64>,
    pub mass: Matrix,
    /// ∂residual/∂velocity
    pub damping: Matrix,
    /// ∂residual/∂increment
    pub stiffness: Matrix,
    /// Bᵀ: one column for each joint equation.
    pub gradient: Matrix,
}

impl Equations {
    pub(crate) fn new(system: &System) -> Self {
        let (n, m) = (system.degrees_of_freedom(), system.equations());
        let square = Matrix::zeros(&system.structure.square);
        Self {
            residual: vec![0.0; n],
            violation: vec![0.0; m],
            violation_rate: vec![0.0; m],
            mass: square.clone(),
            damping: square.clone(),
            stiffness: square,
            gradient: Matrix::zeros(&system.structure.gradient),
        }
    }
}

impl System {
    /// Evaluates all equations.
    pub(crate) fn evaluate(
        &mut self,
        at: At<'_>,
        detail: Detail,
        out: &mut Equations,
    ) -> Result<(), DynamicsError> {
        self.evaluate_without_elements(at, detail, out);
        self.subtract_elements(at, detail, out)
    }

    /// Inertia and joints only: what mass matrix and constraints need.
    pub(crate) fn evaluate_without_elements(
        &mut self,
        at: At<'_>,
        detail: Detail,
        out: &mut Equations,
    ) {
        self.refresh(at.state);
        out.residual.fill(0.0);
        if detail == Detail::Tangents {
            out.mass.clear();
            out.damping.clear();
            out.stiffness.clear();
            out.gradient.clear();
        }
        self.add_inertia(at, detail, out);
        self.add_unknowns(at, detail, out);
        self.add_joints(at, detail, out);
    }

    fn add_inertia(&self, at: At<'_>, detail: Detail, out: &mut Equations) {
        for (body, inertia) in self.inertias.iter().enumerate() {
            let start = self.layout.start(BodyId(body)).unwrap_or_default();
            let modes = self.layout.size(BodyId(body)) - 6;
            let range = start..start + 6 + modes;
            let first = self.layout.modal_start(body);
            let motion = Motion {
                body: &self.motions[body],
                modal: &at.state.modal[first..first + modes],
                velocity: &at.state.velocity[range.clone()],
                acceleration: &at.acceleration[range.clone()],
            };
            inertia.add_forces(&motion, &mut out.residual[range]);
            if detail == Detail::Tangents {
                inertia.add_tangents(
                    &motion,
                    &mut Tangents {
                        start,
                        mass: &mut out.mass,
                        damping: &mut out.damping,
                        stiffness: &mut out.stiffness,
                    },
                );
            }
        }
    }

    /// Left-hand sides of the equations of elements' own coordinates: m ü, u̇ or nothing.
    fn add_unknowns(&self, at: At<'_>, detail: Detail, out: &mut Equations) {
        for (dof, unknown) in self.layout.unknown_dofs() {
            match unknown.kind {
                UnknownKind::Inertial { mass } => {
                    out.residual[dof] += mass * at.acceleration[dof];
                    if detail == Detail::Tangents {
                        out.mass.add(dof, dof, mass);
                    }
                }
                UnknownKind::Rate => {
                    out.residual[dof] += at.state.velocity[dof];
                    if detail == Detail::Tangents {
                        out.damping.add(dof, dof, 1.0);
                    }
                }
                UnknownKind::Equilibrium => {}
            }
        }
    }

    fn add_joints(&self, at: At<'_>, detail: Detail, out: &mut Equations) {
        let mut first = 0;
        for joint in &self.joints {
            let count = joint.equations();
            let lambda = &at.lambda[first..first + count];
            for equation in 0..count {
                let prescribed = joint.prescribed(equation, at.state.time_s);
                out.violation[first + equation] = -joint.offset(equation) - prescribed.value;
                out.violation_rate[first + equation] = -prescribed.rate;
            }
            for (index, pair) in joint.pairs().iter().enumerate() {
                let [a, b] = [pair.a.body, pair.b.body].map(|body| motion_of(&self.motions, body));
                let motion = pair.motion(a, b);
                let starts = [pair.a.body, pair.b.body].map(|body| self.layout.start(body));
                for equation in 0..count {
                    out.violation[first + equation] += joint.part(equation, index, &motion);
                }
                let mut load = SVector::<f64, 6>::zeros();
                joint.rows(index, &motion, |row| {
                    load += lambda[row.equation] * row.load;
                    out.violation_rate[first + row.equation] += row.rate;
                    if detail == Detail::Tangents {
                        add_gradient(
                            &mut out.gradient,
                            first + row.equation,
                            &starts,
                            &row.gradient(),
                        );
                    }
                });
                let reaction = motion.generalised_force(&load);
                for (start, half) in starts.iter().zip(reaction.as_slice().chunks(6)) {
                    if let Some(start) = start {
                        for (place, value) in out.residual[*start..].iter_mut().zip(half) {
                            *place += value;
                        }
                    }
                }
                if detail == Detail::Tangents {
                    let tangent = joint.tangent(index, (lambda, &load), &motion);
                    for (j, column) in starts.iter().enumerate() {
                        for (i, row) in starts.iter().enumerate() {
                            let (Some(row), Some(column)) = (row, column) else {
                                continue;
                            };
                            for k in 0..6 {
                                let values = &tangent.as_slice()[12 * (6 * j + k) + 6 * i..][..6];
                                out.stiffness.add_column(*row, column + k, values);
                            }
                        }
                    }
                }
            }
            first += count;
        }
    }

    fn subtract_elements(
        &mut self,
        at: At<'_>,
        detail: Detail,
        out: &mut Equations,
    ) -> Result<(), DynamicsError> {
        let view = View {
            iterate: at.iterate,
            ..view(&self.motions, &self.layout, at.state, at.load_factor)
        };
        for slot in &mut self.slots {
            slot.loads.begin(detail == Detail::Tangents);
            slot.force_calls += 1;
            let own = slot.own(&view, at.state);
            let evaluated = slot.element.evaluate(&own, &mut slot.loads);
            evaluated.map_err(|source| slot.failure(at.state.time_s, source))?;
            for place in &slot.places {
                place.subtract(&slot.loads.force, &mut out.residual);
            }
            if detail == Detail::Tangents {
                slot.tangent_calls += 1;
                if slot.loads.is_outside_couplings() {
                    return Err(DynamicsError::Couplings {
                        element: slot.element.name().to_owned(),
                    });
                }
                let (loads, places) = (&slot.loads, &slot.matrix_places);
                out.stiffness
                    .subtract_at(loads.by_position.values(), places);
                out.damping.subtract_at(loads.by_velocity.values(), places);
            }
        }
        Ok(())
    }

    /// (dB/dt) v for every joint equation, from the derivative of Bᵀλ: for one unit of λ it is vᵀ ∂(Bᵀλ)/∂q v.
    pub(crate) fn gradient_rate(&mut self, state: &State) -> Vec<f64> {
        self.refresh(state);
        let mut rates = Vec::with_capacity(self.equations());
        for joint in &self.joints {
            for equation in 0..joint.equations() {
                let mut unit = vec![0.0; joint.equations()];
                unit[equation] = 1.0;
                let pairs = joint.pairs().iter().enumerate();
                let terms = pairs.map(|(index, pair)| {
                    let [a, b] =
                        [pair.a.body, pair.b.body].map(|body| motion_of(&self.motions, body));
                    let motion = pair.motion(a, b);
                    let load = -joint.load(index, &unit, &motion);
                    let tangent = joint.tangent(index, (&unit, &load), &motion);
                    let mut velocity = SVector::<f64, 12>::zeros();
                    for (half, motion) in [a, b].iter().enumerate() {
                        velocity
                            .fixed_rows_mut::<3>(6 * half)
                            .copy_from(&motion.velocity_m_per_s);
                        velocity
                            .fixed_rows_mut::<3>(6 * half + 3)
                            .copy_from(&motion.angular_velocity_rad_per_s);
                    }
                    velocity.dot(&(tangent * velocity))
                });
                rates.push(terms.sum());
            }
        }
        rates
    }
}

fn add_gradient(
    gradient: &mut Matrix,
    column: usize,
    starts: &[Option<usize>; 2],
    values: &SVector<f64, 12>,
) {
    for (start, half) in starts.iter().zip(values.as_slice().chunks(6)) {
        if let Some(start) = start {
            gradient.add_column(*start, column, half);
        }
    }
}
