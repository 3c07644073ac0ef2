//! Gaps, roll angles and their derivatives against the static scene's kinematics, against points on the flanks, and
//! against differences.

use crate::mesh_common;

use std::sync::Arc;

use gearmesh_contact::tip_contact::{TipContact, TipGear};
use gearmesh_contact::{
    ContactLine, ContactLines, FlankPlace, FlankSurface, InvoluteSurface, RelativeCurvature,
    SurfaceCurvature,
};
use gearmesh_drivetrain::errors::deviation_table::DeviationTable;
use gearmesh_drivetrain::errors::pitch::PitchErrors;
use gearmesh_drivetrain::flank_contacts::{FlankErrors, ToothContact};
use gearmesh_drivetrain::pose::Vector6;
use gearmesh_drivetrain::*;
use gearmesh_geometry::microgeometry::{ProfileCrowning, ReliefShape, TipRelief};
use gearmesh_geometry::{Flank, GearPair, Microgeometry, Misalignment};
use mesh_common::*;
use nalgebra::{Vector2, Vector3};

const SIDES: [Flank; 2] = [Flank::Right, Flank::Left];

fn microgeometry(gear: &gearmesh_geometry::ToothGeometry) -> Microgeometry {
    let span = gear.tip_roll_rad - gear.form_roll_rad;
    Microgeometry {
        tip_roll_rad: gear.tip_roll_rad,
        face_width_m: WIDTH,
        profile_crowning: Some(ProfileCrowning {
            amount_m: 8e-6,
            centre_roll_rad: gear.form_roll_rad + 0.5 * span,
        }),
        tip_relief: Some(TipRelief {
            amount_m: 20e-6,
            start_roll_rad: gear.form_roll_rad + 0.7 * span,
            shape: ReliefShape::Parabolic,
        }),
        lead_crowning_m: 5e-6,
        flank_angle_m: 3e-6,
        form_roll_rad: gear.form_roll_rad,
        ..Default::default()
    }
}

/// Half a turn of gear 1, where the polar angle of the tilted centre line is π in some slices and −π in others: 15
/// pitches, so that all is as at the start.
#[test]
fn half_a_turn_leaves_no_slice_behind() {
    let pair = spur_pair();
    assert_eq!(pair.gear_1.teeth % 2, 0);
    for side in SIDES {
        for tilt in [0.0, 1e-7, -1e-4] {
            let found = |turns: f64| {
                let [at, _] = angles(&pair, side, 0.0, 0.0);
                let theta = side.mirror() * at - turns * std::f64::consts::TAU;
                let phi = angles(&pair, side, theta, -10e-6);
                let at = pose(&pair, phi, Vector3::zeros(), Vector3::new(tilt, tilt, 0.0));
                let mut found = FlankContacts::default();
                let kinematics = kinematics(&pair);
                kinematics.contacts(&at, side, &mut found).unwrap();
                let gaps = found.contacts.iter().map(|c| (c.slice, c.gap_m));
                gaps.collect::<Vec<_>>()
            };
            let expected = found(0.0);
            assert!(expected.len() >= SLICES);
            for turns in [-0.5, 0.5, 1.5] {
                let at = found(turns);
                assert_eq!(at.len(), expected.len());
                for ((slice, gap), (of, other)) in at.iter().zip(&expected) {
                    let off = (gap - other).abs();
                    assert!(
                        slice == of && off < 1e-12,
                        "{turns} turns, tilt {tilt}: {off:e} m"
                    );
                }
            }
        }
    }
}

/// Flanks that a mesh does not look at because they are far apart do not touch, whatever is added to them.
#[test]
fn flanks_that_are_not_looked_at_are_open() {
    let pair = spur_pair();
    let hollow = |gear: &gearmesh_geometry::ToothGeometry| {
        let mut flank = microgeometry(gear);
        flank.profile_crowning.as_mut().unwrap().amount_m = -9e-6;
        flank.flank_angle_m = -12e-6;
        flank
    };
    let pitches = |side| {
        let removed = (0..pair.gear_2.teeth).map(|tooth| 7e-6 * (tooth as f64).sin());
        PitchErrors::new(side, removed.collect(), pair.gear_2.teeth).unwrap()
    };
    let lead = DeviationTable::new(&[], &[[-1e-2, -4e-6], [1e-2, 3e-6]]).unwrap();
    let (mut skipped, mut touching) = (0, 0);
    for side in SIDES {
        let errors: [FlankErrors; 2] = [
            vec![Arc::new(hollow(&pair.gear_1)), Arc::new(lead.clone())],
            vec![Arc::new(pitches(side))],
        ];
        let with_errors = kinematics_with(&pair, errors, PathEnds::Extended);
        let mut mesh = GearMesh::new(with_errors.clone(), side, impact()).unwrap();
        for (i, te_m) in (0..160).map(|i| (i, 1e-6 * (f64::from(i) - 20.0))) {
            let phi = angles(&pair, side, 0.37 * f64::from(i), te_m);
            let tilt = Vector3::new(1e-3 * f64::from(i % 5), -7e-4 * f64::from(i % 3), 0.0);
            let at = pose(&pair, phi, Vector3::new(2e-5, -1e-5, 3e-5), tilt);
            mesh.evaluate(&at, false).unwrap();
            let mut found = FlankContacts::default();
            with_errors.contacts(&at, side, &mut found).unwrap();
            let least = found
                .contacts
                .iter()
                .fold(1.0, |least: f64, c| least.min(c.gap_m));
            let (looked_at, _) = mesh.side(side).unwrap();
            assert_eq!(looked_at.open_gap_m.is_none(), !looked_at.lines.is_empty());
            touching += usize::from(least < 0.0);
            if let Some(gap_m) = looked_at.open_gap_m {
                skipped += 1;
                assert!(least > 0.0, "{least:e} m at {te_m:e} m");
                assert!((gap_m - found.lines[0].ideal_gap_m).abs() < 1e-15);
            }
        }
    }
    assert!(skipped > 50 && touching > 50, "{skipped}, {touching}");
}

/// Both kinematics see the same pairs, roll angles and gaps, on parallel axes and, to first order, on tilted ones.
#[test]
fn gaps_are_those_of_the_static_scene() {
    for (misalignment, tolerance) in [
        (Misalignment::default(), 1e-15),
        (
            Misalignment {
                inclination_rad: 2e-4,
                deviation_rad: -3e-4,
            },
            // Second order in the tilt: base radius times (3.6e-4)².
            8e-9,
        ),
    ] {
        let families = spur_families().map(|pair| SIDES.map(|side| (pair.clone(), side)));
        for (pair, side) in families.into_iter().flatten() {
            let pair = GearPair {
                misalignment,
                ..pair
            }
            .on_flanks(side);
            // On modified flanks the tilt also changes the roll angle, which the static scene leaves out.
            let modified = |gear| match misalignment == Misalignment::default() {
                true => microgeometry(gear),
                false => Microgeometry::default(),
            };
            let lines = ContactLines {
                microgeometry_1: modified(&pair.gear_1),
                microgeometry_2: modified(&pair.gear_2),
                extension: None,
                zone: gearmesh_contact::ContactZone::of_equal_faces(WIDTH),
                pair: pair.clone(),
            };
            let errors = [&lines.microgeometry_1, &lines.microgeometry_2]
                .map(|m| vec![Arc::new(m.clone()) as Arc<dyn FlankError>]);
            let kinematics = kinematics_with(&pair, errors, PathEnds::LineOfAction);
            // Gear 2 tilts about the pitch point: away from gear 1 with z, and across so that loaded flanks open with
            // z.
            let circles = pair.circles();
            let opens = 1f64.copysign(circles.sum_m()) * circles.hand(side);
            let tilt = Vector3::new(
                opens * misalignment.deviation_rad,
                misalignment.inclination_rad,
                0.0,
            );
            let mut seen = Vec::<ContactLine>::new();
            let mut found = FlankContacts::default();
            for k in 0..40 {
                // At TE = 0 both have the same roll angle on gear 2; the static scene always takes that one.
                let (theta, te) = (0.37 * f64::from(k), 0.0);
                lines.at(theta, &mut seen);
                let phi = angles(&pair, side, theta, te);
                let pitch_point = Vector3::new(
                    pair.centre_distance_m * circles.radii_m[0] / circles.sum_m(),
                    0.0,
                    0.0,
                );
                let from_axis_2 = pitch_point - Vector3::new(pair.centre_distance_m, 0.0, 0.0);
                let shift = from_axis_2 - about(tilt, 1.0) * from_axis_2;
                let at = pose(&pair, phi, shift, tilt);
                let (_, placed) = kinematics.contacts(&at, side, &mut found).unwrap();
                assert_eq!(found.lines.len(), seen.len(), "angle {theta}");
                for line in &found.lines {
                    let twin = seen
                        .iter()
                        .find(|l| [l.tooth_1, l.tooth_2] == line.teeth)
                        .unwrap_or_else(|| panic!("teeth {:?}", line.teeth));
                    // The same second order over the length of the line of action.
                    let roll_tolerance = 1e-12 + 100.0 * tolerance;
                    let roll_1_rad = found.sections[line.section].roll_rad[0];
                    assert!((roll_1_rad - twin.roll_1_rad).abs() < roll_tolerance);
                    let (first, count) = line.contacts;
                    assert_eq!(count, SLICES);
                    for contact in &found.contacts[first..first + count] {
                        let z = placed.planes[contact.slice].section_m;
                        let expected = lines.separation_m(twin, z) + te;
                        let off = contact.gap_m - expected;
                        assert!(off.abs() < tolerance + 1e-16, "{off:e} at {theta}, z {z}");
                    }
                }
            }
        }
    }
}

/// The gap is the distance of points: flank points at the roll angles found lie on one line, that far apart.
#[test]
fn flank_points_are_the_gap_apart() {
    let families = spur_families().map(|pair| SIDES.map(|side| (pair.clone(), side)));
    for (pair, side) in families.into_iter().flatten() {
        let kinematics = kinematics(&pair);
        let mut found = FlankContacts::default();
        let phi = angles(&pair, side, 1.234, 40e-6);
        let shift = Vector3::new(0.3e-3, -0.2e-3, 0.0);
        let at = pose(&pair, phi, shift, Vector3::zeros());
        let (_, placed) = kinematics.contacts(&at, side, &mut found).unwrap();
        assert!(!found.lines.is_empty());
        for line in &found.lines {
            let point = |gear: usize, tooth: &gearmesh_geometry::ToothGeometry| {
                let turn = std::f64::consts::TAU * line.teeth[gear] as f64 / tooth.teeth as f64;
                let section = &found.sections[line.section];
                let side = pair.circles().side_of(gear, side);
                let p = tooth.flank_point_m(side, section.roll_rad[gear]);
                let (sin, cos) = (turn + phi[gear]).sin_cos();
                Vector2::new(cos * p[0] - sin * p[1], sin * p[0] + cos * p[1])
            };
            let centre = Vector2::new(pair.centre_distance_m + shift[0], shift[1]);
            let apart = centre + point(1, &pair.gear_2) - point(0, &pair.gear_1);
            assert!((apart.norm() - line.ideal_gap_m.abs()).abs() < 1e-14);
            // w in the world
            let plane = placed.planes[SLICES / 2];
            let normal = about(Vector3::z(), phi[0]) * plane.normal;
            let along = apart.dot(&normal.xy());
            assert!((along - line.ideal_gap_m).abs() < 1e-14, "{along}");
        }
    }
}

/// Gradients of gaps and roll angles, and the curvature of the gaps, against central differences.
#[test]
fn derivatives_agree_with_differences() {
    for pair in spur_families() {
        check_derivatives(&pair);
    }
}

fn check_derivatives(pair: &GearPair) {
    let errors = [&pair.gear_1, &pair.gear_2]
        .map(|g| vec![Arc::new(microgeometry(g)) as Arc<dyn FlankError>]);
    let kinematics = kinematics_with(pair, errors, PathEnds::Extended);
    let contacts = |at: &Pose, side| {
        let mut found = FlankContacts::default();
        kinematics.contacts(at, side, &mut found).unwrap();
        found
    };
    for (side, theta) in [
        (Flank::Right, 0.05),
        (Flank::Left, 0.13),
        (Flank::Right, 0.21),
    ] {
        let tilt = Vector3::new(3e-3, -2e-3, 0.0);
        let phi = angles(pair, side, theta, -5e-6);
        let at = pose(pair, phi, Vector3::new(1e-4, 2e-4, 1e-3), tilt);
        let here = contacts(&at, side);
        assert!(here.lines.len() >= 2 || theta < 0.1 || pair.has_ring());
        for direction in 0..6 {
            let h = 1e-7;
            let mut step = Vector6::zeros();
            step[direction] = h;
            let (after, before) = (
                contacts(&moved(&at, &step), side),
                contacts(&moved(&at, &-step), side),
            );
            for (i, contact) in here.contacts.iter().enumerate() {
                let gap = (after.contacts[i].gap_m - before.contacts[i].gap_m) / (2.0 * h);
                let off = gap - contact.gradient[direction];
                assert!(off.abs() < 2e-9, "gap {i} by {direction}: {off:e}");
                let section = here.section(contact);
                for gear in 0..2 {
                    let roll = |set: &FlankContacts| set.section(&set.contacts[i]).roll_rad[gear];
                    let off = (roll(&after) - roll(&before)) / (2.0 * h)
                        - section.roll_gradient[gear][direction];
                    assert!(off.abs() < 1e-7, "roll by {direction}: {off:e}");
                }
            }
        }
    }
}

/// The second derivative of the gap of ideal flanks: exact on parallel axes, displaced ones too; what is left out falls
/// with the tilt.
#[test]
fn the_curvature_is_right_to_first_order_of_the_tilt() {
    for pair in spur_families() {
        check_curvature(&pair);
    }
}

fn check_curvature(pair: &GearPair) {
    let ideal = kinematics(pair);
    let worst = |tilt_rad: f64| {
        let mut worst: f64 = 0.0;
        for side in SIDES {
            let phi = angles(pair, side, 0.05, -5e-6);
            let tilt = Vector3::new(tilt_rad, -0.7 * tilt_rad, 0.0);
            let at = pose(pair, phi, Vector3::new(1e-4, 2e-4, 1e-3), tilt);
            let found = |at: &Pose| {
                let mut found = FlankContacts::default();
                let (at, planes) = ideal.contacts(at, side, &mut found).unwrap();
                (found, at, planes)
            };
            let (base, at_base, planes) = found(&at);
            for direction in 0..6 {
                let h = 1e-7;
                let mut step = Vector6::zeros();
                step[direction] = h;
                let (after, before) = (found(&moved(&at, &step)).0, found(&moved(&at, &-step)).0);
                for (i, contact) in base.contacts.iter().enumerate() {
                    let section = base.section(contact);
                    if (0..2).any(|gear| !section.walks(gear)) {
                        continue;
                    }
                    let change =
                        (after.contacts[i].gradient - before.contacts[i].gradient) / (2.0 * h);
                    let roll_rad = section.roll_rad;
                    let placed = (&at_base, &planes);
                    let curvature = ideal.gap_curvature(placed, contact.slice, side, roll_rad);
                    let off = (change - curvature.column(direction)).norm();
                    worst = worst.max(off / (1.0 + change.norm()));
                }
            }
        }
        worst
    };
    let [none, some, more] = [0.0, 1e-4, 1e-3].map(worst);
    assert!(none < 1e-6 && more < 1e-2, "{none:e} {some:e} {more:e}");
    assert!((8.0..12.0).contains(&(more / some)), "{some:e} {more:e}");
}

/// Beyond the end of the path the parabola is the exact gap of the tip edge, to second order: its relative error falls
/// with the angle.
#[test]
fn tip_edges_have_the_exact_gap_to_second_order() {
    for pair in spur_families() {
        check_tip_edges(&pair);
    }
}

fn check_tip_edges(pair: &GearPair) {
    let kinematics = kinematics(pair);
    let sense = pair.gear_1.tip_direction();
    let pitch = pair.pitch_1_rad();
    let mut found = FlankContacts::default();
    for (tip, base) in [
        (TipGear::One, pair.roll_end_1_rad),
        (TipGear::Two, pair.roll_start_1_rad),
    ] {
        let mut errors = Vec::new();
        for share in [0.08, 0.04, 0.02] {
            let sign = if tip == TipGear::One { sense } else { -sense };
            let roll = base + sign * share * pitch;
            let theta = sense * (roll - pair.working_pressure_angle_rad.tan());
            let exact = match tip {
                TipGear::One => TipContact::new(pair, tip, roll, pair.roll_2_rad(roll)),
                TipGear::Two => TipContact::new(pair, tip, pair.roll_2_rad(roll), roll),
            };
            let phi = angles(pair, Flank::Right, theta, 0.0);
            let at = pose(pair, phi, Vector3::zeros(), Vector3::zeros());
            kinematics.contacts(&at, Flank::Right, &mut found).unwrap();
            let line = found.lines.iter().find(|l| l.teeth == [0, 0]).unwrap();
            let gap = found.contacts[line.contacts.0].gap_m;
            errors.push(gap / exact.gap_m - 1.0);
        }
        let [large, half, quarter] = errors[..] else {
            unreachable!()
        };
        assert!(large.abs() < 0.2, "{errors:?}");
        // c₁ δ + c₂ δ² and no constant: a parabola through the three goes through zero but for terms of the third
        // order. Of an edge in a ring c₁ all but vanishes, so that no single order shows.
        let at_zero = (large - 6.0 * half + 8.0 * quarter) / 3.0;
        assert!(
            at_zero.abs() < 0.1 * quarter.abs(),
            "{tip:?} {errors:?} {at_zero:e}"
        );
    }
}

/// Any number of turns, hunting teeth included: the pair is found from the angles alone.
#[test]
fn teeth_are_found_without_memory() {
    let pair = spur_pair();
    let kinematics = kinematics(&pair);
    let mut found = FlankContacts::default();
    for turn in [0i64, 1, 7, -3] {
        let theta = std::f64::consts::TAU * turn as f64;
        let phi = angles(&pair, Flank::Right, theta, 0.0);
        let at = pose(&pair, phi, Vector3::zeros(), Vector3::zeros());
        kinematics.contacts(&at, Flank::Right, &mut found).unwrap();
        let expected = (-30 * turn).rem_euclid(41) as usize;
        let at_pitch = found.lines.iter().find(|l| l.teeth[0] == 0).unwrap();
        assert_eq!(at_pitch.teeth[1], expected, "turn {turn}");
        assert!((at_pitch.ideal_gap_m).abs() < 1e-14);
    }
}

#[test]
fn impossible_poses_are_refused() {
    let pair = spur_pair();
    let kinematics = kinematics(&pair);
    let mut found = FlankContacts::default();
    let mut refuse = |shift: Vector3<f64>, tilt: Vector3<f64>| {
        let at = pose(&pair, [0.0; 2], shift, tilt);
        let refused = kinematics.contacts(&at, Flank::Right, &mut found);
        refused.unwrap_err().to_string()
    };
    let upside_down = refuse(Vector3::zeros(), Vector3::new(3.1, 0.0, 0.0));
    assert!(upside_down.contains("same way"), "{upside_down}");
    let tilted = refuse(Vector3::zeros(), Vector3::new(0.011, 0.0, 0.0));
    assert!(tilted.contains("11.00 mrad"), "{tilted}");
    let close = refuse(Vector3::new(-10e-3, 0.0, 0.0), Vector3::zeros());
    assert!(close.contains("base radii"), "{close}");
    let nan = refuse(Vector3::new(f64::NAN, 0.0, 0.0), Vector3::zeros());
    assert!(nan.contains("NaN"), "{nan}");
}

/// Flanks as surfaces: normals are across the points' differences, turn along the principal directions as the
/// curvatures say, the area is that between neighbouring points; where two flanks touch, the relative curvature across
/// the contact line is that of the mesh, along it none.
#[test]
fn involute_flanks_are_surfaces_with_the_curvature_of_the_mesh() {
    for (pair, side) in (spur_families().into_iter())
        .chain(helical_families())
        .flat_map(|pair| SIDES.map(|side| (pair.clone(), side)))
    {
        let surface = [0, 1].map(|gear: usize| InvoluteSurface {
            tooth: [&pair.gear_1, &pair.gear_2][gear],
            flank: pair.circles().side_of(gear, side),
        });
        let (u, v, h) = (0.5, 3e-3, 1e-6);
        let at = |u: f64, v: f64| FlankPlace { u, v };
        for surface in surface {
            let normal = surface.normal(at(u, v));
            let slope = |f: &dyn Fn(f64) -> Vector3<f64>| (f(h) - f(-h)) / (2.0 * h);
            let by_u = [
                slope(&|d| surface.point_m(at(u + d, v))),
                slope(&|d| surface.normal(at(u + d, v))),
            ];
            let by_v = [
                slope(&|d| surface.point_m(at(u, v + d))),
                slope(&|d| surface.normal(at(u, v + d))),
            ];
            assert!((normal.norm() - 1.0).abs() < 1e-14);
            assert!(normal.dot(&by_u[0]).abs() < 1e-10 && normal.dot(&by_v[0]).abs() < 1e-8);
            let area = by_u[0].cross(&by_v[0]).norm();
            assert!((surface.area(at(u, v)) / area - 1.0).abs() < 1e-8);
            // The normal into the material turns with a convex surface: dn = −κ dx in each principal direction.
            let curvature = surface.curvature(at(u, v));
            let second = normal.cross(&curvature.first);
            for [point, turn] in [by_u, by_v] {
                let [along, across] = curvature.principal_per_m;
                let expected = along * point.dot(&curvature.first) * curvature.first
                    + across * point.dot(&second) * second;
                let off = (turn + expected).norm();
                assert!(off <= 1e-7 * turn.norm(), "{off:e} of {turn}");
            }
        }
        // Gear 2 turned so that the flanks of tooth 0 face each other: normals opposite, one generator.
        let phi = angles(&pair, side, 0.1, 0.0);
        let here = pose(&pair, phi, Vector3::zeros(), Vector3::zeros());
        let mut found = FlankContacts::default();
        let kinematics = kinematics(&pair);
        let (_, placed) = kinematics.contacts(&here, side, &mut found).unwrap();
        let on_path = |c: &&ToothContact| (0..2).all(|gear| found.section(c).walks(gear));
        let contact = found.contacts.iter().find(on_path).unwrap();
        let section = found.section(contact);
        let normal: Vector3<f64> = contact.gradient.fixed_rows::<3>(0).into();
        // Towards the tip of gear 1 is across the line of action; of gear 2 the other way.
        let across = placed.planes[contact.slice].across;
        let curvatures = [0, 1].map(|gear: usize| {
            let place = at(section.touching_roll_rad[gear], contact.heights_m[gear]);
            let own = surface[gear].curvature(place);
            SurfaceCurvature {
                first: across,
                ..own
            }
        });
        let relative = RelativeCurvature::new(normal, curvatures);
        let [least, largest] = relative.principal_per_m;
        assert!((largest * section.radius_m - 1.0).abs() < 1e-12);
        assert!(least.abs() < 1e-12 * largest);
        assert!((relative.along_tangent(&across) / largest - 1.0).abs() < 1e-12);
        assert!(relative.along.dot(&normal).abs() < 1e-12);
    }
}
