//! The same bits for any number of threads, and a number of threads that no machine has.

use crate::common::{Answer, Desk, THIN, argument, program, refused};
use gearmesh_model::{DataTree, FileFormat, REDUCED_GEAR_FORMAT};
use gearmesh_scene::system_run::SYSTEM_RESULT_FORMAT;
use std::path::Path;

fn with_threads(threads: &str, words: &[&str]) -> Answer {
    let mut program = program(words);
    let program = program.env("RAYON_NUM_THREADS", threads);
    program.output().unwrap().into()
}

/// What a command writes with one and with two threads; what it says of time and machine is left out.
fn written(command: &str, input: &Path, format: &FileFormat) -> [DataTree; 2] {
    ["1", "2"].map(|threads| {
        let desk = Desk::new();
        let output = desk.path("out.h5");
        let words = [command, argument(input), "-o", argument(&output)];
        let answer = with_threads(threads, &words);
        assert_eq!(answer.code, Some(0), "{answer:#?}");
        let mut tree = DataTree::read(&output, format).unwrap();
        let is_of_machine =
            |name: &str| name.starts_with("provenance/stage/") || name == "provenance/threads";
        tree.arrays.retain(|name, _| !is_of_machine(name));
        tree.arrays.retain(|name, _| !name.starts_with("run/wall"));
        tree
    })
}

/// Every bit: negative zero is not zero.
fn assert_same_bits([one, two]: &[DataTree; 2]) {
    assert!(one.arrays.len() > 50, "{} arrays", one.arrays.len());
    for (name, array) in &one.arrays {
        let (a, b) = (
            format!("{:?}", array.values),
            format!("{:?}", two.arrays[name].values),
        );
        assert_eq!(a, b, "{name}");
    }
    assert_eq!(one.arrays.len(), two.arrays.len());
}

#[test]
fn a_reduction_gives_the_same_bits_for_one_and_two_threads() {
    let desk = Desk::new();
    // With gauges, whose errors are sums over all teeth, and with modes.
    let gear = THIN.replace(
        "[[gauge]]\nname = \"tension\"",
        "[modes]\ncount = 3\n[[gauge]]\nname = \"tension\"",
    );
    let gear = gear.replace(
        "poisson = 0.3\n",
        "poisson = 0.3\ndensity_kg_per_m3 = 7850.0\n",
    );
    let file = desk.file("gear.toml", gear);
    assert_same_bits(&written("reduce", &file, &REDUCED_GEAR_FORMAT));
}

#[test]
fn a_gearbox_at_rest_gives_the_same_bits_for_one_and_two_threads() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let scene = root.join("fe_models/gearbox_three_stage.toml");
    assert_same_bits(&written("run", &scene, &SYSTEM_RESULT_FORMAT));
}

#[test]
fn a_number_of_threads_that_no_machine_has_is_refused() {
    for threads in ["1000000", "many"] {
        let answer = with_threads(threads, &["check", "nothing.toml"]);
        let found = format!("RAYON_NUM_THREADS: found {threads}, allowed is 1 to 1024");
        refused(&answer, 2, &[&found]);
    }
}
