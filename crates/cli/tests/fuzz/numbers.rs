//! Every number of every kind of file, one after the other made 0, -1, huge and no number under a good seal: each
//! reader answers with a value or an error. Arrays are changed at their first and their last entry; sizes are compared
//! with the arrays that are there, so that no count can ask for more memory than the file has bytes.

use crate::drilled_pair::{scene, scene_in_time, write_models};
use crate::fuzz;
use crate::trees::{answered_mesh, answered_model, changed, file_of, sealed, small_mesh};
use gearmesh_geometry::input::InputDocument;
use gearmesh_model::synthetic::{
    small_bevel_gear, small_crack, small_patterned_gear, small_reduced_gear, small_two_faced_gear,
};
use gearmesh_model::{
    DataTree, FileFormat, MESH_FORMAT, REDUCED_GEAR_FORMAT, Values, file_digest, write_mesh,
    write_reduced_gear,
};
use gearmesh_report::ReferenceRecord;
use gearmesh_report::export::{
    functions, pair_tables, system_tables, write_csv, write_mat, write_parquet,
};
use gearmesh_report::overlay::{overlaid_pairs, overlaid_systems};
use gearmesh_report::scene_comparison::compare_scene;
use gearmesh_report::scene_page::{SceneChapter, SystemChapter, scene_page};
use gearmesh_report::system_comparison::{SystemSelection, compare_system};
use gearmesh_scene::system_run::{Outcome, RunJob, RunOptions, SYSTEM_RESULT_FORMAT, run};
use gearmesh_scene::{RESULT_FORMAT, ResultFile, Scene, SceneFile, load, run as run_pair};
use std::io::sink;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

/// What no counter and no length can be.
const HUGE: f64 = 1e300;

/// A case that takes longer counts as one that never ends.
const FOREVER: Duration = Duration::from_secs(60);

/// A number of a file: where it stands, and what stands there.
struct Place {
    name: String,
    offset: usize,
    /// Little-endian, eight bytes of floating point or four of a count.
    own: Vec<u8>,
}

impl Place {
    /// The first and the last number of every array of a file.
    fn all(file: &Path, format: &FileFormat) -> (Vec<u8>, Vec<Self>) {
        let (tree, version) = DataTree::read_with_version(file, format).unwrap();
        let format = FileFormat { version, ..*format };
        let marked_file = tempfile::NamedTempFile::new().unwrap();
        // The same tree with marks instead of the numbers says where they stand.
        let (mut marked, mut marks) = (tree.clone(), Vec::new());
        for (name, array) in &mut marked.arrays {
            let last = array.values.len().saturating_sub(1);
            for at in [0, last].into_iter().take(array.values.len().min(2)) {
                let number = marks.len() as u32;
                let (own, mark) = match &mut array.values {
                    Values::F64(values) => {
                        let mark = -1.234_567_890_123_456e-123 * f64::from(number + 1);
                        let own = std::mem::replace(&mut values[at], mark);
                        (own.to_le_bytes().to_vec(), mark.to_le_bytes().to_vec())
                    }
                    Values::U32(values) => {
                        let mark = 0xd3a9_0000 + number;
                        let own = std::mem::replace(&mut values[at], mark);
                        (own.to_le_bytes().to_vec(), mark.to_le_bytes().to_vec())
                    }
                };
                marks.push((format!("{name}[{at}]"), own, mark));
            }
        }
        marked.write(marked_file.path(), &format).unwrap();
        let mut bytes = std::fs::read(marked_file.path()).unwrap();
        let mut places = Vec::new();
        for (name, own, mark) in marks {
            let mut windows = bytes.windows(mark.len());
            let offset = windows.position(|window| window == mark).unwrap();
            bytes[offset..offset + own.len()].copy_from_slice(&own);
            places.push(Self { name, offset, own });
        }
        (bytes, places)
    }

    /// What it is made: in words, and its bytes. Of counts -1 has the bits of the largest one.
    fn values(&self) -> Vec<(String, Vec<u8>)> {
        let shown = |value: &f64| (value.to_string(), value.to_le_bytes().to_vec());
        let counted = |value: &u32| (value.to_string(), value.to_le_bytes().to_vec());
        match self.own.len() {
            8 => [0.0, -1.0, HUGE, -HUGE, f64::INFINITY, f64::NAN]
                .iter()
                .map(shown)
                .collect(),
            _ => [0, 1, u32::MAX / 2, u32::MAX].iter().map(counted).collect(),
        }
    }

    /// The file with other bytes in its place, sealed.
    fn put(&self, bytes: &[u8], value: &[u8]) -> Vec<u8> {
        let mut changed = bytes.to_vec();
        changed[self.offset..self.offset + value.len()].copy_from_slice(value);
        sealed(changed)
    }
}

/// What is wrong, in words; it ends by itself, or the test ends.
fn answered(name: &str, read: impl FnOnce() + Send) -> Option<String> {
    std::thread::scope(|scope| {
        let (done, waits) = channel();
        let work = scope.spawn(move || {
            let outcome = catch_unwind(AssertUnwindSafe(read));
            let _ = done.send(());
            outcome
        });
        if waits.recv_timeout(FOREVER) == Err(RecvTimeoutError::Timeout) {
            // A thread cannot be stopped: the whole test program ends.
            eprintln!("does not end: {name}");
            std::process::exit(101);
        }
        work.join().unwrap().err().map(|panic| {
            let text = panic.downcast_ref::<String>().map(String::as_str);
            let text = text.or(panic.downcast_ref::<&str>().copied());
            format!("{name}: {}", text.unwrap_or("panic"))
        })
    })
}

/// Goes through all numbers of a file: with every value where the fuzzing is long, otherwise with one after the other.
/// `read` says whether the file was taken.
fn walk(file: &Path, format: &FileFormat, read: impl Fn(&Path) -> bool + Sync) {
    let desk = tempfile::tempdir().unwrap();
    let path = desk.path().join("case.h5");
    let (mut found, mut taken, mut count) = (Vec::new(), Vec::new(), 0);
    let (bytes, places) = Place::all(file, format);
    let is_long = std::env::var("GEARMESH_FUZZ_SECONDS").is_ok();
    for (number, place) in places.iter().enumerate() {
        let values = place.values();
        let turn = number % values.len();
        for (k, (words, value)) in values.into_iter().enumerate() {
            if !is_long && k != turn {
                continue;
            }
            std::fs::write(&path, place.put(&bytes, &value)).unwrap();
            let name = format!("{}: {} = {words}", file.display(), place.name);
            let is_taken = AtomicBool::new(false);
            found.extend(answered(&name, || {
                is_taken.store(read(&path), Ordering::Relaxed);
            }));
            let may_be = words != "NaN" || place.name.starts_with("columns/");
            if is_taken.into_inner() && !may_be {
                taken.push(name);
            }
            count += 1;
        }
    }
    println!("{}: {count} cases", file.display());
    assert!(found.is_empty(), "{}", found.join("\n"));
    assert!(taken.is_empty(), "not a number: {}", taken.join("\n"));
}

#[test]
fn models() {
    let desk = tempfile::tempdir().unwrap();
    let mut cracked = small_reduced_gear();
    cracked.crack = Some(small_crack());
    for (name, gear) in [
        ("cracked", cracked),
        ("bevel", small_bevel_gear()),
        ("patterned", small_patterned_gear()),
        ("two_faced", small_two_faced_gear()),
    ] {
        let file = desk.path().join(format!("{name}.h5"));
        write_reduced_gear(&file, &gear).unwrap();
        walk(&file, &REDUCED_GEAR_FORMAT, answered_model);
    }
}

#[test]
fn models_of_older_versions() {
    for version in 1..REDUCED_GEAR_FORMAT.version {
        let file = shipped(&format!("model_v{version}.h5"));
        let path = &file;
        assert!(answered_model(path));
        // Later ones are those of `models`.
        if version < 5 {
            walk(path, &REDUCED_GEAR_FORMAT, answered_model);
        }
    }
}

#[test]
fn meshes() {
    let desk = tempfile::tempdir().unwrap();
    let file = desk.path().join("mesh.h5");
    write_mesh(&file, &small_mesh()).unwrap();
    walk(&file, &MESH_FORMAT, answered_mesh);
}

/// A file of reference/files.
fn shipped(name: &str) -> PathBuf {
    crate::root().join("reference/files").join(name)
}

/// A scene with models of which one is changed: loaded and run.
fn is_run(text: &str, folder: &Path) -> bool {
    let document = InputDocument::new("scene.toml", text);
    let Ok(scene) = SceneFile::from_document(document, folder) else {
        return false;
    };
    match scene {
        SceneFile::Pair(scene) => load(*scene).is_ok_and(|loaded| {
            let _ = loaded.plan();
            run_pair(&loaded, &|_, _| ()).is_ok()
        }),
        SceneFile::System(scene) => scene
            .load()
            .is_ok_and(|loaded| loaded.build().is_ok() && RunJob::from_scene(loaded).is_ok()),
    }
}

#[test]
fn models_that_are_run() {
    let desk = tempfile::tempdir().unwrap();
    let models = tempfile::tempdir().unwrap();
    write_models(models.path());
    for name in ["pinion.h5", "drilled.h5"] {
        std::fs::copy(models.path().join(name), desk.path().join(name)).unwrap();
    }
    let gauges = "[gauges]\ngear_1 = [\"g0\"]\n";
    let pair = scene("drilled", "pitches = 1\npoints_per_pitch = 3", gauges);
    let in_time = scene_in_time(1e-3);
    let changed = desk.path().join("pinion.h5");
    walk(
        &models.path().join("pinion.h5"),
        &REDUCED_GEAR_FORMAT,
        |case| {
            std::fs::copy(case, &changed).unwrap();
            is_run(&pair, desk.path()) && is_run(&in_time, desk.path())
        },
    );
}

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
        let _ = functions(table);
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
        let answer = Command::new(env!("CARGO_BIN_EXE_gearmesh"))
            .args(words)
            .stdin(Stdio::null())
            .output()
            .unwrap();
        let told = String::from_utf8_lossy(&answer.stderr);
        assert_eq!(answer.status.code(), Some(2), "{words:?}: {told}");
        assert!(told.contains(part), "{words:?}: {told}");
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
