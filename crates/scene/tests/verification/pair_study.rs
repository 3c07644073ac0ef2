//! Studies of a gear pair: figures against runs of the same scenes, models that are read once, bodies that are reduced
//! once a value, what is refused before anything is computed.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use gearmesh_geometry::GearDefinition;
use gearmesh_geometry::input::InputDocument;
use gearmesh_model::{ReducedGear, StoredGear, read_reduced_gear};
use gearmesh_scene::study::{
    CaseRunner, RestCases, Selected, SelectedValue, SentCase, StudyCases, StudyError, StudyOptions,
    StudyOutcome, Subject, gather_study, run_study,
};
use gearmesh_scene::{Scene, load, run};
use gearmesh_specification::study::Study;

use crate::made_up_gears;

pub const SCENE: &str = r#"title = "made up"
[pair]
gear_1 = "gear_30.h5"
gear_2 = "gear_41.h5"
centre_distance_mm = 106.8
[mesh]
model.kind = "hybrid"
model.local = "weber-banaschek"
teeth.path = "line-of-action"
[gear_1.microgeometry]
tip_relief_um = 5.0
tip_relief_start_diameter_mm = 94.0
[run]
torques_Nm = [60.0, 120.0]
pitches = 1
points_per_pitch = 12
[gauges]
gear_1 = ["g0"]
"#;

const RELIEF: &str =
    "[[parameter]]\nname = \"relief\"\nkeys = [\"gear_1.microgeometry.tip_relief_um\"]\n";

/// A folder with two models and the scene, and the model that a gear is reduced to.
struct Desk {
    folder: tempfile::TempDir,
    reductions: AtomicUsize,
}

impl Desk {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        made_up_gears::write_models(folder.path());
        std::fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
        Self {
            folder,
            reductions: AtomicUsize::new(0),
        }
    }

    fn path(&self, name: &str) -> std::path::PathBuf {
        self.folder.path().join(name)
    }

    /// Stands for meshing and finite elements: the same compliance with the gear that was asked for.
    fn reduced(&self, gear: &GearDefinition) -> Result<ReducedGear, String> {
        self.reductions.fetch_add(1, Ordering::Relaxed);
        let model = read_reduced_gear(&self.path("gear_30.h5")).map_err(|e| e.to_string())?;
        Ok(ReducedGear {
            input: StoredGear::new(gear.clone()),
            ..model
        })
    }

    fn study(&self, head: &str, parameters: &str) -> Result<StudyOutcome, StudyError> {
        let text = format!("title = \"s\"\nscene = \"scene.toml\"\n{head}\n{parameters}");
        let document = InputDocument::new("study.toml", text);
        let study = Study::from_document(document, self.folder.path())?;
        let options = StudyOptions {
            folder: &self.path("out"),
            stop: &AtomicBool::new(false),
            progress: &|_, _| (),
            reduce: &|gear| self.reduced(gear),
        };
        run_study(&study, &options)
    }
}

fn single(selected: &Selected) -> f64 {
    match selected.value {
        SelectedValue::Single(value) => value,
        SelectedValue::Series(_) => unreachable!("a pair has single numbers"),
    }
}

const HEAD: &str = "columns = [\"te_mean_um\", \"te_peak_to_peak_um\", \"strain_gear1_g0_method2_range_ustrain\", \"te_harmonic_1_um\"]";

#[test]
fn figures_are_those_of_a_run_of_the_same_scene() {
    let desk = Desk::new();
    let outcome = desk
        .study(HEAD, &format!("{RELIEF}values = [0.0, 17.5]\n"))
        .unwrap();
    assert_eq!(outcome.cases.len(), 3);
    assert_eq!(outcome.reduced, 0);
    for (case, relief) in outcome.cases.iter().zip(["5.0", "0.0", "17.5"]) {
        let text = SCENE.replace("tip_relief_um = 5.0", &format!("tip_relief_um = {relief}"));
        let scene = Scene::from_document(InputDocument::new("own", text), desk.folder.path());
        let result = run(&load(scene.unwrap()).unwrap(), &|_, _| ()).unwrap();
        let figures = case.figures.as_ref().unwrap();
        assert_eq!(figures.len(), 2 * 4);
        for (k, torque) in [60.0, 120.0].into_iter().enumerate() {
            let te = &result.te_m[12 * k..12 * (k + 1)];
            let strain = &result.strain[0].method_2[12 * k..12 * (k + 1)];
            let between = result.between.of(k);
            let range = |even: &[f64], added: &[f64]| {
                let all = || even.iter().chain(&added[between.clone()]).copied();
                all().fold(f64::MIN, f64::max) - all().fold(f64::MAX, f64::min)
            };
            // Amplitude of the first harmonic of twelve samples, by its definition.
            let part = |shift: f64| {
                let angle = |i: usize| std::f64::consts::TAU * i as f64 / 12.0 + shift;
                te.iter()
                    .enumerate()
                    .map(|(i, v)| v * angle(i).cos())
                    .sum::<f64>()
                    / 6.0
            };
            let harmonic = part(0.0).hypot(part(std::f64::consts::FRAC_PI_2));
            let expected = [
                te.iter().sum::<f64>() / 12.0,
                range(te, &result.between.te_m),
                range(strain, &result.strain[0].between[1]),
                harmonic,
            ];
            for (one, expected) in figures[4 * k..4 * (k + 1)].iter().zip(expected) {
                assert_eq!(one.torque_nm, Some(torque));
                let close = (single(one) - 1e6 * expected).abs() <= 1e-9 * (1e6 * expected).abs();
                assert!(close, "{one:?} against {expected}");
            }
        }
    }
    let table = std::fs::read_to_string(desk.path("out/study.csv")).unwrap();
    let head = table.lines().next().unwrap();
    assert!(
        head.starts_with("relief,torque_Nm,te_mean_um,te_peak_to_peak_um,"),
        "{head}"
    );
    assert_eq!(table.lines().count(), 1 + 3 * 2);
}

/// Files of cases are read again: to the byte the same table; a further column asks for nothing new.
#[test]
fn a_study_of_a_pair_goes_on_where_it_was() {
    let desk = Desk::new();
    let design = "design = \"latin-hypercube\"\nsamples = 8\nseed = 3\n";
    let parameters = format!("{RELIEF}uniform = {{ from = 0.0, to = 30.0 }}\n");
    let first = desk.study(&format!("{design}{HEAD}"), &parameters).unwrap();
    let written = |name: &str| {
        let meta = std::fs::metadata(desk.path("out").join(name)).unwrap();
        meta.modified().unwrap()
    };
    let names: Vec<String> = (first.cases.iter())
        .map(|case| {
            case.file
                .as_ref()
                .unwrap()
                .file_name()
                .unwrap()
                .to_string_lossy()
                .into_owned()
        })
        .collect();
    let times: Vec<_> = names.iter().map(|name| written(name)).collect();
    let table = std::fs::read_to_string(desk.path("out/study.csv")).unwrap();
    let again = desk.study(&format!("{design}{HEAD}"), &parameters).unwrap();
    assert_eq!(again.cases.len(), 8);
    assert_eq!(
        table,
        std::fs::read_to_string(desk.path("out/study.csv")).unwrap()
    );
    desk.study(&format!("{design}columns = [\"k_h_beta\"]"), &parameters)
        .unwrap();
    assert_eq!(
        times,
        names.iter().map(|name| written(name)).collect::<Vec<_>>()
    );
    // One relief in each eighth of the range.
    let mut eighths: Vec<usize> = (first.cases.iter())
        .map(|case| (case.settings_value() / 30.0 * 8.0) as usize)
        .collect();
    eighths.sort_unstable();
    assert_eq!(eighths, (0..8).collect::<Vec<_>>());
}

trait Value {
    fn settings_value(&self) -> f64;
}

impl Value for gearmesh_scene::study::CaseResult {
    fn settings_value(&self) -> f64 {
        self.case.settings[0].value.as_float().unwrap()
    }
}

#[test]
fn models_are_read_once_and_a_body_is_reduced_once_a_value() {
    let desk = Desk::new();
    let cases = RestCases::default();
    for relief in ["1.0", "2.0", "3.0"] {
        let text = SCENE.replace("tip_relief_um = 5.0", &format!("tip_relief_um = {relief}"));
        let scene = Scene::from_document(InputDocument::new("own", text), desk.folder.path());
        let subject = Subject::Pair(Box::new(scene.unwrap()));
        cases.figures(&subject).unwrap();
    }
    // The contact of both bodies is condensed once: reliefs are none of its business.
    assert_eq!((cases.models(), cases.condensed()), (2, 1));
    let finer = SCENE.replace("model.local", "model.slices = 3\nmodel.local");
    let scene = Scene::from_document(InputDocument::new("own", finer), desk.folder.path());
    cases
        .figures(&Subject::Pair(Box::new(scene.unwrap())))
        .unwrap();
    assert_eq!((cases.models(), cases.condensed()), (2, 2));

    let body = "[[parameter]]\nname = \"bore\"\nkeys = [\"pair.gear_1:blank.bore_diameter_mm\"]\nvalues = [25.0, 28.0]\n";
    let both = format!("{body}{RELIEF}values = [0.0, 10.0, 20.0]\n");
    let design = format!("design = \"grid\"\n{HEAD}");
    let outcome = desk.study(&design, &both).unwrap();
    assert_eq!((outcome.cases.len(), outcome.reduced), (6, 2));
    assert!(outcome.cases.iter().all(|case| case.figures.is_ok()));
    let more = both.replace("[25.0, 28.0]", "[25.0, 28.0, 26.0]");
    assert_eq!(desk.study(&design, &more).unwrap().reduced, 1);
    assert_eq!(desk.reductions.load(Ordering::Relaxed), 3);
    let models = std::fs::read_dir(desk.path("out/models")).unwrap();
    let mut bores: Vec<f64> = models
        .map(|entry| read_reduced_gear(&entry.unwrap().path()).unwrap())
        .map(|model| {
            model.input.text.parse::<toml::Table>().unwrap()["blank"]["bore_diameter_mm"]
                .as_float()
                .unwrap()
        })
        .collect();
    bores.sort_by(f64::total_cmp);
    assert_eq!(bores, [25.0, 26.0, 28.0]);
}

#[test]
fn what_is_wrong_is_told_before_anything_is_computed() {
    let desk = Desk::new();
    let key = |key: &str, value: &str| {
        format!("[[parameter]]\nname = \"x\"\nkeys = [\"{key}\"]\nvalues = [{value}]\n")
    };
    for (head, parameters, told) in [
        (
            "columns = [\"te_peak_to_paek_um\"]",
            key("gear_1.microgeometry.tip_relief_um", "1.0"),
            "study.toml:3: columns.0: there is no column `te_peak_to_paek_um`; did you mean `te_peak_to_peak_um`?",
        ),
        (
            HEAD,
            key("gear_1.microgeometry.tip_releif_um", "1.0"),
            "did you mean `tip_relief_um`?",
        ),
        (
            HEAD,
            key("gear_2.microgeometry.root_relief_um", "1.0"),
            "`gear_2.microgeometry.root_relief_um` is refused: needs root_relief_start_diameter_mm",
        ),
        (
            HEAD,
            key("pair.gear_1:microgeometry.tip_relief_um", "1.0"),
            "would reduce the gear for its flanks; vary the scene's microgeometry",
        ),
        (
            HEAD,
            key("pair.gear_1:blank.bore_diametre_mm", "20.0"),
            "did you mean `bore_diameter_mm`?",
        ),
        (
            HEAD,
            key("pair.centre_distance_mm:x", "20.0"),
            "begins with `pair.centre_distance_mm`: there is no key that names a file `pair.centre_distance_mm`",
        ),
        (
            HEAD,
            key("pair.gear1:blank.bore_diameter_mm", "20.0"),
            "did you mean `pair.gear_1`? the scene has `pair.gear_1`, `pair.gear_2`",
        ),
        (
            "from_s = 1.0\ncolumns = [\"k_h_beta\"]",
            key("pair.inclination_mrad", "0.1"),
            "from_s: belongs to runs in time; a gear pair is looked at at rest",
        ),
        (
            HEAD,
            "[[parameter]]\nname = \"x\"\nkeys = [\"pair.inclination_mrad\"]\nnormal = { mean = 0.0, deviation = 0.1 }\n".into(),
            "is a scatter, which needs design",
        ),
        (
            "design = \"random\"\ncolumns = [\"k_h_beta\"]",
            key("pair.inclination_mrad", "0.1"),
            "samples: must be stated with this design",
        ),
    ] {
        let error = desk.study(head, &parameters).unwrap_err();
        assert!(error.is_input() && error.to_string().contains(told), "{error}");
        assert!(!Path::new(&desk.path("out")).exists());
    }
}

/// A computer that has the models in another place runs what it is sent; the table is that of a study in one place.
#[test]
fn cases_that_run_elsewhere_come_to_the_same_table_and_none_runs_twice() {
    let desk = Desk::new();
    let parameters = format!("{RELIEF}values = [0.0, 17.5]\n");
    let here = desk.study(HEAD, &parameters).unwrap();
    let table = std::fs::read_to_string(desk.path("out/study.csv")).unwrap();

    let far = tempfile::tempdir().unwrap();
    let text = format!("title = \"s\"\nscene = \"scene.toml\"\n{HEAD}\n{parameters}");
    let study =
        Study::from_document(InputDocument::new("study.toml", text), desk.folder.path()).unwrap();
    let out = desk.path("far");
    let cases = StudyCases::new(&study, &out).unwrap();
    assert!(cases.missing().is_empty());
    let sent = cases.list().unwrap();
    assert_eq!(sent.len(), 3);
    let mut places = BTreeMap::new();
    for (_, path) in &sent[0].named {
        let place = far.path().join(path.file_name().unwrap());
        std::fs::rename(path, &place).unwrap();
        places.insert(path.clone(), place);
    }
    assert_eq!(places.len(), 2);
    let runner = CaseRunner::default();
    let stop = AtomicBool::new(false);
    let run = |case: &SentCase| runner.run(case, &places, far.path(), &stop).unwrap();
    assert!(!CaseRunner::is_there(&sent[0], far.path()));
    let computed: Vec<Option<bool>> = sent.iter().map(run).collect();
    assert_eq!(computed, [Some(true); 3]);
    assert_eq!(run(&sent[1]), Some(false));
    assert!(CaseRunner::is_there(&sent[0], far.path()));

    // Back with them; one is lost on the way, and one has failed.
    for (path, place) in &places {
        std::fs::rename(place, path).unwrap();
    }
    std::fs::create_dir(&out).unwrap();
    for case in &sent {
        std::fs::copy(far.path().join(&case.file), out.join(&case.file)).unwrap();
    }
    let none = BTreeMap::new();
    let gathered = gather_study(&study, &out, &none).unwrap();
    for (a, b) in here.cases.iter().zip(&gathered.cases) {
        assert_eq!(a.figures, b.figures);
    }
    let far_table = std::fs::read_to_string(out.join("study.csv")).unwrap();
    assert_eq!(
        far_table.replace(out.to_str().unwrap(), ""),
        table.replace(desk.path("out").to_str().unwrap(), "")
    );
    std::fs::remove_file(out.join(&sent[0].file)).unwrap();
    std::fs::remove_file(out.join(&sent[2].file)).unwrap();
    let failures = BTreeMap::from([(sent[2].file.clone(), "no contact".to_owned())]);
    let gathered = gather_study(&study, &out, &failures).unwrap();
    let problem = |k: usize| gathered.cases[k].figures.as_ref().unwrap_err().clone();
    assert!(problem(0).contains("broken off"), "{}", problem(0));
    assert_eq!(problem(2), "no contact");
    assert!(gathered.cases[1].figures.is_ok());
}
