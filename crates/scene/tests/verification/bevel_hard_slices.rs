//! The hard cases of bevel teeth in motion once more, the contact in slices on rigid gears whose surfaces deflect.
//! Every run is made with two steps.

use std::f64::consts::TAU;

use crate::bevel_hard_cases::*;
use crate::common::*;

/// Slices along the face.
const COUNT: usize = 15;

/// The same scene with slices in place of one contact for a pair of teeth.
fn in_slices(scene: &str) -> String {
    let impact = "tooth_pairs = {}\nmodel = { kind = \"impact\", stiffness_N_per_mm_e = 7.2e5, exponent = 1.5, damping_N_s_per_mm = 1.0, full_damping_depth_um = 1.0 }";
    let slices = format!(
        "model = {{ kind = \"hybrid\", half_space = {{}}, slices = {COUNT}, damping = {{ kind = \"stiffness-proportional\", time_s = 5e-6, full_depth_um = 1.0 }} }}"
    );
    changed(scene, impact, &slices)
}

/// Largest line load of each slice, toe to heel \[N/m\].
fn largest_loads(shown: &Shown) -> Vec<f64> {
    let largest = |slice: usize| {
        let loads = shown.mesh(&format!("line_load_slice_{slice}_N_per_m"));
        loads[shown.half.clone()]
            .iter()
            .fold(0.0_f64, |most, q| most.max(*q))
    };
    (1..=COUNT).map(largest).collect()
}

/// Offsets of half a millimetre push the load to the slice at the toe or to that at the heel; the other half of the
/// face is free.
#[test]
fn slices_carry_at_toe_and_heel() {
    for (offset, at_toe) in [(0.5, true), (-0.5, false)] {
        let moved = format!("position_mm = [0.0, {offset:?}, 0.0]\ncardan_deg = [0.0, 0.0, 0.0]");
        let scene = in_slices(&changed(&at_3000_rpm(100.0), PINION, &moved));
        let mut loads = largest_loads(&run(&pair(), &scene, 2e-3));
        if !at_toe {
            loads.reverse();
        }
        let most = loads.iter().copied().fold(0.0, f64::max);
        assert!(loads[0] > 0.2 * most, "{offset}: {loads:?}");
        assert!(
            loads[COUNT - 4..].iter().all(|load| *load == 0.0),
            "{offset}: {loads:?}"
        );
        let [first, largest, far] =
            [loads[0], most, least_and_most(&loads[COUNT - 4..])[1]].map(|load| 1e-3 * load);
        println!(
            "offset {offset} mm: the slice at the {} carries up to {first:.0} N/mm (at least a fifth of the largest, {largest:.0} N/mm), the four at \
             the other end {far:.0} N/mm",
            if at_toe { "toe" } else { "heel" }
        );
    }
}

/// The shaft angle 24 mrad too large, the gear 0.8 mm too far out: the ratio stays. The other way the teeth jam, which
/// is reported.
#[test]
fn slices_at_a_wrong_angle_and_cone_distance() {
    let at = |position: f64, angle: f64| {
        let moved =
            format!("position_mm = [{position:?}, 0.0, 0.0]\ncardan_deg = [0.0, {angle:?}]");
        in_slices(&changed(&at_3000_rpm(100.0), GEAR, &moved))
    };
    let (mut worst, mut rows_apart) = (0.0_f64, 0);
    for moved in [at(0.0, 91.4), at(0.8, 90.0)] {
        let shown = run(&pair(), &moved, 2e-3);
        let off = (shown.turn("gear") + shown.turn("pinion")).abs();
        assert!(off < 3e-3);
        let apart = shown.mesh("apart");
        assert!(apart.iter().all(|apart| *apart == 0.0));
        assert!(!notes(&pair(), &moved).contains("jam"));
        worst = worst.max(off);
        rows_apart += apart.iter().filter(|apart| **apart != 0.0).count();
    }
    println!(
        "turns of gear and pinion apart by {worst:.1e} rad at most (allowed 3e-3), rows with teeth out of reach {rows_apart}"
    );
    for moved in [at(0.0, 88.6), at(-0.8, 90.0)] {
        let told = notes(&pair(), &moved);
        assert!(told.contains("the teeth of mesh `mesh` jam"), "{told}");
        print_jams(&told);
    }
}

/// Under a newton metre one or two pairs carry and the mean force is that of statics, although single pairs lift off as
/// the next one takes over.
#[test]
fn slices_under_a_light_load() {
    let shown = run(&pair(), &in_slices(&at_3000_rpm(1.0)), 0.02);
    let pairs = shown.mesh("loaded_pairs");
    assert!(pairs.iter().all(|pairs| *pairs <= 2.0));
    let mean = shown.mean_force();
    assert!(
        mean > 1.0 / 0.0297 && mean < 1.5 / 0.0297,
        "{mean} N, statics 44"
    );
    println!(
        "at most {:.0} pairs carry (allowed 2); mean normal force {mean:.1} N, by statics 44 N (allowed 33.7 to 50.5 N)",
        least_and_most(&pairs)[1]
    );
}

/// A drive that shakes tears the teeth apart and drives them against both sides; a ramp without load does it once.
#[test]
fn slices_lift_off_and_come_back() {
    let shaking = "{ sum = [1500.0, { sine = { amplitude = 300.0, frequency_Hz = 400.0 } }] }";
    let light = "{ step = { start_s = 0.0, from = 0.0, end_s = 0.003, to = 3.0 } }";
    // The gear flies from side to side, 6.5 mrad apart: when it strikes depends on the step a little, and with it the
    // mean and the last angle.
    let shaken = in_slices(&scene(shaking, light, 0.012));
    let shown = run_within(&pair(), &shaken, [0.05, 3e-4]);
    let force = shown.force();
    let free = shown.half.clone().filter(|row| force[*row] == 0.0).count();
    assert!(free > shown.half.len() / 4);
    let mut strikes = Vec::new();
    for side in ["right", "left"] {
        let force = shown.mesh(&format!("normal_force_{side}_N"));
        assert!(force.iter().any(|force| *force > 500.0), "{side}");
        strikes.push(format!("{side} {:.0} N", least_and_most(&force)[1]));
    }
    println!(
        "shaken: no force {:.0} % of the time (at least 25 %), largest force by flank (at least 500 N): {}",
        100.0 * free as f64 / shown.half.len() as f64,
        strikes.join(", ")
    );
    a_ramp_crosses_the_backlash(in_slices);
}

/// The turn goes back under one torque, and the torque changes its sign under one speed: the other flanks then carry.
#[test]
fn slices_when_turn_and_torque_reverse() {
    reversals_carry_on_the_other_flanks(in_slices, [5e-3; 2]);
}

/// Axes at 60 degrees and eight teeth on 48: the mean normal force by statics, the ratio of the teeth.
#[test]
fn slices_of_other_axes_and_of_few_teeth() {
    let pair = changed(
        &pair(),
        "teeth = [20, 20]",
        "teeth = [20, 20]\nshaft_angle_deg = 60.0",
    );
    let scene = changed(
        &at_3000_rpm(100.0),
        "cardan_deg = [0.0, 90.0]",
        "cardan_deg = [0.0, 60.0]",
    );
    let statics = |torque: f64, radius_m: f64, pressure_deg: f64| {
        torque / radius_m / (pressure_deg.to_radians().cos() * 35.0_f64.to_radians().cos())
    };
    let mean = run(&pair, &in_slices(&scene), 2e-3).mean_force();
    let expected = statics(
        100.0,
        1e-3 * (70.0 - 7.5) * 30.0_f64.to_radians().sin(),
        20.0,
    );
    assert!((mean / expected - 1.0).abs() < 0.05, "{mean}, {expected}");
    println!(
        "axes at 60 degrees: mean normal force {mean:.0} N, by statics {expected:.0} N: {:+.2} % (allowed 5 %)",
        100.0 * (mean / expected - 1.0)
    );

    let shown = run(&eight_and_48(25.0), &in_slices(&at_3000_rpm(100.0)), 2e-3);
    let behind = shown.turn("gear") + shown.turn("pinion") / 6.0;
    assert!(behind.abs() < 5e-4, "{behind}");
    let off = (shown.turn("pinion") - 0.012 * 50.0 * TAU).abs();
    assert!(off < 1e-6);
    // The gear's mean radius: half its outer diameter, less half the face along its pitch cone.
    let cone = f64::atan2(48.0, 8.0);
    let expected = statics(100.0, 84e-3 - 9e-3 * cone.sin(), 25.0);
    let mean = shown.mean_force();
    assert!((mean / expected - 1.0).abs() < 0.05, "{mean}, {expected}");
    println!(
        "8/48: gear off a sixth of the pinion's turn by {behind:.1e} rad (allowed 5e-4), pinion off its drive by {off:.1e} rad (allowed \
         1e-6), mean normal force {mean:.0} N, by statics {expected:.0} N: {:+.2} % (allowed 5 %)",
        100.0 * (mean / expected - 1.0)
    );
}
