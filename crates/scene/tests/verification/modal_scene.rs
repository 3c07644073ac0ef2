//! A scene whose gear 2 is `modal`: at low speed it is the same as `reduced`, and its modal coordinates are written.

use crate::common;
use crate::made_up_gears;
use crate::system_runs;

use common::load;
use gearmesh_scene::system::SystemPlan;
use gearmesh_scene::system_run::{RunJob, SystemResult};
use made_up_gears::mesh_common::modal_gear::MODES;
use made_up_gears::{scene, write_models};
use std::path::Path;
use system_runs::Desk;

/// Three quarters of a mesh period at 5 rpm, a change of pairs among them.
const RUN: &str = r#"[run]
kind = "transient"
end_s = 0.3
[solver]
step_s = 1e-4
start = "equilibrium"
rho_infinity = 0.0
[output]
interval_s = 1e-3"#;

const TE: &str = "elements/mesh/transmission_error_m";

fn result(flexibility: &str, folder: &Path, desk: &Desk) -> SystemResult {
    let gauges = "[[gauge]]\nbody = \"wheel\"\nnames = [\"g0\", \"g1\"]";
    let text = scene(RUN, -5.0, flexibility, gauges);
    desk.run(RunJob::from_scene(load(&text, folder).unwrap()).unwrap())
}

#[test]
fn at_low_speed_a_modal_gear_is_a_reduced_one() {
    let folder = tempfile::tempdir().unwrap();
    write_models(folder.path());
    let [desk, other] = [Desk::new(), Desk::new()];
    let reduced = result("flexibility = \"reduced\"", folder.path(), &desk);
    let modal = result(
        "flexibility = \"modal\"\nmodal_damping_ratio = 0.02",
        folder.path(),
        &other,
    );
    let column = |r: &SystemResult, name: &str| r.rows.read(name).unwrap();
    let worst = |name: &str| {
        let [a, b] = [&reduced, &modal].map(|r| column(r, name));
        let scale = a.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        assert!(scale > 0.0, "{name}");
        let pairs = a.iter().zip(&b);
        pairs.fold(0.0_f64, |most, (x, y)| most.max((x - y).abs())) / scale
    };
    // Modes and the flexibility left deflect as the patterns do; what is left is their inertia.
    // Seen, over the largest value, at every row: 6.1e-5, 4.9e-5, 2.0e-4, 6.4e-4.
    for (name, tolerance) in [
        (TE, 1e-4),
        ("elements/mesh/normal_force_right_N", 1e-4),
        ("elements/mesh/strain_gear2_g0_method1_ustrain", 1e-3),
        ("elements/mesh/strain_gear2_g1_method2_ustrain", 1e-3),
    ] {
        let off = worst(name);
        assert!(off < tolerance, "{name}: {off:e}");
    }
    // Each mode hangs where the teeth press it: η = φ·F/ω², which no bare `reduced` body has.
    let names: Vec<&str> = modal.rows.columns().iter().map(|c| &*c.name).collect();
    for mode in 0..MODES.len() {
        let name = format!("bodies/wheel/mode_{mode}_sqrt_kg_m");
        assert!(names.contains(&&*name), "{name}");
        let eta = column(&modal, &name);
        assert!(eta.iter().all(|x| x.is_finite()));
        let largest = eta.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        assert!(largest > 1e-9, "{name}: {largest:e}");
    }
    let of_modes = |r: &SystemResult| {
        let columns = r.rows.columns().iter();
        columns.filter(|c| c.name.contains("/mode_")).count()
    };
    assert_eq!((of_modes(&reduced), of_modes(&modal)), (0, MODES.len()));
}

/// The lowest modes alone, by frequency; the plan counts them, and more than the model holds are refused.
#[test]
fn modes_are_chosen_by_frequency() {
    let folder = tempfile::tempdir().unwrap();
    write_models(folder.path());
    let with = |modes: &str| {
        let text = scene(RUN, -5.0, &format!("flexibility = \"modal\"\n{modes}"), "");
        load(&text, folder.path()).unwrap()
    };
    let loaded = with("modes_up_to_Hz = 3500.0");
    let plan = SystemPlan::new(&loaded.scene, loaded.build().unwrap()).unwrap();
    let text = plan.lines.join("\n");
    assert!(
        text.contains("z 41, 3 modes") && plan.degrees_of_freedom == 15,
        "{text}"
    );
    let refused = with("modes_up_to_Hz = 9000.0").build().err().unwrap();
    assert!(
        refused.to_string().contains("body.1.modes_up_to_Hz"),
        "{refused}"
    );
}

/// A static pair and a multibody mesh of reduced gears of unequal width with other slices each, the narrow one 1 mm off
/// the middle: contact on the overlap only, one transmission error; faces that do not overlap are refused by the key.
#[test]
fn mates_of_unequal_width_touch_where_their_faces_overlap() {
    let folder = tempfile::tempdir().unwrap();
    let pair = made_up_gears::pair();
    for (teeth, shift, profile, width_m, slices) in [
        (30, 0.2, &pair.gear_1, 20e-3, 5),
        (41, -0.1, &pair.gear_2, 14e-3, 4),
    ] {
        let toml = made_up_gears::gear_file(teeth, shift);
        let toml = toml.replace(
            "face_width_mm = 20.0",
            &format!("face_width_mm = {:?}", 1e3 * width_m),
        );
        let model = gearmesh_model::ReducedGear {
            input: gearmesh_model::StoredGear::of_older_file(toml),
            near_field: None,
            ..made_up_gears::mesh_common::pair_common::made_up_gear(profile, width_m, slices)
        };
        let file = folder.path().join(format!("gear_{teeth}.h5"));
        gearmesh_model::write_reduced_gear(&file, &model).unwrap();
    }
    let static_pair = |offset_mm: f64| {
        let text = format!(
            "title = \"unequal\"\n[pair]\ngear_1 = \"gear_30.h5\"\ngear_2 = \"gear_41.h5\"\ncentre_distance_mm = 106.8\n\
             axial_offset_mm = {offset_mm:?}\n[mesh]\nmodel.kind = \"hybrid\"\nmodel.local = \"weber-banaschek\"\nteeth.path = \"line-of-action\"\n\
             [run]\ntorques_Nm = [2.0]\npitches = 1\npoints_per_pitch = 8\n"
        );
        let document = gearmesh_geometry::input::InputDocument::new("pair.toml", text);
        gearmesh_scene::load(gearmesh_scene::Scene::from_document(document, folder.path()).unwrap())
    };
    let refused = static_pair(-17.0).err().unwrap().to_string();
    assert!(
        refused.contains("axial_offset_mm") && refused.contains("side by side"),
        "{refused}"
    );
    let loaded = static_pair(1.0).unwrap();
    let found = gearmesh_scene::run(&loaded, &|_, _| ()).unwrap();
    assert_eq!(found.lines.slices, 4);
    let places = found.lines.places.as_ref().unwrap();
    for (z, width) in places
        .z_m
        .iter()
        .zip(&places.width_m)
        .filter(|(_, w)| **w > 0.0)
    {
        assert!(
            z - 0.5 * width > -6.0001e-3 && z + 0.5 * width < 8.0001e-3,
            "{z} {width}"
        );
    }
    let text = scene(
        "[run]\nkind = \"static\"",
        -5.0,
        "",
        "teeth.flanks = \"right\"\nteeth.path = \"line-of-action\"",
    );
    let text = text
        .replace("106.8, 0.0, 0.0", "106.8, 0.0, 1.0")
        .replace("-100.0", "-2.0");
    let mut system = load(&text, folder.path()).unwrap().build().unwrap().system;
    let start = system.start().clone();
    let params = gearmesh_dynamics::StaticParams::default();
    let state = gearmesh_dynamics::equilibrium(&mut system, &start, &params)
        .unwrap()
        .state;
    let te = common::Outputs::at(&mut system, &state).value("mesh", "transmission_error_m");
    let [least, most] =
        [f64::min, f64::max].map(|of| found.te_m.iter().copied().reduce(of).unwrap());
    assert!(
        te > 1.2 * least && te < 0.8 * most && te < 0.0,
        "{te:e} {least:e} {most:e}"
    );
}
