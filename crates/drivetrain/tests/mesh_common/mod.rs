//! Gear pairs, meshes and motions for the tests of gear meshes.
#![allow(clippy::unwrap_used, dead_code, missing_docs, unused_imports)]

#[path = "../../../contact/tests/pair_common/mod.rs"]
pub mod pair_common;

pub use pair_common::ring_pair;

pub mod cracked_gear;
pub mod idler;
pub mod made_up_bevel;
pub mod modal_gear;
pub mod running_pair;

use gearmesh_contact::{LocalContact, SliceLayout};
use gearmesh_drivetrain::flank_contacts::FlankErrors;
use gearmesh_drivetrain::*;
use gearmesh_dynamics::Marker;
use gearmesh_geometry::{Flank, GearPair, Material, ToothGeometry, involute};
use gearmesh_model::ReducedGear;
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

pub const STEEL: Material = Material {
    young_pa: 210e9,
    poisson: 0.3,
    density_kg_per_m3: Some(7850.0),
};
pub const WIDTH: f64 = 20e-3;
pub const SLICES: usize = 5;

/// 30/41 teeth, module 3 mm.
pub fn spur_pair() -> GearPair {
    pair_common::pair(
        &pair_common::tooth(30, 0.2, 0.0),
        &pair_common::tooth(41, -0.1, 0.0),
    )
}

/// The same numbers of teeth with a helix, gear 1's hand right where the angle is positive.
pub fn helical_pair(helix_deg: f64) -> GearPair {
    let gear = |teeth, profile_shift, helix_deg: f64| {
        let tooth = gearmesh_geometry::ToothDefinition {
            helix_angle_rad: helix_deg.to_radians(),
            ..pair_common::tooth(teeth, profile_shift, 0.0)
        };
        ToothGeometry::new(&tooth).unwrap()
    };
    let (gear_1, gear_2) = (gear(30, 0.2, helix_deg), gear(41, -0.1, -helix_deg));
    let centre = gear_1.reference_radius_m + gear_2.reference_radius_m + 0.3e-3;
    GearPair::new(gear_1, gear_2, centre, Default::default()).unwrap()
}

/// Spur pairs: external gears, a planet that drives its ring, a ring that drives its planet.
pub fn spur_families() -> [GearPair; 3] {
    [spur_pair(), ring_pair(0.0, false), ring_pair(0.0, true)]
}

/// Helical pairs of both hands, external and with a ring that is driven or drives.
pub fn helical_families() -> [GearPair; 5] {
    [
        helical_pair(18.0),
        helical_pair(-18.0),
        helical_pair(33.0),
        ring_pair(15.0, false),
        ring_pair(-15.0, true),
    ]
}

/// A spur and a helical pair.
pub fn pairs() -> [GearPair; 2] {
    [spur_pair(), helical_pair(16.0)]
}

/// Turn of gear 2 \[rad\] with which helical flanks keep their distance when it moves by `shift_m` along its axis.
pub fn screw_rad(pair: &GearPair, shift_m: f64) -> f64 {
    shift_m * pair.gear_2.twist_rad_per_m()
}

/// The made-up body of the contact tests with both flanks loaded; the two do not feel each other.
pub fn made_up_gear(tooth: &ToothGeometry) -> ReducedGear {
    let one = pair_common::made_up_gear(tooth, WIDTH, SLICES);
    let block = one.grid.len() * one.grid.len();
    let mut c_hub = Vec::new();
    for load_flank in 0..2 {
        for response in one.c_hub.chunks_exact(block) {
            for response_flank in 0..2 {
                let coupled = f64::from(load_flank == response_flank);
                c_hub.extend(response.iter().map(|c| coupled * c));
            }
        }
    }
    ReducedGear {
        flanks: vec![Flank::Right, Flank::Left],
        c_hub,
        c_tooth: one.c_tooth.repeat(2),
        opposite_distance_m: one.opposite_distance_m.repeat(2),
        ..one
    }
}

/// A made-up gear on a rim that bends in waves, which flanks on all teeth and both sides feel.
pub fn on_soft_rim(mut gear: ReducedGear) -> ReducedGear {
    let (teeth, loads) = (gear.teeth, gear.grid.len());
    for (block, values) in gear.c_hub.chunks_exact_mut(loads * loads).enumerate() {
        let [load, response, response_flank] = [block / (2 * teeth), block / 2 % teeth, block % 2];
        let apart = std::f64::consts::TAU * response as f64 / teeth as f64;
        // Positive for any sum of waves, whatever sign a side has.
        let sign = if load == response_flank { 1.0 } else { -1.0 };
        let waves = (2.0 * apart).cos() + 0.5 * (3.0 * apart).cos();
        let height = |l: usize| 1.0 + 0.1 * (l / gear.grid.z_m.len()) as f64;
        for (k, value) in values.iter_mut().enumerate() {
            *value += 4e-10 * sign * waves * height(k / loads) * height(k % loads);
        }
    }
    gear
}

pub fn slice_planes() -> Vec<f64> {
    layout(SLICES).centres_m()
}

/// Slices over equal faces that do not stand displaced.
pub fn layout(slices: usize) -> SliceLayout {
    SliceLayout::new([WIDTH; 2], 0.0, slices)
}

pub fn kinematics_with(
    pair: &GearPair,
    errors: [FlankErrors; 2],
    ends: PathEnds,
) -> MeshKinematics {
    let gears = [pair.gear_1.clone(), pair.gear_2.clone()];
    MeshKinematics::new(gears, errors, pair.centre_distance_m, layout(SLICES), ends).unwrap()
}

pub fn kinematics(pair: &GearPair) -> MeshKinematics {
    kinematics_with(pair, [Vec::new(), Vec::new()], PathEnds::Extended)
}

pub fn beam_tooth(gear: usize, tooth: &ToothGeometry) -> BeamTooth<'_> {
    BeamTooth {
        gear,
        tooth,
        material: STEEL,
        face_width_m: WIDTH,
        bore_radius_m: 0.4 * tooth.root_radius_m,
    }
}

pub fn impact() -> Impact {
    let stiffness = PowerStiffness::n_per_mm_e(2e6, 1.5).unwrap();
    Impact::new(stiffness, 3e3, 5e-6, SLICES).unwrap()
}

pub fn mesh_spring(pair: &GearPair) -> MeshSpring {
    let middle = pair.working_pressure_angle_rad.tan();
    MeshSpring::new(3e8, SLICES, middle)
        .unwrap()
        .with_sine(0.2, middle, pair.gear_1.teeth)
        .unwrap()
}

/// The pair of the made-up gears at rest, over one pitch at `points` positions.
pub fn own_curve(pair: &GearPair, torque_nm: f64, points: usize) -> (PairCurve, Vec<f64>) {
    use gearmesh_contact::mesh_stiffness::MeshStiffness;
    use gearmesh_contact::{ContactLines, Drive, StaticContact};
    let models = [&pair.gear_1, &pair.gear_2].map(made_up_gear);
    let lines = ContactLines {
        pair: pair.clone(),
        microgeometry_1: Default::default(),
        microgeometry_2: Default::default(),
        extension: None,
        zone: gearmesh_contact::ContactZone::of_equal_faces(WIDTH),
    };
    let options = pair_common::FRICTIONLESS;
    let mut contact = StaticContact::new(lines, &models[0], &models[1], options).unwrap();
    let (mut te_m, mut unloaded_m, mut tangent_n_per_m) = (Vec::new(), Vec::new(), Vec::new());
    for k in 0..points {
        let theta = pair.pitch_1_rad() * k as f64 / points as f64;
        let state = contact.solve(theta, Drive::Torque(torque_nm)).unwrap();
        let stiffness = MeshStiffness::of(&state, pair.gear_2.base_radius_m);
        te_m.push(state.transmission_error_m);
        unloaded_m.push(state.unloaded_m);
        tangent_n_per_m.push(stiffness.tangent_n_per_m);
    }
    let samples = PairSamples {
        start_roll_rad: pair.working_pressure_angle_rad.tan(),
        pitches: 1,
        teeth_1: pair.gear_1.teeth,
        force_n: torque_nm / pair.gear_2.base_radius_m,
        te_m: &te_m,
        unloaded_m: &unloaded_m,
        tangent_n_per_m: &tangent_n_per_m,
    };
    (PairCurve::new(samples, 8).unwrap(), te_m)
}

/// The one spring of the mesh as the tangent to the pair's own curve.
pub fn own_spring(pair: &GearPair, side: Flank) -> MeshSpring {
    let (curve, _) = own_curve(pair, 200.0, 24);
    let slope = pair.clone().on_flanks(side).roll_slope_1_rad_per_m();
    let ahead = slice_planes().iter().map(|z| slope * z).collect();
    MeshSpring::on_curve(&curve, SLICES, pair.working_pressure_angle_rad.tan())
        .with_phase_of_mid_face(ahead)
        .on_base_helix(pair.base_helix_angle_rad())
}

pub fn beam_teeth(pair: &GearPair) -> BeamTeeth {
    let gears = [beam_tooth(1, &pair.gear_1), beam_tooth(2, &pair.gear_2)];
    BeamTeeth::new(gears, SLICES, [&[], &[]]).unwrap()
}

pub fn reduced_teeth(pair: &GearPair, side: Flank) -> ReducedTeeth {
    let models = [&pair.gear_1, &pair.gear_2].map(made_up_gear);
    let local = LocalContact::WeberBanaschek;
    ReducedTeeth::new(pair, side, [&models[0], &models[1]], local, 4000.0).unwrap()
}

/// Gear 1 with a crack in the tooth that is in mesh at angle 0.
pub fn cracked_teeth(pair: &GearPair, side: Flank) -> ReducedTeeth {
    // Gears exchanged, the crack stays with its gear.
    let models = [&pair.gear_1, &pair.gear_2].map(|gear| match gear.teeth {
        30 => cracked_gear::cracked_gear(gear, 0, 0.4),
        _ => made_up_gear(gear),
    });
    let local = LocalContact::WeberBanaschek;
    ReducedTeeth::new(pair, side, [&models[0], &models[1]], local, 4000.0).unwrap()
}

/// Teeth of gears that vibrate.
pub fn vibrating_teeth(pair: &GearPair, side: Flank) -> ReducedTeeth {
    let models = [&pair.gear_1, &pair.gear_2].map(|gear| modal_gear::modal_gear("", gear));
    let local = LocalContact::WeberBanaschek;
    ReducedTeeth::new(pair, side, [&models[0], &models[1]], local, 4000.0).unwrap()
}

/// Gives a mesh of gears that vibrate their modes; leaves others as they are.
pub fn with_own_modes(name: &str, pair: &GearPair, mesh: GearMesh) -> GearMesh {
    if name != "vibrating hybrid" {
        return mesh;
    }
    let models = [&pair.gear_1, &pair.gear_2].map(|gear| modal_gear::modal_gear("", gear));
    let count = modal_gear::MODES.len();
    let mesh = mesh.with_modes(1, &models[0], count).unwrap();
    mesh.with_modes(2, &models[1], count).unwrap()
}

/// What a model is called in messages.
pub const MODELS: [&str; 4] = ["impact", "iso6336", "analytic", "hybrid"];

/// And with a crack, and with modes.
pub const CONFORMING: [&str; 6] = [
    "impact",
    "iso6336",
    "analytic",
    "hybrid",
    "cracked hybrid",
    "vibrating hybrid",
];

pub fn model(name: &str, pair: &GearPair, side: Flank) -> Box<dyn TeethModel> {
    match name {
        "impact" => Box::new(impact()),
        "iso6336" => Box::new(mesh_spring(pair)),
        "own curve" => Box::new(own_spring(pair, side)),
        "analytic" => Box::new(beam_teeth(pair)),
        "cracked hybrid" => Box::new(cracked_teeth(pair, side)),
        "vibrating hybrid" => Box::new(vibrating_teeth(pair, side)),
        _ => Box::new(reduced_teeth(pair, side)),
    }
}

/// A mesh of the test pair with both sides of the teeth.
pub fn mesh(name: &str, pair: &GearPair, kinematics: MeshKinematics) -> GearMesh {
    let [right, left] = [Flank::Right, Flank::Left].map(|side| model(name, pair, side));
    let mesh = GearMesh::new(kinematics, Flank::Right, right)
        .unwrap()
        .with_side(Flank::Left, left)
        .unwrap();
    with_own_modes(name, pair, mesh)
}

/// Gear 1 turned by θ₁ from pair 0 at the pitch point, its flanks of `side` leading, gear 2 behind by the transmission
/// error; parallel axes at the pair's centre distance, gear 2 on +x of the world. A ring and the gear inside touch on
/// the far side of that gear.
pub fn angles(pair: &GearPair, side: Flank, theta_1: f64, te_m: f64) -> [f64; 2] {
    let alpha = pair.working_pressure_angle_rad;
    let inv = involute::involute_function(alpha);
    let [r1, r2] = [&pair.gear_1, &pair.gear_2].map(|g| g.base_radius_m);
    let at = |gear: &ToothGeometry| gear.base_half_angle_rad - gear.tip_direction() * inv;
    let theta_2 = (r1 * theta_1 + te_m) / r2;
    let sigma = [0, 1].map(|gear| pair.circles().side_of(gear, side).mirror());
    let [place_1, place_2] = match (pair.gear_1.internal, pair.gear_2.internal) {
        (false, false) => [0.0, std::f64::consts::PI],
        (false, true) => [std::f64::consts::PI; 2],
        _ => [0.0; 2],
    };
    [
        sigma[0] * (at(&pair.gear_1) - theta_1) + place_1,
        sigma[1] * (at(&pair.gear_2) + theta_2) + place_2,
    ]
}

pub fn about(axis: Vector3<f64>, angle: f64) -> Matrix3<f64> {
    *UnitQuaternion::from_scaled_axis(axis * angle)
        .to_rotation_matrix()
        .matrix()
}

/// The pose of two gears whose bodies stand at polar angles φ in the world, gear 2 displaced and tilted from its place
/// on +x.
pub fn pose(pair: &GearPair, phi: [f64; 2], shift: Vector3<f64>, tilt: Vector3<f64>) -> Pose {
    let [from_1, from_2] = phi.map(|angle| about(Vector3::z(), angle));
    let to_1 = from_1.transpose();
    let u = Vector3::new(pair.centre_distance_m, 0.0, 0.0) + shift;
    Pose::at_rest(to_1 * u, to_1 * about(tilt, 1.0) * from_2)
}

/// Torque on gear 2 in its own sense of turning at a driver angle and a transmission error.
pub fn torque_2(mesh: &mut GearMesh, pair: &GearPair, theta: f64, te: f64) -> (f64, f64) {
    let phi = angles(pair, Flank::Right, theta, te);
    let at = pose(pair, phi, Vector3::zeros(), Vector3::zeros());
    let load = mesh.evaluate(&at, true).unwrap();
    let sense = pair.flank_of(1).mirror();
    (sense * load.load[5], load.by_position[(5, 5)])
}

/// The transmission error at which the mesh carries a torque: Newton with the mesh's own tangent.
pub fn equilibrium(mesh: &mut GearMesh, pair: &GearPair, theta: f64, torque: f64) -> f64 {
    let base = pair.gear_2.base_radius_m;
    let mut te = -1e-5;
    for _ in 0..40 {
        let (found, slope) = torque_2(mesh, pair, theta, te);
        let step = (found - torque) / slope * base;
        te -= if found > 0.0 { step } else { 5e-6 };
        if step.abs() < 1e-14 && found > 0.0 {
            return te;
        }
    }
    panic!("no equilibrium at {theta}");
}

/// A pose moved by an increment (δu, ϑ).
pub fn moved(pose: &Pose, increment: &pose::Vector6) -> Pose {
    let turn = Vector3::new(increment[3], increment[4], increment[5]);
    Pose {
        displacement_m: pose.displacement_m
            + Vector3::new(increment[0], increment[1], increment[2]),
        rotation: about(turn, 1.0) * pose.rotation,
        ..*pose
    }
}

/// A pose with rates.
pub fn moving(pose: &Pose, rates: &pose::Vector6) -> Pose {
    Pose {
        velocity_m_per_s: Vector3::new(rates[0], rates[1], rates[2]),
        angular_velocity_rad_per_s: Vector3::new(rates[3], rates[4], rates[5]),
        ..*pose
    }
}

/// A gear on a revolute joint: mass and inertia of a solid disc with a bore of 16 mm.
pub fn disc(
    name: &str,
    gear: &ToothGeometry,
    width_m: f64,
    (x_m, angle_rad, speed_rad_per_s): (f64, f64, f64),
) -> gearmesh_dynamics::Body {
    let blank = gearmesh_geometry::Blank::solid(8e-3);
    let inertia = GearInertia::new(gear, &blank, width_m, 7850.0).unwrap();
    let (across, polar) = (inertia.across_kg_m2, inertia.polar_kg_m2);
    gearmesh_dynamics::Body {
        position_m: Vector3::new(x_m, 0.0, 0.0),
        orientation: UnitQuaternion::from_scaled_axis(Vector3::new(0.0, 0.0, angle_rad)),
        angular_velocity_rad_per_s: Vector3::new(0.0, 0.0, speed_rad_per_s),
        ..gearmesh_dynamics::Body::rigid(name, inertia.mass_kg, [across, across, polar])
    }
}

/// Two gears on fixed axes, gear 1 turning clockwise at `speed_1` with gear 2 at its ratio, torques `torque_2` on gear
/// 2 against its motion and the balancing one on gear 1, right flanks pressed together by `-te_m`.
pub fn two_gears(
    pair: &GearPair,
    mesh: GearMesh,
    (speed_1, torque_2, te_m): (f64, f64, f64),
    width_m: f64,
) -> (gearmesh_dynamics::SystemBuilder, [Marker; 2]) {
    use gearmesh_dynamics::elements::{AppliedLoad, Axes, LoadKind};
    use gearmesh_dynamics::{Joint, JointKind, System, TimeFunction};
    let phi = angles(pair, Flank::Right, 0.0, te_m);
    let ratio = pair.gear_1.base_radius_m / pair.gear_2.base_radius_m;
    let a = pair.centre_distance_m;
    let mut builder = System::builder();
    let mut markers = Vec::new();
    for (name, gear, x, angle, speed, torque) in [
        (
            "gear 1",
            &pair.gear_1,
            0.0,
            phi[0],
            -speed_1,
            -torque_2 * ratio,
        ),
        (
            "gear 2",
            &pair.gear_2,
            a,
            phi[1],
            speed_1 * ratio,
            -torque_2,
        ),
    ] {
        let body = disc(name, gear, width_m, (x, angle, speed));
        let id = builder.body(body).unwrap();
        let marker = Marker::at(id, [0.0; 3]);
        let housing = Marker::ground([x, 0.0, 0.0]);
        let joint = Joint::new(
            &format!("bearing of {name}"),
            JointKind::Revolute,
            housing,
            marker,
        );
        builder.joint(joint.unwrap());
        if torque != 0.0 {
            let axis = (Axes::World, [0.0, 0.0, 1.0]);
            let load = TimeFunction::Constant(torque);
            let name = format!("torque on {name}");
            builder.element(AppliedLoad::new(&name, id, LoadKind::Torque, axis, load).unwrap());
        }
        markers.push(marker);
    }
    let markers = [markers[0], markers[1]];
    builder.element(MeshElement::new("mesh", markers, mesh));
    (builder, markers)
}
