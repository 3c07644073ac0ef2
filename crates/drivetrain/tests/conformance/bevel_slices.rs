//! Bevel gears in slices: the same checks as every mesh, whatever the contact is made of.

use gearmesh_bevel::{FlankSide, TcaRequest, tooth_contact};
use gearmesh_contact::slice_contact::SliceContact;
use gearmesh_contact::{HalfSpaces, LocalContact};
use gearmesh_drivetrain::flank_contacts::FlankContacts;
use gearmesh_drivetrain::pose::Vector6;
use gearmesh_drivetrain::*;
use gearmesh_dynamics::Iterate;
use gearmesh_geometry::Flank;
use gearmesh_model::ReducedGear;

use crate::bevel_pair::{AS_DESIGNED, Pair, assembly, pair, poses};
use crate::energy::{check_energy, check_power};
use crate::mesh_common::made_up_bevel::made_up_bevel;
use crate::mesh_common::*;
use crate::two_bodies::{check_reaction, check_tangents, check_turned};
use crate::{DAMPINGS, friction, rates};

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

/// Reduced gears feel where slices stand up the flank and along the teeth; so do members of unequal faces and teeth, of the other hand.
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
    // What tangents leave out, the change of the compliance, grows with the force: on these soft bodies it is 0.6 % of them, more where an error of assembly
    // presses teeth without backlash on both sides.
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

/// Iterates next to a first guess, which take from there what hardly changes, have the loads of their poses by themselves, from fewer points of flanks; far
/// ones are computed anew.
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
            assert!(off < 5e-8, "{number}, {size_m:e}: {off:e}");
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

const TORQUES: [f64; 4] = [0.1, 50.0, 100.0, 200.0];

/// What is found under torques, rigid gears.
fn loaded(pair: &Pair, count: usize, torques_nm: &[f64]) -> Vec<LoadedContact> {
    loaded_at(12, pair, count, torques_nm)
}

fn loaded_at(
    positions: usize,
    pair: &Pair,
    count: usize,
    torques_nm: &[f64],
) -> Vec<LoadedContact> {
    let flanks = slices(pair, count);
    let loaded_pair = LoadedPair {
        blank: &pair.blank,
        flanks: &flanks,
        pinion_flank: FlankSide::Concave,
        error: assembly(AS_DESIGNED),
        positions,
    };
    let contact = flanks.surface_contact([STEEL; 2]);
    loaded_pair.loaded(&contact, torques_nm).unwrap()
}

/// Without load the pair stands where the tooth contact analysis says; the pattern grows with the torque and stays off toe and heel.
#[test]
fn bevel_slices_under_load() {
    for name in ["bevel_20_20.toml", "bevel_13_35.toml"] {
        let pair = pair(name);
        let count = 41;
        let found = loaded(&pair, count, &TORQUES);
        let request = TcaRequest {
            per_pitch: 48,
            ..TcaRequest::default()
        };
        let flanks = pair.design.flanks(FlankSide::Concave);
        let expected = tooth_contact(flanks, &pair.blank, &request).unwrap();
        let lead: Vec<f64> = expected.error_rad.iter().copied().step_by(4).collect();
        let most = lead.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        // A slice's middle stands beside the contact by up to half its length, which can only open the gap, along the more curved contact of an
        // edge by a tenth of a micrometre: less with half the length.
        let pitch = std::f64::consts::TAU / pair.blank.data.teeth[0] as f64;
        let farthest = |found: &LoadedContact| {
            let off = found.positions.iter().map(|at| {
                let steps = (at.pinion_turn_rad / pitch * lead.len() as f64).round() as i64;
                let lead = lead[steps.rem_euclid(lead.len() as i64) as usize];
                (at.unloaded_rad - (lead - most)).abs()
            });
            off.fold(0.0, f64::max)
        };
        let finer = loaded(&pair, 2 * count, &TORQUES[..1]);
        let [off, less] = [farthest(&found[0]), farthest(&finer[0])];
        assert!(off < 5e-6 && less < 5e-7, "{name}: {off:e} {less:e}");
        let [light, design, heavy] = [0, 2, 3].map(|k: usize| &found[k]);
        // At the even positions: between them the corners with and without load lie at different turns.
        let spread = |error: fn(&LoadedPosition) -> f64| {
            let errors = || light.positions.iter().map(error);
            errors().fold(f64::MIN, f64::max) - errors().fold(f64::MAX, f64::min)
        };
        assert!((spread(|p| p.error_rad) / spread(|p| p.unloaded_rad) - 1.0).abs() < 0.03);
        let size = |of: &LoadedContact| {
            let [along, up] = of.pattern(count);
            (along[1] - along[0]) * (up[1] - up[0])
        };
        assert!(
            found.windows(2).all(|w| size(&w[0]) < size(&w[1])),
            "{name}"
        );
        assert!(found.windows(2).all(|w| w[1].mean_rad() < w[0].mean_rad()));
        let [along, _] = design.pattern(count);
        assert!(along[0] > 0.05 && along[1] < 0.95, "{along:?}");
        assert!(heavy.mean_pairs() > light.mean_pairs());
        // Torques balance: the gear's is stated, forces have the lever of their place.
        let lever = pair.mesh.levers_m()[1];
        for position in &design.positions {
            let force: f64 = position.patches.iter().map(|patch| patch.force_n).sum();
            assert!((force * lever / 100.0 - 1.0).abs() < 0.12, "{force}");
        }
    }
}

/// Few even positions and those between them find the extremes of many: corners of the transmission error lie where
/// pairs of teeth take load or give it up. Both may leave a thousandth of the peak-to-peak value open, the many ones a
/// step's change beside a corner: less than a hundredth of it at 240 positions, for it changes by its whole within a pitch.
#[test]
fn events_between_positions_show_the_extremes() {
    for name in ["bevel_20_20.toml", "bevel_13_35.toml"] {
        let pair = pair(name);
        let few = &loaded_at(12, &pair, 15, &[100.0])[0];
        let many = &loaded_at(240, &pair, 15, &[100.0])[0];
        let even = |of: &LoadedContact| {
            let errors = || of.positions.iter().map(|p| p.error_rad);
            errors().fold(f64::MIN, f64::max) - errors().fold(f64::MAX, f64::min)
        };
        let [found, expected] = [few.peak_to_peak_rad(), even(many)];
        assert!(
            (found / expected - 1.0).abs() < 0.01,
            "{name}: {found:e} {expected:e}"
        );
        // What even positions miss is more than that.
        assert!(even(few) <= found && !few.between.is_empty(), "{name}");
        let turns: Vec<f64> = few
            .between
            .iter()
            .map(|p| p.pinion_turn_rad.abs())
            .collect();
        assert!(turns.is_sorted(), "{turns:?}");
    }
}

/// Slices have converged: from 41 to 82 the mean transmission error changes by less than 0.6 %, its change over the pitch by
/// less than 1 % of the mean, the mean pressure by less than 2 %, the largest one off the tips by less than 8 %.
#[test]
fn bevel_slices_converge() {
    for name in ["bevel_20_20.toml", "bevel_13_35.toml"] {
        let pair = pair(name);
        let [coarse, fine] = [41, 82].map(|count| loaded(&pair, count, &TORQUES[1..]));
        for (a, b) in coarse.iter().zip(&fine) {
            let change = |a: f64, b: f64| (a / b - 1.0).abs();
            let mean = change(a.mean_rad(), b.mean_rad());
            let spread = (a.peak_to_peak_rad() - b.peak_to_peak_rad()).abs() / b.mean_rad().abs();
            // Weighted by the force: the largest one, beside a tip, rises within a slice.
            let mean_pa = |of: &LoadedContact| {
                let sums = of.patches().fold([0.0; 2], |[p, f], patch| {
                    [p + patch.force_n * patch.pressure_pa, f + patch.force_n]
                });
                sums[0] / sums[1]
            };
            let pressure = change(mean_pa(a), mean_pa(b));
            assert!(mean < 0.006 && spread < 0.01, "{name} {}", a.torque_nm);
            assert!(pressure < 0.02, "{name} {}: {pressure}", a.torque_nm);
            let largest = [a, b].map(|of| of.pressures_pa()[1]);
            assert!(change(largest[0], largest[1]) < 0.08, "{name} {largest:?}");
        }
    }
}

/// Flanks slide as the pitch cones would that roll on each other: by the relative speed of turning times the distance
/// from the cones' common generator, taken here from the gear's side of each contact. Without friction nothing is lost,
/// twice the friction loses twice as much.
#[test]
fn bevel_flanks_slide_about_the_common_generator() {
    let pair = pair("bevel_13_35.toml");
    let found = &loaded(&pair, 15, &[100.0])[0];
    let flanks = slices(&pair, 15);
    let [pinion, gear] = &pair.blank.members;
    let side = match FlankSide::Concave.facing(pinion.hand) < 0.0 {
        true => Flank::Right,
        false => Flank::Left,
    };
    let ratio = pinion.teeth as f64 / gear.teeth as f64;
    let assembly = gearmesh_bevel::Assembly::new(&pair.blank, &assembly(AS_DESIGNED));
    let axes = assembly.members.map(|m| m.axis());
    let relative = axes[0] + axes[1] * ratio;
    let (sin, cos) = pinion.pitch_angle_rad.sin_cos();
    let generator = nalgebra::Vector3::new(sin, 0.0, cos);
    assert!((relative.normalize() - generator).norm() < 1e-12);
    let mut most = 0.0f64;
    for position in &found.positions {
        for patch in position.patches.iter().filter(|patch| !patch.on_tip) {
            let own = flanks.pair().flank_point_m(side, 1, patch.places[1]);
            let turn = -ratio * position.pinion_turn_rad - flanks.pair().azimuths_rad(side)[1]
                + std::f64::consts::TAU * patch.teeth[1] as f64 / gear.teeth as f64;
            let (s, c) = turn.sin_cos();
            let turned =
                nalgebra::Vector3::new(own.x * c - own.y * s, own.x * s + own.y * c, own.z);
            let r = assembly.members[1].axes * turned;
            let distance = (r - generator * r.dot(&generator)).norm();
            let expected = relative.norm() * distance;
            most = most.max(expected);
            // The teeth deflect by some micrometres, and slices lie beside their places on the gear.
            assert!(
                (patch.sliding_m - expected).abs() < 5e-5,
                "{patch:?} {expected}"
            );
        }
    }
    assert!(most > 1e-3, "{most}");
    assert_eq!(found.efficiency(0.0, ratio), 1.0);
    let lost = [0.05, 0.1].map(|friction| 1.0 / found.efficiency(friction, ratio) - 1.0);
    assert!(lost[0] > 1e-3 && lost[0] < 0.05, "{lost:?}");
    assert!((lost[1] / lost[0] - 2.0).abs() < 0.01, "{lost:?}");
}
