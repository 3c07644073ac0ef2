//! Parameter studies: a wheel under a constant torque, whose speed is known.

use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;

use gearmesh_geometry::input::InputDocument;
use gearmesh_scene::study::{
    SelectedValue, StudyOptions, StudyOutcome, StudyScenes, Subject, run_study,
};
use gearmesh_specification::study::Study;

/// A wheel of 0.5 kg m² that a torque turns for a second: ω(1) = T/J.
const SCENE: &str = include_str!("../../../../tests/support/wheel.toml");

const SPEED: &str = "bodies/wheel/angular_velocity_z_rad_per_s";

fn study(parameters: &str) -> Study {
    let text = format!(
        "title = \"s\"\nscene = \"scene.toml\"\ncolumns = [\"{SPEED}\"]\nfrom_s = 0.5\n{parameters}"
    );
    Study::from_document(InputDocument::new("study.toml", text), Path::new("")).unwrap()
}

fn run_in(folder: &Path, parameters: &str) -> (Result<StudyOutcome, String>, usize) {
    std::fs::write(folder.join("scene.toml"), SCENE).unwrap();
    let mut study = study(parameters);
    study.folder = folder.to_owned();
    let told = Mutex::new(0);
    let options = StudyOptions {
        folder: &folder.join("out"),
        stop: &AtomicBool::new(false),
        progress: &|_, count| *told.lock().unwrap() = count,
        reduce: &|_| Err("no gear varies".to_owned()),
    };
    let outcome = run_study(&study, &options);
    (
        outcome.map_err(|e| e.to_string()),
        told.into_inner().unwrap(),
    )
}

const TORQUE: &str = "[[parameter]]\nname = \"torque\"\nkeys = [\"load.0.torque_Nm\"]\n";

#[test]
fn every_case_has_the_speed_of_its_torque() {
    let folder = tempfile::tempdir().unwrap();
    let parameters = format!("{TORQUE}values = [4.0, 2.0, -1.0]\n");
    let (outcome, runs) = run_in(folder.path(), &parameters);
    let outcome = outcome.unwrap();
    assert!(!outcome.stopped);
    // The scene as it is has 2 N m: that case and the second value are one run.
    assert_eq!((outcome.cases.len(), runs), (4, 3));
    assert_eq!(outcome.cases[0].file, outcome.cases[2].file);
    for (case, torque) in outcome.cases.iter().zip([2.0, 4.0, 2.0, -1.0]) {
        let SelectedValue::Series(figures) = case.figures.as_ref().unwrap()[0].value else {
            unreachable!("a run in time has a series");
        };
        let [first, last] = [0.5_f64, 1.0].map(|time| torque / 0.5 * time);
        assert!(
            (figures.least - first.min(last)).abs() < 1e-9,
            "{figures:?}"
        );
        assert!(
            (figures.largest - first.max(last)).abs() < 1e-9,
            "{figures:?}"
        );
        assert!(
            (figures.mean - 0.5 * (first + last)).abs() < 1e-9,
            "{figures:?}"
        );
    }
    let table = std::fs::read_to_string(folder.path().join("out/study.csv")).unwrap();
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(
        lines[0],
        "torque,column,mean,deviation,least,largest,file,failure"
    );
    assert!(lines[2].starts_with(&format!("4.0,{SPEED},")), "{table}");
    assert_eq!(lines.len(), 5);
}

/// Results that are there are kept, to the byte; a further value makes one more.
#[test]
fn a_study_goes_on_where_it_was() {
    let folder = tempfile::tempdir().unwrap();
    run_in(folder.path(), &format!("{TORQUE}values = [4.0]\n"))
        .0
        .unwrap();
    let written = |folder: &Path| {
        let entries = std::fs::read_dir(folder.join("out")).unwrap();
        let paths = entries.map(|entry| entry.unwrap().path());
        let results = paths.filter(|path| path.extension().is_some_and(|e| e == "h5"));
        let mut all: Vec<_> = results
            .map(|p| (p.clone(), std::fs::read(p).unwrap()))
            .collect();
        all.sort();
        all
    };
    let before = written(folder.path());
    assert_eq!(before.len(), 2);
    run_in(folder.path(), &format!("{TORQUE}values = [4.0, 8.0]\n"))
        .0
        .unwrap();
    let after = written(folder.path());
    assert_eq!(after.len(), 3);
    assert!(before.iter().all(|file| after.contains(file)));
}

#[test]
fn a_key_that_is_not_in_the_scene_is_told_before_anything_runs() {
    let folder = tempfile::tempdir().unwrap();
    for (parameters, told) in [
        (
            "[[parameter]]\nname = \"x\"\nkeys = [\"load.1.torque_Nm\"]\nvalues = [1.0]\n",
            "study.toml:7: parameter.0.keys: `load.1.torque_Nm` is not in the scene: load has items 0 to 0, not `1`",
        ),
        (
            "[[parameter]]\nname = \"x\"\nkeys = [\"load.0.torque_Nm\"]\nvalues = [\"much\"]\n",
            "study.toml:7: parameter.0.keys: `load.0.torque_Nm` is float in the scene and cannot be string",
        ),
    ] {
        let (outcome, runs) = run_in(folder.path(), parameters);
        assert_eq!(outcome.unwrap_err(), told);
        assert_eq!(runs, 0);
    }
    // A value that the scene refuses names the scene and what was changed in it.
    let parameters =
        "[[parameter]]\nname = \"mass\"\nkeys = [\"body.0.mass_kg\"]\nvalues = [-1.0]\n";
    let outcome = run_in(folder.path(), parameters).0;
    let told = match outcome {
        Err(told) => told,
        Ok(outcome) => outcome.cases[1].figures.clone().unwrap_err(),
    };
    assert!(told.contains("mass = -1"), "{told}");
}

/// A study varies the microgeometry that a scene states; a slip in the key is reported before the first case.
#[test]
fn microgeometry_of_a_body_is_varied() {
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fe_models");
    let text = std::fs::read_to_string(models.join("study_17_25.toml")).unwrap();
    let scenes = |text: &str| {
        let document = InputDocument::new("study.toml", text);
        StudyScenes::new(
            &Study::from_document(document, &models).unwrap(),
            Path::new(""),
        )
    };
    let Some(Subject::System(relieved)) = scenes(&text).unwrap().scenes.pop() else {
        unreachable!("a multibody scene");
    };
    let built = relieved.load().unwrap().build().unwrap();
    let note = built
        .notes
        .iter()
        .find(|note| note.contains("flanks of gear 1"));
    assert!(
        note.unwrap()
            .contains("gear 1 tip relief 25 um parabolic from 180 mm (scene); gear 2 unmodified"),
        "{note:?}"
    );
    let slip = text.replace("microgeometry.tip_relief_um", "microgeometry.tip_releif_um");
    let told = scenes(&slip).err().unwrap().to_string();
    assert!(
        told.contains(
            "`body.0.microgeometry.tip_releif_um` is refused: unknown field `tip_releif_um`"
        ) && told.ends_with("did you mean `tip_relief_um`?"),
        "{told}"
    );
    let alone = "body.1.microgeometry.root_relief_um";
    let alone = text.replace("body.0.microgeometry.tip_relief_um", alone);
    let told = scenes(&alone).err().unwrap().to_string();
    assert!(
        told.ends_with("is refused: needs root_relief_start_diameter_mm"),
        "{told}"
    );
}

/// A column that is not there is reported before the first case, with the nearest and all that there are.
#[test]
fn a_column_that_is_not_there_names_those_that_are() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    let column = SPEED.replace("velocity", "velocty");
    let text = format!(
        "title = \"s\"\nscene = \"scene.toml\"\ncolumns = [\"{column}\"]\nparameter = []\n"
    );
    let study =
        Study::from_document(InputDocument::new("study.toml", text), folder.path()).unwrap();
    let out = folder.path().join("out");
    let options = StudyOptions {
        folder: &out,
        stop: &AtomicBool::new(false),
        progress: &|_, _| (),
        reduce: &|_| Err("no gear varies".to_owned()),
    };
    let told = run_study(&study, &options).unwrap_err();
    assert!(told.is_input());
    let told = told.to_string();
    let nearest = format!("did you mean `{SPEED}`?");
    assert!(
        told.starts_with("study.toml:3: columns.0: there is no column") && told.contains(&nearest),
        "{told}"
    );
    assert!(!out.exists());
}
