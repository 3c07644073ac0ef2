//! Studies of what is neither a gear pair nor a run in time: bevel pairs, bearings, natural
//! frequencies, sweeps; figures against the models themselves.

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use gearmesh_bearings::bearing_file::BearingFromFile;
use gearmesh_bearings::{
    AppliedBearingLoad, Control, Operation, QuasiStaticBearing, TiltCondition,
};
use gearmesh_bevel::{PairFile, tooth_contact};
use gearmesh_geometry::input::InputDocument;
use gearmesh_scene::ModelShelf;
use gearmesh_scene::pair::BevelScene;
use gearmesh_scene::study::{SelectedValue, StudyOptions, StudyOutcome, run_study};
use gearmesh_specification::study::Study;

pub(crate) fn fe_models() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fe_models")
}

/// A study of a scene in `from`, with results in a folder of its own.
pub(crate) fn studied(from: &Path, text: &str) -> Result<(StudyOutcome, String), String> {
    let out = tempfile::tempdir().unwrap();
    let document = InputDocument::new("study.toml", format!("title = \"s\"\n{text}"));
    let study = Study::from_document(document, from).map_err(|e| e.to_string())?;
    let options = StudyOptions {
        folder: out.path(),
        stop: &AtomicBool::new(false),
        progress: &|_, _| (),
        reduce: &|_| Err("no gear varies".to_owned()),
    };
    let outcome = run_study(&study, &options).map_err(|e| e.to_string())?;
    let table = std::fs::read_to_string(out.path().join("study.csv")).unwrap();
    Ok((outcome, table))
}

/// Numbers of a case, column by column.
pub(crate) fn numbers(outcome: &StudyOutcome, case: usize) -> Vec<f64> {
    let figures = outcome.cases[case].figures.as_ref().unwrap();
    let number = |value: SelectedValue| match value {
        SelectedValue::Single(value) => value,
        SelectedValue::Series(figures) => figures.mean,
    };
    figures.iter().map(|one| number(one.value)).collect()
}

#[test]
fn a_bevel_pair_is_analysed_in_each_assembly() {
    let columns = "columns = [\"te_peak_to_peak_urad\", \"contact_ratio\"]\n";
    let offset =
        "[[parameter]]\nname = \"offset\"\nkeys = [\"tca.offset_um\"]\nvalues = [-20.0, -10.0]\n";
    let text = format!("scene = \"bevel_20_20.toml\"\n{columns}{offset}");
    let (outcome, table) = studied(&fe_models(), &text).unwrap();
    assert_eq!(outcome.cases.len(), 3);
    for (case, offset_m) in [(0, 0.0), (1, -20e-6), (2, -10e-6)] {
        let mut file = PairFile::read(&fe_models().join("bevel_20_20.toml")).unwrap();
        file.tca.error.offset_m = offset_m;
        let design = file.design().unwrap();
        let found = tooth_contact(design.flanks(file.pinion_flank), &file.blank, &file.tca);
        let found = found.unwrap();
        let expected = [1e6 * found.peak_to_peak_rad, found.contact_ratio];
        for (one, expected) in numbers(&outcome, case).iter().zip(expected) {
            assert!((one / expected - 1.0).abs() < 1e-9, "{one} {expected}");
        }
    }
    assert!(table.starts_with("offset,te_peak_to_peak_urad,contact_ratio,file,failure\n"));
    let slip = text.replace("contact_ratio", "contact_ratoi");
    let told = studied(&fe_models(), &slip).unwrap_err();
    assert!(told.contains("did you mean `contact_ratio`?"), "{told}");
    let slip = text.replace("offset_um", "ofset_um");
    let told = studied(&fe_models(), &slip).unwrap_err();
    assert!(told.contains("offset_um"), "{told}");
    // Of two new keys the one that is wrong is blamed.
    let second = "[[parameter]]\nname = \"angle\"\nkeys = [\"tca.shaft_angle_mrad\"]\nuniform = { from = -0.1, to = 0.1 }\n";
    let sampled = "design = \"random\"\nsamples = 2\n";
    let slip = format!("{sampled}{slip}{second}");
    let told = studied(&fe_models(), &slip).unwrap_err();
    assert!(told.contains("parameter.0.keys: `tca.ofset_um`"), "{told}");
}

/// Assemblies in which teeth jam fail, as `gearmesh tca` refuses them; the others say how much backlash is left.
#[test]
fn bevel_assemblies_that_jam_fail() {
    let offset =
        "[[parameter]]\nname = \"offset\"\nkeys = [\"tca.offset_um\"]\nvalues = [-5000.0, 100.0]\n";
    for pair in ["bevel_20_20.toml", "bevel_20_20_loaded.toml"] {
        let text = format!("scene = \"{pair}\"\ncolumns = [\"backlash_least_mm\"]\n{offset}");
        let (outcome, _) = studied(&fe_models(), &text).unwrap();
        let told = outcome.cases[1].figures.as_ref().unwrap_err();
        assert!(told.contains("teeth jam"), "{told}");
        let [designed, moved] = [0, 2].map(|case| numbers(&outcome, case)[0]);
        // No backlash is asked for, and an offset to the first order changes none.
        assert!(
            designed.abs() < 1e-3 && moved.abs() < 0.02,
            "{designed} {moved}"
        );
    }
}

/// Under the torques of its `[load]` a bevel pair has a line for each, with the figures that this assembly has by
/// itself.
#[test]
fn a_bevel_pair_is_loaded_in_each_assembly() {
    let columns =
        "columns = [\"loaded_te_mean_urad\", \"pressure_largest_MPa\", \"contact_ratio\"]\n";
    let offset = "[[parameter]]\nname = \"offset\"\nkeys = [\"tca.offset_um\"]\nvalues = [20.0]\n";
    let torques =
        "[[parameter]]\nname = \"torque\"\nkeys = [\"load.torques_Nm.1\"]\nvalues = [80.0]\n";
    let text = format!("scene = \"bevel_20_20_loaded.toml\"\n{columns}{offset}{torques}");
    let (outcome, table) = studied(&fe_models(), &text).unwrap();
    assert!(table.starts_with("offset,torque,torque_Nm,loaded_te_mean_urad,pressure_largest_MPa,contact_ratio,file,failure\n"));
    for (case, offset_m, second_nm) in [(0, 0.0, 100.0), (1, 20e-6, 100.0), (2, 0.0, 80.0)] {
        let document = InputDocument::read(&fe_models().join("bevel_20_20_loaded.toml")).unwrap();
        let mut scene = BevelScene::from_document(document).unwrap();
        scene.file.tca.error.offset_m = offset_m;
        let torques_nm = &mut scene.file.load.as_mut().unwrap().torques_nm;
        torques_nm[1] = second_nm;
        let pair = scene.load(&ModelShelf::default()).unwrap();
        let expected = pair.run(&|_, _| (), &AtomicBool::new(false)).unwrap();
        let found = numbers(&outcome, case);
        assert_eq!(found.len(), 3 * expected.torque_nm.len());
        for (torque, row) in found.chunks(3).enumerate() {
            let of = expected.figures(torque);
            let mean_rad = of.te_mean_m / expected.bevel.unwrap().radius_2_m;
            let own = [1e6 * mean_rad, 1e-6 * of.pressure_largest_pa];
            for (one, expected) in row.iter().zip(own) {
                assert!((one / expected - 1.0).abs() < 1e-9, "{one} {expected}");
            }
        }
        // More torque, more deflection.
        assert!(found[3] < found[0] && found[6] < found[3], "{found:?}");
    }
}

pub(crate) const BEARING: &str = "scene = \"bearing_pair_500_N.toml\"\noperation = { load_N = [0.0, -1000.0, 300.0], speed_rpm = 6000.0 }\n";

#[test]
fn a_bearing_is_loaded_as_the_study_says() {
    let text = format!(
        "{BEARING}design = \"grid\"\ncolumns = [\"displacement_y_um\", \"stiffness_y_N_per_um\"]\n\
         [[parameter]]\nname = \"preload\"\nkeys = [\"preload_N\"]\nvalues = [300.0]\n\
         [[parameter]]\nname = \"speed\"\nkeys = [\"operation.speed_rpm\"]\nvalues = [0.0, 6000.0]\n"
    );
    let (outcome, _) = studied(&fe_models(), &text).unwrap();
    let source = std::fs::read_to_string(fe_models().join("bearing_pair_500_N.toml")).unwrap();
    let source = source.replace("preload_N = 500.0", "preload_N = 300.0");
    let found = BearingFromFile::from_document(&InputDocument::new("b", source)).unwrap();
    let bearing = QuasiStaticBearing::new(&found.definition).unwrap();
    for (case, inner_rad_per_s) in [(0, 0.0), (1, 100.0 * TAU)] {
        let load = AppliedBearingLoad {
            force_n: [0.0, -1000.0, 300.0],
            tilt: TiltCondition::Moments([0.0; 2]),
        };
        let operation = Operation {
            inner_rad_per_s,
            outer_rad_per_s: 0.0,
            cage_angle_rad: 0.0,
            inner_angle_rad: 0.0,
            control: Control::OuterRace,
        };
        let pose = bearing.equilibrium(&load, &operation).unwrap();
        let (ring, _) = bearing.loads(&pose, &operation).unwrap();
        let expected = [1e6 * pose.to_five()[1], -1e-6 * ring.tangent[(1, 1)]];
        for (one, expected) in numbers(&outcome, case).iter().zip(expected) {
            assert!((one / expected - 1.0).abs() < 1e-9, "{one} {expected}");
        }
    }
    let wrong = text.replace("load_N =", "laod_N =");
    let told = studied(&fe_models(), &wrong).unwrap_err();
    assert!(told.contains("laod_N"), "{told}");
    let wrong = text.replace("[\"operation.speed_rpm\"]", "[\"operation.sped_rpm\"]");
    let told = studied(&fe_models(), &wrong).unwrap_err();
    assert!(told.contains("sped_rpm"), "{told}");
    // A list of which nothing is stated.
    let operation = "operation = { load_N = [0.0, -1000.0, 300.0], speed_rpm = 6000.0 }\n";
    let none = text.replace(operation, "");
    let none = none.replace("operation.speed_rpm", "operation.load_N.2");
    let told = studied(&fe_models(), &none).unwrap_err();
    assert!(
        told.contains("it states no `operation.load_N`; state the whole list"),
        "{told}"
    );
    let pair = text.replace("bearing_pair_500_N.toml", "bevel_20_20.toml");
    let told = studied(&fe_models(), &pair).unwrap_err();
    assert!(told.contains("`operation` belongs to bearings"), "{told}");
}

/// A body of 1 kg on a spring of 400 N/m and its damper: ω = 20 rad/s, ζ = c/(2 m ω).
pub(crate) fn oscillator(run: &str) -> String {
    format!(
        "title = \"oscillator\"\n[run]\n{run}\n\
         [[body]]\nname = \"block\"\nmass_kg = 1.0\ninertia_kg_m2 = [1.0, 1.0, 1.0]\nposition_mm = [100.0, 0.0, 0.0]\nvelocity_mm_per_s = [500.0, 0.0, 0.0]\n\
         [[joint]]\nname = \"rail\"\nkind = \"prismatic\"\nbody_2 = \"block\"\naxis = [1.0, 0.0, 0.0]\n\
         [[spring]]\nname = \"spring\"\nbody_2 = \"block\"\nat_1_mm = [0.0, 0.0, 0.0]\nat_2_mm = [100.0, 0.0, 0.0]\nstiffness_N_per_mm = 0.4\nfree_length_mm = 100.0\ndamping_N_s_per_mm = 0.004\n"
    )
}

#[test]
fn natural_frequencies_follow_the_stiffness() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(
        folder.path().join("scene.toml"),
        oscillator("kind = \"eigen\""),
    )
    .unwrap();
    let text = "scene = \"scene.toml\"\ncolumns = [\"mode_1_frequency_Hz:mean\", \"mode_1_damping_ratio:mean\"]\n\
        [[parameter]]\nname = \"stiffness\"\nkeys = [\"spring.0.stiffness_N_per_mm\"]\nvalues = [1.6]\n";
    let (outcome, _) = studied(folder.path(), text).unwrap();
    for (case, omega) in [(0, 20.0_f64), (1, 40.0)] {
        let ratio = 4.0 / (2.0 * omega);
        let damped = omega * (1.0 - ratio * ratio).sqrt() / TAU;
        let found = numbers(&outcome, case);
        assert!((found[0] / damped - 1.0).abs() < 1e-6, "{found:?} {damped}");
        assert!((found[1] / ratio - 1.0).abs() < 1e-6, "{found:?} {ratio}");
    }
    let slip = text.replace("mode_1_damping", "mode_1_dampnig");
    let told = studied(folder.path(), &slip).unwrap_err();
    assert!(
        told.contains("did you mean `mode_1_damping_ratio`?"),
        "{told}"
    );
}

/// The line of a run in time: v = v₀ e^(−δt) cos ωt, near its frequency and far from it.
#[test]
fn a_line_of_the_spectrum_is_a_column() {
    let folder = tempfile::tempdir().unwrap();
    let run = "kind = \"transient\"\nend_s = 6.2831853\n[solver]\nstep_s = 2e-3\n[output]\ninterval_s = 1e-2";
    let text = oscillator(run).replace("damping_N_s_per_mm = 0.004\n", "");
    std::fs::write(folder.path().join("scene.toml"), text).unwrap();
    let text = "scene = \"scene.toml\"\ncolumns = [\"bodies/block/velocity_x_m_per_s:line-3.1831Hz\", \"bodies/block/velocity_x_m_per_s:line-10Hz\", \"bodies/block/velocity_x_m_per_s\"]\n\
        [[parameter]]\nname = \"mass\"\nkeys = [\"body.0.mass_kg\"]\nvalues = [1.0]\n";
    let (outcome, table) = studied(folder.path(), text).unwrap();
    let found = numbers(&outcome, 0);
    assert!((found[0] - 0.5).abs() < 2e-3, "{found:?}");
    assert!(found[1] < 1e-3, "{found:?}");
    // A number beside a series stands in the place of its mean.
    assert!(table.starts_with("mass,column,mean,deviation,least,largest,file,failure\n"));
    let commas: Vec<usize> = table
        .lines()
        .map(|line| line.matches(',').count())
        .collect();
    assert!(commas.windows(2).all(|w| w[0] == w[1]), "{table}");
    let wrong = text.replace("line-10Hz", "line-10");
    let told = studied(folder.path(), &wrong).unwrap_err();
    assert!(told.contains("line-10"), "{told}");
}

/// Rows every 10 ms hold filtered columns up to 40 Hz; rows every 0.25 s are too far apart for a column of 3.2 Hz that
/// is not filtered.
#[test]
fn a_line_that_rows_cannot_tell_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    for (interval, column, told) in [
        (
            "1e-2",
            "elements/spring/force_world_x_N:line-45Hz",
            "their spectrum is right up to 40 Hz",
        ),
        (
            "0.25",
            "bodies/block/velocity_x_m_per_s:line-1Hz",
            "vibrates faster than 2 Hz and stands at false places",
        ),
    ] {
        let run = format!(
            "kind = \"transient\"\nend_s = 20.0\n[solver]\nstep_s = 2e-3\n[output]\ninterval_s = {interval}"
        );
        let text = oscillator(&run).replace("damping_N_s_per_mm = 0.004\n", "");
        std::fs::write(folder.path().join("scene.toml"), text).unwrap();
        let text = format!(
            "scene = \"scene.toml\"\ncolumns = [\"{column}\"]\n[[parameter]]\nname = \"mass\"\nkeys = [\"body.0.mass_kg\"]\nvalues = [1.0]\n"
        );
        let (outcome, _) = studied(folder.path(), &text).unwrap();
        let failure = outcome.cases[0].figures.as_ref().unwrap_err();
        assert!(failure.contains(told), "{failure}");
    }
}

/// A life of a bearing over the load: L10 goes with its third power.
#[test]
fn lives_of_ratings_are_columns() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(
        folder.path().join("balls.toml"),
        "name = \"6205\"\nkind = \"deep-groove\"\nballs = 9\nball_diameter_mm = 7.94\npitch_diameter_mm = 39.04\n\
         inner_conformity = 0.52\nouter_conformity = 0.53\n[ratings]\ndynamic_N = 14000.0\nstatic_N = 7850.0\n",
    )
    .unwrap();
    std::fs::write(
        folder.path().join("shaft.toml"),
        "title = \"shaft\"\n[run]\nkind = \"static\"\n[[body]]\nname = \"shaft\"\nmass_kg = 1.0\ninertia_kg_m2 = [2e-3, 2e-3, 1e-3]\n\
         speed_rpm = 3000.0\n[[bearing]]\nname = \"front\"\nbody_2 = \"shaft\"\naxis = [0, 0, 1]\n\
         model = { kind = \"quasi-static\", file = \"balls.toml\" }\n[[load]]\nname = \"push\"\nbody = \"shaft\"\nforce_N = 1000.0\n\
         along = [1.0, 0.0, 0.0]\n[[rating]]\nkind = \"bearing-life\"\nbearing = \"front\"\n",
    )
    .unwrap();
    let study = |columns: &str| {
        format!(
            "scene = \"shaft.toml\"\ncolumns = [{columns}]\n[[parameter]]\nname = \"load\"\nkeys = [\"load.0.force_N\"]\nvalues = [1000.0, 2000.0]\n"
        )
    };
    let column = "\"ratings/bearing front/bearing_l10_mrev\"";
    let (outcome, table) = studied(folder.path(), &study(column)).unwrap();
    // The first case is the scene as it is.
    let last = outcome.cases.len() - 1;
    let [one, two] = [numbers(&outcome, last - 1)[0], numbers(&outcome, last)[0]];
    assert!(
        (one - 2744.0).abs() < 1e-3 && (two - 343.0).abs() < 1e-3,
        "{one} {two}"
    );
    assert!(
        table.contains("ratings/bearing front/bearing_l10_mrev"),
        "{table}"
    );
    let refused = studied(
        folder.path(),
        &study("\"ratings/bearing front/bearing_l10_mrev:mean\""),
    )
    .unwrap_err();
    assert!(
        refused.contains("a figure of a rating or a planetary set is one number"),
        "{refused}"
    );
    let refused = studied(
        folder.path(),
        &study("\"ratings/bearing front/bearing_l20_mrev\""),
    )
    .unwrap_err();
    assert!(refused.contains("bearing_l10_mrev"), "{refused}");
}
