//! Positions at events and peaks: figures of a coarse even grid against those of a fine one, and how many they are.

use crate::made_up_gears;
#[path = "event_positions/own_figure.rs"]
mod own_figure;

use std::path::Path;

use gearmesh_geometry::input::InputDocument;
use gearmesh_scene::{Scene, SceneResult, load, run};

fn pair_text(path: &str, pitches: usize, points: usize) -> String {
    format!(
        "title = \"made up\"\n[pair]\ngear_1 = \"gear_30.h5\"\ngear_2 = \"gear_41.h5\"\ncentre_distance_mm = 106.8\n[mesh]\nmodel.kind = \"hybrid\"\n\
         model.local = \"weber-banaschek\"\nteeth.path = \"{path}\"\n[run]\ntorques_Nm = [60.0, 240.0]\npitches = {pitches}\npoints_per_pitch = {points}\n\
         [gauges]\ngear_1 = [\"g0\"]\n"
    )
}

fn ran(folder: &Path, path: &str, pitches: usize, points: usize) -> SceneResult {
    ran_text(folder, pair_text(path, pitches, points))
}

fn ran_text(folder: &Path, text: String) -> SceneResult {
    let scene = Scene::from_document(InputDocument::new("pair.toml", text), folder).unwrap();
    run(&load(scene).unwrap(), &|_, _| ()).unwrap()
}

/// Largest less smallest of the even positions of a torque, and their largest pressure.
fn of_even(r: &SceneResult, torque: usize) -> [f64; 2] {
    let te = r.curve(&r.te_m, torque);
    let ends = te
        .iter()
        .fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(*x), b.max(*x)));
    let block = r.lines.pressure_pa.len() / r.torque_nm.len();
    let own = &r.lines.pressure_pa[torque * block..(torque + 1) * block];
    [ends.1 - ends.0, own.iter().copied().fold(0.0, f64::max)]
}

/// The fine grid has 2000 positions a pitch, 167 for each of the coarse one.
#[test]
fn a_coarse_grid_has_the_peaks_of_a_fine_one() {
    let folder = tempfile::tempdir().unwrap();
    made_up_gears::write_models(folder.path());
    let (mut counts, mut missed) = (Vec::new(), false);
    for path in ["extended", "line-of-action"] {
        let coarse = ran(folder.path(), path, 1, 12);
        let fine = ran(folder.path(), path, 1, 2000);
        for torque in 0..2 {
            let [te, pressure] = of_even(&fine, torque);
            let found = coarse.figures(torque);
            let off = |found: f64, right: f64| (found / right - 1.0).abs();
            let (te_off, pressure_off) = (
                off(found.te_peak_to_peak_m, te),
                off(found.pressure_largest_pa, pressure),
            );
            // What is left open by two halvings may be left once more, and as much by the fine grid's own steps.
            assert!(te_off < 4e-3, "{path} {torque}: {te_off:.1e}");
            assert!(pressure_off < 4e-3, "{path} {torque}: {pressure_off:.1e}");
            let [even_te, even_pressure] = of_even(&coarse, torque);
            missed |= off(even_te, te) > 1e-2 || off(even_pressure, pressure) > 1e-2;
            let factor_off = off(found.k_h_beta, fine.lines.k_h_beta[torque]);
            assert!(factor_off < 4e-3, "{path} {torque}: {factor_off:.1e}");
            let errors = found.errors;
            assert!(errors.te_positions.unwrap() < 2e-3, "{errors:?}");
            assert!(errors.pressure_positions.unwrap() < 2e-3, "{errors:?}");
        }
        counts.extend(coarse.between.count);
    }
    // Effort: of 60 and 240 N m on the extended path, then on the line of action.
    assert_eq!(counts, [70, 82, 25, 25]);
    assert!(missed, "the even positions have it all");
}

/// Root strain is largest where pairs change, in a pitch that is not the first. The coarse grid has the change in
/// steps of 1/384 of a pitch, in which strain changes by as much of its range where a tooth passes over in one pitch;
/// the fine grid has steps of 1/1000.
#[test]
fn root_strain_has_its_ends_in_whichever_pitch_they_are() {
    let folder = tempfile::tempdir().unwrap();
    made_up_gears::write_models(folder.path());
    let mut missed = false;
    for path in ["extended", "line-of-action"] {
        let [coarse, fine] = [12, 1000].map(|points| {
            let start = format!("start_deg = {}\npitches = 4", -2.0 * 360.0 / 30.0);
            let text = pair_text(path, 4, points).replace("pitches = 4", &start);
            ran_text(folder.path(), text)
        });
        for (torque, method) in [(0, 1), (0, 2), (1, 1), (1, 2)] {
            let range = |r: &SceneResult| {
                let [low, high] = r.strain_ends(0, method, torque);
                high - low
            };
            let right = range(&fine);
            let off = (range(&coarse) / right - 1.0).abs();
            assert!(off < 4e-3, "{path} {torque} {method}: {off:.1e}");
            let mut even = coarse.clone();
            even.strain[0].between = Default::default();
            missed |= (range(&even) / right - 1.0).abs() > 1e-2;
        }
    }
    assert!(missed, "the even positions have it all");
}

/// Further pitches of gears whose teeth are all alike need no further positions; means are those of the even grid.
#[test]
fn only_the_first_period_has_further_positions() {
    let folder = tempfile::tempdir().unwrap();
    made_up_gears::write_models(folder.path());
    let one = ran(folder.path(), "extended", 1, 12);
    let three = ran(folder.path(), "extended", 3, 12);
    assert_eq!(one.between.count, three.between.count);
    for torque in 0..2 {
        let even = one.curve(&one.te_m, torque);
        let mean = even.iter().sum::<f64>() / 12.0;
        assert!((one.figures(torque).te_mean_m - mean).abs() < 1e-18);
        let swing = |r: &SceneResult| r.figures(torque).te_peak_to_peak_m;
        assert!((swing(&one) / swing(&three) - 1.0).abs() < 1e-9);
    }
    let path = folder.path().join("result.h5");
    one.write(&path).unwrap();
    assert_eq!(SceneResult::read(&path).unwrap(), one);
    assert!(
        one.errors_in_words().starts_with("positions "),
        "{}",
        one.errors_in_words()
    );
    let each = one.between.angle_rad.len();
    assert_eq!(one.strain[0].between[1].len(), each);
    assert_eq!(three.strain[0].between[1].len(), 3 * each);
}

/// What docs/extending.md shows.
#[test]
fn a_figure_is_a_row() {
    let folder = tempfile::tempdir().unwrap();
    made_up_gears::write_models(folder.path());
    let result = ran(folder.path(), "line-of-action", 1, 12);
    let curve = result.curve(&result.tangent_n_per_m, 0).iter();
    let found = own_figure::at_the_doors(&result);
    let ripple: f64 = found[1].parse().unwrap();
    let mean = result.figures(0).tangent_mean_n_per_m;
    let even =
        curve.clone().fold(0.0, |a: f64, b| a.max(*b)) - curve.fold(f64::MAX, |a, b| a.min(*b));
    // Events between the even positions may add to their range, of which the text has four decimals.
    assert!(ripple > 0.0 && ripple >= even / mean - 5e-5, "{ripple}");
    assert_eq!(
        [&found[0], &found[2], &found[3]],
        ["stiffness ripple", "stiffness_ripple", "stiffness_ripple"]
    );
}
