//! The shipped helical pair: every mesh model that needs no reduced gears, and the axial force that a bearing carries.
#![allow(clippy::unwrap_used, missing_docs)]

mod common;

use common::{Outputs, build, changed, fe_models, text};
use gearmesh_dynamics::{Params, Simulation, StaticParams, equilibrium};
use gearmesh_geometry::GearDefinition;

const ANALYTIC: &str = "model = \"analytic\"\nslices = 9\n";
const DAMPING: &str =
    "damping = { kind = \"stiffness-proportional\", time_s = 2e-6, full_depth_um = 1.0 }";

/// F_t tan β_b on gear 2 along +z, on which a right-hand gear 1 presses with its right flanks; at rest to what the changing stiffness of the teeth
/// adds, and a step of time for each model.
#[test]
fn bearings_carry_the_axial_force_of_every_model() {
    let shipped = text("dynamics_helical.toml");
    let gear = GearDefinition::read(&fe_models().join("helical2.toml")).unwrap();
    let helix = gear.profile.base_helix_angle_rad().abs();
    let tangential_n = 200.0 / gear.profile.base_radius_m;
    for (model, damping) in [
        (ANALYTIC, true),
        (
            "model = \"analytic\"\npath = \"line-of-action\"\nslices = 9\n",
            true,
        ),
        (
            "model = \"iso6336\"\nmicrogeometry = false\nslices = 5\n",
            true,
        ),
        ("model = \"iso6336\"\nmicrogeometry = false\n", true),
        (
            "model = \"impact\"\nstiffness_N_per_mm_e = 3e6\nexponent = 1.5\nslices = 9\n",
            false,
        ),
    ] {
        let mut scene = changed(&shipped, ANALYTIC, model);
        if !damping {
            scene = changed(&scene, DAMPING, "");
        }
        let mut system = build(&scene).unwrap().system;
        let start = system.start().clone();
        let found = equilibrium(&mut system, &start, &StaticParams::default()).unwrap();
        let outputs = Outputs::at(&mut system, &found.state);
        let value = |element: &str, channel: &str| outputs.value(element, channel);
        let axial = value("bearing 2", "force_z_N").abs() / (tangential_n * helix.tan());
        let normal = value("mesh", "normal_force_right_N") * helix.cos() / tangential_n;
        assert!((axial - 1.0).abs() < 5e-3, "{model} {axial}");
        assert!((normal - 1.0).abs() < 5e-3, "{model} {normal}");
        assert!(found.state.positions_m[1][2] > 0.0, "{model}");
        let mut run = Simulation::new(system, Params::fixed(2e-5)).unwrap();
        run.run(2e-3, |_| std::ops::ControlFlow::Continue(()))
            .unwrap();
        assert_eq!(run.info().unconverged, 0, "{model}");
    }
    let kinematic = changed(
        &shipped,
        ANALYTIC,
        "model = \"kinematic\"\nmicrogeometry = false\n",
    );
    build(&changed(&kinematic, DAMPING, "")).unwrap();
}

/// Helices that do not fit are refused where the scene is read.
#[test]
fn gears_of_one_hand_are_refused() {
    let scene = changed(
        &text("dynamics_helical.toml"),
        "gear = \"helical2.toml\"",
        "gear = \"helical1.toml\"",
    );
    let refused = build(&scene).err().unwrap().to_string();
    assert!(refused.contains("opposite hand"), "{refused}");
}
