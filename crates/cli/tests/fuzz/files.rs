//! Text files: gears, scenes, studies, S-N tables, tables of numbers, records, gearboxes in REXS.

use crate::common::root;
use crate::{fuzz, mutation};
use gearmesh_geometry::GearDefinition;
use gearmesh_geometry::input::InputDocument;
use gearmesh_report::ReferenceRecord;
use gearmesh_rexs::{Meshes, Running, import_to_run};
use gearmesh_scene::rating::sn_curve;
use gearmesh_scene::study::StudyScenes;
use gearmesh_scene::system_run::RunJob;
use gearmesh_scene::{InputKind, SceneFile};
use gearmesh_specification::study::Study;
use std::path::Path;

const WHEEL: &str = include_str!("../../../../tests/support/wheel.toml");

/// Shipped files of a kind.
pub fn shipped(kind: InputKind) -> Vec<String> {
    shipped_texts(|document| InputKind::of(document).unwrap() == kind)
}

/// Shipped files that `wanted` accepts.
pub fn shipped_texts(wanted: impl Fn(&InputDocument) -> bool) -> Vec<String> {
    let mut paths: Vec<_> = std::fs::read_dir(root().join("fe_models"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
        .collect();
    paths.sort();
    let texts = paths
        .iter()
        .map(|path| std::fs::read_to_string(path).unwrap());
    texts.filter(|text| wanted(&document(text))).collect()
}

/// A text in a file of no name.
pub fn document(text: &str) -> InputDocument {
    InputDocument::new("case.toml", text)
}

/// Texts with faults; `read` is given those that are texts.
pub fn fuzz_text(target: &str, usual: u64, corpus: &[String], read: impl Fn(&str)) {
    assert!(!corpus.is_empty());
    let make = |random: &mut fastrand::Rng| mutation::text(corpus, random).into_bytes();
    fuzz(target, usual, make, |case| {
        // Bytes that are no text are refused when the file is read.
        if let Ok(text) = std::str::from_utf8(case) {
            read(text);
        }
    });
}

#[test]
fn gear_files() {
    fuzz_text("gear", 1500, &shipped(InputKind::Gear), |text| {
        let document = document(text);
        let _ = document.unit_slips();
        if let Ok(gear) = GearDefinition::from_document(&document) {
            let profile = &gear.profile;
            let radii = [
                profile.base_radius_m,
                profile.root_radius_m,
                profile.tip_radius_m,
            ];
            assert!(radii.iter().all(|r| r.is_finite() && *r > 0.0), "{radii:?}");
            assert!(gear.sectors() >= 1);
        }
    });
}

/// Read, loaded with the gears that it names, built, and made a run.
pub fn scene_is_answered(text: &str, folder: &Path) {
    let Ok(SceneFile::System(scene)) = SceneFile::from_document(document(text), folder) else {
        return;
    };
    let Ok(loaded) = scene.load() else { return };
    let _ = loaded.unit_slips();
    if loaded.build().is_ok() {
        let _ = RunJob::from_scene(loaded);
    }
}

#[test]
fn scenes() {
    let folder = root().join("fe_models");
    let mut corpus = shipped(InputKind::Scene);
    corpus.push(WHEEL.to_owned());
    fuzz_text("scene", 250, &corpus, |text| {
        scene_is_answered(text, &folder)
    });
}

#[test]
fn studies() {
    let folder = root().join("fe_models");
    fuzz_text("study", 60, &shipped(InputKind::Study), |text| {
        if let Ok(study) = Study::from_document(document(text), &folder) {
            let _ = StudyScenes::new(&study, &folder);
        }
    });
}

#[test]
fn sn_tables() {
    fuzz_text("sn_table", 3000, &shipped(InputKind::SnTable), |text| {
        let Ok(curve) = sn_curve(&document(text)) else {
            return;
        };
        for amplitude_pa in [0.0, 1e-3, 1e6, 300e6, 1e9, 1e15] {
            if let Ok(cycles) = curve.cycles_to_failure(amplitude_pa) {
                // Zero where the slope is steep and the amplitude far above the table.
                assert!(cycles >= 0.0, "{cycles} at {amplitude_pa}");
            }
        }
    });
}

#[test]
fn tables_of_numbers() {
    let desk = tempfile::tempdir().unwrap();
    let table = r#"torque_Nm = { table = { file = "rig.csv", column = "torque_Nm", interpolation = "monotone-cubic" } }"#;
    let scene = WHEEL.replace("torque_Nm = 2.0", table);
    let corpus = [
        "# rig, Tuesday\ntime_s,torque_Nm\n0,1\n0.25,2.5\n0.5,-3e2\n1,4\n".to_owned(),
        "\u{feff}torque_Nm, time_s, note\r\n1,0,a\r\n\r\n2,0.5,\"b, c\"\r\n3,1,\r\n".to_owned(),
    ];
    fuzz_text("number_table", 500, &corpus, |text| {
        std::fs::write(desk.path().join("rig.csv"), text).unwrap();
        scene_is_answered(&scene, desk.path());
    });
}

#[test]
fn records() {
    let desk = tempfile::tempdir().unwrap();
    let folder = root().join("reference/plane_gear");
    let of = |name: &str| std::fs::read_to_string(folder.join(name)).unwrap();
    let data: String = of("data.csv")
        .lines()
        .take(40)
        .map(|line| format!("{line}\n"))
        .collect();
    // Both files in one case, parted by a NUL.
    let corpus = [format!("{}\0{data}", of("record.toml"))];
    fuzz_text("record", 500, &corpus, |text| {
        let (description, data) = text.split_once('\0').unwrap_or((text, ""));
        std::fs::write(desk.path().join("record.toml"), description).unwrap();
        std::fs::write(desk.path().join("data.csv"), data).unwrap();
        if let Ok(record) = ReferenceRecord::read(desk.path()) {
            for column in &record.columns {
                let _ = record.series(column);
            }
        }
    });
}

/// A shaft with a gear as REXS in JSON.
const REXSJ: &str = r#"{"model": {"version": "1.4", "relations": [
  {"id": 1, "type": "assembly", "refs": [{"id": 1, "role": "assembly"}, {"id": 2, "role": "part"}]},
  {"id": 2, "type": "assembly", "refs": [{"id": 2, "role": "assembly"}, {"id": 3, "role": "part"}]},
  {"id": 3, "type": "assembly", "refs": [{"id": 2, "role": "assembly"}, {"id": 4, "role": "part"}]}],
 "components": [{"id": 1, "type": "gear_unit", "attributes": []},
  {"id": 2, "type": "shaft", "name": "input", "attributes": [{"id": "u_axis_vector", "unit": "mm", "floating_point_array": [1.0, 0.0, 0.0]}]},
  {"id": 3, "type": "shaft_section", "attributes": [
   {"id": "length", "unit": "mm", "floating_point": 60.0},
   {"id": "outer_diameter_begin", "unit": "mm", "floating_point": 30.0},
   {"id": "outer_diameter_end", "unit": "mm", "floating_point": 30.0}]},
  {"id": 4, "type": "cylindrical_gear", "attributes": [
   {"id": "number_of_teeth", "unit": "none", "integer": 17},
   {"id": "normal_module", "unit": "mm", "floating_point": 2.0},
   {"id": "face_width", "unit": "mm", "floating_point": 24.0},
   {"id": "u_coordinate_on_shaft", "unit": "mm", "floating_point": 30.0}]}]}}"#;

/// Imported, at rest and in time; the files that an import writes are answered as any others.
#[test]
fn rexs() {
    let of = |file: &str| std::fs::read_to_string(root().join(file)).unwrap();
    let corpus = [
        of("fe_models/gearbox_three_stage.rexs"),
        of("crates/cli/tests/scene_commands/idler_on_bearing.rexs"),
        REXSJ.to_owned(),
    ];
    fuzz_text("rexs", 150, &corpus, |text| {
        for running in [Running::AtRest, Running::InTime] {
            let bytes = text.as_bytes().to_vec();
            let Ok(import) = import_to_run(bytes, "case", Meshes::Iso6336, running) else {
                continue;
            };
            let desk = tempfile::tempdir().unwrap();
            for file in &import.files {
                std::fs::write(desk.path().join(&file.name), &file.text).unwrap();
            }
            for scene in import
                .files
                .iter()
                .filter(|f| import.scenes.contains(&f.name))
            {
                scene_is_answered(&scene.text, desk.path());
            }
        }
    });
}
