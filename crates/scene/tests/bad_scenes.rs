//! Wrong multibody scenes: the whole complaint that a person reads, with file, line and key.
#![allow(clippy::unwrap_used, clippy::expect_used, missing_docs)]

mod common;

use common::*;
use gearmesh_geometry::input::InputDocument;
use gearmesh_scene::SceneFile;
use gearmesh_scene::system::{SystemPlan, SystemScene};

/// The scene of two wheels in which `from` became `to` is refused at the line of `at` with all `parts`.
#[track_caller]
fn refused((from, to): (&str, &str), at: &str, parts: &[&str]) {
    let scene = changed(&text("scene_two_wheels.toml"), from, to);
    let complaint = build(&scene)
        .err()
        .unwrap_or_else(|| panic!("accepted:\n{scene}"))
        .to_string();
    let place = format!("scene.toml:{}: ", line_of(&scene, at));
    for part in [place.as_str()].iter().chain(parts) {
        assert!(complaint.contains(part), "`{part}` is not in\n{complaint}");
    }
}

#[test]
fn unknown_names_are_answered_with_the_nearest() {
    refused(
        ("body = \"wheel\"", "body = \"weel\""),
        "body = \"weel\"",
        &[
            "load.0.body: there is no body `weel`; did you mean `wheel`? the scene has `ground`, `pinion`, `wheel`",
        ],
    );
    refused(
        ("gear_1 = \"pinion\"", "gear_1 = \"sun\""),
        "gear_1 = \"sun\"",
        &["gear_mesh.0.gear_1: there is no body `sun`; the scene has"],
    );
    refused(
        ("joint = \"axle 1\"", "joint = \"axel 1\""),
        "joint = \"axel 1\"",
        &["motion.0.joint: there is no joint `axel 1`; did you mean `axle 1`?"],
    );
    refused(
        (
            "interval_s = 2e-5",
            "interval_s = 2e-5\nelements = [\"mash\"]",
        ),
        "elements",
        &["output.elements.0: there is no force element `mash`; did you mean `mesh`?"],
    );
    refused(
        ("name = \"axle 2\"", "name = \"axle 1\""),
        "name = \"axle 1\"\nkind = \"revolute\"\nbody_2 = \"wheel\"",
        &["joint.1.name: `axle 1` is the name of another joint or motion"],
    );
}

#[test]
fn keys_of_another_kind_are_refused() {
    refused(
        ("exponent = 1.5", "exponent = 1.5\nlocal = \"calibrated\""),
        "local",
        &["gear_mesh.0.local: is not used by model = \"impact\", only by \"hybrid\"; remove it"],
    );
    refused(
        (
            "model = \"impact\"",
            "model = \"iso6336\"\nmicrogeometry = false",
        ),
        "stiffness_N_per_mm_e",
        &[
            "gear_mesh.0.stiffness_N_per_mm_e: is not used by model = \"iso6336\", only by \"impact\"",
        ],
    );
    refused(
        ("end_s = 0.05", "end_s = 0.05\nspeeds = 7"),
        "speeds",
        &["run.speeds: is not used by kind = \"transient\", only by \"speed-sweep\""],
    );
    refused(
        ("kind = \"transient\"\nend_s = 0.05", "kind = \"static\""),
        "step_s",
        &["solver.step_s: is not used by run.kind = \"static\""],
    );
    refused(
        (
            "kind = \"revolute\"\nbody_2 = \"wheel\"",
            "kind = \"fixed\"\naxis = [0, 0, 1]\nbody_2 = \"wheel\"",
        ),
        "axis",
        &["joint.1.axis: is not used by kind = \"fixed\""],
    );
    refused(
        ("exponent = 1.5", "exponent = 1.5\ncolour = 3"),
        "colour",
        &["unknown field `colour`", "`stiffness_N_per_mm_e`"],
    );
    refused(
        (
            "position_mm = [150.0, 0.0, 0.0]",
            "position_m = [0.15, 0.0, 0.0]",
        ),
        "position_m ",
        &["did you mean `position_mm`? The unit is part of the key"],
    );
}

#[test]
fn values_out_of_range_are_refused() {
    refused(
        ("exponent = 1.5", "exponent = 0.5"),
        "exponent",
        &["gear_mesh.0.exponent: found 0.5, allowed is 1 to 5"],
    );
    refused(
        ("exponent = 1.5\n", ""),
        "[[gear_mesh]]",
        &["gear_mesh.0.exponent: missing; the unit of stiffness_N_per_mm_e, N/mm^e, needs it"],
    );
    refused(
        ("full_damping_depth_um = 10.0", ""),
        "[[gear_mesh]]",
        &["gear_mesh.0.full_damping_depth_um: missing; damping_N_s_per_mm needs it"],
    );
    refused(
        ("step_s = 2e-6", "step_s = -2e-6"),
        "step_s",
        &["solver.step_s: found -0.000002, allowed is more than 0"],
    );
    refused(
        ("step_s = 2e-6", "step_s = 2.0"),
        "step_s",
        &["solver.step_s: found 2, longer than the run of 0.05 s"],
    );
    refused(
        ("step_s = 2e-6", ""),
        "[solver]",
        &["solver.step_s: missing; give a fixed step, or a table [solver.adaptive]"],
    );
    refused(
        ("interval_s = 2e-5", ""),
        "[output]",
        &["output.interval_s: missing"],
    );
    refused(
        ("to = -100.0", "to = nan"),
        "torque_Nm",
        &["STEP runs from 0 s to 0.01 s", "all numbers finite"],
    );
    refused(
        ("end_s = 0.01", "end_s = 0.0"),
        "torque_Nm",
        &["the end must come after the start"],
    );
    refused(
        ("speed_rpm = -600.0", "speed_rpm = inf"),
        "speed_rpm",
        &["motion.0.speed_rpm: found inf"],
    );
    refused(
        ("speed_rpm = -600.0", "speed_rpm = \"fast\""),
        "speed_rpm",
        &["a number, or a table with one of linear, step, sine, table, sum, product"],
    );
    refused(
        ("speed_rpm = -600.0", ""),
        "[[motion]]",
        &["a motion states exactly one of angle_deg, speed_rpm, position_mm, speed_mm_per_s"],
    );
}

#[test]
fn bodies_that_cannot_be_are_refused() {
    let pendulum = text("scene_pendulum.toml");
    for (from, to, at, part) in [
        (
            "[0.25, 1e-3, 0.25]",
            "[0.25, -1e-3, 0.25]",
            "inertia_kg_m2",
            "body.0.inertia_kg_m2: body `rod`: a moment of inertia is zero or negative",
        ),
        (
            "[0.25, 1e-3, 0.25]",
            "[0.25, 1e-3, 0.5]",
            "inertia_kg_m2",
            "breaks the triangle inequality",
        ),
        (
            "[0.25, 1e-3, 0.25]",
            "[0.25, 1e-3]",
            "inertia_kg_m2",
            "body.0.inertia_kg_m2: found 2 numbers, allowed are 3 or 6",
        ),
        (
            "mass_kg = 3.0",
            "mass_kg = 0.0",
            "mass_kg",
            "body.0.mass_kg: body `rod`: mass in kg is 0; it must be positive and finite",
        ),
        (
            "mass_kg = 3.0",
            "",
            "[[body]]",
            "body.0.mass_kg: missing; a body without gear needs it",
        ),
        (
            "cardan_deg = [0.0, 0.0, 60.0]",
            "cardan_deg = [60.0]",
            "cardan_deg",
            "body.0.cardan_deg: found 1 angles, allowed are 3",
        ),
        (
            "name = \"rod\"",
            "name = \"ground\"",
            "name = \"ground\"",
            "which is the world",
        ),
        (
            "body_2 = \"rod\"",
            "body_1 = \"rod\"\nbody_2 = \"rod\"",
            "body_2",
            "joint.0.body_2: found `rod`, the same as body_1",
        ),
        (
            "cardan_deg",
            "gear = \"nowhere.toml\"\ncardan_deg",
            "gear",
            "body.0.gear: the gear file",
        ),
        (
            "cardan_deg",
            "gear = \"nowhere.h5\"\ncardan_deg",
            "gear",
            "make it with `gearmesh reduce GEAR.toml -o",
        ),
        (
            "cardan_deg",
            "flexibility = \"reduced\"\ncardan_deg",
            "flexibility",
            "is stated for a body that is no gear",
        ),
    ] {
        let scene = changed(&pendulum, from, to);
        let complaint = build(&scene)
            .err()
            .unwrap_or_else(|| panic!("accepted:\n{scene}"))
            .to_string();
        let place = format!("scene.toml:{}: ", line_of(&scene, at));
        assert!(
            complaint.contains(&place) && complaint.contains(part),
            "`{place}{part}` is not in\n{complaint}"
        );
    }
    let folder = tempfile::tempdir().unwrap();
    let gear = changed(
        &text("gear1.toml"),
        "density_kg_per_m3 = 7850.0  # for the dynamics\n",
        "",
    );
    std::fs::write(folder.path().join("gear1.toml"), gear).unwrap();
    let complaint = build_in(&text("scene_two_wheels.toml"), folder.path())
        .err()
        .unwrap()
        .to_string();
    assert!(
        complaint.contains("body.0.gear: ")
            && complaint.contains("gear1.toml has no density, hence no mass: give"),
        "{complaint}"
    );
    let modal = "gear = \"gear1.toml\"\nposition_mm";
    refused(
        (
            modal,
            "gear = \"gear1.toml\"\nflexibility = \"modal\"\nposition_mm",
        ),
        "flexibility",
        &["body.1.flexibility: is \"modal\", which needs a reduced gear (.h5) with modes"],
    );
    refused(
        (
            modal,
            "gear = \"gear1.toml\"\nmodal_damping_ratio = 0.01\nposition_mm",
        ),
        "modal_damping_ratio",
        &[
            "body.1.modal_damping_ratio: is not used where flexibility is not given, only by \"modal\"",
        ],
    );
    refused(
        (
            modal,
            "gear = \"gear1.toml\"\nflexibility = \"reduced\"\nposition_mm",
        ),
        "flexibility",
        &["body.1.flexibility: is \"reduced\", which hybrid meshes can feel only"],
    );
}

#[test]
fn gears_that_do_not_fit_are_refused() {
    refused(
        (
            "position_mm = [150.0, 0.0, 0.0]",
            "position_mm = [157.0, 0.0, 0.0]",
        ),
        "gear_2 = ",
        &[
            "gear_mesh.0.gear_2: at the centre distance of 157.0000 mm at the start: the transverse contact ratio",
        ],
    );
    refused(
        (
            "position_mm = [150.0, 0.0, 0.0]",
            "position_mm = [120.0, 0.0, 0.0]",
        ),
        "gear_2 = ",
        &["below the sum of the base radii"],
    );
    refused(
        (
            "position_mm = [150.0, 0.0, 0.0]",
            "position_mm = [150.0, 0.0, 30.0]",
        ),
        "gear_2 = ",
        &["the gears stand side by side: 30.000 mm apart along the axis"],
    );
    refused(
        (
            "position_mm = [150.0, 0.0, 0.0]",
            "position_mm = [150.0, 0.0, 0.0]\ncardan_deg = [2.0, 0.0]",
        ),
        "gear_2 = ",
        &["the gear axes stand 34.91 mrad from parallel"],
    );
    refused(
        ("gear_2 = \"wheel\"", "gear_2 = \"pinion\""),
        "gear_2 = ",
        &["found `pinion`, the same as gear_1"],
    );
    let folder = tempfile::tempdir().unwrap();
    let gear = text("gear1.toml");
    std::fs::write(folder.path().join("gear1.toml"), &gear).unwrap();
    for (from, to, part) in [
        (
            "module_mm = 2.6",
            "module_mm = 2.7",
            "the gears do not fit: module 2.6 and 2.7 mm",
        ),
        (
            "pressure_angle_deg = 20.0",
            "pressure_angle_deg = 22.0",
            "the gears do not fit: pressure angle 20 and 22 deg",
        ),
    ] {
        // The crowning's diameter must stay on the flank.
        let other = changed(
            &changed(&gear, from, to),
            "[microgeometry]\nprofile_crowning_um = 10.0\nprofile_crowning_diameter_mm = 150.0\n",
            "",
        );
        std::fs::write(folder.path().join("other.toml"), other).unwrap();
        let scene = changed(
            &text("scene_two_wheels.toml"),
            "name = \"wheel\"\ngear = \"gear1.toml\"",
            "name = \"wheel\"\ngear = \"other.toml\"",
        );
        let complaint = build_in(&scene, folder.path()).err().unwrap().to_string();
        assert!(complaint.contains(part), "{complaint}");
    }
}

#[test]
fn meshes_that_cannot_be_are_refused() {
    let twice = "full_damping_depth_um = 10.0\n[[gear_mesh]]\nname = \"again\"\ngear_1 = \"wheel\"\ngear_2 = \"pinion\"\nmodel = \"kinematic\"\nmicrogeometry = false\n";
    refused(
        ("full_damping_depth_um = 10.0", twice),
        "gear_2 = \"pinion\"",
        &["gear_mesh.1.gear_2: `wheel` and `pinion` are in mesh already in `mesh`"],
    );
    let plain = "model = \"impact\"\nstiffness_N_per_mm_e = 1e6\nexponent = 1.5\ndamping_N_s_per_mm = 1e2\nfull_damping_depth_um = 10.0";
    refused(
        (plain, "model = \"hybrid\""),
        "gear_1 = ",
        &["gear_mesh.0.gear_1: model = \"hybrid\" needs reduced gears (.h5), found"],
    );
    refused(
        (plain, "model = \"iso6336\""),
        "[[gear_mesh]]",
        &[
            "gear_mesh.0.microgeometry: the gear of",
            "set microgeometry = false to leave it out",
        ],
    );
    refused(
        (
            plain,
            "model = \"kinematic\"\nmicrogeometry = false\nflanks = \"right\"",
        ),
        "flanks",
        &["is not used by model = \"kinematic\", only by"],
    );
    refused(
        (
            "exponent = 1.5",
            "exponent = 1.5\nerrors_2 = [{ kind = \"broken-tooth\", tooth = 57, above_radius_mm = 75.0 }]",
        ),
        "errors_2",
        &["gear_mesh.0.errors_2.0: broken tooth: there is no tooth 57; the gear has teeth 0 to 56"],
    );
    refused(
        (
            "exponent = 1.5",
            "exponent = 1.5\nerrors_1 = [{ kind = \"pitch\", side = \"right\", removed_um = [1.0, 2.0] }]",
        ),
        "errors_1",
        &["pitch errors: the list has 2 entries, 57 are needed"],
    );
    refused(
        (
            "exponent = 1.5",
            "exponent = 1.5\nerrors_1 = [{ kind = \"spall\", tooth = 3 }]",
        ),
        "errors_1",
        &["gear_mesh.0.errors_1.0.side: missing"],
    );
    refused(
        (
            "exponent = 1.5",
            "exponent = 1.5\nerrors_1 = [{ kind = \"spal\", tooth = 3 }]",
        ),
        "errors_1",
        &["unknown variant `spal`", "`spall`"],
    );
    refused(
        (
            "exponent = 1.5",
            "exponent = 1.5\nfriction = { model = \"coulomb\", static_coefficient = 0.1, dynamic_coefficient = 0.2 }",
        ),
        "friction",
        &["the static coefficient is 0.1; it must be at least the dynamic coefficient"],
    );
    refused(
        (
            "[[gear_mesh]]",
            "[[gauge]]\nbody = \"wheel\"\nnames = [\"t0\"]\n[[gear_mesh]]",
        ),
        "body = \"wheel\"\nnames",
        &["gauge.0.body: `wheel` is no reduced gear (.h5)"],
    );
}

/// A wheel that is welded cannot stand 5 degrees off.
#[test]
fn contradictory_joints_are_named() {
    let welded = "[[joint]]\nname = \"welded\"\nkind = \"fixed\"\nbody_2 = \"pinion\"\n[[motion]]";
    let scene = changed(&text("scene_two_wheels.toml"), "[[motion]]", welded);
    let scene = changed(&scene, "speed_rpm = -600.0", "angle_deg = 5.0");
    let complaint = build(&scene).err().unwrap().to_string();
    let place = format!("scene.toml:{}: motion.0: ", line_of(&scene, "[[motion]]"));
    for part in [
        place.as_str(),
        "contradict each other at t = 0 s",
        "\"drive\"",
        "\"welded\"",
    ] {
        assert!(complaint.contains(part), "`{part}` is not in\n{complaint}");
    }
}

/// A wheel held fixed is driven, too: places fit at the start, speeds do not, and the plan names both.
#[test]
fn contradictory_speeds_are_named() {
    let scene = changed(
        &text("scene_two_wheels.toml"),
        "[[motion]]",
        "[[joint]]\nname = \"welded\"\nkind = \"fixed\"\nbody_2 = \"pinion\"\n[[motion]]",
    );
    let document = InputDocument::new("scene.toml", &*scene);
    let loaded = SystemScene::from_document(document, &fe_models())
        .unwrap()
        .load()
        .unwrap();
    let complaint = SystemPlan::new(&loaded.scene, loaded.build().unwrap())
        .unwrap_err()
        .to_string();
    assert!(
        complaint.contains("contradict each other")
            && complaint.contains("`welded`") | complaint.contains("\"welded\""),
        "{complaint}"
    );
}

#[test]
fn redundant_joints_are_reported_and_solved() {
    let scene = changed(
        &text("scene_pendulum.toml"),
        "[[joint]]",
        "[[joint]]\nname = \"guide\"\nkind = \"planar\"\nbody_2 = \"rod\"\n[[joint]]",
    );
    let document = InputDocument::new("scene.toml", &*scene);
    let loaded = SystemScene::from_document(document, &fe_models())
        .unwrap()
        .load()
        .unwrap();
    let built = loaded.build().unwrap();
    assert_eq!(built.system.mobility(), 1);
    let note = built
        .notes
        .iter()
        .find(|note| note.contains("follow from"))
        .unwrap();
    assert!(
        note.starts_with("joint `hinge`: 3 of its equations follow from `guide`"),
        "{note}"
    );
    assert!(SystemPlan::new(&loaded.scene, built).is_ok());
}

#[test]
fn tables_that_do_not_increase_are_refused_in_their_file() {
    let folder = tempfile::tempdir().unwrap();
    let scene = changed(
        &text("scene_pendulum.toml"),
        "[[joint]]",
        "[[load]]\nbody = \"rod\"\ntorque_Nm = { table = { file = \"rig.csv\", column = \"torque_Nm\" } }\n[[joint]]",
    );
    for (table, expected) in [
        (
            "time_s,torque_Nm\n0,1\n# pause\n0.2,3\n0.2,4\n",
            "rig.csv:5: time_s: found 0.2 after 0.2; it must increase from row to row",
        ),
        (
            "time_s,torque_Nm\n0,1\n0.2,x\n",
            "rig.csv:3: torque_Nm: found 'x', allowed is a finite number",
        ),
        (
            "time_s,torque_Nm\n0,1\n0.2,3,4\n",
            "rig.csv:3: 3 fields; the head has 2",
        ),
        (
            "time_s,force_N\n0,1\n0.2,3\n",
            "rig.csv:1: torque_Nm: there is no such column; the file has time_s, force_N",
        ),
        (
            "time_s,torque_Nm\n0,1\n",
            "rig.csv:1: 1 rows of numbers; at least 2 are needed",
        ),
        ("", "rig.csv: is empty"),
    ] {
        std::fs::write(folder.path().join("rig.csv"), table).unwrap();
        let complaint = build_in(&scene, folder.path()).err().unwrap().to_string();
        assert!(
            complaint.contains(expected),
            "`{expected}` is not in\n{complaint}"
        );
    }
    std::fs::remove_file(folder.path().join("rig.csv")).unwrap();
    let complaint = build_in(&scene, folder.path()).err().unwrap().to_string();
    assert!(
        complaint.contains("rig.csv: cannot read the file"),
        "{complaint}"
    );
}

/// A step far beyond the frequency of a stiff, swinging spring is refused with advice, at the solver's table.
#[test]
fn a_step_that_is_too_large_is_refused_with_advice() {
    let scene = changed(
        &text("scene_pendulum.toml"),
        "step_s = 1e-3",
        "step_s = 0.5",
    );
    let scene = changed(
        &scene,
        "mass_kg = 3.0",
        "angular_velocity_rad_per_s = [0.0, 0.0, 90.0]\nmass_kg = 3.0",
    );
    let scene = changed(
        &scene,
        "[[joint]]",
        "[[spring]]\nname = \"stiff\"\nbody_2 = \"rod\"\nat_1_mm = [100.0, 700.0, 0.0]\nstiffness_N_per_mm = 1e6\n[[joint]]",
    );
    let document = InputDocument::new("scene.toml", &*scene);
    let loaded = SystemScene::from_document(document, &fe_models())
        .unwrap()
        .load()
        .unwrap();
    let complaint = SystemPlan::new(&loaded.scene, loaded.build().unwrap())
        .unwrap_err()
        .to_string();
    let place = format!(
        "scene.toml:{}: solver: no convergence at t = ",
        line_of(&scene, "[solver]")
    );
    assert!(
        complaint.starts_with(&place)
            && complaint.contains("take a tenth of it, or an adaptive step"),
        "{complaint}"
    );
}

#[test]
fn files_that_are_no_scene_are_told_apart() {
    let kind = |text: &str| {
        SceneFile::from_document(InputDocument::new("f.toml", text), &fe_models())
            .unwrap_err()
            .to_string()
    };
    assert!(
        kind(&text("gear1.toml")).contains("this is a gear file; a scene has [pair] or [[body]]")
    );
    assert!(kind("title = \"x\"\n").contains("f.toml: no scene: it has neither [pair]"));
    assert!(
        kind("title = \"x\"\n[pair]\n[[body]]\n").contains("f.toml:3: body: a scene has [pair]")
    );
    assert!(
        kind("title = \"x\"\nbody = []\n[run]\nkind = \"static\"\n")
            .contains("f.toml:2: body: is empty")
    );
    let pair = text("pair_a.toml");
    let document = InputDocument::new("p.toml", pair);
    assert!(matches!(
        SceneFile::from_document(document, &fe_models()).unwrap(),
        SceneFile::Pair(_)
    ));
}
