//! A bevel pair from gear files to loads at rest and in motion: coarse members of 13/35 are reduced, the pair is loaded
//! at rest and run slowly.
//!
//! What is asserted holds on any mesh: moments balance, motion at low speed goes through positions at rest, no load is
//! the tooth contact analysis.

use std::f64::consts::TAU;
use std::path::PathBuf;
use std::sync::OnceLock;

use gearmesh_bevel::{FlankPatch, FlankSide, PairFile};
use gearmesh_scene::pair::bevel_result::{PressedPosition, Pressing};
use gearmesh_scene::system_run::SystemResult;
use gearmesh_scene::{SceneResult, StrainSeries};
use serde_json::Value;

use super::bevel::shipped;
use crate::common::{Desk, argument, changed, gearmesh, refused, succeeds};

/// Elements, slices and modes of the members here; gauges in the roots of the flanks that carry.
const COARSE: &str = "[mesh]\nflank_mm = 2.4\nalong_mm = 4.0\nfillet_mm = 0.8\nbody_mm = 9.0\n[reduction]\nprofile_stations = 5\nslices = 7\n[modes]\ncount = 4\n";

const PAIR: &str = "bevel_13_35.toml";
const TEETH: [f64; 2] = [13.0, 35.0];

/// The shipped file with backlash, so that teeth may lift off.
fn with_backlash(name: &str) -> String {
    let text = std::fs::read_to_string(shipped(name)).unwrap();
    let cutter = "cutter_radius_mm = 76.2";
    changed(&text, cutter, &format!("{cutter}\nbacklash_mm = 0.15"))
}

/// Pair file and models, made once.
pub fn members() -> &'static PathBuf {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| {
        // One folder per process: test runners may start each test in a process of its own.
        let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("bevel-13-35");
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join(PAIR), with_backlash(PAIR)).unwrap();
        for member in ["pinion", "gear"] {
            let text = std::fs::read_to_string(shipped(&format!("bevel_{member}_13_35.toml")));
            let file = folder.join(format!("{member}.toml"));
            // In motion tooth 0 of the pinion begins in mesh; of the gear tooth 16 comes into it.
            let gauged = if member == "gear" {
                "tooth = 16\n"
            } else {
                "tooth = 0\n"
            };
            let text = changed(&text.unwrap(), "tooth = 0\n", gauged);
            let text = changed(&text, "[modes]\nup_to_Hz = 25000.0\n", "");
            std::fs::write(&file, format!("{text}\n{COARSE}")).unwrap();
            let model = folder.join(format!("{member}.h5"));
            succeeds(&["reduce", argument(&file), "-o", argument(&model)]);
        }
        folder
    })
}

/// The shipped pair under these torques with the coarse models, more at its end.
pub fn loaded(torques: &str, more: &str) -> String {
    let text = with_backlash("bevel_13_35_loaded.toml");
    let models = format!(
        "models = [\"{0}/pinion.h5\", \"{0}/gear.h5\"]",
        members().display()
    );
    let text = changed(&text, "slices = 31", &models);
    let text = changed(
        &text,
        "torques_Nm = [50.0, 100.0, 200.0]",
        &format!("torques_Nm = {torques}"),
    );
    format!("{text}\n{more}")
}

/// What `gearmesh tca` finds of a pair file.
pub fn tca(text: &str) -> Value {
    let desk = Desk::new();
    let file = desk.file("pair.toml", text);
    succeeds(&["tca", argument(&file), "--json"]).json()
}

/// What `gearmesh run` finds of a pair file under its torques.
pub fn at_rest(text: &str) -> SceneResult {
    let desk = Desk::new();
    let (file, result) = (desk.file("pair.toml", text), desk.path("pair.h5"));
    succeeds(&["run", argument(&file), "-o", argument(&result)]);
    SceneResult::read(&result).unwrap()
}

pub fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().unwrap();
    list.iter().map(|x| x.as_f64().unwrap()).collect()
}

/// Force and place of all patches of a position, on the pinion (0) or the gear (1), shares along the face and up.
pub fn forces(result: &SceneResult, of: PressedPosition<'_>, gear: usize) -> Vec<(f64, [f64; 2])> {
    let width_m = result.bevel.unwrap().face_widths_m[gear];
    let place = |at: Pressing<'_>| [at.along_m(gear) / width_m + 0.5, at.up(gear)];
    of.pressing().map(|at| (at.force_n, place(at))).collect()
}

/// Flanks that carry, of pinion and gear, from the pair file alone.
fn flanks() -> [FlankPatch; 2] {
    let file = PairFile::read(&members().join(PAIR)).unwrap();
    let design = file.design().unwrap();
    let side = |member: usize| match member {
        0 => FlankSide::Concave,
        _ => FlankSide::Convex,
    };
    [0, 1].map(|m: usize| {
        let mate = &file.blank.members[1 - m];
        FlankPatch::of_tooth(&design.teeth[m], mate, side(m)).unwrap()
    })
}

/// Lever of the normal about the member's axis \[m\]: whatever the turn, for both turn together.
fn lever_m(flank: &FlankPatch, place: [f64; 2]) -> f64 {
    let point = flank.point(place);
    (point.r.x * point.n.y - point.r.y * point.n.x).abs()
}

/// Turns of the pinion \[rad\].
fn turns_rad(result: &SceneResult) -> Vec<f64> {
    let sense = -result.bevel.unwrap().side.mirror();
    result.angle_rad.iter().map(|angle| sense * angle).collect()
}

/// Transmission errors as turns of the gear \[µrad\].
fn urad(result: &SceneResult, values_m: &[f64]) -> Vec<f64> {
    let radius_m = result.bevel.unwrap().radius_2_m;
    values_m
        .iter()
        .map(|error| 1e6 * error / radius_m)
        .collect()
}

/// At rest the moments of all contacts about the gear's axis are the stated torque, those about the pinion's 13/35 of
/// it; analyses are repeated to the last digit.
#[test]
fn loads_at_rest_balance() {
    let text = loaded("[50.0, 200.0]", "");
    let (found, again) = (at_rest(&text), at_rest(&text));
    assert_eq!(
        (&found.te_m, &found.lines.force_n),
        (&again.te_m, &again.lines.force_n)
    );
    let (desk, flanks) = (Desk::new(), flanks());
    let (file, page) = (desk.path("pair.h5"), desk.path("page.html"));
    found.write(&file).unwrap();
    succeeds(&["report", argument(&file), "-o", argument(&page)]);
    assert!(
        std::fs::read_to_string(page)
            .unwrap()
            .contains("Gear 1, gauge root")
    );
    for (torque, stated) in found.torque_nm.iter().enumerate() {
        for position in found.even_positions_of(torque) {
            let moment = |member: usize| -> f64 {
                let all = forces(&found, position, member);
                let of = |(force, at): (f64, [f64; 2])| force * lever_m(&flanks[member], at);
                all.into_iter().map(of).sum()
            };
            let gear = moment(1) / stated - 1.0;
            let pinion = moment(0) / (stated * TEETH[0] / TEETH[1]) - 1.0;
            // A tip presses along its mate's normal, which stands a little off its own.
            assert!(
                gear.abs() < 2e-3 && pinion.abs() < 4e-3,
                "{gear:e} {pinion:e}"
            );
        }
    }
}

/// Without load the pair stands where the tooth contact analysis says: behind it by what a slice's middle misses of the
/// contact, half the ellipse's curvature times the square of half a slice, and nowhere ahead.
#[test]
fn no_load_is_the_tooth_contact_analysis() {
    let text = loaded("[0.01]", "");
    let (found, light) = (tca(&text), at_rest(&text));
    let pitch = ..light.points_per_pitch();
    let [under, without] =
        [&light.te_m, &light.unloaded_m].map(|values| urad(&light, &values[pitch]));
    // 0.01 N m turn the gear by less than 0.1 µrad beyond first touch.
    for (under, without) in under.iter().zip(&without) {
        assert!((0.0..0.1).contains(&(without - under)), "{without} {under}");
    }
    // Long ellipses of the positions where flanks lead; their half lengths are those under 6.35 µm of marking.
    let path = found["path"].as_array().unwrap();
    let ellipses = path.iter().filter(|p| p["first"] == true);
    let lengths_m = ellipses.filter_map(|p| p["ellipse_half_lengths_mm"][0].as_f64());
    let shortest_m = 1e-3 * lengths_m.fold(f64::INFINITY, f64::min);
    let curvature_per_m = 2.0 * 6.35e-6 / (shortest_m * shortest_m);
    let half_slice_m = 0.5 * 30e-3 / 7.0 / 35.0_f64.to_radians().cos();
    let flanks = flanks();
    let lever = lever_m(&flanks[1], flanks[1].mean);
    let most = 1e6 * 0.5 * curvature_per_m * half_slice_m * half_slice_m / lever;
    let exact = numbers(&found["error_urad"]);
    let steps = exact.len() / without.len();
    let behind: Vec<f64> = (0..without.len())
        .map(|k| exact[k * steps] - without[k])
        .collect();
    let least = behind.iter().copied().fold(f64::INFINITY, f64::min);
    // Both are zero where they lead most.
    let behind: Vec<f64> = behind.iter().map(|x| x - least).collect();
    for (k, behind) in behind.iter().enumerate() {
        // Where tips lead, which are more curved along themselves, three times as far.
        let turn = turns_rad(&light)[k].to_degrees();
        let pitch_deg = 360.0 / TEETH[0];
        let leads = |point: &&Value| {
            let pitches = (point["pinion_deg"].as_f64().unwrap() - turn) / pitch_deg;
            point["first"] == true && (pitches - pitches.round()).abs() < 1e-6
        };
        let leading = path.iter().find(leads).unwrap();
        let on_flanks = leading["touches"] == "flanks";
        let most = if on_flanks { most } else { 3.0 * most };
        assert!(*behind <= most, "{k}: {behind} of {most} µrad");
    }
}

/// Slow motion of the pair under 100 N m on the gear.
pub fn scene() -> String {
    let body = |name: &str, at: &str, inertia: &str, speed: &str| {
        format!(
            "[[body]]\nname = \"{name}\"\nmass_kg = 1.0\ninertia_kg_m2 = {inertia}\nposition_mm = [0.0, 0.0, 0.0]\ncardan_deg = {at}\n{speed}\
             [[joint]]\nname = \"{name} shaft\"\nkind = \"revolute\"\nbody_2 = \"{name}\"\n"
        )
    };
    format!(
        "title = \"13/35, slowly\"\n[run]\nkind = \"transient\"\nend_s = 0.18\n[solver]\nstep_s = 2e-4\n[output]\ninterval_s = 4e-4\n{}{}\
         [[motion]]\njoint = \"pinion shaft\"\nspeed_rpm = -60.0\n\
         [[load]]\nname = \"brake\"\nbody = \"gear\"\ntorque_Nm = {{ step = {{ start_s = 0.0, from = 0.0, end_s = 0.01, to = -100.0 }} }}\n\
         [[gear_mesh]]\nname = \"mesh\"\ngear_1 = \"pinion\"\ngear_2 = \"gear\"\nbevel_pair = \"bevel_13_35.toml\"\n\
         bevel_models = [\"pinion.h5\", \"gear.h5\"]\nteeth = {{ flanks = \"right\" }}\n\
         model = {{ kind = \"hybrid\", damping = {{ kind = \"stiffness-proportional\", time_s = 2e-5, full_depth_um = 1.0 }} }}\n\
         [[gauge]]\nbody = \"pinion\"\nnames = [\"root\"]\n[[gauge]]\nbody = \"gear\"\nnames = [\"root\"]\n",
        body(
            "pinion",
            "[0.0, 0.0, 0.0]",
            "[3e-4, 3e-4, 3e-4]",
            "speed_rpm = -60.0\n"
        ),
        body("gear", "[0.0, 90.0]", "[5e-3, 5e-3, 1e-2]", "")
    )
}

/// Value at a turn of a curve over one pitch.
fn interpolated(curve: &[(f64, f64)], pitch: f64, turn: f64) -> f64 {
    let at = turn.rem_euclid(pitch);
    let high = curve.partition_point(|(x, _)| *x <= at);
    let (mut a, mut b) = (
        curve[(high + curve.len() - 1) % curve.len()],
        curve[high % curve.len()],
    );
    a.0 -= if high == 0 { pitch } else { 0.0 };
    b.0 += if high == curve.len() { pitch } else { 0.0 };
    a.1 + (b.1 - a.1) * (at - a.0) / (b.0 - a.0)
}

/// Motion at low speed goes through the positions at rest: the transmission error by the turns of the bodies, the mesh
/// force, the ratio. The same scene gives the same numbers.
#[test]
fn slow_motion_goes_through_positions_at_rest() {
    let folder = members();
    let file = folder.join("slowly.toml");
    std::fs::write(&file, scene()).unwrap();
    let run = |name: &str| {
        let output = folder.join(name);
        succeeds(&["run", argument(&file), "-o", argument(&output)]);
        SystemResult::open(&output).unwrap()
    };
    let (result, again) = (run("slowly.h5"), run("again.h5"));
    for column in result.rows.columns() {
        let [a, b] = [&result, &again].map(|r| r.rows.read(&column.name).unwrap());
        assert_eq!(a, b, "{}", column.name);
    }
    let read = |name: &str| result.rows.read(name).unwrap();
    let [pinion, gear] = ["pinion", "gear"].map(|b| read(&format!("bodies/{b}/turn_rad")));
    let ratio = TEETH[0] / TEETH[1];
    let te: Vec<f64> = (pinion.iter().zip(&gear))
        .map(|(p, g)| 1e6 * (g + ratio * p))
        .collect();

    let text = changed(
        &loaded("[100.0]", ""),
        "positions_per_pitch = 16",
        "positions_per_pitch = 64",
    );
    let found = at_rest(&text);
    let pitch = TAU / TEETH[0];
    let turns = turns_rad(&found);
    let curve = |values: Vec<f64>| {
        let mut curve: Vec<(f64, f64)> = (turns.iter().zip(values))
            .map(|(turn, value)| (turn.rem_euclid(pitch), value))
            .collect();
        curve.sort_by(|a, b| a.0.total_cmp(&b.0));
        curve
    };
    let one = ..found.points_per_pitch();
    let under = curve(urad(&found, &found.te_m[one]));
    let without = curve(urad(&found, &found.unloaded_m[one]));
    let total = |position: PressedPosition<'_>| position.pressing().map(|at| at.force_n).sum();
    let force = curve(found.even_positions_of(0).map(total).collect());

    // There the mean point of the flank stands in the plane of the axes at turn 0, here the middle of tooth 0; turns
    // count from first touch.
    let flank = &flanks()[0];
    let start = flank.azimuth_rad(flank.mean);
    let first = interpolated(&without, pitch, start);
    let rows: Vec<usize> = (0..te.len()).filter(|row| pinion[*row] < -0.02).collect();
    let forces = read("elements/mesh/normal_force_right_N");
    let (mut squares, mut worst, mut worst_force) = (0.0, 0.0_f64, 0.0_f64);
    let from = te.len() - (0.154 / 4e-4_f64).round() as usize;
    let settled: Vec<usize> = rows.iter().copied().filter(|row| *row >= from).collect();
    for row in &settled {
        let turn = start + pinion[*row];
        let off = te[*row] - (interpolated(&under, pitch, turn) - first);
        squares += off * off;
        worst = worst.max(off.abs());
        let off = forces[*row] / interpolated(&force, pitch, turn) - 1.0;
        worst_force = worst_force.max(off.abs());
    }
    let rms = (squares / settled.len() as f64).sqrt();
    // Of a mean of −183 µrad.
    assert!(rms < 0.5 && worst < 2.5, "{rms} {worst} µrad");
    assert!(worst_force < 0.05, "{worst_force}");

    // Gauges in motion read what they read at rest while their tooth goes through the mesh. At rest turns count from
    // where their tooth meets its mate's; which pitch of the motion that is, a whole number, is sought.
    for gear in [1, 2] {
        let of = found.strain.iter().find(|s| s.gear == gear).unwrap();
        events_are_read_in_their_pitch(&found, of);
        for (method, values) in [(1, &of.method_1), (2, &of.method_2)] {
            let values: Vec<f64> = values.iter().map(|strain| 1e6 * strain).collect();
            let name = format!("method{method}");
            let moving = read(&format!(
                "elements/mesh/strain_gear{gear}_root_{name}_ustrain"
            ));
            let most = |values: &[f64]| values.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            let at = |turn: f64| {
                let between = |w: &[f64]| (turn - w[0]) * (turn - w[1]) <= 0.0;
                let k = turns.windows(2).position(between)?;
                let share = (turn - turns[k]) / (turns[k + 1] - turns[k]);
                Some(values[k] + (values[k + 1] - values[k]) * share)
            };
            let worst_at = |pitches: i32| {
                let off = |row: &usize| {
                    let turn = start + pinion[*row] + f64::from(pitches) * pitch;
                    at(turn).map(|rest| moving[*row] - rest)
                };
                let offs: Option<Vec<f64>> = settled.iter().map(off).collect();
                offs.map_or([f64::INFINITY; 2], |offs| {
                    let squares: f64 = offs.iter().map(|x| x * x).sum();
                    [most(&offs), (squares / offs.len() as f64).sqrt()]
                })
            };
            let [worst, rms] = (-2..=4)
                .map(worst_at)
                .min_by(|a, b| a[0].total_cmp(&b[0]))
                .unwrap();
            let (moved, rest) = (most(&moving), most(&values));
            assert!(
                moved > 0.5 * rest && rest > 50.0,
                "gear {gear} {name}: {moved} {rest}"
            );
            // The most where the next slice takes its load within a twentieth of a pitch.
            assert!(
                worst < 0.05 * rest && rms < 0.01 * rest,
                "gear {gear} {name}: {worst}, {rms} of {rest}"
            );
        }
    }

    // One turn of a pitch of the pinion is one of the gear.
    let rows_a_pitch = (1.0 / 13.0 / 4e-4_f64).round() as usize;
    let last = te.len() - 1;
    let turned = pinion[last] - pinion[last - 2 * rows_a_pitch];
    let of_gear = gear[last] - gear[last - 2 * rows_a_pitch];
    assert!((of_gear + ratio * turned).abs() < 1e-6 * turned.abs().max(1.0) * 3.0);
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let moving = mean(&forces[last - 2 * rows_a_pitch..last]);
    let at_rest = mean(&force.iter().map(|(_, f)| *f).collect::<Vec<_>>());
    assert!(
        (moving / at_rest - 1.0).abs() < 2e-3,
        "{moving} {at_rest} N"
    );
}

/// More slices than the members have are refused: shorter slices would show too much pressure beside edges.
#[test]
fn more_slices_than_the_members_have_are_refused() {
    let desk = Desk::new();
    let text = changed(
        &loaded("[100.0]", ""),
        "positions_per_pitch = 16",
        "slices = 8",
    );
    let file = desk.file("pair.toml", &text);
    let parts = ["load.slices", "found 8", "at most 7"];
    let result = desk.path("result.h5");
    let run = ["run", argument(&file), "-o", argument(&result)];
    refused(&gearmesh(&run), 2, &parts);
}

/// The largest strain at the positions between those of the grid is that of the grid in each pitch, but for what
/// happens between two of them; of another pitch it would be off by the whole peak.
fn events_are_read_in_their_pitch(result: &SceneResult, of: &StrainSeries) {
    let largest =
        |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, |a: f64, b| a.max(b.abs()));
    let (points, pitches) = (result.points_per_pitch(), result.pitches);
    let peak = largest(&mut of.method_2.iter().copied());
    let events = result.between.of(0).len();
    assert!(events > 0 && pitches > 1);
    for pitch in 0..pitches {
        let even = largest(&mut of.method_2[pitch * points..][..points].iter().copied());
        let own = (0..events).map(|event| of.between[1][event * pitches + pitch]);
        let between = largest(&mut own.into_iter());
        assert!(
            (between - even).abs() < 0.3 * peak,
            "{pitch}: {between:.2e} {even:.2e}"
        );
    }
}
