//! A shaft in one bearing whose outer ring is held.

use gearmesh_bearings::dynamic::Pockets;
use gearmesh_bearings::quasi_static::{QuasiStaticBearing, Row};
use gearmesh_bearings::{BallRow, DynamicBearing, DynamicEffects, RingPose};
use gearmesh_dynamics::elements::{AppliedLoad, Axes, LoadKind};
use gearmesh_dynamics::{
    Body, BodyId, GROUND, Joint, JointKind, Marker, MarkerPair, Motion, Simulation, State, System,
    SystemBuilder, TimeFunction,
};
use nalgebra::{UnitQuaternion, Vector3};

/// The row of balls of a bearing.
pub fn row(bearing: &QuasiStaticBearing) -> &BallRow {
    match &bearing.rows[0] {
        Row::Ball(row) => row,
        _ => panic!("balls are asked for"),
    }
}

/// How the shaft is held.
pub enum Held {
    /// Free, under a force at the bearing's middle and a moment.
    Loaded([f64; 3], [f64; 3]),
    /// Turns and slides along its axis at this speed, under an axial force.
    Thrust(f64),
    /// In its place.
    Fast,
}

/// Outer ring on the ground, shaft of 0.3 kg at a pose, turning.
pub fn system(
    bearing: &QuasiStaticBearing,
    effects: DynamicEffects,
    pose: &RingPose,
    speed_rad_per_s: f64,
    held: &Held,
) -> System {
    let mut builder = System::builder();
    let shaft = shaft(&mut builder, pose, speed_rad_per_s);
    hold(&mut builder, shaft, pose, speed_rad_per_s, held);
    builder.element(element(bearing, effects, shaft));
    builder.build().unwrap()
}

pub fn shaft(builder: &mut SystemBuilder, pose: &RingPose, speed_rad_per_s: f64) -> BodyId {
    let mut shaft = Body::rigid("shaft", 0.3, [3e-4, 3e-4, 1e-4]);
    shaft.position_m = pose.centre_m;
    shaft.orientation = UnitQuaternion::rotation_between(&Vector3::z(), &pose.axis).unwrap();
    shaft.angular_velocity_rad_per_s.z = speed_rad_per_s;
    builder.body(shaft).unwrap()
}

pub fn hold(builder: &mut SystemBuilder, shaft: BodyId, pose: &RingPose, speed: f64, held: &Held) {
    let at = Marker::ground(pose.centre_m.into()).along(pose.axis.into());
    let of = Marker::at(shaft, [0.0; 3]);
    let joint = |kind| Joint::new("joint", kind, at, of).unwrap();
    let turning = JointKind::Rotation(Motion::Speed(TimeFunction::Constant(speed)));
    let load = |name: &str, kind, value: [f64; 3]| {
        let size = Vector3::from(value).norm();
        let magnitude = TimeFunction::Constant(size);
        (size > 0.0)
            .then(|| AppliedLoad::new(name, shaft, kind, (Axes::World, value), magnitude).unwrap())
    };
    let force = LoadKind::Force { point_m: [0.0; 3] };
    match held {
        Held::Loaded(force_n, moment_nm) => {
            let loads = [
                load("force", force, *force_n),
                load("moment", LoadKind::Torque, *moment_nm),
            ];
            for load in loads.into_iter().flatten() {
                builder.element(load);
            }
        }
        Held::Thrust(force_n) => {
            builder.joint(joint(JointKind::Cylindrical));
            builder.joint(Joint::new("speed", turning, at, of).unwrap());
            if let Some(load) = load("force", force, [0.0, 0.0, *force_n]) {
                builder.element(load);
            }
        }
        Held::Fast => {
            builder.joint(joint(JointKind::Revolute));
            builder.joint(Joint::new("speed", turning, at, of).unwrap());
        }
    }
}

pub fn element(
    bearing: &QuasiStaticBearing,
    effects: DynamicEffects,
    shaft: BodyId,
) -> DynamicBearing {
    let pair = MarkerPair {
        a: Marker::at(GROUND, [0.0; 3]),
        b: Marker::at(shaft, [0.0; 3]),
    };
    DynamicBearing::new("bearing", pair, bearing, effects)
        .unwrap()
        .with_ball_loads()
        .with_ball_accelerations()
}

/// A cage of 20 g on the pitch circle, turning.
pub fn cage(builder: &mut SystemBuilder, pitch_radius_m: f64, speed_rad_per_s: f64) -> BodyId {
    let polar = 0.02 * pitch_radius_m.powi(2);
    let mut cage = Body::rigid("cage", 0.02, [0.5 * polar, 0.5 * polar, polar]);
    cage.angular_velocity_rad_per_s.z = speed_rad_per_s;
    builder.body(cage).unwrap()
}

/// Pockets with 0.1 mm of play.
pub fn pockets() -> Pockets {
    Pockets {
        shape: gearmesh_bearings::dynamic::PocketShape::Cylindrical,
        clearance_m: 1e-4,
        film_stiffness_n_per_m: 100.0,
        contact_stiffness_n_per_m15: 1e8,
        rebound: gearmesh_bearings::dynamic::Rebound {
            factor_s_per_m: 1.0,
        },
        traction: None,
    }
}

/// Value of each channel of a system at a state.
pub struct Channels {
    names: Vec<String>,
    values: Vec<f64>,
}

impl Channels {
    pub fn of(system: &mut System, state: &State) -> Self {
        let channels = system.channels();
        let elements: Vec<String> = system.elements().map(str::to_owned).collect();
        let counts: Vec<usize> = elements
            .iter()
            .map(|name| channels.iter().filter(|(owner, _)| owner == name).count())
            .collect();
        let mut values = vec![0.0; channels.len()];
        system.sample(state, &counts, &mut values);
        let name = |(owner, channel): &(String, gearmesh_dynamics::Channel)| {
            format!("{owner}.{}", channel.name)
        };
        Self {
            names: channels.iter().map(name).collect(),
            values,
        }
    }

    pub fn at_end(run: Simulation) -> Self {
        let state = run.state().clone();
        Self::of(&mut run.into_system(), &state)
    }

    #[track_caller]
    pub fn get(&self, name: &str) -> f64 {
        let place = self.names.iter().position(|n| n == name);
        self.values[place.unwrap_or_else(|| panic!("no channel {name} among {:?}", self.names))]
    }
}
