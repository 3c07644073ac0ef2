//! The system: bodies, joints and force elements put together. Its equations are in `equations.rs`.

use std::ops::Range;
use std::sync::Arc;

use crate::body::{Body, BodyId, GROUND};
use crate::elements::{Channel, ForceElement, Iterate, Loads, View};
use crate::energy::Energy;
use crate::error::{DynamicsError, ElementFailure};
use crate::inertia::Inertia;
use crate::joint::Joint;
use crate::matrix::NOWHERE;
use crate::pattern::Pattern;
use crate::redundancy::Redundancy;
use crate::state::{BodyMotion, Layout, State, motion_of};
use crate::structure::Structure;

/// A force element at its place in the system.
pub(crate) struct Slot {
    pub element: Box<dyn ForceElement>,
    /// Where the degrees of freedom of its bodies stand; the ground has none.
    pub places: Vec<Place>,
    /// Its own coordinates among those of all elements.
    pub unknowns: Range<usize>,
    /// Local degrees of freedom that depend on each other.
    groups: Vec<Vec<usize>>,
    /// For each entry of its tangents, where it stands in the system's matrices.
    pub matrix_places: Vec<usize>,
    pub loads: Loads,
    pub force_calls: u64,
    pub tangent_calls: u64,
}

/// Degrees of freedom of one body: first among the element's and the system's, and how many.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place {
    pub local: usize,
    pub system: usize,
    pub count: usize,
}

impl Place {
    /// Subtracts the body's part of an element's vector from that of the system's.
    pub(crate) fn subtract(&self, of_element: &[f64], of_system: &mut [f64]) {
        let values = &of_element[self.local..][..self.count];
        let targets = &mut of_system[self.system..][..self.count];
        for (target, value) in targets.iter_mut().zip(values) {
            *target -= value;
        }
    }
}

impl Slot {
    /// Generalised force of the last evaluation on a degree of freedom of the system.
    pub(crate) fn force_on(&self, dof: usize) -> f64 {
        let here = |place: &&Place| (place.system..place.system + place.count).contains(&dof);
        let place = self.places.iter().find(here);
        place.map_or(0.0, |place| {
            self.loads.force[place.local + dof - place.system]
        })
    }

    /// Adds the magnitudes of its last forces to those of the system.
    pub(crate) fn add_magnitudes(&self, sums: &mut [f64]) {
        for place in &self.places {
            let own = &self.loads.force[place.local..][..place.count];
            for (sum, force) in sums[place.system..].iter_mut().zip(own) {
                *sum += force.abs();
            }
        }
    }

    /// Degrees of freedom of the system that it couples with each other. Those of a body's rigid motion come together.
    pub(crate) fn groups(&self, layout: &Layout) -> Vec<Vec<usize>> {
        let system = self.system_dofs();
        let of_group = |group: &Vec<usize>| -> Vec<usize> {
            let dofs = group.iter().filter_map(|&local| system[local]);
            dofs.flat_map(|dof| {
                let body = (layout.unknown(dof).is_none()).then(|| layout.locate(dof));
                match body {
                    Some((_, place)) if place < 6 => dof - place..dof - place + 6,
                    _ => dof..dof + 1,
                }
            })
            .collect()
        };
        self.groups.iter().map(of_group).collect()
    }

    /// For each local degree of freedom that of the system; none for the ground's.
    pub(crate) fn system_dofs(&self) -> Vec<Option<usize>> {
        let mut system = vec![None; self.loads.by_position.pattern().columns()];
        for place in &self.places {
            for i in 0..place.count {
                system[place.local + i] = Some(place.system + i);
            }
        }
        system
    }

    /// Finds where its tangents go in matrices of a pattern.
    pub(crate) fn find_places(&mut self, square: &Pattern) {
        let own = self.loads.by_position.pattern();
        let system = self.system_dofs();
        let mut found = Vec::with_capacity(own.len());
        for (column, of_column) in system.iter().enumerate() {
            for &row in own.column(column) {
                let place = system[row].zip(*of_column);
                let place = place.and_then(|(row, column)| square.place(row, column));
                found.push(place.unwrap_or(NOWHERE));
            }
        }
        self.matrix_places = found;
    }

    /// `unknowns`: its own coordinates among those of all elements.
    pub(crate) fn new(
        element: Box<dyn ForceElement>,
        layout: &Layout,
        unknowns: Range<usize>,
    ) -> Self {
        let (mut places, mut starts, mut local) = (Vec::new(), Vec::new(), 0);
        let mut add = |system: Option<usize>, count: usize| {
            places.extend(system.map(|system| Place {
                local,
                system,
                count,
            }));
            starts.push(local);
            local += count;
        };
        for &body in element.bodies() {
            add(layout.start(body), layout.size(body));
        }
        add(
            Some(layout.first_unknown() + unknowns.start),
            unknowns.len(),
        );
        let mut groups = element.couplings(&starts);
        if groups.is_empty() {
            groups.push((0..local).collect());
        }
        let inside = groups.iter().map(Vec::as_slice);
        let pattern = Arc::new(Pattern::of_groups(local, inside));
        Self {
            element,
            loads: Loads::new(&pattern, starts),
            places,
            unknowns,
            groups,
            matrix_places: Vec::new(),
            force_calls: 0,
            tangent_calls: 0,
        }
    }

    /// What its element reported at a time.
    pub(crate) fn failure(&self, time_s: f64, source: ElementFailure) -> DynamicsError {
        DynamicsError::Element {
            element: self.element.name().to_owned(),
            time_s,
            source,
        }
    }

    /// The view of the system as the element sees it.
    pub(crate) fn own<'a>(&self, view: &View<'a>, state: &'a State) -> View<'a> {
        let first = view.layout.first_unknown();
        let dofs = first + self.unknowns.start..first + self.unknowns.end;
        View {
            unknowns: &state.unknowns[self.unknowns.clone()],
            unknown_rates: &state.velocity[dofs],
            ..*view
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

/// Bodies, joints and force elements; made by [`SystemBuilder`](crate::SystemBuilder).
pub struct System {
    pub(crate) bodies: Vec<Body>,
    pub(crate) inertias: Vec<Inertia>,
    pub(crate) layout: Layout,
    pub(crate) structure: Structure,
    pub(crate) joints: Vec<Joint>,
    pub(crate) slots: Vec<Slot>,
    pub(crate) motions: Vec<BodyMotion>,
    /// Joint equations that are solved; the others follow from them.
    pub(crate) kept: Vec<usize>,
    pub(crate) redundant: Vec<Redundancy>,
    pub(crate) start: State,
}

impl System {
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

    /// The bodies' numbers, in their order.
    pub fn body_ids(&self) -> impl Iterator<Item = BodyId> + use<> {
        (0..self.bodies.len()).map(BodyId)
    }

    /// Motion of a body in a state; the ground's is at rest.
    #[must_use]
    pub fn body_motion(&self, state: &State, body: BodyId) -> BodyMotion {
        if body == GROUND {
            BodyMotion::at_rest()
        } else {
            BodyMotion::of(state, &self.layout, body.0)
        }
    }

    /// Writes all channels at a motion, in the order of [`Self::channels`]. `counts` holds the number of channels of
    /// each element, so that nothing is allocated here.
    pub fn sample(&mut self, state: &State, counts: &[usize], out: &mut [f64]) {
        self.refresh(state);
        // Next to where elements were asked last: at the end of a step, or at rest.
        let view = View {
            iterate: Iterate::Correction,
            ..view(&self.motions, &self.layout, state, 1.0)
        };
        let mut rest = out;
        for (slot, &count) in self.slots.iter_mut().zip(counts) {
            let (own, after) = rest.split_at_mut(count);
            let seen = slot.own(&view, state);
            slot.element.sample(&seen, own);
            rest = after;
        }
    }

    /// Takes the motion of a state into [`Self::motions`].
    pub(crate) fn refresh(&mut self, state: &State) {
        for (body, motion) in self.motions[..self.bodies.len()].iter_mut().enumerate() {
            *motion = BodyMotion::of(state, &self.layout, body);
        }
    }

    /// Angles and offsets of joints begin at this motion.
    pub(crate) fn begin_joints(&mut self, state: &State) {
        self.refresh(state);
        let motions = &self.motions;
        for joint in &mut self.joints {
            joint.begin(state.time_s, &|body| *motion_of(motions, body));
        }
    }

    /// Internal states of joints and elements begin at this motion.
    pub(crate) fn begin(&mut self, state: &State) {
        self.begin_joints(state);
        let view = view(&self.motions, &self.layout, state, 1.0);
        for slot in &mut self.slots {
            let own = slot.own(&view, state);
            slot.element.begin(&own);
        }
    }

    /// Internal states move on to an accepted motion.
    ///
    /// # Errors
    /// [`DynamicsError::Element`] of an element whose model does not cover that motion.
    pub(crate) fn commit(&mut self, state: &State) -> Result<(), DynamicsError> {
        self.refresh(state);
        let motions = &self.motions;
        for joint in &mut self.joints {
            joint.commit(&|body| *motion_of(motions, body));
        }
        let view = view(&self.motions, &self.layout, state, 1.0);
        for slot in &mut self.slots {
            let own = slot.own(&view, state);
            let committed = slot.element.commit(&own);
            committed.map_err(|source| slot.failure(state.time_s, source))?;
        }
        Ok(())
    }

    /// Whether all elements cover the motion of the last evaluation.
    ///
    /// # Errors
    /// [`DynamicsError::Element`] of the first that does not.
    pub(crate) fn admits(&self, state: &State) -> Result<(), DynamicsError> {
        let view = view(&self.motions, &self.layout, state, 1.0);
        self.slots.iter().try_for_each(|slot| {
            let admitted = slot.element.admits(&slot.own(&view, state));
            admitted.map_err(|source| slot.failure(state.time_s, source))
        })
    }

    /// f̈ of every joint equation, and ḟ.
    pub(crate) fn prescribed(
        &self,
        time_s: f64,
    ) -> impl Iterator<Item = crate::derivatives::Derivatives> + '_ {
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
        for (dof, unknown) in self.layout.unknown_dofs() {
            energy.kinetic_j += 0.5 * unknown.mass() * state.velocity[dof].powi(2);
        }
        for (lambda, motion) in lambda.iter().zip(self.prescribed(state.time_s)) {
            energy.supplied_w -= lambda * motion.rate;
        }
        energy
    }

    /// Rate of the work done, whatever its sign \[W\] (`energy.rs`), at an evaluated motion.
    pub(crate) fn work_rate_w(
        &self,
        state: &State,
        acceleration: &[f64],
        lambda: &[f64],
        masses: &[f64],
    ) -> f64 {
        let mut rate = 0.0;
        for (body, inertia) in self.inertias.iter().enumerate() {
            let start = self.layout.start(BodyId(body)).unwrap_or_default();
            let end = start + self.layout.size(BodyId(body));
            rate += inertia.dissipated_power(&state.velocity[start + 6..end]);
        }
        for slot in &self.slots {
            let power = slot.loads.power;
            rate += power.dissipated_w.abs() + power.supplied_w.abs();
        }
        for (lambda, motion) in lambda.iter().zip(self.prescribed(state.time_s)) {
            rate += (lambda * motion.rate).abs();
        }
        let moves = acceleration.iter().zip(&state.velocity);
        let of_each = moves.zip(masses).map(|((a, v), mass)| (mass * a * v).abs());
        rate + of_each.sum::<f64>()
    }

    /// Size of the system \[m\]: the farthest body or joint, at least a millimetre. What rounding of places is compared
    /// with.
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
        if let Some(unknown) = self.layout.unknown(dof) {
            let number = dof - self.layout.first_unknown();
            let owner = self
                .slots
                .iter()
                .find(|slot| slot.unknowns.contains(&number));
            let owner = owner.map_or("", |slot| slot.element.name());
            return format!("force element `{owner}`, its `{}`", unknown.name);
        }
        let (body, place) = self.layout.locate(dof);
        let what = match place {
            0..=2 => format!("translation along {}", ["x", "y", "z"][place]),
            3..=5 => format!("rotation about its own {}", ["x", "y", "z"][place - 3]),
            _ => format!("mode {}", place - 6),
        };
        format!("body `{}`, {what}", self.bodies[body].name)
    }
}

pub(crate) fn view<'a>(
    motions: &'a [BodyMotion],
    layout: &'a Layout,
    state: &'a State,
    load_factor: f64,
) -> View<'a> {
    View {
        time_s: state.time_s,
        load_factor,
        iterate: Iterate::Single,
        motions,
        modal: &state.modal,
        velocity: &state.velocity,
        layout,
        unknowns: &[],
        unknown_rates: &[],
    }
}
