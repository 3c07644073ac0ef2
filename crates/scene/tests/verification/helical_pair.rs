//! The shipped helical pair: every mesh model that needs no reduced gears, and the axial force that a bearing carries.

use crate::common;

use common::{Outputs, build, changed, fe_models, text};
use gearmesh_dynamics::{Params, Simulation, StaticParams, equilibrium};
use gearmesh_geometry::GearDefinition;

const ANALYTIC: &str = "kind = \"analytic\"\nslices = 9\n";
const MESH: &str = "gear_2 = \"gear 2\"\n";
const DAMPING: &str =
    "damping = { kind = \"stiffness-proportional\", time_s = 2e-6, full_depth_um = 1.0 }";

/// F_t tan β_b on gear 2 along +z, on which a right-hand gear 1 presses with its right flanks; at rest to what the
/// changing stiffness of the teeth adds, and a step of time for each model.
#[test]
fn bearings_carry_the_axial_force_of_every_model() {
    let shipped = text("dynamics_helical.toml");
    let gears = ["helical1.toml", "helical2.toml"]
        .map(|name| GearDefinition::read(&fe_models().join(name)).unwrap());
    let gear = &gears[1];
    let helix = gear.profile.base_helix_angle_rad().abs();
    let tangential_n = 200.0 / gear.profile.base_radius_m;
    let blind = "microgeometry = false\n";
    for (model, mesh, damping) in [
        (ANALYTIC, "", true),
        (ANALYTIC, "teeth.path = \"line-of-action\"\n", true),
        ("kind = \"iso6336\"\nslices = 5\n", blind, true),
        ("kind = \"iso6336\"\n", blind, true),
        (
            "kind = \"impact\"\nstiffness_N_per_mm_e = 3e6\nexponent = 1.5\nslices = 9\n",
            "",
            false,
        ),
    ] {
        let mut scene = changed(&shipped, ANALYTIC, model);
        scene = changed(&scene, MESH, &format!("{MESH}{mesh}"));
        if !damping {
            scene = changed(&scene, DAMPING, "");
        }
        let mut system = build(&scene).unwrap().system;
        let start = system.start().clone();
        let found = equilibrium(&mut system, &start, &StaticParams::default()).unwrap();
        let outputs = Outputs::at(&mut system, &found.state);
        let value = |element: &str, channel: &str| outputs.value(element, channel);
        let axial = value("bearing 2", "force_shaft_z_N").abs() / (tangential_n * helix.tan());
        let normal = value("mesh", "normal_force_right_N") * helix.cos() / tangential_n;
        // F_t, F_r and F_a on gear 1: those of the normal force with the working pressure angle and β_b, and what the
        // bearing of gear 2 carries.
        let [tangential, radial, axial_1] = ["tangential", "radial", "axial"]
            .map(|part| value("mesh", &format!("{part}_force_1_N")));
        let transverse_n = value("mesh", "normal_force_right_N") * helix.cos();
        let sum_m: f64 = gears.iter().map(|gear| gear.profile.base_radius_m).sum();
        let pressure_rad = (sum_m / 0.1136).acos();
        for (found, expected) in [
            (tangential, transverse_n * pressure_rad.cos()),
            (radial, transverse_n * pressure_rad.sin()),
            (axial_1, -transverse_n * helix.tan()),
        ] {
            assert!(
                (found / expected - 1.0).abs() < 5e-3,
                "{model} {found} {expected}"
            );
        }
        let carries = |channel: &str| value("bearing 2", channel);
        assert!(
            (carries("force_radial_N") / tangential.hypot(radial) - 1.0).abs() < 1e-6,
            "{model}"
        );
        assert!(
            (carries("force_world_z_N") / axial_1 - 1.0).abs() < 1e-6,
            "{model}"
        );
        assert!(
            (carries("force_world_y_N") / tangential - 1.0).abs() < 1e-3,
            "{model}"
        );
        assert!(
            (carries("force_world_x_N") / -radial - 1.0).abs() < 3e-3,
            "{model}"
        );
        // Each slice's line load is that of its most loaded pair of teeth: no more than all pairs together, no less
        // than their mean.
        let slices =
            (1..10).map_while(|k| outputs.get("mesh", &format!("line_load_slice_{k}_N_per_m")));
        let slices: Vec<f64> = slices.collect();
        let width_m = gears
            .iter()
            .map(|g| g.tooth.face_width_m)
            .fold(1.0, f64::min)
            / slices.len() as f64;
        let sum_n: f64 = slices.iter().map(|q| q * width_m).sum();
        let normal_n = value("mesh", "normal_force_right_N");
        // The one slice of a whole face may touch over a part of its width.
        let whole = slices.len() == 1;
        let pairs = value("mesh", "loaded_pairs");
        assert!(
            sum_n > (1.0 - 1e-9) * normal_n / pairs
                && (whole || slices.iter().all(|q| q * width_m <= normal_n)),
            "{model} {slices:?}"
        );
        assert!((axial - 1.0).abs() < 5e-3, "{model} {axial}");
        assert!((normal - 1.0).abs() < 5e-3, "{model} {normal}");
        assert!(found.state.positions_m[1][2] > 0.0, "{model}");
        let mut run = Simulation::new(system, Params::fixed(2e-5)).unwrap();
        run.run(2e-3, |_| std::ops::ControlFlow::Continue(()))
            .unwrap();
        assert_eq!(run.info().unconverged, 0, "{model}");
    }
    let kinematic = changed(&shipped, ANALYTIC, "kind = \"kinematic\"\n");
    let kinematic = changed(&kinematic, MESH, &format!("{MESH}{blind}"));
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
