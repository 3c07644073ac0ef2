//! `gearmesh import`: the shipped REXS gearbox becomes files that the program accepts, and its bearings carry what hand statics say.

use crate::common::{Desk, argument, gearmesh, names_in, refused, succeeds};
use gearmesh_scene::system_run::SystemResult;
use std::path::Path;

/// Forces of the bearings on the shafts \[N\]: tools/reference/gearbox_statics.py.
const BY_HAND: &str = include_str!("../../../../reference/gearbox_three_stage/data.csv");

#[test]
fn a_gearbox_of_three_stages_is_imported_and_runs() {
    let desk = Desk::new();
    let model =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fe_models/gearbox_three_stage.rexs");
    let folder = desk.path("imported");
    let answer = succeeds(&[
        "import",
        argument(&model),
        "-o",
        argument(&folder),
        "--json",
    ]);
    let told = answer.json();
    assert_eq!(told["scenes"].as_array().unwrap().len(), 2);
    let files = names_in(&folder);
    for file in files.iter().filter(|name| name.ends_with(".toml")) {
        succeeds(&["check", argument(&folder.join(file))]);
    }
    let list = std::fs::read_to_string(folder.join("import.md")).unwrap();
    for words in [
        "## Not represented",
        "viscosity_at_40_degree_celsius 220",
        "stands for rigid",
        "number_of_teeth 17",
    ] {
        assert!(list.contains(words), "{words} is not in {list}");
    }
    let (scene, output) = (
        folder.join("gearbox_three_stage.toml"),
        desk.path("result.h5"),
    );
    succeeds(&["run", argument(&scene), "-o", argument(&output)]);
    let result = SystemResult::open(&output).unwrap();
    let last = |column: String| *result.rows.read(&column).unwrap().last().unwrap();
    let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    for row in BY_HAND.lines().skip(1) {
        let (bearing, numbers) = row.split_once(',').unwrap();
        let expected: Vec<f64> = numbers.split(',').map(|v| v.parse().unwrap()).collect();
        // The exchange file has the shafts along x: its x, y, z are z, x, y of the figures by hand.
        let found =
            ["y", "z", "x"].map(|axis| last(format!("elements/{bearing}/force_world_{axis}_N")));
        let off: Vec<f64> = expected.iter().zip(found).map(|(a, b)| b - a).collect();
        assert!(
            norm(&off) < 0.02 * norm(&expected),
            "{bearing}: {found:?} {expected:?}"
        );
    }
    let input = result
        .rows
        .read("elements/held at motor/moment_z_Nm")
        .unwrap()[0]
        .abs();
    assert!((input / 28.2068 - 1.0).abs() < 1e-4, "{input}");
}

#[test]
fn what_cannot_be_imported_is_told_with_the_line() {
    let desk = Desk::new();
    let broken = desk.file(
        "broken.rexs",
        "<model version=\"1.4\">\n<components>\n</model>",
    );
    let answer = gearmesh(&[
        "import",
        argument(&broken),
        "-o",
        argument(&desk.path("out")),
    ]);
    refused(&answer, 2, &["broken.rexs", "line 3", "broken XML"]);
    let answer = gearmesh(&["import", "nothing.rexs", "-o", argument(&desk.path("out"))]);
    refused(&answer, 2, &["nothing.rexs"]);
}
