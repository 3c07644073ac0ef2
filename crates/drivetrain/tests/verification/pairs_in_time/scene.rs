//! Two gears on fixed axes, standing anywhere, with what drives and loads them; runs with a record of every step.

use std::ops::ControlFlow;

use gearmesh_drivetrain::*;
use gearmesh_dynamics::elements::{AppliedLoad, Axes, LoadKind};
use gearmesh_dynamics::{
    Joint, JointKind, Marker, Motion, Params, RunInfo, Simulation, State, System, TimeFunction,
};
use gearmesh_geometry::{Flank, GearPair};
use nalgebra::{UnitQuaternion, Vector3};

use crate::mesh_common::{WIDTH, angles, disc};

/// A pair of gears at its start. Speeds are positive in the sense of the drive (gear 1 clockwise), torques positive
/// where they press the right flanks together.
pub struct Scene<'a> {
    pub pair: &'a GearPair,
    pub width_m: f64,
    /// Speed of gear 1 at the start \[rad/s\]; gear 2's fits.
    pub speed_rad_per_s: f64,
    /// Transmission error \[m\] at the start, positive: right flanks open.
    pub te_m: f64,
    /// Its rate \[m/s\], by gear 2.
    pub te_rate_m_per_s: f64,
    /// Prescribed speed of gear 1.
    pub drive: Option<TimeFunction>,
    /// Torque \[N·m\] on gear 1.
    pub torque_1: Option<TimeFunction>,
    /// Torque \[N·m\] on gear 2.
    pub torque_2: Option<TimeFunction>,
    /// The whole scene turned and moved.
    pub turned: UnitQuaternion<f64>,
    pub moved_m: Vector3<f64>,
    /// Tilt of gear 2's axis in the scene \[rad\].
    pub tilt: Vector3<f64>,
    /// Way that gear 2's axis stands nearer to gear 1's than the pair's centre distance \[m\].
    pub nearer_m: f64,
    /// Flanks that the drive presses together and te_m is of. Left ones: the mirror image, all turns and torques of
    /// the other sign.
    pub side: Flank,
}

impl<'a> Scene<'a> {
    pub fn new(pair: &'a GearPair) -> Self {
        Self {
            pair,
            width_m: WIDTH,
            speed_rad_per_s: 0.0,
            te_m: 0.0,
            te_rate_m_per_s: 0.0,
            drive: None,
            torque_1: None,
            torque_2: None,
            turned: UnitQuaternion::identity(),
            moved_m: Vector3::zeros(),
            tilt: Vector3::zeros(),
            nearer_m: 0.0,
            side: Flank::Right,
        }
    }

    /// Gear 1 at a constant prescribed speed.
    pub fn driven_at(mut self, speed_rad_per_s: f64) -> Self {
        self.speed_rad_per_s = speed_rad_per_s;
        self.drive = Some(TimeFunction::Constant(speed_rad_per_s));
        self
    }

    pub fn loaded_by(mut self, torque_2: f64) -> Self {
        self.torque_2 = Some(TimeFunction::Constant(torque_2));
        self
    }

    /// I₂/r_b2² \[kg\]: what the line of action feels of gear 2.
    pub fn mass_2_kg(&self) -> f64 {
        let body = disc("", &self.pair.gear_2, self.width_m, (0.0, 0.0, 0.0));
        body.inertia_kg_m2[(2, 2)] / self.pair.gear_2.base_radius_m.powi(2)
    }

    pub fn system(&self, mesh: GearMesh) -> System {
        let pair = self.pair;
        let [r1, r2] = [&pair.gear_1, &pair.gear_2].map(|g| g.base_radius_m);
        let phi = angles(pair, self.side, 0.0, self.te_m);
        let hand = if self.side == Flank::Right { 1.0 } else { -1.0 };
        let speed_2 = (r1 * self.speed_rad_per_s + self.te_rate_m_per_s) / r2;
        let mut builder = System::builder();
        let mut gears = Vec::new();
        let parts = [
            ("gear 1", &pair.gear_1, 0.0, -self.speed_rad_per_s),
            (
                "gear 2",
                &pair.gear_2,
                pair.centre_distance_m - self.nearer_m,
                speed_2,
            ),
        ];
        for (i, (name, gear, x, speed)) in parts.into_iter().enumerate() {
            let tilt = [Vector3::zeros(), self.tilt][i];
            let axis = self.turned * UnitQuaternion::from_scaled_axis(tilt);
            let mut body = disc(name, gear, self.width_m, (x, phi[i], hand * speed));
            body.position_m = self.turned * body.position_m + self.moved_m;
            let housing = Marker::ground(body.position_m.into()).oriented(axis);
            body.orientation = axis * body.orientation;
            let marker = Marker::at(builder.body(body).unwrap(), [0.0; 3]);
            let bearing = format!("bearing of {name}");
            builder.joint(Joint::new(&bearing, JointKind::Revolute, housing, marker).unwrap());
            let torque = [&self.torque_1, &self.torque_2][i];
            if let Some(torque) = torque {
                // Either torque turns its gear clockwise; in the mirror image counter-clockwise.
                let direction = (Axes::World, (axis * (-hand * Vector3::z())).into());
                let load = torque.clone();
                let name = format!("torque on {name}");
                let load = AppliedLoad::new(&name, marker.body, LoadKind::Torque, direction, load);
                builder.element(load.unwrap());
            }
            if let Some(speed) = self.drive.as_ref().filter(|_| i == 0) {
                // Seen from the gear the housing turns counter-clockwise.
                let drive = JointKind::Rotation(Motion::Speed(speed.clone()));
                let [from, to] = match self.side {
                    Flank::Right => [marker, housing],
                    Flank::Left => [housing, marker],
                };
                builder.joint(Joint::new("drive", drive, from, to).unwrap());
            }
            gears.push(marker);
        }
        builder.element(MeshElement::new("mesh", [gears[0], gears[1]], mesh));
        builder.build().unwrap()
    }
}

/// Speeds of gear 1 and gear 2 about their own axes, in the sense of the drive \[rad/s\].
pub fn speeds(state: &State) -> [f64; 2] {
    [-state.velocity[5], state.velocity[11]]
}

/// Gear 2 as seen in gear 1, at rest.
pub fn pose_of(state: &State) -> Pose {
    let [r1, r2] = [0, 1].map(|i| state.orientations[i]);
    let between = state.positions_m[1] - state.positions_m[0];
    let turned = (r1.inverse() * r2).to_rotation_matrix();
    Pose::at_rest(r1.inverse() * between, *turned.matrix())
}

/// A recorded step.
#[derive(Debug, Clone, Copy)]
pub struct Sample {
    pub time_s: f64,
    /// Transmission error \[m\].
    pub te_m: f64,
    /// Normal forces \[N\] on right and left flanks.
    pub right_n: f64,
    pub left_n: f64,
    pub pairs: f64,
    /// As in [`speeds`].
    pub speeds: [f64; 2],
}

/// Runs to `end_s` and records every step.
pub fn record(system: System, params: Params, end_s: f64) -> (Vec<Sample>, RunInfo) {
    let mut run = Simulation::new(system, params).unwrap();
    let samples = record_on(&mut run, end_s);
    let info = *run.info();
    (samples, info)
}

/// The same on a run that has begun.
pub fn record_on(run: &mut Simulation, end_s: f64) -> Vec<Sample> {
    let names = run.system().channels();
    let of_element = |name: &str| names.iter().filter(|(of, _)| of == name).count();
    let counts: Vec<usize> = run.system().elements().map(of_element).collect();
    let place = |name: &str| names.iter().position(|(_, c)| c.name == name);
    let channels = [
        "transmission_error_m",
        "normal_force_right_N",
        "normal_force_left_N",
        "loaded_pairs",
    ]
    .map(place);
    let mut out = vec![0.0; names.len()];
    let mut samples = Vec::new();
    run.run(end_s, |step| {
        step.system.sample(step.to, &counts, &mut out);
        let [te_m, right_n, left_n, pairs] = channels.map(|at| at.map_or(0.0, |at| out[at]));
        samples.push(Sample {
            time_s: step.to.time_s,
            te_m,
            right_n,
            left_n,
            pairs,
            speeds: speeds(step.to),
        });
        ControlFlow::Continue(())
    })
    .unwrap();
    samples
}

/// Orders of convergence of a figure for steps that halve: log₂ of the ratios of its changes.
pub fn orders(values: &[f64]) -> Vec<f64> {
    let changes: Vec<f64> = values.windows(2).map(|two| two[1] - two[0]).collect();
    let ratios = changes.windows(2).map(|two| (two[0] / two[1]).abs());
    ratios.map(f64::log2).collect()
}

/// The order over the whole range: single ratios scatter where events fall between steps.
pub fn mean_order(values: &[f64]) -> f64 {
    let of = orders(values);
    of.iter().sum::<f64>() / of.len() as f64
}
