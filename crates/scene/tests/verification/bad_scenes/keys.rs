//! Unknown names, keys of another kind, values out of range.

use crate::bad_scenes::refused;
use crate::common::{build, changed, text};

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
        &[
            "gear_mesh.0.model: `local` belongs to kind \"hybrid\", not to \"impact\", which knows `kind`, `stiffness_N_per_mm_e`",
        ],
    );
    refused(
        ("kind = \"impact\"", "kind = \"iso6336\""),
        "damping_N_s_per_mm",
        &[
            "gear_mesh.0.model: `damping_N_s_per_mm` belongs to kind \"impact\" and \"node-to-surface\", not to \"iso6336\"",
        ],
    );
    refused(
        ("end_s = 0.05", "end_s = 0.05\nspeeds = 7"),
        "speeds",
        &[
            "run: `speeds` belongs to kind \"speed-sweep\", not to \"transient\", which knows `kind`, `end_s`",
        ],
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
        &["gear_mesh.0.model.exponent: found 0.5, allowed is 1 to 5"],
    );
    refused(
        ("exponent = 1.5\n", ""),
        "[gear_mesh.model]",
        &[
            "gear_mesh.0.model.exponent: missing; the unit of stiffness_N_per_mm_e, N/mm^e, needs it",
        ],
    );
    refused(
        ("full_damping_depth_um = 10.0", ""),
        "[gear_mesh.model]",
        &["gear_mesh.0.model.full_damping_depth_um: missing; damping_N_s_per_mm needs it"],
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
        &["load.0.torque_Nm.step.to: found NaN, allowed is a finite number"],
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

/// Steps that pass teeth by: at the start, at a speed to which a motion goes later, in a sweep, adaptive.
#[test]
fn steps_that_do_not_follow_the_mesh_are_refused() {
    let allowed = "allowed is at most 1.75e-4 s, a tenth of the mesh period";
    refused(
        ("step_s = 2e-6", "step_s = 2e-4"),
        "step_s",
        &[
            "solver.step_s: found 0.0002 s, 0.114 periods of mesh `mesh`, whose frequency is 570.000 Hz",
            allowed,
        ],
    );
    refused(
        (
            "step_s = 2e-6",
            "adaptive = { largest_step_s = 2e-3, translation_tolerance_um = 1.0, rotation_tolerance_urad = 10.0 }",
        ),
        "adaptive",
        &[
            "solver.adaptive.largest_step_s: found 0.002 s, 1.140 periods of mesh `mesh`",
            allowed,
        ],
    );
    let ramp = "speed_rpm = { step = { start_s = 0.0, from = 0.0, end_s = 0.04, to = -60000.0 } }";
    refused(
        ("speed_rpm = -600.0", ramp),
        "step_s",
        &[
            "0.114 periods of mesh `mesh`, whose frequency is 57000.000 Hz at the highest speed that the scene states",
        ],
    );
    refused(
        (
            "kind = \"transient\"\nend_s = 0.05",
            &sweep("to_rpm = -60000.0", "settle_s = 0.01\nmeasure_s = 0.01"),
        ),
        "step_s",
        &["solver.step_s: found 0.000002 s, 0.114 periods of mesh `mesh`"],
    );
    // Ten steps a period are enough.
    let scene = changed(
        &text("scene_two_wheels.toml"),
        "step_s = 2e-6",
        "step_s = 1.75e-4",
    );
    build(&scene).unwrap();
}

fn sweep(to: &str, times: &str) -> String {
    format!(
        "kind = \"speed-sweep\"\nmotion = \"drive\"\nspeeds = 3\nfrom_rpm = -600.0\n{to}\n{times}"
    )
}

/// Windows of a sweep without samples have no figures.
#[test]
fn sweeps_whose_windows_hold_no_samples_are_refused() {
    let transient = "kind = \"transient\"\nend_s = 0.05";
    let of = |times: &str| sweep("to_rpm = -700.0", times);
    let samples = "two samples of output.interval_s = 0.00002";
    for (measure, found) in [("1e-5", "0.00001"), ("1e-29", "1e-29")] {
        refused(
            (
                transient,
                &of(&format!("settle_s = 0.01\nmeasure_s = {measure}")),
            ),
            "measure_s",
            &[&format!(
                "run.measure_s: found {found}, allowed is at least 0.00004, {samples}"
            )],
        );
    }
    refused(
        (transient, &of("settle_s = 1e-29\nmeasure_s = 0.01")),
        "settle_s",
        &["run.settle_s: found 1e-29, allowed is at least"],
    );
    refused(
        (transient, &of("ramp_s = 1e-3").replace("speeds = 3\n", "")),
        "ramp_s",
        &[
            "run.ramp_s: found 0.001, allowed is at least 0.004: each of its 100 windows needs",
            samples,
        ],
    );
    refused(
        ("interval_s = 2e-5", "interval_s = 1e-29"),
        "interval_s",
        &["output.interval_s: found 1e-29, allowed is at least"],
    );
}
