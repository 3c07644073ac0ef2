//! Bevel pairs at rest under torques, rigid gears whose surfaces deflect: against the tooth contact analysis, against
//! finer slices and positions, and what their result files keep.

use std::f64::consts::TAU;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use gearmesh_bevel::{Assembly, AssemblyError, FlankSide, PairFile, TcaRequest, tooth_contact};
use gearmesh_drivetrain::BevelSlices;
use gearmesh_geometry::input::InputDocument;
use gearmesh_scene::ModelShelf;
use gearmesh_scene::SceneResult;
use gearmesh_scene::pair::bevel_result::PressedPosition;
use gearmesh_scene::pair::{BevelScene, PEAK_SHARE};

const NAMES: [&str; 2] = ["bevel_20_20.toml", "bevel_13_35.toml"];
const TORQUES: [f64; 4] = [0.1, 50.0, 100.0, 200.0];

fn read(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fe_models");
    std::fs::read_to_string(folder.join(name)).unwrap()
}

/// A shipped pair under torques, the same with more in its `[load]`.
fn loaded(
    name: &str,
    (positions, slices): (usize, usize),
    torques: &[f64],
    more: &str,
) -> SceneResult {
    let more = format!("slices = {slices}\n{more}");
    loaded_in_slices(name, positions, torques, &more)
}

/// The same, its slices not stated unless in `more`.
fn loaded_in_slices(name: &str, positions: usize, torques: &[f64], more: &str) -> SceneResult {
    let text = format!(
        "{}\n[load]\ntorques_Nm = {torques:?}\npositions_per_pitch = {positions}\n{more}",
        read(name)
    );
    let scene = BevelScene::from_document(InputDocument::new(name, text)).unwrap();
    let pair = scene.load(&ModelShelf::default()).unwrap();
    pair.run(&|_, _| (), &AtomicBool::new(false)).unwrap()
}

/// Largest less smallest.
fn spread(values: &[f64]) -> f64 {
    let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    most - values.iter().copied().fold(f64::INFINITY, f64::min)
}

/// Without load the pair stands where the tooth contact analysis says; the pattern grows with the torque and stays off
/// toe and heel.
#[test]
fn bevel_slices_under_load() {
    for name in NAMES {
        let count = 41;
        let found = loaded(name, (12, count), &TORQUES, "");
        let file = PairFile::from_document(&InputDocument::new(name, read(name))).unwrap();
        let design = file.design().unwrap();
        let request = TcaRequest {
            per_pitch: 48,
            ..TcaRequest::default()
        };
        let flanks = design.flanks(FlankSide::Concave);
        let expected = tooth_contact(flanks, &file.blank, &request).unwrap();
        let lead: Vec<f64> = expected.error_rad.iter().copied().step_by(4).collect();
        let most = lead.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let bevel = found.bevel.unwrap();
        let sense = -bevel.side.mirror();
        // A slice's middle stands beside the contact by up to half its length, which can only open the gap, along the
        // more curved contact of an edge by a tenth of a micrometre: less with half the length.
        let pitch = TAU / bevel.teeth[0] as f64;
        let farthest = |found: &SceneResult| {
            let all = found.angle_rad.iter().zip(&found.unloaded_m);
            let off = all.map(|(angle, unloaded_m)| {
                let steps = (sense * angle / pitch * lead.len() as f64).round() as i64;
                let lead = lead[steps.rem_euclid(lead.len() as i64) as usize];
                (unloaded_m / bevel.radius_2_m - (lead - most)).abs()
            });
            off.fold(0.0, f64::max)
        };
        let finer = loaded(name, (12, 2 * count), &TORQUES[..1], "");
        let [off, less] = [farthest(&found), farthest(&finer)];
        assert!(off < 5e-6 && less < 5e-7, "{name}: {off:e} {less:e}");
        // At the even positions: between them the corners with and without load lie at different turns.
        let light = spread(found.curve(&found.te_m, 0)) / spread(&found.unloaded_m);
        assert!((light - 1.0).abs() < 0.03, "{light}");
        let figures = [0, 1, 2, 3].map(|torque| found.figures(torque));
        let of_bevel = figures.map(|f| f.bevel.unwrap());
        let sizes = of_bevel.map(|f| f.pattern.map(|[from, to]| to - from));
        let sizes = sizes.map(|[along, up]| along * up);
        assert!(sizes.is_sorted_by(|a, b| a < b), "{name} {sizes:?}");
        assert!(figures.is_sorted_by(|a, b| b.te_mean_m < a.te_mean_m));
        let along = of_bevel[2].pattern[0];
        assert!(along[0] > 0.05 && along[1] < 0.95, "{along:?}");
        assert!(of_bevel[3].mean_pairs > of_bevel[0].mean_pairs);
        // Torques balance: the gear's is stated, forces have the lever of their place.
        for position in found.even_positions_of(2) {
            let force: f64 = position.pressing().map(|at| at.force_n).sum();
            assert!(
                (force * bevel.radius_2_m / 100.0 - 1.0).abs() < 0.12,
                "{force}"
            );
        }
    }
}

/// Under a newton metre few of the default's slices carry (the transmission error of 15 slices is 2 % off): 100 are
/// taken, and the default where the load is spread over enough of them.
#[test]
fn light_loads_take_more_slices_by_themselves() {
    for name in NAMES {
        for (torque, slices, others) in [(1.0, 100, 31), (200.0, 31, 100)] {
            let own = loaded_in_slices(name, 12, &[torque], "");
            let stated = loaded(name, (12, slices), &[torque], "");
            let others = loaded(name, (12, others), &[torque], "");
            let [own, stated, others] = [own, stated, others].map(|of| of.figures(0).te_mean_m);
            assert_eq!(own, stated, "{name}, {torque} N m");
            assert_ne!(own, others);
        }
    }
}

/// Few even positions and those between them find the extremes of many, and the errors that are stated cover what they
/// miss: the curves have corners where pairs of teeth or single slices take load or give it up.
#[test]
fn stated_errors_cover_what_few_positions_miss() {
    for name in NAMES {
        let many = loaded(name, (240, 31), &TORQUES[1..], "");
        for positions in [8, 10] {
            let few = loaded(name, (positions, 31), &TORQUES[1..], "");
            for torque in 0..3 {
                let [found, expected] = [&few, &many].map(|of| of.figures(torque));
                let covered = |value: [f64; 2], stated: [Option<f64>; 2]| {
                    let off = (value[0] / value[1] - 1.0).abs();
                    let stated = stated.map(Option::unwrap);
                    // A curve is followed up and down.
                    assert!(
                        stated[0] <= 2.0 * PEAK_SHARE,
                        "{name} {positions} {torque}: {stated:?}"
                    );
                    let allowed = stated[0] + stated[1];
                    assert!(
                        off < allowed,
                        "{name} {positions} {torque}: {off:.1e} {stated:?}"
                    );
                };
                let both = [&found, &expected];
                covered(
                    both.map(|of| of.te_peak_to_peak_m),
                    both.map(|of| of.errors.te_positions),
                );
                covered(
                    both.map(|of| of.pressure_largest_pa),
                    both.map(|of| of.errors.pressure_positions),
                );
            }
            assert!(few.between.of(1).len() > 1);
            assert!(few.between.angle_rad[few.between.of(1)].is_sorted());
        }
    }
}

/// Slices have converged: from 41 to 82 the mean transmission error changes by less than 0.6 %, its change over the
/// pitch by less than 1 % of the mean, the mean pressure by less than 2 %, the largest one off the tips by less than 8
/// %.
#[test]
fn bevel_slices_converge() {
    for name in NAMES {
        let [coarse, fine] = [41, 82].map(|count| loaded(name, (12, count), &TORQUES[1..], ""));
        for torque in 0..3 {
            let change = |a: f64, b: f64| (a / b - 1.0).abs();
            let [a, b] = [&coarse, &fine].map(|of| of.figures(torque));
            let mean = change(a.te_mean_m, b.te_mean_m);
            let spread = (a.te_peak_to_peak_m - b.te_peak_to_peak_m).abs() / b.te_mean_m.abs();
            // Weighted by the force: the largest one, beside a tip, rises within a slice.
            let mean_pa = |of: &SceneResult| {
                let pressing = of
                    .even_positions_of(torque)
                    .flat_map(PressedPosition::pressing);
                let sums = pressing.fold([0.0; 2], |[p, f], at| {
                    [p + at.force_n * at.pressure_pa, f + at.force_n]
                });
                sums[0] / sums[1]
            };
            let pressure = change(mean_pa(&coarse), mean_pa(&fine));
            assert!(mean < 0.006 && spread < 0.01, "{name} {}", a.torque_nm);
            assert!(pressure < 0.02, "{name} {}: {pressure}", a.torque_nm);
            let largest = [a, b].map(|of| of.bevel.unwrap().pressures_pa[0]);
            assert!(change(largest[0], largest[1]) < 0.08, "{name} {largest:?}");
        }
    }
}

/// Flanks slide as the pitch cones would that roll on each other: by the relative speed of turning times the distance
/// from the cones' common generator, taken here from the gear's side of each contact. Without friction nothing is lost,
/// twice the friction loses twice as much.
#[test]
fn bevel_flanks_slide_about_the_common_generator() {
    let name = "bevel_13_35.toml";
    let with_friction = |friction: f64| {
        loaded(
            name,
            (12, 15),
            &[100.0],
            &format!("friction = {friction:?}\n"),
        )
    };
    let found = with_friction(0.0);
    let file = PairFile::from_document(&InputDocument::new(name, read(name))).unwrap();
    let flanks = BevelSlices::new(&file.blank, &file.design().unwrap(), 15).unwrap();
    let bevel = found.bevel.unwrap();
    let (pinion, side) = (&file.blank.members[0], bevel.side);
    let [pinion_teeth, gear_teeth] = bevel.teeth.map(|teeth| teeth as f64);
    let ratio = pinion_teeth / gear_teeth;
    let assembly = Assembly::new(&file.blank, &AssemblyError::default());
    let axes = assembly.members.map(|m| m.axis());
    let relative = axes[0] + axes[1] * ratio;
    let (sin, cos) = pinion.pitch_angle_rad.sin_cos();
    let generator = nalgebra::Vector3::new(sin, 0.0, cos);
    assert!((relative.normalize() - generator).norm() < 1e-12);
    let mut most = 0.0f64;
    for (position, angle) in found.even_positions_of(0).zip(&found.angle_rad) {
        for at in position.pressing().filter(|at| !at.is_on_tip()) {
            let along = at.along_m(1) / bevel.face_widths_m[1] + 0.5;
            let own = flanks.pair().flank_point_m(side, 1, [along, at.up(1)]);
            let [_, tooth] = bevel.teeth_of(at.pair);
            let turn = ratio * side.mirror() * angle - flanks.pair().azimuths_rad(side)[1]
                + TAU * tooth as f64 / gear_teeth;
            let (s, c) = turn.sin_cos();
            let turned =
                nalgebra::Vector3::new(own.x * c - own.y * s, own.x * s + own.y * c, own.z);
            let r = assembly.members[1].axes * turned;
            let distance = (r - generator * r.dot(&generator)).norm();
            let expected = relative.norm() * distance;
            most = most.max(expected);
            // The teeth deflect by some micrometres, and slices lie beside their places on the gear.
            assert!(
                (at.sliding_m() - expected).abs() < 5e-5,
                "{at:?} {expected}"
            );
        }
    }
    assert!(most > 1e-3, "{most}");
    let efficiency = |found: &SceneResult| found.figures(0).bevel.unwrap().efficiency.unwrap();
    assert_eq!(efficiency(&found), 1.0);
    let lost = [0.05, 0.1].map(|friction| 1.0 / efficiency(&with_friction(friction)) - 1.0);
    assert!(lost[0] > 1e-3 && lost[0] < 0.05, "{lost:?}");
    assert!((lost[1] / lost[0] - 2.0).abs() < 0.01, "{lost:?}");
}

/// The file keeps all of a result, and says what is wrong with one that was altered.
#[test]
fn a_bevel_result_is_kept_as_it_is() {
    let found = loaded("bevel_20_20.toml", (4, 5), &[50.0], "friction = 0.1\n");
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("pair.h5");
    found.write(&file).unwrap();
    assert_eq!(SceneResult::read(&file).unwrap(), found);
}
