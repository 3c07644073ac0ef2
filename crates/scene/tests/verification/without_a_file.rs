//! Scenes of tables in memory, with models from files and from memory: the results of the same scenes in files, bit for
//! bit; complaints name the path of the field.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use gearmesh_bevel::pair_file::BevelFile;
use gearmesh_bevel::pair_file::tables::{
    BladeTable, BlankTable, LoadTable, MemberTable, SynthesisTable,
};
use gearmesh_contact::LocalContact;
use gearmesh_geometry::gear_file::MicrogeometryTable;
use gearmesh_geometry::input::InputDocument;
use gearmesh_model::read_reduced_gear;
use gearmesh_scene::pair::BevelScene;
use gearmesh_scene::system::{LoadedSystem, SystemScene};
use gearmesh_scene::system_run::RunJob;
use gearmesh_scene::{ModelShelf, Scene, SceneResult, load, load_from, run};
use gearmesh_specification::pair::{
    GaugesTable, GearTable, MeshTable, PairModel, PairTable, PairTables, PairTeethTable, RunTable,
};
use gearmesh_specification::system::body::BodyTable;
use gearmesh_specification::system::function::FunctionTable;
use gearmesh_specification::system::gear_mesh::{GearMeshTable, PathWord};
use gearmesh_specification::system::joint::{JointTable, JointWord, MotionTable};
use gearmesh_specification::system::load::LoadTable as TorqueTable;
use gearmesh_specification::system::mesh_model::{DampingTable, HybridTable, MeshModel};
use gearmesh_specification::system::output::OutputTable;
use gearmesh_specification::system::solver::SolverTable;
use gearmesh_specification::system::{SystemTables, run as runs};

use crate::common::changed;
use crate::made_up_gears;
use crate::pair_study::SCENE;
use crate::system_runs;

const MODELS: [&str; 2] = ["gear_30.h5", "gear_41.h5"];

/// The models of a folder as models in memory, under other names than those of the files.
fn in_memory(folder: &Path) -> ModelShelf {
    let shelf = ModelShelf::default();
    for (name, file) in ["pinion", "wheel"].into_iter().zip(MODELS) {
        shelf.keep(name, read_reduced_gear(&folder.join(file)).unwrap());
    }
    shelf
}

/// The pair of another test, its axes inclined.
fn pair_text() -> String {
    let distance = "centre_distance_mm = 106.8\n";
    changed(
        SCENE,
        distance,
        &format!("{distance}inclination_mrad = 0.1\n"),
    )
}

fn pair(models: [&str; 2]) -> PairTables {
    PairTables {
        title: "made up".to_owned(),
        pair: PairTable {
            gear_1: models[0].into(),
            gear_2: models[1].into(),
            centre_distance_mm: 106.8.into(),
            inclination_mrad: Some(0.1.into()),
            ..PairTable::default()
        },
        gear_1: GearTable {
            microgeometry: Some(MicrogeometryTable {
                tip_relief_um: Some(5.0.into()),
                tip_relief_start_diameter_mm: Some(94.0),
                ..MicrogeometryTable::default()
            }),
            ..GearTable::default()
        },
        mesh: MeshTable {
            model: PairModel::Hybrid {
                local: LocalContact::WeberBanaschek,
                slices: None,
            },
            teeth: PairTeethTable {
                path: Some(PathWord::LineOfAction),
                ..PairTeethTable::default()
            },
        },
        run: RunTable {
            torques_Nm: vec![60.0.into(), 120.0.into()],
            pitches: 1.into(),
            points_per_pitch: 12.into(),
            ..RunTable::default()
        },
        gauges: GaugesTable {
            gear_1: vec!["g0".to_owned()],
            ..GaugesTable::default()
        },
        ..PairTables::default()
    }
}

/// A result without what says where and when it was made.
fn found(mut result: SceneResult) -> SceneResult {
    result.source.scene_toml.clear();
    result.source.model_files = Default::default();
    result.source.created_utc.clear();
    result.solution.seconds = [0.0; 2];
    result
}

#[test]
fn a_pair_of_tables_runs_as_its_file_does() {
    let folder = tempfile::tempdir().unwrap();
    made_up_gears::write_models(folder.path());
    let ran = |scene: Scene, shelf: &ModelShelf| {
        found(run(&load_from(scene, shelf).unwrap(), &|_, _| ()).unwrap())
    };
    let file = folder.path().join("pair.toml");
    std::fs::write(&file, pair_text()).unwrap();
    let of_file = ran(Scene::read(&file).unwrap(), &ModelShelf::default());
    let of_paths = Scene::new(&pair(MODELS), folder.path()).unwrap();
    // A result keeps what a file of these tables would be.
    let text = InputDocument::new("kept", &*of_paths.document.text);
    let of_text = ran(
        Scene::from_document(text, folder.path()).unwrap(),
        &ModelShelf::default(),
    );
    let shelf = in_memory(folder.path());
    let of_memory = Scene::new(&pair(["pinion", "wheel"]), Path::new("")).unwrap();
    assert_eq!(ran(of_paths, &ModelShelf::default()), of_file);
    assert_eq!(ran(of_memory, &shelf), of_file);
    assert_eq!(of_text, of_file);
    assert!(of_file.te_m.iter().all(|te| *te < 0.0) && of_file.strain.len() == 1);
}

/// Two gears in time, gear 1 driven at a speed that a table of the function states.
fn system(gears: [&str; 2]) -> SystemTables {
    let body = |name: &str, gear: &str, x_mm: f64| BodyTable {
        name: name.to_owned(),
        gear: Some(gear.into()),
        position_mm: Some([x_mm, 0.0, 0.0]),
        ..BodyTable::default()
    };
    let axle = |name: &str, body: &str| JointTable {
        name: name.to_owned(),
        kind: JointWord::Revolute,
        body_2: body.to_owned(),
        ..JointTable::default()
    };
    SystemTables {
        title: "made up".to_owned(),
        run: runs::RunTable::Transient { end_s: 2e-5.into() },
        solver: SolverTable {
            step_s: Some(1e-6.into()),
            ..SolverTable::default()
        },
        output: OutputTable {
            interval_s: Some(1e-6),
            ..OutputTable::default()
        },
        body: vec![
            body("pinion", gears[0], 0.0),
            body("wheel", gears[1], 106.8),
        ],
        joint: vec![axle("axle 1", "pinion"), axle("axle 2", "wheel")],
        motion: vec![MotionTable {
            name: Some("drive".to_owned()),
            joint: "axle 1".to_owned(),
            speed_rpm: Some(FunctionTable::Constant(-1500.0)),
            ..MotionTable::default()
        }],
        load: vec![TorqueTable {
            body: "wheel".to_owned(),
            torque_Nm: Some(FunctionTable::Constant(-100.0)),
            ..TorqueTable::default()
        }],
        gear_mesh: vec![GearMeshTable {
            name: "mesh".to_owned(),
            gear_1: "pinion".to_owned(),
            gear_2: "wheel".to_owned(),
            model: MeshModel::Hybrid(HybridTable {
                local: Some(LocalContact::WeberBanaschek),
                damping: Some(DampingTable::StiffnessProportional {
                    time_s: 1e-6.into(),
                    full_depth_um: 1.0.into(),
                }),
                ..HybridTable::default()
            }),
            ..GearMeshTable::default()
        }],
        ..SystemTables::default()
    }
}

#[test]
fn a_system_of_tables_runs_as_its_file_does() {
    let folder = tempfile::tempdir().unwrap();
    made_up_gears::write_models(folder.path());
    let text = made_up_gears::scene(
        "[run]\nkind = \"transient\"\nend_s = 2e-5\n[solver]\nstep_s = 1e-6\n[output]\ninterval_s = 1e-6",
        -1500.0,
        "",
        "",
    );
    let rows = |loaded: LoadedSystem| -> Vec<(String, Vec<u64>)> {
        let desk = system_runs::Desk::new();
        let result = desk.run(RunJob::from_scene(loaded).unwrap());
        let columns = result.rows.columns().iter();
        let bits = |name: &str| {
            result
                .rows
                .read(name)
                .unwrap()
                .into_iter()
                .map(f64::to_bits)
        };
        columns
            .map(|column| (column.name.clone(), bits(&column.name).collect()))
            .collect()
    };
    let file = folder.path().join("system.toml");
    std::fs::write(&file, text).unwrap();
    let of_file = rows(SystemScene::read(&file).unwrap().load().unwrap());
    let scene = SystemScene::new(&system(MODELS), folder.path(), Arc::default()).unwrap();
    assert_eq!(rows(scene.load().unwrap()), of_file);
    let shelf = Arc::new(in_memory(folder.path()));
    let scene = SystemScene::new(&system(["pinion", "wheel"]), Path::new(""), shelf).unwrap();
    assert_eq!(rows(scene.load().unwrap()), of_file);
    let force = of_file
        .iter()
        .find(|(name, _)| name.ends_with("normal_force_right_N"));
    let force = force.unwrap().1.iter().map(|bits| f64::from_bits(*bits));
    assert!(force.fold(0.0, f64::max) > 0.0);
}

fn bevel() -> BevelFile {
    let blade = 0.2;
    BevelFile {
        title: "20/20".to_owned(),
        bevel: BlankTable {
            teeth: [20.into(), 20.into()],
            outer_module_mm: 3.5.into(),
            face_width_mm: [15.0.into(), 15.0.into()],
            spiral_angle_deg: Some(35.0.into()),
            pinion_hand: Some(gearmesh_bevel::Hand::Right),
            cutter_radius_mm: Some(44.45.into()),
            thickness_shift: Some(0.007.into()),
            ..BlankTable::default()
        },
        gear: MemberTable::Basic(BladeTable {
            edge_radius_mm: Some(blade.into()),
            ..BladeTable::default()
        }),
        pinion: MemberTable::LocalSynthesis(SynthesisTable {
            edge_radius_mm: Some(blade.into()),
            point_width_mm: None,
            least_top_land_mm: None,
            mean_point_along_mm: [0.0; 2],
            mean_point_height_mm: [0.0; 2],
            path_angle_deg: [100.0.into(), 80.0.into()],
            ellipse_half_length_mm: [4.0.into(), 4.0.into()],
            marking_um: None,
            transmission_curvature: [(-0.005).into(), (-0.005).into()],
        }),
        tca: None,
        load: Some(LoadTable {
            torques_Nm: vec![100.0.into()],
            slices: Some(9.into()),
            positions_per_pitch: Some(4.into()),
            ..LoadTable::default()
        }),
    }
}

#[test]
fn a_bevel_pair_of_tables_runs_as_its_file_does() {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fe_models");
    let text = std::fs::read_to_string(shipped.join("bevel_20_20_loaded.toml")).unwrap();
    let text = text
        .replace("[50.0, 100.0, 200.0]", "[100.0]")
        .replace("slices = 31", "slices = 9")
        .replace("per_pitch = 16", "per_pitch = 4");
    let ran = |scene: BevelScene| {
        let pair = scene.load(&ModelShelf::default()).unwrap();
        let mut result = found(pair.run(&|_, _| (), &AtomicBool::new(false)).unwrap());
        result.source.title.clear();
        result
    };
    let of_file = BevelScene::from_document(InputDocument::new("bevel.toml", text)).unwrap();
    let of_tables = BevelScene::new(&bevel(), Path::new("")).unwrap();
    assert_eq!(ran(of_tables), ran(of_file));
}

/// Every shipped scene's tables are written and read again as they were: all kinds of models, functions and sets.
#[test]
fn shipped_scenes_are_written_as_they_were_read() {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fe_models");
    let mut count = 0;
    for entry in std::fs::read_dir(&shipped).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|ending| ending != "toml") {
            continue;
        }
        let document = InputDocument::read(&path).unwrap();
        if let Ok(tables) = document.parse::<SystemTables>() {
            let values = InputDocument::of_values(&tables, &shipped).unwrap();
            let again: SystemTables = values.parse().unwrap();
            assert_eq!(format!("{tables:?}"), format!("{again:?}"), "{path:?}");
            let text = InputDocument::new("written.toml", values.text);
            let again: SystemTables = text.parse().unwrap();
            assert_eq!(format!("{tables:?}"), format!("{again:?}"), "{path:?}");
            count += 1;
        }
    }
    assert!(count > 20, "{count}");
}

#[test]
fn complaints_name_the_path_of_the_field() {
    let folder = tempfile::tempdir().unwrap();
    made_up_gears::write_models(folder.path());
    let mut tables = pair(MODELS);
    tables.pair.centre_distance_mm = (-1.0).into();
    let problem = Scene::new(&tables, folder.path()).unwrap_err();
    assert_eq!(
        problem.to_string(),
        "pair.centre_distance_mm: found -1, allowed is more than 0"
    );
    let mut tables = pair(MODELS);
    tables.gauges.gear_1 = vec!["g9".to_owned()];
    let scene = Scene::new(&tables, folder.path()).unwrap();
    let problem = load(scene).unwrap_err().to_string();
    assert!(
        problem.starts_with("gauges.gear_1.0: the model has no gauge `g9`"),
        "{problem}"
    );
    let scene = Scene::new(&pair(["pinion", "wheel"]), Path::new("")).unwrap();
    let problem = load(scene).unwrap_err().to_string();
    assert!(
        problem.starts_with("pair.gear_1: the model pinion does not exist"),
        "{problem}"
    );

    let mut tables = system(MODELS);
    tables.body[1].modal_damping_ratio = Some(1.5.into());
    let refused = |tables: &SystemTables| {
        let scene = SystemScene::new(tables, folder.path(), Arc::default());
        let problem = scene.and_then(|scene| scene.load()?.build());
        problem.map(|_| ()).unwrap_err().to_string()
    };
    let problem = refused(&tables);
    assert!(
        problem.starts_with("body.1.modal_damping_ratio: found 1.5"),
        "{problem}"
    );
    let mut tables = system(MODELS);
    tables.joint[0].body_2 = "pignon".to_owned();
    let problem = refused(&tables);
    assert!(
        problem.starts_with("joint.0.body_2: ") && problem.contains("pinion"),
        "{problem}"
    );
}
