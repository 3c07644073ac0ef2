//! Optimisations of what is no gear pair: bevel pairs, bearings, runs in time; figures against the models themselves,
//! and what is refused.

use std::sync::atomic::AtomicBool;

use gearmesh_geometry::input::InputDocument;
use gearmesh_scene::optimise::optimise;
use gearmesh_specification::optimise::Optimisation;

use crate::studies_of_all_kinds::{BEARING, fe_models, numbers, oscillator, studied};

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
