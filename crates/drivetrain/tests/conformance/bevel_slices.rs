//! Bevel gears in slices: the same checks as every mesh, whatever the contact is made of.

use gearmesh_bevel::FlankSide;
use gearmesh_contact::HalfSpaces;
use gearmesh_contact::slice_contact::SliceContact;
use gearmesh_drivetrain::flank_contacts::FlankContacts;
use gearmesh_drivetrain::pose::Vector6;
use gearmesh_drivetrain::*;
use gearmesh_geometry::Flank;

use crate::bevel_pair::{AS_DESIGNED, MISALIGNED, Pair, assembly, pair, poses};
use crate::energy::{check_energy, check_power};
use crate::mesh_common::*;
use crate::two_bodies::{check_reaction, check_tangents, check_turned};
use crate::{DAMPINGS, friction};

/// Slices along the teeth.
const ALONG: usize = 12;
const STEEL: (f64, f64) = (206e9, 0.3);

fn slices(pair: &Pair, count: usize) -> BevelSlices {
    BevelSlices::new(&pair.blank, &pair.design, count).unwrap()
}

/// Rigid gears whose surfaces give way.
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

/// Gaps, shares and places of slices have their gradients.
#[test]
fn derivatives_of_bevel_slices_agree_with_differences() {
    let pair = pair("bevel_20_20.toml");
    let mut flanks = slices(&pair, ALONG);
    for (number, pose) in poses(&pair, 5e-6).iter().enumerate() {
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
}

/// Pair, flanks in slices, and what is found under torques.
fn loaded(name: &str, count: usize, torques_nm: &[f64]) -> (Pair, Vec<LoadedContact>) {
    let pair = pair(name);
    let flanks = slices(&pair, count);
    let loaded_pair = LoadedPair {
        blank: &pair.blank,
        flanks: &flanks,
        pinion_flank: FlankSide::Concave,
        error: assembly(AS_DESIGNED),
        positions: 16,
    };
    let contact = flanks.surface_contact([STEEL; 2]);
    let found = loaded_pair.loaded(&contact, torques_nm).unwrap();
    (pair, found)
}

#[test]
fn explore() {
    for name in ["bevel_20_20.toml", "bevel_13_35.toml"] {
        for count in [9, 15, 31, 61] {
            let (_, found) = loaded(name, count, &[0.1, 50.0, 100.0, 200.0]);
            for c in found {
                println!(
                    "{name} {count} T {} mean {:.2} pp {:.3} unl {:.3} p {:?} shares {:.3?} pairs {:.2} tip {:.4} pattern {:.3?}",
                    c.torque_nm,
                    1e6 * c.mean_rad(),
                    1e6 * c.peak_to_peak_rad(),
                    1e6 * c.unloaded_peak_to_peak_rad(),
                    c.pressures_pa().map(|p| (p * 1e-6).round()),
                    c.load_shares(),
                    c.mean_pairs(),
                    c.tip_share(),
                    c.pattern(count)
                );
            }
        }
    }
}
