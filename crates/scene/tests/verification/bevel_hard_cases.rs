//! Bevel teeth in motion where it is hard: edges, few teeth, light loads, lift-off, reversal, wrong mounting. Every run
//! is made with two steps.

use std::f64::consts::{PI, TAU};

use gearmesh_scene::system_run::{RunJob, SystemResult};

use crate::common::*;
use crate::system_runs::Desk;

const SPEED: &str =
    "speed_rpm = { step = { start_s = 0.0, from = 0.0, end_s = 0.03, to = 3000.0 } }";
const TORQUE: &str =
    "torque_Nm = { step = { start_s = 0.0, from = 0.0, end_s = 0.01, to = 100.0 } }";
pub const PINION: &str = "position_mm = [0.0, 0.0, 0.0]\ncardan_deg = [0.0, 0.0, 0.0]";
pub const GEAR: &str = "position_mm = [0.0, 0.0, 0.0]\ncardan_deg = [0.0, 90.0]";
const STEPS_S: [&str; 2] = ["1e-5", "5e-6"];

/// Seed 001's pair with backlash.
pub fn pair() -> String {
    let text = text("bevel_20_20.toml");
    changed(
        &text,
        "thickness_shift = 0.007",
        "thickness_shift = 0.007\nbacklash_mm = 0.15",
    )
}

/// Seed 001's scene at this speed, under this torque, for so long.
pub fn scene(speed: &str, torque: &str, end_s: f64) -> String {
    let scene = text("dynamics_bevel_20_20.toml").replace("speed_rpm = 0.0\n", "");
    let scene = changed(&scene, SPEED, &format!("speed_rpm = {speed}"));
    let scene = changed(&scene, TORQUE, &format!("torque_Nm = {torque}"));
    changed(&scene, "end_s = 0.08", &format!("end_s = {end_s:?}"))
}

pub fn at_3000_rpm(torque: f64) -> String {
    let torque =
        format!("{{ step = {{ start_s = 0.0, from = 0.0, end_s = 0.003, to = {torque:?} }} }}");
    scene("3000.0", &torque, 0.012)
}

/// What a run shows.
pub struct Shown {
    result: SystemResult,
    /// Rows of the second half.
    pub half: std::ops::Range<usize>,
}

impl Shown {
    fn read(&self, name: &str) -> Vec<f64> {
        self.result.rows.read(name).unwrap()
    }

    pub fn mesh(&self, name: &str) -> Vec<f64> {
        self.read(&format!("elements/mesh/{name}"))
    }

    /// Of both sides together.
    pub fn force(&self) -> Vec<f64> {
        let [right, left] = ["normal_force_right_N", "normal_force_left_N"].map(|n| self.mesh(n));
        right
            .iter()
            .zip(left)
            .map(|(right, left)| right + left)
            .collect()
    }

    pub fn mean_force(&self) -> f64 {
        let force = &self.force()[self.half.clone()];
        force.iter().sum::<f64>() / force.len() as f64
    }

    pub fn turn(&self, body: &str) -> f64 {
        let turn = self.read(&format!("bodies/{body}/turn_rad"));
        turn[turn.len() - 1] - turn[0]
    }

    /// Values of all pairs that carry, in the second half.
    fn of_pairs(&self, what: &str) -> Vec<f64> {
        let mut found = Vec::new();
        for pair in 1..=4 {
            let forces = self.mesh(&format!("pair_{pair}_force_N"));
            let values = self.mesh(&format!("pair_{pair}_{what}"));
            found.extend(
                self.half
                    .clone()
                    .filter(|row| forces[*row] > 0.0)
                    .map(|row| values[row]),
            );
        }
        found
    }
}

/// Runs a scene with both steps: energies balance, all is finite, and mean force and turn do not depend on the step.
pub fn run(pair: &str, scene: &str, most_change: f64) -> Shown {
    run_within(pair, scene, [most_change, 1e-4])
}

/// The same; the changes of mean force and turn \[rad\] with the step are within these.
pub fn run_within(pair: &str, scene: &str, [most_change, most_turn_rad]: [f64; 2]) -> Shown {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("bevel_20_20.toml"), pair).unwrap();
    let mut runs = STEPS_S.iter().map(|step| {
        let scene = changed(scene, "step_s = 1e-5", &format!("step_s = {step}"));
        let loaded = load(&scene, folder.path()).unwrap();
        let result = Desk::new().run(RunJob::from_scene(loaded).unwrap());
        let error = result.relative_energy_error().unwrap();
        assert!(error < 1e-4, "{step}: energy error {error:e}");
        for column in result.rows.columns() {
            let values = result.rows.read(&column.name).unwrap();
            assert!(
                values.iter().all(|v| v.is_finite()),
                "{step}: {}",
                column.name
            );
        }
        let rows = result.rows.read("time_s").unwrap().len();
        Shown {
            result,
            half: rows / 2..rows,
        }
    });
    let (rough, fine) = (runs.next().unwrap(), runs.next().unwrap());
    let [a, b] = [&rough, &fine].map(Shown::mean_force);
    assert!((a - b).abs() <= most_change * b, "{a} and {b} N");
    let (mean, change) = (b, (a - b).abs() / b);
    let [a, b] = [&rough, &fine].map(|run| run.turn("gear"));
    assert!((a - b).abs() < most_turn_rad, "{a} and {b} rad");
    let turn_change = (a - b).abs();
    let errors = [&rough, &fine].map(|run| run.result.relative_energy_error().unwrap());
    let error = errors[0].max(errors[1]);
    println!(
        "mean normal force {mean:.0} N; steps of 10 and 5 us differ by {change:.1e} of it (allowed {most_change:e}), in the gear's turn by \
         {turn_change:.1e} rad (allowed {most_turn_rad:e}); energy error {error:.1e} of the work (allowed 1e-4)"
    );
    fine
}

/// Least and largest of these values; zero has no sign.
pub fn least_and_most(values: &[f64]) -> [f64; 2] {
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    [least + 0.0, most + 0.0]
}

pub fn notes(pair: &str, scene: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("bevel_20_20.toml"), pair).unwrap();
    build_in(scene, folder.path()).unwrap().notes.join("\n")
}

/// Of these notes those on teeth that jam.
pub fn print_jams(notes: &str) {
    for note in notes.lines().filter(|note| note.contains(" jam: ")) {
        println!("reported: {note}");
    }
}

/// Offsets of half a millimetre push the contact to the toe or to the heel, whose edges then carry.
#[test]
fn edges_carry_at_toe_and_heel() {
    for (offset, end) in [(0.5, 0.0), (-0.5, 1.0)] {
        let moved = format!("position_mm = [0.0, {offset:?}, 0.0]\ncardan_deg = [0.0, 0.0, 0.0]");
        let shown = run(&pair(), &changed(&at_3000_rpm(100.0), PINION, &moved), 5e-3);
        let mut places = Vec::new();
        for gear in [1, 2] {
            let along = shown.of_pairs(&format!("along_{gear}"));
            assert!(
                along.iter().any(|s| (s - end).abs() < 1e-9),
                "{offset}: gear {gear}"
            );
            assert!(along.iter().all(|s| (-1e-9..=1.0 + 1e-9).contains(s)));
            let [least, most] = least_and_most(&along);
            places.push(format!("gear {gear} {least:.3} to {most:.3}"));
        }
        println!(
            "offset {offset} mm: contact along the face, toe 0, heel 1: {}",
            places.join(", ")
        );
    }
}

/// Under a newton metre one pair carries at a time, and the next tooth takes over from it.
#[test]
fn contact_jumps_from_pair_to_pair_under_a_light_load() {
    let shown = run(&pair(), &at_3000_rpm(1.0), 5e-3);
    let (teeth, pairs) = (shown.mesh("pair_1_tooth_1"), shown.mesh("loaded_pairs"));
    let rows = shown.half.clone();
    assert!(rows.clone().all(|row| (1.0..=2.0).contains(&pairs[row])));
    assert!(rows.clone().any(|row| pairs[row] == 1.0));
    // Pair 1 is the one nearest to the pinion's tip: when it leaves, the tooth behind it is the first.
    let leading: Vec<f64> = rows.map(|row| teeth[row]).collect();
    let steps = leading
        .windows(2)
        .map(|two| (two[1] - two[0]).rem_euclid(20.0));
    let steps: Vec<f64> = steps.filter(|step| *step != 0.0).collect();
    assert!(
        steps.len() >= 4 && steps.iter().all(|step| *step == steps[0]),
        "{steps:?}"
    );
    assert!(steps[0] == 1.0 || steps[0] == 19.0);
    let [fewest, most] = least_and_most(&pairs[shown.half.clone()]);
    let alone = pairs[shown.half.clone()].iter().filter(|n| **n == 1.0);
    let share = 100.0 * alone.count() as f64 / shown.half.len() as f64;
    println!(
        "{fewest:.0} to {most:.0} pairs carry, one alone {share:.0} % of the time; taken over {} times, each time by the next tooth",
        steps.len()
    );
    let torque = 1.0;
    let mean = shown.mean_force();
    assert!(
        mean > torque / 0.0297 && mean < 1.5 * torque / 0.0297,
        "{mean}"
    );
    println!("mean normal force {mean:.1} N (allowed 33.7 to 50.5 N)");
}

/// The shaft angle 24 mrad off, the gear 0.8 mm too far out: contact at the edges of the path, and no more. The other
/// way the teeth jam, which is reported.
#[test]
fn wrong_angle_and_wrong_cone_distance() {
    let at = |position: f64, angle: f64| {
        let moved =
            format!("position_mm = [{position:?}, 0.0, 0.0]\ncardan_deg = [0.0, {angle:?}]");
        changed(&at_3000_rpm(100.0), GEAR, &moved)
    };
    let (mut worst, mut rows_apart) = (0.0_f64, 0);
    for moved in [at(0.0, 91.4), at(0.8, 90.0)] {
        let shown = run(&pair(), &moved, 5e-3);
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

/// A drive that shakes at 400 Hz tears the teeth apart and drives them against both sides; a ramp without load does it
/// once.
#[test]
fn teeth_lift_off_and_come_back() {
    let shaking = "{ sum = [1500.0, { sine = { amplitude = 300.0, frequency_Hz = 400.0 } }] }";
    let light = "{ step = { start_s = 0.0, from = 0.0, end_s = 0.003, to = 3.0 } }";
    let shown = run(&pair(), &scene(shaking, light, 0.012), 0.03);
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
    a_ramp_crosses_the_backlash(str::to_owned);
}

/// A ramp to 3000 rpm under a light load: teeth lift off, the gear crosses the backlash; `with`: the scene as it runs.
pub fn a_ramp_crosses_the_backlash(with: fn(&str) -> String) {
    let ramp = "{ step = { start_s = 0.001, from = 0.0, end_s = 0.011, to = 3000.0 } }";
    let shown = run(&pair(), &with(&scene(ramp, "1.0", 0.02)), 5e-3);
    assert!(shown.force().contains(&0.0));
    // At rest the gear stood at the coast flanks: it has crossed the backlash, 0.15 mm over a lever of 23 mm.
    let behind = shown.turn("gear") + shown.turn("pinion");
    assert!((behind - 6.5e-3).abs() < 0.6e-3, "{behind}");
    let force = shown.force();
    println!(
        "ramp: no force in {} of {} rows (at least one), turns of gear and pinion then apart by {:.2} mrad (5.9 to 7.1)",
        force.iter().filter(|force| **force == 0.0).count(),
        force.len(),
        1e3 * behind
    );
}

/// The turn goes back under one torque, and the torque changes its sign under one speed: the other flanks then carry.
#[test]
fn turn_and_torque_reverse() {
    reversals_carry_on_the_other_flanks(str::to_owned, [5e-3, 0.02]);
}

/// The same of scenes whose mesh has another model; the changes of the mean force with the step are within these.
pub fn reversals_carry_on_the_other_flanks(with: fn(&str) -> String, most_changes: [f64; 2]) {
    let back = "{ step = { start_s = 0.003, from = 1500.0, end_s = 0.011, to = -1500.0 } }";
    let shown = run(&pair(), &with(&scene(back, "20.0", 0.014)), most_changes[0]);
    let [pinion, gear] = ["pinion", "gear"].map(|body| shown.turn(body).abs());
    assert!(pinion < 1e-6 && gear < 2e-3);
    let right = shown.mesh("normal_force_right_N");
    assert!(right.iter().all(|force| *force == 0.0));
    println!(
        "turned back: pinion off by {pinion:.1e} rad (allowed 1e-6), gear by {gear:.1e} rad (allowed 2e-3), largest force on the right \
         flanks {:.0} N",
        least_and_most(&right)[1]
    );
    let changing = "{ step = { start_s = 0.003, from = 50.0, end_s = 0.011, to = -50.0 } }";
    let shown = run(
        &pair(),
        &with(&scene("3000.0", changing, 0.014)),
        most_changes[1],
    );
    let last = shown.force().len() - 1;
    let mut carry = Vec::new();
    for (side, first, end) in [("left", true, false), ("right", false, true)] {
        let force = shown.mesh(&format!("normal_force_{side}_N"));
        let carried = force[20..100].iter().any(|force| *force > 0.0);
        assert_eq!((carried, force[last] > 0.0), (first, end), "{side}");
        let most = least_and_most(&force[20..100])[1];
        carry.push(format!(
            "{side} flanks up to {most:.0} N early, {:.0} N at the end",
            force[last].abs()
        ));
    }
    println!("torque changes its sign: {}", carry.join("; "));
}

/// Axes at 60 degrees: the mean normal force is that of statics at the mean radius within 5 %.
#[test]
fn axes_at_60_degrees() {
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
    let shown = run(&pair, &scene, 5e-3);
    // F_t at the mean radius, and the normal force by pressure and spiral angle.
    let radius_m = 1e-3 * (70.0 - 7.5) * (PI / 6.0).sin();
    let expected = 100.0 / radius_m / (20.0_f64.to_radians().cos() * 35.0_f64.to_radians().cos());
    let mean = shown.mean_force();
    assert!(
        (mean - expected).abs() < 0.05 * expected,
        "{mean}, {expected}"
    );
    println!(
        "mean normal force {mean:.0} N, by statics {expected:.0} N: {:+.2} % (allowed 5 %)",
        100.0 * (mean / expected - 1.0)
    );
}

/// Angles at which teeth stand in teeth are refused before the run, also where a tooth stands in the middle of a tooth
/// and neither side finds its mate.
#[test]
fn teeth_in_teeth_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(
        folder.path().join("bevel_20_20.toml"),
        text("bevel_8_48.toml"),
    )
    .unwrap();
    let said = |turn_deg: f64| {
        let place =
            format!("position_mm = [0.0, 0.0, 0.0]\ncardan_deg = [0.0, 90.0, {turn_deg:?}]");
        let scene = changed(&at_3000_rpm(100.0), GEAR, &place);
        let refused = build_in(&scene, folder.path()).err();
        refused.map(|e| e.to_string())
    };
    // A pitch of the gear is 7.5 degrees.
    let said: Vec<_> = (0..30).map(|k| said(0.25 * f64::from(k))).collect();
    let refused: Vec<&String> = said.iter().flatten().collect();
    for parts in [
        ["flanks stand", "in each other at the start"],
        ["teeth stand in teeth at the start", "together a pitch"],
    ] {
        let found = refused
            .iter()
            .find(|text| parts.iter().all(|part| text.contains(part)));
        assert!(found.is_some(), "{parts:?} {said:#?}");
        println!("refused: {}", found.unwrap().replace('\n', " "));
    }
    // A tenth of a pitch is allowed on either side.
    assert!((20..26).contains(&refused.len()), "{said:#?}");
    println!(
        "refused at {} of {} angles over a pitch (20 to 25)",
        refused.len(),
        said.len()
    );
}

/// A pair of few teeth on many.
pub fn eight_and_48(pressure_deg: f64) -> String {
    format!(
        "title = \"8/48\"\n[bevel]\nteeth = [8, 48]\nouter_module_mm = 3.5\nface_width_mm = [18.0, 18.0]\nspiral_angle_deg = 35.0\npressure_angle_deg = {pressure_deg:?}\n\
         pinion_hand = \"right\"\ncutter_radius_mm = 88.9\nbacklash_mm = 0.1\n[gear]\nsettings = \"basic\"\nedge_radius_mm = 0.2\n[pinion]\nsettings = \"local-synthesis\"\n\
         edge_radius_mm = 0.2\npath_angle_deg = [100.0, 80.0]\nellipse_half_length_mm = [5.0, 5.0]\ntransmission_curvature = [-0.001, -0.001]\n"
    )
}

/// Eight teeth drive 48: undercut at 20 degrees and refused with what helps; at 25 degrees they run.
#[test]
fn eight_teeth_drive_48() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("bevel_20_20.toml"), eight_and_48(20.0)).unwrap();
    let scene = at_3000_rpm(100.0);
    let refused = build_in(&scene, folder.path()).err().unwrap().to_string();
    for part in ["undercut", "take more teeth, a larger pressure angle"] {
        assert!(refused.contains(part), "{refused}");
    }
    // The folder has another name each time.
    let place = format!("{}/", folder.path().display());
    println!(
        "20 degrees, refused: {}",
        refused.replace(&place, "").replace('\n', " ")
    );
    let shown = run(&eight_and_48(25.0), &scene, 5e-3);
    let behind = shown.turn("gear") + shown.turn("pinion") / 6.0;
    assert!(behind.abs() < 2e-3, "{behind}");
    let off = (shown.turn("pinion") - 0.012 * 50.0 * TAU).abs();
    assert!(off < 1e-6);
    let teeth = shown.of_pairs("tooth_1");
    assert!(teeth.iter().all(|tooth| (0.0..8.0).contains(tooth)));
    let [first, last] = least_and_most(&teeth);
    println!(
        "25 degrees: gear off a sixth of the pinion's turn by {behind:.1e} rad (allowed 2e-3), pinion off its drive by {off:.1e} rad \
         (allowed 1e-6), its teeth {first:.0} to {last:.0} carry"
    );
}
