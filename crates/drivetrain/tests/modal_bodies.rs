//! Gear bodies with vibration modes under mesh forces.
#![allow(clippy::unwrap_used)]

mod mesh_common;

use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::sync::Arc;

use gearmesh_contact::LocalContact;
use gearmesh_drivetrain::pose::Vector6;
use gearmesh_drivetrain::*;
use gearmesh_dynamics::elements::{AppliedLoad, Axes, LoadKind};
use gearmesh_dynamics::{
    Body, Joint, JointKind, Marker, Motion, Params, Simulation, System, SystemBuilder, TimeFunction,
};
use gearmesh_geometry::microgeometry::{ReliefShape, TipRelief};
use gearmesh_geometry::{FlankSide, GearPair, Microgeometry, ToothGeometry};
use gearmesh_model::ReducedGear;
use mesh_common::modal_gear::{MODES, modal_gear};
use mesh_common::*;
use nalgebra::{DMatrix, DVector, SMatrix, UnitQuaternion, Vector3};

const COUNT: usize = MODES.len();

fn models(pair: &GearPair) -> [ReducedGear; 2] {
    [
        modal_gear("gear 1", &pair.gear_1),
        modal_gear("gear 2", &pair.gear_2),
    ]
}

/// `hybrid` on both sides, gears `reduced` (no modes) or `modal` with so many modes.
fn hybrid(
    pair: &GearPair,
    models: &[ReducedGear; 2],
    modes: [usize; 2],
    kinematics: MeshKinematics,
) -> GearMesh {
    let of = |side| {
        let local = LocalContact::WeberBanaschek;
        ReducedTeeth::new(pair, side, [&models[0], &models[1]], local, 4000.0).unwrap()
    };
    let mut mesh = GearMesh::new(kinematics, FlankSide::Right, of(FlankSide::Right))
        .unwrap()
        .with_side(FlankSide::Left, of(FlankSide::Left))
        .unwrap();
    for (gear, count) in modes.into_iter().enumerate() {
        if count > 0 {
            mesh = mesh.with_modes(gear + 1, &models[gear], count).unwrap();
        }
    }
    mesh
}

fn loaded_poses(pair: &GearPair) -> Vec<Pose> {
    [
        (FlankSide::Right, 0.02, -9e-6),
        (FlankSide::Right, 0.11, -14e-6),
        (FlankSide::Left, 0.19, -11e-6),
    ]
    .map(|(side, theta, te)| {
        let phi = angles(pair, side, theta, te);
        let (shift, tilt) = (
            Vector3::new(2e-6, -1e-6, 1e-4),
            Vector3::new(1e-4, -0.5e-4, 0.0),
        );
        let screwed = [phi[0], phi[1] + screw_rad(pair, shift[2])];
        pose(pair, screwed, shift, tilt)
    })
    .to_vec()
}

/// Modal coordinates of both gears that give way at rest: Ω²η = Q(η), by Newton with the mesh's own tangent.
fn at_rest(mesh: &mut GearMesh, pose: &Pose, modes: [usize; 2]) -> (Vec<f64>, MeshLoad) {
    let m = modes[0] + modes[1];
    let omega_squared = |i: usize| {
        let mode = if i < modes[0] { i } else { i - modes[0] };
        (TAU * MODES[mode].0).powi(2)
    };
    let mut eta = vec![0.0; m];
    for _ in 0..30 {
        let (first, second) = eta.split_at(modes[0]);
        let motion = ModalMotion {
            coordinates: [first, second],
            ..ModalMotion::default()
        };
        let load = mesh.evaluate_modal(pose, &motion, true).unwrap();
        let modal = mesh.modal_loads();
        let residual = DVector::from_fn(m, |i, _| modal.force[i] - omega_squared(i) * eta[i]);
        if residual.norm() <= 1e-13 * DVector::from_row_slice(&modal.force).norm() {
            return (eta, load);
        }
        let matrix = DMatrix::from_fn(m, m, |i, j| {
            let own = if i == j { omega_squared(i) } else { 0.0 };
            own - modal.by_coordinates[i * m + j]
        });
        let step = matrix.lu().solve(&residual).unwrap();
        eta.iter_mut()
            .zip(step.iter())
            .for_each(|(eta, step)| *eta += step);
    }
    panic!("no modal equilibrium");
}

/// At rest a `modal` gear is a `reduced` one, whatever the number of modes: the residual flexibility and what the modes give way make up
/// the whole compliance. Loads to 1e-9, those of the walking contacts included.
#[test]
fn modal_gears_at_rest_are_reduced_gears() {
    for pair in pairs() {
        let models = models(&pair);
        let mut reduced = hybrid(&pair, &models, [0, 0], kinematics(&pair));
        for modes in [[COUNT, COUNT], [3, 0], [0, 2]] {
            let mut modal = hybrid(&pair, &models, modes, kinematics(&pair));
            for at in loaded_poses(&pair) {
                let expected = reduced.evaluate(&at, false).unwrap();
                let (eta, found) = at_rest(&mut modal, &at, modes);
                let scale = expected.load.fixed_rows::<3>(0).norm();
                assert!(scale > 100.0);
                let off = (found.load - expected.load).norm() / scale;
                assert!(off < 1e-9, "{modes:?}: {off:e}");
                let strain: f64 = eta
                    .iter()
                    .enumerate()
                    .map(|(i, eta)| {
                        let mode = if i < modes[0] { i } else { i - modes[0] };
                        0.5 * (TAU * MODES[mode].0 * eta).powi(2)
                    })
                    .sum();
                assert!(
                    strain > 1e-3 * expected.power.stored_j,
                    "the modes carry a share"
                );
                let whole = found.power.stored_j + strain;
                let off = (whole / expected.power.stored_j - 1.0).abs();
                assert!(off < 1e-9, "{modes:?}: energy {off:e}");
            }
        }
    }
}

/// At rest a gauge on a `modal` gear reads what it reads on a `reduced` one, with all modes or some, by both methods.
#[test]
fn gauges_at_rest_read_as_on_reduced_gears() {
    for pair in pairs() {
        let models = models(&pair);
        let names = ["g0", "g1", "g5", "g7"];
        let mut reduced = hybrid(&pair, &models, [0, 0], kinematics(&pair));
        let part = ModalPart::Included;
        for modes in [[COUNT, COUNT], [3, 2]] {
            let mut modal = hybrid(&pair, &models, modes, kinematics(&pair));
            for at in loaded_poses(&pair) {
                reduced.evaluate(&at, false).unwrap();
                let (eta, _) = at_rest(&mut modal, &at, modes);
                for gear in [1, 2] {
                    let model = &models[gear - 1];
                    let own = match gear {
                        1 => &eta[..modes[0]],
                        _ => &eta[modes[0]..],
                    };
                    let gauges = |mesh, part| StrainGauges::new(mesh, gear, model, &names, part);
                    let expected = gauges(&reduced, part).unwrap().read(&reduced, &[]).to_vec();
                    let found = gauges(&modal, part).unwrap().read(&modal, own).to_vec();
                    let elsewhere = gauges(&modal, ModalPart::ElsewhereIncluded).unwrap();
                    let without = elsewhere.clone().read(&modal, own).to_vec();
                    for (k, (found, expected)) in found.iter().zip(&expected).enumerate() {
                        let scale = expected.method_2.abs();
                        assert!(scale > 1e-8);
                        assert!((found.method_1 - expected.method_1).abs() < 1e-9 * scale);
                        assert!((found.method_2 - expected.method_2).abs() < 1e-9 * scale);
                        assert!((found.method_2 - without[k].method_2).abs() > 1e-3 * scale);
                    }
                }
            }
        }
    }
}

/// Loads on bodies and modes are minus the gradient of the teeth's energy at any vibration.
#[test]
fn loads_on_modes_follow_from_the_energy() {
    for pair in pairs() {
        let models = models(&pair);
        let mut mesh = hybrid(&pair, &models, [COUNT, COUNT], kinematics(&pair));
        for at in loaded_poses(&pair) {
            let (mut eta, _) = at_rest(&mut mesh, &at, [COUNT, COUNT]);
            for (i, eta) in eta.iter_mut().enumerate() {
                *eta += 2e-6 * (i as f64).sin();
            }
            let mut energy = |at: &Pose, eta: &[f64]| {
                let motion = ModalMotion {
                    coordinates: [&eta[..COUNT], &eta[COUNT..]],
                    ..ModalMotion::default()
                };
                let load = mesh.evaluate_modal(at, &motion, false).unwrap();
                (
                    load.power.stored_j,
                    load.load,
                    mesh.modal_loads().force.clone(),
                )
            };
            let (_, load, force) = energy(&at, &eta);
            let scale = load.fixed_rows::<3>(0).norm();
            for (i, force) in force.iter().enumerate() {
                let h = 3e-9;
                let mut moved = eta.clone();
                moved[i] += h;
                let after = energy(&at, &moved).0;
                moved[i] -= 2.0 * h;
                let slope = (after - energy(&at, &moved).0) / (2.0 * h);
                let off = (slope + force).abs() / (0.3 * scale);
                assert!(off < 3e-6, "mode {i}: {off:e}");
            }
            for direction in 0..6 {
                let h = if direction < 3 { 1e-9 } else { 2e-8 };
                let mut step = Vector6::zeros();
                step[direction] = h;
                let after = energy(&moved(&at, &step), &eta).0;
                let slope = (after - energy(&moved(&at, &-step), &eta).0) / (2.0 * h);
                let unit = if direction < 3 { 1.0 } else { 0.05 };
                let off = (slope + load[direction]).abs() / (scale * unit);
                assert!(off < 3e-6, "direction {direction}: {off:e}");
            }
        }
    }
}

/// Tangents by place and speed of bodies and modes against central differences, with damping.
#[test]
fn modal_tangents_agree_with_differences() {
    for pair in pairs() {
        let models = models(&pair);
        let damping = Damping::StiffnessProportional {
            time_s: 5e-6,
            full_depth_m: 1e-6,
        };
        let local = LocalContact::WeberBanaschek;
        for side in [FlankSide::Right, FlankSide::Left] {
            let of = |side| {
                let teeth = ReducedTeeth::new(&pair, side, [&models[0], &models[1]], local, 4000.0)
                    .unwrap();
                Damped::new(teeth, damping, SLICES).unwrap()
            };
            let mut mesh = GearMesh::new(kinematics(&pair), side, of(side))
                .unwrap()
                .with_modes(1, &models[0], COUNT)
                .unwrap()
                .with_modes(2, &models[1], COUNT)
                .unwrap();
            let phi = angles(&pair, side, 0.11, -14e-6);
            let at = pose(
                &pair,
                phi,
                Vector3::new(2e-6, 0.0, 0.0),
                Vector3::new(1e-4, 0.0, 0.0),
            );
            let (eta, _) = at_rest(&mut mesh, &at, [COUNT, COUNT]);
            let n = 6 + 2 * COUNT;
            // Force on (pose, modes) at a change of place and of speed.
            let mut force = |place: &DVector<f64>, speed: &DVector<f64>, tangents: bool| {
                let six = |v: &DVector<f64>| Vector6::from_fn(|i, _| v[i]);
                let moved = moving(&moved(&at, &six(place)), &six(speed));
                let eta: Vec<f64> = (0..2 * COUNT).map(|i| eta[i] + place[6 + i]).collect();
                let rate: Vec<f64> = (0..2 * COUNT).map(|i| speed[6 + i]).collect();
                let motion = ModalMotion {
                    coordinates: [&eta[..COUNT], &eta[COUNT..]],
                    rates: [&rate[..COUNT], &rate[COUNT..]],
                };
                let load = mesh.evaluate_modal(&moved, &motion, tangents).unwrap();
                let modal = mesh.modal_loads();
                let value = DVector::from_fn(n, |i, _| match i {
                    0..6 => load.load[i],
                    _ => modal.force[i - 6],
                });
                let m = 2 * COUNT;
                let tangent = |pose: &SMatrix<f64, 6, 6>,
                               rows: &[Vector6],
                               columns: &[Vector6],
                               own: &[f64]| {
                    DMatrix::from_fn(n, n, |i, j| match (i < 6, j < 6) {
                        (true, true) => pose[(i, j)],
                        (false, true) => rows[i - 6][j],
                        (true, false) => columns[j - 6][i],
                        (false, false) => own[(i - 6) * m + j - 6],
                    })
                };
                let by_place = tangent(
                    &load.by_position,
                    &modal.force_by_pose,
                    &modal.load_by_coordinates,
                    &modal.by_coordinates,
                );
                let by_speed = tangent(
                    &load.by_velocity,
                    &modal.force_by_rates,
                    &modal.load_by_rates,
                    &modal.by_rates,
                );
                (value, by_place, by_speed)
            };
            let zero = DVector::zeros(n);
            let speed = DVector::from_fn(n, |i, _| 0.01 * (1.0 + 3.0 * i as f64).sin());
            let (_, by_place, by_speed) = force(&zero, &speed, true);
            for dof in 0..n {
                for (velocity, whole) in [(false, &by_place), (true, &by_speed)] {
                    let h = match (velocity, dof) {
                        (true, _) => 1e-6,
                        (false, 3..6) => 2e-9,
                        _ => 2e-10,
                    };
                    let mut at = |by: f64| {
                        let (mut place, mut speed) = (zero.clone(), speed.clone());
                        if velocity {
                            speed[dof] += by;
                        } else {
                            place[dof] += by;
                        }
                        force(&place, &speed, false).0
                    };
                    let difference = (at(h) - at(-h)) / (2.0 * h);
                    // Rows of forces, moments and modes have their own scale.
                    for rows in [0..3, 3..6, 6..n] {
                        let (first, count) = (rows.start, rows.len());
                        let column = whole.column(dof);
                        let off =
                            (difference.rows(first, count) - column.rows(first, count)).norm();
                        let beside = if dof < 6 {
                            3 * (dof / 3)..3 * (dof / 3) + 3
                        } else {
                            6..n
                        };
                        let scale = whole
                            .view((first, beside.start), (count, beside.len()))
                            .norm();
                        assert!(
                            off < 3e-3 * scale,
                            "{side:?} dof {dof} rows {first} {velocity}: {off:e} of {scale:e}"
                        );
                    }
                }
            }
        }
    }
}

fn relieved(gear: &ToothGeometry) -> Arc<dyn FlankError> {
    let span = gear.tip_roll_rad - gear.form_roll_rad;
    Arc::new(Microgeometry {
        tip_roll_rad: gear.tip_roll_rad,
        face_width_m: WIDTH,
        tip_relief: Some(TipRelief {
            amount_m: 40e-6,
            start_roll_rad: gear.form_roll_rad + 0.6 * span,
            shape: ReliefShape::Parabolic,
        }),
        ..Microgeometry::default()
    })
}

fn relieved_kinematics(pair: &GearPair) -> MeshKinematics {
    let errors = [&pair.gear_1, &pair.gear_2].map(|gear| vec![relieved(gear)]);
    kinematics_with(pair, errors, PathEnds::Extended)
}

/// Two gears on revolute joints, vibrating or not, gear 1 turning clockwise.
fn scene(
    pair: &GearPair,
    models: &[ReducedGear; 2],
    modes: [usize; 2],
    (mesh, speed_1, te_m, damping_ratio): (GearMesh, f64, f64, f64),
) -> (SystemBuilder, [Marker; 2]) {
    // Three pitches on: the teeth in mesh lie on no node of any mode.
    let theta = 3.0 * pair.pitch_1_rad();
    let phi = angles(pair, FlankSide::Right, theta, te_m);
    let ratio = pair.gear_1.base_radius_m / pair.gear_2.base_radius_m;
    let mut builder = System::builder();
    let markers = [0, 1].map(|i| {
        let speed = [-speed_1, speed_1 * ratio][i];
        let x = pair.centre_distance_m * i as f64;
        let gear = match modes[i] {
            0 => gear_body(&models[i]).unwrap(),
            count => modal_gear_body(&models[i], count, damping_ratio).unwrap(),
        };
        let body = Body {
            position_m: Vector3::new(x, 0.0, 0.0),
            orientation: UnitQuaternion::from_scaled_axis(Vector3::new(0.0, 0.0, phi[i])),
            angular_velocity_rad_per_s: Vector3::new(0.0, 0.0, speed),
            ..gear
        };
        let id = builder.body(body).unwrap();
        let marker = Marker::at(id, [0.0; 3]);
        let housing = Marker::ground([x, 0.0, 0.0]);
        let name = format!("bearing {i}");
        builder.joint(Joint::new(&name, JointKind::Revolute, housing, marker).unwrap());
        marker
    });
    builder.element(MeshElement::new("mesh", markers, mesh));
    (builder, markers)
}

fn torque(builder: &mut SystemBuilder, name: &str, on: Marker, value: f64) {
    let axis = (Axes::World, [0.0, 0.0, 1.0]);
    let load = TimeFunction::Constant(value);
    builder.element(AppliedLoad::new(name, on.body, LoadKind::Torque, axis, load).unwrap());
}

/// Frictionless, undamped modal gears keep their energy: the error of the balance falls with h² in the mean, as for rigid ones.
#[test]
fn vibrating_pairs_keep_their_energy() {
    let pair = spur_pair();
    let models = models(&pair);
    let modes = [COUNT, COUNT];
    let ratio = pair.gear_1.base_radius_m / pair.gear_2.base_radius_m;
    let run = |step_s: f64| {
        let mesh = hybrid(&pair, &models, modes, relieved_kinematics(&pair));
        let (mut builder, markers) = scene(&pair, &models, modes, (mesh, 60.0, -4e-6, 0.0));
        torque(&mut builder, "drive", markers[0], -60.0 * ratio);
        torque(&mut builder, "load", markers[1], -60.0);
        let params = Params {
            rho_infinity: 1.0,
            newton_tolerance: 1e-12,
            ..Params::fixed(step_s)
        };
        let mut run = Simulation::new(builder.build().unwrap(), params).unwrap();
        run.run(5e-3, |_| ControlFlow::Continue(())).unwrap();
        *run.info()
    };
    let infos = [4e-6, 2e-6, 1e-6, 5e-7].map(run);
    let errors = infos.map(|info| info.energy.largest_error_j);
    let order = (errors[0] / errors[3]).log2() / 3.0;
    assert!((1.6..2.4).contains(&order), "{order} {errors:?}");
    // Elastic energy of the mean load: about 3 mJ.
    assert!(errors[2] < 1e-6, "{errors:?}");
    // Wrong tangents on the modes would not break the balance, but cost iterations.
    let per_step = infos[1].iterations as f64 / infos[1].steps as f64;
    assert!(per_step < 5.0, "{per_step}");
}

/// A run with modes that is resumed repeats bit by bit.
#[test]
fn resumed_runs_with_modes_repeat() {
    for pair in pairs() {
        let models = models(&pair);
        let modes = [2, COUNT];
        let new = || {
            let mesh = hybrid(&pair, &models, modes, kinematics(&pair));
            let (mut builder, markers) = scene(&pair, &models, modes, (mesh, 60.0, -4e-6, 0.01));
            torque(&mut builder, "load", markers[1], -60.0);
            builder.build().unwrap()
        };
        let params = Params::fixed(4e-6);
        let mut whole = Simulation::new(new(), params).unwrap();
        whole.run(4e-4, |_| ControlFlow::Continue(())).unwrap();
        let checkpoint = whole.checkpoint();
        whole.run(1e-3, |_| ControlFlow::Continue(())).unwrap();
        let mut resumed = Simulation::resume(new(), params, &checkpoint).unwrap();
        resumed.run(1e-3, |_| ControlFlow::Continue(())).unwrap();
        assert_eq!(whole.state(), resumed.state());
    }
}

/// Transmission error over a mesh period at a prescribed slow speed, gears with so many modes.
fn slow_transmission_error(
    pair: &GearPair,
    models: &[ReducedGear; 2],
    modes: [usize; 2],
    speed: f64,
) -> Vec<f64> {
    let mesh = hybrid(pair, models, modes, relieved_kinematics(pair));
    let (mut builder, markers) = scene(pair, models, modes, (mesh, speed, -4e-6, 0.05));
    torque(&mut builder, "load", markers[1], -60.0);
    let motion = Motion::Speed(TimeFunction::Constant(-speed));
    let ground = Marker::ground([0.0; 3]);
    builder.joint(Joint::new("drive", JointKind::Rotation(motion), ground, markers[0]).unwrap());
    let system = builder.build().unwrap();
    let period = TAU / 30.0 / speed;
    let steps = 300;
    // Everything that vibrates is gone after a few steps: what is left follows the loads.
    let params = Params {
        rho_infinity: 0.0,
        ..Params::fixed(period / f64::from(steps))
    };
    let mut run = Simulation::new(system, params).unwrap();
    let names = run.system().channels();
    let of = |name: &str| names.iter().filter(|(element, _)| element == name).count();
    let counts: Vec<usize> = run.system().elements().map(of).collect();
    let place = names
        .iter()
        .position(|(_, c)| c.name == "transmission_error_m")
        .unwrap();
    let mut out = vec![0.0; names.len()];
    let mut found = Vec::new();
    run.run(1.5 * period, |step| {
        step.system.sample(step.to, &counts, &mut out);
        if step.to.time_s > 0.5 * period {
            found.push(out[place]);
        }
        ControlFlow::Continue(())
    })
    .unwrap();
    found
}

/// At low speed a `modal` gear is a `reduced` one: the difference in transmission error vanishes as the square of the speed.
#[test]
fn slow_modal_gears_are_reduced_gears() {
    let pair = spur_pair();
    let models = models(&pair);
    let worst = |speed: f64| {
        let [reduced, modal] = [[0, 0], [COUNT, COUNT]]
            .map(|modes| slow_transmission_error(&pair, &models, modes, speed));
        let pairs = reduced.iter().zip(&modal);
        let (low, high) = reduced
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| {
                (l.min(*x), h.max(*x))
            });
        assert!(high - low > 0.5e-6, "{low} {high}");
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / (high - low)
    };
    let found = [4.0, 2.0, 1.0].map(worst);
    assert!(found[2] < 1e-4, "{found:?}");
    for pair in found.windows(2) {
        assert!((3.0..5.0).contains(&(pair[0] / pair[1])), "{found:?}");
    }
}

/// Gear 2 is held at its bore and struck by a tooth of gear 1, which bounces off: all modes ring at the frequencies of the model, 0.1 %.
#[test]
fn a_struck_gear_rings_at_its_own_frequencies() {
    let pair = spur_pair();
    let models = models(&pair);
    let mesh = hybrid(&pair, &models, [0, COUNT], kinematics(&pair));
    let (mut builder, [_, gear_2]) = scene(&pair, &models, [0, COUNT], (mesh, 0.0, 1e-6, 0.0));
    let housing = Marker::ground([pair.centre_distance_m, 0.0, 0.0]);
    builder.joint(
        Joint::new(
            "lock",
            JointKind::Rotation(Motion::Speed(TimeFunction::Constant(0.0))),
            housing,
            gear_2,
        )
        .unwrap(),
    );
    let system = builder.build().unwrap();
    let mut start = system.start().clone();
    // Gear 1 turns against the right flanks of gear 2.
    start.velocity[5] = -0.3;
    let step_s = 1e-6;
    let params = Params {
        rho_infinity: 1.0,
        ..Params::fixed(step_s)
    };
    let mut run = Simulation::from_state(system, start, params).unwrap();
    let mut rings: Vec<Vec<f64>> = vec![Vec::new(); COUNT];
    let (mut touched, mut free_from) = (false, f64::NAN);
    let mut forces = vec![0.0; 4];
    // Before gear 1 has crossed the backlash and strikes again.
    run.run(13e-3, |step| {
        step.system.sample(step.to, &[4], &mut forces);
        let loaded = forces[0] + forces[1] > 0.0;
        touched |= loaded;
        if loaded {
            free_from = step.to.time_s;
            rings.iter_mut().for_each(Vec::clear);
        } else if touched {
            for (ring, eta) in rings.iter_mut().zip(&step.to.modal) {
                ring.push(*eta);
            }
        }
        ControlFlow::Continue(())
    })
    .unwrap();
    assert!(touched && free_from < 3e-3, "free from {free_from}");
    for (mode, ring) in rings.iter().enumerate() {
        let crossings: Vec<f64> = ring
            .windows(2)
            .enumerate()
            .filter(|(_, pair)| pair[0] < 0.0 && pair[1] >= 0.0)
            .map(|(k, pair)| k as f64 - pair[0] / (pair[1] - pair[0]))
            .collect();
        let (first, last) = (crossings[0], crossings[crossings.len() - 1]);
        let periods = (crossings.len() - 1) as f64;
        let frequency = periods / ((last - first) * step_s);
        let expected = MODES[mode].0;
        assert!(
            (frequency / expected - 1.0).abs() < 1e-3,
            "mode {mode}: {frequency} Hz, {expected} Hz"
        );
        let largest = ring.iter().fold(0.0_f64, |most, eta| most.max(eta.abs()));
        assert!(largest > 1e-9, "mode {mode} was not struck: {largest:e}");
    }
}

#[test]
fn modes_that_cannot_be_used_are_refused() {
    let pair = spur_pair();
    let models = models(&pair);
    let with = |mesh: GearMesh, count| mesh.with_modes(2, &models[1], count);
    let springs = mesh("analytic", &pair, kinematics(&pair));
    let message = with(springs, 2).err().unwrap().to_string();
    assert!(message.contains("hybrid"), "{message}");
    let new = || hybrid(&pair, &models, [0, 0], kinematics(&pair));
    let message = with(new(), COUNT + 1).err().unwrap().to_string();
    assert!(message.contains("7 are needed"), "{message}");
    let done = with(new(), 2).unwrap();
    assert!(
        done.with_side(FlankSide::Left, reduced_teeth(&pair, FlankSide::Left))
            .is_err()
    );
    let plain = made_up_gear(&pair.gear_2);
    assert!(new().with_modes(2, &plain, 1).is_err());
    assert!(modal_gear_body(&models[0], 2, -0.1).is_err());
    assert_eq!(modes_up_to(&models[0], 4199.0).unwrap(), 3);
    let message = modes_up_to(&models[0], 7000.0).err().unwrap().to_string();
    assert!(message.contains("6000"), "{message}");
}
