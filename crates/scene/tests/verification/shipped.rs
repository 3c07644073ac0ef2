//! The scenes that are shipped: their plans and systems.

use std::f64::consts::TAU;

use gearmesh_geometry::GearDefinition;
use gearmesh_scene::SceneFile;
use gearmesh_scene::system::{BuiltMesh, BuiltSystem, SystemPlan};
use gearmesh_scene::system_run::RunCost;
use gearmesh_specification::system::run::Run;

use crate::common::*;
use crate::{assert_labelled, spin};

#[test]
fn plans_say_what_is_computed_and_what_is_not() {
    for (name, expected) in [
        (
            "scene_pendulum.toml",
            vec![
                "run        transient to 2 s",
                "joint      hinge: revolute, on ground and rod",
                "1 degrees of freedom left",
                "2000 steps",
            ],
        ),
        (
            "scene_two_wheels.toml",
            vec![
                "body       pinion: 2.",
                "kg, gear file",
                "force      mesh: impact mesh, on pinion and wheel",
                "mesh frequency at the start 570.000 Hz",
                // Contact ratio and pitch radius of seed 004's pair; no overlap.
                "stage      mesh: ratio 1.000000, eps_alpha 1.639, eps_beta 0.000, c' ",
                "pitch line 4.712 m/s at the start",
                "effect     mesh `mesh`: friction: not computed",
                "effect     mesh `mesh`: damping: STEP of the depth",
                "effect     weight: not computed",
                "note       body `wheel` is turned so that the right flanks of mesh `mesh` touch",
                "25000 steps",
            ],
        ),
        (
            "dynamics_17_25.toml",
            // 17 teeth at 500 rpm.
            vec![
                "at rest at the start, mesh frequency up to 141.667 Hz at the speeds that motions reach",
            ],
        ),
    ] {
        let SceneFile::System(scene) = SceneFile::read(&fe_models().join(name)).unwrap() else {
            panic!("{name} is a multibody scene");
        };
        let loaded = scene.load().unwrap();
        assert!(matches!(loaded.scene.run, Run::Transient { .. }));
        let plan = SystemPlan::new(&loaded.scene, loaded.build().unwrap())
            .unwrap()
            .with_cost(&loaded.scene, RunCost::timed(&loaded).unwrap());
        let text = plan.lines.join("\n");
        for part in expected {
            assert!(text.contains(part), "`{part}` is not in\n{text}");
        }
        assert!(
            plan.step_cost_s.unwrap() > 0.0
                && plan.degrees_of_freedom == 6 * loaded.build().unwrap().bodies.len()
        );
    }
}

/// The stage at a glance fits the system: its pitch circles fill the distance of the gears' axes, the pitch line runs
/// with them, and its three forces make up the normal force 1 N m/(r_b cos β_b).
fn assert_stage(mesh: &BuiltMesh, built: &BuiltSystem) {
    let stage = mesh.stage.unwrap();
    let place = |name: &String| {
        let bodies = built.system.bodies().iter();
        bodies
            .clone()
            .find(|body| body.name == *name)
            .unwrap()
            .position_m
    };
    let mut apart = place(&mesh.gears[1]) - place(&mesh.gears[0]);
    apart.z = 0.0;
    let radius = apart.norm() / (1.0 + stage.ratio);
    assert!((stage.pitch_radius_1_m - radius).abs() < 1e-9, "{stage:?}");
    let speed = TAU * mesh.frequency_hz / mesh.teeth[0] as f64 * radius;
    assert!((stage.pitch_line_speed_m_per_s - speed).abs() < 1e-9 * speed);
    let [tangential, radial, axial] = stage.forces_of_1_nm_n;
    assert!((tangential * radius - 1.0).abs() < 1e-9);
    let normal = tangential.hypot(radial).hypot(axial);
    let in_plane = 1.0 / mesh.base_radii_m[0];
    let base_helix_cos = in_plane / normal;
    assert!(
        base_helix_cos <= 1.0 + 1e-12 && (tangential.hypot(radial) / in_plane - 1.0).abs() < 1e-9
    );
    let mesh_over_single = stage.mesh_stiffness_n_per_m2 / stage.single_stiffness_n_per_m2;
    assert!((mesh_over_single - 0.75 * stage.contact_ratio - 0.25).abs() < 1e-12);
    assert!(stage.largest_sliding > 0.0 && stage.largest_sliding < 1.0);
}

/// The scenes that are shipped: those whose gears are gear files become systems, and the train turns at the speeds that
/// it states.
#[test]
fn shipped_scenes_are_built() {
    let mut built_ones = Vec::new();
    for entry in std::fs::read_dir(fe_models()).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        if !name.starts_with("dynamics_") {
            continue;
        }
        let SceneFile::System(scene) = SceneFile::read(&path).unwrap_or_else(|e| panic!("{e}"))
        else {
            panic!("{name} is a multibody scene");
        };
        // Models are made by the demo; without it there are none.
        let of_files = |gear: &std::path::PathBuf| gear.extension().is_some_and(|e| e == "toml");
        let (bodies, mut meshes) = (&scene.tables.body, scene.tables.gear_mesh.iter());
        let has_bevel_models = meshes.any(|mesh| mesh.bevel_models.is_some());
        if !has_bevel_models
            && bodies
                .iter()
                .all(|body| body.gear.as_ref().is_none_or(of_files))
        {
            let built = scene
                .load()
                .unwrap()
                .build()
                .unwrap_or_else(|e| panic!("{e}"));
            assert_labelled(&built);
            if name == "dynamics_two_stage.toml" {
                built
                    .meshes
                    .iter()
                    .for_each(|mesh| assert_stage(mesh, &built));
                assert!(
                    (spin(&built, "output wheel") * 60.0 / TAU
                        - 1500.0 * 27.0 / 61.0 * 31.0 / 71.0)
                        .abs()
                        < 1e-9
                );
                let frequencies = built
                    .meshes
                    .iter()
                    .map(|mesh| mesh.frequency_hz)
                    .collect::<Vec<_>>();
                assert!(
                    (frequencies[0] - 675.0).abs() < 1e-9
                        && (frequencies[1] - 31.0 * 25.0 * 27.0 / 61.0).abs() < 1e-9
                );
            }
            built_ones.push(name);
        }
    }
    built_ones.sort();
    assert_eq!(
        built_ones,
        [
            "dynamics_17_25.toml",
            "dynamics_17_25_steady.toml",
            "dynamics_17_25_teeth.toml",
            "dynamics_25_30.toml",
            "dynamics_34_50_teeth.toml",
            "dynamics_bevel_13_35.toml",
            "dynamics_bevel_13_35_dynamic.toml",
            "dynamics_bevel_13_35_linear.toml",
            "dynamics_bevel_13_35_surfaces.toml",
            "dynamics_bevel_20_20.toml",
            "dynamics_bevel_20_20_nodes.toml",
            "dynamics_bevel_20_20_nodes_steady.toml",
            "dynamics_bevel_20_20_slices.toml",
            "dynamics_bevel_31_36.toml",
            "dynamics_bevel_31_36_dynamic.toml",
            "dynamics_bevel_31_36_linear.toml",
            "dynamics_helical.toml",
            "dynamics_two_stage.toml"
        ]
    );
}

/// The scenes of the tutorial are read, and name the models that its commands make of the gear files beside them.
#[test]
fn the_scenes_of_the_tutorial_name_its_gears() {
    let folder = fe_models().join("first_pair");
    let model = |name: &str| {
        let gear = GearDefinition::read(&folder.join(name).with_extension("toml")).unwrap();
        (folder.join(name).with_extension("h5"), gear)
    };
    let [(pinion, first), (wheel, second)] = ["pinion", "wheel"].map(model);
    assert_eq!([first.tooth.teeth, second.tooth.teeth], [23, 40]);
    assert_eq!(first.gauges[0].name, "root");
    let SceneFile::Pair(pair) = SceneFile::read(&folder.join("pair.toml")).unwrap() else {
        panic!("pair.toml is a pair");
    };
    assert_eq!(pair.gears.map(|gear| gear.model), [pinion, wheel]);
    let SceneFile::System(drive) = SceneFile::read(&folder.join("drive.toml")).unwrap() else {
        panic!("drive.toml is a multibody scene");
    };
    let gears: Vec<_> = drive
        .tables
        .body
        .iter()
        .flat_map(|body| body.gear.clone())
        .collect();
    assert_eq!(gears.len(), 2);
}
