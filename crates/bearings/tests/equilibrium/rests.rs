//! Where rings come to rest: loads for which Newton's method alone finds nothing, balls that a groove does not reach,
//! interference, the apex of tapered rollers.

use crate::common::{B6205, ROLLERS, TAPERED, bearing, close, definition, on_springs};
use gearmesh_bearings::quasi_static::{Row, RowLoads};
use gearmesh_bearings::{
    AppliedBearingLoad, BearingError, Control, Operation, QuasiStaticBearing, RingPose,
    TiltCondition,
};

/// Where the ring rests; what it carries there is the load, to 1e-8 of it.
fn rests(
    bearing: &QuasiStaticBearing,
    load: AppliedBearingLoad,
    operation: &Operation,
) -> (RingPose, RowLoads) {
    let pose = bearing
        .equilibrium(&load, operation)
        .unwrap_or_else(|e| panic!("{e}"));
    let (ring, loads) = bearing.loads(&pose, operation).unwrap();
    let [x, y, z] = load.force_n;
    let size = x.hypot(y).hypot(z);
    for (axis, force) in load.force_n.into_iter().enumerate() {
        // Cylindrical rollers hold nothing along the axis.
        if axis == 2 && !bearing.locates {
            continue;
        }
        let unbalanced = ring.load[axis] + force;
        assert!(
            unbalanced.abs() < 1e-8 * size,
            "axis {axis}: {unbalanced} N"
        );
    }
    if let TiltCondition::Moments(moments) = load.tilt {
        for (axis, moment) in moments.into_iter().enumerate() {
            let unbalanced = ring.load[3 + axis] + moment;
            let arm = bearing.rows[0].pitch_radius_m();
            assert!(
                unbalanced.abs() < 1e-8 * size * arm,
                "about {axis}: {unbalanced} N m"
            );
        }
    }
    (pose, loads)
}

fn free(force_n: [f64; 3], moment_nm: [f64; 2]) -> AppliedBearingLoad {
    AppliedBearingLoad {
        force_n,
        tilt: TiltCondition::Moments(moment_nm),
    }
}

/// Found by random trials: few balls or much play, a tilt that is free, forces and moments at once. Newton's method
/// alone stayed behind an edge of the energy; once it said that 1.6 % of the load unbalanced were an equilibrium.
#[test]
fn rings_rest_under_loads_that_few_balls_bear() {
    let ball_bearing =
        |kind: &str, sizes: &str| bearing(&format!("name = \"drawn\"\nkind = \"{kind}\"\n{sizes}"));
    let still = Operation::default();
    let three_steep = ball_bearing(
        "angular-contact",
        "balls = 3\nball_diameter_mm = 34.4\npitch_diameter_mm = 224.0\ninner_conformity = 0.52\nouter_conformity = 0.53\ncontact_angle_deg = 13.6",
    );
    rests(
        &three_steep,
        free([7800.0, 6800.0, 19_500.0], [-380.0, 160.0]),
        &still,
    );
    let three = ball_bearing(
        "deep-groove",
        "balls = 3\nball_diameter_mm = 15.6\npitch_diameter_mm = 71.0\ninner_conformity = 0.52\nouter_conformity = 0.53\nradial_clearance_um = 5.0",
    );
    rests(&three, free([-81.0, 16.0, -130.0], [0.0; 2]), &still);
    let loose = ball_bearing(
        "deep-groove",
        "balls = 10\nball_diameter_mm = 11.7\npitch_diameter_mm = 80.0\ninner_conformity = 0.52\nouter_conformity = 0.53\nradial_clearance_um = 225.0",
    );
    for angle in 0..12 {
        let (sine, cosine) = (0.1 + 0.05 * f64::from(angle)).sin_cos();
        let force = [28.0 * cosine, 28.0 * sine, 1.0];
        rests(&loose, free(force, [0.0; 2]), &still);
    }
}

/// The inner race may control no ball that it hardly presses; the outer one then leads it.
#[test]
fn lightly_pressed_balls_are_found_by_least_spin() {
    let pair = bearing(
        "name = \"drawn\"\nkind = \"angular-contact\"\nballs = 10\nball_diameter_mm = 20.4\npitch_diameter_mm = 93.0\ninner_conformity = 0.52\n\
         outer_conformity = 0.53\ncontact_angle_deg = 25.5\narrangement = \"X\"\nrow_distance_mm = 40.0",
    );
    for rad_per_s in [0.02, 0.5, 20.0] {
        let operation = Operation {
            inner_rad_per_s: rad_per_s,
            control: Control::LeastSpin,
            ..Operation::default()
        };
        let load = AppliedBearingLoad {
            force_n: [1236.0, 1451.0, 516.0],
            tilt: TiltCondition::Held([1.2e-3, -0.48e-3]),
        };
        rests(&pair, load, &operation);
    }
}

/// A groove is the half of a torus that faces the balls. With much play, or pushed far aside, a ring's torus would
/// reach over the balls on the other side, and press them from outside.
#[test]
fn grooves_do_not_reach_over_balls() {
    let tight = bearing(B6205);
    let held = TiltCondition::Held([0.0; 2]);
    let far = AppliedBearingLoad {
        force_n: [1e6, 0.0, 0.0],
        tilt: held,
    };
    let (pose, loads) = rests(&tight, far, &Operation::default());
    assert!(pose.centre_m.x > 1e-3);
    for ball in &loads.elements[0] {
        let towards = ball.angle_rad.cos() > 0.0;
        assert_eq!(ball.inner_load_n > 0.0, towards, "{ball:?}");
    }
    // 60 degrees of free contact angle: 0.4 mm of play.
    let loose = bearing(&format!("{B6205}radial_clearance_um = 396.0\n"));
    let turning = Operation {
        inner_rad_per_s: 25.0,
        ..Operation::default()
    };
    let load = AppliedBearingLoad {
        force_n: [1.6, -19.5, 0.0],
        tilt: held,
    };
    let (_, loads) = rests(&loose, load, &turning);
    for ball in &loads.elements[0] {
        let towards = 1.6 * ball.angle_rad.cos() - 19.5 * ball.angle_rad.sin() > 0.0;
        assert!(towards || ball.inner_load_n == 0.0, "{ball:?}");
    }
}

/// Interference presses every ball by P/2 at both races together, and the bearing is stiff without load.
#[test]
fn interference_presses_every_ball_alike() {
    let interference = 12e-6;
    let text = format!("{B6205}radial_clearance_um = -12.0\n");
    let pressed = bearing(&text);
    let still = Operation::default();
    let (ring, loads) = pressed.loads(&RingPose::default(), &still).unwrap();
    let Row::Ball(row) = &pressed.rows[0] else {
        panic!("no balls")
    };
    let soft = |k: f64| k.powf(-2.0 / 3.0);
    let both =
        soft(row.inner.contact.stiffness_n_per_m15) + soft(row.outer.contact.stiffness_n_per_m15);
    let expected = (0.5 * interference / both).powf(1.5);
    for ball in &loads.elements[0] {
        close(ball.inner_load_n, expected, 1e-9);
        close(ball.outer_load_n, expected, 1e-9);
        assert!(ball.inner_contact_angle_rad.abs() < 1e-12);
    }
    // Springs at equal angles: half the sum of theirs.
    let spring = 1.5 * expected / (0.5 * interference);
    close(-ring.tangent[(0, 0)], 4.5 * spring, 1e-2);
    // The same bearing told by its raceways.
    let (inner, outer) = match &definition(&text).geometry {
        gearmesh_bearings::definition::BearingGeometry::Ball(g) => {
            close(g.radial_clearance_m(), -interference, 1e-12);
            g.raceway_diameters_m()
        }
        _ => panic!("no balls"),
    };
    close(outer - inner, 2.0 * 7.938e-3 - interference, 1e-12);
    let by_raceways = bearing(&format!(
        "{B6205}raceway_diameters_mm = [{}, {}]\n",
        1e3 * inner,
        1e3 * outer
    ));
    let (_, same) = by_raceways.loads(&RingPose::default(), &still).unwrap();
    close(same.elements[0][0].inner_load_n, expected, 1e-6);
    // It moves less than the same bearing with play, both as springs in a plane do but for (a micrometre)² over the
    // ring's radius.
    let load = AppliedBearingLoad {
        force_n: [1000.0, 0.0, 0.0],
        tilt: TiltCondition::Held([0.0; 2]),
    };
    let (stiff, loads) = rests(&pressed, load, &still);
    let (soft, with_play) = rests(
        &bearing(&format!("{B6205}radial_clearance_um = 12.0\n")),
        load,
        &still,
    );
    for (pose, loads, play_m) in [(&stiff, &loads, -12e-6), (&soft, &with_play, 12e-6)] {
        let (place, on_balls) = on_springs(B6205, load.force_n, play_m, None);
        close(pose.centre_m.x, place.x, 1e-3);
        close(loads.elements[0][0].inner_load_n, on_balls[0], 1e-3);
    }
    assert!(stiff.centre_m.x < soft.centre_m.x);
}

/// Rollers without a profile: 35 948 L^{8/9} (P/2)^{10/9} (N, mm) each, ISO/TS 16281.
#[test]
fn interference_presses_every_roller_alike() {
    let text = ROLLERS.replace("radial_clearance_um = 10.0", "radial_clearance_um = -8.0");
    let pressed = bearing(&format!("{text}[profile]\nkind = \"straight\"\n"));
    let (_, loads) = pressed
        .loads(&RingPose::default(), &Operation::default())
        .unwrap();
    let expected = 35_948.0 * 9.0_f64.powf(8.0 / 9.0) * 4e-3_f64.powf(10.0 / 9.0);
    for roller in &loads.elements[0] {
        close(roller.inner_load_n, expected, 1e-9);
        close(roller.outer_load_n, expected, 1e-9);
    }
}

/// At speed rollers that the inner ring does not press lie on the outer race under their centrifugal force, and all
/// others press it by as much more.
#[test]
fn unpressed_rollers_press_the_outer_race() {
    let turning = Operation {
        inner_rad_per_s: 1500.0,
        ..Operation::default()
    };
    for clearance in ["0.0", "40.0"] {
        let loose = bearing(&ROLLERS.replace("um = 10.0", &format!("um = {clearance}")));
        let load = AppliedBearingLoad {
            force_n: [900.0, 200.0, 0.0],
            tilt: TiltCondition::Held([0.5e-3, 0.0]),
        };
        let (_, loads) = rests(&loose, load, &turning);
        let unpressed = loads.elements[0]
            .iter()
            .filter(|roller| roller.inner_load_n == 0.0);
        assert!(unpressed.count() > 3);
        for roller in &loads.elements[0] {
            assert!(roller.centrifugal_n > 10.0);
            close(
                roller.outer_load_n - roller.inner_load_n,
                roller.centrifugal_n,
                1e-3,
            );
        }
    }
}

/// Under a radial load a single row of tapered rollers needs thrust: with too little the ring slides out. Two minutes
/// went by before that was said (a fuzzed file).
#[test]
fn too_little_thrust_on_tapered_rollers_is_refused() {
    let row = bearing(TAPERED);
    let still = Operation::default();
    rests(&row, free([0.0, -1000.0, 500.0], [0.0; 2]), &still);
    for thrust_n in [50.0, -200.0, -2000.0] {
        let load = free([0.0, -1000.0, thrust_n], [0.0; 2]);
        let held = AppliedBearingLoad {
            tilt: TiltCondition::Held([0.0; 2]),
            ..load
        };
        for load in [load, held] {
            let error = row.equilibrium(&load, &still).unwrap_err().to_string();
            assert!(error.contains("an axial load towards +z"), "{error}");
        }
    }
}

/// Rollers and races of a tapered bearing have one apex on its axis.
#[test]
fn tapered_rollers_and_races_share_an_apex() {
    let tapered = bearing(&format!("{TAPERED}[profile]\nkind = \"straight\"\n"));
    let Row::Roller(row) = &tapered.rows[0] else {
        panic!("no rollers")
    };
    let (r, z) = row.axis;
    let apex = row.pitch_radius_m / r;
    let apex_z = row.middle_z_m - z * apex;
    // The roller's radius, straight on to its apex.
    let [first, last] = [row.laminae.first().unwrap(), row.laminae.last().unwrap()];
    let slope = (last.reach_m - first.reach_m) / (last.place_m - first.place_m);
    let reach = first.reach_m + slope * (-apex - first.place_m);
    assert!(reach.abs() < 1e-12, "{reach}");
    for race in [&row.inner, &row.outer] {
        let off = race.normal.1 * apex_z - race.offset_m;
        assert!(off.abs() < 1e-12, "{off}");
    }
}

/// The unloaded row of a pair of tapered bearings at speed: every roller carries its centrifugal force on the outer
/// race and the rib.
#[test]
fn unpressed_tapered_rollers_are_in_equilibrium() {
    let pair = bearing(&format!(
        "{TAPERED}arrangement = \"O\"\nrow_distance_mm = 25.0\n"
    ));
    let turning = Operation {
        inner_rad_per_s: 1000.0,
        ..Operation::default()
    };
    let load = AppliedBearingLoad {
        force_n: [300.0, 100.0, 4000.0],
        tilt: TiltCondition::Held([0.0; 2]),
    };
    let (_, loads) = rests(&pair, load, &turning);
    let Row::Roller(row) = &pair.rows[1] else {
        panic!("no rollers")
    };
    for roller in &loads.elements[1] {
        // Across the axis, along the outer race's normal: at least the centrifugal force, whatever rib and inner race
        // add.
        let across = roller.outer_load_n * row.outer.normal.0;
        assert!(across > 0.9 * roller.centrifugal_n, "{roller:?}");
    }
}

/// At 18 rpm hardly anything throws the rollers of an unloaded row: what their search leaves over is far below their
/// weight, and no reason to fail.
#[test]
fn rows_that_hardly_turn_may_be_unloaded() {
    let pair = bearing(
        "name = \"slow pair\"\nkind = \"tapered-roller\"\nrollers = 12\nroller_diameter_mm = 2.965703431777003\n\
         roller_length_mm = 5.107769428792179\npitch_diameter_mm = 17.360816440661434\nlaminae = 40\n\
         first_angle_deg = 93.2494267003918\ncontact_angle_deg = 12.086360588709319\nend_radius_ratio = 0.9003931454297511\n\
         preload_um = 14.42323556575126\narrangement = \"O\"\nrow_distance_mm = 13.727398467600374\n\
         [profile]\nkind = \"straight\"\n[element_material]\nyoung_GPa = 310\npoisson = 0.26\ndensity_kg_per_m3 = 3200\n",
    );
    let slow = Operation {
        inner_rad_per_s: 18.189972887627334 * std::f64::consts::PI / 30.0,
        ..Operation::default()
    };
    let load = AppliedBearingLoad {
        force_n: [1205.1987816376256, -2945.233979787513, -2382.485973403632],
        tilt: TiltCondition::Held([-3.146_989_524_832_056e-5, 2.007_487_198_761_761_5e-4]),
    };
    rests(&pair, load, &slow);
}

/// A large tilt that is held: sought from the straight ring on, and where there is none, the tilt is named, not the
/// direction of the load.
#[test]
fn large_tilts_are_reached_from_the_straight_ring() {
    let steep = bearing(crate::common::B218);
    let load = |force_n: [f64; 3], mrad: f64| AppliedBearingLoad {
        force_n,
        tilt: TiltCondition::Held([1e-3 * mrad, 0.0]),
    };
    let still = Operation::default();
    for force in [
        [1000.0, 0.0, 0.0],
        [0.0, 0.0, 1000.0],
        [4000.0, 0.0, 8000.0],
    ] {
        rests(&steep, load(force, 8.0), &still);
    }
    let pair = bearing(crate::common::PAIR);
    for force in [[1000.0, 0.0, 0.0], [0.0, 0.0, 2000.0]] {
        for mrad in [8.0, 10.0, 12.0] {
            rests(&pair, load(force, mrad), &still);
        }
        let error = pair.equilibrium(&load(force, 20.0), &still).unwrap_err();
        // Grooves without end clamp a loose ball there at -43 deg, by the same program of numpy as below.
        assert_beyond_groove(&error, [12.8, 12.9], 7.5);
    }
    // Grooves without end go on: at 10 mrad the flattest ball touches at -14.3 deg, at 12 mrad at -29.2 deg.
    let error = steep.equilibrium(&load([0.0, 0.0, 17_800.0], 12.0), &still);
    assert_beyond_groove(&error.unwrap_err(), [10.0, 12.0], 20.0);
}

/// The tilt that was found, and the angle at which the groove ends.
fn assert_beyond_groove(error: &BearingError, [least_mrad, most_mrad]: [f64; 2], end_deg: f64) {
    let BearingError::TiltedBeyondGroove {
        found_mrad,
        end_deg: found_deg,
        ..
    } = *error
    else {
        panic!("{error}")
    };
    assert!((least_mrad..most_mrad).contains(&found_mrad), "{error}");
    close(found_deg, end_deg, 1e-12);
}

/// Rings held at 8 to 20 mrad, against a program of numpy that seeks the least energy of ring and balls and shares no
/// code with the workspace: places in um to 1e-6.
#[test]
fn tilted_rings_rest_where_the_least_energy_is() {
    const B6208: &str = "name = \"6208\"\nkind = \"deep-groove\"\nballs = 9\nball_diameter_mm = 11.906\npitch_diameter_mm = 60.0\n\
                         inner_conformity = 0.52\nouter_conformity = 0.53\nradial_clearance_um = 15.0\n";
    for (text, force_n, tilt_mrad, expected_um) in [
        (
            crate::common::B218,
            [0.0, 0.0, 17_800.0],
            [8.0, 0.0],
            [0.0, -289.861068, -178.795469],
        ),
        (
            crate::common::B218,
            [5000.0, 0.0, 17_800.0],
            [10.0, 0.0],
            [104.74535683, -253.16608928, -312.98189699],
        ),
        (
            B6208,
            [3000.0, 0.0, 0.0],
            [8.0, 0.3],
            [21.15127851, -0.53758, 2.22530814],
        ),
        (
            B6208,
            [0.0, 0.0, 2000.0],
            [10.0, 0.3],
            [-0.20810943, -24.48459221, 50.84928789],
        ),
        (
            B6208,
            [3000.0, 500.0, 1000.0],
            [20.0, 0.3],
            [4.87409305, -0.6153315, 2.06163901],
        ),
    ] {
        let load = AppliedBearingLoad {
            force_n,
            tilt: TiltCondition::Held(tilt_mrad.map(|mrad| 1e-3 * mrad)),
        };
        let pose = bearing(text)
            .equilibrium(&load, &Operation::default())
            .unwrap();
        for (found_m, expected) in pose.centre_m.iter().zip(expected_um) {
            let size = 1e-6 * (1.0 + f64::abs(expected));
            assert!(
                (1e6 * found_m - expected).abs() < size,
                "{found_m} {expected}"
            );
        }
    }
}

/// Loads in the rounding of the elements' places are refused with that reason; a thousandth of a newton is carried.
#[test]
fn tiny_loads_are_refused_with_their_reason() {
    for text in [B6205, TAPERED, crate::common::B218] {
        let bearing = bearing(text);
        for force in [[1e-9, 0.0, 0.0], [0.0, 0.0, 1e-9]] {
            match bearing.equilibrium(&free(force, [0.0; 2]), &Operation::default()) {
                Ok(_) => {}
                Err(error) => assert!(error.to_string().contains("at least 0.001 N"), "{error}"),
            }
        }
        rests(
            &bearing,
            free([1e-3, 0.0, 1e-3], [0.0; 2]),
            &Operation::default(),
        );
    }
    let error = bearing(TAPERED)
        .equilibrium(&free([0.0, 0.0, 1e-9], [0.0; 2]), &Operation::default())
        .unwrap_err();
    assert!(error.to_string().contains("rounding"), "{error}");
}
