//! Helical contact on made-up bodies: the spur limit, mirror images, balance, the axial force, how contact lines run.

use crate::pair_common;

use gearmesh_contact::Drive;
use gearmesh_contact::{
    ContactLines, ContactOptions, Friction, LocalContact, PathExtension, StaticContact,
    mesh_stiffness::MeshStiffness,
};
use gearmesh_geometry::{Flank, Microgeometry};
use pair_common::{FRICTIONLESS, helical as lines, made_up_gear};

const FACE_WIDTH_M: f64 = 20e-3;

fn contact(lines: &ContactLines, options: ContactOptions, slices: usize) -> StaticContact {
    let models = [&lines.pair.gear_1, &lines.pair.gear_2].map(|gear| {
        let mut model = made_up_gear(gear, FACE_WIDTH_M, slices);
        if lines.pair.flank == Flank::Left {
            model.flanks = vec![Flank::Left];
        }
        model
    });
    StaticContact::new(lines.clone(), &models[0], &models[1], options).unwrap()
}

fn angles(lines: &ContactLines, points: usize) -> Vec<f64> {
    let step = lines.pair.pitch_1_rad() / points as f64;
    (0..points).map(|k| 0.0137 + step * k as f64).collect()
}

fn curve(lines: &ContactLines, torque: f64, slices: usize, points: usize) -> Vec<f64> {
    curve_with(lines, FRICTIONLESS, torque, slices, points)
}

fn curve_with(
    lines: &ContactLines,
    options: ContactOptions,
    torque: f64,
    slices: usize,
    points: usize,
) -> Vec<f64> {
    let mut contact = contact(lines, options, slices);
    angles(lines, points)
        .iter()
        .map(|&a| {
            let state = contact.solve(a, Drive::Torque(torque)).unwrap();
            state.transmission_error_m
        })
        .collect()
}

fn peak_to_peak(curve: &[f64]) -> f64 {
    let high = curve.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    high - curve.iter().copied().fold(f64::INFINITY, f64::min)
}

#[test]
fn a_vanishing_helix_is_a_spur_pair() {
    for (local, has_edges) in [
        (LocalContact::None, false),
        (LocalContact::WeberBanaschek, false),
        (LocalContact::WeberBanaschek, true),
    ] {
        let options = ContactOptions {
            local,
            friction: Some(Friction {
                coefficient: 0.06,
                reversal_m: 20e-6,
            }),
        };
        let [spur, almost] = [0.0, 1e-9].map(|helix_deg| {
            let lines = lines(helix_deg, Flank::Right);
            let extension = has_edges.then(|| PathExtension::new(&lines.pair, 100e-6));
            ContactLines { extension, ..lines }
        });
        assert!(almost.pair.is_helical() && !spur.pair.is_helical());
        let (mut a, mut b) = (contact(&spur, options, 5), contact(&almost, options, 5));
        for angle in angles(&spur, 37) {
            let s = a.solve(angle, Drive::Torque(200.0)).unwrap();
            let h = b.solve(angle, Drive::Torque(200.0)).unwrap();
            let scale = s.transmission_error_m.abs();
            assert!((s.transmission_error_m - h.transmission_error_m).abs() < 1e-9 * scale);
            assert!((s.torque_1_nm - h.torque_1_nm).abs() < 1e-9 * s.torque_1_nm);
            assert!((s.torque_rate_n - h.torque_rate_n).abs() < 1e-8 * s.torque_rate_n);
            assert_eq!(a.forces_n().len(), b.forces_n().len());
            let largest = a.forces_n().iter().copied().fold(0.0, f64::max);
            for (f, g) in a.forces_n().iter().zip(b.forces_n()) {
                assert!((f - g).abs() < 1e-9 * largest, "{f} {g}");
            }
            assert_eq!(s.axial_force_1_n, 0.0);
        }
    }
}

/// One sign of the transmission error: driven on the left flanks a spur pair has the same curve, backlash or not.
#[test]
fn left_flanks_of_a_spur_pair_have_the_curve_of_the_right_ones() {
    let [right, left] = [Flank::Right, Flank::Left].map(|flank| lines(0.0, flank));
    assert!(right.pair.backlash_m() > 1e-5);
    let of_right = curve(&right, 200.0, 5, 23);
    let of_left = curve(&left, 200.0, 5, 23);
    for (a, b) in of_right.iter().zip(&of_left) {
        assert!(*a < -1e-6 && (a - b).abs() < 1e-12 * a.abs(), "{a:e} {b:e}");
    }
}

/// Turning the gears over (z to −z) turns the hand; looking from the other side of the plane of the axes turns hand and
/// flanks. The bodies here are their own mirror images.
#[test]
fn hands_and_flanks_are_mirror_images() {
    let right = lines(18.0, Flank::Right);
    let slices = 6;
    for (helix_deg, flank, axial_sign, over) in [
        (-18.0, Flank::Right, -1.0, true),
        (-18.0, Flank::Left, 1.0, false),
        (18.0, Flank::Left, -1.0, true),
    ] {
        let image = lines(helix_deg, flank);
        let (mut a, mut b) = (
            contact(&right, FRICTIONLESS, slices),
            contact(&image, FRICTIONLESS, slices),
        );
        for angle in angles(&right, 23) {
            let s = a.solve(angle, Drive::Torque(150.0)).unwrap();
            let t = b.solve(angle, Drive::Torque(150.0)).unwrap();
            let scale = s.transmission_error_m.abs();
            assert!((s.transmission_error_m - t.transmission_error_m).abs() < 1e-10 * scale);
            let axial = axial_sign * t.axial_force_1_n;
            assert!((s.axial_force_1_n - axial).abs() < 1e-10 * axial.abs());
            for (x, y) in a.forces_n().chunks(slices).zip(b.forces_n().chunks(slices)) {
                let y: Vec<f64> = if over {
                    y.iter().rev().copied().collect()
                } else {
                    y.to_vec()
                };
                assert!(x.iter().zip(&y).all(|(x, y)| (x - y).abs() < 1e-6));
            }
            if flank == Flank::Left {
                // Gear 1 turns the other way, so that its teeth come in the other order.
                for (l, m) in a.active_lines().iter().zip(b.active_lines()) {
                    assert_eq!(l.pair, m.pair);
                    assert_eq!((l.tooth_1 + m.tooth_1) % 31, 0);
                    assert_eq!((l.tooth_2 + m.tooth_2) % 40, 0);
                }
            }
        }
    }
}

#[test]
fn torque_and_axial_force_balance() {
    for helix_deg in [12.0f64, -30.0] {
        let lines = lines(helix_deg, Flank::Right);
        let mut contact = contact(&lines, FRICTIONLESS, 8);
        let (r1, r2) = (
            lines.pair.gear_1.base_radius_m,
            lines.pair.gear_2.base_radius_m,
        );
        let base_helix = (helix_deg.to_radians().sin() * 20f64.to_radians().cos()).asin();
        for angle in angles(&lines, 29) {
            let state = contact.solve(angle, Drive::Torque(240.0)).unwrap();
            assert!((state.torque_2_nm / 240.0 - 1.0).abs() < 1e-10);
            assert!((state.torque_1_nm / (240.0 * r1 / r2) - 1.0).abs() < 1e-10);
            // Exactly T/r_b tan β_b, however the load is shared; a right-hand driver turning clockwise is pushed to −z.
            let axial = -240.0 / r2 * base_helix.tan();
            assert!((state.axial_force_1_n / axial - 1.0).abs() < 1e-10);
            let normal: f64 = contact.forces_n().iter().sum();
            let expected = 240.0 / (r2 * base_helix.cos());
            assert!((normal / expected - 1.0).abs() < 1e-10);
        }
    }
}

/// Along the line of action: F = T/r_b2 over the deflection since first touch, and dF by differences of the solution.
#[test]
fn stiffnesses_are_those_of_the_load_curve() {
    for helix_deg in [0.0, 12.0] {
        let lines = lines(helix_deg, Flank::Right);
        let mut contact = contact(&lines, FRICTIONLESS, 4);
        let base_m = lines.pair.gear_2.base_radius_m;
        for angle in angles(&lines, 7) {
            let mut at = |torque: f64| contact.solve(angle, Drive::Torque(torque)).unwrap();
            let state = at(240.0);
            let found = MeshStiffness::of(&state, base_m);
            // Hardly any load hardly deflects anything.
            let touch_m = at(1e-6).transmission_error_m;
            let secant = 240.0 / base_m / (touch_m - state.transmission_error_m);
            assert!(
                (found.secant_n_per_m / secant - 1.0).abs() < 1e-6,
                "{found:?} {secant:e}"
            );
            let [less, more] = [239.99, 240.01].map(|torque| at(torque).transmission_error_m);
            let tangent = 0.02 / base_m / (less - more);
            assert!(
                (found.tangent_n_per_m / tangent - 1.0).abs() < 1e-5,
                "{found:?} {tangent:e}"
            );
        }
    }
}

/// The slices on the path, with their shares, are the length of the contact lines: b ε_α/p in the mean over a pitch.
#[test]
fn contact_lines_have_the_mean_length_of_the_field_of_action() {
    for helix_deg in [7.0, 25.0] {
        let lines = lines(helix_deg, Flank::Right);
        let mut contact = contact(&lines, FRICTIONLESS, 7);
        let (points, mut sum, mut most) = (400, 0.0, 0);
        for angle in angles(&lines, points) {
            contact.solve(angle, Drive::Torque(100.0)).unwrap();
            sum += contact.patches().iter().map(|s| s.share).sum::<f64>();
            most = most.max(contact.active_lines().len());
            for s in contact.patches() {
                let roll = s.places[0].u;
                assert!(
                    roll >= lines.pair.roll_start_1_rad - 1e-12
                        && roll <= lines.pair.roll_end_1_rad + 1e-12
                );
                assert!(s.share > 0.0 && s.share <= 1.0);
            }
        }
        let mean = sum / points as f64 / 7.0;
        // The curve has kinks and the least share is cut off: 1e-3.
        assert!(
            (mean / lines.pair.contact_ratio() - 1.0).abs() < 1e-3,
            "{mean}"
        );
        let total = lines.pair.total_contact_ratio(FACE_WIDTH_M);
        assert!(most <= lines.most_pairs() && most >= total.floor() as usize);
        assert!(lines.most_pairs() <= total.ceil() as usize + 1);
    }
}

fn largest_step(curve: &[f64]) -> f64 {
    curve
        .windows(2)
        .map(|w| (w[1] - w[0]).abs())
        .fold(0.0, f64::max)
}

/// A spur pair jumps where a line enters; slanted lines enter slice by slice and each slice with a growing length.
#[test]
fn the_transmission_error_of_helical_teeth_is_continuous() {
    let (spur, helical) = (lines(0.0, Flank::Right), lines(15.0, Flank::Right));
    let steps = |lines: &ContactLines, points| largest_step(&curve(lines, 200.0, 5, points));
    let spur = (steps(&spur, 50), steps(&spur, 800));
    assert!(spur.1 > 0.8 * spur.0, "{spur:?}");
    for local in [LocalContact::WeberBanaschek, LocalContact::None] {
        let options = ContactOptions {
            local,
            friction: None,
        };
        let steps = |points| largest_step(&curve_with(&helical, options, 200.0, 5, points));
        let (coarse, fine) = (steps(50), steps(800));
        assert!(fine < 0.2 * coarse, "{local:?}: {coarse} {fine}");
    }
}

/// With an overlap ratio of one the length of all contact lines together hardly varies, and with it the deflection.
#[test]
fn an_integer_overlap_ratio_smooths_the_transmission_error() {
    let ripple = |overlap: f64| {
        let sin = overlap * std::f64::consts::PI * 3e-3 / FACE_WIDTH_M;
        let lines = lines(sin.asin().to_degrees(), Flank::Right);
        assert!((lines.pair.overlap_ratio(FACE_WIDTH_M) - overlap).abs() < 1e-12);
        peak_to_peak(&curve(&lines, 200.0, 16, 60))
    };
    let (none, half, one, more) = (ripple(0.0), ripple(0.5), ripple(1.0), ripple(1.3));
    assert!(one < 0.5 * half && half < none && one < more);
}

#[test]
fn lead_crowning_and_misalignment_move_the_load() {
    let mut crowned = lines(20.0, Flank::Right);
    crowned.microgeometry_1 = Microgeometry {
        tip_roll_rad: crowned.pair.gear_1.tip_roll_rad,
        face_width_m: FACE_WIDTH_M,
        lead_crowning_m: 15e-6,
        ..Microgeometry::default()
    };
    let centroid = |lines: &ContactLines| {
        let mut contact = contact(lines, FRICTIONLESS, 10);
        let (mut moment, mut sum, mut ends) = (0.0, 0.0, 0.0);
        for angle in angles(lines, 40) {
            contact.solve(angle, Drive::Torque(100.0)).unwrap();
            for s in contact.patches() {
                moment += s.places[0].v * contact.force_n(s);
                sum += contact.force_n(s);
                if s.slice == 0 || s.slice == 9 {
                    ends += contact.force_n(s);
                }
            }
        }
        (moment / sum, ends / sum)
    };
    let (plain, relieved) = (centroid(&lines(20.0, Flank::Right)), centroid(&crowned));
    assert!(relieved.1 < 0.7 * plain.1, "{plain:?} {relieved:?}");
    let mut tilted = crowned.clone();
    tilted.pair.misalignment.deviation_rad = 1e-3;
    // It opens the flanks at +z.
    assert!(centroid(&tilted).0 < relieved.0 - 1e-3);
}
