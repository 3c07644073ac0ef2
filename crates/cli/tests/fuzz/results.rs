//! Every number of results and of unfinished runs, made 0, -1, huge and no number: tables, comparison, page, strain and
//! signals of them end with a value or an error.

use crate::common::{ends, program, succeeds};
use crate::drilled_pair::{scene, scene_in_time, write_models};
use crate::fuzz;
use crate::numbers::{Place, shipped, walk};
use crate::trees::{changed, file_of};
use gearmesh_geometry::input::InputDocument;
use gearmesh_model::{DataTree, FileFormat, REDUCED_GEAR_FORMAT, file_digest};
use gearmesh_report::ReferenceRecord;
use gearmesh_report::export::{
    pair_tables, system_tables, write_csv, write_mat, write_parquet, write_universal,
};
use gearmesh_report::overlay::{overlaid_pairs, overlaid_systems};
use gearmesh_report::scene_comparison::compare_scene;
use gearmesh_report::scene_page::{SceneChapter, SystemChapter, scene_page};
use gearmesh_report::system_comparison::{SystemSelection, compare_system};
use gearmesh_scene::system_run::{Outcome, RunJob, RunOptions, SYSTEM_RESULT_FORMAT, run};
use gearmesh_scene::{RESULT_FORMAT, ResultFile, Scene, SceneFile, load, run as run_pair};
use std::io::sink;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::Duration;

/// A command that takes longer does not end.
const FOREVER: Duration = Duration::from_secs(60);

/// Everything that is made of a result: tables, comparison, page.
fn answered_result(path: &Path, record: &Path) -> bool {
    let Ok(result) = ResultFile::open(path) else {
        return false;
    };
    let record = ReferenceRecord::read(record).unwrap();
    let name = "case.h5".to_owned();
    let tables = match &result {
        ResultFile::Pair(result) => pair_tables(result),
        ResultFile::System(result) => system_tables(result),
    };
    for table in &tables {
        let _ = write_csv(table, &mut sink());
        let _ = write_parquet(table, &mut sink());
        let _ = write_universal(table, ("t", "p"), &mut sink());
    }
    let _ = write_mat(&tables, &mut sink());
    drop(tables);
    let page = match result {
        ResultFile::Pair(result) => {
            let _ = overlaid_pairs(&[(name.clone(), &result), (name, &result)]);
            let _ = result.incomplete();
            let compared = compare_scene(&result, &record);
            let chapter = SceneChapter {
                result: *result,
                record: compared.is_ok().then_some(record),
                stress: None,
            };
            scene_page(&[chapter], &[])
        }
        ResultFile::System(result) => {
            let _ = overlaid_systems(&[(name.clone(), &result), (name, &result)]);
            let _ = (result.problem(), result.summaries(|_| true));
            let _ = (result.mesh_passings(), result.incomplete_windows());
            let column = result.rows.columns().last().map(|c| c.name.clone());
            let column = column.map(|name| ("te_um_200Nm".to_owned(), name));
            let selection = SystemSelection {
                columns: column.into_iter().collect(),
                from_s: None,
                start_angle_rad: 0.0,
            };
            let _ = compare_system(&result, &record, &selection);
            let chapter = SystemChapter {
                result: *result,
                stress: None,
            };
            scene_page(&[], &[chapter])
        }
    };
    if let Ok(page) = page {
        let _ = page.render();
    }
    true
}

/// A record of the transmission error of a pair of 23 and 47 teeth.
fn record(folder: &Path) -> PathBuf {
    let record = folder.join("record");
    std::fs::create_dir(&record).unwrap();
    let line = |k: u32| format!("{k},{}\n", f64::from(k % 7));
    let data: String = (0..360).map(line).collect();
    std::fs::write(
        record.join("data.csv"),
        format!("angle_deg,te_um_200Nm\n{data}"),
    )
    .unwrap();
    let text = "title = \"made up\"\nkind = \"computed\"\nsource = \"a test\"\nangle_origin = \"any\"\nshaft = \"gear_1\"\n";
    std::fs::write(record.join("record.toml"), text).unwrap();
    record
}

/// The result of a short run of the pair of 23 and 47 teeth, with gauges.
fn pair_result(folder: &Path) -> PathBuf {
    write_models(folder);
    let gauges = "[gauges]\ngear_1 = [\"g0\"]\ngear_2 = [\"g0\"]\n[[rating]]\nkind = \"nominal\"\n";
    let text = scene("wheel", "pitches = 23\npoints_per_pitch = 4", gauges);
    let document = InputDocument::new("scene.toml", text);
    let loaded = load(Scene::from_document(document, folder).unwrap()).unwrap();
    let path = folder.join("result.h5");
    run_pair(&loaded, &|_, _| ()).unwrap().write(&path).unwrap();
    path
}

#[test]
fn results_of_pairs() {
    let desk = tempfile::tempdir().unwrap();
    let record = record(desk.path());
    let read = |path: &Path| answered_result(path, &record);
    walk(&pair_result(desk.path()), &RESULT_FORMAT, read);
    for version in 1..=RESULT_FORMAT.version {
        let file = shipped(&format!("pair_result_v{version}.h5"));
        walk(&file, &RESULT_FORMAT, read);
    }
}

const WHEEL: &str = include_str!("../../../../tests/support/wheel.toml");

/// The result of a multibody scene.
fn system_result(text: &str, folder: &Path) -> PathBuf {
    let document = InputDocument::new("scene.toml", text);
    let SceneFile::System(scene) = SceneFile::from_document(document, folder).unwrap() else {
        panic!("a multibody scene");
    };
    let path = folder.join("result.h5");
    let options = RunOptions {
        output: &path,
        restart: true,
        checkpoint_interval: Duration::from_secs(3600),
        stop: &AtomicBool::new(false),
        progress: &|_| (),
    };
    let job = RunJob::from_scene(scene.load().unwrap()).unwrap();
    assert_eq!(run(job, &options).unwrap(), Outcome::Finished);
    path
}

/// A wheel on a spring, for every kind of run but the first.
const SPRUNG: &str = r#"[[body]]
name = "wheel"
mass_kg = 1.0
inertia_kg_m2 = [0.5, 0.5, 0.5]
[[joint]]
name = "axis"
kind = "revolute"
body_2 = "wheel"
[[torsion_spring]]
name = "spring"
body_2 = "wheel"
stiffness_Nm_per_rad = 100.0
damping_Nm_s_per_rad = 0.1
[[load]]
body = "wheel"
torque_Nm = 2.0
"#;

const DRIVEN: &str = r#"title = "sweep"
[run]
kind = "speed-sweep"
motion = "drive"
from_rpm = 100.0
to_rpm = 200.0
speeds = 2
settle_s = 0.05
measure_s = 0.05
[solver]
step_s = 1e-3
[output]
interval_s = 1e-3
[[body]]
name = "wheel"
mass_kg = 1.0
inertia_kg_m2 = [0.5, 0.5, 0.5]
[[joint]]
name = "axis"
kind = "revolute"
body_2 = "wheel"
[[motion]]
name = "drive"
joint = "axis"
speed_rpm = 100.0
"#;

#[test]
fn results_of_multibody_scenes() {
    let desk = tempfile::tempdir().unwrap();
    let record = record(desk.path());
    let eigen = format!("title = \"eigen\"\n[run]\nkind = \"eigen\"\n{SPRUNG}");
    let rest = format!("title = \"static\"\n[run]\nkind = \"static\"\n{SPRUNG}");
    write_models(desk.path());
    let in_time = scene_in_time(4e-3);
    for text in [WHEEL, &eigen, &rest, DRIVEN, &in_time] {
        let file = system_result(text, desk.path());
        walk(&file, &SYSTEM_RESULT_FORMAT, |path| {
            answered_result(path, &record)
        });
    }
}

/// What meshes and models do with a result: strain of its gauges, figures of a column; through the commands, where a
/// signal ends the program and not the test.
#[test]
fn results_through_recover_and_signal() {
    let desk = tempfile::tempdir().unwrap();
    let (pair, in_time) = (pair_result(desk.path()), desk.path().join("in_time"));
    std::fs::create_dir(&in_time).unwrap();
    let system = system_result(WHEEL, &in_time);
    let output = desk.path().join("strain.h5").display().to_string();
    let speed = "bodies/wheel/angular_velocity_z_rad_per_s";
    for (file, format, command) in [
        (&pair, &RESULT_FORMAT, "recover FILE -o OUTPUT"),
        (
            &system,
            &SYSTEM_RESULT_FORMAT,
            "signal statistics FILE COLUMN",
        ),
        (
            &system,
            &SYSTEM_RESULT_FORMAT,
            "signal spectrum FILE COLUMN",
        ),
        (
            &system,
            &SYSTEM_RESULT_FORMAT,
            "signal map FILE COLUMN --shaft wheel",
        ),
    ] {
        let case = file.with_file_name("case.h5");
        let shown = case.display().to_string();
        let word = |word: &str| match word {
            "FILE" => shown.clone(),
            "OUTPUT" => output.clone(),
            "COLUMN" => speed.to_owned(),
            word => word.to_owned(),
        };
        let words: Vec<String> = command.split(' ').map(word).collect();
        walk(file, format, |changed| {
            std::fs::copy(changed, &case).unwrap();
            let answer = ends(program(&words), FOREVER);
            assert!(matches!(answer.code, Some(0..=2)), "{command}: {answer:#?}");
            answer.code == Some(0)
        });
    }
    succeeds(&["check", pair.to_str().unwrap()]);
}

/// The state of an unfinished run, from which the same command goes on.
#[test]
fn checkpoints() {
    let desk = tempfile::tempdir().unwrap();
    let path = desk.path().join("result.h5");
    let go_on = |is_first: bool| {
        let document = InputDocument::new("scene.toml", WHEEL);
        let SceneFile::System(scene) = SceneFile::from_document(document, desk.path()).unwrap()
        else {
            panic!("a multibody scene");
        };
        // The first one stops where it begins.
        let stop = AtomicBool::new(is_first);
        let options = RunOptions {
            output: &path,
            restart: false,
            checkpoint_interval: Duration::from_secs(3600),
            stop: &stop,
            progress: &|_| (),
        };
        run(RunJob::from_scene(scene.load().unwrap()).unwrap(), &options)
    };
    assert_eq!(go_on(true).unwrap(), Outcome::Stopped);
    let part = desk.path().join("result.h5.part");
    let kept = desk.path().join("kept");
    std::fs::rename(&part, &kept).unwrap();
    let format = FileFormat {
        name: "gearmesh-checkpoint",
        version: 1,
    };
    walk(&kept.join("checkpoint.h5"), &format, |case| {
        let _ = std::fs::remove_dir_all(&part);
        std::fs::create_dir(&part).unwrap();
        std::fs::copy(kept.join("rows.log"), part.join("rows.log")).unwrap();
        std::fs::copy(case, part.join("checkpoint.h5")).unwrap();
        go_on(false).is_ok()
    });
}

/// Counts that are larger than memory, through the commands themselves: all of them refuse, none is ended by a signal.
#[test]
fn huge_counts_through_the_commands() {
    let desk = tempfile::tempdir().unwrap();
    let record = record(desk.path());
    let result = pair_result(desk.path());
    let scene_file = desk.path().join("scene.toml");
    let text = scene("wheel", "pitches = 1\npoints_per_pitch = 4", "");
    std::fs::write(&scene_file, text).unwrap();
    let case = desk.path().join("case.h5");
    let changed = |file: &Path, format: &FileFormat, array: &str| {
        let (bytes, places) = Place::all(file, format);
        let wanted = format!("{array}[0]");
        let place = places.iter().find(|place| place.name == wanted).unwrap();
        let bytes = place.put(&bytes, &u32::MAX.to_le_bytes());
        std::fs::write(&case, bytes).unwrap();
    };
    let out = |name: &str| desk.path().join(name).display().to_string();
    let refused = |words: &[&str], part: &str| {
        let answer = ends(program(words), FOREVER);
        assert_eq!(answer.code, Some(2), "{words:?}: {answer:#?}");
        assert!(answer.stderr.contains(part), "{words:?}: {answer:#?}");
    };
    let shown = case.display().to_string();
    for array in ["pitches", "pair_count", "gauge_count", "gauges/0/gear"] {
        changed(&result, &RESULT_FORMAT, array);
        let record = record.display().to_string();
        for words in [
            &["check", &shown][..],
            &["report", &shown, "-o", &out("page.html")],
            &["export", &shown, "-o", &out("table.csv")],
            &["export", &shown, "-o", &out("moves.pvd")],
            &["recover", &shown, "-o", &out("strain.h5")],
            &["compare", &shown, &record],
        ] {
            refused(words, array);
        }
    }
    let pinion = desk.path().join("pinion.h5");
    let sound = std::fs::read(&pinion).unwrap();
    let digest = file_digest(&pinion).unwrap();
    changed(&pinion, &REDUCED_GEAR_FORMAT, "grid/slices");
    std::fs::copy(&case, &pinion).unwrap();
    assert_ne!(file_digest(&pinion).unwrap(), digest);
    let (scene_file, pinion_shown) = (
        scene_file.display().to_string(),
        pinion.display().to_string(),
    );
    for words in [
        &["check", &pinion_shown][..],
        &["plan", &scene_file],
        &["run", &scene_file, "-o", &out("new.h5")],
    ] {
        refused(words, "slices");
    }
    refused(
        &[
            "recover",
            &result.display().to_string(),
            "-o",
            &out("strain.h5"),
        ],
        "slices",
    );
    std::fs::write(&pinion, sound).unwrap();
}

/// Results with numbers, shapes, texts and names changed.
#[test]
fn results_at_random() {
    let desk = tempfile::tempdir().unwrap();
    let record = record(desk.path());
    let (made, case) = (desk.path().join("made.h5"), desk.path().join("case.h5"));
    let newest = [
        ("pair_result", RESULT_FORMAT),
        ("system_result", SYSTEM_RESULT_FORMAT),
    ];
    let corpus = newest.map(|(name, format)| {
        let file = shipped(&format!("{name}_v{}.h5", format.version));
        (DataTree::read(&file, &format).unwrap(), format)
    });
    let make = |random: &mut fastrand::Rng| {
        let (tree, format) = &corpus[random.usize(..corpus.len())];
        file_of(&changed(tree, random), &made, format)
    };
    fuzz("result", 60, make, |bytes| {
        std::fs::write(&case, bytes).unwrap();
        answered_result(&case, &record);
    });
}
