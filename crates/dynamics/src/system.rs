//! The system: bodies, joints and force elements put together, and its equations at one motion.
//!
//! ```text
//! inertia(q, v, v̇) + Bᵀλ − Q(q, v, t) = 0          residual, one entry for each degree of freedom
//! φ(q) − offset − f(t) = 0,   B = ∂φ/∂q            violation, one entry for each equation of a joint
//! ```

use nalgebra::{Matrix3, SVector};

use crate::body::{Body, BodyId, GROUND};
use crate::builder::SystemBuilder;
use crate::constraints::Redundancy;
use crate::elements::{Channel, ForceElement, Loads, View};
use crate::energy::Energy;
use crate::error::DynamicsError;
use crate::inertia::{Inertia, Motion, Tangents};
use crate::joint::Joint;
use crate::matrix::Matrix;
use crate::state::{BodyMotion, Layout, State};

/// A force element at its place in the system.
pub(crate) struct Slot {
    pub element: Box<dyn ForceElement>,
    /// System degree of freedom of each local one; `None` on the ground.
    places: Vec<Option<usize>>,
    loads: Loads,
    force_calls: u64,
    tangent_calls: u64,
}

impl Slot {
    pub(crate) fn new(element: Box<dyn ForceElement>, layout: &Layout) -> Self {
        let places: Vec<Option<usize>> = element
            .bodies()
            .iter()
            .flat_map(|&body| {
                let start = layout.start(body);
                (0..layout.size(body)).map(move |i| start.map(|start| start + i))
            })
            .collect();
        Self {
            element,
            loads: Loads::new(places.len()),
            places,
            force_calls: 0,
            tangent_calls: 0,
        }
    }
}

/// How often an element was asked.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Calls {
    /// Name of the element.
    pub element: String,
    /// Evaluations of its force.
    pub force: u64,
    /// Those among them with tangents.
    pub tangents: u64,
}

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
        let square = Matrix::zeros(n, n);
        Self {
            residual: vec![0.0; n],
            violation: vec![0.0; m],
            violation_rate: vec![0.0; m],
            mass: square.clone(),
            damping: square.clone(),
            stiffness: square,
            gradient: Matrix::zeros(n, m),
        }
    }
}

/// Bodies, joints and force elements; made by [`SystemBuilder`].
pub struct System {
    pub(crate) bodies: Vec<Body>,
    pub(crate) inertias: Vec<Inertia>,
    pub(crate) layout: Layout,
    pub(crate) joints: Vec<Joint>,
    pub(crate) slots: Vec<Slot>,
    pub(crate) motions: Vec<BodyMotion>,
    /// Joint equations that are solved; the others follow from them.
    pub(crate) kept: Vec<usize>,
    pub(crate) redundant: Vec<Redundancy>,
    pub(crate) start: State,
}

impl System {
    /// Begins a system.
    #[must_use]
    pub fn builder() -> SystemBuilder {
        SystemBuilder::default()
    }

    /// Degrees of freedom of all bodies, joints not counted.
    #[must_use]
    pub fn degrees_of_freedom(&self) -> usize {
        self.layout.degrees_of_freedom()
    }

    /// Joint equations, redundant ones included.
    #[must_use]
    pub fn equations(&self) -> usize {
        self.joints.iter().map(Joint::equations).sum()
    }

    /// Degrees of freedom that the joints leave.
    #[must_use]
    pub fn mobility(&self) -> usize {
        self.degrees_of_freedom() - self.kept.len()
    }

    /// Joints with equations that others imply already; solved all the same.
    #[must_use]
    pub fn redundant(&self) -> &[Redundancy] {
        &self.redundant
    }

    /// Bodies, in the order of their numbers.
    #[must_use]
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// Joints.
    #[must_use]
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// Where the numbers of each body stand.
    #[must_use]
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// The start: as the bodies state it, moved onto the joints.
    #[must_use]
    pub fn start(&self) -> &State {
        &self.start
    }

    /// Names of the force elements.
    pub fn elements(&self) -> impl Iterator<Item = &str> {
        self.slots.iter().map(|slot| slot.element.name())
    }

    /// How often each element was asked so far.
    #[must_use]
    pub fn calls(&self) -> Vec<Calls> {
        let calls = self.slots.iter().map(|slot| Calls {
            element: slot.element.name().to_owned(),
            force: slot.force_calls,
            tangents: slot.tangent_calls,
        });
        calls.collect()
    }

    /// What [`Self::sample`] writes: the channels of each element with its name.
    #[must_use]
    pub fn channels(&self) -> Vec<(String, Channel)> {
        let of = |slot: &Slot| {
            let name = slot.element.name().to_owned();
            let channels = slot.element.channels().into_iter();
            channels
                .map(|channel| (name.clone(), channel))
                .collect::<Vec<_>>()
        };
        self.slots.iter().flat_map(of).collect()
    }

    /// Writes all channels at a motion, in the order of [`Self::channels`]. `counts` holds the number of channels of each element,
    /// so that nothing is allocated here.
    pub fn sample(&mut self, state: &State, counts: &[usize], out: &mut [f64]) {
        self.refresh(state);
        let view = view(&self.motions, &self.layout, state, 1.0);
        let mut rest = out;
        for (slot, &count) in self.slots.iter_mut().zip(counts) {
            let (own, after) = rest.split_at_mut(count);
            slot.element.sample(&view, own);
            rest = after;
        }
    }

    /// Takes the motion of a state into [`Self::motions`].
    pub(crate) fn refresh(&mut self, state: &State) {
        for (body, motion) in self.motions.iter_mut().enumerate() {
            *motion = BodyMotion::of(state, &self.layout, body);
        }
    }

    /// Angles and offsets of joints begin at this motion.
    pub(crate) fn begin_joints(&mut self, state: &State) {
        self.refresh(state);
        let motions = &self.motions;
        for joint in &mut self.joints {
            joint.begin(state.time_s, &|body| motion_of(motions, body));
        }
    }

    /// Internal states of joints and elements begin at this motion.
    pub(crate) fn begin(&mut self, state: &State) {
        self.begin_joints(state);
        let view = view(&self.motions, &self.layout, state, 1.0);
        for slot in &mut self.slots {
            slot.element.begin(&view);
        }
    }

    /// Internal states move on to an accepted motion.
    pub(crate) fn commit(&mut self, state: &State) {
        self.refresh(state);
        let motions = &self.motions;
        for joint in &mut self.joints {
            joint.commit(&|body| motion_of(motions, body));
        }
        let view = view(&self.motions, &self.layout, state, 1.0);
        for slot in &mut self.slots {
            slot.element.commit(&view);
        }
    }

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
                let motion = pair.motion(&a, &b);
                let starts = [pair.a.body, pair.b.body].map(|body| self.layout.start(body));
                for equation in 0..count {
                    out.violation[first + equation] += joint.part(equation, index, &motion);
                }
                let reaction = joint.reaction(index, lambda, &motion);
                for (start, half) in starts.iter().zip(reaction.as_slice().chunks(6)) {
                    if let Some(start) = start {
                        for (place, value) in out.residual[*start..].iter_mut().zip(half) {
                            *place += value;
                        }
                    }
                }
                joint.rows(index, &motion, |row| {
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
                if detail == Detail::Tangents {
                    let jacobian = motion.jacobian();
                    let tangent = joint.tangent(index, lambda, &motion, &jacobian);
                    for (j, column) in starts.iter().enumerate() {
                        for (i, row) in starts.iter().enumerate() {
                            let (Some(row), Some(column)) = (row, column) else {
                                continue;
                            };
                            for (k, l) in [(0, 0), (0, 3), (3, 0), (3, 3)] {
                                let block: Matrix3<f64> =
                                    tangent.fixed_view::<3, 3>(6 * i + k, 6 * j + l).into();
                                out.stiffness.add3(row + k, column + l, &block);
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
        let view = view(&self.motions, &self.layout, at.state, at.load_factor);
        for slot in &mut self.slots {
            slot.loads.begin(detail == Detail::Tangents);
            slot.force_calls += 1;
            slot.element
                .evaluate(&view, &mut slot.loads)
                .map_err(|source| DynamicsError::Element {
                    element: slot.element.name().to_owned(),
                    time_s: at.state.time_s,
                    source,
                })?;
            for (place, force) in slot.places.iter().zip(&slot.loads.force) {
                if let Some(place) = place {
                    out.residual[*place] -= force;
                }
            }
            if detail == Detail::Tangents {
                slot.tangent_calls += 1;
                for (j, column) in slot.places.iter().enumerate() {
                    let Some(column) = column else { continue };
                    let by_position = slot.loads.by_position.column(j);
                    let by_velocity = slot.loads.by_velocity.column(j);
                    let stiffness = out.stiffness.column_mut(*column);
                    let damping = out.damping.column_mut(*column);
                    for (i, row) in slot.places.iter().enumerate() {
                        if let Some(row) = row {
                            stiffness[*row] -= by_position[i];
                            damping[*row] -= by_velocity[i];
                        }
                    }
                }
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
                    let motion = pair.motion(&a, &b);
                    let tangent = joint.tangent(index, &unit, &motion, &motion.jacobian());
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

    /// f̈ of every joint equation, and ḟ.
    pub(crate) fn prescribed(
        &self,
        time_s: f64,
    ) -> impl Iterator<Item = crate::time_function::Derivatives> + '_ {
        self.joints
            .iter()
            .flat_map(move |joint| (0..joint.equations()).map(move |i| joint.prescribed(i, time_s)))
    }

    /// Energies and powers at an evaluated motion; powers of elements are those of their last evaluation.
    pub(crate) fn energy(&self, state: &State, lambda: &[f64]) -> Energy {
        let mut energy = Energy::default();
        for (body, inertia) in self.inertias.iter().enumerate() {
            let first = self.layout.modal_start(body);
            let start = self.layout.start(BodyId(body)).unwrap_or_default();
            let modes = self.layout.size(BodyId(body)) - 6;
            let modal = &state.modal[first..first + modes];
            let rates = &state.velocity[start + 6..start + 6 + modes];
            energy.kinetic_j += inertia.kinetic_energy(&self.motions[body], modal, rates);
            energy.potential_j += inertia.strain_energy(modal);
            energy.dissipated_w += inertia.dissipated_power(rates);
        }
        for slot in &self.slots {
            energy.potential_j += slot.loads.power.stored_j;
            energy.dissipated_w += slot.loads.power.dissipated_w;
            energy.supplied_w += slot.loads.power.supplied_w;
        }
        for (lambda, motion) in lambda.iter().zip(self.prescribed(state.time_s)) {
            energy.supplied_w -= lambda * motion.rate;
        }
        energy
    }

    /// Size of the system \[m\]: the farthest body or joint, at least a millimetre. What rounding of places is compared with.
    pub(crate) fn size_m(&self) -> f64 {
        let places = self.start.positions_m.iter().map(|x| x.norm());
        let markers = self.joints.iter().flat_map(|joint| joint.pairs().iter());
        let arms = markers.flat_map(|pair| [pair.a.position_m.norm(), pair.b.position_m.norm()]);
        places.chain(arms).fold(1e-3, f64::max)
    }

    /// Name of the joint that an equation belongs to.
    pub(crate) fn joint_of(&self, equation: usize) -> &str {
        let mut first = 0;
        for joint in &self.joints {
            first += joint.equations();
            if equation < first {
                return joint.name();
            }
        }
        ""
    }

    /// Body and direction of a degree of freedom, in words.
    pub(crate) fn describe(&self, dof: usize) -> String {
        let (body, place) = self.layout.locate(dof);
        let what = match place {
            0..=2 => format!("translation along {}", ["x", "y", "z"][place]),
            3..=5 => format!("rotation about its own {}", ["x", "y", "z"][place - 3]),
            _ => format!("mode {}", place - 6),
        };
        format!("body `{}`, {what}", self.bodies[body].name)
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
            let target = &mut gradient.column_mut(column)[*start..start + 6];
            for (place, value) in target.iter_mut().zip(half) {
                *place += value;
            }
        }
    }
}

fn motion_of(motions: &[BodyMotion], body: BodyId) -> BodyMotion {
    if body == GROUND {
        BodyMotion::at_rest()
    } else {
        motions[body.0]
    }
}

fn view<'a>(
    motions: &'a [BodyMotion],
    layout: &'a Layout,
    state: &'a State,
    load_factor: f64,
) -> View<'a> {
    View {
        time_s: state.time_s,
        load_factor,
        motions,
        modal: &state.modal,
        velocity: &state.velocity,
        layout,
    }
}
