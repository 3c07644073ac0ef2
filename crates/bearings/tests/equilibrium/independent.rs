//! Equilibria against tools/reference/bearings.py, which shares no code with this workspace (scipy's roots of all
//! unknowns at once).

use crate::common::{B218, B6205, ROLLERS, bearing, close};
use gearmesh_bearings::quasi_static::RowLoads;
use gearmesh_bearings::{AppliedBearingLoad, TiltCondition};
use gearmesh_bearings::{Operation, RingPose};

const FREE: TiltCondition = TiltCondition::Moments([0.0; 2]);

fn rest_under(
    text: &str,
    force_n: [f64; 3],
    tilt: TiltCondition,
    rpm: f64,
) -> (RingPose, RowLoads) {
    let bearing = bearing(text);
    let operation = Operation {
        inner_rad_per_s: rpm * std::f64::consts::PI / 30.0,
        ..Operation::default()
    };
    let load = AppliedBearingLoad { force_n, tilt };
    let pose = bearing
        .equilibrium(&load, &operation)
        .unwrap_or_else(|e| panic!("{e}"));
    let (ring, loads) = bearing.loads(&pose, &operation).unwrap();
    // Cylindrical rollers carry no axial load: what tilted ones press out sideways is not balanced.
    let balanced = if bearing.locates { 3 } else { 2 };
    for (found, applied) in ring.load.iter().zip(force_n).take(balanced) {
        assert!(
            (found + applied).abs() < 1e-8 * (1.0 + applied.abs()),
            "{ring:?}"
        );
    }
    (pose, loads)
}

/// REFERENCES §2: α 41.5019°, δ_a 0.036097 mm, Q 1678.88 N.
#[test]
fn the_218_under_thrust() {
    let (pose, loads) = rest_under(B218, [0.0, 0.0, 17800.0], FREE, 0.0);
    close(pose.centre_m.z, 36.097055628e-6, 1e-9);
    for ball in &loads.elements[0] {
        close(ball.inner_load_n, 1678.87935, 1e-8);
        close(ball.outer_load_n, 1678.87935, 1e-8);
        close(ball.inner_contact_angle_rad, 0.724344157, 1e-8);
        close(ball.inner_contact_angle_rad.to_degrees(), 41.5019, 1e-5);
    }
}

/// Load and angles of one ball by the reference; at 1e-6.
fn ball_is(load: &gearmesh_bearings::ElementLoad, expected: [f64; 5]) {
    let [q_i, q_o, angle_i, angle_o, centrifugal] = expected;
    for (found, expected) in [
        (load.inner_load_n, q_i),
        (load.outer_load_n, q_o),
        (load.inner_contact_angle_rad, angle_i),
        (load.outer_contact_angle_rad, angle_o),
        (load.centrifugal_n, centrifugal),
    ] {
        close(found, expected, 1e-6);
    }
}

#[test]
fn the_218_under_thrust_at_10000_rpm() {
    let (pose, loads) = rest_under(B218, [0.0, 0.0, 17800.0], FREE, 10000.0);
    close(pose.centre_m.z, 14.656374682e-6, 1e-6);
    let ball = &loads.elements[0][5];
    ball_is(
        ball,
        [1452.06997, 1924.1603, 0.872825208, 0.545604062, 642.406882],
    );
    close(ball.gyroscopic_nm, 1.48215023, 1e-6);
    // The invariants of REFERENCES §2; the outer race carries the whole gyroscopic moment, so that the inner loads
    // alone balance the thrust.
    let rest = 0.724344157;
    assert!(ball.outer_contact_angle_rad < rest && rest < ball.inner_contact_angle_rad);
    assert!(ball.inner_load_n < 1678.87 && ball.outer_load_n > 1678.88);
    close(
        16.0 * ball.inner_load_n * ball.inner_contact_angle_rad.sin(),
        17800.0,
        1e-9,
    );
}

#[test]
fn the_218_under_a_combined_load_at_6000_rpm() {
    let moments = TiltCondition::Moments([50.0, -80.0]);
    let (pose, loads) = rest_under(B218, [4000.0, 1000.0, 17800.0], moments, 6000.0);
    let q = pose.to_five();
    for (found, expected) in q.iter().zip([
        79.996665753e-6,
        3.839049728e-6,
        28.100748174e-6,
        -0.021301521e-3,
        1.319007242e-3,
    ]) {
        close(*found, expected, 1e-6);
    }
    let balls = &loads.elements[0];
    ball_is(
        &balls[0],
        [2437.89891, 2605.42436, 0.643270563, 0.577339146, 206.0017],
    );
    ball_is(
        &balls[11],
        [1148.68636, 1303.87028, 0.848532662, 0.679269746, 220.686807],
    );
}

#[test]
fn a_deep_groove_bearing_under_radial_load() {
    let held = TiltCondition::Held([0.0; 2]);
    let (pose, loads) = rest_under(B6205, [2000.0, 0.0, 0.0], held, 0.0);
    close(pose.centre_m.x, 23.411180963e-6, 1e-6);
    close(loads.elements[0][0].inner_load_n, 975.182897, 1e-6);
    close(loads.elements[0][1].inner_load_n, 653.516054, 1e-6);
    assert_eq!(loads.elements[0][4].inner_load_n, 0.0);
    let loose = format!("{B6205}radial_clearance_um = 15.0\n");
    let (pose, loads) = rest_under(&loose, [2000.0, 0.0, 0.0], held, 0.0);
    close(pose.centre_m.x, 32.252533714e-6, 1e-6);
    close(loads.elements[0][0].inner_load_n, 1060.25153, 1e-6);
    close(loads.elements[0][1].inner_load_n, 613.925035, 1e-6);
    assert_eq!(loads.elements[0][2].inner_load_n, 0.0);
}

#[test]
fn a_deep_groove_bearing_under_forces_and_moments() {
    let loose = format!("{B6205}radial_clearance_um = 10.0\n");
    let moments = TiltCondition::Moments([3.0, -4.0]);
    let (pose, loads) = rest_under(&loose, [1500.0, 500.0, 800.0], moments, 0.0);
    for (found, expected) in pose.to_five().iter().zip([
        20.115790988e-6,
        1.782540751e-6,
        111.984702639e-6,
        0.190825326e-3,
        2.206925476e-3,
    ]) {
        close(*found, expected, 1e-6);
    }
    let balls = &loads.elements[0];
    ball_is(
        &balls[0],
        [812.797663, 812.797657, 0.167114599, 0.164907655, 0.0],
    );
    ball_is(
        &balls[5],
        [98.9495945, 98.9495939, 0.384439847, 0.386448485, 0.0],
    );
}

/// Load at the inner and outer race and the largest lamina's line load in N/mm of some rollers; at 1e-6.
fn rollers_are(loads: &RowLoads, expected: &[(usize, [f64; 3])]) {
    for &(number, [inner, outer, largest]) in expected {
        let roller = &loads.elements[0][number];
        close(roller.inner_load_n, inner, 1e-6);
        close(roller.outer_load_n, outer, 1e-6);
        close(roller.inner_line_load_n_per_m, 1e3 * largest, 1e-6);
    }
    assert_eq!(loads.elements[0][6].inner_load_n, 0.0);
}

#[test]
fn a_cylindrical_roller_bearing_without_and_with_tilt() {
    let force = [4000.0, 1000.0, 0.0];
    let (pose, loads) = rest_under(ROLLERS, force, TiltCondition::Held([0.0; 2]), 0.0);
    close(pose.centre_m.x, 18.145394464e-6, 1e-6);
    close(pose.centre_m.y, 4.440961552e-6, 1e-6);
    rollers_are(
        &loads,
        &[
            (0, [1560.56937, 1560.56931, 228.693664]),
            (2, [765.746584, 765.746336, 130.102644]),
        ],
    );

    let held = TiltCondition::Held([0.8e-3, -1.5e-3]);
    let (pose, loads) = rest_under(ROLLERS, force, held, 0.0);
    close(pose.centre_m.x, 17.807904495e-6, 1e-6);
    close(pose.centre_m.y, 4.118049884e-6, 1e-6);
    rollers_are(
        &loads,
        &[
            (0, [1553.43899, 1553.43717, 258.816624]),
            (11, [856.48904, 856.488402, 151.885988]),
        ],
    );
    let (ring, _) = bearing(ROLLERS)
        .loads(&pose, &Operation::default())
        .unwrap();
    for (found, expected) in
        ring.load
            .iter()
            .skip(2)
            .zip([-6.8000066, -1.294355109, 3.864861074, 0.001150357])
    {
        close(*found, expected, 1e-6);
    }

    let moments = TiltCondition::Moments([1.5, 4.0]);
    let (pose, loads) = rest_under(ROLLERS, force, moments, 0.0);
    let q = pose.to_five();
    for (place, expected) in [
        (0, 17.017657406e-6),
        (1, 5.402749912e-6),
        (3, 1.933260719e-3),
        (4, 2.068590212e-3),
    ] {
        close(q[place], expected, 1e-6);
    }
    rollers_are(
        &loads,
        &[
            (0, [1478.74646, 1478.74324, 270.76724]),
            (3, [136.024514, 136.024221, 49.6698491]),
        ],
    );
}
