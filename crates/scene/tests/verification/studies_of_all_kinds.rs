//! Studies and optimisations of what is neither a gear pair nor a run in time: bevel pairs, bearings, natural
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
use gearmesh_scene::optimise::{Optimisation, optimise};
use gearmesh_scene::pair::BevelScene;
use gearmesh_scene::study::{SelectedValue, Study, StudyOptions, StudyOutcome, run_study};

fn fe_models() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fe_models")
}

/// A study of a scene in `from`, with results in a folder of its own.
fn studied(from: &Path, text: &str) -> Result<(StudyOutcome, String), String> {
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
fn numbers(outcome: &StudyOutcome, case: usize) -> Vec<f64> {
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

const BEARING: &str = "scene = \"bearing_pair_500_N.toml\"\noperation = { load_N = [0.0, -1000.0, 300.0], speed_rpm = 6000.0 }\n";

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
fn oscillator(run: &str) -> String {
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

/// More preload deflects less and presses more: the front of both goes from one bound to the other.
#[test]
fn a_bearing_has_a_front_of_deflection_against_pressure() {
    let text = format!(
        "title = \"preload\"\n{BEARING}trials = 20\nsearches = 2\n\
         [[variable]]\nname = \"preload\"\nkeys = [\"preload_N\"]\nfrom = 100.0\nto = 1000.0\n\
         [[objective]]\nname = \"deflection\"\nterm = [{{ column = \"displacement_y_um\", weight = -1.0 }}]\n\
         [[objective]]\nname = \"pressure\"\nterm = [{{ column = \"pressure_outer_largest_MPa\" }}]\n"
    );
    let problem = |text: &str| {
        Optimisation::from_document(InputDocument::new("o.toml", text), &fe_models()).unwrap()
    };
    let scratch = tempfile::tempdir().unwrap();
    let stop = AtomicBool::new(false);
    let found = optimise(&problem(&text), scratch.path(), &stop, &|_, _| ()).unwrap();
    let ends = [found.front.first(), found.front.last()].map(|end| end.unwrap().values[0]);
    assert!((ends[0] - 1000.0).abs() < 1.0, "{ends:?}");
    assert!((ends[1] - 100.0).abs() < 20.0, "{ends:?}");
    assert!(found.front.len() > 5);
    let wrong = text.replace("displacement_y_um", "displacment_y_um");
    let told = optimise(&problem(&wrong), scratch.path(), &stop, &|_, _| ());
    let told = told.unwrap_err().to_string();
    assert!(told.contains("did you mean `displacement_y_um`?"), "{told}");
}

/// A torque beside a column that has nothing of the load is refused, for the pair would be made for no load at all.
#[test]
fn a_torque_belongs_to_columns_under_load() {
    let text = "title = \"t\"\nscene = \"bevel_20_20_loaded.toml\"\ntrials = 20\n\
        [[variable]]\nname = \"offset\"\nkeys = [\"tca.offset_um\"]\nfrom = -10.0\nto = 10.0\n\
        [[objective]]\nname = \"TE\"\nterm = [{ column = \"te_peak_to_peak_urad\", torque_Nm = 100.0 }]\n";
    let scratch = tempfile::tempdir().unwrap();
    let stop = AtomicBool::new(false);
    let told = |text: &str| {
        let document = InputDocument::new("o.toml", text);
        let problem = Optimisation::from_document(document, &fe_models()).unwrap();
        optimise(&problem, scratch.path(), &stop, &|_, _| ())
            .unwrap_err()
            .to_string()
    };
    let found = told(text);
    assert!(
        found.contains("o.toml:11: objective.0.term.0.torque_Nm: `te_peak_to_peak_urad` is a number without load"),
        "{found}"
    );
    let found = told(&text.replace("_loaded.toml", ".toml"));
    assert!(
        found.contains("bevel pairs with [load]; remove it"),
        "{found}"
    );
}

/// Choices that are tried grow with `trials`, not with the variables: a number that does not do for the corners of a
/// simplex is refused.
#[test]
fn many_variables_ask_for_no_more_trials_than_stated() {
    const BODIES: usize = 12;
    let folder = tempfile::tempdir().unwrap();
    let body = |k: usize| {
        format!("[[body]]\nname = \"{k}\"\nmass_kg = 1.0\ninertia_kg_m2 = [1.0, 1.0, 1.0]\n")
    };
    let scene = format!(
        "title = \"t\"\n[run]\nkind = \"transient\"\nend_s = 2e-3\n[solver]\nstep_s = 1e-3\n[output]\ninterval_s = 1e-3\n{}",
        (0..BODIES).map(body).collect::<String>()
    );
    std::fs::write(folder.path().join("scene.toml"), scene).unwrap();
    let text = |trials: usize| {
        let variable = |k: usize| {
            format!(
                "[[variable]]\nname = \"{k}\"\nkeys = [\"body.{k}.mass_kg\"]\nfrom = 1.0\nto = 2.0\n"
            )
        };
        format!(
            "title = \"t\"\nscene = \"scene.toml\"\ntrials = {trials}\n{}[[objective]]\nname = \"o\"\n\
             term = [{{ column = \"bodies/0/velocity_x_m_per_s:largest\" }}]\n",
            (0..BODIES).map(variable).collect::<String>()
        )
    };
    let read = |trials| {
        Optimisation::from_document(InputDocument::new("o.toml", text(trials)), folder.path())
    };
    let told = read(20).unwrap_err().to_string();
    assert!(
        told.contains("trials: found 20 in 1 searches, allowed are 26 and more of 12 variables"),
        "{told}"
    );
    let stop = AtomicBool::new(false);
    let found = optimise(&read(26).unwrap(), folder.path(), &stop, &|_, _| ()).unwrap();
    assert!(found.tried.len() <= 26, "{}", found.tried.len());
}

/// The damper that lets a block swing least over a second is the strongest one that is allowed.
#[test]
fn a_run_in_time_is_optimised() {
    let folder = tempfile::tempdir().unwrap();
    let run =
        "kind = \"transient\"\nend_s = 1.0\n[solver]\nstep_s = 5e-3\n[output]\ninterval_s = 1e-2";
    std::fs::write(folder.path().join("scene.toml"), oscillator(run)).unwrap();
    let text = "title = \"damper\"\nscene = \"scene.toml\"\ntrials = 20\n\
        [[variable]]\nname = \"damping\"\nkeys = [\"spring.0.damping_N_s_per_mm\"]\nfrom = 0.001\nto = 0.01\n\
        [[objective]]\nname = \"swing\"\nterm = [{ column = \"bodies/block/velocity_x_m_per_s:deviation\" }]\n";
    let stop = AtomicBool::new(false);
    let problem = |text: &str| {
        Optimisation::from_document(InputDocument::new("o.toml", text), folder.path()).unwrap()
    };
    let found = optimise(&problem(text), folder.path(), &stop, &|_, _| ()).unwrap();
    assert!((found.front[0].values[0] - 0.01).abs() < 1e-5, "{found:?}");
    // Runs leave nothing behind.
    let left: Vec<_> = std::fs::read_dir(folder.path()).unwrap().collect();
    assert_eq!(left.len(), 1);
    let series = text.replace(":deviation", "");
    let told = optimise(&problem(&series), folder.path(), &stop, &|_, _| ());
    let told = told.unwrap_err().to_string();
    assert!(
        told.contains("is a series; say which number of it"),
        "{told}"
    );
}

/// A longer contact ellipse takes load from the middle of the tooth: the longest that is allowed is best. The key
/// stands in the pair file that the scene's mesh names.
#[test]
fn a_key_of_a_bevel_pair_in_motion_is_optimised() {
    let folder = tempfile::tempdir().unwrap();
    let scene = std::fs::read_to_string(fe_models().join("dynamics_bevel_20_20_slices.toml"));
    let pair = fe_models().join("bevel_20_20.toml");
    let pair = std::fs::canonicalize(pair).unwrap().display().to_string();
    let scene = scene.unwrap().replace("bevel_20_20.toml", &pair);
    let scene = scene
        .replace("end_s = 0.06", "end_s = 0.001")
        .replace("end_s = 0.01,", "end_s = 0.0005,");
    std::fs::write(folder.path().join("scene.toml"), scene).unwrap();
    let key = "gear_mesh.0.bevel_pair:pinion.ellipse_half_length_mm";
    let text = format!(
        "title = \"t\"\nscene = \"scene.toml\"\ntrials = 20\nscatter_samples = 1\nfrom_s = 0.0006\n\
         [[variable]]\nname = \"ellipse\"\nkeys = [\"{key}.0\", \"{key}.1\"]\nfrom = 3.0\nto = 5.0\n\
         [[scatter]]\nname = \"path\"\nkeys = [\"gear_mesh.0.bevel_pair:pinion.path_angle_deg.0\"]\nuniform = {{ from = 0.0, to = 1e-9 }}\n\
         [[objective]]\nname = \"middle\"\nterm = [{{ column = \"elements/mesh/line_load_slice_8_N_per_m:mean\" }}]\n"
    );
    let scratch = tempfile::tempdir().unwrap();
    let stop = AtomicBool::new(false);
    let optimum = |text: &str| {
        let document = InputDocument::new("o.toml", text);
        let problem = Optimisation::from_document(document, folder.path()).unwrap();
        optimise(&problem, scratch.path(), &stop, &|_, _| ()).map_err(|e| e.to_string())
    };
    let found = optimum(&text).unwrap();
    assert!((found.front[0].values[0] - 5.0).abs() < 1e-3, "{found:?}");
    let before = found.before.unwrap()[0];
    assert!(found.front[0].objectives[0] < 0.9 * before, "{before}");
    // A study has the same numbers: what scatters by nothing is what the file states.
    let study = format!(
        "scene = \"scene.toml\"\nfrom_s = 0.0006\ncolumns = [\"elements/mesh/line_load_slice_8_N_per_m\"]\n\
         [[parameter]]\nname = \"ellipse\"\nkeys = [\"{key}.0\", \"{key}.1\"]\nvalues = [5.0]\n"
    );
    let (outcome, _) = studied(folder.path(), &study).unwrap();
    let of_study = [0, 1].map(|case| numbers(&outcome, case)[0]);
    assert!((before / of_study[0] - 1.0).abs() < 1e-6, "{of_study:?}");
    let best = found.front[0].objectives[0];
    assert!((best / of_study[1] - 1.0).abs() < 1e-3, "{of_study:?}");
    // A key that the file does not have, and a value that it does not take, are reported with the key of the study's
    // file.
    for (from, to, told) in [
        (
            "pinion.ellipse_half_length_mm.0",
            "pinion.elipse_mm",
            "unknown field `elipse_mm`",
        ),
        ("from = 3.0\nto = 5.0", "from = -3.0\nto = -1.0", "found -2"),
    ] {
        let problem = optimum(&text.replace(from, to)).unwrap_err();
        assert!(problem.contains("o.toml:8: variable.0.keys"), "{problem}");
        assert!(
            problem.contains("`gear_mesh.0.bevel_pair:pinion"),
            "{problem}"
        );
        assert!(
            problem.contains("is refused") && problem.contains(told),
            "{problem}"
        );
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
