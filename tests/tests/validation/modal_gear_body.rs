//! A thin-rimmed gear reduced with its natural modes, under the forces of a mesh: at rest it deflects as without
//! modes, and when its rim is struck it rings at the frequencies of its own finite element model.

use gearmesh_contact::LocalContact;
use gearmesh_drivetrain::*;
use gearmesh_dynamics::{
    Body, Joint, JointKind, Marker, Motion, Params, Simulation, System, TimeFunction,
};
use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{Flank, GearDefinition, GearPair, Misalignment, involute};
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_model::ReducedGear;
use gearmesh_reduction::{ReductionOptions, Silent, reduce};
use nalgebra::{DMatrix, DVector, Matrix3, UnitQuaternion, Vector3};
use std::f64::consts::PI;
use std::ops::ControlFlow;

const GEAR: &str = r#"
name = "small"
[tooth]
teeth = 18
module_mm = 3.0
profile_shift = 0.1
face_width_mm = 12.0
[material]
young_GPa = 210.0
poisson = 0.3
density_kg_per_m3 = 7850.0
[mesh]
flank_mm = 1.5
fillet_mm = 0.6
body_mm = 4.0
axial_mm = 6.0
[reduction]
roll_stations = 5
slices = 2
[blank]
kind = "thin-rim"
bore_diameter_mm = 14.0
hub_diameter_mm = 20.0
rim_inner_diameter_mm = 38.0
web_thickness_mm = 3.0
web_offset_mm = 2.0
[modes]
count = 12
"#;

/// Two such gears, the second on +x of the first.
struct Scene {
    pair: GearPair,
    model: ReducedGear,
}

impl Scene {
    fn new() -> Self {
        let gear =
            GearDefinition::from_document(&InputDocument::new("small.toml", GEAR.to_owned()))
                .unwrap();
        let options = ReductionOptions {
            estimate_error: false,
        };
        let python = PythonEnvironment::find().unwrap();
        let (model, _) = reduce(&gear, &python, options, &Silent).unwrap();
        let tooth = gear.profile;
        let pair = GearPair::new(tooth.clone(), tooth, 54.6e-3, Misalignment::default()).unwrap();
        Self { pair, model }
    }

    fn mesh(&self, modes_2: usize) -> GearMesh {
        let teeth = ReducedTeeth::new(
            &self.pair,
            Flank::Right,
            [&self.model, &self.model],
            LocalContact::Calibrated,
            1000.0,
        )
        .unwrap();
        let kinematics = MeshKinematics::new(
            [self.pair.gear_1.clone(), self.pair.gear_2.clone()],
            [Vec::new(), Vec::new()],
            self.pair.centre_distance_m,
            *teeth.layout(),
            PathEnds::Extended,
        )
        .unwrap();
        let mesh = GearMesh::new(kinematics, Flank::Right, teeth).unwrap();
        match modes_2 {
            0 => mesh,
            count => mesh.with_modes(2, &self.model, count).unwrap(),
        }
    }

    /// Angles of both gears in the world: right flanks touch with this gap, gear 1 turned by θ from tooth 0 at the
    /// pitch point.
    fn angles(&self, theta: f64, gap_m: f64) -> [f64; 2] {
        let inv = involute::involute_function(self.pair.working_pressure_angle_rad);
        let base = self.pair.gear_1.base_radius_m;
        let at = self.pair.gear_1.base_half_angle_rad - inv;
        [at - theta, at + theta + gap_m / base + PI]
    }

    fn pose(&self, theta: f64, gap_m: f64) -> Pose {
        let [from_1, from_2] = self.angles(theta, gap_m).map(about_z);
        let to_1 = from_1.transpose();
        let centre = Vector3::new(self.pair.centre_distance_m, 0.0, 0.0);
        Pose::at_rest(to_1 * centre, to_1 * from_2)
    }
}

fn about_z(angle: f64) -> Matrix3<f64> {
    *UnitQuaternion::from_scaled_axis(Vector3::new(0.0, 0.0, angle))
        .to_rotation_matrix()
        .matrix()
}

#[test]
#[ignore = "reduces a gear with its modes, half a minute"]
fn a_real_gear_with_modes_at_rest_and_struck() {
    let scene = Scene::new();
    at_rest_it_deflects_as_without_modes(&scene);
    struck_it_rings_at_its_own_frequencies(&scene);
}

/// Ω²η = Q(η) by Newton with the mesh's own tangent; then the loads are those of the gear without modes.
fn at_rest_it_deflects_as_without_modes(scene: &Scene) {
    let omega_squared = &scene.model.modal_basis().unwrap().omega_squared;
    for count in [3, 12] {
        let (mut reduced, mut modal) = (scene.mesh(0), scene.mesh(count));
        for k in 0..12 {
            let at = scene.pose(0.06 * f64::from(k), -8e-6);
            let expected = reduced.evaluate(&at, false).unwrap().load;
            let scale = expected.fixed_rows::<3>(0).norm();
            assert!(scale > 100.0);
            let mut eta = vec![0.0; count];
            let mut off = f64::INFINITY;
            for _ in 0..20 {
                let motion = ModalMotion {
                    coordinates: [&[], &eta],
                    ..ModalMotion::default()
                };
                let load = modal.evaluate_modal(&at, &motion, true).unwrap().load;
                off = (load - expected).norm() / scale;
                let loads = modal.modal_loads();
                let residual =
                    DVector::from_fn(count, |i, _| loads.force[i] - omega_squared[i] * eta[i]);
                let matrix = DMatrix::from_fn(count, count, |i, j| {
                    let own = if i == j { omega_squared[i] } else { 0.0 };
                    own - loads.by_coordinates[i * count + j]
                });
                let step = matrix.lu().solve(&residual).unwrap();
                eta.iter_mut()
                    .zip(step.iter())
                    .for_each(|(eta, step)| *eta += step);
            }
            assert!(off < 1e-9, "{count} modes, position {k}: {off:e}");
        }
    }
}

/// Gear 2 is held at its bore, gear 1 strikes it and bounces off; each mode's own frequency to 0.1 % while both are
/// apart.
fn struck_it_rings_at_its_own_frequencies(scene: &Scene) {
    let count = 12;
    let model = &scene.model;
    let phi = scene.angles(2.0 * scene.pair.pitch_1_rad(), 1e-6);
    let mut builder = System::builder();
    let markers = [0, 1].map(|i| {
        let x = scene.pair.centre_distance_m * i as f64;
        let gear = match i {
            0 => gear_body(model).unwrap(),
            _ => modal_gear_body(model, count, 0.0).unwrap(),
        };
        let id = builder
            .body(Body {
                name: format!("gear {}", i + 1),
                position_m: Vector3::new(x, 0.0, 0.0),
                orientation: UnitQuaternion::from_scaled_axis(Vector3::new(0.0, 0.0, phi[i])),
                angular_velocity_rad_per_s: Vector3::new(0.0, 0.0, [-0.3, 0.0][i]),
                ..gear
            })
            .unwrap();
        let (marker, housing) = (Marker::at(id, [0.0; 3]), Marker::ground([x, 0.0, 0.0]));
        let kind = JointKind::Revolute;
        builder.joint(Joint::new(&format!("bearing {i}"), kind, housing, marker).unwrap());
        marker
    });
    let still = JointKind::Rotation(Motion::Speed(TimeFunction::Constant(0.0)));
    let housing = Marker::ground([scene.pair.centre_distance_m, 0.0, 0.0]);
    builder.joint(Joint::new("lock", still, housing, markers[1]).unwrap());
    builder.element(MeshElement::new("mesh", markers, scene.mesh(count)));
    let step_s = 2e-7;
    let params = Params {
        rho_infinity: 1.0,
        ..Params::fixed(step_s)
    };
    let mut run = Simulation::new(builder.build().unwrap(), params).unwrap();
    let mut rings: Vec<Vec<f64>> = vec![Vec::new(); count];
    let (mut out, mut touched) = (vec![0.0; run.system().channels().len()], false);
    run.run(4e-3, |step| {
        let count = [out.len()];
        step.system.sample(step.to, &count, &mut out);
        let loaded = out[0] > 0.0;
        touched |= loaded;
        for (ring, eta) in rings.iter_mut().zip(&step.to.modal) {
            if loaded {
                ring.clear();
            } else if touched {
                ring.push(*eta);
            }
        }
        ControlFlow::Continue(())
    })
    .unwrap();
    assert!(
        rings[0].len() > 10_000,
        "apart for {} steps only",
        rings[0].len()
    );
    let largest = |ring: &[f64]| ring.iter().fold(0.0_f64, |most, eta| most.max(eta.abs()));
    let most = rings.iter().map(|ring| largest(ring)).fold(0.0, f64::max);
    let mut struck = 0;
    for (ring, expected) in rings
        .iter()
        .zip(model.modal_basis().unwrap().frequencies_hz())
    {
        // A mode with a node where the tooth was struck stays still.
        if largest(ring) < 1e-6 * most {
            continue;
        }
        struck += 1;
        let crossings: Vec<f64> = ring
            .windows(2)
            .enumerate()
            .filter(|(_, pair)| pair[0] < 0.0 && pair[1] >= 0.0)
            .map(|(k, pair)| k as f64 - pair[0] / (pair[1] - pair[0]))
            .collect();
        let periods = (crossings.len() - 1) as f64;
        let frequency = periods / ((crossings[crossings.len() - 1] - crossings[0]) * step_s);
        assert!(
            (frequency / expected - 1.0).abs() < 1e-3,
            "{frequency} Hz, {expected} Hz"
        );
    }
    assert!(struck >= 8, "{struck} modes were struck");
}
