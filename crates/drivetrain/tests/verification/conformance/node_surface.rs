//! Nodes against patches, of bevel and of involute gears: the same checks as every mesh, and the force that area
//! weights tend to.

use gearmesh_drivetrain::flank_contacts::{FlankContacts, TeethLine};
use gearmesh_drivetrain::*;
use gearmesh_geometry::{Flank, GearPair};
use nalgebra::Vector3;

use crate::conformance::bevel_pair::{pair, poses};
use crate::conformance::energy::{check_energy, check_power};
use crate::conformance::two_bodies::{check_reaction, check_tangents, check_turned};
use crate::conformance::{DAMPINGS, friction, loaded_poses};
use crate::mesh_common::made_up_bevel::modal_bevel;
use crate::mesh_common::*;

/// N/mm^1.5.
const K: f64 = 1e6;

fn law(damping: f64) -> Impact {
    let stiffness = PowerStiffness::n_per_mm_e(K, 1.5).unwrap();
    Impact::new(stiffness, damping, 5e-6, 1).unwrap()
}

fn size(along_um: f64, up_um: f64) -> PatchSize {
    PatchSize {
        along_m: 1e-6 * along_um,
        up_m: 1e-6 * up_um,
    }
}

const REFERENCE: ReferenceApproach = ReferenceApproach {
    approach_m: 1e-5,
    exponent: 1.5,
};

fn involutes(
    pair: &GearPair,
    size: PatchSize,
    reference: Option<ReferenceApproach>,
) -> NodeSurfaces {
    let none = [Vec::new(), Vec::new()];
    let faces = (pair, [WIDTH; 2], &none);
    NodeSurfaces::of_involutes(kinematics(pair), faces, size, SLICES, reference).unwrap()
}

fn mesh_of(make: impl Fn() -> NodeSurfaces, law: Impact) -> GearMesh {
    let mesh = GearMesh::of_flanks(Box::new(make()), Flank::Right, law).unwrap();
    mesh.with_side(Flank::Left, law).unwrap()
}

/// Energy, power, reaction, tangents, turned scenes. A tangent leaves out what the normal turns as a foot walks over
/// a patch: of the whole flank that
/// would be δ/ρ of the stiffness, below 1e-3.
fn conforms(what: &str, make: &impl Fn() -> NodeSurfaces, poses: &[Pose]) {
    check_energy(what, &mut mesh_of(make, law(0.0)), poses);
    for (rubs, tolerance) in [(false, 2e-3), (true, 5e-3)] {
        let mut mesh = mesh_of(make, law(3e3));
        if rubs {
            mesh = mesh.with_friction(friction());
        }
        let what = format!("{what}, friction {rubs}");
        check_power(("impact", DAMPINGS[0]), &mut mesh, poses);
        check_reaction(&what, &mut mesh, poses);
        check_tangents((&what, tolerance), &mut mesh, poses);
        check_turned(&what, &mut mesh, poses);
    }
}

#[test]
fn nodes_of_involute_flanks_conform() {
    for pair in pairs() {
        let make = || involutes(&pair, size(2000.0, 200.0), Some(REFERENCE));
        conforms("involute nodes", &make, &loaded_poses(&pair));
    }
}

#[test]
fn nodes_of_bevel_flanks_conform() {
    let pair = pair("bevel_20_20.toml");
    let make = || {
        NodeSurfaces::of_bevel(pair.mesh.clone(), size(1000.0, 250.0), 8, Some(REFERENCE)).unwrap()
    };
    conforms("bevel nodes", &make, &poses(&pair, 12e-6));
}

/// Normal force of the right flanks at a pose.
fn force(mesh: &mut GearMesh, at: &Pose) -> f64 {
    mesh.evaluate(at, false).unwrap();
    mesh.side(Flank::Right).unwrap().1.iter().sum()
}

/// Force of the pair of right flanks whose deepest node is nearest to the pitch point.
fn pitch_point_force(mesh: &GearMesh, pair: &GearPair) -> f64 {
    let (found, forces) = mesh.side(Flank::Right).unwrap();
    let roll = pair.working_pressure_angle_rad.tan();
    let off = |line: &TeethLine| {
        let (first, count) = line.contacts;
        let deepest = (first..first + count)
            .min_by(|a, b| {
                found.contacts[*a]
                    .gap_m
                    .total_cmp(&found.contacts[*b].gap_m)
            })
            .unwrap();
        (found.sections[deepest].roll_rad[0] - roll).abs()
    };
    let nearest = found.lines.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
    let (first, count) = nearest.unwrap().contacts;
    forces[first..first + count].iter().sum()
}

/// A spur pair that touches at its pitch point only: with area weights the force tends to K δ_ref^e with the patches,
/// held by what a chord of gear 2's flank
/// lies in its material (h²/8ρ₂ of δ) and by the ends of the contact's width a, where the integrand goes with the
/// power 1.5. One K at each node gives
/// twice the force with twice the nodes.
#[test]
#[allow(clippy::print_stdout)]
fn area_weights_make_the_force_that_of_the_law() {
    let pair = spur_pair();
    let phi = angles(&pair, Flank::Right, 0.0, -REFERENCE.approach_m);
    let at = pose(&pair, phi, Vector3::zeros(), Vector3::zeros());
    let expected = K * (1e3 * REFERENCE.approach_m).powf(1.5);
    let radii = [&pair.gear_1, &pair.gear_2]
        .map(|gear| gear.base_radius_m * pair.working_pressure_angle_rad.tan());
    let rho = radii[0] * radii[1] / (radii[0] + radii[1]);
    let a = (2.0 * rho * REFERENCE.approach_m).sqrt();
    let mut counted = Vec::new();
    for up_um in [200.0, 100.0, 50.0, 25.0] {
        let h = 1e-6 * up_um;
        let mut weighted = mesh_of(
            || involutes(&pair, size(5000.0, up_um), Some(REFERENCE)),
            law(0.0),
        );
        force(&mut weighted, &at);
        // The pair at the pitch point, whatever else carries.
        let found = pitch_point_force(&weighted, &pair);
        let allowed = 2.0 * h * h / (8.0 * radii[1] * REFERENCE.approach_m) + (h / a).powf(2.5);
        let off = found / expected - 1.0;
        println!(
            "up {up_um} um: {found:.2} N of {expected:.2} N, {:.3} %",
            100.0 * off
        );
        assert!(
            off.abs() < allowed,
            "{up_um} um: {off:e}, allowed {allowed:e}"
        );
        let mut whole = mesh_of(|| involutes(&pair, size(5000.0, up_um), None), law(0.0));
        force(&mut whole, &at);
        counted.push(pitch_point_force(&whole, &pair));
    }
    println!("one K at each node: {counted:.0?} N");
    for two in counted.windows(2) {
        assert!((two[1] / two[0] - 2.0).abs() < 0.2, "{counted:?}");
    }
}

/// Bevel flanks that touch inside. The long contact reaches the ends of gear 2, which cut it between two columns of
/// nodes, and tips between two rows: a column or a
/// row counts or not, and this share of the force is what the next finer grid may change, with what chords leave of
/// the depth. The deepest node's gap comes to that
/// of the smooth flanks.
#[test]
#[allow(clippy::print_stdout)]
fn forces_of_bevel_nodes_converge_with_the_patches() {
    let pair = pair("bevel_20_20.toml");
    let poses = poses(&pair, 12e-6);
    let inside = |at: &&Pose| {
        let mut found = FlankContacts::default();
        Flank::ALL.iter().any(|side| {
            pair.mesh.contacts_at(at, *side, &mut found).unwrap();
            let deepest = found.deepest_overlap_m();
            let ups = found.contacts.iter().zip(&found.sections);
            let touching: Vec<_> = ups.filter(|(contact, _)| contact.gap_m < 0.0).collect();
            let clear = |up: &f64| (0.25..0.75).contains(up);
            deepest > 11e-6
                && touching.len() == 1
                && touching
                    .iter()
                    .all(|(_, section)| section.roll_rad.iter().all(clear))
        })
    };
    let at = *poses.iter().find(inside).unwrap();
    let mut last: Option<(f64, f64)> = None;
    for share in [1.0, 0.5, 0.25, 0.125] {
        let (along_um, up_um) = (800.0 * share, 200.0 * share);
        let size = size(along_um, up_um);
        let make = || NodeSurfaces::of_bevel(pair.mesh.clone(), size, 8, Some(REFERENCE)).unwrap();
        let mut mesh = mesh_of(make, law(0.0));
        mesh.evaluate(&at, false).unwrap();
        let te = mesh.transmission_error_m().unwrap();
        let mut found = 0.0;
        let (mut columns, mut rows) = (Vec::new(), Vec::new());
        for side in Flank::ALL {
            let (contacts, forces) = mesh.side(side).unwrap();
            for (contact, force) in contacts.contacts.iter().zip(forces) {
                if *force > 0.0 {
                    found += force;
                    columns.push(contact.heights_m[0].to_bits());
                    rows.push(contacts.section(contact).roll_rad[0].to_bits());
                }
            }
        }
        let counts = [&mut columns, &mut rows].map(|places| {
            places.sort_unstable();
            places.dedup();
            places.len() as f64
        });
        println!(
            "share {share}: {found:.1} N, {counts:?} columns and rows, transmission error {te:e} m"
        );
        // Chords along a face with the radius of the cutter, 44 mm, and up a flank of 10 mm at least.
        let chords_m = 1e-12 * (along_um.powi(2) / (8.0 * 44e-3) + up_um.powi(2) / (8.0 * 10e-3));
        if let Some((before, allowed)) = last {
            let change = (found - before).abs() / found;
            assert!(change < allowed, "{share}: {change} of {allowed}");
        }
        last = Some((
            found,
            1.0 / counts[0] + 1.0 / counts[1] + 1.5 * chords_m / 12e-6,
        ));
        if share == 0.125 {
            // A node lies within 0.05 mm of the deepest point across a relative radius of about 10 mm: 0.1 um.
            assert!((te + 12e-6).abs() < 0.1e-6 + chords_m, "{te:e}");
            assert!(last.unwrap().1 < 0.06, "{counts:?}");
        }
    }
}

/// Forces on the modes of both members are minus the derivatives of the contact's energy by their coordinates.
#[test]
fn nodes_move_with_the_modes() {
    let pair = pair("bevel_20_20.toml");
    let slices = BevelSlices::new(&pair.blank, &pair.design, 8).unwrap();
    let models = [0, 1].map(|member| modal_bevel(&slices, member));
    let nodes =
        NodeSurfaces::of_bevel(pair.mesh.clone(), size(1000.0, 250.0), 8, Some(REFERENCE)).unwrap();
    let mut mesh = GearMesh::of_flanks(Box::new(nodes), Flank::Right, law(0.0).on_modes()).unwrap();
    let counts = [0, 1].map(|gear: usize| models[gear].modal_basis().unwrap().count());
    for gear in 0..2 {
        mesh = mesh
            .with_modes(gear + 1, &models[gear], counts[gear])
            .unwrap();
    }
    let at = poses(&pair, 12e-6)[1];
    let start: [Vec<f64>; 2] = [0, 1].map(|gear: usize| {
        (0..counts[gear])
            .map(|mode| 1e-9 * (1.0 + mode as f64).sin())
            .collect()
    });
    let energy = |mesh: &mut GearMesh, start: &[Vec<f64>; 2]| {
        let rates: [Vec<f64>; 2] = [0, 1].map(|gear: usize| vec![0.0; counts[gear]]);
        let motion = ModalMotion {
            coordinates: [&start[0], &start[1]],
            rates: [&rates[0], &rates[1]],
        };
        mesh.evaluate_modal(&at, &motion, false)
            .unwrap()
            .power
            .stored_j
    };
    energy(&mut mesh, &start);
    let forces = mesh.modal_loads().force.clone();
    let largest = forces
        .iter()
        .fold(0.0_f64, |most, force| most.max(force.abs()));
    assert!(largest > 0.0);
    for (number, force) in forces.iter().enumerate() {
        let (gear, mode) = if number < counts[0] {
            (0, number)
        } else {
            (1, number - counts[0])
        };
        let h = 1e-10;
        let mut moved = |by: f64| {
            let mut changed = start.clone();
            changed[gear][mode] += by;
            energy(&mut mesh, &changed)
        };
        let slope = (moved(h) - moved(-h)) / (2.0 * h);
        assert!(
            (slope + force).abs() < 1e-4 * largest,
            "mode {number}: {slope}, {force}"
        );
    }
}
