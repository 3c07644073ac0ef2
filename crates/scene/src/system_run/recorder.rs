//! The row of numbers that a run writes at an output time.
//!
//! | group | columns | frame |
//! | --- | --- | --- |
//! | `bodies/NAME` | place, Cardan angles, turn about its own z axis, velocity, angular velocity, their rates, modal coordinates | place and velocity world, angular velocity body |
//! | `joints/NAME` | force and moment on body 2, angle about z and offset along z | marker of body 1; the force in world axes, too |
//! | `elements/NAME` | the element's own channels | the element's |
//! | `energy` | kinetic, potential, dissipated, supplied, error of the balance | |
//! | `run` | length of the step, largest violation of a joint so far | |

use gearmesh_dynamics::{BodyId, EnergyBalance, MarkerPair, RelativeMotion, State, System};
use gearmesh_model::Column;
use nalgebra::UnitQuaternion;

use super::counted_angles::{CountedAngles, body_angles};
use super::error::SystemRunError;
use crate::system::names::{element_column, plain};

/// What is recorded besides the time.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Selection {
    /// Bodies.
    pub bodies: Vec<BodyId>,
    /// Joints by their place in the system.
    pub joints: Vec<usize>,
    /// Force elements by their place in the system.
    pub elements: Vec<usize>,
}

impl Selection {
    /// Everything.
    pub fn all(system: &System) -> Self {
        Self {
            bodies: system.body_ids().collect(),
            joints: (0..system.joints().len()).collect(),
            elements: (0..system.elements().count()).collect(),
        }
    }
}

/// Whether the rows follow each other in time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Course {
    /// Accelerations, energies and records of the run belong to the row.
    InTime,
    /// Positions at rest.
    Static,
}

/// A moment to be recorded.
#[derive(Debug, Clone, Copy)]
pub struct Moment<'a> {
    /// First columns: time \[s\], or whatever the rows go through.
    pub abscissas: &'a [f64],
    /// State.
    pub state: &'a State,
    /// Reactions at the ends of the step.
    pub lambda: [&'a [f64]; 2],
    /// v̇ at the ends of the step.
    pub acceleration: [&'a [f64]; 2],
    /// Place within the step, 0 … 1.
    pub share: f64,
    /// Energy balance at the ends of the step.
    pub energy: [&'a EnergyBalance; 2],
    /// Length of the step \[s\].
    pub step_s: f64,
    /// Largest violation of a joint equation so far.
    pub largest_violation: f64,
}

struct RecordedBody {
    id: BodyId,
    start: UnitQuaternion<f64>,
    angles: CountedAngles<4>,
    /// Place in velocities, and in modal coordinates with their number.
    dof: usize,
    modal: (usize, usize),
}

struct RecordedPair {
    joint: usize,
    pair: usize,
    markers: MarkerPair,
    angle: CountedAngles<1>,
    /// Reactions of the joint.
    equations: std::ops::Range<usize>,
}

/// Makes the rows.
pub struct Recorder {
    columns: Vec<Column>,
    course: Course,
    bodies: Vec<RecordedBody>,
    pairs: Vec<RecordedPair>,
    /// Channels of each element, and whether it is recorded.
    counts: Vec<usize>,
    chosen: Vec<bool>,
    channels: Vec<f64>,
    lambda: Vec<f64>,
    row: Vec<f64>,
}

const AXES: [&str; 3] = ["x", "y", "z"];

/// The first column of rows in time.
pub(super) fn time() -> Column {
    Column::new("time_s", "s", "time")
}

impl Recorder {
    /// A recorder that begins at a state. `abscissas` describes the first columns.
    pub fn new(
        system: &System,
        state: &State,
        selection: &Selection,
        abscissas: Vec<Column>,
        course: Course,
    ) -> Self {
        let names: Vec<&str> = system.elements().collect();
        let all = system.channels();
        let counts: Vec<usize> = names
            .iter()
            .map(|name| all.iter().filter(|(of, _)| of == name).count())
            .collect();
        let mut recorder = Self {
            columns: abscissas,
            course,
            bodies: Vec::new(),
            pairs: Vec::new(),
            chosen: (0..names.len())
                .map(|i| selection.elements.contains(&i))
                .collect(),
            channels: vec![0.0; counts.iter().sum()],
            counts,
            lambda: vec![0.0; system.equations()],
            row: Vec::new(),
        };
        recorder.add_bodies(system, state, &selection.bodies);
        recorder.add_joints(system, state, &selection.joints);
        for (name, channel) in &all {
            let element = names.iter().position(|of| of == name);
            if element.is_some_and(|i| recorder.chosen[i]) {
                let column = element_column(name, &channel.name);
                recorder.column(column, channel.unit, &channel.description);
            }
        }
        if course == Course::InTime {
            let stored = "energy stored in springs, teeth, modes and the field of gravity";
            let supplied = "work of loads and prescribed motions since the start";
            let balance = "kinetic + potential - their start + dissipated - supplied";
            for (name, text) in [
                ("kinetic_J", "kinetic energy"),
                ("potential_J", stored),
                ("dissipated_J", "heat since the start"),
                ("supplied_J", supplied),
                ("error_J", balance),
            ] {
                recorder.column(format!("energy/{name}"), "J", text);
            }
            recorder.column("run/step_s".into(), "s", "length of the integrator's step");
            let text = "largest violation of a joint equation so far";
            recorder.column("run/largest_violation".into(), "m or rad", text);
        }
        recorder.row = Vec::with_capacity(recorder.columns.len());
        recorder
    }

    fn column(&mut self, name: String, unit: &str, description: &str) {
        self.columns.push(Column::new(name, unit, description));
    }

    /// A column for each axis, between a stem and the unit as names have it.
    fn three(&mut self, (group, stem): (&str, &str), unit: &str, in_name: &str, text: &str) {
        for axis in AXES {
            self.column(format!("{group}/{stem}{axis}_{in_name}"), unit, text);
        }
    }

    fn add_bodies(&mut self, system: &System, state: &State, ids: &[BodyId]) {
        let in_time = self.course == Course::InTime;
        let (mut dof, mut modal) = (0, 0);
        for (id, body) in system.body_ids().zip(system.bodies()) {
            let modes = body.mode_count();
            if ids.contains(&id) {
                let motion = system.body_motion(state, id);
                self.bodies.push(RecordedBody {
                    id,
                    start: motion.orientation,
                    angles: CountedAngles::begin(body_angles(
                        &motion.orientation,
                        &motion.orientation,
                        &motion.rotation,
                    )),
                    dof,
                    modal: (modal, modes),
                });
                let group = format!("bodies/{}", plain(&body.name));
                self.three((&group, ""), "m", "m", "reference point, world axes");
                let text = "Cardan angle, R = Rx Ry Rz, turns counted";
                self.three((&group, "cardan_"), "rad", "rad", text);
                let turn = "turn about its own z axis since the start, turns counted";
                self.column(format!("{group}/turn_rad"), "rad", turn);
                if in_time {
                    let text = "velocity of the reference point, world axes";
                    self.three((&group, "velocity_"), "m/s", "m_per_s", text);
                    let text = "angular velocity, body axes";
                    self.three((&group, "angular_velocity_"), "rad/s", "rad_per_s", text);
                    let text = "acceleration of the reference point, world axes";
                    self.three((&group, "acceleration_"), "m/s²", "m_per_s2", text);
                    let (stem, text) = (
                        "angular_acceleration_",
                        "rate of the angular velocity, body axes",
                    );
                    self.three((&group, stem), "rad/s²", "rad_per_s2", text);
                }
                for mode in 0..modes {
                    let name = format!("{group}/mode_{mode}_sqrt_kg_m");
                    self.column(name, "√kg·m", "modal coordinate, unit modal mass");
                }
            }
            dof += 6 + modes;
            modal += modes;
        }
    }

    fn add_joints(&mut self, system: &System, state: &State, chosen: &[usize]) {
        let mut first = 0;
        for (index, joint) in system.joints().iter().enumerate() {
            let equations = first..first + joint.equations();
            first = equations.end;
            if !chosen.contains(&index) {
                continue;
            }
            for (pair, &markers) in joint.pairs().iter().enumerate() {
                let group = if joint.pairs().len() == 1 {
                    format!("joints/{}", plain(joint.name()))
                } else {
                    format!("joints/{}/pair_{}", plain(joint.name()), pair + 1)
                };
                let text = "force of the joint on body 2, axes of the marker of body 1";
                self.three((&group, "force_"), "N", "N", text);
                let text =
                    "moment of the joint on body 2 in its marker, axes of the marker of body 1";
                self.three((&group, "moment_"), "N·m", "Nm", text);
                let text = "force of the joint on body 2, world axes";
                self.three((&group, "force_world_"), "N", "N", text);
                let text = "angle of body 2 about z of body 1's marker, turns counted";
                self.column(format!("{group}/angle_rad"), "rad", text);
                let text = "offset of body 2's marker along z of body 1's";
                self.column(format!("{group}/offset_z_m"), "m", text);
                let motion = relative(system, state, &markers);
                self.pairs.push(RecordedPair {
                    joint: index,
                    pair,
                    markers,
                    angle: CountedAngles::begin(about_z(&motion)),
                    equations: equations.clone(),
                });
            }
        }
    }

    /// What the numbers of a row are.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// The row of a moment. Allocates nothing.
    pub fn row(&mut self, system: &mut System, at: &Moment<'_>) -> &[f64] {
        let between =
            |ends: [&[f64]; 2], i: usize| (1.0 - at.share) * ends[0][i] + at.share * ends[1][i];
        let state = at.state;
        self.row.clear();
        self.row.extend_from_slice(at.abscissas);
        for body in &self.bodies {
            let motion = system.body_motion(state, body.id);
            let wrapped = body_angles(&body.start, &motion.orientation, &motion.rotation);
            self.row.extend_from_slice(motion.position_m.as_slice());
            self.row.extend(body.angles.value(wrapped));
            if self.course == Course::InTime {
                self.row
                    .extend_from_slice(&state.velocity[body.dof..body.dof + 6]);
                self.row
                    .extend((body.dof..body.dof + 6).map(|i| between(at.acceleration, i)));
            }
            let (first, modes) = body.modal;
            self.row
                .extend_from_slice(&state.modal[first..first + modes]);
        }
        for (i, lambda) in self.lambda.iter_mut().enumerate() {
            *lambda = between(at.lambda, i);
        }
        for pair in &self.pairs {
            let motion = relative(system, state, &pair.markers);
            let joint = &system.joints()[pair.joint];
            let load = joint.load(pair.pair, &self.lambda[pair.equations.clone()], &motion);
            self.row.extend_from_slice(load.as_slice());
            let force = motion.to_world(&load.fixed_rows::<3>(0).into_owned());
            self.row.extend_from_slice(force.as_slice());
            self.row.extend(pair.angle.value(about_z(&motion)));
            self.row.push(motion.displacement_m[2]);
        }
        if self.chosen.contains(&true) {
            system.sample(state, &self.counts, &mut self.channels);
            let mut rest = &self.channels[..];
            for (&count, &chosen) in self.counts.iter().zip(&self.chosen) {
                let (own, after) = rest.split_at(count);
                if chosen {
                    self.row.extend_from_slice(own);
                }
                rest = after;
            }
        }
        if self.course == Course::InTime {
            let [a, b] = at.energy.map(|balance| {
                [
                    balance.last.kinetic_j,
                    balance.last.potential_j,
                    balance.dissipated_j,
                    balance.supplied_j,
                    balance.error_j(),
                ]
            });
            self.row.extend((0..5).map(|i| between([&a, &b], i)));
            self.row.push(at.step_s);
            self.row.push(at.largest_violation);
        }
        &self.row
    }

    /// The row of a moment, if it holds numbers only. Allocates nothing.
    ///
    /// # Errors
    /// [`SystemRunError::NotFinite`] with the column.
    pub fn finite_row(
        &mut self,
        system: &mut System,
        at: &Moment<'_>,
    ) -> Result<&[f64], SystemRunError> {
        self.row(system, at);
        match self.row.iter().position(|value| !value.is_finite()) {
            None => Ok(&self.row),
            Some(place) => Err(SystemRunError::NotFinite {
                column: self.columns[place].name.clone(),
                value: self.row[place],
                abscissa: self.columns[0].name.clone(),
                at: self.row[0],
            }),
        }
    }

    /// Counts the turns of an accepted motion.
    pub fn commit(&mut self, system: &System, state: &State) {
        for body in &mut self.bodies {
            let motion = system.body_motion(state, body.id);
            let wrapped = body_angles(&body.start, &motion.orientation, &motion.rotation);
            body.angles.commit(wrapped);
        }
        for pair in &mut self.pairs {
            let motion = relative(system, state, &pair.markers);
            pair.angle.commit(about_z(&motion));
        }
    }

    /// Counted angles and the orientations that they are counted from, for a checkpoint.
    pub fn save(&self) -> Vec<f64> {
        let mut numbers = Vec::new();
        for body in &self.bodies {
            numbers.extend([body.start.w, body.start.i, body.start.j, body.start.k]);
            body.angles.save(&mut numbers);
        }
        self.pairs
            .iter()
            .for_each(|pair| pair.angle.save(&mut numbers));
        numbers
    }

    /// Takes what [`Self::save`] gave.
    pub fn restore(&mut self, mut numbers: &[f64]) {
        for body in &mut self.bodies {
            if let Some(([w, i, j, k], rest)) = numbers.split_first_chunk() {
                let start = nalgebra::Quaternion::new(*w, *i, *j, *k);
                body.start = UnitQuaternion::new_unchecked(start);
                numbers = rest;
            }
            body.angles.restore(&mut numbers);
        }
        for pair in &mut self.pairs {
            pair.angle.restore(&mut numbers);
        }
    }
}

/// Moment about z of each joint of one pair of markers, by the name of its column.
pub(super) fn joint_moments(system: &System, state: &State, lambda: &[f64]) -> Vec<(String, f64)> {
    let mut first = 0;
    let mut moments = Vec::new();
    for joint in system.joints() {
        let equations = first..first + joint.equations();
        first = equations.end;
        if let ([markers], Some(lambda)) = (joint.pairs(), lambda.get(equations)) {
            let load = joint.load(0, lambda, &relative(system, state, markers));
            moments.push((
                format!("joints/{}/moment_z_Nm", plain(joint.name())),
                load[5],
            ));
        }
    }
    moments
}

fn relative(system: &System, state: &State, markers: &MarkerPair) -> RelativeMotion {
    let [a, b] = [markers.a.body, markers.b.body].map(|body| system.body_motion(state, body));
    markers.motion(&a, &b)
}

fn about_z(motion: &RelativeMotion) -> [f64; 1] {
    [motion.rotation[(1, 0)].atan2(motion.rotation[(0, 0)])]
}
