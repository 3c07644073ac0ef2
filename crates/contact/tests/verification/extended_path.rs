//! Loaded pairs with contact beyond the ends of the path: continuity over a pitch, balance, and no allocation of lines.

use crate::pair_common;

use gearmesh_contact::Drive;
use gearmesh_contact::{ContactLines, ContactOptions, Friction};
use gearmesh_geometry::Microgeometry;
use gearmesh_geometry::microgeometry::{ReliefShape, TipRelief};
use pair_common::{FRICTIONLESS, contact, extended, pair, tooth};

const SLICES: usize = 3;

fn lines() -> ContactLines {
    extended(pair(&tooth(40, 0.0, 0.0), &tooth(50, 0.0, 0.2e-3)), 100e-6)
}

fn relieved(mut lines: ContactLines, amount_m: f64) -> ContactLines {
    for (gear, microgeometry) in [
        (&lines.pair.gear_1, &mut lines.microgeometry_1),
        (&lines.pair.gear_2, &mut lines.microgeometry_2),
    ] {
        *microgeometry = Microgeometry {
            tip_roll_rad: gear.tip_roll_rad,
            face_width_m: 20e-3,
            tip_relief: Some(TipRelief {
                amount_m,
                start_roll_rad: 0.85 * gear.tip_roll_rad,
                shape: ReliefShape::Linear,
            }),
            lead_crowning_m: 4e-6,
            ..Microgeometry::default()
        };
    }
    lines
}

/// Transmission error over one pitch \[m\], warm from step to step.
fn curve(lines: &ContactLines, options: ContactOptions, torque: f64, points: usize) -> Vec<f64> {
    let mut contact = contact(lines, options, SLICES);
    let step = lines.pair.pitch_1_rad() / points as f64;
    (0..=points)
        .map(|k| {
            let state = contact
                .solve(step * k as f64 + 0.013, Drive::Torque(torque))
                .unwrap();
            assert!((state.torque_2_nm / torque - 1.0).abs() < 1e-10);
            state.transmission_error_m
        })
        .collect()
}

fn largest_step(curve: &[f64]) -> f64 {
    curve
        .windows(2)
        .map(|w| (w[1] - w[0]).abs())
        .fold(0.0, f64::max)
}

/// On the rigid path the transmission error jumps where a pair enters or leaves, however small the step; on the
/// extended path the largest step shrinks with the step.
#[test]
fn the_transmission_error_is_continuous_over_a_pitch() {
    for lines in [lines(), relieved(lines(), 12e-6)] {
        let seed = ContactLines {
            extension: None,
            ..lines.clone()
        };
        for torque in [100.0, 400.0] {
            let steps = |lines: &ContactLines| {
                [200, 800, 3200].map(|n| largest_step(&curve(lines, FRICTIONLESS, torque, n)))
            };
            let (jumping, smooth) = (steps(&seed), steps(&lines));
            assert!(
                smooth[1] < 0.35 * smooth[0] && smooth[2] < 0.35 * smooth[1],
                "{smooth:?}"
            );
            if lines.microgeometry_1.tip_relief.is_none() {
                assert!(jumping[2] > 0.8 * jumping[0], "{jumping:?}");
                assert!(jumping[2] > 10.0 * smooth[2], "{jumping:?} {smooth:?}");
            }
        }
    }
}

/// Where no tip touches both paths are the same problem; where one does, the load is shared and the pair deflects less.
#[test]
fn a_tip_in_contact_stiffens_the_pair() {
    let lines = lines();
    let seed = ContactLines {
        extension: None,
        ..lines.clone()
    };
    let points = 240;
    let mut extended = contact(&lines, FRICTIONLESS, SLICES);
    let mut on_path = contact(&seed, FRICTIONLESS, SLICES);
    let (mut shared, mut same) = (0, 0);
    for k in 0..points {
        let angle = lines.pair.pitch_1_rad() * f64::from(k) / f64::from(points);
        let with = extended.solve(angle, Drive::Torque(300.0)).unwrap();
        let without = on_path.solve(angle, Drive::Torque(300.0)).unwrap();
        let on_tips: f64 = extended
            .active_lines()
            .iter()
            .zip(extended.forces_n().chunks(SLICES))
            .filter(|(line, _)| line.tip.is_some())
            .map(|(_, forces)| forces.iter().sum::<f64>())
            .sum();
        let gain = with.transmission_error_m - without.transmission_error_m;
        if on_tips > 0.0 {
            shared += 1;
            assert!(gain > 0.0, "{gain}");
        } else {
            same += 1;
            assert!(gain.abs() < 1e-9 * without.transmission_error_m.abs());
        }
    }
    assert!(shared > points / 20 && same > points / 4, "{shared} {same}");
}

/// Friction continues its sign from the path: gear 1 needs more torque than without, at all positions where the load is
/// beyond the pitch point or before it, and the curve stays continuous.
#[test]
fn friction_takes_work_beyond_the_ends_of_the_path() {
    let lines = lines();
    let options = ContactOptions {
        friction: Some(Friction {
            coefficient: 0.1,
            reversal_m: 20e-6,
        }),
        ..FRICTIONLESS
    };
    let mut contact = contact(&lines, options, SLICES);
    let ratio = lines.pair.gear_1.base_radius_m / lines.pair.gear_2.base_radius_m;
    let mut tips = 0;
    for k in 0..400 {
        let angle = lines.pair.pitch_1_rad() * f64::from(k) / 400.0;
        let state = contact.solve(angle, Drive::Torque(300.0)).unwrap();
        for (line, forces) in contact
            .active_lines()
            .iter()
            .zip(contact.forces_n().chunks(SLICES))
        {
            let force: f64 = forces.iter().sum();
            if line.tip.is_none() || force == 0.0 {
                continue;
            }
            tips += 1;
            let friction = 0.1 * line.path_m.signum();
            let [one, two] = lines.lever_arms_m(line, friction);
            let [one_without, two_without] = lines.lever_arms_m(line, 0.0);
            // Power lost to friction per newton and radian of gear 1.
            let lost = (one - one_without) - (two - two_without) * ratio;
            assert!(lost > 0.0, "{lost}");
        }
        assert!(state.torque_1_nm.is_finite());
    }
    assert!(tips > 20);
}

/// Memory for the most lines that can come is set aside at the start.
#[test]
fn all_lines_of_a_revolution_fit() {
    let lines = lines();
    let mut contact = contact(&lines, FRICTIONLESS, SLICES);
    let mut most = 0;
    for k in 0..2000 {
        let angle = 0.01 * f64::from(k);
        contact.solve(angle, Drive::Torque(200.0)).unwrap();
        most = most.max(contact.active_lines().len());
        assert_eq!(
            contact.forces_n().len(),
            contact.active_lines().len() * SLICES
        );
    }
    assert_eq!(most, lines.most_pairs());
}
