//! The setting that is chosen for a goal: its error against the truth, and what is said where there is none.

use gearmesh_scene::accuracy::{Chosen, choose};
use gearmesh_scene::study::Subject;
use gearmesh_scene::system_run::RunJob;
use gearmesh_scene::{load, run};

use super::system_runs::Desk;
use super::{OSCILLATOR, SCENE, bench_in, made_up_gears, two_rods};

fn chosen(text: &str, column: &str, goal: f64) -> Result<Chosen, String> {
    let folder = tempfile::tempdir().unwrap();
    made_up_gears::write_models(folder.path());
    std::fs::write(folder.path().join("scene.toml"), text).unwrap();
    bench_in(folder.path(), &[column], |bench| {
        choose(bench, goal, &|_, _| ())
    })
}

/// v = v₀ cos ωt with ω = 20 rad/s: from 0.5 s to 1 s its deviation is known.
fn exact_deviation() -> f64 {
    let mean = (20.0_f64.sin() - 10.0_f64.sin()) / 20.0 / 0.5;
    let square = (0.25 + (40.0_f64.sin() - 20.0_f64.sin()) / 80.0) / 0.5;
    0.5 * (square - mean * mean).sqrt()
}

/// The step that a setting has.
fn step_of(found: &Chosen) -> f64 {
    let line = found
        .toml
        .iter()
        .find_map(|line| line.strip_prefix("solver.step_s = "));
    line.unwrap().parse().unwrap()
}

/// The stated error of a run in time is at least the true one, and a finer goal is served by a step that is as fine or
/// finer. Of the true error the rows' own share, 4e-5 (trapezoidal sum of 250 rows), is no knob's.
#[test]
fn the_stated_error_of_a_run_in_time_covers_the_true_one() {
    let text = OSCILLATOR.replace("interval_s = 1e-2", "interval_s = 2e-3");
    let column = "bodies/block/velocity_x_m_per_s:deviation";
    let mut last = f64::INFINITY;
    for goal in [0.05, 0.001, 1e-4] {
        let found = chosen(&text, column, goal).unwrap();
        assert!(found.is_within(), "{found:?}");
        let Subject::System(scene) = &found.subject else {
            unreachable!("{found:?}")
        };
        let job = RunJob::from_scene((**scene).clone().load().unwrap()).unwrap();
        let result = Desk::new().run(job);
        let mut columns = result.rows.columns().iter();
        let place = columns
            .position(|one| one.name == "bodies/block/velocity_x_m_per_s")
            .unwrap();
        let error = (result.statistics[place].deviation / exact_deviation() - 1.0).abs();
        assert!(error <= found.worst().1 + 4e-5, "{error:e} {found:?}");
        assert!(step_of(&found) <= last);
        last = step_of(&found);
    }
}

/// Of a pair at rest, too: against its finest setting.
#[test]
fn the_stated_error_of_a_pair_covers_the_true_one() {
    let means = |found: &Chosen| {
        let Subject::Pair(scene) = &found.subject else {
            unreachable!("{found:?}")
        };
        let result = run(&load((**scene).clone()).unwrap(), &|_, _| ()).unwrap();
        [0, 1].map(|k| {
            let te = result.curve(&result.te_m, k);
            te.iter().sum::<f64>() / te.len() as f64
        })
    };
    // In one folder: what is chosen names its models.
    let folder = tempfile::tempdir().unwrap();
    made_up_gears::write_models(folder.path());
    std::fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    let within = |goal: f64| {
        bench_in(folder.path(), &["te_mean_um"], |bench| {
            choose(bench, goal, &|_, _| ())
        })
        .unwrap()
    };
    let finest = within(1e-12);
    assert!(
        !finest.is_within() && finest.errors[0] > 1e-12,
        "{finest:?}"
    );
    let reference = means(&finest);
    for goal in [0.02, 0.001] {
        let found = within(goal);
        assert!(found.is_within() && found.runs >= 2, "{found:?}");
        let own = means(&found);
        let error = (0..2)
            .map(|k| (own[k] / reference[k] - 1.0).abs())
            .fold(0.0, f64::max);
        assert!(
            error <= found.errors[0] + finest.errors[0],
            "{error:e} {found:?}"
        );
    }
}

/// Settings of a chaotic run agree in nothing.
#[test]
fn what_cannot_be_promised_is_not() {
    let found = chosen(&two_rods(), "bodies/lower/y_m:deviation", 0.01).unwrap();
    assert!(!found.is_within() && found.worst().1 > 0.01, "{found:?}");
}
