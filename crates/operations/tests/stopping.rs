//! Operations end soon after their stop flag is set, and leave no file.

#![allow(clippy::unwrap_used, clippy::expect_used)]

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

use gearmesh_geometry::input::InputDocument;
use gearmesh_operations::gear_file::GearFile;
use gearmesh_operations::reduce::{Reduction, reduce_to};
use gearmesh_operations::{Fault, Listener, Task, Watch, by_name};
use serde_json::json;

/// A coarse gear in plane strain: reduced in a second.
const GEAR: &str = r#"
name = "coarse"
[tooth]
teeth = 23
module_mm = 3.0
face_width_mm = 20.0
[blank]
kind = "solid"
bore_diameter_mm = 25.0
[material]
young_GPa = 206.0
poisson = 0.3
[mesh]
flank_mm = 2.0
fillet_mm = 1.0
body_mm = 6.0
plane_strain = true
"#;

/// Sets the flag at a stage, and keeps what it hears.
struct StopAt<'a> {
    stage: &'a str,
    stop: &'a AtomicBool,
    heard: Mutex<Vec<String>>,
}

impl Listener for StopAt<'_> {
    fn begin(&self, _: &str) -> Box<dyn Task + '_> {
        Box::new(Told(self))
    }

    fn note(&self, _: &str) {}

    fn warning(&self, _: &str) {}
}

struct Told<'a>(&'a StopAt<'a>);

impl Task for Told<'_> {
    fn stage(&self, name: &str) {
        self.0.heard.lock().unwrap().push(name.to_owned());
        if name == self.0.stage {
            self.0.stop.store(true, Ordering::Relaxed);
        }
    }

    fn advance(&self, _: f64, _: f64) {
        assert!(
            !self.0.stop.load(Ordering::Relaxed),
            "the work went on after it was stopped"
        );
    }

    fn expect(&self, _: f64) {}
}

#[test]
fn a_reduction_ends_at_each_of_its_stages_without_a_model() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("model.h5");
    let how = Reduction {
        estimate_error: false,
        even_if_memory_is_short: false,
    };
    let outcome = |stage: &str| {
        let stop = AtomicBool::new(false);
        let listener = StopAt {
            stage,
            stop: &stop,
            heard: Mutex::default(),
        };
        let watch = Watch {
            listener: &listener,
            stop: &stop,
            python: None,
        };
        let document = InputDocument::new("gear.toml", GEAR);
        let gear = GearFile::of(&document, &watch).unwrap();
        let fault = reduce_to(&gear, how, &output, &watch).map_err(|failure| failure.fault);
        let heard = listener.heard.into_inner().unwrap();
        (fault.map(|_| ()), heard)
    };
    let (reduced, stages) = outcome("no such stage");
    assert_eq!(reduced, Ok(()));
    assert!(stages.len() > 4, "{stages:?}");
    std::fs::remove_file(&output).unwrap();
    for (place, stage) in stages.iter().enumerate() {
        // Where a stage comes twice, its first time counts.
        let first = stages.iter().position(|other| other == stage).unwrap();
        if first < place {
            continue;
        }
        let (stopped, heard) = outcome(stage);
        assert_eq!(stopped, Err(Fault::Stopped), "{stage}");
        assert_eq!(heard, stages[..=place], "{stage}");
        assert!(!output.exists(), "{stage}");
    }
}

#[test]
fn a_panic_is_no_stop() {
    let caught = std::panic::catch_unwind(|| {
        Watch::unattended().offline("work", |_| -> Result<(), gearmesh_operations::Failure> {
            std::panic::resume_unwind(Box::new("a fault"))
        })
    });
    let payload = caught.expect_err("it was swallowed");
    assert_eq!(payload.downcast_ref::<&str>(), Some(&"a fault"));
}

#[test]
fn a_request_is_refused_by_its_words() {
    let refused = |name: &str, request| {
        let failure = by_name::call(name, request, &Watch::unattended()).unwrap_err();
        assert_eq!(failure.fault, Fault::Input);
        failure.message
    };
    let words = refused(
        "report",
        json!({"results": "a.h5", "output": "a.html", "colour": 1}),
    );
    assert!(words.contains("report: unknown field `colour`"), "{words}");
    assert!(words.contains("stress_at_s"), "{words}");
    let words = refused("export", json!({"result": "a.h5"}));
    assert!(words.contains("missing field `output`"), "{words}");
    let words = refused("fly", json!({}));
    assert!(words.contains("no operation `fly`"), "{words}");
}
