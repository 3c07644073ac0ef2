//! Every table and function of time of a scene file.

use crate::common::*;
use crate::{assert_labelled, body};

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
        body_2 = "c"
        model = { kind = "linear", radial_stiffness_N_per_mm = 1.0 }
    "#;
    let refused = build_in(scene, folder.path()).err().unwrap().to_string();
    assert!(refused.contains("is a product of functions"), "{refused}");
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
