//! Files of every version that a program has written: each is read, and to the values that it was written with.
//!
//! They stand in reference/files and are never written anew: a reader that changes has to keep reading them. A new
//! version of a format gets a new file: raise the number here and run this program with `--ignored`, which writes the
//! files that are not there.

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use crate::made_up_gears::pair_common::made_up_models::{
    small_bevel_gear, small_bored_gear, small_crack, small_patterned_gear, small_reduced_gear,
    small_two_faced_gear,
};
use gearmesh_model::{
    Column, DataTree, FileFormat, REDUCED_GEAR_FORMAT, ReducedGear, StoredGear, read_reduced_gear,
    write_reduced_gear,
};
use gearmesh_scene::pair::{LineForces, PairSolution, PairSource};
use gearmesh_scene::periods::Coverage;
use gearmesh_scene::system_run::{
    Outcome, RunJob, RunOptions, SYSTEM_RESULT_FORMAT, SystemResult, run,
};
use gearmesh_scene::{
    ContactPlaces, RESULT_FORMAT, ResultFile, SceneFile, SceneResult, StrainSeries,
};

fn file(kind: &str, version: u32) -> PathBuf {
    let files = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../reference/files");
    files.join(format!("{kind}_v{version}.h5"))
}

/// The model as far as a version of the format holds it.
fn model(version: u32) -> ReducedGear {
    if version >= 9 {
        return small_bored_gear();
    }
    if version >= 8 {
        return small_two_faced_gear();
    }
    if version >= 7 {
        return small_patterned_gear();
    }
    if version >= 6 {
        return small_bevel_gear();
    }
    let mut gear = small_reduced_gear();
    gear.crack = Some(small_crack());
    if version < 5 {
        let text = "# made up\nname = \"synthetic\"\nnote = \"α = 20°\"\n";
        gear.input = StoredGear::of_older_file(text.to_owned());
    }
    if version < 4 {
        gear.crack = None;
    }
    if version < 3 {
        (gear.rigid_body, gear.reference_point, gear.modes) = (None, None, None);
        gear.provenance.effort.clear();
    }
    if version < 2 {
        gear.near_field = None;
    }
    gear
}

/// Elements along root fillets, in modules, where a gear file gave no length until 2026-11-29. Files keep what was
/// taken; those without a definition are read with today's default.
const FILLET_OF_THEN: f64 = 0.08;

/// The gear with the default fillets of then.
fn with_fillets_of_then(stored: &StoredGear) -> StoredGear {
    let Some(definition) = stored.definition() else {
        return stored.clone();
    };
    let mut definition = definition.clone();
    definition.mesh.fillet_m = FILLET_OF_THEN * definition.tooth.module_m;
    StoredGear::new(definition)
}

#[test]
fn models_of_every_version_are_read() {
    for version in 1..=REDUCED_GEAR_FORMAT.version {
        let found = read_reduced_gear(&file("model", version)).unwrap();
        let mut expected = model(version);
        expected.input = with_fillets_of_then(&expected.input);
        assert_eq!(found, expected, "version {version}");
    }
}

const TORQUES: usize = 2;
const ANGLES: usize = 8;
const SLOTS: usize = 2;
const SLICES: usize = 3;

fn gear_toml(teeth: usize) -> String {
    format!(
        "name = \"z {teeth}\"\n[tooth]\nteeth = {teeth}\nmodule_mm = 3.0\nface_width_mm = 20.0\n[blank]\nkind = \"solid\"\n\
         bore_diameter_mm = 20.0\n[material]\nyoung_GPa = 210.0\npoisson = 0.3\n"
    )
}

/// A result of made-up numbers, as far as a version of the format holds it.
fn pair_result(version: u32) -> SceneResult {
    let numbers = |count: usize, scale: f64| (0..count).map(|i| scale * (1.0 + i as f64)).collect();
    let (curve, lines) = (TORQUES * ANGLES, TORQUES * ANGLES * SLOTS * SLICES);
    let places = ANGLES * SLOTS * SLICES;
    let text = |text: &str| text.to_owned();
    let later = |from: u32| version >= from;
    SceneResult {
        source: PairSource {
            title: text("golden"),
            scene_toml: text("# the scene\ntitle = \"golden\"\n"),
            gears: [24, 36].map(|teeth| StoredGear::of_older_file(gear_toml(teeth))),
            model_files: [text("/a/gear_1.h5"), text("/a/gear_2.h5")],
            // Texts of newer programs: empty in files without them.
            microgeometry: Default::default(),
            version: text("0.1.0"),
            created_utc: text("2000-01-01T00:00:00Z"),
        },
        lines: LineForces {
            slots: SLOTS,
            slices: SLICES,
            pair: numbers(ANGLES * SLOTS, 1.0),
            pair_count: vec![2; ANGLES],
            force_n: numbers(lines, 5.0),
            pressure_pa: numbers(lines, 1e6),
            places: later(3).then(|| ContactPlaces {
                roll_1_rad: numbers(places, 0.01),
                z_m: numbers(places, 1e-3),
                width_m: numbers(places, 2e-3),
                ..ContactPlaces::default()
            }),
            k_h_beta: vec![1.1, 1.2],
        },
        solution: PairSolution {
            iterations: vec![30, 31],
            residual: vec![1e-14, 2e-14],
            torque_balance: vec![1e-13, 2e-13],
            seconds: [0.5, 0.25],
        },
        pitches: 2,
        contact_coverage: Coverage::of_contact(1, 2),
        proposal: text(if later(3) {
            "pitches = 36 covers everything"
        } else {
            ""
        }),
        angle_rad: numbers(ANGLES, 0.01),
        torque_nm: vec![50.0, 100.0],
        te_m: numbers(curve, -1e-6),
        unloaded_m: numbers(ANGLES, -1e-7),
        torque_1_nm: numbers(curve, 10.0),
        // Version 1 knew spur gears only.
        axial_force_1_n: if later(2) {
            numbers(curve, 3.0)
        } else {
            vec![0.0; curve]
        },
        secant_n_per_m: numbers(curve, 1e8),
        tangent_n_per_m: numbers(curve, 2e8),
        te_mesh_error: 0.0,
        between: Default::default(),
        bevel: None,
        strain: vec![StrainSeries {
            gear: 2,
            name: text("root"),
            error_estimate_relative: 0.01,
            // A tooth of gear 2 comes round after 36 pitches.
            coverage: Coverage::of_contact(36, 2),
            method_1: numbers(curve, 1e-6),
            method_2: numbers(curve, 1.1e-6),
            between: Default::default(),
        }],
        ratings: Vec::new(),
        warnings: vec![text("a warning")],
    }
}

#[test]
fn results_of_pairs_of_every_version_are_read() {
    for version in 1..=RESULT_FORMAT.version {
        let path = file("pair_result", version);
        let mut found = SceneResult::read(&path).unwrap();
        let mut expected = pair_result(version);
        for result in [&mut found, &mut expected] {
            result.source.gears = result.source.gears.each_ref().map(with_fillets_of_then);
        }
        assert_eq!(found, expected, "version {version}");
        assert!(matches!(
            ResultFile::open(&path).unwrap(),
            ResultFile::Pair(_)
        ));
    }
}

const WHEEL: &str = include_str!("../../../../tests/support/wheel.toml");

#[test]
fn results_of_multibody_runs_of_every_version_are_read() {
    for version in 1..=SYSTEM_RESULT_FORMAT.version {
        let path = file("system_result", version);
        let result = SystemResult::open(&path).unwrap();
        assert_eq!(result.head.title, "wheel");
        assert_eq!(result.head.scene_toml, WHEEL);
        assert_eq!(result.rows.rows(), 101);
        assert!(result.problem().is_none());
        // 2 N m on 0.5 kg m² for a second.
        let speeds = result
            .rows
            .read("bodies/wheel/angular_velocity_z_rad_per_s")
            .unwrap();
        assert!((speeds[100] - 4.0).abs() < 1e-9, "{}", speeds[100]);
        let column = &result.rows.columns()[1];
        assert_eq!(
            (&column.name[..], &column.unit[..]),
            ("bodies/wheel/x_m", "m")
        );
        assert!(!column.description.is_empty());
        let stated = |column: &Column| !column.unit.is_empty();
        assert!(result.rows.columns().iter().all(stated));
        assert!(matches!(
            ResultFile::open(&path).unwrap(),
            ResultFile::System(_)
        ));
    }
}

/// A file of an older version: today's without what that version did not have.
fn write_older(path: &Path, format: FileFormat, is_new: impl Fn(&str) -> bool, made: &Path) {
    let newest = match format.name {
        name if name == RESULT_FORMAT.name => RESULT_FORMAT,
        _ => REDUCED_GEAR_FORMAT,
    };
    let mut tree = DataTree::read(made, &newest).unwrap();
    tree.arrays.retain(|name, _| !is_new(name));
    tree.texts.retain(|name, _| !is_new(name));
    tree.write(path, &format).unwrap();
}

#[test]
#[ignore = "writes the files that are not there; needed once for each new version of a format"]
fn write_missing_files() {
    let desk = tempfile::tempdir().unwrap();
    let made = desk.path().join("made.h5");
    std::fs::create_dir_all(file("", 0).parent().unwrap()).unwrap();
    for version in 1..=REDUCED_GEAR_FORMAT.version {
        let path = file("model", version);
        if !path.exists() {
            write_reduced_gear(&made, &model(version)).unwrap();
            let format = FileFormat {
                version,
                ..REDUCED_GEAR_FORMAT
            };
            write_older(&path, format, |_| false, &made);
        }
    }
    for version in 1..=RESULT_FORMAT.version {
        let path = file("pair_result", version);
        if !path.exists() {
            pair_result(version).write(&made).unwrap();
            let since_2 = |name: &str| name == "axial_force_1_N";
            let since_3 = |name: &str| {
                name == "proposal"
                    || ["/period_pitches", "/extent"]
                        .iter()
                        .any(|end| name.ends_with(end))
            };
            let is_new = |name: &str| version < 2 && since_2(name) || version < 3 && since_3(name);
            write_older(
                &path,
                FileFormat {
                    version,
                    ..RESULT_FORMAT
                },
                is_new,
                &made,
            );
        }
    }
    let path = file("system_result", SYSTEM_RESULT_FORMAT.version);
    if !path.exists() {
        let folder = Path::new("");
        let document = gearmesh_geometry::input::InputDocument::new("wheel.toml", WHEEL);
        let SceneFile::System(scene) = SceneFile::from_document(document, folder).unwrap() else {
            unreachable!("a multibody scene");
        };
        let options = RunOptions {
            output: &path,
            restart: true,
            checkpoint_interval: Duration::from_secs(3600),
            stop: &AtomicBool::new(false),
            progress: &|_| (),
        };
        let job = RunJob::from_scene(scene.load().unwrap()).unwrap();
        assert_eq!(run(job, &options).unwrap(), Outcome::Finished);
    }
}
