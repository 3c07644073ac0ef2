//! `accuracy` of a made-up pair and of a multibody scene: errors against runs of the scenes by themselves, advice that keeps its
//! word, what is refused.
#![allow(clippy::unwrap_used, missing_docs)]

use std::path::Path;
use std::sync::atomic::AtomicBool;

use gearmesh_geometry::input::InputDocument;
use gearmesh_scene::accuracy::{Accuracy, Bench, Goal, Wanted, accuracy, words};
use gearmesh_scene::{Scene, load, run};

mod made_up_gears;

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

fn found_in(folder: &Path, columns: &[&str]) -> Result<Accuracy, String> {
    let wanted = columns.iter().map(|text| Wanted::of(text)).collect();
    let stop = AtomicBool::new(false);
    let bench = Bench::new(&folder.join("scene.toml"), wanted, (0.0, folder, &stop));
    accuracy(&bench.map_err(|e| e.to_string())?, &|_, _| ()).map_err(|e| e.to_string())
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
    let (most, points) = (&found.knobs[1].rungs.last().unwrap().label, 32);
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
    assert_eq!(within.len(), 2);
    for advice in within {
        let Goal::Within(most) = advice.goal else {
            continue;
        };
        assert!(advice.tried.error() <= most, "{advice:?}");
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

/// A body on a spring, ω₀ = 20 rad/s: the error falls with the step.
#[test]
fn a_run_in_time_is_worth_its_step() {
    let folder = tempfile::tempdir().unwrap();
    let text = "title = \"oscillator\"\n[run]\nkind = \"transient\"\nend_s = 1.0\n[solver]\nstep_s = 5e-4\n[output]\ninterval_s = 1e-2\n\
        [[body]]\nname = \"block\"\nmass_kg = 1.0\ninertia_kg_m2 = [1.0, 1.0, 1.0]\nposition_mm = [100.0, 0.0, 0.0]\nvelocity_mm_per_s = [500.0, 0.0, 0.0]\n\
        [[joint]]\nname = \"rail\"\nkind = \"prismatic\"\nbody_2 = \"block\"\naxis = [1.0, 0.0, 0.0]\n\
        [[spring]]\nname = \"spring\"\nbody_2 = \"block\"\nat_1_mm = [0.0, 0.0, 0.0]\nat_2_mm = [100.0, 0.0, 0.0]\nstiffness_N_per_mm = 0.4\nfree_length_mm = 100.0\n";
    std::fs::write(folder.path().join("scene.toml"), text).unwrap();
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
