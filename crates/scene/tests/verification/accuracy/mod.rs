//! `accuracy` of a made-up pair and of a multibody scene: errors against runs of the scenes by themselves, advice that
//! keeps its word, what is refused.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use gearmesh_geometry::input::InputDocument;
use gearmesh_scene::accuracy::{Accuracy, Bench, BenchOptions, Goal, JudgedTime, accuracy, words};
use gearmesh_scene::study::{StudyError, Wanted};
use gearmesh_scene::system::SystemScene;
use gearmesh_scene::system_run::RunJob;
use gearmesh_scene::{Scene, load, run};

mod goal;
mod other_kinds;
use crate::made_up_gears;
use crate::system_runs;

use system_runs::Desk;

const SCENE: &str = r#"title = "made up"
[pair]
gear_1 = "gear_30.h5"
gear_2 = "gear_41.h5"
centre_distance_mm = 106.8
[mesh.model]
kind = "hybrid"
local = "weber-banaschek"
slices = 3
[mesh.teeth]
path = "line-of-action"
[run]
torques_Nm = [60.0, 120.0]
pitches = 1
points_per_pitch = 16
"#;

/// What `of` finds of the folder's scene.
fn bench_in<T>(
    folder: &Path,
    columns: &[&str],
    of: impl FnOnce(&Bench<'_>) -> Result<T, StudyError>,
) -> Result<T, String> {
    let stop = AtomicBool::new(false);
    let options = BenchOptions {
        wanted: columns.iter().map(|text| Wanted::of(text)).collect(),
        from_s: 0.0,
        time: JudgedTime::Processor,
        repeated_for_s: 0.0,
        elements: false,
        scratch: folder,
        models: folder,
        stop: &stop,
        reduce: &|_| Err("no gear is reduced here".to_owned()),
    };
    let bench = Bench::new(&folder.join("scene.toml"), options);
    of(&bench.map_err(|e| e.to_string())?).map_err(|e| e.to_string())
}

fn found_in(folder: &Path, columns: &[&str]) -> Result<Accuracy, String> {
    bench_in(folder, columns, |bench| accuracy(bench, &|_, _| ()))
}

/// Mean transmission error of both torques [m].
fn means(folder: &Path, text: &str) -> [f64; 2] {
    let scene = Scene::from_document(InputDocument::new("own", text), folder).unwrap();
    let result = run(&load(scene).unwrap(), &|_, _| ()).unwrap();
    [0, 1].map(|k| {
        let te = result.curve(&result.te_m, k);
        te.iter().sum::<f64>() / te.len() as f64
    })
}

#[test]
fn errors_are_those_of_runs_and_advice_keeps_its_word() {
    let folder = tempfile::tempdir().unwrap();
    made_up_gears::write_models(folder.path());
    std::fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    let found = found_in(folder.path(), &["te_mean_um", "k_h_beta"]).unwrap();
    let names: Vec<&str> = found.knobs.iter().map(|knob| &knob.name[..]).collect();
    assert_eq!(
        names,
        [
            "mesh.model.local",
            "mesh.model.slices",
            "run.points_per_pitch",
            "mesh.teeth.path"
        ]
    );
    assert!(found.failed.is_empty(), "{:?}", found.failed);
    assert_eq!(found.tried[0].error(), 0.0);

    // The scene with all knobs at their top, and with the local term alone left out.
    let (most, points) = (&found.knobs[1].rungs.last().unwrap().label, 64);
    let top = SCENE
        .replace("slices = 3", &format!("slices = {most}"))
        .replace(
            "points_per_pitch = 16",
            &format!("points_per_pitch = {points}"),
        )
        .replace("line-of-action", "extended");
    let reference = means(folder.path(), &top);
    let lowered = means(folder.path(), &top.replace("weber-banaschek", "none"));
    let expected = (0..2)
        .map(|k| ((lowered[k] - reference[k]) / reference[k]).abs())
        .fold(0.0, f64::max);
    let single = found
        .tried
        .iter()
        .find(|one| words(&found.knobs, &one.rungs) == "mesh.model.local = none")
        .unwrap();
    assert!(
        expected > 1e-3 && (single.errors[0] / expected - 1.0).abs() < 1e-6,
        "{single:?} {expected}"
    );

    // What is advised, pasted into the scene, is within its goal.
    let within: Vec<_> = found
        .advice
        .iter()
        .filter(|a| matches!(a.goal, Goal::Within(_)))
        .collect();
    // Of each goal there is advice, or the reference itself is not known so well.
    assert_eq!(within.len() + found.open.len(), 2, "{found:?}");
    for advice in within {
        let Goal::Within(most) = advice.goal else {
            continue;
        };
        let both = advice.tried.errors.iter().zip(found.doubts());
        let worst = both.map(|(error, doubt)| error + doubt).fold(0.0, f64::max);
        assert!(worst <= most, "{advice:?}");
        let mut pasted: toml::Value = SCENE.parse::<toml::Table>().unwrap().into();
        for line in &advice.toml {
            let (key, value) = line.split_once(" = ").unwrap();
            let value = format!("v = {value}").parse::<toml::Table>().unwrap()["v"].clone();
            let mut place = &mut pasted;
            for part in key.split('.') {
                place = place.as_table_mut().unwrap().get_mut(part).unwrap();
            }
            *place = value;
        }
        let own = means(folder.path(), &toml::to_string(&pasted).unwrap());
        let error = (0..2)
            .map(|k| ((own[k] - reference[k]) / reference[k]).abs())
            .fold(0.0, f64::max);
        assert!(
            (error - advice.tried.errors[0]).abs() < 1e-9,
            "{error} {advice:?}"
        );
    }
}

/// A body of 1 kg on a spring, ω₀ = 20 rad/s.
const OSCILLATOR: &str = "title = \"oscillator\"\n[run]\nkind = \"transient\"\nend_s = 1.0\n[solver]\nstep_s = 5e-4\n[output]\ninterval_s = 1e-2\n\
        [[body]]\nname = \"block\"\nmass_kg = 1.0\ninertia_kg_m2 = [1.0, 1.0, 1.0]\nposition_mm = [100.0, 0.0, 0.0]\nvelocity_mm_per_s = [500.0, 0.0, 0.0]\n\
        [[joint]]\nname = \"rail\"\nkind = \"prismatic\"\nbody_2 = \"block\"\naxis = [1.0, 0.0, 0.0]\n\
        [[spring]]\nname = \"spring\"\nbody_2 = \"block\"\nat_1_mm = [0.0, 0.0, 0.0]\nat_2_mm = [100.0, 0.0, 0.0]\nstiffness_N_per_mm = 0.4\nfree_length_mm = 100.0\n";

/// The error falls with the step.
#[test]
fn a_run_in_time_is_worth_its_step() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("scene.toml"), OSCILLATOR).unwrap();
    let column = "bodies/block/velocity_x_m_per_s:deviation";
    let found = found_in(folder.path(), &[column]).unwrap();
    let of = |setting: &str| {
        let one = found
            .tried
            .iter()
            .find(|one| words(&found.knobs, &one.rungs) == setting);
        one.unwrap_or_else(|| unreachable!("{setting} is not among {found:?}"))
            .error()
    };
    let errors =
        ["0.002", "0.001", "0.0005", "0.00025"].map(|step| of(&format!("solver.step_s = {step}")));
    assert!(errors[0] < 0.01 && errors[3] > 0.0, "{errors:?}");
    assert!(errors.is_sorted_by(|a, b| *a > 1.5 * b), "{errors:?}");
    assert!(!found.advice.is_empty());
}

#[test]
fn columns_that_are_not_there_are_told() {
    let folder = tempfile::tempdir().unwrap();
    made_up_gears::write_models(folder.path());
    std::fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    let told = found_in(folder.path(), &["te_maen_um"]).unwrap_err();
    assert!(told.contains("did you mean `te_mean_um`?"), "{told}");
}

/// An effect that is off adds nothing: a scene that puts friction off takes what a scene takes that never named it.
#[test]
fn an_effect_that_is_off_adds_no_states_and_no_calls() {
    let folder = tempfile::tempdir().unwrap();
    made_up_gears::write_models(folder.path());
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, SCENE).unwrap();
    let never = found_in(folder.path(), &["te_mean_um"]).unwrap();
    let on = never.effects.iter().find(|e| !e.effect.present).unwrap();
    assert!(on.effect.name.starts_with("friction of teeth"), "{on:?}");
    assert!(on.changes[0] > 1e-4, "{on:?}");

    let friction =
        "friction = { model = \"coulomb\", dynamic_coefficient = 0.05 }\npath = \"line-of-action\"";
    let with = SCENE.replace("path = \"line-of-action\"", friction);
    std::fs::write(&path, &with).unwrap();
    let found = found_in(folder.path(), &["te_mean_um"]).unwrap();
    let off = found
        .effects
        .iter()
        .find(|e| e.effect.name == "mesh.teeth.friction")
        .unwrap();
    assert!(off.effect.present);
    let counts = |e: &gearmesh_scene::study::Effort| [e.states, e.calls, e.iterations];
    assert_eq!(counts(&off.without), counts(&on.without));
    assert_eq!(counts(&off.with), counts(&on.with));
    assert_eq!(off.changes, on.changes);
    // Slices that may touch, and both torques' positions.
    assert_eq!(off.with.calls, 32.0);
    assert_eq!(off.with.states % 3.0, 0.0);
}

/// Of a system, too: without its damper the oscillator has the same states, and its swing does not die out.
#[test]
fn effects_of_a_system_are_put_off_one_by_one() {
    let folder = tempfile::tempdir().unwrap();
    let text = OSCILLATOR.replace(
        "free_length_mm = 100.0",
        "free_length_mm = 100.0\ndamping_N_s_per_mm = 2e-3",
    );
    std::fs::write(folder.path().join("scene.toml"), text).unwrap();
    let column = "bodies/block/velocity_x_m_per_s:deviation";
    let found = found_in(folder.path(), &[column]).unwrap();
    let [damping] = &found.effects[..] else {
        unreachable!("{:?}", found.effects)
    };
    assert_eq!(damping.effect.name, "spring.damping_N_s_per_mm");
    assert_eq!(damping.with.states, damping.without.states);
    // v = v0 e^(-t) cos(ωt) against v0 cos(ωt) over the second half of a second: 2 ∫e^(-2t) dt = 0.233 of the square.
    let expected = 1.0 - ((-1.0_f64).exp() - (-2.0_f64).exp()).sqrt();
    assert!(
        (damping.changes[0] - expected).abs() < 0.02,
        "{} {expected}",
        damping.changes[0]
    );
}

/// The reference says how far it is from its own last step.
#[test]
fn the_last_step_of_the_reference_is_told() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("scene.toml"), OSCILLATOR).unwrap();
    let column = "bodies/block/velocity_x_m_per_s:deviation";
    let found = found_in(folder.path(), &[column]).unwrap();
    let (knob, change) = found.unsettled().unwrap();
    assert_eq!(knob.name, "solver.step_s");
    let below = &knob.rungs[knob.rungs.len() - 2].label;
    let single = found
        .tried
        .iter()
        .find(|one| words(&found.knobs, &one.rungs) == format!("solver.step_s = {below}"));
    assert_eq!(single.unwrap().error(), change);
    let told = found_in(folder.path(), &["bodies/block/velocity_x_m_per_s"]).unwrap_err();
    assert!(told.contains("is a series; say what of it"), "{told}");
}

/// What the reference may be off by covers its true error, and is within three times of it: v = v₀ cos ωt over the
/// second half of a second. A run whose neighbours stay with it has no spread.
#[test]
fn what_the_reference_may_be_off_by_covers_its_error() {
    let folder = tempfile::tempdir().unwrap();
    // Of longer rows only some steps are looked at, which no knob changes.
    let oscillator = OSCILLATOR.replace("interval_s = 1e-2", "interval_s = 2e-3");
    std::fs::write(folder.path().join("scene.toml"), &oscillator).unwrap();
    let column = "bodies/block/velocity_x_m_per_s";
    let found = found_in(folder.path(), &[&format!("{column}:deviation")]).unwrap();
    assert!(found.spread.is_empty() && found.open.is_empty());
    let mut text = oscillator;
    for knob in &found.knobs {
        let (name, top) = (&knob.name, &knob.rungs.last().unwrap().label);
        match name.strip_prefix("solver.").unwrap() {
            "step_s" => text = text.replace("step_s = 5e-4", &format!("step_s = {top}")),
            key => text = text.replace("[output]", &format!("{key} = {top}\n[output]")),
        }
    }
    let scene = InputDocument::new("own", text);
    let scene = SystemScene::from_document(scene, folder.path()).unwrap();
    let job = RunJob::from_scene(scene.load().unwrap()).unwrap();
    let result = Desk::new().run(job);
    let mut columns = result.rows.columns().iter();
    let place = columns.position(|one| one.name == column).unwrap();
    let own = result.statistics[place].deviation;
    // ∫ cos 20t dt and ∫ cos² 20t dt from 0.5 to 1.
    let mean = (20.0_f64.sin() - 10.0_f64.sin()) / 20.0 / 0.5;
    let square = (0.25 + (40.0_f64.sin() - 20.0_f64.sin()) / 80.0) / 0.5;
    let exact = 0.5 * (square - mean * mean).sqrt();
    let (error, doubt) = ((own / exact - 1.0).abs(), found.doubts()[0]);
    assert!(
        error <= doubt && doubt <= 3.0 * error,
        "{error:e} {doubt:e}"
    );
}

/// Two rods of 0.1 m, each with its mass at the end, let go level: they swing and turn over without rule.
fn two_rods() -> String {
    let rod = |name: &str, end_mm: f64, on: &str| {
        format!(
            "[[body]]\nname = \"{name}\"\nmass_kg = 0.1\ninertia_kg_m2 = [1e-5, 1e-5, 1e-5]\nposition_mm = [{end_mm:?}, 0.0, 0.0]\n\
             [[joint]]\nname = \"hinge of {name}\"\nkind = \"revolute\"\n{on}body_2 = \"{name}\"\nat_mm = [{:?}, 0.0, 0.0]\naxis = [0.0, 0.0, 1.0]\n",
            end_mm - 100.0
        )
    };
    format!(
        "title = \"two rods\"\ngravity_m_per_s2 = [0.0, -9.81, 0.0]\n[run]\nkind = \"transient\"\nend_s = 10.0\n[solver]\nstep_s = 8e-3\n[output]\ninterval_s = 4e-2\n{}{}",
        rod("upper", 100.0, ""),
        rod("lower", 200.0, "body_1 = \"upper\"\n")
    )
}

/// No setting of a chaotic run is within a hundredth of the truth, and that is what is said.
#[test]
fn a_chaotic_run_is_judged_by_its_spread() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("scene.toml"), two_rods()).unwrap();
    let found = found_in(folder.path(), &["bodies/lower/y_m:deviation"]).unwrap();
    let [spread] = found.spread[..] else {
        unreachable!("{found:?}")
    };
    assert!(spread > 0.01 && spread < 1.0, "{spread}");
    assert!(found.doubts()[0] >= spread);
    assert_eq!(found.open, [Goal::Within(0.01), Goal::Within(0.001)]);
    // It has no teeth, gauges or bearings that would say what matters.
    let told = found_in(folder.path(), &[]).unwrap_err();
    assert!(told.contains("name what is to be exact"), "{told}");
}

/// Where no column is named a pair is judged by what its settings decide.
#[test]
fn columns_by_default_are_those_that_settings_decide() {
    let folder = tempfile::tempdir().unwrap();
    made_up_gears::write_models(folder.path());
    std::fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    let found = found_in(folder.path(), &[]).unwrap();
    let expected = ["te_peak_to_peak_um", "k_h_beta", "pressure_largest_MPa"];
    assert_eq!(found.columns, expected);
}

/// Seed 002's pair without friction, for 20 mesh periods; the pinion's speed as given.
fn pair_in_motion(folder: &Path, speed: &str) -> SystemScene {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fe_models");
    for file in ["pinion_25_m2.toml", "wheel_30_m2.toml"] {
        std::fs::copy(shipped.join(file), folder.join(file)).unwrap();
    }
    let text = std::fs::read_to_string(shipped.join("dynamics_25_30.toml")).unwrap();
    let (text, _) = text.split_once("[gear_mesh.teeth.friction]").unwrap();
    let mut text = text.to_owned();
    for (old, new) in [
        ("end_s = 0.4", "end_s = 0.08"),
        ("step_s = 2e-6", "step_s = 1e-5"),
        ("interval_s = 2e-5", "interval_s = 1e-4"),
        ("end_s = 0.1,", "end_s = 0.02,"),
        ("joint = \"pinion axis\"\nspeed_rpm = -600.0", speed),
    ] {
        assert!(text.contains(old), "{old}");
        text = text.replace(old, new);
    }
    std::fs::write(folder.join("scene.toml"), &text).unwrap();
    SystemScene::from_document(InputDocument::new("own", text), folder).unwrap()
}

/// Mesh frequencies are steady where motions keep their speeds while the run is judged, its second half. Lines at the
/// first orders are then judged, too, and only then.
#[test]
fn lines_at_mesh_orders_are_judged_where_the_mesh_frequency_stays() {
    let folder = tempfile::tempdir().unwrap();
    let joint = "joint = \"pinion axis\"\nspeed_rpm = ";
    let slows_down = |end_s: &str| {
        format!(
            "{joint}{{ step = {{ start_s = 0.0, from = -600.0, end_s = {end_s}, to = -500.0 }} }}"
        )
    };
    let place = "joint = \"pinion axis\"\nangle_deg = { linear = { slope_per_s = -3600.0 } }";
    for (motion, steady_hz) in [
        (format!("{joint}-600.0"), Some(250.0)),
        (slows_down("0.03"), Some(500.0 / 60.0 * 25.0)),
        (slows_down("0.07"), None),
        (place.to_owned(), Some(250.0)),
    ] {
        let scene = pair_in_motion(folder.path(), &motion);
        let built = scene.load().unwrap().build().unwrap();
        let found = built.meshes[0].steady_hz;
        let near = |hz: f64| steady_hz.is_some_and(|known: f64| (hz / known - 1.0).abs() < 1e-9);
        assert!(
            found.map_or(steady_hz.is_none(), near),
            "{motion}: {found:?}"
        );
    }
    let columns = |motion: &str| {
        pair_in_motion(folder.path(), motion);
        let chosen = bench_in(folder.path(), &[], |bench| {
            gearmesh_scene::accuracy::choose(bench, 10.0, &|_, _| ())
        });
        chosen.unwrap().columns
    };
    let steady = columns(&format!("{joint}-600.0"));
    for column in ["transmission_error_m", "normal_force_right_N"] {
        let lines: Vec<&String> = (steady.iter())
            .filter(|name| name.starts_with(&format!("elements/mesh/{column}:line-")))
            .collect();
        let expected =
            ["250", "500", "750"].map(|hz| format!("elements/mesh/{column}:line-{hz}Hz"));
        assert_eq!(lines, expected.iter().collect::<Vec<_>>(), "{steady:?}");
    }
    let unsteady = columns(&slows_down("0.07"));
    assert_eq!(unsteady.len() + 6, steady.len(), "{unsteady:?}");
}

/// Positions of a tooth contact analysis are doubled until the last step matters no more; the rungs below are kept.
#[test]
fn the_reference_is_refined_until_its_last_step_is_small() {
    let folder = tempfile::tempdir().unwrap();
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fe_models/bevel_13_35.toml");
    std::fs::copy(shipped, folder.path().join("scene.toml")).unwrap();
    let found = found_in(folder.path(), &["ellipse_half_length_largest_mm"]).unwrap();
    let [knob] = &found.knobs[..] else {
        unreachable!("{:?}", found.knobs)
    };
    let counts: Vec<usize> = knob
        .rungs
        .iter()
        .map(|rung| rung.label.parse().unwrap())
        .collect();
    assert_eq!(counts[..4], [12, 24, 48, 96]);
    assert!(counts.len() > 4 && counts.iter().all(|count| *count <= 1000));
    let (_, change) = found.unsettled().unwrap();
    assert!(change < 0.01, "{change} {counts:?}");
    // The step before was too large, or the last would not have been taken.
    let single = |rung: usize| found.tried.iter().find(|one| one.rungs[0] == rung).unwrap();
    let last = counts.len() - 1;
    assert!(single(last - 2).error() > 0.01, "{found:?}");
}
