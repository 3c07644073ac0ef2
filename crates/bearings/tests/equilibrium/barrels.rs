//! Spherical roller bearings: independent figures are those of tools/reference/bearing_types.py, which seeks the least
//! energy of ring and rollers together and shares no code with the workspace.

use crate::common::{close, definition};
use gearmesh_bearings::definition::BearingGeometry;
use gearmesh_bearings::{
    AppliedBearingLoad, Life, Operation, QuasiStaticBearing, Ratings, RingPose, TiltCondition,
};
use nalgebra::{Vector3, Vector5};

/// Of the size of a 22220.
pub const BARRELS: &str = r#"
name = "spherical"
kind = "spherical-roller"
rollers = 19
roller_diameter_mm = 23.0
roller_length_mm = 17.0
pitch_diameter_mm = 140.0
contact_angle_deg = 9.0
radial_clearance_um = 40.0
"#;

/// Force, place in µm, loads of the second roller of both rows at inner and outer race.
type Case = ([f64; 3], [f64; 3], [f64; 2], [f64; 2]);

const CASES: [Case; 2] = [
    (
        [40_000.0, 5000.0, 2000.0],
        [48.727103603, 6.135501483, 24.992756722],
        [4236.18778, 4236.17621],
        [6650.54137, 6650.52417],
    ),
    (
        [3000.0, 1000.0, 30_000.0],
        [0.963239838, 0.321079946, 388.930516459],
        [0.0; 2],
        [10274.8701, 10274.8502],
    ),
];

const HELD: TiltCondition = TiltCondition::Held([0.0; 2]);

#[test]
fn spherical_bearings_bear_as_the_independent_ones() {
    let bearing = QuasiStaticBearing::new(&definition(BARRELS)).unwrap();
    for (force_n, expected, first, second) in CASES {
        let load = AppliedBearingLoad {
            force_n,
            tilt: HELD,
        };
        let pose = bearing.equilibrium(&load, &Operation::default()).unwrap();
        let (_, loads) = bearing.loads(&pose, &Operation::default()).unwrap();
        for (found, expected) in pose.centre_m.iter().zip(expected) {
            assert!(
                (1e6 * found - expected).abs() < 1e-6 * (1.0 + expected.abs()),
                "{pose:?}"
            );
        }
        close(loads.elements[0][1].inner_load_n, first[0], 1e-6);
        close(loads.elements[0][1].outer_load_n, first[1], 1e-6);
        close(loads.elements[1][1].inner_load_n, second[0], 1e-6);
        close(loads.elements[1][1].outer_load_n, second[1], 1e-6);
    }
}

/// The outer ring is a sphere: no moment about its middle, whatever the place and the tilt; loads do not depend on the
/// tilt; without load nothing resists it.
#[test]
fn spherical_bearings_align_themselves() {
    let bearing = QuasiStaticBearing::new(&definition(BARRELS)).unwrap();
    assert!(bearing.aligns());
    let rest = Operation::default();
    let place = Vector3::new(60e-6, -20e-6, 90e-6);
    let straight = RingPose {
        centre_m: place,
        ..RingPose::default()
    };
    let straight = bearing.evaluate(&straight, &rest).unwrap();
    let size = straight.load.fixed_rows::<3>(0).norm();
    assert!(size > 1e4);
    for tilt in [[0.0, 0.0], [5e-3, 0.0], [-20e-3, 30e-3]] {
        let mut pose = RingPose::from_five(&Vector5::new(0.0, 0.0, 0.0, tilt[0], tilt[1]));
        // The same place seen from the ring.
        let axis = pose.axis;
        let turn = |v: Vector3<f64>| {
            let k = Vector3::z().cross(&axis);
            v + k.cross(&v) + k.cross(&k.cross(&v)) / (1.0 + axis.z)
        };
        pose.centre_m = turn(place);
        let ring = bearing.evaluate(&pose, &rest).unwrap();
        let force: Vector3<f64> = ring.load.fixed_rows::<3>(0).into();
        let moment: Vector3<f64> = ring.load.fixed_rows::<3>(3).into();
        // About the sphere's middle, which the ring's middle sees at minus its place; but for what is taken away about
        // the ring's own axis.
        let about = moment + pose.centre_m.cross(&force);
        let across = about - axis * axis.dot(&about);
        assert!(across.norm() < 1e-13 * size, "{about}");
        let straight: Vector3<f64> = straight.load.fixed_rows::<3>(0).into();
        assert!((force - turn(straight)).norm() < 1e-9 * size);
    }
    // Stiffness against tilt is what the force does over the ring's displacement, nothing else: about 1e4 N times 0.1
    // mm.
    let tilt_stiffness = straight.tangent.fixed_view::<2, 2>(3, 3).norm();
    assert!(
        tilt_stiffness < 2.0 * size * place.norm(),
        "{tilt_stiffness}"
    );
    let load = AppliedBearingLoad {
        force_n: [1e4, 0.0, 0.0],
        tilt: TiltCondition::Moments([10.0, 0.0]),
    };
    let refused = bearing.equilibrium(&load, &rest).unwrap_err();
    assert!(refused.to_string().contains("carries no moment"));
    let empty = bearing.evaluate(
        &RingPose::from_five(&Vector5::new(0.0, 0.0, 0.0, 9e-3, 0.0)),
        &rest,
    );
    assert_eq!(empty.unwrap().load.norm(), 0.0);
}

/// ISO 281: b_m 1.15; P = F_r + 0.45 cot α F_a up to e = 1.5 tan α, 0.67 (F_r + cot α F_a) above. Life of the true
/// loads: shorter with more load.
#[test]
fn ratings_of_spherical_bearings_are_those_of_the_standard() {
    let made = definition(BARRELS);
    let ratings = Ratings::of(&made);
    let mut straight = made.clone();
    if let BearingGeometry::Roller(g) = &mut straight.geometry {
        g.barrel = None;
    }
    // Without its contact angle only cos α and γ differ: a check of 1.15 over 1.1 to their size.
    close(
        ratings.dynamic_n / Ratings::of(&straight).dynamic_n,
        1.15 / 1.1,
        0.02,
    );
    let bearing = QuasiStaticBearing::new(&made).unwrap();
    let tangent = 9.0_f64.to_radians().tan();
    let mut before = f64::INFINITY;
    for (force_n, expected) in [
        ([20e3, 0.0, 4e3], 20e3 + 0.45 / tangent * 4e3),
        ([20e3, 0.0, 6e3], 0.67 * (20e3 + 6e3 / tangent)),
    ] {
        let load = AppliedBearingLoad {
            force_n,
            tilt: HELD,
        };
        let pose = bearing.equilibrium(&load, &Operation::default()).unwrap();
        let (_, loads) = bearing.loads(&pose, &Operation::default()).unwrap();
        let life = Life::of(&made, &loads, force_n, &Operation::default(), None);
        close(life.equivalent_n.unwrap(), expected, 1e-12);
        assert!(life.reference_mrev < before && life.reference_mrev > 0.0);
        before = life.reference_mrev;
    }
    // Rolling: γ = D cos α/d_m.
    let cage = made.rolling_sizes().frequencies(1.0, 0.0).cage_hz;
    close(
        cage,
        0.5 * (1.0 - 23.0 / 140.0 * 9.0_f64.to_radians().cos()),
        1e-12,
    );
}
