//! Bevel gears in slices: the same checks as every mesh, whatever the contact is made of.

use gearmesh_contact::slice_contact::SliceContact;
use gearmesh_contact::{HalfSpaces, LocalContact};
use gearmesh_drivetrain::flank_contacts::FlankContacts;
use gearmesh_drivetrain::pose::Vector6;
use gearmesh_drivetrain::*;
use gearmesh_dynamics::Iterate;
use gearmesh_geometry::Flank;
use gearmesh_model::ReducedGear;

use crate::conformance::bevel_pair::{Pair, assembly, pair, poses};
use crate::conformance::energy::{check_energy, check_power};
use crate::conformance::two_bodies::{check_reaction, check_tangents, check_turned};
use crate::conformance::{DAMPINGS, friction, rates};
use crate::mesh_common::made_up_bevel::made_up_bevel;
use crate::mesh_common::*;

/// Slices along the teeth.
const ALONG: usize = 12;
const STEEL: (f64, f64) = (206e9, 0.3);

fn slices(pair: &Pair, count: usize) -> BevelSlices {
    BevelSlices::new(&pair.blank, &pair.design, count).unwrap()
}

/// Rigid gears whose surfaces deflect.
fn half_spaces(flanks: &BevelSlices) -> ReducedTeeth {
    let bodies = HalfSpaces::new([STEEL; 2]);
    let layout = *flanks.layout();
    let lines = flanks.capacity() / layout.slices;
    let contact = SliceContact::of_half_spaces(layout, bodies, lines);
    ReducedTeeth::of_flanks(contact, 2000.0).unwrap()
}

fn mesh_of(flanks: &BevelSlices, teeth: impl Fn() -> Box<dyn TeethModel>) -> GearMesh {
    let mesh = GearMesh::of_flanks(Box::new(flanks.clone()), Flank::Right, teeth()).unwrap();
    mesh.with_side(Flank::Left, teeth()).unwrap()
}

#[test]
fn bevel_slices_conform() {
    let pair = pair("bevel_20_20.toml");
    let flanks = slices(&pair, ALONG);
    let poses = poses(&pair, 12e-6);
    let mut undamped = mesh_of(&flanks, || Box::new(half_spaces(&flanks)));
    check_energy("bevel slices", &mut undamped, &poses);
    for damping in DAMPINGS {
        for (rubs, tolerance) in [(false, 2e-3), (true, 5e-3)] {
            let teeth = || -> Box<dyn TeethModel> {
                Box::new(Damped::new(half_spaces(&flanks), damping, ALONG).unwrap())
            };
            let mut mesh = mesh_of(&flanks, teeth);
            if rubs {
                mesh = mesh.with_friction(friction());
            }
            let what = format!("bevel slices, {damping:?} friction {rubs}");
            check_power(("hybrid", damping), &mut mesh, &poses);
            check_reaction(&what, &mut mesh, &poses);
            check_tangents((&what, tolerance), &mut mesh, &poses);
            check_turned(&what, &mut mesh, &poses);
        }
    }
}

/// The line of contact is what its polynomials say, also where the pinion is close to undercut.
#[test]
fn lines_of_contact_are_smooth() {
    for (name, most) in [("bevel_20_20.toml", 5e-3), ("bevel_8_48.toml", 0.013)] {
        let flanks = slices(&pair(name), ALONG);
        for side in Flank::ALL {
            let misfit = flanks.line_misfit(side);
            assert!(misfit < most, "{name} {side:?}: {misfit:e}");
        }
    }
}

/// Gaps, shares and places of slices have their gradients.
#[test]
fn derivatives_of_bevel_slices_agree_with_differences() {
    // The line of 8/48 is described by other polynomials: its pinion is close to undercut.
    for (name, least) in [("bevel_20_20.toml", 1000), ("bevel_8_48.toml", 500)] {
        let compared = compare_derivatives(&pair(name));
        assert!(compared > least, "{name}: {compared}");
    }
}

/// Returns how many were compared.
fn compare_derivatives(pair: &Pair) -> usize {
    let mut flanks = slices(pair, ALONG);
    let mut compared = 0;
    for (number, pose) in poses(pair, 5e-6).iter().enumerate() {
        for side in Flank::ALL {
            flanks.locate(pose).unwrap();
            let mut here = FlankContacts::default();
            flanks.contacts(pose, side, &mut here);
            let (h, mut there) = (1e-7, [FlankContacts::default(), FlankContacts::default()]);
            for direction in 0..6 {
                let mut step = Vector6::zeros();
                step[direction] = h;
                for (sign, found) in [1.0, -1.0].into_iter().zip(&mut there) {
                    let moved = moved(pose, &(sign * step));
                    flanks.contacts_at(&moved, side, found).unwrap();
                }
                for (i, contact) in here.contacts.iter().enumerate() {
                    let teeth = here.lines[contact.line].teeth;
                    let of = |found: &FlankContacts| {
                        let line = found.lines.iter().find(|line| line.teeth == teeth)?;
                        let (first, count) = line.contacts;
                        let own = &found.contacts[first..first + count];
                        let contact = own.iter().find(|other| other.slice == contact.slice)?;
                        Some((*contact, *found.section(contact)))
                    };
                    let [Some((a, at_a)), Some((b, at_b))] = [0, 1].map(|k: usize| of(&there[k]))
                    else {
                        continue;
                    };
                    compared += 1;
                    let off = (a.gap_m - b.gap_m) / (2.0 * h) - contact.gradient[direction];
                    assert!(
                        off.abs() < 2e-7,
                        "{number} {side:?} {i} by {direction}: {off:e}"
                    );
                    let change = (a.gradient - b.gradient) / (2.0 * h);
                    let curvature = flanks.gap_curvature(&here, i, side);
                    let off = (change - curvature.column(direction)).norm() / curvature.norm();
                    assert!(off < 1e-4, "{number} {side:?} {i} by {direction}: {off:e}");
                    let section = here.section(contact);
                    let check = |what: &str, [a, b]: [f64; 2], gradient: &Vector6, scale: f64| {
                        let off = (a - b) / (2.0 * h) - gradient[direction];
                        assert!(
                            off.abs() < 1e-5 * gradient.norm().max(scale),
                            "{number} {side:?} {i} {what} by {direction}: {off:e}"
                        );
                    };
                    check(
                        "share",
                        [at_a.share, at_b.share],
                        &section.share_gradient,
                        1.0,
                    );
                    for gear in 0..2 {
                        let up = [at_a.roll_rad[gear], at_b.roll_rad[gear]];
                        check("u", up, &section.roll_gradient[gear], 1.0);
                        let along = [a.heights_m[gear], b.heights_m[gear]];
                        check("v", along, &section.along_gradient[gear], 1.0);
                    }
                    let by_u = &section.roll_gradient[0];
                    let radius = [at_a.radius_m.ln(), at_b.radius_m.ln()];
                    check("radius", radius, &(section.radius_growth[0] * by_u), 1.0);
                    let length = [at_a, at_b].map(|s| (s.length_m / s.share).ln());
                    check("length", length, &(section.length_growth[0] * by_u), 1.0);
                }
            }
        }
    }
    compared
}

/// Reduced bodies are not pressed deeper than this \[m\].
const MOST_OVERLAP_M: f64 = 60e-6;

/// Two bodies on the flanks of the pair.
fn bodies(flanks: &BevelSlices) -> [ReducedGear; 2] {
    [0, 1].map(|member| made_up_bevel(flanks, member))
}

/// Reduced gears feel where slices stand up the flank and along the teeth; so do members of unequal faces and teeth, of
/// the other hand.
#[test]
fn reduced_bevel_slices_conform() {
    for name in ["bevel_20_20.toml", "bevel_13_35.toml"] {
        check_reduced(name);
    }
}

fn check_reduced(name: &str) {
    let pair = pair(name);
    let flanks = slices(&pair, ALONG);
    let bodies = bodies(&flanks);
    let mut poses = poses(&pair, 12e-6);
    // What tangents leave out, the change of the compliance, grows with the force: on these soft bodies it is 0.6 % of
    // them, more where an error of assembly presses teeth without backlash on both sides.
    poses.retain(|pose| {
        Flank::ALL
            .iter()
            .all(|side| pair.gap_m(pose, *side) > -MOST_OVERLAP_M)
    });
    assert!(poses.len() >= 6, "{}", poses.len());
    for local in LocalContact::ALL {
        let teeth = |side: Flank| {
            let models = [&bodies[0], &bodies[1]];
            flanks.reduced_teeth(side, models, (local, 2000.0)).unwrap()
        };
        let mesh = |damping: Option<Damping>| {
            let model = |side: Flank| -> Box<dyn TeethModel> {
                match damping {
                    Some(damping) => Box::new(Damped::new(teeth(side), damping, ALONG).unwrap()),
                    None => Box::new(teeth(side)),
                }
            };
            let right = Flank::Right;
            let mesh = GearMesh::of_flanks(Box::new(flanks.clone()), right, model(right)).unwrap();
            mesh.with_side(Flank::Left, model(Flank::Left)).unwrap()
        };
        let what = format!("reduced {name}, {local:?}");
        check_energy(&what, &mut mesh(None), &poses);
        let damping = DAMPINGS[0];
        let mut mesh = mesh(Some(damping)).with_friction(friction());
        check_power(("hybrid", damping), &mut mesh, &poses);
        check_reaction(&what, &mut mesh, &poses);
        check_tangents((&what, 1e-2), &mut mesh, &poses);
        check_turned(&what, &mut mesh, &poses);
    }
}

/// Iterates next to a first guess, which take from there what hardly changes, have the loads of their poses by
/// themselves, from fewer points of flanks; far ones are computed anew.
#[test]
fn iterates_of_bevel_slices_have_the_loads_of_their_poses() {
    let pair = pair("bevel_20_20.toml");
    let flanks = slices(&pair, ALONG);
    let bodies = bodies(&flanks);
    let teeth = |side: Flank| -> Box<dyn TeethModel> {
        let models = [&bodies[0], &bodies[1]];
        let local = (LocalContact::Calibrated, 2000.0);
        let teeth = flanks.reduced_teeth(side, models, local).unwrap();
        Box::new(Damped::new(teeth, DAMPINGS[0], ALONG).unwrap())
    };
    let mesh = || {
        let right = Flank::Right;
        let mesh = GearMesh::of_flanks(Box::new(flanks.clone()), right, teeth(right)).unwrap();
        mesh.with_side(Flank::Left, teeth(Flank::Left)).unwrap()
    };
    let (mut near, mut alone) = (mesh(), mesh());
    let points = || flanks.pair().computed_points();
    let mut loaded = 0;
    for (number, pose) in poses(&pair, 12e-6).iter().enumerate() {
        let pose = moving(pose, &rates(number));
        // Small steps from one to the next, then one that is none.
        near.expect(Iterate::First);
        near.evaluate(&pose, true).unwrap();
        let mut there = pose;
        for (iterate, size_m) in [4e-7, 1e-7, 3e-8, 1e-9, 1e-13, 2e-5]
            .into_iter()
            .enumerate()
        {
            let way = rates(number + 7 * iterate).normalize();
            let lever = |i: usize| if i < 3 { 1.0 } else { 30.0 };
            let step = Vector6::from_fn(|i, _| size_m * lever(i) * way[i]);
            there = moved(&there, &step);
            near.expect(Iterate::Correction);
            let before = points();
            let found = near.evaluate(&there, true).unwrap();
            let between = points();
            let expected = alone.evaluate(&there, true).unwrap();
            let [of_near, of_alone] = [between - before, points() - between];
            let off = (found.load - expected.load).norm() / expected.load.norm().max(1.0);
            // What a step of 1e-7 m changes in second order; shares beyond the outer stations are quadratic.
            assert!(off < 1e-7, "{number}, {size_m:e}: {off:e}");
            let off = (found.by_position - expected.by_position).norm();
            let off = off / expected.by_position.norm().max(1.0);
            assert!(off < 1e-6, "{number}, {size_m:e}: tangent {off:e}");
            if size_m < 1e-6 && expected.load.norm() > 100.0 {
                loaded += 1;
                assert!(
                    10 * of_near < 7 * of_alone,
                    "{number}: {of_near} {of_alone}"
                );
            }
        }
    }
    assert!(loaded > 20, "{loaded}");
}

/// Models of other gears are refused in words.
#[test]
fn models_of_other_bevel_gears_are_refused() {
    let pair = pair("bevel_20_20.toml");
    let flanks = slices(&pair, ALONG);
    let [pinion, gear] = bodies(&flanks);
    let refused = |models: [&ReducedGear; 2]| {
        let local = LocalContact::Calibrated;
        let made = flanks.reduced_contact(Flank::Right, models, local);
        made.map(|_| ()).unwrap_err().to_string()
    };
    assert!(refused([&gear, &pinion]).contains("it is the pair's gear"));
    let mut moved = pinion.clone();
    for number in &mut moved.bevel.as_mut().unwrap().points_m {
        *number *= 1.001;
    }
    let message = refused([&moved, &gear]);
    assert!(message.contains("right flanks lie up to 0.0"), "{message}");
    let mut plain = pinion.clone();
    plain.bevel = None;
    assert!(refused([&plain, &gear]).contains("it is a cylindrical gear"));
}

/// Points of flanks that are computed at a pose under load, both sides of the teeth together.
#[test]
fn a_pose_of_bevel_slices_takes_few_points() {
    let pair = pair("bevel_20_20.toml");
    let flanks = slices(&pair, 15);
    let pitch = std::f64::consts::TAU / pair.blank.data.teeth[0] as f64;
    let error = assembly([10e-6, -20e-6, 30e-6, 1e-4]);
    let back = pair.turn_2(&error, 0.0, Flank::Left, -15e-6);
    let (poses, before) = (100, flanks.pair().computed_points());
    let mut patches = 0;
    for i in 0..poses {
        let turn = pitch * f64::from(i) / f64::from(poses);
        let pose = pair.pose(&error, [turn, back - turn]);
        for side in Flank::ALL {
            let mut found = FlankContacts::default();
            flanks.contacts_at(&pose, side, &mut found).unwrap();
            patches += found.contacts.len();
        }
    }
    let points = (flanks.pair().computed_points() - before) as f64 / f64::from(poses);
    let patches = patches as f64 / f64::from(poses);
    assert!(
        points < 5.0 * patches && points < 130.0,
        "{points} {patches}"
    );
}
