//! Gaps of any pair at any pose, looked at from elsewhere: mirrored, turned over, some teeth further on, and slid along
//! the axes. Exchange of the gears is in exchange.rs, with the loads.

use gearmesh_contact::SliceLayout;
use gearmesh_drivetrain::flank_contacts::FlankContacts;
use gearmesh_drivetrain::pose::Vector6;
use gearmesh_drivetrain::{MeshKinematics, PathEnds, Pose};
use gearmesh_geometry::definition::ToothDefinition;
use gearmesh_geometry::{Flank, GearPair, ToothGeometry};
use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;

use crate::mesh_common::*;
use crate::property_cases::cases;

/// A pair at a pose near contact.
#[derive(Debug, Clone)]
struct Case {
    teeth: [usize; 2],
    shifts: [f64; 2],
    helix_deg: f64,
    offset_m: [f64; 3],
    tilt_rad: [f64; 2],
    theta_rad: f64,
    depth_m: f64,
    ends: PathEnds,
    side: Flank,
}

fn any_case() -> impl Strategy<Value = Case> {
    let pair = (
        [18usize..70, 18usize..70],
        [-0.2f64..0.5, -0.2f64..0.5],
        prop_oneof![Just(0.0), -28.0f64..28.0],
    );
    let pose = (
        [-1e-4f64..4e-4, -2e-4f64..2e-4, -1e-3f64..1e-3],
        [-1e-3f64..1e-3, -1e-3f64..1e-3],
        -6.0f64..6.0,
        -30e-6f64..30e-6,
        prop_oneof![Just(PathEnds::Extended), Just(PathEnds::LineOfAction)],
        prop_oneof![Just(Flank::Right), Just(Flank::Left)],
    );
    (pair, pose).prop_map(|(pair, pose)| Case {
        teeth: pair.0,
        shifts: pair.1,
        helix_deg: pair.2,
        offset_m: pose.0,
        tilt_rad: pose.1,
        theta_rad: pose.2,
        depth_m: pose.3,
        ends: pose.4,
        side: pose.5,
    })
}

/// A gap by what it is between: the teeth, the slice; and its gradient by gear 2's increments.
type Gap = ([usize; 2], usize, f64, Vector6);

impl Case {
    /// The pair; `hand` −1 for the mirrored one.
    fn pair(&self, hand: f64) -> Option<GearPair> {
        let gear = |i: usize, sense: f64| {
            ToothGeometry::new(&ToothDefinition {
                helix_angle_rad: hand * sense * self.helix_deg.to_radians(),
                ..pair_common::tooth(self.teeth[i], self.shifts[i], 0.0)
            })
            .ok()
        };
        let (gear_1, gear_2) = (gear(0, 1.0)?, gear(1, -1.0)?);
        let shifts = 3e-3 * (self.shifts[0] + self.shifts[1]);
        let centre = gear_1.reference_radius_m + gear_2.reference_radius_m + shifts;
        GearPair::new(gear_1, gear_2, centre, Default::default()).ok()
    }

    fn pose(&self, pair: &GearPair) -> Pose {
        let [phi_1, phi_2] = angles(pair, self.side, self.theta_rad, -self.depth_m);
        let tilt = Vector3::new(self.tilt_rad[0], self.tilt_rad[1], 0.0);
        let screw = screw_rad(pair, self.offset_m[2]);
        pose(pair, [phi_1, phi_2 + screw], self.offset_m.into(), tilt)
    }

    /// All gaps, in order of teeth and slice.
    fn gaps(&self, pair: &GearPair, at: &Pose, side: Flank) -> Vec<Gap> {
        let gears = [pair.gear_1.clone(), pair.gear_2.clone()];
        let layout = SliceLayout::new([WIDTH; 2], 0.0, SLICES);
        let none = [Vec::new(), Vec::new()];
        let kinematics =
            MeshKinematics::new(gears, none, pair.centre_distance_m, layout, self.ends).unwrap();
        let mut found = FlankContacts::default();
        kinematics.contacts(at, side, &mut found).unwrap();
        let mut gaps: Vec<Gap> = found
            .contacts
            .iter()
            .map(|c| (found.lines[c.line].teeth, c.slice, c.gap_m, c.gradient))
            .collect();
        gaps.sort_by_key(|gap| (gap.0, gap.1));
        gaps
    }
}

/// Gradients of loads and displacements by a change of axes; `handed` −1 where turns change their sense.
fn seen(gradient: &Vector6, axes: &Matrix3<f64>, handed: f64) -> Vector6 {
    let force = axes * gradient.fixed_rows::<3>(0);
    let moment = handed * axes * gradient.fixed_rows::<3>(3);
    Vector6::from_iterator(force.iter().chain(moment.iter()).copied())
}

/// The same teeth, slices, gaps and gradients. Pairs at the very end of the path may be there or not.
fn same(found: &[Gap], expected: &[Gap]) -> Result<(), TestCaseError> {
    let named = |gaps: &[Gap]| gaps.iter().map(|g| (g.0, g.1)).collect::<Vec<_>>();
    prop_assert_eq!(named(found), named(expected));
    for (a, b) in found.iter().zip(expected) {
        prop_assert!(
            (a.2 - b.2).abs() < 1e-13,
            "{:?} slice {}: {:e} and {:e} m",
            a.0,
            a.1,
            a.2,
            b.2
        );
        let off = (a.3 - b.3).norm();
        // Seen per radian as well: gaps in metres, radii below a tenth of a metre.
        prop_assert!(
            off < 1e-9,
            "{:?} slice {}: gradients {off:e} apart",
            a.0,
            a.1
        );
    }
    Ok(())
}

fn diagonal(x: f64, y: f64, z: f64) -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::new(x, y, z))
}

proptest! {
    #![proptest_config(cases(150))]

    /// In a mirror, y to −y, hands and flanks change, and tooth k is tooth −k.
    #[test]
    fn a_mirrored_pair_has_the_same_gaps(case in any_case()) {
        let (pair, mirrored) = (case.pair(1.0), case.pair(-1.0));
        prop_assume!(pair.is_some() && mirrored.is_some());
        let (pair, mirrored) = (pair.unwrap(), mirrored.unwrap());
        let at = case.pose(&pair);
        let mirror = diagonal(1.0, -1.0, 1.0);
        let there = Pose::at_rest(mirror * at.displacement_m, mirror * at.rotation * mirror);
        let mut expected = case.gaps(&pair, &at, case.side);
        prop_assert!(!expected.is_empty() || case.depth_m < 0.0);
        for gap in &mut expected {
            gap.0 = [0, 1].map(|i: usize| (case.teeth[i] - gap.0[i]) % case.teeth[i]);
            gap.3 = seen(&gap.3, &mirror, -1.0);
        }
        expected.sort_by_key(|gap| (gap.0, gap.1));
        same(&case.gaps(&mirrored, &there, case.side.opposite()), &expected)?;
    }

    /// Turned over, z to −z about x: the hand stays, flanks change, slices come in the opposite order.
    #[test]
    fn a_pair_turned_over_has_the_same_gaps(case in any_case()) {
        let pair = case.pair(1.0);
        prop_assume!(pair.is_some());
        let pair = pair.unwrap();
        let at = case.pose(&pair);
        let over = diagonal(1.0, -1.0, -1.0);
        let there = Pose::at_rest(over * at.displacement_m, over * at.rotation * over);
        let mut expected = case.gaps(&pair, &at, case.side);
        for gap in &mut expected {
            gap.0 = [0, 1].map(|i: usize| (case.teeth[i] - gap.0[i]) % case.teeth[i]);
            gap.1 = SLICES - 1 - gap.1;
            gap.3 = seen(&gap.3, &over, 1.0);
        }
        expected.sort_by_key(|gap| (gap.0, gap.1));
        same(&case.gaps(&pair, &there, case.side.opposite()), &expected)?;
    }

    /// Both gears some whole pitches further about their own axes: the same gaps between the teeth before.
    #[test]
    fn teeth_are_alike(case in any_case(), pitches in [-80i64..80, -80i64..80]) {
        let pair = case.pair(1.0);
        prop_assume!(pair.is_some());
        let pair = pair.unwrap();
        let at = case.pose(&pair);
        let turns = [0, 1].map(|i: usize| {
            about(Vector3::z(), std::f64::consts::TAU * pitches[i] as f64 / case.teeth[i] as f64)
        });
        let back = turns[0].transpose();
        let there = Pose::at_rest(back * at.displacement_m, back * at.rotation * turns[1]);
        let mut expected = case.gaps(&pair, &at, case.side);
        for gap in &mut expected {
            gap.0 = [0, 1].map(|i: usize| (gap.0[i] as i64 - pitches[i]).rem_euclid(case.teeth[i] as i64) as usize);
            gap.3 = seen(&gap.3, &back, 1.0);
        }
        expected.sort_by_key(|gap| (gap.0, gap.1));
        same(&case.gaps(&pair, &there, case.side), &expected)?;
    }

    /// A spur gear that slides along its axis, parallel to the mate's, keeps its gaps.
    #[test]
    fn sliding_along_the_axes_changes_no_spur_gap(case in any_case(), slide_m in -2e-3f64..2e-3) {
        let case = Case { tilt_rad: [0.0; 2], helix_deg: 0.0, ..case };
        let pair = case.pair(1.0);
        prop_assume!(pair.is_some());
        let pair = pair.unwrap();
        let offset_m = [case.offset_m[0], case.offset_m[1], case.offset_m[2] + slide_m];
        let there = Case { offset_m, ..case.clone() };
        let first = case.gaps(&pair, &case.pose(&pair), case.side);
        let second = there.gaps(&pair, &there.pose(&pair), case.side);
        prop_assert_eq!(first.len(), second.len());
        for (a, b) in first.iter().zip(&second) {
            prop_assert!(a.0 == b.0 && (a.2 - b.2).abs() < 1e-13, "{:e} and {:e} m", a.2, b.2);
        }
    }
}
