//! A ball or roller that is not there: the row without it, and what the others carry then.

use std::f64::consts::{PI, TAU};

use gearmesh_bearings::bearing_file::BearingFromFile;
use gearmesh_bearings::ring_equilibrium::{AppliedBearingLoad, TiltCondition};
use gearmesh_bearings::{Life, Operation, QuasiStaticBearing, RingPose};
use gearmesh_geometry::input::InputDocument;
use nalgebra::{Vector3, Vector5};

use crate::common::{
    B218, B6205, PAIR, ROLLERS, TAPERED, bearing, close, definition, life_of_balls, on_springs,
};

fn without(text: &str, element: usize) -> String {
    format!("{text}[[fault]]\nkind = \"missing\"\nelement = {element}\n")
}

/// At a place of the ring the others carry what they carried, and the ring lacks that one's force alone: Q (cos α e_r +
/// sin α e_z).
#[test]
fn the_ring_lacks_that_element_and_nothing_else() {
    let operation = Operation {
        inner_rad_per_s: 200.0,
        cage_angle_rad: 0.3,
        ..Operation::default()
    };
    for (text, q) in [
        (B218, [10e-6, -6e-6, 30e-6, 1e-4, -2e-4]),
        (B6205, [12e-6, 5e-6, 8e-6, 1e-4, 3e-4]),
        (PAIR, [6e-6, 2e-6, 3e-6, -1e-4, 1e-4]),
        (ROLLERS, [12e-6, 4e-6, 0.0, 2e-4, 1e-4]),
    ] {
        let pose = RingPose::from_five(&Vector5::from(q));
        let (whole, all) = bearing(text).loads(&pose, &operation).unwrap();
        let (ring, rest) = bearing(&without(text, 1)).loads(&pose, &operation).unwrap();
        assert_eq!(rest.elements[0][0].outer_load_n, 0.0);
        assert_eq!(rest.elements[0][1..], all.elements[0][1..]);
        assert_eq!(rest.elements[1..], all.elements[1..]);
        assert_eq!(rest.laminae[0].len(), all.laminae[0].len());
        let gone = all.elements[0][0];
        assert!(gone.inner_load_n > 10.0, "{text}: {gone:?}");
        let (sine, cosine) = gone.inner_contact_angle_rad.sin_cos();
        let (y, x) = gone.angle_rad.sin_cos();
        let expected = -gone.inner_load_n * Vector3::new(cosine * x, cosine * y, sine);
        let lacking = (whole.load - ring.load).fixed_rows::<3>(0).into_owned();
        // The normal lies in the tilted ring's axial plane: 3e-4 rad off.
        assert!(
            (lacking - expected).norm() < 2e-3 * expected.norm(),
            "{text}: {lacking} {expected}"
        );
    }
    let pose = RingPose::from_five(&Vector5::new(0.0, 0.0, 10e-6, 0.0, 0.0));
    let (whole, all) = bearing(TAPERED).loads(&pose, &operation).unwrap();
    let (ring, _) = bearing(&without(TAPERED, 4))
        .loads(&pose, &operation)
        .unwrap();
    // Under thrust all rollers carry alike: the axial force lacks a seventeenth.
    close(ring.load[2], whole.load[2] * 16.0 / 17.0, 1e-9);
    assert_eq!(all.elements[0].len(), 17);
}

/// Radial load on a 6205, whole and without its loaded ball, against a solver of its own; so is the life that the
/// lack costs.
#[test]
fn loads_of_the_others_against_springs_in_a_plane() {
    let load = AppliedBearingLoad {
        force_n: [30.0, 4.0, 0.0],
        tilt: TiltCondition::Held([0.0; 2]),
    };
    let lives = [None, Some(0)].map(|missing| {
        let text = missing.map_or(B6205.to_owned(), |ball| without(B6205, ball + 1));
        let (place, loads) = on_springs(B6205, load.force_n, 0.0, missing);
        let own = bearing(&text);
        let pose = own.equilibrium(&load, &Operation::default()).unwrap();
        let (_, found) = own.loads(&pose, &Operation::default()).unwrap();
        // The ring's own curve leaves out (a micrometre)² over its radius.
        close(pose.centre_m.x, place.x, 2e-4);
        close(pose.centre_m.y, place.y, 2e-4);
        for (found, expected) in found.elements[0].iter().zip(&loads) {
            assert!(
                (found.inner_load_n - expected).abs() < 5e-4 * 30.0,
                "{found:?} {expected}"
            );
        }
        let still = Operation::default();
        let life = Life::of(&definition(&text), &found, load.force_n, &still, None);
        // Loads are within 5e-4, lives go with their third power.
        close(life.reference_mrev, life_of_balls(B6205, &loads), 2e-3);
        life.reference_mrev
    });
    assert!(lives[1] < lives[0], "{lives:?}");
}

/// As the cage goes round, the place of the ring repeats after a ball's pitch in a whole row, after a turn of the cage
/// without one ball: lines at FTF.
#[test]
fn the_compliance_varies_once_a_turn_of_the_cage() {
    let amplitude = |bearing: &QuasiStaticBearing, order: usize| {
        let count = 72;
        let (mut cosine, mut sine) = (0.0, 0.0);
        for step in 0..count {
            let angle = TAU * f64::from(step) / f64::from(count);
            let operation = Operation {
                cage_angle_rad: angle,
                ..Operation::default()
            };
            let load = AppliedBearingLoad {
                force_n: [500.0, 0.0, 0.0],
                tilt: TiltCondition::Held([0.0; 2]),
            };
            let x = bearing.equilibrium(&load, &operation).unwrap().centre_m.x;
            cosine += x * (order as f64 * angle).cos();
            sine += x * (order as f64 * angle).sin();
        }
        2.0 * f64::hypot(cosine, sine) / f64::from(count)
    };
    let (whole, missing) = (bearing(B6205), bearing(&without(B6205, 3)));
    let passing = amplitude(&whole, 9);
    assert!(passing > 1e-8 && amplitude(&whole, 1) < 1e-6 * passing);
    assert!(amplitude(&missing, 1) > 10.0 * passing);
    // Held at the angle where the gap meets the load the ring sinks deepest.
    let at = |cage_angle_rad: f64| {
        let operation = Operation {
            cage_angle_rad,
            ..Operation::default()
        };
        let load = AppliedBearingLoad {
            force_n: [500.0, 0.0, 0.0],
            tilt: TiltCondition::Held([0.0; 2]),
        };
        missing.equilibrium(&load, &operation).unwrap().centre_m.x
    };
    let gap = -2.0 * TAU / 9.0;
    assert!(at(gap) > 1.05 * at(gap + PI));
}

#[test]
fn faults_of_missing_elements_are_checked() {
    let complaint = |text: &str| {
        let document = InputDocument::new("b.toml", text);
        BearingFromFile::from_document(&document)
            .unwrap_err()
            .to_string()
    };
    for (text, parts) in [
        (without(B6205, 10), ["fault.0.element: found 10", "1 to 9"]),
        (without(ROLLERS, 0), ["fault.0.element: found 0", "1 to 12"]),
        (
            without(&without(B6205, 2), 2),
            ["fault.1.element", "says that it is missing"],
        ),
        (
            format!(
                "{}[[fault]]\nkind = \"off-size-ball\"\nball = 2\noversize_um = 1.0\n",
                without(B6205, 2)
            ),
            ["fault.1.ball", "is missing"],
        ),
        (
            (1..9).fold(B6205.to_owned(), |text, ball| without(&text, ball)),
            ["fault.7.element", "fewer than two"],
        ),
    ] {
        let found = complaint(&text);
        for part in parts {
            assert!(found.contains(part), "`{part}` is not in: {found}");
        }
    }
}
