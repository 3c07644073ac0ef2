//! Every number of every kind of file, one after the other made 0, -1, huge and no number under a good seal: each
//! reader answers with a value or an error. Arrays are changed at their first and their last entry; sizes are compared
//! with the arrays that are there, so that no count can ask for more memory than the file has bytes.

use crate::drilled_pair::{scene, scene_in_time, write_models};
use crate::pair_common::made_up_models::{
    small_bevel_gear, small_bored_gear, small_crack, small_patterned_gear, small_reduced_gear,
    small_two_faced_gear,
};
use crate::trees::{answered_mesh, answered_model, sealed, small_mesh};
use gearmesh_geometry::input::InputDocument;
use gearmesh_model::{
    DataTree, FileFormat, MESH_FORMAT, REDUCED_GEAR_FORMAT, Values, write_mesh, write_reduced_gear,
};
use gearmesh_scene::ModelShelf;
use gearmesh_scene::system_run::RunJob;
use gearmesh_scene::{SceneFile, load, run as run_pair};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

/// What no counter and no length can be.
const HUGE: f64 = 1e300;

/// A case that takes longer counts as one that never ends.
const FOREVER: Duration = Duration::from_secs(60);

/// A number of a file: where it stands, and what stands there.
pub struct Place {
    pub name: String,
    offset: usize,
    /// Little-endian, eight bytes of floating point or four of a count.
    own: Vec<u8>,
}

impl Place {
    /// The first and the last number of every array of a file.
    pub fn all(file: &Path, format: &FileFormat) -> (Vec<u8>, Vec<Self>) {
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
    pub fn put(&self, bytes: &[u8], value: &[u8]) -> Vec<u8> {
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
pub fn walk(file: &Path, format: &FileFormat, read: impl Fn(&Path) -> bool + Sync) {
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
        ("bored", small_bored_gear()),
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
pub fn shipped(name: &str) -> PathBuf {
    crate::common::root().join("reference/files").join(name)
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
        SceneFile::Bevel(scene) => scene
            .load(&ModelShelf::default())
            .is_ok_and(|pair| !pair.plan().is_empty()),
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
