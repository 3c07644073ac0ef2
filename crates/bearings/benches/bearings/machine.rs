//! Seed 000's bearing on a shaft at 6000 rpm: 18 balls of 9.525 mm on 70 mm, 15 degrees, pressed in by 500 N, 300 N of
//! radial load.

use gearmesh_bearings::bearing_file::BearingFromFile;
use gearmesh_bearings::dynamic::{
    FluidTraction, LandContact, LandFilm, LandGuide, LandSide, PocketShape, Pockets, Rebound,
    StatedContact, Traction, TriangleSize,
};
use gearmesh_bearings::quasi_static::Row;
use gearmesh_bearings::{
    AppliedBearingLoad, DynamicBearing, DynamicEffects, Operation, QuasiStaticBearing, RingPose,
    TiltCondition,
};
use gearmesh_dynamics::elements::{AppliedLoad, Axes, LoadKind};
use gearmesh_dynamics::{
    Body, BodyId, GROUND, Joint, JointKind, Marker, MarkerPair, Motion, System, SystemBuilder,
    TimeFunction,
};
use gearmesh_geometry::input::InputDocument;
use nalgebra::Vector3;

pub const BALLS: usize = 18;
pub const BALL_M: f64 = 9.525e-3;
pub const PITCH_RADIUS_M: f64 = 0.035;
pub const SPEED_RAD_PER_S: f64 = 200.0 * std::f64::consts::PI;
const PRELOAD_N: f64 = 500.0;
pub const WIDENED_M: f64 = 1e-5;
pub const RADIAL_N: f64 = 300.0;
pub const SHAFT_KG: f64 = 3.0;
pub const SHAFT_KG_M2: [f64; 3] = [5e-3, 5e-3, 1e-3];

/// A system, and which of its bodies are cages.
pub struct Machine {
    pub system: System,
    pub cages: Vec<usize>,
}

/// The bearing; preload comes from where the shaft is held.
pub const ANGULAR: &str = "angular-contact\"\ncontact_angle_deg = 15.0\n";
/// The same balls in grooves opposite each other, without clearance.
const DEEP: &str = "deep-groove\"\n";

/// The deep-groove bearing, its inner ring widened by a tight fit so that all balls carry.
pub fn fitted() -> QuasiStaticBearing {
    let mut bearing = bearing(DEEP);
    for row in &mut bearing.rows {
        if let Row::Ball(row) = row {
            row.inner.centre_radius_m += WIDENED_M;
        }
    }
    bearing
}

pub fn bearing(kind: &str) -> QuasiStaticBearing {
    let text = format!(
        "kind = \"{kind}name = \"bearing\"\nballs = {BALLS}\nball_diameter_mm = {}\npitch_diameter_mm = {}\n\
         inner_conformity = 0.52\nouter_conformity = 0.52\n",
        1e3 * BALL_M,
        2e3 * PITCH_RADIUS_M
    );
    let document = InputDocument::new("bearing.toml", text);
    let definition = BearingFromFile::from_document(&document)
        .unwrap()
        .definition;
    QuasiStaticBearing::new(&definition).unwrap()
}

fn operation() -> Operation {
    Operation {
        inner_rad_per_s: SPEED_RAD_PER_S,
        ..Operation::default()
    }
}

/// Where preload and radial load press the inner ring.
pub fn pose(bearing: &QuasiStaticBearing, preload_n: f64) -> RingPose {
    let load = AppliedBearingLoad {
        force_n: [0.0, -RADIAL_N, preload_n],
        tilt: TiltCondition::Held([0.0; 2]),
    };
    bearing.equilibrium(&load, &operation()).unwrap()
}

/// Orbit speed of the balls in equilibrium, their mean.
pub fn rolling_rad_per_s(bearing: &QuasiStaticBearing, pose: &RingPose) -> f64 {
    let (_, loads) = bearing.loads(pose, &operation()).unwrap();
    let balls = &loads.elements[0];
    balls.iter().map(|ball| ball.orbit_rad_per_s).sum::<f64>() / balls.len() as f64
}

impl Machine {
    /// Bearings with cages on one shaft that is driven, their races tori or triangles: film at the races, pockets and
    /// lands as in fe_models/spindle_6000_rpm.toml.
    pub fn spindle(bearings: usize, surface: Option<TriangleSize>) -> Self {
        let bearing = bearing(ANGULAR);
        let pose = pose(&bearing, PRELOAD_N);
        let mut builder = System::builder();
        let shaft = shaft(&mut builder, &pose, bearings as f64);
        let [seat, of] = seat(&pose, shaft);
        let turning = JointKind::Rotation(Motion::Speed(TimeFunction::Constant(SPEED_RAD_PER_S)));
        builder.joint(Joint::new("drive", turning, seat, of).unwrap());
        let rolling = rolling_rad_per_s(&bearing, &pose);
        let polar = 0.03 * PITCH_RADIUS_M.powi(2);
        let inertia = [0.5 * polar, 0.5 * polar, polar];
        let restitution = |ratio| Rebound::from_restitution(ratio, 0.1).unwrap();
        let mut cages = Vec::new();
        for place in 0..bearings {
            let at = 0.05 * place as f64;
            let mut cage = Body::rigid(&format!("cage {place}"), 0.03, inertia);
            cage.position_m.z = at;
            cage.angular_velocity_rad_per_s.z = rolling;
            let cage = builder.body(cage).unwrap();
            cages.push(1 + place);
            let land = LandGuide {
                side: LandSide::Outer,
                radius_m: 0.037,
                clearance_m: 1.4e-3,
                film: Some(LandFilm {
                    viscosity_pa_s: 0.033,
                    width_m: 5e-3,
                }),
                contact: LandContact {
                    stiffness_n_per_m15: 1e4 * 1e3_f64.powf(1.5),
                    roughness_m: 1e-5,
                    rebound: restitution(0.9),
                    friction: None,
                },
            };
            let ground = Marker::at(GROUND, [0.0, 0.0, at]);
            let guided = MarkerPair {
                a: ground,
                b: Marker::at(cage, [0.0; 3]),
            };
            builder.element(land.between(&format!("land {place}"), guided).unwrap());
            let pockets = Pockets {
                shape: PocketShape::Cylindrical,
                clearance_m: 8.64e-4,
                film_stiffness_n_per_m: 100.0,
                contact_stiffness_n_per_m15: 1e4 * 1e3_f64.powf(1.5),
                rebound: restitution(0.8),
                traction: None,
            };
            let effects = DynamicEffects {
                rebound: restitution(0.9),
                traction: Some(Traction::Fluid(FluidTraction {
                    viscosity_pa_s: 0.033,
                    pressure_viscosity_per_pa: 15e-9,
                    eyring_stress_pa: 5e6,
                    film_thickness_m: 3e-7,
                })),
                surface,
                cages: vec![(cage, pockets)],
                ..DynamicEffects::default()
            };
            let rings = MarkerPair {
                a: ground,
                b: Marker::at(shaft, [0.0, 0.0, at]),
            };
            let name = format!("bearing {place}");
            let element = DynamicBearing::new(&name, rings, &bearing, effects).unwrap();
            builder.element(element.with_ball_loads());
        }
        Self {
            system: builder.build().unwrap(),
            cages,
        }
    }

    /// What Exudyn's own bearing has too: a stated contact at both races, Coulomb friction, balls on springs to their
    /// cage. The shaft turns on.
    pub fn plain(cage_kg_m2: [f64; 3]) -> Self {
        let bearing = fitted();
        let pose = pose(&bearing, 0.0);
        let mut builder = System::builder();
        let shaft = shaft(&mut builder, &pose, 1.0);
        let mut cage = Body::rigid("cage", super::beside::CAGE_KG, cage_kg_m2);
        cage.angular_velocity_rad_per_s.z = rolling_rad_per_s(&bearing, &pose);
        let cage = builder.body(cage).unwrap();
        let pockets = Pockets {
            shape: PocketShape::Spherical,
            clearance_m: 1.0,
            film_stiffness_n_per_m: super::beside::POCKET_N_PER_M,
            contact_stiffness_n_per_m15: 0.0,
            rebound: Rebound::default(),
            traction: None,
        };
        let effects = DynamicEffects {
            contact: Some(StatedContact {
                stiffness_n_per_m_e: super::beside::CONTACT_N_PER_M15,
                exponent: 1.5,
                damping_n_s_per_m: super::beside::DAMPING_N_S_PER_M,
                full_damping_depth_m: 1e-9,
            }),
            traction: Some(
                Traction::coulomb(super::beside::FRICTION, super::beside::ZONE_M_PER_S).unwrap(),
            ),
            cages: vec![(cage, pockets)],
            ..DynamicEffects::default()
        };
        let rings = MarkerPair {
            a: Marker::at(GROUND, [0.0; 3]),
            b: Marker::at(shaft, [0.0; 3]),
        };
        let element = DynamicBearing::new("bearing", rings, &bearing, effects).unwrap();
        builder.element(element.with_ball_loads());
        Self {
            system: builder.build().unwrap(),
            cages: vec![1],
        }
    }
}

/// A shaft that moves across its axis and turns, under a radial load.
fn shaft(builder: &mut SystemBuilder, pose: &RingPose, bearings: f64) -> BodyId {
    let mut shaft = Body::rigid("shaft", SHAFT_KG, SHAFT_KG_M2);
    shaft.position_m = pose.centre_m;
    shaft.angular_velocity_rad_per_s.z = SPEED_RAD_PER_S;
    let shaft = builder.body(shaft).unwrap();
    let [seat, of] = seat(pose, shaft);
    builder.joint(Joint::new("plane", JointKind::Planar, seat, of).unwrap());
    let force = LoadKind::Force { point_m: [0.0; 3] };
    let magnitude = TimeFunction::Constant(RADIAL_N * bearings);
    let down = (Axes::World, [0.0, -1.0, 0.0]);
    builder.element(AppliedLoad::new("radial", shaft, force, down, magnitude).unwrap());
    shaft
}

fn seat(pose: &RingPose, shaft: BodyId) -> [Marker; 2] {
    let height = Vector3::new(0.0, 0.0, pose.centre_m.z);
    [Marker::ground(height.into()), Marker::at(shaft, [0.0; 3])]
}
