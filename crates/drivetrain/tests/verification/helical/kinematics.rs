//! Gaps, roll angles, shares and their derivatives of helical pairs: against the static scene, points and normals of
//! the flanks, differences.

use std::sync::Arc;

use crate::mesh_common::*;
use gearmesh_contact::{ContactLine, ContactLines, ContactZone, SliceLayout};
use gearmesh_drivetrain::pose::Vector6;
use gearmesh_drivetrain::*;
use gearmesh_geometry::microgeometry::ProfileCrowning;
use gearmesh_geometry::{Flank, GearPair, Microgeometry, ToothGeometry};
use nalgebra::Vector3;

const SIDES: [Flank; 2] = [Flank::Right, Flank::Left];
const ENDS: [PathEnds; 2] = [PathEnds::LineOfAction, PathEnds::Extended];

/// On the rigid path the same slices with the same shares and roll angles as in the static scene, both hands, both
/// sides; the gap is that of the bases times cos β_b.
#[test]
fn slices_are_those_of_the_static_scene() {
    for pair in helical_families() {
        for side in SIDES {
            let pair = pair.clone().on_flanks(side);
            let none = Microgeometry::default;
            let lines = ContactLines {
                pair: pair.clone(),
                microgeometry_1: none(),
                microgeometry_2: none(),
                extension: None,
                zone: ContactZone::of_equal_faces(WIDTH),
            };
            let kinematics =
                kinematics_with(&pair, [Vec::new(), Vec::new()], PathEnds::LineOfAction);
            let cos = pair.base_helix_angle_rad().cos();
            let (mut active, mut found) = (Vec::<ContactLine>::new(), FlankContacts::default());
            let mut partly = 0;
            for k in 0..60 {
                // At TE = 0 both have the same roll angle on gear 2.
                let theta = 0.37 * f64::from(k);
                lines.at(theta, &mut active);
                let mut expected = Vec::new();
                for line in active.iter().enumerate() {
                    lines.push_patches(line, &layout(SLICES), None, &mut expected);
                }
                let phi = angles(&pair, side, theta, 0.0);
                let at = pose(&pair, phi, Vector3::zeros(), Vector3::zeros());
                kinematics.contacts(&at, side, &mut found).unwrap();
                assert_eq!(found.contacts.len(), expected.len(), "{theta}");
                for contact in &found.contacts {
                    let (section, line) = (found.section(contact), &found.lines[contact.line]);
                    let twin = expected
                        .iter()
                        .find(|twin| twin.teeth == line.teeth && twin.slice == contact.slice);
                    let twin = twin.unwrap_or_else(|| panic!("{:?}", line.teeth));
                    assert!((section.share - twin.share).abs() < 1e-10);
                    partly += usize::from(section.share < 1.0);
                    assert!((section.length_m / twin.length_m - 1.0).abs() < 1e-6);
                    assert!((section.radius_m / twin.radius_m - 1.0).abs() < 1e-10);
                    let rolls = twin.places.map(|place| place.u);
                    for (own, other) in section.roll_rad.iter().zip(rolls) {
                        assert!((own - other).abs() < 1e-12, "{own} {other}");
                    }
                    assert!(contact.gap_m.abs() < 1e-15, "{}", contact.gap_m);
                    assert!((contact.gradient.fixed_rows::<3>(0).norm() - 1.0).abs() < 1e-14);
                }
                let opened = pose(
                    &pair,
                    angles(&pair, side, theta, 7e-6),
                    Vector3::zeros(),
                    Vector3::zeros(),
                );
                kinematics.contacts(&opened, side, &mut found).unwrap();
                for contact in &found.contacts {
                    assert!((contact.gap_m - 7e-6 * cos).abs() < 1e-15);
                }
            }
            assert!(partly > 20, "{partly}");
        }
    }
}

/// Points and normals of the two helicoids themselves: at the heights and roll angles found the points lie on the line
/// of action, the transverse gap apart, and gear 2's inward normal there is the direction of the force. The gears stand
/// shifted along the axis, too.
#[test]
fn the_gap_is_that_of_the_helicoids() {
    let families = helical_families().map(|pair| SIDES.map(|side| (pair.clone(), side)));
    for (pair, side) in families.into_iter().flatten() {
        let pair = pair.on_flanks(side);
        let side_2 = pair.flank_of(1);
        let kinematics = kinematics(&pair);
        let phi = angles(&pair, side, 1.234, 40e-6);
        let shift = Vector3::new(0.3e-3, -0.2e-3, 0.7e-3);
        let at = pose(&pair, phi, shift, Vector3::zeros());
        let mut found = FlankContacts::default();
        let (_, placed) = kinematics.contacts(&at, side, &mut found).unwrap();
        let cos = pair.base_helix_angle_rad().cos();
        let mut points = 0;
        for contact in &found.contacts {
            let section = found.section(contact);
            if (0..2).any(|gear| !section.walks(gear)) {
                continue;
            }
            points += 1;
            let plane = &placed.planes[contact.slice];
            let teeth = found.lines[contact.line].teeth;
            let heights = plane.heights_m;
            let turned = |gear: usize, tooth: &ToothGeometry| {
                let pitch = std::f64::consts::TAU / tooth.teeth as f64;
                let twist = tooth.twist_rad_per_m() * heights[gear];
                about(Vector3::z(), teeth[gear] as f64 * pitch + twist + phi[gear])
            };
            let point = |gear: usize, tooth: &ToothGeometry| {
                let side = pair.flank_of(gear);
                let [x, y] = tooth.flank_point_m(side, section.roll_rad[gear]);
                turned(gear, tooth) * Vector3::new(x, y, 0.0) + heights[gear] * Vector3::z()
            };
            let centre_2 = Vector3::new(pair.centre_distance_m, 0.0, 0.0) + shift;
            let point_2 = centre_2 + point(1, &pair.gear_2);
            let apart = point_2 - point(0, &pair.gear_1);
            let world = about(Vector3::z(), phi[0]);
            let along = world * plane.normal;
            let transverse = contact.gap_m / cos;
            let off = (apart - transverse * along).norm();
            assert!(off < 1e-14, "{apart} {off:e}");
            let [x, y, z] = (pair.gear_2).flank_normal(side_2, section.roll_rad[1]);
            let normal = turned(1, &pair.gear_2) * Vector3::new(x, y, z);
            let force: Vector3<f64> = contact.gradient.fixed_rows::<3>(0).into();
            assert!((normal - world * force).norm() < 1e-12, "{normal}");
            // The wrench of that normal through the point halfway between the flanks.
            let moment: Vector3<f64> = contact.gradient.fixed_rows::<3>(3).into();
            let arm = (point_2 - 0.5 * apart - centre_2).cross(&normal);
            assert!((arm - world * moment).norm() < 1e-12, "{arm}");
        }
        assert!(points >= SLICES, "{points}");
    }
}

fn crowned(gear: &ToothGeometry) -> Arc<dyn FlankError> {
    Arc::new(Microgeometry {
        tip_roll_rad: gear.tip_roll_rad,
        face_width_m: WIDTH,
        profile_crowning: Some(ProfileCrowning {
            amount_m: 8e-6,
            centre_roll_rad: 0.5 * (gear.tip_roll_rad + gear.form_roll_rad),
        }),
        ..Microgeometry::default()
    })
}

/// Gradients of gaps, roll angles and shares against central differences, tilted, displaced, on modified flanks, at
/// both ends of the path.
#[test]
fn gradients_agree_with_differences() {
    let pairs = [
        helical_pair(19.0),
        ring_pair(15.0, false),
        ring_pair(-15.0, true),
    ];
    for (pair, ends) in pairs.iter().flat_map(|pair| ENDS.map(|ends| (pair, ends))) {
        let errors = [&pair.gear_1, &pair.gear_2].map(|gear| vec![crowned(gear)]);
        let kinematics = kinematics_with(pair, errors, ends);
        let contacts = |at: &Pose, side| {
            let mut found = FlankContacts::default();
            kinematics.contacts(at, side, &mut found).unwrap();
            found
        };
        let mut partly = 0;
        for (side, theta) in [(SIDES[0], 0.05), (SIDES[1], 0.13), (SIDES[0], 0.21)] {
            let tilt = Vector3::new(3e-3, -2e-3, 0.0);
            let phi = angles(pair, side, theta, -5e-6);
            let at = pose(pair, phi, Vector3::new(1e-4, 2e-4, 1e-3), tilt);
            let here = contacts(&at, side);
            for direction in 0..6 {
                let h = 1e-7;
                let mut step = Vector6::zeros();
                step[direction] = h;
                let (after, before) = (
                    contacts(&moved(&at, &step), side),
                    contacts(&moved(&at, &-step), side),
                );
                assert_eq!(after.contacts.len(), here.contacts.len());
                let differ = |i: usize, what: &dyn Fn(&FlankContacts, usize) -> f64| {
                    (what(&after, i) - what(&before, i)) / (2.0 * h)
                };
                for (i, contact) in here.contacts.iter().enumerate() {
                    let off =
                        differ(i, &|set, i| set.contacts[i].gap_m) - contact.gradient[direction];
                    assert!(off.abs() < 3e-9, "gap {i} by {direction}: {off:e}");
                    let section = here.section(contact);
                    for gear in 0..2 {
                        let roll = |set: &FlankContacts, i: usize| {
                            set.section(&set.contacts[i]).roll_rad[gear]
                        };
                        let off = differ(i, &roll) - section.roll_gradient[gear][direction];
                        assert!(off.abs() < 1e-6, "roll {i} by {direction}: {off:e}");
                    }
                    let share = |set: &FlankContacts, i: usize| set.section(&set.contacts[i]).share;
                    let whole = here.along_teeth.share;
                    partly += usize::from(section.share < whole - 1e-9);
                    let off = differ(i, &share) - section.share_gradient[direction];
                    assert!(off.abs() < 1e-4, "share {i} by {direction}: {off:e}");
                }
            }
        }
        assert_eq!(partly > 10, ends == PathEnds::LineOfAction, "{partly}");
    }
}

/// The second derivative of the gap: what is left out falls with the tilt.
#[test]
fn the_curvature_is_right_to_first_order_of_the_tilt() {
    for pair in [
        helical_pair(24.0),
        ring_pair(15.0, false),
        ring_pair(15.0, true),
    ] {
        check_curvature(&pair);
    }
}

fn check_curvature(pair: &GearPair) {
    let kinematics = kinematics(pair);
    let side = Flank::Right;
    let worst = |tilt_rad: f64| {
        let tilt = Vector3::new(tilt_rad, -0.7 * tilt_rad, 0.0);
        let phi = angles(pair, side, 0.08, -5e-6);
        let at = pose(pair, phi, Vector3::new(1e-4, 2e-4, 5e-4), tilt);
        let contacts = |at: &Pose| {
            let mut found = FlankContacts::default();
            let (at, planes) = kinematics.contacts(at, side, &mut found).unwrap();
            (found, at, planes)
        };
        let (here, at_here, planes) = contacts(&at);
        let mut worst: f64 = 0.0;
        for direction in 0..6 {
            let h = 1e-7;
            let mut step = Vector6::zeros();
            step[direction] = h;
            let (after, before) = (
                contacts(&moved(&at, &step)).0,
                contacts(&moved(&at, &-step)).0,
            );
            for (i, contact) in here.contacts.iter().enumerate() {
                let section = here.section(contact);
                if (0..2).any(|gear| !section.walks(gear)) {
                    continue;
                }
                let change = (after.contacts[i].gradient - before.contacts[i].gradient) / (2.0 * h);
                let roll_rad = section.roll_rad;
                let placed = (&at_here, &planes);
                let curvature = kinematics.gap_curvature(placed, contact.slice, side, roll_rad);
                let off = change - curvature.column(direction);
                worst = worst.max(off.norm() / (1e-3 + change.norm()));
            }
        }
        worst
    };
    let [none, some, more] = [0.0, 1e-4, 1e-3].map(worst);
    println!("{none:e} {some:e} {more:e}");
    // Over the least of all changes of the gradient, that with the axial displacement.
    assert!(none < 1e-6 && more < 0.05, "{none:e} {some:e} {more:e}");
    assert!((8.0..12.0).contains(&(more / some)), "{some:e} {more:e}");
}

/// Helices that do not fit, no slices, and faces that do not overlap are refused with what to do.
#[test]
fn impossible_helices_are_refused() {
    let pair = helical_pair(20.0);
    let new = |gear_2: &ToothGeometry, layout: SliceLayout| {
        let gears = [pair.gear_1.clone(), gear_2.clone()];
        let none = [Vec::new(), Vec::new()];
        let a = pair.centre_distance_m;
        let made = MeshKinematics::new(gears, none, a, layout, PathEnds::Extended);
        made.err().map(|error| error.to_string())
    };
    let same_hand = new(&pair.gear_1, layout(SLICES)).unwrap();
    assert!(same_hand.contains("opposite hand"), "{same_hand}");
    let none = new(&pair.gear_2, layout(0)).unwrap();
    assert!(none.contains("list of slices"), "{none}");
    let apart = new(&pair.gear_2, SliceLayout::new([20e-3, 12e-3], -16e-3, 3)).unwrap();
    assert!(apart.contains("side by side"), "{apart}");
    assert!(new(&pair.gear_2, layout(1)).is_none());
}
