//! Forces of helical meshes: energy, axial force, the static contact, the spur limit.

use crate::mesh_common::running_pair::calibrated_gear;
use crate::mesh_common::*;
use gearmesh_contact::Drive;
use gearmesh_contact::{ContactLines, ContactOptions, LocalContact, StaticContact};
use gearmesh_drivetrain::pose::Vector6;
use gearmesh_drivetrain::*;
use gearmesh_geometry::{Flank, GearPair, Microgeometry};
use nalgebra::Vector3;

const ENDS: [PathEnds; 2] = [PathEnds::LineOfAction, PathEnds::Extended];

/// The right side of a pair of calibrated gears with a local contact.
fn reduced(pair: &GearPair, local: LocalContact) -> ReducedTeeth {
    let models = [&pair.gear_1, &pair.gear_2].map(calibrated_gear);
    let side = Flank::Right;
    ReducedTeeth::new(pair, side, [&models[0], &models[1]], local, 4000.0).unwrap()
}

/// Models with an energy by name, `hybrid` with each local contact.
fn elastic(name: &str, pair: &GearPair) -> Box<dyn TeethModel> {
    match name {
        "impact" => {
            let law = PowerStiffness::n_per_mm_e(2e6, 1.5).unwrap();
            Box::new(Impact::new(law, 0.0, 5e-6, SLICES).unwrap())
        }
        "none" => Box::new(reduced(pair, LocalContact::None)),
        "weber-banaschek" if pair.has_ring() => Box::new(reduced_teeth(pair, Flank::Right)),
        "weber-banaschek" => Box::new(reduced(pair, LocalContact::WeberBanaschek)),
        "calibrated" => Box::new(reduced(pair, LocalContact::Calibrated)),
        other => model(other, pair, Flank::Right),
    }
}

const ELASTIC: [&str; 6] = [
    "impact",
    "iso6336",
    "analytic",
    "none",
    "weber-banaschek",
    "calibrated",
];

fn right(pair: &GearPair, ends: PathEnds, model: Box<dyn TeethModel>) -> GearMesh {
    let kinematics = kinematics_with(pair, [Vec::new(), Vec::new()], ends);
    GearMesh::new(kinematics, Flank::Right, model).unwrap()
}

/// A pose somewhere in the mesh cycle, displaced in all directions and tilted by so much.
fn random_pose(pair: &GearPair, number: usize, tilt_rad: f64) -> Pose {
    let mut random = fastrand::Rng::with_seed(number as u64);
    let mut value = || 2.0 * random.f64() - 1.0;
    let theta = 0.2 * value();
    let phi = angles(pair, Flank::Right, theta, -12e-6 - 4e-6 * value());
    let shift = Vector3::new(3e-6 * value(), 3e-6 * value(), 5e-5 * value());
    let tilt = tilt_rad * Vector3::new(value(), value(), 0.0);
    // The axial displacement alone would open or close the flanks by 15 µm.
    pose(
        pair,
        [phi[0], phi[1] + screw_rad(pair, shift[2])],
        shift,
        tilt,
    )
}

/// The load is minus the gradient of the energy, at both ends of the path: what the walking of the contacts and the
/// shrinking of the slices at the ends store is felt as force.
#[test]
fn loads_follow_from_the_energy() {
    let external = helical_pair(17.0);
    let of_external = ELASTIC.map(|name| (&external, name));
    // The other models do not take rings.
    let rings = [ring_pair(15.0, false), ring_pair(-15.0, true)];
    let of_rings = ["impact", "weber-banaschek"];
    let with_rings = rings
        .iter()
        .flat_map(|pair| of_rings.map(|name| (pair, name)));
    for (pair, name) in of_external.into_iter().chain(with_rings) {
        for ends in ENDS {
            let mut mesh = right(pair, ends, elastic(name, pair));
            let (mut partly, mut worst) = (0, 0.0_f64);
            for number in 0..12 {
                let at = random_pose(pair, number, 1e-4);
                let load = mesh.evaluate(&at, false).unwrap();
                let scale = load.load.fixed_rows::<3>(0).norm();
                assert!(scale > 100.0, "{name} {number}: {scale}");
                let (found, forces) = mesh.side(Flank::Right).unwrap();
                let loaded = found.contacts.iter().zip(forces).filter(|(_, f)| **f > 0.0);
                let whole = found.along_teeth.share - 1e-9;
                partly += loaded
                    .filter(|(contact, _)| found.section(contact).share < whole)
                    .count();
                for direction in 0..6 {
                    let h = if direction < 3 { 1e-9 } else { 2e-8 };
                    let mut step = Vector6::zeros();
                    step[direction] = h;
                    let mut energy = |at: &Pose| mesh.evaluate(at, false).unwrap().power.stored_j;
                    let slope =
                        (energy(&moved(&at, &step)) - energy(&moved(&at, &-step))) / (2.0 * h);
                    let unit = if direction < 3 { 1.0 } else { 0.05 };
                    let off = (slope + load.load[direction]).abs() / (scale * unit);
                    worst = worst.max(off);
                    assert!(
                        off < 5e-6,
                        "{name} {ends:?} {number} by {direction}: {off:e}"
                    );
                }
            }
            println!("{name} {ends:?} {worst:e} {partly}");
            assert_eq!(
                partly > 5,
                ends == PathEnds::LineOfAction && name != "iso6336"
            );
        }
    }
}

/// On parallel axes: F_axial = F_t tan β_b towards the side that the hand says, torques in the ratio of the base radii,
/// however the slices share the load, up to what the walking of the contacts adds.
#[test]
fn torques_and_axial_force_balance() {
    for helix_deg in [12.0, -30.0] {
        let pair = helical_pair(helix_deg);
        let [r1, r2] = [&pair.gear_1, &pair.gear_2].map(|gear| gear.base_radius_m);
        let (sin, cos) = pair.base_helix_angle_rad().sin_cos();
        for side in [Flank::Right, Flank::Left] {
            let pair = pair.clone().on_flanks(side);
            for name in MODELS {
                let mut mesh =
                    GearMesh::new(kinematics(&pair), side, model(name, &pair, side)).unwrap();
                for k in 0..25 {
                    let phi = angles(&pair, side, 0.011 * f64::from(k), -10e-6);
                    let at = pose(&pair, phi, Vector3::zeros(), Vector3::zeros());
                    let load = mesh.evaluate(&at, false).unwrap().load;
                    let (found, forces) = mesh.side(side).unwrap();
                    let (mut walking, mut normal, mut all) =
                        (Vector6::zeros(), 0.0, Vector6::zeros());
                    for (contact, force) in found.contacts.iter().zip(forces) {
                        all += *force * contact.gradient;
                        // A tip edge's force is turned by its slope.
                        if (0..2).all(|gear| found.section(contact).walks(gear)) {
                            normal += force;
                            walking += *force * contact.gradient;
                        }
                    }
                    // Right-hand gear 2 is a left-hand gear 1's mate: pushed to +z by right flanks of a right-hand
                    // gear 1.
                    let sigma = side.mirror();
                    assert!((walking[2] - sigma * sin * normal).abs() < 1e-12 * normal);
                    assert!((walking[5] - sigma * cos * r2 * normal).abs() < 1e-12 * normal);
                    // Moment on gear 1 about its own axis.
                    let u = at.displacement_m;
                    let force: Vector3<f64> = walking.fixed_rows::<3>(0).into();
                    let on_1 = -walking[5] - u.cross(&force)[2];
                    assert!(
                        (on_1 - sigma * cos * r1 * normal).abs() < 1e-12 * normal,
                        "{name} {on_1}"
                    );
                    // The rest: compliance that changes along the path, of the order of deflection over pitch.
                    assert!((load - all).norm() < 5e-3 * normal, "{name} {load} {all}");
                }
            }
        }
    }
}

/// Same transmission error as the static contact on the rigid path, all local contacts. That one takes compliance at
/// the roll angle that gear 2 has without load and has no force from the walking of the contacts and the shrinking of
/// slices: the two differ by deflection over pitch, so that the difference falls with the square of the load.
#[test]
fn at_rest_it_is_the_static_contact() {
    let pair = helical_pair(20.0);
    let models = [&pair.gear_1, &pair.gear_2].map(calibrated_gear);
    for local in [
        LocalContact::None,
        LocalContact::WeberBanaschek,
        LocalContact::Calibrated,
    ] {
        let lines = ContactLines {
            pair: pair.clone(),
            microgeometry_1: Microgeometry::default(),
            microgeometry_2: Microgeometry::default(),
            extension: None,
            zone: gearmesh_contact::ContactZone::of_equal_faces(WIDTH),
        };
        let options = ContactOptions {
            local,
            friction: None,
        };
        let mut contact = StaticContact::new(lines, &models[0], &models[1], options).unwrap();
        let mut mesh = right(
            &pair,
            PathEnds::LineOfAction,
            Box::new(reduced(&pair, local)),
        );
        let mut differ = |torque: f64| {
            let (mut worst, mut force): (f64, f64) = (0.0, 0.0);
            for k in 0..25 {
                let theta = 0.013 * f64::from(k);
                let expected = contact.solve(theta, Drive::Torque(torque)).unwrap();
                let found = equilibrium(&mut mesh, &pair, theta, torque);
                worst = worst.max((found - expected.transmission_error_m).abs());
                let (_, forces) = mesh.side(Flank::Right).unwrap();
                let sum: f64 = forces.iter().sum();
                let normal = torque / pair.gear_2.base_radius_m / pair.base_helix_angle_rad().cos();
                force = force.max((sum / normal - 1.0).abs());
            }
            (worst, force)
        };
        let [full, tenth, hundredth] = [200.0, 20.0, 2.0].map(&mut differ);
        println!("{local:?} {full:?} {tenth:?} {hundredth:?}");
        assert!(full.0 < 5e-8 && full.1 < 5e-3, "{local:?} {full:?}");
        assert!(tenth.0 < 0.03 * full.0 && hundredth.0 < 0.03 * tenth.0);
    }
}

/// A helix of a billionth of a degree is a spur pair. On parallel axes: spur slices have the roll angle at mid-face,
/// helical ones their own.
#[test]
fn a_vanishing_helix_is_a_spur_pair() {
    let (spur, almost) = (helical_pair(0.0), helical_pair(1e-9));
    for name in MODELS {
        for ends in ENDS {
            let mut meshes = [&spur, &almost].map(|pair| {
                let mesh = right(pair, ends, model(name, pair, Flank::Right));
                mesh.with_friction(Friction::new([0.1, 0.05], [1e-3, 1e-2]).unwrap())
            });
            for number in 0..20 {
                let at = random_pose(&spur, number, 0.0);
                let at = moving(&at, &Vector6::new(0.01, 0.0, 0.0, 0.0, 0.0, 0.3));
                let [a, b] = [0, 1].map(|i| meshes[i].evaluate(&at, true).unwrap());
                let scale = a.load.norm();
                assert!((a.load - b.load).norm() < 1e-7 * scale, "{name} {number}");
                let (k, l) = (a.by_position, b.by_position);
                assert!((k - l).norm() < 1e-6 * k.norm(), "{name} {number}");
            }
        }
    }
}

/// The torque at a given transmission error runs through the changes of pairs: its largest step falls with the steps of
/// the angle, at both ends of the path, while that of a spur pair on the rigid path does not.
#[test]
fn forces_are_continuous() {
    let largest_step = |pair: &GearPair, ends: PathEnds, points: usize| {
        let mut mesh = right(pair, ends, elastic("calibrated", pair));
        let step = pair.pitch_1_rad() / points as f64;
        let torques: Vec<f64> = (0..points)
            .map(|k| torque_2(&mut mesh, pair, step * k as f64, -10e-6).0)
            .collect();
        let steps = torques.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        let mean = torques.iter().sum::<f64>() / points as f64;
        steps.fold(0.0, f64::max) / mean
    };
    let (spur, helical) = (helical_pair(0.0), helical_pair(18.0));
    for (pair, ends, least, most) in [
        (&spur, PathEnds::LineOfAction, 0.8, 1.1),
        (&spur, PathEnds::Extended, 0.0, 0.1),
        // In a corner a line begins with a slice's edge under load: the energy per width of that edge is a force along
        // the path, 1e-3 of all.
        (&helical, PathEnds::LineOfAction, 0.0, 0.2),
        (&helical, PathEnds::Extended, 0.0, 0.1),
    ] {
        let [coarse, fine] = [200, 3200].map(|points| largest_step(pair, ends, points));
        println!("{ends:?} {coarse:e} {fine:e}");
        let ratio = fine / coarse;
        assert!(
            (least..most).contains(&ratio),
            "{ends:?} {coarse:e} {fine:e}"
        );
    }
}

/// A constant c_γα of ISO 6336-1, a force over an arc of the base circle, carries T = c_γα b TE r_b2 whatever the helix
/// and the place in the mesh cycle.
#[test]
fn the_spring_of_iso_6336_is_that_of_the_transverse_plane() {
    for helix_deg in [0.0, 15.0, 31.0] {
        let pair = helical_pair(helix_deg);
        let middle = pair.working_pressure_angle_rad.tan();
        for ends in ENDS {
            let spring = MeshSpring::new(3e8, SLICES, middle).unwrap();
            let spring = spring.on_base_helix(pair.base_helix_angle_rad());
            let mut mesh = right(&pair, ends, Box::new(spring));
            for k in 0..30 {
                let torque = torque_2(&mut mesh, &pair, 0.009 * f64::from(k), -4e-6).0;
                let expected = 3e8 * 4e-6 * pair.gear_2.base_radius_m;
                assert!(
                    (torque / expected - 1.0).abs() < 1e-9,
                    "{helix_deg} {torque}"
                );
            }
        }
    }
}
