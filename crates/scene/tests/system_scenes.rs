//! Multibody scene files become the systems that they describe.
#![allow(clippy::unwrap_used, clippy::expect_used, missing_docs)]

mod common;

use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;

use common::*;
use gearmesh_dynamics::scheme::Params;
use gearmesh_dynamics::{Simulation, StaticParams, equilibrium};
use gearmesh_geometry::{GearDefinition, involute};
use gearmesh_scene::SceneFile;
use gearmesh_scene::system::{BuiltSystem, Run, SystemPlan, SystemScene, Variation};

fn body<'a>(built: &'a BuiltSystem, name: &str) -> &'a gearmesh_dynamics::Body {
    built
        .system
        .bodies()
        .iter()
        .find(|body| body.name == name)
        .unwrap()
}

fn spin(built: &BuiltSystem, name: &str) -> f64 {
    body(built, name).angular_velocity_rad_per_s.z
}

/// Names and kinds stand in the order of the system, so that a result can be labelled.
fn assert_labelled(built: &BuiltSystem) {
    let names: Vec<&str> = built.system.elements().collect();
    assert_eq!(
        names,
        built
            .elements
            .iter()
            .map(|part| &*part.name)
            .collect::<Vec<_>>()
    );
    let names: Vec<&str> = built
        .system
        .joints()
        .iter()
        .map(|joint| joint.name())
        .collect();
    assert_eq!(
        names,
        built
            .joints
            .iter()
            .map(|part| &*part.name)
            .collect::<Vec<_>>()
    );
    let names: Vec<&str> = built
        .system
        .bodies()
        .iter()
        .map(|body| &*body.name)
        .collect();
    assert_eq!(
        names,
        built
            .bodies
            .iter()
            .map(|body| &*body.name)
            .collect::<Vec<_>>()
    );
}

/// T = 2π √(J/(m g l))/AGM(1, cos θ₀/2), to the second order of the step.
#[test]
fn the_pendulum_swings_with_its_period() {
    let (mut a, mut g) = (1.0f64, 30f64.to_radians().cos());
    for _ in 0..8 {
        (a, g) = (0.5 * (a + g), (a * g).sqrt());
    }
    let period = TAU * (1.0f64 / (3.0 * 9.81 * 0.5)).sqrt() / a;
    let error = |step_s: f64| {
        let built = build(&text("scene_pendulum.toml")).unwrap();
        assert_labelled(&built);
        assert_eq!(built.system.mobility(), 1);
        let params = Params {
            rho_infinity: 1.0,
            ..Params::fixed(step_s)
        };
        let mut run = Simulation::new(built.system, params).unwrap();
        // It stands still on the other side after half a period: the spin changes its sign.
        let (mut half, mut last) = (0.0, 0.0);
        run.run(1.5, |step| {
            let spin = step.to.velocity[5];
            if last < 0.0 && spin >= 0.0 {
                half = step.to.time_s - step_s * spin / (spin - last);
                return ControlFlow::Break(());
            }
            last = spin;
            ControlFlow::Continue(())
        })
        .unwrap();
        2.0 * half / period - 1.0
    };
    let [coarse, fine] = [4e-3, 1e-3].map(error);
    // Seen: 2.4e-6 at a millisecond.
    assert!(
        (coarse / fine / 16.0 - 1.0).abs() < 0.1 && fine.abs() < 4e-6,
        "{coarse:e} {fine:e}"
    );
}

/// Speeds and angles that the scene leaves open: gear 2 turns at the ratio, and its teeth touch where the closed form says.
#[test]
fn gears_start_touching_at_the_right_speeds() {
    let scene = changed(
        &text("scene_two_wheels.toml"),
        "model = \"impact\"",
        "model = \"impact\"\nmicrogeometry = false",
    );
    let built = build(&scene).unwrap();
    assert_labelled(&built);
    let speed = -600.0 * TAU / 60.0;
    assert!(
        (spin(&built, "pinion") - speed).abs() < 1e-12
            && (spin(&built, "wheel") + speed).abs() < 1e-12
    );
    assert!((built.meshes[0].frequency_hz - 570.0).abs() < 1e-9);
    assert!(
        built
            .notes
            .iter()
            .any(|note| note.contains("`wheel` starts with 600.000000 rpm")),
        "{:?}",
        built.notes
    );
    let gear = GearDefinition::read(&fe_models().join("gear1.toml"))
        .unwrap()
        .profile;
    let alpha = (2.0 * gear.base_radius_m / 0.15).acos();
    // Half the angle of a tooth on the working pitch circle; right flanks touch on the line of centres when gear 1's tooth 0 stands turned
    // back by it, and gear 2's space in front of it.
    let half = gear.base_half_angle_rad - involute::involute_function(alpha);
    let expected = PI + half + half;
    let found = body(&built, "wheel").orientation.scaled_axis();
    assert!(found[0].hypot(found[1]) < 1e-15);
    let pitch = TAU / 57.0;
    let off = (found[2] - expected).rem_euclid(pitch);
    assert!(off.min(pitch - off) < 1e-11, "{found:?} {expected}");
    // At any orientation of the whole scene, and with gear 1 turned: the least gap is zero.
    let turned = changed(
        &scene,
        "name = \"pinion\"\n",
        "name = \"pinion\"\ncardan_deg = [0.0, 0.0, 1.7]\n",
    );
    let built = build(&turned).unwrap();
    let found = body(&built, "wheel").orientation.scaled_axis()[2];
    let off = (found - expected + 1.7f64.to_radians()).rem_euclid(pitch);
    assert!(off.min(pitch - off) < 1e-11, "{found} {expected}");
}

/// Stated angles stay, and the plan says how the teeth stand.
#[test]
fn stated_angles_stay() {
    let scene = changed(
        &text("scene_two_wheels.toml"),
        "position_mm = [150.0, 0.0, 0.0]",
        "position_mm = [150.0, 0.0, 0.0]\ncardan_deg = [0.0, 0.0, 3.0]",
    );
    let scene = changed(
        &scene,
        "[[body]]\nname = \"pinion\"",
        "[[body]]\nname = \"pinion\"\ncardan_deg = [0.0, 0.0, 0.0]",
    );
    let built = build(&scene).unwrap();
    assert!((body(&built, "wheel").orientation.scaled_axis()[2] - 3f64.to_radians()).abs() < 1e-15);
    assert!(
        built
            .notes
            .iter()
            .any(|note| note.contains("starts as the bodies stand")),
        "{:?}",
        built.notes
    );
}

const TRAIN: &str = r#"
title = "Train"
[run]
kind = "static"
[[body]]
name = "a"
gear = "gear1.toml"
mass_kg = 2.0
inertia_kg_m2 = [4e-3, 4e-3, 7e-3]
speed_rpm = -300.0
[[body]]
name = "b"
gear = "gear1.toml"
mass_kg = 2.0
inertia_kg_m2 = [4e-3, 4e-3, 7e-3]
[[body]]
name = "c"
gear = "gear1.toml"
mass_kg = 2.0
inertia_kg_m2 = [4e-3, 4e-3, 7e-3]
[[body]]
name = "d"
gear = "gear1.toml"
mass_kg = 2.0
inertia_kg_m2 = [4e-3, 4e-3, 7e-3]
position_mm = [300.0, 0.0, 100.0]
[[joint]]
name = "axle a"
kind = "revolute"
body_2 = "a"
[[joint]]
name = "axle d"
kind = "revolute"
body_2 = "d"
[[shaft]]
name = "lay"
kind = "beam"
origin_mm = [150.0, 0.0, 0.0]
stations_mm = [-50.0, 0.0, 100.0, 150.0]
outer_diameters_mm = [40.0, 50.0, 40.0]
inner_diameters_mm = [0.0, 20.0, 0.0]
density_kg_per_m3 = 7850.0
young_GPa = 206.0
poisson = 0.3
[[shaft.part]]
station = 3
mass_kg = 1.5
inertia_kg_m2 = [1e-3, 1e-3, 2e-3]
[[shaft.seat]]
station = 1
body = "b"
[[shaft.seat]]
station = 2
body = "c"
[[bearing]]
name = "left"
kind = "linear"
body_2 = "lay/0"
radial_stiffness_N_per_mm = 1e5
axial_stiffness_N_per_mm = 1e5
[[bearing]]
name = "right"
kind = "linear"
body_2 = "lay/3"
radial_stiffness_N_per_mm = 1e5
[[gear_mesh]]
name = "first"
gear_1 = "a"
gear_2 = "b"
model = "analytic"
slices = 3
friction = { model = "coulomb", dynamic_coefficient = 0.05 }
damping = { kind = "viscous", damping_N_s_per_mm = 1.0, full_depth_um = 1.0 }
[[gear_mesh]]
name = "second"
gear_1 = "c"
gear_2 = "d"
model = "iso6336"
flanks = "left"
microgeometry = false
stiffness_amplitude = 0.1
"#;

/// A lay shaft passes the speed on, its mass is all there, and the second mesh drives on left flanks because its gear 1 turns the other way.
#[test]
fn a_train_over_a_beam_shaft() {
    let built = build(TRAIN).unwrap();
    assert_labelled(&built);
    let names: Vec<&str> = built.bodies.iter().map(|body| &*body.name).collect();
    assert_eq!(names, ["a", "b", "c", "d", "lay/0", "lay/3"]);
    let omega = 300.0 * TAU / 60.0;
    for (name, sign) in [
        ("a", -1.0),
        ("b", 1.0),
        ("lay/0", 1.0),
        ("lay/3", 1.0),
        ("c", 1.0),
        ("d", -1.0),
    ] {
        assert!((spin(&built, name) - sign * omega).abs() < 1e-12, "{name}");
    }
    let tube = |outer: f64, inner: f64, length: f64| {
        7850.0 * 0.25 * PI * (outer * outer - inner * inner) * length
    };
    let steel = tube(0.04, 0.0, 0.1) + tube(0.05, 0.02, 0.1);
    let total: f64 = built.system.bodies().iter().map(|body| body.mass_kg).sum();
    assert!((total - (8.0 + 1.5 + steel)).abs() < 1e-12);
    let polar = |outer: f64, inner: f64, length: f64| {
        tube(outer, inner, length) * (outer * outer + inner * inner) / 8.0
    };
    let polar_all = polar(0.04, 0.0, 0.1) + polar(0.05, 0.02, 0.1);
    let total: f64 = built
        .system
        .bodies()
        .iter()
        .map(|body| body.inertia_kg_m2[(2, 2)])
        .sum();
    assert!((total - (4.0 * 7e-3 + 2e-3 + polar_all)).abs() < 1e-15);
    let seat = body(&built, "c");
    assert!((seat.position_m - nalgebra::Vector3::new(0.15, 0.0, 0.1)).norm() < 1e-15);
    let touching: Vec<&String> = built
        .notes
        .iter()
        .filter(|note| note.contains("touch"))
        .collect();
    assert!(
        touching[0].contains("`b`") && touching[0].contains("right flanks of mesh `first`"),
        "{touching:?}"
    );
    assert!(
        touching[1].contains("`d`") && touching[1].contains("left flanks of mesh `second`"),
        "{touching:?}"
    );
    let effect = |name: &str| {
        built
            .effects
            .iter()
            .find(|effect| effect.name == name)
            .unwrap()
            .computed
            .clone()
    };
    assert_eq!(
        effect("mesh `first`: friction").as_deref(),
        Some("`coulomb`, regularised")
    );
    assert_eq!(effect("mesh `second`: friction"), None);
    assert_eq!(effect("weight"), None);
}

/// Twist of a stepped shaft under a torque: Σ T L/(G I_t).
#[test]
fn a_beam_shaft_twists_as_the_closed_form_says() {
    let scene = r#"
        title = "Torsion bar"
        [run]
        kind = "static"
        [[body]]
        name = "disc"
        mass_kg = 1.0
        inertia_kg_m2 = [1e-3, 1e-3, 2e-3]
        [[shaft]]
        name = "bar"
        kind = "beam"
        origin_mm = [0.0, 0.0, 0.0]
        axis = [1.0, 0.0, 0.0]
        stations_mm = [0.0, 200.0, 500.0]
        outer_diameters_mm = [20.0, 16.0]
        density_kg_per_m3 = 7850.0
        young_GPa = 210.0
        poisson = 0.3
        [[shaft.seat]]
        station = 2
        body = "disc"
        [[joint]]
        name = "wall"
        kind = "fixed"
        body_2 = "bar/0"
        [[load]]
        body = "disc"
        torque_Nm = 40.0
    "#;
    let built = build(scene).unwrap();
    let mut system = built.system;
    let start = system.start().clone();
    let found = equilibrium(&mut system, &start, &StaticParams::default()).unwrap();
    let turned = (start.orientations[0].inverse() * found.state.orientations[0]).scaled_axis();
    let shear = 210e9 / 2.6;
    let twist: f64 = [(0.02f64, 0.2), (0.016, 0.3)]
        .iter()
        .map(|(d, l)| 40.0 * l / (shear * PI / 32.0 * d.powi(4)))
        .sum();
    assert!((turned[2] / twist - 1.0).abs() < 1e-9, "{turned:?} {twist}");
    let half = build(&scene.replace(
        "torque_Nm = 40.0",
        "torque_Nm = { sum = [20.0, { sine = { amplitude = 3.0, frequency_Hz = 5.0 } }] }",
    ))
    .unwrap();
    let found = equilibrium(&mut { half.system }, &start, &StaticParams::default()).unwrap();
    let turned = (start.orientations[0].inverse() * found.state.orientations[0]).scaled_axis();
    assert!((turned[2] / (0.5 * twist) - 1.0).abs() < 1e-9);
}

/// Every connection and function of time in one scene.
#[test]
fn every_table_is_read() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(
        folder.path().join("torque.csv"),
        "# rig\ntime_s,torque_Nm,other\n0,1,7\n0.5,3,8\n\n1,2,9\n",
    )
    .unwrap();
    let scene = r#"
        title = "All"
        gravity_m_per_s2 = [0.0, 0.0, -9.81]
        [run]
        kind = "eigen"
        settle_s = 0.1
        load_factors = [0.5, 1.0]
        [solver]
        start = "equilibrium"
        adaptive = { largest_step_s = 1e-3, translation_tolerance_um = 1.0, rotation_tolerance_urad = 10.0 }
        [output]
        interval_s = 1e-3
        bodies = ["a"]
        joints = ["slide"]
        elements = ["line", "weight of a"]
        [[body]]
        name = "a"
        mass_kg = 2.0
        inertia_kg_m2 = [0.1, 0.2, 0.25, 0.01, 0.0, -0.02]
        centre_of_mass_mm = [1.0, 2.0, 3.0]
        velocity_mm_per_s = [5.0, 0.0, 0.0]
        angular_velocity_rad_per_s = [0.1, 0.2, 0.3]
        [[body]]
        name = "b"
        mass_kg = 1.0
        inertia_kg_m2 = [0.1, 0.1, 0.1]
        position_mm = [100.0, 0.0, 0.0]
        cardan_deg = [10.0, 90.0]
        [[body]]
        name = "c"
        mass_kg = 1.0
        inertia_kg_m2 = [0.1, 0.1, 0.1]
        position_mm = [0.0, 300.0, 0.0]
        [[joint]]
        name = "slide"
        kind = "cylindrical"
        body_1 = "a"
        body_2 = "b"
        axis = [1.0, 0.0, 0.0]
        [[joint]]
        name = "ball"
        kind = "spherical"
        body_1 = "b"
        body_2 = "c"
        at_mm = [100.0, 300.0, 0.0]
        [[motion]]
        name = "push"
        joint = "slide"
        speed_mm_per_s = { product = [{ linear = { slope_per_s = 2.0 } }, { step = { start_s = 0.0, from = 0.0, end_s = 1.0, to = 1.0 } }] }
        [[load]]
        name = "measured"
        body = "c"
        torque_Nm = { table = { file = "torque.csv", column = "torque_Nm" } }
        along = [0.0, 1.0, 0.0]
        [[load]]
        body = "c"
        force_N = { table = { file = "torque.csv", column = "other", interpolation = "linear" } }
        along = [0.0, 0.0, 2.0]
        axes = "body"
        at_mm = [0.0, 10.0, 0.0]
        [[spring]]
        name = "line"
        body_2 = "a"
        at_1_mm = [0.0, 0.0, 50.0]
        stiffness_N_per_mm = 10.0
        [[torsion_spring]]
        name = "twist"
        body_1 = "a"
        body_2 = "b"
        axis = [1.0, 0.0, 0.0]
        stiffness_Nm_per_rad = 5.0
        free_angle_deg = 3.0
        [[bushing]]
        name = "rubber"
        body_2 = "a"
        stiffness_N_per_mm = [1.0, 1.0, 2.0]
        stiffness_Nm_per_rad = [1.0, 1.0, 2.0]
        [[bushing]]
        name = "matrix"
        body_2 = "c"
        stiffness_matrix_SI = [[2.0, 0.0, 0.0, 0.0, 1.0, 0.0], [0.0, 2.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 2.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 2.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0, 2.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0, 2.0]]
        [[bearing]]
        name = "ring"
        kind = "linear"
        body_2 = "c"
        radial_stiffness_N_per_mm = 1.0
    "#;
    let refused = build_in(scene, folder.path()).err().unwrap().to_string();
    assert!(
        refused.contains("a speed that is a product of functions cannot be prescribed"),
        "{refused}"
    );
    let scene = changed(scene, "speed_mm_per_s = {", "position_mm = {");
    let built = build_in(&scene, folder.path()).unwrap();
    assert_labelled(&built);
    let kinds: Vec<&str> = built.elements.iter().map(|part| part.kind).collect();
    assert_eq!(
        kinds,
        [
            "load",
            "load",
            "spring",
            "torsion spring",
            "bushing",
            "bushing",
            "linear bearing",
            "weight",
            "weight",
            "weight"
        ]
    );
    assert_eq!(built.joints[1].bodies, ["b", "c"]);
    let a = body(&built, "a");
    assert_eq!(a.inertia_kg_m2[(1, 0)], 0.01);
    assert_eq!(a.inertia_kg_m2[(2, 1)], -0.02);
    assert!((a.velocity_m_per_s[0] - 5e-3).abs() < 1e-18);
}

/// A series of systems from one scene: other motions, other loads.
#[test]
fn systems_can_be_varied() {
    use gearmesh_dynamics::{Motion, TimeFunction};
    let document =
        gearmesh_geometry::input::InputDocument::new("scene.toml", text("scene_two_wheels.toml"));
    let loaded = SystemScene::from_document(document, &fe_models())
        .unwrap()
        .load()
        .unwrap();
    let speed = Motion::Speed(TimeFunction::Constant(-5.0));
    let varied = loaded
        .build_varied(&Variation {
            motions: vec![("drive".to_string(), speed)],
            load_factor: 0.5,
        })
        .unwrap();
    assert!(
        (spin(&varied, "pinion") + 5.0).abs() < 1e-15
            && (spin(&varied, "wheel") - 5.0).abs() < 1e-15
    );
}

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
                "effect     mesh `mesh`: friction: not computed",
                "effect     mesh `mesh`: damping: STEP of the depth",
                "effect     weight: not computed",
                "note       body `wheel` is turned so that the right flanks of mesh `mesh` touch",
                "25000 steps",
            ],
        ),
    ] {
        let SceneFile::System(scene) = SceneFile::read(&fe_models().join(name)).unwrap() else {
            panic!("{name} is a multibody scene");
        };
        let loaded = scene.load().unwrap();
        assert!(matches!(loaded.scene.run, Run::Transient { .. }));
        let plan = SystemPlan::new(&loaded.scene, loaded.build().unwrap()).unwrap();
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

/// The scenes that are shipped: those whose gears are gear files become systems, and the train turns at the speeds that it states.
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
        if scene
            .tables
            .body
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
            "dynamics_25_30.toml",
            "dynamics_two_stage.toml"
        ]
    );
}
