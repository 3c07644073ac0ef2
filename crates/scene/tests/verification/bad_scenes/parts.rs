//! Bodies, gears and meshes that cannot be.

use crate::bad_scenes::refused;
use crate::common::*;

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
        &["body.1.flexibility: is \"reduced\", which its meshes cannot feel"],
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
    let twice = "full_damping_depth_um = 10.0\n[[gear_mesh]]\nname = \"again\"\ngear_1 = \"wheel\"\ngear_2 = \"pinion\"\nmodel = { kind = \"kinematic\" }\nmicrogeometry = false\n";
    refused(
        ("full_damping_depth_um = 10.0", twice),
        "gear_2 = \"pinion\"",
        &["gear_mesh.1.gear_2: `wheel` and `pinion` are in mesh already in `mesh`"],
    );
    let plain = "kind = \"impact\"\nstiffness_N_per_mm_e = 1e6\nexponent = 1.5\ndamping_N_s_per_mm = 1e2\nfull_damping_depth_um = 10.0";
    refused(
        (plain, "kind = \"hybrid\""),
        "gear_1 = ",
        &["gear_mesh.0.gear_1: kind = \"hybrid\" needs reduced gears (.h5), found"],
    );
    refused(
        (plain, "kind = \"iso6336\""),
        "[[gear_mesh]]",
        &[
            "gear_mesh.0.microgeometry: the gear of",
            "set microgeometry = false to leave it out",
        ],
    );
    refused(
        (
            plain,
            "kind = \"kinematic\"\n[gear_mesh.teeth]\nflanks = \"right\"",
        ),
        "[gear_mesh.teeth]",
        &["gear_mesh.0.teeth: is not used by kind = \"kinematic\", which knows no flanks"],
    );
    refused(
        (
            plain,
            "kind = \"iso6336\"\n[gear_mesh.teeth]\nerrors_2 = [{ kind = \"broken-tooth\", tooth = 5, above_radius_mm = 75.0 }]",
        ),
        "errors_2",
        &[
            "gear_mesh.0.teeth.errors_2: is not used by kind = \"iso6336\", which knows no single teeth",
        ],
    );
    refused(
        (
            "gear_2 = \"wheel\"",
            "gear_2 = \"wheel\"\nteeth.errors_2 = [{ kind = \"broken-tooth\", tooth = 57, above_radius_mm = 75.0 }]",
        ),
        "errors_2",
        &[
            "gear_mesh.0.teeth.errors_2.0.tooth: broken-tooth: there is no tooth 57; the gear has teeth 0 to 56",
        ],
    );
    refused(
        (
            "gear_2 = \"wheel\"",
            "gear_2 = \"wheel\"\nteeth.errors_1 = [{ kind = \"pitch\", side = \"right\", removed_um = [1.0, 2.0] }]",
        ),
        "errors_1",
        &["gear_mesh.0.teeth.errors_1.0.removed_um: found 2 numbers, allowed are 57: one a tooth"],
    );
    refused(
        (
            "gear_2 = \"wheel\"",
            "gear_2 = \"wheel\"\nteeth.errors_1 = [{ kind = \"spall\", tooth = 3 }]",
        ),
        "errors_1",
        &["gear_mesh.0.teeth.errors_1.0.side: missing"],
    );
    refused(
        (
            "gear_2 = \"wheel\"",
            "gear_2 = \"wheel\"\nteeth.errors_1 = [{ kind = \"spal\", tooth = 3 }]",
        ),
        "errors_1",
        &["unknown kind `spal`", "`spall`"],
    );
    refused(
        (
            "gear_2 = \"wheel\"",
            "gear_2 = \"wheel\"\nteeth.friction = { model = \"coulomb\", static_coefficient = 0.1, dynamic_coefficient = 0.2 }",
        ),
        "friction",
        &[
            "gear_mesh.0.teeth.friction.static_coefficient: found 0.1, allowed is at least dynamic_coefficient, 0.2",
        ],
    );
    for (further, complaint) in [
        (
            "errors_1 = [{ kind = \"spall\", tooth = 3, side = \"right\", radii_mm = [74.0, 73.0], z_mm = [-1.0, 1.0], depth_um = 5.0 }]",
            "gear_mesh.0.teeth.errors_1.0.radii_mm: found [74, 73], allowed is [lower, upper]",
        ),
        (
            "errors_1 = [{ kind = \"spall\", tooth = 3, side = \"right\", radii_mm = [73.0, 74.0], z_mm = [-1.0, 1.0], depth_um = -5.0 }]",
            "gear_mesh.0.teeth.errors_1.0.depth_um: found -5, allowed is more than 0",
        ),
        (
            "errors_1 = [{ kind = \"tip-chip\", tooth = 3, end = \"+z\", height_mm = 1.0, length_mm = 0.0 }]",
            "gear_mesh.0.teeth.errors_1.0.length_mm: found 0, allowed is more than 0",
        ),
        (
            "errors_1 = [{ kind = \"broken-tooth\", tooth = 3, above_radius_mm = 99.0 }]",
            "gear_mesh.0.teeth.errors_1.0.above_radius_mm: found 99, allowed is less than the tip radius",
        ),
        (
            "friction = { model = \"coulomb\", dynamic_coefficient = 0.2, static_speed_mm_per_s = 10, dynamic_speed_mm_per_s = 5 }",
            "gear_mesh.0.teeth.friction.dynamic_speed_mm_per_s: found 5, allowed is more than static_speed_mm_per_s, 10",
        ),
        (
            "friction = { model = \"coulomb\", coefficient = 0.2 }",
            "gear_mesh.0.teeth.friction: unknown field `coefficient`",
        ),
        (
            "friction = { model = \"coulomb\", dynamic_coefficient = 0.2, reversal_um = 20 }",
            "gear_mesh.0.teeth.friction: unknown field `reversal_um`",
        ),
        (
            "friction = { model = \"coulomb\" }",
            "gear_mesh.0.teeth.friction.dynamic_coefficient: missing",
        ),
    ] {
        let at = further.split(' ').next().unwrap();
        refused(
            (
                "gear_2 = \"wheel\"",
                &format!("gear_2 = \"wheel\"\nteeth.{further}"),
            ),
            at,
            &[complaint],
        );
    }
    refused(
        (
            "[[gear_mesh]]",
            "[[gauge]]\nbody = \"wheel\"\nnames = [\"t0\"]\n[[gear_mesh]]",
        ),
        "body = \"wheel\"\nnames",
        &["gauge.0.body: `wheel` is no reduced gear (.h5)"],
    );
}

/// Programs that know no joints write 1e23 N/m for a rigid support.
#[test]
fn rigid_supports_are_refused_by_their_stiffness() {
    let pendulum = text("scene_pendulum.toml");
    let with = |table: &str| format!("{pendulum}\n{table}");
    let bearing =
        "[[bearing]]\nname = \"b\"\nbody_2 = \"rod\"\n[bearing.model]\nkind = \"linear\"\n";
    for (table, key, parts) in [
        (
            format!("{bearing}radial_stiffness_N_per_mm = 1e14\n"),
            "bearing.0.model.radial_stiffness_N_per_mm",
            ["found 1e14", "up to 1e12", "kind = \"revolute\""],
        ),
        (
            format!("{bearing}radial_stiffness_N_per_mm = 1e6\ntilt_stiffness_Nm_per_rad = 1e20\n"),
            "bearing.0.model.tilt_stiffness_Nm_per_rad",
            ["found", "1e15", "[[joint]]"],
        ),
        (
            "[[bushing]]\nname = \"b\"\nbody_2 = \"rod\"\nstiffness_N_per_mm = [1.0, 1e14, 1.0]\n".to_owned(),
            "bushing.0.stiffness_N_per_mm.1",
            ["found 1e14", "up to 1e12", "[[joint]]"],
        ),
        (
            "[[spring]]\nname = \"s\"\nbody_2 = \"rod\"\nat_1_mm = [0.0, 1.0, 0.0]\nstiffness_N_per_mm = 1e20\n".to_owned(),
            "spring.0.stiffness_N_per_mm",
            ["found 1", "1e15 N_per_mm", "a rigid support is a [[joint]]"],
        ),
    ] {
        let complaint = build(&with(&table)).err().unwrap().to_string();
        for part in [key].into_iter().chain(parts) {
            assert!(complaint.contains(part), "`{part}` is not in\n{complaint}");
        }
    }
    assert!(
        build(&with(&format!(
            "{bearing}radial_stiffness_N_per_mm = 1e12\n"
        )))
        .is_ok()
    );
}

/// Angles that put teeth into each other are no start.
#[test]
fn teeth_that_stand_in_each_other_at_the_start_are_refused() {
    let scene = changed(
        &text("scene_two_wheels.toml"),
        "gear = \"gear1.toml\"\n\n",
        "gear = \"gear1.toml\"\ncardan_deg = [0.0, 0.0, 0.0]\n\n",
    );
    let scene = changed(
        &scene,
        "position_mm = [150.0, 0.0, 0.0]",
        "position_mm = [150.0, 0.0, 0.0]\ncardan_deg = [0.0, 0.0, 3.0]",
    );
    let complaint = build(&scene).err().unwrap().to_string();
    for part in [
        &format!("scene.toml:{}: ", line_of(&scene, "[[gear_mesh]]"))[..],
        "flanks stand",
        "mm in each other at the start, allowed are 0.768 mm",
        "cardan_deg",
        "`pinion` and `wheel`",
    ] {
        assert!(complaint.contains(part), "`{part}` is not in {complaint}");
    }
}
