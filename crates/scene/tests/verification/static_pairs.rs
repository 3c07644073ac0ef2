//! Gear pairs at rest: tilted a little, and in steps of the angle that are longer than teeth.

use std::sync::atomic::AtomicBool;

use gearmesh_scene::system_run::{RunJob, SystemResult};

use crate::common::{changed, fe_models, load};
use crate::system_runs::Desk;

/// A pair of the shipped train on revolute joints, gear 1 at given angles, 100 N m on gear 2, whose axis is tilted.
fn scene(model: &str, tilt_deg: f64, angles_deg: &[f64]) -> String {
    format!(
        "title = \"pair\"\n[run]\nkind = \"static\"\nmotion = \"drive\"\nangles_deg = {angles_deg:?}\n\
         [[body]]\nname = \"pinion\"\ngear = \"train_27.toml\"\n\
         [[body]]\nname = \"wheel\"\ngear = \"train_61.toml\"\nposition_mm = [88.0, 0.0, 0.0]\ncardan_deg = [{tilt_deg}, 0.0]\n\
         [[joint]]\nname = \"a\"\nkind = \"revolute\"\nbody_2 = \"pinion\"\n\
         [[joint]]\nname = \"b\"\nkind = \"revolute\"\nbody_2 = \"wheel\"\n\
         [[motion]]\nname = \"drive\"\njoint = \"a\"\nangle_deg = 0.0\n\
         [[load]]\nbody = \"wheel\"\ntorque_Nm = -100.0\n\
         [[gear_mesh]]\nname = \"mesh\"\ngear_1 = \"pinion\"\ngear_2 = \"wheel\"\nmodel.kind = \"{model}\"\nmodel.slices = 5\nteeth.flanks = \"right\"\n"
    )
}

fn run(text: &str) -> (Desk, SystemResult) {
    let desk = Desk::new();
    let loaded = load(text, &fe_models()).unwrap();
    let result = desk.run(RunJob::from_scene(loaded).unwrap());
    (desk, result)
}

/// Force, transmission error and turn of gear 2 at each angle.
fn found(model: &str, tilt_deg: f64, angles_deg: &[f64]) -> Vec<[f64; 3]> {
    let (_desk, result) = run(&scene(model, tilt_deg, angles_deg));
    let read = |name: &str| result.rows.read(name).unwrap();
    let force = read("elements/mesh/normal_force_right_N");
    let error = read("elements/mesh/transmission_error_m");
    let turn = read("bodies/wheel/turn_rad");
    (0..angles_deg.len())
        .map(|i| [force[i], error[i], turn[i]])
        .collect()
}

/// 17 microradians of tilt hardly move anything.
#[test]
fn pairs_on_tilted_axes_come_to_rest() {
    for model in ["iso6336", "analytic"] {
        let straight = found(model, 0.0, &[0.0, 3.0]);
        for tilt_deg in [0.001, -0.001] {
            let tilted = found(model, tilt_deg, &[0.0, 3.0]);
            for (a, b) in straight.iter().zip(&tilted) {
                assert!(
                    (a[0] / b[0] - 1.0).abs() < 1e-3,
                    "{model} {tilt_deg}: {a:?} {b:?}"
                );
                assert!(
                    (a[1] - b[1]).abs() < 0.2e-6,
                    "{model} {tilt_deg}: {a:?} {b:?}"
                );
            }
        }
    }
}

/// The pitch of gear 1 is 13.3 degrees: one step of 15 or 170 degrees ends on the same teeth as many of 2.
#[test]
fn long_steps_of_the_angle_end_where_short_ones_do() {
    for model in ["iso6336", "analytic"] {
        for end in [30.0, -30.0] {
            let steps: Vec<f64> = (1..=15).map(|i| end / 15.0 * f64::from(i)).collect();
            let short = found(model, 0.01, &steps);
            let long = found(model, 0.01, &[0.5 * end, end]);
            let at_once = found(model, 0.01, &[end]);
            for (a, b) in [(&short[14], &long[1]), (&short[14], &at_once[0])] {
                assert!((a[0] / b[0] - 1.0).abs() < 1e-8, "{model}: {a:?} {b:?}");
                assert!((a[1] - b[1]).abs() < 1e-12, "{model}: {a:?} {b:?}");
                assert!((a[2] - b[2]).abs() < 1e-10, "{model}: {a:?} {b:?}");
            }
            // The ratio, but for the deflection: no tooth was skipped.
            let exact = -end.to_radians() * 27.0 / 61.0;
            assert!((short[14][2] - exact).abs() < 1e-3, "{model}: {short:?}");
        }
    }
}

/// Gears between two torques turn freely: what rounding and the tilt leave along that motion is no load. It was refused
/// as one, or sent the iteration away.
#[test]
fn a_tilted_pair_between_two_torques_comes_to_rest() {
    for model in ["iso6336", "analytic"] {
        for tilt_deg in ["[0.001, 0.0]", "[0.0, 0.001]"] {
            let text = scene(model, 0.0, &[0.0]);
            let text = changed(&text, "teeth.flanks = \"right\"\n", "");
            let text = changed(&text, "motion = \"drive\"\nangles_deg = [0.0]\n", "");
            let text = changed(
                &text,
                "[0, 0.0]\n[[joint]]",
                &format!("{tilt_deg}\n[[joint]]"),
            );
            let driven = "[[motion]]\nname = \"drive\"\njoint = \"a\"\nangle_deg = 0.0\n";
            let torque = -100.0 * 27.0 / 61.0;
            let load = format!("[[load]]\nbody = \"pinion\"\ntorque_Nm = {torque:?}\n");
            let (_desk, result) = run(&changed(&text, driven, &load));
            let read = |side: &str| {
                let column = format!("elements/mesh/normal_force_{side}_N");
                result.rows.read(&column).unwrap()[0]
            };
            let force = read("right") + read("left");
            // T/r_b2 with r_b2 = 61 mm cos 20°; softer teeth in the middle of the face change its distribution only.
            let expected = 100.0 / (0.061 * 20f64.to_radians().cos());
            assert!(
                (force / expected - 1.0).abs() < 2e-3,
                "{model} {tilt_deg}: {force}"
            );
        }
    }
}

/// A load that turns the wheel away from the only flanks that the mesh has is named by its sense, as in a run in time;
/// the gears were sent round until their axes were said to be tilted.
#[test]
fn a_load_against_the_only_flanks_is_named() {
    for model in ["iso6336", "analytic"] {
        let text = changed(
            &scene(model, 0.0, &[0.0]),
            "torque_Nm = -100.0",
            "torque_Nm = 100.0",
        );
        let desk = Desk::new();
        let job = RunJob::from_scene(load(&text, &fe_models()).unwrap()).unwrap();
        let failed = gearmesh_scene::system_run::run(job, &desk.options(&AtomicBool::new(false)));
        let told = failed.unwrap_err().to_string();
        assert!(
            told.contains("left flanks") && told.contains("clockwise (torques negative about z)"),
            "{model}: {told}"
        );
    }
}

/// Teeth that are open by micrometres at the start come together, at whatever angle the gears stand. What rounding
/// leaves of a free turn in the equations of its joint was taken for a resistance; 19 of 160 such starts sent the wheel
/// the wrong way.
#[test]
fn open_teeth_come_together_wherever_the_gears_stand() {
    // T/r_b2: 40 teeth, module 3 mm. Corrections end at 1e-12 rad, 3e-6 of the deflection.
    let expected = 1.0 / (0.060 * 20f64.to_radians().cos());
    for start in 0..40 {
        let wheel_deg = 182.2275 + 5e-4 * f64::from(start);
        let (_desk, result) = run(&format!(
            "title = \"open teeth\"\n[run]\nkind = \"static\"\n\
             [[body]]\nname = \"pinion\"\ngear = \"first_pair/pinion.toml\"\ncardan_deg = [0.0, 0.0, 3.8909]\n\
             [[body]]\nname = \"wheel\"\ngear = \"first_pair/wheel.toml\"\nposition_mm = [94.6, 0.0, 0.0]\ncardan_deg = [0.0, 0.0, {wheel_deg:?}]\n\
             [[joint]]\nname = \"p\"\nkind = \"fixed\"\nbody_2 = \"pinion\"\n\
             [[joint]]\nname = \"w\"\nkind = \"revolute\"\nbody_2 = \"wheel\"\n\
             [[load]]\nbody = \"wheel\"\ntorque_Nm = -1.0\n\
             [[gear_mesh]]\nname = \"mesh\"\ngear_1 = \"pinion\"\ngear_2 = \"wheel\"\n\
             model = {{ kind = \"impact\", stiffness_N_per_mm_e = 1e6, exponent = 1.0 }}\nteeth = {{ flanks = \"right\" }}\n"
        ));
        let force = result
            .rows
            .read("elements/mesh/normal_force_right_N")
            .unwrap()[0];
        assert!(
            (force / expected - 1.0).abs() < 1e-5,
            "{wheel_deg}: {force}"
        );
    }
}
