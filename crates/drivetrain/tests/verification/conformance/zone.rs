//! The contact zone: the overlap of the faces, which moves with the gears.

use std::sync::Arc;

use gearmesh_contact::{LocalContact, SliceLayout};
use gearmesh_drivetrain::flank_contacts::FlankErrors;
use gearmesh_drivetrain::pose::Vector6;
use gearmesh_drivetrain::*;
use gearmesh_geometry::{Flank, GearPair, Microgeometry};
use nalgebra::Vector3;

use crate::mesh_common::*;

/// Faces of gear 1 and gear 2 \[m\].
const WIDTHS: [f64; 2] = [20e-3, 14e-3];

/// Two gears of unequal width at an axial displacement, with crowned and slanting leads where the model feels them.
fn unequal_mesh(name: &str, pair: &GearPair, displacement_m: f64, ends: PathEnds) -> GearMesh {
    let mut layout = SliceLayout::new(WIDTHS, displacement_m, SLICES);
    let gears = [&pair.gear_1, &pair.gear_2];
    let teeth: Box<dyn TeethModel> = match name {
        "analytic" => {
            let width = layout.reference.width_m;
            let teeth = [(1, gears[0]), (2, gears[1])].map(|(number, gear)| BeamTooth {
                face_width_m: width,
                ..beam_tooth(number, gear)
            });
            Box::new(BeamTeeth::new(teeth, SLICES, [&[], &[]]).unwrap())
        }
        "hybrid" | "hybrid without local law" => {
            let made = |i: usize, slices| pair_common::made_up_gear(gears[i], WIDTHS[i], slices);
            let (one, two) = (made(0, 5), made(1, 4));
            let local = match name {
                "hybrid" => LocalContact::WeberBanaschek,
                _ => LocalContact::None,
            };
            let contact = (local, displacement_m);
            let side = Flank::Right;
            let teeth = ReducedTeeth::displaced(pair, side, [&one, &two], contact, 4000.0).unwrap();
            layout = *teeth.layout();
            Box::new(teeth)
        }
        _ => model(name, pair, Flank::Right),
    };
    let led = |i: usize, crowning_m: f64| -> FlankErrors {
        vec![Arc::new(Microgeometry {
            tip_roll_rad: gears[i].tip_roll_rad,
            face_width_m: WIDTHS[i],
            lead_crowning_m: crowning_m,
            flank_angle_m: 3e-6,
            ..Microgeometry::default()
        })]
    };
    let errors = match name {
        "iso6336" => [Vec::new(), Vec::new()],
        _ => [led(0, 5e-6), led(1, 2e-6)],
    };
    let own = [pair.gear_1.clone(), pair.gear_2.clone()];
    let a = pair.centre_distance_m;
    let kinematics = MeshKinematics::new(own, errors, a, layout, ends).unwrap();
    GearMesh::new(kinematics, Flank::Right, teeth).unwrap()
}

/// Gears displaced along their axes, tilted, a few micrometres off the reference.
fn displaced_pose(pair: &GearPair, displacement_m: f64, theta: f64) -> Pose {
    let phi = angles(pair, Flank::Right, theta, -15e-6);
    let shift = Vector3::new(2e-6, -1e-6, displacement_m + 40e-6);
    let screwed = [phi[0], phi[1] + screw_rad(pair, shift[2])];
    pose(pair, screwed, shift, Vector3::new(1e-4, -0.5e-4, 0.0))
}

/// The load is minus the gradient of the energy wherever the faces overlap: the zone's width and place, the leads below
/// it, and the screw of helical teeth are all in it.
#[test]
fn loads_follow_from_the_energy_on_faces_that_overlap_in_part() {
    let models = [
        "impact",
        "iso6336",
        "analytic",
        "hybrid",
        "hybrid without local law",
    ];
    for pair in pairs() {
        for name in models {
            for ends in [PathEnds::Extended, PathEnds::LineOfAction] {
                for displacement in [0.5e-3, 5e-3, -6e-3] {
                    let mut mesh = unequal_mesh(name, &pair, displacement, ends);
                    let at = displaced_pose(&pair, displacement, 0.11);
                    let load = mesh.evaluate(&at, false).unwrap();
                    let scale = load.load.fixed_rows::<3>(0).norm();
                    assert!(scale > 100.0, "{name} {displacement}: {scale}");
                    for direction in 0..6 {
                        let h = if direction < 3 { 1e-9 } else { 2e-8 };
                        let mut step = Vector6::zeros();
                        step[direction] = h;
                        let mut energy =
                            |at: &Pose| mesh.evaluate(at, false).unwrap().power.stored_j;
                        let change = energy(&moved(&at, &step)) - energy(&moved(&at, &-step));
                        let unit = if direction < 3 { 1.0 } else { 0.05 };
                        let off = (change / (2.0 * h) + load.load[direction]).abs();
                        assert!(
                            off < 3e-6 * scale * unit,
                            "{name} {ends:?} {displacement} by {direction}: {off:e} of {scale}"
                        );
                    }
                }
            }
        }
    }
}

/// On parallel axes the force of teeth that are pressed together evenly goes through the middle of the overlap,
/// whichever gear is the wider, and shrinks with it.
#[test]
fn the_force_stands_in_the_middle_of_the_overlap() {
    let pair = spur_pair();
    let phi = angles(&pair, Flank::Right, 0.02, -10e-6);
    let mut whole = None;
    for (displacement, low, high) in [
        (0.0, -7e-3, 7e-3),
        (2e-3, -5e-3, 9e-3),
        (5e-3, -2e-3, 10e-3),
        (-6e-3, -10e-3, 1e-3),
    ] {
        let shift = Vector3::new(0.0, 0.0, displacement);
        let at = pose(&pair, phi, shift, Vector3::zeros());
        // Slices as they are laid for gears that stand in the middle of each other.
        let layout = SliceLayout::new(WIDTHS, 0.0, SLICES);
        let own = [pair.gear_1.clone(), pair.gear_2.clone()];
        let none = [Vec::new(), Vec::new()];
        let a = pair.centre_distance_m;
        let kinematics = MeshKinematics::new(own, none, a, layout, PathEnds::Extended).unwrap();
        let mut mesh = GearMesh::new(kinematics, Flank::Right, impact()).unwrap();
        let load = mesh.evaluate(&at, false).unwrap().load;
        let force: Vector3<f64> = load.fixed_rows::<3>(0).into();
        let moment: Vector3<f64> = load.fixed_rows::<3>(3).into();
        let across = Vector3::new(force[0], force[1], 0.0);
        // Moment about gear 2's origin: z e_z × F + …
        // What the shrinking overlap pushes along the axes acts at the pitch point.
        let [r1, r2] = [pair.gear_1.base_radius_m, pair.gear_2.base_radius_m];
        let pitch_point =
            -r2 / (r1 + r2) * Vector3::new(at.displacement_m[0], at.displacement_m[1], 0.0);
        let moment = moment - pitch_point.cross(&(force[2] * Vector3::z()));
        let about = moment - moment[2] * Vector3::z();
        let height = about.dot(&Vector3::z().cross(&across)) / across.norm_squared() + displacement;
        assert!(
            (height - 0.5 * (low + high)).abs() < 1e-9,
            "{displacement}: {height}"
        );
        let whole = *whole.get_or_insert(across.norm());
        let share = across.norm() / whole;
        assert!(
            (share - (high - low) / 14e-3).abs() < 1e-6,
            "{displacement}: {share}"
        );
    }
}

/// Over a revolution of tilted gears nothing is won or lost: the loads' work is the change of the energy, which comes
/// back with every pitch. `iso6336` made 1e-4 of the energy of the teeth a pitch on helical gears while its spring went
/// from pair to pair.
#[test]
fn a_revolution_of_tilted_gears_makes_no_energy() {
    for pair in pairs() {
        for (name, tolerance) in [("iso6336", 1e-6), ("impact", 5e-4), ("analytic", 5e-4)] {
            let mut mesh = mesh(name, &pair, kinematics(&pair));
            let steps = 160 * pair.gear_1.teeth;
            let tilt = Vector3::new(3.5e-4, -2e-4, 0.0);
            let pose_at = |theta: f64| {
                let phi = angles(&pair, Flank::Right, theta, -15e-6);
                let screwed = [phi[0], phi[1] + screw_rad(&pair, 2e-4)];
                pose(&pair, screwed, Vector3::new(2e-6, 3e-6, 2e-4), tilt)
            };
            let step = std::f64::consts::TAU / steps as f64;
            let (mut work, mut most): (f64, f64) = (0.0, 0.0);
            for k in 0..steps {
                let theta = step * (k as f64 + 0.5);
                let load = mesh.evaluate(&pose_at(theta), false).unwrap();
                let h = 1e-5;
                let (before, after) = (pose_at(theta - h), pose_at(theta + h));
                let moved = (after.displacement_m - before.displacement_m) / (2.0 * h);
                let turn = after.rotation * before.rotation.transpose();
                let twice = turn - turn.transpose();
                let turned = Vector3::new(twice[(2, 1)], twice[(0, 2)], twice[(1, 0)]) / (4.0 * h);
                let force: Vector3<f64> = load.load.fixed_rows::<3>(0).into();
                let moment: Vector3<f64> = load.load.fixed_rows::<3>(3).into();
                work += step * (force.dot(&moved) + moment.dot(&turned));
                most = most.max(load.power.stored_j);
            }
            let a_pitch = work.abs() / pair.gear_1.teeth as f64;
            assert!(
                a_pitch < tolerance * most,
                "{name}: {a_pitch:e} J of {most:e} J"
            );
        }
    }
}
