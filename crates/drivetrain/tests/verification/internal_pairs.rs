//! A ring and the gear inside it, either driving: the gap against the least distance of the profiles, exchange of the
//! gears, a rigid pair by hand, friction. What holds for all pairs alike is checked with external ones
//! (`kinematics.rs`, `helical/`, `static_scene.rs`).

use crate::mesh_common;

use gearmesh_contact::slice_contact::SliceContact;
use gearmesh_contact::{
    ContactLines, ContactOptions, ContactZone, Drive, HalfSpaces, InvoluteAtRest, LocalContact,
    SliceLayout, StaticContact,
};
use gearmesh_drivetrain::pose::Vector6;
use gearmesh_drivetrain::*;
use gearmesh_geometry::{Flank, GearPair, Microgeometry, ToothGeometry};
use mesh_common::*;
use nalgebra::{Vector2, Vector3};

const SIDES: [Flank; 2] = [Flank::Right, Flank::Left];

fn lines(pair: &GearPair) -> ContactLines {
    ContactLines {
        pair: pair.clone(),
        microgeometry_1: Microgeometry::default(),
        microgeometry_2: Microgeometry::default(),
        extension: None,
        zone: ContactZone::of_equal_faces(WIDTH),
    }
}

/// Place and value of the least of a function with one valley.
fn least(mut low: f64, mut high: f64, f: &dyn Fn(f64) -> f64) -> f64 {
    let part = 0.5 * (5f64.sqrt() - 1.0);
    for _ in 0..60 {
        let span = part * (high - low);
        if f(high - span) < f(low + span) {
            high = low + span;
        } else {
            low = high - span;
        }
    }
    f(0.5 * (low + high))
}

/// Two profiles 20 µm of base circle apart: the least distance of all pairs of their points, which knows no line of
/// action.
#[test]
fn the_gap_is_the_least_distance_of_the_profiles() {
    let mut seen = 0;
    for (pair, side) in [ring_pair(0.0, false), ring_pair(0.0, true)]
        .iter()
        .flat_map(|pair| SIDES.map(|side| (pair, side)))
    {
        let kinematics = kinematics(pair);
        let mut found = FlankContacts::default();
        for k in 0..6 {
            let phi = angles(pair, side, 0.07 * f64::from(k), 20e-6);
            let at = pose(pair, phi, Vector3::zeros(), Vector3::zeros());
            kinematics.contacts(&at, side, &mut found).unwrap();
            for line in &found.lines {
                let section = &found.sections[line.section];
                if (0..2).any(|gear| !section.walks(gear)) {
                    continue;
                }
                let gears = [&pair.gear_1, &pair.gear_2];
                let point = |gear: usize, roll: f64| {
                    let tooth = gears[gear];
                    let pitch = std::f64::consts::TAU / tooth.teeth as f64;
                    let (sin, cos) = (pitch * line.teeth[gear] as f64 + phi[gear]).sin_cos();
                    let [x, y] = tooth.flank_point_m(pair.circles().side_of(gear, side), roll);
                    let centre = [0.0, pair.centre_distance_m][gear];
                    Vector2::new(centre + cos * x - sin * y, sin * x + cos * y)
                };
                let ends = |tooth: &ToothGeometry| {
                    let (a, b) = (tooth.form_roll_rad, tooth.flank_end_roll_rad);
                    (a.min(b), a.max(b))
                };
                let (ends_1, ends_2) = (ends(gears[0]), ends(gears[1]));
                let to_flank_2 = |roll_1: f64| {
                    let from = point(0, roll_1);
                    least(ends_2.0, ends_2.1, &|roll| (point(1, roll) - from).norm())
                };
                let distance = least(ends_1.0, ends_1.1, &to_flank_2);
                let gap = found.contacts[line.contacts.0].gap_m;
                assert!((gap - distance).abs() < 1e-12, "{gap:e} {distance:e}");
                seen += 1;
            }
        }
    }
    assert!(seen > 24, "{seen}");
}

/// The same flanks with the other gear as the first, displaced and tilted: the same gaps.
#[test]
fn exchanging_the_gears_changes_no_gap() {
    for helix_deg in [0.0, 15.0] {
        let [pair, exchanged] = [false, true].map(|ring| ring_pair(helix_deg, ring));
        for side in SIDES {
            let phi = angles(&pair, side, 0.11, -7e-6);
            let shift = Vector3::new(1e-4, -2e-4, 3e-4);
            let at = pose(&pair, phi, shift, Vector3::new(2e-3, 1e-3, 0.0));
            let back = at.rotation.transpose();
            let other = Pose::at_rest(-back * at.displacement_m, back);
            let (mut first, mut second) = (FlankContacts::default(), FlankContacts::default());
            kinematics(&pair).contacts(&at, side, &mut first).unwrap();
            let side_2 = pair.circles().side_of(1, side);
            let turned = kinematics(&exchanged);
            turned.contacts(&other, side_2, &mut second).unwrap();
            let mut seen = 0;
            for contact in &first.contacts {
                let [tooth_1, tooth_2] = first.lines[contact.line].teeth;
                let twin = second.contacts.iter().find(|twin| {
                    let teeth = second.lines[twin.line].teeth;
                    teeth == [tooth_2, tooth_1] && twin.slice == contact.slice
                });
                // One more pair is looked at on the side where gear 1's flank begins.
                let Some(twin) = twin else { continue };
                seen += 1;
                let off = contact.gap_m - twin.gap_m;
                assert!(off.abs() < 1e-14, "{off:e}");
            }
            assert!(seen >= SLICES, "{seen}");
        }
    }
}

/// Bodies that deflect at their surfaces only, one slice: 1/ρ = 1/ρ₁ − 1/ρ₂ with ρ₂ − ρ₁ = a sin α, Hertz's half
/// width, and the deflection of a
/// line load of finite length, k q [asinh(l/2ρ₀) + ln(ρ₀/ρ)] (half_spaces.rs), k = 2(1 − ν²)/(πE) of both bodies
/// together halved.
#[test]
fn a_rigid_pair_with_hertz_is_that_by_hand() {
    let (young, nu) = (210e9, 0.3);
    for ring_drives in [false, true] {
        let pair = ring_pair(0.0, ring_drives);
        let layout = SliceLayout::new([WIDTH; 2], 0.0, 1);
        let lines = lines(&pair);
        let most_lines = lines.most_pairs() + 1;
        let flanks = InvoluteAtRest::new(lines, layout, None);
        let bodies = HalfSpaces::new([(young, nu); 2]);
        let slices = SliceContact::of_half_spaces(layout, bodies, most_lines);
        let mut contact = StaticContact::of_flanks(flanks, slices);
        let torque = 150.0;
        let mut alone = 0;
        for k in 0..60 {
            let theta = pair.pitch_1_rad() * f64::from(k) / 60.0;
            let state = contact.solve(theta, Drive::Torque(torque)).unwrap();
            let sum: f64 = contact.forces_n().iter().sum();
            let [r1, r2] = [&pair.gear_1, &pair.gear_2].map(|gear| gear.base_radius_m);
            assert!((sum * r2 / torque - 1.0).abs() < 1e-9);
            assert!((state.torque_1_nm / r1 - state.torque_2_nm / r2).abs() < 1e-9 * sum);
            let [patch] = contact.patches() else { continue };
            alone += 1;
            let rho = [r1 * patch.places[0].u, r2 * patch.places[1].u];
            let line = pair.centre_distance_m * pair.working_pressure_angle_rad.sin();
            let [inside, around] = if ring_drives { [rho[1], rho[0]] } else { rho };
            assert!((around - inside - line).abs() < 1e-14);
            let radius = 1.0 / (1.0 / inside - 1.0 / around);
            assert!((patch.radius_m / radius - 1.0).abs() < 1e-12);
            let q = sum / WIDTH;
            let compliance = 2.0 * (1.0 - nu * nu) / young;
            let half_width = (4.0 * q * radius * compliance / std::f64::consts::PI).sqrt();
            let (found, _) = contact.hertz(0, sum);
            assert!((found / half_width - 1.0).abs() < 1e-9);
            let (smear, spread) = (0.53 * WIDTH, 0.5 * half_width * (-0.5f64).exp());
            let by_hand = 2.0 * compliance / std::f64::consts::PI
                * q
                * ((0.5f64 / 0.53).asinh() + (smear / spread).ln());
            let deflection = state.unloaded_m - state.transmission_error_m;
            assert!(
                (deflection / by_hand - 1.0).abs() < 1e-6,
                "{deflection:e} {by_hand:e}"
            );
        }
        assert!(alone >= 2, "{alone}");
    }
}

/// At rest friction takes the power F μ |v|, v the speed of sliding that the pair's geometry states; in motion it
/// points to the same side.
#[test]
fn friction_takes_power_and_turns_round_in_the_pitch_point() {
    for (ring_drives, helix_deg) in [(false, 0.0), (true, 0.0), (false, 15.0), (true, -15.0)] {
        let pair = ring_pair(helix_deg, ring_drives);
        let models = [&pair.gear_1, &pair.gear_2].map(made_up_gear);
        let options = ContactOptions {
            local: LocalContact::WeberBanaschek,
            friction: Some(gearmesh_contact::Friction {
                coefficient: 0.1,
                reversal_m: 1e-6,
            }),
        };
        let mut contact =
            StaticContact::new(lines(&pair), &models[0], &models[1], options).unwrap();
        let [r1, r2] = [&pair.gear_1, &pair.gear_2].map(|gear| gear.base_radius_m);
        let (mut approach, mut recess) = (0, 0);
        for k in 0..20 {
            let theta = pair.pitch_1_rad() * (0.03 + f64::from(k) / 20.0);
            let state = contact.solve(theta, Drive::Torque(100.0)).unwrap();
            let lost = state.torque_1_nm - state.torque_2_nm * r1 / r2;
            let mut expected = 0.0;
            for patch in contact.patches() {
                let speed = pair.sliding_velocity_m_per_s(patch.places[0].u, 1.0);
                let [drag, force] = [patch.balance.friction, contact.force_n(patch)];
                expected += force * (drag * speed).abs();
                assert!(drag * speed >= 0.0);
                approach += usize::from(drag < 0.0);
                recess += usize::from(drag > 0.0);
            }
            assert!((lost / expected - 1.0).abs() < 1e-9, "{lost} {expected}");
        }
        assert!(approach > 5 && recess > 5, "{approach} {recess}");

        let side = Flank::Right;
        let friction = Friction::new([0.1, 0.1], [1e-9, 2e-9]).unwrap();
        let mut mesh = GearMesh::new(kinematics(&pair), side, reduced_teeth(&pair, side))
            .unwrap()
            .with_friction(friction);
        let sigma = [0, 1].map(|gear| pair.circles().side_of(gear, side).mirror());
        let speeds = [-sigma[0], sigma[1] * r1 / r2];
        for k in 0..10 {
            let phi = angles(&pair, side, 0.021 * f64::from(k), -10e-6);
            let at = pose(&pair, phi, Vector3::zeros(), Vector3::zeros());
            let u = at.displacement_m;
            let turns = speeds[1] - speeds[0];
            let rates = Vector6::new(speeds[0] * u[1], -speeds[0] * u[0], 0.0, 0.0, 0.0, turns);
            let load = mesh.evaluate(&moving(&at, &rates), false).unwrap();
            assert!(load.friction_w > 0.0, "{}", load.friction_w);
            let (found, forces) = mesh.side(side).unwrap();
            for (i, contact) in found.contacts.iter().enumerate() {
                let path = pair.path_from_pitch_point_m(found.section(contact).roll_rad[0]);
                if forces[i] > 0.0 && path.abs() > 1e-5 {
                    let towards_tips = mesh.friction(side)[i].towards_tips;
                    let expected = 0.1f64.copysign(path);
                    assert!(
                        towards_tips.iter().all(|t| (t - expected).abs() < 1e-12),
                        "{towards_tips:?} at {path:e}"
                    );
                }
            }
        }
    }
}

/// Beams for a ring's teeth are refused by name.
#[test]
fn beams_of_a_ring_are_refused() {
    let pair = ring_pair(0.0, false);
    let beams = [beam_tooth(1, &pair.gear_1), beam_tooth(2, &pair.gear_2)];
    let refused = BeamTeeth::new(beams, SLICES, [&[], &[]]).unwrap_err();
    assert!(
        refused.to_string().contains("gear 2 is a ring"),
        "{refused}"
    );
}
